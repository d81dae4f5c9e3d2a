//! Comma-separated values: every number to its last digit, an empty cell for a missing one.

use std::fmt::Display;

use crate::report::Doubt;

/// A line of cells.
pub(super) fn line<T: ToString>(cells: impl IntoIterator<Item = T>) -> String {
    let cells: Vec<String> = cells.into_iter().map(|cell| cell.to_string()).collect();
    cells.join(",") + "\n"
}

/// A value, or an empty cell.
pub(super) fn cell<T: ToString>(value: Option<T>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

/// Text quoted for a cell if necessary (RFC 4180).
pub(super) fn quoted(text: &str) -> String {
    match text.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_owned(),
    }
}

/// The units of the columns in a comment, which readers of tables can be told to skip, and their
/// names.
pub(super) fn head<N: Display, U: Display>(columns: &[(N, U)]) -> String {
    let units: Vec<String> = columns.iter().map(|(name, unit)| format!("{name} {unit}")).collect();
    format!("# units: {}\n{}", units.join(", "), line(columns.iter().map(|(name, _)| name)))
}

/// The comment at the end of a table that ends early or is not to be trusted; empty otherwise.
pub(super) fn end(complete: bool, stop: impl Display, doubt: Option<Doubt>) -> String {
    match doubt {
        _ if !complete => format!("# incomplete: {stop}\n"),
        Some(doubt) => format!("# incomplete: {doubt}\n"),
        None => String::new(),
    }
}
