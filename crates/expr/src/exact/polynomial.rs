//! Sparse polynomials in named symbols, with exponents of either sign.
//!
//! A frequency law such as `omega0 + 3*eps*A^2/(8*omega0)` is such a polynomial: its terms have a
//! fixed order, and none is zero, so that equal polynomials are equal values. Products cost (number
//! of terms)^2 coefficient products, of whole numbers where the exponents fill a box.

use std::cmp::Ordering;
use std::collections::BTreeSet;
use std::collections::btree_map::{BTreeMap, Entry};
use std::ops::Add;

use num_traits::Zero;

use super::dense_product::{dense_cosine_product, dense_product};
use super::rational::{Integer, Rational, to_f64};
use super::ring::{NotInvertible, Number, Rationals, Ring};
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
        Self(if exponent == 0 { vec![] } else { vec![(symbol, exponent)] })
    }

    /// The product of powers of these symbols, which are in their order; a power of zero is left out.
    pub(super) fn from_ordered(factors: impl Iterator<Item = (Symbol, i32)>) -> Self {
        Self(factors.filter(|factor| factor.1 != 0).collect())
    }

    /// The symbols and their exponents, in the order of the symbols.
    pub fn factors(&self) -> &[(Symbol, i32)] {
        &self.0
    }

    /// The exponent of `symbol`, zero when it does not occur.
    pub fn exponent(&self, symbol: Symbol) -> i32 {
        self.0.binary_search_by_key(&symbol, |factor| factor.0).map_or(0, |place| self.0[place].1)
    }

    /// The sum of all exponents.
    pub fn degree(&self) -> i64 {
        self.0.iter().map(|factor| i64::from(factor.1)).sum()
    }

    /// The product: exponents are added.
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
        Self(self.0.iter().map(|&(symbol, power)| (symbol, power * exponent)).collect())
    }

    /// The monomial without the power of `symbol`.
    pub fn without(&self, symbol: Symbol) -> Self {
        Self(self.0.iter().copied().filter(|factor| factor.0 != symbol).collect())
    }
}

impl Ord for Monomial {
    fn cmp(&self, other: &Self) -> Ordering {
        // A higher power of an earlier symbol comes first among equal degrees.
        self.degree().cmp(&other.degree()).then_with(|| {
            let (mut left, mut right) = (self.0.iter().peekable(), other.0.iter().peekable());
            loop {
                let order = match (left.peek(), right.peek()) {
                    (None, None) => return Ordering::Equal,
                    (Some((_, m)), None) => 0.cmp(m),
                    (None, Some((_, n))) => n.cmp(&0),
                    (Some((a, m)), Some((b, n))) => match a.cmp(b) {
                        Ordering::Equal => n.cmp(m),
                        Ordering::Less => 0.cmp(m),
                        Ordering::Greater => n.cmp(&0),
                    },
                };
                if order.is_ne() {
                    return order;
                }
                // Equal powers of the same symbol: no exponent is zero.
                left.next();
                right.next();
            }
        })
    }
}

impl PartialOrd for Monomial {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// A sum of monomials with coefficients of type `K`, by default [`Rational`].
///
/// The arithmetic is that of the ring [`Polynomials`]. For coefficients that are [`Number`]s, whose
/// ring follows from their type, this type has it as methods of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Polynomial<K = Rational> {
    terms: BTreeMap<Monomial, K>,
}

/// The ring of polynomials with coefficients in another ring.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Polynomials<R = Rationals>(
    /// The ring of the coefficients.
    pub R,
);

/// The ring of [`Polynomial`]s with fractions as coefficients: that of the formulas in an answer.
pub const POLYNOMIALS: Polynomials = Polynomials(Rationals);

impl<K: Number> Number for Polynomial<K> {
    type Ring = Polynomials<K::Ring>;
}

impl<K> Polynomial<K> {
    /// The sum of different monomials with coefficients that are not zero.
    pub(super) fn from_terms(terms: impl Iterator<Item = (Monomial, K)>) -> Self {
        Self { terms: terms.collect() }
    }

    /// The terms, lowest total degree first.
    pub fn terms(&self) -> impl DoubleEndedIterator<Item = (&Monomial, &K)> + ExactSizeIterator {
        self.terms.iter()
    }

    /// The only term; `None` if there is not exactly one.
    pub fn single_term(&self) -> Option<(&Monomial, &K)> {
        let mut terms = self.terms.iter();
        terms.next().filter(|_| self.terms.len() == 1)
    }

    /// Every symbol that occurs.
    pub fn symbols(&self) -> BTreeSet<Symbol> {
        self.terms.keys().flat_map(|monomial| monomial.0.iter().map(|factor| factor.0)).collect()
    }

    /// The smallest and largest exponent of `symbol` over all terms; `None` for the zero
    /// polynomial.
    pub fn exponent_range(&self, symbol: Symbol) -> Option<(i32, i32)> {
        let exponents = || self.terms.keys().map(|monomial| monomial.exponent(symbol));
        Some((exponents().min()?, exponents().max()?))
    }
}

impl<K: Clone> Polynomial<K> {
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
}

impl<K: Number> Polynomial<K> {
    /// `coefficient * monomial`.
    pub fn term(monomial: Monomial, coefficient: K) -> Self {
        ring_of::<K>().term(monomial, coefficient)
    }

    /// A number.
    pub fn constant(value: K) -> Self {
        Self::term(Monomial::one(), value)
    }

    /// The polynomial that is this symbol.
    pub fn symbol(symbol: Symbol) -> Self {
        Self::term(Monomial::power_of(symbol, 1), K::Ring::default().integer(1))
    }

    /// The coefficient of `monomial`, zero when it does not occur.
    pub fn coefficient(&self, monomial: &Monomial) -> K {
        let coefficient = self.terms.get(monomial).cloned();
        coefficient.unwrap_or_else(|| K::Ring::default().zero())
    }

    /// `self += coefficient * monomial`.
    pub fn add_term(&mut self, monomial: Monomial, coefficient: K) {
        ring_of::<K>().add_term(self, monomial, coefficient);
    }

    /// `self += other`, in place.
    pub fn accumulate(&mut self, other: &Self) {
        ring_of::<K>().accumulate(self, other);
    }

    /// `-self`, in place.
    pub fn negate(&mut self) {
        ring_of::<K>().negate(self);
    }

    /// `self * other`.
    pub fn product(&self, other: &Self) -> Self {
        ring_of::<K>().product(self, other)
    }

    /// The pair `unit` and `integer` with `self * unit = integer`; `None` unless this is a single
    /// term that has such a pair: see [`Ring::inverse`].
    pub fn inverse(&self) -> Option<(Self, Integer)> {
        ring_of::<K>().inverse(self)
    }

    /// The `exponent`-th power; negative powers only of a single term whose coefficient is a unit.
    pub fn power(&self, exponent: i32) -> Option<Self> {
        ring_of::<K>().power(self, exponent)
    }

    /// The derivative with respect to a symbol.
    pub fn slope(&self, symbol: Symbol) -> Self {
        let ring = K::Ring::default();
        let mut result = Self::zero();
        for (monomial, coefficient) in &self.terms {
            let exponent = monomial.exponent(symbol);
            if exponent != 0 {
                let mut coefficient = coefficient.clone();
                ring.scale(&mut coefficient, exponent.into());
                result.add_term(monomial.product(&Monomial::power_of(symbol, -1)), coefficient);
            }
        }
        result
    }

    /// Returns the polynomial with a function applied to every coefficient.
    pub fn map<L: Number>(&self, mut change: impl FnMut(&K) -> L) -> Polynomial<L> {
        let mut result = Polynomial::zero();
        for (monomial, coefficient) in &self.terms {
            result.add_term(monomial.clone(), change(coefficient));
        }
        result
    }

    /// The polynomial with `symbol` replaced by `value`, whose negative powers exist only if it is
    /// a single invertible term.
    ///
    /// `None` if a negative power would be needed and does not exist.
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
}

fn ring_of<K: Number>() -> Polynomials<K::Ring> {
    Polynomials::default()
}

impl<R: Ring> Polynomials<R> {
    /// `coefficient * monomial`.
    pub fn term(&self, monomial: Monomial, coefficient: R::Element) -> Polynomial<R::Element> {
        let mut result = self.zero();
        self.add_term(&mut result, monomial, coefficient);
        result
    }

    /// `polynomial += coefficient * monomial`.
    pub fn add_term(
        &self,
        polynomial: &mut Polynomial<R::Element>,
        monomial: Monomial,
        coefficient: R::Element,
    ) {
        if self.0.is_certainly_zero(&coefficient) {
            return;
        }
        match polynomial.terms.entry(monomial) {
            Entry::Vacant(place) => {
                place.insert(coefficient);
            }
            Entry::Occupied(mut place) => {
                self.0.add(place.get_mut(), coefficient);
                if self.0.is_certainly_zero(place.get()) {
                    place.remove();
                }
            }
        }
    }

    /// The `exponent`-th power; negative powers only of a single term whose coefficient is a unit.
    pub fn power(
        &self,
        base: &Polynomial<R::Element>,
        exponent: i32,
    ) -> Option<Polynomial<R::Element>> {
        let mut square = base.clone();
        if exponent < 0 {
            let (unit, integer) = self.inverse(base)?;
            square = unit;
            self.divide([&mut square], &integer).ok()?;
        }
        let mut result = self.integer(1);
        let mut rest = exponent.unsigned_abs();
        while rest > 0 {
            if rest & 1 == 1 {
                result = self.product(&result, &square);
            }
            rest >>= 1;
            if rest > 0 {
                square = self.product(&square, &square);
            }
        }
        Some(result)
    }
}

impl Polynomial<Rational> {
    /// The exact square root of a single term: `4*k^2` gives `2*k`; `None` if there is none.
    /// Symbols count as positive.
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

    /// The value with every symbol replaced by its number; the first symbol without one is the
    /// error.
    pub fn evaluate(&self, value_of: impl Fn(Symbol) -> Option<f64>) -> Result<f64, Symbol> {
        self.evaluate_with_size(value_of).map(|(sum, _)| sum)
    }

    /// The value, and the sum of the absolute values of its terms, which shows how far they cancel.
    ///
    /// # Errors
    /// The first symbol without a number.
    pub fn evaluate_with_size(
        &self,
        value_of: impl Fn(Symbol) -> Option<f64>,
    ) -> Result<(f64, f64), Symbol> {
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
        // A factor or an intermediate product is beyond the range of normal doubles, or zero:
        // numbers with an exponent of their own keep all digits.
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

    /// The number; `None` if a symbol occurs.
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

impl<K: Number> Add for Polynomial<K> {
    type Output = Self;

    fn add(mut self, other: Self) -> Self {
        self.accumulate(&other);
        self
    }
}

/// Zero is the polynomial without terms.
impl<K: Number> Zero for Polynomial<K> {
    fn zero() -> Self {
        Self { terms: BTreeMap::new() }
    }

    fn is_zero(&self) -> bool {
        self.terms.is_empty()
    }
}

impl<R: Ring> Ring for Polynomials<R> {
    type Element = Polynomial<R::Element>;

    const FIELD: bool = R::FIELD;

    fn zero(&self) -> Self::Element {
        Polynomial { terms: BTreeMap::new() }
    }
    fn integer(&self, value: i64) -> Self::Element {
        self.term(Monomial::one(), self.0.integer(value))
    }
    fn is_certainly_zero(&self, element: &Self::Element) -> bool {
        element.terms.is_empty()
    }
    fn may_be_zero(&self, element: &Self::Element) -> bool {
        element.terms.values().all(|coefficient| self.0.may_be_zero(coefficient))
    }
    fn accumulate(&self, sum: &mut Self::Element, term: &Self::Element) {
        if sum.terms.is_empty() {
            sum.terms.clone_from(&term.terms);
            return;
        }
        for (monomial, coefficient) in &term.terms {
            let Some(place) = sum.terms.get_mut(monomial) else {
                sum.terms.insert(monomial.clone(), coefficient.clone());
                continue;
            };
            self.0.accumulate(place, coefficient);
            if self.0.is_certainly_zero(place) {
                sum.terms.remove(monomial);
            }
        }
    }
    fn add(&self, sum: &mut Self::Element, term: Self::Element) {
        if sum.terms.is_empty() {
            *sum = term;
            return;
        }
        for (monomial, coefficient) in term.terms {
            self.add_term(sum, monomial, coefficient);
        }
    }
    fn negate(&self, element: &mut Self::Element) {
        element.terms.values_mut().for_each(|coefficient| self.0.negate(coefficient));
    }
    fn product(&self, left: &Self::Element, right: &Self::Element) -> Self::Element {
        if let Some(product) = dense_product(self, left, right) {
            return product;
        }
        let mut result = self.zero();
        for (m, a) in &left.terms {
            for (n, b) in &right.terms {
                self.add_term(&mut result, m.product(n), self.0.product(a, b));
            }
        }
        result
    }
    fn doubled_cosine_product(
        &self,
        left: &[Self::Element],
        right: &[Self::Element],
    ) -> Option<Vec<Self::Element>> {
        dense_cosine_product(self, left, right)
    }
    fn scale(&self, element: &mut Self::Element, factor: i64) {
        for coefficient in element.terms.values_mut() {
            self.0.scale(coefficient, factor);
        }
        self.prune(element);
    }
    fn scale_by(&self, element: &mut Self::Element, factor: &Integer) {
        for coefficient in element.terms.values_mut() {
            self.0.scale_by(coefficient, factor);
        }
        self.prune(element);
    }
    fn divide<'a>(
        &self,
        elements: impl IntoIterator<Item = &'a mut Self::Element>,
        divisor: &Integer,
    ) -> Result<(), NotInvertible> {
        let coefficients = elements.into_iter().flat_map(|element| element.terms.values_mut());
        self.0.divide(coefficients, divisor)
    }
    fn reduce<'a>(
        &self,
        elements: impl IntoIterator<Item = &'a mut Self::Element>,
        denominator: &mut Integer,
    ) {
        let coefficients = elements.into_iter().flat_map(|element| element.terms.values_mut());
        self.0.reduce(coefficients, denominator);
    }
    fn inverse(&self, element: &Self::Element) -> Option<(Self::Element, Integer)> {
        let (monomial, coefficient) = element.single_term()?;
        let (unit, integer) = self.0.inverse(coefficient)?;
        Some((self.term(monomial.power(-1), unit), integer))
    }
}

impl<R: Ring> Polynomials<R> {
    /// Removes terms whose coefficient is certainly zero after a multiplication.
    fn prune(&self, element: &mut Polynomial<R::Element>) {
        element.terms.retain(|_, coefficient| !self.0.is_certainly_zero(coefficient));
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
            ["1 [(omega0, 2)]", "3/4 [(A, 2), (eps, 1)]", "9/64 [(A, 4), (eps, 2), (omega0, -2)]"]
        );
    }

    /// The order against its definition, symbol by symbol, over all small exponents of two symbols
    /// out of three.
    #[test]
    fn monomials_are_ordered_by_degree_and_then_by_their_first_difference() {
        let names = ["a", "b", "c"].map(Symbol::new);
        let mut all = vec![];
        for exponents in
            (0..125).map(|code| [code / 25, code / 5 % 5, code % 5].map(|digit| digit - 2))
        {
            let powers = names.into_iter().zip(exponents);
            let monomial = powers.fold(Monomial::one(), |product, (name, exponent)| {
                product.product(&Monomial::power_of(name, exponent))
            });
            all.push((monomial, exponents));
        }
        for (left, m) in &all {
            for (right, n) in &all {
                let first = m.iter().zip(n).map(|(m, n)| n.cmp(m)).find(|order| order.is_ne());
                let degree = m.iter().sum::<i32>().cmp(&n.iter().sum::<i32>());
                assert_eq!(
                    left.cmp(right),
                    degree.then(first.unwrap_or(Ordering::Equal)),
                    "{left:?} {right:?}"
                );
            }
        }
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
