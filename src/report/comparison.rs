//! Comparison of all methods on one equation.

use super::{Block, Document, MethodRow};
use crate::verify::comparison::{Comparison, ComparisonRow};

/// The document of a comparison: the truth, the table, the reasons for rows without a frequency,
/// the methods that do not apply, and the ranges in which the true motion is periodic.
///
/// ```
/// use lindstedt::{Oscillator, verify::comparison::compare};
///
/// let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
/// let table = compare(&pendulum, &"A = 1".parse()?, None, 0.01)?;
/// let document = lindstedt::report::comparison(&table);
/// assert!(!document.sections.is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn comparison(comparison: &Comparison) -> Document<'_> {
    let reason = || comparison.reason.as_ref().map(ToString::to_string);
    let truth = Block::Truth {
        equation: &comparison.equation,
        at: &comparison.at,
        frequency: comparison.true_frequency.ok_or_else(|| reason().unwrap_or_default()),
    };
    let methods = Block::Methods {
        rows: comparison.rows.iter().map(method_row).collect(),
        at: &comparison.at,
        tolerance: comparison.tolerance,
    };
    let without = comparison.rows.iter().filter(|row| row.frequency.is_none());
    let mut without: Vec<(String, String)> = without
        .map(|row| {
            let reason = row.reason.as_ref().map(ToString::to_string);
            (row.solution.title(), reason.unwrap_or_default())
        })
        .collect();
    without.dedup();
    let mut sections = vec![vec![truth], vec![methods]];
    if !without.is_empty() {
        sections.push(vec![Block::Entries { heading: "No frequency", entries: without }]);
    }
    if !comparison.refused.is_empty() {
        sections.push(vec![Block::Refused(&comparison.refused)]);
    }
    if !comparison.validity.is_empty() {
        sections.push(vec![Block::TrueMotion(&comparison.validity)]);
    }
    let answer = comparison.rows.first().map(|row| &row.solution);
    let convention = answer.map(|answer| answer.amplitude.in_words(answer.coordinate()));
    let over = match comparison.rows.iter().any(|row| row.solution.slow().is_some()) {
        true => "all of that time, of the amplitude at the start",
        false => "one period, of the amplitude",
    };
    sections.push(vec![Block::Closing(format!(
        "{}; deviation: largest over {over}",
        convention.unwrap_or_default()
    ))]);
    Document { sections }
}

fn method_row(row: &ComparisonRow) -> MethodRow<'_> {
    MethodRow {
        row,
        title: row.solution.title(),
        law: row.solution.law.in_one_line(),
        definitions: row.solution.definitions_of_formula(),
        hbar: row.chosen_hbar(),
    }
}
