//! The input of `optimize` from a problem file: a pendulum and its damping, `[limits]`,
//! `[genetic]`, and `[[material]]` to choose from.
//!
//! In: a [`Problem`]. Out: an [`OptimizationProblem`]. A quantity of the paper's Table 4 varies
//! between its limits there unless `[limits]` has others; given in `[design]`, or by its own name,
//! it is fixed. With `[[material]]` a material takes the place of the modulus.

use super::simulate::refuse_two_forms;
use super::{Objectives, Problem, ProblemError, ReadingCommand, refused};
use crate::genetic::{Coding, Crossover, GeneticOptions, Mutation, Penalty, StallTest};
use crate::impact::{ContactDamping, DEFAULT_DURATION, DEFAULT_ZETA, Parameter, default_lambda};
use crate::optimize::{
    DEFAULT_BOX, Limit, Objective, OptimizationProblem, OptimizeError, Variable,
};
use crate::spelling::nearest;

/// The keys that fix a variable: in `[design]`, or by its own name.
fn fixing(parameter: Parameter) -> [&'static str; 2] {
    match parameter {
        Parameter::Mass => ["[design] mass", "[pendulum] mass"],
        Parameter::Radius => ["[design] radius", "[sphere] radius"],
        Parameter::Length => ["[design] length", "[pendulum] length"],
        _ => ["[design] modulus", "[barrier] modulus"],
    }
}

/// The value of a name in a list of choices.
fn named<T: Clone>(
    key: &'static str,
    given: Option<&String>,
    usual: T,
    known: &[(&'static str, T)],
) -> Result<T, ProblemError> {
    let Some(name) = given else {
        return Ok(usual);
    };
    let found = known.iter().find(|(known, _)| known == name);
    found.map(|(_, value)| value.clone()).ok_or_else(|| {
        let known: Vec<&str> = known.iter().map(|(name, _)| *name).collect();
        let choice = known.join(", ");
        ProblemError::new(format!(
            "[genetic] {key} = \"{name}\" is unknown: choose one of {choice}"
        ))
        .with_help(nearest(name, known).map(|name| format!("did you mean \"{name}\"?")))
    })
}

impl Problem {
    /// The search of this file; an empty file gives the paper's.
    ///
    /// # Errors
    /// [`ProblemError`] names the key. The options are checked by [`OptimizationProblem::check`].
    ///
    /// ```
    /// use lindstedt::problem::Problem;
    ///
    /// let file: Problem = "[limits]\nlength = [0.1, 0.2]\n[design]\nmass = 0.05".parse()?;
    /// let asked = file.optimize()?;
    /// assert_eq!(asked.variables.len(), 3); // radius, length, modulus
    /// assert_eq!((asked.variables[1].lower, asked.case.design.mass), (0.1, 0.05));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn optimize(&self) -> Result<OptimizationProblem, ProblemError> {
        self.check_keys(ReadingCommand::Optimize)?;
        let gives = |parameter| self.gives_parameter(parameter);
        refuse_two_forms(gives)?;
        self.check_pairs(gives)?;
        let mut question = OptimizationProblem {
            case: self.for_design().case()?,
            ..OptimizationProblem::default()
        };
        let case = &mut question.case;
        if case.left.is_none() && case.right.is_none() {
            return refused(
                "a search for the best damper needs a barrier: leave out `barrier = false`",
            );
        }
        question.defaults.clear();
        if !ContactDamping::FORMS.into_iter().any(gives) {
            case.contact_damping = ContactDamping::Lambda(default_lambda());
        }
        if !gives(Parameter::Zeta) && !gives(Parameter::Viscous) {
            case.zeta = DEFAULT_ZETA;
            question.defaults.push(Parameter::Zeta);
        }
        question.settings = self.settings()?;
        if !self.has_key("[run] duration") {
            question.settings.duration = DEFAULT_DURATION;
        }
        self.boundaries(&mut question)?;
        if !ContactDamping::FORMS.into_iter().any(gives) && question.holds_contact_damping() {
            question.defaults.insert(0, Parameter::Lambda);
        }
        self.kept(&mut question)?;
        self.search_options(&mut question)?;
        self.carried(&mut question)?;
        Ok(question)
    }

    /// Reads the variables.
    fn boundaries(&self, question: &mut OptimizationProblem) -> Result<(), ProblemError> {
        let limits = &self.limits;
        self.check_materials()?;
        self.own_materials(&mut question.materials)?;
        question.variables.clear();
        for (parameter, lower, upper) in DEFAULT_BOX {
            let given = match parameter {
                Parameter::Mass => limits.mass,
                Parameter::Radius => limits.radius,
                Parameter::Length => limits.length,
                _ => limits.modulus,
            };
            let fixed = fixing(parameter).into_iter().find(|key| self.has_key(key));
            let name = parameter.name();
            if parameter == Parameter::Modulus && !question.materials.is_empty() {
                let key = fixed.or(given.map(|_| "[limits] modulus"));
                match key {
                    Some(key) => {
                        return refused(format!(
                            "`{key}` changes nothing beside [[material]], which have their own moduli: leave one of them out"
                        ));
                    }
                    None => continue,
                }
            }
            match (given, fixed) {
                (Some(_), Some(fixed)) => {
                    return refused(format!(
                        "`{fixed}` and `[limits] {name}` say the same: leave out `{fixed}` to search, or the limits to hold it fixed"
                    ));
                }
                (None, Some(_)) => {}
                (given, None) => {
                    let [lower, upper] = given.map_or([lower, upper], |range| range.0);
                    question.variables.push(Variable { parameter, lower, upper });
                }
            }
        }
        Ok(())
    }

    /// Reads the limits.
    fn kept(&self, question: &mut OptimizationProblem) -> Result<(), ProblemError> {
        let limits = &self.limits;
        let of = [
            (Objective::RestTime, limits.max_rest_time),
            (Objective::DimensionlessRestTime, limits.max_dimensionless_rest_time),
            (Objective::PeakForce, limits.max_peak_force),
            (Objective::PeakPressure, limits.max_peak_pressure),
            (Objective::Impacts, limits.max_impacts),
            (Objective::PrimaryRestTime, limits.max_primary_rest_time),
        ];
        question.limits = of
            .into_iter()
            .filter_map(|(objective, limit)| Some(Limit { objective, at_most: limit? }))
            .collect();
        question.density = limits.density;
        let varies =
            |parameter| question.variables.iter().any(|variable| variable.parameter == parameter);
        if limits.density.is_some() && !(varies(Parameter::Mass) && varies(Parameter::Radius)) {
            return refused(
                "`[limits] density` makes the mass follow the radius: let mass and radius both vary, or leave it out",
            );
        }
        question.sphere_yield = self.yield_limit("[sphere] yield", self.sphere.yield_limit)?;
        question.barrier_yield = self.yield_limit("[barrier] yield", self.barrier.yield_limit)?;
        question.elastic = limits.elastic;
        let materials = &question.materials;
        if question.barrier_yield.is_some() && !materials.is_empty() {
            return refused(
                "`[barrier] yield` changes nothing beside [[material]]: give each material its `yield`",
            );
        }
        let stated = [
            ("[sphere] yield", question.sphere_yield.is_some()),
            ("[barrier] yield", question.barrier_yield.is_some()),
            ("[[material]] yield", materials.iter().any(|material| material.yield_limit.is_some())),
        ];
        match (limits.elastic, stated.into_iter().find(|(_, stated)| *stated)) {
            (true, None) => refused(
                "`[limits] elastic` needs a yield limit: give `yield` in [sphere], [barrier] or [[material]]",
            ),
            (false, Some((key, _))) => refused(format!(
                "`{key}` changes nothing without `elastic = true` in [limits]: give that too, or leave it out"
            )),
            _ => Ok(()),
        }
    }

    /// Reads the main mass that carries the pendulum, if its rest is an objective or limited.
    fn carried(&self, question: &mut OptimizationProblem) -> Result<(), ProblemError> {
        let limited = question.limits.iter().map(|limit| limit.objective);
        let counts =
            question.objectives.iter().copied().chain(limited).any(Objective::is_of_main_mass);
        match (&self.primary, counts) {
            (None, false) => {}
            (None, true) => {
                return refused(
                    "the rest time of the main mass needs [primary]: its mass, stiffness and displacement",
                );
            }
            (Some(_), false) => {
                return refused(
                    "[primary] changes nothing here: make \"primary_rest_time\" an objective in [genetic], or limit it by \
                     `max_primary_rest_time` in [limits]",
                );
            }
            (Some(section), true) => {
                let main_mass = self.main_mass_carrying(section, &mut question.case)?;
                question.main_mass = Some(main_mass);
            }
        }
        Ok(())
    }

    /// Reads the options of the search.
    fn search_options(&self, question: &mut OptimizationProblem) -> Result<(), ProblemError> {
        let section = &self.genetic;
        let names = match &section.objective {
            None => vec![Objective::RestTime.name().to_owned()],
            Some(Objectives::One(name)) => vec![name.clone()],
            Some(Objectives::Several(names)) => names.clone(),
        };
        let objective = |name: &String| {
            let known = Objective::ALL.map(|objective| (objective.name(), objective));
            named("objective", Some(name), Objective::RestTime, &known)
        };
        question.objectives = names.iter().map(objective).collect::<Result<_, _>>()?;
        let options = &mut question.genetic;
        let count = |given: Option<u32>, usual: usize| given.map_or(usual, |given| given as usize);
        options.population = count(section.population, options.population);
        options.generations = count(section.generations, options.generations);
        options.constraint_tolerance =
            section.constraint_tolerance.unwrap_or(options.constraint_tolerance);
        self.needs("constraint_tolerance", question.density.is_some(), "[limits] density")?;
        question.seed = section.seed.unwrap_or(question.seed);
        if question.objectives.len() > 1 {
            question.runs = count(section.runs, SEVERAL_RUNS);
            options.generations = count(section.generations, SEVERAL_GENERATIONS);
            for key in ONE_OBJECTIVE {
                if self.has_key(&format!("[genetic] {key}")) {
                    return Err(OptimizeError::OneObjective(key).into());
                }
            }
            return Ok(());
        }
        question.runs = count(section.runs, question.runs);
        options.elite = count(section.elite, options.elite);
        options.crossover_fraction =
            section.crossover_fraction.unwrap_or(options.crossover_fraction);
        options.stall_generations = count(section.stall_generations, options.stall_generations);
        options.function_tolerance =
            section.function_tolerance.unwrap_or(options.function_tolerance);
        self.operators(options)?;
        self.penalty(question)?;
        let tests = [("average", StallTest::Average), ("weighted", StallTest::Weighted)];
        let usual = question.genetic.stall_test;
        question.genetic.stall_test =
            named("stall_test", section.stall_test.as_ref(), usual, &tests)?;
        Ok(())
    }

    /// Reads coding, crossover and mutation.
    fn operators(&self, options: &mut GeneticOptions) -> Result<(), ProblemError> {
        let section = &self.genetic;
        let bits = section.bits.unwrap_or(DEFAULT_BITS);
        let coding = [("real", Coding::Real), ("bits", Coding::Bits(bits))];
        options.coding = named("coding", section.coding.as_ref(), options.coding, &coding)?;
        let of_bits = options.coding != Coding::Real;
        self.needs("bits", of_bits, "coding = \"bits\"")?;
        let usual = match of_bits {
            true => (Crossover::Scattered, Mutation::BitFlips(DEFAULT_RATE)),
            false => (options.crossover, options.mutation),
        };
        let ratio = section.crossover_ratio.unwrap_or(1.2);
        let crossover = [
            ("heuristic", Crossover::Heuristic(ratio)),
            ("scattered", Crossover::Scattered),
            ("one-point", Crossover::OnePoint),
        ];
        let usual_crossover = match usual.0 {
            Crossover::Heuristic(_) => Crossover::Heuristic(ratio),
            other => other,
        };
        options.crossover =
            named("crossover", section.crossover.as_ref(), usual_crossover, &crossover)?;
        let heuristic = matches!(options.crossover, Crossover::Heuristic(_));
        self.needs("crossover_ratio", heuristic, "crossover = \"heuristic\"")?;
        let rate = section.mutation_rate.unwrap_or(DEFAULT_RATE);
        let mutation = [
            ("adaptive-feasible", Mutation::AdaptiveFeasible),
            ("bit-flip", Mutation::BitFlips(rate)),
        ];
        let usual_mutation = match usual.1 {
            Mutation::BitFlips(_) => Mutation::BitFlips(rate),
            Mutation::AdaptiveFeasible => Mutation::AdaptiveFeasible,
        };
        options.mutation = named("mutation", section.mutation.as_ref(), usual_mutation, &mutation)?;
        let flips = matches!(options.mutation, Mutation::BitFlips(_));
        self.needs("mutation_rate", flips, "mutation = \"bit-flip\"")?;
        Ok(())
    }

    /// Reads the penalty of a violated constraint.
    fn penalty(&self, question: &mut OptimizationProblem) -> Result<(), ProblemError> {
        let section = &self.genetic;
        let constrained =
            question.density.is_some() || question.elastic || !question.limits.is_empty();
        let lagrangian = Penalty::AugmentedLagrangian {
            initial: section.initial_penalty.unwrap_or(10.0),
            factor: section.penalty_factor.unwrap_or(100.0),
        };
        let penalty = [
            ("death", Penalty::Death),
            ("feasible-first", Penalty::FeasibleFirst),
            ("augmented-lagrangian", lagrangian),
        ];
        // A random design practically never has the given density, and may never keep hard limits:
        // the penalty `death` would leave no population.
        let usual = match question.density {
            Some(_) => lagrangian,
            None if constrained => Penalty::FeasibleFirst,
            None => Penalty::Death,
        };
        question.genetic.penalty = named("penalty", section.penalty.as_ref(), usual, &penalty)?;
        let is_lagrangian = matches!(question.genetic.penalty, Penalty::AugmentedLagrangian { .. });
        self.needs(
            "penalty",
            constrained,
            "a constraint beyond the limits of the variables, in [limits]",
        )?;
        self.needs("initial_penalty", is_lagrangian, "penalty = \"augmented-lagrangian\"")?;
        self.needs("penalty_factor", is_lagrangian, "penalty = \"augmented-lagrangian\"")?;
        Ok(())
    }

    /// An error if a key is given although its condition, named by `other`, does not hold.
    fn needs(
        &self,
        key: &'static str,
        there: bool,
        other: &'static str,
    ) -> Result<(), ProblemError> {
        match self.has_key(&format!("[genetic] {key}")) && !there {
            true => refused(format!(
                "`[genetic] {key}` changes nothing without {other}: give that too, or leave it out"
            )),
            false => Ok(()),
        }
    }
}

/// The default number of bits of a number.
const DEFAULT_BITS: u32 = 16;

/// The default probability of a bit flip.
const DEFAULT_RATE: f64 = 0.01;

/// The default number of runs of a search for a front.
const SEVERAL_RUNS: usize = 10;

/// The default number of generations of a search for a front.
const SEVERAL_GENERATIONS: usize = 100;

/// The keys without effect in a search for a front.
const ONE_OBJECTIVE: [&str; 14] = [
    "elite",
    "crossover_fraction",
    "crossover",
    "crossover_ratio",
    "mutation",
    "mutation_rate",
    "coding",
    "bits",
    "penalty",
    "initial_penalty",
    "penalty_factor",
    "stall_generations",
    "function_tolerance",
    "stall_test",
];

#[cfg(test)]
mod tests {
    use super::*;

    fn asked(text: &str) -> Result<OptimizationProblem, ProblemError> {
        text.parse::<Problem>().unwrap().optimize()
    }

    #[test]
    fn an_empty_file_is_the_papers_study() {
        let (of_file, of_library) = (asked("").unwrap(), OptimizationProblem::default());
        assert_eq!(OptimizationProblem { settings: of_library.settings, ..of_file }, of_library);
    }

    #[test]
    fn what_would_change_nothing_is_refused() {
        for (text, words) in [
            ("[limits]\nmass = [1, 2]\n[design]\nmass = 1", "[limits] mass"),
            (
                "[limits]\nmodulus = [1, 2]\n[[material]]\nname = \"A\"\nmodulus = 1e9",
                "[[material]]",
            ),
            ("[design]\nmodulus = 1e9\n[[material]]\nname = \"A\"\nmodulus = 1e9", "[[material]]"),
            ("[limits]\ndensity = 7850\n[design]\nradius = 0.01", "density"),
            ("[limits]\nelastic = true", "yield limit"),
            ("[sphere]\nyield = 1e9", "elastic"),
            ("[genetic]\npenalty = \"death\"", "penalty"),
            ("[genetic]\ninitial_penalty = 10", "initial_penalty"),
            ("[genetic]\nbits = 8", "bits"),
            ("[genetic]\nmutation_rate = 0.1", "bit-flip"),
            ("[genetic]\nobjective = [\"mass\", \"rest_time\"]\nelite = 2", "NSGA-II"),
            ("[genetic]\nobjective = \"rest\"", "unknown"),
        ] {
            let error = asked(text).expect_err(text).to_string();
            assert!(error.contains(words), "{text}: {error}");
        }
        let error = asked("[genetic]\ncrossover = \"heuristics\"").unwrap_err();
        assert_eq!(error.help().as_deref(), Some("did you mean \"heuristic\"?"));
    }

    #[test]
    fn bits_have_operators_of_their_own() {
        let options = asked("[genetic]\ncoding = \"bits\"").unwrap().genetic;
        assert_eq!(options.coding, Coding::Bits(16));
        assert_eq!(
            (options.crossover, options.mutation),
            (Crossover::Scattered, Mutation::BitFlips(0.01))
        );
        assert_eq!(options.check(), Ok(()));
        let mixed = asked("[genetic]\ncoding = \"bits\"\ncrossover = \"heuristic\"").unwrap();
        assert!(mixed.genetic.check().is_err());
    }
}
