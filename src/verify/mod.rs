//! The judge: a formula against the true motion of the *original* equation.
//!
//! In: the equation, the answer of a method, numbers for all symbols, a tolerance. Out: a [`Verification`] with errors relative to
//! the truth, a [`Verdict`] and the ranges in which the formula holds; in [`comparison`] the same for every method at once. Where
//! there is no true periodic motion, a [`VerificationError`] says why.
//!
//! Nothing here looks at how a formula was derived. The true frequency comes from energy quadrature where energy is
//! conserved and from the Runge-Kutta return where it is not; the motion from Runge-Kutta with dense output on the
//! equation as it was typed, sine and all, not on its truncation.
//!
//! ```text
//! relative_error = omega_formula / omega_true - 1
//! max_deviation  = max |x_true(t) - x_formula(t)| / |A|      over one true period, in real time
//! residual       = rms of x'' + f(x, x') along the formula / rms of f
//! slope          = log2( error(delta) / error(delta/2) )     -> the exponent of the first missing term
//! ```

mod amplitude_series;
mod bounds;
pub mod comparison;
pub(crate) mod convergence;
mod reach;
pub(crate) mod validity;
pub(crate) mod well;

pub use convergence::{Singularity, nearest_singularity};
pub use validity::{Range, Reach};
pub use well::{End, Well};

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use crate::conservative::features::Features;
use crate::conservative::force::Force as RestForce;
use crate::decimal::decimal;
use crate::exact::Doubles;
use crate::exact::rational::Rational;
use crate::expr::{CompiledFunction, EvaluationError, Expr, ExprError};
use crate::method::numbers::{NoNumbers, Numbers, evaluate, frequency_squared_of, half_a_period, symbol_values};
use crate::numeric::ode::root::find_root;
use crate::numeric::period::{self, PeriodError, Swing};
use crate::numeric::return_map::{Equation, LimitCycle, NoLimitCycle, nearest_limit_cycle};
use crate::oscillator::{Oscillator, OscillatorError};
use crate::series::FourierSeries;
use crate::solution::{AmplitudeConvention, Method, Solution};
use crate::symbol::Symbol;
use crate::values::Values;

/// The error of the frequency below which a formula passes when the user names no tolerance: 1 %.
pub const DEFAULT_TOLERANCE: f64 = 0.01;

/// Points per period on which deviation and residual are taken.
const SAMPLES: usize = 1024;

/// The formula's verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The frequency is within the tolerance.
    Pass,
    /// It is not, or it is not real.
    Fail,
}

impl Verdict {
    /// Passed or not.
    pub fn of(passed: bool) -> Self {
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
    /// omega by the formula, in the unit of time of the equation; `None` where there is none.
    pub frequency: Option<f64>,
    /// Why there is none.
    pub reason: Option<NoNumbers>,
    /// omega of the true motion.
    pub true_frequency: f64,
    /// `frequency / true_frequency - 1`.
    pub relative_error: Option<f64>,
    /// Which law the frequency comes from: `omega^2`, of which it is the root, or `omega`.
    pub judged_on: &'static str,
    /// The error of the other law, the series of omega itself, where the formula has both.
    pub error_of_omega: Option<f64>,
    /// Largest deviation over one true period, as a part of the amplitude.
    pub max_deviation: Option<f64>,
    /// Root mean square of the equation's residual along the formula, over that of its force.
    pub residual: Option<f64>,
    /// Measured exponent of the frequency error; `None` where rounding hides it.
    pub slope: Option<f64>,
    /// Where the formula holds, in words and numbers; what lies outside is marked.
    pub ranges: Vec<validity::Range>,
    /// Values that the method left open: hbar as it was chosen, the coefficients of a balance as they were solved for.
    pub chosen: Vec<(Symbol, f64)>,
    /// The value of every symbol of the formulas, `omega` and `pi` included; those that have no real value are left out.
    pub values: Vec<(Symbol, f64)>,
    /// theta at `t = 0`: pi for a negative amplitude whose size stands in `values`, else 0.
    pub phase: f64,
    /// The motion in theta; `None` where the frequency is not real or the motion is not known.
    pub motion: Option<FourierSeries<Doubles>>,
    /// The verdict on the frequency.
    pub verdict: Verdict,
}

/// Why a formula could not be judged.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum VerificationError {
    /// Values are missing.
    #[error("to judge the formula, values are needed for: {}", .0.iter().map(|name| name.name()).collect::<Vec<_>>().join(", "))]
    Missing(Vec<Symbol>),
    /// A value for a symbol that does not occur.
    #[error("`{name}` does not occur in the formula; it has: {}", .known.iter().map(|name| name.name()).collect::<Vec<_>>().join(", "))]
    Unknown {
        /// The name.
        name: Symbol,
        /// The names that do occur.
        known: Vec<Symbol>,
    },
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
                PeriodError::NoReturn(_)
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

/// The symbols that need a value before `solution` can be judged.
///
/// ```
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
    // A law such as omega^2 = 1 for x'' + x + x^2 = 0 is free of A where the true motion is not.
    let linear = || {
        let oscillator = Oscillator::from_equation(&solution.equation);
        oscillator.is_ok_and(|oscillator| matches!(oscillator.polynomial_degree(), Ok(Some(0 | 1))))
    };
    if solution.limit_cycle.is_none() && (solution.depends_on_amplitude() || !linear()) {
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
    let numbers = checked_numbers(solution, at)?;
    let truth = TrueMotion::of(oscillator, solution, &numbers)?;
    let (found, reason) = numbers_or_reason(oscillator, solution, &numbers);
    let frequency = found.as_ref().map(|found| found.frequency_squared.sqrt());
    let relative_error = frequency.map(|frequency| frequency / truth.frequency - 1.0);
    let motion = frequency.zip(found.as_ref().and_then(|found| found.motion.clone()));
    let max_deviation = motion
        .as_ref()
        .and_then(|(frequency, motion)| truth.largest_deviation(*frequency, motion));
    let physics = Physics::new(oscillator, solution, &numbers)?;
    let residual = motion
        .as_ref()
        .map(|(frequency, motion)| residual(&physics, *frequency, motion));
    let pass = relative_error.is_some_and(|error| error.abs() <= tolerance);
    let remark = found.as_ref().and_then(|found| found.remark.clone());
    let remark = remark.map(|text| validity::Range { text, outside: false });
    let symbols = symbol_values(oscillator, solution, &numbers, found.as_ref());
    Ok(Verification {
        at: at.clone(),
        frequency,
        reason,
        true_frequency: truth.frequency,
        relative_error,
        judged_on: judged_on(solution),
        error_of_omega: series_of_omega(solution, &numbers).map(|omega| omega / truth.frequency - 1.0),
        max_deviation,
        residual: residual.filter(|value| value.is_finite()),
        slope: slope(oscillator, solution, &numbers),
        ranges: truth
            .about_the_cycle(solution.coordinate())
            .filter(|_| attraction(solution, &numbers) != Some(0.0))
            .into_iter()
            .chain(remark)
            .chain(validity::ranges(oscillator, solution, &numbers, tolerance))
            .collect(),
        chosen: found.map_or_else(Vec::new, |found| found.chosen),
        values: symbols.values,
        phase: symbols.phase,
        // The motion of the size of the amplitude, which begins half a period later.
        motion: motion.map(|(_, motion)| match symbols.phase == 0.0 {
            true => motion,
            false => motion.by_harmonic(half_a_period),
        }),
        verdict: Verdict::of(pass),
    })
}

/// The values as numbers.
///
/// # Errors
/// Missing or unknown values, or an amplitude of zero.
fn checked_numbers(solution: &Solution, at: &Values) -> Result<BTreeMap<Symbol, f64>, VerificationError> {
    let needed = needed_values(solution);
    let mut known = solution.parameters.clone();
    known.push(solution.amplitude.symbol());
    if let Some((name, _)) = at.iter().find(|(name, _)| !known.contains(name)) {
        return Err(VerificationError::Unknown { name, known });
    }
    let missing: Vec<Symbol> = needed.into_iter().filter(|&name| at.get(name).is_none()).collect();
    if !missing.is_empty() {
        return Err(VerificationError::Missing(missing));
    }
    // Where the frequency does not depend on the amplitude, any will do to compare the motion.
    let amplitude_symbol = solution.amplitude.symbol();
    let numbers = at.with(amplitude_symbol, at.get(amplitude_symbol).unwrap_or(1.0));
    if solution.limit_cycle.is_none() && numbers[&amplitude_symbol] == 0.0 {
        return Err(VerificationError::AtRest);
    }
    Ok(numbers)
}

/// Time, displacement and velocity, in the units of the equation.
pub type Sample = (f64, f64, f64);

/// The motion by the formula and the true one, at the same instants of one true period.
pub struct Motions {
    /// By the formula.
    pub formula: Vec<Sample>,
    /// By Runge-Kutta.
    pub truth: Vec<Sample>,
}

/// The motion by the formula and the true one, at the same instants of one true period; `None` where the formula's
/// frequency is not real.
///
/// # Errors
/// As for [`judge`].
///
/// ```
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
    let symbol = solution.amplitude.symbol();
    let numbers = at.with(symbol, at.get(symbol).unwrap_or(1.0));
    let truth = TrueMotion::of(oscillator, solution, &numbers)?;
    let Some((frequency, motion)) = formula_motion(oscillator, solution, &numbers) else {
        return Ok(None);
    };
    let velocity = motion.derivative();
    let times = (0..=SAMPLES).map(|k| truth.period() * k as f64 / SAMPLES as f64);
    let formula = |t: f64| {
        (
            t,
            motion.evaluate(frequency * t),
            frequency * velocity.evaluate(frequency * t),
        )
    };
    Ok(Some(Motions {
        formula: times.clone().map(formula).collect(),
        truth: times.map(|t| truth.sample(t)).collect(),
    }))
}

/// omega by the formula: the root of omega^2, `None` where that is not positive.
fn formula_frequency(oscillator: &Oscillator, solution: &Solution, numbers: &BTreeMap<Symbol, f64>) -> Option<f64> {
    let squared = frequency_squared_of(oscillator, solution, numbers).ok()?;
    (squared > 0.0 && squared.is_finite()).then(|| squared.sqrt())
}

/// The numbers of a formula whose frequency is real, or why there are none.
fn numbers_or_reason(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> (Option<Numbers>, Option<NoNumbers>) {
    match evaluate(oscillator, solution, numbers) {
        Ok(found) if found.frequency_squared > 0.0 && found.frequency_squared.is_finite() => (Some(found), None),
        Ok(_) => (None, Some(NoNumbers::NotReal)),
        Err(NoNumbers::NoValue | NoNumbers::Undefined { .. }) if law_overflows(solution, numbers) => {
            let law = judged_on(solution);
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

/// The law that [`formula_frequency`] takes.
fn judged_on(solution: &Solution) -> &'static str {
    // What is solved by numbers gives omega itself, but for the one-term laws, which are integrals for omega^2.
    let by_integral = solution.law.quadrature().is_some() && solution.method != Method::Exact;
    match solution.law.closed_form() {
        _ if solution.law.frequency_squared().is_some() || solution.law.relation().is_some() || by_integral => {
            "omega^2"
        }
        Some(form) => form.name(),
        None => "omega",
    }
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

/// One period of a true motion, from a turning point.
enum Orbit {
    Swing(Swing),
    LimitCycle(LimitCycle),
}

impl Orbit {
    fn period(&self) -> f64 {
        match self {
            Self::Swing(path) => path.period(),
            Self::LimitCycle(cycle) => cycle.period(),
        }
    }

    /// Displacement and velocity, `t` between zero and the period.
    fn at(&self, t: f64) -> (f64, f64) {
        match self {
            Self::Swing(path) => path.at(t).unwrap_or((f64::NAN, f64::NAN)),
            Self::LimitCycle(cycle) => cycle.at(t),
        }
    }
}

/// The true periodic motion that a formula is meant for.
struct TrueMotion {
    frequency: f64,
    /// `None` where the energy gives the period but Runge-Kutta cannot follow the motion.
    orbit: Option<Orbit>,
    /// The instant of the path that is `t = 0` of the formula.
    shift: f64,
    amplitude: f64,
}

impl TrueMotion {
    fn of(
        oscillator: &Oscillator,
        solution: &Solution,
        numbers: &BTreeMap<Symbol, f64>,
    ) -> Result<Self, VerificationError> {
        /// How well the Runge-Kutta return and the energy must agree for the path to be used.
        const AGREEMENT: f64 = 1e-6;
        let physics = Physics::new(oscillator, solution, numbers)?;
        if solution.limit_cycle.is_some() {
            let cycle = physics.limit_cycle(solution, numbers)?;
            let frequency = TAU / cycle.period();
            let orbit = Orbit::LimitCycle(cycle);
            let equilibrium = physics.rest.equilibrium();
            return Ok(Self::from_orbit(solution, numbers, orbit, frequency, equilibrium));
        }
        let start = physics.start(solution, numbers)?;
        if physics.by_energy() && solution.amplitude == AmplitudeConvention::Initial {
            // The energy knows first whether there is an orbit at all, and says why not.
            let period = physics.rest.period(start)?;
            let path = physics.swing(start, 2.0 * period).ok();
            let path = path.filter(|path| (path.period() / period - 1.0).abs() < AGREEMENT);
            return Ok(Self {
                frequency: TAU / period,
                orbit: path.map(Orbit::Swing),
                shift: 0.0,
                amplitude: start.abs(),
            });
        }
        let path = physics.swing(start, physics.longest)?;
        let frequency = match physics.by_energy() {
            true => TAU / physics.rest.period(start)?,
            false => TAU / path.period(),
        };
        let equilibrium = physics.rest.equilibrium();
        Ok(Self::from_orbit(
            solution,
            numbers,
            Orbit::Swing(path),
            frequency,
            equilibrium,
        ))
    }

    fn from_orbit(
        solution: &Solution,
        numbers: &BTreeMap<Symbol, f64>,
        orbit: Orbit,
        frequency: f64,
        equilibrium: f64,
    ) -> Self {
        let shift = match solution.amplitude {
            AmplitudeConvention::Initial => 0.0,
            AmplitudeConvention::FirstHarmonic => {
                let (cosine, sine) = first_harmonic(&orbit);
                sine.atan2(cosine) / TAU * orbit.period()
            }
        };
        let amplitude = match (solution.amplitude, &solution.limit_cycle) {
            (AmplitudeConvention::FirstHarmonic, None) => numbers[&solution.amplitude.symbol()].abs(),
            _ => (orbit.at(0.0).0 - equilibrium).abs(),
        };
        Self {
            frequency,
            orbit: Some(orbit),
            shift,
            amplitude,
        }
    }

    /// Where a true limit cycle lies and what it does to its neighbours.
    fn about_the_cycle(&self, coordinate: Symbol) -> Option<validity::Range> {
        let Some(Orbit::LimitCycle(cycle)) = &self.orbit else {
            return None;
        };
        let does = if cycle.attracts() { "attracts" } else { "repels" };
        Some(validity::Range {
            text: format!(
                "the true limit cycle turns at {coordinate} = {} and {does}",
                decimal(cycle.at(0.0).0)
            ),
            outside: false,
        })
    }

    fn period(&self) -> f64 {
        self.orbit.as_ref().map_or(TAU / self.frequency, Orbit::period)
    }

    /// The true motion at the time `t` of the formula.
    fn sample(&self, t: f64) -> Sample {
        let place = (t + self.shift).rem_euclid(self.period());
        let (x, v) = self
            .orbit
            .as_ref()
            .map_or((f64::NAN, f64::NAN), |orbit| orbit.at(place));
        (t, x, v)
    }

    /// Largest `|x_true - x_formula|` over one true period, over the amplitude; `None` where the path is not known.
    fn largest_deviation(&self, frequency: f64, motion: &FourierSeries<Doubles>) -> Option<f64> {
        self.orbit.as_ref()?;
        let deviation = |index: usize| {
            let t = self.period() * index as f64 / SAMPLES as f64;
            (self.sample(t).1 - motion.evaluate(frequency * t)).abs()
        };
        let largest = (0..=SAMPLES).map(deviation).fold(0.0, f64::max) / self.amplitude;
        largest.is_finite().then_some(largest)
    }
}

/// The equation with numbers for its parameters, seen from its equilibrium.
struct Physics {
    /// The force at rest.
    rest: RestForce,
    /// What velocities add to it, as a function of position and velocity; `None` where the period follows from the energy.
    moving: Option<CompiledFunction>,
    longest: f64,
}

impl Physics {
    fn new(
        oscillator: &Oscillator,
        solution: &Solution,
        numbers: &BTreeMap<Symbol, f64>,
    ) -> Result<Self, VerificationError> {
        let parts = oscillator.parts()?;
        let velocities = [parts.inertia, parts.damping, parts.forcing];
        let amplitude = numbers.get(&solution.amplitude.symbol()).copied().unwrap_or(1.0);
        let (x, v) = (oscillator.coordinate, oscillator.velocity());
        let (at_rest, moving) = match velocities.iter().all(Expr::is_zero) {
            true => (oscillator.force.clone(), None),
            false => {
                let moving = with_numbers(oscillator, &Expr::sum(velocities), numbers)?;
                (parts.restoring, Some(CompiledFunction::new(&moving, &[x, v])?))
            }
        };
        solution.equilibrium.evaluate(numbers)?;
        let rest = RestForce::new(&at_rest, x, &solution.equilibrium, numbers, amplitude);
        let mut physics = Self {
            rest: rest.ok_or_else(|| VerificationError::Missing(needed_values(solution)))?,
            moving,
            longest: f64::INFINITY,
        };
        // A thousand periods of the formula, or of a linear force as strong at the start: a motion that has not turned by
        // then is not swinging.
        let by_formula = match physics.by_energy() {
            true => None,
            false => formula_frequency(oscillator, solution, numbers),
        };
        let slowest = match by_formula {
            Some(frequency) => frequency,
            None => {
                let rate = (physics.force_at(amplitude, 0.0) / amplitude).abs().sqrt();
                if rate.is_normal() { rate } else { 1.0 }
            }
        };
        physics.longest = 1000.0 * TAU / slowest;
        Ok(physics)
    }

    /// Whether the period follows from the energy.
    fn by_energy(&self) -> bool {
        self.moving.is_none()
    }

    /// The force at a distance from the equilibrium and a velocity.
    fn force_at(&self, y: f64, v: f64) -> f64 {
        let position = self.rest.equilibrium() + y;
        let moving = self.moving.as_ref().map_or(0.0, |moving| moving.call(&[position, v]));
        self.rest.at(y) + moving
    }

    /// One swing by Runge-Kutta, in positions.
    fn swing(&self, start: f64, longest: f64) -> Result<Swing, PeriodError> {
        let end = match self.by_energy() {
            true => self.rest.turning_point(start)?,
            false => -start,
        };
        let acceleration = |_: f64, y: f64, v: f64| -self.force_at(y, v);
        let origin = self.rest.equilibrium();
        let cuts = self.rest.cuts(start, end);
        let swing = period::swing_with_cuts(&acceleration, &cuts, 0.0, start, longest)?;
        Ok(swing.moved(origin))
    }

    /// The true limit cycle nearest to the amplitude that the formula has where the small parameter vanishes.
    fn limit_cycle(
        &self,
        solution: &Solution,
        numbers: &BTreeMap<Symbol, f64>,
    ) -> Result<LimitCycle, VerificationError> {
        let at_rest = solution
            .limit_cycle
            .as_ref()
            .map(|cycle| solution.leading(&cycle.amplitude));
        let amplitude = at_rest.and_then(|law| solution.evaluate(&law, &|symbol| numbers.get(&symbol).copied()).ok());
        let amplitude = amplitude.map(f64::abs).filter(|size| size.is_normal()).unwrap_or(1.0);
        let equilibrium = self.rest.equilibrium();
        let step = 1e-3 * amplitude;
        let slope = (self.rest.at(step) - self.rest.at(-step)) / (2.0 * step);
        let equation = Equation {
            acceleration: &|x, v| -self.force_at(x - equilibrium, v),
            equilibrium,
            amplitude,
            frequency: if slope.sqrt().is_normal() { slope.sqrt() } else { 1.0 },
        };
        // Of cycles close to each other it is the one that attracts as the formula says.
        let attracts = attraction(solution, numbers)
            .filter(|value| *value != 0.0)
            .map(|value| value > 0.0);
        Ok(nearest_limit_cycle(&equation, attracts)?)
    }

    /// The distance from the equilibrium to start from: given, or found so that the first harmonic of the
    /// true motion has the amplitude asked for.
    fn start(&self, solution: &Solution, numbers: &BTreeMap<Symbol, f64>) -> Result<f64, VerificationError> {
        let amplitude = numbers[&solution.amplitude.symbol()];
        if solution.amplitude == AmplitudeConvention::Initial {
            return Ok(amplitude);
        }
        let excess = |start: f64| {
            let path = self.swing(start, self.longest);
            path.map_or(f64::NAN, |path| first_harmonic(&Orbit::Swing(path)).0 - amplitude)
        };
        let at = |factor: f64| factor * amplitude;
        for spread in [0.05, 0.2, 0.5] {
            if let Ok(start) = find_root(excess, at(1.0 - spread), at(1.0 + spread)) {
                return Ok(start);
            }
        }
        Err(PeriodError::NoReturn(self.longest).into())
    }
}

/// What is positive where the limit cycle of a formula attracts, negative where it repels, and zero where the amplitude is free.
fn attraction(solution: &Solution, numbers: &BTreeMap<Symbol, f64>) -> Option<f64> {
    let cycle = solution.limit_cycle.as_ref()?;
    let own = cycle.cycles.get(cycle.number.wrapping_sub(1))?;
    let mut numbers = numbers.clone();
    // A small parameter that only marks terms is positive.
    numbers.entry(solution.small_parameter).or_insert(1.0);
    own.attracts_where.as_ref()?.evaluate(&numbers).ok()
}

/// An expression with exact numbers in place of the parameters.
fn with_numbers(
    oscillator: &Oscillator,
    expression: &Expr,
    numbers: &BTreeMap<Symbol, f64>,
) -> Result<Expr, ExprError> {
    let exact = |name: &Symbol| Rational::from_float(numbers[name]).map(|value| (*name, Expr::number(value)));
    let values = oscillator.parameters.iter().filter_map(exact).collect();
    expression.substitute_all(&values)
}

/// `(2/T) int x cos, (2/T) int x sin` over one period, by the trapezoidal rule, which is exact to rounding here.
fn first_harmonic(orbit: &Orbit) -> (f64, f64) {
    let period = orbit.period();
    let sample = |k: usize| {
        let phase = k as f64 / SAMPLES as f64;
        let x = orbit.at(period * phase).0;
        (x * (TAU * phase).cos(), x * (TAU * phase).sin())
    };
    let sum = (0..SAMPLES)
        .map(sample)
        .fold((0.0, 0.0), |sum, (c, s)| (sum.0 + c, sum.1 + s));
    (2.0 * sum.0 / SAMPLES as f64, 2.0 * sum.1 / SAMPLES as f64)
}

fn residual(physics: &Physics, frequency: f64, motion: &FourierSeries<Doubles>) -> f64 {
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

/// The exponent with which the error of the frequency vanishes: the small parameter is halved until rounding begins to
/// matter, and the slopes between halvings, which approach their limit linearly, are carried on to zero.
fn slope(oscillator: &Oscillator, solution: &Solution, numbers: &BTreeMap<Symbol, f64>) -> Option<f64> {
    const HALVINGS: i32 = 12;
    let varied = with_small_parameter(oscillator, solution, numbers);
    let (oscillator, solution, numbers) = match &varied {
        Some((oscillator, solution, numbers)) => (oscillator, solution, numbers),
        None => (oscillator, solution, numbers),
    };
    // The truth is good to 1e-15 by quadrature, 1e-12 by one in pieces and 1e-11 by Runge-Kutta: an error hundreds of times
    // that is measured to less than a per cent.
    let parts = oscillator.parts().ok()?;
    let conservative = parts.inertia.is_zero() && parts.damping.is_zero();
    let amplitude = numbers.get(&solution.amplitude.symbol()).copied().unwrap_or(1.0);
    let equilibrium = solution.equilibrium.evaluate(numbers).unwrap_or(0.0);
    let features = Features::new(&oscillator.force, oscillator.coordinate, numbers);
    let pieces = !features
        .cuts(equilibrium - amplitude, equilibrium + amplitude)
        .is_empty();
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
        let truth = true_frequency(oscillator, solution, &numbers).ok()?;
        let error = (formula / truth - 1.0).abs();
        // A closed form such as (cos(A) - 1)/A^2 loses digits at small amplitudes: what a change of the last bits does
        // to it is no error of the formula.
        let shakes = if solution.law.closed_form().is_some() { 4 } else { 0 };
        let shaken = (1..=shakes).filter_map(|k| formula_at(factor * (1.0 + f64::from(k) * 1e-14)));
        let noise = shaken
            .map(|(shaken, _)| (shaken / formula - 1.0).abs())
            .fold(0.0, f64::max);
        Some(if error > 100.0 * noise { error } else { 0.0 })
    };
    let errors: Vec<f64> = (0..HALVINGS)
        .filter_map(error)
        .take_while(|error| *error >= floor)
        .collect();
    let slopes: Vec<f64> = errors.windows(2).map(|pair| (pair[0] / pair[1]).log2()).collect();
    match *slopes.as_slice() {
        [.., before, last] if (last - before).abs() < 0.5 => Some(2.0 * last - before),
        [.., last] => Some(last),
        [] => None,
    }
}

/// Where the small parameter marks terms with numbers before them: the equation with that parameter in it, so that it can be
/// varied. What is not the linear restoring force is multiplied by `delta / value`.
fn with_small_parameter(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Option<(Oscillator, Solution, BTreeMap<Symbol, f64>)> {
    let delta = solution.small_parameter;
    let own = solution
        .definitions
        .iter()
        .find(|definition| definition.symbol == delta)?;
    let known = solution.definitions.iter();
    let known = known
        .map(|definition| (definition.symbol, definition.meaning.clone()))
        .collect();
    let stiffness = Expr::from(&solution.leading(solution.law.frequency_squared()?));
    let stiffness = stiffness.substitute_all(&known).ok()?;
    let linear = &stiffness * &(&Expr::from(oscillator.coordinate) - &solution.equilibrium);
    let factor = Expr::divide(&Expr::from(delta), &own.meaning).ok()?;
    let (mut oscillator, mut varied, mut numbers) = (oscillator.clone(), solution.clone(), numbers.clone());
    oscillator.force = &linear + &(&factor * &(&oscillator.force - &linear));
    oscillator.parameters.push(delta);
    varied.definitions.retain(|definition| definition.symbol != delta);
    varied.parameters.push(delta);
    numbers.insert(delta, own.meaning.evaluate(&BTreeMap::new()).ok()?);
    Some((oscillator, varied, numbers))
}

/// omega of the true motion, without its path where energy alone gives it.
fn true_frequency(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Result<f64, VerificationError> {
    let physics = Physics::new(oscillator, solution, numbers)?;
    if physics.by_energy() && solution.amplitude == AmplitudeConvention::Initial {
        return Ok(TAU / physics.rest.period(physics.start(solution, numbers)?)?);
    }
    TrueMotion::of(oscillator, solution, numbers).map(|truth| truth.frequency)
}
