//! A force evaluated on a whole ball of motions: the expression as it was typed, over cosine
//! series.
//!
//! In: `f`, `f'` or `f''` as an expression in the coordinate with exact numbers. Out: a series that
//! contains its values on every motion of the ball. Sums, products and elementary functions of
//! analytic arguments have one; a corner (`abs`, `sgn`, `max`, a fractional power through zero) has
//! none, because the proof needs harmonics that decay.

use num_traits::{One as _, Signed as _, ToPrimitive as _};

use super::coordinate;
use super::elementary::Analytic;
use super::fourier_series::{FourierSeries, WORKING};
use crate::exact::Rational;
use crate::exact::bound::Bound;
use crate::expr::{Expr, ExprError, Function, Node};
use crate::symbol::Symbol;

/// A part of a force that cannot be evaluated over cosine series.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct NoValue(
    /// The part of the expression.
    pub(super) String,
);

/// The values of the expression where the coordinate has these values.
///
/// # Errors
/// [`NoValue`].
pub(super) fn along(force: &Expr, motion: &FourierSeries) -> Result<FourierSeries, NoValue> {
    along_all(force, &[(coordinate(), motion)])
}

/// The values of the expression where its symbols have these values.
///
/// # Errors
/// [`NoValue`].
pub(super) fn along_all<S: Analytic>(force: &Expr, letters: &[(Symbol, &S)]) -> Result<S, NoValue> {
    force.fold(|node, parts: &[S]| {
        let value = value(node, letters, parts);
        value.filter(|value| value.norm() < Bound::UNKNOWN).ok_or_else(|| NoValue(node.to_string()))
    })
}

fn value<S: Analytic>(node: &Expr, letters: &[(Symbol, &S)], parts: &[S]) -> Option<S> {
    match node.node() {
        Node::Number(value) => Some(S::constant(WORKING.fraction(value))),
        Node::Pi => Some(S::constant(WORKING.pi())),
        Node::Symbol(symbol) => {
            letters.iter().find(|(letter, _)| letter == symbol).map(|(_, series)| (*series).clone())
        }
        Node::Sum(_) => parts.iter().cloned().reduce(|sum, part| sum.sum(&part)),
        Node::Product(coefficient, _) => {
            let product = parts.iter().cloned().reduce(|product, part| product.product(&part))?;
            Some(times(product, coefficient))
        }
        Node::Power(_, exponent) => power(parts.first()?, exponent.as_number()?),
        Node::Function(function, _) => function_of(*function, parts.first()?),
    }
}

fn times<S: Analytic>(series: S, coefficient: &Rational) -> S {
    match coefficient.is_one() {
        true => series,
        false => series.product(&S::constant(WORKING.fraction(coefficient))),
    }
}

/// The highest whole power that is computed by products.
const HIGHEST_POWER: u32 = 200;

/// A rational power, of a positive series where it is not whole; `None` if it is not proved to exist.
pub(super) fn power<S: Analytic>(base: &S, exponent: &Rational) -> Option<S> {
    let times = exponent.numer().abs().to_u32().filter(|times| *times <= HIGHEST_POWER)?;
    let degree = exponent.denom().to_u32().filter(|degree| *degree <= HIGHEST_POWER)?;
    match (degree, exponent.is_negative()) {
        (1, false) => Some(base.power(times)),
        (1, true) => Some(base.inverse()?.power(times)),
        (_, true) => Some(base.inverse_root(degree)?.power(times)),
        // u^(1/n) = u (u^(-1/n))^(n - 1).
        (_, false) => {
            Some(base.product(&base.inverse_root(degree)?.power(degree - 1)).power(times))
        }
    }
}

/// A function of a series; `None` if it is not proved to have a value, or has no enclosure here.
pub(super) fn function_of<S: Analytic>(function: Function, argument: &S) -> Option<S> {
    let hyperbolic = || {
        let growing = argument.exponential()?;
        let falling = argument.scaled(-1).exponential()?;
        Some((growing.difference(&falling), growing.sum(&falling)))
    };
    let half = Rational::new(1.into(), 2.into());
    match function {
        Function::Sin => Some(argument.sine_and_cosine()?.0),
        Function::Cos => Some(argument.sine_and_cosine()?.1),
        Function::Tan => {
            let (sine, cosine) = argument.sine_and_cosine()?;
            Some(sine.product(&cosine.inverse()?))
        }
        Function::Exp => argument.exponential(),
        Function::Sinh => Some(times(hyperbolic()?.0, &half)),
        Function::Cosh => Some(times(hyperbolic()?.1, &half)),
        Function::Tanh => {
            let (sine, cosine) = hyperbolic()?;
            Some(sine.product(&cosine.inverse()?))
        }
        Function::Log => argument.logarithm(),
        Function::Atan => argument.arctangent(),
        _ => None,
    }
}

/// Whether `f(-x) = -f(x)`, where x stands for all these symbols, as far as expansion shows it.
///
/// # Errors
/// A point at which the force has no value is written in it.
pub(super) fn is_odd(force: &Expr, letters: &[Symbol]) -> Result<bool, ExprError> {
    Ok(is_nothing(&(force + &mirrored(force, letters)?)))
}

/// Whether `f(-x) = f(x)`, where x stands for all these symbols, as far as expansion shows it.
///
/// # Errors
/// As [`is_odd`].
pub(super) fn is_even(force: &Expr, letters: &[Symbol]) -> Result<bool, ExprError> {
    Ok(is_nothing(&(force - &mirrored(force, letters)?)))
}

fn mirrored(force: &Expr, letters: &[Symbol]) -> Result<Expr, ExprError> {
    let turned = |letter: &Symbol| (*letter, -&Expr::from(*letter));
    force.substitute_all(&letters.iter().map(turned).collect())
}

fn is_nothing(expression: &Expr) -> bool {
    expression.is_zero() || expression.expand().is_ok_and(|expression| expression.is_zero())
}
