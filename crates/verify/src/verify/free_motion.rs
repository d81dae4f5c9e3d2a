//! The true motion that is not periodic: the equation as it was typed, integrated from rest.
//!
//! In: the equation, numbers, start and duration. Out: a [`FreeMotion`] with its turning points and
//! its crossings of the equilibrium. This module does not use the derivation of a formula;
//! `tests/library/layers.rs` checks that.

use std::collections::BTreeMap;

use super::VerificationError;
use crate::exact::rational::from_f64;
use crate::expr::{CompiledFunction, Expr};
use crate::numeric::ode;
use crate::numeric::ode::root::{BisectionStop, bisect, find_root};
use crate::oscillator::Oscillator;
use crate::symbol::Symbol;
use crate::trajectory::{Trajectory, TrajectoryRequest};

/// A motion released from rest, and for how long it is followed.
pub(super) struct Start {
    /// The equilibrium about which it oscillates.
    pub(super) equilibrium: f64,
    /// The initial distance from the equilibrium, at rest.
    pub(super) distance: f64,
    /// Duration, in the unit of time.
    pub(super) duration: f64,
    /// The interval between samples, well below a quarter of a period.
    pub(super) step: f64,
}

/// The representation of a motion.
enum FreePath {
    /// Power series of the equation, with sticking at dry friction.
    Series(Box<Trajectory>),
    /// Runge-Kutta on values of the force alone.
    Evaluated(ode::Trajectory),
}

/// The motion by values of the force alone; `None` if there is none.
fn evaluated(
    oscillator: &Oscillator,
    numbers: &BTreeMap<Symbol, f64>,
    start: &Start,
) -> Option<ode::Trajectory> {
    const TOLERANCE: f64 = 1e-10;
    let known = numbers.iter();
    let known = known.filter_map(|(name, value)| Some((*name, Expr::number(from_f64(*value)?))));
    let force = oscillator.force.substitute_all(&known.collect()).ok()?;
    let force =
        CompiledFunction::new(&force, &[oscillator.coordinate, oscillator.velocity()]).ok()?;
    let begin = ode::State { t: 0.0, x: start.equilibrium + start.distance, v: 0.0 };
    let options = ode::IntegrationOptions {
        maximum_step: start.step,
        ..ode::IntegrationOptions::with_tolerance(TOLERANCE * start.distance.abs().min(1.0))
    };
    ode::integrate(|_, x, v| -force.call(&[x, v]), begin, start.duration, &[], &options).ok()
}

/// A motion with its turning points and crossings.
pub(super) struct FreeMotion {
    motion: FreePath,
    equilibrium: f64,
    end: f64,
    /// Whether it could not be followed for the whole duration.
    ends_early: bool,
    /// Times and distances from the equilibrium at which it turns, the start left out.
    pub(super) turns: Vec<(f64, f64)>,
    /// Time and position, from the equilibrium, at which friction begins to hold it.
    held: Option<(f64, f64)>,
    /// Times at which it goes through the equilibrium.
    pub(super) crossings: Vec<f64>,
}

impl FreeMotion {
    /// Follows the motion.
    ///
    /// # Errors
    /// The motion cannot be followed.
    pub(super) fn follow(
        oscillator: &Oscillator,
        numbers: &BTreeMap<Symbol, f64>,
        start: &Start,
    ) -> Result<Self, VerificationError> {
        /// Tolerance of the integration, a millionth of the smallest deviation that is
        /// distinguished.
        const TOLERANCE: f64 = 1e-11;
        let mut course = TrajectoryRequest::of_equation(oscillator);
        let parameters = course.parameters();
        let known = numbers.iter().filter(|(name, _)| parameters.contains(name));
        course.values = known.map(|(name, value)| (*name, *value)).collect();
        course.tolerance = TOLERANCE;
        course.duration = start.duration;
        course.begin(oscillator.coordinate, start.equilibrium + start.distance)?;
        let motion = course.follow()?;
        let (end, motion) = match motion.end() < start.duration {
            // A root of the velocity, say, is not a power series where it turns; by its values
            // alone the motion goes on.
            true => match evaluated(oscillator, numbers, start) {
                Some(other) if other.end().t > motion.end() => {
                    (other.end().t, FreePath::Evaluated(other))
                }
                _ => (motion.end(), FreePath::Series(Box::new(motion))),
            },
            false => (start.duration, FreePath::Series(Box::new(motion))),
        };
        if end < start.step {
            return Err(VerificationError::NotFollowed { time: end });
        }
        let mut followed = Self {
            ends_early: end < start.duration,
            end,
            motion,
            equilibrium: start.equilibrium,
            turns: vec![],
            held: None,
            crossings: vec![],
        };
        followed.take_sample(start.step);
        Ok(followed)
    }

    /// The error for a motion that passes its equilibrium less than twice.
    pub(super) fn why_no_swing(&self) -> VerificationError {
        match self.ends_early {
            true => VerificationError::NotFollowed { time: self.end },
            false => VerificationError::NoSwing,
        }
    }

    /// The time at which it ends.
    pub(super) fn end(&self) -> f64 {
        self.end
    }

    /// Distance from the equilibrium and velocity.
    pub(super) fn phase_point_at(&self, time: f64) -> (f64, f64) {
        let found = match &self.motion {
            FreePath::Series(motion) => {
                motion.states_at(time).and_then(|state| Some((*state.first()?, *state.get(1)?)))
            }
            FreePath::Evaluated(motion) => motion.phase_point_at(time),
        };
        found.map_or((f64::NAN, f64::NAN), |(x, v)| (x - self.equilibrium, v))
    }

    /// Finds where it turns and where it crosses.
    fn take_sample(&mut self, step: f64) {
        /// Largest number of samples, more than any motion here needs.
        const MOST: usize = 1_000_000;
        let count = (self.end / step).ceil();
        let count = if count.is_finite() { (count as usize).min(MOST) } else { 0 };
        let time = |k: usize| self.end * k as f64 / count as f64;
        let (mut turns, mut crossings) = (vec![], vec![]);
        let mut before = (0.0, self.phase_point_at(0.0));
        for k in 1..=count {
            let now = (time(k), self.phase_point_at(time(k)));
            let ((t0, (x0, v0)), (t1, (x1, v1))) = (before, now);
            if x0 * x1 < 0.0
                && let Ok(t) = find_root(|t| self.phase_point_at(t).0, t0, t1)
            {
                crossings.push(t);
            }
            // The start at rest is no turn, nor is the beginning of sticking.
            let turned = v0 * v1 < 0.0;
            if turned && let Ok(t) = find_root(|t| self.phase_point_at(t).1, t0, t1) {
                turns.push((t, self.phase_point_at(t).0));
            }
            if v0 != 0.0 && v1 == 0.0 {
                let t = self.begin_of_rest(t0, t1);
                self.held = Some((t, self.phase_point_at(t).0));
            }
            before = now;
        }
        self.turns = turns;
        self.crossings = crossings;
    }

    /// The time at which sticking begins, between a time at which the mass moves and one at which
    /// it is held.
    fn begin_of_rest(&self, moves: f64, held: f64) -> f64 {
        let [_, begin] =
            bisect(|t| self.phase_point_at(t).1 != 0.0, moves, held, BisectionStop::Width(0.0));
        begin
    }

    /// The time at which the envelope through the turning points and the position of sticking falls
    /// to this size; `None` if it does not. Between two points the envelope is exponential, or
    /// linear if the point before fits that better.
    pub(super) fn falls_to(&self, size: f64) -> Option<f64> {
        let start = (0.0, self.phase_point_at(0.0).0);
        let points: Vec<(f64, f64)> = std::iter::once(start)
            .chain(self.turns.iter().copied())
            .chain(self.held)
            .map(|(t, x)| (t, x.abs()))
            .collect();
        let index = points.windows(2).position(|pair| pair[1].1 <= size && pair[0].1 > size)?;
        let [(t0, x0), (t1, x1)] = [points[index], points[index + 1]];
        // Dry friction takes the same difference every half swing, viscous damping the same ratio:
        // the turning point before decides which applies.
        let by_difference = index.checked_sub(1).is_some_and(|before| {
            let earlier = points[before].1;
            (earlier - x0 - (x0 - x1)).abs() < (x0 * x0 / earlier - x1).abs()
        });
        let part = match by_difference {
            true => (x0 - size) / (x0 - x1),
            false => (x0 / size).ln() / (x0 / x1).ln(),
        };
        Some(t0 + (t1 - t0) * part)
    }
}
