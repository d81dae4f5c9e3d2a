//! What is no motion is refused, and a run that breaks off keeps what it has.

use lindstedt::impact::{
    Integrator, Model, Settings, SimulationStop, Start, simulate, simulate_many,
};

use super::REST;

#[test]
fn what_is_no_motion_is_refused() {
    let refuse = |model: Model, start: Start, options: Settings| {
        simulate(&model, start, Integrator::Taylor, &options).expect_err("refused").to_string()
    };
    let (model, usual) = (Model::default(), Settings::default());
    let bad = |model: Model| refuse(model, REST, usual);
    assert!(bad(Model { zeta: -0.1, ..model }).contains("zeta must not be negative"));
    assert!(bad(Model { gamma: 0.0, ..model }).contains("gamma must be a positive number"));
    assert!(bad(Model { beta: f64::NAN, ..model }).contains("beta must be a finite number"));
    assert!(bad(Model { left: Some(0.5), ..model }).contains("must lie below"));
    let start = Start { x: f64::INFINITY, velocity: 0.0 };
    assert!(refuse(model, start, usual).contains("start must be a finite number"));
    for duration in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(refuse(model, REST, Settings { duration, ..usual }).contains("duration"));
    }
    for relative_tolerance in [0.0, 1e-16, 0.1, f64::NAN] {
        let options = Settings { relative_tolerance, ..usual };
        assert!(refuse(model, REST, options).contains("tolerance"));
    }
    let second = [(model, REST), (Model { mu: -1.0, ..model }, REST)];
    assert_eq!(simulate_many(&second, Integrator::Taylor, &usual).expect_err("refused").0, 1);
}

#[test]
fn a_motion_below_all_numbers_is_refused() {
    for start in [Start { x: 1e-300, velocity: 0.0 }, Start { x: 0.0, velocity: -1e-120 }] {
        for integrator in [Integrator::Taylor, Integrator::RungeKutta] {
            let refused =
                simulate(&Model::default(), start, integrator, &Settings::default()).unwrap_err();
            assert!(refused.to_string().contains("scale it up"), "{refused}");
        }
    }
}

#[test]
fn a_run_that_breaks_off_keeps_what_it_has() {
    let options = Settings { maximum_steps: 40, ..Settings::default() };
    let motion =
        simulate(&Model::default(), REST, Integrator::Taylor, &options).expect("it begins");
    let SimulationStop::Steps { t } = motion.stop else { panic!("{}", motion.stop) };
    assert!(t > 1.0 && t == motion.end_time && !motion.impacts.is_empty());
    assert!(
        motion.path.phase_point_at(1.0).is_some() && motion.path.phase_point_at(t + 1e-9).is_none()
    );
}
