"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer
from .._document import Document, several
from .common import Event, MotionSample, Section, Wall


@dataclass(frozen=True, eq=False, repr=False)
class EnergyAccount(Document):
    """h = sum q' dL/dq' - L, the energy where nothing depends on the time.

    Attributes:
        start: At the start.
        end: At the end.
        work: The work of forces, dampers and moving constraints in between.
        works: The work of each of them by its name: a term of the equation, as it stands on the
            left side; `Q_x`, `dissipation`.
        residual: The largest part not accounted for at any time, over the largest energy.
    """

    start: float
    end: float
    work: float
    works: dict[str, float]
    residual: float


EnergyAccount.FIELDS = (
    ("start", "start", None),
    ("end", "end", None),
    ("work", "work", None),
    ("works", "works", dict),
    ("residual", "residual", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class LyapunovExponent(Document):
    """The largest Lyapunov exponent of a motion.

    Attributes:
        value: The exponent, per unit of time.
        standard_error: Its standard error.
        from_: The time from which on the motion counts.
    """

    value: float
    standard_error: float
    from_: float


LyapunovExponent.FIELDS = (
    ("value", "value", None),
    ("standard_error", "standard_error", None),
    ("from_", "from", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class WallImpact(Document):
    """An impact on a wall.

    Attributes:
        t: The time.
        wall: The wall, counted from 0.
        speed: The rate at which the gap closes before the impact: a speed where the gap is a
            distance.
        departure: The speed at which it opens after the impact; 0 for the one after which the
            rest of an accumulation is summed.
        energy_lost: The energy that the impact takes; null where no energy is accounted for.
    """

    t: float
    wall: int
    speed: float
    departure: float
    energy_lost: float | None


WallImpact.FIELDS = (
    ("t", "t", None),
    ("wall", "wall", None),
    ("speed", "speed", None),
    ("departure", "departure", None),
    ("energy_lost", "energy_lost", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class WallRest(Document):
    """A stretch of time on which a motion rests on a wall.

    Attributes:
        wall: The wall, counted from 0.
        from_: The time at which it begins.
        until: The time at which the wall no longer presses, or the motion ends.
        after_chatter: Whether infinitely many impacts came before it.
    """

    wall: int
    from_: float
    until: float
    after_chatter: bool


WallRest.FIELDS = (
    ("wall", "wall", None),
    ("from_", "from", None),
    ("until", "until", None),
    ("after_chatter", "after_chatter", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class WallsDocument(Document):
    """Rigid walls, the impacts on them and the rests.

    Attributes:
        walls: The walls.
        impacts: The impacts in order; of an accumulation those before its sum.
        rests: The stretches of time on which the motion rests on a wall.
        order_matters: The first time at which several walls were hit at once and the order of the
            impacts matters; left out if there is none.
    """

    walls: tuple[Wall, ...]
    impacts: tuple[WallImpact, ...]
    rests: tuple[WallRest, ...]
    order_matters: float | None


WallsDocument.FIELDS = (
    ("walls", "walls", several(Wall.from_json)),
    ("impacts", "impacts", several(WallImpact.from_json)),
    ("rests", "rests", several(WallRest.from_json)),
    ("order_matters", "order_matters", None),
)
WallsDocument.OPTIONAL = frozenset(['order_matters'])


@dataclass(frozen=True, eq=False, repr=False)
class EventOccurrence(Document):
    """An event that took place.

    Attributes:
        t: The time.
        event: The event, counted from 0.
        before: Coordinates and velocities before it.
        after: Coordinates and velocities behind it.
        energy_lost: The energy that the event takes, negative where it gives some; null where no
            energy is accounted for.
    """

    t: float
    event: int
    before: dict[str, float]
    after: dict[str, float]
    energy_lost: float | None


EventOccurrence.FIELDS = (
    ("t", "t", None),
    ("event", "event", None),
    ("before", "before", dict),
    ("after", "after", dict),
    ("energy_lost", "energy_lost", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class EventsDocument(Document):
    """The events of a motion.

    Attributes:
        events: The events.
        occurrences: The times at which they took place, in order.
        order_matters: The first time at which several events took place at once and their order
            matters; left out if there is none.
    """

    events: tuple[Event, ...]
    occurrences: tuple[EventOccurrence, ...]
    order_matters: float | None


EventsDocument.FIELDS = (
    ("events", "events", several(Event.from_json)),
    ("occurrences", "occurrences", several(EventOccurrence.from_json)),
    ("order_matters", "order_matters", None),
)
EventsDocument.OPTIONAL = frozenset(['order_matters'])


@dataclass(frozen=True, eq=False, repr=False)
class Motion(Answer):
    """A motion in numbers, of an equation of motion or of a mechanism of several coordinates. Units
    are those of the values given.

    Attributes:
        schema: The kind of document.
        coordinates: The coordinates.
        equations: The equations of motion, each `... = 0`.
        parameters: The value of every parameter.
        start: Coordinates and velocities at t = 0.
        integrator: By which integrator it was followed: `taylor` or `runge-kutta`.
        samples: Coordinates and velocities at the times asked for, or at 21 equally spaced ones.
        section: The states on the section; null where none was asked for.
        final_state: Those at the end.
        energy: The account of the energy; null for an equation whose inertia depends on the
            position, and without a value for a letter of the energies that cancels in the
            equations of motion.
        difference: The largest difference from the other integrator, over the largest
            displacement; null where it was not asked for.
        known_until: The time until which the states are known to six digits; beyond it a start
            displaced by 1e-12 of it leads elsewhere. Left out where they are known to the end.
        lyapunov: The largest Lyapunov exponent. Left out where the states are known to the end
            and it was not asked for.
        held: The stretches of time, from when until when, on which dry friction holds something:
            at rest, on a belt or on another body.
        static_friction: Static over sliding friction, a formula; left out where it was not given.
        walls: The walls with the impacts on them; left out without a wall.
        events: The events; left out without one.
        stopped: Why it ends where it does.
        complete: Whether it was followed as long as asked, its energy is accounted for and the
            other integrator, where asked for, agrees.
    """

    schema: Literal["lindstedt/motion/1"]
    coordinates: tuple[str, ...]
    equations: tuple[str, ...]
    parameters: dict[str, float]
    start: dict[str, float]
    integrator: str
    samples: tuple[MotionSample, ...]
    section: Section | None
    final_state: MotionSample
    energy: EnergyAccount | None
    difference: float | None
    known_until: float | None
    lyapunov: LyapunovExponent | None
    held: tuple[tuple[float, float], ...]
    static_friction: str | None
    walls: WallsDocument | None
    events: EventsDocument | None
    stopped: str
    complete: bool


Motion.FIELDS = (
    ("schema", "schema", None),
    ("coordinates", "coordinates", tuple),
    ("equations", "equations", tuple),
    ("parameters", "parameters", dict),
    ("start", "start", dict),
    ("integrator", "integrator", None),
    ("samples", "samples", several(MotionSample.from_json)),
    ("section", "section", Section.from_json),
    ("final_state", "final_state", MotionSample.from_json),
    ("energy", "energy", EnergyAccount.from_json),
    ("difference", "difference", None),
    ("known_until", "known_until", None),
    ("lyapunov", "lyapunov", LyapunovExponent.from_json),
    ("held", "held", several(tuple)),
    ("static_friction", "static_friction", None),
    ("walls", "walls", WallsDocument.from_json),
    ("events", "events", EventsDocument.from_json),
    ("stopped", "stopped", None),
    ("complete", "complete", None),
)
Motion.OPTIONAL = frozenset(['events', 'known_until', 'lyapunov', 'static_friction', 'walls'])
