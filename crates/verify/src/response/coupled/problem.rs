//! Coupled equations with numbers for all parameters but one, and the maps whose fixed points are
//! their motions.
//!
//! ```text
//! driven:        dy/dtheta = F(theta/omega, y; p)/omega                 over 2 pi, unknowns y; p
//! self-excited:  y' = F(y; p),                   F_k(y; p) = 0          over T, unknowns y, T; p
//! free:          dy/dtheta = (F(y) + lambda (0, q'))/omega,  v_k = 0    over 2 pi, unknowns y, lambda; omega
//! ```
//!
//! Free motions without damping come in families, one motion for each energy. The artificial damping
//! lambda makes the equations of a closed orbit regular, and is zero on each of them (F. J.
//! Munoz-Almaraz and others, *Physica D* 181 (2003) 1). Without a drive a motion may begin anywhere
//! on itself: it begins where the rate of one state is zero, at a turn of it.

use std::borrow::Cow;
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

use super::counters::Counters;
use super::event_modes::{self, EventModes};
use super::flow::{Encounters, Flow, FlowImage, TOLERANCE};
use super::state_jumps::{StateJumps, angles, drive_of, flow_in_phase};
use super::surfaces::largest;
use crate::coupled::{CoupledEquations, Energy};
use crate::event::StateEvent;
use crate::expr::{CompiledFunction, Expr};
use crate::numeric::orbit_branch::{OrbitEquations, OrbitPoint, PeriodImage};
use crate::response::{ResponseError, ResponseRequest};
use crate::symbol::{Symbol, fresh};
use crate::system::{Solver, System, SystemOptions};
use crate::wall::Wall;

/// The travel of each state of an orbit: half of the way from its lowest to its highest value.
pub(super) type Travel = Vec<f64>;

/// The data of a motion over its period that are kept.
#[derive(Clone, Debug)]
pub(super) struct Course {
    pub(super) travel: Travel,
    /// The derivative of the states after the period by those at the beginning.
    pub(super) monodromy: DMatrix<f64>,
    /// Rests, impacts and events in the period.
    pub(super) encounters: Encounters,
    /// The phase at which the period begins, of a driven motion; else zero.
    pub(super) section: f64,
}

/// An orbit of a branch.
pub(super) type Orbit = OrbitPoint<Course>;

/// The beginning of a motion: of one without a drive the state whose rate is zero there, or which has a level there,
/// and a size for that rate or for its distance from the level over the unknown that goes with it; of a driven one the
/// phase.
#[derive(Clone, Copy, Debug)]
pub(super) struct Anchor {
    pub(super) state: usize,
    pub(super) size: f64,
    /// The level of the state; `None` if its rate is zero.
    pub(super) level: Option<f64>,
    /// Whether all rates are zero there, and half a period later: of free motions beside which there are
    /// others with a shift between the coordinates, so that the one rate does not fix the motion.
    pub(super) from_rest: bool,
    /// The phase of the drive.
    pub(super) section: f64,
}

impl Anchor {
    /// The anchor of driven motions that begin at phase zero.
    pub(super) const NONE: Self =
        Self { state: 0, size: 1.0, level: None, from_rest: false, section: 0.0 };

    /// The anchor of driven motions that begin at a phase.
    pub(super) fn at_phase(section: f64) -> Self {
        Self { section, ..Self::NONE }
    }

    /// This anchor at the beginning of an orbit.
    pub(super) fn of_orbit(self, orbit: &Orbit) -> Self {
        Self { section: orbit.kept.section, ..self }
    }
}

/// The equations of orbits.
pub(super) type Orbits<'a> = OrbitEquations<'a, Course, Course>;

/// The kind of motions that a system has.
#[derive(Clone, Debug)]
pub(super) enum Kind {
    /// Motions with the period of a drive, or of some.
    Driven(Drive),
    /// Limit cycles.
    SelfExcited,
    /// Nonlinear normal modes: free motions without damping.
    Free,
}

/// The drive.
#[derive(Clone, Debug)]
pub(super) struct Drive {
    /// Its frequency, in the parameter.
    pub(super) frequency: Expr,
    /// The frequency of the motion, that of the drive over the number of its periods.
    pub(super) base: CompiledFunction,
}

/// Coupled equations of which one parameter varies.
pub(super) struct CoupledProblem<'a> {
    pub(super) question: &'a ResponseRequest,
    pub(super) kind: Kind,
    /// The number of coordinates; they are the first of the states.
    pub(super) coordinates: usize,
    /// The states, as in [`CoupledEquations`].
    pub(super) states: Vec<Symbol>,
    /// The right sides in time, with numbers for all parameters but one.
    pub(super) right: Vec<Expr>,
    /// The right sides in time, compiled; without a drive the orbits of cycles are those of this.
    pub(super) in_time: Flow,
    /// The right sides in the phase of the drive or of a free motion.
    pub(super) in_phase: Option<Flow>,
    /// The Taylor series of the motion, which judges.
    pub(super) series: Solver,
    /// Whether no corner occurs, such as `abs` or `max`.
    pub(super) smooth: bool,
    /// The walls, with numbers for all parameters but one, and the mass matrix of their impacts.
    pub(super) walls: Vec<Wall>,
    pub(super) mass: Vec<Vec<Expr>>,
    /// The other events, with numbers for all parameters but one.
    pub(super) events: Vec<StateEvent>,
    /// Whether a motion backward in time is a motion, so that nothing damps.
    pub(super) undamped: bool,
    /// The quantity that is listed, in the coordinates.
    pub(super) shown: CompiledFunction,
    /// The coordinates that are angles: a turn of 2 pi changes nothing.
    pub(super) angles: Vec<usize>,
    /// Whether a motion was met in which dry friction holds everything.
    pub(super) rests: Cell<bool>,
    /// The number of periods of the drive after which a simulation was seen to repeat itself.
    pub(super) repeats: Cell<Option<usize>>,
    /// The energy of a free motion without damping, and the place of rest from which it is counted.
    pub(super) energy: Option<(Energy, Vec<f64>)>,
    /// The states that change at events alone, among finitely many values.
    pub(super) modes: Option<EventModes>,
    /// The states that only count, which are not among these states.
    pub(super) counters: Option<Counters>,
}

/// A value of the parameter with which nothing cancels; every motion has its own.
const ANY: f64 = 0.618_034;

/// Largest number of steps of a motion by Taylor series.
pub(super) const STEP_LIMIT: usize = 50_000;

/// The smallest size used as a scale, as a fraction of the largest of its kind.
pub(super) const SMALLEST: f64 = 0.1;

impl<'a> CoupledProblem<'a> {
    pub(super) fn new(
        question: &'a ResponseRequest,
        equations: &CoupledEquations,
    ) -> Result<Self, ResponseError> {
        let time = Symbol::new("t");
        let rates = &equations.rates;
        let driven = rates.right.iter().chain(question.of_jumps()).any(|part| part.contains(time));
        let velocities = &rates.states[equations.coordinates.len()..];
        let reversible = is_reversible(&rates.right, equations.coordinates.len(), velocities)?;
        // An impact takes energy, or else the motions are not those of a smooth system.
        let undamped = reversible && !question.has_jumps_of_states();
        let takes_nothing = |wall: &Wall| wall.restitution == Expr::one();
        let are_lossless = question.events.is_empty() && question.walls.iter().all(takes_nothing);
        if reversible && !undamped && !driven && are_lossless {
            return Err(ResponseError::WallsWithoutLoss);
        }
        let free = undamped && !driven;
        let (parameter, parameters) = (question.parameter, question.parameters());
        // Free motions have a frequency for each energy, which is what varies.
        let of_frequency = free && parameter.name() == "omega" && !parameters.contains(&parameter);
        match of_frequency {
            true => question.check_values_but(&parameters, None)?,
            false if free => return Err(ResponseError::FreeParameter(parameter)),
            false => question.check_values_but(&parameters, Some(parameter))?,
        }
        if !driven && question.periods != 1 {
            return Err(ResponseError::NoPeriods(question.periods));
        }
        let values: BTreeMap<Symbol, Expr> = question.values.split(&parameters).0;
        let right: Vec<Expr> = rates
            .right
            .iter()
            .map(|rate| rate.substitute_all(&values))
            .collect::<Result<_, _>>()?;
        let states = rates.states.clone();
        let StateJumps { walls, mass, events, flow_events } =
            StateJumps::new(question, equations, &values)?;
        let in_time =
            Flow::new(&states, time, &right, parameter, &flow_events)?.until(question.interrupt);
        let numbers = [(parameter, ANY)].into();
        let series = System::new(&states, time, &right, &numbers)
            .map_err(|error| ResponseError::Rates(error.to_string()))?
            .solver(&[], &SystemOptions { step_limit: STEP_LIMIT, ..SystemOptions::default() });
        let names: Vec<Symbol> = states.iter().copied().chain([parameter, time]).collect();
        let (kind, in_phase) = match (driven, free) {
            (true, _) => {
                let (frequency, base) = drive_of(&right, &flow_events, &states, question.periods)?;
                let flow =
                    flow_in_phase(&names, &states, (&right, &flow_events), &base, parameter)?;
                let base = CompiledFunction::new(&base, &[parameter])?;
                (Kind::Driven(Drive { frequency, base }), Some(flow))
            }
            (false, true) => {
                let damping = fresh("lambda", &names);
                let first = equations.coordinates.len();
                let damped = |(index, rate): (usize, &Expr)| match index < first {
                    true => rate.clone(),
                    false => rate + &(Expr::from(damping) * Expr::from(states[index])),
                };
                let mut rates: Vec<Expr> = right.iter().enumerate().map(damped).collect();
                rates.push(Expr::zero());
                let all: Vec<Symbol> = states.iter().copied().chain([damping]).collect();
                let flow =
                    flow_in_phase(&names, &all, (&rates, &[]), &Expr::from(parameter), parameter)?;
                (Kind::Free, Some(flow))
            }
            (false, false) => (Kind::SelfExcited, None),
        };
        let shown = question.of.clone().unwrap_or_else(|| Expr::from(equations.coordinates[0]));
        let foreign =
            shown.symbols().into_iter().find(|name| !equations.coordinates.contains(name));
        if let Some(name) = foreign {
            let known = equations.coordinates.clone();
            return Err(ResponseError::NotShown { name, known });
        }
        let energy = match kind {
            Kind::Free => Energy::new(equations, &values),
            _ => None,
        };
        let mut problem = Self {
            question,
            energy: None,
            modes: EventModes::new(&states, &right, &events),
            counters: None,
            rests: Cell::new(false),
            repeats: Cell::new(None),
            angles: angles(&states, &right, &flow_events, parameter, equations.coordinates.len())?,
            smooth: !right.iter().any(Expr::contains_corner),
            kind,
            coordinates: equations.coordinates.len(),
            shown: CompiledFunction::new(&shown, &equations.coordinates)?,
            states,
            right,
            walls,
            mass,
            events,
            in_time,
            in_phase: in_phase.map(|flow: Flow| flow.until(question.interrupt)),
            series,
            undamped,
        };
        problem.has_frequency()?;
        let endless = event_modes::endless(&problem.states, &problem.right, &problem.events)?;
        let is_angle = |state: Symbol| problem.angles.iter().any(|i| problem.states[*i] == state);
        if let Some((state, value)) = endless.filter(|(state, _)| !is_angle(*state)) {
            return Err(ResponseError::CountsAndActs { state, value: Box::new(value) });
        }
        problem.energy = energy.and_then(|energy| Some((energy, problem.rest()?)));
        Ok(problem)
    }

    /// Whether the search has taken as much work as it may: of motions with hundreds of swings in a
    /// period there are many branches, and each point of them takes long.
    pub(super) fn is_exhausted(&self) -> bool {
        /// Largest number of evaluations for each motion and variation: some twenty seconds of two coordinates.
        const MOST_WORK: u64 = 300_000_000;
        let in_phase = self.in_phase.as_ref().map_or(0, Flow::evaluations);
        self.in_time.evaluations() + in_phase > MOST_WORK
    }

    /// Checks that the frequency of a motion is positive in all of the range.
    fn has_frequency(&self) -> Result<(), ResponseError> {
        let [low, high] = self.question.range;
        let frequency = match &self.kind {
            Kind::Driven(drive) => drive.frequency.to_string(),
            Kind::Free => self.question.parameter.to_string(),
            Kind::SelfExcited => return Ok(()),
        };
        for part in 0..=20 {
            let at = low + (high - low) * f64::from(part) / 20.0;
            let value = self.frequency_at(at);
            if !(value > 0.0 && value.is_finite()) {
                let (value, parameter) =
                    (value * self.question.periods as f64, self.question.parameter);
                return Err(ResponseError::Frequency { frequency, value, parameter, at });
            }
        }
        Ok(())
    }

    /// The frequency of a motion at a parameter; NaN for cycles, each of which has its own.
    pub(super) fn frequency_at(&self, parameter: f64) -> f64 {
        match &self.kind {
            Kind::Driven(drive) => drive.base.call(&[parameter]),
            Kind::Free => parameter,
            Kind::SelfExcited => f64::NAN,
        }
    }

    /// The frequency of an orbit.
    pub(super) fn frequency_of(&self, orbit: &Orbit) -> f64 {
        match self.kind {
            Kind::SelfExcited => TAU / orbit.unknowns[self.states.len()],
            _ => self.frequency_at(orbit.parameter()),
        }
    }

    /// The sizes of the states near a motion with this travel, where other motions have that of
    /// `scale`: at least a tenth of the largest of its kind, positions or velocities.
    pub(super) fn state_sizes(&self, travel: &[f64], scale: &[f64]) -> Vec<f64> {
        let n = self.coordinates;
        /// Size of what is rounding where nothing moves and states are set to numbers.
        const NOTHING: f64 = 1e-12;
        let least = self.least_sizes(travel);
        let least_size = if self.question.has_jumps_of_states() { NOTHING } else { 0.0 };
        let own = |index: usize| {
            let kind = usize::from(index >= n);
            let of_kind = if kind == 0 { &travel[..n] } else { &travel[n..self.states.len()] };
            let largest = of_kind.iter().copied().fold(0.0, f64::max);
            let others = scale.get(index).copied().unwrap_or(0.0);
            let size = travel[index].max(SMALLEST * largest.max(others)).max(least[kind]);
            if size > least_size && size.is_finite() { size } else { 1.0 }
        };
        (0..self.states.len()).map(own).collect()
    }

    /// The least sizes of positions and velocities of a motion with this travel. Where dry friction holds
    /// all that moved, velocities are rounding, and no sizes.
    fn least_sizes(&self, travel: &[f64]) -> [f64; 2] {
        const LEAST: f64 = 1e-3;
        if !self.in_time.jumps() {
            return [0.0; 2];
        }
        let [low, high] = self.question.range;
        let frequency = self.frequency_at(0.5 * (low + high));
        let frequency = if frequency > 0.0 { frequency } else { 1.0 };
        let largest = |part: &[f64]| part.iter().copied().fold(0.0, f64::max);
        let (positions, velocities) = travel[..self.states.len()].split_at(self.coordinates);
        [LEAST * largest(velocities) / frequency, LEAST * largest(positions) * frequency]
    }

    /// The sizes of all unknowns of an orbit.
    pub(super) fn sizes(
        &self,
        travel: &[f64],
        scale: &[f64],
        unknowns: &DVector<f64>,
    ) -> DVector<f64> {
        let mut sizes = self.state_sizes(travel, scale);
        let [low, high] = self.question.range;
        match self.kind {
            Kind::SelfExcited => sizes.push(unknowns[self.states.len()].abs()),
            Kind::Free => sizes.push(unknowns[unknowns.len() - 1].abs()),
            Kind::Driven(_) => {}
        }
        sizes.push(high - low);
        DVector::from_vec(sizes)
    }

    /// Whether nothing moves on an orbit, because dry friction holds everything: no motion.
    pub(super) fn is_at_rest(&self, orbit: &Orbit) -> bool {
        let rests = orbit.kept.encounters.places.len() == self.coordinates;
        self.rests.set(self.rests.get() || rests);
        rests
    }

    /// Calls a function with the equations of orbits; `scale` is the travel of the largest known
    /// motion.
    pub(super) fn with_orbits<T>(
        &self,
        scale: &[f64],
        anchor: Anchor,
        call: impl FnOnce(&Orbits) -> T,
    ) -> T {
        let interrupt = self.question.interrupt;
        // Where dry friction holds motions of a branch it holds them at the same place.
        let places = RefCell::new(Vec::new());
        let map = |start: &DVector<f64>, parameter: f64| {
            // A branch may be looked for beyond the range, where the frequency need not be positive.
            let runs = matches!(self.kind, Kind::SelfExcited) || self.frequency_at(parameter) > 0.0;
            if !runs || interrupt.is_requested() {
                return None;
            }
            let start_of = start.as_slice();
            let held_at = |image| at_places(image, start_of, &mut places.borrow_mut());
            match self.kind {
                Kind::Driven(_) => {
                    self.driven_image(start_of, parameter, scale, anchor.section).map(held_at)
                }
                Kind::SelfExcited => {
                    self.cycle_image(start_of, parameter, scale, anchor).map(held_at)
                }
                Kind::Free if anchor.from_rest => {
                    self.image_from_rest(start.as_slice(), parameter, scale)
                }
                Kind::Free => self.free_image(start.as_slice(), parameter, scale, anchor),
            }
        };
        let keep = |_: &DVector<f64>, image: &PeriodImage<Course>| image.path.clone();
        let sizes = |orbit: &Orbit| self.sizes(&orbit.kept.travel, scale, &orbit.unknowns);
        call(&OrbitEquations {
            map: &map,
            smooth: self.smooth,
            accuracy: TOLERANCE,
            rounding: 1e-9,
            keep: &keep,
            sizes: &sizes,
        })
    }

    /// The sizes in which a motion from a start is followed.
    pub(super) fn sizes_of_start(&self, start: &[f64], scale: &[f64]) -> Vec<f64> {
        let absolute: Vec<f64> = start.iter().map(|value| value.abs()).collect();
        let largest: Vec<f64> = absolute
            .iter()
            .enumerate()
            .map(|(index, value)| value.max(scale.get(index).copied().unwrap_or(0.0)))
            .collect();
        self.state_sizes(&largest[..self.states.len()], scale)
    }

    /// The state of a driven motion after phases; `None` if it cannot be followed.
    pub(super) fn after(
        &self,
        start: &[f64],
        phases: [f64; 2],
        parameter: f64,
        scale: &[f64],
    ) -> Option<Vec<f64>> {
        let start = &*self.with_modes(start);
        let sizes = self.sizes_of_start(start, scale);
        let Kind::Driven(_) = self.kind else {
            return self.in_time.end(start, phases, parameter, &sizes);
        };
        self.in_phase.as_ref()?.end(start, phases, parameter, &sizes)
    }

    /// The start with values that the modes have.
    fn with_modes<'b>(&self, start: &'b [f64]) -> Cow<'b, [f64]> {
        match &self.modes {
            Some(modes) => Cow::Owned(modes.nearest(start)),
            None => Cow::Borrowed(start),
        }
    }

    /// The image of a motion after which the modes are what they were at its start, as a function that has no other
    /// value of them beside; `None` if they are not.
    fn closed_modes(&self, mut image: FlowImage, start: &[f64]) -> Option<FlowImage> {
        let Some(modes) = &self.modes else { return Some(image) };
        if !modes.agree(image.end.as_slice(), start) {
            return None;
        }
        for index in modes.indices() {
            image.end[*index] = start[*index];
            image.by_start.row_mut(*index).fill(0.0);
            image.by_parameter[*index] = 0.0;
        }
        Some(image)
    }

    fn driven_image(
        &self,
        start: &[f64],
        parameter: f64,
        scale: &[f64],
        section: f64,
    ) -> Option<PeriodImage<Course>> {
        let start = &*self.with_modes(start);
        let sizes = self.sizes_of_start(start, scale);
        let phases = [section, section + TAU];
        let image = self.in_phase.as_ref()?.image(start, phases, parameter, &sizes)?;
        let FlowImage { end, by_start, by_parameter, travel, encounters } =
            self.closed_modes(image, start)?;
        let path = Course { travel, monodromy: by_start.clone(), encounters, section };
        Some(PeriodImage { end, by_start, by_parameter, path })
    }

    fn cycle_image(
        &self,
        start: &[f64],
        parameter: f64,
        scale: &[f64],
        Anchor { state, size, level, .. }: Anchor,
    ) -> Option<PeriodImage<Course>> {
        let n = self.states.len();
        let (start, period) = (&start[..n], start[n]);
        if !(period > 0.0 && period.is_finite()) {
            return None;
        }
        let start = &*self.with_modes(start);
        let sizes = self.sizes_of_start(start, scale);
        let image = self.in_time.image(start, [0.0, period], parameter, &sizes)?;
        let image = self.closed_modes(image, start)?;
        // The condition that is zero at the beginning, with its derivatives by the states and by the parameter.
        let (missed, by_state, by_own) = match level {
            Some(level) => {
                let own = |column| if column == state { 1.0 } else { 0.0 };
                (start[state] - level, DVector::from_fn(n, |column, _| own(column)), 0.0)
            }
            None => {
                let begin = self.in_time.linearised(start, 0.0, parameter);
                let by_state = begin.by_state.row(state).transpose();
                (begin.rates[state], by_state, begin.by_parameter[state])
            }
        };
        let flow = self.in_time.rates_at(image.end.as_slice(), 0.0, parameter);
        let path = Course {
            travel: image.travel,
            monodromy: image.by_start.clone(),
            encounters: image.encounters,
            section: 0.0,
        };
        let mut by_start = image.by_start.resize(n + 1, n + 1, 0.0);
        by_start.view_mut((0, n), (n, 1)).copy_from(&flow);
        for column in 0..n {
            by_start[(n, column)] = by_state[column] / size;
        }
        by_start[(n, n)] = 1.0;
        Some(PeriodImage {
            end: image.end.push(period + missed / size),
            by_start,
            by_parameter: image.by_parameter.push(by_own / size),
            path,
        })
    }

    fn free_image(
        &self,
        start: &[f64],
        omega: f64,
        scale: &[f64],
        Anchor { state, size, .. }: Anchor,
    ) -> Option<PeriodImage<Course>> {
        let n = self.states.len();
        let mut sizes = self.sizes_of_start(&start[..n], scale);
        sizes.push(omega);
        let FlowImage { mut end, mut by_start, by_parameter, travel, encounters } =
            self.in_phase.as_ref()?.image(start, [0.0, TAU], omega, &sizes)?;
        // The damping stays what it is; its row holds the rate that is to be zero.
        let velocity = state + self.coordinates;
        end[n] = start[n] + start[velocity] / size;
        for column in 0..n {
            by_start[(n, column)] = if column == velocity { 1.0 / size } else { 0.0 };
        }
        let monodromy = by_start.view((0, 0), (n, n)).into_owned();
        let path = Course { travel: travel[..n].to_vec(), monodromy, encounters, section: 0.0 };
        Some(PeriodImage { end, by_start, by_parameter, path })
    }

    /// The conditions of a free motion that begins at rest and is at rest half a period later, after
    /// which it goes back the same way:
    ///
    /// ```text
    /// v(0) = 0,   v(T/2) = 0,   lambda = 0,       M = R H^(-1) R H,   R = diag(1, -1),   H: half a period
    /// ```
    fn image_from_rest(
        &self,
        start: &[f64],
        omega: f64,
        scale: &[f64],
    ) -> Option<PeriodImage<Course>> {
        let (n, m) = (self.states.len(), self.coordinates);
        let mut sizes = self.sizes_of_start(&start[..n], scale);
        sizes.push(omega);
        let half = self.in_phase.as_ref()?.image(start, [0.0, 0.5 * TAU], omega, &sizes)?;
        let mut end = DVector::from_column_slice(start) * 2.0;
        let mut by_start = DMatrix::identity(n + 1, n + 1) * 2.0;
        let mut by_parameter = DVector::zeros(n + 1);
        for i in 0..m {
            let velocity = half.end[m + i];
            end[i] = start[i] + velocity / omega;
            for column in 0..=n {
                by_start[(i, column)] = half.by_start[(m + i, column)] / omega;
            }
            by_start[(i, i)] += 1.0;
            by_parameter[i] = half.by_parameter[m + i] / omega - velocity / (omega * omega);
        }
        let forward = half.by_start.view((0, 0), (n, n)).into_owned();
        let reversed = |matrix: DMatrix<f64>| {
            DMatrix::from_fn(n, n, |i, j| {
                if (i < m) == (j < m) { matrix[(i, j)] } else { -matrix[(i, j)] }
            })
        };
        let monodromy = reversed(forward.clone().try_inverse()?) * forward;
        // On the way back the velocities are the negative ones.
        let travel = |(i, travel): (usize, &f64)| if i < m { *travel } else { 2.0 * travel };
        let travel = half.travel[..n].iter().enumerate().map(travel).collect();
        // A free motion has neither impacts nor events.
        let path = Course { travel, monodromy, encounters: half.encounters, section: 0.0 };
        Some(PeriodImage { end, by_start, by_parameter, path })
    }
}

/// A sum of states that dry friction holds, by its factors, and its value.
type Place = (Vec<f64>, f64);

/// The image of a motion with an equation in place of one that says nothing, c y - c y = 0, for each sum
/// c y that dry friction holds: as if the motion came back to the place where those before were held, or
/// stayed where it begins, if they were not.
fn at_places(
    mut image: PeriodImage<Course>,
    start: &[f64],
    known: &mut Vec<Place>,
) -> PeriodImage<Course> {
    let value = |factors: &[f64]| -> f64 {
        factors.iter().zip(start).map(|(factor, value)| factor * value).sum()
    };
    let is_known = known.iter().map(|(factors, _)| factors).eq(&image.path.encounters.places);
    if !is_known {
        let all = image.path.encounters.places.iter();
        *known = all.map(|factors| (factors.clone(), value(factors))).collect();
    }
    for (factors, place) in known.iter() {
        let row = largest(factors);
        image.end[row] = start[row] - (value(factors) - place);
        image.by_parameter[row] = 0.0;
        image.by_start.row_mut(row).fill(0.0);
        image.by_start[(row, row)] = 1.0;
        for (column, factor) in factors.iter().enumerate() {
            image.by_start[(row, column)] -= factor;
        }
    }
    image
}

/// Whether a motion passed backward in time is a motion as well: the accelerations do not change
/// when all velocities change their signs, and there are no equations of first order.
fn is_reversible(
    right: &[Expr],
    coordinates: usize,
    velocities: &[Symbol],
) -> Result<bool, ResponseError> {
    if velocities.len() < coordinates {
        return Ok(false);
    }
    let reversed = velocities.iter().map(|name| (*name, -Expr::from(*name))).collect();
    for rate in &right[coordinates..] {
        let same = (rate - &rate.substitute_all(&reversed)?).expand()?;
        if !same.is_zero() {
            return Ok(false);
        }
    }
    Ok(true)
}
