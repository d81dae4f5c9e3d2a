//! Residues modulo eight primes side by side, or eight modulo one.
//!
//! The operations of a [`Modulus`], eight at a time: a whole computation runs modulo eight primes
//! at once, and no number ever moves from one lane to another. The functions of this module are
//! inlined into functions that are compiled for the processor; closures would not be, hence the
//! loops.

use super::{Arithmetic, Lanes, Modulus, WIDTH, known_base, prime_factors};

/// Eight primes, and the constants that a [`Modulus`] keeps for each.
#[derive(Clone, Copy, Debug)]
pub struct Moduli {
    /// The primes.
    pub prime: Lanes,
    /// One in Montgomery's form.
    pub one: Lanes,
    pub(super) square: Lanes,
    pub(super) inverse: Lanes,
    pub(super) quotient: Lanes,
}

impl Moduli {
    /// One prime in all eight lanes.
    #[inline(always)]
    pub fn all(modulus: &Modulus) -> Self {
        Self {
            prime: Lanes::all(modulus.prime),
            one: Lanes::all(modulus.one),
            square: Lanes::all(modulus.square),
            inverse: Lanes::all(modulus.inverse),
            quotient: Lanes::all(modulus.quotient),
        }
    }

    /// Takes up to eight primes; the last one is repeated in the remaining lanes.
    ///
    /// # Panics
    ///
    /// If there is no prime.
    pub fn from_primes(moduli: &[Modulus]) -> Self {
        let last = moduli.len() - 1;
        let lanes = |part: fn(&Modulus) -> u64| {
            Lanes(std::array::from_fn(|lane| part(&moduli[lane.min(last)])))
        };
        Self {
            prime: lanes(|modulus| modulus.prime),
            one: lanes(|modulus| modulus.one),
            square: lanes(|modulus| modulus.square),
            inverse: lanes(|modulus| modulus.inverse),
            quotient: lanes(|modulus| modulus.quotient),
        }
    }
}

/// The arithmetic modulo eight primes; residues are in Montgomery's form.
#[derive(Clone, Copy, Debug)]
pub struct Residues<A> {
    /// The arithmetic of sums of products.
    pub arithmetic: A,
    /// The primes.
    pub moduli: Moduli,
}

impl<A: Arithmetic> Residues<A> {
    /// One in Montgomery's form.
    #[inline(always)]
    pub fn one(&self) -> Lanes {
        self.moduli.one
    }

    /// The sum of residues.
    #[inline(always)]
    pub fn sum(&self, left: Lanes, right: Lanes) -> Lanes {
        self.arithmetic.sum(&left, &right, &self.moduli)
    }

    /// The difference of residues.
    #[inline(always)]
    pub fn difference(&self, left: Lanes, right: Lanes) -> Lanes {
        self.arithmetic.difference(&left, &right, &self.moduli)
    }

    /// Zero minus the residue.
    #[inline(always)]
    pub fn negative(&self, residue: Lanes) -> Lanes {
        self.difference(Lanes::default(), residue)
    }

    /// The product of residues.
    #[inline(always)]
    pub fn product(&self, left: Lanes, right: Lanes) -> Lanes {
        self.arithmetic.product(&left, &right, &self.moduli)
    }

    /// Reduces a sum of products.
    #[inline(always)]
    pub fn reduce(&self, sum: A::Sum) -> Lanes {
        self.arithmetic.reduce(sum, &self.moduli)
    }

    /// The residues of a whole number below all primes.
    #[inline(always)]
    pub fn small(&self, value: usize) -> Lanes {
        self.product(Lanes::all(value as u64), self.moduli.square)
    }

    /// Plain residues, below the primes.
    #[inline(always)]
    pub fn plain(&self, residues: Lanes) -> Lanes {
        self.product(residues, Lanes::all(1))
    }

    /// The powers of residues, each with its own exponent.
    #[inline(always)]
    pub fn power(&self, base: Lanes, exponents: Lanes) -> Lanes {
        let mut any = 0;
        for exponent in exponents.0 {
            any |= exponent;
        }
        // From the lowest digit on, neither of the two products of a digit waits for the other.
        let (mut power, mut square) = (self.one(), base);
        for digit in 0..u64::BITS - any.leading_zeros() {
            let product = self.product(power, square);
            square = self.product(square, square);
            for lane in 0..WIDTH {
                if exponents.0[lane] >> digit & 1 == 1 {
                    power.0[lane] = product.0[lane];
                }
            }
        }
        power
    }

    /// The inverses, by Fermat's theorem; zero for zero.
    #[inline(always)]
    pub fn inverse(&self, residues: Lanes) -> Lanes {
        let mut exponents = self.moduli.prime;
        for exponent in &mut exponents.0 {
            *exponent -= 2;
        }
        self.power(residues, exponents)
    }

    /// Replaces all residues by their inverses, with a single power; `None` if one of them is zero
    /// modulo some prime.
    #[inline(always)]
    pub fn invert(&self, residues: &mut [Lanes]) -> Option<()> {
        /// Number of independent chains of products, which do not wait for each other.
        const CHAINS: usize = 4;
        let one = self.one();
        let mut products = [one; CHAINS];
        let mut before = vec![one; residues.len()];
        for (place, residue) in residues.iter().enumerate() {
            let product = &mut products[place % CHAINS];
            before[place] = *product;
            *product = self.product(*product, *residue);
        }
        let [a, b, c, d] = products;
        let (lower, upper) = (self.product(a, b), self.product(c, d));
        let all = self.product(lower, upper);
        if all.0.contains(&0) {
            return None;
        }
        let inverse = self.inverse(all);
        let (lower, upper) = (self.product(inverse, upper), self.product(inverse, lower));
        let mut inverses = [
            self.product(lower, b),
            self.product(lower, a),
            self.product(upper, d),
            self.product(upper, c),
        ];
        for (place, residue) in residues.iter_mut().enumerate().rev() {
            let inverse = &mut inverses[place % CHAINS];
            let next = self.product(*inverse, *residue);
            *residue = self.product(*inverse, before[place]);
            *inverse = next;
        }
        Some(())
    }

    /// Returns `count` powers `1, base, base^2, ...`.
    #[inline(always)]
    pub fn powers(&self, base: Lanes, count: usize) -> Vec<Lanes> {
        let mut powers = vec![self.one(); count];
        let mut next = base;
        // Their number doubles each time, so that no power has to wait for the one before it.
        let mut known = 1;
        while known < count {
            for place in 0..known.min(count - known) {
                powers[known + place] = self.product(powers[place], next);
            }
            next = self.product(next, next);
            known *= 2;
        }
        powers
    }

    /// Returns primitive roots of unity of this order; `None` if `order` does not divide every
    /// prime minus one.
    #[inline(always)]
    pub fn root_of_unity(&self, order: u64) -> Option<Lanes> {
        /// The largest base that is tried; one of the first few numbers leads to a primitive root.
        const LARGEST_BASE: u64 = 1000;
        let mut exponents = self.moduli.prime;
        for exponent in &mut exponents.0 {
            if (*exponent - 1) % order != 0 {
                return None;
            }
            *exponent = (*exponent - 1) / order;
        }
        let factors = prime_factors(order);
        let mut found = Lanes::default();
        for base in 1..LARGEST_BASE {
            let mut bases = Lanes::all(base);
            if base == 1 {
                for (own, prime) in bases.0.iter_mut().zip(self.moduli.prime.0) {
                    *own = known_base(prime).unwrap_or(2);
                }
            }
            let root = self.power(self.product(bases, self.moduli.square), exponents);
            let mut is_primitive = [true; WIDTH];
            for factor in &factors {
                let power = self.power(root, Lanes::all(order / factor));
                for (lane, is_primitive) in is_primitive.iter_mut().enumerate() {
                    *is_primitive &= power.0[lane] != self.moduli.one.0[lane];
                }
            }
            for (lane, is_primitive) in is_primitive.into_iter().enumerate() {
                if found.0[lane] == 0 && is_primitive {
                    found.0[lane] = root.0[lane];
                }
            }
            if !found.0.contains(&0) {
                return Some(found);
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::super::portable::Portable;
    use super::super::{Work, by_widest, primes_below};
    use super::*;

    struct LanesAgainstScalars;

    impl Work for LanesAgainstScalars {
        type Output = ();

        fn run<A: Arithmetic>(self, arithmetic: A) {
            let moduli: Vec<Modulus> = primes_below(A::BITS, 48)
                .take(WIDTH - 1)
                .map(|prime| Modulus::new(prime, A::RADIX))
                .collect();
            let residues = Residues { arithmetic, moduli: Moduli::from_primes(&moduli) };
            let modulus = |lane: usize| &moduli[lane.min(WIDTH - 2)];
            let mut own: Vec<Lanes> = (3..40).map(|k| residues.small(k * k + 1)).collect();
            let inverses = {
                let mut inverses = own.clone();
                residues.invert(&mut inverses).expect("none is zero");
                inverses
            };
            let root = residues.root_of_unity(48).expect("48 divides each prime minus one");
            assert!(residues.root_of_unity(1 << 40).is_none());
            let powers = residues.powers(root, 50);
            for lane in 0..WIDTH {
                let modulus = modulus(lane);
                for (k, (own, inverse)) in own.iter().zip(&inverses).enumerate() {
                    let value = modulus.small(((k + 3) * (k + 3) + 1) as i64);
                    assert_eq!(own.0[lane], value);
                    assert_eq!(inverse.0[lane], modulus.inverse(value));
                    let other = inverses[0].0[lane];
                    assert_eq!(
                        residues.product(*own, inverses[0]).0[lane],
                        modulus.product(value, other)
                    );
                    assert_eq!(
                        residues.sum(*own, inverses[0]).0[lane],
                        (value + other) % modulus.prime
                    );
                    let difference = residues.difference(*own, inverses[0]);
                    assert_eq!(difference.0[lane], modulus.difference(value, other));
                    assert_eq!(residues.plain(*own).0[lane], modulus.plain(value));
                }
                assert_eq!(modulus.power(root.0[lane], 24), modulus.negative(modulus.one));
                assert_ne!(modulus.power(root.0[lane], 16), modulus.one);
                assert_eq!(powers[49].0[lane], root.0[lane]);
            }
            own.push(Lanes::default());
            assert_eq!(residues.invert(&mut own), None);
        }
    }

    #[test]
    fn eight_primes_are_as_each_alone() {
        LanesAgainstScalars.run(Portable);
        by_widest(LanesAgainstScalars);
    }
}
