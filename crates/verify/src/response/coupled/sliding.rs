//! Motions across jumps of the rates and impacts on walls, from event to event, with their variations.
//!
//! ```text
//! impact      g falls through zero: y -> R(y),     behind: z -> R_y z + R_p + (f_behind - R_y f_before - R_t) (g_y z + g_p)/(dg/dt)_before
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

use super::surfaces::{JumpSurfaces, WallMap};
use crate::numeric::ode::{
    Action, Event, IntegrationOptions, Point, StopReason, integrate_first_order,
};
use crate::trajectory::shares_of_one_size;

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
    /// Impacts accumulate, and the motion rests on a wall.
    RestsOnWall,
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
    /// The surfaces on which it sticks all the time, but for a moment at the start.
    pub(super) throughout: Vec<usize>,
    /// The number of impacts on walls.
    pub(super) impacts: usize,
    /// The least speed of an impact, in the sizes of the states over the duration; infinite if there is
    /// none.
    pub(super) slowest: f64,
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
    /// The motion has reached this wall.
    Struck(usize),
}

/// The surfaces on which a motion sticks.
#[derive(Clone, Debug, Default)]
struct Held {
    /// The surfaces with independent normals, whose du/dt is zero: an equation each.
    rows: Vec<usize>,
    /// The surfaces whose sides are the unknowns, as many.
    unknowns: Vec<usize>,
    /// The other surfaces: each has the side of an unknown one, the second number counts which, times a
    /// sign.
    tied: Vec<(usize, usize, f64)>,
}

impl Held {
    fn is_empty(&self) -> bool {
        self.unknowns.is_empty()
    }

    fn contains(&self, index: usize) -> bool {
        self.unknowns.contains(&index) || self.tied.iter().any(|(own, ..)| *own == index)
    }

    fn all(&self) -> Vec<usize> {
        self.unknowns.iter().copied().chain(self.tied.iter().map(|(own, ..)| *own)).collect()
    }

    /// The columns of a matrix that go with the unknown sides, those of tied sides added; `first` is the
    /// column of the first surface.
    fn columns(&self, matrix: &DMatrix<f64>, first: usize, rows: &[usize]) -> DMatrix<f64> {
        let mut found = DMatrix::from_fn(rows.len(), self.unknowns.len(), |i, j| {
            matrix[(rows[i], first + self.unknowns[j])]
        });
        for (own, lead, sign) in &self.tied {
            for (i, row) in rows.iter().enumerate() {
                found[(i, *lead)] += sign * matrix[(*row, first + own)];
            }
        }
        found
    }

    /// Writes the sides of the unknown surfaces, and of those tied to them.
    fn write(&self, shares: &[f64], sides: &mut [f64]) {
        for (index, share) in self.unknowns.iter().zip(shares) {
            sides[*index] = *share;
        }
        for (own, lead, sign) in &self.tied {
            sides[*own] = sign * shares[*lead];
        }
    }
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
    /// The side of each surface, 1 or -1; of those on which it sticks a value in between.
    sides: Vec<f64>,
    /// The surfaces on which it sticks.
    held: Held,
    bounds: RefCell<[Vec<f64>; 2]>,
    /// The number of impacts, and of the last ones that followed each other at once.
    impacts: usize,
    at_once: usize,
    /// The time of the last impact, and the least speed of an impact.
    struck: f64,
    slowest: f64,
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
    let mut run = EventRun::new(surfaces, start, from, parameter, sizes, unit);
    let options = IntegrationOptions {
        maximum_step: options.maximum_step.min((to - from) / LEAST_STEPS),
        ..*options
    };
    let mut stuck = 0.0;
    run.check_walls()?;
    run.begin()?;
    let mut throughout: Option<Vec<usize>> = None;
    for _ in 0..MOST_EVENTS {
        run.settle()?;
        let held = run.held.clone();
        let began = run.time;
        let meeting = if run.time < to { run.leg(to, &options)? } else { None };
        if !held.is_empty() {
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
                    bounds: run.bounds.into_inner(),
                    stuck,
                    throughout: throughout.unwrap_or_default(),
                    impacts: run.impacts,
                    slowest: run.slowest,
                    evaluations: run.evaluations.get(),
                });
            }
            Some(Meeting::Reached(index)) => run.meet(index)?,
            Some(Meeting::Released(index, side)) => run.release(index, side)?,
            Some(Meeting::Struck(wall)) => run.strike(wall, to - from)?,
        }
    }
    let nearest = (0..run.sides.len()).min_by(|one, other| {
        let height = |index: usize| run.height(index).abs();
        height(*one).total_cmp(&height(*other))
    });
    Err(SlidingStop::Chatter(nearest.unwrap_or(0)))
}

/// The arguments of all functions at time zero, on the positive side of all surfaces.
fn at_beginning(surfaces: &JumpSurfaces, state: &[f64], parameter: f64) -> Vec<f64> {
    let sides = surfaces.arguments.iter().map(|_| 1.0);
    state.iter().copied().chain([0.0, parameter]).chain(sides).collect()
}

/// The least gap at time zero, where every state changes by a unit of its size; infinite without walls.
pub(super) fn least_gap(
    surfaces: &JumpSurfaces,
    state: &[f64],
    parameter: f64,
    sizes: &[f64],
) -> f64 {
    let arguments = at_beginning(surfaces, state, parameter);
    let gap = |wall: &WallMap| {
        let normal = wall.normal.at(&arguments);
        let size: f64 =
            sizes.iter().enumerate().map(|(k, size)| (normal[(0, k)] * size).abs()).sum();
        wall.gap.call(&arguments).abs() / size
    };
    surfaces.walls.iter().map(gap).fold(f64::INFINITY, f64::min)
}

/// The state behind an impact on the nearest wall at time zero; `None` without walls.
pub(super) fn behind_impact(
    surfaces: &JumpSurfaces,
    state: &[f64],
    parameter: f64,
) -> Option<Vec<f64>> {
    let arguments = at_beginning(surfaces, state, parameter);
    let gap = |wall: &&WallMap| wall.gap.call(&arguments).abs();
    let nearest = surfaces.walls.iter().min_by(|one, other| gap(one).total_cmp(&gap(other)))?;
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
    for wall in &surfaces.walls {
        let arguments = at_beginning(surfaces, &state, parameter);
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

/// The sides of the surfaces that hold, in the arguments, so that du/dt is zero on all of them;
/// `None` if these equations are singular.
fn set_shares(surfaces: &JumpSurfaces, arguments: &mut [f64], held: &Held) -> Option<()> {
    if held.is_empty() {
        return Some(());
    }
    let first = surfaces.states + 2;
    held.write(&vec![0.0; held.unknowns.len()], &mut arguments[first..]);
    let rises = surfaces.rises.at(arguments);
    let matrix = held.columns(&rises, 1, &held.rows);
    let right = DVector::from_fn(held.rows.len(), |i, _| -rises[(held.rows[i], 0)]);
    let shares = solved(matrix, right)?;
    held.write(shares.as_slice(), &mut arguments[first..]);
    Some(())
}

/// The solution of linear equations; `None` if they are singular.
fn solved(matrix: DMatrix<f64>, right: DVector<f64>) -> Option<DVector<f64>> {
    /// Ratio of a pivot to the largest entry below which the equations are singular.
    const SINGULAR: f64 = 1e-10;
    if matrix.nrows() == 1 {
        return (matrix[(0, 0)] != 0.0).then(|| right / matrix[(0, 0)]);
    }
    let largest = matrix.amax();
    let factors = matrix.full_piv_lu();
    let pivots = factors.u().diagonal();
    let is_regular = pivots.iter().all(|pivot| pivot.abs() > SINGULAR * largest);
    if is_regular { factors.solve(&right) } else { None }
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
            sides: vec![1.0; surfaces.arguments.len()],
            held: Held::default(),
            bounds: RefCell::new([start.to_vec(), start.to_vec()]),
            impacts: 0,
            at_once: 0,
            struck: f64::NEG_INFINITY,
            slowest: f64::INFINITY,
            evaluations: Cell::new(0),
        }
    }

    /// Writes the arguments of all functions at these values.
    fn set_arguments(&self, time: f64, values: &[f64], arguments: &mut Vec<f64>) {
        arguments.clear();
        arguments.extend(values.iter().zip(self.sizes).map(|(value, size)| value * size));
        arguments.extend([time, self.parameter]);
        arguments.extend_from_slice(&self.sides);
    }

    /// The arguments where the motion is.
    fn here(&self) -> Vec<f64> {
        let mut arguments = Vec::new();
        self.set_arguments(self.time, &self.values, &mut arguments);
        arguments
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

    /// Whether the rates on both sides of a surface can lead back to it.
    fn can_hold(&self, index: usize) -> bool {
        self.surfaces.holds[index] && self.surfaces.rises.at(&self.here())[(index, 1 + index)] < 0.0
    }

    /// Finds those of these surfaces, on all of which the motion is, that hold, and the sides of the
    /// others: each is released to the side to which the force leads that would be needed beyond its
    /// bound. The side of the surface that was `hit` is at its bound, unless others take over.
    fn find_held(&mut self, on: Vec<usize>, hit: Option<usize>) -> Result<(), SlidingStop> {
        let first = self.surfaces.states + 2;
        let mut holding = on.clone();
        for _ in 0..=2 * on.len() {
            self.tie(&holding)?;
            let mut arguments = self.here();
            if set_shares(self.surfaces, &mut arguments, &self.held).is_none() {
                return Err(SlidingStop::Undetermined(holding[0]));
            }
            if arguments.iter().any(|value| value.is_nan()) {
                return Err(SlidingStop::NoValue);
            }
            let share = |index: usize| arguments[first + index];
            let group = |lead: usize| {
                let tied = self.held.tied.iter().filter(move |(_, own, _)| *own == lead);
                tied.map(|(own, ..)| *own).chain([self.held.unknowns[lead]])
            };
            let is_beyond = |lead: &usize| {
                let is_hit = hit.is_some_and(|hit| group(*lead).any(|index| index == hit));
                let bound = if is_hit { 1.0 - ROUNDING } else { 1.0 };
                share(self.held.unknowns[*lead]).abs() > bound
            };
            let size = |lead: usize| share(self.held.unknowns[lead]).abs();
            let worst = (0..self.held.unknowns.len())
                .filter(is_beyond)
                .max_by(|one, other| size(*one).total_cmp(&size(*other)));
            if let Some(lead) = worst {
                let released: Vec<usize> = group(lead).collect();
                for index in &released {
                    self.sides[*index] = share(*index).signum();
                }
                holding.retain(|index| !released.contains(index));
                continue;
            }
            self.sides.copy_from_slice(&arguments[first..]);
            // One that was released may be held back once others are.
            let rises = self.surfaces.rises.at(&arguments);
            let returns = on.iter().copied().find(|index| {
                let jump = rises[(*index, 1 + index)].abs();
                !self.held.contains(*index)
                    && self.sides[*index] * rises[(*index, 0)] < -ROUNDING * jump
            });
            match returns {
                Some(index) => holding.push(index),
                None => return Ok(()),
            }
        }
        Err(SlidingStop::Undetermined(on[0]))
    }

    /// Those of these surfaces whose normals are independent of those of the ones before.
    fn independent(&self, surfaces: &[usize]) -> Vec<usize> {
        let normals = self.surfaces.normals.at(&self.here());
        let mut directions: Vec<DVector<f64>> = Vec::new();
        let mut is_independent = |index: &usize| {
            let part = |k: usize, _: usize| normals[(*index, k)] * self.sizes[k];
            let normal = DVector::from_fn(self.surfaces.states, part);
            let along = |left: DVector<f64>, known: &DVector<f64>| &left - known * known.dot(&left);
            let left = directions.iter().fold(normal.clone(), along);
            let own = left.norm() > ROUNDING * normal.norm();
            if own {
                directions.push(left.normalize());
            }
            own
        };
        surfaces.iter().copied().filter(|index| is_independent(index)).collect()
    }

    /// Adds to surfaces on which the motion is those on which it must then be too, as between two bodies
    /// that are both at rest.
    fn with_dependent(&self, mut on: Vec<usize>) -> Vec<usize> {
        const NEAR: f64 = 10.0 * UNSEEN;
        let count = self.independent(&on).len();
        for index in 0..self.sides.len() {
            let is_near = || self.height(index).abs() <= NEAR * self.size_of_height(index);
            if on.contains(&index) || !self.can_hold(index) || !is_near() {
                continue;
            }
            on.push(index);
            if self.independent(&on).len() > count {
                on.pop();
            }
        }
        on
    }

    /// Holds the motion on these surfaces, with ties between the sides that the rates leave
    /// undetermined.
    fn tie(&mut self, holding: &[usize]) -> Result<(), SlidingStop> {
        let n = self.surfaces.states;
        let rows = self.independent(holding);
        self.held = Held { rows, unknowns: holding.to_vec(), tied: vec![] };
        if self.held.rows.len() == holding.len() {
            return Ok(());
        }
        let undetermined = || SlidingStop::Undetermined(holding[0]);
        let mut arguments = self.here();
        for index in holding {
            arguments[n + 2 + index] = 0.0;
        }
        let rises = self.surfaces.rises.at(&arguments);
        let row = |index: &usize| holding.iter().map(|other| rises[(*index, 1 + other)]).collect();
        let matrix: Vec<Vec<f64>> = holding.iter().map(row).collect();
        let right: Vec<f64> = holding.iter().map(|index| -rises[(*index, 0)]).collect();
        let groups = shares_of_one_size(&matrix, &right).ok_or_else(undetermined)?;
        let mut tied: Vec<(usize, usize, f64)> = Vec::new();
        for group in groups {
            let Some(((lead, first), others)) = group.split_first() else { continue };
            tied.extend(others.iter().map(|(own, sign)| (*own, *lead, (sign * first) as f64)));
        }
        let is_tied = |place: usize| tied.iter().any(|(own, ..)| *own == place);
        let leads: Vec<usize> = (0..holding.len()).filter(|place| !is_tied(*place)).collect();
        let number = |lead: usize| leads.iter().position(|place| *place == lead);
        let mut numbered = Vec::new();
        for (own, lead, sign) in &tied {
            numbered.push((holding[*own], number(*lead).ok_or_else(undetermined)?, *sign));
        }
        self.held.tied = numbered;
        self.held.unknowns = leads.into_iter().map(|place| holding[place]).collect();
        match self.held.unknowns.len() == self.held.rows.len() {
            true => Ok(()),
            false => Err(undetermined()),
        }
    }

    /// The rates, in the sizes of the states.
    fn rates(&self) -> DVector<f64> {
        let rates = self.surfaces.rates.at(&self.here());
        DVector::from_fn(self.surfaces.states, |i, _| rates[(i, 0)] / self.sizes[i])
    }

    /// Computes the sides of the surfaces that hold where the motion is.
    fn refresh(&mut self) -> Result<(), SlidingStop> {
        let mut arguments = self.here();
        set_shares(self.surfaces, &mut arguments, &self.held)
            .ok_or_else(|| SlidingStop::Undetermined(self.held.unknowns[0]))?;
        self.sides.copy_from_slice(&arguments[self.surfaces.states + 2..]);
        Ok(())
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

    /// Follows the motion until the next event or the end; returns the event.
    fn leg(
        &mut self,
        to: f64,
        options: &IntegrationOptions,
    ) -> Result<Option<Meeting>, SlidingStop> {
        let run = &*self;
        let (surfaces, n) = (run.surfaces, run.surfaces.states);
        let first = n + 2;
        let memory = RefCell::new(Vec::new());
        let memory = &memory;
        let rates = |time: f64, values: &Vec<f64>, rates: &mut Vec<f64>| {
            let columns = if run.unit.is_some() { n + 1 } else { 0 };
            run.evaluations.set(run.evaluations.get() + 1 + columns as u64);
            let arguments = &mut *memory.borrow_mut();
            run.set_arguments(time, values, arguments);
            if set_shares(surfaces, arguments, &run.held).is_none() {
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
                    rates.fill(0.0);
                    surfaces.rates.visit(arguments, |(i, _), rate| rates[i] = rate / run.sizes[i]);
                }
                Some(unit) => run.varied_rates(arguments, values, rates, unit),
            }
        };
        let mut events: Vec<Event<Point<Vec<f64>>>> = Vec::new();
        let mut meetings = Vec::new();
        for index in 0..run.sides.len() {
            if run.held.unknowns.contains(&index) {
                for side in [1.0, -1.0] {
                    let beyond = move |point: &Point<Vec<f64>>| {
                        let arguments = &mut *memory.borrow_mut();
                        run.set_arguments(point.t, &point.y, arguments);
                        match set_shares(surfaces, arguments, &run.held) {
                            Some(()) => side * arguments[first + index] - 1.0,
                            None => f64::NAN,
                        }
                    };
                    events.push(Event::new(beyond, Action::Stop).rising().reading(n));
                    meetings.push(Meeting::Released(index, side));
                }
            } else if !run.held.contains(index) {
                let (side, unseen) = (run.sides[index], UNSEEN * run.size_of_height(index));
                let height = move |point: &Point<Vec<f64>>| {
                    let arguments = &mut *memory.borrow_mut();
                    run.set_arguments(point.t, &point.y, arguments);
                    side * surfaces.heights[index].call(arguments) + unseen
                };
                events.push(Event::new(height, Action::Stop).falling().reading(n));
                meetings.push(Meeting::Reached(index));
            }
        }
        for (index, wall) in surfaces.walls.iter().enumerate() {
            let unseen = UNSEEN * run.size_of_gap(index);
            let gap = move |point: &Point<Vec<f64>>| {
                let arguments = &mut *memory.borrow_mut();
                run.set_arguments(point.t, &point.y, arguments);
                wall.gap.call(arguments) + unseen
            };
            events.push(Event::new(gap, Action::Stop).falling().reading(n));
            meetings.push(Meeting::Struck(index));
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
        rates.fill(0.0);
        let mut add = |(i, j): (usize, usize), slope: f64| {
            let to = n + i * width;
            match j == n {
                true => rates[to + n] += unit * slope / self.sizes[i],
                false => {
                    let slope = slope * (self.sizes[j] / self.sizes[i]);
                    for k in 0..width {
                        rates[to + k] += slope * values[n + j * width + k];
                    }
                }
            }
        };
        if self.held.is_empty() {
            let mut own = vec![0.0; n];
            self.surfaces.varied.visit(arguments, |(i, j), value| match j {
                0 => own[i] = value / self.sizes[i],
                j if j <= width => add((i, j - 1), value),
                _ => {}
            });
            rates[..n].copy_from_slice(&own);
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

    /// Passes the event at which the motion reaches a surface: it crosses it or begins to stick.
    fn meet(&mut self, index: usize) -> Result<(), SlidingStop> {
        self.refresh()?;
        let before = self.rates();
        let speed = self.surfaces.rises.at(&self.here())[(index, 0)];
        let mut on = self.held.all();
        if self.can_hold(index) {
            on.push(index);
        } else {
            self.sides[index] = -self.sides[index];
        }
        self.find_held(self.with_dependent(on), None)?;
        let behind = self.rates();
        self.jump(index, &(behind - before), speed);
        if self.held.contains(index) {
            self.put_on()?;
        }
        Ok(())
    }

    /// The gap of a wall where every state changes by a unit of its size.
    fn size_of_gap(&self, wall: usize) -> f64 {
        let normal = self.surfaces.walls[wall].normal.at(&self.here());
        (0..self.surfaces.states).map(|k| (normal[(0, k)] * self.sizes[k]).abs()).sum()
    }

    /// Checks that the motion does not begin behind a wall.
    fn check_walls(&self) -> Result<(), SlidingStop> {
        let arguments = self.here();
        let is_behind = |(index, wall): (usize, &WallMap)| {
            let gap = wall.gap.call(&arguments);
            gap.is_nan() || gap < -AT_REST * self.size_of_gap(index)
        };
        match self.surfaces.walls.iter().enumerate().any(is_behind) {
            true => Err(SlidingStop::NoValue),
            false => Ok(()),
        }
    }

    /// Carries out the impact on a wall, with the saltation matrix of the variations.
    fn strike(&mut self, wall: usize, duration: f64) -> Result<(), SlidingStop> {
        /// Part of a run below which an impact follows the one before at once.
        const AT_ONCE: f64 = 1e-7;
        const MOST_AT_ONCE: usize = 3;
        self.refresh()?;
        let (n, width) = (self.surfaces.states, self.surfaces.states + 1);
        let arguments = self.here();
        let map = &self.surfaces.walls[wall];
        let (normal, after) = (map.normal.at(&arguments), map.after.at(&arguments));
        let rates = self.surfaces.rates.at(&arguments);
        let before = DVector::from_fn(n, |i, _| rates[(i, 0)]);
        let speed: f64 =
            (0..n).map(|k| normal[(0, k)] * before[k]).sum::<f64>() + normal[(0, n + 1)];
        // A gap that has turned to rounding opens again.
        if speed >= 0.0 {
            return Ok(());
        }
        self.at_once =
            if self.time - self.struck < AT_ONCE * duration { self.at_once + 1 } else { 0 };
        if self.at_once > MOST_AT_ONCE {
            return Err(SlidingStop::RestsOnWall);
        }
        (self.struck, self.impacts) = (self.time, self.impacts + 1);
        self.slowest = self.slowest.min(-speed * duration / self.size_of_gap(wall));
        // Onto the wall, from which the event is a rounding away, and away from it.
        let gap = map.gap.call(&arguments);
        let square: f64 = (0..n).map(|k| normal[(0, k)].powi(2)).sum();
        let variations = self.values.clone();
        for i in 0..n {
            self.values[i] = (after[(i, 0)] - gap * normal[(0, i)] / square) / self.sizes[i];
        }
        self.begin()?;
        let Some(unit) = self.unit else { return Ok(()) };
        let rates = self.surfaces.rates.at(&self.here());
        // R_y f + R_t - f behind.
        let lost = DVector::from_fn(n, |i, _| {
            let carried: f64 = (0..n).map(|k| after[(i, 1 + k)] * before[k]).sum();
            carried + after[(i, n + 2)] - rates[(i, 0)]
        });
        for column in 0..width {
            let own = |k: usize| variations[n + k * width + column] * self.sizes[k];
            let by_parameter = if column == n { unit } else { 0.0 };
            let height: f64 = (0..n).map(|k| normal[(0, k)] * own(k)).sum::<f64>()
                + by_parameter * normal[(0, n)];
            let varied: Vec<f64> = (0..n)
                .map(|i| {
                    let carried: f64 = (0..n).map(|k| after[(i, 1 + k)] * own(k)).sum();
                    carried + by_parameter * after[(i, 1 + n)] - lost[i] * height / speed
                })
                .collect();
            for (i, varied) in varied.into_iter().enumerate() {
                self.values[n + i * width + column] = varied / self.sizes[i];
            }
        }
        if self.held.is_empty() { Ok(()) } else { self.lose_normals() }
    }

    /// Leaves a surface to a side, unless others on which it sticks too can take over.
    fn release(&mut self, index: usize, side: f64) -> Result<(), SlidingStop> {
        if !self.held.tied.is_empty() {
            return self.find_held(self.held.all(), Some(index));
        }
        let left = |own: &usize| *own != index;
        self.held.rows.retain(left);
        self.held.unknowns.retain(left);
        self.sides[index] = side;
        Ok(())
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
        let n = self.surfaces.states;
        let arguments = self.here();
        let rows: Vec<usize> = (0..n).collect();
        let mut along = self.held.columns(&self.surfaces.varied.at(&arguments), 2 + n, &rows);
        for (mut row, size) in along.row_iter_mut().zip(self.sizes) {
            row /= *size;
        }
        let rises = self.surfaces.rises.at(&arguments);
        (along, self.held.columns(&rises, 1, &self.held.rows))
    }

    /// Puts the states on the surfaces that hold, in the directions in which the rates jump.
    fn put_on(&mut self) -> Result<(), SlidingStop> {
        if self.held.is_empty() {
            return Ok(());
        }
        let (along, matrix) = self.directions();
        let rows = &self.held.rows;
        let heights = DVector::from_fn(rows.len(), |i, _| -self.height(rows[i]));
        let steps = solved(matrix, heights).ok_or(SlidingStop::Undetermined(rows[0]))?;
        for (value, step) in self.values.iter_mut().zip((along * steps).iter()) {
            *value += step;
        }
        Ok(())
    }

    /// Takes from the variations what leads off the surfaces on which the motion begins to stick at
    /// once, z - f_s A^-1 (u_y z + u_p).
    fn lose_normals(&mut self) -> Result<(), SlidingStop> {
        let Some(unit) = self.unit else { return Ok(()) };
        let (n, rows) = (self.surfaces.states, self.held.rows.clone());
        let width = n + 1;
        let (along, matrix) = self.directions();
        let normals = self.surfaces.normals.at(&self.here());
        for column in 0..width {
            let height = DVector::from_fn(rows.len(), |i, _| {
                let of_states = (0..n).map(|k| {
                    normals[(rows[i], k)] * self.sizes[k] * self.values[n + k * width + column]
                });
                let own = if column == n { unit * normals[(rows[i], n)] } else { 0.0 };
                of_states.sum::<f64>() + own
            });
            let steps = solved(matrix.clone(), height).ok_or(SlidingStop::Undetermined(rows[0]))?;
            let change = &along * steps;
            for i in 0..n {
                self.values[n + i * width + column] -= change[i];
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::surfaces::FlowWall;
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
        let wall = FlowWall { gap, after: vec![text("x"), after] };
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
