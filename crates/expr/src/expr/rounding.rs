//! Significant digits of a value: an expression is evaluated together with a bound of its rounding
//! error.
//!
//! Reference: N. J. Higham, *Accuracy and Stability of Numerical Algorithms*, 2nd ed., SIAM 2002,
//! section 3.3 (running error analysis).
//!
//! `4*(cos(A/sqrt(2)) - cos(A))/A^2` is right as a formula but has no correct digit at `A = 1e-8`,
//! where both cosines round to one. The error bound shows this.

use std::collections::BTreeMap;

use num_traits::{One, Signed};
use thiserror::Error;

use super::{Expr, Node};
use crate::decimal::{decimal, significant};
use crate::exact::rational::to_f64;
use crate::symbol::Symbol;

/// A value and a bound of its absolute error.
pub type Rounded = (f64, f64);

/// Relative rounding error of an operation: half a unit in the last place, with a margin for less
/// accurate library functions.
const UNIT: f64 = 1.5 * f64::EPSILON;

/// Largest relative rounding error of a force with which results computed from it still have six
/// digits.
const MOST_LOST: f64 = 1e-6;

/// The error of an expression that loses its digits in double precision: the position is so large
/// that neighbouring doubles are far apart.
#[derive(Clone, Debug, PartialEq, Error)]
#[error(
    "`{expression}` has no digits left at {name} = {}: in double precision {name} and what is made of it are rounded there so \
     coarsely that the value moves by {} of its size; take a smaller {name}",
    decimal(*value), significant(*lost, 2)
)]
pub struct LostDigits {
    /// The expression, shortened.
    pub expression: String,
    /// The symbol whose rounding moves it.
    pub name: Symbol,
    /// The value of that symbol.
    pub value: f64,
    /// Bound of the rounding error, over the size of the expression near that value.
    pub lost: f64,
}

impl Expr {
    /// Refuses values at which rounding, also that of the `uncertain` symbols, changes this
    /// expression by more than a millionth of its size. The expression is evaluated there and a
    /// little nearer to zero, so that neither a jump nor a zero at the point counts. A difference
    /// that loses its digits towards zero is not refused, since no smaller values would restore
    /// them.
    ///
    /// # Errors
    /// [`LostDigits`] names the symbol.
    ///
    /// ```
    /// # use lindstedt_expr as lindstedt;
    /// use lindstedt::expr::Expr;
    /// let force: Expr = "sin(x)".parse()?;
    /// assert!(force.check_digits(&[("x".into(), 1e17)].into(), &["x".into()]).is_err());
    /// assert!(force.check_digits(&[("x".into(), 1e3)].into(), &["x".into()]).is_ok());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn check_digits(
        &self,
        values: &BTreeMap<Symbol, f64>,
        uncertain: &[Symbol],
    ) -> Result<(), LostDigits> {
        const NEARER: [f64; 5] = [1.0, 0.999, 0.98, 0.9, 0.7];
        /// Factor of the errors at smaller values, so that the sign of a difference of rounding errors is
        /// certain at none of them, as it may be by chance; there the largest error counts, since such a
        /// difference may be zero as well.
        const WIDER: f64 = 64.0;
        let lost_at = |scale: f64, wider: f64| {
            let (mut least, mut most, mut size) = (f64::INFINITY, 0.0_f64, 0.0_f64);
            for factor in NEARER.map(|factor| scale * factor) {
                let there = |symbol: Symbol| {
                    let value = *values.get(&symbol)?;
                    Some(match uncertain.contains(&symbol) {
                        true => {
                            (factor * value, 0.5 * wider * f64::EPSILON * (factor * value).abs())
                        }
                        false => (value, 0.0),
                    })
                };
                if let Some((value, error)) =
                    self.evaluate_rounded(&there).filter(|(value, _)| value.is_finite())
                {
                    (least, most) = (least.min(error), most.max(error));
                    size = size.max(value.abs());
                }
            }
            (size > 0.0 && least.is_finite()).then(|| [least / size, most / size])
        };
        let Some([lost, _]) = lost_at(1.0, 1.0).filter(|[lost, _]| *lost > MOST_LOST) else {
            return Ok(());
        };
        let mut smaller = (1..=80).filter_map(|thousands| lost_at(1e-3_f64.powi(thousands), WIDER));
        if !smaller.any(|[_, lost]| lost <= MOST_LOST) {
            return Ok(());
        }
        let of_one = |name: &Symbol| values.get(name).map_or(0.0, |value| value.abs());
        let worst = uncertain.iter().copied().filter(|name| self.contains(*name));
        let Some(name) = worst.max_by(|one, other| of_one(one).total_cmp(&of_one(other))) else {
            return Ok(());
        };
        Err(LostDigits {
            expression: super::print::in_message(self),
            name,
            value: values.get(&name).copied().unwrap_or_default(),
            lost,
        })
    }

    /// Returns the value with a bound of its rounding error, from the values and error bounds of
    /// the symbols; `None` if a symbol is missing.
    ///
    /// ```
    /// # use lindstedt_expr as lindstedt;
    /// use lindstedt::expr::Expr;
    /// let law: Expr = "(1 - cos(A))/A^2".parse()?;
    /// let (value, error) = law.evaluate_rounded(&|_| Some((1e-3, 0.0))).unwrap();
    /// assert!((value - 0.5).abs() < 1e-6 && error > 1e-12 && error < 1e-8);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn evaluate_rounded(
        &self,
        value_of: &dyn Fn(Symbol) -> Option<Rounded>,
    ) -> Option<Rounded> {
        self.fold(|expr, children: &[Rounded]| node(expr, children, value_of).ok_or(())).ok()
    }
}

fn node(
    expr: &Expr,
    children: &[Rounded],
    value_of: &dyn Fn(Symbol) -> Option<Rounded>,
) -> Option<Rounded> {
    Some(match (expr.node(), children) {
        (Node::Number(number), _) => {
            let value = to_f64(number);
            let exact = number.denom().is_one() && value.abs() < 2.0_f64.powi(53);
            (value, if exact { 0.0 } else { UNIT * value.abs() })
        }
        (Node::Pi, _) => (std::f64::consts::PI, UNIT),
        (Node::Symbol(symbol), _) => value_of(*symbol)?,
        (Node::Sum(_), terms) => {
            let (mut value, mut error) = (0.0, 0.0);
            for (term, own) in terms {
                value += term;
                error += own + UNIT * f64::abs(value);
            }
            (value, error)
        }
        (Node::Product(coefficient, factors), values) => {
            let coefficient = to_f64(coefficient);
            // If a step function is zero, the other factors need no value.
            let closed = factors
                .iter()
                .zip(values)
                .any(|(factor, value)| value.0 == 0.0 && factor.is_stepwise());
            if closed {
                return Some((0.0, 0.0));
            }
            let (mut value, mut error) = (coefficient, UNIT * coefficient.abs());
            if coefficient.abs() == 1.0 {
                error = 0.0;
            }
            for (factor, own) in values {
                error = error * f64::abs(*factor) + f64::abs(value) * own;
                value *= factor;
                error += UNIT * f64::abs(value);
            }
            (value, error)
        }
        (Node::Power(_, exponent), [base, power]) => {
            let number = exponent.as_number();
            let raised = |base: f64, power: f64| match number {
                Some(number) if base < 0.0 && number.denom().is_odd() => {
                    let odd = number.numer().is_odd();
                    base.abs().powf(power) * if odd { -1.0 } else { 1.0 }
                }
                _ => base.powf(power),
            };
            let slack = if number
                .is_some_and(|number| number.denom().is_one() && number.abs() <= One::one())
            {
                0.0
            } else {
                power.1
            };
            // If the power has a value, a base that only its error makes negative counts as zero.
            let is_root =
                number.is_some_and(|number| number.is_positive() && !number.denom().is_odd());
            let shifted = |shift: f64| match base.0 + shift * base.1 {
                below if below < 0.0 && is_root && base.0 >= 0.0 => 0.0,
                other => other,
            };
            moved(&|shift| raised(shifted(shift), power.0 + shift * slack))
        }
        (Node::Function(function, _), [one]) => {
            moved(&|shift| function.value(one.0 + shift * one.1, one.0 + shift * one.1))
        }
        (Node::Function(function, _), [one, other]) => {
            let (value, error) =
                moved(&|shift| function.value(one.0 + shift * one.1, other.0 + shift * other.1));
            // The arguments of `max` and `min` may move in opposite directions.
            (value, error + one.1 + other.1)
        }
        (Node::Power(..) | Node::Function(..), _) => return None,
    })
}

/// Returns a function at zero, and a bound of its change as the argument varies from -1 to 1.
fn moved(function: &dyn Fn(f64) -> f64) -> Rounded {
    let value = function(0.0);
    let spread = [-1.0, 1.0].map(|side| (function(side) - value).abs());
    // At the edge of its domain the function has a value on one side only.
    let spread = spread.into_iter().fold(0.0, f64::max);
    let error = if spread.is_nan() { f64::INFINITY } else { spread };
    (value, error + 2.0 * UNIT * value.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Velocities that differ by rounding alone tell no sign at any size, so that no smaller ones would help;
    /// a position that is too large would.
    #[test]
    fn a_difference_of_rounding_is_not_refused() {
        let names: [Symbol; 2] = ["x".into(), "y".into()];
        let friction: Expr = "x/20 + sgn(x - y)/5".parse().unwrap();
        for count in 1..200_u64 {
            let x = 0.3 + 0.0137 * count as f64;
            let y = f64::from_bits(x.to_bits() + count % 3);
            let values = names.iter().copied().zip([x, y]).collect();
            assert_eq!(friction.check_digits(&values, &names), Ok(()), "{x:e} {y:e}");
        }
        let values = names.iter().copied().zip([1e17, 1.0]).collect();
        let sine: Expr = "sin(x) + y".parse().unwrap();
        assert!(sine.check_digits(&values, &names).is_err());
    }

    #[test]
    fn the_bound_covers_the_error_and_is_no_empty_word() {
        // Each beside a form of the same function that does not cancel.
        let pairs = [
            ("(1 - cos(A))/A^2", "sin(A/2)^2/(2*(A/2)^2)"),
            ("exp(A) - exp(-A)", "2*sinh(A)"),
            ("sqrt(1 + A^2) - 1", "A^2/(1 + sqrt(1 + A^2))"),
            ("1/(1 - A) - 1/(1 + A)", "2*A/((1 - A)*(1 + A))"),
            ("2*J1(A)/A", "J0(A) + 2*J1(A)/A - J0(A)"),
        ];
        for (cancels, exact) in pairs {
            let [cancels, exact] = [cancels, exact].map(|text| text.parse::<Expr>().unwrap());
            for k in 0..60 {
                let amplitude = 0.7 * 0.8_f64.powi(k);
                let at = |expr: &Expr| expr.evaluate_rounded(&|_| Some((amplitude, 0.0))).unwrap();
                let ((value, bound), (truth, own)) = (at(&cancels), at(&exact));
                let error = (value - truth).abs();
                assert!(error <= bound + own, "{cancels} at {amplitude}: {error} {bound}");
                assert!(
                    bound <= 1e-14 * value.abs() / amplitude.powi(2),
                    "{cancels} at {amplitude}: {bound}"
                );
            }
        }
    }

    #[test]
    fn a_closed_gate_asks_for_nothing_behind_it() {
        let barrier: Expr = "x + (x - 1)^(3/2)*H(x - 1)".parse().unwrap();
        let (value, error) = barrier.evaluate_rounded(&|_| Some((0.25, 0.0))).unwrap();
        assert_eq!(value, 0.25);
        assert!(error < 1e-15);
        assert_eq!(barrier.evaluate_rounded(&|_| None), None);
    }
}
