//! Exact fractions: reading, printing, roots and the nearest floating-point number.

use num_integer::Integer as _;
use num_traits::{One, Signed, ToPrimitive, Zero};

pub use super::integer::Integer;

/// An exact fraction in lowest terms.
pub type Rational = num_rational::Ratio<Integer>;

/// The fraction `numerator / denominator`, for constants in formulas and tests.
///
/// # Panics
/// If `denominator` is zero.
pub fn ratio(numerator: i64, denominator: i64) -> Rational {
    Rational::new(numerator.into(), denominator.into())
}

/// Returns `left * right`. Common factors are searched only between the numerator of one and the
/// denominator of the other; most often one of them is short.
///
/// Reference: D. E. Knuth, *The Art of Computer Programming*, volume 2, 3rd ed. 1998,
/// section 4.5.1, for this and the sum.
pub(crate) fn product(left: &Rational, right: &Rational) -> Rational {
    let (left_common, right_common) =
        (left.numer().gcd(right.denom()), right.numer().gcd(left.denom()));
    let times = |left: &Integer, left_common: &Integer, right: &Integer, right_common: &Integer| {
        quotient(left, left_common) * quotient(right, right_common)
    };
    Rational::new_raw(
        times(left.numer(), &left_common, right.numer(), &right_common),
        times(left.denom(), &right_common, right.denom(), &left_common),
    )
}

/// Returns `left + right`. A common factor of the numerator and the denominator of the sum divides
/// the greatest common divisor of the two denominators.
pub(crate) fn sum(left: &Rational, right: &Rational) -> Rational {
    if left.is_zero() || right.is_zero() {
        return if left.is_zero() { right.clone() } else { left.clone() };
    }
    let common = left.denom().gcd(right.denom());
    let (own, other) = (quotient(left.denom(), &common), quotient(right.denom(), &common));
    let numerator = left.numer() * &other + right.numer() * &own;
    let shared = numerator.gcd(&common);
    let denominator = own * quotient(right.denom(), &shared);
    Rational::new_raw(quotient(&numerator, &shared), denominator)
}

/// Returns a quotient that is known to be exact.
fn quotient(number: &Integer, divisor: &Integer) -> Integer {
    if divisor.is_one() { number.clone() } else { number / divisor }
}

/// Returns the nearest `f64`; infinite beyond its range.
pub fn to_f64(value: &Rational) -> f64 {
    /// Integers up to this size are doubles, and the quotient of two of them is rounded once.
    const LARGEST_EXACT: u64 = 1 << f64::MANTISSA_DIGITS;
    let exact = |integer: &Integer| {
        let small = integer.to_i64().filter(|small| small.unsigned_abs() <= LARGEST_EXACT);
        small.map(|small| small as f64)
    };
    match (exact(value.numer()), exact(value.denom())) {
        (Some(numerator), Some(denominator)) => numerator / denominator,
        _ => nearest(value),
    }
}

/// The nearest `f64` to a fraction that is not zero, ties to even.
fn nearest(value: &Rational) -> f64 {
    /// The exponent of the last binary digit that a double can have.
    const LOWEST: i64 = f64::MIN_EXP as i64 - f64::MANTISSA_DIGITS as i64;
    let length = |integer: &Integer| i64::try_from(integer.bits()).unwrap_or(i64::MAX / 4);
    // `2^(size - 1) < |value| < 2^(size + 1)`.
    let size = length(value.numer()) - length(value.denom());
    let sign = if value.is_negative() { -1.0 } else { 1.0 };
    if size > i64::from(f64::MAX_EXP) {
        return sign * f64::INFINITY;
    }
    if size < LOWEST - 1 {
        return sign * 0.0;
    }
    // The quotient gets two or three digits more than a mantissa has, or fewer for a subnormal
    // double.
    let last = (size - i64::from(f64::MANTISSA_DIGITS) - 2).max(LOWEST - 2);
    let (numerator, denominator) = match usize::try_from(last) {
        Ok(up) => (value.numer().abs(), value.denom() << up),
        Err(_) => (value.numer().abs() << last.unsigned_abs() as usize, value.denom().clone()),
    };
    let (quotient, remainder) = numerator.div_rem(&denominator);
    // The quotient has at most 56 digits; its last bit also records whether a remainder is left.
    let quotient = quotient.to_u64().unwrap_or(u64::MAX) | u64::from(!remainder.is_zero());
    // Rounded to the digits that the double has there, then scaled without a further rounding.
    let dropped = (i64::from(u64::BITS - quotient.leading_zeros())
        - i64::from(f64::MANTISSA_DIGITS))
    .max(LOWEST - last);
    let unit = 1_u64 << dropped;
    let (kept, rest) = (quotient / unit, quotient % unit);
    let up = rest > unit / 2 || (rest == unit / 2 && kept % 2 == 1);
    let mantissa = (kept + u64::from(up)) as f64;
    let exponent = (last + dropped) as i32;
    // The power is split in two: it may be out of range by itself while the product is not.
    sign * mantissa * 2.0_f64.powi(exponent / 2) * 2.0_f64.powi(exponent - exponent / 2)
}

/// Returns the exact value of a finite double; `None` for infinities and NaN.
pub fn from_f64(value: f64) -> Option<Rational> {
    if !value.is_finite() {
        return None;
    }
    let bits = value.to_bits();
    let (biased, fraction) = ((bits >> 52) & 0x7ff, bits & ((1 << 52) - 1));
    // Subnormal numbers have no leading one, and the exponent of the smallest normal numbers.
    let mantissa = if biased == 0 { fraction } else { fraction | 1 << 52 };
    let exponent = biased.max(1) as i32 - 1075;
    let mantissa = Integer::from(mantissa);
    let size = match usize::try_from(exponent) {
        Ok(up) => Rational::from_integer(mantissa << up),
        Err(_) => Rational::new(mantissa, Integer::one() << exponent.unsigned_abs() as usize),
    };
    Some(if value < 0.0 { -size } else { size })
}

/// Returns the first convergent of the continued fraction of `value` that is within `tolerance` of
/// it: mostly a short fraction.
///
/// ```
/// # use lindstedt_expr as lindstedt;
/// use lindstedt::exact::{convergent, ratio};
///
/// assert_eq!(convergent(&ratio(314_159_265, 100_000_000), &ratio(1, 100)), ratio(22, 7));
/// ```
pub fn convergent(value: &Rational, tolerance: &Rational) -> Rational {
    let (mut before, mut last) =
        ((Integer::zero(), Integer::one()), (Integer::one(), Integer::zero()));
    let mut rest = value.clone();
    loop {
        let whole = rest.floor().to_integer();
        let next = (&whole * &last.0 + &before.0, &whole * &last.1 + &before.1);
        (before, last) = (last, next);
        let found = Rational::new(last.0.clone(), last.1.clone());
        let beyond = &rest - Rational::from_integer(whole);
        if beyond.is_zero() || (&found - value).abs() <= *tolerance {
            return found;
        }
        rest = beyond.recip();
    }
}

/// Returns the exact `p/q`-th power if it is a fraction: `(4/9)^(1/2) = 2/3`.
///
/// With `q` odd the real root of a negative number is taken, as everywhere in this crate. `None` if
/// the result is irrational, not real, a division by zero, or longer than a million bits.
pub fn power(base: &Rational, exponent: &Rational) -> Option<Rational> {
    const LONGEST: u64 = 1 << 20;
    if base.is_one() {
        return Some(Rational::one());
    }
    if base.is_zero() {
        return exponent.is_positive().then(Rational::zero);
    }
    let degree = exponent.denom().to_u32()?;
    let times = exponent.numer().to_i32()?;
    let root = if degree == 1 { base.clone() } else { exact_root(base, degree)? };
    let bits = root.numer().bits().max(root.denom().bits());
    // A base of +-1 never grows, however often it is multiplied.
    if bits > 1 && bits.saturating_mul(u64::from(times.unsigned_abs())) > LONGEST {
        return None;
    }
    Some(num_traits::Pow::pow(root, times))
}

fn exact_root(value: &Rational, degree: u32) -> Option<Rational> {
    if value.is_negative() && degree.is_even() {
        return None;
    }
    let root = |integer: &Integer| {
        if !may_be_power(integer, degree) {
            return None;
        }
        let candidate = integer.nth_root(degree);
        (candidate.pow(degree) == *integer).then_some(candidate)
    };
    Some(Rational::new_raw(root(value.numer())?, root(value.denom())?))
}

/// Whether a number may be a `degree`-th power, by its remainder modulo a prime `p = k degree + 1`
/// (Euler's criterion). Only one in `degree` of all other numbers passes, so for most of them no
/// long root has to be computed to see that there is none.
fn may_be_power(value: &Integer, degree: u32) -> bool {
    const LARGEST: u32 = 64;
    if !(2..=LARGEST).contains(&degree) {
        return true;
    }
    let degree = u64::from(degree);
    let is_prime =
        |number: &u64| (2..).take_while(|d| d * d <= *number).all(|d| !number.is_multiple_of(&d));
    let Some(prime) = (1..).map(|k| k * degree + 1).find(is_prime) else {
        return true;
    };
    let remainder = (value.abs() % Integer::from(prime)).to_u64().unwrap_or(0);
    let power = (0..(prime - 1) / degree).fold(1, |power, _| power * remainder % prime);
    remainder == 0 || power == 1
}

/// The factorial of `n`, exactly.
pub fn factorial(n: u32) -> Integer {
    (1..=n).map(Integer::from).product()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_have_their_roots_and_nothing_else_has() {
        let long = Integer::from(7).pow(60) + Integer::from(11);
        let numbers = (-40..=40).map(Integer::from).chain([long.clone(), -long]);
        for number in numbers.filter(|number| !number.is_zero()) {
            for degree in (2..=70).filter(|degree| !number.is_negative() || degree % 2 == 1) {
                let raised = Rational::from_integer(number.pow(degree));
                assert_eq!(exact_root(&raised, degree), Some(number.clone().into()), "{degree}");
                let beside = &raised + Rational::one();
                let expected = (number.pow(degree) == Integer::from(-1)).then(Rational::zero);
                let expected = expected.or((beside.is_one()).then(Rational::one));
                assert_eq!(exact_root(&beside, degree), expected, "{number}^{degree} + 1");
            }
        }
    }

    #[test]
    fn sums_and_products_are_in_lowest_terms() {
        let numbers = [
            (0, 1),
            (1, 1),
            (-3, 4),
            (5, 6),
            (7, 30),
            (-14, 15),
            (6, 35),
            (49, 12),
            (-5, 6),
            (1, 6),
        ];
        let long = Rational::new(Integer::from(3).pow(90), Integer::from(10).pow(40));
        let mut all: Vec<Rational> = numbers.map(|(n, d)| ratio(n, d)).to_vec();
        all.extend([long.recip(), -&long, long]);
        for left in &all {
            for right in &all {
                for (found, expected) in
                    [(sum(left, right), left + right), (product(left, right), left * right)]
                {
                    assert_eq!(
                        (found.numer(), found.denom()),
                        (expected.numer(), expected.denom()),
                        "{left} {right}"
                    );
                }
            }
        }
    }

    #[test]
    fn powers_are_exact_or_refused() {
        for (base, exponent, expected) in [
            (ratio(4, 9), ratio(1, 2), Some(ratio(2, 3))),
            (ratio(-8, 1), ratio(1, 3), Some(ratio(-2, 1))),
            (ratio(-8, 1), ratio(2, 3), Some(ratio(4, 1))),
            (ratio(2, 1), ratio(-3, 1), Some(ratio(1, 8))),
            (ratio(2, 1), ratio(1, 2), None),
            (ratio(-4, 1), ratio(1, 2), None),
            (ratio(0, 1), ratio(-1, 1), None),
            (ratio(0, 1), ratio(2, 1), Some(ratio(0, 1))),
            (ratio(-1, 1), ratio(1_000_000_001, 1), Some(ratio(-1, 1))),
            (ratio(3, 1), ratio(1_000_000_000, 1), None),
        ] {
            assert_eq!(power(&base, &exponent), expected, "({base})^({exponent})");
        }
    }
}
