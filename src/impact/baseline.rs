//! What a barrier is good for: the rest time beside that without a barrier and with one that loses nothing.
//!
//! A barrier that loses nothing already shortens the rest, because the swing becomes shorter and faster: under light viscous
//! damping the action J = (1/2 pi) times the area of the orbit in the phase plane falls as exp(-2 zeta t) whatever the orbit, and a
//! swing cut at the barrier starts with less of it. What is left of a gain is the loss in contact.
//!
//! In: a motion that was followed. Out: a [`Baseline`], two more motions from the same start.

use super::model::Model;
use super::simulate::{SimulationError, simulate};
use super::simulation::{NoRest, Settings, Simulation};

/// Rest times of the same swing, in units of 1/omega.
#[derive(Clone, Debug, PartialEq)]
pub struct Baseline {
    /// Without a barrier.
    pub no_barrier: Result<f64, NoRest>,
    /// With the same barrier, elastic: mu = 0.
    pub lossless_barrier: Result<f64, NoRest>,
}

/// So many times the duration of the run are the others followed for: they rest later.
const LONGER: f64 = 4.0;

/// The rest times beside that of this motion; `None` where there is nothing to compare: no impact, nothing that damps the swing, or a
/// pivot that moves.
///
/// # Errors
/// As [`simulate`].
///
/// ```
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
    if motion.impacts.is_empty() || !damped || model.beta != 0.0 || motion.model.depth(motion.start.x).is_some() {
        return Ok(None);
    }
    let settings = Settings {
        duration: LONGER * motion.settings.duration,
        keep_path: false,
        ..motion.settings
    };
    let rest = |model: Model| {
        let followed = simulate(&model, motion.start, motion.integrator, &settings)?;
        Ok::<_, SimulationError>(followed.rest().time)
    };
    Ok(Some(Baseline {
        no_barrier: rest(Model {
            left: None,
            right: None,
            ..model
        })?,
        lossless_barrier: match model.mu == 0.0 {
            true => motion.rest().time,
            false => rest(Model { mu: 0.0, ..model })?,
        },
    }))
}
