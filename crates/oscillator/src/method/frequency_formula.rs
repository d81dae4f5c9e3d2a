//! He's one-line frequency formula: the slope of the force at half the amplitude.
//!
//! Reference: J.-H. He, *The simpler, the better: analytical methods for nonlinear oscillators and
//! fractional oscillators*, J. Low Freq. Noise Vib. Act. Control 38 (2019) 1252-1260; formulas of
//! this kind: K. Rapedius, arXiv:1502.00545.
//!
//! ```text
//! x'' + f(x) = 0   ->   omega^2 = f'(x) at x = A/2
//! ```
//!
//! ```
//! # use lindstedt_oscillator as lindstedt;
//! use lindstedt::{Oscillator, method::{Options, solve}, solution::Method};
//! let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
//! let options = Options { method: Some(Method::FrequencyFormula), ..Options::default() };
//! assert_eq!(solve(&pendulum, &options)?.law.closed_form().unwrap().to_string(), "omega^2 = cos(A/2)");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use super::energy_balance::positive_amplitude;
use super::one_term::{conservative_force, first_order_only, require_odd, set_law, unsolved};
use super::{Options, Reason, Refusal};
use crate::conservative::force::CentredForce;
use crate::derivation::{DerivationFormula, DerivationLine};
use crate::expr::Expr;
use crate::oscillator::Oscillator;
use crate::solution::{Method, Note, Solution};
use crate::symbol::fresh;

/// The frequency from the slope of the force at half the amplitude.
///
/// # Errors
/// A force that is not conservative or not odd, by its term; a slope that is zero at half the
/// amplitude, as that of `sgn`; an order above the first.
pub fn solve(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    const METHOD: Method = Method::FrequencyFormula;
    first_order_only(options, METHOD)?;
    let force = conservative_force(oscillator, options, METHOD)?;
    require_odd(oscillator, &force, METHOD)?;
    let slope = force.differentiate(oscillator.coordinate)?;
    let half = Expr::divide(&Expr::symbol("A"), &Expr::from(2))?;
    let law = slope.substitute(oscillator.coordinate, &half)?.expand()?;
    let law = positive_amplitude(&law).unwrap_or(law);
    if law.is_zero() {
        return Err(Reason::NoSlope(force.to_string()).into());
    }
    let mut solution = unsolved(oscillator, options, METHOD, 1);
    set_law(&mut solution, &law)?;
    let derivative = DerivationFormula::Slope {
        factor: Expr::one(),
        of: fresh("f", &oscillator.names()),
        by: oscillator.coordinate,
    };
    solution.derivation = vec![
        DerivationLine::equal([derivative, slope.into()]).because("slope of the force"),
        DerivationLine::equation(Expr::symbol("omega").integer_power(2)?, law)
            .because("its value at half the amplitude"),
    ];
    solution.validity.push(Note::SlopeAtHalf);
    Ok(solution)
}

/// `f'(A/2)` in numbers, which have no error but rounding.
pub(super) fn by_definition(force: &CentredForce, amplitude: f64) -> Option<(f64, f64)> {
    Some((force.slope(0.5 * amplitude), 0.0))
}
