//! A simulated motion, and a sweep of many: as text, table of comma-separated values, and pictures;
//! as documents they are in `export::json`.
//!
//! In: a [`Report`] of one motion or a [`SweepReport`] of many. Out: text in one format; that of a
//! sweep goes to a writer a line at a time. Angles are in rad, times in units of 1/omega, energies
//! in units of m g L, as in the motion itself.

mod chain;
mod columns;
mod content;
mod csv;
pub mod figure;
#[cfg(feature = "plot")]
mod heat_map;
mod latex;
#[cfg(feature = "html")]
mod page;
mod text;

pub(in crate::export) use chain::phase_lines;
#[cfg(feature = "json")]
pub(in crate::export) use chain::phases;
pub use columns::{Column, columns};
pub use csv::{simulation as csv, sweep as sweep_csv};
pub(in crate::export) use latex::phases as phases_as_table;
pub use latex::simulation as latex;
#[cfg(feature = "html")]
pub use page::{simulation as html, sweep as sweep_html};
pub use text::{simulation as text, sweep as sweep_text};

use crate::decimal::{decimal, significant};
use crate::impact::sweep::{Axis, Summary, grid_values};
use crate::impact::{Baseline, Dissipation, Friction, Simulation, Units};
use crate::trajectory::DISPLACEMENT;

/// The data of a report on one run.
#[derive(Debug, Clone, Copy)]
pub struct Report<'a> {
    /// The motion.
    pub motion: &'a Simulation,
    /// The run by the other integrator, if both were requested.
    pub judge: Option<&'a Simulation>,
    /// The sources of gamma and mu.
    pub sources: [&'a str; 2],
    /// The requested tolerance; each step of the integrator gets a fraction of it.
    pub tolerance: f64,
    /// Times at which the state is requested, all within the duration.
    pub samples: &'a [f64],
    /// The rest times of the same swing without a barrier and with a lossless one, if there is
    /// anything to compare.
    pub baseline: Option<&'a Baseline>,
    /// The damping in every form, if known.
    pub dissipation: Option<&'a Dissipation>,
    /// The pendulum in SI units; `None` if they are not known.
    pub units: Option<&'a Units>,
    /// The time until which the motion is known to six digits, if that is not its end
    /// ([`known_until`](crate::impact::known_until)).
    pub known_until: Option<f64>,
}

/// The data of a report on a sweep.
#[derive(Debug, Clone, Copy)]
pub struct SweepReport<'a> {
    /// The parameters; the last varies fastest.
    pub axes: &'a [Axis],
    /// A row for each motion.
    pub rows: &'a [Summary],
}

impl SweepReport<'_> {
    /// Whether the rows contain the rest times without a barrier and with a lossless one.
    pub(super) fn has_baseline(&self) -> bool {
        self.rows.iter().any(|row| row.baseline.is_some())
    }

    /// The values of the parameters of a row.
    pub(super) fn values(&self, row: usize) -> Vec<f64> {
        grid_values(self.axes, row)
    }
}

/// Number of points at which two integrators are compared.
pub(super) const COMPARED: usize = 4001;

pub(super) fn friction(friction: Friction) -> &'static str {
    match friction {
        Friction::Exact => "exact",
        Friction::Arctangent => "arctangent",
    }
}

/// The notes on a run.
pub(super) fn notes(report: &Report) -> Vec<String> {
    let motion = report.motion;
    let mut notes = Vec::new();
    if let Some(known) = report.known_until {
        notes.push(format!(
            "six digits hold until t = {}: then a start displaced by {DISPLACEMENT:e} of it is elsewhere",
            decimal(known)
        ));
    }
    if motion.model.gamma == 0.0 {
        notes.push("gamma = 0 is no barrier: the motion is that of the plain pendulum".to_owned());
    }
    if !motion.touches() && motion.model.left.or(motion.model.right).is_some() {
        let barriers: Vec<String> = [motion.model.left, motion.model.right]
            .into_iter()
            .flatten()
            .map(|barrier| barrier.to_string())
            .collect();
        let barriers = barriers.join(" or ");
        notes.push(match motion.never_touches() {
            true => format!(
                "no contact: the motion never reaches the barrier at {barriers}; it is that of the plain pendulum"
            ),
            false => format!(
                "no contact with the barrier at {barriers} until t = {}",
                decimal(motion.end_time)
            ),
        });
    }
    // Such a small fraction of the initial energy is rounding.
    if let Some(first) = motion.impacts.first()
        && first.speed_in * first.speed_in
            < 1e-12 * motion.model.swing_energy(motion.start.x, motion.start.velocity)
    {
        notes.push(format!(
            "the first impact is no faster than {}: the {} barrier stands where the swing turns back, and rounding decides whether it is touched",
            significant(first.speed_in.abs(), 1),
            first.side.name()
        ));
    }
    if motion.is_caged() {
        notes.push(
            "both barriers stand within a tenth of the first swing: the envelope is below it at once, so the rest time says where they \
             stand and nothing of the energy left"
                .to_owned(),
        );
    }
    if let Some((side, depth)) = motion.model.depth(motion.start.x) {
        notes.push(format!(
            "the motion starts inside the {} barrier, {} deep: the first impact has no touch and so no restitution",
            side.name(),
            decimal(depth)
        ));
    }
    if motion.impacts.last().is_some_and(|impact| impact.exit_time.is_none()) {
        notes.push("the run ends in contact: the last impact has no exit".to_owned());
    }
    notes
}
