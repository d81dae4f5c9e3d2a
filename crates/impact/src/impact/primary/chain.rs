//! The motion of pendulum and main mass without integrating: flight, contact, flight, each in
//! closed form.
//!
//! A flight is a [`ClosedFlight`], a contact a [`ClosedBounce`], and where friction holds the
//! pendulum or a hard barrier carries it, it is a [`RestingPendulum`]. Each begins with the state
//! that the last one left. Where no closed form is good enough the phase is integrated, and counted:
//! swings beyond 1.6 rad, pieces whose energy does not balance, contacts that are deep, soft and
//! pressed, or stopped by friction.

use super::bounce::{ClosedBounce, push, relative_mass};
use super::flight::{ClosedFlight, FlightEnd, FlightForces, FlightStart};
use super::follow::{PrimaryRegime, PrimaryRun};
use super::modes::DampedModes;
use super::path::{PrimarySegment, PrimaryState};
use super::resting::{RestingPendulum, Support};
use super::{PrimaryCase, PrimaryError};
use crate::impact::chain::ChainError;
use crate::impact::model::{Friction, Side};

/// The numbers of a chain that are the same for all of its phases.
#[derive(Clone, Copy, Debug)]
pub(super) struct PrimaryChain {
    modes: DampedModes,
    /// The greatest frequency.
    fastest: f64,
}

impl PrimaryChain {
    /// The chain of a case.
    ///
    /// # Errors
    /// [`ChainError`]: friction by the arctangent, or too much damping.
    pub(super) fn new(case: &PrimaryCase) -> Result<Self, PrimaryError> {
        if case.model.alpha > 0.0 && case.model.friction == Friction::Arctangent {
            return Err(ChainError::Arctangent.into());
        }
        let modes = DampedModes::new(case)?;
        let drive = if case.primary.force == 0.0 { 0.0 } else { case.primary.frequency };
        let fastest = modes.modes.iter().map(|mode| mode.root.im).fold(drive, f64::max);
        Ok(Self { modes, fastest })
    }

    /// The longest piece of a motion with small angles.
    fn longest(&self) -> f64 {
        LONGEST / self.fastest
    }
}

/// The phase, rad, by which the faster mode goes on in a piece of small angles.
const LONGEST: f64 = 2.0;

/// The part of the energy by which the account of a piece may be wrong.
const MOST_ASTRAY: f64 = 2e-5;

/// How often a piece is halved until its energy balances.
const HALVINGS: i32 = 4;

/// The greatest depth at which a pendulum that is pressed into a barrier counts as at rest on its
/// surface, and the greatest speed with which it does.
const SHALLOW: f64 = 2e-4;
const SLOW: f64 = 0.1;

impl PrimaryRun<'_> {
    /// Follows the next phase in closed form; returns whether there is one.
    pub(super) fn follow_in_closed_form(
        &mut self,
        chain: &PrimaryChain,
    ) -> Result<bool, PrimaryError> {
        match self.regime {
            PrimaryRegime::Free(direction) => self.fly_in_closed_form(chain, direction),
            PrimaryRegime::Contact(side, _) => Ok(self.bounce_in_closed_form(chain, side)),
            PrimaryRegime::Held => self.hold_in_closed_form(chain),
            PrimaryRegime::LetGo(..) => Ok(false),
        }
    }

    fn fly_in_closed_form(
        &mut self,
        chain: &PrimaryChain,
        direction: f64,
    ) -> Result<bool, PrimaryError> {
        let primary = self.case.primary;
        let forces = FlightForces {
            friction: -self.case.model.alpha * direction,
            force: primary.force,
            frequency: primary.frequency,
        };
        let barriers = [Side::Left, Side::Right].map(|side| self.case.model.barrier(side));
        let farthest = barriers
            .map(|barrier| barrier.map_or(f64::INFINITY, f64::abs))
            .into_iter()
            .fold(self.state.x.abs(), f64::max);
        let start = FlightStart {
            modes: chain.modes,
            forces,
            begin: self.t,
            state: self.state,
            farthest,
            longest: chain.longest(),
        };
        let mut flight = std::mem::take(&mut self.flight);
        let is_closed = flight.begin(&start) && self.follow_flight(direction, &start, &flight)?;
        self.flight = flight;
        Ok(is_closed)
    }

    /// Follows a flight for a piece or to its first event; returns whether its energy balances, over a
    /// shorter piece if not over a longer one.
    fn follow_flight(
        &mut self,
        direction: f64,
        start: &FlightStart,
        flight: &ClosedFlight,
    ) -> Result<bool, PrimaryError> {
        let barriers = [Side::Left, Side::Right].map(|side| self.case.model.barrier(side));
        let piece = flight.time().min(self.settings.duration - self.t);
        let slip = if self.case.sticks() { direction } else { 0.0 };
        let before = self.case.energy(self.state);
        let balanced = (0..=HALVINGS).find_map(|halvings| {
            let piece = piece * 0.5_f64.powi(halvings);
            let (time, end, point) = flight.first_event(barriers, slip, piece);
            let work = self.work_between(time, |t| flight.point(t).state);
            let [viscous, friction, dashpot, force] = work;
            let after = self.case.energy(point.state);
            let astray = after - before + viscous + friction + dashpot - force;
            (astray.abs() <= MOST_ASTRAY * (before.max(after) + force.abs()))
                .then_some((time, end, point, work))
        });
        let Some((time, end, mut point, work)) = balanced else {
            return Ok(false);
        };
        self.add_work(work);
        if end == FlightEnd::Rest {
            point.state.velocity = 0.0;
        }
        self.record_turns(time, self.state, point.state, |t| flight.point(t).state);
        self.state = point.state;
        self.advance(time, PrimarySegment::ClosedFlight(Box::new(*start)));
        match end {
            FlightEnd::Reached => {}
            FlightEnd::Touch(side) => self.begin_contact(side, direction),
            FlightEnd::Rest => self.turn_back(0.0)?,
        }
        Ok(true)
    }

    /// The energies taken without contact by viscous damping, dry friction and the dashpot, and that
    /// supplied by the force, over these states.
    fn work_between(&self, time: f64, state: impl Fn(f64) -> PrimaryState) -> [f64; 4] {
        let (primary, model) = (&self.case.primary, &self.case.model);
        let drives = primary.force != 0.0;
        let mut work = [0.0; 4];
        for (node, weight) in RULE {
            let t = 0.5 * time * (1.0 + node);
            let PrimaryState { velocity, speed, .. } = state(t);
            let drive = match drives {
                true => primary.force * (primary.frequency * (self.t + t)).sin(),
                false => 0.0,
            };
            let powers = [
                2.0 * model.zeta * velocity * velocity,
                model.alpha * velocity.abs(),
                primary.damping * speed * speed,
                drive * speed,
            ];
            for (work, power) in work.iter_mut().zip(powers) {
                *work += 0.5 * time * weight * power;
            }
        }
        work
    }

    /// Records the turning points of both bodies between two states.
    fn record_turns(
        &mut self,
        time: f64,
        before: PrimaryState,
        after: PrimaryState,
        state: impl Fn(f64) -> PrimaryState,
    ) {
        let turns = |one: f64, other: f64| one * other < 0.0 || other == 0.0 && one != 0.0;
        if turns(before.speed, after.speed) {
            let t = turn(|t| state(t).speed, time, [before.speed, after.speed]);
            self.turns.push((self.t + t, state(t).y));
        }
        if turns(before.velocity, after.velocity) {
            let t = turn(|t| state(t).velocity, time, [before.velocity, after.velocity]);
            self.swings.push((self.t + t, state(t).x));
        }
    }

    fn bounce_in_closed_form(&mut self, chain: &PrimaryChain, side: Side) -> bool {
        let model = &self.case.model;
        let place = self.barrier_position(side);
        let speed = side.sign() * self.state.velocity;
        if model.gamma <= 0.0 || self.state.x != place || speed < 0.0 {
            return false;
        }
        let Some(bounce) = ClosedBounce::new(&self.case, side, self.t, self.state) else {
            return self.press_in_closed_form(chain, side);
        };
        let (t, time) = (self.t, bounce.duration);
        if t + time > self.settings.duration {
            return false;
        }
        let before = self.case.energy(self.state);
        let (primary, model) = (self.case.primary, self.case.model);
        let released = PrimaryState { x: place, ..bounce.point(time) };
        let [travel, squares] = bounce.travel;
        let middle = primary.frequency * (t + 0.5 * time);
        let (viscous, friction) =
            (2.0 * model.zeta * bounce.square, 2.0 * model.alpha * bounce.depth);
        let (dashpot, force) = (primary.damping * squares, primary.force * middle.sin() * travel);
        let taken = before + force - self.case.energy(released) - viscous - friction - dashpot;
        for (account, work) in
            self.accounts.iter_mut().zip([viscous, friction, taken, dashpot, force])
        {
            *account += work;
        }
        self.record_turns(time, self.state, released, |t| bounce.point(t));
        if let Some(impact) = self.impacts.last_mut() {
            impact.penetration = impact.penetration.max(bounce.depth);
        }
        self.state = released;
        self.t = t + time;
        self.path.push(t, self.t, PrimarySegment::ClosedBounce(bounce));
        let direction = if self.case.sticks() { -side.sign() } else { 0.0 };
        self.end_contact(side, direction);
        true
    }

    /// Follows a pendulum that a hard barrier carries, until the acceleration of the main mass lets
    /// go of it. The impacts by which it came to rest, ever smaller, are one.
    fn press_in_closed_form(&mut self, chain: &PrimaryChain, side: Side) -> bool {
        let (t, state) = (self.t, self.state);
        let force = push(&self.case, side, t, state);
        let shallow = (-force / self.case.model.gamma).max(0.0).powf(2.0 / 3.0);
        let is_pressed = force < 0.0 && shallow < SHALLOW && state.velocity.abs() < SLOW;
        if !is_pressed || self.case.model.alpha > 0.0 {
            return false;
        }
        // The momentum of both stays.
        let cosine = state.x.cos();
        let whole = self.case.primary.mass + 1.0;
        let resting = PrimaryState {
            velocity: 0.0,
            speed: state.speed + state.velocity * cosine / whole,
            ..state
        };
        let relative = relative_mass(&self.case.primary, state.x);
        let Some(is_released) = self.rest_on(chain, resting, Support::Barrier(side)) else {
            return false;
        };
        self.accounts[2] += 0.5 * relative * state.velocity * state.velocity;
        if let Some(impact) = self.impacts.last_mut() {
            impact.penetration = impact.penetration.max(shallow);
        }
        if is_released {
            self.end_contact(side, 0.0);
        }
        true
    }

    fn hold_in_closed_form(&mut self, chain: &PrimaryChain) -> Result<bool, PrimaryError> {
        if self.case.model.depth(self.state.x).is_some() {
            return Ok(false);
        }
        let support = Support::Friction(self.case.model.alpha);
        let Some(is_released) = self.rest_on(chain, self.state, support) else {
            return Ok(false);
        };
        if is_released {
            // The torque has just reached the friction: it slips against it.
            let torque = push(&self.case, Side::Right, self.t, self.state);
            self.set_off(-torque.signum())?;
        }
        Ok(true)
    }

    /// Follows the main mass with the pendulum at rest from this state until its support gives way,
    /// for a piece at most; returns whether it gives way, `None` if there is no closed form.
    fn rest_on(
        &mut self,
        chain: &PrimaryChain,
        state: PrimaryState,
        support: Support,
    ) -> Option<bool> {
        let resting = RestingPendulum::new(&self.case, self.t, state)?;
        let left = self.settings.duration - self.t;
        let piece = chain.longest().min(left);
        let release = resting.release(support, piece);
        let time = release.unwrap_or(piece);
        let after = resting.point(time);
        let work = self.work_between(time, |t| resting.point(t));
        self.add_work(work);
        self.record_turns(time, state, after, |t| resting.point(t));
        self.state = after;
        self.advance(time, PrimarySegment::Resting(resting));
        Some(release.is_some())
    }

    /// Advances the clock, to the end of the duration exactly where that is meant.
    fn advance(&mut self, time: f64, segment: PrimarySegment) {
        let (start, left) = (self.t, self.settings.duration - self.t);
        self.t = if time == left { self.settings.duration } else { start + time };
        self.path.push(start, self.t, segment);
    }

    /// Adds the energies of a phase without contact to the accounts.
    fn add_work(&mut self, [viscous, friction, dashpot, force]: [f64; 4]) {
        let work = [viscous, friction, 0.0, dashpot, force];
        self.accounts.iter_mut().zip(work).for_each(|(account, work)| *account += work);
    }
}

/// A time within this one at which a speed with these values at its ends is zero, by the Illinois
/// rule: to a part of 1e-6, where an extremum has twice the digits.
fn turn(speed: impl Fn(f64) -> f64, time: f64, [first, last]: [f64; 2]) -> f64 {
    let (mut old, mut new) = ((0.0, first), (time, last));
    for _ in 0..MOST_SECANTS {
        let t = new.0 - new.1 * (new.0 - old.0) / (new.1 - old.1);
        if (t - new.0).abs() <= 1e-6 * time || !t.is_finite() {
            break;
        }
        let found = (t, speed(t));
        match found.1 * new.1 < 0.0 {
            true => old = new,
            // The end that stays counts half, so that it does not stay for ever.
            false => old.1 *= 0.5,
        }
        new = found;
    }
    new.0
}

/// Largest number of secants.
const MOST_SECANTS: usize = 40;

/// Nodes and weights of the Gauss-Legendre rule of four points on [-1, 1].
const RULE: [(f64, f64); 4] = [
    (-0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
    (-0.339_981_043_584_856_26, 0.652_145_154_862_546_2),
    (0.339_981_043_584_856_26, 0.652_145_154_862_546_2),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
];
