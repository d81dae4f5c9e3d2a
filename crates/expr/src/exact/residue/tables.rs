//! Tables of lanes: a row of each for every point, with an entry for each order.

use super::Lanes;

/// Several tables with the same number of rows in one memory. The rows of all tables for one point
/// lie next to each other, since they are used together.
pub struct Tables<'m> {
    rows: usize,
    /// The distance between consecutive rows of one table, in entries.
    stride: usize,
    /// For each table the offset of its rows within those of a point, and their length.
    places: Vec<(usize, usize)>,
    entries: &'m mut [Lanes],
}

impl<'m> Tables<'m> {
    /// Number of entries of tables with rows of these lengths.
    pub fn entry_count(rows: usize, lengths: &[usize]) -> usize {
        rows * lengths.iter().sum::<usize>()
    }

    /// Tables with rows of these lengths, in that much [room](Self::entry_count).
    pub fn new(rows: usize, lengths: &[usize], entries: &'m mut [Lanes]) -> Self {
        let mut stride = 0;
        let mut places = Vec::with_capacity(lengths.len());
        for length in lengths {
            places.push((stride, *length));
            stride += length;
        }
        Self { rows, stride, places, entries }
    }

    /// Number of rows of each table.
    #[inline(always)]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Index of an order in the rows of a table; in rows too short for all orders a late order
    /// takes the place of an earlier one.
    #[inline(always)]
    pub fn offset(&self, table: usize, order: usize) -> usize {
        let length = self.places[table].1;
        if order < length { order } else { order % length }
    }

    /// All entries of a row.
    #[inline(always)]
    pub fn row(&self, table: usize, row: usize) -> &[Lanes] {
        let (begin, length) = self.places[table];
        &self.entries[row.wrapping_mul(self.stride).wrapping_add(begin)..][..length]
    }

    /// One entry, for writing.
    #[inline(always)]
    pub fn entry(&mut self, table: usize, row: usize, place: usize) -> &mut Lanes {
        let begin = self.places[table].0;
        &mut self.entries[row.wrapping_mul(self.stride).wrapping_add(begin).wrapping_add(place)]
    }

    /// Writes the entries at one place of the first rows, one value for each row.
    #[inline(always)]
    pub fn write(&mut self, table: usize, place: usize, values: &[Lanes]) {
        let begin = self.places[table].0;
        for (row, value) in self.entries.chunks_exact_mut(self.stride.max(1)).zip(values) {
            row[begin + place] = *value;
        }
    }
}
