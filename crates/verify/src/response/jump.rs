//! The motion across jumps of the force, such as dry friction or a step in place, and its
//! variation.
//!
//! ```text
//! h = n_x x + n_v x' - c,   f = f+ where h > 0, f- where h < 0,   a = -f
//! crossing: h' = n_x x' + n_v a has one sign on both sides       sticking: h' leads back to h = 0 from both, until it does no more
//! dx, dx' behind = S (dx, dx'),   S = 1 + (y'_behind - y'_before) n^T/(n^T y'_before)
//! velocity alone:  S = [1 0; 0 a_behind/a_before] where it crosses,  [1 0; 0 0] where sticking begins,  1 where it ends
//! ```
//!
//! S is the saltation matrix (R. I. Leine and H. Nijmeijer, *Dynamics and Bifurcations of
//! Non-Smooth Mechanical Systems*, Springer 2004, chapter 7; M. di Bernardo, C. J. Budd, A. R.
//! Champneys and P. Kowalczyk, *Piecewise-smooth Dynamical Systems*, Springer 2008, chapter 2). In:
//! a start. Out: the motion leg by leg, each between the jumps or sticking on one, the ends of the
//! legs located as events, and M(t). Without jumps the motion is followed in one piece by its Taylor
//! series, where it has one.

use super::driven::{Driven, TimedStart};
use crate::numeric::ode::{
    Action, Event, IntegrationOptions, Point, StopReason, Trajectory, integrate_first_order,
};
use crate::system::Path;

/// Position, velocity and the two columns of M at a time.
type VariationalState = [f64; 6];

/// A motion with its variations.
#[derive(Clone, Debug)]
pub struct VariationalMotion {
    course: Course,
    /// Duration of all sticking phases, in the unit of time.
    stuck: f64,
    /// Whether it has ended where it turns back.
    turned: bool,
    /// Position, velocity and the two columns of M where it ends.
    pub end: [f64; 6],
}

/// The states of a motion between its start and its end.
#[derive(Clone, Debug)]
enum Course {
    /// One after the other between the jumps.
    Legs(Vec<Trajectory<Point<VariationalState>>>),
    /// In one piece, by Taylor series, where there are no jumps.
    Series(Box<Path>),
}

/// The condition at which the integration stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StopCondition {
    /// After this time.
    Time(f64),
    /// At the zero of the velocity at a largest displacement, or after this time.
    Turn(f64),
}

impl StopCondition {
    fn time(self) -> f64 {
        match self {
            Self::Time(time) | Self::Turn(time) => time,
        }
    }
}

impl VariationalMotion {
    /// The motion from its Taylor series with the variations.
    pub(super) fn from_series(path: Path) -> Option<Self> {
        let end = path.states_at(path.end())?.try_into().ok()?;
        Some(Self { course: Course::Series(Box::new(path)), stuck: 0.0, turned: false, end })
    }

    /// Positions at equal steps of the duration, its end left out.
    pub fn positions(&self, count: usize) -> Vec<f64> {
        let (from, to) = self.span();
        let time = |index: usize| from + index as f64 / count as f64 * (to - from);
        match &self.course {
            Course::Legs(legs) => {
                let mut leg = 0;
                let at = |index: usize| {
                    while leg + 1 < legs.len() && time(index) >= legs[leg].end().t {
                        leg += 1;
                    }
                    legs.get(leg)?.state_at(time(index))
                };
                (0..count).filter_map(at).map(|point| point.y[0]).collect()
            }
            Course::Series(path) => positions_on(path, count),
        }
    }

    fn span(&self) -> (f64, f64) {
        match &self.course {
            Course::Legs(legs) => {
                let from = legs.first().map_or(0.0, |leg| leg.start().t);
                (from, legs.last().map_or(0.0, |leg| leg.end().t))
            }
            Course::Series(path) => (0.0, path.end()),
        }
    }

    /// Duration, in the unit of time.
    pub fn duration(&self) -> f64 {
        let (from, to) = self.span();
        to - from
    }

    /// The part of the duration in which it sticks.
    pub fn stuck(&self) -> f64 {
        match self.duration() {
            duration if duration > 0.0 => self.stuck / duration,
            _ => 0.0,
        }
    }

    /// Whether it has ended where it turns back.
    pub fn turned(&self) -> bool {
        self.turned
    }

    /// The largest distance from the initial position.
    pub fn extent(&self) -> f64 {
        let positions = self.positions(super::stability::SAMPLES);
        let from = positions.first().copied().unwrap_or(0.0);
        positions.iter().fold(0.0, |most, position| most.max((position - from).abs()))
    }

    /// Evaluations of the force.
    pub fn evaluations(&self) -> usize {
        match &self.course {
            Course::Legs(legs) => legs.iter().map(Trajectory::evaluations).sum(),
            Course::Series(path) => evaluations_of(path),
        }
    }
}

/// Positions at equal steps of a path from time zero, its end left out.
pub(super) fn positions_on(path: &Path, count: usize) -> Vec<f64> {
    positions_from(path, 0.0, count)
}

/// Positions at equal steps of a path that begins at this time, its end left out.
pub(super) fn positions_from(path: &Path, begin: f64, count: usize) -> Vec<f64> {
    let part = |index: usize| index as f64 / count as f64;
    let times: Vec<f64> =
        (0..count).map(|index| begin + part(index) * (path.end() - begin)).collect();
    let mut columns = [Vec::with_capacity(count)];
    path.sample(&times, &mut Vec::with_capacity(count), &mut columns);
    let [positions] = columns;
    positions
}

/// The work of a path by series in evaluations of the force: about its order for each step.
pub(super) fn evaluations_of(path: &Path) -> usize {
    const ORDER: usize = 16;
    ORDER * path.step_count()
}

/// The motion from a start at phase zero; `None` if it cannot be followed.
pub fn follow(
    driven: &Driven,
    start: [f64; 2],
    parameter: f64,
    until: StopCondition,
    options: &IntegrationOptions,
) -> Option<VariationalMotion> {
    /// Largest number of legs of a period, beyond which the motion is given up.
    const MOST: usize = 400;
    if let StopCondition::Time(duration) = until {
        let motion = TimedStart { start, begin: 0.0, parameter, duration };
        if let Some(path) = driven.varied_by_series(&[motion]).pop().flatten() {
            return VariationalMotion::from_series(path);
        }
    }
    let mut run = NonsmoothRun::new(driven, start, parameter);
    let mut legs = Vec::new();
    let mut stuck = 0.0;
    for _ in 0..MOST {
        let began = run.t;
        let path = match run.sliding {
            None => run.leg(until, options)?,
            Some(surface) => run.sliding_leg(surface, until, options)?,
        };
        let (reason, last) = (path.stop_reason(), path.end());
        (run.t, run.y) = (last.t, last.y);
        if run.sliding.is_some() {
            stuck += last.t - began;
        }
        legs.push(path);
        let turned = match reason {
            StopReason::Event { event, .. } => run.pass_event(event, until),
            _ => false,
        };
        if turned || run.t >= until.time() {
            let course = Course::Legs(legs);
            return Some(VariationalMotion { course, stuck, turned, end: run.y });
        }
    }
    None
}

/// The state of an integration across jumps.
struct NonsmoothRun<'a> {
    driven: &'a Driven,
    parameter: f64,
    omega: f64,
    t: f64,
    y: VariationalState,
    /// The side of each jump, 1 or -1.
    sides: Vec<f64>,
    /// The jump on which it sticks.
    sliding: Option<usize>,
}

impl<'a> NonsmoothRun<'a> {
    fn new(driven: &'a Driven, start: [f64; 2], parameter: f64) -> Self {
        let y = [start[0], start[1], 1.0, 0.0, 0.0, 1.0];
        let heights = |index: usize| driven.height(index, start, parameter);
        let mut run = Self {
            driven,
            parameter,
            omega: driven.frequency_at(parameter),
            t: 0.0,
            y,
            sides: (0..driven.jumps())
                .map(|index| if heights(index) < 0.0 { -1.0 } else { 1.0 })
                .collect(),
            sliding: None,
        };
        for index in (0..driven.jumps()).filter(|index| heights(*index) == 0.0) {
            match [1.0, -1.0].into_iter().find(|side| side * run.rise(index, *side) > 0.0) {
                Some(side) => run.sides[index] = side,
                // On a step in position at rest it is on neither side.
                None if driven.normal(index)[1] != 0.0 => run.stick(index),
                None => {}
            }
        }
        run
    }

    /// The acceleration where it is, with this side of one jump.
    fn acceleration(&self, index: usize, side: f64) -> f64 {
        let mut sides = self.sides.clone();
        sides[index] = side;
        let at = [self.y[0], self.y[1], self.omega * self.t, self.parameter];
        -self.driven.force_on(&at, &sides)
    }

    /// dh/dt on this side of a jump.
    fn rise(&self, index: usize, side: f64) -> f64 {
        let [by_position, by_velocity] = self.driven.normal(index);
        let acceleration = match by_velocity {
            0.0 => 0.0,
            _ => by_velocity * self.acceleration(index, side),
        };
        by_position * self.y[1] + acceleration
    }

    /// The events at which the motion leaves its side of a jump, except for one jump.
    fn crossings(&self, but: Option<usize>) -> Vec<Event<'a, Point<VariationalState>>> {
        let (driven, parameter) = (self.driven, self.parameter);
        let crossing = |(index, side): (usize, &f64)| {
            let side = if Some(index) == but { 0.0 } else { *side };
            let height = move |point: &Point<VariationalState>| {
                side * driven.height(index, [point.y[0], point.y[1]], parameter)
            };
            Event::new(height, Action::Stop).falling()
        };
        self.sides.iter().enumerate().map(crossing).collect()
    }

    /// The event at which the motion turns back; it comes last in the list but has priority at
    /// equal times.
    fn turn(until: StopCondition) -> Option<Event<'a, Point<VariationalState>>> {
        let falls = |point: &Point<VariationalState>| point.y[1];
        matches!(until, StopCondition::Turn(_)).then(|| Event::new(falls, Action::Stop).falling())
    }

    /// A leg between the jumps.
    fn leg(
        &self,
        until: StopCondition,
        options: &IntegrationOptions,
    ) -> Option<Trajectory<Point<VariationalState>>> {
        let rates = |t: f64, y: &VariationalState, rates: &mut VariationalState| {
            let at = [y[0], y[1], self.omega * t, self.parameter];
            let [by_position, by_velocity, _] = self.driven.slopes_on(&at, &self.sides);
            *rates = [
                y[1],
                -self.driven.force_on(&at, &self.sides),
                y[3],
                -by_position * y[2] - by_velocity * y[3],
                y[5],
                -by_position * y[4] - by_velocity * y[5],
            ];
        };
        let events: Vec<_> = Self::turn(until).into_iter().chain(self.crossings(None)).collect();
        let begin = Point { t: self.t, y: self.y };
        let path = integrate_first_order(rates, begin, until.time(), &events, options).ok()?;
        path.is_complete().then_some(path)
    }

    /// A leg that sticks on a jump, where x' = c - n_x x.
    fn sliding_leg(
        &self,
        surface: usize,
        until: StopCondition,
        options: &IntegrationOptions,
    ) -> Option<Trajectory<Point<VariationalState>>> {
        let [by_position, _] = self.driven.normal(surface);
        let rates = |_: f64, y: &VariationalState, rates: &mut VariationalState| {
            *rates =
                [y[1], -by_position * y[1], y[3], -by_position * y[3], y[5], -by_position * y[5]];
        };
        let leaves = [1.0, -1.0].map(|side| {
            let mut sides = self.sides.clone();
            sides[surface] = side;
            let (driven, omega, parameter) = (self.driven, self.omega, self.parameter);
            let pushed = move |point: &Point<VariationalState>| {
                let [x, v, ..] = point.y;
                side * (by_position * v
                    - driven.force_on(&[x, v, omega * point.t, parameter], &sides))
            };
            Event::new(pushed, Action::Stop).rising()
        });
        let turn = Self::turn(until);
        let events: Vec<_> =
            turn.into_iter().chain(self.crossings(Some(surface))).chain(leaves).collect();
        // Only the drive changes on such a leg, so that the error control sees all of it.
        let options = IntegrationOptions {
            maximum_step: 0.05 * std::f64::consts::TAU / self.omega / self.driven.periods as f64,
            ..*options
        };
        let begin = Point { t: self.t, y: self.y };
        let path = integrate_first_order(rates, begin, until.time(), &events, &options).ok()?;
        path.is_complete().then_some(path)
    }

    /// Continues after an event; returns whether the motion has turned back there.
    fn pass_event(&mut self, event: usize, until: StopCondition) -> bool {
        let index = match (until, event) {
            (StopCondition::Turn(_), 0) => {
                self.y[1] = 0.0;
                return true;
            }
            (StopCondition::Turn(_), _) => event - 1,
            (StopCondition::Time(_), _) => event,
        };
        if let Some(side) = index.checked_sub(self.sides.len()) {
            // The motion is pulled off the jump on which it stuck.
            if let Some(surface) = self.sliding.take() {
                self.sides[surface] = if side == 0 { 1.0 } else { -1.0 };
            }
            return false;
        }
        self.put_on(index);
        let side = self.sides[index];
        let before = self.rate_before(index);
        let behind = self.rise(index, -side);
        self.sides[index] = -side;
        if side * behind < 0.0 {
            let after = self.acceleration(index, -side);
            self.jump(index, before, after);
            self.check_sticking();
        } else if self.driven.normal(index)[1] != 0.0 {
            self.stick(index);
        } else {
            // A step in position that is reached with zero speed is not crossed.
            self.sides[index] = side;
        }
        false
    }

    /// Projects the state onto a jump.
    fn put_on(&mut self, index: usize) {
        let height = self.driven.height(index, [self.y[0], self.y[1]], self.parameter);
        match self.driven.normal(index) {
            [by_position, 0.0] => self.y[0] -= height / by_position,
            [_, by_velocity] => self.y[1] -= height / by_velocity,
        }
    }

    /// The acceleration before the jump.
    fn rate_before(&self, index: usize) -> f64 {
        match self.sliding {
            Some(surface) => -self.driven.normal(surface)[0] * self.y[1],
            None => self.acceleration(index, self.sides[index]),
        }
    }

    /// The saltation matrix of a jump, with the accelerations before and behind.
    fn jump(&mut self, index: usize, before: f64, behind: f64) {
        let [by_position, by_velocity] = self.driven.normal(index);
        let speed = by_position * self.y[1] + by_velocity * before;
        for column in [2, 4] {
            let height = by_position * self.y[column] + by_velocity * self.y[column + 1];
            // A variation that is zero stays zero, also if the speed across the jump vanishes.
            if height != 0.0 {
                self.y[column + 1] += (behind - before) * height / speed;
            }
        }
    }

    /// Begins to stick on a jump: only the component of the variations along the jump remains.
    fn stick(&mut self, index: usize) {
        let [by_position, _] = self.driven.normal(index);
        self.put_on(index);
        for column in [2, 4] {
            self.y[column + 1] = -by_position * self.y[column];
        }
        self.sliding = Some(index);
    }

    /// Ends sticking if the motion no longer sticks after another jump.
    fn check_sticking(&mut self) {
        let Some(surface) = self.sliding else { return };
        if let Some(side) =
            [1.0, -1.0].into_iter().find(|side| side * self.rise(surface, *side) > 0.0)
        {
            self.sides[surface] = side;
            self.sliding = None;
        }
    }
}
