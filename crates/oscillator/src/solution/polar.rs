//! Steady motions by slow equations in amplitude and phase that are not polynomials.
//!
//! ```text
//! a' = P + P_c cos(psi) + P_s sin(psi),   a psi'/m = Q + Q_c cos(psi) + Q_s sin(psi),   the coefficients functions of a
//! both zero:   D cos(psi) = P_s Q - P Q_s,   D sin(psi) = P Q_c - P_c Q,   D = P_c Q_s - P_s Q_c,   cos^2 + sin^2 = 1
//! ```

use std::collections::BTreeMap;
use std::f64::consts::PI;

use nalgebra::Matrix2;

use super::response::{SteadyState, wrapped};
use super::{Modulation, Solution};
use crate::exact::rational::from_f64;
use crate::expr::{CompiledFunction, Expr};
use crate::numeric::ode::root::{find_minimum, find_root};
use crate::symbol::Symbol;

/// Every steady motion at given values, largest amplitude first; `None` if a value is missing.
pub(super) fn steady_states(
    solution: &Solution,
    modulation: &Modulation,
    times: f64,
    value_of: &dyn Fn(Symbol) -> Option<f64>,
) -> Option<Vec<SteadyState>> {
    let rates = PolarRates::new(solution, modulation, times, value_of)?;
    let mut states: Vec<SteadyState> =
        rates.amplitudes().into_iter().filter_map(|amplitude| rates.state(amplitude)).collect();
    states.sort_by(|a, b| b.amplitude.total_cmp(&a.amplitude));
    states.extend(rates.rest());
    Some(states)
}

/// The rates of amplitude and phase at numbers, and their slopes by both.
struct PolarRates {
    times: f64,
    amplitude: CompiledFunction,
    phase: CompiledFunction,
    slopes: [[CompiledFunction; 2]; 2],
}

/// The coefficients of the waves at an amplitude.
struct WaveCoefficients {
    rate: [f64; 3],
    turn: [f64; 3],
}

impl WaveCoefficients {
    /// `D`, `D cos(psi)` and `D sin(psi)`.
    fn solved(&self) -> [f64; 3] {
        let ([rate, rate_cos, rate_sin], [turn, turn_cos, turn_sin]) = (self.rate, self.turn);
        [
            rate_cos * turn_sin - rate_sin * turn_cos,
            rate_sin * turn - rate * turn_sin,
            turn_cos * rate - rate_cos * turn,
        ]
    }
}

impl PolarRates {
    fn new(
        solution: &Solution,
        modulation: &Modulation,
        times: f64,
        value_of: &dyn Fn(Symbol) -> Option<f64>,
    ) -> Option<Self> {
        let parameters = solution.parameters.iter();
        let mut known: BTreeMap<Symbol, f64> =
            parameters.filter_map(|&name| Some((name, value_of(name)?))).collect();
        known.extend(solution.defined_values(value_of).ok()?);
        let exact =
            known.iter().filter_map(|(name, value)| Some((*name, Expr::number(from_f64(*value)?))));
        let exact = exact.collect();
        let unknown = [modulation.amplitude, modulation.phase];
        let rates = [&modulation.amplitude_rate, &modulation.phase_rate];
        let [amplitude, phase] = rates.map(|rate| rate.substitute_all(&exact).ok());
        let (amplitude, phase) = (amplitude?, phase?);
        let compiled = |expression: &Expr| CompiledFunction::new(expression, &unknown).ok();
        let slope = |of: &Expr, by: Symbol| compiled(&of.differentiate(by).ok()?);
        let slopes = |of: &Expr| Some([slope(of, unknown[0])?, slope(of, unknown[1])?]);
        Some(Self {
            times,
            slopes: [slopes(&amplitude)?, slopes(&phase)?],
            amplitude: compiled(&amplitude)?,
            phase: compiled(&phase)?,
        })
    }

    /// The values at three phases determine mean, cosine and sine.
    fn waves(&self, amplitude: f64) -> WaveCoefficients {
        let wave = |of: &dyn Fn(f64) -> f64| {
            let [ahead, across, behind] = [0.0, 0.5, 1.0].map(|part| of(part * PI));
            let mean = (ahead + behind) / 2.0;
            [mean, (ahead - behind) / 2.0, across - mean]
        };
        WaveCoefficients {
            rate: wave(&|phase| self.amplitude.call(&[amplitude, phase])),
            turn: wave(&|phase| amplitude * self.phase.call(&[amplitude, phase]) / self.times),
        }
    }

    /// A function that vanishes at the amplitude of a steady motion, over the size of its terms.
    fn excess(&self, amplitude: f64) -> f64 {
        let [determinant, cosine, sine] = self.waves(amplitude).solved();
        let (drive, rest) = (determinant * determinant, cosine * cosine + sine * sine);
        (rest - drive) / (rest + drive)
    }

    /// The steady amplitudes, searched over a range wider than any intended amplitude.
    fn amplitudes(&self) -> Vec<f64> {
        const DECADES: f64 = 16.0;
        const PER_DECADE: usize = 500;
        let count = (DECADES as usize) * PER_DECADE;
        let place = |k: usize| 10.0_f64.powf(DECADES * (k as f64 / count as f64 - 0.5));
        let mut found = vec![];
        let mut between =
            |from: f64, to: f64| found.extend(find_root(|a| self.excess(a), from, to));
        let value = |k: usize| (place(k), self.excess(place(k)));
        let (mut first, mut before) = (value(0), value(0));
        for k in 1..=count {
            let now = value(k);
            if before.1 * now.1 < 0.0 {
                between(before.0, now.0);
            } else if first.1 * before.1 > 0.0 && before.1.abs() < first.1.abs().min(now.1.abs()) {
                // Two zeros may lie closer together than the steps of the search.
                let sign = before.1.signum();
                let (lowest, least) = find_minimum(|a| sign * self.excess(a), first.0, now.0);
                if least < 0.0 {
                    between(first.0, lowest);
                    between(lowest, now.0);
                }
            }
            (first, before) = (before, now);
        }
        found
    }

    fn state(&self, amplitude: f64) -> Option<SteadyState> {
        let [determinant, cosine, sine] = self.waves(amplitude).solved();
        let phase = (sine / determinant).atan2(cosine / determinant);
        let at = |of: &CompiledFunction| of.call(&[amplitude, phase]);
        let [[aa, ap], [pa, pp]] = self.slopes.each_ref().map(|row| row.each_ref().map(at));
        let found = Matrix2::new(aa, ap, pa, pp).complex_eigenvalues();
        let eigenvalues = [(found[0].re, found[0].im), (found[1].re, found[1].im)];
        let known = phase.is_finite() && eigenvalues.iter().all(|value| value.0.is_finite());
        known.then_some(SteadyState { amplitude, phase: wrapped(phase), eigenvalues })
    }

    /// The state of zero amplitude, where no force drives the motion or dry friction dissipates
    /// more than a force feeds: about it `B' = lambda B + mu B*`.
    fn rest(&self) -> Option<SteadyState> {
        /// An amplitude near zero at which rounding does not count yet.
        const NEAR: f64 = 1e-7;
        let size = |waves: &WaveCoefficients| waves.rate[1].hypot(waves.rate[2]);
        let [near, far] = [NEAR, 100.0 * NEAR].map(|amplitude| self.waves(amplitude));
        let forced = size(&near) > 0.1 * size(&far) && size(&near) > 0.0;
        if forced && near.rate[0] + size(&near) >= 0.0 {
            return None;
        }
        let [rate, turn, wave] =
            [near.rate[0], near.turn[0], size(&near)].map(|value| value / NEAR);
        let under = wave * wave - turn * turn;
        let eigenvalues = match under >= 0.0 {
            true => [(rate + under.sqrt(), 0.0), (rate - under.sqrt(), 0.0)],
            false => [(rate, (-under).sqrt()), (rate, -(-under).sqrt())],
        };
        // With a drive or a damping that acts at rest this is no steady state.
        (rate.is_finite() && rate < 1e3).then_some(SteadyState {
            amplitude: 0.0,
            phase: 0.0,
            eigenvalues,
        })
    }
}
