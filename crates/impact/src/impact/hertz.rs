//! Hertz contact of a sphere and an elastic barrier.
//!
//! In: stiffness and depth, or stiffness and speed of touch. Out: force and stored energy; depth
//! and duration. The law is defined only here: the fitted line, the equation of motion, both
//! integrators and the energy balance use it. In the paper's dimensionless form, with d the depth,
//!
//! ```text
//! d'' = -gamma d^(3/2),  d(0) = 0, d'(0) = v                  energy stored: (2/5) gamma d^(5/2)
//! v^2/2 = (2/5) gamma d_max^(5/2)              d_max = (5 v^2 / (4 gamma))^(2/5)
//! T = 2 int_0^d_max dd / sqrt(v^2 - (4/5) gamma d^(5/2)) = (d_max / v) 2 int_0^1 dy / sqrt(1 - y^(5/2))
//! gamma = (4/3) E sqrt(R) l^(5/2) / (omega^2 m L^2)                                            equation (8)
//! ```
//!
//! (H. Hertz, *J. reine angew. Math.* 92 (1881) 156; W. Goldsmith, *Impact*, 1960, section 4.2.)
//! Gravity is left out during the contact: [`true_impact`](super::true_impact()) has it.
//!
//! In time the law is not analytic at the touch. With d = w^2 and dt = w ds it is a polynomial, and
//! touch and release are simple zeros of w, however slow the touch (the change of variable of
//! Levi-Civita and Sundman for collisions):
//!
//! ```text
//! dw/ds = v/2,   dt/ds = w,   dv/ds = -gamma w^4              the regularised equation, d' = v
//! ```
//!
//! The fast integrator follows that form, with the other forces added.

use thiserror::Error;

use crate::numeric::ode::quadrature::nodes_and_weights;

/// A quantity outside its domain.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("the {quantity} must be a positive number, not {value}")]
pub struct NotPositive {
    /// The name of the quantity.
    pub quantity: &'static str,
    /// The value given.
    pub value: f64,
}

/// The quantities from which equation (8) gives the dimensionless stiffness, with the lever arm l =
/// L and omega^2 = g/L.
///
/// The default is a light pendulum before a soft barrier, with standard gravity to two places.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StiffnessDesign {
    /// Mass of the pendulum, kg.
    pub mass: f64,
    /// Radius of the sphere, m.
    pub radius: f64,
    /// Length of the pendulum, m.
    pub length: f64,
    /// Elastic modulus of the barrier, Pa: the sphere counts as rigid.
    pub modulus: f64,
    /// Acceleration of gravity, m/s^2.
    pub gravity: f64,
}

/// The stiffness gamma of the default [`StiffnessDesign`], by equation (8): the default of every
/// impact and simulation.
pub const DEFAULT_STIFFNESS: f64 = 30_406_664.685_165_863;

impl Default for StiffnessDesign {
    fn default() -> Self {
        Self { mass: 0.0112, radius: 0.0096, length: 0.0681, modulus: 1.439e9, gravity: 9.81 }
    }
}

impl StiffnessDesign {
    /// The dimensionless stiffness gamma = (4/3) E sqrt(R) L^(3/2) / (m g), equation (8) with l = L
    /// and omega^2 = g/L.
    ///
    /// # Errors
    /// [`NotPositive`] names the first quantity that is not a positive number.
    pub fn stiffness(&self) -> Result<f64, NotPositive> {
        for (quantity, value) in [
            ("mass", self.mass),
            ("radius", self.radius),
            ("length", self.length),
            ("modulus", self.modulus),
            ("gravity", self.gravity),
        ] {
            positive(quantity, value)?;
        }
        let stiffness = 4.0 / 3.0 * self.modulus * self.radius.sqrt() * self.length.powf(1.5)
            / (self.mass * self.gravity);
        positive("stiffness gamma that follows from the design", stiffness)
    }
}

/// The force of a contact of this stiffness at this depth: stiffness depth^(3/2), and none out of
/// contact.
pub fn force(stiffness: f64, depth: f64) -> f64 {
    if depth <= 0.0 {
        return 0.0;
    }
    stiffness * depth * depth.sqrt()
}

/// The energy that a contact of this stiffness stores at this depth: (2/5) stiffness depth^(5/2),
/// and none out of contact.
pub fn stored_energy(stiffness: f64, depth: f64) -> f64 {
    if depth <= 0.0 {
        return 0.0;
    }
    0.4 * stiffness * depth * depth * depth.sqrt()
}

/// The elastic force per unit of gamma at this depth: depth^(3/2), and none out of contact.
pub fn elastic_force(depth: f64) -> f64 {
    force(1.0, depth)
}

/// The greatest depth d_max of a contact of this stiffness entered at this speed, from the energy.
///
/// # Errors
/// [`NotPositive`] for a stiffness or a speed that is not a positive number.
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::hertz::{penetration, stored_energy};
///
/// let deepest = penetration(1e6, 0.5)?; // rad
/// assert!((stored_energy(1e6, deepest) - 0.125).abs() < 1e-12); // v^2/2
/// # Ok::<(), lindstedt::impact::hertz::NotPositive>(())
/// ```
pub fn penetration(stiffness: f64, speed: f64) -> Result<f64, NotPositive> {
    let (stiffness, speed) =
        (positive("stiffness gamma", stiffness)?, positive("speed of contact", speed)?);
    Ok(greatest_depth(stiffness, speed))
}

/// The depth at which a contact stores the energy of this speed, for numbers known to be positive.
pub(super) fn greatest_depth(stiffness: f64, speed: f64) -> f64 {
    let square = 1.25 * speed * speed;
    let power = match square.is_normal() {
        true => square / stiffness,
        // The square of a tiny speed underflows, its part of the stiffness may not.
        false => 1.25 * speed / stiffness * speed,
    };
    power.powf(0.4)
}

/// The duration of a contact of this stiffness entered at this speed.
///
/// # Errors
/// As [`penetration`].
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::hertz::{duration, penetration};
///
/// assert!((penetration(1.25e6, 1.0)? - 1e-6_f64.powf(0.4)).abs() < 1e-12); // rad
/// assert!(duration(1.25e6, 1.0)? > 2.0 * penetration(1.25e6, 1.0)?); // in units of 1/omega
/// # Ok::<(), lindstedt::impact::hertz::NotPositive>(())
/// ```
pub fn duration(stiffness: f64, speed: f64) -> Result<f64, NotPositive> {
    Ok(duration_factor() * penetration(stiffness, speed)? / speed)
}

/// The number T v / d_max = 2 int_0^1 dy / sqrt(1 - y^(5/2)), the same for every Hertz contact.
///
/// With y = q^2 and q = 1 - w^2 the integrand is smooth: 8 int_0^1 q / sqrt(1 + q + q^2 + q^3 +
/// q^4) dw.
pub fn duration_factor() -> f64 {
    let integrand = |w: f64| {
        let q = 1.0 - w * w;
        8.0 * q / (1.0 + q * (1.0 + q * (1.0 + q * (1.0 + q)))).sqrt()
    };
    nodes_and_weights(0.0, 0.5)
        .chain(nodes_and_weights(0.5, 1.0))
        .map(|(w, weight)| weight * integrand(w))
        .sum()
}

pub(super) fn positive(quantity: &'static str, value: f64) -> Result<f64, NotPositive> {
    if value.is_finite() && value > 0.0 { Ok(value) } else { Err(NotPositive { quantity, value }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::ode::{Event, IntegrationOptions, State, integrate};

    #[test]
    fn the_duration_factor_is_a_ratio_of_gamma_functions() {
        use spec_math::cephes64::gamma;
        let exact = 0.8 * std::f64::consts::PI.sqrt() * gamma(0.4) / gamma(0.9);
        assert!(
            (duration_factor() / exact - 1.0).abs() < 1e-14,
            "{} against {exact}",
            duration_factor()
        );
    }

    #[test]
    fn depth_and_duration_agree_with_the_integrated_contact() {
        for (stiffness, speed) in [(1.0, 1.0), (1e6, 1.3), (3e7, 1e-3)] {
            let (depth, time) =
                (penetration(stiffness, speed).unwrap(), duration(stiffness, speed).unwrap());
            let options = IntegrationOptions {
                absolute_tolerance: 1e-12 * depth,
                ..IntegrationOptions::with_tolerance(1e-12)
            };
            let events = [Event::record(|_, _, v| v), Event::stop(|_, d, _| d).falling()];
            let start = State { t: 0.0, x: 0.0, v: speed };
            let path = integrate(
                |_, d, _| -stiffness * elastic_force(d),
                start,
                2.0 * time,
                &events,
                &options,
            )
            .unwrap();
            assert!(
                (path.occurrences()[0].state.x / depth - 1.0).abs() < 1e-10,
                "depth at gamma {stiffness}"
            );
            assert!((path.end().t / time - 1.0).abs() < 1e-9, "duration at gamma {stiffness}");
        }
    }

    #[test]
    fn the_default_stiffness_is_that_of_the_default_design() {
        let design = StiffnessDesign::default();
        assert!((design.stiffness().unwrap() / DEFAULT_STIFFNESS - 1.0).abs() < 1e-15);
        // The general equation (8), l and omega^2 written out.
        let omega_squared = design.gravity / design.length;
        let general = 4.0 * design.length.powf(2.5) * design.modulus * design.radius.sqrt()
            / (3.0 * omega_squared * design.mass * design.length.powi(2));
        assert!((design.stiffness().unwrap() / general - 1.0).abs() < 1e-14);
    }

    #[test]
    fn what_is_not_positive_is_named() {
        let refused =
            StiffnessDesign { radius: 0.0, ..StiffnessDesign::default() }.stiffness().unwrap_err();
        assert_eq!(refused.to_string(), "the radius must be a positive number, not 0");
        assert!(
            StiffnessDesign { modulus: 1e300, mass: 1e-300, ..StiffnessDesign::default() }
                .stiffness()
                .is_err()
        );
        assert!(penetration(0.0, 1.0).is_err() && duration(1e6, f64::NAN).is_err());
    }
}
