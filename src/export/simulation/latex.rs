//! A chain of closed forms as LaTeX: its contacts with their errors, and the formula of every
//! phase.

use std::fmt::Write as _;

use super::{Report, chain};
use crate::decimal::significant;
use crate::export::latex::{LatexTable, scientific, words};
use crate::impact::{ClosedForm, ContactRecord, PathSegment};

/// Largest number of phases of a block of formulas, which must fit a page because a block does not
/// break.
const PHASES: usize = 12;

/// The contacts and the phases of a chain.
///
/// ```
/// use lindstedt::export::simulation::{Report, latex};
/// use lindstedt::impact::{Case, Integrator, Settings, simulate};
///
/// let (model, start) = Case { zeta: 0.05, ..Case::default() }.motion()?;
/// let motion = simulate(&model, start, Integrator::Chain, &Settings::default())?;
/// let report = Report { motion: &motion, judge: None, sources: ["given", "given"], tolerance: 1e-10, samples: &[], baseline: None, dissipation: None, units: None, known_until: None };
/// assert!(latex(&report).contains("\\operatorname{sn}"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn simulation(report: &Report) -> String {
    let motion = report.motion;
    let mut text = String::new();
    if !motion.impacts.is_empty() {
        text.push_str(&impacts(report));
        text.push('\n');
    }
    text.push_str("% In each line t counts from the beginning of the phase; the second argument of sn is m = k^2.\n");
    for pieces in chain::phases(motion).chunks(PHASES) {
        let lines: Vec<String> = pieces.iter().map(phase).collect();
        let _ = writeln!(text, "\\begin{{align*}}\n{}\n\\end{{align*}}", lines.join(" \\\\\n"));
    }
    let _ = match motion.rest().time {
        Ok(time) => writeln!(text, "\\[ t_{{\\text{{rest}}}} = {} \\]", scientific(time)),
        Err(reason) => {
            writeln!(text, "\\noindent no rest time: {}", words(&reason.to_string()))
        }
    };
    text
}

fn impacts(report: &Report) -> String {
    let motion = report.motion;
    let errors = report.judge.map_or_else(Vec::new, |judge| motion.contact_deviations(judge));
    let judged = !errors.is_empty();
    let number = |value: f64| format!("${}$", scientific(value));
    let percent = |error: f64| format!("${}\\,\\%$", scientific((1e5 * error).round() / 1e3));
    let row = |(index, impact): (usize, &ContactRecord)| {
        let error = errors.get(index).copied().flatten();
        let cells = [
            (impact.entry_time, error.map(|e| number((1e6 * e.entry_time).round() / 1e6))),
            (impact.speed_in, error.and_then(|e| e.speed_in).map(percent)),
            (impact.penetration, error.and_then(|e| e.penetration).map(percent)),
        ];
        let cells = cells.into_iter().flat_map(|(value, error)| {
            std::iter::once(number(value)).chain(judged.then(|| error.unwrap_or_default()))
        });
        std::iter::once((index + 1).to_string()).chain(cells).collect()
    };
    let head = ["impact", "$t$", "error", "speed in", "error", "penetration", "error"].into_iter();
    let head: Vec<String> =
        head.filter(|name| judged || *name != "error").map(str::to_owned).collect();
    let table = LatexTable {
        places: "r".repeat(head.len()),
        head,
        rows: motion.impacts.iter().enumerate().map(row).collect(),
        framed: false,
    };
    table.written()
}

/// The rows of a phase: its time, and its formula below.
fn phase(piece: &PathSegment) -> String {
    let [start, end] = [piece.start, piece.end].map(|time| significant(time, 6));
    let formula = match piece.closed_form() {
        None => "\\text{no closed form}".to_owned(),
        // In one line the formulas of contacts would be wider than a page.
        Some(form) => format!("x = {}", formula(form).join(" \\\\\n&\\qquad\\quad")),
    };
    format!("&{start} \\le t_0 + t \\le {end}: \\\\\n&\\quad {formula}")
}

/// Phases as a table of two times and a formula each.
pub(in crate::export) fn phases(pieces: &[PathSegment]) -> LatexTable {
    let row = |piece: &PathSegment| {
        let times = [piece.start, piece.end].map(|time| significant(time, 8));
        let words = || chain::without_formula(piece.regime).to_owned();
        let formula =
            piece.closed_form().map_or_else(words, |form| format!("${}$", formula(form).concat()));
        times.into_iter().chain([formula]).collect()
    };
    LatexTable {
        places: "rrl".to_owned(),
        head: ["from", "to", "$x(t)$"].map(str::to_owned).to_vec(),
        rows: pieces.iter().map(row).collect(),
        framed: false,
    }
}

/// A closed form in the parts that each fit a line of a page.
fn formula(form: ClosedForm) -> Vec<String> {
    let signed = |value: f64| match value < 0.0 {
        true => format!(" - {}", scientific(-value)),
        false => format!(" + {}", scientific(value)),
    };
    match form {
        ClosedForm::Swing { sign, modulus, rate, speed, phase, parameter } => {
            let minus = if sign < 0.0 { "-" } else { "" };
            let decay = match rate == 0.0 {
                true => String::new(),
                false => format!("\\,e^{{{} t}}", scientific(-rate)),
            };
            let speed = match scientific(speed) {
                one if one == "1" => String::new(),
                speed => format!("{speed} "),
            };
            vec![format!(
                "{minus}2 \\arcsin\\left({}{decay} \\operatorname{{sn}}\\left({speed}t{},\\, {}\\right)\\right)",
                scientific(modulus),
                signed(phase),
                scientific(parameter)
            )]
        }
        ClosedForm::Contact { barrier, duration, sines } => {
            let wave = std::f64::consts::PI / duration;
            let term = |(j, sine): (u32, f64)| match sine == 0.0 {
                true => String::new(),
                false => format!("{} \\sin({} t)", signed(sine), scientific(f64::from(j) * wave)),
            };
            let [first, second, third] = sines;
            let mut parts = vec![format!("{}{}", scientific(barrier), term((1, first)))];
            parts.extend(
                Some(term((2, second)) + &term((3, third))).filter(|part| !part.is_empty()),
            );
            parts
        }
    }
}
