//! A motion followed from its start: any equation of the grammar, any mechanism, in numbers.
//!
//! ```text
//! h = sum q_i' dL/dq_i' - L,  L = T - V        dh/dt = -dL/dt + sum q_i' (Q_i - dD/dq_i')
//! ```
//!
//! (H. Goldstein, *Classical Mechanics*, 2nd ed., section 2-6, for h; of an equation it is
//! `x'^2/2 + V(x)`.) In: coordinates, their accelerations, numbers for every parameter, a start, a
//! duration. Out: a [`Trajectory`]: every state at any time, the balance of energy where a
//! mechanism has energies, and the same by the other integrator to judge it. Power series go first,
//! in time or, where a root acts as in Hertz's contact, in a variable that resolves it; where there
//! are none, as at rest exactly at the touch, Runge-Kutta takes the whole motion. Where dry friction, `sgn(x')`, `sgn(x' - c)` on a belt or `sgn(x' - y')`
//! between two bodies, holds something, it stays until the force on it is more than friction bears.

mod attractors;
mod energy;
mod error;
mod event_run;
mod events;
mod hold;
mod joining;
mod neighbourhood;
mod prepared;
mod pulse;
mod resting;
mod section;
mod sensitivity;
mod state_functions;
mod surplus;
mod sweep;
mod two_sided;
mod walls;

use std::collections::{BTreeMap, BTreeSet};

use crate::coupled::CoupledEquations;
use crate::event::StateEvent;
use crate::expr::{CompiledFunction, Expr};
use crate::interrupt::Interrupt;
use crate::mechanics::{EquationsOfMotion, Mechanism, Rates};
use crate::oscillator::Oscillator;
use crate::symbol::{Symbol, fresh};
use crate::system::{
    Event, Integrator, Path, PathEnd, SideBySide, Solver, System, SystemError, SystemOptions,
    roots_across_corners,
};
use crate::wall::Wall;
use error::names;

pub use attractors::{Attractor, Basins, Fate};
pub use error::TrajectoryError;
pub use joining::{SettledStarts, sweep_to_attractors};
pub use prepared::{PreparedTrajectory, TrajectoryEnd};
pub use section::{Crossing, MOST_CROSSINGS, PoincareSection};
pub use sensitivity::{DISPLACEMENT, LyapunovExponent};
pub use sweep::{SweptMotion, sweep};

use event_run::{EventRun, PieceKeeping, RunEnd};
use events::{CompiledEvents, WORK_OF_EVENTS};
pub use events::{EventOccurrence, EventRecord};
use hold::{Layout, friction_arguments};
use resting::resting_equations;
use section::OnSection;
pub(crate) use surplus::of_one_size as shares_of_one_size;
pub(crate) use two_sided::by_sides;
use walls::{CompiledWalls, WORK_OF_WALLS};
pub use walls::{Impact, WallRecord, WallRest};

/// An initial value problem: equations, initial state and duration.
#[derive(Clone, Debug, PartialEq)]
pub struct TrajectoryRequest {
    /// The coordinates.
    pub coordinates: Vec<Symbol>,
    /// The equations, as they print, each `... = 0`.
    pub equations: Vec<Expr>,
    /// Coordinates and velocities with their rates.
    pub rates: Rates,
    /// h and what changes it; `None` for an equation whose inertia depends on the position.
    pub energy: Option<EnergyWithPowers>,
    /// The matrix of the coefficients of the accelerations, which is that of the masses where it is
    /// symmetric; `None` for one coordinate.
    pub mass: Option<Vec<Vec<Expr>>>,
    /// The rigid walls.
    pub walls: Vec<Wall>,
    /// The events.
    pub events: Vec<StateEvent>,
    /// Static over sliding friction, 1 or more: the force at which dry friction that holds something lets go,
    /// over that with which it slides; `None` for 1.
    pub static_friction: Option<Expr>,
    /// A number for every parameter.
    pub values: BTreeMap<Symbol, f64>,
    /// Initial positions and velocities, in the order of the states.
    pub start: Vec<f64>,
    /// Duration, in the unit of time.
    pub duration: f64,
    /// The Poincaré section at which states are recorded beside the requested times.
    pub section: Option<PoincareSection>,
    /// Start of the recording: the motion before it has not settled.
    pub after: f64,
    /// The time before which no states are asked for, so that they need not be kept.
    pub keep_from: f64,
    /// Relative error of a step.
    pub tolerance: f64,
    /// Steps after which it ends.
    pub step_limit: usize,
    /// The interrupt.
    pub interrupt: Interrupt,
}

/// An energy and what changes it.
#[derive(Clone, Debug, PartialEq)]
pub struct EnergyWithPowers {
    /// h in coordinates and velocities.
    pub value: Expr,
    /// The power of each force that has no part in h, by its name.
    pub powers: Vec<(String, Expr)>,
}

/// A motion.
#[derive(Clone, Debug)]
pub struct Trajectory {
    /// The initial value problem that was solved.
    pub course: TrajectoryRequest,
    /// The integration method.
    pub integrator: Integrator,
    /// The balance of energy; `None` if there is no energy.
    pub balance: Option<EnergyBalance>,
    /// The impacts on walls and the rests on them.
    pub walls: WallRecord,
    /// The events that took place.
    pub events: EventRecord,
    pieces: Vec<TrajectorySegment>,
    /// The ranges of the coordinates on earlier pieces that are not kept; none if all are.
    earlier: Vec<[f64; 2]>,
    on_section: OnSection,
    reason: PathEnd,
}

/// The energy at the end, beside that of the start and the work in between.
#[derive(Clone, Debug, PartialEq)]
pub struct EnergyBalance {
    /// h at the start.
    pub start: f64,
    /// h at the end.
    pub end: f64,
    /// Work of all forces, dampers and moving constraints together.
    pub work: f64,
    /// Work of each of them, by its name.
    pub works: Vec<(String, f64)>,
    /// The largest |h - h(0) - work| of many times, over the largest |h - h(0)| or kinetic share:
    /// how far the account is off.
    pub residual: f64,
}

/// The index among all states of the work of this name; `None` if it is not accounted for.
fn work_of(course: &TrajectoryRequest, name: &str) -> Option<usize> {
    let energy = course.energy.as_ref().filter(|_| course.missing_for_energy().is_empty())?;
    let place = energy.powers.iter().position(|(own, _)| own == name)?;
    Some(course.rates.states.len() + place)
}

/// The times at which energy is accounted for.
const ACCOUNTS: u32 = 2000;

impl TrajectoryRequest {
    /// The initial value problem of an equation of motion, from rest at zero for 50 units of time.
    /// Its energy is that of the velocity and of all terms of the position alone that have a
    /// potential in closed form; every other term has a work of its own.
    pub fn of_equation(oscillator: &Oscillator) -> Self {
        let coordinate = oscillator.coordinate;
        let velocity = oscillator.velocity();
        let acceleration = Expr::from(velocity.derivative());
        Self::new(
            vec![coordinate],
            vec![&acceleration + &oscillator.force],
            Rates {
                states: vec![coordinate, velocity],
                right: vec![Expr::from(velocity), -&oscillator.force],
            },
            energy::energy_of_equation(oscillator),
        )
    }

    /// The initial value problem of a mechanism, from rest at zero for 50 units of time.
    ///
    /// # Errors
    /// Energies that give no accelerations.
    pub fn of_mechanism(
        mechanism: &Mechanism,
        equations: &EquationsOfMotion,
    ) -> Result<Self, TrajectoryError> {
        let lagrangian = &mechanism.kinetic - &mechanism.potential;
        let mut energy = vec![-&lagrangian];
        let moving = -lagrangian.differentiate(Symbol::new("t"))?;
        let mut powers = vec![("moving constraints".to_owned(), moving)];
        let mut lost = Vec::new();
        for coordinate in &mechanism.coordinates {
            let velocity = coordinate.derivative();
            let speed = Expr::from(velocity);
            energy.push(&speed * &mechanism.kinetic.differentiate(velocity)?);
            lost.push(-(&speed * &mechanism.dissipation.differentiate(velocity)?));
            let force = mechanism.forces.get(coordinate);
            powers.extend(force.map(|force| (format!("Q_{coordinate}"), &speed * force)));
        }
        powers.push(("dissipation".to_owned(), Expr::sum(lost)));
        powers.retain(|(_, power)| !power.is_zero());
        let energy = EnergyWithPowers { value: Expr::sum(energy), powers };
        let request = Self::new(
            mechanism.coordinates.clone(),
            equations.left.clone(),
            equations.rates()?,
            Some(energy),
        );
        Ok(Self { mass: Some(equations.mass.clone()), ..request })
    }

    /// The initial value problem of coupled equations, from rest at zero for 50 units of time, without
    /// an account of energy.
    ///
    /// ```
    /// # use lindstedt_verify as lindstedt;
    /// use lindstedt::coupled::CoupledEquations;
    /// use lindstedt::trajectory::TrajectoryRequest;
    ///
    /// let pair = CoupledEquations::parse("x'' + 2*x - y = 0; y'' + 2*y - x = 0")?;
    /// let mut course = TrajectoryRequest::of_coupled(&pair);
    /// course.begin("x".into(), 1.0)?;
    /// course.begin("y".into(), -1.0)?;
    /// let state = course.follow()?.states_at(10.0).ok_or("no state")?;
    /// assert!((state[0] - (3.0_f64.sqrt() * 10.0).cos()).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of_coupled(equations: &CoupledEquations) -> Self {
        let lefts = equations.equations.iter().map(|(left, right)| left - right).collect();
        let request =
            Self::new(equations.coordinates.clone(), lefts, equations.rates.clone(), None);
        Self { mass: Some(equations.matrix.clone()), ..request }
    }

    /// Returns the problem with rigid walls, whose work is accounted for where there is an energy.
    #[must_use]
    pub fn with_walls(mut self, walls: Vec<Wall>) -> Self {
        if let (Some(energy), false) = (&mut self.energy, walls.is_empty()) {
            energy.powers.push((WORK_OF_WALLS.to_owned(), Expr::zero()));
        }
        Self { walls, ..self }
    }

    /// Returns the problem with events, whose work is accounted for where there is an energy.
    ///
    /// ```
    /// # use lindstedt_verify as lindstedt;
    /// use lindstedt::Oscillator;
    /// use lindstedt::event::StateEvent;
    /// use lindstedt::trajectory::TrajectoryRequest;
    ///
    /// let mut course = TrajectoryRequest::of_equation(&Oscillator::parse("x'' + x = 0")?);
    /// let kick = StateEvent::parse("x > 0: x' = x' + 1", &course.rates.states)?;
    /// course = course.with_events(vec![kick]);
    /// course.begin("x".into(), -1.0)?;
    /// course.duration = 4.0;
    /// let motion = course.follow()?;
    /// // The kick at t = pi/2 doubles the amplitude.
    /// assert!((motion.events.occurrences[0].after[1] - 2.0).abs() < 1e-14);
    /// assert!((motion.states_at(3.0).ok_or("a state")?[0] + 2.0 * 3.0_f64.cos()).abs() < 1e-13);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn with_events(mut self, events: Vec<StateEvent>) -> Self {
        if let (Some(energy), false) = (&mut self.energy, events.is_empty()) {
            energy.powers.push((WORK_OF_EVENTS.to_owned(), Expr::zero()));
        }
        Self { events, ..self }
    }

    /// The initial value problem of coordinates and velocities with these rates, from rest at zero for 50
    /// units of time, without an account of energy.
    pub(crate) fn of_rates(coordinates: Vec<Symbol>, rates: Rates) -> Self {
        Self::new(coordinates, vec![], rates, None)
    }

    fn new(
        coordinates: Vec<Symbol>,
        equations: Vec<Expr>,
        rates: Rates,
        energy: Option<EnergyWithPowers>,
    ) -> Self {
        Self {
            start: vec![0.0; rates.states.len()],
            coordinates,
            equations,
            rates,
            energy,
            mass: None,
            walls: vec![],
            events: vec![],
            static_friction: None,
            values: BTreeMap::new(),
            duration: 50.0,
            section: None,
            after: 0.0,
            keep_from: f64::NEG_INFINITY,
            tolerance: SystemOptions::default().tolerance,
            step_limit: SystemOptions::default().step_limit,
            interrupt: Interrupt::default(),
        }
    }

    /// Sets the initial value of a state: `x`, `x'`.
    ///
    /// # Errors
    /// A name that is not a state.
    pub fn begin(&mut self, name: Symbol, value: f64) -> Result<(), TrajectoryError> {
        match self.rates.states.iter().position(|state| *state == name) {
            Some(place) => self.start[place] = value,
            None => {
                return Err(TrajectoryError::NoState { name, states: names(&self.rates.states) });
            }
        }
        Ok(())
    }

    /// The names that take a number: those of the motion, and those of the energy alone, as a mass
    /// that cancels.
    pub fn parameters(&self) -> Vec<Symbol> {
        let mut all = self.parameters_of_motion();
        all.extend(self.parameters_of_energy());
        all.into_iter().collect()
    }

    /// The names without whose numbers nothing moves.
    fn parameters_of_motion(&self) -> BTreeSet<Symbol> {
        let section = self.section.iter().filter_map(PoincareSection::expression);
        let walls = self.walls.iter().flat_map(|wall| [&wall.gap, &wall.restitution]);
        let mass = self.mass.iter().flatten().flatten().filter(|_| !self.walls.is_empty());
        let events = self.events.iter().flat_map(StateEvent::expressions);
        let all = self.rates.right.iter().chain(section).chain(walls).chain(mass).chain(events);
        let all = all.chain(&self.static_friction);
        let all = all.flat_map(Expr::symbols);
        all.filter(|name| !self.is_variable(*name)).collect()
    }

    /// The names that stand in the energy.
    fn parameters_of_energy(&self) -> BTreeSet<Symbol> {
        let energy = self.energy.iter();
        let energy = energy
            .flat_map(|energy| energy.powers.iter().map(|(_, power)| power).chain([&energy.value]));
        let all = energy.flat_map(Expr::symbols);
        all.filter(|name| !self.is_variable(*name)).collect()
    }

    fn is_variable(&self, name: Symbol) -> bool {
        self.rates.states.contains(&name) || name.name() == "t"
    }

    /// The names without a number that the motion does not depend on and its energy does: without
    /// them the energy is not accounted for.
    pub fn missing_for_energy(&self) -> Vec<Symbol> {
        let of_motion = self.parameters_of_motion();
        let missing = |name: &Symbol| !self.values.contains_key(name) && !of_motion.contains(name);
        self.parameters_of_energy().into_iter().filter(missing).collect()
    }

    /// Follows the motion.
    ///
    /// # Errors
    /// [`TrajectoryError`]; a run that ends early says so by [`Trajectory::end`].
    ///
    /// ```
    /// # use lindstedt_verify as lindstedt;
    /// use lindstedt::Oscillator;
    /// use lindstedt::trajectory::TrajectoryRequest;
    ///
    /// let mut course = TrajectoryRequest::of_equation(&Oscillator::parse("x'' + 4*x = 0")?);
    /// course.begin("x".into(), 1.0)?;
    /// let motion = course.follow()?;
    /// assert!((motion.states_at(10.0).ok_or("no state")?[0] - 20.0_f64.cos()).abs() < 1e-13);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn follow(self) -> Result<Trajectory, TrajectoryError> {
        let first = self.clone().follow_by(Integrator::Taylor);
        self.or_by_evaluation(first)
    }

    /// A motion that was followed by its series; where there is none at the start, or it ends, it
    /// may still be followed by evaluation alone.
    fn or_by_evaluation(
        self,
        first: Result<Trajectory, TrajectoryError>,
    ) -> Result<Trajectory, TrajectoryError> {
        match first {
            Ok(motion) if motion.reason != PathEnd::Singular => Ok(motion),
            Ok(_) | Err(TrajectoryError::System(SystemError::Start(_))) => {
                let second = self.follow_by(Integrator::RungeKutta);
                match (&first, &second) {
                    (Ok(one), Ok(other)) if one.end() >= other.end() => first,
                    (Ok(_), Err(_)) => first,
                    _ => second,
                }
            }
            Err(_) => first,
        }
    }

    /// Follows the motion by this integrator alone.
    ///
    /// # Errors
    /// As [`TrajectoryRequest::follow`].
    pub fn follow_by(self, integrator: Integrator) -> Result<Trajectory, TrajectoryError> {
        let ready = self.ready(integrator)?;
        let mut run = EventRun::new(&self, &ready, (0.0, ready.start(&self)), integrator)?;
        run.complete()?;
        let ended = run.finish();
        self.motion(ended, integrator)
    }

    /// Follows several courses by their series, those that differ in numbers and starts alone side
    /// by side; `ready` is one of them, made ready.
    fn followed_together(
        courses: Vec<Self>,
        ready: Option<&Ready>,
        keeping: &PieceKeeping,
    ) -> Vec<Result<Trajectory, TrajectoryError>> {
        let made_ready = |course: &Self| {
            let adapted = match ready {
                Some(ready) => {
                    course.check_start()?;
                    ready.with_numbers(course)
                }
                None => None,
            };
            let ready = adapted.map_or_else(|| course.ready(Integrator::Taylor), Ok)?;
            let start = ready.start(course);
            Ok::<_, TrajectoryError>((ready, start))
        };
        let all: Vec<_> = courses.iter().map(made_ready).collect();
        let mut runs: Vec<Result<EventRun, TrajectoryError>> = courses
            .iter()
            .zip(&all)
            .map(|(course, ready)| {
                let (ready, start) = ready.as_ref().map_err(Clone::clone)?;
                let (start, integrator) = ((0.0, start.clone()), Integrator::Taylor);
                match EventRun::new(course, ready, start.clone(), integrator) {
                    // This motion ends, and the others go on.
                    Err(error) if error.is_of_reset() => {
                        let reason = PathEnd::NoReset;
                        Ok(EventRun::ended_at_start(course, ready, start, integrator, reason))
                    }
                    run => run.map(|mut run| {
                        run.keep(keeping.clone());
                        run
                    }),
                }
            })
            .collect();
        // Each round goes on to the next impact of every motion.
        let mut side_by_side = SideBySide::default();
        loop {
            let is_going = |run: &mut Result<EventRun, _>| {
                run.as_mut().is_ok_and(|run| !run.has_ended() && run.next_flight().is_ok())
            };
            let going: Vec<bool> = runs.iter_mut().map(is_going).collect();
            let flights = runs.iter_mut().zip(&going).filter(|(_, going)| **going);
            let flights: Vec<_> =
                flights.filter_map(|(run, _)| run.as_mut().ok()?.next_flight().ok()).collect();
            if flights.is_empty() {
                break;
            }
            let mut paths = side_by_side.solve(&flights).into_iter();
            for (run, _) in runs.iter_mut().zip(&going).filter(|(_, going)| **going) {
                let path = paths.next().map(|path| path.map_err(TrajectoryError::from));
                let advanced = match (run.as_mut(), path) {
                    (Ok(run), Some(Ok(path))) => run.advance(Some(path)),
                    (Ok(_), Some(Err(error))) => Err(error),
                    _ => Ok(()),
                };
                match (run.as_mut(), advanced) {
                    // The motion has come this far, and the others go on.
                    (Ok(run), Err(error)) if error.is_of_reset() => run.end(PathEnd::NoReset),
                    (_, Err(error)) => *run = Err(error),
                    (_, Ok(())) => {}
                }
            }
        }
        let ended = |run: Result<EventRun, TrajectoryError>| {
            run.and_then(|mut run| {
                run.complete()?;
                Ok(run.finish())
            })
        };
        let ended: Vec<_> = runs.into_iter().map(ended).collect();
        let followed = |(course, ended): (Self, Result<_, TrajectoryError>)| {
            let first = ended.and_then(|ended| course.clone().motion(ended, Integrator::Taylor));
            course.or_by_evaluation(first)
        };
        courses.into_iter().zip(ended).map(followed).collect()
    }

    /// The motion of pieces that have been followed.
    fn motion(
        self,
        RunEnd { pieces, earlier, reason, walls, events }: RunEnd,
        integrator: Integrator,
    ) -> Result<Trajectory, TrajectoryError> {
        let mut motion = Trajectory {
            course: self,
            integrator,
            balance: None,
            walls,
            events,
            pieces,
            earlier,
            on_section: OnSection::default(),
            reason,
        };
        motion.balance = motion.account();
        motion.on_section = motion.find_on_section()?;
        Ok(motion)
    }

    fn options(&self, integrator: Integrator) -> SystemOptions {
        SystemOptions {
            integrator,
            tolerance: self.tolerance,
            step_limit: self.step_limit,
            keep_from: self.keep_from,
            interrupt: self.interrupt,
        }
    }

    /// The value of static over sliding friction.
    ///
    /// # Errors
    /// A value below 1, or none.
    fn static_friction_value(&self) -> Result<f64, TrajectoryError> {
        let Some(ratio) = &self.static_friction else { return Ok(1.0) };
        let value = ratio.evaluate(&self.values).unwrap_or(f64::NAN);
        match value >= 1.0 && value.is_finite() {
            true => Ok(value),
            false => Err(TrajectoryError::StaticFriction(ratio.clone(), value)),
        }
    }

    /// Whether the equations have digits where it begins.
    fn check_start(&self) -> Result<(), TrajectoryError> {
        let mut at_start = self.values.clone();
        at_start.extend(self.rates.states.iter().copied().zip(self.start.iter().copied()));
        at_start.insert(Symbol::new("t"), 0.0);
        for right in &self.rates.right {
            right.check_digits(&at_start, &self.rates.states)?;
        }
        Ok(())
    }

    /// Its equations, made ready to be followed by this integrator.
    fn ready(&self, integrator: Integrator) -> Result<Ready, TrajectoryError> {
        self.ready_on(&[], integrator)
    }

    /// The equations of a motion that rests on these walls, made ready to be followed.
    fn ready_on(
        &self,
        resting: &[usize],
        integrator: Integrator,
    ) -> Result<Ready, TrajectoryError> {
        let needed = self.parameters();
        let missing: Vec<Symbol> = self
            .parameters_of_motion()
            .into_iter()
            .filter(|name| !self.values.contains_key(name))
            .collect();
        if !missing.is_empty() {
            return Err(TrajectoryError::Missing(missing));
        }
        if !(self.duration > 0.0 && self.duration.is_finite()) {
            return Err(TrajectoryError::Duration(self.duration));
        }
        self.check_start()?;
        let on_walls = resting_equations(self, resting)?;
        let mut states = on_walls.rates.states;
        let mut right: Vec<Expr> = on_walls
            .rates
            .right
            .iter()
            .map(|right| roots_across_corners(right, &self.values))
            .collect::<Result<_, _>>()?;
        let mut taken: Vec<Symbol> = states.iter().chain(&needed).copied().collect();
        let energy = self.energy.as_ref().filter(|_| self.missing_for_energy().is_empty());
        for (name, power) in energy.iter().flat_map(|energy| &energy.powers) {
            let work = fresh("work", &taken);
            taken.push(work);
            states.push(work);
            let power = if name == WORK_OF_WALLS { &on_walls.power } else { power };
            right.push(roots_across_corners(power, &self.values)?);
        }
        let first = states.len();
        let mut watched = Vec::new();
        for event in &self.events {
            // The side from which a guard is watched and its level change at events alone.
            let own = ["side", "level"].map(|name| {
                let name = fresh(name, &taken);
                taken.push(name);
                name
            });
            states.extend(own);
            right.extend(own.map(|_| Expr::zero()));
            watched.push(events::watched(event, own));
        }
        let values: BTreeMap<Symbol, f64> =
            needed.iter().filter_map(|name| Some((*name, *self.values.get(name)?))).collect();
        let critical = pulse::critical_times(&right, &states, &values, self.duration);
        let system =
            System::new(&states, Symbol::new("t"), &right, &values)?.with_critical_times(&critical);
        let moving = Rates { states, right };
        let section = self.section.as_ref();
        let mut events = section.map_or(vec![], |section| section.events(&moving));
        let recorded = events.len();
        let guards = [on_walls.guards, watched].concat();
        events.extend(guards.iter().map(|guard| Event::stop(guard.clone()).falling()));
        let Rates { states, right } = moving;
        let static_friction = self.static_friction_value()?;
        let mut frictions = match self.static_friction {
            Some(_) => friction_arguments(&states, &right),
            None => vec![],
        };
        if self.static_friction.is_some() && frictions.is_empty() {
            return Err(TrajectoryError::WithoutFriction);
        }
        if static_friction == 1.0 {
            frictions.clear();
        }
        events.extend(frictions.iter().cloned().map(Event::stop));
        Ok(Ready {
            solver: system.solver(&events, &self.options(integrator)),
            recorded,
            guards,
            static_friction,
            frictions,
            walls: if resting.is_empty() { CompiledWalls::new(self)? } else { None },
            events: if resting.is_empty() { CompiledEvents::new(self, first)? } else { None },
            states,
            right,
            values,
            critical,
        })
    }
}

/// The equations of a course, made ready to be followed.
#[derive(Clone, Debug)]
struct Ready {
    /// Coordinates, velocities, works, and the side and level of the guard of each event.
    states: Vec<Symbol>,
    /// The rate of each, roots at corners as they are followed.
    right: Vec<Expr>,
    /// The value of every other symbol but the time.
    values: BTreeMap<Symbol, f64>,
    /// Times that no step crosses.
    critical: Vec<f64>,
    solver: Solver,
    /// The number of events of the section.
    recorded: usize,
    /// Functions at whose fall through zero a stretch ends: the gap of each wall, or its force; then the
    /// watched guard of each event.
    guards: Vec<Expr>,
    /// Static over sliding friction.
    static_friction: f64,
    /// The arguments of dry frictions, at whose zeros static friction may hold; none where it is the
    /// sliding one.
    frictions: Vec<Expr>,
    /// The walls, of a flight.
    walls: Option<CompiledWalls>,
    /// The events, of a flight.
    events: Option<CompiledEvents>,
}

impl Ready {
    /// The states at the start of a course; no work has been done.
    fn start(&self, course: &TrajectoryRequest) -> Vec<f64> {
        let mut start = course.start.clone();
        start.resize(self.states.len(), 0.0);
        start
    }

    /// These equations take the numbers of a course that differs in its numbers and its start
    /// alone. `None` says that other numbers make other equations.
    fn with_numbers(&self, course: &TrajectoryRequest) -> Option<Self> {
        let mut values = self.values.clone();
        for (name, value) in &mut values {
            *value = *course.values.get(name)?;
        }
        // The solver refuses other numbers in roots, by which they are written across corners.
        let solver = self.solver.with_numbers(&values)?;
        let critical = pulse::critical_times(&self.right, &self.states, &values, course.duration);
        // Without static friction there are fewer events.
        let static_friction = course.static_friction_value().ok()?;
        if (static_friction > 1.0) != (self.static_friction > 1.0) {
            return None;
        }
        Some(Self {
            states: self.states.clone(),
            right: self.right.clone(),
            recorded: self.recorded,
            guards: self.guards.clone(),
            static_friction,
            frictions: self.frictions.clone(),
            walls: self.walls.as_ref().map(|walls| walls.with_numbers(course)).transpose().ok()?,
            events: self.events.as_ref().map(|events| events.with_numbers(course)),
            solver: solver.with_critical_times(&critical),
            values,
            critical,
        })
    }
}

/// A stretch of a motion: as the equations say, or with something held by dry friction.
#[derive(Clone, Debug)]
struct TrajectorySegment {
    from: f64,
    path: Path,
    /// The map from the integrated states to all states on a sliding segment; `None` if all states
    /// are integrated.
    layout: Option<Box<Layout>>,
    /// The number of events of the path that are those of the section; they come first.
    recorded: usize,
}

impl TrajectorySegment {
    fn end(&self) -> f64 {
        self.path.end()
    }

    fn states_at(&self, time: f64) -> Option<Vec<f64>> {
        let states = self.path.states_at(time)?;
        Some(match &self.layout {
            None => states,
            Some(layout) => layout.states(time, &states),
        })
    }

    /// Writes the states at the end, from which the motion goes on; `false` if they are not known.
    fn write_last_states(&self, states: &mut Vec<f64>) -> bool {
        let held = self.is_held().then(|| self.states_at(self.end()));
        let last = held.as_ref().map_or_else(|| Some(self.path.last_states()), Option::as_deref);
        if let Some(last) = last {
            states.clear();
            states.extend_from_slice(last);
        }
        last.is_some()
    }

    /// Adds the states at times in increasing order, those up to the end, to a sample.
    fn sample(&self, times: &[f64], into: &mut Sampled) {
        let Sampled { times: kept, columns } = into;
        if !self.is_held() {
            self.path.sample(times, kept, columns);
            return;
        }
        for time in times {
            let Some(states) = self.states_at(*time) else {
                continue;
            };
            kept.push(*time);
            for (column, state) in columns.iter_mut().zip(states) {
                column.push(state);
            }
        }
    }

    /// Whether something is held.
    fn is_held(&self) -> bool {
        self.layout.is_some()
    }
}

/// The states at many times.
#[derive(Clone, Debug, Default)]
struct Sampled {
    /// The times at which states were requested.
    times: Vec<f64>,
    /// State by state the values then.
    columns: Vec<Vec<f64>>,
}

impl Sampled {
    /// All states at one of the times.
    fn row(&self, index: usize) -> Vec<f64> {
        let mut row = vec![];
        self.read_row(index, &mut row);
        row
    }

    /// All states at one of the times, in place of what the row holds.
    fn read_row(&self, index: usize, row: &mut Vec<f64>) {
        row.clear();
        row.extend(self.columns.iter().map(|column| column[index]));
    }

    /// Leaves out all times.
    fn clear(&mut self) {
        self.times.clear();
        self.columns.iter_mut().for_each(Vec::clear);
    }
}

impl Trajectory {
    /// The account of the energy.
    fn account(&self) -> Option<EnergyBalance> {
        let energy = self.course.energy.as_ref()?;
        if !self.course.missing_for_energy().is_empty() {
            return None;
        }
        // Compiled once: the account takes the energy and its terms at two thousand times.
        let value = self.compiled(&energy.value)?;
        let parts: Vec<_> =
            energy.value.terms().iter().filter_map(|part| self.compiled(part)).collect();
        let count = self.course.rates.states.len();
        let at = |time: f64, state: &[f64]| {
            let (state, works) = state.split_at(count);
            let works = &works[..energy.powers.len()];
            // Kinetic and potential energy may cancel each other: the largest of them counts beside
            // their sum.
            let parts = parts.iter().map(|part| part(time, state).abs());
            let largest = parts.filter(|part| part.is_finite()).fold(0.0, f64::max);
            let now = Some(value(time, state)).filter(|now| now.is_finite())?;
            Some((now, works.to_vec(), largest))
        };
        // The sum of nothing is minus zero.
        let sum = |works: &[f64]| works.iter().fold(0.0, |sum, work| sum + work);
        let (start, ..) = at(0.0, &self.all_at(0.0)?)?;
        let (end, works, _) = at(self.end(), &self.all_at(self.end())?)?;
        let (mut astray, mut moved) = (0.0_f64, 0.0_f64);
        let times = (0..=ACCOUNTS).map(|index| self.end() * f64::from(index) / f64::from(ACCOUNTS));
        let sampled = self.sample(times.collect(), count + energy.powers.len());
        if sampled.times.len() != ACCOUNTS as usize + 1 {
            return None;
        }
        for (index, time) in sampled.times.iter().enumerate() {
            let (now, works, largest) = at(*time, &sampled.row(index))?;
            let work = sum(&works);
            astray = astray.max((now - start - work).abs());
            moved = moved.max(now.abs()).max(work.abs()).max(largest);
        }
        Some(EnergyBalance {
            start,
            end,
            work: sum(&works),
            works: energy.powers.iter().map(|(name, _)| name.clone()).zip(works).collect(),
            residual: if moved > 0.0 { astray / moved } else { 0.0 },
        })
    }

    /// An expression as a function of the time and the states, at the values of this motion; `None`
    /// if a name has no value.
    fn compiled(&self, expression: &Expr) -> Option<impl Fn(f64, &[f64]) -> f64> {
        let states = &self.course.rates.states;
        let moving: Vec<Symbol> =
            std::iter::once(Symbol::new("t")).chain(states.iter().copied()).collect();
        let constant = self.course.values.iter().filter(|(name, _)| !moving.contains(name));
        let (constants, numbers): (Vec<Symbol>, Vec<f64>) =
            constant.map(|(name, value)| (*name, *value)).unzip();
        let function = CompiledFunction::new(expression, &[moving, constants].concat()).ok()?;
        Some(move |time: f64, state: &[f64]| function.call(&[&[time], state, &numbers].concat()))
    }

    /// The states and the work so far; `None` outside of the motion.
    fn all_at(&self, time: f64) -> Option<Vec<f64>> {
        let place = self.pieces.partition_point(|piece| piece.end() < time);
        self.pieces.get(place)?.states_at(time)
    }

    /// The first states at many times, in increasing order.
    fn sample(&self, times: Vec<f64>, count: usize) -> Sampled {
        let kept = Vec::with_capacity(times.len());
        let columns = vec![Vec::with_capacity(times.len()); count];
        let mut sampled = Sampled { times: kept, columns };
        let mut rest = times.as_slice();
        for piece in &self.pieces {
            let (own, others) = rest.split_at(rest.partition_point(|time| *time <= piece.end()));
            rest = others;
            piece.sample(own, &mut sampled);
        }
        sampled
    }

    /// The stretches of time, from when until when, on which dry friction holds something: at rest,
    /// on a belt or on another body.
    pub fn sticking_intervals(&self) -> impl Iterator<Item = [f64; 2]> {
        let mut held: Vec<[f64; 2]> = Vec::new();
        for piece in self.pieces.iter().filter(|piece| piece.is_held()) {
            match held.last_mut() {
                // Something else is held from there on.
                Some([_, until]) if *until == piece.from => *until = piece.end(),
                _ => held.push([piece.from, piece.end()]),
            }
        }
        held.into_iter()
    }

    /// The time at which it ends.
    pub fn end(&self) -> f64 {
        self.pieces.last().map_or(0.0, TrajectorySegment::end)
    }

    /// The reason why it ends there.
    pub fn reason(&self) -> PathEnd {
        self.reason
    }

    /// Whether it was followed as long as asked.
    pub fn is_complete(&self) -> bool {
        self.reason == PathEnd::Reached
    }

    /// Coordinates, then velocities; `None` outside of the motion.
    pub fn states_at(&self, time: f64) -> Option<Vec<f64>> {
        let mut state = self.all_at(time)?;
        state.truncate(self.course.rates.states.len());
        Some(state)
    }

    /// The ends of the stretches between which states jump, or friction begins or ends to hold something.
    pub(crate) fn piece_ends(&self) -> impl Iterator<Item = f64> {
        self.pieces.iter().map(TrajectorySegment::end)
    }

    /// Coordinates, then velocities just behind a time, which differ from those of
    /// [`Trajectory::states_at`] at an impact; `None` outside of the motion.
    pub fn states_after(&self, time: f64) -> Option<Vec<f64>> {
        let place = self.pieces.partition_point(|piece| piece.end() <= time);
        let mut state = self.pieces.get(place)?.states_at(time)?;
        state.truncate(self.course.rates.states.len());
        Some(state)
    }

    /// The largest difference of any coordinate from another motion of the same course, over the
    /// size of that coordinate.
    pub fn difference(&self, other: &Self) -> f64 {
        let end = self.end().min(other.end());
        let count = self.course.coordinates.len();
        let mut apart = vec![(0.0_f64, 0.0_f64); count];
        for index in 0..=ACCOUNTS {
            let time = end * f64::from(index) / f64::from(ACCOUNTS);
            let (Some(one), Some(two)) = (self.states_at(time), other.states_at(time)) else {
                continue;
            };
            for (entry, (one, two)) in apart.iter_mut().zip(one.iter().zip(&two)) {
                *entry = (entry.0.max((one - two).abs()), entry.1.max(one.abs()));
            }
        }
        let share = |(apart, size): (f64, f64)| if size > 0.0 { apart / size } else { apart };
        apart.into_iter().map(share).fold(0.0, f64::max)
    }
}

/// The reason why a motion ended, in words.
pub fn in_words(end: PathEnd) -> &'static str {
    match end {
        PathEnd::Reached => "at the time asked for",
        PathEnd::Event(_) => "at an event",
        PathEnd::StepLimit => "after as many steps as were allowed",
        PathEnd::Singular => "where a state or its rate has no value, or no next step",
        PathEnd::PassesWall => {
            "where it would pass a wall: impacts there follow each other faster than rounding resolves"
        }
        PathEnd::EventsAccumulate => {
            "where events follow each other ever faster: infinitely many take a finite time, and a motion that then rests needs a rigid wall"
        }
        PathEnd::NoReset => {
            "where an event sets a state to a value that is not a number, or behind a wall"
        }
        PathEnd::Overflow => "where a state leaves the range of numbers, 1e300",
        PathEnd::Sticks => {
            "on a corner that the rates on both sides lead back to, where it is not followed"
        }
        PathEnd::Interrupted => "interrupted",
    }
}
