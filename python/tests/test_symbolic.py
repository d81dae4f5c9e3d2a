"""SymPy there and back."""

import lindstedt as ls
import pytest

sympy = pytest.importorskip("sympy")


@pytest.mark.parametrize("name", list(ls.catalog))
def test_the_catalogue_there_and_back(name):
    oscillator = ls.catalog[name]
    there = oscillator.to_sympy()
    back = ls.from_sympy(there)
    assert (back.coordinate, back.parameters) == (oscillator.coordinate, oscillator.parameters)
    again = back.to_sympy()
    difference = (there.lhs - there.rhs) - (again.lhs - again.rhs)
    assert sympy.expand(difference) == 0
    # The program reads both as one equation.
    try:
        expected = ls.derive(oscillator, **({"about": {"x": 1}} if name == "double-well" else {}))
    except ls.Refused as why:
        pytest.fail(str(why))
    found = ls.derive(back, **({"about": {"x": 1}} if name == "double-well" else {}))
    assert found.equation == expected.equation
    assert found.displacement == expected.displacement


def test_an_expression_is_an_oscillator():
    t = sympy.Symbol("t")
    x = sympy.Function("x")(t)
    pendulum = ls.Oscillator(x.diff(t, 2) + sympy.sin(x))
    assert pendulum.derive().omega_squared.coefficients["A^2"].denominator == 8
    with pytest.raises(ls.Refused, match="one function of time"):
        ls.from_sympy(sympy.Symbol("y"))


def test_coefficients_and_laws():
    law = ls.derive("pendulum", order=4)
    amplitude = sympy.Symbol("A", real=True)
    expected = 1 - amplitude**2 / 8 + 7 * amplitude**4 / 1536
    assert law.omega_squared.to_sympy() - expected == 0
    assert law.to_sympy().rhs - expected == 0
    closed = ls.derive("pure-cubic").to_sympy()
    assert float(closed.rhs.subs({symbol: 2 for symbol in closed.rhs.free_symbols})) == pytest.approx(
        ls.derive("pure-cubic").omega(A=2.0), rel=1e-14
    )


def test_latex_in_a_notebook():
    assert ls.catalog["pendulum"]._repr_latex_().startswith("$")
    bundle = ls.derive("pendulum")._repr_mimebundle_()
    assert r"\frac{A^{2}}{8}" in bundle["text/latex"]
    assert r"\frac{A^{2}}{8}" in bundle["text/html"]
