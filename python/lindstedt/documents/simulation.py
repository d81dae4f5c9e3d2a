"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer
from .._document import Document, several
from .common import Barrier, Dissipation, State


@dataclass(frozen=True, eq=False, repr=False)
class Parameters(Document):
    """The numbers of a run: dimensionless unless another unit is given.

    Attributes:
        barrier: Where the barriers stand.
        start: The displacement at t = 0, in radians.
        speed: The velocity at t = 0, in radians per unit of time.
        gamma: The stiffness of the barrier.
        gamma_source: Where gamma comes from, in words.
        mu: The damping of the contact, by Hunt and Crossley.
        mu_source: Where mu comes from, in words.
        zeta: The viscous damping, as a fraction of the critical one.
        alpha: The torque of dry friction, in units of m g L.
        friction: The law of dry friction: `exact` with sticking, or `arctangent`.
        beta: The amplitude of the moving pivot: (A_e/L) (Omega/omega)^2.
        frequency_ratio: The frequency of the pivot over that of small swings, Omega/omega.
        duration: How long the run is to last, in units of time.
        integrator_tolerance: The relative tolerance that was asked for.
        step_tolerance: The relative tolerance of one step, a part of it.
    """

    barrier: Barrier
    start: float
    speed: float
    gamma: float
    gamma_source: str
    mu: float
    mu_source: str
    zeta: float
    alpha: float
    friction: Literal["exact", "arctangent"]
    beta: float
    frequency_ratio: float
    duration: float
    integrator_tolerance: float
    step_tolerance: float


Parameters.FIELDS = (
    ("barrier", "barrier", Barrier.from_json),
    ("start", "start", None),
    ("speed", "speed", None),
    ("gamma", "gamma", None),
    ("gamma_source", "gamma_source", None),
    ("mu", "mu", None),
    ("mu_source", "mu_source", None),
    ("zeta", "zeta", None),
    ("alpha", "alpha", None),
    ("friction", "friction", None),
    ("beta", "beta", None),
    ("frequency_ratio", "frequency_ratio", None),
    ("duration", "duration", None),
    ("integrator_tolerance", "integrator_tolerance", None),
    ("step_tolerance", "step_tolerance", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class ContactForm(Document):
    """x(t) = barrier + the sum over j from 1 of sines_j sin(j pi t/duration).

    Attributes:
        barrier: Where the barrier stands, in radians.
        duration: The duration of the contact, in units of time.
        sines: The amplitudes of the sines, in radians.
    """

    barrier: float
    duration: float
    sines: tuple[float, ...]


ContactForm.FIELDS = (
    ("barrier", "barrier", None),
    ("duration", "duration", None),
    ("sines", "sines", tuple),
)


@dataclass(frozen=True, eq=False, repr=False)
class SwingForm(Document):
    """x(t) = 2 sign asin(modulus exp(-rate t) sn(speed t + phase, parameter)), sn of Jacobi with the
    parameter k^2.

    Attributes:
        sign: 1 or -1.
        modulus: The sine of half the amplitude at the beginning, dimensionless.
        rate: The rate of decay, per unit of time.
        speed: The rate of the argument of sn, per unit of time.
        phase: The argument of sn at the beginning, dimensionless.
        parameter: The parameter of sn, the square of its modulus, dimensionless.
    """

    sign: float
    modulus: float
    rate: float
    speed: float
    phase: float
    parameter: float


SwingForm.FIELDS = (
    ("sign", "sign", None),
    ("modulus", "modulus", None),
    ("rate", "rate", None),
    ("speed", "speed", None),
    ("phase", "phase", None),
    ("parameter", "parameter", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class ChainPhase(Document):
    """A phase of a chain: a stretch of time with one formula.

    Attributes:
        name: What happens: `swing`, `contact`, `rest` where dry friction holds the pendulum, or
            `integrated` where there is no formula.
        start: When it begins, in units of time.
        end: When it ends, in units of time.
        closed_form: x in radians as a function of t, the time since the beginning of the phase;
            null where there is no formula.
        swing: The numbers of the formula of a swing; null for another phase.
        contact: The numbers of the formula of a contact; null for another phase.
    """

    name: Literal["swing", "contact", "rest", "integrated"]
    start: float
    end: float
    closed_form: str | None
    swing: SwingForm | None
    contact: ContactForm | None


ChainPhase.FIELDS = (
    ("name", "name", None),
    ("start", "start", None),
    ("end", "end", None),
    ("closed_form", "closed_form", None),
    ("swing", "swing", SwingForm.from_json),
    ("contact", "contact", ContactForm.from_json),
)


@dataclass(frozen=True, eq=False, repr=False)
class Sample(Document):
    """A state that was asked for.

    Attributes:
        t: The time, in units of time.
        x: The displacement, in radians; null where the run ended before.
        velocity: Its rate, in radians per unit of time; null likewise.
    """

    t: float
    x: float | None
    velocity: float | None


Sample.FIELDS = (
    ("t", "t", None),
    ("x", "x", None),
    ("velocity", "velocity", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class ImpactError(Document):
    """How far a contact of a chain is from the same one by integration.

    Attributes:
        entry_time: The difference of the times of touch, in units of time.
        speed_in: The error of the speed of touch, as a fraction of it; null where it is zero.
        penetration: The error of the greatest depth, as a fraction of it; null where a run ends
            before.
        duration: The error of the duration, as a fraction of it; null where a run ends before.
        speed_out: The error of the speed of release, as a fraction of it; null where a run ends
            before.
    """

    entry_time: float
    speed_in: float | None
    penetration: float | None
    duration: float | None
    speed_out: float | None


ImpactError.FIELDS = (
    ("entry_time", "entry_time", None),
    ("speed_in", "speed_in", None),
    ("penetration", "penetration", None),
    ("duration", "duration", None),
    ("speed_out", "speed_out", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Impact(Document):
    """One contact with a barrier.

    Attributes:
        entry_time: When the barrier is touched, in units of time.
        exit_time: When it is left, in units of time; null where the run ended before.
        speed_in: The speed at the touch, in radians per unit of time; of a motion that starts
            inside the barrier its speed inwards then.
        speed_out: The speed at the release, in radians per unit of time; null where the run ended
            before.
        penetration: The greatest depth, in radians.
        restitution: speed_out / speed_in; null for a contact that did not begin with a touch, or
            did not end.
        energy_lost: The energy that the motion has lost between touch and release, in units of m
            g L; null where the run ended before.
        side: Which barrier it is.
        error: How far it is from the same contact by integration; null unless it is of a chain
            that was judged, and the integration has it.
    """

    entry_time: float
    exit_time: float | None
    speed_in: float
    speed_out: float | None
    penetration: float
    restitution: float | None
    energy_lost: float | None
    side: Literal["left", "right"]
    error: ImpactError | None


Impact.FIELDS = (
    ("entry_time", "entry_time", None),
    ("exit_time", "exit_time", None),
    ("speed_in", "speed_in", None),
    ("speed_out", "speed_out", None),
    ("penetration", "penetration", None),
    ("restitution", "restitution", None),
    ("energy_lost", "energy_lost", None),
    ("side", "side", None),
    ("error", "error", ImpactError.from_json),
)


@dataclass(frozen=True, eq=False, repr=False)
class Geometry(Document):
    """By how much sooner a swing cut at the barrier rests under viscous damping:
    ln(first_swing/at_rest)/(2 zeta).

    Attributes:
        first_swing: The action of the first swing without a barrier over that of the swing cut at
            it.
        at_rest: The same at a tenth of the amplitude; 1 where the barrier is out of reach.
        gain: The gain, in units of time.
    """

    first_swing: float
    at_rest: float
    gain: float


Geometry.FIELDS = (
    ("first_swing", "first_swing", None),
    ("at_rest", "at_rest", None),
    ("gain", "gain", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Baseline(Document):
    """Rest times of the same swing, in units of time; null where it does not come to rest in four
    times the duration of the run.

    Attributes:
        no_barrier: Without a barrier.
        lossless_barrier: With the same barrier, elastic.
        this_barrier: With the barrier of the run: `rest_time`.
        geometry: The gain of the lossless barrier by the actions of the swings; null with dry
            friction.
    """

    no_barrier: float | None
    lossless_barrier: float | None
    this_barrier: float | None
    geometry: Geometry | None


Baseline.FIELDS = (
    ("no_barrier", "no_barrier", None),
    ("lossless_barrier", "lossless_barrier", None),
    ("this_barrier", "this_barrier", None),
    ("geometry", "geometry", Geometry.from_json),
)


@dataclass(frozen=True, eq=False, repr=False)
class Energy(Document):
    """Energies and works over the run, in units of m g L.

    Attributes:
        start: The energy at the start, in units of m g L.
        end: The energy at the end, in units of m g L.
        viscous: The work of viscous damping, never positive, in units of m g L.
        friction: The work of dry friction, never positive, in units of m g L.
        contact: The work of the damping in the contacts, in units of m g L.
        excitation: The work of the moving pivot, in units of m g L.
    """

    start: float
    end: float
    viscous: float
    friction: float
    contact: float
    excitation: float


Energy.FIELDS = (
    ("start", "start", None),
    ("end", "end", None),
    ("viscous", "viscous", None),
    ("friction", "friction", None),
    ("contact", "contact", None),
    ("excitation", "excitation", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Difference(Document):
    """The largest differences of two motions at the same times.

    Attributes:
        x: Of the displacements, in radians.
        velocity: Of the velocities, in radians per unit of time.
        until: The time up to which they are compared, in units of time.
    """

    x: float
    velocity: float
    until: float


Difference.FIELDS = (
    ("x", "x", None),
    ("velocity", "velocity", None),
    ("until", "until", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Judge(Document):
    """The same run by the other integrator.

    Attributes:
        integrator: The integrator.
        impacts: The number of contacts it finds.
        max_difference: How far the two motions differ.
        final_state: The state at its end.
        energy_residual: The largest energy that no work accounts for, as a fraction of the
            largest energy met.
        stopped: Why it ended, in words.
    """

    integrator: Literal["taylor", "runge-kutta", "chain"]
    impacts: int
    max_difference: Difference
    final_state: State
    energy_residual: float
    stopped: str


Judge.FIELDS = (
    ("integrator", "integrator", None),
    ("impacts", "impacts", None),
    ("max_difference", "max_difference", Difference.from_json),
    ("final_state", "final_state", State.from_json),
    ("energy_residual", "energy_residual", None),
    ("stopped", "stopped", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Simulation(Answer):
    """One run of the paper's equation (7), event by event. Angles are in radians, time is in units of
    1/omega of small swings, sqrt(L/g), energies in units of m g L.

    Attributes:
        schema: The kind of document.
        parameters: The numbers of the problem.
        dissipation: What damps, each damping in every form; null where only the numbers of
            equation (7) are known.
        time_unit: The unit of time sqrt(L/g), in seconds; null where mass, length and gravity are
            not known.
        integrator: The integrator of the run: `taylor` with the contact in a variable in which it
            is analytic, or `runge-kutta` phase by phase.
        route: How the motion was found: by `integration`, or as a `chain` of closed forms.
        phases: The phases of a chain, in time; null where the motion was integrated.
        final_state: The state at the end of the run.
        samples: The states at the times that were asked for, in that order.
        impacts: Every contact with a barrier, in time.
        place_of_rest: The place of rest from which amplitudes are counted, in rad: 0, unless a
            barrier holds the pendulum elsewhere or it has turned over.
        rest_time: When the envelope of the amplitude falls to a tenth of the first swing, in
            units of time; null where it does not.
        rest_time_in_seconds: The same in seconds; null where there is none, or where units are
            not known.
        rest_reason: Why there is no rest time, in words; null where there is one.
        last_crossing: The last time at which x is a tenth of the first swing away from the place
            of rest, in units of time; null where it never is.
        baseline: The rest times of the same swing; null where nothing damps it, where it hits
            nothing, or where the pivot moves.
        energy: The energy and the work of each force; of a chain by its formulas, whose
            velocities are near and do not close the books.
        energy_residual: The largest energy that no work accounts for, as a fraction of the
            largest energy met; of a chain that of its velocities.
        known_until: The time until which the motion is known to six digits; beyond it a start
            displaced by 1e-12 of it leads elsewhere. Left out where it is known to the end.
        stopped: Why the run ended, in words.
        complete: Whether the run got where it was to get.
        steps: The number of steps of the integrator.
        judge: The same run by the other integrator, or of a chain by Taylor series; null where it
            was not asked for.
        notes: What should be known beside the numbers, in words.
    """

    schema: Literal["lindstedt/simulation/1"]
    parameters: Parameters
    dissipation: Dissipation | None
    time_unit: float | None
    integrator: Literal["taylor", "runge-kutta", "chain"]
    route: Literal["integration", "chain"]
    phases: tuple[ChainPhase, ...] | None
    final_state: State
    samples: tuple[Sample, ...]
    impacts: tuple[Impact, ...]
    place_of_rest: float
    rest_time: float | None
    rest_time_in_seconds: float | None
    rest_reason: str | None
    last_crossing: float | None
    baseline: Baseline | None
    energy: Energy
    energy_residual: float
    known_until: float | None
    stopped: str
    complete: bool
    steps: int
    judge: Judge | None
    notes: tuple[str, ...]


Simulation.FIELDS = (
    ("schema", "schema", None),
    ("parameters", "parameters", Parameters.from_json),
    ("dissipation", "dissipation", Dissipation.from_json),
    ("time_unit", "time_unit", None),
    ("integrator", "integrator", None),
    ("route", "route", None),
    ("phases", "phases", several(ChainPhase.from_json)),
    ("final_state", "final_state", State.from_json),
    ("samples", "samples", several(Sample.from_json)),
    ("impacts", "impacts", several(Impact.from_json)),
    ("place_of_rest", "place_of_rest", None),
    ("rest_time", "rest_time", None),
    ("rest_time_in_seconds", "rest_time_in_seconds", None),
    ("rest_reason", "rest_reason", None),
    ("last_crossing", "last_crossing", None),
    ("baseline", "baseline", Baseline.from_json),
    ("energy", "energy", Energy.from_json),
    ("energy_residual", "energy_residual", None),
    ("known_until", "known_until", None),
    ("stopped", "stopped", None),
    ("complete", "complete", None),
    ("steps", "steps", None),
    ("judge", "judge", Judge.from_json),
    ("notes", "notes", tuple),
)
Simulation.OPTIONAL = frozenset(['known_until'])
