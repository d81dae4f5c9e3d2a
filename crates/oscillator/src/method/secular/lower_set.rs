//! The points at which an expansion with symbols is formed, and the way back to its coefficients.
//!
//! Reference: N. Dyn and M. S. Floater, *Multivariate polynomial interpolation on lower sets*,
//! J. Approx. Theory 177 (2014) 34-42.

use std::collections::HashMap;

use crate::exact::Monomial;

/// All exponents with `sum weight exponent <= highest`, those of lower weight first.
pub(super) struct LowerSet {
    /// One list of exponents for each point; that of the group whose value is one is zero.
    pub points: Vec<Vec<usize>>,
    /// Number of points of each order.
    pub counts: Vec<usize>,
    /// The indices of all points along each line in the direction of a group, from exponent zero
    /// on.
    pub lines: Vec<Vec<Vec<usize>>>,
}

impl LowerSet {
    pub fn new(weights: &[usize], base: usize, highest: usize, most: usize) -> Option<Self> {
        let mut of_weight: Vec<Vec<Vec<usize>>> = vec![vec![]; highest + 1];
        of_weight[0].push(vec![0; weights.len()]);
        for (group, weight) in weights.iter().enumerate().filter(|(group, _)| *group != base) {
            for total in *weight..=highest {
                let more: Vec<Vec<usize>> = of_weight[total - weight]
                    .iter()
                    .map(|exponents| {
                        let mut more = exponents.clone();
                        more[group] += 1;
                        more
                    })
                    .collect();
                of_weight[total].extend(more);
                if of_weight[total].len() > most {
                    return None;
                }
            }
        }
        let counts = of_weight.iter().scan(0, |count, own| {
            *count += own.len();
            Some(*count)
        });
        let counts: Vec<usize> = counts.collect();
        let points: Vec<Vec<usize>> = of_weight.into_iter().flatten().collect();
        if points.len() > most {
            return None;
        }
        let place: HashMap<&[usize], usize> =
            points.iter().enumerate().map(|(place, point)| (&point[..], place)).collect();
        let line = |start: &Vec<usize>, group: usize| -> Vec<usize> {
            let mut point = start.clone();
            let mut next = || {
                let found = place.get(&point[..]).copied();
                point[group] += 1;
                found
            };
            std::iter::from_fn(&mut next).collect()
        };
        let lines = (0..weights.len())
            .map(|group| {
                let starts = points.iter().filter(|point| point[group] == 0 && group != base);
                starts.map(|start| line(start, group)).collect()
            })
            .collect();
        Some(Self { points, counts, lines })
    }

    /// Interpolation from values at the points of an order, `numbers` side by side at each, to
    /// coefficients, in place; `None` if a number does not fit.
    pub fn interpolate<T: Copy>(
        &self,
        field: &PointField<T, impl Fn(T, T) -> Option<T>, impl Fn(T, T) -> Option<T>>,
        order: usize,
        values: &mut [T],
        numbers: usize,
    ) -> Option<()> {
        let count = self.counts[order];
        // Points beyond the order are the last ones of a line.
        let within = |line: &Vec<usize>| line.partition_point(|place| *place < count);
        // Divided differences at 0, 1, 2, ... in all directions first: only Newton's form has no
        // terms beyond the lower set.
        for line in self.lines.iter().flatten() {
            let line = &line[..within(line)];
            for (step, inverse) in field.inverses.iter().enumerate().take(line.len()).skip(1) {
                for i in (step..line.len()).rev() {
                    for number in 0..numbers {
                        let (upper, lower) =
                            (line[i] * numbers + number, line[i - 1] * numbers + number);
                        let difference = (field.difference)(values[upper], values[lower])?;
                        values[upper] = (field.product)(difference, *inverse)?;
                    }
                }
            }
        }
        for line in self.lines.iter().flatten() {
            let line = &line[..within(line)];
            for node in (1..line.len().saturating_sub(1)).rev() {
                for i in node..line.len() - 1 {
                    for number in 0..numbers {
                        let upper = values[line[i + 1] * numbers + number];
                        let lower = &mut values[line[i] * numbers + number];
                        let product = (field.product)(field.nodes[node], upper)?;
                        *lower = (field.difference)(*lower, product)?;
                    }
                }
            }
        }
        Some(())
    }

    /// The product of symbols at each point, without the group whose value is one, and the weight
    /// of the point; then the product of symbols of that group.
    pub fn monomials(
        &self,
        kinds: &[(usize, Monomial)],
        base: usize,
    ) -> (Vec<(Monomial, usize)>, Monomial) {
        let of_point = |point: &Vec<usize>| {
            let parts = point.iter().zip(kinds);
            parts.fold((Monomial::one(), 0), |(product, weight), (exponent, (order, monomial))| {
                let power = monomial.power(i32::try_from(*exponent).unwrap_or(i32::MAX));
                (product.product(&power), weight + order * exponent)
            })
        };
        (self.points.iter().map(of_point).collect(), kinds[base].1.clone())
    }
}

/// Numbers in which a polynomial is found from its values at `0, 1, 2, ...`; an operation is `None`
/// if its result does not fit.
pub(super) struct PointField<T, D, P> {
    /// `0, 1, 2, ...`
    pub nodes: Vec<T>,
    /// Their inverses; the first is not used.
    pub inverses: Vec<T>,
    pub difference: D,
    pub product: P,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::residue::{Modulus, primes_below};

    #[test]
    fn a_lower_set_gives_back_what_its_points_were_taken_from() {
        // Weights 1 (the one that is one), 1 and 2: exponents i + 2 j <= 5.
        let set = LowerSet::new(&[1, 1, 2], 0, 5, 100).expect("few points");
        assert_eq!(set.counts, [1, 2, 4, 6, 9, 12]);
        let prime = primes_below(30, 2).next().expect("a prime");
        let modulus = Modulus::new(prime, 32);
        let coefficient = |point: &[usize]| (point[1] * 17 + point[2] * point[2] * 5 + 3) as i64;
        let power = |base: usize, exponent: usize| (base as i64).pow(exponent as u32);
        let value = |at: &[usize]| -> i64 {
            let terms = set.points.iter();
            terms
                .map(|point| coefficient(point) * power(at[1], point[1]) * power(at[2], point[2]))
                .sum()
        };
        let mut values: Vec<u64> = set.points.iter().map(|at| modulus.small(value(at))).collect();
        let nodes: Vec<u64> = (0..7).map(|k| modulus.small(k)).collect();
        let mut inverses = nodes.clone();
        modulus.invert(&mut inverses[1..]).expect("no multiple of the prime");
        let field = PointField {
            nodes,
            inverses,
            difference: |left, right| Some(modulus.difference(left, right)),
            product: |left, right| Some(modulus.product(left, right)),
        };
        set.interpolate(&field, 5, &mut values, 1).expect("residues always fit");
        let expected: Vec<u64> =
            set.points.iter().map(|point| modulus.small(coefficient(point))).collect();
        assert_eq!(values, expected);
    }
}
