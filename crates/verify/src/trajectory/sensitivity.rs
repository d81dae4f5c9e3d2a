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
//! who follow two motions side by side).

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

impl Trajectory {
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
