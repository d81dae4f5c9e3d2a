//! The approximate inverse of a derivative: a matrix on the block of low harmonics, whose entries
//! need not be correct.
//!
//! In: integers that a certificate claims to be the entries. Out: images of vectors and columns,
//! and their norms, in balls. The theorem defines the inverse beyond the block.

use crate::exact::Integer;
use crate::exact::ball::{Ball, Balls};
use crate::exact::ball_products::{BallFactor, BallProductSums};
use crate::exact::bound::Bound;

/// The precision in which the product of inverse and derivative is computed: only its distance from
/// the identity counts.
pub(super) const SHORT: Balls = Balls { bits: 80 };

/// The approximate inverse on a number and the harmonics of the block, which has the weight sigma
/// in the norm and the first row.
pub(super) struct Inverse {
    /// Its entries, row by row.
    entries: Vec<Vec<BallFactor>>,
    /// The number of binary digits that they have after the point.
    bits: usize,
    /// The weight of the first row.
    pub(super) sigma: Bound,
}

impl Inverse {
    /// Takes entries that are integers times `2^-bits`, and a first row of the weight `2^sigma`.
    pub(super) fn from_entries(entries: &[Vec<Integer>], bits: usize, sigma: i32) -> Self {
        let balls = Balls { bits };
        let entry = |entry| BallFactor::new(balls, &balls.dyadic(entry, bits));
        let entries = entries.iter().map(|row| row.iter().map(entry).collect()).collect();
        Self { entries, bits, sigma: Bound::power_of_two(sigma) }
    }

    /// The image of a vector, each of its sums rounded once.
    pub(super) fn image(&self, vector: &[Ball], balls: Balls) -> Vec<Ball> {
        let occurring = vector.iter().enumerate().filter(|(_, number)| !number.is_zero());
        let vector: Vec<(usize, BallFactor)> =
            occurring.map(|(column, number)| (column, BallFactor::new(balls, number))).collect();
        let factors = self.entries.iter().flatten().chain(vector.iter().map(|(_, number)| number));
        let mut sums = BallProductSums::new(self.entries.len(), factors);
        for (row, entries) in self.entries.iter().enumerate() {
            for (column, number) in &vector {
                if let Some(entry) = entries.get(*column) {
                    sums.add(entry, number, [(row, false)]);
                }
            }
        }
        sums.rounded(balls, self.bits, 0)
    }

    /// The norm of a vector on the number and the harmonics of the block.
    pub(super) fn norm(&self, vector: &[Ball], balls: Balls) -> Bound {
        let sizes = vector.iter().enumerate();
        sizes.map(|(row, ball)| self.weight(row) * balls.magnitude(ball)).sum()
    }

    /// The norm of a column.
    pub(super) fn norm_of_column(&self, column: usize) -> Bound {
        let rows = self.entries.iter().enumerate();
        rows.map(|(row, entries)| self.weight(row) * entries[column].magnitude()).sum()
    }

    /// Norm of `A c - e_place` for a column `c` of the derivative, A this inverse and `e_place` the
    /// unit vector (zero for `None`): how far A maps the column away from the unit column.
    pub(super) fn distance_from_unit(&self, column: &[Ball], place: Option<usize>) -> Bound {
        let mut image = self.image(column, SHORT);
        if let Some(place) = place {
            image[place] = SHORT.difference(&image[place], &SHORT.integer(1));
        }
        self.norm(&image, SHORT)
    }

    fn weight(&self, row: usize) -> Bound {
        if row == 0 { self.sigma } else { Bound::exactly(1.0) }
    }
}
