//! Motions across jumps of the rates, from event to event, with their variations.
//!
//! ```text
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

use std::cell::{Cell, RefCell};

use nalgebra::{DMatrix, DVector};

use super::surfaces::JumpSurfaces;
use crate::numeric::ode::{
    Action, Event, IntegrationOptions, Point, StopReason, integrate_first_order,
};

/// Distance from a surface, in the sizes of the states, at which an event is: that of rounding.
const UNSEEN: f64 = 1e-12;

/// Distance from a surface, in the sizes of the states, within which a motion that begins there and
/// can stick does.
const AT_REST: f64 = 1e-9;

/// Largest number of events of a run.
const MOST_EVENTS: usize = 2_000;

/// Least number of steps of a run, so that no event is missed where nothing but time changes.
const LEAST_STEPS: f64 = 40.0;

/// The reason why a motion is not followed across jumps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SlidingStop {
    /// It meets this surface, beside others, ever again.
    Chatter(usize),
    /// The forces that hold it on several surfaces, this one of them, are not determined.
    Undetermined(usize),
    /// A rate has no value, or a step vanishes.
    NoValue,
}

/// A run from a start.
#[derive(Clone, Debug)]
pub(super) struct SlidingRun {
    /// The states at the end, then, if they were asked for, the variations of each by all states and
    /// by the parameter, everything in the sizes of the states.
    pub(super) values: Vec<f64>,
    /// The lowest and the highest value of each state.
    pub(super) bounds: [Vec<f64>; 2],
    /// Duration in which something sticks.
    pub(super) stuck: f64,
    /// Evaluations of the rates.
    pub(super) evaluations: u64,
}

/// The event that ends a leg.
#[derive(Clone, Copy, Debug)]
enum Meeting {
    /// The motion has reached this surface.
    Reached(usize),
    /// It leaves this surface, on which it stuck, to this side.
    Released(usize, f64),
}

/// The state of a run.
struct Run<'a> {
    surfaces: &'a JumpSurfaces,
    sizes: &'a [f64],
    parameter: f64,
    /// The size of the variations beside the states; `None` if there are none.
    unit: Option<f64>,
    time: f64,
    values: Vec<f64>,
    /// The side of each surface, 1 or -1; of those on which it sticks a value in between.
    sides: Vec<f64>,
    /// The surfaces on which it sticks.
    held: Vec<usize>,
    bounds: RefCell<[Vec<f64>; 2]>,
    evaluations: Cell<u64>,
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
    let mut run = Run::new(surfaces, start, from, parameter, sizes, unit);
    let options = IntegrationOptions {
        maximum_step: options.maximum_step.min((to - from) / LEAST_STEPS),
        ..*options
    };
    let mut stuck = 0.0;
    run.begin()?;
    for _ in 0..MOST_EVENTS {
        run.settle()?;
        let began = run.time;
        let meeting = if run.time < to { run.leg(to, &options)? } else { None };
        if !run.held.is_empty() {
            stuck += run.time - began;
        }
        match meeting {
            None => {
                return Ok(SlidingRun {
                    values: run.values,
                    bounds: run.bounds.into_inner(),
                    stuck,
                    evaluations: run.evaluations.get(),
                });
            }
            Some(Meeting::Reached(index)) => run.meet(index)?,
            Some(Meeting::Released(index, side)) => run.release(index, side),
        }
    }
    let nearest = (0..run.sides.len()).min_by(|one, other| {
        let height = |index: usize| run.height(index).abs();
        height(*one).total_cmp(&height(*other))
    });
    Err(SlidingStop::Chatter(nearest.unwrap_or(0)))
}

/// The rates at a state with their derivatives by the states and by the parameter, in columns; `None` if
/// they are not determined.
pub(super) fn linearised(
    surfaces: &JumpSurfaces,
    state: &[f64],
    time: f64,
    parameter: f64,
) -> Option<(DVector<f64>, DMatrix<f64>)> {
    let largest = state.iter().map(|value| value.abs()).fold(0.0, f64::max);
    let sizes = vec![if largest > 0.0 { largest } else { 1.0 }; state.len()];
    let mut run = Run::new(surfaces, state, time, parameter, &sizes, None);
    run.begin().ok()?;
    let (all, slopes) = run.slopes(&run.here())?;
    Some((all.column(0).into_owned(), slopes))
}

/// The sides of the surfaces that hold, in the arguments, so that du/dt is zero on all of them;
/// `None` if these equations are singular.
fn set_shares(surfaces: &JumpSurfaces, arguments: &mut [f64], held: &[usize]) -> Option<()> {
    if held.is_empty() {
        return Some(());
    }
    let first = surfaces.states + 2;
    for index in held {
        arguments[first + index] = 0.0;
    }
    let rises = surfaces.rises.at(arguments);
    let count = held.len();
    let matrix = DMatrix::from_fn(count, count, |i, j| rises[(held[i], 1 + held[j])]);
    let right = DVector::from_fn(count, |i, _| -rises[(held[i], 0)]);
    let shares = solved(matrix, right)?;
    for (index, share) in held.iter().zip(shares.iter()) {
        arguments[first + index] = *share;
    }
    Some(())
}

/// The solution of linear equations; `None` if they are singular.
fn solved(matrix: DMatrix<f64>, right: DVector<f64>) -> Option<DVector<f64>> {
    /// Ratio of a pivot to the largest entry below which the equations are singular.
    const SINGULAR: f64 = 1e-10;
    let largest = matrix.amax();
    let factors = matrix.full_piv_lu();
    let pivots = factors.u().diagonal();
    let is_regular = pivots.iter().all(|pivot| pivot.abs() > SINGULAR * largest);
    if is_regular { factors.solve(&right) } else { None }
}

impl<'a> Run<'a> {
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
            sides: vec![1.0; surfaces.arguments.len()],
            held: Vec::new(),
            bounds: RefCell::new([start.to_vec(), start.to_vec()]),
            evaluations: Cell::new(0),
        }
    }

    /// The arguments of all functions at these values.
    fn arguments(&self, time: f64, values: &[f64]) -> Vec<f64> {
        let states = values.iter().zip(self.sizes).map(|(value, size)| value * size);
        states.chain([time, self.parameter]).chain(self.sides.iter().copied()).collect()
    }

    fn here(&self) -> Vec<f64> {
        self.arguments(self.time, &self.values)
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
        let near: Vec<usize> = (0..count)
            .filter(|index| heights[*index].abs() <= AT_REST * sizes[*index])
            .collect();
        if near.is_empty() {
            return Ok(());
        }
        let on: Vec<usize> = near.iter().copied().filter(|index| self.can_hold(*index)).collect();
        self.find_held(on)?;
        let rises = self.surfaces.rises.at(&self.here());
        for index in near.iter().filter(|index| !self.held.contains(index)) {
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

    /// Whether the rates on both sides of a surface can lead back to it.
    fn can_hold(&self, index: usize) -> bool {
        self.surfaces.holds[index] && self.surfaces.rises.at(&self.here())[(index, 1 + index)] < 0.0
    }

    /// Finds those of these surfaces, on all of which the motion is, that hold, and the sides of the
    /// others: each is released to the side to which the force leads that would be needed beyond its
    /// bound.
    fn find_held(&mut self, on: Vec<usize>) -> Result<(), SlidingStop> {
        let first = self.surfaces.states + 2;
        self.held = on.clone();
        for _ in 0..=2 * on.len() {
            let mut arguments = self.here();
            if set_shares(self.surfaces, &mut arguments, &self.held).is_none() {
                return Err(SlidingStop::Undetermined(self.held[0]));
            }
            if arguments.iter().any(|value| value.is_nan()) {
                return Err(SlidingStop::NoValue);
            }
            let share = |index: &usize| arguments[first + index];
            let worst = self
                .held
                .iter()
                .copied()
                .max_by(|one, other| share(one).abs().total_cmp(&share(other).abs()))
                .filter(|index| share(index).abs() > 1.0);
            if let Some(index) = worst {
                self.sides[index] = share(&index).signum();
                self.held.retain(|held| *held != index);
                continue;
            }
            self.sides.copy_from_slice(&arguments[first..]);
            // One that was released may be held back once others are.
            let rises = self.surfaces.rises.at(&arguments);
            let returns = on.iter().copied().find(|index| {
                let jump = rises[(*index, 1 + index)].abs();
                !self.held.contains(index) && self.sides[*index] * rises[(*index, 0)] < -AT_REST * jump
            });
            match returns {
                Some(index) => self.held.push(index),
                None => return Ok(()),
            }
        }
        Err(SlidingStop::Undetermined(on[0]))
    }

    /// The rates, in the sizes of the states.
    fn rates(&self) -> DVector<f64> {
        let rates = self.surfaces.rates.at(&self.here());
        DVector::from_fn(self.surfaces.states, |i, _| rates[(i, 0)] / self.sizes[i])
    }

    /// Passes the events that rounding has put at the same time as the one before: surfaces that the
    /// motion is already behind, and those that no longer hold.
    fn settle(&mut self) -> Result<(), SlidingStop> {
        for _ in 0..=4 * self.sides.len() {
            let mut arguments = self.here();
            if set_shares(self.surfaces, &mut arguments, &self.held).is_none() {
                return Err(SlidingStop::Undetermined(self.held[0]));
            }
            let first = self.surfaces.states + 2;
            self.sides.copy_from_slice(&arguments[first..]);
            if let Some(index) = self.held.iter().copied().find(|index| self.sides[*index].abs() >= 1.0)
            {
                self.release(index, self.sides[index].signum());
                continue;
            }
            let rises = self.surfaces.rises.at(&arguments);
            let behind = (0..self.sides.len()).find(|index| {
                let side = self.sides[*index];
                !self.held.contains(index)
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

    /// Follows the motion until the next event or the end; returns the event.
    fn leg(
        &mut self,
        to: f64,
        options: &IntegrationOptions,
    ) -> Result<Option<Meeting>, SlidingStop> {
        let run = &*self;
        let (surfaces, n) = (run.surfaces, run.surfaces.states);
        let first = n + 2;
        let rates = |time: f64, values: &Vec<f64>, rates: &mut Vec<f64>| {
            let columns = if run.unit.is_some() { n + 1 } else { 0 };
            run.evaluations.set(run.evaluations.get() + 1 + columns as u64);
            let mut arguments = run.arguments(time, values);
            if set_shares(surfaces, &mut arguments, &run.held).is_none() {
                rates.fill(f64::NAN);
                return;
            }
            let [low, high] = &mut *run.bounds.borrow_mut();
            for i in 0..n {
                low[i] = low[i].min(arguments[i]);
                high[i] = high[i].max(arguments[i]);
            }
            match run.unit {
                None => {
                    let own = surfaces.rates.at(&arguments);
                    for i in 0..n {
                        rates[i] = own[(i, 0)] / run.sizes[i];
                    }
                }
                Some(unit) => run.varied_rates(&arguments, values, rates, unit),
            }
        };
        let mut events: Vec<Event<Point<Vec<f64>>>> = Vec::new();
        let mut meetings = Vec::new();
        for index in 0..run.sides.len() {
            if run.held.contains(&index) {
                for side in [1.0, -1.0] {
                    let beyond = move |point: &Point<Vec<f64>>| {
                        let mut arguments = run.arguments(point.t, &point.y);
                        match set_shares(surfaces, &mut arguments, &run.held) {
                            Some(()) => side * arguments[first + index] - 1.0,
                            None => f64::NAN,
                        }
                    };
                    events.push(Event::new(beyond, Action::Stop).rising());
                    meetings.push(Meeting::Released(index, side));
                }
            } else {
                let (side, unseen) = (run.sides[index], UNSEEN * run.size_of_height(index));
                let height = move |point: &Point<Vec<f64>>| {
                    side * surfaces.heights[index].call(&run.arguments(point.t, &point.y)) + unseen
                };
                events.push(Event::new(height, Action::Stop).falling());
                meetings.push(Meeting::Reached(index));
            }
        }
        let begin = Point { t: run.time, y: run.values.clone() };
        let path = integrate_first_order(rates, begin, to, &events, options)
            .map_err(|_| SlidingStop::NoValue)?;
        if !path.is_complete() {
            return Err(SlidingStop::NoValue);
        }
        let meeting = match path.stop_reason() {
            StopReason::Event { event, .. } => Some(meetings[event]),
            _ => None,
        };
        drop(events);
        let end = path.end();
        (self.time, self.values) = (end.t, end.y);
        Ok(meeting)
    }

    /// The rates of states and variations.
    fn varied_rates(&self, arguments: &[f64], values: &[f64], rates: &mut [f64], unit: f64) {
        let n = self.surfaces.states;
        let width = n + 1;
        let Some((all, slopes)) = self.slopes(arguments) else {
            rates.fill(f64::NAN);
            return;
        };
        for i in 0..n {
            rates[i] = all[(i, 0)] / self.sizes[i];
            let to = n + i * width;
            rates[to..to + width].fill(0.0);
            for j in 0..n {
                let slope = slopes[(i, j)];
                if slope != 0.0 {
                    let slope = slope * (self.sizes[j] / self.sizes[i]);
                    for k in 0..width {
                        rates[to + k] += slope * values[n + j * width + k];
                    }
                }
            }
            rates[to + n] += unit * slopes[(i, n)] / self.sizes[i];
        }
    }

    /// f with its derivatives, and its derivatives by the states and the parameter with those of the sides
    /// that hold.
    fn slopes(&self, arguments: &[f64]) -> Option<(DMatrix<f64>, DMatrix<f64>)> {
        let width = self.surfaces.states + 1;
        let all = self.surfaces.varied.at(arguments);
        let mut slopes = all.columns(1, width).into_owned();
        if !self.held.is_empty() {
            let shares = self.change_of_shares(arguments)?;
            for (row, index) in self.held.iter().enumerate() {
                slopes += all.column(1 + width + index) * shares.row(row);
            }
        }
        Some((all, slopes))
    }

    /// The derivatives of the sides that hold by the states and the parameter, -A^-1 (g_y, g_p).
    fn change_of_shares(&self, arguments: &[f64]) -> Option<DMatrix<f64>> {
        let count = self.held.len();
        let rises = self.surfaces.rises.at(arguments);
        let varied = self.surfaces.varied_rises.at(arguments);
        let matrix =
            DMatrix::from_fn(count, count, |i, j| rises[(self.held[i], 1 + self.held[j])]);
        let right = DMatrix::from_fn(count, varied.ncols(), |i, j| -varied[(self.held[i], j)]);
        matrix.full_piv_lu().solve(&right)
    }

    /// Passes the event at which the motion reaches a surface: it crosses it or begins to stick.
    fn meet(&mut self, index: usize) -> Result<(), SlidingStop> {
        let before = self.rates();
        let speed = self.surfaces.rises.at(&self.here())[(index, 0)];
        let was_held = self.held.len();
        let mut on = self.held.clone();
        if self.can_hold(index) {
            on.push(index);
        } else {
            self.sides[index] = -self.sides[index];
        }
        if !on.is_empty() {
            self.find_held(on)?;
        }
        let behind = self.rates();
        self.jump(index, &(behind - before), speed);
        if self.held.len() > was_held || self.held.contains(&index) {
            self.put_on()?;
        }
        Ok(())
    }

    /// Leaves a surface to a side.
    fn release(&mut self, index: usize, side: f64) {
        self.held.retain(|held| *held != index);
        self.sides[index] = side;
    }

    /// Changes the variations by the saltation matrix of a surface, with the change of the rates, in
    /// the sizes of the states, and du/dt before.
    fn jump(&mut self, index: usize, change: &DVector<f64>, speed: f64) {
        let Some(unit) = self.unit else { return };
        let (n, width) = (self.surfaces.states, self.surfaces.states + 1);
        let normals = self.surfaces.normals.at(&self.here());
        for column in 0..width {
            let of_states = (0..n)
                .map(|k| normals[(index, k)] * self.sizes[k] * self.values[n + k * width + column]);
            let own = if column == n { unit * normals[(index, n)] } else { 0.0 };
            let height: f64 = of_states.sum::<f64>() + own;
            // A variation that is zero stays zero, also if the speed across the surface vanishes.
            if height != 0.0 {
                for i in 0..n {
                    self.values[n + i * width + column] += change[i] * height / speed;
                }
            }
        }
    }

    /// f_s in the sizes of the states, and A, of the surfaces that hold.
    fn directions(&self) -> (DMatrix<f64>, DMatrix<f64>) {
        let (n, count) = (self.surfaces.states, self.held.len());
        let arguments = self.here();
        let all = self.surfaces.varied.at(&arguments);
        let rises = self.surfaces.rises.at(&arguments);
        let along =
            DMatrix::from_fn(n, count, |i, j| all[(i, 2 + n + self.held[j])] / self.sizes[i]);
        let matrix =
            DMatrix::from_fn(count, count, |i, j| rises[(self.held[i], 1 + self.held[j])]);
        (along, matrix)
    }

    /// Puts the states on the surfaces that hold, in the directions in which the rates jump.
    fn put_on(&mut self) -> Result<(), SlidingStop> {
        if self.held.is_empty() {
            return Ok(());
        }
        let (along, matrix) = self.directions();
        let heights = DVector::from_fn(self.held.len(), |i, _| -self.height(self.held[i]));
        let steps = solved(matrix, heights).ok_or(SlidingStop::Undetermined(self.held[0]))?;
        for (value, step) in self.values.iter_mut().zip((along * steps).iter()) {
            *value += step;
        }
        Ok(())
    }

    /// Takes from the variations what leads off the surfaces on which the motion begins to stick at
    /// once, z - f_s A^-1 (u_y z + u_p).
    fn lose_normals(&mut self) -> Result<(), SlidingStop> {
        let Some(unit) = self.unit else { return Ok(()) };
        let (n, count) = (self.surfaces.states, self.held.len());
        let width = n + 1;
        let (along, matrix) = self.directions();
        let normals = self.surfaces.normals.at(&self.here());
        for column in 0..width {
            let height = DVector::from_fn(count, |i, _| {
                let of_states = (0..n).map(|k| {
                    normals[(self.held[i], k)] * self.sizes[k] * self.values[n + k * width + column]
                });
                let own = if column == n { unit * normals[(self.held[i], n)] } else { 0.0 };
                of_states.sum::<f64>() + own
            });
            let steps =
                solved(matrix.clone(), height).ok_or(SlidingStop::Undetermined(self.held[0]))?;
            let change = &along * steps;
            for i in 0..n {
                self.values[n + i * width + column] -= change[i];
            }
        }
        Ok(())
    }
}
