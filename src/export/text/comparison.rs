//! Every method on one equation as a table that fits the terminal.

use std::fmt::Write as _;

use super::{percent, size_in_percent};
use crate::decimal::{decimal, significant};
use crate::symbol::Symbol;
use crate::verify::Verdict;
use crate::verify::comparison::{Comparison, Row};
use crate::verify::validity::Reach;

/// Every method in one table, and below it those that do not apply, in lines of at most `width` characters where words allow
/// it. Formulas stand at the end of their rows where all of them fit there, and below the table where not.
pub fn comparison(comparison: &Comparison, width: usize) -> String {
    let at: Vec<String> = comparison
        .at
        .iter()
        .map(|(name, value)| format!("{name} = {value}"))
        .collect();
    let mut text = format!("{}\n\n", comparison.equation);
    let place = if at.is_empty() {
        String::new()
    } else {
        format!(" at {}", at.join(", "))
    };
    let unknown = || format!("not known: {}", in_words(comparison.reason.as_ref()));
    let truth = comparison.true_frequency.map_or_else(unknown, decimal);
    let _ = writeln!(text, "True omega{place}: {truth}\n");
    text.push_str(&table(comparison, width));
    let titles = comparison.rows.iter().map(|row| row.solution.title());
    let titles = titles.chain(
        comparison
            .refused
            .iter()
            .map(|refused| refused.method.title().to_owned()),
    );
    let longest = titles.map(|title| title.chars().count()).max().unwrap_or(0);
    let mut section = |heading: &str, entries: &[(String, String)]| {
        if !entries.is_empty() {
            let _ = writeln!(text, "\n{heading}");
            for (name, words) in entries {
                text.push_str(&entry(name, words, longest, width));
            }
        }
    };
    if !formulas_in_table(comparison, width) {
        let formulas = comparison.rows.iter().map(|row| (row.solution.title(), with_hbar(row)));
        section("Formulas", &formulas.collect::<Vec<_>>());
    }
    let without = comparison.rows.iter().filter(|row| row.frequency.is_none());
    let mut without: Vec<(String, String)> = without
        .map(|row| (row.solution.title(), in_words(row.reason.as_ref())))
        .collect();
    without.dedup();
    section("No frequency", &without);
    let refused = comparison.refused.iter();
    let refused = refused.map(|refused| (refused.method.title().to_owned(), refused.reason.reason(refused.method)));
    section("Not applicable", &refused.collect::<Vec<_>>());
    if !comparison.validity.is_empty() {
        text.push_str("\nTrue motion\n");
        for line in &comparison.validity {
            let _ = writeln!(text, "{}", wrapped(line, width, "  ", "    "));
        }
    }
    let convention = comparison.rows.first().map(|row| row.solution.amplitude.to_string());
    let closing = format!(
        "{}; deviation: largest over one period, of the amplitude",
        convention.unwrap_or_default()
    );
    let _ = writeln!(text, "\n{}", wrapped(&closing, width, "", ""));
    text
}

/// Header and rows, without the formulas.
fn cells(comparison: &Comparison) -> Vec<[String; 6]> {
    let within = format!("{} % up to", significant(100.0 * comparison.tolerance, 3));
    let header = ["method", "omega", "error", "deviation", "verdict", &within].map(str::to_owned);
    let row = |row: &Row| {
        [
            row.solution.title(),
            row.frequency.map_or_else(|| without_number(row).to_owned(), decimal),
            row.relative_error.map_or("-".to_owned(), percent),
            row.max_deviation.map_or("-".to_owned(), size_in_percent),
            row.verdict.map_or("-", Verdict::name).to_owned(),
            reach(row.reach, row.solution.amplitude.symbol()),
        ]
    };
    std::iter::once(header).chain(comparison.rows.iter().map(row)).collect()
}

fn widths(cells: &[[String; 6]]) -> [usize; 6] {
    std::array::from_fn(|column| cells.iter().map(|row| row[column].chars().count()).max().unwrap_or(0))
}

/// Whether every row has room for its formula.
fn formulas_in_table(comparison: &Comparison, width: usize) -> bool {
    let columns: usize = widths(&cells(comparison)).iter().map(|width| width + 2).sum();
    let formulas = comparison.rows.iter().map(|row| with_hbar(row).chars().count());
    columns + 2 + formulas.max().unwrap_or(0) <= width
}

fn table(comparison: &Comparison, width: usize) -> String {
    let cells = cells(comparison);
    let mut widths = widths(&cells);
    let numbers: usize = widths[1..].iter().map(|width| width + 2).sum();
    // Names may take a second line; numbers may not.
    const NARROWEST: usize = 16;
    widths[0] = widths[0].min(width.saturating_sub(numbers + 2).max(NARROWEST));
    let formulas = formulas_in_table(comparison, width);
    let mut formula = std::iter::once("formula".to_owned()).chain(comparison.rows.iter().map(with_hbar));
    let mut text = String::new();
    for row in &cells {
        let name = wrapped(&row[0], widths[0], "", "  ");
        let (first, more) = name.split_once('\n').unwrap_or((&name, ""));
        let mut line = format!("  {first:<width$}", width = widths[0]);
        for column in 1..6 {
            let _ = write!(line, "  {:>width$}", row[column], width = widths[column]);
        }
        if let Some(formula) = formula.next().filter(|_| formulas) {
            let _ = write!(line, "  {formula}");
        }
        let _ = writeln!(text, "{line}");
        for line in more.lines() {
            let _ = writeln!(text, "  {line}");
        }
    }
    text
}

/// A name and what is said of it: side by side where there is room, one below the other where not.
fn entry(name: &str, words: &str, longest: usize, width: usize) -> String {
    const ROOM: usize = 60;
    if width < longest + 4 + ROOM {
        return format!("  {name}\n{}\n", wrapped(words, width, "    ", "      "));
    }
    let first = format!("  {name:<longest$}  ");
    wrapped(words, width, &first, &" ".repeat(longest + 4)) + "\n"
}

/// Text in lines of at most `width` characters, `first` before the first of them and `next` before the others. A sign stays
/// with the term that it belongs to, and a value with its name.
fn wrapped(text: &str, width: usize, first: &str, next: &str) -> String {
    let mut lines = vec![first.to_owned()];
    let mut indent = first.chars().count();
    let mut words: Vec<String> = Vec::new();
    let mut together = false;
    for word in text.split(' ') {
        match words.last_mut() {
            Some(last) if together || word == "=" => {
                last.push(' ');
                last.push_str(word);
            }
            _ => words.push(word.to_owned()),
        }
        together = matches!(word, "+" | "-" | "=");
    }
    for word in words {
        let line = lines.last_mut().expect("a line was begun");
        let length = line.chars().count();
        if length == indent {
            line.push_str(&word);
        } else if length + 1 + word.chars().count() <= width {
            line.push(' ');
            line.push_str(&word);
        } else {
            lines.push(format!("{next}{word}"));
            indent = next.chars().count();
        }
    }
    lines.join("\n")
}

fn in_words(reason: Option<&impl ToString>) -> String {
    reason.map(ToString::to_string).unwrap_or_default()
}

/// What stands in the place of a frequency.
fn without_number(row: &Row) -> &'static str {
    match &row.reason {
        Some(reason) if reason.is_not_real() => "not real",
        _ => "none",
    }
}

/// The formula of a row, and the hbar with which it was evaluated.
fn with_hbar(row: &Row) -> String {
    let hbar = row.chosen_hbar();
    let value = hbar.map(|(name, value)| format!(", {name} = {}", significant(value, 6)));
    row.solution.formula() + &value.unwrap_or_default()
}

fn reach(reach: Option<Reach>, amplitude: Symbol) -> String {
    match reach {
        None => "-".to_owned(),
        Some(Reach::Nowhere) => "nowhere".to_owned(),
        Some(Reach::UpTo(end)) => format!("{amplitude} = {}", significant(end, 3)),
        Some(Reach::Everywhere(searched)) => format!("past {amplitude} = {}", significant(searched, 3)),
    }
}
