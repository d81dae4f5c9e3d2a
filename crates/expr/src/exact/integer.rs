//! Integers of any length; those of up to two machine words need no memory on the heap.

use std::fmt;
use std::iter::{Product, Sum};
use std::ops::{
    Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Rem, RemAssign, Shl, Shr, Sub, SubAssign,
};
use std::str::FromStr;

use dashu_int::IBig;
use dashu_int::ops::{Abs as _, BitTest as _, DivRem as _, Gcd as _};
use num_traits::{Num, One, Pow, Signed, ToPrimitive, Zero};

/// An integer of any length.
///
/// The type wraps that of `dashu-int`, whose `num_integer::Integer` rounds quotients between -1 and
/// 0 up: fractions over it would be ordered wrongly.
#[derive(Clone, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Integer(IBig);

impl Integer {
    /// The integer of the underlying crate.
    pub(super) fn as_inner(&self) -> &IBig {
        &self.0
    }

    /// Wraps an integer of the underlying crate.
    pub(super) fn of_inner(value: IBig) -> Self {
        Self(value)
    }

    /// The remainder of a division by a positive word, with the sign of this integer.
    ///
    /// # Panics
    /// If `divisor` is zero.
    pub fn remainder(&self, divisor: u64) -> i128 {
        let remainder = &self.0 % IBig::from(divisor);
        i128::try_from(&remainder).unwrap_or_default()
    }

    /// The number of binary digits of the absolute value; 0 for zero.
    pub fn bits(&self) -> u64 {
        self.0.bit_len() as u64
    }

    /// Whether the integer is odd.
    pub fn is_odd(&self) -> bool {
        self.0.bit(0)
    }

    /// The `exponent`-th power.
    pub fn pow(&self, exponent: u32) -> Self {
        Self(self.0.pow(exponent as usize))
    }

    /// Number of times that the integer can be halved; `None` for zero.
    pub fn halvings(&self) -> Option<usize> {
        self.0.trailing_zeros()
    }

    /// Whether the absolute value is a power of two, as most denominators are: what it has in common
    /// with another integer is then read off both.
    fn is_power_of_two(&self) -> bool {
        self.halvings().is_some_and(|halvings| halvings as u64 + 1 == self.bits())
    }

    /// The absolute value in words, the lowest first.
    pub(crate) fn to_words(&self) -> Vec<u64> {
        if let Ok(short) = i128::try_from(&self.0) {
            let size = short.unsigned_abs();
            let count = (u128::BITS - size.leading_zeros()).div_ceil(u64::BITS) as usize;
            return [size as u64, (size >> u64::BITS) as u64][..count].to_vec();
        }
        let (_, magnitude) = self.0.clone().into_parts();
        let bytes = magnitude.to_le_bytes();
        let word =
            |bytes: &[u8]| bytes.iter().rev().fold(0, |word, byte| word << 8 | u64::from(*byte));
        bytes.chunks(8).map(word).collect()
    }

    /// The number, not negative, with these words, the lowest first; the words are not of use any
    /// more.
    pub(crate) fn from_words(words: &mut [u64]) -> Self {
        words.iter_mut().for_each(|word| *word = word.to_le());
        Self(dashu_int::UBig::from_le_bytes(bytemuck::cast_slice(words)).into())
    }

    /// The `degree`-th root, rounded towards zero.
    ///
    /// # Panics
    /// If an even root is taken of a negative number, or `degree` is zero.
    pub fn nth_root(&self, degree: u32) -> Self {
        Self(self.0.nth_root(degree as usize))
    }
}

impl fmt::Display for Integer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// Prints all digits; the inner type would leave out those in the middle.
impl fmt::Debug for Integer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// The error of a text that is not an integer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no integer")]
pub struct ParseIntegerError;

/// Reads decimal digits after at most one sign.
impl FromStr for Integer {
    type Err = ParseIntegerError;

    fn from_str(text: &str) -> Result<Self, ParseIntegerError> {
        Self::from_str_radix(text, 10)
    }
}

macro_rules! from_primitive {
    ($($primitive:ty)*) => {$(
        impl From<$primitive> for Integer {
            #[inline]
            fn from(value: $primitive) -> Self {
                Self(value.into())
            }
        }
    )*};
}
from_primitive!(i32 u32 i64 u64 i128 u128 usize);

impl Neg for Integer {
    type Output = Self;

    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Neg for &Integer {
    type Output = Integer;

    fn neg(self) -> Integer {
        Integer(-&self.0)
    }
}

macro_rules! arithmetic {
    ($($operation:ident $method:ident $assignment:ident $in_place:ident)*) => {$(
        impl $operation for Integer {
            type Output = Self;

            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }

        impl $operation<&Self> for Integer {
            type Output = Self;

            fn $method(self, other: &Self) -> Self {
                Self(self.0.$method(&other.0))
            }
        }

        impl $operation<Integer> for &Integer {
            type Output = Integer;

            fn $method(self, other: Integer) -> Integer {
                Integer((&self.0).$method(other.0))
            }
        }

        impl $operation for &Integer {
            type Output = Integer;

            fn $method(self, other: Self) -> Integer {
                Integer((&self.0).$method(&other.0))
            }
        }

        impl $assignment for Integer {
            fn $in_place(&mut self, other: Self) {
                self.0.$in_place(other.0);
            }
        }

        impl $assignment<&Self> for Integer {
            fn $in_place(&mut self, other: &Self) {
                self.0.$in_place(&other.0);
            }
        }
    )*};
}
arithmetic! {
    Add add AddAssign add_assign
    Sub sub SubAssign sub_assign
    Mul mul MulAssign mul_assign
    Div div DivAssign div_assign
    Rem rem RemAssign rem_assign
}

impl Shl<usize> for Integer {
    type Output = Self;

    fn shl(self, places: usize) -> Self {
        Self(self.0 << places)
    }
}

impl Shl<usize> for &Integer {
    type Output = Integer;

    fn shl(self, places: usize) -> Integer {
        Integer(&self.0 << places)
    }
}

/// Shifts and rounds down.
impl Shr<usize> for &Integer {
    type Output = Integer;

    fn shr(self, places: usize) -> Integer {
        Integer(&self.0 >> places)
    }
}

/// Shifts and rounds down.
impl Shr<usize> for Integer {
    type Output = Self;

    fn shr(self, places: usize) -> Self {
        Self(self.0 >> places)
    }
}

impl Sum for Integer {
    fn sum<I: Iterator<Item = Self>>(terms: I) -> Self {
        terms.fold(Self::zero(), Add::add)
    }
}

impl Product for Integer {
    fn product<I: Iterator<Item = Self>>(factors: I) -> Self {
        factors.fold(Self::one(), Mul::mul)
    }
}

impl Zero for Integer {
    #[inline]
    fn zero() -> Self {
        Self(IBig::ZERO)
    }

    #[inline]
    fn is_zero(&self) -> bool {
        self.0.is_zero()
    }
}

impl One for Integer {
    fn one() -> Self {
        Self(IBig::ONE)
    }

    fn is_one(&self) -> bool {
        self.0.is_one()
    }
}

impl Num for Integer {
    type FromStrRadixErr = ParseIntegerError;

    fn from_str_radix(text: &str, radix: u32) -> Result<Self, ParseIntegerError> {
        let digits = text.strip_prefix(['+', '-']).unwrap_or(text);
        // The inner type also accepts underscores between the digits.
        let only_digits =
            (2..=36).contains(&radix) && digits.chars().all(|digit| digit.is_digit(radix));
        if digits.is_empty() || !only_digits {
            return Err(ParseIntegerError);
        }
        IBig::from_str_radix(text, radix).map(Self).map_err(|_| ParseIntegerError)
    }
}

impl Signed for Integer {
    fn abs(&self) -> Self {
        Self((&self.0).abs())
    }

    fn abs_sub(&self, other: &Self) -> Self {
        if self > other { self - other } else { Self::zero() }
    }

    fn signum(&self) -> Self {
        Self(self.0.signum())
    }

    fn is_positive(&self) -> bool {
        self.0 > IBig::ZERO
    }

    fn is_negative(&self) -> bool {
        self.0 < IBig::ZERO
    }
}

impl Pow<u32> for Integer {
    type Output = Self;

    fn pow(self, exponent: u32) -> Self {
        Self::pow(&self, exponent)
    }
}

impl Pow<u32> for &Integer {
    type Output = Integer;

    fn pow(self, exponent: u32) -> Integer {
        Integer::pow(self, exponent)
    }
}

impl ToPrimitive for Integer {
    fn to_i64(&self) -> Option<i64> {
        i64::try_from(&self.0).ok()
    }

    fn to_u64(&self) -> Option<u64> {
        u64::try_from(&self.0).ok()
    }

    fn to_i128(&self) -> Option<i128> {
        i128::try_from(&self.0).ok()
    }

    fn to_u128(&self) -> Option<u128> {
        u128::try_from(&self.0).ok()
    }

    /// The nearest double; infinite beyond the range of doubles.
    fn to_f64(&self) -> Option<f64> {
        Some(self.0.to_f64().value())
    }
}

impl num_integer::Integer for Integer {
    fn div_floor(&self, other: &Self) -> Self {
        self.div_mod_floor(other).0
    }

    fn mod_floor(&self, other: &Self) -> Self {
        self.div_mod_floor(other).1
    }

    fn div_mod_floor(&self, other: &Self) -> (Self, Self) {
        let (quotient, remainder) = (&self.0).div_rem(&other.0);
        if remainder.is_zero() || remainder.sign() == other.0.sign() {
            (Self(quotient), Self(remainder))
        } else {
            (Self(quotient - IBig::ONE), Self(remainder + &other.0))
        }
    }

    fn gcd(&self, other: &Self) -> Self {
        // The inner type panics if both are zero.
        if self.is_zero() {
            return other.abs();
        }
        if self.is_power_of_two() || other.is_power_of_two() {
            let shared = [self, other].into_iter().filter_map(Self::halvings).min();
            return Self::one() << shared.unwrap_or(0);
        }
        Self((&self.0).gcd(&other.0).into())
    }

    fn lcm(&self, other: &Self) -> Self {
        if self.is_zero() || other.is_zero() {
            return Self::zero();
        }
        (self / self.gcd(other) * other).abs()
    }

    fn is_multiple_of(&self, other: &Self) -> bool {
        if other.is_zero() {
            return self.is_zero();
        }
        (self % other).is_zero()
    }

    fn is_even(&self) -> bool {
        !self.0.bit(0)
    }

    fn is_odd(&self) -> bool {
        self.0.bit(0)
    }

    fn div_rem(&self, other: &Self) -> (Self, Self) {
        let (quotient, remainder) = (&self.0).div_rem(&other.0);
        (Self(quotient), Self(remainder))
    }
}
