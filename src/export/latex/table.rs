//! A table as LaTeX.

use super::rows::width;
use super::{formula_in_words, scientific_text, words};
use crate::report::{Heading, are_names};

/// A table whose cells are LaTeX already.
pub(in crate::export) struct LatexTable {
    /// The alignment of each column: `l`, `r`.
    pub(in crate::export) places: String,
    /// The heading of each column.
    pub(in crate::export) head: Vec<String>,
    /// A cell for each column.
    pub(in crate::export) rows: Vec<Vec<String>>,
    /// Whether a line is above it and one below.
    pub(in crate::export) framed: bool,
}

impl LatexTable {
    /// A table whose first column stands on the left and every other one on the right.
    pub(super) fn of_numbers(head: Vec<String>, rows: Vec<Vec<String>>) -> Self {
        Self {
            places: format!("l{}", "r".repeat(head.len().saturating_sub(1))),
            head,
            rows,
            framed: false,
        }
    }

    /// The LaTeX text: a table wider than a line is set in small letters with its widest columns as
    /// paragraphs; one longer than a page extends over several.
    pub(in crate::export) fn written(&self) -> String {
        const LINES_OF_A_PAGE: usize = 44;
        let widths = self.widths();
        let gaps = GAP * widths.len() as f64;
        let fits = widths.iter().sum::<f64>() + gaps <= LINE;
        let widest = if fits { f64::INFINITY } else { cap(&widths, SMALL_LINE - gaps) };
        let place = |(place, width): (char, &f64)| match *width > widest {
            // The columns are given a little less than the line, for the gaps that TeX adds.
            true => format!("p{{{:.2}\\linewidth}}", 0.97 * widest / SMALL_LINE),
            false => place.to_string(),
        };
        let places: String = self.places.chars().zip(&widths).map(place).collect();
        let end = if fits { "\\\\" } else { "\\tabularnewline" };
        let line = |cells: &Vec<String>| {
            let cells = cells.iter().zip(&widths).map(|(cell, width)| match *width > widest {
                true => format!("\\raggedright {cell}"),
                false => cell.clone(),
            });
            cells.collect::<Vec<_>>().join(" & ") + " " + end + "\n"
        };
        let frame = if self.framed { "\\hline\n" } else { "" };
        let head = line(&self.head);
        let rows: String = self.rows.iter().map(line).collect();
        let kind = if self.rows.len() > LINES_OF_A_PAGE { "longtable" } else { "tabular" };
        let table = format!(
            "\\begin{{{kind}}}{{{places}}}\n{frame}{head}\\hline\n{rows}{frame}\\end{{{kind}}}\n\n"
        );
        match fits {
            true => table,
            false => {
                format!("{{\\footnotesize\\setlength{{\\tabcolsep}}{{3pt}}\\noindent\n{table}}}\n")
            }
        }
    }

    /// The width of each column in characters.
    fn widths(&self) -> Vec<f64> {
        let width = |column: usize| {
            let cells = std::iter::once(&self.head).chain(&self.rows);
            let cells = cells.filter_map(|row| row.get(column));
            cells.map(|cell| cell_width(cell)).fold(0.0, f64::max)
        };
        (0..self.places.chars().count()).map(width).collect()
    }
}

/// The number of characters of a line, of ordinary size and small.
const LINE: f64 = 76.0;
const SMALL_LINE: f64 = 96.0;

/// The width of the gap between two columns.
const GAP: f64 = 2.0;

/// The width of a cell: of its words as they are, of its formulas as they are set.
fn cell_width(cell: &str) -> f64 {
    let pieces = cell.split('$').enumerate();
    let width = |(place, piece): (usize, &str)| match place % 2 {
        0 => piece.chars().filter(|letter| !"\\{}".contains(*letter)).count() as f64,
        _ => width(piece),
    };
    pieces.map(width).sum()
}

/// The width that no column may exceed so that all of them take `room` together.
fn cap(widths: &[f64], room: f64) -> f64 {
    let mut sorted = widths.to_vec();
    sorted.sort_by(f64::total_cmp);
    let (mut left, mut columns) = (room, sorted.len());
    for width in sorted {
        let share = left / columns as f64;
        if width > share {
            return share;
        }
        left -= width;
        columns -= 1;
    }
    f64::INFINITY
}

/// The head of a table, a name each.
pub(super) fn head(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

/// A table of numbers and words.
pub(super) fn table(head: &[Heading], rows: &[Vec<String>]) -> LatexTable {
    let cell = |cell: &String| match cell.parse::<f64>() {
        Ok(_) => format!("${}$", scientific_text(cell)),
        Err(_) => {
            formula_in_words(cell).map_or_else(|| words(cell), |formula| format!("${formula}$"))
        }
    };
    let mut places = "r".repeat(head.len());
    if are_names(rows) {
        places.replace_range(..1, "l");
    }
    LatexTable {
        places,
        head: head.iter().map(|heading| heading.latex.to_owned()).collect(),
        rows: rows.iter().map(|row| row.iter().map(cell).collect()).collect(),
        framed: false,
    }
}
