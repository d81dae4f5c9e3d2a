//! NSGA-II: a population that spreads along the front of several values.
//!
//! (K. Deb, A. Pratap, S. Agarwal and T. Meyarivan, *IEEE Trans. Evol. Comput.* 6 (2002) 182;
//! simulated binary crossover: K. Deb and R. B. Agrawal, *Complex Systems* 9 (1995) 115.) Parents
//! are chosen by tournaments of two: the lower rank wins, and of equal ranks the larger crowding
//! distance. The better half of parents and children together goes on to the next generation. Genes
//! are numbers.

use rand::{Rng, RngExt};

use super::pareto::{crowding, non_dominated, ranks};
use super::population::{GeneticOptions, GeneticRun, Individual};
use super::space::{Evaluation, Space};
use super::stopping::GeneticStop;

/// Distribution index of the simulated binary crossover: the larger it is, the nearer the children
/// are to their parents.
const CROSSOVER_INDEX: f64 = 15.0;

/// Distribution index of the polynomial mutation.
const MUTATION_INDEX: f64 = 20.0;

/// The probability that two parents are crossed at all.
const CROSSED: f64 = 0.9;

/// Returns one of two children by simulated binary crossover, kept in the box. The mean of the two
/// is the mean of the parents; the ratio of their distance to that of the parents is distributed as
/// in the crossover of strings of bits.
pub fn simulated_binary(
    one: &[f64],
    other: &[f64],
    space: &Space,
    generator: &mut impl Rng,
) -> Vec<f64> {
    let gene = |((one, other), [lower, upper]): ((&f64, &f64), &[f64; 2])| {
        let part: f64 = generator.random();
        let power = 1.0 / (CROSSOVER_INDEX + 1.0);
        let spread = match part < 0.5 {
            true => (2.0 * part).powf(power),
            false => (0.5 / (1.0 - part)).powf(power),
        };
        let sign = if generator.random::<bool>() { 1.0 } else { -1.0 };
        (0.5 * (one + other) + sign * 0.5 * spread * (one - other)).clamp(*lower, *upper)
    };
    one.iter().zip(other).zip(space.bounds()).map(gene).collect()
}

/// Returns the parent with each of its n numbers changed with the probability 1/n, by a mostly
/// small part of its range; kept in the box.
pub fn polynomial_mutation(parent: &[f64], space: &Space, generator: &mut impl Rng) -> Vec<f64> {
    let rate = 1.0 / parent.len().max(1) as f64;
    let gene = |(x, [lower, upper]): (&f64, &[f64; 2])| {
        if generator.random::<f64>() >= rate {
            return *x;
        }
        let part: f64 = generator.random();
        let power = 1.0 / (MUTATION_INDEX + 1.0);
        let change = match part < 0.5 {
            true => (2.0 * part).powf(power) - 1.0,
            false => 1.0 - (2.0 * (1.0 - part)).powf(power),
        };
        (x + change * (upper - lower)).clamp(*lower, *upper)
    };
    parent.iter().zip(space.bounds()).map(gene).collect()
}

/// Runs NSGA-II and returns the feasible individuals of its last front, and the record of the run.
///
/// `evaluate` takes all new points of a generation at once. Of the options only the population, the generations, the budget and the tolerance of constraints
/// are used. The curve is the number of feasible individuals in the front, generation by
/// generation.
pub fn search_front(
    space: &Space,
    mut evaluate: impl FnMut(&[Vec<f64>]) -> Vec<Evaluation>,
    options: &GeneticOptions,
    generator: &mut impl Rng,
    go_on: &mut dyn FnMut(usize) -> bool,
) -> (Vec<Individual>, GeneticRun) {
    let (size, tolerance) = (options.population, options.constraint_tolerance);
    let mut evaluations = 0;
    let mut born = |points: Vec<Vec<f64>>| {
        let evaluations = evaluate(&points);
        let born = points.into_iter().zip(evaluations);
        born.map(|(point, evaluation)| Individual { point, evaluation }).collect::<Vec<_>>()
    };
    let mut population = born((0..size).map(|_| space.draw(generator)).collect());
    evaluations += size;
    let (mut standing, mut loneliness) = ranks_and_crowding(&population, tolerance);
    let mut curve = vec![front_size(&population, &standing, tolerance)];
    let mut generation = 0;
    let stop = loop {
        if generation >= options.generations {
            break GeneticStop::Generations;
        }
        if options.budget.is_some_and(|budget| evaluations + size > budget) {
            break GeneticStop::Budget;
        }
        if !go_on(generation + 1) {
            break GeneticStop::Interrupted;
        }
        let winner = |generator: &mut _| {
            let [one, other] = [0, 1].map(|_| RngExt::random_range(generator, 0..size));
            let by_rank = standing[one].cmp(&standing[other]);
            match by_rank.then(loneliness[other].total_cmp(&loneliness[one])).is_le() {
                true => one,
                false => other,
            }
        };
        let mut children = Vec::with_capacity(size);
        while children.len() < size {
            let [one, other] = [0, 1].map(|_| &population[winner(generator)].point);
            let child = match generator.random::<f64>() < CROSSED {
                true => simulated_binary(one, other, space, generator),
                false => one.clone(),
            };
            children.push(polynomial_mutation(&child, space, generator));
        }
        population.extend(born(children));
        evaluations += size;
        let (all, lonely) = ranks_and_crowding(&population, tolerance);
        let mut order: Vec<usize> = (0..population.len()).collect();
        order.sort_by(|one, other| {
            all[*one].cmp(&all[*other]).then(lonely[*other].total_cmp(&lonely[*one]))
        });
        order.truncate(size);
        let mut places: Vec<Option<Individual>> = population.into_iter().map(Some).collect();
        population = order.iter().filter_map(|index| places[*index].take()).collect();
        (standing, loneliness) = ranks_and_crowding(&population, tolerance);
        curve.push(front_size(&population, &standing, tolerance));
        generation += 1;
    };
    let all: Vec<&Evaluation> = population.iter().map(|member| &member.evaluation).collect();
    let front = non_dominated(&all, tolerance);
    let front = front.into_iter().map(|index| population[index].clone());
    let front: Vec<Individual> =
        front.filter(|member| member.evaluation.is_feasible(tolerance)).collect();
    let run = GeneticRun {
        best: front.first().cloned(),
        curve,
        generations: generation,
        evaluations,
        stop,
    };
    (front, run)
}

/// Returns the rank of every individual, and its crowding distance among those of the same rank.
fn ranks_and_crowding(population: &[Individual], tolerance: f64) -> (Vec<usize>, Vec<f64>) {
    let all: Vec<&Evaluation> = population.iter().map(|member| &member.evaluation).collect();
    let ranks = ranks(&all, tolerance);
    let mut lonely = vec![0.0; all.len()];
    for rank in 0..=ranks.iter().copied().max().unwrap_or(0) {
        let same: Vec<usize> = (0..all.len()).filter(|index| ranks[*index] == rank).collect();
        let of_rank: Vec<&Evaluation> = same.iter().map(|index| all[*index]).collect();
        for (index, distance) in same.iter().zip(crowding(&of_rank)) {
            lonely[*index] = distance;
        }
    }
    (ranks, lonely)
}

/// Number of feasible individuals in the first front.
fn front_size(population: &[Individual], ranks: &[usize], tolerance: f64) -> f64 {
    let standing = population.iter().zip(ranks);
    let front =
        standing.filter(|(member, rank)| **rank == 0 && member.evaluation.is_feasible(tolerance));
    front.count() as f64
}

#[cfg(test)]
mod tests {
    use super::super::generator;
    use super::super::population::one_by_one;
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn children_stay_in_the_box_and_between_equal_parents(part in 0.0..=1.0_f64, other in 0.0..=1.0_f64, seed in any::<u64>()) {
            let space = Space::new(vec![[-3.0, 5.0]; 3]).unwrap();
            let (one, other) = (space.point_at(&[part; 3]), space.point_at(&[other; 3]));
            let mut generator = generator(seed, 0);
            prop_assert!(space.contains(&simulated_binary(&one, &other, &space, &mut generator)));
            let same = simulated_binary(&one, &one, &space, &mut generator);
            prop_assert!(same.iter().zip(&one).all(|(child, parent)| (child - parent).abs() < 1e-12));
            prop_assert!(space.contains(&polynomial_mutation(&one, &space, &mut generator)));
        }
    }

    /// Schaffer's problem, x^2 and (x - 2)^2: the front is 0 <= x <= 2, where sqrt(f1) + sqrt(f2) =
    /// 2.
    #[test]
    fn a_known_front_is_found_and_covered() {
        let space = Space::new(vec![[-100.0, 100.0]]).unwrap();
        let schaffer = |point: &[f64]| Evaluation {
            objectives: vec![point[0].powi(2), (point[0] - 2.0).powi(2)],
            ..Evaluation::default()
        };
        let options = GeneticOptions { generations: 60, ..GeneticOptions::default() };
        let (front, run) =
            search_front(&space, one_by_one(schaffer), &options, &mut generator(1, 0), &mut |_| {
                true
            });
        assert!(front.len() > 80 && run.evaluations == 6100, "{}", front.len());
        let mut places: Vec<f64> = front.iter().map(|member| member.point[0]).collect();
        places.sort_by(f64::total_cmp);
        assert!(places[0] > -0.02 && *places.last().unwrap() < 2.02, "{places:?}");
        assert!(places.windows(2).all(|pair| pair[1] - pair[0] < 0.15), "{places:?}");
        for member in &front {
            let sum: f64 = member.evaluation.objectives.iter().map(|value| value.sqrt()).sum();
            assert!((sum - 2.0).abs() < 0.05, "{member:?}");
        }
    }
}
