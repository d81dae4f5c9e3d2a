//! Floating-point numbers of any chosen precision.

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;

use super::{Integer, Rational};

/// A binary floating-point number of a chosen precision, which results keep. The range of its
/// exponent is practically unbounded.
#[derive(Clone, Debug, PartialEq)]
pub struct BigFloat(FBig<HalfEven, 2>);

impl BigFloat {
    /// The nearest number to a fraction, with `bits` binary digits.
    pub fn of_fraction(value: &Rational, bits: usize) -> Self {
        let of = |integer: &Integer| Self::of_integer(integer, bits);
        match value.is_integer() {
            true => of(value.numer()),
            false => of(value.numer()).over(&of(value.denom())),
        }
    }

    /// The nearest number to an integer, with `bits` binary digits.
    pub fn of_integer(value: &Integer, bits: usize) -> Self {
        Self(FBig::from_parts(value.as_inner().clone(), 0).with_precision(bits).value())
    }

    /// A double, exactly if `bits` suffices; zero if it is not finite.
    pub fn of_f64(value: f64, bits: usize) -> Self {
        let number = FBig::<HalfEven, 2>::try_from(value).unwrap_or(FBig::ZERO);
        Self(number.with_precision(bits).value())
    }

    /// The number as a fraction.
    pub fn to_fraction(&self) -> Rational {
        let (significand, exponent) = self.0.repr().clone().into_parts();
        let significand = Integer::of_inner(significand);
        match usize::try_from(exponent) {
            Ok(up) => Rational::from_integer(significand << up),
            Err(_) => Rational::new(significand, Integer::from(1) << exponent.unsigned_abs()),
        }
    }

    /// The nearest double.
    pub fn to_f64(&self) -> f64 {
        self.0.to_f64().value()
    }

    /// Number of bits of the significand.
    pub fn bits(&self) -> usize {
        self.0.precision()
    }

    /// Zero of the same precision.
    pub fn zero(bits: usize) -> Self {
        Self::of_integer(&Integer::from(0), bits)
    }

    /// Whether it is zero.
    pub fn is_zero(&self) -> bool {
        self.0.repr().significand().is_zero()
    }

    /// The binary exponent: the absolute value is below `2^exponent` and at least half of that;
    /// `None` for zero.
    pub fn exponent(&self) -> Option<i64> {
        let repr = self.0.repr();
        (!self.is_zero()).then(|| repr.exponent() as i64 + repr.digits() as i64)
    }

    /// The number times a power of two.
    #[must_use]
    pub fn shifted(&self, exponent: i64) -> Self {
        Self(self.0.clone() << exponent as isize)
    }

    /// The absolute value.
    #[must_use]
    pub fn abs(&self) -> Self {
        match self < &Self::zero(self.bits()) {
            true => -self,
            false => self.clone(),
        }
    }

    /// The quotient; anything over zero is zero.
    fn over(&self, divisor: &Self) -> Self {
        match divisor.is_zero() {
            true => Self::zero(self.bits().max(divisor.bits())),
            false => Self(&self.0 / &divisor.0),
        }
    }

    /// The square root; `None` for a negative number.
    pub fn sqrt(&self) -> Option<Self> {
        (self >= &Self::zero(self.bits())).then(|| Self(self.0.sqrt()))
    }

    /// The angle of the point `(x, self)`, from -pi to pi; zero for the origin.
    #[must_use]
    pub fn angle(&self, x: &Self) -> Self {
        match self.is_zero() && x.is_zero() {
            true => Self::zero(self.bits()),
            false => Self(self.0.atan2(&x.0)),
        }
    }
}

impl PartialOrd for BigFloat {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.0.partial_cmp(&other.0)
    }
}

impl Neg for &BigFloat {
    type Output = BigFloat;

    fn neg(self) -> BigFloat {
        BigFloat(-self.0.clone())
    }
}

impl Add for &BigFloat {
    type Output = BigFloat;

    fn add(self, other: Self) -> BigFloat {
        BigFloat(&self.0 + &other.0)
    }
}

impl Sub for &BigFloat {
    type Output = BigFloat;

    fn sub(self, other: Self) -> BigFloat {
        BigFloat(&self.0 - &other.0)
    }
}

impl Mul for &BigFloat {
    type Output = BigFloat;

    fn mul(self, other: Self) -> BigFloat {
        BigFloat(&self.0 * &other.0)
    }
}

/// Division; anything over zero is zero.
impl Div for &BigFloat {
    type Output = BigFloat;

    fn div(self, other: Self) -> BigFloat {
        self.over(other)
    }
}
