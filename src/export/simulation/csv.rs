//! Comma-separated values: one line per point, every number to its last digit.

use std::fmt::Write as _;
use std::io;

use super::columns::columns;
use super::{Report, SweepReport};
use crate::export::csv::{cell, head};

/// Number of points inside each step of the integrator.
const BETWEEN: usize = 3;

/// The trajectory, below its units and the names of its columns: the steps of the integrator and a few points inside each, so that a contact of a
/// millisecond is as well drawn as a swing; where samples are asked for, the state at these alone.
///
/// ```
/// use lindstedt::export::simulation::{Report, csv};
/// use lindstedt::impact::{Case, Integrator, Settings, simulate};
///
/// let (model, start) = Case { zeta: 0.05, ..Case::default() }.motion()?;
/// let motion = simulate(&model, start, Integrator::Taylor, &Settings::default())?;
/// let report = Report { motion: &motion, judge: None, sources: ["given", "given"], tolerance: 1e-10, samples: &[1.0], baseline: None, dissipation: None, units: None, known_until: None };
/// let table = csv(&report);
/// assert!(table.contains("\nt,x,velocity,") && table.lines().count() == 3); // the state at t = 1
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn simulation(report: &Report) -> String {
    let motion = report.motion;
    let mut text = head(&[
        ("t", "1/omega"),
        ("x", "rad"),
        ("velocity", "rad*omega"),
        ("state", "-"),
        ("energy", "m*g*L"),
    ]);
    let mut line = |t: f64, x: f64, velocity: f64| {
        let state = motion.path.regime_at(t).map_or("free", |state| state.name());
        let energy = motion.model.energy(x, velocity);
        let _ = writeln!(text, "{t},{x},{velocity},{state},{energy}");
    };
    if report.samples.is_empty() {
        let mut last = f64::NEG_INFINITY;
        for (t, x, velocity) in motion.path.points(BETWEEN) {
            if t > last {
                line(t, x, velocity);
                last = t;
            }
        }
    } else {
        for &t in report.samples {
            if let Some((x, velocity)) = motion.path.phase_point_at(t) {
                line(t, x, velocity);
            }
        }
    }
    // A table that ends early gets a comment line, which readers of tables can skip.
    if !motion.stop.is_complete() {
        let _ = writeln!(text, "# incomplete: {}", motion.stop);
    }
    text
}

/// The sweep: the parameters, then the results, written line by line, because there may be a
/// million lines. The first line has the units and begins with `#`, as a comment that readers of
/// tables can be told to skip; the second has the names.
///
/// # Errors
/// The errors of the writer.
///
/// ```
/// use lindstedt::export::simulation::{SweepReport, sweep_csv};
/// use lindstedt::impact::{Integrator, Model, Settings, Start, sweep::{Axis, sweep}};
///
/// let axes: [Axis; 1] = ["zeta=0.02:0.1:3".parse()?];
/// let start = Start { x: -1.5, velocity: 0.0 };
/// let motions: Vec<_> = axes[0].values().iter().map(|&zeta| (Model { zeta, ..Model::default() }, start)).collect();
/// let rows = sweep(&motions, Integrator::Taylor, &Settings::default(), |_done| {}).map_err(|(_, error)| error)?;
/// let report = SweepReport { axes: &axes, rows: &rows };
/// let mut table = Vec::new();
/// sweep_csv(&report, &mut table)?;
/// assert!(String::from_utf8(table)?.contains("\nzeta,impacts,rest_time,"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn sweep(report: &SweepReport, to: &mut dyn io::Write) -> io::Result<()> {
    let columns = columns(report.axes, report.has_baseline()).into_iter();
    let columns: Vec<(String, String)> = columns
        .map(|column| (column.name, column.unit.unwrap_or_else(|| "-".to_owned())))
        .collect();
    to.write_all(head(&columns).as_bytes())?;
    for (row, summary) in report.rows.iter().enumerate() {
        for value in report.values(row) {
            write!(to, "{value},")?;
        }
        let mut rest = cell(summary.rest_time.ok());
        if let Some([without, lossless]) = summary.baseline {
            rest = format!("{rest},{},{}", cell(without.ok()), cell(lossless.ok()));
        }
        let (complete, stop) = (summary.stop.is_complete(), summary.stop.name());
        match summary.is_begun() {
            true => writeln!(
                to,
                "{},{rest},{},{},{},{},{},{},{complete},{stop}",
                summary.impacts,
                summary.deepest,
                summary.fastest,
                summary.energy_lost,
                summary.end_time,
                summary.end_x,
                summary.end_velocity,
            )?,
            false => writeln!(to, ",{rest},,,,,,,{complete},{stop}")?,
        }
    }
    Ok(())
}
