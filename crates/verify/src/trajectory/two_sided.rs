//! Forces of two stops that are written as one, by `abs(x)` and `sgn(x)`, as the sum of both.
//!
//! ```text
//! max(abs(x) - d, 0)^r sgn(x)  ->  max(x - d, 0)^r - max(-x - d, 0)^r,   d >= 0
//! ```
//!
//! Both sides are equal for every x, but the left one has a corner and a jump at x = 0, where nothing
//! happens, that every passage through zero would meet. In: an expression, the coordinate and numbers
//! for letters. Out: the same with each such term in two.

use std::collections::BTreeMap;

use crate::expr::{Expr, ExprError, Function, Node};
use crate::symbol::Symbol;

/// The expression with each term that vanishes about zero as the sum of what it is on both sides.
///
/// # Errors
/// An expression that cannot be built anew.
pub(crate) fn by_sides(
    expression: &Expr,
    coordinate: Symbol,
    values: &BTreeMap<Symbol, f64>,
) -> Result<Expr, ExprError> {
    let corner = |node: &Expr| is_corner_of(node, coordinate).is_some();
    if !expression.unique_nodes().any(corner) {
        return Ok(expression.clone());
    }
    if !matches!(expression.node(), Node::Sum(_)) {
        let sides = [1, -1].map(|side| on_side(expression, coordinate, side));
        let [above, below] = sides;
        let (above, below) = (above?, below?);
        let is_apart = vanishes_beyond(&above, coordinate, 1.0, values)
            && vanishes_beyond(&below, coordinate, -1.0, values);
        if is_apart {
            return Ok(above + below);
        }
    }
    let children: Result<Vec<Expr>, ExprError> =
        expression.children().map(|child| by_sides(child, coordinate, values)).collect();
    expression.with_children(&children?)
}

/// The function, if this is `abs(x)` or `sgn(x)`.
fn is_corner_of(node: &Expr, coordinate: Symbol) -> Option<Function> {
    match node.node() {
        Node::Function(function @ (Function::Absolute | Function::Sign), arguments) => {
            let [argument] = arguments.as_slice() else { return None };
            (argument.as_symbol() == Some(coordinate)).then_some(*function)
        }
        _ => None,
    }
}

/// The expression for x of this sign.
fn on_side(expression: &Expr, coordinate: Symbol, side: i64) -> Result<Expr, ExprError> {
    expression.fold(|node, children: &[Expr]| match is_corner_of(node, coordinate) {
        Some(Function::Sign) => Ok(Expr::from(side)),
        Some(_) => Ok(Expr::from(side) * Expr::from(coordinate)),
        None if children.is_empty() => Ok(node.clone()),
        None => node.with_children(children),
    })
}

/// Whether an expression is zero wherever x has the other sign: one of its factors is a positive
/// power of `max(u, 0)`, or `H(u)`, with `u = k x - d`, k of this sign and d not negative.
fn vanishes_beyond(
    expression: &Expr,
    coordinate: Symbol,
    side: f64,
    values: &BTreeMap<Symbol, f64>,
) -> bool {
    let number = |expr: &Expr| expr.evaluate(values).ok();
    let is_closed = |gate: &Expr| {
        let slope = gate.differentiate(coordinate).ok().as_ref().and_then(number);
        let at_zero = gate.substitute(coordinate, &Expr::zero()).ok().as_ref().and_then(number);
        slope.zip(at_zero).is_some_and(|(slope, value)| side * slope > 0.0 && value <= 0.0)
    };
    let vanishes = |factor: &Expr| {
        let base = match factor.node() {
            Node::Power(base, exponent) => match number(exponent) {
                Some(exponent) if exponent > 0.0 => base,
                _ => return false,
            },
            _ => factor,
        };
        let Node::Function(function, arguments) = base.node() else { return false };
        match (function, arguments.as_slice()) {
            (Function::Maximum, [gate, zero] | [zero, gate]) if zero.is_zero() => is_closed(gate),
            (Function::Step, [gate]) => is_closed(gate),
            _ => false,
        }
    };
    expression.factors().1.iter().any(vanishes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oscillator::Oscillator;

    fn split(force: &str) -> (Expr, Expr) {
        let oscillator = Oscillator::parse(&format!("x'' + {force} = 0")).expect("an equation");
        let values = [(Symbol::new("d"), 0.5)].into();
        let split = by_sides(&oscillator.force, oscillator.coordinate, &values).expect("a force");
        (oscillator.force, split)
    }

    /// The parts have no corner at zero, and the same value everywhere.
    #[test]
    fn two_stops_in_one_are_two() {
        for force in [
            "1e4*max(abs(x) - 0.5, 0)^1.5*sgn(x)",
            "x + 3*(2*max(abs(x) - d, 0)*sgn(x) - cos(t))",
            "max(0, 2*abs(x) - 1)^3*x",
            "5*(abs(x) - d)*H(abs(x) - d)*sgn(x)*(1 + x'/3)",
        ] {
            let (whole, parts) = split(force);
            let x = Symbol::new("x");
            assert!(!parts.unique_nodes().any(|node| is_corner_of(node, x).is_some()), "{parts}");
            for index in -20..=20 {
                let value = |expr: &Expr| {
                    let at = [("x", 0.1 * f64::from(index)), ("x'", 0.3), ("t", 0.7), ("d", 0.5)];
                    let at = at.map(|(name, value)| (Symbol::new(name), value)).into();
                    expr.evaluate(&at).expect("a value")
                };
                assert!((value(&whole) - value(&parts)).abs() < 1e-12, "{whole} at {index}");
            }
        }
    }

    /// A term that does not vanish about zero stays as it is.
    #[test]
    fn other_corners_stay() {
        for force in [
            "abs(x)*x",
            "sgn(x)*max(x - d, 0)",
            "max(abs(x) + d, 0)*sgn(x)",
            "max(abs(x) - a, 0)*sgn(x)",
            "sgn(x)*x'",
        ] {
            let (whole, parts) = split(force);
            assert_eq!(whole, parts, "{force}");
        }
    }
}
