//! One case of a study: a pendulum and its barrier as an engineer states them, by dimensions and materials or by the numbers
//! of equation (7).
//!
//! In: a [`Case`], any of whose numbers a [`Parameter`] reads or writes. Out: the [`Model`] and the [`Start`] that follow:
//!
//! ```text
//! gamma = (4/3) E sqrt(R) L^(3/2) / (m g)      where it is not given        equation (8), l = L
//! mu    = gamma lambda sqrt(g L)               where lambda is given
//! x(0)  = -A, x'(0) = 0                        where no other start is given
//! ```

use thiserror::Error;

use super::hertz::{Design, NotPositive};
use super::model::{DEFAULT_AMPLITUDE, DEFAULT_BARRIER, Friction, Model, ModelError, Side, Start};
use super::parameter::Parameter;

/// What damps the contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ContactDamping {
    /// mu of equation (7), dimensionless.
    Mu(f64),
    /// lambda of Hunt and Crossley, s/m: a property of the material.
    Lambda(f64),
}

/// A pendulum, its barrier, and what damps and drives it; the default is the paper's, without losses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Case {
    /// A, rad, positive: released from rest at x = -A.
    pub amplitude: f64,
    /// x(0), rad, where it is not -A.
    pub start: Option<f64>,
    /// x'(0), rad times omega.
    pub speed: f64,
    /// Position of the left barrier, rad.
    pub left: Option<f64>,
    /// Position of the right barrier x_c, rad.
    pub right: Option<f64>,
    /// Dimensionless stiffness gamma of the contact, positive, where it is not that of the design.
    pub gamma: Option<f64>,
    /// Damping of the contact.
    pub contact_damping: ContactDamping,
    /// Viscous damping ratio zeta, dimensionless, not negative.
    pub zeta: f64,
    /// Coulomb friction alpha, dimensionless, not negative.
    pub alpha: f64,
    /// The law of that friction.
    pub friction: Friction,
    /// Excitation beta = (A_e/L)(Omega/omega)^2 of a moving pivot, dimensionless.
    pub beta: f64,
    /// Omega/omega, dimensionless, not negative.
    pub frequency_ratio: f64,
    /// Mass, radius, length, modulus, gravity, in SI units.
    pub design: Design,
}

impl Default for Case {
    fn default() -> Self {
        Self {
            amplitude: DEFAULT_AMPLITUDE,
            start: None,
            speed: 0.0,
            left: None,
            right: Some(DEFAULT_BARRIER),
            gamma: None,
            contact_damping: ContactDamping::Mu(0.0),
            zeta: 0.0,
            alpha: 0.0,
            friction: Friction::default(),
            beta: 0.0,
            frequency_ratio: 0.0,
            design: Design::default(),
        }
    }
}

/// Why a case makes no motion.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum CaseError {
    /// A release that is none.
    #[error("[pendulum] amplitude must be a positive number, not {0}; for another start give `start` and `speed`")]
    Amplitude(f64),
    /// A release behind a barrier, which is no release.
    #[error(
        "the motion starts at x = {start}, inside the {} barrier at {barrier}: move the barrier, or give `start` in \
         [pendulum]", .side.name()
    )]
    Inside {
        /// Which barrier.
        side: Side,
        /// Its position, rad.
        barrier: f64,
        /// The start, rad.
        start: f64,
    },
    /// A design that has no stiffness.
    #[error("[design]: {0}")]
    Design(#[from] NotPositive),
    /// A contact damping that makes no number.
    #[error("[contact] lambda = {0} makes no finite mu: it is in s/m, some hundredths for a hard material")]
    Lambda(f64),
    /// An excitation without a frequency.
    #[error("[excitation] beta = {0} needs a frequency_ratio above 0: a pivot that stands still excites nothing")]
    NoFrequency(f64),
    /// The equation or its start.
    #[error(transparent)]
    Model(#[from] ModelError),
}

impl Case {
    /// The value of a parameter; nothing where the case leaves it to others: gamma to the design, the start to the amplitude.
    pub fn get(&self, parameter: Parameter) -> Option<f64> {
        match parameter {
            Parameter::Amplitude => Some(self.amplitude),
            Parameter::Start => self.start,
            Parameter::Speed => Some(self.speed),
            Parameter::Barrier => self.right,
            Parameter::Gamma => self.gamma,
            Parameter::Mu => match self.contact_damping {
                ContactDamping::Mu(mu) => Some(mu),
                ContactDamping::Lambda(_) => None,
            },
            Parameter::Lambda => match self.contact_damping {
                ContactDamping::Lambda(lambda) => Some(lambda),
                ContactDamping::Mu(_) => None,
            },
            Parameter::Zeta => Some(self.zeta),
            Parameter::Alpha => Some(self.alpha),
            Parameter::Beta => Some(self.beta),
            Parameter::FrequencyRatio => Some(self.frequency_ratio),
            Parameter::Mass => Some(self.design.mass),
            Parameter::Radius => Some(self.design.radius),
            Parameter::Length => Some(self.design.length),
            Parameter::Modulus => Some(self.design.modulus),
            Parameter::Gravity => Some(self.design.gravity),
        }
    }

    /// Gives a parameter another value; whether it makes sense is seen by [`Case::motion`].
    pub fn set(&mut self, parameter: Parameter, value: f64) {
        match parameter {
            Parameter::Amplitude => self.amplitude = value,
            Parameter::Start => self.start = Some(value),
            Parameter::Speed => self.speed = value,
            Parameter::Barrier => self.right = Some(value),
            Parameter::Gamma => self.gamma = Some(value),
            Parameter::Mu => self.contact_damping = ContactDamping::Mu(value),
            Parameter::Lambda => self.contact_damping = ContactDamping::Lambda(value),
            Parameter::Zeta => self.zeta = value,
            Parameter::Alpha => self.alpha = value,
            Parameter::Beta => self.beta = value,
            Parameter::FrequencyRatio => self.frequency_ratio = value,
            Parameter::Mass => self.design.mass = value,
            Parameter::Radius => self.design.radius = value,
            Parameter::Length => self.design.length = value,
            Parameter::Modulus => self.design.modulus = value,
            Parameter::Gravity => self.design.gravity = value,
        }
    }

    /// The dimensionless stiffness gamma: the one given, or that of the design by equation (8).
    ///
    /// # Errors
    /// A design with a quantity that is not positive.
    pub fn stiffness(&self) -> Result<f64, NotPositive> {
        self.gamma.map_or_else(|| self.design.stiffness(), Ok)
    }

    /// The equation and its start.
    ///
    /// # Errors
    /// [`CaseError`] names the parameter that makes none.
    ///
    /// ```
    /// use lindstedt::impact::{Case, Integrator, Parameter, Settings, simulate};
    ///
    /// let mut case = Case { zeta: 0.02, ..Case::default() };
    /// case.set(Parameter::Modulus, 2e6); // rubber
    /// let (model, start) = case.motion()?;
    /// let motion = simulate(&model, start, Integrator::Taylor, &Settings::default())?;
    /// assert!(motion.impacts[0].penetration > 0.01); // rad
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn motion(&self) -> Result<(Model, Start), CaseError> {
        let x = match self.start {
            Some(start) => start,
            None if self.amplitude > 0.0 && self.amplitude.is_finite() => -self.amplitude,
            None => return Err(CaseError::Amplitude(self.amplitude)),
        };
        let start = Start {
            x,
            velocity: self.speed,
        };
        let gamma = self.stiffness()?;
        let mu = match self.contact_damping {
            ContactDamping::Mu(mu) => mu,
            ContactDamping::Lambda(lambda) => {
                let mu = gamma * lambda * (self.design.gravity * self.design.length).sqrt();
                if !mu.is_finite() {
                    return Err(CaseError::Lambda(lambda));
                }
                mu
            }
        };
        if self.beta != 0.0 && self.frequency_ratio == 0.0 {
            return Err(CaseError::NoFrequency(self.beta));
        }
        let model = Model {
            zeta: self.zeta,
            alpha: self.alpha,
            friction: self.friction,
            beta: self.beta,
            frequency_ratio: self.frequency_ratio,
            gamma,
            mu,
            left: self.left,
            right: self.right,
        };
        model.check(start)?;
        if self.start.is_none()
            && let Some((side, _)) = model.depth(start.x)
        {
            return Err(CaseError::Inside {
                side,
                barrier: model.barrier(side).unwrap_or_default(),
                start: start.x,
            });
        }
        Ok((model, start))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_case_is_the_default_model() {
        let (model, start) = Case::default().motion().unwrap();
        assert!((model.gamma / Model::default().gamma - 1.0).abs() < 1e-15);
        assert_eq!(
            Model { gamma: 1.0, ..model },
            Model {
                gamma: 1.0,
                ..Model::default()
            }
        );
        assert_eq!(start, Start::default());
    }

    #[test]
    fn every_parameter_keeps_what_it_is_given_and_changes_the_motion() {
        let usual = Case {
            start: None,
            contact_damping: ContactDamping::Lambda(0.1),
            beta: 0.1,
            frequency_ratio: 0.5,
            ..Case::default()
        };
        for parameter in Parameter::ALL {
            let mut case = usual;
            case.set(parameter, 0.25);
            assert_eq!(case.get(parameter), Some(0.25), "{parameter}");
            assert_ne!(case.motion().unwrap(), usual.motion().unwrap(), "{parameter}");
        }
    }

    #[test]
    fn lambda_is_a_material_and_mu_follows_from_it() {
        let case = Case {
            gamma: Some(1e6),
            contact_damping: ContactDamping::Lambda(0.1),
            design: Design {
                length: 0.25,
                gravity: 9.0,
                ..Design::default()
            },
            ..Case::default()
        };
        assert!((case.motion().unwrap().0.mu / 1.5e5 - 1.0).abs() < 1e-15);
    }
}
