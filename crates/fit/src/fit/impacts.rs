//! Restitution from the times between impacts of a bouncing body.
//!
//! ```text
//! t_(n+1) = t_n + 2 v_n/g,   v_(n+1) = e(v_n) v_n            v_n: speed after impact n, g: gravity
//! e constant, or e(lambda v) of Hunt and Crossley: k d^n (1 + lambda d')
//! ```
//!
//! The duration of a contact is left out: it must be short against a flight. The errors of the times are equal
//! and found from the residuals if they are not given.

use lindstedt_impact::impact::contact::hunt_crossley::{damping_for, restitution};
use nalgebra::{DMatrix, DVector};
use thiserror::Error;

use crate::fit::answer::Estimate;
use crate::fit::least_squares::{Covariance, minimise};
use crate::fit::polynomial::median;

/// The dependence of the coefficient of restitution on the speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RestitutionLaw {
    /// A constant: the parameter is `e`.
    Constant,
    /// A contact of Hunt and Crossley: the parameter is `lambda`, in units of a reciprocal speed.
    HuntCrossley,
}

impl RestitutionLaw {
    /// The name in answers.
    pub fn name(self) -> &'static str {
        match self {
            Self::Constant => "constant restitution",
            Self::HuntCrossley => "Hunt-Crossley contact",
        }
    }

    fn restitution(self, parameter: f64, speed: f64) -> Option<f64> {
        match self {
            Self::Constant => Some(parameter),
            Self::HuntCrossley => restitution(parameter * speed).ok(),
        }
    }
}

/// A law of restitution fitted to times of impacts.
#[derive(Clone, Debug, PartialEq)]
pub struct ImpactFit {
    /// The law.
    pub law: RestitutionLaw,
    /// The parameter of the law, then the speed after the first impact and the time of the first impact.
    pub estimates: Vec<Estimate>,
    /// Chi-square per degree of freedom.
    pub chi_square: f64,
    /// The increase of chi-square over that of the best law.
    pub excess: f64,
}

impl ImpactFit {
    /// The coefficient of restitution at a speed of approach.
    pub fn restitution(&self, speed: f64) -> Option<f64> {
        self.law.restitution(self.estimates.first()?.value, speed)
    }
}

/// The restitution of one impact, as measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredRestitution {
    /// The speed of approach.
    pub speed: f64,
    /// The coefficient of restitution: the ratio of two flights.
    pub value: f64,
    /// Its standard error.
    pub error: f64,
}

/// The answer for times of impacts.
#[derive(Clone, Debug, PartialEq)]
pub struct ImpactAnswer {
    /// The laws, the best first.
    pub laws: Vec<ImpactFit>,
    /// The restitution of each impact against its speed.
    pub measured: Vec<MeasuredRestitution>,
    /// The standard error of a time, as given or found.
    pub noise: f64,
}

/// The reason why times of impacts have no law.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ImpactsError {
    /// There are too few impacts.
    #[error("there are {0} impacts; at least 5 are needed")]
    TooFew(usize),
    /// A time is not later than the one before.
    #[error("impact {0}, counted from 1, is not later than the one before")]
    Order(usize),
    /// A flight lasts longer than the one before.
    #[error("the flight after impact {0}, counted from 1, lasts longer than the one before")]
    Longer(usize),
    /// Gravity or the error of a time is not a positive number.
    #[error("gravity and the error of a time must be positive numbers")]
    NotPositive,
    /// No law could be fitted.
    #[error("no law of restitution could be fitted")]
    NoFit,
}

impl ImpactsError {
    /// A way forward.
    pub fn help(&self) -> &'static str {
        match self {
            Self::TooFew(_) => "drop the body from higher, so that it bounces more often",
            Self::Order(_) => "sort the times, and list each impact once",
            Self::Longer(_) => {
                "an impact may be missing before it, or the body was pushed: use the times on one side of it"
            }
            Self::NotPositive => {
                "give gravity in the units of the times, such as 9.81 for metres and seconds"
            }
            Self::NoFit => "look for missing or doubled impacts among the times",
        }
    }
}

/// Fits laws of restitution to the times of the impacts of a body that bounces under gravity.
///
/// # Errors
/// [`ImpactsError`].
///
/// ```
/// use lindstedt_fit::fit::impacts::{RestitutionLaw, fit_impacts};
///
/// let mut times = vec![0.0];
/// let mut flight = 0.8;
/// for _ in 0..8 {
///     times.push(times[times.len() - 1] + flight);
///     flight *= 0.9;
/// }
/// let answer = fit_impacts(&times, 9.81, Some(1e-4))?;
/// assert_eq!(answer.laws[0].law, RestitutionLaw::Constant);
/// assert!((answer.laws[0].estimates[0].value - 0.9).abs() < 1e-6);
/// # Ok::<(), lindstedt_fit::fit::impacts::ImpactsError>(())
/// ```
pub fn fit_impacts(
    times: &[f64],
    gravity: f64,
    noise: Option<f64>,
) -> Result<ImpactAnswer, ImpactsError> {
    const FEWEST: usize = 5;
    const ITERATIONS: u64 = 100;
    if times.len() < FEWEST {
        return Err(ImpactsError::TooFew(times.len()));
    }
    let is_positive = |value: f64| value.is_finite() && value > 0.0;
    if !is_positive(gravity) || !noise.is_none_or(is_positive) {
        return Err(ImpactsError::NotPositive);
    }
    if let Some(place) =
        times.windows(2).position(|pair| pair[1].is_nan() || pair[0].is_nan() || pair[1] <= pair[0])
    {
        return Err(ImpactsError::Order(place + 2));
    }
    let flights: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if let Some(place) = flights.windows(2).position(|pair| pair[1] > 1.1 * pair[0]) {
        return Err(ImpactsError::Longer(place + 2));
    }
    let ratios = flights.windows(2).map(|pair| pair[1] / pair[0]);
    let ratio = median(ratios.clone().collect());
    let speed = 0.5 * gravity * flights[0];
    let laws = [RestitutionLaw::Constant, RestitutionLaw::HuntCrossley];
    let fits = laws.iter().filter_map(|law| {
        let usual = 0.5 * gravity * median(flights.clone());
        let first = match law {
            RestitutionLaw::Constant => ratio,
            RestitutionLaw::HuntCrossley => damping_for(ratio.min(0.999)).ok()? / usual,
        };
        let residuals = |values: &[f64]| -> Option<DVector<f64>> {
            let [parameter, mut speed, mut time] = *values else { return None };
            let mut residuals = DVector::zeros(times.len());
            for (index, measured) in times.iter().enumerate() {
                residuals[index] = measured - time;
                time += 2.0 * speed / gravity;
                speed *= law.restitution(parameter, speed)?;
            }
            Some(residuals)
        };
        let linearised = |values: &[f64]| {
            const STEP: f64 = 1e-6;
            let scales = [first, speed, flights[0]];
            let at = residuals(values)?;
            let mut jacobian = DMatrix::zeros(at.len(), values.len());
            for (column, scale) in scales.iter().enumerate() {
                let [mut above, mut below] = [values.to_vec(), values.to_vec()];
                above[column] += STEP * scale;
                below[column] -= STEP * scale;
                let slope = (residuals(&above)? - residuals(&below)?) / (2.0 * STEP * scale);
                jacobian.set_column(column, &slope);
            }
            Some((at, jacobian))
        };
        minimise(&[first, speed, times[0]], ITERATIONS, linearised).map(|fit| (*law, fit))
    });
    let mut fits: Vec<_> = fits.collect();
    // The laws have as many parameters, so that any criterion orders them by their squares.
    fits.sort_by(|one, other| one.1.square().total_cmp(&other.1.square()));
    let least = fits.first().ok_or(ImpactsError::NoFit)?.1.square();
    let freedom = (times.len() - 3) as f64;
    let rounding = 1e-15 * times[times.len() - 1].abs().max(flights[0]);
    let noise = noise.unwrap_or((least / freedom).sqrt().max(rounding));
    let laws = fits.iter().map(|(law, fit)| {
        let covariance = Covariance::new(&fit.jacobian).matrix * (noise * noise);
        let parameter = match law {
            RestitutionLaw::Constant => "e",
            RestitutionLaw::HuntCrossley => "lambda",
        };
        let names = [parameter, "v0", "t0"];
        let estimates =
            names.iter().zip(&fit.parameters).enumerate().map(|(index, (name, value))| Estimate {
                name: (*name).to_owned(),
                value: *value,
                error: covariance[(index, index)].sqrt(),
            });
        ImpactFit {
            law: *law,
            estimates: estimates.collect(),
            chi_square: fit.square() / (noise * noise) / freedom,
            excess: (fit.square() - least) / (noise * noise),
        }
    });
    let measured = flights.windows(2).map(|pair| {
        let value = pair[1] / pair[0];
        // Three times enter: the middle one with the opposite sign in both flights.
        let error = noise / pair[0] * (1.0 + value * value + (1.0 + value).powi(2)).sqrt();
        MeasuredRestitution { speed: 0.5 * gravity * pair[0], value, error }
    });
    Ok(ImpactAnswer { laws: laws.collect(), measured: measured.collect(), noise })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    /// Times of impacts with this law and uniform errors of this size.
    fn bounces(law: RestitutionLaw, parameter: f64, size: f64, seed: u64) -> Vec<f64> {
        let mut generator = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
        let (mut time, mut speed) = (0.3, 4.0);
        let mut times = vec![];
        for _ in 0..20 {
            times.push(time + size * (generator.random::<f64>() - 0.5));
            time += 2.0 * speed / 9.81;
            speed *= law.restitution(parameter, speed).unwrap();
        }
        times
    }

    #[test]
    fn restitution_and_damping_are_found_within_two_percent() {
        for (law, parameter) in
            [(RestitutionLaw::Constant, 0.85), (RestitutionLaw::HuntCrossley, 0.12)]
        {
            for seed in 0..20 {
                let answer = fit_impacts(&bounces(law, parameter, 1e-3, seed), 9.81, None).unwrap();
                let best = &answer.laws[0];
                assert_eq!(best.law, law, "{answer:?}");
                let Estimate { value, error, .. } = best.estimates[0];
                assert!((value / parameter - 1.0).abs() < 0.02, "{value} {parameter}");
                assert!((value - parameter).abs() < 4.0 * error, "{value} ({error}) {parameter}");
                assert!(answer.laws[1].excess > 100.0, "{:?}", answer.laws[1]);
            }
        }
    }

    #[test]
    fn mistakes_are_named() {
        let mut times = bounces(RestitutionLaw::Constant, 0.9, 0.0, 1);
        assert_eq!(fit_impacts(&times[..4], 9.81, None).unwrap_err(), ImpactsError::TooFew(4));
        assert_eq!(fit_impacts(&times, 0.0, None).unwrap_err(), ImpactsError::NotPositive);
        times.remove(6);
        assert_eq!(fit_impacts(&times, 9.81, None).unwrap_err(), ImpactsError::Longer(6));
        times.swap(2, 3);
        assert_eq!(fit_impacts(&times, 9.81, None).unwrap_err(), ImpactsError::Order(4));
    }
}
