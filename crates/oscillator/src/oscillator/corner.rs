//! Corners whose side at rest is decided by the sign of a parameter: `max(0, d + x)`, a contact
//! pressed together by `d`, and `H(x - xc)`, a barrier that is `xc` away.
//!
//! ```text
//! w(x) = w_0 + ...,  w_0 one term in letters:   for w_0 > 0 near rest   H(w) = 1, sgn(w) = 1, abs(w) = w, max(0, w) = w
//! ```
//!
//! In: a force. Out: the force near rest if the parameters are positive, and the sides that this
//! assumes, which the caller has to report.

use crate::expr::{Expr, ExprError, Function, Node};
use crate::solution::note::CornerSide;
use crate::symbol::Symbol;

/// The force with each such corner replaced by its side at rest, and the list of these; corners
/// that no parameter decides stay.
///
/// # Errors
/// A step of algebra failed.
pub(crate) fn beside_corners(
    force: &Expr,
    coordinate: Symbol,
) -> Result<(Expr, Vec<CornerSide>), ExprError> {
    let own = [coordinate, coordinate.derivative()];
    let mut sides: Vec<CornerSide> = Vec::new();
    let beside = force.fold(|expr, children: &[Expr]| {
        let here = expr.with_children(children)?;
        if !own.iter().any(|name| here.contains(*name)) {
            return Ok(here);
        }
        match side(&here, own)? {
            Some(side) => {
                let taken = side.taken.clone();
                if !sides.contains(&side) {
                    sides.push(side);
                }
                Ok(taken)
            }
            None => Ok(here),
        }
    })?;
    Ok((beside, sides))
}

/// The force as an expansion about rest takes it: with the sides of its corners if parameters
/// decide them, and none of these sides is zero.
///
/// # Errors
/// As [`beside_corners`].
pub(crate) fn near_rest(
    force: &Expr,
    coordinate: Symbol,
) -> Result<(Expr, Vec<CornerSide>), ExprError> {
    let (beside, sides) = beside_corners(force, coordinate)?;
    // A barrier that is away at rest is no part of any expansion: what is left would be another
    // equation.
    match sides.iter().any(|side| side.taken.is_zero()) {
        true => Ok((force.clone(), vec![])),
        false => Ok((beside, sides)),
    }
}

/// The side of a corner at rest, if one term in the parameters decides it.
fn side(corner: &Expr, own: [Symbol; 2]) -> Result<Option<CornerSide>, ExprError> {
    let Node::Function(function, arguments) = corner.node() else {
        return Ok(None);
    };
    let (argument, [above, below]) = match (function, arguments.as_slice()) {
        (Function::Step, [u]) => (u.clone(), [Expr::one(), Expr::zero()]),
        (Function::Sign, [u]) => (u.clone(), [Expr::one(), -Expr::one()]),
        (Function::Absolute, [u]) => (u.clone(), [u.clone(), -u]),
        (Function::Maximum, [u, v]) => (u - v, [u.clone(), v.clone()]),
        (Function::Minimum, [u, v]) => (u - v, [v.clone(), u.clone()]),
        _ => return Ok(None),
    };
    let mut at_rest = argument;
    for name in own {
        // If the argument has no value at rest, it has no side either.
        match at_rest.substitute(name, &Expr::zero()) {
            Ok(there) => at_rest = there,
            Err(_) => return Ok(None),
        }
    }
    let at_rest = at_rest.expand()?;
    let letters = at_rest.symbols();
    if at_rest.terms().len() != 1 || letters.is_empty() || letters.contains(&Symbol::new("t")) {
        return Ok(None);
    }
    let negative = at_rest.has_leading_minus();
    Ok(Some(CornerSide {
        corner: corner.clone(),
        taken: if negative { below } else { above },
        positive: if negative { -at_rest } else { at_rest },
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_letter_decides_the_side() {
        for (force, expected, positive) in [
            ("k*max(x + d, 0)^(3/2)", "k*(x + d)^(3/2)", "d"),
            ("k*(x - xc)*H(x - xc)", "0", "xc"),
            ("abs(x' - v)*x", "(v - x')*x", "v"),
            ("min(2*c - x, 0)", "0", "2*c"),
            ("sgn(x + b)", "1", "b"),
            ("H(H(x - xc) + x - 2*xc)", "0", "xc"),
        ] {
            let (beside, sides) = beside_corners(&force.parse().unwrap(), "x".into()).unwrap();
            let expected: Expr = expected.parse().unwrap();
            assert!((&beside - &expected).expand().unwrap().is_zero(), "{force}: {beside}");
            assert_eq!(sides[0].positive, positive.parse().unwrap(), "{force}");
        }
        for force in ["abs(x)*x", "H(x - 1/2)", "max(x + a - b, 0)", "H(x + cos(t))", "sgn(x')"] {
            let force: Expr = force.parse().unwrap();
            assert_eq!(beside_corners(&force, "x".into()), Ok((force, vec![])));
        }
    }
}
