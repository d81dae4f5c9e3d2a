//! The main mass in SI units, and its numbers in those of a pendulum.
//!
//! ```text
//! R = M/m,  kappa = k L/(m g),  delta = (c/m) sqrt(L/g),  f = F/(m g),  eta = Omega sqrt(L/g)
//! y = displacement/L,  y' = speed/sqrt(g L)
//! ```

use super::{Primary, PrimaryCase};
use crate::impact::{Model, Start, Units};

/// A main mass in SI units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MainMass {
    /// M, kg, without the pendulum.
    pub mass: f64,
    /// The stiffness of its spring, N/m.
    pub stiffness: f64,
    /// The coefficient of its dashpot, N s/m.
    pub damping: f64,
    /// The initial displacement, m.
    pub displacement: f64,
    /// The initial speed, m/s.
    pub speed: f64,
    /// The amplitude of the force on it, N.
    pub force: f64,
    /// The angular frequency of that force, rad/s.
    pub frequency: f64,
}

impl MainMass {
    /// The dimensionless numbers of the main mass with this pendulum.
    pub fn primary(&self, units: &Units) -> Primary {
        let time = units.time();
        Primary {
            mass: self.mass / units.mass,
            stiffness: self.stiffness * units.length / units.force(),
            damping: self.damping / units.mass * time,
            force: self.force / units.force(),
            frequency: self.frequency * time,
        }
    }

    /// Its displacement and velocity at the start.
    pub fn start(&self, units: &Units) -> [f64; 2] {
        [self.displacement / units.length, self.speed / units.speed()]
    }

    /// The main mass together with this pendulum, let go from `start`.
    pub fn carrying(&self, units: &Units, model: Model, start: Start) -> PrimaryCase {
        let [displacement, speed] = self.start(units);
        PrimaryCase {
            primary: self.primary(units),
            model,
            start: [start.x, start.velocity, displacement, speed],
        }
    }
}
