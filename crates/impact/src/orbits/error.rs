//! Reasons why an equation with walls has no impact orbits in closed form, with ways forward.

use thiserror::Error;

use crate::certificate::OrbitNotProved;
use crate::expr::{EvaluationError, Expr, ExprError};
use crate::symbol::Symbol;
use crate::trajectory::TrajectoryError;
use crate::wall::WallError;

/// The reason why impact orbits are not derived or not computed.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum OrbitError {
    /// A step of algebra failed.
    #[error(transparent)]
    Expression(#[from] ExprError),
    /// A quantity has no value.
    #[error(transparent)]
    Evaluation(#[from] EvaluationError),
    /// A wall is none, or its restitution is out of range.
    #[error(transparent)]
    Wall(#[from] WallError),
    /// The simulation that judges an orbit cannot begin.
    #[error("the simulation beside the closed form does not begin: {0}")]
    Simulation(#[from] TrajectoryError),
    /// A term is not linear in the coordinate and its velocity.
    #[error("the term `{0}` is not linear with constant coefficients")]
    Nonlinear(String),
    /// A force that depends on time otherwise than as a harmonic wave.
    #[error("the term `{0}` is not a harmonic wave such as F*cos(w*t)")]
    NoWave(String),
    /// Two frequencies drive the motion.
    #[error("`{first}` and `{second}` drive the motion with two frequencies")]
    TwoFrequencies {
        /// A wave of the first frequency.
        first: Expr,
        /// A wave of another one.
        second: Expr,
    },
    /// Nothing depends on time.
    #[error("nothing drives the motion: neither the equation nor a wall contains `t`")]
    NoDrive,
    /// There is no wall.
    #[error("an impact orbit needs a wall")]
    NoWall,
    /// There are more than two walls.
    #[error("{0} walls: one coordinate moves between two at most")]
    ManyWalls(usize),
    /// The walls leave no place between them, or bound the same side.
    #[error("the walls `{0} > 0` and `{1} > 0` do not lie on both sides of the motion")]
    SameSide(Expr, Expr),
    /// A gap is not linear in the coordinate with a number in front of it.
    #[error("the wall `{gap} = 0` is not a number times `{coordinate}` beside a place")]
    NonlinearWall {
        /// The gap.
        gap: Expr,
        /// The coordinate.
        coordinate: Symbol,
    },
    /// A name has no value.
    #[error("no value of {}", names(.0))]
    Missing(Vec<Symbol>),
    /// A value is given to a name that does not occur.
    #[error("`{name}` occurs neither in the equation nor in a wall; they contain {}", names(.known))]
    Unknown {
        /// The name.
        name: Symbol,
        /// The names that occur.
        known: Vec<Symbol>,
    },
    /// The frequency of the drive is not positive.
    #[error("the frequency `{name}` of the drive is {value}, but it must be positive")]
    Frequency {
        /// The frequency.
        name: Expr,
        /// Its value.
        value: f64,
    },
    /// A coefficient of the equation overflows.
    #[error("the {0} of the equation has no finite value")]
    NotFinite(&'static str),
    /// The drive has no steady motion: there is no damping, and its frequency is the natural one.
    #[error(
        "without damping a drive at the natural frequency {0} has no steady motion about which to write the closed form"
    )]
    Resonance(Expr),
    /// A number of periods or impacts is zero or too large.
    #[error("{what} must lie between 1 and {most}, not {value}")]
    Count {
        /// The quantity that is counted.
        what: &'static str,
        /// The number.
        value: u32,
        /// The largest number.
        most: u32,
    },
    /// A range of a parameter has no extent.
    #[error("`{0}` varies between two values that differ, both finite")]
    Range(Symbol),
    /// The parameter that varies also has a value.
    #[error("`{0}` varies and has a value")]
    Given(Symbol),
    /// A certificate cannot be made.
    #[error(transparent)]
    NotCertified(#[from] OrbitNotProved),
    /// The work was interrupted.
    #[error("interrupted before the end")]
    Interrupted,
}

impl OrbitError {
    /// The term of the equation that is to blame, as it was typed where that is known.
    pub fn term(&self) -> Option<&str> {
        match self {
            Self::Nonlinear(term) | Self::NoWave(term) => Some(term),
            _ => None,
        }
    }

    /// Advice; `None` where the message says it all.
    pub fn help(&self) -> Option<String> {
        Some(match self {
            Self::Nonlinear(_) => {
                "closed forms need x'' + c*x' + k*x between impacts; `lindstedt simulate` follows other equations between walls, --wall \"x < d\" --restitution e".to_owned()
            }
            Self::NoWave(_) => {
                "write the drive as a sum of waves of one frequency and a constant, F*cos(w*t) + G*sin(w*t) + P".to_owned()
            }
            Self::TwoFrequencies { .. } => {
                "leave one of the waves out, or follow the motion: `lindstedt simulate` with --wall".to_owned()
            }
            Self::NoDrive => {
                "add a force such as = F*cos(w*t), or a wall that moves, --wall \"x > Z*sin(w*t)\"; `lindstedt simulate` with --wall follows free motions".to_owned()
            }
            Self::NoWall => "--wall \"x < d\" --restitution e".to_owned(),
            Self::ManyWalls(_) => "keep the nearest one on each side".to_owned(),
            Self::SameSide(..) => "keep one of them, or write --wall \"x > -d\" --wall \"x < d\"".to_owned(),
            Self::NonlinearWall { coordinate, .. } => {
                format!("write it as {coordinate} < PLACE or {coordinate} > PLACE, the place a constant or a wave such as Z*sin(w*t)")
            }
            Self::Frequency { .. } => "give it a positive value".to_owned(),
            Self::Resonance(_) => "add damping, or move the frequency of the drive a little".to_owned(),
            Self::Wall(WallError::NoCoordinate { .. }) => "name the coordinate, --wall \"x < d\"".to_owned(),
            Self::Wall(WallError::Restitution(_)) => "0 sticks, 1 loses nothing".to_owned(),
            Self::NotCertified(OrbitNotProved::NoFraction { .. }) => {
                "write it as a fraction or a decimal, 22/7 or 0.65".to_owned()
            }
            Self::Given(name) => format!("leave out the value of {name}, or vary another parameter"),
            _ => return None,
        })
    }
}

/// Names in words: `c, k and w`.
fn names(names: &[Symbol]) -> String {
    let names: Vec<String> = names.iter().map(ToString::to_string).collect();
    match names.split_last() {
        Some((last, others)) if !others.is_empty() => format!("{} and {last}", others.join(", ")),
        _ => names.concat(),
    }
}
