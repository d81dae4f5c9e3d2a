//! Until when the digits of a motion are those of its start.
//!
//! ```text
//! d(t) = max_i |y_i(t) - z_i(t)|/Y_i,  Y_i = max |y_i|        z: the same from a start with y_i (1 + 1e-12)
//! errors of the integration grow as d does: six digits are lost where d reaches 1e-12 (1e-6/e), e = 1e-15 or its tolerance
//! ```
//!
//! Of a chaotic motion that is soon: `d` grows like `exp(lambda t)` with the largest exponent of Lyapunov (G. Benettin, L. Galgani, J.-M. Strelcyn,
//! *Phys. Rev. A* 14 (1976) 2338, who follow two motions side by side).

use super::{ACCOUNTS, Trajectory};
use crate::system::End;

/// The part of a state by which its start is displaced: more than rounding, and so little that differences grow in proportion.
pub const DISPLACEMENT: f64 = 1e-12;

/// What the errors of the integration begin with, at least.
const ROUNDING: f64 = 1e-15;

/// What is lost when the sixth digit is.
const SIX_DIGITS: f64 = 1e-6;

impl Trajectory {
    /// The time from which on its states are not known to six digits, for a start displaced by [`DISPLACEMENT`] of it leads elsewhere; `None`
    /// where they are known to the end. Costs as much as the motion.
    ///
    /// ```
    /// use lindstedt::Oscillator;
    /// use lindstedt::trajectory::Course;
    ///
    /// let mut course = Course::of_equation(&Oscillator::parse("x'' + 0.25*x' - x + x^3 - 0.3*cos(t)")?);
    /// course.begin("x".into(), 1.0)?;
    /// course.duration = 400.0;
    /// let known = course.clone().follow()?.known_until().ok_or("a chaotic motion")?;
    /// assert!(known > 50.0 && known < 300.0);
    /// course.duration = 0.9 * known;
    /// assert_eq!(course.follow()?.known_until(), None);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn known_until(&self) -> Option<f64> {
        if self.reason == End::Interrupted {
            return None;
        }
        let mut displaced = self.course.clone();
        displaced.section = None;
        for value in &mut displaced.start {
            *value *= 1.0 + DISPLACEMENT;
        }
        let displaced = displaced.follow_by(self.integrator).ok()?;
        let lost = DISPLACEMENT * SIX_DIGITS / self.course.tolerance.max(ROUNDING);
        let end = self.end().min(displaced.end());
        let times = (0..=ACCOUNTS).map(|index| end * f64::from(index) / f64::from(ACCOUNTS));
        let mut sizes = vec![0.0_f64; self.course.rates.states.len()];
        for state in times.clone().filter_map(|time| self.at(time)) {
            for (size, value) in sizes.iter_mut().zip(&state) {
                *size = size.max(value.abs());
            }
        }
        let mut since = None;
        for time in times {
            let (one, other) = (self.at(time)?, displaced.at(time)?);
            let apart = one.iter().zip(&other).map(|(one, other)| (one - other).abs());
            let is_lost = apart.zip(&sizes).any(|(apart, size)| apart > lost * size);
            // One moment alone may lie between two jumps of one force.
            match (is_lost, since) {
                (true, Some(since)) => return Some(since),
                (true, None) => since = Some(time),
                (false, _) => since = None,
            }
        }
        since
    }
}
