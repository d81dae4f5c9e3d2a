//! The mean of a smooth function between an end of an interval and any place in it, without
//! cancellation close to the end.
//!
//! Reference: L. N. Trefethen, *Approximation Theory and Approximation Practice*, SIAM 2013,
//! chapters 3 and 19.
//!
//! ```text
//! f = c_0 + sum_k c_k T_k(u),   int f du = sum_k b_k T_k(u),   b_k = (c_(k-1) - c_(k+1))/(2 k),   b_1 = c_0 - c_2/2
//! (1 - T_k(u))/(1 - u) = k + 2 sum_(0<j<k) (k - j) T_j(u)
//! mean over [u, 1]:   q_0/2 + sum_j q_j T_j(u),   q_j = 2 sum_(k>j) (k - j) b_k
//! ```
//!
//! Costs some fifty to two thousand values of the function, as it has waves, and then a sum of as many terms for each
//! mean, where a quadrature takes seventy values of the function or more.

use std::f64::consts::PI;

/// The means of a function from both ends of an interval.
#[derive(Clone, Debug)]
pub(super) struct MeanValues {
    ends: [f64; 2],
    /// The `q_j` of the means from the lower and to the upper end; those from the lower end are of
    /// the mirrored function.
    series: [Vec<f64>; 2],
}

impl MeanValues {
    /// Expands a function between two places, in either order; `None` if its Chebyshev series has
    /// not converged to rounding within 1024 terms, or the function nearly vanishes at an end at
    /// which the digits of a mean matter relative to the mean itself.
    pub(super) fn new(
        function: &dyn Fn(f64) -> f64,
        ends: [f64; 2],
        relative_at: [bool; 2],
    ) -> Option<Self> {
        const FEWEST: usize = 16;
        const MOST: usize = 1024;
        /// Ratio of the last half of the coefficients to the largest one at which the series has
        /// converged: what is left out is then below the rounding of those.
        const CONVERGED: f64 = 1e-15;
        /// Ratio of the function at an end to its largest coefficient.
        const LEAST_AT_ENDS: f64 = 0.1;
        /// Decay of the last half of the coefficients with twice the points that tells of a power at
        /// a singularity: unresolved waves do not decay, and what is smooth decays faster. Twice in
        /// a row it is no accident.
        const ALGEBRAIC: std::ops::Range<f64> = 0.1..0.6;
        let (mut count, mut before, mut algebraic) = (FEWEST, f64::INFINITY, 0);
        let coefficients = loop {
            let mut coefficients = chebyshev_coefficients(function, ends, count)?;
            let size = |part: &[f64]| part.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
            let largest = size(&coefficients);
            if size(&coefficients[count / 2..]) <= CONVERGED * largest {
                let small = |(end, relative): (f64, bool)| {
                    relative && function(end).abs() < LEAST_AT_ENDS * largest
                };
                if ends.into_iter().zip(relative_at).any(small) {
                    return None;
                }
                coefficients.truncate(count / 2);
                break coefficients;
            }
            let last = size(&coefficients[count / 2..]);
            algebraic = if ALGEBRAIC.contains(&(last / before)) { algebraic + 1 } else { 0 };
            (count, before) = (2 * count, last);
            if count > MOST || algebraic == 2 {
                return None;
            }
        };
        let mirrored = coefficients.iter().enumerate();
        let mirrored: Vec<f64> = mirrored.map(|(k, c)| if k % 2 == 1 { -c } else { *c }).collect();
        Some(Self { ends, series: [mean_series(&mirrored), mean_series(&coefficients)] })
    }

    /// The mean between the first end and a place.
    pub(super) fn since_first(&self, place: f64) -> f64 {
        let [first, last] = self.ends;
        sum(&self.series[0], 1.0 - 2.0 * (place - first) / (last - first))
    }

    /// The mean between a place and the last end.
    pub(super) fn until_last(&self, place: f64) -> f64 {
        let [first, last] = self.ends;
        sum(&self.series[1], 1.0 - 2.0 * (last - place) / (last - first))
    }
}

/// The coefficients of the interpolant in `count` Chebyshev points of the first kind; `None` if a
/// value is not finite.
fn chebyshev_coefficients(
    function: &dyn Fn(f64) -> f64,
    [first, last]: [f64; 2],
    count: usize,
) -> Option<Vec<f64>> {
    // cos(m pi/(2 n)) for m = 0, ..., 4 n - 1: all the cosines that occur.
    let cosines: Vec<f64> =
        (0..4 * count).map(|m| (m as f64 * PI / (2 * count) as f64).cos()).collect();
    let (middle, half) = (0.5 * (first + last), 0.5 * (last - first));
    let values: Vec<f64> =
        (0..count).map(|j| function(middle + half * cosines[2 * j + 1])).collect();
    if !values.iter().all(|value| value.is_finite()) {
        return None;
    }
    let coefficient = |k: usize| {
        let waves = values.iter().enumerate();
        let sum: f64 = waves.map(|(j, value)| value * cosines[k * (2 * j + 1) % (4 * count)]).sum();
        sum * if k == 0 { 1.0 } else { 2.0 } / count as f64
    };
    Some((0..count).map(coefficient).collect())
}

/// The `q_j` of the mean over `[u, 1]`, the first of them halved.
fn mean_series(coefficients: &[f64]) -> Vec<f64> {
    let c = |k: usize| coefficients.get(k).copied().unwrap_or(0.0);
    let count = coefficients.len();
    let integral = |k: usize| match k {
        1 => c(0) - 0.5 * c(2),
        _ => (c(k - 1) - c(k + 1)) / (2 * k) as f64,
    };
    // Sums from the end, once and twice.
    let (mut once, mut twice) = (0.0, 0.0);
    let mut series = vec![0.0; count];
    for j in (0..count).rev() {
        once += integral(j + 1);
        twice += once;
        series[j] = if j == 0 { twice } else { 2.0 * twice };
    }
    series
}

/// The sum of a Chebyshev series (Clenshaw 1955).
fn sum(series: &[f64], u: f64) -> f64 {
    let (mut newer, mut older) = (0.0, 0.0);
    for coefficient in series.iter().skip(1).rev() {
        (newer, older) = (2.0 * u * newer - older + coefficient, newer);
    }
    u * newer - older + series.first().copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Means of the exponential and the cosine, whose integrals are known, close to the ends too.
    #[test]
    fn means_are_those_of_the_integral() {
        let [first, last] = [1.7, -0.4];
        let exponential =
            MeanValues::new(&f64::exp, [first, last], [true; 2]).expect("a smooth function");
        for part in [1e-12_f64, 1e-6, 0.1, 0.5, 0.9, 1.0] {
            let near_last = last + (first - last) * part;
            // (e^b - e^a)/(b - a) = e^a expm1(b - a)/(b - a)
            let mean = |a: f64, width: f64| a.exp() * width.exp_m1() / width;
            let expected = mean(last, (first - last) * part);
            let found = exponential.until_last(near_last);
            // Of the largest value.
            let allowed = 2e-15 * first.exp();
            assert!((found - expected).abs() < allowed, "{part}: {found} {expected}");
            let near_first = first - (first - last) * part;
            let expected = mean(first, (last - first) * part);
            let found = exponential.since_first(near_first);
            assert!((found - expected).abs() < allowed, "{part}: {found} {expected}");
        }
        let waves = MeanValues::new(&|x| 2.0 + (30.0 * x).cos(), [0.0, 3.0], [true; 2])
            .expect("some waves");
        for x in [0.01_f64, 1.0, 2.5] {
            let expected = 2.0 + (30.0 * x).sin() / (30.0 * x);
            assert!((waves.since_first(x) / expected - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn what_does_not_converge_is_left_out() {
        assert!(MeanValues::new(&|x| x.abs().sqrt() + 1.0, [-1.0, 1.0], [true; 2]).is_none());
        assert!(MeanValues::new(&|x| (x - 0.3).recip(), [-1.0, 1.0], [true; 2]).is_none());
        let waves = |x: f64| 2.0 + (1000.0 * x).cos();
        assert!(MeanValues::new(&waves, [0.0, 3.0], [true; 2]).is_none());
        // Nothing at the end that digits could be relative to.
        let steep = |x: f64| (20.0 * x).exp();
        assert!(MeanValues::new(&steep, [-1.0, 1.0], [true, false]).is_none());
        assert!(MeanValues::new(&steep, [-1.0, 1.0], [false, true]).is_some());
    }
}
