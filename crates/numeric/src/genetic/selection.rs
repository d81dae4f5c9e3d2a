//! Selection of parents.

use rand::seq::SliceRandom;
use rand::{Rng, RngExt};

/// Returns the indices of the parents, in random order, by stochastic uniform selection: the
/// weights are laid end to end on a line, along which equal steps are taken from a random place in
/// the first one; each step chooses the individual in whose part it ends.
///
/// This is Baker's stochastic universal sampling: of n parents, an individual with the share w of
/// all weights is chosen n w times, rounded down or up.
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::genetic::{generator, stochastic_uniform};
///
/// let mut parents = stochastic_uniform(&[2.0, 0.0, 1.0], 6, &mut generator(1, 0));
/// parents.sort();
/// assert_eq!(parents, [0, 0, 0, 0, 2, 2]);
/// ```
pub fn stochastic_uniform(weights: &[f64], parents: usize, generator: &mut impl Rng) -> Vec<usize> {
    let step = weights.iter().sum::<f64>() / parents as f64;
    let mut place = step * generator.random::<f64>();
    let (mut chosen, mut end) = (Vec::with_capacity(parents), 0.0);
    for (index, weight) in weights.iter().enumerate() {
        end += weight;
        while place < end && chosen.len() < parents {
            chosen.push(index);
            place += step;
        }
    }
    // Rounding may leave the last step beyond the end.
    let last = weights.iter().rposition(|weight| *weight > 0.0).unwrap_or_default();
    chosen.resize(parents, last);
    chosen.shuffle(generator);
    chosen
}

#[cfg(test)]
mod tests {
    use super::super::generator;
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn everyone_is_chosen_as_often_as_expected_to_the_whole_number(
            weights in prop::collection::vec(0.0..10.0_f64, 1..30), parents in 1..300_usize, seed in any::<u64>()
        ) {
            let sum: f64 = weights.iter().sum();
            prop_assume!(sum > 1e-3);
            let chosen = stochastic_uniform(&weights, parents, &mut generator(seed, 0));
            prop_assert_eq!(chosen.len(), parents);
            for (index, weight) in weights.iter().enumerate() {
                let count = chosen.iter().filter(|parent| **parent == index).count() as f64;
                let expected = parents as f64 * weight / sum;
                prop_assert!(count > expected - 1.0 - 1e-9 && count < expected + 1.0 + 1e-9, "{count} of {expected}");
            }
        }
    }

    #[test]
    fn the_order_is_random() {
        let chosen = stochastic_uniform(&[1.0; 50], 50, &mut generator(3, 0));
        assert!(chosen.windows(2).any(|pair| pair[0] > pair[1]));
    }
}
