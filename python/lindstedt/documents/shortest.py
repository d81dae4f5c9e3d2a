"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer
from .._document import Document, several
from .common import Constant


@dataclass(frozen=True, eq=False, repr=False)
class ShortLaw(Document):
    """A law and its largest error.

    Attributes:
        formula: The formula.
        length: The number of its symbols: digits, names, functions and signs.
        measured: The largest relative error that was measured.
        worst: The value of the variable at which that is.
        proved: The ends between which the largest error is proved to be; null without a proof.
        reason: The reason why there is no proof; null where there is one.
    """

    formula: str
    length: int
    measured: float
    worst: float
    proved: tuple[float, float] | None
    reason: str | None


ShortLaw.FIELDS = (
    ("formula", "formula", None),
    ("length", "length", None),
    ("measured", "measured", None),
    ("worst", "worst", None),
    ("proved", "proved", tuple),
    ("reason", "reason", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class PublishedFormula(Document):
    """A published formula and its largest error.

    Attributes:
        formula: The formula.
        quantity: Its quantity: `omega`, `omega^2`, `T/(2*pi)` or `T/T_0`.
        source: The publication.
        length: The number of its symbols.
        measured: The largest relative error that was measured; null where it has no value
            somewhere.
        worst: The value of the variable at which that is.
    """

    formula: str
    quantity: str
    source: str
    length: int
    measured: float | None
    worst: float


PublishedFormula.FIELDS = (
    ("formula", "formula", None),
    ("quantity", "quantity", None),
    ("source", "source", None),
    ("length", "length", None),
    ("measured", "measured", None),
    ("worst", "worst", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Shortest(Answer):
    """The best frequency laws on a range: for each length the one with the smallest largest error.

    Attributes:
        schema: The kind of document.
        equation: The equation of motion, `... = 0`, with numbers for all but the variable; of
            modes all equations, separated by `;`.
        variable: The name of the variable.
        meaning: The product that the variable stands for, `eps*A^2` say; null for the amplitude
            or a parameter.
        amplitude: The amplitude where a parameter varies; null where the amplitude does, for
            limit cycles and contacts.
        from_: The lower end of the range.
        to: The upper end; null for infinity.
        mode: The number of the normal mode; null for one coordinate.
        quantity: The quantity of the laws: `omega`, `omega^2`, `T/(2*pi)` or `T/T_0`.
        atoms: The names in the laws besides the variable, each with its meaning in it;
            `restitution` for the coefficient of restitution of a contact.
        chosen: The number of the shortest law within that error, counted from zero; null where
            none is, and the last one without an error.
        laws: The laws, the shortest first, each with a smaller error than all before.
        published: Published formulas beside them.
        verdict: `pass` where a law is proved to be within the error, `fail` where none is; null
            without an error.
        error: The largest error that is asked for; null without it.
    """

    schema: Literal["lindstedt/shortest/1"]
    equation: str
    variable: str
    meaning: str | None
    amplitude: Constant | None
    from_: Constant
    to: Constant | None
    mode: int | None
    quantity: str
    atoms: dict[str, str]
    chosen: int | None
    laws: tuple[ShortLaw, ...]
    published: tuple[PublishedFormula, ...]
    verdict: str | None
    error: float | None


Shortest.FIELDS = (
    ("schema", "schema", None),
    ("equation", "equation", None),
    ("variable", "variable", None),
    ("meaning", "meaning", None),
    ("amplitude", "amplitude", Constant.from_json),
    ("from_", "from", Constant.from_json),
    ("to", "to", Constant.from_json),
    ("mode", "mode", None),
    ("quantity", "quantity", None),
    ("atoms", "atoms", dict),
    ("chosen", "chosen", None),
    ("laws", "laws", several(ShortLaw.from_json)),
    ("published", "published", several(PublishedFormula.from_json)),
    ("verdict", "verdict", None),
    ("error", "error", None),
)
