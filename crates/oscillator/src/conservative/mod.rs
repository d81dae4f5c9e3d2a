//! Forces of the position alone: their potential, and their projection on a harmonic, both in
//! closed form.
//!
//! Every classical frequency formula of a conservative oscillator `x'' + f(x) = 0` is made of these
//! two:
//!
//! ```text
//! V(x)   = int_0^x f(u) du
//! c_k(A) = (2/pi) int_0^pi f(A cos theta) cos(k theta) dtheta
//! ```
//!
//! In comes the force as an expression and the name of its coordinate; out go `V` and `c_k` as
//! expressions, or `None` if a term has no closed form here: the methods fall back on quadrature
//! and say so. With numbers for all symbols the result is a [`CentredForce`], which gives a value,
//! a slope and a turning point however close to rest, and knows its narrow features; its
//! [well](well::Well) is the range of its periodic motions.

pub mod features;
pub mod force;
mod motion;
pub(crate) mod parity;
pub(crate) mod passage;
pub(crate) mod potential;
pub(crate) mod power;
pub(crate) mod projection;
pub mod well;

pub use force::CentredForce;
pub use parity::is_odd;
pub use potential::potential;
pub use projection::cosine_coefficient;

use crate::exact::Rational;
use crate::expr::{Expr, ExprError};
use crate::symbol::Symbol;

/// Whether a force has no corners: neither `abs`, `sgn`, `max`, `min` or `H`, nor a root of
/// something linear in the coordinate. Quadrature converges fast then, and only then.
///
/// ```
/// # use lindstedt_oscillator as lindstedt;
/// use lindstedt::{expr::Expr, method::is_smooth};
///
/// let [wave, wall]: [Expr; 2] = ["sin(x)".parse()?, "abs(x)".parse()?];
/// assert!(is_smooth(&wave, "x".into()) && !is_smooth(&wall, "x".into()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn is_smooth(force: &Expr, coordinate: Symbol) -> bool {
    use crate::expr::Node;
    if force.contains_corner() {
        return false;
    }
    let has_root = force.fold(|expr, children: &[bool]| {
        let root = match expr.node() {
            Node::Power(base, exponent) => {
                exponent.as_number().is_some_and(|number| !number.is_integer())
                    && linear_in(base, coordinate).is_some()
            }
            _ => false,
        };
        Ok::<bool, std::convert::Infallible>(root || children.contains(&true))
    });
    has_root == Ok(false)
}

/// Slope and constant of an argument `slope*x + constant`; `None` if it is not linear in `x`, or
/// constant.
pub(crate) fn linear_in(argument: &Expr, coordinate: Symbol) -> Option<(Expr, Expr)> {
    let slope = argument.differentiate(coordinate).ok()?.expand().ok()?;
    if slope.is_zero() || slope.contains(coordinate) {
        return None;
    }
    let constant = (argument - &(&slope * &Expr::from(coordinate))).expand().ok()?;
    (!constant.contains(coordinate)).then_some((slope, constant))
}

/// The force without `abs`, `sgn`, `max` and `min` of shifted arguments: `abs(u) = u (2 H(u) - 1)`
/// and so on. Those of the coordinate itself stay. A step whose argument has its zeros in closed
/// form, as `1 - x^2`, becomes a sum of steps at these zeros.
pub(crate) fn with_steps(force: &Expr, coordinate: Symbol) -> Result<Expr, ExprError> {
    use crate::expr::{Function, Node};
    let step = |u: Expr| match steps_at_zeros(&u, coordinate) {
        Some(steps) => Ok(steps),
        None => Expr::function(Function::Step, vec![u]),
    };
    force.fold(|expr, children: &[Expr]| {
        let shifted = |u: &Expr| {
            u.contains(coordinate)
                && linear_in(u, coordinate).is_none_or(|(_, constant)| !constant.is_zero())
        };
        match (expr.node(), children) {
            (Node::Function(Function::Absolute, _), [u]) if shifted(u) => {
                Ok(u * &(Expr::from(2) * step(u.clone())? - Expr::one()))
            }
            (Node::Function(Function::Sign, _), [u]) if shifted(u) => {
                Ok(Expr::from(2) * step(u.clone())? - Expr::one())
            }
            (Node::Function(Function::Maximum, _), [u, v])
                if u.contains(coordinate) || v.contains(coordinate) =>
            {
                Ok(v + &((u - v) * step(u - v)?))
            }
            (Node::Function(Function::Minimum, _), [u, v])
                if u.contains(coordinate) || v.contains(coordinate) =>
            {
                Ok(u - &((u - v) * step(u - v)?))
            }
            (Node::Function(Function::Step, _), [u]) => step(u.clone()),
            _ => expr.with_children(children),
        }
    })
}

/// `H(u)` as a sum of steps at the zeros of `u`, where `u` is a constant plus a power of the
/// coordinate or of its size, or a quadratic with numbers for coefficients; `None` for anything
/// else, and for a step that is in this form already. Parameters under a root are taken to be
/// positive.
fn steps_at_zeros(u: &Expr, coordinate: Symbol) -> Option<Expr> {
    use crate::expr::Function;
    use num_integer::Integer as _;
    let step = |u: &Expr| Expr::function(Function::Step, vec![u.clone()]).ok();
    let x = Expr::from(coordinate);
    // One between two places, zero outside.
    let between = |low: &Expr, high: &Expr| Some(step(&(&x - low))? - step(&(&x - high))?);
    let expanded = u.expand().ok()?;
    let mut constants = Vec::new();
    let mut powers: Vec<(SignedPower, Expr)> = Vec::new();
    for term in expanded.terms() {
        let (outside, mut inside) = split(term, coordinate);
        if inside.is_empty() {
            constants.push(outside);
            continue;
        }
        let mut coefficient = outside;
        let power = take_powers(&mut inside, &mut coefficient, coordinate)?;
        if !inside.is_empty() || !num_traits::Signed::is_positive(&power.exponent) {
            return None;
        }
        powers.push((power, coefficient));
    }
    let constant = Expr::sum(constants);
    // If one of the two signs is that of a number, the other is its opposite: only then are the
    // zeros real.
    let inside_and_outside = |inside: Expr, within: &Expr, beyond: &Expr| {
        let [within, beyond] = match (within.as_number(), beyond.as_number()) {
            (None, Some(_)) => [step(&-beyond)?, step(beyond)?],
            _ => [step(within)?, step(&-within)?],
        };
        (&beyond + &((within - &beyond) * inside)).expand().ok()
    };
    if let [(power, coefficient)] = powers.as_slice() {
        if constant.is_zero() || (power.odd && num_traits::One::is_one(&power.exponent)) {
            return None;
        }
        let root = Expr::number(power.exponent.recip());
        let ratio = (-&Expr::divide(&constant, coefficient).ok()?).expand().ok()?;
        if power.odd {
            // An odd power is monotonic: the root of a negative number is minus that of its size.
            let (negative, size) = match ratio.has_leading_minus() {
                true => (true, -ratio),
                false => (false, ratio),
            };
            let zero = Expr::power(&size, &root).ok()?;
            let zero = if negative { -zero } else { zero };
            let above = step(&(&x - &zero))?;
            return (step(coefficient)? * &above + step(&-coefficient)? * (Expr::one() - above))
                .expand()
                .ok();
        }
        if ratio.has_leading_minus() {
            return step(&constant);
        }
        let zero = root_of_size(&ratio, &power.exponent)?;
        return inside_and_outside(between(&-&zero, &zero)?, &constant, coefficient);
    }
    // c + b x + a x^2.
    let of = |exponent: i64| {
        let wanted = Rational::from_integer(exponent.into());
        let found = powers
            .iter()
            .find(|(power, _)| power.exponent == wanted && power.odd == exponent.is_odd());
        found.and_then(|(_, coefficient)| coefficient.as_number().cloned())
    };
    let ([_, _], Some(linear), Some(square)) = (powers.as_slice(), of(1), of(2)) else {
        return None;
    };
    let constant = constant.as_number().cloned()?;
    let four = Rational::from_integer(4.into());
    let discriminant = &linear * &linear - &four * &square * constant;
    let square_number = Expr::number(square.clone());
    if !num_traits::Signed::is_positive(&discriminant) {
        return step(&square_number);
    }
    let half = Expr::divide(
        &Expr::number(discriminant).sqrt().ok()?,
        &Expr::number(four * &square / Rational::from_integer(2.into())),
    )
    .ok()?;
    let middle = Expr::number(-linear / (Rational::from_integer(2.into()) * &square));
    let (low, high) = match num_traits::Signed::is_positive(&square) {
        true => (&middle - &half, &middle + &half),
        false => (&middle + &half, &middle - &half),
    };
    inside_and_outside(between(&low, &high)?, &-&square_number, &square_number)
}

/// The root, of this degree, of a value that is positive wherever the root is real: that of `c^2/4`
/// is `abs(c)/2`.
fn root_of_size(value: &Expr, degree: &Rational) -> Option<Expr> {
    use crate::expr::Function;
    use num_integer::Integer as _;
    let root = Expr::number(degree.recip());
    let (number, factors) = value.factors();
    let even = |factor: &Expr| {
        let (base, exponent) = factor.base_and_exponent();
        let exponent = exponent
            .as_number()
            .filter(|exponent| exponent.is_integer() && exponent.numer().is_even())?;
        let size = Expr::function(Function::Absolute, vec![base]).ok()?;
        Expr::power(&size, &Expr::number(exponent / degree)).ok()
    };
    match factors.iter().map(even).collect::<Option<Vec<Expr>>>() {
        Some(sizes) => Some(Expr::power(&Expr::number(number), &root).ok()? * Expr::product(sizes)),
        None => Expr::power(value, &root).ok(),
    }
}

/// A product of powers of the coordinate, its sign and its size: `sgn(x)^odd |x|^exponent`.
pub(crate) struct SignedPower {
    /// The power of |x|.
    pub exponent: crate::exact::Rational,
    /// Whether the function is odd.
    pub odd: bool,
}

/// Takes the factors that are powers of the coordinate, its size and its sign out of `factors`; the
/// slopes of `abs(k*x)` go into `coefficient`.
pub(crate) fn take_powers(
    factors: &mut Vec<Expr>,
    coefficient: &mut Expr,
    coordinate: Symbol,
) -> Option<SignedPower> {
    use crate::expr::{Function, Node};
    use num_integer::Integer as _;
    use num_traits::Zero;
    let mut power = SignedPower { exponent: Zero::zero(), odd: false };
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
                } else if let (Some(slope), true) =
                    (homogeneous(Function::Sign), number.is_integer())
                {
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
