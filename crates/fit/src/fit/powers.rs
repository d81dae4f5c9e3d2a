//! Powers `|y|^e` with an unknown exponent, rounded near zero.
//!
//! A power of the speed has no Taylor series where the motion turns, and a power of the coordinate none in the middle of a swing. It is
//! replaced by
//!
//! ```text
//! |y|^e       = kappa U^m sum_(j=0)^3 C(m, j) (-u)^j,     U = y^2 + s,  u = s/U,  m = e/2,  s = (0.15 Y)^2
//! y |y|^(e-1) = kappa y U^m sum_(j=0)^3 C(m, j) (-u)^j,   m = (e - 1)/2
//! ```
//!
//! the binomial series of `(U - s)^m`, whose error falls as `(s/y^2)^4` away from zero. Y is the largest value of the half swing, and
//! kappa gives the first harmonic along `y = Y cos(theta)` the value that the power has,
//!
//! ```text
//! (2/pi) int_0^pi cos(theta) |cos(theta)|^e sgn(cos(theta)) = 2^(1-e) Gamma(e+1)/(Gamma((e+3)/2) Gamma((e+1)/2))
//! ```
//!
//! so that the work of a loss and the frequency of a spring stay the same. (Gradshteyn and Ryzhik, 3.631.9.)

use spec_math::cephes64::gamma;

use crate::expr::{CompiledFunction, EvaluationError, Expr, ExprError, Function, Node};
use crate::numeric::ode::quadrature::nodes_and_weights;
use crate::symbol::{Symbol, fresh_stem};

/// The number of terms of the binomial series.
const TERMS: usize = 4;

/// The rounding relative to the largest value.
const ROUNDING: f64 = 0.15;

/// The half width of the difference from which the derivative by the exponent is taken.
const STEP: f64 = 1e-4;

/// The variable of a power.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Base {
    /// The coordinate.
    Coordinate,
    /// The velocity.
    Velocity,
}

/// A power in a law, with the symbols that stand for it, for its derivatives and for the numbers in them.
///
/// ```text
/// f   = y P sum A_j U^-j                       P = exp(m log U), A_j = a_j s^j;   without the factor y if the power is even
/// f_y = P sum R_j U^-j                         R_j = (1 + 2 (m - j)) A_j - 2 s (m - j + 1) A_(j-1)
/// f_y = y P sum R_j U^-j                       R_j = 2 (m - j + 1) A_(j-1) if it is even
/// f_m = y P (log U sum A_j U^-j + sum D_j U^-j)
/// ```
#[derive(Clone, Debug)]
pub struct PowerTerm {
    /// The variable.
    pub base: Base,
    /// The exponent as a function of the parameters.
    exponent: Expr,
    is_odd: bool,
    value: CompiledFunction,
    /// The symbols of f, f_y and f_m in the acceleration.
    places: [Symbol; 3],
    /// Their meaning.
    expressions: [Expr; 3],
    /// s, m, A_j, R_j and D_j.
    symbols: Vec<Symbol>,
}

impl PowerTerm {
    fn new(
        (variable, base): (Symbol, Base),
        exponent: &Expr,
        is_odd: bool,
        parameters: &[Symbol],
        stem: &str,
    ) -> Result<Self, ExprError> {
        let value = CompiledFunction::new(exponent, parameters)
            .map_err(|_: EvaluationError| ExprError::Undefined(exponent.to_string()))?;
        let name = |letter: &str| Symbol::new(&format!("{stem}{letter}"));
        let list = |letter: &str, count: usize| -> Vec<Symbol> {
            (0..count).map(|j| Symbol::new(&format!("{stem}{letter}{j}"))).collect()
        };
        let (s, m) = (name("s"), name("m"));
        let [a, r, d] = [list("a", TERMS), list("r", TERMS + 1), list("d", TERMS)];
        let y = Expr::from(variable);
        let square = y.integer_power(2)? + Expr::from(s);
        let sum = |coefficients: &[Symbol]| -> Result<Expr, ExprError> {
            let terms = coefficients
                .iter()
                .zip(0..)
                .map(|(own, j): (&Symbol, i64)| Ok(Expr::from(*own) * square.integer_power(-j)?));
            Ok(Expr::sum(terms.collect::<Result<Vec<_>, ExprError>>()?))
        };
        let logarithm = Expr::function(Function::Log, vec![square.clone()])?;
        let power = Expr::function(Function::Exp, vec![Expr::from(m) * &logarithm])?;
        let with_factor = |wanted: bool| if wanted { &y * &power } else { power.clone() };
        let (f, r_sum, d_sum) = (sum(&a)?, sum(&r)?, sum(&d)?);
        let expressions = [
            with_factor(is_odd) * &f,
            with_factor(!is_odd) * r_sum,
            with_factor(is_odd) * (logarithm * f + d_sum),
        ];
        let symbols = [&[s, m], a.as_slice(), &r, &d].concat();
        let places = ["f", "g", "h"].map(name);
        Ok(Self { base, exponent: exponent.clone(), is_odd, value, places, expressions, symbols })
    }

    /// The symbols of the numbers in their order.
    pub fn symbols(&self) -> &[Symbol] {
        &self.symbols
    }

    /// The numbers for these parameters on a half swing with `|y| <= largest`.
    pub fn numbers(&self, parameters: &[f64], largest: f64) -> Vec<f64> {
        let exponent = self.value.call(parameters);
        let m = 0.5 * if self.is_odd { exponent - 1.0 } else { exponent };
        let s = (ROUNDING * largest).powi(2).max(f64::MIN_POSITIVE);
        let [below, at, above] =
            [-STEP, 0.0, STEP].map(|change| coefficients(m + change, self.is_odd));
        let scaled = |(j, own): (usize, f64)| own * s.powi(j as i32);
        let a: Vec<f64> = at.into_iter().enumerate().map(scaled).collect();
        let slopes = above.iter().zip(below).map(|(above, below)| (above - below) / (2.0 * STEP));
        let d: Vec<f64> = slopes.enumerate().map(scaled).collect();
        let coefficient = |j: usize| a.get(j).copied().unwrap_or(0.0);
        let r = (0..=TERMS).map(|j| {
            let rest = m - j as f64;
            let before = if j == 0 { 0.0 } else { coefficient(j - 1) * (rest + 1.0) };
            match self.is_odd {
                true => (1.0 + 2.0 * rest) * coefficient(j) - 2.0 * s * before,
                false => 2.0 * before,
            }
        });
        let r: Vec<f64> = r.collect();
        [&[s, m], a.as_slice(), &r, &d].concat()
    }
}

/// The coefficients of the powers of u, with kappa.
fn coefficients(half: f64, is_odd: bool) -> Vec<f64> {
    let mut own = vec![1.0];
    for j in 1..TERMS {
        let k = (j - 1) as f64;
        own.push(-own[j - 1] * (half - k) / (k + 1.0));
    }
    let exponent = if is_odd { 2.0 * half + 1.0 } else { 2.0 * half };
    let exact = match is_odd {
        true => {
            let top = 2.0_f64.powf(1.0 - exponent) * gamma(exponent + 1.0);
            top / (gamma(0.5 * exponent + 1.5) * gamma(0.5 * exponent + 0.5))
        }
        // The mean of an even power.
        false => {
            let top = 2.0_f64.powf(-exponent) * gamma(exponent + 1.0);
            top / gamma(0.5 * exponent + 1.0).powi(2)
        }
    };
    let quarter = std::f64::consts::FRAC_PI_2;
    // The integrand bends at the rounding, so that a panel ends there.
    let bend = quarter - 2.0 * ROUNDING;
    let nodes = nodes_and_weights(0.0, bend).chain(nodes_and_weights(bend, quarter));
    let mean: f64 = nodes
        .map(|(angle, weight)| {
            let y = angle.cos();
            let square = y * y + ROUNDING * ROUNDING;
            let share = ROUNDING * ROUNDING / square;
            let series = own.iter().rev().fold(0.0, |sum, own| sum * share + own);
            let power = square.powf(half) * series;
            weight / quarter * if is_odd { 2.0 * y * y * power } else { power }
        })
        .sum();
    own.iter().map(|own| own * exact / mean).collect()
}

/// Replaces the powers of `abs(y)` that have no power series at zero by symbols, and lists what these stand for.
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
                let stem = format!("{stem}{}", terms.len());
                terms.push(PowerTerm::new((name, base), exponent, is_odd, parameters, &stem)?);
                terms.len() - 1
            }
        };
        Ok::<Expr, ExprError>(Expr::from(terms[index].places[0]))
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
pub fn by_parameter(
    expr: &Expr,
    terms: &[PowerTerm],
    parameter: Symbol,
) -> Result<Expr, ExprError> {
    let mut sum = vec![expr.differentiate(parameter)?];
    for term in terms {
        // m = e/2 or (e - 1)/2.
        let rate = Expr::divide(&term.exponent.differentiate(parameter)?, &Expr::from(2))?;
        sum.push(expr.differentiate(term.places[0])? * Expr::from(term.places[2]) * rate);
    }
    Ok(Expr::sum(sum))
}

/// The derivative of an expression by a variable, through its powers too.
///
/// # Errors
/// [`ExprError`] if there is none.
pub fn by_variable(
    expr: &Expr,
    terms: &[PowerTerm],
    (variable, base): (Symbol, Base),
) -> Result<Expr, ExprError> {
    let mut sum = vec![expr.differentiate(variable)?];
    for term in terms.iter().filter(|term| term.base == base) {
        sum.push(expr.differentiate(term.places[0])? * Expr::from(term.places[1]));
    }
    Ok(Expr::sum(sum))
}

/// The expression with what stands for its powers and their derivatives written out.
///
/// # Errors
/// [`ExprError`] if it cannot be written.
pub fn written_out(expr: &Expr, terms: &[PowerTerm]) -> Result<Expr, ExprError> {
    let own = |term: &PowerTerm| {
        std::iter::zip(term.places, term.expressions.clone()).collect::<Vec<_>>()
    };
    expr.substitute_all(&terms.iter().flat_map(own).collect())
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

    /// The rounded power at y, with Y = 1.
    fn rounded(y: f64, half: f64, is_odd: bool) -> f64 {
        let square = y * y + ROUNDING * ROUNDING;
        let share = ROUNDING * ROUNDING / square;
        let own = coefficients(half, is_odd);
        let series = own.iter().rev().fold(0.0, |sum, own| sum * share + own);
        square.powf(half) * series * if is_odd { y } else { 1.0 }
    }

    #[test]
    fn the_rounded_power_does_the_work_of_the_power() {
        const SAMPLES: u32 = 100_000;
        for exponent in [0.4, 1.0, 1.7, 2.5] {
            let (mut exact, mut found) = (0.0, 0.0);
            for sample in 0..SAMPLES {
                let angle = std::f64::consts::TAU * (f64::from(sample) + 0.5) / f64::from(SAMPLES);
                let y = angle.cos();
                exact += y.abs().powf(exponent + 1.0);
                found += rounded(y, 0.5 * (exponent - 1.0), true) * y;
            }
            assert!((found / exact - 1.0).abs() < 1e-7, "{exponent}: {found} {exact}");
        }
        // Away from zero it is the power but for kappa, which is nearly one.
        for exponent in [0.5, 1.5, 2.7] {
            let half = 0.5 * (exponent - 1.0);
            let ratios = [0.5, 0.7, 1.0].map(|y: f64| rounded(y, half, true) / y.powf(exponent));
            assert!((ratios[0] / ratios[2] - 1.0).abs() < 1e-4, "{exponent}: {ratios:?}");
            assert!((ratios[2] - 1.0).abs() < 5e-3, "{exponent}: {ratios:?}");
        }
    }
}
