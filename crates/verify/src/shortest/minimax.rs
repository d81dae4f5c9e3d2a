//! The constants of a formula with the smallest largest error.
//!
//! ```text
//! z ~ (sum_i theta_i b_i)/(1 + sum_j theta_j d_j),     e = max |(approximation/z)^n - 1|
//! ```
//!
//! In: the values of z and of the functions at some places. Out: the constants. Each step is a problem
//! of least squares that is linear in the constants, weighted by the last denominator (Sanathanan and
//! Koerner) and by the errors of the steps before (Lawson), whose weights come to those of the largest
//! errors. A step costs a product of the number of places with the square of that of the constants. The
//! normal equations lose half of the digits, and where errors are small a second solution for what is
//! left over brings them back (Bjoerck's corrected seminormal equations).
//!
//! Sources: C. K. Sanathanan, J. Koerner: Transfer function synthesis as a ratio of two complex
//! polynomials, IEEE Transactions on Automatic Control 8 (1963), 56-58. Y. Nakatsukasa, L. N.
//! Trefethen: An algorithm for real and complex rational minimax approximation, SIAM Journal on
//! Scientific Computing 42 (2020), A3157-A3179. A. Bjoerck: Numerical Methods for Least Squares Problems,
//! SIAM 1996, section 6.6.5.

/// The largest number of constants.
pub(super) const MOST_CONSTANTS: usize = 6;

/// A quotient of sums with constants to be found.
pub(super) struct QuotientOfSums<'a> {
    /// The functions of the numerator, at the places.
    pub(super) numerator: Vec<&'a [f64]>,
    /// The functions of the denominator, beside one.
    pub(super) denominator: Vec<&'a [f64]>,
    /// z at the places.
    pub(super) target: &'a [f64],
    /// The power n to which the quotient is taken.
    pub(super) power: f64,
    /// The conditions that the constants fulfil; `None` where each is free.
    pub(super) tie: Option<&'a Tie>,
}

/// Constants of which some follow from the others: all of them are `offset + matrix free`.
pub(super) struct Tie {
    pub(super) offset: Vec<f64>,
    /// Row by row, a row for each constant and a column for each free one.
    pub(super) matrix: Vec<Vec<f64>>,
}

/// Constants, numerator first, and the largest error with them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fit {
    pub(super) constants: [f64; MOST_CONSTANTS],
    pub(super) error: f64,
}

impl QuotientOfSums<'_> {
    /// The number of constants that are free.
    pub(super) fn count(&self) -> usize {
        match self.tie {
            Some(tie) => tie.matrix.first().map_or(0, Vec::len),
            None => self.numerator.len() + self.denominator.len(),
        }
    }

    /// The largest error with these constants; infinite where the denominator changes its sign, or the
    /// quotient is not positive.
    pub(super) fn largest_error(&self, constants: &[f64]) -> f64 {
        let mut largest = 0.0_f64;
        for place in 0..self.target.len() {
            let error = self.error_at(place, constants).abs();
            if !error.is_finite() {
                return f64::INFINITY;
            }
            largest = largest.max(error);
        }
        largest
    }

    fn sums_at(&self, place: usize, constants: &[f64]) -> (f64, f64) {
        let mut all = [0.0; MOST_CONSTANTS];
        let constants = match self.tie {
            None => constants,
            Some(tie) => {
                for (own, (offset, row)) in all.iter_mut().zip(tie.offset.iter().zip(&tie.matrix)) {
                    *own = row.iter().zip(constants).fold(*offset, |sum, (m, c)| sum + m * c);
                }
                &all
            }
        };
        let sum = |functions: &[&[f64]], constants: &[f64]| -> f64 {
            functions.iter().zip(constants).map(|(values, c)| c * values[place]).sum()
        };
        let above = sum(&self.numerator, constants);
        (above, 1.0 + sum(&self.denominator, &constants[self.numerator.len()..]))
    }

    /// `(approximation/z)^n - 1`; NaN where there is none.
    fn error_at(&self, place: usize, constants: &[f64]) -> f64 {
        let (above, below) = self.sums_at(place, constants);
        let ratio = above / (below * self.target[place]);
        match below > 0.0 && ratio > 0.0 {
            true => ratio.powf(self.power) - 1.0,
            false => f64::NAN,
        }
    }

    /// The constants with about the smallest largest error, in so many steps. Those that are fixed keep
    /// their values.
    pub(super) fn minimax(&self, fixed: &[Option<f64>], steps: usize) -> Option<Fit> {
        let places = self.target.len();
        let free: Vec<usize> = (0..self.count()).filter(|&i| fixed[i].is_none()).collect();
        let mut constants = [0.0; MOST_CONSTANTS];
        for (constant, value) in constants.iter_mut().zip(fixed) {
            *constant = value.unwrap_or(0.0);
        }
        if free.is_empty() {
            return Some(Fit { constants, error: self.largest_error(&constants) });
        }
        let numerators = self.numerator.len();
        let own_column = |i: usize, place: usize| match i < numerators {
            true => self.numerator[i][place],
            false => -self.target[place] * self.denominator[i - numerators][place],
        };
        let column = |i: usize, place: usize| match self.tie {
            None => own_column(i, place),
            Some(tie) => {
                let rows = tie.matrix.iter().enumerate();
                rows.map(|(k, row)| row[i] * own_column(k, place)).sum()
            }
        };
        let offset = |place: usize| -> f64 {
            let offsets = self.tie.iter().flat_map(|tie| tie.offset.iter().enumerate());
            offsets.map(|(k, offset)| offset * own_column(k, place)).sum()
        };
        let mut weights = vec![1.0 / places as f64; places];
        let mut below = vec![1.0_f64; places];
        let mut best: Option<Fit> = None;
        for _ in 0..steps {
            let mut matrix = [[0.0; MOST_CONSTANTS + 1]; MOST_CONSTANTS];
            for place in 0..places {
                let scale = 1.0 / (below[place] * self.target[place]);
                let weight = weights[place] * scale * scale;
                let mut right = self.target[place] - offset(place);
                let mut row = [0.0; MOST_CONSTANTS];
                for (i, value) in fixed.iter().enumerate().take(self.count()) {
                    if let Some(value) = value {
                        right -= value * column(i, place);
                    }
                }
                for (entry, &i) in row.iter_mut().zip(&free) {
                    *entry = column(i, place);
                }
                for i in 0..free.len() {
                    for j in 0..=i {
                        matrix[i][j] += weight * row[i] * row[j];
                    }
                    matrix[i][MOST_CONSTANTS] += weight * row[i] * right;
                }
            }
            if !factor(&mut matrix, free.len()) {
                break;
            }
            let right: [f64; MOST_CONSTANTS] = std::array::from_fn(|i| matrix[i][MOST_CONSTANTS]);
            for (&i, value) in free.iter().zip(substituted(&matrix, free.len(), right)) {
                constants[i] = value;
            }
            if best.is_some_and(|best| best.error < SMALL) {
                let mut right = [0.0; MOST_CONSTANTS];
                for place in 0..places {
                    let scale = 1.0 / (below[place] * self.target[place]);
                    let weight = weights[place] * scale * scale;
                    let own = (0..self.count()).map(|i| constants[i] * column(i, place));
                    let left = self.target[place] - offset(place) - own.sum::<f64>();
                    for (sum, &i) in right.iter_mut().zip(&free) {
                        *sum += weight * column(i, place) * left;
                    }
                }
                for (&i, value) in free.iter().zip(substituted(&matrix, free.len(), right)) {
                    constants[i] += value;
                }
            }
            let (mut largest, mut total) = (0.0_f64, 0.0);
            let mut is_defined = true;
            for place in 0..places {
                below[place] = self.sums_at(place, &constants).1;
                let error = self.error_at(place, &constants).abs();
                is_defined &= error <= f64::MAX;
                let size = if error <= f64::MAX { error } else { 1.0 };
                largest = largest.max(size);
                weights[place] *= size;
                total += weights[place];
            }
            if is_defined && best.is_none_or(|best| largest < best.error) {
                best = Some(Fit { constants, error: largest });
            }
            if total.is_nan()
                || total <= 0.0
                || below.iter().any(|value| *value == 0.0 || !value.is_finite())
            {
                break;
            }
            let least = 1e-9 / places as f64;
            weights.iter_mut().for_each(|weight| *weight = (*weight / total).max(least));
        }
        best
    }
}

/// The error from which on the constants are found to more digits than the normal equations have.
const SMALL: f64 = 1e-4;

/// Replaces the lower half of a symmetric matrix by Cholesky's factor; false if it is not positive.
fn factor(matrix: &mut [[f64; MOST_CONSTANTS + 1]; MOST_CONSTANTS], size: usize) -> bool {
    /// A pivot that has lost more digits than this is none.
    const LOST: f64 = 1e-15;
    for i in 0..size {
        let diagonal = matrix[i][i];
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| matrix[i][k] * matrix[j][k]).sum();
            let rest = matrix[i][j] - sum;
            matrix[i][j] = match i == j {
                true if rest > LOST * diagonal => rest.sqrt(),
                true => return false,
                false => rest / matrix[j][j],
            };
        }
    }
    true
}

/// The solution of a system with this factor in the lower half.
fn substituted(
    matrix: &[[f64; MOST_CONSTANTS + 1]; MOST_CONSTANTS],
    size: usize,
    right: [f64; MOST_CONSTANTS],
) -> [f64; MOST_CONSTANTS] {
    let mut solution = [0.0; MOST_CONSTANTS];
    for i in 0..size {
        let sum: f64 = (0..i).map(|k| matrix[i][k] * solution[k]).sum();
        solution[i] = (right[i] - sum) / matrix[i][i];
    }
    for i in (0..size).rev() {
        let sum: f64 = (i + 1..size).map(|k| matrix[k][i] * solution[k]).sum();
        solution[i] = (solution[i] - sum) / matrix[i][i];
    }
    solution
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest errors of best approximations on these places were computed by Remez' exchange with 50
    /// digits.
    #[test]
    fn constants_reach_the_least_largest_error() {
        let places: Vec<f64> = (0..49)
            .map(|i| (1.0 - (std::f64::consts::PI * f64::from(i) / 48.0).cos()) / 2.0)
            .collect();
        let power = |n: i32| -> Vec<f64> { places.iter().map(|t| t.powi(n)).collect() };
        let powers: Vec<Vec<f64>> = (0..4).map(power).collect();
        let exponential: Vec<f64> = places.iter().map(|t| t.exp()).collect();
        let root: Vec<f64> = places.iter().map(|t| (1.0 + t).sqrt()).collect();
        for (above, below, target, least) in [
            (2, 1, &exponential, 2.603_778_479_076_246_4e-3),
            (3, 2, &exponential, 2.700_222_439_003_551e-6),
            (3, 3, &exponential, 6.767_168_345_400_847e-8),
            (4, 2, &root, 2.588_367_842_664_019e-8),
        ] {
            let sums = QuotientOfSums {
                numerator: powers[..above].iter().map(Vec::as_slice).collect(),
                denominator: powers[1..=below].iter().map(Vec::as_slice).collect(),
                target,
                power: 1.0,
                tie: None,
            };
            let fit = sums.minimax(&[None; MOST_CONSTANTS], 40).unwrap();
            assert!(fit.error >= least * (1.0 - 1e-6), "{} {least}", fit.error);
            assert!(fit.error <= least * 1.02, "{} {least}", fit.error / least - 1.0);
        }
    }
}
