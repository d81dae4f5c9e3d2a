"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

from .._answer import Answer
from .._document import Document, mapped, one_of, several
from .common import Constant


@dataclass(frozen=True, eq=False, repr=False)
class Reach(Document):
    """How far a formula is good.

    Attributes:
        from_: The size of the amplitude from which on the error stays within the tolerance, for
            motions over several wells, which begin at the separatrix; null for those that begin
            at rest.
        up_to: The size of the amplitude at which the error first crosses the tolerance, in the
            unit of the coordinate, 0 where it does so at once; null where no crossing was found.
        searched: The size of the amplitude up to which was searched, where no crossing was found;
            null where one was.
    """

    from_: float | None
    up_to: float | None
    searched: float | None


Reach.FIELDS = (
    ("from_", "from", None),
    ("up_to", "up_to", None),
    ("searched", "searched", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class ApplyingRow(Document):
    """A method that applies.

    Attributes:
        method: The method, by its name on the command line.
        order: The highest power kept of the small parameter, inclusive; for a balance the number
            of harmonics, for iterations the passes.
        degrees: The degrees of an approximant, of numerator and denominator or of P, Q and R;
            null for every other method.
        applies: Whether the method applies.
        reason: Why there is no frequency at these values, in words; null where there is one.
        chosen: Values that the method left open: hbar as it was chosen, the coefficients of a
            balance as they were solved for.
        formula: The law as text, with the definitions that it needs.
        frequency: omega by the formula, in radians per unit of time; null where there is none.
        relative_error: frequency / true_frequency - 1, signed, as a fraction; null where one of
            them is not known.
        max_deviation: The largest |x - x_true| over one true period in real time, as a fraction
            of the amplitude; null where it is not known.
        reach: The range of the amplitude of the table's first row in which the error stays within
            the tolerance; null where it is not known.
        verdict: Whether |relative_error| is within the tolerance; null where the true frequency
            is not known.
    """

    method: Literal["lindstedt-poincare", "homotopy-perturbation", "homotopy-analysis", "iteration-perturbation", "parameter-expansion", "harmonic-balance", "energy-balance", "max-min", "amplitude-frequency", "hamiltonian", "variational-iteration", "frequency-formula", "averaging", "pade", "hermite-pade", "multiple-scales", "exact"]
    order: int
    degrees: tuple[int, ...] | None
    applies: Literal[True]
    reason: str | None
    chosen: dict[str, float]
    formula: str
    frequency: float | None
    relative_error: float | None
    max_deviation: float | None
    reach: Reach | None
    verdict: Literal["pass", "fail"] | None


ApplyingRow.FIELDS = (
    ("method", "method", None),
    ("order", "order", None),
    ("degrees", "degrees", tuple),
    ("applies", "applies", None),
    ("reason", "reason", None),
    ("chosen", "chosen", dict),
    ("formula", "formula", None),
    ("frequency", "frequency", None),
    ("relative_error", "relative_error", None),
    ("max_deviation", "max_deviation", None),
    ("reach", "reach", Reach.from_json),
    ("verdict", "verdict", None),
)
ApplyingRow.CONSTANTS = {'applies': True}


@dataclass(frozen=True, eq=False, repr=False)
class RefusedRow(Document):
    """A method that does not apply.

    Attributes:
        method: The method, by its name on the command line.
        order: Null.
        applies: Whether the method applies.
        reason: Why it does not, in words.
        formula: Null.
        frequency: Null.
        relative_error: Null.
        max_deviation: Null.
        reach: Null.
        verdict: Null.
    """

    method: Literal["lindstedt-poincare", "homotopy-perturbation", "homotopy-analysis", "iteration-perturbation", "parameter-expansion", "harmonic-balance", "energy-balance", "max-min", "amplitude-frequency", "hamiltonian", "variational-iteration", "frequency-formula", "averaging", "pade", "hermite-pade", "multiple-scales", "exact"]
    order: None
    applies: Literal[False]
    reason: str
    formula: None
    frequency: None
    relative_error: None
    max_deviation: None
    reach: None
    verdict: None


RefusedRow.FIELDS = (
    ("method", "method", None),
    ("order", "order", None),
    ("applies", "applies", None),
    ("reason", "reason", None),
    ("formula", "formula", None),
    ("frequency", "frequency", None),
    ("relative_error", "relative_error", None),
    ("max_deviation", "max_deviation", None),
    ("reach", "reach", None),
    ("verdict", "verdict", None),
)
RefusedRow.CONSTANTS = {'applies': False}


#: A row of the table.
MethodRow: TypeAlias = ApplyingRow | RefusedRow


@dataclass(frozen=True, eq=False, repr=False)
class Comparison(Answer):
    """Every method on one equation at given values, beside the true motion of the equation as it was
    typed.

    Attributes:
        schema: The kind of document.
        equation: The equation of motion as it was understood, `... = 0`; time is its own, so
            frequencies are in radians per unit of it.
        at: The values of parameters and amplitude at which the methods are judged.
        true_frequency: omega of the true motion, in radians per unit of time; null where it
            cannot be computed.
        reason: Why there is no true frequency, in words; null where there is one.
        tolerance: The size of the relative error up to which a verdict is `pass`.
        methods: The methods: first those that apply, then those that do not.
        validity: Where the true motion is periodic, in words and numbers.
    """

    schema: Literal["lindstedt/comparison/1"]
    equation: str
    at: dict[str, Constant]
    true_frequency: float | None
    reason: str | None
    tolerance: float
    methods: tuple[MethodRow, ...]
    validity: tuple[str, ...]


Comparison.FIELDS = (
    ("schema", "schema", None),
    ("equation", "equation", None),
    ("at", "at", mapped(Constant.from_json)),
    ("true_frequency", "true_frequency", None),
    ("reason", "reason", None),
    ("tolerance", "tolerance", None),
    ("methods", "methods", several(one_of(ApplyingRow, RefusedRow))),
    ("validity", "validity", tuple),
)
