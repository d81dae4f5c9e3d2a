//! Functions of two angles, known up to a distance: cosine series of balls with a tail. The second angle stands
//! for a parameter on an interval, `a = c + h cos(phi)`.
//!
//! ```text
//! u(theta, phi) = sum_kn c_kn cos(k theta) cos(n phi) + u~,    ||u~(., phi)|| <= tail for each phi,    norm: sum_kn |c_kn| + tail
//! ```
//!
//! In: the coefficients of approximate motions, Chebyshev's by the parameter. Out: functions that contain the
//! result of the operations. The norm of a product is at most the product of the norms, since a product of two
//! cosines is half the sum of two. A product of n by m coefficients costs n m products of integers and four times
//! as many sums.
//!
//! Sources: L. N. Trefethen: Approximation Theory and Approximation Practice, SIAM 2013, chapter 3, for Chebyshev's
//! series as cosine series; and those of `fourier_series`.

use super::elementary::Analytic;
use super::fourier_series::WORKING;
use crate::exact::Integer;
use crate::exact::ball::{Ball, Balls};
use crate::exact::ball_products::{BallFactor, BallProductSums};
use crate::exact::bound::Bound;
use crate::exact::rational::from_f64;
use crate::numeric::harmonics::Transform;

/// The precision of the coefficients, whose radii are a part of the tail.
const PRECISION: Balls = Balls { bits: 88 };

/// Binary exponent, with its sign changed, below which a coefficient is negligible.
const NEGLIGIBLE: i32 = 66;

/// A function of two angles, known up to a distance.
#[derive(Clone, Debug)]
pub(super) struct Sheet {
    /// The coefficients `c_kn`, a row for each k; exact.
    rows: Vec<Vec<Ball>>,
    /// Bound of the norm of the part that is not in the coefficients.
    pub(super) tail: Bound,
}

impl Sheet {
    /// The function with exactly these coefficients in units of `2^-bits`, without those that are negligible.
    pub(super) fn of_units(rows: &[Vec<Integer>], bits: usize) -> Self {
        let ball = |unit: &Integer| PRECISION.dyadic(unit, bits);
        let rows = rows.iter().map(|row| row.iter().map(ball).collect()).collect();
        Self::of_balls(rows, Bound::ZERO).without_radii()
    }

    /// `middle + half cos(phi)`.
    pub(super) fn interval(middle: &Ball, half: &Ball) -> Self {
        let short = |ball: &Ball| PRECISION.converted(ball, WORKING);
        Self::of_balls(vec![vec![short(middle), short(half)]], Bound::ZERO)
    }

    /// The function with these coefficients; radii and what is negligible move into the tail.
    fn of_balls(mut rows: Vec<Vec<Ball>>, mut tail: Bound) -> Self {
        let negligible = Bound::power_of_two(-NEGLIGIBLE);
        for row in &mut rows {
            for ball in &mut *row {
                tail += std::mem::replace(&mut ball.radius, Bound::ZERO);
                let size = PRECISION.magnitude(ball);
                if size < negligible && !ball.is_zero() {
                    tail += size;
                    *ball = Ball::zero();
                }
            }
            while row.last().is_some_and(Ball::is_zero) {
                row.pop();
            }
        }
        while rows.last().is_some_and(Vec::is_empty) {
            rows.pop();
        }
        Self { rows, tail }
    }

    /// The number of harmonics of the first angle, the constant included.
    pub(super) fn height(&self) -> usize {
        self.rows.len()
    }

    /// One more than the largest harmonic of the second angle.
    pub(super) fn width(&self) -> usize {
        self.rows.iter().map(Vec::len).max().unwrap_or(0)
    }

    /// The coefficient of `cos(k theta) cos(n phi)`.
    pub(super) fn coefficient(&self, k: usize, n: usize) -> Ball {
        let ball = self.rows.get(k).and_then(|row| row.get(n));
        ball.map_or_else(Ball::zero, |ball| WORKING.converted(ball, PRECISION))
    }

    /// The cosine series of the means over the second angle.
    pub(super) fn means(&self) -> Vec<Ball> {
        (0..self.height()).map(|k| self.coefficient(k, 0)).collect()
    }

    /// The coefficients where the second angle is zero.
    pub(super) fn at_end(&self) -> Vec<Ball> {
        self.sums(|_| false)
    }

    /// The coefficients where the second angle is pi.
    pub(super) fn at_begin(&self) -> Vec<Ball> {
        self.sums(|n| n % 2 == 1)
    }

    fn sums(&self, is_negative: impl Fn(usize) -> bool) -> Vec<Ball> {
        let sum = |row: &Vec<Ball>| {
            let sum =
                row.iter().enumerate().fold(Ball::zero(), |sum, (n, ball)| match is_negative(n) {
                    true => PRECISION.difference(&sum, ball),
                    false => PRECISION.sum(&sum, ball),
                });
            WORKING.converted(&sum, PRECISION)
        };
        self.rows.iter().map(sum).collect()
    }

    /// The norm of the part that changes with the second angle.
    pub(super) fn spread(&self) -> Bound {
        let changing = self.rows.iter().flat_map(|row| row.iter().skip(1));
        let spread: Bound = changing.map(|ball| PRECISION.magnitude(ball)).sum();
        spread + self.tail
    }

    /// The norm of the part in the coefficients.
    fn finite_norm(&self) -> Bound {
        self.rows.iter().flatten().map(|ball| PRECISION.magnitude(ball)).sum()
    }

    fn zip(&self, other: &Self, join: impl Fn(&Ball, &Ball) -> Ball) -> Self {
        let (zero, none) = (Ball::zero(), vec![]);
        let row = |k: usize| {
            let [left, right] = [self, other].map(|sheet| sheet.rows.get(k).unwrap_or(&none));
            let pair = |n| join(left.get(n).unwrap_or(&zero), right.get(n).unwrap_or(&zero));
            (0..left.len().max(right.len())).map(pair).collect()
        };
        let rows = (0..self.height().max(other.height())).map(row).collect();
        Self::of_balls(rows, self.tail + other.tail)
    }

    fn mapped(&self, coefficient: impl Fn(&Ball) -> Ball, tail: Bound) -> Self {
        let row = |row: &Vec<Ball>| row.iter().map(&coefficient).collect();
        Self::of_balls(self.rows.iter().map(row).collect(), tail)
    }

    /// The coefficients that are not zero as factors, with their harmonics.
    fn factors(&self) -> Vec<(usize, usize, BallFactor)> {
        let all = self.rows.iter().enumerate().flat_map(|(k, row)| {
            let occurring = row.iter().enumerate().filter(|(_, ball)| !ball.is_zero());
            occurring.map(move |(n, ball)| (k, n, BallFactor::new(PRECISION, ball)))
        });
        all.collect()
    }
}

impl Analytic for Sheet {
    fn constant(value: Ball) -> Self {
        Self::of_balls(vec![vec![PRECISION.converted(&value, WORKING)]], Bound::ZERO)
    }

    fn sum(&self, other: &Self) -> Self {
        self.zip(other, |left, right| PRECISION.sum(left, right))
    }

    fn difference(&self, other: &Self) -> Self {
        self.zip(other, |left, right| PRECISION.difference(left, right))
    }

    fn product(&self, other: &Self) -> Self {
        let [left, right] = [self, other].map(Self::factors);
        let height = (self.height() + other.height()).saturating_sub(1);
        let width = (self.width() + other.width()).saturating_sub(1);
        let factors = left.iter().chain(&right).map(|(_, _, factor)| factor);
        // Four times the product.
        let mut sums = BallProductSums::new(height * width, factors);
        for (i, m, own) in &left {
            for (j, n, other) in &right {
                let [above, below] = [i + j, i.abs_diff(*j)].map(|k| k * width);
                let [long, short] = [m + n, m.abs_diff(*n)];
                let places = [above + long, above + short, below + long, below + short];
                sums.add(own, other, places.map(|place| (place, false)));
            }
        }
        let balls = sums.rounded(PRECISION, PRECISION.bits, 2);
        let rows = balls.chunks(width.max(1)).map(<[Ball]>::to_vec).collect();
        let tail = self.tail * other.norm() + other.tail * self.finite_norm();
        Self::of_balls(rows, tail)
    }

    fn scaled(&self, factor: i64) -> Self {
        let tail = self.tail * Bound::of_nearest(factor.unsigned_abs() as f64);
        self.mapped(|ball| PRECISION.scaled(ball, factor), tail)
    }

    fn divided(&self, divisor: u32) -> Self {
        self.mapped(|ball| PRECISION.divided(ball, divisor), self.tail / divisor)
    }

    fn norm(&self) -> Bound {
        self.finite_norm() + self.tail
    }

    fn widened(mut self, distance: Bound) -> Self {
        self.tail += distance;
        self
    }

    fn at_zero(&self) -> Ball {
        let sum = self.at_end().iter().fold(Ball::zero(), |sum, ball| WORKING.sum(&sum, ball));
        Ball { radius: sum.radius + self.tail, ..sum }
    }

    fn negligible(&self) -> i32 {
        NEGLIGIBLE
    }

    fn without_radii(mut self) -> Self {
        self.tail = Bound::ZERO;
        self
    }

    fn sampled(&self, function: impl Fn(f64) -> f64) -> Option<Self> {
        const SMALL: f64 = 1e-16;
        let samples = |length: usize| (4 * length).next_power_of_two().clamp(64, 512);
        let along = [self.height(), self.width()].map(|length| Transform::new(samples(length)));
        let nearest = |ball: &Ball| [PRECISION.nearest(ball), 0.0];
        // A row for each harmonic of the first angle, then one for each sample of the second.
        let rows: Vec<Vec<f64>> =
            self.rows.iter().map(|row| along[1].sum_of_waves(row.iter().map(nearest))).collect();
        let mut by_sample = vec![];
        for sample in 0..along[1].samples() {
            let values = along[0].sum_of_waves(rows.iter().map(|row| [row[sample], 0.0]));
            let values: Vec<f64> = values.into_iter().map(&function).collect();
            if values.iter().any(|value| !value.is_finite()) {
                return None;
            }
            by_sample.push(along[0].harmonics(&values, values.len() / 2 - 1).cosines);
        }
        let mut rows = vec![];
        for k in 0..along[0].samples() / 2 - 1 {
            let values: Vec<f64> = by_sample.iter().map(|cosines| cosines[k]).collect();
            let cosines = along[1].harmonics(&values, values.len() / 2 - 1).cosines;
            let ball = |(n, cosine): (usize, f64)| {
                // The coefficients of constants are twice the means.
                let twice = usize::from(k == 0) + usize::from(n == 0);
                let value = if cosine.abs() < SMALL { 0.0 } else { cosine / (1 << twice) as f64 };
                Some(PRECISION.fraction(&from_f64(value)?))
            };
            rows.push(cosines.into_iter().enumerate().map(ball).collect::<Option<Vec<Ball>>>()?);
        }
        Some(Self::of_balls(rows, Bound::ZERO).without_radii())
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::exact::ratio;

    /// Coefficients of a function in units of `2^-20`, and a disturbance of a hundredth at most that its tail holds.
    fn sheet() -> impl Strategy<Value = (Sheet, Vec<Vec<f64>>)> {
        let row = || proptest::collection::vec(-200_000_i64..200_000, 1..4);
        (proptest::collection::vec(row(), 1..4), -0.01..0.01_f64, 0_usize..5, 0_usize..5).prop_map(
            |(rows, disturbance, k, n)| {
                let units = |row: &Vec<i64>| row.iter().map(|unit| Integer::from(*unit)).collect();
                let sheet = Sheet::of_units(&rows.iter().map(units).collect::<Vec<_>>(), 20);
                let doubles = |row: &Vec<i64>| row.iter().map(|c| *c as f64 / 1048576.0).collect();
                let mut rows: Vec<Vec<f64>> = rows.iter().map(doubles).collect();
                rows.resize(rows.len().max(k + 1), vec![]);
                let length = rows[k].len().max(n + 1);
                rows[k].resize(length, 0.0);
                rows[k][n] += disturbance;
                (sheet.widened(Bound::exactly(0.01)), rows)
            },
        )
    }

    fn value(rows: &[Vec<f64>], [theta, phi]: [f64; 2]) -> f64 {
        let all = rows.iter().enumerate().flat_map(|(k, row)| {
            let own = row.iter().enumerate();
            own.map(move |(n, c)| c * (k as f64 * theta).cos() * (n as f64 * phi).cos())
        });
        all.sum()
    }

    fn holds(sheet: &Sheet, angles: [f64; 2], number: f64) -> bool {
        let doubles = |row: &Vec<Ball>| row.iter().map(|c| PRECISION.nearest(c)).collect();
        let rows: Vec<Vec<f64>> = sheet.rows.iter().map(doubles).collect();
        (value(&rows, angles) - number).abs() <= sheet.tail.value() + 1e-12
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(12))]

        #[test]
        fn functions_of_a_sheet_contain_those_of_every_member(
            (left, x) in sheet(), (right, y) in sheet(), theta in 0.0..6.3_f64, phi in 0.0..6.3_f64
        ) {
            let angles = [theta, phi];
            let (x, y) = (value(&x, angles), value(&y, angles));
            prop_assert!(holds(&left, angles, x) && holds(&right, angles, y));
            prop_assert!(holds(&left.sum(&right), angles, x + y));
            prop_assert!(holds(&left.difference(&right), angles, x - y));
            prop_assert!(holds(&left.product(&right), angles, x * y));
            prop_assert!(holds(&left.power(3), angles, x.powi(3)));
            prop_assert!(holds(&left.scaled(-7).divided(3), angles, -7.0 * x / 3.0));
            let (sine, cosine) = left.sine_and_cosine().expect("a small argument");
            prop_assert!(holds(&sine, angles, x.sin()) && holds(&cosine, angles, x.cos()));
            let above = left.divided(4).sum(&Sheet::integer(2));
            prop_assert!(holds(&above.inverse().expect("no zero"), angles, 1.0 / (2.0 + x / 4.0)));
            prop_assert!(holds(&above.logarithm().expect("no zero"), angles, (2.0 + x / 4.0).ln()));
            let close = above.without_radii().inverse().expect("no zero");
            prop_assert!(close.tail.value() < 1e-12);
        }
    }

    #[test]
    fn an_interval_has_its_ends() {
        let [middle, half] = [ratio(1, 3), ratio(1, 7)].map(|value| WORKING.fraction(&value));
        let sheet = Sheet::interval(&middle, &half);
        let ends = [sheet.at_begin(), sheet.at_end()].map(|series| WORKING.nearest(&series[0]));
        assert!((ends[0] - 4.0 / 21.0).abs() < 1e-15 && (ends[1] - 10.0 / 21.0).abs() < 1e-15);
        assert!((sheet.spread().value() - 1.0 / 7.0).abs() < 1e-15);
        let square = sheet.product(&sheet);
        assert!((WORKING.nearest(&square.means()[0]) - 1.0 / 9.0 - 1.0 / 98.0).abs() < 1e-15);
        assert!((WORKING.nearest(&square.coefficient(0, 2)) - 1.0 / 98.0).abs() < 1e-15);
    }
}
