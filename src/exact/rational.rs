//! Exact fractions: reading, printing, roots and the nearest floating-point number.

use num_bigint::BigInt;
use num_integer::Integer as _;
use num_traits::{One, Signed, ToPrimitive, Zero};

/// An exact fraction in lowest terms.
pub type Rational = num_rational::BigRational;

/// An integer of any length.
pub type Integer = BigInt;

/// The fraction `numerator / denominator`, for constants in formulas and tests.
///
/// # Panics
/// If `denominator` is zero.
pub fn ratio(numerator: i64, denominator: i64) -> Rational {
    Rational::new(numerator.into(), denominator.into())
}

/// The nearest `f64`; infinite when it is out of range.
pub fn to_f64(value: &Rational) -> f64 {
    value.to_f64().unwrap_or(f64::NAN)
}

/// The exact `p/q`-th power, where one exists among the fractions: `(4/9)^(1/2) = 2/3`.
///
/// With `q` odd the real root of a negative number is taken, as everywhere in this crate. `None` where the result is
/// irrational, not real, a division by zero, or longer than a million bits.
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
    let root = if degree == 1 {
        base.clone()
    } else {
        exact_root(base, degree)?
    };
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
        let candidate = integer.nth_root(degree);
        (candidate.pow(degree) == *integer).then_some(candidate)
    };
    Some(Rational::new_raw(root(value.numer())?, root(value.denom())?))
}

/// The factorial of `n`, exactly.
pub fn factorial(n: u32) -> Integer {
    (1..=n).map(Integer::from).product()
}

#[cfg(test)]
mod tests {
    use super::*;

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
