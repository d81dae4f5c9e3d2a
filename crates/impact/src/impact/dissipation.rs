//! The damping of a pendulum and of its contact: each damping in every form in which it may be
//! given, and the form that is held fixed.
//!
//! In: a number in one form, and the pendulum in SI units. Out: the number of equation (7), and
//! from it every other form. With d = L (x - x_c) the depth in m, v the dimensionless speed at a
//! touch, omega^2 = g/L:
//!
//! ```text
//! contact   F = (k + c d') d^(3/2)            c = mu m sqrt(g)/L^2, N s/m^(5/2)       the same mu whatever gamma
//!           F = k (1 + lambda d') d^(3/2)     lambda = (mu/gamma)/sqrt(g L), s/m     the same mu/gamma whatever gamma
//!           G(-e z) = G(z), z = (mu/gamma) v, G(z) = z - ln(1 + z)                   the restitution e at the speed v
//! viscous   a force c_v times the velocity L x' of the bob, in m/s, against it:  c_v = 2 zeta m omega, N s/m
//! friction  a constant torque against the motion:  alpha = torque/(m g L)
//! ```
//!
//! (K. H. Hunt and F. R. E. Crossley, *J. Appl. Mech.* 42 (1975) 440 for the contact.) alpha is the
//! dimensionless coefficient of friction. A bearing of radius r with a coefficient f of its own has
//! the torque f m g r, alpha = f r/L, if the weight alone loads it; a swing loads it with m g (cos
//! x + x'^2) and more, so that f is not an input.

use super::contact::hunt_crossley::{damping_for, restitution};
use super::model::ModelError;
use super::parameter::Parameter;
use super::units::Units;
use crate::decimal::decimal;

/// The damping of the contact, in the form in which it is given and held fixed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ContactDamping {
    /// mu of equation (7), dimensionless.
    Mu(f64),
    /// mu/gamma, dimensionless: lambda in units of equation (7).
    MuOverGamma(f64),
    /// lambda of Hunt and Crossley, s/m: a property of the material.
    Lambda(f64),
    /// The coefficient of restitution, above 0 and at most 1, at a stated speed.
    Restitution(f64),
    /// c of F = (k + c d') d^(3/2), N s/m^(5/2).
    Coefficient(f64),
}

/// The unit in which the speed of a restitution is stated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SpeedUnit {
    /// L omega = sqrt(g L), the unit of equation (7): the speed is an angular velocity in rad times
    /// omega.
    #[default]
    RadOmega,
    /// m/s, that of the bob.
    MetresPerSecond,
}

impl SpeedUnit {
    /// `rad*omega` or `m/s`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::RadOmega => "rad*omega",
            Self::MetresPerSecond => "m/s",
        }
    }

    /// A speed in this unit, of a pendulum of this length in m under this gravity in m/s^2, in
    /// units of L omega.
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::SpeedUnit;
    ///
    /// assert_eq!(SpeedUnit::MetresPerSecond.dimensionless(3.0, 0.25, 9.0), 2.0); // sqrt(g L) = 1.5 m/s
    /// assert_eq!(SpeedUnit::RadOmega.dimensionless(3.0, 0.25, 9.0), 3.0);
    /// ```
    pub fn dimensionless(self, speed: f64, length: f64, gravity: f64) -> f64 {
        match self {
            Self::RadOmega => speed,
            Self::MetresPerSecond => speed / (gravity * length).sqrt(),
        }
    }
}

/// The scales of a damping of the contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactScales {
    /// The stiffness gamma of equation (7), positive.
    pub gamma: f64,
    /// Mass of the pendulum, kg.
    pub mass: f64,
    /// Length of the pendulum, m.
    pub length: f64,
    /// Acceleration of gravity, m/s^2.
    pub gravity: f64,
    /// The speed at which a restitution is stated, in units of L omega; `None` if none is known.
    pub speed: Option<f64>,
}

impl ContactDamping {
    /// The forms, by the parameters that give them.
    pub const FORMS: [Parameter; 5] = [
        Parameter::Mu,
        Parameter::MuOverGamma,
        Parameter::Lambda,
        Parameter::Restitution,
        Parameter::ContactDamping,
    ];

    /// A value in this form; `None` for a parameter that is not a damping of the contact.
    pub fn given(form: Parameter, value: f64) -> Option<Self> {
        match form {
            Parameter::Mu => Some(Self::Mu(value)),
            Parameter::MuOverGamma => Some(Self::MuOverGamma(value)),
            Parameter::Lambda => Some(Self::Lambda(value)),
            Parameter::Restitution => Some(Self::Restitution(value)),
            Parameter::ContactDamping => Some(Self::Coefficient(value)),
            _ => None,
        }
    }

    /// The parameter of this form.
    pub fn form(self) -> Parameter {
        match self {
            Self::Mu(_) => Parameter::Mu,
            Self::MuOverGamma(_) => Parameter::MuOverGamma,
            Self::Lambda(_) => Parameter::Lambda,
            Self::Restitution(_) => Parameter::Restitution,
            Self::Coefficient(_) => Parameter::ContactDamping,
        }
    }

    /// The number given.
    pub fn value(self) -> f64 {
        match self {
            Self::Mu(value)
            | Self::MuOverGamma(value)
            | Self::Lambda(value)
            | Self::Restitution(value)
            | Self::Coefficient(value) => value,
        }
    }

    /// mu of equation (7).
    ///
    /// # Errors
    /// [`ModelError`]: a damping that is negative or too large; a restitution out of range, or
    /// without a speed.
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::{ContactDamping, ContactScales};
    ///
    /// let scales = ContactScales { gamma: 1e6, mass: 0.02, length: 0.25, gravity: 9.0, speed: Some(1.25) };
    /// assert!((ContactDamping::Lambda(0.1).mu(&scales)? / 1.5e5 - 1.0).abs() < 1e-15); // sqrt(g L) = 1.5 m/s
    /// let ContactDamping::Restitution(e) = ContactDamping::Mu(1.5e5).in_form(ContactDamping::Restitution(0.0), &scales)?
    /// else { unreachable!() };
    /// assert!((ContactDamping::Restitution(e).mu(&scales)? / 1.5e5 - 1.0).abs() < 1e-13);
    /// # Ok::<(), lindstedt::impact::ModelError>(())
    /// ```
    pub fn mu(self, scales: &ContactScales) -> Result<f64, ModelError> {
        let (key, value) = (self.form(), self.value());
        if let Self::Mu(mu) = self {
            // The range of mu is checked by the equation.
            return Ok(mu);
        }
        if let Self::Restitution(e) = self {
            if !(e > 0.0 && e <= 1.0) {
                return Err(ModelError::Restitution(e));
            }
        } else if value.is_nan() || value < 0.0 {
            return Err(ModelError::NegativeDamping { key, value });
        }
        let &ContactScales { gamma, mass, length, gravity, .. } = scales;
        let mu = match self {
            Self::Mu(mu) => mu,
            Self::MuOverGamma(ratio) => gamma * ratio,
            Self::Lambda(lambda) => gamma * lambda * (gravity * length).sqrt(),
            Self::Restitution(e) => {
                let product = damping_for(e).map_err(|_| ModelError::Restitution(e))?;
                gamma * (product / scales.stated_speed()?)
            }
            Self::Coefficient(coefficient) => {
                coefficient * length * length / (mass * gravity.sqrt())
            }
        };
        match (mu.is_finite(), self) {
            (true, _) => Ok(mu),
            (false, Self::Lambda(lambda)) => Err(ModelError::Lambda(lambda)),
            (false, _) => Err(ModelError::InfiniteDamping { key, value }),
        }
    }

    /// Converts the damping to the form of `other`, whose value is not used.
    ///
    /// # Errors
    /// As [`ContactDamping::mu`].
    pub fn in_form(self, other: Self, scales: &ContactScales) -> Result<Self, ModelError> {
        let mu = self.mu(scales)?;
        let &ContactScales { gamma, mass, length, gravity, .. } = scales;
        let ratio = mu / gamma;
        Ok(match other {
            Self::Mu(_) => Self::Mu(mu),
            Self::MuOverGamma(_) => Self::MuOverGamma(ratio),
            Self::Lambda(_) => Self::Lambda(ratio / (gravity * length).sqrt()),
            Self::Restitution(_) => {
                let (key, value) = (Parameter::Mu, mu);
                let product = ratio * scales.stated_speed()?;
                Self::Restitution(
                    restitution(product).map_err(|_| ModelError::NegativeDamping { key, value })?,
                )
            }
            Self::Coefficient(_) => {
                Self::Coefficient(mu * mass * gravity.sqrt() / (length * length))
            }
        })
    }
}

impl ContactScales {
    fn stated_speed(&self) -> Result<f64, ModelError> {
        match self.speed {
            None => Err(ModelError::NoSpeed),
            Some(speed) if speed > 0.0 && speed.is_finite() => Ok(speed),
            Some(speed) => Err(ModelError::ContactSpeed(speed)),
        }
    }
}

/// The damping ratio zeta = c/(2 m omega) of a force c times the velocity of the bob, c in N s/m.
pub fn viscous_ratio(coefficient: f64, units: &Units) -> f64 {
    0.5 * coefficient * units.time() / units.mass
}

/// The coefficient c = 2 zeta m omega of a force against the velocity of the bob, N s/m, that has
/// this damping ratio.
pub fn viscous_coefficient(zeta: f64, units: &Units) -> f64 {
    2.0 * zeta * units.mass / units.time()
}

/// alpha = torque/(m g L), the torque in N m.
pub fn friction_of_torque(torque: f64, units: &Units) -> f64 {
    torque / units.energy()
}

/// The torque alpha m g L of dry friction, N m.
pub fn torque_of_friction(alpha: f64, units: &Units) -> f64 {
    alpha * units.energy()
}

/// The dampings of one motion in every form.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Dissipation {
    /// The damping of the contact as it is given.
    pub contact: ContactDamping,
    /// mu of equation (7).
    pub mu: f64,
    /// mu/gamma.
    pub mu_over_gamma: f64,
    /// lambda, s/m, where units are known.
    pub lambda: Option<f64>,
    /// c of F = (k + c d') d^(3/2), N s/m^(5/2), where units are known.
    pub coefficient: Option<f64>,
    /// The speed at which a given restitution is stated, in units of L omega.
    pub at_speed: Option<f64>,
    /// The speed in m/s, if the file states it so.
    pub at_speed_si: Option<f64>,
    /// The speed of the first touch without damping, in units of L omega; `None` if no barrier is
    /// reached.
    pub touch_speed: Option<f64>,
    /// The restitution at that speed.
    pub restitution: Option<f64>,
    /// `zeta` or `viscous`, as it is given.
    pub viscous_form: Parameter,
    /// zeta of equation (7).
    pub zeta: f64,
    /// The coefficient of the viscous force on the bob, N s/m, where units are known.
    pub viscous: Option<f64>,
    /// `alpha` or `torque`, as it is given.
    pub friction_form: Parameter,
    /// alpha of equation (7).
    pub alpha: f64,
    /// The torque of dry friction, N m, where units are known.
    pub torque: Option<f64>,
}

impl Dissipation {
    /// These dampings with another speed of the first touch without damping.
    #[must_use]
    pub(super) fn touched_at(self, speed: Option<f64>) -> Self {
        Self {
            touch_speed: speed,
            restitution: speed.and_then(|speed| restitution(self.mu_over_gamma * speed).ok()),
            ..self
        }
    }

    /// The speed at which a given restitution is stated, with its unit: `1 m/s, 1.22347 rad*omega`
    /// where that is how it is stated.
    pub fn at_speed_in_words(&self) -> Option<String> {
        let own = format!("{} {}", decimal(self.at_speed?), SpeedUnit::RadOmega.name());
        Some(match self.at_speed_si {
            Some(speed) => {
                format!("{} {}, {own}", decimal(speed), SpeedUnit::MetresPerSecond.name())
            }
            None => own,
        })
    }

    /// The quantities that are held fixed, one for each damping that acts: `mu`, `zeta`.
    pub fn held_fixed(&self) -> Vec<&'static str> {
        [
            (self.mu != 0.0, self.contact.form()),
            (self.zeta != 0.0, self.viscous_form),
            (self.alpha != 0.0, self.friction_form),
        ]
        .into_iter()
        .filter_map(|(there, form)| there.then_some(form.name()))
        .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn units(mass: f64, length: f64, gravity: f64) -> Units {
        Units {
            mass,
            length,
            gravity,
            radius: None,
            modulus: None,
            sphere_yield: None,
            barrier_yield: None,
        }
    }

    fn decades(from: f64, to: f64) -> impl Strategy<Value = f64> {
        (from..to).prop_map(|power| 10.0_f64.powf(power))
    }

    proptest! {
        #[test]
        fn every_form_leads_to_every_other_and_back(
            gamma in decades(0.0, 12.0), mass in decades(-4.0, 3.0), length in decades(-3.0, 2.0),
            gravity in decades(-1.0, 2.0), speed in decades(-3.0, 1.0), product in decades(-3.0, 1.0)
        ) {
            let scales = ContactScales { gamma, mass, length, gravity, speed: Some(speed) };
            let mu = gamma * product / speed;
            for form in ContactDamping::FORMS {
                let form = ContactDamping::given(form, 0.0).expect("a form");
                let there = ContactDamping::Mu(mu).in_form(form, &scales).expect("a damping");
                let back = there.mu(&scales).expect("a damping");
                // A restitution near one or zero has lost digits of the damping.
                let lost = 1e-15 / product.min(1.0) + 1e-16 * product.powi(4).exp().min(1e4);
                let allowed = if matches!(form, ContactDamping::Restitution(_)) { 1e-13 + 10.0 * lost } else { 1e-14 };
                prop_assert!((back / mu - 1.0).abs() < allowed, "{there:?}: {back} and {mu}");
            }
            let units = units(mass, length, gravity);
            prop_assert!((viscous_ratio(viscous_coefficient(product, &units), &units) / product - 1.0).abs() < 1e-14);
            prop_assert!((friction_of_torque(torque_of_friction(product, &units), &units) / product - 1.0).abs() < 1e-14);
        }
    }

    /// Forces and torques in SI units, over m g L, against the terms of equation (7).
    #[test]
    fn the_numbers_of_equation_7_are_forces_over_the_weight() {
        let units = units(0.02, 0.25, 9.81);
        let gamma = 1e6;
        let scales = ContactScales { gamma, mass: 0.02, length: 0.25, gravity: 9.81, speed: None };
        let (depth, rate) = (2e-3_f64, 0.7_f64); // rad, rad times omega
        let (metres, speed) = (0.25 * depth, 0.25 * rate / units.time());
        let k = units.contact_stiffness(gamma);
        for damping in [
            ContactDamping::Lambda(0.12),
            ContactDamping::Coefficient(30.0),
            ContactDamping::MuOverGamma(0.1),
        ] {
            let mu = damping.mu(&scales).expect("a damping");
            let in_si = match damping {
                ContactDamping::Lambda(lambda) => k * (1.0 + lambda * speed) * metres.powf(1.5),
                ContactDamping::Coefficient(c) => (k + c * speed) * metres.powf(1.5),
                _ => k * (1.0 + 0.1 * rate) * metres.powf(1.5),
            };
            let expected = (gamma + mu * rate) * depth.powf(1.5) * units.force();
            assert!((in_si / expected - 1.0).abs() < 1e-13, "{damping:?}");
        }
        // m L^2 x'' = -c (L x') L, with the time in s.
        let torque = 0.3 * speed * 0.25;
        assert!(
            (2.0 * viscous_ratio(0.3, &units) * rate * units.energy() / torque - 1.0).abs() < 1e-13
        );
    }

    #[test]
    fn what_is_no_damping_is_refused_by_name() {
        let scales =
            ContactScales { gamma: 1e6, mass: 0.02, length: 0.25, gravity: 9.81, speed: None };
        for (damping, words) in [
            (ContactDamping::Lambda(-1.0), "[contact] lambda must"),
            (ContactDamping::Coefficient(f64::NAN), "[contact] damping must"),
            (ContactDamping::Restitution(0.0), "above 0"),
            (ContactDamping::Restitution(0.5), "at_speed"),
            (ContactDamping::MuOverGamma(1e305), "no finite"),
        ] {
            let error = damping.mu(&scales).expect_err("no damping").to_string();
            assert!(error.contains(words), "{error}");
        }
        let still = ContactScales { speed: Some(0.0), ..scales };
        assert_eq!(ContactDamping::Restitution(0.5).mu(&still), Err(ModelError::ContactSpeed(0.0)));
    }
}
