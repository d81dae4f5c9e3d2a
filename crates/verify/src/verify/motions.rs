//! The motion by a formula and the true one, sampled over a period.

use std::collections::BTreeMap;

use super::formula::formula_motion;
use super::orbit::{SAMPLES, TrueMotion};
use super::values::numbers_of_motion;
use super::{
    VerificationError, check_common_period, driven, in_another_coordinate, in_time, meant_motion,
    off_cycle, on_cycle, orbit_target, transient,
};
use crate::oscillator::Oscillator;
use crate::solution::Solution;
use crate::symbol::Symbol;
use crate::values::Values;

/// Time, displacement and velocity, in the units of the equation.
pub type TimedState = (f64, f64, f64);

/// The motion by the formula and the true one, at the same instants of one true period.
pub struct Motions {
    /// The motion by the formula.
    pub formula: Vec<TimedState>,
    /// The true motion by Runge-Kutta.
    pub truth: Vec<TimedState>,
    /// Motions whose amplitude changes: times and positions of the two envelopes of the formula.
    pub envelope: Option<[Vec<(f64, f64)>; 2]>,
}

/// The motion by the formula and the true one, at the same instants of one true period, or as long
/// as a motion that is not periodic is judged; `None` where the formula's frequency is not real.
///
/// # Errors
/// As for [`judge`](super::judge).
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::{Options, Oscillator, solve, verify::motions};
///
/// let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
/// let solution = solve(&pendulum, &Options::default())?;
/// let sampled = motions(&pendulum, &solution, &"A = 1/10".parse()?)?.ok_or("no real frequency")?;
/// let pairs = sampled.formula.iter().zip(&sampled.truth);
/// assert!(pairs.map(|(formula, truth)| (formula.1 - truth.1).abs()).all(|difference| difference < 1e-5));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn motions(
    oscillator: &Oscillator,
    solution: &Solution,
    at: &Values,
) -> Result<Option<Motions>, VerificationError> {
    if let Some(relative) = in_another_coordinate(oscillator, solution)? {
        return motions(&relative, solution, at);
    }
    if let Some(motion) = solution.in_time() {
        return in_time::motions(oscillator, solution, motion, at).map(Some);
    }
    if let Some(response) = &solution.response {
        check_common_period(solution)?;
        return driven::motions(oscillator, solution, response, at);
    }
    if let Some(moving) = off_cycle(solution, at) {
        return motions(oscillator, &moving, at);
    }
    let numbers = numbers_of_motion(solution, at);
    let settled = on_cycle(solution, at);
    if let (Some(slow), None) = (solution.slow(), &settled) {
        return transient::motions(oscillator, solution, slow, &numbers).map(Some);
    }
    let solution = settled.as_ref().unwrap_or(solution);
    let truth = true_path(oscillator, solution, &numbers)?;
    let Some((frequency, motion)) = formula_motion(oscillator, solution, &numbers) else {
        return Ok(None);
    };
    let velocity = motion.derivative();
    let formula =
        |t: f64| (t, motion.evaluate(frequency * t), frequency * velocity.evaluate(frequency * t));
    Ok(Some(Motions {
        formula: instants(&truth).map(formula).collect(),
        truth: samples_of(&truth),
        envelope: None,
    }))
}

/// The true motion that an answer is about, over one period, whether its formula has a value there
/// or not; the answer is one of a periodic motion without a drive.
///
/// # Errors
/// As for [`judge`](super::judge).
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::{Options, Oscillator, solve, verify::true_motion};
///
/// let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
/// let solution = solve(&pendulum, &Options { order: Some(2), ..Options::default() })?;
/// // omega^2 = 1 - A^2/8 is negative there.
/// let samples = true_motion(&pendulum, &solution, &"A = 3".parse()?)?;
/// assert!(samples.last().is_some_and(|(period, ..)| (period - 16.155).abs() < 1e-3));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn true_motion(
    oscillator: &Oscillator,
    solution: &Solution,
    at: &Values,
) -> Result<Vec<TimedState>, VerificationError> {
    let numbers = numbers_of_motion(solution, at);
    let settled = on_cycle(solution, at);
    let solution = settled.as_ref().unwrap_or(solution);
    true_path(oscillator, solution, &numbers).map(|truth| samples_of(&truth))
}

/// The true motion, with its path.
fn true_path(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Result<TrueMotion, VerificationError> {
    let meant = orbit_target(oscillator, solution, numbers);
    let truth = meant_motion(oscillator, solution, &meant, numbers)?;
    match truth.has_path() {
        true => Ok(truth),
        false => Err(VerificationError::NoPath),
    }
}

/// The instants at which a motion is sampled, over one period.
fn instants(truth: &TrueMotion) -> impl Iterator<Item = f64> {
    let period = truth.period();
    (0..=SAMPLES).map(move |k| period * k as f64 / SAMPLES as f64)
}

fn samples_of(truth: &TrueMotion) -> Vec<TimedState> {
    instants(truth).map(|t| truth.sample(t)).collect()
}
