//! Balls: numbers known up to a radius, in fixed point.
//!
//! A ball is all real numbers within `radius` of `middle * 2^-bits`. In: fractions, and other
//! balls. Out: balls that contain the sum, product, quotient or root of any numbers in the given
//! balls. A product costs one product of integers of `bits` digits and some operations on doubles.
//! Rounding errors are added to the radius, so that a statement proved for a ball is true of the
//! number.
//!
//! Source: F. Johansson, Arb: efficient arbitrary-precision midpoint-radius interval arithmetic,
//! IEEE Transactions on Computers 66 (2017), 1281-1292; in fixed point here, because the sums of a
//! Fourier series have a single scale.

use num_integer::Integer as _;
use num_traits::{Signed, ToPrimitive, Zero};

use super::bound::Bound;
use super::integer::Integer;
use super::rational::Rational;

/// A number known up to a radius. The unit of its middle is that of the [`Balls`] that it belongs
/// to.
#[derive(Clone, Debug, PartialEq)]
pub struct Ball {
    /// The middle, in units of `2^-bits`.
    pub middle: Integer,
    /// The radius, in the unit of the number itself, not of the middle.
    pub radius: Bound,
}

impl Ball {
    /// The exact zero, with radius zero.
    pub fn zero() -> Self {
        Self { middle: Integer::zero(), radius: Bound::ZERO }
    }

    /// Whether the ball is the exact zero.
    pub fn is_zero(&self) -> bool {
        self.middle.is_zero() && self.radius == Bound::ZERO
    }
}

/// The balls with a given number of binary digits after the point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Balls {
    /// The number of digits; below a thousand, so that the unit is a normal double.
    pub bits: usize,
}

impl Balls {
    /// The unit of the middles.
    fn unit(self) -> Bound {
        Bound::power_of_two(i32::try_from(self.bits).map_or(i32::MIN, |bits| -bits))
    }

    /// Returns a bound of the absolute value of a number of units.
    fn size(self, units: &Integer) -> Bound {
        match units.is_zero() {
            true => Bound::ZERO,
            false => {
                Bound::of_nearest(units.to_f64().map_or(f64::INFINITY, f64::abs)) * self.unit()
            }
        }
    }

    /// Rounds a number of units of `2^(-2 bits)`, such as a product of two middles, to units of
    /// `2^-bits`; `radius` is added to the rounding error.
    pub fn rounded(self, units: &Integer, radius: Bound) -> Ball {
        self.shifted(units, self.bits, radius)
    }

    /// Rounds `units * 2^-places` down; `radius` is added to the rounding error.
    pub(super) fn shifted(self, units: &Integer, places: usize, radius: Bound) -> Ball {
        let exact = units.halvings().is_none_or(|halvings| halvings >= places);
        Ball {
            middle: units.clone() >> places,
            radius: if exact { radius } else { radius + self.unit() },
        }
    }

    /// An integer.
    pub fn integer(self, value: i64) -> Ball {
        Ball { middle: Integer::from(value) << self.bits, radius: Bound::ZERO }
    }

    /// `integer * 2^-bits` with other bits.
    pub fn dyadic(self, integer: &Integer, bits: usize) -> Ball {
        match self.bits.checked_sub(bits) {
            Some(more) => Ball { middle: integer << more, radius: Bound::ZERO },
            None => self.shifted(integer, bits - self.bits, Bound::ZERO),
        }
    }

    /// A fraction.
    pub fn fraction(self, value: &Rational) -> Ball {
        let (middle, rest) = (value.numer() << self.bits).div_mod_floor(value.denom());
        Ball { middle, radius: if rest.is_zero() { Bound::ZERO } else { self.unit() } }
    }

    /// Converts a ball from another number of digits.
    pub fn converted(self, ball: &Ball, from: Self) -> Ball {
        let mut converted = self.dyadic(&ball.middle, from.bits);
        converted.radius += ball.radius;
        converted
    }

    /// The middle as a fraction.
    pub fn middle(self, ball: &Ball) -> Rational {
        Rational::new(ball.middle.clone(), Integer::from(1) << self.bits)
    }

    /// The middle as a double, for use outside of proofs.
    pub fn nearest(self, ball: &Ball) -> f64 {
        super::rational::to_f64(&self.middle(ball))
    }

    /// Returns an upper bound of the absolute values of all numbers in the ball.
    pub fn magnitude(self, ball: &Ball) -> Bound {
        self.size(&ball.middle) + ball.radius
    }

    /// Returns a lower bound of the absolute values of all numbers in the ball; not positive if
    /// zero may be among them.
    pub fn distance_from_zero(self, ball: &Ball) -> f64 {
        let size = ball.middle.to_f64().map_or(0.0, f64::abs).next_down() * self.unit().value();
        match ball.radius == Bound::ZERO {
            true => size,
            false => (size - ball.radius.value()).next_down(),
        }
    }

    /// `left + right`.
    pub fn sum(self, left: &Ball, right: &Ball) -> Ball {
        Ball { middle: &left.middle + &right.middle, radius: left.radius + right.radius }
    }

    /// `left - right`.
    pub fn difference(self, left: &Ball, right: &Ball) -> Ball {
        Ball { middle: &left.middle - &right.middle, radius: left.radius + right.radius }
    }

    /// Returns a bound of the absolute value of the middle of a ball.
    pub fn size_of_middle(self, ball: &Ball) -> Bound {
        self.size(&ball.middle)
    }

    /// The radius of a product, before its middle is rounded.
    pub fn radius_of_product(self, left: &Ball, right: &Ball) -> Bound {
        // A size costs more than all the rest.
        let size = |ball: &Ball, other: &Ball| match other.radius == Bound::ZERO {
            true => Bound::ZERO,
            false => self.size(&ball.middle),
        };
        let sizes = [size(left, right), size(right, left)];
        radius_of_product([left.radius, right.radius], sizes)
    }

    /// `left * right`.
    pub fn product(self, left: &Ball, right: &Ball) -> Ball {
        match left.is_zero() || right.is_zero() {
            true => Ball::zero(),
            false => {
                self.rounded(&(&left.middle * &right.middle), self.radius_of_product(left, right))
            }
        }
    }

    /// `ball * factor`.
    pub fn scaled(self, ball: &Ball, factor: i64) -> Ball {
        Ball {
            middle: &ball.middle * Integer::from(factor),
            radius: ball.radius * Bound::of_nearest(factor.unsigned_abs() as f64),
        }
    }

    /// `ball / divisor`, for a divisor that is not zero.
    pub fn divided(self, ball: &Ball, divisor: u32) -> Ball {
        let radius = ball.radius / divisor;
        let (middle, rest) = ball.middle.div_mod_floor(&divisor.into());
        Ball { middle, radius: if rest.is_zero() { radius } else { radius + self.unit() } }
    }

    /// `left / right`; `None` if zero may be among the divisors.
    pub fn quotient(self, left: &Ball, right: &Ball) -> Option<Ball> {
        let distance = self.distance_from_zero(right);
        (distance > 0.0).then(|| {
            let (middle, _) = (&left.middle << self.bits).div_mod_floor(&right.middle);
            // a/b - m = (a - m b)/b, with the middles' remainder less than a unit of b.
            let quotient = self.size(&middle) + self.unit();
            Ball {
                middle,
                radius: (left.radius + quotient * right.radius).over(distance) + self.unit(),
            }
        })
    }

    /// The positive `degree`-th root; `None` if a number in the ball may not be positive, or if
    /// `degree` is zero.
    pub fn root(self, ball: &Ball, degree: u32) -> Option<Ball> {
        let distance = self.distance_from_zero(ball);
        if ball.middle.is_negative() || distance <= 0.0 || degree == 0 {
            return None;
        }
        let places = self.bits.checked_mul(degree as usize - 1)?;
        let middle = (&ball.middle << places).nth_root(degree);
        // The derivative of the root r by x is r/(n x); both factors are bounded over the whole
        // ball, r by the root of its upper end.
        let highest =
            (self.size(&middle) + self.unit()) * (Bound::exactly(1.0) + ball.radius.over(distance));
        let slope = highest.over(distance) / degree;
        Some(Ball { middle, radius: self.unit() + slope * ball.radius })
    }

    /// pi, by Machin's formula `16 atan(1/5) - 4 atan(1/239)`.
    pub fn pi(self) -> Ball {
        let arctangent = |x: u32| {
            let square = x * x;
            let mut power = self.divided(&self.integer(1), x);
            let mut sum = Ball::zero();
            let mut denominator = 1;
            // The series alternates: the remainder is smaller than the first term left out.
            while self.magnitude(&power) > self.unit() + self.unit() {
                let term = self.divided(&power, denominator);
                sum = match denominator % 4 {
                    1 => self.sum(&sum, &term),
                    _ => self.difference(&sum, &term),
                };
                power = self.divided(&power, square);
                denominator += 2;
            }
            sum.radius += self.magnitude(&power);
            sum
        };
        self.difference(&self.scaled(&arctangent(5), 16), &self.scaled(&arctangent(239), 4))
    }
}

/// The radius of a product of two balls, before its middle is rounded, from their radii and bounds of
/// the [sizes of their middles](Balls::size_of_middle).
pub(super) fn radius_of_product([left, right]: [Bound; 2], sizes: [Bound; 2]) -> Bound {
    let own = |radius: Bound, size: Bound| match radius == Bound::ZERO {
        true => Bound::ZERO,
        false => radius * size,
    };
    own(left, sizes[1]) + own(right, sizes[0]) + left * right
}

#[cfg(test)]
mod tests {
    use num_traits::{Signed as _, Zero as _};
    use proptest::prelude::*;

    use super::{Ball, Balls};
    use crate::exact::Integer;
    use crate::exact::bound::Bound;
    use crate::exact::rational::{Rational, from_f64, power};

    const BALLS: Balls = Balls { bits: 40 };

    /// Whether the exact number is in the ball.
    fn contains(ball: &Ball, number: &Rational) -> bool {
        let distance = (BALLS.middle(ball) - number).abs();
        from_f64(ball.radius.value()).is_none_or(|radius| distance <= radius)
    }

    /// A ball and a number in it, at its ends and in its middle too.
    fn ball_with_number() -> impl Strategy<Value = (Ball, Rational)> {
        let middle =
            prop_oneof![Just(0_i64), Just(1 << 40), Just(-(1 << 40)), -50_i64..50, any::<i64>()];
        let radius = prop_oneof![Just(0.0), Just(2.0_f64.powi(-40)), 0.0..1e-6_f64, 0.0..3.0_f64];
        let place = prop_oneof![Just(-1_i64), Just(0), Just(1), -1..=1_i64];
        (middle, radius, place, 1_i64..9).prop_map(|(middle, radius, place, part)| {
            let ball = Ball { middle: Integer::from(middle), radius: Bound::exactly(radius) };
            let radius = from_f64(radius).unwrap_or_else(Rational::zero);
            let number = BALLS.middle(&ball)
                + radius * Rational::new(Integer::from(place), Integer::from(part));
            (ball, number)
        })
    }

    proptest! {
        #[test]
        fn operations_contain_the_exact_result((left, x) in ball_with_number(), (right, y) in ball_with_number(), n in 1_u32..9) {
            prop_assert!(contains(&left, &x) && contains(&right, &y));
            prop_assert!(contains(&BALLS.sum(&left, &right), &(&x + &y)));
            prop_assert!(contains(&BALLS.difference(&left, &right), &(&x - &y)));
            prop_assert!(contains(&BALLS.product(&left, &right), &(&x * &y)));
            prop_assert!(contains(&BALLS.divided(&left, n), &(&x / Integer::from(n))));
            prop_assert!(contains(&BALLS.scaled(&left, -i64::from(n)), &(&x * -Integer::from(n))));
            if let Some(quotient) = BALLS.quotient(&left, &right) {
                prop_assert!(contains(&quotient, &(&x / &y)));
            }
            prop_assert!(from_f64(BALLS.magnitude(&left).value()).is_some_and(|bound| bound >= x.abs()));
            prop_assert!(from_f64(BALLS.distance_from_zero(&left)).is_some_and(|bound| bound <= x.abs()));
            if let Some(root) = BALLS.root(&left, n) {
                // The root is between the ends of its ball exactly when the number is between their
                // powers.
                let radius = from_f64(root.radius.value()).unwrap_or_else(Rational::zero);
                let ends = [BALLS.middle(&root) - &radius, BALLS.middle(&root) + radius];
                let powers = ends.map(|end| if end.is_negative() { Rational::zero() } else { end.pow(n as i32) });
                prop_assert!(powers[0] <= x && x <= powers[1], "{root:?} for {left:?}");
            }
        }
    }

    #[test]
    fn pi_to_two_hundred_digits() {
        let balls = Balls { bits: 200 };
        let pi = balls.pi();
        assert!(pi.radius.value() < 1e-57);
        let known: Rational = Rational::new(
            "31415926535897932384626433832795028841971693993751058209749445923078164"
                .parse()
                .unwrap_or_else(|_| Integer::zero()),
            Integer::from(10).pow(70),
        );
        let distance = (balls.middle(&pi) - known).abs();
        assert!(from_f64(pi.radius.value()).is_some_and(|radius| distance <= radius));
    }

    #[test]
    fn roots_agree_with_exact_ones() {
        let two = power(
            &Rational::from_integer(Integer::from(8)),
            &Rational::new(Integer::from(1), Integer::from(3)),
        );
        let root = BALLS.root(&BALLS.integer(8), 3);
        assert!(root.zip(two).is_some_and(|(root, two)| contains(&root, &two)));
    }
}
