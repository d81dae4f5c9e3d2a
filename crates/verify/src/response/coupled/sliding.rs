//! Motions across jumps of the rates and of the states, at impacts and other events, from event to event, with their variations.
//!
//! ```text
//! event       g falls through zero: y -> R(y),     behind: z -> R_y z + R_p + (f_behind - R_y f_before - R_t) (g_y z + g_p)/(dg/dt)_before
//! crossing    u_i changes its sign, and s_i with it
//! sticking    du_i/dt leads back to u_i = 0 from both sides: s_i solves du_i/dt = 0, |s_i| <= 1, until it leaves these bounds
//! variations  z' = f_y z + f_p,    behind an event:  z + (f_behind - f_before) (u_y z + u_p)/(du_i/dt)_before
//! sticking    z' = (f_y - f_s A^-1 g_y) z + f_p - f_s A^-1 g_p,     A = g_s of the surfaces that hold
//! ```
//!
//! (A. F. Filippov, *Differential Equations with Discontinuous Righthand Sides*, Kluwer 1988, chapter
//! 2; R. I. Leine and H. Nijmeijer, *Dynamics and Bifurcations of Non-Smooth Mechanical Systems*,
//! Springer 2004, chapter 7.) Where several surfaces hold at once their sides are the solution of
//! linear equations. Where sticking begins the variations lose the direction across the surface: one
//! multiplier is zero.
//!
//! An event is where u_i has fallen to a level just below zero, which rounding does not reach at the
//! onset of a slip, where u_i and its rate both begin at zero.

mod held;
mod passages;
mod resting;

use std::cell::{Cell, RefCell};
use std::rc::Rc;

use nalgebra::{DMatrix, DVector};

use super::flow::set_states;
use super::scaled_rates::ScaledRates;
use super::surfaces::{EventMap, JumpSurfaces};
use crate::numeric::ode::{Action, Event, IntegrationOptions, Point, end_or_event};
use held::{Held, set_shares};
pub(super) use resting::onto_walls;

/// Distance from a surface, in the sizes of the states, at which an event is: that of rounding.
const UNSEEN: f64 = 1e-12;

/// Distance from a surface, in the sizes of the states, within which a motion that begins there and
/// can stick does.
const AT_REST: f64 = 1e-9;

/// Largest number of events of a run.
const MOST_EVENTS: usize = 2_000;

/// Least number of steps of a run, so that no event is missed where nothing but time changes.
const LEAST_STEPS: f64 = 16.0;

/// Part of a run within which a motion sticks that does so all the time.
const SOON: f64 = 0.02;

/// Difference from its bound within which a side that has just reached it is there.
const ROUNDING: f64 = 1e-9;

/// The reason why a motion is not followed across jumps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SlidingStop {
    /// It meets this surface, beside others, ever again.
    Chatter(usize),
    /// The forces that hold it on several surfaces, this one of them, are not determined.
    Undetermined(usize),
    /// A rate has no value, or a step vanishes.
    NoValue,
    /// The motion rests on this wall, beside another one or where forces jump.
    RestsOnWall(usize, Option<usize>),
    /// Other events accumulate, or one takes place at once with another.
    EventsAccumulate,
}

/// A run from a start.
#[derive(Clone, Debug)]
pub(super) struct SlidingRun {
    /// The states at the end, then, if they were asked for, the variations of each by all states and
    /// by the parameter, everything in the sizes of the states.
    pub(super) values: Vec<f64>,
    /// The lowest and the highest value of each state.
    pub(super) bounds: [Vec<f64>; 2],
    /// Duration in which something sticks, or rests on a wall.
    pub(super) stuck: f64,
    /// The surfaces on which it sticks all the time, but for a moment at the start.
    pub(super) throughout: Vec<usize>,
    /// The number of impacts on walls, without those that accumulate before a rest.
    pub(super) impacts: usize,
    /// The number of rests on walls that begin.
    pub(super) rests: usize,
    /// The number of other events.
    pub(super) events: usize,
    /// The least speed of an impact or into an event, in the sizes of the states over the duration; infinite
    /// if there is none.
    pub(super) slowest: f64,
    /// The times of impacts and other events.
    pub(super) times: Vec<f64>,
    /// The step with which the motion would go on.
    pub(super) next_step: f64,
    /// Evaluations of the rates.
    pub(super) evaluations: u64,
}

/// The event that ends a leg.
#[derive(Clone, Copy, Debug)]
enum Meeting {
    /// The motion has reached this surface.
    Reached(usize),
    /// The side of this surface, on which it sticks, reaches this bound.
    Released(usize, f64),
    /// The gap of this event has fallen to zero.
    Event(usize),
    /// The wall on which the motion rests would have to pull.
    Lifted,
}

/// The state of a run.
struct EventRun<'a> {
    surfaces: &'a JumpSurfaces,
    sizes: &'a [f64],
    parameter: f64,
    /// The size of the variations beside the states; `None` if there are none.
    unit: Option<f64>,
    time: f64,
    values: Vec<f64>,
    /// The first step of the next leg; 0: chosen by the rates.
    next_step: f64,
    /// The side of each surface, 1 or -1; of those on which it sticks a value in between.
    sides: Vec<f64>,
    /// The surfaces on which it sticks.
    held: Held,
    bounds: [Vec<f64>; 2],
    /// The numbers of impacts and of other events, and of the last ones that followed each other at once.
    impacts: usize,
    events: usize,
    at_once: usize,
    /// The wall on which the motion rests, and the number of rests that have begun.
    resting: Option<usize>,
    rests: usize,
    /// The number of impacts at the last release.
    impacts_at_release: usize,
    /// The time of the last event, of all and of each, and the least speed into one.
    last: f64,
    passed: Vec<f64>,
    slowest: f64,
    /// The times of all impacts and other events.
    times: Vec<f64>,
    evaluations: Cell<u64>,
    /// The instants at which rates were asked for since the last event, each with the states.
    seen: RefCell<Vec<f64>>,
    /// The rates where nothing holds that were prepared before.
    prepared: RefCell<Vec<PreparedRates>>,
}

/// Rates where nothing holds, on these sides of the surfaces and on this wall if the motion rests on one.
struct PreparedRates {
    sides: Vec<f64>,
    resting: Option<usize>,
    rates: Rc<ScaledRates>,
}

/// Follows a motion from a start, in the sizes of the states, between two times. With a `unit` the
/// variations are followed too, counted in this unit.
///
/// # Errors
/// [`SlidingStop`].
pub(super) fn follow(
    surfaces: &JumpSurfaces,
    start: &[f64],
    [from, to]: [f64; 2],
    parameter: f64,
    sizes: &[f64],
    unit: Option<f64>,
    options: &IntegrationOptions,
) -> Result<SlidingRun, SlidingStop> {
    let mut run = EventRun::new(surfaces, start, from, parameter, sizes, unit);
    run.next_step = options.first_step;
    let options = IntegrationOptions {
        maximum_step: options.maximum_step.min((to - from) / LEAST_STEPS),
        ..*options
    };
    let mut stuck = 0.0;
    run.begin_at_rest(to - from)?;
    run.check_walls()?;
    run.begin()?;
    let mut throughout: Option<Vec<usize>> = None;
    for _ in 0..MOST_EVENTS {
        run.settle()?;
        let held = run.held.clone();
        let (began, rested) = (run.time, run.resting.is_some());
        let meeting = if run.time < to { run.leg([from, to], &options)? } else { None };
        if !held.is_empty() || rested {
            stuck += run.time - began;
        }
        // A guess of an orbit may begin a little beside a surface.
        if run.time - from > SOON * (to - from) {
            throughout.get_or_insert_with(|| held.all()).retain(|index| held.contains(*index));
        }
        match meeting {
            None => {
                return Ok(SlidingRun {
                    values: run.values,
                    bounds: run.bounds,
                    stuck,
                    throughout: throughout.unwrap_or_default(),
                    impacts: run.impacts,
                    rests: run.rests,
                    events: run.events,
                    slowest: run.slowest,
                    times: run.times,
                    next_step: run.next_step,
                    evaluations: run.evaluations.get(),
                });
            }
            Some(Meeting::Reached(index)) => run.meet(index)?,
            Some(Meeting::Released(index, side)) => run.release(index, side)?,
            Some(Meeting::Event(event)) => run.pass(event, to - from)?,
            Some(Meeting::Lifted) => run.lift(),
        }
    }
    let nearest = (0..run.sides.len()).min_by(|one, other| {
        let height = |index: usize| run.height(index).abs();
        height(*one).total_cmp(&height(*other))
    });
    Err(SlidingStop::Chatter(nearest.unwrap_or(0)))
}

/// The arguments of all functions at a time and a parameter, on the positive side of all surfaces.
fn at_beginning(surfaces: &JumpSurfaces, state: &[f64], at: [f64; 2]) -> Vec<f64> {
    let sides = surfaces.arguments.iter().map(|_| 1.0);
    state.iter().copied().chain(at).chain(sides).collect()
}

/// The least gap of an event at a time and a parameter, where every state changes by a unit of its size;
/// infinite without events.
pub(super) fn least_gap(
    surfaces: &JumpSurfaces,
    state: &[f64],
    at: [f64; 2],
    sizes: &[f64],
) -> f64 {
    let arguments = at_beginning(surfaces, state, at);
    let gap = |event: &EventMap| {
        let normal = event.normal.at(&arguments);
        let size: f64 =
            sizes.iter().enumerate().map(|(k, size)| (normal[(0, k)] * size).abs()).sum();
        event.gap.call(&arguments).abs() / size
    };
    surfaces.events.iter().map(gap).fold(f64::INFINITY, f64::min)
}

/// The gaps of all events at a time and a parameter, each with its rate.
pub(super) fn gaps(surfaces: &JumpSurfaces, state: &[f64], at: [f64; 2]) -> Vec<[f64; 2]> {
    let mut arguments = at_beginning(surfaces, state, at);
    let first = state.len() + 2;
    for (index, height) in surfaces.heights.iter().enumerate() {
        arguments[first + index] = if height.call(&arguments) < 0.0 { -1.0 } else { 1.0 };
    }
    let rates = surfaces.rates.at(&arguments);
    let gap = |event: &EventMap| {
        let normal = event.normal.at(&arguments);
        let carried: f64 = (0..state.len()).map(|k| normal[(0, k)] * rates[(k, 0)]).sum();
        [event.gap.call(&arguments), carried + normal[(0, state.len() + 1)]]
    };
    surfaces.events.iter().map(gap).collect()
}

/// The state behind the nearest event at a time and a parameter; `None` without events.
pub(super) fn behind_event(
    surfaces: &JumpSurfaces,
    state: &[f64],
    at: [f64; 2],
) -> Option<Vec<f64>> {
    let arguments = at_beginning(surfaces, state, at);
    let gap = |event: &&EventMap| event.gap.call(&arguments).abs();
    let nearest = surfaces.events.iter().min_by(|one, other| gap(one).total_cmp(&gap(other)))?;
    let after = nearest.after.at(&arguments);
    Some((0..surfaces.states).map(|i| after[(i, 0)]).collect())
}

/// The state mirrored in every wall behind which it is, at time zero.
pub(super) fn in_front_of_walls(
    surfaces: &JumpSurfaces,
    mut state: Vec<f64>,
    parameter: f64,
) -> Vec<f64> {
    let n = surfaces.states;
    for wall in surfaces.events.iter().filter(|event| event.is_wall) {
        let arguments = at_beginning(surfaces, &state, [0.0, parameter]);
        let gap = wall.gap.call(&arguments);
        if gap < 0.0 {
            let normal = wall.normal.at(&arguments);
            let square: f64 = (0..n).map(|k| normal[(0, k)].powi(2)).sum();
            for (k, value) in state.iter_mut().enumerate() {
                *value -= 2.0 * gap * normal[(0, k)] / square;
            }
        }
    }
    state
}

/// Whether a state is on a surface, to rounding.
pub(super) fn is_on_surface(
    surfaces: &JumpSurfaces,
    state: &[f64],
    time: f64,
    parameter: f64,
) -> bool {
    let sizes = vec![largest_of(state); state.len()];
    let run = EventRun::new(surfaces, state, time, parameter, &sizes, None);
    let is_near = |index: usize| run.height(index).abs() <= AT_REST * run.size_of_height(index);
    (0..surfaces.arguments.len()).any(is_near)
}

/// The largest absolute value, which is the size of all where no other is known.
fn largest_of(state: &[f64]) -> f64 {
    let largest = state.iter().map(|value| value.abs()).fold(0.0, f64::max);
    if largest > 0.0 { largest } else { 1.0 }
}

/// The rates at a state with their derivatives by the states and by the parameter, in columns; `None` if
/// they are not determined.
pub(super) fn linearised(
    surfaces: &JumpSurfaces,
    state: &[f64],
    time: f64,
    parameter: f64,
) -> Option<(DVector<f64>, DMatrix<f64>)> {
    let sizes = vec![largest_of(state); state.len()];
    let mut run = EventRun::new(surfaces, state, time, parameter, &sizes, None);
    run.begin().ok()?;
    let (all, slopes) = run.slopes(&run.here())?;
    Some((all.column(0).into_owned(), slopes))
}

impl<'a> EventRun<'a> {
    /// The state at the start, on no surface yet.
    fn new(
        surfaces: &'a JumpSurfaces,
        start: &[f64],
        time: f64,
        parameter: f64,
        sizes: &'a [f64],
        unit: Option<f64>,
    ) -> Self {
        let n = surfaces.states;
        let scaled = start.iter().zip(sizes).map(|(value, size)| value / size);
        let mut values: Vec<f64> = scaled.collect();
        if let Some(unit) = unit {
            values.resize(n + n * (n + 1), 0.0);
            for i in 0..n {
                values[n + i * (n + 1) + i] = unit;
            }
        }
        Self {
            surfaces,
            sizes,
            parameter,
            unit,
            time,
            values,
            next_step: 0.0,
            sides: vec![1.0; surfaces.arguments.len()],
            held: Held::default(),
            bounds: [start.to_vec(), start.to_vec()],
            impacts: 0,
            events: 0,
            at_once: 0,
            resting: None,
            rests: 0,
            impacts_at_release: 0,
            last: f64::NEG_INFINITY,
            passed: vec![f64::NEG_INFINITY; surfaces.events.len()],
            slowest: f64::INFINITY,
            times: Vec::new(),
            evaluations: Cell::new(0),
            seen: RefCell::default(),
            prepared: RefCell::default(),
        }
    }

    /// The rates where nothing holds, prepared once for all legs on the same sides.
    fn free_rates(&self) -> Rc<ScaledRates> {
        let all = &mut *self.prepared.borrow_mut();
        let is_known =
            |known: &&PreparedRates| known.sides == self.sides && known.resting == self.resting;
        if let Some(known) = all.iter().find(is_known) {
            return known.rates.clone();
        }
        let rest = self.resting_map();
        let rates = rest.map_or(&self.surfaces.rates, |rest| &rest.rates);
        let varied = rest.map_or(&self.surfaces.varied, |rest| &rest.varied);
        let varied = self.unit.map(|unit| (varied, unit));
        let behind_time = &self.here()[self.surfaces.states + 1..];
        let own = Rc::new(ScaledRates::new(rates, varied, behind_time, self.sizes));
        let (sides, resting) = (self.sides.clone(), self.resting);
        all.push(PreparedRates { sides, resting, rates: own.clone() });
        own
    }

    /// The arguments of all functions where the motion is.
    fn here(&self) -> Vec<f64> {
        let states = self.values.iter().zip(self.sizes).map(|(value, size)| value * size);
        states.chain([self.time, self.parameter]).chain(self.sides.iter().copied()).collect()
    }

    /// u of a surface, in no size.
    fn height(&self, index: usize) -> f64 {
        self.surfaces.heights[index].call(&self.here())
    }

    /// u of a surface where every state changes by a unit of its size.
    fn size_of_height(&self, index: usize) -> f64 {
        let normals = self.surfaces.normals.at(&self.here());
        (0..self.surfaces.states).map(|k| (normals[(index, k)] * self.sizes[k]).abs()).sum()
    }

    /// The surfaces on which the motion begins, and the sides of all others.
    fn begin(&mut self) -> Result<(), SlidingStop> {
        let count = self.sides.len();
        let heights: Vec<f64> = (0..count).map(|index| self.height(index)).collect();
        if heights.iter().any(|height| height.is_nan()) {
            return Err(SlidingStop::NoValue);
        }
        let sign = |height: f64| if height < 0.0 { -1.0 } else { 1.0 };
        self.sides = heights.iter().map(|height| sign(*height)).collect();
        let sizes: Vec<f64> = (0..count).map(|index| self.size_of_height(index)).collect();
        let near: Vec<usize> =
            (0..count).filter(|index| heights[*index].abs() <= AT_REST * sizes[*index]).collect();
        if near.is_empty() {
            return Ok(());
        }
        let on: Vec<usize> = near.iter().copied().filter(|index| self.can_hold(*index)).collect();
        self.find_held(on, None)?;
        let rises = self.surfaces.rises.at(&self.here());
        for index in near.iter().filter(|index| !self.held.contains(**index)) {
            if heights[*index].abs() > UNSEEN * sizes[*index] {
                self.sides[*index] = sign(heights[*index]);
            } else if !self.surfaces.holds[*index] {
                self.sides[*index] = sign(rises[(*index, 0)]);
            }
        }
        if !self.held.is_empty() {
            self.lose_normals()?;
            self.put_on()?;
        }
        Ok(())
    }

    /// The table of the rates where the motion is, on a wall on which it rests or not.
    fn rates_here(&self, arguments: &[f64]) -> DMatrix<f64> {
        self.resting_map().map_or(&self.surfaces.rates, |rest| &rest.rates).at(arguments)
    }

    /// The rates, in the sizes of the states.
    fn rates(&self) -> DVector<f64> {
        let rates = self.rates_here(&self.here());
        DVector::from_fn(self.surfaces.states, |i, _| rates[(i, 0)] / self.sizes[i])
    }

    /// Passes the events that rounding has put at the same time as the one before: surfaces that the
    /// motion is already behind, and those that no longer hold.
    fn settle(&mut self) -> Result<(), SlidingStop> {
        for _ in 0..=4 * self.sides.len() {
            self.refresh()?;
            let loose = |index: &usize| self.sides[*index].abs() >= 1.0;
            if let Some(index) = self.held.unknowns.iter().copied().find(loose) {
                self.release(index, self.sides[index].signum())?;
                continue;
            }
            let rises = self.surfaces.rises.at(&self.here());
            let behind = (0..self.sides.len()).find(|index| {
                let side = self.sides[*index];
                !self.held.contains(*index)
                    && side * rises[(*index, 0)] < 0.0
                    && side * self.height(*index) + UNSEEN * self.size_of_height(*index) <= 0.0
            });
            match behind {
                Some(index) => self.meet(index)?,
                None => return Ok(()),
            }
        }
        Ok(())
    }

    /// Follows a run between two times until the next event or the end; returns the event.
    fn leg(
        &mut self,
        [from, to]: [f64; 2],
        options: &IntegrationOptions,
    ) -> Result<Option<Meeting>, SlidingStop> {
        let run = &*self;
        let (surfaces, n) = (run.surfaces, run.surfaces.states);
        let rest = run.resting_map();
        let rates_here = rest.map_or(&surfaces.rates, |rest| &rest.rates);
        let (first, duration) = (n + 2, to - from);
        let memory = RefCell::new(run.here());
        let memory = &memory;
        // Where nothing holds, the sides stay what they are.
        let free = run.held.is_empty().then(|| run.free_rates());
        run.seen.borrow_mut().clear();
        let rates = |time: f64, values: &Vec<f64>, rates: &mut Vec<f64>| {
            // Within a step the states alone are asked for.
            let unit = run.unit.filter(|_| values.len() > n);
            let columns = if unit.is_some() { n + 1 } else { 0 };
            run.evaluations.set(run.evaluations.get() + 1 + columns as u64);
            let arguments = &mut *memory.borrow_mut();
            set_states(values, run.sizes, time, arguments);
            if set_shares(surfaces, arguments, &run.held).is_none() {
                rates.fill(f64::NAN);
                return;
            }
            let seen = &mut *run.seen.borrow_mut();
            seen.push(time);
            seen.extend_from_slice(&arguments[..n]);
            match (&free, unit) {
                (Some(free), _) => free.write(arguments, values, rates),
                (None, None) => {
                    rates.fill(0.0);
                    rates_here.visit(arguments, |(i, _), rate| rates[i] = rate / run.sizes[i]);
                }
                (None, Some(unit)) => run.varied_rates(arguments, values, rates, unit),
            }
        };
        let mut events: Vec<Event<Point<Vec<f64>>>> = Vec::new();
        let mut meetings = Vec::new();
        let normals = surfaces.normals.at(&memory.borrow());
        for index in 0..run.sides.len() {
            if run.held.unknowns.contains(&index) {
                for side in [1.0, -1.0] {
                    let beyond = move |point: &Point<Vec<f64>>| {
                        let arguments = &mut *memory.borrow_mut();
                        set_states(&point.y, run.sizes, point.t, arguments);
                        match set_shares(surfaces, arguments, &run.held) {
                            Some(()) => side * arguments[first + index] - 1.0,
                            None => f64::NAN,
                        }
                    };
                    events.push(Event::new(beyond, Action::Stop).rising().reading(n));
                    meetings.push(Meeting::Released(index, side));
                }
            } else if !run.held.contains(index) {
                let side = run.sides[index];
                let factors: Vec<f64> =
                    (0..n).map(|k| side * normals[(index, k)] * run.sizes[k]).collect();
                let unseen = UNSEEN * factors.iter().map(|factor| factor.abs()).sum::<f64>();
                let height = move |point: &Point<Vec<f64>>| {
                    let arguments = &mut *memory.borrow_mut();
                    set_states(&point.y, run.sizes, point.t, arguments);
                    side * surfaces.heights[index].call(arguments) + unseen
                };
                let event = Event::new(height, Action::Stop).falling().reading(n);
                events.push(match surfaces.is_linear[index] {
                    true => event.linear(factors),
                    false => event,
                });
                meetings.push(Meeting::Reached(index));
            }
        }
        if let Some(rest) = rest {
            let acceleration = move |point: &Point<Vec<f64>>| {
                let arguments = &mut *memory.borrow_mut();
                set_states(&point.y, run.sizes, point.t, arguments);
                rest.acceleration.call(arguments)
            };
            events.push(Event::new(acceleration, Action::Stop).rising().reading(n));
            meetings.push(Meeting::Lifted);
        }
        for (index, event) in surfaces.events.iter().enumerate() {
            if run.resting == Some(index) {
                continue;
            }
            let unseen = run.unseen_gap(index, duration);
            // Just behind an event through which the motion goes on there is no second one.
            let has_passed = run.time - run.passed[index] <= UNSEEN * duration;
            let is_behind = has_passed && run.goes_through(index, duration);
            let watched = if is_behind { run.time + AT_REST * duration } else { f64::NEG_INFINITY };
            let gap = move |point: &Point<Vec<f64>>| {
                if point.t < watched {
                    return -unseen;
                }
                let arguments = &mut *memory.borrow_mut();
                set_states(&point.y, run.sizes, point.t, arguments);
                let gap = event.gap.call(arguments);
                let is_watched = (from + event.unwatched..=to - event.unwatched).contains(&point.t);
                if is_watched { gap + unseen } else { gap.abs() + unseen }
            };
            events.push(Event::new(gap, Action::Stop).falling().reading(n));
            meetings.push(Meeting::Event(index));
        }
        let begin = Point { t: run.time, y: run.values.clone() };
        let options = IntegrationOptions { first_step: run.next_step, ..*options };
        let found = end_or_event(rates, n, begin, to, &events, &options);
        let end = found.ok_or(SlidingStop::NoValue)?;
        let meeting = end.event.map(|event| meetings[event]);
        drop(events);
        (self.time, self.values, self.next_step) = (end.point.t, end.point.y, end.next_step);
        let seen = self.seen.take();
        self.widen_bounds(&seen);
        self.seen.replace(seen);
        Ok(meeting)
    }

    /// Takes the states at these instants, as far as the motion has come, into its bounds: the last step
    /// before an event leads beyond it.
    fn widen_bounds(&mut self, seen: &[f64]) {
        let n = self.surfaces.states;
        let end: Vec<f64> =
            { self.values.iter().zip(self.sizes) }.map(|(y, size)| y * size).collect();
        let [low, high] = &mut self.bounds;
        let before = seen.chunks_exact(n + 1).filter(|at| at[0] <= self.time);
        for states in before.map(|at| &at[1..]).chain([end.as_slice()]) {
            for (i, state) in states.iter().enumerate() {
                low[i] = low[i].min(*state);
                high[i] = high[i].max(*state);
            }
        }
    }

    /// The rates of states and variations where something holds.
    fn varied_rates(&self, arguments: &[f64], values: &[f64], rates: &mut [f64], unit: f64) {
        let n = self.surfaces.states;
        let width = n + 1;
        rates.fill(0.0);
        let mut add = |(i, j): (usize, usize), slope: f64| {
            let to = n + i * width;
            match j == n {
                true => rates[to + n] += unit * slope / self.sizes[i],
                false => {
                    let slope = slope * (self.sizes[j] / self.sizes[i]);
                    let changes = &values[n + j * width..][..width];
                    for (rate, change) in rates[to..to + width].iter_mut().zip(changes) {
                        *rate += slope * change;
                    }
                }
            }
        };
        if let Some([row, unknown]) = self.held.single() {
            // The same sums as in the general case, without its matrices.
            let mut memory = vec![0.0; 2 * n + (n + 1) * width];
            let (own, rest) = memory.split_at_mut(n);
            let (by_side, rest) = rest.split_at_mut(n);
            let (change, slopes) = rest.split_at_mut(width);
            self.surfaces.varied.visit(arguments, |(i, j), value| match j {
                0 => own[i] = value,
                j if j <= width => slopes[i * width + j - 1] = value,
                j if j == 1 + width + unknown => by_side[i] = value,
                _ => {}
            });
            let mut pivot = 0.0;
            self.surfaces.rises.visit(arguments, |place, value| {
                if place == (row, 1 + unknown) {
                    pivot = value;
                }
            });
            self.surfaces.varied_rises.visit(arguments, |(i, j), value| {
                if i == row {
                    change[j] = -value;
                }
            });
            change.iter_mut().for_each(|change| *change /= pivot);
            for i in 0..n {
                for j in 0..width {
                    let slope = slopes[i * width + j] + by_side[i] * change[j];
                    if slope != 0.0 {
                        add((i, j), slope);
                    }
                }
            }
            for i in 0..n {
                rates[i] = own[i] / self.sizes[i];
            }
            return;
        }
        let Some((all, slopes)) = self.slopes(arguments) else {
            rates.fill(f64::NAN);
            return;
        };
        for i in 0..n {
            for j in 0..width {
                if slopes[(i, j)] != 0.0 {
                    add((i, j), slopes[(i, j)]);
                }
            }
        }
        for i in 0..n {
            rates[i] = all[(i, 0)] / self.sizes[i];
        }
    }

    /// f with its derivatives, and its derivatives by the states and the parameter with those of the sides
    /// that hold.
    fn slopes(&self, arguments: &[f64]) -> Option<(DMatrix<f64>, DMatrix<f64>)> {
        let width = self.surfaces.states + 1;
        let all = self.surfaces.varied.at(arguments);
        let mut slopes = all.columns(1, width).into_owned();
        if !self.held.is_empty() {
            let rows: Vec<usize> = (0..self.surfaces.states).collect();
            slopes +=
                self.held.columns(&all, 1 + width, &rows) * self.change_of_shares(arguments)?;
        }
        Some((all, slopes))
    }

    /// The derivatives of the unknown sides by the states and the parameter, -A^-1 (g_y, g_p).
    fn change_of_shares(&self, arguments: &[f64]) -> Option<DMatrix<f64>> {
        let rows = &self.held.rows;
        let matrix = self.held.columns(&self.surfaces.rises.at(arguments), 1, rows);
        let varied = self.surfaces.varied_rises.at(arguments);
        let right = DMatrix::from_fn(rows.len(), varied.ncols(), |i, j| -varied[(rows[i], j)]);
        match rows.len() {
            1 => Some(right / matrix[(0, 0)]),
            _ => matrix.full_piv_lu().solve(&right),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::surfaces::FlowEvent;
    use super::*;
    use crate::expr::Expr;
    use crate::symbol::Symbol;

    /// The run of two bodies over a time with variations, in sizes of one.
    fn followed(rates: [&str; 2], start: [f64; 4], time: f64) -> Result<SlidingRun, SlidingStop> {
        let states: Vec<Symbol> = ["x", "y", "x'", "y'"].map(Symbol::new).into();
        let right = ["x'", "y'", rates[0], rates[1]].map(|text| text.parse::<Expr>().expect(text));
        let surfaces = JumpSurfaces::new(&states, "t".into(), &right, "p".into(), &[]);
        let surfaces = surfaces.expect("surfaces").expect("jumps");
        let options = IntegrationOptions::with_tolerance(1e-12);
        follow(&surfaces, &start, [0.0, time], 1.0, &[1.0; 4], Some(1.0), &options)
    }

    /// The variations of a run are differences of runs beside it, where one body sticks all the time and
    /// the other for a while, and where both begin beside their rest.
    #[test]
    fn variations_are_differences() {
        let rates = [
            "(-1.1*x + y/10 - x'/20 - 3*sgn(x')/10 + cos(t))/p",
            "(-2.1*y + x/10 - y'/20 - 2*sgn(y')/5)/p",
        ];
        for start in [[-1.2, 0.01, 0.05, 0.0], [-1.0, 0.1, 0.3, 0.2], [-1.2, 0.0, 0.3, 0.0]] {
            let at = |start: [f64; 4], p: f64| {
                let states: Vec<Symbol> = ["x", "y", "x'", "y'"].map(Symbol::new).into();
                let right = ["x'", "y'", rates[0], rates[1]];
                let right = right.map(|text| text.parse::<Expr>().expect(text));
                let surfaces = JumpSurfaces::new(&states, "t".into(), &right, "p".into(), &[]);
                let surfaces = surfaces.expect("surfaces").expect("jumps");
                let options = IntegrationOptions::with_tolerance(1e-12);
                let run = follow(&surfaces, &start, [0.0, 9.0], p, &[1.0; 4], Some(1.0), &options);
                run.expect("a run")
            };
            let run = at(start, 1.3);
            assert!(run.stuck > 1.0);
            const STEP: f64 = 1e-6;
            for column in 0..5 {
                let beside = |step: f64| {
                    let mut start = start;
                    match column {
                        4 => return at(start, 1.3 + step).values,
                        column => start[column] += step,
                    }
                    at(start, 1.3).values
                };
                let (above, below) = (beside(STEP), beside(-STEP));
                for row in 0..4 {
                    let slope = (above[row] - below[row]) / (2.0 * STEP);
                    let found = run.values[4 + row * 5 + column];
                    assert!(
                        (slope - found).abs() < 1e-5,
                        "{start:?} {row} {column}: {slope} {found}"
                    );
                }
            }
        }
    }

    /// The variations across impacts on a moving wall are differences of runs beside it.
    #[test]
    fn variations_across_impacts_are_differences() {
        let states: Vec<Symbol> = ["x", "x'"].map(Symbol::new).into();
        let text = |text: &str| text.parse::<Expr>().expect("an expression");
        let right = ["x'", "-x - x'/10 - x^3/5 + p*cos(t)"].map(text);
        // The wall 1 + sin(2*t)/10 + p/20 with the coefficient of restitution 0.7 - p/50.
        let gap = text("1 + sin(2*t)/10 + p/20 - x");
        let after = text("x' - (1.7 - p/50)*(x' - cos(2*t)/5)");
        let wall = FlowEvent { gap, after: vec![text("x"), after], is_wall: true, push: None };
        let surfaces = JumpSurfaces::new(&states, "t".into(), &right, "p".into(), &[wall]);
        let surfaces = surfaces.expect("surfaces").expect("a wall");
        let options = IntegrationOptions::with_tolerance(1e-13);
        let at = |start: [f64; 2], p: f64| {
            let run = follow(&surfaces, &start, [0.0, 7.0], p, &[1.0, 2.0], Some(1.0), &options);
            run.expect("a run")
        };
        let (start, p) = ([0.2, 1.4], 1.9);
        let run = at(start, p);
        assert!(run.impacts >= 2, "{}", run.impacts);
        const STEP: f64 = 1e-6;
        for column in 0..3 {
            let beside = |step: f64| match column {
                0 => at([start[0] + step, start[1]], p).values,
                1 => at([start[0], start[1] + step], p).values,
                _ => at(start, p + step).values,
            };
            let (above, below) = (beside(STEP), beside(-STEP));
            for row in 0..2 {
                // The columns count the start in its sizes.
                let size = [1.0, 2.0, 1.0][column];
                let slope = size * (above[row] - below[row]) / (2.0 * STEP);
                let found = run.values[2 + row * 3 + column];
                assert!((slope - found).abs() < 1e-6, "{row} {column}: {slope} {found}");
            }
        }
    }

    #[test]
    fn two_bodies_at_rest_stay_there() {
        let rates =
            ["-x - sgn(x')/5 - sgn(x' - y')/10 + cos(t)/10", "-y - sgn(y')/5 + sgn(x' - y')/10"];
        let run = followed(rates, [0.0; 4], 6.0).expect("a run");
        assert_eq!((run.stuck, run.throughout.len()), (6.0, 3));
        assert!(run.values[..4].iter().all(|value| value.abs() < 1e-12), "{run:?}");
    }
}
