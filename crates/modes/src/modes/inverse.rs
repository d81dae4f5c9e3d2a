//! The motion of each harmonic under a force: `(K - k^2 lambda M) q_k = r_k`.
//!
//! A matrix of numbers is inverted; in the modal coordinates of two coordinates in closed form it is
//! diagonal, with the entries `lambda_j - k^2 lambda`. For k = 1 the mode itself is left out. Where
//! `k^2 lambda` is the root of another mode, that one is left out too, and a force along it is an
//! internal resonance.

use num_traits::{One, Zero};

use super::linear::{DIGITS, LinearModes, NumberModes, TwoModes, tidied};
use super::matrix::{self, Matrix, Tidy};
use crate::decimal::rounded_fraction;
use crate::exact::{Polynomial, Rational};
use crate::expr::Expr;
use crate::solution::Definition;
use crate::symbol::{Symbol, fresh};

/// The inverse of `K - k^2 lambda M`.
#[derive(Clone, Debug)]
pub(super) struct HarmonicInverse {
    /// The entries, a row for each unknown.
    pub(super) entries: Vec<Vec<Polynomial>>,
    /// The index of the mode that resonates, where the matrix is singular for k other than 1, and the
    /// vectors u against which the force must be zero.
    pub(super) resonant: Option<(usize, Vec<Vec<Polynomial>>)>,
}

/// The inverses for the harmonics of one mode, with the names of their divisors.
pub(super) struct HarmonicInverses<'a> {
    modes: &'a LinearModes,
    index: usize,
    square: &'a Polynomial,
    taken: Vec<Symbol>,
    /// The divisors `lambda_j - k^2 lambda` that are sums of letters, by name.
    pub(super) definitions: Vec<Definition>,
}

impl<'a> HarmonicInverses<'a> {
    /// The inverses for a mode with its `square`, lambda; `taken` are the names in use.
    pub(super) fn new(
        modes: &'a LinearModes,
        index: usize,
        square: &'a Polynomial,
        taken: Vec<Symbol>,
    ) -> Self {
        Self { modes, index, square, taken, definitions: vec![] }
    }

    /// The inverse for a harmonic; `None` if it cannot be formed.
    pub(super) fn of(&mut self, harmonic: usize) -> Option<HarmonicInverse> {
        match self.modes {
            LinearModes::Numbers(modes) => self.of_numbers(modes, harmonic),
            LinearModes::Two(modes) => self.of_two(modes, harmonic),
        }
    }

    fn of_numbers(&self, modes: &NumberModes, harmonic: usize) -> Option<HarmonicInverse> {
        let own = &modes.roots[self.index];
        let lambda = &own.value * Rational::from_integer((harmonic * harmonic).into());
        let near = |root: &Rational| match own.exact {
            true => *root == lambda,
            // Both are of as many digits, less those that the factor takes.
            false => rounded_fraction(root, DIGITS - 10) == rounded_fraction(&lambda, DIGITS - 10),
        };
        let matrix = modes.matrix_at(&lambda);
        let tidy = |entry: &Rational| tidied(entry, own.exact);
        let resonates = modes.roots.iter().position(|root| near(&root.value));
        let (entries, resonant) = match resonates {
            None => (matrix::inverse(&matrix, &tidy)?, None),
            Some(other) if modes.roots.iter().filter(|root| near(&root.value)).count() > 1 => {
                // Several modes resonate: a force on any coordinate may drive one of them.
                let count = matrix.len();
                let unit = |i: usize| -> Vec<Polynomial> {
                    (0..count).map(|j| super::linear::whole((i == j).into())).collect()
                };
                let entries = vec![vec![Polynomial::zero(); count]; count];
                let resonant = Some((other, (0..count).map(unit).collect()));
                return Some(HarmonicInverse { entries, resonant });
            }
            Some(other) => {
                let shape = matrix::null_vector(&matrix, &tidy);
                let left = matrix::null_vector(&matrix::transposed(&matrix), &tidy);
                let entries = bordered_inverse(&matrix, &modes.mass, &shape, &left, &tidy)?;
                let left = left.into_iter().map(Polynomial::constant).collect();
                (entries, (other != self.index).then_some((other, vec![left])))
            }
        };
        let entry = |entry: Rational| {
            Polynomial::constant(match own.exact {
                true => entry,
                false => rounded_fraction(&entry, DIGITS),
            })
        };
        let entries = entries.into_iter().map(|row| row.into_iter().map(entry).collect()).collect();
        Some(HarmonicInverse { entries, resonant })
    }

    fn of_two(&mut self, modes: &TwoModes, harmonic: usize) -> Option<HarmonicInverse> {
        let square = Rational::from_integer((harmonic * harmonic).into());
        let mut entries = vec![vec![Polynomial::zero(); 2]; 2];
        if harmonic != 1 {
            // lambda - k^2 lambda
            let factor = (Rational::one() - &square).recip();
            entries[self.index][self.index] =
                self.square.power(-1)?.product(&Polynomial::constant(factor));
        }
        let other = 1 - self.index;
        let less = |of: &Polynomial, own: &Polynomial| {
            let mut moved = own.product(&Polynomial::constant(-square.clone()));
            moved.accumulate(of);
            moved
        };
        let divisor = match (&modes.explicit[other], &modes.explicit[self.index]) {
            (Some(of), Some(own)) => less(of, own),
            _ => less(&modes.modes[other].square, self.square),
        };
        let mut resonant = None;
        if divisor.is_zero() {
            resonant = Some((other, vec![super::linear::unit(other)]));
        } else {
            entries[other][other] =
                divisor.power(-1).or_else(|| self.named(&divisor, harmonic).power(-1))?;
        }
        Some(HarmonicInverse { entries, resonant })
    }

    /// The name of a divisor.
    fn named(&mut self, divisor: &Polynomial, harmonic: usize) -> Polynomial {
        let symbol = fresh(&format!("d{harmonic}"), &self.taken);
        self.taken.push(symbol);
        self.definitions.push(Definition { symbol, meaning: Expr::from(divisor) });
        Polynomial::symbol(symbol)
    }
}

/// The solution of `S q = r` with `u^T M q = 0`, for a matrix S with the null vectors v and u: the
/// first block of the inverse of `[S, M v; u^T M, 0]`.
fn bordered_inverse(
    singular: &Matrix,
    mass: &Matrix,
    shape: &[Rational],
    left: &[Rational],
    tidy: Tidy,
) -> Option<Matrix> {
    let count = shape.len();
    let column = matrix::applied(mass, shape);
    let row = matrix::applied(&matrix::transposed(mass), left);
    let mut bordered: Matrix = singular
        .iter()
        .zip(column)
        .map(|(row, last)| row.iter().cloned().chain([last]).collect())
        .collect();
    bordered.push(row.into_iter().chain([Rational::zero()]).collect());
    let inverse = matrix::inverse(&bordered, tidy)?;
    Some(inverse[..count].iter().map(|row| row[..count].to_vec()).collect())
}
