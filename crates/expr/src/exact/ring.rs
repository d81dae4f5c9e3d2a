//! The arithmetic that a derivation needs of its coefficients.
//!
//! A series and a perturbation method are written once, over any [`Ring`]. A ring is a value, and
//! its elements know nothing of it: what the arithmetic needs to know beside them, a prime or a
//! working precision chosen at run time, is a field of the ring, kept once for a whole series. The
//! exact numbers need nothing of the kind, and their rings are empty structs.
//!
//! | ring | its elements | divides by integers |
//! | --- | --- | --- |
//! | [`Integers`] | [`Integer`] | no: the series keeps one denominator |
//! | [`Rationals`] | [`Rational`] | yes |
//! | [`Doubles`] | `f64` | yes, rounded |
//! | [`Polynomials`](super::Polynomials) | [`Polynomial`](super::Polynomial) | as its coefficients do |
//!
//! Two kinds of ring exist. A [field](Ring::FIELD) divides in place. A ring of *numerators* does
//! not, and the series that holds its elements keeps one denominator for all of them: products are
//! then products of integers, and one greatest common divisor per series and order replaces one per
//! addition, which is what makes exact series fast.
//!
//! A field may still be unable to divide by some integers, as residues are by multiples of their
//! prime. Such a divisor stays in the denominator of the series too, so that no operation on series
//! fails or gives a wrong value; `FourierSeries::divided` tells of it, and the elimination of
//! secular terms, which asks after every order, ends with that as its error.
//!
//! Nothing is left out of a series but what is [certainly zero](Ring::is_certainly_zero). An
//! interval that contains zero stays, and so does a residue that came out as zero: it may be that
//! of a multiple of the prime, and left out before a division by the prime it would be lost without
//! a word.

use std::fmt::Debug;

use num_integer::Integer as _;
use num_traits::{One, Signed, Zero};

use super::rational::{Integer, Rational, to_f64};

/// An integer by which a ring cannot divide.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no division by {divisor} in {ring}")]
pub struct NotInvertible {
    /// The integer without an inverse.
    pub divisor: Integer,
    /// The ring in words, with whatever was chosen at run time: `the residues modulo 7`.
    pub ring: String,
}

/// A commutative ring with one, seen as the coefficients of a series. The laws of a ring hold as
/// far as its elements are exact.
pub trait Ring: Clone + Debug + PartialEq {
    /// A coefficient.
    type Element: Clone + Debug + PartialEq + 'static;

    /// Whether [`Ring::divide`] is how elements are divided by integers; otherwise the series keeps
    /// a denominator and [`Ring::reduce`] finds what it has in common with the elements.
    const FIELD: bool;

    /// Zero.
    fn zero(&self) -> Self::Element;
    /// The image of an integer.
    fn integer(&self, value: i64) -> Self::Element;
    /// Whether the number that the element stands for can only be zero, so that it need not be
    /// kept. [`Ring::zero`] is so, and its products are; an interval that contains other numbers
    /// and a residue of some multiple of the prime are not.
    fn is_certainly_zero(&self, element: &Self::Element) -> bool;
    /// Whether nothing shows that the number is not zero: the same as [`Ring::is_certainly_zero`]
    /// where elements are exact.
    fn may_be_zero(&self, element: &Self::Element) -> bool {
        self.is_certainly_zero(element)
    }
    /// `sum += term`, in place.
    fn accumulate(&self, sum: &mut Self::Element, term: &Self::Element);
    /// As [`Ring::accumulate`] with a term that is not needed any more.
    fn add(&self, sum: &mut Self::Element, term: Self::Element) {
        self.accumulate(sum, &term);
    }
    /// `-element`, in place.
    fn negate(&self, element: &mut Self::Element);
    /// `left * right`.
    fn product(&self, left: &Self::Element, right: &Self::Element) -> Self::Element;
    /// `element *= factor`.
    fn scale(&self, element: &mut Self::Element, factor: i64);
    /// `element *= factor` where the factor may be of any length: the ratio of two denominators.
    fn scale_by(&self, element: &mut Self::Element, factor: &Integer);
    /// Divides all of `elements` by `divisor`, which is not zero.
    ///
    /// # Errors
    /// `divisor` has no inverse, which depends on `divisor` alone; all elements are unchanged.
    fn divide<'a>(
        &self,
        elements: impl IntoIterator<Item = &'a mut Self::Element>,
        divisor: &Integer,
    ) -> Result<(), NotInvertible>;
    /// Divides `elements` and their `denominator`, which is positive, by what they have in common.
    /// A field has nothing to do.
    fn reduce<'a>(
        &self,
        elements: impl IntoIterator<Item = &'a mut Self::Element>,
        denominator: &mut Integer,
    ) {
        let _ = (elements.into_iter(), denominator);
    }
    /// `unit` and `integer` with `element * unit = integer`, where the element has such a pair: the
    /// step from a linear equation `element * x = b` to `x = b * unit / integer`.
    fn inverse(&self, element: &Self::Element) -> Option<(Self::Element, Integer)>;
}

/// An element whose ring has nothing to choose, so that it need not be named.
pub trait Number: Clone + Debug + PartialEq + 'static {
    /// The ring of such elements.
    type Ring: Ring<Element = Self> + Default;
}

/// The ring of whole numbers, numerators of a series over one denominator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Integers;

/// The field of fractions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rationals;

/// Floating point. It rounds, so the laws of a ring hold to rounding only; series over it are for
/// drawing and checking.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Doubles;

impl Number for Integer {
    type Ring = Integers;
}

impl Number for Rational {
    type Ring = Rationals;
}

impl Ring for Integers {
    type Element = Integer;

    const FIELD: bool = false;

    fn zero(&self) -> Integer {
        Integer::zero()
    }
    fn integer(&self, value: i64) -> Integer {
        value.into()
    }
    fn is_certainly_zero(&self, element: &Integer) -> bool {
        element.is_zero()
    }
    fn accumulate(&self, sum: &mut Integer, term: &Integer) {
        *sum += term;
    }
    fn add(&self, sum: &mut Integer, term: Integer) {
        *sum += term;
    }
    fn negate(&self, element: &mut Integer) {
        *element = -std::mem::take(element);
    }
    fn product(&self, left: &Integer, right: &Integer) -> Integer {
        left * right
    }
    fn scale(&self, element: &mut Integer, factor: i64) {
        *element *= Integer::from(factor);
    }
    fn scale_by(&self, element: &mut Integer, factor: &Integer) {
        *element *= factor;
    }
    fn divide<'a>(
        &self,
        elements: impl IntoIterator<Item = &'a mut Integer>,
        divisor: &Integer,
    ) -> Result<(), NotInvertible> {
        // One and minus one are their own inverses.
        if !divisor.abs().is_one() {
            return Err(NotInvertible {
                divisor: divisor.clone(),
                ring: "the integers".to_owned(),
            });
        }
        elements.into_iter().for_each(|element| *element *= divisor);
        Ok(())
    }
    fn reduce<'a>(
        &self,
        elements: impl IntoIterator<Item = &'a mut Integer>,
        denominator: &mut Integer,
    ) {
        let mut elements: Vec<&mut Integer> = elements.into_iter().collect();
        let mut common = denominator.clone();
        for element in &elements {
            if common.is_one() {
                return;
            }
            common = common.gcd(&**element);
        }
        if !common.is_one() {
            *denominator /= &common;
            elements.iter_mut().for_each(|element| **element /= &common);
        }
    }
    fn inverse(&self, element: &Integer) -> Option<(Integer, Integer)> {
        (!element.is_zero()).then(|| (Integer::one(), element.clone()))
    }
}

impl Ring for Rationals {
    type Element = Rational;

    const FIELD: bool = true;

    fn zero(&self) -> Rational {
        Rational::zero()
    }
    fn integer(&self, value: i64) -> Rational {
        Rational::from_integer(value.into())
    }
    fn is_certainly_zero(&self, element: &Rational) -> bool {
        element.is_zero()
    }
    fn accumulate(&self, sum: &mut Rational, term: &Rational) {
        *sum = super::rational::sum(sum, term);
    }
    fn negate(&self, element: &mut Rational) {
        *element = -std::mem::replace(element, Rational::zero());
    }
    fn product(&self, left: &Rational, right: &Rational) -> Rational {
        super::rational::product(left, right)
    }
    fn scale(&self, element: &mut Rational, factor: i64) {
        self.scale_by(element, &factor.into());
    }
    fn scale_by(&self, element: &mut Rational, factor: &Integer) {
        *element *= factor;
    }
    fn divide<'a>(
        &self,
        elements: impl IntoIterator<Item = &'a mut Rational>,
        divisor: &Integer,
    ) -> Result<(), NotInvertible> {
        elements.into_iter().for_each(|element| *element /= divisor);
        Ok(())
    }
    fn inverse(&self, element: &Rational) -> Option<(Rational, Integer)> {
        (!element.is_zero()).then(|| (element.recip(), Integer::one()))
    }
}

impl Ring for Doubles {
    type Element = f64;

    const FIELD: bool = true;

    fn zero(&self) -> f64 {
        0.0
    }
    fn integer(&self, value: i64) -> f64 {
        value as f64
    }
    fn is_certainly_zero(&self, element: &f64) -> bool {
        *element == 0.0
    }
    fn accumulate(&self, sum: &mut f64, term: &f64) {
        *sum += term;
    }
    fn negate(&self, element: &mut f64) {
        *element = -*element;
    }
    fn product(&self, left: &f64, right: &f64) -> f64 {
        left * right
    }
    fn scale(&self, element: &mut f64, factor: i64) {
        *element *= factor as f64;
    }
    fn scale_by(&self, element: &mut f64, factor: &Integer) {
        *element *= to_f64(&Rational::from_integer(factor.clone()));
    }
    fn divide<'a>(
        &self,
        elements: impl IntoIterator<Item = &'a mut f64>,
        divisor: &Integer,
    ) -> Result<(), NotInvertible> {
        let divisor = to_f64(&Rational::from_integer(divisor.clone()));
        elements.into_iter().for_each(|element| *element /= divisor);
        Ok(())
    }
    fn inverse(&self, element: &f64) -> Option<(f64, Integer)> {
        (*element != 0.0).then(|| (element.recip(), Integer::one()))
    }
}
