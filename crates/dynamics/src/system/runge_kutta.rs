//! Integration by a Runge-Kutta method: the right sides are evaluated, never expanded into series,
//! so that it is a check of the series.
//!
//! ```text
//! abs(u) -> s u,   sgn(u) -> sgn(s),   H(u) -> H(s),   max(u, w) -> H(s) u + H(-s) w      s = 1 or -1: the side of a corner
//! ```
//!
//! A side is a further value of the run, with rate zero: the right sides are smooth in every step,
//! and where `s u` falls through zero the run restarts with the other side. The rest of u that
//! rounding leaves there is kept as one more value and subtracted, so that the motion starts
//! exactly on its corner and can leave it on either side. States are scaled by their own sizes, and
//! time from the start by the length of the first step, so that one tolerance and one initial step
//! suit all.

use std::cell::RefCell;

use super::narrow::{Argument, COARSE, FunctionGrowth, arguments, end_by_values};
use super::{
    Event, EventCrossing, LARGEST, Path, PathEnd, System, SystemError, SystemOptions, end_of_range,
    expansion, is_vanishing, taylor, within_range, without_value,
};
use crate::expr::{CompiledFunction, EvaluationError, Expr, ExprError, Function, Node};
use crate::numeric::ode::{
    self, AcceptedFraction, Action, Point, StepLimits, StopReason, Trajectory, integrate_through,
};
use crate::series::guard::{Guard, Guards};
use crate::symbol::{Symbol, fresh_stem};

/// Least tolerance of a step: below it the error estimate is rounding.
const SMALLEST_TOLERANCE: f64 = 1e-14;

/// Least relative change of a state during the run with which its rate is scaled by its own size.
const SMALLEST_MOVE: f64 = 1e-10;

/// Distance, in units of the first step, within which two crossings in the same direction count as
/// one.
const SAME_PLACE: f64 = 1e-10;

/// A trajectory in scaled units, with these units.
#[derive(Clone, Debug)]
pub(super) struct ScaledTrajectory {
    trajectory: Trajectory<Point<Vec<f64>>>,
    units: RunScales,
}

impl ScaledTrajectory {
    /// All states at a time within the path.
    pub(super) fn states_at(&self, time: f64) -> Option<Vec<f64>> {
        let end = self.trajectory.end();
        // There and back a time of the run changes by rounding, and the state at its end is known
        // better than by the interpolant.
        let point = match time == self.units.time(end.t) {
            true => end,
            false => self.trajectory.state_at(self.units.count(time).min(end.t))?,
        };
        Some(self.states(&point).collect())
    }

    pub(super) fn step_count(&self) -> usize {
        self.trajectory.step_count()
    }

    /// Returns the unscaled states at a point of the run.
    fn states<'a>(&'a self, point: &'a Point<Vec<f64>>) -> impl Iterator<Item = f64> + 'a {
        // The sides and the rests of the corners follow after the states.
        point.y.iter().zip(&self.units.sizes).map(|(value, size)| value * size)
    }

    /// Returns the start and the end of the last step, in scaled time.
    fn last_step(&self) -> [f64; 2] {
        let end = self.trajectory.end().t;
        let starts = self.trajectory.knots().map(|knot| knot.t);
        [starts.filter(|time| *time < end).last().unwrap_or(end), end]
    }

    /// Returns the time up to which all states are within range, and the reason why the path ends
    /// there; `None` if they never leave it.
    fn end_of_range(&self) -> Option<(f64, PathEnd)> {
        let mut before = self.trajectory.start().t;
        for knot in self.trajectory.knots() {
            if !within_range(self.states(&knot)) {
                let is_within = |length: f64| {
                    let point = self.trajectory.state_at((before + length).min(knot.t));
                    point.is_some_and(|point| within_range(self.states(&point)))
                };
                return Some(match is_vanishing([before, knot.t]) {
                    true => (before, PathEnd::Singular),
                    false => {
                        (before + end_of_range(knot.t - before, is_within)?, PathEnd::Overflow)
                    }
                });
            }
            before = knot.t;
        }
        None
    }
}

/// The units of states and time of a run.
#[derive(Clone, Debug)]
struct RunScales {
    /// The size of every state: its largest absolute value on the first step of its series. A state
    /// that stays zero there gets the smallest size of the others.
    sizes: Vec<f64>,
    start: f64,
    time: f64,
}

impl RunScales {
    fn new(system: &System, [start, end]: [f64; 2], values: &[f64], events: &[Event]) -> Self {
        // If there is no series, the initial values are used.
        let alone = || (f64::INFINITY, values.iter().map(|value| value.abs()).collect());
        let (reach, mut sizes): (f64, Vec<f64>) =
            taylor::first_step(system, [start, end], values, events).unwrap_or_else(alone);
        // A rate that hardly moves a state during the whole run, as one due to rounding at a
        // contact, is not a scale.
        for (right, moved) in system.right.iter().zip(sizes.clone()) {
            let rate = system.state.iter().position(|state| right.as_symbol() == Some(*state));
            if let Some(size) = rate.map(|rate| &mut sizes[rate])
                && *size * (end - start) < SMALLEST_MOVE * moved
            {
                *size = 0.0;
            }
        }
        let smallest =
            sizes.iter().copied().filter(|size| *size > 0.0).fold(f64::INFINITY, f64::min);
        let other = if smallest.is_finite() { smallest } else { 1.0 };
        sizes.iter_mut().filter(|size| **size == 0.0).for_each(|size| *size = other);
        sizes.iter_mut().for_each(|size| *size = size.min(LARGEST));
        let time = reach.min(end - start);
        let time = if time > 0.0 { time } else { 1.0 };
        Self { sizes, start, time }
    }

    /// Converts a time to scaled time.
    fn count(&self, time: f64) -> f64 {
        (time - self.start) / self.time
    }

    /// Converts a scaled time to time.
    fn time(&self, counted: f64) -> f64 {
        self.start + counted * self.time
    }
}

/// Integrates the system between two times from these values.
pub(super) fn follow(
    system: &System,
    [start, end]: [f64; 2],
    values: &[f64],
    events: &[Event],
    options: &SystemOptions,
) -> Result<Path, SystemError> {
    // Both integrators refuse equations that cannot be expanded into series.
    expansion::check(system, events)?;
    let smooth = Smooth::new(system, events)?;
    let units = RunScales::new(system, [start, end], values, events);
    let scaled = ScaledSystem {
        states: values.len(),
        scratch: RefCell::new(smooth.arguments(system)),
        smooth: &smooth,
        units: &units,
    };
    let begin = Point { t: 0.0, y: scaled.start(system, values)? };
    let watched = scaled.watched(events);
    let settings = ode::IntegrationOptions {
        maximum_steps: options.step_limit,
        // An event function may vary faster than the motion: with events or corners a step is no
        // longer than the first step by series.
        maximum_step: if watched.is_empty() { f64::INFINITY } else { 1.0 },
        interrupt: options.interrupt,
        ..ode::IntegrationOptions::with_tolerance(options.tolerance.max(SMALLEST_TOLERANCE))
    };
    let rates = |t: f64, y: &Vec<f64>, rates: &mut Vec<f64>| scaled.rates(t, y, rates);
    let critical: Vec<f64> = system.critical.iter().map(|time| units.count(*time)).collect();
    let kept = |state: &dyn Fn(f64) -> Point<Vec<f64>>| scaled.short_of_narrow(state);
    let looks = StepLimits {
        critical: &critical,
        kept: (!smooth.narrow.is_empty()).then_some(&kept as &AcceptedFraction<Point<Vec<f64>>>),
    };
    let run = integrate_through(rates, begin, units.count(end), looks, &watched, &settings);
    let trajectory = run.map_err(|error| match error {
        ode::IntegrationError::RateNotFinite { index, .. } => {
            SystemError::Start(system.state[index])
        }
        _ => SystemError::Bounds,
    })?;
    drop(watched);
    let mut occurrences = occurrences(trajectory.occurrences(), &units, events.len());
    let motion = ScaledTrajectory { trajectory, units };
    let last = motion.trajectory.end();
    let (end, reason) = match (motion.end_of_range(), reason(motion.trajectory.stop_reason())) {
        (Some((time, reason)), _) => {
            let time = motion.units.time(time);
            occurrences.retain(|occurrence| occurrence.time <= time);
            (time, reason)
        }
        (None, PathEnd::Reached) => (end, PathEnd::Reached),
        (None, PathEnd::Singular) => {
            (motion.units.time(last.t), without_value(motion.states(&last), motion.last_step()))
        }
        (None, reason) => (motion.units.time(last.t), reason),
    };
    let last = motion.states_at(end).unwrap_or_else(|| values.to_vec());
    let path = Box::new(super::EvaluatedPath { motion, last, occurrences });
    Ok(Path { end, reason, motion: super::PathRepresentation::RungeKutta(path) })
}

/// Returns the crossings of the user's events, each of them once.
fn occurrences(
    all: &[ode::EventOccurrence<Point<Vec<f64>>>],
    units: &RunScales,
    events: usize,
) -> Vec<EventCrossing> {
    let mut occurrences: Vec<EventCrossing> = Vec::new();
    for found in all.iter().filter(|found| found.event < events) {
        let (event, time, rising) = (found.event, units.time(found.state.t), found.rising);
        // If a corner lies at the same place, rounding may report the crossing both before and
        // after it.
        let same = |met: &&EventCrossing| met.event == event && met.rising == rising;
        let again = occurrences.iter().rev().find(same);
        if again.is_none_or(|met| time - met.time > SAME_PLACE * units.time) {
            occurrences.push(EventCrossing { event, time, rising });
        }
    }
    occurrences
}

/// The functions of a system in scaled units. Their values are the scaled states, then the sides of
/// the corners, then the rest that the argument of each corner had when it was crossed last.
struct ScaledSystem<'a> {
    states: usize,
    smooth: &'a Smooth,
    units: &'a RunScales,
    /// Scratch memory for the arguments of every function: states, sides, time, numbers.
    scratch: RefCell<Vec<f64>>,
}

impl ScaledSystem<'_> {
    fn corners(&self) -> usize {
        self.smooth.corners.len()
    }

    fn with(
        &self,
        t: f64,
        y: &[f64],
        functions: &[CompiledFunction],
        mut out: impl FnMut(usize, f64),
    ) {
        let mut arguments = self.scratch.borrow_mut();
        let time = self.states + self.corners();
        for (index, argument) in arguments.iter_mut().take(time).enumerate() {
            *argument = y[index] * self.units.sizes.get(index).copied().unwrap_or(1.0);
        }
        arguments[time] = self.units.time(t);
        for (index, function) in functions.iter().enumerate() {
            out(index, function.call(&arguments));
        }
    }

    fn value_of(&self, t: f64, y: &[f64], function: &CompiledFunction) -> f64 {
        let mut value = f64::NAN;
        self.with(t, y, std::slice::from_ref(function), |_, found| value = found);
        value
    }

    fn rates(&self, t: f64, y: &[f64], rates: &mut [f64]) {
        rates.fill(0.0);
        self.with(t, y, &self.smooth.rates, |state, rate| {
            rates[state] = self.units.time * (rate / self.units.sizes[state]);
        });
    }

    /// Returns the fraction of a step that ends beside the first narrow place; `None` if there is
    /// none. `state` is the step as a function of its fraction.
    fn short_of_narrow(&self, state: &dyn Fn(f64) -> Point<Vec<f64>>) -> Option<f64> {
        let coarse = COARSE.map(state);
        let ends = self.smooth.narrow.iter().filter_map(|(kind, function)| {
            let value = |point: &Point<Vec<f64>>| self.value_of(point.t, &point.y, function);
            end_by_values(*kind, coarse.each_ref().map(value), |fraction| value(&state(fraction)))
        });
        ends.fold(None, |first: Option<f64>, end| Some(first.map_or(end, |first| first.min(end))))
    }

    /// Returns the initial values of the run in scaled units.
    ///
    /// # Errors
    /// [`SystemError`] for a right side or an event without a value there.
    fn start(&self, system: &System, values: &[f64]) -> Result<Vec<f64>, SystemError> {
        let (states, corners) = (self.states, self.corners());
        let mut first: Vec<f64> =
            values.iter().zip(&self.units.sizes).map(|(value, size)| value / size).collect();
        first.resize(states + corners, 1.0);
        first.resize(states + 2 * corners, 0.0);
        // The argument of a corner contains only the sides of earlier corners, so the sides can be
        // set in order. At an argument of zero the positive side is assumed; if it is wrong, the
        // corner is crossed at once.
        for (corner, argument) in self.smooth.corners.iter().enumerate() {
            if self.value_of(0.0, &first, argument) < 0.0 {
                first[states + corner] = -1.0;
            }
        }
        // The typed right sides are tested because the smooth ones may have a value although a
        // corner's argument has none.
        for (state, rate) in self.smooth.typed.iter().enumerate() {
            if !self.value_of(0.0, &first, rate).is_finite() {
                return Err(SystemError::Start(system.state[state]));
            }
        }
        for (event, function) in self.smooth.events.iter().enumerate() {
            if !self.value_of(0.0, &first, function).is_finite() {
                return Err(SystemError::Event(event));
            }
        }
        Ok(first)
    }

    /// Takes the other side of every corner that rounding has put behind this point. Such a corner
    /// is met at the same time as the one that has just been crossed, and no step would find it any
    /// more.
    fn cross_with(&self, point: &mut Point<Vec<f64>>) {
        for (corner, argument) in self.smooth.corners.iter().enumerate() {
            let side = self.states + corner;
            let left_over = side + self.corners();
            let value = self.value_of(point.t, &point.y, argument);
            if point.y[side] * (value - point.y[left_over]) < 0.0 {
                point.y[left_over] = value;
                point.y[side] = -point.y[side];
            }
        }
    }

    /// Returns the events of the user, followed by the corners, at which the motion changes sides.
    fn watched(&self, events: &[Event]) -> Vec<ode::Event<'_, Point<Vec<f64>>>> {
        let mut watched = Vec::with_capacity(self.smooth.events.len() + self.corners());
        for (event, function) in events.iter().zip(&self.smooth.events) {
            let action = match event.stops {
                true => Action::Stop,
                false => Action::Record,
            };
            let height = move |point: &Point<Vec<f64>>| self.value_of(point.t, &point.y, function);
            let crossing = ode::Event::new(height, action);
            watched.push(match event.rising {
                None => crossing,
                Some(true) => crossing.rising(),
                Some(false) => crossing.falling(),
            });
        }
        for (corner, argument) in self.smooth.corners.iter().enumerate() {
            let side = self.states + corner;
            let left_over = side + self.corners();
            let cross = move |mut point: Point<Vec<f64>>| {
                point.y[left_over] = self.value_of(point.t, &point.y, argument);
                point.y[side] = -point.y[side];
                self.cross_with(&mut point);
                (0, point)
            };
            let height = move |point: &Point<Vec<f64>>| {
                point.y[side] * (self.value_of(point.t, &point.y, argument) - point.y[left_over])
            };
            watched.push(ode::Event::new(height, Action::Switch(Box::new(cross))).falling());
        }
        watched
    }
}

fn reason(stopped: StopReason) -> PathEnd {
    match stopped {
        StopReason::EndReached => PathEnd::Reached,
        StopReason::Event { event, .. } => PathEnd::Event(event),
        StopReason::MaximumSteps { .. } => PathEnd::StepLimit,
        StopReason::Interrupted { .. } => PathEnd::Interrupted,
        StopReason::SwitchingStalled { .. } => PathEnd::Sticks,
        StopReason::NonFinite { .. } | StopReason::StepTooSmall { .. } => PathEnd::Singular,
    }
}

/// The right sides, events and arguments of the corners, compiled as functions of states, sides,
/// time and numbers.
struct Smooth {
    /// The right sides as typed, with their corners.
    typed: Vec<CompiledFunction>,
    rates: Vec<CompiledFunction>,
    events: Vec<CompiledFunction>,
    corners: Vec<CompiledFunction>,
    /// The arguments of functions that may vary faster than the motion.
    narrow: Vec<(FunctionGrowth, CompiledFunction)>,
}

impl Smooth {
    fn new(system: &System, events: &[Event]) -> Result<Self, SystemError> {
        let events: Vec<Expr> = events.iter().map(|event| event.expression.clone()).collect();
        let known =
            || system.state.iter().chain([&system.time]).chain(system.numbers.keys()).copied();
        let mut corners = Corners {
            stem: fresh_stem("side", &known().collect::<Vec<_>>()),
            arguments: Vec::new(),
            guards: Guards::new(&system.numbers),
        };
        let rates: Vec<Expr> =
            system.right.iter().map(|right| corners.smooth(right)).collect::<Result<_, _>>()?;
        let states = system.state.iter().copied();
        let sides = (0..corners.arguments.len()).map(|index| corners.side(index));
        let names: Vec<Symbol> = states
            .chain(sides)
            .chain([system.time])
            .chain(system.numbers.keys().copied())
            .collect();
        let compiled = |expressions: &[Expr]| {
            let compiled =
                expressions.iter().map(|expression| CompiledFunction::new(expression, &names));
            compiled.collect::<Result<Vec<_>, EvaluationError>>()
        };
        let guards: Vec<Guard> = corners
            .arguments
            .iter()
            .map(|argument| Guard::new(argument, &system.numbers))
            .collect();
        let narrow = arguments(&rates, &system.state, &guards, &system.numbers).into_iter().map(
            |Argument { kind, expression }| {
                Ok::<_, EvaluationError>((kind, CompiledFunction::new(&expression, &names)?))
            },
        );
        Ok(Self {
            narrow: narrow.collect::<Result<_, _>>()?,
            typed: compiled(&system.right)?,
            rates: compiled(&rates)?,
            events: compiled(&events)?,
            corners: compiled(&corners.arguments)?,
        })
    }

    /// Returns scratch memory for the arguments, with the numbers in their places.
    fn arguments(&self, system: &System) -> Vec<f64> {
        let before = self.rates.len() + self.corners.len() + 1;
        let numbers = system.numbers.values().copied();
        std::iter::repeat_n(0.0, before).chain(numbers).collect()
    }
}

/// The corners found so far: the arguments whose signs choose between formulas. They may contain
/// the sides of earlier corners.
struct Corners {
    stem: String,
    arguments: Vec<Expr>,
    guards: Guards,
}

impl Corners {
    fn side(&self, index: usize) -> Symbol {
        Symbol::new(&format!("{}{index}", self.stem))
    }

    /// Returns the sign of an argument, expressed by the side of its corner.
    fn sign(&mut self, argument: &Expr) -> Expr {
        let guard = self.guards.find_or_add(argument);
        if guard.is_new {
            self.arguments.push(argument.clone());
        }
        let side = Expr::from(self.side(guard.index));
        match guard.is_aligned {
            true => side,
            false => -side,
        }
    }

    /// Returns the expression with the sides in place of the signs.
    fn smooth(&mut self, expression: &Expr) -> Result<Expr, ExprError> {
        expression.fold(|expr, children: &[Expr]| match (expr.node(), children) {
            (Node::Function(Function::Absolute, _), [u]) => {
                Ok(Expr::product([self.sign(u), u.clone()]))
            }
            (Node::Function(function @ (Function::Sign | Function::Step), _), [u]) => {
                Expr::function(*function, vec![self.sign(u)])
            }
            (Node::Function(function @ (Function::Maximum | Function::Minimum), _), [u, w]) => {
                let minus = |expr: &Expr| Expr::product([Expr::from(-1), expr.clone()]);
                let side = self.sign(&Expr::sum([u.clone(), minus(w)]));
                let [above, below] = [side.clone(), minus(&side)]
                    .map(|side| Expr::function(Function::Step, vec![side]));
                let (larger, smaller) = match function {
                    Function::Maximum => (u, w),
                    _ => (w, u),
                };
                Ok(Expr::sum([
                    Expr::product([above?, larger.clone()]),
                    Expr::product([below?, smaller.clone()]),
                ]))
            }
            _ => expr.with_children(children),
        })
    }
}
