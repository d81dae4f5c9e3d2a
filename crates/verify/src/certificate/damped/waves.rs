//! Sines and cosines of time as symbols: those of the drive, and of multiples of its frequency.
//!
//! In: an expression in time, and a frequency. Out: the same in `c = cos(Omega t)` and
//! `s = sin(Omega t)`, exactly.

use num_integer::Integer as _;
use num_traits::{ToPrimitive as _, Zero as _};

use super::super::candidate::NotCertified;
use super::super::force::along_all;
use super::super::fourier_series::{FourierSeries, WORKING};
use super::super::law;
use super::Drive;
use super::problem::waves_of_drive;
use crate::exact::ball::Ball;
use crate::exact::{Integer, Rational};
use crate::expr::{Expr, Function, Node};
use crate::symbol::Symbol;
use crate::values::Values;

/// The displacement of a driven motion by its law as text, `x = a*cos(Omega*t - psi)` with values
/// of all symbols but t, over the periods of the motion; `None` for words, and for a law without
/// such a series.
pub(super) fn displacement(law: &str, values: &Values, drive: &Drive) -> Option<FourierSeries> {
    let time = Symbol::new("t");
    let (_, value) = law::with_values(law, values)?;
    let periods = Rational::from_integer(Integer::from(drive.periods));
    let value = in_waves(&value, time, &(&drive.frequency / periods)).ok()?;
    let [cosine, sine] = waves_of_drive();
    let wave = || vec![Ball::zero(), WORKING.integer(1)];
    let letters = [
        (cosine, &FourierSeries::exactly(wave(), vec![])),
        (sine, &FourierSeries::exactly(vec![], wave())),
    ];
    along_all(&value, &letters).ok()
}

/// The frequency of which those of all sines and cosines of time are whole multiples.
///
/// # Errors
/// A frequency that is no fraction, or none at all.
pub(super) fn common_frequency(
    expressions: &[Expr],
    time: Symbol,
) -> Result<Rational, NotCertified> {
    let mut common: Option<Rational> = None;
    for expression in expressions {
        expression.fold(|node, _: &[()]| -> Result<(), NotCertified> {
            if let Node::Function(Function::Sin | Function::Cos, arguments) = node.node()
                && let Some(argument) = arguments.first().filter(|argument| argument.contains(time))
            {
                let rate = argument.differentiate(time)?.expand()?;
                let number = rate.as_number().map(num_traits::Signed::abs);
                let number = number.filter(|number| !number.is_zero());
                let own = number.ok_or_else(|| NotCertified::DrivingFrequency(rate.to_string()))?;
                common = Some(match common.take() {
                    None => own,
                    Some(other) => Rational::new(
                        own.numer().gcd(other.numer()),
                        own.denom().lcm(other.denom()),
                    ),
                });
            }
            Ok(())
        })?;
    }
    common.ok_or(NotCertified::NoSteadyMotion)
}

/// An expression with the symbols of `cos(Omega t)` and `sin(Omega t)` in place of time.
pub(super) fn in_waves(
    expression: &Expr,
    time: Symbol,
    frequency: &Rational,
) -> Result<Expr, NotCertified> {
    let own = waves_of_drive();
    if let Some(taken) = own.iter().find(|name| expression.contains(**name)) {
        return Err(NotCertified::NotDriven(taken.to_string()));
    }
    let other = |node: &Expr| NotCertified::NotDriven(node.to_string());
    expression.fold(|node, children: &[Expr]| match node.node() {
        Node::Function(Function::Sin | Function::Cos, _)
            if children.iter().any(|child| child.contains(time)) =>
        {
            let argument = children[0].expand()?;
            let rate = argument.differentiate(time)?.expand()?;
            let times = rate.as_number().map(|rate| rate / frequency).filter(Rational::is_integer);
            let times =
                times.and_then(|times| times.to_integer().to_i32()).ok_or_else(|| other(node))?;
            let [cosine, sine] = multiple(own, times).ok_or_else(|| other(node))?;
            // cos(k Omega t + b) and sin of the same, b all the rest.
            let rest = argument.substitute(time, &Expr::zero())?;
            let [cosine_of_rest, sine_of_rest] = [Function::Cos, Function::Sin]
                .map(|function| Expr::function(function, vec![rest.clone()]));
            let (cosine_of_rest, sine_of_rest) = (cosine_of_rest?, sine_of_rest?);
            Ok(match node.node() {
                Node::Function(Function::Cos, _) => {
                    &(&cosine * &cosine_of_rest) - &(&sine * &sine_of_rest)
                }
                _ => &(&sine * &cosine_of_rest) + &(&cosine * &sine_of_rest),
            })
        }
        // Time itself stays until it is found inside a wave.
        Node::Symbol(_) | Node::Number(_) | Node::Pi => Ok(node.clone()),
        _ => Ok(node.with_children(children)?),
    })
}

/// Cosine and sine of a whole multiple of an angle in terms of those of the angle.
fn multiple([cosine, sine]: [Symbol; 2], times: i32) -> Option<[Expr; 2]> {
    const MOST: u32 = 20;
    let [one_cosine, one_sine] = [cosine, sine].map(Expr::from);
    let mut found = [Expr::one(), Expr::zero()];
    for _ in 0..times.unsigned_abs().min(MOST + 1) {
        let [cosine, sine] = found;
        found = [
            &(&cosine * &one_cosine) - &(&sine * &one_sine),
            &(&sine * &one_cosine) + &(&cosine * &one_sine),
        ];
    }
    let [cosine, sine] = found;
    (times.unsigned_abs() <= MOST).then(|| [cosine, if times < 0 { -sine } else { sine }])
}
