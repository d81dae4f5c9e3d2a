//! Initial motions of branches, found by simulations that settle.

use nalgebra::DVector;

use super::backbone::places_of_rest;
use super::balance::DrivenBalance;
use super::continuation::BranchPath;
use super::stability::{SettlingStart, SimulationBudget, half_of_peak_to_peak, settle_together};
use super::{Elsewhere, PreparedRequest, ResponseError};
use crate::system::LANES;

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
}

impl Seed {
    /// Half of the way from the lowest to the highest point.
    pub(super) fn extent(&self) -> f64 {
        half_of_peak_to_peak(&self.positions)
    }
}

impl PreparedRequest<'_> {
    /// Initial motions from simulations that settle, from rest and from a ring of starts as large
    /// as the motions of the first branches; and the simulations that did not become periodic.
    pub(super) fn seeds(&self, harmonics: usize) -> Result<InitialMotions, ResponseError> {
        /// Number of values of the parameter at which simulations begin.
        const VALUES: u32 = 5;
        const RINGS: [f64; 2] = [0.5, 1.3];
        if self.driven.self_excited {
            return Ok(InitialMotions { seeds: self.cycles()?, ..InitialMotions::default() });
        }
        let [low, high] = self.question.range;
        let balance = DrivenBalance::new(&self.driven, harmonics);
        /// Fraction of the range at which the search starts: without damping there is no motion at
        /// a resonance, which a user is likely to place at an end or in the middle.
        const OFF: f64 = 0.382;
        let part = |index: u32| match self.driven.undamped {
            true => (f64::from(index) + OFF) / f64::from(VALUES),
            false => f64::from(index) / f64::from(VALUES - 1),
        };
        let values: Vec<f64> = (0..VALUES).map(|index| low + (high - low) * part(index)).collect();
        let mut seeds = Vec::new();
        let mut elsewhere = Vec::new();
        let mut planned = Vec::new();
        let mut budget = self.budget();
        let rings = if self.driven.undamped { 0 } else { 4 * RINGS.len() };
        self.question.progress.begin(values.len() * (1 + rings));
        let mut size = 0.0_f64;
        for parameter in &values {
            self.count([1, 0], seeds.len());
            self.question.progress.advance();
            let mut places = places_of_rest(&self.driven, *parameter, size.max(1.0));
            // There is a motion about the maximum between two wells as well, though it is unstable.
            if !places.contains(&0.0) {
                places.push(0.0);
            }
            for place in places {
                // The simulation starts near the motion that a balance finds from rest, if it finds
                // one.
                let found = self.balanced_from_rest(&balance, place, *parameter);
                let (seed, extent) = found.unzip();
                size = size.max(extent.unwrap_or(0.0));
                planned.push(PlannedSimulation {
                    seed,
                    start: [place, 0.0],
                    parameter: *parameter,
                });
            }
        }
        // Simulations that have Taylor series are followed side by side.
        let together = if self.driven.has_series() { 4 * LANES } else { 1 };
        for planned in planned.chunks(together) {
            elsewhere.extend(self.add_settled(planned, &mut seeds, &mut budget));
        }
        size = size.max(size_of(&seeds));
        // The ring is as large as the motions of the branches known so far.
        let first = self.branches_through(&balance, &seeds, size, &[]);
        for path in &first {
            for (seed, extent) in self.reentries(&balance, path, &seeds, size) {
                seeds.push(seed);
                size = size.max(extent);
            }
        }
        let widest = first
            .iter()
            .flat_map(|path| &path.nodes)
            .map(|node| balance.core.extent(&node.coefficients));
        size = widest.fold(size, f64::max);
        let ring = |parameter: &f64| {
            let (parameter, omega) = (*parameter, self.driven.frequency_at(*parameter));
            let turns = RINGS.iter().flat_map(|radius| (0..4_u32).map(move |turn| (radius, turn)));
            turns.map(move |(radius, turn)| {
                let (sine, cosine) =
                    (std::f64::consts::FRAC_PI_2 * (f64::from(turn) + 0.3)).sin_cos();
                let start = [radius * size * cosine, -radius * size * omega * sine];
                PlannedSimulation { seed: None, start, parameter }
            })
        };
        let rings: Vec<PlannedSimulation> = match self.driven.undamped {
            true => vec![],
            false => values.iter().flat_map(ring).collect(),
        };
        for planned in rings.chunks(together) {
            if self.question.interrupt.is_requested() {
                return Ok(InitialMotions { seeds, elsewhere, branches: first });
            }
            planned.iter().for_each(|_| self.question.progress.advance());
            elsewhere.extend(self.add_settled(planned, &mut seeds, &mut budget));
        }
        elsewhere.sort_by(Elsewhere::in_order);
        elsewhere.dedup();
        if seeds.is_empty() {
            return Err(self.no_motion_error());
        }
        Ok(InitialMotions { seeds, elsewhere, branches: first })
    }

    /// The branches through these motions, by the method that finds them; none across jumps that
    /// harmonic balance cannot treat. Those that shooting knows already are not followed again.
    pub(super) fn branches_through(
        &self,
        balance: &DrivenBalance,
        seeds: &[Seed],
        size: f64,
        known: &[BranchPath],
    ) -> Vec<BranchPath> {
        match self.period_series {
            Some(_) => self.shot_branches(balance, seeds, size, known),
            None if self.driven.is_balanced() => self.branches(balance, seeds, size),
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

    /// The motion that a balance, or shooting, finds from rest at an equilibrium, and its extent;
    /// `None` if it finds none.
    fn balanced_from_rest(
        &self,
        balance: &DrivenBalance,
        place: f64,
        parameter: f64,
    ) -> Option<(Seed, f64)> {
        if self.period_series.is_some() {
            return self.shot_from_rest(balance, place, parameter);
        }
        if !self.driven.is_balanced() {
            return None;
        }
        let mut still = DVector::zeros(balance.core.size());
        still[0] = place;
        let found = balance.solve(&still, parameter)?;
        Some((self.seed(balance, &found, parameter), balance.core.extent(&found)))
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
            let phase = std::f64::consts::TAU * sample as f64 / SAMPLES as f64;
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

    /// Adds the motions on which simulations settle, each behind the motion found beside its start;
    /// returns those that do not become periodic.
    fn add_settled(
        &self,
        planned: &[PlannedSimulation],
        seeds: &mut Vec<Seed>,
        budget: &mut SimulationBudget,
    ) -> Vec<Elsewhere> {
        const PERIODS: usize = 250;
        const CLOSELY: f64 = 1e-4;
        if self.driven.undamped || self.question.interrupt.is_requested() {
            seeds.extend(planned.iter().filter_map(|planned| planned.seed.clone()));
            return vec![];
        }
        self.count([0, planned.len()], seeds.len());
        let start = |planned: &PlannedSimulation| SettlingStart {
            start: planned.start,
            parameter: planned.parameter,
            most: PERIODS,
        };
        let starts: Vec<SettlingStart> = planned.iter().map(start).collect();
        let mut elsewhere = Vec::new();
        let all = settle_together(&self.driven, &starts, CLOSELY, budget);
        for (planned, settled) in planned.iter().zip(all) {
            let parameter = planned.parameter;
            seeds.extend(planned.seed.clone());
            let Some(settled) = settled else { continue };
            if settled.returns_after != Some(1) {
                elsewhere.push(Elsewhere { parameter, periods: settled.returns_after });
                continue;
            }
            seeds.push(Seed {
                parameter,
                frequency: self.driven.frequency_at(parameter),
                positions: settled.positions,
                start: Some(settled.state),
            });
        }
        elsewhere
    }
}

/// A simulation to be followed until it settles.
struct PlannedSimulation {
    /// The motion that was found beside its start.
    seed: Option<Seed>,
    start: [f64; 2],
    parameter: f64,
}

/// The size of the largest initial motion.
pub(super) fn size_of(seeds: &[Seed]) -> f64 {
    seeds.iter().map(Seed::extent).fold(0.0, f64::max)
}
