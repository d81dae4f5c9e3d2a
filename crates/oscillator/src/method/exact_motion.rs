//! The exact motion of the method `exact`, by quadratures of its own: the period and the harmonics
//! of a motion between two turning points. With verification it shares only the integrand
//! ([`crate::numeric::ode::energy`]), not the quadrature.

use crate::conservative::force::CentredForce as RestForce;
use crate::numeric::ode::energy::{PeriodError, PiecewiseForce, TimePerAngle, turning_point};
use crate::numeric::ode::quadrature::{QuadratureError, integrate_smooth, nodes_and_weights};

/// Harmonics of the exact motion.
const HARMONICS: usize = 64;

/// The period of the motion of a force released at the distance `start` from its equilibrium, and
/// the coefficients of `cos(k theta)` of its position.
///
/// # Errors
/// See [`PeriodError`].
pub(super) fn motion_about(force: &RestForce, start: f64) -> Result<(f64, Vec<f64>), PeriodError> {
    let (period, mut cosine) = force
        .between_turning_points(start, |force, end| motion_between(force, &|_| 1.0, start, end))?;
    if let Some(mean) = cosine.first_mut() {
        *mean += force.equilibrium();
    }
    Ok((period, cosine))
}

/// The coefficients of `cos(k theta)` of a motion that is even in theta.
pub(super) fn cosines(place: &dyn Fn(f64) -> f64) -> Vec<f64> {
    const POINTS: usize = 16 * HARMONICS;
    let angle = |i: usize| std::f64::consts::PI * (i as f64 + 0.5) / POINTS as f64;
    let places: Vec<f64> = (0..POINTS).map(|i| place(angle(i))).collect();
    let coefficient = |k: usize| {
        let waves = places.iter().enumerate().map(|(i, x)| x * (k as f64 * angle(i)).cos());
        waves.sum::<f64>() * if k == 0 { 1.0 } else { 2.0 } / POINTS as f64
    };
    (0..HARMONICS).map(coefficient).collect()
}

/// The period of a motion where the energy is `M x'^2/2 + U`, released at rest from `start`, and
/// the coefficients of `cos(k theta)`: `force` is `U'`, and `weight` is the root of `M`, the factor
/// by which time is stretched at each position.
///
/// # Errors
/// See [`PeriodError`].
pub(super) fn weighted_motion(
    force: &PiecewiseForce,
    weight: &dyn Fn(f64) -> f64,
    equilibrium: f64,
    start: f64,
) -> Result<(f64, Vec<f64>), PeriodError> {
    motion_between(force, weight, start, turning_point(force, equilibrium, start)?)
}

/// The period and the coefficients of `cos(k theta)` of the motion between two turning points, the
/// first at `theta = 0`.
///
/// With `psi = pi/2 - phi` the rate `h = dt/dpsi` is an even, periodic function: its cosine series
/// gives `omega t(psi)`, and sums over equal steps in `psi` give the coefficients, both to spectral
/// accuracy for a smooth force. Where the force has corners or narrow places the same integrals are
/// taken piece by piece.
///
/// # Errors
/// See [`PeriodError`].
fn motion_between(
    force: &PiecewiseForce,
    weight: &dyn Fn(f64) -> f64,
    start: f64,
    end: f64,
) -> Result<(f64, Vec<f64>), PeriodError> {
    const FEWEST: usize = 64;
    const MOST: usize = 1024;
    let rates = TimePerAngle::new(force, weight, start, end)?;
    if rates.knots.len() > 2 {
        return motion_by_pieces(&rates);
    }
    let pi = std::f64::consts::PI;
    let (mut points, mut last) = (FEWEST, f64::INFINITY);
    loop {
        let angle = |i: usize| pi * (i as f64 + 0.5) / points as f64;
        let values: Vec<f64> = (0..points)
            .map(|i| rates.time_per_angle(0, 0.5 * pi - angle(i)))
            .collect::<Result<_, _>>()?;
        let mean = values.iter().sum::<f64>() / points as f64;
        let settled = (mean - last).abs() <= 1e-13 * mean;
        if !settled && points < MOST {
            (points, last) = (2 * points, mean);
            continue;
        }
        if (mean - last).abs() > 1e-9 * mean {
            return motion_by_pieces(&rates);
        }
        let times = EqualSteps { rates: values, mean };
        return Ok((2.0 * pi * mean, times.harmonics(0.5 * (start + end), 0.5 * (start - end))));
    }
}

/// The rates `dt/dpsi` at the middles of equal steps from `psi = 0` to `pi`, and their mean.
struct EqualSteps {
    rates: Vec<f64>,
    mean: f64,
}

impl EqualSteps {
    fn angle(&self, step: usize) -> f64 {
        std::f64::consts::PI * (step as f64 + 0.5) / self.rates.len() as f64
    }

    /// The coefficients of `cos(j psi)` of the rate, from `j = 1`.
    fn rate_coefficients(&self) -> Vec<f64> {
        let points = self.rates.len();
        let coefficient = |j: usize| {
            let terms = self.rates.iter().enumerate();
            let sum: f64 = terms.map(|(i, rate)| rate * (j as f64 * self.angle(i)).cos()).sum();
            2.0 * sum / points as f64
        };
        (1..points / 2).map(coefficient).collect()
    }

    /// The coefficients of `cos(k theta)` of `x = middle + half cos(psi)`.
    fn harmonics(&self, middle: f64, half: f64) -> Vec<f64> {
        let rate_coefficients = self.rate_coefficients();
        let theta = |psi: f64| {
            let waves = rate_coefficients
                .iter()
                .zip(1..)
                .map(|(rate, j)| rate * (f64::from(j) * psi).sin() / f64::from(j));
            psi + waves.sum::<f64>() / self.mean
        };
        let mut coefficients = vec![0.0; HARMONICS];
        for (i, rate) in self.rates.iter().enumerate() {
            let psi = self.angle(i);
            let (x, theta) = (middle + half * psi.cos(), theta(psi));
            for (k, coefficient) in coefficients.iter_mut().enumerate() {
                let weight = if k == 0 { 1.0 } else { 2.0 } / self.rates.len() as f64;
                *coefficient += weight * x * (k as f64 * theta).cos() * rate / self.mean;
            }
        }
        coefficients
    }
}

/// Period and coefficients by Gauss-Legendre panels in phi: the phase at the points of a panel is
/// the integral of the Legendre series through the rates there. The panels are halved until their
/// time agrees with the period.
fn motion_by_pieces(rates: &TimePerAngle) -> Result<(f64, Vec<f64>), PeriodError> {
    const HALVINGS: u32 = 6;
    /// The longest panel, as a phase: the highest harmonic still has few waves on it.
    const LONGEST: f64 = 0.2;
    let (end, start) = (rates.knots[0], rates.knots[rates.knots.len() - 1]);
    let period = period_by_pieces(rates)?;
    let frequency = std::f64::consts::TAU / period;
    let mut coefficients = vec![0.0; HARMONICS];
    for halving in 0..=HALVINGS {
        coefficients.fill(0.0);
        // The phase from the far turning point, where it is -pi.
        let mut phase = -std::f64::consts::PI;
        for piece in 0..rates.angles.len() - 1 {
            let [low, high] = rates.variable_range(piece);
            // The angle and the rate at a value of the variable of the piece.
            let at = |variable: f64| {
                let (phi, slope) = rates.angle_at(piece, variable);
                Ok::<_, PeriodError>((phi, slope * rates.time_per_angle(piece, phi)?))
            };
            let mut duration = 0.0;
            for (variable, weight) in nodes_and_weights(low, high) {
                duration += weight * at(variable)?.1;
            }
            let parts = (1 + (frequency * duration / LONGEST) as u32) << halving;
            let place = |part: u32| low + (high - low) * f64::from(part) / f64::from(parts);
            for part in 0..parts {
                let (from, to) = (place(part), place(part + 1));
                let nodes: Vec<(f64, f64)> = nodes_and_weights(from, to).collect();
                let found = nodes.iter().map(|node| at(node.0));
                let (angles, values): (Vec<f64>, Vec<f64>) =
                    found.collect::<Result<Vec<_>, _>>()?.into_iter().unzip();
                let elapsed = running_integral(&nodes, &values, from, to);
                let weights = nodes.iter().map(|node| node.1);
                for (((phi, rate), weight), elapsed) in
                    angles.iter().zip(&values).zip(weights).zip(elapsed)
                {
                    let theta = phase + frequency * elapsed;
                    let x = 0.5 * (start + end) + 0.5 * (start - end) * phi.sin();
                    for (k, coefficient) in coefficients.iter_mut().enumerate() {
                        let share = if k == 0 { 1.0 } else { 2.0 } / std::f64::consts::PI;
                        *coefficient +=
                            share * x * (k as f64 * theta).cos() * rate * frequency * weight;
                    }
                }
                phase += frequency
                    * nodes.iter().zip(&values).map(|(node, rate)| node.1 * rate).sum::<f64>();
            }
        }
        // At the start the phase is zero again.
        if phase.abs() < 1e-10 {
            break;
        }
    }
    Ok((period, coefficients))
}

/// The period as the sum of the times that the pieces take.
fn period_by_pieces(rates: &TimePerAngle) -> Result<f64, PeriodError> {
    /// The part of the period that its error must stay below.
    const GOOD_ENOUGH: f64 = 1e-9;
    let (mut half, mut uncertain) = (0.0, 0.0);
    for piece in 0..rates.angles.len() - 1 {
        let mut lost = None;
        let rate = |variable: f64| {
            let (phi, slope) = rates.angle_at(piece, variable);
            let rate = rates.time_per_angle(piece, phi);
            slope
                * rate.unwrap_or_else(|error| {
                    lost = Some(error);
                    f64::NAN
                })
        };
        let [from, to] = rates.variable_range(piece);
        let (time, error) = match integrate_smooth(rate, from, to, rates.tolerance(piece)) {
            // No panel can be more accurate than the rounding of the force.
            Err(QuadratureError::NotConverged { value, error_estimate, .. }) => {
                (value, error_estimate)
            }
            found => found.map_err(|error| lost.unwrap_or(error))?,
        };
        half += time;
        uncertain += error;
    }
    if uncertain < GOOD_ENOUGH * half {
        return Ok(2.0 * half);
    }
    let worst_at = rates.knots[0];
    Err(PeriodError::Quadrature(QuadratureError::NotConverged {
        value: half,
        error_estimate: uncertain,
        worst_at,
    }))
}

/// The integral from `from` to each node, through the Legendre series of the values:
/// `int P_l = (P_(l+1) - P_(l-1))/(2l+1)`.
fn running_integral(nodes: &[(f64, f64)], values: &[f64], from: f64, to: f64) -> Vec<f64> {
    let half = 0.5 * (to - from);
    // P_0 to P_n at each node.
    let legendre = |x: f64| {
        let u = (x - 0.5 * (from + to)) / half;
        let mut p = vec![1.0, u];
        for l in 1..nodes.len() {
            let l_real = l as f64;
            p.push(((2.0 * l_real + 1.0) * u * p[l] - l_real * p[l - 1]) / (l_real + 1.0));
        }
        p
    };
    let polynomials: Vec<Vec<f64>> = nodes.iter().map(|node| legendre(node.0)).collect();
    let series: Vec<f64> = (0..nodes.len())
        .map(|l| {
            let terms = nodes.iter().zip(values).zip(&polynomials);
            let sum: f64 = terms.map(|((node, value), p)| node.1 / half * value * p[l]).sum();
            0.5 * (2.0 * l as f64 + 1.0) * sum
        })
        .collect();
    let integral = |p: &Vec<f64>| {
        let higher =
            (1..nodes.len()).map(|l| series[l] * (p[l + 1] - p[l - 1]) / (2.0 * l as f64 + 1.0));
        half * (series[0] * (p[1] + 1.0) + higher.sum::<f64>())
    };
    polynomials.iter().map(integral).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mass_that_grows_outwards_slows_the_motion() {
        // (1 + x^2)*x'' + x*x'^2 + x = 0 has the energy (1 + x^2) x'^2/2 + x^2/2.
        let weight = |x: f64| (1.0 + x * x).sqrt();
        let (period, cosines) =
            weighted_motion(&PiecewiseForce::smooth(&|x| x), &weight, 0.0, 0.1).expect("a motion");
        assert!(period > std::f64::consts::TAU && (cosines.iter().sum::<f64>() - 0.1).abs() < 1e-9);
    }
}
