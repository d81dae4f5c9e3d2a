//! The parameters of a pendulum and its barrier that a sweep or an optimisation may vary.
//!
//! In: the name of a parameter. Out: a [`Parameter`]: its name, its group, its unit. Its value is
//! read and written on a [`Case`](super::Case).

use std::fmt;
use std::str::FromStr;

use thiserror::Error;

use crate::spelling::nearest;

/// A number that a study may vary.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Parameter {
    /// A: the release is from rest at x = -A, or at x = A towards a barrier on the left.
    Amplitude,
    /// x(0), where it is not -A.
    Start,
    /// x'(0).
    Speed,
    /// x_c, the position of the barrier towards which the pendulum is released.
    Barrier,
    /// Stiffness of the contact.
    Gamma,
    /// Damping of the contact.
    Mu,
    /// Damping of the contact over its stiffness.
    MuOverGamma,
    /// Damping of the contact by its material, of Hunt and Crossley.
    Lambda,
    /// Damping of the contact by its coefficient of restitution.
    Restitution,
    /// The speed at which the restitution is stated.
    AtSpeed,
    /// Damping of the contact in SI units.
    ContactDamping,
    /// Viscous damping ratio.
    Zeta,
    /// Viscous damping in SI units.
    Viscous,
    /// Coulomb friction.
    Alpha,
    /// Coulomb friction in SI units.
    Torque,
    /// Excitation by the pivot.
    Beta,
    /// Omega/omega of that excitation.
    FrequencyRatio,
    /// Mass of the pendulum.
    Mass,
    /// Radius of its sphere.
    Radius,
    /// Length of the pendulum.
    Length,
    /// Elastic modulus of the barrier.
    Modulus,
    /// Acceleration of gravity.
    Gravity,
}

/// Name, group, unit and meaning of a parameter.
type ParameterRow = (&'static str, &'static str, &'static str, &'static str);

impl Parameter {
    /// Every parameter, in the order of the documentation.
    pub const ALL: [Self; 22] = [
        Self::Amplitude,
        Self::Start,
        Self::Speed,
        Self::Barrier,
        Self::Gamma,
        Self::Mu,
        Self::MuOverGamma,
        Self::Lambda,
        Self::Restitution,
        Self::AtSpeed,
        Self::ContactDamping,
        Self::Zeta,
        Self::Viscous,
        Self::Alpha,
        Self::Torque,
        Self::Beta,
        Self::FrequencyRatio,
        Self::Mass,
        Self::Radius,
        Self::Length,
        Self::Modulus,
        Self::Gravity,
    ];

    const fn row(self) -> ParameterRow {
        match self {
            Self::Amplitude => ("amplitude", "pendulum", "rad", "the release from rest at x = -A"),
            Self::Start => ("start", "pendulum", "rad", "the displacement x(0)"),
            Self::Speed => ("speed", "pendulum", "rad*omega", "the velocity x'(0)"),
            Self::Barrier => ("barrier", "pendulum", "rad", "the place x_c of the right barrier"),
            Self::Gamma => ("gamma", "contact", "", "the stiffness of the contact"),
            Self::Mu => ("mu", "contact", "", "the damping of the contact"),
            Self::MuOverGamma => (
                "mu_over_gamma",
                "contact",
                "",
                "the damping of the contact over its stiffness, mu/gamma",
            ),
            Self::Lambda => (
                "lambda",
                "contact",
                "s/m",
                "the damping of the contact by its material, of Hunt and Crossley",
            ),
            Self::Restitution => (
                "restitution",
                "contact",
                "",
                "the coefficient of restitution that damps the contact",
            ),
            Self::AtSpeed => ("at_speed", "contact", "rad*omega", "the speed at which that holds"),
            Self::ContactDamping => (
                "damping",
                "contact",
                "N s/m^(5/2)",
                "the damping c of the contact, of the force (k + c d') d^(3/2)",
            ),
            Self::Zeta => ("zeta", "damping", "", "the viscous damping ratio"),
            Self::Viscous => {
                ("viscous", "damping", "N s/m", "the coefficient of the viscous force on the bob")
            }
            Self::Alpha => ("alpha", "damping", "", "the Coulomb friction"),
            Self::Torque => ("torque", "damping", "N m", "the torque of the Coulomb friction"),
            Self::Beta => ("beta", "excitation", "", "the excitation by the pivot"),
            Self::FrequencyRatio => {
                ("frequency_ratio", "excitation", "", "Omega/omega of the excitation")
            }
            Self::Mass => ("mass", "design", "kg", "the mass of the pendulum"),
            Self::Radius => ("radius", "design", "m", "the radius of its sphere"),
            Self::Length => ("length", "design", "m", "the length of the pendulum"),
            Self::Modulus => ("modulus", "design", "Pa", "the elastic modulus of the barrier"),
            Self::Gravity => ("gravity", "design", "m/s^2", "the acceleration of gravity"),
        }
    }

    /// `zeta`
    pub const fn name(self) -> &'static str {
        self.row().0
    }

    /// The group of the parameter, `damping`: the section of a problem file.
    pub const fn group(self) -> &'static str {
        self.row().1
    }

    /// Its SI unit, or rad and rad*omega; empty if it is dimensionless.
    pub const fn unit(self) -> &'static str {
        self.row().2
    }

    /// The meaning of the parameter in words: `the viscous damping ratio`.
    pub const fn meaning(self) -> &'static str {
        self.row().3
    }
}

/// Group and name, as in a problem file: `[damping] zeta`.
impl fmt::Display for Parameter {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "[{}] {}", self.group(), self.name())
    }
}

/// The error of a name that is not a parameter.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "there is no parameter `{name}` to sweep: choose one of {}",
    Parameter::ALL.map(Parameter::name).join(", ")
)]
pub struct UnknownParameter {
    /// The name that was given.
    pub name: String,
    /// The most similar known name.
    pub nearest: Option<&'static str>,
}

impl UnknownParameter {
    /// Advice on the name to write instead; `None` if no similar one is known.
    pub fn help(&self) -> Option<String> {
        self.nearest.map(|name| format!("did you mean `{name}`?"))
    }
}

impl FromStr for Parameter {
    type Err = UnknownParameter;

    /// Parses the name alone: `zeta`.
    fn from_str(name: &str) -> Result<Self, UnknownParameter> {
        let known = Self::ALL.into_iter().find(|parameter| parameter.name() == name);
        known.ok_or_else(|| UnknownParameter {
            name: name.to_owned(),
            nearest: nearest(name, Self::ALL.map(Self::name)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_read_back() {
        for parameter in Parameter::ALL {
            assert_eq!(parameter.name().parse(), Ok(parameter));
        }
        let error = "zetta".parse::<Parameter>().unwrap_err();
        assert_eq!(error.help().as_deref(), Some("did you mean `zeta`?"));
        assert_eq!(Parameter::FrequencyRatio.to_string(), "[excitation] frequency_ratio");
    }
}
