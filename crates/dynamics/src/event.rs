//! Events of a motion: a guard, and the values that states take where it passes through zero.
//!
//! ```text
//! g(q, q', t) = 0,  dg/dt > 0 (or either sign)       the place of the event
//! y_i -> r_i(q, q', t) for some states y_i           the reset; all r_i take the states before
//! ```
//!
//! (R. Goebel, R. G. Sanfelice, A. R. Teel, *Hybrid Dynamical Systems*, Princeton 2012, chapters 1 and 2.)
//! A rigid [wall](crate::wall) is an event with the law of impact as its reset, on which a motion may also rest.

use std::collections::BTreeMap;

use crate::expr::{Assignments, Expr, ExprError, ParseError, parse_event};
use crate::symbol::Symbol;

/// An event of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct StateEvent {
    /// The guard g in coordinates, velocities, time and parameters: the event takes place where it grows
    /// through zero.
    pub guard: Expr,
    /// Whether the event takes place as well where the guard falls through zero.
    pub both_ways: bool,
    /// The states that are set, and their values behind the event in terms of the states before.
    pub assignments: Assignments,
}

impl StateEvent {
    /// Reads an event of a motion with these states: the condition that comes true, and what is set there.
    ///
    /// # Errors
    /// [`ParseError`]; also for a name that is not a state, and for an event that changes nothing.
    ///
    /// ```
    /// # use lindstedt_dynamics as lindstedt;
    /// use lindstedt::event::StateEvent;
    ///
    /// let states = ["x".into(), "x'".into()];
    /// let bounce = StateEvent::parse("x < 0: x' = -e*x'", &states)?;
    /// assert_eq!(bounce.to_string(), "-x grows through zero: x' = -e*x'");
    /// assert!(StateEvent::parse("x = 1: x' = x' + p", &states)?.both_ways);
    /// # Ok::<(), lindstedt::expr::ParseError>(())
    /// ```
    pub fn parse(text: &str, states: &[Symbol]) -> Result<Self, ParseError> {
        let (guard, both_ways, assignments) = parse_event(text, states)?;
        Ok(Self { guard, both_ways, assignments })
    }

    /// Returns the place of the event in words.
    pub fn condition(&self) -> String {
        let way = if self.both_ways { "passes" } else { "grows" };
        format!("{} {way} through zero", self.guard)
    }

    /// Returns the event with expressions in place of parameters.
    ///
    /// # Errors
    /// [`ExprError`] for a value without a meaning there, such as a division by zero.
    pub fn substitute_all(&self, values: &BTreeMap<Symbol, Expr>) -> Result<Self, ExprError> {
        let set = self.assignments.iter();
        let set = set.map(|(state, value)| Ok((*state, value.substitute_all(values)?)));
        Ok(Self {
            guard: self.guard.substitute_all(values)?,
            both_ways: self.both_ways,
            assignments: set.collect::<Result<_, _>>()?,
        })
    }

    /// The expressions of the event, in which parameters may stand.
    pub fn expressions(&self) -> impl Iterator<Item = &Expr> {
        [&self.guard].into_iter().chain(self.assignments.iter().map(|(_, value)| value))
    }
}

impl std::fmt::Display for StateEvent {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let set = self.assignments.iter().map(|(state, value)| format!("{state} = {value}"));
        write!(formatter, "{}: {}", self.condition(), set.collect::<Vec<String>>().join("; "))
    }
}
