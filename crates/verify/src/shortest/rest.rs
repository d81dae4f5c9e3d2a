//! Laws that are exact at rest: the series of the truth in powers of the variable.
//!
//! In: a problem and an order. Out: the coefficients of the quantity, from the exact series of omega^2
//! by Lindstedt and Poincare, and those of its powers.

use num_traits::{One as _, Zero as _};

use super::SearchOptions;
use super::problem::{LawMotion, LawProblem, ShortestError};
use crate::exact::rational::{factorial, power};
use crate::exact::{Integer, Rational};
use crate::expr::Expr;
use crate::method::{Options, solve};
use crate::symbol::Symbol;

/// The first coefficients of a quantity in powers of the variable.
pub(super) struct RestSeries {
    pub(super) quantity: Vec<Rational>,
}

impl RestSeries {
    /// The series of the quantity of a search up to an order.
    ///
    /// # Errors
    /// [`ShortestError::NoSeries`] where it has no coefficients that are fractions.
    pub(super) fn new(
        problem: &LawProblem,
        options: &SearchOptions,
        order: u32,
    ) -> Result<Self, ShortestError> {
        let none = || ShortestError::NoSeries(problem.variable);
        let LawMotion::Free { oscillator, .. } = &problem.motion else { return Err(none()) };
        let asked = Options { order: Some(order.max(1)), ..Options::default() };
        let solution = solve(oscillator, &asked).map_err(Box::new)?;
        let law = Expr::from(solution.law.frequency_squared().ok_or_else(none)?);
        let law = match problem.amplitude() {
            Some((name, amplitude)) => law.substitute(name, &Expr::number(amplitude.clone()))?,
            None => law,
        };
        let count = order as usize + 1;
        let squared = power_series(&law, problem.variable, count).ok_or_else(none)?;
        let half = Rational::new(options.quantity.power().into(), 2.into());
        let quantity = powered(&squared, &half).ok_or_else(none)?;
        Ok(Self { quantity })
    }

    /// The series of z, whose power this quantity is; `None` if it is not one of fractions.
    pub(super) fn to_power(&self, whole: &Rational) -> Option<Vec<Rational>> {
        powered(&self.quantity, &whole.recip())
    }
}

/// The first coefficients of an expression in powers of a symbol, which is the only one in it; `None` if
/// one is no fraction, or has no value.
pub(super) fn power_series(law: &Expr, symbol: Symbol, count: usize) -> Option<Vec<Rational>> {
    let mut derivative = law.clone();
    let mut series = vec![];
    for order in 0..count {
        let value = derivative.substitute(symbol, &Expr::zero()).ok()?.expand().ok()?;
        let value = value.as_number()?.clone();
        let factorial = Rational::from_integer(factorial(u32::try_from(order).ok()?));
        series.push(value / factorial);
        if order + 1 < count {
            derivative = derivative.differentiate(symbol).ok()?;
        }
    }
    Some(series)
}

/// `u^e` of a series whose constant is not zero: `k u_0 v_k = sum_(j >= 1) (e j - k + j) u_j v_(k - j)`
/// (Knuth, The Art of Computer Programming 2, 4.7). `None` if the power of the constant is no fraction.
fn powered(series: &[Rational], exponent: &Rational) -> Option<Vec<Rational>> {
    let first = series.first().filter(|first| !first.is_zero())?;
    let start = match exponent.is_one() {
        true => first.clone(),
        false => power(first, exponent)?,
    };
    let mut result = vec![start];
    for k in 1..series.len() {
        let whole = |number: usize| Rational::from_integer(Integer::from(number as u64));
        let terms = (1..=k).map(|j| {
            let factor = exponent * whole(j) - whole(k - j);
            factor * &series[j] * &result[k - j]
        });
        let sum: Rational = terms.sum();
        result.push(sum / (whole(k) * first));
    }
    Some(result)
}
