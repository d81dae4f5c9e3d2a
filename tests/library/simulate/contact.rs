//! The contact: restitution, no pull, and motions that lean on a barrier.

use lindstedt::impact::{Integrator, Model, SimulationStop, Start};
use lindstedt::numeric::ode::root::find_root;

use super::{REST, run, taylor};

#[test]
fn restitution_of_hunt_and_crossley() {
    // lambda v (1 + e) = ln((1 + lambda v)/(1 - lambda e v)), whatever the stiffness: without
    // gravity, which a hard contact does not notice.
    for (lambda_v, expected) in [(0.1, 0.937_475_580), (0.3, 0.832_869_792), (1.0, 0.593_624_260)] {
        let gamma = 1e12;
        let speed = 1.0;
        let model =
            Model { gamma, mu: lambda_v / speed * gamma, right: Some(0.0), ..Model::default() };
        let start = Start { x: 0.0, velocity: speed };
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
    let model = Model { mu: 1e6, gamma: 1e4, zeta: 0.01, ..Model::default() };
    let motion = taylor(&model, REST, 1e-12, 20.0);
    let judge = run(&model, REST, 1e-13, 20.0, Integrator::RungeKutta);
    assert!(
        motion
            .path
            .pieces()
            .iter()
            .any(|piece| matches!(piece.regime, lindstedt::impact::Regime::Detached(_)))
    );
    assert!(motion.difference(&judge, 2001).displacement < 1e-8);
    assert!(motion.energy().residual < 1e-9, "{:?}", motion.energy());
    for impact in motion.impacts.iter().filter(|impact| impact.exit_time.is_some()) {
        let out = impact.speed_out.expect("left");
        assert!(out > 0.0 && out < impact.speed_in);
    }
}

#[test]
fn it_settles_on_a_barrier_that_it_leans_on() {
    let model = Model { zeta: 0.05, gamma: 1e3, mu: 1e4, right: Some(-0.3), ..Model::default() };
    for start in [REST, Start { x: -0.3, velocity: 0.0 }] {
        let motion = taylor(&model, start, 1e-10, 200.0);
        assert_eq!(motion.stop, SimulationStop::Duration, "{}", motion.stop);
        // Gravity against the barrier: sin(0.3 - d) = gamma d^(3/2).
        let depth =
            find_root(|d| (0.3 - d).sin() - model.gamma * d.powf(1.5), 0.0, 0.3).expect("a depth");
        assert!((motion.end_x + 0.3 - depth).abs() < 1e-7, "{}", motion.end_x);
        assert!(motion.impacts.last().expect("contact").exit_time.is_none());
        assert!(motion.energy().residual < 1e-9);
    }
}

#[test]
fn no_barrier_is_certain_only_where_the_energy_does_not_reach_it() {
    let free = |barrier: f64, beta: f64| {
        let model = Model { right: Some(barrier), beta, frequency_ratio: 0.5, ..Model::default() };
        let motion = taylor(&model, REST, 1e-9, 1.0);
        assert!(!motion.touches());
        motion.never_touches()
    };
    for (barrier, never) in
        [(0.5, false), (1.499, false), (1.501, true), (1.55, true), (3.0, true), (4.0, true)]
    {
        assert_eq!(free(barrier, 0.0), never, "{barrier}");
        // What is driven may get anywhere.
        assert!(!free(barrier, 0.01));
    }
}

/// A run that is to end within a contact ends there, however near to the release: the step that
/// reaches beyond the release, where time would run backwards, must not hide it.
#[test]
fn a_run_ends_on_time_next_to_a_release() {
    for (gamma, mu) in [(1e6, 0.0), (1e6, 1e4), (300.0, 50.0)] {
        let model = Model { gamma, mu, ..Model::default() };
        let long = taylor(&model, REST, 1e-11, 12.0);
        for contact in &long.impacts[..2] {
            let (entry, exit) = (contact.entry_time, contact.exit_time.expect("left"));
            for before in [0.3, 0.1, 1e-2, 1e-3, 1e-5] {
                let duration = exit - before * (exit - entry);
                let motion = taylor(&model, REST, 1e-11, duration);
                assert_eq!(motion.end_time, duration, "{gamma} {mu} {before}");
                assert_eq!(motion.impacts.last().expect("a contact").exit_time, None);
                let (x, velocity) = long.path.phase_point_at(duration).expect("a place");
                assert!((motion.end_x - x).abs() < 1e-10, "{} and {x}", motion.end_x);
                assert!(
                    (motion.end_velocity - velocity).abs() < 1e-7,
                    "{} and {velocity}",
                    motion.end_velocity
                );
            }
        }
    }
}
