//! A table as LaTeX.

use super::{scientific_text, words};
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

    /// As it stands in an article.
    pub(in crate::export) fn written(&self) -> String {
        let line = |cells: &Vec<String>| cells.join(" & ") + " \\\\\n";
        let frame = if self.framed { "\\hline\n" } else { "" };
        let (places, head) = (&self.places, line(&self.head));
        let rows: String = self.rows.iter().map(line).collect();
        format!(
            "\\begin{{tabular}}{{{places}}}\n{frame}{head}\\hline\n{rows}{frame}\\end{{tabular}}\n"
        )
    }
}

/// The head of a table, a name each.
pub(super) fn head(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

/// A table of numbers and words.
pub(super) fn table(head: &[Heading], rows: &[Vec<String>]) -> LatexTable {
    let cell = |cell: &String| match cell.parse::<f64>() {
        Ok(_) => format!("${}$", scientific_text(cell)),
        Err(_) => words(cell),
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
