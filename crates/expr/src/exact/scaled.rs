//! Floating-point numbers with an exponent of their own: products of powers far beyond the range of
//! doubles keep their digits.

use num_traits::ToPrimitive;

use super::{Integer, Rational};

/// `mantissa * 2^exponent`, the mantissa zero or of a size between 1 and 2.
#[derive(Clone, Copy, Debug)]
pub struct Scaled {
    /// Zero, of a size between 1 and 2, or not finite.
    pub mantissa: f64,
    /// The power of two.
    pub exponent: i64,
}

impl Scaled {
    /// Returns the number equal to a double.
    pub fn new(value: f64) -> Self {
        // Subnormal numbers have no exponent of their own.
        let (value, shift) = if value.abs() < f64::MIN_POSITIVE {
            (value * 2.0_f64.powi(100), 100)
        } else {
            (value, 0)
        };
        if value == 0.0 || !value.is_finite() {
            return Self { mantissa: value, exponent: 0 };
        }
        let exponent = ((value.to_bits() >> 52) & 0x7ff) as i64 - 1023;
        Self { mantissa: value / 2.0_f64.powi(exponent as i32), exponent: exponent - shift }
    }

    /// The nearest number to a fraction, however large or small.
    pub fn of_fraction(value: &Rational) -> Self {
        /// More bits than a mantissa has, so that the quotient of the integers is rounded once.
        const BITS: i64 = 64;
        let length = |integer: &Integer| i64::try_from(integer.bits()).unwrap_or(i64::MAX / 4);
        let shift = BITS + length(value.denom()) - length(value.numer());
        let shifted = match usize::try_from(shift) {
            Ok(up) => (value.numer() << up) / value.denom(),
            Err(_) => value.numer() / (value.denom() << shift.unsigned_abs() as usize),
        };
        let rounded = Self::new(shifted.to_f64().unwrap_or(f64::NAN));
        Self {
            exponent: if rounded.mantissa == 0.0 { 0 } else { rounded.exponent - shift },
            ..rounded
        }
    }

    /// Returns the sum as a double, infinite or zero if it is beyond their range.
    pub fn sum(terms: &[Self]) -> f64 {
        let used = terms.iter().filter(|term| term.mantissa != 0.0);
        let unit = used.map(|term| term.exponent).max().unwrap_or(0);
        let mantissa = terms.iter().map(|term| term.in_units(unit)).sum();
        Self { mantissa, exponent: unit }.in_units(0)
    }

    /// The product, rounded.
    pub fn product(self, other: Self) -> Self {
        let product = Self::new(self.mantissa * other.mantissa);
        Self { exponent: product.exponent + self.exponent + other.exponent, ..product }
    }

    /// A whole power, of either sign.
    pub fn power(self, exponent: i32) -> Self {
        let base = if exponent < 0 { self.inverse() } else { self };
        let (mut result, mut square, mut left) = (Self::new(1.0), base, exponent.unsigned_abs());
        while left > 0 {
            if left % 2 == 1 {
                result = result.product(square);
            }
            square = square.product(square);
            left /= 2;
        }
        result
    }

    /// One over the number.
    pub fn inverse(self) -> Self {
        let inverse = Self::new(1.0 / self.mantissa);
        Self { exponent: inverse.exponent - self.exponent, ..inverse }
    }

    /// Returns the number in units of `2^unit`, as a double.
    pub fn in_units(self, unit: i64) -> f64 {
        if self.mantissa == 0.0 {
            return 0.0;
        }
        let exponent = (self.exponent - unit).clamp(-2200, 2200) as i32;
        // The power is split in two: it may underflow by itself while the product does not.
        self.mantissa * 2.0_f64.powi(exponent / 2) * 2.0_f64.powi(exponent - exponent / 2)
    }

    /// The natural logarithm of the absolute value.
    pub fn logarithm(self) -> f64 {
        self.mantissa.abs().ln() + self.exponent as f64 * std::f64::consts::LN_2
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::rational::{ratio, to_f64};

    #[test]
    fn numbers_beyond_the_range_of_doubles_keep_their_digits() {
        let huge = Scaled::new(1.7e300).power(40).product(Scaled::new(3.1e-310));
        let expected = 40.0 * 1.7e300_f64.ln() + (3.1_f64.ln() - 310.0 * 10.0_f64.ln());
        assert!((huge.logarithm() / expected - 1.0).abs() < 1e-14);
        assert_eq!(Scaled::new(-0.75).power(3).in_units(0), -0.421875);
        assert_eq!(Scaled::new(0.0).in_units(5), 0.0);
        assert_eq!(Scaled::new(8.0).power(-2).in_units(0), 1.0 / 64.0);
    }

    #[test]
    fn fractions_of_any_size_are_rounded_once() {
        for (p, q) in [(1, 3), (-22, 7), (1, 1), (i64::MAX, 3), (-1, i64::MAX), (0, 1)] {
            assert_eq!(Scaled::of_fraction(&ratio(p, q)).in_units(0), to_f64(&ratio(p, q)));
        }
        let huge = Rational::from_integer(Integer::from(10).pow(900)) / ratio(7, 1);
        let expected = 900.0 * 10.0_f64.ln() - 7.0_f64.ln();
        assert!((Scaled::of_fraction(&huge).logarithm() / expected - 1.0).abs() < 1e-15);
        assert!((Scaled::of_fraction(&huge.recip()).logarithm() / -expected - 1.0).abs() < 1e-15);
        let difference =
            [Scaled::of_fraction(&huge), Scaled::of_fraction(&-huge), Scaled::new(0.0)];
        assert_eq!(Scaled::sum(&difference), 0.0);
        assert_eq!(Scaled::sum(&[Scaled::new(1e300).power(2), Scaled::new(1.0)]), f64::INFINITY);
    }
}
