//! Nonlinear normal modes as a picture: each motion in the plane of two coordinates, and in time.

use super::figure::{Curve, CurveStyle, FigureError, Panel, Points, figure};
use crate::decimal::significant;
use crate::modes::NonlinearMode;
use crate::report::ModesReport;
use crate::solution::Method;
use crate::verify::JudgedMode;

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
/// the first, and half a period of every coordinate; of the first six modes.
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
                curves: curves(points),
                ..Panel::default()
            });
        }
    }
    let by = match report.modes.method() {
        Method::HarmonicBalance => format!("by balance of {} harmonics", report.modes.order),
        _ => format!("to order {}", report.modes.order),
    };
    let caption = format!(
        "Nonlinear normal modes {by}: {second} against {first}, and half a period of {all}."
    );
    figure(&panels, &caption)
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
fn curves([formula, truth]: &[Vec<Points>; 2]) -> Vec<Curve<'_>> {
    let styles = [("true motion", CurveStyle::RUNGE_KUTTA), ("formula", CurveStyle::FORMULA)];
    let each = [truth, formula].into_iter().zip(styles);
    each.flat_map(|(all, (label, style))| {
        all.iter().map(move |points| Curve { label, points, style })
    })
    .collect()
}
