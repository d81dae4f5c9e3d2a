//! Sums of products by the 256-bit vectors of x86-64 processors with AVX2: 32 by 32 bits in words
//! of 64 bits, as in the [portable](super::portable) arithmetic, with the same primes.

use std::arch::x86_64::__m256i as Register;

use pulp::NullaryFnOnce;
use pulp::x86::V3;

use super::{Arithmetic, Lanes, Moduli};

/// A processor with AVX2, detected at run time.
#[derive(Clone, Copy, Debug)]
pub struct Narrow(V3);

/// Eight words.
type EightWords = [Register; 2];

/// Four primes, and the constants that reduce modulo them.
#[derive(Clone, Copy)]
struct FourPrimes {
    prime: Register,
    inverse: Register,
    quotient: Register,
}

/// The sum of the products not carried yet, and the sums of the low and of the high halves of those
/// that are.
#[derive(Clone, Copy)]
pub struct NarrowSum {
    recent: EightWords,
    low: EightWords,
    high: EightWords,
}

impl Narrow {
    /// Detects AVX2; `None` if the processor does not have it.
    pub fn try_new() -> Option<Self> {
        V3::try_new().map(Self)
    }

    #[inline(always)]
    fn all(self, value: u64) -> Register {
        self.0.avx._mm256_set1_epi64x(value as i64)
    }

    #[inline(always)]
    fn words(self, lanes: &Lanes) -> EightWords {
        pulp::cast(lanes.0)
    }

    /// Eight primes, four by four.
    #[inline(always)]
    fn fours(self, moduli: &Moduli) -> [FourPrimes; 2] {
        let prime = self.words(&moduli.prime);
        let inverse = self.words(&moduli.inverse);
        let quotient = self.words(&moduli.quotient);
        [
            FourPrimes { prime: prime[0], inverse: inverse[0], quotient: quotient[0] },
            FourPrimes { prime: prime[1], inverse: inverse[1], quotient: quotient[1] },
        ]
    }

    #[inline(always)]
    fn both(self, left: EightWords, right: EightWords) -> EightWords {
        let v = self.0.avx2;
        [v._mm256_add_epi64(left[0], right[0]), v._mm256_add_epi64(left[1], right[1])]
    }

    /// The products of the low halves.
    #[inline(always)]
    fn multiply(self, left: EightWords, right: EightWords) -> EightWords {
        let v = self.0.avx2;
        [v._mm256_mul_epu32(left[0], right[0]), v._mm256_mul_epu32(left[1], right[1])]
    }

    /// The upper halves.
    #[inline(always)]
    fn upper(self, words: EightWords) -> EightWords {
        let v = self.0.avx2;
        [v._mm256_srli_epi64::<32>(words[0]), v._mm256_srli_epi64::<32>(words[1])]
    }

    /// The lower halves.
    #[inline(always)]
    fn lower(self, words: EightWords) -> EightWords {
        let (v, zero) = (self.0.avx2, self.all(0));
        [v._mm256_blend_epi32::<0xaa>(words[0], zero), v._mm256_blend_epi32::<0xaa>(words[1], zero)]
    }

    /// Four sums divided by `R`.
    #[inline(always)]
    fn reduce_four(self, low: Register, high: Register, four: FourPrimes) -> Register {
        let v = self.0.avx2;
        let prime = four.prime;
        // The steps are those of the wide arithmetic, with a high part below 2^42.
        let high = v._mm256_add_epi64(high, v._mm256_srli_epi64::<32>(low));
        let guess = v._mm256_mul_epu32(v._mm256_srli_epi64::<10>(high), four.quotient);
        let multiple = v._mm256_mul_epu32(v._mm256_srli_epi64::<47>(guess), prime);
        let high = v._mm256_sub_epi64(high, multiple);
        let residue = v._mm256_sub_epi64(v._mm256_add_epi64(high, prime), self.taken(low, four));
        // Half words are compared: both halves of a difference below zero are large.
        let once = v._mm256_min_epu32(residue, v._mm256_sub_epi64(residue, prime));
        v._mm256_min_epu32(once, v._mm256_sub_epi64(once, prime))
    }

    /// Four products divided by `R`.
    #[inline(always)]
    fn reduce_product(self, product: Register, four: FourPrimes) -> Register {
        let v = self.0.avx2;
        let residue =
            v._mm256_sub_epi64(v._mm256_srli_epi64::<32>(product), self.taken(product, four));
        // Both halves of a residue below zero are large, so that the minimum is the one to which
        // the prime was added.
        v._mm256_min_epu32(residue, v._mm256_add_epi64(residue, four.prime))
    }

    /// Returns the number that Montgomery's step subtracts from the high part.
    #[inline(always)]
    fn taken(self, low: Register, four: FourPrimes) -> Register {
        let v = self.0.avx2;
        let multiple = v._mm256_mul_epu32(low, four.inverse);
        v._mm256_srli_epi64::<32>(v._mm256_mul_epu32(multiple, four.prime))
    }
}

impl Arithmetic for Narrow {
    const BITS: u32 = 30;
    const RADIX: u32 = 32;
    const DIGIT: u32 = 30;
    // Sixteen products of 60 bits fill a word.
    const RUN: usize = 16;
    type Sum = NarrowSum;

    #[inline(always)]
    fn none(self) -> NarrowSum {
        let none = [self.all(0); 2];
        NarrowSum { recent: none, low: none, high: none }
    }
    #[inline(always)]
    fn add_product(self, sum: NarrowSum, left: &Lanes, right: &Lanes) -> NarrowSum {
        let product = self.multiply(self.words(left), self.words(right));
        NarrowSum { recent: self.both(sum.recent, product), ..sum }
    }
    #[inline(always)]
    fn add_multiple(self, sum: NarrowSum, left: u64, right: &Lanes) -> NarrowSum {
        let left = self.all(left);
        let product = self.multiply([left; 2], self.words(right));
        NarrowSum { recent: self.both(sum.recent, product), ..sum }
    }
    #[inline(always)]
    fn carry(self, sum: NarrowSum) -> NarrowSum {
        NarrowSum {
            recent: [self.all(0); 2],
            low: self.both(sum.low, self.lower(sum.recent)),
            high: self.both(sum.high, self.upper(sum.recent)),
        }
    }
    #[inline(always)]
    fn merge(self, left: NarrowSum, right: NarrowSum) -> NarrowSum {
        NarrowSum {
            recent: self.both(left.recent, right.recent),
            low: self.both(left.low, right.low),
            high: self.both(left.high, right.high),
        }
    }
    #[inline(always)]
    fn join(self, left: NarrowSum, right: NarrowSum) -> NarrowSum {
        self.merge(self.carry(left), self.carry(right))
    }
    #[inline(always)]
    fn parts(self, sum: NarrowSum) -> (Lanes, Lanes) {
        let sum = self.carry(sum);
        (Lanes(pulp::cast(sum.low)), Lanes(pulp::cast(sum.high)))
    }
    #[inline(always)]
    fn reduce(self, sum: NarrowSum, moduli: &Moduli) -> Lanes {
        let NarrowSum { low, high, .. } = self.carry(sum);
        let [first, second] = self.fours(moduli);
        let residues: EightWords =
            [self.reduce_four(low[0], high[0], first), self.reduce_four(low[1], high[1], second)];
        Lanes(pulp::cast(residues))
    }
    #[inline(always)]
    fn product(self, left: &Lanes, right: &Lanes, moduli: &Moduli) -> Lanes {
        let products = self.multiply(self.words(left), self.words(right));
        let [first, second] = self.fours(moduli);
        let residues: EightWords =
            [self.reduce_product(products[0], first), self.reduce_product(products[1], second)];
        Lanes(pulp::cast(residues))
    }
    #[inline(always)]
    fn sum(self, left: &Lanes, right: &Lanes, moduli: &Moduli) -> Lanes {
        let v = self.0.avx2;
        let [first, second] = self.both(self.words(left), self.words(right));
        let prime = self.words(&moduli.prime);
        // Half words are compared, as above.
        let residues: EightWords = [
            v._mm256_min_epu32(first, v._mm256_sub_epi64(first, prime[0])),
            v._mm256_min_epu32(second, v._mm256_sub_epi64(second, prime[1])),
        ];
        Lanes(pulp::cast(residues))
    }
    #[inline(always)]
    fn difference(self, left: &Lanes, right: &Lanes, moduli: &Moduli) -> Lanes {
        let v = self.0.avx2;
        let (left, right, prime) = (self.words(left), self.words(right), self.words(&moduli.prime));
        let first = v._mm256_sub_epi64(left[0], right[0]);
        let second = v._mm256_sub_epi64(left[1], right[1]);
        let residues: EightWords = [
            v._mm256_min_epu32(first, v._mm256_add_epi64(first, prime[0])),
            v._mm256_min_epu32(second, v._mm256_add_epi64(second, prime[1])),
        ];
        Lanes(pulp::cast(residues))
    }
    #[inline(always)]
    fn vectorize<F: NullaryFnOnce>(self, function: F) -> F::Output {
        self.0.vectorize(function)
    }
}
