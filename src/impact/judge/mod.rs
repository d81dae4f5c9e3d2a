//! The judge: the original equations by Runge-Kutta, one smooth right side at a time.
//!
//! In: the forces as they stand in the equation. Out: one undamped impact from release to return, its digits assured
//! (`single`), or a whole motion of equation (7), event by event (`events`). Nothing of the closed form and nothing of the
//! Taylor series enters: no frequency law, no line, no regularised variable.

mod events;
mod single;

pub(super) use events::follow;
pub use single::{Deviation, TrueMotion, TrueMotionError, assured_motion, deviation, true_motion};
