//! Verification of the points of a branch: the true motion that shooting finds near each, and
//! simulations started near the stable ones.

use nalgebra::Matrix2;

use super::balance::DrivenBalance;
use super::continuation::BranchNode;
use super::cycle::{self, Guess, true_cycle};
use super::stability::{
    Floquet, SAMPLES, TrueMotion, first_harmonic, half_of_peak_to_peak, multipliers_along,
    periodic_motion, settle,
};
use super::{Branch, PreparedRequest, Simulated, SteadyMotion};
use crate::trajectory;

/// The multipliers at a point of a branch, and the true motion beside it.
pub(super) type PointJudgement = (Option<Floquet>, Option<TrueMotion>);

impl PreparedRequest<'_> {
    /// The multipliers and the true motion of [`Self::judged`]; both `None` once an interrupt was
    /// requested.
    pub(super) fn judged_in_time(
        &self,
        balance: &DrivenBalance,
        node: &BranchNode,
    ) -> PointJudgement {
        match self.question.interrupt.is_requested() {
            true => (None, None),
            false => self.judged(balance, node),
        }
    }

    /// The multipliers at a point of a branch, and the true motion beside it.
    pub(super) fn judged(&self, balance: &DrivenBalance, node: &BranchNode) -> PointJudgement {
        /// Largest difference of the true motion, relative to its size; beyond this it is another
        /// motion.
        const OTHER: f64 = 0.3;
        if node.truth.is_some() {
            return (node.truth.map(|truth| truth.floquet), node.truth);
        }
        if self.driven.self_excited {
            return self.judged_cycle(balance, node);
        }
        let start = node.begins(balance);
        let size = balance.core.extent(&node.coefficients);
        let truth =
            periodic_motion(&self.driven, start, node.parameter, size.max(1e-12)).filter(|truth| {
                let [cosine, sine] = [1, 2].map(|index| node.coefficients[index]);
                (truth.first_harmonic[0] - cosine).hypot(truth.first_harmonic[1] - sine)
                    <= OTHER * size.max(1e-12)
            });
        let floquet = truth.map(|truth| truth.floquet);
        let along = || {
            // Across a jump only the true motion has multipliers.
            if self.driven.jumps() > 0 {
                return None;
            }
            let frequency = self.driven.frequency_at(node.parameter);
            multipliers_along(&self.driven, node.parameter, frequency, |phase| {
                balance.phase_point_at(&node.coefficients, node.parameter, phase)
            })
        };
        (floquet.or_else(along), truth)
    }

    /// The multipliers and the true motion of a point without drive; the true motion may have
    /// another phase.
    fn judged_cycle(&self, balance: &DrivenBalance, node: &BranchNode) -> PointJudgement {
        const OTHER: f64 = 0.3;
        let (u, parameter) = (&node.coefficients, node.parameter);
        let frequency = balance.frequency(u, parameter);
        let guess = Guess {
            start: balance.phase_point_at(u, parameter, 0.0),
            frequency,
            size: balance.core.extent(u),
        };
        let damping = balance.motion(u).into_iter().map(|[x, by_phase, _]| {
            let [_, by_velocity, _] =
                self.driven.slopes(&[x, frequency * by_phase, 0.0, parameter]);
            by_velocity
        });
        let mean = damping.sum::<f64>() / balance.core.samples() as f64;
        let along = Floquet {
            monodromy: Matrix2::new(
                (-mean * std::f64::consts::TAU / frequency).exp(),
                0.0,
                0.0,
                1.0,
            ),
            self_excited: true,
        };
        if guess.size == 0.0 {
            // At rest no integration is needed: position and frequency follow from the equation
            // itself.
            let at_rest = TrueMotion {
                start: guess.start,
                frequency,
                floquet: along,
                first_harmonic: [0.0, 0.0],
                peak: 0.0,
                stuck: 0.0,
            };
            return (Some(along), Some(at_rest));
        }
        let amplitude = |[cosine, sine]: [f64; 2]| cosine.hypot(sine);
        let truth =
            true_cycle(&self.driven, &guess, parameter, along.largest() > 1.0).filter(|truth| {
                let apart =
                    amplitude(truth.first_harmonic) - amplitude(balance.core.harmonic(u, 0, 1));
                apart.abs() <= OTHER * guess.size
            });
        (Some(truth.map_or(along, |truth| truth.floquet)), truth)
    }

    pub(super) fn point(
        &self,
        balance: &DrivenBalance,
        node: &BranchNode,
        (floquet, truth): PointJudgement,
        size: f64,
    ) -> SteadyMotion {
        let u = &node.coefficients;
        let positions: Vec<f64> = balance.motion(u).iter().map(|point| point[0]).collect();
        /// Relative size below which a harmonic is rounding.
        const NOTHING: f64 = 1e-12;
        let [cosine, sine] = balance.core.harmonic(u, 0, 1);
        let (amplitude, peak) = (cosine.hypot(sine), half_of_peak_to_peak(&positions));
        let frequency = balance.frequency(u, node.parameter);
        let (amplitude, phase) = match amplitude > NOTHING * peak {
            // A half turn is written as pi, not -pi, whatever the rounding of the sine.
            true if sine.abs() <= NOTHING * amplitude => {
                (amplitude, if cosine < 0.0 { std::f64::consts::PI } else { 0.0 })
            }
            true => (amplitude, sine.atan2(cosine)),
            false => (0.0, 0.0),
        };
        let error = truth.map(|truth| {
            let [cosine, sine] = truth.first_harmonic;
            let of_size = relative_error([amplitude, peak], [cosine.hypot(sine), truth.peak], size);
            of_size.max((frequency / truth.frequency - 1.0).abs())
        });
        // Without damping the multipliers lie on the unit circle, up to rounding.
        let allowed = if self.driven.undamped { 1.0 + 1e-5 } else { 1.0 };
        SteadyMotion {
            parameter: node.parameter,
            harmonics: balance.core.waves(u, 0).collect(),
            frequency,
            amplitude,
            phase,
            peak,
            start: truth.map_or_else(
                || balance.phase_point_at(u, node.parameter, 0.0),
                |truth| truth.start,
            ),
            stable: floquet.map(|floquet| floquet.largest() < allowed),
            multipliers: floquet.map(|floquet| floquet.multipliers()),
            stuck: truth.map_or(0.0, |truth| truth.stuck),
            error,
        }
    }

    /// Simulations beside some stable points, disturbed a little and followed until they have
    /// settled.
    pub(super) fn simulated(&self, branches: &[Branch]) -> Vec<Simulated> {
        /// Largest number of points on a stable part of a branch, and on all of them.
        const EACH: usize = 6;
        const MOST: usize = 30;
        /// Disturbances, relative to the size of the motion; the second is used if the first leads
        /// to another motion.
        const DISTURBANCES: [f64; 2] = [1e-2, 1e-5];
        const OTHER: f64 = 0.05;
        const PERIODS: f64 = 1500.0;
        const CLOSELY: f64 = 1e-8;
        if self.driven.undamped {
            return vec![];
        }
        let size = branches
            .iter()
            .flat_map(|branch| &branch.points)
            .map(|point| point.peak)
            .fold(0.0, f64::max);
        let mut found = Vec::new();
        let mut budget = self.budget();
        for branch in branches {
            for part in branch.points.chunk_by(|one, other| one.stable == other.stable) {
                if part.first().is_none_or(|point| point.stable != Some(true)) {
                    continue;
                }
                let steps = EACH.min(part.len());
                for index in 0..steps {
                    let point = &part[(2 * index + 1) * part.len() / (2 * steps)];
                    let largest =
                        point.multipliers.map_or(1.0, |multipliers| multipliers[0].norm());
                    let needed = (1e-7_f64 / DISTURBANCES[0]).ln() / largest.ln();
                    let stopped = self.question.interrupt.is_requested();
                    // Without a drive, a motion that shooting does not find may not exist.
                    let nothing = self.driven.self_excited && point.error.is_none();
                    if !(needed > 0.0 && needed < PERIODS)
                        || found.len() >= MOST
                        || stopped
                        || nothing
                    {
                        continue;
                    }
                    let most = needed.ceil() as usize + 8;
                    let mut run = |disturbance: f64| {
                        let start = [point.start[0] + disturbance * point.peak, point.start[1]];
                        if self.driven.jumps() > 0 {
                            let (frequency, positions) =
                                self.simulated_by_series(start, point, most)?;
                            return Some(simulated(point, &positions, frequency, size));
                        }
                        if self.driven.self_excited {
                            let guess =
                                Guess { start, frequency: point.frequency, size: point.peak };
                            let found = cycle::settle_cycle(
                                &self.driven,
                                &guess,
                                point.parameter,
                                most,
                                &mut budget,
                            )?;
                            return Some(simulated(point, &found.1, found.0, size));
                        }
                        let settled = settle(
                            &self.driven,
                            start,
                            point.parameter,
                            (most, CLOSELY),
                            &mut budget,
                        )?;
                        Some(simulated(point, &settled.positions, point.frequency, size))
                    };
                    // If the first disturbance leads to another motion, the second, much smaller
                    // one decides.
                    let first = run(DISTURBANCES[0]);
                    let near = match first {
                        Some(first) if first.error <= OTHER => Some(first),
                        _ => run(DISTURBANCES[1]).or(first),
                    };
                    found.extend(near);
                }
            }
        }
        found
    }
}

impl PreparedRequest<'_> {
    /// Frequency and positions of the last of this many periods from a start, by an independent
    /// simulation that locates every jump as an event and does not use the map by which the points
    /// were found; `None` if it ends earlier.
    fn simulated_by_series(
        &self,
        start: [f64; 2],
        point: &SteadyMotion,
        periods: usize,
    ) -> Option<(f64, Vec<f64>)> {
        let mut course = trajectory::TrajectoryRequest::of_equation(&self.oscillator);
        let period = std::f64::consts::TAU / point.frequency;
        course.energy = None;
        course.start = start.to_vec();
        course.values = [(self.question.parameter, point.parameter)].into();
        course.values.retain(|name, _| self.oscillator.parameters.contains(name));
        course.interrupt = self.question.interrupt;
        course.duration = period * (periods + 2) as f64;
        if self.driven.self_excited {
            // The section is a minimum of the displacement.
            course.section =
                Some(trajectory::PoincareSection::Rising(self.oscillator.velocity().into()));
        }
        let motion = course.follow().ok().filter(|motion| motion.is_complete())?;
        let (from, to) = match (self.driven.self_excited, motion.crossings()) {
            (false, _) => (motion.end() - period, motion.end()),
            (true, [.., one, other]) => (one.time, other.time),
            (true, _) => return None,
        };
        let time = |sample: usize| from + (to - from) * sample as f64 / SAMPLES as f64;
        let positions = (0..SAMPLES).filter_map(|sample| Some(motion.states_at(time(sample))?[0]));
        Some((std::f64::consts::TAU / (to - from), positions.collect()))
    }
}

fn simulated(point: &SteadyMotion, positions: &[f64], frequency: f64, size: f64) -> Simulated {
    let [cosine, sine] = first_harmonic(positions);
    let (amplitude, peak) = (cosine.hypot(sine), half_of_peak_to_peak(positions));
    let of_size = relative_error([point.amplitude, point.peak], [amplitude, peak], size);
    Simulated {
        parameter: point.parameter,
        frequency,
        amplitude,
        peak,
        error: of_size.max((point.frequency / frequency - 1.0).abs()),
    }
}

/// The larger error of amplitude and peak, over the true peak; for motions far smaller than the
/// largest, over a thousandth of the largest.
fn relative_error(
    [amplitude, peak]: [f64; 2],
    [true_amplitude, true_peak]: [f64; 2],
    size: f64,
) -> f64 {
    let apart = (amplitude - true_amplitude).abs().max((peak - true_peak).abs());
    let over = true_peak.max(1e-3 * size);
    if over > 0.0 { apart / over } else { 0.0 }
}
