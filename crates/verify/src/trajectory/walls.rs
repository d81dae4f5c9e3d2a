//! Impacts on rigid walls at an instant, their accumulation, and the walls on which a motion rests.
//!
//! ```text
//! impact:    q' -> q' - (1 + e) d g'/(n.d),  n = dg/dq,  d = M^-1 n         g' -> -e g'
//! chatter:   impacts of speed v, e v, e^2 v, ... are over after v (1 + e + e^2 + ...) 2/|g''| = 2 v/(|g''| (1 - e))
//! bearing:   sum_j (n_i.d_j) lambda_j = -g_i'',  lambda_i > 0 for every wall i that bears
//! ```
//!
//! (B. Brogliato, *Nonsmooth Mechanics*, 3rd ed., Springer 2016, chapters 4 and 7, for the law of
//! impact and the accumulation; F. Pfeiffer, C. Glocker, *Multibody Dynamics with Unilateral
//! Contacts*, Wiley 1996, chapter 5, for the forces lambda.) Impacts at one time are taken one after
//! another, in the order of the walls, until no gap closes; where the order matters, this is recorded.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use super::resting::{WallEquations, equations};
use super::state_functions::StateFunctions;
use super::{TrajectoryError, TrajectoryRequest, work_of};
use crate::expr::{CompiledList, Expr};
use crate::symbol::Symbol;
use crate::system::rate_along;
use crate::wall::WallError;

/// Largest gap that counts as zero up to rounding, relative to the largest size of a gap.
const ON_WALL: f64 = 1e-11;

/// Largest speed towards a wall that counts as zero up to rounding, relative to the largest speed.
const AT_REST: f64 = 1e-14;

/// Largest height of a bounce, relative to the largest gap before, of which the accumulation is
/// summed in closed form.
const UNSEEN: f64 = 1e-13;

/// Largest change of the force on a wall within an accumulation that is summed, relative to the
/// force.
const STEADY: f64 = 1e-6;

/// Height of a bounce, relative to the positions in its gap, that is lost in their rounding.
const ROUNDING: f64 = 2e-13;

/// Depth behind a wall, relative to the sizes of its gap, beyond which a motion has passed it.
const BEHIND: f64 = 1e-9;

/// Largest number of impacts at one time.
const MOST_AT_ONE_TIME: usize = 10_000;

/// Name of the work of walls in the account of energy.
pub(super) const WORK_OF_WALLS: &str = "walls";

/// An impact on a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// The time.
    pub time: f64,
    /// The index of the wall.
    pub wall: usize,
    /// The speed at which the gap closes before the impact.
    pub speed: f64,
    /// The speed at which it opens after the impact.
    pub departure: f64,
    /// The energy that the impact takes from the motion; `None` if there is no account of energy.
    pub loss: Option<f64>,
}

/// A stretch of time on which a motion rests on a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallRest {
    /// The index of the wall.
    pub wall: usize,
    /// The time at which it begins, after the sum of an accumulation of impacts.
    pub from: f64,
    /// The time at which the force of the wall has fallen to zero, or the motion ends.
    pub until: f64,
    /// Whether impacts accumulated before it.
    pub after_chatter: bool,
}

/// The impacts and rests of a motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WallRecord {
    /// The impacts, in order; of an accumulation those before its sum.
    pub impacts: Vec<Impact>,
    /// The rests on walls, in the order of their beginning.
    pub rests: Vec<WallRest>,
    /// The first time at which several walls were hit at once and the order of the impacts matters;
    /// `None` if there is none.
    pub order_matters: Option<f64>,
}

/// The event after which a motion goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum WallEvent {
    /// It begins.
    Start,
    /// The gap of this wall has fallen to zero.
    Hit(usize),
    /// The force of this wall has fallen to zero.
    Released(usize),
}

/// The walls of a course, ready for impacts.
#[derive(Clone, Debug)]
pub(super) struct CompiledWalls {
    walls: Vec<WallEquations>,
    restitution: Vec<f64>,
    /// For each wall: g, g', g'' and g''' in flight, n, and M^-1 n.
    functions: Vec<CompiledList>,
    /// The gaps of all walls.
    gaps: CompiledList,
    evaluation: StateFunctions,
    /// The index among all states of the work of the walls; `None` if it is not accounted for.
    pub(super) work: Option<usize>,
    /// The numbers of coordinates and of states.
    counts: [usize; 2],
    /// The index of the coordinate of each velocity: all but those of equations of first order.
    moving: Vec<usize>,
}

/// Memory for what impacts on walls need.
#[derive(Clone, Debug, Default)]
pub(super) struct WallMemory {
    /// The values at each wall.
    walls: Vec<AtWall>,
    /// The gap of each wall.
    gaps: Vec<f64>,
    /// The walls that a motion touches at an instant, and those that it hits.
    touched: Vec<usize>,
    struck: Vec<usize>,
}

/// The values of the functions of a wall at a state.
#[derive(Clone, Debug, Default)]
struct AtWall {
    gap: f64,
    rate: f64,
    free: f64,
    jerk: f64,
    /// These four, then n and d = M^-1 n.
    values: Vec<f64>,
}

impl AtWall {
    /// n = dg/dq for each coordinate.
    fn normal(&self) -> &[f64] {
        &self.values[4..self.values.len() / 2 + 2]
    }

    /// d = M^-1 n for each coordinate.
    fn direction(&self) -> &[f64] {
        &self.values[self.values.len() / 2 + 2..]
    }

    /// The largest component of n.
    fn largest_normal(&self) -> f64 {
        self.normal().iter().fold(0.0_f64, |most, n| most.max(n.abs()))
    }

    /// n . d: the change of the rate of the gap by a unit of momentum of the wall.
    fn compliance(&self) -> f64 {
        self.compliance_with(self)
    }

    /// The change of the rate of this gap by a unit of momentum of another wall.
    fn compliance_with(&self, other: &Self) -> f64 {
        self.normal().iter().zip(other.direction()).map(|(n, d)| n * d).sum()
    }
}

/// The forces of walls that keep their gaps closed; `None` if they are not determined.
fn forces(walls: &[(usize, AtWall)]) -> Option<DVector<f64>> {
    let size = walls.len();
    if size == 0 {
        return Some(DVector::zeros(0));
    }
    let compliance = DMatrix::from_fn(size, size, |i, j| walls[i].1.compliance_with(&walls[j].1));
    let right = DVector::from_fn(size, |i, _| -walls[i].1.free);
    let forces = compliance.lu().solve(&right)?;
    forces.iter().all(|force| force.is_finite()).then_some(forces)
}

impl CompiledWalls {
    /// The walls of a course whose account of energy has these works behind its states.
    pub(super) fn new(course: &TrajectoryRequest) -> Result<Option<Self>, TrajectoryError> {
        if course.walls.is_empty() {
            return Ok(None);
        }
        let walls = equations(course)?;
        let states = &course.rates.states;
        let evaluation = StateFunctions::new(course);
        let compiled = |wall: &WallEquations| {
            let jerk = rate_along(&wall.free, Symbol::new("t"), states, &course.rates.right);
            let mut all = vec![
                wall.impact.gap.clone(),
                wall.impact.rate.clone(),
                wall.free.clone(),
                jerk.unwrap_or_else(Expr::zero),
            ];
            all.extend(wall.impact.normal.iter().chain(&wall.impact.direction).cloned());
            evaluation
                .compiled(&all)
                .map_err(|error| TrajectoryError::WallUndefined(wall.impact.gap.clone(), error))
        };
        let functions = walls.iter().map(compiled).collect::<Result<_, _>>()?;
        let has_velocity =
            |index: &usize| states.contains(&course.coordinates[*index].derivative());
        let moving = (0..course.coordinates.len()).filter(has_velocity).collect();
        let gaps: Vec<Expr> = walls.iter().map(|wall| wall.impact.gap.clone()).collect();
        let undefined = |error| TrajectoryError::WallUndefined(gaps[0].clone(), error);
        Ok(Some(Self {
            functions,
            gaps: evaluation.compiled(&gaps).map_err(undefined)?,
            walls,
            restitution: restitutions(course)?,
            work: work_of(course, WORK_OF_WALLS),
            evaluation,
            counts: [course.coordinates.len(), states.len()],
            moving,
        }))
    }

    /// Returns the walls with the numbers of a course that differs in its numbers alone.
    pub(super) fn with_numbers(&self, course: &TrajectoryRequest) -> Result<Self, TrajectoryError> {
        Ok(Self {
            evaluation: self.evaluation.with_numbers(course),
            restitution: restitutions(course)?,
            ..self.clone()
        })
    }

    fn at(&self, wall: usize, time: f64, state: &[f64]) -> AtWall {
        let mut at = AtWall::default();
        self.refresh(&mut at, wall, time, state);
        at
    }

    /// Takes the values at a wall at another state.
    fn refresh(&self, at: &mut AtWall, wall: usize, time: f64, state: &[f64]) {
        at.values.resize(4 + 2 * self.counts[0], 0.0);
        self.evaluation.write_values(&self.functions[wall], time, state, &mut at.values);
        [at.gap, at.rate, at.free, at.jerk] = [0, 1, 2, 3].map(|index| at.values[index]);
    }

    /// Takes the values at all walls at another state.
    fn refresh_each(&self, walls: &mut Vec<AtWall>, time: f64, state: &[f64]) {
        walls.resize_with(self.walls.len(), AtWall::default);
        for (wall, at) in walls.iter_mut().enumerate() {
            self.refresh(at, wall, time, state);
        }
    }

    /// The size of a gap: that of the positions in it, whose rounding it has, or the largest so far. Where
    /// all of these are zero, as at the beginning of a rest on a wall that passes the origin, it is a small
    /// part of the height of a flight at the speeds in it.
    fn size_of_gap(&self, at: &AtWall, state: &[f64], largest: f64) -> f64 {
        const PART_OF_FLIGHT: f64 = 1e-3;
        let [coordinates, states] = self.counts;
        let normal = at.normal();
        let velocities = self.moving.iter().zip(&state[coordinates..states]);
        let speed = velocities.map(|(index, v)| (normal[*index] * v).abs()).fold(0.0, f64::max);
        let positions =
            normal.iter().zip(&state[..coordinates]).map(|(n, value)| (n * value).abs());
        let position = positions.fold(0.0, f64::max);
        let flight = PART_OF_FLIGHT * speed * speed / at.free.abs();
        let flight = if flight.is_finite() { flight } else { 0.0 };
        largest.max(position).max(flight)
    }

    /// Whether a motion is behind a wall, beyond rounding.
    pub(super) fn passed(
        &self,
        time: f64,
        state: &[f64],
        largest: &[f64],
        WallMemory { walls, gaps, .. }: &mut WallMemory,
    ) -> bool {
        self.write_gaps(time, state, gaps);
        if gaps.iter().all(|gap| *gap >= 0.0) {
            return false;
        }
        self.refresh_each(walls, time, state);
        let size = self.size_of_gaps(walls, state, largest);
        gaps.iter().any(|gap| *gap < -BEHIND * size)
    }

    /// The largest size of a gap: one that is closed all the time has none of its own.
    fn size_of_gaps(&self, walls: &[AtWall], state: &[f64], largest: &[f64]) -> f64 {
        walls.iter().enumerate().fold(0.0_f64, |most, (wall, at)| {
            let largest = largest.get(wall).copied().unwrap_or(0.0);
            most.max(self.size_of_gap(at, state, largest))
        })
    }

    /// The gap of the first wall behind which a state is, beyond rounding, and its value; `None` if it is on
    /// or in front of all walls.
    pub(super) fn behind(&self, time: f64, state: &[f64]) -> Option<(Expr, f64)> {
        self.walls.iter().enumerate().find_map(|(index, wall)| {
            let at = self.at(index, time, state);
            let is_behind = at.gap < -ON_WALL * self.size_of_gap(&at, state, 0.0);
            is_behind.then(|| (wall.impact.gap.clone(), at.gap))
        })
    }

    /// The start of a motion on or in front of all walls, to rounding.
    ///
    /// # Errors
    /// The first wall behind which it begins.
    pub(super) fn check_start(&self, time: f64, state: &[f64]) -> Result<(), TrajectoryError> {
        if let Some((gap, value)) = self.behind(time, state) {
            return Err(TrajectoryError::BehindWall { gap, value });
        }
        for (index, wall) in self.walls.iter().enumerate() {
            let at = self.at(index, time, state);
            // Away from a wall, x^2 < 1, its gap may be greatest, and changes by no velocity there.
            let is_greatest = at.gap > 0.0 && at.largest_normal() == 0.0;
            if !is_greatest && (at.compliance().is_nan() || at.compliance() <= 0.0) {
                return Err(WallError::WithoutMass(wall.impact.gap.clone()).into());
            }
            if at.gap.is_nan() || at.rate.is_nan() {
                return Err(TrajectoryError::WallWithCorner(wall.impact.gap.clone()));
            }
        }
        Ok(())
    }

    /// Carries out the impacts at a state after this event, and returns the walls on which the motion
    /// rests from there on. `resting` are those on which it rested before, `largest` is the largest gap
    /// of each wall so far.
    pub(super) fn settle(
        &self,
        time: f64,
        state: &mut [f64],
        event: WallEvent,
        resting: &[usize],
        largest: &[f64],
        (record, memory): (&mut WallRecord, &mut WallMemory),
    ) -> Vec<usize> {
        let [coordinates, states] = self.counts;
        let WallMemory { walls, touched, struck, .. } = memory;
        touched.clear();
        touched.extend_from_slice(resting);
        struck.clear();
        let mut chatter: BTreeMap<usize, f64> = BTreeMap::new();
        self.refresh_each(walls, time, state);
        let size_of_gaps = self.size_of_gaps(walls, state, largest);
        for _ in 0..MOST_AT_ONE_TIME {
            let speed =
                state[coordinates..states].iter().fold(0.0_f64, |most, v| most.max(v.abs()));
            let closing = walls.iter().enumerate().position(|(wall, at)| {
                let near = at.gap.abs() <= ON_WALL * size_of_gaps;
                let on = event == WallEvent::Hit(wall) || touched.contains(&wall) || near;
                if on && !touched.contains(&wall) {
                    touched.push(wall);
                }
                on && at.rate < -AT_REST * at.largest_normal() * speed
            });
            let Some(wall) = closing else { break };
            let at = &walls[wall];
            let before = self.evaluation.energy(time, state);
            let compliance = at.compliance();
            let mut departure = -self.restitution[wall] * at.rate;
            let over = self.accumulation(wall, at, departure, largest, resting, (time, state));
            if let Some(sum) = over {
                departure = 0.0;
                chatter.insert(wall, sum);
            }
            let change = (departure - at.rate) / compliance;
            let velocities = state[coordinates..states].iter_mut();
            for (velocity, index) in velocities.zip(&self.moving) {
                *velocity += change * at.direction()[*index];
            }
            let after = self.evaluation.energy(time, state);
            let loss = before.zip(after).map(|(before, after)| before - after);
            if let (Some(work), Some(loss)) = (self.work, loss) {
                state[work] -= loss;
            }
            record.impacts.push(Impact { time, wall, speed: -at.rate, departure, loss });
            if struck.iter().any(|other| *other != wall && self.couples(*other, at, time, state)) {
                record.order_matters.get_or_insert(time);
            }
            struck.push(wall);
            self.refresh_each(walls, time, state);
        }
        // The state is put onto the walls that were hit, which rounding has left a little off.
        for wall in struck.iter().chain(resting) {
            if walls[*wall].gap != 0.0 {
                self.project(&walls[*wall], state);
                self.refresh_each(walls, time, state);
            }
        }
        // A start a little behind a wall is put onto it: a gap that opens from less than nothing may fall again
        // without having passed through zero.
        for wall in touched.iter().filter(|_| event == WallEvent::Start) {
            if walls[*wall].gap < 0.0 {
                self.project(&walls[*wall], state);
                self.refresh_each(walls, time, state);
            }
        }
        // The force of a wall that was released is zero, up to rounding.
        touched.retain(|wall| event != WallEvent::Released(*wall));
        let bearing = self.bearing(time, state, touched, walls, |wall| {
            chatter.contains_key(&wall) || resting.contains(&wall)
        });
        for wall in &bearing {
            if !resting.contains(wall) {
                let sum = chatter.get(wall).copied();
                record.rests.push(WallRest {
                    wall: *wall,
                    from: time + sum.unwrap_or(0.0),
                    until: f64::INFINITY,
                    after_chatter: sum.is_some_and(|sum| sum > 0.0),
                });
            }
        }
        for rest in record.rests.iter_mut().filter(|rest| rest.until.is_infinite()) {
            if !bearing.contains(&rest.wall) {
                rest.until = time.max(rest.from);
            }
        }
        bearing
    }

    /// Whether an impact on a wall changes the rate of the gap of another.
    fn couples(&self, other: usize, at: &AtWall, time: f64, state: &[f64]) -> bool {
        let other = self.at(other, time, state);
        other.compliance_with(at) != 0.0
    }

    /// The time after which the impacts that follow one of this departure are over, if they cannot be
    /// seen; `None` if they are followed one by one.
    fn accumulation(
        &self,
        wall: usize,
        at: &AtWall,
        departure: f64,
        largest: &[f64],
        resting: &[usize],
        (time, state): (f64, &[f64]),
    ) -> Option<f64> {
        let restitution = self.restitution[wall];
        if restitution == 0.0 {
            return Some(0.0);
        }
        if restitution >= 1.0 {
            return None;
        }
        // The acceleration of the gap with the forces of the walls that bear.
        let others: Vec<(usize, AtWall)> = resting
            .iter()
            .filter(|other| **other != wall)
            .map(|other| (*other, self.at(*other, time, state)))
            .collect();
        let forces = forces(&others)?;
        let held = others.iter().zip(forces.iter());
        let pull = -at.free
            - held.map(|((_, other), force)| at.compliance_with(other) * force).sum::<f64>();
        if pull <= 0.0 {
            return None;
        }
        let sum = 2.0 * departure / (pull * (1.0 - restitution));
        let height = departure * departure / (2.0 * pull);
        let seen = largest.get(wall).copied().unwrap_or(0.0);
        let is_steady = height <= UNSEEN * seen && at.jerk.abs() * sum <= STEADY * pull;
        let is_rounding = height <= ROUNDING * self.size_of_gap(at, state, 0.0);
        (is_steady || is_rounding).then_some(sum)
    }

    /// Moves a state along M^-1 n onto a wall.
    fn project(&self, at: &AtWall, state: &mut [f64]) {
        let [coordinates, _] = self.counts;
        let shift = at.gap / at.compliance();
        if shift.is_finite() {
            for (position, direction) in state[..coordinates].iter_mut().zip(at.direction()) {
                *position -= shift * direction;
            }
        }
    }

    /// The walls among those touched on which a motion rests: their gaps do not open, and their
    /// forces press. The walls of `at_rest` have no rate but rounding.
    fn bearing(
        &self,
        time: f64,
        state: &[f64],
        touched: &[usize],
        walls: &[AtWall],
        at_rest: impl Fn(usize) -> bool,
    ) -> Vec<usize> {
        let [coordinates, states] = self.counts;
        let speed = state[coordinates..states].iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        let is_at_rest = |wall: &&usize| {
            let at = &walls[**wall];
            let size = at.largest_normal() * speed;
            at_rest(**wall) && at.rate.abs() <= 1e-9 * size || at.rate.abs() <= AT_REST * size
        };
        let mut bearing: Vec<(usize, AtWall)> = touched
            .iter()
            .filter(is_at_rest)
            .map(|wall| (*wall, self.with_sign_of_force(*wall, time, state)))
            .collect();
        bearing.sort_by_key(|(wall, _)| *wall);
        // The wall that would pull most is left, until all press.
        while !bearing.is_empty() {
            let Some(forces) = forces(&bearing) else {
                bearing.pop();
                continue;
            };
            let least =
                (0..bearing.len()).min_by(|one, other| forces[*one].total_cmp(&forces[*other]));
            match least {
                Some(least) if forces[least] <= 0.0 => bearing.remove(least),
                _ => break,
            };
        }
        bearing.into_iter().map(|(wall, _)| wall).collect()
    }

    /// The values at a wall with the sign of g'' a moment later, where it is zero.
    fn with_sign_of_force(&self, wall: usize, time: f64, state: &[f64]) -> AtWall {
        const MOMENT: f64 = 1e-3;
        let [coordinates, states] = self.counts;
        let at = self.at(wall, time, state);
        if at.free != 0.0 {
            return at;
        }
        let later = || {
            let mut state = state[..states].to_vec();
            for (velocity, index) in self.moving.iter().enumerate() {
                state[*index] += MOMENT * state[coordinates + velocity];
            }
            self.at(wall, time + MOMENT, &state).free
        };
        let sign = if at.jerk == 0.0 { later() } else { at.jerk };
        AtWall { free: if sign < 0.0 { -f64::MIN_POSITIVE } else { 0.0 }, ..at }
    }

    /// Raises the largest gap of each wall to those at a state. Returns whether the motion is in front of all
    /// walls there.
    pub(super) fn note_largest(
        &self,
        time: f64,
        state: &[f64],
        largest: &mut [f64],
        WallMemory { gaps, .. }: &mut WallMemory,
    ) -> bool {
        self.write_gaps(time, state, gaps);
        let mut is_in_front = true;
        for (largest, gap) in largest.iter_mut().zip(gaps) {
            *largest = largest.max(*gap);
            is_in_front &= *gap >= 0.0;
        }
        is_in_front
    }

    /// The gap of each wall at a state.
    pub(super) fn gaps(&self, time: f64, state: &[f64]) -> Vec<f64> {
        self.evaluation.values(&self.gaps, self.walls.len(), time, state)
    }

    fn write_gaps(&self, time: f64, state: &[f64], gaps: &mut Vec<f64>) {
        gaps.resize(self.walls.len(), 0.0);
        self.evaluation.write_values(&self.gaps, time, state, gaps);
    }
}

/// The coefficient of restitution of each wall.
fn restitutions(course: &TrajectoryRequest) -> Result<Vec<f64>, TrajectoryError> {
    let values = &course.values;
    Ok(course.walls.iter().map(|wall| wall.restitution_at(values)).collect::<Result<_, _>>()?)
}
