//! Powers `|y|^e` with an unknown exponent, as polynomials on one half swing.
//!
//! A power of the speed has no Taylor series where the motion turns. On a half swing with `|y| <= Y` it is replaced by
//! its Chebyshev series, whose terms are the harmonics of the power along `y = Y cos(theta)`:
//!
//! ```text
//! |y|^e       = Y^e (a_0/2 + sum a_k T_2k(y/Y)),   a_k = 2^(1-e) Gamma(e+1)/(Gamma(1+e/2+k) Gamma(1+e/2-k))
//! y |y|^(e-1) = Y^e sum b_k T_(2k+1)(y/Y),         b_k = 2^(1-e) Gamma(e+1)/(Gamma((e+3)/2+k) Gamma((e+1)/2-k))
//! a_(k+1)/a_k = (e/2 - k)/(e/2 + k + 1),           b_(k+1)/b_k = ((e-1)/2 - k)/((e+3)/2 + k)
//! ```
//!
//! (Gradshteyn and Ryzhik, 3.631.9.) The harmonics left out do no work in a harmonic motion, and displace it by their size over
//! the square of their number, which is at least 9.

use spec_math::cephes64::gamma;

use crate::expr::{CompiledFunction, EvaluationError, Expr, ExprError, Function, Node};
use crate::symbol::{Symbol, fresh_stem};

/// The number of terms of a series: more for the spring, whose harmonics displace the body by more.
const fn term_count(base: Base) -> usize {
    match base {
        Base::Coordinate => 6,
        Base::Velocity => 4,
    }
}

/// The half width of the difference from which the derivative by the exponent is taken.
const STEP: f64 = 1e-4;

/// Which variable a power is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Base {
    /// The coordinate.
    Coordinate,
    /// The velocity.
    Velocity,
}

/// A power in a law, and the symbols of the coefficients that stand for it.
#[derive(Clone, Debug)]
pub struct PowerTerm {
    /// The variable.
    pub base: Base,
    /// The exponent as a function of the parameters.
    pub exponent: Expr,
    /// The symbols of the coefficients of `y^(2k)` or `y^(2k+1)`.
    pub coefficients: Vec<Symbol>,
    /// The symbols of their derivatives by the exponent.
    pub slopes: Vec<Symbol>,
    /// The symbols of their derivatives by the largest value Y.
    pub growths: Vec<Symbol>,
    is_odd: bool,
    value: CompiledFunction,
}

impl PowerTerm {
    /// The coefficients, then their derivatives by the exponent and by the largest value, on a half swing with
    /// `|y| <= largest`.
    pub fn numbers(&self, parameters: &[f64], largest: f64) -> Vec<f64> {
        let exponent = self.value.call(parameters);
        let [below, at, above] = [-STEP, 0.0, STEP]
            .map(|change| monomials(exponent + change, largest, self.is_odd, self.coefficients.len()));
        let slopes = above.iter().zip(below).map(|(above, below)| (above - below) / (2.0 * STEP));
        // Y^(e - j) has the logarithmic derivative (e - j)/Y.
        let parity = usize::from(self.is_odd);
        let growth = |(k, c): (usize, &f64)| c * (exponent - (2 * k + parity) as f64) / largest;
        let growths = at.iter().enumerate().map(growth);
        at.iter().copied().chain(slopes).chain(growths).collect()
    }

    /// The symbols of the numbers in their order.
    pub fn symbols(&self) -> Vec<Symbol> {
        [self.coefficients.as_slice(), &self.slopes, &self.growths].concat()
    }

    /// The polynomial in a variable with these coefficients.
    fn polynomial(&self, variable: &Expr, coefficients: &[Symbol]) -> Result<Expr, ExprError> {
        let square = variable.integer_power(2)?;
        let mut sum = Expr::zero();
        for coefficient in coefficients.iter().rev() {
            sum = sum * &square + Expr::from(*coefficient);
        }
        Ok(if self.is_odd { sum * variable } else { sum })
    }
}

/// The coefficients of the powers of y in the Chebyshev series.
fn monomials(exponent: f64, largest: f64, is_odd: bool, terms: usize) -> Vec<f64> {
    let parity = usize::from(is_odd);
    let half = 0.5 * exponent;
    let mut chebyshev = vec![0.0; terms];
    let top = 2.0_f64.powf(1.0 - exponent) * gamma(exponent + 1.0);
    chebyshev[0] = match is_odd {
        true => top / (gamma(half + 1.5) * gamma(half + 0.5)),
        false => top / gamma(half + 1.0).powi(2),
    };
    for index in 1..terms {
        let k = (index - 1) as f64;
        let ratio = match is_odd {
            true => (half - 0.5 - k) / (half + 1.5 + k),
            false => (half - k) / (half + 1.0 + k),
        };
        chebyshev[index] = chebyshev[index - 1] * ratio;
    }
    if !is_odd {
        chebyshev[0] *= 0.5;
    }
    // T_(n+1) = 2 y T_n - T_(n-1), as lists of coefficients.
    let length = 2 * terms;
    let [mut before, mut now] = [vec![0.0; length], vec![0.0; length]];
    (before[0], now[1]) = (1.0, 1.0);
    let mut sum = vec![0.0; length];
    for order in 0..length {
        let own = if order == 0 { &before } else { &now };
        if order % 2 == parity {
            for (sum, own) in sum.iter_mut().zip(own) {
                *sum += chebyshev[order / 2] * own;
            }
        }
        if order > 0 {
            let next = (0..length).map(|place| {
                let raised = if place > 0 { 2.0 * now[place - 1] } else { 0.0 };
                raised - before[place]
            });
            let next = next.collect();
            before = std::mem::replace(&mut now, next);
        }
    }
    let scaled = |index: usize| {
        let power = 2 * index + parity;
        sum[power] * largest.powf(exponent - power as f64)
    };
    (0..terms).map(scaled).collect()
}

/// Replaces the powers of `abs(y)` that have no power series at zero by polynomials, and lists them.
///
/// # Errors
/// [`ExprError`] if the result cannot be written.
pub fn replace_powers(
    acceleration: &Expr,
    bases: [(Symbol, Base); 2],
    parameters: &[Symbol],
    taken: &[Symbol],
) -> Result<(Expr, Vec<PowerTerm>), ExprError> {
    let stem = fresh_stem("c", taken);
    let mut terms: Vec<PowerTerm> = vec![];
    let mut replaced = |name: Symbol, base: Base, exponent: &Expr, is_odd: bool| {
        let known = terms.iter().position(|term| {
            term.base == base && term.exponent == *exponent && term.is_odd == is_odd
        });
        let index = match known {
            Some(index) => index,
            None => {
                let value = CompiledFunction::new(exponent, parameters)
                    .map_err(|_: EvaluationError| ExprError::Undefined(exponent.to_string()))?;
                let symbols = |letter: &str| {
                    let own = (0..term_count(base)).map(|k| format!("{stem}{letter}{}_{k}", terms.len()));
                    own.map(|name| Symbol::new(&name)).collect()
                };
                let [coefficients, slopes, growths] = ["a", "b", "g"].map(symbols);
                let exponent = exponent.clone();
                terms.push(PowerTerm { base, exponent, coefficients, slopes, growths, is_odd, value });
                terms.len() - 1
            }
        };
        terms[index].polynomial(&Expr::from(name), &terms[index].coefficients)
    };
    let result = acceleration.fold(|expr, children: &[Expr]| {
        if let Node::Product(coefficient, factors) = expr.node() {
            // y |y|^(e-1) and sgn(y) |y|^e are smoother than their factors.
            for (name, base) in bases {
                let power = factors.iter().position(|factor| power_of(factor, name).is_some());
                let companion = factors.iter().position(|factor| is_odd_companion(factor, name));
                let (Some(power), Some(companion)) = (power, companion) else { continue };
                let Some(exponent) = power_of(&factors[power], name) else { continue };
                let is_sign = factors[companion].as_symbol().is_none();
                let exponent = if is_sign { exponent } else { exponent + Expr::one() };
                let own = replaced(name, base, &exponent, true)?;
                let rest = children.iter().enumerate();
                let rest = rest.filter(|(place, _)| ![power, companion].contains(place));
                let rest = rest.map(|(_, factor)| factor.clone()).chain([own]);
                return Ok(Expr::number(coefficient.clone()) * Expr::product(rest));
            }
        }
        for (name, base) in bases {
            if let Some(exponent) = power_of(expr, name) {
                return replaced(name, base, &exponent, false);
            }
        }
        match expr.node() {
            Node::Number(_) | Node::Pi | Node::Symbol(_) => Ok(expr.clone()),
            _ => expr.with_children(children),
        }
    })?;
    Ok((result, terms))
}

/// The derivative of an expression by a parameter, through the exponents of its powers too.
///
/// # Errors
/// [`ExprError`] if there is none.
pub fn derivative(expr: &Expr, terms: &[PowerTerm], parameter: Symbol) -> Result<Expr, ExprError> {
    let mut sum = vec![expr.differentiate(parameter)?];
    for term in terms {
        let rate = term.exponent.differentiate(parameter)?;
        if rate.is_zero() {
            continue;
        }
        for (coefficient, slope) in term.coefficients.iter().zip(&term.slopes) {
            sum.push(expr.differentiate(*coefficient)? * Expr::from(*slope) * &rate);
        }
    }
    Ok(Expr::sum(sum))
}

/// The derivative of an expression by the largest value of a variable, through the coefficients of its powers.
///
/// # Errors
/// [`ExprError`] if there is none.
pub fn derivative_by_size(expr: &Expr, terms: &[PowerTerm], base: Base) -> Result<Expr, ExprError> {
    let mut sum = vec![];
    for term in terms.iter().filter(|term| term.base == base) {
        for (coefficient, growth) in term.coefficients.iter().zip(&term.growths) {
            sum.push(expr.differentiate(*coefficient)? * Expr::from(*growth));
        }
    }
    Ok(Expr::sum(sum))
}

/// The exponent of `abs(y)^e` unless it is a whole number; `None` for any other node.
fn power_of(node: &Expr, name: Symbol) -> Option<Expr> {
    let Node::Power(base, exponent) = node.node() else { return None };
    let square = Expr::from(name).integer_power(2).ok()?;
    let whole = match base.node() {
        Node::Function(Function::Absolute, own) if own[0].as_symbol() == Some(name) => {
            exponent.clone()
        }
        _ if *base == square => exponent * Expr::from(2),
        _ => return None,
    };
    (!whole.as_number().is_some_and(|number| number.is_integer())).then_some(whole)
}

/// Whether a factor is `y` or `sgn(y)`.
fn is_odd_companion(factor: &Expr, name: Symbol) -> bool {
    match factor.node() {
        Node::Symbol(own) => *own == name,
        Node::Function(Function::Sign, own) => own[0].as_symbol() == Some(name),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_polynomial_has_the_first_harmonic_of_the_power() {
        // The work of the force in a harmonic motion is its first harmonic, found by the sum over a period.
        const SAMPLES: u32 = 100_000;
        for exponent in [0.4, 1.0, 1.7, 2.5] {
            let coefficients = monomials(exponent, 0.7, true, 4);
            let (mut exact, mut found) = (0.0, 0.0);
            for sample in 0..SAMPLES {
                let angle = std::f64::consts::TAU * (f64::from(sample) + 0.5) / f64::from(SAMPLES);
                let y = 0.7 * angle.cos();
                exact += y * y.abs().powf(exponent - 1.0) * y;
                let power = |(k, c): (usize, &f64)| c * y.powi(2 * k as i32 + 1);
                found += coefficients.iter().enumerate().map(power).sum::<f64>() * y;
            }
            assert!((found / exact - 1.0).abs() < 1e-6, "{exponent}: {found} {exact}");
        }
        for (exponent, y) in [(2.0_f64, 0.3_f64), (4.0, 0.6)] {
            let even = monomials(exponent, 0.7, false, 4);
            let sum: f64 = even.iter().enumerate().map(|(k, c)| c * y.powi(2 * k as i32)).sum();
            assert!((sum - y.powf(exponent)).abs() < 1e-12);
        }
    }
}
