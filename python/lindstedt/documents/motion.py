"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer
from .._document import Document, several
from .common import MotionSample, Section


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
        held: The stretches of time, from when until when, on which dry friction holds something:
            at rest, on a belt or on another body.
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
    held: tuple[tuple[float, float], ...]
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
    ("held", "held", several(tuple)),
    ("stopped", "stopped", None),
    ("complete", "complete", None),
)
Motion.OPTIONAL = frozenset(['known_until'])
