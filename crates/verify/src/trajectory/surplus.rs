//! More frictions at rest than independent velocities: a body that sticks to the floor and to
//! another that sticks to the floor too.
//!
//! ```text
//! A s = r,  |s_i| <= 1                 du_i/dt = 0 on every surface: the shares s are not determined where A is singular, s = s0 + N z
//! min over z of max |s_i|  =  max over w of |w^T s0| / sum |w_i|,    w^T N = 0,  w with as few entries as possible
//! ```
//!
//! All surfaces stick as long as there are shares within the bounds (J. J. Moreau, *Unilateral
//! contact and dry friction in finite freedom dynamics*, CISM 302, Springer 1988), so the shares
//! with the smallest maximum are taken. By the duality of linear programming (A. Schrijver, *Theory
//! of Linear and Integer Programming*, Wiley 1986, chapters 7 and 8) the maximum is attained for a
//! `w`, the slip that is nearest. All of its surfaces have shares of equal size, with the sign of
//! `w_i`, and reach their bounds together. Shares that are still undetermined are found in the same
//! way.

/// Largest entry, relative to the largest of all, that counts as zero.
const NOTHING: f64 = 1e-9;

/// Largest number of combinations of slips that are tried.
const MOST_SLIPS: usize = 20_000;

/// The groups of shares of equal size, each share by its number with a sign, until no share is
/// undetermined; `None` if the equations contradict each other, or there are too many.
pub(crate) fn of_one_size(matrix: &[Vec<f64>], right: &[f64]) -> Option<Vec<Vec<(usize, i64)>>> {
    let (mut shares, mut open) = solutions(matrix, right)?;
    let mut groups = Vec::new();
    while !open.is_empty() {
        let (size, slip) = nearest_slip(&shares, &open)?;
        // The shares of the slip are fixed at that size; the remaining directions stay open.
        let rows: Vec<Vec<f64>> = slip.iter().map(|(index, _)| row(&open, *index)).collect();
        let wanted: Vec<f64> =
            slip.iter().map(|(index, sign)| *sign as f64 * size - shares[*index]).collect();
        let (along, rest) = solutions(&rows, &wanted)?;
        let moved = |along: &[f64]| -> Vec<f64> {
            let part =
                |index: usize| along.iter().zip(&open).map(|(z, column)| z * column[index]).sum();
            (0..shares.len()).map(part).collect()
        };
        let next: Vec<f64> =
            shares.iter().zip(moved(&along)).map(|(share, more)| share + more).collect();
        let left: Vec<Vec<f64>> = rest.iter().map(|direction| moved(direction)).collect();
        if left.len() >= open.len() {
            return None;
        }
        (shares, open) = (next, left);
        groups.push(slip);
    }
    Some(groups)
}

/// The entries of one share in the directions that are open.
fn row(open: &[Vec<f64>], index: usize) -> Vec<f64> {
    open.iter().map(|column| column[index]).collect()
}

/// The size that the largest share has at least, and the shares that have it, with their signs.
fn nearest_slip(shares: &[f64], open: &[Vec<f64>]) -> Option<(f64, Vec<(usize, i64)>)> {
    let largest = open.iter().flatten().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
    let free: Vec<usize> = (0..shares.len())
        .filter(|index| row(open, *index).iter().any(|entry| entry.abs() > NOTHING * largest))
        .collect();
    let mut nearest: Option<(f64, Vec<(usize, i64)>)> = None;
    let mut chosen: Vec<usize> = (0..=open.len()).collect();
    if free.len() < chosen.len() {
        return None;
    }
    for _ in 0..MOST_SLIPS {
        let rows: Vec<Vec<f64>> = open
            .iter()
            .map(|column| chosen.iter().map(|place| column[free[*place]]).collect())
            .collect();
        if let Some((_, slips)) = solutions(&rows, &vec![0.0; rows.len()])
            && let [slip] = slips.as_slice()
        {
            let whole: f64 = slip.iter().map(|entry| entry.abs()).sum();
            let power: f64 =
                slip.iter().zip(&chosen).map(|(w, place)| w * shares[free[*place]]).sum();
            let size = power.abs() / whole;
            if nearest.as_ref().is_none_or(|(known, _)| size > *known) {
                let sign = |w: f64| if (w > 0.0) == (power >= 0.0) { 1 } else { -1 };
                let of_slip = slip.iter().zip(&chosen).filter(|(w, _)| w.abs() > NOTHING * whole);
                nearest =
                    Some((size, of_slip.map(|(w, place)| (free[*place], sign(*w))).collect()));
            }
        }
        if !next_choice(&mut chosen, free.len()) {
            return nearest;
        }
    }
    None
}

/// The next choice of as many of `count`, in order; `false` after the last one.
fn next_choice(chosen: &mut [usize], count: usize) -> bool {
    let size = chosen.len();
    let Some(place) = (0..size).rev().find(|place| chosen[*place] < count - size + place) else {
        return false;
    };
    let first = chosen[place] + 1;
    for (entry, value) in chosen[place..].iter_mut().zip(first..) {
        *entry = value;
    }
    true
}

/// One solution of linear equations and the directions in which there are more; `None` if they
/// contradict each other.
fn solutions(matrix: &[Vec<f64>], right: &[f64]) -> Option<(Vec<f64>, Vec<Vec<f64>>)> {
    /// Relative size below which an entry is zero: rounding, and the error of the positions on
    /// their surfaces.
    const APART: f64 = 1e-6;
    let count = matrix.first().map_or(0, Vec::len);
    let mut rows: Vec<Vec<f64>> = matrix
        .iter()
        .zip(right)
        .map(|(row, right)| row.iter().copied().chain([*right]).collect())
        .collect();
    if rows.iter().flatten().any(|entry| !entry.is_finite()) {
        return None;
    }
    let size_of =
        |entries: &[f64]| entries.iter().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
    let matrix_size = rows.iter().map(|row| size_of(&row[..count])).fold(0.0, f64::max);
    let right_size = size_of(right).max(matrix_size);
    let mut pivots: Vec<usize> = Vec::new();
    while pivots.len() < rows.len() {
        let done = pivots.len();
        let places = (done..rows.len()).flat_map(|row| (0..count).map(move |column| (row, column)));
        let pivot = places
            .max_by(|one, other| rows[one.0][one.1].abs().total_cmp(&rows[other.0][other.1].abs()));
        let Some((row, column)) =
            pivot.filter(|(row, column)| rows[*row][*column].abs() > NOTHING * matrix_size)
        else {
            break;
        };
        rows.swap(done, row);
        let leading: Vec<f64> = rows[done].iter().map(|entry| entry / rows[done][column]).collect();
        for (_, row) in rows.iter_mut().enumerate().filter(|(index, _)| *index != done) {
            let factor = row[column];
            for (entry, of_pivot) in row.iter_mut().zip(&leading) {
                *entry -= factor * of_pivot;
            }
            // The entry is zero by construction, and must not become a pivot by rounding.
            row[column] = 0.0;
        }
        rows[done] = leading;
        pivots.push(column);
    }
    if rows[pivots.len()..].iter().any(|row| row[count].abs() > APART * right_size) {
        return None;
    }
    let mut one = vec![0.0; count];
    for (row, column) in rows.iter().zip(&pivots) {
        one[*column] = row[count];
    }
    let open = (0..count).filter(|column| !pivots.contains(column));
    let directions = open.map(|free| {
        let mut direction = vec![0.0; count];
        direction[free] = 1.0;
        for (row, column) in rows.iter().zip(&pivots) {
            direction[*column] = -row[free];
        }
        direction
    });
    Some((one, directions.collect()))
}

#[cfg(test)]
mod tests {
    use super::of_one_size;

    /// Two bodies on the floor and on each other: the one that is pushed slips on both, the pair
    /// together, or each on its own.
    #[test]
    fn the_nearest_slip_is_that_of_statics() {
        // du/dt of x', y' and x' - y' for masses of one and the bounds 1, b, c: x'' = f - s1 - c
        // s3, y'' = g - b s2 + c s3.
        let groups = |[b, c]: [f64; 2], [f, g]: [f64; 2]| {
            let matrix = [vec![1.0, 0.0, c], vec![0.0, b, -c], vec![1.0, -b, 2.0 * c]];
            of_one_size(&matrix, &[f, g, f - g])
        };
        // f over 1 + c where x moves alone, (f + g)/(1 + b) where both do, g over b + c where y
        // does.
        assert_eq!(groups([1.0, 0.5], [1.2, 0.0]), Some(vec![vec![(0, 1), (2, 1)]]));
        assert_eq!(groups([0.1, 0.5], [1.0, 0.0]), Some(vec![vec![(0, 1), (1, 1)]]));
        assert_eq!(groups([1.0, 0.5], [0.0, -1.0]), Some(vec![vec![(1, -1), (2, 1)]]));
        // Contradicting equations have no solution.
        assert_eq!(of_one_size(&[vec![1.0, 1.0], vec![1.0, 1.0]], &[1.0, 2.0]), None);
        assert_eq!(of_one_size(&[vec![f64::NAN, 1.0], vec![1.0, 1.0]], &[1.0, 2.0]), None);
        // Nothing is open.
        assert_eq!(of_one_size(&[vec![2.0, 0.0], vec![0.0, 1.0]], &[1.0, 2.0]), Some(vec![]));
        assert_eq!(of_one_size(&[], &[]), Some(vec![]));
    }
}
