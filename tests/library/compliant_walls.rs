//! Walls that give way against closed forms: the speed after an impact, its duration, momentum,
//! energy, walls that move, mechanisms.

use std::f64::consts::PI;

use lindstedt::numeric::ode::quadrature::integrate_smooth;
use lindstedt::problem::Problem;
use lindstedt::system::{Integrator, PathEnd};
use lindstedt::trajectory::{Trajectory, TrajectoryRequest};

/// Laws whose restitution is 0.7 at the speed 2.
const LAWS: [&str; 5] = [
    "hunt-crossley K=1e4 restitution=0.7 speed=2",
    "hunt-crossley K=3e5 n=5/2 restitution=0.7 speed=2",
    "kelvin-voigt K=1e3 restitution=0.7",
    "kelvin-voigt-no-pull K=1e3 restitution=0.7",
    "step K=1e4 d=0.01 restitution=0.7 speed=2",
];

fn course(file: &str, start: &[(&str, f64)], until: f64) -> TrajectoryRequest {
    let mut course = file.parse::<Problem>().and_then(|file| file.course()).expect(file);
    for (name, value) in start {
        course.begin((*name).into(), *value).expect("a state");
    }
    course.duration = until;
    course
}

fn on_wall(equation: &str, bound: &str, contact: &str) -> String {
    format!("equation = \"{equation}\"\n[[wall]]\nbound = \"{bound}\"\ncontact = \"{contact}\"")
}

fn followed(course: &TrajectoryRequest, integrator: Integrator) -> Trajectory {
    let motion = course.clone().follow_by(integrator).expect("a motion");
    assert_eq!(motion.reason(), PathEnd::Reached);
    motion
}

fn end(motion: &Trajectory) -> Vec<f64> {
    motion.states_at(motion.end()).expect("a state")
}

#[test]
fn a_free_mass_leaves_with_the_restitution_that_its_contact_was_given() {
    for law in LAWS {
        let course = course(&on_wall("5/2*x'' = 0", "x < 1", law), &[("x'", 2.0)], 2.0);
        for integrator in [Integrator::Taylor, Integrator::RungeKutta] {
            let motion = followed(&course, integrator);
            let speed = end(&motion)[1];
            assert!((speed / -1.4 - 1.0).abs() < 1e-9, "{law}, {integrator:?}: {speed}");
        }
    }
}

/// The duration follows from the place at the end: T = t - 1/v - (1 - x)/(e v).
#[test]
fn contacts_last_as_long_as_their_closed_forms() {
    let (mass, speed): (f64, f64) = (2.5, 2.0);
    let hertz = {
        // T = (2 D/v) int_0^1 dy/sqrt(1 - y^(5/2)), y = 1 - u^2.
        let depth = (1.25 * mass * speed * speed / 1e4).powf(0.4);
        let inverse = |u: f64| 2.0 * u / (-(2.5 * (-u * u).ln_1p()).exp_m1()).sqrt();
        2.0 * depth / speed * integrate_smooth(inverse, 0.0, 1.0, 1e-13).expect("an integral").0
    };
    let omega = (1e3 / mass).sqrt();
    let pulled = {
        let loss = -0.7_f64.ln();
        let zeta = loss / PI.hypot(loss);
        PI / (omega * (1.0 - zeta * zeta).sqrt())
    };
    for (law, e, expected) in [("hertz K=1e4", 1.0, hertz), (LAWS[2], 0.7, pulled)] {
        let course = course(&on_wall("5/2*x'' = 0", "x < 1", law), &[("x'", speed)], 2.0);
        let motion = followed(&course, Integrator::Taylor);
        let [x, v] = end(&motion)[..] else { panic!() };
        assert!((v + e * speed).abs() < 1e-11, "{law}: {v}");
        let lasted = 2.0 - 1.0 / speed - (1.0 - x) / (e * speed);
        assert!((lasted / expected - 1.0).abs() < 1e-8, "{law}: {lasted}, not {expected}");
    }
}

/// Masses 1 and 3 in a row, and a wall between them: momentum is kept, the relative speed is turned.
#[test]
fn bodies_keep_their_momentum_and_lose_what_the_restitution_says() {
    for law in LAWS {
        let file = on_wall("x'' = 0; 3*y'' = 0", "x < y", law);
        let course = course(&file, &[("x", -1.0), ("x'", 1.5), ("y'", -0.5)], 2.0);
        let motion = followed(&course, Integrator::Taylor);
        for step in 0..=40 {
            let state = motion.states_at(f64::from(step) / 20.0).expect("a state");
            assert!((state[2] + 3.0 * state[3]).abs() < 1e-11, "{law}: {state:?}");
        }
        let state = end(&motion);
        assert!((state[3] - state[2] - 1.4).abs() < 1e-8, "{law}: {state:?}");
    }
}

/// A wall that moves away uniformly is a wall at rest in its own frame.
#[test]
fn the_velocity_of_a_moving_wall_counts() {
    for law in LAWS {
        let course = course(&on_wall("5/2*x'' = 0", "x < 1 + t", law), &[("x'", 3.0)], 2.0);
        let speed = end(&followed(&course, Integrator::Taylor))[1];
        assert!((speed - (1.0 - 1.4)).abs() < 1e-8, "{law}: {speed}");
    }
}

/// A free particle in polar coordinates at a straight wall: the velocity along the wall stays.
#[test]
fn a_mechanism_is_pushed_along_the_gradient_of_the_gap() {
    let file = "[lagrangian]\ncoordinates = [\"r\", \"p\"]\nkinetic = \"5/4*(r'^2 + r^2*p'^2)\"\n\
        [[wall]]\nbound = \"r*cos(p) < 1\"\ncontact = \"hunt-crossley K=1e4 restitution=0.7 speed=2\"";
    // From (x, y) = (0.5, 0.5) with the velocity (2, 0.3).
    let (r, angle) = (0.5_f64.sqrt(), 0.25 * PI);
    let [along, across] = [(2.0 + 0.3) / 2.0_f64.sqrt(), (0.3 - 2.0) / 2.0_f64.sqrt()];
    let start = [("r", r), ("p", angle), ("r'", along), ("p'", across / r)];
    let motion = followed(&course(file, &start, 0.6), Integrator::Taylor);
    let [r, p, radial, turning] = end(&motion)[..4] else { panic!() };
    let x = radial * p.cos() - r * turning * p.sin();
    let y = radial * p.sin() + r * turning * p.cos();
    assert!((x + 1.4).abs() < 1e-9 && (y - 0.3).abs() < 1e-9, "{x} {y}");
    let balance = motion.balance.as_ref().expect("an energy");
    let lost = 1.25 * (4.0 - 1.96);
    assert!((balance.work + lost).abs() < 1e-9 && balance.residual < 1e-11, "{balance:?}");
}

#[test]
fn the_energy_that_a_contact_takes_is_accounted_for() {
    for law in LAWS {
        let course = course(&on_wall("5/2*x'' = 0", "x < 1", law), &[("x'", 2.0)], 2.0);
        let motion = followed(&course, Integrator::Taylor);
        let balance = motion.balance.as_ref().expect("an energy");
        assert!(balance.residual < 1e-10, "{law}: {balance:?}");
    }
}
