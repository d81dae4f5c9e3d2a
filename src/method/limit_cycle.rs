//! Self-excited oscillators: the amplitude that the equation itself determines.
//!
//! Reference: A. H. Nayfeh, *Perturbation Methods*, Wiley 1973, sections 3.1 and 5.1.
//!
//! To first order the amplitude drifts as the secular sine does. In units of the linear frequency, with `z = a^2` and the
//! terms `C_j` of the method of Lindstedt and Poincare,
//!
//! ```text
//! a' = delta a g(a^2)/2,      g(z) = sum_j c_j omega0^(q-2) [cos^p (-sin)^q]_sin z^((p+q-1)/2)
//! ```
//!
//! A positive root of `g` is the square of the amplitude of a limit cycle; it attracts where `delta g' < 0`.

use num_bigint::BigInt;
use num_integer::Integer as _;
use num_traits::{One, Signed, ToPrimitive, Zero};

use super::lindstedt_poincare::{TITLE, inverse_power};
use super::{Refusal, first_term};
use crate::derivation::AmplitudeCondition;
use crate::exact::polynomial::Monomial;
use crate::exact::{Integer, Polynomial, Rational, Ring};
use crate::expr::Expr;
use crate::oscillator::{Parts, PerturbedForce};
use crate::series::FourierSeries;
use crate::solution::AmplitudeConvention;
use crate::symbol::Symbol;

/// The amplitude of a limit cycle before its corrections.
pub(super) const LEADING: &str = "a0";

/// The square of the amplitude at which the first order has no secular sine; `None` where the amplitude is free.
pub(super) fn limit_cycle_amplitude(
    force: &PerturbedForce,
    linear_frequency: &Polynomial,
    parts: &Parts,
) -> Result<Option<Polynomial>, Refusal> {
    let equation = amplitude_equation(force, linear_frequency);
    let powers: Vec<usize> = (0..equation.len()).filter(|&k| !equation[k].is_zero()).collect();
    let z = Symbol::new("z");
    let text = || {
        let term = |&k: &usize| equation[k].times_monomial(&Monomial::power_of(z, k as i32));
        powers
            .iter()
            .map(term)
            .fold(Polynomial::zero(), |sum, term| sum + term)
            .to_string()
    };
    match powers.as_slice() {
        [] => Ok(None),
        [_] => Err(Refusal::Damping {
            method: TITLE,
            term: first_term(&parts.damping),
        }),
        &[low, high] if high == low + 1 => {
            let Some(inverse) = equation[high].power(-1) else {
                return Err(Refusal::LimitCycle {
                    equation: text(),
                    reason: "which divides by a sum of symbols",
                });
            };
            let mut squared = equation[low].product(&inverse);
            squared.negate();
            let negative = squared.single_term().is_some_and(|(_, number)| !number.is_positive());
            if negative {
                return Err(Refusal::Damping {
                    method: TITLE,
                    term: first_term(&parts.damping),
                });
            }
            Ok(Some(squared))
        }
        _ => rational_limit_cycle(&equation)
            .map(|squared| Some(Polynomial::constant(squared)))
            .ok_or_else(|| Refusal::LimitCycle {
                equation: text(),
                reason: "whose stable positive root is no fraction",
            }),
    }
}

/// The secular sine of the first order, which vanishes at the amplitude of the limit cycle.
pub(super) fn leading_amplitude(
    force: &PerturbedForce,
    linear_frequency: &Polynomial,
    delta: Symbol,
    squared: &Polynomial,
) -> AmplitudeCondition {
    let unknown = Symbol::new(LEADING);
    let mut sine = Polynomial::zero();
    for (power, coefficient) in amplitude_equation(force, linear_frequency).iter().enumerate() {
        let unit = Monomial::power_of(unknown, 2 * power as i32).product(&Monomial::power_of(delta, 1));
        sine.accumulate(&coefficient.times_monomial(&unit));
    }
    sine.negate();
    let squared = Expr::from(squared);
    AmplitudeCondition {
        sine,
        unknown,
        value: squared.sqrt().unwrap_or(squared),
    }
}

/// `g_k`, the coefficients of `z^k` in the secular sine over the amplitude, `z = amplitude^2`: slowly varying, the amplitude
/// follows `a' = delta a g(a^2)/2` in units of the linear frequency.
fn amplitude_equation(force: &PerturbedForce, linear_frequency: &Polynomial) -> Vec<Polynomial> {
    let mut equation: Vec<Polynomial> = vec![];
    for term in force
        .terms
        .iter()
        .filter(|term| term.order == 1 && term.velocity % 2 == 1)
    {
        let sine = FourierSeries::<Rational>::cos(1)
            .power(term.position)
            .product(&FourierSeries::sin(1).times(-1).power(term.velocity))
            .sine(1);
        let (weight, _) = sine.mean();
        let power = ((term.position + term.velocity).saturating_sub(1) / 2) as usize;
        if weight.is_zero() {
            continue;
        }
        if equation.len() <= power {
            equation.resize(power + 1, Polynomial::zero());
        }
        let frequency = inverse_power(linear_frequency, term.velocity as i32 - 2);
        let weighted = term
            .coefficient
            .product(&frequency)
            .product(&Polynomial::constant(weight));
        equation[power].accumulate(&weighted);
    }
    equation
}

/// The smallest positive rational root `z` of `sum g_k z^k` at which the limit cycle is stable, for numerical `g_k`.
///
/// The averaged amplitude obeys `a' = (a/2) omega0 g(a^2)` up to a positive factor, so stability asks for `g' < 0`.
fn rational_limit_cycle(equation: &[Polynomial]) -> Option<Rational> {
    let numbers: Vec<Rational> = equation.iter().map(Polynomial::as_number).collect::<Option<_>>()?;
    let common = numbers
        .iter()
        .fold(Integer::one(), |lcm, number| lcm.lcm(number.denom()));
    let integers: Vec<Integer> = numbers.iter().map(|number| (number * &common).to_integer()).collect();
    let lowest = integers.iter().find(|value| !value.is_zero())?;
    let highest = integers.last()?;
    let value = |z: &Rational| integers.iter().rev().fold(Rational::zero(), |sum, g| sum * z + g);
    let slope = |z: &Rational| {
        let powers = integers.iter().enumerate().skip(1).rev();
        powers.fold(Rational::zero(), |sum, (k, g)| sum * z + g * BigInt::from(k))
    };
    let mut roots: Vec<Rational> = divisors(lowest)?
        .iter()
        .flat_map(|p| {
            divisors(highest)
                .unwrap_or_default()
                .into_iter()
                .map(|q| Rational::new(p.clone(), q))
        })
        .filter(|z| value(z).is_zero())
        .collect();
    roots.sort();
    roots.into_iter().find(|z| slope(z).is_negative())
}

/// All positive divisors of a number small enough for trial division.
fn divisors(value: &Integer) -> Option<Vec<Integer>> {
    let value = value.abs().to_u64().filter(|value| *value < 1 << 40)?;
    let small = (1..).take_while(|d| d * d <= value).filter(|d| value % d == 0);
    Some(small.flat_map(|d| [d, value / d]).map(Integer::from).collect())
}

/// For which sign of the small parameter the limit cycle attracts: where `g' < 0` at the root of `g_k + g_(k+1) z`.
pub(super) fn stability(force: &PerturbedForce, linear_frequency: &Polynomial, delta: Symbol) -> Option<String> {
    let equation = amplitude_equation(force, linear_frequency);
    let mut terms = equation.iter().filter(|coefficient| !coefficient.is_zero());
    let (_, high, None) = (terms.next()?, terms.next()?, terms.next()) else {
        return None;
    };
    let (monomial, number) = high.single_term()?;
    // omega0 is positive.
    let scale = monomial
        .without(Symbol::new("omega0"))
        .product(&Monomial::power_of(delta, 1));
    let scale = Polynomial::term(scale, One::one());
    let (stable, unstable) = if number.is_negative() { ('>', '<') } else { ('<', '>') };
    Some(format!(
        "the limit cycle attracts for {scale} {stable} 0 and repels for {scale} {unstable} 0"
    ))
}

/// The amplitude that a limit cycle has, in the convention of the answer.
pub(super) fn limit_cycle(displacement: &FourierSeries<Polynomial>, convention: AmplitudeConvention) -> Polynomial {
    match convention {
        AmplitudeConvention::Initial => displacement.at_zero().mean().0,
        AmplitudeConvention::FirstHarmonic => displacement.cosine(1).mean().0,
    }
}
