//! The reasons why an answer has no numbers.

use super::law_name;
use crate::decimal::significant;
use crate::numeric::ode::energy::PeriodError;
use crate::oscillator::OscillatorError;
use crate::solution::Solution;
use crate::symbol::Symbol;
use crate::symbol::letters::{AMPLITUDE, FREQUENCY, of_frequency};

/// Why an answer has no numbers, or no motion.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoNumbers {
    /// The branch of an implicit relation turns back or reaches zero before the amplitude asked
    /// for.
    #[error("not real: the root that continues the linear frequency ends at {} = {}", AMPLITUDE, significant(*amplitude, 6))]
    BranchEnds {
        /// The amplitude.
        amplitude: f64,
    },
    /// No root of an implicit relation continues that of its first order about an unstable
    /// equilibrium.
    #[error("not real: no root continues the frequency of order 1 at this amplitude")]
    NoneOfFirstOrder,
    /// omega^2 is not positive.
    #[error("not real: {}^2 <= 0", FREQUENCY)]
    NotReal,
    /// omega itself is not positive, of a law for omega.
    #[error("not positive: {} <= 0", FREQUENCY)]
    NotPositive,
    /// The law is larger than any number.
    #[error("{} is beyond the range of double precision, 1.8e308", of_frequency(law))]
    LawBeyond {
        /// `omega^2` or `omega`.
        law: &'static str,
    },
    /// The assumed motion leaves the places where the force is defined and finite.
    #[error(
        "does not apply: the assumed motion runs through {coordinate} = {}, where the force has no finite value",
        significant(*place, 6)
    )]
    Gap {
        /// The coordinate.
        coordinate: Symbol,
        /// The position.
        place: f64,
    },
    /// A symbol that the law is written with has no real value.
    #[error("not real: {name} has no real value at these numbers")]
    Undefined {
        /// The symbol.
        name: Symbol,
    },
    /// A symbol that the law is written with is larger than any number.
    #[error("{name} is beyond the range of double precision, 1.8e308")]
    Beyond {
        /// The symbol.
        name: Symbol,
    },
    /// The branch never reaches the amplitude.
    #[error(
        "no balance: followed from rest, the motion of these harmonics ends at {} = {}; another order may reach farther",
        AMPLITUDE,
        significant(*amplitude, 6)
    )]
    BalanceEnds {
        /// The largest amplitude reached.
        amplitude: f64,
    },
    /// There is no motion to start from.
    #[error("no balance: at small amplitudes these harmonics have no motion to start from")]
    NoBalance,
    /// The branch of motions through an unstable equilibrium never reaches the amplitude.
    #[error(
        "no balance: followed from {} = {}, the motion of these harmonics over both wells ends at {} = {}; another order may reach farther",
        AMPLITUDE,
        significant(*from, 6),
        AMPLITUDE,
        significant(*amplitude, 6)
    )]
    CrossWellBalanceEnds {
        /// The amplitude at which it was taken up.
        from: f64,
        /// The last amplitude reached.
        amplitude: f64,
    },
    /// The sums for the harmonics of the force do not agree, however fine.
    #[error(
        "no balance: the force changes too often along this motion for its harmonics to be summed"
    )]
    UnsettledBalance,
    /// The motion found runs through a place where the force has no value.
    #[error("no balance: the motion of these harmonics runs through {}, where the force has no finite value", significant(*place, 6))]
    BalanceGap {
        /// Where.
        place: f64,
    },
    /// The terms of the formula cancel.
    #[error(
        "no digits: the terms of the formula cancel at this amplitude, and rounding moves {}^2 by {} of itself",
        FREQUENCY,
        significant(*rounding, 2)
    )]
    Cancels {
        /// The relative rounding error of omega^2.
        rounding: f64,
    },
    /// The integral that defines the law goes up and down too often.
    #[error(
        "no digits: the integral that defines {}^2 is known at this amplitude to {} of itself only",
        FREQUENCY,
        significant(*error, 2)
    )]
    Integral {
        /// The relative error of omega^2.
        error: f64,
    },
    /// There is no motion whose frequency it could be.
    #[error(transparent)]
    Motion(#[from] PeriodError),
    /// A quadrature, the exact motion or a search for hbar failed.
    #[error("no finite value at these numbers")]
    NoValue,
    /// Values are missing.
    #[error("values are needed for: {}", .0.iter().map(|name| name.name()).collect::<Vec<_>>().join(", "))]
    Missing(Vec<Symbol>),
    /// The frequency of the formula is not positive, or is known without a motion.
    #[error(
        "the formula has no motion at these values: its frequency is not positive, or is all that it gives"
    )]
    NoMotion,
    /// The motion of a driven equation, which does not follow from its amplitude alone.
    #[error(
        "a driven motion has a phase of its own: its steady motions are `steady_states`, and `response.motion` is its formula"
    )]
    Driven,
    /// The equation of the answer, which a document may have brought, is none.
    #[error(transparent)]
    Equation(#[from] OscillatorError),
}

impl NoNumbers {
    /// The reason that the frequency of an answer is not positive, of the law that it is given by.
    pub fn not_positive(solution: &Solution) -> Self {
        match law_name(solution) {
            "omega" => Self::NotPositive,
            _ => Self::NotReal,
        }
    }

    /// Whether there is no frequency because it would not be real.
    pub fn is_not_real(&self) -> bool {
        matches!(
            self,
            Self::BranchEnds { .. }
                | Self::NoneOfFirstOrder
                | Self::Undefined { .. }
                | Self::NotReal
        )
    }
}
