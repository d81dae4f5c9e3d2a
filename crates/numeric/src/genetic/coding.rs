//! The genes of a point: its numbers, or each number as a string of bits.
//!
//! A gene of a string of bits is 0 or 1, the highest bit of a number first: with n bits it takes
//! 2^n evenly spaced values from the lower to the upper bound, so every string is a point of the
//! box.

use rand::{Rng, RngExt};

use super::space::Space;

/// The encoding of points as genes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Coding {
    /// A gene is a number.
    #[default]
    Real,
    /// Each number is a string of this many bits, with a gene for each bit.
    Bits(u32),
}

impl Coding {
    /// Returns the genes of a random point, drawn evenly.
    pub fn draw(self, space: &Space, generator: &mut impl Rng) -> Vec<f64> {
        match self {
            Self::Real => space.draw(generator),
            Self::Bits(bits) => {
                let count = bits as usize * space.bounds().len();
                let bit = |_| f64::from(u8::from(generator.random::<bool>()));
                (0..count).map(bit).collect()
            }
        }
    }

    /// Decodes genes into a point of the box.
    ///
    /// ```
    /// # use lindstedt_numeric as lindstedt;
    /// use lindstedt::genetic::{Coding, Space};
    ///
    /// let space = Space::new(vec![[0.0, 3.0]])?;
    /// assert_eq!(Coding::Bits(2).point(&[1.0, 0.0], &space), [2.0]);
    /// # Ok::<(), lindstedt::genetic::SearchError>(())
    /// ```
    pub fn point(self, genes: &[f64], space: &Space) -> Vec<f64> {
        match self {
            Self::Real => genes.to_vec(),
            Self::Bits(bits) => {
                let number = |bits: &[f64]| bits.iter().fold(0.0, |sum, bit| 2.0 * sum + bit);
                let largest = (f64::from(bits)).exp2() - 1.0;
                let parts: Vec<f64> = genes
                    .chunks(bits.max(1) as usize)
                    .map(|genes| number(genes) / largest)
                    .collect();
                space.point_at(&parts)
            }
        }
    }
}
