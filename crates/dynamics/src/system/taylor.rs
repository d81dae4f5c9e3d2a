//! Integration by Taylor series of the states: coefficients, step sizes, and the corners and events
//! on a step.
//!
//! References: A. Jorba, M. Zou, *Experimental Mathematics* 14 (2005) 99 (order and step from the
//! series); R. E. Moore, *Methods and Applications of Interval Analysis*, SIAM 1979, section 3.4
//! (coefficients by recurrences along the expression).
//!
//! ```text
//! y(t + s) = sum_n y_n s^n,   (n + 1) y_(n+1) = F_n      F_n: coefficient of s^n along the expression, each part once
//! step: the longest h with |y_k| h^k <= tolerance^(k/p) * size of y on the step, for the last orders k; events and corners alike
//! event: g(t, y) = 0, found on the series of g itself, so that two crossings in one step are two
//! ```
//!
//! Time is measured from the start, so that a late start costs no digits.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use pulp::{Arch, Simd, WithSimd};

use super::narrow::{FunctionGrowth, end_of_step};
use super::polynomial::{roots, sign_at_start, value};
use super::roots::{Equations, Root, equations, roots as corner_roots};
use super::steps::TaylorSteps;
use super::{
    Event, EventCrossing, Path, PathEnd, PathRepresentation, System, SystemError, SystemOptions,
    end_of_range, is_vanishing, within_range, without_value,
};
use crate::expr::Expr;
use crate::numeric::ode::root::find_root;
use crate::series::recurrence::{RecurrenceError, Recurrences};
use crate::series::tape::Tape;
use crate::symbol::Symbol;

/// Checks that there are recurrences for the right sides of a system and these events.
///
/// # Errors
/// [`RecurrenceError`] for a function without a recurrence.
pub(super) fn check(system: &System, events: &[Event]) -> Result<(), RecurrenceError> {
    const ANY: f64 = 0.1;
    let equations = Equations::as_written(system, &expressions(events));
    SystemSeries::new(&equations, &system.numbers, ANY).map(drop)
}

fn expressions(events: &[Event]) -> Vec<&Expr> {
    events.iter().map(|event| &event.expression).collect()
}

/// The recurrences for the right sides of a system and for events, to the order with which steps
/// within the tolerance are cheapest; for each side of the roots their own, derived when a motion
/// first comes there.
#[derive(Clone, Debug)]
pub(super) struct Expansions {
    tolerance: f64,
    roots: Arc<[Root]>,
    known: Arc<Mutex<BTreeMap<Vec<bool>, SystemSeries>>>,
}

impl Expansions {
    /// Prepares the recurrences of a system and these events.
    ///
    /// # Errors
    /// As [`check`].
    pub(super) fn new(
        system: &System,
        events: &[Event],
        tolerance: f64,
    ) -> Result<Self, RecurrenceError> {
        let events = expressions(events);
        let equations = Equations::as_written(system, &events);
        let as_written = SystemSeries::new(&equations, &system.numbers, tolerance)?;
        let roots: Arc<[Root]> = corner_roots(system, &events).into();
        let known = match roots.is_empty() {
            true => [(vec![], as_written)].into(),
            false => BTreeMap::new(),
        };
        Ok(Self { tolerance, roots, known: Arc::new(Mutex::new(known)) })
    }

    /// Returns the recurrences where the arguments of the roots have these signs; `None` if they
    /// cannot be written.
    fn on_side(&self, system: &System, events: &[Event], signs: &[f64]) -> Option<SystemSeries> {
        let side: Vec<bool> = signs.iter().map(|sign| *sign > 0.0).collect();
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(series) = known.get(&side).and_then(|own| own.with_numbers(&system.numbers)) {
            return Some(series);
        }
        let events = expressions(events);
        let equations = match self.roots.is_empty() {
            true => Equations::as_written(system, &events),
            false => equations(system, &events, &self.roots, signs).ok()?,
        };
        let series = SystemSeries::new(&equations, &system.numbers, self.tolerance).ok()?;
        known.entry(side).or_insert_with(|| series.clone());
        Some(series)
    }

    /// The order of the series.
    fn order(&self) -> usize {
        order(self.tolerance)
    }
}

/// Returns the order that reaches the tolerance with the fewest operations (Jorba and Zou).
fn order(tolerance: f64) -> usize {
    (1.0 - 0.5 * tolerance.ln()).ceil() as usize + 1
}

/// Returns the length of the first step by series, and the largest absolute value of every state on
/// it, up to the end of the run or the next corner; `None` if there is no series.
pub(super) fn first_step(
    system: &System,
    [start, end]: [f64; 2],
    values: &[f64],
    events: &[Event],
) -> Option<(f64, Vec<f64>)> {
    const SAMPLES: u32 = 8;
    let equations = Equations::as_written(system, &expressions(events));
    let mut expansion = SystemSeries::new(&equations, &system.numbers, f64::EPSILON).ok()?;
    expansion.begin(start, values);
    expansion.expand(start, values).ok()?;
    let reach = expansion.longest_step;
    // The series of a free flight reaches to infinity, but the flight ends at the next corner.
    let longest = reach.min(end - start);
    let corner = expansion.first_corner(longest).filter(|(_, place)| *place > 0.0);
    let looked_at = corner.map_or(longest, |(_, place)| place);
    let size = |state: usize| {
        let place = |sample: u32| looked_at * f64::from(sample) / f64::from(SAMPLES);
        let sizes = (0..=SAMPLES).map(|sample| value(expansion.state(state), place(sample)).abs());
        sizes.fold(0.0, f64::max)
    };
    Some((reach, (0..values.len()).map(size).collect()))
}

/// Number of motions side by side: they fill a register of 512 bits, or two or four smaller ones.
pub const LANES: usize = 8;

/// Follows a run to its end.
pub(super) fn follow(mut run: TaylorRun) -> Result<Path, SystemError> {
    loop {
        if let Some(reason) = run.before_step() {
            return Ok(run.finish(reason));
        }
        run.expansion.compute();
        if let Some(reason) = run.step()? {
            return Ok(run.finish(reason));
        }
    }
}

/// Follows several runs, up to [`LANES`] of those with the same recurrences side by side, and
/// returns their paths in order; each is bit for bit the same as alone.
pub(super) fn follow_together(mut runs: Vec<TaylorRun>) -> Vec<Result<Path, SystemError>> {
    let mut tapes: Vec<(SystemSeries, Tape<LANES>)> = vec![];
    let mut ends: Vec<Option<Result<PathEnd, SystemError>>> = runs.iter().map(|_| None).collect();
    while let Some(first) = ends.iter().position(Option::is_none) {
        let alike = |index: &usize| {
            ends[*index].is_none() && runs[*index].expansion.is_like(&runs[first].expansion)
        };
        let mut lanes: Vec<usize> = (first..runs.len()).filter(alike).take(LANES).collect();
        lanes.retain(|index| {
            ends[*index] = runs[*index].before_step().map(Ok);
            ends[*index].is_none()
        });
        let Some(series) = lanes.first().map(|index| &runs[*index].expansion) else { continue };
        let known = tapes.iter().position(|(own, _)| own.is_like(series)).unwrap_or_else(|| {
            tapes.push((series.clone(), series.tape.side_by_side()));
            tapes.len() - 1
        });
        let (series, tape) = &mut tapes[known];
        for (lane, index) in lanes.iter().enumerate() {
            tape.load(lane, &runs[*index].expansion.tape);
        }
        tape.expand(series.rates());
        let longest_steps = series.longest_steps(tape);
        for (lane, (index, longest_step)) in lanes.into_iter().zip(longest_steps).enumerate() {
            runs[index].expansion.take_from(tape, lane, longest_step);
            ends[index] = runs[index].step().transpose();
        }
    }
    let finished =
        |(run, end): (TaylorRun, Result<PathEnd, SystemError>)| end.map(|end| run.finish(end));
    runs.into_iter().zip(ends.into_iter().flatten()).map(finished).collect()
}

/// A run in progress.
pub(super) struct TaylorRun<'a> {
    system: &'a System,
    events: &'a [Event],
    options: &'a SystemOptions,
    expansions: Expansions,
    /// The signs of the arguments of the roots.
    root_signs: Vec<f64>,
    /// The recurrences for these signs.
    expansion: SystemSeries,
    start: f64,
    end: f64,
    duration: f64,
    /// The time since the start.
    time: f64,
    /// The states, then the variables of the roots that act.
    values: Vec<f64>,
    /// The signs of the event functions after the last step.
    signs: Vec<f64>,
    steps: TaylorSteps,
    occurrences: Vec<EventCrossing>,
    /// Number of consecutive steps that returned to a corner at once.
    stuck: usize,
    /// The corner at which the last step ended, and the speed of its argument there.
    met: Option<(usize, f64)>,
    /// The data to take back the last step; `None` if it ended at a corner or an event, and cannot
    /// be taken back.
    last: Option<StepUndo>,
    /// Number of halvings of the step from the present point.
    halvings: i32,
}

/// Largest number of consecutive halvings of a step.
const MOST_HALVINGS: i32 = 12;

/// A step that is about to be taken.
struct NextStep {
    /// The value at its end of the variable of the series.
    reach: f64,
    /// The time since the start at which it ends.
    until: f64,
    /// The first corner on it, and the value of the variable there.
    corner: Option<(usize, f64)>,
}

/// The values that are restored if a step is taken back.
struct StepUndo {
    length: f64,
    values: Vec<f64>,
    signs: Vec<f64>,
    sides: Vec<f64>,
    occurrences: usize,
}

impl<'a> TaylorRun<'a> {
    /// Prepares a run between two times from these values.
    ///
    /// # Errors
    /// [`SystemError`] if there is no series on any side of the roots.
    pub(super) fn new(
        system: &'a System,
        [start, end]: [f64; 2],
        values: &[f64],
        events: &'a [Event],
        options: &'a SystemOptions,
        expansions: Expansions,
    ) -> Result<Self, SystemError> {
        let no_series = || SystemError::Start(system.state.first().copied().unwrap_or(system.time));
        let sign = |root: &Root| match root_argument(system, root, start, values) < 0.0 {
            true => -1.0,
            false => 1.0,
        };
        let mut root_signs: Vec<f64> = expansions.roots.iter().map(sign).collect();
        let mut expansion =
            expansions.on_side(system, events, &root_signs).ok_or_else(no_series)?;
        let variables = |expansion: &SystemSeries| {
            let acting = expansion.acting.iter().map(|root| &expansions.roots[*root]);
            let own = acting.map(|root| root_variable(system, root, start, values));
            values.iter().copied().chain(own).collect::<Vec<f64>>()
        };
        // A motion that begins where a root does may begin towards either side.
        for attempt in 0..=root_signs.len() {
            expansion.begin(start, &variables(&expansion));
            let left = expansion.left_root(&root_signs).filter(|_| attempt < root_signs.len());
            let Some(left) = left else { break };
            root_signs[left] *= -1.0;
            expansion = expansions.on_side(system, events, &root_signs).ok_or_else(no_series)?;
        }
        expansion.take_root_sides(&root_signs);
        Ok(Self {
            system,
            events,
            options,
            start,
            end,
            duration: end - start,
            time: 0.0,
            values: variables(&expansion),
            signs: vec![0.0; events.len()],
            steps: TaylorSteps::new(values.len(), expansions.order()),
            occurrences: vec![],
            stuck: 0,
            met: None,
            last: None,
            halvings: 0,
            expansions,
            root_signs,
            expansion,
        })
    }

    /// Returns the path of a run that has ended.
    fn finish(mut self, reason: PathEnd) -> Path {
        if self.steps.count() == 0 {
            // A run that ended at its start gets one step of length zero.
            self.values.truncate(self.system.state.len());
            self.steps = TaylorSteps::at_rest(self.values);
        }
        Path {
            end: if reason == PathEnd::Reached { self.end } else { self.start + self.time },
            motion: PathRepresentation::Taylor { steps: self.steps, start: self.start },
            reason,
            occurrences: self.occurrences,
        }
    }

    /// Sets the expansion at the start of the next step; returns the reason if the run ends there.
    fn before_step(&mut self) -> Option<PathEnd> {
        let over = self.time >= self.duration;
        if !over && self.steps.count() >= self.options.step_limit {
            return Some(PathEnd::StepLimit);
        }
        if !over && self.options.interrupt.is_requested() {
            return Some(PathEnd::Interrupted);
        }
        self.expansion.expand_about(self.start + self.time, &self.values);
        None
    }

    /// Takes a step along the computed series, or takes the last step back. Returns the reason why
    /// the run ends, `None` if it goes on.
    ///
    /// # Errors
    /// [`SystemError`] for a state or an event without a value at the start of the run.
    fn step(&mut self) -> Result<Option<PathEnd>, SystemError> {
        let over = self.time >= self.duration;
        let now = self.start + self.time;
        let defined = self.defined();
        let last = self.last.take();
        if let Some(last) = last {
            if self.halvings < MOST_HALVINGS
                && (defined.is_err() || self.has_missed_something(&last, now))
            {
                self.take_back(last);
                return Ok(None);
            }
            self.halvings = 0;
        }
        match defined {
            Err(_) if over => return Ok(Some(PathEnd::Reached)),
            Err(error) if self.steps.count() == 0 => return Err(error),
            Err(_) => return Ok(Some(self.without_value())),
            Ok(()) => {}
        }
        if over {
            return Ok(Some(PathEnd::Reached));
        }
        let Some(step) = self.next_step(now) else {
            return Ok(Some(PathEnd::Singular));
        };
        let reach = step.reach;
        let met = self.met.take();
        if met.is_some_and(|(corner, speed)| self.expansion.stays_on(corner, speed * reach, reach))
        {
            return Ok(Some(PathEnd::Sticks));
        }
        Ok(self.advance(&step))
    }

    /// Checks that all states and events have a series here.
    ///
    /// # Errors
    /// [`SystemError`] with the first state or event without one.
    fn defined(&mut self) -> Result<(), SystemError> {
        let settled = self.expansion.switch_corners();
        // Behind the states come the variables of the roots.
        let name = |state: usize| *self.system.state.get(state).unwrap_or(&self.system.time);
        settled.map_err(|state| SystemError::Start(name(state)))?;
        let is_undefined =
            |event: &usize| !self.expansion.event(*event).iter().all(|value| value.is_finite());
        match (0..self.events.len()).find(is_undefined) {
            Some(event) => Err(SystemError::Event(event)),
            None => Ok(()),
        }
    }

    /// Returns the reason why the run ends here if there is no series.
    fn without_value(&self) -> PathEnd {
        let before = self.steps.last_start().unwrap_or(self.time);
        without_value(self.values.iter().copied(), [before, self.time])
    }

    /// Returns the next step: the longest within the tolerance, shortened so that it crosses neither
    /// the end of the run, nor a critical time, nor a narrow place. `None` if it has no length.
    fn next_step(&mut self, now: f64) -> Option<NextStep> {
        let left = self.duration - self.time;
        let next = next_critical(&self.system.critical, now);
        let limit = next.map_or(left, |next| (next - now).min(left));
        let longest = match self.expansion.acting.is_empty() {
            true => self.expansion.longest_step.min(limit),
            // At rest in contact the series are constant, and the time is proportional to s.
            false => self.expansion.longest_step.min(2.0 * limit / self.expansion.time_rate()),
        };
        let corner = self.expansion.first_corner(longest);
        // Beyond the end of contact the time would go back.
        let forward = corner.map_or(longest, |(_, place)| place);
        let within = self.expansion.step_within(limit, forward);
        let longest = within.unwrap_or(longest);
        let reach = self.expansion.short_of_narrow(longest) * 0.5_f64.powi(self.halvings);
        let corner = corner.filter(|(_, place)| *place <= reach);
        let until = match within.is_some() && reach == longest && limit == left {
            true => self.duration,
            false => self.time + self.expansion.elapsed(reach),
        };
        // Where a root acts, its variable moves on although the time may not.
        let moves = match self.expansion.acting.is_empty() {
            true => now + reach > now,
            false => corner.is_some() || self.expansion.elapsed(reach) > 0.0,
        };
        (reach > 0.0 && moves).then_some(NextStep { reach, until, corner })
    }

    /// Advances by a step, or to the first corner or stopping event on it. Returns the reason if the
    /// run ends there.
    fn advance(&mut self, &NextStep { reach, until, corner }: &NextStep) -> Option<PathEnd> {
        // A corner within the step ends it, and so does an event that stops.
        let mut corner = corner;
        let mut length = corner.map_or(reach, |(_, place)| place);
        let before = self.values.clone();
        let range = end_of_range(length, |place| {
            self.expansion.tape.values(place, &mut self.values);
            within_range(self.values.iter().copied())
        });
        if let Some(end) = range {
            (corner, length) = (None, end);
        }
        let last = StepUndo {
            length,
            values: before,
            signs: self.signs.clone(),
            sides: self.expansion.sides(),
            occurrences: self.occurrences.len(),
        };
        let mut met = self.expansion.crossings(&mut self.signs, length);
        met.retain(|(event, _, rising)| self.events[*event].counts(*rising));
        let stop = met.iter().position(|found| self.events[found.0].stops);
        let stop = stop.map(|index| {
            met.truncate(index + 1);
            length = met[index].1;
            met[index].0
        });
        let (start, time) = (self.start, self.time);
        self.occurrences.extend(met.into_iter().map(|(event, place, rising)| EventCrossing {
            event,
            time: start + (time + self.expansion.elapsed(place)),
            rising,
        }));
        let series = (0..self.system.state.len()).map(|state| self.expansion.state(state));
        self.steps.push([time, length], series, self.expansion.time());
        self.steps.forget_before(self.options.keep_from - start);
        if stop.is_some() || range.is_some() {
            self.expansion.tape.values(length, &mut self.values);
        }
        let whole = corner.is_none() && stop.is_none() && range.is_none();
        self.last = whole.then_some(last);
        self.time = if whole { until } else { time + self.expansion.elapsed(length) };
        if let Some(event) = stop {
            return Some(PathEnd::Event(event));
        }
        if range.is_some() {
            return Some(match is_vanishing([time, self.time]) {
                true => PathEnd::Singular,
                false => PathEnd::Overflow,
            });
        }
        let (corner, _) = corner?;
        self.halvings = 0;
        // A motion that leaves a corner and returns at once, over and over, sticks to it.
        const OFTEN: usize = 20;
        let [gone, whole] = [length, reach].map(|place| self.expansion.elapsed(place));
        let at_once = gone <= 1e-12 * whole + 4.0 * f64::EPSILON * self.time;
        self.stuck = if at_once { self.stuck + 1 } else { 0 };
        if self.stuck > OFTEN {
            return Some(PathEnd::Sticks);
        }
        if corner < self.root_signs.len() {
            return self.pass_root(corner);
        }
        self.met = self.expansion.speed_at(corner, length).map(|speed| (corner, speed));
        self.expansion.cross(corner);
        None
    }

    /// Goes over to the other side of a root. Returns the reason if the run ends there.
    fn pass_root(&mut self, passed: usize) -> Option<PathEnd> {
        self.root_signs[passed] *= -1.0;
        let Some(mut next) = self.expansions.on_side(self.system, self.events, &self.root_signs)
        else {
            return Some(PathEnd::Singular);
        };
        let (states, variables) = self.values.split_at(self.system.state.len());
        let now = self.start + self.time;
        let variable = |root: &usize| {
            let before = self.expansion.acting.iter().position(|own| own == root);
            match before {
                _ if *root == passed => 0.0,
                Some(place) => variables[place],
                None => root_variable(self.system, &self.expansions.roots[*root], now, states),
            }
        };
        let variables = next.acting.iter().map(variable);
        let values: Vec<f64> = states.iter().copied().chain(variables).collect();
        if next.tape.corners().count() > next.roots {
            next.begin(now, &values);
        }
        next.take_root_sides(&self.root_signs);
        (self.values, self.expansion) = (values, next);
        None
    }

    /// Whether the rates at the end of a step differ from those of its series, for instance because
    /// of a wall that did not show at its beginning.
    fn has_missed_something(&mut self, last: &StepUndo, now: f64) -> bool {
        /// Largest error of a rate times the step, over the size of the state on it.
        const ASTRAY: f64 = 1e-8;
        // The truncated terms are within the tolerance, and their derivatives within the tolerance
        // times the next order.
        let astray = ASTRAY.max((self.expansion.order + 1) as f64 * self.options.tolerance);
        let apart = |(state, series): (usize, &[f64])| {
            let rate = self.expansion.rate(state);
            let (mut power, mut size, mut change) = (1.0, series[0].abs(), 0.0);
            for (order, coefficient) in series.iter().enumerate().skip(1) {
                power *= last.length;
                size += (coefficient * power).abs();
                change += order as f64 * coefficient * power;
            }
            let apart = (change - rate * last.length).abs();
            (apart > astray * size).then_some((state, apart / last.length))
        };
        let missed: Vec<(usize, f64)> = self.steps.last().enumerate().filter_map(apart).collect();
        !missed.is_empty() && !self.is_rounding(&missed, now)
    }

    /// Whether the errors of these rates, each given with the index of its state, are no larger
    /// than the last digits of the states can cause. Two bodies that touch to within rounding push
    /// each other by the rounding of their positions, which may be the only force on a step from
    /// rest.
    fn is_rounding(&mut self, missed: &[(usize, f64)], now: f64) -> bool {
        /// Number of units in the last place of a state that count as rounding.
        const DIGITS: f64 = 4.0;
        let here: Vec<f64> = missed.iter().map(|(state, _)| self.expansion.rate(*state)).collect();
        let mut by_rounding = vec![0.0; missed.len()];
        let mut values = self.values.clone();
        for state in 0..self.system.state.len() {
            values[state] += DIGITS * f64::EPSILON * self.values[state].abs();
            let expanded =
                values[state] != self.values[state] && self.expansion.expand_once(now, &values);
            if expanded {
                for ((sum, here), (missed, _)) in by_rounding.iter_mut().zip(&here).zip(missed) {
                    *sum += (self.expansion.rate(*missed) - here).abs();
                }
            }
            values[state] = self.values[state];
        }
        // The expansion at the unchanged state is restored.
        let again = self.expansion.expand_once(now, &self.values);
        again && missed.iter().zip(by_rounding).all(|((_, apart), sum)| *apart <= sum)
    }

    /// Returns to the start of the last step, from which half of it will be taken.
    fn take_back(&mut self, last: StepUndo) {
        let Some(time) = self.steps.pop() else { return };
        (self.time, self.values) = (time, last.values);
        self.signs = last.signs;
        self.expansion.set_sides(&last.sides);
        self.occurrences.truncate(last.occurrences);
        self.halvings += 1;
    }
}

/// Returns the next of these times that is farther away than rounding; `None` if there is none.
fn next_critical(critical: &[f64], now: f64) -> Option<f64> {
    let beyond = now + 4.0 * f64::EPSILON * now.abs();
    critical.get(critical.partition_point(|time| *time <= beyond)).copied()
}

/// The argument of a root in these states.
fn root_argument(system: &System, root: &Root, time: f64, states: &[f64]) -> f64 {
    let mut values = system.numbers.clone();
    values.extend(system.state.iter().copied().zip(states.iter().copied()));
    values.insert(system.time, time);
    root.argument.evaluate(&values).unwrap_or(f64::NAN)
}

/// The variable of a root in these states.
fn root_variable(system: &System, root: &Root, time: f64, states: &[f64]) -> f64 {
    root_argument(system, root, time, states).abs().powf(1.0 / f64::from(root.degree))
}

/// The recurrences of right sides and events, with their series.
#[derive(Clone, Debug)]
pub(super) struct SystemSeries {
    /// The tape, whose variables are the states, then that of the series. The states of the system
    /// come first, then the variables of the roots that act, then, if there are any, the time.
    tape: Tape,
    states: usize,
    events: usize,
    /// The roots that act.
    acting: Vec<usize>,
    /// The number of roots; their sides are the first corners.
    roots: usize,
    order: usize,
    /// The places of the rates, then of the events, then of the arguments of narrow functions.
    outputs: Vec<usize>,
    narrow: Vec<FunctionGrowth>,
    /// The longest step within the bounds of states, events and corners.
    longest_step: f64,
    /// Bounds of the last terms of states, events and corners.
    of_steps: Allowance,
    /// Bounds of the last terms of the arguments of narrow functions.
    of_arguments: Allowance,
}

impl SystemSeries {
    /// Derives the recurrences of these equations, to the order for this tolerance.
    fn new(
        equations: &Equations,
        numbers: &BTreeMap<Symbol, f64>,
        tolerance: f64,
    ) -> Result<Self, RecurrenceError> {
        /// Tolerance of the arguments of narrow functions, which need not be known to rounding.
        const CLOSELY: f64 = 1e-9;
        let order = order(tolerance);
        let states = equations.states.iter().map(|state| (*state, None));
        let variables: Vec<_> = states.chain([(equations.variable, Some(1))]).collect();
        let mut recurrences = Recurrences::new(&variables, numbers, order);
        for end in &equations.ends {
            recurrences.watch(end)?;
        }
        let narrow = equations.narrow.iter().map(|(argument, _)| argument);
        let outputs = equations.right.iter().chain(&equations.events).chain(narrow);
        let outputs = outputs.map(|output| recurrences.add(output)).collect::<Result<_, _>>()?;
        Ok(Self {
            tape: recurrences.into_tape(),
            states: equations.states.len(),
            events: equations.events.len(),
            acting: equations.acting.clone(),
            roots: equations.ends.len(),
            order,
            outputs,
            narrow: equations.narrow.iter().map(|(_, kind)| *kind).collect(),
            longest_step: f64::NAN,
            of_steps: Allowance::new(tolerance, order),
            of_arguments: Allowance::new(CLOSELY, order),
        })
    }

    /// Whether another expansion has the same recurrences, so that both may be computed side by
    /// side.
    fn is_like(&self, other: &Self) -> bool {
        self.tape.is_like(&other.tape)
    }

    /// The series of the time; `None` if it is the variable itself.
    fn time(&self) -> Option<&[f64]> {
        (!self.acting.is_empty()).then(|| self.state(self.states - 1))
    }

    /// The time that passes from the start of the step until a value of its variable.
    fn elapsed(&self, place: f64) -> f64 {
        match self.time() {
            None => place,
            Some([]) => 0.0,
            Some([_, since_start @ ..]) => place * value(since_start, place),
        }
    }

    /// The rate of the time in the variable of the series.
    fn time_rate(&self) -> f64 {
        self.time().and_then(|series| series.get(1)).copied().unwrap_or(1.0)
    }

    /// Returns the value of the variable at which this time has passed, on a step on which the time
    /// does not go back; `None` if it does not pass on it.
    fn step_within(&self, time: f64, reach: f64) -> Option<f64> {
        if self.time().is_none() {
            return (reach >= time).then_some(time);
        }
        let beyond = |place: f64| self.elapsed(place) - time;
        match beyond(reach) {
            0.0 => Some(reach),
            passed if passed > 0.0 => find_root(beyond, 0.0, reach).ok(),
            _ => None,
        }
    }

    /// Returns the first root whose side the motion leaves at once, or on whose side it does not
    /// move; `signs` are the signs of the arguments of all.
    fn left_root(&self, signs: &[f64]) -> Option<usize> {
        let mut sides = self.tape.corners().zip(signs).enumerate();
        sides.find_map(|(root, ((series, side), sign))| {
            let is_left = match self.acting.contains(&root) {
                true => side < 0.0 || series.iter().all(|value| *value == 0.0),
                false => side * sign < 0.0,
            };
            is_left.then_some(root)
        })
    }

    /// Takes the sides of the roots on which their arguments have these signs.
    fn take_root_sides(&mut self, signs: &[f64]) {
        let mut sides = self.sides();
        for (root, sign) in signs.iter().enumerate() {
            sides[root] = if self.acting.contains(&root) { 1.0 } else { *sign };
        }
        self.set_sides(&sides);
    }

    /// Returns this expansion with other values of the parameters; `None` if these may lead to
    /// other recurrences.
    fn with_numbers(&self, numbers: &BTreeMap<Symbol, f64>) -> Option<Self> {
        let mut other = self.clone();
        other.tape.set_numbers(numbers).then_some(other)
    }

    /// Takes the side of every corner on which this point lies, or to which it moves.
    pub(super) fn begin(&mut self, time: f64, values: &[f64]) {
        self.expand_about(time, values);
        let corners = self.tape.corners().count();
        // The expansion is repeated because the argument of one corner may depend on the side of
        // another.
        for _ in 0..if corners > 0 { corners + 1 } else { 0 } {
            // Undefined series do not matter here, since the sides may still be wrong.
            self.compute();
            if !self.tape.take_sides() {
                break;
            }
        }
    }

    /// Computes all coefficients about a point.
    ///
    /// # Errors
    /// As [`Self::switch_corners`].
    pub(super) fn expand(&mut self, time: f64, values: &[f64]) -> Result<(), usize> {
        self.expand_about(time, values);
        self.compute();
        self.switch_corners()
    }

    /// Computes all coefficients about a point on the present sides of the corners; returns whether
    /// they are finite.
    fn expand_once(&mut self, time: f64, values: &[f64]) -> bool {
        self.expand_about(time, values);
        self.compute();
        self.check().is_ok()
    }

    /// Sets the variables to the point of the expansion.
    fn expand_about(&mut self, time: f64, values: &[f64]) {
        for (variable, value) in values.iter().chain([&time]).enumerate() {
            self.tape.set(variable, 0, *value);
        }
        if self.order > 0 {
            self.tape.set(self.states, 1, 1.0);
        }
    }

    /// Computes all coefficients about the present point.
    fn compute(&mut self) {
        self.tape.expand(&self.outputs[..self.states]);
        [self.longest_step] = self.longest_steps(&self.tape);
    }

    /// Takes the series that were computed in a lane, with the longest step along them.
    fn take_from(&mut self, tape: &Tape<LANES>, lane: usize, longest_step: f64) {
        let places = (0..self.states).chain(self.outputs[self.states..].iter().copied());
        tape.copy_lane_to(lane, places, &mut self.tape);
        self.longest_step = longest_step;
    }

    /// Returns the longest step within the bounds of every state, event and argument of a corner,
    /// for each lane of a tape of these recurrences.
    fn longest_steps<const L: usize>(&self, tape: &Tape<L>) -> [f64; L] {
        let events = &self.outputs[self.states..][..self.events];
        let places = (0..self.states).chain(events.iter().chain(tape.corner_places()).copied());
        self.of_steps.longest_steps(tape, places)
    }

    /// The places of the rates.
    fn rates(&self) -> &[usize] {
        &self.outputs[..self.states]
    }

    /// Switches to the other side of corners that were passed together with another one: the motion
    /// is beyond them and moving away.
    ///
    /// # Errors
    /// The index of the first state whose series is not finite; 0 if the argument of a corner has a
    /// value but no series.
    fn switch_corners(&mut self) -> Result<(), usize> {
        for _ in 0..=self.tape.corners().count() {
            let left = self.tape.corners().enumerate().position(|(corner, (series, side))| {
                let slope = series.get(1).copied().unwrap_or(0.0);
                corner >= self.roots && series[0] * side < 0.0 && slope * side < 0.0
            });
            let Some(corner) = left else { break };
            self.cross(corner);
            self.compute();
        }
        self.check()
    }

    /// Checks that states and corners have series; the errors are those of
    /// [`Self::switch_corners`].
    fn check(&self) -> Result<(), usize> {
        let is_defined = |series: &[f64]| series.iter().all(|value| value.is_finite());
        if let Some(state) = (0..self.states).find(|&state| !is_defined(self.state(state))) {
            return Err(state);
        }
        // A corner whose argument has a value but no series, such as a root that begins here, could
        // change its side unnoticed.
        let mut corners = self.tape.corners();
        match corners.any(|(series, _)| series[0].is_finite() && !is_defined(series)) {
            true => Err(0),
            false => Ok(()),
        }
    }

    /// The series of a state.
    pub(super) fn state(&self, state: usize) -> &[f64] {
        self.tape.series(state)
    }

    /// Returns the rate of a state, the coefficient of order 1.
    fn rate(&self, state: usize) -> f64 {
        self.state(state).get(1).copied().unwrap_or(0.0)
    }

    /// The series of an event.
    pub(super) fn event(&self, event: usize) -> &[f64] {
        self.tape.series(self.outputs[self.states + event])
    }

    /// Returns the length, at most `longest`, of a step that ends beside the first narrow place, if
    /// there is one.
    fn short_of_narrow(&mut self, longest: f64) -> f64 {
        let arguments = self.outputs.iter().skip(self.states + self.events);
        let mut length = longest;
        for (kind, output) in self.narrow.iter().zip(arguments) {
            let series = self.tape.series(*output);
            if end_of_step(*kind, series, length).is_none() {
                continue;
            }
            // The series of the argument is valid only within its own step length.
            let [valid] = self.of_arguments.longest_steps(&self.tape, [*output].into_iter());
            length = length.min(valid);
            if let Some(end) = end_of_step(*kind, series, length) {
                length = end;
            }
        }
        length
    }

    /// Returns the crossings of all events on the step in order: the index of the event, the time
    /// since the start of the step, and whether its function rises there. `signs` are the signs
    /// after the last step: a crossing that rounding has put between two steps counts at the
    /// beginning of the second.
    fn crossings(&self, signs: &mut [f64], length: f64) -> Vec<(usize, f64, bool)> {
        let mut met = Vec::new();
        // On a step of length zero the sign would be due to rounding.
        if length == 0.0 {
            return met;
        }
        for (event, before) in signs.iter_mut().enumerate() {
            let series = self.event(event);
            let sign = sign_at_start(series, 0.0, length);
            if sign == 0.0 {
                continue;
            }
            if *before == -sign {
                met.push((event, 0.0, sign > 0.0));
            }
            *before = sign;
            for (place, rising) in roots(series, 0.0, length) {
                met.push((event, place, rising));
                *before = if rising { 1.0 } else { -1.0 };
            }
        }
        met.sort_by(|one, other| one.1.total_cmp(&other.1));
        met
    }

    /// Returns the first corner met within a step, and the time since its start: 0 if the motion
    /// turns back to the corner on which it starts, or leaves it on the other side. `None` if no
    /// corner is met.
    pub(super) fn first_corner(&self, length: f64) -> Option<(usize, f64)> {
        let met = |(index, (series, side)): (usize, (&[f64], f64))| {
            let (here, slope) = (side * series[0], side * series.get(1).copied().unwrap_or(0.0));
            let rounding = 1e-14 * length * slope.abs();
            let leading = series.iter().find(|value| **value != 0.0);
            let leaves = here == 0.0 && leading.is_some_and(|leading| side * leading < 0.0);
            if leaves || here <= rounding && slope < 0.0 {
                return Some((index, 0.0));
            }
            let mut crossed = roots(series, 0.0, length).into_iter();
            let left = crossed.find(|(_, rising)| *rising != (side > 0.0));
            left.map(|(place, _)| (index, place))
        };
        // A corner whose argument has no value is left out.
        let corners = self.tape.corners().enumerate();
        let found = corners.filter(|(_, (series, _))| series[0].is_finite()).filter_map(met);
        found.min_by(|one, other| one.1.total_cmp(&other.1))
    }

    /// Returns the speed of the argument of a corner at a time since the start of the step.
    fn speed_at(&self, corner: usize, time: f64) -> Option<f64> {
        let (series, _) = self.tape.corners().nth(corner)?;
        let terms = series.iter().enumerate().skip(1).rev();
        let slope =
            terms.fold(0.0, |sum, (order, coefficient)| sum * time + order as f64 * coefficient);
        Some(slope.abs())
    }

    /// Whether only rounding leads away from a corner within a step: its argument stays far below
    /// the `change` that it would have had at its speed before. If the argument is zero throughout,
    /// the motion does not stick, but goes on.
    fn stays_on(&self, corner: usize, change: f64, length: f64) -> bool {
        /// Ratio to `change` below which a value is rounding.
        const ROUNDING: f64 = 1e-12;
        let Some((series, _)) = self.tape.corners().nth(corner) else {
            return false;
        };
        let reached = series.iter().rev().fold(0.0, |sum, value| sum * length + value.abs());
        reached > 0.0 && reached <= ROUNDING * change
    }

    /// The sides of the corners.
    fn sides(&self) -> Vec<f64> {
        self.tape.corners().map(|(_, side)| side).collect()
    }

    /// Sets the sides of all corners.
    fn set_sides(&mut self, sides: &[f64]) {
        for (corner, side) in sides.iter().enumerate() {
            if self.tape.corners().nth(corner).is_some_and(|(_, now)| now != *side) {
                self.cross(corner);
            }
        }
    }

    /// Switches to the other side of a corner.
    pub(super) fn cross(&mut self, corner: usize) {
        self.tape.cross(corner);
    }
}

/// Number of last terms of a series that are examined: symmetry may leave some of them zero.
const LAST: usize = 8;

/// Bounds of the last terms of a series, relative to its largest term of lower order on the step:
///
/// ```text
/// |c_k| h^k <= tolerance^(k/p) max_(j<first) |c_j| h^j      for the last orders k = first..p
/// ```
///
/// Each bound holds up to an `h` and not beyond, so that the longest step is the least over k of the
/// greatest over j of `(tolerance^(k/p) |c_j/c_k|)^(1/(k - j))`: differences of logarithms.
#[derive(Clone, Debug)]
struct Allowance {
    /// The lowest of the last orders.
    first: usize,
    /// The binary logarithms of the bounds `tolerance^(k/p)` from the order `first` on.
    bounds: Vec<f64>,
    /// The reciprocals `1/n`.
    reciprocals: Vec<f64>,
}

impl Allowance {
    /// The bounds for series up to this order.
    fn new(tolerance: f64, order: usize) -> Self {
        let first = order.saturating_sub(LAST - 1).max(order / 2 + 1);
        let bound = |k: usize| tolerance.log2() * k as f64 / order as f64;
        Self {
            first,
            bounds: (first..=order).map(bound).collect(),
            reciprocals: (0..=order).map(|n| 1.0 / n as f64).collect(),
        }
    }

    /// Returns the longest step on which the series at these places are within their bounds, for
    /// each lane; infinity if nothing bounds it. A series without a value bounds nothing.
    ///
    /// Some hundred subtractions, multiplications and comparisons for each series.
    fn longest_steps<const L: usize>(
        &self,
        tape: &Tape<L>,
        places: impl Iterator<Item = usize>,
    ) -> [f64; L] {
        struct Shorten<'a, const L: usize> {
            allowance: &'a Allowance,
            series: &'a [[f64; L]],
            least: &'a mut [f64; L],
        }
        impl<const L: usize> WithSimd for Shorten<'_, L> {
            type Output = ();

            #[inline(always)]
            fn with_simd<S: Simd>(self, _: S) {
                self.allowance.shorten(self.series, self.least);
            }
        }
        let mut least = [f64::INFINITY; L];
        let arch = Arch::new();
        for place in places {
            let series = tape.lanes(place);
            arch.dispatch(Shorten { allowance: self, series, least: &mut least });
        }
        least.map(f64::exp2)
    }

    /// Reduces the logarithms of the steps to what a series allows.
    #[inline(always)]
    fn shorten<const L: usize>(&self, series: &[[f64; L]], least: &mut [f64; L]) {
        const MOST: usize = 32;
        let mut lower = [[0.0; L]; MOST];
        let lower = &mut lower[..self.first];
        let mut sum = [0.0; L];
        for (logarithms, coefficients) in lower.iter_mut().zip(series) {
            for lane in 0..L {
                logarithms[lane] = logarithm(coefficients[lane]);
                sum[lane] += coefficients[lane];
            }
        }
        let mut shortest = [f64::INFINITY; L];
        for (k, bound) in (self.first..).zip(&self.bounds) {
            let mut room = [0.0; L];
            for lane in 0..L {
                room[lane] = bound - logarithm(series[k][lane]);
                sum[lane] += series[k][lane];
            }
            let mut longest = [f64::NEG_INFINITY; L];
            for (logarithms, reciprocal) in lower.iter().zip(self.reciprocals[..=k].iter().rev()) {
                for lane in 0..L {
                    let step = (logarithms[lane] + room[lane]) * reciprocal;
                    longest[lane] = if step > longest[lane] { step } else { longest[lane] };
                }
            }
            for lane in 0..L {
                let bounds = longest[lane] > f64::NEG_INFINITY && longest[lane] < shortest[lane];
                shortest[lane] = if bounds { longest[lane] } else { shortest[lane] };
            }
        }
        for lane in 0..L {
            let bounds = sum[lane].is_finite() && shortest[lane] < least[lane];
            least[lane] = if bounds { shortest[lane] } else { least[lane] };
        }
    }
}

/// Returns the binary logarithm of the absolute value of a number to 0.01, from its bits: the
/// exponent, and a parabola for the mantissa. It is minus infinity for zero.
#[inline(always)]
fn logarithm(number: f64) -> f64 {
    const EXPONENT: u32 = 52;
    const MANTISSA: u64 = (1 << EXPONENT) - 1;
    /// Of `f + c f (1 - f)`, nearest to the logarithm of `1 + f` everywhere.
    const CURVATURE: f64 = 0.344;
    let bits = number.abs().to_bits();
    // Both conversions are sums with numbers whose last bits are free, which any processor does side by side.
    let whole = f64::from_bits((bits >> EXPONENT) | 2.0_f64.powi(52).to_bits()) - 2.0_f64.powi(52);
    let fraction = f64::from_bits((bits & MANTISSA) | 1.0_f64.to_bits()) - 1.0;
    let logarithm = whole - 1023.0 + fraction * (1.0 + CURVATURE * (1.0 - fraction));
    if bits == 0 { f64::NEG_INFINITY } else { logarithm }
}
