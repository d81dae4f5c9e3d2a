//! Functions of an angle, known up to a distance: Fourier series of balls with a tail. An even
//! function has no sines.
//!
//! ```text
//! u(theta) = sum_k (a_k cos(k theta) + b_k sin(k theta)) + h(theta),    ||h|| <= tail,    norm: sum_k (|a_k| + |b_k|)
//! ```
//!
//! In: the coefficients of an approximate motion. Out: series that contain the result of the
//! operations for any functions contained in the operands. The norm bounds the largest value, and
//! that of a product is at most the product of the norms, since a product of two of the functions
//! is half the sum of two: `cos i cos j = (cos(i+j) + cos(i-j))/2`, `sin i sin j = (cos(i-j) -
//! cos(i+j))/2`, `sin i cos j = (sin(i+j) + sin(i-j))/2`. A product of n by m coefficients costs n
//! m products of integers. Elementary functions are those of every algebra, in `elementary`.
//!
//! Source: J.-P. Lessard, J. D. Mireles James: Computer assisted Fourier analysis in sequence
//! spaces of varying regularity, SIAM Journal on Mathematical Analysis 49 (2017), 530-561.

use std::sync::OnceLock;

use super::elementary::Analytic;
use crate::exact::ball::{Ball, Balls};
use crate::exact::ball_products::{BallFactor, BallProductSums};
use crate::exact::bound::Bound;
use crate::exact::rational::from_f64;
use crate::numeric::harmonics::Transform;

/// The precision with which functions are computed; that of an approximate motion is lower.
pub(super) const WORKING: Balls = Balls { bits: 224 };

/// Binary exponent below which a coefficient is negligible if its digits are not known, and the
/// largest such exponent.
const NEGLIGIBLE: i32 = 120;

/// The largest number of harmonics of a series; those beyond are a part of its tail.
const LONGEST: usize = 1600;

/// One of the functions that a series consists of, by its harmonic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BasisFunction {
    Cosine(usize),
    Sine(usize),
}

impl BasisFunction {
    /// Its harmonic.
    pub(super) const fn harmonic(self) -> usize {
        match self {
            Self::Cosine(harmonic) | Self::Sine(harmonic) => harmonic,
        }
    }

    /// The square of its harmonic.
    pub(super) fn squared(self) -> u32 {
        u32::try_from(self.harmonic() * self.harmonic()).unwrap_or(u32::MAX)
    }
}

/// Cosine and sine of the sum of two angles.
pub(super) fn sum_of_angles(one: &[Ball; 2], other: &[Ball; 2]) -> [Ball; 2] {
    let product = |i: usize, j: usize| WORKING.product(&one[i], &other[j]);
    [
        WORKING.difference(&product(0, 0), &product(1, 1)),
        WORKING.sum(&product(1, 0), &product(0, 1)),
    ]
}

/// A function of an angle, known up to a distance.
#[derive(Clone, Debug)]
pub(super) struct FourierSeries {
    /// The coefficients of the cosines, that of the constant first.
    pub(super) cosines: Vec<Ball>,
    /// Sine coefficients by harmonic, the entry of the constant zero; empty for an even function.
    pub(super) sines: Vec<Ball>,
    /// Bound of the norm of the part that is not in the coefficients.
    pub(super) tail: Bound,
    /// Harmonics smaller than `2^-negligible` at the end become a part of the tail.
    negligible: i32,
}

impl FourierSeries {
    /// A constant.
    pub(super) fn constant(value: Ball) -> Self {
        Self::exactly(vec![value], vec![])
    }

    /// The function with these cosines and sines and without a tail.
    pub(super) fn exactly(cosines: Vec<Ball>, sines: Vec<Ball>) -> Self {
        Self { cosines, sines, tail: Bound::ZERO, negligible: NEGLIGIBLE }
    }

    /// This function, with the information that only so many bits of its coefficients are
    /// significant.
    pub(super) fn of_digits(mut self, bits: usize) -> Self {
        const MORE: i32 = 16;
        let bits = i32::try_from(bits).unwrap_or(NEGLIGIBLE);
        self.negligible = NEGLIGIBLE.min(bits.saturating_add(MORE));
        self
    }

    /// An enclosure of the value at the angle 0, and so of a constant function.
    pub(super) fn at_zero(&self) -> Ball {
        let zero = Ball::zero();
        let mut value = self.cosines.iter().fold(zero, |sum, ball| WORKING.sum(&sum, ball));
        value.radius += self.tail;
        value
    }

    /// The norm of the part in the coefficients.
    pub(super) fn finite_norm(&self) -> Bound {
        let all = self.cosines.iter().chain(&self.sines);
        all.map(|ball| WORKING.magnitude(ball)).sum()
    }

    /// Number of harmonics, the constant included.
    pub(super) fn length(&self) -> usize {
        self.cosines.len().max(self.sines.len())
    }

    /// The norm.
    pub(super) fn norm(&self) -> Bound {
        self.finite_norm() + self.tail
    }

    /// The coefficient of a cosine.
    pub(super) fn cosine(&self, harmonic: usize) -> Ball {
        self.cosines.get(harmonic).cloned().unwrap_or_else(Ball::zero)
    }

    /// The coefficient of a sine.
    pub(super) fn sine(&self, harmonic: usize) -> Ball {
        self.sines.get(harmonic).cloned().unwrap_or_else(Ball::zero)
    }

    /// The coefficient of a wave.
    pub(super) fn coefficient(&self, wave: BasisFunction) -> Ball {
        match wave {
            BasisFunction::Cosine(harmonic) => self.cosine(harmonic),
            BasisFunction::Sine(harmonic) => self.sine(harmonic),
        }
    }

    /// The function `theta -> f(theta + a)`, with the cosine and the sine of `a` given.
    pub(super) fn phase_shifted(&self, by: &[Ball; 2]) -> Self {
        let (mut cosines, mut sines) = (vec![], vec![]);
        let mut angle = [WORKING.integer(1), Ball::zero()];
        for k in 0..self.length() {
            // a cos(u + v) + b sin(u + v) has (a cos v + b sin v) cos u and (b cos v - a sin v) sin
            // u.
            let [cosine, sine] = &angle;
            let (a, b) = (self.cosine(k), self.sine(k));
            cosines.push(WORKING.sum(&WORKING.product(&a, cosine), &WORKING.product(&b, sine)));
            sines
                .push(WORKING.difference(&WORKING.product(&b, cosine), &WORKING.product(&a, sine)));
            angle = sum_of_angles(&angle, by);
        }
        Self { cosines, sines, tail: self.tail, negligible: self.negligible }
    }

    /// The derivative by the angle; the derivative of a tail is not bounded.
    pub(super) fn derivative(&self) -> Self {
        let by_harmonic = |balls: &[Ball], sign: i64| {
            let scaled = balls.iter().enumerate();
            scaled.map(|(k, ball)| WORKING.scaled(ball, sign * k as i64)).collect()
        };
        Self {
            cosines: by_harmonic(&self.sines, 1),
            sines: by_harmonic(&self.cosines, -1),
            tail: if self.tail == Bound::ZERO { self.tail } else { Bound::UNKNOWN },
            negligible: self.negligible,
        }
    }

    /// The set of all functions within a distance of those in this one.
    pub(super) fn widened(mut self, distance: Bound) -> Self {
        self.tail += distance;
        self
    }

    /// This function without its tail, for computations that prove nothing.
    #[cfg(test)]
    pub(super) fn without_tail(mut self) -> Self {
        self.tail = Bound::ZERO;
        self
    }

    /// Moves trailing harmonics that are negligible, or beyond the greatest length, into the tail.
    fn trimmed(mut self) -> Self {
        let negligible = Bound::power_of_two(-self.negligible);
        for balls in [&mut self.cosines, &mut self.sines] {
            while let Some(last) = balls.last() {
                let size = WORKING.magnitude(last);
                if size > negligible && balls.len() <= LONGEST {
                    break;
                }
                self.tail += size;
                balls.pop();
            }
        }
        self
    }

    /// This function with its trailing harmonics smaller than `2^-digits` moved into the tail.
    pub(super) fn shortened(mut self, digits: i32) -> Self {
        self.negligible = self.negligible.min(digits);
        self.trimmed()
    }

    fn zip(&self, other: &Self, join: impl Fn(&Ball, &Ball) -> Ball) -> Self {
        let zero = Ball::zero();
        let joined = |left: &[Ball], right: &[Ball]| {
            let pair = |k| join(left.get(k).unwrap_or(&zero), right.get(k).unwrap_or(&zero));
            (0..left.len().max(right.len())).map(pair).collect()
        };
        Self {
            cosines: joined(&self.cosines, &other.cosines),
            sines: joined(&self.sines, &other.sines),
            tail: self.tail + other.tail,
            negligible: self.negligible.min(other.negligible),
        }
    }

    /// Applies one map to every coefficient and another to the tail.
    fn mapped(&self, coefficient: impl Fn(&Ball) -> Ball, tail: Bound) -> Self {
        Self {
            cosines: self.cosines.iter().map(&coefficient).collect(),
            sines: self.sines.iter().map(&coefficient).collect(),
            tail,
            negligible: self.negligible,
        }
    }

    /// `self + other`.
    pub(super) fn sum(&self, other: &Self) -> Self {
        self.zip(other, |left, right| WORKING.sum(left, right))
    }

    /// `self - other`.
    pub(super) fn difference(&self, other: &Self) -> Self {
        self.zip(other, |left, right| WORKING.difference(left, right))
    }

    /// `self * factor`.
    pub(super) fn scaled(&self, factor: i64) -> Self {
        let tail = self.tail * Bound::of_nearest(factor.unsigned_abs() as f64);
        self.mapped(|ball| WORKING.scaled(ball, factor), tail)
    }

    /// `self / divisor`, for a divisor that is not zero.
    pub(super) fn divided(&self, divisor: u32) -> Self {
        self.mapped(|ball| WORKING.divided(ball, divisor), self.tail / divisor)
    }

    /// `self * other`.
    pub(super) fn product(&self, other: &Self) -> Self {
        let length = (self.length() + other.length()).saturating_sub(1);
        let all = [&self.cosines, &self.sines, &other.cosines, &other.sines];
        let all = all.map(|balls| factors(balls));
        let no_products = |count: usize| {
            BallProductSums::new(count, all.iter().flatten().map(|(_, factor)| factor))
        };
        let [own_cosines, own_sines, other_cosines, other_sines] = &all;
        let is_even = self.sines.is_empty() && other.sines.is_empty();
        let mut cosines = no_products(length);
        let mut sines = no_products(if is_even { 0 } else { length });
        let apart = |i: usize, j: usize| (i.abs_diff(j), i < j);
        add_products(&mut cosines, own_cosines, other_cosines, |i, j| {
            [(i + j, false), (i.abs_diff(j), false)]
        });
        add_products(&mut cosines, own_sines, other_sines, |i, j| {
            [(i + j, true), (i.abs_diff(j), false)]
        });
        add_products(&mut sines, own_sines, other_cosines, |i, j| [(i + j, false), apart(i, j)]);
        add_products(&mut sines, other_sines, own_cosines, |i, j| [(i + j, false), apart(i, j)]);
        let halved = |doubled: BallProductSums| doubled.rounded(WORKING, WORKING.bits, 1);
        let (cosines, mut sines) = (halved(cosines), halved(sines));
        // sin 0 is zero, whatever its coefficient.
        if let Some(constant) = sines.first_mut() {
            *constant = Ball::zero();
        }
        let tails = self.tail * other.norm() + other.tail * self.finite_norm();
        Self { cosines, sines, tail: tails, negligible: self.negligible.min(other.negligible) }
            .trimmed()
    }

    /// The middles without radii, which suffice for the guess of an iteration.
    fn without_radii(mut self) -> Self {
        for ball in self.cosines.iter_mut().chain(&mut self.sines) {
            ball.radius = Bound::ZERO;
        }
        self.tail = Bound::ZERO;
        self.trimmed()
    }

    /// Approximates `function` of this series from samples, without a proof. `None` if a sample has
    /// no value.
    fn sampled(&self, function: impl Fn(f64) -> f64) -> Option<Self> {
        const DIGITS: f64 = 1e-15;
        let waves = (0..self.length())
            .map(|k| [&self.cosine(k), &self.sine(k)].map(|ball| WORKING.nearest(ball)));
        let (count, transform) = transform(self.length());
        let samples: Vec<f64> = transform.sum_of_waves(waves).into_iter().map(function).collect();
        if samples.iter().any(|value| !value.is_finite()) {
            return None;
        }
        let mut harmonics = transform.harmonics(&samples, count / 2 - 1);
        // The coefficient of the constant was twice the mean.
        harmonics.cosines[0] /= 2.0;
        if self.sines.is_empty() {
            harmonics.sines.clear();
        }
        let all = harmonics.cosines.iter().chain(&harmonics.sines);
        let largest = all.fold(0.0_f64, |most, value| most.max(value.abs()));
        let balls = |mut coefficients: Vec<f64>| {
            // Coefficients that the parity of the function excludes must be exactly zero: half of
            // all products are skipped for it.
            for coefficient in &mut coefficients {
                if coefficient.abs() < DIGITS * largest {
                    *coefficient = 0.0;
                }
            }
            let length = coefficients.iter().rposition(|c| *c != 0.0).map_or(0, |last| last + 1);
            coefficients.truncate(length);
            let ball = |value| Some(WORKING.fraction(&from_f64(value)?));
            coefficients.into_iter().map(ball).collect::<Option<Vec<Ball>>>()
        };
        Some(Self {
            cosines: balls(harmonics.cosines)?,
            sines: balls(harmonics.sines)?,
            tail: Bound::ZERO,
            negligible: self.negligible,
        })
    }
}

impl Analytic for FourierSeries {
    fn constant(value: Ball) -> Self {
        Self::constant(value)
    }

    fn sum(&self, other: &Self) -> Self {
        self.sum(other)
    }

    fn difference(&self, other: &Self) -> Self {
        self.difference(other)
    }

    fn product(&self, other: &Self) -> Self {
        self.product(other)
    }

    fn scaled(&self, factor: i64) -> Self {
        self.scaled(factor)
    }

    fn divided(&self, divisor: u32) -> Self {
        self.divided(divisor)
    }

    fn norm(&self) -> Bound {
        self.norm()
    }

    fn widened(self, distance: Bound) -> Self {
        self.widened(distance)
    }

    fn at_zero(&self) -> Ball {
        self.at_zero()
    }

    fn negligible(&self) -> i32 {
        self.negligible
    }

    fn without_radii(self) -> Self {
        self.without_radii()
    }

    fn sampled(&self, function: impl Fn(f64) -> f64) -> Option<Self> {
        self.sampled(function)
    }
}

/// The number of samples for a function of a series of this length, and their transform.
pub(super) fn transform(length: usize) -> (usize, &'static Transform) {
    const LEAST: u32 = 6;
    const MOST: u32 = 12;
    static TRANSFORMS: [OnceLock<Transform>; (MOST - LEAST + 1) as usize] =
        [const { OnceLock::new() }; (MOST - LEAST + 1) as usize];
    let count = (8 * length).next_power_of_two().clamp(1 << LEAST, 1 << MOST);
    let own = &TRANSFORMS[(count.ilog2() - LEAST) as usize];
    (count, own.get_or_init(|| Transform::new(count)))
}

/// The balls that are not zero as factors, by harmonic.
fn factors(balls: &[Ball]) -> Vec<(usize, BallFactor)> {
    let occurring = balls.iter().enumerate().filter(|(_, ball)| !ball.is_zero());
    occurring.map(|(k, ball)| (k, BallFactor::new(WORKING, ball))).collect()
}

/// Adds twice the product of a sum of cosines or sines with another: that of the harmonics i and j
/// is that of two others, each of which may be negative.
fn add_products(
    doubled: &mut BallProductSums,
    left: &[(usize, BallFactor)],
    right: &[(usize, BallFactor)],
    waves: impl Fn(usize, usize) -> [(usize, bool); 2],
) {
    for (i, left) in left {
        for (j, right) in right {
            doubled.add(left, right, waves(*i, *j));
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{Analytic as _, Bound, FourierSeries, WORKING};
    use crate::exact::rational::from_f64;

    /// A series of few harmonics with a tail of a hundredth, and one of the functions in it, its
    /// cosines and sines: `disturbance` times a further harmonic. Half of them are even.
    fn series() -> impl Strategy<Value = (FourierSeries, [Vec<f64>; 2])> {
        let coefficients = || proptest::collection::vec(-0.25..0.25_f64, 1..4);
        let disturbance = prop_oneof![Just(0.0), Just(0.01), Just(-0.01), -0.01..0.01_f64];
        (coefficients(), coefficients(), any::<bool>(), disturbance, 0_usize..7).prop_map(
            |(cosines, mut sines, even, disturbance, harmonic)| {
                sines[0] = 0.0;
                if even {
                    sines.clear();
                }
                let balls = |numbers: &[f64]| {
                    let balls =
                        numbers.iter().filter_map(|c| Some(WORKING.fraction(&from_f64(*c)?)));
                    balls.collect()
                };
                let series = FourierSeries::exactly(balls(&cosines), balls(&sines))
                    .widened(Bound::exactly(0.01));
                let mut numbers = [cosines, sines];
                let disturbed = &mut numbers[usize::from(!even && harmonic > 0)];
                disturbed.resize(disturbed.len().max(harmonic + 1), 0.0);
                disturbed[harmonic] += disturbance;
                (series, numbers)
            },
        )
    }

    fn value([cosines, sines]: &[Vec<f64>; 2], angle: f64) -> f64 {
        let sum = |numbers: &[f64], wave: fn(f64) -> f64| -> f64 {
            let terms = numbers.iter().enumerate();
            terms.map(|(k, c)| c * wave(k as f64 * angle)).sum()
        };
        sum(cosines, f64::cos) + sum(sines, f64::sin)
    }

    /// Whether a number may be the value of one of the functions at the angle.
    fn holds(series: &FourierSeries, angle: f64, number: f64) -> bool {
        let numbers = [&series.cosines, &series.sines]
            .map(|balls| balls.iter().map(|ball| WORKING.nearest(ball)).collect());
        let radii: Bound = series.cosines.iter().chain(&series.sines).map(|ball| ball.radius).sum();
        (value(&numbers, angle) - number).abs() <= (series.tail + radii).value() + 1e-12
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        #[test]
        fn functions_of_a_series_contain_those_of_every_member(
            (left, x) in series(), (right, y) in series(), angle in 0.0..6.3_f64, degree in 1_u32..5
        ) {
            let (x, y) = (value(&x, angle), value(&y, angle));
            prop_assert!(holds(&left, angle, x) && holds(&right, angle, y));
            prop_assert!(holds(&left.sum(&right), angle, x + y));
            prop_assert!(holds(&left.difference(&right), angle, x - y));
            prop_assert!(holds(&left.product(&right), angle, x * y));
            prop_assert!(holds(&left.power(3), angle, x.powi(3)));
            prop_assert!(holds(&left.scaled(-7), angle, -7.0 * x));
            let (sine, cosine) = left.scaled(5).sine_and_cosine().expect("a small argument");
            prop_assert!(holds(&sine, angle, (5.0 * x).sin()) && holds(&cosine, angle, (5.0 * x).cos()));
            prop_assert!(holds(&left.scaled(3).exponential().expect("a small argument"), angle, (3.0 * x).exp()));
            let above = left.sum(&FourierSeries::integer(2));
            if let Some(root) = above.inverse_root(degree) {
                prop_assert!(holds(&root, angle, (2.0 + x).powf(-1.0 / f64::from(degree))));
            }
            let below = above.negated();
            if let Some(inverse) = below.inverse() {
                prop_assert!(holds(&inverse, angle, -1.0 / (2.0 + x)));
            }
            if let Some(logarithm) = above.logarithm() {
                prop_assert!(holds(&logarithm, angle, (2.0 + x).ln()));
            }
            if let Some(arctangent) = left.scaled(2).arctangent() {
                prop_assert!(holds(&arctangent, angle, (2.0 * x).atan()));
            }
        }
    }

    #[test]
    fn most_functions_have_a_value() {
        let ball = |value: f64| WORKING.fraction(&from_f64(value).expect("a double"));
        let series = FourierSeries::exactly(vec![ball(0.25), ball(1.0), ball(-0.125)], vec![]);
        let above = series.sum(&FourierSeries::integer(2));
        let values = [
            above.inverse(),
            above.inverse_root(3),
            above.logarithm(),
            series.arctangent(),
            series.exponential(),
            series.scaled(20).exponential(),
        ];
        for value in values {
            assert!(value.is_some_and(|value| value.tail < Bound::exactly(1e-20)));
        }
        // Through zero there is no inverse, no root and no logarithm.
        assert!(
            series.inverse().is_none()
                && series.inverse_root(2).is_none()
                && series.logarithm().is_none()
        );
        assert!(series.scaled(100).exponential().is_none());
    }
}
