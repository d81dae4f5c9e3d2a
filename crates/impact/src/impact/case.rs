//! One case of a study: a pendulum and its barrier as an engineer states them, by dimensions and
//! materials or by the numbers of equation (7).
//!
//! In: a [`Case`], any of whose numbers a [`Parameter`] reads or writes. Out: the [`Model`] and the
//! [`Start`] that follow:
//!
//! ```text
//! gamma = (4/3) E sqrt(R) L^(3/2) / (m g)      where it is not given        equation (8), l = L
//! mu    = gamma lambda sqrt(g L)               where lambda is given; other forms of it, and of zeta and alpha: `dissipation`
//! x(0)  = -A, x'(0) = 0                        where no other start is given; x(0) = A towards a barrier on the left
//! ```

use std::f64::consts::PI;

use super::dissipation::{
    ContactDamping, ContactScales, Dissipation, SpeedUnit, friction_of_torque, torque_of_friction,
    viscous_coefficient, viscous_ratio,
};
use super::hertz::{NotPositive, StiffnessDesign};
use super::model::{DEFAULT_AMPLITUDE, DEFAULT_BARRIER, Friction, Model, ModelError, Side, Start};
use super::parameter::Parameter;
use super::units::Units;

/// A pendulum, its barrier, and what damps and drives it; the default has no losses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Case {
    /// A, rad, positive: released from rest at x = -A, or at x = A towards a barrier on the left.
    pub amplitude: f64,
    /// The side of the barrier towards which the pendulum is released; the release is on the other
    /// side.
    pub side: Side,
    /// x(0), rad, if it is not that of the release; `None` otherwise.
    pub start: Option<f64>,
    /// x'(0), rad times omega.
    pub speed: f64,
    /// Position of the left barrier, rad.
    pub left: Option<f64>,
    /// Position of the right barrier x_c, rad.
    pub right: Option<f64>,
    /// Dimensionless stiffness gamma of the contact, positive, or 0 for no barrier; `None` if it is
    /// that of the design.
    pub gamma: Option<f64>,
    /// Damping of the contact.
    pub contact_damping: ContactDamping,
    /// The speed, in `speed_unit`, at which a restitution is stated; if `None`, that of the first
    /// touch without damping.
    pub at_speed: Option<f64>,
    /// The unit of that speed.
    pub speed_unit: SpeedUnit,
    /// Viscous damping ratio zeta, dimensionless, not negative.
    pub zeta: f64,
    /// The coefficient of the viscous force on the bob, N s/m, in place of zeta if given.
    pub viscous: Option<f64>,
    /// Coulomb friction alpha, dimensionless, not negative.
    pub alpha: f64,
    /// The torque of the friction, N m, in place of alpha if given.
    pub torque: Option<f64>,
    /// The law of that friction.
    pub friction: Friction,
    /// Excitation beta = (A_e/L)(Omega/omega)^2 of a moving pivot, dimensionless.
    pub beta: f64,
    /// Omega/omega, dimensionless, not negative.
    pub frequency_ratio: f64,
    /// Mass, radius, length, modulus, gravity, in SI units.
    pub design: StiffnessDesign,
}

impl Default for Case {
    fn default() -> Self {
        Self {
            amplitude: DEFAULT_AMPLITUDE,
            side: Side::Right,
            start: None,
            speed: 0.0,
            left: None,
            right: Some(DEFAULT_BARRIER),
            gamma: None,
            contact_damping: ContactDamping::Mu(0.0),
            at_speed: None,
            speed_unit: SpeedUnit::default(),
            zeta: 0.0,
            viscous: None,
            alpha: 0.0,
            torque: None,
            friction: Friction::default(),
            beta: 0.0,
            frequency_ratio: 0.0,
            design: StiffnessDesign::default(),
        }
    }
}

impl Case {
    /// The value of a parameter; `None` if it follows from others: gamma from the design, the start
    /// from the amplitude.
    pub fn get(&self, parameter: Parameter) -> Option<f64> {
        match parameter {
            Parameter::Amplitude => Some(self.amplitude),
            Parameter::Start => self.start,
            Parameter::Speed => Some(self.speed),
            Parameter::Barrier => match self.side {
                Side::Left => self.left,
                Side::Right => self.right,
            },
            Parameter::Gamma => self.gamma,
            Parameter::Mu
            | Parameter::MuOverGamma
            | Parameter::Lambda
            | Parameter::Restitution
            | Parameter::ContactDamping => {
                let damping = self.contact_damping;
                (damping.form() == parameter).then_some(damping.value())
            }
            Parameter::AtSpeed => self.at_speed,
            Parameter::Zeta => self.viscous.is_none().then_some(self.zeta),
            Parameter::Viscous => self.viscous,
            Parameter::Alpha => self.torque.is_none().then_some(self.alpha),
            Parameter::Torque => self.torque,
            Parameter::Beta => Some(self.beta),
            Parameter::FrequencyRatio => Some(self.frequency_ratio),
            Parameter::Mass => Some(self.design.mass),
            Parameter::Radius => Some(self.design.radius),
            Parameter::Length => Some(self.design.length),
            Parameter::Modulus => Some(self.design.modulus),
            Parameter::Gravity => Some(self.design.gravity),
        }
    }

    /// Sets a parameter without a check; [`Case::motion`] checks the values.
    pub fn set(&mut self, parameter: Parameter, value: f64) {
        match parameter {
            Parameter::Amplitude => self.amplitude = value,
            Parameter::Start => self.start = Some(value),
            Parameter::Speed => self.speed = value,
            Parameter::Barrier => match self.side {
                Side::Left => self.left = Some(value),
                Side::Right => self.right = Some(value),
            },
            Parameter::Gamma => self.gamma = Some(value),
            Parameter::Mu => self.contact_damping = ContactDamping::Mu(value),
            Parameter::MuOverGamma => self.contact_damping = ContactDamping::MuOverGamma(value),
            Parameter::Lambda => self.contact_damping = ContactDamping::Lambda(value),
            Parameter::Restitution => self.contact_damping = ContactDamping::Restitution(value),
            Parameter::ContactDamping => self.contact_damping = ContactDamping::Coefficient(value),
            Parameter::AtSpeed => self.at_speed = Some(value),
            Parameter::Zeta => (self.zeta, self.viscous) = (value, None),
            Parameter::Viscous => self.viscous = Some(value),
            Parameter::Alpha => (self.alpha, self.torque) = (value, None),
            Parameter::Torque => self.torque = Some(value),
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
    /// [`ModelError`] names the parameter that is not admissible.
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::{Case, Integrator, Parameter, Settings, simulate};
    ///
    /// let mut case = Case { zeta: 0.02, ..Case::default() };
    /// case.set(Parameter::Modulus, 2e6); // rubber
    /// let (model, start) = case.motion()?;
    /// let motion = simulate(&model, start, Integrator::Taylor, &Settings::default())?;
    /// assert!(motion.impacts[0].penetration > 0.01); // rad
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn motion(&self) -> Result<(Model, Start), ModelError> {
        let x = match self.start {
            Some(start) => start,
            None if self.amplitude > 0.0 && self.amplitude.is_finite() => {
                -self.side.sign() * self.amplitude
            }
            None => return Err(ModelError::Amplitude(self.amplitude)),
        };
        let start = Start { x, velocity: self.speed };
        let gamma = self.stiffness()?;
        let mu = self.contact_damping.mu(&self.scales(gamma, start))?;
        if gamma == 0.0 && mu > 0.0 {
            return Err(ModelError::NothingToDamp(mu));
        }
        let barrier = |place: Option<f64>| place.filter(|_| gamma != 0.0);
        let units = self.si();
        let in_si =
            |key, value: Option<f64>, number: f64, convert: fn(f64, &Units) -> f64| match value {
                None => Ok(number),
                Some(value) if value.is_nan() || value < 0.0 => {
                    Err(ModelError::NegativeDamping { key, value })
                }
                Some(value) => match convert(value, &units) {
                    number if number.is_finite() => Ok(number),
                    _ => Err(ModelError::InfiniteDamping { key, value }),
                },
            };
        let zeta = in_si(Parameter::Viscous, self.viscous, self.zeta, viscous_ratio)?;
        let alpha = in_si(Parameter::Torque, self.torque, self.alpha, friction_of_torque)?;
        if self.beta != 0.0 && self.frequency_ratio == 0.0 {
            return Err(ModelError::NoFrequency(self.beta));
        }
        let model = Model {
            zeta,
            alpha,
            friction: self.friction,
            beta: self.beta,
            frequency_ratio: self.frequency_ratio,
            gamma,
            mu,
            left: barrier(self.left),
            right: barrier(self.right),
        };
        let released = |error| match error {
            ModelError::LostDigits { parameter: Parameter::Start, .. } if self.start.is_none() => {
                ModelError::LostDigits { parameter: Parameter::Amplitude, value: self.amplitude }
            }
            error => error,
        };
        model.check(start).map_err(released)?;
        if self.start.is_none()
            && let Some((side, _)) = model.depth(start.x)
        {
            return Err(ModelError::Inside {
                side,
                barrier: model.barrier(side).unwrap_or_default(),
                start: start.x,
            });
        }
        Ok((model, start))
    }

    /// The design in SI units.
    fn si(&self) -> Units {
        Units {
            mass: self.design.mass,
            length: self.design.length,
            gravity: self.design.gravity,
            radius: None,
            modulus: None,
            sphere_yield: None,
            barrier_yield: None,
        }
    }

    /// The scales of its contact damping.
    fn scales(&self, gamma: f64, start: Start) -> ContactScales {
        ContactScales {
            gamma,
            mass: self.design.mass,
            length: self.design.length,
            gravity: self.design.gravity,
            speed: self.stated_speed().or_else(|| self.touch_speed(start)),
        }
    }

    /// The speed at which a restitution is stated, in units of L omega; `None` if none is stated.
    fn stated_speed(&self) -> Option<f64> {
        let StiffnessDesign { length, gravity, .. } = self.design;
        let speed = self.at_speed?;
        Some(self.speed_unit.dimensionless(speed, length, gravity))
    }

    /// The speed of the first touch from this start, by the energy of the swing: without damping
    /// and with the pivot at rest. `None` if no barrier is reached, or if the start is inside one.
    fn touch_speed(&self, start: Start) -> Option<f64> {
        let Start { x, velocity } = start;
        if self.left.is_some_and(|left| x < left) || self.right.is_some_and(|right| x > right) {
            return None;
        }
        // cos c - cos x = 2 sin((x - c)/2) sin((x + c)/2), which keeps its digits for small swings.
        let square = |barrier: f64| {
            let fallen = 2.0 * (0.5 * (x - barrier)).sin() * (0.5 * (x + barrier)).sin();
            velocity * velocity + 2.0 * fallen
        };
        // On the way to a barrier beyond the upright position the swing must get over it.
        let over_the_top = 0.5 * velocity * velocity > 1.0 + x.cos();
        let reached = |barrier: f64| barrier.abs() <= PI || over_the_top;
        let speed = |barrier: Option<f64>| {
            let barrier = barrier.filter(|barrier| reached(*barrier))?;
            Some(square(barrier).sqrt()).filter(|speed| *speed > 0.0)
        };
        let rises = if velocity == 0.0 { x.sin() < 0.0 } else { velocity > 0.0 };
        let (first, second) = if rises { (self.right, self.left) } else { (self.left, self.right) };
        // Over the top the motion never turns back.
        speed(first).or_else(|| speed(second).filter(|_| !over_the_top))
    }

    /// Every form of the dampings of this case; those in SI units are `None` without `units`.
    ///
    /// # Errors
    /// As [`Case::motion`].
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::{Case, ContactDamping};
    ///
    /// let case = Case { contact_damping: ContactDamping::MuOverGamma(0.1), zeta: 0.02, ..Case::default() };
    /// let forms = case.dissipation(None)?;
    /// assert!((forms.touch_speed.unwrap_or_default() - 1.324_802).abs() < 1e-6); // sqrt(2 (cos xc - cos A))
    /// assert!((forms.restitution.unwrap_or_default() - 0.918_794).abs() < 1e-6);
    /// assert_eq!(forms.held_fixed(), ["mu_over_gamma", "zeta"]);
    /// # Ok::<(), lindstedt::impact::ModelError>(())
    /// ```
    pub fn dissipation(&self, units: Option<&Units>) -> Result<Dissipation, ModelError> {
        let (model, start) = self.motion()?;
        let damping = self.contact_damping;
        let scales = self.scales(model.gamma, start);
        // With gamma = 0 there is no barrier to touch.
        let touch_speed = self.touch_speed(start).filter(|_| model.gamma != 0.0);
        let form = |of: ContactDamping, scales: &ContactScales| {
            Some(damping.in_form(of, scales).ok()?.value())
        };
        let at_touch = ContactScales { speed: touch_speed, ..scales };
        let of_touch =
            |mu| ContactDamping::Mu(mu).in_form(ContactDamping::Restitution(0.0), &at_touch);
        let either = |si: Option<f64>, own, number| if si.is_some() { own } else { number };
        Ok(Dissipation {
            contact: damping,
            mu: model.mu,
            mu_over_gamma: if model.mu == 0.0 { 0.0 } else { model.mu / model.gamma },
            lambda: match damping {
                ContactDamping::Lambda(lambda) => Some(lambda),
                _ => units.and_then(|_| form(ContactDamping::Lambda(0.0), &scales)),
            },
            coefficient: match damping {
                ContactDamping::Coefficient(coefficient) => Some(coefficient),
                _ => units.and_then(|_| form(ContactDamping::Coefficient(0.0), &scales)),
            },
            at_speed: match damping {
                ContactDamping::Restitution(_) => scales.speed,
                _ => None,
            },
            at_speed_si: match (damping, self.speed_unit) {
                (ContactDamping::Restitution(_), SpeedUnit::MetresPerSecond) => self.at_speed,
                _ => None,
            },
            touch_speed,
            restitution: of_touch(model.mu).ok().map(ContactDamping::value),
            viscous_form: either(self.viscous, Parameter::Viscous, Parameter::Zeta),
            zeta: model.zeta,
            viscous: self.viscous.or_else(|| Some(viscous_coefficient(model.zeta, units?))),
            friction_form: either(self.torque, Parameter::Torque, Parameter::Alpha),
            alpha: model.alpha,
            torque: self.torque.or_else(|| Some(torque_of_friction(model.alpha, units?))),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::impact::{Integrator, Settings, simulate};

    #[test]
    fn the_default_case_is_the_default_model() {
        let (model, start) = Case::default().motion().unwrap();
        assert!((model.gamma / Model::default().gamma - 1.0).abs() < 1e-15);
        assert_eq!(Model { gamma: 1.0, ..model }, Model { gamma: 1.0, ..Model::default() });
        assert_eq!(start, Start::default());
    }

    #[test]
    fn every_parameter_keeps_what_it_is_given_and_changes_the_motion() {
        let usual = Case {
            start: None,
            contact_damping: ContactDamping::Restitution(0.9),
            at_speed: Some(1.0),
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
    fn the_speed_of_the_first_touch_is_that_of_the_undamped_motion() {
        for (left, right, start, speed) in [
            (None, Some(0.323), None, 0.0),
            (None, Some(-0.5), None, 0.0),
            (Some(-1.4), None, Some(1.2), 1.0),
            (Some(-0.9), Some(0.4), Some(0.1), 1.2),
            (Some(-0.9), Some(0.4), Some(0.1), -1.2),
            (Some(-0.3), Some(2.0), Some(0.1), 1.0),
            (None, Some(3.5), Some(0.1), 2.5),
        ] {
            let case = Case { left, right, start, speed, ..Case::default() };
            let (model, start) = case.motion().unwrap();
            let motion =
                simulate(&model, start, Integrator::RungeKutta, &Settings::default()).unwrap();
            let found = case.dissipation(None).unwrap().touch_speed.unwrap();
            assert!((found / motion.impacts[0].speed_in - 1.0).abs() < 1e-8, "{case:?}: {found}");
        }
        let unreached = Case { right: Some(1.6), ..Case::default() };
        assert_eq!(unreached.dissipation(None).unwrap().touch_speed, None);
        let upright = Case { right: Some(3.5), ..Case::default() };
        assert_eq!(upright.dissipation(None).unwrap().touch_speed, None);
        let over_the_top =
            Case { left: Some(-1.4), right: None, start: Some(1.2), speed: 2.0, ..Case::default() };
        assert_eq!(over_the_top.dissipation(None).unwrap().touch_speed, None);
    }

    #[test]
    fn lambda_is_a_material_and_mu_follows_from_it() {
        let case = Case {
            gamma: Some(1e6),
            contact_damping: ContactDamping::Lambda(0.1),
            design: StiffnessDesign { length: 0.25, gravity: 9.0, ..StiffnessDesign::default() },
            ..Case::default()
        };
        assert!((case.motion().unwrap().0.mu / 1.5e5 - 1.0).abs() < 1e-15);
    }
}
