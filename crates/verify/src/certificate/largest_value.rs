//! The largest value of a cosine series, bounded.
//!
//! ```text
//! u(theta) = sum_k a_k cos(k theta) + h(theta),   theta_j = pi j/M:
//! max |u| <= max_j |u(theta_j)| + (pi/(2 M))^2/2 sum_k k^2 |a_k| + max |h|
//! ```
//!
//! The slope of the sum is zero where it is largest, and the nearest of the points, both ends among them, is
//! within `pi/(2 M)` of that. The cosines are the doubles nearest to proved ones, and the rounding of a sum of n
//! products is bounded by `n + 4` units in the last place of the sum of their sizes.
//!
//! Source for rounding: N. J. Higham, Accuracy and Stability of Numerical Algorithms, SIAM 2002, section 3.1.

use std::sync::LazyLock;

use pulp::{Arch, NullaryFnOnce};

use super::double_series::DoubleSeries;
use super::elementary::Analytic as _;
use super::fourier_series::{FourierSeries, WORKING, sum_of_angles};
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;

/// M.
const INTERVALS: usize = 1024;

/// The cosines of the points, the doubles nearest to them.
static COSINES: LazyLock<Vec<f64>> = LazyLock::new(|| {
    let step = WORKING.divided(&WORKING.pi(), INTERVALS as u32);
    let by = FourierSeries::constant(step).sine_and_cosine();
    let Some((sine, cosine)) = by else { return vec![f64::NAN; INTERVALS + 1] };
    let by = [cosine.at_zero(), sine.at_zero()];
    let mut angle = [WORKING.integer(1), Ball::zero()];
    let next = |_| {
        let cosine = WORKING.nearest(&angle[0]);
        angle = sum_of_angles(&angle, &by);
        cosine
    };
    (0..=INTERVALS).map(next).collect()
});

/// The cosines of multiples of the points up to the middle, multiple by multiple, as far as many series reach.
static ROWS: LazyLock<Vec<Vec<f64>>> = LazyLock::new(|| {
    const MOST: usize = 64;
    let row = |k: usize| (0..=INTERVALS / 2).map(|point| cosine(k * point)).collect();
    (0..MOST).map(row).collect()
});

/// The cosine of a multiple of `pi/M`.
fn cosine(angle: usize) -> f64 {
    let angle = angle % (2 * INTERVALS);
    COSINES[angle.min(2 * INTERVALS - angle)]
}

/// The largest size at the points, from the even and the odd harmonics: those at `pi - theta` have the other sign.
struct LargestAtPoints<'a>(&'a [f64]);

impl NullaryFnOnce for LargestAtPoints<'_> {
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        let mut sums = [[0.0; INTERVALS / 2 + 1]; 2];
        for (k, own) in self.0.iter().enumerate() {
            let sums = &mut sums[k % 2];
            match ROWS.get(k) {
                Some(row) => {
                    sums.iter_mut().zip(row).for_each(|(sum, cosine)| *sum += own * cosine)
                }
                None => sums
                    .iter_mut()
                    .enumerate()
                    .for_each(|(point, sum)| *sum += own * cosine(k * point)),
            }
        }
        let [even, odd] = &sums;
        // A coefficient that is no number makes the norm, which is added, unknown.
        even.iter().zip(odd).fold(0.0, |largest, (even, odd)| largest.max(even.abs() + odd.abs()))
    }
}

/// A bound of the largest size of a series; sines are bounded by their norm.
pub(super) fn largest_value(series: &FourierSeries) -> Bound {
    let cosines = DoubleSeries::of_balls(&series.cosines);
    let sines: Bound = series.sines.iter().map(|ball| WORKING.magnitude(ball)).sum();
    largest_value_of_doubles(cosines.cosines(), cosines.tail() + sines + series.tail)
}

/// A bound of the largest size of a cosine series with these coefficients and a tail.
pub(super) fn largest_value_of_doubles(cosines: &[f64], tail: Bound) -> Bound {
    let at_points = Bound::exactly(Arch::new().dispatch(LargestAtPoints(cosines)));
    let sizes = || cosines.iter().map(|own| Bound::exactly(own.abs())).enumerate();
    let curvature: Bound =
        sizes().map(|(k, size)| size * Bound::exactly(k as f64) * Bound::exactly(k as f64)).sum();
    // 1.6 is above pi/2.
    let apart = Bound::exactly(1.6).over(INTERVALS as f64);
    let norm: Bound = sizes().map(|(_, size)| size).sum();
    let rounding = Bound::exactly(f64::EPSILON) * Bound::exactly(cosines.len() as f64 + 4.0);
    at_points + apart * apart * curvature / 2 + rounding * norm + tail
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::ratio;

    /// `T_3(x) + x/2` on [-1, 1] is largest at the end, 3/2; `1 + cos 2 theta - cos 4 theta`, which is
    /// `2 + u - 2 u^2` with `u = cos 2 theta`, at `u = 1/4`, 17/8.
    #[test]
    fn bounds_are_just_above_the_largest_values() {
        for (sizes, largest) in [
            (vec![ratio(0, 1), ratio(1, 2), ratio(0, 1), ratio(1, 1)], 1.5),
            (vec![ratio(1, 1), ratio(0, 1), ratio(1, 1), ratio(0, 1), ratio(-1, 1)], 2.125),
        ] {
            let cosines = sizes.iter().map(|size| WORKING.fraction(size)).collect();
            let series = FourierSeries::exactly(cosines, vec![]);
            let bound = largest_value(&series).value();
            assert!(bound >= largest && bound < largest * (1.0 + 3e-5), "{bound} {largest}");
            let wider = series.widened(Bound::exactly(0.25));
            assert!(largest_value(&wider).value() >= largest + 0.25);
        }
    }
}
