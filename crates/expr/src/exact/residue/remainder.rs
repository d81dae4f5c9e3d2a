//! Reconstruction of whole numbers from their residues by the Chinese remainder theorem, for many
//! numbers over the same primes.
//!
//! The cofactors `M/p_i` are cut into digits once; a number is then a sum of digits times residues,
//! which costs (primes)^2 word products. Eight numbers are reconstructed side by side, as fast as
//! the recursion that gave the residues. The result is the number between `-M/2` and `M/2`.

use num_integer::Integer as _;
use num_traits::{One, Signed, ToPrimitive, Zero};
use pulp::NullaryFnOnce;

use super::sums::multiples;
use super::{Arithmetic, Lanes, Moduli, Modulus, Residues, WIDTH};
use crate::exact::Integer;

/// Primes, and the constants that reconstruct a number from its residues modulo all of them.
pub struct Remainders<A> {
    arithmetic: A,
    moduli: Vec<Modulus>,
    /// The digits of `M/p_i`, eight at a time: the first eight for all primes, then the next eight
    /// for all.
    cofactors: Vec<Lanes>,
    /// The digits of `M`, as many as those of a cofactor.
    product: Vec<u64>,
    /// `(M/p_i)^-1` modulo `p_i`.
    inverses: Vec<u64>,
    /// `1/p_i`.
    reciprocals: Vec<f64>,
}

impl<A: Arithmetic> Remainders<A> {
    /// Prepares these primes, at most 2^13.
    pub fn new(arithmetic: A, moduli: &[Modulus]) -> Self {
        let product: Integer = moduli.iter().map(|modulus| Integer::from(modulus.prime)).product();
        let blocks = (product.bits() / u64::from(A::DIGIT)) as usize / WIDTH + 1;
        let mut cofactors = vec![Lanes::default(); blocks * moduli.len()];
        for (i, modulus) in moduli.iter().enumerate() {
            let cofactor = &product / Integer::from(modulus.prime);
            let digits = digits::<A>(&cofactor, blocks * WIDTH);
            let own = cofactors.iter_mut().skip(i).step_by(moduli.len());
            for (own, digits) in own.zip(digits.chunks_exact(WIDTH)) {
                own.0.copy_from_slice(digits);
            }
        }
        let mut inverses: Vec<u64> = Vec::with_capacity(moduli.len());
        for (block, eight) in moduli.chunks(WIDTH).enumerate() {
            let mut cofactors = Lanes::default();
            for (lane, modulus) in eight.iter().enumerate() {
                let own = block * WIDTH + lane;
                let others = moduli.iter().enumerate().filter(|(j, _)| *j != own);
                cofactors.0[lane] = others.fold(modulus.one, |product, (_, other)| {
                    modulus.product(product, modulus.residue(other.prime))
                });
            }
            let residues = Residues { arithmetic, moduli: Moduli::from_primes(eight) };
            let inverse = arithmetic.vectorize(Invert(&residues, cofactors));
            inverses.extend_from_slice(&inverse.0[..eight.len()]);
        }
        Self {
            arithmetic,
            moduli: moduli.to_vec(),
            reciprocals: moduli.iter().map(|modulus| 1.0 / modulus.prime as f64).collect(),
            product: digits::<A>(&product, blocks * WIDTH),
            cofactors,
            inverses,
        }
    }

    /// Returns the weights by which plain residues are multiplied when they are
    /// [lifted](Self::lift): the inverse cofactors times `factor`.
    pub fn weights<'a>(
        &'a self,
        factor: impl Fn(&Modulus) -> u64 + 'a,
    ) -> impl Iterator<Item = u64> + 'a {
        let pairs = self.moduli.iter().zip(&self.inverses);
        pairs.map(move |(modulus, inverse)| modulus.product(factor(modulus), *inverse))
    }

    /// Reconstructs eight numbers from their plain residues modulo each prime and the
    /// [weights](Self::weights); the residues are overwritten.
    pub fn lift(
        &self,
        residues: &mut [Lanes],
        weights: &[u64],
        numbers: &mut ReconstructedIntegers,
    ) {
        numbers.digits.resize(self.product.len(), Lanes::default());
        self.arithmetic.vectorize(LiftRemainders(self, residues, weights, numbers));
    }

    /// Reconstructs one number from its plain residues.
    pub fn lift_one(&self, residues: impl Iterator<Item = u64>, weights: &[u64]) -> Integer {
        let mut residues: Vec<Lanes> = residues.map(Lanes::all).collect();
        let mut numbers = ReconstructedIntegers::default();
        self.lift(&mut residues, weights, &mut numbers);
        numbers.integer::<A>(0)
    }
}

/// The inverses of eight residues.
struct Invert<'a, A>(&'a Residues<A>, Lanes);

impl<A: Arithmetic> NullaryFnOnce for Invert<'_, A> {
    type Output = Lanes;

    #[inline(always)]
    fn call(self) -> Lanes {
        self.0.inverse(self.1)
    }
}

struct LiftRemainders<'a, A>(
    &'a Remainders<A>,
    &'a mut [Lanes],
    &'a [u64],
    &'a mut ReconstructedIntegers,
);

impl<A: Arithmetic> NullaryFnOnce for LiftRemainders<'_, A> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        /// Number of digits whose sums are formed together: a residue is read once for all of them.
        const TOGETHER: usize = 4;
        let Self(remainders, residues, weights, numbers) = self;
        let arithmetic = remainders.arithmetic;
        let count = remainders.moduli.len();
        let mut quotients = [0.0; WIDTH];
        let primes = weights.iter().zip(&remainders.moduli).zip(&remainders.reciprocals);
        for (own, ((weight, modulus), reciprocal)) in residues.iter_mut().zip(primes) {
            *own = arithmetic.product(own, &Lanes::all(*weight), &Moduli::all(modulus));
            for (quotient, residue) in quotients.iter_mut().zip(own.0) {
                *quotient += small_to_f64(residue) * reciprocal;
            }
        }
        // The quotient q is the nearest integer. Rounding errors cannot change it if the number is
        // small compared with M, as it is with enough primes.
        let mut times = Lanes::default();
        for (times, quotient) in times.0.iter_mut().zip(quotients) {
            *times = (quotient + 0.5) as u64;
        }
        let mask = (1_u64 << A::DIGIT) - 1;
        let mut carries = [0_i64; WIDTH];
        let digits = numbers.digits.chunks_exact_mut(TOGETHER);
        for (lot, (digits, product)) in
            digits.zip(remainders.product.chunks_exact(TOGETHER)).enumerate()
        {
            let (block, first) = (lot * TOGETHER / WIDTH, lot * TOGETHER % WIDTH);
            let mut sums = [arithmetic.none(); TOGETHER];
            let columns = &remainders.cofactors[block * count..][..count];
            for (columns, residues) in columns.chunks(A::RUN).zip(residues.chunks(A::RUN)) {
                for (column, residue) in columns.iter().zip(residues) {
                    let column = &column.0[first..first + TOGETHER];
                    for (sum, digit) in sums.iter_mut().zip(column) {
                        *sum = arithmetic.add_multiple(*sum, *digit, residue);
                    }
                }
                // This is a loop because a closure would not be compiled for this processor.
                for sum in &mut sums {
                    *sum = arithmetic.carry(*sum);
                }
            }
            for ((sum, digit), product) in sums.into_iter().zip(digits).zip(product) {
                let (low, high) = arithmetic.parts(sum);
                let taken =
                    arithmetic.parts(arithmetic.add_multiple(arithmetic.none(), *product, &times));
                for (j, carry) in carries.iter_mut().enumerate() {
                    let value =
                        (low.0[j] as i64).wrapping_sub(taken.0.0[j] as i64).wrapping_add(*carry);
                    digit.0[j] = value as u64 & mask;
                    let above = (high.0[j] as i64).wrapping_sub(taken.1.0[j] as i64);
                    *carry = (value >> A::DIGIT).wrapping_add(above << (A::RADIX - A::DIGIT));
                }
            }
        }
        numbers.negative = carries.map(|carry| carry < 0);
    }
}

/// Converts a whole number below `2^52`, without an instruction for words that not every processor
/// has.
#[inline(always)]
fn small_to_f64(number: u64) -> f64 {
    const SHIFT: f64 = (1_u64 << 52) as f64;
    f64::from_bits(SHIFT.to_bits() | number) - SHIFT
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

/// Eight reconstructed integers, digit by digit; a negative one is kept as its complement, the sum
/// with the power of the radix above its highest digit.
#[derive(Clone, Debug, Default)]
pub struct ReconstructedIntegers {
    digits: Vec<Lanes>,
    negative: [bool; WIDTH],
}

impl ReconstructedIntegers {
    /// Returns the plain residues of the eight integers; `powers` are the residues of the powers of
    /// `2^DIGIT` ([`Arithmetic::DIGIT`]), one more than there are digits.
    pub fn residues<A: Arithmetic>(
        &self,
        arithmetic: A,
        modulus: &Modulus,
        powers: &[u64],
    ) -> [u64; WIDTH] {
        struct ReduceDigits<'a, A>(A, &'a Modulus, &'a [u64], &'a [Lanes]);
        impl<A: Arithmetic> NullaryFnOnce for ReduceDigits<'_, A> {
            type Output = Lanes;
            #[inline(always)]
            fn call(self) -> Lanes {
                let Self(arithmetic, modulus, powers, digits) = self;
                arithmetic.reduce(multiples(arithmetic, powers, digits), &Moduli::all(modulus))
            }
        }
        let count = self.digits.len();
        let mut residues = arithmetic
            .vectorize(ReduceDigits(arithmetic, modulus, &powers[..count], &self.digits))
            .0;
        let above = modulus.plain(powers[count]);
        for (residue, negative) in residues.iter_mut().zip(self.negative) {
            if negative {
                *residue = modulus.difference(*residue, above);
            }
        }
        residues
    }

    /// Returns the integer in this lane.
    pub fn integer<A: Arithmetic>(&self, place: usize) -> Integer {
        let mask = (1_u64 << A::DIGIT) - 1;
        let negative = self.negative[place];
        let mut words = Vec::with_capacity(self.digits.len() * A::DIGIT as usize / 64 + 2);
        let (mut pending, mut length, mut borrow) = (0_u128, 0, u64::from(negative));
        for digit in &self.digits {
            let mut digit = digit.0[place];
            if negative {
                let complement = (!digit & mask) + borrow;
                digit = complement & mask;
                borrow = complement >> A::DIGIT;
            }
            pending |= u128::from(digit) << length;
            length += A::DIGIT;
            if length >= 64 {
                words.push(pending as u64);
                pending >>= 64;
                length -= 64;
            }
        }
        words.push(pending as u64);
        let number = Integer::from_words(&mut words);
        if negative { -number } else { number }
    }
}

/// Returns numerator and denominator of the fraction with this residue modulo `modulus`, by Wang's
/// algorithm; the residue may be negative. Far from the end some eighteen divisions of Euclid's
/// algorithm are made at once (`lehmer_step`), so that the cost is `n^2/30` word products for `n`
/// bits. Numerator and denominator together have at least 24 bits
/// fewer than the modulus, so that another such fraction would be a coincidence; `None` if there is
/// none.
pub fn fraction(residue: &Integer, modulus: &Integer) -> Option<(Integer, Integer)> {
    const ROOM: u64 = 24;
    let bound = modulus.bits() / 2;
    let positive = if residue.is_negative() { residue + modulus } else { residue.clone() };
    let (mut larger, mut smaller) = (modulus.clone(), positive);
    let (mut before, mut denominator) = (Integer::zero(), Integer::one());
    while smaller.bits() > bound {
        // One such step takes off less than a word, and must not go beyond the bound.
        if smaller.bits() > bound + u64::from(u64::BITS)
            && let Some([[a, b], [c, d]]) = lehmer_step(&larger, &smaller)
        {
            let combined = |p: &Integer, m: i64, q: &Integer, n: i64| {
                p * &Integer::from(m) + q * &Integer::from(n)
            };
            (larger, smaller) =
                (combined(&larger, a, &smaller, b), combined(&larger, c, &smaller, d));
            (before, denominator) =
                (combined(&before, a, &denominator, b), combined(&before, c, &denominator, d));
            continue;
        }
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

/// Returns the matrix of as many steps of Euclid's algorithm as follow from the leading digits of two
/// positive numbers; `None` if not one does.
///
/// Reference: D. H. Lehmer, Amer. Math. Monthly 45 (1938) 227-233; D. E. Knuth, *The Art of Computer
/// Programming* 2, section 4.5.2, algorithm L.
fn lehmer_step(larger: &Integer, smaller: &Integer) -> Option<[[i64; 2]; 2]> {
    /// Leading binary digits that are looked at: sums with the entries stay within a word.
    const LEADING: u64 = 62;
    let shift = usize::try_from(larger.bits().saturating_sub(LEADING)).ok()?;
    let leading = |number: &Integer| (number >> shift).to_i64();
    let (mut x, mut y) = (leading(larger)?, leading(smaller)?);
    let [mut upper, mut lower] = [[1, 0], [0, 1]];
    // The quotient is certain where both bounds of the numbers give it.
    while y + lower[0] != 0 && y + lower[1] != 0 {
        let quotient = (x + upper[0]) / (y + lower[0]);
        if quotient != (x + upper[1]) / (y + lower[1]) {
            break;
        }
        let next: [i64; 2] = std::array::from_fn(|k| upper[k] - quotient * lower[k]);
        (upper, lower) = (lower, next);
        (x, y) = (y, x - quotient * y);
    }
    (upper[1] != 0).then_some([upper, lower])
}

#[cfg(test)]
mod tests {
    use super::super::{Work, by_widest, portable::Portable, primes_below};
    use super::*;

    struct RoundTrip;

    impl Work for RoundTrip {
        type Output = ();

        fn run<A: Arithmetic>(self, arithmetic: A) {
            let primes: Vec<u64> = primes_below(A::BITS, 16).take(40).collect();
            let moduli: Vec<Modulus> =
                primes.iter().map(|prime| Modulus::new(*prime, A::RADIX)).collect();
            let check = Modulus::new(primes[39], A::RADIX);
            let remainders = Remainders::new(arithmetic, &moduli[..39]);
            for (power, factor) in
                [(0, 0), (1, 1), (3, -1), (600, 17), (600, -17), (1000, 3), (1000, -1)]
            {
                let number = Integer::from(3).pow(power / 2) * Integer::from(factor);
                let weights: Vec<u64> = remainders.weights(|modulus| modulus.one).collect();
                // Eight numbers beside each other: this one and its multiples.
                let all: Vec<Integer> =
                    (0..WIDTH as i64).map(|k| &number * Integer::from(3 - 2 * k)).collect();
                let mut residues = vec![Lanes::default(); 39];
                for (own, modulus) in residues.iter_mut().zip(&moduli) {
                    for (residue, number) in own.0.iter_mut().zip(&all) {
                        *residue = modulus.plain(modulus.integer(number));
                    }
                }
                let first = remainders.lift_one(residues.iter().map(|own| own.0[0]), &weights);
                assert_eq!(first, all[0]);
                let mut numbers = ReconstructedIntegers::default();
                remainders.lift(&mut residues, &weights, &mut numbers);
                let digit = check.residue(1 << A::DIGIT);
                let powers: Vec<u64> = (0..60).map(|place| check.power(digit, place)).collect();
                let found = numbers.residues(arithmetic, &check, &powers);
                for (place, number) in all.iter().enumerate() {
                    assert_eq!(numbers.integer::<A>(place), *number);
                    assert_eq!(found[place], check.plain(check.integer(number)));
                }
            }
        }
    }

    #[test]
    fn a_number_is_what_its_residues_say() {
        RoundTrip.run(Portable);
        by_widest(RoundTrip);
    }

    #[test]
    fn a_fraction_is_found_where_the_modulus_is_long_enough() {
        let modulus = Integer::from((1_i64 << 61) - 1);
        // -17/96 modulo the prime: 96 * inverse = 1.
        let inverse = (1..96).find_map(|k| {
            let (quotient, rest) =
                (&modulus * Integer::from(k) + Integer::one()).div_rem(&Integer::from(96));
            rest.is_zero().then_some(quotient)
        });
        let residue = (inverse.expect("a prime") * Integer::from(-17)).mod_floor(&modulus);
        assert_eq!(fraction(&residue, &modulus), Some((Integer::from(-17), Integer::from(96))));
        assert_eq!(
            fraction(&Integer::from(3_000_000_001_i64).pow(2).mod_floor(&modulus), &modulus),
            None
        );
    }

    #[test]
    fn many_steps_at_once_are_those_of_euclid() {
        let long = Integer::from(7).pow(500);
        let others = [Integer::from(3).pow(800), Integer::from(5).pow(40), &long - Integer::one()];
        for other in others {
            let (mut larger, mut smaller) =
                if long > other { (long.clone(), other) } else { (other, long.clone()) };
            let mut pairs = vec![];
            while smaller.is_positive() {
                pairs.push([larger.clone(), smaller.clone()]);
                (larger, smaller) = (smaller.clone(), larger.mod_floor(&smaller));
            }
            let mut steps = 0;
            for (place, [larger, smaller]) in pairs.iter().enumerate() {
                let Some(rows) = lehmer_step(larger, smaller) else { continue };
                let found =
                    rows.map(|[m, n]| larger * &Integer::from(m) + smaller * &Integer::from(n));
                let ahead = pairs[place + 1..].iter().position(|pair| *pair == found);
                assert!(ahead.is_some() || found[1].is_zero(), "{place}");
                steps = ahead.map_or(steps, |ahead| steps.max(ahead + 1));
            }
            assert!(steps > 12 || pairs.len() < 100, "{steps} of {}", pairs.len());
        }
    }

    #[test]
    fn a_long_fraction_is_found() {
        // The inverse of d modulo M = 2 d t - 1 is 2 t.
        let (numerator, denominator) = (-Integer::from(5).pow(200), Integer::from(7).pow(200));
        let double = Integer::from(2) * Integer::from(3).pow(900);
        let modulus = &denominator * &double - Integer::one();
        let residue = (&numerator * double).mod_floor(&modulus);
        assert_eq!(fraction(&residue, &modulus), Some((numerator, denominator)));
    }
}
