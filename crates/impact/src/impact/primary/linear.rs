//! The main mass without its damper, and with the damper locked: linear, in closed form.
//!
//! ```text
//! N y'' + delta y' + kappa y = f sin(eta t)        N = R without the damper, R + 1 with the pendulum locked
//! rest = ln(10) 2 N/delta,  underdamped            |y| = f / sqrt((kappa - N eta^2)^2 + (delta eta)^2) in the long run
//! ```

use super::super::simulation::REST_FRACTION;
use super::{Primary, PrimaryMotion};
use crate::impact::NoRest;

/// A main mass alone, in closed form.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Alone {
    /// Its mass, in units of the mass of the pendulum.
    pub mass: f64,
    /// Its angular frequency, damped; 0 where it creeps.
    pub frequency: f64,
    /// When its envelope has fallen to a tenth; null where it never does, creeps, or a force drives
    /// it.
    pub rest_time: Option<f64>,
    /// Its amplitude in the long run; null where no force drives it.
    pub amplitude: Option<f64>,
}

/// The main mass without its damper and with the damper locked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UndampedAndLocked {
    /// Without the damper.
    pub without: Alone,
    /// Locked.
    pub locked: Alone,
}

impl Primary {
    /// The two linear cases for comparison with the damper.
    pub fn undamped_and_locked(&self) -> UndampedAndLocked {
        UndampedAndLocked {
            without: self.single_mass(self.mass),
            locked: self.single_mass(self.mass + 1.0),
        }
    }

    fn single_mass(&self, mass: f64) -> Alone {
        let decay = 0.5 * self.damping / mass;
        let square = self.stiffness / mass - decay * decay;
        let driven = self.force != 0.0;
        let inertia = mass * self.frequency * self.frequency;
        let reactance = self.stiffness - inertia;
        // The difference of two equal numbers is rounding: resonance without damping has no steady
        // state.
        let reactance = match reactance.abs() <= 8.0 * f64::EPSILON * inertia {
            true => 0.0,
            false => reactance,
        };
        let amplitude = match self.frequency == 0.0 {
            // A force at zero frequency, f sin(0), is no drive.
            true => 0.0,
            false => self.force.abs() / reactance.hypot(self.damping * self.frequency),
        };
        Alone {
            mass,
            frequency: square.max(0.0).sqrt(),
            rest_time: (!driven && decay > 0.0 && square > 0.0)
                .then(|| -REST_FRACTION.ln() / decay),
            amplitude: driven.then_some(amplitude).filter(|amplitude| amplitude.is_finite()),
        }
    }

    /// The envelope of the free motion of the mass alone from this start; `None` if it is
    /// overdamped.
    pub fn alone_envelope(&self, mass: f64, [y, speed]: [f64; 2], t: f64) -> Option<f64> {
        let decay = 0.5 * self.damping / mass;
        let square = self.stiffness / mass - decay * decay;
        let height = || y.hypot((speed + decay * y) / square.sqrt());
        (square > 0.0).then(|| height() * (-decay * t).exp())
    }

    /// The displacement of the free motion of the mass alone from this start.
    pub fn alone_at(&self, mass: f64, [y, speed]: [f64; 2], t: f64) -> f64 {
        let decay = 0.5 * self.damping / mass;
        let square = self.stiffness / mass - decay * decay;
        let slope = speed + decay * y;
        let wave = match square {
            square if square > 0.0 => {
                let omega = square.sqrt();
                y * (omega * t).cos() + slope * (omega * t).sin() / omega
            }
            square if square < 0.0 => {
                // Both exponentials together, for the growing one alone may be too large.
                let rate = (-square).sqrt();
                let [slow, fast] = [((rate - decay) * t).exp(), ((-rate - decay) * t).exp()];
                return 0.5 * ((y + slope / rate) * slow + (y - slope / rate) * fast);
            }
            _ => y + slope * t,
        };
        wave * (-decay * t).exp()
    }
}

impl PrimaryMotion {
    /// The time at which the envelope of the main mass has fallen to a tenth of its first swing,
    /// for good: the larger of every two successive turning points, joined by straight lines of
    /// log|y|.
    ///
    /// # Errors
    /// The reason why there is none.
    pub fn rest_time(&self) -> Result<f64, NoRest> {
        let envelope = self.envelope();
        match envelope.first() {
            Some((_, first)) if *first > 0.0 => self.falls_to(REST_FRACTION * first, &envelope),
            _ => Err(NoRest::NoAmplitude),
        }
    }

    /// The points of the envelope of the main mass, time and |y| over L: the first swing at the
    /// start, then the larger of every two successive turning points.
    pub fn envelope(&self) -> Vec<(f64, f64)> {
        let [.., y, speed] = self.case.start;
        let primary = &self.case.primary;
        // The first swing includes the energy of the initial speed.
        let first = y.hypot(speed * (primary.mass / primary.stiffness).sqrt());
        let mut envelope = vec![(0.0, first)];
        let turns: Vec<(f64, f64)> =
            self.turns.iter().filter(|(t, _)| *t > 0.0).map(|(t, y)| (*t, y.abs())).collect();
        for pair in turns.windows(2) {
            let larger = if pair[1].1 > pair[0].1 { pair[1] } else { pair[0] };
            if envelope.last() != Some(&larger) {
                envelope.push(larger);
            }
        }
        envelope
    }

    /// The last time at which this envelope, straight lines of log h through (t, h), falls through
    /// a level.
    ///
    /// # Errors
    /// The reason why it does not.
    pub(super) fn falls_to(&self, level: f64, envelope: &[(f64, f64)]) -> Result<f64, NoRest> {
        let Some(index) = envelope.iter().rposition(|(_, height)| *height > level) else {
            return Err(NoRest::StaysAbove);
        };
        let above = envelope[index];
        let Some(below) = envelope.get(index + 1) else {
            return Err(if self.is_complete() { NoRest::StaysAbove } else { NoRest::BrokeOff });
        };
        let height = |point: (f64, f64)| point.1.max(1e-12 * level).ln();
        let share = (level.ln() - height(above)) / (height(*below) - height(above));
        Ok(above.0 + share * (below.0 - above.0))
    }
}
