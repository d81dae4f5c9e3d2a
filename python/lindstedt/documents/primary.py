"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer
from .._document import Document, several


@dataclass(frozen=True, eq=False, repr=False)
class PrimaryParameters(Document):
    """The numbers of main mass and pendulum, dimensionless.

    Attributes:
        mass: R = M/m.
        stiffness: kappa = k L/(m g).
        damping: delta = (c/m) sqrt(L/g).
        force: f = F/(m g).
        frequency: eta = Omega sqrt(L/g).
        zeta: The viscous damping ratio of the pendulum.
        alpha: Its dry friction.
        gamma: The stiffness of the contact.
        mu: The damping of the contact.
        left: The place of the left barrier, in radians; null where there is none.
        right: The place of the right barrier, likewise.
        start: The start: angle, its velocity, displacement of the main mass, its velocity.
    """

    mass: float
    stiffness: float
    damping: float
    force: float
    frequency: float
    zeta: float
    alpha: float
    gamma: float
    mu: float
    left: float | None
    right: float | None
    start: tuple[float, float, float, float]


PrimaryParameters.FIELDS = (
    ("mass", "mass", None),
    ("stiffness", "stiffness", None),
    ("damping", "damping", None),
    ("force", "force", None),
    ("frequency", "frequency", None),
    ("zeta", "zeta", None),
    ("alpha", "alpha", None),
    ("gamma", "gamma", None),
    ("mu", "mu", None),
    ("left", "left", None),
    ("right", "right", None),
    ("start", "start", tuple),
)


@dataclass(frozen=True, eq=False, repr=False)
class PrimarySample(Document):
    """Both bodies at a time.

    Attributes:
        t: The time.
        x: The angle of the pendulum.
        velocity: Its velocity.
        y: The displacement of the main mass.
        speed: Its velocity.
    """

    t: float
    x: float
    velocity: float
    y: float
    speed: float


PrimarySample.FIELDS = (
    ("t", "t", None),
    ("x", "x", None),
    ("velocity", "velocity", None),
    ("y", "y", None),
    ("speed", "speed", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class PrimaryImpact(Document):
    """An impact.

    Attributes:
        side: The barrier: `left` or `right`.
        entry_time: When it is touched; 0 where the motion starts inside it.
        exit_time: When it is left; null where the run ends before.
        speed_in: The speed of the pendulum towards the barrier at the touch; where the motion
            starts inside it, the speed inwards then.
        speed_out: Its speed away from it at the release; null where the run ends before.
        penetration: The greatest depth, in radians.
        energy_lost: The energy that the contact took.
    """

    side: str
    entry_time: float
    exit_time: float | None
    speed_in: float
    speed_out: float | None
    penetration: float
    energy_lost: float


PrimaryImpact.FIELDS = (
    ("side", "side", None),
    ("entry_time", "entry_time", None),
    ("exit_time", "exit_time", None),
    ("speed_in", "speed_in", None),
    ("speed_out", "speed_out", None),
    ("penetration", "penetration", None),
    ("energy_lost", "energy_lost", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class PrimaryEnergyDocument(Document):
    """The account of the energy.

    Attributes:
        start: At the start.
        end: At the end.
        viscous: Taken by the viscous damping of the pendulum.
        friction: Taken by its dry friction.
        contact: Taken by the contacts.
        dashpot: Taken by the dashpot of the main mass.
        force: Put in by the force.
        residual: What is not accounted for, over the largest energy.
    """

    start: float
    end: float
    viscous: float
    friction: float
    contact: float
    dashpot: float
    force: float
    residual: float


PrimaryEnergyDocument.FIELDS = (
    ("start", "start", None),
    ("end", "end", None),
    ("viscous", "viscous", None),
    ("friction", "friction", None),
    ("contact", "contact", None),
    ("dashpot", "dashpot", None),
    ("force", "force", None),
    ("residual", "residual", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Alone(Document):
    """A main mass alone, in closed form.

    Attributes:
        mass: Its mass, in units of the mass of the pendulum.
        frequency: Its angular frequency, damped; 0 where it creeps.
        rest_time: When its envelope has fallen to a tenth; null where it never does, creeps, or a
            force drives it.
        amplitude: Its amplitude in the long run; null where no force drives it.
    """

    mass: float
    frequency: float
    rest_time: float | None
    amplitude: float | None


Alone.FIELDS = (
    ("mass", "mass", None),
    ("frequency", "frequency", None),
    ("rest_time", "rest_time", None),
    ("amplitude", "amplitude", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class PrimaryJudge(Document):
    """The motion of a chain by integration.

    Attributes:
        rest_time: When the envelope of the main mass has fallen to a tenth, for good; null where
            it never does, and where a force drives it.
        long_run: The largest displacement of the main mass in the last quarter of the run.
        impacts: The number of impacts.
    """

    rest_time: float | None
    long_run: float
    impacts: int


PrimaryJudge.FIELDS = (
    ("rest_time", "rest_time", None),
    ("long_run", "long_run", None),
    ("impacts", "impacts", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Primary(Answer):
    """A main mass on spring and dashpot with a pendulum and its barriers. Time is in units of
    1/omega, omega^2 = g/L, displacements of the main mass are over L, energies in units of m g
    L, angles in radians.

    Attributes:
        schema: The kind of document.
        parameters: The numbers of both bodies.
        time_unit: One unit of time, in seconds.
        length_unit: One unit of displacement of the main mass, L, in metres.
        samples: The states at the times asked for.
        final_state: The state at the end.
        impacts: Every impact on a barrier.
        energy: What became of the energy.
        rest_time: When the envelope of the main mass has fallen to a tenth, for good; null where
            it never does, and where a force drives it.
        rest_reason: Why there is none; null where there is one.
        long_run: The largest displacement of the main mass in the last quarter of the run.
        without: The same main mass without its damper, in closed form.
        locked: The same with the damper locked, in closed form.
        route: How the motion was found: by `integration`, or as a `chain` of closed forms.
        integrated_phases: The number of phases of a chain that were integrated for want of a
            closed form; null where the motion was integrated.
        judge: The motion of a chain by integration; null where the motion was integrated.
        nearby_rest_times: The least and the greatest rest time by closed forms of starts 0.03 %
            smaller and larger: where they are apart, closed forms cannot give this one; null
            where the motion was integrated, or one of them does not rest.
        stopped: Why the run ended.
        complete: Whether it was followed as long as asked, and its energy is accounted for.
    """

    schema: Literal["lindstedt/primary/1"]
    parameters: PrimaryParameters
    time_unit: float
    length_unit: float
    samples: tuple[PrimarySample, ...]
    final_state: PrimarySample
    impacts: tuple[PrimaryImpact, ...]
    energy: PrimaryEnergyDocument
    rest_time: float | None
    rest_reason: str | None
    long_run: float
    without: Alone
    locked: Alone
    route: Literal["integration", "chain"]
    integrated_phases: int | None
    judge: PrimaryJudge | None
    nearby_rest_times: tuple[float, float] | None
    stopped: str
    complete: bool


Primary.FIELDS = (
    ("schema", "schema", None),
    ("parameters", "parameters", PrimaryParameters.from_json),
    ("time_unit", "time_unit", None),
    ("length_unit", "length_unit", None),
    ("samples", "samples", several(PrimarySample.from_json)),
    ("final_state", "final_state", PrimarySample.from_json),
    ("impacts", "impacts", several(PrimaryImpact.from_json)),
    ("energy", "energy", PrimaryEnergyDocument.from_json),
    ("rest_time", "rest_time", None),
    ("rest_reason", "rest_reason", None),
    ("long_run", "long_run", None),
    ("without", "without", Alone.from_json),
    ("locked", "locked", Alone.from_json),
    ("route", "route", None),
    ("integrated_phases", "integrated_phases", None),
    ("judge", "judge", PrimaryJudge.from_json),
    ("nearby_rest_times", "nearby_rest_times", tuple),
    ("stopped", "stopped", None),
    ("complete", "complete", None),
)
