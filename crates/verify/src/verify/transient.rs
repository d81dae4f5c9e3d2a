//! Verification of motions that are not periodic: slow equations of amplitude and phase against the
//! equation as it was typed.
//!
//! ```text
//! released at rest from x = A, followed until the amplitude has fallen to A/10, grown to 10 A, settled within 1 % of one that
//! stays, or 50 periods have gone by, but at least three of them
//! true_frequency = pi (n - 1)/(t_n - t_1)       t_k the times at which the motion goes through its equilibrium
//! frequency      = the same of the formula, with as many of its own
//! amplitude_error = max |x_formula - x_true|/|A|  at the true turning points, x_formula that of the same half swing at its turn
//! max_deviation  = max |x_formula(t) - x_true(t)|/|A|
//! residual       = rms of x'' + f(x, x') along the formula / rms of f
//! slope          = log2(max_deviation at delta / at delta/2), delta before all that is small, over times that grow as 1/delta
//! ```
//!
//! Slow equations of order n are off by `delta^(n+1)`, over times of `1/delta` by `delta^n`: that
//! is the slope to expect. It may be more where a coefficient of the error vanishes.
//!
//! Reference: J. A. Sanders, F. Verhulst, J. Murdock, *Averaging Methods in Nonlinear Dynamical
//! Systems*, 2nd ed., Springer 2007, theorems 2.8.1 and 2.9.2.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use super::free_motion::{FreeMotion, Start};
use super::slope::slopes_of;
use super::slow_motion::{LOOKS, SlowMotion};
use super::smaller::{is_small_in_amplitude, smaller};
use super::validity::Range;
use super::{Motions, TimedState, Verdict, Verification, VerificationError};
use crate::decimal::decimal;
use crate::exact::rational::from_f64;
use crate::expr::{CompiledFunction, Expr};
use crate::method::averaging::action::falls_to;
use crate::method::numbers::{NoNumbers, symbol_values};
use crate::oscillator::Oscillator;
use crate::solution::{AmplitudeConvention, Modulation, Solution};
use crate::symbol::Symbol;
use crate::values::Values;

/// A motion that is not periodic, followed from its release at rest at x = A. Frequencies are those
/// of its crossings of the equilibrium: pi over the mean time between successive ones;
/// `max_deviation` is over the whole time.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Followed {
    /// How long it was followed, in the time of the equation.
    pub until: f64,
    /// Why no longer, in words.
    pub reason: String,
    /// How many crossings of the formula and of the true motion were compared.
    pub crossings: usize,
    /// The largest error of the turning points, as a fraction of the amplitude at the start; null
    /// where it is not known.
    pub amplitude_error: Option<f64>,
    /// The exponent with which that error vanishes as the small parameter does, over times that
    /// grow as it becomes less; null where rounding hides it.
    #[cfg_attr(feature = "serde", serde(default))]
    pub amplitude_slope: Option<f64>,
    /// When the amplitude is a tenth of that at the start, by the formula; null where it was not
    /// seen.
    pub tenth: Option<f64>,
    /// The same by the action, which viscous damping drains at one rate whatever the force; null
    /// for any other damping.
    pub tenth_by_action: Option<f64>,
    /// The same in truth, between turning points on the logarithm; null where it was not seen.
    pub true_tenth: Option<f64>,
}

/// Verifies slow equations from a start.
///
/// # Errors
/// The motion cannot be followed, or it does not oscillate.
pub(super) fn judge(
    oscillator: &Oscillator,
    solution: &Solution,
    modulation: &Modulation,
    at: &Values,
    numbers: &BTreeMap<Symbol, f64>,
    tolerance: f64,
) -> Result<Verification, VerificationError> {
    let symbols = symbol_values(oscillator, solution, numbers, None);
    let judged = TransientPair::new(oscillator, solution, modulation, numbers)?;
    let TransientPair { slow, truth, until, reason, start } = &judged;
    let crossings = slow.crossings(*until);
    let own: Vec<f64> = truth.crossings.iter().copied().filter(|t| t <= until).collect();
    let count = own.len().min(crossings.len());
    let mean = |times: &[f64]| match times {
        [first, .., last] => Some(PI * (times.len() - 1) as f64 / (last - first)),
        _ => None,
    };
    let reference = if count < 2 { &own[..] } else { &own[..count] };
    let true_frequency = mean(reference).ok_or_else(|| truth.why_no_swing())?;
    let frequency = mean(&crossings[..count]);
    let relative_error = frequency.map(|frequency| frequency / true_frequency - 1.0);
    let errors = judged.errors(*until);
    let amplitude_error = errors.amplitude;
    let slopes = slopes(oscillator, solution, numbers, &judged);
    let is_within = |error: Option<f64>| error.is_some_and(|error| error.abs() <= tolerance);
    let pass = is_within(relative_error) && is_within(amplitude_error);
    let outside = amplitude_error.is_none_or(|error| error > tolerance);
    let ranges = amplitude_error.map(|error| Range {
        text: format!(
            "the amplitude errs by {} of that at the start at most, followed to t = {}",
            crate::decimal::significant(error, 3),
            decimal(*until)
        ),
        outside,
    });
    Ok(Verification {
        at: at.clone(),
        tolerance,
        frequency,
        reason: frequency.is_none().then_some(NoNumbers::NoValue),
        true_frequency,
        relative_error,
        judged_on: "omega",
        error_of_omega: None,
        max_deviation: errors.deviation,
        no_deviation: None,
        residual: judged.residual(oscillator, numbers),
        slope: slopes.deviation,
        over_several_wells: false,
        ranges: ranges.filter(|range| range.outside).into_iter().collect(),
        chosen: vec![],
        values: symbols.values,
        phase: 0.0,
        motion: None,
        steady_states: vec![],
        spurious: 0,
        followed: Some(Followed {
            until: *until,
            reason: (*reason).to_owned(),
            crossings: count,
            amplitude_error,
            amplitude_slope: slopes.amplitude,
            tenth: slow.turns_at(start.abs() / 10.0, truth.end()),
            tenth_by_action: falls_to(
                oscillator,
                &solution.equilibrium,
                numbers,
                [*start, start / 10.0],
            ),
            true_tenth: truth.falls_to(start.abs() / 10.0),
        }),
        verdict: Verdict::from_passed(pass),
    })
}

/// The motion by the slow equations and the true one, at the same instants.
///
/// # Errors
/// As for [`judge`].
pub(super) fn motions(
    oscillator: &Oscillator,
    solution: &Solution,
    modulation: &Modulation,
    numbers: &BTreeMap<Symbol, f64>,
) -> Result<Motions, VerificationError> {
    let judged = TransientPair::new(oscillator, solution, modulation, numbers)?;
    let rest = judged.slow.equilibrium;
    let count = samples(judged.until, judged.slow.period);
    let time = |k: usize| judged.until * k as f64 / count as f64;
    let sample = |t: f64, (y, v): (f64, f64)| -> TimedState { (t, rest + y, v) };
    let times = || (0..=count).map(time);
    let envelope = |t: f64| [0.0, PI].map(|phase| (t, rest + judged.slow.at_phase(t, phase)));
    let [upper, lower] = [0, 1].map(|side| times().map(|t| envelope(t)[side]).collect());
    Ok(Motions {
        formula: times().map(|t| sample(t, judged.slow.phase_point_at(t))).collect(),
        truth: times().map(|t| sample(t, judged.truth.phase_point_at(t))).collect(),
        envelope: Some([upper, lower]),
    })
}

/// The number of samples, enough for a figure and for the largest deviation.
fn samples(until: f64, period: f64) -> usize {
    const PER_PERIOD: f64 = 64.0;
    let count = (PER_PERIOD * until / period).ceil();
    if count.is_finite() { (count as usize).clamp(64, 8192) } else { 64 }
}

/// The largest of the numbers; `None` if there are none or one is not finite.
fn largest(values: impl Iterator<Item = f64>) -> Option<f64> {
    let found = values.fold(None, |largest: Option<f64>, value| {
        Some(match largest {
            Some(known) if known.is_nan() || known >= value => known,
            _ => value,
        })
    });
    found.filter(|value| value.is_finite())
}

/// Formula and truth from one start.
struct TransientPair {
    slow: SlowMotion,
    truth: FreeMotion,
    until: f64,
    reason: &'static str,
    start: f64,
}

/// Errors of a formula, over the initial amplitude.
struct Errors {
    /// The error at the turning points.
    amplitude: Option<f64>,
    /// The error at any time.
    deviation: Option<f64>,
}

impl TransientPair {
    fn new(
        oscillator: &Oscillator,
        solution: &Solution,
        modulation: &Modulation,
        numbers: &BTreeMap<Symbol, f64>,
    ) -> Result<Self, VerificationError> {
        let slow = SlowMotion::new(solution, modulation, numbers)?;
        let (until, reason) = slow.duration();
        // The true amplitude may fall to a tenth a little later.
        let longer = until + f64::max(slow.period, 0.1 * until);
        Self::followed(oscillator, numbers, slow, (until, reason), longer)
    }

    /// Formula and truth from the start, the true motion for the given time.
    fn followed(
        oscillator: &Oscillator,
        numbers: &BTreeMap<Symbol, f64>,
        slow: SlowMotion,
        (until, reason): (f64, &'static str),
        duration: f64,
    ) -> Result<Self, VerificationError> {
        let start = numbers.get(&AmplitudeConvention::Initial.symbol()).copied().unwrap_or(1.0);
        let truth = FreeMotion::follow(
            oscillator,
            numbers,
            &Start {
                equilibrium: slow.equilibrium,
                distance: start,
                duration,
                step: slow.period / LOOKS,
            },
        )?;
        Ok(Self { until: until.min(truth.end()), slow, truth, reason, start })
    }

    /// The errors up to a time.
    fn errors(&self, until: f64) -> Errors {
        let (slow, truth, start) = (&self.slow, &self.truth, self.start.abs());
        let turns = truth.turns.iter().filter(|(t, _)| *t <= until);
        let apart = turns.map(|&(t, x)| (slow.turned(t, x) - x).abs() / start);
        let count = samples(until, slow.period);
        let times = (0..=count).map(|k| until * k as f64 / count as f64);
        Errors {
            amplitude: largest(apart),
            deviation: largest(
                times.map(|t| (slow.phase_point_at(t).0 - truth.phase_point_at(t).0).abs() / start),
            ),
        }
    }

    /// Root mean square residual of the formula in the equation, over that of the force.
    fn residual(&self, oscillator: &Oscillator, numbers: &BTreeMap<Symbol, f64>) -> Option<f64> {
        let known = numbers.iter();
        let known =
            known.filter_map(|(name, value)| Some((*name, Expr::number(from_f64(*value)?))));
        let force = oscillator.force.substitute_all(&known.collect()).ok()?;
        let force =
            CompiledFunction::new(&force, &[oscillator.coordinate, oscillator.velocity()]).ok()?;
        let count = samples(self.until, self.slow.period);
        let (mut defects, mut forces) = (0.0, 0.0);
        for k in 0..count {
            let t = self.until * k as f64 / count as f64;
            let (y, v) = self.slow.phase_point_at(t);
            let force = force.call(&[self.slow.equilibrium + y, v]);
            let defect = self.slow.acceleration(t)? + force;
            defects += defect * defect;
            forces += force * force;
        }
        Some((defects / forces).sqrt()).filter(|value: &f64| value.is_finite())
    }
}

/// The exponents of both errors, as far as they can be measured.
struct Slopes {
    amplitude: Option<f64>,
    deviation: Option<f64>,
}

/// Measures the exponents of the errors: the small quantities are halved repeatedly, and the motion
/// is followed twice as long each time.
fn slopes(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    judged: &TransientPair,
) -> Slopes {
    const HALVINGS: i32 = 4;
    /// Duration of the first motion in periods; it is doubled with each halving.
    const PERIODS: f64 = 8.0;
    /// The true motion is accurate to 1e-11, and a deviation a hundred times larger is measured to
    /// one per cent.
    const FLOOR: f64 = 1e-9;
    let first = judged.until.min(PERIODS * judged.slow.period);
    let error = |halving: i32| {
        if halving == 0 {
            return Some(judged.errors(first));
        }
        let smaller = smaller(oscillator, solution, numbers, halving)?;
        let slow =
            SlowMotion::new(&smaller.solution, smaller.solution.slow()?, &smaller.numbers).ok()?;
        let until = first * 2.0_f64.powi(halving);
        let judged = TransientPair::followed(
            &smaller.oscillator,
            &smaller.numbers,
            slow,
            (until, ""),
            until,
        )
        .ok()?;
        (judged.until >= until).then(|| judged.errors(until))
    };
    let mut errors = vec![];
    // The sequence of halvings ends at the first error that cannot be measured.
    for halving in 0..HALVINGS {
        match error(halving) {
            Some(found) => errors.push(found),
            None => break,
        }
    }
    // The halved quantity is the square of a small amplitude.
    let power = if is_small_in_amplitude(solution) { 2.0 } else { 1.0 };
    let measured = |of: fn(&Errors) -> Option<f64>| {
        let errors: Vec<f64> =
            errors.iter().map_while(of).take_while(|error| *error >= FLOOR).collect();
        slopes_of(&errors).map(|slope| power * slope)
    };
    Slopes {
        amplitude: measured(|errors| errors.amplitude),
        deviation: measured(|errors| errors.deviation),
    }
}
