//! The effect of an arctangent in place of Coulomb's sgn on a pendulum: the laws at single speeds,
//! and the swing near rest.
//!
//! In: a [`FrictionSetup`]: how strong the friction is, and where the swing is released. Out: a
//! [`FrictionStudy`]:
//!
//! - `laws`: the arctangent beside sgn, speed by speed.
//! - `near_rest`: where Coulomb's law stops the swing, and how the arctangent creeps on.
//!
//! ```text
//! x'' + alpha sgn(x') + sin x = 0              it stops for good where it turns back with |sin x| <= alpha
//! x'' + alpha (2/pi) atan(100 x') + sin x = 0  it never stops
//! ```

mod laws;
mod near_rest;

use thiserror::Error;

pub use laws::{SpeedRow, arctangent, arctangent_error};
pub use near_rest::{Creep, CreepSample, FirstCycle, NearRest, RestTimes, slow_rate, work_share};

use super::model::DEFAULT_AMPLITUDE;
use super::simulate::SimulationError;
use crate::decimal::decimal;

/// The friction and the swing to be studied.
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionSetup {
    /// The friction alpha, between 0 and 1: dimensionless, the torque in units of m g L.
    pub alpha: f64,
    /// The release, from rest at x = -A, rad: positive and below pi.
    pub amplitude: f64,
    /// Speeds at which the two laws are compared, units of omega.
    pub speeds: Vec<f64>,
}

/// The default friction: it stops the default swing after fifteen half swings.
pub const DEFAULT_ALPHA: f64 = 0.05;

impl Default for FrictionSetup {
    /// The default swing, at [`DEFAULT_ALPHA`].
    fn default() -> Self {
        Self { alpha: DEFAULT_ALPHA, amplitude: DEFAULT_AMPLITUDE, speeds: Vec::new() }
    }
}

/// The reason why a friction cannot be studied.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum FrictionError {
    /// A friction that is not positive, or that holds the pendulum everywhere.
    #[error(
        "alpha must lie above 0 and below 1, not {0}: at 1 friction holds the pendulum wherever it is"
    )]
    Alpha(f64),
    /// A release outside its range.
    #[error(
        "the amplitude must lie above 0 and below pi, not {0}: the pendulum is released from rest at x = -A"
    )]
    Amplitude(f64),
    /// A speed that is not a number.
    #[error("a speed must be a finite number, not {0}")]
    Speed(f64),
    /// A release that is held.
    #[error(
        "alpha = {} holds the pendulum where it is released, at x = -{}: sin A must be above alpha",
        decimal(*alpha),
        decimal(*amplitude)
    )]
    Held {
        /// The friction.
        alpha: f64,
        /// The release, rad.
        amplitude: f64,
    },
    /// A friction so weak that the swing is not followed to its end.
    #[error("alpha = {} takes more steps to stop the swing than a run may have: give a larger one", decimal(*.0))]
    Restless(f64),
    /// A motion that cannot begin.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
}

/// The arctangent beside Coulomb's law.
#[derive(Debug, Clone)]
pub struct FrictionStudy {
    /// The question.
    pub setup: FrictionSetup,
    /// The two laws at the speeds of the setup.
    pub rows: Vec<SpeedRow>,
    /// The swing by both laws, to rest.
    pub near_rest: NearRest,
}

/// The arctangent beside Coulomb's law, at single speeds and in a swing.
///
/// # Errors
/// [`FrictionError`] names the number that is not admissible.
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::friction::{FrictionSetup, study};
///
/// let study = study(FrictionSetup::default())?;
/// let stop = study.near_rest.stop;
/// assert!(stop.x.sin().abs() <= 0.05);
/// assert!(study.near_rest.creep.rate.is_some_and(|rate| rate > 0.3)); // per unit of time
/// # Ok::<(), lindstedt::impact::friction::FrictionError>(())
/// ```
pub fn study(setup: FrictionSetup) -> Result<FrictionStudy, FrictionError> {
    let FrictionSetup { alpha, amplitude, ref speeds } = setup;
    if !(alpha > 0.0 && alpha < 1.0) {
        return Err(FrictionError::Alpha(alpha));
    }
    if !(amplitude > 0.0 && amplitude < std::f64::consts::PI) {
        return Err(FrictionError::Amplitude(amplitude));
    }
    if amplitude.sin() <= alpha {
        return Err(FrictionError::Held { alpha, amplitude });
    }
    if let Some(speed) = speeds.iter().find(|speed| !speed.is_finite()) {
        return Err(FrictionError::Speed(*speed));
    }
    Ok(FrictionStudy {
        rows: speeds.iter().copied().map(SpeedRow::new).collect(),
        near_rest: near_rest::near_rest(alpha, amplitude)?,
        setup,
    })
}
