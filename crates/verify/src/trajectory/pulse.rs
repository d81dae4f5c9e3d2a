//! Short pulses of a drive: the times at which a step has to end, so that no integrator steps over
//! one.
//!
//! ```text
//! F(t) = exp(-((t - s)/w)^2), tanh((t - s)/w), ...      s +- 2 w, 4 w, 8 w, ..., half the way to the next pulse
//! ```
//!
//! An integrator samples the drive only along its step and may miss a pulse. The expression tells
//! where a pulse is and how wide.

use std::collections::BTreeMap;

use crate::conservative::features::{Feature, Features};
use crate::expr::{Expr, Function, Node};
use crate::symbol::Symbol;

/// Number of widths beyond which a pulse vanishes in double precision: from there on steps may grow
/// faster.
const FAR: f64 = 32.0;

/// The times between zero and the duration at which a step has to end, in order. Waves alone,
/// `cos(W*t)`, have none: no step can miss them.
pub(super) fn critical_times(
    right: &[Expr],
    states: &[Symbol],
    values: &BTreeMap<Symbol, f64>,
    duration: f64,
) -> Vec<f64> {
    let time = Symbol::new("t");
    let mut drives = Vec::new();
    let mut open: Vec<&Expr> = right.iter().collect();
    while let Some(expr) = open.pop() {
        if !expr.contains(time) {
            continue;
        }
        let alone = !states.iter().any(|state| expr.contains(*state));
        match alone && may_be_short(expr) {
            true if !drives.contains(expr) => drives.push(expr.clone()),
            true => {}
            false => open.extend(expr.children()),
        }
    }
    let mut pulses: Vec<Feature> = drives
        .iter()
        .flat_map(|drive| Features::new(drive, time, values).between(0.0, duration))
        .filter(|pulse| pulse.width > 0.0 && pulse.width < duration / 16.0 && !pulse.singular)
        .collect();
    pulses.sort_by(|one, other| one.place.total_cmp(&other.place));
    let mut times = Vec::new();
    for (index, pulse) in pulses.iter().enumerate() {
        let width = pulse.width.max(1e-13 * duration);
        let before = index.checked_sub(1).map(|index| pulses[index].place);
        let behind = pulses.get(index + 1).map(|next| next.place);
        times.push(pulse.place);
        for (side, neighbour) in [(-1.0, before), (1.0, behind)] {
            let reach =
                neighbour.map_or(duration, |neighbour| 0.5 * (neighbour - pulse.place).abs());
            let mut distance = 2.0 * width;
            while distance < reach {
                times.push(pulse.place + side * distance);
                distance *= if distance < FAR * width { 2.0 } else { 4.0 };
            }
        }
    }
    times.retain(|place| 0.0 < *place && *place < duration);
    times.sort_by(f64::total_cmp);
    times.dedup_by(|second, first| (*second - *first).abs() <= 1e-14 * duration);
    times
}

/// Whether a function of time may differ from a constant for a short time only. Waves, corners
/// (which end a step by themselves) and sums vary no faster than their arguments.
fn may_be_short(expr: &Expr) -> bool {
    use Function::{Absolute, Cos, Maximum, Minimum, Sign, Sin, Step, Tan};
    match expr.node() {
        Node::Function(function, _) => {
            ![Absolute, Cos, Maximum, Minimum, Sign, Sin, Step, Tan].contains(function)
        }
        Node::Power(..) => true,
        _ => false,
    }
}
