"""Made by `python/generate.py` from the JSON schemas: change those."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .._answer import Answer
from .._document import Document, several


@dataclass(frozen=True, eq=False, repr=False)
class Applicability(Document):
    """Whether a method applies to an oscillator.

    Attributes:
        method: The method, by its name on the command line.
        applies: Whether it applies.
        reason: Why it does not, in words; null where it does.
    """

    method: Literal["lindstedt-poincare", "homotopy-perturbation", "homotopy-analysis", "iteration-perturbation", "parameter-expansion", "harmonic-balance", "energy-balance", "max-min", "amplitude-frequency", "hamiltonian", "variational-iteration", "frequency-formula", "averaging", "pade", "hermite-pade", "multiple-scales", "exact"]
    applies: bool
    reason: str | None


Applicability.FIELDS = (
    ("method", "method", None),
    ("applies", "applies", None),
    ("reason", "reason", None),
)


@dataclass(frozen=True, eq=False, repr=False)
class Entry(Document):
    """A classical oscillator.

    Attributes:
        name: The name on the command line.
        title: The name in running text.
        equation: The equation of motion, or several separated by `;`.
        source: Where it is studied.
        published: The law as its source prints it, `omega = ... + ...` or `omega^2 = ... + ...`;
            null where none is printed.
        walls: The sides of rigid walls on which motions are allowed, such as `x < d`, each with
            the coefficient of restitution `e`.
        methods: Every method, and whether it applies.
    """

    name: str
    title: str
    equation: str
    source: str
    published: str | None
    walls: tuple[str, ...]
    methods: tuple[Applicability, ...]


Entry.FIELDS = (
    ("name", "name", None),
    ("title", "title", None),
    ("equation", "equation", None),
    ("source", "source", None),
    ("published", "published", None),
    ("walls", "walls", tuple),
    ("methods", "methods", several(Applicability.from_json)),
)


@dataclass(frozen=True, eq=False, repr=False)
class Catalog(Answer):
    """The classical oscillators that the program knows by name.

    Attributes:
        schema: The kind of document.
        entries: The oscillators, in the order of the listing.
    """

    schema: Literal["lindstedt/catalog/1"]
    entries: tuple[Entry, ...]


Catalog.FIELDS = (
    ("schema", "schema", None),
    ("entries", "entries", several(Entry.from_json)),
)
