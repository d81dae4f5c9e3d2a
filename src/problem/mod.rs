//! Problem files: one document, in TOML, and what each command reads in it.
//!
//! In: the text of a file: every key optional, the paper's value the default, an unknown key an
//! error. Angles in radians, masses, lengths and materials in SI units, the rest dimensionless as
//! in the paper's equation (7), time in units of 1/omega, omega^2 = g/L. Out: a [`Problem`], and
//! from it, with the keys that a command would ignore refused by name:
//!
//! - [`Problem::formula`], what `derive`, `compare` and `response` read;
//! - an impact in closed form, [`Setup`](crate::impact::Setup), by `TryFrom`;
//! - a motion of the full equation, [`Simulate`], by `TryFrom`, or by [`Problem::simulate`] where
//!   parameters are swept;
//! - barriers of several materials, [`Problem::materials`];
//! - a search for the best design, [`Problem::optimize`];
//! - the motion of an equation of one's own, [`Problem::course`];
//! - a mechanism by its energies, [`Problem::mechanism`]: of one with a single coordinate the
//!   equation is derived at once, and every command that reads an equation reads that.

mod design;
mod document;
mod formula;
mod impact;
mod keys;
mod materials;
mod mechanism;
mod mistakes;
mod optimize;
mod primary;
mod simulate;
mod trajectory;

use std::str::FromStr;

use crate::expr::ParseError;
use crate::impact::hertz::{Design, NotPositive};
use crate::impact::{Parameter, SpeedUnit, UnknownRule};
use crate::values::ValueError;

pub use design::DesignError;
pub use document::{
    Barrier, BarrierSection, BarrierSide, Contact, Damping, DesignSection, Excitation,
    GeneticSection, LagrangianSection, LimitsSection, MaterialSection, NoBarrier, Objectives,
    Order, Pendulum, PrimarySection, Problem, Range, Run, SphereSection,
};
pub use formula::{Formula, FormulaError};
pub use impact::ImpactFileError;
pub use keys::{KEYS, Reader, UnreadKey};
pub use materials::MaterialsFileError;
pub use mechanism::MechanismFileError;
pub(crate) use mistakes::in_words;
pub use optimize::OptimizeFileError;
pub use primary::{PrimaryFileError, PrimaryProblem};
pub use simulate::{Simulate, SimulateError};
pub use trajectory::TrajectoryFileError;

/// The largest file that is read, in bytes.
pub const LARGEST_FILE: usize = 1 << 20;

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
    /// Bodies that are none.
    #[error(transparent)]
    Bodies(#[from] DesignError),
    /// Energies that give no equation of motion.
    #[error(transparent)]
    Mechanism(#[from] MechanismFileError),
    /// An unknown rule.
    #[error("[contact]: {0}")]
    Rule(#[from] UnknownRule),
}

impl ProblemError {
    /// What to write instead, where it is known.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Toml { help, .. } => help.clone(),
            Self::Mechanism(error) => error.help(),
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
        let problem: Self =
            toml::from_str(text).map_err(|error| mistakes::in_words(text, &error))?;
        let given = toml::from_str(text).map_or_else(|_| Vec::new(), |file| keys::given(&file));
        Self { given, ..problem }.with_derived_equation()
    }
}

impl Problem {
    /// The dimensionless stiffness of the contact, and where it comes from.
    ///
    /// # Errors
    /// A design with a quantity that is not positive.
    fn stiffness(&self) -> Result<(f64, &'static str), ProblemError> {
        let design = self.design()?;
        let source = self.stiffness_source(&design);
        match self.contact.gamma {
            Some(gamma) => Ok((gamma, source)),
            None => Ok((design.stiffness()?, source)),
        }
    }

    /// Whether something that damps is given by mass, length and gravity.
    fn damps_in_si_units(&self) -> bool {
        let in_si = [self.contact.damping, self.damping.viscous, self.damping.torque];
        in_si.iter().any(Option::is_some)
    }

    /// The unit of `at_speed`: m/s where the file gives any of its numbers in SI units, or one of
    /// the `swept` ones is.
    fn speed_unit(&self, swept: &[Parameter]) -> SpeedUnit {
        use Parameter::{
            ContactDamping, Gravity, Lambda, Length, Mass, Modulus, Radius, Torque, Viscous,
        };
        let of_pendulum = self.equation.is_none() && self.contact.force.is_none();
        let sections = [
            "[design]",
            "[sphere]",
            "[barrier]",
            "[limits]",
            "[pendulum] mass",
            "[pendulum] length",
            "[pendulum] gravity",
        ];
        let gives = |section: &str| self.given.iter().any(|key| key.starts_with(section));
        let by_sections = sections.into_iter().any(gives) || !self.material.is_empty();
        let parameters =
            [Lambda, ContactDamping, Viscous, Torque, Mass, Radius, Length, Modulus, Gravity];
        let by_parameters =
            || parameters.into_iter().any(|key| swept.contains(&key) || self.gives_parameter(key));
        match of_pendulum && (by_sections || by_parameters()) {
            true => SpeedUnit::MetresPerSecond,
            false => SpeedUnit::RadOmega,
        }
    }

    /// Where the stiffness of the contact comes from, with this design.
    fn stiffness_source(&self, design: &Design) -> &'static str {
        if self.contact.gamma.is_none() {
            return match *design == Design::default() {
                true => {
                    "equation (8) with the paper's Table 5 and l = L; the paper prints no gamma"
                }
                false => "equation (8) with the given design and l = L",
            };
        }
        let by_length = self.contact.lambda.is_some() || self.contact.at_speed.is_some();
        let without_say: &[&str] = match (self.damps_in_si_units(), by_length) {
            (true, _) => &["radius", "modulus", "poisson"],
            // mu = gamma*lambda*sqrt(g*L), and v/sqrt(g*L) for a speed in m/s
            (false, true) => &["mass", "radius", "modulus", "poisson"],
            (false, false) => &["mass", "radius", "modulus", "poisson", "length", "gravity"],
        };
        let gives = |sections: &[&str]| {
            let mut keys = without_say
                .iter()
                .flat_map(|key| sections.iter().map(move |section| format!("[{section}] {key}")));
            keys.any(|key| self.gives(&key))
        };
        match (gives(&["design"]), gives(&["pendulum", "sphere", "barrier"])) {
            (true, _) => "given: [design] has no say in it",
            (false, true) => "given: masses, lengths and moduli have no say in it",
            (false, false) => "given",
        }
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
                barrier: Barrier::One(0.323),
                side: None,
                start: None,
                speed: None,
                mass: None,
                length: None,
                gravity: None,
            }
        );
        let (gamma, source) = problem.stiffness().unwrap();
        assert!((gamma / 3.0407e7 - 1.0).abs() < 1e-4, "{gamma} by {source}");
    }

    #[test]
    fn a_gamma_that_is_given_says_what_has_no_say() {
        let source = |beside: &str| {
            let file = format!("[contact]\ngamma = 1e6\n{beside}");
            file.parse::<Problem>().unwrap().stiffness().unwrap().1
        };
        assert_eq!(source(""), "given");
        assert_eq!(source("[design]\nmass = 0.02"), "given: [design] has no say in it");
        for beside in
            ["[pendulum]\nmass = 0.02", "[sphere]\nradius = 0.02", "[barrier]\nmodulus = 2e9"]
        {
            assert_eq!(source(beside), "given: masses, lengths and moduli have no say in it");
        }
        // mu = gamma*lambda*sqrt(g*L)
        assert_eq!(source("lambda = 0.1\n[pendulum]\nlength = 0.2"), "given");
    }

    #[test]
    fn unknown_keys_name_the_nearest_known_one() {
        let error = "[pendulum]\nbariers = 0.3".parse::<Problem>().unwrap_err();
        assert_eq!(error.help().as_deref(), Some("did you mean `barrier`?"));
        assert!(error.to_string().contains("line 2"), "{error}");
    }
}
