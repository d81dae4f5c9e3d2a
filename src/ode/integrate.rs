//! The run itself: step, look for events in the step, restart where the right side switches.
//!
//! Only the stepping is the library's: its 0.7.0 accepts a step whose error estimate is not a number, so every step
//! is checked here and tried again smaller; its event handling does not see two crossings in one step, so ours is
//! used.

use std::cell::Cell;

use differential_equations::ode::{ODE, OrdinaryNumericalMethod};
use differential_equations::status::Status;
use thiserror::Error;

use super::State;
use super::event::{Action, Event, Watch};
use super::scheme::{Scheme, explicit, implicit};
use super::trajectory::{FRACTIONS, Occurrence, Step, StopReason, TERMS, Trajectory};
use crate::interrupt::Interrupt;

/// How closely and how long to integrate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Error allowed per step relative to the size of x and of v.
    pub relative_tolerance: f64,
    /// Error allowed per step beside it, in the units of x and v: choose it well below the amplitude.
    pub absolute_tolerance: f64,
    /// Steps, rejected ones included, after which the run gives up. Each accepted step keeps about 200 bytes.
    pub maximum_steps: usize,
    /// Longest step: infinity, unless a right side or an event varies faster than the motion.
    pub maximum_step: f64,
    /// Whether the motion has parts of very different speed: an implicit method of lower order then takes longer steps.
    pub stiff: bool,
    /// Who may ask the run to stop where it is.
    pub interrupt: Interrupt,
}

impl Default for Options {
    /// Tolerances of 1e-10, 200 000 steps of any length.
    fn default() -> Self {
        Self::with_tolerance(1e-10)
    }
}

impl Options {
    /// The same relative and absolute tolerance, the rest as in the default.
    pub fn with_tolerance(tolerance: f64) -> Self {
        Self {
            relative_tolerance: tolerance,
            absolute_tolerance: tolerance,
            maximum_steps: 200_000,
            maximum_step: f64::INFINITY,
            stiff: false,
            interrupt: Interrupt::default(),
        }
    }
}

/// A smooth right side and the events to look for while it is in force.
pub struct Phase<'a> {
    acceleration: Box<dyn Fn(f64, f64, f64) -> f64 + 'a>,
    events: Vec<Event<'a>>,
}

impl<'a> Phase<'a> {
    /// The acceleration g(t, x, v) and the events of this phase.
    pub fn new(acceleration: impl Fn(f64, f64, f64) -> f64 + 'a, events: Vec<Event<'a>>) -> Self {
        Self {
            acceleration: Box::new(acceleration),
            events,
        }
    }
}

/// What makes a run impossible from the outset. A run that began keeps what it has, see [`StopReason`].
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum IntegrationError {
    /// The start or the end time is not a finite number.
    #[error("the start (t = {t}, x = {x}, v = {v}) and the end time {end_time} must be finite numbers")]
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
    #[error("the acceleration has no finite value at the start (t = {t}, x = {x}, v = {v}): start inside its domain")]
    AccelerationNotFinite {
        /// Time of the start.
        t: f64,
        /// Displacement at the start.
        x: f64,
        /// Velocity at the start.
        v: f64,
    },
    /// The end lies before the start.
    #[error("the end time {end_time} lies before the start {start_time}: motions are followed forward only")]
    EndBeforeStart {
        /// Time of the start.
        start_time: f64,
        /// End time asked for.
        end_time: f64,
    },
    /// A tolerance no double-precision run can keep.
    #[error("the integrator's tolerance must lie between 1e-15 and 0.1, not {0}: 1e-10 is a good choice")]
    Tolerance(f64),
    /// A maximum step that is not positive.
    #[error("the longest step must be positive, not {0}")]
    MaximumStep(f64),
    /// A phase that does not exist.
    #[error("there is no phase {phase}: {count} are given, counted from 0")]
    UnknownPhase {
        /// The index asked for.
        phase: usize,
        /// How many there are.
        count: usize,
    },
}

/// The motion x'' = acceleration(t, x, v) from `start` to `end_time`, or to the first stopping event.
///
/// An [`Action::Switch`] must name phase 0, the only one, and so restarts with a changed state: a rebound.
///
/// # Errors
/// [`IntegrationError`] where the run cannot begin. One that ends early is no error: ask
/// [`Trajectory::stop_reason`].
pub fn integrate<'a>(
    acceleration: impl Fn(f64, f64, f64) -> f64 + 'a,
    start: State,
    end_time: f64,
    events: &[Event<'a>],
    options: &Options,
) -> Result<Trajectory, IntegrationError> {
    run(&[(&acceleration, events)], 0, start, end_time, options)
}

/// The motion through several smooth right sides: begins in phase `first`, goes on as the switches of the events say.
///
/// # Errors
/// As [`integrate`], and [`IntegrationError::UnknownPhase`] where `first` or a switch names a phase that is not
/// there.
pub fn integrate_phases(
    phases: &[Phase],
    first: usize,
    start: State,
    end_time: f64,
    options: &Options,
) -> Result<Trajectory, IntegrationError> {
    let parts: Vec<Part> = phases
        .iter()
        .map(|phase| (&*phase.acceleration as _, phase.events.as_slice()))
        .collect();
    run(&parts, first, start, end_time, options)
}

type Part<'r, 'a> = (&'r dyn Fn(f64, f64, f64) -> f64, &'r [Event<'a>]);

/// Switches in a row without progress of time (beyond rounding) after which the run is called stalled.
const MAXIMUM_IDLE_SWITCHES: usize = 16;

fn run(
    parts: &[Part],
    first: usize,
    start: State,
    end_time: f64,
    options: &Options,
) -> Result<Trajectory, IntegrationError> {
    check(start, end_time, options)?;
    let unknown = |phase: usize| IntegrationError::UnknownPhase {
        phase,
        count: parts.len(),
    };
    let &(acceleration, _) = parts.get(first).ok_or(unknown(first))?;
    let State { t, x, v } = start;
    if !acceleration(t, x, v).is_finite() {
        return Err(IntegrationError::AccelerationNotFinite { t, x, v });
    }
    let evaluations = Cell::new(0);
    let mut trajectory = Trajectory {
        start,
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
        let &(acceleration, events) = parts.get(phase).ok_or(unknown(phase))?;
        let system = System {
            acceleration,
            evaluations: &evaluations,
            non_finite: Cell::new(false),
        };
        let begin = trajectory.end;
        let leg = Leg {
            system,
            phase,
            events,
            end_time,
            options,
        };
        let end = match options.stiff {
            false => leg.run(&explicit(), &mut trajectory, &mut attempts),
            true => leg.run(&implicit(), &mut trajectory, &mut attempts),
        };
        match end {
            LegEnd::Stopped(reason) => {
                trajectory.stop_reason = reason;
                break;
            }
            LegEnd::Switched(next_phase, next) => {
                let time = trajectory.end.t;
                let idle = time - begin.t <= 256.0 * f64::EPSILON * time.abs();
                idle_switches = if idle { idle_switches + 1 } else { 0 };
                trajectory.end = State { t: time, ..next };
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

fn check(start: State, end_time: f64, options: &Options) -> Result<(), IntegrationError> {
    let State { t, x, v } = start;
    if !(start.is_finite() && end_time.is_finite()) {
        return Err(IntegrationError::NotFinite { t, x, v, end_time });
    }
    if end_time < t {
        return Err(IntegrationError::EndBeforeStart {
            start_time: t,
            end_time,
        });
    }
    if !(1e-15..=0.1).contains(&options.relative_tolerance) {
        return Err(IntegrationError::Tolerance(options.relative_tolerance));
    }
    // An amplitude may be tiny, so the absolute tolerance has no lower limit but zero.
    if !(f64::MIN_POSITIVE..=0.1).contains(&options.absolute_tolerance) {
        return Err(IntegrationError::Tolerance(options.absolute_tolerance));
    }
    if options.maximum_step.is_nan() || options.maximum_step <= 0.0 {
        return Err(IntegrationError::MaximumStep(options.maximum_step));
    }
    Ok(())
}

/// The first-order system, counting its evaluations and remembering whether one of them was not finite.
struct System<'r> {
    acceleration: &'r dyn Fn(f64, f64, f64) -> f64,
    evaluations: &'r Cell<usize>,
    non_finite: Cell<bool>,
}

impl ODE<f64, [f64; 2]> for System<'_> {
    fn diff(&self, t: f64, state: &[f64; 2], derivative: &mut [f64; 2]) {
        let acceleration = (self.acceleration)(t, state[0], state[1]);
        self.evaluations.set(self.evaluations.get() + 1);
        if !(acceleration.is_finite() && state[1].is_finite()) {
            self.non_finite.set(true);
        }
        *derivative = [state[1], acceleration];
    }
}

/// The part of a run with one right side.
struct Leg<'r, 'a> {
    system: System<'r>,
    phase: usize,
    events: &'r [Event<'a>],
    end_time: f64,
    options: &'r Options,
}

enum LegEnd {
    Stopped(StopReason),
    Switched(usize, State),
}

impl Leg<'_, '_> {
    fn run<M: OrdinaryNumericalMethod<f64, [f64; 2]>>(
        &self,
        scheme: &Scheme<M>,
        trajectory: &mut Trajectory,
        attempts: &mut usize,
    ) -> LegEnd {
        let mut state = trajectory.end;
        let Some(mut solver) = self.solver(scheme, state, 0.0) else {
            return LegEnd::Stopped(self.failure(state.t));
        };
        let mut watches = vec![Watch::default(); self.events.len()];
        let mut first = true;
        loop {
            let remaining = self.end_time - state.t;
            if remaining <= 2.0 * f64::EPSILON * self.end_time.abs() {
                trajectory.end.t = self.end_time;
                return LegEnd::Stopped(StopReason::EndReached);
            }
            if *attempts >= self.options.maximum_steps {
                return LegEnd::Stopped(StopReason::MaximumSteps { time: state.t });
            }
            if self.options.interrupt.is_requested() {
                return LegEnd::Stopped(StopReason::Interrupted { time: state.t });
            }
            *attempts += 1;
            let wanted = solver.h().min(self.options.maximum_step).min(remaining);
            solver.set_h(wanted);
            self.system.non_finite.set(false);
            let outcome = solver.step(&self.system);
            if self.system.non_finite.get() {
                // The step reached outside the domain of the equation: try again, a fifth as long.
                let shorter = 0.2 * wanted;
                if state.t + shorter <= state.t {
                    return LegEnd::Stopped(StopReason::NonFinite { time: state.t });
                }
                match self.solver(scheme, state, shorter) {
                    Some(smaller) => solver = smaller,
                    None => return LegEnd::Stopped(self.failure(state.t)),
                }
                continue;
            }
            if outcome.is_err() {
                return LegEnd::Stopped(StopReason::StepTooSmall { time: state.t });
            }
            if matches!(solver.status(), Status::RejectedStep) {
                if state.t + solver.h() <= state.t {
                    return LegEnd::Stopped(StopReason::StepTooSmall { time: state.t });
                }
                continue;
            }
            let Some((step, next)) = self.accepted(scheme, &mut solver, state) else {
                return LegEnd::Stopped(StopReason::NonFinite { time: state.t });
            };
            let Some(happenings) = self.happenings(&step, &mut watches, first) else {
                return LegEnd::Stopped(StopReason::NonFinite { time: state.t });
            };
            trajectory.steps.push(step);
            trajectory.end = next;
            for (happening, event) in happenings {
                trajectory.occurrences.push(Occurrence {
                    phase: self.phase,
                    event,
                    state: happening,
                });
                match &self.events[event].action {
                    Action::Record => {}
                    Action::Stop => {
                        trajectory.end = happening;
                        return LegEnd::Stopped(StopReason::Event {
                            phase: self.phase,
                            event,
                        });
                    }
                    Action::Switch(next_state) => {
                        trajectory.end = happening;
                        let (phase, changed) = next_state(happening);
                        return LegEnd::Switched(phase, changed);
                    }
                }
            }
            state = next;
            first = false;
        }
    }

    /// A fresh solver at this state, with this first step (0: of its own choice).
    fn solver<M: OrdinaryNumericalMethod<f64, [f64; 2]>>(
        &self,
        scheme: &Scheme<M>,
        state: State,
        first_step: f64,
    ) -> Option<M> {
        let remaining = self.end_time - state.t;
        let longest = self.options.maximum_step.min(remaining);
        if longest <= 0.0 {
            // Nothing left to do: the solver will not be asked for a step.
            return Some((scheme.fresh)(self.options, 0.0, f64::INFINITY));
        }
        let mut derivative = [0.0; 2];
        self.system.non_finite.set(false);
        self.system.diff(state.t, &[state.x, state.v], &mut derivative);
        if self.system.non_finite.get() {
            return None;
        }
        for step in [first_step, 1e-6 * longest] {
            let mut solver = (scheme.fresh)(self.options, step.min(longest), longest);
            // The trial steps by which a first step is chosen may leave the domain: then a short one is prescribed.
            if solver
                .init(&self.system, state.t, self.end_time, &[state.x, state.v])
                .is_ok()
                && solver.h() > 0.0
            {
                return Some(solver);
            }
        }
        None
    }

    fn failure(&self, time: f64) -> StopReason {
        if self.system.non_finite.get() {
            StopReason::NonFinite { time }
        } else {
            StopReason::StepTooSmall { time }
        }
    }

    /// The step just taken, as polynomials, and the state at its end.
    fn accepted<M: OrdinaryNumericalMethod<f64, [f64; 2]>>(
        &self,
        scheme: &Scheme<M>,
        solver: &mut M,
        start: State,
    ) -> Option<(Step, State)> {
        let (from, to) = (solver.t_prev(), solver.t());
        let length = to - from;
        let mut values = [[0.0; 2]; TERMS];
        for (value, fraction) in values.iter_mut().zip(FRACTIONS.iter()) {
            *value = (scheme.inside)(solver, (from + fraction * length).min(to))?;
        }
        let [x, v] = *solver.y();
        let next = State { t: to, x, v };
        let finite = next.is_finite() && values.iter().flatten().all(|value| value.is_finite());
        finite.then(|| (Step::new(self.phase, start, length, &values), next))
    }

    /// The events inside the step in the order of time, as states; `None` where an event function is not finite.
    fn happenings(&self, step: &Step, watches: &mut [Watch], first: bool) -> Option<Vec<(State, usize)>> {
        let mut found = Vec::new();
        for (index, (event, watch)) in self.events.iter().zip(watches).enumerate() {
            let fractions = watch.crossings(step, event, first).ok()?;
            found.extend(fractions.into_iter().map(|fraction| (step.state_at(fraction), index)));
        }
        // A stable sort: of two events at the same time the one listed first comes first.
        found.sort_by(|one, other| one.0.t.total_cmp(&other.0.t));
        Some(found)
    }
}
