//! Verification of a motion that is known as a function of time, by integration of the equation as
//! it was typed from the same start.
//!
//! ```text
//! x(0) = A, x'(0) = 0:   max_deviation = max |x_formula(t) - x_true(t)|/max |x_true - x_eq|
//! ```
//!
//! If no amplitude is given, a free motion begins at A = 1, and a driven one at rest in the
//! equilibrium.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use super::validity::Range;
use super::values::checked_numbers;
use super::{Motions, TimedState, Verdict, Verification, VerificationError};
use crate::decimal::decimal;
use crate::exact::rational::from_f64;
use crate::expr::{CompiledFunction, Expr};
use crate::method::numbers::symbol_values;
use crate::numeric::ode::{IntegrationOptions, State, integrate};
use crate::oscillator::Oscillator;
use crate::solution::{AmplitudeConvention, Solution};
use crate::symbol::Symbol;
use crate::symbol::letters::AMPLITUDE;
use crate::values::Values;

/// Number of periods of the slowest component that are followed, and of the fastest one at most.
const PERIODS: [f64; 2] = [10.0, 200.0];
const SAMPLES: usize = 4096;

/// The formula and the true motion at the same instants.
struct SampledMotions {
    formula: Vec<TimedState>,
    truth: Vec<TimedState>,
    numbers: BTreeMap<Symbol, f64>,
    /// The angular frequencies of the drives.
    drives: Vec<f64>,
    equilibrium: f64,
    /// The root mean square residual of the formula in the equation, over that of the force.
    residual: f64,
}

impl SampledMotions {
    fn new(
        oscillator: &Oscillator,
        solution: &Solution,
        motion: &Expr,
        at: &Values,
    ) -> Result<Self, VerificationError> {
        let mut numbers = checked_numbers(solution, at)?;
        let start = AmplitudeConvention::Initial.symbol();
        let t = Symbol::new("t");
        if at.get(start).is_none() && oscillator.force.contains(t) {
            numbers.insert(start, 0.0);
        }
        let value_of = |name: Symbol| numbers.get(&name).copied();
        let defined = solution
            .defined_values(&value_of)
            .map_err(|name| VerificationError::Missing(vec![name]))?;
        let known = numbers.iter().map(|(name, value)| (*name, *value)).chain(defined);
        let exact: BTreeMap<Symbol, Expr> = known
            .filter_map(|(name, value)| Some((name, Expr::number(from_f64(value)?))))
            .collect();
        let motion = motion.substitute_all(&exact)?;
        let velocity = motion.differentiate(t)?;
        let of_time = |part: &Expr| CompiledFunction::new(part, &[t]);
        let [place, speed, rate] = [&motion, &velocity, &velocity.differentiate(t)?].map(of_time);
        let (place, speed, rate) = (place?, speed?, rate?);
        let force = oscillator.force.substitute_all(&exact)?;
        let force =
            CompiledFunction::new(&force, &[t, oscillator.coordinate, oscillator.velocity()])?;
        let equilibrium = solution.equilibrium.evaluate(&numbers)?;
        let drives = frequencies(oscillator, &numbers)?;
        let stiffness = (force.call(&[0.0, equilibrium + 1.0, 0.0])
            - force.call(&[0.0, equilibrium, 0.0]))
        .abs();
        let rates = || drives.iter().copied().chain([stiffness.sqrt()]).filter(|rate| *rate > 0.0);
        let [slow, fast] = [rates().fold(f64::INFINITY, f64::min), rates().fold(0.0, f64::max)];
        let until = (PERIODS[0] * TAU / slow).min(PERIODS[1] * TAU / fast);
        let acceleration = |t: f64, x: f64, v: f64| -force.call(&[t, x, v]);
        let begin = State { t: 0.0, x: equilibrium + numbers[&start], v: 0.0 };
        let path =
            integrate(acceleration, begin, until, &[], &IntegrationOptions::with_tolerance(1e-12))
                .map_err(|_| VerificationError::NotFollowed { time: 0.0 })?;
        if !path.is_complete() {
            let time = path.end().t;
            return Err(VerificationError::NotFollowed { time });
        }
        let times = || (0..=SAMPLES).map(|k| until * k as f64 / SAMPLES as f64);
        let (mut defects, mut forces) = (0.0, 0.0);
        for t in times() {
            let own = force.call(&[t, place.call(&[t]), speed.call(&[t])]);
            defects += (rate.call(&[t]) + own).powi(2);
            forces += own.powi(2);
        }
        Ok(Self {
            formula: times().map(|t| (t, place.call(&[t]), speed.call(&[t]))).collect(),
            truth: times()
                .map(|t| {
                    let (x, v) = path.phase_point_at(t).unwrap_or((f64::NAN, f64::NAN));
                    (t, x, v)
                })
                .collect(),
            numbers,
            drives,
            equilibrium,
            residual: (defects / forces).sqrt(),
        })
    }

    /// The largest deviation over the largest displacement.
    fn deviation(&self) -> Option<f64> {
        let largest = |values: &mut dyn Iterator<Item = f64>| {
            // NaN propagates, unlike in `f64::max`.
            values.fold(0.0_f64, |largest, value| if value <= largest { largest } else { value })
        };
        let pairs = self.formula.iter().zip(&self.truth);
        let apart = largest(&mut pairs.map(|(formula, truth)| (formula.1 - truth.1).abs()));
        let size = largest(&mut self.truth.iter().map(|truth| (truth.1 - self.equilibrium).abs()));
        let deviation = if size == 0.0 { apart } else { apart / size };
        Some(deviation).filter(|value| value.is_finite())
    }
}

/// The angular frequencies of the drives.
fn frequencies(
    oscillator: &Oscillator,
    numbers: &BTreeMap<Symbol, f64>,
) -> Result<Vec<f64>, VerificationError> {
    let t = Symbol::new("t");
    let mut found = vec![];
    for term in oscillator.force.expand()?.terms() {
        for factor in term.factors().1.iter().filter(|factor| factor.contains(t)) {
            if let crate::expr::Node::Function(_, arguments) = factor.node() {
                let rate = arguments[0].differentiate(t)?.evaluate(numbers)?;
                found.push(rate.abs());
            }
        }
    }
    Ok(found)
}

/// Verifies a motion that is given as a function of time.
///
/// # Errors
/// Missing or unknown values; the motion cannot be followed.
pub(super) fn judge(
    oscillator: &Oscillator,
    solution: &Solution,
    motion: &Expr,
    at: &Values,
    tolerance: f64,
) -> Result<Verification, VerificationError> {
    let followed = SampledMotions::new(oscillator, solution, motion, at)?;
    let deviation = followed.deviation();
    let numbers = &followed.numbers;
    let frequency = followed.drives.first().copied().unwrap_or(0.0);
    let until = followed.truth.last().map_or(0.0, |sample| sample.0);
    let start = numbers[&AmplitudeConvention::Initial.symbol()];
    Ok(Verification {
        at: at.clone(),
        tolerance,
        frequency: Some(frequency),
        reason: None,
        true_frequency: frequency,
        relative_error: None,
        judged_on: "motion",
        error_of_omega: None,
        max_deviation: deviation,
        no_deviation: None,
        residual: Some(followed.residual).filter(|value| value.is_finite()),
        slope: None,
        over_several_wells: false,
        ranges: vec![Range {
            text: format!(
                "followed from rest at {AMPLITUDE} = {} to t = {}",
                decimal(start),
                decimal(until)
            ),
            outside: false,
        }],
        chosen: vec![],
        values: symbol_values(oscillator, solution, numbers, None).values,
        phase: 0.0,
        motion: None,
        steady_states: vec![],
        spurious: 0,
        followed: None,
        verdict: Verdict::from_passed(deviation.is_some_and(|deviation| deviation <= tolerance)),
    })
}

/// The motion by the formula and the true one, at the same instants.
///
/// # Errors
/// As for [`judge`].
pub(super) fn motions(
    oscillator: &Oscillator,
    solution: &Solution,
    motion: &Expr,
    at: &Values,
) -> Result<Motions, VerificationError> {
    let SampledMotions { formula, truth, .. } =
        SampledMotions::new(oscillator, solution, motion, at)?;
    Ok(Motions { formula, truth, envelope: None })
}
