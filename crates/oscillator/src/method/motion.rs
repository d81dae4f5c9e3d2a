//! The motion that an answer describes at given values, as a function of time.
//!
//! ```text
//! x(t) = x_e + sum_k (c_k cos(k omega t) + s_k sin(k omega t))
//! ```
//!
//! In: an answer and values of its parameters and amplitude. Out: numbers for `omega`, `c_k`,
//! `s_k`, whatever kind of law the answer has.

use std::fmt;

use super::numbers::{NoNumbers, evaluate};
use crate::decimal::significant;
use crate::exact::Doubles;
use crate::oscillator::Oscillator;
use crate::series::{FourierSeries, terms};
use crate::solution::Solution;
use crate::symbol::Symbol;
use crate::values::Values;

/// A periodic motion in numbers; the displacement contains the equilibrium. Time and displacement
/// have the units of the equation.
///
/// ```
/// # use lindstedt_oscillator as lindstedt;
/// use lindstedt::{Options, Oscillator, solve};
///
/// let solution = solve(&Oscillator::parse("x'' + x + eps*x^3 = 0")?, &Options::default())?;
/// let motion = solution.motion_at(&"eps = 1/10, A = 1".parse()?)?;
/// assert_eq!(motion.to_string(), "x(t) = 0.9971*cos(1.03671*t) + 0.00289062*cos(3.11013*t) + 9.76563e-6*cos(5.18355*t)");
/// assert!((motion.displacement_at(0.0) - 1.0).abs() < 1e-15 && motion.velocity(0.0) == 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Motion {
    /// The letter of the displacement.
    coordinate: Symbol,
    frequency: f64,
    displacement: FourierSeries<Doubles>,
    velocity: FourierSeries<Doubles>,
}

impl Motion {
    /// The angular frequency omega.
    pub fn frequency(&self) -> f64 {
        self.frequency
    }

    /// The displacement at the time `t`; the motion starts at a turning point at `t = 0`.
    pub fn displacement_at(&self, t: f64) -> f64 {
        self.displacement.evaluate(self.frequency * t)
    }

    /// The velocity at the time `t`.
    pub fn velocity(&self, t: f64) -> f64 {
        self.frequency * self.velocity.evaluate(self.frequency * t)
    }

    /// The displacement as a Fourier series in `theta = omega t`.
    pub fn displacement(&self) -> &FourierSeries<Doubles> {
        &self.displacement
    }
}

/// In one line, to six digits; harmonics below rounding are left out.
impl fmt::Display for Motion {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        let coefficients = (0..=self.displacement.highest_harmonic()).flat_map(|k| {
            let part = |series: FourierSeries<Doubles>| series.mean().0;
            let cosine = part(self.displacement.cosine(k));
            let sine = if k == 0 { 0.0 } else { part(self.displacement.sine(k)) };
            [(k, "cos", cosine), (k, "sin", sine)]
        });
        let coefficients: Vec<_> = coefficients.collect();
        let largest = coefficients.iter().fold(0.0, |most: f64, entry| most.max(entry.2.abs()));
        let felt = coefficients.into_iter().filter(|entry| entry.2.abs() > 1e-15 * largest);
        let written = felt.map(|(k, function, value)| {
            let value = significant(value, 6);
            match k {
                0 => value,
                _ => format!("{value}*{function}({}*t)", significant(k as f64 * self.frequency, 6)),
            }
        });
        write!(formatter, "{}(t) = {}", self.coordinate, terms::sum(written))
    }
}

impl Solution {
    /// The motion at these values of the parameters and the amplitude.
    ///
    /// # Errors
    /// [`NoNumbers`].
    pub fn motion_at(&self, values: &Values) -> Result<Motion, NoNumbers> {
        if self.response.is_some() {
            return Err(NoNumbers::Driven);
        }
        let oscillator = Oscillator::from_equation(&self.equation)?;
        let mut needed = self.parameters.clone();
        needed.extend(self.limit_cycle.is_none().then(|| self.amplitude.symbol()));
        needed.retain(|&name| values.get(name).is_none());
        if !needed.is_empty() {
            return Err(NoNumbers::Missing(needed));
        }
        let found = evaluate(&oscillator, self, &values.numbers())?;
        if !(found.frequency_squared > 0.0 && found.frequency_squared.is_finite()) {
            return Err(NoNumbers::not_positive(self));
        }
        let displacement = found.motion.ok_or(NoNumbers::NoMotion)?;
        Ok(Motion {
            coordinate: oscillator.coordinate,
            frequency: found.frequency_squared.sqrt(),
            velocity: displacement.derivative(),
            displacement,
        })
    }

    /// The displacement at the time `t`, at these values of the parameters and the amplitude. For
    /// many times [`Solution::motion_at`] does the work once.
    ///
    /// # Errors
    /// [`NoNumbers`].
    pub fn displacement_at(&self, t: f64, values: &Values) -> Result<f64, NoNumbers> {
        Ok(self.motion_at(values)?.displacement_at(t))
    }
}
