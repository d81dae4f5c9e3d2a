//! Eight residues side by side, and rows of them.

use pulp::NullaryFnOnce;

use super::Modulus;

/// How many residues stand side by side.
pub const WIDTH: usize = 8;

/// Eight residues of one prime.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
// One line of the cache, so that no load touches two.
#[repr(align(64))]
pub struct Lanes(pub [u64; WIDTH]);

impl Lanes {
    /// The same eight times.
    #[inline(always)]
    pub fn all(value: u64) -> Self {
        Self([value; WIDTH])
    }
}

/// A length that whole [`Lanes`] fill.
pub fn padded(length: usize) -> usize {
    length.next_multiple_of(WIDTH)
}

/// How eight products at a time are summed. A sum is kept unreduced: that is where the speed comes from.
pub trait Arithmetic: Copy + Send + Sync {
    /// The primes lie between half of `2^BITS` and `2^BITS`.
    const BITS: u32;
    /// Of [`Modulus::new`].
    const RADIX: u32;
    /// Digits that may be multiplied by a residue and summed as residues are.
    const DIGIT: u32;
    /// After so many products a sum has to be [carried](Self::carry).
    const RUN: usize;
    /// Eight sums of products.
    type Sum: Copy;

    /// Eight empty sums.
    fn none(self) -> Self::Sum;
    /// `sum + left right`.
    fn add_product(self, sum: Self::Sum, left: &Lanes, right: &Lanes) -> Self::Sum;
    /// `sum + left right` with the same `left` for all.
    fn add_multiple(self, sum: Self::Sum, left: u64, right: &Lanes) -> Self::Sum;
    /// Makes room for another [run](Self::RUN): 2^13 products at most in all.
    fn carry(self, sum: Self::Sum) -> Self::Sum;
    /// The sum of two that have not more products than one [run](Self::RUN) together.
    fn merge(self, left: Self::Sum, right: Self::Sum) -> Self::Sum;
    /// The sum of two, each with room for another.
    fn join(self, left: Self::Sum, right: Self::Sum) -> Self::Sum;
    /// The low and the high parts of carried sums: `low + 2^RADIX high`.
    fn parts(self, sum: Self::Sum) -> (Lanes, Lanes);
    /// The sums divided by `R` as residues, in Montgomery's form where both factors were.
    fn reduce(self, sum: Self::Sum, modulus: &Modulus) -> Lanes;
    /// The product of two residues.
    #[inline(always)]
    fn product(self, left: &Lanes, right: &Lanes, modulus: &Modulus) -> Lanes {
        self.reduce(self.add_product(self.none(), left, right), modulus)
    }
    /// Runs a function compiled for this processor.
    fn vectorize<F: NullaryFnOnce>(self, function: F) -> F::Output;
}

/// Residues in a table: for every eight points (or harmonics) side by side one row, with an entry for each order.
#[derive(Clone, Debug)]
pub struct Rows {
    blocks: usize,
    orders: usize,
    entries: Vec<Lanes>,
}

impl Rows {
    /// Zeros, for `length` points and `orders` orders.
    pub fn new(length: usize, orders: usize) -> Self {
        let blocks = length.div_ceil(WIDTH);
        Self {
            blocks,
            orders,
            entries: vec![Lanes::default(); blocks * orders],
        }
    }

    /// How many rows there are: an eighth of the points, rounded up.
    #[inline(always)]
    pub fn blocks(&self) -> usize {
        self.blocks
    }

    /// Eight points at every order.
    #[inline(always)]
    pub fn row(&self, block: usize) -> &[Lanes] {
        &self.entries[block.wrapping_mul(self.orders)..][..self.orders]
    }

    /// Eight points at one order, to be written.
    #[inline(always)]
    pub fn entry(&mut self, block: usize, order: usize) -> &mut Lanes {
        &mut self.entries[block.wrapping_mul(self.orders).wrapping_add(order)]
    }

    /// Writes one order of the first points, whole [`Lanes`] of them.
    pub fn write(&mut self, order: usize, values: &[u64]) {
        for (block, values) in values.chunks_exact(WIDTH).enumerate() {
            self.entry(block, order).0.copy_from_slice(values);
        }
    }

    /// One order of all points.
    pub fn read(&self, order: usize) -> Vec<u64> {
        (0..self.blocks).flat_map(|block| self.row(block)[order].0).collect()
    }

    /// Writes one order of one point.
    pub fn set(&mut self, point: usize, order: usize, value: u64) {
        self.entry(point / WIDTH, order).0[point % WIDTH] = value;
    }

    /// One order of one point.
    pub fn get(&self, point: usize, order: usize) -> u64 {
        self.row(point / WIDTH)[order].0[point % WIDTH]
    }
}
