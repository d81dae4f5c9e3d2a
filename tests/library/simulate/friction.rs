//! Dry friction: what it takes, and when it holds and lets go.

use lindstedt::impact::{Integrator, Model, Simulation, SimulationStop, Start};

use super::{REST, run, taylor};

#[test]
fn coulomb_friction_takes_alpha_times_the_way_and_then_holds() {
    let alpha = 0.05;
    let model = Model { alpha, right: Some(3.0), ..Model::default() };
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
    assert_eq!(motion.path.phase_point_at(99.9), Some((motion.end_x, 0.0)));
    assert!(motion.energy().residual < 1e-12);
}

#[test]
fn a_driven_pendulum_sticks_and_slips_when_the_force_says_so() {
    // From rest at x = 0: held until beta sin(Omega t) = alpha.
    let model =
        Model { alpha: 0.3, beta: 0.5, frequency_ratio: 0.8, right: Some(3.0), ..Model::default() };
    let start = Start { x: 0.0, velocity: 0.0 };
    let release = (0.3_f64 / 0.5).asin() / 0.8;
    for integrator in [Integrator::Taylor, Integrator::RungeKutta] {
        let motion = run(&model, start, 1e-12, 60.0, integrator);
        assert_eq!(motion.stop, SimulationStop::Duration, "{}", motion.stop);
        assert_eq!(motion.path.phase_point_at(0.999 * release), Some((0.0, 0.0)));
        assert!(motion.path.phase_point_at(release + 0.1).expect("t").0 > 0.0);
        let first = motion
            .path
            .pieces()
            .iter()
            .find(|piece| piece.regime != lindstedt::impact::Regime::Stuck);
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
            .filter(|piece| piece.regime == lindstedt::impact::Regime::Stuck)
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
