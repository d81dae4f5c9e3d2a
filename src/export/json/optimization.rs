//! Kind `optimization`: a search for the best damper; and its record, a line for each run, from
//! which it can be taken up again.
//!
//! The first line of a record says what was asked, every other one is a run. A line is written as a
//! whole when its run has ended, so that of a process that is killed at most the last line is
//! incomplete; it is left out where the record is read.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::number::{Map, finite, text};
use super::simulation::Barrier;
use super::{DocumentKind, JsonError};
use crate::genetic::{Coding, Crossover, GeneticStop, Mutation, Penalty, StallTest};
use crate::impact::primary::MainMass;
use crate::impact::{self, ContactDamping, Friction, Parameter, REST_FRACTION, SpeedUnit};
#[cfg(feature = "schema")]
use crate::optimize::VariableRole;
use crate::optimize::{self, Found, Objective, OptimizationProblem, SearchRun, Study, WITHIN};
use crate::report::optimization_sentences;

/// A search for the best damper. Angles are in radians, everything else in SI units, unless another
/// unit is given; units of time are 1/omega of small swings, sqrt(L/g).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct OptimizationDocument {
    /// The kind of document.
    pub schema: String,
    /// What was asked.
    pub asked: Asked,
    /// Whether all of it was done; false where it was stopped before the end.
    pub complete: bool,
    /// The runs, by their numbers.
    pub runs: Vec<Run>,
    /// The best values of the runs as the searches have them, and of other searches with as many
    /// evaluations; empty with several objectives.
    pub searches: Vec<Search>,
    /// The median over the runs of the best value after the random population and after every
    /// generation; null while half of them have none.
    pub median_curve: Vec<Option<f64>>,
    /// The best designs of the runs judged again by integration, the best first; with several
    /// objectives the front, by the first one.
    pub finalists: Vec<Finalist>,
    /// The paper's Table 5 under the same assumptions, by integration; null where materials are
    /// tried.
    pub papers_design: Option<Design>,
    /// What decides the best design; null with several objectives.
    pub decision: Option<Decision>,
    /// What the numbers say, in words.
    pub conclusions: Vec<String>,
}

/// What was asked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Asked {
    /// What is to be small, by its key in a file.
    #[cfg_attr(feature = "schema", schemars(extend("items" = {"enum": Objective::ALL.map(Objective::name)})))]
    pub objectives: Vec<String>,
    /// What varies, in the order in which points have it.
    pub variables: Vec<SearchVariable>,
    /// The materials that are tried; a point has their number from 0 up, its fraction is left out,
    /// behind the variables where there are two or more.
    pub materials: Vec<SearchMaterial>,
    /// What must not be larger.
    pub limits: Vec<SearchLimit>,
    /// The density of the sphere, in kg/m^3, where its mass is that of its radius; null where it is
    /// not.
    pub density: Option<f64>,
    /// Whether the bodies must not yield.
    pub elastic: bool,
    /// The yield limit of the sphere, in Pa; null where none is stated.
    pub sphere_yield: Option<f64>,
    /// That of the barrier, in Pa; null likewise.
    pub barrier_yield: Option<f64>,
    /// The main mass that carries the pendulum; null where its rest does not count.
    pub main_mass: Option<MainMassDocument>,
    /// What is held fixed.
    pub held_fixed: SearchHeldFixed,
    /// The dampings that nobody gave, by their keys in a file: their numbers are not the paper's,
    /// which prints none.
    pub defaults: Vec<String>,
    /// How long motions are followed, in units of time.
    pub duration: f64,
    /// The part of the first amplitude at which the pendulum rests.
    pub rest_fraction: f64,
    /// The relative tolerance of one step of the integrator.
    pub step_tolerance: f64,
    /// The most steps of an integration.
    pub step_limit: usize,
    /// How it is searched.
    pub genetic: Genetic,
    /// Runs.
    pub runs: usize,
    /// The seed; run i has its i-th stream of random numbers.
    pub seed: u64,
}

/// A number of the design that varies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct SearchVariable {
    /// Its key in a file.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Its lower limit, in that unit.
    pub lower: f64,
    /// Its upper limit, in that unit.
    pub upper: f64,
}

/// A material that is tried.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct SearchMaterial {
    /// Its name.
    pub name: String,
    /// The modulus of its contact, in Pa.
    pub modulus: f64,
    /// Its yield limit, in Pa; null where none is stated.
    pub yield_limit: Option<f64>,
    /// Its own damping; null where it has none.
    pub damping: Option<ContactForm>,
}

/// A damping of the contact in the form in which it is given.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct ContactForm {
    /// The form, by its key in a file.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = ContactDamping::FORMS.map(Parameter::name))))]
    pub form: String,
    /// Its number, in the unit of that key.
    pub value: f64,
    /// The speed at which a restitution is stated, in `speed_unit`; null where none is.
    pub at_speed: Option<f64>,
    /// The unit of that speed: `m/s`, or `rad*omega`, radians per unit of time. Left out where none
    /// is stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_unit: Option<String>,
}

/// What must not be larger.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct SearchLimit {
    /// What, by its name as an objective.
    pub objective: String,
    /// The largest value, in `unit`.
    pub at_most: f64,
    /// The unit; empty where it has none.
    pub unit: String,
}

/// What is held fixed; null where it varies or is not given.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct SearchHeldFixed {
    /// The release from rest, in radians.
    pub amplitude: f64,
    /// The displacement at t = 0, in radians, where it is not that.
    pub start: Option<f64>,
    /// The velocity at t = 0, in radians per unit of time.
    pub speed: f64,
    /// Where the barriers stand.
    pub barrier: Barrier,
    /// The damping of the contact; null where every material has its own.
    pub contact: Option<ContactForm>,
    /// The viscous damping ratio, dimensionless; null where `viscous` is given.
    pub zeta: Option<f64>,
    /// The coefficient of the viscous force on the bob, in N s/m; null where zeta is given.
    pub viscous: Option<f64>,
    /// The Coulomb friction, dimensionless; null where `torque` is given.
    pub alpha: Option<f64>,
    /// Its torque, in N m; null where alpha is given.
    pub torque: Option<f64>,
    /// The law of that friction.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = ["exact", "arctangent"])))]
    pub friction: String,
    /// The mass, in kg.
    pub mass: Option<f64>,
    /// The radius of the sphere, in m.
    pub radius: Option<f64>,
    /// The length, in m.
    pub length: Option<f64>,
    /// The modulus of the barrier, in Pa.
    pub modulus: Option<f64>,
    /// The acceleration of gravity, in m/s^2.
    pub gravity: f64,
}

/// The genetic algorithm; with several objectives NSGA-II, which has only population, generations
/// and budget of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Genetic {
    /// Individuals.
    pub population: usize,
    /// The best ones, which go on as they are.
    pub elite: usize,
    /// The part of the others that crossover makes.
    pub crossover_fraction: f64,
    /// How genes are written.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = ["real", "bits"])))]
    pub coding: String,
    /// Bits of a number; null where genes are numbers.
    pub bits: Option<u32>,
    /// How two parents make a child.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = ["heuristic", "scattered", "one-point"])))]
    pub crossover: String,
    /// How far beyond the better parent, in parts of the way to it; null for other crossovers.
    pub crossover_ratio: Option<f64>,
    /// How one parent makes a child.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = ["adaptive-feasible", "bit-flip"])))]
    pub mutation: String,
    /// The probability of a bit to be turned over; null for the other mutation.
    pub mutation_rate: Option<f64>,
    /// What a broken constraint costs.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = ["death", "feasible-first", "augmented-lagrangian"])))]
    pub penalty: String,
    /// The weight that an augmented Lagrangian begins with; null for other penalties.
    pub initial_penalty: Option<f64>,
    /// What it is multiplied by; null for other penalties.
    pub penalty_factor: Option<f64>,
    /// How far the mass may be from that of the density, in parts.
    pub constraint_tolerance: f64,
    /// The most generations after the random population.
    pub generations: usize,
    /// Over so many generations the best value is watched.
    pub stall_generations: usize,
    /// Below this change of it a run ends.
    pub function_tolerance: f64,
    /// How that is measured.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = ["average", "weighted"])))]
    pub stall_test: String,
    /// The most evaluations of one run; null where there is no such limit.
    pub budget: Option<usize>,
}

/// A run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "SearchRun"))]
#[serde(deny_unknown_fields)]
pub struct Run {
    /// Its number, from 0.
    pub number: usize,
    /// The best design, or the front; empty where no design rests and keeps the constraints.
    pub found: Vec<Found>,
    /// The best value after the random population and after every generation, null while there is
    /// none; with several objectives the size of the front.
    pub curve: Vec<Option<f64>>,
    /// Generations after the random population.
    pub generations: usize,
    /// Designs that were followed.
    pub evaluations: usize,
    /// Those that were integrated: they have no closed form, or would be the best if they keep the
    /// constraints.
    pub integrated: usize,
    /// Why it ended.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = GeneticStop::ALL.map(GeneticStop::name))))]
    pub stop: String,
}

/// The best values of the runs of one search.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Search {
    /// Which: the genetic algorithm first.
    pub name: String,
    /// Evaluations of one run, on the average.
    pub evaluations: f64,
    /// How many runs found a design that rests and keeps the constraints.
    pub found: usize,
    /// The least value, in the unit of the objective; null where no run found one.
    pub best: Option<f64>,
    /// A quarter of the runs is no worse; null likewise.
    pub lower_quartile: Option<f64>,
    /// Half of them; null likewise.
    pub median: Option<f64>,
    /// Three quarters; null likewise.
    pub upper_quartile: Option<f64>,
    /// The greatest value; null likewise.
    pub worst: Option<f64>,
}

/// A design that was judged again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Finalist {
    /// The number of the run that found it.
    pub run: usize,
    /// Its objectives by closed forms, where it has them; else by integration.
    pub by_closed_forms: Vec<f64>,
    /// The same by integration; null where it does not rest.
    pub values: Vec<Option<f64>>,
    /// Whether by integration it rests and keeps the constraints.
    pub feasible: bool,
    /// The design by integration.
    pub design: Design,
}

/// A design that was followed until it rests.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Design {
    /// The values of the variables by their names.
    pub variables: Map<f64>,
    /// Its material; null where none are tried.
    pub material: Option<String>,
    /// The rest time, in units of time; null where it does not rest.
    pub rest_time: Option<f64>,
    /// The same in seconds; null likewise.
    pub rest_time_in_seconds: Option<f64>,
    /// Why it does not rest, in words; null where it does.
    pub rest_reason: Option<String>,
    /// The contacts until rest.
    pub impacts: usize,
    /// The greatest force of a contact, in N; null where there is none.
    pub peak_force: Option<f64>,
    /// The greatest pressure of Hertz, in Pa; null where there is none.
    pub peak_pressure: Option<f64>,
    /// The coefficient of restitution of the contact with the greatest force, dimensionless; null
    /// where there is none.
    pub restitution: Option<f64>,
    /// The rest time of the main mass, in seconds; null where it never rests, or none counts.
    pub primary_rest_time: Option<f64>,
    /// The stiffness of the contact by equation (8), dimensionless.
    pub gamma: f64,
    /// mu/gamma, dimensionless.
    pub mu_over_gamma: f64,
}

/// A main mass on spring and dashpot that carries the pendulum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "MainMass"))]
pub struct MainMassDocument {
    /// Its mass without the pendulum, in kg.
    pub mass: f64,
    /// The stiffness of its spring, in N/m.
    pub stiffness: f64,
    /// The coefficient of its dashpot, in N s/m.
    pub damping: f64,
    /// Where it begins, in m.
    pub displacement: f64,
    /// How fast it begins, in m/s.
    pub speed: f64,
}

impl From<MainMass> for MainMassDocument {
    fn from(main_mass: MainMass) -> Self {
        let MainMass { mass, stiffness, damping, displacement, speed, .. } = main_mass;
        Self { mass, stiffness, damping, displacement, speed }
    }
}

/// What decides the best design.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Decision {
    /// The variables, each moved alone.
    pub sensitivities: Vec<Sensitivity>,
    /// A design this much worse, in parts, counts as good.
    pub within: f64,
    /// The part of the box that is as good.
    pub share: f64,
    /// Least and greatest value of every variable, and of the number of the material, among the
    /// designs that are as good.
    pub extents: Vec<[f64; 2]>,
    /// Constraints with no more than 1 % to spare, in words.
    pub active: Vec<String>,
    /// The rest times with the length at its limits, in both units; null where the length does not
    /// vary or no rest time is the objective.
    pub unit: Option<optimize::Ends>,
    /// The objective with each material, the rest as it is best; null where it does not rest.
    pub materials: Vec<Option<f64>>,
}

/// A variable moved alone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Sensitivity {
    /// Its key in a file.
    pub name: String,
    /// Its value in the best design.
    pub value: f64,
    /// The change of the objective in parts for one part of the variable, by integration; null
    /// where it has no value on one side.
    pub elasticity: Option<f64>,
    /// Between these values the objective is no more than 1 % worse.
    pub alone: [f64; 2],
    /// Least and greatest objective over the whole range, constraints aside; null where it does not
    /// rest somewhere.
    pub range: Option<[f64; 2]>,
    /// What follows: every value is as good, a limit decides, a constraint does, or something is
    /// lost on either side.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = VariableRole::ALL.map(VariableRole::name))))]
    pub role: String,
}

/// The document of kind `optimization`.
///
/// ```
/// use lindstedt::optimize::{OptimizationProblem, StudyObserver, optimize};
///
/// let study = optimize(OptimizationProblem { runs: 1, ..OptimizationProblem::default() }, vec![], &StudyObserver::default())?;
/// let document = lindstedt::export::json::optimization(&study);
/// assert_eq!(document.asked.variables[2].name, "length");
/// # Ok::<(), lindstedt::optimize::OptimizeError>(())
/// ```
pub fn optimization(study: &Study) -> OptimizationDocument {
    OptimizationDocument {
        schema: DocumentKind::Optimization.schema().to_owned(),
        asked: Asked::from_problem(&study.question),
        complete: study.complete,
        runs: study.runs.iter().map(Run::from_run).collect(),
        searches: searches(study),
        median_curve: match study.question.objectives.len() {
            1 => study.median_curve().into_iter().map(|value| finite(Some(value))).collect(),
            _ => vec![],
        },
        finalists: study
            .finalists
            .iter()
            .map(|finalist| Finalist {
                run: finalist.run,
                by_closed_forms: finalist.by_chain.clone(),
                values: finalist.values.iter().map(|value| finite(Some(*value))).collect(),
                feasible: finalist.feasible,
                design: design(study, &finalist.design),
            })
            .collect(),
        papers_design: study.default_design.as_ref().map(|papers| design(study, papers)),
        decision: study.decision.as_ref().map(decision),
        conclusions: optimization_sentences(study),
    }
}

fn searches(study: &Study) -> Vec<Search> {
    if study.question.objectives.len() > 1 {
        return vec![];
    }
    let search = |name: &str,
                  evaluations: f64,
                  found: usize,
                  spread: Option<optimize::FiveNumberSummary>| Search {
        name: name.to_owned(),
        evaluations,
        found,
        best: spread.map(|spread| spread.best),
        lower_quartile: spread.map(|spread| spread.lower_quartile),
        median: spread.map(|spread| spread.median),
        upper_quartile: spread.map(|spread| spread.upper_quartile),
        worst: spread.map(|spread| spread.worst),
    };
    let (evaluations, _) = study.evaluations();
    let each = evaluations as f64 / study.runs.len().max(1) as f64;
    let own = search("genetic algorithm", each, study.values().len(), study.spread());
    let rivals = study.rivals.iter().map(|rival| {
        let found = rival.values.iter().filter(|value| value.is_finite()).count();
        search(rival.name, rival.evaluations as f64, found, rival.spread())
    });
    std::iter::once(own).chain(rivals).collect()
}

fn design(study: &Study, design: &optimize::EvaluatedDesign) -> Design {
    let variables = study.question.variables.iter().zip(&design.point);
    let material = design.material.and_then(|number| study.question.materials.get(number));
    Design {
        variables: variables
            .map(|(variable, value)| (variable.parameter.name().to_owned(), *value))
            .collect(),
        material: material.map(|material| material.name.clone()),
        rest_time: design.rest_time.ok(),
        rest_time_in_seconds: Objective::RestTime.value(design),
        rest_reason: text(design.rest_time.err()),
        impacts: design.impacts,
        peak_force: design.hardest.map(|contact| contact.force),
        peak_pressure: design.hardest.map(|contact| contact.pressure),
        restitution: design.hardest.and_then(|contact| contact.restitution),
        primary_rest_time: Objective::PrimaryRestTime.value(design),
        gamma: design.model.gamma,
        mu_over_gamma: design.model.mu / design.model.gamma,
    }
}

fn decision(decision: &optimize::Decision) -> Decision {
    Decision {
        sensitivities: decision
            .sensitivities
            .iter()
            .map(|of| Sensitivity {
                name: of.parameter.name().to_owned(),
                value: of.value,
                elasticity: of.elasticity,
                alone: of.alone,
                range: of.range,
                role: of.role.name().to_owned(),
            })
            .collect(),
        within: WITHIN,
        share: decision.share,
        extents: decision.extents.clone(),
        active: decision.active.clone(),
        unit: decision.ends,
        materials: decision.materials.clone(),
    }
}

impl Asked {
    /// The request of an optimisation problem.
    pub fn from_problem(question: &OptimizationProblem) -> Self {
        Self {
            objectives: question
                .objectives
                .iter()
                .map(|objective| objective.name().to_owned())
                .collect(),
            variables: question
                .variables
                .iter()
                .map(|variable| SearchVariable {
                    name: variable.parameter.name().to_owned(),
                    unit: variable.parameter.unit().to_owned(),
                    lower: variable.lower,
                    upper: variable.upper,
                })
                .collect(),
            materials: question
                .materials
                .iter()
                .map(|material| SearchMaterial::from_material(material, question.case.speed_unit))
                .collect(),
            limits: question
                .limits
                .iter()
                .map(|limit| SearchLimit {
                    objective: limit.objective.name().to_owned(),
                    at_most: limit.at_most,
                    unit: limit.objective.unit().to_owned(),
                })
                .collect(),
            density: question.density,
            elastic: question.elastic,
            sphere_yield: question.sphere_yield,
            barrier_yield: question.barrier_yield,
            main_mass: question.main_mass.map(MainMassDocument::from),
            held_fixed: SearchHeldFixed::from_problem(question),
            defaults: question.defaults.iter().map(|key| key.name().to_owned()).collect(),
            duration: question.settings.duration,
            rest_fraction: REST_FRACTION,
            step_tolerance: question.settings.relative_tolerance,
            step_limit: question.settings.maximum_steps,
            genetic: Genetic::from_problem(question),
            runs: question.runs,
            seed: question.seed,
        }
    }
}

impl ContactForm {
    fn new(damping: ContactDamping, at_speed: Option<f64>, unit: SpeedUnit) -> Self {
        Self {
            form: damping.form().name().to_owned(),
            value: damping.value(),
            at_speed,
            speed_unit: at_speed.map(|_| unit.name().to_owned()),
        }
    }
}

impl SearchMaterial {
    fn from_material(material: &impact::Material, unit: SpeedUnit) -> Self {
        let damping = material.damping;
        Self {
            name: material.name.clone(),
            modulus: material.modulus.value(),
            yield_limit: material.yield_limit,
            damping: damping.map(|damping| ContactForm::new(damping, material.at_speed, unit)),
        }
    }
}

impl SearchHeldFixed {
    fn from_problem(question: &OptimizationProblem) -> Self {
        let case = &question.case;
        let fixed = |parameter: Parameter| {
            let mut variables = question.variables.iter();
            let varies = variables.any(|variable| variable.parameter == parameter);
            let of_material = parameter == Parameter::Modulus && !question.materials.is_empty();
            case.get(parameter).filter(|_| !varies && !of_material)
        };
        Self {
            amplitude: case.amplitude,
            start: case.start,
            speed: case.speed,
            barrier: Barrier { left: case.left, right: case.right },
            contact: question
                .holds_contact_damping()
                .then(|| ContactForm::new(case.contact_damping, case.at_speed, case.speed_unit)),
            zeta: case.get(Parameter::Zeta),
            viscous: case.viscous,
            alpha: case.get(Parameter::Alpha),
            torque: case.torque,
            friction: match case.friction {
                Friction::Exact => "exact".to_owned(),
                Friction::Arctangent => "arctangent".to_owned(),
            },
            mass: fixed(Parameter::Mass),
            radius: fixed(Parameter::Radius),
            length: fixed(Parameter::Length),
            modulus: fixed(Parameter::Modulus),
            gravity: case.design.gravity,
        }
    }
}

impl Genetic {
    fn from_problem(question: &OptimizationProblem) -> Self {
        let options = &question.genetic;
        let (coding, bits) = match options.coding {
            Coding::Real => ("real", None),
            Coding::Bits(bits) => ("bits", Some(bits)),
        };
        let (crossover, ratio) = match options.crossover {
            Crossover::Heuristic(ratio) => ("heuristic", Some(ratio)),
            Crossover::Scattered => ("scattered", None),
            Crossover::OnePoint => ("one-point", None),
        };
        let (mutation, rate) = match options.mutation {
            Mutation::AdaptiveFeasible => ("adaptive-feasible", None),
            Mutation::BitFlips(rate) => ("bit-flip", Some(rate)),
        };
        let (penalty, weights) = match options.penalty {
            Penalty::Death => ("death", None),
            Penalty::FeasibleFirst => ("feasible-first", None),
            Penalty::AugmentedLagrangian { initial, factor } => {
                ("augmented-lagrangian", Some((initial, factor)))
            }
        };
        Self {
            population: options.population,
            elite: options.elite,
            crossover_fraction: options.crossover_fraction,
            coding: coding.to_owned(),
            bits,
            crossover: crossover.to_owned(),
            crossover_ratio: ratio,
            mutation: mutation.to_owned(),
            mutation_rate: rate,
            penalty: penalty.to_owned(),
            initial_penalty: weights.map(|weights| weights.0),
            penalty_factor: weights.map(|weights| weights.1),
            constraint_tolerance: options.constraint_tolerance,
            generations: options.generations,
            stall_generations: options.stall_generations,
            function_tolerance: options.function_tolerance,
            stall_test: match options.stall_test {
                StallTest::Average => "average".to_owned(),
                StallTest::Weighted => "weighted".to_owned(),
            },
            budget: options.budget,
        }
    }
}

impl Run {
    /// The document of a run.
    pub fn from_run(run: &SearchRun) -> Self {
        Self {
            number: run.number,
            found: run.found.clone(),
            curve: run.curve.iter().map(|value| finite(Some(*value))).collect(),
            generations: run.generations,
            evaluations: run.evaluations,
            integrated: run.integrated,
            stop: run.stop.name().to_owned(),
        }
    }

    /// The run again; `None` if it ended for an unknown reason.
    pub fn read(self) -> Option<SearchRun> {
        Some(SearchRun {
            number: self.number,
            found: self.found,
            curve: self.curve.into_iter().map(|value| value.unwrap_or(f64::INFINITY)).collect(),
            generations: self.generations,
            evaluations: self.evaluations,
            integrated: self.integrated,
            stop: GeneticStop::from_name(&self.stop)?,
        })
    }
}

/// The name of a record under `schema`.
const RECORD: &str = "lindstedt/optimization-record/1";

/// The first line of a record: what was asked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Head {
    schema: String,
    asked: Value,
}

/// The first line of the record of a search, with its line end.
///
/// # Errors
/// The errors of the writer.
pub fn record_head(question: &OptimizationProblem) -> Result<String, JsonError> {
    let head = Head { schema: RECORD.to_owned(), asked: request_value(question)? };
    line(&head)
}

/// The line of a run, with its line end.
///
/// # Errors
/// The errors of the writer.
pub fn record_line(run: &SearchRun) -> Result<String, JsonError> {
    line(&Run::from_run(run))
}

fn unwritable(error: serde_json::Error) -> JsonError {
    JsonError(format!("it cannot be written: {error}"))
}

fn no_record() -> JsonError {
    JsonError(
        "it is no record of `lindstedt optimize`: its first line says what was asked".to_owned(),
    )
}

fn line(of: &impl Serialize) -> Result<String, JsonError> {
    let text = serde_json::to_string(of).map_err(unwritable)?;
    Ok(text + "\n")
}

fn request_value(question: &OptimizationProblem) -> Result<Value, JsonError> {
    serde_json::to_value(Asked::from_problem(question)).map_err(unwritable)
}

/// The runs of a record of the same search, and how many bytes of it are whole lines.
///
/// # Errors
/// [`JsonError`]: a text that is no record, or that of another search.
///
/// ```
/// use lindstedt::export::json::optimization::{read_record, record_head, record_line};
/// use lindstedt::optimize::{OptimizationProblem, StudyObserver, optimize};
///
/// let question = OptimizationProblem { runs: 2, ..OptimizationProblem::default() };
/// let study = optimize(question.clone(), vec![], &StudyObserver::default())?;
/// let text = record_head(&question)? + &record_line(&study.runs[1])? + "{\"number\": 0, \"fou";
/// let (runs, whole) = read_record(&text, &question)?;
/// assert_eq!((&runs[..], whole), (&study.runs[1..], text.len() - 18));
/// assert_eq!(optimize(question, runs, &StudyObserver::default())?, study);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_record(
    text: &str,
    question: &OptimizationProblem,
) -> Result<(Vec<SearchRun>, usize), JsonError> {
    let whole = text.rfind('\n').map_or(0, |place| place + 1);
    let mut lines = text[..whole].lines();
    let first = lines.next().ok_or_else(no_record)?;
    let head: Head = serde_json::from_str(first).map_err(|_| no_record())?;
    if head.schema != RECORD {
        return Err(no_record());
    }
    if let Some(key) = difference(&head.asked, &request_value(question)?) {
        return Err(JsonError(format!(
            "it is the record of another search: `{key}` differs; only `runs` may"
        )));
    }
    let mut runs: Vec<SearchRun> = Vec::new();
    let length = question.variables.len() + usize::from(question.materials.len() > 1);
    for (index, line) in lines.enumerate() {
        let wrong = || JsonError(format!("line {} is no run of this search", index + 2));
        let run: Run = serde_json::from_str(line).map_err(|_| wrong())?;
        let run = run.read().ok_or_else(wrong)?;
        let fits = |found: &optimize::Found| {
            found.point.len() == length && found.values.len() == question.objectives.len()
        };
        if !run.found.iter().all(fits) || run.curve.is_empty() {
            return Err(wrong());
        }
        if runs.iter().all(|known| known.number != run.number) {
            runs.push(run);
        }
    }
    Ok((runs, whole))
}

/// The first key, `genetic.population`, in which two questions differ.
fn difference(one: &Value, other: &Value) -> Option<String> {
    let (Value::Object(one), Value::Object(other)) = (one, other) else {
        return (one != other).then(String::new);
    };
    let keys = other.keys().chain(one.keys()).filter(|key| *key != "runs");
    for key in keys {
        let (Some(one), Some(other)) = (one.get(key), other.get(key)) else {
            return Some(key.clone());
        };
        if let Some(inner) = difference(one, other) {
            return Some(format!("{key}.{inner}").trim_end_matches('.').to_owned());
        }
    }
    None
}
