//! Products of polynomials whose exponents fill a box: every product of powers is a place in one
//! array, and a product of two terms an addition of places.
//!
//! Reference: J. von zur Gathen, J. Gerhard, *Modern Computer Algebra*, 3rd ed., Cambridge 2013,
//! section 8.4 (Kronecker's substitution).
//!
//! ```text
//! x^i y^j z^k -> i' + d_x j' + d_x d_y k',    i' = (i - least exponent of x)/step,   d_x: the number of exponents of x
//! ```
//!
//! The cost is a product of whole numbers for each pair of terms, and a reduction to lowest terms
//! for each term of the result. The products of all pairs of harmonics of two Fourier series go into
//! one array.

use num_integer::Integer as _;
use num_traits::Zero;

use super::polynomial::{Monomial, Polynomial, Polynomials};
use super::rational::Integer;
use super::ring::Ring;
use crate::symbol::Symbol;

/// The least number of pairs of terms for which an array is made.
const MANY: usize = 48;

/// Largest number of places in the array per pair of terms.
const SPARSE: usize = 4;

/// The box of the exponents of a product.
struct ExponentBox {
    axes: Vec<ExponentRange>,
    places: usize,
}

/// The range of the exponents of one symbol.
struct ExponentRange {
    symbol: Symbol,
    /// The least exponent in each factor.
    least: [i32; 2],
    /// The greatest common divisor of all differences of exponents: 2 of an odd function.
    step: u32,
    /// The number of exponents in the product.
    length: usize,
}

/// Returns `left * right`; `None` if the terms are few or sparse, or the coefficients are neither
/// whole numbers nor fractions.
pub(super) fn dense_product<R: Ring>(
    ring: &Polynomials<R>,
    left: &Polynomial<R::Element>,
    right: &Polynomial<R::Element>,
) -> Option<Polynomial<R::Element>> {
    let [left, right] = [left, right].map(std::slice::from_ref);
    let product = products(ring, left, right, 1, |_, _| [Some(0), None])?;
    product.into_iter().next()
}

/// Returns the coefficients `c_k` of `2 sum_i a_i cos(i theta) sum_j b_j cos(j theta)`, to which each
/// product adds twice, at `i + j` and at `|i - j|`; `None` as for [`dense_product`].
pub(super) fn dense_cosine_product<R: Ring>(
    ring: &Polynomials<R>,
    left: &[Polynomial<R::Element>],
    right: &[Polynomial<R::Element>],
) -> Option<Vec<Polynomial<R::Element>>> {
    let count = (left.len() + right.len()).checked_sub(1)?;
    products(ring, left, right, count, |i, j| [Some(i + j), Some(i.abs_diff(j))])
}

/// Sums the products of all pairs of polynomials: that of the pair `(i, j)` into the one or two of the
/// `count` sums that `into(i, j)` names, twice if it names one twice.
fn products<R: Ring>(
    ring: &Polynomials<R>,
    left: &[Polynomial<R::Element>],
    right: &[Polynomial<R::Element>],
    count: usize,
    into: impl Fn(usize, usize) -> [Option<usize>; 2],
) -> Option<Vec<Polynomial<R::Element>>> {
    let terms = |factor: &[Polynomial<R::Element>]| {
        factor.iter().map(|own| own.terms().len()).sum::<usize>()
    };
    let pairs = terms(left) * terms(right);
    if pairs < MANY {
        return None;
    }
    let exponents = ExponentBox::of_product(left, right, SPARSE * pairs / count)?;
    let (own, own_denominator) = numerators(ring, left, &exponents, 0)?;
    let (other, other_denominator) = numerators(ring, right, &exponents, 1)?;
    let mut cells = vec![Integer::zero(); exponents.places * count];
    for (i, own) in own.iter().enumerate() {
        for (j, other) in other.iter().enumerate() {
            let sums = into(i, j).map(|sum| sum.map(|sum| sum * exponents.places));
            for (place, number) in own {
                for (behind, factor) in other {
                    let product = number * factor;
                    if let Some(second) = sums[1] {
                        cells[second + place + behind] += &product;
                    }
                    if let Some(first) = sums[0] {
                        cells[first + place + behind] += product;
                    }
                }
            }
        }
    }
    let denominator = own_denominator * other_denominator;
    let monomials: Vec<Monomial> =
        (0..exponents.places).map(|place| exponents.monomial(place)).collect();
    let mut cells = cells.into_iter();
    let sum = |_| {
        let own = cells.by_ref().take(exponents.places).zip(&monomials);
        let terms = own
            .filter(|(cell, _)| !cell.is_zero())
            .map(|(cell, monomial)| Some((monomial.clone(), ring.0.fraction(cell, &denominator)?)));
        Some(Polynomial::from_terms(terms.collect::<Option<Vec<_>>>()?.into_iter()))
    };
    (0..count).map(sum).collect()
}

/// The numerators of the terms of one factor with their places, a list for each of its polynomials,
/// and their common denominator.
type Numerators = (Vec<Vec<(usize, Integer)>>, Integer);

fn numerators<R: Ring>(
    ring: &Polynomials<R>,
    polynomials: &[Polynomial<R::Element>],
    exponents: &ExponentBox,
    factor: usize,
) -> Option<Numerators> {
    let all = polynomials.iter().flat_map(|own| own.terms().map(|term| term.1));
    let (numbers, denominator) = ring.0.numerators(all)?;
    let mut numbers = numbers.into_iter();
    let placed = |own: &Polynomial<R::Element>| {
        let places = own.terms().map(|(monomial, _)| exponents.place(monomial, factor));
        places.zip(numbers.by_ref()).collect()
    };
    Some((polynomials.iter().map(placed).collect(), denominator))
}

impl ExponentBox {
    /// The box of the products of polynomials of one list and of another; `None` if it has more than
    /// `most` places.
    fn of_product<'a, K>(
        left: &'a [Polynomial<K>],
        right: &'a [Polynomial<K>],
        most: usize,
    ) -> Option<Self> {
        let monomials = |factor: &'a [Polynomial<K>]| {
            factor.iter().flat_map(Polynomial::terms).map(|term| term.0)
        };
        let mut symbols: Vec<Symbol> = vec![];
        let factors = [left, right].into_iter().flat_map(monomials).flat_map(Monomial::factors);
        for (symbol, _) in factors {
            if !symbols.contains(symbol) {
                symbols.push(*symbol);
            }
        }
        symbols.sort();
        let (mut places, mut axes) = (1_usize, Vec::with_capacity(symbols.len()));
        for symbol in symbols {
            let exponents = |factor| monomials(factor).map(|monomial| monomial.exponent(symbol));
            let mut axis = ExponentRange { symbol, least: [0; 2], step: 0, length: 1 };
            let mut range = 0_u32;
            for (least, factor) in axis.least.iter_mut().zip([left, right]) {
                *least = exponents(factor).min()?;
                let mut largest = 0;
                for distance in exponents(factor).map(|exponent| exponent.abs_diff(*least)) {
                    axis.step = axis.step.gcd(&distance);
                    largest = distance.max(largest);
                }
                range = range.saturating_add(largest);
            }
            axis.step = axis.step.max(1);
            axis.length += (range / axis.step) as usize;
            places = places.checked_mul(axis.length).filter(|places| *places <= most)?;
            axes.push(axis);
        }
        Some(Self { axes, places })
    }

    /// The place of a product of powers in one of the factors.
    fn place(&self, monomial: &Monomial, factor: usize) -> usize {
        self.axes.iter().rev().fold(0, |place, axis| {
            let exponent = monomial.exponent(axis.symbol).abs_diff(axis.least[factor]);
            place * axis.length + (exponent / axis.step) as usize
        })
    }

    /// The product of powers at a place of the product.
    fn monomial(&self, mut place: usize) -> Monomial {
        let power = |axis: &ExponentRange| {
            let steps = (place % axis.length) as i32 * axis.step as i32;
            place /= axis.length;
            (axis.symbol, axis.least[0] + axis.least[1] + steps)
        };
        Monomial::from_ordered(self.axes.iter().map(power))
    }
}

#[cfg(test)]
mod tests {
    use num_traits::One;

    use super::*;
    use crate::exact::ring::{Integers, Rationals};
    use crate::exact::{POLYNOMIALS, Rational, ratio};

    /// `sum_(i, j) (i - 2 j + 1/(i + j + 1)) a^i b^(j - 2)`.
    fn filled(a: &str, b: &str) -> Polynomial {
        let mut sum = Polynomial::zero();
        for (i, j) in (0..9).flat_map(|i| (0..5).map(move |j| (i, j))) {
            let powers = [(a, i), (b, j - 2)].map(|(name, k)| Monomial::power_of(name.into(), k));
            let number = ratio(i64::from(i - 2 * j), 1) + ratio(1, i64::from(i + j + 1));
            sum.add_term(powers[0].product(&powers[1]), number);
        }
        sum
    }

    /// The product term by term.
    fn by_terms(left: &Polynomial, right: &Polynomial) -> Polynomial {
        let mut product = Polynomial::zero();
        for (m, a) in left.terms() {
            for (n, b) in right.terms() {
                product.add_term(m.product(n), a * b);
            }
        }
        product
    }

    #[test]
    fn products_in_a_box_are_those_of_the_terms() {
        let (one, other) = (filled("a", "b"), filled("b", "c"));
        for (left, right) in [(&one, &one), (&one, &other), (&other, &one)] {
            let product = dense_product(&Polynomials(Rationals), left, right).expect("many terms");
            assert_eq!(product, by_terms(left, right));
            assert_eq!(product, left.product(right));
        }
        // What cancels is no term of the result.
        let mut minus = one.clone();
        minus.negate();
        minus.add_term(Monomial::one(), ratio(1, 1));
        let mut plus = one.clone();
        plus.add_term(Monomial::one(), ratio(1, 1));
        assert_eq!(POLYNOMIALS.product(&plus, &minus), by_terms(&plus, &minus));
    }

    #[test]
    fn a_product_of_cosine_series_is_the_sum_over_its_pairs() {
        let series = |names: [&str; 2], harmonics: &[usize]| {
            let term = |k: usize| match harmonics.contains(&k) {
                true => filled(names[0], names[1]).map(|number| number * ratio(k as i64 + 1, 3)),
                false => Polynomial::zero(),
            };
            (0..6).map(term).collect::<Vec<Polynomial>>()
        };
        let (left, right) = (series(["a", "b"], &[0, 2, 5]), series(["b", "c"], &[0, 1, 2]));
        let found = dense_cosine_product(&POLYNOMIALS, &left, &right).expect("many terms");
        let mut expected = vec![Polynomial::zero(); 11];
        for (i, own) in left.iter().enumerate() {
            for (j, other) in right.iter().enumerate() {
                let product = by_terms(own, other);
                expected[i + j].accumulate(&product);
                expected[i.abs_diff(j)].accumulate(&product);
            }
        }
        assert_eq!(found, expected);
        // Constants alone: the harmonics i + j and |i - j| are one.
        let found =
            dense_cosine_product(&POLYNOMIALS, &left[..1], &right[..1]).expect("many terms");
        let mut doubled = by_terms(&left[0], &right[0]);
        doubled.accumulate(&doubled.clone());
        assert_eq!(found, [doubled]);
        assert!(dense_cosine_product(&POLYNOMIALS, &left[3..4], &[]).is_none());
    }

    #[test]
    fn few_terms_and_terms_far_apart_are_left_to_the_other_way() {
        let few = filled("a", "b").times_monomial(&Monomial::one());
        let short: Polynomial<Rational> = Polynomial::symbol("a".into());
        assert!(dense_product(&POLYNOMIALS, &few, &short).is_none());
        let mut apart = Polynomial::zero();
        let mut stepping = Polynomial::zero();
        for k in 0..10_i32 {
            apart.add_term(Monomial::power_of("a".into(), k.pow(3)), ratio(1, 1));
            stepping.add_term(Monomial::power_of("a".into(), 1000 * k - 500), ratio(k.into(), 7));
        }
        assert!(dense_product(&POLYNOMIALS, &apart, &apart).is_none());
        // Exponents that differ by multiples of a thousand have one place each.
        let square = dense_product(&POLYNOMIALS, &stepping, &stepping);
        assert_eq!(square, Some(by_terms(&stepping, &stepping)));
        let mut whole: Polynomial<Integer> = Polynomial::zero();
        for k in 0..10 {
            whole.add_term(Monomial::power_of("a".into(), k), Integer::one());
        }
        let square = dense_product(&Polynomials(Integers), &whole, &whole).expect("many terms");
        let middle = square.coefficient(&Monomial::power_of("a".into(), 9));
        assert_eq!((square.terms().len(), middle), (19, Integer::from(10)));
    }
}
