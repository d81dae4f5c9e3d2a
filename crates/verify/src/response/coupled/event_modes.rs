//! Modes: states that change at events alone, among finitely many values, such as the latch of an escapement.
//!
//! ```text
//! m' = 0;   at an event  m -> r(m)       values: all that follow from the numbers to which m is set, or from 0
//! ```
//!
//! A mode that is set from itself, as `m = 1 - m`, has the values that follow from 0: here 0 and 1. Where 0 stays 0, as
//! for `m = -m`, they are those that follow from 1. A motion closes if its modes come back to the values that they
//! had, and beside a motion there is none with other values: a mode has no multiplier.
//!
//! In: states, rates and events. Out: the modes with their values.

use std::collections::BTreeMap;

use crate::event::StateEvent;
use crate::expr::{Expr, ExprError};
use crate::symbol::Symbol;

/// Largest number of values that modes have together.
const MOST_VALUES: usize = 64;

/// Difference between two values below which they are one.
const SAME: f64 = 1e-9;

/// The modes of a system.
#[derive(Clone, Debug)]
pub(super) struct EventModes {
    /// The indices of the modes among the states.
    indices: Vec<usize>,
    /// The values that they have together.
    values: Vec<Vec<f64>>,
}

/// Whether two values of the modes are one.
fn is_same(one: &[f64], other: &[f64]) -> bool {
    one.iter().zip(other).all(|(one, other)| (one - other).abs() <= SAME * (1.0 + other.abs()))
}

impl EventModes {
    /// Finds the modes; `None` if there are none, or if they have more values than are treated together.
    pub(super) fn new(states: &[Symbol], right: &[Expr], events: &[StateEvent]) -> Option<Self> {
        let at_rest = states.iter().zip(right).filter(|(_, rate)| rate.is_zero());
        let mut modes: Vec<Symbol> = at_rest.map(|(state, _)| *state).collect();
        let assignments = || events.iter().flat_map(|event| &event.assignments);
        // A state that is set to what is no mode is none.
        loop {
            let is_mode = |state: &Symbol| {
                let mut set = assignments().filter(|(name, _)| name == state).peekable();
                set.peek().is_some()
                    && set.all(|(_, value)| value.symbols().iter().all(|name| modes.contains(name)))
            };
            let left: Vec<Symbol> = modes.iter().copied().filter(is_mode).collect();
            if left.len() == modes.len() {
                break;
            }
            modes = left;
        }
        if modes.is_empty() {
            return None;
        }
        let numbers = |mode: &Symbol| -> Vec<f64> {
            let set = assignments().filter(|(name, _)| name == mode);
            set.filter_map(|(_, value)| value.evaluate(&BTreeMap::new()).ok()).collect()
        };
        let known: Vec<Vec<f64>> = modes.iter().map(numbers).collect();
        let found = [0.0, 1.0].into_iter().find_map(|first| {
            let begin = known.iter().map(|values| match values.is_empty() {
                true => vec![first],
                false => values.clone(),
            });
            let values = reached(&modes, events, begin.collect())?;
            // A value that no event changes says nothing of the others.
            let is_changed = |index: usize| {
                !known[index].is_empty()
                    || values.iter().any(|value| (value[index] - first).abs() > SAME)
            };
            (first == 1.0 || (0..modes.len()).all(is_changed)).then_some(values)
        })?;
        let index = |mode: &Symbol| states.iter().position(|state| state == mode);
        Some(Self { indices: modes.iter().filter_map(index).collect(), values: found })
    }

    /// The start with the nearest values of the modes.
    pub(super) fn nearest(&self, start: &[f64]) -> Vec<f64> {
        let distance = |values: &&Vec<f64>| -> f64 {
            let parts = self.indices.iter().zip(values.iter());
            parts.map(|(index, value)| (start[*index] - value).powi(2)).sum()
        };
        let mut nearest = start.to_vec();
        let values =
            self.values.iter().min_by(|one, other| distance(one).total_cmp(&distance(other)));
        for (index, value) in self.indices.iter().zip(values.into_iter().flatten()) {
            nearest[*index] = *value;
        }
        nearest
    }

    /// The start with one of the values of the modes, by a number that counts round.
    pub(super) fn set(&self, start: &mut [f64], count: usize) {
        for (index, value) in self.indices.iter().zip(&self.values[count % self.values.len()]) {
            start[*index] = *value;
        }
    }

    /// Whether the modes have the same values in two states.
    pub(super) fn agree(&self, one: &[f64], other: &[f64]) -> bool {
        let of = |state: &[f64]| -> Vec<f64> { self.indices.iter().map(|i| state[*i]).collect() };
        is_same(&of(one), &of(other))
    }

    /// The indices of the modes among the states.
    pub(super) fn indices(&self) -> &[usize] {
        &self.indices
    }

    /// Each mode with its values in increasing order.
    pub(super) fn values_of_states(&self, states: &[Symbol]) -> Vec<(Symbol, Vec<f64>)> {
        let of_mode = |(position, index): (usize, &usize)| {
            let mut values: Vec<f64> = self.values.iter().map(|values| values[position]).collect();
            values.sort_by(f64::total_cmp);
            values.dedup_by(|one, other| is_same(&[*one], &[*other]));
            (states[*index], values)
        };
        self.indices.iter().enumerate().map(of_mode).collect()
    }
}

/// A state without a rate that an event sets to what it was and a constant more, with that value; `None` without one.
///
/// # Errors
/// A failed step of algebra.
pub(super) fn endless(
    states: &[Symbol],
    right: &[Expr],
    events: &[StateEvent],
) -> Result<Option<(Symbol, Expr)>, ExprError> {
    let is_at_rest = |name: &Symbol| {
        states.iter().zip(right).any(|(state, rate)| state == name && rate.is_zero())
    };
    for (state, value) in events.iter().flat_map(|event| &event.assignments) {
        let more = (value - &Expr::from(*state)).expand()?;
        let is_constant = !states.iter().any(|name| more.contains(*name));
        if is_at_rest(state) && is_constant && !more.contains(Symbol::new("t")) && !more.is_zero() {
            return Ok(Some((*state, value.clone())));
        }
    }
    Ok(None)
}

/// All values of the modes to which the events lead from these of each; `None` if they are too many.
fn reached(modes: &[Symbol], events: &[StateEvent], begin: Vec<Vec<f64>>) -> Option<Vec<Vec<f64>>> {
    let mut found: Vec<Vec<f64>> = vec![vec![]];
    for values in begin {
        let longer = |one: &Vec<f64>| {
            let one = one.clone();
            values.clone().into_iter().map(move |value| [one.clone(), vec![value]].concat())
        };
        found = found.iter().flat_map(longer).collect();
        if found.len() > MOST_VALUES {
            return None;
        }
    }
    let mut next = 0;
    while next < found.len() {
        let here: BTreeMap<Symbol, f64> =
            modes.iter().copied().zip(found[next].iter().copied()).collect();
        for event in events {
            let set = |(mode, value): (&Symbol, &f64)| {
                let assigned = event.assignments.iter().find(|(name, _)| name == mode);
                assigned.map_or(Some(*value), |(_, to)| to.evaluate(&here).ok())
            };
            let after: Vec<f64> = modes.iter().zip(&found[next]).map(set).collect::<Option<_>>()?;
            if !found.iter().any(|known| is_same(known, &after)) {
                found.push(after);
            }
        }
        if found.len() > MOST_VALUES {
            return None;
        }
        next += 1;
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modes_have_the_values_to_which_events_lead() {
        let states: Vec<Symbol> = ["x", "m", "n"].map(Symbol::new).to_vec();
        let right = ["m - x", "0", "0"].map(|text| text.parse::<Expr>().expect(text));
        let of = |events: &[&str]| {
            let events: Vec<StateEvent> =
                events.iter().map(|text| StateEvent::parse(text, &states).expect(text)).collect();
            EventModes::new(&states, &right, &events).map(|modes| modes.values_of_states(&states))
        };
        let [m, n] = [Symbol::new("m"), Symbol::new("n")];
        assert_eq!(of(&["x > 1: m = 1 - m"]), Some(vec![(m, vec![0.0, 1.0])]));
        assert_eq!(of(&["x > 1: m = -m"]), Some(vec![(m, vec![-1.0, 1.0])]));
        assert_eq!(of(&["x > 1: m = 2", "x < 0: m = -m"]), Some(vec![(m, vec![-2.0, 2.0])]));
        // Neither a count without end, nor a sample of what moves.
        assert_eq!(of(&["x > 1: m = m + 1"]), None);
        assert_eq!(of(&["x > 1: m = x/2"]), None);
        assert_eq!(of(&["x > 1: m = n; n = x"]), None);
        let three = vec![(m, vec![0.0, 1.0, 2.0]), (n, vec![5.0])];
        assert_eq!(of(&["x > 1: m = m*(5 - 3*m)/2 + 1; n = 5"]), Some(three));
    }
}
