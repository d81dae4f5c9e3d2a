//! What a derivation asks of its coefficients.
//!
//! A series and a perturbation method are written once, over any [`Ring`]. Two kinds of ring exist:
//!
//! - a *field* ([`Rational`], `f64`, polynomials over them) divides by an integer itself;
//! - a ring of *numerators* ([`Integer`], polynomials over it) does not, and the series that holds its elements keeps one
//!   denominator for all of them. Products are then products of integers, and one greatest common divisor per series and
//!   order replaces one per addition, which is what makes exact series fast.

use std::fmt::Debug;

use num_integer::Integer as _;
use num_traits::{One, Signed, Zero};

use super::rational::{Integer, Rational};

/// A commutative ring with one, seen as coefficients of a series.
pub trait Ring: Zero + Clone + PartialEq + Debug {
    /// Whether every non-zero integer divides every element; [`Ring::divide`] may be called only then.
    const FIELD: bool;

    /// The image of an integer.
    fn from_integer(value: &Integer) -> Self;
    /// `self += other`, in place.
    fn accumulate(&mut self, other: &Self);
    /// `self *= factor`.
    fn scale(&mut self, factor: &Integer);
    /// `self * other`.
    fn product(&self, other: &Self) -> Self;
    /// `self /= divisor` exactly: any divisor in a field, one that divides [`Ring::content`] otherwise.
    fn divide(&mut self, divisor: &Integer);
    /// The greatest integer that divides this element; one in a field, zero for zero.
    fn content(&self) -> Integer;
    /// `unit` and `integer` with `self * unit = integer`, where this element has such a pair: the step from a linear
    /// equation `self * x = b` to `x = b * unit / integer`.
    fn inverse(&self) -> Option<(Self, Integer)>;
    /// `-self`.
    fn negate(&mut self) {
        self.scale(&-Integer::one());
    }
}

impl Ring for Integer {
    const FIELD: bool = false;

    fn from_integer(value: &Integer) -> Self {
        value.clone()
    }
    fn accumulate(&mut self, other: &Self) {
        *self += other;
    }
    fn scale(&mut self, factor: &Integer) {
        *self *= factor;
    }
    fn product(&self, other: &Self) -> Self {
        self * other
    }
    fn divide(&mut self, divisor: &Integer) {
        *self /= divisor;
    }
    fn content(&self) -> Integer {
        self.abs()
    }
    fn inverse(&self) -> Option<(Self, Integer)> {
        (!self.is_zero()).then(|| (One::one(), self.clone()))
    }
}

impl Ring for Rational {
    const FIELD: bool = true;

    fn from_integer(value: &Integer) -> Self {
        Self::from_integer(value.clone())
    }
    fn accumulate(&mut self, other: &Self) {
        *self += other;
    }
    fn scale(&mut self, factor: &Integer) {
        *self *= factor;
    }
    fn product(&self, other: &Self) -> Self {
        self * other
    }
    fn divide(&mut self, divisor: &Integer) {
        *self /= divisor;
    }
    fn content(&self) -> Integer {
        if self.is_zero() { Zero::zero() } else { One::one() }
    }
    fn inverse(&self) -> Option<(Self, Integer)> {
        (!self.is_zero()).then(|| (self.recip(), One::one()))
    }
}

/// Floating point rounds, so its ring laws hold to rounding only; series over it are for drawing and checking.
impl Ring for f64 {
    const FIELD: bool = true;

    fn from_integer(value: &Integer) -> Self {
        super::rational::to_f64(&Rational::from_integer(value.clone()))
    }
    fn accumulate(&mut self, other: &Self) {
        *self += other;
    }
    fn scale(&mut self, factor: &Integer) {
        *self *= Self::from_integer(factor);
    }
    fn product(&self, other: &Self) -> Self {
        self * other
    }
    fn divide(&mut self, divisor: &Integer) {
        *self /= Self::from_integer(divisor);
    }
    fn content(&self) -> Integer {
        if *self == 0.0 { Zero::zero() } else { One::one() }
    }
    fn inverse(&self) -> Option<(Self, Integer)> {
        (*self != 0.0).then(|| (self.recip(), One::one()))
    }
}

/// The greatest common divisor of the contents of `elements` and of `start`, stopping early at one.
pub fn common_content<'a, C: Ring + 'a>(start: Integer, elements: impl IntoIterator<Item = &'a C>) -> Integer {
    let mut divisor = start;
    for element in elements {
        if divisor.is_one() {
            break;
        }
        divisor = divisor.gcd(&element.content());
    }
    divisor
}
