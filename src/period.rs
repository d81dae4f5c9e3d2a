//! The true frequency, by ways that share nothing with the formulas.
//!
//! Conservative motion (L. D. Landau and E. M. Lifshitz, *Mechanics*, 3rd ed., section 11): between the turning points `x_0`
//! and `x_1`, with `U(x) = V(x_0) - V(x)`,
//!
//! ```text
//! T = 2 int dx / sqrt(2 U),   x = m + r sin phi,   U = (x_0 - x)(x - x_1) g(x)   ->   T = 2 int dphi / sqrt(2 g)
//! ```
//!
//! The last integrand is smooth. `U` near either end is the mean of the force from there, so nothing cancels.
//!
//! Any other periodic motion: the Runge-Kutta return to a turning point.

use crate::ode::quadrature::{QuadratureError, integrate_smooth, nodes_and_weights};
use crate::ode::root::{RootError, find_root};
use crate::ode::{Event, IntegrationError, Options, State, StopReason, Trajectory, integrate};

/// Relative tolerance of the quadratures.
const TOLERANCE: f64 = 1e-14;

/// Tolerance per step of the Runge-Kutta runs that find a return.
const STEP_TOLERANCE: f64 = 1e-13;

/// Why there is no period.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PeriodError {
    /// Released there, the motion leaves instead of swinging.
    #[error(
        "no periodic motion about x = {equilibrium}: released at rest from x = {start}, the force does not pull back there"
    )]
    PushedAway {
        /// The release point.
        start: f64,
        /// The equilibrium.
        equilibrium: f64,
    },
    /// The motion turns before it reaches the equilibrium.
    #[error(
        "no motion about x = {equilibrium}: released at rest from x = {start} it turns back before it gets there, and swings about another equilibrium"
    )]
    OtherWell {
        /// The release point.
        start: f64,
        /// The equilibrium.
        equilibrium: f64,
    },
    /// No second turning point.
    #[error(
        "no periodic motion: released at rest from x = {start}, the motion does not turn back before x = {searched}"
    )]
    Escapes {
        /// The release point.
        start: f64,
        /// How far the search went.
        searched: f64,
    },
    /// The motion did not come back within the time allowed.
    #[error("no return to a turning point within t = {0}")]
    NoReturn(f64),
    /// A quadrature failed.
    #[error(transparent)]
    Quadrature(#[from] QuadratureError),
    /// A root was lost.
    #[error(transparent)]
    Root(#[from] RootError),
    /// The integration failed.
    #[error(transparent)]
    Integration(#[from] IntegrationError),
}

/// The period of `x'' + force(x) = 0` released at rest from `start`, swinging about `equilibrium`.
///
/// # Errors
/// See [`PeriodError`].
pub fn conservative_period(force: &dyn Fn(f64) -> f64, equilibrium: f64, start: f64) -> Result<f64, PeriodError> {
    let end = turning_point(force, equilibrium, start)?;
    let mut failure = None;
    let integrand = |phi: f64| match time_per_angle(force, start, end, phi) {
        Ok(value) => value,
        Err(error) => {
            failure = Some(error);
            f64::NAN
        }
    };
    let quarter = std::f64::consts::FRAC_PI_2;
    match integrate_smooth(integrand, -quarter, quarter, TOLERANCE) {
        Ok((half, _)) => Ok(2.0 * half),
        // The force itself is rounded where it is a small difference, as x^2 - 4 near x = 2: no panel gets below that.
        Err(QuadratureError::NotConverged {
            value, error_estimate, ..
        }) if error_estimate < 1e-9 * value => Ok(2.0 * value),
        Err(error) => Err(failure.unwrap_or(error).into()),
    }
}

/// `dt/dphi = 1/sqrt(2 g)` of the substitution above.
fn time_per_angle(force: &dyn Fn(f64) -> f64, start: f64, end: f64, phi: f64) -> Result<f64, QuadratureError> {
    let mean_force = |from: f64, to: f64| integral(&|u| force(from + (to - from) * u), 0.0, 1.0);
    let x = 0.5 * (start + end) + 0.5 * (start - end) * phi.sin();
    let quotient = if phi >= 0.0 {
        mean_force(x, start)? / (x - end)
    } else {
        -mean_force(end, x)? / (start - x)
    };
    Ok(1.0 / (2.0 * quotient).sqrt())
}

/// The period of a conservative motion released at rest from `start`, and the coefficients of `cos(k theta)` of the motion.
///
/// With `psi = pi/2 - phi` the rate `h = dt/dpsi` is an even, periodic function: its cosine series gives `omega t(psi)`, and
/// sums over equal steps in `psi` give the coefficients, both to spectral accuracy for a smooth force.
///
/// # Errors
/// See [`PeriodError`].
pub fn conservative_motion(
    force: &dyn Fn(f64) -> f64,
    equilibrium: f64,
    start: f64,
) -> Result<(f64, Vec<f64>), PeriodError> {
    weighted_motion(force, &|_| 1.0, equilibrium, start)
}

/// As [`conservative_motion`] where the energy is `M x'^2/2 + U`: `force` is `U'` and `weight` the root of `M`, by which
/// every instant takes longer.
///
/// # Errors
/// See [`PeriodError`].
pub fn weighted_motion(
    force: &dyn Fn(f64) -> f64,
    weight: &dyn Fn(f64) -> f64,
    equilibrium: f64,
    start: f64,
) -> Result<(f64, Vec<f64>), PeriodError> {
    const FEWEST: usize = 64;
    const MOST: usize = 1024;
    const HARMONICS: usize = 64;
    let end = turning_point(force, equilibrium, start)?;
    let pi = std::f64::consts::PI;
    let (mut points, mut last) = (FEWEST, f64::INFINITY);
    loop {
        let angle = |i: usize| pi * (i as f64 + 0.5) / points as f64;
        let rates: Vec<f64> = (0..points)
            .map(|i| {
                let x = 0.5 * (start + end) + 0.5 * (start - end) * angle(i).cos();
                time_per_angle(force, start, end, 0.5 * pi - angle(i)).map(|rate| rate * weight(x))
            })
            .collect::<Result<_, _>>()?;
        let mean = rates.iter().sum::<f64>() / points as f64;
        let settled = (mean - last).abs() <= 1e-13 * mean;
        if !settled && points < MOST {
            (points, last) = (2 * points, mean);
            continue;
        }
        let kept = points / 2;
        let rate_coefficients: Vec<f64> = (1..kept)
            .map(|j| {
                let sum: f64 = rates
                    .iter()
                    .enumerate()
                    .map(|(i, rate)| rate * (j as f64 * angle(i)).cos())
                    .sum();
                2.0 * sum / points as f64
            })
            .collect();
        let theta = |psi: f64| {
            let waves = rate_coefficients
                .iter()
                .zip(1..)
                .map(|(rate, j)| rate * (f64::from(j) * psi).sin() / f64::from(j));
            psi + waves.sum::<f64>() / mean
        };
        let mut coefficients = vec![0.0; HARMONICS];
        for (i, rate) in rates.iter().enumerate() {
            let psi = angle(i);
            let (x, theta) = (0.5 * (start + end) + 0.5 * (start - end) * psi.cos(), theta(psi));
            for (k, coefficient) in coefficients.iter_mut().enumerate() {
                let weight = if k == 0 { 1.0 } else { 2.0 } / points as f64;
                *coefficient += weight * x * (k as f64 * theta).cos() * rate / mean;
            }
        }
        return Ok((2.0 * pi * mean, coefficients));
    }
}

/// The integral of a force: panels are doubled until the value settles, or until doubling no longer brings it closer,
/// which is where the rounding of the force itself begins.
fn integral(function: &dyn Fn(f64) -> f64, from: f64, to: f64) -> Result<f64, QuadratureError> {
    const MOST_PANELS: i32 = 64;
    let with_panels = |panels: i32| {
        let place = |k: i32| from + (to - from) * f64::from(k) / f64::from(panels);
        let nodes = (0..panels).flat_map(|k| nodes_and_weights(place(k), place(k + 1)));
        nodes.map(|(x, weight)| weight * function(x)).sum::<f64>()
    };
    let (mut value, mut change) = (with_panels(1), f64::INFINITY);
    let mut panels = 2;
    while panels <= MOST_PANELS {
        let finer = with_panels(panels);
        let next = (finer - value).abs();
        if next <= TOLERANCE * finer.abs() || (next >= 0.5 * change && next <= 1e-9 * finer.abs()) {
            return Ok(finer);
        }
        (value, change) = (finer, next);
        panels *= 2;
    }
    match integrate_smooth(function, from, to, TOLERANCE) {
        // Where pull and push cancel, the integral is as good as the forces in it allow.
        Err(QuadratureError::NotConverged {
            value, error_estimate, ..
        }) if error_estimate <= TOLERANCE * size(function, from, to) => Ok(value),
        result => result.map(|(value, _)| value),
    }
}

/// The integral of the size of a function, roughly.
fn size(function: &dyn Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let nodes = nodes_and_weights(from, to);
    nodes.map(|(x, weight)| (weight * function(x)).abs()).sum()
}

/// The other turning point of a conservative motion released at rest from `start`.
///
/// # Errors
/// See [`PeriodError`].
pub fn turning_point(force: &dyn Fn(f64) -> f64, equilibrium: f64, start: f64) -> Result<f64, PeriodError> {
    /// Steps per amplitude of the search, and how many amplitudes far it goes.
    const STEPS_PER_AMPLITUDE: f64 = 64.0;
    const FARTHEST: f64 = 1e4;
    let amplitude = start - equilibrium;
    if force(start) * amplitude <= 0.0 {
        return Err(PeriodError::PushedAway { start, equilibrium });
    }
    // In a symmetric well the mirror image is the turning point to the last digit, which no root finder gives near a
    // separatrix.
    let odd = (1..=16).map(|k| amplitude * f64::from(k) / 16.0);
    if odd
        .into_iter()
        .all(|x| force(equilibrium + x) == -force(equilibrium - x) && force(equilibrium + x) * amplitude > 0.0)
    {
        return Ok(equilibrium - amplitude);
    }
    let gained = |from: f64, to: f64| integral(force, to, from);
    let (mut x, mut energy, mut step) = (start, 0.0, -amplitude / STEPS_PER_AMPLITUDE);
    while (x - equilibrium).abs() < FARTHEST * amplitude.abs() {
        let next = x + step;
        let after = energy + gained(x, next)?;
        if after <= 0.0 {
            let mut failure = None;
            let root = find_root(
                |candidate| match gained(x, candidate) {
                    Ok(gain) => energy + gain,
                    Err(error) => {
                        failure = Some(error);
                        f64::NAN
                    }
                },
                x,
                next,
            );
            let end = root.map_err(|error| failure.map_or(error.into(), PeriodError::from))?;
            return match (end - equilibrium) * amplitude > 0.0 {
                true => Err(PeriodError::OtherWell { start, equilibrium }),
                false => Ok(end),
            };
        }
        (x, energy) = (next, after);
        // Past the mirror image of the start the search may widen its steps.
        if (x - equilibrium).abs() > 2.0 * amplitude.abs() {
            step *= 1.05;
        }
    }
    Err(PeriodError::Escapes { start, searched: x })
}

/// One full swing by Runge-Kutta: from rest at `start` to the next turning point on the same side.
///
/// # Errors
/// See [`PeriodError`].
pub fn swing(
    acceleration: &dyn Fn(f64, f64, f64) -> f64,
    equilibrium: f64,
    start: f64,
    longest: f64,
) -> Result<Trajectory, PeriodError> {
    let state = State {
        t: 0.0,
        x: start,
        v: 0.0,
    };
    let turning = Event::stop(|_, _, v| v);
    let turning = if start > equilibrium {
        turning.falling()
    } else {
        turning.rising()
    };
    let path = integrate(
        acceleration,
        state,
        longest,
        &[turning],
        &Options::with_tolerance(STEP_TOLERANCE),
    )?;
    match path.stop_reason() {
        StopReason::Event { .. } => Ok(path),
        _ => Err(PeriodError::NoReturn(path.end().t)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pendulum_and_duffing_by_elliptic_functions() {
        for amplitude in [0.01, 0.5, 1.5, 2.5, 3.0, 3.13, -1.5] {
            let period = conservative_period(&|x: f64| x.sin(), 0.0, amplitude).unwrap();
            // By the complementary parameter 1 - m = cos^2(A/2): near the separatrix m itself has lost its digits.
            let exact = 4.0 * spec_math::cephes64::ellpk((0.5 * amplitude).cos().powi(2));
            assert!(
                (period / exact - 1.0).abs() < 1e-13,
                "A = {amplitude}: {period} {exact}"
            );
        }
        for s in [-0.9, 0.1, 1.0, 10.0, 1000.0] {
            let period = conservative_period(&|x: f64| x + s * x * x * x, 0.0, 1.0).unwrap();
            let exact = 4.0 * ellip::ellipk(s / (2.0 * (1.0 + s))).unwrap() / f64::sqrt(1.0 + s);
            assert!((period / exact - 1.0).abs() < 1e-13, "s = {s}: {period} {exact}");
        }
    }

    #[test]
    fn an_uneven_well_has_its_own_turning_point() {
        // V = x^2/2 + x^3/3 at x = 1/4: V(x_1) = V(1/4) is a cubic with root 1/4, leaving a quadratic.
        let end = turning_point(&|x: f64| x + x * x, 0.0, 0.25).unwrap();
        let quadratic = |x: f64| x * x + 1.75 * x + 0.4375;
        assert!(quadratic(end).abs() < 1e-15, "{end}");
        let period = conservative_period(&|x: f64| x + x * x, 0.0, 0.25).unwrap();
        let swing = swing(&|_, x, _| -x - x * x, 0.0, 0.25, 100.0).unwrap();
        assert!((period - swing.end().t).abs() < 1e-10);
    }

    #[test]
    fn a_force_that_is_a_small_difference_is_good_to_its_rounding() {
        for amplitude in [0.3, 0.01, 1e-3] {
            let shifted = conservative_period(&|x: f64| x * x - 4.0, 2.0, 2.0 + amplitude).unwrap();
            let direct = conservative_period(&|d: f64| 4.0 * d + d * d, 0.0, amplitude).unwrap();
            assert!(
                (shifted / direct - 1.0).abs() < 1e-13 / amplitude,
                "{amplitude}: {shifted} {direct}"
            );
        }
    }

    #[test]
    fn what_does_not_swing_is_refused() {
        let cubic = |x: f64| x - x * x * x / 6.0;
        assert!(matches!(
            conservative_period(&cubic, 0.0, 2.5),
            Err(PeriodError::PushedAway { .. })
        ));
        assert!(matches!(
            conservative_period(&|x: f64| x + x * x, 0.0, 0.75),
            Err(PeriodError::Escapes { .. })
        ));
    }

    #[test]
    fn a_motion_in_another_well_is_told_from_one_over_all() {
        let wells = |x: f64| x - x.powi(3) + 0.2 * x.powi(5);
        assert!(matches!(
            conservative_period(&wells, 0.0, 2.0),
            Err(PeriodError::OtherWell { .. })
        ));
        assert!((turning_point(&wells, 0.0, 2.5).unwrap() + 2.5).abs() < 1e-14);
        let uneven = |x: f64| wells(x) + 0.01;
        assert!(matches!(
            conservative_period(&uneven, -0.01, -2.0),
            Err(PeriodError::OtherWell { .. })
        ));
    }
}
