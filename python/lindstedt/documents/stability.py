"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer
from .._document import Document, mapped, several
from .common import Constant, Polynomial


@dataclass(frozen=True, eq=False, repr=False)
class TransitionCurve(Document):
    """A transition curve: `curve + sign*sqrt(under_root)`.

    Attributes:
        name: `a1`, `b1` for motions of cosines and of sines; `lower1`, `upper1` where they are of
            both.
        tongue: n: on the curve a motion of the frequency n*Omega/2 exists.
        multiplier: Floquet's multiplier of that motion over a period of the coefficients: 1 or
            -1.
        curve: The curve, or the middle of the two.
        under_root: What stands under the root; null where there is none.
        sign: The sign before the root: 1 or -1; 0 where there is none.
    """

    name: str
    tongue: int
    multiplier: int
    curve: Polynomial
    under_root: Polynomial | None
    sign: int


TransitionCurve.FIELDS = (
    ("name", "name", None),
    ("tongue", "tongue", None),
    ("multiplier", "multiplier", None),
    ("curve", "curve", Polynomial.from_json),
    ("under_root", "under_root", Polynomial.from_json),
    ("sign", "sign", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class JudgedCurve(Document):
    """A curve at the values.

    Attributes:
        name: Its name.
        value: The unknown by the formula; null where it is not real.
        true_value: The unknown in truth, by Hill's determinant and Floquet's multipliers; null
            where the tongue does not reach so far.
        relative_error: `value/true_value - 1`; null where one of them is null.
        verdict: `pass` or `fail`.
    """

    name: str
    value: float | None
    true_value: float | None
    relative_error: float | None
    verdict: str


JudgedCurve.FIELDS = (
    ("name", "name", None),
    ("value", "value", None),
    ("true_value", "true_value", None),
    ("relative_error", "relative_error", None),
    ("verdict", "verdict", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class StabilityVerification(Document):
    """The curves at values.

    Attributes:
        at: The values.
        tolerance: The relative error up to which a curve passes.
        curves: The curves, in the same order.
        verdict: Whether all of them pass: `pass` or `fail`.
    """

    at: dict[str, Constant]
    tolerance: float
    curves: tuple[JudgedCurve, ...]
    verdict: str


StabilityVerification.FIELDS = (
    ("at", "at", mapped(Constant.from_json)),
    ("tolerance", "tolerance", None),
    ("curves", "curves", several(JudgedCurve.from_json)),
    ("verdict", "verdict", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Stability(Answer):
    """The curves on which a linear equation with periodic coefficients changes between stable and
    unstable.

    Attributes:
        schema: The kind of document.
        equation: The equation as it was understood.
        unknown: The letter that the curves are solved for.
        gives: What a curve gives: that letter, or its square where it is a frequency.
        order: Highest power of the small parameters, all together, that is kept.
        small_parameters: What is small.
        parameters: The letters of the equation, in alphabetical order.
        frequency: The angular frequency of the coefficients, a formula.
        curves: The curves, by the number of their tongue.
        verification: The curves at values beside the truth; null without values.
    """

    schema: Literal["lindstedt/stability/1"]
    equation: str
    unknown: str
    gives: str
    order: int
    small_parameters: tuple[str, ...]
    parameters: tuple[str, ...]
    frequency: str
    curves: tuple[TransitionCurve, ...]
    verification: StabilityVerification | None


Stability.FIELDS = (
    ("schema", "schema", None),
    ("equation", "equation", None),
    ("unknown", "unknown", None),
    ("gives", "gives", None),
    ("order", "order", None),
    ("small_parameters", "small_parameters", tuple),
    ("parameters", "parameters", tuple),
    ("frequency", "frequency", None),
    ("curves", "curves", several(TransitionCurve.from_json)),
    ("verification", "verification", StabilityVerification.from_json),
)
