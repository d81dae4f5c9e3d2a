//! Many motions: one or two parameters over a range, all cores, and what an engineer asks of each.
//!
//! In: motions, in the order of their numbers. Out: a [`Summary`] each, in that order. Every motion is followed by the
//! same operations wherever it runs, so the result does not depend on the number of threads.
//!
//! ```
//! use lindstedt::impact::{Model, Settings, Start, sweep::{Axis, sweep}};
//!
//! let axis: Axis = "gamma=1e4:1e6:3".parse()?;
//! assert_eq!(axis.values(), [1e4, 505_000.0, 1e6]);
//! let start = Start { x: -1.5, velocity: 0.0 };
//! let motions: Vec<_> = axis.values().into_iter().map(|gamma| (Model { gamma, ..Model::default() }, start)).collect();
//! let found = sweep(&motions, &Settings::default(), |_| ()).map_err(|(_, error)| error)?;
//! assert!(found[0].deepest > found[2].deepest);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use std::str::FromStr;

#[cfg(feature = "parallel")]
use rayon::prelude::*;
use thiserror::Error;

use super::model::{Model, Start};
use super::simulate::{SimulationError, simulate_many};
use super::simulation::{Contact, NoRest, Settings, Simulation, Stop};

/// The most motions of one sweep.
pub const MOST_MOTIONS: usize = 1_000_000;

/// Motions that one thread follows together.
const CHUNK: usize = 96;

/// A parameter and the values it takes: `NAME=from:to:count`.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// The name of the parameter, such as that of a [`Parameter`](super::Parameter).
    pub name: String,
    /// The first value.
    pub from: f64,
    /// The last value.
    pub to: f64,
    /// How many values, equally spaced, both ends included.
    pub count: usize,
}

/// Why a text names no range.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum AxisError {
    /// Not of the form NAME=from:to:count.
    #[error("`{0}` should be NAME=from:to:count, such as zeta=0.01:0.05:9")]
    Form(String),
    /// An end that is no finite number.
    #[error("`{0}` is no finite number")]
    Number(String),
    /// A count that cannot be.
    #[error("the count `{0}` should be a whole number from 2 to {MOST_MOTIONS}")]
    Count(String),
}

impl FromStr for Axis {
    type Err = AxisError;

    fn from_str(text: &str) -> Result<Self, AxisError> {
        let form = || AxisError::Form(text.to_owned());
        let (name, range) = text.split_once('=').ok_or_else(form)?;
        let parts: Vec<&str> = range.split(':').map(str::trim).collect();
        let [from, to, count] = parts[..] else {
            return Err(form());
        };
        let number = |text: &str| match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(AxisError::Number(text.to_owned())),
        };
        let count_of = |text: &str| match text.parse::<usize>() {
            Ok(value) if (2..=MOST_MOTIONS).contains(&value) => Ok(value),
            _ => Err(AxisError::Count(text.to_owned())),
        };
        if name.trim().is_empty() {
            return Err(form());
        }
        Ok(Self {
            name: name.trim().to_owned(),
            from: number(from)?,
            to: number(to)?,
            count: count_of(count)?,
        })
    }
}

impl Axis {
    /// The value of this number, counted from zero.
    pub fn value(&self, index: usize) -> f64 {
        let last = self.count.saturating_sub(1).max(1);
        match index >= last {
            true => self.to,
            false => self.from + (self.to - self.from) * (index as f64 / last as f64),
        }
    }

    /// The values, in order.
    pub fn values(&self) -> Vec<f64> {
        (0..self.count).map(|index| self.value(index)).collect()
    }
}

/// The values of the parameters in the motion of this number, where the last axis varies fastest.
///
/// ```
/// use lindstedt::impact::sweep::grid_values;
///
/// let axes = ["zeta=0:1:2".parse()?, "mu=5:7:3".parse()?];
/// assert_eq!(grid_values(&axes, 4), [1.0, 6.0]);
/// # Ok::<(), lindstedt::impact::sweep::AxisError>(())
/// ```
pub fn grid_values(axes: &[Axis], number: usize) -> Vec<f64> {
    let mut rest = number;
    let value = |axis: &Axis| {
        let index = rest % axis.count.max(1);
        rest /= axis.count.max(1);
        axis.value(index)
    };
    let mut values: Vec<f64> = axes.iter().rev().map(value).collect();
    values.reverse();
    values
}

/// What came of one motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// Number of contacts.
    pub impacts: usize,
    /// When the envelope fell to a tenth of the first swing, in units of 1/omega; or why it did not.
    pub rest_time: Result<f64, NoRest>,
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
    /// Why it ended.
    pub stop: Stop,
}

impl Summary {
    fn of(motion: &Simulation) -> Self {
        let largest = |value: fn(&Contact) -> f64| motion.impacts.iter().map(value).fold(0.0, f64::max);
        Self {
            impacts: motion.impacts.len(),
            rest_time: motion.rest().time,
            deepest: largest(|impact| impact.penetration),
            fastest: largest(|impact| impact.speed_in),
            // The sum of nothing is minus zero.
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

/// Follows every motion by Taylor series, on all threads of the current pool (on one without the feature `parallel`); `progress` hears how many more are done.
///
/// # Errors
/// [`SimulationError`] and the number of the first motion that cannot begin.
///
/// ```
/// use lindstedt::impact::{Model, Settings, Start, sweep::{Axis, sweep}};
///
/// let axis: Axis = "zeta=0.01:0.1:4".parse()?;
/// let start = Start { x: -1.5, velocity: 0.0 };
/// let motions: Vec<_> = axis.values().into_iter().map(|zeta| (Model { zeta, ..Model::default() }, start)).collect();
/// let rows = sweep(&motions, &Settings::default(), |_done| {}).map_err(|(_, error)| error)?;
/// assert!(rows[3].impacts < rows[0].impacts);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn sweep(
    motions: &[(Model, Start)],
    settings: &Settings,
    progress: impl Fn(usize) + Sync,
) -> Result<Vec<Summary>, (usize, SimulationError)> {
    let settings = Settings {
        keep_path: false,
        ..*settings
    };
    let run = |(chunk, motions): (usize, &[(Model, Start)])| {
        let runs = simulate_many(motions, &settings).map_err(|(number, error)| (chunk * CHUNK + number, error))?;
        progress(motions.len());
        Ok(runs.iter().map(Summary::of).collect::<Vec<Summary>>())
    };
    #[cfg(feature = "parallel")]
    let chunks = motions.par_chunks(CHUNK);
    #[cfg(not(feature = "parallel"))]
    let chunks = motions.chunks(CHUNK);
    let parts: Vec<Result<Vec<Summary>, (usize, SimulationError)>> = chunks.enumerate().map(run).collect();
    let mut summaries = Vec::with_capacity(motions.len());
    for part in parts {
        summaries.extend(part?);
    }
    Ok(summaries)
}

/// The same on so many threads.
///
/// # Errors
/// As [`sweep`].
///
/// ```
/// use lindstedt::impact::{Case, Parameter, Settings, sweep::{sweep, sweep_on}};
///
/// let mut case = Case { zeta: 0.05, ..Case::default() };
/// let mut motions = Vec::new();
/// for barrier in [0.1, 0.2, 0.3, 0.4] {
///     case.set(Parameter::Barrier, barrier);
///     motions.push(case.motion()?);
/// }
/// let settings = Settings::default();
/// let alone = sweep_on(1, &motions, &settings, |_done| {}).map_err(|(_, error)| error)?;
/// assert_eq!(alone, sweep(&motions, &settings, |_done| {}).map_err(|(_, error)| error)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[cfg(feature = "parallel")]
pub fn sweep_on(
    threads: usize,
    motions: &[(Model, Start)],
    settings: &Settings,
    progress: impl Fn(usize) + Sync + Send,
) -> Result<Vec<Summary>, (usize, SimulationError)> {
    match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
        Ok(pool) => pool.install(|| sweep(motions, settings, progress)),
        // Without threads of its own it runs on those there are.
        Err(_) => sweep(motions, settings, progress),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_is_read_and_ends_where_it_says() {
        let axis: Axis = "zeta=0.01:0.07:4".parse().unwrap();
        assert_eq!(axis.values().len(), 4);
        assert_eq!((axis.values()[0], axis.values()[3]), (0.01, 0.07));
        for wrong in [
            "zeta",
            "zeta=1:2",
            "zeta=1:2:3:4",
            "=1:2:3",
            "zeta=a:2:3",
            "zeta=1:inf:3",
            "zeta=1:2:1",
            "zeta=1:2:2.5",
        ] {
            assert!(wrong.parse::<Axis>().is_err(), "{wrong}");
        }
    }
}
