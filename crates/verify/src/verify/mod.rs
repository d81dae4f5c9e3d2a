//! The judge: a formula against the true motion of the *original* equation.
//!
//! In: the equation, the answer of a method, numbers for all symbols, a tolerance. Out: a
//! [`Verification`] with errors relative to the truth, a [`Verdict`] and the ranges in which the
//! formula holds; in [`comparison`] the same for every method at once. Where there is no true
//! periodic motion, a [`VerificationError`] says why.
//!
//! Nothing here looks at how a formula was derived. The true frequency comes from energy quadrature
//! where energy is conserved and from the Runge-Kutta return where it is not; the motion from
//! Runge-Kutta with dense output on the equation as it was typed, sine and all, not on its
//! truncation.
//!
//! ```text
//! relative_error = omega_formula / omega_true - 1
//! max_deviation  = max |x_true(t) - x_formula(t)| / |A|      over one true period, in real time
//! residual       = rms of x'' + f(x, x') along the formula / rms of f
//! slope          = log2( error(delta) / error(delta/2) )     -> the exponent of the first missing term
//! ```

mod amplitude_series;
mod backbone;
mod bounds;
pub mod comparison;
pub(crate) mod convergence;
mod driven;
mod error;
mod formula;
mod free_motion;
mod in_time;
mod largest;
mod motions;
mod normal_mode;
mod one_harmonic;
mod orbit;
mod reach;
mod slope;
mod slow_equations;
mod slow_motion;
mod smaller;
mod transient;
pub mod validity;
mod values;

pub use convergence::{Singularity, converges, converges_everywhere, nearest_singularity};
pub use driven::JudgedState;
pub use error::VerificationError;
pub use motions::{Motions, TimedState, motions, true_motion};
pub(crate) use normal_mode::mode_frequencies;
pub use normal_mode::{BackbonePoint, JudgedMode, judge_mode};
pub use one_harmonic::{JudgedOneHarmonic, OneHarmonicMotion, judge_one_harmonic};
pub use slow_equations::{
    JudgedSlowMotion, JudgedSteadyMotion, JudgedTransient, judge_slow_motion,
};
pub use transient::Followed;
pub use validity::{AmplitudeReach, Range};
pub use values::{checked, needed_values};

pub use crate::conservative::well::{Well, WellBoundary, WellEnd};

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use self::formula::{cancellation, formula_frequency, numbers_or_reason, series_of_omega};
use self::largest::largest_over;
use self::orbit::{NearCycle, NumericOscillator, OrbitTarget, SAMPLES, TrueMotion};
use self::slope::slope;
use self::values::{check_digits, checked_numbers};
use crate::conservative::force::CentredForce;
use crate::decimal::{decimal, significant};
use crate::exact::Doubles;
use crate::exact::rational::from_f64;
use crate::expr::Expr;
use crate::method::numbers::{NoNumbers, half_a_period, law_name, symbol_values};
use crate::oscillator::Oscillator;
use crate::series::FourierSeries;
use crate::solution::{AmplitudeConvention, Note, Solution};
use crate::symbol::Symbol;
use crate::symbol::letters::{AMPLITUDE, FIRST_HARMONIC};
use crate::values::Values;

/// The error of the frequency below which a formula passes when the user names no tolerance: 1 %.
pub const DEFAULT_TOLERANCE: f64 = 0.01;

/// The formula's verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The frequency is within the tolerance.
    Pass,
    /// The formula is not within the tolerance, or not real.
    Fail,
}

impl Verdict {
    /// Passed or not.
    pub fn from_passed(passed: bool) -> Self {
        if passed { Self::Pass } else { Self::Fail }
    }

    /// `pass` or `fail`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Fail => "fail",
        }
    }
}

/// A formula judged at given values.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Verification {
    /// The values at which it was judged.
    pub at: Values,
    /// The relative error up to which it passes.
    pub tolerance: f64,
    /// omega by the formula, in the unit of time of the equation; `None` if there is none.
    pub frequency: Option<f64>,
    /// The reason why there is none.
    pub reason: Option<NoNumbers>,
    /// omega of the true motion.
    pub true_frequency: f64,
    /// `frequency / true_frequency - 1`.
    pub relative_error: Option<f64>,
    /// The law that gives the frequency: `omega^2`, of which it is the root, or `omega`.
    pub judged_on: &'static str,
    /// The error of the other law, the series of omega itself, where the formula has both.
    pub error_of_omega: Option<f64>,
    /// Largest deviation over one true period, as a part of the amplitude.
    pub max_deviation: Option<f64>,
    /// The reason why there is none, where the true motion has a period and no path that
    /// Runge-Kutta follows.
    pub no_deviation: Option<String>,
    /// Root mean square of the equation's residual along the formula, over that of its force.
    pub residual: Option<f64>,
    /// Measured exponent of the frequency error; of a motion followed from its start that of
    /// `max_deviation`, over times that grow as what is small becomes less. `None` if rounding
    /// hides it, and for motions over several wells, which do not become small.
    pub slope: Option<f64>,
    /// Whether the motion runs over several wells through an unstable equilibrium: such motions
    /// have a least amplitude.
    pub over_several_wells: bool,
    /// The ranges in which the formula holds, in words and numbers; values outside are marked.
    pub ranges: Vec<validity::Range>,
    /// Values that the method left open: hbar as it was chosen, the coefficients of a balance as
    /// they were solved for.
    pub chosen: Vec<(Symbol, f64)>,
    /// The value of every symbol of the formulas, `omega` and `pi` included; those that have no
    /// real value are left out.
    pub values: Vec<(Symbol, f64)>,
    /// theta at `t = 0`: pi for a negative amplitude whose size stands in `values`, else 0.
    pub phase: f64,
    /// The motion in theta; `None` if the frequency is not real or the motion is not known.
    pub motion: Option<FourierSeries<Doubles>>,
    /// Driven motions: every steady motion by the slow equations, largest first, beside the true
    /// one.
    pub steady_states: Vec<JudgedState>,
    /// Driven motions: how many steady motions of the truncated slow equations are
    /// [left out](crate::solution::Solution::steady_motions), because they are none of the
    /// equation.
    pub spurious: usize,
    /// Motions that are not periodic: what else is known of them.
    pub followed: Option<Followed>,
    /// The verdict on the frequency; on the amplitude of a driven motion.
    pub verdict: Verdict,
}

impl Verification {
    /// The verdict with what it was reached on: of a motion that changes frequency and amplitude
    /// both; of one that passes by its frequency while the motion is further off, that as well.
    pub fn verdict_in_words(&self) -> String {
        let within = significant(100.0 * self.tolerance, 3);
        self.verdict_on_both()
            .unwrap_or_else(|| format!("{} (|relative error| <= {within} %)", self.verdict.name()))
    }

    /// The verdict with the two numbers that it is about; `None` if the frequency alone says all of
    /// it.
    pub fn verdict_on_both(&self) -> Option<String> {
        let tolerance = self.tolerance;
        let verdict = self.verdict.name();
        let within = significant(100.0 * tolerance, 3);
        let said = |what: &str, error: Option<f64>| match error.map(f64::abs) {
            Some(error) if error <= tolerance => format!("{what} within {within} %"),
            Some(error) => format!("{what} off by {} %", significant(100.0 * error, 3)),
            None => format!("{what} without a number"),
        };
        let far_off = self.max_deviation.filter(|deviation| *deviation > tolerance);
        match (&self.followed, self.verdict, far_off) {
            (Some(followed), ..) => Some(format!(
                "{verdict}: {}, {}",
                said("frequency", self.relative_error),
                said("amplitude", followed.amplitude_error)
            )),
            (None, Verdict::Pass, Some(_)) => Some(format!(
                "{verdict}: {}, {}",
                said("frequency", self.relative_error),
                said("motion", far_off)
            )),
            (None, ..) => None,
        }
    }
}

/// Judges `solution` at the values `at`.
///
/// # Errors
/// A formula that answers another equation, missing or unknown values, or no true periodic motion
/// there.
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::{Options, Oscillator, Verdict, judge, solve};
///
/// let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
/// let law = solve(&duffing, &Options::default())?;
/// let judged = judge(&duffing, &law, &"A = 1, eps = 1/10".parse()?, 0.01)?;
/// assert_eq!(judged.verdict, Verdict::Pass);
/// assert!(judged.relative_error.is_some_and(|error| error.abs() < 1e-5));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn judge(
    oscillator: &Oscillator,
    solution: &Solution,
    at: &Values,
    tolerance: f64,
) -> Result<Verification, VerificationError> {
    judge_with(oscillator, solution, at, (tolerance, VerificationScope::Range))
}

/// As [`judge`], of the motion at the values given and nothing else: where motions are periodic,
/// neither how its error grows nor how far the formula is good, which takes most of the time.
///
/// # Errors
/// As for [`judge`].
pub fn judge_motion(
    oscillator: &Oscillator,
    solution: &Solution,
    at: &Values,
    tolerance: f64,
) -> Result<Verification, VerificationError> {
    judge_with(oscillator, solution, at, (tolerance, VerificationScope::Motion))
}

/// The true angular frequency that [`judge_motion`] finds, without the path of the motion where that is not needed.
///
/// # Errors
/// As for [`judge`].
pub(crate) fn true_frequency(
    oscillator: &Oscillator,
    solution: &Solution,
    at: &Values,
) -> Result<f64, VerificationError> {
    /// Every formula passes: the truth alone is asked for.
    const ANY: f64 = 1.0;
    match directly_known_frequency(oscillator, solution, at) {
        Some(frequency) => Ok(frequency),
        None => judge_motion(oscillator, solution, at, ANY).map(|judged| judged.true_frequency),
    }
}

/// The true angular frequency of a motion in the coordinate and with the amplitude of its formula; `None` for all
/// others, and where it is not found.
fn directly_known_frequency(
    oscillator: &Oscillator,
    solution: &Solution,
    at: &Values,
) -> Option<f64> {
    let _letters = solution.letters().in_force();
    let is_converted = in_another_coordinate(oscillator, solution).ok()?.is_some()
        || in_convention_of(oscillator, solution, at).ok()?.is_some();
    let is_special =
        solution.in_time().is_some() || solution.response.is_some() || solution.slow().is_some();
    if is_converted || is_special || off_cycle(solution, at).is_some() {
        return None;
    }
    let settled = on_cycle(solution, at);
    let solution = settled.as_ref().unwrap_or(solution);
    periodic(solution).ok()?;
    let numbers = checked_numbers(solution, at).ok()?;
    check_digits(oscillator, solution, &numbers).ok()?;
    let meant = orbit_target(oscillator, solution, &numbers);
    orbit::true_frequency(oscillator, &meant, &numbers).ok()
}

/// The extent of a verification.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum VerificationScope {
    /// The motion at the values given.
    Motion,
    /// The growth of its error and the range of the formula too.
    Range,
}

fn judge_with(
    oscillator: &Oscillator,
    solution: &Solution,
    at: &Values,
    (tolerance, scope): (f64, VerificationScope),
) -> Result<Verification, VerificationError> {
    let _letters = solution.letters().in_force();
    if let Some(relative) = in_another_coordinate(oscillator, solution)? {
        return judge_with(&relative, solution, at, (tolerance, scope));
    }
    if let Some(motion) = solution.in_time() {
        return in_time::judge(oscillator, solution, motion, at, tolerance);
    }
    if let Some(response) = &solution.response {
        check_common_period(solution)?;
        return driven::judge(oscillator, solution, response, at, tolerance);
    }
    if let Some(moving) = off_cycle(solution, at) {
        return judge_with(oscillator, &moving, at, (tolerance, scope));
    }
    if let Some((converted, in_words)) = in_convention_of(oscillator, solution, at)? {
        let mut judged = judge_with(oscillator, solution, &converted, (tolerance, scope))?;
        let text = in_words;
        judged.ranges.insert(0, validity::Range { text, outside: false });
        return Ok(judged);
    }
    let settled = on_cycle(solution, at);
    if let (Some(slow), None) = (solution.slow(), &settled) {
        let numbers = checked_numbers(solution, at)?;
        check_digits(oscillator, solution, &numbers)?;
        return transient::judge(oscillator, solution, slow, at, &numbers, tolerance);
    }
    periodic(settled.as_ref().unwrap_or(solution))?;
    let numbers = checked_numbers(solution, at)?;
    let solution = settled.as_ref().unwrap_or(solution);
    check_digits(oscillator, solution, &numbers)?;
    let meant = orbit_target(oscillator, solution, &numbers);
    let truth = meant_motion(oscillator, solution, &meant, &numbers)?;
    let (found, reason) = numbers_or_reason(oscillator, solution, &numbers);
    let frequency = found.as_ref().map(|found| found.frequency_squared.sqrt());
    let relative_error = frequency.map(|frequency| frequency / truth.frequency - 1.0);
    let motion = frequency.zip(found.as_ref().and_then(|found| found.motion.clone()));
    let max_deviation = motion
        .as_ref()
        .and_then(|(frequency, motion)| largest_deviation(&truth, *frequency, motion));
    let physics = NumericOscillator::new(oscillator, &meant, &numbers)?;
    let residual = motion
        .as_ref()
        // The mean square of a force that is infinite at rest is nothing but what the samples
        // nearest to it find.
        .filter(|_| {
            physics.force_at(0.0, 0.0).is_finite() && !physics.is_infinite_at_rest(truth.amplitude)
        })
        .map(|(frequency, motion)| residual(&physics, *frequency, motion));
    let pass = relative_error.is_some_and(|error| error.abs() <= tolerance);
    let remark = found.as_ref().and_then(|found| found.remark.clone());
    let remark = remark.map(|text| validity::Range { text, outside: false });
    let mut symbols = symbol_values(oscillator, solution, &numbers, found.as_ref());
    if let Some(cycle) = settled.as_ref().and_then(|settled| settled.limit_cycle.as_ref()) {
        // The formulas are those of any amplitude: where the motion settles it is the cycle's,
        // whatever it was at the start.
        let size = solution.evaluate(&cycle.amplitude, &|symbol| numbers.get(&symbol).copied());
        symbols.values.retain(|(name, _)| *name != AmplitudeConvention::Initial.symbol());
        symbols.values.extend(size.ok().map(|size| (solution.amplitude.symbol(), size)));
    }
    let ranged = scope == VerificationScope::Range;
    let far = ranged.then(|| validity::ranges(oscillator, solution, &numbers, tolerance));
    let far = far.into_iter().flatten();
    Ok(Verification {
        at: at.clone(),
        tolerance,
        frequency,
        reason,
        true_frequency: truth.frequency,
        relative_error,
        judged_on: law_name(solution),
        error_of_omega: series_of_omega(solution, &numbers)
            .map(|omega| omega / truth.frequency - 1.0),
        max_deviation,
        no_deviation: unfollowed(&truth, &physics, solution.coordinate())
            .filter(|_| motion.is_some()),
        residual: residual.filter(|value| value.is_finite()),
        slope: ranged.then(|| slope(oscillator, solution, &numbers)).flatten(),
        over_several_wells: validity::is_over_several_wells(oscillator, solution, &numbers),
        ranges: about_the_cycle(&truth, solution.coordinate())
            .filter(|_| attraction(solution, &numbers) != Some(0.0))
            .into_iter()
            .chain(remark)
            .chain(cancellation(solution, &numbers, found.as_ref(), max_deviation))
            .chain(far)
            .collect(),
        chosen: found.map_or_else(Vec::new, |found| found.chosen),
        values: symbols.values,
        phase: symbols.phase,
        steady_states: vec![],
        spurious: 0,
        // The motion of the size of the amplitude, which begins half a period later.
        motion: motion.map(|(_, motion)| match symbols.phase == 0.0 {
            true => motion,
            false => motion.by_harmonic(half_a_period),
        }),
        followed: None,
        verdict: Verdict::from_passed(pass),
    })
}

/// An error if the drives have frequencies without a ratio.
fn check_common_period(solution: &Solution) -> Result<(), VerificationError> {
    let apart = |note: &Note| matches!(note, Note::ForcedWaves { .. });
    match solution.validity.iter().any(apart) {
        true => Err(VerificationError::NeverRepeats),
        false => Ok(()),
    }
}

/// The question in the coordinate of its answer, where that is another one: relative to a base that
/// moves.
fn in_another_coordinate(
    oscillator: &Oscillator,
    solution: &Solution,
) -> Result<Option<Oscillator>, VerificationError> {
    let own = oscillator.equation();
    if solution.coordinate() == oscillator.coordinate && solution.equation.left == own.left {
        return Ok(None);
    }
    // Driven through its base, the answer may be one of the displacement relative to that.
    let is_driven = oscillator.force.contains(Symbol::new("t"));
    match is_driven && solution.coordinate() != oscillator.coordinate {
        true => Ok(Some(Oscillator::from_equation(&solution.equation)?)),
        false => Err(VerificationError::OtherEquation {
            answered: solution.equation.to_string(),
            asked: own.to_string(),
        }),
    }
}

/// The values with the amplitude that the formula is written in, where that of the other convention
/// is given instead, and what was converted in words: the true motion released at `A` has the first
/// harmonic `a`. `None` if there is nothing to convert.
///
/// # Errors
/// There is no true periodic motion of this amplitude.
fn in_convention_of(
    oscillator: &Oscillator,
    solution: &Solution,
    at: &Values,
) -> Result<Option<(Values, String)>, VerificationError> {
    let [wanted, given] = [solution.amplitude, solution.amplitude.other()];
    let free = solution.limit_cycle.is_none() && solution.slow().is_none();
    let Some(size) = at
        .get(given.symbol())
        .filter(|size| free && *size != 0.0 && at.get(wanted.symbol()).is_none())
    else {
        return Ok(None);
    };
    let numbers = at.with(given.symbol(), size);
    if solution.parameters.iter().any(|name| !numbers.contains_key(name)) {
        return Ok(None);
    }
    let meant = OrbitTarget { convention: given, ..orbit_target(oscillator, solution, &numbers) };
    let equilibrium = solution.equilibrium.evaluate(&numbers)?;
    let motion = TrueMotion::follow(oscillator, &meant, &numbers)?;
    let Some(converted) = motion.amplitude_by_the_other(given, equilibrium) else {
        return Ok(None);
    };
    let (_, mut values) = at.split(&[given.symbol()]);
    let exact = from_f64(converted).ok_or(VerificationError::NoPath)?;
    // A number is a value for any name.
    let _ = values.insert(wanted.symbol(), Expr::number(exact));
    let (release, harmonic) = match given {
        AmplitudeConvention::Initial => (size, converted),
        AmplitudeConvention::FirstHarmonic => (converted, size),
    };
    let in_words = format!(
        "the true motion released from rest at {AMPLITUDE} = {} has the first harmonic {FIRST_HARMONIC} = {}; the formula is written in {}",
        decimal(release),
        decimal(harmonic),
        wanted.symbol()
    );
    Ok(Some((values, in_words)))
}

/// An error where the amplitude of a free motion changes.
fn periodic(solution: &Solution) -> Result<(), VerificationError> {
    let slow = solution.modulation.as_ref().filter(|_| solution.limit_cycle.is_none());
    match slow.is_some_and(|slow| !slow.is_conservative()) {
        true => Err(VerificationError::NotPeriodic),
        false => Ok(()),
    }
}

/// The motion from the start that is given, where the solution is that on a limit cycle.
fn off_cycle(solution: &Solution, at: &Values) -> Option<Solution> {
    at.get(AmplitudeConvention::Initial.symbol())?;
    solution.off_cycle()
}

/// Slow equations where their motion has settled, unless a start is given.
fn on_cycle(solution: &Solution, at: &Values) -> Option<Solution> {
    let started = at.get(AmplitudeConvention::Initial.symbol()).is_some();
    solution.slow().filter(|_| !started).and_then(|_| solution.on_cycle())
}

/// Which true motion an answer is meant for.
fn orbit_target(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> OrbitTarget {
    let value_of = |symbol: Symbol| numbers.get(&symbol).copied();
    let near = |cycle: &crate::solution::LimitCycle| {
        // The amplitude that the formula has where the small parameter vanishes.
        let amplitude = solution.evaluate(&solution.leading(&cycle.amplitude), &value_of);
        let amplitude = amplitude.ok().map(f64::abs).filter(|size| size.is_normal());
        NearCycle {
            amplitude: amplitude.unwrap_or(1.0),
            attracts: attraction(solution, numbers)
                .filter(|value| *value != 0.0)
                .map(|value| value > 0.0),
        }
    };
    let expected = || formula_frequency(oscillator, solution, numbers);
    OrbitTarget {
        equilibrium: solution.equilibrium.clone(),
        convention: solution.amplitude,
        limit_cycle: solution.limit_cycle.as_ref().map(near),
        frequency: if oscillator.of_position_alone() { None } else { expected() },
    }
}

/// The true motion that an answer is meant for.
///
/// # Errors
/// There is none, or it cannot be followed; where motions are periodic is said with it.
fn meant_motion(
    oscillator: &Oscillator,
    solution: &Solution,
    meant: &OrbitTarget,
    numbers: &BTreeMap<Symbol, f64>,
) -> Result<TrueMotion, VerificationError> {
    let found = TrueMotion::follow(oscillator, meant, numbers);
    found.map_err(|error| validity::why_no_motion(oscillator, solution, numbers, error))
}

/// The force about the equilibrium of an answer; `None` if a symbol of it has no number.
fn force_of(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Option<CentredForce> {
    let amplitude = numbers.get(&solution.amplitude.symbol()).copied().unwrap_or(1.0);
    let (force, coordinate) = (&oscillator.force, oscillator.coordinate);
    CentredForce::new(force, coordinate, &solution.equilibrium, numbers, amplitude)
}

/// Describes the position of a true limit cycle and whether it attracts.
fn about_the_cycle(truth: &TrueMotion, coordinate: Symbol) -> Option<validity::Range> {
    let cycle = truth.limit_cycle()?;
    let does = if cycle.attracts() { "attracts" } else { "repels" };
    Some(validity::Range {
        text: format!(
            "the true limit cycle turns at {coordinate} = {} and {does}",
            decimal(cycle.phase_point_at(0.0).0)
        ),
        outside: false,
    })
}

/// The reason why the displacement is not judged, where the true path is not known.
fn unfollowed(
    truth: &TrueMotion,
    physics: &NumericOscillator,
    coordinate: Symbol,
) -> Option<String> {
    if truth.has_path() {
        return None;
    }
    let why = match physics.is_infinite_at_rest(truth.amplitude) {
        true => format!(
            " through {coordinate} = {}, where the force is infinite",
            decimal(physics.rest.equilibrium())
        ),
        false => String::new(),
    };
    Some(format!("Runge-Kutta does not follow the true motion{why}"))
}

/// Largest `|x_true - x_formula|` over one true period, over the amplitude; `None` if the path is
/// not known.
fn largest_deviation(
    truth: &TrueMotion,
    frequency: f64,
    motion: &FourierSeries<Doubles>,
) -> Option<f64> {
    if !truth.has_path() {
        return None;
    }
    let deviation = |t: f64| (truth.sample(t).1 - motion.evaluate(frequency * t)).abs();
    let largest = largest_over(truth.period(), deviation) / truth.amplitude;
    largest.is_finite().then_some(largest)
}

/// A number that is positive if the limit cycle of a formula attracts, negative if it repels, and
/// zero if the amplitude is free.
fn attraction(solution: &Solution, numbers: &BTreeMap<Symbol, f64>) -> Option<f64> {
    let cycle = solution.limit_cycle.as_ref()?;
    let own = cycle.cycles.get(cycle.number.wrapping_sub(1))?;
    let mut numbers = numbers.clone();
    // A small parameter that only marks terms is positive.
    numbers.entry(solution.small_parameter).or_insert(1.0);
    own.attracts_where.as_ref()?.evaluate(&numbers).ok()
}

fn residual(physics: &NumericOscillator, frequency: f64, motion: &FourierSeries<Doubles>) -> f64 {
    let velocity = motion.derivative();
    let acceleration = velocity.derivative();
    let (mut defects, mut forces) = (0.0, 0.0);
    for k in 0..SAMPLES {
        let theta = TAU * k as f64 / SAMPLES as f64;
        let distance = motion.evaluate(theta) - physics.rest.equilibrium();
        let force = physics.force_at(distance, frequency * velocity.evaluate(theta));
        let defect = frequency * frequency * acceleration.evaluate(theta) + force;
        defects += defect * defect;
        forces += force * force;
    }
    (defects / forces).sqrt()
}
