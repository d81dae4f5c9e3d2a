//! Upper bounds of absolute values, as doubles that are rounded up.
//!
//! In: numbers, none negative. Out: doubles that are certainly no smaller than their sums, products
//! and quotients. The error of an IEEE 754 operation is at most half a unit in the last place, so
//! that the next double above its result is a bound. NaN becomes infinity, the bound of an unknown
//! number.

use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Mul};

use super::rational::{Rational, from_f64, to_f64};

/// An upper bound of a number that is not negative; infinity if nothing is known.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct Bound(f64);

impl Bound {
    /// The bound of zero.
    pub const ZERO: Self = Self(0.0);
    /// The bound of an unknown size.
    pub const UNKNOWN: Self = Self(f64::INFINITY);

    /// The bound equal to a double that is exact, or rounded up already.
    pub const fn exactly(value: f64) -> Self {
        match value >= 0.0 {
            true => Self(value),
            false => Self::UNKNOWN,
        }
    }

    /// A bound of the number whose nearest double is given.
    pub const fn of_nearest(value: f64) -> Self {
        match value >= 0.0 {
            true => Self(value.next_up()),
            false => Self::UNKNOWN,
        }
    }

    /// The bound `2^exponent`; unknown beyond the exponents of normal doubles.
    pub fn power_of_two(exponent: i32) -> Self {
        /// The exponent of one in the bits of a double, and the number of bits after it.
        const ONE: i32 = f64::MAX_EXP - 1;
        const AFTER: u32 = f64::MANTISSA_DIGITS - 1;
        match (f64::MIN_EXP..f64::MAX_EXP).contains(&exponent) {
            true => Self(f64::from_bits(((exponent + ONE) as u64) << AFTER)),
            false => Self::UNKNOWN,
        }
    }

    /// A bound of the absolute value of a fraction.
    pub fn of_fraction(value: &Rational) -> Self {
        let nearest = to_f64(value).abs();
        match from_f64(nearest) {
            Some(exact) if exact >= num_traits::abs(value.clone()) => Self::exactly(nearest),
            _ => Self::of_nearest(nearest),
        }
    }

    /// The double.
    pub const fn value(self) -> f64 {
        self.0
    }

    /// The larger of two.
    #[must_use]
    pub const fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }

    /// The square root.
    #[must_use]
    pub fn sqrt(self) -> Self {
        match self == Self::ZERO {
            true => self,
            false => Self::of_nearest(self.0.sqrt()),
        }
    }

    /// Returns a double that is certainly no larger than `1 - bound`; it may be negative.
    pub const fn below_complement(self) -> f64 {
        (1.0 - self.0).next_down()
    }

    /// The quotient by a lower bound of the divisor; unknown if that is not positive.
    #[must_use]
    pub fn over(self, divisor: f64) -> Self {
        match (self == Self::ZERO, divisor > 0.0) {
            (_, false) => Self::UNKNOWN,
            (true, true) => self,
            (false, true) => Self::of_nearest(self.0 / divisor),
        }
    }
}

impl Add for Bound {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        match (self == Self::ZERO, other == Self::ZERO) {
            (true, _) => other,
            (_, true) => self,
            _ => Self::of_nearest(self.0 + other.0),
        }
    }
}

impl AddAssign for Bound {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Mul for Bound {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        // A product with an unknown size is unknown, whatever the other factor.
        match (self == Self::ZERO || other == Self::ZERO, self.0 + other.0 < f64::INFINITY) {
            (_, false) => Self::UNKNOWN,
            (true, true) => Self::ZERO,
            (false, true) => Self::of_nearest(self.0 * other.0),
        }
    }
}

/// Division by an exact number.
impl Div<u32> for Bound {
    type Output = Self;

    fn div(self, divisor: u32) -> Self {
        self.over(f64::from(divisor))
    }
}

impl Sum for Bound {
    fn sum<I: Iterator<Item = Self>>(terms: I) -> Self {
        terms.fold(Self::ZERO, Add::add)
    }
}
