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
//! A power such as `(x - a)^(1/3)` at one end `a` has no such series, but in `x = a + (b - a) s^6` it has one:
//!
//! ```text
//! int_a^x f dx = (b - a) int_0^s 6 s^5 f ds,   (1 - s^6)/(1 - s) = 1 + s + ... + s^5
//! ```
//!
//! Costs some fifty to two thousand values of the function, as it has waves, and then a sum of as many terms for each
//! mean, where a quadrature takes seventy values of the function or more; a power at an end costs up to 360 values.

use std::f64::consts::PI;

/// The means of a function from both ends of an interval.
#[derive(Clone, Debug)]
pub(super) struct MeanValues {
    ends: [f64; 2],
    /// The `q_j` of the means from the lower and to the upper end; those from the lower end are of
    /// the mirrored function.
    series: [Vec<f64>; 2],
    /// The end at which the function is a power of the distance: the series are then those of
    /// `6 s^5 f`, from `s = 0` there to `s = 1` at the other end.
    power_at: Option<IntervalEnd>,
}

/// One end of an interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum IntervalEnd {
    /// The end that is given first.
    First,
    /// The end that is given last.
    Last,
}

/// The most terms of a series.
pub(super) const MOST_TERMS: usize = 1024;

/// The exponent of the substitution at an end with a power, by which square roots and cube roots
/// become whole powers, and all other powers smooth.
const GRADING: i32 = 6;

/// The reason why a function has no series.
enum NoSeries {
    /// The coefficients decay as a power of their number.
    Algebraic,
    /// A value is not finite, the digits at an end are lost, or there are too many waves.
    Other,
}

impl MeanValues {
    /// Expands a function between two places, in either order; `None` if neither its Chebyshev
    /// series nor that for a power at one end has converged to rounding within `most` terms, or the
    /// function nearly vanishes at an end at which the digits of a mean matter relative to the mean
    /// itself.
    pub(super) fn new(
        function: &dyn Fn(f64) -> f64,
        ends: [f64; 2],
        relative_at: [bool; 2],
        most: usize,
    ) -> Option<Self> {
        match converged_series(function, ends, relative_at, most) {
            Ok(series) => return Some(Self { ends, series, power_at: None }),
            Err(NoSeries::Algebraic) => {}
            Err(NoSeries::Other) => return None,
        }
        let sides = [
            (IntervalEnd::First, relative_at),
            (IntervalEnd::Last, [relative_at[1], relative_at[0]]),
        ];
        // At the end with the power a mean is known relative to the largest one.
        sides.into_iter().filter(|(_, relative)| !relative[0]).find_map(|(side, relative)| {
            let (from, to) = match side {
                IntervalEnd::First => (ends[0], ends[1]),
                IntervalEnd::Last => (ends[1], ends[0]),
            };
            let graded = |s: f64| {
                let slope = f64::from(GRADING) * s.powi(GRADING - 1);
                slope * function(from + (to - from) * s.powi(GRADING))
            };
            let series = converged_series(&graded, [0.0, 1.0], relative, most).ok()?;
            Some(Self { ends, series, power_at: Some(side) })
        })
    }

    /// The end at which the function is no series in the distance from it.
    pub(super) fn power_at(&self) -> Option<IntervalEnd> {
        self.power_at
    }

    /// The mean over the whole interval.
    pub(super) fn mean(&self) -> f64 {
        match self.power_at {
            None | Some(IntervalEnd::First) => self.until_last(self.ends[0]),
            Some(IntervalEnd::Last) => self.since_first(self.ends[1]),
        }
    }

    /// The mean between the first end and a place.
    pub(super) fn since_first(&self, place: f64) -> f64 {
        let [first, last] = self.ends;
        match self.power_at {
            None => sum(&self.series[0], 1.0 - 2.0 * (place - first) / (last - first)),
            Some(IntervalEnd::First) => self.since_power((place - first) / (last - first)),
            Some(IntervalEnd::Last) => self.to_smooth_end((last - place) / (last - first)),
        }
    }

    /// The mean between a place and the last end.
    pub(super) fn until_last(&self, place: f64) -> f64 {
        let [first, last] = self.ends;
        match self.power_at {
            None => sum(&self.series[1], 1.0 - 2.0 * (last - place) / (last - first)),
            Some(IntervalEnd::First) => self.to_smooth_end((place - first) / (last - first)),
            Some(IntervalEnd::Last) => self.since_power((last - place) / (last - first)),
        }
    }

    /// The mean over this part of the interval, from the end with the power.
    fn since_power(&self, part: f64) -> f64 {
        let s = part.max(0.0).powf(1.0 / f64::from(GRADING));
        match s > 0.0 {
            true => sum(&self.series[0], 1.0 - 2.0 * s) / s.powi(GRADING - 1),
            // Nothing is added over no distance.
            false => 0.0,
        }
    }

    /// The mean from this part of the interval, counted from the end with the power, to the other
    /// end.
    fn to_smooth_end(&self, part: f64) -> f64 {
        let s = part.clamp(0.0, 1.0).powf(1.0 / f64::from(GRADING));
        let quotient = (1..GRADING).fold(1.0, |quotient, _| 1.0 + s * quotient);
        sum(&self.series[1], 2.0 * s - 1.0) / quotient
    }
}

/// The series of the means of a function from both ends.
fn converged_series(
    function: &dyn Fn(f64) -> f64,
    ends: [f64; 2],
    relative_at: [bool; 2],
    most: usize,
) -> Result<[Vec<f64>; 2], NoSeries> {
    const FEWEST: usize = 16;
    /// Ratio of the last half of the coefficients to the largest one at which the series has
    /// converged: what is left out is then below the rounding of those.
    const CONVERGED: f64 = 1e-15;
    /// Ratio of the function at an end to its largest coefficient.
    const LEAST_AT_ENDS: f64 = 0.1;
    /// Decay of the last half of the coefficients with twice the points that tells of a power at
    /// a singularity: unresolved waves do not decay, and what is smooth decays faster. Twice in
    /// a row it is no accident.
    const ALGEBRAIC: std::ops::Range<f64> = 0.1..0.6;
    /// Decay at a weaker singularity, such as a power 3/2 at an end, where it stays the same; what is
    /// smooth decays by the square of that the next time.
    const STEADY: std::ops::Range<f64> = 0.002..0.1;
    /// Ratio to the largest coefficient below which a decay is that of rounding.
    const ROUNDING: f64 = 1e-13;
    let (mut count, mut before, mut algebraic) = (FEWEST, f64::INFINITY, 0);
    let mut decay_before = 0.0;
    let coefficients = loop {
        let mut coefficients =
            chebyshev_coefficients(function, ends, count).ok_or(NoSeries::Other)?;
        let size = |part: &[f64]| part.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
        let largest = size(&coefficients);
        if size(&coefficients[count / 2..]) <= CONVERGED * largest {
            let small = |(end, relative): (f64, bool)| {
                relative && function(end).abs() < LEAST_AT_ENDS * largest
            };
            if ends.into_iter().zip(relative_at).any(small) {
                return Err(NoSeries::Other);
            }
            coefficients.truncate(count / 2);
            break coefficients;
        }
        let last = size(&coefficients[count / 2..]);
        let decay = last / before;
        algebraic = if ALGEBRAIC.contains(&decay) { algebraic + 1 } else { 0 };
        let steady = [decay, decay_before].iter().all(|decay| STEADY.contains(decay))
            && decay > 0.5 * decay_before
            && last > ROUNDING * largest;
        if algebraic == 2 || steady {
            return Err(NoSeries::Algebraic);
        }
        (count, before, decay_before) = (2 * count, last, decay);
        if count > most {
            return Err(NoSeries::Other);
        }
    };
    let mirrored = coefficients.iter().enumerate();
    let mirrored: Vec<f64> = mirrored.map(|(k, c)| if k % 2 == 1 { -c } else { *c }).collect();
    Ok([mean_series(&mirrored), mean_series(&coefficients)])
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
        let exponential = MeanValues::new(&f64::exp, [first, last], [true; 2], MOST_TERMS)
            .expect("a smooth function");
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
        let waves = MeanValues::new(&|x| 2.0 + (30.0 * x).cos(), [0.0, 3.0], [true; 2], MOST_TERMS)
            .expect("some waves");
        for x in [0.01_f64, 1.0, 2.5] {
            let expected = 2.0 + (30.0 * x).sin() / (30.0 * x);
            assert!((waves.since_first(x) / expected - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn what_does_not_converge_is_left_out() {
        assert!(
            MeanValues::new(&|x| x.abs().sqrt() + 1.0, [-1.0, 1.0], [true; 2], MOST_TERMS)
                .is_none()
        );
        assert!(
            MeanValues::new(&|x| (x - 0.3).recip(), [-1.0, 1.0], [true; 2], MOST_TERMS).is_none()
        );
        let waves = |x: f64| 2.0 + (1000.0 * x).cos();
        assert!(MeanValues::new(&waves, [0.0, 3.0], [true; 2], MOST_TERMS).is_none());
        // Nothing at the end that digits could be relative to.
        let steep = |x: f64| (20.0 * x).exp();
        assert!(MeanValues::new(&steep, [-1.0, 1.0], [true, false], MOST_TERMS).is_none());
        assert!(MeanValues::new(&steep, [-1.0, 1.0], [false, true], MOST_TERMS).is_some());
    }

    /// The mean of x^p over [a, b] is (b^(p+1) - a^(p+1))/((p + 1)(b - a)); in the other direction
    /// the power stands at the other end.
    #[test]
    fn a_power_at_an_end_is_expanded_in_a_root_of_the_distance() {
        for p in [0.1_f64, 1.0 / 3.0, 0.5, 0.7, 1.5] {
            let calls = std::cell::Cell::new(0);
            let power = |x: f64| {
                calls.set(calls.get() + 1);
                x.powf(p) * (1.0 + 0.2 * x)
            };
            let integral = |x: f64| x.powf(p + 1.0) / (p + 1.0) + 0.2 * x.powf(p + 2.0) / (p + 2.0);
            let upwards =
                MeanValues::new(&power, [0.0, 2.0], [false, true], MOST_TERMS).expect("upwards");
            let downwards =
                MeanValues::new(&power, [2.0, 0.0], [true, false], MOST_TERMS).expect("downwards");
            assert_eq!(upwards.power_at(), Some(IntervalEnd::First));
            assert_eq!(downwards.power_at(), Some(IntervalEnd::Last));
            assert!(calls.get() < 720, "{p}: {}", calls.get());
            for x in [1e-6, 1e-3, 0.1, 1.0, 1.9] {
                let above = (integral(2.0) - integral(x)) / (2.0 - x);
                // The difference loses a digit near the end.
                let lost = integral(2.0) / (integral(2.0) - integral(x));
                for found in [upwards.until_last(x), downwards.since_first(x)] {
                    let error = (found / above - 1.0).abs();
                    assert!(error < 2e-15 * (1.0 + lost), "{p} {x}: {found} {above}");
                }
                // From the power on, to the digits of the whole integral.
                for found in [upwards.since_first(x), downwards.until_last(x)] {
                    let error = (found * x - integral(x)).abs();
                    assert!(error < 2e-15 * integral(2.0), "{p} {x}: {error}");
                }
            }
        }
        // At an end where its digits count, a power stays what it is.
        assert!(MeanValues::new(&f64::sqrt, [0.0, 2.0], [true, false], MOST_TERMS).is_none());
    }
}
