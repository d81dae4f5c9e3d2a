//! The approximate inverse of a derivative: a matrix on the block of low harmonics, whose entries
//! need not be correct.
//!
//! In: integers that a certificate claims to be the entries. Out: images of vectors and columns,
//! and their norms, in balls. The theorem defines the inverse beyond the block.

use crate::exact::Integer;
use crate::exact::ball::{Ball, Balls};
use crate::exact::bound::Bound;

use super::fourier_series::WORKING;

/// The precision in which the product of inverse and derivative is computed: only its distance from
/// the identity counts.
pub(super) const SHORT: Balls = Balls { bits: 80 };

/// The approximate inverse on a number and the harmonics of the block, which has the weight sigma
/// in the norm and the first row.
pub(super) struct Inverse {
    /// Its entries in full, row by row.
    pub(super) entries: Vec<Vec<Ball>>,
    /// The entries rounded to the precision of [`SHORT`].
    pub(super) short: Vec<Vec<Ball>>,
    /// The weight of the first row.
    pub(super) sigma: Bound,
}

impl Inverse {
    /// Takes entries that are integers times `2^-bits`, and a first row of the weight `2^sigma`.
    pub(super) fn from_entries(entries: &[Vec<Integer>], bits: usize, sigma: i32) -> Self {
        let rows = |balls: Balls| {
            let row =
                |row: &Vec<Integer>| row.iter().map(|entry| balls.dyadic(entry, bits)).collect();
            entries.iter().map(row).collect()
        };
        Self { entries: rows(WORKING), short: rows(SHORT), sigma: Bound::power_of_two(sigma) }
    }

    /// The norm of a vector on the number and the harmonics of the block.
    pub(super) fn norm(&self, vector: &[Ball], balls: Balls) -> Bound {
        let sizes = vector.iter().enumerate();
        sizes.map(|(row, ball)| self.weight(row) * balls.magnitude(ball)).sum()
    }

    /// The norm of a column.
    pub(super) fn norm_of_column(&self, column: usize) -> Bound {
        let column: Vec<Ball> = self.entries.iter().map(|row| row[column].clone()).collect();
        self.norm(&column, WORKING)
    }

    /// Norm of `A c - e_place` for a column `c` of the derivative, A this inverse and `e_place` the
    /// unit vector (zero for `None`): how far A maps the column away from the unit column.
    pub(super) fn distance_from_unit(&self, column: &[Ball], place: Option<usize>) -> Bound {
        let mut image = image(&self.short, column, SHORT);
        if let Some(place) = place {
            image[place] = SHORT.difference(&image[place], &SHORT.integer(1));
        }
        self.norm(&image, SHORT)
    }

    fn weight(&self, row: usize) -> Bound {
        if row == 0 { self.sigma } else { Bound::exactly(1.0) }
    }
}

/// A matrix times a vector, each sum rounded once.
pub(super) fn image(matrix: &[Vec<Ball>], vector: &[Ball], balls: Balls) -> Vec<Ball> {
    let row = |row: &Vec<Ball>| {
        let (mut units, mut radius) = (Integer::default(), Bound::ZERO);
        for (entry, number) in row.iter().zip(vector).filter(|(_, number)| !number.is_zero()) {
            units += &entry.middle * &number.middle;
            radius += balls.radius_of_product(entry, number);
        }
        balls.rounded(&units, radius)
    };
    matrix.iter().map(row).collect()
}
