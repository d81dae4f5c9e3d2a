//! Fractions of two machine words, and the arithmetic of common divisors that they and
//! [short series](super) need.

/// Bound of numerators and of all intermediate sums. It is half of what fits, which leaves room for
/// rounding errors in the estimates of the sizes.
pub(super) const BOUND: f64 = (1_u128 << 126) as f64;

/// A fraction in lowest terms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShortFraction {
    numerator: i128,
    denominator: i128,
}

impl ShortFraction {
    /// The number zero.
    pub const ZERO: Self = Self { numerator: 0, denominator: 1 };
    /// The number one.
    pub const ONE: Self = Self { numerator: 1, denominator: 1 };

    /// The fraction with this numerator and this positive denominator, which need not be in lowest
    /// terms; `None` if they are too long.
    pub fn new(numerator: i128, denominator: i128) -> Option<Self> {
        if denominator <= 0 || size(numerator.unsigned_abs()) >= BOUND {
            return None;
        }
        let common = greatest_common_divisor(denominator, numerator);
        let [numerator, denominator] =
            [numerator, denominator].map(|number| exact_quotient(number, common));
        Some(Self { numerator, denominator })
    }

    /// The numerator.
    pub fn numerator(self) -> i128 {
        self.numerator
    }

    /// The denominator, positive.
    pub fn denominator(self) -> i128 {
        self.denominator
    }

    /// Whether it is zero.
    pub fn is_zero(self) -> bool {
        self.numerator == 0
    }

    /// The negative number.
    pub fn negative(self) -> Self {
        Self { numerator: -self.numerator, ..self }
    }

    /// The least common denominator of some fractions, and their numerators over it; `None` if a
    /// number is too long.
    pub fn over_common_denominator(fractions: &[Self]) -> Option<(i128, Vec<i128>)> {
        let lengthened =
            |common, fraction: &Self| least_common_multiple(common, fraction.denominator);
        let common = fractions.iter().try_fold(1, lengthened)?;
        let numerators = fractions.iter().map(|fraction| {
            product(fraction.numerator, exact_quotient(common, fraction.denominator))
        });
        Some((common, numerators.collect::<Option<_>>()?))
    }

    /// Half of the number; `None` if it is too long.
    pub fn half(self) -> Option<Self> {
        // The other part is odd or keeps its factors of two, so the result is in lowest terms.
        match self.numerator & 1 {
            0 => Some(Self { numerator: self.numerator >> 1, ..self }),
            _ => Some(Self { denominator: product(self.denominator, 2)?, ..self }),
        }
    }

    /// The product; `None` if it is too long.
    pub fn product(self, other: Self) -> Option<Self> {
        let numerator = product(self.numerator, other.numerator)?;
        Self::new(numerator, product(self.denominator, other.denominator)?)
    }

    /// The quotient; `None` if it is too long, or the divisor is zero.
    pub fn quotient(self, divisor: Self) -> Option<Self> {
        let numerator = self.numerator.checked_mul(divisor.denominator)?;
        let denominator = self.denominator.checked_mul(divisor.numerator.abs())?;
        Self::new(numerator.checked_mul(divisor.numerator.signum())?, denominator)
    }

    /// The sum; `None` if it is too long.
    pub fn sum(self, other: Self) -> Option<Self> {
        let common = least_common_multiple(self.denominator, other.denominator)?;
        let [own, other] = [self, other].map(|fraction| {
            product(fraction.numerator, exact_quotient(common, fraction.denominator))
        });
        Self::new(own?.checked_add(other?)?, common)
    }
}

/// The number as a double, or a little more; most numbers fit one word, whose conversion is a single
/// instruction.
#[inline]
pub(super) fn size(number: u128) -> f64 {
    const WORD: f64 = (1_u128 << 64) as f64;
    let high = (number >> 64) as u64;
    let above = if high > 0 { high as f64 + 1.0 } else { return number as u64 as f64 };
    above * WORD
}

/// The least power of two that is not below a number. As a bound of a factor it is at hand at once,
/// and it is the factor itself where denominators are powers of two.
#[inline]
pub(super) fn power_of_two_above(number: u128) -> f64 {
    let digits = u128::BITS - number.saturating_sub(1).leading_zeros();
    f64::from_bits((1023 + u64::from(digits)) << 52)
}

/// Whether a positive number is a power of two.
#[inline]
fn is_power_of_two(number: i128) -> bool {
    number & (number - 1) == 0
}

/// Returns a quotient without remainder by a positive divisor. Most divisors are powers of two.
#[inline]
pub(super) fn exact_quotient(number: i128, divisor: i128) -> i128 {
    match is_power_of_two(divisor) {
        true => number >> divisor.trailing_zeros(),
        false => quotient(number, divisor),
    }
}

/// The product; `None` if it is too long. Most numbers fit one word, whose product always fits.
#[inline]
pub(super) fn product(left: i128, right: i128) -> Option<i128> {
    match (i64::try_from(left), i64::try_from(right)) {
        (Ok(left), Ok(right)) => Some(i128::from(left).wrapping_mul(i128::from(right))),
        _ => left.checked_mul(right),
    }
}

/// Returns a quotient; most numbers fit one word.
pub(super) fn quotient(number: i128, divisor: i128) -> i128 {
    match (i64::try_from(number), i64::try_from(divisor)) {
        (Ok(number), Ok(divisor)) => i128::from(number / divisor),
        _ => number / divisor,
    }
}

/// Greatest common divisor of a positive number and any other.
pub(super) fn greatest_common_divisor(left: i128, right: i128) -> i128 {
    if is_power_of_two(left) {
        return 1 << left.trailing_zeros().min(right.trailing_zeros());
    }
    // Often one number divides the other, and a single division tells it.
    let rest = match (u64::try_from(left), u64::try_from(right.unsigned_abs())) {
        (Ok(left), Ok(right)) => i128::from(right % left),
        _ => (right % left).abs(),
    };
    if rest == 0 {
        return left;
    }
    let (left, rest) = (left.unsigned_abs(), rest.unsigned_abs());
    let halvings = (left | rest).trailing_zeros();
    (common_odd_divisor(left >> left.trailing_zeros(), rest >> rest.trailing_zeros()) << halvings)
        as i128
}

/// Greatest common divisor of two odd numbers. No branch but the end of a loop depends on them,
/// because nothing could foretell it.
fn common_odd_divisor(mut smaller: u128, mut other: u128) -> u128 {
    while smaller != other {
        if let (Ok(mut smaller), Ok(mut other)) = (u64::try_from(smaller), u64::try_from(other)) {
            while smaller != other {
                let difference = smaller.abs_diff(other);
                smaller = smaller.min(other);
                other = difference >> difference.trailing_zeros();
            }
            return smaller.into();
        }
        let difference = smaller.abs_diff(other);
        smaller = smaller.min(other);
        other = difference >> difference.trailing_zeros();
    }
    smaller
}

/// Least common multiple of positive numbers.
#[inline]
pub(super) fn least_common_multiple(left: i128, right: i128) -> Option<i128> {
    // One of the two mostly, and always among powers of two.
    if left == right || right == 1 {
        return Some(left);
    }
    if left == 1 || (is_power_of_two(left) && is_power_of_two(right)) {
        return Some(left.max(right));
    }
    lengthened(left, right)
}

/// [`least_common_multiple`] of any numbers.
fn lengthened(left: i128, right: i128) -> Option<i128> {
    // Mostly one is a multiple of the other, and a single division tells it.
    let (larger, smaller) = (left.max(right), left.min(right));
    let rest = match (u64::try_from(larger), u64::try_from(smaller)) {
        (Ok(larger), Ok(smaller)) => i128::from(larger % smaller),
        _ => larger % smaller,
    };
    match rest {
        0 => Some(larger),
        _ => exact_quotient(larger, greatest_common_divisor(smaller, rest)).checked_mul(smaller),
    }
}

#[cfg(test)]
mod tests {
    use num_integer::Integer as _;

    use super::*;
    use crate::exact::{Integer, Rational};

    #[test]
    fn common_divisors_are_those_of_any_length() {
        let wide = 3_i128.pow(50);
        let numbers =
            [1, 2, 3, 12, 35, 96, 1 << 40, (1 << 61) - 1, 3_i128.pow(39), wide, 10 * wide];
        for left in numbers {
            for right in numbers.into_iter().chain([0, 7 << 100]) {
                for right in [right, -right] {
                    let found = greatest_common_divisor(left, right);
                    assert_eq!(found, left.gcd(&right), "{left} {right}");
                }
            }
        }
    }

    #[test]
    fn short_fractions_are_those_of_any_length() {
        let long = |own: ShortFraction| Rational::new(own.numerator.into(), own.denominator.into());
        let wide = (1_i128 << 70) + 3;
        let numbers =
            [(0, 5), (1, 1), (-6, 4), (35, 12), (7 << 66, 96), (wide, 3 * wide), (-9, wide)];
        let fractions = numbers.map(|(numerator, denominator)| {
            let own = ShortFraction::new(numerator, denominator).expect("short");
            assert_eq!(long(own), Rational::new(numerator.into(), denominator.into()));
            assert_eq!(Integer::from(own.denominator()), *long(own).denom());
            assert_eq!(Integer::from(own.numerator()), *long(own).numer());
            assert_eq!(long(own.negative()), -long(own));
            own
        });
        for left in fractions {
            for right in fractions {
                let check = |found: Option<ShortFraction>, expected: Rational| match found {
                    Some(found) => assert_eq!(long(found), expected),
                    None => assert!(expected.numer().bits() + expected.denom().bits() > 126),
                };
                check(left.sum(right), long(left) + long(right));
                check(left.product(right), long(left) * long(right));
                match right.is_zero() {
                    true => assert_eq!(left.quotient(right), None),
                    false => check(left.quotient(right), long(left) / long(right)),
                }
            }
        }
        assert_eq!(ShortFraction::new(1, 0), None);
        assert_eq!(ShortFraction::new(i128::MIN, 3), None);
    }
}
