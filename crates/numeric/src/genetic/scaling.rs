//! Fitness scaling: how often each individual is expected to be a parent.

/// Returns how often each individual is expected to be a parent, by its rank: the individual of
/// rank r, the best having rank 1, gets 1/sqrt(r), scaled so that the sum is the number of parents.
/// A smaller score is better; equal ones keep their order.
///
/// The differences of the scores play no part, and neither does the unit of the objective.
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::genetic::rank_scaling;
///
/// let expected = rank_scaling(&[3.0, -1.0, 7.0, f64::INFINITY], 10);
/// assert!((expected.iter().sum::<f64>() - 10.0).abs() < 1e-12);
/// assert!((expected[1] / expected[3] - 2.0).abs() < 1e-12); // rank 1 and rank 4
/// ```
pub fn rank_scaling(scores: &[f64], parents: usize) -> Vec<f64> {
    let mut order: Vec<usize> = (0..scores.len()).collect();
    order.sort_by(|one, other| scores[*one].total_cmp(&scores[*other]));
    let mut expected = vec![0.0; scores.len()];
    for (rank, index) in order.into_iter().enumerate() {
        expected[index] = 1.0 / ((rank + 1) as f64).sqrt();
    }
    let sum: f64 = expected.iter().sum();
    expected.iter_mut().for_each(|value| *value *= parents as f64 / sum);
    expected
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn only_the_order_of_the_scores_counts(scores in prop::collection::vec(-1e3..1e3_f64, 1..40), parents in 1..200_usize) {
            let expected = rank_scaling(&scores, parents);
            prop_assert!((expected.iter().sum::<f64>() / parents as f64 - 1.0).abs() < 1e-12);
            let stretched: Vec<f64> = scores.iter().map(|score| score.cbrt() + 5.0).collect();
            prop_assert_eq!(&expected, &rank_scaling(&stretched, parents));
            for (one, other) in scores.iter().zip(&expected).zip(scores.iter().zip(&expected).skip(1)) {
                prop_assert!(one.0 >= other.0 || one.1 > other.1);
            }
        }
    }
}
