//! Even functions of an angle, known up to a distance: cosine series of balls with a tail.
//!
//! ```text
//! u(theta) = sum_k c_k cos(k theta) + h(theta),    ||h|| <= tail,    ||sum_k c_k cos(k theta)|| = sum_k |c_k|
//! ```
//!
//! In: the coefficients of an approximate motion. Out: series that contain whatever the operations make of any functions of
//! those that came in. The norm bounds the largest value, and that of a product is at most the product of the norms, since
//! `cos(i theta) cos(j theta) = (cos((i+j) theta) + cos((i-j) theta))/2`. A product of n by m coefficients costs n m products of
//! integers; what is elementary is a Taylor series of an argument that has been halved until it is small, or Newton's
//! iteration, whose outcome is held against what it has to fulfil.
//!
//! Source: J.-P. Lessard, J. D. Mireles James: Computer assisted Fourier analysis in sequence spaces of varying regularity,
//! SIAM Journal on Mathematical Analysis 49 (2017), 530-561.

use num_traits::{Signed as _, Zero};

use crate::exact::Integer;
use crate::exact::ball::{Ball, Balls};
use crate::exact::bound::Bound;
use crate::exact::rational::from_f64;
use crate::numeric::harmonics::Transform;

/// The digits with which functions are computed. Those of an approximate motion are fewer.
pub(super) const WORKING: Balls = Balls { bits: 224 };

/// What is negligible in a series unless its digits say otherwise, and at most.
const NEGLIGIBLE: i32 = 120;

/// No series has more harmonics; what is beyond is a part of its tail.
const LONGEST: usize = 1600;

/// How often an argument is halved; one of a larger norm has no value here.
const MOST_HALVINGS: u32 = 6;

/// Steps of Newton's iteration, each of which doubles the digits: from those of a double to more than are kept.
const STEPS: usize = 3;

/// No Taylor series has more terms.
const MOST_TERMS: u32 = 28;

/// An even function of an angle, known up to a distance.
#[derive(Clone, Debug)]
pub(super) struct CosineSeries {
    /// The coefficient of each harmonic.
    pub(super) coefficients: Vec<Ball>,
    /// The norm of what is not in them.
    pub(super) tail: Bound,
    /// Harmonics smaller than `2^-negligible` at the end become a part of the tail.
    negligible: i32,
}

impl CosineSeries {
    /// A constant.
    pub(super) fn constant(value: Ball) -> Self {
        Self {
            coefficients: vec![value],
            tail: Bound::ZERO,
            negligible: NEGLIGIBLE,
        }
    }

    /// Of these coefficients and nothing else.
    pub(super) fn exactly(coefficients: Vec<Ball>) -> Self {
        Self {
            coefficients,
            tail: Bound::ZERO,
            negligible: NEGLIGIBLE,
        }
    }

    /// The same, of which so many binary digits count.
    pub(super) fn of_digits(mut self, bits: usize) -> Self {
        const MORE: i32 = 16;
        let bits = i32::try_from(bits).unwrap_or(NEGLIGIBLE);
        self.negligible = NEGLIGIBLE.min(bits.saturating_add(MORE));
        self
    }

    /// The terms of a Taylor series, of an argument of a norm of at most 1/2, after which what is left is negligible; an even number.
    fn terms(&self) -> u32 {
        let negligible = Bound::power_of_two(-self.negligible - 8);
        (2..MOST_TERMS)
            .step_by(2)
            .find(|&terms| remainder(terms + 1) < negligible)
            .unwrap_or(MOST_TERMS)
    }

    /// All that it may be at the angle 0, which is all where it is a constant.
    pub(super) fn at_zero(&self) -> Ball {
        let zero = Ball::zero();
        let mut value = self.coefficients.iter().fold(zero, |sum, ball| WORKING.sum(&sum, ball));
        value.radius += self.tail;
        value
    }

    fn integer(value: i64) -> Self {
        Self::constant(WORKING.integer(value))
    }

    /// The norm of what is in the coefficients.
    pub(super) fn finite_norm(&self) -> Bound {
        self.coefficients.iter().map(|ball| WORKING.magnitude(ball)).sum()
    }

    /// The norm.
    pub(super) fn norm(&self) -> Bound {
        self.finite_norm() + self.tail
    }

    /// The coefficient of a harmonic.
    pub(super) fn coefficient(&self, harmonic: usize) -> Ball {
        self.coefficients.get(harmonic).cloned().unwrap_or_else(Ball::zero)
    }

    /// The same with all functions within a distance of it.
    pub(super) fn widened(mut self, distance: Bound) -> Self {
        self.tail += distance;
        self
    }

    /// Moves into the tail what is at the end and negligible, or beyond all length.
    fn trimmed(mut self) -> Self {
        let negligible = Bound::power_of_two(-self.negligible);
        while let Some(last) = self.coefficients.last() {
            let size = WORKING.magnitude(last);
            if size > negligible && self.coefficients.len() <= LONGEST {
                break;
            }
            self.tail += size;
            self.coefficients.pop();
        }
        self
    }

    fn zip(&self, other: &Self, join: impl Fn(&Ball, &Ball) -> Ball) -> Self {
        let length = self.coefficients.len().max(other.coefficients.len());
        let joined = (0..length).map(|k| join(&self.coefficient(k), &other.coefficient(k)));
        Self {
            coefficients: joined.collect(),
            tail: self.tail + other.tail,
            negligible: self.negligible.min(other.negligible),
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

    /// `-self`.
    fn negated(&self) -> Self {
        self.scaled(-1)
    }

    /// `self * factor`.
    pub(super) fn scaled(&self, factor: i64) -> Self {
        Self {
            coefficients: self
                .coefficients
                .iter()
                .map(|ball| WORKING.scaled(ball, factor))
                .collect(),
            tail: self.tail * Bound::of_nearest(factor.unsigned_abs() as f64),
            negligible: self.negligible,
        }
    }

    /// `self / divisor`, for a divisor that is not zero.
    fn divided(&self, divisor: u32) -> Self {
        Self {
            coefficients: self
                .coefficients
                .iter()
                .map(|ball| WORKING.divided(ball, divisor))
                .collect(),
            tail: self.tail / divisor,
            negligible: self.negligible,
        }
    }

    /// `self * other`.
    pub(super) fn product(&self, other: &Self) -> Self {
        let length = self.coefficients.len() + other.coefficients.len();
        // Twice the product, unrounded, and its radius; a constant is the case where both angles are the same.
        let mut doubled = vec![(Integer::zero(), Bound::ZERO); length.saturating_sub(1)];
        let mut add = |harmonic: usize, product: &Integer, radius: Bound| {
            doubled[harmonic].0 += product;
            doubled[harmonic].1 += radius;
        };
        for (i, left) in self.coefficients.iter().enumerate().filter(|(_, left)| !left.is_zero()) {
            for (j, right) in other
                .coefficients
                .iter()
                .enumerate()
                .filter(|(_, right)| !right.is_zero())
            {
                let (product, radius) = (&left.middle * &right.middle, WORKING.radius_of_product(left, right));
                add(i + j, &product, radius);
                add(i.abs_diff(j), &product, radius);
            }
        }
        let halved = doubled.into_iter().map(|(units, radius)| {
            let whole = WORKING.rounded(&units, radius);
            WORKING.divided(&whole, 2)
        });
        let tails = self.tail * other.norm() + other.tail * self.finite_norm();
        Self {
            coefficients: halved.collect(),
            tail: tails,
            negligible: self.negligible.min(other.negligible),
        }
        .trimmed()
    }

    fn squared(&self) -> Self {
        self.product(self)
    }

    /// A whole power.
    pub(super) fn power(&self, exponent: u32) -> Self {
        let mut result: Option<Self> = None;
        let mut square = self.clone();
        let mut rest = exponent;
        while rest > 0 {
            if rest % 2 == 1 {
                result = Some(result.map_or_else(|| square.clone(), |result| result.product(&square)));
            }
            rest /= 2;
            if rest > 0 {
                square = square.squared();
            }
        }
        result.unwrap_or_else(|| Self::integer(1))
    }

    /// Itself divided by a power of two, so that its norm is at most a half, and how often it was halved.
    fn halved(&self) -> Option<(Self, u32)> {
        let norm = self.norm();
        let halvings = (0..=MOST_HALVINGS).find(|&halvings| norm <= Bound::power_of_two(halvings as i32 - 1))?;
        Some((self.divided(1 << halvings), halvings))
    }

    /// Sine and cosine; `None` of what is too large.
    pub(super) fn sine_and_cosine(&self) -> Option<(Self, Self)> {
        let (argument, halvings) = self.halved()?;
        let square = argument.squared();
        let terms = self.terms();
        let (mut sine, mut cosine) = (Self::integer(1), Self::integer(1));
        for k in (1..=terms / 2).rev() {
            let one = Self::integer(1);
            sine = one.difference(&square.product(&sine).divided(2 * k * (2 * k + 1)));
            cosine = one.difference(&square.product(&cosine).divided(2 * k * (2 * k - 1)));
        }
        let mut sine = argument.product(&sine).widened(remainder(terms + 3));
        let mut cosine = cosine.widened(remainder(terms + 2));
        for _ in 0..halvings {
            let doubled = sine.product(&cosine).scaled(2);
            cosine = Self::integer(1).difference(&sine.squared().scaled(2));
            sine = doubled;
        }
        Some((sine, cosine))
    }

    /// The exponential function; `None` of what is too large.
    pub(super) fn exponential(&self) -> Option<Self> {
        let (argument, halvings) = self.halved()?;
        let terms = self.terms();
        let mut sum = Self::integer(1);
        for k in (1..=terms).rev() {
            sum = Self::integer(1).sum(&argument.product(&sum).divided(k));
        }
        sum = sum.widened(remainder(terms + 1));
        for _ in 0..halvings {
            sum = sum.squared();
        }
        Some(sum)
    }

    /// `self^(-1/degree)`, positive; `None` where that is not proved to exist.
    ///
    /// With any `g` that is positive at the angle 0 and `w = 1 - u g^n`, `d = ||w|| < 1`: `u^(-1/n) = g (1 - w)^(-1/n)`, which is within
    /// `||g|| d^2/(1 - d)` of `g (1 + w/n)`, for no coefficient of the binomial series is larger than one.
    pub(super) fn inverse_root(&self, degree: u32) -> Option<Self> {
        let mut root = self.sampled(|u| u.powf(-1.0 / f64::from(degree)))?;
        let next = |root: &Self, defect: &Self| root.sum(&root.product(defect).divided(degree));
        let mut defect = self.defect(&root, degree);
        for _ in 0..STEPS {
            if defect.norm() < enough(self.negligible) {
                break;
            }
            root = next(&root, &defect).without_radii();
            defect = self.defect(&root, degree);
        }
        let distance = defect.norm();
        let left = distance.below_complement();
        let spread = root.norm() * (distance * distance).over(left);
        let proved = left > 0.0 && root.start().is_some_and(|start| start > 0.0);
        proved.then(|| next(&root, &defect).widened(spread))
    }

    /// `1 - self g^n`.
    fn defect(&self, root: &Self, degree: u32) -> Self {
        Self::integer(1).difference(&self.product(&root.power(degree)))
    }

    /// `1/self`; `None` where that is not proved to exist.
    pub(super) fn inverse(&self) -> Option<Self> {
        match self.start()? < 0.0 {
            true => Some(self.negated().inverse_root(1)?.negated()),
            false => self.inverse_root(1),
        }
    }

    /// The natural logarithm; `None` where that is not proved to exist.
    ///
    /// With any `g` and `w = u exp(-g)`, `d = ||w - 1|| < 1`: `log u = g + log w`, and `log w` is within `d^2/(2 (1 - d))` of `w - 1`.
    pub(super) fn logarithm(&self) -> Option<Self> {
        let mut guess = self.sampled(f64::ln)?;
        let beyond = |guess: &Self| {
            Some(
                self.product(&guess.negated().exponential()?)
                    .difference(&Self::integer(1)),
            )
        };
        let mut rest = beyond(&guess)?;
        for _ in 0..STEPS {
            if rest.norm() < enough(self.negligible) {
                break;
            }
            guess = guess.sum(&rest).without_radii();
            rest = beyond(&guess)?;
        }
        let distance = rest.norm();
        let left = distance.below_complement();
        (left > 0.0).then(|| guess.sum(&rest).widened((distance * distance).over(left)))
    }

    /// The arctangent; `None` where that is not proved.
    ///
    /// With any `g` and `w = (u cos g - sin g)/(cos g + u sin g)`, which is `tan(atan u - g)`, and `||w|| = d < 1/32`: the continuous
    /// function `atan u - g` stays within `d` of one multiple of pi. That is zero if `|g| < pi/2 - d` at the angle 0, and then it is
    /// `atan w`, within `d^3` of `w`.
    pub(super) fn arctangent(&self) -> Option<Self> {
        let mut guess = self.sampled(f64::atan)?;
        let mut rest = self.angle_beyond(&guess)?;
        for _ in 0..STEPS {
            if rest.norm() < enough(self.negligible) {
                break;
            }
            guess = guess.sum(&rest).without_radii();
            rest = self.angle_beyond(&guess)?;
        }
        let distance = rest.norm();
        // 1.57 is below pi/2.
        let principal = WORKING.magnitude(&guess.at_zero()) + distance < Bound::exactly(1.57);
        (principal && distance < Bound::exactly(1.0 / 32.0))
            .then(|| guess.sum(&rest).widened(distance * distance * distance))
    }

    /// `tan(atan self - guess)`.
    fn angle_beyond(&self, guess: &Self) -> Option<Self> {
        let (sine, cosine) = guess.sine_and_cosine()?;
        let above = self.product(&cosine).difference(&sine);
        Some(above.product(&cosine.sum(&self.product(&sine)).inverse()?))
    }

    /// A double between zero and its value at the angle 0, of the same sign; `None` where zero may be that value.
    fn start(&self) -> Option<f64> {
        let value = self.at_zero();
        let distance = WORKING.distance_from_zero(&value);
        (distance > 0.0).then(|| {
            if value.middle.is_negative() {
                -distance
            } else {
                distance
            }
        })
    }

    /// The middles alone: a guess of an iteration needs no more.
    fn without_radii(mut self) -> Self {
        for ball in &mut self.coefficients {
            ball.radius = Bound::ZERO;
        }
        self.tail = Bound::ZERO;
        self.trimmed()
    }

    /// About `function` of it, from samples; nothing is proved of it. `None` where a sample has no value.
    fn sampled(&self, function: impl Fn(f64) -> f64) -> Option<Self> {
        const DIGITS: f64 = 1e-15;
        let waves = self.coefficients.iter().map(|ball| [WORKING.nearest(ball), 0.0]);
        let count = (8 * self.coefficients.len()).next_power_of_two().clamp(64, 4096);
        let transform = Transform::new(count);
        let samples: Vec<f64> = transform.sum_of_waves(waves).into_iter().map(function).collect();
        if samples.iter().any(|value| !value.is_finite()) {
            return None;
        }
        let mut coefficients = transform.harmonics(&samples, count / 2 - 1).cosines;
        // Of a constant twice the mean.
        coefficients[0] /= 2.0;
        let largest = coefficients.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        // What an even or odd function has not must be missing: half of all products are those with zero.
        for coefficient in &mut coefficients {
            if coefficient.abs() < DIGITS * largest {
                *coefficient = 0.0;
            }
        }
        let length = coefficients.iter().rposition(|c| *c != 0.0).map_or(0, |last| last + 1);
        coefficients.truncate(length);
        let balls = coefficients
            .into_iter()
            .map(|value| Some(WORKING.fraction(&from_f64(value)?)));
        Some(Self {
            coefficients: balls.collect::<Option<_>>()?,
            tail: Bound::ZERO,
            negligible: self.negligible,
        })
    }
}

/// What of a guess need not become smaller: its square is negligible.
fn enough(negligible: i32) -> Bound {
    Bound::power_of_two(-negligible / 2)
}

/// What is left of a Taylor series of sine, cosine or exponential function from a power on, of an argument of a norm of at most 1/2:
/// `sum_(k >= n) 2^-k/k! <= 2 * 2^-n/n!`.
fn remainder(from: u32) -> Bound {
    (1..=from).fold(Bound::exactly(2.0), |bound, k| bound / (2 * k))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{Bound, CosineSeries, WORKING};
    use crate::exact::rational::from_f64;

    /// A series of few harmonics with a tail of a hundredth, and one of the functions in it: `disturbance` times a further harmonic.
    fn series() -> impl Strategy<Value = (CosineSeries, Vec<f64>)> {
        let coefficients = proptest::collection::vec(-0.4..0.4_f64, 1..4);
        let disturbance = prop_oneof![Just(0.0), Just(0.01), Just(-0.01), -0.01..0.01_f64];
        (coefficients, disturbance, 0_usize..7).prop_map(|(coefficients, disturbance, harmonic)| {
            let balls = coefficients
                .iter()
                .filter_map(|c| Some(WORKING.fraction(&from_f64(*c)?)));
            let series = CosineSeries::exactly(balls.collect()).widened(Bound::exactly(0.01));
            let mut numbers = coefficients.clone();
            numbers.resize(numbers.len().max(harmonic + 1), 0.0);
            numbers[harmonic] += disturbance;
            (series, numbers)
        })
    }

    fn value(numbers: &[f64], angle: f64) -> f64 {
        numbers
            .iter()
            .enumerate()
            .map(|(k, c)| c * (k as f64 * angle).cos())
            .sum()
    }

    /// Whether a number may be the value of one of the functions at the angle.
    fn holds(series: &CosineSeries, angle: f64, number: f64) -> bool {
        let numbers: Vec<f64> = series.coefficients.iter().map(|ball| WORKING.nearest(ball)).collect();
        let radii: Bound = series.coefficients.iter().map(|ball| ball.radius).sum();
        (value(&numbers, angle) - number).abs() <= (series.tail + radii).value() + 1e-12
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        #[test]
        fn functions_of_a_series_contain_those_of_every_member(
            (left, x) in series(), (right, y) in series(), angle in 0.0..3.2_f64, degree in 1_u32..5
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
            let above = left.sum(&CosineSeries::integer(2));
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
        let series = CosineSeries::exactly(vec![ball(0.25), ball(1.0), ball(-0.125)]);
        let above = series.sum(&CosineSeries::integer(2));
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
        assert!(series.inverse().is_none() && series.inverse_root(2).is_none() && series.logarithm().is_none());
        assert!(series.scaled(100).exponential().is_none());
    }
}
