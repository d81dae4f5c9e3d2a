//! Variational iteration: one correction functional, its secular term removed.
//!
//! Reference: J.-H. He, *Variational iteration method: a kind of non-linear analytical technique:
//! some examples*, Int. J. Non-Linear Mech. 34 (1999) 699-708.
//!
//! ```text
//! u_1(t) = u_0(t) + int_0^t lambda [u_0'' + f(u_0)] ds,   lambda = sin(omega (s - t))/omega,   u_0 = A cos(omega t)
//! f(A cos theta) = sum_k c_k cos(k theta):   no t sin(omega t)   ->   omega^2 = c_1/A
//! u_1 = A cos theta + sum_(k>1) c_k (cos k theta - cos theta)/((k^2 - 1) omega^2)
//! ```
//!
//! Cost: one Fourier table of the force.
//!
//! ```
//! # use lindstedt_oscillator as lindstedt;
//! use lindstedt::{Oscillator, method::{Options, solve}, solution::Method};
//! let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
//! let options = Options { method: Some(Method::VariationalIteration), ..Options::default() };
//! let solution = solve(&duffing, &options)?;
//! assert_eq!(solution.law.frequency_squared().unwrap().to_string(), "1 + 3*eps*A^2/4");
//! assert_eq!(solution.displacement.harmonics()[1].1.to_string(), "eps*A^3/(32*omega^2)");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use super::iteration_perturbation::first_iterate;
use super::one_term::{
    conservative_force, first_order_only, integral_law, note_even_part_last, solve_by_integral,
};
use super::{Options, Refusal};
use crate::derivation::{DerivationFormula, DerivationLine};
use crate::expr::Expr;
use crate::oscillator::Oscillator;
use crate::solution::{Method, Solution};
use crate::symbol::{fresh, fresh_stem};

/// Frequency and motion after one correction.
///
/// # Errors
/// A force that is not conservative, by its term; an order above the first.
pub fn solve(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    const METHOD: Method = Method::VariationalIteration;
    first_order_only(options, METHOD)?;
    let force = conservative_force(oscillator, options, METHOD)?;
    let mut solution = solve_by_integral(oscillator, options, METHOD)?;
    first_iterate(&mut solution, oscillator, &force)?;
    let names = solution.names();
    let (variable, letter) = (fresh("s", &names), fresh_stem("u", &names));
    let [amplitude, omega, t, s] = ["A", "omega", "t", variable.name()].map(Expr::symbol);
    let [start, first] = [0, 1].map(|number| Expr::symbol(&format!("{letter}{number}")));
    let along = &amplitude * &(&omega * &s).cos()?;
    let defect =
        force.substitute(oscillator.coordinate, &along)? - omega.integer_power(2)? * &along;
    let multiplier = Expr::divide(&(&omega * &(s - &t)).sin()?, &omega)?;
    let functional = DerivationFormula::Integral {
        factor: Expr::one(),
        from: Expr::zero(),
        to: t.clone(),
        integrand: Box::new((multiplier * defect).into()),
        variable,
    };
    solution.derivation = vec![
        DerivationLine::equation(start.clone(), &amplitude * &(&omega * &t).cos()?)
            .because("first iterate"),
        DerivationLine::equation(first - start, functional).because("correction functional"),
    ];
    solution.derivation.extend(integral_law(oscillator, &force, &solution)?);
    note_even_part_last(&mut solution);
    Ok(solution)
}
