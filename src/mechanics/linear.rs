//! Matrices of expressions: elimination with the first pivot that is not zero, which of a positive mass matrix is always the next.

use super::MechanicsError;
use crate::expr::{Expr, ExprError};

/// x of `matrix x = right`, each entry a quotient in which common parts are shared: O(n^3) of them, none written out.
///
/// # Errors
/// A pivot that vanishes: the caller's error.
pub(crate) fn solution(
    matrix: &[Vec<Expr>],
    right: &[Expr],
    singular: impl Fn() -> MechanicsError,
) -> Result<Vec<Expr>, MechanicsError> {
    let size = right.len();
    let mut rows: Vec<Vec<Expr>> = matrix.to_vec();
    let mut right = right.to_vec();
    for pivot in 0..size {
        let is_zero = |entry: &Expr| super::trigonometry::simplified(entry).is_ok_and(|entry| entry.is_zero());
        let Some(first) = (pivot..size).find(|row| !is_zero(&rows[*row][pivot])) else {
            return Err(singular());
        };
        rows.swap(pivot, first);
        right.swap(pivot, first);
        let (above, below) = rows.split_at_mut(pivot + 1);
        let (above_right, below_right) = right.split_at_mut(pivot + 1);
        for (row, value) in below.iter_mut().zip(below_right) {
            if row[pivot].is_zero() {
                continue;
            }
            let factor = Expr::divide(&row[pivot], &above[pivot][pivot])?;
            for (entry, of_pivot) in row.iter_mut().zip(&above[pivot]).skip(pivot) {
                *entry = &*entry - &(&factor * of_pivot);
            }
            *value = &*value - &(&factor * &above_right[pivot]);
        }
    }
    let mut found = vec![Expr::zero(); size];
    for row in (0..size).rev() {
        let known: Expr = (row + 1..size).map(|column| &rows[row][column] * &found[column]).sum();
        found[row] = Expr::divide(&(&right[row] - &known), &rows[row][row]).map_err(|_: ExprError| singular())?;
    }
    Ok(found)
}
