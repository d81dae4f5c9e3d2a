"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer
from .._document import Document, several


@dataclass(frozen=True, eq=False, repr=False)
class Group(Document):
    """A dimensionless number.

    Attributes:
        name: Its name in `dimensionless`.
        definition: What it is in the parameters.
        dimension: The unit of the definition, counted from those of the parameters: `1`.
        meaning: What it does.
    """

    name: str
    definition: str
    dimension: str
    meaning: str


Group.FIELDS = (
    ("name", "name", None),
    ("definition", "definition", None),
    ("dimension", "dimension", None),
    ("meaning", "meaning", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Equilibrium(Document):
    """A place of rest.

    Attributes:
        places: The place of each coordinate; null for one that may be anywhere.
        cosine: What lies between -1 and 1 where the place exists; null where it always does.
        frequency_squared: omega^2 of small swings about it, negative where it is unstable; null
            for several coordinates, and where the linear equation changes with the time other
            than by sines and cosines of it.
    """

    places: dict[str, str | None]
    cosine: str | None
    frequency_squared: str | None


Equilibrium.FIELDS = (
    ("places", "places", dict),
    ("cosine", "cosine", None),
    ("frequency_squared", "frequency_squared", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Mode(Document):
    """A mode.

    Attributes:
        frequency: Angular frequency; 0 where it does not swing.
        growth: The exponent of growth, negative for decay, per unit of time.
        shape: The coordinates in proportion, the largest 1; null where damping makes them move
            out of step.
    """

    frequency: float
    growth: float
    shape: tuple[float, ...] | None


Mode.FIELDS = (
    ("frequency", "frequency", None),
    ("growth", "growth", None),
    ("shape", "shape", tuple),
)


@dataclass(frozen=True, eq=False, repr=False)
class Finding(Document):
    """An equation of the paper.

    Attributes:
        equation: Its number: `(1)`.
        printed: What is printed.
        agrees: Whether it follows as it is printed; null where it is put in and not derived.
        words: What was found, in words.
    """

    equation: str
    printed: str
    agrees: bool | None
    words: str


Finding.FIELDS = (
    ("equation", "equation", None),
    ("printed", "printed", None),
    ("agrees", "agrees", None),
    ("words", "words", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Lagrangian(Answer):
    """A mechanism, its equations of motion by Lagrange, its places of rest and the dimensionless
    groups on which its motion depends. Formulas are text of the grammar; `q'` is the velocity
    of `q`. Numbers are in the units of the values that were given.

    Attributes:
        schema: The kind of document.
        coordinates: The generalised coordinates, in the order of the equations.
        kinetic: T, the kinetic energy.
        potential: V, the potential energy.
        dissipation: D, Rayleigh's dissipation function; `0` where there is none.
        forces: The generalised force on each coordinate that has one.
        equations: The equations of motion, each `... = 0`.
        divisors: What each was divided by.
        accelerations: The accelerations, solved for.
        units_checked: Whether every term was checked for its unit: only where units were given.
        units: The parameters that give the units of the dimensionless form, and behind them the
            sizes of the motion that do, `x0` of the coordinate x, where no product of parameters
            has its unit; null without units or where there is none.
        combinations: The sums of parameters that count as one parameter, by their names in what
            follows; null likewise.
        time_unit: The unit of time in them; null likewise.
        parameter_count: The number of parameters of the equations; null likewise.
        rank: The rank of the matrix of their dimensions, with those of the sizes that are units;
            null likewise.
        groups: The dimensionless numbers on which the motion depends; null likewise.
        dimensionless: The equations in these units and groups; null likewise.
        no_groups: Why there are no groups; null where there are, and without units.
        values: The values that were given.
        equilibria: Places of rest that were found; others are not ruled out. Contacts and terms
            in the time are left out.
        modes: The modes at each of them, in the same order; an empty list where not every
            parameter has a value.
        findings: The paper's equations beside these; empty for any other mechanism.
    """

    schema: Literal["lindstedt/lagrangian/1"]
    coordinates: tuple[str, ...]
    kinetic: str
    potential: str
    dissipation: str
    forces: dict[str, str]
    equations: tuple[str, ...]
    divisors: tuple[str, ...]
    accelerations: dict[str, str]
    units_checked: bool
    units: tuple[str, ...] | None
    combinations: dict[str, str] | None
    time_unit: str | None
    parameter_count: int | None
    rank: int | None
    groups: tuple[Group, ...] | None
    dimensionless: tuple[str, ...] | None
    no_groups: str | None
    values: dict[str, float]
    equilibria: tuple[Equilibrium, ...]
    modes: tuple[tuple[Mode, ...], ...]
    findings: tuple[Finding, ...]


Lagrangian.FIELDS = (
    ("schema", "schema", None),
    ("coordinates", "coordinates", tuple),
    ("kinetic", "kinetic", None),
    ("potential", "potential", None),
    ("dissipation", "dissipation", None),
    ("forces", "forces", dict),
    ("equations", "equations", tuple),
    ("divisors", "divisors", tuple),
    ("accelerations", "accelerations", dict),
    ("units_checked", "units_checked", None),
    ("units", "units", tuple),
    ("combinations", "combinations", dict),
    ("time_unit", "time_unit", None),
    ("parameter_count", "parameter_count", None),
    ("rank", "rank", None),
    ("groups", "groups", several(Group.from_json)),
    ("dimensionless", "dimensionless", tuple),
    ("no_groups", "no_groups", None),
    ("values", "values", dict),
    ("equilibria", "equilibria", several(Equilibrium.from_json)),
    ("modes", "modes", several(several(Mode.from_json))),
    ("findings", "findings", several(Finding.from_json)),
)
