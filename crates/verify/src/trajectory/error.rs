//! The reasons why a motion is not followed.

use thiserror::Error;

use super::section::MOST_CROSSINGS;
use crate::decimal::decimal;
use crate::event::StateEvent;
use crate::expr::{EvaluationError, Expr, ExprError, LostDigits};
use crate::mechanics::MechanicsError;
use crate::symbol::Symbol;
use crate::system::SystemError;
use crate::wall::WallError;

/// The reason why there is no motion.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum TrajectoryError {
    /// Parameters without a number.
    #[error("no value for {}", names(.0))]
    Missing(Vec<Symbol>),
    /// A value for a name that does not occur.
    #[error("there is a value for `{0}`, which does not occur")]
    Unknown(Symbol),
    /// A start for a name that is not a state.
    #[error("the start gives `{name}`, but the states are {states}")]
    NoState {
        /// The name.
        name: Symbol,
        /// The names of the states that there are.
        states: String,
    },
    /// A duration that is none.
    #[error("the duration must be a positive number, not {0}")]
    Duration(f64),
    /// A section once a period that is none.
    #[error(
        "the period `{0}` of the section is {1}: it must be positive, and the motion shorter than {MOST_CROSSINGS} of it"
    )]
    Period(Expr, f64),
    /// A start so large that a rate has no digits there.
    #[error(transparent)]
    LostDigits(#[from] LostDigits),
    /// The equations cannot be followed.
    #[error(transparent)]
    System(#[from] SystemError),
    /// The mechanism has no accelerations.
    #[error(transparent)]
    Mechanics(#[from] MechanicsError),
    /// A bound that is not a wall.
    #[error(transparent)]
    Wall(#[from] WallError),
    /// A start behind a wall.
    #[error("the motion begins behind a wall: `{gap}` is {} there and must not be negative", decimal(*.value))]
    BehindWall {
        /// The gap of the wall.
        gap: Expr,
        /// Its value at the start.
        value: f64,
    },
    /// A wall whose gap cannot be differentiated.
    #[error("the gap `{0}` of a wall has no second rate along the motion")]
    WallWithCorner(Expr),
    /// An event one of whose expressions has no value.
    #[error("the event `{0}`: {1}")]
    EventUndefined(Box<StateEvent>, EvaluationError),
    /// An event, counted from 1, whose guard has no value at the start.
    #[error("the condition of event {0} has no value at the start")]
    GuardUndefined(usize),
    /// An event that sets a state to no number.
    #[error("event {event} sets `{name}` to a value that is not a number, at t = {}", decimal(*.time))]
    ResetUndefined {
        /// The event, counted from 1.
        event: usize,
        /// The state.
        name: Symbol,
        /// The time.
        time: f64,
    },
    /// An event that puts the motion behind a wall.
    #[error("an event puts the motion behind a wall at t = {}: `{gap}` is {} there and must not be negative", decimal(*.time), decimal(*.value))]
    EventBehindWall {
        /// The gap of the wall.
        gap: Expr,
        /// Its value behind the event.
        value: f64,
        /// The time.
        time: f64,
    },
    /// Static friction that is less than the sliding one, or has no value.
    #[error("static over sliding friction, `{0}`, is {1}: it must be 1 or more")]
    StaticFriction(Expr, f64),
    /// Static friction in equations without dry friction.
    #[error("static friction needs a dry friction in the equations, such as `mu*sgn(x')`")]
    WithoutFriction,
    /// A wall whose gap has no value.
    #[error("the gap `{0}` of a wall: {1}")]
    WallUndefined(Expr, EvaluationError),
    /// A step of algebra failed.
    #[error(transparent)]
    Expression(#[from] ExprError),
}

impl TrajectoryError {
    /// Whether an event on the way has no state behind it.
    pub(super) fn is_of_reset(&self) -> bool {
        matches!(self, Self::ResetUndefined { .. } | Self::EventBehindWall { .. })
    }
}

/// Names in back quotes, with commas between them.
pub(super) fn names(symbols: &[Symbol]) -> String {
    let names: Vec<String> = symbols.iter().map(|symbol| format!("`{symbol}`")).collect();
    names.join(", ")
}
