//! omega and the motion of an answer at given numbers, whatever kind of law it has.
//!
//! Polynomials, implicit relations and closed forms are evaluated; a balance of harmonics, a law that is an integral, the
//! exact motion and the choice of hbar in homotopy analysis are solved for.

use std::collections::BTreeMap;

use num_traits::One;

use super::{energy_balance, harmonic_balance, homotopy_analysis, one_term};
use crate::conservative::is_odd;
use crate::exact::{Integer, Polynomial};
use crate::ode::root::find_minimum;
use crate::oscillator::Oscillator;
use crate::period;
use crate::series::FourierSeries;
use crate::solution::{AmplitudeConvention, Method, Solution};
use crate::symbol::Symbol;

/// An answer in numbers.
#[derive(Clone, Debug)]
pub struct Numbers {
    /// omega^2, of either sign.
    pub frequency_squared: f64,
    /// The motion in theta; `None` where the frequency is not real.
    pub motion: Option<FourierSeries<f64>>,
    /// Values that were chosen or solved for: hbar, the coefficients of a balance.
    pub chosen: Vec<(Symbol, f64)>,
}

/// omega^2 and the motion of `solution`, an answer for `oscillator`, with `numbers` for the parameters and the amplitude;
/// `None` where there are none.
pub fn evaluate(oscillator: &Oscillator, solution: &Solution, numbers: &BTreeMap<Symbol, f64>) -> Option<Numbers> {
    let mut chosen = Vec::new();
    let mut numbers = numbers.clone();
    let hbar = Symbol::new(homotopy_analysis::HBAR);
    if solution.method == Method::HomotopyAnalysis && !numbers.contains_key(&hbar) && contains(solution, hbar) {
        let value = best_hbar(oscillator, solution, &numbers, hbar)?;
        numbers.insert(hbar, value);
        chosen.push((hbar, value));
    }
    let solved = |(frequency_squared, motion): (f64, FourierSeries<f64>)| Numbers {
        frequency_squared,
        chosen: balanced(solution, &motion),
        motion: (frequency_squared > 0.0).then_some(motion),
    };
    if solution.system.is_some() || solution.by_quadrature.is_some() {
        return solve(oscillator, solution, &numbers).map(solved);
    }
    if solution.method == Method::Exact {
        let squared = frequency_squared(solution, &numbers)?;
        let motion = (squared > 0.0)
            .then(|| exact_motion(oscillator, solution, &numbers))
            .flatten();
        return Some(Numbers {
            frequency_squared: squared,
            motion: motion.map(|found| found.1),
            chosen,
        });
    }
    let squared = frequency_squared(solution, &numbers).filter(|value| value.is_finite())?;
    let motion = formula_motion(solution, &numbers, squared);
    Some(Numbers {
        frequency_squared: squared,
        motion,
        chosen,
    })
}

/// The coefficients of a balance, by their names; the equilibrium is no part of the mean.
fn balanced(solution: &Solution, motion: &FourierSeries<f64>) -> Vec<(Symbol, f64)> {
    if solution.method != Method::HarmonicBalance {
        return vec![];
    }
    let equilibrium = solution.equilibrium.evaluate(&BTreeMap::new()).unwrap_or(0.0);
    let named = |(k, cosine, _): (usize, Polynomial, Polynomial)| {
        let name = cosine.symbols().into_iter().next()?;
        let value = motion.cosine(k).mean().0;
        Some((name, if k == 0 { value - equilibrium } else { value }))
    };
    solution
        .displacement
        .harmonics()
        .into_iter()
        .filter_map(named)
        .collect()
}

/// omega^2 alone, without the motion where that costs more.
pub fn frequency_squared_of(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Option<f64> {
    match (solution.method, &solution.by_quadrature) {
        (Method::Exact, None) => frequency_squared(solution, numbers),
        _ => evaluate(oscillator, solution, numbers).map(|found| found.frequency_squared),
    }
}

fn contains(solution: &Solution, symbol: Symbol) -> bool {
    let laws = solution.frequency.iter().chain(&solution.frequency_squared);
    laws.into_iter().any(|law| law.symbols().contains(&symbol))
        || solution
            .displacement
            .harmonics()
            .iter()
            .any(|entry| entry.1.symbols().contains(&symbol))
}

/// Laws of one term are written for positive amplitudes: a negative one is half a period away.
fn by_size(solution: &Solution) -> bool {
    solution.relation.is_none()
        && solution.amplitude == AmplitudeConvention::Initial
        && !matches!(
            solution.method,
            Method::Pade | Method::HomotopyPerturbation | Method::HomotopyAnalysis | Method::LindstedtPoincare
        )
}

fn frequency_squared(solution: &Solution, numbers: &BTreeMap<Symbol, f64>) -> Option<f64> {
    let amplitude = solution.amplitude.symbol();
    // The quadratic force alone has an exact law that knows the sign of A, by eps*A.
    let sized = by_size(solution) && (solution.method != Method::Exact || odd_equation(solution));
    solution.frequency_squared_at(&|symbol| {
        let value = numbers.get(&symbol).copied()?;
        Some(if sized && symbol == amplitude {
            value.abs()
        } else {
            value
        })
    })
}

/// Whether the equation changes its sign with the coordinate.
fn odd_equation(solution: &Solution) -> bool {
    Oscillator::parse(&solution.equation)
        .ok()
        .is_some_and(|oscillator| is_odd(&oscillator.force, oscillator.coordinate).unwrap_or(false))
}

/// The motion by the formula, in theta; implicit methods write it with `omega`.
fn formula_motion(solution: &Solution, numbers: &BTreeMap<Symbol, f64>, squared: f64) -> Option<FourierSeries<f64>> {
    if squared <= 0.0 {
        return None;
    }
    let (omega, amplitude) = (Symbol::new("omega"), solution.amplitude.symbol());
    let turned = by_size(solution) && numbers.get(&amplitude).is_some_and(|value| *value < 0.0);
    let value = |symbol| {
        if symbol == omega {
            return Some(squared.sqrt());
        }
        let value = numbers.get(&symbol).copied()?;
        Some(if turned && symbol == amplitude { -value } else { value })
    };
    let motion = solution.motion(&value).ok()?;
    if !turned {
        return Some(motion);
    }
    let half_a_period = |k: usize, value: f64| if k % 2 == 1 { -value } else { value };
    Some(motion.by_harmonic(half_a_period))
}

/// What has to be solved: balances, integrals, the exact motion.
fn solve(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Option<(f64, FourierSeries<f64>)> {
    if solution.method == Method::Exact {
        return exact_motion(oscillator, solution, numbers);
    }
    let equilibrium = solution.equilibrium.evaluate(numbers).ok()?;
    let amplitude = *numbers.get(&solution.amplitude.symbol())?;
    let force = one_term::compiled(oscillator, &oscillator.force, numbers)?;
    let about = |y: f64| force(equilibrium + y);
    let (squared, motion) = match solution.method {
        Method::HarmonicBalance => {
            let slope = oscillator.force.differentiate(oscillator.coordinate).ok()?;
            let slope = one_term::compiled(oscillator, &slope, numbers)?;
            let odd = solution.displacement.harmonics().iter().all(|entry| entry.0 % 2 == 1);
            let degree = oscillator.polynomial_degree().ok().flatten();
            let found = harmonic_balance::balance(
                &about,
                &|y| slope(equilibrium + y),
                degree,
                odd,
                solution.order,
                amplitude,
            )?;
            (found.frequency_squared, found.motion)
        }
        Method::EnergyBalance => {
            let size = amplitude.abs();
            let squared = energy_balance::by_quadrature(&about, size)?;
            (
                squared,
                FourierSeries::from_parts(vec![0.0, amplitude], vec![], Integer::one()),
            )
        }
        _ => {
            let size = amplitude.abs();
            let squared = one_term::coefficient_by_quadrature(&about, size, 1).0 / size;
            (
                squared,
                FourierSeries::from_parts(vec![0.0, amplitude], vec![], Integer::one()),
            )
        }
    };
    let shift = FourierSeries::constant(equilibrium, Integer::one());
    squared.is_finite().then(|| (squared, motion.sum(&shift)))
}

/// omega^2 and the motion by quadrature of the energy.
fn exact_motion(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
) -> Option<(f64, FourierSeries<f64>)> {
    let equilibrium = solution.equilibrium.evaluate(numbers).ok()?;
    let amplitude = *numbers.get(&solution.amplitude.symbol()).unwrap_or(&1.0);
    let force = one_term::compiled(oscillator, &oscillator.force, numbers)?;
    let (period, cosine) = period::conservative_motion(&force, equilibrium, equilibrium + amplitude).ok()?;
    let frequency = std::f64::consts::TAU / period;
    Some((
        frequency * frequency,
        FourierSeries::from_parts(cosine, vec![], Integer::one()),
    ))
}

/// The hbar between -2 and 0 at which the squared residual of the original equation is least.
fn best_hbar(
    oscillator: &Oscillator,
    solution: &Solution,
    numbers: &BTreeMap<Symbol, f64>,
    hbar: Symbol,
) -> Option<f64> {
    const TRIALS: usize = 40;
    const SAMPLES: usize = 64;
    let force = one_term::compiled(oscillator, &oscillator.force, numbers)?;
    let squared_residual = |value: f64| {
        let mut numbers = numbers.clone();
        numbers.insert(hbar, value);
        let squared = frequency_squared(solution, &numbers).unwrap_or(f64::NAN);
        let Some(motion) = formula_motion(solution, &numbers, squared) else {
            return f64::INFINITY;
        };
        let acceleration = motion.derivative().derivative();
        let defect = |k: usize| {
            let theta = std::f64::consts::PI * (k as f64 + 0.5) / SAMPLES as f64;
            squared * acceleration.evaluate(theta) + force(motion.evaluate(theta))
        };
        let sum: f64 = (0..SAMPLES).map(|k| defect(k).powi(2)).sum();
        if sum.is_finite() { sum } else { f64::INFINITY }
    };
    let place = |k: usize| -2.0 * k as f64 / TRIALS as f64;
    let best = (1..=TRIALS).min_by(|&a, &b| squared_residual(place(a)).total_cmp(&squared_residual(place(b))))?;
    let (value, least) = find_minimum(squared_residual, place(best + 1), place(best - 1));
    least.is_finite().then_some(value)
}
