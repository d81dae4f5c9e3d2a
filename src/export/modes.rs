//! Nonlinear normal modes as a picture: each motion in the plane of two coordinates and in time, and
//! the backbones of all.

use super::figure::{Curve, CurveStyle, FigureError, Panel, Points, figure};
use crate::decimal::significant;
use crate::modes::NonlinearMode;
use crate::report::ModesReport;
use crate::solution::Method;
use crate::verify::{BackbonePoint, JudgedMode};

/// Largest number of modes that are drawn: the slowest of those that were asked for.
const MOST_MODES: usize = 6;

/// The curves of one mode: each by the formula, and in truth.
struct DrawnMode {
    title: String,
    /// The second coordinate against the first.
    lines: [Vec<Points>; 2],
    /// Every coordinate over half a period.
    times: [Vec<Points>; 2],
}

/// The modal lines at the values, by the formulas over the true motions: the second coordinate against
/// the first, and half a period of every coordinate; of the first six modes, with their frequencies
/// against the energy.
///
/// # Errors
/// [`FigureError`], as of [`figure`]; without values there is nothing to draw.
pub fn picture(report: &ModesReport) -> Result<String, FigureError> {
    let names: Vec<String> =
        report.modes.system.equations.coordinates.iter().map(ToString::to_string).collect();
    let name = |index: usize| names.get(index).cloned().unwrap_or_default();
    let (first, second, all) = (name(0), name(1), names.join(", "));
    let phase = format!("{} (π)", report.phase());
    let drawn: Vec<DrawnMode> = report
        .judged_modes()
        .filter_map(|(mode, judged)| Some(drawn(mode, judged?.as_ref().ok()?)))
        .take(MOST_MODES)
        .collect();
    let mut panels = Vec::new();
    for mode in &drawn {
        for (points, x_label, y_label) in
            [(&mode.lines, &first, &second), (&mode.times, &phase, &all)]
        {
            panels.push(Panel {
                title: &mode.title,
                x_label,
                y_label,
                curves: curves_of(points),
                ..Panel::default()
            });
        }
    }
    let backbone = backbones(report);
    panels.extend(backbone.as_ref().map(|(x_label, curves)| Panel {
        title: "Backbones: the frequency of each mode",
        x_label,
        y_label: "omega",
        curves: curves_of(curves),
        ..Panel::default()
    }));
    let by = match report.modes.method() {
        Method::HarmonicBalance => format!("by balance of {} harmonics", report.modes.order),
        _ => format!("to order {}", report.modes.order),
    };
    let caption = format!(
        "Nonlinear normal modes {by}: {second} against {first}, and half a period of {all}; and the frequency against {}.",
        backbone.as_ref().map_or("", |(label, _)| label)
    );
    figure(&panels, &caption)
}

/// The true frequency and that of the formula, of each mode against the energy, or against the amplitude
/// where that is not known of all.
fn backbones(report: &ModesReport) -> Option<(String, [Vec<Points>; 2])> {
    let judged: Vec<&JudgedMode> = report
        .judged_modes()
        .filter_map(|(_, judged)| judged?.as_ref().ok())
        .take(MOST_MODES)
        .collect();
    let points = || judged.iter().flat_map(|judged| &judged.backbone);
    let has_energy = points().all(|point| point.energy.is_some());
    let label = match has_energy {
        true => "energy".to_owned(),
        false => format!("amplitude {}", report.modes.amplitude.symbol()),
    };
    let of = |value: &dyn Fn(&BackbonePoint) -> Option<f64>| -> Vec<Points> {
        let curve = |judged: &&JudgedMode| -> Points {
            let places = judged.backbone.iter().filter_map(|point| {
                let along = if has_energy { point.energy? } else { point.amplitude };
                Some((along, value(point)?))
            });
            places.collect()
        };
        judged.iter().map(curve).filter(|points| points.len() > 1).collect()
    };
    let both = [of(&|point| point.frequency), of(&|point| Some(point.true_frequency))];
    both.iter().all(|curves| !curves.is_empty()).then_some((label, both))
}

fn drawn(mode: &NonlinearMode, judged: &JudgedMode) -> DrawnMode {
    let lines = judged.paths.each_ref().map(|path| {
        let points = path.iter().map(|place| (place[0], place.get(1).copied().unwrap_or(0.0)));
        vec![points.collect::<Points>()]
    });
    let times = judged.paths.each_ref().map(|path| {
        let steps = path.len().saturating_sub(1).max(1) as f64;
        let of = |coordinate: usize| -> Points {
            let points = path.iter().enumerate();
            points.map(|(index, place)| (index as f64 / steps, place[coordinate])).collect()
        };
        (0..mode.motion.len()).map(of).collect()
    });
    let title = match judged.relative_error {
        Some(error) => {
            format!("Mode {}: omega off by {} %", mode.number, significant(100.0 * error, 2))
        }
        None => format!("Mode {}", mode.number),
    };
    DrawnMode { title, lines, times }
}

/// The formula over the true motion.
fn curves_of([formula, truth]: &[Vec<Points>; 2]) -> Vec<Curve<'_>> {
    let styles = [("true motion", CurveStyle::RUNGE_KUTTA), ("formula", CurveStyle::FORMULA)];
    let each = [truth, formula].into_iter().zip(styles);
    each.flat_map(|(all, (label, style))| {
        all.iter().map(move |points| Curve { label, points, style })
    })
    .collect()
}
