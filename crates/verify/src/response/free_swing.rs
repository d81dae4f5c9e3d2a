//! The free motion without damping about an equilibrium where the force has corners, by Taylor
//! series from one turning point to the other.
//!
//! ```text
//! x(0) = x_0,  x'(0) = 0,  x'(T/2) = 0:   the second half of a period is the first one backwards
//! a = 4/T integral_0^(T/2) x cos(2 pi t/T) dt
//! ```
//!
//! In: an oscillator whose force is even in the velocity, an amplitude of the first harmonic. Out:
//! the frequency of that motion. A motion costs 3 to 20 steps however stiff a contact is, an
//! amplitude some four motions.

use std::f64::consts::{PI, TAU};

use super::series::{ANY, swing_solver};
use crate::oscillator::Oscillator;
use crate::symbol::Symbol;
use crate::system::{Path, PathEnd, Solver};

/// The free motions of an oscillator.
pub(super) struct FreeSwings(Solver);

/// The longest half of a period.
const LONGEST: f64 = 1e4;

impl FreeSwings {
    /// Prepares the series; `None` if there are none.
    pub(super) fn new(free: &Oscillator, parameter: Symbol) -> Option<Self> {
        swing_solver(free, (parameter, ANY)).map(Self)
    }

    /// These motions at a value of the parameter, which may stand in the force.
    pub(super) fn at(free: &Oscillator, (parameter, value): (Symbol, f64)) -> Option<Self> {
        let solver = swing_solver(free, (parameter, value))?;
        let own = solver.with_numbers(&[(parameter, value)].into());
        Some(Self(own.unwrap_or(solver)))
    }

    /// The first half of the motion that begins at rest at a place below the equilibrium; `None` if
    /// it does not come back.
    fn half(&self, start: f64) -> Option<Path> {
        let path = self.0.solve([0.0, LONGEST], &[start, 0.0]).ok()?;
        let turns = matches!(path.reason(), PathEnd::Event(_)) && path.end() > 0.0;
        turns.then_some(path)
    }

    /// Half of the period of the motion that begins at rest at a place below the equilibrium; `None`
    /// if it does not come back.
    pub(super) fn half_period(&self, start: f64) -> Option<f64> {
        Some(self.half(start)?.end())
    }

    /// Position and velocity at so many equal steps of a period of this motion, an even number.
    pub(super) fn orbit(&self, start: f64, samples: usize) -> Option<Vec<[f64; 2]>> {
        let path = self.half(start)?;
        let half = samples / 2;
        let state = |sample: usize| {
            // The second half is the first one backwards.
            let there = if sample <= half { sample } else { samples - sample };
            let time = path.end() * there as f64 / half as f64;
            let [x, v] = [path.state_at(time, 0)?, path.state_at(time, 1)?];
            Some([x, if sample <= half { v } else { -v }])
        };
        (0..samples).map(state).collect()
    }

    /// Half of the period of the motion that begins at rest at a place below the equilibrium, and
    /// the amplitude of its first harmonic; `None` if it does not come back.
    fn swing(&self, start: f64) -> Option<[f64; 2]> {
        const SAMPLES: usize = 512;
        let path = self.half(start)?;
        let half = path.end();
        let part = |sample: usize| sample as f64 / SAMPLES as f64;
        let times: Vec<f64> = (0..=SAMPLES).map(|sample| half * part(sample)).collect();
        let mut columns = [Vec::with_capacity(times.len())];
        path.sample(&times, &mut Vec::with_capacity(times.len()), &mut columns);
        let [positions] = columns;
        let weight = |sample: usize| if sample.is_multiple_of(SAMPLES) { 0.5 } else { 1.0 };
        let terms = positions.iter().enumerate();
        let terms = terms.map(|(sample, x)| weight(sample) * x * (PI * part(sample)).cos());
        Some([half, 2.0 / SAMPLES as f64 * terms.sum::<f64>().abs()])
    }

    /// The frequency and the turning point of the motion about an equilibrium whose first harmonic
    /// has this amplitude; the `known` ones have been found at smaller amplitudes. `None` if there
    /// is none.
    pub(super) fn frequency_at(
        &self,
        place: f64,
        amplitude: f64,
        known: &[(f64, f64)],
    ) -> Option<(f64, f64)> {
        const MOST: usize = 30;
        const CONVERGED: f64 = 1e-11;
        // How far the turning point is from the equilibrium grows with the amplitude.
        let mut slope = match known {
            [.., (a, x), (b, y)] => (x - y) / (b - a),
            [(a, x)] => (place - x) / a,
            [] => 1.0,
        };
        let (from, start) = known.last().copied().unwrap_or((0.0, place));
        let mut below = start - slope * (amplitude - from);
        let mut before: Option<(f64, f64)> = None;
        for _ in 0..MOST {
            let [half, own] = self.swing(below)?;
            let missed = amplitude - own;
            if missed.abs() <= CONVERGED * amplitude {
                return Some((TAU / (2.0 * half), below));
            }
            if let Some((place, amplitude)) = before
                && own != amplitude
            {
                slope = (place - below) / (own - amplitude);
            }
            before = Some((below, own));
            below -= slope * missed;
            if below.is_nan() || below >= place {
                return None;
            }
        }
        None
    }
}
