//! A contact as half an oscillation: homotopy, iteration and the balance of harmonics.
//!
//! In: the whole force g(d) of the depth and the speed v of touch. Out: a [`SineSeries`] of odd
//! sines, d(0) = d(T) = 0, phi = Omega s, d'(0) = v, whose duration is T = pi/Omega. With s_k(A) =
//! (2/pi) int_0^pi g(A sin phi) sin k phi dphi:
//!
//! ```text
//! homotopy            Omega^2 = s_1/A,  d = A sin phi
//! iteration           Omega^2 = s_1/A,  d = A sin phi + X/Omega^2,   X = sum_(k = 3, 5 ..) s_k (sin k phi - sigma_k sin phi)/(k^2 - 1)
//!                                       sigma_k = sin(k pi/2)
//! homotopy-2          Omega^4 - (s_1/A) Omega^2 - Q = 0, d as before, Q = (1/A) [first coefficient of (g'(A sin phi) - s_1/A) X]
//! harmonic-balance-N  k^2 Omega^2 b_k = (2/pi) int_0^pi g(d) sin k phi dphi, k = 1, 3 .. 2 N - 1,  d = sum b_k sin k phi
//! ```
//!
//! (J.-H. He, *Comput. Methods Appl. Mech. Eng.* 178 (1999) 257, *J. Vib. Control* 7 (2001) 631; A.
//! H. Nayfeh and D. T. Mook, *Nonlinear Oscillations*, 1979, section 2.3.4, for the balance.)

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{DMatrix, DVector};

use super::super::hertz::positive;
use super::{ContactError, SineSeries};
use crate::numeric::ode::quadrature::nodes_and_weights;
use crate::numeric::ode::root::find_root;

/// Harmonics kept in the motion of iteration and homotopy: to k = 15.
pub(super) const HARMONICS: usize = 8;

/// The order to which the perturbation is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PerturbationOrder {
    /// Homotopy of the first order: one sine.
    First,
    /// One pass of iteration.
    Iterated,
    /// Homotopy of the second order.
    Second,
}

/// Half an oscillation under a force of the depth, entered at this speed.
pub(super) struct HalfOscillation<'a> {
    /// g(d), the whole force in contact, per unit of mass.
    pub(super) force: &'a dyn Fn(f64) -> f64,
    /// The speed v of touch, in the unit of x per time.
    pub(super) speed: f64,
}

impl HalfOscillation<'_> {
    /// s_k(A) for k = 1, 3, ..
    fn sine_coefficients(&self, amplitude: f64) -> [f64; HARMONICS] {
        let mut coefficients = [0.0; HARMONICS];
        for (phi, weight) in quarter() {
            let force = weight * (self.force)(amplitude * phi.sin());
            for (number, coefficient) in coefficients.iter_mut().enumerate() {
                *coefficient += 4.0 / PI * force * ((2 * number + 1) as f64 * phi).sin();
            }
        }
        coefficients
    }

    /// Omega^2 and the motion by homotopy or iteration, for the amplitude that begins with the
    /// speed of touch.
    pub(super) fn perturbed(&self, order: PerturbationOrder) -> Result<SineSeries, ContactError> {
        // The square of d'(0), with a sign that is negative where the amplitude gives no
        // oscillation.
        let squared_speed = |amplitude: f64| {
            let (square, sines) = self.perturbation(amplitude, order);
            let slope = sum_of_slopes(&sines);
            square * slope * slope.abs()
        };
        let excess = |root: f64| squared_speed(root * root) / (self.speed * self.speed) - 1.0;
        let root = rising_root(excess).ok_or(ContactError::NotOscillating)?;
        let (square, harmonics) = self.perturbation(root * root, order);
        Ok(SineSeries::new(
            PI / positive("square of the frequency", square)?.sqrt(),
            0.0,
            harmonics,
        ))
    }

    fn perturbation(&self, amplitude: f64, order: PerturbationOrder) -> (f64, Vec<f64>) {
        let coefficients = self.sine_coefficients(amplitude);
        let first = coefficients[0] / amplitude;
        if order == PerturbationOrder::First {
            return (first, vec![amplitude]);
        }
        // X by its sine coefficients.
        let mut correction = [0.0; HARMONICS];
        for number in 1..HARMONICS {
            let k = (2 * number + 1) as f64;
            let part = coefficients[number] / (k * k - 1.0);
            correction[number] += part;
            correction[0] -= if number % 2 == 0 { part } else { -part };
        }
        let square = match order {
            PerturbationOrder::Second => {
                // g' X by the difference of the force along X.
                let size = correction
                    .iter()
                    .fold(f64::MIN_POSITIVE, |size: f64, term| size.max(term.abs()));
                let step = 1e-4 * amplitude / size;
                let mut change = 0.0;
                for (phi, weight) in quarter() {
                    let along = step * sine_sum(&correction, phi);
                    let depth = amplitude * phi.sin();
                    let difference = (self.force)(depth + along) - (self.force)(depth - along);
                    change += 4.0 / PI * weight * difference / (2.0 * step) * phi.sin();
                }
                let q = (change - first * correction[0]) / amplitude;
                0.5 * (first + (first * first + 4.0 * q).max(0.0).sqrt())
            }
            _ => first,
        };
        let mut sines: Vec<f64> = correction.iter().map(|term| term / square).collect();
        sines[0] += amplitude;
        (square, sines)
    }

    /// The balance of `count` odd harmonics, by Newton's method from that of one.
    pub(super) fn balanced(&self, count: usize) -> Result<SineSeries, ContactError> {
        let start = self.perturbed(PerturbationOrder::First)?;
        let (scale, frequency) = (start.harmonics[0], PI / start.duration);
        // Unknowns: harmonics in units of the amplitude of one, Omega in units of its own.
        let residual = |unknown: &DVector<f64>| {
            let omega = unknown[count];
            let sines: Vec<f64> = unknown.iter().take(count).copied().collect();
            let mut residual = DVector::zeros(count + 1);
            for (phi, weight) in quarter() {
                let force = weight * (self.force)(scale * sine_sum(&sines, phi))
                    / (scale * frequency * frequency);
                for number in 0..count {
                    residual[number] -= 4.0 / PI * force * ((2 * number + 1) as f64 * phi).sin();
                }
            }
            for number in 0..count {
                residual[number] += ((2 * number + 1) as f64 * omega).powi(2) * unknown[number];
            }
            residual[count] = omega * sum_of_slopes(&sines) - self.speed / (scale * frequency);
            residual
        };
        let mut unknown = DVector::zeros(count + 1);
        unknown[0] = 1.0;
        unknown[count] = 1.0;
        let mut size = residual(&unknown).amax();
        for _ in 0..40 {
            let step = newton_step(residual, &unknown).ok_or(ContactError::NotOscillating)?;
            // The step is halved until the residual decreases.
            let mut part = 1.0;
            let (mut next, mut next_size) = (&unknown - &step, f64::INFINITY);
            while part > 1e-3 {
                next = &unknown - &step * part;
                next_size = residual(&next).amax();
                if next_size < size {
                    break;
                }
                part *= 0.5;
            }
            if next_size.is_nan() || next_size >= size {
                break;
            }
            (unknown, size) = (next, next_size);
        }
        if size.is_nan() || size > 1e-9 || unknown[count] <= 0.0 {
            return Err(ContactError::NotOscillating);
        }
        let harmonics = unknown.iter().take(count).map(|part| scale * part).collect();
        Ok(SineSeries::new(PI / (frequency * unknown[count]), 0.0, harmonics))
    }
}

/// Angles from 0 to pi/2 and weights: phi = u^2, so that roots of the depth are smooth.
fn quarter() -> impl Iterator<Item = (f64, f64)> {
    let end = FRAC_PI_2.sqrt();
    (0..4).flat_map(move |panel| {
        let (from, to) = (end * f64::from(panel) / 4.0, end * f64::from(panel + 1) / 4.0);
        nodes_and_weights(from, to).map(|(u, weight)| (u * u, 2.0 * u * weight))
    })
}

/// sum of b_k sin k phi over k = 1, 3, ..
fn sine_sum(harmonics: &[f64], phi: f64) -> f64 {
    let term = |(number, harmonic): (usize, &f64)| harmonic * ((2 * number + 1) as f64 * phi).sin();
    harmonics.iter().enumerate().map(term).sum()
}

/// The derivative of [`sine_sum`] at zero: the sum of k b_k.
fn sum_of_slopes(harmonics: &[f64]) -> f64 {
    let term = |(number, harmonic): (usize, &f64)| harmonic * (2 * number + 1) as f64;
    harmonics.iter().enumerate().map(term).sum()
}

/// The positive argument at which an increasing function changes its sign, searched by doubling and
/// halving from one.
fn rising_root(function: impl Fn(f64) -> f64) -> Option<f64> {
    let (mut low, mut high) = (1.0, 1.0);
    // A point without a value lies too far.
    let value = |at: f64| {
        let value = function(at);
        if value.is_finite() { value } else { 1.0 }
    };
    for _ in 0..500 {
        if value(low) > 0.0 {
            high = low;
            low *= 0.5;
        } else if value(high) < 0.0 {
            low = high;
            high *= 2.0;
        } else {
            return find_root(value, low, high).ok();
        }
    }
    None
}

/// The inverse Jacobian, by central differences, times the residual.
fn newton_step(
    residual: impl Fn(&DVector<f64>) -> DVector<f64>,
    at: &DVector<f64>,
) -> Option<DVector<f64>> {
    let size = at.len();
    let mut jacobian = DMatrix::zeros(size, size);
    let step = 1e-6;
    for column in 0..size {
        let (mut above, mut below) = (at.clone(), at.clone());
        above[column] += step;
        below[column] -= step;
        jacobian.set_column(column, &((residual(&above) - residual(&below)) / (2.0 * step)));
    }
    jacobian.lu().solve(&residual(at))
}
