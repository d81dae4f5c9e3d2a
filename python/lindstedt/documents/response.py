"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer
from .._document import Document, mapped, several
from .common import Constant


@dataclass(frozen=True, eq=False, repr=False)
class ResponsePoint(Document):
    """A steady state.

    Attributes:
        parameter: The value of the parameter that varies.
        frequency: The frequency of the motion: theta/t.
        amplitude: The amplitude of the first harmonic, amplitude*cos(theta - phase).
        phase: Its phase, in radians.
        peak: Half of the way from the lowest to the highest point of the motion.
        stable: Whether small disturbances die out: both multipliers lie inside the unit circle,
            of a self-excited motion the first; null where they could not be found.
        multipliers: The multipliers of a period, each its real and imaginary part, the larger
            first, of a self-excited motion the one along it, which is 1, last; null where they
            could not be found.
        start: Position and velocity at t = 0, by shooting where that found the true motion.
        error: The error of amplitude or peak, the larger, over the true peak, or that of the
            frequency; null where no true motion was found near.
    """

    parameter: float
    frequency: float
    amplitude: float
    phase: float
    peak: float
    stable: bool | None
    multipliers: tuple[tuple[float, float], tuple[float, float]] | None
    start: tuple[float, float]
    error: float | None


ResponsePoint.FIELDS = (
    ("parameter", "parameter", None),
    ("frequency", "frequency", None),
    ("amplitude", "amplitude", None),
    ("phase", "phase", None),
    ("peak", "peak", None),
    ("stable", "stable", None),
    ("multipliers", "multipliers", several(tuple)),
    ("start", "start", tuple),
    ("error", "error", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class ResponseBifurcation(Document):
    """A place where a branch changes.

    Attributes:
        kind: What happens: the branch turns back, another one crosses, motions of twice the
            period come off, a second frequency comes in, a self-excited motion is born from rest,
            motions of every amplitude at one value of the parameter.
        branch: The branch, counted from 0.
        parameter: The value of the parameter that varies.
        frequency: The frequency of the motion.
        amplitude: The amplitude of the first harmonic.
        peak: Half of peak to peak.
    """

    kind: Literal["fold", "branch-point", "period-doubling", "neimark-sacker", "hopf", "centre"]
    branch: int
    parameter: float
    frequency: float
    amplitude: float
    peak: float


ResponseBifurcation.FIELDS = (
    ("kind", "kind", None),
    ("branch", "branch", None),
    ("parameter", "parameter", None),
    ("frequency", "frequency", None),
    ("amplitude", "amplitude", None),
    ("peak", "peak", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class ResponseRipple(Document):
    """Folds of the balance alone.

    Attributes:
        folds: How many they are.
        range: The lowest and the highest value of the parameter at which they are.
    """

    folds: int
    range: tuple[float, float]


ResponseRipple.FIELDS = (
    ("folds", "folds", None),
    ("range", "range", tuple),
)


@dataclass(frozen=True, eq=False, repr=False)
class BackbonePoint(Document):
    """A free motion without damping.

    Attributes:
        parameter: The value of the parameter at which it has the frequency of the drive over
            `periods`.
        amplitude: The amplitude of its first harmonic.
    """

    parameter: float
    amplitude: float


BackbonePoint.FIELDS = (
    ("parameter", "parameter", None),
    ("amplitude", "amplitude", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class SlowPoint(Document):
    """A steady motion by slow equations.

    Attributes:
        parameter: The value of the parameter that varies.
        amplitude: The amplitude of the first harmonic.
        phase: Its phase, in radians.
        stable: Whether small disturbances die out, by the slow equations.
    """

    parameter: float
    amplitude: float
    phase: float
    stable: bool


SlowPoint.FIELDS = (
    ("parameter", "parameter", None),
    ("amplitude", "amplitude", None),
    ("phase", "phase", None),
    ("stable", "stable", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class SlowResponse(Document):
    """Steady motions by slow equations.

    Attributes:
        method: The method: `multiple-scales`.
        order: Its order.
        amplitude_rate: The rate of the amplitude, a formula.
        phase_rate: The rate of the phase, a formula.
        definitions: What stands for what in them.
        states: The steady motions, by the parameter.
        largest_error: The largest error of the amplitude at the stable points of the branches,
            over the amplitude; null where there is none.
        missing: Stable points of the branches near which the slow equations have no stable
            motion.
        beside: The number of stable points beside a branch point, which are not compared: there
            the amplitude grows as a root of the distance. Left out where there are none.
        spurious: Steady motions of the truncated slow equations that are left out, at all values
            of the parameter together: at their amplitude the last order is more than half of the
            one before it. Left out where there are none.
        verdict: Whether the error is within the tolerance and no more than one point in twenty is
            missing.
    """

    method: str
    order: int
    amplitude_rate: str
    phase_rate: str
    definitions: dict[str, str]
    states: tuple[SlowPoint, ...]
    largest_error: float | None
    missing: int
    beside: int | None
    spurious: int | None
    verdict: Literal["pass", "fail"]


SlowResponse.FIELDS = (
    ("method", "method", None),
    ("order", "order", None),
    ("amplitude_rate", "amplitude_rate", None),
    ("phase_rate", "phase_rate", None),
    ("definitions", "definitions", dict),
    ("states", "states", several(SlowPoint.from_json)),
    ("largest_error", "largest_error", None),
    ("missing", "missing", None),
    ("beside", "beside", None),
    ("spurious", "spurious", None),
    ("verdict", "verdict", None),
)
SlowResponse.OPTIONAL = frozenset(['beside', 'spurious'])


@dataclass(frozen=True, eq=False, repr=False)
class SimulatedPoint(Document):
    """A simulation that has settled.

    Attributes:
        parameter: The value of the parameter that varies.
        frequency: Its frequency.
        amplitude: The amplitude of its first harmonic.
        peak: Half of peak to peak.
        error: The error of the point of the branch against it, over its peak; or that of the
            frequency, if it is larger.
    """

    parameter: float
    frequency: float
    amplitude: float
    peak: float
    error: float


SimulatedPoint.FIELDS = (
    ("parameter", "parameter", None),
    ("frequency", "frequency", None),
    ("amplitude", "amplitude", None),
    ("peak", "peak", None),
    ("error", "error", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class ElsewherePoint(Document):
    """A simulation that has settled elsewhere.

    Attributes:
        parameter: The value of the parameter that varies.
        periods: After how many periods of the motion it repeats itself, 1 where harmonic balance
            has not come to it; null where it does not within eight.
        drive_periods: After how many periods of the drive it repeats itself; null where it does
            not.
        start: Position and velocity at t = 0 or a whole number of periods later, from where it
            goes on as it has settled.
        amplitude: The amplitude of the first harmonic of a period of the motion from there.
        peak: Half of the way from the lowest to the highest point of this period.
    """

    parameter: float
    periods: int | None
    drive_periods: int | None
    start: tuple[float, float]
    amplitude: float
    peak: float


ElsewherePoint.FIELDS = (
    ("parameter", "parameter", None),
    ("periods", "periods", None),
    ("drive_periods", "drive_periods", None),
    ("start", "start", tuple),
    ("amplitude", "amplitude", None),
    ("peak", "peak", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class ResponseVerification(Document):
    """How far the branches are from true motions.

    Attributes:
        error: The largest error of all points and simulations; null where no true motion was
            found.
        tolerance: The error up to which it passes.
        unjudged: Points beside which shooting found no true motion.
        verdict: The verdict.
    """

    error: float | None
    tolerance: float
    unjudged: int
    verdict: Literal["pass", "fail"]


ResponseVerification.FIELDS = (
    ("error", "error", None),
    ("tolerance", "tolerance", None),
    ("unjudged", "unjudged", None),
    ("verdict", "verdict", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Response(Answer):
    """Steady states of an oscillator, driven or self-excited, as a parameter varies. Units are those
    of the equation and the values given.

    Attributes:
        schema: The kind of document.
        equation: The equation of motion.
        parameters: The values of all other parameters.
        parameter: The name of the parameter that varies.
        range: Its lowest and its highest value.
        method: How the branches were found: `harmonic-balance`, or `period-map` where the force
            has corners, or jumps that harmonic balance does not take.
        harmonics: The highest harmonic kept.
        periods: How many periods of the drive a period of the motion takes.
        frequency: theta/t: the frequency of the motion, that of the drive over `periods`; a name
            where nothing drives it.
        self_excited: Whether nothing drives the motion: each point then has a frequency of its
            own.
        undamped: Whether nothing damps the motion; `stable` then means that disturbances do not
            grow.
        branches: The branches, each a list of points in order.
        mirrored: Of each branch whether -x half a period of the drive later is a branch as well,
            which is not listed.
        stuck: Of each point of a branch the part of a period in which dry friction holds it;
            empty for a branch that nothing holds.
        bifurcations: Where branches change.
        ripple: Folds of the balance that are none of the true motion and not among those places.
            Left out where there are none.
        backbone: The free motion without damping, a list of points for each stable place of rest;
            empty where the frequency of the drive does not vary.
        modulation: The steady motions by slow equations of amplitude and phase, where a method
            with such equations was asked for; else null.
        simulated: Simulations that were let go beside stable points and have settled.
        elsewhere: Simulations that have settled on something that is not among the branches.
        verification: The judgement of all points.
        complete: Whether it was followed to its end.
    """

    schema: Literal["lindstedt/response/1"]
    equation: str
    parameters: dict[str, Constant]
    parameter: str
    range: tuple[float, float]
    method: str
    harmonics: int
    periods: int
    frequency: str
    self_excited: bool
    undamped: bool
    branches: tuple[tuple[ResponsePoint, ...], ...]
    mirrored: tuple[bool, ...]
    stuck: tuple[tuple[float, ...], ...]
    bifurcations: tuple[ResponseBifurcation, ...]
    ripple: ResponseRipple | None
    backbone: tuple[tuple[BackbonePoint, ...], ...]
    modulation: SlowResponse | None
    simulated: tuple[SimulatedPoint, ...]
    elsewhere: tuple[ElsewherePoint, ...]
    verification: ResponseVerification
    complete: bool


Response.FIELDS = (
    ("schema", "schema", None),
    ("equation", "equation", None),
    ("parameters", "parameters", mapped(Constant.from_json)),
    ("parameter", "parameter", None),
    ("range", "range", tuple),
    ("method", "method", None),
    ("harmonics", "harmonics", None),
    ("periods", "periods", None),
    ("frequency", "frequency", None),
    ("self_excited", "self_excited", None),
    ("undamped", "undamped", None),
    ("branches", "branches", several(several(ResponsePoint.from_json))),
    ("mirrored", "mirrored", tuple),
    ("stuck", "stuck", several(tuple)),
    ("bifurcations", "bifurcations", several(ResponseBifurcation.from_json)),
    ("ripple", "ripple", ResponseRipple.from_json),
    ("backbone", "backbone", several(several(BackbonePoint.from_json))),
    ("modulation", "modulation", SlowResponse.from_json),
    ("simulated", "simulated", several(SimulatedPoint.from_json)),
    ("elsewhere", "elsewhere", several(ElsewherePoint.from_json)),
    ("verification", "verification", ResponseVerification.from_json),
    ("complete", "complete", None),
)
Response.OPTIONAL = frozenset(['ripple'])
