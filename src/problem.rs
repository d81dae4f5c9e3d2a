//! One input file, in TOML: every key optional, the paper's value the default, an unknown key an error.
//!
//! Angles in radians, `[design]` in SI units, the rest dimensionless as in the paper's equation (7), time in units of
//! 1/omega, omega^2 = g/L.

mod damper;
mod keys;
mod mistakes;

use std::str::FromStr;

use serde::Deserialize;

use crate::expr::{ParseError, parse_expression};
use crate::impact::hertz::{Design, NotPositive};
use crate::impact::{DEFAULT_AMPLITUDE, DEFAULT_BARRIER, Rule, UnknownRule};
use crate::symbol::Symbol;
use crate::values::{ValueError, Values};

pub use damper::{Damper, DamperError, PARAMETERS};
pub use keys::{KEYS, Reader, UnreadKey};

/// The largest file that is read, in bytes.
pub const LARGEST_FILE: usize = 1 << 20;

/// A problem file as it was written.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Problem {
    /// The equation of motion, for formulas.
    pub equation: Option<String>,
    /// The name of a method.
    pub method: Option<String>,
    /// The order of the expansion; for an impact, that of the frequency law of the approach.
    pub order: Option<Order>,
    /// The name of the small parameter.
    pub small: Option<String>,
    /// The amplitude convention: `initial` or `first-harmonic`.
    pub amplitude: Option<String>,
    /// The equilibrium to swing about: `"x = 1"`.
    pub about: Option<String>,
    /// Values for `--at`: numbers, or text such as "pi/3".
    pub values: toml::Table,
    /// The swing.
    pub pendulum: Pendulum,
    /// The barrier.
    pub contact: Contact,
    /// Damping of the swing.
    pub damping: Damping,
    /// Motion of the pivot.
    pub excitation: Excitation,
    /// Mass, radius, length, modulus, gravity.
    pub design: DesignSection,
    /// Duration and accuracy of integrations.
    pub run: Run,
    /// The keys that are given, as [`KEYS`] names them: what is absent has its default.
    #[serde(skip)]
    pub given: Vec<String>,
}

/// A whole number, or the two degrees of a Pade approximant: `order = 4`, `order = [2, 1]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(untagged, expecting = "expected a whole number, or two: [numerator, denominator]")]
pub enum Order {
    /// The highest power kept, or what the method counts.
    Power(u32),
    /// Degrees of numerator and denominator.
    Degrees([u32; 2]),
}

/// `[pendulum]`: released from rest at `x = -amplitude`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Pendulum {
    /// A, rad.
    pub amplitude: f64,
    /// x_c, rad, or `[left, right]`.
    pub barrier: Barrier,
    /// x(0), rad, where it is not -amplitude.
    pub start: Option<f64>,
    /// x'(0), where it is not 0.
    pub speed: Option<f64>,
}

/// One barrier on the right, or one on either side.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(untagged, expecting = "expected a number, or two: [left, right]")]
pub enum Barrier {
    /// The position of the right one.
    Right(f64),
    /// The positions of both.
    Both([f64; 2]),
}

/// `[contact]`
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Contact {
    /// Dimensionless stiffness; from `[design]` by equation (8) where it is not given.
    pub gamma: Option<f64>,
    /// Dimensionless contact damping of equation (7).
    pub mu: Option<f64>,
    /// Contact damping of Hunt and Crossley, s/m.
    pub lambda: Option<f64>,
    /// The rule by which a line replaces the elastic force.
    pub linearisation: Option<String>,
}

/// `[damping]`
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Damping {
    /// Viscous damping ratio.
    pub zeta: f64,
    /// Coulomb friction.
    pub alpha: f64,
    /// `exact` or `arctangent`.
    pub friction: Option<String>,
}

/// `[excitation]`
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Excitation {
    /// beta = (A_e/L)(Omega/omega)^2.
    pub beta: f64,
    /// Omega/omega.
    pub frequency_ratio: f64,
}

/// `[design]`, SI units; the defaults are the paper's Table 5.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct DesignSection {
    /// kg
    pub mass: f64,
    /// m
    pub radius: f64,
    /// m
    pub length: f64,
    /// Pa
    pub modulus: f64,
    /// m/s^2
    pub gravity: f64,
}

/// `[run]`
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Run {
    /// Dimensionless time.
    pub duration: f64,
    /// Error allowed in one step.
    pub integrator_tolerance: f64,
    /// Steps after which an integration gives up.
    pub step_limit: u32,
}

impl Default for Pendulum {
    fn default() -> Self {
        Self {
            amplitude: DEFAULT_AMPLITUDE,
            barrier: Barrier::Right(DEFAULT_BARRIER),
            start: None,
            speed: None,
        }
    }
}

impl Default for DesignSection {
    fn default() -> Self {
        let Design {
            mass,
            radius,
            length,
            modulus,
            gravity,
        } = Design::default();
        Self {
            mass,
            radius,
            length,
            modulus,
            gravity,
        }
    }
}

impl Default for Run {
    fn default() -> Self {
        Self {
            duration: 50.0,
            integrator_tolerance: 1e-10,
            step_limit: 250_000,
        }
    }
}

/// Why a file is no problem.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ProblemError {
    /// Not TOML, or a key or value that does not belong there; the text shows the line.
    #[error("{message}")]
    Toml {
        /// The message with the line and a caret.
        message: String,
        /// The nearest known key.
        help: Option<String>,
    },
    /// Too long.
    #[error("the text is longer than the {LARGEST_FILE} bytes that a problem may have")]
    TooLarge,
    /// A value of `[values]` is neither a number nor an expression.
    #[error("the value of `{0}` in [values] should be a number, or text such as \"pi/3\"")]
    Value(String),
    /// A value that does not parse.
    #[error("the value of `{name}` in [values]: {error}")]
    Expression {
        /// The name.
        name: String,
        /// What is wrong with it.
        error: Box<ParseError>,
    },
    /// A value that is no number.
    #[error(transparent)]
    NoValue(#[from] ValueError),
    /// A design that has no stiffness.
    #[error("[design]: {0}")]
    Design(#[from] NotPositive),
    /// An unknown rule.
    #[error("[contact]: {0}")]
    Rule(#[from] UnknownRule),
}

impl ProblemError {
    /// What to write instead, where it is known.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Toml { help, .. } => help.clone(),
            _ => None,
        }
    }
}

impl FromStr for Problem {
    type Err = ProblemError;

    fn from_str(text: &str) -> Result<Self, ProblemError> {
        if text.len() > LARGEST_FILE {
            return Err(ProblemError::TooLarge);
        }
        let text = text.trim_start_matches('\u{feff}');
        let problem: Self = toml::from_str(text).map_err(|error| mistakes::in_words(text, &error))?;
        let given = toml::from_str(text).map_or_else(|_| Vec::new(), |file| keys::given(&file));
        Ok(Self { given, ..problem })
    }
}

impl Problem {
    /// The dimensionless stiffness of the contact, and where it comes from.
    ///
    /// # Errors
    /// A design with a quantity that is not positive.
    pub fn stiffness(&self) -> Result<(f64, &'static str), ProblemError> {
        if let Some(gamma) = self.contact.gamma {
            let of_design = |key: &&str| self.gives(&format!("[design] {key}"));
            let unused = self.unused_design().iter().any(of_design);
            return Ok((
                gamma,
                match unused {
                    true => "given: [design] has no say in it",
                    false => "given",
                },
            ));
        }
        let DesignSection {
            mass,
            radius,
            length,
            modulus,
            gravity,
        } = self.design;
        let design = Design {
            mass,
            radius,
            length,
            modulus,
            gravity,
        };
        let source = if self.design == DesignSection::default() {
            "equation (8) with the paper's Table 5 and l = L; the paper prints no gamma"
        } else {
            "equation (8) with the given design and l = L"
        };
        Ok((design.stiffness()?, source))
    }

    /// The keys of `[design]` that change nothing because `[contact] gamma` is given.
    fn unused_design(&self) -> &'static [&'static str] {
        match (self.contact.gamma, self.contact.lambda) {
            (None, _) => &[],
            (Some(_), None) => &["mass", "radius", "modulus", "length", "gravity"],
            // mu = gamma*lambda*sqrt(g*L)
            (Some(_), Some(_)) => &["mass", "radius", "modulus"],
        }
    }

    /// The rule that replaces the elastic force by a line.
    ///
    /// # Errors
    /// An unknown name.
    pub fn linearisation(&self) -> Result<Rule, ProblemError> {
        match &self.contact.linearisation {
            None => Ok(Rule::default()),
            Some(name) => Ok(name.parse()?),
        }
    }

    /// `[values]` as exact numbers: `1.5` is 3/2.
    ///
    /// # Errors
    /// A value that is neither a number nor an expression without symbols.
    pub fn exact_values(&self) -> Result<Values, ProblemError> {
        let mut values = Values::default();
        for (name, value) in &self.values {
            let text = match value {
                toml::Value::String(text) => text.clone(),
                toml::Value::Integer(number) => number.to_string(),
                // The shortest decimal that reads back to the same float is what was typed.
                toml::Value::Float(number) if number.is_finite() => number.to_string(),
                _ => return Err(ProblemError::Value(name.clone())),
            };
            let error = |error| ProblemError::Expression {
                name: name.clone(),
                error: Box::new(error),
            };
            values.insert(Symbol::new(name), parse_expression(&text).map_err(error)?)?;
        }
        Ok(values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_are_the_papers() {
        let problem: Problem = "".parse().unwrap();
        assert_eq!(
            problem.pendulum,
            Pendulum {
                amplitude: 1.5,
                barrier: Barrier::Right(0.323),
                start: None,
                speed: None,
            }
        );
        let (gamma, source) = problem.stiffness().unwrap();
        assert!((gamma / 3.0407e7 - 1.0).abs() < 1e-4, "{gamma} by {source}");
    }

    #[test]
    fn unknown_keys_name_the_nearest_known_one() {
        let error = "[pendulum]\nbariers = 0.3".parse::<Problem>().unwrap_err();
        assert_eq!(error.help().as_deref(), Some("did you mean `barrier`?"));
        assert!(error.to_string().contains("line 2"), "{error}");
    }

    #[test]
    fn values_are_exact() {
        let problem: Problem = "[values]\nA = 0.323\nB = \"pi/3\"\nC = 2".parse().unwrap();
        let values = problem.exact_values().unwrap();
        let texts: Vec<String> = values.iter().map(|(name, value)| format!("{name} = {value}")).collect();
        assert_eq!(texts, ["A = 323/1000", "B = pi/3", "C = 2"]);
        assert!(
            "[values]\nA = \"k\""
                .parse::<Problem>()
                .unwrap()
                .exact_values()
                .is_err()
        );
    }
}
