//! Limit cycles of systems that nothing drives: from simulations that settle, and from Hopf points.
//!
//! ```text
//! y' = F(y; p),   y(T) = y(0):   unknowns y, T; p
//! ```

use std::f64::consts::TAU;

use nalgebra::DVector;

use super::branches::{Known, Start};
use super::equilibria::HopfPoint;
use super::problem::{Anchor, CoupledProblem, Orbit, SMALLEST};
use super::starts::spread;
use crate::numeric::ode::root::find_root;
use crate::response::{Criticality, ResponseDiagram, ResponseError, SeedSearch};

/// Values of the parameter at which simulations start, and starts at each.
const SEARCH: [usize; 2] = [7, 4];

/// Duration of a simulation, in periods of small motions.
const SETTLING: f64 = 60.0;

impl CoupledProblem<'_> {
    /// All limit cycles that are found, with the equilibria.
    pub(super) fn cycle_response(&self) -> Result<ResponseDiagram, ResponseError> {
        let [low, high] = self.question.range;
        let [values, starts] = SEARCH;
        self.question.progress.begin(values);
        // What is at rest behind a wall, or on the condition of an event, is not at rest.
        let (mut equilibria, hopf) = match self.question.has_jumps_of_states() {
            true => Default::default(),
            false => self.equilibria(),
        };
        let mut known = Known::default();
        for point in &hopf {
            if let Some((orbit, anchor)) = self.small_cycle(point) {
                let is_above = orbit.parameter() > point.parameter;
                let criticality = match is_above == point.unstable_above {
                    true => Criticality::Supercritical,
                    false => Criticality::Subcritical,
                };
                let [branch, change] = point.place;
                equilibria[branch].changes[change].criticality = Some(criticality);
                self.add_branch(orbit, anchor, &mut known);
            }
        }
        let mut tried = SeedSearch::default();
        for value in 0..values {
            let parameter = low + (high - low) * (value as f64 + 0.5) / values as f64;
            tried.values += 1;
            for index in 0..starts {
                if self.is_done(&known) {
                    break;
                }
                tried.starts += 1;
                let index = value * starts + index;
                let settled = self.settled_cycle(index, parameter, &known.scale);
                let Some((start, anchor)) = settled else { continue };
                if let Some(orbit) = self.cycle_near(&start, &known.scale, anchor) {
                    self.add_branch(orbit, anchor, &mut known);
                }
            }
            self.question.progress.advance();
        }
        self.follow_crossings(&mut known);
        if known.branches.is_empty() && equilibria.is_empty() {
            return Err(match self.question.interrupt.is_requested() {
                true => self.nothing_found(tried),
                false => ResponseError::NoCycle {
                    parameter: self.question.parameter,
                    range: self.question.range,
                },
            });
        }
        let mut response = self.diagram(&known, vec![], vec![]);
        response.equilibria = equilibria;
        Ok(response.with_verdict())
    }

    /// The cycle near a start with its period.
    fn cycle_near(&self, start: &Start, scale: &[f64], anchor: Anchor) -> Option<Orbit> {
        let n = self.states.len();
        let orbit = self.orbit_near(start, scale, anchor)?;
        let travel = &orbit.kept.travel[..self.coordinates];
        let guessed = start.unknowns[n];
        let period = orbit.unknowns[n];
        let moves = travel.iter().any(|travel| *travel > 1e-6 * (1.0 + start.unknowns[0].abs()));
        if !(moves && period > 0.2 * guessed && period < 5.0 * guessed) {
            return None;
        }
        // A simulation that winds about a cycle comes back after some turns of it.
        let turns = self.turns(&orbit, scale);
        if turns == 1 {
            return Some(orbit);
        }
        let mut unknowns = orbit.unknowns.as_slice()[..=n].to_vec();
        unknowns[n] /= turns as f64;
        self.orbit_near(&Start { unknowns, ..*start }, scale, anchor)
    }

    /// The number of times that an orbit goes round the same cycle in its period.
    fn turns(&self, orbit: &Orbit, scale: &[f64]) -> usize {
        const MOST: usize = 12;
        /// Distance in the sizes of the states below which a state is that of the beginning.
        const SAME: f64 = 1e-6;
        let n = self.states.len();
        let start = &orbit.unknowns.as_slice()[..n];
        let sizes = self.state_sizes(&orbit.kept.travel, scale);
        let closes = |turns: &usize| {
            let period = orbit.unknowns[n] / *turns as f64;
            let end = self.in_time.end(start, [0.0, period], orbit.parameter(), &sizes);
            end.is_some_and(|end| {
                let apart = end.iter().zip(start).zip(&sizes);
                { apart }.all(|((one, other), size)| (one - other).abs() <= SAME * size)
            })
        };
        (2..=MOST).rev().find(closes).unwrap_or(1)
    }

    /// A cycle of small amplitude beside a Hopf point.
    fn small_cycle(&self, point: &HopfPoint) -> Option<(Orbit, Anchor)> {
        const PARTS: [f64; 6] = [0.02, 0.1, 0.005, 0.4, 1e-3, 1e-4];
        /// Ratio of the size of a cycle to that of the guess beyond which it is another one.
        const OTHER: f64 = 5.0;
        let n = self.states.len();
        let ordinary = point.state.iter().map(|value| value.abs()).fold(0.0, f64::max).max(1.0);
        // The motion of the linear equations begins where the largest coordinate turns.
        let slopes = self.in_time.linearised(&point.state, 0.0, point.parameter).by_state;
        let quarter = slopes * &point.direction / point.frequency;
        let size_of = |k: &usize| point.direction[*k].hypot(quarter[*k]);
        let turning =
            (0..self.coordinates).max_by(|one, other| size_of(one).total_cmp(&size_of(other)))?;
        let (sine, cosine) = quarter[turning].atan2(point.direction[turning]).sin_cos();
        let shape = (&point.direction * cosine + &quarter * sine).normalize();
        PARTS.into_iter().find_map(|part| {
            let size = part * ordinary;
            let mut guess = DVector::zeros(n + 2);
            for i in 0..n {
                guess[i] = point.state[i] + size * shape[i];
            }
            (guess[n], guess[n + 1]) = (TAU / point.frequency, point.parameter);
            let travel: Vec<f64> = (0..n).map(|i| size * shape[i].abs()).collect();
            let largest = travel.iter().copied().fold(0.0, f64::max);
            let travel: Vec<f64> =
                travel.into_iter().map(|travel| travel.max(SMALLEST * largest)).collect();
            let sizes = self.sizes(&travel, &[], &guess);
            let mut direction = DVector::zeros(n + 2);
            for i in 0..n {
                direction[i] = shape[i] * size / sizes[i];
            }
            let direction = direction.normalize();
            let anchor = anchor_of(turning, travel[turning], guess[n]);
            let orbit = self.with_orbits(&[], anchor, |orbits| {
                orbits.orbit_along(&guess, &direction, &sizes)
            })?;
            let extent = orbit.kept.travel[..self.coordinates].iter().copied().fold(0.0, f64::max);
            (size / OTHER..size * OTHER).contains(&extent).then_some((orbit, anchor))
        })
    }

    /// The state and the period of a simulation that comes back to itself; `None` if it does not.
    fn settled_cycle(
        &self,
        index: usize,
        parameter: f64,
        scale: &[f64],
    ) -> Option<(Start, Anchor)> {
        /// Distance from its start at which a motion has come back, relative to its size.
        const BACK: f64 = 0.05;
        const CELLS: usize = 400;
        let (n, m) = (self.states.len(), self.coordinates);
        // Periods of small motions about zero, or of the slowest of them; beside what friction holds there.
        const BESIDE: f64 = 1e-6;
        let beside = if self.in_time.jumps() { BESIDE } else { 0.0 };
        let zero: Vec<f64> = (0..n).map(|k| beside * (2.0 * spread(0, k) - 1.0)).collect();
        let fastest = self.growth(&zero, parameter)?.into_iter().map(|value| value.norm());
        let fastest = fastest.fold(0.0, f64::max);
        let mut unit = TAU / if fastest > 0.0 { fastest } else { 1.0 };
        let largest = scale.iter().take(m).copied().fold(0.0, f64::max);
        let size =
            (if largest > 0.0 { largest } else { 1.0 }) * 0.1 * 30.0_f64.powf(spread(index, 0));
        let mut start: Vec<f64> =
            (0..n).map(|k| size * (2.0 * spread(index, k + 1) - 1.0)).collect();
        if let Some(modes) = &self.modes {
            modes.set(&mut start, index);
        }
        // A relay may switch often in a period of small motions.
        const MOST_EVENTS: usize = 24;
        const HALVINGS: usize = 16;
        let events_from = |start: &[f64], duration: f64| {
            let sizes = self.sizes_of_start(start, scale);
            self.in_time.event_times(start, [0.0, duration], parameter, &sizes)
        };
        let mut halvings = if self.question.has_jumps_of_states() { HALVINGS } else { 0 };
        while halvings > 0
            && events_from(&start, unit).is_none_or(|events| events.len() > MOST_EVENTS)
        {
            unit *= 0.5;
            halvings -= 1;
        }
        let settled = self.after(&start, [0.0, SETTLING * unit], parameter, scale)?;
        let events = events_from(&settled, 12.0 * unit)?;
        let duration = events.get(MOST_EVENTS).copied().unwrap_or(12.0 * unit);
        let path = self.by_series(&settled, [0.0, duration], parameter)?;
        let rates = self.in_time.rates_at(&settled, 0.0, parameter);
        let mut low = settled.clone();
        let mut high = settled.clone();
        let time = |cell: usize| path.end() * cell as f64 / CELLS as f64;
        for cell in 0..=CELLS {
            for (index, state) in path.states_at(time(cell))?.into_iter().enumerate() {
                low[index] = low[index].min(state);
                high[index] = high[index].max(state);
            }
        }
        let travel: Vec<f64> =
            low.iter().zip(&high).map(|(low, high)| 0.5 * (high - low)).collect();
        let sizes = self.state_sizes(&travel, &[]);
        let away = |time: f64| -> Option<Vec<f64>> {
            let state = path.states_at(time)?;
            Some((0..n).map(|i| (state[i] - settled[i]) / sizes[i]).collect())
        };
        let across = |time: f64| {
            away(time).map_or(f64::NAN, |away| {
                away.iter().enumerate().map(|(i, value)| value * rates[i] / sizes[i]).sum()
            })
        };
        let back = (1..CELLS)
            .filter(|cell| across(time(*cell)) < 0.0 && across(time(cell + 1)) >= 0.0)
            .filter_map(|cell| find_root(across, time(cell), time(cell + 1)).ok());
        let is_back = |time: &f64| {
            away(*time).is_some_and(|away| away.iter().all(|value| value.abs() <= BACK))
        };
        let period = { back }.find(is_back)?;
        // It begins where the coordinate turns that moves most: the highest of many points, made
        // exact by the search for the orbit. Where friction acts at the turn it begins where a velocity
        // is largest.
        let place = |cell: usize| period * cell as f64 / CELLS as f64;
        let highest = |state: usize| {
            let height =
                |cell: usize| path.states_at(place(cell)).map_or(f64::NAN, |states| states[state]);
            let highest =
                (0..CELLS).max_by(|one, other| height(*one).total_cmp(&height(*other)))?;
            Some((state, path.states_at(place(highest))?))
        };
        // What only events set has no rate.
        let mut states: Vec<usize> = (0..n).filter(|state| !self.right[*state].is_zero()).collect();
        states.sort_by(|one, other| {
            (one >= &m).cmp(&(other >= &m)).then(travel[*other].total_cmp(&travel[*one]))
        });
        let is_smooth = |state: &&usize| self.in_time.has_smooth_turn(&self.states, **state);
        let turning = states.iter().find(is_smooth).and_then(|state| highest(*state));
        // Where an event turns the coordinate round, its rate does not vanish.
        const TURNS: f64 = 1.0;
        let turns = |(state, begin): &(usize, Vec<f64>)| {
            let rate = self.in_time.rates_at(begin, 0.0, parameter)[*state];
            rate.abs() * period <= TURNS * travel[*state]
        };
        let (begin, anchor) = match turning.filter(turns) {
            Some((state, begin)) => (begin, anchor_of(state, travel[state], period)),
            // It begins at the middle of the way of the state that moves most: at that of many points which is
            // nearest to it.
            None => {
                let flows =
                    |state: &&usize| !self.right[**state].is_zero() && travel[**state] > 0.0;
                let state = *states.iter().find(flows)?;
                let middle = 0.5 * (low[state] + high[state]);
                let states = (0..CELLS).filter_map(|cell| path.states_at(place(cell)));
                let apart = |states: &Vec<f64>| (states[state] - middle).abs();
                let begin = { states }.min_by(|one, other| apart(one).total_cmp(&apart(other)))?;
                (begin, anchor_at_level(state, middle, travel[state], period))
            }
        };
        let unknowns: Vec<f64> = begin.into_iter().chain([period]).collect();
        Some((Start { parameter, unknowns, section: 0.0 }, anchor))
    }
}

/// The anchor of a cycle where a coordinate passes a level, for motions of this travel and period.
fn anchor_at_level(state: usize, level: f64, travel: f64, period: f64) -> Anchor {
    Anchor { state, size: travel / period, level: Some(level), ..Anchor::NONE }
}

/// The anchor of a cycle at a turn of a coordinate, for motions of this travel and period.
fn anchor_of(state: usize, travel: f64, period: f64) -> Anchor {
    let travel = if travel > 0.0 { travel } else { 1.0 };
    Anchor { state, size: travel / (period * period), ..Anchor::NONE }
}
