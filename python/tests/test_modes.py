"""Nonlinear normal modes of coupled equations."""

from fractions import Fraction

import lindstedt as ls
import pytest

PAIR = "x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0"


def test_laws_are_exact():
    modes = ls.modes(PAIR)
    assert modes.count == 2
    assert modes.mode(1).omega_squared.coefficients["a^4"] == Fraction(-101, 2048)
    assert modes.mode(2).linear_omega_squared.coefficients["1"] == 3
    assert modes.mode(2).shape["y"].coefficients["1"] == -1
    assert modes.mode(1).verification is None
    assert isinstance(ls.derive(PAIR), ls.Modes)


def test_values_ask_for_a_verdict():
    modes = ls.modes(PAIR, mode=2, a="1/2")
    judged = modes.mode(2).verification
    assert judged.verdict == "pass" and modes.passed
    assert abs(judged.omega / judged.true_omega - 1 - judged.relative_error) < 1e-12
    with pytest.raises(ls.Refused, match="mode 1 has no formula"):
        modes.mode(1)


def test_sympy_has_the_definitions():
    sympy = pytest.importorskip("sympy")
    letters = ls.modes("m*x'' + (k + c)*x - c*y + g*x^3 = 0; y'' + (k + c)*y - c*x = 0", order=2)
    law = letters.to_sympy(1)
    names = {str(symbol) for symbol in law.rhs.free_symbols}
    assert names <= {"m", "k", "c", "g", "a"}
    values = {"m": 1, "k": 1, "c": 1, "g": 0.5, "a": 0.3}
    numbers = {symbol: values[str(symbol)] for symbol in law.rhs.free_symbols}
    assert abs(float(law.rhs.subs(numbers)) - (1 + 3 * 0.3**2 / 16)) < 1e-12
    line = ls.modes(PAIR).lines_to_sympy(1)["y"]
    assert {str(symbol) for symbol in line.free_symbols} == {"a", "x"}
    assert sympy.Poly(line, *line.free_symbols).total_degree() == 3


def test_refusals_say_why():
    with pytest.raises(ls.Refused, match="internal resonance 1:2"):
        ls.modes("x'' + x = 0.4*x*y; y'' + 4*y = 0.3*x^2", mode=1)
    with pytest.raises(ls.Refused) as why:
        ls.modes("x'' + x' + x - y = 0; y'' + 2*y - x = 0")
    assert why.value.term == "x'"
    with pytest.raises(ls.UsageError, match="`derive`"):
        ls.modes("x'' + x + x^3 = 0")


def test_the_catalogue_has_coupled_equations():
    coupled = [entry.name for entry in ls.catalog.entries if entry.name not in ls.catalog]
    assert len(coupled) >= 12
    assert isinstance(ls.derive("modal-pair"), ls.Modes)


def test_an_approximant_is_a_quotient_in_sympy():
    sympy = pytest.importorskip("sympy")
    series = ls.modes(PAIR, order=6).to_sympy(1).rhs
    quotient = ls.modes(PAIR, method="pade", order="2,1").to_sympy(1).rhs
    a = next(iter(series.free_symbols))
    quotient = quotient.subs({symbol: a for symbol in quotient.free_symbols})
    assert sympy.series(quotient - series, a, 0, 8).removeO() == 0
    assert sympy.denom(sympy.together(quotient)).has(a)
