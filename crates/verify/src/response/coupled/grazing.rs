//! Curves in two parameters on which a motion grazes: it touches a wall, or the condition of an event, and no
//! more.
//!
//! ```text
//! P_tau(y; p, q) = y,   g(y, tau) = 0,   dg/dt (y, tau) = 0        unknowns y, tau, p; q
//! dP_tau/dtau = f(P_tau) - M f(y)
//! ```
//!
//! The period begins at the phase tau of the touch, and the map is that of the motion without it. So it is
//! smooth there, where the map with the impact has a square root (A. B. Nordmark, *Journal of Sound and
//! Vibration* 145 (1991) 279): Newton's method converges on both sides.

use std::f64::consts::TAU;

use nalgebra::DVector;

use super::curves::TwoParameters;
use super::flow::TOLERANCE;
use super::problem::Orbit;
use crate::numeric::orbit_branch::{OrbitBranchLimits, OrbitEquations, OrbitPoint, PeriodImage};
use crate::response::LONGEST_STEP;

/// Part of a period at both ends within which the touch is no impact.
const TOUCH: f64 = 0.02;

/// Largest number of points of a curve in one direction.
const MOST: usize = 200;

/// A touch: the event, the phase and the state.
struct Touch {
    event: usize,
    phase: f64,
    state: Vec<f64>,
}

impl TwoParameters<'_> {
    /// The touch of an orbit beside a grazing: where gap and rate of an event are least together.
    fn touch(&self, orbit: &Orbit, second: f64) -> Option<Touch> {
        const PLACES: usize = 1024;
        let n = self.problem.states.len();
        let parameter = orbit.parameter();
        let section = orbit.kept.section;
        let mut state: Vec<f64> = orbit.start()[..n].iter().copied().chain([second]).collect();
        let mut sizes = self.problem.state_sizes(&orbit.kept.travel, self.scale);
        sizes.push(second.abs().max(1e-12));
        let place = |index: usize| section + TAU * index as f64 / PLACES as f64;
        let mut course: Vec<(f64, Vec<f64>, Vec<[f64; 2]>)> = Vec::new();
        for index in 0..PLACES {
            let phases = [place(index), place(index + 1)];
            let gaps = self.flow.gaps(&state, phases[0], parameter);
            course.push((phases[0], state.clone(), gaps));
            state = self.flow.end(&state, phases, parameter, &sizes)?;
        }
        let events = course[0].2.len();
        let found = (0..events).flat_map(|event| {
            let of_event = || course.iter().map(move |(.., gaps)| gaps[event]);
            let largest = |index: usize| of_event().map(|gap| gap[index].abs()).fold(0.0, f64::max);
            let (gap, rate) = (largest(0), largest(1));
            // A touch from the side on which the motion is.
            let is_inside = of_event().filter(|own| own[0] > 0.0).count() > PLACES / 2;
            let measured = of_event().map(move |own| (own[0] / gap).abs() + (own[1] / rate).abs());
            measured
                .enumerate()
                .filter(move |_| is_inside)
                .map(move |(index, at)| (at, event, index))
        });
        let (_, event, index) = { found }.min_by(|(one, ..), (other, ..)| one.total_cmp(other))?;
        let (phase, state, _) = &course[index];
        Some(Touch { event, phase: *phase, state: state[..n].to_vec() })
    }

    /// The points of the curve of a grazing beside an orbit, in order; none where the motion beyond a touch is
    /// not followed.
    pub(super) fn grazing_curve(
        &self,
        orbit: &Orbit,
        second: f64,
        range: [f64; 2],
    ) -> Vec<OrbitPoint<Vec<f64>>> {
        let Some(touch) = self.touch(orbit, second) else { return vec![] };
        let n = self.problem.states.len();
        let [low, high] = self.problem.question.range;
        let states = self.problem.state_sizes(&self.scale[..n], self.scale);
        let flow = self.flow.clone().without_event_at_ends(touch.event, TOUCH * TAU);
        let two = Self { problem: self.problem, flow, scale: self.scale };
        let mut all = states.clone();
        all.extend([1.0, high - low, range[1] - range[0]]);
        // The gap and its rate at all unknowns: y, tau, p, q.
        let gap = |unknowns: &[f64]| -> Option<[f64; 2]> {
            let state: Vec<f64> = unknowns[..n].iter().copied().chain([unknowns[n + 2]]).collect();
            two.flow.gaps(&state, unknowns[n], unknowns[n + 1]).get(touch.event).copied()
        };
        // Both with their gradients, by central differences.
        let gradients = |unknowns: &[f64]| -> Option<Vec<[f64; 2]>> {
            const STEP: f64 = 1e-6;
            let slope = |index: usize| {
                let moved = |sign: f64| {
                    let mut moved = unknowns.to_vec();
                    moved[index] += sign * STEP * all[index];
                    gap(&moved)
                };
                let (above, below) = (moved(1.0)?, moved(-1.0)?);
                Some([0, 1].map(|i| (above[i] - below[i]) / (2.0 * STEP * all[index])))
            };
            (0..n + 3).map(slope).collect()
        };
        let guess: Vec<f64> =
            touch.state.iter().copied().chain([touch.phase, orbit.parameter(), second]).collect();
        let Some(slopes) = gradients(&guess) else { return vec![] };
        // The gap counts by the parameter, its rate by the phase, in units of their steepest slopes.
        let unit = |row: usize, size: f64| {
            let steep = slopes.iter().zip(&all).map(|(slope, size)| (slope[row] * size).abs());
            size / steep.fold(0.0, f64::max)
        };
        let units = [unit(0, all[n + 1]), unit(1, 1.0)];
        if !units.iter().all(|unit| unit.is_finite()) {
            return vec![];
        }
        let map = |start: &DVector<f64>, second: f64| {
            let unknowns: Vec<f64> = start.iter().copied().chain([second]).collect();
            let (state, phase, parameters) =
                (&unknowns[..n], unknowns[n], [unknowns[n + 1], unknowns[n + 2]]);
            let image = two.image(state, phase, parameters)?;
            let rates = |state: &[f64], phase: f64| {
                let state: Vec<f64> = state.iter().copied().chain([second]).collect();
                two.flow.rates_at(&state, phase, parameters[0]).rows(0, n).into_owned()
            };
            let by_phase =
                rates(image.end.as_slice(), phase + TAU) - &image.monodromy * rates(state, phase);
            let ([gap, rate], slopes) = (gap(&unknowns)?, gradients(&unknowns)?);
            let mut by_start = image.monodromy.resize(n + 2, n + 2, 0.0);
            by_start.view_mut((0, n), (n, 1)).copy_from(&by_phase);
            by_start.view_mut((0, n + 1), (n, 1)).copy_from(&image.by_parameter);
            let mut by_second = image.by_second.push(0.0).push(0.0);
            // Row n is the rate, which fixes the phase, and row n + 1 the gap, which fixes the parameter.
            for (row, own) in [(n, 1), (n + 1, 0)] {
                for column in 0..n + 2 {
                    by_start[(row, column)] = units[own] * slopes[column][own];
                }
                by_start[(row, row)] += 1.0;
                by_second[row] = units[own] * slopes[n + 2][own];
            }
            let end = image.end.push(phase + units[1] * rate);
            Some(PeriodImage {
                end: end.push(parameters[0] + units[0] * gap),
                by_start,
                by_parameter: by_second,
                path: image.travel,
            })
        };
        let sizes = DVector::from_vec(all.clone());
        let equations = OrbitEquations {
            map: &map,
            smooth: false,
            accuracy: TOLERANCE,
            rounding: 1e-9,
            keep: &|_, image: &PeriodImage<Vec<f64>>| image.path.clone(),
            sizes: &|_| sizes.clone(),
        };
        let start = DVector::from_column_slice(&guess[..n + 2]);
        let Some(point) = equations.orbit_at(&start, second, &sizes) else { return vec![] };
        let limits = OrbitBranchLimits {
            range,
            longest: LONGEST_STEP,
            most: MOST,
            interrupt: self.problem.question.interrupt,
        };
        // The gap opens before and behind the touch.
        let opens = |point: &OrbitPoint<Vec<f64>>| {
            const BESIDE: f64 = 1e-3;
            let unknowns = point.unknowns.as_slice();
            let state: Vec<f64> = unknowns[..n].iter().copied().chain([unknowns[n + 2]]).collect();
            let rates = two.flow.rates_at(&state, unknowns[n], unknowns[n + 1]);
            let beside = |sign: f64| {
                let mut moved = unknowns.to_vec();
                for k in 0..n {
                    moved[k] += sign * BESIDE * rates[k];
                }
                moved[n] += sign * BESIDE;
                gap(&moved).map_or(f64::NAN, |gap| gap[1])
            };
            beside(1.0) > beside(-1.0)
        };
        let refused = |point: &OrbitPoint<Vec<f64>>| {
            !(low..=high).contains(&point.unknowns[n + 1]) || !opens(point)
        };
        match refused(&point) {
            true => vec![],
            false => equations.branch_through(point, &limits, &refused).0,
        }
    }
}
