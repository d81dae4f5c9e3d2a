//! Several numbers side by side, each computed as alone, so that motions share each instruction.
//!
//! No operation is fused or reordered. What iterates does so a fixed number of times, or a lane that
//! has converged keeps its value: a number is the same to the last bit whatever is beside it.
//!
//! Reference: FDLIBM, Sun Microsystems 1993, for the arcsine.

use std::f64::consts::{FRAC_PI_2, LOG2_E};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// `L` numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::impact) struct Lanes<const L: usize>(pub [f64; L]);

/// A choice for each of `L` lanes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::impact) struct Mask<const L: usize>(pub [bool; L]);

macro_rules! operator {
    ($trait:ident, $name:ident, $sign:tt, $assign:tt) => {
        impl<const L: usize> $trait for Lanes<L> {
            type Output = Self;

            #[inline(always)]
            fn $name(mut self, other: Self) -> Self {
                for lane in 0..L {
                    self.0[lane] $assign other.0[lane];
                }
                self
            }
        }

        impl<const L: usize> $trait<Lanes<L>> for f64 {
            type Output = Lanes<L>;

            #[inline(always)]
            fn $name(self, other: Lanes<L>) -> Lanes<L> {
                Lanes([self; L]) $sign other
            }
        }

        impl<const L: usize> $trait<f64> for Lanes<L> {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: f64) -> Self {
                self $sign Self([other; L])
            }
        }
    };
}

operator!(Add, add, +, +=);
operator!(Sub, sub, -, -=);
operator!(Mul, mul, *, *=);
operator!(Div, div, /, /=);

impl<const L: usize> Neg for Lanes<L> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|value| -value)
    }
}

impl<const L: usize> Lanes<L> {
    /// One number in every lane.
    #[inline(always)]
    pub fn all(value: f64) -> Self {
        Self([value; L])
    }

    /// A function of each number.
    #[inline(always)]
    fn map(mut self, function: impl Fn(f64) -> f64) -> Self {
        for lane in 0..L {
            self.0[lane] = function(self.0[lane]);
        }
        self
    }

    /// The square roots.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }

    /// The absolute values.
    #[inline(always)]
    pub fn abs(self) -> Self {
        self.map(f64::abs)
    }

    /// The numbers with the signs of others.
    #[inline(always)]
    pub fn with_sign_of(mut self, other: Self) -> Self {
        for lane in 0..L {
            self.0[lane] = self.0[lane].copysign(other.0[lane]);
        }
        self
    }

    /// The numbers, or this one where it is greater or a number is NaN.
    #[inline(always)]
    pub fn at_least(self, least: f64) -> Self {
        self.map(|value| if value > least { value } else { least })
    }

    /// The numbers, or this one where it is less or a number is NaN.
    #[inline(always)]
    pub fn at_most(self, most: f64) -> Self {
        self.map(|value| if value < most { value } else { most })
    }

    /// The lanes in which a number is greater than another.
    #[inline(always)]
    pub fn is_above(self, other: Self) -> Mask<L> {
        let mut mask = Mask([false; L]);
        for lane in 0..L {
            mask.0[lane] = self.0[lane] > other.0[lane];
        }
        mask
    }

    /// The lanes in which a number is this one or greater.
    #[inline(always)]
    pub fn is_at_least(self, least: f64) -> Mask<L> {
        let mut mask = Mask([false; L]);
        for lane in 0..L {
            mask.0[lane] = self.0[lane] >= least;
        }
        mask
    }

    /// The polynomial with these coefficients, that of the highest power first.
    #[inline(always)]
    pub fn polynomial<const N: usize>(self, coefficients: [f64; N]) -> Self {
        let mut sum = Self::all(coefficients[0]);
        for coefficient in &coefficients[1..] {
            sum = sum * self + *coefficient;
        }
        sum
    }

    /// e^y - 1 for |y| < 700, to two units in the last place.
    #[inline(always)]
    pub fn exp_m1(self) -> Self {
        const ROUND: f64 = 6_755_399_441_055_744.0;
        const LN_2_HIGH: f64 = 0.693_147_180_369_123_8;
        const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;
        let shifted = self * LOG2_E + ROUND;
        let count = shifted - ROUND;
        let rest = self - count * LN_2_HIGH - count * LN_2_LOW;
        // The Taylor series, |rest| < 0.35: the first term left out is 2e-17 of the first.
        let series = rest.polynomial([
            1.0 / 6_227_020_800.0,
            1.0 / 479_001_600.0,
            1.0 / 39_916_800.0,
            1.0 / 3_628_800.0,
            1.0 / 362_880.0,
            1.0 / 40_320.0,
            1.0 / 5_040.0,
            1.0 / 720.0,
            1.0 / 120.0,
            1.0 / 24.0,
            1.0 / 6.0,
            0.5,
        ]);
        let small = rest + rest * rest * series;
        let mut power = Self::all(0.0);
        for lane in 0..L {
            // The exponent of 2^count: count stands in the last bits of `shifted`.
            power.0[lane] =
                f64::from_bits((shifted.0[lane].to_bits() << 52).wrapping_add(1.0_f64.to_bits()));
        }
        power * small + (power - 1.0)
    }

    /// The angle in [-pi/2, pi/2] with this sine, to two units in the last place.
    #[inline(always)]
    pub fn asin(self) -> Self {
        // (asin x - x)/x^3 for |x| < 1/2 (FDLIBM, e_asin.c).
        let ratio = |square: Self| {
            let above = square.polynomial([
                3.479_331_075_960_212e-5,
                7.915_349_942_898_145e-4,
                -4.005_553_450_067_941e-2,
                2.012_125_321_348_629_3e-1,
                -3.255_658_186_224_009e-1,
                1.666_666_666_666_666_6e-1,
            ]);
            let below = square.polynomial([
                7.703_815_055_590_194e-2,
                -6.882_839_716_054_533e-1,
                2.020_945_760_233_505_7,
                -2.403_394_911_734_414,
                1.0,
            ]);
            square * above / below
        };
        let size = self.abs();
        let half = 0.5 * (1.0 - size);
        let root = half.sqrt();
        let near = self + self * ratio(self * self);
        let far = FRAC_PI_2 - 2.0 * (root + root * ratio(half));
        size.is_above(Self::all(0.5)).select(far.with_sign_of(self), near)
    }

    /// The fifth root of a positive number, to 1e-4.
    #[inline(always)]
    pub fn fifth_root(self) -> Self {
        let mut root = Self::all(0.0);
        for lane in 0..L {
            // A fifth of the logarithm, by the exponent: good to 5 %.
            let bits = (self.0[lane].to_bits() >> 32) / 5 + 0x3326_0000;
            root.0[lane] = f64::from_bits(bits << 32);
        }
        for _ in 0..2 {
            let square = root * root;
            root = 0.2 * (4.0 * root + self / (square * square));
        }
        root
    }
}

impl<const L: usize> Mask<L> {
    /// Numbers of the first list where the choice is true, of the second elsewhere.
    #[inline(always)]
    pub fn select(self, yes: Lanes<L>, no: Lanes<L>) -> Lanes<L> {
        let mut chosen = no;
        for lane in 0..L {
            chosen.0[lane] = if self.0[lane] { yes.0[lane] } else { no.0[lane] };
        }
        chosen
    }

    /// Whether any lane is chosen.
    #[inline(always)]
    pub fn any(self) -> bool {
        let mut any = false;
        for lane in 0..L {
            any |= self.0[lane];
        }
        any
    }

    /// The lanes chosen by both.
    #[inline(always)]
    pub fn and(mut self, other: Self) -> Self {
        for lane in 0..L {
            self.0[lane] &= other.0[lane];
        }
        self
    }

    /// The lanes chosen by either.
    #[inline(always)]
    pub fn or(mut self, other: Self) -> Self {
        for lane in 0..L {
            self.0[lane] |= other.0[lane];
        }
        self
    }

    /// The lanes not chosen.
    #[inline(always)]
    pub fn not(mut self) -> Self {
        for lane in 0..L {
            self.0[lane] = !self.0[lane];
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(value: f64, function: impl Fn(Lanes<1>) -> Lanes<1>) -> f64 {
        function(Lanes([value])).0[0]
    }

    #[test]
    fn functions_are_those_of_the_library_to_the_last_digits() {
        let close = |one: f64, other: f64| (one - other).abs() <= 5e-16 * other.abs();
        for index in -1000..=1000 {
            let x = f64::from(index) / 1000.0;
            assert!(close(of(x, Lanes::asin), x.asin()), "asin {x}");
            let wide = x * x * x * 700.0;
            assert!(close(of(wide, Lanes::exp_m1), wide.exp_m1()), "exp_m1 {wide}");
            let positive = (wide * 0.9).exp();
            let root = of(positive, Lanes::fifth_root) / positive.powf(0.2);
            assert!((root - 1.0).abs() < 1e-4, "root {positive}: {root}");
        }
        assert_eq!(of(1e-300, Lanes::exp_m1), 1e-300);
        assert_eq!(of(1e-300, Lanes::asin), 1e-300);
    }

    #[test]
    fn a_lane_does_not_depend_on_the_others() {
        let values = [0.3, -0.9, 1e-9, 0.51, -0.5, 0.0, 1.0, 0.7];
        let together = [Lanes(values).asin(), Lanes(values).exp_m1()];
        for (lane, value) in values.into_iter().enumerate() {
            let alone = [of(value, Lanes::asin), of(value, Lanes::exp_m1)];
            assert_eq!(together.map(|lanes| lanes.0[lane]), alone);
        }
    }
}
