//! Eight residues side by side, and the arithmetic that sums their products.

use pulp::NullaryFnOnce;

use super::Moduli;

/// Number of residues side by side.
pub const WIDTH: usize = 8;

/// Eight residues, of one prime or of eight.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
// The alignment is a cache line, so that no load touches two.
#[repr(C, align(64))]
pub struct Lanes(pub [u64; WIDTH]);

impl Lanes {
    /// One value in all eight lanes.
    #[inline(always)]
    pub fn all(value: u64) -> Self {
        Self([value; WIDTH])
    }
}

/// Sums of products of eight residues at a time. A sum is kept unreduced, which makes it fast.
pub trait Arithmetic: Copy + Send + Sync {
    /// The primes lie between half of `2^BITS` and `2^BITS`.
    const BITS: u32;
    /// The radix of `Modulus::new`.
    const RADIX: u32;
    /// Number of bits of a digit that may be multiplied by a residue and summed like a residue.
    const DIGIT: u32;
    /// Number of products after which a sum has to be [carried](Self::carry).
    const RUN: usize;
    /// Eight sums of products.
    type Sum: Copy;

    /// Eight empty sums.
    fn none(self) -> Self::Sum;
    /// `sum + left right`.
    fn add_product(self, sum: Self::Sum, left: &Lanes, right: &Lanes) -> Self::Sum;
    /// `sum + left right` with the same `left` in all lanes.
    fn add_multiple(self, sum: Self::Sum, left: u64, right: &Lanes) -> Self::Sum;
    /// Makes room for another [run](Self::RUN): 2^13 products at most in all.
    fn carry(self, sum: Self::Sum) -> Self::Sum;
    /// Adds two sums that together have at most one [run](Self::RUN) of products.
    fn merge(self, left: Self::Sum, right: Self::Sum) -> Self::Sum;
    /// Adds two carried sums, each with room for the other.
    fn join(self, left: Self::Sum, right: Self::Sum) -> Self::Sum;
    /// The low and the high parts of carried sums: `low + 2^RADIX high`.
    fn parts(self, sum: Self::Sum) -> (Lanes, Lanes);
    /// The sums divided by `R`, as residues; in Montgomery's form if both factors of the products
    /// were.
    fn reduce(self, sum: Self::Sum, moduli: &Moduli) -> Lanes;
    /// The products of residues.
    #[inline(always)]
    fn product(self, left: &Lanes, right: &Lanes, moduli: &Moduli) -> Lanes {
        self.reduce(self.add_product(self.none(), left, right), moduli)
    }
    /// The sums of residues.
    fn sum(self, left: &Lanes, right: &Lanes, moduli: &Moduli) -> Lanes;
    /// The differences of residues.
    fn difference(self, left: &Lanes, right: &Lanes, moduli: &Moduli) -> Lanes;
    /// Runs a function compiled for this processor.
    fn vectorize<F: NullaryFnOnce>(self, function: F) -> F::Output;
}
