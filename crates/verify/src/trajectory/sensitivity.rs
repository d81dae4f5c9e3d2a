//! The time until which a motion is determined by its start to six digits.
//!
//! ```text
//! d(t) = max_i |y_i(t) - z_i(t)|/Y_i,  Y_i = max |y_i|        z: the same from a start with y_i (1 + 1e-12)
//! (where y_i = 0: 1e-12 of its size soon after)
//! errors of the integration grow as d does: six digits are lost where d reaches 1e-12 (1e-6/e), e = 1e-15 or its tolerance
//! ```
//!
//! For a chaotic motion this time is short: `d` grows like `exp(lambda t)` with the largest
//! exponent of Lyapunov (G. Benettin, L. Galgani, J.-M. Strelcyn, *Phys. Rev. A* 14 (1976) 2338,
//! who follow two motions side by side):
//!
//! ```text
//! lambda = <ln(d(t_k + tau)/d_0)>/tau        z begins anew at every t_k, at the distance d_0 in the direction that it had
//! ```
//!
//! Impacts and friction are passed by both motions, so that no derivative across them is needed. The
//! standard error is that of the means of ten parts of the motion.

use super::{ACCOUNTS, Trajectory};
use crate::system::PathEnd;

/// The relative displacement of the start: larger than rounding, and so small that differences grow
/// linearly.
pub const DISPLACEMENT: f64 = 1e-12;

/// Least relative error of the integration.
const ROUNDING: f64 = 1e-15;

/// One in so many parts of the motion, whose size is the scale for the displacement of states that
/// begin at zero.
const BEGINNING: u32 = 100;

/// The relative error at which the sixth digit is lost.
const SIX_DIGITS: f64 = 1e-6;

/// The largest Lyapunov exponent of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LyapunovExponent {
    /// The exponent, per unit of time: positive where motions nearby part from each other.
    pub value: f64,
    /// Its standard error.
    pub error: f64,
    /// The time from which on the motion counts.
    pub from: f64,
}

impl Trajectory {
    /// The largest Lyapunov exponent, from the second quarter of the motion on, or from the time `after`
    /// of the course. The cost is that of the motion. `None` if it ends early, or if a motion nearby
    /// cannot be followed or falls together with this one.
    ///
    /// ```
    /// # use lindstedt_verify as lindstedt;
    /// use lindstedt::Oscillator;
    /// use lindstedt::trajectory::TrajectoryRequest;
    ///
    /// // Of x'' + c x' + x = 0 it is -c/2.
    /// let mut course = TrajectoryRequest::of_equation(&Oscillator::parse("x'' + 0.2*x' + x = 0")?);
    /// course.begin("x".into(), 1.0)?;
    /// let exponent = course.follow()?.lyapunov_exponent().ok_or("an exponent")?;
    /// assert!((exponent.value + 0.1).abs() < 1e-2);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn lyapunov_exponent(&self) -> Option<LyapunovExponent> {
        const INTERVALS: u32 = 400;
        const PARTS: usize = 10;
        /// Distance at which the second motion begins, relative to the sizes of the states.
        const APART: f64 = 1e-8;
        if !self.is_complete() {
            return None;
        }
        let quarter = 0.25 * self.end();
        let from = if self.course.after > 0.0 { self.course.after } else { quarter };
        let step = (self.end() - from) / f64::from(INTERVALS);
        let impacts = self.walls.impacts.iter().map(|hit| hit.time);
        let events = self.events.occurrences.iter().map(|event| event.time);
        let jumps: Vec<f64> = impacts.chain(events).collect();
        // No instant is at a jump, where one of the two motions is before it and the other behind.
        let times: Vec<f64> = (0..=INTERVALS)
            .map(|index| {
                let time = from + step * f64::from(index);
                let is_near = |jump: f64| (jump - time).abs() < 1e-3 * step;
                if jumps.iter().copied().any(is_near) { time + 2e-3 * step } else { time }
            })
            .collect();
        let last = times.len() - 1;
        let time = |index: u32| times[(index as usize).min(last)].min(self.end());
        let reference: Vec<Vec<f64>> =
            (0..=INTERVALS).map(|index| self.states_at(time(index))).collect::<Option<_>>()?;
        let count = self.course.rates.states.len();
        let mut sizes = vec![0.0_f64; count];
        for state in &reference {
            for (size, value) in sizes.iter_mut().zip(state) {
                *size = size.max(value.abs());
            }
        }
        let prepared = self.course.clone().prepared(self.integrator).ok()?;
        let mut away: Vec<f64> = sizes.iter().map(|size| APART * size).collect();
        let mut growths = Vec::new();
        for (index, pair) in reference.windows(2).enumerate() {
            let [begin, end] = pair else { continue };
            let [now, then] = [index as u32, index as u32 + 1].map(time);
            let displaced = |sign: f64| {
                let start = begin.iter().zip(&away).map(|(value, away)| value + sign * away);
                let motion = prepared.follow([now, then], &start.collect::<Vec<f64>>()).ok()?;
                (motion.reason == PathEnd::Reached).then_some((motion.state, sign))
            };
            // A start behind a wall is mirrored.
            let (state, sign) = displaced(1.0).or_else(|| displaced(-1.0))?;
            let apart: Vec<f64> =
                state.iter().zip(end).map(|(one, other)| sign * (one - other)).collect();
            let size = |apart: &[f64]| {
                let parts = apart.iter().zip(&sizes).filter(|(_, size)| **size > 0.0);
                parts.map(|(apart, size)| (apart / size).powi(2)).sum::<f64>().sqrt()
            };
            let (before, after) = (size(&away), size(&apart));
            if !(after > 0.0 && after.is_finite()) {
                return None;
            }
            growths.push((after / before).ln() / (then - now));
            away = apart.iter().map(|apart| apart * (APART / after)).collect();
        }
        // The first part turns the displacement into the direction that grows.
        let means: Vec<f64> = growths
            .chunks(growths.len().div_ceil(PARTS + 1))
            .skip(1)
            .map(|part| part.iter().sum::<f64>() / part.len() as f64)
            .collect();
        let number = means.len() as f64;
        let value = means.iter().sum::<f64>() / number;
        let square: f64 = means.iter().map(|mean| (mean - value).powi(2)).sum();
        let error = (square / (number * (number - 1.0))).sqrt();
        (value.is_finite() && error.is_finite()).then_some(LyapunovExponent { value, error, from })
    }

    /// The time until which the states are known to six digits of their sizes, among two thousand
    /// instants of the motion; later, a start with the relative displacement [`DISPLACEMENT`] leads
    /// elsewhere. `None` if they are known to the end. The cost is that of the motion.
    ///
    /// ```
    /// # use lindstedt_verify as lindstedt;
    /// use lindstedt::Oscillator;
    /// use lindstedt::trajectory::TrajectoryRequest;
    ///
    /// let mut course = TrajectoryRequest::of_equation(&Oscillator::parse("x'' + 0.25*x' - x + x^3 - 0.3*cos(t)")?);
    /// course.begin("x".into(), 1.0)?;
    /// course.duration = 400.0;
    /// let known = course.clone().follow()?.known_until().ok_or("a chaotic motion")?;
    /// assert!(known > 50.0 && known < 300.0);
    /// course.duration = 0.9 * known;
    /// assert_eq!(course.follow()?.known_until(), None);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn known_until(&self) -> Option<f64> {
        if self.reason == PathEnd::Interrupted {
            return None;
        }
        let time = |end: f64, index: u32| end * f64::from(index) / f64::from(ACCOUNTS);
        let sizes = |count: u32| {
            let mut sizes = vec![0.0_f64; self.course.rates.states.len()];
            for state in (0..=count).filter_map(|index| self.states_at(time(self.end(), index))) {
                for (size, value) in sizes.iter_mut().zip(&state) {
                    *size = size.max(value.abs());
                }
            }
            sizes
        };
        let mut displaced = self.course.clone();
        displaced.section = None;
        for (value, size) in displaced.start.iter_mut().zip(sizes(ACCOUNTS / BEGINNING)) {
            *value += DISPLACEMENT * if *value == 0.0 { size } else { *value };
        }
        let displaced = displaced.follow_by(self.integrator).ok()?;
        // Of a start that is not followed nothing is known.
        if displaced.reason == PathEnd::PassesWall {
            return None;
        }
        let lost = DISPLACEMENT * SIX_DIGITS / self.course.tolerance.max(ROUNDING);
        let end = self.end().min(displaced.end());
        let sizes = sizes(ACCOUNTS);
        let (mut known, mut doubtful) = (0.0, false);
        for time in (0..=ACCOUNTS).map(|index| time(end, index)) {
            let (one, other) = (self.states_at(time)?, displaced.states_at(time)?);
            let apart = one.iter().zip(&other).map(|(one, other)| (one - other).abs());
            let is_lost = apart.zip(&sizes).any(|(apart, size)| apart > lost * size);
            // A single instant may lie between two jumps of the force, so that two in a row are
            // required.
            match (is_lost, doubtful) {
                (true, true) => return Some(known),
                (true, false) => doubtful = true,
                (false, _) => (known, doubtful) = (time, false),
            }
        }
        doubtful.then_some(known)
    }
}
