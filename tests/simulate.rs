//! The damper against truths that it does not know: elliptic functions, quadrature, the other integrator, itself with
//! a tighter tolerance.

use lindstedt::damper::sweep::sweep_on;
use lindstedt::damper::{
    Friction, Integrator, Model, NoRest, Options, Simulation, Start, Stop, simulate, simulate_many,
};
use lindstedt::ode::quadrature::integrate_smooth;
use lindstedt::ode::root::find_root;
use proptest::prelude::*;

const REST: Start = Start { x: -1.5, velocity: 0.0 };

fn run(model: &Model, start: Start, tolerance: f64, duration: f64, integrator: Integrator) -> Simulation {
    let options = Options {
        duration,
        relative_tolerance: tolerance,
        absolute_tolerance: 1e-2 * tolerance,
        ..Options::default()
    };
    simulate(model, start, integrator, &options).expect("a motion")
}

/// As accurate as a run by the program with this `integrator_tolerance`, whose steps get a hundredth of it.
fn taylor(model: &Model, start: Start, tolerance: f64, duration: f64) -> Simulation {
    run(
        model,
        start,
        (1e-2 * tolerance).max(1e-15),
        duration,
        Integrator::Taylor,
    )
}

/// The pendulum released at rest from x = -amplitude: sin(x/2) = -k cn/dn, k = sin(amplitude/2).
fn pendulum(amplitude: f64, t: f64) -> (f64, f64) {
    let k = (0.5 * amplitude).sin();
    let (sn, cn, dn, _) = spec_math::cephes64::ellpj(t, k * k);
    (-2.0 * (k * cn / dn).asin(), 2.0 * k * (1.0 - k * k).sqrt() * sn / dn)
}

/// Time from release to touch, time in contact, and depth, of the conservative motion: elliptic F, and from the energy
/// T = 8 sqrt(q_m) int q / sqrt(H) dw with depth = q^2, q = q_m (1 - w^2), v^2 = (q_m - q) H.
fn exact_cycle(amplitude: f64, barrier: f64, gamma: f64) -> (f64, f64, f64) {
    let k = (0.5 * amplitude).sin();
    let approach = ellip::ellipk(k * k).expect("m < 1")
        + ellip::ellipf(((0.5 * barrier).sin() / k).asin(), k * k).expect("within reach");
    // 2 (cos(x_c + d) - cos A) as a product, without cancellation at grazing.
    let square = |q: f64| {
        let x = barrier + q * q;
        4.0 * (0.5 * (amplitude + x)).sin() * (0.5 * (amplitude - x)).sin() - 0.8 * gamma * q.powi(5)
    };
    let deepest = find_root(square, 0.0, (amplitude - barrier).sqrt()).expect("a depth");
    let slope = |q: f64| 4.0 * q * (barrier + q * q).sin() + 4.0 * gamma * q.powi(4);
    let quotient = |q: f64| {
        integrate_smooth(|u| slope(q + u * (deepest - q)), 0.0, 1.0, 1e-14)
            .expect("smooth")
            .0
    };
    let integrand = |w: f64| {
        let q = deepest * (1.0 - w * w);
        q / quotient(q).sqrt()
    };
    let contact = 8.0 * deepest.sqrt() * integrate_smooth(integrand, 0.0, 1.0, 1e-13).expect("smooth").0;
    (approach, contact, deepest * deepest)
}

/// The exact conservative motion at any time outside contact.
fn exact_state(amplitude: f64, barrier: f64, gamma: f64, t: f64) -> Option<(f64, f64)> {
    let (approach, contact, _) = exact_cycle(amplitude, barrier, gamma);
    let cycle = 2.0 * approach + contact;
    // Counted from the nearest release.
    let phase = t - cycle * (t / cycle).round();
    let (x, v) = pendulum(amplitude, phase);
    (phase.abs() < approach).then_some((x, v))
}

#[test]
fn the_conservative_motion_is_that_of_elliptic_functions_and_quadrature() {
    for (gamma, barrier) in [(1e6, 0.323), (3.0407e7, 0.323), (1e3, -0.2), (1e16, 0.7)] {
        let model = Model {
            gamma,
            right: Some(barrier),
            ..Model::default()
        };
        let (approach, contact, depth) = exact_cycle(1.5, barrier, gamma);
        let motion = taylor(&model, REST, 1e-10, 50.0);
        assert_eq!(motion.stop, Stop::Duration);
        let cycle = 2.0 * approach + contact;
        let expected = ((50.0 - approach) / cycle).floor() as usize + 1;
        assert_eq!(motion.impacts.len(), expected, "gamma {gamma}");
        for (number, impact) in motion.impacts.iter().enumerate() {
            let entry = approach + number as f64 * cycle;
            assert!(
                (impact.entry_time - entry).abs() < 1e-10,
                "gamma {gamma}, {number}: {}",
                impact.entry_time - entry
            );
            if let Some(exit) = impact.exit_time {
                assert!((exit - entry - contact).abs() < 1e-10);
                assert!(
                    (impact.penetration / depth - 1.0).abs() < 1e-8,
                    "{} {depth}",
                    impact.penetration
                );
                assert!((impact.restitution.expect("left") - 1.0).abs() < 1e-9);
                assert!(impact.energy_lost.expect("left").abs() < 1e-9);
            }
        }
        let mut compared = 0;
        for index in 0..=500 {
            let t = 0.1 * f64::from(index);
            let (x, v) = motion.path.at(t).expect("within the run");
            if let Some((exact_x, exact_v)) = exact_state(1.5, barrier, gamma, t) {
                assert!(
                    (x - exact_x).abs() < 1e-9 && (v - exact_v).abs() < 1e-9,
                    "gamma {gamma}, t {t}: {} {}",
                    x - exact_x,
                    v - exact_v
                );
                compared += 1;
            }
        }
        assert!(compared > 450);
        assert!(motion.energy().residual < 1e-9, "{:?}", motion.energy());
    }
}

#[test]
fn the_judge_agrees() {
    let damped = Model {
        zeta: 0.02,
        alpha: 0.03,
        beta: 0.3,
        frequency_ratio: 1.7,
        gamma: 1e5,
        mu: 1e4,
        left: Some(-0.9),
        right: Some(0.4),
        friction: Friction::Exact,
    };
    let start = Start { x: 0.2, velocity: 1.3 };
    for model in [
        damped,
        Model {
            friction: Friction::Arctangent,
            ..damped
        },
        Model { beta: 0.0, ..damped },
        Model {
            alpha: 0.35,
            beta: 0.6,
            ..damped
        },
    ] {
        let fast = taylor(&model, start, 1e-13, 40.0);
        let judge = run(&model, start, 1e-13, 40.0, Integrator::RungeKutta);
        assert_eq!(judge.stop, Stop::Duration, "{}", judge.stop);
        assert_eq!(fast.stop, Stop::Duration, "{}", fast.stop);
        assert_eq!(fast.impacts.len(), judge.impacts.len(), "{model:?}");
        for (one, other) in fast.impacts.iter().zip(&judge.impacts) {
            assert_eq!(one.side, other.side);
            assert!((one.entry_time - other.entry_time).abs() < 1e-8, "{one:?} {other:?}");
        }
        for index in 0..=400 {
            let t = 0.1 * f64::from(index);
            let ((x, v), (judge_x, judge_v)) = (fast.path.at(t).expect("t"), judge.path.at(t).expect("t"));
            assert!(
                (x - judge_x).abs() < 1e-7 && (v - judge_v).abs() < 1e-6,
                "{model:?} {t}: {} {}",
                x - judge_x,
                v - judge_v
            );
        }
        assert!(fast.energy().residual < 1e-9, "{:?}", fast.energy());
        assert!(judge.energy().residual < 1e-7, "{:?}", judge.energy());
        println!(
            "{:?} {} turns, {} impacts",
            fast.energy(),
            fast.turns.len(),
            fast.impacts.len()
        );
        println!(
            "{:?} {} turns, {} steps {} {}",
            judge.energy(),
            judge.turns.len(),
            fast.impacts.len(),
            fast.steps,
            judge.steps
        );
    }
}

#[test]
fn grazing_contacts_are_neither_missed_nor_invented() {
    let gamma = 1e6;
    for part in [0.9, 0.99, 0.999, 0.9999, 0.99999, 0.999_999] {
        let barrier = 1.5 * part;
        let model = Model {
            gamma,
            right: Some(barrier),
            ..Model::default()
        };
        let (approach, contact, depth) = exact_cycle(1.5, barrier, gamma);
        let cycle = 2.0 * approach + contact;
        let motion = taylor(&model, REST, 1e-12, 50.0);
        let expected = ((50.0 - approach) / cycle).floor() as usize + 1;
        assert_eq!(motion.impacts.len(), expected, "barrier at {part} A");
        for (number, impact) in motion.impacts.iter().enumerate() {
            // A touch at speed v is as well known in time as x is, divided by v.
            let allowed = 1e-10 / impact.speed_in.min(1.0);
            let entry = approach + number as f64 * cycle;
            assert!(
                (impact.entry_time - entry).abs() < allowed,
                "{part}: {}",
                impact.entry_time - entry
            );
            if let Some(exit) = impact.exit_time {
                assert!((exit - impact.entry_time - contact).abs() < 2.0 * allowed);
                assert!((impact.penetration - depth).abs() < 1e-10);
            }
        }
    }
    for beyond in [1.0, 1.0 + 1e-12, 1.000_001, 1.1] {
        let model = Model {
            right: Some(1.5 * beyond),
            ..Model::default()
        };
        let motion = taylor(&model, REST, 1e-13, 200.0);
        // Exactly at A the rounding decides, and what it makes is no impact to speak of.
        let speed = motion.impacts.iter().map(|impact| impact.speed_in).fold(0.0, f64::max);
        if beyond == 1.0 {
            assert!(speed < 1e-6, "{speed}");
        } else {
            assert_eq!(motion.impacts.len(), 0, "barrier at {beyond} A");
        }
        let (x, v) = pendulum(1.5, 200.0);
        assert!((motion.end_x - x).abs() < 1e-9 && (motion.end_velocity - v).abs() < 1e-9);
    }
}

#[test]
fn a_slow_touch_bounces_as_gravity_says() {
    // Thrown against the barrier at a speed that hardly dents it: it is back after 2 v / sin x_c and the depth is
    // v^2 / (2 sin x_c), until the contact force counts.
    for speed in [1e-6, 1e-8, 1e-10] {
        let model = Model {
            gamma: 1.0,
            ..Model::default()
        };
        let start = Start {
            x: 0.323,
            velocity: speed,
        };
        let motion = taylor(&model, start, 1e-12, 1.0);
        let impact = motion.impacts[0];
        let force = 0.323_f64.sin();
        let exit = impact.exit_time.expect("it comes back");
        assert!((exit / (2.0 * speed / force) - 1.0).abs() < 1e-5, "{exit}");
        assert!((impact.penetration / (0.5 * speed * speed / force) - 1.0).abs() < 1e-5);
        assert_eq!(motion.impacts.len(), 1);
    }
}

#[test]
fn two_barriers_are_mirror_images() {
    let model = Model {
        zeta: 0.01,
        alpha: 0.02,
        beta: 0.25,
        frequency_ratio: 0.9,
        mu: 3e4,
        left: Some(-0.6),
        right: Some(0.35),
        ..Model::default()
    };
    let mirrored = Model {
        beta: -model.beta,
        left: Some(-0.35),
        right: Some(0.6),
        ..model
    };
    let start = Start { x: 0.1, velocity: 1.1 };
    let image = Start {
        x: -0.1,
        velocity: -1.1,
    };
    for integrator in [Integrator::Taylor, Integrator::RungeKutta] {
        let one = run(&model, start, 1e-12, 40.0, integrator);
        let other = run(&mirrored, image, 1e-12, 40.0, integrator);
        assert!(one.impacts.len() > 10 && one.impacts.len() == other.impacts.len());
        for (one, other) in one.impacts.iter().zip(&other.impacts) {
            assert_ne!(one.side, other.side);
            assert!((one.entry_time - other.entry_time).abs() < 1e-11);
            assert!((one.penetration - other.penetration).abs() < 1e-11);
        }
        assert!((one.end_x + other.end_x).abs() < 1e-10 && (one.end_velocity + other.end_velocity).abs() < 1e-10);
    }
    // Symmetric barriers and start: every other half swing is the mirror image of the one before.
    let symmetric = Model {
        left: Some(-0.4),
        right: Some(0.4),
        ..Model::default()
    };
    let start = Start { x: 0.0, velocity: 1.0 };
    let motion = taylor(&symmetric, start, 1e-13, 30.0);
    let times: Vec<f64> = motion.impacts.iter().map(|impact| impact.entry_time).collect();
    assert!(times.len() > 20);
    for three in times.windows(3) {
        assert!((three[2] - 2.0 * three[1] + three[0]).abs() < 1e-10);
    }
}

#[test]
fn dissipative_and_forced_motions_agree_with_runs_a_hundred_times_tighter() {
    let base = Model {
        zeta: 0.015,
        mu: 5e4,
        ..Model::default()
    };
    for model in [
        base,
        Model { alpha: 0.02, ..base },
        Model {
            alpha: 0.02,
            friction: Friction::Arctangent,
            ..base
        },
        Model {
            beta: 0.2,
            frequency_ratio: 1.4,
            ..base
        },
        Model {
            alpha: 0.02,
            beta: 0.2,
            frequency_ratio: 1.4,
            left: Some(-0.7),
            ..base
        },
    ] {
        let start = Start {
            x: -0.65,
            velocity: 0.4,
        };
        let usual = taylor(&model, start, 1e-10, 50.0);
        let tight = taylor(&model, start, 1e-12, 50.0);
        assert_eq!(usual.impacts.len(), tight.impacts.len());
        for (one, other) in usual.impacts.iter().zip(&tight.impacts) {
            let allowed = 1e-9 / one.speed_in;
            assert!(
                (one.entry_time - other.entry_time).abs() < allowed,
                "{model:?}: {}",
                one.entry_time - other.entry_time
            );
        }
        assert!(
            (usual.end_x - tight.end_x).abs() < 1e-8,
            "{model:?}: {}",
            usual.end_x - tight.end_x
        );
        for motion in [&usual, &tight] {
            assert!(motion.energy().residual < 1e-9, "{:?}", motion.energy());
        }
    }
}

#[test]
fn restitution_of_hunt_and_crossley() {
    // lambda v (1 + e) = ln((1 + lambda v)/(1 - lambda e v)), whatever the stiffness: without gravity, which a hard
    // contact does not notice.
    for (lambda_v, expected) in [(0.1, 0.937_475_580), (0.3, 0.832_869_792), (1.0, 0.593_624_260)] {
        let gamma = 1e12;
        let speed = 1.0;
        let model = Model {
            gamma,
            mu: lambda_v / speed * gamma,
            right: Some(0.0),
            ..Model::default()
        };
        let start = Start {
            x: 0.0,
            velocity: speed,
        };
        let exact = find_root(
            |e| lambda_v * (1.0 + e) - ((1.0 + lambda_v) / (1.0 - lambda_v * e)).ln(),
            0.1,
            0.999,
        )
        .expect("a restitution");
        assert!((exact - expected).abs() < 1e-8);
        let motion = taylor(&model, start, 1e-12, 0.1);
        let found = motion.impacts[0].restitution.expect("left");
        assert!((found - exact).abs() < 1e-9, "{found} against {exact}");
    }
}

#[test]
fn the_contact_never_pulls() {
    // A damper so strong that the return would be faster than the barrier can follow.
    let model = Model {
        mu: 1e6,
        gamma: 1e4,
        zeta: 0.01,
        ..Model::default()
    };
    let motion = taylor(&model, REST, 1e-12, 20.0);
    let judge = run(&model, REST, 1e-13, 20.0, Integrator::RungeKutta);
    assert!(
        motion
            .path
            .pieces()
            .iter()
            .any(|piece| matches!(piece.state, lindstedt::damper::State::Detached(_)))
    );
    assert!(motion.difference(&judge, 2001).displacement < 1e-8);
    assert!(motion.energy().residual < 1e-9, "{:?}", motion.energy());
    for impact in motion.impacts.iter().filter(|impact| impact.exit_time.is_some()) {
        let out = impact.speed_out.expect("left");
        assert!(out > 0.0 && out < impact.speed_in);
    }
}

#[test]
fn coulomb_friction_takes_alpha_times_the_way_and_then_holds() {
    let alpha = 0.05;
    let model = Model {
        alpha,
        right: Some(3.0),
        ..Model::default()
    };
    let motion = taylor(&model, REST, 1e-12, 100.0);
    let amplitudes: Vec<f64> = motion.turns.iter().map(|turn| turn.x.abs()).collect();
    // cos a_(n+1) - cos a_n = alpha (a_n + a_(n+1)) until it sticks, where sin a < alpha.
    let mut swings = 0;
    for pair in amplitudes.windows(2) {
        if pair[1] != pair[0] {
            assert!(
                (pair[1].cos() - pair[0].cos() - alpha * (pair[0] + pair[1])).abs() < 1e-10,
                "{pair:?}"
            );
            swings += 1;
        }
    }
    assert!(swings >= 10, "{amplitudes:?}");
    assert!(motion.end_x.abs().sin() <= alpha && motion.end_velocity == 0.0);
    // After rest it is still there to be asked.
    assert_eq!(motion.path.at(99.9), Some((motion.end_x, 0.0)));
    assert!(motion.energy().residual < 1e-12);
}

#[test]
fn a_driven_pendulum_sticks_and_slips_when_the_force_says_so() {
    // From rest at x = 0: held until beta sin(Omega t) = alpha.
    let model = Model {
        alpha: 0.3,
        beta: 0.5,
        frequency_ratio: 0.8,
        right: Some(3.0),
        ..Model::default()
    };
    let start = Start { x: 0.0, velocity: 0.0 };
    let release = (0.3_f64 / 0.5).asin() / 0.8;
    for integrator in [Integrator::Taylor, Integrator::RungeKutta] {
        let motion = run(&model, start, 1e-12, 60.0, integrator);
        assert_eq!(motion.stop, Stop::Duration, "{}", motion.stop);
        assert_eq!(motion.path.at(0.999 * release), Some((0.0, 0.0)));
        assert!(motion.path.at(release + 0.1).expect("t").0 > 0.0);
        let first = motion
            .path
            .pieces()
            .iter()
            .find(|piece| piece.state != lindstedt::damper::State::Stuck);
        assert!((first.expect("it slips").start - release).abs() < 1e-10);
    }
    let (fast, judge) = (
        taylor(&model, start, 1e-12, 60.0),
        run(&model, start, 1e-13, 60.0, Integrator::RungeKutta),
    );
    assert!(fast.difference(&judge, 3001).displacement < 1e-8);
    let stuck = |motion: &Simulation| {
        let pieces = motion.path.pieces().iter();
        pieces
            .filter(|piece| piece.state == lindstedt::damper::State::Stuck)
            .map(|piece| piece.end - piece.start)
            .sum::<f64>()
    };
    assert!(
        stuck(&fast) > 1.0 && (stuck(&fast) - stuck(&judge)).abs() < 1e-6,
        "{} {}",
        stuck(&fast),
        stuck(&judge)
    );
}

#[test]
fn rest_times_of_the_plain_pendulum() {
    // The envelope by the action, the staircase by the last crossing.
    for (zeta, envelope, last) in [
        (0.0100, 224.2, 223.4),
        (0.0101, 222.0, 220.3),
        (0.0102, 219.8, 217.1),
        (0.0103, 217.7, 216.9),
    ] {
        let model = Model {
            zeta,
            right: Some(3.0),
            ..Model::default()
        };
        let rest = taylor(&model, REST, 1e-10, 300.0).rest();
        assert!((rest.time.expect("it rests") - envelope).abs() < 0.06, "{rest:?}");
        assert!(
            (rest.last_crossing.expect("it crosses") - last).abs() < 0.06,
            "{rest:?}"
        );
    }
}

/// The rest time by its definition, from nothing but samples of the Runge-Kutta motion: crests on the left, each by a
/// parabola through three samples, and the straight line of log|x| between the two around the level.
fn rest_by_samples(model: &Model, level: f64, duration: f64) -> f64 {
    const STEP: f64 = 1e-3;
    let motion = run(model, REST, 1e-11, duration, Integrator::RungeKutta);
    let at = |k: usize| motion.path.at(STEP * k as f64).map_or(0.0, |(x, _)| x);
    let crests = (1..(duration / STEP) as usize - 1).filter_map(|k| {
        let [before, here, after] = [at(k - 1), at(k), at(k + 1)];
        (here < before && here <= after).then(|| {
            let (slope, bend) = (0.5 * (after - before), before - 2.0 * here + after);
            (STEP * (k as f64 - slope / bend), here - 0.5 * slope * slope / bend)
        })
    });
    let mut before = (0.0, REST.x);
    for (t, x) in crests {
        if -x <= level {
            let fraction = (level / -before.1).ln() / (x / before.1).ln();
            return before.0 + fraction * (t - before.0);
        }
        before = (t, x);
    }
    f64::INFINITY
}

#[test]
fn a_barrier_near_plumb_does_not_invent_rest() {
    // Without loss nothing ever rests, wherever the barrier stands and wherever the run ends.
    for k in 0..29 {
        let model = Model {
            right: Some(0.005 * f64::from(k)),
            ..Model::default()
        };
        for duration in [98.5, 100.0, 101.3] {
            let rest = taylor(&model, REST, 1e-10, duration).rest();
            assert_eq!(rest.time, Err(NoRest::StaysAbove), "{:?} {duration}", model.right);
        }
    }
    for (right, mu) in [(0.1, 1e4), (0.02, 1e4), (0.146, 1e5)] {
        let model = Model {
            right: Some(right),
            mu,
            zeta: 0.01,
            ..Model::default()
        };
        assert_eq!(taylor(&model, REST, 1e-10, 100.0).rest().time, Err(NoRest::StaysAbove));
        let found = taylor(&model, REST, 1e-10, 260.0).rest().time.expect("it rests");
        let sampled = rest_by_samples(&model, 0.15, 260.0);
        assert!((found - sampled).abs() < 1e-3, "{right}: {found} {sampled}");
    }
}

#[test]
fn the_rest_time_is_continuous_in_the_place_of_the_barrier() {
    let rest = |right: f64| {
        let model = Model {
            right: Some(right),
            mu: 1e5,
            zeta: 0.01,
            ..Model::default()
        };
        taylor(&model, REST, 1e-10, 200.0).rest().time.expect("it rests")
    };
    let times: Vec<f64> = (0..=40).map(|k| rest(0.14 + 2.5e-4 * f64::from(k))).collect();
    // It rises by a twentieth from one to the next, and so does the rise, smoothly.
    let bends = times
        .windows(3)
        .map(|three| (three[0] - 2.0 * three[1] + three[2]).abs());
    assert!(bends.fold(0.0, f64::max) < 5e-3, "{times:?}");
}

#[test]
fn the_rest_time_does_not_depend_on_where_in_the_first_swing_the_motion_is_taken_up() {
    let model = Model {
        mu: 1e5,
        right: Some(0.05),
        ..Model::default()
    };
    let whole = taylor(&model, REST, 1e-11, 900.0);
    let rest = whole.rest();
    for t in [0.5, 1.3, 1.8] {
        let (x, velocity) = whole.path.at(t).expect("on the way");
        let later = taylor(&model, Start { x, velocity }, 1e-11, 900.0).rest();
        assert!((later.amplitude - rest.amplitude).abs() < 1e-10, "{later:?}");
        let (later, whole) = (later.time.expect("it rests"), rest.time.expect("it rests"));
        assert!((later + t - whole).abs() < 1e-5, "{t}: {later} {whole}");
    }
}

#[test]
fn a_motion_that_creeps_is_its_own_envelope_and_one_that_swings_must_be_seen_to_turn() {
    // x'' + 4 x' + x = 0 for small x: slopes s = -2 +- sqrt 3, x = (s1 e^(s2 t) - s2 e^(s1 t))/(s1 - s2) of the start.
    let model = Model {
        zeta: 2.0,
        right: Some(1.0),
        ..Model::default()
    };
    let start = Start {
        x: -1e-5,
        velocity: 0.0,
    };
    let (slow, fast) = (-2.0 + 3.0_f64.sqrt(), -2.0 - 3.0_f64.sqrt());
    let left = |t: f64| (slow * (fast * t).exp() - fast * (slow * t).exp()) / (slow - fast);
    let exact = find_root(|t| left(t) - 0.1, 1.0, 20.0).expect("it falls");
    let rest = taylor(&model, start, 1e-10, 60.0).rest();
    assert!((rest.time.expect("it rests") - exact).abs() < 1e-6, "{rest:?} {exact}");

    let swinging = Model { zeta: 0.5, ..model };
    let soon = taylor(&swinging, REST, 1e-10, 6.0).rest();
    assert_eq!(soon.time, Err(NoRest::NotYetSeen), "{soon:?}");
    assert!(taylor(&swinging, REST, 1e-10, 60.0).rest().time.is_ok());
}

#[test]
fn it_settles_on_a_barrier_that_it_leans_on() {
    let model = Model {
        zeta: 0.05,
        gamma: 1e3,
        mu: 1e4,
        right: Some(-0.3),
        ..Model::default()
    };
    for start in [REST, Start { x: -0.3, velocity: 0.0 }] {
        let motion = taylor(&model, start, 1e-10, 200.0);
        assert_eq!(motion.stop, Stop::Duration, "{}", motion.stop);
        // Gravity against the barrier: sin(0.3 - d) = gamma d^(3/2).
        let depth = find_root(|d| (0.3 - d).sin() - model.gamma * d.powf(1.5), 0.0, 0.3).expect("a depth");
        assert!((motion.end_x + 0.3 - depth).abs() < 1e-7, "{}", motion.end_x);
        assert!(motion.impacts.last().expect("contact").exit_time.is_none());
        assert!(motion.energy().residual < 1e-9);
    }
}

#[test]
fn a_run_that_breaks_off_keeps_what_it_has() {
    let options = Options {
        maximum_steps: 40,
        ..Options::default()
    };
    let motion = simulate(&Model::default(), REST, Integrator::Taylor, &options).expect("it begins");
    let Stop::Steps { t } = motion.stop else {
        panic!("{}", motion.stop)
    };
    assert!(t > 1.0 && t == motion.end_time && !motion.impacts.is_empty());
    assert!(motion.path.at(1.0).is_some() && motion.path.at(t + 1e-9).is_none());
}

/// Motions with every term on, different in every parameter.
fn crowd(count: usize) -> Vec<(Model, Start)> {
    (0..count)
        .map(|index| {
            let part = index as f64 / count as f64;
            let model = Model {
                zeta: 0.02 * part,
                alpha: if index.is_multiple_of(3) { 0.0 } else { 0.1 * part },
                beta: if index.is_multiple_of(4) { 0.0 } else { 0.3 * part },
                frequency_ratio: 0.5 + part,
                gamma: 10.0_f64.powf(3.0 + 6.0 * part),
                mu: if index.is_multiple_of(2) { 0.0 } else { 1e4 },
                left: Some(-1.0 - part),
                right: Some(0.1 + 0.5 * part),
                friction: Friction::Exact,
            };
            let start = Start {
                x: -0.9 + 0.3 * part,
                velocity: 0.5 * part,
            };
            (model, start)
        })
        .collect()
}

#[test]
fn several_at_a_time_are_bit_for_bit_what_each_is_alone() {
    let options = Options {
        keep_path: false,
        ..Options::default()
    };
    let motions = crowd(150);
    let together = simulate_many(&motions, &options).expect("they begin");
    for ((model, start), together) in motions.iter().zip(&together) {
        for keep_path in [false, true] {
            let alone =
                simulate(model, *start, Integrator::Taylor, &Options { keep_path, ..options }).expect("it begins");
            assert_eq!(alone.impacts, together.impacts, "{model:?}");
            assert_eq!(alone.turns, together.turns);
            assert_eq!(alone.end_x.to_bits(), together.end_x.to_bits());
            assert_eq!((alone.steps, alone.stop), (together.steps, together.stop));
        }
    }
}

#[test]
fn a_sweep_is_the_same_on_any_number_of_threads() {
    let motions = crowd(400);
    let options = Options::default();
    let one = sweep_on(1, &motions, &options, |_| ()).expect("they begin");
    let counted = std::sync::atomic::AtomicUsize::new(0);
    let count = |done: usize| {
        counted.fetch_add(done, std::sync::atomic::Ordering::Relaxed);
    };
    let many = sweep_on(5, &motions, &options, count).expect("they begin");
    assert_eq!(one, many);
    assert_eq!(counted.into_inner(), motions.len());
}

/// Over the top there is no swing: the amplitude is half a turn, or the start where that lies farther out.
#[test]
fn the_amplitude_of_a_motion_that_turns_over() {
    let model = Model {
        right: None,
        ..Model::default()
    };
    for (x, amplitude) in [(-10.0, 10.0), (10.0, 10.0), (0.5, std::f64::consts::PI)] {
        let motion = taylor(&model, Start { x, velocity: 3.0 }, 1e-9, 5.0);
        assert!(
            (motion.rest().amplitude - amplitude).abs() < 1e-12,
            "{x}: {}",
            motion.rest().amplitude
        );
    }
}

/// Where a rest energy is given the run ends as it is reached, with what a longer run had until then.
#[test]
fn a_run_ends_where_its_energy_has_died_away() {
    let plain = Model {
        zeta: 0.05,
        right: None,
        ..Model::default()
    };
    let bouncing = Model {
        zeta: 0.02,
        gamma: 1e5,
        mu: 1e4,
        ..Model::default()
    };
    for model in [plain, bouncing] {
        let options = Options {
            duration: 200.0,
            ..Options::default()
        };
        let full = simulate(&model, REST, Integrator::Taylor, &options).expect("a motion");
        let mut last = 0.0;
        for k in 1..14 {
            let calm = 0.9 * 0.6_f64.powi(k);
            let options = Options {
                rest_energy: Some(calm),
                ..options
            };
            let motion = simulate(&model, REST, Integrator::Taylor, &options).expect("a motion");
            assert_eq!(motion.stop, Stop::Calm);
            let energy = model.energy(motion.end_x, motion.end_velocity);
            assert!(
                energy <= calm * (1.0 + 1e-9) && motion.end_time >= last,
                "{energy} {calm}"
            );
            last = motion.end_time;
            let before = full.turns.iter().filter(|turn| turn.t <= motion.end_time);
            assert_eq!(motion.turns.iter().collect::<Vec<_>>(), before.collect::<Vec<_>>());
            if model.right.is_none() {
                assert!((energy / calm - 1.0).abs() < 1e-9, "{energy} {calm}");
                let judge = simulate(&model, REST, Integrator::RungeKutta, &options).expect("a motion");
                assert_eq!(judge.stop, Stop::Calm);
                assert!((judge.end_time - motion.end_time).abs() < 1e-5);
            }
        }
    }
}

/// A contact whose damping outweighs its stiffness at the speed of the touch: both integrators follow it alike.
#[test]
fn a_touch_faster_than_the_contact_relaxes() {
    let model = Model {
        gamma: 1e4,
        mu: 4e4,
        ..Model::default()
    };
    let [one, other] =
        [Integrator::Taylor, Integrator::RungeKutta].map(|integrator| run(&model, REST, 1e-11, 12.0, integrator));
    assert_eq!(one.impacts.len(), other.impacts.len());
    let first = one.impacts[0];
    assert!(first.speed_in * model.mu > 4.0 * model.gamma, "{first:?}");
    for (one, other) in one.impacts.iter().zip(&other.impacts) {
        assert!(
            (one.penetration / other.penetration - 1.0).abs() < 1e-6,
            "{one:?} {other:?}"
        );
        let [out, judged] = [one, other].map(|impact| impact.speed_out.expect("an exit"));
        assert!((out / judged - 1.0).abs() < 1e-5, "{one:?} {other:?}");
    }
}

#[test]
fn no_barrier_is_certain_only_where_the_energy_does_not_reach_it() {
    let free = |barrier: f64, beta: f64| {
        let model = Model {
            right: Some(barrier),
            beta,
            frequency_ratio: 0.5,
            ..Model::default()
        };
        let motion = taylor(&model, REST, 1e-9, 1.0);
        assert!(!motion.touches());
        motion.never_touches()
    };
    for (barrier, never) in [
        (0.5, false),
        (1.499, false),
        (1.501, true),
        (1.55, true),
        (3.0, true),
        (4.0, true),
    ] {
        assert_eq!(free(barrier, 0.0), never, "{barrier}");
        // What is driven may get anywhere.
        assert!(!free(barrier, 0.01));
    }
}

#[test]
fn what_is_no_motion_is_refused() {
    let refuse = |model: Model, start: Start, options: Options| {
        simulate(&model, start, Integrator::Taylor, &options)
            .expect_err("refused")
            .to_string()
    };
    let (model, usual) = (Model::default(), Options::default());
    let bad = |model: Model| refuse(model, REST, usual);
    assert!(bad(Model { zeta: -0.1, ..model }).contains("zeta must not be negative"));
    assert!(bad(Model { gamma: 0.0, ..model }).contains("gamma must be a positive number"));
    assert!(
        bad(Model {
            beta: f64::NAN,
            ..model
        })
        .contains("beta must be a finite number")
    );
    assert!(
        bad(Model {
            left: Some(0.5),
            ..model
        })
        .contains("must lie below")
    );
    let start = Start {
        x: f64::INFINITY,
        velocity: 0.0,
    };
    assert!(refuse(model, start, usual).contains("start must be a finite number"));
    for duration in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(refuse(model, REST, Options { duration, ..usual }).contains("duration"));
    }
    for relative_tolerance in [0.0, 1e-16, 0.1, f64::NAN] {
        let options = Options {
            relative_tolerance,
            ..usual
        };
        assert!(refuse(model, REST, options).contains("tolerance"));
    }
    let second = [(model, REST), (Model { mu: -1.0, ..model }, REST)];
    assert_eq!(simulate_many(&second, &usual).expect_err("refused").0, 1);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, ..ProptestConfig::default() })]

    /// Whatever the parameters: the energy is accounted for, impacts follow each other, no contact gains energy, and
    /// away from the barriers the motion is never beyond them.
    #[test]
    fn every_motion_keeps_its_books(
        zeta in 0.0..0.2_f64,
        alpha in prop_oneof![Just(0.0), 0.0..0.4_f64],
        beta in prop_oneof![Just(0.0), -0.8..0.8_f64],
        frequency_ratio in 0.1..4.0_f64,
        exponent in 2.0..9.0_f64,
        ratio in prop_oneof![Just(0.0), 0.0..2.0_f64],
        right in -0.5..1.4_f64,
        left in prop_oneof![Just(None), (-3.0..-1.5_f64).prop_map(Some)],
        arctangent in any::<bool>(),
        x in -1.4..-0.6_f64,
        velocity in -1.0..1.0_f64,
    ) {
        let gamma = 10.0_f64.powf(exponent);
        let model = Model {
            zeta, alpha, beta, frequency_ratio, gamma, left,
            friction: if arctangent { Friction::Arctangent } else { Friction::Exact },
            mu: ratio * gamma,
            right: Some(right),
        };
        let motion = taylor(&model, Start { x, velocity }, 1e-10, 20.0);
        prop_assert_eq!(motion.stop, Stop::Duration);
        let book = motion.energy();
        prop_assert!(book.residual < 1e-9, "{:?}", book);
        prop_assert!(book.viscous <= 0.0 && book.friction <= 0.0 && book.contact <= 1e-12);
        for pair in motion.impacts.windows(2) {
            let exit = pair[0].exit_time.expect("only the last may last");
            prop_assert!(pair[0].entry_time <= exit && exit <= pair[1].entry_time);
        }
        for (t, x, _) in motion.path.points(4) {
            let free = motion.path.state_at(t) == Some(lindstedt::damper::State::Free);
            prop_assert!(!free || x <= right + 1e-12, "t = {}, x = {}", t, x);
        }
        let pieces = motion.path.pieces();
        for pair in pieces.windows(2) {
            prop_assert_eq!(pair[0].end, pair[1].start);
        }
    }
}

#[test]
fn a_motion_below_all_numbers_is_refused() {
    for start in [
        Start {
            x: 1e-300,
            velocity: 0.0,
        },
        Start {
            x: 0.0,
            velocity: -1e-120,
        },
    ] {
        for integrator in [Integrator::Taylor, Integrator::RungeKutta] {
            let refused = simulate(&Model::default(), start, integrator, &Options::default()).unwrap_err();
            assert!(refused.to_string().contains("scale it up"), "{refused}");
        }
    }
}
