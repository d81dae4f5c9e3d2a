//! A power of one variable with its sign.

use num_traits::ToPrimitive as _;

use crate::expr::{Expr, Function, Node};
use crate::symbol::Symbol;

/// The highest whole power that may multiply a function that is not a power.
const HIGHEST_POWER: usize = 24;

/// `|y|^exponent`, times `sgn(y)` where odd. The exponent may be a symbol, which is taken to be
/// above -1.
pub(crate) struct Power {
    /// The power of the size.
    pub(crate) exponent: Expr,
    /// Whether the sign stands beside it.
    pub(crate) odd: bool,
}

impl Power {
    /// The power zero.
    pub(crate) fn one() -> Self {
        Self { exponent: Expr::zero(), odd: false }
    }

    /// Takes a factor in, where it is a power of the variable, its size or its sign.
    pub(crate) fn absorb(&mut self, factor: &Expr, variable: Symbol) -> bool {
        let (base, exponent) = factor.base_and_exponent();
        let number = exponent.as_number();
        let of_variable =
            |arguments: &[Expr]| arguments.first().and_then(Expr::as_symbol) == Some(variable);
        match base.node() {
            // An even root of y exists for y > 0 alone.
            Node::Symbol(name) if *name == variable => match number {
                Some(number) if number.denom().is_odd() => self.odd ^= number.numer().is_odd(),
                _ => return false,
            },
            Node::Function(Function::Absolute, arguments) if of_variable(arguments) => {
                if exponent.contains(variable) {
                    return false;
                }
            }
            Node::Function(Function::Sign, arguments) if of_variable(arguments) => {
                match number.filter(|number| number.is_integer()) {
                    Some(number) => self.odd ^= number.numer().is_odd(),
                    None => return false,
                }
                return true;
            }
            _ => return false,
        }
        self.exponent = &self.exponent + &exponent;
        true
    }

    /// The exponent, if this is a whole power of the variable itself, and not of its size.
    pub(crate) fn integer_exponent(&self) -> Option<usize> {
        let number = self.exponent.as_number()?;
        let whole = number.is_integer() && self.odd == number.numer().is_odd();
        let count = number.to_integer().to_usize()?;
        (whole && count <= HIGHEST_POWER).then_some(count)
    }

    /// This power of `variable` as an expression; `None` if it has none.
    pub(crate) fn in_terms_of(&self, variable: Symbol) -> Option<Expr> {
        let size = Expr::function(Function::Absolute, vec![Expr::from(variable)]).ok()?;
        let power = Expr::power(&size, &self.exponent).ok()?;
        if let Some(count) = self.integer_exponent() {
            return Expr::from(variable).integer_power(count as i64).ok();
        }
        match self.odd {
            true => {
                Some(&power * &Expr::function(Function::Sign, vec![Expr::from(variable)]).ok()?)
            }
            false => Some(power),
        }
    }
}
