//! A motion from event to event: impacts on walls, with rest on them in between, and resets.
//!
//! ```text
//! flight:    q'' = f(q, q', t) until a gap falls through zero, then the impact
//!            or the guard of an event passes through zero, then its reset
//! rest:      the equations of [`resting`](super::resting) until the force of a wall falls through zero
//! ```
//!
//! Flights of several motions can be integrated side by side: [`EventRun::next_flight`] says what is to
//! be integrated, [`EventRun::advance`] takes its path. A motion without walls and events is one flight. Walls
//! come first where both are met at one time.

use std::collections::BTreeMap;

use super::events::{BeforeEvents, CompiledEvents, EventRecord, GuardState};
use super::hold::{IDLE, Stretch};
use super::walls::{WallEvent, WallRecord};
use super::{Ready, Sampled, TrajectoryError, TrajectoryRequest, TrajectorySegment};
use crate::system::{Integrator, Path, PathEnd, Solver};

/// A motion that is followed from event to event.
pub(super) struct EventRun<'a> {
    course: &'a TrajectoryRequest,
    /// The equations of flight, with the walls.
    flight: &'a Ready,
    integrator: Integrator,
    /// The equations of rest on walls, by their indices.
    rest: BTreeMap<Vec<usize>, Ready>,
    from: f64,
    state: Vec<f64>,
    resting: Vec<usize>,
    /// The largest gap of each wall so far.
    largest: Vec<f64>,
    /// Number of stretches of length zero in a row.
    idle: usize,
    steps: usize,
    /// The reason why it has ended; `None` while it goes on.
    reason: Option<PathEnd>,
    pieces: Vec<TrajectorySegment>,
    record: WallRecord,
    guards: Vec<GuardState>,
    events: EventRecord,
    /// States in some places of the last stretches, and memory for those in one of them.
    samples: Sampled,
    sampled: Vec<f64>,
    /// Memory for the gap of each wall.
    gaps: Vec<f64>,
}

/// The pieces of a motion that has ended, the reason, and the impacts and events on its way.
pub(super) struct RunEnd {
    pub(super) pieces: Vec<TrajectorySegment>,
    pub(super) reason: PathEnd,
    pub(super) walls: WallRecord,
    pub(super) events: EventRecord,
}

impl<'a> EventRun<'a> {
    /// Begins a motion at a time, with the state there.
    ///
    /// # Errors
    /// A start behind a wall.
    pub(super) fn new(
        course: &'a TrajectoryRequest,
        flight: &'a Ready,
        (from, state): (f64, Vec<f64>),
        integrator: Integrator,
    ) -> Result<Self, TrajectoryError> {
        let mut run = Self::in_flight(course, flight, (from, state), integrator);
        if let Some(walls) = &flight.walls {
            let (state, record) = (&mut run.state, &mut run.record);
            walls.check_start(from, state)?;
            run.resting = walls.settle(from, state, WallEvent::Start, &[], &[], record);
            run.largest = walls.gaps(from, state);
            // The account begins behind an impact at the start.
            if let Some(work) = walls.work {
                state[work] = 0.0;
            }
        }
        if let Some(events) = &flight.events {
            events.check_start(from, &run.state)?;
            events.note_largest(from, &run.state, &mut run.guards);
            let before = events.before(from, &run.state, None, &mut run.guards);
            run.take_events(events, before)?;
            // The account begins behind an event at the start.
            if let Some(work) = events.work {
                run.state[work] = 0.0;
            }
        }
        Ok(run)
    }

    /// A motion that ends where it begins, for this reason.
    pub(super) fn ended_at_start(
        course: &'a TrajectoryRequest,
        flight: &'a Ready,
        (from, state): (f64, Vec<f64>),
        integrator: Integrator,
        reason: PathEnd,
    ) -> Self {
        let mut run = Self::in_flight(course, flight, (from, state), integrator);
        let path = Path::at_instant(from, run.state.clone(), reason);
        run.pieces.push(TrajectorySegment { from, path, layout: None, recorded: 0 });
        run.end(reason);
        run
    }

    /// A motion in flight, before any impact or event.
    fn in_flight(
        course: &'a TrajectoryRequest,
        flight: &'a Ready,
        (from, mut state): (f64, Vec<f64>),
        integrator: Integrator,
    ) -> Self {
        state.resize(flight.states.len(), 0.0);
        Self {
            course,
            flight,
            integrator,
            rest: BTreeMap::new(),
            from,
            state,
            resting: vec![],
            largest: vec![],
            idle: 0,
            steps: 0,
            reason: None,
            pieces: vec![],
            record: WallRecord::default(),
            guards: flight.events.as_ref().map_or(vec![], CompiledEvents::guards),
            events: EventRecord::default(),
            samples: Sampled::default(),
            sampled: vec![],
            gaps: vec![],
        }
    }

    /// Carries out the events at this instant and the impacts that they cause, and sets what is watched from
    /// here on.
    ///
    /// # Errors
    /// A reset without a value, or to a place behind a wall.
    fn take_events(
        &mut self,
        events: &CompiledEvents,
        before: BeforeEvents,
    ) -> Result<(), TrajectoryError> {
        let (from, largest, record) = (self.from, &self.largest, &mut self.record);
        let resting = &mut self.resting;
        let impacts = |state: &mut [f64]| {
            let Some(walls) = &self.flight.walls else { return Ok(()) };
            if let Some((gap, value)) = walls.behind(from, state) {
                return Err(TrajectoryError::EventBehindWall { gap, value, time: from });
            }
            *resting = walls.settle(from, state, WallEvent::Start, resting, largest, record);
            Ok(())
        };
        let state = &mut self.state;
        let ends = events.settle(from, state, before, &self.guards, &mut self.events, impacts)?;
        events.watch(from, state, &mut self.guards);
        if !ends {
            self.reason = Some(PathEnd::EventsAccumulate);
        }
        Ok(())
    }

    /// Ends the motion where it is.
    pub(super) fn end(&mut self, reason: PathEnd) {
        self.reason = Some(reason);
    }

    /// Whether it has ended.
    pub(super) fn has_ended(&self) -> bool {
        self.reason.is_some()
    }

    /// The next integration: from where it is to the end, or to the next impact or release.
    ///
    /// # Errors
    /// Equations of rest that cannot be formed.
    pub(super) fn next_flight(&mut self) -> Result<(&Solver, [f64; 2], &[f64]), TrajectoryError> {
        self.prepare()?;
        let solver = &self.equations().solver;
        Ok((solver, [self.from, self.course.duration], &self.state))
    }

    /// Prepares the equations of the walls on which it rests.
    fn prepare(&mut self) -> Result<(), TrajectoryError> {
        if !self.resting.is_empty() && !self.rest.contains_key(&self.resting) {
            let ready = self.course.ready_on(&self.resting, self.integrator)?;
            self.rest.insert(self.resting.clone(), ready);
        }
        Ok(())
    }

    /// The equations of flight, or of rest on walls.
    fn equations(&self) -> &Ready {
        self.rest.get(&self.resting).unwrap_or(self.flight)
    }

    /// Goes on to the next impact or release, or to the end; the path of the next integration is given
    /// if it has been followed.
    ///
    /// # Errors
    /// [`TrajectoryError`].
    pub(super) fn advance(&mut self, path: Option<Path>) -> Result<(), TrajectoryError> {
        self.prepare()?;
        let state = std::mem::take(&mut self.state);
        let Stretch { pieces: stretch, reason, last } =
            self.course.pieces(self.equations(), path, self.from, state, self.integrator)?;
        self.steps += stretch.iter().map(|piece| piece.path.step_count()).sum::<usize>();
        let end = stretch.last().map_or(self.from, TrajectorySegment::end);
        let recorded = stretch.last().map_or(0, |piece| piece.recorded);
        let flight = self.flight;
        self.take_samples(&stretch);
        let passed = self.has_passed_wall(end, last.as_deref());
        let missed = match (&flight.events, &last) {
            (Some(events), Some(last)) => {
                events.note_largest(end, last, &mut self.guards);
                !matches!(reason, PathEnd::Event(_)) && events.missed(end, last, &self.guards)
            }
            _ => false,
        };
        self.pieces.extend(stretch);
        if passed || missed {
            let passed_wall = if passed { PathEnd::PassesWall } else { PathEnd::EventsAccumulate };
            self.reason = Some(passed_wall);
            return Ok(());
        }
        let (Some(last), PathEnd::Event(event)) = (last, reason) else {
            self.reason = Some(reason);
            return Ok(());
        };
        let guard = event - recorded;
        let reached = guard.checked_sub(self.course.walls.len());
        self.idle = if end > self.from { 0 } else { self.idle + 1 };
        if self.idle > IDLE || self.steps >= self.course.step_limit {
            self.reason = Some(match (self.idle > IDLE, reached) {
                (false, _) => PathEnd::StepLimit,
                (true, None) => PathEnd::Sticks,
                (true, Some(_)) => PathEnd::EventsAccumulate,
            });
            return Ok(());
        }
        (self.from, self.state) = (end, last);
        let guards = &mut self.guards;
        let before =
            flight.events.as_ref().map(|events| events.before(end, &self.state, reached, guards));
        if let (Some(walls), None) = (&flight.walls, reached) {
            let event = match self.resting.contains(&guard) {
                true => WallEvent::Released(guard),
                false => WallEvent::Hit(guard),
            };
            let (largest, record) = (&self.largest, &mut self.record);
            self.resting =
                walls.settle(end, &mut self.state, event, &self.resting, largest, record);
        }
        match (&flight.events, before) {
            (Some(events), Some(before)) => self.take_events(events, before),
            _ => Ok(()),
        }
    }

    /// Takes the states in some places of these stretches, those at their ends not among them, and raises the
    /// largest gaps of the walls and sizes of the guards to those there.
    fn take_samples(&mut self, stretch: &[TrajectorySegment]) {
        const PLACES: [f64; 3] = [0.25, 0.5, 0.75];
        let Ready { walls, events, states, .. } = self.flight;
        self.samples.clear();
        if walls.is_none() && events.is_none() {
            return;
        }
        self.samples.columns.resize(states.len(), vec![]);
        for piece in stretch {
            let times = PLACES.map(|share| piece.from + share * (piece.end() - piece.from));
            piece.sample(&times, &mut self.samples);
        }
        for index in 0..self.samples.times.len() {
            let time = self.samples.times[index];
            self.samples.read_row(index, &mut self.sampled);
            if let Some(walls) = walls {
                walls.note_largest(time, &self.sampled, &mut self.largest, &mut self.gaps);
            }
            if let Some(events) = events {
                events.note_largest(time, &self.sampled, &mut self.guards);
            }
        }
    }

    /// Whether the motion is behind a wall in one of the places of its samples, or at the end.
    fn has_passed_wall(&mut self, end: f64, last: Option<&[f64]>) -> bool {
        let Some(walls) = &self.flight.walls else { return false };
        let (largest, gaps) = (&self.largest, &mut self.gaps);
        if last.is_some_and(|last| walls.passed(end, last, largest, gaps)) {
            return true;
        }
        (0..self.samples.times.len()).any(|index| {
            self.samples.read_row(index, &mut self.sampled);
            walls.passed(self.samples.times[index], &self.sampled, largest, gaps)
        })
    }

    /// Goes on to the end.
    ///
    /// # Errors
    /// [`TrajectoryError`].
    pub(super) fn complete(&mut self) -> Result<(), TrajectoryError> {
        while !self.has_ended() {
            self.advance(None)?;
        }
        Ok(())
    }

    /// The pieces, the reason why it ended, and the impacts and events.
    pub(super) fn finish(self) -> RunEnd {
        let Self { pieces, mut record, .. } = self;
        let end = pieces.last().map_or(0.0, TrajectorySegment::end);
        for rest in record.rests.iter_mut().filter(|rest| rest.until.is_infinite()) {
            rest.until = end.max(rest.from);
        }
        let reason = self.reason.unwrap_or(PathEnd::Interrupted);
        RunEnd { pieces, reason, walls: record, events: self.events }
    }
}
