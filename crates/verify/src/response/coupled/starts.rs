//! The motions from which branches of a driven system start.
//!
//! At several values of the parameter: the motions to which simulations settle, from rest and from
//! states of every size; that which Newton's method finds from rest; and those near guesses of one
//! harmonic. Then the motions that branch off where branches cross. Simulations afterwards show
//! what was missed.

use std::f64::consts::TAU;

use super::branches::{Known, Start};
use super::flow::Flow;
use super::problem::{CoupledProblem, Orbit};
use super::sliding::SlidingStop;
use crate::response::aperiodic::{LaterMotion, PeriodSamples, SAMPLES};
use crate::response::{Elsewhere, ResponseDiagram, ResponseError, SeedSearch, Simulated};

/// The extent of the search.
struct Effort {
    /// Values of the parameter at which branches are searched for.
    values: usize,
    /// Simulated starts at each of them.
    starts: usize,
    /// Values of the parameter at which simulations look for motions that were missed, and starts
    /// at each.
    checks: [usize; 2],
}

impl Effort {
    /// The extent for this many states: a period with its variations costs as their cube in the
    /// worst case, and a search is to take about as long as its branches.
    fn of(states: usize) -> Self {
        match states {
            ..=8 => Self { values: 9, starts: 4, checks: [7, 4] },
            9..=20 => Self { values: 5, starts: 3, checks: [5, 2] },
            _ => Self { values: 3, starts: 1, checks: [2, 1] },
        }
    }
}

/// Numbers of periods of a simulation: after each of the first number it is looked at whether the
/// motion comes to a known one; the second is the largest number.
const SETTLING: [usize; 2] = [40, 400];

/// A number between 0 and 1 for each index and dimension, evenly spread.
pub(super) fn spread(index: usize, dimension: usize) -> f64 {
    // The fractional parts of multiples of square roots of primes are independent.
    const PRIMES: [f64; 16] = [
        2.0, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0, 19.0, 23.0, 29.0, 31.0, 37.0, 41.0, 43.0, 47.0, 53.0,
    ];
    let root = PRIMES[dimension % PRIMES.len()].sqrt() * (1.0 + (dimension / PRIMES.len()) as f64);
    ((index + 1) as f64 * root).fract()
}

/// A simulation that has gone on for a time.
pub(super) struct Settled {
    /// The state at the end of it.
    pub(super) state: Vec<f64>,
    /// The number of periods of the motion after which it repeats itself; `None` if it does not.
    pub(super) periods: Option<usize>,
    /// The largest distance, in the sizes of the states, of its end from the beginnings of periods
    /// before.
    pub(super) spread: f64,
}

impl CoupledProblem<'_> {
    /// Follows a motion until it repeats itself, or for the longest time.
    fn settle(
        &self,
        start: Vec<f64>,
        parameter: f64,
        scale: &[f64],
        most: usize,
    ) -> Option<Settled> {
        /// Change over a period, relative to the sizes, below which a motion has settled.
        const SETTLED: f64 = 1e-8;
        const MOST_REPEATS: usize = 8;
        let sizes = self.state_sizes(&vec![0.0; self.states.len()], scale);
        let apart = |one: &[f64], other: &[f64]| {
            let each = one.iter().zip(other).zip(&sizes);
            each.map(|((one, other), size)| ((one - other) / size).abs()).fold(0.0, f64::max)
        };
        let mut past: Vec<Vec<f64>> = vec![self.in_front_of_walls(start, parameter)];
        for _ in 0..most {
            let last = past.last()?;
            let next = self.after(last, [0.0, TAU], parameter, scale)?;
            let repeats = past.iter().rev().take(MOST_REPEATS);
            let repeats = { repeats }.position(|before| apart(before, &next) <= SETTLED);
            past.push(next);
            if let Some(count) = repeats {
                return Some(Settled { state: past.pop()?, periods: Some(count + 1), spread: 0.0 });
            }
        }
        let state = past.pop()?;
        let spread = past.iter().map(|before| apart(before, &state)).fold(0.0, f64::max);
        Some(Settled { state, periods: None, spread })
    }

    /// The state mirrored in every wall behind which it is at the beginning of a period.
    fn in_front_of_walls(&self, state: Vec<f64>, parameter: f64) -> Vec<f64> {
        self.in_phase.as_ref().unwrap_or(&self.in_time).in_front_of_walls(state, parameter)
    }

    /// A state of random directions, of a size between a part of that of the largest motion and
    /// several times it.
    fn random_state(&self, index: usize, parameter: f64, scale: &[f64]) -> Vec<f64> {
        const SIZES: [f64; 2] = [0.1, 6.0];
        let n = self.coordinates;
        let largest = scale[..n].iter().copied().fold(0.0, f64::max);
        let largest = if largest > 0.0 { largest } else { 1.0 };
        let factor = SIZES[0] * (SIZES[1] / SIZES[0]).powf(spread(index, 0));
        let omega = self.frequency_at(parameter) * self.question.periods as f64;
        let own = |state: usize| {
            let own = largest * factor * (2.0 * spread(index, state + 1) - 1.0);
            if state < n { own } else { own * omega }
        };
        let mut state: Vec<f64> = (0..self.states.len()).map(own).collect();
        if let Some(modes) = &self.modes {
            modes.set(&mut state, index);
        }
        state
    }

    /// The values of the parameter at which something is done, in the middle of equal parts of the
    /// range.
    fn values(&self, count: usize) -> Vec<f64> {
        let [low, high] = self.question.range;
        (0..count).map(|i| low + (high - low) * (i as f64 + 0.5) / count as f64).collect()
    }

    /// All steady states of a driven system that are found, and their orbits.
    pub(super) fn driven_response(&self) -> Result<(ResponseDiagram, Known), ResponseError> {
        let mut known = self.driven_branches(false);
        if known.branches.is_empty() {
            self.look_for_repeats();
            return Err(self.nothing_found(SeedSearch::default()));
        }
        let (simulated, elsewhere) = match self.undamped {
            true => (vec![], vec![]),
            false => self.checked_by_simulation(&mut known),
        };
        self.follow_crossings(&mut known);
        self.without_parts(&mut known);
        Ok((self.diagram(&known, simulated, elsewhere), known))
    }

    /// The branches of a driven system; a `quick` search has fewer simulations.
    pub(super) fn driven_branches(&self, quick: bool) -> Known {
        let n = self.states.len();
        let mut known = Known::default();
        let Effort { values, starts, .. } = Effort::of(n);
        let starts = if quick { 1 } else { starts };
        if !quick {
            self.question.progress.begin(3 * values);
        }
        let advance = || {
            if !quick {
                self.question.progress.advance();
            }
        };
        // Simulations come to motions of the size that the drive keeps up, beside which Newton's method may
        // come to enormous ones.
        for (place, parameter) in self.values(values).into_iter().enumerate() {
            for index in 0..starts {
                if self.is_done(&known) || self.undamped {
                    break;
                }
                let scale = with_size(&known.scale, n);
                // What rests on a wall tells little of the size of the motions that leave it.
                const BEYOND_REST: f64 = 4.0;
                let rests = |orbit: &Orbit| orbit.kept.encounters.stuck > 0.0;
                let mut branches = known.branches.iter();
                let any_rests = !self.walls.is_empty()
                    && branches.any(|branch| branch.orbits.iter().any(rests));
                let reach = if any_rests { BEYOND_REST } else { 1.0 };
                let start = match index {
                    0 => vec![0.0; n],
                    index => {
                        let reach: Vec<f64> = scale.iter().map(|size| reach * size).collect();
                        self.random_state(place * starts + index, parameter, &reach)
                    }
                };
                let settled = self.settle(start, parameter, &scale, SETTLING[0]);
                let Some(settled) = settled else { continue };
                let start = Start { parameter, unknowns: settled.state, section: 0.0 };
                self.follow_from(&start, &mut known);
            }
            advance();
        }
        let rest = |parameter: f64| Start {
            parameter,
            unknowns: self.in_front_of_walls(vec![0.0; n], parameter),
            section: 0.0,
        };
        for parameter in self.values(values) {
            self.follow_from(&rest(parameter), &mut known);
            advance();
        }
        for parameter in self.values(values) {
            if self.is_done(&known) {
                break;
            }
            for unknowns in self.guesses(parameter, &known.scale) {
                self.follow_from(&Start { parameter, unknowns, section: 0.0 }, &mut known);
            }
            advance();
        }
        self.follow_beyond_grazings(&mut known);
        self.follow_crossings(&mut known);
        known
    }

    /// Looks whether a long simulation in the middle of the range repeats itself after some periods of the drive,
    /// where no motion was found.
    fn look_for_repeats(&self) {
        if self.undamped || self.question.interrupt.is_requested() || self.is_exhausted() {
            return;
        }
        let [low, high] = self.question.range;
        let rest = vec![0.0; self.states.len()];
        if let Some(settled) = self.settle(rest.clone(), 0.5 * (low + high), &rest, SETTLING[1]) {
            self.repeats.set(settled.periods.map(|count| count * self.question.periods));
        }
    }

    /// The error where no motion was found.
    pub(super) fn nothing_found(&self, tried: SeedSearch) -> ResponseError {
        let parameter = self.question.parameter;
        if self.question.interrupt.is_requested() {
            return ResponseError::Interrupted { parameter, tried };
        }
        if self.rests.get() {
            return ResponseError::NothingMoves { parameter, range: self.question.range };
        }
        let flows = self.in_phase.iter().chain([&self.in_time]);
        if let Some(error) = flows.clone().find_map(Flow::ended_at_event) {
            return error;
        }
        let stopped = flows.clone().find_map(Flow::stopped);
        match stopped {
            Some((SlidingStop::Chatter(_), argument)) => {
                ResponseError::Chatters(argument.to_string())
            }
            Some((_, argument)) => ResponseError::UndeterminedFriction(argument.to_string()),
            None => ResponseError::NoMotion {
                parameter,
                at: 0.5 * (self.question.range[0] + self.question.range[1]),
                undamped: self.undamped,
                repeats: self.repeats.get(),
            },
        }
    }

    /// Simulations that settle on known motions, and those that settle elsewhere. A motion of the
    /// period that is not known gives its branch.
    fn checked_by_simulation(&self, known: &mut Known) -> (Vec<Simulated>, Vec<Elsewhere>) {
        let (mut simulated, mut elsewhere) = (Vec::new(), Vec::new());
        let [values, starts] = Effort::of(self.states.len()).checks;
        for (place, parameter) in self.values(values).into_iter().enumerate() {
            for index in 0..starts {
                if self.is_exhausted() || self.question.interrupt.is_requested() {
                    return (simulated, elsewhere);
                }
                let scale = known.scale.clone();
                let start = self.random_state(1000 + place * starts + index, parameter, &scale);
                let Some((start, periods, found)) = self.settled_on(start, parameter, known) else {
                    continue;
                };
                match found {
                    Some(found) => simulated.push(found),
                    None => elsewhere.extend(self.elsewhere(&start, periods)),
                }
            }
        }
        Elsewhere::sort(&mut elsewhere);
        self.follow_further(&mut elsewhere, &known.scale);
        simulated.dedup_by(|one, other| {
            one.parameter == other.parameter && (one.peak / other.peak - 1.0).abs() < 1e-3
        });
        (simulated, elsewhere)
    }

    /// Simulates until the motion is beside a known orbit, repeats itself, or goes on without coming to
    /// rest although whatever damping takes away has died out; `None` if it has not settled. In: the
    /// start. Out: the end, after how many periods it repeats itself, and the known orbit.
    fn settled_on(
        &self,
        start: Vec<f64>,
        parameter: f64,
        known: &mut Known,
    ) -> Option<(Start, Option<usize>, Option<Simulated>)> {
        /// Powers of e by which disturbances have decayed on the average.
        const DECAYED: f64 = 12.0;
        /// Ratio of the spread of a motion to what it was before, below which it still shrinks.
        const SHRINKS: f64 = 0.9;
        let [chunk, most] = SETTLING;
        let period = TAU / self.frequency_at(parameter);
        let mut state = start;
        let (mut before, mut decayed) = (f64::INFINITY, 0.0);
        for _ in 0..most / chunk {
            let scale = known.scale.clone();
            let Settled { state: end, periods, spread } =
                self.settle(state, parameter, &scale, chunk)?;
            let start = Start { parameter, unknowns: end.clone(), section: 0.0 };
            if periods == Some(1) {
                self.follow_from(&start, known);
            }
            let found = self.compared(&start, periods, known);
            if found.is_some() || periods.is_some() {
                // What friction holds altogether is no motion, and what it holds almost is none of its own.
                let is_held = |orbit: Orbit| self.is_at_rest(&orbit) || self.creeps(&orbit);
                let rests = self.in_time.jumps()
                    && found.is_none()
                    && self.driven_orbit_near(&start, &known.scale).is_some_and(is_held);
                return if rests { None } else { Some((start, periods, found)) };
            }
            let trace = self.in_time.linearised(&end, 0.0, parameter).by_state.trace();
            decayed -= trace * period * chunk as f64 / self.states.len() as f64;
            if decayed > DECAYED && spread > SHRINKS * before {
                return Some((start, None, None));
            }
            (state, before) = (end, spread);
        }
        None
    }

    /// A settled simulation beside the known orbit on which it lies; `None` if there is none.
    fn compared(&self, start: &Start, periods: Option<usize>, known: &Known) -> Option<Simulated> {
        /// Distance from an orbit, relative to its size, within which a simulation has settled on it,
        /// or comes to it still.
        const NEAR: f64 = 0.05;
        let orbit = self.driven_orbit_near(start, &known.scale)?;
        let own = self.state_at_phase(&orbit, start.section, &known.scale)?;
        let sizes = self.state_sizes(&orbit.kept.travel, &known.scale);
        let each = own.iter().zip(&start.unknowns).zip(&sizes);
        let apart = each.map(|((one, other), size)| ((one - other) / size).abs());
        let apart = apart.fold(0.0, f64::max);
        // A motion that winds about an orbit on its way to it may seem to repeat itself later.
        const WINDING: f64 = 1e-4;
        let near = if periods.is_some_and(|count| count > 1) { WINDING } else { NEAR };
        if apart > near {
            return None;
        }
        let multipliers = self.multipliers(&orbit)?;
        if !self.is_stable(&multipliers) && periods.is_none() {
            return None;
        }
        self.find(&orbit, known)?;
        let transform = crate::numeric::harmonics::Transform::new(256);
        let motion = self.motion(&orbit, &transform, &known.scale);
        Some(Simulated {
            parameter: start.parameter,
            frequency: motion.frequency,
            amplitude: motion.amplitude,
            peak: motion.peak,
            error: if periods.is_some() { apart } else { 0.0 },
        })
    }

    /// A simulation that has settled on something that is not among the branches.
    fn elsewhere(&self, start: &Start, periods: Option<usize>) -> Option<Elsewhere> {
        let parameter = start.parameter;
        let duration = TAU / self.frequency_at(parameter) * periods.unwrap_or(1) as f64;
        let path = self.by_series(&start.unknowns, [0.0, duration], parameter)?;
        const SAMPLES: usize = 512;
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut cosine, mut sine) = (0.0, 0.0);
        for index in 0..SAMPLES {
            let part = index as f64 / SAMPLES as f64;
            let states = path.states_at(path.end() * part)?;
            let value = self.shown.call(&states[..self.coordinates]);
            (low, high) = (low.min(value), high.max(value));
            let angle = TAU * part * periods.unwrap_or(1) as f64;
            cosine += value * angle.cos() * 2.0 / SAMPLES as f64;
            sine += value * angle.sin() * 2.0 / SAMPLES as f64;
        }
        let places = &start.unknowns[..self.coordinates];
        let rates = self.in_time.rates_at(&start.unknowns, 0.0, parameter);
        let moved: Vec<f64> = places.iter().zip(rates.iter()).map(|(x, v)| x + 1e-6 * v).collect();
        let place = self.shown.call(places);
        Some(Elsewhere {
            parameter,
            periods,
            drive_periods: periods.map(|count| count * self.question.periods),
            start: [place, (self.shown.call(&moved) - place) / 1e-6],
            state: start.unknowns.clone(),
            amplitude: cosine.hypot(sine),
            peak: 0.5 * (high - low),
            aperiodic: None,
        })
    }

    /// Follows the motions further that do not repeat themselves, and says how they go on.
    fn follow_further(&self, elsewhere: &mut Vec<Elsewhere>, scale: &[f64]) {
        for place in elsewhere.iter_mut().filter(|place| place.periods.is_none()) {
            let parameter = place.parameter;
            let samples = |state: &[f64]| {
                let mut positions = Vec::with_capacity(SAMPLES);
                let mut end = state.to_vec();
                for part in 0..SAMPLES {
                    if self.is_exhausted() || self.question.interrupt.is_requested() {
                        return None;
                    }
                    positions.push(self.shown.call(&end[..self.coordinates]));
                    let phases = [part, part + 1].map(|part| TAU * part as f64 / SAMPLES as f64);
                    end = self.after(&end, phases, parameter, scale)?;
                }
                Some(PeriodSamples { positions, end })
            };
            let omega = self.frequency_at(parameter);
            match LaterMotion::of(&place.state, &self.angles, omega, samples) {
                Some(LaterMotion::Aperiodic(motion)) => place.aperiodic = Some(motion),
                Some(LaterMotion::Periodic(count, unknowns)) => {
                    let start = Start { parameter, unknowns, section: 0.0 };
                    *place = self.elsewhere(&start, Some(count)).unwrap_or_else(|| place.clone());
                }
                None => {}
            }
        }
        Elsewhere::sort(elsewhere);
    }
}

/// Sizes of all states where none are known yet.
fn with_size(scale: &[f64], states: usize) -> Vec<f64> {
    match scale.is_empty() {
        true => vec![0.0; states],
        false => scale.to_vec(),
    }
}
