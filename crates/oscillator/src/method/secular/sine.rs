//! The sine of the motion by its differential equation, for a force that is the whole series of a
//! sine.
//!
//! Reference: D. E. Knuth, *The Art of Computer Programming*, volume 2, 3rd ed. 1998, section 4.7
//! (functions of power series).
//!
//! ```text
//! S = sin(sqrt(-k delta) y)/sqrt(-k delta) = y + k delta y^3/3! + k^2 delta^2 y^5/5! + ...,   C = cos(sqrt(-k delta) y)
//! V_n = (n + 1/2) y_n:    (n + 1/2) S_n = sum C_(n-i) V_i,    n C_n = k sum S_(n-1-i) V_i
//! ```
//!
//! Two products for each order take the place of one for each power: `k = -1` is the pendulum's.

use num_traits::{One, Zero};

use super::plan::PlannedTerm;
use crate::exact::residue::sums::{MixtureTerm, Product};
use crate::exact::residue::{Arithmetic, Lanes, Residues};
use crate::exact::{Integer, Rational};

/// Indices of the tables of the sine.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sine {
    /// `V`.
    pub scaled: usize,
    /// `S`.
    pub sine: usize,
    /// `C`.
    pub cosine: usize,
    /// The sum of all `C_(n-i) V_i`, the last one left out until it is known.
    pub of_sine: Product,
    /// The sum of all `S_(n-i) V_i`.
    pub of_cosine: Product,
}

impl Sine {
    /// Tables from `first` on; their number is [`Self::TABLES`].
    pub fn new(first: usize, last: usize) -> Self {
        let product = |left, to| Product { left, right: first, to, needed: last };
        Self {
            scaled: first,
            sine: first + 1,
            cosine: first + 2,
            of_sine: product(first + 2, first + 3),
            of_cosine: product(first + 1, first + 4),
        }
    }

    /// Number of tables.
    pub const TABLES: usize = 5;
}

/// The rate `k` of a sine that the terms contain up to an order, and the remaining terms.
pub(super) fn split(
    mut terms: Vec<PlannedTerm>,
    highest: usize,
) -> (Option<Rational>, Vec<PlannedTerm>) {
    /// Number of terms below which separate powers are as fast.
    const LONG: usize = 6;
    let enough = (LONG..=terms.len()).contains(&highest);
    let rate = if enough { rate(&terms, highest) } else { None };
    if rate.is_some() {
        terms.retain(|term| sine_index(term).is_none());
    }
    (rate, terms)
}

/// The index of a term in the series of the sine: `n` for `delta^n y^(2n+1)`.
fn sine_index(term: &PlannedTerm) -> Option<usize> {
    let own = term.velocity == 0 && term.position as usize == 2 * term.order + 1;
    own.then_some(term.order)
}

fn rate(terms: &[PlannedTerm], highest: usize) -> Option<Rational> {
    let coefficient = |n: usize| {
        let mut own = terms.iter().filter(|term| sine_index(term) == Some(n));
        own.next().filter(|_| own.next().is_none()).map(|term| &term.coefficient)
    };
    let rate = coefficient(1)? * Rational::from_integer(Integer::from(6));
    // Numerator and denominator of `rate^n/(2n+1)!`, not in lowest terms.
    let (mut numerator, mut denominator) = (Integer::one(), Integer::one());
    for n in 1..=highest {
        numerator *= rate.numer();
        denominator *= rate.denom() * Integer::from(2 * n * (2 * n + 1));
        let own = coefficient(n)?;
        if own.numer() * &denominator != own.denom() * &numerator {
            return None;
        }
    }
    (!rate.is_zero()).then_some(rate)
}

/// Factors of the recursion, modulo eight primes.
pub(super) struct SineFactors {
    /// `n + 1/2`.
    scaled: Vec<Lanes>,
    /// `1/(n + 1/2)`.
    sine: Vec<Lanes>,
    /// `k/(n + 1)`.
    cosine: Vec<Lanes>,
}

impl SineFactors {
    /// `None` if a prime divides a denominator.
    #[inline(always)]
    pub fn new<A: Arithmetic>(residues: &Residues<A>, rate: Lanes, last: usize) -> Option<Self> {
        let one = residues.one();
        // 1/1, 1/2, ...
        let mut inverses = vec![one; 2 * last + 2];
        for (place, inverse) in inverses.iter_mut().enumerate() {
            *inverse = residues.small(place + 1);
        }
        residues.invert(&mut inverses)?;
        let mut factors = Self {
            scaled: vec![one; last + 1],
            sine: vec![one; last + 1],
            cosine: vec![one; last + 1],
        };
        for order in 0..=last {
            factors.scaled[order] = residues.sum(residues.small(order), inverses[1]);
            factors.sine[order] = residues.sum(inverses[2 * order], inverses[2 * order]);
            factors.cosine[order] = residues.product(rate, inverses[order]);
        }
        Some(factors)
    }

    /// `V_n` from `y_n`, which stands in the first table.
    pub fn scaled(&self, order: usize) -> MixtureTerm {
        MixtureTerm { factor: self.scaled[order], table: 0, order }
    }

    /// `S_n` without the contribution of `y_n`.
    pub fn sine(&self, sine: &Sine, order: usize) -> MixtureTerm {
        MixtureTerm { factor: self.sine[order], table: sine.of_sine.to, order }
    }

    /// `C_(n+1)`.
    pub fn cosine(&self, sine: &Sine, order: usize) -> MixtureTerm {
        MixtureTerm { factor: self.cosine[order], table: sine.of_cosine.to, order }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::factorial;

    #[test]
    fn a_sine_is_known_by_all_of_its_terms() {
        let term = |order: usize, coefficient: Rational| PlannedTerm {
            order,
            position: 2 * order as u32 + 1,
            velocity: 0,
            coefficient,
        };
        let third = Rational::new(Integer::from(-1), Integer::from(3));
        let mut power = Rational::one();
        let mut terms: Vec<PlannedTerm> = (1..=8)
            .map(|n| {
                power *= &third;
                term(n, &power / Rational::from_integer(factorial(2 * n as u32 + 1)))
            })
            .collect();
        terms.push(PlannedTerm {
            order: 1,
            position: 1,
            velocity: 2,
            coefficient: Rational::one(),
        });
        let (rate, others) = split(terms.clone(), 8);
        assert_eq!(rate, Some(third));
        assert_eq!((others.len(), others[0].velocity), (1, 2));
        // One term too few, and one that is not a term of a sine.
        assert_eq!(split(terms.clone(), 9).0, None);
        terms[4].coefficient *= Rational::from_integer(Integer::from(2));
        let (rate, others) = split(terms.clone(), 8);
        assert_eq!((rate, others.len()), (None, 9));
    }
}
