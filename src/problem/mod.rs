//! Problem files in TOML, and the part of a file that each command reads.
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
//! - the motion of a given equation, [`Problem::course`];
//! - a mechanism by its energies, [`Problem::mechanism`]: if it has a single coordinate, its
//!   equation is derived at once, and every command that reads an equation reads that one; of
//!   several the equations are [`Problem::coupled_equations`], for `response`.

mod contact;
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
mod wall;

use std::str::FromStr;

use crate::impact::contact::UnknownContactLaw;
use crate::impact::hertz::{NotPositive, StiffnessDesign};
use crate::impact::{CollisionError, ModelError, Parameter, SpeedUnit, UnknownRule};
use crate::mechanics::MechanicsError;
use crate::optimize::OptimizeError;
use crate::oscillator::OscillatorError;
use crate::trajectory::TrajectoryError;
use crate::values::ValueError;

pub use document::{
    Barrier, BarrierSection, BarrierSide, Contact, Damping, DesignSection, Excitation,
    GeneticSection, LagrangianSection, LimitsSection, MaterialSection, NoBarrier, Objectives,
    Order, Pendulum, PrimarySection, Problem, Range, Run, SphereSection, WallSection,
};
pub use formula::FormulaProblem;
pub use keys::{ReadingCommand, keys};
pub(crate) use mistakes::{at_place, in_words};
pub use primary::PrimaryProblem;
pub use simulate::Simulate;

/// The size of the largest file that is read, in bytes.
pub const LARGEST_FILE: usize = 1 << 20;

/// The error of a problem file: the key, what is wrong with it, and what to write instead.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct ProblemError {
    message: String,
    help: Option<String>,
}

impl ProblemError {
    /// An error with this message.
    pub(crate) fn new(message: impl ToString) -> Self {
        Self { message: message.to_string(), help: None }
    }

    /// Returns the error with advice.
    #[must_use]
    pub(crate) fn with_help(self, help: impl Into<Option<String>>) -> Self {
        Self { help: help.into(), ..self }
    }

    /// Advice on what to write instead; `None` if there is none.
    pub fn help(&self) -> Option<String> {
        self.help.clone()
    }
}

/// An error with this message.
fn refused<T>(message: impl ToString) -> Result<T, ProblemError> {
    Err(ProblemError::new(message))
}

/// Converts errors of the engine: those that name the key themselves, and those to which its
/// section is added.
macro_rules! as_problem_errors {
    ($($error:ty: $words:literal,)*) => {$(
        impl From<$error> for ProblemError {
            fn from(error: $error) -> Self {
                Self::new(format!($words, error))
            }
        }
    )*};
}

as_problem_errors! {
    CollisionError: "{}",
    MechanicsError: "[lagrangian]: {}",
    ModelError: "{}",
    NotPositive: "[design]: {}",
    OptimizeError: "{}",
    OscillatorError: "{}",
    TrajectoryError: "{}",
    UnknownContactLaw: "[contact] law: {}, or all for a table of them",
    UnknownRule: "[contact]: {}",
    ValueError: "{}",
}

/// The error of a text beyond [`LARGEST_FILE`].
pub(crate) fn too_large() -> ProblemError {
    let limit = format!("the {LARGEST_FILE} bytes that a problem may have");
    ProblemError::new(format!("the text is longer than {limit}"))
}

impl FromStr for Problem {
    type Err = ProblemError;

    fn from_str(text: &str) -> Result<Self, ProblemError> {
        if text.len() > LARGEST_FILE {
            return Err(too_large());
        }
        let text = text.trim_start_matches('\u{feff}');
        let problem: Self =
            toml::from_str(text).map_err(|error| mistakes::in_words(text, &error))?;
        let given = toml::from_str(text).map_or_else(|_| Vec::new(), |file| keys::given(&file));
        Self { given, ..problem }.with_contact_forces()?.with_derived_equation()
    }
}

impl Problem {
    /// The dimensionless stiffness of the contact, and its source in words.
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

    /// Whether a damping is given in a form that needs mass, length and gravity.
    fn damps_in_si_units(&self) -> bool {
        let in_si = [self.contact.damping, self.damping.viscous, self.damping.torque];
        in_si.iter().any(Option::is_some)
    }

    /// The unit of `at_speed`: m/s if the file gives any of its numbers in SI units, or one of the
    /// `swept` ones is in SI units.
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

    /// The source of the stiffness of the contact, with this design.
    fn stiffness_source(&self, design: &StiffnessDesign) -> &'static str {
        if self.contact.gamma.is_none() {
            return match *design == StiffnessDesign::default() {
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
            keys.any(|key| self.has_key(&key))
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
