//! Drives much shorter than the motion: closed forms of what rings after them, by both integrators.

use std::f64::consts::PI;

use lindstedt::system::{Integrator, PathEnd};
use lindstedt::trajectory::{Trajectory, TrajectoryRequest};
use lindstedt::{Oscillator, Symbol};

fn followed(equation: &str, start: f64, duration: f64) -> [Trajectory; 2] {
    [Integrator::Taylor, Integrator::RungeKutta].map(|integrator| {
        let mut course =
            TrajectoryRequest::of_equation(&Oscillator::parse(equation).expect(equation));
        course.begin(Symbol::new("x"), start).expect("a state");
        course.duration = duration;
        // Runge-Kutta sees the rounding of a steep argument.
        if integrator == Integrator::RungeKutta {
            course.tolerance = 1e-12;
        }
        course.energy = None;
        let motion = course.follow_by(integrator).expect(equation);
        assert_eq!(motion.reason(), PathEnd::Reached, "{equation}");
        motion
    })
}

fn place(motion: &Trajectory, time: f64) -> f64 {
    motion.states_at(time).expect("a state")[0]
}

/// `x'' + 2 z x' + x = a exp(-((t - s)/w)^2)` rings behind it as
/// `a w sqrt(pi) Im[e^(l (t - s) + (l w)^2/4)]/W`, `l = -z + i W`.
fn ringing(time: f64, height: f64, width: f64) -> f64 {
    let (damping, frequency) = (-0.1, (1.0 - 0.01_f64).sqrt());
    let quarter = 0.25 * width * width;
    let size = (damping * time + quarter * (damping * damping - frequency * frequency)).exp();
    let phase = frequency * time + 2.0 * quarter * damping * frequency;
    height * width * PI.sqrt() * size * phase.sin() / frequency
}

#[test]
fn a_short_pulse_rings() {
    for (height, rate) in [(50.0, 1e2), (50e3, 1e5), (2.0, 4.0)] {
        let equation = format!("x'' + 0.2*x' + x = {height}*exp(-((t-20)*{rate})^2)");
        for motion in followed(&equation, 0.0, 40.0) {
            assert!(place(&motion, 12.0).abs() < 1e-12, "{equation}");
            for time in [22.5, 25.0, 31.3, 40.0] {
                let (found, expected) =
                    (place(&motion, time), ringing(time - 20.0, height, 1.0 / rate));
                assert!((found - expected).abs() < 1e-9, "{equation}, {time}: {found} {expected}");
            }
        }
    }
}

/// What a pulse has done is accounted for, however steep it is: its argument stays as it was typed.
#[test]
fn the_work_of_a_steep_pulse_closes_the_account() {
    for equation in [
        "x'' + 0.2*x' + x = 50e3*exp(-((t-20)*1e5)^2)",
        "x'' + 0.2*x' + x + x^3*(1 + t)/100 = 1e4/(1 + ((t - 7.3)*1e6)^2)",
        "x'' + x*(1 + 1e3*exp(-((t - 5)*1e4)^2)) = 0",
    ] {
        for integrator in [Integrator::Taylor, Integrator::RungeKutta] {
            let mut course =
                TrajectoryRequest::of_equation(&Oscillator::parse(equation).expect(equation));
            course.begin(Symbol::new("x"), 0.3).expect("a state");
            course.duration = 30.0;
            if integrator == Integrator::RungeKutta {
                course.tolerance = 1e-12;
            }
            let balance = course.follow_by(integrator).expect(equation).balance.expect("a balance");
            assert!(balance.residual < 1e-9, "{equation} by {integrator:?}: {balance:?}");
        }
    }
}

/// Two pulses of opposite sign, half a period apart, in a sum with a wave: all superposed.
#[test]
fn every_pulse_of_several_counts() {
    let equation =
        "x'' + 0.2*x' + x = 50*exp(-((t-20)*100)^2) - 30*exp(-((t-23.1)*1000)^2) + cos(2*t)";
    let quiet = followed("x'' + 0.2*x' + x = cos(2*t)", 0.3, 40.0);
    for (motion, quiet) in followed(equation, 0.3, 40.0).iter().zip(&quiet) {
        for time in [25.0, 31.3, 40.0] {
            let expected = place(quiet, time) + ringing(time - 20.0, 50.0, 1e-2)
                - ringing(time - 23.1, 30.0, 1e-3);
            let found = place(motion, time);
            assert!((found - expected).abs() < 1e-9, "{time}: {found} {expected}");
        }
    }
}

/// `x'' = -tanh'(...)`: a speed that goes from one value to another within a hundred-thousandth,
/// and a Lorentzian pulse with its tails.
#[test]
fn a_switch_and_a_pulse_with_tails() {
    for motion in followed("x'' + tanh((t - 7.3)*1e5) = 0", 0.0, 20.0) {
        let expected = 0.5 * 20.0_f64.powi(2) - 12.7_f64.powi(2);
        assert!((place(&motion, 20.0) - expected).abs() < 1e-8, "{}", place(&motion, 20.0));
    }
    // The integral of (T - t)/(1 + ((t - s)/w)^2).
    for motion in followed("x'' = 1e3/(1 + ((t - 7.3)*1e3)^2)", 0.0, 20.0) {
        let (ahead, behind) = (12.7e3_f64, 7.3e3_f64);
        let expected = 12.7 * (ahead.atan() + behind.atan())
            - 0.5e-3 * ((1.0 + ahead * ahead) / (1.0 + behind * behind)).ln();
        assert!(
            (place(&motion, 20.0) - expected).abs() < 1e-8,
            "{} {expected}",
            place(&motion, 20.0)
        );
    }
}

/// A coefficient that is there for a moment: `x'' + (1 + k delta(t - s)) x = 0` to first order in
/// the width.
#[test]
fn a_stiffness_for_a_moment_kicks() {
    for motion in followed("x'' + x + 1e5*exp(-((t - 20)*1e5)^2)*x = 0", 1.0, 40.0) {
        let expected = 40.0_f64.cos() - PI.sqrt() * 20.0_f64.cos() * 20.0_f64.sin();
        assert!(
            (place(&motion, 40.0) - expected).abs() < 1e-4,
            "{} {expected}",
            place(&motion, 40.0)
        );
    }
}

/// Dry friction holds until a pulse frees it, however short.
#[test]
fn a_short_pulse_frees_what_friction_holds() {
    for motion in followed("x'' + x + 0.5*sgn(x') = 50*exp(-((t-20)*100)^2)", 0.1, 40.0) {
        let held: Vec<[f64; 2]> = motion.sticking_intervals().collect();
        assert!(
            held.first().is_some_and(|[from, until]| *from < 1.0 && (until - 20.0).abs() < 0.05),
            "{held:?}"
        );
        assert!(place(&motion, 21.0) > 0.3);
    }
}

/// A swing that ends at the edge of what friction holds, but for rounding, is held: it falls by 0.6
/// each half period of pi, until 0.3 is left. With its energy and without, for that changes the
/// steps.
#[test]
fn what_ends_at_the_edge_of_what_friction_holds_is_held() {
    let equation = Oscillator::parse("x'' + x + 0.3*sgn(x') = 0").expect("an equation");
    for half_periods in 1..=5_u32 {
        let start = 0.3 + 0.6 * f64::from(half_periods);
        let rests_at = if half_periods % 2 == 0 { 0.3 } else { -0.3 };
        for with_energy in [true, false] {
            let mut course = TrajectoryRequest::of_equation(&equation);
            course.begin(Symbol::new("x"), start).expect("a state");
            course.duration = 60.0;
            if !with_energy {
                course.energy = None;
            }
            let motion = course.follow().expect("a motion");
            let held: Vec<[f64; 2]> = motion.sticking_intervals().collect();
            let [[from, until]] = held.as_slice() else {
                panic!("{start}: {held:?}");
            };
            let rests = std::f64::consts::PI * f64::from(half_periods);
            assert!((from - rests).abs() < 1e-6 && *until == 60.0, "{start}: {held:?}");
            assert!((place(&motion, 50.0) - rests_at).abs() < 1e-9);
        }
    }
}
