//! Pictures: x(t), the phase plane and the energy of one run; curves or a heat map of a sweep.

use std::sync::Arc;

use kuva::prelude::{ColorMap, Heatmap, Layout, Plot, TickFormat};
use kuva::render::render::{Primitive, TextAnchor, render_multiple};

use super::super::figure::{Curve, CurveStyle, FigureError, Guide, Panel, figure, written};
use super::{Report, SweepReport};
use crate::decimal::decimal;
use crate::impact::Simulation;
use crate::impact::sweep::{Axis, Summary};

/// Points of a curve, equally spaced in time; the turning points come on top.
const POINTS: usize = 1600;

/// The motion at equal distances of time and at its turning points, so that no peak is cut.
fn points(motion: &Simulation) -> Vec<(f64, f64, f64)> {
    let mut times: Vec<f64> = (0..=POINTS)
        .map(|index| motion.end_time * (index as f64 / POINTS as f64))
        .collect();
    times.extend(motion.turns.iter().map(|turn| turn.t));
    times.extend(
        motion
            .impacts
            .iter()
            .flat_map(|impact| [Some(impact.entry_time), impact.exit_time])
            .flatten(),
    );
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
        .into_iter()
        .filter_map(|t| motion.path.at(t).map(|(x, velocity)| (t, x, velocity)))
        .collect()
}

/// The motion in time, the phase plane, and where the energy goes.
///
/// # Errors
/// As [`figure`].
///
/// ```
/// use lindstedt::export::simulation::{Report, figure};
/// use lindstedt::impact::{Case, Integrator, Settings, simulate};
///
/// let (model, start) = Case { zeta: 0.05, ..Case::default() }.motion()?;
/// let motion = simulate(&model, start, Integrator::Taylor, &Settings::default())?;
/// let report = Report { motion: &motion, judge: None, sources: ["given", "given"], tolerance: 1e-10, samples: &[1.0], baseline: None };
/// assert!(figure::simulation(&report)?.starts_with("<svg"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn simulation(report: &Report) -> Result<String, FigureError> {
    let motion = report.motion;
    let points = points(motion);
    let time: Vec<(f64, f64)> = points.iter().map(|&(t, x, _)| (t, x)).collect();
    let phase: Vec<(f64, f64)> = points.iter().map(|&(_, x, v)| (x, v)).collect();
    let (mut energy, mut viscous, mut friction, mut contact, mut excitation) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new(), Vec::new());
    motion.energy_points(motion.end_time / POINTS as f64, |point| {
        energy.push((point.t, point.energy));
        viscous.push((point.t, point.book.viscous));
        friction.push((point.t, point.book.friction));
        contact.push((point.t, point.book.contact));
        excitation.push((point.t, point.book.excitation));
    });
    let judge = report.judge.map(|judge| {
        let points = self::points(judge);
        let time: Vec<(f64, f64)> = points.iter().map(|&(t, x, _)| (t, x)).collect();
        let phase: Vec<(f64, f64)> = points.iter().map(|&(_, x, v)| (x, v)).collect();
        (time, phase)
    });
    let mut motions = Vec::new();
    let mut orbits = Vec::new();
    if let Some((time, phase)) = &judge {
        motions.push(curve("Runge-Kutta", time, CurveStyle::RUNGE_KUTTA));
        orbits.push(curve("Runge-Kutta", phase, CurveStyle::RUNGE_KUTTA));
    }
    let style = if judge.is_some() {
        CurveStyle::FORMULA
    } else {
        CurveStyle::DIFFERENCE
    };
    motions.push(curve("motion", &time, style));
    orbits.push(curve("motion", &phase, style));
    let model = &motion.model;
    let guides = |guide: fn(f64, &'static str) -> Guide<'static>| -> Vec<Guide<'static>> {
        let left = model.left.map(|at| guide(at, "left barrier"));
        let right = model.right.map(|at| guide(at, "barrier x_c"));
        // A barrier out of reach would leave no room for the motion.
        if motion.touches() {
            left.into_iter().chain(right).collect()
        } else {
            Vec::new()
        }
    };
    let mut energies = vec![curve("energy", &energy, CurveStyle::FORMULA)];
    for (label, points, style, shown) in [
        (
            "work of viscous damping",
            &viscous,
            CurveStyle::SECOND_DIFFERENCE,
            model.zeta != 0.0,
        ),
        (
            "work of dry friction",
            &friction,
            CurveStyle::SERIES[5],
            model.alpha != 0.0,
        ),
        (
            "work of contact damping",
            &contact,
            CurveStyle::THIRD_DIFFERENCE,
            model.mu != 0.0,
        ),
        (
            "work of the excitation",
            &excitation,
            CurveStyle::SECOND_FORMULA,
            model.beta != 0.0,
        ),
    ] {
        if shown {
            energies.push(curve(label, points, style));
        }
    }
    let panel = |title, x_label, y_label, curves, guides| Panel {
        title,
        x_label,
        y_label,
        curves,
        guides,
        ..Panel::default()
    };
    let panels = [
        panel(
            "Motion in time",
            TIME,
            "displacement x (rad)",
            motions,
            guides(Guide::Y),
        ),
        panel(
            "Phase plane",
            "displacement x (rad)",
            "velocity x′",
            orbits,
            guides(Guide::X),
        ),
        panel("Energy", TIME, "energy (units of m g L)", energies, Vec::new()),
    ];
    let caption = format!(
        "Equation (7): γ = {}, μ = {}, ζ = {}, α = {}, β = {}; {} impacts until t = {}.",
        decimal(model.gamma),
        decimal(model.mu),
        decimal(model.zeta),
        decimal(model.alpha),
        decimal(model.beta),
        motion.impacts.len(),
        decimal(motion.end_time)
    );
    figure(&panels, &caption)
}

const TIME: &str = "time t (units of 1/ω)";

fn curve<'a>(label: &'a str, points: &'a [(f64, f64)], style: CurveStyle) -> Curve<'a> {
    Curve { label, points, style }
}

/// Points of one curve.
type Points = Vec<(f64, f64)>;

/// A quantity of a sweep.
struct Quantity {
    title: &'static str,
    label: &'static str,
    /// What a motion without it lacks.
    name: &'static str,
    value: fn(&Summary) -> Option<f64>,
}

const QUANTITIES: [Quantity; 4] = [
    Quantity {
        title: "Rest time",
        label: "rest time (units of 1/ω)",
        name: "rest time",
        value: |summary| summary.rest_time.ok(),
    },
    Quantity {
        title: "Impacts",
        label: "number of impacts",
        name: "impacts",
        value: |summary| Some(summary.impacts as f64),
    },
    Quantity {
        title: "Deepest penetration",
        label: "penetration (rad)",
        name: "penetration",
        value: |summary| Some(summary.deepest),
    },
    Quantity {
        title: "Energy lost in contact",
        label: "energy (units of m g L)",
        name: "energy",
        value: |summary| Some(summary.energy_lost),
    },
];

/// How a swept parameter is written at an axis and in a caption: what it is with its unit, and its symbol.
fn parameter(name: &str) -> [&str; 2] {
    match name {
        "amplitude" => ["amplitude A (rad)", "A"],
        "start" => ["start x(0) (rad)", "x(0)"],
        "speed" => ["start x′(0)", "x′(0)"],
        "barrier" => ["barrier x_c (rad)", "x_c"],
        "gamma" => ["stiffness γ", "γ"],
        "mu" => ["contact damping μ", "μ"],
        "lambda" => ["contact damping λ (s/m)", "λ"],
        "zeta" => ["damping ratio ζ", "ζ"],
        "alpha" => ["friction α", "α"],
        "beta" => ["excitation β", "β"],
        "frequency_ratio" => ["frequency ratio Ω/ω", "Ω/ω"],
        "mass" => ["mass m (kg)", "m"],
        "radius" => ["radius R (m)", "R"],
        "length" => ["length L (m)", "L"],
        "modulus" => ["modulus E (Pa)", "E"],
        "gravity" => ["gravity g (m/s²)", "g"],
        other => [other, other],
    }
}

/// From where to where: `ζ from 0.01 to 0.05`.
fn range(axis: &Axis) -> String {
    let [_, symbol] = parameter(&axis.name);
    format!("{symbol} from {} to {}", decimal(axis.from), decimal(axis.to))
}

/// Curves over one parameter, or a heat map over two: of the rest time where a motion has one, otherwise of the number of
/// impacts.
///
/// # Errors
/// As [`figure`].
///
/// ```
/// use lindstedt::export::simulation::{SweepReport, figure};
/// use lindstedt::impact::{Model, Settings, Start, sweep::{Axis, sweep}};
///
/// let axes: [Axis; 1] = ["zeta=0.02:0.1:3".parse()?];
/// let start = Start { x: -1.5, velocity: 0.0 };
/// let motions: Vec<_> = axes[0].values().into_iter().map(|zeta| (Model { zeta, ..Model::default() }, start)).collect();
/// let rows = sweep(&motions, &Settings::default(), |_done| {}).map_err(|(_, error)| error)?;
/// let report = SweepReport { axes: &axes, rows: &rows };
/// assert!(figure::sweep(&report)?.starts_with("<svg"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn sweep(report: &SweepReport) -> Result<String, FigureError> {
    match report.axes {
        [one] => {
            let values = one.values();
            // A motion without the quantity interrupts the curve: nothing is drawn across what is not there, and one point
            // alone is no curve.
            let runs = |quantity: &Quantity| -> Vec<Points> {
                let found: Vec<Option<(f64, f64)>> = values
                    .iter()
                    .zip(report.rows)
                    .map(|(at, row)| Some((*at, (quantity.value)(row)?)))
                    .collect();
                let unbroken = found.split(Option::is_none).filter(|run| run.len() > 1);
                unbroken.map(|run| run.iter().copied().flatten().collect()).collect()
            };
            let drawn: Vec<(&Quantity, Vec<Points>)> = QUANTITIES
                .iter()
                .map(|quantity| (quantity, runs(quantity)))
                .filter(|(_, runs)| !runs.is_empty())
                .collect();
            let panels: Vec<Panel> = drawn
                .iter()
                .map(|(quantity, runs)| Panel {
                    title: quantity.title,
                    x_label: parameter(&one.name)[0],
                    y_label: quantity.label,
                    curves: runs
                        .iter()
                        .map(|points| curve("", points, CurveStyle::DIFFERENCE))
                        .collect(),
                    ..Panel::default()
                })
                .collect();
            let restless = report.rows.iter().filter(|row| row.rest_time.is_err()).count();
            let mut caption = format!("{} motions, {}.", report.rows.len(), range(one));
            if restless > 0 {
                caption.push_str(&format!(" No rest time in {restless} of them."));
            }
            figure(&panels, &caption)
        }
        [down, across] => {
            let [rest, impacts, ..] = &QUANTITIES;
            let restless = report.rows.iter().filter(|row| row.rest_time.is_err()).count();
            let total = report.rows.len();
            let quantity = if restless < total { rest } else { impacts };
            let grid: Vec<Vec<f64>> = report
                .rows
                .chunks(across.count.max(1))
                .map(|row| {
                    row.iter()
                        .map(|summary| (quantity.value)(summary).unwrap_or(f64::NAN))
                        .collect()
                })
                .collect();
            let mut caption = format!("{total} motions, {} and {}.", range(down), range(across));
            match restless {
                0 => {}
                _ if restless < total => {
                    caption.push_str(&format!(
                        " Grey: no {} within the run, {restless} of them.",
                        quantity.name
                    ));
                }
                _ => caption.push_str(" None of them has a rest time within the run."),
            }
            Ok(heat_map(&grid, [down, across], quantity, &caption))
        }
        _ => Err(FigureError::Empty("the sweep".to_owned())),
    }
}

/// The rows as the library draws them, upwards and to the right: an axis that falls is turned round.
fn rising(grid: &[Vec<f64>], down_rises: bool, across_rises: bool) -> Vec<Vec<f64>> {
    let mut rows = grid.to_vec();
    if !down_rises {
        rows.reverse();
    }
    if !across_rises {
        rows.iter_mut().for_each(|row| row.reverse());
    }
    rows
}

/// The colour of a cell without a value.
const MISSING: &str = "#c8c8c8";

/// A cell for each motion, grey where its value is no number, with the quantity and its unit at the scale of colours.
fn heat_map(grid: &[Vec<f64>], [down, across]: [&Axis; 2], quantity: &Quantity, caption: &str) -> String {
    let half = |axis: &Axis| 0.5 * (axis.to - axis.from) / (axis.count.max(2) - 1) as f64;
    let range = |axis: &Axis| {
        let (from, to) = (axis.from - half(axis), axis.to + half(axis));
        (from.min(to), from.max(to))
    };
    let (x, y) = (range(across), range(down));
    let map = Heatmap::new()
        .with_data(rising(grid, down.to >= down.from, across.to >= across.from))
        .with_color_map(ColorMap::Custom(Arc::new(|part: f64| match part.is_finite() {
            true => ColorMap::Viridis.map(part),
            false => MISSING.to_owned(),
        })))
        .with_x_range(x.0, x.1)
        .with_y_range(y.0, y.1);
    let ticks = TickFormat::Custom(Arc::new(|value: f64| decimal((value * 1e12).round() / 1e12)));
    let mut layout = Layout::new(x, y)
        .with_title(quantity.title)
        .with_x_label(parameter(&across.name)[0])
        .with_y_label(parameter(&down.name)[0])
        .with_tick_format(ticks);
    (layout.x_axis_min, layout.x_axis_max) = (Some(x.0), Some(x.1));
    (layout.y_axis_min, layout.y_axis_max) = (Some(y.0), Some(y.1));
    layout.show_colorbar = true;
    let mut scene = render_multiple(vec![Plot::Heatmap(map)], layout.with_width(700.0).with_height(480.0));
    scene.width += 26.0;
    let (x, y) = (scene.width - 10.0, 0.5 * scene.height - 4.0);
    scene.add(Primitive::Text {
        x,
        y,
        content: quantity.label.to_owned(),
        size: 14,
        anchor: TextAnchor::Middle,
        rotate: Some(-90.0),
        bold: false,
        color: None,
    });
    // Room between the label of the axis and the caption.
    scene.height += 8.0;
    written(scene, caption)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where the one hot cell stands in the picture: left or right, above or below.
    #[test]
    fn cells_stand_at_their_values() {
        let axis = |from, to| Axis {
            name: "a".to_owned(),
            from,
            to,
            count: 2,
        };
        // The second value of the ordinate, the first of the abscissa.
        let grid = [vec![0.0, 0.0], vec![1.0, 0.0]];
        let place = |down: &Axis, across: &Axis| {
            let svg = heat_map(&grid, [down, across], &QUANTITIES[0], "Two by two.");
            let number = |cell: &str, key: &str| -> f64 {
                let rest = cell.split(&format!(" {key}=\"")).nth(1).expect("a coordinate");
                rest.split('"')
                    .next()
                    .and_then(|text| text.parse().ok())
                    .expect("a number")
            };
            // The cells are the rectangles of the clipped group, set in by four spaces.
            let cells: Vec<&str> = svg.lines().filter(|line| line.starts_with("    <rect")).collect();
            assert_eq!(cells.len(), 4);
            let (hot, cold): (Vec<&str>, Vec<&str>) = cells.iter().partition(|cell| cell.contains("#fde725"));
            let side = |key| cold.iter().any(|cell| number(cell, key) > number(hot[0], key));
            (side("x"), side("y"))
        };
        let (left, above) = (true, true);
        assert_eq!(place(&axis(0.0, 1.0), &axis(0.0, 1.0)), (left, above));
        assert_eq!(place(&axis(1.0, 0.0), &axis(0.0, 1.0)), (left, !above));
        assert_eq!(place(&axis(0.0, 1.0), &axis(1.0, 0.0)), (!left, above));
    }
}
