"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer
from .common import Constant


@dataclass(frozen=True, eq=False, repr=False)
class CertificateRange(Answer):
    """The range of amplitudes in which the frequency of a formula is proved to be within a tolerance
    of the true one, for every amplitude.

    Attributes:
        schema: The kind of document.
        equation: The equation of motion, `... = 0`.
        method: The method of the formula.
        tolerance: The size of the relative error of the frequency that is asked for.
        from_: The first amplitude of the range.
        to: The last amplitude up to which it is proved.
        end: The reason why the range ends: `asked`, because all of it is proved; `further`,
            because the error is proved to be larger at the next amplitude; `open`, because it is
            proved to be neither within nor beyond the tolerance there; `unproved`, because there
            is no proof of the motion there; `stopped`, because the computation was.
        beyond: The amplitude at which it ends so; null for `asked` and `stopped`.
        reason: The reason why there is no proof of the motion at `beyond`; null where there is
            one.
        within: The size of the relative error is proved to be at most this between them; null
            where nothing is proved.
        intervals: The number of intervals, each with a proof; 0 where nothing is proved.
    """

    schema: Literal["lindstedt/certificate-range/1"]
    equation: str
    method: str
    tolerance: float
    from_: Constant
    to: Constant
    end: Literal["asked", "further", "open", "unproved", "stopped"]
    beyond: Constant | None
    reason: str | None
    within: float | None
    intervals: int


CertificateRange.FIELDS = (
    ("schema", "schema", None),
    ("equation", "equation", None),
    ("method", "method", None),
    ("tolerance", "tolerance", None),
    ("from_", "from", Constant.from_json),
    ("to", "to", Constant.from_json),
    ("end", "end", None),
    ("beyond", "beyond", Constant.from_json),
    ("reason", "reason", None),
    ("within", "within", None),
    ("intervals", "intervals", None),
)
