"""An oscillator: its equation, with the commands of equations as methods."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from ._call import Problem, words_of
from ._lindstedt import read
from .commands import EquationCommands


class Oscillator(EquationCommands):
    """An equation of motion that is read at once, so that a mistake in it is known here.

    Args:
        problem: An equation as text or as a SymPy expression, a name of the catalogue, the path of
            a problem file, or the tables of one.

    Raises:
        Refused: It is no oscillator, with the term and a way forward.

    >>> import lindstedt as ls
    >>> duffing = ls.Oscillator("x'' + x + eps*x^3 = 0")
    >>> duffing.coordinate, duffing.parameters
    ('x', ('eps',))
    >>> str(ls.Oscillator("duffing")) == str(duffing)
    True
    """

    __slots__ = ("coordinate", "equation", "parameters", "problem")

    problem: Problem
    equation: str
    coordinate: str
    parameters: tuple[str, ...]

    def __init__(self, problem: Any) -> None:
        if not isinstance(problem, (str, Mapping, os.PathLike)):
            from .symbolic import equation_from_sympy

            problem = equation_from_sympy(problem)
        words, text = words_of(problem)
        equation, coordinate, parameters = read(words[0], text)
        values = (("problem", problem), ("equation", equation), ("coordinate", coordinate))
        for name, value in (*values, ("parameters", tuple(parameters))):
            object.__setattr__(self, name, value)

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"an oscillator does not change: {name}")

    def __reduce__(self) -> tuple[type, tuple[Problem]]:
        return Oscillator, (self.problem,)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Oscillator) and self.equation == other.equation

    def __hash__(self) -> int:
        return hash(self.equation)

    def __str__(self) -> str:
        return self.equation

    def __repr__(self) -> str:
        return f"Oscillator({self.equation!r})"

    def to_sympy(self) -> Any:
        """Returns the equation of motion as a SymPy equation in a function of `t`."""
        from .symbolic import equation_to_sympy

        return equation_to_sympy(self)

    def _repr_latex_(self) -> str:
        from .symbolic import latex_of

        return f"${latex_of(self.to_sympy())}$"
