//! Starts on a barrier, inside one, held by friction there: against an integrator of this file's
//! own, fourth-order Runge-Kutta in small equal steps with every event by bisection, which shares
//! nothing with the library.

use lindstedt::impact::{
    Friction, Integrator, Model, Settings, Side, Simulation, SimulationStop, Start, simulate,
};

/// A contact: from when to when.
type Span = (f64, Option<f64>);

/// What the small steps say.
struct Truth {
    contacts: Vec<Span>,
    x: f64,
    velocity: f64,
}

/// t, x, x'.
type Point = (f64, f64, f64);

/// How deep inside a barrier, and its side as a sign; negative outside.
fn depth(model: &Model, x: f64) -> (f64, f64) {
    let right = model.right.map_or(f64::NEG_INFINITY, |barrier| x - barrier);
    let left = model.left.map_or(f64::NEG_INFINITY, |barrier| barrier - x);
    if left > right { (left, -1.0) } else { (right, 1.0) }
}

/// All forces of equation (7) but Coulomb's.
fn force(model: &Model, (t, x, v): Point) -> f64 {
    let drive = model.beta * (model.frequency_ratio * t).sin() * x.cos();
    let creeping = match model.friction {
        Friction::Arctangent => model.alpha * 2.0 / std::f64::consts::PI * (100.0 * v).atan(),
        Friction::Exact => 0.0,
    };
    let (depth, sign) = depth(model, x);
    let contact = if depth > 0.0 {
        sign * (model.gamma + model.mu * sign * v).max(0.0) * depth.powf(1.5)
    } else {
        0.0
    };
    drive - x.sin() - 2.0 * model.zeta * v - creeping - contact
}

fn step(model: &Model, (t, x, v): Point, dry: f64, h: f64) -> Point {
    let slope = |at: Point| (at.2, force(model, at) - dry);
    let (x1, v1) = slope((t, x, v));
    let (x2, v2) = slope((t + 0.5 * h, x + 0.5 * h * x1, v + 0.5 * h * v1));
    let (x3, v3) = slope((t + 0.5 * h, x + 0.5 * h * x2, v + 0.5 * h * v2));
    let (x4, v4) = slope((t + h, x + h * x3, v + h * v3));
    (
        t + h,
        x + h / 6.0 * (x1 + 2.0 * x2 + 2.0 * x3 + x4),
        v + h / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4),
    )
}

/// The part of a step at which the condition becomes true.
fn bisected(h: f64, holds: impl Fn(f64) -> bool) -> f64 {
    let (mut before, mut after) = (0.0, h);
    for _ in 0..60 {
        let middle = 0.5 * (before + after);
        if holds(middle) {
            after = middle;
        } else {
            before = middle;
        }
    }
    after
}

fn truth(model: &Model, start: Start, duration: f64, h: f64) -> Truth {
    let coulomb = model.friction == Friction::Exact && model.alpha > 0.0;
    let mut now = (0.0, start.x, start.velocity);
    let mut contacts: Vec<Span> = Vec::new();
    let mut inside = depth(model, start.x).0 > 0.0;
    if inside {
        contacts.push((0.0, None));
    }
    // Where friction acts: 1 or -1, 0 while it holds.
    let mut direction = if start.velocity == 0.0 {
        let push = force(model, now);
        if push.abs() > model.alpha { push.signum() } else { 0.0 }
    } else {
        start.velocity.signum()
    };
    while now.0 < duration {
        let mut length = h.min(duration - now.0);
        if coulomb && direction == 0.0 {
            let push = |part: f64| force(model, (now.0 + part, now.1, 0.0));
            if push(length).abs() > model.alpha {
                length = bisected(length, |part| push(part).abs() > model.alpha);
                direction = push(length).signum();
            }
            now.0 += length;
            continue;
        }
        let dry = if coulomb { model.alpha * direction } else { 0.0 };
        let mut next = step(model, now, dry, length);
        let turned = coulomb && direction * next.2 < 0.0;
        if turned {
            length = bisected(length, |part| direction * step(model, now, dry, part).2 < 0.0);
            next = step(model, now, dry, length);
            next.2 = 0.0;
            let push = force(model, next);
            direction = if push.abs() > model.alpha { push.signum() } else { 0.0 };
        }
        let entered = depth(model, next.1).0 > 0.0;
        if entered != inside {
            let at_rest = depth(model, now.1).0 == 0.0 && now.2 == 0.0;
            let part = bisected(length, |part| {
                (depth(model, step(model, now, dry, part).1).0 > 0.0) == entered
            });
            let time = if at_rest { now.0 } else { now.0 + part };
            match contacts.last_mut() {
                Some(last) if !entered => last.1 = Some(time),
                _ => contacts.push((time, None)),
            }
            inside = entered;
        }
        now = next;
    }
    Truth { contacts, x: now.1, velocity: now.2 }
}

fn followed(model: &Model, start: Start, duration: f64, integrator: Integrator) -> Simulation {
    let options = Settings { duration, ..Settings::default() };
    simulate(model, start, integrator, &options).expect("a motion")
}

/// Both integrators against the small steps: the same contacts at the same times, the same end.
fn agrees(name: &str, model: &Model, start: Start, duration: f64, allowed: f64) {
    let truth = truth(model, start, duration, 2e-5);
    for integrator in [Integrator::Taylor, Integrator::RungeKutta] {
        let motion = followed(model, start, duration, integrator);
        assert_eq!(
            motion.stop,
            SimulationStop::Duration,
            "{name}, {integrator:?}: {}",
            motion.stop
        );
        let found: Vec<Span> =
            motion.impacts.iter().map(|impact| (impact.entry_time, impact.exit_time)).collect();
        assert_eq!(
            found.len(),
            truth.contacts.len(),
            "{name}, {integrator:?}: {found:?} against {:?}",
            truth.contacts
        );
        let near = |one: f64, other: f64| (one - other).abs() < allowed;
        for (found, expected) in found.iter().zip(&truth.contacts) {
            let ends = match (found.1, expected.1) {
                (Some(one), Some(other)) => near(one, other),
                (None, None) => true,
                _ => false,
            };
            assert!(
                near(found.0, expected.0) && ends,
                "{name}, {integrator:?}: {found:?} against {expected:?}"
            );
        }
        assert!(
            near(motion.end_x, truth.x) && near(motion.end_velocity, truth.velocity),
            "{name}, {integrator:?}: {} {} against {} {}",
            motion.end_x,
            motion.end_velocity,
            truth.x,
            truth.velocity
        );
        let residual = motion.energy().residual;
        assert!(residual < 1e-8, "{name}, {integrator:?}: energy residual {residual}");
    }
}

/// Hangs at rest on a barrier and is shaken.
fn shaken(alpha: f64, beta: f64) -> Model {
    Model {
        zeta: 0.02,
        alpha,
        beta,
        frequency_ratio: 0.9,
        gamma: 1e4,
        mu: 1e3,
        right: Some(0.0),
        ..Model::default()
    }
}

#[test]
fn at_rest_on_a_barrier_it_goes_where_the_force_goes() {
    let rest = Start { x: 0.0, velocity: 0.0 };
    // The force is zero at first and grows with time: into the barrier, or away from it.
    agrees("pushed in", &shaken(0.0, 0.3), rest, 30.0, 1e-6);
    agrees("pulled away", &shaken(0.0, -0.3), rest, 30.0, 1e-6);
    // Held at first, and let go by friction into the barrier, or away from it.
    agrees("let go into it", &shaken(0.1, 0.3), rest, 30.0, 1e-6);
    agrees("let go away from it", &shaken(0.1, -0.3), rest, 30.0, 1e-6);
    let creeping = Model { friction: Friction::Arctangent, ..shaken(0.1, 0.3) };
    agrees("creeping", &creeping, rest, 30.0, 1e-6);
    // Gravity presses from the first moment on; nothing but the damping of the barrier takes
    // energy.
    let pressed = Model { gamma: 1e4, mu: 1e3, right: Some(-0.3), ..Model::default() };
    let on_it = Start { x: -0.3, velocity: 0.0 };
    agrees("pressed", &pressed, on_it, 10.0, 1e-6);
    let mirrored = Model { left: Some(0.3), right: None, ..pressed };
    agrees("pressed from the right", &mirrored, Start { x: 0.3, ..on_it }, 10.0, 1e-6);
    let falling = Model { right: Some(0.3), ..pressed };
    agrees("falls away", &falling, Start { x: 0.3, ..on_it }, 10.0, 1e-6);
}

#[test]
fn pressed_into_an_elastic_barrier_at_rest_it_never_leaves() {
    // It comes back to the barrier without speed again and again: one contact that lasts.
    for (gamma, barrier) in [(1e3, -0.3), (3.0407e7, -0.3), (1e5, -1.2)] {
        let model = Model { gamma, right: Some(barrier), ..Model::default() };
        let start = Start { x: barrier, velocity: 0.0 };
        for integrator in [Integrator::Taylor, Integrator::RungeKutta] {
            let motion = followed(&model, start, 3.0, integrator);
            assert_eq!(motion.stop, SimulationStop::Duration, "{gamma}, {integrator:?}");
            assert_eq!(motion.impacts.len(), 1, "{gamma}, {integrator:?}");
            let impact = motion.impacts[0];
            assert!(
                impact.exit_time.is_none() && impact.entry_time == 0.0 && impact.speed_in == 0.0
            );
            // The deepest place is the one where the energy is that of the start: 2/5 gamma d^(5/2)
            // = cos(x) - cos(xc).
            let depth = impact.penetration;
            let gained = 2.0 * (0.5 * depth).sin() * -(barrier + 0.5 * depth).sin();
            assert!(
                (0.4 * gamma * depth.powf(2.5) / gained - 1.0).abs() < 1e-6,
                "{gamma}, {integrator:?}: {depth}"
            );
        }
    }
}

#[test]
fn a_start_inside_the_contact_begins_with_what_the_barrier_stores() {
    let model = Model { zeta: 0.01, gamma: 1e4, mu: 1e3, right: Some(0.2), ..Model::default() };
    let inside = |x: f64, velocity: f64| Start { x, velocity };
    agrees("at rest", &model, inside(0.22, 0.0), 10.0, 1e-6);
    agrees("inwards", &model, inside(0.21, 0.5), 10.0, 1e-6);
    agrees("outwards", &model, inside(0.21, -0.5), 10.0, 1e-6);
    // Faster than the barrier comes back: gamma + mu v < 0.
    agrees("detached", &model, inside(0.22, -12.0), 4.0, 1e-6);
    let left = Model { left: Some(-0.2), right: Some(0.9), ..model };
    agrees("on the left", &left, inside(-0.215, -0.3), 10.0, 1e-6);
    let rough = Model { alpha: 0.1, ..model };
    agrees("with friction", &rough, inside(0.22, 0.0), 10.0, 1e-6);
    agrees("and speed", &rough, inside(0.21, 0.4), 10.0, 1e-6);
    // gamma d^(3/2) + sin x stays below alpha: it is held where it is.
    agrees("held", &Model { alpha: 0.5, ..model }, inside(0.201, 0.0), 5.0, 1e-9);
    let driven = Model { alpha: 0.25, beta: 0.6, frequency_ratio: 1.3, ..model };
    agrees("held, then let go", &driven, inside(0.2001, 0.0), 10.0, 1e-6);
    let creeping = Model { friction: Friction::Arctangent, ..rough };
    agrees("creeping", &creeping, inside(0.22, 0.0), 10.0, 1e-6);

    // Without damping nothing is lost: it leaves with all that was stored, and there was no touch
    // to compare with.
    let elastic = Model { zeta: 0.0, mu: 0.0, ..model };
    for integrator in [Integrator::Taylor, Integrator::RungeKutta] {
        let motion = followed(&elastic, inside(0.22, 0.0), 0.3, integrator);
        let impact = motion.impacts[0];
        let stored = 0.4 * 1e4 * 0.02_f64.powf(2.5) + 0.2_f64.cos() - 0.22_f64.cos();
        assert!((impact.speed_out.expect("it leaves") - (2.0 * stored).sqrt()).abs() < 1e-10);
        assert!(impact.energy_lost.is_some_and(|lost| lost.abs() < 1e-10));
        assert_eq!((impact.side, impact.restitution), (Side::Right, None));
        assert!((impact.penetration - 0.02).abs() < 1e-15);
    }
}

#[test]
fn at_a_barrier_near_plumb_a_dying_motion_goes_on_to_the_end() {
    // Where the barrier stands at the place of rest a touch becomes ever slower and longer: steps
    // must grow with it.
    for barrier in [0.0, 1e-12, -1e-12, 1e-15, -1e-14] {
        let model =
            Model { zeta: 0.1, gamma: 1e5, mu: 1e4, right: Some(barrier), ..Model::default() };
        let start = Start { x: -1.0, velocity: 0.0 };
        for duration in [500.0, 2e4] {
            let motion = followed(&model, start, duration, Integrator::Taylor);
            assert_eq!(
                motion.stop,
                SimulationStop::Duration,
                "{barrier}, {duration}: {}",
                motion.stop
            );
            assert!(motion.steps < 20_000, "{barrier}, {duration}: {} steps", motion.steps);
            assert!(motion.end_x.abs() < 1e-11 && motion.end_velocity.abs() < 1e-11);
        }
        agrees("near plumb", &model, start, 25.0, 1e-6);
    }
}

#[test]
fn a_tiny_motion_is_followed_as_closely_as_a_large_one() {
    // Near plumb the swing is linear, and d^(3/2) takes another gamma to another size: the motion
    // of size s with gamma is that of size 1 with gamma sqrt(s), for sin x = x.
    let times = |size: f64, integrator: Integrator| {
        let model = Model {
            zeta: 0.02,
            gamma: 1e2 / size.sqrt(),
            mu: 1e2 / size.sqrt() / size,
            right: Some(0.3 * size),
            ..Model::default()
        };
        let start = Start { x: -size, velocity: 0.0 };
        let motion = followed(&model, start, 20.0, integrator);
        assert!(motion.energy().residual < 1e-8, "{size}: {}", motion.energy().residual);
        let spans = motion
            .impacts
            .iter()
            .map(|impact| [impact.entry_time, impact.exit_time.unwrap_or(20.0)]);
        spans.flatten().collect::<Vec<f64>>()
    };
    for integrator in [Integrator::Taylor, Integrator::RungeKutta] {
        let reference = times(1e-6, integrator);
        assert!(reference.len() > 6);
        for size in [1e-8, 1e-12, 1e-20, 1e-60] {
            let found = times(size, integrator);
            assert_eq!(found.len(), reference.len(), "{size}, {integrator:?}");
            for (one, other) in found.iter().zip(&reference) {
                assert!(
                    (one - other).abs() < 1e-8,
                    "{size}, {integrator:?}: {one} against {other}"
                );
            }
        }
    }
}
