//! Sparse polynomials in named symbols, with exponents of either sign.
//!
//! A frequency law such as `omega0 + 3*eps*A^2/(8*omega0)` is one of these: terms in a fixed order, no zero among them, so
//! that equal polynomials are equal values. Products cost (number of terms)^2 coefficient products.

use std::collections::BTreeSet;
use std::collections::btree_map::{BTreeMap, Entry};
use std::ops::Add;

use num_traits::{One, Zero};

use super::rational::{Integer, Rational, to_f64};
use super::ring::{Ring, common_content};
use super::scaled::Scaled;
use crate::symbol::Symbol;

/// A product of powers of symbols, `A^2*eps`. The exponents are never zero; they may be negative.
///
/// The order is by total degree, then by the first symbol in which two of them differ.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Monomial(Vec<(Symbol, i32)>);

impl Monomial {
    /// The empty product.
    pub fn one() -> Self {
        Self::default()
    }

    /// `symbol^exponent`.
    pub fn power_of(symbol: Symbol, exponent: i32) -> Self {
        Self(if exponent == 0 {
            vec![]
        } else {
            vec![(symbol, exponent)]
        })
    }

    /// The symbols and their exponents, in the order of the symbols.
    pub fn factors(&self) -> &[(Symbol, i32)] {
        &self.0
    }

    /// The exponent of `symbol`, zero when it does not occur.
    pub fn exponent(&self, symbol: Symbol) -> i32 {
        self.0
            .binary_search_by_key(&symbol, |factor| factor.0)
            .map_or(0, |place| self.0[place].1)
    }

    /// The sum of all exponents.
    pub fn degree(&self) -> i64 {
        self.0.iter().map(|factor| i64::from(factor.1)).sum()
    }

    /// The product, exponents added.
    pub fn product(&self, other: &Self) -> Self {
        let mut factors = Vec::with_capacity(self.0.len() + other.0.len());
        let (mut left, mut right) = (self.0.iter().peekable(), other.0.iter().peekable());
        loop {
            match (left.peek(), right.peek()) {
                (Some(&&(a, m)), Some(&&(b, n))) if a == b => {
                    if m + n != 0 {
                        factors.push((a, m + n));
                    }
                    left.next();
                    right.next();
                }
                (Some(&&a), Some(&&b)) if a.0 < b.0 => {
                    factors.push(a);
                    left.next();
                }
                (_, Some(&&b)) => {
                    factors.push(b);
                    right.next();
                }
                (Some(&&a), None) => {
                    factors.push(a);
                    left.next();
                }
                (None, None) => return Self(factors),
            }
        }
    }

    /// The `exponent`-th power.
    pub fn power(&self, exponent: i32) -> Self {
        if exponent == 0 {
            return Self::one();
        }
        Self(
            self.0
                .iter()
                .map(|&(symbol, power)| (symbol, power * exponent))
                .collect(),
        )
    }

    /// This monomial with `symbol` taken out.
    pub fn without(&self, symbol: Symbol) -> Self {
        Self(self.0.iter().copied().filter(|factor| factor.0 != symbol).collect())
    }
}

impl Ord for Monomial {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        // A higher power of an earlier symbol comes first among equal degrees.
        self.degree().cmp(&other.degree()).then_with(|| {
            let names: BTreeSet<Symbol> = self.0.iter().chain(&other.0).map(|factor| factor.0).collect();
            names
                .into_iter()
                .map(|name| other.exponent(name).cmp(&self.exponent(name)))
                .find(|o| o.is_ne())
                .unwrap_or(std::cmp::Ordering::Equal)
        })
    }
}

impl PartialOrd for Monomial {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

/// A sum of monomials with coefficients in `K`; [`Rational`] unless said otherwise.
#[derive(Clone, Debug, PartialEq)]
pub struct Polynomial<K = Rational> {
    terms: BTreeMap<Monomial, K>,
}

impl<K: Ring> Polynomial<K> {
    /// `coefficient * monomial`.
    pub fn term(monomial: Monomial, coefficient: K) -> Self {
        let mut result = Self::zero();
        result.add_term(monomial, coefficient);
        result
    }

    /// A number.
    pub fn constant(value: K) -> Self {
        Self::term(Monomial::one(), value)
    }

    /// The polynomial that is this symbol.
    pub fn symbol(symbol: Symbol) -> Self {
        Self::term(Monomial::power_of(symbol, 1), K::from_integer(&Integer::one()))
    }

    /// The terms, lowest total degree first.
    pub fn terms(&self) -> impl DoubleEndedIterator<Item = (&Monomial, &K)> + ExactSizeIterator {
        self.terms.iter()
    }

    /// The coefficient of `monomial`, zero when it does not occur.
    pub fn coefficient(&self, monomial: &Monomial) -> K {
        self.terms.get(monomial).cloned().unwrap_or_else(K::zero)
    }

    /// `self += coefficient * monomial`.
    pub fn add_term(&mut self, monomial: Monomial, coefficient: K) {
        if coefficient.is_zero() {
            return;
        }
        match self.terms.entry(monomial) {
            Entry::Vacant(place) => {
                place.insert(coefficient);
            }
            Entry::Occupied(mut place) => {
                place.get_mut().accumulate(&coefficient);
                if place.get().is_zero() {
                    place.remove();
                }
            }
        }
    }

    /// The only term, where there is exactly one.
    pub fn single_term(&self) -> Option<(&Monomial, &K)> {
        let mut terms = self.terms.iter();
        terms.next().filter(|_| self.terms.len() == 1)
    }

    /// Every symbol that occurs.
    pub fn symbols(&self) -> BTreeSet<Symbol> {
        self.terms
            .keys()
            .flat_map(|monomial| monomial.0.iter().map(|factor| factor.0))
            .collect()
    }

    /// The smallest and largest exponent of `symbol` over all terms; `None` for the zero polynomial.
    pub fn exponent_range(&self, symbol: Symbol) -> Option<(i32, i32)> {
        let exponents = || self.terms.keys().map(|monomial| monomial.exponent(symbol));
        Some((exponents().min()?, exponents().max()?))
    }

    /// The terms whose exponent of `symbol` is at most `highest`: a series cut off at its order.
    pub fn truncated(&self, symbol: Symbol, highest: i32) -> Self {
        let keep = |monomial: &Monomial| monomial.exponent(symbol) <= highest;
        Self {
            terms: self
                .terms
                .iter()
                .filter(|(m, _)| keep(m))
                .map(|(m, k)| (m.clone(), k.clone()))
                .collect(),
        }
    }

    /// The product with one monomial.
    pub fn times_monomial(&self, factor: &Monomial) -> Self {
        Self {
            terms: self
                .terms
                .iter()
                .map(|(monomial, k)| (monomial.product(factor), k.clone()))
                .collect(),
        }
    }

    /// The same polynomial over other coefficients.
    pub fn map<L: Ring>(&self, mut change: impl FnMut(&K) -> L) -> Polynomial<L> {
        let mut result = Polynomial::zero();
        for (monomial, coefficient) in &self.terms {
            result.add_term(monomial.clone(), change(coefficient));
        }
        result
    }

    /// `symbol` replaced by `value`, whose negative powers exist only where it is a single invertible term.
    ///
    /// `None` where a negative power would be needed and does not exist.
    pub fn substitute(&self, symbol: Symbol, value: &Self) -> Option<Self> {
        let mut result = Self::zero();
        let mut powers: BTreeMap<i32, Self> = BTreeMap::new();
        for (monomial, coefficient) in &self.terms {
            let exponent = monomial.exponent(symbol);
            let power = match powers.entry(exponent) {
                Entry::Occupied(known) => known.into_mut(),
                Entry::Vacant(place) => place.insert(value.power(exponent)?),
            };
            let rest = Self::term(monomial.without(symbol), coefficient.clone());
            result.accumulate(&rest.product(power));
        }
        Some(result)
    }

    /// The `exponent`-th power; negative powers only of a single term whose coefficient is a unit.
    pub fn power(&self, exponent: i32) -> Option<Self> {
        let base = if exponent < 0 {
            let (unit, integer) = self.inverse()?;
            let mut inverse = unit;
            if K::FIELD {
                inverse.divide(&integer);
            } else if !integer.is_one() {
                return None;
            }
            inverse
        } else {
            self.clone()
        };
        let mut result = Self::constant(K::from_integer(&Integer::one()));
        let mut square = base;
        let mut rest = exponent.unsigned_abs();
        while rest > 0 {
            if rest & 1 == 1 {
                result = result.product(&square);
            }
            rest >>= 1;
            if rest > 0 {
                square = square.product(&square);
            }
        }
        Some(result)
    }
}

impl Polynomial<Rational> {
    /// The exact square root, where it is a single term: `4*k^2` gives `2*k`. Symbols count as positive.
    pub fn single_term_root(&self) -> Option<Self> {
        let (monomial, coefficient) = self.single_term()?;
        let half = super::rational::power(coefficient, &super::rational::ratio(1, 2))?;
        let factors: Option<Vec<_>> = monomial
            .0
            .iter()
            .map(|&(symbol, power)| (power % 2 == 0).then_some((symbol, power / 2)))
            .collect();
        Some(Self::term(Monomial(factors?), half))
    }

    /// The value with every symbol replaced by its number; the first symbol without one is the error.
    pub fn evaluate(&self, value_of: impl Fn(Symbol) -> Option<f64>) -> Result<f64, Symbol> {
        self.evaluate_with_size(value_of).map(|(sum, _)| sum)
    }

    /// The value, and the sum of the sizes of its terms: what they cancel to, beside what they are.
    ///
    /// # Errors
    /// The first symbol without a number.
    pub fn evaluate_with_size(&self, value_of: impl Fn(Symbol) -> Option<f64>) -> Result<(f64, f64), Symbol> {
        let (mut sum, mut size, mut in_range) = (0.0, 0.0, true);
        for (monomial, coefficient) in &self.terms {
            let mut product = to_f64(coefficient);
            in_range &= product.is_normal();
            for &(symbol, exponent) in &monomial.0 {
                let power = value_of(symbol).ok_or(symbol)?.powi(exponent);
                product *= power;
                in_range &= power.is_normal() && product.is_normal();
            }
            sum += product;
            size += product.abs();
        }
        if in_range {
            return Ok((sum, size));
        }
        // A factor or a product on the way is beyond the range of doubles, or zero.
        let term = |(monomial, coefficient): (&Monomial, &Rational)| {
            let mut factors = monomial.0.iter().map(|&(symbol, exponent)| {
                let value = value_of(symbol).ok_or(symbol)?;
                Ok(Scaled::new(value).power(exponent))
            });
            let start = Scaled::of_fraction(coefficient);
            factors.try_fold(start, |product, factor: Result<Scaled, Symbol>| {
                Ok(product.product(factor?))
            })
        };
        let mut terms: Vec<Scaled> = self.terms.iter().map(term).collect::<Result<_, Symbol>>()?;
        let sum = Scaled::sum(&terms);
        for term in &mut terms {
            term.mantissa = term.mantissa.abs();
        }
        Ok((sum, Scaled::sum(&terms)))
    }

    /// The number, where no symbol occurs.
    pub fn as_number(&self) -> Option<Rational> {
        match self.terms.len() {
            0 => Some(Rational::zero()),
            _ => self
                .single_term()
                .filter(|(monomial, _)| monomial.0.is_empty())
                .map(|(_, number)| number.clone()),
        }
    }
}

impl<K: Ring> Add for Polynomial<K> {
    type Output = Self;

    fn add(mut self, other: Self) -> Self {
        self.accumulate(&other);
        self
    }
}

/// Zero is the polynomial without terms.
impl<K: Ring> Zero for Polynomial<K> {
    fn zero() -> Self {
        Self { terms: BTreeMap::new() }
    }

    fn is_zero(&self) -> bool {
        self.terms.is_empty()
    }
}

impl<K: Ring> Ring for Polynomial<K> {
    const FIELD: bool = K::FIELD;

    fn from_integer(value: &Integer) -> Self {
        Self::constant(K::from_integer(value))
    }
    fn accumulate(&mut self, other: &Self) {
        for (monomial, coefficient) in &other.terms {
            self.add_term(monomial.clone(), coefficient.clone());
        }
    }
    fn scale(&mut self, factor: &Integer) {
        if factor.is_zero() {
            self.terms.clear();
        }
        for coefficient in self.terms.values_mut() {
            coefficient.scale(factor);
        }
    }
    fn product(&self, other: &Self) -> Self {
        let mut result = Self::zero();
        for (left, a) in &self.terms {
            for (right, b) in &other.terms {
                result.add_term(left.product(right), a.product(b));
            }
        }
        result
    }
    fn divide(&mut self, divisor: &Integer) {
        for coefficient in self.terms.values_mut() {
            coefficient.divide(divisor);
        }
    }
    fn content(&self) -> Integer {
        if K::FIELD {
            Integer::one()
        } else {
            common_content(Zero::zero(), self.terms.values())
        }
    }
    fn inverse(&self) -> Option<(Self, Integer)> {
        let (monomial, coefficient) = self.single_term()?;
        let (unit, integer) = coefficient.inverse()?;
        Some((Self::term(monomial.power(-1), unit), integer))
    }
}

#[cfg(test)]
mod tests {
    use super::super::rational::ratio;
    use super::*;

    fn law() -> Polynomial {
        let mut law = Polynomial::symbol(Symbol::new("omega0"));
        law.add_term(
            Monomial(vec![("A".into(), 2), ("eps".into(), 1), ("omega0".into(), -1)]),
            ratio(3, 8),
        );
        law
    }

    #[test]
    fn squares_a_frequency_law() {
        let squared = law().product(&law());
        let terms: Vec<String> = squared.terms().map(|(m, k)| format!("{k} {:?}", m.0)).collect();
        assert_eq!(
            terms,
            [
                "1 [(omega0, 2)]",
                "3/4 [(A, 2), (eps, 1)]",
                "9/64 [(A, 4), (eps, 2), (omega0, -2)]"
            ]
        );
    }

    #[test]
    fn substitution_inverts_single_terms_only() {
        let omega0 = Symbol::new("omega0");
        let two_k = Polynomial::symbol("k".into()).product(&Polynomial::constant(ratio(2, 1)));
        let value = law().substitute(omega0, &two_k).expect("2 k has an inverse");
        assert_eq!(
            value.evaluate(|s| Some(if s.name() == "k" { 3.0 } else { 2.0 })),
            Ok(6.0 + 0.375 * 8.0 / 6.0)
        );
        let sum = two_k + Polynomial::constant(ratio(1, 1));
        assert_eq!(law().substitute(omega0, &sum), None);
    }

    #[test]
    fn roots_of_single_terms() {
        let k = Symbol::new("k");
        let square = Polynomial::term(Monomial::power_of(k, 2), ratio(4, 9));
        assert_eq!(
            square.single_term_root(),
            Some(Polynomial::term(Monomial::power_of(k, 1), ratio(2, 3)))
        );
        assert_eq!(Polynomial::<Rational>::symbol(k).single_term_root(), None);
    }

    #[test]
    fn equal_sums_are_equal_values() {
        let mut sum = law();
        let mut minus = law();
        minus.negate();
        sum.accumulate(&minus);
        assert_eq!(sum, Polynomial::zero());
        assert!(sum.is_zero());
    }
}
