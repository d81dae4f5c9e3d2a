//! Positive roots of polynomials with rational coefficients.
//!
//! Reference: D. E. Knuth, *The Art of Computer Programming* 2, 3rd ed., section 4.6.1 (greatest
//! common divisors) and exercise 4.6.1-22 (Sturm's theorem).
//!
//! `gcd(p, p')` separates simple from multiple roots, rational roots are found as quotients of
//! divisors, and the others are isolated by Sturm's chain: `V(a) - V(b)` roots lie in `(a, b]`,
//! where `V` is the number of sign changes of the chain. A polynomial is the list of its
//! coefficients, lowest first.

use std::cmp::Ordering;

use num_integer::Integer as _;
use num_traits::{One, Signed, ToPrimitive, Zero};

use super::rational::{ratio, to_f64};
use super::residue::{Modulus, primes_below};
use super::{Integer, Rational};

/// A positive root.
#[derive(Clone, Debug, PartialEq)]
pub struct RealRoot {
    /// The root, rounded.
    pub value: f64,
    /// The root as a fraction; `None` if it was not found to be one.
    pub exact: Option<Rational>,
    /// A polynomial without multiple roots that has this root, and no rational root unless this one
    /// is rational.
    pub factor: Vec<Rational>,
    /// Whether it is a simple root of the given polynomial, whose slope there is then not zero.
    pub simple: bool,
}

/// All positive roots of a polynomial that is not zero, smallest first.
pub fn positive_roots(polynomial: &[Rational]) -> Vec<RealRoot> {
    let polynomial = trimmed(polynomial.to_vec());
    let shared = gcd(&polynomial, &derivative(&polynomial));
    let distinct = quotient(&polynomial, &shared);
    let multiple = gcd(&distinct, &shared);
    let mut roots = Vec::new();
    for (part, simple) in [(quotient(&distinct, &multiple), true), (multiple, false)] {
        let mut rest = part;
        for exact in fractions(&rest) {
            let factor = vec![-exact.clone(), One::one()];
            rest = quotient(&rest, &factor);
            roots.push(RealRoot { value: to_f64(&exact), exact: Some(exact), factor, simple });
        }
        roots.extend(irrational(&rest).into_iter().map(|value| RealRoot {
            value,
            exact: None,
            factor: rest.clone(),
            simple,
        }));
    }
    roots.sort_by(|a, b| a.value.total_cmp(&b.value));
    roots
}

/// A polynomial without multiple roots that has the sign of this one wherever neither is zero: the
/// product of its factors of odd multiplicity. (D. R. Musser, *J. ACM* 22 (1975) 291: the factors
/// of multiplicity 1, 2, ... one after the other.)
pub fn sign_changing_part(polynomial: &[Rational]) -> Vec<Rational> {
    let polynomial = trimmed(polynomial.to_vec());
    let mut shared = gcd(&polynomial, &derivative(&polynomial));
    if shared.len() < 2 {
        return polynomial;
    }
    let mut distinct = quotient(&polynomial, &shared);
    let leading = distinct.last().cloned();
    let mut part: Vec<Rational> = leading.into_iter().collect();
    let mut is_odd = true;
    while distinct.len() > 1 {
        let more = gcd(&distinct, &shared);
        if is_odd {
            let factor = quotient(&distinct, &more);
            let monic: Vec<Rational> =
                factor.iter().map(|c| c / &factor[factor.len() - 1]).collect();
            part = product(&part, &monic);
        }
        shared = quotient(&shared, &more);
        (distinct, is_odd) = (more, !is_odd);
    }
    part
}

/// The derivative of a polynomial.
pub fn derivative(polynomial: &[Rational]) -> Vec<Rational> {
    let powers = polynomial.iter().enumerate().skip(1);
    powers.map(|(k, c)| c * Rational::from_integer(k.into())).collect()
}

/// The polynomial `u` of lowest degree with `a u = 1` modulo `modulus`; `None` if they have a
/// factor in common.
pub fn inverse_modulo(a: &[Rational], modulus: &[Rational]) -> Option<Vec<Rational>> {
    let (mut r, mut next_r) = (trimmed(modulus.to_vec()), remainder(a, modulus));
    let (mut u, mut next_u) = (vec![], vec![Rational::one()]);
    while !next_r.is_empty() {
        let q = quotient(&r, &next_r);
        let new_u = difference(&u, &product(&q, &next_u));
        let new_r = remainder(&r, &next_r);
        (r, next_r) = (next_r, new_r);
        (u, next_u) = (next_u, new_u);
    }
    match r.as_slice() {
        [unit] => Some(remainder(&u.iter().map(|c| c / unit).collect::<Vec<_>>(), modulus)),
        _ => None,
    }
}

/// The remainder of a division.
pub fn remainder(dividend: &[Rational], divisor: &[Rational]) -> Vec<Rational> {
    divide(dividend, divisor).1
}

pub(super) fn quotient(dividend: &[Rational], divisor: &[Rational]) -> Vec<Rational> {
    divide(dividend, divisor).0
}

fn divide(dividend: &[Rational], divisor: &[Rational]) -> (Vec<Rational>, Vec<Rational>) {
    let mut rest = trimmed(dividend.to_vec());
    let Some((leading, _)) = divisor.split_last() else {
        return (vec![], rest);
    };
    let mut quotient = vec![Rational::zero(); (rest.len() + 1).saturating_sub(divisor.len())];
    while rest.len() >= divisor.len() {
        let shift = rest.len() - divisor.len();
        let factor = &rest[rest.len() - 1] / leading;
        for (k, coefficient) in divisor.iter().enumerate() {
            rest[shift + k] -= &factor * coefficient;
        }
        quotient[shift] = factor;
        rest.pop();
        rest = trimmed(rest);
    }
    (trimmed(quotient), rest)
}

/// The monic greatest common divisor.
pub(super) fn gcd(a: &[Rational], b: &[Rational]) -> Vec<Rational> {
    let (mut a, mut b) = (trimmed(a.to_vec()), trimmed(b.to_vec()));
    let monic = |list: &[Rational]| -> Vec<Rational> {
        list.last().map_or(vec![], |leading| list.iter().map(|c| c / leading).collect())
    };
    if let Some(found) = gcd_by_residues(&primitive(&a), &primitive(&b)) {
        return monic(&found.into_iter().map(Rational::from_integer).collect::<Vec<_>>());
    }
    while !b.is_empty() {
        let next = remainder(&a, &b);
        (a, b) = (b, next);
    }
    monic(&a)
}

/// The greatest common divisor of two primitive polynomials by Euclid's algorithm modulo primes, whose
/// coefficients do not grow, and the Chinese remainder theorem (W. S. Brown, *J. ACM* 18 (1971) 478); `None`
/// if one of them is zero, or the primes tell too little.
///
/// Modulo a prime that divides no leading coefficient the degree is not lower than that of the true
/// divisor, so that what divides both is it. Another prime is taken where the coefficients do not fit the
/// product of those before: they then change.
fn gcd_by_residues(a: &[Integer], b: &[Integer]) -> Option<Vec<Integer>> {
    /// The largest prime below 2^59, and the radix of its multiplication; the bits and the radix of others.
    const FIRST: (u64, u32) = ((1 << 59) - 55, 62);
    const OTHERS: (u32, u32) = (50, 52);
    /// Largest number of primes.
    const MOST: usize = 30;
    let others = primes_below(OTHERS.0, 8).map(|prime| (prime, OTHERS.1));
    // The leading coefficient of the true divisor divides that of both.
    let leading = a.last()?.gcd(b.last()?);
    let mut known: Option<CombinedResidues> = None;
    let mut before: Vec<Integer> = vec![];
    for (prime, radix) in std::iter::once(FIRST).chain(others).take(MOST) {
        let modulus = Modulus::new(prime, radix);
        let Some(shared) = gcd_modulo(&modulus, a, b) else { continue };
        if shared.len() == 1 {
            return Some(vec![Integer::one()]);
        }
        let unit = modulus.product(modulus.integer(&leading), modulus.inverse(*shared.last()?));
        let residues: Vec<u64> = shared.iter().map(|c| modulus.product(*c, unit)).collect();
        let is_first = known.is_none();
        match &mut known {
            // A prime by which the degree is too high tells nothing.
            Some(known) if known.values.len() < residues.len() => continue,
            Some(known) if known.values.len() == residues.len() => known.add(&modulus, &residues),
            _ => known = Some(CombinedResidues::new(&modulus, &residues)),
        }
        let centred = known.as_ref()?.centred();
        if is_first || centred == before {
            let found = without_content(centred.clone());
            if is_divisor(&found, a) && is_divisor(&found, b) {
                return Some(found);
            }
        }
        before = centred;
    }
    None
}

/// The greatest common divisor of two polynomials modulo a prime, in its residues; `None` if the prime divides
/// a leading coefficient, or one of the polynomials is zero.
fn gcd_modulo(modulus: &Modulus, a: &[Integer], b: &[Integer]) -> Option<Vec<u64>> {
    let residues = |list: &[Integer]| -> Option<Vec<u64>> {
        let all: Vec<u64> = list.iter().map(|number| modulus.integer(number)).collect();
        all.last().is_some_and(|leading| *leading != 0).then_some(all)
    };
    let (mut shared, mut rest) = (residues(a)?, residues(b)?);
    while !rest.is_empty() {
        let unit = modulus.inverse(*rest.last()?);
        rest.iter_mut().for_each(|c| *c = modulus.product(*c, unit));
        while shared.len() >= rest.len() {
            let shift = shared.len() - rest.len();
            let factor = *shared.last()?;
            for (k, c) in rest.iter().enumerate() {
                let taken = modulus.product(factor, *c);
                shared[shift + k] = modulus.difference(shared[shift + k], taken);
            }
            while shared.last() == Some(&0) {
                shared.pop();
            }
        }
        (shared, rest) = (rest, shared);
    }
    Some(shared)
}

/// Whole numbers by their remainders modulo a product of primes.
struct CombinedResidues {
    product: Integer,
    values: Vec<Integer>,
}

impl CombinedResidues {
    /// The remainders modulo one prime.
    fn new(modulus: &Modulus, residues: &[u64]) -> Self {
        let values = residues.iter().map(|c| Integer::from(modulus.plain(*c))).collect();
        Self { product: Integer::from(modulus.prime), values }
    }

    /// Takes the remainders modulo another prime into account.
    fn add(&mut self, modulus: &Modulus, residues: &[u64]) {
        let unit = modulus.inverse(modulus.integer(&self.product));
        for (value, residue) in self.values.iter_mut().zip(residues) {
            let apart = modulus.difference(*residue, modulus.integer(value));
            let multiple = modulus.plain(modulus.product(apart, unit));
            *value += &self.product * Integer::from(multiple);
        }
        self.product = &self.product * Integer::from(modulus.prime);
    }

    /// The numbers of least size with these remainders.
    fn centred(&self) -> Vec<Integer> {
        let half = &self.product / Integer::from(2);
        let centred = |value: &Integer| match *value > half {
            true => value - &self.product,
            false => value.clone(),
        };
        self.values.iter().map(centred).collect()
    }
}

/// Whether a primitive polynomial divides another one; the quotient then has whole coefficients.
fn is_divisor(divisor: &[Integer], dividend: &[Integer]) -> bool {
    let Some(leading) = divisor.last() else { return false };
    let mut rest = dividend.to_vec();
    while rest.len() >= divisor.len() {
        let shift = rest.len() - divisor.len();
        let Some(highest) = rest.pop() else { return false };
        let (factor, left) = highest.div_rem(leading);
        if !left.is_zero() {
            return false;
        }
        for (k, c) in divisor[..divisor.len() - 1].iter().enumerate() {
            rest[shift + k] -= &factor * c;
        }
    }
    rest.iter().all(Zero::is_zero)
}

/// The product, by whole numbers over a common denominator, so that each coefficient is reduced once.
pub(super) fn product(a: &[Rational], b: &[Rational]) -> Vec<Rational> {
    let whole = |list: &[Rational]| -> (Vec<Integer>, Integer) {
        let common = list.iter().fold(Integer::one(), |lcm, c| lcm.lcm(c.denom()));
        (list.iter().map(|c| c.numer() * (&common / c.denom())).collect(), common)
    };
    let ((left, below), (right, own)) = (whole(a), whole(b));
    let below = below * own;
    let mut sum = vec![Integer::zero(); (a.len() + b.len()).saturating_sub(1)];
    for (i, left) in left.iter().enumerate() {
        for (k, right) in right.iter().enumerate() {
            sum[i + k] += left * right;
        }
    }
    trimmed(sum.into_iter().map(|c| Rational::new(c, below.clone())).collect())
}

pub(super) fn difference(a: &[Rational], b: &[Rational]) -> Vec<Rational> {
    let at = |list: &[Rational], k: usize| list.get(k).cloned().unwrap_or_else(Rational::zero);
    trimmed((0..a.len().max(b.len())).map(|k| at(a, k) - at(b, k)).collect())
}

pub(super) fn trimmed(mut polynomial: Vec<Rational>) -> Vec<Rational> {
    while polynomial.last().is_some_and(Zero::is_zero) {
        polynomial.pop();
    }
    polynomial
}

/// Returns the primitive polynomial: whole numbers without common divisor in the ratio of the
/// coefficients, with the same signs.
pub(super) fn primitive(polynomial: &[Rational]) -> Vec<Integer> {
    let common = polynomial.iter().fold(Integer::one(), |lcm, c| lcm.lcm(c.denom()));
    without_content(polynomial.iter().map(|c| (c * &common).to_integer()).collect())
}

fn without_content(mut whole: Vec<Integer>) -> Vec<Integer> {
    while whole.last().is_some_and(Zero::is_zero) {
        whole.pop();
    }
    let content = whole.iter().fold(Integer::zero(), |gcd, c| gcd.gcd(c));
    whole.iter().map(|c| c / &content).collect()
}

/// Returns the sign of a polynomial at a fraction, computed from its value times a power of the
/// denominator, so that no fraction has to be reduced.
fn sign_at(whole: &[Integer], x: &Rational) -> Ordering {
    let mut power = Integer::one();
    let mut sum = Integer::zero();
    for coefficient in whole.iter().rev() {
        sum = sum * x.numer() + coefficient * &power;
        power *= x.denom();
    }
    sum.cmp(&Integer::zero())
}

/// Returns the positive rational roots of a polynomial without multiple roots, as far as divisors
/// are found by trial division.
fn fractions(polynomial: &[Rational]) -> Vec<Rational> {
    let whole = primitive(polynomial);
    let (Some(lowest), Some(highest)) = (whole.iter().find(|c| !c.is_zero()), whole.last()) else {
        return vec![];
    };
    let residues: Vec<u64> = whole.iter().map(modulo_prime).collect();
    let mut roots: Vec<Rational> = Vec::new();
    let numerators = divisors(lowest);
    for q in divisors(highest) {
        let inverse = power_modulo_prime(q, PRIME - 2);
        for &p in numerators.iter().filter(|p| p.gcd(&q).is_one()) {
            // A root is a root modulo a prime as well, which is tested first because it is cheap.
            let x = times_modulo_prime(p, inverse);
            let vanishes =
                residues.iter().rev().fold(0, |sum, &c| (times_modulo_prime(sum, x) + c) % PRIME);
            let candidate = Rational::new(p.into(), q.into());
            if vanishes == 0 && sign_at(&whole, &candidate).is_eq() {
                roots.push(candidate);
            }
        }
    }
    roots
}

/// A prime above all divisors that are tried, and small enough that the sum of two residues fits 64
/// bits.
const PRIME: u64 = (1 << 61) - 1;

fn modulo_prime(number: &Integer) -> u64 {
    number.mod_floor(&Integer::from(PRIME)).to_u64().unwrap_or(0)
}

fn times_modulo_prime(a: u64, b: u64) -> u64 {
    let product = u128::from(a) * u128::from(b) % u128::from(PRIME);
    u64::try_from(product).unwrap_or(0)
}

fn power_modulo_prime(base: u64, mut exponent: u64) -> u64 {
    let (mut power, mut square) = (1, base % PRIME);
    while exponent > 0 {
        if exponent % 2 == 1 {
            power = times_modulo_prime(power, square);
        }
        square = times_modulo_prime(square, square);
        exponent /= 2;
    }
    power
}

/// Returns all positive divisors of a number small enough for trial division; for any other number
/// only 1.
fn divisors(number: &Integer) -> Vec<u64> {
    let Some(number) = number.abs().to_u64().filter(|number| *number < 1 << 40) else {
        return vec![1];
    };
    let small = (1..).take_while(|d| d * d <= number).filter(|d| number % d == 0);
    let mut all: Vec<u64> = small.flat_map(|d| [d, number / d]).collect();
    all.dedup();
    all
}

/// A positive multiple of the remainder of a division, in whole numbers.
fn pseudo_remainder(dividend: &[Integer], divisor: &[Integer]) -> Vec<Integer> {
    let mut rest = dividend.to_vec();
    let Some(leading) = divisor.last() else {
        return rest;
    };
    while rest.len() >= divisor.len() {
        let shift = rest.len() - divisor.len();
        let Some(first) = rest.pop() else { break };
        if first.is_zero() {
            continue;
        }
        let factor = if leading.is_negative() { -first } else { first };
        for (k, value) in rest.iter_mut().enumerate() {
            *value *= leading.abs();
            if let Some(coefficient) = k.checked_sub(shift).and_then(|k| divisor.get(k)) {
                *value -= &factor * coefficient;
            }
        }
    }
    without_content(rest)
}

/// Returns the positive roots of a polynomial without multiple roots, rounded, by Sturm's chain.
fn irrational(polynomial: &[Rational]) -> Vec<f64> {
    let Some((leading, rest)) = polynomial.split_last().filter(|(_, rest)| !rest.is_empty()) else {
        return vec![];
    };
    let whole = primitive(polynomial);
    let mut chain = vec![whole.clone(), primitive(&derivative(polynomial))];
    while let [.., before, last] = chain.as_slice() {
        let next: Vec<Integer> = pseudo_remainder(before, last).iter().map(|c| -c).collect();
        if next.is_empty() {
            break;
        }
        chain.push(next);
    }
    let changes = |x: &Rational| {
        let signs: Vec<Ordering> =
            chain.iter().map(|entry| sign_at(entry, x)).filter(|sign| sign.is_ne()).collect();
        signs.windows(2).filter(|pair| pair[0] != pair[1]).count()
    };
    // All roots are below 1 + max |c_k / c_n|.
    let bound = rest.iter().map(|c| (c / leading).abs()).max().unwrap_or_else(Rational::zero)
        + Rational::one();
    let ends = [Rational::zero(), bound].map(|end| (changes(&end), end));
    let mut intervals = vec![ends];
    let mut roots = Vec::new();
    while let Some([low, high]) = intervals.pop() {
        match low.0.saturating_sub(high.0) {
            0 => {}
            1 => roots.push(only_root(&whole, low.1, high.1)),
            _ => {
                let middle = (&low.1 + &high.1) * ratio(1, 2);
                let middle = (changes(&middle), middle);
                intervals.extend([[low, middle.clone()], [middle, high]]);
            }
        }
    }
    roots
}

/// Returns the only root in `(low, high]`, at which the polynomial changes its sign, by bisection
/// down to neighbouring doubles.
fn only_root(whole: &[Integer], mut low: Rational, mut high: Rational) -> f64 {
    let beyond = sign_at(whole, &high);
    if beyond.is_eq() {
        return to_f64(&high);
    }
    loop {
        let middle = (&low + &high) * ratio(1, 2);
        let value = to_f64(&middle);
        if to_f64(&low) == to_f64(&high) || value == to_f64(&low) || value == to_f64(&high) {
            return value;
        }
        match sign_at(whole, &middle) {
            Ordering::Equal => return value,
            sign if sign == beyond => high = middle,
            _ => low = middle,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polynomial(coefficients: &[i64]) -> Vec<Rational> {
        coefficients.iter().map(|&c| ratio(c, 1)).collect()
    }

    /// A divisor whose coefficients need several primes, and factors without a common one.
    #[test]
    fn a_common_divisor_of_long_coefficients_is_found_by_residues() {
        let list = |numbers: &[Integer]| without_content(numbers.to_vec());
        let times = |a: &[Integer], b: &[Integer]| -> Vec<Integer> {
            let mut sum = vec![Integer::zero(); a.len() + b.len() - 1];
            for (i, left) in a.iter().enumerate() {
                for (k, right) in b.iter().enumerate() {
                    sum[i + k] += left * right;
                }
            }
            list(&sum)
        };
        let small = |numbers: &[i64]| numbers.iter().map(|c| Integer::from(*c)).collect::<Vec<_>>();
        let (left, right) = (small(&[3, -5, 7]), small(&[-2, 9, 0, 11]));
        for length in [1_u32, 40, 200, 700] {
            let long =
                |base: i64| -> Integer { num_traits::pow(Integer::from(base), length as usize) };
            let divisor = list(&[long(3), -long(5), long(7), -long(2)]);
            let found = gcd_by_residues(&times(&divisor, &left), &times(&divisor, &right));
            let Some(found) = found else {
                // The coefficients are longer than all primes together.
                assert_eq!(length, 700);
                continue;
            };
            let same = found == divisor || found.iter().zip(&divisor).all(|(a, b)| *a == -b);
            assert!(same && found.len() == 4, "{length}: {found:?}");
        }
        assert_eq!(gcd_by_residues(&left, &right), Some(vec![Integer::one()]));
    }

    /// (z - 2)(z - 1/3)(z^2 - 6 z + 4)(z + 1)(z - 5)^2: fractions, quadratic roots 3 -+ sqrt 5, a
    /// double root.
    #[test]
    fn roots_of_every_kind() {
        let factors: [&[i64]; 6] = [&[-2, 1], &[-1, 3], &[4, -6, 1], &[1, 1], &[-5, 1], &[-5, 1]];
        let all =
            factors.iter().fold(polynomial(&[1]), |all, factor| product(&all, &polynomial(factor)));
        let roots = positive_roots(&all);
        let expected = [1.0 / 3.0, 3.0 - 5f64.sqrt(), 2.0, 5.0, 3.0 + 5f64.sqrt()];
        assert_eq!(roots.len(), 5);
        for (root, expected) in roots.iter().zip(expected) {
            assert!((root.value - expected).abs() < 1e-15 * 8.0, "{root:?} {expected}");
            assert_eq!(root.simple, expected != 5.0);
        }
        assert_eq!(roots[0].exact, Some(ratio(1, 3)));
        assert!(roots[1].exact.is_none() && roots[1].factor.len() == 4);
    }

    /// Divisors of products with a known common factor: none, one of large numbers, and one where the prime
    /// of the residues divides a leading coefficient.
    #[test]
    fn the_common_divisor_is_the_common_factor() {
        let large = ratio(10_i64.pow(18) + 9, 7).pow(5);
        let parts = [
            vec![ratio(-3, 7), ratio(2, 5), ratio(1, 1)],
            vec![large.clone(), -large, ratio(4, 3)],
            vec![ratio(1, 1), ratio((1 << 59) - 55, 1)],
        ];
        for shared in [&polynomial(&[5]), &parts[0], &parts[1], &parts[2]] {
            let [a, b] = [[-2, 0, 3], [7, 1, -4]].map(|other| product(shared, &polynomial(&other)));
            let monic: Vec<Rational> =
                shared.iter().map(|c| c / &shared[shared.len() - 1]).collect();
            assert_eq!(gcd(&a, &b), monic);
            assert_eq!(gcd(&[], &b).len(), b.len());
        }
    }

    /// -3 (z - 2)(z - 5)^2 (3 z - 1)^3 (z^2 + 1)^2: what is left is -3 (z - 2)(z - 1/3).
    #[test]
    fn what_changes_its_sign_has_the_factors_of_odd_multiplicity() {
        let factors: [&[i64]; 8] =
            [&[-2, 1], &[-5, 1], &[-5, 1], &[-1, 3], &[-1, 3], &[-1, 3], &[1, 0, 1], &[1, 0, 1]];
        let all = factors
            .iter()
            .fold(polynomial(&[-3]), |all, factor| product(&all, &polynomial(factor)));
        let part = sign_changing_part(&all);
        let roots = positive_roots(&part);
        let values: Vec<f64> = roots.iter().map(|root| root.value).collect();
        assert_eq!((part.len(), values), (3, vec![1.0 / 3.0, 2.0]));
        for place in [-7, 0, 1, 3, 4, 6] {
            let at = |polynomial: &[Rational]| sign_at(&primitive(polynomial), &ratio(place, 1));
            assert_eq!(at(&part), at(&all), "{place}");
        }
        let once = polynomial(&[-6, 5, -1]);
        assert_eq!(sign_changing_part(&once), once);
    }

    #[test]
    fn close_and_distant_roots_are_told_apart() {
        // (z^2 - 2)(z^2 - 2 - 1e-9)(z^2 - 2e20) and one without positive roots.
        let near: Vec<Rational> =
            vec![-(ratio(2, 1) + ratio(1, 1_000_000_000)), Zero::zero(), One::one()];
        let far = vec![-ratio(2, 1) * num_traits::pow(ratio(10, 1), 20), Zero::zero(), One::one()];
        let all = product(&product(&polynomial(&[-2, 0, 1]), &near), &far);
        let roots: Vec<f64> = positive_roots(&all).iter().map(|root| root.value).collect();
        assert_eq!(roots.len(), 3);
        assert!(
            (roots[1] - roots[0] - 1e-9 / 8f64.sqrt()).abs() < 1e-15
                && (roots[2] / 2e20f64.sqrt() - 1.0).abs() < 1e-15
        );
        assert!(positive_roots(&polynomial(&[1, 1, 1])).is_empty());
        assert!(positive_roots(&polynomial(&[7])).is_empty());
    }

    #[test]
    fn high_degrees_end_soon() {
        // 1 - c z^100 with c as van der Pol's first order has it for x^200, and the product of (z -
        // k/7) for k up to 30.
        let c = (1..=100).fold(ratio(1, 101), |c, k| c * ratio(100 + k, 4 * k));
        let mut power = vec![Rational::zero(); 101];
        (power[0], power[100]) = (ratio(1, 1), -c.clone());
        let [root] = positive_roots(&power).try_into().expect("one root");
        assert!((root.value.ln() + to_f64(&c).ln() / 100.0).abs() < 1e-15);
        let factors = (1..=30).map(|k| polynomial(&[-k, 7]));
        let all = factors.fold(polynomial(&[1]), |all, factor| product(&all, &factor));
        let roots = positive_roots(&all);
        assert_eq!(roots.len(), 30);
        for (k, root) in (1..).zip(&roots) {
            assert!((root.value - f64::from(k) / 7.0).abs() < 1e-14 && root.simple, "{root:?}");
        }
    }

    #[test]
    fn inverses_modulo_a_polynomial() {
        let modulus = polynomial(&[1, -3, 0, 2, 1]);
        let a = polynomial(&[2, 5, -1]);
        let inverse = inverse_modulo(&a, &modulus).unwrap();
        assert_eq!(remainder(&product(&a, &inverse), &modulus), polynomial(&[1]));
        assert_eq!(inverse_modulo(&product(&a, &modulus), &modulus), None);
    }
}
