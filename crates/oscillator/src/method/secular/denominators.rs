//! The denominators of an expansion, guessed from its first orders.
//!
//! The elimination divides order `n` by `1 - k^2` for its harmonics `k`, so that no prime above the
//! highest harmonic can stand in a denominator, and its exponent grows at each order by no more
//! than that in `lcm(1 .. highest)`. Often much cancels: Duffing's denominators are powers of two,
//! the pendulum's divide `64^n (2n+1)!`. The kind of growth is inferred from the first orders, half
//! of them for the fit and the other half for a test. It is a guess: every number that is found
//! with it is tried modulo one more prime.

use num_integer::Integer as _;
use num_traits::{One, ToPrimitive, Zero};

use crate::exact::residue::{Modulus, primes_up_to};
use crate::exact::{Integer, Rational};

/// The primes that are looked for in denominators, those below 1000: larger ones could only come
/// from a coefficient of the equation.
const SMALL: [u64; 168] = {
    let mut primes = [0; 168];
    let (mut count, mut number) = (0, 2);
    while count < primes.len() {
        let mut place = 0;
        while place < count && number % primes[place] != 0 {
            place += 1;
        }
        if place == count {
            primes[count] = number;
            count += 1;
        }
        number += 1;
    }
    primes
};

/// A positive whole number by its prime factors, in order, and their exponents.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(in crate::method) struct Factored(Vec<(u64, u64)>);

impl Factored {
    /// The factors of a number whose primes are all small; `None` for another.
    pub fn factorize(number: &Integer) -> Option<Self> {
        let mut rest = number.clone();
        let mut factored = Self::default();
        let halvings = remove(&mut rest, 2, u64::MAX);
        factored.set(2, halvings);
        for prime in SMALL.iter().skip(1) {
            // The rest is mostly one, or fits a word, before all primes have been tried.
            if let Some(word) = rest.to_u64() {
                return factored.with_factors_of(word);
            }
            let exponent = remove(&mut rest, *prime, u64::MAX);
            factored.set(*prime, exponent);
        }
        rest.is_one().then_some(factored)
    }

    /// The product with a word whose primes are all small; `None` for another.
    fn with_factors_of(mut self, word: u64) -> Option<Self> {
        let mut rest = word;
        for prime in SMALL.iter() {
            if rest == 1 {
                break;
            }
            let mut exponent = 0;
            while rest.is_multiple_of(*prime) {
                rest /= prime;
                exponent += 1;
            }
            self.set(*prime, self.exponent(*prime) + exponent);
        }
        (rest == 1).then_some(self)
    }

    /// Multiplies by a positive word, whose factors are found by division.
    fn multiply_by_word(&mut self, number: u64) {
        let halvings = number.trailing_zeros();
        self.raise(2, halvings.into());
        let mut rest = number >> halvings;
        let mut divisor = 3;
        while rest > 1 {
            if divisor * divisor > rest {
                divisor = rest;
            }
            while rest.is_multiple_of(divisor) {
                rest /= divisor;
                self.raise(divisor, 1);
            }
            divisor += 2;
        }
    }

    fn exponent(&self, prime: u64) -> u64 {
        let place = self.0.binary_search_by_key(&prime, |factor| factor.0);
        place.map_or(0, |place| self.0[place].1)
    }

    fn set(&mut self, prime: u64, exponent: u64) {
        match self.0.binary_search_by_key(&prime, |factor| factor.0) {
            Ok(place) if exponent == 0 => {
                self.0.remove(place);
            }
            Ok(place) => self.0[place].1 = exponent,
            Err(_) if exponent == 0 => {}
            Err(place) => self.0.insert(place, (prime, exponent)),
        }
    }

    /// Multiplies by a power of a prime.
    fn raise(&mut self, prime: u64, exponent: u64) {
        match self.0.binary_search_by_key(&prime, |factor| factor.0) {
            Ok(place) => self.0[place].1 += exponent,
            Err(_) if exponent == 0 => {}
            Err(place) => self.0.insert(place, (prime, exponent)),
        }
    }

    /// Whether it is one.
    pub fn is_one(&self) -> bool {
        self.0.is_empty()
    }

    /// The product.
    pub fn product(&self, other: &Self) -> Self {
        let mut product = self.clone();
        other.0.iter().for_each(|(prime, exponent)| product.raise(*prime, *exponent));
        product
    }

    /// The quotient; factors that the divisor has in excess are ignored.
    pub fn quotient(&self, divisor: &Self) -> Self {
        Self(self.left_by(divisor).collect())
    }

    /// The factors that a divisor leaves.
    fn left_by(&self, divisor: &Self) -> impl Iterator<Item = (u64, u64)> {
        let left = self.0.iter();
        left.map(|&(prime, exponent)| (prime, exponent.saturating_sub(divisor.exponent(prime))))
            .filter(|factor| factor.1 > 0)
    }

    /// The number.
    pub fn value(&self) -> Integer {
        let mut value = Integer::one();
        // As many powers as fit are multiplied in one word.
        let mut word = 1_u64;
        for &(prime, exponent) in self.0.iter().filter(|factor| factor.0 != 2) {
            let exponent = u32::try_from(exponent).unwrap_or(u32::MAX);
            match prime.checked_pow(exponent) {
                Some(power) => {
                    word = word.checked_mul(power).unwrap_or_else(|| {
                        value *= Integer::from(word);
                        power
                    });
                }
                None => value *= Integer::from(prime).pow(exponent),
            }
        }
        (value * Integer::from(word)) << self.exponent(2) as usize
    }

    /// The number in the form from which residues are computed.
    pub(super) fn ladder(&self) -> ExponentBits {
        let digits = self.0.iter().map(|factor| factor.1.checked_ilog2().map_or(0, |log| log + 1));
        let digits = digits.max().unwrap_or(0);
        let with_digit = |digit: u32| -> Vec<u64> {
            let factors = self.0.iter().filter(|(_, exponent)| exponent >> digit & 1 == 1);
            let primes: Vec<u64> = factors.map(|factor| factor.0).collect();
            words(&primes).map(|lot| lot.iter().product()).collect()
        };
        ExponentBits((0..digits).rev().map(with_digit).collect())
    }

    /// The number of its binary digits.
    pub fn bits(&self) -> f64 {
        let powers = self.0.iter();
        powers.map(|(prime, exponent)| (*prime as f64).log2() * *exponent as f64).sum()
    }

    /// The numerator and denominator in lowest terms of a number over this one.
    pub fn lowest_terms(&self, mut numerator: Integer) -> (Integer, Integer) {
        if numerator.is_zero() {
            return (numerator, Integer::one());
        }
        let mut left = self.clone();
        loop {
            let common = left.common(std::slice::from_ref(&numerator));
            if !common.is_one() {
                left = left.quotient(&common);
                numerator /= common.value();
            }
            // Each step removes at most one word of each odd prime.
            let next = |exponent: u64| u32::try_from(exponent + 1).unwrap_or(u32::MAX);
            let mut odd = common.0.iter().filter(|factor| factor.0 != 2);
            if !odd.any(|(prime, exponent)| prime.checked_pow(next(*exponent)).is_none()) {
                return (numerator, left.value());
            }
        }
    }

    /// The fraction with this number, whose `value` is known, as its denominator.
    pub fn fraction(&self, numerator: &Integer, value: &Integer) -> Rational {
        if numerator.is_zero() {
            return Rational::zero();
        }
        let (mut numerator, mut denominator, mut left) =
            (numerator.clone(), value.clone(), self.clone());
        loop {
            let common = left.common(std::slice::from_ref(&numerator));
            if common.is_one() {
                return Rational::new_raw(numerator, denominator);
            }
            let divisor = common.value();
            numerator /= &divisor;
            denominator /= &divisor;
            // Each step removes at most one word of each prime.
            left = left.quotient(&common);
        }
    }

    /// Greatest common divisor of this number and all of the others.
    pub fn common(&self, numbers: &[Integer]) -> Self {
        let numbers: Vec<&Integer> = numbers.iter().filter(|number| !number.is_zero()).collect();
        let mut common = Self::default();
        let halvings = numbers.iter().filter_map(|number| number.halvings()).min();
        let halvings = halvings.map_or(0, |count| count as u64);
        common.set(2, halvings.min(self.exponent(2)));
        // One division tests many primes: most do not divide even the first numbers.
        let odd: Vec<u64> =
            self.0.iter().map(|factor| factor.0).filter(|prime| *prime != 2).collect();
        let mut shared: Vec<u64> = Vec::new();
        for lot in words(&odd) {
            let all: u64 = lot.iter().product();
            let mut left = all;
            for number in &numbers {
                left = left.gcd(&remainder(number, all));
                if left == 1 {
                    break;
                }
            }
            shared.extend(lot.iter().filter(|prime| left.is_multiple_of(**prime)));
        }
        for (prime, exponent) in self.least_powers(&shared, &numbers) {
            common.set(prime, exponent);
        }
        common
    }

    /// The highest powers of these primes in all of the numbers, at most those of this one.
    fn least_powers(&self, primes: &[u64], numbers: &[&Integer]) -> Vec<(u64, u64)> {
        // Squares are tested first, several in a word; then each prime with more than a square, to
        // its highest power in a word.
        let squares: Vec<u64> = primes.iter().map(|prime| prime * prime).collect();
        let mut least: Vec<(u64, u64)> =
            primes.iter().map(|prime| (*prime, self.exponent(*prime).min(2))).collect();
        let mut place = 0;
        for lot in words(&squares) {
            let all: u64 = lot.iter().product();
            let own = &mut least[place..place + lot.len()];
            for number in numbers {
                lower(own, remainder(number, all));
            }
            place += lot.len();
        }
        for (prime, exponent) in &mut least {
            if *exponent == 2 && self.exponent(*prime) > 2 {
                let (power, count) = largest_power(*prime);
                *exponent = self.exponent(*prime).min(count);
                for number in numbers {
                    let mut own = [(*prime, *exponent)];
                    lower(&mut own, remainder(number, power));
                    *exponent = own[0].1;
                }
            }
        }
        least
    }
}

/// A number by the binary digits of the exponents of its primes, the highest digit first: for each
/// digit the product of the primes whose exponent has it, in words. One squaring for each digit
/// serves all primes.
pub(super) struct ExponentBits(Vec<Vec<u64>>);

impl ExponentBits {
    /// The residue of the number.
    pub fn residue(&self, modulus: &Modulus) -> u64 {
        self.0.iter().fold(modulus.one, |power, words| {
            let square = modulus.product(power, power);
            words
                .iter()
                .fold(square, |product, word| modulus.product(product, modulus.residue(*word)))
        })
    }
}

/// Lowers exponents to those that the primes have in a number, zero meaning any.
fn lower(exponents: &mut [(u64, u64)], number: u64) {
    if number == 0 {
        return;
    }
    for (prime, most) in exponents {
        let mut rest = number;
        let mut exponent = 0;
        while exponent < *most && rest.is_multiple_of(*prime) {
            rest /= *prime;
            exponent += 1;
        }
        *most = exponent;
    }
}

/// Splits a list of numbers into groups whose products fit a word.
fn words(numbers: &[u64]) -> impl Iterator<Item = &[u64]> {
    let mut rest = numbers;
    std::iter::from_fn(move || {
        let products = rest.iter().scan(1_u64, |product, number| {
            *product = product.checked_mul(*number)?;
            Some(())
        });
        let (lot, others) = rest.split_at(products.count().max(1).min(rest.len()));
        rest = others;
        (!lot.is_empty()).then_some(lot)
    })
}

/// The absolute remainder of a division by a word.
fn remainder(number: &Integer, divisor: u64) -> u64 {
    number.remainder(divisor).unsigned_abs() as u64
}

/// The largest power of a prime in one word, and its exponent.
fn largest_power(prime: u64) -> (u64, u64) {
    let exponent = u64::MAX.ilog(prime);
    (prime.pow(exponent), exponent.into())
}

/// Divides by a prime as often as it goes, `most` times at most, and says how often.
fn remove(number: &mut Integer, prime: u64, most: u64) -> u64 {
    if number.is_zero() {
        return 0;
    }
    if prime == 2 {
        let halvings = number.halvings().map_or(0, |count| count as u64).min(most);
        *number = std::mem::take(number) >> halvings as usize;
        return halvings;
    }
    let mut removed = 0;
    for (power, count) in [largest_power(prime), (prime, 1)] {
        let divisor = Integer::from(power);
        while removed + count <= most {
            let (quotient, rest) = number.div_rem(&divisor);
            if !rest.is_zero() {
                break;
            }
            *number = quotient;
            removed += count;
        }
    }
    removed
}

/// The growth of denominators with the order, apart from a factor `c^n`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Growth {
    /// No growth apart from that factor.
    Power,
    /// As `(2n+1)!`.
    Factorial,
    /// As the product of `lcm(1 .. highest factor)` over the orders, the upper bound.
    Multiples,
    /// As both together: a force with factorials in its coefficients.
    FactorialMultiples,
}

impl Growth {
    /// All kinds, the one with the shortest numbers first.
    pub const ALL: [Self; 4] =
        [Self::Power, Self::Factorial, Self::Multiples, Self::FactorialMultiples];

    /// The numbers of all orders up to `highest`; `largest_factor` is that of the divisors of each
    /// order.
    fn of_orders(self, highest: usize, largest_factor: &dyn Fn(usize) -> u64) -> Vec<Factored> {
        let mut numbers = vec![Factored::default()];
        let primes = match self {
            Self::Power | Self::Factorial => vec![],
            Self::Multiples | Self::FactorialMultiples => primes_up_to(largest_factor(highest)),
        };
        for order in 1..=highest {
            let mut number = numbers[order - 1].clone();
            if matches!(self, Self::Factorial | Self::FactorialMultiples) {
                let twice = 2 * order as u64;
                number.multiply_by_word(twice);
                number.multiply_by_word(twice + 1);
            }
            if matches!(self, Self::Multiples | Self::FactorialMultiples) {
                let last = largest_factor(order);
                for &prime in primes.iter().take_while(|prime| **prime <= last) {
                    // The exponent of a prime in lcm(1 .. last).
                    number.raise(prime, u64::from(last.checked_ilog(prime).unwrap_or(0)));
                }
            }
            numbers.push(number);
        }
        numbers
    }

    /// The denominators of all orders up to `highest` if those of the first ones, `known`, are of
    /// this growth; the known ones as they are.
    pub fn denominators(
        self,
        known: &[Factored],
        highest: usize,
        largest_factor: &dyn Fn(usize) -> u64,
    ) -> Option<Vec<Factored>> {
        // Factorials have primes that no divisor of the elimination has, and hide how fast the
        // exponents of small ones grow.
        let beyond = |(order, own): (usize, &Factored)| {
            own.0.last().is_some_and(|factor| factor.0 > largest_factor(order))
        };
        // The last resort is not tested here, because every result is tested modulo another prime.
        let last_resort = matches!(self, Self::Multiples | Self::FactorialMultiples);
        let untested = last_resort || known.len() > highest;
        let foreign = self == Self::Factorial && !known.iter().enumerate().any(beyond);
        if !untested && foreign {
            return None;
        }
        let numbers = self.of_orders(highest.max(known.len()), largest_factor);
        let fitted = |count: usize| {
            let mut base = Factored::default();
            for (order, own) in known.iter().enumerate().take(count).skip(1) {
                for (prime, exponent) in own.left_by(&numbers[order]) {
                    base.set(prime, base.exponent(prime).max(exponent.div_ceil(order as u64)));
                }
            }
            base
        };
        let base = fitted(known.len());
        if !untested && fitted(known.len().div_ceil(2)) != base {
            return None;
        }
        let denominator = |order: usize| match known.get(order) {
            Some(known) => known.clone(),
            None => {
                let mut power = base.clone();
                power.0.iter_mut().for_each(|factor| factor.1 *= order as u64);
                power.product(&numbers[order])
            }
        };
        Some((0..=highest).map(denominator).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::factorial;

    fn integer(value: i64) -> Integer {
        Integer::from(value)
    }

    #[test]
    fn factors_and_lowest_terms() {
        let number = Factored::factorize(&integer(720_720)).expect("small factors");
        assert_eq!(number.value(), integer(720_720));
        assert_eq!(number.lowest_terms(integer(-1001 * 9)), (integer(-1), integer(80)));
        assert_eq!(number.lowest_terms(integer(0)), (integer(0), integer(1)));
        let common = number.common(&[integer(-36), integer(0), integer(24), integer(12 * 17)]);
        assert_eq!(common.value(), integer(12));
        assert_eq!(number.quotient(&common).value(), integer(60_060));
        let modulus = Modulus::new(1_073_741_789, 32);
        for number in [
            &number,
            &common,
            &Factored::default(),
            &Factored::factorize(&integer(6).pow(77)).expect("small factors"),
        ] {
            assert_eq!(number.ladder().residue(&modulus), modulus.integer(&number.value()));
        }
        let ratio = |numerator: i64| number.fraction(&integer(numerator), &integer(720_720));
        assert_eq!(ratio(-1001 * 9), Rational::new(integer(-1), integer(80)));
        assert_eq!(ratio(0), Rational::zero());
        // More of one prime than a word holds.
        let power = Factored::factorize(&integer(3).pow(90)).expect("small factors");
        let long = power.fraction(&(integer(3).pow(85) * integer(-14)), &power.value());
        assert_eq!(long, Rational::new(integer(-14), integer(243)));
        assert!(Factored::factorize(&integer(1_000_003)).is_none());
    }

    #[test]
    fn growth_is_told_from_the_first_orders() {
        let divisors = |order: usize| order as u64 + 1;
        let known = |denominator: &dyn Fn(u32) -> Integer| -> Vec<Factored> {
            (0..=10).map(|n| Factored::factorize(&denominator(n)).expect("small factors")).collect()
        };
        let powers = known(&|n| integer(32).pow(n));
        let found = Growth::Power.denominators(&powers, 20, &divisors).expect("a power");
        assert_eq!(found[20].value(), integer(32).pow(20));
        let factorials = known(&|n| integer(64).pow(n) * factorial(2 * n + 1));
        assert_eq!(Growth::Power.denominators(&factorials, 20, &divisors), None);
        let found = Growth::Factorial.denominators(&factorials, 20, &divisors).expect("factorials");
        assert!((integer(64).pow(20) * factorial(41)).is_multiple_of(&found[20].value()));
        // Product of lcm(1 .. m) over m = 2 .. 21 has 17 exactly from m = 17 on.
        let multiples = known(&|n| {
            (1..=i64::from(n) + 1)
                .map(|m| (1..=m).fold(integer(1), |l, k| l.lcm(&integer(k))))
                .product()
        });
        assert_eq!(Growth::Factorial.denominators(&multiples, 20, &divisors), None);
        let found = Growth::Multiples.denominators(&multiples, 20, &divisors).expect("multiples");
        assert_eq!(found[20].exponent(17), 5);
        // Half as fast: the factorials of the first orders hold them, those of later ones do not.
        let half = |order: usize| order as u64 / 2 + 1;
        let slow = known(&|n| multiples[n as usize / 2].value());
        assert!((0..=10).all(|n| factorial(2 * n + 1).is_multiple_of(&slow[n as usize].value())));
        assert_eq!(Growth::Factorial.denominators(&slow, 80, &half), None);
        let found = Growth::Multiples.denominators(&slow, 80, &half).expect("multiples");
        assert!(!factorial(161).is_multiple_of(&found[80].value()));
    }
}
