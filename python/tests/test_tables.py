"""Frames, data sets, pictures."""

import lindstedt as ls
import numpy as np
import pytest


def test_frames():
    pytest.importorskip("pandas")
    table = ls.compare("pendulum", A=2.0)
    frame = table.to_pandas().sort_values("error")
    assert frame.iloc[0]["method"] == "exact" == table.best.method
    assert frame.attrs["units"]["omega"] == "rad per unit of time"
    motion = ls.simulate("duffing", x=1, eps=0.1, until=5)
    assert list(motion.to_pandas().columns) == ["t", "x", "x'"]
    assert motion.t.shape == motion.x.shape == motion["x'"].shape


def test_branches():
    duffing = ls.Oscillator("x'' + x'/10 + x + x^3 - F*cos(W*t) = 0")
    branches = duffing.response(vary={"W": (0.5, 2.5)}, at={"F": 0.3})
    assert len(branches.folds) == 2
    assert branches.points.column("parameter").shape == (len(branches.points),)
    upper, lower = sorted(branches.folds.column("parameter"), reverse=True)
    assert 1.3 < lower < upper < 1.8


def test_a_sweep_over_several_axes():
    pytest.importorskip("xarray")
    sweep = ls.simulate(sweep={"zeta": (0.01, 0.03, 3), "barrier": [0.1, 0.2]})
    dataset = sweep.to_xarray()
    assert dict(dataset.sizes) == {"zeta": 3, "barrier": 2}
    one = ls.simulate(sweep={"zeta": [0.02, 0.03], "barrier": [0.2, 0.3]})
    found = dataset["penetration"].sel(zeta=0.02, barrier=0.2, method="nearest")
    assert float(found) == pytest.approx(one.rows[0].penetration, rel=1e-9)
    assert dataset["penetration"].attrs["units"] == "rad"
    motions = ls.simulate("duffing", x=1, until=5, sweep={"eps": [0.1, 0.2, 0.3]}).to_xarray()
    assert motions.sizes["eps"] == 3


def test_pictures():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    from matplotlib import pyplot

    _, ax = pyplot.subplots()
    law = ls.derive("duffing")
    assert law.plot(ax=ax, A=1.0, eps=0.1) is ax and len(ax.lines) == 1
    drawn = ax.lines[0].get_xydata()
    assert drawn[0] == pytest.approx([0, 1])
    assert np.ptp(drawn[:, 1]) == pytest.approx(2, rel=1e-2)
    ls.compare("pendulum", A=1).plot()
    ls.response("x'' + x'/10 + x + x^3/10 = F*cos(W*t)", vary={"W": (0.8, 1.2)}, F=0.1).plot()
    ls.simulate("duffing", x=1, eps=0.1, until=5).plot()
    ls.simulate().plot()
    ls.friction().plot()
    materials = ls.materials().plot()
    assert len(materials.lines) == 5 and materials.get_xscale() == "log"
    curves = ls.stability("x'' + (delta + eps*cos(t))*x = 0", eps=1).plot()
    assert len(curves.lines) == 14
    ls.simulate(sweep={"zeta": (0.01, 0.03, 3)}).plot(what="penetration")
    pyplot.close("all")
