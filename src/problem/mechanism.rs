//! What a file says of a mechanism: energies, forces, units; and the equation that follows, where
//! there is one coordinate.

use std::collections::BTreeMap;

use thiserror::Error;

use super::document::LagrangianSection;
use super::{Problem, ProblemError};
use crate::expr::{Expr, ParseError, parse_equation, parse_expression};
use crate::mechanics::{Dimension, MechanicsError, Mechanism, MechanismQuestion, UnitError};
use crate::symbol::Symbol;

/// Why a file is no mechanism.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum MechanismFileError {
    /// A text that is no expression.
    #[error("[lagrangian] {key}: {error}")]
    Parse {
        /// The key.
        key: String,
        /// What is wrong with it.
        error: Box<ParseError>,
    },
    /// A key that must be there.
    #[error("[lagrangian] has no `{0}`")]
    Missing(&'static str),
    /// No equations of motion.
    #[error("[lagrangian]: {0}")]
    Mechanics(#[from] MechanicsError),
    /// A unit that is none, or a term of a wrong one.
    #[error("[units]: {0}")]
    Unit(#[from] UnitError),
    /// Two equations of motion.
    #[error(
        "the file has an `equation` and a [lagrangian], which gives another: leave one of them out"
    )]
    Twice,
    /// Units without a mechanism.
    #[error("[units] belong to the energies of a [lagrangian], which the file does not have")]
    OnlyUnits,
    /// No section.
    #[error("the file has no [lagrangian]: give coordinates, kinetic and potential")]
    NoMechanism,
    /// Several equations where one is wanted.
    #[error(
        "the file describes a mechanism of {0} coordinates, and one equation of motion is wanted: `lindstedt lagrange` derives its \
         equations, `lindstedt simulate` follows them"
    )]
    Several(usize),
    /// A coordinate that an equation of its own cannot have.
    #[error("the coordinate `{name}`: {error}")]
    Coordinate {
        /// The coordinate.
        name: String,
        /// What an equation says of it.
        error: Box<ParseError>,
    },
}

impl MechanismFileError {
    /// What to write instead, where it is known.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Unit(error) => error.help(),
            Self::Missing(_) | Self::NoMechanism => {
                Some("coordinates = [\"x\"], kinetic = \"m*L^2*x'^2/2\", potential = \"m*g*L*(1 - cos(x))\"".to_owned())
            }
            Self::Coordinate { .. } => Some(
                "to hand an equation on, name the coordinate by a letter (Greek ones by name, such as phi) and its parameters by other \
                 names than A, a and omega; `lindstedt lagrange` takes any"
                    .to_owned(),
            ),
            _ => None,
        }
    }
}

impl Problem {
    /// The mechanism of the file and the units of its letters, ready for
    /// [`study`](crate::mechanics::study).
    ///
    /// # Errors
    /// [`MechanismFileError`] names the key; values as in [`Problem::exact_values`].
    ///
    /// ```
    /// use lindstedt::problem::Problem;
    ///
    /// let file: Problem = "[lagrangian]\ncoordinates = [\"x\"]\nkinetic = \"m*x'^2/2\"\npotential = \"k*x^2/2\"".parse()?;
    /// assert_eq!(file.mechanism()?.mechanism.equations()?.to_string(), "x'' + k*x/m = 0");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn mechanism(&self) -> Result<MechanismQuestion, MechanismFileError> {
        let section = self.lagrangian.as_ref().ok_or(MechanismFileError::NoMechanism)?;
        let mechanism = section.mechanism()?;
        let units = match self.units.is_empty() {
            true => None,
            false => Some(self.mechanism_units()?),
        };
        Ok(MechanismQuestion { mechanism, units, values: BTreeMap::new() })
    }

    fn mechanism_units(&self) -> Result<BTreeMap<Symbol, Dimension>, MechanismFileError> {
        let unit = |(name, unit): (&String, &String)| match unit.parse() {
            Ok(unit) => Ok((Symbol::new(name), unit)),
            Err(UnitError::Parse { error, .. }) => {
                Err(UnitError::Parse { name: name.clone(), error })
            }
            Err(UnitError::Unknown { unit, .. }) => {
                Err(UnitError::Unknown { name: name.clone(), unit })
            }
            Err(UnitError::NoProduct { unit, .. }) => {
                Err(UnitError::NoProduct { name: name.clone(), unit })
            }
            Err(error) => Err(error),
        };
        Ok(self.units.iter().map(unit).collect::<Result<_, UnitError>>()?)
    }

    /// The same file with the equation that its energies give, where it has one coordinate: what
    /// derives, compares and simulates reads that.
    ///
    /// # Errors
    /// Energies that give none, or terms of a wrong unit.
    pub(super) fn with_derived_equation(mut self) -> Result<Self, ProblemError> {
        if self.lagrangian.is_none() {
            return match self.units.is_empty() {
                true => Ok(self),
                false => Err(MechanismFileError::OnlyUnits.into()),
            };
        }
        if self.equation.is_some() {
            return Err(MechanismFileError::Twice.into());
        }
        let question = self.mechanism()?;
        let equations = question.mechanism.equations().map_err(MechanismFileError::from)?;
        if let Some(units) = &question.units {
            question.mechanism.check_units(units).map_err(MechanismFileError::from)?;
        }
        // A mass that stands in all energies is a letter of the file whose value says nothing of
        // the motion.
        let cancels = |name: &Symbol| equations.left.iter().all(|left| !left.contains(*name));
        self.cancelled = question.mechanism.parameters().into_iter().filter(cancels).collect();
        if let [left] = equations.left.as_slice() {
            self.equation = Some(format!("{left} = 0"));
        }
        Ok(self)
    }

    /// Whether the derived equation can be read as one that was typed.
    ///
    /// # Errors
    /// A coordinate of several letters, or a parameter that bears the name of an answer.
    pub(super) fn check_derived_equation(&self) -> Result<(), MechanismFileError> {
        let (Some(section), Some(equation)) = (&self.lagrangian, &self.equation) else {
            let count = self.lagrangian.as_ref().map_or(1, |section| section.coordinates.len());
            return match count {
                1 => Ok(()),
                count => Err(MechanismFileError::Several(count)),
            };
        };
        let own = section.coordinates.first().cloned().unwrap_or_default();
        match parse_equation(equation) {
            Ok(_) => Ok(()),
            Err(error) => Err(MechanismFileError::Coordinate { name: own, error: Box::new(error) }),
        }
    }
}

impl LagrangianSection {
    fn mechanism(&self) -> Result<Mechanism, MechanismFileError> {
        let read = |key: &str, text: &str| {
            parse_expression(text).map_err(|error| MechanismFileError::Parse {
                key: key.to_owned(),
                error: Box::new(error),
            })
        };
        if self.coordinates.is_empty() {
            return Err(MechanismFileError::Missing("coordinates"));
        }
        let kinetic = self.kinetic.as_ref().ok_or(MechanismFileError::Missing("kinetic"))?;
        let or_zero = |key: &str, text: &Option<String>| {
            text.as_ref().map_or(Ok(Expr::zero()), |text| read(key, text))
        };
        let force = |(on, text): (&String, &String)| {
            Ok((Symbol::new(on), read(&format!("forces.{on}"), text)?))
        };
        Ok(Mechanism {
            coordinates: self.coordinates.iter().map(|name| Symbol::new(name)).collect(),
            kinetic: read("kinetic", kinetic)?,
            potential: or_zero("potential", &self.potential)?,
            dissipation: or_zero("dissipation", &self.dissipation)?,
            forces: self.forces.iter().map(force).collect::<Result<_, MechanismFileError>>()?,
        })
    }
}
