//! Wells, walls and switches much narrower than the motion, in place or on their way: closed forms
//! by the energy, by both integrators.

use std::f64::consts::PI;

use lindstedt::system::{Integrator, PathEnd};
use lindstedt::trajectory::{Trajectory, TrajectoryRequest};
use lindstedt::{Oscillator, Symbol};

/// By power series, and by Runge-Kutta where two are wanted.
fn followed(equation: &str, start: [f64; 2], duration: f64, count: usize) -> Vec<Trajectory> {
    let integrators = [Integrator::Taylor, Integrator::RungeKutta].into_iter().take(count);
    let motion = |integrator: Integrator| {
        let mut course =
            TrajectoryRequest::of_equation(&Oscillator::parse(equation).expect(equation));
        course.begin(Symbol::new("x"), start[0]).expect("a state");
        course.begin(Symbol::new("x'"), start[1]).expect("a state");
        course.duration = duration;
        course.energy = None;
        // Runge-Kutta sees the rounding of a steep argument.
        if integrator == Integrator::RungeKutta {
            course.tolerance = 1e-12;
        }
        let motion = course.follow_by(integrator).expect(equation);
        assert_eq!(motion.reason(), PathEnd::Reached, "{equation} {integrator:?}");
        motion
    };
    integrators.map(motion).collect()
}

fn least(motion: &Trajectory) -> f64 {
    motion.extremes()[0][0]
}

/// A bump in the force that is crossed on the way in: `x_m^2/2 = 1/2 + integral`, for a bell and
/// for a pole beside the real line.
#[test]
fn a_narrow_bump_in_place_gives_its_work() {
    for width in [1e-2_f64, 1e-4, 1e-6, 1e-8] {
        let height = 0.1 / width;
        let work = 0.1 * PI.sqrt();
        let bell = format!("x'' + x + {height}*exp(-((x - 0.5)/{width})^2) = 0");
        for motion in followed(&bell, [1.0, 0.0], 20.0, 2) {
            let expected = -(1.0 + 2.0 * work).sqrt();
            let found = least(&motion);
            // The place in a well so narrow is known to rounding only.
            let allowed = 1e-9 + 1e-15 / width;
            assert!(
                (found - expected).abs() < allowed,
                "{bell}, {:?}: {found} {expected}",
                motion.integrator
            );
            // Back where it began: what it has gained it gives back.
            assert!((motion.extremes()[0][1] - 1.0).abs() < 2.0 * allowed, "{bell}");
        }
    }
    for width in [1e-4_f64, 1e-8] {
        let height = 0.1 / width;
        let pole = format!("x'' + x + {height}/(1 + ((x - 0.5)/{width})^2) = 0");
        let potential = |x: f64| 0.5 * x * x + 0.1 * ((x - 0.5) / width).atan();
        // What is rounding of so steep an argument is more than Runge-Kutta can step through.
        let motions = followed(&pole, [1.0, 0.0], 5.0, if width < 1e-6 { 1 } else { 2 });
        for motion in motions {
            let found = least(&motion);
            assert!(
                (potential(found) - potential(1.0)).abs() < 1e-9 + 1e-15 / width,
                "{pole}, {:?}: {found}",
                motion.integrator
            );
        }
    }
}

/// A force that changes within a ten-thousandth of the way, and one that does so at a velocity.
#[test]
fn a_steep_switch_is_taken_where_it_is() {
    for rate in [1e2, 1e5, 1e8] {
        let equation = format!("x'' + x + tanh({rate}*(x - 0.5))/5 = 0");
        // x^2/2 + |x - 1/2|/5 is kept, but for ln 2/rate at the corner.
        let expected = 0.2 - (0.04 + 1.0_f64).sqrt();
        for motion in followed(&equation, [1.0, 0.0], 20.0, 2) {
            let found = least(&motion);
            assert!((found - expected).abs() < 1e-9, "{equation}: {found} {expected}");
        }
    }
    // Beyond the speed 1/2 the force is less by 1/2: w = x' obeys w' = 1 - H(w - 1/2)/2.
    for motion in followed("x'' = 3/4 - tanh(1e6*(x' - 1/2))/4", [0.0, 0.0], 2.0, 2) {
        let expected = 0.125 + 1.5 * 0.5 + 0.25 * 1.5 * 1.5;
        let found = motion.states_at(2.0).expect("a state")[0];
        assert!((found - expected).abs() < 1e-6, "{:?}: {found} {expected}", motion.integrator);
    }
}

/// A pulse that moves: in its own frame the energy is kept, `y'^2/2 - V(y)`, `y = x - u t - s`.
#[test]
fn a_pulse_that_meets_the_motion_on_its_way_counts() {
    for width in [1e-3_f64, 1e-6] {
        let height = 0.1 / width;
        let equation = format!("x'' = {height}*exp(-((x - 0.3*t + 4)/{width})^2)");
        let work = 0.1 * PI.sqrt();
        for motion in followed(&equation, [0.0, -0.7], 10.0, 2) {
            let expected = 0.3 - (1.0 - 2.0 * work).sqrt();
            let found = motion.states_at(10.0).expect("a state")[1];
            assert!((found - expected).abs() < 1e-9, "{equation}: {found} {expected}");
        }
    }
}

/// A wall that is nothing before it and everything behind it: `x^n/n = 1/2` where it turns back.
#[test]
fn a_wall_is_not_gone_through() {
    for power in [31, 101, 401] {
        let equation = format!("x'' + x^{power} = 0");
        let order = f64::from(power + 1);
        let expected = -(0.5 * order).powf(1.0 / order);
        for motion in followed(&equation, [0.0, 1.0], 12.0, 2) {
            let found = least(&motion);
            assert!(
                (found - expected).abs() < 1e-9,
                "{equation}, {:?}: {found} {expected}",
                motion.integrator
            );
        }
    }
}
