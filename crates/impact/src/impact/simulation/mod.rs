//! The result of a simulation and its evaluation.
//!
//! In: from either integrator the path, the contacts, the turning points and why the run ended.
//! Out: a [`Simulation`]: the motion as a function of time, its energy balance, its rest time, its
//! distance from another motion.
//!
//! - `path`: the motion as a function of time, piece by piece.
//! - `closed`: the formulas of a chain.
//! - `energy`: the work of each force, and the residual.
//! - `place`: the position of rest.
//! - `rest`: the envelope and its 10 %.

mod closed;
pub(super) mod energy;
pub(super) mod path;
pub(super) mod place;
pub(super) mod rest;

use std::fmt;

pub use closed::ClosedForm;
pub use energy::{EnergyBook, EnergyPoint};
pub use path::{PathSegment, Regime, SimulationPath};
pub use rest::{NoRest, REST_FRACTION, Rest};
pub(super) use rest::{first_swing, has_rested};

use super::model::{Model, Side, Start};
use super::si::greatest;
use crate::decimal::significant;
use crate::interrupt::Interrupt;

/// The integration method of a motion.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Integrator {
    /// Power series, the contact in its regularised variable: the fast one.
    #[default]
    Taylor,
    /// The library's Runge-Kutta in phases, for verification.
    RungeKutta,
    /// A chain of closed forms: swing and contact, one after the other, without integration.
    Chain,
}

impl Integrator {
    /// `chain`, or `integration` for both others.
    pub fn route(self) -> &'static str {
        match self {
            Self::Chain => "chain",
            Self::Taylor | Self::RungeKutta => "integration",
        }
    }
}

/// Duration and accuracy of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Time to follow it for, in units of 1/omega.
    pub duration: f64,
    /// Error allowed in one step, relative to the size of x and x'.
    pub relative_tolerance: f64,
    /// Absolute error allowed in one step in addition, in rad, for a motion of size 1 or more;
    /// proportionally less for smaller ones.
    pub absolute_tolerance: f64,
    /// Largest number of steps.
    pub maximum_steps: usize,
    /// Stop as soon as the energy (units of m g L) is no more than this.
    pub rest_energy: Option<f64>,
    /// The interrupt.
    pub interrupt: Interrupt,
    /// Stop as soon as the rest time is known; Runge-Kutta continues to the end.
    pub stop_at_rest: bool,
    /// Keep the motion as a function of time; otherwise only impacts, turning points and the end.
    pub keep_path: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            duration: 50.0,
            relative_tolerance: 1e-12,
            absolute_tolerance: 1e-14,
            maximum_steps: 250_000,
            rest_energy: None,
            interrupt: Interrupt::default(),
            stop_at_rest: false,
            keep_path: true,
        }
    }
}

/// The reason why a run ended. Everything before is kept.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum SimulationStop {
    /// The end of the duration.
    Duration,
    /// The energy fell to [`Settings::rest_energy`].
    RestEnergy,
    /// The envelope fell to a tenth of the first swing, with [`Settings::stop_at_rest`].
    AtRest,
    /// The state overflowed.
    NotFinite {
        /// The last time reached.
        t: f64,
    },
    /// Too many steps.
    Steps {
        /// The last time reached.
        t: f64,
    },
    /// An interrupt.
    Interrupted {
        /// The last time reached.
        t: f64,
    },
    /// The tolerance asks for steps that do not advance the clock.
    StepTooSmall {
        /// The last time reached.
        t: f64,
    },
    /// Events follow each other without progress of time.
    Stalled {
        /// The time at which it happened.
        t: f64,
    },
}

impl SimulationStop {
    /// Whether the run reached its intended end.
    pub fn is_complete(self) -> bool {
        matches!(self, Self::Duration | Self::RestEnergy | Self::AtRest)
    }
}

impl SimulationStop {
    /// The reason with its time shifted.
    pub(super) fn delayed_by(self, time: f64) -> Self {
        match self {
            Self::Duration | Self::RestEnergy | Self::AtRest => self,
            Self::NotFinite { t } => Self::NotFinite { t: time + t },
            Self::Steps { t } => Self::Steps { t: time + t },
            Self::Interrupted { t } => Self::Interrupted { t: time + t },
            Self::StepTooSmall { t } => Self::StepTooSmall { t: time + t },
            Self::Stalled { t } => Self::Stalled { t: time + t },
        }
    }

    /// The reason in a word or two, for tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Duration => "duration",
            Self::RestEnergy => "rest energy",
            Self::AtRest => "at rest",
            Self::NotFinite { .. } => "not finite",
            Self::Steps { .. } => "step limit",
            Self::Interrupted { .. } => "interrupted",
            Self::StepTooSmall { .. } => "step too small",
            Self::Stalled { .. } => "stalled",
        }
    }
}

impl fmt::Display for SimulationStop {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let time = |t: &f64| significant(*t, 12);
        match self {
            Self::Duration => write!(formatter, "the end of the duration was reached"),
            Self::RestEnergy => write!(formatter, "the energy fell to the rest energy"),
            Self::AtRest => write!(formatter, "the rest time is known"),
            Self::NotFinite { t } => {
                write!(
                    formatter,
                    "no finite value after t = {}: the numbers of the problem are too large",
                    time(t)
                )
            }
            Self::Steps { t } => write!(
                formatter,
                "the allowed number of steps was used up at t = {}: raise step_limit in [run], or shorten the duration",
                time(t)
            ),
            Self::Interrupted { t } => {
                write!(formatter, "the run was stopped from outside at t = {}", time(t))
            }
            Self::StepTooSmall { t } => write!(
                formatter,
                "the tolerance could not be reached at t = {}: the steps became too small; loosen it",
                time(t)
            ),
            Self::Stalled { t } => write!(
                formatter,
                "events follow each other without time going on at t = {}: change the barrier or the friction a little",
                time(t)
            ),
        }
    }
}

/// One contact with a barrier.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct ContactRecord {
    /// The side of the barrier.
    pub side: Side,
    /// The time at which it is touched.
    pub entry_time: f64,
    /// The time at which it is left; `None` if the run ended before.
    pub exit_time: Option<f64>,
    /// Speed at the touch; where the motion starts inside the barrier, its speed inwards then,
    /// negative if it leaves.
    pub speed_in: f64,
    /// Depth at the entry, rad: 0 at a touch, more where the motion starts inside the barrier.
    pub start_depth: f64,
    /// Speed at the release.
    pub speed_out: Option<f64>,
    /// Greatest depth, rad.
    pub penetration: f64,
    /// Speed out over speed in; `None` for a contact that did not begin with a touch.
    pub restitution: Option<f64>,
    /// Energy that the motion has lost between touch and release, units of m g L.
    pub energy_lost: Option<f64>,
}

impl ContactRecord {
    /// A contact that begins with a touch at this speed.
    pub(super) fn touched(side: Side, t: f64, speed: f64) -> Self {
        Self {
            side,
            entry_time: t,
            exit_time: None,
            speed_in: speed,
            start_depth: 0.0,
            speed_out: None,
            penetration: 0.0,
            restitution: None,
            energy_lost: None,
        }
    }

    /// The contact with its times shifted.
    pub(super) fn delayed_by(&self, time: f64) -> Self {
        Self {
            entry_time: self.entry_time + time,
            exit_time: self.exit_time.map(|exit| exit + time),
            ..*self
        }
    }

    /// The contact ends, at this time and with this speed.
    pub(super) fn released(&mut self, model: &Model, t: f64, speed: f64) {
        self.exit_time = Some(t);
        self.speed_out = Some(speed);
        let touched = self.start_depth == 0.0;
        self.restitution = (touched && self.speed_in > 0.0).then(|| speed / self.speed_in);
        // The positions of touch and release may differ in height, and the barrier may store
        // energy.
        let held = match model.barrier(self.side) {
            Some(barrier) if !touched => {
                let inside = barrier + self.side.sign() * self.start_depth;
                model.energy(inside, 0.0) - model.swing_energy(barrier, 0.0)
            }
            _ => 0.0,
        };
        self.energy_lost = Some(held + 0.5 * (self.speed_in - speed) * (self.speed_in + speed));
    }
}

/// The approximate size of a motion, in displacement or speed; zero for a pendulum at rest in its
/// lowest position.
pub(super) fn size(model: &Model, start: Start) -> f64 {
    let stored = model.depth(start.x).map_or(0.0, |(_, depth)| model.elastic_energy(depth));
    let released = (2.0 * stored).sqrt();
    start.x.abs().max(start.velocity.abs()).max(released).max(model.beta.abs())
}

/// Settings of the same accuracy for a motion of this size: the absolute tolerance is that of a
/// motion of size 1, and a tiny one would be lost in it.
pub(super) fn scaled(settings: &Settings, model: &Model, start: Start) -> Settings {
    let size = size(model, start);
    let scale = if size > 0.0 { size.min(1.0) } else { 1.0 };
    Settings {
        absolute_tolerance: (scale * settings.absolute_tolerance).max(f64::MIN_POSITIVE),
        ..*settings
    }
}

/// Records the beginning of a contact: at this depth, which is zero at a touch, and with this speed
/// inwards.
///
/// If a contact was left and is entered again before x has changed by more than the error of a
/// step, the old contact continues: the pendulum is pressed against the barrier and rests there.
pub(super) fn begin_contact(
    impacts: &mut Vec<ContactRecord>,
    (model, settings): (&Model, &Settings),
    side: Side,
    t: f64,
    [depth, speed]: [f64; 2],
) {
    let place = model.barrier(side).unwrap_or_default().abs();
    let visible = settings.absolute_tolerance + settings.relative_tolerance * place;
    if let Some(last) = impacts.last_mut()
        && last.side == side
        && let (Some(exit), Some(left)) = (last.exit_time, last.speed_out)
        && left.max(speed) * (t - exit) <= visible
    {
        *last = ContactRecord {
            exit_time: None,
            speed_out: None,
            restitution: None,
            energy_lost: None,
            ..*last
        };
        return;
    }
    impacts.push(ContactRecord {
        start_depth: depth,
        penetration: depth,
        ..ContactRecord::touched(side, t, speed)
    });
}

/// A moment of rest: x is largest or smallest there, or friction begins or ceases to hold it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TurningPoint {
    /// The time.
    pub t: f64,
    /// The position, rad.
    pub x: f64,
}

/// A motion that was followed.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Simulation {
    /// The model.
    pub model: Model,
    /// The initial state.
    pub start: Start,
    /// The settings of the run.
    pub settings: Settings,
    /// The integration method.
    pub integrator: Integrator,
    /// The motion as a function of time; empty without [`Settings::keep_path`].
    pub path: SimulationPath,
    /// Every contact, in order.
    pub impacts: Vec<ContactRecord>,
    /// Every turning point, in order; including the start if that is one.
    pub turns: Vec<TurningPoint>,
    /// Time at the end.
    pub end_time: f64,
    /// Displacement there, rad.
    pub end_x: f64,
    /// Velocity there.
    pub end_velocity: f64,
    /// The reason why it ended there.
    pub stop: SimulationStop,
    /// Steps taken.
    pub steps: usize,
    /// The time at which |x| has fallen to a tenth of the first swing, if the envelope does not
    /// determine the rest and there is no path or that of a chain.
    pub(super) fall: Option<f64>,
}

/// How far a contact of a chain is from the same one by integration.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema), schemars(rename = "ImpactError"))]
pub struct ContactDeviation {
    /// The difference of the times of touch, in units of time.
    pub entry_time: f64,
    /// The error of the speed of touch, as a fraction of it; null where it is zero.
    pub speed_in: Option<f64>,
    /// The error of the greatest depth, as a fraction of it; null where a run ends before.
    pub penetration: Option<f64>,
    /// The error of the duration, as a fraction of it; null where a run ends before.
    pub duration: Option<f64>,
    /// The error of the speed of release, as a fraction of it; null where a run ends before.
    pub speed_out: Option<f64>,
}

/// The differences of two motions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionDifference {
    /// The largest difference in x, rad.
    pub displacement: f64,
    /// The largest difference in x'.
    pub velocity: f64,
    /// The end of the comparison.
    pub until: f64,
}

/// Ratio of the duration of a contact to the time of its end below which the duration has lost
/// digits.
pub(super) const CLOCK: f64 = 1e-6;

impl Simulation {
    /// The greatest force of the barrier in a contact, its damping included, in units of m g, found
    /// on the path. `None` if no path is kept, for a chain, whose path is approximate, and if the
    /// contact did not end or is too short for the clock.
    ///
    /// ```
    /// # use lindstedt_impact as lindstedt;
    /// use lindstedt::impact::{Integrator, Model, Settings, Start, simulate};
    ///
    /// let model = Model { gamma: 1e4, ..Model::default() };
    /// let motion = simulate(&model, Start::default(), Integrator::Taylor, &Settings::default())?;
    /// let first = motion.impacts[0];
    /// let force = motion.peak_force(&first).ok_or("a force")?;
    /// assert!((force / (1e4 * first.penetration.powf(1.5)) - 1.0).abs() < 1e-9); // without damping that of the greatest depth
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn peak_force(&self, impact: &ContactRecord) -> Option<f64> {
        let (exit, barrier) = (impact.exit_time?, self.model.barrier(impact.side)?);
        let is_known = self.integrator != Integrator::Chain && !self.path.pieces().is_empty();
        if !is_known || exit - impact.entry_time < CLOCK * exit {
            return None;
        }
        let sign = impact.side.sign();
        let force = |t: f64| match self.path.phase_point_at(t) {
            Some((x, velocity)) => self.model.contact(sign * (x - barrier), sign * velocity),
            None => 0.0,
        };
        Some(greatest(force, impact.entry_time, exit))
    }

    /// Compares the paths at this many times, as far as both go.
    pub fn difference(&self, other: &Self, count: usize) -> MotionDifference {
        let until = self.end_time.min(other.end_time);
        let mut difference = MotionDifference { displacement: 0.0, velocity: 0.0, until };
        for index in 0..count {
            let t = until * (index as f64 / (count.max(2) - 1) as f64);
            if let (Some((x, v)), Some((other_x, other_v))) =
                (self.path.phase_point_at(t), other.path.phase_point_at(t))
            {
                difference.displacement = difference.displacement.max((x - other_x).abs());
                difference.velocity = difference.velocity.max((v - other_v).abs());
            }
        }
        difference
    }

    /// The deviations of the contacts from those of the true motion, in order; `None` for a contact
    /// that the true motion does not have.
    pub fn contact_deviations(&self, truth: &Self) -> Vec<Option<ContactDeviation>> {
        let relative =
            |found: f64, truth: f64| Some(found / truth - 1.0).filter(|error| error.is_finite());
        let error = |(index, found): (usize, &ContactRecord)| {
            let truth = truth.impacts.get(index).filter(|truth| truth.side == found.side)?;
            let duration = |contact: &ContactRecord| Some(contact.exit_time? - contact.entry_time);
            let both = |found: Option<f64>, truth: Option<f64>| relative(found?, truth?);
            let depth = |contact: &ContactRecord| contact.exit_time.map(|_| contact.penetration);
            Some(ContactDeviation {
                entry_time: found.entry_time - truth.entry_time,
                speed_in: relative(found.speed_in, truth.speed_in),
                penetration: both(depth(found), depth(truth)),
                duration: both(duration(found), duration(truth)),
                speed_out: both(found.speed_out, truth.speed_out),
            })
        };
        self.impacts.iter().enumerate().map(error).collect()
    }

    /// Whether two barriers hold the pendulum within a tenth of its first swing: then by the
    /// envelope it is at rest from the beginning, whatever its energy.
    pub fn is_caged(&self) -> bool {
        let rest = self.rest();
        self.model.is_caged(rest.place, REST_FRACTION * rest.amplitude)
    }

    /// Whether a barrier was touched at all.
    pub fn touches(&self) -> bool {
        !self.impacts.is_empty()
    }

    /// Whether it is certain that no barrier will ever be touched: there is no drive, and the
    /// remaining energy does not suffice.
    pub fn never_touches(&self) -> bool {
        let left_over = self.model.energy(self.end_x, self.end_velocity);
        let out_of_reach = |barrier: f64| {
            barrier.abs() < std::f64::consts::PI
                && barrier.abs() > self.end_x.abs()
                && self.model.swing_energy(barrier, 0.0) > left_over * (1.0 + 1e-9)
        };
        // Beyond the upright position a barrier is out of reach of any motion that does not turn
        // over.
        let upright = |barrier: f64| barrier.abs() >= std::f64::consts::PI && left_over < 2.0;
        let barriers = [self.model.left, self.model.right].into_iter().flatten();
        !self.touches()
            && self.model.beta == 0.0
            && barriers.into_iter().all(|barrier| out_of_reach(barrier) || upright(barrier))
    }
}
