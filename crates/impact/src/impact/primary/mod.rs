//! The main mass: a mass on spring and dashpot that carries the pendulum and its barriers, which
//! the impact damper is to damp.
//!
//! ```text
//! T = R y'^2/2 + ((y' + x' cos x)^2 + (x' sin x)^2)/2        V = kappa y^2/2 + 1 - cos x
//! D = delta y'^2/2 + zeta x'^2                               Q_y = f sin(eta t)
//! Q_x = -F(x - x_r, x') + F(x_l - x, -x') - alpha sgn(x')    F(d, d') = max(0, gamma + mu d') d^(3/2) for d > 0, else 0
//! ```
//!
//! x is the angle of the pendulum, y the displacement of the main mass over L, t is in units of
//! 1/omega, omega^2 = g/L, energy in units of m g L; R = M/m, kappa = k L/(m g), delta = (c/m)
//! sqrt(L/g), f = F/(m g), eta = Omega/omega. The equations are derived from these energies by
//! [`mechanics`](crate::mechanics). The barriers move with the main mass, so the force between them
//! and the sphere is internal: it changes neither the momentum of both nor, undamped, their energy.
//!
//! In: a [`PrimaryCase`]. Out: a [`PrimaryMotion`], event by event: both states at any time, the
//! impacts, the energy balance, and the rest time of the main mass, with those of the same main
//! mass without damper and with the damper locked, which are linear and known in closed form. A
//! contact is followed in the variable of `regularised`, in which it is analytic through the touch.
//! With [`PrimarySettings::chain`] nothing is integrated where there is a closed form: `modes`,
//! `flight`, `bounce` and `resting` have those of the phases, `chain` puts them together.
//!
//! (S. F. Masri, *J. Acoust. Soc. Am.* 45 (1969) 1111, for impact dampers of this kind.)

mod bounce;
mod chain;
mod equations;
mod flight;
mod follow;
mod linear;
mod modes;
mod nearby;
mod parameter;
mod path;
mod pendulum;
mod resting;
mod si;
mod sweep;

use thiserror::Error;

use super::model::{Friction, Model, Side};
use super::simulation::{ContactRecord, Settings};
use crate::interrupt::Interrupt;
use crate::mechanics::MechanicsError;
use crate::system::SystemError;

pub use follow::simulate_primary;
pub use linear::{Alone, UndampedAndLocked};
pub use nearby::{NEARBY, nearby_rest_times};
pub use parameter::PrimaryParameter;
pub use path::PrimaryState;
pub use si::MainMass;
pub use sweep::{PrimaryRow, sweep_primary};

use path::PrimaryPath;

/// The main mass, all dimensionless.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Primary {
    /// R = M/m, positive.
    pub mass: f64,
    /// kappa = k L/(m g), positive.
    pub stiffness: f64,
    /// delta = (c/m) sqrt(L/g), not negative.
    pub damping: f64,
    /// f = F/(m g), the amplitude of the force on it.
    pub force: f64,
    /// eta = Omega/omega of that force, not negative.
    pub frequency: f64,
}

/// A main mass with its pendulum, and their initial state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrimaryCase {
    /// The main mass.
    pub primary: Primary,
    /// The pendulum and its barriers; its own excitation must be none.
    pub model: Model,
    /// Angle, its velocity, displacement of the main mass, its velocity.
    pub start: [f64; 4],
}

/// Duration and accuracy of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrimarySettings {
    /// Duration, in units of 1/omega.
    pub duration: f64,
    /// Relative error of a step.
    pub tolerance: f64,
    /// Largest number of phases, flights and contacts together.
    pub phase_limit: usize,
    /// Whether it ends as soon as the main mass, not driven, can never again swing a tenth of its
    /// start.
    pub stop_at_rest: bool,
    /// Whether it is followed by closed forms, and integrated only where there are none.
    pub chain: bool,
    /// The interrupt.
    pub interrupt: Interrupt,
}

impl Default for PrimarySettings {
    /// 200 units of time, to 1e-15, at most 100 000 phases.
    fn default() -> Self {
        Self {
            duration: 200.0,
            tolerance: 1e-15,
            phase_limit: 100_000,
            stop_at_rest: false,
            chain: false,
            interrupt: Interrupt::default(),
        }
    }
}

impl From<&Settings> for PrimarySettings {
    /// Duration, interrupt and largest number of phases of a simulation of the pendulum alone.
    fn from(settings: &Settings) -> Self {
        Self {
            duration: settings.duration,
            phase_limit: settings.maximum_steps,
            interrupt: settings.interrupt,
            ..Self::default()
        }
    }
}

/// An impact.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PrimaryImpact {
    /// The barrier: `left` or `right`.
    #[cfg_attr(feature = "schema", schemars(with = "String"))]
    pub side: Side,
    /// When it is touched; 0 where the motion starts inside it.
    pub entry_time: f64,
    /// When it is left; null where the run ends before.
    pub exit_time: Option<f64>,
    /// The speed of the pendulum towards the barrier at the touch; where the motion starts inside
    /// it, the speed inwards then.
    pub speed_in: f64,
    /// Its speed away from it at the release; null where the run ends before.
    pub speed_out: Option<f64>,
    /// The greatest depth, in radians.
    pub penetration: f64,
    /// The energy that the contact took.
    pub energy_lost: f64,
}

impl PrimaryImpact {
    /// Speed out over speed in; `None` for a contact that did not begin with a touch or did not end.
    pub fn restitution(&self) -> Option<f64> {
        let restitution = self.speed_out? / self.speed_in;
        Some(restitution).filter(|restitution| restitution.is_finite())
    }
}

impl From<&PrimaryImpact> for ContactRecord {
    fn from(impact: &PrimaryImpact) -> Self {
        Self {
            exit_time: impact.exit_time,
            speed_out: impact.speed_out,
            penetration: impact.penetration,
            restitution: impact.restitution(),
            energy_lost: impact.exit_time.map(|_| impact.energy_lost),
            ..Self::touched(impact.side, impact.entry_time, impact.speed_in)
        }
    }
}

/// The account of the energy.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "schema",
    derive(schemars::JsonSchema),
    schemars(rename = "PrimaryEnergyDocument")
)]
pub struct PrimaryEnergy {
    /// At the start.
    pub start: f64,
    /// At the end.
    pub end: f64,
    /// Taken by the viscous damping of the pendulum.
    pub viscous: f64,
    /// Taken by its dry friction.
    pub friction: f64,
    /// Taken by the contacts.
    pub contact: f64,
    /// Taken by the dashpot of the main mass.
    pub dashpot: f64,
    /// Put in by the force.
    pub force: f64,
    /// What is not accounted for, over the largest energy.
    pub residual: f64,
}

/// The reason why a motion ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum PrimaryStop {
    /// The end of the duration.
    #[error("at the end of the duration")]
    Duration,
    /// The motion came to rest, and was to end there.
    #[error("at rest")]
    AtRest,
    /// The largest number of phases was reached.
    #[error("after as many flights and contacts as were allowed")]
    PhaseLimit,
    /// A step failed.
    #[error("where no next step could be made")]
    Singular,
    /// An interrupt.
    #[error("interrupted")]
    Interrupted,
}

/// The motion of both bodies.
#[derive(Clone, Debug)]
pub struct PrimaryMotion {
    /// The case.
    pub case: PrimaryCase,
    /// The time at which it ended.
    pub end: f64,
    /// The reason why it ended.
    pub stop: PrimaryStop,
    /// Whether it was followed by closed forms.
    pub by_chain: bool,
    /// The number of phases that were integrated: of a chain those without a closed form.
    pub integrated: usize,
    /// Every impact.
    pub impacts: Vec<PrimaryImpact>,
    /// Turning points of the main mass: time and displacement.
    pub turns: Vec<(f64, f64)>,
    /// Turning points of the pendulum: time and angle.
    pub swings: Vec<(f64, f64)>,
    /// The energy balance.
    pub energy: PrimaryEnergy,
    path: PrimaryPath,
}

/// The reason why a motion or a sweep is not possible.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum PrimaryError {
    /// A number of the main mass outside its range.
    #[error("the {name} of the main mass must be {wanted}, not {value}")]
    Number {
        /// The name of the parameter.
        name: &'static str,
        /// The admissible values.
        wanted: &'static str,
        /// The value given.
        value: f64,
    },
    /// The numbers of the pendulum are not admissible.
    #[error(transparent)]
    Model(#[from] super::model::ModelError),
    /// There is no chain of closed forms.
    #[error(transparent)]
    Chain(#[from] super::chain::ChainError),
    /// A driven pivot, which a main mass excludes.
    #[error(
        "the pivot moves with the main mass: drive that by a force, and leave out the excitation beta"
    )]
    Driven,
    /// The equations could not be derived.
    #[error(transparent)]
    Mechanics(#[from] MechanicsError),
    /// A phase that cannot begin.
    #[error(transparent)]
    System(#[from] SystemError),
    /// The duration is not positive.
    #[error("the duration must be a positive number, not {0}")]
    Duration(f64),
    /// No parameter that a sweep may vary has this name.
    #[error(
        "there is no parameter `{name}` of a main mass to sweep: choose one of {}",
        PrimaryParameter::all().map(PrimaryParameter::name).collect::<Vec<_>>().join(", ")
    )]
    UnknownName {
        /// The name.
        name: String,
        /// The known name that is nearest to it.
        nearest: Option<&'static str>,
    },
    /// Two sections have a key of this name.
    #[error("`{name}` is a key of two sections: write {}", .names.join(" or "))]
    AmbiguousName {
        /// The name.
        name: String,
        /// The names that tell them apart.
        names: Vec<&'static str>,
    },
}

impl PrimaryError {
    /// Advice on the known name that may have been meant.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::UnknownName { nearest, .. } => {
                nearest.map(|name| format!("did you mean `{name}`?"))
            }
            _ => None,
        }
    }
}

impl PrimaryCase {
    fn check(&self) -> Result<(), PrimaryError> {
        let positive = "a positive number";
        let not_negative = "a number, 0 or more";
        let primary = &self.primary;
        for (name, value, wanted, least) in [
            ("mass", primary.mass, positive, f64::MIN_POSITIVE),
            ("stiffness", primary.stiffness, positive, f64::MIN_POSITIVE),
            ("damping", primary.damping, not_negative, 0.0),
            ("frequency of the force", primary.frequency, not_negative, 0.0),
            ("force", primary.force, "a number", f64::MIN),
            ("displacement", self.start[2], "a number", f64::MIN),
            ("speed", self.start[3], "a number", f64::MIN),
        ] {
            if !(value >= least && value.is_finite()) {
                return Err(PrimaryError::Number { name, wanted, value });
            }
        }
        let [x, velocity, ..] = self.start;
        self.model.check(super::model::Start { x, velocity })?;
        if self.model.beta != 0.0 {
            return Err(PrimaryError::Driven);
        }
        Ok(())
    }

    /// The energy of both bodies, with that of the spring and the barrier, in units of m g L.
    pub fn energy(&self, state: PrimaryState) -> f64 {
        let PrimaryState { x, velocity, y, speed } = state;
        let along = speed + velocity * x.cos();
        let across = velocity * x.sin();
        let kinetic = 0.5 * (self.primary.mass * speed * speed + along * along + across * across);
        let half = (0.5 * x).sin();
        let depth = self.model.depth(x).map_or(0.0, |(_, depth)| depth);
        kinetic
            + 0.5 * self.primary.stiffness * y * y
            + 2.0 * half * half
            + self.model.elastic_energy(depth)
    }

    /// Whether its dry friction is Coulomb's.
    fn sticks(&self) -> bool {
        self.model.alpha > 0.0 && self.model.friction == Friction::Exact
    }
}

impl PrimaryMotion {
    /// Both states at a time; `None` outside of the motion.
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::Model;
    /// use lindstedt::impact::primary::{Primary, PrimaryCase, PrimarySettings, simulate_primary};
    ///
    /// let primary = Primary { mass: 10.0, stiffness: 10.0, damping: 0.0, force: 0.0, frequency: 0.0 };
    /// let model = Model { gamma: 1e5, ..Model::default() };
    /// let case = PrimaryCase { primary, model, start: [0.0, 0.0, 0.5, 0.0] };
    /// let settings = PrimarySettings { duration: 20.0, ..PrimarySettings::default() };
    /// let motion = simulate_primary(case, &settings)?;
    /// assert!(motion.energy.residual < 1e-9 && !motion.impacts.is_empty());
    /// let state = motion.state_at(20.0).ok_or("a state")?;
    /// assert!((case.energy(state) / motion.energy.start - 1.0).abs() < 1e-9); // nothing damps
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn state_at(&self, time: f64) -> Option<PrimaryState> {
        self.path.state_at(time)
    }

    /// Whether it was followed for the whole duration.
    pub fn is_complete(&self) -> bool {
        matches!(self.stop, PrimaryStop::Duration | PrimaryStop::AtRest)
    }

    /// The times at which the phases begin, where a curve has its corners.
    pub fn phase_starts(&self) -> impl Iterator<Item = f64> {
        self.path.starts()
    }

    /// The largest |y| from this time on, by its turning points and the end.
    pub fn largest_since(&self, time: f64) -> f64 {
        let turns = self.turns.iter().filter(|(at, _)| *at >= time).map(|(_, y)| y.abs());
        let end = self.state_at(self.end).map_or(0.0, |state| state.y.abs());
        turns.fold(end, f64::max)
    }
}
