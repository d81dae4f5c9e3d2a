//! The pendulum in SI units: conversion of the dimensionless numbers of the paper's equation (9) to
//! seconds, metres and newtons.
//!
//! In: mass, length and gravity of the pendulum, radius and moduli of the bodies that meet. Out:
//! the units of its numbers, the combined modulus of both bodies, and the contact pressure. With x
//! the angle, d = L (x - x_c) the depth in m,
//!
//! ```text
//! m L^2 x'' + m g L sin x + k d^(3/2) L = 0,   k = (4/3) E sqrt(R)            the motion in SI units
//! x'' + sin x + gamma (x - x_c)^(3/2) = 0,     gamma = k L^(3/2) / (m g)      over m g L, in time units of sqrt(L/g)
//! F = m g gamma (x - x_c)^(3/2) = k d^(3/2)                                   the force of the contact
//! 1/E = (1 - nu1^2)/E1 + (1 - nu2^2)/E2                                       two elastic bodies
//! p0 = 3 F / (2 pi a^2),   a^2 = R d                                          the pressure in the middle of the contact
//!    = (6 F E^2 / (pi^3 R^2))^(1/3)                                           the same, with the E of k
//! ```
//!
//! The paper's equation (3) has the modulus of the barrier alone for E. Ductile bodies with nu =
//! 0.3 begin to yield, below the middle of the contact, where p0 reaches 1.6 times the yield limit
//! Y of the softer one: above that the law of Hertz no longer holds (K. L. Johnson, *Contact
//! Mechanics*, 1985, chapters 4 and 6).

use std::f64::consts::PI;

/// The pressure in the middle of a contact at which bodies with nu = 0.3 begin to yield, over their
/// yield limit.
pub const FIRST_YIELD: f64 = 1.6;

/// The elastic constants of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elastic {
    /// Young's modulus, Pa, positive.
    pub modulus: f64,
    /// Poisson's ratio, above -1 and at most 1/2.
    pub poisson: f64,
}

impl Elastic {
    /// (1 - nu^2)/E, 1/Pa: the contribution of the body to 1/E of the contact.
    fn compliance(self) -> f64 {
        (1.0 - self.poisson * self.poisson) / self.modulus
    }
}

/// The modulus E of the contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Modulus {
    /// The modulus of the barrier alone, Pa, as in the paper's equation (3).
    BarrierAlone(f64),
    /// The modulus of an elastic barrier under a rigid sphere, E1/(1 - nu1^2).
    RigidSphere(Elastic),
    /// The modulus of two elastic bodies.
    Both {
        /// The barrier, E1 and nu1.
        barrier: Elastic,
        /// The sphere, E2 and nu2.
        sphere: Elastic,
    },
}

impl Modulus {
    /// Its value, Pa.
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::{Elastic, Modulus};
    ///
    /// let steel = Elastic { modulus: 2.1e11, poisson: 0.3 };
    /// let both = Modulus::Both { barrier: steel, sphere: steel };
    /// assert!((both.value() / (2.1e11 / 2.0 / 0.91) - 1.0).abs() < 1e-15);
    /// ```
    pub fn value(self) -> f64 {
        match self {
            Self::BarrierAlone(modulus) => modulus,
            Self::RigidSphere(barrier) => 1.0 / barrier.compliance(),
            Self::Both { barrier, sphere } => 1.0 / (barrier.compliance() + sphere.compliance()),
        }
    }
}

/// The pendulum and its bodies in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    /// Mass of the pendulum, kg.
    pub mass: f64,
    /// Length of the pendulum, m.
    pub length: f64,
    /// Acceleration of gravity, m/s^2.
    pub gravity: f64,
    /// Radius of the sphere, m; without it no pressure is known.
    pub radius: Option<f64>,
    /// The modulus from which gamma follows; `None` if gamma is given.
    pub modulus: Option<Modulus>,
    /// Yield limit of the sphere, Pa, where one is stated.
    pub sphere_yield: Option<f64>,
    /// Yield limit of the barrier, Pa, where one is stated.
    pub barrier_yield: Option<f64>,
}

impl Units {
    /// The unit of time, sqrt(L/g), s.
    pub fn time(&self) -> f64 {
        (self.length / self.gravity).sqrt()
    }

    /// The unit of speed, sqrt(g L), m/s.
    pub fn speed(&self) -> f64 {
        (self.gravity * self.length).sqrt()
    }

    /// The unit of force, m g, N.
    pub fn force(&self) -> f64 {
        self.mass * self.gravity
    }

    /// The unit of energy, m g L, J.
    pub fn energy(&self) -> f64 {
        self.force() * self.length
    }

    /// The stiffness k = gamma m g / L^(3/2) of a contact with this gamma, N/m^(3/2).
    pub fn contact_stiffness(&self, stiffness: f64) -> f64 {
        stiffness * self.force() / self.length.powf(1.5)
    }

    /// The pressure p0 = 3 F/(2 pi R d) in the middle of a contact, Pa, by its force in N and its
    /// depth in m; `None` without a radius.
    pub fn pressure(&self, force: f64, depth: f64) -> Option<f64> {
        Some(1.5 * force / (PI * self.radius? * depth))
    }

    /// The bodies with a stated yield limit, and that limit, Pa.
    pub fn yield_limits(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let limits = [("sphere", self.sphere_yield), ("barrier", self.barrier_yield)];
        limits.into_iter().filter_map(|(body, limit)| limit.map(|limit| (body, limit)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::impact::hertz::{self, StiffnessDesign};

    #[test]
    fn the_equivalent_modulus_at_its_limits() {
        let steel = Elastic { modulus: 2e11, poisson: 0.3 };
        let rigid = Elastic { modulus: 1e300, poisson: 0.3 };
        let together = |sphere| Modulus::Both { barrier: steel, sphere }.value();
        assert!((together(rigid) / Modulus::RigidSphere(steel).value() - 1.0).abs() < 1e-15);
        assert!((together(rigid) / (2e11 / 0.91) - 1.0).abs() < 1e-15);
        assert!((together(steel) / (1e11 / 0.91) - 1.0).abs() < 1e-15);
        // Without lateral strain a rigid sphere meets the modulus of the barrier itself.
        let cork = Elastic { poisson: 0.0, ..steel };
        assert_eq!(Modulus::RigidSphere(cork).value(), Modulus::BarrierAlone(cork.modulus).value());
    }

    #[test]
    fn force_and_pressure_are_those_of_hertz() {
        let design = StiffnessDesign::default();
        let gamma = design.stiffness().unwrap();
        let units = Units {
            mass: design.mass,
            length: design.length,
            gravity: design.gravity,
            radius: Some(design.radius),
            modulus: Some(Modulus::BarrierAlone(design.modulus)),
            sphere_yield: None,
            barrier_yield: None,
        };
        let stiffness = 4.0 / 3.0 * design.modulus * design.radius.sqrt();
        assert!((units.contact_stiffness(gamma) / stiffness - 1.0).abs() < 1e-14);
        for angle in [1e-6, 1.4e-3, 0.1_f64] {
            let depth = design.length * angle;
            let force = units.force() * hertz::force(gamma, angle);
            assert!((force / (stiffness * depth.powf(1.5)) - 1.0).abs() < 1e-14);
            let pressure = units.pressure(force, depth).unwrap();
            let by_force = (6.0 * force * design.modulus.powi(2)
                / (PI.powi(3) * design.radius.powi(2)))
            .cbrt();
            assert!((pressure / by_force - 1.0).abs() < 1e-14, "{pressure} and {by_force}");
            // The mean pressure is two thirds of it.
            let area = PI * design.radius * depth;
            assert!((force / area / pressure - 2.0 / 3.0).abs() < 1e-14);
        }
    }
}
