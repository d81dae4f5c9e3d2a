//! The main mass with its damper held against independent formulations: limits in closed form,
//! equations written by hand and followed by Runge-Kutta, momentum and energy over every impact.

use std::collections::BTreeMap;

use lindstedt::Symbol;
use lindstedt::expr::{Expr, parse_expression};
use lindstedt::impact::primary::{
    Primary, PrimaryCase, PrimaryError, PrimaryMotion, PrimaryParameter, PrimarySettings,
    PrimaryState, PrimaryStop, simulate_primary, sweep_primary,
};
use lindstedt::impact::{Friction, Integrator, Model, Settings, Start, simulate};
use lindstedt::problem::Problem;
use lindstedt::system::{Event, Integrator as Route, Path, System, SystemOptions};

fn settings(duration: f64) -> PrimarySettings {
    PrimarySettings { duration, ..PrimarySettings::default() }
}

fn follow(case: PrimaryCase, duration: f64) -> PrimaryMotion {
    let motion = simulate_primary(case, &settings(duration)).expect("a motion");
    assert!(motion.is_complete(), "{:?} at {}", motion.stop, motion.end);
    assert!(motion.energy.residual < 1e-9, "{:?}", motion.energy);
    motion
}

const FREE: Model = Model {
    zeta: 0.0,
    alpha: 0.0,
    friction: Friction::Exact,
    beta: 0.0,
    frequency_ratio: 0.0,
    gamma: 1e5,
    mu: 0.0,
    left: None,
    right: None,
};

const MASS: Primary =
    Primary { mass: 20.0, stiffness: 45.0, damping: 0.0, force: 0.0, frequency: 0.0 };

/// A main mass that hardly moves: the pendulum is that of equation (7), impact for impact.
#[test]
fn a_heavy_main_mass_leaves_the_pendulum_alone() {
    let primary = Primary { mass: 1e13, stiffness: 1e13, ..MASS };
    for model in [
        Model { right: Some(0.323), mu: 1e4, zeta: 0.02, ..FREE },
        Model { right: Some(0.2), left: Some(-0.4), zeta: 0.01, ..FREE },
        Model { right: Some(0.323), alpha: 0.03, ..FREE },
        Model { right: Some(0.323), alpha: 0.03, friction: Friction::Arctangent, ..FREE },
    ] {
        let start = Start {
            x: if model.left.is_some() { 0.0 } else { -1.5 },
            velocity: if model.left.is_some() { 1.1 } else { 0.0 },
        };
        let truth = simulate(
            &model,
            start,
            Integrator::Taylor,
            &Settings { duration: 40.0, ..Settings::default() },
        )
        .expect("a motion");
        let motion = follow(
            PrimaryCase { primary, model, start: [start.x, start.velocity, 0.0, 0.0] },
            40.0,
        );
        assert_eq!(motion.impacts.len(), truth.impacts.len(), "{model:?}");
        for (own, truth) in motion.impacts.iter().zip(&truth.impacts) {
            assert!((own.entry_time - truth.entry_time).abs() < 1e-7, "{own:?} {truth:?}");
            assert!((own.speed_in - truth.speed_in).abs() < 1e-7, "{own:?} {truth:?}");
        }
        for index in 0..=400 {
            let t = 0.1 * f64::from(index);
            let (x, _) = truth.path.phase_point_at(t).expect("a state");
            let own = motion.state_at(t).expect("a state").x;
            assert!((own - x).abs() < 1e-6, "{model:?} at {t}: {own} {x}");
        }
    }
}

/// Without contact small swings are linear: two modes, from the quadratic (kappa - (R + 1) s)(1 -
/// s) = s^2.
#[test]
fn without_contact_it_is_the_linear_system_of_two_modes() {
    let (r, kappa) = (MASS.mass, MASS.stiffness);
    let (half, rest) = ((kappa + r + 1.0) / (2.0 * r), kappa / r);
    let root = (half * half - rest).sqrt();
    let squares = [half - root, half + root];
    // In a mode y = q x with -s x - s q x + x = 0.
    let shapes = squares.map(|s| (1.0 - s) / s);
    let size = 1e-6;
    // Released with x = 0, y = size: parts p1 + p2 = 0 in x and q1 p1 + q2 p2 = size in y.
    let part = size / (shapes[0] - shapes[1]);
    let motion =
        follow(PrimaryCase { primary: MASS, model: FREE, start: [0.0, 0.0, size, 0.0] }, 100.0);
    for index in 0..=500 {
        let t = 0.2 * f64::from(index);
        let waves = squares.map(|s| (s.sqrt() * t).cos());
        let x = part * (waves[0] - waves[1]);
        let y = part * (shapes[0] * waves[0] - shapes[1] * waves[1]);
        let state = motion.state_at(t).expect("a state");
        assert!((state.x - x).abs() < 1e-9 * size.max(1e-3 * size) + 1e-15, "{t}: {} {x}", state.x);
        assert!((state.y - y).abs() < 1e-9 * size, "{t}: {} {y}", state.y);
    }
    // With the pendulum held by friction, and without the pendulum's say: in closed form.
    let damped = Primary { damping: 0.8, ..MASS };
    let held = Model { alpha: 1e3, ..FREE };
    let motion =
        follow(PrimaryCase { primary: damped, model: held, start: [0.0, 0.0, 0.5, 0.2] }, 60.0);
    for index in 0..=300 {
        let t = 0.2 * f64::from(index);
        let state = motion.state_at(t).expect("a state");
        assert!((state.y - damped.alone_at(damped.mass + 1.0, [0.5, 0.2], t)).abs() < 1e-11, "{t}");
        assert_eq!(state.x, 0.0);
    }
    let rest =
        follow(PrimaryCase { primary: damped, model: held, start: [0.0, 0.0, 0.5, 0.0] }, 200.0)
            .rest_time();
    let locked = damped.undamped_and_locked().locked.rest_time.expect("a rest time");
    assert!((rest.expect("a rest time") / locked - 1.0).abs() < 1e-9);
}

/// The contact is inside: over an impact the momentum of both changes by spring, dashpot and force
/// alone, the energy by what the contact takes; integrated along the path, not read from the
/// equations.
#[test]
fn momentum_and_energy_balance_over_every_impact() {
    let primary = Primary { damping: 0.5, force: 0.4, frequency: 1.4, ..MASS };
    let model = Model { mu: 3e4, left: Some(-0.3), right: Some(0.25), ..FREE };
    let case = PrimaryCase { primary, model, start: [0.0, 0.0, 0.6, 0.0] };
    let motion = follow(case, 60.0);
    assert!(motion.impacts.len() > 20);
    for impact in &motion.impacts {
        let Some(exit) = impact.exit_time else { continue };
        let at = |t: f64| motion.state_at(t).expect("a state");
        let momentum = |t: f64| {
            let state = at(t);
            (primary.mass + 1.0) * state.speed + state.velocity * state.x.cos()
        };
        // Simpson over the contact: force of spring, dashpot and excitation; power of the last two.
        const PARTS: u32 = 400;
        let (mut push, mut work) = (0.0, 0.0);
        let width = (exit - impact.entry_time) / f64::from(PARTS);
        for part in 0..=PARTS {
            let t = impact.entry_time + width * f64::from(part);
            let state = at(t);
            let weight = match part {
                0 | PARTS => 1.0,
                part if part % 2 == 1 => 4.0,
                _ => 2.0,
            } * width
                / 3.0;
            let drive = primary.force * (primary.frequency * t).sin();
            push += weight * (drive - primary.stiffness * state.y - primary.damping * state.speed);
            work += weight * (drive * state.speed - primary.damping * state.speed * state.speed);
        }
        let change = momentum(exit) - momentum(impact.entry_time);
        assert!((change - push).abs() < 1e-9, "{impact:?}: {change} {push}");
        let energy = case.energy(at(exit)) - case.energy(at(impact.entry_time));
        assert!((energy - work + impact.energy_lost).abs() < 1e-9, "{impact:?}: {energy} {work}");
        assert!(impact.speed_out.expect("a release") < impact.speed_in && impact.energy_lost > 0.0);
    }
}

/// Where the pendulum is inside of a barrier there is an impact, and nowhere else.
#[test]
fn no_impact_is_missed() {
    let model = Model { zeta: 0.005, mu: 2e4, left: Some(-0.31), right: Some(0.2), ..FREE };
    for start in [[0.0, 0.0, 0.4, 0.0], [0.1, 0.3, -0.2, 1.0], [0.0, 0.0, 0.05, 0.0]] {
        let motion = follow(PrimaryCase { primary: MASS, model, start }, 80.0);
        let mut inside = 0;
        for index in 0..=80_000 {
            let t = 1e-3 * f64::from(index);
            let state = motion.state_at(t).expect("a state");
            let deep = model.depth(state.x).is_some_and(|(_, depth)| depth > 1e-12);
            let within = motion
                .impacts
                .iter()
                .any(|impact| (impact.entry_time..=impact.exit_time.unwrap_or(80.0)).contains(&t));
            assert!(!deep || within, "{start:?} at {t}: {state:?}");
            inside += usize::from(deep);
        }
        assert!(inside > 0 || start[2] < 0.1);
    }
}

/// The motion by equations that are solved by hand, q + p cos x = g and (R + 1) p + q cos x = h,
/// with a barrier at `place`, followed by Runge-Kutta; every passage of the barrier is listed.
fn by_hand(primary: Primary, model: Model, place: f64, start: [f64; 4], until: f64) -> Path {
    let g = "(-sin(x) - 2*zeta*v - (gamma + mu*v)*((x - c)^2)^(3/4)*H(x - c))";
    let h = "(v^2*sin(x) - delta*u - kappa*y + f*sin(eta*t))";
    let p = format!("(({h} - {g}*cos(x))/(R + sin(x)^2))");
    let read = |text: &str| -> Expr { parse_expression(text).expect("an expression") };
    let right = [read("v"), read(&format!("{g} - {p}*cos(x)")), read("u"), read(&p)];
    let numbers: BTreeMap<Symbol, f64> = [
        ("R", primary.mass),
        ("kappa", primary.stiffness),
        ("delta", primary.damping),
        ("f", primary.force),
        ("eta", primary.frequency),
        ("gamma", model.gamma),
        ("mu", model.mu),
        ("zeta", model.zeta),
        ("c", place),
    ]
    .map(|(name, value)| (Symbol::new(name), value))
    .into();
    let states = ["x", "v", "y", "u"].map(Symbol::new);
    let system = System::new(&states, "t".into(), &right, &numbers).expect("a system");
    let options = SystemOptions {
        integrator: Route::RungeKutta,
        tolerance: 1e-12,
        ..SystemOptions::default()
    };
    let passages = [Event::record(read("x - c"))];
    system.solve([0.0, until], &start, &passages, &options).expect("a path")
}

/// The accelerations solved by hand, the contact as |d|^(3/2) behind its step, followed by
/// Runge-Kutta in the time itself.
#[test]
fn equations_written_by_hand_agree() {
    let model = Model { gamma: 2e3, mu: 40.0, zeta: 0.002, right: Some(0.3), ..FREE };
    let primary = Primary { damping: 0.3, force: 0.2, frequency: 0.9, ..MASS };
    let start = [-0.8, 0.0, 0.1, 0.0];
    let motion = follow(PrimaryCase { primary, model, start }, 25.0);
    assert!(motion.impacts.len() >= 3, "{}", motion.impacts.len());
    let path = by_hand(primary, model, 0.3, start, 25.0);
    assert_eq!(path.occurrences().len(), 2 * motion.impacts.len());
    for index in 0..=250 {
        let t = 0.1 * f64::from(index);
        let (own, other) =
            (motion.state_at(t).expect("a state"), path.states_at(t).expect("a state"));
        for (own, other) in [own.x, own.velocity, own.y, own.speed].iter().zip(other) {
            assert!((own - other).abs() < 1e-7, "{t}: {own} {other}");
        }
    }
}

/// Driven with the damper held, the long run is the resonance curve of the locked mass.
#[test]
fn the_long_run_of_a_locked_damper_is_the_resonance_curve() {
    let primary = Primary { damping: 4.0, force: 0.5, frequency: 1.0, ..MASS };
    let case = PrimaryCase { primary, model: Model { alpha: 1e3, ..FREE }, start: [0.0; 4] };
    let motions = [0.5, 1.2, 1.4, 2.5].map(|frequency| {
        let primary = Primary { frequency, ..primary };
        (PrimaryCase { primary, ..case }, settings(300.0))
    });
    let rows = sweep_primary(&motions, |_| ()).expect("rows");
    for row in &rows {
        let exact = row.others.locked.amplitude.expect("an amplitude");
        assert!((row.amplitude / exact - 1.0).abs() < 1e-9, "{row:?}");
        assert!(row.stop == PrimaryStop::Duration && row.impacts == 0);
    }
    // One thread or all: the same.
    let one = simulate_primary(
        PrimaryCase { primary: Primary { frequency: 1.2, ..primary }, ..case },
        &settings(300.0),
    )
    .expect("a motion");
    assert_eq!(one.largest_since(225.0), rows[1].amplitude);
}

/// A damper with losses brings the main mass to rest sooner than without, and where nothing takes
/// energy nothing rests.
#[test]
fn what_the_damper_is_worth() {
    let primary = Primary { damping: 0.4, ..MASS };
    let caged =
        Model { gamma: 1e6, mu: 5e5, zeta: 0.01, left: Some(-0.3), right: Some(0.3), ..FREE };
    let start = [0.0, 0.0, 0.5, 0.0];
    let with = follow(PrimaryCase { primary, model: caged, start }, 400.0)
        .rest_time()
        .expect("a rest time");
    let others = primary.undamped_and_locked();
    assert!(
        with < others.locked.rest_time.expect("a rest time")
            && with < others.without.rest_time.expect("a rest time")
    );
    let lossless = follow(
        PrimaryCase { primary: MASS, model: Model { mu: 0.0, zeta: 0.0, ..caged }, start },
        100.0,
    );
    assert!(lossless.rest_time().is_err());
    assert_eq!(MASS.undamped_and_locked().without.rest_time, None);
    assert!((lossless.energy.end / lossless.energy.start - 1.0).abs() < 1e-9);
}

#[test]
fn what_cannot_be_followed_is_said() {
    let case = PrimaryCase { primary: MASS, model: FREE, start: [0.0, 0.0, 0.1, 0.0] };
    let refused =
        |case: PrimaryCase| simulate_primary(case, &settings(1.0)).expect_err("a refusal");
    for (primary, word) in [
        (Primary { mass: 0.0, ..MASS }, "mass"),
        (Primary { stiffness: -1.0, ..MASS }, "stiffness"),
        (Primary { damping: f64::NAN, ..MASS }, "damping"),
        (Primary { force: f64::INFINITY, ..MASS }, "force"),
    ] {
        let message = refused(PrimaryCase { primary, ..case }).to_string();
        assert!(message.contains(word), "{message}");
    }
    let driven = Model { beta: 0.1, frequency_ratio: 1.0, ..FREE };
    assert_eq!(refused(PrimaryCase { model: driven, ..case }), PrimaryError::Driven);
    let wall = Model { right: Some(0.1), ..FREE };
    assert!(matches!(simulate_primary(case, &settings(-1.0)), Err(PrimaryError::Duration(_))));
    let few = PrimarySettings { phase_limit: 3, ..settings(100.0) };
    let short =
        simulate_primary(PrimaryCase { model: wall, start: [0.0, 0.0, 0.8, 0.0], ..case }, &few)
            .expect("a part");
    assert_eq!(short.stop, PrimaryStop::PhaseLimit);
}

/// From rest or with speed on a barrier's surface, and pressed against it: by hand and Runge-Kutta,
/// as above.
#[test]
fn a_start_on_a_barrier_is_a_start_in_contact() {
    let primary = Primary { mass: 5.0, stiffness: 10.0, damping: 0.1, ..MASS };
    for (place, start) in [
        (0.0, [0.0, 0.0, 0.2, 0.0]),
        (0.0, [0.0, 0.0, -0.2, 0.0]),
        (0.2, [0.2, 0.5, 0.0, 0.0]),
        (-0.2, [-0.2, 0.0, 0.1, 0.0]),
    ] {
        let model = Model { gamma: 2000.0, mu: 300.0, zeta: 0.01, right: Some(place), ..FREE };
        let motion = follow(PrimaryCase { primary, model, start }, 10.0);
        let path = by_hand(primary, model, place, start, 10.0);
        for index in 0..=100 {
            let t = 0.1 * f64::from(index);
            let (own, other) =
                (motion.state_at(t).expect("a state"), path.states_at(t).expect("a state"));
            assert!(
                (own.x - other[0]).abs() < 1e-6,
                "{place} {start:?} at {t}: {} {}",
                own.x,
                other[0]
            );
            assert!(
                (own.y - other[2]).abs() < 1e-6,
                "{place} {start:?} at {t}: {} {}",
                own.y,
                other[2]
            );
        }
        assert!(motion.impacts.iter().all(|impact| impact.speed_in >= 0.0));
    }
}

/// On a pivot that is hardly moved the pendulum rests when it does on a fixed one.
#[test]
fn the_pendulum_of_a_heavy_main_mass_rests_as_on_a_fixed_pivot() {
    // Far from resonance with the pendulum, whose recoil would add up otherwise.
    let primary = Primary { mass: 1e12, stiffness: 1e14, damping: 0.0, force: 0.0, frequency: 0.0 };
    for (left, right, x) in [
        (None, Some(0.323), -1.5),
        (Some(-0.4), None, 0.9),
        (Some(-0.5), Some(0.3), -0.45),
        (None, None, 1.2),
    ] {
        let model = Model { gamma: 1e4, mu: 500.0, zeta: 0.02, left, right, ..Model::default() };
        let start = Start { x, velocity: 0.0 };
        let alone = simulate(
            &model,
            start,
            Integrator::Taylor,
            &Settings { duration: 200.0, ..Settings::default() },
        );
        let alone = alone.expect("a motion");
        let motion = follow(PrimaryCase { primary, model, start: [x, 0.0, 0.0, 0.0] }, 200.0);
        let (found, truth) =
            (motion.pendulum_rest_time().expect("it rests"), alone.rest().time.expect("it rests"));
        assert!((found / truth - 1.0).abs() < 1e-6, "{left:?} {right:?}: {found} {truth}");
        // The force of the first impact is that on the fixed pivot.
        if let (Some(impact), Some(contact)) = (motion.impacts.first(), alone.impacts.first()) {
            let (found, truth) =
                (motion.peak_force(impact), alone.peak_force(contact).expect("a force"));
            assert!((found / truth - 1.0).abs() < 1e-6, "{found} {truth}");
        }
    }
}

/// The torque that friction must bear where the pendulum stands still relative to the main mass, by
/// the equations solved by hand: (R + 1) y'' = f sin(eta t) - delta y' - kappa y and G = sin x +
/// y'' cos x + contact.
fn torque_at_rest(case: &PrimaryCase, t: f64, state: &PrimaryState) -> f64 {
    let (primary, model) = (&case.primary, &case.model);
    let drive = primary.force * (primary.frequency * t).sin();
    let acceleration = (drive - primary.damping * state.speed - primary.stiffness * state.y)
        / (primary.mass + 1.0);
    let depth = |place: Option<f64>, side: f64| {
        place.map_or(0.0, |place| (side * (state.x - place)).max(0.0))
    };
    let push = |depth: f64| model.gamma * depth.powf(1.5);
    state.x.sin() + state.x.cos() * acceleration + push(depth(model.right, 1.0))
        - push(depth(model.left, -1.0))
}

/// The number of moments, of so many, at which the pendulum has stood still since the one before;
/// at each the torque is at most alpha.
fn held_moments(motion: &PrimaryMotion, moments: u32) -> usize {
    let alpha = motion.case.model.alpha;
    let mut held = 0;
    let mut before = f64::NAN;
    for index in 0..=moments {
        let t = motion.end * f64::from(index) / f64::from(moments);
        let state = motion.state_at(t).expect("a state");
        // At a turning point alone nothing is held.
        let stays = state.velocity == 0.0 && state.x == before;
        before = state.x;
        if stays {
            held += 1;
            let torque = torque_at_rest(&motion.case, t, &state);
            assert!(torque.abs() <= alpha * (1.0 + 1e-9), "{t}: {torque} {:?}", motion.case);
        }
    }
    held
}

fn example(text: &str, varied: &[(&str, f64)]) -> PrimaryMotion {
    let file: Problem = text.parse().expect("a problem");
    let varied: Vec<(PrimaryParameter, f64)> =
        varied.iter().map(|(name, value)| (name.parse().expect("a parameter"), *value)).collect();
    let asked = file.primary_case(&varied).expect("a case");
    let motion = simulate_primary(asked.case, &asked.settings).expect("a motion");
    assert!(motion.is_complete(), "{:?} at {}", motion.stop, motion.end);
    assert!(motion.energy.residual < 1e-9, "{:?}", motion.energy);
    motion
}

const STICK_SLIP: &str = include_str!("../../examples/primary/stick-slip.toml");

/// While a pendulum is held, the torque that friction must bear is at most alpha: at the onset of a
/// slip velocity and acceleration are both zero, and rounding may not decide.
#[test]
fn a_pendulum_is_held_only_while_friction_can_bear_the_torque() {
    let mut held = 0;
    for index in 0..8 {
        let displacement = 0.0103 + 0.002 * f64::from(index);
        held += held_moments(&example(STICK_SLIP, &[("displacement", displacement)]), 3000);
    }
    for (force, frequency) in [(0.3, 9.0), (0.8, 11.0), (1.5, 14.0), (0.2, 17.0), (2.0, 5.0)] {
        let varied = [("force", force), ("frequency", frequency), ("alpha", 0.2)];
        held += held_moments(&example(STICK_SLIP, &varied), 3000);
    }
    assert!(held > 5000, "{held}");
    // By an event-driven Runge-Kutta of order 8 (scipy's DOP853, 1e-11, steps of 1e-5 in contact)
    // with the contact as |d|^(3/2) in t.
    for (displacement, impacts, rest) in [(0.0163, 7, 48.655_261_6), (0.02, 10, 59.512_111_5)] {
        let motion = example(STICK_SLIP, &[("displacement", displacement)]);
        assert_eq!(motion.impacts.len(), impacts, "{displacement}");
        assert!((motion.rest_time().expect("a rest") - rest).abs() < 2e-6, "{displacement}");
    }
}

/// Held while a driven main mass shakes it, in closed form: the steady swing of the locked mass
/// tears the pendulum loose exactly where its acceleration exceeds alpha.
#[test]
fn a_shaken_pendulum_slips_exactly_where_the_acceleration_exceeds_the_friction() {
    // Undamped and started on its steady motion y = Y sin(eta t), Y = f/(kappa - (R + 1) eta^2).
    for (force, frequency) in [(3.0, 0.9), (7.0, 0.5), (-20.0, 2.3)] {
        let amplitude: f64 = force / (MASS.stiffness - (MASS.mass + 1.0) * frequency * frequency);
        let peak = (amplitude * frequency * frequency).abs();
        for part in [0.999_999_9, 1.000_001, 1.3] {
            let alpha = peak / part;
            let primary = Primary { force, frequency, ..MASS };
            let case = PrimaryCase {
                primary,
                model: Model { alpha, ..FREE },
                start: [0.0, 0.0, 0.0, amplitude * frequency],
            };
            let motion = follow(case, 40.0);
            held_moments(&motion, 4000);
            // |y''| = peak |sin(eta t)| reaches alpha at eta t = asin(1/part).
            let onset = (1.0 / part).min(1.0).asin() / frequency;
            let still = |t: f64| motion.state_at(t).expect("a state").x == 0.0;
            assert!(still(onset - 1e-3), "{force} {part}");
            assert_eq!(still(onset + 0.5), part < 1.0, "{force} {part}");
        }
    }
}

/// The contact acts from the start where the motion begins inside a barrier: at rest, moving in,
/// moving out, moving out faster than the barrier comes back, by hand and Runge-Kutta as above;
/// held by friction, by the torque.
#[test]
fn a_start_inside_a_barrier_is_a_start_in_contact() {
    let primary = Primary { mass: 5.0, stiffness: 10.0, damping: 0.1, ..MASS };
    let model = Model { gamma: 2000.0, mu: 300.0, zeta: 0.01, right: Some(0.1), ..FREE };
    for velocity in [0.0, 0.8, -0.5] {
        let start = [0.15, velocity, 0.1, -0.2];
        let motion = follow(PrimaryCase { primary, model, start }, 10.0);
        let path = by_hand(primary, model, 0.1, start, 10.0);
        for index in 0..=100 {
            let t = 0.1 * f64::from(index);
            let (own, other) =
                (motion.state_at(t).expect("a state"), path.states_at(t).expect("a state"));
            for (own, other) in [own.x, own.velocity, own.y, own.speed].iter().zip(other) {
                assert!((own - other).abs() < 1e-6, "{velocity} at {t}: {own} {other}");
            }
        }
        let first = motion.impacts[0];
        assert_eq!((first.entry_time, first.speed_in), (0.0, velocity));
        assert!(first.penetration >= 0.05 - 1e-15 && first.exit_time.is_some());
    }
    // Faster outwards than the barrier follows: nothing pushes, as if there were no barrier, until
    // it is out.
    let start = [0.15, -8.0, 0.0, 0.0];
    let motion = follow(PrimaryCase { primary, model, start }, 1.0);
    let free = Model { right: None, ..model };
    let without = follow(PrimaryCase { primary, model: free, start }, 1.0);
    let out = motion.impacts[0].exit_time.expect("an exit");
    for state in [0.5 * out, out].map(|t| [motion.state_at(t), without.state_at(t)]) {
        let [own, other] = state.map(|state| state.expect("a state"));
        assert!((own.x - other.x).abs() < 1e-13 && (own.velocity - other.velocity).abs() < 1e-12);
    }
    assert!((motion.impacts[0].energy_lost - model.elastic_energy(0.05)).abs() < 1e-12);
    // Friction that bears the contact and gravity holds it there.
    let held = Model { alpha: 60.0, ..model };
    let start = [0.15, 0.0, 0.3, 0.0];
    let motion = follow(PrimaryCase { primary, model: held, start }, 20.0);
    assert_eq!(held_moments(&motion, 2000), 2000);
    // The left barrier mirrors the right one.
    let mirrored = Model { left: Some(-0.1), right: None, ..model };
    let [right, left] = [(model, [0.15, 0.3, 0.1, 0.0]), (mirrored, [-0.15, -0.3, -0.1, 0.0])].map(
        |(model, start)| {
            follow(PrimaryCase { primary, model, start }, 10.0).state_at(10.0).expect("a state")
        },
    );
    assert!((right.x + left.x).abs() < 1e-12 && (right.y + left.y).abs() < 1e-12);
}

/// A sweep over several numbers at a time is, motion for motion, what the file says with these
/// numbers in it.
#[test]
fn a_sweep_is_what_the_file_says_with_other_numbers() {
    let text = "[primary]\nmass = 0.3\nstiffness = 40\ndamping = 0.5\ndisplacement = 0.02\n\
                [pendulum]\nbarrier = 0.2\n[contact]\nmu_over_gamma = 0.3\n[run]\nduration = 40";
    let file: Problem = text.parse().expect("a problem");
    let followed = |file: &Problem, varied: &[(&str, f64)]| {
        let varied: Vec<(PrimaryParameter, f64)> = varied
            .iter()
            .map(|(name, value)| (name.parse().expect("a parameter"), *value))
            .collect();
        let asked = file.primary_case(&varied).expect("a case");
        (asked.case, asked.settings, asked.units)
    };
    for (varied, from, to) in [
        (&[("primary.mass", 0.5)][..], "mass = 0.3", "mass = 0.5"),
        (&[("mass_ratio", 50.0)], "mass = 0.3", "mass = 0.56"),
        (&[("stiffness", 60.0)], "stiffness = 40", "stiffness = 60"),
        (&[("primary.damping", 0.1)], "damping = 0.5", "damping = 0.1"),
        (&[("displacement", -0.01)], "displacement = 0.02", "displacement = -0.01"),
        (&[("barrier", 0.05)], "barrier = 0.2", "barrier = 0.05"),
        (&[("mu_over_gamma", 0.1)], "mu_over_gamma = 0.3", "mu_over_gamma = 0.1"),
        (&[("gamma", 1e5)], "[contact]", "[contact]\ngamma = 1e5"),
        (&[("alpha", 0.1)], "[run]", "[damping]\nalpha = 0.1\n[run]"),
        (&[("length", 0.1)], "[run]", "[design]\nlength = 0.1\n[run]"),
        (&[("design.mass", 0.02)], "[run]", "[design]\nmass = 0.02\n[run]"),
        (
            &[("pendulum.speed", 0.3), ("start", -0.1)],
            "barrier = 0.2",
            "barrier = 0.2\nstart = -0.1\nspeed = 0.3",
        ),
        (
            &[("force", 0.2), ("frequency", 9.0)],
            "stiffness",
            "force = 0.2\nfrequency = 9\nstiffness",
        ),
    ] {
        let typed: Problem = text.replace(from, to).parse().expect("a problem");
        let (own, other) = (followed(&file, varied), followed(&typed, &[]));
        let close = |one: f64, other: f64| (one - other).abs() <= 1e-12 * other.abs();
        assert!(close(own.0.primary.mass, other.0.primary.mass), "{varied:?}");
        let primary = Primary { mass: other.0.primary.mass, ..own.0.primary };
        assert_eq!((PrimaryCase { primary, ..own.0 }, own.1, own.2), other, "{varied:?}");
    }
    let refused = |varied: &[(&str, f64)]| {
        let varied: Vec<(PrimaryParameter, f64)> = varied
            .iter()
            .map(|(name, value)| (name.parse().expect("a parameter"), *value))
            .collect();
        file.primary_case(&varied).expect_err("a refusal").to_string()
    };
    assert!(refused(&[("mass_ratio", 50.0), ("primary.mass", 1.0)]).contains("sweep one of them"));
    assert!(refused(&[("frequency", 9.0)]).contains("force"));
    assert!(refused(&[("mass_ratio", -1.0)]).contains("mass_ratio"));
    assert!(refused(&[("gamma", 1e5), ("modulus", 1e9)]).contains("gamma"));
}
