"""Slow equations of coupled equations: amplitudes and phases of all modes by multiple scales."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, Literal

from ._call import Problem, Progress, Value, Values, ask
from .documents.slow_equations import SlowEquations as SlowEquationsDocument
from .documents.slow_equations import SlowMode
from .errors import UsageError


class SlowEquations(SlowEquationsDocument):
    """The slow equations of all modes of coupled equations.

    Its document is that of `lindstedt derive --method multiple-scales` of several equations, with the
    keys as attributes.

    >>> import lindstedt as ls
    >>> pair = ls.slow_equations("x'' + x - x*y = 0; y'' + w2^2*y - x^2 = 0", resonance="w2 = 2*omega1")
    >>> pair.mode(1).amplitude_rate
    '-a1*a2*sin(gamma1)/4'
    """

    def mode(self, number: int) -> SlowMode:
        """The mode of a number, from 1."""
        for mode in self.modes:
            if mode.number == number:
                return mode
        raise UsageError(f"there is no mode {number}: there are {len(self.modes)}")

    def rates_to_sympy(self) -> dict[str, Any]:
        """The rates of all amplitudes and phases as SymPy expressions, with what they name put in but for
        detunings of frequencies that stand in no formula.

        >>> import lindstedt as ls
        >>> pair = ls.slow_equations("x'' + x - x*y = 0; y'' + 4*y - x^2 = 0")
        >>> pair.rates_to_sympy()["a1"]
        -a1*a2*sin(2*phi1 - phi2)/4
        """
        from .symbolic import expression, sympy

        s = sympy()
        rates: dict[str, Any] = {}
        for mode in self.modes:
            rates[mode.amplitude] = expression(mode.amplitude_rate)
            rates[mode.phase] = expression(mode.phase_rate)
        meanings = {**self.definitions, **self.slow_phases}
        for name in rates:
            for known, meaning in reversed(meanings.items()):
                named = {str(symbol): symbol for symbol in rates[name].free_symbols}
                symbol = named.get(known, s.Symbol(known, real=True))
                rates[name] = rates[name].subs(symbol, expression(meaning))
        return rates


def slow_equations(
    problem: Problem,
    *,
    method: Literal["multiple-scales", "averaging"] = "multiple-scales",
    order: int | None = None,
    small: str | None = None,
    resonance: str | None = None,
    tolerance: float | None = None,
    timeout: float | None = None,
    at: Values | None = None,
    progress: Progress | None = None,
    **values: Value | Fraction,
) -> SlowEquations:
    """Derive the slow equations of coupled equations by multiple scales.

    What `derive` gives of several equations with this method; this function says so in its type.

    Args:
        problem: Equations separated by `;`, the path of a problem file, or the tables of one.
        method: Multiple scales, or averaging to first order.
        order: The highest order of the slow equations.
        small: The small parameter; the amplitudes without it.
        resonance: Relations between frequencies, `"omega2 = 2*omega1, Omega = omega2"`, or `"none"`; without it
            those that the numbers are near.
        tolerance: The error up to which a verdict is a pass; 0.01 without it.
        timeout: Give up after so many seconds.
        at: Values of symbols whose names are options or no words.
        progress: Is called with the parts done and all of them; an exception ends the work.
        **values: The values of symbols: of all parameters for steady motions, of the amplitudes too for a motion
            from them.

    Raises:
        Refused: The problem is refused, with the term and a way forward.
        UsageError: The problem is one equation of one coordinate.
    """
    options = {
        "method": method,
        "order": order,
        "small": small,
        "resonance": resonance,
        "tolerance": tolerance,
        "timeout": timeout,
        "at": at,
    }
    found = ask("derive", problem, options, values, progress)
    if not isinstance(found, SlowEquations):
        raise UsageError("these slow equations are of several equations: `derive` has those of one")
    return found
