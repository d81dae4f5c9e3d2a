//! Sums of products of sines and cosines made shorter by the addition theorems:
//!
//! ```text
//! cos u cos v +- sin u sin v = cos(u -+ v)        sin u cos v +- cos u sin v = sin(u +- v)
//! ```
//!
//! with `u = v` in the first giving 1 or `cos(2u)`: only the 1 is used, since it is what the square
//! of a speed yields.

use std::collections::HashMap;

use num_traits::Signed;

use crate::exact::Rational;
use crate::expr::{Expr, ExprError, Function, Node};

/// Largest number of terms of a sum that is simplified.
const MOST_TERMS: usize = 2000;

/// Expands an expression and joins every pair of terms to which an addition theorem applies.
///
/// # Errors
/// [`ExprError`] if the expanded expression would be too long.
pub(super) fn simplified(expression: &Expr) -> Result<Expr, ExprError> {
    let mut sum = without_inverses(expression)?.expand()?;
    while sum.terms().len() <= MOST_TERMS {
        match join_one_pair(&sum)? {
            Some(shorter) => sum = shorter.expand()?,
            None => break,
        }
    }
    Ok(sum)
}

/// Applies `cos(acos(u)) = u` and `sin(acos(u)) = sqrt(1 - u^2)`, which occur at an equilibrium
/// given by a cosine.
fn without_inverses(expression: &Expr) -> Result<Expr, ExprError> {
    expression.fold(|expr, children: &[Expr]| {
        let inner = children.first().map(Expr::node);
        match (expr.node(), inner) {
            (Node::Function(Function::Cos, _), Some(Node::Function(Function::Acos, u))) => {
                Ok(u[0].clone())
            }
            (Node::Function(Function::Sin, _), Some(Node::Function(Function::Acos, u))) => {
                (Expr::one() - u[0].integer_power(2)?).sqrt()
            }
            _ => expr.with_children(children),
        }
    })
}

/// Returns the sum with one pair of its terms joined; `None` if there is no such pair.
fn join_one_pair(sum: &Expr) -> Result<Option<Expr>, ExprError> {
    let terms = sum.terms();
    let bare: Vec<(Rational, Expr)> = terms.iter().map(without_number).collect();
    let places: HashMap<&Expr, usize> =
        bare.iter().enumerate().map(|(index, (_, term))| (term, index)).collect();
    for (index, (number, term)) in bare.iter().enumerate() {
        for [first, second] in pairs(term) {
            let rest = Expr::divide(term, &(&first.expression() * &second.expression()))?;
            let partner = &rest * &(first.cofunction()? * second.cofunction()?);
            let Some(&place) = places.get(&partner) else {
                continue;
            };
            let other = &bare[place].0;
            let opposite = other.is_negative() != number.is_negative();
            // A square and its partner are also joined in part, since this leaves one term of that
            // degree less.
            let whole = other.abs() == number.abs();
            if place == index || !(whole || first.angle == second.angle) {
                continue;
            }
            let Some(together) = SineOrCosine::combine(&first, &second, opposite)? else {
                continue;
            };
            let share = match other.abs() < number.abs() {
                true => other.abs() * number.signum(),
                false => number.clone(),
            };
            let left = terms.iter().enumerate().map(|(at, term)| match at {
                _ if at == index => {
                    Expr::product([Expr::number(number - &share), bare[index].1.clone()])
                }
                _ if at == place => {
                    let share = if opposite { -share.clone() } else { share.clone() };
                    Expr::product([Expr::number(other - share), bare[place].1.clone()])
                }
                _ => term.clone(),
            });
            let joined = Expr::product([Expr::number(share.clone()), rest, together]);
            return Ok(Some(Expr::sum(left.chain([joined]))));
        }
    }
    Ok(None)
}

/// Splits a term into its number and the rest.
fn without_number(term: &Expr) -> (Rational, Expr) {
    let (number, factors) = term.factors();
    (number, Expr::product(factors.iter().cloned()))
}

/// The sine or cosine of an angle.
#[derive(Clone, PartialEq)]
struct SineOrCosine {
    function: Function,
    angle: Expr,
}

impl SineOrCosine {
    fn expression(&self) -> Expr {
        // The sine or cosine comes from an expression, so the function cannot fail.
        Expr::function(self.function, vec![self.angle.clone()]).unwrap_or_else(|_| Expr::zero())
    }

    /// Returns the cosine for a sine, and the sine for a cosine, of the same angle.
    fn cofunction(&self) -> Result<Expr, ExprError> {
        let function = match self.function {
            Function::Sin => Function::Cos,
            _ => Function::Sin,
        };
        Expr::function(function, vec![self.angle.clone()])
    }

    /// Returns `first*second` plus the product of their cofunctions, or minus it if `opposite`, as
    /// one sine or cosine; `None` if that is no shorter.
    fn combine(first: &Self, second: &Self, opposite: bool) -> Result<Option<Expr>, ExprError> {
        let (u, v) = (&first.angle, &second.angle);
        match (first.function, second.function, opposite) {
            (Function::Cos, Function::Cos, false) => (u - v).cos().map(Some),
            (Function::Cos, Function::Cos, true) if u != v => (u + v).cos().map(Some),
            (Function::Sin, Function::Cos, false) if u != v => (u + v).sin().map(Some),
            (Function::Sin, Function::Cos, true) if u != v => (u - v).sin().map(Some),
            _ => Ok(None),
        }
    }
}

/// Returns every ordered pair of sines and cosines among the factors of a term; a square makes a
/// pair with itself.
fn pairs(term: &Expr) -> Vec<[SineOrCosine; 2]> {
    let (_, factors) = term.factors();
    let mut waves = Vec::new();
    for factor in factors {
        let (base, exponent) = factor.base_and_exponent();
        let Node::Function(function @ (Function::Sin | Function::Cos), arguments) = base.node()
        else {
            continue;
        };
        let whole = exponent.as_number().filter(|exponent| {
            exponent.is_integer() && **exponent >= Rational::from_integer(1.into())
        });
        let (Some(exponent), Some(angle)) = (whole, arguments.first()) else {
            continue;
        };
        let times = if *exponent >= Rational::from_integer(2.into()) { 2 } else { 1 };
        let wave = SineOrCosine { function: *function, angle: angle.clone() };
        waves.extend(std::iter::repeat_n(wave, times));
    }
    let mut pairs = Vec::new();
    for first in 0..waves.len() {
        for second in 0..waves.len() {
            if first != second {
                pairs.push([waves[first].clone(), waves[second].clone()]);
            }
        }
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addition_theorems_join_terms() {
        for (typed, short) in [
            ("m*sin(x)^2 + m*cos(x)^2", "m"),
            ("k*cos(a)*cos(b) + k*sin(a)*sin(b) + 1", "1 + k*cos(a - b)"),
            ("cos(a)*cos(b) - sin(a)*sin(b)", "cos(a + b)"),
            ("p*sin(a)*cos(b) - p*cos(a)*sin(b)", "p*sin(a - b)"),
            ("sin(a)*cos(b) + cos(a)*sin(b)", "sin(a + b)"),
            ("2*sin(x)^2 + 3*cos(x)^2", "2 + cos(x)^2"),
            ("2*cos(a)*cos(b) + sin(a)*sin(b)", "2*cos(a)*cos(b) + sin(a)*sin(b)"),
            ("cos(x)^2 - sin(x)^2", "cos(x)^2 - sin(x)^2"),
            ("x*(sin(x)^2 + cos(x)^2)^2", "x"),
            ("sin(a)*cos(a)", "sin(a)*cos(a)"),
            ("cos(acos(u)) + sin(acos(u))^2 + sin(-acos(u))^2", "2 + u - 2*u^2"),
        ] {
            let typed: Expr = typed.parse().unwrap();
            let short: Expr = short.parse().unwrap();
            assert_eq!(simplified(&typed).unwrap(), short, "{typed}");
        }
    }
}
