//! Parameter expansion: the coefficients of the equation expanded in a bookkeeping parameter.
//!
//! References: J.-H. He, *Some asymptotic methods for strongly nonlinear equations*, Int. J. Mod.
//! Phys. B 20 (2006) 1141-1199, section 5; L. Xu, *He's parameter-expanding methods for strongly
//! nonlinear oscillators*, J. Comput. Appl. Math. 207 (2007) 148-154.
//!
//! ```text
//! x'' + omega0^2 x + p N(x) = 0,   omega0^2 = omega^2 + p w_1 + p^2 w_2 + ...,   x = x_0 + p x_1 + ...
//! x_0'' + omega^2 x_0 = 0
//! x_1'' + omega^2 x_1 + w_1 x_0 + N(x_0) = 0,   no secular term:   w_1 = omega0^2 - omega^2 = -c_1[N]/A
//! ```
//!
//! `omega0^2 = 0` is allowed: `0 = omega^2 + p w_1 + ...` is how the method treats forces without
//! linear part. At first order any force enters as it is, sine, |x| and all; above, the steps are
//! those of [homotopy perturbation](super::homotopy_perturbation) with the force as a polynomial.
//!
//! Cost: one Fourier coefficient of the force at first order; above, that of homotopy perturbation.
//!
//! ```
//! # use lindstedt_oscillator as lindstedt;
//! use lindstedt::{Oscillator, method::{Options, solve}, solution::Method};
//! let quadratic = Oscillator::parse("x'' + x*abs(x) = 0")?;
//! let options = Options { method: Some(Method::ParameterExpansion), order: Some(1), ..Options::default() };
//! assert_eq!(solve(&quadratic, &options)?.law.frequency_squared().unwrap().to_string(), "8*A/(3*pi)");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use super::iteration_perturbation::numbered;
use super::one_term::{conservative_force, integral_law, solve_by_integral};
use super::{Options, Refusal, homotopy_perturbation, not_polynomial};
use crate::derivation::{DerivationFormula, DerivationLine};
use crate::expr::Expr;
use crate::oscillator::Oscillator;
use crate::solution::{Method, Solution};
use crate::symbol::letters::FREQUENCY;
use crate::symbol::{fresh, fresh_stem};

/// The frequency, and the motion, to an order in the bookkeeping parameter; order 2 unless the
/// force is not a polynomial.
///
/// # Errors
/// A force that is not conservative, by its term; above the first order, a force that is not a
/// polynomial.
pub fn solve(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    const METHOD: Method = Method::ParameterExpansion;
    conservative_force(oscillator, options, METHOD)?;
    let polynomial = oscillator.polynomial_degree()?.is_some();
    let order = options.order.unwrap_or(if polynomial || options.taylor.is_some() { 2 } else { 1 });
    if order <= 1 && options.taylor.is_none() {
        let mut solution = solve_by_integral(oscillator, options, METHOD)?;
        let omega = Expr::symbol("omega").integer_power(2)?;
        let along = Expr::symbol("A") * Expr::from(oscillator.phase()).cos()?;
        let driven =
            &omega * &along - oscillator.force.substitute(oscillator.coordinate, &along)?;
        let [start, first] = [0, 1].map(|number| numbered(oscillator, number));
        let names = oscillator.names();
        let (p, w, omega0) = (fresh("p", &names), fresh_stem("w", &names), fresh("omega0", &names));
        let left = DerivationFormula::oscillator(first, omega);
        solution.derivation = vec![
            DerivationLine::equation(start, along).because(format!("at {p}^0")),
            DerivationLine::equation(left, driven).because(format!(
                "at {p}^1, {omega0}^2 - {FREQUENCY}^2 = {p}*{w}1 and the nonlinear terms together"
            )),
        ];
        let law = integral_law(oscillator, &oscillator.force, &solution)?;
        solution.derivation.extend(law);
        return Ok(solution);
    }
    if !polynomial && options.taylor.is_none() && options.order.is_some() {
        return Err(not_polynomial(&oscillator.force, oscillator.coordinate, METHOD));
    }
    let options = Options { order: Some(order), ..options.clone() };
    let mut solution = homotopy_perturbation::solve_without_linear_part(oscillator, &options)?;
    solution.method = METHOD;
    Ok(solution)
}
