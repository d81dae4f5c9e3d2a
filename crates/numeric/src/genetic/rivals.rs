//! Baselines for a genetic algorithm: random points, and differential evolution.
//!
//! The latter is that of the crate `basin`, DE/rand/1/bin with its default weights (R. Storn and K.
//! Price, *J. Glob. Optim.* 11 (1997) 341). Both get the same number of evaluations; constraints by
//! the rule that feasible points come first.

use std::cell::RefCell;
use std::convert::Infallible;

use basin::PopulationProgress;
use basin::{
    BoxBounds, ConstraintDescription, ConstraintSet, Constraints, CostFunction, De, Executor,
};
use rand::Rng;

use super::population::{GeneticRun, Individual};
use super::space::{Evaluation, Space};
use super::stopping::GeneticStop;

/// Evaluates points, and keeps the best of them and the curve of its value.
struct BestTracker<F> {
    evaluate: F,
    tolerance: f64,
    every: usize,
    best: Option<Individual>,
    curve: Vec<f64>,
    count: usize,
}

impl<F: FnMut(&[Vec<f64>]) -> Vec<Evaluation>> BestTracker<F> {
    fn new(evaluate: F, tolerance: f64, every: usize) -> Self {
        Self { evaluate, tolerance, every, best: None, curve: vec![], count: 0 }
    }

    fn evaluate_points(&mut self, points: &[Vec<f64>]) -> Vec<Evaluation> {
        let evaluations = (self.evaluate)(points);
        for (point, evaluation) in points.iter().zip(&evaluations) {
            self.count += 1;
            let better = |best: &Individual| evaluation.value() < best.evaluation.value();
            if evaluation.is_feasible(self.tolerance) && self.best.as_ref().is_none_or(better) {
                self.best =
                    Some(Individual { point: point.clone(), evaluation: evaluation.clone() });
            }
            if self.count.is_multiple_of(self.every) {
                self.curve.push(self.value());
            }
        }
        evaluations
    }

    fn value(&self) -> f64 {
        self.best.as_ref().map_or(f64::INFINITY, |best| best.evaluation.value())
    }

    fn finish(self, stop: GeneticStop) -> GeneticRun {
        GeneticRun {
            generations: self.curve.len(),
            evaluations: self.count,
            best: self.best,
            curve: self.curve,
            stop,
        }
    }
}

/// Draws `evaluations` points evenly from the box, and evaluates `every` of them at once; the curve
/// has the best value after each time.
pub fn random_search(
    space: &Space,
    evaluate: impl FnMut(&[Vec<f64>]) -> Vec<Evaluation>,
    (evaluations, every): (usize, usize),
    tolerance: f64,
    generator: &mut impl Rng,
) -> GeneticRun {
    let every = every.max(1);
    let mut watch = BestTracker::new(evaluate, tolerance, every);
    let mut left = evaluations;
    while left > 0 {
        let count = left.min(every);
        let points: Vec<Vec<f64>> = (0..count).map(|_| space.draw(generator)).collect();
        watch.evaluate_points(&points);
        left -= count;
    }
    watch.finish(GeneticStop::Budget)
}

/// The problem in the form that `basin` expects.
struct Boxed<F> {
    watch: RefCell<BestTracker<F>>,
    lower: Vec<f64>,
    upper: Vec<f64>,
}

impl<F> Constraints for &Boxed<F> {
    type Set = ConstraintSet<BoxBounds<Vec<f64>>>;

    fn constraints(&self) -> <Self::Set as ConstraintDescription>::Borrowed<'_> {
        ConstraintSet::new().with_bounds(BoxBounds::new(Some(&self.lower), Some(&self.upper)))
    }
}

/// Cost of a point that violates a constraint or has no value: larger than that of any other point,
/// and finite.
const BROKEN: f64 = 1e100;

impl<F: FnMut(&[Vec<f64>]) -> Vec<Evaluation>> CostFunction for &Boxed<F> {
    type Param = Vec<f64>;
    type Output = f64;
    type Error = Infallible;

    fn cost(&self, point: &Vec<f64>) -> Result<f64, Infallible> {
        let mut watch = self.watch.borrow_mut();
        let tolerance = watch.tolerance;
        let found = watch.evaluate_points(std::slice::from_ref(point));
        Ok(match found.first().map(|own| (own.violation(tolerance), own.value())) {
            Some((0.0, value)) if value.is_finite() => value.clamp(-BROKEN, BROKEN),
            Some((violation, _)) => BROKEN * (1.0 + violation.min(1e6)),
            None => BROKEN,
        })
    }
}

/// Differential evolution with ten individuals for every variable, for about this many evaluations.
/// The curve has the best value after every `every` evaluations.
pub fn differential_evolution(
    space: &Space,
    evaluate: impl FnMut(&[Vec<f64>]) -> Vec<Evaluation>,
    (evaluations, every): (usize, usize),
    tolerance: f64,
    seed: u64,
) -> GeneticRun {
    let (lower, upper): (Vec<f64>, Vec<f64>) =
        space.bounds().iter().map(|[lower, upper]| (*lower, *upper)).unzip();
    let size = De::<f64>::default_pop_size(lower.len()).min(evaluations / 2).max(4);
    let problem = Boxed {
        watch: RefCell::new(BestTracker::new(evaluate, tolerance, every.max(1))),
        lower,
        upper,
    };
    // The initial population costs as much as a generation.
    let generations = (evaluations / size).saturating_sub(1).max(1) as u64;
    let start = PopulationProgress::<Vec<f64>>::empty();
    // The run cannot fail: the bounds are in order, and a cost is always a finite number. The
    // result is in the tracker.
    let ended = Executor::new(&problem, De::new(seed).with_pop_size(size), start)
        .max_iter(generations)
        .run();
    drop(ended);
    problem.watch.into_inner().finish(GeneticStop::Budget)
}

#[cfg(test)]
mod tests {
    use super::super::generator;
    use super::super::population::one_by_one;
    use super::*;

    #[test]
    fn both_use_their_budget_and_one_of_them_finds_the_valley() {
        let space = Space::new(vec![[-5.0, 5.0]; 4]).unwrap();
        let bowl = |point: &[f64]| {
            Evaluation::unconstrained(point.iter().map(|x| (x - 1.0).powi(2)).sum())
        };
        let drawn =
            random_search(&space, one_by_one(bowl), (4000, 100), 1e-3, &mut generator(1, 0));
        assert_eq!((drawn.evaluations, drawn.curve.len()), (4000, 40));
        let evolved = differential_evolution(&space, one_by_one(bowl), (4000, 100), 1e-3, 1);
        assert_eq!((evolved.evaluations, evolved.curve.len()), (4000, 40));
        let [drawn, evolved] =
            [drawn, evolved].map(|run| run.best.expect("a point").evaluation.value());
        assert!(evolved < 1e-3 && evolved < drawn, "{evolved} {drawn}");
    }

    #[test]
    fn points_that_break_constraints_are_not_the_best() {
        let space = Space::new(vec![[0.0, 1.0]; 2]).unwrap();
        let beyond = |point: &[f64]| Evaluation {
            objectives: vec![point[0] + point[1]],
            equalities: vec![],
            inequalities: vec![0.5 - point[0]],
        };
        let never = |_: &[f64]| Evaluation::unconstrained(f64::INFINITY);
        for best in [
            random_search(&space, one_by_one(beyond), (500, 100), 1e-3, &mut generator(1, 0)).best,
            differential_evolution(&space, one_by_one(beyond), (500, 100), 1e-3, 1).best,
        ] {
            assert!(best.expect("a point").point[0] >= 0.5);
        }
        assert_eq!(
            differential_evolution(&space, one_by_one(never), (500, 100), 1e-3, 1).best,
            None
        );
    }
}
