//! One design: its motion until it rests, and the numbers that a search needs.
//!
//! The motion is the chain of closed forms, a few microseconds; if it has none, as for a heavily
//! damped swing, it is integrated. A pendulum that a main mass carries is followed together with
//! it, likewise, in a millisecond or two.

use super::question::OptimizationProblem;
use crate::impact::contact::hunt_crossley::{peak_force, restitution};
use crate::impact::primary::{MainMass, PrimaryError, PrimarySettings, simulate_primary};
use crate::impact::{
    Case, ContactRecord, Integrator, Model, NoRest, Parameter, Settings, Simulation,
    SimulationError, Start, Units, hertz, impacts_until, simulate, simulate_each,
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
            Route::Integration => self.design_motion(point, route, contact)?.followed(None),
            Route::Chain => {
                let mut all = self.follow_by_chain(&[point.to_vec()], contact, |design| design);
                all.pop().unwrap_or_else(|| Err("no design".to_owned()))
            }
        }
    }

    /// Follows designs by the chain of closed forms, several side by side; those without one are
    /// integrated. `keep` takes what is wanted of each as it ends, so that no more
    /// motions are in memory than are followed at once.
    pub(super) fn follow_by_chain<T>(
        &self,
        points: &[Vec<f64>],
        contact: bool,
        keep: impl Fn(Result<EvaluatedDesign, String>) -> T,
    ) -> Vec<T> {
        let prepared: Vec<Result<DesignMotion, String>> =
            points.iter().map(|point| self.design_motion(point, Route::Chain, contact)).collect();
        let mut kept: Vec<Option<T>> = points.iter().map(|_| None).collect();
        let (mut numbers, mut begun) = (vec![], vec![]);
        for (number, motion) in prepared.iter().enumerate() {
            match motion {
                Ok(motion) if self.main_mass.is_none() => {
                    numbers.push(number);
                    begun.push((motion.model, motion.start));
                }
                Ok(motion) => kept[number] = Some(keep(motion.followed(None))),
                Err(error) => kept[number] = Some(keep(Err(error.clone()))),
            }
        }
        let settings = self.settings_to_rest();
        simulate_each(&begun, Integrator::Chain, &settings, &mut |index, chain| {
            let number = numbers[index];
            if let Ok(motion) = &prepared[number] {
                kept[number] = Some(keep(motion.followed(Some(chain))));
            }
        });
        kept.into_iter().flatten().collect()
    }

    /// The settings of a motion that is followed until it rests.
    fn settings_to_rest(&self) -> Settings {
        Settings { stop_at_rest: true, keep_path: false, ..self.settings }
    }

    /// The motion of a design.
    ///
    /// # Errors
    /// [`Case::motion`] in words.
    fn design_motion<'a>(
        &'a self,
        point: &'a [f64],
        route: Route,
        contact: bool,
    ) -> Result<DesignMotion<'a>, String> {
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
        Ok(DesignMotion {
            question: self,
            point,
            material,
            case,
            model,
            start,
            units,
            route,
            contact,
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
    point: &'a [f64],
    material: Option<usize>,
    case: Case,
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
    /// Follows the design by integration, unless its chain is given.
    ///
    /// # Errors
    /// As [`simulate`](crate::impact::simulate()), in words.
    fn followed(
        &self,
        chain: Option<Result<Simulation, SimulationError>>,
    ) -> Result<EvaluatedDesign, String> {
        let followed = match self.question.main_mass {
            Some(main_mass) => self.on_main_mass(&main_mass)?,
            None => self.on_fixed_pivot(chain).map_err(|error| error.to_string())?,
        };
        Ok(EvaluatedDesign {
            point: self.point.to_vec(),
            material: self.material,
            case: self.case,
            model: self.model,
            units: self.units,
            rest_time: followed.rest_time,
            impacts: followed.impacts,
            hardest: followed.hardest,
            primary_rest_time: followed.primary_rest_time,
            integrated: followed.integrated,
        })
    }

    /// The pendulum alone, by its chain if there is one.
    fn on_fixed_pivot(
        &self,
        chain: Option<Result<Simulation, SimulationError>>,
    ) -> Result<SimulatedMotion, SimulationError> {
        let by_chain = match chain {
            None | Some(Err(SimulationError::Chain(_))) => None,
            Some(found) => Some(found?),
        };
        let integrated = by_chain.is_none();
        let motion = match by_chain {
            Some(motion) => motion,
            None => {
                let settings =
                    Settings { keep_path: self.contact, ..self.question.settings_to_rest() };
                simulate(&self.model, self.start, Integrator::Taylor, &settings)?
            }
        };
        let rest_time = motion.rest().time;
        let until_rest = || impacts_until(&motion.impacts, rest_time);
        let hardest = self.contact.then(|| match integrated {
            false => self.fastest_in_closed_form(until_rest()),
            true => self.hardest_of_motion(&motion, until_rest()),
        });
        Ok(SimulatedMotion {
            rest_time,
            impacts: until_rest().count(),
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
    fn fastest_in_closed_form<'a>(
        &self,
        impacts: impl Iterator<Item = &'a ContactRecord>,
    ) -> Option<HardestContact> {
        let faster =
            |one: &&ContactRecord, other: &&ContactRecord| one.speed_in.total_cmp(&other.speed_in);
        let fastest = impacts.max_by(faster)?;
        let contacts = self.in_closed_form(fastest).into_iter();
        HardestContact::from_contacts(&self.model, &self.units, contacts)
    }

    /// The hardest contact of a motion that was integrated. For one too short for the clock the
    /// force is that of the closed form, because the forces of the swing are negligible then.
    fn hardest_of_motion<'a>(
        &self,
        motion: &Simulation,
        impacts: impl Iterator<Item = &'a ContactRecord>,
    ) -> Option<HardestContact> {
        let contacts = impacts.filter_map(|contact| match motion.peak_force(contact) {
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
