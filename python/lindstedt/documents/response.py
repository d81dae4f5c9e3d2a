"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

from .._answer import Answer
from .._document import Document, mapped, one_of, several
from .common import Constant, Event, Wall


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
        amplitudes: The amplitude of the first harmonic of each coordinate of coupled equations.
            Left out for one coordinate.
        phases: The phase of each, in radians. Left out for one coordinate.
        peaks: Half of the way from the lowest to the highest point of each. Left out for one
            coordinate.
        state: The positions of all coordinates at t = 0, then their rates. Left out for one
            coordinate.
        counted: The value after a period of each state that only counts and begins the period at
            zero. Left out where there is none.
        energy: The energy of a free motion without damping over that of rest. Left out where it
            is not known.
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
    amplitudes: dict[str, float] | None
    phases: dict[str, float] | None
    peaks: dict[str, float] | None
    state: tuple[float, ...] | None
    counted: tuple[float, ...] | None
    energy: float | None


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
    ("amplitudes", "amplitudes", dict),
    ("phases", "phases", dict),
    ("peaks", "peaks", dict),
    ("state", "state", tuple),
    ("counted", "counted", tuple),
    ("energy", "energy", None),
)
ResponsePoint.OPTIONAL = frozenset(['amplitudes', 'counted', 'energy', 'peaks', 'phases', 'state'])


#: The side on which motions come off at a bifurcation, and so whether they are stable beside it.
Criticality: TypeAlias = Literal["subcritical", "supercritical", "strongly-resonant"]


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
        criticality: Whether the motions that come off are stable, where that is known.
    """

    kind: Literal["fold", "branch-point", "period-doubling", "neimark-sacker", "hopf", "centre", "grazing"]
    branch: int
    parameter: float
    frequency: float
    amplitude: float
    peak: float
    criticality: Criticality | None


ResponseBifurcation.FIELDS = (
    ("kind", "kind", None),
    ("branch", "branch", None),
    ("parameter", "parameter", None),
    ("frequency", "frequency", None),
    ("amplitude", "amplitude", None),
    ("peak", "peak", None),
    ("criticality", "criticality", None),
)
ResponseBifurcation.OPTIONAL = frozenset(['criticality'])


@dataclass(frozen=True, eq=False, repr=False)
class Equilibrium(Document):
    """An equilibrium of coupled equations that nothing drives.

    Attributes:
        parameter: The value of the parameter that varies.
        value: The quantity that is listed.
        state: All coordinates, then the velocities of those of second order.
        growth: The largest real part of an eigenvalue of the linear equations; null where there
            is none.
        stable: Whether small disturbances die out; without damping, whether they do not grow.
        error: The way to the zero of the equations as they were given, by one step of Newton's
            method, over the size of the largest equilibrium; null where the linear equations are
            singular.
    """

    parameter: float
    value: float
    state: tuple[float, ...]
    growth: float | None
    stable: bool | None
    error: float | None


Equilibrium.FIELDS = (
    ("parameter", "parameter", None),
    ("value", "value", None),
    ("state", "state", tuple),
    ("growth", "growth", None),
    ("stable", "stable", None),
    ("error", "error", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class EquilibriumChange(Document):
    """A place where a branch of equilibria changes.

    Attributes:
        kind: The kind of the change: a fold, a branch point, or a Hopf point, where cycles are
            born.
        parameter: The value of the parameter that varies.
        value: The quantity that is listed.
        criticality: Whether the cycles that come off at a Hopf point are stable, where that is
            known.
    """

    kind: Literal["fold", "branch-point", "period-doubling", "neimark-sacker", "hopf", "centre", "grazing"]
    parameter: float
    value: float
    criticality: Criticality | None


EquilibriumChange.FIELDS = (
    ("kind", "kind", None),
    ("parameter", "parameter", None),
    ("value", "value", None),
    ("criticality", "criticality", None),
)
EquilibriumChange.OPTIONAL = frozenset(['criticality'])


@dataclass(frozen=True, eq=False, repr=False)
class EquilibriumBranch(Document):
    """A branch of equilibria in order, with its changes.

    Attributes:
        points: Its points.
        changes: Its folds, branch points and Hopf points.
    """

    points: tuple[Equilibrium, ...]
    changes: tuple[EquilibriumChange, ...]


EquilibriumBranch.FIELDS = (
    ("points", "points", several(Equilibrium.from_json)),
    ("changes", "changes", several(EquilibriumChange.from_json)),
)


@dataclass(frozen=True, eq=False, repr=False)
class BifurcationCurvePoint(Document):
    """A bifurcation at values of two parameters.

    Attributes:
        parameter: The value of the parameter that varies.
        along: The value of the second parameter.
        peak: Half of peak to peak of the motion there.
    """

    parameter: float
    along: float
    peak: float


BifurcationCurvePoint.FIELDS = (
    ("parameter", "parameter", None),
    ("along", "along", None),
    ("peak", "peak", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class BifurcationCurve(Document):
    """A curve of bifurcations in two parameters.

    Attributes:
        kind: The kind of its bifurcations: fold, period doubling or Neimark-Sacker.
        points: Its points in order.
    """

    kind: Literal["fold", "branch-point", "period-doubling", "neimark-sacker", "hopf", "centre", "grazing"]
    points: tuple[BifurcationCurvePoint, ...]


BifurcationCurve.FIELDS = (
    ("kind", "kind", None),
    ("points", "points", several(BifurcationCurvePoint.from_json)),
)


@dataclass(frozen=True, eq=False, repr=False)
class StableMotions(Document):
    """Numbers of stable motions at values of two parameters.

    Attributes:
        parameters: The values of the parameter that varies.
        along: The values of the second parameter.
        counts: For each value of the second parameter the number of stable motions that were
            found at each value of the first.
    """

    parameters: tuple[float, ...]
    along: tuple[float, ...]
    counts: tuple[tuple[int, ...], ...]


StableMotions.FIELDS = (
    ("parameters", "parameters", tuple),
    ("along", "along", tuple),
    ("counts", "counts", several(tuple)),
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
        peak: Half of the way from the lowest to the highest point, of coupled equations; left out
            of one coordinate.
    """

    parameter: float
    amplitude: float
    phase: float
    stable: bool
    peak: float | None


SlowPoint.FIELDS = (
    ("parameter", "parameter", None),
    ("amplitude", "amplitude", None),
    ("phase", "phase", None),
    ("stable", "stable", None),
    ("peak", "peak", None),
)
SlowPoint.OPTIONAL = frozenset(['peak'])


@dataclass(frozen=True, eq=False, repr=False)
class SlowResponse(Document):
    """Steady motions by slow equations.

    Attributes:
        method: The method: `multiple-scales`.
        order: Its order.
        amplitude_rate: The rate of the amplitude, a formula; empty of coupled equations.
        phase_rate: The rate of the phase, a formula; empty of coupled equations.
        modes: The rates of amplitude and phase of each mode of coupled equations, formulas. Left
            out of one coordinate.
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
    modes: tuple[tuple[str, str], ...] | None
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
    ("modes", "modes", several(tuple)),
    ("definitions", "definitions", dict),
    ("states", "states", several(SlowPoint.from_json)),
    ("largest_error", "largest_error", None),
    ("missing", "missing", None),
    ("beside", "beside", None),
    ("spurious", "spurious", None),
    ("verdict", "verdict", None),
)
SlowResponse.OPTIONAL = frozenset(['beside', 'modes', 'spurious'])


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
class ChaoticMotion(Document):
    """A motion from which those nearby part exponentially.

    Attributes:
        lyapunov_exponent: The largest Lyapunov exponent, per unit of time.
        lyapunov_error: Its standard error.
    """

    lyapunov_exponent: float
    lyapunov_error: float


ChaoticMotion.FIELDS = (
    ("lyapunov_exponent", "lyapunov_exponent", None),
    ("lyapunov_error", "lyapunov_error", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class QuasiPeriodicMotion(Document):
    """A motion of two frequencies: that of the drive, or of so many of its periods as a motion takes,
    and another.

    Attributes:
        second_frequency: The angular frequency of the strongest part that is no harmonic of the
            first.
    """

    second_frequency: float


QuasiPeriodicMotion.FIELDS = (
    ("second_frequency", "second_frequency", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class RotatingMotion(Document):
    """A motion that goes round: it repeats itself but for whole turns of 2 pi.

    Attributes:
        turns: The number of turns, negative where the angle decreases; of several angles, of that
            with the most of them.
        in_periods: The number of periods of the motion that they take.
    """

    turns: int
    in_periods: int


RotatingMotion.FIELDS = (
    ("turns", "turns", None),
    ("in_periods", "in_periods", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class UnsettledMotion(Document):
    """A motion that neither repeats itself nor is quasi-periodic or chaotic, as far as it was
    followed: it may still be on its way.

    Attributes:
        followed_periods: The number of periods of the motion over which it was followed further.
    """

    followed_periods: int


UnsettledMotion.FIELDS = (
    ("followed_periods", "followed_periods", None),
)


#: The course of a motion that does not repeat itself.
AperiodicMotion: TypeAlias = QuasiPeriodicMotion | ChaoticMotion | RotatingMotion | UnsettledMotion


@dataclass(frozen=True, eq=False, repr=False)
class ElsewherePoint(Document):
    """A simulation that has settled elsewhere.

    Attributes:
        parameter: The value of the parameter that varies.
        periods: After how many periods of the motion it repeats itself, 1 where harmonic balance
            has not come to it; null where it does not.
        drive_periods: After how many periods of the drive it repeats itself; null where it does
            not.
        start: Position and velocity at t = 0 or a whole number of periods later, from where it
            goes on as it has settled.
        state: All states there, of coupled equations: coordinates, then velocities. Left out for
            one coordinate.
        amplitude: The amplitude of the first harmonic of a period of the motion from there.
        peak: Half of the way from the lowest to the highest point of this period.
        aperiodic: How it goes on where it does not repeat itself; left out where it does, and
            where it cannot be followed.
    """

    parameter: float
    periods: int | None
    drive_periods: int | None
    start: tuple[float, float]
    state: tuple[float, ...] | None
    amplitude: float
    peak: float
    aperiodic: AperiodicMotion | None


ElsewherePoint.FIELDS = (
    ("parameter", "parameter", None),
    ("periods", "periods", None),
    ("drive_periods", "drive_periods", None),
    ("start", "start", tuple),
    ("state", "state", tuple),
    ("amplitude", "amplitude", None),
    ("peak", "peak", None),
    ("aperiodic", "aperiodic", one_of(QuasiPeriodicMotion, ChaoticMotion, RotatingMotion, UnsettledMotion)),
)
ElsewherePoint.OPTIONAL = frozenset(['aperiodic', 'state'])


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
    """Steady states of an oscillator, or of coupled equations, as a parameter varies. Units are those
    of the equation and the values given.

    Attributes:
        schema: The kind of document.
        equation: The equation of motion; coupled equations are separated by `;`.
        coordinates: The coordinates of coupled equations, without those that only count. Left out
            for one coordinate.
        counters: The states that only count: they enter neither forces nor conditions. Left out
            where there are none.
        modes: The values of each state that changes at events alone, among finitely many. Left
            out where there is none.
        of: The quantity of coupled equations whose amplitude, phase and peak are listed, in the
            coordinates. Left out for one coordinate.
        parameters: The values of all other parameters.
        parameter: The name of the parameter that varies.
        range: Its lowest and its highest value.
        method: How the branches were found: `harmonic-balance`, or `period-map` where the force
            has corners, or jumps that harmonic balance does not take; `shooting` for coupled
            equations.
        harmonics: The highest harmonic kept.
        periods: How many periods of the drive a period of the motion takes.
        frequency: theta/t: the frequency of the motion, that of the drive over `periods`; a name
            where nothing drives it.
        self_excited: Whether nothing drives the motion: each point then has a frequency of its
            own, or, of coupled equations that nothing damps either, the parameter is the
            frequency.
        undamped: Whether nothing damps the motion; `stable` then means that disturbances do not
            grow.
        branches: The branches, each a list of points in order.
        mirrored: Of each branch whether -x half a period of the drive later is a branch as well,
            which is not listed.
        stuck: Of each point of a branch the part of a period in which dry friction holds it or it
            rests on a wall; empty for a branch that nothing holds.
        walls: The walls; left out without one.
        impacts: The number of impacts in a period at each point of a branch, without those that
            accumulate before a rest; left out without a wall.
        events: The events, as `--event` takes them; left out without one.
        event_counts: The number of events in a period at each point of a branch, without those
            that set nothing but what only counts; left out without an event.
        bifurcations: Where branches change.
        equilibria: The equilibria of coupled equations that nothing drives, a branch each. Left
            out where there are none.
        along: The name of a second parameter, along which bifurcations are followed. Left out
            where none was given.
        curves_of_bifurcations: The curves of bifurcations in both parameters. Left out where
            there are none.
        stable_motions: The numbers of stable motions over both parameters. Left out where they
            were not counted.
        ripple: Folds of the balance that are none of the true motion and not among those places.
            Left out where there are none.
        backbone: The free motion without damping, a list of points for each stable place of rest;
            empty where the frequency of the drive does not vary.
        modulation: The steady motions by slow equations of amplitude and phase, where a method
            with such equations was asked for; else null.
        simulated: Simulations that were let go beside stable points and have settled.
        elsewhere: Simulations that have settled on something that is not among the branches.
        verification: The judgement of all points.
        exhausted: Whether the search for motions of coupled equations was ended because it had
            taken as much work as it may: branches may be missing or end early, and bifurcations
            are not listed. Left out where it was not.
        sparse: The stretches, each with its ends, in which the search for motions of one
            coordinate had too few starts: from one to the next they gain more than a swing in a
            period of the drive. Those outside `range` were asked for and are not answered; in
            others branches may be missing. Left out where there are none.
        complete: Whether it was followed to its end.
    """

    schema: Literal["lindstedt/response/1"]
    equation: str
    coordinates: tuple[str, ...] | None
    counters: tuple[str, ...] | None
    modes: dict[str, tuple[float, ...]] | None
    of: str | None
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
    walls: tuple[Wall, ...] | None
    impacts: tuple[tuple[int, ...], ...] | None
    events: tuple[Event, ...] | None
    event_counts: tuple[tuple[int, ...], ...] | None
    bifurcations: tuple[ResponseBifurcation, ...]
    equilibria: tuple[EquilibriumBranch, ...] | None
    along: str | None
    curves_of_bifurcations: tuple[BifurcationCurve, ...] | None
    stable_motions: StableMotions | None
    ripple: ResponseRipple | None
    backbone: tuple[tuple[BackbonePoint, ...], ...]
    modulation: SlowResponse | None
    simulated: tuple[SimulatedPoint, ...]
    elsewhere: tuple[ElsewherePoint, ...]
    verification: ResponseVerification
    exhausted: bool | None
    sparse: tuple[tuple[float, float], ...] | None
    complete: bool


Response.FIELDS = (
    ("schema", "schema", None),
    ("equation", "equation", None),
    ("coordinates", "coordinates", tuple),
    ("counters", "counters", tuple),
    ("modes", "modes", mapped(tuple)),
    ("of", "of", None),
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
    ("walls", "walls", several(Wall.from_json)),
    ("impacts", "impacts", several(tuple)),
    ("events", "events", several(Event.from_json)),
    ("event_counts", "event_counts", several(tuple)),
    ("bifurcations", "bifurcations", several(ResponseBifurcation.from_json)),
    ("equilibria", "equilibria", several(EquilibriumBranch.from_json)),
    ("along", "along", None),
    ("curves_of_bifurcations", "curves_of_bifurcations", several(BifurcationCurve.from_json)),
    ("stable_motions", "stable_motions", StableMotions.from_json),
    ("ripple", "ripple", ResponseRipple.from_json),
    ("backbone", "backbone", several(several(BackbonePoint.from_json))),
    ("modulation", "modulation", SlowResponse.from_json),
    ("simulated", "simulated", several(SimulatedPoint.from_json)),
    ("elsewhere", "elsewhere", several(ElsewherePoint.from_json)),
    ("verification", "verification", ResponseVerification.from_json),
    ("exhausted", "exhausted", None),
    ("sparse", "sparse", several(tuple)),
    ("complete", "complete", None),
)
Response.OPTIONAL = frozenset(['along', 'coordinates', 'counters', 'curves_of_bifurcations', 'equilibria', 'event_counts', 'events', 'exhausted', 'impacts', 'modes', 'of', 'ripple', 'sparse', 'stable_motions', 'walls'])
