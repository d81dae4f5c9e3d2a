//! A table as text: a first column of names on the left, all others flush right, each column as
//! wide as its cells. If that is wider than the page, the widest columns are moved out of the rows
//! and printed below them, each cell with the name of its column.

use super::lines::fitted;
use crate::report::{Heading, are_names};

/// The table in lines of at most `width` characters, if its cells allow it.
pub(super) fn table(head: &[Heading], rows: &[Vec<String>], width: usize) -> String {
    let names = are_names(rows);
    let head: Vec<&str> = head.iter().map(|heading| heading.text).collect();
    let rows: Vec<Vec<&str>> =
        rows.iter().map(|row| row.iter().map(String::as_str).collect()).collect();
    let count = rows.iter().map(Vec::len).chain([head.len()]).max().unwrap_or(0);
    let lines = || std::iter::once(&head).chain(&rows);
    let widest = |column: usize| {
        let cells = lines().filter_map(|line| line.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..count).map(widest).collect();
    let below = columns_below(&widths, width);
    let last = (0..count).rev().find(|column| !below.contains(column));
    let line = |cells: &Vec<&str>| {
        let mut text = String::new();
        for (column, (cell, width)) in cells.iter().zip(&widths).enumerate() {
            match (below.contains(&column), names && (column == 0 || !below.is_empty())) {
                (true, _) => {}
                (false, true) if Some(column) == last => text += &format!("  {cell}"),
                (false, true) => text += &format!("  {cell:<width$}"),
                (false, false) => text += &format!("  {cell:>width$}"),
            }
        }
        text.trim_end().to_owned() + "\n"
    };
    let label = below.iter().filter_map(|column| head.get(*column)).map(|name| name.len()).max();
    let label = label.unwrap_or(0);
    let hanging = |cells: &Vec<&str>| -> String {
        let cells =
            below.iter().filter_map(|column| Some((head.get(*column)?, cells.get(*column)?)));
        let cells = cells.filter(|(_, cell)| !cell.is_empty());
        cells.map(|(name, cell)| fitted(&format!("    {name:<label$}  {cell}\n"), width)).collect()
    };
    let rows: String = rows.iter().map(|row| line(row) + &hanging(row)).collect();
    line(&head) + &rows
}

/// The columns that are moved below the rows so that the others fit: the widest first, never the
/// first.
fn columns_below(widths: &[usize], width: usize) -> Vec<usize> {
    let mut below: Vec<usize> = Vec::new();
    let mut total: usize = widths.iter().map(|width| width + 2).sum();
    while total > width {
        let others = (1..widths.len()).filter(|column| !below.contains(column));
        let Some(widest) = others.max_by_key(|column| widths[*column]) else {
            break;
        };
        total -= widths[widest] + 2;
        below.push(widest);
    }
    below.sort_unstable();
    below
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wide_columns_stand_below_their_rows() {
        let head = ["claim", "printed", "computed"].map(Heading::from);
        let rows = [
            vec!["one".to_owned(), "1 + 2*x + 3*x^2 + 4*x^3".to_owned(), "5".to_owned()],
            vec!["another".to_owned(), "x".to_owned(), "7".to_owned()],
        ];
        let wide = table(&head, &rows, 120);
        assert_eq!(wide.lines().next(), Some("  claim                    printed  computed"));
        assert_eq!(
            table(&head, &rows, 30),
            "  claim    computed\n  one      5\n    printed  1 + 2*x + 3*x^2\n             + 4*x^3\n  another  7\n    printed  x\n"
        );
    }
}
