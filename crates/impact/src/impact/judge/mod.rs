//! Verification: the original equations by Runge-Kutta, one smooth right side at a time.
//!
//! In: the forces as they stand in the equation. Out: one undamped impact from release to return,
//! its digits assured (`single`), or a whole motion of equation (7), event by event (`events`).
//! Both follow the same two right sides, with z counted from an origin in the direction s, the
//! release or the place of a barrier:
//!
//! ```text
//! flight    z'' = s a(t, x, x')               x = origin + s z,  a: the acceleration by all but the barrier
//! contact   d'' = s a(t, x, x') - F(d, d')    d the depth: a shallow one keeps its digits
//! ```
//!
//! There are two drivers: a single impact counts its contact from the touch, in time as well, so
//! that the hardest barrier costs no digits, and mirrors the approach; a whole motion needs one
//! clock. Neither the closed form nor the Taylor series is used: no frequency law, no line, no
//! regularised variable.

mod events;
mod single;

pub(super) use events::follow;
pub(super) use single::way_forward;
pub use single::{Deviation, TrueImpact, assured_impact, deviation, true_impact};

/// A coordinate z in which a motion is followed: x = origin + sign z.
#[derive(Debug, Clone, Copy)]
struct Coordinate {
    sign: f64,
    origin: f64,
}

impl Coordinate {
    fn x(self, value: f64) -> f64 {
        self.origin + self.sign * value
    }

    /// z'' in free flight, where `swing` gives x'' from t, x and x'.
    fn flight(self, swing: impl Fn(f64, f64, f64) -> f64) -> impl Fn(f64, f64, f64) -> f64 {
        move |t, value, rate| self.sign * swing(t, self.x(value), self.sign * rate)
    }

    /// d'' inside a barrier that pushes back with `press`, from depth and speed inwards.
    fn contact(
        self,
        swing: impl Fn(f64, f64, f64) -> f64,
        press: impl Fn(f64, f64) -> f64,
    ) -> impl Fn(f64, f64, f64) -> f64 {
        let flight = self.flight(swing);
        move |t, depth, speed| flight(t, depth, speed) - press(depth, speed)
    }
}
