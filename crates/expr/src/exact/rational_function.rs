//! Rational functions of one letter in lowest terms, and surds over them.
//!
//! ```text
//! 3 mu/(8 (1 + mu))        (1 + sqrt(4 + 3 mu))/3        a + b sqrt(R),  a, b, R rational functions
//! ```
//!
//! In: polynomials in one letter. Out: exact quotients whose zero is seen, factors for printing, and
//! square roots with what is a square taken out. A polynomial is the list of its coefficients, lowest
//! first.

use num_traits::{One, Signed, Zero};

use super::polynomial::Monomial;
use super::real_roots::{
    derivative, difference, gcd, positive_roots, primitive, product, quotient, trimmed,
};
use super::{Polynomial, Rational};
use crate::symbol::Symbol;

/// A quotient of two polynomials in one letter without a common factor.
#[derive(Clone, Debug, PartialEq)]
pub struct RationalFunction {
    pub(crate) numerator: Vec<Rational>,
    /// Monic.
    denominator: Vec<Rational>,
}

/// A factor, whole numbers without common divisor, and its power.
pub(crate) type Factor = (Vec<Rational>, i64);

impl RationalFunction {
    /// Returns the quotient of two polynomials; `None` if the divisor is zero.
    fn new(numerator: &[Rational], denominator: &[Rational]) -> Option<Self> {
        let shared = gcd(numerator, denominator);
        let (above, below) = match shared.len() {
            0 | 1 => (numerator.to_vec(), denominator.to_vec()),
            _ => (quotient(numerator, &shared), quotient(denominator, &shared)),
        };
        let below = trimmed(below);
        let leading = below.last()?.clone();
        let scaled = |list: Vec<Rational>| list.iter().map(|c| c / &leading).collect();
        Some(Self { numerator: trimmed(scaled(above)), denominator: scaled(below) })
    }

    /// A number.
    pub fn number(value: Rational) -> Self {
        Self { numerator: trimmed(vec![value]), denominator: vec![One::one()] }
    }

    /// Returns a polynomial in this letter, with exponents of either sign; `None` if it has another
    /// letter.
    pub fn from_polynomial(polynomial: &Polynomial, letter: Symbol) -> Option<Self> {
        let (lowest, highest) = polynomial.exponent_range(letter).unwrap_or((0, 0));
        let shift = lowest.min(0);
        let length = usize::try_from(highest - shift).ok()? + 1;
        let mut numerator = vec![Rational::zero(); length];
        for (monomial, number) in polynomial.terms() {
            if *monomial != Monomial::power_of(letter, monomial.exponent(letter)) {
                return None;
            }
            numerator[usize::try_from(monomial.exponent(letter) - shift).ok()?] += number;
        }
        let mut denominator = vec![Rational::zero(); usize::try_from(-shift).ok()?];
        denominator.push(One::one());
        Self::new(&numerator, &denominator)
    }

    /// Whether it is zero.
    pub fn is_zero(&self) -> bool {
        self.numerator.is_empty()
    }

    /// `self + other`.
    #[must_use]
    pub fn sum(&self, other: &Self) -> Self {
        self.difference(&other.negative())
    }

    /// `self - other`. With `g` the common divisor of both denominators it is `(a d/g - c b/g)/(b d/g)`, where
    /// only a divisor of `g` is left in common (P. Henrici, *J. ACM* 3 (1956) 6).
    #[must_use]
    pub fn difference(&self, other: &Self) -> Self {
        let shared = common_divisor(&self.denominator, &other.denominator);
        let [own, others] = [self, other].map(|part| without(&part.denominator, &shared));
        let numerator = trimmed(difference(
            &product(&self.numerator, &others),
            &product(&other.numerator, &own),
        ));
        if numerator.is_empty() {
            return Self::number(Zero::zero());
        }
        let left = common_divisor(&numerator, &shared);
        Self {
            numerator: without(&numerator, &left),
            denominator: product(&own, &without(&other.denominator, &left)),
        }
    }

    /// `self * other`. Each numerator has a common divisor with the denominator of the other alone.
    #[must_use]
    pub fn product(&self, other: &Self) -> Self {
        if self.is_zero() || other.is_zero() {
            return Self::number(Zero::zero());
        }
        let first = common_divisor(&self.numerator, &other.denominator);
        let second = common_divisor(&other.numerator, &self.denominator);
        Self {
            numerator: product(
                &without(&self.numerator, &first),
                &without(&other.numerator, &second),
            ),
            denominator: product(
                &without(&self.denominator, &second),
                &without(&other.denominator, &first),
            ),
        }
    }

    /// `-self`.
    #[must_use]
    pub fn negative(&self) -> Self {
        self.scaled(&-Rational::one())
    }

    /// `self` times a number.
    #[must_use]
    pub fn scaled(&self, factor: &Rational) -> Self {
        let numerator = trimmed(self.numerator.iter().map(|c| c * factor).collect());
        Self { numerator, denominator: self.denominator.clone() }
    }

    /// `self/other`; `None` if the divisor is zero.
    pub fn quotient(&self, other: &Self) -> Option<Self> {
        let leading = other.numerator.last()?;
        let scaled = |list: &[Rational]| list.iter().map(|c| c / leading).collect();
        let reciprocal =
            Self { numerator: scaled(&other.denominator), denominator: scaled(&other.numerator) };
        Some(self.product(&reciprocal))
    }

    /// Returns the number in front, and factors without multiple roots with their powers, negative
    /// in the denominator; rational roots have factors of their own.
    pub(crate) fn factors(&self) -> (Rational, Vec<Factor>) {
        let mut number = Rational::one();
        let mut factors: Vec<Factor> = Vec::new();
        for (polynomial, sign) in [(&self.numerator, 1), (&self.denominator, -1)] {
            let mut rest = polynomial.clone();
            for factor in distinct_factors(polynomial) {
                let mut power = 0;
                // The factor divides as long as the quotient times it is what was divided.
                while rest.len() >= factor.len() {
                    let next = quotient(&rest, &factor);
                    if product(&next, &factor) != rest {
                        break;
                    }
                    (rest, power) = (next, power + sign);
                }
                if power != 0 {
                    factors.push((factor, power));
                }
            }
            if let [content] = rest.as_slice() {
                number = if sign > 0 { number * content } else { number / content };
            }
        }
        (number, factors)
    }

    /// Returns `outer` and `inner` with `self = outer^2 inner`. Only factors that are positive at
    /// every positive value of the letter are taken out.
    pub fn square_parts(&self) -> (Self, Self) {
        let mut outer = Self::number(Rational::one());
        for (factor, power) in self.factors().1 {
            if factor.iter().any(Signed::is_negative) {
                continue;
            }
            let factor = Self { numerator: factor, denominator: vec![One::one()] };
            for _ in 0..(power.abs() / 2) {
                let next = match power > 0 {
                    true => Some(outer.product(&factor)),
                    false => outer.quotient(&factor),
                };
                outer = next.unwrap_or(outer);
            }
        }
        let inner = self.quotient(&outer.product(&outer));
        match inner {
            Some(inner) => (outer, inner),
            None => (Self::number(Rational::one()), self.clone()),
        }
    }
}

/// The monic common divisor of two polynomials that are not zero.
fn common_divisor(a: &[Rational], b: &[Rational]) -> Vec<Rational> {
    match a.len() <= 1 || b.len() <= 1 {
        true => vec![One::one()],
        false => gcd(a, b),
    }
}

/// A polynomial over a monic divisor of it.
fn without(polynomial: &[Rational], divisor: &[Rational]) -> Vec<Rational> {
    match divisor.len() <= 1 {
        true => polynomial.to_vec(),
        false => quotient(polynomial, divisor),
    }
}

/// The distinct factors of a polynomial: its rational roots, then what is left of each
/// multiplicity.
fn distinct_factors(polynomial: &[Rational]) -> Vec<Vec<Rational>> {
    let mut factors = Vec::new();
    let mut shared = polynomial.to_vec();
    // The products of the roots of multiplicity 1 and more, 2 and more, ...
    let mut levels: Vec<Vec<Rational>> = Vec::new();
    while shared.len() > 1 {
        let next = gcd(&shared, &derivative(&shared));
        levels.push(quotient(&shared, &next));
        shared = next;
    }
    levels.push(vec![One::one()]);
    for pair in levels.windows(2) {
        let mut rest = quotient(&pair[0], &pair[1]);
        let mut linear: Vec<Vec<Rational>> = Vec::new();
        if rest.first().is_some_and(Zero::is_zero) {
            linear.push(vec![Zero::zero(), One::one()]);
        }
        for sign in [Rational::one(), -Rational::one()] {
            let mut power = Rational::one();
            let mirrored: Vec<Rational> = rest
                .iter()
                .map(|c| {
                    let value = c * &power;
                    power *= &sign;
                    value
                })
                .collect();
            let roots = positive_roots(&mirrored).into_iter().filter_map(|root| root.exact);
            linear.extend(roots.map(|root| vec![-root * &sign, One::one()]));
        }
        for factor in &linear {
            rest = quotient(&rest, factor);
        }
        factors.extend(linear.into_iter().chain((rest.len() > 1).then_some(rest)));
    }
    let whole = |factor: Vec<Rational>| -> Vec<Rational> {
        let whole: Vec<Rational> =
            primitive(&factor).into_iter().map(Rational::from_integer).collect();
        match whole.last().is_some_and(Signed::is_negative) {
            true => whole.iter().map(|c| -c).collect(),
            false => whole,
        }
    };
    factors.into_iter().map(whole).collect()
}

/// A number `rational + coefficient*sqrt(radicand)` over the rational functions of one letter.
#[derive(Clone, Debug, PartialEq)]
pub struct QuadraticSurd {
    /// The part without the root.
    pub rational: RationalFunction,
    /// The factor of the root.
    pub coefficient: RationalFunction,
    /// The radicand, one for all numbers that are computed with each other.
    pub radicand: RationalFunction,
}

impl QuadraticSurd {
    /// Returns `rational + coefficient*sqrt(radicand)`, squares taken out of the root.
    pub fn new(
        rational: RationalFunction,
        coefficient: &RationalFunction,
        radicand: &RationalFunction,
    ) -> Self {
        let (outer, inner) = radicand.square_parts();
        Self { rational, coefficient: coefficient.product(&outer), radicand: inner }
    }

    /// The surd of this field with these two parts.
    fn with(&self, rational: RationalFunction, coefficient: RationalFunction) -> Self {
        Self { rational, coefficient, radicand: self.radicand.clone() }
    }

    /// A rational function as a number of this field.
    #[must_use]
    pub fn constant(&self, value: RationalFunction) -> Self {
        self.with(value, RationalFunction::number(Zero::zero()))
    }

    /// `self + other`.
    #[must_use]
    pub fn sum(&self, other: &Self) -> Self {
        self.with(self.rational.sum(&other.rational), self.coefficient.sum(&other.coefficient))
    }

    /// `self * other`.
    #[must_use]
    pub fn product(&self, other: &Self) -> Self {
        let roots = self.coefficient.product(&other.coefficient).product(&self.radicand);
        self.with(
            self.rational.product(&other.rational).sum(&roots),
            self.rational
                .product(&other.coefficient)
                .sum(&self.coefficient.product(&other.rational)),
        )
    }

    /// The number with the other sign of the root.
    #[must_use]
    pub fn conjugate(&self) -> Self {
        self.with(self.rational.clone(), self.coefficient.negative())
    }

    /// `self/other`; `None` if the divisor is zero.
    pub fn quotient(&self, other: &Self) -> Option<Self> {
        let above = self.product(&other.conjugate());
        let norm = other.product(&other.conjugate()).rational;
        Some(self.with(above.rational.quotient(&norm)?, above.coefficient.quotient(&norm)?))
    }

    /// The value of a polynomial with these coefficients, lowest first.
    #[must_use]
    pub fn value_of(&self, coefficients: &[RationalFunction]) -> Self {
        let zero = self.constant(RationalFunction::number(Zero::zero()));
        coefficients.iter().rev().fold(zero, |sum, coefficient| {
            sum.product(self).sum(&self.constant(coefficient.clone()))
        })
    }

    /// Returns the common factor of both parts, and the two parts without it, which are polynomials.
    pub(crate) fn common_factor(&self) -> Option<(RationalFunction, [RationalFunction; 2])> {
        let parts = [&self.rational, &self.coefficient];
        let below = {
            let [a, b] = parts.map(|part| part.denominator.clone());
            quotient(&product(&a, &b), &gcd(&a, &b))
        };
        let scale = RationalFunction { numerator: below, denominator: vec![One::one()] };
        let [a, b] = parts.map(|part| part.product(&scale).numerator);
        let mut shared = gcd(&a, &b);
        // Whole numbers without a common divisor in both together.
        let together: Vec<Rational> =
            [&a, &b].iter().flat_map(|list| quotient(list, &shared)).collect();
        let position = together.iter().position(|c| !c.is_zero())?;
        let whole = primitive(&together);
        let content = &together[position] / Rational::from_integer(whole[position].clone());
        shared = shared.iter().map(|c| c * &content).collect();
        let shared = RationalFunction { numerator: shared, denominator: vec![One::one()] };
        let factor = shared.quotient(&scale)?;
        let rest = [self.rational.quotient(&factor)?, self.coefficient.quotient(&factor)?];
        Some((factor, rest))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::ratio;

    fn mu() -> RationalFunction {
        RationalFunction::from_polynomial(&Polynomial::symbol("mu".into()), "mu".into())
            .expect("a letter")
    }

    fn number(value: i64) -> RationalFunction {
        RationalFunction::number(ratio(value, 1))
    }

    #[test]
    fn quotients_of_surds_are_exact() {
        let surd = |a: i64, b: i64| QuadraticSurd {
            rational: number(a).sum(&mu()),
            coefficient: number(b),
            radicand: number(4).sum(&mu().scaled(&ratio(3, 1))),
        };
        let (a, b) = (surd(3, 2), surd(-1, 5));
        let back = a.quotient(&b).expect("a divisor").product(&b);
        assert_eq!(back, a);
        assert!(a.quotient(&a.constant(number(0))).is_none());
    }

    /// Sums, products and quotients beside the same in one fraction, reduced at the end.
    #[test]
    fn results_are_in_lowest_terms() {
        let list = |all: &[i64]| all.iter().map(|c| ratio(*c, 1)).collect::<Vec<_>>();
        let fraction = |above: &[i64], below: &[i64]| {
            RationalFunction::new(&list(above), &list(below)).expect("a fraction")
        };
        let all = [
            fraction(&[0, 2, 2], &[6, 5, 1]),
            fraction(&[3, 4, 1], &[-4, 0, 9]),
            fraction(&[-2, 3], &[2, 3, 1]),
            fraction(&[4, 12, 9], &[0, 7]),
            fraction(&[5], &[1]),
            number(0),
        ];
        for (one, other) in all.iter().flat_map(|one| all.iter().map(move |other| (one, other))) {
            let [[a, b], [c, d]] = [one, other].map(|part| [&part.numerator, &part.denominator]);
            let whole =
                |above: Vec<Rational>, below: &[Rational]| RationalFunction::new(&above, below);
            let apart = difference(&product(a, d), &product(c, b));
            assert_eq!(Some(one.difference(other)), whole(apart, &product(b, d)));
            assert_eq!(Some(one.product(other)), whole(product(a, c), &product(b, d)));
            assert_eq!(one.quotient(other), whole(product(a, d), &product(b, c)));
        }
    }
}
