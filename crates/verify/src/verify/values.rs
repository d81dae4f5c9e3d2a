//! The values at which a formula is verified: the symbols that it needs, and their numbers.

use std::collections::BTreeMap;

use super::VerificationError;
use crate::expr::{Expr, LostDigits};
use crate::oscillator::Oscillator;
use crate::solution::{AmplitudeConvention, Solution};
use crate::symbol::Symbol;
use crate::values::Values;

/// The symbols that need a value before `solution` can be judged.
///
/// ```
/// # use lindstedt_verify as lindstedt;
/// use lindstedt::{Options, Oscillator, solve};
///
/// let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
/// let solution = solve(&duffing, &Options::default())?;
/// let names = lindstedt::verify::needed_values(&solution);
/// assert!(names.contains(&"A".into()) && names.contains(&"eps".into()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn needed_values(solution: &Solution) -> Vec<Symbol> {
    let mut needed = solution.parameters.clone();
    if solution.slow().is_some() {
        // A motion that settles may be verified in its steady state, without an initial amplitude.
        if solution.on_cycle().is_none() {
            needed.push(AmplitudeConvention::Initial.symbol());
        }
        return needed;
    }
    // A law such as omega^2 = 1 for x'' + x + x^2 = 0 does not contain A although the true motion
    // depends on it.
    let linear = || {
        let oscillator = Oscillator::from_equation(&solution.equation);
        oscillator.is_ok_and(|oscillator| matches!(oscillator.polynomial_degree(), Ok(Some(0 | 1))))
    };
    let own = solution.limit_cycle.is_some() || solution.response.is_some();
    if !own && (solution.depends_on_amplitude() || !linear()) {
        needed.push(solution.amplitude.symbol());
    }
    needed
}

/// The symbol of the amplitude among the values: that of the start if the amplitude changes.
fn amplitude_symbol(solution: &Solution) -> Symbol {
    match solution.slow() {
        Some(_) => AmplitudeConvention::Initial.symbol(),
        None => solution.amplitude.symbol(),
    }
}

/// Whether a formula can be judged at these values.
///
/// # Errors
/// Missing or unknown values, or an amplitude of zero.
pub fn checked(solution: &Solution, at: &Values) -> Result<(), VerificationError> {
    checked_numbers(solution, at).map(|_| ())
}

/// Refuses an amplitude at which the force has no digits left. The distance from the equilibrium
/// decides, which is exact if the equilibrium is.
///
/// # Errors
/// [`LostDigits`].
pub(super) fn check_digits(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Result<(), VerificationError> {
    let coordinate = oscillator.coordinate;
    let Some(amplitude) = numbers.get(&amplitude_symbol(solution)).copied() else {
        return Ok(());
    };
    let moved = Expr::from(coordinate) + solution.equilibrium.clone();
    let Ok(force) = oscillator.force.substitute(coordinate, &moved) else {
        return Ok(());
    };
    let mut there = numbers.clone();
    there.insert(coordinate, amplitude);
    there.extend([oscillator.velocity(), Symbol::new("t")].map(|name| (name, 0.0)));
    let of_amplitude = |lost: LostDigits| LostDigits { name: amplitude_symbol(solution), ..lost };
    Ok(force.check_digits(&there, &[coordinate]).map_err(of_amplitude)?)
}

/// The values as numbers.
///
/// # Errors
/// Missing or unknown values, or an amplitude of zero.
pub(super) fn checked_numbers(
    solution: &Solution,
    at: &Values,
) -> Result<BTreeMap<Symbol, f64>, VerificationError> {
    let needed = needed_values(solution);
    let mut known = solution.parameters.clone();
    if solution.response.is_none() || solution.in_time().is_some() {
        known.push(amplitude_symbol(solution));
    }
    let start = AmplitudeConvention::Initial.symbol();
    if solution.limit_cycle.is_some() && !known.contains(&start) && at.get(start).is_some() {
        return Err(VerificationError::OffCycle);
    }
    if let Some((name, _)) = at.iter().find(|(name, _)| !known.contains(name)) {
        return Err(VerificationError::Unknown { name, known });
    }
    let missing: Vec<Symbol> = needed.into_iter().filter(|&name| at.get(name).is_none()).collect();
    if !missing.is_empty() {
        return Err(VerificationError::Missing(missing));
    }
    // If the frequency does not depend on the amplitude, any amplitude serves for the comparison of
    // the motion.
    let amplitude_symbol = amplitude_symbol(solution);
    let numbers = at.with(amplitude_symbol, at.get(amplitude_symbol).unwrap_or(1.0));
    let may_rest = solution.limit_cycle.is_some() || solution.in_time().is_some();
    if !may_rest && numbers[&amplitude_symbol] == 0.0 {
        return Err(VerificationError::AtRest);
    }
    Ok(numbers)
}

/// The values as numbers, with the amplitude 1 if none is given.
pub(super) fn numbers_of_motion(solution: &Solution, at: &Values) -> BTreeMap<Symbol, f64> {
    let symbol = amplitude_symbol(solution);
    at.with(symbol, at.get(symbol).unwrap_or(1.0))
}
