//! The damper against truths that it does not know: elliptic functions, quadrature, the other integrator, itself with
//! a tighter tolerance.

use lindstedt::damper::{Friction, Integrator, Model, Options, Simulation, Start, Stop, simulate};
use lindstedt::ode::quadrature::integrate_smooth;
use lindstedt::ode::root::find_root;

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

fn taylor(model: &Model, start: Start, tolerance: f64, duration: f64) -> Simulation {
    run(model, start, tolerance, duration, Integrator::Taylor)
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
