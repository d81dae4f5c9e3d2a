//! Comparison of all methods on one impact: the equation, a row for each method, and the reasons
//! for the methods without one.

use super::impact::problem_blocks;
use super::{Block, Document};
use crate::impact::ImpactComparison;

/// The document of a table of methods on one impact.
///
/// ```
/// use lindstedt::impact::{Setup, compare};
///
/// let table = compare(Setup { stiffness: 1e6, ..Setup::default() })?;
/// let document = lindstedt::report::impact_comparison(&table, 0.01);
/// assert!(lindstedt::export::text::document(&document, 120).contains("Lindstedt-Poincare"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn impact_comparison(table: &ImpactComparison, tolerance: f64) -> Document<'_> {
    let mut sections = vec![
        vec![Block::QuestionAsTyped(&table.equation)],
        problem_blocks(
            &table.setup,
            table.letters,
            [table.equilibrium, table.turning_point],
            table.damping,
        ),
        vec![Block::ImpactMethods {
            rows: &table.rows,
            truth: table.truth.quantities(),
            tolerance,
        }],
    ];
    if !table.refused.is_empty() {
        let entries = table.refused.iter();
        sections.push(vec![Block::Entries {
            heading: "Not applicable",
            entries: entries
                .map(|(method, reason)| (method.title().to_owned(), reason.clone()))
                .collect(),
        }]);
    }
    Document { sections }
}
