//! Fourier series in `theta = omega t`, over any coefficient ring.
//!
//! `u(theta) = c_0 + c_1 cos theta + s_1 sin theta + c_2 cos 2 theta + ...`, a finite sum. All coefficients stand over one
//! common denominator, which stays one when the ring divides by itself (see [`Ring::FIELD`]).
//!
//! The three operations that perturbation methods live on: the product
//! `2 cos i cos j = cos(i+j) + cos(i-j)`, the derivative, and the solution of `u'' + u = r`, whose resonant part
//! `r_1 cos theta + q_1 sin theta` no periodic `u` can balance and which is handed back to the caller.

use num_integer::Integer as _;
use num_traits::{One, Zero};

use crate::exact::ring::{Ring, common_content};
use crate::exact::{Integer, Polynomial, Rational};

/// A finite Fourier series. Equal functions are equal values in lowest terms, which every operation here ends with.
#[derive(Clone, Debug, PartialEq)]
pub struct FourierSeries<C> {
    /// Common denominator of all coefficients, positive; one over a field.
    denominator: Integer,
    /// Numerators of `cos k theta`, `k = 0, 1, ...`.
    cosine: Vec<C>,
    /// Numerators of `sin k theta`; the entry for `k = 0` is zero.
    sine: Vec<C>,
}

/// The part of a right-hand side at the natural frequency: `cosine cos theta + sine sin theta`, each a constant series.
#[derive(Clone, Debug, PartialEq)]
pub struct Resonance<C> {
    /// The coefficient of `cos theta`.
    pub cosine: FourierSeries<C>,
    /// The coefficient of `sin theta`.
    pub sine: FourierSeries<C>,
}

impl<C: Ring> FourierSeries<C> {
    /// The series without terms.
    pub fn zero() -> Self {
        Self {
            denominator: Integer::one(),
            cosine: vec![],
            sine: vec![],
        }
    }

    /// The constant `numerator / denominator`.
    ///
    /// # Panics
    /// If `denominator` is not positive.
    pub fn constant(numerator: C, denominator: Integer) -> Self {
        Self::from_parts(vec![numerator], vec![], denominator)
    }

    /// The integer `value` as a constant series.
    pub fn integer(value: i64) -> Self {
        Self::constant(C::from_integer(&value.into()), Integer::one())
    }

    /// `cos(k theta)`.
    pub fn cos(k: usize) -> Self {
        Self::from_parts(unit(k), vec![], Integer::one())
    }

    /// `sin(k theta)`.
    pub fn sin(k: usize) -> Self {
        Self::from_parts(vec![], if k == 0 { vec![] } else { unit(k) }, Integer::one())
    }

    /// The series with these numerators over `denominator`; `sine[0]` is ignored.
    ///
    /// # Panics
    /// If `denominator` is not positive.
    pub fn from_parts(cosine: Vec<C>, mut sine: Vec<C>, denominator: Integer) -> Self {
        assert!(denominator > Zero::zero(), "a common denominator is positive");
        if let Some(first) = sine.first_mut() {
            *first = C::zero();
        }
        let mut series = Self {
            denominator: Integer::one(),
            cosine,
            sine,
        };
        series.divide_in_place(&denominator);
        series.reduce();
        series
    }

    /// Whether no term is left.
    pub fn is_zero(&self) -> bool {
        self.cosine.is_empty() && self.sine.is_empty()
    }

    /// The highest harmonic with a non-zero coefficient; zero for a constant.
    pub fn highest_harmonic(&self) -> usize {
        self.cosine.len().max(self.sine.len()).saturating_sub(1)
    }

    /// The coefficient of `cos k theta` as a constant series.
    pub fn cosine(&self, k: usize) -> Self {
        Self::constant(
            self.cosine.get(k).cloned().unwrap_or_else(C::zero),
            self.denominator.clone(),
        )
    }

    /// The coefficient of `sin k theta` as a constant series.
    pub fn sine(&self, k: usize) -> Self {
        Self::constant(
            self.sine.get(k).cloned().unwrap_or_else(C::zero),
            self.denominator.clone(),
        )
    }

    /// Numerator and denominator of the constant term: the mean over a period.
    pub fn mean(&self) -> (C, &Integer) {
        (self.cosine.first().cloned().unwrap_or_else(C::zero), &self.denominator)
    }

    /// Whether no sine occurs.
    pub fn is_even(&self) -> bool {
        self.sine.is_empty()
    }

    /// The sum.
    pub fn sum(&self, other: &Self) -> Self {
        linear_combination(&[(1, self), (1, other)])
    }

    /// The difference.
    pub fn difference(&self, other: &Self) -> Self {
        linear_combination(&[(1, self), (-1, other)])
    }

    /// The product; (number of harmonics)^2 coefficient products.
    pub fn product(&self, other: &Self) -> Self {
        sum_of_products(&[(1, self, other)])
    }

    /// The `exponent`-th power.
    pub fn power(&self, exponent: u32) -> Self {
        (0..exponent).fold(Self::integer(1), |power, _| power.product(self))
    }

    /// The product with an integer.
    pub fn times(&self, factor: i64) -> Self {
        linear_combination(&[(factor, self)])
    }

    /// The quotient by a non-zero integer.
    ///
    /// # Panics
    /// If `divisor` is zero.
    pub fn divided_by(&self, divisor: i64) -> Self {
        assert!(divisor != 0, "division of a series by zero");
        let mut series = self.times(divisor.signum());
        series.divide_in_place(&divisor.abs().into());
        series.reduce();
        series
    }

    /// The quotient of two constant series, where the divisor is a unit of the ring times an integer; `None` otherwise.
    pub fn divided_by_constant(&self, divisor: &Self) -> Option<Self> {
        let (numerator, denominator) = divisor.mean();
        let (unit, integer) = numerator.inverse()?;
        let mut series = self.product(&Self::constant(unit, Integer::one()));
        let sign = if integer < Zero::zero() {
            -Integer::one()
        } else {
            Integer::one()
        };
        series.scale(&(denominator * &sign));
        series.divide_in_place(&(integer * sign));
        series.reduce();
        Some(series)
    }

    /// The derivative with respect to `theta`.
    pub fn derivative(&self) -> Self {
        let times = |sign: i64, coefficients: &[C]| {
            let scaled = |(k, coefficient): (usize, &C)| {
                let mut result = coefficient.clone();
                result.scale(&(Integer::from(k) * sign));
                result
            };
            coefficients.iter().enumerate().map(scaled).collect()
        };
        let mut series = Self {
            denominator: self.denominator.clone(),
            cosine: times(1, &self.sine),
            sine: times(-1, &self.cosine),
        };
        series.reduce();
        series
    }

    /// The periodic solution of `u'' + u = self` without first harmonic, and the resonant part left over:
    /// `u_k = r_k / (1 - k^2)` for `k != 1`.
    pub fn solve_oscillator(&self) -> (Self, Resonance<C>) {
        let highest = self.highest_harmonic();
        let occurs = |k: &usize| {
            [&self.cosine, &self.sine]
                .iter()
                .any(|part| part.get(*k).is_some_and(|c| !c.is_zero()))
        };
        let divisor = |k: usize| Integer::one() - Integer::from(k) * Integer::from(k);
        let common = (2..=highest)
            .filter(occurs)
            .fold(Integer::one(), |lcm, k| lcm.lcm(&divisor(k)));
        let solve = |part: &[C]| {
            let solved = |(k, coefficient): (usize, &C)| {
                let mut result = if k == 1 { C::zero() } else { coefficient.clone() };
                if !result.is_zero() {
                    result.scale(&(&common / divisor(k)));
                }
                result
            };
            part.iter().enumerate().map(solved).collect()
        };
        let mut solution = Self {
            denominator: self.denominator.clone(),
            cosine: solve(&self.cosine),
            sine: solve(&self.sine),
        };
        solution.divide_in_place(&common);
        solution.reduce();
        (
            solution,
            Resonance {
                cosine: self.cosine(1),
                sine: self.sine(1),
            },
        )
    }

    /// The value at `theta = 0`, as a constant series.
    pub fn at_zero(&self) -> Self {
        let mut sum = C::zero();
        for coefficient in &self.cosine {
            sum.accumulate(coefficient);
        }
        Self::constant(sum, self.denominator.clone())
    }

    /// The same series over another ring.
    pub fn map<D: Ring>(&self, change: impl Fn(&C, &Integer) -> D) -> FourierSeries<D> {
        let all = |part: &[C]| {
            part.iter()
                .map(|coefficient| change(coefficient, &self.denominator))
                .collect()
        };
        FourierSeries::from_parts(all(&self.cosine), all(&self.sine), Integer::one())
    }

    fn scale(&mut self, factor: &Integer) {
        if !factor.is_one() {
            self.cosine
                .iter_mut()
                .chain(&mut self.sine)
                .for_each(|coefficient| coefficient.scale(factor));
        }
    }

    fn divide_in_place(&mut self, divisor: &Integer) {
        if divisor.is_one() {
            return;
        }
        if C::FIELD {
            self.cosine
                .iter_mut()
                .chain(&mut self.sine)
                .for_each(|coefficient| coefficient.divide(divisor));
        } else {
            self.denominator *= divisor;
        }
    }

    /// Lowest terms: trailing zeros dropped and, where the ring cannot divide, the common factor of all numerators and
    /// the denominator taken out. The only place where a greatest common divisor is computed.
    fn reduce(&mut self) {
        for part in [&mut self.cosine, &mut self.sine] {
            let length = part
                .iter()
                .rposition(|coefficient| !coefficient.is_zero())
                .map_or(0, |last| last + 1);
            part.truncate(length);
        }
        if self.denominator.is_one() {
            return;
        }
        let divisor = common_content(self.denominator.clone(), self.cosine.iter().chain(&self.sine));
        if !divisor.is_one() {
            self.denominator /= &divisor;
            self.cosine
                .iter_mut()
                .chain(&mut self.sine)
                .for_each(|coefficient| coefficient.divide(&divisor));
        }
    }
}

/// `sum of weight * series`, over one common denominator.
pub fn linear_combination<C: Ring>(terms: &[(i64, &FourierSeries<C>)]) -> FourierSeries<C> {
    let common = terms
        .iter()
        .fold(Integer::one(), |lcm, (_, series)| lcm.lcm(&series.denominator));
    let mut result = FourierSeries {
        denominator: Integer::one(),
        cosine: vec![],
        sine: vec![],
    };
    for (weight, series) in terms {
        let factor = &common / &series.denominator * weight;
        add_scaled(&mut result.cosine, &series.cosine, &factor);
        add_scaled(&mut result.sine, &series.sine, &factor);
    }
    result.divide_in_place(&common);
    result.reduce();
    result
}

/// `sum of weight * left * right`, over one common denominator: one order of a running convolution.
pub fn sum_of_products<C: Ring>(terms: &[(i64, &FourierSeries<C>, &FourierSeries<C>)]) -> FourierSeries<C> {
    let terms: Vec<_> = terms
        .iter()
        .filter(|(_, left, right)| !left.is_zero() && !right.is_zero())
        .collect();
    let denominator = |left: &FourierSeries<C>, right: &FourierSeries<C>| &left.denominator * &right.denominator;
    let common = terms.iter().fold(Integer::one(), |lcm, (_, left, right)| {
        lcm.lcm(&denominator(left, right))
    });
    let highest = terms
        .iter()
        .map(|(_, left, right)| left.highest_harmonic() + right.highest_harmonic())
        .max();
    let length = highest.map_or(0, |harmonic| harmonic + 1);
    let mut doubled = FourierSeries {
        denominator: Integer::one(),
        cosine: vec![C::zero(); length],
        sine: vec![C::zero(); length],
    };
    for &&(weight, left, right) in &terms {
        let factor = &common / denominator(left, right) * weight;
        let mut left = left.clone();
        left.scale(&factor);
        doubled.add_doubled_product(&left, right);
    }
    doubled.divide_in_place(&(common * 2));
    doubled.reduce();
    doubled
}

impl<C: Ring> FourierSeries<C> {
    /// Adds `2 * left * right` of the numerators, so that the halves of `2 cos i cos j = cos(i+j) + cos(i-j)` stay whole.
    fn add_doubled_product(&mut self, left: &Self, right: &Self) {
        for_each_product(&left.cosine, &right.cosine, |i, j, product| {
            self.cosine[i + j].accumulate(&product);
            self.cosine[i.abs_diff(j)].accumulate(&product);
        });
        for_each_product(&left.sine, &right.sine, |i, j, mut product| {
            self.cosine[i.abs_diff(j)].accumulate(&product);
            product.negate();
            self.cosine[i + j].accumulate(&product);
        });
        let mut mixed = |i: usize, j: usize, mut product: C| {
            self.sine[i + j].accumulate(&product);
            if i > j {
                product.negate();
            }
            self.sine[i.abs_diff(j)].accumulate(&product);
        };
        for_each_product(&left.cosine, &right.sine, &mut mixed);
        for_each_product(&left.sine, &right.cosine, |i, j, product| mixed(j, i, product));
        if let Some(first) = self.sine.first_mut() {
            *first = C::zero();
        }
    }
}

fn for_each_product<C: Ring>(left: &[C], right: &[C], mut receive: impl FnMut(usize, usize, C)) {
    for (i, a) in left.iter().enumerate().filter(|(_, a)| !a.is_zero()) {
        for (j, b) in right.iter().enumerate().filter(|(_, b)| !b.is_zero()) {
            receive(i, j, a.product(b));
        }
    }
}

fn add_scaled<C: Ring>(target: &mut Vec<C>, source: &[C], factor: &Integer) {
    if target.len() < source.len() {
        target.resize(source.len(), C::zero());
    }
    for (into, from) in target.iter_mut().zip(source) {
        let mut scaled = from.clone();
        scaled.scale(factor);
        into.accumulate(&scaled);
    }
}

fn unit<C: Ring>(k: usize) -> Vec<C> {
    let mut coefficients = vec![C::zero(); k];
    coefficients.push(C::from_integer(&Integer::one()));
    coefficients
}

impl FourierSeries<Polynomial> {
    /// The coefficients of every harmonic that occurs: `(k, cosine, sine)`.
    pub fn harmonics(&self) -> Vec<(usize, Polynomial, Polynomial)> {
        let coefficient = |part: &[Polynomial], k: usize| part.get(k).cloned().unwrap_or_else(Polynomial::zero);
        (0..=self.highest_harmonic())
            .map(|k| (k, coefficient(&self.cosine, k), coefficient(&self.sine, k)))
            .filter(|(_, cosine, sine)| !(cosine.is_zero() && sine.is_zero()))
            .collect()
    }
}

impl FourierSeries<f64> {
    /// Every coefficient changed by a function of its harmonic.
    pub fn by_harmonic(&self, change: impl Fn(usize, f64) -> f64) -> Self {
        let all = |part: &[f64]| part.iter().enumerate().map(|(k, &value)| change(k, value)).collect();
        Self::from_parts(all(&self.cosine), all(&self.sine), Integer::one())
    }

    /// The value at `theta`.
    pub fn evaluate(&self, theta: f64) -> f64 {
        let (sine, cosine) = theta.sin_cos();
        self.evaluate_at(cosine, sine)
    }

    /// The value where `cos(theta)` and `sin(theta)` are these, without further sines: harmonic by harmonic the point turns on.
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

/// A quotient of integers as a fraction, for [`FourierSeries::map`] from numerators to [`Rational`].
pub fn fraction(numerator: &Integer, denominator: &Integer) -> Rational {
    Rational::new(numerator.clone(), denominator.clone())
}
