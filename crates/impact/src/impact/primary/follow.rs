//! Integration of the motion from phase to phase: flight, contact, held by friction.
//!
//! A flight ends at a touch, or where friction changes its direction; a contact ends where w is
//! zero again, or where the barrier would have to pull and lets go; a held phase ends where the
//! torque exceeds the greatest friction. Every phase begins with the states that the last one left,
//! exactly.
//!
//! At the onset of a slip x' and x'' are both zero, so that rounding decides in which direction x'
//! leaves its zero. Therefore only crossings in one direction end a phase, and each such event has
//! a second one at a level that rounding does not reach:
//!
//! ```text
//! slip in direction d:   d x' falls through 0                          or through -ROUNDING alpha
//! held:                  |torque| grows through alpha                  or through (1 + ROUNDING) alpha
//! ```

use std::cell::Ref;
use std::rc::Rc;

use super::super::model::Side;
use super::super::simulation::REST_FRACTION;
use super::chain::PrimaryChain;
use super::equations::{ACCOUNTS, DerivedSolvers, PhaseSystem, PrimaryEquations};
use super::flight::ClosedFlight;
use super::path::{PrimaryPath, PrimarySegment, PrimaryState};
use super::{
    PrimaryCase, PrimaryEnergy, PrimaryError, PrimaryImpact, PrimaryMotion, PrimarySettings,
    PrimaryStop,
};
use crate::exact::from_f64;
use crate::expr::{Expr, parse_expression};
use crate::system::{Event, Path, PathEnd, SideBySide, Solver, SystemOptions};

/// Follows both bodies from their start until the duration is over.
///
/// # Errors
/// [`PrimaryError`]; a motion that ends early says so by [`PrimaryMotion::stop`].
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::Model;
/// use lindstedt::impact::primary::{Primary, PrimaryCase, PrimarySettings, simulate_primary};
///
/// // A main mass a million times the pendulum hardly notices it.
/// let primary = Primary { mass: 1e6, stiffness: 1e6, damping: 0.0, force: 0.0, frequency: 0.0 };
/// let model = Model { left: None, right: None, ..Model::default() };
/// let case = PrimaryCase { primary, model, start: [0.0, 0.0, 0.1, 0.0] };
/// let motion = simulate_primary(case, &PrimarySettings { duration: 10.0, ..PrimarySettings::default() })?;
/// assert!((motion.state_at(10.0).ok_or("a state")?.y - 0.1 * 10.0_f64.cos()).abs() < 1e-5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn simulate_primary(
    case: PrimaryCase,
    settings: &PrimarySettings,
) -> Result<PrimaryMotion, PrimaryError> {
    let mut motion = FollowedMotion::new(case, settings, DerivedSolvers::default())?;
    loop {
        match motion.next_phase()? {
            NextPhase::Stopped(stop) => return Ok(motion.run.finish(stop)),
            NextPhase::Integrated(phase) => {
                let path = phase.solver().solve(phase.times, &phase.start)?;
                motion.take(phase, path)?;
            }
        }
    }
}

/// Follows several motions of a main mass: their integrated phases run side by side, and each motion is bit for bit
/// that of [`simulate_primary`] alone, but that its state is kept at the end alone.
pub(super) fn simulate_primaries(
    motions: &[(PrimaryCase, PrimarySettings)],
) -> Vec<Result<PrimaryMotion, PrimaryError>> {
    let (mut side_by_side, derived) = (SideBySide::default(), DerivedSolvers::default());
    let mut found: Vec<Option<Result<PrimaryMotion, PrimaryError>>> =
        motions.iter().map(|_| None).collect();
    let mut followed: Vec<(usize, FollowedMotion)> = vec![];
    for (index, (case, settings)) in motions.iter().enumerate() {
        match FollowedMotion::new(*case, settings, derived.clone()) {
            Ok(mut motion) => {
                motion.run.path = PrimaryPath::of_end();
                followed.push((index, motion));
            }
            Err(error) => found[index] = Some(Err(error)),
        }
    }
    while !followed.is_empty() {
        let mut phases = vec![];
        let mut going = vec![];
        for (index, mut motion) in followed {
            match motion.next_phase() {
                Ok(NextPhase::Integrated(phase)) => {
                    phases.push(phase);
                    going.push((index, motion));
                }
                Ok(NextPhase::Stopped(stop)) => found[index] = Some(Ok(motion.run.finish(stop))),
                Err(error) => found[index] = Some(Err(error)),
            }
        }
        let solvers: Vec<Ref<Solver>> = phases.iter().map(Phase::solver).collect();
        let runs = phases.iter().zip(&solvers);
        let runs = runs.map(|(phase, solver)| (&**solver, phase.times, &phase.start[..]));
        let paths = side_by_side.solve(&runs.collect::<Vec<_>>());
        drop(solvers);
        followed = vec![];
        for (((index, mut motion), phase), path) in going.into_iter().zip(phases).zip(paths) {
            let path = path.map_err(PrimaryError::from);
            match path.and_then(|path| motion.take(phase, path)) {
                Ok(()) => followed.push((index, motion)),
                Err(error) => found[index] = Some(Err(error)),
            }
        }
    }
    found.into_iter().flatten().collect()
}

/// A motion that is followed from phase to phase.
struct FollowedMotion<'a> {
    run: PrimaryRun<'a>,
    /// The closed forms of its phases, where these are asked for.
    chain: Option<PrimaryChain>,
    /// The time at which the last phase began.
    before: f64,
    /// The reason why the last phase is the last one.
    stop: Option<PrimaryStop>,
}

/// The next phase of a motion.
enum NextPhase {
    /// A phase without a closed form.
    Integrated(Phase),
    /// There is none.
    Stopped(PrimaryStop),
}

/// A phase that is about to be integrated.
struct Phase {
    followed: Rc<PhaseSystem>,
    /// The place of the solver with its events.
    solver: usize,
    times: [f64; 2],
    start: Vec<f64>,
    kind: PhaseKind,
}

/// The data of a phase that its end needs.
enum PhaseKind {
    /// A flight with an event for each of these barriers, the second and later ones, and then those of a turning
    /// point or of the end of a slip.
    Flight { direction: f64, sides: Vec<Side> },
    /// A contact, at this depth at its beginning, with the number of the event at which the barrier would pull.
    Contact { side: Side, direction: f64, place: f64, depth: f64, pulls: usize },
    /// The way out of a barrier that lets go, from this position.
    LetGo { side: Side, direction: f64, place: f64, before: f64 },
    /// The main mass alone, with the pendulum held at x, in a barrier or not.
    Held { x: f64, inside: Option<Side> },
}

impl Phase {
    fn solver(&self) -> Ref<'_, Solver> {
        self.followed.solver(self.solver)
    }
}

impl<'a> FollowedMotion<'a> {
    fn new(
        case: PrimaryCase,
        settings: &'a PrimarySettings,
        derived: DerivedSolvers,
    ) -> Result<Self, PrimaryError> {
        case.check()?;
        if !(settings.duration > 0.0 && settings.duration.is_finite()) {
            return Err(PrimaryError::Duration(settings.duration));
        }
        let chain = settings.chain.then(|| PrimaryChain::new(&case)).transpose()?;
        let run = PrimaryRun::new(case, settings, derived)?;
        Ok(Self { run, chain, before: 0.0, stop: None })
    }

    /// Follows the phases with a closed form up to the next one without.
    fn next_phase(&mut self) -> Result<NextPhase, PrimaryError> {
        loop {
            if let Some(stop) = self.stop.or_else(|| self.stop_before_phase()) {
                return Ok(NextPhase::Stopped(stop));
            }
            let run = &mut self.run;
            self.before = run.t;
            let is_closed = match &self.chain {
                Some(chain) => run.follow_in_closed_form(chain)?,
                None => false,
            };
            match is_closed {
                true => self.close(PathEnd::Reached),
                false => return Ok(NextPhase::Integrated(run.begin_phase()?)),
            }
        }
    }

    /// Counts the next phase; returns the reason if there is none.
    fn stop_before_phase(&mut self) -> Option<PrimaryStop> {
        let settings = self.run.settings;
        let run = &mut self.run;
        if run.t >= settings.duration {
            return Some(PrimaryStop::Duration);
        }
        if settings.interrupt.is_requested() {
            return Some(PrimaryStop::Interrupted);
        }
        if run.phases >= settings.phase_limit {
            return Some(PrimaryStop::PhaseLimit);
        }
        run.phases += 1;
        (settings.stop_at_rest && run.is_at_rest()).then_some(PrimaryStop::AtRest)
    }

    /// Continues at the end of a phase that has been integrated.
    fn take(&mut self, phase: Phase, path: Path) -> Result<(), PrimaryError> {
        let reason = self.run.end_phase(phase, path)?;
        self.close(reason);
        Ok(())
    }

    /// Completes a phase that has ended for this reason.
    fn close(&mut self, reason: PathEnd) {
        let run = &mut self.run;
        run.close_accounts();
        self.stop = match reason {
            PathEnd::Interrupted => Some(PrimaryStop::Interrupted),
            PathEnd::Reached | PathEnd::Event(_) => None,
            PathEnd::StepLimit
            | PathEnd::Singular
            | PathEnd::Overflow
            | PathEnd::Sticks
            | PathEnd::PassesWall
            | PathEnd::EventsAccumulate
            | PathEnd::NoReset => Some(PrimaryStop::Singular),
        };
        if self.stop.is_some() {
            return;
        }
        // Consecutive phases of length zero mean that the motion is stuck.
        run.idle = if run.t > self.before { 0 } else { run.idle + 1 };
        if run.idle > IDLE {
            self.stop = Some(PrimaryStop::Singular);
        }
    }
}

/// Largest number of consecutive phases of length zero.
const IDLE: usize = 8;

/// Largest torque or speed that counts as zero up to rounding, relative to the friction.
const ROUNDING: f64 = 1e-12;

/// The mode of the pendulum; the direction is that of dry friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum PrimaryRegime {
    Free(f64),
    Contact(Side, f64),
    /// Inside a barrier that exerts no force because it would have to pull.
    LetGo(Side, f64),
    Held,
}

/// The state of an integration.
pub(super) struct PrimaryRun<'a> {
    pub(super) case: PrimaryCase,
    pub(super) settings: &'a PrimarySettings,
    equations: PrimaryEquations,
    pub(super) regime: PrimaryRegime,
    pub(super) t: f64,
    pub(super) state: PrimaryState,
    pub(super) accounts: [f64; ACCOUNTS],
    phases: usize,
    /// Phases that were integrated.
    integrated: usize,
    idle: usize,
    pub(super) path: PrimaryPath,
    /// The flight in closed form that was the last, whose memory the next one takes over.
    pub(super) flight: ClosedFlight,
    pub(super) impacts: Vec<PrimaryImpact>,
    /// Energy taken by the contacts when the open impact began.
    taken: f64,
    pub(super) turns: Vec<(f64, f64)>,
    pub(super) swings: Vec<(f64, f64)>,
    start_energy: f64,
    largest: f64,
    astray: f64,
}

fn parsed(text: &str) -> Expr {
    parse_expression(text).unwrap_or_else(|_| Expr::zero())
}

/// A finite number as an expression.
fn number(value: f64) -> Expr {
    from_f64(value).map_or_else(Expr::zero, Expr::number)
}

fn offset(name: &str, place: f64) -> Expr {
    parsed(name) - number(place)
}

impl<'a> PrimaryRun<'a> {
    fn new(
        case: PrimaryCase,
        settings: &'a PrimarySettings,
        derived: DerivedSolvers,
    ) -> Result<Self, PrimaryError> {
        let [x, velocity, y, speed] = case.start;
        let state = PrimaryState { x, velocity, y, speed };
        let energy = case.energy(state);
        let mut run = Self {
            case,
            settings,
            equations: PrimaryEquations::new(case, derived)?,
            regime: PrimaryRegime::Free(0.0),
            t: 0.0,
            state,
            accounts: [0.0; ACCOUNTS],
            phases: 0,
            integrated: 0,
            idle: 0,
            path: PrimaryPath::default(),
            flight: ClosedFlight::default(),
            impacts: Vec::new(),
            taken: 0.0,
            turns: Vec::new(),
            swings: Vec::new(),
            start_energy: energy,
            largest: energy.abs(),
            astray: 0.0,
        };
        let inside = case.model.depth(x);
        let push =
            inside.map_or(0.0, |(side, depth)| -side.sign() * case.model.contact(depth, 0.0));
        let direction = run.direction(push);
        if let Some((side, depth)) = inside {
            run.begin_impact(side, depth);
        }
        run.regime = match (direction, inside) {
            (None, _) => PrimaryRegime::Held,
            (Some(direction), None) => return run.set_off(direction).map(|()| run),
            (Some(direction), Some((side, _))) if case.model.would_pull(side.sign() * velocity) => {
                PrimaryRegime::LetGo(side, direction)
            }
            (Some(direction), Some((side, _))) => PrimaryRegime::Contact(side, direction),
        };
        Ok(run)
    }

    /// The direction of dry friction: that of the motion, or of the torque on what is at rest;
    /// `None` if friction holds the pendulum. `contact` is the force of a contact.
    fn direction(&self, contact: f64) -> Option<f64> {
        if !self.case.sticks() {
            return Some(0.0);
        }
        if self.state.velocity != 0.0 {
            return Some(self.state.velocity.signum());
        }
        let PrimaryState { x, y, speed, .. } = self.state;
        let torque = self.equations.torque(self.t, x, contact, [y, speed]);
        (torque.abs() > self.case.model.alpha).then(|| torque.signum())
    }

    /// Continues in this direction: into the barrier on whose surface it is, if it moves or is
    /// pushed that way, else in free flight.
    pub(super) fn set_off(&mut self, direction: f64) -> Result<(), PrimaryError> {
        self.regime = PrimaryRegime::Free(direction);
        let PrimaryState { x, velocity, y, speed } = self.state;
        for side in [Side::Left, Side::Right] {
            if x != self.barrier_position(side) {
                continue;
            }
            let push = match velocity == 0.0 {
                // From rest it slips in the direction that friction opposes, possibly only with its
                // third derivative.
                true if direction != 0.0 => direction,
                true => self.equations.acceleration(self.t, [x, velocity, y, speed], direction)?,
                false => velocity,
            };
            if side.sign() * push > 0.0 {
                self.begin_contact(side, direction);
            }
        }
        Ok(())
    }

    fn options(&self) -> SystemOptions {
        SystemOptions {
            tolerance: self.settings.tolerance,
            interrupt: self.settings.interrupt,
            ..SystemOptions::default()
        }
    }

    /// The position of a barrier.
    pub(super) fn barrier_position(&self, side: Side) -> f64 {
        self.case.model.barrier(side).unwrap_or(f64::INFINITY * side.sign())
    }

    /// The states, followed by the energies that change in this phase.
    fn with_accounts(&self, states: &[f64], followed: &PhaseSystem) -> Vec<f64> {
        let accounts = followed.accounts.iter().map(|account| self.accounts[*account]);
        states.iter().copied().chain(accounts).collect()
    }

    /// Stores the energies that follow the states in `values`.
    fn keep_accounts(&mut self, values: &[f64], followed: &PhaseSystem) {
        for (account, value) in followed.accounts.iter().zip(values) {
            self.accounts[*account] = *value;
        }
    }

    /// Prepares the integration of the next phase.
    fn begin_phase(&mut self) -> Result<Phase, PrimaryError> {
        self.integrated += 1;
        match self.regime {
            PrimaryRegime::Free(direction) => self.begin_flight(direction),
            PrimaryRegime::Contact(side, direction) => self.begin_touch(side, direction),
            PrimaryRegime::LetGo(side, direction) => self.begin_letting_go(side, direction),
            PrimaryRegime::Held => self.begin_hold(),
        }
    }

    /// Continues with the state at the end of a phase; returns the reason of that end.
    fn end_phase(&mut self, phase: Phase, path: Path) -> Result<PathEnd, PrimaryError> {
        let Phase { followed, start, kind, .. } = phase;
        match kind {
            PhaseKind::Flight { direction, sides } => {
                let swings = Some(1 + sides.len());
                let reason = self.end_free(path, &start, &followed, swings);
                if let PathEnd::Event(event) = reason {
                    match sides.get(event.wrapping_sub(1)) {
                        Some(side) => self.begin_contact(*side, direction),
                        None => self.turn_back(0.0)?,
                    }
                }
                Ok(reason)
            }
            PhaseKind::Contact { .. } => self.end_touch(path, &start, &followed, &kind),
            PhaseKind::LetGo { side, direction, place, before } => {
                let reason = self.end_free(path, &start, &followed, None);
                // The elastic energy that the barrier stores on this way is not returned.
                let stored = |x: f64| {
                    let depth = (side.sign() * (x - place)).max(0.0);
                    self.case.model.elastic_energy(depth)
                };
                self.accounts[2] += stored(before) - stored(self.state.x);
                match reason {
                    PathEnd::Event(1) => self.end_contact(side, direction),
                    PathEnd::Event(2) => self.regime = PrimaryRegime::Contact(side, direction),
                    _ => {}
                }
                Ok(reason)
            }
            PhaseKind::Held { x, inside } => self.end_hold(path, &start, &followed, (x, inside)),
        }
    }

    /// A phase of these equations until one of these events.
    fn phase(
        &self,
        followed: Rc<PhaseSystem>,
        (times, start): ([f64; 2], Vec<f64>),
        events: &[Event],
        kind: PhaseKind,
    ) -> Phase {
        let solver = followed.place_of_solver(events, &self.options());
        Phase { followed, solver, times, start, kind }
    }

    /// The end of a flight that is integrated: a swing later where closed forms may go on.
    fn end_of_flight(&self) -> f64 {
        let end = self.settings.duration;
        if self.settings.chain { end.min(self.t + std::f64::consts::TAU) } else { end }
    }

    fn begin_flight(&mut self, direction: f64) -> Result<Phase, PrimaryError> {
        let mut events = vec![Event::record(parsed("y'"))];
        let mut sides = Vec::new();
        for side in [Side::Left, Side::Right] {
            if let Some(place) = self.case.model.barrier(side) {
                sides.push(side);
                events.push(Event::stop(offset("x", place)));
            }
        }
        match self.case.sticks() {
            true => events.extend(self.end_of_slip(direction)),
            false => events.push(Event::record(parsed("x'"))),
        }
        self.begin_free(direction, &events, PhaseKind::Flight { direction, sides })
    }

    /// The events that end a slip in this direction: the pendulum comes to rest, or never leaves
    /// it.
    fn end_of_slip(&self, direction: f64) -> [Event; 2] {
        let forward = Expr::from(direction as i64) * parsed("x'");
        let unseen = number(ROUNDING * self.case.model.alpha);
        [&forward + &Expr::zero(), forward + unseen].map(|speed| Event::stop(speed).falling())
    }

    /// The motion without contact forces until one of these events. The first are the turning points of the main
    /// mass.
    fn begin_free(
        &self,
        direction: f64,
        events: &[Event],
        kind: PhaseKind,
    ) -> Result<Phase, PrimaryError> {
        let followed = self.equations.flight(direction)?;
        let PrimaryState { x, velocity, y, speed } = self.state;
        let start = self.with_accounts(&[x, velocity, y, speed], &followed);
        Ok(self.phase(followed, ([self.t, self.end_of_flight()], start), events, kind))
    }

    /// Continues after such a motion; the event of this number, if given, are the turning points of the pendulum.
    fn end_free(
        &mut self,
        path: Path,
        start: &[f64],
        followed: &PhaseSystem,
        swings: Option<usize>,
    ) -> PathEnd {
        self.turns_of(&path, |state| state[2], |time| time);
        for met in path.occurrences().iter().filter(|met| Some(met.event) == swings) {
            self.swings.extend(path.states_at(met.time).map(|state| (met.time, state[0])));
        }
        let (reason, end) = (path.reason(), path.end());
        let last = path.states_at(end).unwrap_or_else(|| start.to_vec());
        self.state = PrimaryState { x: last[0], velocity: last[1], y: last[2], speed: last[3] };
        self.keep_accounts(&last[4..], followed);
        self.path.push(self.t, end, PrimarySegment::Flight(path));
        self.t = end;
        reason
    }

    /// Decides at a moment of rest whether the pendulum turns back or is held.
    pub(super) fn turn_back(&mut self, contact: f64) -> Result<(), PrimaryError> {
        self.state.velocity = 0.0;
        match self.direction(contact) {
            Some(direction) => self.set_off(direction),
            None => {
                self.regime = PrimaryRegime::Held;
                Ok(())
            }
        }
    }

    pub(super) fn begin_contact(&mut self, side: Side, direction: f64) {
        self.state.x = self.barrier_position(side);
        self.begin_impact(side, 0.0);
        self.regime = PrimaryRegime::Contact(side, direction);
    }

    /// Records an impact that begins now, at this depth in the barrier.
    fn begin_impact(&mut self, side: Side, depth: f64) {
        self.taken = self.accounts[2];
        self.impacts.push(PrimaryImpact {
            side,
            entry_time: self.t,
            exit_time: None,
            speed_in: side.sign() * self.state.velocity,
            speed_out: None,
            penetration: depth,
            energy_lost: 0.0,
        });
    }

    pub(super) fn end_contact(&mut self, side: Side, direction: f64) {
        self.state.x = self.barrier_position(side);
        let (t, taken, velocity) = (self.t, self.taken, self.state.velocity);
        if let Some(impact) = self.impacts.last_mut() {
            impact.exit_time = Some(t);
            impact.speed_out = Some(-side.sign() * velocity);
            impact.energy_lost = self.accounts[2] - taken;
        }
        self.regime = PrimaryRegime::Free(direction);
    }

    fn begin_touch(&mut self, side: Side, direction: f64) -> Result<Phase, PrimaryError> {
        let place = self.barrier_position(side);
        let followed = self.equations.contact(side, place, direction)?;
        let depth = (side.sign() * (self.state.x - place)).max(0.0);
        // At a touch with zero speed the variable w would never leave zero.
        let w = depth.sqrt().max(if self.state.velocity == 0.0 { 1e-12 } else { 0.0 });
        let mut events = vec![
            Event::record(parsed("y'")),
            Event::stop(parsed("w")),
            Event::stop(offset("t", self.settings.duration)),
        ];
        match self.case.sticks() {
            true => events.extend(self.end_of_slip(direction)),
            false => events.push(Event::record(parsed("x'"))),
        }
        let pulls = events.len();
        if self.case.model.mu > 0.0 {
            let sign = Expr::from(side.sign() as i64);
            events.push(Event::stop(parsed("gamma") + sign * parsed("mu*x'")).falling());
        }
        let PrimaryState { velocity, y, speed, .. } = self.state;
        let start = self.with_accounts(&[w, velocity, y, speed, self.t], &followed);
        let kind = PhaseKind::Contact { side, direction, place, depth, pulls };
        Ok(self.phase(followed, ([0.0, LONGEST_CONTACT], start), &events, kind))
    }

    fn end_touch(
        &mut self,
        path: Path,
        start: &[f64],
        followed: &PhaseSystem,
        kind: &PhaseKind,
    ) -> Result<PathEnd, PrimaryError> {
        let &PhaseKind::Contact { side, direction, place, depth, pulls } = kind else {
            return Ok(path.reason());
        };
        self.turns_of(&path, |state| state[2], |_| f64::NAN);
        let turns = path.occurrences().iter().filter(|met| met.event == 3);
        let turns: Vec<Vec<f64>> = turns.filter_map(|met| path.states_at(met.time)).collect();
        let deepest = turns.iter().map(|state| state[0] * state[0]).fold(depth, f64::max);
        let swing = |state: &Vec<f64>| (state[4], place + side.sign() * state[0] * state[0]);
        self.swings.extend(turns.iter().map(swing));
        let reason = path.reason();
        let last = path.states_at(path.end()).unwrap_or_else(|| start.to_vec());
        let w = last[0].max(0.0);
        self.state = PrimaryState {
            x: place + side.sign() * w * w,
            velocity: last[1],
            y: last[2],
            speed: last[3],
        };
        self.keep_accounts(&last[5..], followed);
        let end = last[4].min(self.settings.duration);
        if let Some(impact) = self.impacts.last_mut() {
            impact.penetration = impact.penetration.max(deepest).max(w * w);
        }
        self.path.push(self.t, end, PrimarySegment::Contact { path, side, place });
        self.t = end;
        match reason {
            PathEnd::Event(1) => self.end_contact(side, direction),
            PathEnd::Event(2) => self.t = self.settings.duration,
            PathEnd::Event(event) if event == pulls => {
                self.regime = PrimaryRegime::LetGo(side, direction)
            }
            PathEnd::Event(_) => {
                let push = -side.sign() * self.case.model.contact(w * w, 0.0);
                self.turn_back(push)?;
                if let PrimaryRegime::Free(direction) = self.regime {
                    self.regime = PrimaryRegime::Contact(side, direction);
                }
            }
            _ => {}
        }
        Ok(reason)
    }

    /// Follows the pendulum out of a barrier that returns more slowly than it: without force, until
    /// it has left the barrier or is pushed again.
    fn begin_letting_go(&mut self, side: Side, direction: f64) -> Result<Phase, PrimaryError> {
        let place = self.barrier_position(side);
        let sign = Expr::from(side.sign() as i64);
        let events = [
            Event::record(parsed("y'")),
            Event::stop(offset("x", place)),
            Event::stop(parsed("gamma") + sign * parsed("mu*x'")).rising(),
        ];
        let kind = PhaseKind::LetGo { side, direction, place, before: self.state.x };
        self.begin_free(direction, &events, kind)
    }

    fn begin_hold(&mut self) -> Result<Phase, PrimaryError> {
        let PrimaryState { x, y, speed, .. } = self.state;
        let inside = self.case.model.depth(x);
        let contact =
            inside.map_or(0.0, |(side, depth)| -side.sign() * self.case.model.contact(depth, 0.0));
        let (followed, torque) = self.equations.equations_when_held(x, contact)?;
        let bound = self.case.model.alpha;
        let mut events = vec![Event::record(parsed("y'"))];
        for bound in [bound, (1.0 + ROUNDING) * bound].map(number) {
            events.push(Event::stop(&torque - &bound).rising());
            events.push(Event::stop(&torque + &bound).falling());
        }
        let start = self.with_accounts(&[y, speed], &followed);
        let kind = PhaseKind::Held { x, inside: inside.map(|(side, _)| side) };
        Ok(self.phase(followed.into(), ([self.t, self.settings.duration], start), &events, kind))
    }

    fn end_hold(
        &mut self,
        path: Path,
        start: &[f64],
        followed: &PhaseSystem,
        (x, inside): (f64, Option<Side>),
    ) -> Result<PathEnd, PrimaryError> {
        self.turns_of(&path, |state| state[0], |time| time);
        let (reason, end) = (path.reason(), path.end());
        let last = path.states_at(end).unwrap_or_else(|| start.to_vec());
        self.state = PrimaryState { x, velocity: 0.0, y: last[0], speed: last[1] };
        self.keep_accounts(&last[2..], followed);
        self.path.push(self.t, end, PrimarySegment::Held { path, x });
        self.t = end;
        if let PathEnd::Event(event) = reason {
            let direction = if event % 2 == 1 { 1.0 } else { -1.0 };
            match inside {
                Some(side) => self.regime = PrimaryRegime::Contact(side, direction),
                None => self.set_off(direction)?,
            }
        }
        Ok(reason)
    }

    /// The turning points of the main mass in this piece.
    fn turns_of(&mut self, path: &Path, y: impl Fn(&[f64]) -> f64, time: impl Fn(f64) -> f64) {
        for met in path.occurrences().iter().filter(|met| met.event == 0) {
            if let Some(state) = path.states_at(met.time) {
                let t = time(met.time);
                // In a contact the time is one of the states.
                let t = if t.is_nan() { state.get(4).copied().unwrap_or(self.t) } else { t };
                self.turns.push((t, y(&state)));
            }
        }
    }

    /// Whether the total energy is too small for the main mass to reach a tenth of its start; the
    /// limit is half of that, so that turning points below the tenth have been recorded.
    fn is_at_rest(&self) -> bool {
        let [.., y, speed] = self.case.start;
        let primary = &self.case.primary;
        let first = y.hypot(speed * (primary.mass / primary.stiffness).sqrt());
        let level = 0.5 * REST_FRACTION * first;
        primary.force == 0.0
            && first > 0.0
            && self.turns.len() > 2
            && self.case.energy(self.state) < 0.5 * primary.stiffness * level * level
    }

    /// Completes the energy balance at the end of a phase.
    fn close_accounts(&mut self) {
        let energy = self.case.energy(self.state);
        let [viscous, friction, contact, dashpot, force] = self.accounts;
        let astray = energy - self.start_energy + viscous + friction + contact + dashpot - force;
        self.largest = self.largest.max(energy.abs()).max(force.abs());
        self.astray = self.astray.max(astray.abs());
    }

    fn finish(self, stop: PrimaryStop) -> PrimaryMotion {
        let [viscous, friction, contact, dashpot, force] = self.accounts;
        PrimaryMotion {
            case: self.case,
            end: self.t,
            stop,
            by_chain: self.settings.chain,
            integrated: self.integrated,
            impacts: self.impacts,
            turns: self.turns,
            swings: self.swings,
            energy: PrimaryEnergy {
                start: self.start_energy,
                end: self.case.energy(self.state),
                viscous,
                friction,
                contact,
                dashpot,
                force,
                residual: if self.largest > 0.0 { self.astray / self.largest } else { 0.0 },
            },
            path: self.path,
        }
    }
}

/// A duration in s, which is longer than the time by one over the root of the depth, that no
/// contact reaches.
const LONGEST_CONTACT: f64 = 1e12;
