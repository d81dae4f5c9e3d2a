//! Orbits as steady motions: amplitudes of all coordinates, harmonics, stability, and the error
//! against the motion by Taylor series in time.
//!
//! ```text
//! error: (1 - M) dy = P(y) - y      P by Taylor series, dy: the way to the closed orbit
//! ```

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

use super::branches::{Known, OrbitBranch};
use super::changes::{changes_between, least_squares};
use super::problem::{CoupledProblem, Kind, Orbit, STEP_LIMIT};
use super::wave::{PeriodSamples, SAMPLES, Wave};
use crate::event::StateEvent;
use crate::exact::rational::from_f64;
use crate::expr::Expr;
use crate::interrupt::Interrupt;
use crate::mechanics::Rates;
use crate::numeric::harmonics::Transform;
use crate::response::bifurcation::BifurcationKind;
use crate::response::{
    Bifurcation, Branch, CoordinateMotion, Criticality, Elsewhere, MOST_HARMONICS, ResponseDiagram,
    Simulated, SteadyMotion,
};
use crate::symbol::Symbol;
use crate::system::{Integrator, Path, PathEnd};
use crate::trajectory::{Trajectory, TrajectoryRequest};
use crate::verify::Verdict;
use crate::wall::Wall;

/// Number of harmonics that are kept where none is asked for.
const HARMONICS: usize = 16;

/// Part of the period within which an event is at a time.
const AT_END: f64 = 1e-10;

/// The motion from a state by the Taylor series of the equations as they were given.
pub(super) enum OrbitPath {
    /// In one run.
    Series(Box<Path>),
    /// Across jumps of the rates, in pieces between which dry friction holds something.
    Events(Box<Trajectory>),
}

impl OrbitPath {
    /// The time at which it ends.
    pub(super) fn end(&self) -> f64 {
        match self {
            Self::Series(path) => path.end(),
            Self::Events(motion) => motion.end(),
        }
    }

    /// All states at a time; `None` outside of the motion.
    pub(super) fn states_at(&self, time: f64) -> Option<Vec<f64>> {
        match self {
            Self::Series(path) => path.states_at(time),
            Self::Events(motion) => motion.states_at(time),
        }
    }

    /// The states at the end of a period from a start; where rounding puts an event before or behind the
    /// end, as a kick at the beginning of each period, on that side of the event which is nearer to the start.
    fn closing(&self, period: f64, start: &[f64], sizes: &[f64]) -> Option<Vec<f64>> {
        let end = self.states_at(period)?;
        let Self::Events(motion) = self else { return Some(end) };
        let apart = |state: &[f64]| -> f64 {
            let parts = state.iter().zip(start).zip(sizes);
            parts.map(|((one, other), size)| ((one - other) / size).abs()).fold(0.0, f64::max)
        };
        let last = motion.events.occurrences.last();
        let last = last.filter(|last| (last.time - period).abs() <= AT_END * period);
        Some(match last.filter(|last| apart(&last.before) < apart(&end)) {
            Some(last) => last.before.clone(),
            None => end,
        })
    }

    /// The state at a time, before an event that rounding puts before or behind it; with it the period.
    fn state_before(&self, time: f64, period: f64) -> Option<Vec<f64>> {
        let Self::Events(motion) = self else { return self.states_at(time) };
        let is_here = |end: &f64| (end - time).abs() <= AT_END * period;
        self.states_at(motion.piece_ends().find(is_here).unwrap_or(time))
    }

    /// The instants within a time at which states jump, or friction begins or ends to hold something, with the
    /// states on both sides.
    pub(super) fn breaks(&self, duration: f64) -> Vec<(f64, [Vec<f64>; 2])> {
        let Self::Events(motion) = self else { return vec![] };
        let times = motion.piece_ends().filter(|time| *time > 0.0 && *time < duration);
        times
            .filter_map(|time| Some((time, [motion.states_at(time)?, motion.states_after(time)?])))
            .collect()
    }

    /// Appends the states at times in increasing order to the columns, one for each state.
    pub(super) fn sample(&self, times: &[f64], columns: &mut [Vec<f64>]) {
        match self {
            Self::Series(path) => path.sample(times, &mut vec![], columns),
            Self::Events(motion) => {
                for states in times.iter().filter_map(|time| motion.states_at(*time)) {
                    for (column, state) in columns.iter_mut().zip(states) {
                        column.push(state);
                    }
                }
            }
        }
    }
}

/// The equations with walls and events, whose motion is followed by Taylor series.
#[derive(Clone, Debug)]
pub(super) struct TimedEquations {
    /// The states, of which the coordinates are the first, and their number.
    pub(super) states: Vec<Symbol>,
    pub(super) coordinates: usize,
    /// The rates of the states.
    pub(super) right: Vec<Expr>,
    pub(super) mass: Vec<Vec<Expr>>,
    pub(super) walls: Vec<Wall>,
    pub(super) events: Vec<StateEvent>,
}

impl TimedEquations {
    /// The equations in the time from here on; `None` for a time that is no number.
    fn later(self, begin: f64) -> Option<Self> {
        if begin == 0.0 {
            return Some(self);
        }
        let time = Symbol::new("t");
        let later = Expr::from(time) + Expr::number(from_f64(begin)?);
        let later: BTreeMap<Symbol, Expr> = [(time, later)].into();
        let moved = |expression: &Expr| -> Option<Expr> {
            match expression.contains(time) {
                true => expression.substitute_all(&later).ok(),
                false => Some(expression.clone()),
            }
        };
        let all = |row: &Vec<Expr>| -> Option<Vec<Expr>> { row.iter().map(moved).collect() };
        let wall = |wall: &Wall| {
            Some(Wall { gap: moved(&wall.gap)?, restitution: moved(&wall.restitution)? })
        };
        let event = |event: &StateEvent| event.substitute_all(&later).ok();
        Some(Self {
            right: all(&self.right)?,
            mass: self.mass.iter().map(all).collect::<Option<_>>()?,
            walls: self.walls.iter().map(wall).collect::<Option<_>>()?,
            events: self.events.iter().map(event).collect::<Option<_>>()?,
            ..self
        })
    }

    /// The motion from a state at a time over a duration, with values of all parameters; `None` if it cannot
    /// be followed all the way. No interrupt ends it: it shows and judges an orbit that was found before, whose
    /// values would be wrong without it, and takes no longer than a period.
    pub(super) fn motion(
        self,
        start: Vec<f64>,
        [begin, duration]: [f64; 2],
        values: BTreeMap<Symbol, f64>,
    ) -> Option<Trajectory> {
        let timed = self.later(begin)?;
        let coordinates = timed.states[..timed.coordinates].to_vec();
        let rates = Rates { states: timed.states, right: timed.right };
        let request = TrajectoryRequest {
            values,
            start,
            duration,
            step_limit: STEP_LIMIT,
            mass: Some(timed.mass),
            ..TrajectoryRequest::of_rates(coordinates, rates)
                .with_walls(timed.walls)
                .with_events(timed.events)
        };
        let motion = request.follow_by(Integrator::Taylor).ok()?;
        motion.is_complete().then_some(motion)
    }
}

/// The harmonics of a wave in the phase of the drive, from those in the phase from a section on.
fn from_section(harmonics: Vec<[f64; 2]>, section: f64) -> Vec<[f64; 2]> {
    let moved = |(index, [cosine, sine]): (usize, [f64; 2])| {
        let (s, c) = (index as f64 * section).sin_cos();
        [cosine * c - sine * s, cosine * s + sine * c]
    };
    harmonics.into_iter().enumerate().map(moved).collect()
}

impl CoupledProblem<'_> {
    /// The motion from a state at a time over a duration, by the Taylor series of the equations as they were
    /// given, with what dry friction holds; `None` if it cannot be followed all the way.
    pub(super) fn by_series(
        &self,
        start: &[f64],
        [begin, duration]: [f64; 2],
        parameter: f64,
    ) -> Option<OrbitPath> {
        let numbers = [(self.question.parameter, parameter)].into();
        if self.in_time.jumps() {
            let states = self.states.clone();
            let timed = TimedEquations {
                right: self.right.clone(),
                states,
                coordinates: self.coordinates,
                mass: self.mass.clone(),
                walls: self.walls.clone(),
                events: self.events.clone(),
            };
            let start = self.in_time.onto_walls(start, [begin, duration], parameter);
            let motion = timed.motion(start, [begin, duration], numbers)?;
            return Some(OrbitPath::Events(Box::new(motion)));
        }
        let path = match self.series.with_numbers(&numbers) {
            Some(solver) => solver.solve([0.0, duration], start).ok()?,
            None => {
                let system = crate::system::System::new(
                    &self.states,
                    Symbol::new("t"),
                    &self.right,
                    &numbers,
                );
                let options = crate::system::SystemOptions::default();
                system.ok()?.solve([0.0, duration], start, &[], &options).ok()?
            }
        };
        (path.reason() == PathEnd::Reached).then(|| OrbitPath::Series(Box::new(path)))
    }

    /// The time at which an orbit begins.
    pub(super) fn time_of_section(&self, orbit: &Orbit) -> f64 {
        match orbit.kept.section {
            0.0 => 0.0,
            section => section / self.frequency_of(orbit),
        }
    }

    /// The highest harmonic that is kept.
    pub(super) fn harmonics(&self) -> usize {
        self.question.harmonics.unwrap_or(HARMONICS).min(MOST_HARMONICS)
    }

    /// The states of a motion at these times by the integrator that found it, for one that has no
    /// series; the last state that was reached stands for those after it. No interrupt ends it.
    fn sampled(
        &self,
        start: &[f64],
        (begin, times): (f64, &[f64]),
        parameter: f64,
        scale: &[f64],
    ) -> Vec<Vec<f64>> {
        let travel: Vec<f64> = start.iter().map(|value| value.abs()).collect();
        let sizes = self.state_sizes(&travel, scale);
        let mut columns = vec![Vec::with_capacity(times.len()); start.len()];
        let mut state = start.to_vec();
        let mut before = 0.0;
        let flow = self.in_time.clone().until(Interrupt::default());
        for time in times {
            if *time > before
                && let Some(next) =
                    flow.end(&state, [begin + before, begin + *time], parameter, &sizes)
            {
                state = next;
            }
            before = *time;
            for (column, value) in columns.iter_mut().zip(&state) {
                column.push(*value);
            }
        }
        columns
    }

    /// The distance of the closed orbit from this one by a path over its period, relative to the
    /// travel; the difference of the period, relative to it, if that is larger.
    fn error(&self, orbit: &Orbit, path: &OrbitPath, period: f64, scale: &[f64]) -> Option<f64> {
        let (n, m) = (self.states.len(), self.coordinates);
        let start = &orbit.unknowns.as_slice()[..n];
        let sizes = self.state_sizes(&orbit.kept.travel, scale);
        let end = path.closing(period, start, &sizes)?;
        let mut missed = DVector::from_iterator(n, (0..n).map(|i| (end[i] - start[i]) / sizes[i]));
        let full = orbit.kept.monodromy.clone();
        let mut matrix =
            DMatrix::from_fn(n, n, |i, j| f64::from(i == j) - full[(i, j)] * sizes[j] / sizes[i]);
        let step = match self.kind {
            // Where dry friction holds a place it is that of the orbit, whatever it is.
            Kind::Driven(_) if !orbit.kept.encounters.places.is_empty() => {
                least_squares(matrix, &missed)?
            }
            Kind::Driven(_) => matrix.lu().solve(&missed)?,
            Kind::SelfExcited | Kind::Free => {
                // The period is free as well, and so is the place on the orbit; the frequency of a
                // free motion is given, and its energy is free.
                let rates = self.in_time.rates_at(start, 0.0, orbit.parameter());
                let column = (0..n).map(|i| -period * rates[i] / sizes[i]);
                let column = DVector::from_iterator(n, column);
                if matches!(self.kind, Kind::SelfExcited) {
                    matrix = matrix.insert_column(n, 0.0);
                    matrix.set_column(n, &column);
                }
                least_squares(matrix, &std::mem::replace(&mut missed, DVector::zeros(0)))?
            }
        };
        /// Motions smaller than this part of the largest are compared as if they were as large.
        const SMALL: f64 = 1e-3;
        let extent = |travel: &[f64]| travel.iter().take(m).copied().fold(0.0, f64::max);
        let least =
            (super::problem::SMALLEST * extent(&orbit.kept.travel)).max(SMALL * extent(scale));
        let of_place = (0..m).map(|i| {
            let size = orbit.kept.travel[i].max(least);
            if size > 0.0 { (step[i] * sizes[i] / size).abs() } else { 0.0 }
        });
        let of_period = step.get(n).copied().unwrap_or(0.0).abs();
        Some(of_place.fold(of_period, f64::max)).filter(|error| error.is_finite())
    }

    /// An orbit as a steady motion.
    pub(super) fn motion(
        &self,
        orbit: &Orbit,
        transform: &Transform,
        scale: &[f64],
    ) -> SteadyMotion {
        let (n, m, parameter) = (self.states.len(), self.coordinates, orbit.parameter());
        let frequency = self.frequency_of(orbit);
        let period = TAU / frequency;
        let (begin, section) = (self.time_of_section(orbit), orbit.kept.section);
        let own_start = &orbit.unknowns.as_slice()[..n];
        let path = self.by_series(own_start, [begin, period], parameter);
        // The state at time zero, before an event that takes place there.
        let at_zero = match (section, &path) {
            (0.0, _) => None,
            (_, Some(path)) => path.state_before(period - begin, period),
            (_, None) => self.state_at_phase(orbit, 0.0, scale),
        };
        let start = at_zero.as_deref().unwrap_or(own_start);
        let rates = self.in_time.rates_at(start, 0.0, parameter);
        let multipliers = self.multipliers(orbit);
        let sampled = path.as_ref().and_then(|path| PeriodSamples::of_path(path, period));
        let samples = sampled.unwrap_or_else(|| {
            let times = PeriodSamples::equal_times(period);
            PeriodSamples::equal(period, self.sampled(own_start, (begin, &times), parameter, scale))
        });
        let wave = |quantity: &dyn Fn(&[f64]) -> f64| {
            let quantity = |states: &[f64]| quantity(&states[..m]);
            let wave = samples.wave(path.as_ref(), self.harmonics(), transform, quantity);
            Wave { harmonics: from_section(wave.harmonics, section), ..wave }
        };
        let polar = |wave: &Wave| {
            let [cosine, sine] = wave.harmonics.get(1).copied().unwrap_or_default();
            (cosine.hypot(sine), sine.atan2(cosine))
        };
        let coordinates: Vec<CoordinateMotion> = (0..m)
            .map(|index| {
                let wave = wave(&|states: &[f64]| states[index]);
                let (amplitude, phase) = polar(&wave);
                CoordinateMotion {
                    coordinate: self.states[index],
                    start: start[index],
                    rate: rates[index],
                    amplitude,
                    phase,
                    peak: wave.peak,
                    harmonics: wave.harmonics,
                }
            })
            .collect();
        let shown = wave(&|states: &[f64]| self.shown.call(states));
        let (amplitude, phase) = polar(&shown);
        let stable = multipliers.as_ref().map(|all| self.is_stable(all));
        let two = multipliers.map(|all| {
            let get = |index: usize| all.get(index).copied();
            // A cycle of one state has no other: after an event nothing but the phase is left of a disturbance.
            let none = if matches!(self.kind, Kind::SelfExcited) { 0.0 } else { 1.0 };
            [get(0).unwrap_or(none.into()), get(1).unwrap_or(1.0.into())]
        });
        // The place and the rate of the quantity that is listed, at the beginning.
        let place = self.shown.call(&start[..m]);
        let step = 1e-6;
        let moved: Vec<f64> = (0..m).map(|i| start[i] + step * rates[i]).collect();
        SteadyMotion {
            parameter,
            harmonics: shown.harmonics,
            frequency,
            amplitude,
            phase,
            peak: shown.peak,
            start: [place, (self.shown.call(&moved) - place) / step],
            stable,
            multipliers: two,
            stuck: orbit.kept.encounters.stuck,
            impacts: orbit.kept.encounters.impacts,
            events: orbit.kept.encounters.events,
            error: path.as_ref().and_then(|path| self.error(orbit, path, period, scale)),
            coordinates,
            energy: self.energy.as_ref().map(|(energy, rest)| energy.over(rest, start)),
            counted: self.counters.as_ref().map_or(vec![], |counters| {
                counters.after_period((&self.states, own_start), [begin, period], parameter)
            }),
        }
    }

    /// The diagram of the branches that are known, each point judged.
    pub(super) fn diagram(
        &self,
        known: &Known,
        simulated: Vec<Simulated>,
        elsewhere: Vec<Elsewhere>,
    ) -> ResponseDiagram {
        let question = self.question;
        let transform = Transform::new(SAMPLES);
        let count: usize = known.branches.iter().map(|branch| branch.distinct().count()).sum();
        question.progress.begin(count);
        let exhausted = self.is_exhausted();
        let mut branches = Vec::new();
        let mut bifurcations: Vec<Bifurcation> = Vec::new();
        let size = known.scale.get(..self.coordinates).unwrap_or_default();
        let size = size.iter().copied().fold(0.0, f64::max);
        for (index, branch) in known.branches.iter().enumerate() {
            let mut points = Vec::new();
            for orbit in branch.distinct() {
                points.push(self.motion(orbit, &transform, &known.scale));
                question.progress.advance();
            }
            // Where the search did not come to its end, each of very many bifurcations takes long.
            let changes = match exhausted {
                true => vec![],
                false => self.changes_along(branch, &known.scale),
            };
            for (kind, orbit, criticality) in changes {
                let motion = self.motion(&orbit, &transform, &known.scale);
                let bifurcation = Bifurcation {
                    kind,
                    branch: index,
                    parameter: motion.parameter,
                    frequency: motion.frequency,
                    amplitude: motion.amplitude,
                    peak: motion.peak,
                    criticality,
                };
                let is_listed = bifurcations
                    .iter()
                    .any(|other| bifurcation.is_near(other, question.range, size));
                if !is_listed {
                    bifurcations.push(bifurcation);
                }
            }
            branches.push(Branch { points, ends: branch.ends, mirrored: branch.mirrored });
        }
        let self_excited = !matches!(self.kind, Kind::Driven(_));
        ResponseDiagram {
            question: question.clone(),
            frequency: match &self.kind {
                Kind::Driven(drive) => drive.frequency.clone(),
                Kind::Free => Expr::from(question.parameter),
                Kind::SelfExcited => Expr::from(crate::symbol::fresh("omega", &self.states)),
            },
            self_excited,
            undamped: self.undamped,
            jumps: self.in_time.jumps(),
            by_map: true,
            harmonics: self.harmonics(),
            branches,
            bifurcations,
            ripple: None,
            backbone: vec![],
            simulated,
            elsewhere,
            error: None,
            unjudged: 0,
            verdict: Verdict::Fail,
            slow: None,
            equilibria: vec![],
            curves: vec![],
            stable_motions: None,
            counters: vec![],
            modes: self.modes.as_ref().map_or(vec![], |modes| modes.values_of_states(&self.states)),
            sparse: vec![],
            exhausted,
            complete: !question.interrupt.is_requested(),
        }
        .with_verdict()
    }

    /// The bifurcations of a branch.
    fn changes_along(
        &self,
        branch: &OrbitBranch,
        scale: &[f64],
    ) -> Vec<(BifurcationKind, Orbit, Option<Criticality>)> {
        let mut found = Vec::new();
        for run in branch.runs() {
            self.with_orbits(scale, branch.anchor.of_orbit(&run[0]), |orbits| {
                for pair in run.windows(2) {
                    let [from, to] = pair else { continue };
                    for (kind, at) in changes_between(self, orbits, from, to) {
                        let criticality = self.criticality(kind, &at, [from, to], orbits, scale);
                        found.push((kind, at, criticality));
                    }
                }
            });
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicBool, Ordering};

    use super::super::branches::Start;
    use super::super::problem::Anchor;
    use super::*;
    use crate::coupled::CoupledEquations;
    use crate::response::ResponseRequest;
    use crate::response::continuation::BranchEnd;

    /// An orbit that was found before the work is stopped is shown and judged as without the stop.
    #[test]
    fn an_interrupt_changes_nothing_of_what_was_found() {
        static STOP: AtomicBool = AtomicBool::new(false);
        let equation = "x'' + x'/10 + x + H(x - 1)*(50*(x - 1) + x') = F*cos(w*t)";
        let question = ResponseRequest::new(equation, "w", [0.5, 1.5], "F = 1/2");
        let question = ResponseRequest {
            interrupt: Interrupt::from_flag(&STOP),
            ..question.expect("a question")
        };
        let equations = CoupledEquations::new(question.equations.sides()).expect("equations");
        let problem = CoupledProblem::new(&question, &equations).expect("a problem");
        let start = Start { parameter: 0.8, unknowns: vec![1.0, 0.0], section: 0.0 };
        let orbit = problem.driven_orbit_near(&start, &[]).expect("an orbit");
        let scale = orbit.kept.travel.clone();
        let branch = OrbitBranch {
            orbits: vec![orbit],
            ends: [BranchEnd::Range; 2],
            mirrored: false,
            anchor: Anchor::NONE,
        };
        let known = Known { branches: vec![branch], scale };
        let shown = || {
            let found = problem.diagram(&known, vec![], vec![]);
            let point = &found.branches[0].points[0];
            let numbers = [point.amplitude, point.phase, point.peak];
            (found.complete, numbers, point.error, found.verdict)
        };
        let whole = shown();
        STOP.store(true, Ordering::Relaxed);
        let stopped = shown();
        assert!(whole.0 && !stopped.0);
        assert!(whole.1[0] > 0.5 && whole.2.is_some_and(|error| error < 1e-6), "{whole:?}");
        assert_eq!((whole.1, whole.2, whole.3), (stopped.1, stopped.2, stopped.3));
    }
}
