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
mod free_motion;
mod in_time;
mod largest;
mod orbit;
mod reach;
mod slow_motion;
mod smaller;
mod transient;
pub mod validity;

pub use convergence::{Singularity, converges, converges_everywhere, nearest_singularity};
pub use driven::JudgedState;
pub use transient::Followed;
pub use validity::{AmplitudeReach, Range};

pub use crate::conservative::well::{Well, WellBoundary, WellEnd};

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use self::largest::largest_over;
use self::orbit::{NearCycle, NumericOscillator, OrbitTarget, SAMPLES, TrueMotion, true_frequency};
use crate::conservative::features::Features;
use crate::conservative::force::CentredForce;
use crate::decimal::{decimal, significant};
use crate::exact::Doubles;
use crate::exact::rational::from_f64;
use crate::expr::{EvaluationError, Expr, ExprError, LostDigits};
use crate::method::numbers::{
    NoNumbers, Numbers, NumbersCache, evaluate, frequency_squared_along, half_a_period, law_name,
    symbol_values,
};
use crate::numeric::period::PeriodError;
use crate::numeric::return_map::NoLimitCycle;
use crate::oscillator::{Oscillator, OscillatorError};
use crate::series::FourierSeries;
use crate::solution::{AmplitudeConvention, Note, Solution};
use crate::symbol::Symbol;
use crate::symbol::letters::{AMPLITUDE, FIRST_HARMONIC, FREQUENCY};
use crate::trajectory::TrajectoryError;
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
    pub fn verdict_in_words(&self, tolerance: f64) -> String {
        let within = significant(100.0 * tolerance, 3);
        self.verdict_on_both(tolerance)
            .unwrap_or_else(|| format!("{} (|relative error| <= {within} %)", self.verdict.name()))
    }

    /// The verdict with the two numbers that it is about; `None` if the frequency alone says all of
    /// it.
    pub fn verdict_on_both(&self, tolerance: f64) -> Option<String> {
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

/// The reason why a formula could not be judged.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum VerificationError {
    /// Values are missing.
    #[error("to judge the formula, values are needed for: {}", .0.iter().map(|name| name.written()).collect::<Vec<_>>().join(", "))]
    Missing(Vec<Symbol>),
    /// A value for a symbol that does not occur.
    #[error("`{name}` does not occur in the formula{}", letters_of(known))]
    Unknown {
        /// The name.
        name: Symbol,
        /// The names that do occur.
        known: Vec<Symbol>,
    },
    /// An amplitude so large that the force has no digits there.
    #[error(transparent)]
    LostDigits(#[from] LostDigits),
    /// The equation has no motion to compare with at these values.
    #[error(transparent)]
    Period(#[from] PeriodError),
    /// The equation has no limit cycle to compare with at these values.
    #[error(transparent)]
    LimitCycle(#[from] NoLimitCycle),
    /// The equation could not be taken apart.
    #[error(transparent)]
    Oscillator(#[from] OscillatorError),
    /// The equation could not be evaluated.
    #[error(transparent)]
    Evaluation(#[from] EvaluationError),
    /// The values do not fit the equation.
    #[error(transparent)]
    Expression(#[from] ExprError),
    /// A motion whose amplitude changes.
    #[error("the amplitude of the motion changes, so it has no period to be compared with")]
    NotPeriodic,
    /// A motion under drives whose frequencies have no ratio.
    #[error(
        "under drives whose frequencies have no ratio no motion repeats itself, and there is none to compare with"
    )]
    NeverRepeats,
    /// The equation cannot be followed.
    #[error(transparent)]
    Trajectory(#[from] TrajectoryError),
    /// A motion that ends where it begins.
    #[error("the true motion cannot be followed past t = {}: a state or its rate has no value there", decimal(*time))]
    NotFollowed {
        /// The time at which it ends.
        time: f64,
    },
    /// A motion whose period alone is known.
    #[error(
        "Runge-Kutta does not follow the true motion, of which the energy tells the period alone: there is no path to compare with"
    )]
    NoPath,
    /// A start off the limit cycle that a formula describes.
    #[error(
        "x(0) = {} is a start off the limit cycle, and this method describes the cycle alone",
        AMPLITUDE
    )]
    OffCycle,
    /// A motion that dies out or grows before it swings.
    #[error("the true motion does not swing: it goes through its equilibrium less than twice")]
    NoSwing,
    /// A rate of the phase that is not positive at the start.
    #[error("not real: the rate of the phase is not positive at the start")]
    NoSlowFrequency,
    /// The amplitude is zero, and at rest there is nothing to compare.
    #[error(
        "at amplitude zero the motion is rest: the formula gives the linear limit, which has nothing to be judged against"
    )]
    AtRest,
}

impl VerificationError {
    /// Whether there may be a true motion all the same: it was not found, or could not be followed.
    fn leaves_the_truth_open(&self) -> bool {
        match self {
            Self::Period(error) => matches!(
                error,
                PeriodError::Waves
                    | PeriodError::NearSeparatrix { .. }
                    | PeriodError::NoReturn(_)
                    | PeriodError::Pole { .. }
                    | PeriodError::Overflow { .. }
                    | PeriodError::Quadrature(_)
                    | PeriodError::Root(_)
                    | PeriodError::Integration(_)
            ),
            Self::LimitCycle(_) => true,
            _ => false,
        }
    }
}

/// The letters that there are, after "does not occur in the formula".
fn letters_of(known: &[Symbol]) -> String {
    let names: Vec<&str> = known.iter().map(|name| name.written()).collect();
    match names.is_empty() {
        true => ", which has no letters: it is judged without values, by `--tolerance 0.01` say"
            .to_owned(),
        false => format!("; it has: {}", names.join(", ")),
    }
}

/// The symbols that need a value before `solution` can be judged.
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::{Options, Oscillator, solve};
///
/// let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
/// let solution = solve(&duffing, &Options::default())?;
/// let names = lindstedt::verify::needed_values(&solution);
/// assert!(names.contains(&"A".into()) && names.contains(&"eps".into()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn needed_values(solution: &Solution) -> Vec<Symbol> {
    let mut needed = solution.parameters.clone();
    if solution.slow().is_some() {
        // A motion that settles may be judged where it does.
        if solution.on_cycle().is_none() {
            needed.push(AmplitudeConvention::Initial.symbol());
        }
        return needed;
    }
    // A law such as omega^2 = 1 for x'' + x + x^2 = 0 is free of A where the true motion is not.
    let linear = || {
        let oscillator = Oscillator::from_equation(&solution.equation);
        oscillator.is_ok_and(|oscillator| matches!(oscillator.polynomial_degree(), Ok(Some(0 | 1))))
    };
    let own = solution.limit_cycle.is_some() || solution.response.is_some();
    if !own && (solution.depends_on_amplitude() || !linear()) {
        needed.push(solution.amplitude.symbol());
    }
    needed
}

/// Judges `solution` at the values `at`.
///
/// # Errors
/// Missing or unknown values, or no true periodic motion there.
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
    judge_to(oscillator, solution, at, tolerance, VerificationScope::Range)
}

/// The extent of a verification.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VerificationScope {
    /// The motion at the values given, and nothing else: where motions are periodic, neither how
    /// its error grows nor how far the formula is good, which takes most of the time.
    Motion,
    /// All of it.
    Range,
}

/// As [`judge`], to this extent.
///
/// # Errors
/// As for [`judge`].
pub fn judge_to(
    oscillator: &Oscillator,
    solution: &Solution,
    at: &Values,
    tolerance: f64,
    extent: VerificationScope,
) -> Result<Verification, VerificationError> {
    let _letters = solution.letters().in_force();
    if let Some(relative) = in_another_coordinate(oscillator, solution)? {
        return judge_to(&relative, solution, at, tolerance, extent);
    }
    if let Some(motion) = solution.in_time() {
        return in_time::judge(oscillator, solution, motion, at, tolerance);
    }
    if let Some(response) = &solution.response {
        check_common_period(solution)?;
        return driven::judge(oscillator, solution, response, at, tolerance);
    }
    if let Some(moving) = off_cycle(solution, at) {
        return judge_to(oscillator, &moving, at, tolerance, extent);
    }
    if let Some((converted, in_words)) = in_convention_of(oscillator, solution, at)? {
        let mut judged = judge_to(oscillator, solution, &converted, tolerance, extent)?;
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
    let ranged = extent == VerificationScope::Range;
    let far = ranged.then(|| validity::ranges(oscillator, solution, &numbers, tolerance));
    let far = far.into_iter().flatten();
    Ok(Verification {
        at: at.clone(),
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
    match solution.coordinate() == oscillator.coordinate {
        true => Ok(None),
        false => Ok(Some(Oscillator::from_equation(&solution.equation)?)),
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

/// The loss of digits of the verdict by cancellation, where the formula is summed far out.
fn cancellation(
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    found: Option<&Numbers>,
    max_deviation: Option<f64>,
) -> Vec<validity::Range> {
    /// Relative errors of less are said to be less.
    const SHOWN: f64 = 1e-9;
    /// Deviations have three digits.
    const OF_DEVIATION: f64 = 5e-4;
    let said = |what: &str, rounding: f64, of: &str| validity::Range {
        text: format!(
            "terms of high order cancel here: rounding moves {what} by {} of {of}",
            significant(rounding, 1)
        ),
        outside: false,
    };
    let law = found.map(|found| found.rounding).filter(|rounding| *rounding > SHOWN);
    let value_of = |symbol: Symbol| numbers.get(&symbol).copied();
    let motion = max_deviation.zip(solution.rounding_of_motion_at(&value_of));
    let motion =
        motion.filter(|(deviation, rounding)| *rounding > (OF_DEVIATION * deviation).max(SHOWN));
    let law = law.map(|rounding| said(&format!("{FREQUENCY}^2"), rounding, "itself"));
    let motion = motion.map(|(_, rounding)| said("the motion", rounding, "the amplitude"));
    law.into_iter().chain(motion).collect()
}

/// An error if the amplitude of a free motion changes.
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

/// The symbol of the amplitude among the values: that of the start if the amplitude changes.
fn amplitude_symbol(solution: &Solution) -> Symbol {
    match solution.slow() {
        Some(_) => AmplitudeConvention::Initial.symbol(),
        None => solution.amplitude.symbol(),
    }
}

/// Whether a formula can be judged at these values.
///
/// # Errors
/// Missing or unknown values, or an amplitude of zero.
pub fn checked(solution: &Solution, at: &Values) -> Result<(), VerificationError> {
    checked_numbers(solution, at).map(|_| ())
}

/// Refuses an amplitude at which the force has no digits left. The distance from the equilibrium
/// counts, which is exact where the equilibrium is.
///
/// # Errors
/// [`LostDigits`].
fn check_digits(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Result<(), VerificationError> {
    let coordinate = oscillator.coordinate;
    let Some(amplitude) = numbers.get(&amplitude_symbol(solution)).copied() else {
        return Ok(());
    };
    let moved = Expr::from(coordinate) + solution.equilibrium.clone();
    let Ok(force) = oscillator.force.substitute(coordinate, &moved) else {
        return Ok(());
    };
    let mut there = numbers.clone();
    there.insert(coordinate, amplitude);
    there.extend([oscillator.velocity(), Symbol::new("t")].map(|name| (name, 0.0)));
    let of_amplitude = |lost: LostDigits| LostDigits { name: amplitude_symbol(solution), ..lost };
    Ok(force.check_digits(&there, &[coordinate]).map_err(of_amplitude)?)
}

/// The values as numbers.
///
/// # Errors
/// Missing or unknown values, or an amplitude of zero.
fn checked_numbers(
    solution: &Solution,
    at: &Values,
) -> Result<BTreeMap<Symbol, f64>, VerificationError> {
    let needed = needed_values(solution);
    let mut known = solution.parameters.clone();
    if solution.response.is_none() || solution.in_time().is_some() {
        known.push(amplitude_symbol(solution));
    }
    let start = AmplitudeConvention::Initial.symbol();
    if solution.limit_cycle.is_some() && !known.contains(&start) && at.get(start).is_some() {
        return Err(VerificationError::OffCycle);
    }
    if let Some((name, _)) = at.iter().find(|(name, _)| !known.contains(name)) {
        return Err(VerificationError::Unknown { name, known });
    }
    let missing: Vec<Symbol> = needed.into_iter().filter(|&name| at.get(name).is_none()).collect();
    if !missing.is_empty() {
        return Err(VerificationError::Missing(missing));
    }
    // If the frequency does not depend on the amplitude, any one will do to compare the motion.
    let amplitude_symbol = amplitude_symbol(solution);
    let numbers = at.with(amplitude_symbol, at.get(amplitude_symbol).unwrap_or(1.0));
    let may_rest = solution.limit_cycle.is_some() || solution.in_time().is_some();
    if !may_rest && numbers[&amplitude_symbol] == 0.0 {
        return Err(VerificationError::AtRest);
    }
    Ok(numbers)
}

/// Time, displacement and velocity, in the units of the equation.
pub type TimedState = (f64, f64, f64);

/// The motion by the formula and the true one, at the same instants of one true period.
pub struct Motions {
    /// The motion by the formula.
    pub formula: Vec<TimedState>,
    /// The motion by Runge-Kutta.
    pub truth: Vec<TimedState>,
    /// Motions whose amplitude changes: times and places of its two envelopes by the formula.
    pub envelope: Option<[Vec<(f64, f64)>; 2]>,
}

/// The motion by the formula and the true one, at the same instants of one true period, or as long
/// as a motion that is not periodic is judged; `None` if the formula's frequency is not real.
///
/// # Errors
/// As for [`judge`].
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
/// As for [`judge`].
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

/// The values as numbers, the amplitude 1 where it is left out.
fn numbers_of_motion(solution: &Solution, at: &Values) -> BTreeMap<Symbol, f64> {
    let symbol = amplitude_symbol(solution);
    at.with(symbol, at.get(symbol).unwrap_or(1.0))
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

/// omega by the formula: the root of omega^2, `None` if that is not positive.
fn formula_frequency(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Option<f64> {
    formula_frequency_along(oscillator, solution, numbers, &NumbersCache::default())
}

/// As [`formula_frequency`] for one amplitude after the other, all else being the same.
fn formula_frequency_along(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    known: &NumbersCache,
) -> Option<f64> {
    let squared = frequency_squared_along(oscillator, solution, numbers, known).ok()?;
    (squared > 0.0 && squared.is_finite()).then(|| squared.sqrt())
}

/// The numbers of a formula whose frequency is real, or why there are none.
fn numbers_or_reason(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> (Option<Numbers>, Option<NoNumbers>) {
    match evaluate(oscillator, solution, numbers) {
        Ok(found) if found.frequency_squared > 0.0 && found.frequency_squared.is_finite() => {
            (Some(found), None)
        }
        Ok(_) => (None, Some(NoNumbers::not_positive(solution))),
        Err(NoNumbers::NoValue | NoNumbers::Undefined { .. })
            if law_overflows(solution, numbers) =>
        {
            let law = law_name(solution);
            (None, Some(NoNumbers::LawBeyond { law }))
        }
        Err(reason) => (None, Some(reason)),
    }
}

/// Whether the law has no value because a part of it is larger than any number.
fn law_overflows(solution: &Solution, numbers: &BTreeMap<Symbol, f64>) -> bool {
    let law = match (solution.law.closed_form(), solution.law.frequency_squared()) {
        (Some(form), _) => form.value.clone(),
        (None, Some(squared)) => Expr::from(squared),
        (None, None) => return false,
    };
    law.overflow(numbers).is_some()
}

/// omega by its own series, where the formula has one of omega^2 as well.
fn series_of_omega(solution: &Solution, numbers: &BTreeMap<Symbol, f64>) -> Option<f64> {
    solution.law.frequency_squared()?;
    let series = solution.law.frequency()?;
    solution.evaluate(series, &|symbol| numbers.get(&symbol).copied()).ok()
}

/// omega, the motion by the formula in theta, and what was chosen for it.
fn formula_motion(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Option<(f64, FourierSeries<Doubles>)> {
    let found = evaluate(oscillator, solution, numbers).ok()?;
    Some((found.frequency_squared.sqrt(), found.motion?))
}

/// Returns the true motion that an answer is meant for.
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

/// The exponent with which the error of the frequency vanishes: the small parameter is halved until
/// rounding begins to matter, and the slopes between halvings, which approach their limit linearly,
/// are carried on to zero.
fn slope(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Option<f64> {
    const HALVINGS: i32 = 12;
    // Motions over several wells do not become small.
    if validity::is_over_several_wells(oscillator, solution, numbers) {
        return None;
    }
    let varied = with_small_parameter(oscillator, solution, numbers);
    let (oscillator, solution, numbers) = match &varied {
        Some((oscillator, solution, numbers)) => (oscillator, solution, numbers),
        None => (oscillator, solution, numbers),
    };
    // The truth is good to 1e-15 by quadrature, 1e-12 by one in pieces and 1e-11 by Runge-Kutta: an
    // error hundreds of times that is measured to less than a per cent.
    let conservative = oscillator.of_position_alone();
    let amplitude = numbers.get(&solution.amplitude.symbol()).copied().unwrap_or(1.0);
    let equilibrium = solution.equilibrium.evaluate(numbers).unwrap_or(0.0);
    let features = Features::new(&oscillator.force, oscillator.coordinate, numbers);
    let pieces = !features.cuts(equilibrium - amplitude, equilibrium + amplitude).is_empty();
    let floor = match (conservative, pieces) {
        (true, false) => 2e-13,
        (true, true) => 1e-10,
        (false, _) => 1e-8,
    };
    let formula_at = |factor: f64| {
        let mut numbers = numbers.clone();
        for small in solution.small_parameters() {
            *numbers.get_mut(&small)? *= factor;
        }
        Some((formula_frequency(oscillator, solution, &numbers)?, numbers))
    };
    let error = |halving: i32| {
        let factor = 0.5_f64.powi(halving);
        let (formula, numbers) = formula_at(factor)?;
        let truth =
            true_frequency(oscillator, &orbit_target(oscillator, solution, &numbers), &numbers)
                .ok()?;
        let error = (formula / truth - 1.0).abs();
        // A closed form such as (cos(A) - 1)/A^2 loses digits at small amplitudes: what a change of
        // the last bits does to it is no error of the formula.
        let shakes = if solution.law.closed_form().is_some() { 4 } else { 0 };
        let shaken = (1..=shakes).filter_map(|k| formula_at(factor * (1.0 + f64::from(k) * 1e-14)));
        let noise = shaken.map(|(shaken, _)| (shaken / formula - 1.0).abs()).fold(0.0, f64::max);
        Some(if error > 100.0 * noise { error } else { 0.0 })
    };
    let errors: Vec<f64> =
        (0..HALVINGS).filter_map(error).take_while(|error| *error >= floor).collect();
    slopes_of(&errors)
}

/// The exponent of errors of which each belongs to half of what the one before does: the slopes
/// between them, which approach their limit linearly, carried on to zero.
fn slopes_of(errors: &[f64]) -> Option<f64> {
    let slopes: Vec<f64> = errors.windows(2).map(|pair| (pair[0] / pair[1]).log2()).collect();
    match *slopes.as_slice() {
        [.., before, last] if (last - before).abs() < 0.5 => Some(2.0 * last - before),
        [.., last] => Some(last),
        [] => None,
    }
}

/// If the small parameter marks terms with numbers before them, returns the equation with that
/// parameter in it, so that it can be varied: every term but the linear restoring force is
/// multiplied by `delta / value`.
fn with_small_parameter(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Option<(Oscillator, Solution, BTreeMap<Symbol, f64>)> {
    let delta = solution.small_parameter;
    let own = solution.definitions.iter().find(|definition| definition.symbol == delta)?;
    let known = solution.definitions.iter();
    let known = known.map(|definition| (definition.symbol, definition.meaning.clone())).collect();
    let stiffness = Expr::from(&solution.leading(solution.law.frequency_squared()?));
    let stiffness = stiffness.substitute_all(&known).ok()?;
    let linear = &stiffness * &(&Expr::from(oscillator.coordinate) - &solution.equilibrium);
    let factor = Expr::divide(&Expr::from(delta), &own.meaning).ok()?;
    let (mut oscillator, mut varied, mut numbers) =
        (oscillator.clone(), solution.clone(), numbers.clone());
    oscillator.force = &linear + &(&factor * &(&oscillator.force - &linear));
    oscillator.parameters.push(delta);
    varied.definitions.retain(|definition| definition.symbol != delta);
    varied.parameters.push(delta);
    numbers.insert(delta, own.meaning.evaluate(&BTreeMap::new()).ok()?);
    Some((oscillator, varied, numbers))
}
