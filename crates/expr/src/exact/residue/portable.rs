//! Sums of products on any processor: residues of 30 bits, multiplied in words of 64 bits, which
//! compilers turn into the vector instructions of the processor.

use pulp::NullaryFnOnce;
#[cfg(not(target_arch = "x86_64"))]
use pulp::{Arch, Simd, WithSimd};

use super::{Arithmetic, Lanes, Moduli, WIDTH};

/// Any processor.
#[derive(Clone, Copy, Debug, Default)]
pub struct Portable;

/// The sum of the products not carried yet, and the sums of the low and of the high halves of those
/// that are.
#[derive(Clone, Copy)]
pub struct PortableSum {
    recent: Lanes,
    low: Lanes,
    high: Lanes,
}

/// The lower half of a word, which is all that a multiplication of half words uses.
#[inline(always)]
fn half(word: u64) -> u64 {
    word & 0xffff_ffff
}

impl Arithmetic for Portable {
    const BITS: u32 = 30;
    const RADIX: u32 = 32;
    const DIGIT: u32 = 30;
    // Sixteen products of 60 bits fill a word.
    const RUN: usize = 16;
    type Sum = PortableSum;

    #[inline(always)]
    fn none(self) -> PortableSum {
        let none = Lanes([0; WIDTH]);
        PortableSum { recent: none, low: none, high: none }
    }
    #[inline(always)]
    fn add_product(self, mut sum: PortableSum, left: &Lanes, right: &Lanes) -> PortableSum {
        for k in 0..WIDTH {
            sum.recent.0[k] =
                sum.recent.0[k].wrapping_add(half(left.0[k]).wrapping_mul(half(right.0[k])));
        }
        sum
    }
    #[inline(always)]
    fn add_multiple(self, mut sum: PortableSum, left: u64, right: &Lanes) -> PortableSum {
        for k in 0..WIDTH {
            sum.recent.0[k] =
                sum.recent.0[k].wrapping_add(half(left).wrapping_mul(half(right.0[k])));
        }
        sum
    }
    #[inline(always)]
    fn carry(self, mut sum: PortableSum) -> PortableSum {
        for k in 0..WIDTH {
            sum.low.0[k] = sum.low.0[k].wrapping_add(half(sum.recent.0[k]));
            sum.high.0[k] = sum.high.0[k].wrapping_add(sum.recent.0[k] >> 32);
            sum.recent.0[k] = 0;
        }
        sum
    }
    #[inline(always)]
    fn merge(self, mut sum: PortableSum, right: PortableSum) -> PortableSum {
        for k in 0..WIDTH {
            sum.recent.0[k] = sum.recent.0[k].wrapping_add(right.recent.0[k]);
            sum.low.0[k] = sum.low.0[k].wrapping_add(right.low.0[k]);
            sum.high.0[k] = sum.high.0[k].wrapping_add(right.high.0[k]);
        }
        sum
    }
    #[inline(always)]
    fn join(self, left: PortableSum, right: PortableSum) -> PortableSum {
        self.merge(self.carry(left), self.carry(right))
    }
    #[inline(always)]
    fn parts(self, sum: PortableSum) -> (Lanes, Lanes) {
        let sum = self.carry(sum);
        (sum.low, sum.high)
    }
    #[inline(always)]
    fn reduce(self, sum: PortableSum, moduli: &Moduli) -> Lanes {
        let sum = self.carry(sum);
        let mut residues = Lanes::default();
        for k in 0..WIDTH {
            let prime = moduli.prime.0[k];
            // The steps are those of the wide arithmetic, with a high part below 2^42.
            let low = half(sum.low.0[k]);
            let high = sum.high.0[k].wrapping_add(sum.low.0[k] >> 32);
            let guess = half(high >> 10).wrapping_mul(half(moduli.quotient.0[k])) >> 47;
            let high = high.wrapping_sub(half(guess).wrapping_mul(half(prime)));
            let multiple = half(low.wrapping_mul(half(moduli.inverse.0[k])));
            let taken = multiple.wrapping_mul(half(prime)) >> 32;
            let residue = high.wrapping_add(prime).wrapping_sub(taken);
            let once = residue.min(residue.wrapping_sub(prime));
            residues.0[k] = once.min(once.wrapping_sub(prime));
        }
        residues
    }
    #[inline(always)]
    fn sum(self, left: &Lanes, right: &Lanes, moduli: &Moduli) -> Lanes {
        let mut sums = Lanes::default();
        for k in 0..WIDTH {
            let sum = left.0[k].wrapping_add(right.0[k]);
            sums.0[k] = sum.min(sum.wrapping_sub(moduli.prime.0[k]));
        }
        sums
    }
    #[inline(always)]
    fn difference(self, left: &Lanes, right: &Lanes, moduli: &Moduli) -> Lanes {
        let mut differences = Lanes::default();
        for k in 0..WIDTH {
            let difference = left.0[k].wrapping_sub(right.0[k]);
            differences.0[k] = difference.min(difference.wrapping_add(moduli.prime.0[k]));
        }
        differences
    }
    #[inline(always)]
    fn vectorize<F: NullaryFnOnce>(self, function: F) -> F::Output {
        // On x86-64 the other arithmetics use the better vector instructions, so there is nothing
        // to choose here.
        #[cfg(target_arch = "x86_64")]
        return function.call();
        #[cfg(not(target_arch = "x86_64"))]
        return Arch::new().dispatch(Vectorized(function));
    }
}

/// A function compiled for every set of vector instructions.
#[cfg(not(target_arch = "x86_64"))]
struct Vectorized<F>(F);

#[cfg(not(target_arch = "x86_64"))]
impl<F: NullaryFnOnce> WithSimd for Vectorized<F> {
    type Output = F::Output;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> F::Output {
        self.0.call()
    }
}
