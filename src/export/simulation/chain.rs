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

/// The formula of every phase.
pub(super) fn formulas(text: &mut String, motion: &Simulation) {
    let pieces = phases(motion);
    let _ = writeln!(
        text,
        "\nPhases: {}; x(t) with t from the beginning of each, sn(u, m) Jacobi's with the parameter m = k^2",
        pieces.len()
    );
    let _ = writeln!(text, "  {:>12}  {:>12}", "from", "to");
    for (index, piece) in pieces.iter().enumerate() {
        if index == 2 * LISTED && index + 1 < pieces.len() {
            let _ = writeln!(
                text,
                "   ... {} more, all of them in --format json",
                pieces.len() - index
            );
            break;
        }
        let _ = writeln!(
            text,
            "  {:>12}  {:>12}  {}",
            significant(piece.start, 8),
            significant(piece.end, 8),
            formula(piece)
        );
    }
}

/// The formula of one phase, or words for a phase without one.
pub(super) fn formula(piece: &PathSegment) -> String {
    match (piece.closed_form(), piece.regime) {
        (Some(form), _) => format!("x(t) = {form}"),
        (None, Regime::Stuck) => "at rest".to_owned(),
        (None, _) => "by Taylor series: this part has no closed form".to_owned(),
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
