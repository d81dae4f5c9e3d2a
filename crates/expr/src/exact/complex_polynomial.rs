//! Complex numbers whose parts are polynomials in real symbols and in pairs of conjugate ones.

use num_traits::Zero;

use super::polynomial::Monomial;
use super::{Polynomial, Rational};
use crate::symbol::Symbol;

/// A complex number whose parts are polynomials in real symbols, and in complex amplitudes and their
/// conjugates, each of which has a symbol.
#[derive(Clone, Debug, PartialEq)]
pub struct ComplexPolynomial {
    /// Real part.
    pub real: Polynomial,
    /// Imaginary part.
    pub imaginary: Polynomial,
}

impl ComplexPolynomial {
    /// Zero.
    pub fn zero() -> Self {
        Self { real: Polynomial::zero(), imaginary: Polynomial::zero() }
    }

    /// Whether both parts are zero.
    pub fn is_zero(&self) -> bool {
        self.real.is_zero() && self.imaginary.is_zero()
    }

    /// The number without an imaginary part.
    pub fn real(real: Polynomial) -> Self {
        Self { real, imaginary: Polynomial::zero() }
    }

    /// Adds another one.
    pub fn accumulate(&mut self, other: &Self) {
        self.real.accumulate(&other.real);
        self.imaginary.accumulate(&other.imaginary);
    }

    /// Its negative.
    #[must_use]
    pub fn negative(mut self) -> Self {
        self.real.negate();
        self.imaginary.negate();
        self
    }

    /// The product.
    #[must_use]
    pub fn product(&self, other: &Self) -> Self {
        let mut real = self.imaginary.product(&other.imaginary);
        real.negate();
        real.accumulate(&self.real.product(&other.real));
        let mut imaginary = self.real.product(&other.imaginary);
        imaginary.accumulate(&self.imaginary.product(&other.real));
        Self { real, imaginary }
    }

    /// The product with a real factor.
    #[must_use]
    pub fn times(&self, factor: &Polynomial) -> Self {
        Self { real: self.real.product(factor), imaginary: self.imaginary.product(factor) }
    }

    /// `i` times it.
    #[must_use]
    pub fn times_i(&self) -> Self {
        let mut real = self.imaginary.clone();
        real.negate();
        Self { real, imaginary: self.real.clone() }
    }

    /// Its conjugate, with the symbols of each pair exchanged.
    #[must_use]
    pub fn conjugate(&self, pairs: &[[Symbol; 2]]) -> Self {
        let mut imaginary = exchanged(&self.imaginary, pairs);
        imaginary.negate();
        Self { real: exchanged(&self.real, pairs), imaginary }
    }

    /// Its derivative with respect to a symbol.
    #[must_use]
    pub fn slope(&self, symbol: Symbol) -> Self {
        Self { real: self.real.slope(symbol), imaginary: self.imaginary.slope(symbol) }
    }

    /// Both parts changed alike.
    #[must_use]
    pub fn map(&self, change: impl Fn(&Polynomial) -> Polynomial) -> Self {
        Self { real: change(&self.real), imaginary: change(&self.imaginary) }
    }
}

/// A polynomial with the symbols of each pair exchanged.
fn exchanged(polynomial: &Polynomial, pairs: &[[Symbol; 2]]) -> Polynomial {
    let mut result: Polynomial<Rational> = Polynomial::zero();
    for (monomial, number) in polynomial.terms() {
        let turned = pairs.iter().fold(monomial.clone(), |monomial, [own, conjugate]| {
            let (p, q) = (monomial.exponent(*own), monomial.exponent(*conjugate));
            let rest = monomial.without(*own).without(*conjugate);
            rest.product(&Monomial::power_of(*own, q).product(&Monomial::power_of(*conjugate, p)))
        });
        result.add_term(turned, number.clone());
    }
    result
}
