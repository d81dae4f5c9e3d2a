//! The exponent with which the error of a formula vanishes with its small parameter.

use std::collections::BTreeMap;

use super::formula::formula_frequency;
use super::orbit::true_frequency;
use super::{orbit_target, validity};
use crate::conservative::features::Features;
use crate::expr::Expr;
use crate::oscillator::Oscillator;
use crate::solution::Solution;
use crate::symbol::Symbol;

/// The exponent with which the error of the frequency vanishes: the small parameter is halved until
/// rounding begins to matter, and the slopes between halvings, which approach their limit linearly,
/// are extrapolated to zero.
pub(super) fn slope(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Option<f64> {
    const HALVINGS: i32 = 12;
    // Motions over several wells do not become small.
    if validity::is_over_several_wells(oscillator, solution, numbers) {
        return None;
    }
    let varied = with_small_parameter(oscillator, solution, numbers);
    let (oscillator, solution, numbers) = match &varied {
        Some((oscillator, solution, numbers)) => (oscillator, solution, numbers),
        None => (oscillator, solution, numbers),
    };
    // The true frequency is accurate to 1e-15 by quadrature, 1e-12 by quadrature in pieces and
    // 1e-11 by Runge-Kutta: errors hundreds of times larger are measured to less than one per cent.
    let conservative = oscillator.of_position_alone();
    let amplitude = numbers.get(&solution.amplitude.symbol()).copied().unwrap_or(1.0);
    let equilibrium = solution.equilibrium.evaluate(numbers).unwrap_or(0.0);
    let features = Features::new(&oscillator.force, oscillator.coordinate, numbers);
    let pieces = !features.cuts(equilibrium - amplitude, equilibrium + amplitude).is_empty();
    let floor = match (conservative, pieces) {
        (true, false) => 2e-13,
        (true, true) => 1e-10,
        (false, _) => 1e-8,
    };
    let formula_at = |factor: f64| {
        let mut numbers = numbers.clone();
        for small in solution.small_parameters() {
            *numbers.get_mut(&small)? *= factor;
        }
        Some((formula_frequency(oscillator, solution, &numbers)?, numbers))
    };
    let error = |halving: i32| {
        let factor = 0.5_f64.powi(halving);
        let (formula, numbers) = formula_at(factor)?;
        let truth =
            true_frequency(oscillator, &orbit_target(oscillator, solution, &numbers), &numbers)
                .ok()?;
        let error = (formula / truth - 1.0).abs();
        // A closed form such as (cos(A) - 1)/A^2 loses digits at small amplitudes: the effect of a
        // change of the last bits is not an error of the formula.
        let shakes = if solution.law.closed_form().is_some() { 4 } else { 0 };
        let shaken = (1..=shakes).filter_map(|k| formula_at(factor * (1.0 + f64::from(k) * 1e-14)));
        let noise = shaken.map(|(shaken, _)| (shaken / formula - 1.0).abs()).fold(0.0, f64::max);
        Some(if error > 100.0 * noise { error } else { 0.0 })
    };
    let errors: Vec<f64> =
        (0..HALVINGS).filter_map(error).take_while(|error| *error >= floor).collect();
    slopes_of(&errors)
}

/// The exponent of a sequence of errors at successively halved parameters: the slopes between them,
/// which approach their limit linearly, are extrapolated to zero.
pub(super) fn slopes_of(errors: &[f64]) -> Option<f64> {
    let slopes: Vec<f64> = errors.windows(2).map(|pair| (pair[0] / pair[1]).log2()).collect();
    match *slopes.as_slice() {
        [.., before, last] if (last - before).abs() < 0.5 => Some(2.0 * last - before),
        [.., last] => Some(last),
        [] => None,
    }
}

/// The equation with the bookkeeping parameter inserted, so that it can be varied, if the small
/// terms have numbers for coefficients: all but the linear restoring force is multiplied by `delta
/// / value`.
fn with_small_parameter(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Option<(Oscillator, Solution, BTreeMap<Symbol, f64>)> {
    let delta = solution.small_parameter;
    let own = solution.definitions.iter().find(|definition| definition.symbol == delta)?;
    let known = solution.definitions.iter();
    let known = known.map(|definition| (definition.symbol, definition.meaning.clone())).collect();
    let stiffness = Expr::from(&solution.leading(solution.law.frequency_squared()?));
    let stiffness = stiffness.substitute_all(&known).ok()?;
    let linear = &stiffness * &(&Expr::from(oscillator.coordinate) - &solution.equilibrium);
    let factor = Expr::divide(&Expr::from(delta), &own.meaning).ok()?;
    let (mut oscillator, mut varied, mut numbers) =
        (oscillator.clone(), solution.clone(), numbers.clone());
    oscillator.force = &linear + &(&factor * &(&oscillator.force - &linear));
    oscillator.parameters.push(delta);
    varied.definitions.retain(|definition| definition.symbol != delta);
    varied.parameters.push(delta);
    numbers.insert(delta, own.meaning.evaluate(&BTreeMap::new()).ok()?);
    Some((oscillator, varied, numbers))
}
