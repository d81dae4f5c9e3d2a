"""The shortest frequency laws on a range: a front as a table, and each law as a function of arrays."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from .documents.shortest import Shortest as ShortestDocument
from .documents.shortest import ShortLaw
from .errors import Refused
from .plots import axes, labelled
from .tables import Table


class Shortest(ShortestDocument):
    """The best frequency laws on a range by length.

    >>> import lindstedt as ls
    >>> found = ls.shortest("pendulum", range={"A": (0, 2.8)}, quantity="T", longest=8)
    >>> found.front.column("length").tolist()[-1]
    8
    >>> found(A=[0.5, 1.5]).round(4)
    array([1.0159, 1.162 ])
    """

    @property
    def front(self) -> Front:
        """The laws, the shortest first."""
        return Front(self.laws)

    @property
    def law(self) -> ShortLaw:
        """The shortest law within the error, or the one with the smallest error.

        Raises:
            Refused: No law was found.
        """
        if not self.laws:
            raise Refused("no law was found", "law")
        return self.laws[-1 if self.chosen is None else self.chosen]

    def function(self, law: ShortLaw | None = None) -> Callable[..., Any]:
        """A law as a function of its variable, of numbers, lists and arrays; without one the law that is chosen.

        A law of a contact is a function of those of its variable and its restitution e that occur in it.
        """
        from ._compile import numpy_functions

        law = self.law if law is None else law
        # The restitution of a contact has no formula in the variable, and is an argument of its own.
        given = [name for name, meaning in self.atoms.items() if meaning == "restitution"]
        known = {name: meaning for name, meaning in self.atoms.items() if name not in given}
        lines = [f"    {name} = {python(meaning)}" for name, meaning in known.items()]
        letters = set(re.findall(r"\w+", law.formula))
        arguments = [name for name in [self.variable, *given] if name in letters or not given]
        program = [
            "from math import cos, exp, log, sin, sqrt, tan",
            f"def angular_frequency({', '.join(arguments)}):",
            '    """A law of the frequency."""',
            *lines,
            f"    return {python(law.formula)}",
        ]
        return numpy_functions("\n".join(program) + "\n")["angular_frequency"]

    def __call__(self, *amounts: Any, **symbols: Any) -> Any:
        """The value of the law that is chosen; arrays broadcast."""
        return self.function()(*amounts, **symbols)


def python(formula: str) -> str:
    """A formula as Python writes it."""
    return formula.replace("^", "**")


class Front(Table[ShortLaw]):
    """The best laws by length."""

    __slots__ = ()

    def plot(self, ax: Any = None) -> Any:
        """Draws length against error on `ax`, and returns the axes."""
        ax = axes(ax)
        errors = [100 * (law.measured if law.proved is None else law.proved[1]) for law in self]
        ax.step([law.length for law in self], errors, where="post")
        ax.set_yscale("log")
        return labelled(ax, "length in symbols", "largest error (%)")
