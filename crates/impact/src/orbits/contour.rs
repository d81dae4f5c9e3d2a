//! Curves in a plane on which a quantity is zero, from its values on a grid.

use std::collections::BTreeMap;

/// An edge of the grid, by its lower left end and whether it is upright.
type Edge = (usize, usize, bool);

/// The polylines on which the values change their sign. `values[row*columns + column]` may be NaN
/// where the quantity is not defined: no curve passes there. `zero` places the crossing of an edge,
/// given by the column and row of both ends; `None` leaves the edge out.
pub(super) fn zero_curves(
    values: &[f64],
    columns: usize,
    mut zero: impl FnMut([usize; 2], [usize; 2]) -> Option<[f64; 2]>,
) -> Vec<Vec<[f64; 2]>> {
    let rows = values.len() / columns;
    let value = |column: usize, row: usize| values[row * columns + column];
    let mut crossings: BTreeMap<Edge, [f64; 2]> = BTreeMap::new();
    for row in 0..rows {
        for column in 0..columns {
            for (upright, other) in [(false, [column + 1, row]), (true, [column, row + 1])] {
                if other[0] >= columns || other[1] >= rows {
                    continue;
                }
                let (here, there) = (value(column, row), value(other[0], other[1]));
                let changes =
                    here.is_finite() && there.is_finite() && (here > 0.0) != (there > 0.0);
                if changes && let Some(place) = zero([column, row], other) {
                    crossings.insert((column, row, upright), place);
                }
            }
        }
    }
    let mut segments: Vec<[Edge; 2]> = Vec::new();
    for row in 0..rows.saturating_sub(1) {
        for column in 0..columns.saturating_sub(1) {
            // Bottom, right, top, left.
            let sides = [
                (column, row, false),
                (column + 1, row, true),
                (column, row + 1, false),
                (column, row, true),
            ];
            let crossed: Vec<Edge> =
                sides.into_iter().filter(|side| crossings.contains_key(side)).collect();
            match crossed[..] {
                [a, b] => segments.push([a, b]),
                // A saddle: the corner at the lower left is cut off.
                [bottom, right, top, left] => segments.extend([[bottom, left], [right, top]]),
                _ => {}
            }
        }
    }
    joined(&segments)
        .into_iter()
        .map(|line| line.iter().map(|edge| crossings[edge]).collect())
        .collect()
}

/// Segments with common ends as lines.
fn joined(segments: &[[Edge; 2]]) -> Vec<Vec<Edge>> {
    let mut at: BTreeMap<Edge, Vec<usize>> = BTreeMap::new();
    for (index, ends) in segments.iter().enumerate() {
        for end in ends {
            at.entry(*end).or_default().push(index);
        }
    }
    let mut used = vec![false; segments.len()];
    let mut lines = Vec::new();
    // Ends of open lines first, then what is left: closed lines.
    let open = at.iter().filter(|(_, own)| own.len() == 1).map(|(edge, _)| *edge);
    let starts: Vec<Edge> = open.chain(segments.iter().map(|ends| ends[0])).collect();
    for start in starts {
        let mut line = vec![start];
        let mut now = start;
        while let Some(&index) = at[&now].iter().find(|&&index| !used[index]) {
            used[index] = true;
            let [a, b] = segments[index];
            now = if a == now { b } else { a };
            line.push(now);
        }
        if line.len() > 1 {
            lines.push(line);
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_is_one_closed_line_on_the_circle() {
        let size = 41;
        let place = |at: usize| at as f64 / 20.0 - 1.0;
        let inside = |x: f64, y: f64| 0.49 - x * x - y * y;
        let values: Vec<f64> =
            (0..size * size).map(|at| inside(place(at % size), place(at / size))).collect();
        let lines = zero_curves(&values, size, |[a, b], [c, d]| {
            let (first, last) = (inside(place(a), place(b)), inside(place(c), place(d)));
            let part = first / (first - last);
            Some([place(a) + part * (place(c) - place(a)), place(b) + part * (place(d) - place(b))])
        });
        assert_eq!(lines.len(), 1);
        assert_eq!(lines[0].first(), lines[0].last());
        assert!(lines[0].iter().all(|[x, y]| (x.hypot(*y) - 0.7).abs() < 2e-3));
        let length: f64 = lines[0]
            .windows(2)
            .map(|pair| (pair[0][0] - pair[1][0]).hypot(pair[0][1] - pair[1][1]))
            .sum();
        assert!((length - 1.4 * std::f64::consts::PI).abs() < 0.02, "{length}");
    }
}
