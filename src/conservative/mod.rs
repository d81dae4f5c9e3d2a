//! Forces of the position alone: their potential, and their projection on a harmonic, both in closed form.
//!
//! Every classical frequency formula of a conservative oscillator `x'' + f(x) = 0` is made of these two:
//!
//! ```text
//! V(x)   = int_0^x f(u) du
//! c_k(A) = (2/pi) int_0^pi f(A cos theta) cos(k theta) dtheta
//! ```
//!
//! In comes the force as an expression and the name of its coordinate; out go `V` and `c_k` as expressions, or `None` where a term
//! has no closed form here: the methods fall back on quadrature and say so. With numbers for all symbols out goes a [`Force`], which
//! has a value, a slope and a turning point as near to rest as one likes, and knows where it turns fast; its [well](well::Well) has ends.

pub(crate) mod features;
pub(crate) mod force;
mod motion;
pub(crate) mod parity;
pub(crate) mod passage;
pub(crate) mod potential;
pub(crate) mod power;
pub(crate) mod projection;
pub(crate) mod well;

pub use force::Force;
pub use parity::is_odd;
pub use potential::potential;
pub use projection::cosine_coefficient;

use crate::expr::{Expr, ExprError};
use crate::symbol::Symbol;

/// Whether a force has no corners: neither `abs`, `sgn`, `max`, `min` or `H`, nor a root of something linear in the coordinate.
/// Quadrature converges fast then, and only then.
///
/// ```
/// use lindstedt::{expr::Expr, method::is_smooth};
///
/// let [wave, wall]: [Expr; 2] = ["sin(x)".parse()?, "abs(x)".parse()?];
/// assert!(is_smooth(&wave, "x".into()) && !is_smooth(&wall, "x".into()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn is_smooth(force: &Expr, coordinate: Symbol) -> bool {
    use crate::expr::Function::{Absolute, Maximum, Minimum, Sign, Step};
    use crate::expr::Node;
    let corners = [Absolute, Maximum, Minimum, Sign, Step];
    if corners.into_iter().any(|function| force.contains_function(function)) {
        return false;
    }
    let has_root = force.fold(|expr, children: &[bool]| {
        let root = match expr.node() {
            Node::Power(base, exponent) => {
                exponent.as_number().is_some_and(|number| !number.is_integer()) && linear_in(base, coordinate).is_some()
            }
            _ => false,
        };
        Ok::<bool, std::convert::Infallible>(root || children.contains(&true))
    });
    has_root == Ok(false)
}

/// Slope and constant of an argument `slope*x + constant`; `None` where it is not linear in `x`, or constant.
pub(crate) fn linear_in(argument: &Expr, coordinate: Symbol) -> Option<(Expr, Expr)> {
    let slope = argument.differentiate(coordinate).ok()?.expand().ok()?;
    if slope.is_zero() || slope.contains(coordinate) {
        return None;
    }
    let constant = (argument - &(&slope * &Expr::from(coordinate))).expand().ok()?;
    (!constant.contains(coordinate)).then_some((slope, constant))
}

/// The force without `abs`, `sgn`, `max` and `min` of shifted arguments: `abs(u) = u (2 H(u) - 1)` and so on. Those of
/// the coordinate itself stay.
pub(crate) fn with_steps(force: &Expr, coordinate: Symbol) -> Result<Expr, ExprError> {
    use crate::expr::{Function, Node};
    let step = |u: Expr| Expr::function(Function::Step, vec![u]);
    force.fold(|expr, children: &[Expr]| {
        let shifted = |u: &Expr| {
            u.contains(coordinate) && linear_in(u, coordinate).is_none_or(|(_, constant)| !constant.is_zero())
        };
        match (expr.node(), children) {
            (Node::Function(Function::Absolute, _), [u]) if shifted(u) => {
                Ok(u * &(Expr::from(2) * step(u.clone())? - Expr::one()))
            }
            (Node::Function(Function::Sign, _), [u]) if shifted(u) => {
                Ok(Expr::from(2) * step(u.clone())? - Expr::one())
            }
            (Node::Function(Function::Maximum, _), [u, v]) if u.contains(coordinate) || v.contains(coordinate) => {
                Ok(v + &((u - v) * step(u - v)?))
            }
            (Node::Function(Function::Minimum, _), [u, v]) if u.contains(coordinate) || v.contains(coordinate) => {
                Ok(u - &((u - v) * step(u - v)?))
            }
            _ => expr.with_children(children),
        }
    })
}

/// A product of powers of the coordinate, its sign and its size: `sgn(x)^odd |x|^exponent`.
pub(crate) struct SignedPower {
    /// The power of |x|.
    pub exponent: crate::exact::Rational,
    /// Whether the function is odd.
    pub odd: bool,
}

/// Takes the factors that are powers of the coordinate, its size and its sign out of `factors`; the slopes of `abs(k*x)`
/// go into `coefficient`.
pub(crate) fn take_powers(factors: &mut Vec<Expr>, coefficient: &mut Expr, coordinate: Symbol) -> Option<SignedPower> {
    use crate::expr::{Function, Node};
    use num_integer::Integer as _;
    use num_traits::Zero;
    let mut power = SignedPower {
        exponent: Zero::zero(),
        odd: false,
    };
    let mut rest = Vec::new();
    for factor in factors.drain(..) {
        let (base, exponent) = factor.base_and_exponent();
        let homogeneous = |function: Function| match base.node() {
            Node::Function(found, arguments) if *found == function => {
                let (slope, constant) = linear_in(arguments.first()?, coordinate)?;
                constant.is_zero().then_some(slope)
            }
            _ => None,
        };
        let number = exponent.as_number().cloned();
        match number {
            Some(number) if base.as_symbol() == Some(coordinate) => {
                // An even root of x exists for x > 0 alone.
                if number.denom().is_even() {
                    return None;
                }
                power.odd ^= number.numer().is_odd();
                power.exponent += number;
            }
            Some(number) => {
                if let Some(slope) = homogeneous(Function::Absolute) {
                    let size = Expr::function(Function::Absolute, vec![slope]).ok()?;
                    *coefficient = &*coefficient * &Expr::power(&size, &exponent).ok()?;
                    power.exponent += number;
                } else if let (Some(slope), true) = (homogeneous(Function::Sign), number.is_integer()) {
                    if number.numer().is_odd() {
                        let sign = Expr::function(Function::Sign, vec![slope]).ok()?;
                        *coefficient = &*coefficient * &sign;
                        power.odd = !power.odd;
                    }
                } else {
                    rest.push(factor);
                }
            }
            None => rest.push(factor),
        }
    }
    *factors = rest;
    Some(power)
}

/// The factors of a term that contain the coordinate, and the product of the others.
pub(crate) fn split(term: &Expr, coordinate: Symbol) -> (Expr, Vec<Expr>) {
    let (number, factors) = term.factors();
    let (inside, outside): (Vec<Expr>, Vec<Expr>) =
        factors.iter().cloned().partition(|factor| factor.contains(coordinate));
    let outside = Expr::product(std::iter::once(Expr::number(number)).chain(outside));
    (outside, inside)
}
