//! Sums of products by the wide multiply-add of x86-64 processors that have it (AVX-512 IFMA): 52
//! by 52 binary digits, the low and the high half of the product each added to a word of its own.

use std::arch::x86_64::__m512i as Register;

use pulp::NullaryFnOnce;

use super::{Arithmetic, Lanes, Moduli};

pulp::simd_type! {
    /// A processor with the wide multiply-add, detected at run time.
    pub struct Wide {
        sse: "sse",
        sse2: "sse2",
        fxsr: "fxsr",
        sse3: "sse3",
        ssse3: "ssse3",
        sse4_1: "sse4.1",
        sse4_2: "sse4.2",
        popcnt: "popcnt",
        avx: "avx",
        avx2: "avx2",
        bmi1: "bmi1",
        bmi2: "bmi2",
        fma: "fma",
        lzcnt: "lzcnt",
        avx512f: "avx512f",
        avx512bw: "avx512bw",
        avx512cd: "avx512cd",
        avx512dq: "avx512dq",
        avx512vl: "avx512vl",
        avx512ifma: "avx512ifma",
    }
}

impl Wide {
    #[inline(always)]
    fn all(self, value: u64) -> Register {
        self.avx512f._mm512_set1_epi64(value as i64)
    }

    #[inline(always)]
    fn add(
        self,
        sum: (Register, Register),
        left: Register,
        right: Register,
    ) -> (Register, Register) {
        (
            self.avx512ifma._mm512_madd52lo_epu64(sum.0, left, right),
            self.avx512ifma._mm512_madd52hi_epu64(sum.1, left, right),
        )
    }
}

impl Arithmetic for Wide {
    const BITS: u32 = 50;
    const RADIX: u32 = 52;
    const DIGIT: u32 = 52;
    // A word has room for 2^12 low halves.
    const RUN: usize = 4095;
    /// The sums of the low halves, and those of the high ones.
    type Sum = (Register, Register);

    #[inline(always)]
    fn none(self) -> Self::Sum {
        (self.all(0), self.all(0))
    }
    #[inline(always)]
    fn add_product(self, sum: Self::Sum, left: &Lanes, right: &Lanes) -> Self::Sum {
        self.add(sum, pulp::cast(left.0), pulp::cast(right.0))
    }
    #[inline(always)]
    fn add_multiple(self, sum: Self::Sum, left: u64, right: &Lanes) -> Self::Sum {
        self.add(sum, self.all(left), pulp::cast(right.0))
    }
    #[inline(always)]
    fn carry(self, (low, high): Self::Sum) -> Self::Sum {
        let f = self.avx512f;
        let low_digits = f._mm512_and_si512(low, self.all((1 << 52) - 1));
        (low_digits, f._mm512_add_epi64(high, f._mm512_srli_epi64::<52>(low)))
    }
    #[inline(always)]
    fn merge(self, left: Self::Sum, right: Self::Sum) -> Self::Sum {
        let f = self.avx512f;
        (f._mm512_add_epi64(left.0, right.0), f._mm512_add_epi64(left.1, right.1))
    }
    #[inline(always)]
    fn join(self, left: Self::Sum, right: Self::Sum) -> Self::Sum {
        self.merge(left, right)
    }
    #[inline(always)]
    fn parts(self, sum: Self::Sum) -> (Lanes, Lanes) {
        let (low, high) = self.carry(sum);
        (Lanes(pulp::cast(low)), Lanes(pulp::cast(high)))
    }
    #[inline(always)]
    fn reduce(self, sum: Self::Sum, moduli: &Moduli) -> Lanes {
        let (f, ifma) = (self.avx512f, self.avx512ifma);
        let (low, high) = self.carry(sum);
        let (zero, prime) = (self.all(0), pulp::cast(moduli.prime.0));
        // A multiple of the prime is subtracted from the high part, which is below 2^62: the rest
        // is below twice the prime.
        let upper = f._mm512_srli_epi64::<10>(high);
        let guess = ifma._mm512_madd52hi_epu64(zero, upper, pulp::cast(moduli.quotient.0));
        let multiple = ifma._mm512_madd52lo_epu64(zero, f._mm512_srli_epi64::<35>(guess), prime);
        let high = f._mm512_and_si512(f._mm512_sub_epi64(high, multiple), self.all((1 << 52) - 1));
        // Montgomery's step subtracts a multiple of the prime with the same low digits.
        let multiple = ifma._mm512_madd52lo_epu64(zero, low, pulp::cast(moduli.inverse.0));
        let taken = ifma._mm512_madd52hi_epu64(zero, multiple, prime);
        let residue = f._mm512_sub_epi64(f._mm512_add_epi64(high, prime), taken);
        let once = f._mm512_min_epu64(residue, f._mm512_sub_epi64(residue, prime));
        let twice = f._mm512_min_epu64(once, f._mm512_sub_epi64(once, prime));
        Lanes(pulp::cast(twice))
    }
    #[inline(always)]
    fn product(self, left: &Lanes, right: &Lanes, moduli: &Moduli) -> Lanes {
        let (f, ifma) = (self.avx512f, self.avx512ifma);
        let (zero, prime) = (self.all(0), pulp::cast(moduli.prime.0));
        let (low, high) = self.add((zero, zero), pulp::cast(left.0), pulp::cast(right.0));
        let multiple = ifma._mm512_madd52lo_epu64(zero, low, pulp::cast(moduli.inverse.0));
        let taken = ifma._mm512_madd52hi_epu64(zero, multiple, prime);
        let residue = f._mm512_sub_epi64(high, taken);
        Lanes(pulp::cast(f._mm512_min_epu64(residue, f._mm512_add_epi64(residue, prime))))
    }
    #[inline(always)]
    fn sum(self, left: &Lanes, right: &Lanes, moduli: &Moduli) -> Lanes {
        let f = self.avx512f;
        let sum = f._mm512_add_epi64(pulp::cast(left.0), pulp::cast(right.0));
        // A word below zero wraps around to a large one.
        let less = f._mm512_sub_epi64(sum, pulp::cast(moduli.prime.0));
        Lanes(pulp::cast(f._mm512_min_epu64(sum, less)))
    }
    #[inline(always)]
    fn difference(self, left: &Lanes, right: &Lanes, moduli: &Moduli) -> Lanes {
        let f = self.avx512f;
        let difference = f._mm512_sub_epi64(pulp::cast(left.0), pulp::cast(right.0));
        let more = f._mm512_add_epi64(difference, pulp::cast(moduli.prime.0));
        Lanes(pulp::cast(f._mm512_min_epu64(difference, more)))
    }
    #[inline(always)]
    fn vectorize<F: NullaryFnOnce>(self, function: F) -> F::Output {
        Self::vectorize(self, function)
    }
}
