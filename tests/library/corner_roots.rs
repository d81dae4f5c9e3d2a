//! Powers such as 3/2 that begin at a corner, written with `max`, `min` or `abs`: against the energy, a period in closed form and the same
//! force behind a step.

use std::collections::BTreeMap;

use lindstedt::mechanics::Mechanism;
use lindstedt::system::Integrator;
use lindstedt::trajectory::{Course, Trajectory};
use lindstedt::{Oscillator, Symbol};

fn follow(equation: &str, start: f64, until: f64) -> Course {
    let mut course = Course::of_equation(&Oscillator::parse(equation).expect("an oscillator"));
    course.begin("x".into(), start).expect("a state");
    course.duration = until;
    course
}

fn by_both_routes(course: &Course) -> [Trajectory; 2] {
    [
        course.clone().follow(),
        course.clone().follow_by(Integrator::RungeKutta),
    ]
    .map(|motion| {
        let motion = motion.expect("a motion");
        assert!(motion.is_complete(), "{}: {:?}", motion.end(), motion.reason());
        motion
    })
}

/// A mass strikes a Hertzian stop at every swing: `x'^2/2 + x^2/2 + 2/5 k d^(5/2)` stays what it was, in whatever form the stop is written.
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
        let values = [("k", 1e4), ("d", 0.5), ("n", 1.5)].map(|(name, value)| (Symbol::new(name), value));
        let needed = course.parameters();
        course.values = values.into_iter().filter(|(name, _)| needed.contains(name)).collect();
        for motion in by_both_routes(&course) {
            let mut deepest = 0.0_f64;
            for index in 0..=4000 {
                let state = motion.at(20.0 * f64::from(index) / 4000.0).expect("a state");
                let depth = (state[0] - 0.5).max(0.0);
                deepest = deepest.max(depth);
                let energy = 0.5 * (state[1] * state[1] + state[0] * state[0]) + 4e3 * depth.powf(2.5);
                assert!((energy - 0.5).abs() < 1e-10, "{form}: {energy} at {index}");
            }
            assert!(deepest > 0.01, "{form}: {deepest}");
        }
    }
}

/// `x'' + sgn(x) abs(x)^n = 0` from 1: the period is `4 sqrt((n + 1)/2) sqrt(pi)/(n + 1) Gamma(1/(n + 1))/Gamma(1/(n + 1) + 1/2)`.
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
                let state = motion.at(time * period).expect("a state");
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
        let mut course = Course::of_mechanism(&mechanism, &equations).expect("accelerations");
        course.begin("q".into(), -1.0).expect("a state");
        course.duration = 20.0;
        course.values = BTreeMap::from([(Symbol::new("k"), 1e4), (Symbol::new("d"), 0.5)]);
        let motion = course.follow().expect("a motion");
        assert!(motion.is_complete(), "{contact}: {:?}", motion.reason());
        assert!(
            motion.balance.as_ref().expect("an energy").residual < 1e-11,
            "{contact}"
        );
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
        let motion = follow(&format!("x'' + {force} = 0"), 1.0, 20.0)
            .follow()
            .expect("a motion");
        assert!(!motion.is_complete(), "{force}");
        let end = motion.at(motion.end()).expect("a state")[0];
        assert!((end - edge).abs() < 1e-3, "{force}: {end}");
    }
}
