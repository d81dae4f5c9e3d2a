//! Sums, products and comparison of exact fractions whose lengths differ widely.
//!
//! The library of fractions takes the greatest common divisor bit by bit, also of a million bits
//! and 1, and compares by recursion along continued fractions. Here the divisor comes from Euclid's
//! algorithm, which takes one cheap step if one number is short, and is left out where the result
//! is in lowest terms already (Knuth, The Art of Computer Programming, volume 2, section 4.5.1).

use std::cmp::Ordering;

use num_traits::{One, Signed, Zero};

use crate::exact::rational::{Integer, Rational};

/// The sum, in lowest terms.
pub(super) fn add(a: &Rational, b: &Rational) -> Rational {
    let common = greatest_common_divisor(a.denom(), b.denom());
    if common.is_one() {
        let numerator = a.numer() * b.denom() + b.numer() * a.denom();
        return Rational::new_raw(numerator, a.denom() * b.denom());
    }
    let rest = a.denom() / &common;
    let numerator = a.numer() * (b.denom() / &common) + b.numer() * &rest;
    // Any further common factor divides the common part of the denominators.
    let again = greatest_common_divisor(&numerator, &common);
    Rational::new_raw(numerator / &again, rest * (b.denom() / again))
}

/// The product, in lowest terms.
pub(super) fn multiply(a: &Rational, b: &Rational) -> Rational {
    if a.denom().is_one() && b.denom().is_one() {
        return Rational::from_integer(a.numer() * b.numer());
    }
    let first = greatest_common_divisor(a.numer(), b.denom());
    let second = greatest_common_divisor(b.numer(), a.denom());
    let numerator = (a.numer() / &first) * (b.numer() / &second);
    Rational::new_raw(numerator, (a.denom() / second) * (b.denom() / first))
}

/// The fraction `numerator / denominator` in lowest terms, for a denominator above zero.
pub(super) fn lowest_terms(numerator: Integer, denominator: Integer) -> Rational {
    let common = greatest_common_divisor(&numerator, &denominator);
    match common.is_one() {
        true => Rational::new_raw(numerator, denominator),
        false => Rational::new_raw(numerator / &common, denominator / common),
    }
}

/// The greatest common divisor, not negative; that of 0 and 0 is 0.
pub(super) fn greatest_common_divisor(a: &Integer, b: &Integer) -> Integer {
    // Most numbers are whole, with the denominator 1.
    if a.is_one() || b.is_one() {
        return Integer::one();
    }
    // Of long numbers a division takes off a few bits only, with a number as long each time.
    if a.bits().min(b.bits()) > 2 * u64::from(u64::BITS) {
        return num_integer::Integer::gcd(a, b);
    }
    let (mut larger, mut smaller) = (a.abs(), b.abs());
    while !smaller.is_zero() {
        let remainder = larger % &smaller;
        larger = smaller;
        smaller = remainder;
    }
    larger
}

/// Compares two fractions.
pub(super) fn compare(a: &Rational, b: &Rational) -> Ordering {
    match a.denom() == b.denom() {
        true => a.numer().cmp(b.numer()),
        false => (a.numer() * b.denom()).cmp(&(b.numer() * a.denom())),
    }
}

/// The length of numerator and denominator in bits.
pub(super) fn bits(value: &Rational) -> u64 {
    value.numer().bits() + value.denom().bits()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::rational::ratio;

    #[test]
    fn agrees_with_the_library() {
        let numbers = [
            (0, 1),
            (1, 1),
            (-1, 1),
            (2, 3),
            (-2, 3),
            (5, 6),
            (7, 12),
            (-35, 12),
            (9, 10),
            (12, 35),
        ];
        let numbers = numbers.map(|(numerator, denominator)| ratio(numerator, denominator));
        for a in &numbers {
            for b in &numbers {
                // Raw parts: the library's own equality would forgive a fraction that is not in
                // lowest terms.
                let parts = |value: &Rational| (value.numer().clone(), value.denom().clone());
                assert_eq!(parts(&add(a, b)), parts(&(a + b)), "{a} + {b}");
                assert_eq!(parts(&multiply(a, b)), parts(&(a * b)), "{a} * {b}");
                assert_eq!(compare(a, b), a.cmp(b), "{a} against {b}");
            }
        }
    }
}
