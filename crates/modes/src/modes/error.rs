//! The reasons why a system has no nonlinear normal modes in formulas.

use thiserror::Error;

use crate::coupled::CoupledError;
use crate::expr::{Expr, ExprError};
use crate::series::TaylorError;
use crate::solution::Degrees;
use crate::symbol::Symbol;

/// The reason why there is no formula of a mode, or of any.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ModeError {
    /// The text is no system of equations.
    #[error(transparent)]
    Equations(#[from] CoupledError),
    /// A coordinate moves by an equation of first order.
    #[error(
        "{0} moves by an equation of first order: a normal mode is a motion of masses and springs"
    )]
    FirstOrder(Symbol),
    /// A term depends on time.
    #[error("`{0}` depends on time: normal modes are free motions")]
    Driven(Expr),
    /// A term is odd in the velocities: the motion backward in time is none.
    #[error(
        "`{0}` is odd in the velocities, as damping is: it takes energy or gives it, and a mode is a motion without"
    )]
    Damped(Expr),
    /// Forces of velocities that do no work.
    #[error("`{0}` is a gyroscopic force: its modes are not in phase")]
    Gyroscopic(Expr),
    /// The coordinates are not at rest where all of them are zero.
    #[error("the equation `{0} = 0` leaves the force {1} where every coordinate is zero")]
    NotAtRest(Expr, Expr),
    /// A force has no value where all coordinates are zero.
    #[error("the equation `{0} = 0` has no value where every coordinate is zero")]
    NoValueAtRest(Expr),
    /// The mass matrix is singular where every coordinate is zero.
    #[error("the mass matrix is singular where every coordinate is zero")]
    Massless,
    /// A force has no Taylor series at rest.
    #[error(transparent)]
    Taylor(#[from] TaylorError),
    /// A step of algebra failed.
    #[error(transparent)]
    Expression(#[from] ExprError),
    /// The linear modes of more than two coordinates with letters in masses or stiffnesses.
    #[error(
        "the linear modes of {coordinates} coordinates have no closed form in {}", listed(.letters)
    )]
    Letters {
        /// The number of coordinates.
        coordinates: usize,
        /// The letters of the linear part.
        letters: Vec<Symbol>,
    },
    /// The linear equations have solutions that neither oscillate nor grow in one shape.
    #[error(
        "the linear equations have squares of frequencies that are not real, as with follower forces"
    )]
    NotReal,
    /// A frequency with fewer shapes than modes.
    #[error(
        "omega^2 = {square} belongs to more modes than it has shapes: the linear motion grows in proportion to time, as with follower forces"
    )]
    Defective {
        /// The square of the frequency.
        square: String,
    },
    /// There is no mode of this number.
    #[error("there is no mode {number}: there are {count}")]
    NoSuchMode {
        /// The number that was asked for.
        number: usize,
        /// The number of modes.
        count: usize,
    },
    /// The linear motion grows: rest is unstable.
    #[error(
        "mode {number} has omega^2 = {square} at rest: rest is unstable along it, and nothing swings there"
    )]
    Unstable {
        /// The number of the mode.
        number: usize,
        /// The square of its linear frequency.
        square: String,
    },
    /// No linear force pulls back.
    #[error("mode {number} has omega = 0 at rest: no linear force pulls it back")]
    NoStiffness {
        /// The number of the mode.
        number: usize,
    },
    /// Another mode has the same linear frequency.
    #[error(
        "modes {number} and {other} have one linear frequency, omega^2 = {square}: which of their shapes swing is for the nonlinear forces to decide (internal resonance 1:1)"
    )]
    EqualFrequencies {
        /// The number of the mode.
        number: usize,
        /// The number of the other mode.
        other: usize,
        /// The square of the frequency.
        square: String,
    },
    /// A multiple of the frequency is that of another mode.
    #[error(
        "internal resonance 1:{ratio} of modes {number} and {other}: at order {order} of the amplitude mode {number} drives mode {other} at its own frequency, and the divisor vanishes"
    )]
    InternalResonance {
        /// The number of the mode.
        number: usize,
        /// The mode that it drives.
        other: usize,
        /// The multiple of the frequency; zero for a force that does not change with time.
        ratio: usize,
        /// The power of the amplitude.
        order: usize,
    },
    /// A number of coordinates other than two.
    #[error("closed forms with one harmonic are of two coordinates: there are {0}")]
    NotTwo(usize),
    /// A force that one harmonic does not balance.
    #[error(
        "`{0}` is of even degree: it moves the mean and drives the second harmonic, which a balance of one harmonic has not"
    )]
    EvenDegree(Expr),
    /// A force that is no polynomial of a moderate degree.
    #[error("closed forms with one harmonic are of forces that are polynomials up to degree {0}")]
    NotPolynomial(u32),
    /// The equations of the balance cannot be solved in closed form.
    #[error("the balance of one harmonic has no closed form")]
    NoClosedForm,
    /// Degrees without an approximant.
    #[error("omega^2 of mode {number} has no approximant {degrees}: {reason}")]
    Approximant {
        /// The number of the mode.
        number: usize,
        /// The degrees.
        degrees: Degrees,
        /// The reason.
        reason: &'static str,
    },
    /// An order that is too high.
    #[error("order {0} is above the limit of {1}")]
    Order(u32, u32),
    /// A number of harmonics that no balance has.
    #[error("{0} harmonics: a balance has 1 to {1}")]
    Harmonics(u32, u32),
}

fn listed(letters: &[Symbol]) -> String {
    let names: Vec<&str> = letters.iter().map(|name| name.written()).collect();
    names.join(", ")
}

impl ModeError {
    /// The term of the equations that is to blame, where one is.
    pub fn term(&self) -> Option<&Expr> {
        match self {
            Self::Driven(term)
            | Self::Damped(term)
            | Self::Gyroscopic(term)
            | Self::EvenDegree(term) => Some(term),
            _ => None,
        }
    }

    /// Returns advice on what to do instead; `None` if there is none.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Equations(error) => error.help(),
            Self::FirstOrder(_) => Some(
                "write an equation of second order for each coordinate, x'' + ... = 0; `lindstedt simulate` follows equations of first order, and `lindstedt response` finds their cycles"
                    .to_owned(),
            ),
            Self::Gyroscopic(_) => Some(
                "`lindstedt simulate` follows motions with such forces, and with a drive `lindstedt response` has their resonance curves; without the term there are modes"
                    .to_owned(),
            ),
            Self::Damped(_) | Self::Driven(_) => Some(
                "--method multiple-scales has the slow equations with such terms; without them there are modes".to_owned(),
            ),
            Self::NotAtRest(_, force) if !force.symbols().is_empty() => {
                let names: Vec<String> =
                    force.symbols().iter().map(|name| format!("`{}`", name.written())).collect();
                Some(format!(
                    "no derivative of {} occurs: if it is a coordinate, check how it is written; else count each coordinate from the place of rest, x0 + x for x",
                    names.join(", ")
                ))
            }
            Self::NotAtRest(..) | Self::NoValueAtRest(_) => Some(
                "count each coordinate from the place of rest: put x0 + x for x, with x0 such that nothing is left".to_owned(),
            ),
            Self::EvenDegree(_) => Some(
                "--order 2 balances several harmonics, by numbers at an amplitude; --method multiple-scales has slow equations; `lindstedt response --vary omega=FROM:TO` finds the modes in numbers".to_owned(),
            ),
            Self::NotTwo(_) | Self::NotPolynomial(_) | Self::NoClosedForm => Some(
                "--order 2 balances several harmonics, by numbers at an amplitude; without --method the modes are series in the amplitude; `lindstedt response --vary omega=FROM:TO` finds them in numbers".to_owned(),
            ),
            Self::Taylor(_) => Some(
                "`lindstedt response --vary omega=FROM:TO` finds the modes of forces of the positions in numbers; `lindstedt simulate` follows motions with any force".to_owned(),
            ),
            Self::Letters { letters, .. } => Some(format!(
                "give them values: --at {}",
                letters.iter().map(|name| format!("{}=1", name.written())).collect::<Vec<_>>().join(",")
            )),
            Self::EqualFrequencies { .. } => Some(
                "--method multiple-scales has the slow equations of both modes, --method harmonic-balance similar ones of two masses where every force is of odd degree; `lindstedt response --vary omega=FROM:TO` finds the motions in numbers"
                    .to_owned(),
            ),
            Self::InternalResonance { .. } => Some(
                "--method multiple-scales has the slow equations of both modes; `lindstedt response --vary omega=FROM:TO` finds the motions in numbers"
                    .to_owned(),
            ),
            Self::Approximant { .. } => Some("other degrees may have one: --order 1,1".to_owned()),
            Self::NoStiffness { .. } => {
                Some("`lindstedt simulate` follows the motions from any start".to_owned())
            }
            _ => None,
        }
    }
}
