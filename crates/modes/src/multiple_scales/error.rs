//! The reasons why coupled equations have no slow equations.

use thiserror::Error;

use super::resonance::ResonanceError;
use crate::expr::{Expr, ExprError};
use crate::modes::ModeError;
use crate::series::TaylorError;
use crate::symbol::Symbol;

/// The reason why there are no slow equations.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum MultipleScalesError {
    /// The equations, or their linear modes.
    #[error(transparent)]
    Modes(#[from] ModeError),
    /// The resonances that were asked for.
    #[error(transparent)]
    Resonance(#[from] ResonanceError),
    /// A step of algebra failed.
    #[error(transparent)]
    Expression(#[from] ExprError),
    /// A force has no Taylor series at rest.
    #[error(transparent)]
    Taylor(#[from] TaylorError),
    /// A term is no product of powers of the coordinates and waves in time.
    #[error("`{0}` is no product of powers of the coordinates and waves such as cos(Omega*t)")]
    Term(Expr),
    /// The small parameter does not occur.
    #[error("`{0}` is no parameter of the equations")]
    NoSmallParameter(Symbol),
    /// Forces of velocities that do no work and are not small.
    #[error("`{0}` is a gyroscopic force, which counts as small in none of these expansions")]
    Gyroscopic(Expr),
    /// A divisor vanishes: the frequencies have a resonance that the reference frequencies leave out.
    #[error(
        "the divisor of mode {mode} vanishes at {frequency}: a resonance between the frequencies that was not asked for"
    )]
    Divisor {
        /// The number of the mode.
        mode: usize,
        /// The frequency of the wave that drives it.
        frequency: String,
    },
    /// An order that is too high.
    #[error("order {0} is above the limit of {1}")]
    Order(usize, usize),
    /// An order at which nothing changes slowly.
    #[error(
        "order {asked} is below that at which damping, detuning and the nonlinear forces act first, {lowest}"
    )]
    BelowBalance {
        /// The order that was asked for.
        asked: usize,
        /// The lowest order that does.
        lowest: usize,
    },
    /// Averaging to an order beyond the first.
    #[error(
        "averaging is of the first order here: means of the forces along the linear motion, and those of the lowest degree have none"
    )]
    NoMean,
    /// Equations in which the small terms are multiplied by a factor have other coordinates.
    #[error("with smaller small terms the equations have another order of coordinates")]
    NotScaled,
    /// A derivation that was interrupted.
    #[error("interrupted")]
    Interrupted,
}

impl MultipleScalesError {
    /// The term of the equations that is to blame, where one is.
    pub fn term(&self) -> Option<&Expr> {
        match self {
            Self::Modes(error) => error.term(),
            Self::Term(term) | Self::Gyroscopic(term) => Some(term),
            _ => None,
        }
    }

    /// Returns advice on what to do instead; `None` if there is none.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Modes(error) => error.help(),
            Self::Resonance(error) => error.help(),
            Self::Divisor { .. } => {
                Some("name the resonance that makes it vanish, such as --resonance \"omega2 = 2*omega1\"; drives of one frequency need one letter".to_owned())
            }
            Self::NoMean => {
                Some("--method multiple-scales has the equations of higher orders".to_owned())
            }
            Self::BelowBalance { lowest, .. } => Some(format!("--order {lowest}")),
            Self::Term(_) | Self::Taylor(_) | Self::Gyroscopic(_) => {
                Some("`lindstedt response` finds the motions in numbers".to_owned())
            }
            _ => None,
        }
    }
}
