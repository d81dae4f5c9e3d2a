//! Designs that a search comes back to: each is followed once.
//!
//! Most children of a genetic search that has come near its end lie in a corner of the box, or are
//! copies of their parents. In: points, and what follows those that are new. Out: the evaluation of
//! each, in their order. Cost: a look into a table for a point that is known.

use std::collections::{HashMap, HashSet};

use crate::genetic::Evaluation;

/// The evaluations of designs by their chains, and whether they were integrated instead, by the bits
/// of their points.
#[derive(Default)]
pub(super) struct KnownDesigns(HashMap<Vec<u64>, (Evaluation, bool)>);

impl KnownDesigns {
    /// The largest number of designs that are remembered, some ten megabytes.
    const MOST: usize = 30_000;

    /// The evaluations of these points: those that are not known are followed, each once.
    pub(super) fn recalled(
        &mut self,
        points: &[Vec<f64>],
        follow: impl FnOnce(&[Vec<f64>]) -> Vec<(Evaluation, bool)>,
    ) -> Vec<(Evaluation, bool)> {
        if self.0.len() + points.len() > Self::MOST {
            self.0.clear();
        }
        let bits = |point: &Vec<f64>| -> Vec<u64> { point.iter().map(|x| x.to_bits()).collect() };
        let keys: Vec<Vec<u64>> = points.iter().map(bits).collect();
        let mut seen = HashSet::new();
        let (mut new_keys, mut new_points) = (vec![], vec![]);
        for (key, point) in keys.iter().zip(points) {
            if !self.0.contains_key(key) && seen.insert(key) {
                new_keys.push(key.clone());
                new_points.push(point.clone());
            }
        }
        self.0.extend(new_keys.into_iter().zip(follow(&new_points)));
        keys.iter().filter_map(|key| self.0.get(key).cloned()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_points_are_followed_once() {
        let mut known = KnownDesigns::default();
        let mut followed = vec![];
        let mut recalled = |numbers: &[f64]| -> Vec<f64> {
            let points: Vec<Vec<f64>> = numbers.iter().map(|x| vec![*x, 1.0]).collect();
            let found = known.recalled(&points, |points| {
                followed.extend(points.iter().map(|point| point[0]));
                let square = |point: &Vec<f64>| Evaluation::unconstrained(point[0] * point[0]);
                points.iter().map(|point| (square(point), false)).collect()
            });
            found.iter().map(|(evaluation, _)| evaluation.value()).collect()
        };
        assert_eq!(recalled(&[1.0, 2.0, 1.0]), [1.0, 4.0, 1.0]);
        assert_eq!(recalled(&[2.0, 3.0, 3.0, 1.0]), [4.0, 9.0, 9.0, 1.0]);
        assert_eq!(followed, [1.0, 2.0, 3.0]);
    }
}
