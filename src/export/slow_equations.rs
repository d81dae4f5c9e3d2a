//! A motion by slow equations over the true one, every coordinate in time.

use super::figure::{Curve, CurveStyle, FigureError, Panel, Points, figure};
use crate::report::SlowReport;

/// The motion from the amplitudes that were given, by the formula over the truth, a panel for each
/// coordinate; of many waves their envelopes.
///
/// # Errors
/// [`FigureError`], as of [`figure`]; without amplitudes there is no motion to draw.
pub fn picture(report: &SlowReport) -> Result<String, FigureError> {
    let slow = report.slow;
    let names: Vec<String> =
        slow.system.equations.coordinates.iter().map(ToString::to_string).collect();
    let transient = report.judged.and_then(|judged| judged.transient.as_ref());
    let drawn: Vec<[Vec<Points>; 2]> = transient
        .map(|transient| {
            let of = |rows: &[Vec<f64>], coordinate: usize| -> Points {
                let points = transient.times.iter().zip(rows);
                points.map(|(time, row)| (*time, row[coordinate])).collect()
            };
            (0..names.len())
                .map(|index| {
                    let both = [of(&transient.truth, index), of(&transient.formula, index)];
                    match waves(&both[0]) > MOST_WAVES {
                        true => both.map(|points| envelopes(&points).into()),
                        false => both.map(|points| vec![points]),
                    }
                })
                .collect()
        })
        .unwrap_or_default();
    let panels: Vec<Panel> = drawn
        .iter()
        .zip(&names)
        .map(|([truth, formula], name)| {
            let [of_truth, of_formula] = match truth.len() {
                1 => ["true motion", "slow equations"],
                _ => ["envelope of the true motion", "of the slow equations"],
            };
            let mut all = curves(truth, of_truth, CurveStyle::RUNGE_KUTTA);
            all.extend(curves(formula, of_formula, CurveStyle::FORMULA));
            Panel { title: name, x_label: "t", y_label: name, curves: all, ..Panel::default() }
        })
        .collect();
    let caption = format!(
        "Slow equations to order {} over the true motion: {}.",
        slow.order,
        names.join(", ")
    );
    figure(&panels, &caption)
}

/// Curves of one kind, of which the first has a label.
fn curves<'a>(all: &'a [Points], label: &'a str, style: CurveStyle) -> Vec<Curve<'a>> {
    let labels = std::iter::once(label).chain(std::iter::repeat(""));
    all.iter().zip(labels).map(|(points, label)| Curve { label, points, style }).collect()
}

/// Largest number of waves that are drawn one by one.
const MOST_WAVES: usize = 60;

/// The number of waves of a motion: of its largest places between two others.
fn waves(points: &Points) -> usize {
    points.windows(3).filter(|own| own[1].1 > own[0].1 && own[1].1 >= own[2].1).count()
}

/// The upper and the lower envelope of a motion: the greatest and the least place in each of equal
/// parts of the time.
fn envelopes(points: &Points) -> [Points; 2] {
    const PARTS: usize = 160;
    let parts = || points.chunks_exact(points.len().div_ceil(PARTS).max(1));
    let by_place = |one: &&(f64, f64), other: &&(f64, f64)| one.1.total_cmp(&other.1);
    [
        parts().filter_map(|part| part.iter().max_by(by_place).copied()).collect(),
        parts().filter_map(|part| part.iter().min_by(by_place).copied()).collect(),
    ]
}
