//! Mutation: a child of one parent.
//!
//! Adaptive feasible mutation is a name without a published algorithm. Ours, in the manner of
//! mesh-adaptive direct search (C. Audet and J. E. Dennis, *SIAM J. Optim.* 17 (2006) 188), does
//! what the name says: directions adapt to the last successful or unsuccessful generation, and
//! every step stays in the box.
//!
//! ```text
//! D = 1 for the first two generations; then D <- min(1, 4 D) where the best score has improved, else D <- max(1e-6, D/4)
//! directions: the columns of a random lower triangular matrix of whole numbers of size 1/sqrt(D) at most, of exactly that on the
//!             diagonal, rows and columns permuted
//! try x + D s d and x - D s d, s the ranges of the box, in random order: the first in the box is the child
//! if none is, halve D for this child, eight times at most, then keep x
//! ```
//!
//! A step is therefore about sqrt(D) times the size of the box, and the smaller it is, the more
//! directions are possible.

use rand::seq::SliceRandom;
use rand::{Rng, RngExt};

use super::space::Space;

/// The operator that makes a child of one parent.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum Mutation {
    /// [`adaptive_feasible`].
    #[default]
    AdaptiveFeasible,
    /// [`bit_flips`], each with this probability.
    BitFlips(f64),
}

/// The smallest value of D.
pub const SMALLEST_STEP: f64 = 1e-6;

/// Largest number of halvings of D for one child.
const MOST_HALVINGS: usize = 8;

/// Returns D of the generation after `generation`, which is counted from 0.
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::genetic::next_step;
///
/// assert_eq!([next_step(1.0, 0, false), next_step(1.0, 1, false), next_step(0.25, 7, true)], [1.0, 0.25, 1.0]);
/// ```
pub fn next_step(step: f64, generation: usize, improved: bool) -> f64 {
    match (generation, improved) {
        (0, _) => 1.0,
        (_, true) => (4.0 * step).min(1.0),
        (_, false) => (0.25 * step).max(SMALLEST_STEP),
    }
}

/// Returns a child in the box near its parent, by the algorithm of this module with D = `step`; the
/// parent itself if no step fits.
pub fn adaptive_feasible(
    parent: &[f64],
    step: f64,
    space: &Space,
    generator: &mut impl Rng,
) -> Vec<f64> {
    let mut step = step;
    for _ in 0..=MOST_HALVINGS {
        let mut trials: Vec<(Vec<f64>, f64)> = directions(parent.len(), step, generator)
            .into_iter()
            .flat_map(|direction| [(direction.clone(), step), (direction, -step)])
            .collect();
        trials.shuffle(generator);
        for (direction, step) in trials {
            let moved = parent.iter().zip(&direction).zip(space.bounds());
            let child: Vec<f64> = moved
                .map(|((x, part), [lower, upper])| x + step * part * (upper - lower))
                .collect();
            if space.contains(&child) {
                return child;
            }
        }
        step *= 0.5;
    }
    parent.to_vec()
}

/// Returns `count` linearly independent directions, each with `count` whole numbers.
fn directions(count: usize, step: f64, generator: &mut impl Rng) -> Vec<Vec<f64>> {
    // The floor of 1/sqrt(D), safe from a rounding error just below a whole number.
    let size = (1.0 / step.sqrt() + 1e-9).floor().max(1.0) as i64;
    let mut rows: Vec<usize> = (0..count).collect();
    rows.shuffle(generator);
    let mut columns = vec![vec![0.0; count]; count];
    for (column, direction) in columns.iter_mut().enumerate() {
        for (row, place) in rows.iter().enumerate().skip(column) {
            direction[*place] = match row == column {
                true if generator.random::<bool>() => size as f64,
                true => -(size as f64),
                false => generator.random_range(-size..=size) as f64,
            };
        }
    }
    columns.shuffle(generator);
    columns
}

/// Returns the bits of the parent, each flipped with the probability `rate`.
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::genetic::{bit_flips, generator};
///
/// assert_eq!(bit_flips(&[0.0, 1.0], 1.0, &mut generator(1, 0)), [1.0, 0.0]);
/// ```
pub fn bit_flips(parent: &[f64], rate: f64, generator: &mut impl Rng) -> Vec<f64> {
    let flip = |bit: &f64| {
        if generator.random::<f64>() < rate { 1.0 - bit } else { *bit }
    };
    parent.iter().map(flip).collect()
}

#[cfg(test)]
mod tests {
    use super::super::generator;
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_mutant_is_another_point_of_the_box_about_as_far_as_the_step(
            parts in prop::collection::vec(0.0..=1.0_f64, 1..8), quarterings in 0..10, seed in any::<u64>()
        ) {
            let space = Space::new(parts.iter().map(|_| [-2.0, 3.0]).collect()).unwrap();
            let parent = space.point_at(&parts);
            let step = 0.25_f64.powi(quarterings);
            let child = adaptive_feasible(&parent, step, &space, &mut generator(seed, 0));
            prop_assert!(space.contains(&child));
            let farthest = parent.iter().zip(&child).map(|(one, other)| (one - other).abs() / 5.0).fold(0.0, f64::max);
            prop_assert!(farthest <= step.sqrt() * (1.0 + 1e-9), "{farthest}");
            // In the middle of the box the first direction fits from a quarter on: one coordinate
            // moves by the whole size.
            if quarterings > 0 && parts.iter().all(|part| (part - 0.5).abs() <= 0.5 - step.sqrt()) {
                prop_assert!(farthest >= step.sqrt() * (1.0 - 1e-6), "{farthest}");
            }
        }

        #[test]
        fn the_directions_span_the_space(count in 1..7_usize, quarterings in 0..8, seed in any::<u64>()) {
            let step = 0.25_f64.powi(quarterings);
            let columns = directions(count, step, &mut generator(seed, 0));
            let size = (1.0 / step.sqrt()).round();
            let matrix = nalgebra::DMatrix::from_fn(count, count, |row, column| columns[column][row]);
            // Triangular but for the order of rows and columns: the determinant is the product of
            // the diagonal.
            let determinant = matrix.determinant().abs() / size.powi(count as i32);
            prop_assert!((determinant - 1.0).abs() < 1e-6, "{determinant}");
            prop_assert!(columns.iter().flatten().all(|entry| entry.abs() <= size && entry.fract() == 0.0));
        }
    }

    #[test]
    fn a_parent_in_a_corner_still_has_children() {
        let space = Space::new(vec![[0.0, 1.0]; 4]).unwrap();
        let moved = (0..200).filter(|seed| {
            let child =
                adaptive_feasible(&[0.0, 1.0, 0.0, 1.0], 1e-4, &space, &mut generator(*seed, 0));
            child != [0.0, 1.0, 0.0, 1.0]
        });
        assert!(moved.count() > 100);
    }

    #[test]
    fn bits_turn_over_as_often_as_told() {
        let child = bit_flips(&[0.0; 100_000], 0.01, &mut generator(1, 0));
        let sum: f64 = child.iter().sum();
        // Four standard deviations.
        assert!((sum - 1000.0).abs() < 126.0, "{sum}");
    }

    #[test]
    fn the_step_adapts() {
        let steps = [true, false, false, false, true].iter().enumerate();
        let mut step = 1.0;
        let found = steps.map(|(generation, improved)| {
            step = next_step(step, generation, *improved);
            step
        });
        assert_eq!(found.collect::<Vec<_>>(), [1.0, 0.25, 0.0625, 0.015_625, 0.0625]);
        assert_eq!(next_step(SMALLEST_STEP, 9, false), SMALLEST_STEP);
    }
}
