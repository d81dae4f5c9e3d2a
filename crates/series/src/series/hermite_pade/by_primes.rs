//! Exact approximants, computed modulo primes of one word and reconstructed.
//!
//! Modulo a prime the recursion needs only words. The coefficients of the result are fractions over
//! one denominator. They may have as many digits as all coefficients of the series together, but
//! mostly have far fewer: primes are added until one entry is recognized as a fraction, and all
//! others, over its denominator, agree with a further prime that was not used for them.

use num_integer::Integer as _;
use num_traits::{One, Signed, Zero};

use super::{Field, HermitePade};
use crate::exact::residue::remainder::{ReconstructedIntegers, Remainders, fraction};
use crate::exact::residue::{Arithmetic, Lanes, Modulus, WIDTH, Work, by_widest, primes_below};
use crate::exact::{Integer, Rational};
use crate::parallel::par_map;

/// Returns the combination of these series, each given with the degree of its factor, that vanishes
/// to the highest order: whole numbers without a common factor, a list for each series, the lowest
/// power first. Returns `None` if there is no combination with a non-zero first number, if there
/// are several, or if the numbers would be too long.
pub fn exact(series: &[(Vec<Rational>, usize)]) -> Option<Vec<Vec<Integer>>> {
    by_widest(Exact(series))
}

struct Exact<'a>(&'a [(Vec<Rational>, usize)]);

/// Residues modulo a prime.
struct PrimeField(Modulus);

impl Field for PrimeField {
    type Element = u64;

    fn zero(&self) -> u64 {
        0
    }
    fn one(&self) -> u64 {
        self.0.one
    }
    fn quotient(&self, numerator: &u64, denominator: &u64) -> u64 {
        self.0.product(*numerator, self.0.inverse(*denominator))
    }
    fn subtract(&self, number: &mut u64, factor: &u64, other: &u64) {
        *number = self.0.difference(*number, self.0.product(*factor, *other));
    }
    fn exponent(&self, number: &u64) -> Option<i64> {
        (*number != 0).then_some(0)
    }
    fn noise(&self) -> Option<i64> {
        None
    }
}

/// The coefficients of the combination modulo one prime: plain residues, divided by the first of
/// them.
struct CoefficientImage {
    modulus: Modulus,
    numbers: Vec<u64>,
}

impl Exact<'_> {
    fn image(&self, modulus: Modulus) -> Option<CoefficientImage> {
        let order = self.0.iter().map(|(_, degree)| degree + 1).sum::<usize>() - 1;
        let residues = |numbers: &[Rational]| {
            let mut inverses: Vec<u64> =
                numbers.iter().map(|number| modulus.integer(number.denom())).collect();
            modulus.invert(&mut inverses)?;
            let pairs = numbers.iter().zip(inverses);
            Some(
                pairs
                    .map(|(number, inverse)| {
                        modulus.product(modulus.integer(number.numer()), inverse)
                    })
                    .collect(),
            )
        };
        let series: Option<Vec<(Vec<u64>, usize)>> = self
            .0
            .iter()
            .map(|(numbers, degree)| Some((residues(numbers.get(..order)?)?, *degree)))
            .collect();
        let mut work = HermitePade::new(PrimeField(modulus), series?);
        while work.order() < order {
            work.advance();
        }
        let best = work.best();
        // If room is left, the combination is not unique.
        if best.room != 0 {
            return None;
        }
        let mut numbers = vec![];
        for (factor, (_, degree)) in best.factors.iter().zip(self.0) {
            numbers.extend((0..=*degree).map(|power| factor.get(power).copied().unwrap_or(0)));
        }
        let first = *numbers.first().filter(|first| **first != 0)?;
        let inverse = modulus.inverse(first);
        Some(CoefficientImage {
            numbers: numbers
                .into_iter()
                .map(|number| modulus.plain(modulus.product(number, inverse)))
                .collect(),
            modulus,
        })
    }
}

impl Work for Exact<'_> {
    type Output = Option<Vec<Vec<Integer>>>;

    fn run<A: Arithmetic>(self, arithmetic: A) -> Self::Output {
        /// The largest number of primes, which is that of [`Remainders`].
        const MOST: usize = 1 << 13;
        /// Number of primes without a result beyond which the search fails, besides one in a
        /// hundred.
        const BLIND: usize = 4;
        let mut source = primes_below(A::BITS, 2);
        let mut images: Vec<CoefficientImage> = vec![];
        let mut count = 8;
        while count < MOST {
            let mut blind = 0;
            while images.len() <= count {
                let primes: Vec<u64> = source.by_ref().take(count + 1 - images.len()).collect();
                let seen: Vec<Option<CoefficientImage>> =
                    par_map(&primes, |prime| self.image(Modulus::new(*prime, A::RADIX)));
                blind += seen.iter().filter(|image| image.is_none()).count();
                if seen.is_empty() || blind > BLIND + images.len() / 100 {
                    return None;
                }
                images.extend(seen.into_iter().flatten());
            }
            if let Some(numbers) = lifted(arithmetic, &images[..=count]) {
                let mut numbers = numbers.into_iter();
                let lists =
                    self.0.iter().map(|(_, degree)| numbers.by_ref().take(degree + 1).collect());
                return Some(lists.collect());
            }
            count += count / 2;
        }
        None
    }
}

/// Reconstructs all numbers over their common denominator, which becomes the first of them; `None`
/// if there are too few images. The last image serves only as a test.
fn lifted<A: Arithmetic>(arithmetic: A, images: &[CoefficientImage]) -> Option<Vec<Integer>> {
    let (test, images) = images.split_last()?;
    let moduli: Vec<Modulus> = images.iter().map(|image| image.modulus).collect();
    let remainders = Remainders::new(arithmetic, &moduli);
    let product: Integer = moduli.iter().map(|modulus| Integer::from(modulus.prime)).product();
    let digit = test.modulus.residue(1 << A::DIGIT);
    let digits = (images.len() + 1) * A::BITS as usize / A::DIGIT as usize + 2 + WIDTH;
    let next = |power: &u64| Some(test.modulus.product(*power, digit));
    let powers: Vec<u64> =
        std::iter::successors(Some(test.modulus.one), next).take(digits).collect();
    let weights = |factor: &Integer| -> Vec<u64> {
        remainders.weights(|modulus| modulus.integer(factor)).collect()
    };
    let length = test.numbers.len();
    // The numbers of the highest powers have the longest denominators.
    let mut denominator = Integer::one();
    let mut numerators = vec![];
    let mut over = weights(&denominator);
    let mut place = length - 1;
    let mut first = true;
    // Eight numbers, from a place downwards, over the present denominator.
    let mut residues = vec![Lanes::default(); images.len()];
    let mut eight = ReconstructedIntegers::default();
    let mut lifted = None;
    let mut in_test = [0; WIDTH];
    while numerators.len() < length {
        let start = *lifted.get_or_insert_with(|| {
            for (residues, image) in residues.iter_mut().zip(images) {
                let own = image.numbers[..=place].iter().rev();
                residues.0.iter_mut().zip(own).for_each(|(lane, residue)| *lane = *residue);
            }
            remainders.lift(&mut residues, &over, &mut eight);
            in_test = eight.residues(arithmetic, &test.modulus, &powers);
            place
        });
        let found = eight.integer::<A>(start - place);
        let expected =
            test.modulus.product(test.numbers[place], test.modulus.integer(&denominator));
        if !first && in_test[start - place] == expected {
            numerators.push(found);
            if start - place == WIDTH - 1 {
                lifted = None;
            }
            place = place.wrapping_sub(1);
            continue;
        }
        let residue = found.mod_floor(&product);
        let (_, more) = fraction(&residue, &product)?;
        if more.is_one() && !first {
            return None;
        }
        lifted = None;
        // The earlier numerators have the smaller denominator.
        numerators.iter_mut().for_each(|numerator: &mut Integer| *numerator *= &more);
        denominator *= more;
        over = weights(&denominator);
        first = false;
    }
    numerators.reverse();
    // The first number was one, so a common factor of all numerators is one of the denominator as
    // well.
    let common = numerators.iter().fold(Integer::zero(), |common, number| common.gcd(number));
    if common > Integer::one() {
        numerators.iter_mut().for_each(|number| *number /= &common);
    }
    if numerators.first().is_some_and(Signed::is_negative) {
        numerators.iter_mut().for_each(|number| *number = -std::mem::take(number));
    }
    Some(numerators)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::rational::ratio;

    /// The exponential's approximants are known: `q_j = (-1)^j (L+M-j)! M! / ((L+M)! j! (M-j)!)`.
    #[test]
    fn the_approximants_of_the_exponential() {
        for (above, below) in [(1_i64, 1_i64), (3, 2), (14, 15), (30, 29)] {
            let mut series = vec![ratio(1, 1)];
            for k in 1..=above + below {
                series.push(series.last().expect("the first") / ratio(k, 1));
            }
            let mut one = vec![ratio(0, 1); series.len()];
            one[0] = ratio(-1, 1);
            let found =
                exact(&[(series, below as usize), (one, above as usize)]).expect("approximants");
            let mut expected = ratio(1, 1);
            for j in 0..=below {
                let quotient = Rational::new(found[0][j as usize].clone(), found[0][0].clone());
                assert_eq!(quotient, expected, "[{above}/{below}] {j}");
                expected = -expected * ratio(below - j, (j + 1) * (above + below - j).max(1));
            }
            assert_eq!((found[0].len(), found[1].len()), (below as usize + 1, above as usize + 1));
        }
    }

    #[test]
    fn an_algebraic_function_of_degree_two_has_its_equation() {
        // f = sqrt(1 + s): -(1 + s) + f^2 = 0.
        let mut root = vec![ratio(1, 1)];
        for k in 1..=8 {
            root.push(root.last().expect("the first") * ratio(3 - 2 * k, 2 * k));
        }
        let mut one = vec![ratio(0, 1); root.len()];
        one[0] = ratio(1, 1);
        let square: Vec<Rational> =
            (0..root.len()).map(|n| (0..=n).map(|k| &root[k] * &root[n - k]).sum()).collect();
        let whole = |numbers: &[i64]| {
            numbers.iter().map(|number| Integer::from(*number)).collect::<Vec<_>>()
        };
        let found = exact(&[(one, 1), (root, 0), (square, 0)]).expect("its equation");
        assert_eq!(found, [whole(&[1, 1]), whole(&[0]), whole(&[-1])]);
    }

    #[test]
    fn what_is_not_unique_is_none() {
        // 1/(1 - s) has many approximants [3/3].
        let series = vec![ratio(1, 1); 7];
        let mut one = vec![ratio(0, 1); 7];
        one[0] = ratio(-1, 1);
        assert_eq!(exact(&[(series, 3), (one, 3)]), None);
    }
}
