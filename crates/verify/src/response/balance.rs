//! The harmonic balance of a driven or self-excited equation: [`HarmonicBalance`] of one
//! coordinate, whose force and derivatives are those of the equation.
//!
//! In: coefficients and a parameter. Out: residual and derivatives, in the units of the equation.
//!
//! Samples do not locate a jump of the force with the velocity, such as that of dry friction: the
//! phases at which the velocity passes it are computed, and the height of the jump is integrated
//! between them.

use std::f64::consts::TAU;

use nalgebra::DVector;

use super::driven::Driven;

use crate::expr::SampledFunctions;
use crate::numeric::balance::{
    ForceColumn, ForceSample, HarmonicBalance, Linearised, LocatedForces, SampledForces,
};
use crate::numeric::ode::quadrature::nodes_and_weights;
use crate::numeric::ode::root::find_root;

/// The balance equations for a number of harmonics.
#[derive(Clone, Debug)]
pub struct DrivenBalance<'a> {
    /// The equation.
    pub driven: &'a Driven,
    /// The balance of its one coordinate.
    pub core: HarmonicBalance,
    /// The force without jumps and its derivatives, at the phases of the samples.
    forces: Option<SampledFunctions<4>>,
}

impl<'a> DrivenBalance<'a> {
    /// The equations of `harmonics` harmonics, one at least.
    pub fn new(driven: &'a Driven, harmonics: usize) -> Self {
        let anchor = driven.self_excited.then_some(0);
        let core = HarmonicBalance::new(1, harmonics, driven.smooth, anchor);
        let samples = core.samples();
        let phases: Vec<f64> =
            (0..samples).map(|index| TAU / samples as f64 * index as f64).collect();
        Self { driven, core, forces: driven.sampled_with_slopes(&phases) }
    }

    /// The frequency of a motion.
    pub fn frequency(&self, coefficients: &DVector<f64>, parameter: f64) -> f64 {
        self.core.frequency(coefficients, self.driven.frequency_at(parameter))
    }

    /// Position and velocity at a phase.
    pub fn phase_point_at(
        &self,
        coefficients: &DVector<f64>,
        parameter: f64,
        phase: f64,
    ) -> [f64; 2] {
        self.core.at(coefficients, 0, self.frequency(coefficients, parameter), phase)
    }

    /// X, X' and X'' by the phase, at every sample.
    pub fn motion(&self, coefficients: &DVector<f64>) -> Vec<[f64; 3]> {
        self.core.motion(coefficients).swap_remove(0)
    }

    /// The residual and its derivatives; `None` if the force has no finite value on the motion.
    pub fn linearised(&self, coefficients: &DVector<f64>, parameter: f64) -> Option<Linearised> {
        let driven = self.driven;
        let omega = self.frequency(coefficients, parameter);
        let motion = self.core.motion(coefficients);
        let frequency = [omega, driven.frequency_slope(parameter)];
        if let Some(forces) = &self.forces {
            let sampled = self.sampled(forces, &motion[0], omega, parameter);
            return self.core.linearised_on(&motion, frequency, LocatedForces::default(), sampled);
        }
        let above = self.above(coefficients, parameter, omega, &motion[0]);
        let jumps = driven.jump_speed(parameter).is_some();
        let force = |phase: f64, state: &[[f64; 2]], sample: &mut ForceSample| {
            let at = [state[0][0], state[0][1], phase, parameter];
            match jumps {
                // The samples use the lower side of the jump; its height is added below.
                true => {
                    write(sample, driven.force_on(&at, &[BELOW]), driven.slopes_on(&at, &[BELOW]))
                }
                false => {
                    let (value, slopes) = driven.force_with_slopes(&at);
                    write(sample, value, slopes);
                }
            }
        };
        self.core.linearised(&motion, frequency, above, force)
    }

    /// A force without jumps and its derivatives at the samples of a motion.
    fn sampled(
        &self,
        forces: &SampledFunctions<4>,
        motion: &[[f64; 3]],
        omega: f64,
        parameter: f64,
    ) -> SampledForces {
        let positions: Vec<f64> = motion.iter().map(|[position, ..]| *position).collect();
        let velocities: Vec<f64> = motion.iter().map(|[_, slope, _]| omega * slope).collect();
        let parameters = vec![parameter; motion.len()];
        let mut values = vec![];
        forces.call(&[(0, &positions), (1, &velocities), (3, &parameters)], &mut values);
        let mut sampled = SampledForces::zeros(&self.core);
        let columns = [
            ForceColumn::Value,
            ForceColumn::ByPosition(0),
            ForceColumn::ByVelocity(0),
            ForceColumn::ByParameter,
        ];
        for (function, column) in columns.into_iter().enumerate() {
            sampled.column_mut(0, column).copy_from_slice(forces.column(function, &values));
        }
        sampled
    }

    /// The height of a jump of the force and of its derivatives, at phases of the motion: an
    /// integral by Gauss and Legendre between the phases at which the velocity passes the jump, and
    /// these phases themselves, at which the derivatives by the velocity and by the parameter of
    /// the jump are delta functions.
    fn above(
        &self,
        coefficients: &DVector<f64>,
        parameter: f64,
        omega: f64,
        motion: &[[f64; 3]],
    ) -> LocatedForces {
        let driven = self.driven;
        let mut all = LocatedForces::default();
        let Some(speed) = driven.jump_speed(parameter) else {
            return all;
        };
        let at = |phase: f64| {
            let [position, velocity] = self.core.at(coefficients, 0, omega, phase);
            [position, velocity, phase, parameter]
        };
        let mut integral = ForceSample::zeros(1);
        let mut push = |[_, velocity, phase, _]: [f64; 4], value: f64, slopes: [f64; 3]| {
            write(&mut integral, value, slopes);
            all.push(phase, &[velocity], &integral);
        };
        let step = TAU / motion.len() as f64;
        let is_above = |sample: usize| omega * motion[sample % motion.len()][1] >= speed;
        let passes = (0..motion.len()).filter(|sample| is_above(*sample) != is_above(sample + 1));
        let passed = |sample: usize| {
            let [from, to] = [sample, sample + 1].map(|sample| step * sample as f64);
            find_root(|phase| at(phase)[1] - speed, from, to).unwrap_or(from)
        };
        let mut phases: Vec<f64> = passes.map(passed).collect();
        for phase in &phases {
            let here = at(*phase);
            let [above, below] = [ABOVE, BELOW].map(|side| driven.force_on(&here, &[side]));
            let turn = omega * self.core.curvature(coefficients, 0, *phase);
            let by_velocity = (above - below) / turn.abs();
            let by_parameter = -by_velocity * driven.jump_speed_slope(parameter);
            push(here, 0.0, [0.0, by_velocity, by_parameter]);
        }
        // Each span begins where it rises above the jump, and ends where it falls below.
        match (phases.is_empty(), is_above(0)) {
            (true, true) => phases = vec![0.0, TAU],
            (false, true) => phases.rotate_right(1),
            (_, false) => {}
        }
        for span in phases.chunks_exact(2) {
            let (from, to) = (span[0], span[1] + if span[1] < span[0] { TAU } else { 0.0 });
            let panels = ((to - from) / TAU * (self.core.harmonics + 1) as f64).ceil();
            let width = (to - from) / panels;
            for panel in 0..panels as usize {
                let begin = from + width * panel as f64;
                for (phase, weight) in nodes_and_weights(begin, begin + width) {
                    let here = at(phase);
                    let [above, below] =
                        [ABOVE, BELOW].map(|side| driven.slopes_on(&here, &[side]));
                    let slopes =
                        std::array::from_fn(|index| weight * (above[index] - below[index]));
                    let [above, below] = [ABOVE, BELOW].map(|side| driven.force_on(&here, &[side]));
                    push(here, weight * (above - below), slopes);
                }
            }
        }
        all
    }

    /// Newton's method for the coefficients at a fixed parameter; `None` if it does not converge.
    pub fn solve(&self, guess: &DVector<f64>, parameter: f64) -> Option<DVector<f64>> {
        self.core.solve(guess, |coefficients| self.linearised(coefficients, parameter))
    }
}

/// The sides of a jump.
const ABOVE: f64 = 1.0;
const BELOW: f64 = -1.0;

/// Writes the force on the one coordinate, and its derivatives by position, velocity and parameter.
fn write(sample: &mut ForceSample, value: f64, [by_position, by_velocity, by_parameter]: [f64; 3]) {
    sample.value[0] = value;
    sample.by_position[(0, 0)] = by_position;
    sample.by_velocity[(0, 0)] = by_velocity;
    sample.by_parameter[0] = by_parameter;
}
