//! Initial motions of branches, found by simulations that settle.

use std::f64::consts::TAU;

use nalgebra::DVector;

use super::backbone::{farthest_rest, free_oscillator, places_of_rest};
use super::balance::DrivenBalance;
use super::continuation::{BranchNode, BranchPath};
use super::coverage::Coverage;
use super::driven::Driven;
use super::free_swing::FreeSwings;
use super::jump::{StopCondition, follow};
use super::stability::{
    MotionGuess, Settled, SettlingStart, SimulationBudget, TOLERANCE, TrueMotion, first_harmonic,
    half_of_peak_to_peak, options, periodic_motions, settle_together,
};
use super::{Elsewhere, PreparedRequest, ResponseError};
use super::{melnikov, one_harmonic};
use crate::system::LANES;

/// Number of values of the parameter at which simulations begin.
const VALUES: u32 = 5;

/// Radii of the starts about the origin, relative to the largest motion, and the number of values of
/// the parameter for each of those above at which simulations begin there: a branch apart from
/// others may be short, but simulations from many places come to its stable motions.
const RADII: [f64; 2] = [0.5, 1.3];
const FINER: u32 = 5;

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

/// An initial motion of a branch.
#[derive(Clone, Debug)]
pub(super) struct Seed {
    pub(super) parameter: f64,
    /// The frequency of the motion.
    pub(super) frequency: f64,
    pub(super) positions: Vec<f64>,
    /// Position and velocity at its start, if a simulation has found it.
    pub(super) start: Option<[f64; 2]>,
}

/// The result of the search for initial motions.
#[derive(Debug, Default)]
pub(super) struct InitialMotions {
    /// The initial motions.
    pub(super) seeds: Vec<Seed>,
    /// The simulations that did not become periodic.
    pub(super) elsewhere: Vec<Elsewhere>,
    /// The branches that were followed on the way.
    pub(super) branches: Vec<BranchPath>,
    /// The stretches of the range in which the values of the search are far apart.
    pub(super) gaps: Vec<[f64; 2]>,
}

impl Seed {
    /// Half of the way from the lowest to the highest point.
    pub(super) fn extent(&self) -> f64 {
        half_of_peak_to_peak(&self.positions)
    }

    /// Whether the positions differ by no more than this part of the size.
    fn is_near(&self, other: &Self, within: f64) -> bool {
        let apart = self.positions.iter().zip(&other.positions).map(|(one, two)| (one - two).abs());
        apart.fold(0.0, f64::max) <= within * self.extent().max(other.extent())
    }
}

impl PreparedRequest<'_> {
    /// Initial motions: from simulations that settle, from rest and from starts all around as large as
    /// the motions of the first branches, and from guesses of every size; and the simulations that did
    /// not become periodic.
    pub(super) fn seeds(&self, harmonics: usize) -> Result<InitialMotions, ResponseError> {
        if self.driven.self_excited {
            return Ok(InitialMotions { seeds: self.cycles()?, ..InitialMotions::default() });
        }
        let balance = DrivenBalance::new(&self.driven, harmonics);
        let values = self.values_of_search();
        let around = if self.driven.undamped { vec![] } else { self.finer_values() };
        let covered = self.coverage_of_search();
        let added = covered.added;
        let starts =
            values.len() + (around.len() + added.len()) * RADII.len() * self.speeds_of_starts();
        self.question.progress.begin(starts);
        let mut found = Search {
            motions: InitialMotions { gaps: covered.gaps, ..InitialMotions::default() },
            budget: self.budget(),
            size: 0.0,
            stable: vec![],
        };
        let known = self.search_from_rest(&balance, &values, &mut found);
        self.search_from_guesses(&balance, (&values, &added), known, &mut found);
        let seeds = &mut found.motions.seeds;
        found.size = found.size.max(size_of(seeds));
        let mut branches = self.branches_through(&balance, seeds, found.size, &[]);
        for path in &branches {
            for (seed, extent) in self.reentries(&balance, path, seeds, found.size) {
                seeds.push(seed);
                found.size = found.size.max(extent);
            }
            let extents = path.nodes.iter().map(|node| balance.core.extent(&node.coefficients));
            found.size = extents.fold(found.size, f64::max);
        }
        if !self.driven.undamped {
            let before = found.motions.seeds.len();
            self.begin_round(&balance, &branches, &around, &mut found);
            self.search_around(&around, 0, found.size, &mut found);
            // Motions at the added values are far smaller, or larger, than those at others.
            for value in &added {
                let own = found.motions.seeds.iter().filter(|seed| seed.parameter == *value);
                let size = own.map(Seed::extent).fold(0.0, f64::max);
                let size = if size > 0.0 { size } else { found.size };
                self.search_around(&[*value], 0, size, &mut found);
            }
            self.search_again(&balance, &around, before, &mut branches, &mut found);
        }
        found.motions.branches = branches;
        Elsewhere::sort(&mut found.motions.elsewhere);
        match found.motions.seeds.is_empty() {
            true => Err(self.no_motion_error()),
            false => Ok(found.motions),
        }
    }

    /// Repeats the search from all around, each time from other places, until nothing new is found; where
    /// simulations settle on motions of more periods or not at all, the largest number of times, since small
    /// basins are frequent there. The branches through the motions that were new, those after a number of
    /// motions, are followed first: simulations end where they come to a known branch.
    fn search_again(
        &self,
        balance: &DrivenBalance,
        values: &[f64],
        mut before: usize,
        branches: &mut Vec<BranchPath>,
        found: &mut Search,
    ) {
        /// The number of searches, the first one included.
        const ROUNDS: usize = 4;
        for round in 1..ROUNDS {
            let new = &found.motions.seeds[before..];
            let known = branches.len();
            if !new.is_empty() {
                *branches = self.branches_through(balance, new, found.size, branches);
            }
            let has_small_basins = !found.motions.elsewhere.is_empty();
            let is_larger = branches.len() > known;
            if !(is_larger || has_small_basins) || self.question.interrupt.is_requested() {
                return;
            }
            before = found.motions.seeds.len();
            if is_larger {
                self.begin_round(balance, branches, values, found);
            }
            self.question.progress.begin(values.len() * RADII.len() * self.speeds_of_starts());
            self.search_around(values, round, found.size, found);
        }
    }

    /// The stable motions on these branches at values of the parameter, each with its value; and others to which
    /// iterations from these branches led.
    fn stable_on(
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
        let mut stable = vec![];
        let mut strayed: Vec<(f64, TrueMotion)> = vec![];
        for (guess, truth) in guesses.iter().zip(truths) {
            let Some(truth) = truth.filter(|truth| truth.floquet.largest() < 1.0) else { continue };
            if is_near(guess, &truth) {
                stable.push((guess.parameter, truth));
            } else if !is_among(&strayed, guess.parameter, &truth) {
                strayed.push((guess.parameter, truth));
            }
        }
        [stable, strayed]
    }

    /// The stable motions near the mirror images, half a period of the drive later, of these, unless they are among
    /// them: a force that is nearly odd has two motions where an odd one has a motion and its image.
    fn near_mirror_images(&self, stable: &[(f64, TrueMotion)]) -> Vec<(f64, TrueMotion)> {
        let [low, high] = self.question.range;
        if self.is_odd(0.5 * (low + high)) {
            return vec![];
        }
        let guess = |(parameter, motion): &(f64, TrueMotion)| {
            let drive = self.driven.frequency_at(*parameter) * self.question.periods as f64;
            let half = StopCondition::Time(0.5 * TAU / drive);
            let settings = options(motion.peak, TOLERANCE);
            let [x, v, ..] = follow(&self.driven, motion.start, *parameter, half, &settings)?.end;
            Some(MotionGuess { start: [-x, -v], parameter: *parameter, size: motion.peak })
        };
        let guesses: Vec<MotionGuess> = stable.iter().filter_map(guess).collect();
        let truths = periodic_motions(&self.driven, &guesses);
        let mut found: Vec<(f64, TrueMotion)> = vec![];
        for (guess, truth) in guesses.iter().zip(truths) {
            let Some(truth) = truth.filter(|truth| truth.floquet.largest() < 1.0) else { continue };
            let is_known = |known: &[(f64, TrueMotion)]| is_among(known, guess.parameter, &truth);
            if !is_known(stable) && !is_known(&found) {
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

    /// Takes the stable motions of branches for known, and those to which iterations strayed for new ones.
    fn begin_round(
        &self,
        balance: &DrivenBalance,
        branches: &[BranchPath],
        values: &[f64],
        found: &mut Search,
    ) {
        let [stable, mut strayed] = self.stable_on(balance, branches, values);
        strayed.extend(self.near_mirror_images(&stable));
        found.stable = stable;
        let begin = |(parameter, motion): &(f64, TrueMotion)| PlannedSimulation {
            seed: None,
            start: motion.start,
            parameter: *parameter,
        };
        let planned: Vec<PlannedSimulation> = strayed.iter().map(begin).collect();
        self.add_settled(&planned, found);
        found.stable.extend(strayed);
    }

    /// The distances between the values of the parameter at which the search begins.
    pub(super) fn coverage_of_search(&self) -> Coverage {
        let values = self.values_of_guesses().chain(self.values_of_search());
        self.coverage(&values.collect::<Vec<_>>())
    }

    /// The values of the parameter at which simulations begin.
    fn values_of_search(&self) -> Vec<f64> {
        /// Fraction of the range at which the search starts: without damping there is no motion at
        /// a resonance, which a user is likely to place at an end or in the middle.
        const OFF: f64 = 0.382;
        let [low, high] = self.question.range;
        let part = |index: u32| match self.driven.undamped {
            true => (f64::from(index) + OFF) / f64::from(VALUES),
            false => f64::from(index) / f64::from(VALUES - 1),
        };
        (0..VALUES).map(|index| low + (high - low) * part(index)).collect()
    }

    /// The values of the parameter, between those at which simulations begin, at which guesses are made:
    /// more by a balance than by shooting, which costs more.
    fn values_of_guesses(&self) -> impl Iterator<Item = f64> {
        /// Number of values for each of those at which simulations begin.
        const BETWEEN: [u32; 2] = [3, 1];
        let [low, high] = self.question.range;
        let count = VALUES * BETWEEN[usize::from(self.period_series.is_some())];
        let part = move |index: u32| (f64::from(index) + 0.5) / f64::from(count);
        (0..count).map(move |index| low + (high - low) * part(index))
    }

    /// The values of the parameter at which simulations begin from all around.
    fn finer_values(&self) -> Vec<f64> {
        let [low, high] = self.question.range;
        // Motions of several periods come from fewer starts, each from its own.
        let count = FINER * (VALUES - 1) * u32::try_from(self.question.periods).unwrap_or(1);
        let part = |index: u32| f64::from(index) / f64::from(count);
        (0..=count).map(|index| low + (high - low) * part(index)).collect()
    }

    /// Adds the motions on which simulations from rest settle; returns the motions about the
    /// equilibria.
    fn search_from_rest(
        &self,
        balance: &DrivenBalance,
        values: &[f64],
        found: &mut Search,
    ) -> Vec<KnownMotion> {
        let (mut planned, mut known) = (Vec::new(), Vec::new());
        for parameter in values {
            self.count([1, 0], found.motions.seeds.len());
            self.question.progress.advance();
            for (motion, seed) in self.motions_from_rest(balance, *parameter, &mut found.size) {
                // The simulation starts near the motion that is found from rest, if one is.
                let start = [motion.place, 0.0];
                planned.push(PlannedSimulation { seed, start, parameter: *parameter });
                known.push(motion);
            }
        }
        self.add_settled(&planned, found);
        known
    }

    /// Adds motions of every size about the known ones, and about others at more values: guesses cost
    /// little, and an isolated branch may be short. Where a guess leads to none, a simulation starts.
    fn search_from_guesses(
        &self,
        balance: &DrivenBalance,
        (values, added): (&[f64], &[f64]),
        mut known: Vec<KnownMotion>,
        found: &mut Search,
    ) {
        for parameter in self.values_of_guesses().chain(added.iter().copied()) {
            let motions = self.motions_from_rest(balance, parameter, &mut found.size);
            known.extend(motions.into_iter().map(|(motion, _)| motion));
        }
        let mut without = Vec::new();
        for motion in &known {
            if self.question.interrupt.is_requested() {
                return;
            }
            // At an added value motions have a size of their own.
            let own = balance.core.extent(&motion.coefficients);
            let size = match added.contains(&motion.parameter) && own > 0.0 {
                true => own,
                false => found.size,
            };
            let (motions, starts) = self.of_every_size(balance, motion, size);
            found.motions.seeds.extend(motions);
            // A smooth force leads nearly every guess to its motion.
            if !self.driven.smooth && values.contains(&motion.parameter) {
                without.extend(starts);
            }
        }
        self.add_settled(&without, found);
    }

    /// The number of speeds that starts all around have at each place: that of the drive, and for motions
    /// of several periods, which swing with a frequency of their own, that of a free swing.
    fn speeds_of_starts(&self) -> usize {
        self.question.periods.min(2)
    }

    /// Adds the motions on which simulations settle from places all around in the plane of position
    /// and velocity, in proportion to a size; other places in each round.
    fn search_around(&self, values: &[f64], round: usize, size: f64, found: &mut Search) {
        /// Parts of a turn from one value to the next, which leave no direction out (the golden
        /// section), from one radius to the other, and from one speed to the other.
        const TURNS: [f64; 3] = [0.618_034, 0.5, 0.25];
        // A motion over a hilltop of the potential is larger than all that stay in a well.
        let [low, high] = self.question.range;
        let rests = [low, 0.5 * (low + high), high].map(|at| farthest_rest(&self.driven, at, size));
        let size = rests.into_iter().fold(size, f64::max);
        let around = |(index, parameter): (usize, &f64)| {
            let parameter = *parameter;
            let omega = self.driven.frequency_at(parameter) * self.question.periods as f64;
            let places = (0..self.speeds_of_starts())
                .flat_map(|speed| (0..RADII.len()).map(move |ring| [speed, ring]));
            places.map(move |[speed, ring]| {
                let turns = [index + round * values.len(), ring, speed].map(|count| count as f64);
                let turn: f64 = TURNS.iter().zip(turns).map(|(part, count)| part * count).sum();
                let (sine, cosine) = (TAU * turn).sin_cos();
                let size = RADII[ring] * size;
                // Another round has the other speed first.
                let speed = match (speed + round) % 2 {
                    0 => size * omega,
                    _ => swing_speed(&self.driven, parameter, size),
                };
                PlannedSimulation { seed: None, start: [size * cosine, -speed * sine], parameter }
            })
        };
        let planned: Vec<PlannedSimulation> = values.iter().enumerate().flat_map(around).collect();
        for planned in planned.chunks(4 * LANES) {
            if self.question.interrupt.is_requested() {
                return;
            }
            planned.iter().for_each(|_| self.question.progress.advance());
            self.add_settled(planned, found);
        }
    }

    /// The branches through these motions, by the method that finds them; none across jumps that
    /// harmonic balance cannot treat. Those that are known already are not followed again.
    pub(super) fn branches_through(
        &self,
        balance: &DrivenBalance,
        seeds: &[Seed],
        size: f64,
        known: &[BranchPath],
    ) -> Vec<BranchPath> {
        match self.period_series {
            Some(_) => self.shot_branches(balance, seeds, size, known),
            None if self.driven.is_balanced() => self.branches(balance, seeds, size, known),
            None => vec![],
        }
    }

    /// The motions at which a branch that leaves the range re-enters it, with their extents.
    fn reentries(
        &self,
        balance: &DrivenBalance,
        path: &BranchPath,
        seeds: &[Seed],
        size: f64,
    ) -> Vec<(Seed, f64)> {
        if self.period_series.is_some() {
            return self.shot_reentries(balance, path, self.surroundings());
        }
        let found = self.walk(seeds, size).reentries(balance, path, self.surroundings());
        let seed = |(found, parameter): (DVector<f64>, f64)| {
            (self.seed(balance, &found, parameter), balance.core.extent(&found))
        };
        found.into_iter().map(seed).collect()
    }

    /// The motions about the equilibria, each with what a balance, or shooting, finds from rest, if it
    /// finds something; `size` grows with them.
    fn motions_from_rest(
        &self,
        balance: &DrivenBalance,
        parameter: f64,
        size: &mut f64,
    ) -> Vec<(KnownMotion, Option<Seed>)> {
        let mut places = places_of_rest(&self.driven, parameter, size.max(1.0));
        // There is a motion about the maximum between two wells as well, though it is unstable.
        if !places.iter().any(|place| place.abs() <= 1e-9 * size.max(1.0)) {
            places.push(0.0);
        }
        let mut motion = |place: f64| {
            let (seed, extent) = self.balanced_from_rest(balance, place, parameter).unzip();
            *size = size.max(extent.unwrap_or(0.0));
            let coefficients = match &seed {
                Some(seed) => balance.core.coefficients_of(&[&seed.positions]),
                None => at_rest(balance, place),
            };
            (KnownMotion { place, parameter, coefficients }, seed)
        };
        places.into_iter().map(&mut motion).collect()
    }

    /// Motions of every size about a known one, each once: those found from guesses in which a single
    /// harmonic balances the forces, if shooting finds the true motion beside them, or, where the
    /// force has corners, from free motions. Where none is found from a guess, a simulation is to
    /// start there.
    fn of_every_size(
        &self,
        balance: &DrivenBalance,
        known: &KnownMotion,
        size: f64,
    ) -> (Vec<Seed>, Vec<PlannedSimulation>) {
        /// Harmonics that may be in resonance.
        const HARMONICS: usize = 3;
        /// Relative difference below which two motions are one.
        const SAME: f64 = 1e-6;
        let most = HARMONICS.max(self.question.periods);
        let &KnownMotion { place, parameter, ref coefficients } = known;
        let size = if size > 0.0 { size } else { 1.0 };
        let mut motions: Vec<Seed> = vec![self.seed(balance, coefficients, parameter)];
        let mut without = Vec::new();
        let mut add = |start: [f64; 2], found: Option<(Seed, f64)>| match found {
            Some((seed, _)) if motions.iter().any(|known| known.is_near(&seed, SAME)) => {}
            Some((seed, _)) => motions.push(seed),
            None => without.push(PlannedSimulation { seed: None, start, parameter }),
        };
        let swings = || {
            let free = free_oscillator(&self.oscillator)?;
            FreeSwings::at(&free, (self.question.parameter, parameter))
        };
        match self.period_series.as_ref().and_then(|_| swings()) {
            Some(swings) => {
                let at = (place, parameter);
                for (start, extent) in melnikov::guesses(&self.driven, &swings, at, most, size) {
                    add(start, self.shot_near(balance, start, parameter, extent));
                }
            }
            None => {
                let guesses = |number: usize| {
                    one_harmonic::guesses(balance, coefficients, (parameter, number), size)
                };
                for guess in (1..=most).flat_map(guesses) {
                    let start = balance.phase_point_at(&guess, parameter, 0.0);
                    add(start, self.motion_near(balance, &guess, parameter));
                }
            }
        }
        motions.remove(0);
        if self.period_series.is_none() {
            self.keep_true(balance, &mut motions);
        }
        (motions, without)
    }

    /// Keeps the motions of a balance beside which shooting finds a true one: with few harmonics a
    /// balance has motions of its own.
    fn keep_true(&self, balance: &DrivenBalance, motions: &mut Vec<Seed>) {
        let guess = |seed: &Seed| MotionGuess {
            start: self.begins(balance, seed),
            parameter: seed.parameter,
            size: seed.extent(),
        };
        let guesses: Vec<MotionGuess> = motions.iter().map(guess).collect();
        let mut truths = periodic_motions(&self.driven, &guesses).into_iter();
        motions.retain(|_| truths.next().flatten().is_some());
    }

    /// Position and velocity at phase zero of an initial motion.
    fn begins(&self, balance: &DrivenBalance, seed: &Seed) -> [f64; 2] {
        let coefficients = balance.core.coefficients_of(&[&seed.positions]);
        balance.phase_point_at(&coefficients, seed.parameter, 0.0)
    }

    /// The motion that a balance, or shooting, finds from these coefficients, and its extent; `None`
    /// if it finds none.
    fn motion_near(
        &self,
        balance: &DrivenBalance,
        guess: &DVector<f64>,
        parameter: f64,
    ) -> Option<(Seed, f64)> {
        if self.period_series.is_some() {
            let start = balance.phase_point_at(guess, parameter, 0.0);
            return self.shot_near(balance, start, parameter, balance.core.extent(guess));
        }
        if !self.driven.is_balanced() {
            return None;
        }
        let found = balance.solve(guess, parameter)?;
        Some((self.seed(balance, &found, parameter), balance.core.extent(&found)))
    }

    /// The motion that a balance, or shooting, finds from rest at an equilibrium, and its extent;
    /// `None` if it finds none.
    fn balanced_from_rest(
        &self,
        balance: &DrivenBalance,
        place: f64,
        parameter: f64,
    ) -> Option<(Seed, f64)> {
        match self.period_series {
            Some(_) => self.shot_from_rest(balance, place, parameter),
            None => self.motion_near(balance, &at_rest(balance, place), parameter),
        }
    }

    /// An initial motion from the solution of a balance.
    pub(super) fn seed(
        &self,
        balance: &DrivenBalance,
        found: &DVector<f64>,
        parameter: f64,
    ) -> Seed {
        const SAMPLES: usize = 256;
        let positions = (0..SAMPLES).map(|sample| {
            let phase = TAU * sample as f64 / SAMPLES as f64;
            balance.phase_point_at(found, parameter, phase)[0]
        });
        Seed {
            parameter,
            frequency: self.driven.frequency_at(parameter),
            positions: positions.collect(),
            start: None,
        }
    }

    /// The range, widened, in which branches that leave it are followed because they might come
    /// back; it contains no value of the other sign.
    fn surroundings(&self) -> [f64; 2] {
        const TIMES: f64 = 4.0;
        let [low, high] = self.question.range;
        let beyond = TIMES * (high - low).max(low.abs()).max(high.abs());
        let lowest = if low >= 0.0 { low / TIMES } else { low - beyond };
        let highest = if high <= 0.0 { high / TIMES } else { high + beyond };
        [lowest, highest]
    }

    /// Adds the motions on which simulations settle, each behind the motion found beside its start,
    /// and those that do not become periodic.
    fn add_settled(&self, planned: &[PlannedSimulation], found: &mut Search) {
        const PERIODS: usize = 250;
        const CLOSELY: f64 = 1e-4;
        // Those that have Taylor series are followed side by side.
        let together = if self.driven.has_series() { 4 * LANES } else { 1 };
        let InitialMotions { seeds, elsewhere, .. } = &mut found.motions;
        for planned in planned.chunks(together) {
            if self.driven.undamped || self.question.interrupt.is_requested() {
                seeds.extend(planned.iter().filter_map(|planned| planned.seed.clone()));
                continue;
            }
            self.count([0, planned.len()], seeds.len());
            let stable_at = |parameter: f64| {
                let own = found.stable.iter().filter(|(value, _)| *value == parameter);
                own.map(|(_, motion)| *motion).collect()
            };
            let start = |planned: &PlannedSimulation| SettlingStart {
                start: planned.start,
                parameter: planned.parameter,
                most: PERIODS,
                known: stable_at(planned.parameter),
            };
            let starts: Vec<SettlingStart> = planned.iter().map(start).collect();
            let all = settle_together(&self.driven, &starts, CLOSELY, &mut found.budget);
            for (planned, settled) in planned.iter().zip(all) {
                let parameter = planned.parameter;
                seeds.extend(planned.seed.clone());
                let Some(Settled { state, returns_after, positions, peak }) = settled else {
                    continue;
                };
                if returns_after != Some(1) {
                    let wave = first_harmonic(&positions);
                    elsewhere.push(self.elsewhere((state, parameter), returns_after, wave, peak));
                    continue;
                }
                let frequency = self.driven.frequency_at(parameter);
                seeds.push(Seed { parameter, frequency, positions, start: Some(state) });
            }
        }
    }
}

/// Whether a motion is among these, each with its value of the parameter.
fn is_among(known: &[(f64, TrueMotion)], parameter: f64, motion: &TrueMotion) -> bool {
    /// Relative distance of motions that are one.
    const SAME: f64 = 1e-6;
    known.iter().any(|(own, known)| {
        let apart = [0, 1].map(|index| (known.start[index] - motion.start[index]).abs());
        *own == parameter && apart[0].max(apart[1]) <= SAME * motion.peak
    })
}

/// A search for initial motions.
struct Search {
    /// The result so far.
    motions: InitialMotions,
    /// The evaluations that are left for simulations.
    budget: SimulationBudget,
    /// The size of the largest motion.
    size: f64,
    /// Stable motions of the first branches, each with its value of the parameter.
    stable: Vec<(f64, TrueMotion)>,
}

/// A simulation to be followed until it settles.
struct PlannedSimulation {
    /// The motion that was found beside its start.
    seed: Option<Seed>,
    start: [f64; 2],
    parameter: f64,
}

/// A motion at a value of the parameter, or rest, about which larger ones are looked for.
struct KnownMotion {
    /// The equilibrium.
    place: f64,
    parameter: f64,
    coefficients: DVector<f64>,
}

/// The coefficients of rest at a place.
fn at_rest(balance: &DrivenBalance, place: f64) -> DVector<f64> {
    let mut still = DVector::zeros(balance.core.size());
    still[0] = place;
    still
}

/// The size of the largest initial motion.
pub(super) fn size_of(seeds: &[Seed]) -> f64 {
    seeds.iter().map(Seed::extent).fold(0.0, f64::max)
}
