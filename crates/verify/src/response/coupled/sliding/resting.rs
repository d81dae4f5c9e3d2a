//! Rests on a rigid wall within a run: bounces that accumulate end in one, and it ends where the wall would have to
//! pull.
//!
//! ```text
//! g = 0,  dg/dt = 0:   y' = f - w D^2 g/(w . grad_v dg/dt),   w = (0, M^-1 n),   D^2 g < 0: the acceleration without the wall
//! variations           z_q -= w (g_y z + g_p)/(w . grad_q g),   then z_v -= w (g'_y z + g'_p)/(w . grad_v g'),   g' = dg/dt
//! ```
//!
//! From an impact that is so slow that the next one follows within 1e-5 of the run the motion is taken to rest:
//! what is left of the sum of all bounces is of the order of that squared. Flights that are much shorter would stay
//! within the distance from the wall at which an impact is seen. Along the normal of the wall what was
//! before is forgotten: the saltation matrix has two ranks less. At the release nothing jumps.

use super::{AT_REST, EventRun, SlidingStop, UNSEEN};
use crate::response::coupled::surfaces::{JumpSurfaces, RestMap};

/// Part of a run below which an impact that follows the one before ends in rest.
const SHORTEST_FLIGHT: f64 = 1e-5;

/// Depth behind a wall, in the sizes of the states, from which a motion that the wall bears begins on it.
const NEARLY_ON: f64 = 0.05;

impl<'a> EventRun<'a> {
    /// The wall on which the motion rests.
    pub(super) fn resting_map(&self) -> Option<&'a RestMap> {
        self.surfaces.events[self.resting?].rest.as_ref()
    }

    /// The rate at which the gap of a wall changes, and that of this rate without the wall; `None` for an event on
    /// which nothing rests.
    fn gap_rates(&self, event: usize) -> Option<[f64; 2]> {
        let rest = self.surfaces.events[event].rest.as_ref()?;
        let arguments = self.here();
        Some([rest.rate.call(&arguments), rest.acceleration.call(&arguments)])
    }

    /// Whether the motion, on a wall, would be back on it at once, and pushes on it.
    pub(super) fn comes_to_rest(&self, event: usize, duration: f64) -> bool {
        let Some([rate, acceleration]) = self.gap_rates(event) else { return false };
        let gap = self.surfaces.events[event].gap.call(&self.here());
        let size = self.size_of_gap(event, &self.here());
        let is_on = gap.abs() <= AT_REST * size && rate >= -AT_REST * size / duration;
        is_on && acceleration < 0.0 && -2.0 * rate / acceleration < SHORTEST_FLIGHT * duration
    }

    /// Lets the motion begin to rest on a wall.
    ///
    /// # Errors
    /// [`SlidingStop::RestsOnWall`] where it rests on another one already, or forces jump.
    pub(super) fn rest_on(&mut self, event: usize) -> Result<(), SlidingStop> {
        let is_alone = self.resting.is_none_or(|own| own == event) && self.sides.is_empty();
        let rest = self.surfaces.events[event].rest.as_ref();
        let other = self.resting.filter(|own| *own != event);
        let stop = SlidingStop::RestsOnWall(event, other);
        let Some(rest) = rest.filter(|_| is_alone) else { return Err(stop) };
        self.resting = Some(event);
        self.rests += 1;
        self.impacts = self.impacts_at_release;
        let (n, width) = (self.surfaces.states, self.surfaces.states + 1);
        let arguments = self.here();
        let directions = rest.directions.at(&arguments);
        let normals =
            [self.surfaces.events[event].normal.at(&arguments), rest.normal.at(&arguments)];
        let heights =
            [self.surfaces.events[event].gap.call(&arguments), rest.rate.call(&arguments)];
        // First the place, then the velocity, along the impulse of the wall.
        for (row, (normal, height)) in normals.iter().zip(heights).enumerate() {
            let along: f64 = (0..n).map(|k| normal[(0, k)] * directions[(row, k)]).sum();
            if along == 0.0 || !along.is_finite() {
                return Err(stop);
            }
            for i in 0..n {
                self.values[i] -= directions[(row, i)] * height / (along * self.sizes[i]);
            }
            let Some(unit) = self.unit else { continue };
            for column in 0..width {
                let of_states = (0..n)
                    .map(|k| normal[(0, k)] * self.sizes[k] * self.values[n + k * width + column]);
                let own = if column == n { unit * normal[(0, n)] } else { 0.0 };
                let height = of_states.sum::<f64>() + own;
                for i in 0..n {
                    self.values[n + i * width + column] -=
                        directions[(row, i)] * height / (along * self.sizes[i]);
                }
            }
        }
        Ok(())
    }

    /// Lets the motion begin at rest where it begins on a wall, with no speed off it, and is pushed onto it; or a
    /// little behind a wall, as the guess of a motion that rests there may be, for it comes to rest again.
    ///
    /// # Errors
    /// [`SlidingStop::RestsOnWall`].
    pub(super) fn begin_at_rest(&mut self, duration: f64) -> Result<(), SlidingStop> {
        if !self.sides.is_empty() {
            return Ok(());
        }
        let arguments = self.here();
        let begins = |event: &usize| {
            let Some([rate, acceleration]) = self.gap_rates(*event) else { return false };
            let gap = self.surfaces.events[*event].gap.call(&arguments);
            let size = self.size_of_gap(*event, &arguments);
            let slow = AT_REST * size / duration;
            let is_on = rate.abs() <= slow && gap.abs() <= AT_REST * size;
            let is_behind = gap < -AT_REST * size && gap > -NEARLY_ON * size;
            let falls_behind = gap < 0.0 && rate < 0.0 && gap > -NEARLY_ON * size;
            acceleration < 0.0 && (is_on || is_behind || falls_behind)
        };
        let event = (0..self.surfaces.events.len()).find(begins);
        match event {
            Some(event) => {
                self.rest_on(event)?;
                // A rest that goes on is counted where it began.
                self.rests = 0;
                Ok(())
            }
            None => Ok(()),
        }
    }

    /// Leaves the wall on which the motion rests, which would have to pull.
    pub(super) fn lift(&mut self) {
        self.times.push(self.time);
        self.impacts_at_release = self.impacts;
        if let Some(event) = self.resting.take() {
            // Just off the wall, so that the gap is seen to open.
            let arguments = self.here();
            let map = &self.surfaces.events[event];
            let normal = map.normal.at(&arguments);
            let n = self.surfaces.states;
            let square: f64 = (0..n).map(|k| normal[(0, k)].powi(2)).sum();
            let place = 0.5 * UNSEEN * self.size_of_gap(event, &arguments);
            let gap = map.gap.call(&arguments) + place;
            for i in 0..n {
                self.values[i] -= gap * normal[(0, i)] / (square * self.sizes[i]);
            }
        }
    }
}

/// The state, in these sizes, on the walls from which rounding or the search for an orbit have left it apart,
/// and without a speed off them where that is rounding too; otherwise as it is.
pub(in crate::response::coupled) fn onto_walls(
    surfaces: &JumpSurfaces,
    mut state: Vec<f64>,
    sizes: &[f64],
    at: [f64; 2],
) -> Vec<f64> {
    let n = surfaces.states;
    for wall in &surfaces.events {
        let Some(rest) = &wall.rest else { continue };
        let arguments: Vec<f64> = state.iter().copied().chain(at).collect();
        let directions = rest.directions.at(&arguments);
        let heights = [
            (wall.gap.call(&arguments), wall.normal.at(&arguments)),
            (rest.rate.call(&arguments), rest.normal.at(&arguments)),
        ];
        for (row, (height, normal)) in heights.into_iter().enumerate() {
            let size: f64 = (0..n).map(|k| (normal[(0, k)] * sizes[k]).abs()).sum();
            let along: f64 = (0..n).map(|k| normal[(0, k)] * directions[(row, k)]).sum();
            let is_near = height.abs() <= AT_REST * size && along != 0.0;
            if !is_near {
                break;
            }
            for (k, value) in state.iter_mut().enumerate() {
                *value -= directions[(row, k)] * height / along;
                // What is left of a zero would have no digits.
                if value.abs() < f64::EPSILON * sizes[k] {
                    *value = 0.0;
                }
            }
        }
    }
    state
}
