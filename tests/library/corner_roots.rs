//! Powers such as 3/2 that begin at a corner, written with `max`, `min` or `abs`: against the
//! energy, a period in closed form, the same force behind a step, and between several bodies the
//! laws of impact and fixed steps of the classical Runge-Kutta method.

use std::collections::BTreeMap;

use lindstedt::mechanics::Mechanism;
use lindstedt::system::Integrator;
use lindstedt::trajectory::{Trajectory, TrajectoryRequest};
use lindstedt::{Oscillator, Symbol};

fn follow(equation: &str, start: f64, until: f64) -> TrajectoryRequest {
    let mut course =
        TrajectoryRequest::of_equation(&Oscillator::parse(equation).expect("an oscillator"));
    course.begin("x".into(), start).expect("a state");
    course.duration = until;
    course
}

fn by_both_routes(course: &TrajectoryRequest) -> [Trajectory; 2] {
    [course.clone().follow(), course.clone().follow_by(Integrator::RungeKutta)].map(|motion| {
        let motion = motion.expect("a motion");
        assert!(motion.is_complete(), "{}: {:?}", motion.end(), motion.reason());
        motion
    })
}

/// A mass strikes a Hertzian stop at every swing: `x'^2/2 + x^2/2 + 2/5 k d^(5/2)` stays what it
/// was, in whatever form the stop is written.
#[test]
fn a_contact_without_a_step_keeps_its_energy() {
    let forms = [
        "1e4*max(x - 0.5, 0)^(3/2)",
        "k*max(0, x - d)^n",
        "2500*sqrt(2)*max(2*x - 1, 0)^(3/2)",
        "1e4*max(x - 0.5, 0)*sqrt(max(x - 0.5, 0))",
        "1e4*(-min(0.5 - x, 0))^(3/2)",
        "1e4*((x - 0.5 + abs(x - 0.5))/2)^(3/2)",
        "k*(x - d)^n*H(x - d)",
        "max(k*max(x - d, 0)^(3/2), 0)",
    ];
    for form in forms {
        let mut course = follow(&format!("x'' + x + {form} = 0"), -1.0, 20.0);
        let values =
            [("k", 1e4), ("d", 0.5), ("n", 1.5)].map(|(name, value)| (Symbol::new(name), value));
        let needed = course.parameters();
        course.values = values.into_iter().filter(|(name, _)| needed.contains(name)).collect();
        for motion in by_both_routes(&course) {
            let mut deepest = 0.0_f64;
            for index in 0..=4000 {
                let state = motion.states_at(20.0 * f64::from(index) / 4000.0).expect("a state");
                let depth = (state[0] - 0.5).max(0.0);
                deepest = deepest.max(depth);
                let energy =
                    0.5 * (state[1] * state[1] + state[0] * state[0]) + 4e3 * depth.powf(2.5);
                assert!((energy - 0.5).abs() < 1e-10, "{form}: {energy} at {index}");
            }
            assert!(deepest > 0.01, "{form}: {deepest}");
        }
    }
}

/// `x'' + sgn(x) abs(x)^n = 0` from 1: the period is `4 sqrt((n + 1)/2) sqrt(pi)/(n + 1)
/// Gamma(1/(n + 1))/Gamma(1/(n + 1) + 1/2)`.
#[test]
fn a_power_of_the_absolute_value_has_its_period() {
    let periods = [
        ("sgn(x)*abs(x)^(3/2)", 6.581_363_388_638_262_5),
        ("x*sqrt(abs(x))", 6.581_363_388_638_262_5),
        ("sgn(x)*sqrt(abs(x))", 5.974_673_601_777_492),
        ("max(x, 0)^(3/2) - max(-x, 0)^(3/2)", 6.581_363_388_638_262_5),
    ];
    for (force, period) in periods {
        for motion in by_both_routes(&follow(&format!("x'' + {force} = 0"), 1.0, 3.0 * period)) {
            for (time, expected) in [(0.5, -1.0), (1.0, 1.0), (2.5, -1.0), (3.0, 1.0)] {
                let state = motion.states_at(time * period).expect("a state");
                let astray = (state[0] - expected).abs().max(state[1].abs());
                assert!(astray < 1e-8, "{force}: {state:?} after {time} periods");
            }
        }
    }
}

/// A potential `2/5 k max(q - d, 0)^(5/2)` of a mechanism, beside the same behind a step.
#[test]
fn a_potential_without_a_step_is_followed() {
    let [largest, gated] = ["max(q - d, 0)^(5/2)", "(q - d)^(5/2)*H(q - d)"].map(|contact| {
        let potential = format!("q^2/2 + 2/5*k*{contact}");
        let mechanism = Mechanism::parse(&["q"], "q'^2/2", &potential).expect("a mechanism");
        let equations = mechanism.equations().expect("equations");
        let mut course =
            TrajectoryRequest::of_mechanism(&mechanism, &equations).expect("accelerations");
        course.begin("q".into(), -1.0).expect("a state");
        course.duration = 20.0;
        course.values = BTreeMap::from([(Symbol::new("k"), 1e4), (Symbol::new("d"), 0.5)]);
        let motion = course.follow().expect("a motion");
        assert!(motion.is_complete(), "{contact}: {:?}", motion.reason());
        assert!(motion.balance.as_ref().expect("an energy").residual < 1e-11, "{contact}");
        motion
    });
    assert!(largest.difference(&gated) < 1e-9, "{}", largest.difference(&gated));
}

/// What has no value below zero has none: no root is taken of a size.
#[test]
fn a_root_that_leaves_its_range_still_ends_the_motion() {
    let edges = [
        ("max(x, -1/2)^(3/2)", 0.0),
        ("(x + abs(x)/2)^(3/2)", 0.0),
        ("x/5 + sqrt(abs(x) - 1/4)", 0.25),
    ];
    for (force, edge) in edges {
        let motion = follow(&format!("x'' + {force} = 0"), 1.0, 20.0).follow().expect("a motion");
        assert!(!motion.is_complete(), "{force}");
        let end = motion.states_at(motion.end()).expect("a state")[0];
        assert!((end - edge).abs() < 1e-3, "{force}: {end}");
    }
}

/// A motion of several bodies, by its potential, its dissipation and its forces.
fn bodies(
    coordinates: &[&str],
    [kinetic, potential, dissipation]: [&str; 3],
    forces: &[(&str, &str)],
    start: &[(&str, f64)],
    until: f64,
) -> TrajectoryRequest {
    let mut mechanism = Mechanism::parse(coordinates, kinetic, potential).expect("a mechanism");
    mechanism.dissipation = dissipation.parse().expect("a dissipation");
    for (coordinate, force) in forces {
        let force = force.parse().expect("a force");
        mechanism.forces.insert(Symbol::new(coordinate), force);
    }
    let equations = mechanism.equations().expect("equations");
    let mut course =
        TrajectoryRequest::of_mechanism(&mechanism, &equations).expect("accelerations");
    for (name, value) in start {
        course.begin(Symbol::new(name), *value).expect("a state");
    }
    course.duration = until;
    course.values = course
        .parameters()
        .into_iter()
        .map(|name| (name, if name.name() == "K" { 1e4 } else { 0.5 }))
        .collect();
    course
}

/// The states at the end, in fixed steps of the classical Runge-Kutta method.
fn in_fixed_steps<const N: usize>(
    rates: impl Fn(f64, [f64; N]) -> [f64; N],
    mut state: [f64; N],
    until: f64,
    steps: u32,
) -> [f64; N] {
    let step = until / f64::from(steps);
    let moved = |state: [f64; N], rates: [f64; N], by: f64| {
        std::array::from_fn(|i| state[i] + by * rates[i])
    };
    for index in 0..steps {
        let time = step * f64::from(index);
        let first = rates(time, state);
        let second = rates(time + 0.5 * step, moved(state, first, 0.5 * step));
        let third = rates(time + 0.5 * step, moved(state, second, 0.5 * step));
        let fourth = rates(time + step, moved(state, third, step));
        state = std::array::from_fn(|i| {
            state[i] + step / 6.0 * (first[i] + 2.0 * (second[i] + third[i]) + fourth[i])
        });
    }
    state
}

fn end_of(course: TrajectoryRequest) -> Vec<f64> {
    let motion = course.follow().expect("a motion");
    assert!(motion.is_complete(), "{}: {:?}", motion.end(), motion.reason());
    let balance = motion.balance.as_ref().expect("an energy");
    assert!(balance.residual < 1e-10, "{}", balance.residual);
    motion.states_at(motion.end()).expect("a state")
}

/// Equal masses exchange their velocities, whatever the law of the contact. One of Hertz lasts
/// `T = 2 d/v int_0^1 (1 - s^(5/2))^(-1/2) ds`, `v^2/2 = 4/5 K d^(5/2)`, in which the centre of
/// mass moves on by v T/2.
#[test]
fn balls_exchange_their_velocities() {
    // 2/5 Gamma(2/5) Gamma(1/2)/Gamma(9/10).
    let integral =
        0.4 * 2.218_159_543_757_688 * std::f64::consts::PI.sqrt() / 1.068_628_702_119_319;
    let duration = 2.0 * integral * (5.0 / 8e4_f64).powf(0.4);
    let forces =
        [("p", "-K*(p - q + 1)^(3/2)*H(p - q + 1)"), ("q", "K*(p - q + 1)^(3/2)*H(2*p - 2*q + 2)")];
    let contacts: [(&str, &[(&str, &str)]); 4] = [
        ("2/5*K*max(p - q + 1, 0)^(5/2)", &[]),
        ("2/5*K*(-min(0, q - p - 1))^(5/2)", &[]),
        ("2/5*K*((p - q + 1 + abs(q - p - 1))/2)^(5/2)", &[]),
        ("0", &forces),
    ];
    for (potential, forces) in contacts {
        for start in [-2.7, -1.0] {
            let course = bodies(
                &["p", "q"],
                ["p'^2/2 + q'^2/2", potential, "0"],
                forces,
                &[("p", start), ("p'", 1.0)],
                10.0,
            );
            let end = end_of(course);
            let expected = [0.5 * duration - 1.0, start + 10.0 + 1.0 - 0.5 * duration, 0.0, 1.0];
            let astray = end.iter().zip(expected).map(|(end, expected)| (end - expected).abs());
            assert!(astray.fold(0.0, f64::max) < 1e-9, "{potential} from {start}: {end:?}");
        }
    }
}

/// Of three balls in a row the last takes the velocity; between two that come from both sides the
/// middle one stays.
#[test]
fn three_balls_hand_their_velocity_on() {
    let follow = |start: &[(&str, f64)]| {
        let contact = "2/5*K*max(p - q + 1, 0)^(5/2) + 2/5*K*max(q - r + 1, 0)^(5/2)";
        end_of(bodies(
            &["p", "q", "r"],
            ["p'^2/2 + q'^2/2 + r'^2/2", contact, "0"],
            &[],
            start,
            10.0,
        ))
    };
    for start in [-3.0, -2.7] {
        let end = follow(&[("p", start), ("p'", 1.0), ("r", 2.0)]);
        let astray = end[3..].iter().zip([0.0, 0.0, 1.0]);
        assert!(
            astray.map(|(end, one)| (end - one).abs()).fold(0.0, f64::max) < 1e-9,
            "{start}: {end:?}"
        );
        let end = follow(&[("p", start), ("p'", 1.0), ("r", -start), ("r'", -1.0)]);
        let astray = end[3..].iter().zip([-1.0, 0.0, 1.0]);
        assert!(
            astray.map(|(end, one)| (end - one).abs()).fold(0.0, f64::max) < 1e-9,
            "{start}: {end:?}"
        );
        assert!(end[1].abs() < 1e-9, "{start}: {end:?}");
    }
    // Two that touch already, to rounding: neither of them is passed through.
    let end = follow(&[("p", -3.0), ("p'", 1.0), ("q", 0.3), ("r", 1.3)]);
    assert!(end[0] < end[1] - 1.0 && end[1] < end[2] - 1.0, "{end:?}");
    assert!((end[3] + end[4] + end[5] - 1.0).abs() < 1e-9, "{end:?}");
}

/// A mass on a spring between the two stops of another: one guard for each stop, in the equations
/// of both.
#[test]
fn a_mass_with_two_stops_takes_the_other_along() {
    let contact = |depth: f64| 1e4 * depth.max(0.0).powf(1.5);
    let potential = "X^2/2 + 2/5*K*max(u - X - d, 0)^(5/2) + 2/5*K*max(X - u - d, 0)^(5/2)";
    let forces = [
        ("X", "K*(u - X - d)^(3/2)*H(u - X - d) - K*(X - u - d)^(3/2)*H(X - u - d)"),
        ("u", "K*(X - u - d)^(3/2)*H(X - u - d) - K*(u - X - d)^(3/2)*H(u - X - d)"),
    ];
    for begin in [1.1, 1.3] {
        let rates = |_: f64, [x, u, v, w]: [f64; 4]| {
            let force = contact(u - x - 0.5) - contact(x - u - 0.5);
            [v, w, force - x, -force]
        };
        let expected = in_fixed_steps(rates, [begin, 1.0, 0.0, 0.0], 8.0, 400_000);
        for (potential, forces) in [(potential, &[][..]), ("X^2/2", &forces[..])] {
            let start = [("X", begin), ("u", 1.0)];
            let end = end_of(bodies(
                &["X", "u"],
                ["X'^2/2 + u'^2/2", potential, "0"],
                forces,
                &start,
                8.0,
            ));
            let astray = end.iter().zip(expected).map(|(end, expected)| (end - expected).abs());
            assert!(
                astray.fold(0.0, f64::max) < 1e-6,
                "{potential} from {begin}: {end:?} {expected:?}"
            );
        }
    }
}

/// A driven mass with a damper that strikes its two stops.
#[test]
fn a_driven_damper_strikes_its_stops() {
    let stop = |depth: f64| 1e4 * depth.max(0.0).powi(2);
    let rates = |t: f64, [x, u, v, w]: [f64; 4]| {
        let force = stop(u - x - 0.5) - stop(x - u - 0.5) + 0.5 * (u - x) + 0.05 * (w - v);
        [v, w, force - x + (0.9 * t).cos(), -force]
    };
    let expected = in_fixed_steps(rates, [0.0, 0.0, 0.0, 0.0], 12.0, 200_000);
    let course = bodies(
        &["X", "u"],
        [
            "X'^2/2 + u'^2/2",
            "X^2/2 + d*(u - X)^2/2 + K/3*max(abs(u - X) - d, 0)^3",
            "d*(u' - X')^2/20",
        ],
        &[("X", "cos(0.9*t)")],
        &[("X", 0.0)],
        12.0,
    );
    for motion in by_both_routes(&course) {
        let end = motion.states_at(12.0).expect("a state");
        let astray = end.iter().zip(expected).map(|(end, expected)| (end - expected).abs());
        assert!(astray.fold(0.0, f64::max) < 1e-6, "{end:?} {expected:?}");
    }
}

/// Several corners of one coordinate, one in another, and one in the argument of another: against
/// fixed steps.
#[test]
fn several_corners_of_one_coordinate_are_followed() {
    let powers = |x: f64| 1e4 * ((x - 0.3).max(0.0).powf(1.5) - (-x - 0.4).max(0.0).powf(1.5));
    let sides =
        |x: f64| 1e4 * (x.abs() - 0.4).max(0.0).powf(1.5).copysign(x) + 0.1 * (x - 0.3).max(0.0);
    let forces: [(&str, &dyn Fn(f64) -> f64); 4] = [
        ("1e4*max(max(x, 0.1) - 0.3, 0)^1.5 - 1e4*max(-x - 0.4, 0)^1.5", &powers),
        ("1e4*(x - 0.3)^1.5*H(2*x - 0.6) - 1e4*(-0.4 - x)^1.5*H(-0.4 - x)", &powers),
        ("1e4*max(abs(x) - 0.4, 0)^1.5*sgn(x) + 0.1*max(x - 0.3, 0)", &sides),
        ("1e4*(abs(x) - 0.4)^1.5*H(abs(x) - 0.4)*sgn(x) - 0.1*min(0.3 - x, 0)", &sides),
    ];
    for (force, value) in forces {
        let expected = in_fixed_steps(|_, [x, v]| [v, -x - value(x)], [0.2, 1.0], 4.0, 200_000);
        let mut course = follow(&format!("x'' + x + {force} = 0"), 0.2, 4.0);
        course.begin("x'".into(), 1.0).expect("a state");
        let end = end_of(course);
        let astray = (end[0] - expected[0]).abs().max((end[1] - expected[1]).abs());
        assert!(astray < 1e-6, "{force}: {end:?} {expected:?}");
    }
}

/// A ball on a floor whose damping begins with the depth: a corner in a corner, and no chaos.
#[test]
fn a_damping_that_begins_with_the_depth_is_followed() {
    let damped = [
        "C*min(max(-x, 0)/D, 1)^2*x'",
        "C*x'*max(0, min(-x/D, 1))^2",
        "C*x'*(max(-x/D, 0) - max(-x/D - 1, 0))^2",
    ];
    let rates = |_: f64, [x, v]: [f64; 2]| {
        let depth = (-x).max(0.0);
        [v, 1e5 * depth.powf(1.5) - 9.81 - 10.0 * (depth / 1e-3).min(1.0).powi(2) * v]
    };
    for (height, speed) in [(1.0, 1e-5), (0.9, 0.1)] {
        let expected = in_fixed_steps(rates, [height, speed], 1.05, 200_000);
        for damping in damped {
            let mut course =
                follow(&format!("x'' + 9.81 - K*max(-x, 0)^1.5 + {damping} = 0"), height, 1.05);
            course.begin("x'".into(), speed).expect("a state");
            let values = [("K", 1e5), ("C", 10.0), ("D", 1e-3)];
            course.values = values.map(|(name, value)| (Symbol::new(name), value)).into();
            let motion = course.follow().expect("a motion");
            assert!(motion.is_complete(), "{damping}: {:?}", motion.reason());
            let end = motion.states_at(1.05).expect("a state");
            let astray = (end[0] - expected[0]).abs().max((end[1] - expected[1]).abs());
            assert!(astray < 1e-6, "{damping} from {height}, {speed}: {end:?} {expected:?}");
            assert_eq!(motion.known_until(), None, "{damping} from {height}, {speed}");
        }
    }
}
