//! A comparison as comma-separated values: a row for each method; text, LaTeX and pages come from its
//! document.

use super::csv::{cell, head, line, quoted};
use crate::symbol::letters::FREQUENCY;
use crate::verify::comparison::Comparison;

/// The table: the methods that apply with their numbers and formulas, then those that do not, with
/// the reason. Cells without a value are empty.
///
/// ```
/// use lindstedt::{Oscillator, verify::comparison::compare};
///
/// let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
/// let table = compare(&pendulum, &"A = 1".parse()?, None, 0.01)?;
/// let csv = lindstedt::export::comparison::csv(&table);
/// assert!(csv.contains("lindstedt-poincare,"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn csv(comparison: &Comparison) -> String {
    let _letters = comparison.letters().in_force();
    let frequency = FREQUENCY.written();
    let mut text = head(&[
        ("method", "-"),
        ("title", "-"),
        (frequency, "rad per unit of time"),
        ("relative_error", "1"),
        ("max_deviation", "amplitude"),
        ("verdict", "-"),
        ("up_to", "unit of the coordinate"),
        ("formula", "-"),
        ("reason", "-"),
    ]);
    for row in &comparison.rows {
        let reason = row.reason.as_ref().map(ToString::to_string);
        text += &line([
            row.solution.method.name().to_owned(),
            quoted(&row.solution.title()),
            cell(row.frequency),
            cell(row.relative_error),
            cell(row.max_deviation),
            cell(row.verdict.map(|verdict| verdict.name())),
            cell(row.reach.and_then(|reach| reach.end())),
            quoted(&row.solution.formula()),
            quoted(&reason.unwrap_or_default()),
        ]);
    }
    for refused in &comparison.refused {
        let nothing = || std::iter::repeat_n(String::new(), 6);
        let names = [refused.method.name().to_owned(), quoted(refused.method.title())];
        let reason = quoted(&refused.reason.without_title(refused.method));
        text += &line(names.into_iter().chain(nothing()).chain([reason]));
    }
    text
}
