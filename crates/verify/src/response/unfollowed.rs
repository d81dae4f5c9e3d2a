//! Motions on which simulations have settled and that lie on no branch, or have not settled.
//!
//! In: the branches, and the initial motions. Out: the initial motions whose true motion, by
//! shooting, is not found by shooting from any branch: harmonic balance has not converged to it, or
//! has converged to another one.

use super::aperiodic::{LaterMotion, PeriodSamples, SAMPLES};
use super::balance::DrivenBalance;
use super::continuation::{BranchNode, BranchPath};
use super::driven::TimedStart;
use super::jump::{StopCondition, follow, positions_on};
use super::seeds::Seed;
use super::stability::{
    self, MotionGuess, TOLERANCE, TrueMotion, first_harmonic, half_of_peak_to_peak, options,
    periodic_motion, periodic_motions,
};
use super::{Elsewhere, LONGEST_STEP, PreparedRequest};
use crate::system::Path;

/// A motion at a value of the parameter, by its start and those of its images, shifted by a drive
/// period or mirrored.
pub(super) struct MotionWithImages {
    pub(super) parameter: f64,
    pub(super) starts: Vec<[f64; 2]>,
    pub(super) size: f64,
}

impl PreparedRequest<'_> {
    /// The motions reached by simulations that lie on none of these branches, each motion once.
    pub(super) fn unfollowed(
        &self,
        balance: &DrivenBalance,
        paths: &[BranchPath],
        seeds: &[Seed],
        size: f64,
    ) -> Vec<Elsewhere> {
        /// Ratio to the largest motion below which a motion is at rest.
        const NOTHING: f64 = 1e-6;
        let mut known: Vec<MotionWithImages> = Vec::new();
        let mut found = Vec::new();
        let is_meant = |seed: &&Seed| !self.driven.self_excited && seed.start.is_some();
        let guess = |seed: &Seed| {
            Some(MotionGuess { start: seed.start?, parameter: seed.parameter, size: seed.extent() })
        };
        let guesses: Vec<MotionGuess> = seeds.iter().filter(is_meant).filter_map(guess).collect();
        // A simulation ends before it has settled completely, so that shooting refines it.
        let together = if self.driven.has_series() { guesses.len().max(1) } else { 1 };
        let truths = guesses.chunks(together).flat_map(|guesses| {
            match self.question.interrupt.is_requested() {
                true => vec![None; guesses.len()],
                false => periodic_motions(&self.driven, guesses),
            }
        });
        for (guess, truth) in guesses.iter().zip(truths) {
            if self.question.interrupt.is_requested() {
                return found;
            }
            let MotionGuess { parameter, size: extent, .. } = *guess;
            let truth = truth.filter(|_| extent > NOTHING * size);
            let Some(truth) = truth else { continue };
            let start = truth.start;
            let is_known = |motion: &MotionWithImages| {
                motion.parameter == parameter && self.is_one(motion, start)
            };
            if known.iter().any(is_known) {
                continue;
            }
            let motion = MotionWithImages {
                parameter,
                starts: self.images(MotionGuess { start, parameter, size: extent }),
                size: extent,
            };
            if !paths.iter().any(|path| self.passes(balance, path, &motion)) {
                let TrueMotion { first_harmonic, peak, .. } = truth;
                found.push(self.elsewhere((start, parameter), Some(1), first_harmonic, peak));
            }
            known.push(motion);
        }
        found
    }

    /// A motion that lies on no branch, by its start at a value of the parameter, the number of
    /// its periods, the first harmonic and the size of one of them.
    pub(super) fn elsewhere(
        &self,
        (start, parameter): ([f64; 2], f64),
        periods: Option<usize>,
        [cosine, sine]: [f64; 2],
        peak: f64,
    ) -> Elsewhere {
        /// Ratio of a difference to the size below which a motion has come back.
        const SAME: f64 = 1e-3;
        let omega = self.driven.frequency_at(parameter);
        let drive_period = std::f64::consts::TAU / omega / self.question.periods as f64;
        let settings = options(peak, TOLERANCE);
        let returns = |count: usize| {
            let time = StopCondition::Time(count as f64 * drive_period);
            let end = follow(&self.driven, start, parameter, time, &settings);
            end.is_some_and(|path| {
                let [x, v, ..] = path.end;
                (x - start[0]).hypot((v - start[1]) / omega) <= SAME * peak
            })
        };
        // An odd number of drive periods is found after twice as many where the motion takes two.
        let drive_periods = periods.map(|periods| {
            let all = periods * self.question.periods;
            let mut fewer = (1..all).filter(|count| {
                all.is_multiple_of(*count) && !count.is_multiple_of(self.question.periods)
            });
            fewer.find(|count| returns(*count)).unwrap_or(all)
        });
        let amplitude = cosine.hypot(sine);
        Elsewhere {
            parameter,
            periods,
            drive_periods,
            start,
            state: vec![],
            amplitude,
            peak,
            aperiodic: None,
        }
    }

    /// Follows the motions further that do not repeat themselves, and says how they go on.
    pub(super) fn follow_further(&self, elsewhere: &mut Vec<Elsewhere>) {
        for place in elsewhere.iter_mut().filter(|place| place.periods.is_none()) {
            let parameter = place.parameter;
            let omega = self.driven.frequency_at(parameter);
            let settings = options(place.peak, TOLERANCE);
            let samples = |state: &[f64], count: usize| {
                if self.question.interrupt.is_requested() {
                    return None;
                }
                let (start, duration) = (state.try_into().ok()?, std::f64::consts::TAU / omega);
                let motion = TimedStart { start, begin: 0.0, parameter, duration };
                if let Some(path) = self.driven.by_series(&[motion]).pop().flatten() {
                    let end = path.states_at(path.end())?;
                    return Some(PeriodSamples { positions: positions_on(&path, count), end });
                }
                let time = StopCondition::Time(duration);
                let path = follow(&self.driven, start, parameter, time, &settings)?;
                let end = path.end[..2].to_vec();
                Some(PeriodSamples { positions: path.positions(count), end })
            };
            let is_angle = self.repeats_after(std::f64::consts::TAU, parameter);
            let angles: &[usize] = if is_angle { &[0] } else { &[] };
            match LaterMotion::of(&place.start, angles, omega, |state| samples(state, SAMPLES)) {
                Some(LaterMotion::Aperiodic(motion)) => place.aperiodic = Some(motion),
                Some(LaterMotion::Periodic(count, state)) => {
                    let Some(period) = samples(&state, stability::SAMPLES) else { continue };
                    let Ok(start) = state.try_into() else { continue };
                    let wave = first_harmonic(&period.positions);
                    let peak = half_of_peak_to_peak(&period.positions);
                    *place = self.elsewhere((start, parameter), Some(count), wave, peak);
                }
                None => {}
            }
        }
        Elsewhere::sort(elsewhere);
    }

    /// The starts of a motion, of its shifts by drive periods, and of their mirror images, a half of a drive period
    /// after each other.
    pub(super) fn images(&self, motion: MotionGuess) -> Vec<[f64; 2]> {
        self.images_together(&[motion]).pop().unwrap_or_default()
    }

    /// The [images](Self::images) of several motions, which are followed over a period side by side.
    pub(super) fn images_together(&self, motions: &[MotionGuess]) -> Vec<Vec<[f64; 2]>> {
        let period = |motion: &MotionGuess| {
            std::f64::consts::TAU / self.driven.frequency_at(motion.parameter)
        };
        let whole = |motion: &MotionGuess| {
            let &MotionGuess { start, parameter, .. } = motion;
            TimedStart { start, begin: 0.0, parameter, duration: period(motion) }
        };
        let halves = 2 * self.question.periods;
        let images = |(path, motion): (Option<Path>, &MotionGuess)| {
            let state = |time: f64| -> Option<[f64; 2]> {
                if let Some(path) = &path {
                    return path.states_at(time.min(path.end()))?.try_into().ok();
                }
                let settings = options(motion.size, TOLERANCE);
                let until = StopCondition::Time(time);
                let path = follow(&self.driven, motion.start, motion.parameter, until, &settings)?;
                Some([path.end[0], path.end[1]])
            };
            let after = |half: usize| {
                let [x, v] = state(period(motion) * half as f64 / halves as f64)?;
                Some(if half % 2 == 1 { [-x, -v] } else { [x, v] })
            };
            std::iter::once(motion.start).chain((1..halves).filter_map(after)).collect()
        };
        let starts: Vec<TimedStart> = motions.iter().map(whole).collect();
        self.driven.by_short_series(&starts).into_iter().zip(motions).map(images).collect()
    }

    /// Whether a start is that of this motion or of an image of it, up to a period of the force in
    /// position.
    fn is_one(&self, motion: &MotionWithImages, [x, v]: [f64; 2]) -> bool {
        /// Ratio of a difference to the size below which two motions are the same.
        const SAME: f64 = 1e-3;
        let omega = self.driven.frequency_at(motion.parameter);
        motion.starts.iter().any(|start| {
            let same_place = (x - start[0]).abs() <= SAME * motion.size;
            let same_speed = (v - start[1]).abs() <= SAME * motion.size * omega;
            same_speed && (same_place || self.repeats_after(x - start[0], motion.parameter))
        })
    }

    /// Whether a branch contains a motion, by the true motions that shooting finds from the branch
    /// at the same value of the parameter.
    fn passes(
        &self,
        balance: &DrivenBalance,
        path: &BranchPath,
        motion: &MotionWithImages,
    ) -> bool {
        let [low, high] = self.question.range;
        let parameter = motion.parameter;
        let is_it = |guess: [f64; 2]| {
            let guess = MotionGuess { start: guess, parameter, size: motion.size };
            let truth = periodic_motion(&self.driven, guess);
            // A motion to which shooting does not converge is taken as simulated.
            self.is_one(motion, truth.map_or(guess.start, |truth| truth.start))
        };
        // A branch may end a little before an end of the range.
        let ends = [path.nodes.first(), path.nodes.last()].into_iter().flatten();
        let mut beside =
            ends.filter(|node| (node.parameter - parameter).abs() <= LONGEST_STEP * (high - low));
        let between = |pair: &[BranchNode]| {
            let [one, other] = pair else { return false };
            let Some(part) = one.part_of_way(other, parameter) else {
                return false;
            };
            let [from, to] = [one, other].map(|node| node.begins(balance));
            is_it([0, 1].map(|index| from[index] + part * (to[index] - from[index])))
        };
        path.nodes.windows(2).any(between) || beside.any(|node| is_it(node.begins(balance)))
    }
}
