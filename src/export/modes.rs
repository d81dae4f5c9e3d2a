//! Nonlinear normal modes as a picture: each motion in the plane of two coordinates, and in time.

use super::figure::{Curve, CurveStyle, FigureError, Panel, Points, figure};
use crate::decimal::significant;
use crate::report::ModesReport;

/// The modal lines at the values, by the formulas over the true motions: the second coordinate against
/// the first, and half a period of every coordinate.
///
/// # Errors
/// As [`figure`]; without values there is nothing to draw.
pub fn picture(report: &ModesReport) -> Result<String, FigureError> {
    let coordinates = &report.modes.system.equations.coordinates;
    let judged: Vec<_> = report
        .judged_modes()
        .filter_map(|(mode, judged)| Some((mode, judged?.as_ref().ok()?)))
        .collect();
    let [first, second] = [0, 1].map(|index| coordinates.get(index).map(ToString::to_string));
    let (first, second) = (first.unwrap_or_default(), second.unwrap_or_default());
    let phase = format!("{} (π)", report.phase());
    let names: Vec<String> = coordinates.iter().map(ToString::to_string).collect();
    let all = names.join(", ");
    let mut drawn: Vec<(String, [Vec<Points>; 2], [Vec<Points>; 2])> = Vec::new();
    for (mode, judged) in &judged {
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
            (0..coordinates.len()).map(of).collect()
        });
        let title = match judged.relative_error {
            Some(error) => {
                format!("Mode {}: omega off by {} %", mode.number, significant(100.0 * error, 2))
            }
            None => format!("Mode {}", mode.number),
        };
        drawn.push((title, lines, times));
    }
    let mut panels = Vec::new();
    for (title, lines, times) in &drawn {
        for (points, x_label, y_label) in [(lines, &first, &second), (times, &phase, &all)] {
            let [formula, truth] = points;
            let truth = truth.iter().map(|points| Curve {
                label: "true motion",
                points,
                style: CurveStyle::RUNGE_KUTTA,
            });
            let formula = formula.iter().map(|points| Curve {
                label: "formula",
                points,
                style: CurveStyle::FORMULA,
            });
            panels.push(Panel {
                title,
                x_label,
                y_label,
                curves: truth.chain(formula).collect(),
                ..Panel::default()
            });
        }
    }
    let caption = format!(
        "Nonlinear normal modes to order {}: {second} against {first}, and half a period of {all}.",
        report.modes.order
    );
    figure(&panels, &caption)
}
