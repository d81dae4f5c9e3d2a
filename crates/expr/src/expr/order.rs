//! The order in which terms and factors print, and the structural order behind equality.
//!
//! - Terms of a sum: those with an acceleration first, those with functions last, in between by
//!   ascending total degree, at equal degree coordinates before amplitudes before parameters:
//!   `x'' + 2*zeta*x' + sin(x)`, `1 - A^2/8`, `x - xc`.
//! - Factors of a product: roots of numbers, pi, parameters in alphabetical order, amplitudes,
//!   coordinates, then powers of sums and functions: `3*eps*A^2/4`,
//!   `gamma*(x - xc)^(3/2)*H(x - xc)`.

use std::cmp::{Ordering, Reverse};
use std::collections::HashSet;

use super::{Expr, Node, number};
use crate::exact::rational::to_f64;
use crate::symbol::Symbol;

/// Sorts terms that are not sums and pairwise unlike into printing order.
pub(super) fn sort_terms(terms: &mut [Expr]) {
    terms.sort_by_cached_key(TermKey::from_term);
}

/// The order of factors; the bases differ.
pub(super) fn compare_factors(a: &Expr, b: &Expr) -> Ordering {
    fn base(factor: &Expr) -> &Expr {
        match factor.node() {
            Node::Power(base, _) => base,
            _ => factor,
        }
    }
    let class = |expr: &Expr| match expr.node() {
        Node::Number(_) => 0,
        Node::Pi => 1,
        Node::Symbol(symbol) => 2 + symbol_class(*symbol) as u8,
        Node::Sum(_) | Node::Product(..) | Node::Power(..) => 6,
        Node::Function(..) => 7,
    };
    let (first, second) = (base(a), base(b));
    class(first)
        .cmp(&class(second))
        .then_with(|| match (first.node(), second.node()) {
            (Node::Symbol(first), Node::Symbol(second)) => compare_names(*first, *second),
            _ => first.cmp(second),
        })
        .then_with(|| a.cmp(b))
}

/// The kinds of symbols in the order in which they print in a product.
#[derive(Clone, Copy)]
enum Class {
    Parameter,
    Amplitude,
    Coordinate,
    Time,
}

fn symbol_class(symbol: Symbol) -> Class {
    match symbol.name() {
        "A" | "a" if !symbol.is_apart() => Class::Amplitude,
        "x" | "theta" => Class::Coordinate,
        "t" => Class::Time,
        _ if symbol.primes() > 0 => Class::Coordinate,
        _ => Class::Parameter,
    }
}

fn compare_names(a: Symbol, b: Symbol) -> Ordering {
    let folded = |symbol: Symbol| symbol.name().chars().map(|letter| letter.to_ascii_lowercase());
    folded(a).cmp(folded(b)).then_with(|| a.cmp(&b))
}

/// The sorting key of a term, computed once; it does not depend on the coefficient.
struct TermKey {
    kind: u8,
    degree: f64,
    monomial: Vec<(Symbol, f64)>,
    factors: Vec<Expr>,
}

impl TermKey {
    fn from_term(term: &Expr) -> Self {
        let mut key =
            Self { kind: 1, degree: 0.0, monomial: Vec::new(), factors: term.factors().1.to_vec() };
        for factor in &key.factors {
            let (base, exponent) = match factor.node() {
                Node::Power(base, exponent) => (base, exponent.as_number().map(to_f64)),
                _ => (factor, Some(1.0)),
            };
            match (base.node(), exponent) {
                (Node::Symbol(symbol), Some(exponent)) => {
                    // A negative power does not count towards the degree:
                    // `omega0 + A^2/omega0 + A^4/omega0^3`.
                    key.degree += exponent.max(0.0);
                    key.monomial.push((*symbol, exponent));
                }
                (Node::Number(_) | Node::Pi, _) => {}
                _ => key.kind = key.kind.max(2),
            }
        }
        // A term with an acceleration comes first whatever its other factors.
        if key.monomial.iter().any(|(symbol, _)| symbol.primes() >= 2) {
            key.kind = 0;
        }
        key.monomial.sort_by(|a, b| compare_variables(a.0, b.0));
        key
    }
}

/// Compares symbols: coordinates, the highest derivative first, then time, amplitudes and
/// parameters.
fn compare_variables(a: Symbol, b: Symbol) -> Ordering {
    let rank = |symbol: Symbol| {
        let place = match symbol_class(symbol) {
            Class::Coordinate => 0,
            Class::Time => 1,
            Class::Amplitude => 2,
            Class::Parameter => 3,
        };
        (place, Reverse(symbol.primes()))
    };
    rank(a).cmp(&rank(b)).then_with(|| compare_names(a, b))
}

impl Ord for TermKey {
    fn cmp(&self, other: &Self) -> Ordering {
        let monomials = || {
            for (a, b) in self.monomial.iter().zip(&other.monomial) {
                let order = compare_variables(a.0, b.0).then_with(|| b.1.total_cmp(&a.1));
                if order.is_ne() {
                    return order;
                }
            }
            self.monomial.len().cmp(&other.monomial.len())
        };
        self.kind
            .cmp(&other.kind)
            .then_with(|| self.degree.total_cmp(&other.degree))
            .then_with(monomials)
            .then_with(|| self.factors.cmp(&other.factors))
    }
}

impl PartialOrd for TermKey {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for TermKey {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for TermKey {}

/// A total order of trees by kind, size and content, without recursion.
pub(super) fn compare_structure(a: &Expr, b: &Expr) -> Ordering {
    /// Number of steps after which pairs already found equal are remembered, for trees with many
    /// shared parts.
    const PATIENCE: usize = 1_000;
    if a.address() == b.address() {
        return Ordering::Equal;
    }
    let mut open = vec![(a, b)];
    let mut seen = HashSet::new();
    let mut steps = 0_usize;
    while let Some((a, b)) = open.pop() {
        if a.address() == b.address() {
            continue;
        }
        steps += 1;
        if steps > PATIENCE && a.0.hash == b.0.hash && !seen.insert((a.address(), b.address())) {
            continue;
        }
        // Among trees of one kind the size decides first, so that deep trees that differ are seldom
        // walked through.
        let order = match (a.node(), b.node()) {
            _ if rank(a.node()) != rank(b.node()) => rank(a.node()).cmp(&rank(b.node())),
            _ if a.0.size != b.0.size => a.0.size.cmp(&b.0.size),
            (Node::Number(a), Node::Number(b)) => number::compare(a, b),
            (Node::Symbol(a), Node::Symbol(b)) => a.cmp(b),
            (Node::Sum(a), Node::Sum(b)) => a.len().cmp(&b.len()),
            (Node::Product(first, a), Node::Product(second, b)) => {
                a.len().cmp(&b.len()).then_with(|| number::compare(first, second))
            }
            (Node::Function(first, a), Node::Function(second, b)) => {
                first.cmp(second).then(a.len().cmp(&b.len()))
            }
            _ => Ordering::Equal,
        };
        if order.is_ne() {
            return order;
        }
        open.extend(a.children().rev().zip(b.children().rev()));
    }
    Ordering::Equal
}

fn rank(node: &Node) -> u8 {
    match node {
        Node::Number(_) => 0,
        Node::Pi => 1,
        Node::Symbol(_) => 2,
        Node::Power(..) => 3,
        Node::Product(..) => 4,
        Node::Sum(_) => 5,
        Node::Function(..) => 6,
    }
}
