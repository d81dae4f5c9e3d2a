//! The program of a frequency law on a range, with its proved bound in the comment.

use super::program::lines_of;
use super::{NoCode, Program, Routine, Statement, Value};
use crate::certificate::LawQuantity;
use crate::report::{Block, Document, ShortestReport};
use crate::shortest::Atom;

/// The program of the law that is shown first.
///
/// # Errors
/// [`NoCode`] where there is none.
pub(super) fn program(report: &ShortestReport, document: &Document) -> Result<Program, NoCode> {
    let front = report.front;
    let law = report.shown().ok_or(NoCode::NoMotion(None))?;
    let expression = law.formula.expression().map_err(|_| NoCode::Beyond)?;
    let letters = expression.symbols();
    let written = law.formula.written().unwrap_or(expression);
    let variable = front.problem.variable;
    let atoms =
        front.atoms.iter().filter(|atom| atom.name != variable && letters.contains(&atom.name));
    // The restitution of a contact is an argument of its own.
    let (known, given): (Vec<&Atom>, Vec<&Atom>) = atoms.partition(|atom| atom.meaning.is_some());
    let meanings = known.iter().filter_map(|atom| Some((atom.name, atom.meaning.clone()?)));
    let body = meanings
        .map(|(name, meaning)| Statement::Variable(name, Value::Expression(meaning)))
        .collect();
    let own = std::iter::once(variable).filter(|name| given.is_empty() || letters.contains(name));
    let arguments = own.chain(given.iter().map(|atom| atom.name)).collect();
    let (name, about) = match front.quantity {
        LawQuantity::Frequency => ("angular_frequency", "The angular frequency"),
        LawQuantity::FrequencySquared => {
            ("squared_frequency", "The square of the angular frequency")
        }
        LawQuantity::Period => ("period_over_two_pi", "The period over 2 pi"),
        LawQuantity::ContactTime => {
            ("contact_time_ratio", "The duration of a contact over that without damping")
        }
    };
    // The table of all laws and the published ones are not of this program.
    let of_law = document.sections.iter().take(2).map(|section| {
        let words = section.iter().filter(|block| !matches!(block, Block::Table { .. }));
        words.cloned().collect()
    });
    Ok(Program {
        header: lines_of(&Document { sections: of_law.collect() }),
        routines: vec![Routine {
            name: name.to_owned(),
            about: format!("{about} for {}", report.range()),
            arguments,
            body,
            result: Value::Expression(written),
        }],
    })
}
