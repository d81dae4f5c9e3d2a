//! He's amplitude-frequency formulation: two trial motions and the residuals they leave at one
//! instant.
//!
//! Reference: J.-H. He, *An improved amplitude-frequency formulation for nonlinear oscillators*,
//! Int. J. Nonlinear Sci. Numer. Simul. 9 (2008) 211-212; the instant cos^2 = 3/4 (theta = pi/6):
//! L. Geng, X.-C. Cai, Eur. J. Phys. 28 (2007) 923-931.
//!
//! ```text
//! u_1 = A cos(omega_1 t),  u_2 = A cos(omega_2 t),   R_i = u_i'' + f(u_i) at cos^2 = 3/4
//! omega^2 = (omega_1^2 R_2 - omega_2^2 R_1)/(R_2 - R_1)
//! R_i = f(c A) - omega_i^2 c A, c = sqrt(3)/2   ->   omega^2 = f(c A)/(c A), whatever omega_1 and omega_2 are
//! ```
//!
//! Cost: one value of the force.
//!
//! ```
//! # use lindstedt_oscillator as lindstedt;
//! use lindstedt::{Oscillator, method::{Options, solve}, solution::Method};
//! let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
//! let options = Options { method: Some(Method::AmplitudeFrequency), ..Options::default() };
//! assert_eq!(solve(&duffing, &options)?.law.frequency_squared().unwrap().to_string(), "1 + 3*eps*A^2/4");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use super::energy_balance::positive_amplitude;
use super::one_term::{conservative_force, first_order_only, require_odd, set_law, unsolved};
use super::{Options, Refusal};
use crate::conservative::force::CentredForce;
use crate::derivation::DerivationLine;
use crate::expr::Expr;
use crate::oscillator::Oscillator;
use crate::solution::{Method, Note, Solution, note::CollocationInstant};
use crate::symbol::fresh_stem;
use crate::symbol::letters::{AMPLITUDE, FREQUENCY};

/// The frequency from the residuals of two trial motions.
///
/// # Errors
/// A force that is not conservative or not odd, by its term; an order above the first.
pub fn solve(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    const METHOD: Method = Method::AmplitudeFrequency;
    first_order_only(options, METHOD)?;
    let force = conservative_force(oscillator, options, METHOD)?;
    require_odd(oscillator, &force, METHOD)?;
    let place = Expr::divide(&(Expr::from(3).sqrt()? * Expr::symbol("A")), &Expr::from(2))?;
    let trials = [Expr::one(), Expr::from(2)];
    let force_there = force.substitute(oscillator.coordinate, &place)?;
    let residual = |squared: &Expr| &force_there - &(squared * &place);
    let [first, second] = trials.each_ref().map(residual);
    let numerator = (&trials[0] * &second - &trials[1] * &first).expand()?;
    let law = Expr::divide(&numerator, &(&second - &first).expand()?)?.expand()?;
    let law = positive_amplitude(&law).unwrap_or(law);
    let mut solution = unsolved(oscillator, options, METHOD, 1);
    set_law(&mut solution, &law)?;
    let [letter, residual] =
        [FREQUENCY.written(), "R"].map(|letter| fresh_stem(letter, &oscillator.names()));
    let [first_name, second_name] = [1, 2].map(|number| format!("{letter}{number}"));
    let [omega, first_trial, second_trial] =
        ["omega", &first_name, &second_name].map(|name| Expr::symbol(name).integer_power(2));
    let (first_trial, second_trial) = (first_trial?, second_trial?);
    let [r1, r2] = [1, 2].map(|number| Expr::symbol(&format!("{residual}{number}")));
    let mixed = Expr::divide(&(&first_trial * &r2 - &second_trial * &r1), &(&r2 - &r1))?;
    let [one, two] = &trials;
    solution.derivation = vec![
        DerivationLine::equation(first_trial, one)
            .because(format!("first trial motion {AMPLITUDE}*cos({first_name}*t)")),
        DerivationLine::equation(second_trial, two)
            .because(format!("second trial motion {AMPLITUDE}*cos({second_name}*t)")),
        DerivationLine::equation(r1, first)
            .because("residuals where the square of the cosine is 3/4"),
        DerivationLine::equation(r2, second),
        DerivationLine::equal([omega?.into(), mixed.into(), law.into()])
            .because("weighted by the residuals"),
    ];
    solution.validity.push(Note::Collocated(CollocationInstant::CosineSquared));
    Ok(solution)
}

/// `f(c A)/(c A)`, `c = sqrt(3)/2`, in numbers, which have no error but rounding.
pub(super) fn by_definition(force: &CentredForce, amplitude: f64) -> Option<(f64, f64)> {
    let place = 0.75_f64.sqrt() * amplitude;
    Some((force.value(place) / place, 0.0))
}
