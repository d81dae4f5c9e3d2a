//! The arithmetic that a derivation needs of its coefficients.
//!
//! A series and a perturbation method are written once, over any [`Ring`]. A ring is a value, to
//! which its elements do not refer: any parameter of the arithmetic, such as a prime or a working
//! precision chosen at run time, is a field of the ring, kept once for a whole series. The exact
//! numbers have no such parameter, and their rings are empty structs.
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
//! fails or gives a wrong value; `FourierSeries::divided` reports it, and the elimination of
//! secular terms, which asks after every order, ends with it as its error.
//!
//! A term is left out of a series only if it is [certainly zero](Ring::is_certainly_zero). An
//! interval that contains zero stays, and so does a residue of zero: it may be that of a multiple
//! of the prime, which would be lost silently if it were left out before a division by the prime.

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

/// A commutative ring with one, whose elements are the coefficients of a series. The laws of a ring
/// hold as far as its elements are exact.
pub trait Ring: Clone + Debug + PartialEq {
    /// A coefficient.
    type Element: Clone + Debug + PartialEq + 'static;

    /// Whether [`Ring::divide`] divides elements by integers; otherwise the series keeps a
    /// denominator, and [`Ring::reduce`] cancels its common factors with the elements.
    const FIELD: bool;

    /// Zero.
    fn zero(&self) -> Self::Element;
    /// The image of an integer.
    fn integer(&self, value: i64) -> Self::Element;
    /// Whether the number that the element stands for can only be zero, so that it need not be
    /// kept. This is true of [`Ring::zero`] and its products, and false of an interval that
    /// contains other numbers and of the residue of a multiple of the prime.
    fn is_certainly_zero(&self, element: &Self::Element) -> bool;
    /// Whether nothing shows that the number is not zero: the same as [`Ring::is_certainly_zero`]
    /// where elements are exact.
    fn may_be_zero(&self, element: &Self::Element) -> bool {
        self.is_certainly_zero(element)
    }
    /// `sum += term`, in place.
    fn accumulate(&self, sum: &mut Self::Element, term: &Self::Element);
    /// `sum += term` as by [`Ring::accumulate`], for a term that is not needed any more.
    fn add(&self, sum: &mut Self::Element, term: Self::Element) {
        self.accumulate(sum, &term);
    }
    /// `-element`, in place.
    fn negate(&self, element: &mut Self::Element);
    /// `left * right`.
    fn product(&self, left: &Self::Element, right: &Self::Element) -> Self::Element;
    /// `element *= factor`.
    fn scale(&self, element: &mut Self::Element, factor: i64);
    /// `element *= factor` with a factor of any length, such as the ratio of two denominators.
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
    /// Divides `elements` and their `denominator`, which is positive, by their greatest common
    /// divisor. A field does nothing.
    fn reduce<'a>(
        &self,
        elements: impl IntoIterator<Item = &'a mut Self::Element>,
        denominator: &mut Integer,
    ) {
        let _ = (elements.into_iter(), denominator);
    }
    /// The pair `unit` and `integer` with `element * unit = integer`; `None` if the element has no
    /// such pair: the step from a linear equation `element * x = b` to `x = b * unit / integer`.
    fn inverse(&self, element: &Self::Element) -> Option<(Self::Element, Integer)>;
    /// Twice the product of two series in `cos(k theta)`, whose elements are the coefficients by `k`,
    /// for rings that form it faster as a whole than product by product; `None` for all others.
    fn doubled_cosine_product(
        &self,
        left: &[Self::Element],
        right: &[Self::Element],
    ) -> Option<Vec<Self::Element>> {
        let _ = (left, right);
        None
    }
    /// The numerators of elements over one positive common denominator; `None` if elements are
    /// neither whole numbers nor fractions.
    fn numerators<'a>(
        &self,
        elements: impl Iterator<Item = &'a Self::Element>,
    ) -> Option<(Vec<Integer>, Integer)> {
        let _ = elements;
        None
    }
    /// The element with this numerator over a product of denominators of [`Ring::numerators`];
    /// `None` if the ring has none.
    fn fraction(&self, numerator: Integer, denominator: &Integer) -> Option<Self::Element> {
        let _ = (numerator, denominator);
        None
    }
}

/// An element whose ring has no parameters, so that its type determines the ring.
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
    fn numerators<'a>(
        &self,
        elements: impl Iterator<Item = &'a Integer>,
    ) -> Option<(Vec<Integer>, Integer)> {
        Some((elements.cloned().collect(), Integer::one()))
    }
    fn fraction(&self, numerator: Integer, denominator: &Integer) -> Option<Integer> {
        denominator.is_one().then_some(numerator)
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
    fn numerators<'a>(
        &self,
        elements: impl Iterator<Item = &'a Rational>,
    ) -> Option<(Vec<Integer>, Integer)> {
        let elements: Vec<&Rational> = elements.collect();
        let denominator =
            elements.iter().fold(Integer::one(), |common, element| match element.denom() {
                denominator if denominator.is_one() || *denominator == common => common,
                denominator => common.lcm(denominator),
            });
        let numerator = |element: &&Rational| element.numer() * (&denominator / element.denom());
        Some((elements.iter().map(numerator).collect(), denominator))
    }
    fn fraction(&self, numerator: Integer, denominator: &Integer) -> Option<Rational> {
        Some(Rational::new(numerator, denominator.clone()))
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
