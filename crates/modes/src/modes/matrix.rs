//! Fractions in rows: determinants, inverses and null vectors by Gaussian elimination.
//!
//! A pivot is the largest entry that is left, so that fractions which stand for rounded numbers of
//! many digits are treated as well as exact ones; an entry of a null vector below [`NEGLIGIBLE`] is zero. Such fractions
//! would grow by as many digits with each step: they are tidied, rounded again, and exact ones are not.
//! The work is n^3 products.

use num_traits::{One, Signed, Zero};

use crate::exact::Rational;
use crate::exact::rational::to_f64;

/// A matrix in rows.
pub(crate) type Matrix = Vec<Vec<Rational>>;

/// The change of each new entry: none, or rounding.
pub(crate) type Tidy<'a> = &'a dyn Fn(&Rational) -> Rational;

/// Size below which an entry of a null vector is that of rounding: roots are refined to [`super::linear::DIGITS`]
/// digits, and entries are of the order of one or exact.
const NEGLIGIBLE: f64 = 1e-45;

fn size(entry: &Rational) -> f64 {
    if entry.is_zero() { 0.0 } else { to_f64(&entry.abs()) }
}

/// `matrix - factor * other`.
pub(crate) fn less(matrix: &Matrix, factor: &Rational, other: &Matrix) -> Matrix {
    let row = |(row, others): (&Vec<Rational>, &Vec<Rational>)| {
        row.iter().zip(others).map(|(entry, other)| entry - factor * other).collect()
    };
    matrix.iter().zip(other).map(row).collect()
}

/// The transposed matrix.
pub(crate) fn transposed(matrix: &Matrix) -> Matrix {
    (0..matrix.len()).map(|j| matrix.iter().map(|row| row[j].clone()).collect()).collect()
}

/// `matrix * vector`.
pub(crate) fn applied(matrix: &Matrix, vector: &[Rational]) -> Vec<Rational> {
    matrix.iter().map(|row| dot(row, vector)).collect()
}

/// The sum of products.
pub(crate) fn dot(left: &[Rational], right: &[Rational]) -> Rational {
    left.iter().zip(right).fold(Rational::zero(), |sum, (a, b)| sum + a * b)
}

/// The determinant.
pub(crate) fn determinant(matrix: &Matrix) -> Rational {
    let mut rows = matrix.clone();
    let mut product = Rational::one();
    for pivot in 0..rows.len() {
        let Some(first) = (pivot..rows.len()).find(|row| !rows[*row][pivot].is_zero()) else {
            return Rational::zero();
        };
        if first != pivot {
            rows.swap(pivot, first);
            product = -product;
        }
        product *= rows[pivot][pivot].clone();
        eliminate_below(&mut rows, pivot, &Rational::clone);
    }
    product
}

fn eliminate_below(rows: &mut Matrix, pivot: usize, tidy: Tidy) {
    let (above, below) = rows.split_at_mut(pivot + 1);
    let of_pivot = &above[pivot];
    for row in below.iter_mut().filter(|row| !row[pivot].is_zero()) {
        let factor = &row[pivot] / &of_pivot[pivot];
        for (entry, of_pivot) in row.iter_mut().zip(of_pivot).skip(pivot) {
            *entry = tidy(&(&*entry - &factor * of_pivot));
        }
    }
}

/// The inverse; `None` if a pivot vanishes.
pub(crate) fn inverse(matrix: &Matrix, tidy: Tidy) -> Option<Matrix> {
    let count = matrix.len();
    let unit = |i: usize, j: usize| if i == j { Rational::one() } else { Rational::zero() };
    let mut rows: Matrix = matrix
        .iter()
        .enumerate()
        .map(|(i, row)| row.iter().cloned().chain((0..count).map(|j| unit(i, j))).collect())
        .collect();
    for pivot in 0..count {
        let largest = (pivot..count)
            .max_by(|one, other| size(&rows[*one][pivot]).total_cmp(&size(&rows[*other][pivot])))?;
        if rows[largest][pivot].is_zero() {
            return None;
        }
        rows.swap(pivot, largest);
        let scale = rows[pivot][pivot].clone();
        rows[pivot].iter_mut().for_each(|entry| *entry = tidy(&(&*entry / &scale)));
        let of_pivot = rows[pivot].clone();
        for (index, row) in rows.iter_mut().enumerate() {
            if index == pivot || row[pivot].is_zero() {
                continue;
            }
            let factor = row[pivot].clone();
            for (entry, of_pivot) in row.iter_mut().zip(&of_pivot) {
                if !of_pivot.is_zero() {
                    *entry = tidy(&(&*entry - &factor * of_pivot));
                }
            }
        }
    }
    Some(rows.into_iter().map(|row| row[count..].to_vec()).collect())
}

/// The vector that a matrix of rank n - 1 makes zero; its first entry that is not zero is one.
pub(crate) fn null_vector(matrix: &Matrix, tidy: Tidy) -> Vec<Rational> {
    null_vectors(matrix, 1, tidy).swap_remove(0)
}

/// As many independent vectors as a matrix of rank `n - number` makes zero; the first entry of each
/// that is not zero is one. A matrix of higher rank has no such vectors: what they leave is for the
/// caller to look at.
pub(crate) fn null_vectors(matrix: &Matrix, number: usize, tidy: Tidy) -> Vec<Vec<Rational>> {
    let count = matrix.len();
    let rank = count.saturating_sub(number);
    let mut rows = matrix.clone();
    let mut columns: Vec<usize> = (0..count).collect();
    // Full pivoting leaves the zeros in the last places.
    for pivot in 0..rank {
        let places = (pivot..count).flat_map(|row| (pivot..count).map(move |column| (row, column)));
        let largest = places.max_by(|one, other| {
            size(&rows[one.0][one.1]).total_cmp(&size(&rows[other.0][other.1]))
        });
        let Some((row, column)) = largest else { break };
        if rows[row][column].is_zero() {
            break;
        }
        rows.swap(pivot, row);
        rows.iter_mut().for_each(|row| row.swap(pivot, column));
        columns.swap(pivot, column);
        eliminate_below(&mut rows, pivot, tidy);
    }
    let vector = |free: usize| {
        let mut found = vec![Rational::zero(); count];
        found[free] = Rational::one();
        for row in (0..rank).rev() {
            let known = dot(&rows[row][row + 1..], &found[row + 1..]);
            if !rows[row][row].is_zero() {
                found[row] = tidy(&(-known / &rows[row][row]));
            }
        }
        let mut vector = vec![Rational::zero(); count];
        for (place, entry) in columns.iter().zip(found) {
            vector[*place] = if size(&entry) < NEGLIGIBLE { Rational::zero() } else { entry };
        }
        first_is_one(&vector, tidy)
    };
    (rank..count).map(vector).collect()
}

/// A vector over its first entry that is not zero.
pub(crate) fn first_is_one(vector: &[Rational], tidy: Tidy) -> Vec<Rational> {
    match vector.iter().find(|entry| !entry.is_zero()) {
        Some(first) => vector.iter().map(|entry| tidy(&(entry / first))).collect(),
        None => vector.to_vec(),
    }
}

/// Whether a matrix makes a vector zero, but for what rounding leaves.
pub(crate) fn vanishes(matrix: &Matrix, vector: &[Rational]) -> bool {
    applied(matrix, vector).iter().all(|entry| size(entry) < NEGLIGIBLE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::rational::ratio;

    #[test]
    fn an_inverse_undoes_and_a_null_vector_vanishes() {
        let matrix: Matrix = [[2, -1, 0], [-1, 2, -1], [0, -1, 2]]
            .map(|row| row.map(|entry| ratio(entry, 1)).to_vec())
            .to_vec();
        assert_eq!(determinant(&matrix), ratio(4, 1));
        let vector = [ratio(1, 3), ratio(-2, 1), ratio(5, 7)];
        let inverse = inverse(&matrix, &Rational::clone).expect("a regular matrix");
        assert_eq!(applied(&inverse, &applied(&matrix, &vector)), vector);
        let unit: Matrix =
            (0..3).map(|i| (0..3).map(|j| ratio((i == j).into(), 1)).collect()).collect();
        let singular = less(&matrix, &ratio(2, 1), &unit);
        assert_eq!(
            null_vector(&singular, &Rational::clone),
            [ratio(1, 1), ratio(0, 1), ratio(-1, 1)]
        );
    }

    /// Units do not matter: a matrix of small numbers is as regular as its multiple.
    #[test]
    fn a_matrix_of_small_numbers_has_an_inverse() {
        let small = ratio(1, 10_i64.pow(15));
        let small = &small * &small * &small * small.clone();
        let matrix: Matrix = [[2, -1], [-1, 2]]
            .map(|row| row.map(|entry| ratio(entry, 1) * &small).to_vec())
            .to_vec();
        let inverse = inverse(&matrix, &Rational::clone).expect("a regular matrix");
        let vector = [ratio(1, 3), ratio(-2, 1)];
        assert_eq!(applied(&inverse, &applied(&matrix, &vector)), vector);
    }
}
