"""Slow equations of several coordinates, held to integration by SciPy and to the rates they print."""

import lindstedt as ls
import pytest

PAIR = "u'' + 2*mu*u' + u - 2*u*v/5 = 0; v'' + 2*mu*v' + 4*v - 3*u^2/10 = F*cos(Omega*t)"


def test_steady_motions_saturate():
    found = ls.slow_equations(PAIR, mu="1/100", F="1/125", Omega=2)
    stable = [motion for motion in found.steady if motion.stable]
    assert len(stable) == 1 and found.verdict == "pass"
    assert stable[0].amplitudes["a2"] == pytest.approx(0.1, abs=1e-12)
    assert stable[0].truly_stable and stable[0].error < 0.01


def test_rates_go_to_sympy():
    sympy = pytest.importorskip("sympy")
    found = ls.slow_equations(PAIR, resonance="omega2 = 2*omega1, Omega = omega2")
    rates = found.rates_to_sympy()
    assert set(rates) == {"a1", "phi1", "a2", "phi2"}
    values = {"mu": 0.01, "F": 0.008, "Omega": 2.02, "a1": 0.1, "a2": 0.2, "phi1": 0.3, "phi2": 0.4}
    at = {symbol: values[str(symbol)] for symbol in rates["a1"].free_symbols}
    expected = -0.01 * 0.1 - 0.1 * 0.2 * 0.4 / (2 * 2.02) * float(sympy.sin(0.6 - 0.4))
    assert float(rates["a1"].subs(at)) == pytest.approx(expected, rel=1e-12)


def test_one_equation_is_a_usage_error():
    with pytest.raises(ls.UsageError):
        ls.slow_equations("x'' + x + eps*x^3 = 0")
    with pytest.raises(ls.Refused, match="which resonance"):
        ls.slow_equations("x'' + x + x^3 = F*cos(W*t); y'' + 2*y + x*y = 0")
