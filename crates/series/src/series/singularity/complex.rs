//! Complex numbers of many digits.

use std::ops::{Add, Mul, Sub};

use num_complex::Complex64;

use crate::exact::big_float::BigFloat;

/// A complex number of many digits.
#[derive(Clone, Debug)]
pub(super) struct Complex {
    pub(super) re: BigFloat,
    pub(super) im: BigFloat,
}

impl Complex {
    pub(super) fn from_complex64(value: Complex64, bits: usize) -> Self {
        Self { re: BigFloat::of_f64(value.re, bits), im: BigFloat::of_f64(value.im, bits) }
    }

    pub(super) fn to_f64(&self) -> Complex64 {
        Complex64::new(self.re.to_f64(), self.im.to_f64())
    }

    pub(super) fn squared_size(&self) -> BigFloat {
        &(&self.re * &self.re) + &(&self.im * &self.im)
    }

    /// Distance to another number, as a double.
    pub(super) fn distance(&self, other: &Self) -> f64 {
        (self - other).squared_size().sqrt().map_or(0.0, |size| size.to_f64())
    }

    /// The quotient; zero where the divisor is.
    pub(super) fn divided_by(&self, divisor: &Self) -> Self {
        let size = divisor.squared_size();
        let above = self * &Self { re: divisor.re.clone(), im: -&divisor.im };
        Self { re: &above.re / &size, im: &above.im / &size }
    }
}

impl Add for &Complex {
    type Output = Complex;

    fn add(self, other: Self) -> Complex {
        Complex { re: &self.re + &other.re, im: &self.im + &other.im }
    }
}

impl Sub for &Complex {
    type Output = Complex;

    fn sub(self, other: Self) -> Complex {
        Complex { re: &self.re - &other.re, im: &self.im - &other.im }
    }
}

impl Mul for &Complex {
    type Output = Complex;

    fn mul(self, other: Self) -> Complex {
        Complex {
            re: &(&self.re * &other.re) - &(&self.im * &other.im),
            im: &(&self.re * &other.im) + &(&self.im * &other.re),
        }
    }
}
