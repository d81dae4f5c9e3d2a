//! The motion that a study of materials follows: of the pendulum, or of the main mass that carries
//! it.
//!
//! In: an equation, its start, and the main mass if there is one. Out: a [`StudiedMotion`] with its
//! rest time, impacts and envelope, whichever body it is that is to come to rest.

use super::super::contact::HuntCrossley;
use super::super::hertz;
use super::super::model::{Model, Start};
use super::super::primary::{
    MainMass, PrimaryError, PrimaryMotion, PrimarySettings, PrimaryStop, nearby_rest_times,
    simulate_primary,
};
use super::super::simulate::simulate;
use super::super::simulation::{
    CLOCK, ContactRecord, Integrator, NoRest, Settings, Simulation, SimulationStop,
};
use super::super::units::Units;
use super::{FirstContact, MaterialsError, MotionToRest};

/// The equation of a motion, its start, and what carries the pendulum.
#[derive(Debug, Clone, Copy)]
pub(super) struct StudiedCase {
    pub(super) model: Model,
    pub(super) start: Start,
    pub(super) units: Units,
    pub(super) main_mass: Option<MainMass>,
}

/// A motion of a study.
#[derive(Debug, Clone)]
pub enum StudiedMotion {
    /// The swing of a pendulum on a fixed pivot.
    Pendulum(Simulation),
    /// A main mass and the pendulum that it carries.
    MainMass(PrimaryMotion),
}

impl StudiedCase {
    /// Follows the motion.
    ///
    /// # Errors
    /// As [`simulate`] and [`simulate_primary`].
    pub(super) fn follow(
        &self,
        integrator: Integrator,
        settings: &Settings,
    ) -> Result<StudiedMotion, MaterialsError> {
        let Some(main_mass) = self.main_mass else {
            let motion = simulate(&self.model, self.start, integrator, settings)?;
            return Ok(StudiedMotion::Pendulum(motion));
        };
        let settings = PrimarySettings {
            stop_at_rest: settings.stop_at_rest,
            chain: integrator == Integrator::Chain,
            ..PrimarySettings::from(settings)
        };
        let case = main_mass.carrying(&self.units, self.model, self.start);
        Ok(StudiedMotion::MainMass(simulate_primary(case, &settings)?))
    }

    /// Follows the motion until it rests.
    ///
    /// # Errors
    /// As [`StudiedCase::follow`].
    pub(super) fn course(
        &self,
        integrator: Integrator,
        settings: &Settings,
    ) -> Result<MotionToRest, MaterialsError> {
        // The envelope of a main mass is above a tenth for good or not: no more is to be seen of it.
        let stop_at_rest = settings.stop_at_rest || self.main_mass.is_some();
        let settings = Settings { keep_path: false, stop_at_rest, ..*settings };
        Ok(MotionToRest::from(&self.follow(integrator, &settings)?))
    }

    /// The least and the greatest rest time of starts nearby; `None` if closed forms follow no main
    /// mass, or if one of the starts does not rest.
    ///
    /// # Errors
    /// As [`simulate_primary`].
    pub(super) fn nearby_rest_times(
        &self,
        integrator: Integrator,
        settings: &Settings,
    ) -> Result<Option<[f64; 2]>, PrimaryError> {
        let Some(main_mass) = self.main_mass.filter(|_| integrator == Integrator::Chain) else {
            return Ok(None);
        };
        let case = main_mass.carrying(&self.units, self.model, self.start);
        nearby_rest_times(case, &PrimarySettings::from(settings))
    }

    /// The speed of the first touch without damping, in units of L omega; `None` if no barrier is
    /// touched within this duration.
    ///
    /// # Errors
    /// As [`simulate_primary`].
    pub(super) fn carried_touch_speed(&self, duration: f64) -> Result<Option<f64>, PrimaryError> {
        let Some(main_mass) = self.main_mass else {
            return Ok(None);
        };
        let undamped = MainMass { damping: 0.0, ..main_mass };
        let model = Model { mu: 0.0, zeta: 0.0, alpha: 0.0, ..self.model };
        // The first flight is one phase, at whose end the impact is on record.
        let settings = PrimarySettings { duration, phase_limit: 1, ..PrimarySettings::default() };
        let motion =
            simulate_primary(undamped.carrying(&self.units, model, self.start), &settings)?;
        Ok(motion.impacts.first().map(|impact| impact.speed_in))
    }

    /// The numbers of a first contact in SI units; the greatest force is found on the motion
    /// itself. For a contact of a chain, or one too short for the clock, duration and force are
    /// those of the closed form, which neglects the force of the swing.
    ///
    /// # Errors
    /// As [`StudiedCase::follow`].
    pub(super) fn first_contact(
        &self,
        impact: &ContactRecord,
        integrator: Integrator,
        settings: &Settings,
    ) -> Result<Option<FirstContact>, MaterialsError> {
        let (Some(exit), Some(restitution)) = (impact.exit_time, impact.restitution) else {
            return Ok(None);
        };
        let Self { model, units, .. } = self;
        let until = Settings { duration: exit, keep_path: true, ..*settings };
        let [duration, peak_force] = match self.follow(integrator, &until)? {
            StudiedMotion::Pendulum(motion) => {
                let closed =
                    integrator == Integrator::Chain || exit - impact.entry_time < CLOCK * exit;
                let contact = closed.then(|| {
                    HuntCrossley::new(1.5, model.gamma, model.mu / model.gamma, impact.speed_in)
                });
                match contact.and_then(Result::ok) {
                    Some(contact) => [contact.duration, contact.peak_force],
                    None => match motion.peak_force(impact) {
                        Some(force) => [exit - impact.entry_time, force],
                        None => return Ok(None),
                    },
                }
            }
            StudiedMotion::MainMass(motion) => match motion.impacts.first() {
                Some(own) => [exit - impact.entry_time, motion.peak_force(own)],
                None => return Ok(None),
            },
        };
        let metres = units.length * impact.penetration;
        let elastic = units.force() * hertz::force(model.gamma, impact.penetration);
        Ok(Some(FirstContact {
            speed: units.speed() * impact.speed_in,
            duration: units.time() * duration,
            penetration: metres,
            peak_force: units.force() * peak_force,
            peak_pressure: units.pressure(elastic, metres).unwrap_or(f64::NAN),
            restitution,
        }))
    }
}

impl StudiedMotion {
    /// The angle of the pendulum, rad, or the displacement of the main mass over L at a time;
    /// `None` outside of the motion.
    pub fn displacement_at(&self, time: f64) -> Option<f64> {
        match self {
            Self::Pendulum(motion) => Some(motion.path.phase_point_at(time)?.0),
            Self::MainMass(motion) => Some(motion.state_at(time)?.y),
        }
    }

    /// The points of the envelope of that displacement: time and height.
    pub fn envelope(&self) -> Vec<(f64, f64)> {
        match self {
            Self::Pendulum(motion) => {
                motion.envelope().iter().map(|turn| (turn.t, turn.x.abs())).collect()
            }
            Self::MainMass(motion) => motion.envelope(),
        }
    }
}

impl From<&StudiedMotion> for MotionToRest {
    fn from(motion: &StudiedMotion) -> Self {
        match motion {
            StudiedMotion::Pendulum(motion) => Self::from(motion),
            StudiedMotion::MainMass(motion) => Self::from(motion),
        }
    }
}

/// The contacts that begin before the rest, all of them without a rest time.
pub(crate) fn impacts_until(
    impacts: &[ContactRecord],
    rest_time: Result<f64, NoRest>,
) -> impl Iterator<Item = &ContactRecord> {
    impacts.iter().filter(move |impact| {
        rest_time.is_err() || rest_time.is_ok_and(|rest| impact.entry_time < rest)
    })
}

impl From<&Simulation> for MotionToRest {
    fn from(motion: &Simulation) -> Self {
        let model = &motion.model;
        let rest_time = motion.rest().time;
        let impacts: Vec<ContactRecord> =
            impacts_until(&motion.impacts, rest_time).copied().collect();
        let energy = |impact: &ContactRecord| {
            Some(model.swing_energy(model.barrier(impact.side)?, impact.speed_out?))
        };
        Self {
            rest_time,
            energies: impacts.iter().filter_map(energy).collect(),
            impacts,
            stop: motion.stop,
        }
    }
}

/// The course of the main mass: its rest time, the impacts until then, and the energy of both
/// bodies after each of them.
impl From<&PrimaryMotion> for MotionToRest {
    fn from(motion: &PrimaryMotion) -> Self {
        let rest_time = motion.rest_time();
        let before_rest = motion.impacts.iter().filter(|impact| {
            rest_time.is_err() || rest_time.is_ok_and(|rest| impact.entry_time < rest)
        });
        let impacts: Vec<ContactRecord> = before_rest.map(ContactRecord::from).collect();
        let energy =
            |impact: &ContactRecord| Some(motion.case.energy(motion.state_at(impact.exit_time?)?));
        let t = motion.end;
        Self {
            rest_time,
            energies: impacts.iter().filter_map(energy).collect(),
            impacts,
            stop: match motion.stop {
                PrimaryStop::Duration => SimulationStop::Duration,
                PrimaryStop::AtRest => SimulationStop::AtRest,
                PrimaryStop::PhaseLimit => SimulationStop::Steps { t },
                PrimaryStop::Singular => SimulationStop::StepTooSmall { t },
                PrimaryStop::Interrupted => SimulationStop::Interrupted { t },
            },
        }
    }
}
