//! Errors of the computation of a response.

use thiserror::Error;

use super::MOST_HARMONICS;
use crate::decimal::decimal;
use crate::expr::{EvaluationError, Expr, ExprError};
use crate::oscillator::OscillatorError;
use crate::symbol::Symbol;
use crate::wall::WallError;

/// The reason why there is no response.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ResponseError {
    /// Time does not occur, and no term feeds or dissipates energy.
    #[error("there is no drive: time `t` does not occur in the equation")]
    NoDrive,
    /// Time does not occur, and no self-excited motion was found.
    #[error("there is no drive, and no limit cycle was found for {parameter} from {} to {}", decimal(.range[0]), decimal(.range[1]))]
    NoCycle {
        /// The parameter.
        parameter: Symbol,
        /// Its range.
        range: [f64; 2],
    },
    /// A number of drive periods was given, but there is no drive.
    #[error(
        "there is no drive of which a motion could take {0} periods: time `t` does not occur in the equation"
    )]
    NoPeriods(usize),
    /// Time enters in a way that is not periodic.
    #[error("the term `{0}` is not periodic in time")]
    NotPeriodic(String),
    /// A force that jumps with the velocity, but not on a fixed line in the plane of position and
    /// velocity.
    #[error(
        "the term `{0}` jumps with the velocity, and not on a line of places and velocities that is the same at every time"
    )]
    Jump(String),
    /// Two frequencies without a common period for every value of the parameter.
    #[error("the frequencies `{}` and `{}` are no whole multiples of one frequency", .0[0], .0[1])]
    TwoFrequencies([String; 2]),
    /// Frequencies whose common period holds so many waves that a balance has too few harmonics.
    #[error(
        "the common period of the frequencies `{}` and `{}` holds {waves} waves of the faster one: a motion with its own harmonics takes more than \
         the {MOST_HARMONICS} of a balance", frequencies[0], frequencies[1]
    )]
    FarFrequencies {
        /// The first frequency and the fastest.
        frequencies: [String; 2],
        /// The number of waves.
        waves: String,
    },
    /// The frequency of the drive is not positive in all of the range.
    #[error("the frequency `{frequency}` of the drive is {} at {parameter} = {}: it must be positive", decimal(*.value), decimal(*.at))]
    Frequency {
        /// The frequency.
        frequency: String,
        /// Its value.
        value: f64,
        /// The parameter.
        parameter: Symbol,
        /// The value of the parameter.
        at: f64,
    },
    /// The parameter to vary does not occur in the equation.
    #[error("there is no parameter `{name}` in the equation: {}", parameters(.known))]
    NoParameter {
        /// The name.
        name: Symbol,
        /// The parameters of the equation.
        known: Vec<Symbol>,
    },
    /// The parameter to vary stands only where states are set that only count.
    #[error(
        "the motion does not depend on `{parameter}`: it stands only where {} set, which only {}", are_set(.counters),
        if .counters.len() == 1 { "counts" } else { "count" }
    )]
    OnlyCounts {
        /// The parameter.
        parameter: Symbol,
        /// The states that only count.
        counters: Vec<Symbol>,
    },
    /// A state that acts on the motion, and is set at an event to what it was and a constant more.
    #[error(
        "an event sets `{state} = {value}`, each time to another value, and `{state}` acts on the motion: no motion with this event repeats itself, and \
         beside one without it there is another for every value of `{state}`"
    )]
    CountsAndActs {
        /// The state.
        state: Symbol,
        /// The value to which an event sets it.
        value: Box<Expr>,
    },
    /// The parameter that varies has a value.
    #[error("`{0}` varies and is given a value as well")]
    Given(Symbol),
    /// A value for a name that does not occur.
    #[error("there is a value for `{0}`, which does not occur in the equation")]
    Unknown(Symbol),
    /// Parameters without a value.
    #[error("no value for {}", list(.0))]
    Missing(Vec<Symbol>),
    /// A range whose ends are not finite and in order.
    #[error("the range of `{0}` must go from a finite number to a larger one")]
    Range(Symbol),
    /// A count beyond what can be kept.
    #[error("{what} must lie between 1 and {most}, not {given}")]
    Count {
        /// The quantity that is counted.
        what: &'static str,
        /// The value given.
        given: usize,
        /// The largest value allowed.
        most: usize,
    },
    /// Initial motions were found, but no branch could be followed from them.
    #[error("motions were found, but none of them could be followed for {parameter} from {} to {}", decimal(.range[0]), decimal(.range[1]))]
    NotFollowed {
        /// The parameter.
        parameter: Symbol,
        /// Its range.
        range: [f64; 2],
    },
    /// No periodic motion was found as an initial guess.
    #[error("no periodic motion was found at {parameter} = {}{}", decimal(*.at), without_motion(*undamped, *repeats))]
    NoMotion {
        /// The parameter.
        parameter: Symbol,
        /// Its value.
        at: f64,
        /// Whether nothing damps the motion.
        undamped: bool,
        /// The number of periods of the drive after which simulations repeat themselves, if they do.
        repeats: Option<usize>,
    },
    /// The search was interrupted before there was a branch.
    #[error(
        "interrupted, by hand or a timeout, before a branch was followed: {} starts at {} values of {parameter} were tried, which led to {} motions to begin with",
        .tried.starts,
        .tried.values,
        .tried.motions
    )]
    Interrupted {
        /// The parameter.
        parameter: Symbol,
        /// The progress of the search until then.
        tried: SeedSearch,
    },
    /// Free coupled equations without damping, whose motions have every energy: another name than
    /// that of their frequency varies.
    #[error(
        "nothing drives or damps the motion: it has a frequency for each energy, and `{0}` alone does not tell them apart"
    )]
    FreeParameter(Symbol),
    /// A rate of coupled equations has the product of two jumps on both of which a motion can stick.
    #[error(
        "the term `{0}` is the product of two jumps on which a motion can stick: where it is on both, its rates are not determined"
    )]
    CoupledJump(String),
    /// Friction holds all coordinates.
    #[error("nothing moves: friction bears what drives it for {parameter} from {} to {}", decimal(.range[0]), decimal(.range[1]))]
    NothingMoves {
        /// The parameter.
        parameter: Symbol,
        /// Its range.
        range: [f64; 2],
    },
    /// No motion could be followed over a period because it meets a jump without end.
    #[error(
        "no motion was found, because it meets the jump at `{0} = 0` ever faster, more than 2000 times in a period"
    )]
    Chatters(String),
    /// No motion could be followed over a period because forces that hold it are not determined.
    #[error(
        "no motion was found, because the forces that hold it on `{0} = 0` and on other jumps at once are not determined"
    )]
    UndeterminedFriction(String),
    /// No motion could be followed over a period because it rests on a wall, given by its gap, where forces jump.
    #[error("no motion was found that does not rest on the wall `{0} = 0` while a force jumps")]
    RestsOnWall(String),
    /// No motion could be followed over a period because it rests on two walls at once, given by their gaps.
    #[error("no motion was found that does not rest on two walls at once, `{0} = 0` and `{1} = 0`")]
    RestsOnTwoWalls(String, String),
    /// No motion could be followed over a period because events accumulate, or take place at once.
    #[error(
        "no motion was found whose events are apart: within a period they accumulate, or two take place at once"
    )]
    EventsAccumulate,
    /// Walls that take no energy in equations that nothing drives and nothing damps.
    #[error(
        "nothing drives the motion and nothing takes its energy, so that there is one for each energy"
    )]
    WallsWithoutLoss,
    /// A bound that is not a wall.
    #[error(transparent)]
    Wall(#[from] WallError),
    /// No family of free motions has frequencies in the range.
    #[error(
        "no nonlinear normal mode was found for frequencies from {} to {}: the linear modes have {}", decimal(.range[0]), decimal(.range[1]),
        frequencies(.linear)
    )]
    NoModes {
        /// The frequencies of the linear modes.
        linear: Vec<f64>,
        /// The range.
        range: [f64; 2],
    },
    /// Bifurcations in two parameters of motions that nothing drives.
    #[error("bifurcations are followed in two parameters where something drives the motion")]
    NoDriveAlong,
    /// Bifurcations in two parameters of motions with corners of the force.
    #[error(
        "bifurcations are followed in two parameters where no force has a corner, such as `abs` or `max`"
    )]
    CornersAlong,
    /// The rates have no series.
    #[error("the motion has no Taylor series: {0}")]
    Rates(String),
    /// A quantity to be listed contains a name that is no coordinate.
    #[error("`{name}` is no coordinate: the coordinates are {}", list(.known))]
    NotShown {
        /// The name.
        name: Symbol,
        /// The coordinates.
        known: Vec<Symbol>,
    },
    /// The equation has no such values.
    #[error(transparent)]
    Oscillator(#[from] OscillatorError),
    /// A step of algebra failed.
    #[error(transparent)]
    Expression(#[from] ExprError),
    /// A name without a value.
    #[error(transparent)]
    Evaluation(#[from] EvaluationError),
}

/// The progress of the search for initial motions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SeedSearch {
    /// Number of values of the parameter.
    pub values: usize,
    /// Number of simulations started at them.
    pub starts: usize,
    /// Number of motions found.
    pub motions: usize,
}

/// The parameters of an equation, in words.
fn parameters(known: &[Symbol]) -> String {
    match known {
        [] => "it has none".to_owned(),
        known => format!("its parameters are {}", list(known)),
    }
}

/// Frequencies in words.
fn frequencies(all: &[f64]) -> String {
    let numbers: Vec<String> = all.iter().map(|value| decimal(*value)).collect();
    match numbers.as_slice() {
        [] => "none".to_owned(),
        [one] => format!("the frequency {one}"),
        several => format!("the frequencies {}", several.join(", ")),
    }
}

/// The reason why there is no periodic motion, where it is known.
fn without_motion(undamped: bool, repeats: Option<usize>) -> String {
    match (undamped, repeats) {
        (true, _) => ": without damping the amplitude is unbounded at resonance".to_owned(),
        (false, None) => String::new(),
        (false, Some(1)) => {
            ", but simulations repeat themselves after one period of the drive".to_owned()
        }
        (false, Some(periods)) => {
            format!(", but simulations repeat themselves after {periods} periods of the drive")
        }
    }
}

/// Names of states that are set, as a subject.
fn are_set(states: &[Symbol]) -> String {
    format!("{} {}", list(states), if states.len() == 1 { "is" } else { "are" })
}

fn list(symbols: &[Symbol]) -> String {
    let names: Vec<String> = symbols.iter().map(|symbol| format!("`{symbol}`")).collect();
    names.join(", ")
}
