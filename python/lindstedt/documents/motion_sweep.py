"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer
from .._document import Document, mapped, several
from .common import MotionSample, Section


@dataclass(frozen=True, eq=False, repr=False)
class SweptMotion(Document):
    """One of many motions.

    Attributes:
        values: The values of what is varied.
        final_state: Those at the end.
        extremes: The least and the greatest value of each coordinate.
        section: The states on the section; null where none was asked for.
        impacts: The number of impacts on walls; left out without a wall.
        events: The number of events; left out without one.
        attractor: The attractor on which it settles, counted from 0; left out if it settles on
            none.
        stopped: Why it ends where it does.
        complete: Whether it was followed as long as asked.
    """

    values: dict[str, float]
    final_state: MotionSample
    extremes: dict[str, tuple[float, float]]
    section: Section | None
    impacts: int | None
    events: int | None
    attractor: int | None
    stopped: str
    complete: bool


SweptMotion.FIELDS = (
    ("values", "values", dict),
    ("final_state", "final_state", MotionSample.from_json),
    ("extremes", "extremes", mapped(tuple)),
    ("section", "section", Section.from_json),
    ("impacts", "impacts", None),
    ("events", "events", None),
    ("attractor", "attractor", None),
    ("stopped", "stopped", None),
    ("complete", "complete", None),
)
SweptMotion.OPTIONAL = frozenset(['attractor', 'events', 'impacts'])


@dataclass(frozen=True, eq=False, repr=False)
class Attractor(Document):
    """A motion that repeats itself on a section, on which others settle.

    Attributes:
        states: Its states on the section in their order, coordinates and velocities.
        motions: The number of motions that settle on it.
    """

    states: tuple[dict[str, float], ...]
    motions: int


Attractor.FIELDS = (
    ("states", "states", several(dict)),
    ("motions", "motions", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class MotionSweep(Answer):
    """Many motions of one equation or mechanism, over every combination of the values of some
    parameters or starts.

    Attributes:
        schema: The kind of document.
        coordinates: The coordinates.
        equations: The equations of motion, each `... = 0`.
        parameters: The value of every parameter that is not varied.
        start: Coordinates and velocities at t = 0, where they are not varied.
        duration: How long each motion is followed.
        after: From when on extremes and section count.
        varied: What is varied; the last varies fastest.
        motions: The motions, in order.
        attractors: The attractors on which motions from many starts settle, that of the most
            motions first; left out where anything but a start is varied, or without a section.
    """

    schema: Literal["lindstedt/motion-sweep/1"]
    coordinates: tuple[str, ...]
    equations: tuple[str, ...]
    parameters: dict[str, float]
    start: dict[str, float]
    duration: float
    after: float
    varied: tuple[str, ...]
    motions: tuple[SweptMotion, ...]
    attractors: tuple[Attractor, ...] | None


MotionSweep.FIELDS = (
    ("schema", "schema", None),
    ("coordinates", "coordinates", tuple),
    ("equations", "equations", tuple),
    ("parameters", "parameters", dict),
    ("start", "start", dict),
    ("duration", "duration", None),
    ("after", "after", None),
    ("varied", "varied", tuple),
    ("motions", "motions", several(SweptMotion.from_json)),
    ("attractors", "attractors", several(Attractor.from_json)),
)
MotionSweep.OPTIONAL = frozenset(['attractors'])
