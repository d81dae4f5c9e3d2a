//! Until when the digits of a motion are those of its start: two integrators, whose errors have
//! nothing in common, part there.

use lindstedt::Oscillator;
use lindstedt::system::Integrator;
use lindstedt::trajectory::{Trajectory, TrajectoryRequest};

fn course(equation: &str, start: f64, duration: f64) -> TrajectoryRequest {
    let mut course = TrajectoryRequest::of_equation(&Oscillator::parse(equation).expect(equation));
    course.begin("x".into(), start).expect("a state");
    course.duration = duration;
    course
}

/// How far two motions are from each other around a time, over the size of the first one.
fn apart(motions: &[Trajectory; 2], around: f64) -> f64 {
    let size = (0..1000).filter_map(|k| motions[0].states_at(0.1 * f64::from(k)));
    let size = size.fold(0.0_f64, |size, state| size.max(state[0].abs()));
    let times = (0..50).map(|k| around - 5.0 + 0.1 * f64::from(k));
    let difference =
        |time: f64| Some((motions[0].states_at(time)?[0] - motions[1].states_at(time)?[0]).abs());
    times.filter_map(difference).fold(0.0, f64::max) / size
}

#[test]
fn two_integrators_part_where_six_digits_are_lost() {
    for (equation, start) in [
        ("x'' + 0.25*x' - x + x^3 - 0.3*cos(t) = 0", 1.0),
        ("x'' + 0.05*x' + x^3 - 7.5*cos(t) = 0", 3.0),
        ("x'' + 0.05*x' + x^3 - 7.5*cos(t) = 0", 0.0),
        ("x'' + 0.5*x' + sin(x) - 1.15*cos(2*t/3) = 0", 0.2),
    ] {
        let course = course(equation, start, 400.0);
        let motions = [Integrator::Taylor, Integrator::RungeKutta]
            .map(|integrator| course.clone().follow_by(integrator).expect(equation));
        let known = motions[0].known_until().expect(equation);
        assert!((20.0..350.0).contains(&known), "{equation}: {known}");
        // Rounding errors differ from an integrator to the other, so that where they part is known
        // to a factor.
        let [before, there] = [0.8 * known, known].map(|time| apart(&motions, time));
        assert!(before < 1e-6, "{equation}: {before:e} before {known}");
        assert!((1e-8..1e-3).contains(&there), "{equation}: {there:e} at {known}");
    }
}

/// Neither a growing phase, nor a growing motion, nor friction makes digits uncertain.
#[test]
fn regular_motions_are_known_to_the_end() {
    for (equation, start) in [
        ("x'' + sin(x) = 0", 3.1),
        ("x'' + x + x^3 = 0", 20.0),
        ("x'' - x = 0", 1e-3),
        ("x'' + 0.3*sgn(x') + x - cos(0.7*t) = 0", 1.0),
        ("x'' + 0.2*x' - x + x^3 - 0.1*cos(t) = 0", 1.0),
        ("x'' + 2*(x^2 - 1)*x' + x = 0", 1e-3),
    ] {
        let motion = course(equation, start, 200.0).follow().expect(equation);
        assert_eq!(motion.known_until(), None, "{equation}");
    }
}
