//! A table as text: a first column of names on the left, everything else flush right, each column
//! as wide as it must be.

use crate::report::{Heading, are_names};

pub(super) fn table(head: &[Heading], rows: &[Vec<String>]) -> String {
    let names = are_names(rows);
    let head: Vec<&str> = head.iter().map(|heading| heading.text).collect();
    let rows = rows.iter().map(|row| row.iter().map(String::as_str).collect());
    let lines: Vec<Vec<&str>> = std::iter::once(head).chain(rows).collect();
    let columns = lines.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        let cells = lines.iter().filter_map(|line| line.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let line = |cells: &Vec<&str>| {
        let cells = cells.iter().zip(&widths).enumerate();
        let cells: String = cells
            .map(|(column, (cell, width))| match names && column == 0 {
                true => format!("  {cell:<width$}"),
                false => format!("  {cell:>width$}"),
            })
            .collect();
        cells.trim_end().to_owned() + "\n"
    };
    lines.iter().map(line).collect()
}
