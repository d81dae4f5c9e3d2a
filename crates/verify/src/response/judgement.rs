//! Verification of the points of a branch: the true motion that shooting finds near each, and
//! simulations started near the stable ones.

use nalgebra::Matrix2;

use super::balance::DrivenBalance;
use super::continuation::BranchNode;
use super::cycle::{self, Guess, true_cycle};
use super::multiple_shooting::motion_in_parts;
use super::stability::{
    Floquet, MotionGuess, SAMPLES, Settled, SettlingStart, SimulationBudget, TrueMotion,
    checked_orbit, first_harmonic, half_of_peak_to_peak, multipliers_along, periodic_motions,
    settle_together,
};
use super::{Branch, PreparedRequest, Simulated, SteadyMotion};
use crate::system::LANES;
use crate::trajectory;

/// The multipliers at a point of a branch, and the true motion beside it.
pub(super) type PointJudgement = (Option<Floquet>, Option<TrueMotion>);

impl PreparedRequest<'_> {
    /// The multipliers and the true motion at each of some points, as by [`Self::judged`]; both
    /// `None` once an interrupt was requested. The progress advances by a point for each.
    pub(super) fn judged_in_time(
        &self,
        balance: &DrivenBalance,
        nodes: &[BranchNode],
    ) -> Vec<PointJudgement> {
        let is_alone = |node: &BranchNode| node.truth.is_some() || self.driven.self_excited;
        let together = match self.driven.has_series() && !nodes.iter().any(is_alone) {
            true => 8 * LANES,
            false => 1,
        };
        let mut all = Vec::with_capacity(nodes.len());
        for nodes in nodes.chunks(together) {
            nodes.iter().for_each(|_| self.question.progress.advance());
            match self.question.interrupt.is_requested() {
                true => all.extend(nodes.iter().map(|_| (None, None))),
                false => all.extend(self.judged_together(balance, nodes)),
            }
        }
        all
    }

    /// The multipliers at a point of a branch, and the true motion beside it.
    pub(super) fn judged(&self, balance: &DrivenBalance, node: &BranchNode) -> PointJudgement {
        self.judged_together(balance, std::slice::from_ref(node)).pop().unwrap_or_default()
    }

    /// The multipliers at points of a branch, and the true motions beside them, followed side by
    /// side.
    fn judged_together(
        &self,
        balance: &DrivenBalance,
        nodes: &[BranchNode],
    ) -> Vec<PointJudgement> {
        let size = |node: &BranchNode| balance.core.extent(&node.coefficients).max(1e-12);
        let is_guess = |node: &&BranchNode| node.truth.is_none() && !self.driven.self_excited;
        let guess = |node: &BranchNode| MotionGuess {
            start: node.begins(balance),
            parameter: node.parameter,
            size: size(node),
        };
        let guesses: Vec<MotionGuess> = nodes.iter().filter(is_guess).map(guess).collect();
        let mut truths = periodic_motions(&self.driven, &guesses).into_iter();
        let judged = |node: &BranchNode| {
            if let Some(truth) = node.truth {
                let checked = match self.period_series {
                    Some(_) => checked_orbit(&self.driven, &truth, node.parameter),
                    None => Some(truth),
                };
                return (Some(truth.floquet), checked);
            }
            match self.driven.self_excited {
                true => self.judged_cycle(balance, node),
                false => self.judged_beside(balance, node, size(node), truths.next().flatten()),
            }
        };
        nodes.iter().map(judged).collect()
    }

    /// The multipliers at a point of a driven motion, and the true motion that shooting has found
    /// from it, unless that is another one.
    fn judged_beside(
        &self,
        balance: &DrivenBalance,
        node: &BranchNode,
        size: f64,
        truth: Option<TrueMotion>,
    ) -> PointJudgement {
        /// Largest difference of the true motion, relative to its size; beyond this it is another
        /// motion.
        const OTHER: f64 = 0.3;
        /// The largest multiplier of a motion that one shot tells: the last digit of its start times
        /// this is the error at the end of the period, and times this once more that of det M.
        const ONE_SHOT: f64 = 1e4;
        // Of a motion over several periods of the drive the first harmonic may vanish, as that of every other
        // motion with the period of the drive does: the peak tells them apart.
        let own_peak = {
            let positions: Vec<f64> =
                balance.motion(&node.coefficients).iter().map(|[x, ..]| *x).collect();
            half_of_peak_to_peak(&positions)
        };
        let is_beside = |truth: &TrueMotion| {
            let [cosine, sine] = [1, 2].map(|index| node.coefficients[index]);
            let apart = (truth.first_harmonic[0] - cosine).hypot(truth.first_harmonic[1] - sine);
            apart <= OTHER * size && (truth.peak - own_peak).abs() <= OTHER * size
        };
        let truth = truth.filter(is_beside);
        // Across a jump only the true motion has multipliers.
        if self.driven.jumps() > 0 || truth.is_some_and(|truth| truth.floquet.largest() <= ONE_SHOT)
        {
            return (truth.map(|truth| truth.floquet), truth);
        }
        let parameter = node.parameter;
        let motion = |phase: f64| balance.phase_point_at(&node.coefficients, parameter, phase);
        let along = || {
            let frequency = self.driven.frequency_at(parameter);
            multipliers_along(&self.driven, parameter, frequency, motion)
        };
        let floquet = truth.map(|truth| truth.floquet).or_else(along);
        let in_parts = floquet.and_then(|floquet| {
            motion_in_parts(&self.driven, (parameter, size), floquet.largest(), motion)
        });
        let truth = in_parts.filter(is_beside).or(truth);
        (truth.map(|truth| truth.floquet).or(floquet), truth)
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
        /// Relative size below which a harmonic is rounding.
        const NOTHING: f64 = 1e-12;
        let u = &node.coefficients;
        let [cosine, sine] = balance.core.harmonic(u, 0, 1);
        let orbit = node.truth.filter(|_| self.period_series.is_some());
        let peak = orbit.map(|orbit| orbit.peak).unwrap_or_else(|| {
            let positions: Vec<f64> = balance.motion(u).iter().map(|point| point[0]).collect();
            half_of_peak_to_peak(&positions)
        });
        let amplitude = cosine.hypot(sine);
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
            // The judge closes the orbit at another start.
            let start = orbit.map_or(truth.start, |orbit| orbit.start);
            let apart = (start[0] - truth.start[0])
                .abs()
                .max((start[1] - truth.start[1]).abs() / frequency);
            let of_start = relative_error([apart, peak], [0.0, peak], size);
            of_size.max(of_start).max((frequency / truth.frequency - 1.0).abs())
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
            start: truth.map_or_else(|| node.begins(balance), |truth| truth.start),
            stable: floquet.map(|floquet| floquet.largest() < allowed),
            multipliers: floquet.map(|floquet| floquet.multipliers()),
            stuck: truth.map_or(0.0, |truth| truth.stuck),
            impacts: 0,
            events: 0,
            error,
            coordinates: vec![],
            energy: None,
            counted: vec![],
        }
    }

    /// Simulations beside some stable points, disturbed a little and followed until they have
    /// settled.
    pub(super) fn simulated(&self, branches: &[Branch]) -> Vec<Simulated> {
        /// Largest number of points on a stable part of a branch, and on all of them.
        const EACH: usize = 6;
        const MOST: usize = 30;
        /// Disturbances, relative to the size of the motion; a smaller one is used if the one before
        /// leads to another motion, as it may beside a motion that just does not touch a stop. The
        /// last one is that of orbits by shooting, whose starts are known to more digits.
        const DISTURBANCES: [f64; 4] = [1e-2, 1e-5, 1e-8, 1e-11];
        /// Errors beyond which a simulation has settled on another motion: beside points of a
        /// balance, and beside orbits by shooting.
        const OTHER: f64 = 0.05;
        const OTHER_THAN_ORBIT: f64 = 1e-3;
        const PERIODS: f64 = 1500.0;
        if self.driven.undamped {
            return vec![];
        }
        let size = branches
            .iter()
            .flat_map(|branch| &branch.points)
            .map(|point| point.peak)
            .fold(0.0, f64::max);
        // An orbit by shooting is known too well to be mistaken for one beside it.
        let (other, disturbances) = match self.period_series.is_some() || !self.driven.is_balanced()
        {
            true => (OTHER_THAN_ORBIT, &DISTURBANCES[..]),
            false => (OTHER, &DISTURBANCES[..3]),
        };
        let mut budget = self.budget();
        let parts = branches
            .iter()
            .flat_map(|branch| branch.points.chunk_by(|one, other| one.stable == other.stable))
            .filter(|part| part.first().is_some_and(|point| point.stable == Some(true)));
        let chosen = parts.flat_map(|part| match self.period_series {
            Some(_) => self.spread_over(part, EACH, size),
            None => {
                let steps = EACH.min(part.len());
                (0..steps).map(|index| &part[(2 * index + 1) * part.len() / (2 * steps)]).collect()
            }
        });
        // Each point with the number of periods in which its disturbance decays.
        let decaying = chosen.filter_map(|point| {
            let largest = point.multipliers.map_or(1.0, |multipliers| multipliers[0].norm());
            let needed = (1e-7_f64 / DISTURBANCES[0]).ln() / largest.ln();
            // Without a drive, a motion that shooting does not find may not exist.
            let nothing = self.driven.self_excited && point.error.is_none();
            let decays = needed > 0.0 && needed < PERIODS && !nothing;
            decays.then(|| (point, needed.ceil() as usize + 8))
        });
        let decaying: Vec<(&SteadyMotion, usize)> = decaying.collect();
        let mut found = Vec::new();
        for points in decaying.chunks(if self.driven.has_series() { LANES } else { 1 }) {
            if found.len() >= MOST || self.question.interrupt.is_requested() {
                break;
            }
            let is_near = |simulated: &Option<Simulated>| {
                simulated.is_some_and(|simulated| simulated.error <= other)
            };
            let mut nearest = vec![None; points.len()];
            for &disturbance in disturbances {
                let left: Vec<usize> =
                    (0..points.len()).filter(|index| !is_near(&nearest[*index])).collect();
                let beside: Vec<_> = left.iter().map(|index| points[*index]).collect();
                let runs = self.simulated_beside(&beside, (disturbance, size), &mut budget);
                for (index, run) in left.into_iter().zip(runs) {
                    nearest[index] = run.or(nearest[index]);
                }
            }
            found.extend(nearest.into_iter().flatten());
        }
        found.truncate(MOST);
        found
    }

    /// Chooses at most so many points of a part of a branch, at equal distances along it: where a
    /// motion begins to touch a stiff stop the branch turns sharply, and half of its points lie
    /// there. `size` is that of the largest motion. Linear in the number of points.
    fn spread_over<'a>(
        &self,
        part: &'a [SteadyMotion],
        most: usize,
        size: f64,
    ) -> Vec<&'a SteadyMotion> {
        let [low, high] = self.question.range;
        let mut way = 0.0;
        let mut ways = vec![way];
        ways.extend(part.windows(2).map(|pair| {
            let parameter = (pair[1].parameter - pair[0].parameter) / (high - low);
            way += parameter.hypot((pair[1].peak - pair[0].peak) / size);
            way
        }));
        let steps = most.min(part.len());
        let nearest = |step: usize| {
            let there = way * (2 * step + 1) as f64 / (2 * steps) as f64;
            let behind = ways.partition_point(|way| *way < there).min(part.len() - 1);
            match behind {
                0 => 0,
                _ if there - ways[behind - 1] < ways[behind] - there => behind - 1,
                _ => behind,
            }
        };
        let mut chosen: Vec<usize> = (0..steps).map(nearest).collect();
        chosen.dedup();
        chosen.into_iter().map(|index| &part[index]).collect()
    }

    /// Simulations beside points, each over its number of periods, from starts that are moved by
    /// this part of their peaks; `size` is the largest peak of all branches.
    fn simulated_beside(
        &self,
        points: &[(&SteadyMotion, usize)],
        (disturbance, size): (f64, f64),
        budget: &mut SimulationBudget,
    ) -> Vec<Option<Simulated>> {
        const CLOSELY: f64 = 1e-8;
        let start =
            |point: &SteadyMotion| [point.start[0] + disturbance * point.peak, point.start[1]];
        if self.driven.jumps() > 0 {
            let run = |&(point, most): &(&SteadyMotion, usize)| {
                let (frequency, positions) = self.simulated_by_series(start(point), point, most)?;
                Some(simulated(point, &positions, None, frequency, size))
            };
            return points.iter().map(run).collect();
        }
        if self.driven.self_excited {
            let run = |&(point, most): &(&SteadyMotion, usize)| {
                let guess =
                    Guess { start: start(point), frequency: point.frequency, size: point.peak };
                let (frequency, positions) =
                    cycle::settle_cycle(&self.driven, &guess, point.parameter, most, budget)?;
                Some(simulated(point, &positions, None, frequency, size))
            };
            return points.iter().map(run).collect();
        }
        let starts = points.iter().map(|&(point, most)| SettlingStart {
            start: start(point),
            parameter: point.parameter,
            most,
            known: vec![],
        });
        let settled = settle_together(&self.driven, &starts.collect::<Vec<_>>(), CLOSELY, budget);
        let run = |((point, _), settled): (&(&SteadyMotion, usize), Option<Settled>)| {
            let Settled { positions, peak, .. } = settled?;
            Some(simulated(point, &positions, Some(peak), point.frequency, size))
        };
        points.iter().zip(settled).map(run).collect()
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

/// The error of a point against a simulation, whose peak is that of its samples unless it is known.
fn simulated(
    point: &SteadyMotion,
    positions: &[f64],
    peak: Option<f64>,
    frequency: f64,
    size: f64,
) -> Simulated {
    let [cosine, sine] = first_harmonic(positions);
    let amplitude = cosine.hypot(sine);
    let peak = peak.unwrap_or_else(|| half_of_peak_to_peak(positions));
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
