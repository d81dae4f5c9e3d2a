//! Many runs of one search, on all cores, and the comparisons with other searches.
//!
//! Run number i has the i-th stream of random numbers of the seed, so its result depends only on
//! the problem, not on the number of threads or on whether it was read from a record.

use super::decision::Decision;
use super::design::{EvaluatedDesign, Route};
use super::known::KnownDesigns;
use super::objective::Objective;
use super::question::{LARGEST_EXCESS, OptimizationProblem, OptimizeError};
use crate::decimal::significant;
use crate::genetic::{
    Evaluation, GeneticOptions, GeneticRun, GeneticStop, Individual, Penalty, Space, crowding,
    differential_evolution, generator, non_dominated, one_by_one, random_search, search,
    search_front,
};
use crate::impact::hertz;
use crate::parallel::par_map;

/// A design that a run found, as the search has it: by closed forms, by integration where there are
/// none.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(deny_unknown_fields)
)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Found {
    /// The values of the variables in their order, then the number of the material.
    pub point: Vec<f64>,
    /// The objectives in their order.
    pub values: Vec<f64>,
}

/// One run.
#[derive(Debug, Clone, PartialEq)]
pub struct SearchRun {
    /// Its number, from 0: the stream of its random numbers.
    pub number: usize,
    /// The best design, or with several objectives the front; empty if no design rests and keeps
    /// the constraints.
    pub found: Vec<Found>,
    /// The best value after the random population and after every generation, infinite as long as
    /// there is none; with several objectives the size of the front.
    pub curve: Vec<f64>,
    /// Generations after the random population.
    pub generations: usize,
    /// Designs that were followed.
    pub evaluations: usize,
    /// The number of designs that were integrated: they have no closed form, or would be the best
    /// if they keep the constraints.
    pub integrated: usize,
    /// The reason why it ended.
    pub stop: GeneticStop,
}

/// The observer of a study; by default there is none.
pub struct StudyObserver<'a> {
    /// Whether to stop.
    pub stop: &'a (dyn Fn() -> bool + Sync),
    /// Called with every run that has ended without an interrupt.
    pub done: &'a (dyn Fn(&SearchRun) + Sync),
    /// Called with the number of generations newly done, of those that
    /// [`OptimizationProblem::most_work`] counts.
    pub progress: &'a (dyn Fn(usize) + Sync),
}

impl Default for StudyObserver<'_> {
    fn default() -> Self {
        Self { stop: &|| false, done: &|_| (), progress: &|_| () }
    }
}

/// The distribution of a number over the runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FiveNumberSummary {
    /// The least value.
    pub best: f64,
    /// The lower quartile: a quarter of the values are not larger.
    pub lower_quartile: f64,
    /// The median: half of the values are not larger.
    pub median: f64,
    /// The upper quartile: three quarters of the values are not larger.
    pub upper_quartile: f64,
    /// The greatest value.
    pub worst: f64,
}

impl FiveNumberSummary {
    /// The summary of these values; `None` if there are none. Quartiles are interpolated.
    pub fn from_values(values: &[f64]) -> Option<Self> {
        let mut values = values.to_vec();
        values.sort_by(f64::total_cmp);
        let last = values.len().checked_sub(1)?;
        let at = |part: f64| {
            let place = part * last as f64;
            let index = (place.floor() as usize).min(last);
            let next = values[(index + 1).min(last)];
            values[index] + (place - index as f64) * (next - values[index])
        };
        Some(Self {
            best: values[0],
            lower_quartile: at(0.25),
            median: at(0.5),
            upper_quartile: at(0.75),
            worst: values[last],
        })
    }
}

/// Another search with as many evaluations, run as often.
#[derive(Debug, Clone, PartialEq)]
pub struct BaselineSearch {
    /// `random search`
    pub name: &'static str,
    /// Evaluations of one run.
    pub evaluations: usize,
    /// The best value of every run; infinite if it found none.
    pub values: Vec<f64>,
    /// The median of the best values so far over the runs, after every population of evaluations.
    pub curve: Vec<f64>,
}

impl BaselineSearch {
    /// The distribution of the best values over the runs that found one.
    pub fn spread(&self) -> Option<FiveNumberSummary> {
        let found: Vec<f64> =
            self.values.iter().copied().filter(|value| value.is_finite()).collect();
        FiveNumberSummary::from_values(&found)
    }
}

/// A design that was judged again by integration.
#[derive(Debug, Clone, PartialEq)]
pub struct Finalist {
    /// The run that found it.
    pub run: usize,
    /// Its objectives by closed forms, where it has them; else by integration.
    pub by_chain: Vec<f64>,
    /// The design by integration.
    pub design: EvaluatedDesign,
    /// Its objectives by integration; infinite if it has none.
    pub values: Vec<f64>,
    /// Whether it rests and keeps the constraints by integration; no front has a design that does
    /// not.
    pub feasible: bool,
}

/// A search for the best design: the answer.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Study {
    /// The problem that was solved.
    pub question: OptimizationProblem,
    /// The runs, by their numbers.
    pub runs: Vec<SearchRun>,
    /// Whether all runs and comparisons were completed.
    pub complete: bool,
    /// The best designs of the runs judged again, the best first; with several objectives the
    /// front.
    pub finalists: Vec<Finalist>,
    /// The default design under the same assumptions, by integration, in the box or not.
    pub default_design: Option<EvaluatedDesign>,
    /// The factors that limit the best design; `None` with several objectives.
    pub decision: Option<Decision>,
    /// Other searches with the same number of evaluations; none with several objectives.
    pub rivals: Vec<BaselineSearch>,
}

/// The best of this many runs are judged again.
const FINALISTS: usize = 10;

/// Largest error of closed forms relative to a constraint.
const MOST_OFF: f64 = 0.25;

/// Streams of random numbers of the rivals.
const RIVALS: [u64; 2] = [1 << 32, 1 << 33];

impl OptimizationProblem {
    /// The most generations of the whole study, those of the rivals among them.
    pub fn most_work(&self) -> usize {
        let rivals = if self.objectives.len() == 1 { 2 } else { 0 };
        self.runs.saturating_mul((1 + rivals) * self.genetic.generations)
    }

    /// The value of a design in a search, in which the best one so far has this value; a design
    /// that is not admissible gets the worst value.
    ///
    /// Closed forms are too coarse to decide whether a constraint is kept: a design that is within
    /// their error of a constraint and would be the best or on a front is integrated. If it keeps
    /// the constraints, its value by closed forms is used, so that values can be compared.
    pub(super) fn bounded_evaluation(
        &self,
        point: &[f64],
        best: f64,
        integrated: &mut usize,
    ) -> Evaluation {
        let by_chain = self.follow(point, Route::Chain, self.needs_contact());
        self.bounded(self.evaluation_of(&by_chain), point, best, integrated)
    }

    /// The objectives and constraints of a design that was followed, and whether it was integrated.
    fn evaluation_of(&self, found: &Result<EvaluatedDesign, String>) -> (Evaluation, bool) {
        match found {
            Ok(design) => (self.evaluation(design), design.integrated),
            Err(_) => {
                let none = Evaluation {
                    objectives: vec![f64::INFINITY; self.objectives.len()],
                    equalities: self.density.map(|_| LARGEST_EXCESS).into_iter().collect(),
                    inequalities: vec![
                        LARGEST_EXCESS;
                        self.limits.len() + usize::from(self.elastic)
                    ],
                };
                (none, false)
            }
        }
    }

    /// [`Self::bounded_evaluation`] of a design whose evaluation by its chain is known, and whether
    /// it was integrated instead.
    fn bounded(
        &self,
        (evaluation, is_integrated): (Evaluation, bool),
        point: &[f64],
        best: f64,
        integrated: &mut usize,
    ) -> Evaluation {
        let closest = evaluation.inequalities.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let tolerance = self.genetic.constraint_tolerance;
        let counts = self.objectives.len() > 1 || evaluation.value() < best;
        let decides =
            counts && closest > -MOST_OFF && !is_integrated && evaluation.is_feasible(tolerance);
        *integrated += usize::from(is_integrated || decides);
        if decides {
            let by_integration = self.follow(point, Route::Integration, self.needs_contact());
            let (judged, _) = self.evaluation_of(&by_integration);
            if !judged.is_feasible(tolerance) {
                return judged;
            }
        }
        evaluation
    }

    /// The function that a search minimises, of many points at once; it remembers the best value so
    /// far, and counts the designs that were integrated. `known` are designs that were followed
    /// before, where a search comes back to them: a genetic one gives most of its children values
    /// that it has had.
    fn evaluate<'a>(
        &'a self,
        integrated: &'a mut usize,
        mut known: Option<KnownDesigns>,
    ) -> impl FnMut(&[Vec<f64>]) -> Vec<Evaluation> + 'a {
        let mut best = f64::INFINITY;
        let follow = |points: &[Vec<f64>]| {
            let keep = |design| self.evaluation_of(&design);
            self.follow_by_chain(points, self.needs_contact(), keep)
        };
        move |points| {
            let by_chain = match &mut known {
                Some(known) => known.recalled(points, follow),
                None => follow(points),
            };
            let evaluate = |(point, by_chain): (&Vec<f64>, (Evaluation, bool))| {
                let evaluation = self.bounded(by_chain, point, best, integrated);
                if evaluation.is_feasible(self.genetic.constraint_tolerance) {
                    best = best.min(evaluation.value());
                }
                evaluation
            };
            points.iter().zip(by_chain).map(evaluate).collect()
        }
    }

    fn run(&self, space: &Space, number: usize, watch: &StudyObserver) -> SearchRun {
        let mut generator = generator(self.seed, number as u64);
        let mut integrated = 0;
        let mut go_on = |_| {
            (watch.progress)(1);
            !(watch.stop)()
        };
        let evaluate = self.evaluate(&mut integrated, Some(KnownDesigns::default()));
        let (front, run) = match self.objectives.len() {
            1 => {
                let run = search(space, evaluate, &self.genetic, &mut generator, &mut go_on);
                (run.best.clone().into_iter().collect(), run)
            }
            _ => search_front(space, evaluate, &self.genetic, &mut generator, &mut go_on),
        };
        (watch.progress)(self.genetic.generations.saturating_sub(run.generations));
        let found = |individual: Individual| Found {
            point: individual.point,
            values: individual.evaluation.objectives,
        };
        SearchRun {
            number,
            found: front.into_iter().map(found).collect(),
            curve: run.curve,
            generations: run.generations,
            evaluations: run.evaluations,
            integrated,
            stop: run.stop,
        }
    }
}

/// The runs of these numbers alone, in that order, on all threads of the current pool; those that
/// an interrupt ended, or kept from beginning, are left out.
///
/// # Errors
/// [`OptimizeError`]: options that are not admissible.
pub fn search_runs(
    question: &OptimizationProblem,
    numbers: &[usize],
    watch: &StudyObserver,
) -> Result<Vec<SearchRun>, OptimizeError> {
    let space = question.check()?;
    let one = |&number: &usize| {
        let run = (!(watch.stop)()).then(|| question.run(&space, number, watch))?;
        (run.stop != GeneticStop::Interrupted).then_some(run)
    };
    Ok(par_map(numbers, one).into_iter().flatten().collect())
}

/// Searches: all runs but those that are known already, on all threads of the current pool.
///
/// # Errors
/// [`OptimizeError`]: options that are not admissible, or a box without a design that rests and
/// keeps the constraints.
pub fn optimize(
    question: OptimizationProblem,
    known: Vec<SearchRun>,
    watch: &StudyObserver,
) -> Result<Study, OptimizeError> {
    let space = question.check()?;
    let missing: Vec<usize> =
        (0..question.runs).filter(|number| known.iter().all(|run| run.number != *number)).collect();
    (watch.progress)((question.runs - missing.len()) * question.genetic.generations);
    // The first run always completes its random population, so that there is a result after an
    // interrupt.
    let first = missing.first().copied();
    let one = |&number: &usize| {
        if first != Some(number) && (watch.stop)() {
            return None;
        }
        let run = question.run(&space, number, watch);
        if run.stop != GeneticStop::Interrupted {
            (watch.done)(&run);
        }
        Some(run)
    };
    let new = par_map(&missing, one);
    let mut runs: Vec<SearchRun> =
        known.into_iter().filter(|run| run.number < question.runs).collect();
    runs.extend(new.into_iter().flatten());
    runs.sort_by_key(|run| run.number);
    if runs.is_empty() {
        return Err(OptimizeError::Stopped);
    }
    let complete =
        runs.len() == question.runs && runs.iter().all(|run| run.stop != GeneticStop::Interrupted);
    if runs.iter().all(|run| run.found.is_empty()) {
        return Err(no_design_error(&question, &space, watch, complete));
    }
    let finalists = finalists(&question, &runs);
    if finalists.first().is_none_or(|best| !best.feasible) {
        return Err(no_design_error(&question, &space, watch, complete));
    }
    let (mut rivals, mut decision) = (vec![], None);
    if question.objectives.len() == 1 {
        decision = finalists.first().map(|best| Decision::new(&question, &space, &best.design));
        if complete {
            rivals = self::rivals(&question, &space, &runs, watch);
        }
    }
    // The default design with all its values, including those that are held fixed here.
    let default_design = question.default_point().and_then(|point| {
        let mut usual = question.clone();
        usual.case.design = hertz::StiffnessDesign {
            gravity: question.case.design.gravity,
            ..hertz::StiffnessDesign::default()
        };
        usual.follow(&point, Route::Integration, true).ok()
    });
    Ok(Study {
        complete: complete && !(watch.stop)(),
        finalists,
        default_design,
        decision,
        rivals: if (watch.stop)() { vec![] } else { rivals },
        runs,
        question,
    })
}

/// The optimisation on this number of threads.
///
/// # Errors
/// As [`optimize`].
#[cfg(feature = "parallel")]
pub fn optimize_on(
    threads: usize,
    question: OptimizationProblem,
    known: Vec<SearchRun>,
    watch: &StudyObserver,
) -> Result<Study, OptimizeError> {
    crate::parallel::on_threads(threads, || optimize(question, known, watch))
}

/// Population and generations of a search for the constraints alone, at least.
const ENOUGH: [usize; 2] = [60, 100];

/// The error of a search without a design.
fn no_design_error(
    question: &OptimizationProblem,
    space: &Space,
    watch: &StudyObserver,
    complete: bool,
) -> OptimizeError {
    if !complete {
        return OptimizeError::Stopped;
    }
    // First check: whether any design rests, without constraints.
    let mut random = generator(question.seed, u64::MAX);
    let middle = space.point_at(&vec![0.5; space.bounds().len()]);
    let mut reason = None;
    let rests = (0..question.genetic.population.max(100)).any(|number| {
        let point = if number == 0 { middle.clone() } else { space.draw(&mut random) };
        let missing = match question.follow(&point, Route::Chain, question.needs_contact()) {
            Ok(design) => question.missing_value(&design),
            Err(error) => Some(error),
        };
        reason = reason.take().or(missing.clone());
        missing.is_none()
    });
    if let (false, Some(reason)) = (rests, reason) {
        return OptimizeError::NoRest { duration: question.settings.duration, reason };
    }
    if question.constraints().is_empty() {
        return OptimizeError::NoRest {
            duration: question.settings.duration,
            reason: "some do just before its end by closed forms, and none by integration"
                .to_owned(),
        };
    }
    // Second check: the violation of the constraints is minimised.
    let tolerance = question.genetic.constraint_tolerance;
    let evaluate = |point: &[f64]| {
        let evaluation = question.bounded_evaluation(point, f64::INFINITY, &mut 0);
        let has_values = evaluation.objectives.iter().all(|value| value.is_finite());
        Evaluation::unconstrained(match has_values {
            true => evaluation.violation(tolerance),
            false => f64::INFINITY,
        })
    };
    let mut options = GeneticOptions { penalty: Penalty::Death, ..question.genetic };
    if question.main_mass.is_none() {
        // Closed forms are cheap, so that a large population can exclude the existence of a design.
        options.population = options.population.max(ENOUGH[0]);
        options.generations = options.generations.max(ENOUGH[1]);
    }
    let run = search(
        space,
        one_by_one(evaluate),
        &options,
        &mut generator(question.seed, u64::MAX - 1),
        &mut |_| !(watch.stop)(),
    );
    let design =
        run.best.and_then(|best| question.follow(&best.point, Route::Integration, true).ok());
    let broken = design.as_ref().map(|design| question.broken(design));
    let exists = broken.as_ref().is_some_and(Vec::is_empty);
    OptimizeError::NoFeasible {
        constraints: question.constraints().join("; "),
        nearest: match (design, broken) {
            (Some(design), Some(broken)) if broken.is_empty() => {
                let variables = question.variables.iter().zip(&design.point);
                let values = variables.map(|(variable, value)| {
                    format!("{} = {}", variable.parameter.name(), significant(*value, 4))
                });
                let values: Vec<String> = values.collect();
                format!("there are some, such as {}", values.join(", "))
            }
            (Some(_), Some(broken)) => {
                format!("the nearest that was found breaks {}", broken.join("; "))
            }
            _ => "none comes near".to_owned(),
        },
        exists,
    }
}

fn finalists(question: &OptimizationProblem, runs: &[SearchRun]) -> Vec<Finalist> {
    let mut found: Vec<(usize, &Found)> = runs
        .iter()
        .flat_map(|run| run.found.iter().map(move |found| (run.number, found)))
        .collect();
    if question.objectives.len() == 1 {
        found.sort_by(|one, other| one.1.values[0].total_cmp(&other.1.values[0]));
        found = distinct(question, &found);
    } else {
        found = merged_front(&found, question.genetic.population);
    }
    let judge = |&(run, found): &(usize, &Found)| {
        let design = question.follow(&found.point, Route::Integration, true).ok()?;
        let evaluation = question.evaluation(&design);
        let by_chain =
            question.follow(&found.point, Route::Chain, question.needs_contact()).ok()?;
        Some(Finalist {
            run,
            by_chain: question.evaluation(&by_chain).objectives,
            feasible: evaluation.is_feasible(question.genetic.constraint_tolerance),
            values: evaluation.objectives,
            design,
        })
    };
    let judged = par_map(&found, judge);
    let mut finalists: Vec<Finalist> = judged.into_iter().flatten().collect();
    if question.objectives.len() > 1 {
        // By integration a design may break a constraint, or be dominated by another.
        finalists.retain(|finalist| finalist.feasible);
        let evaluations: Vec<Evaluation> =
            finalists.iter().map(|finalist| question.evaluation(&finalist.design)).collect();
        let front = non_dominated(
            &evaluations.iter().collect::<Vec<_>>(),
            question.genetic.constraint_tolerance,
        );
        let mut number = 0..;
        finalists.retain(|_| number.next().is_some_and(|number| front.contains(&number)));
    }
    // Designs that keep the constraints come first; a front is sorted by the first objective.
    finalists.sort_by(|one, other| {
        let broken = one.feasible.cmp(&other.feasible).reverse();
        broken.then(one.values[0].total_cmp(&other.values[0]))
    });
    finalists
}

/// The first designs that differ from those before by more than the tolerance of manufacture,
/// relative to the range between the limits.
fn distinct<'a>(
    question: &OptimizationProblem,
    found: &[(usize, &'a Found)],
) -> Vec<(usize, &'a Found)> {
    const SAME: f64 = 1e-6;
    let same = |one: &Found, other: &Found| {
        let ranges = question.variables.iter().map(|variable| variable.upper - variable.lower);
        // A material is a whole number.
        let ranges = ranges.chain(std::iter::once(1.0 / SAME));
        let pairs = one.point.iter().zip(&other.point).zip(ranges);
        let mut distances = pairs.map(|((one, other), range)| (one - other).abs() / range);
        distances.all(|distance| distance <= SAME)
    };
    let mut kept: Vec<(usize, &Found)> = Vec::new();
    for candidate in found {
        if kept.iter().all(|(_, other)| !same(candidate.1, other)) {
            kept.push(*candidate);
        }
        if kept.len() == FINALISTS {
            break;
        }
    }
    kept
}

/// The designs that are not dominated among the fronts of all runs; the most isolated ones if they
/// are too many.
fn merged_front<'a>(found: &[(usize, &'a Found)], most: usize) -> Vec<(usize, &'a Found)> {
    let evaluation =
        |found: &Found| Evaluation { objectives: found.values.clone(), ..Evaluation::default() };
    let all: Vec<Evaluation> = found.iter().map(|(_, found)| evaluation(found)).collect();
    let mut left = non_dominated(&all.iter().collect::<Vec<_>>(), 0.0);
    while left.len() > most {
        let standing: Vec<&Evaluation> = left.iter().map(|index| &all[*index]).collect();
        let lonely = crowding(&standing);
        // A tenth of the surplus is removed at a time, because removing neighbours together would
        // leave gaps.
        let mut order: Vec<usize> = (0..left.len()).collect();
        order.sort_by(|one, other| lonely[*one].total_cmp(&lonely[*other]));
        let mut gone: Vec<usize> =
            order.into_iter().take((left.len() - most).div_ceil(10)).collect();
        gone.sort_unstable();
        for index in gone.into_iter().rev() {
            left.remove(index);
        }
    }
    left.into_iter().map(|index| found[index]).collect()
}

fn rivals(
    question: &OptimizationProblem,
    space: &Space,
    runs: &[SearchRun],
    watch: &StudyObserver,
) -> Vec<BaselineSearch> {
    let GeneticOptions { population, constraint_tolerance, generations, .. } = question.genetic;
    let total: usize = runs.iter().map(|run| run.evaluations).sum();
    let evaluations = (total as f64 / runs.len() as f64).round() as usize;
    let compete = |name: &'static str, work: &(dyn Fn(usize) -> GeneticRun + Sync)| {
        let runs = par_map(runs, |run| {
            // A run is not begun after an interrupt.
            let run = (!(watch.stop)()).then(|| work(run.number));
            (watch.progress)(generations);
            run
        });
        let runs: Option<Vec<GeneticRun>> = runs.into_iter().collect();
        let runs = runs?;
        let length = runs.iter().map(|run| run.curve.len()).min().unwrap_or(0);
        let median = |index: usize| {
            let values: Vec<f64> = runs.iter().map(|run| run.curve[index]).collect();
            FiveNumberSummary::from_values(&values).map_or(f64::INFINITY, |spread| spread.median)
        };
        let value = |run: &GeneticRun| {
            run.best.as_ref().map_or(f64::INFINITY, |best| best.evaluation.value())
        };
        Some(BaselineSearch {
            name,
            evaluations: runs.first().map_or(0, |run| run.evaluations),
            values: runs.iter().map(value).collect(),
            curve: (0..length).map(median).collect(),
        })
    };
    let budget = (evaluations, population);
    let random = |number: usize| {
        let mut generator = generator(question.seed, RIVALS[0] + number as u64);
        let mut integrated = 0;
        random_search(
            space,
            question.evaluate(&mut integrated, None),
            budget,
            constraint_tolerance,
            &mut generator,
        )
    };
    let differential = |number: usize| {
        let seed = rand::RngExt::random(&mut generator(question.seed, RIVALS[1] + number as u64));
        let mut integrated = 0;
        differential_evolution(
            space,
            question.evaluate(&mut integrated, None),
            budget,
            constraint_tolerance,
            seed,
        )
    };
    [compete("random search", &random), compete("differential evolution", &differential)]
        .into_iter()
        .flatten()
        .collect()
}

impl Study {
    /// The best design that keeps the constraints, judged by integration; with several objectives
    /// the one best in the first. A study always has one.
    pub fn best(&self) -> Option<&Finalist> {
        self.finalists.first()
    }

    /// The best values of the runs that found one, as computed by the searches.
    pub fn values(&self) -> Vec<f64> {
        let value = |run: &SearchRun| Some(run.found.first()?.values[0]);
        self.runs.iter().filter_map(value).collect()
    }

    /// The distribution of the values over the runs.
    pub fn spread(&self) -> Option<FiveNumberSummary> {
        FiveNumberSummary::from_values(&self.values())
    }

    /// All designs that the genetic algorithm followed, and those that were integrated for want of
    /// a closed form.
    pub fn evaluations(&self) -> (usize, usize) {
        let sum = |of: fn(&SearchRun) -> usize| self.runs.iter().map(of).sum();
        (sum(|run| run.evaluations), sum(|run| run.integrated))
    }

    /// The median over the runs of the best value after each generation; runs that have ended keep
    /// theirs.
    pub fn median_curve(&self) -> Vec<f64> {
        let length = self.runs.iter().map(|run| run.curve.len()).max().unwrap_or(0);
        let at = |index: usize| {
            let last = |run: &SearchRun| run.curve.get(index).or(run.curve.last()).copied();
            let values: Vec<f64> = self.runs.iter().filter_map(last).collect();
            FiveNumberSummary::from_values(&values).map(|spread| spread.median)
        };
        (0..length).filter_map(at).collect()
    }

    /// The generation from which on the median was within this relative distance of its last value.
    pub fn generation_of_convergence(&self, part: f64) -> Option<usize> {
        let curve = self.median_curve();
        let last = *curve.last()?;
        curve.iter().position(|value| value - last <= part * last.abs())
    }

    /// The first objective.
    pub fn objective(&self) -> Objective {
        self.question.objectives.first().copied().unwrap_or(Objective::RestTime)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles_lie_between_the_values() {
        let spread = FiveNumberSummary::from_values(&[4.0, 1.0, 2.0, 3.0, 8.0]).unwrap();
        let numbers = [
            spread.best,
            spread.lower_quartile,
            spread.median,
            spread.upper_quartile,
            spread.worst,
        ];
        assert_eq!(numbers, [1.0, 2.0, 3.0, 4.0, 8.0]);
        assert_eq!(
            FiveNumberSummary::from_values(&[1.0, 2.0]).map(|spread| spread.lower_quartile),
            Some(1.25)
        );
        assert_eq!(FiveNumberSummary::from_values(&[]), None);
    }
}
