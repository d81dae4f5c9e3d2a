//! He's max-min approach: omega^2 lies between the least and the largest of `f(x)/x`.
//!
//! Reference: J.-H. He, *Max-min approach to nonlinear oscillators*, Int. J. Nonlinear Sci. Numer. Simul. 9 (2008) 207-210.
//!
//! ```text
//! x'' + [f(x)/x] x = 0:    min f/x < omega^2 < max f/x    over 0 < |x| <= A
//! omega^2 = (m lo + n hi)/(m + n) = lo + k (hi - lo),   k = n/(m + n)
//! no secular term in x'' + omega^2 x = omega^2 x - f(x), x = A cos(theta), fixes k
//! ```
//!
//! The last condition makes omega^2 the [shared integral](super::one_term); the bounds are what the method adds, and where
//! there are none, as for a force that is steeper than linear at rest, it does not apply.
//!
//! ```
//! use lindstedt::{Oscillator, method::{Options, solve}, solution::Method};
//! let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
//! let options = Options { method: Some(Method::MaxMin), ..Options::default() };
//! let solution = solve(&duffing, &options)?;
//! assert_eq!(solution.frequency_squared.unwrap().to_string(), "1 + 3*eps*A^2/4");
//! assert!(solution.derivation[1].ends_with("between 1 and 1 + eps*A^2"));
//! assert_eq!(solution.derivation[2], "k = 3/4");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use num_traits::{Signed, Zero};

use super::one_term::{conservative_force, first_order_only, require_odd, solve_by_integral};
use super::{Options, Refusal};
use crate::conservative::{split, take_powers};
use crate::exact::Rational;
use crate::expr::Expr;
use crate::oscillator::Oscillator;
use crate::series::taylor::taylor;
use crate::solution::{Method, Solution};

/// The frequency between the bounds of `f(x)/x`.
///
/// # Errors
/// A force that is not conservative or not odd, by its term; no finite bounds; an order above the first.
pub fn solve(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    const METHOD: Method = Method::MaxMin;
    first_order_only(options, METHOD)?;
    let force = conservative_force(oscillator, options, METHOD)?;
    require_odd(oscillator, &force, METHOD)?;
    let coordinate = oscillator.coordinate;
    let (amplitude, x) = (Expr::symbol("A"), Expr::from(coordinate));
    let quotient = Expr::divide(&force, &x)?.expand()?;
    let at_rest = stiffness_at_rest(&quotient, &force, oscillator).ok_or_else(|| Refusal::Unbounded {
        quotient: quotient.to_string(),
    })?;
    let at_turning = super::energy_balance::positive_amplitude(&quotient.substitute(coordinate, &amplitude)?)
        .unwrap_or_else(|| quotient.clone());
    let mut solution = solve_by_integral(oscillator, options, METHOD)?;
    solution.derivation = vec![
        format!("{coordinate}'' + ({quotient})*{coordinate} = 0"),
        format!("the factor runs between {at_rest} and {at_turning}"),
    ];
    let law = solution
        .frequency_squared
        .as_ref()
        .map(Expr::from)
        .or_else(|| solution.closed_form.as_ref().map(|form| form.value.clone()));
    let share = law.and_then(|law| {
        let above = (law - &at_rest).expand().ok()?;
        let range = (&at_turning - &at_rest).expand().ok()?;
        quotient_of(&above, &range)
    });
    if let Some(share) = share {
        solution.derivation.push(format!("k = {share}"));
    }
    solution
        .derivation
        .push("no secular term: omega^2 = lo + k*(hi - lo)".to_owned());
    solution.validity.insert(
        0,
        format!("omega^2 lies between {at_rest} and {at_turning} wherever f(x)/x is monotonic"),
    );
    Ok(solution)
}

fn quotient_of(above: &Expr, below: &Expr) -> Option<Expr> {
    if below.is_zero() {
        return None;
    }
    let quotient = Expr::divide(above, below).ok()?;
    // Sums that are multiples of one another leave a number.
    match (above.terms(), below.terms()) {
        ([_], [_]) => quotient.expand().ok(),
        _ => Some(quotient),
    }
}

/// The limit of `f(x)/x` at rest, where it is finite.
fn stiffness_at_rest(quotient: &Expr, force: &Expr, oscillator: &Oscillator) -> Option<Expr> {
    if let Ok(value) = quotient.substitute(oscillator.coordinate, &Expr::zero()) {
        return Some(value);
    }
    let coordinate = oscillator.coordinate;
    if let Ok(parts) = taylor(force, &[(coordinate, Rational::zero())], 1) {
        let slope = Expr::divide(parts.get(1)?, &Expr::from(coordinate)).ok()?;
        return slope.expand().ok();
    }
    // Powers of |x| above zero vanish at rest, whatever they are.
    let term = |term: &Expr| {
        let (mut outside, mut inside) = split(term, coordinate);
        let power = take_powers(&mut inside, &mut outside, coordinate)?;
        match (inside.is_empty(), power.exponent.is_positive()) {
            (true, true) => Some(Expr::zero()),
            (true, false) if power.exponent.is_zero() && !power.odd => Some(outside),
            _ => None,
        }
    };
    let terms = quotient.terms().iter().map(term).collect::<Option<Vec<_>>>()?;
    Some(Expr::sum(terms))
}
