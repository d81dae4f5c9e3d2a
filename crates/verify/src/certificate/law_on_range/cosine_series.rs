//! The series over which a law and the truth are enclosed: of doubles, which suffice for most laws, or of balls.
//!
//! ```text
//! r G = F_1 + 4 sum_{l >= 1} l cos(l theta) sum_{k = l + 1, l + 3, ...} F_k/(k^2 - 1)     of a force sum_k F_k cos(k theta)
//! T_k((x + 1)/2) = 2^-k sum_j m_jk T_j(x),   T_k((x - 1)/2) = 2^-k sum_j (-1)^(j + k) m_jk T_j(x),   m whole numbers
//! ```
//!
//! In: series. Out: `r G` of a force, the series of a part of the interval of another one, and bounds of sizes.

use std::sync::LazyLock;

use num_traits::ToPrimitive as _;

use super::super::double_series::{self, DoubleSeries};
use super::super::elementary::Analytic;
use super::super::fourier_series::{FourierSeries, WORKING};
use super::super::largest_value::{largest_value, largest_value_of_doubles};
use super::jet::DIGITS;
use crate::exact::Integer;
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;

/// A cosine series with a tail.
pub(super) trait CosineSeries: Analytic + Send + Sync {
    /// Steps of Newton's iteration from a number in doubles to as many digits as are kept.
    const STEPS_FROM_DOUBLES: usize;

    /// The series with these coefficients, of the digits that are kept.
    fn of_balls(cosines: Vec<Ball>) -> Self;

    /// The coefficient of a cosine.
    fn cosine(&self, harmonic: usize) -> Ball;

    /// The number of coefficients.
    fn length(&self) -> usize;

    /// The bound of the norm of the part that is not in the coefficients.
    fn tail(&self) -> Bound;

    /// `r G` of the series of a force along `m + r cos(theta)`.
    fn mean_rate(&self) -> Self;

    /// A series of Chebyshev on the upper or the lower half of its interval.
    fn on_half(&self, is_upper: bool) -> Self;

    /// A bound of the largest size.
    fn largest_value(&self) -> Bound;

    /// This series, of the digits that are kept.
    fn of_kept_digits(self) -> Self;
}

/// The number of polynomials of Chebyshev whose halves are known; coefficients beyond are a part of the tail.
const MOST: usize = 60;

/// m_jk by k and j.
static HALVES: LazyLock<Vec<Vec<i64>>> = LazyLock::new(|| {
    let mut halves = vec![vec![1], vec![1, 1]];
    for k in 2..MOST {
        // T_(k + 1)(y) = 2 y T_k(y) - T_(k - 1)(y) with 2 y = x + 1, and 2 x T_j = T_(j + 1) + T_|j - 1|.
        let (own, before): (&Vec<i64>, &Vec<i64>) = (&halves[k - 1], &halves[k - 2]);
        let mut next = vec![0; k + 1];
        for (j, number) in own.iter().enumerate() {
            next[j + 1] += number;
            next[j.abs_diff(1)] += number;
            next[j] += 2 * number;
        }
        before.iter().zip(&mut next).for_each(|(number, next)| *next -= 4 * number);
        halves.push(next);
    }
    halves
});

/// Whether a coefficient of a half has another sign than m.
const fn is_turned(is_upper: bool, j: usize, k: usize) -> bool {
    !is_upper && (j + k) % 2 == 1
}

impl CosineSeries for FourierSeries {
    const STEPS_FROM_DOUBLES: usize = 1;

    fn of_balls(cosines: Vec<Ball>) -> Self {
        Self::exactly(cosines, vec![]).of_digits(DIGITS)
    }

    fn cosine(&self, harmonic: usize) -> Ball {
        self.cosine(harmonic)
    }

    fn length(&self) -> usize {
        self.length()
    }

    fn tail(&self) -> Bound {
        self.tail
    }

    fn mean_rate(&self) -> Self {
        let length = self.length();
        let mut cosines = vec![Ball::zero(); length.max(1)];
        // From the highest harmonic down, the sum over k = l + 1, l + 3, ... grows by a term each time; the
        // two parities take turns.
        let mut sums = [Ball::zero(), Ball::zero()];
        for l in (1..length).rev() {
            let k = l + 1;
            let sum = &mut sums[l % 2];
            if k < length {
                let divisor = u32::try_from(k * k - 1).unwrap_or(u32::MAX);
                *sum = WORKING.sum(sum, &WORKING.divided(&self.cosine(k), divisor));
            }
            cosines[l] = WORKING.scaled(sum, 4 * l as i64);
        }
        cosines[0] = self.cosine(1);
        let tail = self.tail * Bound::exactly(4.0) / 3;
        <Self as CosineSeries>::of_balls(cosines).widened(tail)
    }

    fn on_half(&self, is_upper: bool) -> Self {
        let mut halved = vec![Ball::zero(); self.cosines.len().min(MOST)];
        for (k, (own, column)) in self.cosines.iter().zip(&*HALVES).enumerate() {
            for (j, (number, half)) in column.iter().zip(&mut halved).enumerate() {
                let number = if is_turned(is_upper, j, k) { -number } else { *number };
                let factor = WORKING.dyadic(&Integer::from(number), k);
                *half = WORKING.sum(half, &WORKING.product(own, &factor));
            }
        }
        let beyond = self.cosines.iter().skip(MOST).map(|ball| WORKING.magnitude(ball)).sum();
        // A tail on an interval bounds values, and no value of the polynomials beyond is larger than one.
        <Self as CosineSeries>::of_balls(halved).widened(self.tail + beyond)
    }

    fn largest_value(&self) -> Bound {
        largest_value(self)
    }

    fn of_kept_digits(self) -> Self {
        self.of_digits(DIGITS)
    }
}

impl CosineSeries for DoubleSeries {
    const STEPS_FROM_DOUBLES: usize = 0;

    fn of_balls(cosines: Vec<Ball>) -> Self {
        Self::of_balls(&cosines)
    }

    fn cosine(&self, harmonic: usize) -> Ball {
        double_series::ball(self.cosines().get(harmonic).copied().unwrap_or(0.0), Bound::ZERO)
    }

    fn length(&self) -> usize {
        self.cosines().len()
    }

    fn tail(&self) -> Bound {
        self.tail()
    }

    fn mean_rate(&self) -> Self {
        let own = self.cosines();
        let mut cosines = vec![0.0; own.len().max(1)];
        let mut sums = [0.0, 0.0];
        for l in (1..own.len()).rev() {
            let sum = &mut sums[l % 2];
            if let Some(force) = own.get(l + 1) {
                *sum += force / ((l + 1) * (l + 1) - 1) as f64;
            }
            cosines[l] = 4.0 * l as f64 * *sum;
        }
        cosines[0] = own.get(1).copied().unwrap_or(0.0);
        let over = |bound: Bound| bound * Bound::exactly(4.0) / 3;
        let sizes = over(self.finite_norm());
        Self::rounded(cosines, over(self.tail()), own.len() + 3, sizes)
    }

    fn on_half(&self, is_upper: bool) -> Self {
        let own = self.cosines();
        let mut halved = vec![0.0; own.len().min(MOST)];
        let (mut unit, mut sizes) = (1.0, Bound::ZERO);
        for (k, (own, column)) in own.iter().zip(&*HALVES).enumerate() {
            let mut all = 0.0;
            for (j, (number, half)) in column.iter().zip(&mut halved).enumerate() {
                let factor = unit * number.to_f64().unwrap_or(f64::NAN);
                *half += if is_turned(is_upper, j, k) { -factor * own } else { factor * own };
                all += factor.abs();
            }
            sizes += Bound::exactly(all * own.abs()) * Bound::exactly(1.0 + 1e-9);
            unit /= 2.0;
        }
        let beyond = own.iter().skip(MOST).map(|size| Bound::exactly(size.abs())).sum();
        Self::rounded(halved, self.tail() + beyond, own.len() + 2, sizes)
    }

    fn largest_value(&self) -> Bound {
        largest_value_of_doubles(self.cosines(), self.tail())
    }

    fn of_kept_digits(self) -> Self {
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::ratio;

    /// With y = (x + 1)/2 or (x - 1)/2: `T_2(y) = T_2(x)/4 +- T_1(x) - 1/4`, and `3 + y` beside it.
    fn halves_are_those_of_polynomials<S: CosineSeries>() {
        let balls = |numbers: &[(i64, i64)]| -> Vec<Ball> {
            numbers.iter().map(|(n, d)| WORKING.fraction(&ratio(*n, *d))).collect()
        };
        let series = S::of_balls(balls(&[(3, 1), (1, 1), (1, 1)]));
        for (is_upper, expected) in
            [(true, [(13, 4), (3, 2), (1, 4)]), (false, [(9, 4), (-1, 2), (1, 4)])]
        {
            let apart = series.on_half(is_upper).difference(&S::of_balls(balls(&expected)));
            assert!(apart.norm() < Bound::exactly(1e-14), "{is_upper} {}", apart.norm().value());
        }
    }

    #[test]
    fn halves_of_both_series_are_those_of_polynomials() {
        halves_are_those_of_polynomials::<DoubleSeries>();
        halves_are_those_of_polynomials::<FourierSeries>();
    }
}
