//! Fourier series in `theta = omega t`, over any coefficient ring.
//!
//! `u(theta) = c_0 + c_1 cos theta + s_1 sin theta + c_2 cos 2 theta + ...`, a finite sum. A series
//! holds its ring and one denominator for all its coefficients, which stays one if the ring can
//! divide (see [`Ring::FIELD`]).
//!
//! Perturbation methods need three operations: the product `2 cos i cos j = cos(i+j) + cos(i-j)`,
//! the derivative, and the solution of `u'' + u = r`, whose resonant part
//! `r_1 cos theta + q_1 sin theta` no periodic `u` can balance, so that it is returned to the
//! caller.
//!
//! The series in one operation must be over the same ring: the same prime, the same precision.

use std::borrow::Cow;

use num_integer::Integer as _;
use num_traits::{One, Signed, Zero};

use crate::exact::ring::{Doubles, NotInvertible, Ring};
use crate::exact::{Integer, Polynomial, Polynomials, Rational};

/// A finite Fourier series. Every operation reduces its result to lowest terms, so that equal
/// functions are equal values.
#[derive(Clone, Debug, PartialEq)]
pub struct FourierSeries<R: Ring> {
    ring: R,
    /// Common denominator of all coefficients, positive; over a field one, or the product of the
    /// divisors that have no inverse.
    denominator: Integer,
    /// Numerators of `cos k theta`, `k = 0, 1, ...`.
    cosine: Vec<R::Element>,
    /// Numerators of `sin k theta`; the entry for `k = 0` is zero.
    sine: Vec<R::Element>,
}

/// The part of a right-hand side at the natural frequency: `cosine cos theta + sine sin theta`,
/// each a constant series.
#[derive(Clone, Debug, PartialEq)]
pub struct ResonantPart<R: Ring> {
    /// The coefficient of `cos theta`.
    pub cosine: FourierSeries<R>,
    /// The coefficient of `sin theta`.
    pub sine: FourierSeries<R>,
}

impl<R: Ring> FourierSeries<R> {
    /// The series without terms.
    pub fn zero(ring: R) -> Self {
        Self::raw(ring, vec![], vec![])
    }

    /// The constant `value`.
    pub fn constant(ring: R, value: R::Element) -> Self {
        Self::from_parts(ring, vec![value], vec![])
    }

    /// The integer `value` as a constant series.
    pub fn integer(ring: R, value: i64) -> Self {
        let value = ring.integer(value);
        Self::constant(ring, value)
    }

    /// `cos(k theta)`.
    pub fn cos(ring: R, k: usize) -> Self {
        let wave = unit(&ring, k);
        Self::from_parts(ring, wave, vec![])
    }

    /// `sin(k theta)`.
    pub fn sin(ring: R, k: usize) -> Self {
        let wave = unit(&ring, k);
        Self::from_parts(ring, vec![], wave)
    }

    /// The series with these coefficients of `cos k theta` and `sin k theta`, `k = 0, 1, ...`;
    /// `sine[0]` is ignored.
    pub fn from_parts(ring: R, cosine: Vec<R::Element>, mut sine: Vec<R::Element>) -> Self {
        if let Some(first) = sine.first_mut() {
            *first = ring.zero();
        }
        let mut series = Self::raw(ring, cosine, sine);
        series.reduce();
        series
    }

    /// The series over a denominator that has nothing in common with all of its numerators;
    /// trailing zeros are dropped.
    #[inline]
    pub fn in_lowest_terms(
        ring: R,
        denominator: Integer,
        cosine: Vec<R::Element>,
        sine: Vec<R::Element>,
    ) -> Self {
        let mut series = Self { ring, denominator, cosine, sine };
        series.drop_trailing_zeros();
        series
    }

    fn raw(ring: R, cosine: Vec<R::Element>, sine: Vec<R::Element>) -> Self {
        Self { ring, denominator: Integer::one(), cosine, sine }
    }

    /// The ring of the coefficients.
    pub fn ring(&self) -> &R {
        &self.ring
    }

    /// Whether the series has no terms.
    pub fn is_zero(&self) -> bool {
        self.cosine.is_empty() && self.sine.is_empty()
    }

    /// Whether nothing shows that the series is not zero: the same as [`FourierSeries::is_zero`]
    /// where coefficients are exact.
    pub fn may_be_zero(&self) -> bool {
        self.numerators().all(|numerator| self.ring.may_be_zero(numerator))
    }

    /// Whether the ring could divide by everything it had to: over a field, whether no denominator
    /// is left.
    ///
    /// # Errors
    /// [`NotInvertible`] with the product of the divisors that remain.
    pub fn divided(&self) -> Result<(), NotInvertible> {
        match R::FIELD && !self.denominator.is_one() {
            true => self.ring.divide(std::iter::empty(), &self.denominator),
            false => Ok(()),
        }
    }

    /// The highest harmonic with a non-zero coefficient; zero for a constant.
    pub fn highest_harmonic(&self) -> usize {
        self.cosine.len().max(self.sine.len()).saturating_sub(1)
    }

    /// The coefficient of `cos k theta` as a constant series.
    pub fn cosine(&self, k: usize) -> Self {
        self.constant_of(self.cosine.get(k))
    }

    /// The coefficient of `sin k theta` as a constant series.
    pub fn sine(&self, k: usize) -> Self {
        self.constant_of(self.sine.get(k))
    }

    fn constant_of(&self, coefficient: Option<&R::Element>) -> Self {
        let mut series = Self {
            ring: self.ring.clone(),
            denominator: self.denominator.clone(),
            cosine: coefficient.cloned().into_iter().collect(),
            sine: vec![],
        };
        series.reduce();
        series
    }

    /// Numerator and denominator of the constant term: the mean over a period.
    pub fn mean(&self) -> (R::Element, &Integer) {
        let mean = self.cosine.first().cloned();
        (mean.unwrap_or_else(|| self.ring.zero()), &self.denominator)
    }

    /// The numerators of all cosines and sines, zeros between them included.
    pub fn numerators(&self) -> impl Iterator<Item = &R::Element> {
        self.cosine.iter().chain(&self.sine)
    }

    /// Whether no sine occurs.
    pub fn is_even(&self) -> bool {
        self.sine.is_empty()
    }

    /// The sum.
    pub fn sum(&self, other: &Self) -> Self {
        linear_combination(&self.ring, &[(1, self), (1, other)])
    }

    /// The difference.
    pub fn difference(&self, other: &Self) -> Self {
        linear_combination(&self.ring, &[(1, self), (-1, other)])
    }

    /// The product; (number of harmonics)^2 coefficient products.
    pub fn product(&self, other: &Self) -> Self {
        sum_of_products(&self.ring, &[(1, self, other)])
    }

    /// The `exponent`-th power.
    pub fn power(&self, exponent: u32) -> Self {
        (0..exponent).fold(Self::integer(self.ring.clone(), 1), |power, _| power.product(self))
    }

    /// The product with an integer.
    pub fn times(&self, factor: i64) -> Self {
        linear_combination(&self.ring, &[(factor, self)])
    }

    /// The quotient by a non-zero integer.
    ///
    /// # Panics
    /// If `divisor` is zero.
    pub fn divided_by(&self, divisor: i64) -> Self {
        self.over(&divisor.into())
    }

    /// The quotient by a non-zero integer of any length.
    ///
    /// # Panics
    /// If `denominator` is zero.
    pub fn over(&self, denominator: &Integer) -> Self {
        assert!(!denominator.is_zero(), "division of a series by zero");
        let mut series = self.clone();
        if denominator.is_negative() {
            series.negate();
        }
        series.divide_in_place(&denominator.abs());
        series.reduce();
        series
    }

    /// The quotient of two constant series; `None` unless the divisor is a unit of the ring times
    /// an integer.
    pub fn divided_by_constant(&self, divisor: &Self) -> Option<Self> {
        let (numerator, denominator) = divisor.mean();
        let (unit, integer) = self.ring.inverse(&numerator)?;
        let mut series = self.product(&Self::constant(self.ring.clone(), unit));
        series.scale_by(denominator);
        Some(series.over(&integer))
    }

    /// The derivative with respect to `theta`.
    pub fn derivative(&self) -> Self {
        let times = |sign: i64, coefficients: &[R::Element]| {
            let scaled = |(k, coefficient): (i64, &R::Element)| {
                let mut result = coefficient.clone();
                self.ring.scale(&mut result, sign * k);
                result
            };
            (0..).zip(coefficients).map(scaled).collect()
        };
        let mut series = Self {
            ring: self.ring.clone(),
            denominator: self.denominator.clone(),
            cosine: times(1, &self.sine),
            sine: times(-1, &self.cosine),
        };
        series.reduce();
        series
    }

    /// The periodic solution of `u'' + u = self` without first harmonic, `u_k = r_k / (1 - k^2)`
    /// for `k != 1`, and the remaining resonant part.
    pub fn solve_oscillator(&self) -> (Self, ResonantPart<R>) {
        let resonance = ResonantPart { cosine: self.cosine(1), sine: self.sine(1) };
        let mut solution = self.clone();
        for part in [&mut solution.cosine, &mut solution.sine] {
            if let Some(resonant) = part.get_mut(1) {
                *resonant = self.ring.zero();
            }
        }
        // The divisors by which the ring cannot divide: the denominator becomes a multiple of each.
        let mut left = Vec::new();
        for k in 2..=self.highest_harmonic() {
            let parts = [&mut solution.cosine, &mut solution.sine];
            let harmonic = parts.into_iter().filter_map(|part| part.get_mut(k));
            let mut harmonic: Vec<_> =
                harmonic.filter(|coefficient| !self.ring.is_certainly_zero(coefficient)).collect();
            let divisor = Integer::one() - Integer::from(k) * Integer::from(k);
            if harmonic.is_empty() {
                continue;
            }
            if !R::FIELD
                || self.ring.divide(harmonic.iter_mut().map(|c| &mut **c), &divisor).is_err()
            {
                left.push((k, divisor));
            }
        }
        let common = left.iter().fold(Integer::one(), |lcm, (_, divisor)| lcm.lcm(divisor));
        if !left.is_empty() {
            let mut left = left.iter().peekable();
            for k in 0..=self.highest_harmonic() {
                let divided = left.next_if(|(harmonic, _)| *harmonic == k);
                let factor =
                    divided.map_or_else(|| common.clone(), |(_, divisor)| &common / divisor);
                for part in [&mut solution.cosine, &mut solution.sine] {
                    if let Some(coefficient) = part.get_mut(k) {
                        self.ring.scale_by(coefficient, &factor);
                    }
                }
            }
            solution.denominator *= common;
        }
        solution.reduce();
        (solution, resonance)
    }

    /// The value at `theta = 0`, as a constant series.
    pub fn at_zero(&self) -> Self {
        let mut sum = self.ring.zero();
        for coefficient in &self.cosine {
            self.ring.accumulate(&mut sum, coefficient);
        }
        self.constant_of(Some(&sum))
    }

    /// Converts the series to another ring.
    pub fn map<S: Ring>(
        &self,
        ring: S,
        change: impl Fn(&R::Element, &Integer) -> S::Element,
    ) -> FourierSeries<S> {
        let all = |part: &[R::Element]| {
            part.iter().map(|coefficient| change(coefficient, &self.denominator)).collect()
        };
        let (cosine, sine) = (all(&self.cosine), all(&self.sine));
        FourierSeries::from_parts(ring, cosine, sine)
    }

    fn negate(&mut self) {
        let coefficients = self.cosine.iter_mut().chain(&mut self.sine);
        coefficients.for_each(|coefficient| self.ring.negate(coefficient));
    }

    fn scale_by(&mut self, factor: &Integer) {
        if !factor.is_one() {
            let coefficients = self.cosine.iter_mut().chain(&mut self.sine);
            coefficients.for_each(|coefficient| self.ring.scale_by(coefficient, factor));
        }
    }

    /// The product with `factor`, which most often is one; it is not reduced to lowest terms.
    fn scaled(&self, factor: &Factor) -> Cow<'_, Self> {
        if factor.is_one() {
            return Cow::Borrowed(self);
        }
        let mut series = self.clone();
        let coefficients = series.cosine.iter_mut().chain(&mut series.sine);
        coefficients.for_each(|coefficient| factor.scale(&self.ring, coefficient));
        Cow::Owned(series)
    }

    fn divide_in_place(&mut self, divisor: &Integer) {
        if divisor.is_one() {
            return;
        }
        let coefficients = self.cosine.iter_mut().chain(&mut self.sine);
        if !R::FIELD || self.ring.divide(coefficients, divisor).is_err() {
            self.denominator *= divisor;
        }
    }

    #[inline]
    fn drop_trailing_zeros(&mut self) {
        for part in [&mut self.cosine, &mut self.sine] {
            let last = part.iter().rposition(|c| !self.ring.is_certainly_zero(c));
            part.truncate(last.map_or(0, |last| last + 1));
        }
    }

    /// Reduces to lowest terms: drops trailing zeros and, if a denominator is left, cancels the
    /// common factor of all numerators and the denominator. No greatest common divisor is computed
    /// anywhere else.
    fn reduce(&mut self) {
        self.drop_trailing_zeros();
        if !self.denominator.is_one() {
            let coefficients = self.cosine.iter_mut().chain(&mut self.sine);
            self.ring.reduce(coefficients, &mut self.denominator);
        }
    }
}

/// The factor that brings one term of a sum to the common denominator of all, times its weight.
enum Factor {
    /// The weight itself, for a term that already has the common denominator.
    Small(i64),
    Large(Integer),
}

impl Factor {
    fn new(weight: i64, common: &Integer, denominator: &Integer) -> Self {
        match common == denominator {
            true => Self::Small(weight),
            false => Self::Large(common / denominator * Integer::from(weight)),
        }
    }

    fn is_one(&self) -> bool {
        matches!(self, Self::Small(1))
    }

    fn scale<R: Ring>(&self, ring: &R, element: &mut R::Element) {
        match self {
            Self::Small(1) => {}
            Self::Small(-1) => ring.negate(element),
            Self::Small(factor) => ring.scale(element, *factor),
            Self::Large(factor) => ring.scale_by(element, factor),
        }
    }
}

/// `sum of weight * series`, over one common denominator.
///
/// ```
/// # use lindstedt_series as lindstedt;
/// use lindstedt::exact::{Integer, Integers};
/// use lindstedt::series::{FourierSeries, linear_combination};
/// let series = |parts: &[i64]| {
///     let cosine = parts.iter().map(|&part| Integer::from(part)).collect();
///     FourierSeries::from_parts(Integers, cosine, vec![])
/// };
/// let (one, half) = (series(&[0, 1]), series(&[3, 0, 1]).divided_by(2)); // cos(t) and (3 + cos(2 t))/2
/// let sum = linear_combination(&Integers, &[(1, &one), (-2, &half)]);
/// assert_eq!(sum, series(&[-3, 1, -1]));
/// ```
pub fn linear_combination<R: Ring>(
    ring: &R,
    terms: &[(i64, &FourierSeries<R>)],
) -> FourierSeries<R> {
    let common = terms.iter().fold(Integer::one(), |lcm, (_, series)| lcm.lcm(&series.denominator));
    let mut result = FourierSeries::zero(ring.clone());
    for (weight, series) in terms {
        let factor = Factor::new(*weight, &common, &series.denominator);
        add_scaled(ring, &mut result.cosine, &series.cosine, &factor);
        add_scaled(ring, &mut result.sine, &series.sine, &factor);
    }
    // Every term has been brought to this denominator: there is nothing to divide.
    result.denominator = common;
    result.reduce();
    result
}

/// `sum of weight * left * right`, over one common denominator: one order of a convolution.
///
/// ```
/// # use lindstedt_series as lindstedt;
/// use lindstedt::exact::{Integer, Integers};
/// use lindstedt::series::{FourierSeries, sum_of_products};
/// let parts = vec![Integer::from(0), Integer::from(1)];
/// let cosine = FourierSeries::from_parts(Integers, parts.clone(), vec![]);
/// let sine = FourierSeries::from_parts(Integers, vec![], parts);
/// let sum = sum_of_products(&Integers, &[(3, &cosine, &cosine), (3, &sine, &sine)]);
/// assert_eq!(sum, FourierSeries::constant(Integers, Integer::from(3)));
/// ```
pub fn sum_of_products<R: Ring>(
    ring: &R,
    terms: &[(i64, &FourierSeries<R>, &FourierSeries<R>)],
) -> FourierSeries<R> {
    let terms: Vec<_> = terms
        .iter()
        .filter(|(_, left, right)| !left.is_zero() && !right.is_zero())
        .map(|&(weight, left, right)| (weight, left, right, &left.denominator * &right.denominator))
        .collect();
    let common = terms.iter().fold(Integer::one(), |lcm, term| lcm.lcm(&term.3));
    let highest = terms
        .iter()
        .map(|(_, left, right, _)| left.highest_harmonic() + right.highest_harmonic())
        .max();
    let length = highest.map_or(0, |harmonic| harmonic + 1);
    let zeros = || vec![ring.zero(); length];
    let mut doubled = FourierSeries::raw(ring.clone(), zeros(), zeros());
    for (weight, left, right, denominator) in terms {
        let factor = Factor::new(weight, &common, &denominator);
        // The shorter of the two is scaled.
        match left.highest_harmonic() <= right.highest_harmonic() {
            true => doubled.add_doubled_product(&left.scaled(&factor), right),
            false => doubled.add_doubled_product(left, &right.scaled(&factor)),
        }
    }
    doubled.denominator = common;
    doubled.divide_in_place(&2.into());
    doubled.reduce();
    doubled
}

impl<R: Ring> FourierSeries<R> {
    /// Adds `2 * left * right` of the numerators, so that the halves of
    /// `2 cos i cos j = cos(i+j) + cos(i-j)` stay whole.
    fn add_doubled_product(&mut self, left: &Self, right: &Self) {
        let Self { ring, cosine, sine, .. } = self;
        match ring.doubled_cosine_product(&left.cosine, &right.cosine) {
            Some(doubled) => {
                cosine.iter_mut().zip(doubled).for_each(|(sum, term)| ring.add(sum, term));
            }
            None => for_each_product(ring, &left.cosine, &right.cosine, |i, j, product| {
                ring.accumulate(&mut cosine[i + j], &product);
                ring.add(&mut cosine[i.abs_diff(j)], product);
            }),
        }
        for_each_product(ring, &left.sine, &right.sine, |i, j, mut product| {
            ring.accumulate(&mut cosine[i.abs_diff(j)], &product);
            ring.negate(&mut product);
            ring.add(&mut cosine[i + j], product);
        });
        let mut mixed = |i: usize, j: usize, mut product: R::Element| {
            ring.accumulate(&mut sine[i + j], &product);
            if i > j {
                ring.negate(&mut product);
            }
            ring.add(&mut sine[i.abs_diff(j)], product);
        };
        for_each_product(ring, &left.cosine, &right.sine, &mut mixed);
        for_each_product(ring, &left.sine, &right.cosine, |i, j, product| mixed(j, i, product));
        if let Some(first) = sine.first_mut() {
            *first = ring.zero();
        }
    }
}

fn for_each_product<R: Ring>(
    ring: &R,
    left: &[R::Element],
    right: &[R::Element],
    mut receive: impl FnMut(usize, usize, R::Element),
) {
    let occurs = |(_, element): &(usize, &R::Element)| !ring.is_certainly_zero(element);
    for (i, a) in left.iter().enumerate().filter(occurs) {
        for (j, b) in right.iter().enumerate().filter(occurs) {
            receive(i, j, ring.product(a, b));
        }
    }
}

fn add_scaled<R: Ring>(
    ring: &R,
    target: &mut Vec<R::Element>,
    source: &[R::Element],
    factor: &Factor,
) {
    if target.len() < source.len() {
        target.resize(source.len(), ring.zero());
    }
    for (into, from) in target.iter_mut().zip(source) {
        if factor.is_one() {
            ring.accumulate(into, from);
            continue;
        }
        let mut scaled = from.clone();
        factor.scale(ring, &mut scaled);
        ring.add(into, scaled);
    }
}

fn unit<R: Ring>(ring: &R, k: usize) -> Vec<R::Element> {
    let mut coefficients = vec![ring.zero(); k];
    coefficients.push(ring.integer(1));
    coefficients
}

impl FourierSeries<Polynomials> {
    /// The constant term: the mean over a period. Fractions leave no denominator.
    pub fn constant_term(&self) -> Polynomial {
        self.mean().0
    }

    /// The coefficients of every harmonic that occurs: `(k, cosine, sine)`.
    pub fn harmonics(&self) -> Vec<(usize, Polynomial, Polynomial)> {
        let coefficient =
            |part: &[Polynomial], k: usize| part.get(k).cloned().unwrap_or_else(Polynomial::zero);
        (0..=self.highest_harmonic())
            .map(|k| (k, coefficient(&self.cosine, k), coefficient(&self.sine, k)))
            .filter(|(_, cosine, sine)| !(cosine.is_zero() && sine.is_zero()))
            .collect()
    }
}

impl FourierSeries<Doubles> {
    /// Returns the series with every coefficient changed by a function of its harmonic and its
    /// value.
    pub fn by_harmonic(&self, change: impl Fn(usize, f64) -> f64) -> Self {
        let all =
            |part: &[f64]| part.iter().enumerate().map(|(k, &value)| change(k, value)).collect();
        Self::from_parts(Doubles, all(&self.cosine), all(&self.sine))
    }

    /// The value at `theta`.
    pub fn evaluate(&self, theta: f64) -> f64 {
        let (sine, cosine) = theta.sin_cos();
        self.evaluate_at(cosine, sine)
    }

    /// The value at the angle with this cosine and sine. No further sines are computed: those of
    /// the multiples follow by the addition theorems.
    pub fn evaluate_at(&self, cosine: f64, sine: f64) -> f64 {
        let (mut c, mut s, mut sum) = (1.0, 0.0, 0.0);
        for k in 0..self.cosine.len().max(self.sine.len()) {
            sum += self.cosine.get(k).map_or(0.0, |coefficient| coefficient * c);
            sum += self.sine.get(k).map_or(0.0, |coefficient| coefficient * s);
            (c, s) = (c * cosine - s * sine, s * cosine + c * sine);
        }
        sum
    }
}

/// A quotient of integers as a fraction, for [`FourierSeries::map`] from numerators to
/// [`Rational`].
pub fn fraction(numerator: &Integer, denominator: &Integer) -> Rational {
    match denominator.is_one() {
        true => Rational::from_integer(numerator.clone()),
        false => Rational::new(numerator.clone(), denominator.clone()),
    }
}
