//! One integrator against the other, and against itself a hundred times tighter.

use lindstedt::impact::{
    Friction, Integrator, Model, Settings, SimulationStop, Start, known_until, simulate,
};

use super::{REST, run, taylor};

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
        Model { friction: Friction::Arctangent, ..damped },
        Model { beta: 0.0, ..damped },
        Model { alpha: 0.35, beta: 0.6, ..damped },
    ] {
        let fast = taylor(&model, start, 1e-13, 40.0);
        let judge = run(&model, start, 1e-13, 40.0, Integrator::RungeKutta);
        assert_eq!(judge.stop, SimulationStop::Duration, "{}", judge.stop);
        assert_eq!(fast.stop, SimulationStop::Duration, "{}", fast.stop);
        assert_eq!(fast.impacts.len(), judge.impacts.len(), "{model:?}");
        for (one, other) in fast.impacts.iter().zip(&judge.impacts) {
            assert_eq!(one.side, other.side);
            assert!((one.entry_time - other.entry_time).abs() < 1e-8, "{one:?} {other:?}");
        }
        for index in 0..=400 {
            let t = 0.1 * f64::from(index);
            let ((x, v), (judge_x, judge_v)) =
                (fast.path.phase_point_at(t).expect("t"), judge.path.phase_point_at(t).expect("t"));
            assert!(
                (x - judge_x).abs() < 1e-7 && (v - judge_v).abs() < 1e-6,
                "{model:?} {t}: {} {}",
                x - judge_x,
                v - judge_v
            );
        }
        assert!(fast.energy().residual < 1e-9, "{:?}", fast.energy());
        assert!(judge.energy().residual < 1e-7, "{:?}", judge.energy());
        println!("{:?} {} turns, {} impacts", fast.energy(), fast.turns.len(), fast.impacts.len());
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
fn two_barriers_are_mirror_images() {
    let model = Model {
        gamma: 1e6,
        zeta: 0.01,
        alpha: 0.02,
        beta: 0.25,
        frequency_ratio: 0.9,
        mu: 3e4,
        left: Some(-0.6),
        right: Some(0.35),
        ..Model::default()
    };
    let mirrored = Model { beta: -model.beta, left: Some(-0.35), right: Some(0.6), ..model };
    let start = Start { x: 0.1, velocity: 1.1 };
    let image = Start { x: -0.1, velocity: -1.1 };
    for integrator in [Integrator::Taylor, Integrator::RungeKutta] {
        let one = run(&model, start, 1e-12, 40.0, integrator);
        let other = run(&mirrored, image, 1e-12, 40.0, integrator);
        assert!(one.impacts.len() > 10 && one.impacts.len() == other.impacts.len());
        for (one, other) in one.impacts.iter().zip(&other.impacts) {
            assert_ne!(one.side, other.side);
            assert!((one.entry_time - other.entry_time).abs() < 1e-11);
            assert!((one.penetration - other.penetration).abs() < 1e-11);
        }
        assert!(
            (one.end_x + other.end_x).abs() < 1e-10
                && (one.end_velocity + other.end_velocity).abs() < 1e-10
        );
    }
    // Symmetric barriers and start: every other half swing is the mirror image of the one before.
    let symmetric = Model { left: Some(-0.4), right: Some(0.4), ..Model::default() };
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
    let base = Model { gamma: 1e6, zeta: 0.015, mu: 5e4, ..Model::default() };
    for model in [
        base,
        Model { alpha: 0.02, ..base },
        Model { alpha: 0.02, friction: Friction::Arctangent, ..base },
        Model { beta: 0.2, frequency_ratio: 1.4, ..base },
        Model { alpha: 0.02, beta: 0.2, frequency_ratio: 1.4, left: Some(-0.7), ..base },
    ] {
        let start = Start { x: -0.65, velocity: 0.4 };
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

/// A contact whose damping outweighs its stiffness at the speed of the touch: both integrators
/// follow it alike.
#[test]
fn a_touch_faster_than_the_contact_relaxes() {
    let model = Model { gamma: 1e4, mu: 4e4, ..Model::default() };
    let [one, other] = [Integrator::Taylor, Integrator::RungeKutta]
        .map(|integrator| run(&model, REST, 1e-11, 12.0, integrator));
    assert_eq!(one.impacts.len(), other.impacts.len());
    let first = one.impacts[0];
    assert!(first.speed_in * model.mu > 4.0 * model.gamma, "{first:?}");
    for (one, other) in one.impacts.iter().zip(&other.impacts) {
        assert!((one.penetration / other.penetration - 1.0).abs() < 1e-6, "{one:?} {other:?}");
        let [out, judged] = [one, other].map(|impact| impact.speed_out.expect("an exit"));
        assert!((out / judged - 1.0).abs() < 1e-5, "{one:?} {other:?}");
    }
}

/// Where six digits are lost to a chaotic drive, there the integrators part; without chaos, or a
/// drive, they are kept.
#[test]
fn a_chaotic_motion_is_known_until_the_integrators_part() {
    let still = Start { x: 0.0, velocity: 0.0 };
    let driven = |beta: f64, frequency_ratio: f64, barrier: f64| Model {
        gamma: 1e4,
        mu: 500.0,
        zeta: 0.01,
        beta,
        frequency_ratio,
        right: Some(barrier),
        ..Model::default()
    };
    let settings = Settings {
        duration: 400.0,
        relative_tolerance: 1e-12,
        absolute_tolerance: 1e-14,
        ..Settings::default()
    };
    for (beta, frequency_ratio, barrier) in [(0.7, 2.1, 0.05), (1.2, 0.9, 0.1), (1.0, 2.5, 0.0)] {
        let model = driven(beta, frequency_ratio, barrier);
        let [series, judge] = [Integrator::Taylor, Integrator::RungeKutta]
            .map(|integrator| simulate(&model, still, integrator, &settings).expect("a motion"));
        let known = known_until(&series).expect("a chaotic motion");
        let apart = |from: f64, to: f64| {
            let times = (0..200).map(|k| from + (to - from) * f64::from(k) / 200.0);
            let places = times.filter_map(|t| {
                Some((series.path.phase_point_at(t)?.0 - judge.path.phase_point_at(t)?.0).abs())
            });
            places.fold(0.0, f64::max)
        };
        let places = (0..400).filter_map(|t| series.path.phase_point_at(f64::from(t)));
        let size = places.fold(0.0, |size: f64, (x, _)| size.max(x.abs()));
        let (before, after) =
            (apart(0.0, 0.8 * known) / size, apart(known, (1.6 * known).min(400.0)) / size);
        assert!((20.0..350.0).contains(&known), "{beta} {frequency_ratio}: {known}");
        assert!(
            before < 1e-6 && after > 1e-6,
            "{beta} {frequency_ratio}: {before:e}, {after:e} around {known}"
        );
    }
    for model in [driven(0.8, 0.6, 0.2), driven(0.0, 1.0, 0.2)] {
        let start = Start { x: -0.5, velocity: 0.0 };
        let motion = simulate(&model, start, Integrator::Taylor, &settings).expect("a motion");
        assert_eq!(known_until(&motion), None);
    }
}
