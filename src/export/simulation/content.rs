//! The words and numbers of a report, part by part, as they are printed: text aligns them, a page
//! sets them as tables and formulas.

use super::text::LISTED;
use super::{COMPARED, Report, SweepReport, chain, friction};
use crate::decimal::{decimal, significant};
use crate::export::text::percent;
use crate::impact::sweep::Summary;
use crate::impact::{
    Baseline, ContactDamping, ContactRecord, Dissipation, Friction, Geometry, Integrator, Model,
    NoRest, Simulation,
};

/// The words for a second barrier that the equation leaves out.
pub(super) const MIRRORED: &str = "and the mirror image of the contact on the left";

/// The heading of the energy balance.
pub(super) const ENERGY: &str = "Energy, in units of m g L";

/// The heading of the states at requested times.
pub(super) const STATES: &str = "States asked for";

/// The columns of the states.
pub(super) const STATE: [&str; 3] = ["t", "x", "x'"];

/// The name of the last column of the impacts of a run without a second integrator.
pub(super) const ENERGY_LOST: &str = "energy lost";

/// The name of an integrator.
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

/// Whether there are two barriers, of which the equation shows one.
pub(super) fn is_mirrored(model: &Model) -> bool {
    model.left.is_some() && model.right.is_some()
}

/// The equation of motion with the terms that do not vanish.
pub(super) fn equation(model: &Model) -> String {
    let dry = match model.friction {
        _ if model.alpha == 0.0 => "",
        Friction::Exact => " + alpha*sgn(x')",
        Friction::Arctangent => " + (2/pi)*alpha*atan(100*x')",
    };
    let viscous = if model.zeta == 0.0 { "" } else { " + 2*zeta*x'" };
    let drive = if model.beta == 0.0 { "" } else { " - beta*sin(eta*t)*cos(x)" };
    let free = model.left.or(model.right).is_none();
    let left_alone = model.left.is_some() && model.right.is_none();
    let contact = match (model.mu == 0.0, left_alone) {
        _ if free => "",
        (true, false) => " + gamma*(x - xc)^(3/2)*H(x - xc)",
        (false, false) => " + (gamma + mu*x')*(x - xc)^(3/2)*H(x - xc)",
        (true, true) => " - gamma*(xc - x)^(3/2)*H(xc - x)",
        (false, true) => " - (gamma - mu*x')*(xc - x)^(3/2)*H(xc - x)",
    };
    format!("x''{viscous}{dry}{drive} + sin(x){contact} = 0")
}

/// The start and the parameters that are not zero.
pub(super) fn given(report: &Report) -> Vec<(&'static str, String)> {
    let motion = report.motion;
    let Model { zeta, alpha, friction: law, beta, frequency_ratio, gamma, mu, left, right } =
        motion.model;
    let [gamma_source, mu_source] = report.sources;
    let free = left.or(right).is_none();
    let start = format!("{}, x'(0) = {}", decimal(motion.start.x), decimal(motion.start.velocity));
    let mut given = vec![("x(0)", start)];
    match (left, right) {
        (Some(left), Some(right)) => {
            given.push(("xc", format!("{} and {}", typed(left), typed(right))));
        }
        (Some(only), None) | (None, Some(only)) => given.push(("xc", typed(only))),
        (None, None) => {}
    }
    if !free {
        given.push(("gamma", format!("{}   ({gamma_source})", decimal(gamma))));
    }
    if mu != 0.0 && !free {
        given.push(("mu", format!("{}   ({mu_source})", decimal(mu))));
    }
    if zeta != 0.0 {
        given.push(("zeta", decimal(zeta)));
    }
    if alpha != 0.0 {
        given.push(("alpha", format!("{}   ({})", decimal(alpha), friction(law))));
    }
    if beta != 0.0 {
        let beta = format!("{}, eta = Omega/omega = {}", decimal(beta), decimal(frequency_ratio));
        given.push(("beta", beta));
    }
    given
}

/// The damping in every form under a heading that names the form that is held fixed; an entry
/// without a name continues the one before. `None` if nothing damps the motion.
pub(super) fn damping(
    report: &Report,
    dissipation: &Dissipation,
) -> Option<(String, Vec<(&'static str, String)>)> {
    let &Dissipation {
        mu, mu_over_gamma, lambda, coefficient, zeta, viscous, alpha, torque, ..
    } = dissipation;
    let contact = mu != 0.0 && report.motion.model.left.or(report.motion.model.right).is_some();
    if !contact && zeta == 0.0 && alpha == 0.0 {
        return None;
    }
    let held = dissipation.held_fixed();
    let held: Vec<&str> = held
        .into_iter()
        .filter(|form| contact || *form != dissipation.contact.form().name())
        .collect();
    let mut entries = Vec::new();
    let mut entry = |name: &'static str, forms: Vec<String>| entries.push((name, forms.join(", ")));
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
    if let Some(units) = report.units {
        let mut sizes = vec![format!("m = {} kg", decimal(units.mass))];
        sizes.push(format!("L = {} m", decimal(units.length)));
        sizes.push(format!("g = {} m/s^2", decimal(units.gravity)));
        sizes.push(format!("1/omega = {} s", decimal(units.time())));
        entry("with", sizes);
    }
    Some((format!("Damping, in every form; held fixed: {}", held.join(", ")), entries))
}

/// The impacts of a run, of a long one the first and the last.
pub(super) struct Impacts {
    /// The number of impacts, and what stands below each.
    pub(super) heading: String,
    /// The heading of each column: number, side, then numbers.
    pub(super) head: Vec<&'static str>,
    /// A cell for each column; a row of errors has neither number nor side.
    pub(super) rows: Vec<Vec<String>>,
    /// The words for the impacts that are left out; `None` if there are none.
    pub(super) more: Option<String>,
    /// The rows that follow those words.
    pub(super) last: Vec<Vec<String>>,
}

/// The impacts: of a chain that was also integrated each with its errors below it, otherwise each
/// with the energy lost in it.
pub(super) fn impacts(report: &Report) -> Impacts {
    let motion = report.motion;
    let judge = report.judge.filter(|_| motion.integrator == Integrator::Chain);
    let count = motion.impacts.len();
    let judged = judge.is_some();
    let beside = judge.map_or_else(String::new, |judge| {
        format!(", {} by integration; below each number its error", judge.impacts.len())
    });
    let optional = |value: Option<f64>| value.map_or("-".to_owned(), decimal);
    let errors = judge.map_or_else(Vec::new, |judge| motion.contact_deviations(judge));
    let rows_of = |index: usize| {
        let impact = &motion.impacts[index];
        let mut cells = vec![
            (index + 1).to_string(),
            impact.side.name().to_owned(),
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
        let mut rows = vec![cells];
        rows.extend(errors.get(index).map(|error| {
            let mut cells = vec![String::new(), String::new()];
            match error {
                None => cells.push("not there by integration".to_owned()),
                Some(error) => {
                    cells.push(format!("{:+.1e}", error.entry_time));
                    let parts =
                        [error.duration, error.speed_in, error.speed_out, error.penetration];
                    cells.extend(parts.map(|part| part.map_or("-".to_owned(), percent)));
                }
            }
            cells
        }));
        rows
    };
    let mut head = vec![
        "impact",
        "side",
        "entry",
        "duration",
        "speed in",
        "speed out",
        "penetration",
        "restitution",
    ];
    head.extend((!judged).then_some(ENERGY_LOST));
    // With errors one more is listed, because the last impact is not repeated below.
    let listed = LISTED + usize::from(judged);
    let shown = if count <= listed { count } else { listed - 1 };
    let more = (shown < count)
        .then(|| format!("... {} more, all of them in --format json", count - LISTED));
    Impacts {
        heading: format!("Impacts: {count}{beside}"),
        head,
        rows: (0..shown).flat_map(rows_of).collect(),
        last: match more.is_some() && !judged {
            true => rows_of(count - 1),
            false => vec![],
        },
        more,
    }
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

/// The rest of a run: when it is reached, and what the barrier contributes.
pub(super) struct Rest {
    /// The definition of rest.
    pub(super) heading: String,
    /// The times, each with its name.
    pub(super) times: Vec<(&'static str, String)>,
    /// The sentences that follow from them.
    pub(super) sentences: Vec<String>,
}

/// The rest time of a run, those without a barrier and with a lossless one, and their differences.
pub(super) fn rest(report: &Report) -> Rest {
    let rest = report.motion.rest();
    let seconds = |time: f64| match report.units {
        Some(units) => format!(", {} s", decimal(time * units.time())),
        None => String::new(),
    };
    let about = match rest.place {
        0.0 => String::new(),
        place => format!(" about the place of rest, x = {}", decimal(place)),
    };
    let heading = match rest.amplitude {
        0.0 => "Rest".to_owned(),
        amplitude => format!("Rest: 10 % of the amplitude {}{about}", decimal(amplitude)),
    };
    let own = match rest.time {
        Ok(time) => {
            format!("{}{}   (envelope of the turning points)", decimal(time), seconds(time))
        }
        Err(reason) => format!("none: {reason}"),
    };
    let (mut times, mut sentences) = (vec![("rest time", own)], Vec::new());
    if let (Integrator::Chain, Some(judge)) = (report.motion.integrator, report.judge) {
        let integrated = chain::rest_time_comparison(rest.time, judge.rest().time);
        times.push(("integrated", integrated));
    }
    if let Some(last) = rest.last_crossing {
        times.push(("last crossing", decimal(last)));
    }
    let Some(Baseline { no_barrier, lossless_barrier, geometry }) = report.baseline else {
        return Rest { heading, times, sentences };
    };
    let written = |time: &Result<f64, NoRest>| match time {
        Ok(time) => decimal(*time),
        Err(reason) => format!("none: {reason}"),
    };
    times.push(("no barrier", written(no_barrier)));
    times.push(("lossless", format!("{}   (mu = 0)", written(lossless_barrier))));
    if let (Ok(none), Ok(lossless), Ok(this)) = (no_barrier, lossless_barrier, rest.time) {
        sentences.push(format!(
            "of the {} that the barrier saves, {} by the shorter swing and {} by the loss in contact",
            decimal(none - this),
            decimal(none - lossless),
            decimal(lossless - this)
        ));
    }
    if let Some(Geometry { first_swing, at_rest, gain }) = geometry {
        let (letters, numbers) = match *at_rest == 1.0 {
            true => ("S/Sc".to_owned(), decimal(*first_swing)),
            false => (
                "(S/Sc)/(s/sc)".to_owned(),
                format!("{}/{}", decimal(*first_swing), decimal(*at_rest)),
            ),
        };
        sentences.push(format!(
            "the shorter swing by formula: ln({letters})/(2*zeta) = ln({numbers})/(2*zeta) = {}",
            decimal(*gain)
        ));
        let rested = if *at_rest == 1.0 { "" } else { ", s and sc those at rest" };
        sentences.push(format!(
            "S and Sc are the actions of the first swing, whole and cut at the barrier{rested}"
        ));
    }
    Rest { heading, times, sentences }
}

/// The energy balance: names, numbers, and words behind a number. It is empty for a chain, whose
/// formulas give the energy only at the ends of each phase; within a phase their velocities do not
/// satisfy the energy balance.
pub(super) fn energy(motion: &Simulation) -> Vec<(&'static str, String, &'static str)> {
    if motion.integrator == Integrator::Chain {
        return vec![];
    }
    let book = motion.energy();
    let model = &motion.model;
    let entries = [
        ("at the start", book.start, true),
        ("viscous", book.viscous, model.zeta != 0.0),
        ("friction", book.friction, model.alpha != 0.0),
        ("contact", book.contact, model.mu != 0.0),
        ("excitation", book.excitation, model.beta != 0.0),
        ("at the end", book.end, true),
    ];
    let shown = entries.into_iter().filter(|(.., shown)| *shown);
    let residual = ("residual", size(book.residual), "   of the largest energy");
    shown.map(|(name, value, _)| (name, decimal(value), "")).chain([residual]).collect()
}

/// The states at the requested times.
pub(super) fn states(report: &Report) -> Vec<Vec<String>> {
    let row = |time: &f64| {
        let mut cells = vec![decimal(*time)];
        match report.motion.path.phase_point_at(*time) {
            Some((x, velocity)) => cells.extend([x, velocity].map(|value| significant(value, 10))),
            None => cells.push("not reached".to_owned()),
        }
        cells
    };
    report.samples.iter().map(row).collect()
}

/// The last state, and how the run came there.
pub(super) fn end(motion: &Simulation) -> [String; 2] {
    [
        format!(
            "At t = {}: x = {}, x' = {}",
            decimal(motion.end_time),
            significant(motion.end_x, 10),
            significant(motion.end_velocity, 10)
        ),
        format!("{} in {} steps; {}", method(motion), motion.steps, motion.stop),
    ]
}

/// The comparison with the other integrator: its name, the difference, and its own run. `None` if
/// there is no other.
pub(super) fn beside(report: &Report) -> Option<[String; 3]> {
    let (motion, judge) = (report.motion, report.judge?);
    let difference = motion.difference(judge, COMPARED);
    // For a chain the difference would be dominated by touches at slightly different times.
    let in_velocity = match motion.integrator {
        Integrator::Chain => String::new(),
        _ => format!(", in x' {}", size(difference.velocity)),
    };
    Some([
        format!("Beside {}, {} steps", method(judge), judge.steps),
        format!(
            "largest difference in x {}{in_velocity}, until t = {}",
            size(difference.displacement),
            decimal(difference.until)
        ),
        format!(
            "impacts {}, energy residual {}; {}",
            judge.impacts.len(),
            size(judge.energy().residual),
            judge.stop
        ),
    ])
}

/// The heading of each column of a sweep: the parameters, then the results.
pub(super) fn sweep_head(report: &SweepReport) -> Vec<String> {
    let beside: &[&str] = if report.has_baseline() { &["no barrier", "lossless"] } else { &[] };
    let parameters = report.axes.iter().map(|axis| axis.name());
    let names = parameters.chain(["impacts", "rest time"]).chain(beside.iter().copied());
    let names = names.chain(["penetration", "speed in", "energy lost", "stopped at"]);
    names.map(str::to_owned).collect()
}

/// The cells of one motion of a sweep; dashes for results of a motion that was never begun.
pub(super) fn sweep_row(report: &SweepReport, row: usize, summary: &Summary) -> Vec<String> {
    let written = |time: Result<f64, NoRest>| time.map_or("-".to_owned(), decimal);
    let mut cells: Vec<String> = report.values(row).into_iter().map(decimal).collect();
    cells.push(match summary.is_begun() {
        true => summary.impacts.to_string(),
        false => "-".to_owned(),
    });
    cells.push(written(summary.rest_time));
    cells.extend(summary.baseline.into_iter().flatten().map(written));
    let lost = if summary.energy_lost.abs() < 1e-9 { 0.0 } else { summary.energy_lost };
    cells.extend(match summary.is_begun() {
        true => [summary.deepest, summary.fastest, lost, summary.end_time].map(decimal),
        false => [(); 4].map(|()| "-".to_owned()),
    });
    cells
}
