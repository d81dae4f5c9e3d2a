//! Stable motions that are found by simulations from all around.
//!
//! ```text
//! P(not found) = (1 - p)^n:   p the part of the starts that a motion attracts, n simulations
//! ```
//!
//! Simulations begin at values of the parameter all over the range, in rounds, from places all around in the
//! plane of position and velocity. Between two rounds the branches through the motions that were new are
//! followed, so that simulations end where they come to a known motion. With m motions at a value the
//! mean of p is 1/m, and the number of simulations there grows with m. When the rounds find nothing new, others at
//! values between theirs follow that take a quarter of the work of the branches, or as much where motions with
//! small p are known: a motion may be stable in a hundredth of the range. A motion that simulations do not come to
//! may still be found: by the mirror image of another one, or by a motion of more periods, or chaos, that
//! surrounds it. In: the first branches. Out: more of them, and the simulations that
//! did not become periodic. Costs up to 250 periods a simulation, fewer where the motions are known.

use std::f64::consts::TAU;

use super::PreparedRequest;
use super::backbone::{farthest_rest, nonlinear_size};
use super::balance::DrivenBalance;
use super::continuation::{BranchNode, BranchPath};
use super::driven::Driven;
use super::jump::{StopCondition, follow};
use super::seeds::{PlannedSimulation, Search, Seed, VALUES};
use super::stability::{MotionGuess, SAMPLES, TOLERANCE, TrueMotion, options, periodic_motions};
use super::unfollowed::MotionWithImages;
use crate::system::LANES;

/// Radii of the starts about the origin, relative to the largest motion.
const RADII: [f64; 2] = [0.5, 1.3];

/// The number of intervals of the parameter, for each of those between the first simulations, in which
/// simulations begin from all around: a branch apart from others may be short.
const FINER: u32 = 5;

/// An interval of the parameter in which simulations begin from all around.
struct Interval {
    /// The value at which the first of them begin, in its middle or at an end of the range.
    value: f64,
    /// The number of simulations.
    simulations: usize,
    /// The largest number of stable motions that are known at one value.
    stable: usize,
    /// The numbers of periods of other motions, `None` of those that do not repeat themselves.
    others: Vec<Option<usize>>,
}

impl Interval {
    /// Whether more simulations are needed before it is likely that no motion is missing.
    fn needs_more(&self) -> bool {
        /// The number of motions from which on some of them may attract few starts.
        const MANY: usize = 3;
        /// The number of simulations for each motion: one with half of the mean part of the starts is
        /// missed in exp(-4) of all cases.
        const EACH: usize = 8;
        let motions = self.stable + self.others.len();
        motions >= MANY && self.simulations < EACH * motions
    }
}

/// The greatest speed of free motions between -size and size, of which one rests at the highest place of
/// the potential: `sqrt(2 (max V - min V))`, V of the mean force over the drive by the trapezoidal rule.
fn swing_speed(driven: &Driven, parameter: f64, size: f64) -> f64 {
    const PLACES: u32 = 32;
    const PHASES: u32 = 8;
    let step = 2.0 * size / f64::from(PLACES);
    let mean_force = driven.mean_force(parameter, PHASES);
    let forces: Vec<f64> =
        (0..=PLACES).map(|place| mean_force(f64::from(place) * step - size)).collect();
    let (mut potential, mut least, mut greatest) = (0.0, 0.0, 0.0);
    for pair in forces.windows(2) {
        potential += 0.5 * (pair[0] + pair[1]) * step;
        (least, greatest) = (potential.min(least), potential.max(greatest));
    }
    let speed = (2.0_f64 * (greatest - least)).sqrt();
    if speed.is_finite() { speed } else { 0.0 }
}

impl PreparedRequest<'_> {
    /// The number of simulations of the first round, at the values of the search and at those that were added.
    pub(super) fn simulations_of_a_round(&self, added: usize) -> usize {
        let intervals = if self.driven.undamped { 0 } else { self.intervals().len() };
        (intervals + added) * RADII.len() * self.speeds_of_starts()
    }

    /// Adds the motions on which simulations from all around settle, and follows their branches, until it is
    /// likely that none is missing; `added` are values of the parameter besides those of the search.
    pub(super) fn search_all_around(
        &self,
        balance: &DrivenBalance,
        added: &[f64],
        branches: &mut Vec<BranchPath>,
        found: &mut Search,
    ) {
        /// The number of searches of the whole range, the first one included, while they find new branches or
        /// motions that are on none, and the number of all.
        const ROUNDS: usize = 4;
        const MOST: usize = 48;
        /// The part of the work of the branches that later searches take if no motions have shown small basins;
        /// if some have, they take as much as the branches.
        const PART: usize = 4;
        let mut intervals = self.intervals();
        let mut before = found.motions.seeds.len();
        self.search_round(balance, branches, &mut intervals, |_| true, 0, found);
        // Motions at the added values are far smaller, or larger, than those at others.
        for value in added {
            let own = found.motions.seeds.iter().filter(|seed| seed.parameter == *value);
            let size = own.map(Seed::extent).fold(0.0, f64::max);
            let size = if size > 0.0 { size } else { found.size };
            let size = self.sizes_of_starts(size)[0];
            self.search_around(&[(0, *value)], (0, 1), size, found);
        }
        let mut spent_later = 0;
        for round in 1..MOST {
            let new = &found.motions.seeds[before..];
            let known = branches.len();
            if !new.is_empty() {
                *branches = self.branches_through(balance, new, found.size, branches);
            }
            let has_small_basins = !found.motions.elsewhere.is_empty();
            let is_early = round < self.sizes_of_starts(found.size).len()
                || round < ROUNDS && (branches.len() > known || has_small_basins);
            let part = if has_small_basins { 1 } else { PART };
            let later = (self.work_of(balance, branches) / part).saturating_sub(spent_later);
            let is_later = !is_early && later > 0;
            let is_asked = |interval: &Interval| is_early || is_later || interval.needs_more();
            let is_over = found.is_spent() || self.question.interrupt.is_requested();
            if is_over || !intervals.iter().any(is_asked) {
                return;
            }
            before = found.motions.seeds.len();
            let asked = intervals.iter().filter(|interval| is_asked(interval)).count();
            self.question.progress.begin(asked * RADII.len() * self.speeds_of_starts());
            let rest = found.budget.evaluations;
            if is_later {
                found.budget.evaluations = later;
            }
            self.search_round(balance, branches, &mut intervals, is_asked, round, found);
            if is_later {
                spent_later += later - found.budget.evaluations;
                found.budget.evaluations = rest;
            }
        }
    }

    /// About the number of evaluations of the force that take as long as these branches took.
    fn work_of(&self, balance: &DrivenBalance, branches: &[BranchPath]) -> usize {
        /// A point by shooting: a few periods with their variations.
        const SHOT: usize = 3_000;
        let points: usize = branches.iter().map(|path| path.nodes.len()).sum();
        // A balance of n unknowns solves linear equations, n^3 operations, some times a point.
        let balanced = (2 * balance.core.harmonics + 1).pow(3) / 4;
        let work = points * if self.period_series.is_some() { SHOT } else { balanced };
        // Side by side, simulations by series take an eighth of the time.
        if self.driven.has_series() { work } else { work / 8 }
    }

    /// The intervals in which simulations begin from all around.
    fn intervals(&self) -> Vec<Interval> {
        let [low, high] = self.question.range;
        // Motions of several periods come from fewer starts, each from its own.
        let count = FINER * (VALUES - 1) * u32::try_from(self.question.periods).unwrap_or(1);
        let interval = |index: u32| Interval {
            value: low + (high - low) * f64::from(index) / f64::from(count),
            simulations: 0,
            stable: 0,
            others: vec![],
        };
        (0..=count).map(interval).collect()
    }

    /// A round of simulations in the intervals that are asked for, each time at another value in them.
    fn search_round(
        &self,
        balance: &DrivenBalance,
        branches: &[BranchPath],
        intervals: &mut [Interval],
        is_asked: impl Fn(&Interval) -> bool,
        round: usize,
        found: &mut Search,
    ) {
        let [low, high] = self.question.range;
        let width = (high - low) / (intervals.len() - 1) as f64;
        // Between -1/2 and 1/2, and 0 in the first round.
        let shift = (GOLDEN * round as f64 + 0.5).fract() - 0.5;
        let asked: Vec<(usize, f64)> = (0..intervals.len())
            .filter(|index| is_asked(&intervals[*index]))
            .map(|index| (index, (intervals[index].value + shift * width).clamp(low, high)))
            .collect();
        let values: Vec<f64> = asked.iter().map(|(_, value)| *value).collect();
        self.take_for_known(balance, branches, &values, found);
        let before = found.motions.elsewhere.len();
        let sizes = self.sizes_of_starts(found.size);
        let size = sizes[round % sizes.len()];
        self.search_around(&asked, (round, intervals.len()), size, found);
        let elsewhere = found.motions.elsewhere.split_off(before);
        for (index, value) in asked {
            let interval = &mut intervals[index];
            if !found.is_spent() {
                interval.simulations += RADII.len() * self.speeds_of_starts();
            }
            let stable = found.stable_at(value).count();
            interval.stable = interval.stable.max(stable);
            for place in elsewhere.iter().filter(|place| place.parameter == value) {
                let is_new = !interval.others.contains(&place.periods);
                if is_new {
                    interval.others.push(place.periods);
                }
                if is_new || round == 0 {
                    found.motions.elsewhere.push(place.clone());
                }
            }
        }
    }

    /// The motions on these branches at values of the parameter, stable or not, each with its value; and stable ones
    /// to which iterations from these branches led.
    fn motions_on(
        &self,
        balance: &DrivenBalance,
        branches: &[BranchPath],
        values: &[f64],
    ) -> [Vec<(f64, TrueMotion)>; 2] {
        /// The distance of a motion from its guess, in parts of its size, up to which it is on the branch.
        const NEAR: f64 = 0.1;
        let guess = |(pair, parameter): (&[BranchNode], f64)| {
            let [one, other] = pair else { return None };
            let part = one.part_of_way(other, parameter)?;
            let [from, to] = [one, other].map(|node| node.begins(balance));
            let start = [0, 1].map(|index| from[index] + part * (to[index] - from[index]));
            Some(MotionGuess { start, parameter, size: balance.core.extent(&one.coefficients) })
        };
        let pairs = branches.iter().flat_map(|path| path.nodes.windows(2));
        let pairs = pairs.flat_map(|pair| values.iter().map(move |value| (pair, *value)));
        let guesses: Vec<MotionGuess> = pairs.filter_map(guess).collect();
        let truths = periodic_motions(&self.driven, &guesses);
        // Newton's iteration from a guess may lead to a motion that is on no branch.
        let is_near = |guess: &MotionGuess, truth: &TrueMotion| {
            let [x, v] = [0, 1].map(|index| truth.start[index] - guess.start[index]);
            x.hypot(v / truth.frequency) <= NEAR * guess.size
        };
        let (mut known, mut strayed) = (vec![], vec![]);
        for (guess, truth) in guesses.iter().zip(truths) {
            let Some(truth) = truth else { continue };
            let own = match is_near(guess, &truth) {
                true => &mut known,
                false if truth.floquet.largest() < 1.0 => &mut strayed,
                false => continue,
            };
            if !is_among(own, guess.parameter, &truth) {
                own.push((guess.parameter, truth));
            }
        }
        [known, strayed]
    }

    /// The stable motions near the mirror images, half a period of the drive later, of those that are known, unless
    /// they are among them: a force that is nearly odd has two motions where an odd one has a motion and its image.
    fn near_mirror_images(
        &self,
        known: &[(f64, TrueMotion)],
        stable: &[MotionWithImages],
    ) -> Vec<(f64, TrueMotion)> {
        let [low, high] = self.question.range;
        if self.is_odd(0.5 * (low + high)) {
            return vec![];
        }
        let guess = |motion: &MotionWithImages| {
            let &MotionWithImages { parameter, size, .. } = motion;
            Some(MotionGuess { start: *motion.starts.get(1)?, parameter, size })
        };
        let guesses: Vec<MotionGuess> = stable.iter().filter_map(guess).collect();
        let truths = periodic_motions(&self.driven, &guesses);
        let mut found: Vec<(f64, TrueMotion)> = vec![];
        for (guess, truth) in guesses.iter().zip(truths) {
            let Some(truth) = truth.filter(|truth| truth.floquet.largest() < 1.0) else { continue };
            let is_in = |motions: &[(f64, TrueMotion)]| is_among(motions, guess.parameter, &truth);
            if !is_in(known) && !is_in(&found) {
                found.push((guess.parameter, truth));
            }
        }
        found
    }

    /// Whether the force changes its sign with those of position and velocity half a period of the drive later, by
    /// values at places that are not special.
    fn is_odd(&self, parameter: f64) -> bool {
        const PLACES: u32 = 6;
        const ROUNDING: f64 = 1e-12;
        let half = 0.5 * TAU / self.question.periods as f64;
        (0..PLACES).all(|place| {
            let [x, v] = [0.37, 0.83].map(|part| 2.0 * (part * f64::from(place + 1)).fract() - 1.0);
            let theta = 1.1 * f64::from(place);
            let force = self.driven.force(&[x, v, theta, parameter]);
            let mirrored = self.driven.force(&[-x, -v, theta + half, parameter]);
            (force + mirrored).abs() <= ROUNDING * (force.abs() + 1.0)
        })
    }

    /// Takes the motions of branches for known, and those to which iterations strayed, or mirror images led, for
    /// new ones.
    fn take_for_known(
        &self,
        balance: &DrivenBalance,
        branches: &[BranchPath],
        values: &[f64],
        found: &mut Search,
    ) {
        let [known, mut new] = self.motions_on(balance, branches, values);
        let stable = self.stable_with_images(&known);
        new.extend(self.near_mirror_images(&known, &stable));
        found.images = self.other_images(&stable).collect();
        found.known = known;
        let begin = |(parameter, motion): &(f64, TrueMotion)| PlannedSimulation {
            seed: None,
            start: motion.start,
            parameter: *parameter,
        };
        let planned: Vec<PlannedSimulation> = new.iter().map(begin).collect();
        self.add_settled(&planned, found);
        found.images.extend(self.other_images(&self.stable_with_images(&new)));
        found.known.extend(new);
    }

    /// The stable ones of these motions, each with its images.
    fn stable_with_images(&self, motions: &[(f64, TrueMotion)]) -> Vec<MotionWithImages> {
        let stable = motions.iter().filter(|(_, motion)| motion.floquet.largest() < 1.0);
        let guess = |&(parameter, motion): &(f64, TrueMotion)| MotionGuess {
            start: motion.start,
            parameter,
            size: motion.peak,
        };
        let guesses: Vec<MotionGuess> = stable.map(guess).collect();
        let all = self.images_together(&guesses).into_iter();
        let with_images = |(starts, guess): (Vec<[f64; 2]>, &MotionGuess)| {
            let &MotionGuess { parameter, size, .. } = guess;
            MotionWithImages { parameter, starts, size }
        };
        all.zip(&guesses).map(with_images).collect()
    }

    /// The images of these motions that are motions as well: the same ones drive periods later, and where the force
    /// is odd their mirror images. Simulations come to them, too.
    fn other_images<'a>(
        &self,
        motions: &'a [MotionWithImages],
    ) -> impl Iterator<Item = MotionGuess> + use<'a> {
        let [low, high] = self.question.range;
        let is_odd = self.is_odd(0.5 * (low + high));
        motions.iter().flat_map(move |motion| {
            let &MotionWithImages { parameter, size, .. } = motion;
            // Every other one is half a drive period later, and mirrored.
            let starts = motion.starts.iter().enumerate().skip(1);
            let own = starts.filter(move |(halves, _)| is_odd || halves.is_multiple_of(2));
            own.map(move |(_, start)| MotionGuess { start: *start, parameter, size })
        })
    }

    /// The number of speeds that starts all around have at each place: that of the drive, and for motions
    /// of several periods, which swing with a frequency of their own, that of a free swing.
    fn speeds_of_starts(&self) -> usize {
        self.question.periods.min(2)
    }

    /// The sizes of starts in turn, from that of the largest motion that is known: where it is smaller than
    /// nonlinear motions are, theirs as well.
    fn sizes_of_starts(&self, size: f64) -> Vec<f64> {
        /// Part of the size of nonlinear motions below which the known ones are hardly more than rest, and
        /// multiple of it that starts reach.
        const SMALL: f64 = 0.01;
        const REACH: f64 = 2.0;
        let [low, high] = self.question.range;
        let values = [low, 0.5 * (low + high), high];
        let nonlinear = values.map(|at| nonlinear_size(&self.driven, at));
        let nonlinear = nonlinear.into_iter().fold(0.0, f64::max);
        let size = if size > SMALL * nonlinear { size } else { nonlinear };
        // A motion over a hilltop of the potential is larger than all that stay in a well.
        let rests = values.map(|at| farthest_rest(&self.driven, at, size));
        let size = rests.into_iter().fold(size, f64::max);
        let larger = Some(REACH * nonlinear).filter(|larger| *larger > size);
        std::iter::once(size).chain(larger).collect()
    }

    /// Adds the motions on which simulations settle from places all around in the plane of position
    /// and velocity, in proportion to a size, at values with their numbers among all; other places in each round.
    fn search_around(
        &self,
        values: &[(usize, f64)],
        (round, all): (usize, usize),
        size: f64,
        found: &mut Search,
    ) {
        /// Parts of a turn from one value to the next, which leave no direction out, from one radius to the
        /// other, and from one speed to the other.
        const TURNS: [f64; 3] = [GOLDEN, 0.5, 0.25];
        let around = |&(index, parameter): &(usize, f64)| {
            let omega = self.driven.frequency_at(parameter) * self.question.periods as f64;
            let places = (0..self.speeds_of_starts())
                .flat_map(|speed| (0..RADII.len()).map(move |ring| [speed, ring]));
            places.map(move |[speed, ring]| {
                let turns = [index + round * all, ring, speed].map(|count| count as f64);
                let turn: f64 = TURNS.iter().zip(turns).map(|(part, count)| part * count).sum();
                let (sine, cosine) = (TAU * turn).sin_cos();
                // The rings of later rounds lie inside those of the first.
                let size = RADII[ring] * size * (1.0 - 0.5 * (GOLDEN * round as f64).fract());
                // Another round has the other speed first.
                let speed = match (speed + round) % 2 {
                    0 => size * omega,
                    _ => swing_speed(&self.driven, parameter, size),
                };
                PlannedSimulation { seed: None, start: [size * cosine, -speed * sine], parameter }
            })
        };
        let planned: Vec<PlannedSimulation> = values.iter().flat_map(around).collect();
        for planned in planned.chunks(4 * LANES) {
            if self.question.interrupt.is_requested() {
                return;
            }
            planned.iter().for_each(|_| self.question.progress.advance());
            self.add_settled(planned, found);
        }
        self.add_surrounded(found);
    }

    /// Adds the motions that those surround which did not become periodic, stable or not: the branch of a motion
    /// that doubled its period here may be stable elsewhere, between two values of the search.
    fn add_surrounded(&self, found: &mut Search) {
        let guesses = std::mem::take(&mut found.returns);
        for (guess, truth) in guesses.iter().zip(periodic_motions(&self.driven, &guesses)) {
            let Some(truth) = truth else { continue };
            let (parameter, frequency) = (guess.parameter, truth.frequency);
            if is_among(&found.known, parameter, &truth) {
                continue;
            }
            found.known.push((parameter, truth));
            let period = StopCondition::Time(TAU / frequency);
            let settings = options(truth.peak, TOLERANCE);
            let path = follow(&self.driven, truth.start, parameter, period, &settings);
            if let Some(path) = path {
                let (positions, start) = (path.positions(SAMPLES), Some(truth.start));
                found.motions.seeds.push(Seed { parameter, frequency, positions, start });
            }
        }
    }
}

/// The golden section, whose multiples leave no part of a turn out.
const GOLDEN: f64 = 0.618_034;

/// Whether a motion is among these, each with its value of the parameter.
fn is_among(known: &[(f64, TrueMotion)], parameter: f64, motion: &TrueMotion) -> bool {
    /// Relative distance of motions that are one.
    const SAME: f64 = 1e-6;
    known.iter().any(|(own, known)| {
        let apart = [0, 1].map(|index| (known.start[index] - motion.start[index]).abs());
        *own == parameter && apart[0].max(apart[1]) <= SAME * motion.peak
    })
}
