//! Zeros of a force with parameters that are found by inverting it: the coordinate stands in one
//! place, or in the sine and cosine of one angle, or the force is a polynomial of third degree in
//! it, in a power of it or in an exponential.
//!
//! References: NIST Digital Library of Mathematical Functions 1.11(iii) (Cardano), 4.43
//! (Viete), 4.21 and 4.23 (angles).
//!
//! ```text
//! c h(u) = r                      u = h^-1(r/c), and so on to x
//! c sin u + d cos u = r           u = phi +- acos(r/sqrt(c^2 + d^2)),   tan phi = c/d
//! c x^a + d x^b = 0               x^(a - b) = -d/c,   and three or four powers alike where x^s is the root of a polynomial,
//!                                 or exponentials: 2 sinh u = e^u - e^-u
//! x^3 + p x + q = 0               x = -q/(U^2 + p/3 + p^2/(9 U^2)),   U^3 = sqrt(q^2/4 + p^3/27) + q/2    one real root
//!                                 x = 2 sqrt(-p/3) cos(acos(3 q sqrt(-3/p)/(2 p))/3 - 2 pi k/3)           three
//! ```
//!
//! The values of the parameters decide which of them are real; that is left to the caller. In: a
//! force and its coordinate. Out: candidates, some of which may be zeros for no values at all.

use num_integer::Integer as _;
use num_traits::{Signed, ToPrimitive, Zero};

use super::shift::{coefficients, numerator, quadratic_roots};
use crate::conservative::linear_in;
use crate::exact::Rational;
use crate::exact::rational::ratio;
use crate::expr::{Expr, ExprError, Function, Node};
use crate::symbol::Symbol;

/// The places at which an expression may be zero; empty if it cannot be inverted.
pub(super) fn inverted(expression: &Expr, coordinate: Symbol) -> Vec<Expr> {
    zeros(expression, coordinate).unwrap_or_default()
}

fn zeros(expression: &Expr, x: Symbol) -> Result<Vec<Expr>, ExprError> {
    if expression.as_symbol() == Some(x) {
        return Ok(vec![Expr::zero()]);
    }
    if let Some((slope, constant)) = linear_in(expression, x) {
        return Ok(vec![Expr::divide(&-constant, &slope)?]);
    }
    let (moving, still): (Vec<Expr>, Vec<Expr>) =
        expression.terms().iter().cloned().partition(|term| term.contains(x));
    let other_side = -Expr::sum(still);
    if let ([product], true) = (moving.as_slice(), other_side.is_zero()) {
        let factors = product.factors().1.iter().filter(|factor| factor.contains(x));
        let factors: Vec<&Expr> = factors.collect();
        if factors.len() > 1 {
            // A factor such as 1/x is never zero.
            let found = factors.into_iter().map(|factor| zeros(factor, x).unwrap_or_default());
            return Ok(found.flatten().collect());
        }
    }
    let parts: Option<Vec<(Expr, Expr)>> = moving.iter().map(|term| split(term, x)).collect();
    if let Some([(factor, function)]) = parts.as_deref() {
        return solve_for_argument(function, &Expr::divide(&other_side, factor)?, x);
    }
    if let Some([one, other]) = parts.as_deref()
        && let Some((angle, values)) = angles([one, other], &other_side)?
    {
        return zeros_at_values(&angle, values, x);
    }
    let roots = of_polynomial(expression, x)?;
    match parts {
        Some(parts) if roots.is_empty() => of_powers(&parts, &other_side, x),
        _ => Ok(roots),
    }
}

/// A term as a constant factor and the one factor that contains `x`; `None` if several contain it.
fn split(term: &Expr, x: Symbol) -> Option<(Expr, Expr)> {
    let (number, factors) = term.factors();
    let (moving, still): (Vec<&Expr>, Vec<&Expr>) =
        factors.iter().partition(|factor| factor.contains(x));
    let [moving] = moving.as_slice() else {
        return None;
    };
    let still = still.into_iter().cloned();
    Some((Expr::product(still.chain([Expr::number(number)])), (*moving).clone()))
}

/// Solves `function = y` for x.
fn solve_for_argument(function: &Expr, y: &Expr, x: Symbol) -> Result<Vec<Expr>, ExprError> {
    let both = |value: Expr| vec![value.clone(), -value];
    let call = |function, argument: Expr| Expr::function(function, vec![argument]);
    let squared = y.integer_power(2)?;
    let (inner, values) = match function.node() {
        Node::Power(base, exponent) if !exponent.contains(x) => {
            let root = Expr::power(y, &Expr::divide(&Expr::one(), exponent)?)?;
            let even = exponent.as_number().is_some_and(|exponent| !exponent.numer().is_odd());
            (base, if even { both(root) } else { vec![root] })
        }
        Node::Function(name, arguments) => {
            let [argument] = arguments.as_slice() else {
                return Ok(vec![]);
            };
            let values = match name {
                Function::Sin => {
                    let angle = call(Function::Asin, y.clone())?;
                    vec![angle.clone(), Expr::pi() - angle]
                }
                Function::Cos => both(call(Function::Acos, y.clone())?),
                Function::Tan => vec![call(Function::Atan, y.clone())?],
                Function::Asin => vec![y.sin()?],
                Function::Acos => vec![y.cos()?],
                Function::Atan => vec![call(Function::Tan, y.clone())?],
                Function::Asinh => vec![call(Function::Sinh, y.clone())?],
                Function::Exp => vec![call(Function::Log, y.clone())?],
                Function::Log => vec![call(Function::Exp, y.clone())?],
                Function::Sinh => vec![call(Function::Log, y + &(squared + Expr::one()).sqrt()?)?],
                Function::Cosh => both(call(Function::Log, y + &(squared - Expr::one()).sqrt()?)?),
                Function::Tanh => {
                    let quotient = Expr::divide(&(Expr::one() + y), &(Expr::one() - y))?;
                    vec![call(Function::Log, quotient)? * Expr::number(ratio(1, 2))]
                }
                Function::Absolute => both(y.clone()),
                _ => return Ok(vec![]),
            };
            (argument, values)
        }
        Node::Sum(_) => (function, vec![y.clone()]),
        _ => return Ok(vec![]),
    };
    zeros_at_values(inner, values, x)
}

/// Solves `inner = value` for x, for each of these values.
fn zeros_at_values(inner: &Expr, values: Vec<Expr>, x: Symbol) -> Result<Vec<Expr>, ExprError> {
    let found: Result<Vec<Vec<Expr>>, ExprError> =
        values.iter().map(|value| zeros(&(inner - value), x)).collect();
    Ok(found?.into_iter().flatten().collect())
}

/// The angle `u` of `c sin u + d cos u = r`, and the values that it may have.
fn angles(terms: [&(Expr, Expr); 2], r: &Expr) -> Result<Option<(Expr, Vec<Expr>)>, ExprError> {
    let named = |(factor, function): &(Expr, Expr)| match function.node() {
        Node::Function(name @ (Function::Sin | Function::Cos), arguments) => {
            Some((*name, arguments.first()?.clone(), factor.clone()))
        }
        _ => None,
    };
    let [Some(one), Some(other)] = terms.map(named) else {
        return Ok(None);
    };
    let (sine, cosine) = if one.0 == Function::Sin { (one, other) } else { (other, one) };
    if (sine.0, cosine.0) != (Function::Sin, Function::Cos) || sine.1 != cosine.1 {
        return Ok(None);
    }
    let (c, d) = (sine.2, cosine.2);
    let call = |function, argument: Expr| Expr::function(function, vec![argument]);
    let turned = |angle: Expr| [angle.clone(), angle + Expr::pi()];
    if r.is_zero() {
        let angle = call(Function::Atan, Expr::divide(&-d, &c)?)?;
        return Ok(Some((sine.1, turned(angle).to_vec())));
    }
    let size = (c.integer_power(2)? + d.integer_power(2)?).sqrt()?;
    let beside = call(Function::Acos, Expr::divide(r, &size)?)?;
    let phase = call(Function::Atan, Expr::divide(&c, &d)?)?;
    let values = turned(phase).into_iter();
    let values = values.flat_map(|phase| [&phase - &beside, phase + beside.clone()]);
    Ok(Some((sine.1, values.collect())))
}

/// The roots of the numerator where that is of third degree.
fn of_polynomial(expression: &Expr, x: Symbol) -> Result<Vec<Expr>, ExprError> {
    let numerator = numerator(expression, x).and_then(|numerator| coefficients(&numerator, x));
    match numerator.as_deref() {
        Some([d, c, b, a]) => cubic_roots(a, b, c, d),
        Some([d, between @ .., a]) if !between.is_empty() && between.iter().all(Expr::is_zero) => {
            let degree = Expr::from(between.len() as i64 + 1);
            solve_for_argument(&Expr::power(&Expr::from(x), &degree)?, &Expr::divide(&-d, a)?, x)
        }
        _ => Ok(vec![]),
    }
}

/// Solves a sum of powers of one base, or of exponentials, equal to `r`: up to a factor it is a
/// polynomial in one of them.
fn of_powers(parts: &[(Expr, Expr)], r: &Expr, x: Symbol) -> Result<Vec<Expr>, ExprError> {
    let powers: Option<Vec<Vec<Power>>> = parts.iter().map(|part| powers(part, x)).collect();
    let powers = powers.unwrap_or_default().concat();
    let Some((first, others)) = powers.split_first() else {
        return Ok(vec![]);
    };
    if others.iter().any(|other| other.base != first.base) {
        return Ok(vec![]);
    }
    // The difference of every exponent from the first, in multiples of one step.
    let constant = (!r.is_zero()).then(|| (Expr::zero(), -r));
    let terms = others.iter().map(|power| (power.exponent.clone(), power.factor.clone()));
    let terms: Vec<(Expr, Expr)> = terms.chain(constant).collect();
    let steps = terms.iter().map(|(exponent, _)| (exponent - &first.exponent).expand());
    let steps = steps.collect::<Result<Vec<Expr>, ExprError>>()?;
    let Some(step) = steps.iter().find(|step| !step.is_zero()) else {
        return Ok(vec![]);
    };
    let mut places = vec![(Rational::zero(), first.factor.clone())];
    for (away, (_, factor)) in steps.iter().zip(&terms) {
        let away = Expr::divide(away, step)?.expand()?;
        match away.as_number() {
            Some(away) => places.push((away.clone(), factor.clone())),
            None => return Ok(vec![]),
        }
    }
    let Some((unit, mut polynomial)) = polynomial_of(&places) else {
        return Ok(vec![]);
    };
    let mut exponent = (Expr::number(unit) * step.clone()).expand()?;
    if exponent.has_leading_minus() {
        exponent = -exponent;
        polynomial.reverse();
    }
    let roots = match polynomial.as_slice() {
        [c, b] => vec![Expr::divide(&-c, b)?],
        [c, b, a] => quadratic_roots(a, b, c)?,
        [d, c, b, a] => cubic_roots(a, b, c, d)?,
        _ => return Ok(vec![]),
    };
    let function = match &first.base {
        Some(base) => Expr::power(base, &exponent)?,
        None => Expr::function(Function::Exp, vec![exponent])?,
    };
    let found: Result<Vec<Vec<Expr>>, ExprError> =
        roots.iter().map(|root| solve_for_argument(&function, root, x)).collect();
    Ok(found?.into_iter().flatten().collect())
}

/// `factor base^exponent`; an exponential has no base.
#[derive(Clone)]
struct Power {
    factor: Expr,
    base: Option<Expr>,
    exponent: Expr,
}

/// A function of x times its factor as powers: one, or the two exponentials of a hyperbolic
/// function.
fn powers((factor, function): &(Expr, Expr), x: Symbol) -> Option<Vec<Power>> {
    let exponential = |factor: Expr, exponent: Expr| Power { factor, base: None, exponent };
    let (base, exponent) = function.base_and_exponent();
    if exponent.contains(x) {
        return None;
    }
    if let Node::Function(name, arguments) = base.node()
        && let [argument] = arguments.as_slice()
    {
        let half = || Expr::number(ratio(1, 2)) * factor.clone();
        match name {
            Function::Exp => {
                let exponent = (&exponent * argument).expand().ok()?;
                return Some(vec![exponential(factor.clone(), exponent)]);
            }
            Function::Sinh | Function::Cosh if exponent.is_one() => {
                let other = if *name == Function::Sinh { -half() } else { half() };
                return Some(vec![
                    exponential(half(), argument.clone()),
                    exponential(other, -argument),
                ]);
            }
            _ => {}
        }
    }
    Some(vec![Power { factor: factor.clone(), base: Some(base), exponent }])
}

/// Converts coefficients at exponents that need not be whole to those of a polynomial: returns the
/// unit of the exponents, and all coefficients from the lowest on; `None` beyond the third degree.
fn polynomial_of(places: &[(Rational, Expr)]) -> Option<(Rational, Vec<Expr>)> {
    const DEGREE: usize = 3;
    let lowest = places.iter().map(|place| &place.0).min()?;
    let apart: Vec<Rational> = places.iter().map(|place| &place.0 - lowest).collect();
    let unit = apart.iter().filter(|apart| !apart.is_zero()).fold(
        None,
        |unit: Option<Rational>, apart| {
            let Some(unit) = unit else {
                return Some(apart.clone());
            };
            let over = unit.denom() * apart.denom();
            let numerator = (unit.numer() * apart.denom()).gcd(&(apart.numer() * unit.denom()));
            Some(Rational::new(numerator, over))
        },
    )?;
    let mut coefficients = vec![Expr::zero(); DEGREE + 1];
    for (apart, (_, factor)) in apart.iter().zip(places) {
        let degree = (apart / &unit).to_integer().to_usize()?;
        let coefficient = coefficients.get_mut(degree)?;
        *coefficient = &*coefficient + factor;
    }
    let length = coefficients.iter().rposition(|coefficient| !coefficient.is_zero())? + 1;
    coefficients.truncate(length);
    Some((unit, coefficients))
}

/// The roots of `a x^3 + b x^2 + c x + d`, first the one that is the only real one where it has a
/// value.
fn cubic_roots(a: &Expr, b: &Expr, c: &Expr, d: &Expr) -> Result<Vec<Expr>, ExprError> {
    let third = |expr: &Expr, power: i64| Ok::<_, ExprError>(Expr::number(ratio(1, power)) * expr);
    let [b, c, d] = [b, c, d].map(|coefficient| Expr::divide(coefficient, a));
    let (b, c, d) = (b?, c?, d?);
    let p = (&c - &third(&b.integer_power(2)?, 3)?).expand()?;
    let q =
        (third(&b.integer_power(3)?, 27)? * Expr::from(2) - third(&(&b * &c), 3)? + d).expand()?;
    let shift = third(&b, 3)?;
    if p.is_zero() {
        let root = Expr::power(&-q, &Expr::number(ratio(1, 3)))?;
        return Ok(vec![root - shift]);
    }
    // With q > 0 nothing cancels; the roots for -q are the negative ones.
    let negative = q.has_leading_minus();
    let q = if negative { -q } else { q };
    let half = third(&q, 2)?;
    let discriminant = (half.integer_power(2)? + third(&p.integer_power(3)?, 27)?).expand()?;
    let u = Expr::power(&(discriminant.sqrt()? + half), &Expr::number(ratio(1, 3)))?;
    let squared = u.integer_power(2)?;
    let below = Expr::sum([
        squared.clone(),
        third(&p, 3)?,
        Expr::divide(&p.integer_power(2)?, &(Expr::from(9) * squared))?,
    ]);
    let mut roots = vec![Expr::divide(&-q.clone(), &below)?];
    if !p.as_number().is_some_and(Signed::is_positive) {
        let cosine = Expr::divide(&(Expr::from(3) * q), &(Expr::from(2) * p.clone()))?
            * Expr::divide(&Expr::from(-3), &p)?.sqrt()?;
        let angle = third(&Expr::function(Function::Acos, vec![cosine])?, 3)?;
        let size = Expr::from(2) * third(&-p, 3)?.sqrt()?;
        for turn in [0, 1, 2] {
            let turned = &angle - &(Expr::pi() * Expr::number(ratio(2 * turn, 3)));
            roots.push(&size * &turned.cos()?);
        }
    }
    let signed = |root: Expr| if negative { -root } else { root };
    Ok(roots.into_iter().map(|root| signed(root) - shift.clone()).collect())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    /// Values of the letters, and the number of candidates that are real for them: each has to be a
    /// zero of the force.
    #[test]
    fn every_real_candidate_is_a_zero() {
        let table = [
            ("sin(x) - T", vec![("T", 0.3)], 2),
            ("3*cos(2*x - d) - T", vec![("T", 0.3), ("d", -2.0)], 2),
            ("k*exp(2*x) - c", vec![("k", 2.0), ("c", 0.7)], 1),
            ("log(1 + x) + k", vec![("k", 2.0)], 1),
            ("sinh(x) - k", vec![("k", -2.0)], 1),
            ("cosh(x) - k", vec![("k", 3.0)], 2),
            ("tanh(b*x) - k", vec![("k", -0.9), ("b", 2.0)], 1),
            ("abs(x - L) - k", vec![("k", 0.1), ("L", 2.0)], 2),
            ("tan(x) + k", vec![("k", 7.0)], 1),
            ("asin(x) - k", vec![("k", 1.2)], 1),
            ("acos(x) - k", vec![("k", 1.2)], 1),
            ("atan(x) - k", vec![("k", -1.2)], 1),
            ("asinh(x) - k", vec![("k", -1.2)], 1),
            ("k*(1 + x^2)^(3/2) - g", vec![("k", 1.0), ("g", 5.0)], 2),
            ("(x + L)^(3/5) - g", vec![("L", 1.0), ("g", -5.0)], 1),
            ("x^n - g", vec![("n", 2.5), ("g", 5.0)], 1),
            ("x^5 + g", vec![("g", 5.0)], 1),
            ("a*sin(x) - b*cos(x)", vec![("a", 1.0), ("b", 5.0)], 2),
            ("a*sin(3*x) + b*cos(3*x) - c", vec![("a", 1.0), ("b", 5.0), ("c", 2.0)], 2),
            ("x - k/x^2", vec![("k", 0.2)], 1),
            ("x + b*x^3 - k", vec![("k", 0.2), ("b", 3.0)], 1),
            ("x + b*x^3 - k", vec![("k", -1e-9), ("b", 3.0)], 1),
            ("x + x^2 + b*x^3 + k", vec![("k", 0.2), ("b", 3.0)], 1),
            ("x - k/(1 - x)^2", vec![("k", 0.1)], 3),
            ("x - k/(1 - x)^2", vec![("k", 0.2)], 1),
            ("b*x^3 - x + k", vec![("k", 0.1), ("b", 0.7)], 3),
            ("log(k*exp(x^3 + x - c))", vec![("k", 0.1), ("c", 0.7)], 1),
            ("24*e*(s^6/x^7 - 2*s^12/x^13)", vec![("e", 0.1), ("s", 0.7)], 2),
            ("-p*(x^(-3*k) - 1)/x", vec![("p", 2.0), ("k", 1.4)], 1),
            ("p*x^(-3*k) - p*x^(-k)", vec![("p", 2.0), ("k", 1.4)], 1),
            ("b/x^m - c/x^n", vec![("b", 2.0), ("c", 3.0), ("m", 4.0), ("n", 9.0)], 1),
            ("x^(1/3) + b*x^(2/3) - k", vec![("b", 2.0), ("k", 3.0)], 2),
            ("exp(x) - k*exp(-x)", vec![("k", 2.0)], 1),
            ("exp(2*b*x) - k*exp(b*x) + 1", vec![("k", 3.0), ("b", 2.0)], 2),
            ("exp(x)^2 - k*exp(-x/3)", vec![("k", 2.0)], 1),
            ("sinh(x) - k*cosh(x)", vec![("k", -0.7)], 1),
            ("a*sinh(b*x) + 5*cosh(b*x) - c", vec![("a", 2.0), ("b", 3.0), ("c", 7.0)], 2),
            ("sinh(x) + k*exp(x) - 1", vec![("k", 0.7)], 1),
            ("x^5 + b*x^3 - k*x", vec![("b", 1.0), ("k", 3.0)], 2),
            ("(1 + x)^(-6) - k*(1 + x)^(-2)", vec![("k", 3.0)], 2),
        ];
        for (text, numbers, count) in table {
            let force: Expr = text.parse().unwrap();
            let numbers: BTreeMap<Symbol, f64> =
                numbers.into_iter().map(|(name, value)| (name.into(), value)).collect();
            let mut real: Vec<f64> = Vec::new();
            for form in inverted(&force, "x".into()) {
                let Ok(place) = form.evaluate(&numbers) else {
                    continue;
                };
                let mut there = numbers.clone();
                there.insert("x".into(), place);
                let size = 1.0 + numbers.values().map(|value| value.abs()).sum::<f64>();
                let Ok(value) = force.evaluate(&there) else {
                    panic!("{text}: no force at {form} = {place}")
                };
                // Of the four angles with the same tangent two have the other sign.
                if value.abs() < 1e-13 * size {
                    real.push(place);
                } else {
                    assert!(text.starts_with("a*sin(3*x)"), "{text} at {form} = {place}: {value}");
                }
            }
            real.sort_by(f64::total_cmp);
            real.dedup();
            assert_eq!(real.len(), count, "{text}: {real:?}");
        }
    }

    #[test]
    fn small_loads_lose_no_digits() {
        let force: Expr = "x + b*x^3 - k".parse().unwrap();
        let numbers: BTreeMap<Symbol, f64> = [("b".into(), 3.0), ("k".into(), 1e-9)].into();
        let place = inverted(&force, "x".into())[0].evaluate(&numbers).unwrap();
        // x = k - b k^3.
        assert!((place / 1e-9 - 1.0).abs() < 1e-15, "{place}");
    }

    #[test]
    fn what_stands_in_two_places_is_not_inverted() {
        for text in ["x - k*exp(-x)", "x^5 + x - k", "sin(x) + cos(2*x) - k", "x + sgn(x) - k"] {
            let force: Expr = text.parse().unwrap();
            assert_eq!(inverted(&force, "x".into()), vec![], "{text}");
        }
    }
}
