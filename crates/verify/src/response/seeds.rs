//! Initial motions of branches, found by simulations that settle.

use nalgebra::DVector;

use super::backbone::places_of_rest;
use super::balance::DrivenBalance;
use super::continuation::BranchPath;
use super::stability::{SimulationBudget, half_of_peak_to_peak, settle};
use super::{Elsewhere, PreparedRequest, ResponseError};

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

impl PreparedRequest<'_> {
    /// Initial motions from simulations that settle, from rest and from a ring of starts as large
    /// as the motions of the first branches; and the simulations that did not become periodic.
    pub(super) fn seeds(
        &self,
        harmonics: usize,
    ) -> Result<(Vec<Seed>, Vec<Elsewhere>), ResponseError> {
        /// Number of values of the parameter at which simulations begin.
        const VALUES: u32 = 5;
        const RINGS: [f64; 2] = [0.5, 1.3];
        if self.driven.self_excited {
            return Ok((self.cycles()?, vec![]));
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
                if let Some((seed, extent)) = self.balanced_from_rest(&balance, place, *parameter) {
                    size = size.max(extent);
                    seeds.push(seed);
                }
                elsewhere.extend(self.add_settled(
                    [place, 0.0],
                    *parameter,
                    &mut seeds,
                    &mut budget,
                ));
            }
        }
        size = size.max(size_of(&seeds));
        // The ring is as large as the motions of the branches known so far.
        let first: Vec<BranchPath> = match self.driven.is_balanced() {
            true => self.branches(&balance, &seeds, size),
            false => vec![],
        };
        for path in &first {
            for (found, parameter) in
                self.walk(&seeds, size).reentries(&balance, path, self.surroundings())
            {
                seeds.push(self.seed(&balance, &found, parameter));
                size = size.max(balance.core.extent(&found));
            }
        }
        let widest = first
            .iter()
            .flat_map(|path| &path.nodes)
            .map(|node| balance.core.extent(&node.coefficients));
        size = widest.fold(size, f64::max);
        if !self.driven.undamped {
            for parameter in &values {
                let omega = self.driven.frequency_at(*parameter);
                for (radius, turn) in
                    RINGS.iter().flat_map(|radius| (0..4_u32).map(move |turn| (radius, turn)))
                {
                    if self.question.interrupt.is_requested() {
                        return Ok((seeds, elsewhere));
                    }
                    self.question.progress.advance();
                    let (sine, cosine) =
                        (std::f64::consts::FRAC_PI_2 * (f64::from(turn) + 0.3)).sin_cos();
                    let start = [radius * size * cosine, -radius * size * omega * sine];
                    elsewhere.extend(self.add_settled(start, *parameter, &mut seeds, &mut budget));
                }
            }
        }
        elsewhere.sort_by(Elsewhere::in_order);
        elsewhere.dedup();
        if seeds.is_empty() {
            return Err(self.no_motion_error());
        }
        Ok((seeds, elsewhere))
    }

    /// The motion that a balance finds from rest at an equilibrium, and its extent; `None` if it
    /// finds none.
    fn balanced_from_rest(
        &self,
        balance: &DrivenBalance,
        place: f64,
        parameter: f64,
    ) -> Option<(Seed, f64)> {
        if !self.driven.is_balanced() {
            return None;
        }
        let mut still = DVector::zeros(balance.core.size());
        still[0] = place;
        let found = balance.solve(&still, parameter)?;
        Some((self.seed(balance, &found, parameter), balance.core.extent(&found)))
    }

    /// An initial motion from the solution of a balance.
    fn seed(&self, balance: &DrivenBalance, found: &DVector<f64>, parameter: f64) -> Seed {
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

    /// Adds the motion on which a simulation settles, or reports that it does not become periodic.
    fn add_settled(
        &self,
        start: [f64; 2],
        parameter: f64,
        seeds: &mut Vec<Seed>,
        budget: &mut SimulationBudget,
    ) -> Option<Elsewhere> {
        const PERIODS: usize = 250;
        const CLOSELY: f64 = 1e-4;
        if self.driven.undamped || self.question.interrupt.is_requested() {
            return None;
        }
        self.count([0, 1], seeds.len());
        let settled = settle(&self.driven, start, parameter, (PERIODS, CLOSELY), budget)?;
        if settled.returns_after != Some(1) {
            return Some(Elsewhere { parameter, periods: settled.returns_after });
        }
        seeds.push(Seed {
            parameter,
            frequency: self.driven.frequency_at(parameter),
            positions: settled.positions,
            start: Some(settled.state),
        });
        None
    }
}

/// The size of the largest initial motion.
pub(super) fn size_of(seeds: &[Seed]) -> f64 {
    seeds.iter().map(|seed| half_of_peak_to_peak(&seed.positions)).fold(0.0, f64::max)
}
