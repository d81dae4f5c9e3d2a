//! Whether a force is odd, decided for the function and not for the way it is written.
//!
//! A wall on both sides may be written `max(x - 1, 0) + min(x + 1, 0)`, in steps, or with `abs`.
//! All of them are made of steps:
//!
//! ```text
//! abs(u) = u (2 H(u) - 1),   sgn(u) = 2 H(u) - 1,   max(u, v) = v + (u - v) H(u - v),   min(u, v) = u - (u - v) H(u - v)
//! H(-u) = 1 - H(u),   H(k u) = H(u) for k > 0,   H(u)^n = H(u),   H(x - b) H(x - c) = H(x - max(b, c))
//! ```
//!
//! A sum written this way is zero, up to the points of the jumps, only if nothing is left of it.

use num_traits::{Signed, Zero};

use super::linear_in;
use crate::exact::Rational;
use crate::expr::{Expr, ExprError, Function, Node};
use crate::symbol::Symbol;

/// Whether `f(-x) = -f(x)` but for single points.
///
/// # Errors
/// A force that cannot be written out.
///
/// ```
/// # use lindstedt_oscillator as lindstedt;
/// use lindstedt::{expr::Expr, method::is_odd};
///
/// let [odd, neither]: [Expr; 2] = ["x + x^3".parse()?, "x + x^2".parse()?];
/// assert!(is_odd(&odd, "x".into())? && !is_odd(&neither, "x".into())?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn is_odd(force: &Expr, coordinate: Symbol) -> Result<bool, ExprError> {
    Ok(twice_even_part(force, coordinate)?.is_zero())
}

/// `f(x) + f(-x)`, zero where the force is odd.
///
/// # Errors
/// A force that cannot be written out.
pub fn twice_even_part(force: &Expr, coordinate: Symbol) -> Result<Expr, ExprError> {
    let mirrored = force.substitute(coordinate, &-&Expr::from(coordinate))?;
    let sum = (&mirrored + force).expand()?;
    let vanishes = || Ok::<bool, ExprError>(in_steps(&sum, coordinate)?.is_zero());
    // A sum too long to be written in steps keeps the parity that its own form shows.
    match sum.is_zero() || vanishes().unwrap_or(false) {
        true => Ok(Expr::zero()),
        false => Ok(sum),
    }
}

/// An expression with steps of one orientation alone in place of corners and jumps, written out.
fn in_steps(expr: &Expr, coordinate: Symbol) -> Result<Expr, ExprError> {
    let stepwise = expr.fold(|expr, children: &[Expr]| {
        let two = Expr::from(2);
        match (expr.node(), children) {
            (Node::Function(Function::Step, _), [u]) => step(u, coordinate),
            (Node::Function(Function::Absolute, _), [u]) => {
                Ok(u * &(two * step(u, coordinate)? - Expr::one()))
            }
            (Node::Function(Function::Sign, _), [u]) => {
                Ok(two * step(u, coordinate)? - Expr::one())
            }
            (Node::Function(Function::Maximum, _), [u, v]) => {
                let difference = (u - v).expand()?;
                Ok(v + &(&difference * &step(&difference, coordinate)?))
            }
            (Node::Function(Function::Minimum, _), [u, v]) => {
                let difference = (u - v).expand()?;
                Ok(u - &(&difference * &step(&difference, coordinate)?))
            }
            _ => expr.with_children(children),
        }
    })?;
    let written_out = stepwise.expand()?;
    Expr::sum(written_out.terms().iter().map(|term| merged(term, coordinate))).expand()
}

/// `H(u)`, a `u` with steps of its own taken apart first:
/// `H(u) = (1 - H(v)) H(u at H(v) = 0) + H(v) H(u at H(v) = 1)`.
fn step(argument: &Expr, coordinate: Symbol) -> Result<Expr, ExprError> {
    const MOST_PIECES: usize = 64;
    let mut open = vec![(Expr::one(), argument.clone())];
    let mut pieces = Vec::new();
    while let Some((weight, argument)) = open.pop() {
        let inner = match open.len() < MOST_PIECES {
            true => inner_step(&argument),
            false => None,
        };
        let Some(inner) = inner else {
            pieces.push(weight * oriented_step(&argument, coordinate)?);
            continue;
        };
        let fixed = |value: Expr| {
            argument.fold(|expr, children: &[Expr]| match *expr == inner {
                true => Ok(value.clone()),
                false => expr.with_children(children),
            })
        };
        open.push((&weight * &(Expr::one() - &inner), fixed(Expr::zero())?));
        open.push((&weight * &inner, fixed(Expr::one())?));
    }
    Ok(Expr::sum(pieces))
}

/// A step without steps inside.
fn inner_step(expr: &Expr) -> Option<Expr> {
    let mut found = None;
    let visited = expr.fold(|expr, _: &[()]| {
        if found.is_none() && matches!(expr.node(), Node::Function(Function::Step, _)) {
            found = Some(expr.clone());
        }
        Ok::<(), std::convert::Infallible>(())
    });
    visited.ok().and(found)
}

/// `H(u)` with `u` as `x - c` where it is linear, else with a first term without a factor.
fn oriented_step(argument: &Expr, coordinate: Symbol) -> Result<Expr, ExprError> {
    let argument = argument.expand()?;
    let slope = linear_in(&argument, coordinate).and_then(|(slope, _)| slope.as_number().cloned());
    let leading = || argument.terms().first().map(|term| term.factors().0);
    let unit = match slope.or_else(leading) {
        Some(unit) if !unit.is_zero() => unit,
        _ => return Expr::function(Function::Step, vec![argument]),
    };
    let scaled = Expr::divide(&argument, &Expr::number(unit.clone()))?.expand()?;
    let step = Expr::function(Function::Step, vec![scaled])?;
    Ok(if unit.is_negative() { Expr::one() - step } else { step })
}

/// A product with its steps merged: powers are left out, and of steps at numbers only the last
/// counts.
fn merged(term: &Expr, coordinate: Symbol) -> Expr {
    let (number, factors) = term.factors();
    let mut others = vec![Expr::number(number)];
    let mut last: Option<(Rational, Expr)> = None;
    for factor in factors {
        let (base, exponent) = factor.base_and_exponent();
        let argument = match base.node() {
            Node::Function(Function::Step, arguments) => arguments.first(),
            _ => None,
        };
        let power = exponent.as_number().is_some_and(Signed::is_positive);
        let (Some(argument), true) = (argument, power) else {
            others.push(factor.clone());
            continue;
        };
        let place = linear_in(argument, coordinate)
            .and_then(|(_, constant)| constant.as_number().map(|c| -c));
        match place {
            Some(place) if last.as_ref().is_none_or(|known| place > known.0) => {
                last = Some((place, base))
            }
            Some(_) => {}
            None => others.push(base),
        }
    }
    others.extend(last.map(|entry| entry.1));
    Expr::product(others)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn odd_forces_however_they_are_written() {
        for text in [
            "x + 3*max(x - 1, 0) + 3*min(x + 1, 0)",
            "2.71*(max(x - 1.99, 0) + min(x + 1.99, 0))",
            "x + k*(x - g)*H(x - g) + k*(x + g)*H(-x - g)",
            "x + k*max(x - g, 0) - k*max(-x - g, 0)",
            "x + abs(x - 1) - abs(x + 1)",
            "x*abs(x) + sgn(x)^3 + x*abs(abs(x) - 1)",
            "max(x, 2*x) + min(x, 2*x)",
            "max(min(x, 1), -1)",
            "sgn(2*x - 1)/2 + sgn(2*x + 1)/2",
            "H(x) - H(-x)",
            "x*max(x^2 - 1, 0)",
            "max(sin(x) - 1/2, 0) + min(sin(x) + 1/2, 0)",
            "1/(1 - x) - 1/(1 + x)",
            "x + (x - 1)^2*H(x - 1) - (x + 1)^2*H(-(x + 1))",
            "(x - 1)*H(x - 1)*H(x - 1/2) + (x + 1)*H(-x - 1)*H(-x - 1/2)",
        ] {
            let force: Expr = text.parse().unwrap();
            assert_eq!(is_odd(&force, "x".into()), Ok(true), "{text}");
        }
    }

    #[test]
    fn forces_that_are_not() {
        for text in [
            "x + 3*max(x - 1, 0) + 3*min(x + 2, 0)",
            "x + 3*max(x - 1, 0) + 2*min(x + 1, 0)",
            "x + abs(x)",
            "x + H(x - 1) - H(-x - 2)",
            "max(x, 2*x)",
            "x + k*max(x - g, 0) + h*min(x + g, 0)",
            "max(min(x, 1), -2)",
            "exp(x) - 1",
        ] {
            let force: Expr = text.parse().unwrap();
            assert_eq!(is_odd(&force, "x".into()), Ok(false), "{text}");
        }
    }
}
