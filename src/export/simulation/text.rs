//! A simulation, or a sweep, as text for a terminal.

use std::fmt::Write as _;
use std::io;

use super::{Report, SweepReport, chain, content, notes};
use crate::impact::{Dissipation, Integrator, Simulation};

/// Largest number of listed impacts; a long run has thousands.
pub(super) const LISTED: usize = 24;

/// The text of a single run.
///
/// ```
/// use lindstedt::export::simulation::{Report, text};
/// use lindstedt::impact::{Case, Integrator, Settings, simulate};
///
/// let (model, start) = Case { zeta: 0.05, ..Case::default() }.motion()?;
/// let motion = simulate(&model, start, Integrator::Taylor, &Settings::default())?;
/// let report = Report { motion: &motion, judge: None, sources: ["given", "given"], tolerance: 1e-10, samples: &[1.0], baseline: None, dissipation: None, units: None, known_until: None };
/// assert!(text(&report).contains("\nImpacts: "));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn simulation(report: &Report) -> String {
    let motion = report.motion;
    let mut text = header(report);
    if let Some(dissipation) = report.dissipation {
        text.push_str(&damping(report, dissipation));
    }
    let is_chain = motion.integrator == Integrator::Chain;
    text += &impacts(report);
    if is_chain {
        chain::formulas(&mut text, motion);
    }
    rest(&mut text, report);
    if !is_chain {
        energy(&mut text, motion);
    }
    if !report.samples.is_empty() {
        let [t, x, velocity] = content::STATE;
        let _ = writeln!(text, "\n{}\n  {t:>12}  {x:>16}  {velocity:>16}", content::STATES);
        for cells in content::states(report) {
            let [t, state @ ..] = cells.as_slice() else { continue };
            let state: Vec<String> = state.iter().map(|cell| format!("{cell:>16}")).collect();
            let _ = writeln!(text, "  {t:>12}  {}", state.join("  "));
        }
    }
    let [heading, words] = content::end(motion);
    let _ = writeln!(text, "\n{heading}\n  {words}");
    if let Some([heading, difference, words]) = content::beside(report) {
        let _ = writeln!(text, "\n{heading}\n  {difference}\n  {words}");
    }
    for note in notes(report) {
        let _ = writeln!(text, "\nnote: {note}");
    }
    text
}

fn header(report: &Report) -> String {
    let mut text = content::equation(&report.motion.model) + "\n";
    if content::is_mirrored(&report.motion.model) {
        let _ = writeln!(text, "{}", content::MIRRORED);
    }
    for (name, value) in content::given(report) {
        let _ = writeln!(text, "  {name:<8} = {value}");
    }
    text
}

/// The damping in every form, and the form that is held fixed.
fn damping(report: &Report, dissipation: &Dissipation) -> String {
    let Some((heading, forms)) = content::damping(report, dissipation) else {
        return String::new();
    };
    let line = |(name, forms): &(&str, String)| format!("  {name:<9} {forms}\n");
    format!("\n{heading}\n") + &forms.iter().map(line).collect::<String>()
}

/// The impacts: with a second integrator, each with its errors below it; without one, each with the
/// energy lost in it.
fn impacts(report: &Report) -> String {
    let impacts = content::impacts(report);
    let mut text = format!("\n{}\n", impacts.heading);
    if impacts.rows.is_empty() {
        return text;
    }
    let speed = if impacts.head.contains(&content::ENERGY_LOST) { 10 } else { 11 };
    let line = |cells: &[&str]| {
        let [number, side, cells @ ..] = cells else { return String::new() };
        let cells = cells.iter().zip([12, 12, speed, speed, 12, 11, 12]);
        let cells: String = cells.map(|(cell, width)| format!("  {cell:>width$}")).collect();
        format!("  {number:>4}  {side:5}{cells}\n")
    };
    let rows = |rows: &[Vec<String>]| -> String {
        rows.iter().map(|row| line(&row.iter().map(String::as_str).collect::<Vec<_>>())).collect()
    };
    text += &line(&[&["", "side"], &impacts.head[2..]].concat());
    text += &rows(&impacts.rows);
    if let Some(more) = impacts.more {
        text += &format!("   {more}\n");
        text += &rows(&impacts.last);
    }
    text
}

fn rest(text: &mut String, report: &Report) {
    let rest = content::rest(report);
    let _ = writeln!(text, "\n{}", rest.heading);
    for (name, value) in rest.times {
        let _ = writeln!(text, "  {name:<13}  {value}");
    }
    for sentence in rest.sentences {
        let _ = writeln!(text, "  {sentence}");
    }
}

fn energy(text: &mut String, motion: &Simulation) {
    let _ = writeln!(text, "\n{}", content::ENERGY);
    for (name, value, words) in content::energy(motion) {
        let _ = writeln!(text, "  {name:<14} {value:>13}{words}");
    }
}

/// A sweep, written line by line, because there may be a million lines. With three or more
/// parameters, each block varies the last two.
///
/// # Errors
/// The errors of the writer.
///
/// ```
/// use lindstedt::export::simulation::{SweepReport, sweep_text};
/// use lindstedt::impact::{Integrator, Model, Settings, Start, sweep::{Axis, sweep}};
///
/// let axes: [Axis; 1] = ["zeta=0.02:0.1:3".parse()?];
/// let start = Start { x: -1.5, velocity: 0.0 };
/// let motions: Vec<_> = axes[0].values().iter().map(|&zeta| (Model { zeta, ..Model::default() }, start)).collect();
/// let rows = sweep(&motions, Integrator::Taylor, &Settings::default(), |_done| {}).map_err(|(_, error)| error)?;
/// let report = SweepReport { axes: &axes, rows: &rows };
/// let mut text = Vec::new();
/// sweep_text(&report, &mut text)?;
/// assert!(String::from_utf8(text)?.lines().count() > 3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn sweep(report: &SweepReport, to: &mut dyn io::Write) -> io::Result<()> {
    let own = report.axes.iter().map(|axis| (axis.name().len() + 2).max(14));
    let beside: &[usize] = if report.has_baseline() { &[13, 13] } else { &[] };
    let widths: Vec<usize> =
        own.chain([9, 13]).chain(beside.iter().copied()).chain([13, 11, 13, 13]).collect();
    let line = |to: &mut dyn io::Write, cells: &[String], end: &str| {
        for (cell, width) in cells.iter().zip(&widths) {
            write!(to, "{cell:>width$}")?;
        }
        writeln!(to, "{end}")
    };
    line(to, &content::sweep_head(report), "")?;
    let block: usize = match report.axes {
        [_, .., down, across] => down.values().len() * across.values().len(),
        _ => usize::MAX,
    };
    for (row, summary) in report.rows.iter().enumerate() {
        if row > 0 && row % block == 0 {
            writeln!(to)?;
        }
        let warning = if summary.stop.is_complete() { "" } else { "  incomplete" };
        line(to, &content::sweep_row(report, row, summary), warning)?;
    }
    Ok(())
}
