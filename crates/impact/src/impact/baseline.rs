//! The benefit of a barrier: the rest time compared with those without a barrier and with a
//! lossless one.
//!
//! A barrier that loses nothing already shortens the rest, because the swing becomes shorter and
//! faster: under light viscous damping the action, the area S of the orbit in the phase plane,
//! falls as exp(-2 zeta t) whatever the orbit, and a swing cut at the barrier starts with less of
//! it. The rest of a gain is due to the loss in contact. With A the first amplitude and a = A/10,
//!
//! ```text
//! S(A) = 2 int_-A^A x' dx        = 16 (E(m) - (1 - m) K(m)),  m = sin^2(A/2)      without a barrier
//! S_c(A) = 2 int_-A^x_c x' dx                                                     cut at the barrier
//! t = ln(S(A)/S(a))/(2 zeta),    t_c = ln(S_c(A)/S_c(a))/(2 zeta)
//! t - t_c = ln(S(A) S_c(a)/(S_c(A) S(a)))/(2 zeta)                                the gain by geometry alone
//! ```
//!
//! In: a motion that was followed. Out: a [`Baseline`], two more motions from the same start, and
//! the ratio of the actions.

use std::f64::consts::PI;

use super::chain::actions;
use super::model::Model;
use super::simulate::{SimulationError, simulate};
use super::simulation::{NoRest, REST_FRACTION, Settings, Simulation};

/// Rest times of the same swing, in units of 1/omega.
#[derive(Clone, Debug, PartialEq)]
pub struct Baseline {
    /// Without a barrier.
    pub no_barrier: Result<f64, NoRest>,
    /// With the same barrier, elastic: mu = 0.
    pub lossless_barrier: Result<f64, NoRest>,
    /// The difference as predicted by the actions; `None` with dry friction, if the first swing
    /// turns over, if a barrier holds the pendulum above the bottom, or if two barriers hold it
    /// within a tenth of the amplitude.
    pub geometry: Option<Geometry>,
}

/// By how much sooner a swing cut at the barrier rests under viscous damping:
/// ln(first_swing/at_rest)/(2 zeta).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Geometry {
    /// The action of the first swing without a barrier over that of the swing cut at it.
    pub first_swing: f64,
    /// The same at a tenth of the amplitude; 1 where the barrier is out of reach.
    pub at_rest: f64,
    /// The gain, in units of time.
    pub gain: f64,
}

impl Geometry {
    /// The prediction by the actions of a swing of this amplitude, rad, about the bottom between
    /// the barriers of the model; `None` if the formula does not apply.
    fn from_actions(model: &Model, amplitude: f64) -> Option<Self> {
        let caged = model.is_caged(0.0, REST_FRACTION * amplitude);
        if model.zeta == 0.0 || model.alpha != 0.0 || amplitude >= PI || caged {
            return None;
        }
        let ratio = |amplitude: f64| {
            let (whole, cut) = actions(model, amplitude);
            whole / cut
        };
        let (first_swing, at_rest) = (ratio(amplitude), ratio(REST_FRACTION * amplitude));
        let gain = (first_swing / at_rest).ln() / (2.0 * model.zeta);
        Some(Self { first_swing, at_rest, gain }).filter(|geometry| geometry.gain.is_finite())
    }
}

/// Duration of the comparison runs in units of that of the motion itself, because they rest later.
pub const BASELINE_DURATIONS: f64 = 4.0;

/// The rest times with which that of this motion is compared; `None` if there is nothing to
/// compare: no impact, no damping of the swing, or a moving pivot.
///
/// # Errors
/// As [`simulate`].
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::{Integrator, Model, Settings, Start, baseline, simulate};
///
/// let model = Model { zeta: 0.02, mu: 1e6, gamma: 1e7, ..Model::default() };
/// let settings = Settings { duration: 150.0, ..Settings::default() };
/// let motion = simulate(&model, Start::default(), Integrator::Taylor, &settings)?;
/// let others = baseline(&motion)?.ok_or("it hits and is damped")?;
/// let (none, lossless, this) = (others.no_barrier?, others.lossless_barrier?, motion.rest().time?);
/// assert!(this < lossless && lossless < none);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn baseline(motion: &Simulation) -> Result<Option<Baseline>, SimulationError> {
    let model = motion.model;
    let damped = model.zeta > 0.0 || model.alpha > 0.0;
    if motion.impacts.is_empty()
        || !damped
        || model.beta != 0.0
        || motion.model.depth(motion.start.x).is_some()
    {
        return Ok(None);
    }
    let settings = Settings {
        duration: BASELINE_DURATIONS * motion.settings.duration,
        keep_path: false,
        ..motion.settings
    };
    let rest = |model: Model| {
        let followed = simulate(&model, motion.start, motion.integrator, &settings)?;
        Ok::<_, SimulationError>(followed.rest().time)
    };
    Ok(Some(Baseline {
        // The formula counts amplitudes from the bottom.
        geometry: Some(motion.rest())
            .filter(|rest| rest.place == 0.0)
            .and_then(|rest| Geometry::from_actions(&model, rest.amplitude)),
        no_barrier: rest(Model { left: None, right: None, ..model })?,
        lossless_barrier: match model.mu == 0.0 {
            true => motion.rest().time,
            false => rest(Model { mu: 0.0, ..model })?,
        },
    }))
}
