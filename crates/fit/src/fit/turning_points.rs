//! Turning points of a record by local fits, with their standard errors, before any law.
//!
//! An excursion begins where the record leaves a band about its centre and ends where it leaves the band on the other side, so
//! that noise makes no turning points. About the largest value of each, a polynomial of degree 4 (2 where samples are few) is
//! fitted over 0.6 of the half swing; its vertex is the turning point. The centre is a line in time, and
//! a multiple of the square of the amplitude where the spring is not even: it is found from
//! `(y_(i-1) + 2 y_i + y_(i+1))/4` and the search is repeated.

use thiserror::Error;

use crate::fit::polynomial::{LocalPolynomial, median, regression};

pub use crate::fit::spikes::local_noise;

/// A turning point of a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurningPoint {
    /// The time.
    pub time: f64,
    /// The standard error of the time.
    pub time_error: f64,
    /// The value, with the offset of the record in it.
    pub value: f64,
    /// The standard error of the value.
    pub value_error: f64,
    /// Whether it is a maximum.
    pub is_maximum: bool,
    /// The number of half swings since the first turning point.
    pub half_swings: usize,
}

/// A crossing of the centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The time.
    pub time: f64,
    /// The standard error of the time.
    pub time_error: f64,
    /// Whether the record grows there.
    pub is_upwards: bool,
}

/// The turning points of a record, and what was found on the way.
#[derive(Clone, Debug, PartialEq)]
pub struct Swings {
    /// The turning points in the order of time.
    pub points: Vec<TurningPoint>,
    /// The mean duration of a half swing.
    pub half_period: f64,
    /// The standard deviation of the samples about the local polynomials.
    pub noise: f64,
    /// The centre at the middle of the record, its drift per unit of time, and its multiple of the square of the
    /// amplitude.
    pub centre: [f64; 3],
    /// The time to which the centre refers.
    pub middle: f64,
}

/// The reason why a record has no turning points to work with.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SwingsError {
    /// The record has too few half swings above its noise.
    #[error("the record has {found} half swings above its noise; at least {needed} are needed")]
    TooFew {
        /// The number found.
        found: usize,
        /// The number needed.
        needed: usize,
    },
    /// The samples are too far apart.
    #[error("the record has {0:.1} samples in a half swing; at least 5 are needed")]
    TooCoarse(f64),
}

impl SwingsError {
    /// A way forward.
    pub fn help(&self) -> &'static str {
        match self {
            Self::TooFew { .. } => {
                "record for longer, from a larger displacement, or filter noise of high frequency; if the \
                 body creeps back without swinging, no law of vibration can be found from it"
            }
            Self::TooCoarse(_) => "sample at ten times the frequency of the vibration or faster",
        }
    }
}

/// The least number of half swings.
const FEWEST: usize = 5;

impl Swings {
    /// Finds the turning points of a record with increasing times.
    ///
    /// # Errors
    /// [`SwingsError`].
    ///
    /// ```
    /// use lindstedt_fit::fit::turning_points::Swings;
    ///
    /// let times: Vec<f64> = (0..2000).map(|index| 0.01 * f64::from(index)).collect();
    /// let values: Vec<f64> = times.iter().map(|t| 0.2 + (3.0 * t).cos()).collect();
    /// let swings = Swings::find(&times, &values)?;
    /// // The polynomials are no cosines, and fit them to some 1e-6 of their period.
    /// assert!((swings.half_period - std::f64::consts::PI / 3.0).abs() < 1e-5);
    /// assert!((swings.points[2].value + 0.8).abs() < 1e-4);
    /// # Ok::<(), lindstedt_fit::fit::turning_points::SwingsError>(())
    /// ```
    pub fn find(times: &[f64], values: &[f64]) -> Result<Self, SwingsError> {
        const PASSES: usize = 3;
        let noise = local_noise(times, values);
        let none = SwingsError::TooFew { found: 0, needed: FEWEST };
        let (Some(first), Some(last)) = (times.first(), times.last()) else { return Err(none) };
        let middle = 0.5 * (first + last);
        let level = median(values.to_vec());
        let mut centre = vec![level; times.len()];
        let mut found = None;
        for _ in 0..PASSES {
            let swings = Self::about(times, values, &centre, noise, middle)?;
            // Beyond the turning points the amplitude is that of the nearest one.
            let amplitudes = swings.amplitudes();
            centre = times
                .iter()
                .map(|time| {
                    let next = swings.points.partition_point(|point| point.time < *time);
                    let nearest = amplitudes[next.min(amplitudes.len() - 1)];
                    swings.centre_at(*time, nearest)
                })
                .collect();
            found = Some(swings);
        }
        found.ok_or(none)
    }

    /// The amplitude about each turning point: half the distance from its neighbours.
    pub fn amplitudes(&self) -> Vec<f64> {
        let value = |index: usize| self.points[index].value;
        let count = self.points.len();
        (0..count)
            .map(|index| {
                let neighbours = match index {
                    0 => value(1.min(count - 1)),
                    _ if index + 1 == count => value(index - 1),
                    _ => 0.5 * (value(index - 1) + value(index + 1)),
                };
                0.5 * (value(index) - neighbours).abs()
            })
            .collect()
    }

    /// The crossings of the centre between neighbouring turning points of this record: zeros of cubics, or lines where samples are
    /// few, through a half of the time between them.
    pub fn crossings(&self, times: &[f64], values: &[f64]) -> Vec<Crossing> {
        const DEGREES: [(usize, usize); 2] = [(3, 6), (1, 4)];
        let amplitudes = self.amplitudes();
        let pairs = self.points.windows(2).zip(amplitudes.windows(2));
        let crossing = |(pair, sizes): (&[TurningPoint], &[f64])| {
            let [before, after] = [pair[0], pair[1]];
            if after.half_swings != before.half_swings + 1 {
                return None;
            }
            let amplitude = 0.5 * (sizes[0] + sizes[1]);
            let width = 0.25 * (after.time - before.time);
            let mut guess = 0.5 * (before.time + after.time);
            let mut error = None;
            // The crossing of a swing with friction, or of one that is not even, lies beside the middle.
            for _ in 0..2 {
                let from = times.partition_point(|time| *time < guess - width);
                let to = times.partition_point(|time| *time <= guess + width);
                let (degree, _) = DEGREES.into_iter().find(|(_, fewest)| to - from >= *fewest)?;
                let centred: Vec<f64> = (from..to)
                    .map(|index| values[index] - self.centre_at(times[index], amplitude))
                    .collect();
                let fit = LocalPolynomial::fit(&times[from..to], &centred, guess, width, degree)?;
                let zero = fit.zero(0)?;
                (guess, error) = (zero.0, Some(zero.1));
            }
            let time_error = error? * self.noise;
            Some(Crossing { time: guess, time_error, is_upwards: after.is_maximum })
        };
        pairs.filter_map(crossing).collect()
    }

    /// The centre of the swings at a time with this amplitude.
    pub fn centre_at(&self, time: f64, amplitude: f64) -> f64 {
        let [level, drift, shift] = self.centre;
        level + drift * (time - self.middle) + shift * amplitude * amplitude
    }

    fn about(
        times: &[f64],
        values: &[f64],
        centre: &[f64],
        noise: f64,
        middle: f64,
    ) -> Result<Self, SwingsError> {
        let peaks = excursions(values, centre, noise);
        let few = |found: usize| SwingsError::TooFew { found, needed: FEWEST };
        if peaks.len() < FEWEST {
            return Err(few(peaks.len()));
        }
        let distances = peaks.windows(2).map(|pair| times[pair[1].0] - times[pair[0].0]);
        let half_period = median(distances.collect());
        let steps = times.windows(2).map(|pair| pair[1] - pair[0]);
        let samples = half_period / median(steps.collect());
        if samples < 4.5 {
            return Err(SwingsError::TooCoarse(samples));
        }
        let fits = peaks.iter().filter_map(|(peak, is_maximum)| {
            let fit = vertex(times, values, times[*peak], half_period)?;
            Some((fit, *is_maximum))
        });
        let fits: Vec<_> = fits.collect();
        let deviations =
            fits.iter().map(|((fit, _), _)| (fit.residual_square / fit.freedom as f64).sqrt());
        let deviation = median(deviations.collect());
        let mut points: Vec<TurningPoint> = vec![];
        for ((fit, (time, error)), is_maximum) in &fits {
            let is_top = fit.derivative(*time, 2).0 < 0.0;
            if is_top != *is_maximum || points.last().is_some_and(|last| last.time >= *time) {
                continue;
            }
            let (value, value_error) = fit.derivative(*time, 0);
            let (mut half_swings, mut before) = (0, *time);
            if let Some(last) = points.last() {
                (half_swings, before) = (last.half_swings, last.time);
            }
            // Turning points that were lost in gaps are counted: maxima and minima take turns.
            let passed = ((time - before) / half_period).round() as usize;
            let has_changed = points.last().is_some_and(|last| last.is_maximum != *is_maximum);
            let parity = usize::from(has_changed);
            let passed = if passed % 2 == parity { passed } else { passed + 1 };
            points.push(TurningPoint {
                time: *time,
                time_error: error * deviation,
                value,
                value_error: value_error * deviation,
                is_maximum: *is_maximum,
                half_swings: half_swings + passed,
            });
        }
        if points.len() < FEWEST {
            return Err(few(points.len()));
        }
        let mut swings = Self { points, half_period, noise: deviation, centre: [0.0; 3], middle };
        let (first, last) = (swings.points[0], swings.points[swings.points.len() - 1]);
        let count = (last.half_swings - first.half_swings).max(1);
        swings.half_period = (last.time - first.time) / count as f64;
        swings.centre = swings.find_centre();
        Ok(swings)
    }

    /// The centre as a line in time and a multiple of the square of the amplitude.
    fn find_centre(&self) -> [f64; 3] {
        let amplitudes = self.amplitudes();
        let (mut one, mut time, mut square, mut means) = (vec![], vec![], vec![], vec![]);
        for (three, amplitude) in self.points.windows(3).zip(&amplitudes[1..]) {
            if three[2].half_swings != three[0].half_swings + 2 {
                continue;
            }
            one.push(1.0);
            time.push(three[1].time - self.middle);
            square.push(amplitude * amplitude);
            means.push(0.25 * (three[0].value + 2.0 * three[1].value + three[2].value));
        }
        let level = median(means.clone());
        let weights = vec![1.0; means.len()];
        // With few points the square of the amplitude cannot be told from a drift.
        let columns = [one, time, square];
        let used = match means.len() {
            0..=3 => 1,
            4..=9 => 2,
            _ => 3,
        };
        let found = regression(&columns[..used], &means, &weights);
        let mut centre = [if level.is_finite() { level } else { 0.0 }, 0.0, 0.0];
        if let Some((coefficients, _)) = found {
            centre[..used].copy_from_slice(&coefficients);
        }
        centre
    }
}

/// The sample with the largest deviation of each excursion, and whether it lies above the centre.
fn excursions(values: &[f64], centre: &[f64], noise: f64) -> Vec<(usize, bool)> {
    const BAND: f64 = 5.0;
    let deviations = values.iter().zip(centre).map(|(value, centre)| value - centre);
    let deviations: Vec<f64> = deviations.collect();
    let largest = deviations.iter().fold(0.0_f64, |largest, own| largest.max(own.abs()));
    let band = (BAND * noise).max(1e-3 * largest);
    let mut peaks: Vec<(usize, bool)> = vec![];
    for (index, deviation) in deviations.iter().enumerate() {
        if deviation.abs() <= band {
            continue;
        }
        let is_above = *deviation > 0.0;
        match peaks.last_mut() {
            Some((peak, above)) if *above == is_above => {
                if deviation.abs() > deviations[*peak].abs() {
                    *peak = index;
                }
            }
            _ => peaks.push((index, is_above)),
        }
    }
    // The record may begin or end within an excursion, whose largest value is then no turning point.
    let is_inside = |(peak, _): &(usize, bool)| *peak > 1 && *peak + 2 < values.len();
    peaks.retain(is_inside);
    peaks
}

/// The polynomial about a turning point, with the time of its vertex and the error of the time.
fn vertex(
    times: &[f64],
    values: &[f64],
    guess: f64,
    half_period: f64,
) -> Option<(LocalPolynomial, (f64, f64))> {
    const WIDTHS: [(f64, usize, usize); 2] = [(0.3, 4, 9), (0.3, 2, 4)];
    let mut centre = guess;
    let mut found = None;
    for _ in 0..2 {
        for (share, degree, fewest) in WIDTHS {
            let width = share * half_period;
            let from = times.partition_point(|time| *time < centre - width);
            let to = times.partition_point(|time| *time <= centre + width);
            if to - from < fewest {
                continue;
            }
            // One side alone does not fix a vertex.
            let split = times.partition_point(|time| *time < centre);
            if split - from < 2 || to - split < 2 {
                return found;
            }
            let (times, values) = (&times[from..to], &values[from..to]);
            let fit = LocalPolynomial::fit(times, values, centre, width, degree)?;
            let Some(zero) = fit.zero(1) else { continue };
            centre = zero.0;
            found = Some((fit, zero));
            break;
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crossings_lie_where_the_record_passes_its_centre() {
        let times: Vec<f64> = (0..2000).map(|index| 0.02 * f64::from(index)).collect();
        let ripple = |t: f64| 1e-3 * (1e4 * t * t).sin();
        let values: Vec<f64> =
            times.iter().map(|t| 0.5 + (-0.02 * t).exp() * (2.0 * t).sin() + ripple(*t)).collect();
        let swings = Swings::find(&times, &values).unwrap();
        let crossings = swings.crossings(&times, &values);
        assert_eq!(crossings.len() + 1, swings.points.len());
        for (place, own) in crossings.iter().enumerate() {
            // The first turning point is a maximum: the first crossing leads down.
            let exact = std::f64::consts::FRAC_PI_2 * (place + 1) as f64;
            assert!((own.time - exact).abs() < 5.0 * own.time_error + 1e-4, "{own:?} {exact}");
            assert!(own.time_error < 1e-3 && own.is_upwards == (place % 2 == 1), "{own:?}");
        }
    }

    #[test]
    fn a_gap_is_counted_and_a_short_record_refused() {
        let times: Vec<f64> = (0..3000)
            .map(|index| 0.01 * f64::from(index))
            .filter(|time| !(10.0..14.5).contains(time))
            .collect();
        let values: Vec<f64> =
            times.iter().map(|t| 0.1 * t + (-0.02 * t).exp() * (2.0 * t).sin()).collect();
        let swings = Swings::find(&times, &values).unwrap();
        let last = swings.points.last().unwrap();
        let expected = (last.time - swings.points[0].time) / std::f64::consts::FRAC_PI_2;
        assert_eq!(last.half_swings, expected.round() as usize);
        assert!((swings.centre[1] - 0.1).abs() < 2e-3, "{:?}", swings.centre);
        let error = Swings::find(&times[..400], &values[..400]).unwrap_err();
        assert!(matches!(error, SwingsError::TooFew { .. }), "{error}");
    }
}
