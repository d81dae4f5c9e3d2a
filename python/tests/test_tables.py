"""Frames, data sets, pictures."""

from pathlib import Path

import lindstedt as ls
import numpy as np
import pytest
from lindstedt.tables import Table

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


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


def test_branches_of_coupled_equations():
    equations = "x'' + x'/5 + 2*x - y = cos(W*t); y'' + y'/5 + 2*y - x = 0"
    branches = ls.response(equations, vary={"W": (0.5, 0.7)}, of="x - y")
    assert (branches.coordinates, branches.of) == (("x", "y"), "x - y")
    point = branches.points[0]
    assert branches.points.column("amplitude_y")[0] == point.amplitudes["y"]
    assert len(point.state) == 4
    pytest.importorskip("pandas")
    frame = branches.points.to_pandas()
    assert {"amplitude", "amplitude_x", "phase_y", "peak_y", "state"} < set(frame.columns)
    assert "amplitude_y" in branches.to_pandas().columns
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    lines = branches.plot().lines
    assert [line.get_label() for line in lines[:3]] == ["x", "y", "x - y"]
    one = ls.response("x'' + x'/5 + x = cos(W*t)", vary={"W": (0.5, 0.7)})
    assert "amplitudes" not in one.points.to_pandas().columns and one.of is None
    assert "amplitudes" not in one.points._repr_html_()


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


def test_a_sweep_of_a_main_mass():
    pytest.importorskip("xarray")
    problem = EXAMPLES / "primary" / "stick-slip.toml"
    asked = {"displacement": [0.01, 0.0163], "zeta": [0.01, 0.02, 0.03]}
    sweep = ls.simulate(problem, sweep=asked)
    assert dict(sweep.to_xarray().sizes) == {"displacement": 2, "zeta": 3}
    found = sweep.to_xarray()["rest_time"].sel(displacement=0.0163, zeta=0.02)
    turned = ls.simulate(problem, sweep={"zeta": [0.02, 0.01], "displacement": [0.0163, 0.01]})
    assert float(found) == turned.rows[0].rest_time


def test_a_table_in_a_notebook():
    duffing = ls.Oscillator("x'' + x'/10 + x + x^3 - F*cos(W*t) = 0")
    branches = duffing.response(vary={"W": (0.5, 2.5)}, at={"F": 0.3})
    page = branches.folds._repr_html_()
    assert page.count("<tr>") == 3 and "<th>parameter</th>" in page
    assert "more rows" in branches.points._repr_html_()
    assert Table(())._repr_html_() is None
    entries = Table(ls.catalog.entries)._repr_html_()
    assert "<td>pendulum</td>" in entries and "x&#x27;&#x27; + sin(x) = 0" in entries


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
    sweep = ls.simulate(sweep={"barrier": [0.1, 0.2], "zeta": (0.01, 0.03, 3)})
    lines = sweep.plot(what="penetration").lines
    assert [line.get_label() for line in lines] == ["barrier = 0.1", "barrier = 0.2"]
    assert all(len(line.get_xdata()) == 3 for line in lines)
    with pytest.raises(ls.UsageError, match="choose one of barrier, zeta"):
        sweep.plot(what="depth")
    one = ls.simulate(sweep={"zeta": (0.01, 0.03, 3)}).plot(what="penetration")
    assert len(one.lines) == 1 and one.get_legend() is None
    main_mass = ls.simulate(EXAMPLES / "primary" / "stick-slip.toml")
    assert main_mass.plot().get_ylabel() == "x" and main_mass.y.shape == main_mass.t.shape
    pyplot.close("all")


def test_an_impact_is_a_function_of_time_and_has_a_picture():
    for impact in (ls.impact(), ls.impact(EXAMPLES / "impact-paper.toml")):
        for phase in impact.motion:
            for time, state in ((phase.start, phase.start_state), (phase.end, phase.end_state)):
                inside = 1e-6 * (phase.end - phase.start) * (1 if time == phase.start else -1)
                assert abs(impact.x(time + inside) - state.x) < 1e-5 * max(1.0, abs(state.x))
                slope = (impact.x(time + 2 * inside) - impact.x(time)) / (2 * inside)
                assert abs(slope - state.velocity) < 1e-4 * max(1.0, abs(state.velocity))
        times = np.linspace(impact.motion[0].start, impact.motion[-1].end, 50)
        assert np.isfinite(impact.x(times)).all()
        assert np.isnan(impact.x([-1.0, times[-1] + 1.0])).all()
        axes = impact.plot()
        assert [line.get_label() for line in axes.lines] == ["approach", "contact", "return"]
