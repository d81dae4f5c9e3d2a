//! Several objectives at once: dominance, ranks and crowding distances.
//!
//! (K. Deb, A. Pratap, S. Agarwal and T. Meyarivan, *IEEE Trans. Evol. Comput.* 6 (2002) 182.)

use super::space::Evaluation;

/// Whether `one` is no worse in every objective and better in one; if either violates a constraint,
/// whether `one` violates them less.
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::genetic::{Evaluation, dominates};
///
/// let of = |objectives: &[f64]| Evaluation { objectives: objectives.to_vec(), ..Evaluation::default() };
/// assert!(dominates(&of(&[1.0, 2.0]), &of(&[1.0, 3.0]), 0.0));
/// assert!(!dominates(&of(&[1.0, 3.0]), &of(&[2.0, 2.0]), 0.0));
/// ```
pub fn dominates(one: &Evaluation, other: &Evaluation, tolerance: f64) -> bool {
    let (broken, of_other) = (one.violation(tolerance), other.violation(tolerance));
    if broken > 0.0 || of_other > 0.0 {
        return broken < of_other;
    }
    let pairs = || one.objectives.iter().zip(&other.objectives);
    pairs().all(|(one, other)| one <= other) && pairs().any(|(one, other)| one < other)
}

/// The rank of every individual: 0 if no other dominates it, 1 if only those of rank 0 do, and so
/// on.
pub fn ranks(all: &[&Evaluation], tolerance: f64) -> Vec<usize> {
    let count = all.len();
    let mut dominated: Vec<Vec<usize>> = vec![vec![]; count];
    let mut masters = vec![0_usize; count];
    for one in 0..count {
        for other in one + 1..count {
            if dominates(all[one], all[other], tolerance) {
                dominated[one].push(other);
                masters[other] += 1;
            } else if dominates(all[other], all[one], tolerance) {
                dominated[other].push(one);
                masters[one] += 1;
            }
        }
    }
    let mut ranks = vec![0; count];
    let mut front: Vec<usize> = (0..count).filter(|index| masters[*index] == 0).collect();
    let mut rank = 0;
    while !front.is_empty() {
        let mut next = Vec::new();
        for index in front {
            ranks[index] = rank;
            for below in &dominated[index] {
                masters[*below] -= 1;
                if masters[*below] == 0 {
                    next.push(*below);
                }
            }
        }
        front = next;
        rank += 1;
    }
    ranks
}

/// Returns the indices of the points that no other dominates; of equal ones only the first.
pub fn non_dominated(all: &[&Evaluation], tolerance: f64) -> Vec<usize> {
    let stands = |index: &usize| {
        let is_worse = |(place, other): (usize, &&Evaluation)| {
            dominates(other, all[*index], tolerance)
                || place < *index
                    && other.objectives == all[*index].objectives
                    && other.is_feasible(tolerance)
        };
        !all.iter().enumerate().any(is_worse)
    };
    (0..all.len()).filter(stands).collect()
}

/// Crowding distance of every individual: the sum over the objectives of the distance between its
/// neighbours on either side, as a fraction of the whole range; infinite at the ends.
pub fn crowding(all: &[&Evaluation]) -> Vec<f64> {
    let mut distance = vec![0.0; all.len()];
    let values = all.iter().map(|each| each.objectives.len()).max().unwrap_or(0);
    for value in 0..values {
        // A missing objective counts as infinite.
        let of = |index: usize| all[index].objectives.get(value).copied().unwrap_or(f64::INFINITY);
        let mut order: Vec<usize> = (0..all.len()).collect();
        order.sort_by(|one, other| of(*one).total_cmp(&of(*other)));
        let (Some(&first), Some(&last)) = (order.first(), order.last()) else {
            continue;
        };
        let range = of(last) - of(first);
        distance[first] = f64::INFINITY;
        distance[last] = f64::INFINITY;
        for neighbours in order.windows(3) {
            let gap = of(neighbours[2]) - of(neighbours[0]);
            distance[neighbours[1]] +=
                if range > 0.0 && range.is_finite() { gap / range } else { 0.0 };
        }
    }
    distance
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn of(values: &[Vec<f64>]) -> Vec<Evaluation> {
        let each = values.iter().map(|objectives| Evaluation {
            objectives: objectives.clone(),
            ..Evaluation::default()
        });
        each.collect()
    }

    proptest! {
        #[test]
        fn ranks_are_those_of_their_definition(
            values in prop::collection::vec(prop::collection::vec(0..6_i32, 3), 1..30)
        ) {
            let values: Vec<Vec<f64>> = values.iter().map(|row| row.iter().copied().map(f64::from).collect()).collect();
            let all = of(&values);
            let all: Vec<&Evaluation> = all.iter().collect();
            let ranks = ranks(&all, 0.0);
            for (one, rank) in all.iter().zip(&ranks) {
                let masters = all.iter().zip(&ranks).filter(|(other, _)| dominates(other, one, 0.0));
                let highest = masters.map(|(_, rank)| rank + 1).max().unwrap_or(0);
                prop_assert_eq!(*rank, highest);
            }
            let front = non_dominated(&all, 0.0);
            prop_assert!(front.iter().all(|index| ranks[*index] == 0));
            for index in (0..all.len()).filter(|index| ranks[*index] == 0) {
                prop_assert!(front.iter().any(|other| all[*other].objectives == all[index].objectives));
            }
        }
    }

    #[test]
    fn the_lonely_are_those_with_room_around_them() {
        let all = of(&[vec![0.0, 4.0], vec![1.0, 3.0], vec![1.5, 2.5], vec![4.0, 0.0]]);
        let found = crowding(&all.iter().collect::<Vec<_>>());
        assert!(found[0].is_infinite() && found[3].is_infinite());
        assert!((found[1] - 0.75).abs() < 1e-12 && (found[2] - 1.5).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn who_breaks_less_is_better() {
        let broken = |value: f64, by: f64| Evaluation {
            objectives: vec![value],
            equalities: vec![],
            inequalities: vec![by],
        };
        assert!(dominates(&broken(9.0, 0.1), &broken(1.0, 0.2), 0.0));
        assert!(dominates(&broken(9.0, -0.1), &broken(1.0, 0.2), 0.0));
        assert!(!dominates(&broken(1.0, 0.1), &broken(9.0, 0.0), 0.0));
    }
}
