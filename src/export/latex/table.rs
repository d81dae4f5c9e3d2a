//! A table as LaTeX.

use super::rows::{in_open_brackets, longest_term, width, with_solidus};
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
        const LINES_OF_A_PAGE: f64 = 44.0;
        let widths = self.widths(cell_width);
        let columns = widths.len() as f64;
        let fits = widths.iter().sum::<f64>() + GAP * columns <= LINE;
        let pieces = self.widths(longest_piece);
        // A little less than the line, for the gaps that TeX adds.
        let room = |size: &Small| 0.97 * size.line - size.gap * columns;
        let has_room = |size: &&Small| pieces.iter().sum::<f64>() <= room(size);
        let size = SMALL.iter().find(has_room).unwrap_or(&SMALL[0]);
        let set = match fits {
            true => widths.clone(),
            false => narrowed(&widths, &pieces, room(size)),
        };
        let is_narrowed: Vec<bool> =
            widths.iter().zip(&set).map(|(width, set)| set < width).collect();
        let place = |(place, (set, narrowed)): (char, (&f64, &bool))| match narrowed {
            true => format!("p{{{:.3}\\linewidth}}", set / size.line),
            false => place.to_string(),
        };
        let places: String =
            self.places.chars().zip(set.iter().zip(&is_narrowed)).map(place).collect();
        let end = if fits { "\\\\" } else { "\\tabularnewline" };
        let line = |cells: &Vec<String>| {
            let cells = cells.iter().zip(self.places.chars()).zip(set.iter().zip(&is_narrowed));
            let cells = cells.map(|((cell, place), (set, narrowed))| match (narrowed, place) {
                (false, _) => cell.clone(),
                (true, 'r') => format!("\\raggedleft {}", breakable(cell, *set)),
                (true, _) => format!("\\raggedright {}", breakable(cell, *set)),
            });
            cells.collect::<Vec<_>>().join(" & ") + " " + end + "\n"
        };
        let frame = if self.framed { "\\hline\n" } else { "" };
        let head = line(&self.head);
        let rows: String = self.rows.iter().map(line).collect();
        let lines: f64 = self.rows.iter().map(|row| height(row, &set)).sum();
        let kind = if lines > LINES_OF_A_PAGE { "longtable" } else { "tabular" };
        let table = format!(
            "\\begin{{{kind}}}{{{places}}}\n{frame}{head}\\hline\n{rows}{frame}\\end{{{kind}}}\n\n"
        );
        match fits {
            true => table,
            false => {
                let Small { letters, separation, .. } = size;
                format!(
                    "{{{letters}\\setlength{{\\tabcolsep}}{{{separation}}}\\noindent\n{table}}}\n"
                )
            }
        }
    }

    /// The largest of this measure of the cells of each column.
    fn widths(&self, measure: impl Fn(&str) -> f64) -> Vec<f64> {
        let width = |column: usize| {
            let cells = std::iter::once(&self.head).chain(&self.rows);
            let cells = cells.filter_map(|row| row.get(column));
            cells.map(|cell| measure(cell)).fold(0.0, f64::max)
        };
        (0..self.places.chars().count()).map(width).collect()
    }
}

/// The width of a line of ordinary letters in digits, behind the indentation of a paragraph.
const LINE: f64 = 67.5;

/// The width of the gap between two columns in digits.
const GAP: f64 = 2.4;

/// Small letters.
struct Small {
    /// The command for them.
    letters: &'static str,
    /// Half the gap between two columns.
    separation: &'static str,
    /// The width of a line in digits.
    line: f64,
    /// The width of the gap between two columns in digits.
    gap: f64,
}

/// Small letters, the larger ones first.
const SMALL: [Small; 2] = [
    Small { letters: "\\footnotesize", separation: "3pt", line: 81.0, gap: 1.4 },
    Small { letters: "\\scriptsize", separation: "2pt", line: 86.0, gap: 1.0 },
];

/// The width of a letter of words in digits.
const LETTER: f64 = 0.88;

/// The width of a cell: of its words as they are, of its formulas as they are set.
fn cell_width(cell: &str) -> f64 {
    let pieces = cell.split('$').enumerate();
    let width = |(place, piece): (usize, &str)| match place % 2 {
        0 => words_width(piece),
        _ => width(piece),
    };
    pieces.map(width).sum()
}

/// The width of words in digits.
fn words_width(words: &str) -> f64 {
    let letters = words.chars().filter(|letter| !"\\{}".contains(*letter));
    letters.map(|letter| if letter.is_ascii_digit() { 1.0 } else { LETTER }).sum()
}

/// The width of the longest part of a cell that TeX does not break: a word, or a term of a formula.
fn longest_piece(cell: &str) -> f64 {
    let pieces = cell.split('$').enumerate();
    let width = |(place, piece): (usize, &str)| match place % 2 {
        0 => piece.split([' ', '-']).map(cell_width).fold(0.0, f64::max),
        _ => longest_term(piece),
    };
    pieces.map(width).fold(0.0, f64::max)
}

/// The lines that a row takes in columns of these widths; those of fractions are higher.
fn height(row: &[String], widths: &[f64]) -> f64 {
    const FRACTION: f64 = 1.4;
    let lines = |(cell, set): (&String, &f64)| {
        let lines = (cell_width(cell) / set.max(1.0)).ceil().max(1.0);
        let is_narrowed = cell_width(cell) > *set;
        if is_narrowed && cell.contains("\\frac") { FRACTION * lines } else { lines }
    };
    row.iter().zip(widths).map(lines).fold(1.0, f64::max)
}

/// A cell whose formulas may break in a column of this width: brackets are open, and a fraction that
/// is wider has a solidus.
fn breakable(cell: &str, width: f64) -> String {
    let pieces = cell.split('$').enumerate();
    let pieces = pieces.map(|(place, piece)| match place % 2 {
        1 if longest_term(piece) > width => in_open_brackets(&with_solidus(piece, width)),
        _ => in_open_brackets(piece),
    });
    pieces.collect::<Vec<_>>().join("$")
}

/// The widths of columns that take no more than `room` together: the widest become narrower, down to
/// their longest pieces where these leave room.
fn narrowed(widths: &[f64], pieces: &[f64], room: f64) -> Vec<f64> {
    let largest = cap(pieces, room);
    let least: Vec<f64> = pieces.iter().map(|piece| piece.min(largest)).collect();
    let mut fixed = vec![false; widths.len()];
    loop {
        let free: Vec<f64> = (0..widths.len()).filter(|i| !fixed[*i]).map(|i| widths[i]).collect();
        let taken: f64 = (0..widths.len()).filter(|i| fixed[*i]).map(|i| least[i]).sum();
        let widest = cap(&free, room - taken);
        let below = |i: &usize| !fixed[*i] && least[*i] > widest;
        match (0..widths.len()).find(below) {
            Some(column) => fixed[column] = true,
            None => {
                let set = |i: usize| if fixed[i] { least[i] } else { widths[i].min(widest) };
                return (0..widths.len()).map(set).collect();
            }
        }
    }
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
