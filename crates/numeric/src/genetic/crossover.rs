//! Crossover: a child of two parents.

use rand::{Rng, RngExt};

use super::space::Space;

/// The operator that makes a child of two parents.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Crossover {
    /// The child lies on the line from the worse to the better parent, beyond it: [`heuristic`],
    /// with this ratio.
    Heuristic(f64),
    /// Every gene comes from either parent by chance: [`scattered`].
    Scattered,
    /// The first genes come from one parent, the others from the other: [`one_point`].
    OnePoint,
}

impl Default for Crossover {
    fn default() -> Self {
        Self::Heuristic(1.2)
    }
}

/// Returns the child worse + R (better - worse), where R is the ratio or, if that leaves the box,
/// the largest R below it that does not.
///
/// This is Wright's heuristic crossover, kept feasible; it draws no random number.
///
/// With both parents in the box and a ratio of 1 or more, R is at least 1.
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::genetic::{Space, heuristic};
///
/// let space = Space::new(vec![[0.0, 1.0], [0.0, 1.0]])?;
/// assert_eq!(heuristic(&[0.0, 0.0], &[0.5, 0.25], 1.2, &space), [0.6, 0.3]);
/// assert_eq!(heuristic(&[0.0, 0.0], &[1.0, 0.25], 1.2, &space), [1.0, 0.25]); // no farther
/// # Ok::<(), lindstedt::genetic::SearchError>(())
/// ```
pub fn heuristic(worse: &[f64], better: &[f64], ratio: f64, space: &Space) -> Vec<f64> {
    let mut reach = ratio;
    for ((from, to), [lower, upper]) in worse.iter().zip(better).zip(space.bounds()) {
        let way = to - from;
        let room = if way > 0.0 { upper - from } else { lower - from };
        if way != 0.0 {
            reach = reach.min(room / way);
        }
    }
    let place = |((from, to), [lower, upper]): ((&f64, &f64), &[f64; 2])| {
        // Rounding may carry the child just outside the box.
        (from + reach * (to - from)).clamp(*lower, *upper)
    };
    worse.iter().zip(better).zip(space.bounds()).map(place).collect()
}

/// Returns a child that has every gene from either parent with probability 1/2.
pub fn scattered(one: &[f64], other: &[f64], generator: &mut impl Rng) -> Vec<f64> {
    let gene = |(one, other): (&f64, &f64)| {
        if generator.random::<bool>() { *one } else { *other }
    };
    one.iter().zip(other).map(gene).collect()
}

/// Returns a child with the genes up to a random place from one parent and those after it from the
/// other. If there are two genes or more, each parent gives at least one.
pub fn one_point(one: &[f64], other: &[f64], generator: &mut impl Rng) -> Vec<f64> {
    let shared = one.len().min(other.len());
    if shared < 2 {
        return one.to_vec();
    }
    let place = generator.random_range(1..shared);
    one[..place].iter().chain(&other[place..]).copied().collect()
}

#[cfg(test)]
mod tests {
    use super::super::generator;
    use super::*;
    use proptest::prelude::*;

    fn box_of(count: usize) -> Space {
        Space::new((0..count).map(|index| [-(index as f64), 2.5]).collect()).unwrap()
    }

    proptest! {
        #[test]
        fn a_heuristic_child_lies_on_the_line_beyond_the_better_parent_and_in_the_box(
            parts in prop::collection::vec((0.0..=1.0_f64, 0.0..=1.0_f64), 1..8), ratio in 1.0..3.0_f64
        ) {
            let space = box_of(parts.len());
            let (worse, better): (Vec<f64>, Vec<f64>) = parts.iter().copied().unzip();
            let (worse, better) = (space.point_at(&worse), space.point_at(&better));
            let child = heuristic(&worse, &better, ratio, &space);
            prop_assert!(space.contains(&child));
            let widest = (0..parts.len()).max_by(|one, other| {
                let way = |index: usize| (better[index] - worse[index]).abs();
                way(*one).total_cmp(&way(*other))
            }).unwrap();
            let way = better[widest] - worse[widest];
            prop_assume!(way.abs() > 1e-6);
            let reach = (child[widest] - worse[widest]) / way;
            prop_assert!(reach > 1.0 - 1e-9 && reach < ratio + 1e-9, "{reach}");
            for index in 0..parts.len() {
                let expected = worse[index] + reach * (better[index] - worse[index]);
                prop_assert!((child[index] - expected).abs() < 1e-6);
            }
            // As far as allowed: at the ratio, or at a wall.
            let at = |x: &f64, wall: &f64| (x - wall).abs() < 1e-9;
            let at_wall = child.iter().zip(space.bounds()).any(|(x, bounds)| bounds.iter().any(|wall| at(x, wall)));
            prop_assert!(at_wall || reach > ratio - 1e-9);
        }

        #[test]
        fn genes_come_from_the_parents(seed in any::<u64>(), count in 1..60_usize) {
            let (one, other) = (vec![0.0; count], vec![1.0; count]);
            let mut generator = generator(seed, 0);
            prop_assert!(scattered(&one, &other, &mut generator).iter().all(|gene| [0.0, 1.0].contains(gene)));
            let child = one_point(&one, &other, &mut generator);
            prop_assert_eq!(child.len(), count);
            let changes = child.windows(2).filter(|pair| pair[0] != pair[1]).count();
            prop_assert_eq!(changes, usize::from(count > 1));
        }
    }

    #[test]
    fn half_of_the_genes_come_from_either_parent() {
        let child = scattered(&[0.0; 10_000], &[1.0; 10_000], &mut generator(1, 0));
        let sum: f64 = child.iter().sum();
        // Four standard deviations.
        assert!((sum - 5000.0).abs() < 200.0, "{sum}");
    }
}
