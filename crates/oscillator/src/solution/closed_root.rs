//! Whether the closed root of a relation is the frequency wherever it is real and positive.
//!
//! The frequency is the root that continues the linear one from amplitude zero. A relation that is
//! quadratic in `z = omega^2`, `a z^2 + b z + c = 0`, has it as
//! `z = (-b + sqrt(b^2 - 4 a c))/(2 a)`, up to the amplitude at which the root turns back or
//! reaches zero. Where the formula has a positive value again beyond, that belongs to no motion
//! which comes from rest.
//!
//! ```text
//! u = z/z(0):   alpha(m) u^2 - beta(m) u + gamma(m) = 0,   alpha(0) = beta(0) = 1,   m the one product of powers that all depend on
//! ```

use num_traits::{One, Zero};

use crate::exact::polynomial::Monomial;
use crate::exact::rational::to_f64;
use crate::exact::real_roots::positive_roots;
use crate::exact::{Polynomial, Rational};
use crate::symbol::Symbol;

/// Whether the root with the plus sign of a relation that is quadratic in omega^2 is the branch
/// from rest wherever it is positive; false where that cannot be told.
pub(super) fn is_the_branch(relation: &Polynomial, amplitude: Symbol) -> bool {
    normalised(relation, amplitude)
        .is_some_and(|parts| [1, -1].iter().all(|sign| ends_for_good(&parts, *sign)))
}

/// `alpha`, `beta` and `gamma`, lowest power of `m` first.
fn normalised(relation: &Polynomial, amplitude: Symbol) -> Option<[Vec<Rational>; 3]> {
    let omega = Symbol::new("omega");
    let mut parts = [0; 3].map(|_| Polynomial::zero());
    for (monomial, number) in relation.terms() {
        let place = match monomial.exponent(omega) {
            4 => 0,
            2 => 1,
            0 => 2,
            _ => return None,
        };
        parts[place].add_term(monomial.without(omega), number.clone());
    }
    let at_rest = |part: &Polynomial| {
        let mut free = part.terms().filter(|(monomial, _)| monomial.exponent(amplitude) == 0);
        let (monomial, number) = free.next()?;
        free.next().is_none().then(|| (monomial.power(-1), Rational::one() / number))
    };
    let [leading, middle] = [at_rest(&parts[0])?, at_rest(&parts[1])?];
    let last =
        (leading.0.power(-1).product(&middle.0.power(2)), &middle.1 * &middle.1 / &leading.1);
    let factors = [leading, middle, last];
    let scaled = parts.iter().zip(&factors).map(|(part, (monomial, number))| {
        let part = part.times_monomial(monomial);
        part.map(|own| own * number)
    });
    let scaled: Vec<Polynomial> = scaled.collect();
    let of_amplitude = scaled.iter().flat_map(Polynomial::terms).map(|(monomial, _)| monomial);
    // The least power of the amplitude is that of m, or all are powers of its root: both are tried.
    let least = of_amplitude
        .filter(|monomial| monomial.exponent(amplitude) > 0)
        .min_by_key(|monomial| monomial.exponent(amplitude))?
        .clone();
    let univariate: Option<Vec<Vec<Rational>>> =
        scaled.iter().map(|part| in_powers_of(part, &least, amplitude)).collect();
    univariate?.try_into().ok()
}

/// A polynomial as one in powers of a monomial.
fn in_powers_of(
    polynomial: &Polynomial,
    base: &Monomial,
    amplitude: Symbol,
) -> Option<Vec<Rational>> {
    let mut coefficients: Vec<Rational> = vec![];
    for (monomial, number) in polynomial.terms() {
        let power = monomial.exponent(amplitude) / base.exponent(amplitude);
        let place = usize::try_from(power).ok()?;
        if base.power(power) != *monomial {
            return None;
        }
        coefficients.resize(coefficients.len().max(place + 1), Rational::zero());
        coefficients[place] += number;
    }
    Some(coefficients)
}

/// Whether the root, once it is no longer real and positive, never is again.
fn ends_for_good([alpha, beta, gamma]: &[Vec<Rational>; 3], sign: i64) -> bool {
    let turned = |part: &[Rational]| -> Vec<Rational> {
        let odd = |(power, number): (usize, &Rational)| match power % 2 {
            1 => number * Rational::from_integer(sign.into()),
            _ => number.clone(),
        };
        part.iter().enumerate().map(odd).collect()
    };
    let [alpha, beta, gamma] = [turned(alpha), turned(beta), turned(gamma)];
    let product = |one: &[Rational], other: &[Rational]| {
        let mut product = vec![Rational::zero(); (one.len() + other.len()).saturating_sub(1)];
        for (i, a) in one.iter().enumerate() {
            for (j, b) in other.iter().enumerate() {
                product[i + j] += a * b;
            }
        }
        product
    };
    let mut discriminant = product(&beta, &beta);
    let others = product(&alpha, &gamma);
    discriminant.resize(discriminant.len().max(others.len()), Rational::zero());
    for (own, other) in discriminant.iter_mut().zip(&others) {
        *own -= other * Rational::from_integer(4.into());
    }
    let roots = |part: &[Rational]| match part.iter().all(Zero::is_zero) {
        true => vec![],
        false => positive_roots(part),
    };
    let mut places = vec![0.0];
    for part in [&discriminant, &gamma, &beta] {
        let found = roots(part);
        if found.iter().any(|root| !root.simple) {
            return false;
        }
        places.extend(found.iter().map(|root| root.value));
    }
    if !roots(&alpha).is_empty() {
        return false;
    }
    places.sort_by(f64::total_cmp);
    let farthest = places.last().map_or(1.0, |last| 2.0 * last + 1.0);
    let between = places.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).chain([farthest]);
    let value = |part: &[Rational], m: f64| {
        part.iter().rev().fold(0.0, |sum, number| sum * m + to_f64(number))
    };
    let is_positive = |m: f64| {
        let root = value(&discriminant, m).sqrt();
        (value(&beta, m) + root) / value(&alpha, m) > 0.0
    };
    let mut after_the_end = between.skip_while(|m| is_positive(*m));
    !after_the_end.any(is_positive)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::parse_expression;

    fn of(relation: &str) -> bool {
        let relation = parse_expression(relation).expect("an expression");
        let relation =
            relation.expand().expect("a sum").to_polynomial(&mut |_| None).expect("no error");
        is_the_branch(&relation.expect("a polynomial"), "A".into())
    }

    #[test]
    fn a_root_that_comes_back_is_told_from_one_that_ends() {
        // Real on both sides of -0.94 and -2.26, beyond which it is negative.
        assert!(of("omega^4 - omega^2 - 3*eps*omega^2*A^2/4 + 3*eps^2*A^4/128"));
        assert!(of("omega^4 - k*omega^2 - 3*eps*omega^2*A^2/4 + 3*eps^2*A^4/128"));
        // The circle z^2 - z + A^2 = 0 turns back for good.
        assert!(of("omega^4 - omega^2 + A^2"));
        // z^2 - z + (A^2 - A^4)/3: the discriminant 1 - 4*(A^2 - A^4)/3 is positive throughout, at
        // 4 in place of 4/3 it is not.
        assert!(of("omega^4 - omega^2 + (A^2 - A^4)/3"));
        assert!(!of("omega^4 - omega^2 + 2*(A^2 - A^4)"));
        // Two products of powers.
        assert!(!of("omega^4 - omega^2 + a1*A^2 + a2*A^4"));
        // Of the third degree.
        assert!(!of("omega^6 - omega^4 + A^2"));
    }
}
