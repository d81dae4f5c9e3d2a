"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer
from .._document import Document, several
from .common import Judged, Parameters


@dataclass(frozen=True, eq=False, repr=False)
class TrueNumbers(Document):
    """The numbers of the true motion.

    Attributes:
        time_to_contact: The time from the release to the touch, in units of time.
        speed: The speed at the touch, in radians per unit of time.
        penetration: The greatest depth in the barrier, in radians.
        duration: The time from touch to release, in units of time.
        period: The time from release to release, in units of time.
    """

    time_to_contact: float
    speed: float
    penetration: float
    duration: float
    period: float


TrueNumbers.FIELDS = (
    ("time_to_contact", "time_to_contact", None),
    ("speed", "speed", None),
    ("penetration", "penetration", None),
    ("duration", "duration", None),
    ("period", "period", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class ImpactMethodRow(Document):
    """A row of the table.

    Attributes:
        method: The method, by its name on the command line; `paper` and `energy` are the paper's
            readings.
        order: The order that was chosen; null for a method without one.
        degrees: The degrees of an approximant, of numerator and denominator or of P, Q and R;
            null for every other method.
        applies: Whether the method applies.
        reason: Why it does not, in words; null where it does.
        time_to_contact: The time from the release to the touch, in units of time; this and the
            rest is null where the method does not apply.
        speed: The speed at the touch, in radians per unit of time.
        penetration: The greatest depth in the barrier, in radians.
        duration: The time from touch to release, in units of time.
        period: The time from release to release, in units of time.
        max_deviation_by_phase: The largest |x - x_true| in approach, contact and return, each on
            its own clock: of the flights as a fraction of the amplitude, of the contact as one of
            the true depth.
        verdict: Whether every number and every phase is within the tolerance.
    """

    method: str
    order: int | None
    degrees: tuple[int, ...] | None
    applies: bool
    reason: str | None
    time_to_contact: Judged | None
    speed: Judged | None
    penetration: Judged | None
    duration: Judged | None
    period: Judged | None
    max_deviation_by_phase: tuple[float, float, float] | None
    verdict: Literal["pass", "fail"] | None


ImpactMethodRow.FIELDS = (
    ("method", "method", None),
    ("order", "order", None),
    ("degrees", "degrees", tuple),
    ("applies", "applies", None),
    ("reason", "reason", None),
    ("time_to_contact", "time_to_contact", Judged.from_json),
    ("speed", "speed", Judged.from_json),
    ("penetration", "penetration", Judged.from_json),
    ("duration", "duration", Judged.from_json),
    ("period", "period", Judged.from_json),
    ("max_deviation_by_phase", "max_deviation_by_phase", tuple),
    ("verdict", "verdict", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class ImpactComparison(Answer):
    """Every method on one impact, beside Runge-Kutta on the equation as it stands. Units as in a
    document of kind `impact`.

    Attributes:
        schema: The kind of document.
        equation: The equation of motion that is judged, `... = 0`, its force on the barrier
            included.
        parameters: The numbers of the problem.
        runge_kutta: The numbers of the true motion.
        tolerance: The size of the relative error up to which a verdict is `pass`.
        methods: The rows: the paper's readings and the methods that apply, then those that do
            not.
    """

    schema: Literal["lindstedt/impact-comparison/1"]
    equation: str
    parameters: Parameters
    runge_kutta: TrueNumbers
    tolerance: float
    methods: tuple[ImpactMethodRow, ...]


ImpactComparison.FIELDS = (
    ("schema", "schema", None),
    ("equation", "equation", None),
    ("parameters", "parameters", Parameters.from_json),
    ("runge_kutta", "runge_kutta", TrueNumbers.from_json),
    ("tolerance", "tolerance", None),
    ("methods", "methods", several(ImpactMethodRow.from_json)),
)
