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

/// A bound of the largest size of a series; sines are bounded by their norm.
pub(super) fn largest_value(series: &FourierSeries) -> Bound {
    let coefficients: Vec<f64> = series.cosines.iter().map(|ball| WORKING.nearest(ball)).collect();
    let cosine = |angle: usize| {
        let angle = angle % (2 * INTERVALS);
        COSINES[angle.min(2 * INTERVALS - angle)]
    };
    let value = |point: usize| -> f64 {
        coefficients.iter().enumerate().map(|(k, size)| size * cosine(k * point)).sum()
    };
    let at_points = (0..=INTERVALS).map(|point| Bound::exactly(value(point).abs()));
    let at_points = at_points.fold(Bound::ZERO, Bound::max);
    let sizes = || series.cosines.iter().map(|ball| WORKING.magnitude(ball)).enumerate();
    let curvature: Bound =
        sizes().map(|(k, size)| size * Bound::exactly(k as f64) * Bound::exactly(k as f64)).sum();
    // 1.6 is above pi/2.
    let apart = Bound::exactly(1.6).over(INTERVALS as f64);
    let norm: Bound = sizes().map(|(_, size)| size).sum();
    let rounding = Bound::exactly(f64::EPSILON) * Bound::exactly(coefficients.len() as f64 + 4.0);
    let radii: Bound = series.cosines.iter().map(|ball| ball.radius).sum();
    let sines: Bound = series.sines.iter().map(|ball| WORKING.magnitude(ball)).sum();
    at_points + apart * apart * curvature / 2 + rounding * norm + radii + sines + series.tail
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
