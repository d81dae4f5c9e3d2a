"""Nonlinear normal modes of coupled equations: laws, motions, modal lines."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, Literal

from ._call import Problem, Progress, Value, Values, ask
from .documents.modes import Mode
from .documents.modes import Modes as ModesDocument
from .errors import Refused, UsageError


class Modes(ModesDocument):
    """The nonlinear normal modes of coupled equations.

    Its document is that of `lindstedt derive` of several equations, with the keys as attributes.

    >>> import lindstedt as ls
    >>> pair = ls.modes("x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0")
    >>> [mode.formula for mode in pair.modes][0]
    'omega^2 = 1 + 3*a^2/16 - 101*a^4/2048'
    >>> pair.mode(2).omega_squared.coefficients["a^4"]
    Fraction(1429, 26624)
    """

    def mode(self, number: int) -> Mode:
        """The mode of a number, 1 for the slowest.

        Raises:
            Refused: It has no formula; the reasons are in `refused`.
        """
        for mode in self.modes:
            if mode.number == number:
                return mode
        reasons = "; ".join(self.refused) or f"there are {self.count} modes"
        raise Refused(f"mode {number} has no formula: {reasons}", "modes")

    def to_sympy(self, number: int = 1) -> Any:
        """The law of a mode as a SymPy equation, with what it defines put in.

        >>> import lindstedt as ls
        >>> ls.modes("x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0", order=2).to_sympy(1)
        Eq(omega**2, 3*a**2/16 + 1)
        """
        from .symbolic import expression, sympy

        s = sympy()
        mode = self.mode(number)
        law = mode.approximant
        square = mode.omega_squared.to_sympy() if law is None else expression(law)
        square = self._defined(mode, square)
        return s.Eq(s.Symbol("omega", real=True) ** 2, square, evaluate=False)

    def lines_to_sympy(self, number: int = 1) -> dict[str, Any]:
        """The modal lines of a mode: each other coordinate as an expression in the first.

        >>> import lindstedt as ls
        >>> ls.modes("x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0").lines_to_sympy(1)
        {'y': a**2*x/4 - x**3/12 + x}
        """
        mode = self.mode(number)
        lines = mode.modal_lines.items()
        return {name: self._defined(mode, line.to_sympy()) for name, line in lines}

    @staticmethod
    def _defined(mode: Mode, value: Any) -> Any:
        """An expression with the definitions of its mode put in, the last ones first."""
        from .symbolic import expression, sympy

        s = sympy()
        named = {str(symbol): symbol for symbol in value.free_symbols}
        for name, meaning in reversed(mode.definitions.items()):
            symbol = named.get(name, s.Symbol(name, real=True))
            value = value.subs(symbol, expression(meaning))
            named = {str(symbol): symbol for symbol in value.free_symbols}
        return value


def modes(
    problem: Problem,
    *,
    method: Literal["lindstedt-poincare", "pade"] = "lindstedt-poincare",
    mode: int | None = None,
    order: int | str | None = None,
    amplitude: Literal["initial", "first-harmonic"] | None = None,
    tolerance: float | None = None,
    timeout: float | None = None,
    at: Values | None = None,
    progress: Progress | None = None,
    **values: Value | Fraction,
) -> Modes:
    """Derive the nonlinear normal modes of coupled equations.

    What `derive` gives of several equations; this function says so in its type.

    Args:
        problem: Equations separated by `;`, the path of a problem file, or the tables of one.
        method: A series in the amplitude, or a quotient of polynomials for omega^2 on top.
        mode: Which mode, 1 for the slowest; without it all of them.
        order: Highest power of the amplitude in omega^2; degrees "2,1" of a quotient.
        amplitude: What the amplitude measures.
        tolerance: The relative error up to which a verdict is a pass; 0.01 without it.
        timeout: Give up after so many seconds.
        at: Values of symbols whose names are options or no words.
        progress: Is called with the parts done and all of them; an exception ends the work.
        **values: The values of symbols: of the amplitude too, which asks for verdicts.

    Raises:
        Refused: The problem is refused, with the term and a way forward.
        UsageError: The problem is one equation of one coordinate.
    """
    options = {
        "method": method,
        "mode": mode,
        "order": order,
        "amplitude": amplitude,
        "tolerance": tolerance,
        "timeout": timeout,
        "at": at,
    }
    found = ask("derive", problem, options, values, progress)
    if not isinstance(found, Modes):
        raise UsageError("modes are those of several equations: `derive` has the law of one")
    return found
