//! Harmonic balance with many harmonics: the equation of a periodic motion as equations for its
//! Fourier coefficients.
//!
//! ```text
//! X(theta) = a_0 + sum_(k = 1..H) a_k cos(k theta) + b_k sin(k theta),   u = (a_0, a_1, b_1, ..., a_H, b_H)
//! R(u, p) = the same coefficients of omega^2 X'' + f(X, omega X', theta; p)
//! ```
//!
//! The force is sampled at equal steps of the phase and taken apart into its harmonics again:
//! alternating time and frequency (T. M. Cameron and J. H. Griffin, *J. Appl. Mech.* 56 (1989) 149;
//! G. von Groll and D. J. Ewins, *J. Sound Vib.* 241 (2001) 223; M. Krack and J. Gross, *Harmonic
//! Balance for Nonlinear Vibration Problems*, Springer 2019). The Jacobian comes from the harmonics
//! of the derivatives of the force at the same samples. In: coefficients and a parameter. Out:
//! residual and derivatives, in the units of the equation.
//!
//! At a jump of the force with the velocity, such as dry friction, samples would not tell where it
//! is: the phases at which the velocity passes it are located, and what is more above it is
//! integrated between them.
//!
//! Without a drive the frequency is an unknown and the phase is free: the phase is fixed by a
//! vanishing first sine, and the frequency takes the place of b_1 among the unknowns.

use std::cell::Cell;

use nalgebra::{DMatrix, DVector};

use super::driven::Driven;

use crate::numeric::harmonics::{Harmonics, Transform};
use crate::numeric::ode::newton::{Progress, newton};
use crate::numeric::ode::quadrature::nodes_and_weights;
use crate::numeric::ode::root::find_root;

/// Samples for each harmonic, and of all of them: forces of the seventh power are exact.
const SMOOTH: [usize; 2] = [8, 32];

/// The numbers of harmonics for a force with corners: with fewer the branch would oscillate as a
/// corner moves from sample to sample.
const CORNERED: [usize; 2] = [32, 512];

/// The equations for this many harmonics.
#[derive(Clone, Debug)]
pub struct HarmonicBalance<'a> {
    /// The equation.
    pub driven: &'a Driven,
    /// H: the highest harmonic.
    pub harmonics: usize,
    /// The transform from samples to harmonics and back; the number of samples is a power of two.
    transform: Transform,
}

/// The residual and its derivatives at a point.
#[derive(Clone, Debug)]
pub struct Linearised {
    /// R.
    pub residual: DVector<f64>,
    /// dR/du and dR/dp, the last column.
    pub jacobian: DMatrix<f64>,
    /// The size of the terms that cancel in R.
    pub scale: f64,
}

/// A part of the force and of its derivatives by position, velocity, parameter and frequency, at a
/// phase.
struct ForceAtPhase {
    phase: f64,
    values: [f64; 5],
}

impl<'a> HarmonicBalance<'a> {
    /// The equations of `harmonics` harmonics, one at least.
    pub fn new(driven: &'a Driven, harmonics: usize) -> Self {
        let harmonics = harmonics.max(1);
        let [each, least] = if driven.smooth { SMOOTH } else { CORNERED };
        let samples = (each * (harmonics + 1)).next_power_of_two().max(least);
        Self { driven, harmonics, transform: Transform::new(samples) }
    }

    /// The number of coefficients: 2 H + 1.
    pub fn size(&self) -> usize {
        2 * self.harmonics + 1
    }

    /// The frequency of a motion.
    pub fn frequency(&self, coefficients: &DVector<f64>, parameter: f64) -> f64 {
        match self.driven.self_excited {
            true => coefficients[FREQUENCY],
            false => self.driven.frequency_at(parameter),
        }
    }

    /// The place of the frequency among the unknowns, where it is one of them.
    pub(super) fn frequency_place(&self) -> Option<usize> {
        self.driven.self_excited.then_some(FREQUENCY)
    }

    /// Cosine and sine of a harmonic of a motion; of harmonic 0, the mean and zero.
    pub fn harmonic(&self, coefficients: &DVector<f64>, harmonic: usize) -> [f64; 2] {
        match harmonic {
            0 => [coefficients[0], 0.0],
            1 if self.driven.self_excited => [coefficients[1], 0.0],
            _ => [coefficients[2 * harmonic - 1], coefficients[2 * harmonic]],
        }
    }

    /// The size of what moves in a motion.
    pub fn extent(&self, coefficients: &DVector<f64>) -> f64 {
        let size = coefficients.len();
        match self.frequency_place() {
            None => coefficients.rows(1, size - 1).norm(),
            Some(place) => {
                coefficients[1].hypot(coefficients.rows(place + 1, size - place - 1).norm())
            }
        }
    }

    /// The size of the last quarter of the harmonics.
    pub(super) fn last_harmonics(&self, coefficients: &DVector<f64>) -> f64 {
        let first = self.harmonics - self.harmonics / 4;
        let sizes = (first + 1..=self.harmonics).map(|harmonic| {
            let [cosine, sine] = self.harmonic(coefficients, harmonic);
            cosine.hypot(sine)
        });
        sizes.fold(0.0, f64::hypot)
    }

    /// The unknowns of a motion of this frequency that is known at any number of equal steps of a
    /// period.
    pub fn unknowns_of(&self, positions: &[f64], frequency: f64) -> DVector<f64> {
        let coefficients = self.coefficients_of(positions);
        if !self.driven.self_excited {
            return coefficients;
        }
        let mut begun = phase_shifted(&coefficients, coefficients[2].atan2(coefficients[1]));
        begun[FREQUENCY] = frequency;
        begun
    }

    /// The number of samples.
    pub fn samples(&self) -> usize {
        self.transform.samples()
    }

    /// X, X' and X'' by the phase, at every sample.
    pub fn motion(&self, coefficients: &DVector<f64>) -> Vec<[f64; 3]> {
        let derivative = |times: u32| {
            let wave = move |harmonic: usize| {
                let [a, b] = self.harmonic(coefficients, harmonic);
                let k = harmonic as f64;
                match times {
                    0 => [a, b],
                    1 => [k * b, -k * a],
                    _ => [-k * k * a, -k * k * b],
                }
            };
            self.transform.sum_of_waves((0..=self.harmonics).map(wave))
        };
        let [positions, slopes, curvatures] = [0, 1, 2].map(derivative);
        let points = positions.into_iter().zip(slopes).zip(curvatures);
        points.map(|((position, slope), curvature)| [position, slope, curvature]).collect()
    }

    /// The coefficients of a motion that is known at any number of equal steps of a period, twice
    /// as many as harmonics at least.
    pub fn coefficients_of(&self, positions: &[f64]) -> DVector<f64> {
        let count = positions.len().max(1) as f64;
        let harmonic = |harmonic: usize| {
            let wave = |(index, value): (usize, &f64)| {
                let (sine, cosine) =
                    (std::f64::consts::TAU * (harmonic * index) as f64 / count).sin_cos();
                (value * cosine, value * sine)
            };
            let sums = positions.iter().enumerate().map(wave);
            let (cosines, sines) =
                sums.fold((0.0, 0.0), |sum, next| (sum.0 + next.0, sum.1 + next.1));
            (2.0 * cosines / count, 2.0 * sines / count)
        };
        let (cosines, sines) = (0..=self.harmonics).map(harmonic).unzip();
        self.in_order(&Harmonics { cosines, sines })
    }

    fn in_order(&self, harmonics: &Harmonics) -> DVector<f64> {
        DVector::from_fn(self.size(), |index, _| match index {
            0 => 0.5 * harmonics.cosines[0],
            odd if odd % 2 == 1 => harmonics.cosines[odd.div_ceil(2)],
            even => harmonics.sines[even / 2],
        })
    }

    /// The residual and its derivatives; `None` if the force has no finite value on the motion.
    pub fn linearised(&self, coefficients: &DVector<f64>, parameter: f64) -> Option<Linearised> {
        let driven = self.driven;
        let (omega, omega_slope) =
            (self.frequency(coefficients, parameter), driven.frequency_slope(parameter));
        if omega.is_nan() || omega <= 0.0 {
            return None;
        }
        let step = std::f64::consts::TAU / self.samples() as f64;
        let motion = self.motion(coefficients);
        let count = motion.len();
        let (mut inertia, mut force) = (Vec::with_capacity(count), Vec::with_capacity(count));
        let mut slopes: [Vec<f64>; 4] = std::array::from_fn(|_| Vec::with_capacity(count));
        // The contribution of the side above a jump is added at the phases at which the velocity is
        // there.
        let above = self.above(coefficients, parameter, omega, &motion);
        const BELOW: [f64; 1] = [-1.0];
        let located = driven.jump_speed(parameter).is_some();
        for (sample, [position, by_phase, curvature]) in motion.iter().enumerate() {
            let velocity = omega * by_phase;
            let at = [*position, velocity, step * sample as f64, parameter];
            let ([by_position, by_velocity, by_parameter], value) = match located {
                true => (driven.slopes_on(&at, &BELOW), driven.force_on(&at, &BELOW)),
                false => (driven.slopes(&at), driven.force(&at)),
            };
            inertia.push(omega * omega * curvature);
            force.push(value);
            slopes[0].push(by_position);
            slopes[1].push(by_velocity);
            let by_frequency = 2.0 * omega * curvature + by_velocity * by_phase;
            slopes[2].push(by_parameter + omega_slope * by_frequency);
            slopes[3].push(by_frequency);
        }
        let sum: Vec<f64> = inertia.iter().zip(&force).map(|(one, other)| one + other).collect();
        let added = above.iter().flat_map(|part| part.values.iter());
        if !sum.iter().chain(slopes.iter().flatten()).chain(added).all(|value| value.is_finite()) {
            return None;
        }
        let size =
            |values: &[f64]| values.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        let all = |values: &[f64], which: usize, count: usize| {
            let mut harmonics = self.transform.harmonics(values, count);
            for part in &above {
                harmonics.add(part.phase, part.values[which]);
            }
            harmonics
        };
        let [stiffness, damping] =
            [0, 1].map(|index| all(&slopes[index], index + 1, 2 * self.harmonics));
        let mut jacobian = self.jacobian(&stiffness, &damping, omega);
        let vector =
            |values: &[f64], which: usize| self.in_order(&all(values, which, self.harmonics));
        if let Some(place) = self.frequency_place() {
            jacobian.set_column(place, &vector(&slopes[3], 4));
        }
        jacobian.set_column(self.size(), &vector(&slopes[2], 3));
        Some(Linearised {
            residual: vector(&sum, 0),
            jacobian,
            scale: size(&inertia).max(size(&force)),
        })
    }

    /// Differences of the force and its derivatives between above and below a jump, as weighted
    /// samples at phases of the motion: Gauss-Legendre quadrature over the spans in which the
    /// velocity is above the jump, and Dirac terms of the derivatives by the velocity, the
    /// parameter and the frequency at the phases at which it crosses.
    fn above(
        &self,
        coefficients: &DVector<f64>,
        parameter: f64,
        omega: f64,
        motion: &[[f64; 3]],
    ) -> Vec<ForceAtPhase> {
        let driven = self.driven;
        let Some(speed) = driven.jump_speed(parameter) else {
            return vec![];
        };
        let at = |phase: f64| {
            let [position, velocity] = self.phase_point_at(coefficients, parameter, phase);
            [position, velocity, phase, parameter]
        };
        let omega_slope = driven.frequency_slope(parameter);
        let step = std::f64::consts::TAU / motion.len() as f64;
        let is_above = |sample: usize| omega * motion[sample % motion.len()][1] >= speed;
        let passes = (0..motion.len()).filter(|sample| is_above(*sample) != is_above(sample + 1));
        let passed = |sample: usize| {
            let [from, to] = [sample, sample + 1].map(|sample| step * sample as f64);
            find_root(|phase| at(phase)[1] - speed, from, to).unwrap_or(from)
        };
        let mut phases: Vec<f64> = passes.map(passed).collect();
        let mut parts: Vec<ForceAtPhase> = Vec::new();
        for phase in &phases {
            let here = at(*phase);
            let [above, below] = [1.0, -1.0].map(|side| driven.force_on(&here, &[side]));
            let turn = omega * self.curvature(coefficients, *phase);
            let by_velocity = (above - below) / turn.abs();
            let by_frequency = by_velocity * here[1] / omega;
            let by_parameter =
                omega_slope * by_frequency - by_velocity * driven.jump_speed_slope(parameter);
            parts.push(ForceAtPhase {
                phase: *phase,
                values: [0.0, 0.0, by_velocity, by_parameter, by_frequency],
            });
        }
        // Each span begins where it rises above the jump, and ends where it falls below.
        match (phases.is_empty(), is_above(0)) {
            (true, true) => phases = vec![0.0, std::f64::consts::TAU],
            (false, true) => phases.rotate_right(1),
            (_, false) => {}
        }
        for span in phases.chunks_exact(2) {
            let (from, to) =
                (span[0], span[1] + if span[1] < span[0] { std::f64::consts::TAU } else { 0.0 });
            let panels = ((to - from) / std::f64::consts::TAU * (self.harmonics + 1) as f64).ceil();
            let width = (to - from) / panels;
            for panel in 0..panels as usize {
                let begin = from + width * panel as f64;
                for (phase, weight) in nodes_and_weights(begin, begin + width) {
                    let here = at(phase);
                    let [above, below] = [1.0, -1.0].map(|side| driven.slopes_on(&here, &[side]));
                    let [by_position, by_velocity, by_parameter] =
                        std::array::from_fn(|index| weight * (above[index] - below[index]));
                    let by_frequency = by_velocity * here[1] / omega;
                    let force =
                        weight * (driven.force_on(&here, &[1.0]) - driven.force_on(&here, &[-1.0]));
                    parts.push(ForceAtPhase {
                        phase,
                        values: [
                            force,
                            by_position,
                            by_velocity,
                            by_parameter + omega_slope * by_frequency,
                            by_frequency,
                        ],
                    });
                }
            }
        }
        parts
    }

    /// X'' by the phase.
    fn curvature(&self, coefficients: &DVector<f64>, phase: f64) -> f64 {
        let term = |harmonic: usize| {
            let [a, b] = self.harmonic(coefficients, harmonic);
            let k = harmonic as f64;
            let (sine, cosine) = (k * phase).sin_cos();
            -k * k * (a * cosine + b * sine)
        };
        (1..=self.harmonics).map(term).sum()
    }

    /// dR/du from the derivatives of the force at the samples, and room for dR/dp.
    fn jacobian(&self, stiffness: &Harmonics, damping: &Harmonics, omega: f64) -> DMatrix<f64> {
        // Coefficients (k; cos or sin) of s(theta) times the wave (l; cos or sin), s having these
        // harmonics.
        let coupled = |s: &Harmonics, (k, k_sine): (isize, bool), (l, l_sine): (isize, bool)| {
            0.5 * match (k_sine, l_sine) {
                (false, false) => s.cosine(k - l) + s.cosine(k + l),
                (false, true) => s.sine(k + l) + s.sine(l - k),
                (true, false) => s.sine(k + l) + s.sine(k - l),
                (true, true) => s.cosine(k - l) - s.cosine(k + l),
            }
        };
        DMatrix::from_fn(self.size(), self.size() + 1, |row, column| {
            if column == self.size() {
                return 0.0;
            }
            let place =
                |index: usize| (index.div_ceil(2) as isize, index > 0 && index.is_multiple_of(2));
            let ((k, k_sine), (l, l_sine)) = (place(row), place(column));
            // A cosine turns into minus a sine, a sine into a cosine.
            let turned = if l_sine { 1.0 } else { -1.0 } * omega * l as f64;
            let mut value = coupled(stiffness, (k, k_sine), (l, l_sine))
                + turned * coupled(damping, (k, k_sine), (l, !l_sine));
            if k == 0 {
                value *= 0.5;
            }
            if row == column {
                value -= (omega * k as f64).powi(2);
            }
            value
        })
    }

    /// Newton's method for the coefficients at a fixed parameter; `None` if it does not settle.
    pub fn solve(&self, guess: &DVector<f64>, parameter: f64) -> Option<DVector<f64>> {
        const MOST: usize = 40;
        let vanishes = Cell::new(false);
        let equations = |coefficients: &DVector<f64>| {
            let linear = self.linearised(coefficients, parameter)?;
            vanishes.set(linear.residual.norm() <= 1e-14 * linear.scale);
            Some((linear.residual, linear.jacobian.remove_column(self.size())))
        };
        let judged = |coefficients: &DVector<f64>, step: &DVector<f64>| {
            if !coefficients.norm().is_finite() {
                return Progress::Lost;
            }
            let settled = match self.frequency_place() {
                None => step.norm() <= CONVERGED * coefficients.norm(),
                // A frequency is measured in itself.
                Some(place) => {
                    let [size, moved] =
                        [coefficients, step].map(|vector| self.extent(vector).hypot(vector[0]));
                    moved <= CONVERGED * size
                        && step[place].abs() <= CONVERGED * coefficients[place].abs()
                }
            };
            match settled || vanishes.get() {
                true => Progress::Settled,
                false => Progress::Going,
            }
        };
        newton(guess.clone(), MOST, equations, judged)
    }

    /// Position and velocity at phase zero.
    pub fn start(&self, coefficients: &DVector<f64>, parameter: f64) -> [f64; 2] {
        let omega = self.frequency(coefficients, parameter);
        let mut start = [coefficients[0], 0.0];
        for harmonic in 1..=self.harmonics {
            let [a, b] = self.harmonic(coefficients, harmonic);
            start[0] += a;
            start[1] += omega * harmonic as f64 * b;
        }
        start
    }

    /// Position and velocity at a phase.
    pub fn phase_point_at(
        &self,
        coefficients: &DVector<f64>,
        parameter: f64,
        phase: f64,
    ) -> [f64; 2] {
        let omega = self.frequency(coefficients, parameter);
        let mut point = [coefficients[0], 0.0];
        let (step_sine, step_cosine) = phase.sin_cos();
        let (mut cosine, mut sine) = (1.0, 0.0);
        for harmonic in 1..=self.harmonics {
            (cosine, sine) =
                (cosine * step_cosine - sine * step_sine, sine * step_cosine + cosine * step_sine);
            let [a, b] = self.harmonic(coefficients, harmonic);
            point[0] += a * cosine + b * sine;
            point[1] += omega * harmonic as f64 * (b * cosine - a * sine);
        }
        point
    }
}

/// The motion begun later by a phase.
pub(super) fn phase_shifted(coefficients: &DVector<f64>, phase: f64) -> DVector<f64> {
    let mut turned = coefficients.clone();
    for harmonic in 1..=(coefficients.len() - 1) / 2 {
        let (sine, cosine) = (phase * harmonic as f64).sin_cos();
        let (a, b) = (coefficients[2 * harmonic - 1], coefficients[2 * harmonic]);
        turned[2 * harmonic - 1] = a * cosine + b * sine;
        turned[2 * harmonic] = b * cosine - a * sine;
    }
    turned
}

/// The place of the frequency among the unknowns, where it is one: that of b_1, which is zero.
const FREQUENCY: usize = 2;

/// A step of Newton's method that is smaller than this part of the motion is its last.
pub(super) const CONVERGED: f64 = 1e-10;
