//! A quantity over a period of an orbit: its harmonics and its peak.
//!
//! ```text
//! a_k = 2/T int_0^T f cos(k omega t) dt,   b_k = 2/T int_0^T f sin(k omega t) dt
//! ```
//!
//! The integrals of a smooth motion are sums over equal steps, which are exact to rounding for the harmonics that are kept. A motion
//! with jumps or corners is integrated from one to the next by the rule of Gauss and Legendre, and its extremes may be at them.

use std::f64::consts::TAU;

use super::judged::OrbitPath;
use crate::numeric::harmonics::{Harmonics, Transform};
use crate::numeric::ode::quadrature::gauss_points;

/// Number of samples of a period in equal steps.
pub(super) const SAMPLES: usize = 256;

/// A quantity over a period.
pub(super) struct Wave {
    /// The coefficients of cos(k theta) and sin(k theta), from k = 0, the mean.
    pub(super) harmonics: Vec<[f64; 2]>,
    /// Half of the way from the lowest to the highest value.
    pub(super) peak: f64,
}

/// The states of a motion at instants of its period.
pub(super) struct PeriodSamples {
    period: f64,
    times: Vec<f64>,
    /// The weights of the integral over the period; `None` for equal steps.
    weights: Option<Vec<f64>>,
    /// The states, in a column each.
    columns: Vec<Vec<f64>>,
    /// The states on both sides of jumps and corners.
    sides: Vec<Vec<f64>>,
}

impl PeriodSamples {
    /// The instants of equal steps.
    pub(super) fn equal_times(period: f64) -> Vec<f64> {
        (0..SAMPLES).map(|index| period * index as f64 / SAMPLES as f64).collect()
    }

    /// The states in columns at these instants.
    pub(super) fn equal(period: f64, columns: Vec<Vec<f64>>) -> Self {
        Self { period, times: Self::equal_times(period), weights: None, columns, sides: vec![] }
    }

    /// The samples of a path; `None` if it does not reach the end of the period.
    pub(super) fn of_path(path: &OrbitPath, period: f64) -> Option<Self> {
        /// Length of a stretch between two breaks, in the period, below which it counts as none.
        const SHORTEST: f64 = 1e-12;
        /// Number of panels that a period without breaks would have.
        const PANELS: f64 = 12.0;
        let states = path.states_at(0.0)?.len();
        let breaks = path.breaks(period);
        let (times, weights) = match breaks.is_empty() {
            true => (Self::equal_times(period), None),
            false => {
                let inner = breaks.iter().map(|(time, _)| *time);
                let ends: Vec<f64> = [0.0].into_iter().chain(inner).chain([period]).collect();
                let mut points: Vec<[f64; 2]> = Vec::new();
                for pair in ends.windows(2) {
                    let length = pair[1] - pair[0];
                    if length <= SHORTEST * period {
                        continue;
                    }
                    let count = (PANELS * length / period).ceil();
                    for panel in 0..count as usize {
                        let place = |index: usize| pair[0] + length * index as f64 / count;
                        points.extend(gauss_points(place(panel), place(panel + 1)));
                    }
                }
                let times = points.iter().map(|point| point[0]).collect();
                (times, Some(points.iter().map(|point| point[1]).collect()))
            }
        };
        let mut columns = vec![Vec::with_capacity(times.len()); states];
        path.sample(&times, &mut columns);
        let sides = breaks.into_iter().flat_map(|(_, sides)| sides).collect();
        let is_whole = columns.iter().all(|column| column.len() == times.len());
        is_whole.then_some(Self { period, times, weights, columns, sides })
    }

    /// A quantity of the states over the period, with its harmonics up to this one.
    pub(super) fn wave(
        &self,
        path: Option<&OrbitPath>,
        highest: usize,
        transform: &Transform,
        quantity: impl Fn(&[f64]) -> f64,
    ) -> Wave {
        let at = |index: usize| -> Vec<f64> {
            self.columns.iter().map(|column| column[index]).collect()
        };
        let values: Vec<f64> = (0..self.times.len()).map(|index| quantity(&at(index))).collect();
        let Harmonics { cosines, sines } = match &self.weights {
            None => transform.harmonics(&values, highest),
            Some(weights) => self.integrated(&values, weights, highest),
        };
        let pairs = cosines.iter().zip(&sines).enumerate();
        let harmonics = pairs.map(|(index, (cosine, sine))| match index {
            0 => [0.5 * cosine, 0.0],
            _ => [*cosine, *sine],
        });
        let value = |time: f64| {
            let states = path.and_then(|path| path.states_at(time.rem_euclid(self.period)));
            states.map_or(f64::NAN, |states| quantity(&states))
        };
        let extreme = |sign: f64| {
            let inside = self.extreme(sign, &values, value);
            let sides = self.sides.iter().map(|states| quantity(states));
            sides.fold(inside, |best, side| if sign * side > sign * best { side } else { best })
        };
        Wave { harmonics: harmonics.collect(), peak: 0.5 * (extreme(1.0) - extreme(-1.0)) }
    }

    /// The harmonics of values at the instants, by their weights.
    fn integrated(&self, values: &[f64], weights: &[f64], highest: usize) -> Harmonics {
        let factor = 2.0 / self.period;
        let (cosines, sines) = (0..=highest)
            .map(|harmonic| {
                let rate = harmonic as f64 * TAU / self.period;
                let terms = self.times.iter().zip(values.iter().zip(weights));
                terms.fold((0.0, 0.0), |(cosine, sine), (time, (value, weight))| {
                    let (s, c) = (rate * time).sin_cos();
                    (cosine + factor * weight * value * c, sine + factor * weight * value * s)
                })
            })
            .unzip();
        Harmonics { cosines, sines }
    }

    /// The highest value near the highest sample for a sign of 1, the lowest for -1: by parabolas through three
    /// points; where one has its vertex lower than a point, as beside a jump of the force at the turn, from the
    /// highest of them.
    fn extreme(&self, sign: f64, values: &[f64], value: impl Fn(f64) -> f64) -> f64 {
        const PARABOLAS: usize = 3;
        const MOST_TRIALS: usize = 30;
        let highest = (0..values.len())
            .max_by(|one, other| (sign * values[*one]).total_cmp(&(sign * values[*other])))
            .unwrap_or(0);
        let (mut middle, mut width) = (self.times[highest], self.period / SAMPLES as f64);
        let mut best = values[highest];
        let mut parabolas = 0;
        for _ in 0..MOST_TRIALS {
            let [left, right] = [middle - width, middle + width].map(&value);
            let curve = left - 2.0 * best + right;
            let shift = if curve == 0.0 { 0.0 } else { 0.5 * width * (left - right) / curve };
            let there = if shift.abs() <= width { value(middle + shift) } else { f64::NAN };
            if sign * there >= sign * best {
                (middle, best, width) = (middle + shift, there, 0.1 * width);
                parabolas += 1;
                if parabolas == PARABOLAS {
                    break;
                }
                continue;
            }
            for (side, there) in [(-width, left), (width, right)] {
                if sign * there > sign * best {
                    (middle, best) = (middle + side, there);
                }
            }
            width *= 0.5;
        }
        best
    }
}
