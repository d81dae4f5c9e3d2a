//! Even functions of an angle in doubles, known up to a distance: cosine series whose rounding errors are a part
//! of their tail.
//!
//! ```text
//! u(theta) = sum_k a_k cos(k theta) + h(theta),   ||h|| <= tail,   norm: sum_k |a_k| + tail
//! ```
//!
//! In: balls, rounded to doubles. Out: series that contain the result of the operations for any functions contained
//! in the operands, as those of `fourier_series`, with some twelve digits instead of as many as are asked for. A
//! product of n by m coefficients costs 2 n m products of doubles, a hundredth of those of balls.
//!
//! A sum of N products errs by at most `N u/(1 - N u)` of the sum of their sizes, u half a unit in the last place, and
//! the smallest normal double is far below all that is of interest: it is added to tails in place of underflows.
//!
//! Source: N. J. Higham, Accuracy and Stability of Numerical Algorithms, SIAM 2002, section 3.1.

use num_traits::{ToPrimitive as _, Zero as _};
use pulp::{Arch, NullaryFnOnce};

use super::elementary::Analytic;
use super::fourier_series::{WORKING, transform};
use crate::exact::Integer;
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;

/// A bound of the relative error of an operation, and of `u/(1 - N u)` for all sums of this length.
const ROUNDING: Bound = Bound::exactly(1.2e-16);

/// A bound of what underflows of one operation on series leave out.
const UNDERFLOW: Bound = Bound::exactly(1e-300);

/// The size of a trailing coefficient, over the norm, that is a part of the tail.
const NEGLIGIBLE: f64 = 1e-17;

/// The binary exponent to which functions are computed, with its sign changed.
const DIGITS: i32 = 60;

/// The largest number of coefficients; those beyond are a part of the tail.
const LONGEST: usize = 1600;

/// An even function of an angle, known up to a distance.
#[derive(Clone, Debug)]
pub(super) struct DoubleSeries {
    /// The coefficients of the cosines, that of the constant first.
    cosines: Vec<f64>,
    /// Bound of the norm of the part that is not in the coefficients.
    tail: Bound,
}

impl DoubleSeries {
    /// The series nearest to that of these balls, which it contains.
    pub(super) fn of_balls(cosines: &[Ball]) -> Self {
        let mut tail = Bound::ZERO;
        let double = |ball: &Ball| {
            let value = nearest(ball);
            tail += ball.radius + Bound::exactly(value.abs()) * ROUNDING;
            value
        };
        let cosines = cosines.iter().map(double).collect();
        Self { cosines, tail }
    }

    /// The coefficients of the cosines.
    pub(super) fn cosines(&self) -> &[f64] {
        &self.cosines
    }

    /// The bound of the norm of the part that is not in the coefficients.
    pub(super) const fn tail(&self) -> Bound {
        self.tail
    }

    /// The value at the angle pi, without a proof.
    pub(super) fn at_pi(&self) -> f64 {
        let signed = |(k, own): (usize, &f64)| if k % 2 == 0 { *own } else { -own };
        self.cosines.iter().enumerate().map(signed).sum()
    }

    /// The norm of the part in the coefficients.
    pub(super) fn finite_norm(&self) -> Bound {
        sum_of_sizes(&self.cosines)
    }

    /// The series of other coefficients that are sums of up to `count` products of numbers with the own ones, whose
    /// sizes sum up to `sizes`.
    pub(super) fn rounded(cosines: Vec<f64>, tail: Bound, count: usize, sizes: Bound) -> Self {
        Self { cosines, tail: tail + rounding(count) * sizes + UNDERFLOW }.trimmed()
    }

    /// Moves trailing harmonics that are negligible, or beyond the greatest length, into the tail.
    fn trimmed(mut self) -> Self {
        let negligible = NEGLIGIBLE * self.finite_norm().value();
        while let Some(last) = self.cosines.last() {
            let size = last.abs();
            if size > negligible && self.cosines.len() <= LONGEST {
                break;
            }
            self.tail += Bound::exactly(size);
            self.cosines.pop();
        }
        self
    }

    /// The sum of this one and the other times a sign.
    fn with(&self, other: &Self, sign: f64) -> Self {
        let [longer, shorter] = [
            self.cosines.len().max(other.cosines.len()),
            self.cosines.len().min(other.cosines.len()),
        ];
        let of = |cosines: &[f64], k: usize| cosines.get(k).copied().unwrap_or(0.0);
        let sum = |k| of(&self.cosines, k) + sign * of(&other.cosines, k);
        let cosines: Vec<f64> = (0..longer).map(sum).collect();
        let tail = self.tail + other.tail + ROUNDING * sum_of_sizes(&cosines[..shorter]);
        Self { cosines, tail }
    }
}

/// The double nearest to the middle of a ball.
pub(super) fn nearest(ball: &Ball) -> f64 {
    let unit = Bound::power_of_two(-(WORKING.bits as i32)).value();
    ball.middle.to_f64().map_or(f64::NAN, |units| units * unit)
}

/// The ball of a double, with a radius.
pub(super) fn ball(value: f64, radius: Bound) -> Ball {
    let (mantissa, exponent, sign) = num_traits::Float::integer_decode(value);
    if !value.is_finite() {
        return Ball { middle: Integer::zero(), radius: Bound::UNKNOWN };
    }
    let mantissa = Integer::from(mantissa) * Integer::from(i64::from(sign));
    let exact = match usize::try_from(-exponent) {
        Ok(places) => WORKING.dyadic(&mantissa, places),
        Err(_) => Ball {
            middle: mantissa << (WORKING.bits + usize::from(exponent.unsigned_abs())),
            radius: Bound::ZERO,
        },
    };
    Ball { radius: exact.radius + radius, ..exact }
}

/// A bound of the relative error of a sum of this many products.
fn rounding(count: usize) -> Bound {
    Bound::exactly(count as f64 + 1.0) * ROUNDING
}

/// A bound of the sum of the sizes of doubles.
fn sum_of_sizes(values: &[f64]) -> Bound {
    let sum: f64 = values.iter().map(|value| value.abs()).sum();
    Bound::exactly(sum) * (Bound::exactly(1.0) + rounding(values.len()))
}

/// Twice the product of two cosine series: `2 cos i cos j = cos(i + j) + cos(i - j)`. The right one is continued to
/// harmonics of either sign, so that all loops go forward.
struct DoubledProduct<'a>(&'a [f64], &'a [f64]);

impl NullaryFnOnce for DoubledProduct<'_> {
    type Output = Vec<f64>;

    #[inline(always)]
    fn call(self) -> Vec<f64> {
        let Self(left, right) = self;
        let count = right.len();
        let mut sums = vec![0.0; left.len() + count - 1];
        let mut both = vec![0.0; 2 * count - 1];
        for (k, value) in right.iter().enumerate() {
            both[count - 1 + k] = *value;
            both[count - 1 - k] = *value;
        }
        both[count - 1] *= 2.0;
        for (i, own) in left.iter().enumerate() {
            let first = (i + 1).saturating_sub(count);
            let from = count - 1 + first - i;
            for (sum, other) in sums[first..i + count].iter_mut().zip(&both[from..]) {
                *sum += own * other;
            }
            if let Some(beyond) = right.get(i + 1..) {
                for (sum, other) in sums[1..].iter_mut().zip(beyond) {
                    *sum += own * other;
                }
            }
        }
        sums
    }
}

impl Analytic for DoubleSeries {
    fn constant(value: Ball) -> Self {
        Self::of_balls(&[value])
    }

    fn integer(value: i64) -> Self {
        match i32::try_from(value) {
            Ok(value) => Self { cosines: vec![f64::from(value)], tail: Bound::ZERO },
            Err(_) => Self::constant(WORKING.integer(value)),
        }
    }

    fn sum(&self, other: &Self) -> Self {
        self.with(other, 1.0)
    }

    fn difference(&self, other: &Self) -> Self {
        self.with(other, -1.0)
    }

    fn product(&self, other: &Self) -> Self {
        let tails = self.tail * other.norm() + other.tail * self.finite_norm();
        let shorter = self.cosines.len().min(other.cosines.len());
        if shorter == 0 {
            return Self { cosines: vec![], tail: tails };
        }
        let mut cosines = Arch::new().dispatch(DoubledProduct(&self.cosines, &other.cosines));
        cosines.iter_mut().for_each(|doubled| *doubled /= 2.0);
        let sizes = self.finite_norm() * other.finite_norm();
        Self::rounded(cosines, tails, 3 * shorter, sizes)
    }

    fn scaled(&self, factor: i64) -> Self {
        let size = factor.unsigned_abs();
        let (factor, bound) = (factor as f64, Bound::of_nearest(size as f64));
        let cosines: Vec<f64> = self.cosines.iter().map(|own| own * factor).collect();
        let tail = self.tail * bound;
        match size.is_power_of_two() {
            true => Self { cosines, tail },
            false => Self::rounded(cosines, tail, 1, self.finite_norm() * bound),
        }
    }

    fn divided(&self, divisor: u32) -> Self {
        let over = f64::from(divisor);
        let cosines = self.cosines.iter().map(|own| own / over).collect();
        let sizes = match divisor.is_power_of_two() {
            true => Bound::ZERO,
            false => self.finite_norm() / divisor,
        };
        Self::rounded(cosines, self.tail / divisor, 1, sizes)
    }

    fn norm(&self) -> Bound {
        self.finite_norm() + self.tail
    }

    fn widened(mut self, distance: Bound) -> Self {
        self.tail += distance;
        self
    }

    fn at_zero(&self) -> Ball {
        let sum = self.cosines.iter().sum();
        ball(sum, self.tail + rounding(self.cosines.len()) * self.finite_norm())
    }

    fn negligible(&self) -> i32 {
        DIGITS
    }

    fn without_radii(self) -> Self {
        Self { cosines: self.cosines, tail: Bound::ZERO }.trimmed()
    }

    fn sampled(&self, function: impl Fn(f64) -> f64) -> Option<Self> {
        const LEAST: f64 = 1e-15;
        let (count, transform) = transform(self.cosines.len());
        let values = transform.sum_of_waves(self.cosines.iter().map(|cosine| [*cosine, 0.0]));
        // The second half of a period is the mirror image of the first one.
        let mut samples: Vec<f64> = values.into_iter().take(count / 2 + 1).map(function).collect();
        if samples.iter().any(|value| !value.is_finite()) {
            return None;
        }
        samples.extend_from_within(1..count / 2);
        samples[count / 2 + 1..].reverse();
        let mut cosines = transform.harmonics(&samples, count / 2 - 1).cosines;
        // The coefficient of the constant was twice the mean.
        cosines[0] /= 2.0;
        let largest = cosines.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let length = cosines.iter().rposition(|value| value.abs() >= LEAST * largest);
        cosines.truncate(length.map_or(0, |last| last + 1));
        Some(Self { cosines, tail: Bound::ZERO })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::fourier_series::FourierSeries;
    use super::*;

    /// Series of doubles, which are balls without radii as well.
    fn series() -> impl Strategy<Value = (DoubleSeries, FourierSeries)> {
        let number = prop_oneof![Just(0.0), -0.25..0.25_f64, -1e-9..1e-9_f64];
        proptest::collection::vec(number, 1..9).prop_map(|mut cosines| {
            cosines[0] += 2.5;
            let balls = cosines.iter().map(|own| ball(*own, Bound::ZERO)).collect();
            (DoubleSeries { cosines, tail: Bound::ZERO }, FourierSeries::exactly(balls, vec![]))
        })
    }

    /// Whether a series of doubles is about the function of balls, with a tail that is not wide.
    fn encloses(own: &DoubleSeries, exact: &FourierSeries) -> bool {
        let balls = own.cosines.iter().map(|value| ball(*value, Bound::ZERO)).collect();
        let apart = FourierSeries::exactly(balls, vec![]).difference(exact);
        let middles = |balls: &[Ball]| -> Bound {
            balls.iter().map(|ball| WORKING.size_of_middle(ball)).sum()
        };
        // The balls are some 1e-30 wide.
        middles(&apart.cosines).value() <= own.tail.value() + 1e-25
            && own.tail <= Bound::exactly(1e-11) * own.norm()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn operations_enclose_those_of_balls((one, a) in series(), (other, b) in series(), n in 1_u32..9) {
            prop_assert!(encloses(&one.product(&other), &a.product(&b)));
            prop_assert!(encloses(&one.sum(&other), &a.sum(&b)));
            prop_assert!(encloses(&one.difference(&other), &a.difference(&b)));
            prop_assert!(encloses(&one.scaled(-i64::from(n)), &a.scaled(-i64::from(n))));
            prop_assert!(encloses(&one.divided(n), &a.divided(n)));
            prop_assert!(encloses(&one.power(n), &a.power(n)));
            let sums = [one.at_zero(), a.at_zero()];
            let apart = WORKING.magnitude(&WORKING.difference(&sums[0], &sums[1]));
            prop_assert!(apart.value() <= 3.0 * sums[0].radius.value() + 1e-25);
        }

        #[test]
        fn functions_enclose_those_of_balls((one, a) in series(), degree in 1_u32..6) {
            let (exact, own) = (a.exponential(), one.exponential());
            prop_assert!(exact.zip(own).is_some_and(|(exact, own)| encloses(&own, &exact)));
            let (exact, own) = (a.sine_and_cosine(), one.sine_and_cosine());
            let both = exact.zip(own).map(|(exact, own)| encloses(&own.0, &exact.0) && encloses(&own.1, &exact.1));
            prop_assert_eq!(both, Some(true));
            // A constant of 2.5 and eight coefficients below a quarter: some have no root.
            if let (Some(exact), Some(own)) = (a.inverse_root(degree), one.inverse_root(degree)) {
                prop_assert!(encloses(&own, &exact));
            }
        }
    }

    /// Products are sums over all pairs of harmonics, of either length first.
    #[test]
    fn a_product_of_cosines_is_half_a_sum_of_cosines() {
        let wave = |k: usize| DoubleSeries {
            cosines: (0..=k).map(|i| if i == k { 1.0 } else { 0.0 }).collect(),
            tail: Bound::ZERO,
        };
        for (i, j) in [(0, 0), (0, 3), (3, 0), (2, 5), (5, 2), (4, 4)] {
            let mut expected = vec![0.0; i + j + 1];
            expected[i + j] += 0.5;
            expected[i.abs_diff(j)] += 0.5;
            assert_eq!(wave(i).product(&wave(j)).cosines, expected, "{i} {j}");
        }
    }
}
