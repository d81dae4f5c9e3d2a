//! Vibration absorbers: the design formulas of a small mass that takes the vibration of a large one.
//!
//! In: a kind of absorber. Out: its equations of motion, and designs, each a list of formulas in the
//! letters of the equations, derived from them.
//!
//! - `tuned`: the tuned mass damper, by exact algebra of its frequency response.
//! - `damped`: the same on a main mass with damping of its own, to first order in it.
//! - `nonlinear`: the tuned mass damper on a main mass with a cubic spring, with a cubic spring of its own, by
//!   perturbation of its two peaks.
//! - `impact_sink`: a ball in a cavity or a pendulum between barriers, by the conditions of its impacts.
//! - `cubic_sink`: a light mass on a cubic spring, by the first harmonic of its motion.

mod cubic_sink;
mod damped;
mod impact_sink;
mod nonlinear;
mod tuned;

use std::collections::BTreeMap;
use std::ops::{Bound, RangeBounds as _};

use thiserror::Error;

use crate::coupled::CoupledError;
use crate::expr::{Expr, ExprError};
use crate::solution::{Definition, defined_values};
use crate::symbol::Symbol;
use crate::values::Values;

/// The excitation of the main mass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Excitation {
    /// A force on the main mass.
    #[default]
    Force,
    /// The acceleration of the ground; displacements are relative to it.
    Ground,
}

/// A kind of absorber.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AbsorberKind {
    /// The tuned mass damper on a main mass without damping.
    Tuned(Excitation),
    /// The tuned mass damper on a main mass with damping of its own.
    Damped(Excitation),
    /// The nonlinear tuned absorber, with a cubic spring like that of the main mass.
    Nonlinear,
    /// The vibro-impact sink, a ball in a cavity.
    ImpactSink,
    /// The vibro-impact sink, a pendulum between two barriers.
    PendulumSink,
    /// The nonlinear energy sink, a light mass on a cubic spring.
    CubicSink,
}

impl AbsorberKind {
    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tuned(_) => "tuned",
            Self::Damped(_) => "damped",
            Self::Nonlinear => "nonlinear",
            Self::ImpactSink => "impact-sink",
            Self::PendulumSink => "pendulum-sink",
            Self::CubicSink => "cubic-sink",
        }
    }

    /// The letters of the designs, with the values that each may have.
    pub fn letters(self) -> &'static [AbsorberLetter] {
        match self {
            Self::Tuned(Excitation::Force) => &[tuned::MASS_RATIO],
            Self::Tuned(Excitation::Ground) => &[tuned::MASS_RATIO_BELOW_TWO],
            Self::Damped(Excitation::Force) => &damped::LETTERS,
            Self::Damped(Excitation::Ground) => &damped::LETTERS_BELOW_TWO,
            Self::Nonlinear => &nonlinear::LETTERS,
            Self::ImpactSink => &impact_sink::LETTERS,
            Self::PendulumSink => &impact_sink::LETTERS_OF_PENDULUM,
            Self::CubicSink => &cubic_sink::LETTERS,
        }
    }
}

/// A letter that stands in the formulas of a design.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AbsorberLetter {
    /// The letter.
    pub name: &'static str,
    /// Its meaning in words.
    pub meaning: &'static str,
    /// The range of its values.
    pub range: (Bound<f64>, Bound<f64>),
    /// A usual value, for advice.
    pub example: &'static str,
}

/// The formulas of a kind of absorber.
#[derive(Clone, Debug)]
pub struct AbsorberLaws {
    /// The kind.
    pub kind: AbsorberKind,
    /// The equations of motion.
    pub equations: Vec<(Expr, Expr)>,
    /// The meanings of the letters of the equations and the formulas.
    pub meanings: Vec<(Symbol, &'static str)>,
    /// The symbols that shorten the formulas.
    pub definitions: Vec<Definition>,
    /// The relations that the designs are derived from.
    pub relations: Vec<AbsorberRelation>,
    /// The designs.
    pub designs: Vec<AbsorberDesign>,
    /// What the formulas leave out.
    pub validity: &'static str,
}

/// An equation on the way to the designs.
#[derive(Clone, Debug, PartialEq)]
pub struct AbsorberRelation {
    /// The left side.
    pub left: Expr,
    /// The right side.
    pub right: Expr,
    /// What it says, in words.
    pub words: &'static str,
}

/// A way to choose the absorber, or a property of it.
#[derive(Clone, Debug, PartialEq)]
pub struct AbsorberDesign {
    /// The name, such as `equal-peaks`.
    pub name: &'static str,
    /// What is best of it, in words.
    pub words: &'static str,
    /// Its formulas.
    pub formulas: Vec<AbsorberFormula>,
    /// The name of the design that has these formulas to the next order; `None` if they are the most
    /// exact ones.
    pub refined_by: Option<&'static str>,
}

/// A formula of a design.
#[derive(Clone, Debug, PartialEq)]
pub struct AbsorberFormula {
    /// The name, such as `tuning`.
    pub name: &'static str,
    /// The symbol that it gives.
    pub symbol: Symbol,
    /// The formula.
    pub formula: Expr,
}

/// The reason why there are no formulas, or no numbers of them.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum AbsorberError {
    /// The equations.
    #[error(transparent)]
    Equations(#[from] CoupledError),
    /// A step of algebra failed.
    #[error(transparent)]
    Expression(#[from] ExprError),
    /// A step of the derivation leaves no closed form.
    #[error("{0} has no closed form")]
    NoClosedForm(&'static str),
    /// A letter has no value.
    #[error("{} {} no value", listed(.0), if .0.len() == 1 { "has" } else { "have" })]
    Missing(Vec<Symbol>),
    /// A value of a letter that the formulas do not have.
    #[error("`{name}` is no letter of this absorber, which has {}", listed(.known))]
    Unknown {
        /// The name.
        name: Symbol,
        /// The letters.
        known: Vec<Symbol>,
    },
    /// A value that the letter cannot have.
    #[error("{name} = {value}: {meaning} is {range}")]
    Outside {
        /// The letter.
        name: Symbol,
        /// The value as it was given.
        value: Expr,
        /// What the letter is.
        meaning: &'static str,
        /// The values that it may have, in words.
        range: String,
        /// A usual value.
        example: &'static str,
    },
}

/// A range in words.
fn in_words(range: (Bound<f64>, Bound<f64>)) -> String {
    match range {
        (Bound::Excluded(0.0), Bound::Unbounded) => "positive".to_owned(),
        (least, most) => {
            let least = match least {
                Bound::Excluded(least) => format!("above {least}"),
                Bound::Included(least) => format!("at least {least}"),
                Bound::Unbounded => String::new(),
            };
            let most = match most {
                Bound::Excluded(most) => format!(" and below {most}"),
                Bound::Included(most) => format!(" and at most {most}"),
                Bound::Unbounded => String::new(),
            };
            least + &most
        }
    }
}

/// Names in a row.
fn listed(names: &[Symbol]) -> String {
    let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    names.join(", ")
}

impl AbsorberError {
    /// Returns advice on what to give instead; `None` if there is none.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Outside { name, example, .. } => Some(format!("such as {name}={example}")),
            _ => None,
        }
    }
}

/// Derives the formulas of a kind of absorber.
///
/// # Errors
/// [`AbsorberError::NoClosedForm`], where a step of the derivation has none.
///
/// ```
/// # use lindstedt_modes as lindstedt;
/// use lindstedt::absorber::{AbsorberKind, Excitation, derive};
///
/// let laws = derive(AbsorberKind::Tuned(Excitation::Force))?;
/// let equal_peaks = &laws.designs[0].formulas;
/// assert_eq!(equal_peaks[0].formula.to_string(), "1/(1 + mu)");
/// # Ok::<(), lindstedt::absorber::AbsorberError>(())
/// ```
pub fn derive(kind: AbsorberKind) -> Result<AbsorberLaws, AbsorberError> {
    match kind {
        AbsorberKind::Tuned(excitation) => tuned::derive(excitation),
        AbsorberKind::Damped(excitation) => damped::derive(excitation),
        AbsorberKind::Nonlinear => nonlinear::derive(),
        AbsorberKind::ImpactSink | AbsorberKind::PendulumSink => impact_sink::derive(kind),
        AbsorberKind::CubicSink => cubic_sink::derive(),
    }
}

impl AbsorberLaws {
    /// Checks that every letter of the designs has a value that it may have, and nothing else has.
    ///
    /// # Errors
    /// [`AbsorberError`] for the first value that is missing, unknown or outside its range.
    pub fn check(&self, values: &Values) -> Result<(), AbsorberError> {
        let letters = self.kind.letters();
        for (name, value) in values.iter() {
            let Some(letter) = letters.iter().find(|letter| letter.name == name.name()) else {
                let known = letters.iter().map(|letter| Symbol::new(letter.name)).collect();
                return Err(AbsorberError::Unknown { name, known });
            };
            let number = values.get(name).unwrap_or(f64::NAN);
            if !letter.range.contains(&number) {
                return Err(AbsorberError::Outside {
                    name,
                    value: value.clone(),
                    meaning: letter.meaning,
                    range: in_words(letter.range),
                    example: letter.example,
                });
            }
        }
        let missing: Vec<Symbol> = letters
            .iter()
            .map(|letter| Symbol::new(letter.name))
            .filter(|name| values.get(*name).is_none())
            .collect();
        if missing.is_empty() { Ok(()) } else { Err(AbsorberError::Missing(missing)) }
    }

    /// The design of this name.
    pub fn design(&self, name: &str) -> Option<&AbsorberDesign> {
        self.designs.iter().find(|design| design.name == name)
    }
}

impl AbsorberLaws {
    /// The value of a formula at these values; `None` if it has no finite one.
    pub fn value(&self, formula: &Expr, values: &Values) -> Option<f64> {
        self.value_of_numbers(formula, values.numbers())
    }

    fn value_of_numbers(&self, formula: &Expr, mut known: BTreeMap<Symbol, f64>) -> Option<f64> {
        known.insert(Symbol::new("pi"), std::f64::consts::PI);
        let defined = defined_values(&self.definitions, &|name| known.get(&name).copied()).ok()?;
        known.extend(defined);
        formula.evaluate(&known).ok().filter(|value| value.is_finite())
    }

    /// The value of the right side of the relation with this left side, with numbers for its letters.
    pub fn relation_value(&self, left: &Expr, numbers: BTreeMap<Symbol, f64>) -> Option<f64> {
        let relation = self.relations.iter().find(|relation| relation.left == *left)?;
        self.value_of_numbers(&relation.right, numbers)
    }

    /// The value of the formula with these names of design and quantity.
    pub fn named_value(&self, design: &str, quantity: &str, values: &Values) -> Option<f64> {
        let formulas = &self.design(design)?.formulas;
        let formula = formulas.iter().find(|formula| formula.name == quantity)?;
        self.value(&formula.formula, values)
    }
}
