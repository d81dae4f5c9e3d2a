//! A motion from impact to impact, with rest on walls in between.
//!
//! ```text
//! flight:    q'' = f(q, q', t) until a gap falls through zero, then the impact
//! rest:      the equations of [`resting`](super::resting) until the force of a wall falls through zero
//! ```
//!
//! Flights of several motions can be integrated side by side: [`WallRun::next_flight`] says what is to
//! be integrated, [`WallRun::advance`] takes its path. A motion without walls is one flight.

use std::collections::BTreeMap;

use super::hold::IDLE;
use super::walls::{WallEvent, WallRecord};
use super::{Ready, TrajectoryError, TrajectoryRequest, TrajectorySegment};
use crate::system::{Integrator, Path, PathEnd, Solver};

/// A motion that is followed from impact to impact.
pub(super) struct WallRun<'a> {
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
}

impl<'a> WallRun<'a> {
    /// Begins a motion at a time, with the state there.
    ///
    /// # Errors
    /// A start behind a wall.
    pub(super) fn new(
        course: &'a TrajectoryRequest,
        flight: &'a Ready,
        (from, mut state): (f64, Vec<f64>),
        integrator: Integrator,
    ) -> Result<Self, TrajectoryError> {
        let mut record = WallRecord::default();
        let (mut resting, mut largest) = (vec![], vec![]);
        if let Some(walls) = &flight.walls {
            walls.check_start(from, &state)?;
            resting = walls.settle(from, &mut state, WallEvent::Start, &[], &[], &mut record);
            largest = walls.gaps(from, &state);
            // The account begins behind an impact at the start.
            if let Some(work) = walls.work {
                state[work] = 0.0;
            }
        }
        Ok(Self {
            course,
            flight,
            integrator,
            rest: BTreeMap::new(),
            from,
            state,
            resting,
            largest,
            idle: 0,
            steps: 0,
            reason: None,
            pieces: vec![],
            record,
        })
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
        let (stretch, reason) =
            self.course.pieces(self.equations(), path, self.from, state, self.integrator)?;
        self.steps += stretch.iter().map(|piece| piece.path.step_count()).sum::<usize>();
        let end = stretch.last().map_or(self.from, TrajectorySegment::end);
        let last = stretch.last().and_then(|piece| piece.states_at(end));
        let recorded = stretch.last().map_or(0, |piece| piece.recorded);
        let flight = self.flight;
        if let Some(walls) = &flight.walls {
            walls.note_largest(&stretch, &mut self.largest);
        }
        let passed = flight.walls.as_ref().is_some_and(|walls| {
            let middle = 0.5 * (self.from + end);
            let middle = stretch
                .iter()
                .find(|piece| piece.end() >= middle)
                .and_then(|piece| Some((middle, piece.states_at(middle)?)));
            let places = middle.into_iter().chain(last.clone().map(|state| (end, state)));
            places
                .into_iter()
                .any(|(time, state)| walls.passed(time, &state, &self.largest).is_some())
        });
        self.pieces.extend(stretch);
        if passed {
            self.reason = Some(PathEnd::PassesWall);
            return Ok(());
        }
        let (Some(walls), Some(last), PathEnd::Event(event)) = (&flight.walls, last, reason) else {
            self.reason = Some(reason);
            return Ok(());
        };
        self.idle = if end > self.from { 0 } else { self.idle + 1 };
        if self.idle > IDLE || self.steps >= self.course.step_limit {
            let stuck = self.idle > IDLE;
            self.reason = Some(if stuck { PathEnd::Sticks } else { PathEnd::StepLimit });
            return Ok(());
        }
        (self.from, self.state) = (end, last);
        let guard = event - recorded;
        let event = match self.resting.contains(&guard) {
            true => WallEvent::Released(guard),
            false => WallEvent::Hit(guard),
        };
        let largest = &self.largest;
        let record = &mut self.record;
        self.resting =
            walls.settle(self.from, &mut self.state, event, &self.resting, largest, record);
        Ok(())
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

    /// The pieces, the reason why it ended, and the impacts.
    pub(super) fn finish(self) -> (Vec<TrajectorySegment>, PathEnd, WallRecord) {
        let Self { pieces, mut record, .. } = self;
        let end = pieces.last().map_or(0.0, TrajectorySegment::end);
        for rest in record.rests.iter_mut().filter(|rest| rest.until.is_infinite()) {
            rest.until = end.max(rest.from);
        }
        (pieces, self.reason.unwrap_or(PathEnd::Interrupted), record)
    }
}
