//! Many main masses with their pendulums: the amplitude of each in the long run, or its rest time,
//! with its damper, with the damper locked and without.

use super::follow::simulate_primaries;
use super::{
    Primary, PrimaryCase, PrimaryError, PrimaryMotion, PrimarySettings, PrimaryStop,
    UndampedAndLocked,
};
use crate::impact::NoRest;
use crate::parallel::{par_map, threads};
use crate::system::LANES;

/// The part of a run, its last, that counts as the long run.
const LAST: f64 = 0.25;

/// The result of one motion of a sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrimaryRow {
    /// The main mass.
    pub primary: Primary,
    /// The time at which the run ended; 0 if it was interrupted before it had begun.
    pub end: f64,
    /// The largest |y| in the last quarter of the run, over L.
    pub amplitude: f64,
    /// The number of impacts in that quarter.
    pub impacts: usize,
    /// The number of impacts in the whole run.
    pub all_impacts: usize,
    /// The time at which the main mass comes to rest, as
    /// [`PrimaryMotion::rest_time`](super::PrimaryMotion::rest_time) says, or why it does not.
    pub rest_time: Result<f64, NoRest>,
    /// The main mass without its damper and with the damper locked, in closed form.
    pub others: UndampedAndLocked,
    /// The reason why the run ended.
    pub stop: PrimaryStop,
}

impl PrimaryRow {
    /// Whether the run had begun before the interrupt.
    pub fn is_begun(&self) -> bool {
        self.stop != PrimaryStop::Interrupted || self.end > 0.0
    }

    /// Whether a force drives the main mass, so that it has an amplitude in the long run and no
    /// rest.
    pub fn is_driven(&self) -> bool {
        self.primary.force != 0.0
    }
}

/// A row for every motion, on all threads of the current pool; `progress` is called after each of
/// them. The result is the same for any number of threads.
///
/// # Errors
/// The number, counted from zero, of the first motion that cannot be followed, and why.
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::Model;
/// use lindstedt::impact::primary::{Primary, PrimaryCase, PrimarySettings, sweep_primary};
///
/// let model = Model { gamma: 1e4, mu: 1e3, zeta: 0.02, ..Model::default() };
/// let settings = PrimarySettings { duration: 60.0, ..PrimarySettings::default() };
/// let motions = [0.5, 2.0].map(|frequency| {
///     let primary = Primary { mass: 20.0, stiffness: 20.0, damping: 0.8, force: 0.1, frequency };
///     (PrimaryCase { primary, model, start: [0.0; 4] }, settings)
/// });
/// let rows = sweep_primary(&motions, |_| ()).map_err(|(_, error)| error)?;
/// assert!(rows[0].amplitude > rows[1].amplitude);
/// # Ok::<(), lindstedt::impact::primary::PrimaryError>(())
/// ```
pub fn sweep_primary(
    motions: &[(PrimaryCase, PrimarySettings)],
    progress: impl Fn(usize) + Sync,
) -> Result<Vec<PrimaryRow>, (usize, PrimaryError)> {
    /// Motions that are followed together: those that impact leave the others behind.
    const TOGETHER: usize = 4 * LANES;
    let together = motions.len().div_ceil(threads()).clamp(1, TOGETHER);
    let blocks: Vec<_> = motions.chunks(together).collect();
    let rows = par_map(&blocks, |block| {
        let found = simulate_primaries(block);
        progress(block.len());
        found.into_iter().map(|motion| motion.map(|motion| row(&motion))).collect::<Vec<_>>()
    });
    let numbered = rows.into_iter().flatten().enumerate();
    numbered.map(|(number, row)| row.map_err(|error| (number, error))).collect()
}

fn row(motion: &PrimaryMotion) -> PrimaryRow {
    let case = &motion.case;
    let since = (1.0 - LAST) * motion.end;
    PrimaryRow {
        primary: case.primary,
        end: motion.end,
        amplitude: motion.largest_since(since),
        impacts: motion.impacts.iter().filter(|impact| impact.entry_time >= since).count(),
        all_impacts: motion.impacts.len(),
        rest_time: motion.rest_time(),
        others: case.primary.undamped_and_locked(),
        stop: motion.stop,
    }
}
