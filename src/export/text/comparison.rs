//! The blocks of a comparison as text: a table that fits the terminal, and lists.

use std::fmt::Write as _;

use super::{TextLayout, percent, size_in_percent};
use crate::decimal::{decimal, significant};
use crate::expr::Equation;
use crate::report::{Block, Document, MethodRow};
use crate::symbol::Symbol;
use crate::symbol::letters::FREQUENCY;
use crate::values::Values;
use crate::verify::Verdict;
use crate::verify::comparison::{ComparisonRow, Refused};
use crate::verify::validity::AmplitudeReach;

/// The length of the longest name of a method in the tables and lists of a document.
pub(super) fn longest_title(document: &Document) -> usize {
    let length = |title: &str| title.chars().count();
    let longest = |block: &Block| match block {
        Block::Methods { rows, .. } => rows.iter().map(|row| length(&row.title)).max(),
        Block::Refused(refused) => {
            refused.iter().map(|refused| length(refused.method.title())).max()
        }
        _ => None,
    };
    document.sections.iter().flatten().filter_map(longest).max().unwrap_or(0)
}

pub(super) fn truth(equation: &Equation, at: &Values, frequency: &Result<f64, String>) -> String {
    format!("{equation}\n\n{}\n", true_frequency(at, frequency))
}

/// The frequency that a table is compared with.
pub(in crate::export) fn true_frequency(at: &Values, frequency: &Result<f64, String>) -> String {
    let at: Vec<String> = at.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    let place = match at.is_empty() {
        true => String::new(),
        false => format!(" at {}", at.join(", ")),
    };
    let truth = match frequency {
        Ok(frequency) => decimal(*frequency),
        Err(reason) => format!("not known: {reason}"),
    };
    format!("True {FREQUENCY}{place}: {truth}")
}

/// The table, with the formulas below it if they do not fit its rows.
pub(super) fn methods(rows: &[MethodRow], tolerance: f64, page: &TextLayout) -> String {
    let cells = cells(rows, tolerance);
    let formulas: Vec<String> = rows.iter().map(formula).collect();
    let widths = widths(&cells);
    let columns: usize = widths.iter().map(|width| width + 2).sum();
    let longest = formulas.iter().map(|formula| formula.chars().count()).max();
    let room = columns + 2 + longest.unwrap_or(0) <= page.width;
    let mut text = table(&cells, widths, room.then_some(&formulas), page.width);
    if !room {
        let formulas = rows.iter().map(|row| row.title.clone()).zip(formulas);
        text.push('\n');
        text.push_str(&entries("Formulas", &formulas.collect::<Vec<_>>(), page));
    }
    text
}

/// Names with the same text grouped together, and the text of each group.
pub(in crate::export) fn grouped(
    entries: impl Iterator<Item = (String, String)>,
) -> Vec<(Vec<String>, String)> {
    let mut groups: Vec<(Vec<String>, String)> = Vec::new();
    for (name, words) in entries {
        match groups.iter_mut().find(|(_, known)| *known == words) {
            Some((names, _)) => names.push(name),
            None => groups.push((vec![name], words)),
        }
    }
    groups
}

/// Names and reasons; names with the same reason are grouped together.
fn reasons(
    heading: &str,
    entries: impl Iterator<Item = (String, String)>,
    page: &TextLayout,
) -> String {
    let groups = grouped(entries);
    let groups = groups.iter().map(|(names, words)| match names.as_slice() {
        [name] => entry(name, words, page.longest_title, page.width),
        names => {
            let names = wrapped(&format!("{}:", names.join(", ")), page.width, "  ", "  ");
            format!("{names}\n{}\n", wrapped(words, page.width, "    ", "    "))
        }
    });
    format!("{heading}\n") + &groups.collect::<String>()
}

/// Names with a text for each.
pub(super) fn entries(heading: &str, entries: &[(String, String)], page: &TextLayout) -> String {
    let entries =
        entries.iter().map(|(name, words)| entry(name, words, page.longest_title, page.width));
    format!("{heading}\n") + &entries.collect::<String>()
}

pub(super) fn refused(refused: &[Refused], page: &TextLayout) -> String {
    let named = |refused: &Refused| {
        let reason = refused.reason.without_title(refused.method);
        (refused.method.title().to_owned(), reason)
    };
    reasons("Not applicable", refused.iter().map(named), page)
}

pub(super) fn true_motion(lines: &[String], width: usize) -> String {
    let lines = lines.iter().map(|line| wrapped(line, width, "  ", "    ") + "\n");
    "True motion\n".to_owned() + &lines.collect::<String>()
}

/// Header and rows, without the formulas.
pub(in crate::export) fn cells(rows: &[MethodRow], tolerance: f64) -> Vec<[String; 6]> {
    let over_several_wells =
        rows.iter().any(|row| matches!(row.row.reach, Some(AmplitudeReach::Between { .. })));
    let range = if over_several_wells { "for" } else { "up to" };
    let within = format!("{} % {range}", significant(100.0 * tolerance, 3));
    let header = ["method", FREQUENCY.written(), "error", "deviation", "verdict", &within]
        .map(str::to_owned);
    // All rows use the start of the first one, whatever the amplitude in their formulas means.
    let amplitude = rows.first().map(|first| first.row.solution.amplitude.symbol());
    let cells = |MethodRow { row, title, .. }: &MethodRow| {
        [
            title.clone(),
            row.frequency.map_or_else(|| without_number(row).to_owned(), decimal),
            row.relative_error.map_or("-".to_owned(), percent),
            row.max_deviation.map_or("-".to_owned(), size_in_percent),
            row.verdict.map_or("-", Verdict::name).to_owned(),
            reach(row.reach.zip(amplitude)),
        ]
    };
    std::iter::once(header).chain(rows.iter().map(cells)).collect()
}

fn widths(cells: &[[String; 6]]) -> [usize; 6] {
    std::array::from_fn(|column| {
        cells.iter().map(|row| row[column].chars().count()).max().unwrap_or(0)
    })
}

fn table(
    cells: &[[String; 6]],
    mut widths: [usize; 6],
    formulas: Option<&Vec<String>>,
    width: usize,
) -> String {
    let numbers: usize = widths[1..].iter().map(|width| width + 2).sum();
    // Names may take a second line; numbers may not.
    const NARROWEST: usize = 16;
    widths[0] = widths[0].min(width.saturating_sub(numbers + 2).max(NARROWEST));
    let header = formulas.map(|_| "formula");
    let mut formulas = header.into_iter().chain(formulas.into_iter().flatten().map(String::as_str));
    let mut text = String::new();
    for row in cells {
        let name = wrapped(&row[0], widths[0], "", "  ");
        let (first, more) = name.split_once('\n').unwrap_or((&name, ""));
        let mut line = format!("  {first:<width$}", width = widths[0]);
        for column in 1..6 {
            let _ = write!(line, "  {:>width$}", row[column], width = widths[column]);
        }
        if let Some(formula) = formulas.next() {
            let _ = write!(line, "  {formula}");
        }
        let _ = writeln!(text, "{line}");
        for line in more.lines() {
            let _ = writeln!(text, "  {line}");
        }
    }
    text
}

/// A name and its text: side by side if there is room, otherwise one below the other.
fn entry(name: &str, words: &str, longest: usize, width: usize) -> String {
    const ROOM: usize = 60;
    if width < longest + 4 + ROOM {
        return format!("  {name}\n{}\n", wrapped(words, width, "    ", "      "));
    }
    let first = format!("  {name:<longest$}  ");
    wrapped(words, width, &first, &" ".repeat(longest + 4)) + "\n"
}

/// Text in lines of at most `width` characters, `first` before the first of them and `next` before
/// the others. A sign stays with the term that it belongs to, and a value with its name.
pub(super) fn wrapped(text: &str, width: usize, first: &str, next: &str) -> String {
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

/// The text in place of a frequency.
fn without_number(row: &ComparisonRow) -> &'static str {
    match &row.reason {
        Some(reason) if reason.is_not_real() => "not real",
        _ => "none",
    }
}

/// The formula of a row, and the hbar with which it was evaluated.
fn formula(row: &MethodRow) -> String {
    let value = row.hbar.map(|(name, value)| format!(", {name} = {}", significant(value, 6)));
    row.row.solution.formula() + &value.unwrap_or_default()
}

fn reach(reach: Option<(AmplitudeReach, Symbol)>) -> String {
    match reach {
        None => "-".to_owned(),
        Some((AmplitudeReach::Nowhere, _)) => "nowhere".to_owned(),
        Some((AmplitudeReach::UpTo(end), amplitude)) => {
            format!("{amplitude} = {}", significant(end, 3))
        }
        Some((AmplitudeReach::Between { from, to, open }, amplitude)) => {
            let [from, to] = [from, to].map(|end| significant(end, 3));
            let past = if open { "past " } else { "" };
            format!("{amplitude} = {from} to {past}{to}")
        }
        Some((AmplitudeReach::Everywhere(searched), amplitude)) => {
            format!("past {amplitude} = {}", significant(searched, 3))
        }
    }
}
