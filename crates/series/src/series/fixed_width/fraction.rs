//! Integers of one machine word or two, fractions of them, and the arithmetic of common divisors that
//! they and [short series](super) need.

use std::fmt::Debug;

use num_traits::{PrimInt, Signed, WrappingAdd, WrappingMul, WrappingNeg, WrappingSub};

use crate::exact::Integer;

/// A signed integer of one machine word or two.
///
/// The arithmetic of a series is the same in both; one word takes less time and holds fewer orders.
pub trait FixedWidth:
    PrimInt
    + Signed
    + WrappingAdd
    + WrappingSub
    + WrappingMul
    + WrappingNeg
    + Into<Integer>
    + Into<i128>
    + Debug
{
    /// Bound of numerators and of all intermediate sums. It is half of what fits, which leaves room
    /// for rounding errors in the estimates of the sizes.
    const BOUND: f64;
    /// Whether it has more than one machine word.
    const IS_WIDE: bool;

    /// The absolute value as a double, or a little more.
    fn size(self) -> f64;

    /// A bound of the absolute value that is at hand at once.
    fn bound(self) -> f64;

    /// The product; `None` if it is too long.
    fn product(self, other: Self) -> Option<Self>;

    /// The product of two numbers that fit one word.
    fn product_of_words(self, other: Self) -> Self;

    /// The product of a number that fits one word and any other.
    fn word_times(self, other: Self) -> Self;

    /// The quotient, rounded towards zero, by a divisor that is positive.
    fn quotient(self, divisor: Self) -> Self;

    /// The absolute value of the remainder of a division by a positive number.
    fn remainder(self, divisor: Self) -> Self;

    /// Greatest common divisor of two odd positive numbers.
    fn common_odd_divisor(self, other: Self) -> Self;
}

impl FixedWidth for i64 {
    const BOUND: f64 = (1_u64 << 62) as f64;
    const IS_WIDE: bool = false;

    #[inline]
    fn size(self) -> f64 {
        (self as f64).abs()
    }

    #[inline]
    fn bound(self) -> f64 {
        self.size()
    }

    #[inline]
    fn product(self, other: Self) -> Option<Self> {
        self.checked_mul(other)
    }

    #[inline]
    fn product_of_words(self, other: Self) -> Self {
        self.wrapping_mul(other)
    }

    #[inline]
    fn word_times(self, other: Self) -> Self {
        self.wrapping_mul(other)
    }

    #[inline]
    fn quotient(self, divisor: Self) -> Self {
        self / divisor
    }

    #[inline]
    fn remainder(self, divisor: Self) -> Self {
        (self % divisor).abs()
    }

    #[inline]
    fn common_odd_divisor(self, other: Self) -> Self {
        common_odd_divisor(self.unsigned_abs(), other.unsigned_abs()) as Self
    }
}

impl FixedWidth for i128 {
    const BOUND: f64 = (1_u128 << 126) as f64;
    const IS_WIDE: bool = true;

    /// Most numbers fit one word, whose conversion is a single instruction.
    #[inline]
    fn size(self) -> f64 {
        const WORD: f64 = (1_u128 << 64) as f64;
        let number = self.unsigned_abs();
        let high = (number >> 64) as u64;
        let above = if high > 0 { high as f64 + 1.0 } else { return number as u64 as f64 };
        above * WORD
    }

    /// The least power of two that is not below the number, and the number itself where denominators
    /// are powers of two.
    #[inline]
    fn bound(self) -> f64 {
        let digits = u128::BITS - self.unsigned_abs().saturating_sub(1).leading_zeros();
        f64::from_bits((1023 + u64::from(digits)) << 52)
    }

    /// Most numbers fit one word, whose product always fits.
    #[inline]
    fn product(self, other: Self) -> Option<Self> {
        match (i64::try_from(self), i64::try_from(other)) {
            (Ok(left), Ok(right)) => Some(Self::from(left).wrapping_mul(Self::from(right))),
            _ => self.checked_mul(other),
        }
    }

    #[inline]
    fn product_of_words(self, other: Self) -> Self {
        Self::from(self as i64).wrapping_mul(Self::from(other as i64))
    }

    #[inline]
    fn word_times(self, other: Self) -> Self {
        Self::from(self as i64).wrapping_mul(other)
    }

    /// Most numbers fit one word.
    fn quotient(self, divisor: Self) -> Self {
        match (i64::try_from(self), i64::try_from(divisor)) {
            (Ok(number), Ok(divisor)) => (number / divisor).into(),
            _ => self / divisor,
        }
    }

    /// Most numbers fit one word.
    fn remainder(self, divisor: Self) -> Self {
        match (u64::try_from(divisor), u64::try_from(self.unsigned_abs())) {
            (Ok(divisor), Ok(number)) => (number % divisor).into(),
            _ => (self % divisor).abs(),
        }
    }

    fn common_odd_divisor(self, other: Self) -> Self {
        let (mut smaller, mut other) = (self.unsigned_abs(), other.unsigned_abs());
        while smaller != other {
            if let (Ok(smaller), Ok(other)) = (u64::try_from(smaller), u64::try_from(other)) {
                return common_odd_divisor(smaller, other).into();
            }
            let difference = smaller.abs_diff(other);
            smaller = smaller.min(other);
            other = difference >> difference.trailing_zeros();
        }
        smaller as Self
    }
}

/// Greatest common divisor of two odd numbers. No branch but the end of the loop depends on them,
/// because nothing could foretell it.
#[inline]
fn common_odd_divisor(mut smaller: u64, mut other: u64) -> u64 {
    while smaller != other {
        let difference = smaller.abs_diff(other);
        smaller = smaller.min(other);
        other = difference >> difference.trailing_zeros();
    }
    smaller
}

/// A fraction in lowest terms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShortFraction<W = i128> {
    numerator: W,
    denominator: W,
}

impl<W: FixedWidth> ShortFraction<W> {
    /// The number zero.
    pub fn zero() -> Self {
        Self { numerator: W::zero(), denominator: W::one() }
    }

    /// The number one.
    pub fn one() -> Self {
        Self { numerator: W::one(), denominator: W::one() }
    }

    /// The fraction with this numerator and this positive denominator, which need not be in lowest
    /// terms; `None` if they are too long.
    pub fn new(numerator: W, denominator: W) -> Option<Self> {
        if denominator <= W::zero() || numerator.size() >= W::BOUND {
            return None;
        }
        let common = greatest_common_divisor(denominator, numerator);
        let [numerator, denominator] =
            [numerator, denominator].map(|number| exact_quotient(number, common));
        Some(Self { numerator, denominator })
    }

    /// The numerator.
    pub fn numerator(self) -> W {
        self.numerator
    }

    /// The denominator, positive.
    pub fn denominator(self) -> W {
        self.denominator
    }

    /// Whether it is zero.
    pub fn is_zero(self) -> bool {
        self.numerator.is_zero()
    }

    /// The negative number.
    pub fn negative(self) -> Self {
        Self { numerator: -self.numerator, ..self }
    }

    /// The least common denominator of some fractions, and their numerators over it; `None` if a
    /// number is too long.
    pub fn over_common_denominator(fractions: &[Self]) -> Option<(W, Vec<W>)> {
        let lengthened =
            |common, fraction: &Self| least_common_multiple(common, fraction.denominator);
        let common = fractions.iter().try_fold(W::one(), lengthened)?;
        let numerators = fractions.iter().map(|fraction| {
            fraction.numerator.product(exact_quotient(common, fraction.denominator))
        });
        Some((common, numerators.collect::<Option<_>>()?))
    }

    /// Half of the number; `None` if it is too long.
    pub fn half(self) -> Option<Self> {
        // The other part is odd or keeps its factors of two, so the result is in lowest terms.
        match (self.numerator & W::one()).is_zero() {
            true => Some(Self { numerator: self.numerator >> 1, ..self }),
            false => Some(Self { denominator: self.denominator.product(twice(W::one()))?, ..self }),
        }
    }

    /// The product; `None` if it is too long.
    pub fn product(self, other: Self) -> Option<Self> {
        let numerator = self.numerator.product(other.numerator)?;
        Self::new(numerator, self.denominator.product(other.denominator)?)
    }

    /// The quotient; `None` if it is too long, or the divisor is zero.
    pub fn quotient(self, divisor: Self) -> Option<Self> {
        let numerator = self.numerator.product(divisor.denominator)?;
        let denominator = self.denominator.product(divisor.numerator.abs())?;
        Self::new(numerator.product(divisor.numerator.signum())?, denominator)
    }

    /// The sum; `None` if it is too long.
    pub fn sum(self, other: Self) -> Option<Self> {
        let common = least_common_multiple(self.denominator, other.denominator)?;
        let [own, other] = [self, other].map(|fraction| {
            fraction.numerator.product(exact_quotient(common, fraction.denominator))
        });
        Self::new(own?.checked_add(&other?)?, common)
    }
}

impl ShortFraction<i64> {
    /// The same number in two words.
    pub fn widened(self) -> ShortFraction {
        ShortFraction { numerator: self.numerator.into(), denominator: self.denominator.into() }
    }
}

/// Twice a number far below the bound.
#[inline]
pub(super) fn twice<W: FixedWidth>(number: W) -> W {
    number.wrapping_add(&number)
}

/// Whether a positive number is a power of two.
#[inline]
fn is_power_of_two<W: FixedWidth>(number: W) -> bool {
    (number & (number - W::one())).is_zero()
}

/// Returns a quotient without remainder by a positive divisor. Most divisors are powers of two.
#[inline]
pub(super) fn exact_quotient<W: FixedWidth>(number: W, divisor: W) -> W {
    match is_power_of_two(divisor) {
        true => number >> divisor.trailing_zeros() as usize,
        false => number.quotient(divisor),
    }
}

/// Greatest common divisor of a positive number and any other.
#[inline]
pub(super) fn greatest_common_divisor<W: FixedWidth>(left: W, right: W) -> W {
    match is_power_of_two(left) {
        true => W::one() << left.trailing_zeros().min(right.trailing_zeros()) as usize,
        false => common_divisor(left, right),
    }
}

/// [`greatest_common_divisor`] of any numbers.
fn common_divisor<W: FixedWidth>(left: W, right: W) -> W {
    // Often one number divides the other, and a single division tells it.
    let rest = right.remainder(left);
    if rest.is_zero() {
        return left;
    }
    let odd = |number: W| number >> number.trailing_zeros() as usize;
    odd(left).common_odd_divisor(odd(rest)) << (left | rest).trailing_zeros() as usize
}

/// Least common multiple of positive numbers.
#[inline]
pub(super) fn least_common_multiple<W: FixedWidth>(left: W, right: W) -> Option<W> {
    // One of the two mostly, and always among powers of two.
    if left == right || right.is_one() {
        return Some(left);
    }
    if left.is_one() || (is_power_of_two(left) && is_power_of_two(right)) {
        return Some(left.max(right));
    }
    lengthened(left, right)
}

/// [`least_common_multiple`] of any numbers.
fn lengthened<W: FixedWidth>(left: W, right: W) -> Option<W> {
    // Mostly one is a multiple of the other, and a single division tells it.
    let (larger, smaller) = (left.max(right), left.min(right));
    let rest = larger.remainder(smaller);
    match rest.is_zero() {
        true => Some(larger),
        false => {
            exact_quotient(larger, greatest_common_divisor(smaller, rest)).checked_mul(&smaller)
        }
    }
}

#[cfg(test)]
mod tests {
    use num_integer::Integer as _;

    use super::*;
    use crate::exact::Rational;

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
                    if let (Ok(left), Ok(right)) = (i64::try_from(left), i64::try_from(right)) {
                        assert_eq!(greatest_common_divisor(left, right), left.gcd(&right));
                    }
                }
            }
        }
    }

    #[test]
    fn short_fractions_are_those_of_any_length() {
        let wide = (1_i128 << 70) + 3;
        agree(&[(0, 5), (1, 1), (-6, 4), (35, 12), (7 << 66, 96), (wide, 3 * wide), (-9, wide)]);
        let wide = (1_i64 << 40) + 3;
        agree(&[(0, 5), (1, 1), (-6, 4), (35, 12), (7 << 36, 96), (wide, 3 * wide), (-9, wide)]);
        assert_eq!(ShortFraction::new(1_i128, 0), None);
        assert_eq!(ShortFraction::new(i128::MIN, 3), None);
        assert_eq!(ShortFraction::new(i64::MIN, 3), None);
    }

    fn agree<W: FixedWidth>(numbers: &[(W, W)]) {
        let long =
            |own: ShortFraction<W>| Rational::new(own.numerator.into(), own.denominator.into());
        let fractions = numbers.iter().map(|&(numerator, denominator)| {
            let own = ShortFraction::new(numerator, denominator).expect("short");
            assert_eq!(long(own), Rational::new(numerator.into(), denominator.into()));
            assert_eq!(Rational::from_integer(own.denominator().into()).numer(), long(own).denom());
            assert_eq!(Rational::from_integer(own.numerator().into()).numer(), long(own).numer());
            assert_eq!(long(own.negative()), -long(own));
            own
        });
        let fractions: Vec<_> = fractions.collect();
        for &left in &fractions {
            for &right in &fractions {
                let check = |found: Option<ShortFraction<W>>, expected: Rational| match found {
                    Some(found) => assert_eq!(long(found), expected),
                    None => {
                        let digits = expected.numer().bits() + expected.denom().bits();
                        assert!(digits as f64 > W::BOUND.log2());
                    }
                };
                check(left.sum(right), long(left) + long(right));
                check(left.product(right), long(left) * long(right));
                match right.is_zero() {
                    true => assert_eq!(left.quotient(right), None),
                    false => check(left.quotient(right), long(left) / long(right)),
                }
            }
        }
    }
}
