//! Linear equations with expressions as coefficients: Gaussian elimination with the first pivot
//! that does not vanish at rest, or that is not zero at all. For a positive definite mass matrix it is
//! always the next one.

use super::MechanicsError;
use crate::expr::{Expr, ExprError};
use crate::symbol::Symbol;

/// Solves `matrix x = right`. The entries of x are quotients with O(n^3) shared parts, which are
/// not expanded. A pivot is chosen that does not vanish where the names `moving` are zero, as
/// coordinates and velocities are at rest, if there is one: the quotients by it have values there.
///
/// # Errors
/// The error of `singular` if a pivot vanishes.
pub fn solution(
    matrix: &[Vec<Expr>],
    right: &[Expr],
    moving: &[Symbol],
    singular: impl Fn() -> MechanicsError,
) -> Result<Vec<Expr>, MechanicsError> {
    let size = right.len();
    let mut rows: Vec<Vec<Expr>> = matrix.to_vec();
    let mut right = right.to_vec();
    for pivot in 0..size {
        let is_zero = |entry: &Expr| {
            !is_surely_not_zero(entry, &[])
                && super::trigonometry::simplified(entry).is_ok_and(|entry| entry.is_zero())
        };
        let stays = |row: &usize| is_surely_not_zero(&rows[*row][pivot], moving);
        let any = || (pivot..size).find(|row| !is_zero(&rows[*row][pivot]));
        let Some(first) = (pivot..size).find(stays).or_else(any) else {
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
        found[row] = Expr::divide(&(&right[row] - &known), &rows[row][row])
            .map_err(|_: ExprError| singular())?;
    }
    Ok(found)
}

/// Whether the expression is not zero at a test point at which the names `moving` are zero, with
/// rounding accounted for. It costs one evaluation; to expand the quotients of an elimination would
/// take far longer.
fn is_surely_not_zero(expression: &Expr, moving: &[Symbol]) -> bool {
    let value = at_test_point(expression, moving);
    value.is_some_and(|(value, error)| value.is_finite() && value.abs() > 16.0 * error)
}

/// Returns the absolute value of an expression at a test point at which the names `moving` are zero;
/// zero where it has none.
pub fn size_at_rest(expression: &Expr, moving: &[Symbol]) -> f64 {
    let value = at_test_point(expression, moving).map(|(value, _)| value.abs());
    value.filter(|value| value.is_finite()).unwrap_or(0.0)
}

/// Returns the value at a test point, and its rounding error. The point is the same on every run: a
/// name is the fractional part of a multiple of the golden section that depends on its letters, or zero
/// if it is one of those that move.
fn at_test_point(expression: &Expr, moving: &[Symbol]) -> Option<(f64, f64)> {
    let place = |name: Symbol| {
        let number =
            name.name().bytes().fold(7_u32, |sum, byte| (31 * sum + u32::from(byte)) % 10_007);
        let place = 0.3 + (0.618_033_988_75 * f64::from(number)).fract();
        Some((if moving.contains(&name) { 0.0 } else { place }, 0.0))
    };
    expression.evaluate_rounded(&place)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_zero_is_told_from_what_is() {
        for (text, expected) in [
            ("m*L^2 - (m*L*cos(x))^2/(M + m)", true),
            ("sin(x)^2 + cos(x)^2 - 1", false),
            ("(a + b)^2 - a^2 - 2*a*b - b^2", false),
            ("1e-9*(a - b)", true),
            ("a/b - a/b*cos(0*x)", false),
        ] {
            let expression: Expr = text.parse().expect(text);
            assert_eq!(is_surely_not_zero(&expression, &[]), expected, "{text}");
        }
    }
    #[test]
    fn a_pivot_does_not_vanish_at_rest_where_another_row_has_one_that_does_not() {
        let row = |texts: [&str; 2]| texts.map(|text| text.parse::<Expr>().expect(text)).to_vec();
        let matrix = [row(["b", "1"]), row(["1", "b"])];
        let right = row(["-20*y", "-9*b"]);
        let singular = || MechanicsError::Singular(Expr::zero());
        let found =
            solution(&matrix, &right, &["b".into(), "y".into()], singular).expect("a solution");
        let at_rest = [("b".into(), 0.0), ("y".into(), 0.2)].into();
        let values: Vec<_> = found.iter().map(|entry| entry.evaluate(&at_rest)).collect();
        assert_eq!(values, [Ok(0.0), Ok(-4.0)]);
    }
}
