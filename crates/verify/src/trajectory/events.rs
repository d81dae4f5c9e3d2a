//! Events at an instant: which guards have passed through zero, their resets, and the sides of the guards
//! behind them.
//!
//! ```text
//! watched:   s (g - g_0) falls through zero,  s = 1 or -1, g_0 = 0         from a side of the guard
//!            s = the sign of g a moment later, g_0 = g where s g < 0       from a state on the guard
//! ```
//!
//! A motion that has just had an event is on its guard up to rounding, which must neither cause a second event
//! nor hide the next. Therefore the side to which it leaves is that of the Taylor polynomial of g, and from
//! there only the return is watched. The side s and the level g_0 are constant states of the equations.
//!
//! At one time: guards that the motion passes are taken in the order of the events; then those whose sign a
//! reset or an impact has changed (R. Goebel, R. G. Sanfelice, A. R. Teel, *Hybrid Dynamical Systems*,
//! Princeton 2012, chapter 2: jumps of a hybrid time domain).

use super::state_functions::StateFunctions;
use super::{TrajectoryError, TrajectoryRequest, work_of};
use crate::event::StateEvent;
use crate::expr::{CompiledList, Expr};
use crate::symbol::Symbol;
use crate::system::rate_along;

/// Largest value of a guard that counts as zero up to rounding, relative to its size.
const ON_GUARD: f64 = 1e-11;

/// The moment after which the side of a guard counts, relative to the duration of the motion: shorter
/// visits are not resolved.
const MOMENT: f64 = 1e-12;

/// Largest number of events at one time.
const MOST_AT_ONE_TIME: usize = 1_000;

/// Name of the work of events in the account of energy.
pub(super) const WORK_OF_EVENTS: &str = "events";

/// Number of derivatives of a guard that tell its side.
const RATES: usize = 3;

/// An event that took place.
#[derive(Clone, Debug, PartialEq)]
pub struct EventOccurrence {
    /// The time.
    pub time: f64,
    /// The index of the event.
    pub event: usize,
    /// Coordinates and velocities before the event.
    pub before: Vec<f64>,
    /// Coordinates and velocities behind it.
    pub after: Vec<f64>,
    /// The energy that the event takes from the motion, negative where it gives some; `None` if there is no
    /// account of energy.
    pub loss: Option<f64>,
}

/// The events of a motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EventRecord {
    /// The events that took place, in order.
    pub occurrences: Vec<EventOccurrence>,
    /// The first time at which several events took place at once and their order matters; `None` if
    /// there is none.
    pub order_matters: Option<f64>,
}

/// The guard of an event on the way.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct GuardState {
    /// The side to which the motion has left the guard at the beginning of a stretch, 1 or -1; `None` if it
    /// was not on it.
    left: Option<f64>,
    /// The largest size of the guard so far.
    largest: f64,
    /// The error of the place at which it was located.
    slack: f64,
}

/// An event of a course, compiled.
#[derive(Clone, Debug)]
struct CompiledEvent {
    both_ways: bool,
    /// g, its derivatives along the motion, and its partial derivatives by states and time.
    guard: CompiledList,
    /// The indices of the states that are set, and their new values.
    targets: Vec<usize>,
    values: CompiledList,
}

/// The value of a guard at a state.
struct AtGuard {
    value: f64,
    rates: [f64; RATES],
    /// The size of the terms whose rounding the value has.
    size: f64,
}

impl AtGuard {
    /// The sign of the guard a moment later, from a state on it.
    fn side_after(&self, moment: f64) -> f64 {
        let [one, two, three] = self.rates;
        let later = one + moment * (two / 2.0 + moment * three / 6.0);
        if later == 0.0 { 0.0 } else { later.signum() }
    }

    /// The sign that the guard takes on at once.
    fn side_at_once(&self) -> f64 {
        self.rates.iter().find(|rate| **rate != 0.0).map_or(0.0, |rate| rate.signum())
    }
}

/// The sides of the guards just before an instant, and the guards that the motion passes there.
pub(super) struct BeforeEvents {
    sides: Vec<f64>,
    /// The events that the motion passes, and whether their guards grow.
    crossed: Vec<(usize, bool)>,
}

/// The events of a course, ready to be carried out.
#[derive(Clone, Debug)]
pub(super) struct CompiledEvents {
    events: Vec<CompiledEvent>,
    functions: StateFunctions,
    /// The index among all states of the work of the events; `None` if it is not accounted for.
    pub(super) work: Option<usize>,
    /// The index of the side of the first guard among all states; its level follows.
    first: usize,
    /// Coordinates and velocities.
    names: Vec<Symbol>,
    moment: f64,
}

/// The function at whose fall through zero a stretch ends: the guard of an event from the side that is
/// watched, given by the names of its side and its level.
pub(super) fn watched(event: &StateEvent, [side, level]: [Symbol; 2]) -> Expr {
    Expr::from(side) * (&event.guard - Expr::from(level))
}

impl CompiledEvents {
    /// The events of a course; the sides and levels of their guards begin at an index of all states.
    pub(super) fn new(
        course: &TrajectoryRequest,
        first: usize,
    ) -> Result<Option<Self>, TrajectoryError> {
        if course.events.is_empty() {
            return Ok(None);
        }
        let functions = StateFunctions::new(course);
        let events =
            course.events.iter().map(|event| CompiledEvent::new(course, event, &functions));
        Ok(Some(Self {
            events: events.collect::<Result<_, _>>()?,
            functions,
            work: work_of(course, WORK_OF_EVENTS),
            first,
            names: course.rates.states.clone(),
            moment: MOMENT * course.duration,
        }))
    }

    /// Returns the events with the numbers of a course that differs in its numbers alone.
    pub(super) fn with_numbers(&self, course: &TrajectoryRequest) -> Self {
        Self { functions: self.functions.with_numbers(course), ..self.clone() }
    }

    /// The guards before a motion begins.
    pub(super) fn guards(&self) -> Vec<GuardState> {
        vec![GuardState::default(); self.events.len()]
    }

    fn at(&self, event: usize, time: f64, state: &[f64]) -> AtGuard {
        let count = 1 + RATES + self.names.len() + 1;
        let values = self.functions.values(&self.events[event].guard, count, time, state);
        let (rates, slopes) = values[1..].split_at(RATES);
        let arguments = state[..self.names.len()].iter().chain([&time]);
        let parts = slopes.iter().zip(arguments).map(|(slope, value)| (slope * value).abs());
        AtGuard {
            value: values[0],
            rates: std::array::from_fn(|order| rates[order]),
            size: parts.filter(|part| part.is_finite()).fold(0.0, f64::max),
        }
    }

    /// Whether a state is on a guard, up to rounding.
    fn is_on(at: &AtGuard, guard: &GuardState) -> bool {
        at.value.abs() <= (ON_GUARD * at.size.max(guard.largest)).max(guard.slack)
    }

    /// The side of each guard: its sign, or on it the one to which the motion leaves.
    fn sides(&self, time: f64, state: &[f64], guards: &[GuardState]) -> Vec<f64> {
        let side = |(event, guard): (usize, &GuardState)| {
            let at = self.at(event, time, state);
            match Self::is_on(&at, guard) {
                true => at.side_after(self.moment),
                false => at.value.signum(),
            }
        };
        guards.iter().enumerate().map(side).collect()
    }

    /// Checks that all guards have values at the start.
    ///
    /// # Errors
    /// The first event whose guard has none.
    pub(super) fn check_start(&self, time: f64, state: &[f64]) -> Result<(), TrajectoryError> {
        match (0..self.events.len()).find(|event| !self.at(*event, time, state).value.is_finite()) {
            Some(event) => Err(TrajectoryError::GuardUndefined(event + 1)),
            None => Ok(()),
        }
    }

    /// The guards just before an instant, at which that of one event may have been reached.
    pub(super) fn before(
        &self,
        time: f64,
        state: &[f64],
        reached: Option<usize>,
        guards: &mut [GuardState],
    ) -> BeforeEvents {
        let mut crossed = Vec::new();
        for (event, guard) in guards.iter_mut().enumerate() {
            let at = self.at(event, time, state);
            guard.slack = 0.0;
            if reached == Some(event) {
                // Behind the event it is still on its guard, as exactly as it was located.
                guard.slack = 2.0 * at.value.abs();
                crossed.push((event, state[self.first + 2 * event] < 0.0));
            } else if Self::is_on(&at, guard) {
                let side = at.side_at_once();
                if side != 0.0 && guard.left != Some(side) {
                    crossed.push((event, side > 0.0));
                }
            }
        }
        BeforeEvents { sides: self.sides(time, state, guards), crossed }
    }

    /// Whether a crossing in this direction is one of an event.
    fn counts(&self, event: usize, rising: bool) -> bool {
        rising || self.events[event].both_ways
    }

    /// Carries out the events at an instant; `impacts` carries out the impacts on walls that a reset may
    /// cause. Returns whether they come to an end.
    ///
    /// # Errors
    /// A reset without a value, or what `impacts` returns.
    pub(super) fn settle(
        &self,
        time: f64,
        state: &mut [f64],
        before: BeforeEvents,
        guards: &[GuardState],
        record: &mut EventRecord,
        mut impacts: impl FnMut(&mut [f64]) -> Result<(), TrajectoryError>,
    ) -> Result<bool, TrajectoryError> {
        let BeforeEvents { mut sides, crossed } = before;
        let due: Vec<usize> = crossed
            .iter()
            .filter(|(event, rising)| self.counts(*event, *rising))
            .map(|(event, _)| *event)
            .collect();
        if due.len() > 1 && record.order_matters.is_none() && self.order_matters(time, state, &due)
        {
            record.order_matters = Some(time);
        }
        let mut turned: Vec<(usize, f64)> = Vec::new();
        for event in &due {
            self.reset(*event, time, state, record)?;
            let side = crossed.iter().find(|(own, _)| own == event);
            turned.extend(side.map(|(event, rising)| (*event, if *rising { -1.0 } else { 1.0 })));
        }
        if !due.is_empty() {
            impacts(state)?;
        }
        for count in 0_usize.. {
            let now = self.sides(time, state, guards);
            if count == 0 {
                // These have passed by the motion, and their resets say where they go.
                crossed.iter().for_each(|(event, _)| sides[*event] = now[*event]);
            }
            let jumped = (0..now.len()).find(|event| {
                now[*event] * sides[*event] < 0.0 && self.counts(*event, now[*event] > 0.0)
            });
            let Some(event) = jumped else { break };
            if count > MOST_AT_ONE_TIME {
                return Ok(false);
            }
            self.reset(event, time, state, record)?;
            impacts(state)?;
            sides = now;
            // Its own reset is no reason for an event to take place again.
            sides[event] = self.sides(time, state, guards)[event];
        }
        // A motion that turns round on a guard and is back within a moment has an accumulation of events.
        Ok(!turned.into_iter().any(|(event, side)| {
            let at = self.at(event, time, state);
            let is_on = Self::is_on(&at, &guards[event]);
            is_on && at.side_at_once() == side && at.side_after(self.moment) == -side
        }))
    }

    /// Whether the state behind these events depends on their order.
    fn order_matters(&self, time: f64, state: &[f64], events: &[usize]) -> bool {
        let behind = |order: &mut dyn Iterator<Item = &usize>| {
            let mut state = state.to_vec();
            order.for_each(|event| self.assign(*event, time, &mut state));
            state
        };
        let (one, other) = (behind(&mut events.iter()), behind(&mut events.iter().rev()));
        one.iter().zip(&other).any(|(one, other)| (one - other).abs() > 1e-12 * one.abs())
    }

    /// Sets the states of an event, all from the values before.
    fn assign(&self, event: usize, time: f64, state: &mut [f64]) {
        let event = &self.events[event];
        let values = self.functions.values(&event.values, event.targets.len(), time, state);
        for (target, value) in event.targets.iter().zip(values) {
            state[*target] = value;
        }
    }

    /// Carries out one event.
    fn reset(
        &self,
        event: usize,
        time: f64,
        state: &mut [f64],
        record: &mut EventRecord,
    ) -> Result<(), TrajectoryError> {
        let before = state[..self.names.len()].to_vec();
        let energy = self.functions.energy(time, state);
        self.assign(event, time, state);
        let after = state[..self.names.len()].to_vec();
        if let Some(place) = after.iter().position(|value| !value.is_finite()) {
            let name = self.names[place];
            return Err(TrajectoryError::ResetUndefined { event: event + 1, name, time });
        }
        let loss = energy.zip(self.functions.energy(time, state)).map(|(one, two)| one - two);
        if let (Some(work), Some(loss)) = (self.work, loss) {
            state[work] -= loss;
        }
        record.occurrences.push(EventOccurrence { time, event, before, after, loss });
        Ok(())
    }

    /// Sets the side from which each guard is watched on the next stretch, and its level.
    pub(super) fn watch(&self, time: f64, state: &mut [f64], guards: &mut [GuardState]) {
        for (event, guard) in guards.iter_mut().enumerate() {
            let at = self.at(event, time, state);
            let side = at.side_after(self.moment);
            guard.left = (Self::is_on(&at, guard) && side != 0.0).then_some(side);
            let (side, level) = match guard.left {
                Some(side) if side * at.value < 0.0 => (side, at.value),
                Some(side) => (side, 0.0),
                None if self.events[event].both_ways && at.value > 0.0 => (1.0, 0.0),
                None => (-1.0, 0.0),
            };
            state[self.first + 2 * event] = side;
            state[self.first + 2 * event + 1] = level;
        }
    }

    /// Raises the largest size of each guard to that of a state.
    pub(super) fn note_largest(&self, time: f64, state: &[f64], guards: &mut [GuardState]) {
        for (event, guard) in guards.iter_mut().enumerate() {
            let value = self.at(event, time, state).value.abs();
            guard.largest = guard.largest.max(if value.is_finite() { value } else { 0.0 });
        }
    }

    /// Whether a guard is on the other side of the one from which it was watched on the stretch that ends
    /// at this state, although it was not seen to pass through zero.
    pub(super) fn missed(&self, time: f64, state: &[f64], guards: &[GuardState]) -> bool {
        guards.iter().enumerate().any(|(event, guard)| {
            let at = self.at(event, time, state);
            guard.left.is_some_and(|side| side * at.value < 0.0) && !Self::is_on(&at, guard)
        })
    }
}

impl CompiledEvent {
    fn new(
        course: &TrajectoryRequest,
        event: &StateEvent,
        functions: &StateFunctions,
    ) -> Result<Self, TrajectoryError> {
        let undefined = |error| TrajectoryError::EventUndefined(Box::new(event.clone()), error);
        let (states, right) = (&course.rates.states, &course.rates.right);
        let time = Symbol::new("t");
        let mut guard = vec![event.guard.clone()];
        for order in 0..RATES {
            // Beyond a corner there is no rate, and the one before tells the side.
            let rate = rate_along(&guard[order], time, states, right);
            guard.push(rate.unwrap_or_else(Expr::zero));
        }
        for name in states.iter().chain([&time]) {
            guard.push(event.guard.differentiate(*name).unwrap_or_else(|_| Expr::zero()));
        }
        let place = |name: &Symbol| states.iter().position(|state| state == name);
        let (targets, values): (Vec<usize>, Vec<Expr>) = event
            .assignments
            .iter()
            .filter_map(|(name, value)| Some((place(name)?, value.clone())))
            .unzip();
        Ok(Self {
            both_ways: event.both_ways,
            guard: functions.compiled(&guard).map_err(undefined)?,
            targets,
            values: functions.compiled(&values).map_err(undefined)?,
        })
    }
}
