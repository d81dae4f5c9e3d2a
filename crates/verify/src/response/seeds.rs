//! Initial motions of branches, found by simulations that settle.

use std::f64::consts::TAU;

use nalgebra::DVector;

use super::backbone::{free_oscillator, places_of_rest};
use super::balance::DrivenBalance;
use super::continuation::BranchPath;
use super::coverage::Coverage;
use super::free_swing::FreeSwings;
use super::stability::{
    MotionGuess, Settled, SettlingStart, SimulationBudget, TrueMotion, first_harmonic,
    half_of_peak_to_peak, periodic_motions, settle_together,
};
use super::{Elsewhere, MOST_HARMONICS, PreparedRequest, ResponseError};
use super::{melnikov, one_harmonic};
use crate::system::LANES;

/// Number of values of the parameter at which simulations begin.
pub(super) const VALUES: u32 = 5;

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
    /// The number of harmonics of these branches.
    pub(super) harmonics: usize,
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
            return Ok(InitialMotions {
                seeds: self.cycles()?,
                harmonics,
                ..InitialMotions::default()
            });
        }
        let balance = DrivenBalance::new(&self.driven, harmonics);
        let values = self.values_of_search();
        let covered = self.coverage_of_search();
        let added = covered.added;
        self.question.progress.begin(values.len() + self.simulations_of_a_round(added.len()));
        let mut found = Search {
            motions: InitialMotions { gaps: covered.gaps, ..InitialMotions::default() },
            budget: self.budget(),
            size: 0.0,
            known: vec![],
            images: vec![],
            returns: vec![],
        };
        let known = self.search_from_rest(&balance, &values, &mut found);
        self.search_from_guesses(&balance, (&values, &added), known, &mut found);
        let seeds = &mut found.motions.seeds;
        let balance = self.balance_for(seeds, harmonics);
        found.motions.harmonics = balance.core.harmonics;
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
            self.search_all_around(&balance, &added, &mut branches, &mut found);
        }
        found.motions.branches = branches;
        Elsewhere::sort(&mut found.motions.elsewhere);
        match found.motions.seeds.is_empty() {
            true => Err(self.no_motion_error()),
            false => Ok(found.motions),
        }
    }

    /// A balance of at least so many harmonics that sums of them come near the motions that simulations have
    /// found: with fewer there are branches of other motions, which would be followed anew.
    fn balance_for(&self, seeds: &[Seed], harmonics: usize) -> DrivenBalance<'_> {
        /// The distance of a sum from the motion, in parts of its size, up to which it comes near.
        const NEAR: f64 = 0.1;
        let mut balance = DrivenBalance::new(&self.driven, harmonics);
        let is_far = |balance: &DrivenBalance, seed: &Seed| {
            let Some([end, speed]) = seed.start else { return false };
            let near = NEAR * seed.extent();
            let [x, v] = self.begins(balance, seed);
            // A motion that still decays is no sum of harmonics.
            let repeats =
                seed.positions.first().is_some_and(|begin| (end - begin).abs() <= NEAR * near);
            repeats && (x - end).hypot((v - speed) / seed.frequency) > near
        };
        let may_have_more = self.question.harmonics.is_none() && self.period_series.is_none();
        while may_have_more
            && 2 * balance.core.harmonics <= MOST_HARMONICS
            && seeds.iter().any(|seed| is_far(&balance, seed))
        {
            balance = DrivenBalance::new(&self.driven, 2 * balance.core.harmonics);
        }
        balance
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
        let found = self.walk(size_of(seeds), size).reentries(balance, path, self.surroundings());
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
    pub(super) fn add_settled(&self, planned: &[PlannedSimulation], found: &mut Search) {
        const PERIODS: usize = 250;
        const CLOSELY: f64 = 1e-4;
        // Those that have Taylor series are followed side by side.
        let together = if self.driven.has_series() { 4 * LANES } else { 1 };
        for planned in planned.chunks(together) {
            if self.driven.undamped || self.question.interrupt.is_requested() {
                let seeds = &mut found.motions.seeds;
                seeds.extend(planned.iter().filter_map(|planned| planned.seed.clone()));
                continue;
            }
            self.count([0, planned.len()], found.motions.seeds.len());
            let start = |planned: &PlannedSimulation| SettlingStart {
                start: planned.start,
                parameter: planned.parameter,
                most: PERIODS,
                known: found.places_at(planned.parameter).collect(),
            };
            let starts: Vec<SettlingStart> = planned.iter().map(start).collect();
            let all = settle_together(&self.driven, &starts, CLOSELY, &mut found.budget);
            let InitialMotions { seeds, elsewhere, .. } = &mut found.motions;
            for (planned, settled) in planned.iter().zip(all) {
                let parameter = planned.parameter;
                seeds.extend(planned.seed.clone());
                let Some(Settled { state, returns_after, positions, peak, nearest_returns }) =
                    settled
                else {
                    continue;
                };
                if returns_after != Some(1) {
                    let guess = |start| MotionGuess { start, parameter, size: peak };
                    found.returns.extend(nearest_returns.into_iter().map(guess));
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

/// A search for initial motions.
pub(super) struct Search {
    /// The result so far.
    pub(super) motions: InitialMotions,
    /// The evaluations that are left for simulations.
    pub(super) budget: SimulationBudget,
    /// The size of the largest motion.
    pub(super) size: f64,
    /// Motions of the first branches, each with its value of the parameter.
    pub(super) known: Vec<(f64, TrueMotion)>,
    /// Images of the stable ones of them.
    pub(super) images: Vec<MotionGuess>,
    /// Guesses of motions that simulations that do not become periodic surround.
    pub(super) returns: Vec<MotionGuess>,
}

impl Search {
    /// The stable motions that are known at a value of the parameter.
    pub(super) fn stable_at(&self, parameter: f64) -> impl Iterator<Item = TrueMotion> {
        let own = self.known.iter().filter(move |(value, _)| *value == parameter);
        own.map(|(_, motion)| *motion).filter(|motion| motion.floquet.largest() < 1.0)
    }

    /// Whether no evaluations are left.
    pub(super) fn is_spent(&self) -> bool {
        self.budget.evaluations == 0
    }

    /// The starts of stable motions that are known at a value of the parameter, and of their images.
    fn places_at(&self, parameter: f64) -> impl Iterator<Item = MotionGuess> {
        let place = move |motion: TrueMotion| MotionGuess {
            start: motion.start,
            parameter,
            size: motion.peak,
        };
        let images = self.images.iter().filter(move |image| image.parameter == parameter);
        self.stable_at(parameter).map(place).chain(images.copied())
    }
}

/// A simulation to be followed until it settles.
pub(super) struct PlannedSimulation {
    /// The motion that was found beside its start.
    pub(super) seed: Option<Seed>,
    pub(super) start: [f64; 2],
    pub(super) parameter: f64,
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
