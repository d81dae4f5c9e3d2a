//! Products of series in a small parameter, order by order, none computed twice.
//!
//! With `u = u_0 + delta u_1 + ...` and `v` likewise, order `n` of the product is
//! `sum_i u_i v_(n-i)`. A [`Convolutions`] holds the products that an equation needs (`x^2`, `x^3`,
//! `x x'^2`, ...) as a graph on its leaves. It computes one order of each product when that order
//! of the leaves is known, and only as far as it is needed.

use std::collections::HashMap;

use super::fourier::{FourierSeries, sum_of_products};
use crate::exact::Ring;

/// One series in the graph: a leaf, or a product of two others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SeriesNode(usize);

#[derive(Debug)]
struct Orders<R: Ring> {
    /// The two factors; `None` for a leaf.
    factors: Option<(SeriesNode, SeriesNode)>,
    /// The orders known so far.
    known: Vec<FourierSeries<R>>,
    /// The highest order that was required; `None` if none was.
    needed: Option<usize>,
}

/// Series in a small parameter and their products.
#[derive(Debug)]
pub struct Convolutions<R: Ring> {
    ring: R,
    nodes: Vec<Orders<R>>,
    products: HashMap<(SeriesNode, SeriesNode), SeriesNode>,
}

impl<R: Ring> Convolutions<R> {
    /// A graph without series; all series added later are over `ring`.
    pub fn new(ring: R) -> Self {
        Self { ring, nodes: vec![], products: HashMap::new() }
    }

    /// A new series whose orders the caller supplies.
    pub fn leaf(&mut self) -> SeriesNode {
        self.add(None)
    }

    /// The product of two series.
    pub fn product(&mut self, left: SeriesNode, right: SeriesNode) -> SeriesNode {
        let factors = (left.min(right), left.max(right));
        if let Some(&known) = self.products.get(&factors) {
            return known;
        }
        let node = self.add(Some(factors));
        self.products.insert(factors, node);
        node
    }

    /// The power `base^exponent`, `exponent >= 1`, built by steps of two so that neighbouring
    /// powers share their work.
    pub fn power(&mut self, base: SeriesNode, exponent: u32) -> SeriesNode {
        if exponent <= 1 {
            return base;
        }
        let square = self.product(base, base);
        let start = if exponent.is_multiple_of(2) { square } else { base };
        (1..exponent.div_ceil(2)).fold(start, |power, _| self.product(power, square))
    }

    /// Requires `node` up to `order`, and with it its factors.
    pub fn require(&mut self, node: SeriesNode, order: usize) {
        let entry = &mut self.nodes[node.0];
        if entry.needed.is_some_and(|needed| needed >= order) {
            return;
        }
        entry.needed = Some(order);
        if let Some((left, right)) = entry.factors {
            self.require(left, order);
            self.require(right, order);
        }
    }

    /// Supplies the next order of a leaf.
    pub fn push(&mut self, leaf: SeriesNode, series: FourierSeries<R>) {
        self.nodes[leaf.0].known.push(series);
    }

    /// Order `order` of a series; `None` if it is not known.
    pub fn order(&self, node: SeriesNode, order: usize) -> Option<&FourierSeries<R>> {
        self.nodes[node.0].known.get(order)
    }

    /// Order `order` of every series that is known that far.
    pub fn orders(&self, order: usize) -> impl Iterator<Item = &FourierSeries<R>> {
        self.nodes.iter().filter_map(move |entry| entry.known.get(order))
    }

    /// Number of series, the leaves included.
    pub fn count(&self) -> usize {
        self.nodes.len()
    }

    /// Computes `order` of every product that needs it; the leaves must be known that far.
    pub fn advance(&mut self, order: usize) {
        for index in 0..self.nodes.len() {
            let entry = &self.nodes[index];
            let Some((left, right)) = entry.factors else {
                continue;
            };
            if entry.needed.is_none_or(|needed| needed < order) {
                continue;
            }
            let (left, right, same) =
                (&self.nodes[left.0].known, &self.nodes[right.0].known, left == right);
            let terms: Vec<_> = match same {
                // A square: u_i u_j and u_j u_i are the same product.
                true => (0..=order / 2)
                    .map(|i| (if 2 * i == order { 1 } else { 2 }, &left[i], &left[order - i]))
                    .collect(),
                false => (0..=order).map(|i| (1, &left[i], &right[order - i])).collect(),
            };
            let product = sum_of_products(&self.ring, &terms);
            self.nodes[index].known.push(product);
        }
    }

    /// The first variation of every series at order zero when the leaves vary by `of_leaves`; zero
    /// for products that were not required.
    pub fn variations(
        &self,
        of_leaves: &HashMap<SeriesNode, FourierSeries<R>>,
    ) -> Vec<FourierSeries<R>> {
        let mut variations: Vec<FourierSeries<R>> = Vec::with_capacity(self.nodes.len());
        for (index, entry) in self.nodes.iter().enumerate() {
            let variation = match entry.factors {
                None => of_leaves
                    .get(&SeriesNode(index))
                    .cloned()
                    .unwrap_or_else(|| FourierSeries::zero(self.ring.clone())),
                Some((left, right)) => {
                    let pairs = [(&variations[left.0], right), (&variations[right.0], left)];
                    let terms: Vec<_> = pairs
                        .into_iter()
                        .filter_map(|(variation, other)| {
                            Some((1, variation, self.order(other, 0)?))
                        })
                        .collect();
                    sum_of_products(&self.ring, &terms)
                }
            };
            variations.push(variation);
        }
        variations
    }

    /// Adds `factor` times the variation of each series to its order `order`, if that order is
    /// already known.
    pub fn correct(
        &mut self,
        order: usize,
        factor: &FourierSeries<R>,
        variations: &[FourierSeries<R>],
    ) {
        for (entry, variation) in self.nodes.iter_mut().zip(variations) {
            if let Some(series) = entry.known.get_mut(order) {
                *series = series.sum(&factor.product(variation));
            }
        }
    }

    /// The variation that belongs to `node` in the list of [`Convolutions::variations`].
    pub fn variation_of(variations: &[FourierSeries<R>], node: SeriesNode) -> &FourierSeries<R> {
        &variations[node.0]
    }

    fn add(&mut self, factors: Option<(SeriesNode, SeriesNode)>) -> SeriesNode {
        self.nodes.push(Orders { factors, known: vec![], needed: None });
        SeriesNode(self.nodes.len() - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::super::fourier::linear_combination;
    use super::*;
    use crate::exact::Integers;

    #[test]
    fn powers_agree_with_repeated_products() {
        let orders = [
            FourierSeries::cos(Integers, 1),
            FourierSeries::cos(Integers, 3),
            FourierSeries::sin(Integers, 2),
        ];
        let mut graph = Convolutions::new(Integers);
        let leaf = graph.leaf();
        let fifth = graph.power(leaf, 5);
        graph.require(fifth, 2);
        for (order, series) in orders.iter().enumerate() {
            graph.push(leaf, series.clone());
            graph.advance(order);
        }
        // (u0 + d u1 + d^2 u2)^5 at d^2: 5 u0^4 u2 + 10 u0^3 u1^2.
        let [zeroth, first, second] = &orders;
        let expected = linear_combination(
            &Integers,
            &[
                (5, &zeroth.power(4).product(second)),
                (10, &zeroth.power(3).product(&first.power(2))),
            ],
        );
        assert_eq!(graph.order(fifth, 2), Some(&expected));
    }
}
