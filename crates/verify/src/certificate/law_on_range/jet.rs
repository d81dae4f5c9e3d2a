//! A law on an interval: its series, or its values and its slope, and the powers of a variable that reaches zero.
//!
//! In: a law as an expression, and the variable p or `r = 1/p` on an interval. Out: a series of Chebyshev that
//! contains the law, or balls that contain its value and its derivative for all numbers of the interval, times a
//! power of r: `sqrt(1 + p)` is `r^(-1/2) sqrt(r + 1)`, so that it has a value at infinity beside a truth that
//! grows alike.

use num_traits::{Signed as _, ToPrimitive as _, Zero as _};

use super::super::elementary::Analytic;
use super::super::force::{function_of, power};
use super::super::fourier_series::{FourierSeries, WORKING};
use super::cosine_series::CosineSeries;
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

/// Values of a law on an interval.
pub(super) trait LawValues: Clone {
    /// A constant.
    fn constant(value: Ball) -> Self;

    /// A whole number.
    fn integer(value: i64) -> Self {
        Self::constant(WORKING.integer(value))
    }

    /// `self + other`.
    fn plus(&self, other: &Self) -> Self;

    /// `self * other`.
    fn times(&self, other: &Self) -> Self;

    /// A rational power, of a positive number where it is not whole; `None` if it is not proved to exist.
    fn to_power(&self, exponent: &Rational) -> Option<Self>;

    /// A function; `None` if it is not proved to exist.
    fn function(&self, function: Function) -> Option<Self>;

    /// All functions with values between zero and a number; `None` where they are no such values.
    fn up_to(end: &Ball) -> Option<Self>;
}

/// A cosine series in theta, where the variable is `m + h cos(theta)`: a series of Chebyshev.
impl<S: CosineSeries> LawValues for S {
    fn constant(value: Ball) -> Self {
        <Self as Analytic>::constant(value)
    }

    fn integer(value: i64) -> Self {
        <Self as Analytic>::integer(value)
    }

    fn plus(&self, other: &Self) -> Self {
        self.sum(other)
    }

    fn times(&self, other: &Self) -> Self {
        self.product(other)
    }

    fn to_power(&self, exponent: &Rational) -> Option<Self> {
        power(self, exponent)
    }

    fn function(&self, function: Function) -> Option<Self> {
        function_of(function, self)
    }

    fn up_to(_: &Ball) -> Option<Self> {
        None
    }
}

/// A number and its derivative by the variable.
#[derive(Clone, Debug)]
pub(super) struct Jet {
    pub(super) value: Ball,
    pub(super) slope: Ball,
}

impl Jet {
    fn inverse(&self) -> Option<Self> {
        let value = WORKING.quotient(&WORKING.integer(1), &self.value)?;
        let slope = WORKING.product(&WORKING.product(&value, &value), &self.slope);
        Some(Self { value, slope: WORKING.scaled(&slope, -1) })
    }
}

impl LawValues for Jet {
    fn constant(value: Ball) -> Self {
        Self { value, slope: Ball::zero() }
    }

    fn plus(&self, other: &Self) -> Self {
        Self {
            value: WORKING.sum(&self.value, &other.value),
            slope: WORKING.sum(&self.slope, &other.slope),
        }
    }

    fn times(&self, other: &Self) -> Self {
        let product = |one: &Ball, other: &Ball| WORKING.product(one, other);
        Self {
            value: product(&self.value, &other.value),
            slope: WORKING
                .sum(&product(&self.slope, &other.value), &product(&self.value, &other.slope)),
        }
    }

    fn to_power(&self, exponent: &Rational) -> Option<Self> {
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

    fn up_to(end: &Ball) -> Option<Self> {
        let half = WORKING.divided(end, 2);
        let radius = WORKING.magnitude(&half);
        let slope = Ball { middle: Integer::zero(), radius: Bound::UNKNOWN };
        Some(Self { value: widened(&half, radius), slope })
    }
}

/// The largest power, and degree of a root, of a law.
const MOST_TIMES: u32 = 64;

/// The variable, or r, on an interval.
pub(super) struct Variable<V> {
    own: V,
    pub(super) from: Rational,
    to: Rational,
    /// The restitution of a contact there.
    pub(super) restitution: Option<V>,
}

impl Variable<Jet> {
    /// The variable at a place.
    pub(super) fn at(place: &Rational) -> Self {
        Self::between(place, place)
    }

    /// The variable on an interval.
    pub(super) fn between(from: &Rational, to: &Rational) -> Self {
        let two = Integer::from(2);
        let half = Bound::of_fraction(&((to - from) / &two));
        let place = widened(&WORKING.fraction(&((from + to) / &two)), half);
        let own = Jet { value: place, slope: WORKING.integer(1) };
        Self { own, from: from.clone(), to: to.clone(), restitution: None }
    }
}

impl<S: CosineSeries> Variable<S> {
    /// The variable on an interval as a series of Chebyshev.
    pub(super) fn along(from: &Rational, to: &Rational) -> Self {
        Self { own: line(from, to), from: from.clone(), to: to.clone(), restitution: None }
    }
}

/// Binary digits of the series, whose errors need only be small beside the error of a law.
pub(super) const DIGITS: usize = 48;

/// The numbers from one to another as a series of Chebyshev.
fn line<S: CosineSeries>(from: &Rational, to: &Rational) -> S {
    let two = Integer::from(2);
    let ends = [(from + to) / &two, (to - from) / &two].map(|number| WORKING.fraction(&number));
    S::of_balls(ends.to_vec())
}

impl<V: LawValues> Variable<V> {
    /// `r^exponent`, for an exponent that is not negative.
    fn power(&self, exponent: &Rational) -> Option<V> {
        if exponent.is_zero() {
            return Some(V::integer(1));
        }
        if exponent.is_integer() || self.from.is_positive() {
            return self.own.to_power(exponent);
        }
        let end = Jet::constant(WORKING.fraction(&self.to)).to_power(exponent)?;
        V::up_to(&end.value)
    }
}

/// Values times a power of the variable of an interval, which may reach zero.
#[derive(Clone, Debug)]
pub(super) struct Scaled<V> {
    pub(super) power: Rational,
    pub(super) values: V,
}

impl<V: LawValues> Scaled<V> {
    /// These values written with another, smaller power; `None` if the power of the variable has no value.
    fn with_power(&self, power: &Rational, variable: &Variable<V>) -> Option<Self> {
        let more = &self.power - power;
        let values = match more.is_zero() {
            true => self.values.clone(),
            false => self.values.times(&variable.power(&more)?),
        };
        Some(Self { power: power.clone(), values })
    }

    /// The values themselves, without a power.
    pub(super) fn unscaled(&self, variable: &Variable<V>) -> Option<V> {
        if self.power.is_zero() {
            return Some(self.values.clone());
        }
        let power = match self.power.is_negative() {
            true => {
                let inverse = Rational::from_integer((-1).into());
                variable.power(&-&self.power)?.to_power(&inverse)?
            }
            false => variable.power(&self.power)?,
        };
        Some(self.values.times(&power))
    }
}

/// The law with the variable in an interval, or its reciprocal.
pub(super) fn law_along<V: LawValues>(
    law: &Expr,
    symbol: Symbol,
    variable: &Variable<V>,
    is_far: bool,
) -> Result<Scaled<V>, LawNotProved> {
    let unscaled = |values: V| Scaled { power: Rational::zero(), values };
    let value = |node: &Expr, parts: &[Scaled<V>]| -> Option<Scaled<V>> {
        match node.node() {
            Node::Number(value) => Some(unscaled(V::constant(WORKING.fraction(value)))),
            Node::Pi => Some(unscaled(V::constant(WORKING.pi()))),
            Node::Symbol(name) if *name == symbol => Some(match is_far {
                false => unscaled(variable.own.clone()),
                true => {
                    Scaled { power: Rational::from_integer((-1).into()), values: V::integer(1) }
                }
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
                    Some(Scaled { power: sum.power, values: sum.values.plus(&part?.values) })
                })
            }
            Node::Product(coefficient, _) => {
                let number = unscaled(V::constant(WORKING.fraction(coefficient)));
                Some(parts.iter().fold(number, |product, part| Scaled {
                    power: &product.power + &part.power,
                    values: product.values.times(&part.values),
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
                let values = base.values.to_power(exponent)?;
                Some(Scaled { power: &base.power * exponent, values })
            }
            Node::Function(function, _) => {
                Some(unscaled(parts.first()?.unscaled(variable)?.function(*function)?))
            }
        }
    };
    law.fold(|node, parts: &[Scaled<V>]| {
        value(node, parts).ok_or_else(|| LawNotProved::NoValue(node.to_string()))
    })
}
