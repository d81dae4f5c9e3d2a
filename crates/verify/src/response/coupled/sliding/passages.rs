//! The events at which a motion meets a surface, leaves it, hits a wall or is set anew, with the saltation
//! matrices of its variations (the head of `sliding.rs`).

use nalgebra::{DMatrix, DVector};

use super::held::solved;
use super::{AT_REST, EventRun, SlidingStop, UNSEEN};
use crate::response::coupled::surfaces::EventMap;

impl EventRun<'_> {
    /// Passes the event at which the motion reaches a surface: it crosses it or begins to stick.
    pub(super) fn meet(&mut self, index: usize) -> Result<(), SlidingStop> {
        self.refresh()?;
        let before = self.rates();
        let speed = self.surfaces.rises.at(&self.here())[(index, 0)];
        let mut on = self.held.all();
        if self.can_hold(index) {
            on.push(index);
        } else {
            self.sides[index] = -self.sides[index];
            // In a stiff contact a step as long as those before it is rejected, but its states would count as
            // bounds of the motion.
            self.next_step = 0.0;
        }
        self.find_held(self.with_dependent(on), None)?;
        let behind = self.rates();
        self.jump(index, &(behind - before), speed);
        if self.held.contains(index) {
            self.put_on()?;
        }
        Ok(())
    }

    /// The gap of an event at these arguments where every state changes by a unit of its size.
    pub(super) fn size_of_gap(&self, event: usize, arguments: &[f64]) -> f64 {
        let normal = self.surfaces.events[event].normal.at(arguments);
        (0..self.surfaces.states).map(|k| (normal[(0, k)] * self.sizes[k]).abs()).sum()
    }

    /// The rate at which the gap of an event changes at these arguments.
    fn rate_of_gap(&self, event: usize, arguments: &[f64]) -> f64 {
        let n = self.surfaces.states;
        let normal = self.surfaces.events[event].normal.at(arguments);
        let rates = self.surfaces.rates.at(arguments);
        (0..n).map(|k| normal[(0, k)] * rates[(k, 0)]).sum::<f64>() + normal[(0, n + 1)]
    }

    /// Checks that the motion does not begin behind a wall.
    pub(super) fn check_walls(&self) -> Result<(), SlidingStop> {
        let arguments = self.here();
        let is_behind = |(index, event): (usize, &EventMap)| {
            let gap = event.gap.call(&arguments);
            let least = -AT_REST * self.size_of_gap(index, &arguments);
            gap.is_nan() || event.is_wall && event.unwatched == 0.0 && gap < least
        };
        match self.surfaces.events.iter().enumerate().any(is_behind) {
            true => Err(SlidingStop::NoValue),
            false => Ok(()),
        }
    }

    /// Puts the states behind an event of which they are a rounding away: onto the wall that they leave again, or
    /// so far beyond the guard through which the motion goes on that it is not seen to fall once more.
    fn put_behind(&mut self, event: usize, duration: f64) {
        let arguments = self.here();
        let map = &self.surfaces.events[event];
        let normal = map.normal.at(&arguments);
        let n = self.surfaces.states;
        let square: f64 = (0..n).map(|k| normal[(0, k)].powi(2)).sum();
        let gap = map.gap.call(&arguments);
        if square == 0.0 || gap.abs() > AT_REST * self.size_of_gap(event, &arguments) {
            return;
        }
        let place = match self.goes_through(event, duration) {
            true => -2.0 * self.unseen_gap(event, duration),
            false => 0.0,
        };
        for i in 0..n {
            self.values[i] -= (gap - place) * normal[(0, i)] / (square * self.sizes[i]);
        }
    }

    /// The distance below zero at which the gap of an event is seen to have fallen: that of rounding.
    pub(super) fn unseen_gap(&self, event: usize, duration: f64) -> f64 {
        let arguments = self.here();
        let size = self.size_of_gap(event, &arguments);
        // A guard that depends on the time alone has its size from the time.
        match size > 0.0 {
            true => UNSEEN * size,
            false => UNSEEN * self.rate_of_gap(event, &arguments).abs() * duration,
        }
    }

    /// Whether the motion, a rounding away from the guard of an event, goes through it.
    pub(super) fn goes_through(&self, event: usize, duration: f64) -> bool {
        let arguments = self.here();
        let map = &self.surfaces.events[event];
        let near = AT_REST / UNSEEN * self.unseen_gap(event, duration);
        !map.is_wall
            && map.gap.call(&arguments).abs() <= near
            && self.rate_of_gap(event, &arguments) < 0.0
    }

    /// Passes an event, and those that a time of their own puts at the same instant.
    pub(super) fn pass(&mut self, event: usize, duration: f64) -> Result<(), SlidingStop> {
        self.pass_one(event, duration)?;
        for other in 0..self.surfaces.events.len() {
            let is_of_time = self.size_of_gap(other, &self.here()) == 0.0;
            let is_new = self.time - self.passed[other] > UNSEEN * duration;
            if is_of_time && is_new && self.goes_through(other, duration) {
                self.pass_one(other, duration)?;
            }
        }
        Ok(())
    }

    /// Passes an event, such as the impact on a wall, with the saltation matrix of the variations.
    fn pass_one(&mut self, event: usize, duration: f64) -> Result<(), SlidingStop> {
        /// Part of a run below which an event follows the one before at once.
        const AT_ONCE: f64 = 1e-7;
        const MOST_AT_ONCE: usize = 3;
        self.refresh()?;
        let (n, width) = (self.surfaces.states, self.surfaces.states + 1);
        let arguments = self.here();
        let map = &self.surfaces.events[event];
        let (normal, after) = (map.normal.at(&arguments), map.after.at(&arguments));
        let rates = self.rates_here(&arguments);
        let before = DVector::from_fn(n, |i, _| rates[(i, 0)]);
        let speed = self.rate_of_gap(event, &arguments);
        // A gap that has turned to rounding opens again.
        if speed >= 0.0 {
            return Ok(());
        }
        self.at_once =
            if self.time - self.last < AT_ONCE * duration { self.at_once + 1 } else { 0 };
        if self.at_once > MOST_AT_ONCE {
            let is_met = |other: &usize| {
                let own = &self.surfaces.events[*other];
                *other != event
                    && own.is_wall
                    && self.time - self.passed[*other] < AT_ONCE * duration
            };
            let other = (0..self.surfaces.events.len()).find(is_met).or(self.resting);
            return Err(match map.is_wall {
                true => SlidingStop::RestsOnWall(event, other.filter(|other| *other != event)),
                false => SlidingStop::EventsAccumulate,
            });
        }
        (self.last, self.passed[event]) = (self.time, self.time);
        self.times.push(self.time);
        *(if map.is_wall { &mut self.impacts } else { &mut self.events }) += 1;
        let slowness = -speed * duration / self.size_of_gap(event, &arguments);
        self.slowest = self.slowest.min(slowness);
        let variations = self.values.clone();
        for i in 0..n {
            self.values[i] = after[(i, 0)] / self.sizes[i];
        }
        self.put_behind(event, duration);
        // An event may end a rest, or let it go on.
        let rested = self.resting.take();
        self.resting = rested.filter(|wall| self.comes_to_rest(*wall, duration));
        if rested.is_some() && self.resting.is_none() {
            self.impacts_at_release = self.impacts;
        }
        if !map.is_wall {
            self.check_walls()?;
        }
        // A jump past the guard of another event would be a second event at once, and one on the same guard
        // would be lost.
        let here = self.here();
        let is_at_once = |(index, other): (usize, &EventMap)| {
            let size = self.size_of_gap(index, &arguments);
            let [before, behind] = [&arguments, &here].map(|at| other.gap.call(at));
            let falls = |at: &[f64]| self.rate_of_gap(index, at) < 0.0;
            let jumps_past = !other.is_wall && before > AT_REST * size && behind < -AT_REST * size;
            let is_met = before.abs() <= AT_REST * size && falls(&arguments);
            let is_lost = is_met && !(behind > -UNSEEN * size && falls(&here));
            let are_walls = map.is_wall && other.is_wall;
            index != event
                && Some(index) != rested
                && size > 0.0
                && !are_walls
                && (jumps_past || is_lost)
        };
        if self.surfaces.events.iter().enumerate().any(is_at_once) {
            return Err(SlidingStop::EventsAccumulate);
        }
        self.begin()?;
        let comes_to_rest = map.is_wall && self.comes_to_rest(event, duration);
        let Some(unit) = self.unit else {
            return if comes_to_rest { self.rest_on(event) } else { Ok(()) };
        };
        let rates = self.rates_here(&self.here());
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
        if comes_to_rest {
            return self.rest_on(event);
        }
        if self.held.is_empty() { Ok(()) } else { self.lose_normals() }
    }

    /// Leaves a surface to a side, unless others on which it sticks too can take over.
    pub(super) fn release(&mut self, index: usize, side: f64) -> Result<(), SlidingStop> {
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
    pub(super) fn jump(&mut self, index: usize, change: &DVector<f64>, speed: f64) {
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
    pub(super) fn directions(&self) -> (DMatrix<f64>, DMatrix<f64>) {
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
    pub(super) fn put_on(&mut self) -> Result<(), SlidingStop> {
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
    pub(super) fn lose_normals(&mut self) -> Result<(), SlidingStop> {
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
