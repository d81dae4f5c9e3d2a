//! The Hamiltonian approach: the mean Hamiltonian of a one-term motion made stationary in the
//! amplitude.
//!
//! Reference: J.-H. He, *Hamiltonian approach to nonlinear oscillators*, Phys. Lett. A 374 (2010)
//! 2312-2314.
//!
//! ```text
//! H = x'^2/2 + V(x),   V' = f,   x = A cos(omega t)
//! h(A) = int_0^(T/4) H dt = (1/omega) int_0^(pi/2) [omega^2 A^2 sin^2/2 + V(A cos theta)] dtheta
//! d/dA dh/d(1/omega) = 0   ->   omega^2 = (2/A) d<V>/dA,   <V> = (1/pi) int_0^pi V(A cos theta) dtheta
//! ```
//!
//! The mean is taken of the potential in closed form and then differentiated; where there is none
//! the derivative is taken under the integral, which leaves the [shared integral](super::one_term).
//!
//! Cost: one mean of the potential over a turn.
//!
//! ```
//! # use lindstedt_oscillator as lindstedt;
//! use lindstedt::{Oscillator, method::{Options, solve}, solution::Method};
//! let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
//! let options = Options { method: Some(Method::Hamiltonian), ..Options::default() };
//! assert_eq!(solve(&pendulum, &options)?.law.closed_form().unwrap().to_string(), "omega^2 = 2*J1(A)/A");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use super::one_term::{
    conservative_force, first_order_only, note_even_part, set_law, solve_by_integral, unsolved,
};
use super::{Options, Refusal};
use crate::conservative::potential::potential;
use crate::conservative::projection::cosine_coefficient;
use crate::derivation::{DerivationFormula, DerivationLine};
use crate::expr::{Expr, Function};
use crate::oscillator::Oscillator;
use crate::solution::{Method, Note, Solution, note::ExactFirstStep};
use crate::symbol::fresh;
use crate::symbol::letters::AMPLITUDE;

/// The frequency by the mean Hamiltonian.
///
/// # Errors
/// A force that is not conservative, by its term; an order above the first.
pub fn solve(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    const METHOD: Method = Method::Hamiltonian;
    first_order_only(options, METHOD)?;
    let force = conservative_force(oscillator, options, METHOD)?;
    let amplitude = Expr::symbol("A");
    // The derivatives of the ends of an arc cancel, but not visibly in the closed form: arcs are
    // differentiated under the integral.
    let has_arcs = force.contains_function(Function::Step);
    let mean_of = |potential: &Expr| {
        let twice = cosine_coefficient(potential, oscillator.coordinate, &amplitude, 0)?;
        Some(twice * Expr::number(crate::exact::rational::ratio(1, 2)))
    };
    let law = |mean: &Expr| {
        let slope = mean.differentiate("A".into()).ok()?;
        Expr::divide(&(Expr::from(2) * slope), &amplitude).ok()?.expand().ok()
    };
    let stationary = |potential: Expr| {
        let mean = mean_of(&potential)?;
        let law = law(&mean)?;
        Some((potential, mean, law))
    };
    let Some((potential, mean, law)) =
        potential(&force, oscillator.coordinate).filter(|_| !has_arcs).and_then(stationary)
    else {
        return solve_by_integral(oscillator, options, METHOD);
    };
    let mut solution = unsolved(oscillator, options, METHOD, 1);
    set_law(&mut solution, &law)?;
    let names = oscillator.names();
    let mean_name = fresh("V_mean", &names);
    let along = amplitude.clone() * Expr::from(oscillator.phase()).cos()?;
    let integral = DerivationFormula::Integral {
        factor: Expr::divide(&Expr::one(), &Expr::pi())?,
        from: Expr::zero(),
        to: Expr::pi(),
        integrand: Box::new(potential.substitute(oscillator.coordinate, &along)?.into()),
        variable: oscillator.phase(),
    };
    let slope = DerivationFormula::Slope {
        factor: Expr::divide(&Expr::from(2), &amplitude)?,
        of: mean_name,
        by: "A".into(),
    };
    solution.derivation = vec![
        DerivationLine::equation(fresh("V", &names), potential).because("potential energy"),
        DerivationLine::equal([mean_name.into(), integral, mean.into()])
            .because(format!("its mean over {AMPLITUDE}*cos(θ)")),
        DerivationLine::equal([Expr::symbol("omega").integer_power(2)?.into(), slope, law.into()])
            .because("the mean Hamiltonian is stationary"),
    ];
    solution.validity.push(Note::FirstStep(ExactFirstStep::TermOfForce));
    note_even_part(&mut solution, oscillator, &force)?;
    Ok(solution)
}
