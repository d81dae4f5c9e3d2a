//! The pendulum that meets an elastic barrier.
//!
//! x'' + f(x) + gamma F(x - x_c) H(x - x_c) = 0, released at rest from x = -A towards the barrier at x_c: with
//! f = sin x and F = depth^(3/2) the paper's equation (9). In: amplitude, barrier, stiffness, the law omega^2 of the
//! free swing. Out: the motion in three closed forms, and the true motion beside it.
//!
//! - [`hertz`]: the contact alone: depth, duration, and gamma from mass, radius, length and modulus, equation (8).
//! - [`Rule`] and [`fit`]: the straight line that replaces F while in contact, equation (15).
//! - [`three_phases`]: approach | contact | return in closed form, equations (13) to (16).
//! - [`true_motion()`]: the Runge-Kutta judge of the original equation, and the deviation from it.
//!
//! ```
//! use lindstedt::contact::hertz::{Design, elastic_force};
//! use lindstedt::contact::Rule;
//! use lindstedt::contact::{Column, Swing, three_phases};
//!
//! let swing = Swing {
//!     amplitude: 1.5,
//!     barrier: 0.323,
//!     stiffness: Design::default().stiffness()?,
//!     frequency_squared: 1.0 - 1.5 * 1.5 / 8.0,
//!     linear_stiffness: 1.0,
//!     restoring_force: &|x| x.sin(),
//!     elastic_force: &elastic_force,
//!     rule: Rule::LeastSquares,
//! };
//! let motion = three_phases(&swing, Column::Paper)?;
//! assert_eq!(motion.phases[0].closed_form(), "x(t) = -1.5 cos(0.847791 t)");
//! assert!((motion.speed - 1.24185).abs() < 1e-5);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod hertz;
pub(crate) mod linearisation;
pub(crate) mod phases;
pub(crate) mod true_motion;

pub use linearisation::{Line, LinearisationError, Rule, UnknownRule, fit};
pub use phases::{Column, Form, Phase, PhasesError, Swing, ThreePhases, three_phases};
pub use true_motion::{Deviation, TrueMotion, TrueMotionError, assured_motion, deviation, true_motion};
