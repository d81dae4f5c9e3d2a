//! A law on an interval: its values and its slope, and the powers of a variable that reaches zero.
//!
//! In: a law as an expression, and the variable p or `r = 1/p` on an interval. Out: balls that contain the
//! value and the derivative of the law for all numbers of the interval, times a power of r: `sqrt(1 + p)` is
//! `r^(-1/2) sqrt(r + 1)`, so that it has a value at infinity beside a truth that grows alike.

use num_traits::{Signed as _, ToPrimitive as _, Zero as _};

use super::super::force::function_of;
use super::super::fourier_series::{FourierSeries, WORKING};
use super::{LawNotProved, restitution};
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;
use crate::exact::{Integer, Rational};
use crate::expr::{Expr, Function, Node};
use crate::symbol::Symbol;

/// The ball about the same number with a larger radius.
pub(super) fn widened(ball: &Ball, by: Bound) -> Ball {
    Ball { middle: ball.middle.clone(), radius: ball.radius + by }
}

/// A number and its derivative by the variable.
#[derive(Clone, Debug)]
pub(super) struct Jet {
    pub(super) value: Ball,
    pub(super) slope: Ball,
}

impl Jet {
    pub(super) fn constant(value: Ball) -> Self {
        Self { value, slope: Ball::zero() }
    }

    fn plus(&self, other: &Self) -> Self {
        Self {
            value: WORKING.sum(&self.value, &other.value),
            slope: WORKING.sum(&self.slope, &other.slope),
        }
    }

    pub(super) fn times(&self, other: &Self) -> Self {
        let product = |one: &Ball, other: &Ball| WORKING.product(one, other);
        Self {
            value: product(&self.value, &other.value),
            slope: WORKING
                .sum(&product(&self.slope, &other.value), &product(&self.value, &other.slope)),
        }
    }

    fn inverse(&self) -> Option<Self> {
        let value = WORKING.quotient(&WORKING.integer(1), &self.value)?;
        let slope = WORKING.product(&WORKING.product(&value, &value), &self.slope);
        Some(Self { value, slope: WORKING.scaled(&slope, -1) })
    }

    /// A rational power, of a positive number where it is not whole.
    pub(super) fn to_power(&self, exponent: &Rational) -> Option<Self> {
        let (times, degree) = (exponent.numer().abs().to_u32()?, exponent.denom().to_u32()?);
        if times > MOST_TIMES || degree > MOST_TIMES {
            return None;
        }
        let root = match degree {
            1 => self.clone(),
            _ => {
                let value = WORKING.root(&self.value, degree)?;
                // (u^(1/n))' = u' u^(1/n)/(n u).
                let slope = WORKING.quotient(&WORKING.product(&value, &self.slope), &self.value)?;
                Self { value, slope: WORKING.divided(&slope, degree) }
            }
        };
        let mut power = Self::constant(WORKING.integer(1));
        for _ in 0..times {
            power = power.times(&root);
        }
        if exponent.is_negative() { power.inverse() } else { Some(power) }
    }

    fn function(&self, function: Function) -> Option<Self> {
        let of = |function: Function| {
            let series = function_of(function, &FourierSeries::constant(self.value.clone()))?;
            Some(series.at_zero())
        };
        let value = of(function)?;
        let slope = match function {
            Function::Sin => of(Function::Cos)?,
            Function::Cos => WORKING.scaled(&of(Function::Sin)?, -1),
            Function::Exp => value.clone(),
            Function::Log => WORKING.quotient(&WORKING.integer(1), &self.value)?,
            _ => return None,
        };
        Some(Self { value, slope: WORKING.product(&slope, &self.slope) })
    }
}

/// The largest power, and degree of a root, of a law.
const MOST_TIMES: u32 = 64;

/// The variable, or r, on an interval.
pub(super) struct Variable {
    place: Ball,
    pub(super) from: Rational,
    to: Rational,
    /// The restitution of a contact there.
    pub(super) restitution: Option<Jet>,
}

impl Variable {
    pub(super) fn at(place: &Rational) -> Self {
        let (from, to) = (place.clone(), place.clone());
        Self { place: WORKING.fraction(place), from, to, restitution: None }
    }

    pub(super) fn between(from: &Rational, to: &Rational) -> Self {
        let two = Integer::from(2);
        let half = Bound::of_fraction(&((to - from) / &two));
        let place = widened(&WORKING.fraction(&((from + to) / &two)), half);
        Self { place, from: from.clone(), to: to.clone(), restitution: None }
    }

    /// `r^exponent` with its slope, for an exponent that is not negative.
    fn power(&self, exponent: &Rational) -> Option<Jet> {
        let jet = Jet { value: self.place.clone(), slope: WORKING.integer(1) };
        if exponent.is_zero() {
            return Some(Jet::constant(WORKING.integer(1)));
        }
        if exponent.is_integer() || self.from.is_positive() {
            return jet.to_power(exponent);
        }
        // Between zero and the power of the upper end, with a slope that is not bounded.
        let end = Jet::constant(WORKING.fraction(&self.to)).to_power(exponent)?;
        let half = WORKING.divided(&end.value, 2);
        let radius = WORKING.magnitude(&half);
        Some(Jet {
            value: widened(&half, radius),
            slope: Ball { middle: Integer::zero(), radius: Bound::UNKNOWN },
        })
    }
}

/// A number times a power of the variable of an interval, which may reach zero.
#[derive(Clone, Debug)]
pub(super) struct ScaledJet {
    pub(super) power: Rational,
    pub(super) jet: Jet,
}

impl ScaledJet {
    /// This number written with another, smaller power; `None` if the power of the variable has no value.
    fn with_power(&self, power: &Rational, variable: &Variable) -> Option<Self> {
        let more = &self.power - power;
        let jet = match more.is_zero() {
            true => self.jet.clone(),
            false => self.jet.times(&variable.power(&more)?),
        };
        Some(Self { power: power.clone(), jet })
    }

    /// The number itself, without a power.
    pub(super) fn unscaled(&self, variable: &Variable) -> Option<Jet> {
        let power = match self.power.is_negative() {
            true => variable.power(&-&self.power)?.inverse()?,
            false => variable.power(&self.power)?,
        };
        Some(self.jet.times(&power))
    }
}

/// The law with the variable in an interval, or its reciprocal.
pub(super) fn law_along(
    law: &Expr,
    symbol: Symbol,
    variable: &Variable,
    is_far: bool,
) -> Result<ScaledJet, LawNotProved> {
    let unscaled = |jet: Jet| ScaledJet { power: Rational::zero(), jet };
    let value = |node: &Expr, parts: &[ScaledJet]| -> Option<ScaledJet> {
        match node.node() {
            Node::Number(value) => Some(unscaled(Jet::constant(WORKING.fraction(value)))),
            Node::Pi => Some(unscaled(Jet::constant(WORKING.pi()))),
            Node::Symbol(name) if *name == symbol => Some(match is_far {
                false => unscaled(Jet { value: variable.place.clone(), slope: WORKING.integer(1) }),
                true => ScaledJet {
                    power: Rational::from_integer((-1).into()),
                    jet: Jet::constant(WORKING.integer(1)),
                },
            }),
            Node::Symbol(name) if *name == restitution() => {
                variable.restitution.clone().map(unscaled)
            }
            Node::Symbol(_) => None,
            Node::Sum(_) => {
                let least = parts.iter().map(|part| &part.power).min()?;
                let mut aligned = parts.iter().map(|part| part.with_power(least, variable));
                let first = aligned.next()??;
                aligned.try_fold(first, |sum, part| {
                    Some(ScaledJet { power: sum.power, jet: sum.jet.plus(&part?.jet) })
                })
            }
            Node::Product(coefficient, _) => {
                let number = unscaled(Jet::constant(WORKING.fraction(coefficient)));
                Some(parts.iter().fold(number, |product, part| ScaledJet {
                    power: &product.power + &part.power,
                    jet: product.jet.times(&part.jet),
                }))
            }
            Node::Power(_, exponent) => {
                let (base, exponent) = (parts.first()?, exponent.as_number()?);
                // The root of a variable that begins at zero.
                let is_variable = node.children().next()?.as_symbol() == Some(symbol);
                if is_variable && !is_far && !variable.from.is_positive() && !exponent.is_negative()
                {
                    return Some(unscaled(variable.power(exponent)?));
                }
                Some(ScaledJet { power: &base.power * exponent, jet: base.jet.to_power(exponent)? })
            }
            Node::Function(function, _) => {
                Some(unscaled(parts.first()?.unscaled(variable)?.function(*function)?))
            }
        }
    };
    law.fold(|node, parts: &[ScaledJet]| {
        value(node, parts).ok_or_else(|| LawNotProved::NoValue(node.to_string()))
    })
}
