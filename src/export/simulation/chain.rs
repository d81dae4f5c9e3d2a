//! The formulas of a chain of closed forms, as part of a simulation.

use std::fmt::Write as _;

use super::text::LISTED;
use crate::decimal::{decimal, significant};
use crate::export::text::percent;
use crate::impact::{NoRest, PathSegment, Regime, Simulation};

/// The phases of a chain: consecutive steps of an integration form one phase, which has no formula.
pub(in crate::export) fn phases(motion: &Simulation) -> Vec<PathSegment> {
    let integrated =
        |piece: &PathSegment| piece.closed_form().is_none() && piece.regime != Regime::Stuck;
    let mut phases: Vec<PathSegment> = Vec::new();
    for piece in motion.path.pieces() {
        match phases.last_mut() {
            Some(last) if integrated(last) && integrated(piece) => last.end = piece.end,
            _ => phases.push(*piece),
        }
    }
    phases
}

/// The meaning of the formulas of the phases.
pub(super) const MEANING: &str =
    "x(t) with t from the beginning of each, sn(u, m) Jacobi's with the parameter m = k^2";

/// The phases that are listed, and words for those that are left out; `None` if there are none.
pub(super) fn listed(motion: &Simulation) -> (Vec<PathSegment>, Option<String>) {
    let mut pieces = phases(motion);
    let count = pieces.len();
    if count <= 2 * LISTED + 1 {
        return (pieces, None);
    }
    pieces.truncate(2 * LISTED);
    let more = format!("... {} more, all of them in --format json", count - 2 * LISTED);
    (pieces, Some(more))
}

/// The formula of every phase.
pub(super) fn formulas(text: &mut String, motion: &Simulation) {
    let (pieces, more) = listed(motion);
    let _ = writeln!(text, "\nPhases: {}; {MEANING}", phases(motion).len());
    text.push_str(&phase_lines(&pieces));
    if let Some(more) = more {
        let _ = writeln!(text, "   {more}");
    }
}

/// Phases as lines of text: two times and a formula each.
pub(in crate::export) fn phase_lines(pieces: &[PathSegment]) -> String {
    let head = format!("  {:>12}  {:>12}\n", "from", "to");
    let line = |piece: &PathSegment| {
        let [start, end] = [piece.start, piece.end].map(|time| significant(time, 8));
        format!("  {start:>12}  {end:>12}  {}\n", formula(piece))
    };
    head + &pieces.iter().map(line).collect::<String>()
}

/// The formula of one phase, or words for a phase without one.
pub(super) fn formula(piece: &PathSegment) -> String {
    match (piece.closed_form(), piece.regime) {
        (Some(form), _) => format!("x(t) = {form}"),
        (None, regime) => without_formula(regime).to_owned(),
    }
}

/// The words for a phase without a formula.
pub(super) fn without_formula(regime: Regime) -> &'static str {
    match regime {
        Regime::Stuck => "at rest",
        _ => "by Taylor series: this part has no closed form",
    }
}

/// A rest time compared with that of the chain.
pub(super) fn rest_time_comparison(
    chain: Result<f64, NoRest>,
    integrated: Result<f64, NoRest>,
) -> String {
    match (chain, integrated) {
        (Ok(chain), Ok(truth)) => {
            format!("{}, by which the chain errs {}", decimal(truth), percent(chain / truth - 1.0))
        }
        (_, Ok(truth)) => decimal(truth),
        (_, Err(reason)) => format!("none: {reason}"),
    }
}
