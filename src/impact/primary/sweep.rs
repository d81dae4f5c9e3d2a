//! The main mass at many frequencies of its force: how far it swings in the long run, with its damper, with the damper locked and
//! without.

use super::{Others, Primary, PrimaryCase, PrimaryError, PrimarySettings, PrimaryStop, simulate_primary};
use crate::parallel::each;

/// The part of a run, its last, that counts as the long run.
const LAST: f64 = 0.25;

/// The main mass at one frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrimaryRow {
    /// eta, the frequency of the force over omega.
    pub frequency: f64,
    /// The largest |y| in the last quarter of the run, over L.
    pub amplitude: f64,
    /// The number of impacts in that quarter.
    pub impacts: usize,
    /// The main mass without its damper and with the damper locked, in closed form.
    pub others: Others,
    /// Why the run ended.
    pub stop: PrimaryStop,
}

/// A row for every frequency, on all threads of the current pool; `progress` hears of each that is done. The result is the same for
/// any number of threads.
///
/// # Errors
/// The first frequency that cannot be followed.
///
/// ```
/// use lindstedt::impact::Model;
/// use lindstedt::impact::primary::{Primary, PrimaryCase, PrimarySettings, sweep_primary};
///
/// let primary = Primary { mass: 20.0, stiffness: 20.0, damping: 0.8, force: 0.1, frequency: 1.0 };
/// let case = PrimaryCase { primary, model: Model { gamma: 1e4, mu: 1e3, zeta: 0.02, ..Model::default() }, start: [0.0; 4] };
/// let rows = sweep_primary(case, &[0.5, 2.0], &PrimarySettings { duration: 60.0, ..PrimarySettings::default() }, |_| ())?;
/// assert!(rows[0].amplitude > rows[1].amplitude);
/// # Ok::<(), lindstedt::impact::primary::PrimaryError>(())
/// ```
pub fn sweep_primary(
    case: PrimaryCase,
    frequencies: &[f64],
    settings: &PrimarySettings,
    progress: impl Fn(usize) + Sync,
) -> Result<Vec<PrimaryRow>, PrimaryError> {
    let row = |frequency: &f64| {
        let primary = Primary {
            frequency: *frequency,
            ..case.primary
        };
        let row = row(PrimaryCase { primary, ..case }, settings);
        progress(1);
        row
    };
    each(frequencies, row).into_iter().collect()
}

fn row(case: PrimaryCase, settings: &PrimarySettings) -> Result<PrimaryRow, PrimaryError> {
    let motion = simulate_primary(case, settings)?;
    let since = (1.0 - LAST) * motion.end;
    Ok(PrimaryRow {
        frequency: case.primary.frequency,
        amplitude: motion.largest_since(since),
        impacts: motion.impacts.iter().filter(|impact| impact.entry >= since).count(),
        others: case.primary.others(),
        stop: motion.stop,
    })
}
