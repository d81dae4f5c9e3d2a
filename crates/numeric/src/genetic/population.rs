//! The generations of one run.

use rand::Rng;
use thiserror::Error;

use super::coding::Coding;
use super::crossover::{Crossover, heuristic, one_point, scattered};
use super::mutation::{Mutation, adaptive_feasible, bit_flips, next_step};
use super::penalty::{Multipliers, Penalty, scores};
use super::scaling::rank_scaling;
use super::selection::stochastic_uniform;
use super::space::{Evaluation, Space};
use super::stopping::{GeneticStop, StallTest, has_stalled};

/// Options of a genetic algorithm. By default genes are real numbers and the penalty is infinite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GeneticOptions {
    /// Number of individuals in a generation.
    pub population: usize,
    /// Number of the best individuals that go on to the next generation unchanged.
    pub elite: usize,
    /// Fraction of the others, from 0 to 1, that crossover makes; mutation makes the rest.
    pub crossover_fraction: f64,
    /// The encoding of points as genes.
    pub coding: Coding,
    /// The crossover of two parents.
    pub crossover: Crossover,
    /// The mutation of a parent.
    pub mutation: Mutation,
    /// The penalty of a violated constraint.
    pub penalty: Penalty,
    /// Largest value of an equality that counts as zero.
    pub constraint_tolerance: f64,
    /// Largest number of generations after the random population.
    pub generations: usize,
    /// Number of generations over which the best value is watched.
    pub stall_generations: usize,
    /// Change of the best value below which the search has stalled.
    pub function_tolerance: f64,
    /// The measure of that change.
    pub stall_test: StallTest,
    /// Largest number of evaluations of a run; `None` sets no limit.
    pub budget: Option<usize>,
}

impl Default for GeneticOptions {
    fn default() -> Self {
        Self {
            population: 100,
            elite: 2,
            crossover_fraction: 0.8,
            coding: Coding::Real,
            crossover: Crossover::default(),
            mutation: Mutation::default(),
            penalty: Penalty::default(),
            constraint_tolerance: 0.001,
            generations: 400,
            stall_generations: 50,
            function_tolerance: 1e-6,
            stall_test: StallTest::default(),
            budget: None,
        }
    }
}

/// The reason why a search cannot begin.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SearchError {
    /// There is no variable.
    #[error("there is nothing to vary")]
    Empty,
    /// The bounds of a variable are equal, in the wrong order or not finite.
    #[error("the bounds {lower} and {upper} of variable {number} leave nothing between them")]
    Inverted {
        /// The number of the variable, counted from 1.
        number: usize,
        /// The lower bound given.
        lower: f64,
        /// The upper bound given.
        upper: f64,
    },
    /// The population is too small to cross, or too large.
    #[error(
        "population = {0} cannot cross: a population needs 2 or more, {MOST_INDIVIDUALS} at most"
    )]
    Population(usize),
    /// There are no generations, or too many.
    #[error("generations = {0}: a run needs 1 or more, {MOST_GENERATIONS} at most")]
    Generations(usize),
    /// The elite is the whole population.
    #[error(
        "elite = {elite} leaves nobody of a population of {population} to change: it must be smaller"
    )]
    Elite {
        /// The elite.
        elite: usize,
        /// The population.
        population: usize,
    },
    /// The crossover fraction is not between 0 and 1.
    #[error("crossover_fraction must lie between 0 and 1, not {0}")]
    Fraction(f64),
    /// The crossover ratio is below 1 or not finite, so that a child would lie short of the better
    /// parent.
    #[error(
        "crossover_ratio must be a number of 1 or more, not {0}: the child lies beyond the better parent"
    )]
    Ratio(f64),
    /// The mutation rate is not a probability.
    #[error("mutation_rate must lie between 0 and 1, not {0}")]
    Rate(f64),
    /// There are too few or too many bits.
    #[error("bits must be a whole number from 1 to 52, not {0}")]
    Bits(u32),
    /// An operator that needs real numbers was combined with bits.
    #[error(
        "{operator} needs numbers and knows nothing of bits: use {instead}, or leave out `coding`"
    )]
    NeedsNumbers {
        /// The operator asked for.
        operator: &'static str,
        /// The operators that work instead.
        instead: &'static str,
    },
    /// An operator that needs bits was combined with real numbers.
    #[error(
        "mutation \"bit-flip\" needs coding = \"bits\": give that too, or use \"adaptive-feasible\""
    )]
    NeedsBits,
    /// A tolerance, or a parameter of the penalty, is not a positive number.
    #[error("{key} must be a positive number, not {value}")]
    NotPositive {
        /// The key.
        key: &'static str,
        /// The value given.
        value: f64,
    },
    /// The window of the stall test is empty.
    #[error("stall_generations must be 1 or more")]
    Window,
    /// The budget is smaller than the random population.
    #[error("a budget of {budget} evaluations a run is less than one population of {population}")]
    Budget {
        /// The budget of one run.
        budget: usize,
        /// The population.
        population: usize,
    },
}

/// The largest population.
const MOST_INDIVIDUALS: usize = 100_000;

/// The largest number of generations.
const MOST_GENERATIONS: usize = 1_000_000;

impl GeneticOptions {
    /// Checks that a search with these options can begin.
    ///
    /// # Errors
    /// [`SearchError`] names the option.
    pub fn check(&self) -> Result<(), SearchError> {
        let &Self { population, elite, generations, crossover_fraction, .. } = self;
        if !(2..=MOST_INDIVIDUALS).contains(&population) {
            return Err(SearchError::Population(population));
        }
        if !(1..=MOST_GENERATIONS).contains(&generations) {
            return Err(SearchError::Generations(generations));
        }
        if elite >= population {
            return Err(SearchError::Elite { elite, population });
        }
        if !(0.0..=1.0).contains(&crossover_fraction) {
            return Err(SearchError::Fraction(crossover_fraction));
        }
        if self.stall_generations == 0 {
            return Err(SearchError::Window);
        }
        let bits = match self.coding {
            Coding::Bits(bits) if !(1..=52).contains(&bits) => {
                return Err(SearchError::Bits(bits));
            }
            coding => coding != Coding::Real,
        };
        match self.crossover {
            Crossover::Heuristic(_) if bits => {
                let (operator, instead) =
                    ("crossover \"heuristic\"", "\"scattered\" or \"one-point\"");
                return Err(SearchError::NeedsNumbers { operator, instead });
            }
            Crossover::Heuristic(ratio) if !(ratio >= 1.0 && ratio.is_finite()) => {
                return Err(SearchError::Ratio(ratio));
            }
            _ => {}
        }
        match self.mutation {
            Mutation::AdaptiveFeasible if bits => {
                let (operator, instead) = ("mutation \"adaptive-feasible\"", "\"bit-flip\"");
                return Err(SearchError::NeedsNumbers { operator, instead });
            }
            Mutation::BitFlips(_) if !bits => return Err(SearchError::NeedsBits),
            Mutation::BitFlips(rate) if !(0.0..=1.0).contains(&rate) => {
                return Err(SearchError::Rate(rate));
            }
            _ => {}
        }
        let mut positive = vec![
            ("function_tolerance", self.function_tolerance),
            ("constraint_tolerance", self.constraint_tolerance),
        ];
        if let Penalty::AugmentedLagrangian { initial, factor } = self.penalty {
            positive.extend([("initial_penalty", initial), ("penalty_factor", factor)]);
        }
        for (key, value) in positive {
            if !(value > 0.0 && value.is_finite()) {
                return Err(SearchError::NotPositive { key, value });
            }
        }
        match self.budget {
            Some(budget) if budget < population => Err(SearchError::Budget { budget, population }),
            _ => Ok(()),
        }
    }

    /// Returns the numbers of children by crossover and by mutation.
    ///
    /// ```
    /// # use lindstedt_numeric as lindstedt;
    /// use lindstedt::genetic::GeneticOptions;
    ///
    /// assert_eq!(GeneticOptions::default().children(), (78, 20)); // of 100 with an elite of 2
    /// ```
    pub fn children(&self) -> (usize, usize) {
        let all = self.population.saturating_sub(self.elite);
        let crossed = ((self.crossover_fraction * all as f64).round() as usize).min(all);
        (crossed, all - crossed)
    }

    /// Returns the largest number of evaluations of one run.
    pub fn most_evaluations(&self) -> usize {
        let (crossed, mutated) = self.children();
        let all =
            self.population.saturating_add(self.generations.saturating_mul(crossed + mutated));
        self.budget.map_or(all, |budget| budget.min(all))
    }
}

/// A point and its evaluation.
#[derive(Debug, Clone, PartialEq)]
pub struct Individual {
    /// The point, in the box.
    pub point: Vec<f64>,
    /// Its objectives and constraints.
    pub evaluation: Evaluation,
}

/// The result of one run.
#[derive(Debug, Clone, PartialEq)]
pub struct GeneticRun {
    /// The best of all points that break no constraint; `None` if there was none.
    pub best: Option<Individual>,
    /// The best value after the random population and after every generation; infinite while no
    /// point is feasible.
    pub curve: Vec<f64>,
    /// Generations after the random population.
    pub generations: usize,
    /// Points that were evaluated.
    pub evaluations: usize,
    /// The reason why it ended.
    pub stop: GeneticStop,
}

/// After this many generations the multipliers of an augmented Lagrangian are corrected.
const SUBPROBLEM: usize = 10;

/// An individual of the search: its genes and the point that they encode.
struct Member {
    genes: Vec<f64>,
    individual: Individual,
}

/// The function of many points from that of one.
pub fn one_by_one(
    mut evaluate: impl FnMut(&[f64]) -> Evaluation,
) -> impl FnMut(&[Vec<f64>]) -> Vec<Evaluation> {
    move |points| points.iter().map(|point| evaluate(point)).collect()
}

/// Minimises the first objective under the constraints by one run of the genetic algorithm.
///
/// `evaluate` takes all new points of a generation at once, so that it may work on them side by side.
/// `go_on` is called with the number of each generation before it begins; the run ends there if it
/// returns `false`.
pub fn search(
    space: &Space,
    mut evaluate: impl FnMut(&[Vec<f64>]) -> Vec<Evaluation>,
    options: &GeneticOptions,
    generator: &mut impl Rng,
    go_on: &mut dyn FnMut(usize) -> bool,
) -> GeneticRun {
    let mut nursery =
        PopulationBuilder { space, options, evaluate: &mut evaluate, best: None, evaluations: 0 };
    let drawn = (0..options.population).map(|_| options.coding.draw(space, generator)).collect();
    let mut population = nursery.evaluate_genes(drawn);
    let mut multipliers = match (options.penalty, population.first()) {
        (Penalty::AugmentedLagrangian { initial, .. }, Some(first)) => {
            Some(Multipliers::new(initial, &first.individual.evaluation))
        }
        _ => None,
    };
    let (crossed, mutated) = options.children();
    let score = |population: &[Member], multipliers: Option<&Multipliers>| {
        let evaluations: Vec<&Evaluation> =
            population.iter().map(|member| &member.individual.evaluation).collect();
        scores(&evaluations, options.penalty, multipliers, options.constraint_tolerance)
    };
    let (mut curve, mut step, mut generation) = (vec![nursery.value()], 1.0, 0);
    let stop = loop {
        if let Some(stop) = ended(options, &curve, generation, nursery.evaluations) {
            break stop;
        }
        if !go_on(generation + 1) {
            break GeneticStop::Interrupted;
        }
        let scored = score(&population, multipliers.as_ref());
        let expected = rank_scaling(&scored, 2 * crossed + mutated);
        let parents = stochastic_uniform(&expected, 2 * crossed + mutated, generator);
        let children = children(&population, &scored, &parents, (space, options, step), generator);
        let mut order: Vec<usize> = (0..population.len()).collect();
        order.sort_by(|one, other| scored[*one].total_cmp(&scored[*other]));
        let mut places: Vec<Option<Member>> = population.into_iter().map(Some).collect();
        let elite = order.iter().take(options.elite);
        population = elite.filter_map(|index| places[*index].take()).collect();
        population.extend(nursery.evaluate_genes(children));
        let before = order.first().map_or(f64::INFINITY, |index| scored[*index]);
        let now = score(&population, multipliers.as_ref());
        let leader = (0..now.len()).min_by(|one, other| now[*one].total_cmp(&now[*other]));
        let improved = leader.is_some_and(|leader| now[leader] < before);
        step = next_step(step, generation, improved);
        generation += 1;
        curve.push(nursery.value());
        if let (Some(multipliers), Penalty::AugmentedLagrangian { factor, .. }, Some(leader)) =
            (&mut multipliers, options.penalty, leader)
            && generation % SUBPROBLEM == 0
        {
            let evaluation = &population[leader].individual.evaluation;
            multipliers.update(evaluation, factor, options.constraint_tolerance);
        }
    };
    GeneticRun {
        best: nursery.best,
        curve,
        generations: generation,
        evaluations: nursery.evaluations,
        stop,
    }
}

/// Decodes and evaluates the genes of new members of the population; keeps the best point that
/// violates no constraint.
struct PopulationBuilder<'a, E> {
    space: &'a Space,
    options: &'a GeneticOptions,
    evaluate: &'a mut E,
    best: Option<Individual>,
    evaluations: usize,
}

impl<E: FnMut(&[Vec<f64>]) -> Vec<Evaluation>> PopulationBuilder<'_, E> {
    fn evaluate_genes(&mut self, all: Vec<Vec<f64>>) -> Vec<Member> {
        let points: Vec<Vec<f64>> =
            all.iter().map(|genes| self.options.coding.point(genes, self.space)).collect();
        let evaluations = (self.evaluate)(&points);
        let mut members = Vec::with_capacity(all.len());
        for ((genes, point), evaluation) in all.into_iter().zip(points).zip(evaluations) {
            self.evaluations += 1;
            let individual = Individual { point, evaluation };
            let better = individual.evaluation.value() < self.value();
            let first = self.best.is_none();
            let tolerance = self.options.constraint_tolerance;
            if individual.evaluation.is_feasible(tolerance) && (first || better) {
                self.best = Some(individual.clone());
            }
            members.push(Member { genes, individual });
        }
        members
    }

    /// Returns the best value so far; infinite while there is none.
    fn value(&self) -> f64 {
        let best = self.best.as_ref();
        best.map_or(f64::INFINITY, |best| best.evaluation.value())
    }
}

/// Returns the reason why no further generation is begun; `None` if no limit is reached.
fn ended(
    options: &GeneticOptions,
    curve: &[f64],
    generation: usize,
    evaluations: usize,
) -> Option<GeneticStop> {
    let (crossed, mutated) = options.children();
    if has_stalled(curve, options.stall_generations, options.function_tolerance, options.stall_test)
    {
        return Some(GeneticStop::Stalled);
    }
    if generation >= options.generations {
        return Some(GeneticStop::Generations);
    }
    let spent = |budget: usize| evaluations + crossed + mutated > budget;
    options.budget.is_some_and(spent).then_some(GeneticStop::Budget)
}

/// Returns the genes of the children: first those by crossover, then those by mutation.
fn children(
    population: &[Member],
    scored: &[f64],
    parents: &[usize],
    (space, options, step): (&Space, &GeneticOptions, f64),
    generator: &mut impl Rng,
) -> Vec<Vec<f64>> {
    let (crossed, mutated) = options.children();
    let mut children: Vec<Vec<f64>> = Vec::with_capacity(crossed + mutated);
    // There are fewer parents if no score is a number.
    let (pairs, alone) = parents.split_at(parents.len().min(2 * crossed));
    for pair in pairs.chunks_exact(2) {
        let (one, other) = (&population[pair[0]].genes, &population[pair[1]].genes);
        children.push(match options.crossover {
            Crossover::Heuristic(ratio) if scored[pair[0]] <= scored[pair[1]] => {
                heuristic(other, one, ratio, space)
            }
            Crossover::Heuristic(ratio) => heuristic(one, other, ratio, space),
            Crossover::Scattered => scattered(one, other, generator),
            Crossover::OnePoint => one_point(one, other, generator),
        });
    }
    for parent in alone {
        let genes = &population[*parent].genes;
        children.push(match options.mutation {
            Mutation::AdaptiveFeasible => adaptive_feasible(genes, step, space, generator),
            Mutation::BitFlips(rate) => bit_flips(genes, rate, generator),
        });
    }
    children
}

#[cfg(test)]
mod tests {
    use super::super::generator;
    use super::*;

    fn rastrigin(point: &[f64]) -> Evaluation {
        let term = |x: &f64| x * x - 10.0 * (std::f64::consts::TAU * x).cos() + 10.0;
        Evaluation::unconstrained(point.iter().map(term).sum())
    }

    fn run(
        bounds: [f64; 2],
        evaluate: fn(&[f64]) -> Evaluation,
        options: &GeneticOptions,
        stream: u64,
    ) -> GeneticRun {
        let space = Space::new(vec![bounds; 2]).unwrap();
        search(&space, one_by_one(evaluate), options, &mut generator(7, stream), &mut |_| true)
    }

    #[test]
    fn one_of_the_lowest_of_many_valleys_is_found() {
        let bits = GeneticOptions {
            coding: Coding::Bits(16),
            crossover: Crossover::Scattered,
            mutation: Mutation::BitFlips(0.02),
            ..GeneticOptions::default()
        };
        for options in [GeneticOptions::default(), bits] {
            let found = (0..10).filter(|stream| {
                let run = run([-5.0, 5.5], rastrigin, &options, *stream);
                assert!(run.curve.windows(2).all(|pair| pair[1] <= pair[0]));
                assert_eq!(run.curve.len(), run.generations + 1);
                assert_eq!(run.evaluations, 100 + 98 * run.generations);
                assert!(run.generations >= 51);
                // The lowest is 0, the four beside it are 0.995, of a hundred.
                run.curve.last().is_some_and(|best| *best < 1.5)
            });
            let count = found.count();
            assert!(count >= 8, "{options:?}: {count} of 10");
        }
    }

    /// Random numbers of a library may change from version to version: these are those of the lock
    /// file.
    #[test]
    fn a_seed_gives_the_same_run_for_ever() {
        let first = run([-5.0, 5.5], rastrigin, &GeneticOptions::default(), 0);
        assert_eq!(first, run([-5.0, 5.5], rastrigin, &GeneticOptions::default(), 0));
        assert_ne!(first.curve, run([-5.0, 5.5], rastrigin, &GeneticOptions::default(), 1).curve);
        assert_eq!(first.curve[0], GOLDEN);
    }

    const GOLDEN: f64 = 5.525_355_977_437_131;

    /// min x^2 + 2 y^2 on the line x + y = 1, beyond x = 0.75: (0.75, 0.25).
    #[test]
    fn constraints_are_kept_by_every_penalty() {
        let on_a_line = |point: &[f64]| Evaluation {
            objectives: vec![point[0] * point[0] + 2.0 * point[1] * point[1]],
            equalities: vec![point[0] + point[1] - 1.0],
            inequalities: vec![0.75 - point[0]],
        };
        let beyond = |point: &[f64]| Evaluation { equalities: vec![], ..on_a_line(point) };
        let lagrangian = Penalty::AugmentedLagrangian { initial: 10.0, factor: 100.0 };
        let space = Space::new(vec![[-2.0, 2.0]; 2]).unwrap();
        for (penalty, equality) in [
            (Penalty::Death, false),
            (Penalty::FeasibleFirst, false),
            (lagrangian, false),
            (Penalty::FeasibleFirst, true),
            (lagrangian, true),
        ] {
            let options = GeneticOptions { penalty, ..GeneticOptions::default() };
            let evaluate = |point: &[f64]| {
                if equality { on_a_line(point) } else { beyond(point) }
            };
            let run =
                search(&space, one_by_one(evaluate), &options, &mut generator(1, 0), &mut |_| true);
            let best = run.best.expect("a point that keeps them");
            assert!(best.evaluation.is_feasible(options.constraint_tolerance));
            let expected = if equality { [0.75, 0.25] } else { [0.75, 0.0] };
            let value = expected[0] * expected[0] + 2.0 * expected[1] * expected[1];
            let found = best.evaluation.value();
            assert!(found < value + 0.02, "{penalty:?} {equality}: {:?}", best.point);
        }
    }

    #[test]
    fn a_run_ends_where_it_is_told() {
        let few = GeneticOptions { generations: 7, ..GeneticOptions::default() };
        let run_of = |options: &GeneticOptions| run([-5.0, 5.5], rastrigin, options, 0);
        let ended = run_of(&few);
        assert_eq!((ended.stop, ended.generations), (GeneticStop::Generations, 7));
        let little = GeneticOptions { budget: Some(450), ..GeneticOptions::default() };
        let ended = run_of(&little);
        assert_eq!((ended.stop, ended.evaluations), (GeneticStop::Budget, 100 + 3 * 98));
        let space = Space::new(vec![[-5.0, 5.5]; 2]).unwrap();
        let mut until = |generation| generation <= 4;
        let ended = search(
            &space,
            one_by_one(rastrigin),
            &GeneticOptions::default(),
            &mut generator(7, 0),
            &mut until,
        );
        assert_eq!((ended.stop, ended.generations), (GeneticStop::Interrupted, 4));
        let whole = run_of(&GeneticOptions::default());
        assert_eq!(ended.curve[..], whole.curve[..5]);
    }

    #[test]
    fn what_makes_no_population_is_refused_by_name() {
        let usual = GeneticOptions::default();
        let population = GeneticOptions { population: 1, ..usual };
        let elite = GeneticOptions { elite: 100, ..usual };
        let generations = GeneticOptions { generations: 0, ..usual };
        let fraction = GeneticOptions { crossover_fraction: f64::NAN, ..usual };
        let bits = GeneticOptions { coding: Coding::Bits(8), ..usual };
        let flips = GeneticOptions { mutation: Mutation::BitFlips(0.1), ..usual };
        let budget = GeneticOptions { budget: Some(99), ..usual };
        for (options, words) in [
            (population, "population"),
            (elite, "elite"),
            (generations, "generations"),
            (fraction, "crossover_fraction"),
            (bits, "heuristic"),
            (flips, "bit-flip"),
            (budget, "budget"),
        ] {
            let error = options.check().expect_err(words).to_string();
            assert!(error.contains(words), "{error}");
        }
        assert_eq!(usual.check(), Ok(()));
    }
}
