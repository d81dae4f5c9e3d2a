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

use pulp::{Arch, Simd, WithSimd};

use crate::exact::Rational;
use crate::exact::rational::to_f64;

/// The largest number of constants.
pub(super) const MOST_CONSTANTS: usize = 6;

/// A quotient of sums with constants to be found.
pub(super) struct QuotientOfSums<'a> {
    /// The functions of the numerator over z, at the places.
    pub(super) numerator: Vec<&'a [f64]>,
    /// The functions of the denominator, beside one.
    pub(super) denominator: Vec<&'a [f64]>,
    /// The power n to which the quotient is taken.
    pub(super) power: PowerOfQuotient,
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

/// The extent of a search for constants.
#[derive(Clone, Copy)]
pub(super) struct FitSteps {
    /// The number of steps.
    pub(super) count: usize,
    /// The error beyond which the search is given up after the second step.
    pub(super) given_up: f64,
}

impl FitSteps {
    /// So many steps.
    pub(super) const fn all(count: usize) -> Self {
        Self { count, given_up: f64::INFINITY }
    }
}

/// A power of positive numbers, many at a time.
#[derive(Clone, Copy, Debug)]
pub(super) struct PowerOfQuotient {
    exponent: f64,
    /// Square roots and then products, where that is the power.
    roots_and_products: Option<(u32, u32)>,
}

impl PowerOfQuotient {
    pub(super) fn new(exponent: &Rational) -> Self {
        let exponent = to_f64(exponent);
        let whole = |roots: &u32| {
            let times = exponent.abs() * f64::from(1_u32 << roots);
            (times.fract() == 0.0 && times <= 4.0).then_some((*roots, times as u32))
        };
        Self { exponent, roots_and_products: (0..=3).find_map(|roots| whole(&roots)) }
    }

    /// n.
    pub(super) const fn exponent(self) -> f64 {
        self.exponent
    }

    /// Replaces numbers by their powers.
    #[inline(always)]
    fn replace(self, values: &mut [f64]) {
        let Some((roots, times)) = self.roots_and_products else {
            return values.iter_mut().for_each(|value| *value = value.powf(self.exponent));
        };
        for _ in 0..roots {
            values.iter_mut().for_each(|value| *value = value.sqrt());
        }
        match times {
            2 => values.iter_mut().for_each(|value| *value *= *value),
            3 => values.iter_mut().for_each(|value| *value = *value * *value * *value),
            4 => values.iter_mut().for_each(|value| {
                *value *= *value;
                *value *= *value;
            }),
            _ => {}
        }
        if self.exponent < 0.0 {
            values.iter_mut().for_each(|value| *value = 1.0 / *value);
        }
    }
}

impl QuotientOfSums<'_> {
    /// The number of constants that are free.
    pub(super) fn count(&self) -> usize {
        match self.tie {
            Some(tie) => tie.matrix.first().map_or(0, Vec::len),
            None => self.numerator.len() + self.denominator.len(),
        }
    }

    /// The number of places.
    pub(super) fn places(&self) -> usize {
        self.numerator.first().or(self.denominator.first()).map_or(0, |values| values.len())
    }

    /// The largest error with these constants; infinite where the denominator changes its sign, or the
    /// quotient is not positive.
    pub(super) fn largest_error(&self, constants: &[f64]) -> f64 {
        let mut free = [0.0; MOST_CONSTANTS];
        free[..constants.len()].copy_from_slice(constants);
        let mut errors = vec![0.0; 2 * self.places()];
        let (below, errors) = errors.split_at_mut(self.places());
        self.errors(&free, below, errors);
        match errors.iter().all(|error| error.is_finite()) {
            true => errors.iter().fold(0.0, |largest, error| error.abs().max(largest)),
            false => f64::INFINITY,
        }
    }

    /// All constants, those that are tied to the free ones as well.
    #[inline(always)]
    fn all_constants(&self, free: &[f64; MOST_CONSTANTS]) -> [f64; MOST_CONSTANTS] {
        let Some(tie) = self.tie else { return *free };
        let mut all = [0.0; MOST_CONSTANTS];
        for (own, (offset, row)) in all.iter_mut().zip(tie.offset.iter().zip(&tie.matrix)) {
            *own = row.iter().zip(free).fold(*offset, |sum, (m, c)| sum + m * c);
        }
        all
    }

    /// The denominators, and `(approximation/z)^n - 1`; NaN where that is none.
    #[inline(always)]
    fn errors(&self, free: &[f64; MOST_CONSTANTS], below: &mut [f64], errors: &mut [f64]) {
        let constants = self.all_constants(free);
        let (above, divisor) = constants.split_at(self.numerator.len());
        let add = |sums: &mut [f64], functions: &[&[f64]], constants: &[f64]| {
            for (values, constant) in functions.iter().zip(constants) {
                sums.iter_mut().zip(*values).for_each(|(sum, value)| *sum += constant * value);
            }
        };
        errors.fill(0.0);
        add(errors, &self.numerator, above);
        below.fill(1.0);
        add(below, &self.denominator, divisor);
        for (error, below) in errors.iter_mut().zip(&*below) {
            let ratio = *error / below;
            *error = if *below > 0.0 && ratio > 0.0 { ratio } else { f64::NAN };
        }
        self.power.replace(errors);
        errors.iter_mut().for_each(|error| *error -= 1.0);
    }

    /// The constants with about the smallest largest error. Those that are fixed keep their values.
    pub(super) fn minimax(&self, fixed: &[Option<f64>], steps: FitSteps) -> Option<Fit> {
        Arch::new().dispatch(Minimax { sums: self, fixed, steps })
    }
}

/// A search of constants, compiled for every set of vector instructions.
struct Minimax<'a> {
    sums: &'a QuotientOfSums<'a>,
    fixed: &'a [Option<f64>],
    steps: FitSteps,
}

impl WithSimd for Minimax<'_> {
    type Output = Option<Fit>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Option<Fit> {
        let Self { sums, fixed, steps } = self;
        let (count, places) = (sums.count(), sums.places());
        let free: Vec<usize> = (0..count).filter(|&i| fixed[i].is_none()).collect();
        let mut constants = [0.0; MOST_CONSTANTS];
        for (constant, value) in constants.iter_mut().zip(fixed) {
            *constant = value.unwrap_or(0.0);
        }
        if free.is_empty() {
            return Some(Fit { constants, error: sums.largest_error(&constants[..count]) });
        }
        if places == 0 {
            return None;
        }
        // The columns of the problem, those that are fixed and the tied part brought to the right side.
        let mut numbers = vec![0.0; (count + 5) * places];
        let (columns, rest) = numbers.split_at_mut(count * places);
        sums.fill_columns(columns);
        let columns: Vec<&[f64]> = columns.chunks_exact(places).collect();
        let (right, rest) = rest.split_at_mut(places);
        let (below, rest) = rest.split_at_mut(places);
        let (weights, rest) = rest.split_at_mut(places);
        let (scaled, errors) = rest.split_at_mut(places);
        sums.fill_right(right);
        for (i, column) in columns.iter().enumerate().filter(|(i, _)| fixed[*i].is_some()) {
            subtract(right, constants[i], column);
        }
        weights.fill(1.0 / places as f64);
        below.fill(1.0);
        let mut best: Option<Fit> = None;
        for step in 0..steps.count {
            // The weights of the squares.
            for (scaled, (weight, below)) in errors.iter_mut().zip(weights.iter().zip(&*below)) {
                *scaled = weight / (below * below);
            }
            let mut matrix = [[0.0; MOST_CONSTANTS + 1]; MOST_CONSTANTS];
            for (row, &i) in free.iter().enumerate() {
                multiply(scaled, columns[i], errors);
                for (column, &j) in free[..=row].iter().enumerate() {
                    matrix[row][column] = sum_of_products(scaled, columns[j]);
                }
                matrix[row][MOST_CONSTANTS] = sum_of_products(scaled, right);
            }
            if !factor(&mut matrix, free.len()) {
                break;
            }
            let own: [f64; MOST_CONSTANTS] = std::array::from_fn(|i| matrix[i][MOST_CONSTANTS]);
            for (&i, value) in free.iter().zip(substituted(&matrix, free.len(), own)) {
                constants[i] = value;
            }
            if best.is_some_and(|best| best.error < SMALL) {
                scaled.copy_from_slice(right);
                for &i in &free {
                    subtract(scaled, constants[i], columns[i]);
                }
                scaled.iter_mut().zip(&*errors).for_each(|(left, weight)| *left *= weight);
                let mut left = [0.0; MOST_CONSTANTS];
                for (sum, &i) in left.iter_mut().zip(&free) {
                    *sum = sum_of_products(scaled, columns[i]);
                }
                for (&i, value) in free.iter().zip(substituted(&matrix, free.len(), left)) {
                    constants[i] += value;
                }
            }
            sums.errors(&constants, below, errors);
            let (mut largest, mut is_defined) = (0.0_f64, true);
            for (error, weight) in errors.iter().zip(&mut *weights) {
                let size = error.abs();
                is_defined &= size <= f64::MAX;
                let size = if size <= f64::MAX { size } else { 1.0 };
                largest = largest.max(size);
                *weight *= size;
            }
            if is_defined && best.is_none_or(|best| largest < best.error) {
                best = Some(Fit { constants, error: largest });
            }
            if step == 1 && best.is_none_or(|best| best.error > steps.given_up) {
                return None;
            }
            let total: f64 = weights.iter().sum();
            let is_bounded = |value: &f64| *value != 0.0 && value.is_finite();
            if total.is_nan() || total <= 0.0 || !below.iter().all(is_bounded) {
                break;
            }
            let least = 1e-9 / places as f64;
            weights.iter_mut().for_each(|weight| *weight = (*weight / total).max(least));
        }
        best
    }
}

impl QuotientOfSums<'_> {
    /// The columns of the linear problem `sum_i theta_i b_i/z - sum_j theta_j d_j = 1`, of the free constants.
    #[inline(always)]
    fn fill_columns(&self, into: &mut [f64]) {
        let places = self.places();
        for (i, column) in into.chunks_exact_mut(places).enumerate() {
            match self.tie {
                None => self.add_column(i, 1.0, column),
                Some(tie) => {
                    let rows = tie.matrix.iter().enumerate();
                    rows.for_each(|(k, row)| self.add_column(k, row[i], column));
                }
            }
        }
    }

    /// The right side of the linear problem.
    #[inline(always)]
    fn fill_right(&self, into: &mut [f64]) {
        into.fill(1.0);
        for (k, offset) in self.tie.iter().flat_map(|tie| tie.offset.iter().enumerate()) {
            self.add_column(k, -offset, into);
        }
    }

    /// Adds the column of a constant, free or tied, times a factor.
    #[inline(always)]
    fn add_column(&self, constant: usize, factor: f64, into: &mut [f64]) {
        let above = self.numerator.len();
        match constant < above {
            true => subtract(into, -factor, self.numerator[constant]),
            false => subtract(into, factor, self.denominator[constant - above]),
        }
    }
}

/// Subtracts a multiple of some numbers from others.
#[inline(always)]
fn subtract(from: &mut [f64], factor: f64, values: &[f64]) {
    from.iter_mut().zip(values).for_each(|(own, value)| *own -= factor * value);
}

/// The products of two numbers each.
#[inline(always)]
fn multiply(into: &mut [f64], left: &[f64], right: &[f64]) {
    into.iter_mut().zip(left.iter().zip(right)).for_each(|(into, (a, b))| *into = a * b);
}

/// A sum of products, eight sums side by side, so that it is the same with all vector instructions.
#[inline(always)]
fn sum_of_products(left: &[f64], right: &[f64]) -> f64 {
    const TOGETHER: usize = 8;
    let mut sums = [0.0; TOGETHER];
    let (left, right) = (left.chunks_exact(TOGETHER), right.chunks_exact(TOGETHER));
    let rest = left.remainder().iter().zip(right.remainder()).map(|(a, b)| a * b);
    let rest: f64 = rest.sum();
    for (left, right) in left.zip(right) {
        for k in 0..TOGETHER {
            sums[k] += left[k] * right[k];
        }
    }
    sums.iter().sum::<f64>() + rest
}

/// The error from which on the constants are found to more digits than the normal equations have.
const SMALL: f64 = 1e-4;

/// Replaces the lower half of a symmetric matrix by Cholesky's factor; false if it is not positive.
#[inline(always)]
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
#[inline(always)]
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
            let over_target = |power: &Vec<f64>| -> Vec<f64> {
                power.iter().zip(target).map(|(value, target)| value / target).collect()
            };
            let numerator: Vec<Vec<f64>> = powers[..above].iter().map(over_target).collect();
            let sums = QuotientOfSums {
                numerator: numerator.iter().map(Vec::as_slice).collect(),
                denominator: powers[1..=below].iter().map(Vec::as_slice).collect(),
                power: PowerOfQuotient::new(&Rational::from_integer(1.into())),
                tie: None,
            };
            let fit = sums.minimax(&[None; MOST_CONSTANTS], FitSteps::all(40)).unwrap();
            assert!(fit.error >= least * (1.0 - 1e-6), "{} {least}", fit.error);
            assert!(fit.error <= least * 1.02, "{} {least}", fit.error / least - 1.0);
        }
    }
}
