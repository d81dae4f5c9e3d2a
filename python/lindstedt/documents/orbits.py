"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer
from .._document import Document, mapped, several
from .common import Constant


@dataclass(frozen=True, eq=False, repr=False)
class OrbitWall(Document):
    """A rigid wall.

    Attributes:
        gap: The gap: positive where motions are allowed.
        restitution: The coefficient of restitution.
    """

    gap: str
    restitution: str


OrbitWall.FIELDS = (
    ("gap", "gap", None),
    ("restitution", "restitution", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class OrbitRelation(Document):
    """An equation of an orbit.

    Attributes:
        name: The name: `speed`, `phase`, `wave-velocity`, `wave-position`, `trace`,
            `determinant`, `multipliers`; of a curve `grazing`, `fold`, `period-doubling`,
            `symmetry-breaking`.
        equation: The equation.
        words: The equation in words.
    """

    name: str
    equation: str
    words: str


OrbitRelation.FIELDS = (
    ("name", "name", None),
    ("equation", "equation", None),
    ("words", "words", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class OrbitLaws(Document):
    """The laws of orbits in letters. The speed is that relative to the wall, just before the impact.

    Attributes:
        kind: The orbits: `one-impact`, or `symmetric` with one impact on each of two walls.
        wall: The number of the wall, from 1.
        gap: The letter of the gap.
        gap_equation: The equation of the gap between impacts.
        definitions: The symbols that shorten the formulas, each of those before it.
        relations: Speed, phase, trace, determinant and multipliers.
        curves: The curves in the parameters at which the orbits change.
        validity: Conventions, and where the formulas hold.
    """

    kind: str
    wall: int
    gap: str
    gap_equation: str
    definitions: dict[str, str]
    relations: tuple[OrbitRelation, ...]
    curves: tuple[OrbitRelation, ...]
    validity: tuple[str, ...]


OrbitLaws.FIELDS = (
    ("kind", "kind", None),
    ("wall", "wall", None),
    ("gap", "gap", None),
    ("gap_equation", "gap_equation", None),
    ("definitions", "definitions", dict),
    ("relations", "relations", several(OrbitRelation.from_json)),
    ("curves", "curves", several(OrbitRelation.from_json)),
    ("validity", "validity", tuple),
)


@dataclass(frozen=True, eq=False, repr=False)
class OrbitMultiplier(Document):
    """A Floquet multiplier.

    Attributes:
        re: The real part.
        im: The imaginary part.
    """

    re: float
    im: float


OrbitMultiplier.FIELDS = (
    ("re", "re", None),
    ("im", "im", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Orbit(Document):
    """An orbit.

    Attributes:
        kind: The way it was found: `one-impact` or `symmetric` in closed form, or `searched`.
        impacts: The number of impacts in its period.
        periods: The number of periods of the drive in its period.
        walls: The number of the wall of each impact, from 1.
        times: The time of each impact, as in the equation.
        phases: The phase of the drive at each impact, from 0 to 2 pi.
        speeds: The speed of each impact, relative to the wall, just before it.
        multipliers: The Floquet multipliers over its period.
        stable: Whether all multipliers lie within the unit circle.
        stability: `stable`, `marginal` with a multiplier on the unit circle, or `unstable`.
        admissible: Whether a motion follows it: between impacts it is beyond no wall.
        reason: Why no motion follows it; null of one that motions follow.
        return_error: The distance of a simulation from its start after a period of the orbit,
            over the impact speed; null where none was followed.
        simulated_multipliers: The multipliers of the simulation; null likewise.
        verdict: The verdict of the simulation, `pass` or `fail`; null likewise.
    """

    kind: str
    impacts: int
    periods: int
    walls: tuple[int, ...]
    times: tuple[float, ...]
    phases: tuple[float, ...]
    speeds: tuple[float, ...]
    multipliers: tuple[OrbitMultiplier, ...]
    stable: bool
    stability: str
    admissible: bool
    reason: str | None
    return_error: float | None
    simulated_multipliers: tuple[OrbitMultiplier, ...] | None
    verdict: str | None


Orbit.FIELDS = (
    ("kind", "kind", None),
    ("impacts", "impacts", None),
    ("periods", "periods", None),
    ("walls", "walls", tuple),
    ("times", "times", tuple),
    ("phases", "phases", tuple),
    ("speeds", "speeds", tuple),
    ("multipliers", "multipliers", several(OrbitMultiplier.from_json)),
    ("stable", "stable", None),
    ("stability", "stability", None),
    ("admissible", "admissible", None),
    ("reason", "reason", None),
    ("return_error", "return_error", None),
    ("simulated_multipliers", "simulated_multipliers", several(OrbitMultiplier.from_json)),
    ("verdict", "verdict", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class OrbitBranch(Document):
    """Orbits of one kind along the parameter.

    Attributes:
        kind: `one-impact` or `symmetric`.
        wall: The number of the wall, from 1.
        periods: The number of periods of the drive.
        parameters: The parameter of each orbit.
        speeds: The speed just before the impact of each.
        phases: The phase of the drive at the impact of each.
        stable: Whether each is stable.
        admissible: Whether a motion follows each.
    """

    kind: str
    wall: int
    periods: int
    parameters: tuple[float, ...]
    speeds: tuple[float, ...]
    phases: tuple[float, ...]
    stable: tuple[bool, ...]
    admissible: tuple[bool, ...]


OrbitBranch.FIELDS = (
    ("kind", "kind", None),
    ("wall", "wall", None),
    ("periods", "periods", None),
    ("parameters", "parameters", tuple),
    ("speeds", "speeds", tuple),
    ("phases", "phases", tuple),
    ("stable", "stable", tuple),
    ("admissible", "admissible", tuple),
)


@dataclass(frozen=True, eq=False, repr=False)
class OrbitChange(Document):
    """A place where orbits change.

    Attributes:
        kind: `grazing`, `fold`, `period-doubling`, `symmetry-breaking`, or `second-impact`, where
            an orbit touches a wall between impacts.
        wall: The number of the wall, from 1.
        periods: The number of periods of the drive of the orbit.
        parameter: The parameter.
        speed: The speed there; null of grazing.
    """

    kind: str
    wall: int
    periods: int
    parameter: float
    speed: float | None


OrbitChange.FIELDS = (
    ("kind", "kind", None),
    ("wall", "wall", None),
    ("periods", "periods", None),
    ("parameter", "parameter", None),
    ("speed", "speed", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class OrbitSweep(Document):
    """Orbits along a parameter.

    Attributes:
        parameter: The parameter.
        range: The beginning and the end of its range.
        branches: The branches.
        changes: The places where orbits change, in order of the parameter.
    """

    parameter: str
    range: tuple[float, float]
    branches: tuple[OrbitBranch, ...]
    changes: tuple[OrbitChange, ...]


OrbitSweep.FIELDS = (
    ("parameter", "parameter", None),
    ("range", "range", tuple),
    ("branches", "branches", several(OrbitBranch.from_json)),
    ("changes", "changes", several(OrbitChange.from_json)),
)


@dataclass(frozen=True, eq=False, repr=False)
class OrbitCurve(Document):
    """A curve of a chart.

    Attributes:
        kind: `grazing`, `fold`, `period-doubling`, `symmetry-breaking`, or `second-impact`, where
            an orbit touches a wall between impacts.
        wall: The number of the wall, from 1.
        periods: The number of periods of the drive of the orbit.
        pieces: The pieces of the curve: of each its points, across and upwards.
    """

    kind: str
    wall: int
    periods: int
    pieces: tuple[tuple[tuple[float, float], ...], ...]


OrbitCurve.FIELDS = (
    ("kind", "kind", None),
    ("wall", "wall", None),
    ("periods", "periods", None),
    ("pieces", "pieces", several(several(tuple))),
)


@dataclass(frozen=True, eq=False, repr=False)
class OrbitFamily(Document):
    """Orbits of one kind in a chart.

    Attributes:
        kind: `one-impact` or `symmetric`.
        wall: The number of the wall, from 1.
        periods: The number of periods of the drive.
        orbits: A text for each row, from below, a digit for each point: the number of orbits that
            motions follow.
        stable: The number of stable ones among them, likewise.
    """

    kind: str
    wall: int
    periods: int
    orbits: tuple[str, ...]
    stable: tuple[str, ...]


OrbitFamily.FIELDS = (
    ("kind", "kind", None),
    ("wall", "wall", None),
    ("periods", "periods", None),
    ("orbits", "orbits", tuple),
    ("stable", "stable", tuple),
)


@dataclass(frozen=True, eq=False, repr=False)
class OrbitChart(Document):
    """Orbits over two parameters.

    Attributes:
        across: The parameter across.
        across_range: The beginning and the end of its range.
        upwards: The parameter upwards.
        upwards_range: The beginning and the end of its range.
        columns: Points in a row, which lie equally far from one end of its range to the other.
        rows: Rows, likewise.
        families: The kinds of orbits.
        curves: The curves at which orbits change.
    """

    across: str
    across_range: tuple[float, float]
    upwards: str
    upwards_range: tuple[float, float]
    columns: int
    rows: int
    families: tuple[OrbitFamily, ...]
    curves: tuple[OrbitCurve, ...]


OrbitChart.FIELDS = (
    ("across", "across", None),
    ("across_range", "across_range", tuple),
    ("upwards", "upwards", None),
    ("upwards_range", "upwards_range", tuple),
    ("columns", "columns", None),
    ("rows", "rows", None),
    ("families", "families", several(OrbitFamily.from_json)),
    ("curves", "curves", several(OrbitCurve.from_json)),
)


@dataclass(frozen=True, eq=False, repr=False)
class Orbits(Answer):
    """Periodic motions that are linear between impacts on rigid walls.

    Attributes:
        schema: The kind of document.
        equation: The left side of the equation of motion, zero on the right.
        coordinate: The coordinate.
        walls: The walls.
        laws: The laws in letters, one for each wall, before them that of symmetric orbits between
            two walls placed alike.
        at: The values; null without them.
        orbits: The orbits at these values, fewer periods first, then the faster; null without
            values, and of a sweep or a chart.
        degenerate_periods: Numbers of periods in whose time the free motion returns to itself, so
            that there is no orbit; null likewise.
        sweep: The orbits along a parameter; null without one.
        chart: The orbits over two parameters; null without them.
        verdict: Whether a simulation returns to every orbit that motions follow, `pass` or
            `fail`; null where there is none, and without values.
        tolerance: The largest error that passes; null without orbits.
    """

    schema: Literal["lindstedt/orbits/1"]
    equation: str
    coordinate: str
    walls: tuple[OrbitWall, ...]
    laws: tuple[OrbitLaws, ...]
    at: dict[str, Constant] | None
    orbits: tuple[Orbit, ...] | None
    degenerate_periods: tuple[int, ...] | None
    sweep: OrbitSweep | None
    chart: OrbitChart | None
    verdict: str | None
    tolerance: float | None


Orbits.FIELDS = (
    ("schema", "schema", None),
    ("equation", "equation", None),
    ("coordinate", "coordinate", None),
    ("walls", "walls", several(OrbitWall.from_json)),
    ("laws", "laws", several(OrbitLaws.from_json)),
    ("at", "at", mapped(Constant.from_json)),
    ("orbits", "orbits", several(Orbit.from_json)),
    ("degenerate_periods", "degenerate_periods", tuple),
    ("sweep", "sweep", OrbitSweep.from_json),
    ("chart", "chart", OrbitChart.from_json),
    ("verdict", "verdict", None),
    ("tolerance", "tolerance", None),
)
