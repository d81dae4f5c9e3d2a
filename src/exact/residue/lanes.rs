//! Eight residues side by side, rows of them, and what sums their products.

use pulp::NullaryFnOnce;

use super::Moduli;

/// How many residues stand side by side.
pub const WIDTH: usize = 8;

/// Eight residues, of one prime or of eight.
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
    fn reduce(self, sum: Self::Sum, moduli: &Moduli) -> Lanes;
    /// The products of residues.
    #[inline(always)]
    fn product(self, left: &Lanes, right: &Lanes, moduli: &Moduli) -> Lanes {
        self.reduce(self.add_product(self.none(), left, right), moduli)
    }
    /// The sums of residues.
    fn sum(self, left: &Lanes, right: &Lanes, moduli: &Moduli) -> Lanes;
    /// The differences.
    fn difference(self, left: &Lanes, right: &Lanes, moduli: &Moduli) -> Lanes;
    /// Runs a function compiled for this processor.
    fn vectorize<F: NullaryFnOnce>(self, function: F) -> F::Output;
}

/// Lanes in a table, row by row: for every point (or harmonic) one row, with an entry for each order.
#[derive(Clone, Debug)]
pub struct Rows {
    rows: usize,
    length: usize,
    entries: Vec<Lanes>,
}

impl Rows {
    /// Zeros.
    pub fn new(rows: usize, length: usize) -> Self {
        Self {
            rows,
            length,
            entries: vec![Lanes::default(); rows * length],
        }
    }

    /// How many rows there are.
    #[inline(always)]
    pub fn count(&self) -> usize {
        self.rows
    }

    /// Where an order stands: in rows too short for all of them, instead of one before it.
    #[inline(always)]
    pub fn place(&self, order: usize) -> usize {
        if order < self.length {
            order
        } else {
            order % self.length
        }
    }

    /// All entries of a row.
    #[inline(always)]
    pub fn row(&self, row: usize) -> &[Lanes] {
        &self.entries[row.wrapping_mul(self.length)..][..self.length]
    }

    /// One entry, to be written.
    #[inline(always)]
    pub fn entry(&mut self, row: usize, place: usize) -> &mut Lanes {
        &mut self.entries[row.wrapping_mul(self.length).wrapping_add(place)]
    }

    /// Writes the same place of the first rows.
    #[inline(always)]
    pub fn write(&mut self, place: usize, values: &[Lanes]) {
        for (row, value) in self.entries.chunks_exact_mut(self.length.max(1)).zip(values) {
            row[place] = *value;
        }
    }
}
