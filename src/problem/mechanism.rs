//! The mechanism of a file: energies, forces, units; and the equation that follows, if there is one
//! coordinate.

use std::collections::BTreeMap;

use super::document::LagrangianSection;
use super::{Problem, ProblemError, ReadingCommand, refused};
use crate::expr::{Expr, parse_equation, parse_expression};
use crate::mechanics::{Dimension, EquationsOfMotion, Mechanism, MechanismQuestion, UnitError};
use crate::symbol::Symbol;

impl Problem {
    /// The mechanism of the file and the units of its symbols, ready for
    /// [`study`](crate::mechanics::study).
    ///
    /// # Errors
    /// [`ProblemError`] names the key; values as in [`Problem::exact_values`].
    ///
    /// ```
    /// use lindstedt::problem::Problem;
    ///
    /// let file: Problem = "[lagrangian]\ncoordinates = [\"x\"]\nkinetic = \"m*x'^2/2\"\npotential = \"k*x^2/2\"".parse()?;
    /// assert_eq!(file.mechanism()?.mechanism.equations()?.to_string(), "x'' + k*x/m = 0");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn mechanism(&self) -> Result<MechanismQuestion, ProblemError> {
        let section = self.lagrangian.as_ref().ok_or_else(no_mechanism)?;
        let mechanism = section.mechanism()?;
        let units = match self.units.is_empty() {
            true => None,
            false => Some(self.mechanism_units()?),
        };
        Ok(MechanismQuestion { mechanism, units, values: BTreeMap::new() })
    }

    fn mechanism_units(&self) -> Result<BTreeMap<Symbol, Dimension>, ProblemError> {
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

    /// Returns the file with the equation that its energies give, if it has one coordinate: for the
    /// commands that derive, compare and simulate.
    ///
    /// # Errors
    /// Energies that give no equation, or terms of a wrong unit.
    pub(super) fn with_derived_equation(mut self) -> Result<Self, ProblemError> {
        if self.lagrangian.is_none() {
            return match self.units.is_empty() {
                true => Ok(self),
                false => refused(
                    "[units] belong to the energies of a [lagrangian], which the file does not have",
                ),
            };
        }
        if self.equation.is_some() {
            return refused(
                "the file has an `equation` and a [lagrangian], which gives another: leave one of them out",
            );
        }
        let question = self.mechanism()?;
        let equations = question.mechanism.equations()?;
        if let Some(units) = &question.units {
            question.mechanism.check_units(units)?;
        }
        // A mass that is a factor of all energies is a symbol of the file that does not affect the
        // motion.
        let cancels = |name: &Symbol| equations.left.iter().all(|left| !left.contains(*name));
        self.cancelled = question.mechanism.parameters().into_iter().filter(cancels).collect();
        if let [left] = equations.left.as_slice() {
            self.equation = Some(format!("{left} = 0"));
        }
        Ok(self)
    }

    /// The equations of a mechanism of several coordinates, for a command that takes coupled
    /// equations; `None` of a file that has a single equation.
    ///
    /// # Errors
    /// A key that the command would ignore; energies that give no equation.
    ///
    /// ```
    /// use lindstedt::problem::{Problem, ReadingCommand};
    ///
    /// let file: Problem = "[lagrangian]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"(x'^2 + y'^2)/2\"\npotential = \"(x^2 + (x - y)^2)/2\"".parse()?;
    /// let equations = file.coupled_equations(ReadingCommand::Response)?.ok_or("one coordinate")?;
    /// assert_eq!(equations.left.len(), 2);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn coupled_equations(
        &self,
        reader: ReadingCommand,
    ) -> Result<Option<EquationsOfMotion>, ProblemError> {
        match &self.lagrangian {
            Some(section) if section.coordinates.len() > 1 => {
                self.check_keys(reader)?;
                Ok(Some(self.mechanism()?.mechanism.equations()?))
            }
            _ => Ok(None),
        }
    }

    /// Whether the derived equation can be read as one that was typed.
    ///
    /// # Errors
    /// A coordinate whose name has several letters, or a parameter with a name that answers use.
    pub(super) fn check_derived_equation(&self) -> Result<(), ProblemError> {
        let (Some(section), Some(equation)) = (&self.lagrangian, &self.equation) else {
            let count = self.lagrangian.as_ref().map_or(1, |section| section.coordinates.len());
            return match count {
                1 => Ok(()),
                count => refused(format!(
                    "the file describes a mechanism of {count} coordinates, and one equation of motion is wanted: `lindstedt lagrange` \
                     derives its equations, `lindstedt simulate` follows them"
                )),
            };
        };
        let own = section.coordinates.first().cloned().unwrap_or_default();
        match parse_equation(equation) {
            Ok(_) => Ok(()),
            Err(error) => {
                let help = "to hand an equation on, name the coordinate by a letter (Greek ones by name, such as phi) and its \
                            parameters by other names than A, a and omega; `lindstedt lagrange` takes any";
                let error = ProblemError::new(format!("the coordinate `{own}`: {error}"));
                Err(error.with_help(help.to_owned()))
            }
        }
    }
}

impl From<UnitError> for ProblemError {
    fn from(error: UnitError) -> Self {
        Self::new(format!("[units]: {error}")).with_help(error.help())
    }
}

/// The refusal of a file without a mechanism.
pub(super) fn no_mechanism() -> ProblemError {
    needs_energies("the file has no [lagrangian]: give coordinates, kinetic and potential")
}

fn missing(key: &str) -> ProblemError {
    needs_energies(&format!("[lagrangian] has no `{key}`"))
}

fn needs_energies(message: &str) -> ProblemError {
    let example =
        "coordinates = [\"x\"], kinetic = \"m*L^2*x'^2/2\", potential = \"m*g*L*(1 - cos(x))\"";
    ProblemError::new(message).with_help(example.to_owned())
}

impl LagrangianSection {
    fn mechanism(&self) -> Result<Mechanism, ProblemError> {
        let read = |key: &str, text: &str| {
            parse_expression(text)
                .map_err(|error| ProblemError::new(format!("[lagrangian] {key}: {error}")))
        };
        if self.coordinates.is_empty() {
            return Err(missing("coordinates"));
        }
        let kinetic = self.kinetic.as_ref().ok_or_else(|| missing("kinetic"))?;
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
            forces: self.forces.iter().map(force).collect::<Result<_, ProblemError>>()?,
        })
    }
}
