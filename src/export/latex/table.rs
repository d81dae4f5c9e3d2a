//! A table as LaTeX.

use super::{scientific_text, words};
use crate::report::{Heading, are_names};

pub(super) fn table(head: &[Heading], rows: &[Vec<String>]) -> String {
    let line = |cells: Vec<String>| cells.join(" & ") + " \\\\\n";
    let cell = |cell: &String| match cell.parse::<f64>() {
        Ok(_) => format!("${}$", scientific_text(cell)),
        Err(_) => words(cell),
    };
    let mut places = "r".repeat(head.len());
    if are_names(rows) {
        places.replace_range(..1, "l");
    }
    let names = line(head.iter().map(|heading| heading.latex.to_owned()).collect());
    let rows: String = rows.iter().map(|row| line(row.iter().map(cell).collect())).collect();
    format!("\\begin{{tabular}}{{{places}}}\n{names}\\hline\n{rows}\\end{{tabular}}\n")
}
