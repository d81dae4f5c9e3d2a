//! Many motions on all cores, for any number of parameters with their values, and a summary of
//! each.
//!
//! In: motions, in the order of their numbers, such as those of the grid of some [`Axis`]. Out: a
//! [`Summary`] each, in that order. Every motion is computed by the same operations on any thread,
//! so that the result does not depend on the number of threads.
//!
//! ```
//! # use lindstedt_impact as lindstedt;
//! use lindstedt::impact::{Integrator, Model, Settings, Start, sweep::{Axis, sweep}};
//!
//! let axis: Axis = "gamma=1e4:1e6:3:log".parse()?;
//! assert_eq!(axis.values(), [1e4, 1e5, 1e6]);
//! let start = Start { x: -1.5, velocity: 0.0 };
//! let motions: Vec<_> = axis.values().iter().map(|&gamma| (Model { gamma, ..Model::default() }, start)).collect();
//! let found = sweep(&motions, Integrator::Taylor, &Settings::default(), |_| ()).map_err(|(_, error)| error)?;
//! assert!(found[0].deepest > found[2].deepest);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod axis;

use thiserror::Error;

pub use axis::{Axis, AxisError, Spacing};

use super::model::{Model, Start};
use super::simulate::{SimulationError, simulate_many};
use super::simulation::{ContactRecord, Integrator, NoRest, Settings, Simulation, SimulationStop};
use crate::parallel::par_map;

/// The most motions of one sweep.
pub const MOST_MOTIONS: usize = 1_000_000;

/// Number of motions that one thread follows together.
const CHUNK: usize = 96;

/// More motions than a sweep may have.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "the sweep has {counts} = {product} motions, more than {MOST_MOTIONS} motions: lower the counts"
)]
pub struct TooManyRuns {
    /// The numbers of values, `2000 * 2000`.
    pub counts: String,
    /// Their product.
    pub product: String,
}

/// The number of motions of a grid: the product of the numbers of values.
///
/// # Errors
/// [`TooManyRuns`], beyond [`MOST_MOTIONS`].
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::sweep::grid_size;
///
/// let axes = ["zeta=0:1:2".parse()?, "mu=5,6,8".parse()?, "gamma=1e4:1e9:1000:log".parse()?];
/// assert_eq!(grid_size(&axes), Ok(6000));
/// # Ok::<(), lindstedt::impact::sweep::AxisError>(())
/// ```
pub fn grid_size(axes: &[Axis]) -> Result<usize, TooManyRuns> {
    let counts = axes.iter().map(|axis| axis.values().len());
    let product = counts.clone().try_fold(1_usize, usize::checked_mul);
    product.filter(|product| *product <= MOST_MOTIONS).ok_or_else(|| {
        let counts: Vec<String> = counts.clone().map(|count| count.to_string()).collect();
        let product = match product {
            Some(product) => product.to_string(),
            None => format!(
                "{:.2e}",
                axes.iter().map(|axis| axis.values().len() as f64).product::<f64>()
            ),
        };
        TooManyRuns { counts: counts.join(" * "), product }
    })
}

/// The values of the parameters in the motion of this number, where the last axis varies fastest.
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::sweep::grid_values;
///
/// let axes = ["zeta=0:1:2".parse()?, "mu=5:7:3".parse()?];
/// assert_eq!(grid_values(&axes, 4), [1.0, 6.0]);
/// # Ok::<(), lindstedt::impact::sweep::AxisError>(())
/// ```
pub fn grid_values(axes: &[Axis], number: usize) -> Vec<f64> {
    let mut rest = number;
    let value = |axis: &Axis| {
        let count = axis.values().len();
        let index = rest % count;
        rest /= count;
        axis.values()[index]
    };
    let mut values: Vec<f64> = axes.iter().rev().map(value).collect();
    values.reverse();
    values
}

/// The summary of one motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// Number of contacts.
    pub impacts: usize,
    /// The time at which the envelope fell to a tenth of the first swing, in units of 1/omega; or
    /// the reason why it did not.
    pub rest_time: Result<f64, NoRest>,
    /// The rest times of the same swing without a barrier and with a lossless one, if requested.
    pub baseline: Option<[Result<f64, NoRest>; 2]>,
    /// The greatest depth in a barrier, rad; 0 without contact.
    pub deepest: f64,
    /// The greatest speed at a touch, rad times omega; 0 without contact.
    pub fastest: f64,
    /// Energy lost in contacts, units of m g L.
    pub energy_lost: f64,
    /// Time at the end, in units of 1/omega.
    pub end_time: f64,
    /// Displacement there, rad.
    pub end_x: f64,
    /// Velocity there, rad times omega.
    pub end_velocity: f64,
    /// The reason why it ended.
    pub stop: SimulationStop,
}

impl Summary {
    /// Whether the motion had begun before the interrupt.
    pub fn is_begun(&self) -> bool {
        !matches!(self.stop, SimulationStop::Interrupted { t } if t == 0.0)
    }

    /// Summarises a motion.
    pub fn from_motion(motion: &Simulation) -> Self {
        let largest =
            |value: fn(&ContactRecord) -> f64| motion.impacts.iter().map(value).fold(0.0, f64::max);
        Self {
            impacts: motion.impacts.len(),
            rest_time: motion.rest().time,
            baseline: None,
            deepest: largest(|impact| impact.penetration),
            fastest: largest(|impact| impact.speed_in),
            // An empty sum of floats is minus zero in Rust.
            energy_lost: motion
                .impacts
                .iter()
                .filter_map(|impact| impact.energy_lost)
                .fold(0.0, |sum, lost| sum + lost),
            end_time: motion.end_time,
            end_x: motion.end_x,
            end_velocity: motion.end_velocity,
            stop: motion.stop,
        }
    }
}

/// Follows every motion, on all threads of the current pool (on one without the feature
/// `parallel`); `progress` is called with the number of motions that are newly done.
///
/// # Errors
/// [`SimulationError`] and the number of the first motion that cannot begin.
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::{Integrator, Model, Settings, Start, sweep::{Axis, sweep}};
///
/// let axis: Axis = "zeta=0.01:0.1:4".parse()?;
/// let start = Start { x: -1.5, velocity: 0.0 };
/// let motions: Vec<_> = axis.values().iter().map(|&zeta| (Model { zeta, ..Model::default() }, start)).collect();
/// let rows = sweep(&motions, Integrator::Taylor, &Settings::default(), |_done| {}).map_err(|(_, error)| error)?;
/// assert!(rows[3].impacts < rows[0].impacts);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn sweep(
    motions: &[(Model, Start)],
    integrator: Integrator,
    settings: &Settings,
    progress: impl Fn(usize) + Sync,
) -> Result<Vec<Summary>, (usize, SimulationError)> {
    let settings = Settings { keep_path: false, ..*settings };
    let run = |(chunk, motions): &(usize, &[(Model, Start)])| {
        let found = simulate_many(motions, integrator, &settings)
            .map_err(|(number, error)| (chunk * CHUNK + number, error))?;
        progress(motions.len());
        Ok(found.iter().map(Summary::from_motion).collect::<Vec<_>>())
    };
    let chunks: Vec<_> = motions.chunks(CHUNK).enumerate().collect();
    let mut summaries = Vec::with_capacity(motions.len());
    for part in par_map(&chunks, run) {
        summaries.extend(part?);
    }
    Ok(summaries)
}

/// The sweep on this number of threads.
///
/// # Errors
/// As [`sweep`].
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::{Case, Integrator, Parameter, Settings, sweep::{sweep, sweep_on}};
///
/// let mut case = Case { zeta: 0.05, ..Case::default() };
/// let mut motions = Vec::new();
/// for barrier in [0.1, 0.2, 0.3, 0.4] {
///     case.set(Parameter::Barrier, barrier);
///     motions.push(case.motion()?);
/// }
/// let settings = Settings::default();
/// let alone = sweep_on(1, &motions, Integrator::Taylor, &settings, |_done| {}).map_err(|(_, error)| error)?;
/// assert_eq!(alone, sweep(&motions, Integrator::Taylor, &settings, |_done| {}).map_err(|(_, error)| error)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[cfg(feature = "parallel")]
pub fn sweep_on(
    threads: usize,
    motions: &[(Model, Start)],
    integrator: Integrator,
    settings: &Settings,
    progress: impl Fn(usize) + Sync + Send,
) -> Result<Vec<Summary>, (usize, SimulationError)> {
    crate::parallel::on_threads(threads, || sweep(motions, integrator, settings, progress))
}
