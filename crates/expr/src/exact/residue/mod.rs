//! Residues modulo primes of one word, and the reconstruction of whole numbers from them.
//!
//! References: P. L. Montgomery, *Modular multiplication without trial division*, Math. Comp. 44
//! (1985) 519-521; J. von zur Gathen and J. Gerhard, *Modern Computer Algebra*, Cambridge 2013,
//! chapter 5.
//!
//! ```text
//! a is held as a R mod p,  R = 2^radix        (a R)(b R)/R = (a b) R
//! x = sum_i t_i M/p_i - q M,   M = p_1 ... p_r,   t_i = x (M/p_i)^-1 mod p_i     (Chinese remainders)
//! ```
//!
//! A long exact computation is done modulo many primes, for each of them in machine words only, and
//! its result is reconstructed at the end. In come [`Modulus`] and [`Tables`] of [`Lanes`], eight
//! residues side by side, most often of [eight primes](moduli); an [`Arithmetic`] sums eight
//! products at a time, by the wide multiply-add of the processor if it has one ([`wide`]) and
//! otherwise by ordinary words ([`portable`]), with the same results after
//! [reconstruction](remainder).

pub mod lanes;
pub mod memory;
pub mod moduli;
#[cfg(target_arch = "x86_64")]
pub mod narrow;
pub mod portable;
pub mod remainder;
pub mod sums;
pub mod tables;
#[cfg(target_arch = "x86_64")]
pub mod wide;

pub use lanes::{Arithmetic, Lanes, WIDTH};
pub use memory::Memory;
pub use moduli::{Moduli, Residues};
pub use tables::Tables;

use super::Integer;

/// A computation that is written once for every arithmetic.
pub trait Work {
    /// The result of the work.
    type Output;

    /// Does the work with this arithmetic.
    fn run<A: Arithmetic>(self, arithmetic: A) -> Self::Output;
}

/// Does the work with the widest arithmetic of this processor.
pub fn by_widest<W: Work>(work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    if let Some(wide) = wide::Wide::try_new() {
        return work.run(wide);
    }
    #[cfg(target_arch = "x86_64")]
    if let Some(narrow) = narrow::Narrow::try_new() {
        return work.run(narrow);
    }
    work.run(portable::Portable)
}

/// A prime, and the constants of Montgomery's multiplication modulo it. Residues are below the
/// prime and stand for themselves times `R = 2^radix`, except where they are called plain.
#[derive(Clone, Copy, Debug)]
pub struct Modulus {
    /// The prime, odd, below `2^(radix - 2)`.
    pub prime: u64,
    /// One in Montgomery's form: `R` modulo the prime.
    pub one: u64,
    /// `R^2` modulo the prime: the factor that brings a plain residue into Montgomery's form.
    square: u64,
    /// `1/prime` modulo `R`.
    pub(super) inverse: u64,
    /// `2^(2 radix - 7)/prime`, rounded down, for an estimate of a quotient by the prime.
    pub(super) quotient: u64,
    radix: u32,
}

impl Modulus {
    /// A prime with `R = 2^radix`, where the radix is that of an [`Arithmetic`].
    pub fn new(prime: u64, radix: u32) -> Self {
        // Newton's iteration doubles the number of correct digits; it starts with three, as an odd
        // number is its own inverse modulo 8.
        let inverse = (0..5).fold(prime, |inverse, _| {
            inverse.wrapping_mul(2_u64.wrapping_sub(prime.wrapping_mul(inverse)))
        });
        // A division of words, if the number fits one, is many times faster than a division of
        // double words.
        let quotient = |value: u128| match u64::try_from(value) {
            Ok(word) => word / prime,
            Err(_) => (value / u128::from(prime)) as u64,
        };
        let remainder =
            |value: u128| (value - u128::from(quotient(value)) * u128::from(prime)) as u64;
        let one = remainder(1 << radix);
        Self {
            prime,
            one,
            square: remainder(u128::from(one) * u128::from(one)),
            inverse: inverse & ((1 << radix) - 1),
            quotient: quotient(1 << (2 * radix - 7)),
            radix,
        }
    }

    /// `left right / R`: the product of two residues, or of two digits below `R`, one of them below
    /// the prime.
    #[inline(always)]
    pub fn product(&self, left: u64, right: u64) -> u64 {
        let product = u128::from(left) * u128::from(right);
        let multiple = (product as u64).wrapping_mul(self.inverse) & ((1 << self.radix) - 1);
        let taken = ((u128::from(multiple) * u128::from(self.prime)) >> self.radix) as u64;
        self.difference((product >> self.radix) as u64, taken)
    }

    /// The difference of two residues.
    #[inline(always)]
    pub fn difference(&self, left: u64, right: u64) -> u64 {
        // A word below zero wraps around to a large one, so the smaller of the two is the residue,
        // without a branch.
        let difference = left.wrapping_sub(right);
        difference.min(difference.wrapping_add(self.prime))
    }

    /// Zero minus the residue.
    #[inline(always)]
    pub fn negative(&self, residue: u64) -> u64 {
        self.difference(0, residue)
    }

    /// The residue of a word.
    pub fn residue(&self, value: u64) -> u64 {
        let remainder = if value < self.prime { value } else { value % self.prime };
        self.product(remainder, self.square)
    }

    /// The residue of a small whole number.
    pub fn small(&self, value: i64) -> u64 {
        let size = self.residue(value.unsigned_abs());
        if value < 0 { self.negative(size) } else { size }
    }

    /// The residue of a whole number of any length.
    pub fn integer(&self, value: &Integer) -> u64 {
        let remainder = value.remainder(self.prime);
        let size = self.residue(remainder.unsigned_abs() as u64);
        if remainder < 0 { self.negative(size) } else { size }
    }

    /// A plain residue, below the prime, from one in Montgomery's form.
    pub fn plain(&self, residue: u64) -> u64 {
        self.product(residue, 1)
    }

    /// A residue in Montgomery's form from a plain one.
    pub fn of_plain(&self, plain: u64) -> u64 {
        self.product(plain, self.square)
    }

    /// `base^exponent`.
    pub fn power(&self, base: u64, mut exponent: u64) -> u64 {
        let (mut power, mut square) = (self.one, base);
        while exponent > 0 {
            if exponent % 2 == 1 {
                power = self.product(power, square);
            }
            square = self.product(square, square);
            exponent /= 2;
        }
        power
    }

    /// The inverse of a residue, by Fermat's theorem; zero for zero.
    pub fn inverse(&self, residue: u64) -> u64 {
        self.power(residue, self.prime - 2)
    }

    /// Replaces all residues by their inverses, with a single power; `None` if one of them is zero.
    pub fn invert(&self, residues: &mut [u64]) -> Option<()> {
        let mut product = self.one;
        let mut before = Vec::with_capacity(residues.len());
        for residue in residues.iter() {
            before.push(product);
            product = self.product(product, *residue);
        }
        if product == 0 {
            return None;
        }
        let mut inverse = self.inverse(product);
        for (residue, before) in residues.iter_mut().zip(before).rev() {
            let next = self.product(inverse, *residue);
            *residue = self.product(inverse, before);
            inverse = next;
        }
        Some(())
    }
}

fn prime_factors(mut number: u64) -> Vec<u64> {
    let mut factors = Vec::new();
    let mut candidate = 2;
    while candidate * candidate <= number {
        if number.is_multiple_of(candidate) {
            factors.push(candidate);
            while number.is_multiple_of(candidate) {
                number /= candidate;
            }
        }
        candidate += 1;
    }
    if number > 1 {
        factors.push(number);
    }
    factors
}

/// The primes up to `last`, in order.
pub fn primes_up_to(last: u64) -> Vec<u64> {
    let mut primes: Vec<u64> = Vec::new();
    for number in 2..=last {
        let small = primes.iter().take_while(|&prime| prime * prime <= number);
        if small.into_iter().all(|prime| !number.is_multiple_of(*prime)) {
            primes.push(number);
        }
    }
    primes
}

/// Whether a number below `2^50` is prime, by the strong test: these bases decide it below `2^61`,
/// and the first four below `3 215 031 751`.
fn is_prime(number: u64) -> bool {
    /// Y. Jiang and Y. Deng, Math. Comp. 83 (2014) 2915-2924; the first four: Pomerance, Selfridge
    /// and Wagstaff, Math. Comp. 35 (1980) 1003-1026.
    const BASES: [u64; 9] = [2, 3, 5, 7, 11, 13, 17, 19, 23];
    const FOUR_DECIDE_BELOW: u64 = 3_215_031_751;
    if let Some(divisor) = BASES.iter().find(|&base| number.is_multiple_of(*base)) {
        return number == *divisor;
    }
    let needed = if number < FOUR_DECIDE_BELOW { 4 } else { BASES.len() };
    if number < 2 {
        return false;
    }
    let modulus = Modulus::new(number, if number < 1 << 30 { 32 } else { 52 });
    let halvings = (number - 1).trailing_zeros();
    let minus_one = modulus.negative(modulus.one);
    BASES[..needed].iter().all(|&base| {
        let mut power = modulus.power(modulus.residue(base), (number - 1) >> halvings);
        if power == modulus.one {
            return true;
        }
        for _ in 1..halvings {
            if power == minus_one {
                return true;
            }
            power = modulus.product(power, power);
        }
        power == minus_one
    })
}

/// A multiple of the steps between the primes of most expansions: powers of two up to `2^11`, times
/// small odd numbers.
const COMMON_STEP: u64 = 685_341_296_640;

/// The largest primes below `2^50` that are one more than a multiple of [`COMMON_STEP`], as these
/// multiples, and beside each a number that is no q-th power modulo the prime for any prime factor q
/// of the step, so that its powers are primitive roots of unity. To find them again would take a
/// short expansion a quarter of its time.
const COMMON_PRIMES: [(u64, u64); 32] = [
    (1638, 58),
    (1634, 47),
    (1623, 47),
    (1616, 87),
    (1615, 29),
    (1598, 59),
    (1594, 89),
    (1583, 53),
    (1582, 29),
    (1577, 93),
    (1574, 79),
    (1569, 29),
    (1565, 31),
    (1561, 82),
    (1560, 29),
    (1550, 43),
    (1542, 31),
    (1540, 37),
    (1537, 31),
    (1535, 29),
    (1529, 31),
    (1525, 86),
    (1509, 47),
    (1506, 29),
    (1497, 29),
    (1494, 41),
    (1493, 29),
    (1477, 53),
    (1476, 73),
    (1465, 37),
    (1462, 82),
    (1454, 41),
];

/// A base whose power is a primitive root of unity modulo this prime, if one is known.
fn known_base(prime: u64) -> Option<u64> {
    let multiple = prime / COMMON_STEP;
    let mut known = COMMON_PRIMES.iter().filter(|_| prime % COMMON_STEP == 1);
    known.find(|(own, _)| *own == multiple).map(|(_, base)| *base)
}

/// The primes below `2^bits` that are one more than a multiple of `step`, down to half of `2^bits`;
/// `bits` is at most 50. They begin with a few that are known beforehand, where these have the
/// step; the others follow from the largest on.
pub fn primes_below(bits: u32, step: u64) -> impl Iterator<Item = u64> {
    let (highest, lowest) = ((1 << bits) - 1, 1_u64 << (bits - 1));
    let known: &[(u64, u64)] = match bits == 50 && COMMON_STEP.is_multiple_of(step) {
        true => &COMMON_PRIMES,
        false => &[],
    };
    let first = (highest - 1) / step;
    let numbers = (1..=first).rev().map(move |multiple| multiple * step + 1);
    let sought = numbers.take_while(move |&number| number > lowest).filter(move |&number| {
        is_prime(number) && (known.is_empty() || known_base(number).is_none())
    });
    known.iter().map(|(multiple, _)| multiple * COMMON_STEP + 1).chain(sought)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tests a prime by division alone.
    fn is_prime_by_division(number: u64) -> bool {
        number > 1 && (2..).take_while(|d| d * d <= number).all(|d| !number.is_multiple_of(d))
    }

    #[test]
    fn primes_are_those_without_a_divisor() {
        for number in 1..5000 {
            assert_eq!(is_prime(number), is_prime_by_division(number), "{number}");
        }
        // Products of two primes, the first of them a pseudoprime to the bases 2, 3, 5 and 7.
        for composite in [3_215_031_751, 1_000_003 * 1_000_033, 33_554_393 * 33_554_383] {
            assert!(!is_prime(composite), "{composite}");
        }
        let found: Vec<u64> = primes_below(30, 24).take(3).collect();
        assert!(found.iter().all(|p| p % 24 == 1 && is_prime_by_division(*p)), "{found:?}");
        assert_eq!(primes_up_to(30), [2, 3, 5, 7, 11, 13, 17, 19, 23, 29]);
    }

    #[test]
    fn primes_known_beforehand_are_the_largest_and_come_once() {
        let multiples = (1..=((1 << 50) - 2) / COMMON_STEP).rev();
        let primes = multiples.filter(|multiple| is_prime(multiple * COMMON_STEP + 1));
        let largest: Vec<u64> = primes.take(COMMON_PRIMES.len()).collect();
        assert_eq!(largest, COMMON_PRIMES.map(|(multiple, _)| multiple));
        for (multiple, base) in COMMON_PRIMES {
            let prime = multiple * COMMON_STEP + 1;
            let modulus = Modulus::new(prime, 52);
            assert_eq!(known_base(prime), Some(base));
            for factor in prime_factors(COMMON_STEP) {
                let power = modulus.power(modulus.residue(base), (prime - 1) / factor);
                assert_ne!(power, modulus.one, "{base} modulo {prime}");
            }
        }
        for step in [48, 8 * 17 * 4, COMMON_STEP, 4 * COMMON_STEP, 29] {
            let found: Vec<u64> = primes_below(50, step).take(100).collect();
            assert!(found.iter().all(|prime| prime % step == 1 && is_prime(*prime)));
            assert!(found.iter().all(|prime| prime >> 49 == 1));
            let mut sorted = found.clone();
            sorted.sort_unstable();
            sorted.dedup();
            assert_eq!(sorted.len(), found.len());
            assert_eq!(
                found[0] == COMMON_PRIMES[0].0 * COMMON_STEP + 1,
                COMMON_STEP.is_multiple_of(step)
            );
        }
    }

    #[test]
    fn residues_multiply_as_whole_numbers_do() {
        for (bits, radix) in [(50, 52), (30, 32)] {
            for prime in primes_below(bits, 48).take(3) {
                let modulus = Modulus::new(prime, radix);
                let mut value = 12_345;
                for other in [0, 1, 2, prime - 1, prime / 2, 987_654_321 % prime] {
                    let product = modulus.product(modulus.residue(value), modulus.residue(other));
                    let expected = u128::from(value) * u128::from(other) % u128::from(prime);
                    assert_eq!(u128::from(modulus.plain(product)), expected);
                    value = (value * 31 + other) % prime;
                }
                let inverse = modulus.inverse(modulus.small(-7));
                assert_eq!(modulus.product(inverse, modulus.small(-7)), modulus.one);
                for count in 0..10 {
                    let own: Vec<u64> = (0..count).map(|k| modulus.small(3 * k - 5)).collect();
                    let mut inverses = own.clone();
                    modulus.invert(&mut inverses).expect("none is zero");
                    for (own, inverse) in own.iter().zip(&inverses) {
                        assert_eq!(modulus.product(*own, *inverse), modulus.one);
                    }
                    inverses.push(0);
                    assert_eq!(modulus.invert(&mut inverses), None);
                }
                let fifth = modulus.power(modulus.small(-5), 5);
                assert_eq!(fifth, modulus.small(-3125));
            }
        }
    }
}
