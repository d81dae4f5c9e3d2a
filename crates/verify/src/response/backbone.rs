//! Backbones: the frequency of the free motion without damping against its amplitude, about every
//! stable equilibrium.
//!
//! ```text
//! X(theta) = a_0 + a cos theta + a_2 cos(2 theta) + ...,   R(a_0, omega, a_2, ..., a_H) = 0 for the given a
//! ```
//!
//! The resonance peak bends along it. In: an oscillator without drive and damping, the frequency of
//! the drive as an expression in the parameter that varies. Out: the parameter at which the free
//! motion has the frequency of the drive, for amplitudes from small to large; by the same balance as
//! that of the driven motion, with the frequency as an unknown, or by Taylor series where the driven
//! motion is found by shooting.

use nalgebra::{DMatrix, DVector};

use super::ResponseError;
use super::balance::DrivenBalance;
use super::driven::Driven;
use super::free_swing::FreeSwings;
use crate::expr::Expr;
use crate::numeric::balance::CONVERGED;
use crate::oscillator::Oscillator;

/// A free motion without damping.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct BackbonePoint {
    /// The value of the parameter at which it has the frequency of the drive over `periods`.
    pub parameter: f64,
    /// The amplitude of its first harmonic.
    pub amplitude: f64,
}

/// Number of amplitudes of a curve.
const POINTS: usize = 120;

/// The backbones of an oscillator about its equilibria, as far as they lie in the range; of two
/// mirrored equilibria only one is listed. `size` is the largest amplitude of interest; `by_series`
/// says that the free motion is found by its Taylor series, if it has one.
///
/// # Errors
/// A force that cannot be differentiated.
pub fn backbones(
    oscillator: &Oscillator,
    driven: &Driven,
    (harmonics, by_series): (usize, bool),
    range: [f64; 2],
    size: f64,
) -> Result<Vec<Vec<BackbonePoint>>, ResponseError> {
    let Some(free) = free_oscillator(oscillator) else {
        return Ok(vec![]);
    };
    let is_size = size > 0.0 && size.is_finite();
    if !is_size || !driven.frequency.contains(driven.parameter) {
        return Ok(vec![]);
    }
    if free.force.contains(driven.parameter) {
        return Ok(vec![]);
    }
    let swings = by_series.then(|| FreeSwings::new(&free, driven.parameter)).flatten();
    let free =
        Driven::of_frequency(&free, driven.frequency.clone(), driven.parameter, driven.periods)?;
    let balance = DrivenBalance::new(&free, harmonics);
    let mut curves: Vec<Vec<BackbonePoint>> = Vec::new();
    for place in places_of_rest(&free, range[0], size) {
        let curve = match &swings {
            Some(swings) => curve_by_series(swings, &free, place, range, size),
            None => curve(&balance, place, range, size),
        };
        let same = |other: &Vec<BackbonePoint>| {
            other.len() == curve.len()
                && other.iter().zip(&curve).all(|(one, two)| {
                    (one.parameter - two.parameter).abs() <= 1e-6 * (range[1] - range[0])
                        && (one.amplitude - two.amplitude).abs() <= 1e-6 * size
                })
        };
        if curve.len() > 1 && !curves.iter().any(same) {
            curves.push(curve);
        }
    }
    Ok(curves)
}

/// The oscillator without damping and drive; `None` if its force has no such parts. Of a contact whose force
/// depends on place and velocity in one term, as `K*p^n*max(1 + lambda*x', 0)`, its force at rest is left.
pub(super) fn free_oscillator(oscillator: &Oscillator) -> Option<Oscillator> {
    let parts = oscillator.parts().ok()?;
    let (place, velocity) = (oscillator.coordinate, oscillator.velocity());
    let at_rest = |term: &Expr| {
        term.contains(place).then(|| term.substitute(velocity, &Expr::zero()).ok())?
    };
    let held: Vec<Expr> = parts.damping.terms().iter().filter_map(at_rest).collect();
    let force = Expr::sum([vec![parts.restoring, parts.inertia], held].concat());
    Some(Oscillator { force, ..oscillator.clone() })
}

/// The stable equilibria nearest to zero.
pub(super) fn places_of_rest(driven: &Driven, parameter: f64, size: f64) -> Vec<f64> {
    const CELLS: i32 = 400;
    const REACH: f64 = 3.0;
    const MOST: usize = 3;
    const PHASES: u32 = 16;
    let mean_force = driven.mean_force(parameter, PHASES);
    // The grid is shifted by half a cell, so that zero lies inside a cell.
    let place = |cell: i32| REACH * size * (f64::from(cell) + 0.5) / f64::from(CELLS);
    let forces: Vec<f64> = (-CELLS..=CELLS).map(|cell| mean_force(place(cell))).collect();
    let mut found: Vec<f64> = (-CELLS..CELLS)
        .zip(forces.windows(2))
        .filter(|(_, pair)| pair[0] < 0.0 && pair[1] > 0.0)
        .map(|(cell, _)| cell)
        .filter_map(|cell| {
            crate::numeric::ode::root::find_root(&mean_force, place(cell), place(cell + 1)).ok()
        })
        .collect();
    found.sort_by(|one, other| one.abs().total_cmp(&other.abs()).then(other.total_cmp(one)));
    found.truncate(MOST);
    found
}

/// The distance from zero of the farthest equilibrium, stable or not, within four sizes or four units; zero if there is
/// none. A motion that leaves its well is at least as large.
pub(super) fn farthest_rest(driven: &Driven, parameter: f64, size: f64) -> f64 {
    const CELLS: i32 = 64;
    const REACH: f64 = 4.0;
    const PHASES: u32 = 8;
    let mean_force = driven.mean_force(parameter, PHASES);
    let place = |cell: i32| REACH * size.max(1.0) * (f64::from(cell) + 0.5) / f64::from(CELLS);
    let forces: Vec<f64> = (-CELLS..=CELLS).map(|cell| mean_force(place(cell))).collect();
    let zeros = (-CELLS..CELLS)
        .zip(forces.windows(2))
        .filter(|(_, pair)| pair[0] * pair[1] < 0.0)
        .map(|(cell, _)| place(cell).abs().min(place(cell + 1).abs()));
    // The cell about zero has its zero inside.
    zeros.fold(0.0, f64::max)
}

/// The distance from zero at which the mean force differs from its linear part by half of that: the size of
/// motions whose frequency depends on it. Zero if there is none up to 1e4, or no linear part.
pub(super) fn nonlinear_size(driven: &Driven, parameter: f64) -> f64 {
    const PHASES: u32 = 8;
    const DIFFERENCE: f64 = 0.5;
    /// Distances in a decade, and the powers of ten of the first and the last one.
    const EACH: i32 = 8;
    const DECADES: [i32; 2] = [-4, 4];
    let mean_force = driven.mean_force(parameter, PHASES);
    let place = |index: i32| 10.0_f64.powf(f64::from(index) / f64::from(EACH));
    let [odd, even] = [1.0, -1.0].map(|sign| {
        let mean_force = &mean_force;
        move |x: f64| 0.5 * (mean_force(x) - sign * mean_force(-x))
    });
    let [first, last] = DECADES.map(|power| power * EACH);
    let nearest = place(first);
    let (stiffness, offset) = (odd(nearest) / nearest, mean_force(0.0));
    let is_nonlinear = |x: &f64| {
        let linear = stiffness * x;
        let differs = (odd(*x) - linear).abs().max((even(*x) - offset).abs());
        differs >= DIFFERENCE * linear.abs()
    };
    let distance = (first..=last).map(place).find(is_nonlinear);
    distance.filter(|x| *x > nearest).unwrap_or(0.0)
}

/// The points of one curve that lie in the range.
fn curve(balance: &DrivenBalance, place: f64, range: [f64; 2], size: f64) -> Vec<BackbonePoint> {
    let mut points = Vec::new();
    let mut last: Option<(DVector<f64>, f64)> = None;
    for index in 1..=POINTS {
        let amplitude = size * index as f64 / POINTS as f64;
        let guess = match &last {
            Some((coefficients, parameter)) => {
                let mut guess = coefficients.clone();
                guess[1] = amplitude;
                Some((guess, *parameter))
            }
            None => first_guess(balance, place, amplitude, range),
        };
        let Some((guess, parameter)) = guess else {
            continue;
        };
        match solved(balance, guess, parameter) {
            Some((coefficients, parameter)) => {
                points.push(BackbonePoint { parameter, amplitude });
                last = Some((coefficients, parameter));
            }
            // A motion that leaves its well has no neighbour beyond.
            None if last.is_some() => break,
            None => {}
        }
    }
    points.retain(|point| (range[0]..=range[1]).contains(&point.parameter));
    points
}

/// The points of one curve that lie in the range, by Taylor series.
fn curve_by_series(
    swings: &FreeSwings,
    free: &Driven,
    place: f64,
    range: [f64; 2],
    size: f64,
) -> Vec<BackbonePoint> {
    let mut points = Vec::new();
    let mut known: Vec<(f64, f64)> = Vec::new();
    for index in 1..=POINTS {
        let amplitude = size * index as f64 / POINTS as f64;
        match swings.frequency_at(place, amplitude, &known) {
            Some((frequency, below)) => {
                let parameter = parameter_with(free, frequency, range);
                points.extend(parameter.map(|parameter| BackbonePoint { parameter, amplitude }));
                known.push((amplitude, below));
            }
            // A motion that leaves its well has no neighbour beyond.
            None if !known.is_empty() => break,
            None => {}
        }
    }
    points.retain(|point| (range[0]..=range[1]).contains(&point.parameter));
    points
}

/// The parameter at which the frequency is this one; `None` if Newton's method does not find it.
fn parameter_with(driven: &Driven, frequency: f64, range: [f64; 2]) -> Option<f64> {
    let mut parameter = 0.5 * (range[0] + range[1]);
    for _ in 0..20 {
        let step = (driven.frequency_at(parameter) - frequency) / driven.frequency_slope(parameter);
        parameter -= step;
        if !parameter.is_finite() {
            return None;
        }
    }
    Some(parameter)
}

/// The motion of one harmonic about an equilibrium, with the frequency by the first harmonic of the
/// force.
fn first_guess(
    balance: &DrivenBalance,
    place: f64,
    amplitude: f64,
    range: [f64; 2],
) -> Option<(DVector<f64>, f64)> {
    const PHASES: u32 = 64;
    let driven = balance.driven;
    let mut sum = 0.0;
    for phase in 0..PHASES {
        let theta = std::f64::consts::TAU * f64::from(phase) / f64::from(PHASES);
        sum += driven.force(&[place + amplitude * theta.cos(), 0.0, theta, range[0]]) * theta.cos();
    }
    let square = 2.0 * sum / f64::from(PHASES) / amplitude;
    if square.is_nan() || square <= 0.0 {
        return None;
    }
    let parameter = parameter_with(driven, square.sqrt(), range)?;
    let mut coefficients = DVector::zeros(balance.core.size());
    coefficients[0] = place;
    coefficients[1] = amplitude;
    Some((coefficients, parameter))
}

/// Newton's method for the mean, the parameter and the higher cosines, the first being given.
fn solved(
    balance: &DrivenBalance,
    mut coefficients: DVector<f64>,
    mut parameter: f64,
) -> Option<(DVector<f64>, f64)> {
    const MOST: usize = 30;
    let count = balance.core.harmonics + 1;
    // The index of the cosine of a harmonic among the coefficients.
    let cosine = |harmonic: usize| if harmonic == 0 { 0 } else { 2 * harmonic - 1 };
    for _ in 0..MOST {
        let linear = balance.linearised(&coefficients, parameter)?;
        let matrix = DMatrix::from_fn(count, count, |row, column| match column {
            1 => linear.jacobian[(cosine(row), balance.core.size())],
            _ => linear.jacobian[(cosine(row), cosine(column))],
        });
        let right = DVector::from_fn(count, |row, _| linear.residual[cosine(row)]);
        let step = matrix.lu().solve(&right)?;
        for harmonic in (0..count).filter(|harmonic| *harmonic != 1) {
            coefficients[cosine(harmonic)] -= step[harmonic];
        }
        parameter -= step[1];
        let size = coefficients.norm();
        let frequency = balance.driven.frequency_at(parameter);
        if !size.is_finite() || !parameter.is_finite() || frequency.is_nan() || frequency <= 0.0 {
            return None;
        }
        let moved = step.iter().enumerate().filter(|(index, _)| *index != 1);
        let moved = moved.fold(0.0_f64, |most, (_, part)| most.max(part.abs()));
        if moved <= CONVERGED * size && step[1].abs() <= CONVERGED * parameter.abs() {
            return Some((coefficients, parameter));
        }
    }
    None
}
