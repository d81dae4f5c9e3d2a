//! The forces of the paper's equation (7), its parameters and their ranges.
//!
//! ```text
//! x'' = -2 zeta x' - alpha sgn(x') - sin x + beta sin(Omega t/omega) cos x - F(x - x_r, x') + F(x_l - x, -x')
//! F(d, d') = max(0, gamma + mu d') d^(3/2)  for d > 0, else 0                                equation (7)
//! sgn(x') ~ (2/pi) atan(100 x')                                                              equation (6)
//! E = x'^2/2 + 1 - cos x + (2/5) gamma d^(5/2)
//! ```
//!
//! (K. H. Hunt and F. R. E. Crossley, *J. Appl. Mech.* 42 (1975) 440 for the damped contact.)
//! Angles in radians, time in units of 1/omega with omega^2 = g/L, energy in units of m g L;
//! everything else is dimensionless. The maximum says that the contact never pulls: left fast
//! enough, the barrier lets go before it is back in place.

use std::f64::consts::{FRAC_2_PI, PI, TAU};

use thiserror::Error;

use super::hertz::{self, NotPositive};
use super::parameter::Parameter;
use crate::decimal::{decimal, significant};

/// The law of dry friction.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Friction {
    /// Coulomb's law: alpha against the motion, and at rest any torque up to alpha that keeps it at
    /// rest.
    #[default]
    Exact,
    /// The paper's equation (6), alpha (2/pi) atan(100 x'): it creeps and never sticks.
    Arctangent,
}

/// The steepness of the arctangent in equation (6).
pub const STEEPNESS: f64 = 100.0;

/// A barrier on one side of the swing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Side {
    /// At negative angles, touched in falling motion.
    Left,
    /// At positive angles, touched in rising motion.
    Right,
}

impl Side {
    /// -1 on the left, 1 on the right: the coordinate `sign * x` runs into the barrier.
    pub fn sign(self) -> f64 {
        match self {
            Self::Left => -1.0,
            Self::Right => 1.0,
        }
    }

    /// The other one.
    pub fn opposite(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }

    /// `left` or `right`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }
}

/// The parameters of equation (7), all dimensionless but the angles, in rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Model {
    /// Viscous damping ratio zeta, not negative.
    pub zeta: f64,
    /// Coulomb friction alpha, not negative.
    pub alpha: f64,
    /// The law of that friction.
    pub friction: Friction,
    /// Excitation beta = (A_e/L)(Omega/omega)^2 of a pivot that moves as A_e sin(Omega t).
    pub beta: f64,
    /// Omega/omega, not negative.
    pub frequency_ratio: f64,
    /// Stiffness gamma of the contact, positive; without a barrier it may be 0.
    pub gamma: f64,
    /// Damping mu of the contact, not negative.
    pub mu: f64,
    /// Position of the left barrier, rad.
    pub left: Option<f64>,
    /// Position of the right barrier x_c, rad.
    pub right: Option<f64>,
}

impl Default for Model {
    /// The default barrier, [`DEFAULT_BARRIER`], with the stiffness of its design,
    /// [`hertz::DEFAULT_STIFFNESS`], and no damping or drive.
    fn default() -> Self {
        Self {
            zeta: 0.0,
            alpha: 0.0,
            friction: Friction::Exact,
            beta: 0.0,
            frequency_ratio: 0.0,
            gamma: hertz::DEFAULT_STIFFNESS,
            mu: 0.0,
            left: None,
            right: Some(DEFAULT_BARRIER),
        }
    }
}

/// The amplitude of the default swing, rad: it is released from rest at x = -1.5.
pub const DEFAULT_AMPLITUDE: f64 = 1.5;

/// The place of the default barrier, rad.
pub const DEFAULT_BARRIER: f64 = 0.323;

/// The initial state of a motion, at t = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Start {
    /// Angle, rad.
    pub x: f64,
    /// Velocity x', in units of omega.
    pub velocity: f64,
}

impl Default for Start {
    /// The default release, from rest at minus [`DEFAULT_AMPLITUDE`].
    fn default() -> Self {
        Self { x: -DEFAULT_AMPLITUDE, velocity: 0.0 }
    }
}

/// The reason why a model or a start is not admissible.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum ModelError {
    /// A parameter that is not a finite number.
    #[error("{parameter} must be a finite number, not {value}")]
    NotFinite {
        /// The parameter.
        parameter: Parameter,
        /// The value given.
        value: f64,
    },
    /// A parameter below zero.
    #[error("{parameter} must not be negative, but is {value}")]
    Negative {
        /// The parameter.
        parameter: Parameter,
        /// The value given.
        value: f64,
    },
    /// A stiffness that is negative, or zero beside a barrier.
    #[error("[contact] gamma must be a positive number, or 0 for no barrier at all, not {0}")]
    Stiffness(f64),
    /// An angle at which the sine has no digits left.
    #[error(
        "{parameter} = {} is an angle whose sine has no digits left: in double precision it is rounded to {} rad there; take one below \
         {LARGEST_ANGLE:e} rad",
        decimal(*value), significant(value.abs() * f64::EPSILON, 1)
    )]
    LostDigits {
        /// The parameter.
        parameter: Parameter,
        /// The value given.
        value: f64,
    },
    /// Barriers in the wrong order.
    #[error(
        "the left barrier at {left} must lie below the right one at {right}: give [left, right]"
    )]
    Barriers {
        /// Position of the left one, rad.
        left: f64,
        /// Position of the right one, rad.
        right: f64,
    },
    /// An amplitude of release that is not positive.
    #[error(
        "[pendulum] amplitude must be a positive number, not {0}; for another start give `start` and `speed`"
    )]
    Amplitude(f64),
    /// A release behind a barrier.
    #[error(
        "the motion starts at x = {start}, inside the {} barrier at {barrier}: move the barrier, or give `start` in \
         [pendulum]", .side.name()
    )]
    Inside {
        /// The side of the barrier.
        side: Side,
        /// Its position, rad.
        barrier: f64,
        /// The start, rad.
        start: f64,
    },
    /// A design that has no stiffness.
    #[error("[design]: {0}")]
    Design(#[from] NotPositive),
    /// A damping of a contact without a barrier.
    #[error("[contact] mu = {0} damps a barrier, and gamma = 0 is none: leave out one of them")]
    NothingToDamp(f64),
    /// An excitation without a frequency.
    #[error(
        "[excitation] beta = {0} needs a frequency_ratio above 0: a pivot that stands still excites nothing"
    )]
    NoFrequency(f64),
    /// A damping that is negative or not a number.
    #[error("{key} must be a number and not negative, not {value}")]
    NegativeDamping {
        /// The parameter.
        key: Parameter,
        /// The value given.
        value: f64,
    },
    /// A restitution outside its range.
    #[error("[contact] restitution must lie above 0 and be at most 1, not {0}")]
    Restitution(f64),
    /// A restitution without a speed at which it holds.
    #[error(
        "[contact] restitution is that at a speed, and without damping, the pivot at rest, this motion touches no barrier, or starts inside one: give \
         `at_speed`, in m/s beside numbers in SI units and otherwise in rad times omega"
    )]
    NoSpeed,
    /// A speed of the restitution that is not positive.
    #[error("[contact] at_speed must be a positive number, not {0}")]
    ContactSpeed(f64),
    /// A lambda whose mu overflows.
    #[error(
        "[contact] lambda = {0} makes no finite mu: it is in s/m, some hundredths for a hard material"
    )]
    Lambda(f64),
    /// A damping that overflows.
    #[error("{key} = {value:e} makes no finite number of equation (7)")]
    InfiniteDamping {
        /// The parameter.
        key: Parameter,
        /// The value given.
        value: f64,
    },
}

/// The largest angle, rad, whose sine is known to a millionth.
const LARGEST_ANGLE: f64 = 4e9;

impl Model {
    /// Checks the parameters and the start.
    ///
    /// # Errors
    /// [`ModelError`] names the first parameter that does not.
    pub fn check(&self, start: Start) -> Result<(), ModelError> {
        let numbers = [
            (Parameter::Zeta, self.zeta),
            (Parameter::Alpha, self.alpha),
            (Parameter::Mu, self.mu),
            (Parameter::FrequencyRatio, self.frequency_ratio),
            (Parameter::Beta, self.beta),
            (Parameter::Barrier, self.left.unwrap_or(0.0)),
            (Parameter::Barrier, self.right.unwrap_or(0.0)),
            (Parameter::Start, start.x),
            (Parameter::Speed, start.velocity),
        ];
        if let Some(&(parameter, value)) = numbers.iter().find(|(_, value)| !value.is_finite()) {
            return Err(ModelError::NotFinite { parameter, value });
        }
        if let Some(&(parameter, value)) =
            numbers[5..8].iter().find(|(_, value)| value.abs() > LARGEST_ANGLE)
        {
            return Err(ModelError::LostDigits { parameter, value });
        }
        if let Some(&(parameter, value)) = numbers[..4].iter().find(|(_, value)| *value < 0.0) {
            return Err(ModelError::Negative { parameter, value });
        }
        let free = self.left.is_none() && self.right.is_none();
        if !(self.gamma.is_finite() && (self.gamma > 0.0 || free && self.gamma == 0.0)) {
            return Err(ModelError::Stiffness(self.gamma));
        }
        if let (Some(left), Some(right)) = (self.left, self.right)
            && left >= right
        {
            return Err(ModelError::Barriers { left, right });
        }
        Ok(())
    }

    /// The position of a barrier, rad.
    pub fn barrier(&self, side: Side) -> Option<f64> {
        match side {
            Side::Left => self.left,
            Side::Right => self.right,
        }
    }

    /// Whether both barriers stand within this angle of a place.
    pub(super) fn is_caged(&self, place: f64, angle: f64) -> bool {
        let near =
            |barrier: Option<f64>| barrier.is_some_and(|barrier| (barrier - place).abs() < angle);
        near(self.left) && near(self.right)
    }

    /// Whether dry friction is Coulomb's and there is some: then the motion is integrated one
    /// direction at a time.
    pub fn sticks(&self) -> bool {
        self.friction == Friction::Exact && self.alpha > 0.0
    }

    /// Acceleration by the forces that do not depend on the velocity, without contact: gravity and
    /// excitation.
    pub fn field(&self, t: f64, x: f64) -> f64 {
        if self.beta == 0.0 {
            return -x.sin();
        }
        self.beta * (self.frequency_ratio * t).sin() * x.cos() - x.sin()
    }

    /// The time derivative of [`Model::field`] at this position.
    pub fn field_rate(&self, t: f64, x: f64) -> f64 {
        let eta = self.frequency_ratio;
        self.beta * eta * (eta * t).cos() * x.cos()
    }

    /// Acceleration by damping: viscous, and dry by equation (6) or, for Coulomb's law, in motion
    /// of this direction (1, -1, or 0 for none).
    pub fn damping(&self, velocity: f64, direction: f64) -> f64 {
        let dry = match self.friction {
            Friction::Exact => self.alpha * direction,
            Friction::Arctangent => self.alpha * FRAC_2_PI * (STEEPNESS * velocity).atan(),
        };
        -2.0 * self.zeta * velocity - dry
    }

    /// Force of a barrier entered to this depth and at this speed, per mass; away from the barrier
    /// it is zero.
    pub fn contact(&self, depth: f64, speed: f64) -> f64 {
        hertz::force((self.gamma + self.mu * speed).max(0.0), depth)
    }

    /// Whether a barrier left at this speed (negative: outwards) would have to pull: it comes back
    /// more slowly.
    pub fn would_pull(&self, speed: f64) -> bool {
        self.gamma + self.mu * speed < 0.0
    }

    /// Energy of a motion without contact, in units of m g L: zero at rest in the lowest place.
    pub fn swing_energy(&self, x: f64, velocity: f64) -> f64 {
        let half = (0.5 * x).sin();
        0.5 * velocity * velocity + 2.0 * half * half
    }

    /// Energy stored in a barrier entered to this depth.
    pub fn elastic_energy(&self, depth: f64) -> f64 {
        hertz::stored_energy(self.gamma, depth)
    }

    /// The depth of this position inside a barrier, and its side; `None` between the barriers.
    pub fn depth(&self, x: f64) -> Option<(Side, f64)> {
        [Side::Left, Side::Right].into_iter().find_map(|side| {
            let depth = side.sign() * (x - self.barrier(side)?);
            (depth > 0.0).then_some((side, depth))
        })
    }

    /// Energy of swing and contact, in units of m g L.
    pub fn energy(&self, x: f64, velocity: f64) -> f64 {
        let depth = self.depth(x).map_or(0.0, |(_, depth)| depth);
        self.swing_energy(x, velocity) + self.elastic_energy(depth)
    }

    /// The time at which Coulomb friction lets go of a pendulum at rest at x, held since `t`
    /// against the constant force `field` and the excitation: the time and the direction; `None` if
    /// it holds for ever.
    ///
    /// |field + beta cos x sin(eta t)| = alpha, with the force increasing through this limit.
    pub(super) fn release(&self, t: f64, x: f64, field: f64) -> Option<(f64, f64)> {
        let drive = self.beta * x.cos();
        if drive == 0.0 || self.frequency_ratio == 0.0 {
            return None;
        }
        let phase = self.frequency_ratio * t;
        let mut first: Option<(f64, f64)> = None;
        for direction in [1.0, -1.0] {
            let level = (direction * self.alpha - field) / drive;
            if level.abs() >= 1.0 {
                continue;
            }
            // The force increases through the limit: direction * drive * cos(phase) > 0.
            let angle = if direction * drive > 0.0 { level.asin() } else { PI - level.asin() };
            let turns = ((phase - angle) / TAU).floor();
            // If the force is at the limit already, to rounding, the release is immediate.
            let near = 1e-14 * phase.abs().max(1.0);
            let mut candidate = angle + TAU * turns;
            if candidate < phase - near {
                candidate += TAU;
            }
            let time = (candidate / self.frequency_ratio).max(t);
            if first.is_none_or(|(earlier, _)| time < earlier) {
                first = Some((time, direction));
            }
        }
        first
    }
}
