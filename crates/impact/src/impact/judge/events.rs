//! Verification by the library's Runge-Kutta on the same equation, one smooth right side at a time.
//!
//! ```text
//! free:      x'' = field(t, x) + damping(x')
//! contact:   d'' = s (field + damping) - (gamma + mu d') d^(3/2),   d = s (x - x_s), s = 1 right, -1 left
//! detached:  d'' = s (field + damping)                              while gamma + mu d' < 0
//! stuck:     x'' = 0                                                while |all but friction| <= alpha
//! ```
//!
//! It shares the forces of [`Model`] with the Taylor series and nothing else: no series, no
//! regularised variable, no polynomials of its own, but the phases and located events of
//! [`integrate_phases`]. In contact it counts from the barrier, so that a shallow depth keeps its
//! digits.

use super::Coordinate;
use crate::impact::model::{Model, Side, Start};
use crate::impact::simulation::{
    ContactRecord, Integrator, Regime, Settings, Simulation, SimulationPath, SimulationStop,
    TurningPoint, begin_contact, scaled,
};
use crate::numeric::ode::{
    self, Event, EventOccurrence, IntegrationError, StopReason, Trajectory, integrate_phases,
};

/// The mode of the hybrid system: the region of the pendulum and the direction of dry friction.
#[derive(Debug, Clone, Copy, PartialEq)]
struct HybridMode {
    region: Regime,
    /// 1 or -1 where Coulomb friction acts, in the direction of x; 0 at rest under it, and where
    /// there is none.
    direction: f64,
}

/// The action of an event.
#[derive(Debug, Clone, Copy, PartialEq)]
enum JudgeEvent {
    Touch(Side),
    Release,
    Turn,
    Detach,
    Reattach,
    LetGo,
    RestEnergy,
}

const REGIONS: [Regime; 5] = [
    Regime::Free,
    Regime::Contact(Side::Right),
    Regime::Contact(Side::Left),
    Regime::Detached(Side::Right),
    Regime::Detached(Side::Left),
];

/// The speed with which the motion starts when friction releases the pendulum.
const NUDGE: f64 = 1e-14;

/// Each region moving without Coulomb friction, rising, falling, and stuck.
const MOTIONS: usize = 4;

fn index(place: HybridMode, stuck: bool) -> usize {
    let region = REGIONS.iter().position(|region| *region == place.region).unwrap_or(0);
    let motion = match place.direction {
        _ if stuck => 3,
        1.0 => 1,
        -1.0 => 2,
        _ => 0,
    };
    region * MOTIONS + motion
}

fn mode_and_sticking(index: usize) -> (HybridMode, bool) {
    let direction = [0.0, 1.0, -1.0, 0.0][index % MOTIONS];
    let region = REGIONS[(index / MOTIONS).min(REGIONS.len() - 1)];
    (HybridMode { region, direction }, index % MOTIONS == 3)
}

impl Coordinate {
    /// x itself, or the depth in the barrier of a region.
    fn for_region(model: &Model, region: Regime) -> Self {
        match region {
            Regime::Contact(side) | Regime::Detached(side) => {
                Self { sign: side.sign(), origin: model.barrier(side).unwrap_or_default() }
            }
            Regime::Free | Regime::Stuck => Self { sign: 1.0, origin: 0.0 },
        }
    }
}

/// The force other than friction at rest, in the direction of x.
fn force_at_rest(model: &Model, region: Regime, t: f64, value: f64) -> f64 {
    let coordinate = Coordinate::for_region(model, region);
    let contact = match region {
        Regime::Contact(_) => model.contact(value, 0.0),
        _ => 0.0,
    };
    model.field(t, coordinate.x(value)) - coordinate.sign * contact
}

/// The phase in which a pendulum at rest continues.
fn from_rest(model: &Model, region: Regime, t: f64, value: f64) -> usize {
    let force = force_at_rest(model, region, t, value);
    let direction = force.signum();
    let held = force.abs() <= model.alpha * (1.0 + 4.0 * f64::EPSILON);
    if held {
        return index(HybridMode { region, direction }, true);
    }
    let region = pushed_into(model, region, value, direction).unwrap_or(region);
    index(HybridMode { region, direction }, false)
}

/// The contact that begins at rest on a barrier, if the motion starts in this direction.
fn pushed_into(model: &Model, region: Regime, x: f64, direction: f64) -> Option<Regime> {
    let on = |side: &Side| {
        region == Regime::Free && model.barrier(*side) == Some(x) && direction == side.sign()
    };
    [Side::Left, Side::Right].into_iter().find(on).map(Regime::Contact)
}

/// The region in which a motion begins.
fn beginning(model: &Model, start: Start) -> Regime {
    if let Some((side, _)) = model.depth(start.x) {
        return match model.would_pull(side.sign() * start.velocity) {
            true => Regime::Detached(side),
            false => Regime::Contact(side),
        };
    }
    // At rest the force decides, and if that is zero, its rate of change.
    let rates = [start.velocity, model.field(0.0, start.x), model.field_rate(0.0, start.x)];
    let held = model.sticks() && start.velocity == 0.0;
    rates
        .into_iter()
        .find(|rate| *rate != 0.0 && !held)
        .and_then(|rate| pushed_into(model, Regime::Free, start.x, rate.signum()))
        .unwrap_or(Regime::Free)
}

/// An event and its action.
type Watched<'a> = (Event<'a>, JudgeEvent);

/// A phase of the run, and the actions of its events in order.
fn phase<'a>(
    model: &'a Model,
    settings: &Settings,
    number: usize,
) -> (ode::IntegrationPhase<'a>, Vec<JudgeEvent>) {
    let (place, stuck) = mode_and_sticking(number);
    let HybridMode { region, direction } = place;
    if stuck {
        let (event, meaning) = letting_go(model, place);
        return (ode::IntegrationPhase::new(|_, _, _| 0.0, vec![event]), vec![meaning]);
    }
    let mut watched = match region {
        Regime::Free | Regime::Stuck => touches(model, direction),
        Regime::Contact(side) | Regime::Detached(side) => ends_of_contact(model, place, side),
    };
    watched.push(turning(model, place));
    watched.extend(settings.rest_energy.map(|energy| fall_to_rest(model, region, energy)));
    let (events, meanings) = watched.into_iter().unzip();
    let coordinate = Coordinate::for_region(model, region);
    let swing =
        move |t: f64, x: f64, velocity: f64| model.field(t, x) + model.damping(velocity, direction);
    let phase = match region {
        Regime::Contact(_) => ode::IntegrationPhase::new(
            coordinate.contact(swing, |depth, speed| model.contact(depth, speed)),
            events,
        ),
        _ => ode::IntegrationPhase::new(coordinate.flight(swing), events),
    };
    (phase, meanings)
}

/// The event that ends sticking: the other forces together exceed the friction.
fn letting_go(model: &Model, HybridMode { region, .. }: HybridMode) -> Watched<'_> {
    let sign = Coordinate::for_region(model, region).sign;
    let excess = move |t: f64, value: f64, _: f64| {
        force_at_rest(model, region, t, value).abs() - model.alpha
    };
    let next = move |state: ode::State| {
        let direction = force_at_rest(model, region, state.t, state.x).signum();
        // The acceleration is still zero, so that the sign of the velocity would be arbitrary
        // without this value.
        let v = NUDGE * direction * sign;
        let (region, state) = match pushed_into(model, region, state.x, direction) {
            Some(contact) => (contact, ode::State { x: 0.0, v: NUDGE, ..state }),
            None => (region, ode::State { v, ..state }),
        };
        (index(HybridMode { region, direction }, false), state)
    };
    (Event::switch(excess, next).rising(), JudgeEvent::LetGo)
}

/// The touches of the barriers in free flight.
fn touches(model: &Model, direction: f64) -> Vec<Watched<'_>> {
    let touch = |side: Side| {
        let barrier = model.barrier(side)?;
        let next = move |state: ode::State| {
            let contact = HybridMode { region: Regime::Contact(side), direction };
            // The motion is inwards, even if rounding gives another sign for a pendulum at rest on
            // the barrier.
            let v = (side.sign() * state.v).max(0.0);
            (index(contact, false), ode::State { x: 0.0, v, ..state })
        };
        let depth = move |_: f64, x: f64, _: f64| side.sign() * (x - barrier);
        Some((Event::switch(depth, next).rising(), JudgeEvent::Touch(side)))
    };
    [Side::Left, Side::Right].into_iter().filter_map(touch).collect()
}

/// The events inside a barrier: the release, and for a damped contact the instants at which the
/// pendulum becomes faster than the barrier or no longer is.
fn ends_of_contact(
    model: &Model,
    HybridMode { region, direction }: HybridMode,
    side: Side,
) -> Vec<Watched<'_>> {
    let Coordinate { sign, origin } = Coordinate::for_region(model, region);
    let to = move |region: Regime| index(HybridMode { region, direction }, false);
    let release = move |state: ode::State| {
        let v = sign * state.v.min(0.0);
        (to(Regime::Free), ode::State { x: origin, v, ..state })
    };
    let mut watched =
        vec![(Event::switch(|_, depth, _| depth, release).falling(), JudgeEvent::Release)];
    if model.mu > 0.0 {
        let push = move |_: f64, _: f64, speed: f64| model.gamma + model.mu * speed;
        watched.push(match region {
            Regime::Contact(_) => {
                let next = move |state: ode::State| (to(Regime::Detached(side)), state);
                (Event::switch(push, next).falling(), JudgeEvent::Detach)
            }
            _ => {
                let next = move |state: ode::State| (to(Regime::Contact(side)), state);
                (Event::switch(push, next).rising(), JudgeEvent::Reattach)
            }
        });
    }
    watched
}

/// The turning points: under Coulomb friction each decides how the motion goes on.
fn turning(model: &Model, HybridMode { region, direction }: HybridMode) -> Watched<'_> {
    if direction == 0.0 {
        return (Event::record(|_, _, v| v), JudgeEvent::Turn);
    }
    let next = move |state: ode::State| {
        let state = ode::State { v: 0.0, ..state };
        (from_rest(model, region, state.t, state.x), state)
    };
    let turn = Event::switch(move |_, _, v| v, next);
    let inwards = direction * Coordinate::for_region(model, region).sign > 0.0;
    let turn = if inwards { turn.falling() } else { turn.rising() };
    (turn, JudgeEvent::Turn)
}

/// The event that ends the run: the energy falls to that of rest.
fn fall_to_rest(model: &Model, region: Regime, rest_energy: f64) -> Watched<'_> {
    let coordinate = Coordinate::for_region(model, region);
    let energy = move |_: f64, value: f64, v: f64| {
        let stored = match region {
            Regime::Contact(_) => model.elastic_energy(value),
            _ => 0.0,
        };
        model.swing_energy(coordinate.x(value), v) + stored - rest_energy
    };
    (Event::stop(energy).falling(), JudgeEvent::RestEnergy)
}

/// The motion by Runge-Kutta.
pub(in crate::impact) fn follow(
    model: &Model,
    start: Start,
    settings: &Settings,
) -> Result<Simulation, IntegrationError> {
    let settings = &scaled(settings, model, start);
    let (phases, meanings): (Vec<_>, Vec<_>) =
        (0..REGIONS.len() * MOTIONS).map(|number| phase(model, settings, number)).unzip();
    let region = beginning(model, start);
    let Coordinate { sign, origin } = Coordinate::for_region(model, region);
    let first = match start.velocity {
        _ if !model.sticks() => index(HybridMode { region, direction: 0.0 }, false),
        0.0 => from_rest(model, region, 0.0, sign * (start.x - origin)),
        velocity => {
            let direction = velocity.signum();
            index(HybridMode { region, direction }, false)
        }
    };
    // The force that releases a stuck pendulum varies with the excitation, not with the motion.
    let watched = model.sticks() && model.beta != 0.0 && model.frequency_ratio > 0.0;
    let maximum_step = if watched { 1.0 / model.frequency_ratio } else { f64::INFINITY };
    let options = ode::IntegrationOptions {
        relative_tolerance: settings.relative_tolerance,
        absolute_tolerance: settings.absolute_tolerance,
        maximum_steps: settings.maximum_steps,
        maximum_step,
        interrupt: settings.interrupt,
        ..ode::IntegrationOptions::default()
    };
    let first_region = mode_and_sticking(first).0.region;
    let begin = ode::State {
        t: 0.0,
        x: match first_region {
            Regime::Free => start.x,
            first => {
                let Coordinate { sign, origin } = Coordinate::for_region(model, first);
                sign * (start.x - origin)
            }
        },
        v: sign * start.velocity,
    };
    let trajectory = integrate_phases(&phases, first, begin, settings.duration, &options)?;
    let (impacts, turns) =
        contacts_and_turns((model, settings), start, first_region, &trajectory, &meanings);
    let end = trajectory.end();
    let (end_x, end_velocity) = end_in_x(model, &trajectory);
    Ok(Simulation {
        model: *model,
        start,
        settings: *settings,
        integrator: Integrator::RungeKutta,
        impacts,
        turns,
        end_time: end.t,
        end_x,
        end_velocity,
        stop: stop_of(trajectory.stop_reason()),
        steps: trajectory.step_count(),
        path: path_of(model, settings, trajectory),
        fall: None,
    })
}

/// Contacts and turning points from the events of the run.
fn contacts_and_turns(
    (model, settings): (&Model, &Settings),
    start: Start,
    first: Regime,
    trajectory: &Trajectory,
    meanings: &[Vec<JudgeEvent>],
) -> (Vec<ContactRecord>, Vec<TurningPoint>) {
    let mut impacts: Vec<ContactRecord> = Vec::new();
    if let Regime::Contact(side) | Regime::Detached(side) = first {
        let depth = model.depth(start.x).map_or(0.0, |(_, depth)| depth);
        let speed = side.sign() * start.velocity;
        begin_contact(&mut impacts, (model, settings), side, 0.0, [depth, speed]);
    }
    let mut turns = Vec::new();
    if start.velocity == 0.0 {
        turns.push(TurningPoint { t: 0.0, x: start.x });
    }
    for EventOccurrence { phase, event, state, .. } in trajectory.occurrences().iter().copied() {
        let region = mode_and_sticking(phase).0.region;
        match meanings.get(phase).and_then(|list| list.get(event)) {
            Some(&JudgeEvent::Touch(side)) => {
                let speed = (side.sign() * state.v).max(0.0);
                begin_contact(&mut impacts, (model, settings), side, state.t, [0.0, speed]);
            }
            Some(JudgeEvent::Release) => {
                if let Some(impact) = impacts.last_mut() {
                    impact.released(model, state.t, (-state.v).max(0.0));
                }
            }
            Some(meaning @ (JudgeEvent::Turn | JudgeEvent::LetGo)) => {
                let direction = force_at_rest(model, region, state.t, state.x).signum();
                if let JudgeEvent::LetGo = meaning
                    && let Some(Regime::Contact(side)) =
                        pushed_into(model, region, state.x, direction)
                {
                    begin_contact(&mut impacts, (model, settings), side, state.t, [0.0, 0.0]);
                }
                turns.push(TurningPoint {
                    t: state.t,
                    x: Coordinate::for_region(model, region).x(state.x),
                });
                if matches!(region, Regime::Contact(_))
                    && let Some(impact) = impacts.last_mut()
                {
                    impact.penetration = impact.penetration.max(state.x);
                }
            }
            _ => {}
        }
    }
    (impacts, turns)
}

/// The reason why the run ended.
fn stop_of(reason: StopReason) -> SimulationStop {
    match reason {
        StopReason::EndReached => SimulationStop::Duration,
        StopReason::Event { .. } => SimulationStop::RestEnergy,
        StopReason::NonFinite { time } => SimulationStop::NotFinite { t: time },
        StopReason::MaximumSteps { time } => SimulationStop::Steps { t: time },
        StopReason::Interrupted { time } => SimulationStop::Interrupted { t: time },
        StopReason::StepTooSmall { time } => SimulationStop::StepTooSmall { t: time },
        StopReason::SwitchingStalled { time } => SimulationStop::Stalled { t: time },
    }
}

/// Displacement and velocity at the end, in the coordinate of the last phase that took time: an
/// event that switches leaves the end in the coordinate it switched to only if a step followed.
fn end_in_x(model: &Model, trajectory: &Trajectory) -> (f64, f64) {
    let knots: Vec<f64> = trajectory.knots().map(|knot| knot.t).collect();
    let last_phase = knots
        .windows(2)
        .rev()
        .find_map(|pair| trajectory.phase_at(0.5 * (pair[0] + pair[1])))
        .unwrap_or(0);
    let coordinate = Coordinate::for_region(model, mode_and_sticking(last_phase).0.region);
    let end = trajectory.end();
    (coordinate.x(end.x), coordinate.sign * end.v)
}

/// The run as a function of time, a piece for each step.
fn path_of(model: &Model, settings: &Settings, trajectory: Trajectory) -> SimulationPath {
    let knots: Vec<f64> = trajectory.knots().map(|knot| knot.t).collect();
    let mut path = SimulationPath::judged(trajectory);
    if settings.keep_path {
        for pair in knots.windows(2) {
            let [from, to] = [pair[0], pair[1]];
            let phase = path.judged_phase(0.5 * (from + to)).unwrap_or(0);
            let (HybridMode { region, .. }, stuck) = mode_and_sticking(phase);
            let Coordinate { origin, sign } = Coordinate::for_region(model, region);
            let regime = if stuck { Regime::Stuck } else { region };
            path.push_judged([from, to], regime, [origin, sign]);
        }
    }
    path
}
