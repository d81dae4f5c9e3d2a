//! One design: its motion until it rests, and the numbers that a search asks for.
//!
//! The motion is the chain of closed forms, a few microseconds; where it has none, as for a heavily damped swing, it is integrated.

use super::question::Question;
use crate::impact::contact::hunt_crossley::{peak_force, restitution};
use crate::impact::primary::{PrimaryCase, PrimarySettings, simulate_primary};
use crate::impact::{
    Case, Integrator, Model, NoRest, Parameter, Settings, SimulationError, Start, Units, course, hertz,
};

/// How a design is judged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Route {
    /// By closed forms, and by integration where there are none.
    Chain,
    /// By integration.
    Integration,
}

/// The contact that is touched fastest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HardestContact {
    /// The greatest force, that of the damping included, N.
    pub force: f64,
    /// The pressure of Hertz at the greatest depth, Pa.
    pub pressure: f64,
    /// The coefficient of restitution.
    pub restitution: f64,
}

/// A design that was followed until it rests.
#[derive(Debug, Clone, PartialEq)]
pub struct Design {
    /// The point of the box.
    pub point: Vec<f64>,
    /// The number of its material, where materials are tried.
    pub material: Option<usize>,
    /// The pendulum, its barrier and what damps it.
    pub case: Case,
    /// The equation.
    pub model: Model,
    /// What its numbers are in SI units.
    pub units: Units,
    /// When it rests, in units of 1/omega.
    pub rest_time: Result<f64, NoRest>,
    /// The contacts until then.
    pub impacts: usize,
    /// The hardest of them; nothing where none was, or nobody asked for it.
    pub hardest: Option<HardestContact>,
    /// When the main mass rests, s; nothing where it never does, or nobody asked for it.
    pub primary_rest_time: Option<f64>,
    /// Whether it was integrated.
    pub integrated: bool,
}

impl Question {
    /// The case of a point of the box, and the number of its material.
    pub fn case_of(&self, point: &[f64]) -> (Case, Option<usize>) {
        let mut case = self.case;
        let mut material = (self.materials.len() == 1).then_some(0);
        for (index, value) in point.iter().enumerate() {
            match self.variables.get(index) {
                Some(variable) => case.set(variable.parameter, *value),
                None => {
                    let number = (value.max(0.0).floor() as usize).min(self.materials.len().saturating_sub(1));
                    material = Some(number);
                }
            }
        }
        if let Some(of) = material.and_then(|number| self.materials.get(number)) {
            case.design.modulus = of.modulus.value();
            if let Some(damping) = of.damping {
                case.contact_damping = damping;
                case.at_speed = of.at_speed;
            }
        }
        (case, material)
    }

    /// Whether a design may have the damping of the contact that is held fixed: not where every material has its own.
    pub fn holds_contact_damping(&self) -> bool {
        self.materials.is_empty() || self.materials.iter().any(|material| material.damping.is_none())
    }

    /// Follows a design until it rests.
    ///
    /// # Errors
    /// As [`simulate`](crate::impact::simulate()), and [`Case::motion`] in words.
    pub fn follow(&self, point: &[f64], route: Route, contact: bool) -> Result<Design, String> {
        let (case, material) = self.case_of(point);
        let (model, start) = case.motion().map_err(|error| error.to_string())?;
        let units = Units {
            mass: case.design.mass,
            length: case.design.length,
            gravity: case.design.gravity,
            radius: Some(case.design.radius),
            modulus: None,
            sphere_yield: self.sphere_yield,
            barrier_yield: None,
        };
        let settings = Settings {
            stop_at_rest: true,
            keep_path: false,
            ..self.settings
        };
        let (followed, integrated) = match route {
            Route::Integration => (course(&model, start, Integrator::Taylor, &settings), true),
            Route::Chain => match course(&model, start, Integrator::Chain, &settings) {
                Err(SimulationError::Chain(_)) => (course(&model, start, Integrator::Taylor, &settings), true),
                followed => (followed, false),
            },
        };
        let followed = followed.map_err(|error| error.to_string())?;
        let fastest = followed
            .impacts
            .iter()
            .max_by(|one, other| one.speed_in.total_cmp(&other.speed_in));
        let hardest = fastest.filter(|_| contact).and_then(|impact| {
            let ratio = model.mu / model.gamma;
            let elastic = units.force() * hertz::force(model.gamma, impact.penetration);
            Some(HardestContact {
                force: units.force() * peak_force(1.5, model.gamma, ratio, impact.speed_in)?,
                pressure: units.pressure(elastic, units.length * impact.penetration)?,
                restitution: restitution(ratio * impact.speed_in).ok()?,
            })
        });
        Ok(Design {
            point: point.to_vec(),
            material,
            case,
            model,
            units,
            rest_time: followed.rest_time,
            impacts: followed.impacts.len(),
            hardest,
            primary_rest_time: self.primary_rest_time(model, &units),
            integrated,
        })
    }

    /// When the main mass rests that carries this pendulum, s: always by integration, for it has no chain. The pendulum hangs at rest when
    /// the main mass is let go.
    fn primary_rest_time(&self, model: Model, units: &Units) -> Option<f64> {
        let main_mass = self.main_mass?;
        let [displacement, speed] = main_mass.start(units);
        let case = PrimaryCase {
            primary: main_mass.primary(units),
            model,
            start: [0.0, 0.0, displacement, speed],
        };
        let settings = PrimarySettings {
            duration: self.settings.duration,
            stop_at_rest: true,
            interrupt: self.settings.interrupt,
            ..PrimarySettings::default()
        };
        let motion = simulate_primary(case, &settings).ok()?;
        Some(motion.rest_time().ok()? * units.time())
    }

    /// The paper's Table 5 as a point of this box, in it or not; nothing where materials are tried.
    pub fn papers_point(&self) -> Option<Vec<f64>> {
        let papers = Case::default();
        let value = |parameter: Parameter| papers.get(parameter);
        match self.materials.is_empty() {
            true => self
                .variables
                .iter()
                .map(|variable| value(variable.parameter))
                .collect(),
            false => None,
        }
    }

    /// The equation and the start of a point of the box.
    pub fn motion_of(&self, point: &[f64]) -> Option<(Model, Start)> {
        self.case_of(point).0.motion().ok()
    }
}
