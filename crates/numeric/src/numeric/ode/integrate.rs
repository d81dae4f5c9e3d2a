//! The run itself: it takes a step, looks for events in the step, and restarts where the right side
//! switches.
//!
//! A step whose rates are not finite is repeated with a smaller length. Of the crate
//! `differential-equations` only Radau's steps are used, and the coefficients of Verner's: its event
//! handling misses two crossings in one step.

mod to_event;

use std::cell::Cell;

use differential_equations::ode::{ODE, OrdinaryNumericalMethod};
use differential_equations::status::Status;
use thiserror::Error;

use super::State;
use super::event::{Action, Event, SignTracker};
use super::sample::{Point, Sample, StateVector};
use super::scheme::{Scheme, explicit, implicit};
use super::trajectory::{
    EventOccurrence, FRACTIONS, StopReason, TERMS, Trajectory, TrajectoryStep,
};
use super::verner::VernerSteps;
use crate::interrupt::Interrupt;
use to_event::StepToEnd;

/// Tolerances and limits of an integration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IntegrationOptions {
    /// Error allowed per step relative to the size of each value.
    pub relative_tolerance: f64,
    /// Absolute error allowed per step in addition, in the units of the values: choose it well
    /// below their size.
    pub absolute_tolerance: f64,
    /// Steps, rejected ones included, after which the run gives up. Each accepted step keeps about
    /// 200 bytes.
    pub maximum_steps: usize,
    /// First step, in units of time; 0: chosen by the rates.
    pub first_step: f64,
    /// Longest step, in units of time: infinity, unless a right side or an event varies faster than
    /// the motion.
    pub maximum_step: f64,
    /// Whether the motion has parts of very different speed: an implicit method of lower order then
    /// takes longer steps.
    pub stiff: bool,
    /// The request to stop the run.
    pub interrupt: Interrupt,
}

impl Default for IntegrationOptions {
    /// Tolerances of 1e-10, 200 000 steps of any length.
    fn default() -> Self {
        Self::with_tolerance(1e-10)
    }
}

impl IntegrationOptions {
    /// Options with one number as relative and absolute tolerance, the rest as in the default.
    pub fn with_tolerance(tolerance: f64) -> Self {
        Self {
            relative_tolerance: tolerance,
            absolute_tolerance: tolerance,
            maximum_steps: 200_000,
            first_step: 0.0,
            maximum_step: f64::INFINITY,
            stiff: false,
            interrupt: Interrupt::default(),
        }
    }
}

/// A smooth right side and the events to look for while it is in force.
pub struct IntegrationPhase<'a, S: Sample = State> {
    rates: Box<RateFunction<'a, S>>,
    events: Vec<Event<'a, S>>,
}

/// Writes the rates of the values at a time.
type RateFunction<'a, S> = dyn Fn(f64, &<S as Sample>::Values, &mut <S as Sample>::Values) + 'a;

impl<'a> IntegrationPhase<'a> {
    /// The acceleration g(t, x, v) and the events of this phase.
    pub fn new(acceleration: impl Fn(f64, f64, f64) -> f64 + 'a, events: Vec<Event<'a>>) -> Self {
        let rates = Box::new(first_order(acceleration));
        Self { rates, events }
    }
}

/// x'' = g(t, x, v) as x' = v, v' = g.
fn first_order(
    acceleration: impl Fn(f64, f64, f64) -> f64,
) -> impl Fn(f64, &[f64; 2], &mut [f64; 2]) {
    move |t, &[x, v], rates| *rates = [v, acceleration(t, x, v)]
}

/// An error that prevents a run from the outset. A run that has begun returns its path so far, see
/// [`StopReason`].
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum IntegrationError {
    /// The start or the end time is not a finite number.
    #[error(
        "the start (t = {t}, x = {x}, v = {v}) and the end time {end_time} must be finite numbers"
    )]
    NotFinite {
        /// Time of the start.
        t: f64,
        /// Displacement at the start.
        x: f64,
        /// Velocity at the start.
        v: f64,
        /// End time asked for.
        end_time: f64,
    },
    /// The acceleration has no finite value at the start.
    #[error(
        "the acceleration has no finite value at the start (t = {t}, x = {x}, v = {v}): start inside its domain"
    )]
    AccelerationNotFinite {
        /// Time of the start.
        t: f64,
        /// Displacement at the start.
        x: f64,
        /// Velocity at the start.
        v: f64,
    },
    /// A value at the start of first-order equations, or the end time, is not a finite number.
    #[error(
        "the start (t = {start_time}), its values and the end time {end_time} must be finite numbers"
    )]
    ValuesNotFinite {
        /// Time of the start.
        start_time: f64,
        /// End time asked for.
        end_time: f64,
    },
    /// A rate of first-order equations has no finite value at the start.
    #[error(
        "rate {index}, counted from 0, has no finite value at the start (t = {t}): start inside its domain"
    )]
    RateNotFinite {
        /// Index of the value.
        index: usize,
        /// Time of the start.
        t: f64,
    },
    /// The end lies before the start.
    #[error(
        "the end time {end_time} lies before the start {start_time}: motions are followed forward only"
    )]
    EndBeforeStart {
        /// Time of the start.
        start_time: f64,
        /// End time asked for.
        end_time: f64,
    },
    /// A tolerance lies outside the range that a run in double precision can keep.
    #[error(
        "the integrator's tolerance must lie between 1e-15 and 0.1, not {0}: 1e-10 is a good choice"
    )]
    Tolerance(f64),
    /// The maximum step is not positive.
    #[error("the longest step must be positive, not {0}")]
    MaximumStep(f64),
    /// The first phase, or that of a switch, does not exist.
    #[error("there is no phase {phase}: {count} are given, counted from 0")]
    UnknownPhase {
        /// The index asked for.
        phase: usize,
        /// Number of phases.
        count: usize,
    },
}

/// The motion x'' = acceleration(t, x, v) from `start` to `end_time`, or to the first stopping
/// event.
///
/// An [`Action::Switch`] must name phase 0, the only one, and so restarts with a changed state: a
/// rebound.
///
/// # Errors
/// [`IntegrationError`] if the run cannot begin. A run that ends early is no error: see
/// [`Trajectory::stop_reason`].
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::numeric::ode::{IntegrationOptions, State, integrate};
///
/// let path = integrate(|_t, x, _v| -x, State { t: 0.0, x: 1.0, v: 0.0 }, 3.0, &[], &IntegrationOptions::default())?;
/// assert!((path.end().x - 3.0_f64.cos()).abs() < 1e-8);
/// # Ok::<(), lindstedt::numeric::ode::IntegrationError>(())
/// ```
pub fn integrate<'a>(
    acceleration: impl Fn(f64, f64, f64) -> f64 + 'a,
    start: State,
    end_time: f64,
    events: &[Event<'a>],
    options: &IntegrationOptions,
) -> Result<Trajectory, IntegrationError> {
    let rates = first_order(acceleration);
    run(&[(&rates, events)], 0, start, end_time, StepLimits::NOWHERE, options)
        .map_err(|error| of_motion(error, start))
}

/// The motion through several smooth right sides: it begins in phase `first`, and each
/// [`Action::Switch`] chooses the next.
///
/// # Errors
/// As [`integrate`], and [`IntegrationError::UnknownPhase`] where `first` or a switch names a phase
/// that is not there.
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::numeric::ode::{Event, IntegrationOptions, IntegrationPhase, State, integrate_phases};
///
/// // Free fall from a height of 1 until a spring of stiffness 100 is met at x = 0.
/// let met = Event::switch(|_t, x, _v| x, |state| (1, State { x: 0.0, ..state })).falling();
/// let fall = IntegrationPhase::new(|_t, _x, _v| -1.0, vec![met]);
/// let deepest = Event::stop(|_t, _x, v| v).rising();
/// let spring = IntegrationPhase::new(|_t, x, _v| -1.0 - 100.0 * x, vec![deepest]);
/// let start = State { t: 0.0, x: 1.0, v: 0.0 };
/// let path = integrate_phases(&[fall, spring], 0, start, 10.0, &IntegrationOptions::default())?;
/// let depth = -path.end().x;
/// assert!((50.0 * depth * depth - (1.0 + depth)).abs() < 1e-8); // energy of the spring, work of the weight
/// # Ok::<(), lindstedt::numeric::ode::IntegrationError>(())
/// ```
pub fn integrate_phases(
    phases: &[IntegrationPhase],
    first: usize,
    start: State,
    end_time: f64,
    options: &IntegrationOptions,
) -> Result<Trajectory, IntegrationError> {
    let parts: Vec<PhaseFunctions<State>> =
        phases.iter().map(|phase| (&*phase.rates as _, phase.events.as_slice())).collect();
    run(&parts, first, start, end_time, StepLimits::NOWHERE, options)
        .map_err(|error| of_motion(error, start))
}

/// The solution of any first-order equations: `rates` writes y' at the time and the values y that
/// it is given. Otherwise as [`integrate`].
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::numeric::ode::{Action, Event, IntegrationOptions, Point, integrate_first_order};
///
/// // Euler's equations of a body that turns freely: energy and angular momentum are kept.
/// let spin = |_t: f64, w: &[f64; 3], rates: &mut [f64; 3]| *rates = [-w[1] * w[2], 2.0 * w[2] * w[0], -w[0] * w[1]];
/// let start = Point { t: 0.0, y: [0.1, 1.0, 0.2] };
/// let turned = Event::new(|point: &Point<[f64; 3]>| point.y[1], Action::Record).falling();
/// let path = integrate_first_order(spin, start, 20.0, &[turned], &IntegrationOptions::with_tolerance(1e-12))?;
/// let energy = |w: [f64; 3]| 2.0 * w[0] * w[0] + 2.0 * w[1] * w[1] + 2.0 * w[2] * w[2];
/// assert!(path.samples(100).all(|point| (energy(point.y) - energy(start.y)).abs() < 1e-10));
/// assert!(!path.occurrences().is_empty());
/// # Ok::<(), lindstedt::numeric::ode::IntegrationError>(())
/// ```
///
/// # Errors
/// As [`integrate`].
pub fn integrate_first_order<'a, Y: StateVector>(
    rates: impl Fn(f64, &Y, &mut Y) + 'a,
    start: Point<Y>,
    end_time: f64,
    events: &[Event<'a, Point<Y>>],
    options: &IntegrationOptions,
) -> Result<Trajectory<Point<Y>>, IntegrationError> {
    run(&[(&rates, events)], 0, start, end_time, StepLimits::NOWHERE, options)
}

/// Integrates as [`integrate_first_order`], with limits that no step crosses.
///
/// # Errors
/// As [`integrate`].
pub fn integrate_through<'a, Y: StateVector>(
    rates: impl Fn(f64, &Y, &mut Y) + 'a,
    start: Point<Y>,
    end_time: f64,
    looks: StepLimits<Point<Y>>,
    events: &[Event<'a, Point<Y>>],
    options: &IntegrationOptions,
) -> Result<Trajectory<Point<Y>>, IntegrationError> {
    run(&[(&rates, events)], 0, start, end_time, looks, options)
}

/// The values at the end time of first-order equations whose path is not kept: a step then costs its
/// sixteen evaluations of the rates and no interpolant, and a run takes the memory of one step.
/// Returns `None` if the end is not reached.
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::numeric::ode::{IntegrationOptions, Point, end_values};
///
/// let swing = |_t: f64, y: &Vec<f64>, rates: &mut Vec<f64>| (rates[0], rates[1]) = (y[1], -y[0]);
/// let start = Point { t: 0.0, y: vec![1.0, 0.0] };
/// let end = end_values(swing, start, 3.0, &IntegrationOptions::default()).ok_or("no end")?;
/// assert!((end[0] - 3.0_f64.cos()).abs() < 1e-8);
/// # Ok::<(), &str>(())
/// ```
pub fn end_values<Y: StateVector>(
    rates: impl Fn(f64, &Y, &mut Y),
    start: Point<Y>,
    end_time: f64,
    options: &IntegrationOptions,
) -> Option<Y> {
    end_or_event(rates, 0, start, end_time, &[], options).map(|end| end.point.y)
}

/// The end of a run whose path is not kept.
#[derive(Clone, Debug, PartialEq)]
pub struct RunEnd<Y> {
    /// The time and the values.
    pub point: Point<Y>,
    /// The index of the event that ended it; `None` at the end time.
    pub event: Option<usize>,
    /// The step that would be tried next, were there no end: a motion that goes on from here, or one like it,
    /// may begin with it.
    pub next_step: f64,
}

/// The end time, or the first of these events, of first-order equations whose path is not kept; each event
/// ends the run, whatever its action. `None` if neither is reached.
///
/// The events read the first `inside` values alone, and so do the rates of these: between the ends of a
/// step only they are known, and `rates` is called with them alone, for their own rates. A step up to an
/// event is taken once more for the other values.
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::numeric::ode::{Action, Event, IntegrationOptions, Point, end_or_event};
///
/// // x'' = -x with the variation z of x by the velocity at the start, up to the zero of x at pi.
/// let swing = |_t: f64, y: &Vec<f64>, rates: &mut Vec<f64>| {
///     (rates[0], rates[1]) = (y[1], -y[0]);
///     if y.len() > 2 {
///         (rates[2], rates[3]) = (y[3], -y[2]);
///     }
/// };
/// let start = Point { t: 0.0, y: vec![0.0, 1.0, 0.0, 1.0] };
/// let zero = Event::new(|point: &Point<Vec<f64>>| point.y[0], Action::Stop).falling();
/// let options = IntegrationOptions::with_tolerance(1e-12);
/// let end = end_or_event(swing, 2, start, 9.0, &[zero], &options).ok_or("no end")?;
/// assert!(end.event == Some(0) && (end.point.t - std::f64::consts::PI).abs() < 1e-10);
/// assert!(end.point.y[2].abs() < 1e-10 && (end.point.y[3] + 1.0).abs() < 1e-10);
/// # Ok::<(), &str>(())
/// ```
pub fn end_or_event<'a, Y: StateVector>(
    rates: impl Fn(f64, &Y, &mut Y) + 'a,
    inside: usize,
    start: Point<Y>,
    end_time: f64,
    events: &[Event<'a, Point<Y>>],
    options: &IntegrationOptions,
) -> Option<RunEnd<Y>> {
    check(&start, end_time, options).ok()?;
    let evaluations = Cell::new(0);
    let equations = CountedRates::<Point<Y>> {
        rates: &rates,
        evaluations: &evaluations,
        non_finite: Cell::new(false),
    };
    let looks = StepLimits::NOWHERE;
    let leg = Leg { equations, phase: 0, events, end_time, looks, inside, options };
    let (point, event, next_step) =
        leg.end_or_event(&explicit::<Y>(), start, options.first_step)?;
    Some(RunEnd { point, event, next_step })
}

/// Conditions, besides the error, that limit a step.
pub struct StepLimits<'a, S> {
    /// Times, in order, that no step crosses.
    pub critical: &'a [f64],
    /// Returns the fraction of a step that may be kept, from the step as a function of its
    /// fraction; `None` keeps all of it.
    pub kept: Option<&'a AcceptedFraction<'a, S>>,
}

/// A function that returns the fraction of a step that may be kept, from the step as a function of
/// its fraction; `None` keeps all of it.
pub type AcceptedFraction<'a, S> = dyn Fn(&dyn Fn(f64) -> S) -> Option<f64> + 'a;

impl<S> StepLimits<'_, S> {
    const NOWHERE: Self = Self { critical: &[], kept: None };
}

impl<S> Clone for StepLimits<'_, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S> Copy for StepLimits<'_, S> {}

/// Converts an error of first-order equations into one of displacement and velocity.
fn of_motion(error: IntegrationError, State { t, x, v }: State) -> IntegrationError {
    match error {
        IntegrationError::ValuesNotFinite { end_time, .. } => {
            IntegrationError::NotFinite { t, x, v, end_time }
        }
        IntegrationError::RateNotFinite { .. } => {
            IntegrationError::AccelerationNotFinite { t, x, v }
        }
        other => other,
    }
}

type PhaseFunctions<'r, 'a, S> = (&'r RateFunction<'r, S>, &'r [Event<'a, S>]);

/// Switches in a row without progress of time (beyond rounding) after which the run is called
/// stalled.
const MAXIMUM_IDLE_SWITCHES: usize = 16;

fn run<S: Sample>(
    parts: &[PhaseFunctions<S>],
    first: usize,
    start: S,
    end_time: f64,
    looks: StepLimits<S>,
    options: &IntegrationOptions,
) -> Result<Trajectory<S>, IntegrationError> {
    check(&start, end_time, options)?;
    let unknown = |phase: usize| IntegrationError::UnknownPhase { phase, count: parts.len() };
    let &(rates, _) = parts.get(first).ok_or(unknown(first))?;
    let mut at_start = start.values();
    rates(start.time(), &start.values(), &mut at_start);
    if let Some(index) = at_start.as_ref().iter().position(|rate| !rate.is_finite()) {
        return Err(IntegrationError::RateNotFinite { index, t: start.time() });
    }
    let evaluations = Cell::new(0);
    let mut trajectory = Trajectory {
        start: start.clone(),
        end: start,
        steps: Vec::new(),
        occurrences: Vec::new(),
        stop_reason: StopReason::EndReached,
        evaluations: 0,
    };
    let mut phase = first;
    let mut attempts = 0;
    let mut idle_switches = 0;
    loop {
        let &(rates, events) = parts.get(phase).ok_or(unknown(phase))?;
        let equations =
            CountedRates::<S> { rates, evaluations: &evaluations, non_finite: Cell::new(false) };
        let begin = trajectory.end.time();
        let leg = Leg { equations, phase, events, end_time, looks, inside: usize::MAX, options };
        let end = match options.stiff {
            false => leg.run(&explicit::<S::Values>(), &mut trajectory, &mut attempts),
            true => leg.run(&implicit::<S>(), &mut trajectory, &mut attempts),
        };
        match end {
            LegEnd::Stopped(reason) => {
                trajectory.stop_reason = reason;
                break;
            }
            LegEnd::Switched(next_phase, next) => {
                let time = trajectory.end.time();
                let idle = time - begin <= 256.0 * f64::EPSILON * time.abs();
                idle_switches = if idle { idle_switches + 1 } else { 0 };
                trajectory.end = S::new(time, next.values());
                if !trajectory.end.is_finite() {
                    trajectory.stop_reason = StopReason::NonFinite { time };
                    break;
                }
                if idle_switches > MAXIMUM_IDLE_SWITCHES {
                    trajectory.stop_reason = StopReason::SwitchingStalled { time };
                    break;
                }
                phase = next_phase;
            }
        }
    }
    trajectory.evaluations = evaluations.get();
    Ok(trajectory)
}

fn check(
    start: &impl Sample,
    end_time: f64,
    options: &IntegrationOptions,
) -> Result<(), IntegrationError> {
    let start_time = start.time();
    if !(start.is_finite() && end_time.is_finite()) {
        return Err(IntegrationError::ValuesNotFinite { start_time, end_time });
    }
    if end_time < start_time {
        return Err(IntegrationError::EndBeforeStart { start_time, end_time });
    }
    if !(1e-15..=0.1).contains(&options.relative_tolerance) {
        return Err(IntegrationError::Tolerance(options.relative_tolerance));
    }
    // An amplitude may be tiny, so the absolute tolerance need only be positive.
    if !(f64::MIN_POSITIVE..=0.1).contains(&options.absolute_tolerance) {
        return Err(IntegrationError::Tolerance(options.absolute_tolerance));
    }
    if options.maximum_step.is_nan() || options.maximum_step <= 0.0 {
        return Err(IntegrationError::MaximumStep(options.maximum_step));
    }
    Ok(())
}

/// The right side, counting its evaluations and remembering whether one of them was not finite.
struct CountedRates<'r, S: Sample> {
    rates: &'r RateFunction<'r, S>,
    evaluations: &'r Cell<usize>,
    non_finite: Cell<bool>,
}

impl<S: Sample> ODE<f64, S::Values> for CountedRates<'_, S> {
    fn diff(&self, t: f64, values: &S::Values, derivative: &mut S::Values) {
        (self.rates)(t, values, derivative);
        self.evaluations.set(self.evaluations.get() + 1);
        if !are_finite(derivative.as_ref()) {
            self.non_finite.set(true);
        }
    }
}

/// Whether all values are finite. Zero times a value that is not is no number: four sums of such products take
/// less time than to look at one value after the other.
fn are_finite(values: &[f64]) -> bool {
    let (fours, rest) = values.as_chunks::<4>();
    let mut sums = [0.0; 4];
    for four in fours {
        sums.iter_mut().zip(four).for_each(|(sum, value)| *sum += 0.0 * value);
    }
    rest.iter().fold(sums.iter().sum::<f64>(), |sum, value| sum + 0.0 * value) == 0.0
}

/// The part of a run with one right side.
struct Leg<'r, 'a, S: Sample> {
    equations: CountedRates<'r, S>,
    phase: usize,
    events: &'r [Event<'a, S>],
    end_time: f64,
    looks: StepLimits<'r, S>,
    /// The number of values, from the first on, that are known between the ends of a step.
    inside: usize,
    options: &'r IntegrationOptions,
}

enum LegEnd<S> {
    Stopped(StopReason),
    Switched(usize, S),
}

impl<S: Sample> Leg<'_, '_, S> {
    fn run<M: OrdinaryNumericalMethod<f64, S::Values>>(
        &self,
        scheme: &Scheme<M, S::Values>,
        trajectory: &mut Trajectory<S>,
        attempts: &mut usize,
    ) -> LegEnd<S> {
        let mut state = trajectory.end.clone();
        let Some(mut solver) = self.solver(scheme, &state, self.options.first_step) else {
            return LegEnd::Stopped(self.failure(state.time()));
        };
        let mut watches = vec![SignTracker::default(); self.events.len()];
        let mut first = true;
        loop {
            let time = state.time();
            let remaining = self.end_time - time;
            if remaining <= 2.0 * f64::EPSILON * self.end_time.abs() {
                trajectory.end = S::new(self.end_time, trajectory.end.values());
                return LegEnd::Stopped(StopReason::EndReached);
            }
            if let Some(reason) = self.given_up(time, *attempts) {
                return LegEnd::Stopped(reason);
            }
            *attempts += 1;
            let allowed = self.options.maximum_step.min(remaining).min(self.to_critical(time));
            let wanted = solver.h().min(allowed);
            solver.set_h(wanted);
            self.equations.non_finite.set(false);
            let outcome = solver.step(&self.equations);
            if self.equations.non_finite.get() {
                // The step reached outside the domain of the equation: try again, a fifth as long.
                let shorter = 0.2 * wanted;
                if time + shorter <= time {
                    return LegEnd::Stopped(StopReason::NonFinite { time });
                }
                match self.solver(scheme, &state, shorter) {
                    Some(smaller) => solver = smaller,
                    None => return LegEnd::Stopped(self.failure(time)),
                }
                continue;
            }
            if outcome.is_err() {
                return LegEnd::Stopped(StopReason::StepTooSmall { time });
            }
            if matches!(solver.status(), Status::RejectedStep) {
                if time + solver.h() <= time {
                    return LegEnd::Stopped(StopReason::StepTooSmall { time });
                }
                continue;
            }
            let Some((step, next)) = self.accepted(scheme, &mut solver, &state) else {
                return LegEnd::Stopped(StopReason::NonFinite { time });
            };
            let kept = self
                .looks
                .kept
                .and_then(|kept| kept(&|fraction| step.state_at(fraction)))
                // A step too short to advance the time would be repeated for ever.
                .filter(|kept| kept * step.length > 4.0 * f64::EPSILON * time.abs());
            if let Some(kept) = kept {
                // The whole step would go past a limit: repeat it with the part that may be kept.
                match self.solver(scheme, &state, kept * step.length) {
                    Some(shorter) => solver = shorter,
                    None => return LegEnd::Stopped(self.failure(time)),
                }
                continue;
            }
            let moved = first.then(|| self.extrapolated(&state, step.length));
            let before = watches.clone();
            let Some(happenings) = self.located_events(&step, &mut watches, moved.as_ref()) else {
                return LegEnd::Stopped(StopReason::NonFinite { time });
            };
            let (step, happenings) =
                match self.step_to_end(scheme, (&state, step.length), &happenings) {
                    StepToEnd::None => (step, happenings),
                    StepToEnd::TooLong(shorter) => {
                        match self.solver(scheme, &state, shorter) {
                            Some(smaller) => solver = smaller,
                            None => return LegEnd::Stopped(self.failure(time)),
                        }
                        watches = before;
                        continue;
                    }
                    StepToEnd::Found(until, end) => {
                        watches = before;
                        let moved = moved.as_ref();
                        let all = self.up_to_end(&until, end, &happenings, (&mut watches, moved));
                        let Some(happenings) = all else {
                            return LegEnd::Stopped(StopReason::NonFinite { time });
                        };
                        (until, happenings)
                    }
                };
            trajectory.steps.push(step);
            trajectory.end = next.clone();
            if let Some(end) = self.recorded(happenings, trajectory) {
                return end;
            }
            state = next;
            first = false;
        }
    }

    /// Returns the values at the end time or the first event, the event, and the next step, without
    /// limits of a step; `None` if neither is reached.
    fn end_or_event(
        &self,
        scheme: &Scheme<VernerSteps<S::Values>, S::Values>,
        start: S,
        first_step: f64,
    ) -> Option<(S, Option<usize>, f64)> {
        let mut solver = self.solver(scheme, &start, first_step)?;
        let mut watches = vec![SignTracker::default(); self.events.len()];
        let (mut state, mut first) = (start, true);
        let mut next_step = solver.h();
        let mut quotient = [(); TERMS].map(|()| state.values().leading(self.inside));
        for attempts in 0.. {
            let time = state.time();
            let remaining = self.end_time - time;
            if remaining <= 2.0 * f64::EPSILON * self.end_time.abs() {
                break;
            }
            if self.given_up(time, attempts).is_some() {
                return None;
            }
            let allowed = solver.h().min(self.options.maximum_step);
            let wanted = allowed.min(remaining);
            solver.set_h(wanted);
            self.equations.non_finite.set(false);
            let outcome = solver.step(&self.equations);
            if self.equations.non_finite.get() {
                let shorter = 0.2 * wanted;
                if time + shorter <= time {
                    return None;
                }
                solver = self.solver(scheme, &state, shorter)?;
                continue;
            }
            outcome.ok()?;
            if matches!(solver.status(), Status::RejectedStep) {
                if time + solver.h() <= time {
                    return None;
                }
                continue;
            }
            let values = solver.y().as_ref();
            if !(solver.t().is_finite() && values.iter().all(|value| value.is_finite())) {
                return None;
            }
            if !self.events.is_empty() {
                let begin = S::new(time, solver.y_prev().leading(self.inside));
                solver.write_quotient(&mut quotient);
                let is_finite =
                    |values: &S::Values| values.as_ref().iter().all(|own| own.is_finite());
                if !quotient.iter().all(is_finite) {
                    return None;
                }
                let length = solver.t() - solver.t_prev();
                let step = TrajectoryStep::from_quotient(self.phase, begin, length, quotient);
                let moved = first.then(|| self.extrapolated(&step.start, step.length));
                let met = self.located_events(&step, &mut watches, moved.as_ref())?;
                if let Some((happening, event, _)) = met.into_iter().next() {
                    let end = self.whole_at(scheme, state, &happening)?;
                    return Some((end, Some(event), solver.h()));
                }
                quotient = step.into_quotient();
            }
            // A step that the end has cut short says little of the next one.
            let cut = if wanted < allowed { allowed } else { 0.0 };
            next_step = solver.h().max(cut);
            state.set(solver.t(), values.len(), |index| values[index]);
            first = false;
        }
        Some((S::new(self.end_time, state.values()), None, next_step))
    }

    /// Returns all values where the first ones are known, within the step that begins in a state.
    fn whole_at(
        &self,
        scheme: &Scheme<VernerSteps<S::Values>, S::Values>,
        state: S,
        known: &S,
    ) -> Option<S> {
        let first = known.values();
        let length = known.time() - state.time();
        let mut values = state.values();
        if length > 0.0 && values.as_ref().len() > first.as_ref().len() {
            let CountedRates { rates, evaluations, .. } = self.equations;
            let equations = CountedRates { rates, evaluations, non_finite: Cell::new(false) };
            let step = Leg { equations, events: &[], end_time: known.time(), inside: 0, ..*self };
            values = step.end_or_event(scheme, state, length)?.0.values();
        }
        values.as_mut()[..first.as_ref().len()].copy_from_slice(first.as_ref());
        Some(S::new(known.time(), values))
    }

    /// Returns the time left until the next critical time that is farther away than rounding.
    fn to_critical(&self, time: f64) -> f64 {
        let beyond = time + 4.0 * f64::EPSILON * time.abs();
        let next = self.looks.critical.partition_point(|critical| *critical <= beyond);
        self.looks.critical.get(next).map_or(f64::INFINITY, |critical| critical - time)
    }

    /// Returns the reason to stop if the steps are used up or an interrupt was requested.
    fn given_up(&self, time: f64, attempts: usize) -> Option<StopReason> {
        if attempts >= self.options.maximum_steps {
            return Some(StopReason::MaximumSteps { time });
        }
        let asked = self.options.interrupt.is_requested();
        asked.then_some(StopReason::Interrupted { time })
    }

    /// Records the events of a step, up to the first that ends the leg: the path then ends there.
    /// Returns how the leg ends, `None` if it goes on.
    fn recorded(
        &self,
        happenings: Vec<(S, usize, bool)>,
        trajectory: &mut Trajectory<S>,
    ) -> Option<LegEnd<S>> {
        for (happening, event, rising) in happenings {
            trajectory.occurrences.push(EventOccurrence {
                phase: self.phase,
                event,
                state: happening.clone(),
                rising,
            });
            match &self.events[event].action {
                Action::Record => {}
                Action::Stop => {
                    trajectory.end = happening;
                    return Some(LegEnd::Stopped(StopReason::Event { phase: self.phase, event }));
                }
                Action::Switch(next_state) => {
                    trajectory.end = happening.clone();
                    let (phase, changed) = next_state(happening);
                    return Some(LegEnd::Switched(phase, changed));
                }
            }
        }
        None
    }

    /// Returns a new solver at this state, with this first step (0: chosen by the solver); `None`
    /// if the rates have no finite value or no first step is found.
    fn solver<M: OrdinaryNumericalMethod<f64, S::Values>>(
        &self,
        scheme: &Scheme<M, S::Values>,
        state: &S,
        first_step: f64,
    ) -> Option<M> {
        let (time, values) = (state.time(), state.values());
        let remaining = self.end_time - time;
        let longest = self.options.maximum_step.min(remaining);
        if longest <= 0.0 {
            // The end is reached: no step of this solver will be taken.
            return Some((scheme.fresh)(self.options, [0.0, f64::INFINITY], self.inside));
        }
        self.equations.non_finite.set(false);
        // With a first step nothing but the rates at the start is evaluated.
        if first_step <= 0.0 {
            self.equations.diff(time, &values, &mut values.clone());
        }
        if self.equations.non_finite.get() {
            return None;
        }
        for step in [first_step, 1e-6 * longest] {
            let steps = [step.min(longest), longest];
            let mut solver = (scheme.fresh)(self.options, steps, self.inside);
            // The trial steps by which a first step is chosen may leave the domain: the second pass
            // prescribes a short one.
            if solver.init(&self.equations, time, self.end_time, &values).is_ok()
                && solver.h() > 0.0
                && (first_step <= 0.0 || !self.equations.non_finite.get())
            {
                return Some(solver);
            }
        }
        None
    }

    fn failure(&self, time: f64) -> StopReason {
        if self.equations.non_finite.get() {
            StopReason::NonFinite { time }
        } else {
            StopReason::StepTooSmall { time }
        }
    }

    /// Returns the start of a step extrapolated over the time `length` at its rates, so that values
    /// at rest do not change at all.
    fn extrapolated(&self, start: &S, length: f64) -> S {
        let mut values = start.values();
        let mut rates = values.clone();
        (self.equations.rates)(start.time(), &values, &mut rates);
        for (value, rate) in values.as_mut().iter_mut().zip(rates.as_ref()) {
            *value += length * rate;
        }
        S::new(start.time() + length, values)
    }

    /// Returns the step just taken, as polynomials, and the state at its end; `None` if a value is
    /// not finite.
    fn accepted<M: OrdinaryNumericalMethod<f64, S::Values>>(
        &self,
        scheme: &Scheme<M, S::Values>,
        solver: &mut M,
        start: &S,
    ) -> Option<(TrajectoryStep<S>, S)> {
        let (from, to) = (solver.t_prev(), solver.t());
        let length = to - from;
        let mut is_known = true;
        let values: [S::Values; TERMS] = FRACTIONS.map(|fraction| {
            let found = (scheme.inside)(solver, (from + fraction * length).min(to));
            is_known &= found.is_some();
            found.unwrap_or_else(|| start.values())
        });
        if !is_known {
            return None;
        }
        let next = S::new(to, solver.y().clone());
        let finite = |values: &S::Values| values.as_ref().iter().all(|value| value.is_finite());
        let finite = next.is_finite() && values.iter().all(finite);
        finite.then(|| (TrajectoryStep::new(self.phase, start.clone(), length, values), next))
    }

    /// Returns the events inside the step in the order of time: the state, the index of the event
    /// and whether its function rises; `None` if an event function is not finite.
    fn located_events(
        &self,
        step: &TrajectoryStep<S>,
        watches: &mut [SignTracker],
        moved: Option<&S>,
    ) -> Option<Vec<(S, usize, bool)>> {
        let mut found = Vec::new();
        for (index, (event, watch)) in self.events.iter().zip(watches).enumerate() {
            let crossings = watch.crossings(step, event, moved).ok()?;
            found.extend(
                crossings
                    .into_iter()
                    .map(|(fraction, rising)| (step.state_at(fraction), index, rising)),
            );
        }
        // The sort is stable: of two events at the same time the one listed first comes first.
        found.sort_by(|one, other| one.0.time().total_cmp(&other.0.time()));
        Some(found)
    }
}
