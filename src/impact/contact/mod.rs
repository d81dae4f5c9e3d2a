//! Laws of one contact, all of one shape: how deep, how long, how hard, and where at any instant.
//!
//! ```text
//! d'' + a + k d + gamma F(d) = 0,   d(0) = 0, d'(0) = v > 0,   until d = 0 again
//! a = f(x_c), k = f'(x_c)           what else acts at the barrier: force at touch (the preload), and its slope
//! F(d) = d^n                        n = 3/2 for Hertz, 1 for a spring, 2 for a cone
//! ```
//!
//! In: gamma, v, the exponent or the force as a closure, a and k. Out: depth D, duration T, peak force, the motion. Each file uses
//! only those above it:
//!
//! - [`power_law`]: a = k = 0, by Gamma and incomplete beta functions; a and k as corrections in powers of them.
//! - `time`: the time along a motion whose speed is known at every place, and back.
//! - [`exact`]: any force as a closure, by energy and quadrature; the motion as a short series of sines.
//! - [`hunt_crossley`]: a contact that loses energy, gamma d^n (1 + lambda d'): restitution, loop of force and depth, duration.
//! - [`law`]: all laws by name, the fitted lines, perturbation and balances among them, beside the exact one: [`comparison`].
//!
//! Depths are in the unit of x, rad for the pendulum, times in units of 1/omega, forces per unit of mass: accelerations, rad omega^2.

use thiserror::Error;

use super::hertz::NotPositive;
use super::linearisation::LinearisationError;
use crate::numeric::ode::quadrature::QuadratureError;
use crate::numeric::ode::root::RootError;

pub mod exact;
pub mod hunt_crossley;
pub mod law;
pub mod power_law;
mod time;

pub use exact::{ExactContact, SineSeries};
pub use hunt_crossley::HuntCrossley;
pub use law::{ContactErrors, ContactLaw, ContactMotion, ContactRow, Touch, UnknownContactLaw, comparison};
pub use power_law::{CorrectedPowerLaw, PowerLaw};

/// Why there is no contact to speak of.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum ContactError {
    /// A quantity outside its domain.
    #[error(transparent)]
    NotPositive(#[from] NotPositive),
    /// A quantity that is no number.
    #[error("the {quantity} must be a finite number, not {value}")]
    NotFinite {
        /// What it is.
        quantity: &'static str,
        /// The value given.
        value: f64,
    },
    /// A result that double precision does not hold.
    #[error(
        "the {quantity} of this contact is beyond the range of double precision: measure length and time in units nearer to it"
    )]
    Range {
        /// What it is.
        quantity: &'static str,
    },
    /// A restitution outside its range.
    #[error("the coefficient of restitution must lie above 0 and be at most 1, not {0}: 1 is a contact without loss")]
    Restitution(f64),
    /// A damping below zero.
    #[error("the {quantity} must be a number and not negative, not {value}: 0 is a contact without loss")]
    Negative {
        /// What it is.
        quantity: &'static str,
        /// The value given.
        value: f64,
    },
    /// A correction of more terms than are worth their rounding, or of none.
    #[error(
        "the correction has 1 to {highest} orders, not {order}: from there on the exact contact is the better answer"
    )]
    Order {
        /// The order asked for.
        order: u32,
        /// The highest there is.
        highest: u32,
    },
    /// What acts besides the contact is no small correction to it.
    #[error(
        "the force at touch and its slope are no small correction: the last terms of the series are {depth_error:.1e} of the depth \
         and {duration_error:.1e} of the duration; take the exact contact"
    )]
    NoCorrection {
        /// The last terms of the depth, relative.
        depth_error: f64,
        /// The last terms of the duration, relative.
        duration_error: f64,
    },
    /// The force does not turn the motion back.
    #[error(
        "the force in contact does not turn the motion back, searched to depth {searched:.2e}: it must be finite and push back \
         hard enough on the way"
    )]
    NeverTurns {
        /// How deep the search went.
        searched: f64,
    },
    /// The force has corners, jumps or waves on the way.
    #[error("the force in contact is not smooth enough for its motion to be computed: integrate it step by step")]
    NotSmooth,
    /// A law of a power of the depth, asked about another force.
    #[error(
        "the force of this contact is not given as a power of the depth: give its exponent, or take the exact contact"
    )]
    NoPowerLaw,
    /// The perturbation or the balance has no oscillation at this speed.
    #[error(
        "no oscillation of this form begins with that speed: what acts beside the contact is too strong; take the exact contact"
    )]
    NotOscillating,
    /// No line for the force.
    #[error(transparent)]
    Linearisation(#[from] LinearisationError),
    /// An integral over the force failed.
    #[error("the force in contact cannot be integrated: {0}")]
    Quadrature(#[from] QuadratureError),
    /// The force has no finite value somewhere.
    #[error("the force in contact has no turning point: {0}")]
    Root(#[from] RootError),
}

/// The value, if it is a number.
fn finite(quantity: &'static str, value: f64) -> Result<f64, ContactError> {
    match value.is_finite() {
        true => Ok(value),
        false => Err(ContactError::NotFinite { quantity, value }),
    }
}

/// The result, if double precision holds it with all its digits.
fn in_range(quantity: &'static str, value: f64) -> Result<f64, ContactError> {
    match value.is_normal() && value > 0.0 {
        true => Ok(value),
        false => Err(ContactError::Range { quantity }),
    }
}

/// A time of the contact: before it the touch, which is that of no number too, after it the release.
fn within(time: f64, duration: f64) -> f64 {
    if time > 0.0 { time.min(duration) } else { 0.0 }
}
