"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer
from .._document import Document, mapped, several
from .common import Constant


@dataclass(frozen=True, eq=False, repr=False)
class OneHarmonicFamily(Document):
    """A family of modes: formulas of two of ratio, A^2 and omega^2 in the parameter of the family.

    Attributes:
        along: The parameter: `amplitude` of a similar mode, `ratio` or `frequency`.
        ratio: The ratio, a formula; null where it is the parameter.
        amplitude_squared: A^2, a formula; null where A is the parameter.
        omega_squared: omega^2, a formula; null where omega is the parameter.
    """

    along: str
    ratio: str | None
    amplitude_squared: str | None
    omega_squared: str | None


OneHarmonicFamily.FIELDS = (
    ("along", "along", None),
    ("ratio", "ratio", None),
    ("amplitude_squared", "amplitude_squared", None),
    ("omega_squared", "omega_squared", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class OneHarmonicBranchPoint(Document):
    """A place where another family branches off a similar mode.

    Attributes:
        ratio: The ratio of the similar mode.
        quantity: What is fixed there: the square of the amplitude, or a letter.
        value: Its value, a formula.
    """

    ratio: str
    quantity: str
    value: str


OneHarmonicBranchPoint.FIELDS = (
    ("ratio", "ratio", None),
    ("quantity", "quantity", None),
    ("value", "value", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class OneHarmonicMotion(Document):
    """A mode at an amplitude beside the true motion.

    Attributes:
        family: The number of its family, from 1.
        ratio: The ratio.
        omega: omega.
        true_omega: omega of the true motion from the same start of the first coordinate; null if
            none was found near.
        relative_error: `omega/true_omega - 1`; null without a true motion.
    """

    family: int
    ratio: float
    omega: float
    true_omega: float | None
    relative_error: float | None


OneHarmonicMotion.FIELDS = (
    ("family", "family", None),
    ("ratio", "ratio", None),
    ("omega", "omega", None),
    ("true_omega", "true_omega", None),
    ("relative_error", "relative_error", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class OneHarmonic(Answer):
    """Normal modes with one harmonic: the second coordinate is the ratio times the first.

    Attributes:
        schema: The kind of document.
        equations: The equations as they were understood.
        coordinates: The coordinates.
        parameters: The letters of the equations, in alphabetical order.
        method: The method: `harmonic-balance`.
        amplitude_symbol: The symbol of the amplitude, the start of the first coordinate.
        ratio_symbol: The symbol of the ratio.
        families: The families of modes.
        branch_points: The places where another family branches off a similar mode.
        definitions: What the formulas name.
        at: The values; null without them.
        motions: The modes that have the amplitude, the slowest first.
        verdict: `pass` or `fail`; null without values.
        tolerance: The largest relative error that passes; null without values.
    """

    schema: Literal["lindstedt/one-harmonic/1"]
    equations: tuple[str, ...]
    coordinates: tuple[str, ...]
    parameters: tuple[str, ...]
    method: str
    amplitude_symbol: str
    ratio_symbol: str
    families: tuple[OneHarmonicFamily, ...]
    branch_points: tuple[OneHarmonicBranchPoint, ...]
    definitions: dict[str, str]
    at: dict[str, Constant] | None
    motions: tuple[OneHarmonicMotion, ...]
    verdict: str | None
    tolerance: float | None


OneHarmonic.FIELDS = (
    ("schema", "schema", None),
    ("equations", "equations", tuple),
    ("coordinates", "coordinates", tuple),
    ("parameters", "parameters", tuple),
    ("method", "method", None),
    ("amplitude_symbol", "amplitude_symbol", None),
    ("ratio_symbol", "ratio_symbol", None),
    ("families", "families", several(OneHarmonicFamily.from_json)),
    ("branch_points", "branch_points", several(OneHarmonicBranchPoint.from_json)),
    ("definitions", "definitions", dict),
    ("at", "at", mapped(Constant.from_json)),
    ("motions", "motions", several(OneHarmonicMotion.from_json)),
    ("verdict", "verdict", None),
    ("tolerance", "tolerance", None),
)
