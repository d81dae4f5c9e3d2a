//! Formulas of a search: trees of numbers and names, their text and their length.
//!
//! The length of a formula is the number of symbols in its text: each digit of a number but zeros in
//! front, each name, each function and each sign of `+ - * / ^` counts one; brackets, decimal points
//! and spaces count nothing. `4/(1 + sqrt(c))^2` has the length 8.

use std::collections::BTreeMap;
use std::fmt;

use num_traits::{One as _, Signed as _, Zero as _};

use crate::decimal::exact_decimal;
use crate::exact::Rational;
use crate::exact::rational::to_f64;
use crate::expr::{Expr, ParseError, parse_expression};
use crate::symbol::Symbol;

/// A formula.
#[derive(Clone, Debug, PartialEq)]
pub enum Formula {
    /// A number.
    Number(Rational),
    /// The variable, or a quantity that is given beside the formula.
    Name(Symbol),
    /// A sum.
    Sum(Box<Self>, Box<Self>),
    /// A difference.
    Difference(Box<Self>, Box<Self>),
    /// A product.
    Product(Box<Self>, Box<Self>),
    /// A quotient.
    Quotient(Box<Self>, Box<Self>),
    /// A power with a number as exponent.
    Power(Box<Self>, Rational),
    /// A natural logarithm.
    Logarithm(Box<Self>),
}

/// Counts the symbols of a formula.
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::shortest::length;
///
/// assert_eq!(length("4/(1 + sqrt(c))^2"), 8);
/// assert_eq!(length("(1 - 0.125*A^2)^0.5"), 11);
/// ```
pub fn length(text: &str) -> usize {
    let (mut count, mut rest) = (0, text);
    while let Some(first) = rest.chars().next() {
        let word = |belongs: fn(char) -> bool| rest.find(|c| !belongs(c)).unwrap_or(rest.len());
        let end = match first {
            '0'..='9' | '.' => {
                let end = word(|c| c.is_ascii_digit() || c == '.');
                let digits = rest[..end].replace('.', "");
                count += digits.trim_start_matches('0').len().max(1);
                end
            }
            _ if first.is_alphabetic() => {
                count += 1;
                word(|c| c.is_alphanumeric() || c == '_')
            }
            _ => {
                count += usize::from("+-*/^".contains(first));
                first.len_utf8()
            }
        };
        rest = &rest[end..];
    }
    count
}

/// The text of a number: a decimal, or a fraction where that is shorter.
pub fn text_of_number(number: &Rational) -> String {
    let fraction = number.to_string();
    match exact_decimal(number) {
        Some(decimal) if length(&decimal) <= length(&fraction) => decimal,
        _ => fraction,
    }
}

impl Formula {
    /// A whole number.
    pub fn integer(value: i64) -> Self {
        Self::Number(Rational::from_integer(value.into()))
    }

    /// The length.
    pub fn length(&self) -> usize {
        length(&self.to_string())
    }

    /// The formula as an expression.
    ///
    /// # Errors
    /// A number without a value, such as a quotient by zero.
    pub fn expression(&self) -> Result<Expr, ParseError> {
        parse_expression(&self.to_string())
    }

    /// The formula as an expression that prints its decimals as they are written: each is a symbol.
    ///
    /// # Errors
    /// As [`expression`](Self::expression).
    pub fn written(&self) -> Result<Expr, ParseError> {
        let name = |place: usize| format!("decimal_{place}");
        let mut decimals = BTreeMap::new();
        let named = self.with_decimals(&mut |number| {
            let size = exact_decimal(&number.abs())?;
            let symbol = Symbol::new(&name(decimals.len()));
            decimals.insert(symbol, Expr::symbol(&size));
            let named = Self::Name(symbol);
            Some(match number.is_negative() {
                true => Self::Product(Self::integer(-1).into(), named.into()),
                false => named,
            })
        });
        let expression = named.expression()?;
        // A symbol for a symbol: nothing is without a value.
        Ok(expression.substitute_all(&decimals).unwrap_or(expression))
    }

    /// The formula with other formulas in place of its decimals.
    fn with_decimals(&self, change: &mut dyn FnMut(&Rational) -> Option<Self>) -> Self {
        let mut both = |left: &Self, right: &Self| {
            (Box::new(left.with_decimals(change)), Box::new(right.with_decimals(change)))
        };
        match self {
            Self::Number(number) if !number.is_integer() => {
                change(number).unwrap_or_else(|| self.clone())
            }
            Self::Number(_) | Self::Name(_) => self.clone(),
            Self::Sum(left, right) => {
                let (left, right) = both(left, right);
                Self::Sum(left, right)
            }
            Self::Difference(left, right) => {
                let (left, right) = both(left, right);
                Self::Difference(left, right)
            }
            Self::Product(left, right) => {
                let (left, right) = both(left, right);
                Self::Product(left, right)
            }
            Self::Quotient(left, right) => {
                let (left, right) = both(left, right);
                Self::Quotient(left, right)
            }
            Self::Power(base, exponent) => {
                Self::Power(base.with_decimals(change).into(), exponent.clone())
            }
            Self::Logarithm(argument) => Self::Logarithm(argument.with_decimals(change).into()),
        }
    }

    /// `self + other`, with the sign of a number in front of `other` as the sign between them.
    pub fn plus(self, other: Self) -> Self {
        match other.without_minus() {
            Some(other) => Self::Difference(self.into(), other.into()),
            None => Self::Sum(self.into(), other.into()),
        }
    }

    /// `number * self`, left out where the number is one.
    pub fn times(self, number: &Rational) -> Self {
        match &self {
            _ if number.is_one() => self,
            // 0.3/u for 0.3*(1/u), 12/u for 2*(6/u).
            Self::Quotient(numerator, divisor) => match &**numerator {
                Self::Number(own) if own.is_one() || own.is_integer() && number.is_integer() => {
                    Self::Quotient(Self::Number(own * number).into(), divisor.clone())
                }
                _ => Self::Product(Self::Number(number.clone()).into(), self.into()),
            },
            _ => Self::Product(Self::Number(number.clone()).into(), self.into()),
        }
    }

    /// A power, left out where the exponent is one.
    pub fn power(self, exponent: &Rational) -> Self {
        match exponent.is_one() {
            true => self,
            false => Self::Power(self.into(), exponent.clone()),
        }
    }

    /// The formula with the opposite sign, if it begins with a negative number.
    fn without_minus(&self) -> Option<Self> {
        match self {
            Self::Number(number) if number.is_negative() => Some(Self::Number(-number)),
            Self::Product(left, right) => match left.without_minus()? {
                Self::Number(one) if one.is_one() => Some((**right).clone()),
                left => Some(Self::Product(left.into(), right.clone())),
            },
            Self::Quotient(left, right) => {
                Some(Self::Quotient(left.without_minus()?.into(), right.clone()))
            }
            _ => None,
        }
    }

    /// The strength with which the text holds together: that of a sum, a product, a power, or a name.
    fn strength(&self) -> u8 {
        match self {
            Self::Sum(..) | Self::Difference(..) => 1,
            Self::Product(..) | Self::Quotient(..) => 2,
            Self::Number(number) if number.is_negative() => 1,
            Self::Number(number)
                if !number.is_integer() && text_of_number(number).contains('/') =>
            {
                2
            }
            Self::Power(_, exponent) if is_half(exponent) => 4,
            Self::Power(_, exponent) if exponent.is_negative() && shows_divisor(exponent) => 2,
            Self::Power(..) => 3,
            Self::Number(_) | Self::Name(_) | Self::Logarithm(_) => 4,
        }
    }

    /// Writes a part in brackets if it holds together less than is needed.
    fn write(&self, needed: u8, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.strength() < needed {
            true => write!(formatter, "({self})"),
            false => write!(formatter, "{self}"),
        }
    }
}

fn is_half(exponent: &Rational) -> bool {
    *exponent == Rational::new(1.into(), 2.into())
}

/// Whether a negative power is written as a quotient: `1/u`, `1/u^2`, `1/sqrt(u)`.
fn shows_divisor(exponent: &Rational) -> bool {
    exponent.is_integer() || is_half(&-exponent)
}

impl fmt::Display for Formula {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => formatter.write_str(&text_of_number(number)),
            Self::Name(name) => write!(formatter, "{name}"),
            Self::Sum(left, right) => {
                write!(formatter, "{left} + ")?;
                right.write(2, formatter)
            }
            Self::Difference(left, right) => {
                write!(formatter, "{left} - ")?;
                right.write(2, formatter)
            }
            Self::Product(left, right) => {
                left.write(2, formatter)?;
                formatter.write_str("*")?;
                right.write(2, formatter)
            }
            Self::Quotient(left, right) => {
                left.write(2, formatter)?;
                formatter.write_str("/")?;
                right.write(3, formatter)
            }
            Self::Power(base, exponent) if is_half(exponent) => write!(formatter, "sqrt({base})"),
            Self::Power(base, exponent) if exponent.is_negative() && shows_divisor(exponent) => {
                formatter.write_str("1/")?;
                base.clone().power(&-exponent).write(3, formatter)
            }
            Self::Power(base, exponent) => {
                base.write(4, formatter)?;
                let text = text_of_number(exponent);
                match text.contains(['/', '-']) {
                    true => write!(formatter, "^({text})"),
                    false => write!(formatter, "^{text}"),
                }
            }
            Self::Logarithm(argument) => write!(formatter, "log({argument})"),
        }
    }
}

impl Formula {
    /// The values at so many places, with those of the names.
    pub fn values(&self, names: &dyn Fn(Symbol) -> Vec<f64>, count: usize) -> Vec<f64> {
        let both = |left: &Self, right: &Self, operation: fn(f64, f64) -> f64| {
            let mut values = left.values(names, count);
            let others = right.values(names, count);
            values.iter_mut().zip(others).for_each(|(own, other)| *own = operation(*own, other));
            values
        };
        let each = |part: &Self, operation: &dyn Fn(f64) -> f64| {
            let mut values = part.values(names, count);
            values.iter_mut().for_each(|own| *own = operation(*own));
            values
        };
        match self {
            Self::Number(number) => vec![to_f64(number); count],
            Self::Name(name) => names(*name),
            Self::Sum(left, right) => both(left, right, |a, b| a + b),
            Self::Difference(left, right) => both(left, right, |a, b| a - b),
            Self::Product(left, right) => both(left, right, |a, b| a * b),
            Self::Quotient(left, right) => both(left, right, |a, b| a / b),
            Self::Power(base, exponent) if exponent.is_zero() => {
                each(base, &|base| base * 0.0 + 1.0)
            }
            Self::Power(base, exponent) => {
                let exponent = to_f64(exponent);
                each(base, &|base| base.powf(exponent))
            }
            Self::Logarithm(argument) => each(argument, &f64::ln),
        }
    }
}
