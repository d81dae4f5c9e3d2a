//! The optimisation problem: the box of designs, the constraints and the search.

use std::f64::consts::PI;

use thiserror::Error;

use super::design::{EvaluatedDesign, Route};
use super::objective::Objective;
use crate::decimal::{decimal, significant};
use crate::genetic::{Evaluation, GeneticOptions, SearchError, Space};
use crate::impact::primary::MainMass;
use crate::impact::{
    Case, ContactDamping, DEFAULT_DURATION, DEFAULT_ZETA, FIRST_YIELD, Material, Parameter,
    Settings, default_lambda,
};

/// The default box of a search: each parameter with its lower and upper limit, in SI units.
pub const DEFAULT_BOX: [(Parameter, f64, f64); 4] = [
    (Parameter::Mass, 0.010, 0.100),
    (Parameter::Radius, 0.001, 0.020),
    (Parameter::Length, 0.030, 0.300),
    (Parameter::Modulus, 0.1e9, 200e9),
];

/// A number of the design that is searched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Variable {
    /// The parameter.
    pub parameter: Parameter,
    /// Its lower limit.
    pub lower: f64,
    /// Its upper limit.
    pub upper: f64,
}

/// An upper limit of a quantity of the design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// The objective.
    pub objective: Objective,
    /// The largest value.
    pub at_most: f64,
}

/// A search for the best design: the question.
#[derive(Debug, Clone, PartialEq)]
pub struct OptimizationProblem {
    /// The values of all parameters that are not variables.
    pub case: Case,
    /// The variables of the search.
    pub variables: Vec<Variable>,
    /// The materials of the barrier that are tried, in place of its modulus; empty if that is
    /// searched or fixed.
    pub materials: Vec<Material>,
    /// The objectives to be minimised; several give a Pareto front.
    pub objectives: Vec<Objective>,
    /// The limits of other quantities.
    pub limits: Vec<Limit>,
    /// The density of the sphere, kg/m^3, if its mass follows from its radius.
    pub density: Option<f64>,
    /// Whether the bodies must not yield.
    pub elastic: bool,
    /// The yield limit of the sphere, Pa, where one is stated.
    pub sphere_yield: Option<f64>,
    /// The yield limit of the barrier, Pa, where one is stated and no materials are tried.
    pub barrier_yield: Option<f64>,
    /// The main mass that carries the pendulum, if its rest time is an objective or limited.
    pub main_mass: Option<MainMass>,
    /// Duration and accuracy of the motions.
    pub settings: Settings,
    /// The genetic algorithm.
    pub genetic: GeneticOptions,
    /// Number of runs.
    pub runs: usize,
    /// The seed of all random numbers.
    pub seed: u64,
    /// The dampings that were not given, for which the defaults are used.
    pub defaults: Vec<Parameter>,
}

impl Default for OptimizationProblem {
    /// The [`DEFAULT_BOX`], searched a hundred times for the least rest time in seconds, with the
    /// default dissipation.
    fn default() -> Self {
        let variable = |(parameter, lower, upper)| Variable { parameter, lower, upper };
        Self {
            case: Case {
                contact_damping: ContactDamping::Lambda(default_lambda()),
                zeta: DEFAULT_ZETA,
                ..Case::default()
            },
            variables: DEFAULT_BOX.map(variable).into(),
            materials: vec![],
            objectives: vec![Objective::RestTime],
            limits: vec![],
            density: None,
            elastic: false,
            sphere_yield: None,
            barrier_yield: None,
            main_mass: None,
            settings: Settings { duration: DEFAULT_DURATION, ..Settings::default() },
            genetic: GeneticOptions::default(),
            runs: 100,
            seed: 1,
            defaults: vec![Parameter::Lambda, Parameter::Zeta],
        }
    }
}

/// The reason why a search is not possible.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum OptimizeError {
    /// Limits that leave no design.
    #[error("[limits] {0}")]
    Limits(String),
    /// There is no objective.
    #[error("[genetic] objective names nothing that is to be small: choose one or more of {}", Objective::ALL.map(Objective::name).join(", "))]
    NoObjective,
    /// An objective named twice.
    #[error("[genetic] objective names `{0}` twice")]
    SameObjective(&'static str),
    /// There is no run.
    #[error("[genetic] runs = {0}: a study needs 1 run or more, {MOST_RUNS} at most")]
    Runs(usize),
    /// Options that are not admissible.
    #[error("[genetic] {0}")]
    Options(#[from] SearchError),
    /// An option for a single objective, although there are several.
    #[error(
        "[genetic] {0} belongs to a search for one objective; several at once are searched by NSGA-II: leave it out"
    )]
    OneObjective(&'static str),
    /// The design in the middle of the box is not admissible.
    #[error("{0}")]
    Motion(String),
    /// No design comes to rest.
    #[error(
        "no design in this box comes to rest in the time allowed, {duration} units of 1/omega: {reason}"
    )]
    NoRest {
        /// The duration of the motions.
        duration: f64,
        /// The reason at the design in the middle of the box.
        reason: String,
    },
    /// No design keeps the constraints.
    #[error(
        "no design was found in this box that comes to rest in the time allowed and keeps {constraints}: {nearest}"
    )]
    NoFeasible {
        /// The constraints in words.
        constraints: String,
        /// The result of a search for the constraints alone, in words.
        nearest: String,
        /// Whether that result keeps the constraints.
        exists: bool,
    },
    /// Records of another search.
    #[error("{0}")]
    Record(String),
    /// The search was stopped before a design was found.
    #[error("stopped before a design was found")]
    Stopped,
}

/// The most runs of a study.
const MOST_RUNS: usize = 100_000;

impl OptimizationProblem {
    /// The box; a material is a number from 0 to their count.
    ///
    /// # Errors
    /// [`OptimizeError::Limits`] if there is no variable, or a lower limit is not below the upper
    /// one.
    pub fn space(&self) -> Result<Space, OptimizeError> {
        let mut bounds: Vec<[f64; 2]> =
            self.variables.iter().map(|variable| [variable.lower, variable.upper]).collect();
        if self.materials.len() > 1 {
            bounds.push([0.0, self.materials.len() as f64]);
        }
        Space::new(bounds).map_err(|error| match error {
            SearchError::Inverted { number, lower, upper } if number <= self.variables.len() => {
                let name = self.variables[number - 1].parameter.name();
                OptimizeError::Limits(format!(
                    "{name} = [{lower}, {upper}] leaves nothing between: the lower limit comes first; to hold it fixed give it in [design]"
                ))
            }
            error => OptimizeError::Limits(format!(
                "{error}: give limits to one of {}",
                DEFAULT_BOX.map(|(parameter, ..)| parameter.name()).join(", ")
            )),
        })
    }

    /// Checks the problem and returns its box.
    ///
    /// # Errors
    /// [`OptimizeError`] names the key.
    pub fn check(&self) -> Result<Space, OptimizeError> {
        for variable in &self.variables {
            if !(variable.lower > 0.0 && variable.upper.is_finite()) {
                return Err(OptimizeError::Limits(format!(
                    "{} = [{}, {}] must be positive numbers",
                    variable.parameter.name(),
                    variable.lower,
                    variable.upper
                )));
            }
        }
        let space = self.space()?;
        for limit in &self.limits {
            if !(limit.at_most > 0.0 && limit.at_most.is_finite()) {
                return Err(OptimizeError::Limits(format!(
                    "max_{} must be a positive number, not {}",
                    limit.objective.name(),
                    limit.at_most
                )));
            }
        }
        if let Some(density) =
            self.density.filter(|density| !(*density > 0.0 && density.is_finite()))
        {
            return Err(OptimizeError::Limits(format!(
                "density must be a positive number, not {density}"
            )));
        }
        if self.objectives.is_empty() {
            return Err(OptimizeError::NoObjective);
        }
        for (index, objective) in self.objectives.iter().enumerate() {
            if self.objectives[..index].contains(objective) {
                return Err(OptimizeError::SameObjective(objective.name()));
            }
        }
        if !(1..=MOST_RUNS).contains(&self.runs) {
            return Err(OptimizeError::Runs(self.runs));
        }
        self.genetic.check()?;
        let middle: Vec<f64> = space.bounds().iter().map(|_| 0.5).collect();
        self.follow(&space.point_at(&middle), Route::Chain, false)
            .map_err(OptimizeError::Motion)?;
        Ok(space)
    }

    /// Whether the hardest contact is needed.
    pub(super) fn needs_contact(&self) -> bool {
        let limited = self.limits.iter().map(|limit| limit.objective);
        self.elastic || self.objectives.iter().copied().chain(limited).any(Objective::is_of_contact)
    }

    /// Whether the motion of the pendulum until it rests is needed.
    pub(super) fn follows_pendulum(&self) -> bool {
        let limited = self.limits.iter().map(|limit| limit.objective);
        let mut counting = self.objectives.iter().copied().chain(limited);
        counting.any(|objective| objective.is_rest_time() || objective == Objective::Impacts)
    }

    /// The reason for which a design has no value of an objective; `None` if it has all of them.
    pub(super) fn missing_value(&self, design: &EvaluatedDesign) -> Option<String> {
        let missing = self.objectives.iter().find(|objective| objective.value(design).is_none())?;
        let rest = match missing.is_of_main_mass() {
            true => design.primary_rest_time.unwrap_or(design.rest_time),
            false => design.rest_time,
        };
        Some(rest.err().map_or_else(
            || format!("{} has no finite value", missing.meaning()),
            |reason| reason.to_string(),
        ))
    }

    /// The constraints that a design breaks, in words: `max_impacts = 9 (10)`.
    pub fn broken(&self, design: &EvaluatedDesign) -> Vec<String> {
        let evaluation = self.evaluation(design);
        let words = self.constraints();
        let mut broken = Vec::new();
        for (index, limit) in self.limits.iter().enumerate() {
            if evaluation.inequalities.get(index).is_some_and(|excess| *excess > 0.0) {
                let value = limit.objective.value(design).map_or("no value".to_owned(), decimal);
                broken.push(format!("{} ({value})", words[index]));
            }
        }
        if let Some(off) = evaluation.equalities.first()
            && off.abs() > self.genetic.constraint_tolerance
        {
            let words = words.get(self.limits.len()).cloned().unwrap_or_default();
            broken.push(format!("{words} (m is {} times that)", significant(1.0 + off, 4)));
        }
        if let Some(excess) = evaluation.inequalities.get(self.limits.len())
            && *excess > 0.0
        {
            let words = words.last().cloned().unwrap_or_default();
            broken.push(format!("{words} ({} times that)", significant(1.0 + excess, 4)));
        }
        broken
    }

    /// The lowest stated yield limit of the bodies of a design, Pa.
    pub fn yield_limit(&self, design: &EvaluatedDesign) -> Option<f64> {
        let barrier = match design.material {
            Some(number) => self.materials.get(number)?.yield_limit,
            None => self.barrier_yield,
        };
        [self.sphere_yield, barrier].into_iter().flatten().reduce(f64::min)
    }

    /// Objectives and constraints of a design.
    pub fn evaluation(&self, design: &EvaluatedDesign) -> Evaluation {
        let value = |objective: Objective| objective.value(design).unwrap_or(f64::INFINITY);
        let mut inequalities: Vec<f64> = self
            .limits
            .iter()
            .map(|limit| (value(limit.objective) / limit.at_most - 1.0).min(LARGEST_EXCESS))
            .collect();
        if self.elastic
            && let Some(limit) = self.yield_limit(design)
        {
            inequalities.push(value(Objective::PeakPressure) / (FIRST_YIELD * limit) - 1.0);
        }
        let sphere = self.density.map(|density| {
            let volume = 4.0 / 3.0 * PI * design.case.design.radius.powi(3);
            design.case.design.mass / (density * volume) - 1.0
        });
        Evaluation {
            objectives: self.objectives.iter().copied().map(value).collect(),
            equalities: sphere.into_iter().collect(),
            inequalities,
        }
    }

    /// The constraints in words: `max_peak_force = 200`.
    pub fn constraints(&self) -> Vec<String> {
        let mut words: Vec<String> = self
            .limits
            .iter()
            .map(|limit| {
                format!(
                    "max_{} = {} {}",
                    limit.objective.name(),
                    limit.at_most,
                    limit.objective.unit()
                )
            })
            .map(|words| words.trim_end().to_owned())
            .collect();
        words.extend(
            self.density
                .map(|density| format!("density = {density} kg/m^3, m = density*(4/3)*pi*R^3")),
        );
        if self.elastic {
            words.push("elastic = true, pressure below 1.6 times the yield limit".to_owned());
        }
        words
    }
}

/// Upper bound of the violation of a constraint, because infinities could not be ordered.
pub(super) const LARGEST_EXCESS: f64 = 1e100;
