//! Integration by Taylor series of the states: coefficients, step sizes, and the corners and events
//! on a step.
//!
//! References: A. Jorba, M. Zou, *Experimental Mathematics* 14 (2005) 99 (order and step from the
//! series); R. E. Moore, *Methods and Applications of Interval Analysis*, SIAM 1979, section 3.4
//! (coefficients by recurrences along the expression).
//!
//! ```text
//! y(t + s) = sum_n y_n s^n,   (n + 1) y_(n+1) = F_n      F_n: coefficient of s^n along the expression, each part once
//! step: the largest h with |y_p| h^p <= tolerance * size of y on the step, for the last orders p; events and corners alike
//! event: g(t, y) = 0, found on the series of g itself, so that two crossings in one step are two
//! ```
//!
//! Time is measured from the start, so that a late start costs no digits.

use std::collections::BTreeMap;

use super::narrow::{FunctionGrowth, end_of_step};
use super::polynomial::{powers, roots, sign_at_start, value};
use super::steps::TaylorSteps;
use super::{
    Event, EventCrossing, Path, PathEnd, PathRepresentation, System, SystemError, SystemOptions,
    end_of_range, is_vanishing, within_range, without_value,
};
use crate::series::recurrence::{RecurrenceError, Recurrences};
use crate::series::tape::Tape;
use crate::symbol::Symbol;

/// Checks that there are recurrences for the right sides of a system and these events.
///
/// # Errors
/// [`RecurrenceError`] for a function without a recurrence.
pub(super) fn check(system: &System, events: &[Event]) -> Result<(), RecurrenceError> {
    const ANY: f64 = 0.1;
    expansion(system, events, ANY).map(drop)
}

/// Derives the recurrences for the right sides of a system and these events, to the order with
/// which steps within this tolerance are cheapest.
pub(super) fn expansion(
    system: &System,
    events: &[Event],
    tolerance: f64,
) -> Result<SystemSeries, RecurrenceError> {
    /// Tolerance of the arguments of narrow functions, which need not be known to rounding.
    const CLOSELY: f64 = 1e-9;
    let order = order(tolerance);
    let states = system.state.iter().map(|state| (*state, None));
    let variables: Vec<(Symbol, Option<usize>)> = states.chain([(system.time, Some(1))]).collect();
    let mut recurrences = Recurrences::new(&variables, &system.numbers, order);
    let narrow = system.narrow.iter().map(|argument| &argument.expression);
    let outputs = system.right.iter().chain(events.iter().map(|event| &event.expression));
    let outputs =
        outputs.chain(narrow).map(|output| recurrences.add(output)).collect::<Result<_, _>>()?;
    Ok(SystemSeries {
        tape: recurrences.into_tape(),
        states: system.state.len(),
        events: events.len(),
        order,
        outputs,
        narrow: system.narrow.iter().map(|argument| argument.kind).collect(),
        powers: PowerTable::new(order),
        of_steps: Allowance::new(tolerance, order),
        of_arguments: Allowance::new(CLOSELY, order),
    })
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
    let tolerance = f64::EPSILON;
    let mut expansion = expansion(system, events, tolerance).ok()?;
    expansion.begin(start, values);
    expansion.expand(start, values).ok()?;
    let reach = expansion.step();
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

/// Follows several runs of the same recurrences, [`LANES`] of them side by side, and returns their
/// paths in order; each is bit for bit the same as alone.
pub(super) fn follow_together(mut runs: Vec<TaylorRun>) -> Vec<Result<Path, SystemError>> {
    let Some(first) = runs.first() else { return vec![] };
    let mut tape: Tape<LANES> = first.expansion.tape.side_by_side();
    let rates = first.expansion.rates().to_vec();
    let mut ends: Vec<Option<Result<PathEnd, SystemError>>> = runs.iter().map(|_| None).collect();
    for (runs, ends) in runs.chunks_mut(LANES).zip(ends.chunks_mut(LANES)) {
        loop {
            for (lane, (run, end)) in runs.iter_mut().zip(&mut *ends).enumerate() {
                if end.is_none() {
                    *end = run.before_step().map(Ok);
                    tape.load(lane, &run.expansion.tape);
                }
            }
            if ends.iter().all(Option::is_some) {
                break;
            }
            tape.expand(&rates);
            for (lane, (run, end)) in runs.iter_mut().zip(&mut *ends).enumerate() {
                if end.is_none() {
                    run.expansion.take_from(&tape, lane);
                    *end = run.step().transpose();
                }
            }
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
    expansion: SystemSeries,
    start: f64,
    end: f64,
    duration: f64,
    /// The time since the start.
    time: f64,
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

/// The values that are restored if a step is taken back.
struct StepUndo {
    length: f64,
    signs: Vec<f64>,
    sides: Vec<f64>,
    occurrences: usize,
}

impl<'a> TaylorRun<'a> {
    /// Prepares a run between two times from these values, with the recurrences of these events.
    pub(super) fn new(
        system: &'a System,
        [start, end]: [f64; 2],
        values: &[f64],
        events: &'a [Event],
        options: &'a SystemOptions,
        mut expansion: SystemSeries,
    ) -> Self {
        expansion.begin(start, values);
        let order = expansion.order;
        Self {
            system,
            events,
            options,
            expansion,
            start,
            end,
            duration: end - start,
            time: 0.0,
            values: values.to_vec(),
            signs: vec![0.0; events.len()],
            steps: TaylorSteps::new(values.len(), order),
            occurrences: vec![],
            stuck: 0,
            met: None,
            last: None,
            halvings: 0,
        }
    }

    /// Whether the run has the recurrences of an expansion, so that both may be computed side by
    /// side.
    pub(super) fn is_like(&self, expansion: &SystemSeries) -> bool {
        self.expansion.tape.is_like(&expansion.tape)
    }

    /// Returns the path of a run that has ended.
    fn finish(mut self, reason: PathEnd) -> Path {
        if self.steps.count() == 0 {
            // A run that ended at its start gets one step of length zero.
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
        let reach = self.step_length(now);
        if reach.is_nan() || reach <= 0.0 || now + reach == now {
            return Ok(Some(PathEnd::Singular));
        }
        let met = self.met.take();
        if met.is_some_and(|(corner, speed)| self.expansion.stays_on(corner, speed * reach, reach))
        {
            return Ok(Some(PathEnd::Sticks));
        }
        Ok(self.advance(reach))
    }

    /// Checks that all states and events have a series here.
    ///
    /// # Errors
    /// [`SystemError`] with the first state or event without one.
    fn defined(&mut self) -> Result<(), SystemError> {
        let settled = self.expansion.switch_corners();
        settled.map_err(|state| SystemError::Start(self.system.state[state]))?;
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

    /// Returns the length of the next step: the largest within the tolerance, shortened so that it
    /// crosses no critical time and no narrow place.
    fn step_length(&mut self, now: f64) -> f64 {
        let reach = self.expansion.step().min(self.duration - self.time);
        let next = next_critical(&self.system.critical, now);
        let reach = next.map_or(reach, |next| reach.min(next - now));
        let reach = self.expansion.short_of_narrow(reach);
        reach * 0.5_f64.powi(self.halvings)
    }

    /// Advances by this time, or to the first corner or stopping event. Returns the reason if the
    /// run ends there.
    fn advance(&mut self, reach: f64) -> Option<PathEnd> {
        // A corner within the step ends it, and so does an event that stops.
        let mut corner = self.expansion.first_corner(reach);
        let mut length = corner.map_or(reach, |(_, place)| place);
        let range = end_of_range(length, |place| {
            self.expansion.tape.values(place, &mut self.values);
            within_range(self.values.iter().copied())
        });
        if let Some(end) = range {
            (corner, length) = (None, end);
        }
        let last = StepUndo {
            length,
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
            time: start + (time + place),
            rising,
        }));
        let series = (0..self.values.len()).map(|state| self.expansion.state(state));
        self.steps.push(time, series);
        if stop.is_some() || range.is_some() {
            self.expansion.tape.values(length, &mut self.values);
        }
        let whole = corner.is_none() && stop.is_none() && range.is_none();
        self.last = whole.then_some(last);
        let at_end = time + length >= self.duration && whole;
        self.time = if at_end { self.duration } else { time + length };
        if let Some(event) = stop {
            return Some(PathEnd::Event(event));
        }
        if range.is_some() {
            return Some(match is_vanishing([time, time + length]) {
                true => PathEnd::Singular,
                false => PathEnd::Overflow,
            });
        }
        let (corner, _) = corner?;
        self.halvings = 0;
        self.met = self.expansion.speed_at(corner, length).map(|speed| (corner, speed));
        self.expansion.cross(corner);
        // A motion that leaves a corner and returns at once, over and over, sticks to it.
        const OFTEN: usize = 20;
        let at_once = length <= 1e-12 * reach + 4.0 * f64::EPSILON * self.time;
        self.stuck = if at_once { self.stuck + 1 } else { 0 };
        (self.stuck > OFTEN).then_some(PathEnd::Sticks)
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
        for state in 0..values.len() {
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
        let Some((time, values)) = self.steps.pop() else { return };
        (self.time, self.values) = (time, values);
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

/// The recurrences of right sides and events, with their series.
#[derive(Clone, Debug)]
pub(super) struct SystemSeries {
    /// The tape, whose variables are the states, then time.
    tape: Tape,
    states: usize,
    events: usize,
    order: usize,
    /// The places of the rates, then of the events, then of the arguments of narrow functions.
    outputs: Vec<usize>,
    narrow: Vec<FunctionGrowth>,
    powers: PowerTable,
    /// Bounds of the last terms of states, events and corners.
    of_steps: Allowance,
    /// Bounds of the last terms of the arguments of narrow functions.
    of_arguments: Allowance,
}

impl SystemSeries {
    /// Returns this expansion with other values of the parameters; `None` if these may lead to
    /// other recurrences.
    pub(super) fn with_numbers(&self, numbers: &BTreeMap<Symbol, f64>) -> Option<Self> {
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
    }

    /// Takes the series that were computed in a lane.
    fn take_from(&mut self, tape: &Tape<LANES>, lane: usize) {
        let places = (0..self.states).chain(self.outputs[self.states..].iter().copied());
        tape.copy_lane_to(lane, places, &mut self.tape);
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
            let left = self.tape.corners().position(|(series, side)| {
                let slope = series.get(1).copied().unwrap_or(0.0);
                series[0] * side < 0.0 && slope * side < 0.0
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

    /// The longest step within the tolerance of every state, event and argument of a corner.
    pub(super) fn step(&mut self) -> f64 {
        let followed = (0..self.states).map(|state| self.tape.series(state));
        let events = self.outputs.iter().skip(self.states).take(self.events);
        let events = events.map(|output| self.tape.series(*output));
        // A corner whose argument has no value is left out.
        let finite = |series: &&[f64]| series.iter().all(|value| value.is_finite());
        let corners = self.tape.corners().map(|(series, _)| series).filter(finite);
        followed.chain(events).chain(corners).fold(f64::INFINITY, |longest, series| {
            self.of_steps.longest_step(series, longest, &mut self.powers)
        })
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
            length = self.of_arguments.longest_step(series, length, &mut self.powers);
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
            let sign = sign_at_start(series, length);
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

/// The factor by which a step that is too long for the tolerance is shortened.
const SHORTER: f64 = 0.9;

/// Bounds of the last terms of a series, relative to its size on the step.
#[derive(Clone, Debug)]
struct Allowance {
    order: usize,
    /// The bounds for the orders from [`Self::first`] on.
    parts: [f64; LAST],
}

impl Allowance {
    /// The bounds `tolerance^(k/order)` for the last orders k.
    fn new(tolerance: f64, order: usize) -> Self {
        let mut parts = [0.0; LAST];
        let first = Self::first(order);
        for (part, k) in parts.iter_mut().zip(first..=order) {
            *part = tolerance.powf(k as f64 / order as f64);
        }
        Self { order, parts }
    }

    /// Returns the lowest of the last orders, which lies above the orders that determine the size.
    fn first(order: usize) -> usize {
        order.saturating_sub(LAST - 1).max(order / 2 + 1)
    }

    /// Returns the longest step, at most `longest`, on which the last terms of a series are within
    /// their bounds.
    fn longest_step(&self, series: &[f64], longest: f64, powers: &mut PowerTable) -> f64 {
        const TRIALS: usize = 400;
        let order = self.order;
        let Some(lead) = series.iter().position(|c| *c != 0.0) else {
            return longest;
        };
        // The root test gives a first step, which is shortened until the last terms are small
        // enough.
        let mut h = longest;
        let of_longest = powers.powers(longest);
        let first = Self::first(order).max(lead + 1);
        // A root is computed only if it may be the shortest.
        let (mut ratios, mut least) = ([f64::NAN; LAST], [f64::INFINITY; LAST]);
        let mut shortest = f64::INFINITY;
        for (slot, k) in (first..=order).enumerate() {
            let (size, power) = (series[k].abs(), of_longest[k - lead]);
            let clearly_longer =
                power >= f64::MIN_POSITIVE && series[lead].abs() > size * power * (1.0 + 1e-9);
            if size != 0.0 && !clearly_longer {
                ratios[slot] = series[lead].abs() / size;
                let [low, high] = coarse_logarithm(ratios[slot]);
                least[slot] = low / (k - lead) as f64;
                shortest = shortest.min(high / (k - lead) as f64);
            }
        }
        for (slot, k) in (first..=order).enumerate() {
            if least[slot] <= shortest {
                h = h.min(ratios[slot].powf(1.0 / (k - lead) as f64));
            }
        }
        let in_vain = match h.is_finite() {
            true => self.trials_in_vain(series, lead, powers.powers(h)).min(TRIALS),
            false => 0,
        };
        let first_trial = (0..in_vain).fold(h, |h, _| h * SHORTER);
        // If powers underflow, the trials cannot be skipped: they would give another result.
        let is_known = powers.powers(first_trial)[order] >= f64::MIN_POSITIVE;
        let (mut h, trials) =
            if is_known { (first_trial, in_vain..TRIALS) } else { (h, 0..TRIALS) };
        for _ in trials {
            if h.is_infinite() || self.is_within(series, lead, powers.powers(h)) {
                break;
            }
            h *= SHORTER;
        }
        h
    }

    /// Returns the number of trials, from the step with these powers on, that are certain to fail:
    /// the size of a series falls with the step, so that the last terms must at least fall to their
    /// bounds relative to the present size.
    fn trials_in_vain(&self, series: &[f64], lead: usize, powers: &[f64]) -> usize {
        let size = self.size(series, lead, powers);
        let first = Self::first(self.order);
        // A logarithm is computed only if it may be the largest.
        let (mut ratios, mut greatest) = ([f64::NAN; LAST], [f64::NEG_INFINITY; LAST]);
        let mut largest = 0.0_f64;
        for (slot, k) in (first..=self.order).enumerate() {
            let (term, allowed) = (series[k].abs() * powers[k], self.parts[slot] * size);
            if k > lead && term.is_finite() && allowed > 1e-280 {
                ratios[slot] = term / allowed;
                let [low, high] = coarse_logarithm(ratios[slot]);
                greatest[slot] = high / k as f64;
                largest = largest.max(low / k as f64);
            }
        }
        let trials =
            (first..=self.order).enumerate().map(|(slot, k)| match greatest[slot] >= largest {
                true => ratios[slot].ln() / (-(k as f64) * SHORTER.ln()),
                false => 0.0,
            });
        (trials.fold(0.0, f64::max) - 1e-6) as usize
    }

    /// Returns the size of a series on the step with these powers: its largest leading term.
    fn size(&self, series: &[f64], lead: usize, powers: &[f64]) -> f64 {
        let leading = lead..lead.max(self.order / 2) + 1;
        let terms = series[leading.clone()].iter().zip(&powers[leading]);
        let sizes = terms.map(|(coefficient, power)| coefficient.abs() * power);
        sizes.fold(0.0, |largest, size| if size > largest { size } else { largest })
    }

    /// Whether the last terms of a series that begins with the order `lead` are within their bounds
    /// on the step with these powers.
    fn is_within(&self, series: &[f64], lead: usize, powers: &[f64]) -> bool {
        let term = |k: usize| series[k].abs() * powers[k];
        let size = self.size(series, lead, powers);
        let first = Self::first(self.order);
        for (k, part) in (first..self.order + 1).zip(self.parts) {
            let is_within = k <= lead || term(k) <= size * part;
            if !is_within {
                return false;
            }
        }
        true
    }
}

/// Returns bounds of the binary logarithm of a number that is not negative, from its bits: the
/// exponent, and a straight line for the mantissa, which is at most 0.0861 too low.
fn coarse_logarithm(number: f64) -> [f64; 2] {
    const TOO_LOW: f64 = 0.0861;
    if !number.is_normal() {
        return [f64::NEG_INFINITY, f64::INFINITY];
    }
    let low = number.to_bits() as f64 / (1_u64 << 52) as f64 - 1023.0;
    [low, low + TOO_LOW]
}

/// A table of the powers of one number, kept from call to call, since most series of a step are
/// evaluated at the same place.
#[derive(Clone, Debug)]
struct PowerTable {
    base: f64,
    table: Vec<f64>,
}

impl PowerTable {
    /// A table for this order and those below it.
    fn new(order: usize) -> Self {
        Self { base: f64::NAN, table: vec![0.0; order + 1] }
    }

    /// Returns `h^0, h^1, ...`
    fn powers(&mut self, h: f64) -> &[f64] {
        if h != self.base {
            powers(h, &mut self.table);
            self.base = h;
        }
        &self.table
    }
}
