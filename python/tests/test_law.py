"""Laws as functions: broadcasting, packages, speed, exact numbers."""

import math
import pickle
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction

import lindstedt as ls
import numpy as np
import pytest


def test_coefficients_are_exact():
    law = ls.derive("pendulum", order=4)
    assert law.omega_squared.coefficients == {
        "1": Fraction(1),
        "A^2": Fraction(-1, 8),
        "A^4": Fraction(7, 1536),
    }
    assert law.convention == "initial"


def test_every_symbol_broadcasts():
    law = ls.derive("x'' + x + eps*x^3 = 0", order=2)
    amplitude, small = np.linspace(0.1, 1, 7), np.linspace(0, 0.3, 5)
    grid = law.omega(A=amplitude[:, None], eps=small)
    assert grid.shape == (7, 5)
    for row, a in enumerate(amplitude):
        for column, e in enumerate(small):
            a2 = a * a
            expected = math.sqrt(1 + 3 * e * a2 / 4 - 3 * e * e * a2 * a2 / 128)
            assert grid[row, column] == pytest.approx(expected, rel=1e-14)
            assert law.omega(a, e) == pytest.approx(expected, rel=1e-14)
    times = np.linspace(0, 3, 4)
    motion = law(times, A=amplitude[:, None, None], eps=small[:, None])
    assert motion.shape == (7, 5, 4)
    assert motion[3, 2, 1] == pytest.approx(law(1.0, A=amplitude[3], eps=small[2]), rel=1e-14)
    assert motion[:, :, 0] == pytest.approx(np.broadcast_to(amplitude[:, None], (7, 5)), rel=1e-14)


def test_velocity_is_the_derivative():
    law = ls.derive("helmholtz")
    t, step = np.linspace(0, 6, 13), 1e-5
    slope = (law(t + step, A=0.3, eps=0.2) - law(t - step, A=0.3, eps=0.2)) / (2 * step)
    assert law.velocity(t, A=0.3, eps=0.2) == pytest.approx(slope, abs=1e-8)


def test_no_frequency_is_an_error_of_a_number_and_nan_in_an_array():
    law = ls.derive("duffing-softening", order=1)
    with pytest.raises(ValueError, match="not positive"):
        law.omega(A=10, eps=1)
    with np.errstate(invalid="ignore"):
        values = law.omega(A=[0.1, 10], eps=1)
    assert values[0] > 0 and math.isnan(values[1])
    harmonic = ls.derive("duffing-harmonic")
    values = harmonic.omega(A=np.array([1e-7, 1.0]))
    assert math.isnan(values[0]) and values[1] == pytest.approx(harmonic.omega(1.0), rel=1e-14)


@pytest.mark.parametrize("name", list(ls.catalog))
def test_arrays_and_numbers_agree(name):
    try:
        law = ls.derive(name)
        law.omega
    except ls.Refused:
        pytest.skip("no program: the motion is not periodic")
    values = {symbol: [0.2, 0.1] for symbol in law.symbols}
    at = {symbol: 0.2 for symbol in law.symbols}
    assert law.omega(**values)[0] == pytest.approx(law.omega(**at), rel=1e-13)
    if law.displacement.harmonics == () and law.closed_motion is None:
        with pytest.raises(ls.Refused, match="no motion"):
            law(0.0, **at)
        return
    x = law([[0.0], [1.2]], **values)
    assert x.shape == (2, 2)
    assert x[1, 0] == pytest.approx(law(1.2, **at), rel=1e-12)


def test_a_keyword_that_is_a_word_of_python():
    law = ls.derive("rotating-pendulum")
    assert law.symbols == ("A", "lambda_")
    assert law.omega(A=0.1, lambda_=0.2) == pytest.approx(law.judge(A=0.1, lambda_=0.2).frequency)


def test_lambdify():
    law = ls.derive("duffing")
    t = np.linspace(0, 10, 50)
    expected = law(t, A=1.2, eps=0.1)
    assert law.lambdify("numpy")(t, 1.2, 0.1) == pytest.approx(expected, rel=1e-14)
    assert law.lambdify("math", "omega")(1.2, 0.1) == law.omega(1.2, 0.1)
    with pytest.raises(ValueError, match="choose one of"):
        law.lambdify("fortran")
    for language in ("c", "julia", "rust", "matlab", "python"):
        assert "displacement" in law.lambdify(language)


def test_lambdify_numba():
    pytest.importorskip("numba")
    t = np.linspace(0, 10, 50)
    for name, at in (("duffing", (1.2, 0.1)), ("pendulum", (1.2,)), ("morse", (0.3,))):
        law = ls.derive(name)
        assert law.lambdify("numba")(t, *at) == pytest.approx(law(t, *at), rel=1e-12)
    soft = ls.derive("duffing-softening", order=1).lambdify("numba", "omega")
    assert math.isnan(soft(10.0, 1.0))


def test_lambdify_jax():
    jax = pytest.importorskip("jax")
    law = ls.derive("duffing")
    omega = law.lambdify("jax", "omega")
    assert float(omega(1.2, 0.1)) == pytest.approx(law.omega(1.2, 0.1), rel=1e-6)
    slope = jax.grad(omega)(1.2, 0.1)
    step = 1e-5
    expected = (law.omega(1.2 + step, 0.1) - law.omega(1.2 - step, 0.1)) / (2 * step)
    assert float(slope) == pytest.approx(expected, rel=1e-4)


def test_jax_has_no_functions_that_iterate():
    pytest.importorskip("jax")
    with pytest.raises(ls.Refused, match="numba"):
        ls.derive("pure-cubic").lambdify("jax")


def test_a_law_pickles_and_compares():
    law = ls.derive("pendulum")
    law.omega(1.0)
    copy = pickle.loads(pickle.dumps(law))
    assert copy == law and copy.omega(1.0) == law.omega(1.0)
    assert copy.omega_squared.terms[1].exact == Fraction(-1, 8)


def test_threads_do_not_meet():
    names = ["pendulum", "duffing", "van-der-pol", "toda"] * 8

    def formula(name):
        return ls.derive(name, order=3 if name != "van-der-pol" else 2).equation

    with ThreadPoolExecutor(8) as pool:
        found = list(pool.map(formula, names))
    assert found == [formula(name) for name in names[:4]] * 8


def test_frames_and_labelled_arrays_pass_through():
    pandas = pytest.importorskip("pandas")
    xarray = pytest.importorskip("xarray")
    law = ls.derive("duffing")
    series = law.omega(A=pandas.Series([0.5, 1.0], index=["p", "q"]), eps=0.1)
    assert list(series.index) == ["p", "q"]
    array = law.omega(
        A=xarray.DataArray([0.5, 1.0], dims="A"), eps=xarray.DataArray([0.1, 0.2, 0.3], dims="eps")
    )
    assert set(array.dims) == {"A", "eps"}
    assert float(array.isel(A=1, eps=0)) == series["q"]


def test_whole_numbers_are_doubles():
    law = ls.derive("duffing", order=8)
    amplitude = np.array([1, 2000])
    assert law.omega_squared(A=amplitude.astype(float), eps=1e-9) == pytest.approx(
        law.omega(A=amplitude, eps=1e-9) ** 2, rel=1e-13
    )
    assert law.omega(A=np.int64(2), eps=0) == 1
    assert law.omega(A=Fraction(1, 2), eps=Fraction(1, 10)) == law.omega(0.5, 0.1)
    assert law.omega(A=[1, 2], eps=0.1) == pytest.approx(law.omega(A=[1.0, 2.0], eps=0.1))


def test_long_arrays_are_those_of_their_parts():
    law = ls.derive("toda")
    amplitude = np.linspace(0.01, 0.5, 50_000)
    whole = law.omega(A=amplitude)
    assert (whole[::997] == law.omega(A=amplitude[::997])).all()
    square = law.omega(A=amplitude.reshape(250, 200))
    assert (square.ravel() == whole).all()
    t = np.linspace(0, 5, 40_000)
    motion = law(t, A=0.2)
    assert (motion[::991] == law(t[::991], A=0.2)).all()
    assert law(t[:200], A=amplitude[:200, None]).shape == (200, 200)
