//! A simulation, or a sweep, as text for a terminal.

use std::fmt::Write as _;
use std::io;

use super::{COMPARED, Report, SweepReport, chain, friction, notes};
use crate::decimal::{decimal, significant};
use crate::export::text::percent;
use crate::impact::sweep::Axis;
use crate::impact::{
    Baseline, ContactDamping, ContactRecord, Dissipation, Geometry, Integrator, Model, NoRest,
    Simulation, Units,
};

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
        text.push_str(&damping(
            dissipation,
            motion.model.left.or(motion.model.right).is_some(),
            report.units,
        ));
    }
    let is_chain = motion.integrator == Integrator::Chain;
    text += &impacts(motion, report.judge.filter(|_| is_chain));
    if is_chain {
        chain::formulas(&mut text, motion);
    }
    rest(&mut text, report);
    // The formulas of a chain give the energy only at the ends of each phase; within a phase their
    // velocities do not satisfy the energy balance.
    if motion.integrator != Integrator::Chain {
        energy(&mut text, motion);
    }
    if !report.samples.is_empty() {
        let _ = writeln!(text, "\nStates asked for\n  {:>12}  {:>16}  {:>16}", "t", "x", "x'");
        for &t in report.samples {
            let state = match motion.path.phase_point_at(t) {
                Some((x, velocity)) => {
                    format!("{:>16}  {:>16}", significant(x, 10), significant(velocity, 10))
                }
                None => format!("{:>16}", "not reached"),
            };
            let _ = writeln!(text, "  {:>12}  {state}", decimal(t));
        }
    }
    let _ = writeln!(
        text,
        "\nAt t = {}: x = {}, x' = {}",
        decimal(motion.end_time),
        significant(motion.end_x, 10),
        significant(motion.end_velocity, 10)
    );
    let _ = writeln!(text, "  {} in {} steps; {}", method(motion), motion.steps, motion.stop);
    if let Some(judge) = report.judge {
        let difference = motion.difference(judge, COMPARED);
        let _ = writeln!(
            text,
            "\nBeside {}, {} steps\n  largest difference in x {}{}, until t = {}",
            method(judge),
            judge.steps,
            size(difference.displacement),
            // For a chain the difference would be dominated by touches at slightly different times.
            match motion.integrator {
                Integrator::Chain => String::new(),
                _ => format!(", in x' {}", size(difference.velocity)),
            },
            decimal(difference.until)
        );
        let _ = writeln!(
            text,
            "  impacts {}, energy residual {}; {}",
            judge.impacts.len(),
            size(judge.energy().residual),
            judge.stop
        );
    }
    for note in notes(report) {
        let _ = writeln!(text, "\nnote: {note}");
    }
    text
}

fn method(motion: &Simulation) -> &'static str {
    match motion.integrator {
        Integrator::Taylor => "Taylor series, contact regularised",
        Integrator::RungeKutta => "Runge-Kutta in phases",
        Integrator::Chain => "closed forms, swing and contact in turn",
    }
}

/// A number as it was typed: every digit, unless there are very many zeros.
fn typed(value: f64) -> String {
    if (1e-6..1e9).contains(&value.abs()) || value == 0.0 {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

/// A number to its order of magnitude, limited by rounding.
fn size(value: f64) -> String {
    if value < 1e-15 { "< 1e-15".to_owned() } else { format!("{value:.0e}") }
}

fn header(report: &Report) -> String {
    let motion = report.motion;
    let Model { zeta, alpha, friction: law, beta, frequency_ratio, gamma, mu, left, right } =
        motion.model;
    let dry = match law {
        _ if alpha == 0.0 => "",
        crate::impact::Friction::Exact => " + alpha*sgn(x')",
        crate::impact::Friction::Arctangent => " + (2/pi)*alpha*atan(100*x')",
    };
    let viscous = if zeta == 0.0 { "" } else { " + 2*zeta*x'" };
    let drive = if beta == 0.0 { "" } else { " - beta*sin(eta*t)*cos(x)" };
    let free = left.or(right).is_none();
    let left_alone = left.is_some() && right.is_none();
    let contact = match (mu == 0.0, left_alone) {
        _ if free => "",
        (true, false) => " + gamma*(x - xc)^(3/2)*H(x - xc)",
        (false, false) => " + (gamma + mu*x')*(x - xc)^(3/2)*H(x - xc)",
        (true, true) => " - gamma*(xc - x)^(3/2)*H(xc - x)",
        (false, true) => " - (gamma - mu*x')*(xc - x)^(3/2)*H(xc - x)",
    };
    let mut text = format!("x''{viscous}{dry}{drive} + sin(x){contact} = 0\n");
    if left.is_some() && !left_alone {
        text.push_str("and the mirror image of the contact on the left\n");
    }
    let [gamma_source, mu_source] = report.sources;
    let mut entry = |name: &str, value: String| {
        let _ = writeln!(text, "  {name:<8} = {value}");
    };
    entry(
        "x(0)",
        format!("{}, x'(0) = {}", decimal(motion.start.x), decimal(motion.start.velocity)),
    );
    match (left, right) {
        (Some(left), Some(right)) => entry("xc", format!("{} and {}", typed(left), typed(right))),
        (Some(only), None) | (None, Some(only)) => entry("xc", typed(only)),
        (None, None) => {}
    }
    if !free {
        entry("gamma", format!("{}   ({gamma_source})", decimal(gamma)));
    }
    if mu != 0.0 && !free {
        entry("mu", format!("{}   ({mu_source})", decimal(mu)));
    }
    if zeta != 0.0 {
        entry("zeta", decimal(zeta));
    }
    if alpha != 0.0 {
        entry("alpha", format!("{}   ({})", decimal(alpha), friction(law)));
    }
    if beta != 0.0 {
        entry(
            "beta",
            format!("{}, eta = Omega/omega = {}", decimal(beta), decimal(frequency_ratio)),
        );
    }
    text
}

/// The damping in every form, and the form that is held fixed.
fn damping(dissipation: &Dissipation, has_barrier: bool, units: Option<&Units>) -> String {
    let &Dissipation {
        mu, mu_over_gamma, lambda, coefficient, zeta, viscous, alpha, torque, ..
    } = dissipation;
    let contact = mu != 0.0 && has_barrier;
    if !contact && zeta == 0.0 && alpha == 0.0 {
        return String::new();
    }
    let held = dissipation.held_fixed();
    let held: Vec<&str> = held
        .into_iter()
        .filter(|form| contact || *form != dissipation.contact.form().name())
        .collect();
    let mut text = format!("\nDamping, in every form; held fixed: {}\n", held.join(", "));
    let mut entry = |name: &str, forms: Vec<String>| {
        let _ = writeln!(text, "  {name:<9} {}", forms.join(", "));
    };
    let in_si = |name: &str, value: Option<f64>, unit: &str| {
        let value = value.map(|value| format!("{name} = {} {unit}", decimal(value)));
        value.into_iter().collect::<Vec<_>>()
    };
    if contact {
        let mut forms =
            vec![format!("mu = {}", decimal(mu)), format!("mu/gamma = {}", decimal(mu_over_gamma))];
        forms.extend(in_si("lambda", lambda, "s/m"));
        forms.extend(in_si("damping", coefficient, "N s/m^(5/2)"));
        entry("contact", forms);
        if let (ContactDamping::Restitution(e), Some(speed)) =
            (dissipation.contact, dissipation.at_speed_in_words())
        {
            let given = format!("restitution = {} at the speed {speed}", decimal(e));
            entry("", vec![given]);
        }
        if let (Some(e), Some(speed)) = (dissipation.restitution, dissipation.touch_speed) {
            let (e, speed) = (decimal(e), decimal(speed));
            let words = format!(
                "restitution {e} at {speed} rad*omega, the speed of the first touch without damping"
            );
            entry("", vec![words]);
        }
    }
    if zeta != 0.0 {
        let zeta = vec![format!("zeta = {}", decimal(zeta))];
        entry("viscous", [zeta, in_si("viscous", viscous, "N s/m")].concat());
    }
    if alpha != 0.0 {
        let alpha = vec![format!("alpha = {}", decimal(alpha))];
        entry("friction", [alpha, in_si("torque", torque, "N m")].concat());
    }
    if let Some(units) = units {
        let mut sizes = vec![format!("m = {} kg", decimal(units.mass))];
        sizes.push(format!("L = {} m", decimal(units.length)));
        sizes.push(format!("g = {} m/s^2", decimal(units.gravity)));
        sizes.push(format!("1/omega = {} s", decimal(units.time())));
        entry("with", sizes);
    }
    text
}

/// The impacts: with a second integrator, each with its errors below it; without one, each with the
/// energy lost in it.
fn impacts(motion: &Simulation, judge: Option<&Simulation>) -> String {
    let count = motion.impacts.len();
    let judged = judge.is_some();
    let beside = judge.map_or_else(String::new, |judge| {
        format!(", {} by integration; below each number its error", judge.impacts.len())
    });
    let mut text = format!("\nImpacts: {count}{beside}\n");
    if count == 0 {
        return text;
    }
    let speed = if judged { 11 } else { 10 };
    let line = |[number, side]: [&str; 2], cells: &[String]| {
        let cells = cells.iter().zip([12, 12, speed, speed, 12, 11, 12]);
        let cells: String = cells.map(|(cell, width)| format!("  {cell:>width$}")).collect();
        format!("  {number:>4}  {side:5}{cells}\n")
    };
    let optional = |value: Option<f64>| value.map_or("-".to_owned(), decimal);
    let errors = judge.map_or_else(Vec::new, |judge| motion.contact_deviations(judge));
    let row = |index: usize| {
        let impact = &motion.impacts[index];
        let mut cells = vec![
            significant(impact.entry_time, 8),
            duration(impact),
            decimal(impact.speed_in),
            optional(impact.speed_out),
            decimal(impact.penetration),
            optional(impact.restitution),
        ];
        if !judged {
            // The loss in an elastic contact is rounding.
            cells.push(optional(impact.energy_lost.map(|lost| {
                let speed = impact.speed_in.abs().max(impact.speed_out.unwrap_or_default());
                if lost.abs() < 1e-9 * speed * speed { 0.0 } else { lost }
            })));
        }
        let own = line([&(index + 1).to_string(), impact.side.name()], &cells);
        own + &match errors.get(index) {
            None => String::new(),
            Some(None) => line(["", ""], &["not there by integration".to_owned()]),
            Some(Some(error)) => {
                let time = format!("{:+.1e}", error.entry_time);
                let parts = [error.duration, error.speed_in, error.speed_out, error.penetration]
                    .map(|part| part.map_or("-".to_owned(), percent));
                line(["", ""], &[&[time], &parts[..]].concat())
            }
        }
    };
    let columns =
        ["entry", "duration", "speed in", "speed out", "penetration", "restitution", "energy lost"];
    let columns = columns.map(str::to_owned);
    text += &line(["", "side"], &columns[..columns.len() - usize::from(judged)]);
    // With errors one more is listed, because the last impact is not repeated below.
    let listed = LISTED + usize::from(judged);
    let shown = if count <= listed { count } else { listed - 1 };
    text.extend((0..shown).map(row));
    if shown < count {
        text += &format!("   ... {} more, all of them in --format json\n", count - LISTED);
        text.extend((!judged).then(|| row(count - 1)));
    }
    text
}

/// Duration of an impact, to the accuracy of its two times: with a very stiff barrier it is shorter
/// than their last digit.
fn duration(impact: &ContactRecord) -> String {
    let least = 2.0 * f64::EPSILON * impact.entry_time.abs();
    match impact.exit_time.map(|exit| exit - impact.entry_time) {
        None => "-".to_owned(),
        Some(short) if short <= least => format!("< {}", significant(least, 1)),
        Some(duration) => decimal(duration),
    }
}

fn rest(text: &mut String, report: &Report) {
    let rest = report.motion.rest();
    let seconds = |time: f64| match report.units {
        Some(units) => format!(", {} s", decimal(time * units.time())),
        None => String::new(),
    };
    let about = match rest.place {
        0.0 => String::new(),
        place => format!(" about the place of rest, x = {}", decimal(place)),
    };
    let _ = match rest.amplitude {
        0.0 => writeln!(text, "\nRest"),
        amplitude => writeln!(text, "\nRest: 10 % of the amplitude {}{about}", decimal(amplitude)),
    };
    let _ = match rest.time {
        Ok(time) => writeln!(
            text,
            "  rest time      {}{}   (envelope of the turning points)",
            decimal(time),
            seconds(time)
        ),
        Err(reason) => writeln!(text, "  rest time      none: {reason}"),
    };
    if let (Integrator::Chain, Some(judge)) = (report.motion.integrator, report.judge) {
        let _ = writeln!(
            text,
            "  integrated     {}",
            chain::rest_time_comparison(rest.time, judge.rest().time)
        );
    }
    if let Some(last) = rest.last_crossing {
        let _ = writeln!(text, "  last crossing  {}", decimal(last));
    }
    let Some(Baseline { no_barrier, lossless_barrier, geometry }) = report.baseline else {
        return;
    };
    let written = |time: &Result<f64, NoRest>| match time {
        Ok(time) => decimal(*time),
        Err(reason) => format!("none: {reason}"),
    };
    let _ = writeln!(text, "  no barrier     {}", written(no_barrier));
    let _ = writeln!(text, "  lossless       {}   (mu = 0)", written(lossless_barrier));
    if let (Ok(none), Ok(lossless), Ok(this)) = (no_barrier, lossless_barrier, rest.time) {
        let _ = writeln!(
            text,
            "  of the {} that the barrier saves, {} by the shorter swing and {} by the loss in contact",
            decimal(none - this),
            decimal(none - lossless),
            decimal(lossless - this)
        );
    }
    if let Some(Geometry { first_swing, at_rest, gain }) = geometry {
        let (letters, numbers) = match *at_rest == 1.0 {
            true => ("S/Sc".to_owned(), decimal(*first_swing)),
            false => (
                "(S/Sc)/(s/sc)".to_owned(),
                format!("{}/{}", decimal(*first_swing), decimal(*at_rest)),
            ),
        };
        let _ = writeln!(
            text,
            "  the shorter swing by formula: ln({letters})/(2*zeta) = ln({numbers})/(2*zeta) = {}",
            decimal(*gain)
        );
        let rested = if *at_rest == 1.0 { "" } else { ", s and sc those at rest" };
        let _ = writeln!(
            text,
            "  S and Sc are the actions of the first swing, whole and cut at the barrier{rested}"
        );
    }
}

fn energy(text: &mut String, motion: &Simulation) {
    let book = motion.energy();
    let model = &motion.model;
    let _ = writeln!(text, "\nEnergy, in units of m g L");
    let mut entry = |name: &str, value: f64, shown: bool| {
        if shown {
            let _ = writeln!(text, "  {name:<14} {:>13}", decimal(value));
        }
    };
    entry("at the start", book.start, true);
    entry("viscous", book.viscous, model.zeta != 0.0);
    entry("friction", book.friction, model.alpha != 0.0);
    entry("contact", book.contact, model.mu != 0.0);
    entry("excitation", book.excitation, model.beta != 0.0);
    entry("at the end", book.end, true);
    let _ =
        writeln!(text, "  {:<14} {:>13}   of the largest energy", "residual", size(book.residual));
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
    let width = |axis: &Axis| (axis.name().len() + 2).max(14);
    let beside = match report.has_baseline() {
        true => format!("{:>13}{:>13}", "no barrier", "lossless"),
        false => String::new(),
    };
    for axis in report.axes {
        write!(to, "{:>1$}", axis.name(), width(axis))?;
    }
    writeln!(
        to,
        "{:>9}{:>13}{beside}{:>13}{:>11}{:>13}{:>13}",
        "impacts", "rest time", "penetration", "speed in", "energy lost", "stopped at"
    )?;
    let block: usize = match report.axes {
        [_, .., down, across] => down.values().len() * across.values().len(),
        _ => usize::MAX,
    };
    for (row, summary) in report.rows.iter().enumerate() {
        if row > 0 && row % block == 0 {
            writeln!(to)?;
        }
        for (axis, value) in report.axes.iter().zip(report.values(row)) {
            write!(to, "{:>1$}", decimal(value), width(axis))?;
        }
        let written = |time: Result<f64, NoRest>| time.map_or("-".to_owned(), decimal);
        let rest = written(summary.rest_time);
        let beside = match summary.baseline {
            Some([without, lossless]) => {
                format!("{:>13}{:>13}", written(without), written(lossless))
            }
            None => String::new(),
        };
        let warning = if summary.stop.is_complete() { "" } else { "  incomplete" };
        let lost = if summary.energy_lost.abs() < 1e-9 { 0.0 } else { summary.energy_lost };
        let results = match summary.is_begun() {
            true => [summary.deepest, summary.fastest, lost, summary.end_time].map(decimal),
            false => [(); 4].map(|()| "-".to_owned()),
        };
        let impacts = match summary.is_begun() {
            true => summary.impacts.to_string(),
            false => "-".to_owned(),
        };
        let [deepest, fastest, lost, end] = results;
        writeln!(
            to,
            "{impacts:>9}{rest:>13}{beside}{deepest:>13}{fastest:>11}{lost:>13}{end:>13}{warning}"
        )?;
    }
    Ok(())
}
