//! The judge: the same equation by the library's Runge-Kutta, one smooth right side at a time.
//!
//! ```text
//! free:      x'' = field(t, x) + damping(x')
//! contact:   d'' = s (field + damping) - (gamma + mu d') d^(3/2),   d = s (x - x_s), s = 1 right, -1 left
//! detached:  d'' = s (field + damping)                              while gamma + mu d' < 0
//! stuck:     x'' = 0                                                while |all but friction| <= alpha
//! ```
//!
//! It shares the forces of [`Model`] with the Taylor series and nothing else: no series, no regularised variable, no
//! polynomials of its own, but the phases and located events of [`integrate_phases`]. In contact it counts from the
//! barrier, so that a shallow depth keeps its digits.

use crate::impact::model::{Model, Side, Start};
use crate::impact::simulation::{Contact, Integrator, Options, Path, Simulation, State, Stop, Turn, enter, scaled};
use crate::ode::{self, Event, IntegrationError, Occurrence, Phase, StopReason, Trajectory, integrate_phases};

/// Where the pendulum is and which way dry friction acts: a phase of the run.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Place {
    region: State,
    /// 1 or -1 where Coulomb friction acts, in the direction of x; 0 at rest under it, and where there is none.
    direction: f64,
}

/// What an event means.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Meaning {
    Touch(Side),
    Release,
    Turn,
    Detach,
    Reattach,
    LetGo,
    Calm,
}

const REGIONS: [State; 5] = [
    State::Free,
    State::Contact(Side::Right),
    State::Contact(Side::Left),
    State::Detached(Side::Right),
    State::Detached(Side::Left),
];

/// The speed at which friction lets go.
const NUDGE: f64 = 1e-14;

/// Each region moving without Coulomb friction, rising, falling, and stuck.
const MOTIONS: usize = 4;

fn index(place: Place, stuck: bool) -> usize {
    let region = REGIONS.iter().position(|region| *region == place.region).unwrap_or(0);
    let motion = match place.direction {
        _ if stuck => 3,
        1.0 => 1,
        -1.0 => 2,
        _ => 0,
    };
    region * MOTIONS + motion
}

fn place(index: usize) -> (Place, bool) {
    let direction = [0.0, 1.0, -1.0, 0.0][index % MOTIONS];
    let region = REGIONS[(index / MOTIONS).min(REGIONS.len() - 1)];
    (Place { region, direction }, index % MOTIONS == 3)
}

/// The coordinate of a region: x itself, or the depth in a barrier.
#[derive(Debug, Clone, Copy)]
struct Coordinate {
    sign: f64,
    origin: f64,
}

impl Coordinate {
    fn of(model: &Model, region: State) -> Self {
        match region {
            State::Contact(side) | State::Detached(side) => Self {
                sign: side.sign(),
                origin: model.barrier(side).unwrap_or_default(),
            },
            State::Free | State::Stuck => Self { sign: 1.0, origin: 0.0 },
        }
    }

    fn x(self, value: f64) -> f64 {
        self.origin + self.sign * value
    }
}

/// All but friction, at rest, in the direction of x.
fn force_at_rest(model: &Model, region: State, t: f64, value: f64) -> f64 {
    let coordinate = Coordinate::of(model, region);
    let contact = match region {
        State::Contact(_) => model.contact(value, 0.0),
        _ => 0.0,
    };
    model.field(t, coordinate.x(value)) - coordinate.sign * contact
}

/// The phase in which a pendulum at rest goes on.
fn from_rest(model: &Model, region: State, t: f64, value: f64) -> usize {
    let force = force_at_rest(model, region, t, value);
    let direction = force.signum();
    let held = force.abs() <= model.alpha * (1.0 + 4.0 * f64::EPSILON);
    if held {
        return index(Place { region, direction }, true);
    }
    let region = pushed_into(model, region, value, direction).unwrap_or(region);
    index(Place { region, direction }, false)
}

/// The contact that begins at rest on a barrier, where the motion sets off in this direction.
fn pushed_into(model: &Model, region: State, x: f64, direction: f64) -> Option<State> {
    let on = |side: &Side| region == State::Free && model.barrier(*side) == Some(x) && direction == side.sign();
    [Side::Left, Side::Right].into_iter().find(on).map(State::Contact)
}

/// The region in which a motion begins, and how fast it moves there in the coordinate of that region.
fn beginning(model: &Model, start: Start) -> State {
    if let Some((side, _)) = model.depth(start.x) {
        return match model.would_pull(side.sign() * start.velocity) {
            true => State::Detached(side),
            false => State::Contact(side),
        };
    }
    // At rest the force decides, and where there is none yet, the one that comes.
    let rates = [
        start.velocity,
        model.field(0.0, start.x),
        model.field_rate(0.0, start.x),
    ];
    let held = model.sticks() && start.velocity == 0.0;
    rates
        .into_iter()
        .find(|rate| *rate != 0.0 && !held)
        .and_then(|rate| pushed_into(model, State::Free, start.x, rate.signum()))
        .unwrap_or(State::Free)
}

fn phase<'a>(model: &'a Model, options: &Options, number: usize) -> (Phase<'a>, Vec<Meaning>) {
    let (Place { region, direction }, stuck) = place(number);
    let coordinate = Coordinate::of(model, region);
    let Coordinate { sign, origin } = coordinate;
    let mut events: Vec<(Event<'a>, Meaning)> = Vec::new();
    let to = move |region: State| index(Place { region, direction }, false);
    if stuck {
        let excess = move |t: f64, value: f64, _: f64| force_at_rest(model, region, t, value).abs() - model.alpha;
        let next = move |state: ode::State| {
            let direction = force_at_rest(model, region, state.t, state.x).signum();
            // The acceleration is still zero: without a sign of its own the velocity would be anybody's.
            let v = NUDGE * direction * sign;
            match pushed_into(model, region, state.x, direction) {
                Some(contact) => (
                    index(
                        Place {
                            region: contact,
                            direction,
                        },
                        false,
                    ),
                    ode::State {
                        x: 0.0,
                        v: NUDGE,
                        ..state
                    },
                ),
                None => (index(Place { region, direction }, false), ode::State { v, ..state }),
            }
        };
        events.push((Event::switch(excess, next).rising(), Meaning::LetGo));
        let (events, meanings) = events.into_iter().unzip();
        return (Phase::new(|_, _, _| 0.0, events), meanings);
    }
    match region {
        State::Free | State::Stuck => {
            for side in [Side::Left, Side::Right] {
                if let Some(barrier) = model.barrier(side) {
                    let next = move |state: ode::State| {
                        // It moves inwards, whatever rounding says of one that rests there.
                        let speed = (side.sign() * state.v).max(0.0);
                        (
                            to(State::Contact(side)),
                            ode::State {
                                x: 0.0,
                                v: speed,
                                ..state
                            },
                        )
                    };
                    let depth = move |_: f64, x: f64, _: f64| side.sign() * (x - barrier);
                    events.push((Event::switch(depth, next).rising(), Meaning::Touch(side)));
                }
            }
        }
        State::Contact(side) | State::Detached(side) => {
            let next = move |state: ode::State| {
                (
                    to(State::Free),
                    ode::State {
                        x: origin,
                        v: sign * state.v.min(0.0),
                        ..state
                    },
                )
            };
            events.push((Event::switch(|_, d, _| d, next).falling(), Meaning::Release));
            if model.mu > 0.0 {
                let push = move |_: f64, _: f64, speed: f64| model.gamma + model.mu * speed;
                if matches!(region, State::Contact(_)) {
                    let next = move |state: ode::State| (to(State::Detached(side)), state);
                    events.push((Event::switch(push, next).falling(), Meaning::Detach));
                } else {
                    let next = move |state: ode::State| (to(State::Contact(side)), state);
                    events.push((Event::switch(push, next).rising(), Meaning::Reattach));
                }
            }
        }
    }
    if direction == 0.0 {
        events.push((Event::record(|_, _, v| v), Meaning::Turn));
    } else {
        let next = move |state: ode::State| {
            let state = ode::State { v: 0.0, ..state };
            (from_rest(model, region, state.t, state.x), state)
        };
        let turn = Event::switch(move |_, _, v| v, next);
        let turn = if direction * sign > 0.0 {
            turn.falling()
        } else {
            turn.rising()
        };
        events.push((turn, Meaning::Turn));
    }
    if let Some(calm) = options.rest_energy {
        let energy = move |_: f64, value: f64, v: f64| {
            let stored = if matches!(region, State::Contact(_)) {
                model.elastic_energy(value)
            } else {
                0.0
            };
            model.swing_energy(coordinate.x(value), v) + stored - calm
        };
        events.push((Event::stop(energy).falling(), Meaning::Calm));
    }
    let acceleration = move |t: f64, value: f64, v: f64| {
        let free = model.field(t, coordinate.x(value)) + model.damping(sign * v, direction);
        let contact = match region {
            State::Contact(_) => model.contact(value, v),
            _ => 0.0,
        };
        sign * free - contact
    };
    let (events, meanings) = events.into_iter().unzip();
    (Phase::new(acceleration, events), meanings)
}

/// The motion by Runge-Kutta.
pub(in crate::impact) fn follow(
    model: &Model,
    start: Start,
    options: &Options,
) -> Result<Simulation, IntegrationError> {
    let options = &scaled(options, model, start);
    let (phases, meanings): (Vec<_>, Vec<_>) = (0..REGIONS.len() * MOTIONS)
        .map(|number| phase(model, options, number))
        .unzip();
    let region = beginning(model, start);
    let Coordinate { sign, origin } = Coordinate::of(model, region);
    let first = match start.velocity {
        _ if !model.sticks() => index(Place { region, direction: 0.0 }, false),
        0.0 => from_rest(model, region, 0.0, sign * (start.x - origin)),
        velocity => {
            let direction = velocity.signum();
            index(Place { region, direction }, false)
        }
    };
    // What lets go of a stuck pendulum varies with the excitation, not with the motion.
    let watched = model.sticks() && model.beta != 0.0 && model.frequency_ratio > 0.0;
    let maximum_step = if watched {
        1.0 / model.frequency_ratio
    } else {
        f64::INFINITY
    };
    let settings = ode::Options {
        relative_tolerance: options.relative_tolerance,
        absolute_tolerance: options.absolute_tolerance,
        maximum_steps: options.maximum_steps,
        maximum_step,
        stiff: false,
        interrupt: options.interrupt,
    };
    let begin = ode::State {
        t: 0.0,
        x: match place(first).0.region {
            State::Free => start.x,
            first => {
                let Coordinate { sign, origin } = Coordinate::of(model, first);
                sign * (start.x - origin)
            }
        },
        v: sign * start.velocity,
    };
    let trajectory = integrate_phases(&phases, first, begin, options.duration, &settings)?;
    Ok(told(
        model,
        start,
        options,
        trajectory,
        (place(first).0.region, &meanings),
    ))
}

/// The run in the words of a simulation.
fn told(
    model: &Model,
    start: Start,
    options: &Options,
    trajectory: Trajectory,
    (first, meanings): (State, &[Vec<Meaning>]),
) -> Simulation {
    let mut impacts: Vec<Contact> = Vec::new();
    if let State::Contact(side) | State::Detached(side) = first {
        let depth = model.depth(start.x).map_or(0.0, |(_, depth)| depth);
        enter(
            &mut impacts,
            (model, options),
            side,
            0.0,
            [depth, side.sign() * start.velocity],
        );
    }
    let mut turns = Vec::new();
    if start.velocity == 0.0 {
        turns.push(Turn { t: 0.0, x: start.x });
    }
    for Occurrence {
        phase, event, state, ..
    } in trajectory.occurrences().iter().copied()
    {
        let coordinate = Coordinate::of(model, place(phase).0.region);
        match meanings.get(phase).and_then(|list| list.get(event)) {
            Some(&Meaning::Touch(side)) => {
                let speed = (side.sign() * state.v).max(0.0);
                enter(&mut impacts, (model, options), side, state.t, [0.0, speed]);
            }
            Some(Meaning::Release) => {
                if let Some(impact) = impacts.last_mut() {
                    impact.released(model, state.t, (-state.v).max(0.0));
                }
            }
            Some(meaning @ (Meaning::Turn | Meaning::LetGo)) => {
                let region = place(phase).0.region;
                let direction = force_at_rest(model, region, state.t, state.x).signum();
                if let Meaning::LetGo = meaning
                    && let Some(State::Contact(side)) = pushed_into(model, region, state.x, direction)
                {
                    enter(&mut impacts, (model, options), side, state.t, [0.0, 0.0]);
                }
                turns.push(Turn {
                    t: state.t,
                    x: coordinate.x(state.x),
                });
                if matches!(place(phase).0.region, State::Contact(_))
                    && let Some(impact) = impacts.last_mut()
                {
                    impact.penetration = impact.penetration.max(state.x);
                }
            }
            _ => {}
        }
    }
    let stop = match trajectory.stop_reason() {
        StopReason::EndReached => Stop::Duration,
        StopReason::Event { .. } => Stop::Calm,
        StopReason::NonFinite { time } => Stop::NotFinite { t: time },
        StopReason::MaximumSteps { time } => Stop::Steps { t: time },
        StopReason::Interrupted { time } => Stop::Interrupted { t: time },
        StopReason::StepTooSmall { time } => Stop::StepTooSmall { t: time },
        StopReason::SwitchingStalled { time } => Stop::Stalled { t: time },
    };
    let knots: Vec<f64> = trajectory.knots().map(|knot| knot.t).collect();
    let last_phase = knots
        .windows(2)
        .rev()
        .find_map(|pair| trajectory.phase_at(0.5 * (pair[0] + pair[1])))
        .unwrap_or(0);
    let end = trajectory.end();
    let coordinate = Coordinate::of(model, place(last_phase).0.region);
    let steps = trajectory.step_count();
    // An event that switches leaves the end in the coordinate it switched to only if a step followed.
    let (end_x, end_velocity) = (coordinate.x(end.x), coordinate.sign * end.v);
    let mut path = Path::judged(trajectory);
    if options.keep_path {
        for pair in knots.windows(2) {
            let [from, to] = [pair[0], pair[1]];
            let phase = path.judged_phase(0.5 * (from + to)).unwrap_or(0);
            let (Place { region, .. }, stuck) = place(phase);
            let origin = Coordinate::of(model, region);
            let state = if stuck { State::Stuck } else { region };
            path.push_judged([from, to], state, [origin.origin, origin.sign]);
        }
    }
    Simulation {
        model: *model,
        start,
        options: *options,
        integrator: Integrator::RungeKutta,
        path,
        impacts,
        turns,
        end_time: end.t,
        end_x,
        end_velocity,
        stop,
        steps,
    }
}
