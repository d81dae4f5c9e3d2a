//! The transition curves of a linear equation with periodic coefficients, compared with Floquet's
//! multipliers.

use std::borrow::Cow;

use super::{Block, Document, percent};
use crate::decimal::{decimal, significant};
use crate::derivation::DerivationLine;
use crate::expr::Expr;
use crate::hill::{JudgedCurve, TransitionCurve, TransitionCurves};
use crate::values::Values;

/// Transition curves to be reported.
#[derive(Clone, Copy, Debug)]
pub struct StabilityReport<'a> {
    /// The curves.
    pub curves: &'a TransitionCurves,
    /// The given values and the verdict on each curve; `None` without values.
    pub judged: Option<(&'a Values, &'a [JudgedCurve])>,
    /// The largest error of a passing curve.
    pub tolerance: f64,
}

impl StabilityReport<'_> {
    /// Whether every curve passes; `None` without values.
    pub fn passes(&self) -> Option<bool> {
        let (_, judged) = self.judged?;
        Some(judged.iter().all(|curve| curve.passes))
    }
}

/// The document of transition curves.
///
/// ```
/// use lindstedt::Oscillator;
/// use lindstedt::hill::{HillOptions, transition_curves};
/// use lindstedt::report::{StabilityReport, stability};
///
/// let mathieu = Oscillator::parse("x'' + (delta + eps*cos(2*t))*x = 0")?;
/// let curves = transition_curves(&mathieu, &HillOptions::default())?;
/// let report = StabilityReport { curves: &curves, judged: None, tolerance: 0.01 };
/// let text = lindstedt::export::text::document(&stability(&report), 100);
/// assert!(text.contains("delta   = 1 + eps/2 - eps^2/32"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn stability<'a>(report: &StabilityReport<'a>) -> Document<'a> {
    let curves = report.curves;
    let mut sections = vec![vec![Block::Question(&curves.equation)]];
    let heading = format!(
        "Transition curves to order {} in {}; rest is unstable between the two of one number",
        curves.order,
        curves.small_in_words()
    );
    let mut blocks = vec![Block::Heading(heading)];
    let mut number = None;
    for curve in &curves.curves {
        if number != Some(curve.tongue) {
            number = Some(curve.tongue);
            blocks.push(Block::Remark(of_number(curves, curve.tongue)));
        }
        blocks.push(equation(curves, curve));
    }
    sections.push(blocks);
    sections.push(validity(curves));
    if let Some((at, judged)) = report.judged {
        sections.push(verdicts(report, at, judged));
    }
    Document { sections }
}

/// The curves of a number, and the motion that exists on them.
fn of_number(curves: &TransitionCurves, tongue: usize) -> String {
    let names = curves.curves.iter().filter(|curve| curve.tongue == tongue);
    let names: Vec<&str> = names.map(|curve| curve.name.as_str()).collect();
    let period = curves.period().map(|period| match tongue % 2 {
        0 => period,
        _ => &period + &period,
    });
    match period {
        Ok(period) => format!("{}: motions of the period {period}", names.join(", ")),
        Err(_) => names.join(", "),
    }
}

fn equation<'a>(curves: &TransitionCurves, curve: &TransitionCurve) -> Block<'a> {
    let left = Expr::from(&curves.unknown.given());
    match (&curve.under_root, curve.expression()) {
        (Some(_), Ok(right)) => Block::Line(Cow::Owned(DerivationLine::equation(left, right))),
        _ => Block::Law { left, right: curves.ordered(&curve.middle) },
    }
}

fn validity<'a>(curves: &TransitionCurves) -> Vec<Block<'a>> {
    let mut blocks = vec![
        Block::Heading("Validity".to_owned()),
        Block::Note(format!(
            "truncated after powers of {} that together are {}; an expansion for small {}",
            curves.small_in_words(),
            curves.order,
            curves.small_in_words()
        )),
    ];
    if let Some(name) = curves.time_scale {
        blocks.push(Block::Note(format!("derived in the dimensionless time tau = {name}*t")));
    }
    for pair in curves.curves.windows(2) {
        let same = pair[0].tongue == pair[1].tongue && pair[0].middle == pair[1].middle;
        if same && pair[0].under_root.is_none() {
            blocks.push(Block::Note(format!(
                "{} and {} agree to this order",
                pair[0].name, pair[1].name
            )));
        }
    }
    if curves.curves.iter().any(|curve| curve.under_root.is_some()) {
        blocks.push(Block::Note(
            "where what stands under the root is negative, the tongue does not reach so far: with positive damping rest is stable there"
                .to_owned(),
        ));
    }
    blocks
}

fn verdicts<'a>(
    report: &StabilityReport<'a>,
    at: &'a Values,
    judged: &[JudgedCurve],
) -> Vec<Block<'a>> {
    let values: Vec<String> = at.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    let head = [
        ("curve", "curve"),
        ("formula", "formula"),
        ("true", "true"),
        ("error", "error"),
        ("verdict", "verdict"),
    ];
    let number = |value: Option<f64>| value.map_or("none".to_owned(), decimal);
    let row = |curve: &JudgedCurve| {
        vec![
            report.curves.curves[curve.curve].name.clone(),
            number(curve.value),
            number(curve.truth),
            curve.relative_error.map_or(String::new(), percent),
            if curve.passes { "pass" } else { "fail" }.to_owned(),
        ]
    };
    vec![
        Block::Heading(format!(
            "{} at {}; within {}",
            report.curves.unknown.symbol(),
            values.join(", "),
            format_args!("{} %", significant(100.0 * report.tolerance, 3))
        )),
        Block::table(head, judged.iter().map(row)),
        Block::Note(format!(
            "true: by Hill's determinant, confirmed by Floquet's multipliers of the integrated motion; none: {}",
            match report.curves.unknown.power() {
                power if power % 2 == 0 && report.curves.time_scale.is_some() =>
                    format!("no real {} lies on the curve there", report.curves.unknown.symbol()),
                _ => "the tongue does not reach so far".to_owned(),
            }
        )),
    ]
}
