//! The functions that an expression may use: a table with one entry for each.
//!
//! To add a function, add a variant to [`Function`] and an entry to [`TABLE`]: its name, how many
//! arguments it takes, its parity, its value as a floating-point number, its exact values, and its
//! partial derivatives. Parsing, printing, simplification, calculus and evaluation read the table;
//! Taylor coefficients are with the series.
//!
//! The last entries are special functions that occur only in answers: an equation of motion cannot
//! call them, but may use their names for parameters (`K*x`, `J0*x''`).

use num_integer::Integer as _;
use num_traits::{One, Signed, ToPrimitive, Zero};

use spec_math::cephes64;

use super::jacobi::jacobi;
use super::{Expr, ExprError, Node, normal, number, order, print};
use crate::exact::rational::{Rational, ratio};

/// A function of the table. The square root is not among them, being the power 1/2.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Function {
    /// `sin`
    Sin,
    /// `cos`
    Cos,
    /// `tan`
    Tan,
    /// `sinh`
    Sinh,
    /// `cosh`
    Cosh,
    /// `tanh`
    Tanh,
    /// `asin`, the angle from -pi/2 to pi/2
    Asin,
    /// `acos`, the angle from 0 to pi
    Acos,
    /// `atan`
    Atan,
    /// `asinh`, the inverse of `sinh`
    Asinh,
    /// `exp`
    Exp,
    /// `log`, the natural logarithm
    Log,
    /// `abs`
    Absolute,
    /// `sgn`: -1, 0 or 1, and 0 at 0
    Sign,
    /// `max` of two arguments
    Maximum,
    /// `min` of two arguments
    Minimum,
    /// `H`, the Heaviside step: 1 where the argument is positive, 0 elsewhere. H(0) = 0: a surface
    /// that is just touched exerts no force.
    Step,
    /// `J0`, the Bessel function of the first kind
    BesselJ0,
    /// `J1`, likewise; Bessel functions of higher order are written with these two
    BesselJ1,
    /// `I0`, the modified Bessel function of the first kind
    BesselI0,
    /// `I1`, likewise
    BesselI1,
    /// `Gamma`
    Gamma,
    /// `K`, the complete elliptic integral of the first kind as a function of the parameter m = k^2
    /// < 1
    EllipticK,
    /// `sn(u, m)`, the elliptic function of Jacobi with the parameter m = k^2 up to one
    JacobiSn,
    /// `cn(u, m)`, likewise
    JacobiCn,
    /// `dn(u, m)`, likewise
    JacobiDn,
}

impl Function {
    /// The functions that an equation may use, in the order of the table.
    pub fn all() -> impl Iterator<Item = Self> {
        TABLE.iter().map(|entry| entry.function).filter(|function| !function.is_special())
    }

    /// The function of this name that an equation may use.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::all().find(|function| function.name() == name)
    }

    /// The function of this name, special ones included.
    pub fn from_name_in_answers(name: &str) -> Option<Self> {
        TABLE.iter().find(|entry| entry.name == name).map(|entry| entry.function)
    }

    /// Whether the function occurs only in answers.
    pub fn is_special(self) -> bool {
        self as usize > Self::Step as usize
    }

    /// Whether the function has a corner or a jump: `abs`, `sgn`, `H`, `max` and `min`.
    pub fn has_corner(self) -> bool {
        matches!(self, Self::Absolute | Self::Sign | Self::Step | Self::Maximum | Self::Minimum)
    }

    /// The name as it is read and printed.
    pub fn name(self) -> &'static str {
        self.entry().name
    }

    /// Number of arguments: 1 or 2.
    pub fn argument_count(self) -> usize {
        match self.entry().value {
            Value::One(_) => 1,
            Value::Two(_) => 2,
        }
    }

    /// The value as a floating-point number; NaN where there is none, or where an argument is NaN.
    pub fn value(self, first: f64, second: f64) -> f64 {
        match self.entry().value {
            Value::One(value) => value(first),
            Value::Two(value) => value(first, second),
        }
    }

    /// The partial derivative by the argument of this index (0 or 1), at these arguments. The jumps
    /// of `sgn` and `H` and the kinks of `abs`, `max` and `min` are left out: the derivative is
    /// that of the smooth pieces.
    ///
    /// # Errors
    /// The derivative has no value at these arguments.
    pub fn derivative(self, arguments: &[Expr], index: usize) -> Result<Expr, ExprError> {
        match arguments {
            [only] if self.argument_count() == 1 => (self.entry().derivative)(only, only, index),
            [first, second] if self.argument_count() == 2 => {
                (self.entry().derivative)(first, second, index)
            }
            _ => Err(self.wrong_arguments(arguments.len())),
        }
    }

    /// The expression `self(arguments)` in normal form.
    pub(super) fn apply(self, mut arguments: Vec<Expr>) -> Result<Expr, ExprError> {
        let entry = self.entry();
        if arguments.len() != self.argument_count() {
            return Err(self.wrong_arguments(arguments.len()));
        }
        if let [first, ..] = arguments.as_slice() {
            let exact =
                (entry.exact)(first, arguments.get(1).unwrap_or(first)).map_err(|NoValue| {
                    ExprError::Undefined(print::call_in_message(self, &arguments))
                })?;
            if let Some(exact) = exact {
                return Ok(exact);
            }
            if matches!(entry.parity, Parity::Even | Parity::Odd) && first.has_leading_minus() {
                let turned = std::iter::once(-first).chain(arguments.iter().skip(1).cloned());
                let positive = self.apply(turned.collect())?;
                return Ok(if entry.parity == Parity::Odd { -positive } else { positive });
            }
        }
        if entry.parity == Parity::Symmetric {
            arguments.sort_by(order::compare_factors);
        }
        Ok(Expr::from_node(Node::Function(self, arguments)))
    }

    /// The floating-point function itself, for programs that call it often.
    pub(super) fn value_function(self) -> Value {
        self.entry().value
    }

    fn wrong_arguments(self, given: usize) -> ExprError {
        ExprError::WrongArguments { function: self.name(), expected: self.argument_count(), given }
    }

    fn entry(self) -> &'static FunctionDefinition {
        &TABLE[self as usize]
    }
}

/// The properties of one function.
struct FunctionDefinition {
    function: Function,
    name: &'static str,
    parity: Parity,
    value: Value,
    /// The exact value at these arguments: `None` if the function is kept, [`NoValue`] if it has no
    /// real value. A function of one argument gets it twice.
    exact: fn(&Expr, &Expr) -> Result<Option<Expr>, NoValue>,
    /// The partial derivative by the argument of the index. A function of one argument gets it
    /// twice.
    derivative: fn(&Expr, &Expr, usize) -> Result<Expr, ExprError>,
}

#[derive(Clone, Copy)]
pub(super) enum Value {
    One(fn(f64) -> f64),
    Two(fn(f64, f64) -> f64),
}

#[derive(PartialEq)]
enum Parity {
    /// f(-u) = f(u), also with a second argument
    Even,
    /// f(-u) = -f(u), likewise
    Odd,
    /// f(u, v) = f(v, u)
    Symmetric,
    None,
}

/// The function has no real value at this argument.
struct NoValue;

use Function::{
    Absolute, Acos, Asin, Asinh, Atan, Cos, Cosh, Exp, Log, Maximum, Minimum, Sign, Sin, Sinh,
    Step, Tan, Tanh,
};
use Function::{
    BesselI0, BesselI1, BesselJ0, BesselJ1, EllipticK, Gamma, JacobiCn, JacobiDn, JacobiSn,
};
use Value::{One as Unary, Two as Binary};

/// The entries stand in the order of the variants of [`Function`].
static TABLE: [FunctionDefinition; 26] = [
    FunctionDefinition {
        function: Sin,
        name: "sin",
        parity: Parity::Odd,
        value: Unary(f64::sin),
        exact: |u, _| Ok(quarter_turns(u).map(|turns| Expr::from([0, 1, 0, -1][turns]))),
        derivative: |u, _, _| call(Cos, u),
    },
    FunctionDefinition {
        function: Cos,
        name: "cos",
        parity: Parity::Even,
        value: Unary(f64::cos),
        exact: |u, _| Ok(quarter_turns(u).map(|turns| Expr::from([1, 0, -1, 0][turns]))),
        derivative: |u, _, _| Ok(-call(Sin, u)?),
    },
    FunctionDefinition {
        function: Tan,
        name: "tan",
        parity: Parity::Odd,
        value: Unary(f64::tan),
        exact: |u, _| match quarter_turns(u) {
            Some(turns) if turns % 2 == 1 => Err(NoValue),
            turns => Ok(turns.map(|_| Expr::zero())),
        },
        derivative: |u, _, _| Ok(Expr::one() + call(Tan, u)?.integer_power(2)?),
    },
    FunctionDefinition {
        function: Sinh,
        name: "sinh",
        parity: Parity::Odd,
        value: Unary(f64::sinh),
        exact: |u, _| Ok(value_if_equal(u, 0, Expr::zero)),
        derivative: |u, _, _| call(Cosh, u),
    },
    FunctionDefinition {
        function: Cosh,
        name: "cosh",
        parity: Parity::Even,
        value: Unary(f64::cosh),
        exact: |u, _| Ok(value_if_equal(u, 0, Expr::one)),
        derivative: |u, _, _| call(Sinh, u),
    },
    FunctionDefinition {
        function: Tanh,
        name: "tanh",
        parity: Parity::Odd,
        value: Unary(f64::tanh),
        exact: |u, _| Ok(value_if_equal(u, 0, Expr::zero)),
        derivative: |u, _, _| call(Cosh, u)?.integer_power(-2),
    },
    FunctionDefinition {
        function: Asin,
        name: "asin",
        parity: Parity::Odd,
        value: Unary(f64::asin),
        exact: |u, _| match u.as_number() {
            Some(number) if beyond_one(number) => Err(NoValue),
            _ => {
                Ok(value_if_equal(u, 0, Expr::zero).or_else(|| value_if_equal(u, 1, || turn(1, 2))))
            }
        },
        derivative: |u, _, _| {
            Expr::divide(&Expr::one(), &(Expr::one() - u.integer_power(2)?).sqrt()?)
        },
    },
    FunctionDefinition {
        function: Acos,
        name: "acos",
        parity: Parity::None,
        value: Unary(f64::acos),
        exact: |u, _| match u.as_number() {
            Some(number) if beyond_one(number) => Err(NoValue),
            _ => Ok(value_if_equal(u, 1, Expr::zero)
                .or_else(|| value_if_equal(u, 0, || turn(1, 2)))
                .or_else(|| value_if_equal(u, -1, Expr::pi))),
        },
        derivative: |u, _, _| {
            Expr::divide(&Expr::from(-1), &(Expr::one() - u.integer_power(2)?).sqrt()?)
        },
    },
    FunctionDefinition {
        function: Atan,
        name: "atan",
        parity: Parity::Odd,
        value: Unary(f64::atan),
        exact: |u, _| {
            Ok(value_if_equal(u, 0, Expr::zero).or_else(|| value_if_equal(u, 1, || turn(1, 4))))
        },
        derivative: |u, _, _| Expr::divide(&Expr::one(), &(Expr::one() + u.integer_power(2)?)),
    },
    FunctionDefinition {
        function: Asinh,
        name: "asinh",
        parity: Parity::Odd,
        value: Unary(f64::asinh),
        exact: |u, _| Ok(value_if_equal(u, 0, Expr::zero)),
        derivative: |u, _, _| {
            Expr::divide(&Expr::one(), &(Expr::one() + u.integer_power(2)?).sqrt()?)
        },
    },
    FunctionDefinition {
        function: Exp,
        name: "exp",
        parity: Parity::None,
        value: Unary(f64::exp),
        exact: |u, _| Ok(value_if_equal(u, 0, Expr::one)),
        derivative: |u, _, _| call(Exp, u),
    },
    FunctionDefinition {
        function: Log,
        name: "log",
        parity: Parity::None,
        value: Unary(f64::ln),
        exact: |u, _| match u.as_number() {
            Some(number) if !number.is_positive() => Err(NoValue),
            _ => Ok(value_if_equal(u, 1, Expr::zero)),
        },
        derivative: |u, _, _| Expr::divide(&Expr::one(), u),
    },
    FunctionDefinition {
        function: Absolute,
        name: "abs",
        parity: Parity::Even,
        value: Unary(f64::abs),
        exact: |u, _| Ok(u.as_number().map(|number| Expr::number(number.abs()))),
        derivative: |u, _, _| call(Sign, u),
    },
    FunctionDefinition {
        function: Sign,
        name: "sgn",
        parity: Parity::Odd,
        value: Unary(sign),
        exact: |u, _| Ok(u.as_number().map(|number| Expr::number(number.signum()))),
        derivative: |_, _, _| Ok(Expr::zero()),
    },
    FunctionDefinition {
        function: Maximum,
        name: "max",
        parity: Parity::Symmetric,
        value: Binary(|u, v| if u.is_nan() || v.is_nan() { f64::NAN } else { u.max(v) }),
        exact: |u, v| Ok(extreme(u, v, std::cmp::Ordering::Greater)),
        derivative: |u, v, index| match index {
            0 => call(Step, &(u - v)),
            _ => Ok(Expr::one() - call(Step, &(u - v))?),
        },
    },
    FunctionDefinition {
        function: Minimum,
        name: "min",
        parity: Parity::Symmetric,
        value: Binary(|u, v| if u.is_nan() || v.is_nan() { f64::NAN } else { u.min(v) }),
        exact: |u, v| Ok(extreme(u, v, std::cmp::Ordering::Less)),
        derivative: |u, v, index| match index {
            0 => Ok(Expr::one() - call(Step, &(u - v))?),
            _ => call(Step, &(u - v)),
        },
    },
    FunctionDefinition {
        function: Step,
        name: "H",
        parity: Parity::None,
        value: Unary(step),
        exact: |u, _| Ok(u.as_number().map(|number| Expr::from(i64::from(number.is_positive())))),
        derivative: |_, _, _| Ok(Expr::zero()),
    },
    // NIST Digital Library of Mathematical Functions 10.6 and 10.29: J0' = -J1, J1' = J0 - J1/u,
    // I0' = I1, I1' = I0 - I1/u.
    FunctionDefinition {
        function: BesselJ0,
        name: "J0",
        parity: Parity::Even,
        value: Unary(cephes64::j0),
        exact: |u, _| Ok(value_if_equal(u, 0, Expr::one)),
        derivative: |u, _, _| Ok(-call(BesselJ1, u)?),
    },
    FunctionDefinition {
        function: BesselJ1,
        name: "J1",
        parity: Parity::Odd,
        value: Unary(cephes64::j1),
        exact: |u, _| Ok(value_if_equal(u, 0, Expr::zero)),
        derivative: |u, _, _| Ok(call(BesselJ0, u)? - Expr::divide(&call(BesselJ1, u)?, u)?),
    },
    FunctionDefinition {
        function: BesselI0,
        name: "I0",
        parity: Parity::Even,
        value: Unary(cephes64::i0),
        exact: |u, _| Ok(value_if_equal(u, 0, Expr::one)),
        derivative: |u, _, _| call(BesselI1, u),
    },
    FunctionDefinition {
        function: BesselI1,
        name: "I1",
        parity: Parity::Odd,
        value: Unary(cephes64::i1),
        exact: |u, _| Ok(value_if_equal(u, 0, Expr::zero)),
        derivative: |u, _, _| Ok(call(BesselI0, u)? - Expr::divide(&call(BesselI1, u)?, u)?),
    },
    FunctionDefinition {
        function: Gamma,
        name: "Gamma",
        parity: Parity::None,
        value: Unary(gamma),
        exact: |u, _| match u.as_number() {
            Some(number) if number.is_integer() && !number.is_positive() => Err(NoValue),
            Some(number) => Ok(gamma_of_halves(number)),
            None => Ok(None),
        },
        derivative: |u, _, _| {
            Err(ExprError::Undefined(print::call_in_message(Gamma, std::slice::from_ref(u))))
        },
    },
    FunctionDefinition {
        function: EllipticK,
        name: "K",
        parity: Parity::None,
        value: Unary(elliptic_k),
        exact: |u, _| match u.as_number() {
            Some(number) if *number >= Rational::one() => Err(NoValue),
            _ => Ok(value_if_equal(u, 0, || turn(1, 2))),
        },
        derivative: |u, _, _| {
            Err(ExprError::Undefined(print::call_in_message(EllipticK, std::slice::from_ref(u))))
        },
    },
    // NIST Digital Library of Mathematical Functions 22.13: sn' = cn dn, cn' = -sn dn, dn' = -m sn
    // cn.
    FunctionDefinition {
        function: JacobiSn,
        name: "sn",
        parity: Parity::Odd,
        value: Binary(|u, m| jacobi(u, m)[0]),
        exact: |u, m| limit_of_jacobi(u, m, Expr::zero, Sin),
        derivative: |u, m, index| match index {
            0 => Ok(elliptic(JacobiCn, u, m)? * elliptic(JacobiDn, u, m)?),
            _ => Err(no_slope(JacobiSn, u, m)),
        },
    },
    FunctionDefinition {
        function: JacobiCn,
        name: "cn",
        parity: Parity::Even,
        value: Binary(|u, m| jacobi(u, m)[1]),
        exact: |u, m| limit_of_jacobi(u, m, Expr::one, Cos),
        derivative: |u, m, index| match index {
            0 => Ok(-(elliptic(JacobiSn, u, m)? * elliptic(JacobiDn, u, m)?)),
            _ => Err(no_slope(JacobiCn, u, m)),
        },
    },
    FunctionDefinition {
        function: JacobiDn,
        name: "dn",
        parity: Parity::Even,
        value: Binary(|u, m| jacobi(u, m)[2]),
        exact: |u, m| match m.as_number() {
            Some(number) if *number > Rational::one() => Err(NoValue),
            _ => Ok(value_if_equal(u, 0, Expr::one).or_else(|| value_if_equal(m, 0, Expr::one))),
        },
        derivative: |u, m, index| match index {
            0 => Ok(-(m * &(elliptic(JacobiSn, u, m)? * elliptic(JacobiCn, u, m)?))),
            _ => Err(no_slope(JacobiDn, u, m)),
        },
    },
];

fn elliptic(function: Function, u: &Expr, m: &Expr) -> Result<Expr, ExprError> {
    function.apply(vec![u.clone(), m.clone()])
}

/// The error for the derivative of an elliptic function by its parameter, which the table does not
/// have.
fn no_slope(function: Function, u: &Expr, m: &Expr) -> ExprError {
    ExprError::Undefined(print::call_in_message(function, &[u.clone(), m.clone()]))
}

/// Returns the value of an elliptic function at zero, or with the parameter zero, for which it is a
/// circular function; `None` elsewhere.
fn limit_of_jacobi(
    u: &Expr,
    m: &Expr,
    at_zero: fn() -> Expr,
    circular: Function,
) -> Result<Option<Expr>, NoValue> {
    match m.as_number() {
        Some(number) if *number > Rational::one() => Err(NoValue),
        Some(number) if number.is_zero() => call(circular, u).map(Some).map_err(|_| NoValue),
        _ => Ok(value_if_equal(u, 0, at_zero)),
    }
}

/// Gamma, NaN at its poles.
fn gamma(u: f64) -> f64 {
    if u <= 0.0 && u == u.floor() { f64::NAN } else { cephes64::gamma(u) }
}

/// Gamma(n) = (n-1)! and Gamma(n + 1/2) = (n-1/2)(n-3/2)...(1/2) sqrt(pi), for n below 30.
fn gamma_of_halves(u: &Rational) -> Option<Expr> {
    const LARGEST: i64 = 30;
    if !(u * ratio(2, 1)).is_integer() || !u.is_positive() || *u > ratio(LARGEST, 1) {
        return None;
    }
    let half = ratio(1, 2);
    let (mut factor, mut left) = (Rational::one(), u.clone());
    while left > Rational::one() {
        left -= Rational::one();
        factor *= &left;
    }
    let start = if left == half { Expr::pi().sqrt().ok()? } else { Expr::one() };
    Some(&Expr::number(factor) * &start)
}

/// K(m) for every m < 1, below zero by K(m) = K(m/(m - 1))/sqrt(1 - m) (NIST Digital Library of
/// Mathematical Functions 19.7.2).
fn elliptic_k(m: f64) -> f64 {
    if m >= 1.0 || m.is_nan() {
        f64::NAN
    } else if m < 0.0 {
        cephes64::ellpk(1.0 / (1.0 - m)) / (1.0 - m).sqrt()
    } else {
        cephes64::ellpk(1.0 - m)
    }
}

fn call(function: Function, argument: &Expr) -> Result<Expr, ExprError> {
    function.apply(vec![argument.clone()])
}

/// The value, if the argument is exactly this number.
fn value_if_equal(argument: &Expr, point: i64, value: impl FnOnce() -> Expr) -> Option<Expr> {
    let number = argument.as_number()?;
    (number.is_integer() && *number.numer() == point.into()).then(value)
}

/// Returns `numerator/denominator * pi`.
fn turn(numerator: i64, denominator: i64) -> Expr {
    normal::scaled_product(ratio(numerator, denominator), &[Expr::pi()])
}

/// Returns the argument in units of pi/2, modulo 4; `None` if it is not a whole number of them.
fn quarter_turns(argument: &Expr) -> Option<usize> {
    let multiple = match (argument.as_number(), argument.factors()) {
        (Some(number), _) if number.is_zero() => Rational::zero(),
        (None, (coefficient, [factor])) if matches!(factor.node(), Node::Pi) => coefficient,
        _ => return None,
    };
    let turns = multiple * ratio(2, 1);
    turns.is_integer().then(|| turns.to_integer().mod_floor(&4.into()).to_usize())?
}

fn beyond_one(number: &Rational) -> bool {
    number::compare(&number.abs(), &Rational::one()).is_gt()
}

fn extreme(u: &Expr, v: &Expr, wanted: std::cmp::Ordering) -> Option<Expr> {
    if u == v {
        return Some(u.clone());
    }
    let order = number::compare(u.as_number()?, v.as_number()?);
    Some(if order == wanted { u.clone() } else { v.clone() })
}

fn sign(u: f64) -> f64 {
    if u == 0.0 { 0.0 } else { u.signum() }
}

fn step(u: f64) -> f64 {
    if u.is_nan() {
        u
    } else if u > 0.0 {
        1.0
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::symbol::Symbol;
    use std::collections::BTreeMap;

    #[test]
    fn the_table_stands_in_the_order_of_the_variants() {
        for (place, entry) in TABLE.iter().enumerate() {
            assert_eq!(entry.function as usize, place);
            assert_eq!(Function::from_name_in_answers(entry.name), Some(entry.function));
            assert_eq!(Function::from_name(entry.name).is_none(), entry.function.is_special());
        }
    }

    /// Special functions agree with their integrals (NIST Digital Library of Mathematical Functions
    /// 10.9.2, 10.32.3, 5.9.1, 19.2.8), which share nothing with the library.
    #[test]
    fn special_functions_are_their_integrals() {
        use lindstedt_numeric::numeric::ode::quadrature::integrate_smooth;
        use std::f64::consts::PI;
        let integral =
            |f: &dyn Fn(f64) -> f64, to: f64| integrate_smooth(f, 0.0, to, 1e-14).unwrap().0;
        for u in [0.1, 0.7, 1.5, 3.0, 7.0] {
            for (function, value) in [
                (BesselJ0, integral(&|t| (u * t.sin()).cos(), PI) / PI),
                (BesselJ1, integral(&|t| (t - u * t.sin()).cos(), PI) / PI),
                (BesselI0, integral(&|t| (u * t.cos()).exp(), PI) / PI),
                (BesselI1, integral(&|t| (u * t.cos()).exp() * t.cos(), PI) / PI),
                // t = s^8 leaves a smooth integrand for every u > 1/8.
                (
                    Gamma,
                    integral(&|s| 8.0 * s.powf(8.0 * (u + 0.2) - 1.0) * (-s.powi(8)).exp(), 1.8),
                ),
            ] {
                let u = if function == Gamma { u + 0.2 } else { u };
                let found = function.value(u, 0.0);
                assert!(
                    (found - value).abs() < 3e-14 * (1.0 + value.abs()),
                    "{function:?}({u}) {found} {value}"
                );
            }
        }
        for m in [-50.0, -1.0, -0.3, 0.0, 0.4, 0.9, 0.999] {
            let value = integral(&|t| (1.0 - m * t.sin().powi(2)).sqrt().recip(), 0.5 * PI);
            assert!((EllipticK.value(m, 0.0) / value - 1.0).abs() < 1e-13, "K({m})");
        }
        assert_eq!(
            Expr::function(Gamma, vec![Expr::number(ratio(5, 2))]).unwrap().to_string(),
            "3*sqrt(pi)/4"
        );
    }

    /// Simplified values must agree with numerical ones.
    #[test]
    fn exact_values_agree_with_the_numbers() {
        let points = ["0", "1", "-1", "1/2", "-2", "pi", "pi/2", "-3*pi/2", "2*pi", "5*pi/2"];
        for function in Function::all() {
            for first in points {
                for second in ["0", "-2", "pi"] {
                    let [first, second]: [Expr; 2] =
                        [first, second].map(|text| text.parse().unwrap());
                    let values =
                        [&first, &second].map(|point| point.evaluate(&BTreeMap::new()).unwrap());
                    let arguments = [first, second][..function.argument_count()].to_vec();
                    let expected = function.value(values[0], values[1]);
                    match function.apply(arguments.clone()) {
                        Ok(exact) if exact.symbols().is_empty() => {
                            let value = exact.evaluate(&BTreeMap::new()).unwrap_or(f64::NAN);
                            let close = (value - expected).abs() < 1e-14 * (1.0 + expected.abs());
                            assert!(
                                close || value.is_nan() && expected.is_nan(),
                                "{exact:?} at {arguments:?}"
                            );
                        }
                        Ok(other) => panic!("{other} has symbols"),
                        Err(_) => assert!(
                            !expected.is_finite() || expected.abs() > 1e15,
                            "{function:?}{arguments:?}"
                        ),
                    }
                }
            }
        }
    }

    #[test]
    fn nothing_becomes_a_number_by_way_of_nan() {
        for function in Function::all() {
            assert!(function.value(f64::NAN, 1.0).is_nan(), "{function:?}");
            assert!(
                function.argument_count() == 1 || function.value(1.0, f64::NAN).is_nan(),
                "{function:?}"
            );
        }
    }

    #[test]
    fn parity_agrees_with_the_numbers() {
        for entry in &TABLE {
            let [plus, minus] = [0.3, -0.3].map(|u| entry.function.value(u, 0.7));
            match entry.parity {
                Parity::Even => assert_eq!(plus, minus, "{}", entry.name),
                Parity::Odd => assert_eq!(plus, -minus, "{}", entry.name),
                Parity::Symmetric => {
                    assert_eq!(plus, entry.function.value(0.7, 0.3), "{}", entry.name)
                }
                Parity::None => assert_ne!(plus.abs(), minus.abs(), "{}", entry.name),
            }
        }
    }

    #[test]
    fn the_number_of_arguments_is_checked() {
        let x = Expr::from(Symbol::new("x"));
        let error = Expr::function(Sin, vec![x.clone(), x.clone()]).unwrap_err();
        assert_eq!(error.to_string(), "`sin` takes 1 argument, not 2");
        assert_eq!(
            Expr::function(Maximum, vec![x]).unwrap_err().to_string(),
            "`max` takes 2 arguments, not 1"
        );
    }
}
