//! Guards: the arguments of `abs`, `sgn`, `H`, `max` and `min` that change their sign together.
//!
//! ```text
//! sgn(c u) = sgn(c) sgn(u)        u - x - d,   x + d - u,   k*(u - x) - k*d    are one guard
//! ```
//!
//! The contact of two bodies occurs in the equations of both, with opposite signs, and in
//! derivatives of these: if the occurrences were switched one by one, rounding could leave some of
//! them on the wrong side.

use std::collections::BTreeMap;

use crate::expr::Expr;
use crate::symbol::Symbol;

/// An argument, kept as a sum of numbers times expressions so that its multiples are recognized.
#[derive(Clone, Debug)]
pub struct Guard {
    terms: BTreeMap<Expr, f64>,
}

impl Guard {
    /// Splits an argument into its terms; a symbol with a value counts as a number.
    pub fn new(argument: &Expr, values: &BTreeMap<Symbol, f64>) -> Self {
        let is_number = |expr: &Expr| expr.symbols().iter().all(|name| values.contains_key(name));
        let number = |expr: &Expr| expr.evaluate(values).ok().filter(|value| value.is_finite());
        // An argument too long to be expanded is compared as it is.
        let written_out = argument.expand().unwrap_or_else(|_| argument.clone());
        let mut terms = BTreeMap::new();
        for term in written_out.terms() {
            let (number_before, factors) = term.factors();
            let (numbers, others): (Vec<&Expr>, Vec<&Expr>) =
                factors.iter().partition(|factor| is_number(factor));
            let product = |factors: Vec<&Expr>| Expr::product(factors.into_iter().cloned());
            let coefficient = Expr::number(number_before) * product(numbers);
            let (rest, coefficient) = match number(&coefficient) {
                Some(coefficient) => (product(others), coefficient),
                None => (term.clone(), 1.0),
            };
            *terms.entry(rest).or_insert(0.0) += coefficient;
        }
        terms.retain(|_, coefficient| *coefficient != 0.0);
        Self { terms }
    }

    /// The ratio of this guard to another; `None` if they are not proportional, or one of them is
    /// zero.
    pub fn ratio_to(&self, other: &Self) -> Option<f64> {
        /// The relative difference that rounding leaves between ratios that are equal.
        const ROUNDING: f64 = 1e-14;
        let mut ratios = self
            .terms
            .iter()
            .zip(&other.terms)
            .map(|((term, one), (same, other))| (term == same).then_some(one / other));
        let first = ratios.next()??;
        let alike = |ratio: Option<f64>| {
            ratio.is_some_and(|ratio| (ratio - first).abs() <= ROUNDING * first.abs())
        };
        (self.terms.len() == other.terms.len() && ratios.all(alike)).then_some(first)
    }
}

/// The distinct guards of several expressions.
#[derive(Clone, Debug)]
pub struct Guards {
    values: BTreeMap<Symbol, f64>,
    known: Vec<Guard>,
}

/// The guard of an argument, as found in a list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuardUse {
    /// The index of the guard in the list.
    pub index: usize,
    /// Whether no earlier argument has this guard, so that its sign is that of this argument.
    pub is_new: bool,
    /// Whether the argument has the same sign as the guard, and not the opposite one.
    pub is_aligned: bool,
}

impl Guards {
    /// An empty list; `values` are the values of the symbols that count as numbers.
    pub fn new(values: &BTreeMap<Symbol, f64>) -> Self {
        Self { values: values.clone(), known: vec![] }
    }

    /// Finds the guard of an argument, or adds a new one.
    pub fn find_or_add(&mut self, argument: &Expr) -> GuardUse {
        let guard = Guard::new(argument, &self.values);
        let mut ratios = self.known.iter().enumerate();
        if let Some((index, ratio)) =
            ratios.find_map(|(index, known)| Some((index, guard.ratio_to(known)?)))
        {
            return GuardUse { index, is_new: false, is_aligned: ratio > 0.0 };
        }
        self.known.push(guard);
        GuardUse { index: self.known.len() - 1, is_new: true, is_aligned: true }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::parse_expression;

    #[test]
    fn multiples_of_an_argument_are_one_guard() {
        let values = [("k", -2.5), ("d", 0.1)].map(|(name, value)| (Symbol::new(name), value));
        let mut guards = Guards::new(&BTreeMap::from(values));
        let mut find = |text: &str| guards.find_or_add(&parse_expression(text).expect(text));
        for (text, index, is_new, is_aligned) in [
            ("u - x - d", 0, true, true),
            ("x + d - u", 0, false, false),
            ("3*(u - x) - 0.3", 0, false, true),
            ("k*(u - x - d)", 0, false, false),
            ("u - x", 1, true, true),
            ("u - x - 0.1000001", 2, true, true),
            ("max(-x, 0)/d - 1", 3, true, true),
            ("d - max(0, -x)", 3, false, false),
            ("x - x", 4, true, true),
            ("2*sin(x)", 5, true, true),
            ("-sin(x)/k", 5, false, true),
        ] {
            let expected = GuardUse { index, is_new, is_aligned };
            assert_eq!(find(text), expected, "{text}");
        }
    }
}
