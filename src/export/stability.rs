//! Transition curves as comma-separated values and as a picture; text and LaTeX by their
//! `document`.

use std::fmt::Write as _;

use super::csv::cell;
use super::figure::{CurveStyle, FigureError, Points, curve, figure, panel};
use crate::hill::{Chart, TransitionCurves};
use crate::symbol::Symbol;

/// Name of the curve, the small parameter, the unknown by the formula and its true value; cells
/// without a value are empty.
///
/// ```
/// use lindstedt::Oscillator;
/// use lindstedt::hill::{HillOptions, chart, transition_curves};
///
/// let mathieu = Oscillator::parse("x'' + (delta + eps*cos(2*t))*x = 0")?;
/// let curves = transition_curves(&mathieu, &HillOptions { tongues: 1, ..HillOptions::default() })?;
/// let chart = chart(&curves, &Default::default(), "eps".into(), 0.5, 10)?;
/// let table = lindstedt::export::stability::csv(&curves, "eps".into(), &chart);
/// assert_eq!(table.lines().count(), 1 + 3 * 11);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn csv(curves: &TransitionCurves, by: Symbol, charts: &[Chart]) -> String {
    let unknown = curves.unknown.symbol();
    let mut text = format!("curve,{by},{unknown}_formula,{unknown}_true\n");
    for chart in charts {
        let mut sizes: Vec<f64> =
            chart.formula.iter().chain(&chart.truth).map(|point| point.1).collect();
        sizes.sort_by(f64::total_cmp);
        sizes.dedup();
        let at = |points: &[(f64, f64)], size: f64| {
            cell(points.iter().find(|point| point.1 == size).map(|point| point.0))
        };
        for size in sizes {
            let name = &curves.curves[chart.curve].name;
            let _ = writeln!(
                text,
                "{name},{size},{},{}",
                at(&chart.formula, size),
                at(&chart.truth, size)
            );
        }
    }
    text
}

/// The chart of Ince and Strutt: the small parameter against the unknown, every curve over the
/// truth.
///
/// # Errors
/// As [`figure`].
pub fn picture(
    curves: &TransitionCurves,
    by: Symbol,
    charts: &[Chart],
    caption: &str,
) -> Result<String, FigureError> {
    let unknown = curves.unknown.symbol().to_string();
    let all = || charts.iter().flat_map(|chart| &chart.truth).map(|point| point.0);
    let (least, most) = all().fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), value| {
        (least.min(value), most.max(value))
    });
    // The range is limited, because a formula far beyond its own range would hide the rest.
    let margin = 0.1 * (most - least);
    let formulas: Vec<Points> = charts
        .iter()
        .map(|chart| {
            let near = |point: &&(f64, f64)| point.0 >= least - margin && point.0 <= most + margin;
            chart.formula.iter().take_while(near).copied().collect()
        })
        .collect();
    let drawn = |points: &[(f64, f64)]| points.len() > 1;
    let truths = charts
        .iter()
        .filter(|chart| drawn(&chart.truth))
        .map(|chart| curve("true motion", &chart.truth, CurveStyle::RUNGE_KUTTA));
    let label = format!("order {}", curves.order);
    let formulas = formulas
        .iter()
        .filter(|points| drawn(points))
        .map(|points| curve(&label, points, CurveStyle::FORMULA));
    let title = "Transition curves: rest is unstable inside the tongues";
    let curves = truths.chain(formulas).collect();
    figure(&[panel(title, [&unknown, by.name()], curves, vec![])], caption)
}
