//! One design: its motion until it rests, and the numbers that a search needs.
//!
//! The motion is the chain of closed forms, a few microseconds; if it has none, as for a heavily
//! damped swing, it is integrated. A pendulum that a main mass carries is followed together with
//! it, likewise, in a millisecond or two.

use super::question::OptimizationProblem;
use crate::impact::contact::hunt_crossley::{peak_force, restitution};
use crate::impact::primary::{MainMass, PrimaryError, PrimarySettings, simulate_primary};
use crate::impact::{
    Case, ContactRecord, Integrator, Model, MotionToRest, NoRest, Parameter, Settings, Simulation,
    SimulationError, Start, Units, hertz, simulate, simulate_each,
};

/// The way in which a design is evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Route {
    /// Closed forms, and integration if there are none.
    Chain,
    /// Integration.
    Integration,
}

/// The greatest numbers of all contacts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HardestContact {
    /// The greatest force, that of the damping included, N.
    pub force: f64,
    /// The pressure of Hertz at the greatest depth, Pa.
    pub pressure: f64,
    /// The coefficient of restitution of the contact with the greatest force; `None` if it did not
    /// begin with a touch or did not end.
    pub restitution: Option<f64>,
}

impl HardestContact {
    /// The greatest of these contacts: each is given by its force in units of m g, its depth in
    /// rad, and its restitution. `None` if there is none.
    fn from_contacts(
        model: &Model,
        units: &Units,
        contacts: impl Iterator<Item = (f64, f64, Option<f64>)>,
    ) -> Option<Self> {
        contacts.fold(None, |hardest: Option<Self>, (force, depth, restitution)| {
            let elastic = units.force() * hertz::force(model.gamma, depth);
            let own = Self {
                force: units.force() * force,
                pressure: units.pressure(elastic, units.length * depth).unwrap_or(0.0),
                restitution,
            };
            Some(match hardest {
                None => own,
                Some(other) => Self {
                    pressure: own.pressure.max(other.pressure),
                    ..if own.force > other.force { own } else { other }
                },
            })
        })
    }
}

/// A design that was followed until it rests.
#[derive(Debug, Clone, PartialEq)]
pub struct EvaluatedDesign {
    /// The point of the box.
    pub point: Vec<f64>,
    /// The number of its material; `None` if no materials are tried.
    pub material: Option<usize>,
    /// The pendulum, its barrier and its dampings.
    pub case: Case,
    /// The equation.
    pub model: Model,
    /// The units of its numbers.
    pub units: Units,
    /// The rest time of the pendulum, in units of 1/omega.
    pub rest_time: Result<f64, NoRest>,
    /// The contacts until it rests; all of them if it does not.
    pub impacts: usize,
    /// The hardest of them; `None` if there was none, or it was not requested.
    pub hardest: Option<HardestContact>,
    /// The rest time of the main mass, s; `None` without one.
    pub primary_rest_time: Option<Result<f64, NoRest>>,
    /// Whether it was integrated.
    pub integrated: bool,
}

impl OptimizationProblem {
    /// The case of a point of the box, and the number of its material.
    pub fn case_of(&self, point: &[f64]) -> (Case, Option<usize>) {
        let mut case = self.case;
        let mut material = (self.materials.len() == 1).then_some(0);
        for (index, value) in point.iter().enumerate() {
            match self.variables.get(index) {
                Some(variable) => case.set(variable.parameter, *value),
                None => {
                    let number = (value.max(0.0).floor() as usize)
                        .min(self.materials.len().saturating_sub(1));
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

    /// Whether the damping of the contact that is held fixed may apply: it does not if every
    /// material has its own.
    pub fn holds_contact_damping(&self) -> bool {
        self.materials.is_empty()
            || self.materials.iter().any(|material| material.damping.is_none())
    }

    /// Follows a design until it rests; `contact` asks for the hardest contact too.
    ///
    /// # Errors
    /// As [`simulate`](crate::impact::simulate()), and [`Case::motion`] in words.
    pub fn follow(
        &self,
        point: &[f64],
        route: Route,
        contact: bool,
    ) -> Result<EvaluatedDesign, String> {
        match route {
            Route::Integration => self.follow_motion(point, route, None, contact),
            Route::Chain => {
                let mut all = self.follow_by_chain(&[point.to_vec()], contact);
                all.pop().unwrap_or_else(|| Err("no design".to_owned()))
            }
        }
    }

    /// Follows designs by the chain of closed forms, several side by side; those without one are
    /// integrated.
    pub(super) fn follow_by_chain(
        &self,
        points: &[Vec<f64>],
        contact: bool,
    ) -> Vec<Result<EvaluatedDesign, String>> {
        let motions: Vec<Option<(Model, Start)>> = match self.main_mass {
            Some(_) => vec![None; points.len()],
            None => points.iter().map(|point| self.motion_of(point)).collect(),
        };
        let begun: Vec<(Model, Start)> = motions.iter().flatten().copied().collect();
        let mut chains =
            simulate_each(&begun, Integrator::Chain, &self.settings_to_rest()).into_iter();
        let follow = |(point, motion): (&Vec<f64>, Option<(Model, Start)>)| {
            let chain = motion.and_then(|_| chains.next());
            self.follow_motion(point, Route::Chain, chain, contact)
        };
        points.iter().zip(motions).map(follow).collect()
    }

    /// The settings of a motion that is followed until it rests.
    fn settings_to_rest(&self) -> Settings {
        Settings { stop_at_rest: true, keep_path: false, ..self.settings }
    }

    /// Follows a design by integration, unless its chain is given.
    fn follow_motion(
        &self,
        point: &[f64],
        route: Route,
        chain: Option<Result<Simulation, SimulationError>>,
        contact: bool,
    ) -> Result<EvaluatedDesign, String> {
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
        let motion = DesignMotion { question: self, model, start, units, route, contact };
        let followed = match self.main_mass {
            Some(main_mass) => motion.on_main_mass(&main_mass)?,
            None => motion.on_fixed_pivot(chain).map_err(|error| error.to_string())?,
        };
        Ok(EvaluatedDesign {
            point: point.to_vec(),
            material,
            case,
            model,
            units,
            rest_time: followed.rest_time,
            impacts: followed.impacts,
            hardest: followed.hardest,
            primary_rest_time: followed.primary_rest_time,
            integrated: followed.integrated,
        })
    }

    /// The default design as a point of this space, inside the box or not; `None` if materials are
    /// tried.
    pub fn default_point(&self) -> Option<Vec<f64>> {
        let usual = Case::default();
        let value = |parameter: Parameter| usual.get(parameter);
        match self.materials.is_empty() {
            true => self.variables.iter().map(|variable| value(variable.parameter)).collect(),
            false => None,
        }
    }

    /// The equation and the start of a point of the box.
    pub fn motion_of(&self, point: &[f64]) -> Option<(Model, Start)> {
        self.case_of(point).0.motion().ok()
    }
}

/// The motion of a design that is to be followed.
struct DesignMotion<'a> {
    question: &'a OptimizationProblem,
    model: Model,
    start: Start,
    units: Units,
    route: Route,
    contact: bool,
}

/// The numbers of a motion that was followed.
struct SimulatedMotion {
    rest_time: Result<f64, NoRest>,
    impacts: usize,
    hardest: Option<HardestContact>,
    primary_rest_time: Option<Result<f64, NoRest>>,
    integrated: bool,
}

impl DesignMotion<'_> {
    /// The pendulum alone, by its chain if there is one.
    fn on_fixed_pivot(
        &self,
        chain: Option<Result<Simulation, SimulationError>>,
    ) -> Result<SimulatedMotion, SimulationError> {
        let settings = self.question.settings_to_rest();
        let by_chain = match chain {
            None | Some(Err(SimulationError::Chain(_))) => None,
            Some(found) => Some(MotionToRest::from(&found?)),
        };
        let integrated = by_chain.is_none();
        let (course, hardest) = match by_chain {
            Some(course) => {
                let hardest = self.contact.then(|| self.fastest_in_closed_form(&course));
                (course, hardest)
            }
            None => {
                let settings = Settings { keep_path: self.contact, ..settings };
                let motion = simulate(&self.model, self.start, Integrator::Taylor, &settings)?;
                let course = MotionToRest::from(&motion);
                let hardest = self.contact.then(|| self.hardest_of_motion(&motion, &course));
                (course, hardest)
            }
        };
        Ok(SimulatedMotion {
            rest_time: course.rest_time,
            impacts: course.impacts.len(),
            hardest: hardest.flatten(),
            primary_rest_time: None,
            integrated,
        })
    }

    /// Force and restitution of a contact in closed form: the swing's own forces are left out.
    fn in_closed_form(&self, contact: &ContactRecord) -> Option<(f64, f64, Option<f64>)> {
        let ratio = self.model.mu / self.model.gamma;
        let force = peak_force(1.5, self.model.gamma, ratio, contact.speed_in)?;
        Some((force, contact.penetration, restitution(ratio * contact.speed_in).ok()))
    }

    /// The contact that is touched fastest, in closed form.
    fn fastest_in_closed_form(&self, course: &MotionToRest) -> Option<HardestContact> {
        let faster =
            |one: &&ContactRecord, other: &&ContactRecord| one.speed_in.total_cmp(&other.speed_in);
        let fastest = course.impacts.iter().max_by(faster)?;
        let contacts = self.in_closed_form(fastest).into_iter();
        HardestContact::from_contacts(&self.model, &self.units, contacts)
    }

    /// The hardest contact of a motion that was integrated. For one too short for the clock the
    /// force is that of the closed form, because the forces of the swing are negligible then.
    fn hardest_of_motion(
        &self,
        motion: &Simulation,
        course: &MotionToRest,
    ) -> Option<HardestContact> {
        let contacts =
            course.impacts.iter().filter_map(|contact| match motion.peak_force(contact) {
                Some(force) => Some((force, contact.penetration, contact.restitution)),
                None => self
                    .in_closed_form(contact)
                    .map(|(force, depth, _)| (force, depth, contact.restitution)),
            });
        HardestContact::from_contacts(&self.model, &self.units, contacts)
    }

    /// The pendulum on the main mass that carries it, by its chain if there is one. It ends when the main mass rests, unless the rest of the pendulum is asked for too.
    fn on_main_mass(&self, main_mass: &MainMass) -> Result<SimulatedMotion, String> {
        let case = main_mass.carrying(&self.units, self.model, self.start);
        let settings = PrimarySettings {
            stop_at_rest: !(self.question.follows_pendulum()
                || self.route == Route::Integration && self.contact),
            chain: self.route == Route::Chain,
            ..PrimarySettings::from(&self.question.settings)
        };
        let motion = match simulate_primary(case, &settings) {
            Err(PrimaryError::Chain(_)) => {
                simulate_primary(case, &PrimarySettings { chain: false, ..settings })
            }
            found => found,
        };
        let motion = motion.map_err(|error| error.to_string())?;
        let rest = motion.pendulum_rest_time();
        let impacts = motion.impacts.iter();
        let impacts = impacts
            .filter(|impact| rest.is_err() || rest.is_ok_and(|rest| impact.entry_time < rest));
        let hardest = self.contact.then(|| {
            let contacts = impacts.clone().map(|impact| {
                (motion.peak_force(impact), impact.penetration, impact.restitution())
            });
            HardestContact::from_contacts(&self.model, &self.units, contacts)
        });
        Ok(SimulatedMotion {
            rest_time: rest,
            impacts: impacts.count(),
            hardest: hardest.flatten(),
            primary_rest_time: Some(motion.rest_time().map(|rest| rest * self.units.time())),
            integrated: !motion.by_chain,
        })
    }
}
