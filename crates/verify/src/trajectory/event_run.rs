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
use super::hold::{IDLE, StretchEnd};
use super::walls::{WallEvent, WallMemory, WallRecord};
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
    keeping: PieceKeeping,
    record: WallRecord,
    guards: Vec<GuardState>,
    events: EventRecord,
    /// States in some places of the last stretches, and memory for those in one of them.
    samples: Sampled,
    sampled: Vec<f64>,
    /// Whether the motion is in front of all walls in these places.
    is_in_front: bool,
    /// Memory for the values at walls.
    memory: WallMemory,
}

/// The pieces of a motion that are kept while it is followed.
#[derive(Clone, Debug)]
pub(super) enum PieceKeeping {
    /// All of them.
    All,
    /// Those that end where the motion is; of the earlier ones the least and the greatest value of each
    /// coordinate from the time `after` of the course on.
    LastAndRanges(Vec<[f64; 2]>),
    /// Those that end where the motion is.
    Last,
}

impl PieceKeeping {
    /// The last pieces, and the ranges of this many coordinates on the earlier ones.
    pub(super) fn ranges(coordinates: usize) -> Self {
        Self::LastAndRanges(vec![[f64::INFINITY, f64::NEG_INFINITY]; coordinates])
    }
}

/// The pieces of a motion that has ended, the reason, and the impacts and events on its way.
pub(super) struct RunEnd {
    pub(super) pieces: Vec<TrajectorySegment>,
    /// The ranges of the coordinates on pieces that are not kept; none if all are.
    pub(super) earlier: Vec<[f64; 2]>,
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
            let (state, record, memory) = (&mut run.state, &mut run.record, &mut run.memory);
            walls.check_start(from, state)?;
            run.resting = walls.settle(from, state, WallEvent::Start, &[], &[], (record, memory));
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
        let path = Path::at_instant(from, &run.state, reason);
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
            keeping: PieceKeeping::All,
            record: WallRecord::default(),
            guards: flight.events.as_ref().map_or(vec![], CompiledEvents::guards),
            events: EventRecord::default(),
            samples: Sampled::default(),
            sampled: vec![],
            is_in_front: true,
            memory: WallMemory::default(),
        }
    }

    /// Keeps only some of the pieces from here on.
    pub(super) fn keep(&mut self, keeping: PieceKeeping) {
        self.keeping = keeping;
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
        let (from, largest, resting) = (self.from, &self.largest, &mut self.resting);
        let (record, memory) = (&mut self.record, &mut self.memory);
        let impacts = |state: &mut [f64]| {
            let Some(walls) = &self.flight.walls else { return Ok(()) };
            if let Some((gap, value)) = walls.behind(from, state) {
                return Err(TrajectoryError::EventBehindWall { gap, value, time: from });
            }
            let (event, records) = (WallEvent::Start, (&mut *record, &mut *memory));
            *resting = walls.settle(from, state, event, resting, largest, records);
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
        let first = self.pieces.len();
        // The state at its start becomes that at its end.
        let (flight, course) = (self.flight, self.course);
        let equations = self.rest.get(&self.resting).unwrap_or(flight);
        let start = (self.from, &mut self.state);
        let StretchEnd { reason, has_states } =
            course.follow_stretch(equations, path, start, self.integrator, &mut self.pieces)?;
        let stretch = &self.pieces[first..];
        self.steps += stretch.iter().map(|piece| piece.path.step_count()).sum::<usize>();
        let end = stretch.last().map_or(self.from, TrajectorySegment::end);
        let recorded = stretch.last().map_or(0, |piece| piece.recorded);
        self.take_samples(first);
        let passed = self.has_passed_wall(end, has_states);
        let missed = match &flight.events {
            Some(events) if has_states => {
                events.note_largest(end, &self.state, &mut self.guards);
                !matches!(reason, PathEnd::Event(_))
                    && events.missed(end, &self.state, &self.guards)
            }
            _ => false,
        };
        if passed {
            // The stretch behind the wall is no part of the motion.
            self.take_back(first);
        }
        self.leave_earlier_pieces(end);
        if passed || missed {
            let passed_wall = if passed { PathEnd::PassesWall } else { PathEnd::EventsAccumulate };
            self.reason = Some(passed_wall);
            return Ok(());
        }
        let (true, PathEnd::Event(event)) = (has_states, reason) else {
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
        self.from = end;
        let guards = &mut self.guards;
        let before =
            flight.events.as_ref().map(|events| events.before(end, &self.state, reached, guards));
        if let (Some(walls), None) = (&flight.walls, reached) {
            let event = match self.resting.contains(&guard) {
                true => WallEvent::Released(guard),
                false => WallEvent::Hit(guard),
            };
            let (largest, records) = (&self.largest, (&mut self.record, &mut self.memory));
            self.resting =
                walls.settle(end, &mut self.state, event, &self.resting, largest, records);
        }
        match (&flight.events, before) {
            (Some(events), Some(before)) => self.take_events(events, before),
            _ => Ok(()),
        }
    }

    /// Leaves out the pieces from this one on; a motion that has no other ends where it begins.
    fn take_back(&mut self, first: usize) {
        let start = self.pieces.get(first).and_then(|piece| piece.states_at(piece.from));
        self.pieces.truncate(first);
        if let (true, Some(start)) = (self.pieces.is_empty(), start) {
            let (from, layout) = (self.from, None);
            let path = Path::at_instant(from, &start, PathEnd::PassesWall);
            self.pieces.push(TrajectorySegment { from, path, layout, recorded: 0 });
        }
    }

    /// Leaves the pieces that end before this time, if not all are kept.
    fn leave_earlier_pieces(&mut self, end: f64) {
        if matches!(self.keeping, PieceKeeping::All) {
            return;
        }
        let earlier = self.pieces.partition_point(|piece| piece.end() < end);
        let (count, after) = (self.course.coordinates.len(), self.course.after);
        for piece in self.pieces.drain(..earlier).filter(|piece| piece.end() >= after) {
            if let PieceKeeping::LastAndRanges(ranges) = &mut self.keeping {
                piece.extend_ranges(ranges, count, after);
            }
        }
    }

    /// Takes the states in some places of the pieces from this one on, those at their ends not among them, and
    /// raises the largest gaps of the walls and sizes of the guards to those there.
    fn take_samples(&mut self, first: usize) {
        const PLACES: [f64; 3] = [0.25, 0.5, 0.75];
        let Ready { walls, events, states, .. } = self.flight;
        self.samples.clear();
        self.is_in_front = true;
        if walls.is_none() && events.is_none() {
            return;
        }
        if self.samples.columns.len() != states.len() {
            self.samples.columns.resize(states.len(), vec![]);
        }
        for piece in &self.pieces[first..] {
            let times = PLACES.map(|share| piece.from + share * (piece.end() - piece.from));
            piece.sample(&times, &mut self.samples);
        }
        for index in 0..self.samples.times.len() {
            let time = self.samples.times[index];
            self.samples.read_row(index, &mut self.sampled);
            if let Some(walls) = walls {
                let (largest, memory) = (&mut self.largest, &mut self.memory);
                self.is_in_front &= walls.note_largest(time, &self.sampled, largest, memory);
            }
            if let Some(events) = events {
                events.note_largest(time, &self.sampled, &mut self.guards);
            }
        }
    }

    /// Whether the motion is behind a wall in one of the places of its samples, or at the end if its state
    /// there is known.
    fn has_passed_wall(&mut self, end: f64, has_states: bool) -> bool {
        let Some(walls) = &self.flight.walls else { return false };
        let (largest, memory) = (&self.largest, &mut self.memory);
        if has_states && walls.passed(end, &self.state, largest, memory) {
            return true;
        }
        !self.is_in_front
            && (0..self.samples.times.len()).any(|index| {
                self.samples.read_row(index, &mut self.sampled);
                walls.passed(self.samples.times[index], &self.sampled, largest, memory)
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
        let earlier = match self.keeping {
            PieceKeeping::LastAndRanges(ranges) => ranges,
            PieceKeeping::All | PieceKeeping::Last => vec![],
        };
        RunEnd { pieces, earlier, reason, walls: record, events: self.events }
    }
}
