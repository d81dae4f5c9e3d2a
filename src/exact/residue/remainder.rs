//! Whole numbers from their residues: the Chinese remainder theorem, for many numbers over the same primes.
//!
//! The cofactors `M/p_i` are cut into digits once; a number is then a sum of digits times residues, which costs (primes)^2 word
//! products and runs as fast as the recursion that gave the residues. A number nearer to zero than half of `M` is meant.

use num_integer::Integer as _;
use num_traits::{One, Signed, Zero};
use pulp::NullaryFnOnce;

use super::sums::multiples;
use super::{Arithmetic, Modulus, Rows, WIDTH, padded};
use crate::exact::Integer;

/// Primes, and what brings residues modulo all of them together.
pub struct Remainders<A> {
    arithmetic: A,
    moduli: Vec<Modulus>,
    /// The digits of `M/p_i`, a column for each prime.
    cofactors: Rows,
    /// The digits of `M`.
    product: Vec<u64>,
    /// `(M/p_i)^-1` modulo `p_i`.
    inverses: Vec<u64>,
}

impl<A: Arithmetic> Remainders<A> {
    /// For these primes, at most 2^13.
    pub fn new(arithmetic: A, moduli: &[Modulus]) -> Self {
        let product: Integer = moduli.iter().map(|modulus| Integer::from(modulus.prime)).product();
        let count = product.bits().div_ceil(A::DIGIT.into()) as usize + 1;
        let mut cofactors = Rows::new(count, moduli.len());
        for (i, modulus) in moduli.iter().enumerate() {
            let cofactor = &product / Integer::from(modulus.prime);
            cofactors.write(i, &digits::<A>(&cofactor, padded(count)));
        }
        let mut inverses: Vec<u64> = Vec::with_capacity(moduli.len());
        for (i, modulus) in moduli.iter().enumerate() {
            let others = moduli.iter().enumerate().filter(|(j, _)| *j != i);
            let cofactor = others.fold(modulus.one, |product, (_, other)| {
                modulus.product(product, modulus.residue(other.prime))
            });
            inverses.push(modulus.inverse(cofactor));
        }
        Self {
            arithmetic,
            moduli: moduli.to_vec(),
            product: digits::<A>(&product, count),
            cofactors,
            inverses,
        }
    }

    /// What plain residues are multiplied by before they are [lifted](Self::lift), times `factor`.
    pub fn weights<'a>(&'a self, factor: impl Fn(&Modulus) -> u64 + 'a) -> impl Iterator<Item = u64> + 'a {
        let pairs = self.moduli.iter().zip(&self.inverses);
        pairs.map(move |(modulus, inverse)| modulus.product(factor(modulus), *inverse))
    }

    /// The number from its plain residues times the [weights](Self::weights).
    pub fn lift(&self, weighted: &[u64]) -> Digits {
        let mut sums = vec![0_u128; padded(self.product.len())];
        let work = Lift(self.arithmetic, weighted, &self.cofactors, &mut sums);
        self.arithmetic.vectorize(work);
        let fractions = weighted.iter().zip(&self.moduli);
        let quotient: f64 = fractions.map(|(t, modulus)| *t as f64 / modulus.prime as f64).sum();
        // Far from the middle between two integers where the number is small beside M, as it is where there are primes enough.
        let quotient = quotient.round() as i128;
        let mask = (1_i128 << A::DIGIT) - 1;
        let mut carry = 0_i128;
        let mut digits: Vec<u64> = Vec::with_capacity(self.product.len());
        for (sum, digit) in sums.into_iter().zip(&self.product) {
            let value = sum as i128 - quotient * i128::from(*digit) + carry;
            digits.push((value & mask) as u64);
            carry = value >> A::DIGIT;
        }
        let negative = carry < 0;
        if negative {
            let mut borrow = 1;
            for digit in &mut digits {
                let complement = (!*digit & mask as u64) + borrow;
                *digit = complement & mask as u64;
                borrow = complement >> A::DIGIT;
            }
        }
        while digits.last() == Some(&0) {
            digits.pop();
        }
        Digits { negative, digits }
    }
}

struct Lift<'a, A>(A, &'a [u64], &'a Rows, &'a mut [u128]);

impl<A: Arithmetic> NullaryFnOnce for Lift<'_, A> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(arithmetic, weighted, cofactors, sums) = self;
        for (block, sums) in sums.chunks_exact_mut(WIDTH).enumerate() {
            let sum = multiples(arithmetic, weighted, cofactors.row(block));
            let (low, high) = arithmetic.parts(sum);
            for (k, sum) in sums.iter_mut().enumerate() {
                *sum = u128::from(low.0[k]) + (u128::from(high.0[k]) << A::RADIX);
            }
        }
    }
}

/// The lowest `count` digits of a positive number.
fn digits<A: Arithmetic>(number: &Integer, count: usize) -> Vec<u64> {
    let words = number.to_words();
    let word = |place: usize| words.get(place).copied().unwrap_or(0);
    let digit = |place: usize| {
        let (word_at, shift) = (place * A::DIGIT as usize / 64, place * A::DIGIT as usize % 64);
        let both = u128::from(word(word_at)) | u128::from(word(word_at + 1)) << 64;
        (both >> shift) as u64 & ((1 << A::DIGIT) - 1)
    };
    (0..count).map(digit).collect()
}

/// A whole number as it comes out of the remainders.
#[derive(Clone, Debug)]
pub struct Digits {
    negative: bool,
    digits: Vec<u64>,
}

impl Digits {
    /// Its residue; `powers` are the residues of the powers of a [digit](Arithmetic::DIGIT).
    pub fn residue(&self, modulus: &Modulus, powers: &[u64]) -> u64 {
        let terms = self.digits.iter().zip(powers);
        let sum = terms.fold(0, |sum, (&digit, &power)| {
            modulus.sum(sum, modulus.product(digit, power))
        });
        // Digits are no residues: one factor R is missing.
        let residue = modulus.of_plain(sum);
        if self.negative {
            modulus.negative(residue)
        } else {
            residue
        }
    }

    /// The number itself.
    pub fn to_integer<A: Arithmetic>(&self) -> Integer {
        let length = self.digits.len() * A::DIGIT as usize;
        let mut words = vec![0_u64; length / 64 + 2];
        for (place, digit) in self.digits.iter().enumerate() {
            let (word, shift) = (place * A::DIGIT as usize / 64, place * A::DIGIT as usize % 64);
            let shifted = u128::from(*digit) << shift;
            words[word] |= shifted as u64;
            words[word + 1] |= (shifted >> 64) as u64;
        }
        let number = Integer::from_words(&words);
        if self.negative { -number } else { number }
    }
}

/// The fraction with this residue modulo `modulus`, between its two halves or positive, whose numerator and denominator together have at least 24 binary digits fewer
/// than the modulus, so that another fraction with the same residue would be a coincidence; Wang's algorithm.
pub fn fraction(residue: &Integer, modulus: &Integer) -> Option<(Integer, Integer)> {
    const ROOM: u64 = 24;
    let bound = modulus.bits() / 2;
    let positive = if residue.is_negative() {
        residue + modulus
    } else {
        residue.clone()
    };
    let (mut larger, mut smaller) = (modulus.clone(), positive);
    let (mut before, mut denominator) = (Integer::zero(), Integer::one());
    while smaller.bits() > bound {
        let (quotient, rest) = larger.div_rem(&smaller);
        let next = before - &denominator * quotient;
        (larger, smaller) = (smaller, rest);
        (before, denominator) = (denominator, next);
    }
    if denominator.is_negative() {
        (smaller, denominator) = (-smaller, -denominator);
    }
    let short = smaller.bits() + denominator.bits() + ROOM <= modulus.bits();
    (short && !denominator.is_zero()).then_some((smaller, denominator))
}

#[cfg(test)]
mod tests {
    use super::super::{Work, by_widest, portable::Portable, primes_below};
    use super::*;

    struct ThereAndBack;

    impl Work for ThereAndBack {
        type Output = ();

        fn by<A: Arithmetic>(self, arithmetic: A) {
            let primes: Vec<u64> = primes_below(A::BITS, 16).take(40).collect();
            let moduli: Vec<Modulus> = primes.iter().map(|prime| Modulus::new(*prime, A::RADIX)).collect();
            let check = Modulus::new(primes[39], A::RADIX);
            let remainders = Remainders::new(arithmetic, &moduli[..39]);
            for (power, factor) in [(0, 0), (1, 1), (3, -1), (600, 17), (600, -17), (1000, 3), (1000, -1)] {
                let number = Integer::from(3).pow(power / 2) * Integer::from(factor);
                let weights: Vec<u64> = remainders.weights(|modulus| modulus.one).collect();
                let weighted: Vec<u64> = moduli[..39]
                    .iter()
                    .zip(weights)
                    .map(|(modulus, weight)| modulus.product(modulus.plain(modulus.integer(&number)), weight))
                    .collect();
                let digits = remainders.lift(&weighted);
                assert_eq!(digits.to_integer::<A>(), number);
                let digit = check.residue(1 << A::DIGIT);
                let powers: Vec<u64> = (0..60).map(|place| check.power(digit, place)).collect();
                assert_eq!(digits.residue(&check, &powers), check.integer(&number));
            }
        }
    }

    #[test]
    fn a_number_is_what_its_residues_say() {
        ThereAndBack.by(Portable::new());
        by_widest(ThereAndBack);
    }

    #[test]
    fn a_fraction_is_found_where_the_modulus_is_long_enough() {
        let modulus = Integer::from((1_i64 << 61) - 1);
        // -17/96 modulo the prime: 96 * inverse = 1.
        let inverse = (1..96).find_map(|k| {
            let (quotient, rest) = (&modulus * Integer::from(k) + Integer::one()).div_rem(&Integer::from(96));
            rest.is_zero().then_some(quotient)
        });
        let residue = (inverse.expect("a prime") * Integer::from(-17)).mod_floor(&modulus);
        assert_eq!(
            fraction(&residue, &modulus),
            Some((Integer::from(-17), Integer::from(96)))
        );
        assert_eq!(
            fraction(&Integer::from(3_000_000_001_i64).pow(2).mod_floor(&modulus), &modulus),
            None
        );
    }
}
