"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer
from .._document import Document, mapped, several
from .common import Constant


@dataclass(frozen=True, eq=False, repr=False)
class SlowMode(Document):
    """A mode with the rates of its amplitude and phase.

    Attributes:
        number: Its number.
        frequency: Its linear frequency, a formula.
        reference_frequency: The frequency with which its phase is counted, which obeys the
            resonances.
        shape: The linear mode: the displacement of each coordinate.
        amplitude: The symbol of its amplitude.
        phase: The symbol of its phase.
        amplitude_rate: The rate of the amplitude, a formula.
        phase_rate: The rate of the phase, a formula.
    """

    number: int
    frequency: str
    reference_frequency: str
    shape: dict[str, str]
    amplitude: str
    phase: str
    amplitude_rate: str
    phase_rate: str


SlowMode.FIELDS = (
    ("number", "number", None),
    ("frequency", "frequency", None),
    ("reference_frequency", "reference_frequency", None),
    ("shape", "shape", dict),
    ("amplitude", "amplitude", None),
    ("phase", "phase", None),
    ("amplitude_rate", "amplitude_rate", None),
    ("phase_rate", "phase_rate", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class SteadyRelation(Document):
    """A relation between amplitudes of steady motions.

    Attributes:
        at_rest: The amplitudes that are zero; the others are not.
        vanishes: The formula that vanishes.
        squares: The amplitude that the relation fixes alone, and its square; else empty.
    """

    at_rest: tuple[str, ...]
    vanishes: str
    squares: dict[str, str]


SteadyRelation.FIELDS = (
    ("at_rest", "at_rest", tuple),
    ("vanishes", "vanishes", None),
    ("squares", "squares", dict),
)


@dataclass(frozen=True, eq=False, repr=False)
class NearDivisor(Document):
    """A wave near the frequency of a mode.

    Attributes:
        mode: The number of the mode.
        frequency: The frequency of the wave, a formula.
        distance: Its distance from that of the mode, as a part of it.
    """

    mode: int
    frequency: str
    distance: float


NearDivisor.FIELDS = (
    ("mode", "mode", None),
    ("frequency", "frequency", None),
    ("distance", "distance", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class SlowSteadyMotion(Document):
    """A steady motion of the slow equations.

    Attributes:
        amplitudes: The amplitude of each mode.
        phases: The phase of each mode at t = 0.
        phase_rates: The rate of each phase: zero where a drive fixes it.
        stable: Whether small disturbances die out, by the slow equations.
        growth: The largest real part of the eigenvalues that decide; null where there are none.
        error: The largest deviation of a coordinate from the true motion over a period, as a part
            of the largest displacement; null where none was sought, or found near.
        truly_stable: Whether the true motion is stable, by its multipliers; null where it is not
            known.
        omega: The frequency of a motion that nothing drives; left out of others.
        true_omega: The true frequency of a motion that nothing drives; left out where it was not
            found.
    """

    amplitudes: dict[str, float]
    phases: dict[str, float]
    phase_rates: dict[str, float]
    stable: bool
    growth: float | None
    error: float | None
    truly_stable: bool | None
    omega: float | None
    true_omega: float | None


SlowSteadyMotion.FIELDS = (
    ("amplitudes", "amplitudes", dict),
    ("phases", "phases", dict),
    ("phase_rates", "phase_rates", dict),
    ("stable", "stable", None),
    ("growth", "growth", None),
    ("error", "error", None),
    ("truly_stable", "truly_stable", None),
    ("omega", "omega", None),
    ("true_omega", "true_omega", None),
)
SlowSteadyMotion.OPTIONAL = frozenset(['omega', 'true_omega'])


@dataclass(frozen=True, eq=False, repr=False)
class EnergyExchange(Document):
    """The exchange of energy between modes in resonance, by the slow equations.

    Attributes:
        period: The period, `factor` times K(m).
        factor: The factor of K(m).
        parameter: The parameter m of the complete elliptic integral K(m).
        rate_squared: The coefficients of f in s'^2 = f(s), the lowest first; s is zero at the
            start.
        ends: The zeros of f between which s goes to and fro.
        squares: The square of each amplitude, linear in s: its value at the start and its slope.
        amplitudes: The least and the greatest amplitude of each mode.
    """

    period: float
    factor: float
    parameter: float
    rate_squared: tuple[float, ...]
    ends: tuple[float, float]
    squares: dict[str, tuple[float, float]]
    amplitudes: dict[str, tuple[float, float]]


EnergyExchange.FIELDS = (
    ("period", "period", None),
    ("factor", "factor", None),
    ("parameter", "parameter", None),
    ("rate_squared", "rate_squared", tuple),
    ("ends", "ends", tuple),
    ("squares", "squares", mapped(tuple)),
    ("amplitudes", "amplitudes", mapped(tuple)),
)


@dataclass(frozen=True, eq=False, repr=False)
class SlowTransient(Document):
    """A motion by the slow equations beside the true one.

    Attributes:
        until: The time over which both are compared.
        error: The largest deviation of a coordinate, as a part of the largest displacement.
        exchange: The exchange of energy between the modes; null where there is none in closed
            form.
    """

    until: float
    error: float
    exchange: EnergyExchange | None


SlowTransient.FIELDS = (
    ("until", "until", None),
    ("error", "error", None),
    ("exchange", "exchange", EnergyExchange.from_json),
)


@dataclass(frozen=True, eq=False, repr=False)
class SlowEquations(Answer):
    """The slow equations of coupled equations by multiple scales.

    Attributes:
        schema: The kind of document.
        equations: The equations as they were understood.
        coordinates: The coordinates.
        rest: The place of rest from which each coordinate is counted, a formula.
        parameters: The letters of the equations, in alphabetical order.
        method: The method: `multiple-scales`, or `averaging`.
        order: The highest order of the slow equations.
        small_order: The order as which damping, detunings and drives at a resonance count.
        small_parameter: The small parameter; null if it is the amplitude of the motion.
        resonances: The resonances between the frequencies.
        modes: The modes.
        slow_phases: The slow phases in the rates that are combinations of the phases of the
            modes.
        motion: The motion of each coordinate: a formula in `t`, the amplitudes and the phases.
        definitions: What the formulas name, each by those before it; detunings, `sigma`, are
            reference frequency less linear frequency.
        constants: What stays constant along the slow motion, formulas in amplitudes and slow
            phases; empty where something damps or drives it, or no one phase decides.
        relations: The relations of steady motions with the phases eliminated.
        near: Waves that are near the frequency of a mode they are not in resonance with, where
            values are known: a divisor is small.
        derivation: The derivation line by line, as text; left out where it was not asked for.
        numerical: Whether coefficients are rounded to fifteen digits.
        at: The values at which steady motions, or a motion, were computed; null without values.
        steady: The steady motions at the values, the largest first.
        has_families: Whether there are families of steady motions as well, which are not listed.
        transient: The motion from the amplitudes that were given, beside the true one; null
            without them.
        slope: The measured exponent of the deviation by halving of everything that is small; left
            out where it was not measured.
        verdict: `pass` or `fail`; null where nothing was compared.
        tolerance: The largest error that passes; null without values.
    """

    schema: Literal["lindstedt/slow-equations/1"]
    equations: tuple[str, ...]
    coordinates: tuple[str, ...]
    rest: dict[str, str]
    parameters: tuple[str, ...]
    method: str
    order: int
    small_order: int
    small_parameter: str | None
    resonances: tuple[str, ...]
    modes: tuple[SlowMode, ...]
    slow_phases: dict[str, str]
    motion: dict[str, str]
    definitions: dict[str, str]
    constants: tuple[str, ...]
    relations: tuple[SteadyRelation, ...]
    near: tuple[NearDivisor, ...]
    derivation: tuple[str, ...] | None
    numerical: bool
    at: dict[str, Constant] | None
    steady: tuple[SlowSteadyMotion, ...]
    has_families: bool
    transient: SlowTransient | None
    slope: float | None
    verdict: str | None
    tolerance: float | None


SlowEquations.FIELDS = (
    ("schema", "schema", None),
    ("equations", "equations", tuple),
    ("coordinates", "coordinates", tuple),
    ("rest", "rest", dict),
    ("parameters", "parameters", tuple),
    ("method", "method", None),
    ("order", "order", None),
    ("small_order", "small_order", None),
    ("small_parameter", "small_parameter", None),
    ("resonances", "resonances", tuple),
    ("modes", "modes", several(SlowMode.from_json)),
    ("slow_phases", "slow_phases", dict),
    ("motion", "motion", dict),
    ("definitions", "definitions", dict),
    ("constants", "constants", tuple),
    ("relations", "relations", several(SteadyRelation.from_json)),
    ("near", "near", several(NearDivisor.from_json)),
    ("derivation", "derivation", tuple),
    ("numerical", "numerical", None),
    ("at", "at", mapped(Constant.from_json)),
    ("steady", "steady", several(SlowSteadyMotion.from_json)),
    ("has_families", "has_families", None),
    ("transient", "transient", SlowTransient.from_json),
    ("slope", "slope", None),
    ("verdict", "verdict", None),
    ("tolerance", "tolerance", None),
)
SlowEquations.OPTIONAL = frozenset(['derivation', 'slope'])
