//! The numbers that a sweep of a main mass may vary: its own, and those of the pendulum that it
//! carries.
//!
//! In: the name of a key, `frequency`, `gamma`; with its section, `primary.mass`, `design.mass`,
//! where two sections have a key of that name. Out: a [`PrimaryParameter`].

use std::str::FromStr;

use super::PrimaryError;
use crate::impact::Parameter;
use crate::spelling::nearest;

/// A number that a sweep of a main mass may vary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PrimaryParameter {
    /// M, without the pendulum.
    Mass,
    /// R = M/m, beside the mass m of the pendulum.
    MassRatio,
    /// The stiffness of its spring.
    Stiffness,
    /// The coefficient of its dashpot.
    Damping,
    /// Its displacement at the start.
    Displacement,
    /// Its speed at the start.
    Speed,
    /// The amplitude of the force on it.
    Force,
    /// The angular frequency of that force.
    Frequency,
    /// A number of the pendulum or its barriers.
    Pendulum(Parameter),
}

impl PrimaryParameter {
    /// The numbers of the main mass alone.
    const OWN: [Self; 8] = [
        Self::Mass,
        Self::MassRatio,
        Self::Stiffness,
        Self::Damping,
        Self::Displacement,
        Self::Speed,
        Self::Force,
        Self::Frequency,
    ];

    /// Every parameter, those of the main mass first. The pivot moves with the main mass, so the
    /// parameters of its excitation are not among them.
    pub fn all() -> impl Iterator<Item = Self> {
        let excited = [Parameter::Beta, Parameter::FrequencyRatio];
        let carried = Parameter::ALL.into_iter().filter(move |own| !excited.contains(own));
        Self::OWN.into_iter().chain(carried.map(Self::Pendulum))
    }

    /// The section of a problem file and the key in it: `primary`, `mass`.
    const fn key(self) -> (&'static str, &'static str) {
        match self {
            Self::Mass => ("primary", "mass"),
            Self::MassRatio => ("primary", "mass_ratio"),
            Self::Stiffness => ("primary", "stiffness"),
            Self::Damping => ("primary", "damping"),
            Self::Displacement => ("primary", "displacement"),
            Self::Speed => ("primary", "speed"),
            Self::Force => ("primary", "force"),
            Self::Frequency => ("primary", "frequency"),
            Self::Pendulum(parameter) => (parameter.group(), parameter.name()),
        }
    }

    /// Its name in a sweep: the key, with its section where another section has a key of that name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Mass => "primary.mass",
            Self::Damping => "primary.damping",
            Self::Speed => "primary.speed",
            Self::Pendulum(Parameter::Mass) => "design.mass",
            Self::Pendulum(Parameter::ContactDamping) => "contact.damping",
            Self::Pendulum(Parameter::Speed) => "pendulum.speed",
            _ => self.key().1,
        }
    }

    /// Its SI unit, or rad and rad*omega; empty if it is dimensionless.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Mass => "kg",
            Self::MassRatio => "",
            Self::Stiffness => "N/m",
            Self::Damping => "N s/m",
            Self::Displacement => "m",
            Self::Speed => "m/s",
            Self::Force => "N",
            Self::Frequency => "rad/s",
            Self::Pendulum(parameter) => parameter.unit(),
        }
    }

    /// Its meaning in words.
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::Mass => "the main mass without the pendulum",
            Self::MassRatio => "the main mass over the mass of the pendulum, M/m",
            Self::Stiffness => "the stiffness of the spring of the main mass",
            Self::Damping => "the coefficient of the dashpot of the main mass",
            Self::Displacement => "the displacement of the main mass at the start",
            Self::Speed => "the speed of the main mass at the start",
            Self::Force => "the amplitude of the force on the main mass",
            Self::Frequency => "the angular frequency of the force on the main mass",
            Self::Pendulum(parameter) => parameter.meaning(),
        }
    }
}

impl FromStr for PrimaryParameter {
    type Err = PrimaryError;

    fn from_str(name: &str) -> Result<Self, PrimaryError> {
        let is_meant = |parameter: &Self| {
            let (section, key) = parameter.key();
            name == key || name.strip_suffix(key).is_some_and(|rest| rest == format!("{section}."))
        };
        let meant: Vec<Self> = Self::all().filter(is_meant).collect();
        match meant[..] {
            [parameter] => Ok(parameter),
            [] => Err(PrimaryError::UnknownName {
                name: name.to_owned(),
                nearest: nearest(name, Self::all().map(Self::name)),
            }),
            _ => Err(PrimaryError::AmbiguousName {
                name: name.to_owned(),
                names: meant.into_iter().map(Self::name).collect(),
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_reads_back_and_is_one() {
        for parameter in PrimaryParameter::all() {
            assert_eq!(parameter.name().parse(), Ok(parameter));
            let (section, key) = parameter.key();
            assert_eq!(format!("{section}.{key}").parse(), Ok(parameter));
        }
        let ambiguous = "mass".parse::<PrimaryParameter>().unwrap_err().to_string();
        assert!(ambiguous.contains("primary.mass or design.mass"), "{ambiguous}");
        let unknown = "frequncy".parse::<PrimaryParameter>().unwrap_err();
        assert_eq!(unknown.help().as_deref(), Some("did you mean `frequency`?"));
        assert!(unknown.to_string().contains("mass_ratio, stiffness"), "{unknown}");
    }
}
