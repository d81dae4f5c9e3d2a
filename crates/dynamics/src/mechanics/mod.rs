//! From energies to equations of motion: Lagrange's equations of the second kind for any number of
//! coordinates.
//!
//! ```text
//! d/dt dT/dq_i' - dT/dq_i + dV/dq_i + dD/dq_i' = Q_i        T(q, q', t), V(q, t), D(q, q'), Q_i(q, q', t)
//! M q'' + C q' + K q = 0   near a place of rest;   det(lambda^2 M + lambda C + K) = 0
//! ```
//!
//! (L. Meirovitch, *Fundamentals of Vibrations*, 2001, sections 6.4 and 7.2; J. W. Strutt, Lord
//! Rayleigh, *The Theory of Sound*, section 81, for D.) In: a [`Mechanism`], energies as
//! expressions with `q'` for the velocity of `q`. Out: its [`EquationsOfMotion`], its equilibria
//! with the small oscillations about them, and, if its parameters have units, a check of every term
//! and the dimensionless [`Groups`] on which the motion depends.
//!
//! ```
//! # use lindstedt_dynamics as lindstedt;
//! use lindstedt::mechanics::Mechanism;
//!
//! let pendulum = Mechanism::parse(&["x"], "m*L^2*x'^2/2", "m*g*L*(1 - cos(x))")?;
//! assert_eq!(pendulum.equations()?.to_string(), "x'' + g*sin(x)/L = 0");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod combination;
pub mod dimension;
mod equilibrium;
mod groups;
mod lagrange;
pub mod linear;
mod modes;
mod rates;
mod study;
mod trigonometry;

use std::collections::BTreeMap;

use thiserror::Error;

use crate::expr::{EvaluationError, Expr, ExprError, ParseError, parse_expression};
use crate::symbol::Symbol;

pub use combination::Combination;
pub use dimension::{Dimension, UnitError};
pub use equilibrium::{DriveAtRest, Rest, RestPosition, equilibria};
pub use groups::{Group, Groups};
pub use lagrange::EquationsOfMotion;
pub use modes::{Mode, Modes};
pub use rates::Rates;
pub use study::{MechanismQuestion, MechanismStudy, RestStudy, study};

/// Largest number of coordinates of a mechanism, whose matrices are written as formulas.
pub const MOST_COORDINATES: usize = 8;

/// A mechanism: its coordinates, its energies, and the other forces that act on it.
#[derive(Clone, Debug, PartialEq)]
pub struct Mechanism {
    /// The generalised coordinates, in the order of their equations.
    pub coordinates: Vec<Symbol>,
    /// T, the kinetic energy, in coordinates, velocities and time.
    pub kinetic: Expr,
    /// V, the potential energy, in coordinates and time.
    pub potential: Expr,
    /// D, Rayleigh's dissipation function: `c*x'^2/2` for a dashpot, `F*abs(x')` for dry friction.
    pub dissipation: Expr,
    /// Q, the generalised force on each coordinate that has one, on the right side of its equation.
    pub forces: BTreeMap<Symbol, Expr>,
}

/// The reason why there are no equations of motion, no groups, no study or no numbers.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum MechanicsError {
    /// The text of an energy or a force has a syntax error.
    #[error("the {part}: {error}")]
    Parse {
        /// The part of the mechanism.
        part: String,
        /// The error of its syntax.
        error: Box<ParseError>,
    },
    /// A step of algebra failed.
    #[error(transparent)]
    Expression(#[from] ExprError),
    /// There are no coordinates, or too many to write the equations out.
    #[error("a mechanism has 1 to {MOST_COORDINATES} coordinates, not {0}")]
    CoordinateCount(usize),
    /// A coordinate that occurs twice.
    #[error("the coordinate `{0}` is listed twice")]
    Twice(Symbol),
    /// A name that cannot be a coordinate.
    #[error(
        "`{0}` cannot be a coordinate: take a name of letters and digits that is neither `t` nor `pi`"
    )]
    Name(String),
    /// A velocity or an acceleration occurs in a part that must not contain it.
    #[error("the {part} contains `{name}`: {why}")]
    Derivative {
        /// The part of the mechanism.
        part: String,
        /// The symbol.
        name: Symbol,
        /// The reason, and what to write instead.
        why: &'static str,
    },
    /// The kinetic energy does not contain the velocity of a coordinate.
    #[error(
        "the kinetic energy does not contain `{0}'`: without inertia `{0}` has no equation of motion"
    )]
    NoInertia(Symbol),
    /// The mass matrix is singular, so that the accelerations do not follow.
    #[error(
        "the kinetic energy `{0}` does not determine every acceleration: its mass matrix is singular"
    )]
    Singular(Expr),
    /// An energy jumps.
    #[error(
        "the {part} jumps with `{jump}`: the force of a jump is no function; let the term vanish where it begins, such as \
         k*(x - a)^2*H(x - a)"
    )]
    Jump {
        /// The part of the mechanism.
        part: String,
        /// The step or sign.
        jump: Expr,
    },
    /// A force is given for a name that is not a coordinate.
    #[error("there is a force on `{0}`, which is no coordinate")]
    ForceOnNothing(Symbol),
    /// A unit is missing, or a term has a wrong one.
    #[error(transparent)]
    Unit(#[from] UnitError),
    /// No parameter and no size of the motion has the dimension of a time.
    #[error("no product of powers of {0} is a time: the motion has no time of its own")]
    NoTime(String),
    /// A value is given for a name that does not occur.
    #[error("there is a value for `{0}`, which is no parameter of the mechanism")]
    UnknownValue(Symbol),
    /// The linear equations have coefficients that change with the time.
    #[error(
        "no small swings of a fixed frequency: the linear equations contain `{0}`, which changes with the time other than by sines and \
         cosines of it; follow the motion by `lindstedt simulate`"
    )]
    Changing(Expr),
    /// A parameter has no value, or an expression is undefined.
    #[error(transparent)]
    Evaluation(#[from] EvaluationError),
    /// A mass or a stiffness is not finite.
    #[error("mass or stiffness has no finite value there")]
    NotFinite,
    /// The mass matrix is not positive definite.
    #[error("the mass matrix is not positive there")]
    Mass,
}

impl MechanicsError {
    /// Returns advice on what to write instead; `None` if there is none.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Unit(error) => error.help(),
            _ => None,
        }
    }
}

impl Mechanism {
    /// Reads a mechanism from the texts of its energies, without dissipation and other forces.
    ///
    /// # Errors
    /// [`MechanicsError::Parse`] for a part with a syntax error; [`Mechanism::equations`] makes all
    /// other checks.
    pub fn parse(
        coordinates: &[&str],
        kinetic: &str,
        potential: &str,
    ) -> Result<Self, MechanicsError> {
        let read = |part: &str, text: &str| {
            parse_expression(text).map_err(|error| MechanicsError::Parse {
                part: part.to_owned(),
                error: Box::new(error),
            })
        };
        Ok(Self {
            coordinates: coordinates.iter().map(|name| Symbol::new(name)).collect(),
            kinetic: read("kinetic energy", kinetic)?,
            potential: read("potential energy", potential)?,
            dissipation: Expr::zero(),
            forces: BTreeMap::new(),
        })
    }

    /// Derives the equations of motion.
    ///
    /// # Errors
    /// [`MechanicsError`] names the part and the symbol.
    ///
    /// ```
    /// # use lindstedt_dynamics as lindstedt;
    /// use lindstedt::mechanics::Mechanism;
    ///
    /// let cart = Mechanism::parse(
    ///     &["s", "x"],
    ///     "M*s'^2/2 + m*((s' + L*x'*cos(x))^2 + (L*x'*sin(x))^2)/2",
    ///     "-m*g*L*cos(x)",
    /// )?;
    /// let equations = cart.equations()?;
    /// assert_eq!(equations.to_string(), "s''*(M + m) + L*m*x''*cos(x) - L*m*x'^2*sin(x) = 0\ns''*cos(x) + L*x'' + g*sin(x) = 0");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn equations(&self) -> Result<EquationsOfMotion, MechanicsError> {
        self.check()?;
        let (own, combinations) = combination::combined(self)?;
        let equations = lagrange::equations(&own)?;
        Ok(equations.written_out(combinations)?)
    }

    /// Returns the mechanism with a function applied to every part.
    fn mapped(&self, change: impl Fn(&Expr) -> Result<Expr, ExprError>) -> Result<Self, ExprError> {
        let force = |(on, force): (&Symbol, &Expr)| Ok((*on, change(force)?));
        Ok(Self {
            coordinates: self.coordinates.clone(),
            kinetic: change(&self.kinetic)?,
            potential: change(&self.potential)?,
            dissipation: change(&self.dissipation)?,
            forces: self.forces.iter().map(force).collect::<Result<_, ExprError>>()?,
        })
    }

    /// Returns all energies and forces with their names in messages.
    pub(crate) fn parts(&self) -> impl Iterator<Item = (String, &Expr)> {
        let energies = [
            ("kinetic energy", &self.kinetic),
            ("potential energy", &self.potential),
            ("dissipation", &self.dissipation),
        ];
        let energies = energies.into_iter().map(|(name, part)| (name.to_owned(), part));
        let forces = self.forces.iter();
        energies.chain(forces.map(|(on, force)| (format!("force on {on}"), force)))
    }

    /// The names that are neither coordinates, their derivatives nor time, in alphabetical order.
    pub fn parameters(&self) -> Vec<Symbol> {
        let names: std::collections::BTreeSet<Symbol> =
            self.parts().flat_map(|(_, part)| part.symbols()).collect();
        let own =
            |name: &Symbol| self.coordinates.contains(&name.coordinate()) || name.name() == "t";
        names.into_iter().filter(|name| !own(name)).collect()
    }

    /// Checks that equations of motion follow from the mechanism.
    fn check(&self) -> Result<(), MechanicsError> {
        let count = self.coordinates.len();
        if count == 0 || count > MOST_COORDINATES {
            return Err(MechanicsError::CoordinateCount(count));
        }
        for (index, coordinate) in self.coordinates.iter().enumerate() {
            let readable = parse_expression(coordinate.name())
                .is_ok_and(|read| read.as_symbol() == Some(*coordinate));
            if !readable || coordinate.primes() > 0 || coordinate.name() == "t" {
                return Err(MechanicsError::Name(coordinate.name().to_owned()));
            }
            if self.coordinates[..index].contains(coordinate) {
                return Err(MechanicsError::Twice(*coordinate));
            }
        }
        if let Some(on) = self.forces.keys().find(|on| !self.coordinates.contains(on)) {
            return Err(MechanicsError::ForceOnNothing(*on));
        }
        for (part, expression) in self.parts() {
            for name in expression.symbols() {
                let why = match name.primes() {
                    0 => continue,
                    _ if !self.coordinates.contains(&name.coordinate()) => {
                        "no coordinate has that name"
                    }
                    1 if part == "potential energy" => {
                        "a potential depends on coordinates alone; what depends on velocities belongs to the kinetic energy, the \
                         dissipation or the forces"
                    }
                    1 => continue,
                    _ => "energies and forces depend on coordinates, velocities and time alone",
                };
                return Err(MechanicsError::Derivative { part, name, why });
            }
        }
        for (part, energy) in self.parts().take(2) {
            if let Some(jump) = lagrange::jump(energy, &self.coordinates) {
                return Err(MechanicsError::Jump { part, jump });
            }
        }
        for coordinate in &self.coordinates {
            if !self.kinetic.contains(coordinate.derivative()) {
                return Err(MechanicsError::NoInertia(*coordinate));
            }
        }
        Ok(())
    }
}
