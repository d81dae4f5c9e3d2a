//! Exact Taylor expansion of an expression, in one or several variables, about a rational point.
//!
//! Reference: A. Griewank and A. Walther, *Evaluating Derivatives*, 2nd ed., SIAM 2008, section 13.2 (propagation of Taylor
//! coefficients). With `u = u_0 + u_1 s + u_2 s^2 + ...` along the line `x = point + s * (deviation)`:
//!
//! ```text
//! w = u v        w_k = sum_j u_j v_(k-j)
//! w = u^r        k u_0 w_k = sum_(j=1..k) ((r + 1) j - k) u_j w_(k-j)
//! w = exp u      k w_k = sum_(j=1..k) j u_j w_(k-j)
//! s, c = sin u, cos u     k s_k = sum j u_j c_(k-j),  k c_k = - sum j u_j s_(k-j)
//! w = F(u)       w' = F'(u) u'      for log, asin, acos, atan, whose derivative is algebraic
//! ```
//!
//! Each function costs `O(degree^2)` products of coefficients. Coefficients are expressions, so `sin(1/2)`, `sqrt(k)` or
//! `exp(eps)` stay what they are.

use num_traits::{One, Signed, ToPrimitive, Zero};

use crate::exact::Rational;
use crate::expr::{Expr, ExprError, Function, Node};
use crate::symbol::Symbol;

/// The highest degree that is expanded.
pub const HIGHEST_DEGREE: u32 = 4000;

/// Why there is no expansion.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TaylorError {
    /// The function is not analytic at the point, or its analyticity there cannot be decided.
    #[error("`{term}` has no Taylor series about {point}")]
    NotAnalytic {
        /// The term that is to blame.
        term: String,
        /// `x = 0`, say.
        point: String,
    },
    /// The degree is above [`HIGHEST_DEGREE`].
    #[error("a Taylor expansion of degree {0} is above the limit of {HIGHEST_DEGREE}")]
    Degree(u32),
    /// A coefficient could not be formed.
    #[error(transparent)]
    Expression(#[from] ExprError),
}

/// The Taylor expansion of `expression` about `point` up to total degree `degree`.
///
/// Entry `k` of the result is the part that is homogeneous of degree `k` in the deviations from the point, written with the
/// variables' own names: about `x = 0`, entry 3 of `sin(x)` is `-x^3/6`; about `x = 1`, entry 1 of `x^2` is `2*x`, where `x` now
/// stands for the deviation `x - 1`.
///
/// # Errors
/// A term that is not analytic at the point, a degree above the limit, or a coefficient that does not exist.
///
/// ```
/// use lindstedt::{expr::parse_expression, series::taylor::taylor};
/// let force = parse_expression("sin(x)").unwrap();
/// let parts = taylor(&force, &[("x".into(), num_traits::Zero::zero())], 5).unwrap();
/// assert_eq!(parts[3].to_string(), "-x^3/6");
/// assert!(parts[4].is_zero());
/// ```
pub fn taylor(expression: &Expr, point: &[(Symbol, Rational)], degree: u32) -> Result<Vec<Expr>, TaylorError> {
    if degree > HIGHEST_DEGREE {
        return Err(TaylorError::Degree(degree));
    }
    let expansion = Expansion {
        point,
        length: degree as usize + 1,
    };
    let mut parts = expansion.of(expression)?;
    if let [(variable, _)] = point {
        for (power, part) in (0_i64..).zip(&mut parts) {
            *part = &*part * &Expr::integer_power(&Expr::from(*variable), power)?;
        }
    }
    Ok(parts)
}

/// The Maclaurin coefficient of `u^k` (NIST Digital Library of Mathematical Functions 10.2.2, 10.25.2 and 19.5.1).
fn special_coefficient(function: Function, k: usize) -> Expr {
    let fraction = |top: Rational, bottom: Rational| Expr::number(top / bottom);
    let factorial = |n: usize| Rational::from_integer(crate::exact::rational::factorial(n as u32));
    let quarter = |sign: i64, n: usize| num_traits::pow(crate::exact::rational::ratio(sign, 4), n);
    let (half, odd) = (k / 2, k % 2 == 1);
    match function {
        Function::BesselJ0 | Function::BesselI0 if !odd => {
            let sign = if function == Function::BesselJ0 { -1 } else { 1 };
            fraction(quarter(sign, half), num_traits::pow(factorial(half), 2))
        }
        Function::BesselJ1 | Function::BesselI1 if odd => {
            let sign = if function == Function::BesselJ1 { -1 } else { 1 };
            fraction(quarter(sign, half), factorial(half) * factorial(half + 1) * integer(2))
        }
        Function::EllipticK => {
            let choose = factorial(2 * k) / num_traits::pow(factorial(k), 2);
            Expr::number(choose.clone() * choose * num_traits::pow(quarter(1, k), 2))
                * Expr::pi()
                * Expr::number(crate::exact::rational::ratio(1, 2))
        }
        _ => Expr::zero(),
    }
}

/// A truncated power series in `s`; as many entries as the expansion is long.
type Series = Vec<Expr>;

struct Expansion<'a> {
    point: &'a [(Symbol, Rational)],
    length: usize,
}

impl Expansion<'_> {
    fn of(&self, expression: &Expr) -> Result<Series, TaylorError> {
        expression.fold(|node, children: &[Series]| self.node(node, children))
    }

    /// The series of one node from the series of its children.
    fn node(&self, expression: &Expr, children: &[Series]) -> Result<Series, TaylorError> {
        if children.iter().all(|child| child[1..].iter().all(Expr::is_zero)) && expression.as_symbol().is_none() {
            let constants: Vec<Expr> = children.iter().map(|child| child[0].clone()).collect();
            // sgn(0) has a value, but no series goes through it.
            if !self.depends_on_variables(expression) || !matches!(expression.node(), Node::Function(..)) {
                return Ok(self.constant(expression.with_children(&constants)?));
            }
        }
        match (expression.node(), children) {
            (Node::Symbol(symbol), _) => Ok(self.variable(*symbol, expression)),
            (Node::Sum(_), terms) => {
                let column = |k: usize| Expr::sum(terms.iter().map(|term| term[k].clone()));
                Ok((0..self.length).map(column).collect())
            }
            (Node::Product(coefficient, _), factors) => {
                let start = self.constant(Expr::number(coefficient.clone()));
                factors
                    .iter()
                    .try_fold(start, |product, factor| self.product(&product, factor))
            }
            (Node::Power(_, exponent), [base, exponents]) => match exponent.as_number() {
                Some(exponent) => self.power(base, exponent, expression),
                None => self.exponential(&self.product(exponents, &self.logarithm(base, expression)?)?),
            },
            (Node::Function(function, _), arguments) => self.function(*function, arguments, expression),
            (Node::Number(_) | Node::Pi | Node::Power(..), _) => Ok(self.constant(expression.clone())),
        }
    }

    fn depends_on_variables(&self, expression: &Expr) -> bool {
        self.point.iter().any(|(variable, _)| expression.contains(*variable))
    }

    fn constant(&self, value: Expr) -> Series {
        let mut series = vec![Expr::zero(); self.length];
        series[0] = value;
        series
    }

    fn variable(&self, symbol: Symbol, itself: &Expr) -> Series {
        match self.point.iter().find(|(variable, _)| *variable == symbol) {
            None => self.constant(itself.clone()),
            Some((_, centre)) => {
                let mut series = self.constant(Expr::number(centre.clone()));
                // One variable alone is put back at the end: until then `sqrt(x^4)` is the square root of a number.
                if let Some(first) = series.get_mut(1) {
                    *first = if self.point.len() == 1 {
                        Expr::one()
                    } else {
                        itself.clone()
                    };
                }
                series
            }
        }
    }

    fn product(&self, left: &Series, right: &Series) -> Result<Series, TaylorError> {
        (0..self.length)
            .map(|k| convolution(left, right, k, |_| Rational::one()))
            .collect()
    }

    fn times(&self, series: &Series, factor: &Expr) -> Result<Series, TaylorError> {
        self.product(series, &self.constant(factor.clone()))
    }

    /// `w' = g u'` with the constant of integration given.
    fn integral(&self, start: Expr, derivative: &Series, of: &Series) -> Result<Series, TaylorError> {
        let mut series = vec![start];
        for k in 1..self.length {
            let sum = convolution(&of[1..=k].to_vec(), &derivative[..k].to_vec(), k - 1, |j| {
                integer(j + 1)
            })?;
            series.push(Expr::divide(&sum, &number(k))?);
        }
        Ok(series)
    }

    fn power(&self, base: &Series, exponent: &Rational, term: &Expr) -> Result<Series, TaylorError> {
        let Some(lowest) = base.iter().position(|coefficient| !coefficient.is_zero()) else {
            // Zero to all orders kept: a positive power of it is zero as well, anything else does not exist.
            return if exponent.is_positive() && exponent.is_integer() {
                Ok(self.constant(Expr::zero()))
            } else {
                Err(self.not_analytic(term))
            };
        };
        let shift = Rational::from_integer(lowest.into()) * exponent;
        // (s^m)^(p/q) with q even is |s|^(m p/q): analytic only where m p/q is an even whole number.
        let even_root = !exponent.denom().bit(0);
        let whole = shift.is_integer() && !shift.is_negative();
        if lowest > 0 && (!whole || (even_root && shift.numer().bit(0))) {
            return Err(self.not_analytic(term));
        }
        if even_root && sign_of(&base[lowest]) == Some(std::cmp::Ordering::Less) {
            return Err(self.not_analytic(term));
        }
        let shift = shift.to_usize().unwrap_or(usize::MAX);
        let mut result = vec![Expr::zero(); self.length.min(shift)];
        if shift >= self.length {
            return Ok(result);
        }
        let reduced = &base[lowest..];
        let mut powers = vec![Expr::power(&reduced[0], &Expr::number(exponent.clone()))?];
        for k in 1..self.length - shift {
            let weight = |j: usize| (exponent + Rational::one()) * integer(j) - integer(k);
            let terms: Result<Vec<Expr>, TaylorError> = (1..=k)
                .filter(|&j| reduced.get(j).is_some_and(|u| !u.is_zero()) && !powers[k - j].is_zero())
                .map(|j| Ok(&(&Expr::number(weight(j)) * &reduced[j]) * &powers[k - j]))
                .collect();
            let sum = Expr::sum(terms?).expand()?;
            powers.push(Expr::divide(&sum, &(&number(k) * &reduced[0]))?.expand()?);
        }
        result.extend(powers);
        Ok(result)
    }

    fn exponential(&self, of: &Series) -> Result<Series, TaylorError> {
        let mut series = vec![Expr::function(Function::Exp, vec![of[0].clone()])?];
        for k in 1..self.length {
            let sum = convolution(&of[1..=k].to_vec(), &series, k - 1, |j| integer(j + 1))?;
            series.push(Expr::divide(&sum, &number(k))?);
        }
        Ok(series)
    }

    fn logarithm(&self, of: &Series, term: &Expr) -> Result<Series, TaylorError> {
        if of[0].is_zero() || sign_of(&of[0]) == Some(std::cmp::Ordering::Less) {
            return Err(self.not_analytic(term));
        }
        let start = Expr::function(Function::Log, vec![of[0].clone()])?;
        let reciprocal = self.power(of, &-Rational::one(), term)?;
        self.integral(start, &reciprocal, of)
    }

    /// Sine and cosine (`sign = -1`) or their hyperbolic sisters (`sign = 1`).
    fn sine_and_cosine(&self, of: &Series, hyperbolic: bool) -> Result<(Series, Series), TaylorError> {
        let (sine, cosine, sign) = if hyperbolic {
            (Function::Sinh, Function::Cosh, 1)
        } else {
            (Function::Sin, Function::Cos, -1)
        };
        let mut sines = vec![Expr::function(sine, vec![of[0].clone()])?];
        let mut cosines = vec![Expr::function(cosine, vec![of[0].clone()])?];
        for k in 1..self.length {
            let of = of[1..=k].to_vec();
            let next_sine = Expr::divide(&convolution(&of, &cosines, k - 1, |j| integer(j + 1))?, &number(k))?;
            let next_cosine = Expr::divide(
                &convolution(&of, &sines, k - 1, |j| integer(j + 1) * integer_sign(sign))?,
                &number(k),
            )?;
            sines.push(next_sine);
            cosines.push(next_cosine);
        }
        Ok((sines, cosines))
    }

    fn function(&self, function: Function, arguments: &[Series], term: &Expr) -> Result<Series, TaylorError> {
        let of = arguments.first().ok_or_else(|| self.not_analytic(term))?;
        let start = || Expr::function(function, vec![of[0].clone()]);
        match function {
            Function::Sin => Ok(self.sine_and_cosine(of, false)?.0),
            Function::Cos => Ok(self.sine_and_cosine(of, false)?.1),
            Function::Sinh => Ok(self.sine_and_cosine(of, true)?.0),
            Function::Cosh => Ok(self.sine_and_cosine(of, true)?.1),
            Function::Tan | Function::Tanh => {
                let (sine, cosine) = self.sine_and_cosine(of, function == Function::Tanh)?;
                self.product(&sine, &self.power(&cosine, &-Rational::one(), term)?)
            }
            Function::Exp => self.exponential(of),
            Function::Log => self.logarithm(of, term),
            Function::Asin | Function::Acos | Function::Atan => {
                // 1/sqrt(1 - u^2), its negative, or 1/(1 + u^2).
                let atan = function == Function::Atan;
                let square = self.times(&self.product(of, of)?, &Expr::from(if atan { 1 } else { -1 }))?;
                let mut radicand = square;
                radicand[0] = &radicand[0] + &Expr::from(1);
                let exponent = if atan {
                    -Rational::one()
                } else {
                    crate::exact::rational::ratio(-1, 2)
                };
                let mut derivative = self.power(&radicand, &exponent, term)?;
                if function == Function::Acos {
                    derivative = self.times(&derivative, &Expr::from(-1))?;
                }
                self.integral(start()?, &derivative, of)
            }
            Function::Absolute | Function::Sign | Function::Step => {
                // Away from its corner each of them is a polynomial of degree one at most.
                let sign = sign_of(&of[0])
                    .filter(|sign| sign.is_ne())
                    .ok_or_else(|| self.not_analytic(term))?;
                let positive = sign.is_gt();
                match function {
                    Function::Absolute => self.times(of, &Expr::from(if positive { 1 } else { -1 })),
                    Function::Sign => Ok(self.constant(Expr::from(if positive { 1 } else { -1 }))),
                    _ => Ok(self.constant(Expr::from(i64::from(positive)))),
                }
            }
            Function::Maximum | Function::Minimum => {
                let other = arguments.get(1).ok_or_else(|| self.not_analytic(term))?;
                let difference = &of[0] - &other[0];
                let sign = sign_of(&difference)
                    .filter(|sign| sign.is_ne())
                    .ok_or_else(|| self.not_analytic(term))?;
                Ok(if sign.is_gt() == (function == Function::Maximum) {
                    of.clone()
                } else {
                    other.clone()
                })
            }
            Function::BesselJ0 | Function::BesselJ1 | Function::BesselI0 | Function::BesselI1 | Function::EllipticK
                if of[0].is_zero() =>
            {
                self.composed(of, &|k| special_coefficient(function, k))
            }
            Function::BesselJ0
            | Function::BesselJ1
            | Function::BesselI0
            | Function::BesselI1
            | Function::EllipticK
            | Function::Gamma => Err(self.not_analytic(term)),
        }
    }

    /// `sum_k coefficient(k) u^k` of a series without constant term, by Horner's rule.
    fn composed(&self, of: &Series, coefficient: &dyn Fn(usize) -> Expr) -> Result<Series, TaylorError> {
        let mut sum = self.constant(coefficient(self.length - 1));
        for k in (0..self.length - 1).rev() {
            sum = self.product(&sum, of)?;
            sum[0] = &sum[0] + &coefficient(k);
        }
        Ok(sum)
    }

    fn not_analytic(&self, term: &Expr) -> TaylorError {
        let point: Vec<String> = self
            .point
            .iter()
            .map(|(variable, centre)| format!("{variable} = {centre}"))
            .collect();
        TaylorError::NotAnalytic {
            term: term.to_string(),
            point: point.join(", "),
        }
    }
}

/// `sum_j weight(j) left_j right_(k-j)`, expanded so that like terms meet and zeros are seen.
fn convolution(
    left: &Series,
    right: &Series,
    k: usize,
    weight: impl Fn(usize) -> Rational,
) -> Result<Expr, TaylorError> {
    let mut terms = Vec::new();
    for j in 0..=k {
        if let (Some(a), Some(b)) = (left.get(j), right.get(k - j))
            && !a.is_zero()
            && !b.is_zero()
        {
            terms.push(&(&Expr::number(weight(j)) * a) * b);
        }
    }
    Ok(Expr::sum(terms).expand()?)
}

/// The sign of a constant; `None` where it depends on symbols or is too small to tell.
fn sign_of(constant: &Expr) -> Option<std::cmp::Ordering> {
    if let Some(number) = constant.as_number() {
        return Some(number.cmp(&Rational::zero()));
    }
    let value = constant.evaluate(&[].into()).ok()?;
    (value.abs() > 1e-12).then(|| value.total_cmp(&0.0))
}

fn integer(value: usize) -> Rational {
    Rational::from_integer(value.into())
}

fn integer_sign(sign: i64) -> Rational {
    Rational::from_integer(sign.into())
}

fn number(value: usize) -> Expr {
    Expr::number(integer(value))
}
