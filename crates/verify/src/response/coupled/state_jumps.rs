//! Walls and events of a request as events of a flow, in time and in the phase of a drive.
//!
//! In: walls and events as they were asked for, and values. Out: gaps with the states behind each, the frequency of
//! what drives, and the coordinates that are angles.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use super::flow::Flow;
use super::surfaces::FlowEvent;
use crate::coupled::CoupledEquations;
use crate::event::StateEvent;
use crate::expr::{CompiledFunction, Expr};
use crate::response::driven::{drive_frequency, in_phase};
use crate::response::{ResponseError, ResponseRequest};
use crate::symbol::{Symbol, fresh};
use crate::wall::Wall;

/// The coordinates of which nothing but a sine or the like occurs, so that a turn of 2 pi changes nothing: by
/// values at places that are not special.
pub(super) fn angles(
    states: &[Symbol],
    right: &[Expr],
    events: &[FlowEvent],
    parameter: Symbol,
    coordinates: usize,
) -> Result<Vec<usize>, ResponseError> {
    const PLACES: usize = 5;
    const ROUNDING: f64 = 1e-11;
    let names: Vec<Symbol> = states.iter().copied().chain([Symbol::new("t"), parameter]).collect();
    let of_events = |event: &FlowEvent| {
        let set = event.after.iter().zip(states).map(|(after, state)| after - &Expr::from(*state));
        [event.gap.clone()].into_iter().chain(set).collect::<Vec<_>>()
    };
    let all = right.iter().cloned().chain(events.iter().flat_map(of_events));
    let all: Vec<CompiledFunction> =
        all.map(|part| CompiledFunction::new(&part, &names)).collect::<Result<_, _>>()?;
    let is_angle = |index: &usize| {
        (0..PLACES).all(|place| {
            let value = |k: usize| 0.1 + (0.618_034 * (place * names.len() + k + 1) as f64).fract();
            let here: Vec<f64> = (0..names.len()).map(value).collect();
            let mut turned = here.clone();
            turned[*index] += TAU;
            all.iter().all(|part| {
                let (one, other) = (part.call(&here), part.call(&turned));
                (one - other).abs() <= ROUNDING * (1.0 + one.abs())
            })
        })
    };
    Ok((0..coordinates).filter(is_angle).collect())
}

/// The frequency of the drive of right sides and events, and that of a motion of so many of its periods.
///
/// # Errors
/// [`ResponseError`] for a drive without one period.
pub(super) fn drive_of(
    right: &[Expr],
    events: &[FlowEvent],
    states: &[Symbol],
    periods: usize,
) -> Result<(Expr, Expr), ResponseError> {
    let of_events = events.iter().flat_map(|event| [&event.gap].into_iter().chain(&event.after));
    let timed: Vec<Expr> = right.iter().chain(of_events).cloned().collect();
    let frequency = drive_frequency(&timed, states)?;
    let periods = Expr::from(i64::try_from(periods).unwrap_or(1));
    let base = Expr::divide(&frequency, &periods)?;
    Ok((frequency, base))
}

/// The walls and events of a request with values for some of the parameters.
pub(super) struct StateJumps {
    pub(super) walls: Vec<Wall>,
    /// The mass matrix of the impacts.
    pub(super) mass: Vec<Vec<Expr>>,
    pub(super) events: Vec<StateEvent>,
    /// All of them with the states behind each.
    pub(super) flow_events: Vec<FlowEvent>,
}

impl StateJumps {
    /// The walls and events with these values.
    ///
    /// # Errors
    /// [`ResponseError`] for a coefficient of restitution outside 0 to 1, or a wall without a law of impact.
    pub(super) fn new(
        question: &ResponseRequest,
        equations: &CoupledEquations,
        values: &BTreeMap<Symbol, Expr>,
    ) -> Result<Self, ResponseError> {
        let (walls, mass) = with_numbers(question, equations, values)?;
        let events = question.events.iter().map(|event| event.substitute_all(values));
        let events: Vec<StateEvent> = events.collect::<Result<_, _>>()?;
        let states = &equations.rates.states;
        let of_wall = |wall| flow_wall(wall, &mass, states, &equations.coordinates);
        let mut flow_events: Vec<FlowEvent> =
            walls.iter().map(of_wall).collect::<Result<_, _>>()?;
        flow_events.extend(events.iter().flat_map(|event| flow_event(event, states)));
        Ok(Self { walls, mass, events, flow_events })
    }
}

/// The walls of a request and the mass matrix, with numbers for some of the parameters.
fn with_numbers(
    question: &ResponseRequest,
    equations: &CoupledEquations,
    values: &BTreeMap<Symbol, Expr>,
) -> Result<(Vec<Wall>, Vec<Vec<Expr>>), ResponseError> {
    let wall = |wall: &Wall| -> Result<Wall, ResponseError> {
        Ok(Wall {
            gap: wall.gap.substitute_all(values)?,
            restitution: wall.restitution.substitute_all(values)?,
        })
    };
    for wall in &question.walls {
        let mut numbers: BTreeMap<Symbol, f64> = question.values.numbers();
        for end in question.range {
            numbers.insert(question.parameter, end);
            wall.restitution_at(&numbers)?;
        }
    }
    let row = |row: &Vec<Expr>| row.iter().map(|entry| entry.substitute_all(values)).collect();
    let mass = equations.matrix.iter().map(row).collect::<Result<_, _>>()?;
    Ok((question.walls.iter().map(wall).collect::<Result<_, _>>()?, mass))
}

/// A wall with the states after an impact.
fn flow_wall(
    wall: &Wall,
    mass: &[Vec<Expr>],
    states: &[Symbol],
    coordinates: &[Symbol],
) -> Result<FlowEvent, ResponseError> {
    let impact = wall.impact(coordinates, states, Some(mass))?;
    let velocities = impact.velocities_after(coordinates, &wall.restitution)?;
    let has_velocity = |name: &Symbol| states.contains(&name.derivative());
    let velocities = coordinates.iter().zip(velocities).filter(|(name, _)| has_velocity(name));
    let velocities = velocities.map(|(_, after)| after);
    let positions = coordinates.iter().copied().map(Expr::from);
    let after = positions.chain(velocities).collect();
    let push = Some(impact.direction);
    Ok(FlowEvent { gap: impact.gap, after, is_wall: true, push })
}

/// An event with all states after it; one that counts in both directions is two.
fn flow_event(event: &StateEvent, states: &[Symbol]) -> Vec<FlowEvent> {
    let after = |state: &Symbol| {
        let set = event.assignments.iter().find(|(name, _)| name == state);
        set.map_or_else(|| Expr::from(*state), |(_, value)| value.clone())
    };
    let after: Vec<Expr> = states.iter().map(after).collect();
    let falling = |gap: Expr| FlowEvent { gap, after: after.clone(), is_wall: false, push: None };
    let growing = event.both_ways.then(|| falling(event.guard.clone()));
    [falling(-&event.guard)].into_iter().chain(growing).collect()
}

/// The right sides and events in the phase of a motion of frequency `base`.
pub(super) fn flow_in_phase(
    names: &[Symbol],
    states: &[Symbol],
    (right, events): (&[Expr], &[FlowEvent]),
    base: &Expr,
    parameter: Symbol,
) -> Result<Flow, ResponseError> {
    let phase = fresh("theta", &names.iter().chain(states).copied().collect::<Vec<_>>());
    let moment = Expr::divide(&Expr::from(phase), base)?;
    let rate = |rate: &Expr| -> Result<Expr, ResponseError> {
        Ok(Expr::divide(&in_phase(rate, Symbol::new("t"), &moment)?, base)?)
    };
    let right: Vec<Expr> = right.iter().map(rate).collect::<Result<_, _>>()?;
    let moved = |expression: &Expr| in_phase(expression, Symbol::new("t"), &moment);
    let event = |event: &FlowEvent| -> Result<FlowEvent, ResponseError> {
        let after = event.after.iter().map(moved).collect::<Result<_, _>>()?;
        let push = event.push.as_ref();
        let push = push.map(|push| push.iter().map(moved).collect::<Result<_, _>>()).transpose()?;
        Ok(FlowEvent { gap: moved(&event.gap)?, after, is_wall: event.is_wall, push })
    };
    let events: Vec<FlowEvent> = events.iter().map(event).collect::<Result<_, _>>()?;
    Flow::new(states, phase, &right, parameter, &events)
}
