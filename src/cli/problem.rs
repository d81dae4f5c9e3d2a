//! PROBLEM on the command line: an equation in quotes, a TOML file, a name of the catalogue, or -
//! for standard input.

use std::path::Path;

use crate::Symbol;
use crate::catalog;
use crate::catalog::nearest;
use crate::coupled::{CoupledEquations, CoupledError};
use crate::expr::{Expr, ParseError, equation_in_grammar, expression_in_grammar, parse_expression};
use crate::problem::{Problem, ProblemError, ReadingCommand};

use super::files::is_standard;
use super::{Failure, read, session};

/// Reads a PROBLEM. A name that ends in `.toml`, or a file that exists, is a file. An equation may
/// have the notations of print; how it was read is said on standard error.
///
/// # Errors
/// A file that cannot be read or is no problem; a single word that is neither an equation nor a
/// name.
pub(super) fn problem(text: &str) -> Result<Problem, Failure> {
    let problem = match path(text) {
        Some(path) => from_file(path),
        None => from_words(text),
    }?;
    let equation = problem.equation.map(|typed| {
        let parts: Vec<_> = typed.split(';').map(equation_in_grammar).collect();
        let read = parts.join(";");
        if read != typed {
            session::current().note(&match parts.len() {
                1 => format!("the equation is read as {read}"),
                _ => format!("the equations are read as {read}"),
            });
        }
        read
    });
    Ok(Problem { equation, ..problem })
}

/// The equations of a problem of several coordinates: separated by `;`, a list of a file, or those of
/// a mechanism, then with their energy; `None` for one equation.
///
/// # Errors
/// A key that the command would ignore; equations that do not belong together.
pub(super) fn coupled_equations(
    problem: &Problem,
    reader: ReadingCommand,
) -> Result<Option<CoupledEquations>, Failure> {
    let coupled = |error: CoupledError| Failure::refused(&error, error.help());
    let of_file = |error: ProblemError| Failure::refused(&error, error.help());
    if let Some(equations) = problem.coupled_equations(reader).map_err(of_file)? {
        return CoupledEquations::of_mechanism(&equations).map(Some).map_err(coupled);
    }
    match &problem.equation {
        Some(text) if text.contains(';') => {
            problem.check_keys(reader).map_err(of_file)?;
            CoupledEquations::parse(text).map(Some).map_err(coupled)
        }
        _ => Ok(None),
    }
}

/// Reads an expression of the command line, which may have the notations of print.
///
/// # Errors
/// See [`parse_expression`].
pub(super) fn expression(text: &str) -> Result<Expr, ParseError> {
    parse_expression(&expression_in_grammar(text))
}

/// The name of a value on the command line, `ε` for `eps`.
pub(super) fn value_name(text: &str) -> Symbol {
    let name = expression(text).ok().and_then(|name| name.as_symbol());
    name.unwrap_or_else(|| Symbol::new(text.trim()))
}

/// The file that a PROBLEM names, where it names one.
pub(super) fn path(text: &str) -> Option<&Path> {
    let path = Path::new(text);
    (is_standard(path) || text.ends_with(".toml") || path.is_file()).then_some(path)
}

/// Reads a problem file, or standard input for `-`, which may also hold a bare equation or a name.
///
/// # Errors
/// See [`problem`].
pub(super) fn from_file(path: &Path) -> Result<Problem, Failure> {
    let text = read(path)?;
    // Only TOML assigns to a bare key.
    let is_toml = text.lines().any(|line| {
        let line = line.trim_start();
        let key: String = line.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        line.starts_with('[') || (key.len() > 1 && line[key.len()..].trim_start().starts_with('='))
    });
    if is_standard(path) && !is_toml {
        return from_words(text.trim_end());
    }
    text.parse().map_err(|error: ProblemError| {
        let name = if is_standard(path) { "standard input".into() } else { path.to_string_lossy() };
        Failure::refused(&format!("{name}: {error}"), error.help()).of_kind(&error)
    })
}

/// A name of the catalogue, or an equation.
fn from_words(text: &str) -> Result<Problem, Failure> {
    let with_equation =
        |equation: &str| Problem { equation: Some(equation.to_owned()), ..Problem::default() };
    // Words alone cannot be an equation: they are a name, perhaps with a slip in it, or a file that
    // is not there.
    let word = text.split_whitespace().collect::<Vec<_>>().join("-");
    if let Some(entry) = catalog::find(&word.replace('_', "-")) {
        let of_file = |error: ProblemError| Failure::refused(&error, error.help());
        return match entry.walls {
            [] => Ok(with_equation(entry.equation)),
            _ => entry.problem_file().parse().map_err(of_file),
        };
    }
    let is_word = word.len() > 1
        && word.starts_with(|letter: char| letter.is_ascii_alphabetic())
        && word.chars().all(|letter| letter.is_ascii_alphanumeric() || "-_./".contains(letter));
    if is_word {
        let help = match nearest(&word, catalog::CATALOG.iter().map(|entry| entry.name)) {
            Some(near) => format!("did you mean `{near}`?"),
            None => "write an equation such as \"x'' + sin(x) = 0\"; `lindstedt catalog` lists the names".to_owned(),
        };
        return Err(Failure::because(format!(
            "`{}` is no equation, no file, and no name of the catalogue\n  help: {help}",
            text.trim()
        )));
    }
    Ok(with_equation(text))
}
