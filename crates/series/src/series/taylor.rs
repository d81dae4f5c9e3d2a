//! Exact Taylor expansion of an expression, in one or several variables, about a rational point.
//!
//! Reference: A. Griewank and A. Walther, *Evaluating Derivatives*, 2nd ed., SIAM 2008, section
//! 13.2 (propagation of Taylor coefficients). With `u = u_0 + u_1 s + u_2 s^2 + ...` along the line
//! `x = point + s * (deviation)`:
//!
//! ```text
//! w = u v        w_k = sum_j u_j v_(k-j)
//! w = u^r        k u_0 w_k = sum_(j=1..k) ((r + 1) j - k) u_j w_(k-j)
//! w = exp u      k w_k = sum_(j=1..k) j u_j w_(k-j)
//! s, c = sin u, cos u     k s_k = sum j u_j c_(k-j),  k c_k = - sum j u_j s_(k-j)
//! w = F(u)       w' = F'(u) u'      for log, asin, acos, atan, asinh, whose derivative is algebraic
//! ```
//!
//! Powers of a series that vanishes at the point are Laurent series,
//! `u^-n = s^(-m n) (u_m + u_(m+1) s + ...)^-n`, and so are sums and products of them:
//! `(1 - cos(x))/x`, whose singularity is removable, has the series of its continuous extension.
//!
//! Each function costs `O(degree^2)` products of coefficients. Coefficients are expressions, so
//! `sin(1/2)`, `sqrt(k)` or `exp(eps)` stay as they are, although no [`Ring`](crate::exact::Ring)
//! contains them. An expansion in another ring starts from the images of these coefficients, which
//! must then be fractions.

use std::cell::Cell;

use num_traits::{One, Signed, ToPrimitive, Zero};

use crate::exact::Rational;
use crate::expr::{Expr, ExprError, Function, Node, Quotation};
use crate::symbol::Symbol;

/// The highest degree that is expanded.
pub const HIGHEST_DEGREE: u32 = 4000;

/// The reason why there is no expansion.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TaylorError {
    /// The function is not analytic at the point, or its analyticity there cannot be decided.
    #[error("`{term}` has no Taylor series about {}", in_words(.point))]
    NotAnalytic {
        /// The term that has no Taylor series.
        term: Quotation,
        /// The variables and their values at the point.
        point: Vec<(Symbol, Expr)>,
    },
    /// The degree is above [`HIGHEST_DEGREE`].
    #[error("a Taylor expansion of degree {0} is above the limit of {HIGHEST_DEGREE}")]
    Degree(u32),
    /// A coefficient could not be formed.
    #[error(transparent)]
    Expression(#[from] ExprError),
}

/// Writes a point as `x = 0, x' = 0`.
fn in_words(point: &[(Symbol, Expr)]) -> String {
    let places: Vec<String> =
        point.iter().map(|(variable, centre)| format!("{variable} = {centre}")).collect();
    places.join(", ")
}

/// Returns the Taylor expansion of `expression` about `point` up to total degree `degree`.
///
/// Entry `k` of the result is the part that is homogeneous of degree `k` in the deviations from the
/// point, written with the variables' own names: about `x = 0`, entry 3 of `sin(x)` is `-x^3/6`;
/// about `x = 1`, entry 1 of `x^2` is `2*x`, where `x` now stands for the deviation `x - 1`.
///
/// # Errors
/// [`TaylorError`] for a term that is not analytic at the point, a degree above the limit, or a
/// coefficient that is undefined.
///
/// ```
/// # use lindstedt_series as lindstedt;
/// use lindstedt::{expr::parse_expression, series::taylor};
/// let force = parse_expression("sin(x)").unwrap();
/// let parts = taylor(&force, &[("x".into(), num_traits::Zero::zero())], 5).unwrap();
/// assert_eq!(parts[3].to_string(), "-x^3/6");
/// assert!(parts[4].is_zero());
/// ```
pub fn taylor(
    expression: &Expr,
    point: &[(Symbol, Rational)],
    degree: u32,
) -> Result<Vec<Expr>, TaylorError> {
    if degree > HIGHEST_DEGREE {
        return Err(TaylorError::Degree(degree));
    }
    let mut parts = known_to(expression, point, degree as usize + 1)?;
    if let [(variable, _)] = point {
        for (power, part) in (0_i64..).zip(&mut parts) {
            *part = &*part * &Expr::integer_power(&Expr::from(*variable), power)?;
        }
    }
    Ok(parts)
}

/// Returns the first `count` coefficients. A division by a series that vanishes at the point loses
/// the last ones, so the expansion is repeated with more.
fn known_to(
    expression: &Expr,
    point: &[(Symbol, Rational)],
    count: usize,
) -> Result<TruncatedSeries, TaylorError> {
    /// Number of attempts, enough for the poles of a force; quotients within quotients lose some
    /// coefficients at each level.
    const ATTEMPTS: usize = 6;
    let mut length = count.max(2);
    for _ in 0..ATTEMPTS {
        let expansion = TaylorExpansion { point, length, too_short: Cell::new(false) };
        match expansion.expand(expression) {
            Ok(found) if found.pole > 0 && found.known > 0 => {
                return Err(expansion.not_analytic(&pole_of(expression, point)));
            }
            Ok(mut found) if found.pole == 0 && found.known >= count => {
                found.coefficients.truncate(count);
                return Ok(found.coefficients);
            }
            Ok(found) => length += (count + found.pole).saturating_sub(found.known).max(1),
            Err(error) if !expansion.too_short.get() => return Err(error),
            Err(_) => length += 4,
        }
    }
    let expansion = TaylorExpansion { point, length, too_short: Cell::new(false) };
    Err(expansion.not_analytic(expression))
}

/// The first factor `u^-n` of an expression that is not finite at the point.
fn pole_of(expression: &Expr, point: &[(Symbol, Rational)]) -> Expr {
    let mut first = None;
    let visited = expression.fold(|expr, _: &[()]| {
        if first.is_none()
            && matches!(expr.node(), Node::Power(..))
            && let Ok(found) =
                (TaylorExpansion { point, length: 8, too_short: Cell::new(false) }).expand(expr)
            && found.pole > 0
        {
            first = Some(expr.clone());
        }
        Ok::<(), std::convert::Infallible>(())
    });
    visited.ok().and(first).unwrap_or_else(|| expression.clone())
}

/// The Maclaurin coefficient of `u^k` (NIST Digital Library of Mathematical Functions
/// 10.2.2, 10.25.2 and 19.5.1).
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

/// A truncated power series in `s`, with as many entries as the length of the expansion.
type TruncatedSeries = Vec<Expr>;

/// `s^-pole (c_0 + c_1 s + ...)`; where there is a pole, `c_0` is not zero.
#[derive(Clone)]
struct Laurent {
    pole: usize,
    /// Number of known coefficients; the zeros behind them stand for unknown ones.
    known: usize,
    coefficients: TruncatedSeries,
}

struct TaylorExpansion<'a> {
    point: &'a [(Symbol, Rational)],
    length: usize,
    /// Whether a quotient failed only because its denominator vanishes to this length.
    too_short: Cell<bool>,
}

impl TaylorExpansion<'_> {
    fn expand(&self, expression: &Expr) -> Result<Laurent, TaylorError> {
        expression.fold(|node, children: &[Laurent]| self.node(node, children))
    }

    /// The series of one node from the series of its children.
    fn node(&self, expression: &Expr, children: &[Laurent]) -> Result<Laurent, TaylorError> {
        let known = children.iter().map(|child| child.known).min().unwrap_or(self.length);
        let is_constant =
            |child: &Laurent| child.pole == 0 && child.coefficients[1..].iter().all(Expr::is_zero);
        let is_power =
            |expr: &Expr| matches!(expr.node(), Node::Power(..)) && self.depends_on_variables(expr);
        // A base that vanishes to this length need not be a constant at a greater length.
        let may_vanish = is_power(expression)
            && children.first().is_some_and(|base| base.coefficients[0].is_zero());
        if known == self.length
            && !may_vanish
            && children.iter().all(is_constant)
            && expression.as_symbol().is_none()
        {
            let constants: Vec<Expr> =
                children.iter().map(|child| child.coefficients[0].clone()).collect();
            // At a corner a function may have a value, as sgn(0), but no series.
            if !self.depends_on_variables(expression)
                || !matches!(expression.node(), Node::Function(..))
            {
                return Ok(
                    self.regular(self.constant(expression.with_children(&constants)?), known)
                );
            }
        }
        match (expression.node(), children) {
            (Node::Sum(_), terms) => return Ok(self.sum(terms)),
            (Node::Product(coefficient, _), factors) => {
                let start =
                    self.regular(self.constant(Expr::number(coefficient.clone())), self.length);
                return factors
                    .iter()
                    .try_fold(start, |product, factor| self.laurent_product(&product, factor));
            }
            (Node::Power(_, exponent), [base, _]) => {
                if let Some(exponent) = exponent.as_number() {
                    return self.power(base, exponent, expression);
                }
            }
            _ => {}
        }
        if let Some((term, _)) =
            expression.children().zip(children).find(|(_, child)| child.pole > 0)
        {
            return Err(self.not_analytic(term));
        }
        let series = |child: &Laurent| child.coefficients.clone();
        let children: Vec<TruncatedSeries> = children.iter().map(series).collect();
        let coefficients = match (expression.node(), children.as_slice()) {
            (Node::Symbol(symbol), _) => self.variable(*symbol, expression),
            (Node::Power(..), [base, exponents]) => {
                self.exponential(&self.product(exponents, &self.logarithm(base, expression)?)?)?
            }
            (Node::Function(function, _), arguments) => {
                self.function(*function, arguments, expression)?
            }
            _ => self.constant(expression.clone()),
        };
        Ok(self.regular(coefficients, known))
    }

    fn regular(&self, coefficients: TruncatedSeries, known: usize) -> Laurent {
        Laurent { pole: 0, known, coefficients }
    }

    fn sum(&self, terms: &[Laurent]) -> Laurent {
        let pole = terms.iter().map(|term| term.pole).max().unwrap_or(0);
        let behind = |term: &Laurent| pole - term.pole;
        let column = |k: usize| {
            let entries = terms.iter().filter(|term| k >= behind(term));
            Expr::sum(entries.map(|term| term.coefficients[k - behind(term)].clone()))
        };
        let known = terms.iter().map(|term| term.known + behind(term)).min();
        self.reduced(Laurent {
            pole,
            known: known.unwrap_or(self.length).min(self.length),
            coefficients: (0..self.length).map(column).collect(),
        })
    }

    fn laurent_product(&self, left: &Laurent, right: &Laurent) -> Result<Laurent, TaylorError> {
        Ok(self.reduced(Laurent {
            pole: left.pole + right.pole,
            known: left.known.min(right.known),
            coefficients: self.product(&left.coefficients, &right.coefficients)?,
        }))
    }

    /// Cancels leading zeros against the pole.
    fn reduced(&self, mut series: Laurent) -> Laurent {
        let known = &series.coefficients[..series.known];
        let zeros = known.iter().take_while(|coefficient| coefficient.is_zero()).count();
        let removable = zeros.min(series.pole);
        series.coefficients.drain(..removable);
        series.coefficients.resize(self.length, Expr::zero());
        series.pole -= removable;
        series.known -= removable;
        series
    }

    /// Raises a series without a pole to a power as [`TaylorExpansion::power`] does; fails if the
    /// result has a pole.
    fn regular_power(
        &self,
        base: &TruncatedSeries,
        exponent: &Rational,
        term: &Expr,
    ) -> Result<TruncatedSeries, TaylorError> {
        let found = self.power(&self.regular(base.clone(), self.length), exponent, term)?;
        match found.pole {
            0 => Ok(found.coefficients),
            _ => Err(self.not_analytic(term)),
        }
    }

    fn depends_on_variables(&self, expression: &Expr) -> bool {
        self.point.iter().any(|(variable, _)| expression.contains(*variable))
    }

    fn constant(&self, value: Expr) -> TruncatedSeries {
        let mut series = vec![Expr::zero(); self.length];
        series[0] = value;
        series
    }

    fn variable(&self, symbol: Symbol, itself: &Expr) -> TruncatedSeries {
        match self.point.iter().find(|(variable, _)| *variable == symbol) {
            None => self.constant(itself.clone()),
            Some((_, centre)) => {
                let mut series = self.constant(Expr::number(centre.clone()));
                // A single variable is inserted only at the end, so that the coefficients under a
                // root such as `sqrt(x^4)` are numbers.
                if let Some(first) = series.get_mut(1) {
                    *first = if self.point.len() == 1 { Expr::one() } else { itself.clone() };
                }
                series
            }
        }
    }

    fn product(
        &self,
        left: &TruncatedSeries,
        right: &TruncatedSeries,
    ) -> Result<TruncatedSeries, TaylorError> {
        (0..self.length).map(|k| convolution(left, right, k, |_| Rational::one())).collect()
    }

    fn times(
        &self,
        series: &TruncatedSeries,
        factor: &Expr,
    ) -> Result<TruncatedSeries, TaylorError> {
        self.product(series, &self.constant(factor.clone()))
    }

    /// Integrates `w' = g u'` with the given constant of integration.
    fn integral(
        &self,
        start: Expr,
        derivative: &TruncatedSeries,
        of: &TruncatedSeries,
    ) -> Result<TruncatedSeries, TaylorError> {
        let mut series = vec![start];
        for k in 1..self.length {
            let sum = convolution(&of[1..=k].to_vec(), &derivative[..k].to_vec(), k - 1, |j| {
                integer(j + 1)
            })?;
            series.push(Expr::divide(&sum, &number(k))?);
        }
        Ok(series)
    }

    fn power(
        &self,
        base: &Laurent,
        exponent: &Rational,
        term: &Expr,
    ) -> Result<Laurent, TaylorError> {
        let known = &base.coefficients[..base.known];
        let Some(lowest) = known.iter().position(|coefficient| !coefficient.is_zero()) else {
            // The base vanishes to all orders kept: a positive whole power vanishes as well, any
            // other power needs more orders.
            return if base.pole == 0 && exponent.is_positive() && exponent.is_integer() {
                Ok(self.regular(self.constant(Expr::zero()), base.known))
            } else {
                self.too_short.set(true);
                Err(self.not_analytic(term))
            };
        };
        let shift = (integer(lowest) - integer(base.pole)) * exponent;
        // (s^m)^(p/q) with q even is |s|^(m p/q): analytic only where m p/q is an even whole
        // number.
        let even_root = !exponent.denom().is_odd();
        if !shift.is_integer() || (even_root && shift.numer().is_odd()) {
            return Err(self.not_analytic(term));
        }
        if even_root && sign_of(&base.coefficients[lowest]) == Some(std::cmp::Ordering::Less) {
            return Err(self.not_analytic(term));
        }
        let size = shift.abs().to_integer().to_usize().unwrap_or(usize::MAX);
        let (zeros, pole) = if shift.is_negative() { (0, size) } else { (size, 0) };
        let mut result = vec![Expr::zero(); self.length.min(zeros)];
        if zeros >= self.length {
            return Ok(self.regular(result, self.length));
        }
        let reduced = &known[lowest..];
        // If the constant term is a sum, a whole power is multiplied out: the recurrence would
        // divide by the sum, and the last term of (c + s)^3 would not simplify to 1.
        let whole = exponent.is_positive() && exponent.is_integer() && reduced[0].terms().len() > 1;
        if let Some(times) =
            exponent.to_integer().to_usize().filter(|times| whole && *times <= self.length)
        {
            let mut padded = reduced.to_vec();
            padded.resize(self.length, Expr::zero());
            let mut product = padded.clone();
            for _ in 1..times {
                product = self.product(&product, &padded)?;
            }
            result.extend(product);
            result.truncate(self.length);
            return Ok(Laurent {
                pole,
                known: self.length.min(zeros + reduced.len()),
                coefficients: result,
            });
        }
        let mut powers = vec![Expr::power(&reduced[0], &Expr::number(exponent.clone()))?];
        for k in 1..reduced.len().min(self.length - zeros) {
            let weight = |j: usize| (exponent + Rational::one()) * integer(j) - integer(k);
            let terms: Result<Vec<Expr>, TaylorError> = (1..=k)
                .filter(|&j| {
                    reduced.get(j).is_some_and(|u| !u.is_zero()) && !powers[k - j].is_zero()
                })
                .map(|j| Ok(&(&Expr::number(weight(j)) * &reduced[j]) * &powers[k - j]))
                .collect();
            let sum = Expr::sum(terms?).expand()?;
            powers.push(Expr::divide(&sum, &(&number(k) * &reduced[0]))?.expand()?);
        }
        result.extend(powers);
        let known = result.len();
        result.resize(self.length, Expr::zero());
        Ok(Laurent { pole, known, coefficients: result })
    }

    fn exponential(&self, of: &TruncatedSeries) -> Result<TruncatedSeries, TaylorError> {
        let mut series = vec![Expr::function(Function::Exp, vec![of[0].clone()])?];
        for k in 1..self.length {
            let sum = convolution(&of[1..=k].to_vec(), &series, k - 1, |j| integer(j + 1))?;
            series.push(Expr::divide(&sum, &number(k))?);
        }
        Ok(series)
    }

    fn logarithm(&self, of: &TruncatedSeries, term: &Expr) -> Result<TruncatedSeries, TaylorError> {
        if of[0].is_zero() || sign_of(&of[0]) == Some(std::cmp::Ordering::Less) {
            return Err(self.not_analytic(term));
        }
        let start = Expr::function(Function::Log, vec![of[0].clone()])?;
        let reciprocal = self.regular_power(of, &-Rational::one(), term)?;
        self.integral(start, &reciprocal, of)
    }

    /// Sine and cosine (`sign = -1`) or the hyperbolic pair (`sign = 1`).
    fn sine_and_cosine(
        &self,
        of: &TruncatedSeries,
        hyperbolic: bool,
    ) -> Result<(TruncatedSeries, TruncatedSeries), TaylorError> {
        let (sine, cosine, sign) = if hyperbolic {
            (Function::Sinh, Function::Cosh, 1)
        } else {
            (Function::Sin, Function::Cos, -1)
        };
        let mut sines = vec![Expr::function(sine, vec![of[0].clone()])?];
        let mut cosines = vec![Expr::function(cosine, vec![of[0].clone()])?];
        for k in 1..self.length {
            let of = of[1..=k].to_vec();
            let next_sine =
                Expr::divide(&convolution(&of, &cosines, k - 1, |j| integer(j + 1))?, &number(k))?;
            let next_cosine = Expr::divide(
                &convolution(&of, &sines, k - 1, |j| integer(j + 1) * integer_sign(sign))?,
                &number(k),
            )?;
            sines.push(next_sine);
            cosines.push(next_cosine);
        }
        Ok((sines, cosines))
    }

    /// The tangent, `w' = (1 + w^2) u'`, or the hyperbolic tangent, `w' = (1 - w^2) u'`; its
    /// coefficients are polynomials in its constant term.
    fn tangent(
        &self,
        start: Expr,
        of: &TruncatedSeries,
        sign: i64,
    ) -> Result<TruncatedSeries, TaylorError> {
        let mut series = vec![start];
        let mut slopes: TruncatedSeries = Vec::new();
        for k in 1..self.length {
            let square = convolution(&series, &series, k - 1, |_| integer_sign(sign))?;
            slopes.push(if k == 1 { Expr::one() + square } else { square });
            let sum = convolution(&of[1..=k].to_vec(), &slopes, k - 1, |j| integer(j + 1))?;
            series.push(Expr::divide(&sum, &number(k))?);
        }
        Ok(series)
    }

    fn function(
        &self,
        function: Function,
        arguments: &[TruncatedSeries],
        term: &Expr,
    ) -> Result<TruncatedSeries, TaylorError> {
        let of = arguments.first().ok_or_else(|| self.not_analytic(term))?;
        let start = || Expr::function(function, vec![of[0].clone()]);
        match function {
            Function::Sin => Ok(self.sine_and_cosine(of, false)?.0),
            Function::Cos => Ok(self.sine_and_cosine(of, false)?.1),
            Function::Sinh => Ok(self.sine_and_cosine(of, true)?.0),
            Function::Cosh => Ok(self.sine_and_cosine(of, true)?.1),
            Function::Tan if of[0].cos()?.is_zero() => Err(self.not_analytic(term)),
            Function::Tan => self.tangent(start()?, of, 1),
            Function::Tanh => self.tangent(start()?, of, -1),
            Function::Exp => self.exponential(of),
            Function::Log => self.logarithm(of, term),
            Function::Asin | Function::Acos | Function::Atan | Function::Asinh => {
                // 1/sqrt(1 - u^2), its negative, 1/(1 + u^2), or 1/sqrt(1 + u^2).
                let (sign, exponent) = match function {
                    Function::Atan => (1, -Rational::one()),
                    Function::Asinh => (1, crate::exact::rational::ratio(-1, 2)),
                    _ => (-1, crate::exact::rational::ratio(-1, 2)),
                };
                let square = self.times(&self.product(of, of)?, &Expr::from(sign))?;
                let mut radicand = square;
                radicand[0] = &radicand[0] + &Expr::from(1);
                let mut derivative = self.regular_power(&radicand, &exponent, term)?;
                if function == Function::Acos {
                    derivative = self.times(&derivative, &Expr::from(-1))?;
                }
                self.integral(start()?, &derivative, of)
            }
            Function::Absolute | Function::Sign | Function::Step => {
                // Away from its corner each of these functions is linear in its arguments, or
                // constant.
                let sign = sign_of(&of[0])
                    .filter(|sign| sign.is_ne())
                    .ok_or_else(|| self.not_analytic(term))?;
                let positive = sign.is_gt();
                match function {
                    Function::Absolute => {
                        self.times(of, &Expr::from(if positive { 1 } else { -1 }))
                    }
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
            Function::BesselJ0
            | Function::BesselJ1
            | Function::BesselI0
            | Function::BesselI1
            | Function::EllipticK
                if of[0].is_zero() =>
            {
                self.composed(of, &|k| special_coefficient(function, k))
            }
            Function::BesselJ0
            | Function::BesselJ1
            | Function::BesselI0
            | Function::BesselI1
            | Function::EllipticK
            | Function::JacobiSn
            | Function::JacobiCn
            | Function::JacobiDn
            | Function::Gamma => Err(self.not_analytic(term)),
        }
    }

    /// `sum_k coefficient(k) u^k` of a series without constant term, by Horner's rule.
    fn composed(
        &self,
        of: &TruncatedSeries,
        coefficient: &dyn Fn(usize) -> Expr,
    ) -> Result<TruncatedSeries, TaylorError> {
        let mut sum = self.constant(coefficient(self.length - 1));
        for k in (0..self.length - 1).rev() {
            sum = self.product(&sum, of)?;
            sum[0] = &sum[0] + &coefficient(k);
        }
        Ok(sum)
    }

    fn not_analytic(&self, term: &Expr) -> TaylorError {
        let centres = self.point.iter();
        TaylorError::NotAnalytic {
            term: term.clone().into(),
            point: centres
                .map(|(variable, centre)| (*variable, Expr::number(centre.clone())))
                .collect(),
        }
    }
}

/// `sum_j weight(j) left_j right_(k-j)`, expanded so that like terms meet and zeros are seen.
fn convolution(
    left: &TruncatedSeries,
    right: &TruncatedSeries,
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

/// The sign of a constant; `None` if it depends on symbols or is too small to tell.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::parse_expression;

    /// The coefficients up to x^degree as text.
    fn coefficients(text: &str, degree: u32) -> Result<Vec<String>, TaylorError> {
        let parts =
            taylor(&parse_expression(text).unwrap(), &[("x".into(), Zero::zero())], degree)?;
        assert_eq!(parts.len(), degree as usize + 1);
        let one = |part: &Expr| part.substitute("x".into(), &Expr::one()).unwrap().to_string();
        Ok(parts.iter().map(one).collect())
    }

    #[test]
    fn removable_singularities() {
        for (text, expected) in [
            ("(1 - cos(x))/x", ["0", "1/2", "0", "-1/24", "0"]),
            ("1/x - cos(x)/x", ["0", "1/2", "0", "-1/24", "0"]),
            ("sin(x)/x*x^2", ["0", "0", "1", "0", "-1/6"]),
            ("(exp(x) - 1)/x - 1", ["0", "1/2", "1/6", "1/24", "1/120"]),
            ("x/sin(x)", ["1", "0", "1/6", "0", "7/360"]),
            ("1/sin(x) - 1/x", ["0", "1/6", "0", "7/360", "0"]),
            ("(x - sin(x))/x^2", ["0", "1/6", "0", "-1/120", "0"]),
            ("x^3/(1 - cos(x))", ["0", "2", "0", "1/6", "0"]),
            ("sin(x)/x", ["1", "0", "-1/6", "0", "1/120"]),
            ("log(sin(x)/x + x)", ["0", "1", "-2/3", "1/2", "-19/45"]),
            ("1/(1/x + 1)", ["0", "1", "-1", "1", "-1"]),
            ("x*sqrt((1 - cos(x))/x^2*2)", ["0", "1", "0", "-1/24", "0"]),
            ("tanh(k*x)/x - k + x", ["0", "1", "-k^3/3", "0", "2*k^5/15"]),
            ("x^2*J0(x)", ["0", "0", "1", "0", "-1/4"]),
            ("J1(x)", ["0", "1/2", "0", "-1/16", "0"]),
            ("I0(x) - 1", ["0", "0", "1/4", "0", "1/64"]),
            ("x*I1(x)", ["0", "0", "1/2", "0", "1/16"]),
            ("2*K(x)/pi", ["1", "1/4", "9/64", "25/256", "1225/16384"]),
            // The square root needs more of its radicand than it gives.
            ("sqrt(x^4 + x^5)", ["0", "0", "1", "1/2", "-1/8"]),
        ] {
            for degree in 0..5 {
                let found =
                    coefficients(text, degree).unwrap_or_else(|error| panic!("{text}: {error}"));
                assert_eq!(found, expected[..=degree as usize], "{text} to {degree}");
            }
        }
    }

    #[test]
    fn poles_are_none() {
        for (text, term) in [
            ("1/x", "1/x"),
            ("x - 1/x^3", "1/x^3"),
            ("cos(x)/x", "1/x"),
            ("(1 - cos(x))/x^3", "1/x^3"),
            ("exp(1/x)", "1/x"),
            ("x + (1 + x)/sin(x)", "1/sin(x)"),
            ("sqrt(x^2)/x", "sqrt(x^2)"),
            ("x^(-1/3)", "1/x^(1/3)"),
        ] {
            let expected = TaylorError::NotAnalytic {
                term: parse_expression(term).unwrap().into(),
                point: vec![("x".into(), Expr::zero())],
            };
            for degree in [0, 1, 4] {
                assert_eq!(coefficients(text, degree), Err(expected.clone()), "{text}");
            }
        }
    }
}
