//! A motion by slow equations over the true one, every coordinate in time.

use super::figure::{Curve, CurveStyle, FigureError, Panel, Points, figure};
use crate::report::SlowReport;

/// The motion from the amplitudes that were given, by the formula over the truth, a panel for each
/// coordinate.
///
/// # Errors
/// [`FigureError`], as of [`figure`]; without amplitudes there is no motion to draw.
pub fn picture(report: &SlowReport) -> Result<String, FigureError> {
    let slow = report.slow;
    let names: Vec<String> =
        slow.system.equations.coordinates.iter().map(ToString::to_string).collect();
    let transient = report.judged.and_then(|judged| judged.transient.as_ref());
    let drawn: Vec<[Points; 2]> = transient
        .map(|transient| {
            let of = |rows: &[Vec<f64>], coordinate: usize| -> Points {
                let points = transient.times.iter().zip(rows);
                points.map(|(time, row)| (*time, row[coordinate])).collect()
            };
            (0..names.len())
                .map(|index| [of(&transient.truth, index), of(&transient.formula, index)])
                .collect()
        })
        .unwrap_or_default();
    let panels: Vec<Panel> = drawn
        .iter()
        .zip(&names)
        .map(|([truth, formula], name)| Panel {
            title: name,
            x_label: "t",
            y_label: name,
            curves: vec![
                Curve { label: "true motion", points: truth, style: CurveStyle::RUNGE_KUTTA },
                Curve { label: "slow equations", points: formula, style: CurveStyle::FORMULA },
            ],
            ..Panel::default()
        })
        .collect();
    let caption = format!(
        "Slow equations to order {} over the true motion: {}.",
        slow.order,
        names.join(", ")
    );
    figure(&panels, &caption)
}
