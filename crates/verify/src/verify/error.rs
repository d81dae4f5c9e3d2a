//! Errors of the verification of a formula.

use super::comparison::Refused;
use crate::decimal::decimal;
use crate::expr::{EvaluationError, Expr, ExprError, LostDigits};
use crate::numeric::period::PeriodError;
use crate::numeric::return_map::NoLimitCycle;
use crate::oscillator::OscillatorError;
use crate::symbol::Symbol;
use crate::symbol::letters::{AMPLITUDE, FREQUENCY};
use crate::trajectory::TrajectoryError;

/// The reason why a formula could not be verified, or formulas not compared.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum VerificationError {
    /// Values are missing.
    #[error("to judge the formula, values are needed for: {}", .0.iter().map(|name| name.written()).collect::<Vec<_>>().join(", "))]
    Missing(Vec<Symbol>),
    /// A value for a symbol that does not occur.
    #[error("`{name}` does not occur in the formula{}", letters_of(known))]
    Unknown {
        /// The name.
        name: Symbol,
        /// The names that do occur.
        known: Vec<Symbol>,
    },
    /// A value for a coordinate, whose amplitude has a letter of its own.
    #[error("`{name}` is a coordinate: the amplitude of the mode is `{amplitude}`")]
    Coordinate {
        /// The coordinate.
        name: Symbol,
        /// The letter of the amplitude.
        amplitude: Symbol,
    },
    /// The formula is that of another equation.
    #[error(
        "the formula answers `{answered}`, not `{asked}`, and is judged on the equation that it answers alone"
    )]
    OtherEquation {
        /// The equation that the formula answers.
        answered: String,
        /// The equation on which it was to be judged.
        asked: String,
    },
    /// An amplitude so large that the force has no significant digits there.
    #[error(transparent)]
    LostDigits(#[from] LostDigits),
    /// The equation has no motion to compare with at these values.
    #[error(transparent)]
    Period(#[from] PeriodError),
    /// The equation has no limit cycle to compare with at these values.
    #[error(transparent)]
    LimitCycle(#[from] NoLimitCycle),
    /// The terms of the equation could not be separated.
    #[error(transparent)]
    Oscillator(#[from] OscillatorError),
    /// The equation could not be evaluated.
    #[error(transparent)]
    Evaluation(#[from] EvaluationError),
    /// The values do not fit the equation.
    #[error(transparent)]
    Expression(#[from] ExprError),
    /// A motion whose amplitude changes.
    #[error("the amplitude of the motion changes, so it has no period to be compared with")]
    NotPeriodic,
    /// A motion under drives whose frequencies are incommensurable.
    #[error(
        "under drives whose frequencies have no ratio no motion repeats itself, and there is none to compare with"
    )]
    NeverRepeats,
    /// The equation cannot be followed.
    #[error(transparent)]
    Trajectory(#[from] TrajectoryError),
    /// A motion whose integration ends before it can be compared.
    #[error("the true motion cannot be followed past t = {}: a state or its rate has no value there", decimal(*time))]
    NotFollowed {
        /// The time at which it ends.
        time: f64,
    },
    /// A motion of which only the period is known.
    #[error(
        "Runge-Kutta does not follow the true motion, of which the energy tells the period alone: there is no path to compare with"
    )]
    NoPath,
    /// A start off the limit cycle that a formula describes.
    #[error(
        "x(0) = {} is a start off the limit cycle, and this method describes the cycle alone",
        AMPLITUDE
    )]
    OffCycle,
    /// A motion that dies out or grows before it swings.
    #[error("the true motion does not swing: it goes through its equilibrium less than twice")]
    NoSwing,
    /// A rate of the phase that is not positive at the start.
    #[error("not real: the rate of the phase is not positive at the start")]
    NoSlowFrequency,
    /// The amplitude is zero, and at rest there is nothing to compare.
    #[error(
        "at amplitude zero the motion is rest: the formula gives the linear limit, which has nothing to be judged against"
    )]
    AtRest,
    /// No method applies, each for its reason; the message has that of the first.
    #[error("no method applies{}", .0.first().map_or(String::new(), |first| format!(": {}", first.reason)))]
    NoMethod(Vec<Refused>),
    /// No true motion of a nonlinear normal mode was found.
    #[error(
        "the true motion of mode {number} was not found: the search, in steps of {} from rest on, came to {}", amplitude.written(), decimal(*reached)
    )]
    NoMode {
        /// The number of the mode.
        number: usize,
        /// The symbol of the amplitude.
        amplitude: Symbol,
        /// The amplitude up to which the motions were followed.
        reached: f64,
    },
    /// The search was interrupted.
    #[error("stopped before the true motion was found")]
    Interrupted,
    /// A balance of harmonics has no motion of a mode at the amplitude.
    #[error(
        "the balance of mode {number} was not solved: the search, in steps of {} from rest on, came to {}, where it turns back or has no motion near", amplitude.written(), decimal(*reached)
    )]
    NoBalance {
        /// The number of the mode.
        number: usize,
        /// The symbol of the amplitude.
        amplitude: Symbol,
        /// The amplitude up to which the balance was followed.
        reached: f64,
    },
    /// A divisor of a formula vanishes at the values.
    #[error(
        "mode {number} has no formula at these values: its divisor {divisor} is zero there, an internal resonance or a mode that does not swing"
    )]
    VanishingDivisor {
        /// The number of the mode.
        number: usize,
        /// The name of the divisor.
        divisor: Symbol,
    },
    /// What a formula names has no real value.
    #[error(
        "mode {number} has no formula at these values: {name} = {meaning} has no real value there"
    )]
    NoValue {
        /// The number of the mode.
        number: usize,
        /// The name.
        name: Symbol,
        /// Its meaning.
        meaning: Expr,
    },
    /// The numbers of an equation cannot be followed.
    #[error("{0}")]
    NoSystem(String),
    /// There is no curve of omega against the amplitude, for this reason.
    #[error("there is no curve of {omega} against the amplitude: {0}", omega = FREQUENCY)]
    NoBackbone(&'static str),
}

impl VerificationError {
    /// Whether a true motion may exist nevertheless, because it was only not found or not followed.
    pub(super) fn leaves_the_truth_open(&self) -> bool {
        match self {
            Self::Period(error) => matches!(
                error,
                PeriodError::Waves
                    | PeriodError::NearSeparatrix { .. }
                    | PeriodError::NoReturn(_)
                    | PeriodError::Pole { .. }
                    | PeriodError::Overflow { .. }
                    | PeriodError::Quadrature(_)
                    | PeriodError::Root(_)
                    | PeriodError::Integration(_)
            ),
            Self::LimitCycle(_) => true,
            _ => false,
        }
    }
}

/// The list of known symbols, for the end of the message "does not occur in the formula".
fn letters_of(known: &[Symbol]) -> String {
    let names: Vec<&str> = known.iter().map(|name| name.written()).collect();
    match names.is_empty() {
        true => ", which has no letters: it is judged without values, by `--tolerance 0.01` say"
            .to_owned(),
        false => format!("; it has: {}", names.join(", ")),
    }
}
