//! Powers such as 3/2 that begin at a corner: the force of a contact, written so that a step may
//! extend across the beginning of contact.
//!
//! ```text
//! u^r H(u), max(u, 0)^r  ->  (u^2)^(r/2) H(u)        abs(u)^r  ->  (u^2)^(r/2) sgn(u)^2        r = 3/2, 1/2, ..., or a letter
//! ```
//!
//! Both sides are equal for every real u. But between its corners an expression is evaluated as on
//! one side, and u may become negative for a moment before the corner is located: then the left
//! form has no value, but the right one has, and it keeps its corner.

use std::collections::BTreeMap;

use num_traits::Zero;

use crate::exact::rational::{Integer, ratio};
use crate::expr::{Expr, ExprError, Function, Node};
use crate::series::guard::Guard;
use crate::symbol::Symbol;

/// Extends the roots of an expression across corners, so that they have a value on both sides: the
/// form in which [`System::new`](super::System::new) takes its right sides. An argument of a corner
/// must not jump, so that no steps are introduced inside of one.
///
/// # Errors
/// [`ExprError`] if an expression becomes too large.
///
/// ```
/// # use lindstedt_dynamics as lindstedt;
/// use lindstedt::expr::parse_expression;
/// use lindstedt::system::roots_across_corners;
///
/// let force = parse_expression("k*max(x, 0)^(3/2)")?;
/// let followed = roots_across_corners(&force, &[("k".into(), 2.0)].into())?;
/// assert_eq!(followed.to_string(), "k*(x^2)^(3/4)*H(x)");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn roots_across_corners(
    expression: &Expr,
    values: &BTreeMap<Symbol, f64>,
) -> Result<Expr, ExprError> {
    expression.fold(|expr, children: &[Expr]| match (expr.node(), children) {
        (Node::Function(function, arguments), _) if function.has_corner() => {
            let inside: Result<Vec<Expr>, ExprError> =
                arguments.iter().map(|argument| inside_corner(argument, values)).collect();
            expr.with_children(&inside?)
        }
        (Node::Power(..), [base, exponent]) if rises_as_root(exponent, values) => {
            match root_of(base, values)? {
                Some(Rooted { inner, gate }) => {
                    Ok(Expr::product([even_root(&inner, exponent)?, gate]))
                }
                None => expr.with_children(children),
            }
        }
        (Node::Product(..), _) => behind_gates(expr, children, values),
        _ => expr.with_children(children),
    })
}

/// An argument of a corner: `(max(u, 0)^2)^(r/2)`, and `abs(u) (u^2)^((r - 1)/2)` where r is more
/// than one.
fn inside_corner(argument: &Expr, values: &BTreeMap<Symbol, f64>) -> Result<Expr, ExprError> {
    argument.fold(|expr, children: &[Expr]| match (expr.node(), children) {
        (Node::Power(..), [base, exponent]) if rises_as_root(exponent, values) => {
            let less = exponent - &Expr::one();
            match root_of(base, values)? {
                Some(Rooted { gate, .. }) if gate.contains_function(Function::Step) => {
                    even_root(base, exponent)
                }
                Some(Rooted { inner, .. }) if rises_as_root(&less, values) => {
                    Ok(Expr::product([base.clone(), even_root(&inner, &less)?]))
                }
                _ => expr.with_children(children),
            }
        }
        _ => expr.with_children(children),
    })
}

/// `(base^2)^(exponent/2)`.
fn even_root(base: &Expr, exponent: &Expr) -> Result<Expr, ExprError> {
    Expr::power(&base.integer_power(2)?, &(exponent * &Expr::number(ratio(1, 2))))
}

/// Whether a power with this exponent has no value below zero.
fn draws_root(exponent: &Expr, values: &BTreeMap<Symbol, f64>) -> bool {
    match exponent.as_number() {
        Some(number) => (number.denom() % Integer::from(2)).is_zero(),
        None => exponent.evaluate(values).is_ok_and(|value| value.fract() != 0.0),
    }
}

/// Whether the power also vanishes at zero, that is, whether the exponent is positive.
fn rises_as_root(exponent: &Expr, values: &BTreeMap<Symbol, f64>) -> bool {
    draws_root(exponent, values) && exponent.evaluate(values).is_ok_and(|value| value > 0.0)
}

/// A non-negative expression that is zero at a corner: the inner expression where its gate is not
/// zero, and its absolute value at the corner.
struct Rooted {
    inner: Expr,
    gate: Expr,
}

/// The base of a root as one: positive numbers times `max(u, 0)`, `-min(u, 0)` or `abs(u)`, or
/// `c*u + c*abs(u)`.
fn root_of(base: &Expr, values: &BTreeMap<Symbol, f64>) -> Result<Option<Rooted>, ExprError> {
    let step = |inner: Expr| {
        let gate = Expr::function(Function::Step, vec![inner.clone()])?;
        Ok(Some(Rooted { inner, gate }))
    };
    if let Node::Sum(terms) = base.node() {
        for term in terms {
            let (before, Some((Function::Absolute, [inner]))) = one_function(term, values) else {
                continue;
            };
            let (rest, half) = (base - term, &before * inner);
            for half in [half.clone(), -half] {
                if is_positive(&before, values) && (&rest - &half).expand()?.is_zero() {
                    return step(&half + &half);
                }
            }
        }
        return Ok(None);
    }
    let (before, Some((function, arguments))) = one_function(base, values) else {
        return Ok(None);
    };
    let other = |arguments: &[Expr]| match arguments {
        [zero, other] | [other, zero] if zero.is_zero() => Some(&before * other),
        _ => None,
    };
    match (function, arguments) {
        (Function::Absolute, [inner]) if is_positive(&before, values) => Ok(Some(Rooted {
            inner: &before * inner,
            gate: Expr::function(Function::Sign, vec![inner.clone()])?.integer_power(2)?,
        })),
        (Function::Maximum, arguments) if is_positive(&before, values) => {
            other(arguments).map_or(Ok(None), step)
        }
        (Function::Minimum, arguments) if is_positive(&-&before, values) => {
            other(arguments).map_or(Ok(None), step)
        }
        _ => Ok(None),
    }
}

/// An expression as numbers times one function with its arguments; `None` if it has another form.
fn one_function<'a>(
    expr: &'a Expr,
    values: &BTreeMap<Symbol, f64>,
) -> (Expr, Option<(Function, &'a [Expr])>) {
    let (number, factors) = expr.factors();
    let (numbers, rest): (Vec<&Expr>, Vec<&Expr>) =
        factors.iter().partition(|factor| is_number(factor, values));
    let before =
        Expr::product([Expr::number(number)].into_iter().chain(numbers.into_iter().cloned()));
    let function = match rest.as_slice() {
        [only] => match only.node() {
            Node::Function(function, arguments) => Some((*function, arguments.as_slice())),
            _ => None,
        },
        _ => None,
    };
    (before, function)
}

fn is_number(expr: &Expr, values: &BTreeMap<Symbol, f64>) -> bool {
    expr.symbols().iter().all(|name| values.contains_key(name))
}

fn is_positive(expr: &Expr, values: &BTreeMap<Symbol, f64>) -> bool {
    expr.evaluate(values).is_ok_and(|value| value > 0.0)
}

/// `u^r H(v)` as `(u^2)^(r/2) H(v)` where u is zero with v and positive behind it. A root without a
/// gate stays as it is, because it has no value for negative u.
fn behind_gates(
    product: &Expr,
    factors: &[Expr],
    values: &BTreeMap<Symbol, f64>,
) -> Result<Expr, ExprError> {
    let gates: Vec<&Expr> = factors
        .iter()
        .filter_map(|factor| match factor.node() {
            Node::Function(Function::Step, arguments) => arguments.first(),
            _ => None,
        })
        .collect();
    if gates.is_empty() {
        return product.with_children(factors);
    }
    let open = |factor: &Expr| {
        factor.fold(|expr, children: &[Expr]| {
            let (Node::Power(..), [base, exponent]) = (expr.node(), children) else {
                return expr.with_children(children);
            };
            let is_gated = || gates.iter().any(|gate| is_open_with(base, gate, values));
            match draws_root(exponent, values) && is_gated() {
                true => even_root(base, exponent),
                false => expr.with_children(children),
            }
        })
    };
    let factors: Result<Vec<Expr>, ExprError> = factors.iter().map(open).collect();
    product.with_children(&factors?)
}

/// Whether a base is a positive number times the argument of a gate, or times its sine: zero where
/// the gate opens, and positive behind it.
fn is_open_with(base: &Expr, gate: &Expr, values: &BTreeMap<Symbol, f64>) -> bool {
    let in_proportion = |one: &Expr, other: &Expr| {
        let ratio = Guard::new(one, values).ratio_to(&Guard::new(other, values));
        ratio.is_some_and(|ratio| ratio > 0.0)
    };
    if in_proportion(base, gate) {
        return true;
    }
    match one_function(base, values) {
        (before, Some((Function::Sin, [argument]))) => {
            is_positive(&before, values) && in_proportion(argument, gate)
        }
        _ => false,
    }
}
