//! Equilibria in exact form, and the force seen from one.
//!
//! Candidates are fractions, zeros of the linear expressions that occur in the force, multiples of
//! pi, and the roots of its numerator where that is of second degree; each is tried by putting it
//! in. A force of angles that is moved by a multiple of pi is written out,
//! `cos(x - pi/2) = sin(x)`, so that its parity shows (NIST Digital Library of Mathematical
//! Functions 4.21.2).

use std::collections::BTreeMap;

use num_traits::{Signed, ToPrimitive, Zero};

use crate::conservative::linear_in;
use crate::decimal::rounded_to;
use crate::exact::Rational;
use crate::exact::rational::{from_f64, ratio, to_f64};
use crate::expr::{Expr, ExprError, Function, Node};
use crate::symbol::Symbol;

/// The most terms of an expression whose zero is looked for.
const LONGEST_LINEAR: usize = 16;

/// The force at a position, simplified.
pub(super) fn value_at(
    force: &Expr,
    coordinate: Symbol,
    position: &Expr,
) -> Result<Expr, ExprError> {
    with_known_angles(&force.substitute(coordinate, position)?)?.expand()
}

/// The force in the deviation from a position.
pub(super) fn shifted_force(
    force: &Expr,
    coordinate: Symbol,
    position: &Expr,
) -> Result<Expr, ExprError> {
    with_known_angles(&force.substitute(coordinate, &(Expr::from(coordinate) + position))?)
}

/// Sines and cosines of sums with a multiple of pi, written out where its sine and cosine are roots
/// of fractions.
fn with_known_angles(force: &Expr) -> Result<Expr, ExprError> {
    force.fold(|expr, children: &[Expr]| {
        let rebuilt = || match expr.children().zip(children).all(|(old, new)| old == new) {
            true => Ok(expr.clone()),
            false => expr.with_children(children),
        };
        let (
            Node::Function(function @ (Function::Sin | Function::Cos | Function::Tan), _),
            [angle],
        ) = (expr.node(), children)
        else {
            return rebuilt();
        };
        let angle = angle.expand()?;
        let (turning, rest): (Vec<Expr>, Vec<Expr>) =
            angle.terms().iter().cloned().partition(|term| half_turns(term).is_some());
        let turn: Rational = turning.iter().filter_map(half_turns).sum();
        let rest = Expr::sum(rest);
        let (Some(sine), Some(cosine)) = (sine_of(&turn), sine_of(&(&turn + ratio(1, 2)))) else {
            return rebuilt();
        };
        if turn.is_zero() {
            return rebuilt();
        }
        let of = |function| Expr::function(function, vec![rest.clone()]);
        match function {
            Function::Sin => Ok(of(Function::Sin)? * &cosine + of(Function::Cos)? * &sine),
            Function::Cos => Ok(of(Function::Cos)? * &cosine - of(Function::Sin)? * &sine),
            _ if sine.is_zero() => of(Function::Tan),
            _ => rebuilt(),
        }
    })
}

/// `r` of a term `r pi`.
fn half_turns(term: &Expr) -> Option<Rational> {
    match term.factors() {
        (coefficient, [factor]) if matches!(factor.node(), Node::Pi) => Some(coefficient),
        _ => None,
    }
}

/// `sin(r pi)` for multiples of a sixth and a quarter.
fn sine_of(half_turns: &Rational) -> Option<Expr> {
    let whole = half_turns.floor();
    let part = half_turns - &whole;
    let part = if part > ratio(1, 2) { ratio(1, 1) - part } else { part };
    let squared = [(0, 1, 0), (1, 6, 1), (1, 4, 2), (1, 3, 3), (1, 2, 4)];
    let (.., quarters) = squared.into_iter().find(|&(p, q, _)| part == ratio(p, q))?;
    let size = Expr::number(ratio(quarters, 4)).sqrt().ok()?;
    Some(if whole.to_integer().is_odd() { -size } else { size })
}

/// The exact form of the zero of a force near a number, the simplest first; `None` if none is
/// found.
pub(super) fn exact_zero(force: &Expr, coordinate: Symbol, near: f64) -> Option<Expr> {
    let pi = |multiple: Rational| Expr::pi() * Expr::number(multiple);
    let turns = near / std::f64::consts::PI;
    let multiples =
        [1, 2, 3, 4, 5, 6, 8, 12].map(|q| ratio((turns * f64::from(q)).round() as i64, q.into()));
    let angles = force.contains_function(Function::Sin)
        || force.contains_function(Function::Cos)
        || force.contains_function(Function::Tan);
    let multiples = multiples.into_iter().filter(|_| angles && turns.abs() < 1e6).map(pi);
    let candidates = fractions_near(near)
        .into_iter()
        .map(Expr::number)
        .chain(linear_zeros(force, coordinate))
        .chain(multiples);
    let tried = candidates.filter(|candidate| {
        let value = candidate.evaluate(&BTreeMap::new());
        value.is_ok_and(|value| (value - near).abs() <= 1e-9 * near.abs())
    });
    tried
        .into_iter()
        .find(|candidate| value_at(force, coordinate, candidate).is_ok_and(|value| value.is_zero()))
}

/// Fractions that may have been meant by a number: the convergents of its continued fraction, and
/// its decimals.
fn fractions_near(value: f64) -> Vec<Rational> {
    let Some(exact) = from_f64(value) else {
        return vec![];
    };
    let close = |candidate: &Rational| (to_f64(candidate) - value).abs() <= 1e-11 * value.abs();
    let (mut before, mut last) = (ratio(0, 1), ratio(1, 1));
    let (mut before_below, mut last_below) = (ratio(1, 1), ratio(0, 1));
    let mut rest = exact;
    let mut found = Vec::new();
    for _ in 0..40 {
        let whole = rest.floor();
        let next = &whole * &last + &before;
        let next_below = &whole * &last_below + &before_below;
        (before, last) = (last, next);
        (before_below, last_below) = (last_below, next_below);
        let candidate = &last / &last_below;
        if close(&candidate) {
            found.push(candidate);
        }
        let part = rest - whole;
        if part.is_zero() || found.len() >= 4 {
            break;
        }
        rest = part.recip();
    }
    found.push(rounded_to(value, 12));
    found
}

/// The zeros of all linear expressions in a force: 1 of `max(x - 1, 0)`, `L` of `k*(x - L)`.
pub(super) fn linear_zeros(force: &Expr, coordinate: Symbol) -> Vec<Expr> {
    let mut zeros: Vec<Expr> = Vec::new();
    let collected = force.fold(|expr, _: &[()]| {
        let sum = matches!(expr.node(), Node::Sum(_)) && expr.terms().len() <= LONGEST_LINEAR;
        if sum && let Some((slope, constant)) = linear_in(expr, coordinate) {
            let zero = Expr::divide(&-constant, &slope)?.expand()?;
            if !zero.is_zero() && !zeros.contains(&zero) {
                zeros.push(zero);
            }
        }
        Ok::<(), ExprError>(())
    });
    match collected {
        Ok(()) => zeros,
        Err(_) => vec![],
    }
}

/// The coefficients of an expression as a polynomial in the coordinate, lowest power first; `None`
/// if it is not one.
pub(super) fn coefficients(expression: &Expr, coordinate: Symbol) -> Option<Vec<Expr>> {
    let mut coefficients: Vec<Vec<Expr>> = Vec::new();
    for term in expression.expand().ok()?.terms() {
        let (number, factors) = term.factors();
        let mut power = 0;
        let mut rest = vec![Expr::number(number)];
        for factor in factors {
            let (base, exponent) = factor.base_and_exponent();
            if base.as_symbol() == Some(coordinate) {
                let exponent =
                    exponent.as_number().filter(|exponent| exponent.is_integer())?.to_integer();
                power = exponent.to_usize().filter(|power| *power <= 1000)?;
            } else if factor.contains(coordinate) {
                return None;
            } else {
                rest.push(factor.clone());
            }
        }
        if coefficients.len() <= power {
            coefficients.resize(power + 1, vec![]);
        }
        coefficients[power].push(Expr::product(rest));
    }
    let mut coefficients: Vec<Expr> = coefficients.into_iter().map(Expr::sum).collect();
    while coefficients.last().is_some_and(Expr::is_zero) {
        coefficients.pop();
    }
    Some(coefficients)
}

/// The zeros of a force, beside `x = 0`, that have a closed form: of linear expressions in it, and
/// of a numerator that is of second degree, or of second degree in the square.
pub(super) fn closed_forms(force: &Expr, coordinate: Symbol) -> Vec<Expr> {
    let zero = |candidate: &Expr| {
        value_at(force, coordinate, candidate).is_ok_and(|value| value.is_zero())
    };
    let mut forms: Vec<Expr> = linear_zeros(force, coordinate).into_iter().filter(zero).collect();
    let numerator =
        numerator(force, coordinate).and_then(|numerator| coefficients(&numerator, coordinate));
    if let Some(numerator) = numerator {
        let lowest = numerator.iter().position(|coefficient| !coefficient.is_zero());
        let numerator = &numerator[lowest.unwrap_or(numerator.len())..];
        let roots = match numerator {
            [c, b] => linear_root(b, c),
            [c, b, a] => quadratic_roots(a, b, c),
            [c, b1, b, b3, a] if b1.is_zero() && b3.is_zero() => {
                quadratic_roots(a, b, c).and_then(|squares| {
                    let roots: Result<Vec<Expr>, ExprError> =
                        squares.iter().map(Expr::sqrt).collect();
                    Ok(roots?.into_iter().flat_map(|root| [root.clone(), -root]).collect())
                })
            }
            _ => Ok(vec![]),
        };
        forms.extend(roots.unwrap_or_default().into_iter().filter(|root| !root.is_zero()));
    }
    forms.dedup();
    forms
}

/// The numerator of the force over a common denominator.
pub(super) fn numerator(force: &Expr, coordinate: Symbol) -> Option<Expr> {
    let mut below: BTreeMap<String, (Expr, i64)> = BTreeMap::new();
    let expanded = force.expand().ok()?;
    for term in expanded.terms() {
        for factor in term.factors().1 {
            let (base, exponent) = factor.base_and_exponent();
            let exponent = exponent.as_number().filter(|exponent| exponent.is_negative());
            if let Some(exponent) = exponent.filter(|_| base.contains(coordinate)) {
                let power =
                    (-exponent.to_integer()).to_i64().filter(|power| (1..=4).contains(power))?;
                if !exponent.is_integer() {
                    return None;
                }
                let entry = below.entry(base.to_string()).or_insert((base, power));
                entry.1 = entry.1.max(power);
            }
        }
    }
    let powers: Result<Vec<Expr>, ExprError> =
        below.into_values().map(|(base, power)| base.integer_power(power)).collect();
    let below = powers.ok()?;
    let times =
        |term: &Expr| Expr::product(std::iter::once(term.clone()).chain(below.iter().cloned()));
    Expr::sum(expanded.terms().iter().map(times)).expand().ok()
}

fn linear_root(slope: &Expr, constant: &Expr) -> Result<Vec<Expr>, ExprError> {
    Ok(vec![Expr::divide(&-constant, slope)?.expand()?])
}

/// Both roots of `a x^2 + b x + c`, in the form in which nothing cancels for `b > 0`: the first
/// goes to zero with `c`.
pub(super) fn quadratic_roots(a: &Expr, b: &Expr, c: &Expr) -> Result<Vec<Expr>, ExprError> {
    if b.is_zero() {
        let root = Expr::divide(&-c, a)?.sqrt()?;
        return Ok(vec![root.clone(), -root]);
    }
    if b.has_leading_minus() {
        return quadratic_roots(&-a, &-b, &-c);
    }
    let discriminant = (b.integer_power(2)? - Expr::from(4) * a * c).expand()?;
    let sum = b + &discriminant.sqrt()?;
    Ok(vec![Expr::divide(&(Expr::from(-2) * c), &sum)?, Expr::divide(&-sum, &(Expr::from(2) * a))?])
}
