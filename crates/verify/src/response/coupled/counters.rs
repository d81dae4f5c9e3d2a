//! States that only count: a number of events, a sum over them, the time of the last one.
//!
//! ```text
//! m' = 0;   at an event  m -> r(m, q, q', t)        m in no rate, no wall, and no guard or reset of a state that is in one
//! ```
//!
//! Such a state has no influence on the motion, and need not come back after a period: `m = m + 1` never does, and
//! `m = 1 - m` makes of a motion with one event in a period one of two. It is left out of the equations, and the
//! motions are those of the other states. Its change is followed beside them.
//!
//! In: a request of coupled equations with events. Out: the request without these states and without the events
//! that set nothing else.

use std::collections::{BTreeMap, BTreeSet};

use super::judged::TimedEquations;
use crate::coupled::CoupledEquations;
use crate::event::StateEvent;
use crate::expr::Expr;
use crate::response::{Equations, ResponseError, ResponseRequest};
use crate::symbol::Symbol;

/// The states that only count, and the equations with them.
#[derive(Clone, Debug)]
pub(super) struct Counters {
    /// The states, in the order of the coordinates.
    pub(super) names: Vec<Symbol>,
    /// All equations, with numbers for all parameters but one.
    equations: TimedEquations,
    /// The parameter that varies.
    parameter: Symbol,
}

/// A request without its counters.
pub(super) struct RequestWithoutCounters {
    pub(super) request: ResponseRequest,
    pub(super) equations: CoupledEquations,
    pub(super) counters: Counters,
}

/// The states that only count.
fn find(question: &ResponseRequest, equations: &CoupledEquations) -> Vec<Symbol> {
    let rates = || equations.rates.states.iter().zip(&equations.rates.right);
    let moving = rates().filter(|(_, rate)| !rate.is_zero()).map(|(state, _)| *state);
    let mut needed: BTreeSet<Symbol> = moving.collect();
    let of_walls = question.walls.iter().flat_map(|wall| [&wall.gap, &wall.restitution]);
    needed.extend(rates().map(|(_, rate)| rate).chain(of_walls).flat_map(Expr::symbols));
    loop {
        let before = needed.len();
        for event in &question.events {
            let set: Vec<_> =
                event.assignments.iter().filter(|(state, _)| needed.contains(state)).collect();
            if !set.is_empty() {
                needed.extend(event.guard.symbols());
                needed.extend(set.into_iter().flat_map(|(_, value)| value.symbols()));
            }
        }
        if needed.len() == before {
            break;
        }
    }
    let is_counter = |name: &Symbol| !needed.contains(name);
    equations.coordinates.iter().copied().filter(is_counter).collect()
}

/// The equations of the other coordinates; `None` if those of the counters are not apart from them, or if there
/// are no others.
fn other_equations(
    equations: &CoupledEquations,
    counters: &[Symbol],
) -> Result<Option<CoupledEquations>, ResponseError> {
    let is_counted: Vec<bool> =
        equations.coordinates.iter().map(|name| counters.contains(name)).collect();
    let mut others = Vec::new();
    let at_rest: BTreeMap<Symbol, Expr> =
        counters.iter().map(|name| (name.derivative(), Expr::zero())).collect();
    for ((left, right), row) in equations.equations.iter().zip(&equations.matrix) {
        let of_others = row.iter().zip(&is_counted).filter(|(_, counted)| !**counted);
        if { of_others }.any(|(entry, _)| !entry.is_zero()) {
            others.push((left.substitute_all(&at_rest)?, right.substitute_all(&at_rest)?));
        }
    }
    if others.is_empty() || others.len() + counters.len() != equations.coordinates.len() {
        return Ok(None);
    }
    let energy = equations.energy.clone();
    let order = equations.coordinates.iter().filter(|name| !counters.contains(name));
    let found = CoupledEquations::new(others).ok();
    let found = found.filter(|found| found.coordinates.iter().eq(order));
    Ok(found.map(|found| CoupledEquations { energy, ..found }))
}

/// States and rates in which a counter has a velocity, of zero, since an impact sets the velocities of all
/// coordinates.
fn with_velocities(equations: &CoupledEquations, counters: &[Symbol]) -> (Vec<Symbol>, Vec<Expr>) {
    let rates = &equations.rates;
    let rate = |state: &Symbol| {
        let known = rates.states.iter().position(|other| other == state);
        known.map_or_else(Expr::zero, |index| rates.right[index].clone())
    };
    let places = equations.coordinates.iter().map(|name| match counters.contains(name) {
        true => (*name, Expr::from(name.derivative())),
        false => (*name, rate(name)),
    });
    let is_second = |velocity: &Symbol| {
        counters.contains(&velocity.coordinate()) || rates.states.contains(velocity)
    };
    let velocities = equations.coordinates.iter().map(|name| name.derivative()).filter(is_second);
    let velocities = velocities.map(|velocity| (velocity, rate(&velocity)));
    places.chain(velocities).unzip()
}

impl RequestWithoutCounters {
    /// Leaves the counters out of a request; `None` if there are none.
    ///
    /// # Errors
    /// [`ResponseError`] for a parameter without a value that stands only where they are set, or one that varies
    /// there alone.
    pub(super) fn new(
        question: &ResponseRequest,
        equations: &CoupledEquations,
    ) -> Result<Option<Self>, ResponseError> {
        let names = find(question, equations);
        if names.is_empty() {
            return Ok(None);
        }
        let Some(others) = other_equations(equations, &names)? else { return Ok(None) };
        let of_others = |event: &StateEvent| {
            let set = event.assignments.iter().filter(|(state, _)| !names.contains(state));
            let assignments: Vec<_> = set.cloned().collect();
            (!assignments.is_empty()).then(|| StateEvent { assignments, ..event.clone() })
        };
        let mut request = ResponseRequest {
            equations: Equations::Coupled(others.clone()),
            events: question.events.iter().filter_map(of_others).collect(),
            ..question.clone()
        };
        let (all, left) = (question.parameters(), request.parameters());
        let counting: Vec<Symbol> = all.into_iter().filter(|name| !left.contains(name)).collect();
        if counting.contains(&question.parameter) {
            return Err(ResponseError::OnlyCounts {
                parameter: question.parameter,
                counters: names,
            });
        }
        let has_none = |name: &Symbol| question.values.get(*name).is_none();
        let missing: Vec<Symbol> = counting.iter().copied().filter(has_none).collect();
        if !missing.is_empty() {
            return Err(ResponseError::Missing(missing));
        }
        request.values = question.values.split(&counting).1;
        let values = question.values.split(&question.parameters()).0;
        let with_values = |expression: &Expr| expression.substitute_all(&values);
        let row = |row: &Vec<Expr>| row.iter().map(with_values).collect::<Result<_, _>>();
        let mut walls = question.walls.clone();
        for wall in &mut walls {
            wall.gap = with_values(&wall.gap)?;
            wall.restitution = with_values(&wall.restitution)?;
        }
        let events = question.events.iter().map(|event| event.substitute_all(&values));
        let (states, right) = match walls.is_empty() {
            true => (equations.rates.states.clone(), equations.rates.right.clone()),
            false => with_velocities(equations, &names),
        };
        let timed = TimedEquations {
            states,
            coordinates: equations.coordinates.len(),
            right: row(&right)?,
            mass: equations.matrix.iter().map(row).collect::<Result<_, _>>()?,
            walls,
            events: events.collect::<Result<_, _>>()?,
        };
        let counters = Counters { names, equations: timed, parameter: question.parameter };
        Ok(Some(Self { request, equations: others, counters }))
    }
}

impl Counters {
    /// The counters a duration after a time at which they are zero, and the other states are these; empty if the
    /// motion cannot be followed.
    pub(super) fn after_period(
        &self,
        others: (&[Symbol], &[f64]),
        times: [f64; 2],
        parameter: f64,
    ) -> Vec<f64> {
        let value = |state: &Symbol| {
            let known = others.0.iter().position(|other| other == state);
            known.map_or(0.0, |index| others.1[index])
        };
        let states = &self.equations.states;
        let start = states.iter().map(value).collect();
        let values = [(self.parameter, parameter)].into();
        let motion = self.equations.clone().motion(start, times, values);
        let Some(end) = motion.and_then(|motion| motion.states_at(times[1])) else {
            return vec![];
        };
        let of_counter =
            |(state, value): (&Symbol, f64)| self.names.contains(state).then_some(value);
        states.iter().zip(end).filter_map(of_counter).collect()
    }
}
