//! Guesses of driven motions: few harmonics that balance the forces.
//!
//! ```text
//! X_i(theta) = a_i0 + sum_(k = 1..n) a_ik cos(k theta) + b_ik sin(k theta),    n: periods of the drive in one of the motion
//! ```
//!
//! Balances of so few harmonics cost little, so that they are begun at random from motions of many
//! sizes and directions; each that is found is the start of a search by shooting.

use nalgebra::DVector;

use super::flow::LinearisedRates;
use super::problem::CoupledProblem;
use super::starts::spread;
use crate::numeric::balance::{ForceSample, HarmonicBalance, LocatedForces};

/// Number of guesses at a value of the parameter.
const GUESSES: usize = 24;

/// Sizes of the guesses, in that of the largest known motion.
const SIZES: [f64; 2] = [0.03, 30.0];

impl CoupledProblem<'_> {
    /// The states in which the balances that are found begin, each once; none where an equation is
    /// of first order.
    pub(super) fn guesses(&self, parameter: f64, scale: &[f64]) -> Vec<Vec<f64>> {
        let n = self.coordinates;
        if self.states.len() != 2 * n {
            return vec![];
        }
        let omega = self.frequency_at(parameter);
        let periods = self.question.periods;
        let balance = HarmonicBalance::new(n, periods, true, None);
        let force = |phase: f64, state: &[[f64; 2]], sample: &mut ForceSample| {
            let positions = state.iter().map(|[position, _]| *position);
            let velocities = state.iter().map(|[_, velocity]| *velocity);
            let state: Vec<f64> = positions.chain(velocities).collect();
            let LinearisedRates { rates, by_state, .. } =
                self.in_time.linearised(&state, phase / omega, parameter);
            for i in 0..n {
                sample.value[i] = -rates[n + i];
                for j in 0..n {
                    sample.by_position[(i, j)] = -by_state[(n + i, j)];
                    sample.by_velocity[(i, j)] = -by_state[(n + i, n + j)];
                }
            }
        };
        let equations = |u: &DVector<f64>| {
            balance.linearised(&balance.motion(u), [omega, 0.0], LocatedForces::default(), force)
        };
        let largest = scale.iter().take(n).copied().fold(0.0, f64::max);
        let largest = if largest > 0.0 { largest } else { 1.0 };
        let mut found: Vec<DVector<f64>> = Vec::new();
        for index in 0..GUESSES {
            if self.question.interrupt.is_requested() {
                break;
            }
            let size = largest * SIZES[0] * (SIZES[1] / SIZES[0]).powf(spread(index, 0));
            // The wave of one harmonic: of the first, or of that of the drive.
            let harmonic = if index % 2 == 0 { 1 } else { periods };
            let mut guess = DVector::zeros(balance.size());
            let block = balance.size() / n;
            for coordinate in 0..n {
                for part in 0..2 {
                    let random = 2.0 * spread(index, 1 + 2 * coordinate + part) - 1.0;
                    guess[coordinate * block + 2 * harmonic - 1 + part] = size * random;
                }
            }
            let Some(solved) = balance.solve(&guess, equations) else { continue };
            let extent = balance.extent(&solved);
            let is_same = |other: &DVector<f64>| (other - &solved).norm() <= 1e-4 * extent;
            if extent.is_finite() && !found.iter().any(is_same) {
                found.push(solved);
            }
        }
        let start = |unknowns: &DVector<f64>| {
            let at = |coordinate: usize| balance.at(unknowns, coordinate, omega, 0.0);
            let positions = (0..n).map(|coordinate| at(coordinate)[0]);
            let velocities = (0..n).map(|coordinate| at(coordinate)[1]);
            positions.chain(velocities).collect()
        };
        found.iter().map(start).collect()
    }
}
