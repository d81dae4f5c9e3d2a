//! The validity of a formula: the well of the true motion, the amplitude at which a law loses its
//! frequency, the radius of convergence of its series, and the range in which its error stays
//! small.

use std::collections::BTreeMap;

use super::backbone::TrueBackbone;
use super::bounds::bounds;
use super::convergence::convergence;
use super::reach;
use super::{VerificationError, force_of, orbit_target};
use crate::conservative::force::CentredForce;
use crate::conservative::well::Well;
use crate::decimal::significant;
use crate::method::inertia;
use crate::method::numbers::{NumbersCache, error_of_integral, frequency_squared_along, law_name};
use crate::method::table::{ForceRepresentation, MethodEntry};
use crate::numeric::ode::energy::PeriodError;
use crate::numeric::ode::root::find_root;
use crate::oscillator::Oscillator;
use crate::solution::{AmplitudeConvention, Method, Solution};
use crate::symbol::Symbol;
use crate::symbol::letters::of_frequency;

pub use super::reach::AmplitudeReach;

/// A place where the formula stops to hold, or another remark on its range.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Range {
    /// The range in words and numbers.
    pub text: String,
    /// Whether the given values lie outside of it.
    pub outside: bool,
}

/// Collects the known limits of validity of `solution` at these numbers.
pub(super) fn ranges(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    tolerance: f64,
) -> Vec<Range> {
    let mut ranges: Vec<Range> = of_equation(oscillator, solution, numbers).into_iter().collect();
    if let Some(cycle) = &solution.limit_cycle {
        let series = MethodEntry::for_method(solution.method).sees
            == ForceRepresentation::Derivatives
            && cycle.small_with.is_empty();
        // Without self-excitation there is no cycle to expand from.
        let feeds = numbers.get(&solution.small_parameter).is_some_and(|value| *value != 0.0);
        let found = (series && feeds).then(|| convergence(oscillator, solution, numbers)).flatten();
        ranges.extend(found.map(|range| {
            match range.outside && solution.method == Method::LindstedtPoincare {
                // A quotient can represent the poles that limit the series.
                true => Range {
                    text: format!(
                        "{}; beyond it a Pade approximant of the series holds farther",
                        range.text
                    ),
                    ..range
                },
                false => range,
            }
        }));
        return ranges;
    }
    if solution.amplitude != AmplitudeConvention::Initial {
        return ranges;
    }
    let Some(&amplitude) = numbers.get(&solution.amplitude.symbol()) else {
        return ranges;
    };
    ranges.extend(integral_error(oscillator, solution, numbers));
    ranges.extend(bounds(oscillator, solution, numbers));
    let truth = backbone(oscillator, solution, numbers);
    match truth.smallest_amplitude() {
        inner if inner > 0.0 => ranges.extend(positive_from(oscillator, solution, numbers, &truth)),
        _ => ranges.extend(vanishing(oscillator, solution, numbers, truth.largest_amplitude())),
    }
    if MethodEntry::for_method(solution.method).sees == ForceRepresentation::Derivatives {
        ranges.extend(convergence(oscillator, solution, numbers));
    }
    if let Some(reach) = reach::amplitude_reach(oscillator, solution, &truth, tolerance) {
        ranges.push(Range {
            text: reach.in_words(tolerance, solution.amplitude.symbol()),
            outside: reach.leaves_out(amplitude),
        });
    }
    ranges
}

/// The escape from the well; `None` if the energy has no closed form.
pub(super) fn of_equation(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Option<Range> {
    let well = well_of(oscillator, solution, numbers)?;
    let amplitude = *numbers.get(&solution.amplitude.symbol())?;
    let beyond = well.on_side(amplitude).is_some_and(|end| amplitude.abs() >= end.amplitude.abs())
        || amplitude.abs() < well.smallest_amplitude();
    let text = well.in_words(solution.amplitude.symbol(), oscillator.coordinate);
    // Beyond the edge of one well the motion may still be periodic, over several wells.
    let over_all = beyond
        && super::orbit::true_frequency(
            oscillator,
            &orbit_target(oscillator, solution, numbers),
            numbers,
        )
        .is_ok();
    Some(match over_all {
        true => Range {
            text: format!("{text}; beyond it the motion runs over several wells, and does so here"),
            outside: false,
        },
        false => Range { text, outside: beyond },
    })
}

/// The error of the numerical integral of a law, as a remark.
fn integral_error(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Option<Range> {
    let error = error_of_integral(oscillator, solution, numbers)?;
    Some(Range {
        text: format!("the integral of the law is good to {error:.0e}"),
        outside: error > 1e-6,
    })
}

/// The true frequency against the amplitude, for the motions that an answer is about.
pub(super) fn backbone<'a>(
    oscillator: &'a Oscillator,
    solution: &Solution,
    numbers: &'a BTreeMap<Symbol, f64>,
) -> TrueBackbone<'a> {
    let well = well_of(oscillator, solution, numbers);
    TrueBackbone::new(oscillator, &orbit_target(oscillator, solution, numbers), numbers, well)
}

/// Whether the motions that an answer is about run over several wells and do not begin at rest.
pub(super) fn is_over_several_wells(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> bool {
    well_of(oscillator, solution, numbers).is_some_and(|well| well.inner.is_some())
}

/// The well of the motion that an answer is about.
fn well_of(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Option<Well> {
    if solution.amplitude != AmplitudeConvention::Initial || solution.limit_cycle.is_some() {
        return None;
    }
    let amplitude = *numbers.get(&solution.amplitude.symbol())?;
    if oscillator.of_position_alone() {
        return Well::new(&force_of(oscillator, solution, numbers)?, amplitude);
    }
    let forces = inertia::forces(oscillator)?;
    let [weighted, force] = forces.map(|force| {
        CentredForce::new(&force, oscillator.coordinate, &solution.equilibrium, numbers, amplitude)
    });
    Well::with_inertia(&weighted?, &force?, amplitude)
}

/// The reason why there is no motion to judge by, with the amplitudes at which there is one where
/// the inertia depends on the position: Runge-Kutta alone does not give these. For a force of the
/// position alone the error contains them already.
pub(super) fn why_no_motion(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    error: VerificationError,
) -> VerificationError {
    /// Relative distance from the end of the well within which its position is known.
    const ON: f64 = 1e-9;
    let VerificationError::Period(lost) = error else {
        return error;
    };
    let well = match oscillator.of_position_alone() {
        true => None,
        false => well_of(oscillator, solution, numbers),
    };
    let (symbol, coordinate) = (solution.amplitude.symbol(), oscillator.coordinate);
    let end = well.and_then(|well| {
        let amplitude = *numbers.get(&symbol)?;
        Some((well, well.on_side(amplitude)?, amplitude))
    });
    VerificationError::Period(match end {
        Some((_, end, amplitude))
            if end.rim.separatrix && (amplitude / end.amplitude - 1.0).abs() <= ON =>
        {
            PeriodError::Separatrix {
                start: solution.equilibrium.evaluate(numbers).unwrap_or(0.0) + amplitude,
                place: end.rim.place,
            }
        }
        Some((well, end, amplitude)) if amplitude / end.amplitude >= 1.0 => {
            lost.with_range(well.in_words(symbol, coordinate))
        }
        _ => lost,
    })
}

/// The largest amplitude of motions over several wells, up to four times that asked for, below
/// which the law's omega^2 is not positive.
fn positive_from(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    truth: &TrueBackbone,
) -> Option<Range> {
    const STEPS: usize = 256;
    if solution.method == Method::Exact || solution.law.is_solved_by_numbers() {
        return None;
    }
    let symbol = solution.amplitude.symbol();
    let amplitude = *numbers.get(&symbol)?;
    let (inner, outer) =
        (truth.smallest_amplitude(), f64::min(truth.largest_amplitude(), 4.0 * amplitude.abs()));
    let known = NumbersCache::default();
    let squared = |size: f64| {
        let numbers = truth.numbers_at(size);
        frequency_squared_along(oscillator, solution, &numbers, &known).unwrap_or(f64::NAN)
    };
    let place = |k: usize| inner + (outer - inner) * k as f64 / STEPS as f64;
    let values: Vec<f64> = (0..=STEPS).map(|k| squared(place(k))).collect();
    let last = values.windows(2).rposition(|pair| pair[0] <= 0.0 && pair[1] > 0.0)?;
    let zero = find_root(squared, place(last), place(last + 1)).ok()?;
    let at = significant(zero.copysign(amplitude), 6);
    let law = of_frequency(law_name(solution));
    Some(Range {
        text: format!("{law} of the formula is positive from {symbol} = {at} on"),
        outside: amplitude.abs() <= zero,
    })
}

/// The first amplitude, on the side asked for, at which the law's omega^2 reaches zero or has a
/// pole.
fn vanishing(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    limit: f64,
) -> Option<Range> {
    const STEPS: usize = 256;
    /// Range of the search in amplitudes, if the motion has no escape.
    const FARTHEST: f64 = 100.0;
    let symbol = solution.amplitude.symbol();
    let amplitude = *numbers.get(&symbol)?;
    if solution.method == Method::Exact || solution.law.is_solved_by_numbers() {
        return None;
    }
    // A law is of no use beyond the escape of the true motion, but its own end is reported all the
    // same.
    let farthest = if limit.is_finite() {
        f64::max(1.5 * limit, amplitude.abs())
    } else {
        FARTHEST * amplitude.abs()
    };
    let known = NumbersCache::default();
    let squared = |size: f64| {
        let mut numbers = numbers.clone();
        numbers.insert(symbol, size.copysign(amplitude));
        frequency_squared_along(oscillator, solution, &numbers, &known).unwrap_or(f64::NAN)
    };
    let mut places: Vec<f64> = (1..=STEPS)
        .map(|k| farthest * (k as f64 / STEPS as f64).powi(2))
        .chain(reach::places_of_law(solution, numbers, amplitude.signum() * farthest))
        .collect();
    places.sort_by(f64::total_cmp);
    let (mut before, mut value_before) = (1e-9 * amplitude.abs(), squared(1e-9 * amplitude.abs()));
    let reference = squared(1e-3 * amplitude.abs()).abs();
    for place in places {
        let value = squared(place);
        // A law that has underflowed has no zero there.
        if value == 0.0 && value_before < 1e-100 * reference {
            return None;
        }
        if value_before > 0.0 && value <= 0.0 {
            let Ok(zero) = find_root(squared, before, place) else {
                return None;
            };
            // A sign change by way of infinity is a pole: towards it the values grow, towards a
            // zero they shrink.
            let size = |distance: f64| squared(zero * (1.0 - distance)).abs();
            let is_pole = size(1e-9) > 10.0 * size(1e-6);
            let at = significant(zero.copysign(amplitude), 6);
            return Some(Range {
                text: match is_pole {
                    true => format!("the formula has a pole at {symbol} = {at}"),
                    false => format!(
                        "{} of the formula reaches zero at {symbol} = {at}",
                        of_frequency(law_name(solution))
                    ),
                },
                outside: amplitude.abs() >= zero,
            });
        }
        if value > 0.0 {
            (before, value_before) = (place, value);
        }
    }
    None
}
