//! Contact in a variable in which it is a power series: for equation (7) and for the main mass.
//!
//! In time the force of a barrier, depth^(3/2), has no power series at the touch. It has one in s:
//!
//! ```text
//! x = x_c + sigma w^2,  dt = w ds          sigma = 1 at a right barrier, -1 at a left one
//! w' = sigma x'/2,  every other rate times w,  P = -sigma (gamma + mu sigma x') w^3
//! ```
//!
//! The force is a polynomial in w, and touch and release are simple zeros of w, however slow the
//! touch. (T. Levi-Civita and K. F. Sundman regularised collisions by this change of variable:
//! E. L. Stiefel, G. Scheifele, *Linear and Regular Celestial Mechanics*, Springer 1971.)

use super::model::Side;
use crate::expr::{Expr, ExprError};
use crate::symbol::Symbol;

/// Returns the rates in s of w and of everything else that moves, from the rates in time of
/// everything but x. In these `x'` is the velocity and `P` the force of the barrier on x; the
/// barrier stands at `x_c`.
///
/// # Errors
/// A rate that has no value in contact.
pub(super) fn regularised(rates: &[Expr], side: Side) -> Result<Vec<Expr>, ExprError> {
    let [w, velocity, gamma, mu] = ["w", "x'", "gamma", "mu"].map(Expr::symbol);
    let power = |exponent: i64| Expr::power(&w, &Expr::from(exponent));
    let sign = Expr::from(side.sign() as i64);
    let inwards = &sign * &velocity;
    let force = &sign * &(power(3)? * (gamma + mu * &inwards));
    let place = Expr::symbol("x_c") + &sign * &power(2)?;
    let in_s = [(Symbol::new("P"), -force), (Symbol::new("x"), place)].into();
    let others = rates.iter().map(|rate| Ok(&w * &rate.substitute_all(&in_s)?));
    std::iter::once(Expr::divide(&inwards, &Expr::from(2))).chain(others).collect()
}
