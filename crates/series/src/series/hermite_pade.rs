//! Hermite-Padé approximants: polynomials for which a combination of power series vanishes to the
//! highest order that their number of coefficients allows.
//!
//! References: B. Beckermann, G. Labahn, *A uniform approach for the fast computation of
//! matrix-type Padé approximants*, SIAM J. Matrix Anal. Appl. 15 (1994) 804-823; G. A. Baker, P.
//! Graves-Morris, *Padé Approximants*, 2nd ed., Cambridge 1996, section 8.5.
//!
//! ```text
//! p_1 f_1 + ... + p_m f_m = O(s^n),   deg p_l <= d_l,   n = d_1 + ... + d_m + m - 1
//! Padé: f, -1      quadratic: 1, f, f^2      differential: 1, f, f'
//! ```
//!
//! The order is raised by one at a time. Of `m` combinations that vanish to an order, the pivot
//! loses its next power by a factor `s`, and the others by subtracting a multiple of the pivot,
//! which is the combination with most room below its degrees. The approximants to all lower orders
//! arise on the way. Cost: `3 m n^2/2` products.

pub mod by_primes;

/// A field of numbers: residues modulo a prime, or floating-point numbers of many digits.
pub(crate) trait Field {
    /// A number.
    type Element: Clone;

    /// Zero.
    fn zero(&self) -> Self::Element;
    /// One.
    fn one(&self) -> Self::Element;
    /// `numerator/denominator`, the denominator not zero.
    fn quotient(&self, numerator: &Self::Element, denominator: &Self::Element) -> Self::Element;
    /// `number -= factor other`.
    fn subtract(&self, number: &mut Self::Element, factor: &Self::Element, other: &Self::Element);
    /// The binary exponent of the absolute value; `None` for zero. It is the same for all other
    /// numbers in a field without absolute values.
    fn exponent(&self, number: &Self::Element) -> Option<i64>;
    /// Number of binary digits by which a number must be smaller than its terms to count as zero;
    /// `None` for exact numbers.
    fn noise(&self) -> Option<i64>;
}

/// A linear combination of the series with polynomial factors.
#[derive(Clone, Debug)]
pub(crate) struct Combination<E> {
    /// The polynomial factor of each of the series, the lowest power first.
    pub factors: Vec<Vec<E>>,
    /// The sum, the lowest power first, without the powers that have vanished.
    remainder: Vec<E>,
    /// Number of further factors `s` that the degrees allow.
    pub room: i64,
}

/// Combinations of series, each vanishing to the same order.
pub(crate) struct HermitePade<F: Field> {
    field: F,
    combinations: Vec<Combination<F::Element>>,
    order: usize,
}

impl<F: Field> HermitePade<F> {
    /// Starts with the series, all of the same length, each with the largest degree of its factor.
    pub fn new(field: F, series: Vec<(Vec<F::Element>, usize)>) -> Self {
        let count = series.len();
        let combination = |(own, (remainder, degree)): (usize, (Vec<F::Element>, usize))| {
            let mut factors = vec![vec![]; count];
            factors[own] = vec![field.one()];
            Combination { factors, remainder, room: degree as i64 }
        };
        Self {
            combinations: series.into_iter().enumerate().map(combination).collect(),
            field,
            order: 0,
        }
    }

    /// The order to which all combinations vanish.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Returns the combination with most room below its degrees.
    pub fn best(&self) -> &Combination<F::Element> {
        let best = self.combinations.iter().rev().max_by_key(|combination| combination.room);
        best.expect("a series at least")
    }

    /// Makes all combinations vanish to one more order.
    pub fn advance(&mut self) {
        let leading: Vec<Option<i64>> =
            self.combinations.iter().map(|own| self.leading(own)).collect();
        let candidates = self.combinations.iter().zip(&leading).enumerate();
        let pivot = candidates
            .filter_map(|(place, (own, exponent))| Some((own.room, (*exponent)?, place)))
            .max_by_key(|(room, exponent, place)| (*room, *exponent, std::cmp::Reverse(*place)));
        self.order += 1;
        let Some((_, _, pivot)) = pivot else {
            for combination in self.combinations.iter_mut().filter(|own| !own.remainder.is_empty())
            {
                combination.remainder.remove(0);
            }
            return;
        };
        let mut chosen = self.combinations.remove(pivot);
        let mut leading = leading;
        leading.remove(pivot);
        for (combination, leading) in self.combinations.iter_mut().zip(leading) {
            if leading.is_some() {
                let factor = self.field.quotient(&combination.remainder[0], &chosen.remainder[0]);
                let pairs = combination.factors.iter_mut().zip(&chosen.factors);
                for (own, other) in pairs {
                    own.resize(own.len().max(other.len()), self.field.zero());
                    for (number, other) in own.iter_mut().zip(other) {
                        self.field.subtract(number, &factor, other);
                    }
                }
                let pairs = combination.remainder.iter_mut().zip(&chosen.remainder).skip(1);
                for (number, other) in pairs {
                    self.field.subtract(number, &factor, other);
                }
            }
            combination.remainder.remove(0);
        }
        // The factor s shifts the remainder up by one power, as the order does: only its last
        // coefficient is dropped.
        chosen.remainder.pop();
        for factor in chosen.factors.iter_mut().filter(|factor| !factor.is_empty()) {
            factor.insert(0, self.field.zero());
        }
        chosen.room -= 1;
        self.combinations.insert(pivot, chosen);
    }

    /// The binary exponent of the next coefficient of a combination; `None` if it vanishes.
    fn leading(&self, combination: &Combination<F::Element>) -> Option<i64> {
        let exponent = self.field.exponent(combination.remainder.first()?)?;
        let Some(noise) = self.field.noise() else {
            return Some(exponent);
        };
        let numbers = combination.factors.iter().flatten();
        let largest = numbers.filter_map(|number| self.field.exponent(number)).max()?;
        (exponent > largest - noise).then_some(exponent)
    }
}
