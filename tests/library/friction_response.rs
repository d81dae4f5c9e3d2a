//! Steady states under dry friction against Den Hartog's closed form, simulation piece by piece, and differences of its map.

use lindstedt::response::{Point, Question, Response, respond};
use lindstedt::trajectory::Course;
use lindstedt::verify::Verdict;
use lindstedt::{Oscillator, Symbol};

fn response(equation: &str, range: [f64; 2], values: &str, harmonics: usize) -> Response {
    let question = Question::new(equation, "Omega", range, values).expect(equation);
    respond(&Question {
        harmonics: Some(harmonics),
        ..question
    })
    .expect(equation)
}

fn points(response: &Response) -> impl Iterator<Item = &Point> {
    response.branches.iter().flat_map(|branch| &branch.points)
}

/// Position and velocity after a period, by the simulation that takes every term of `sgn` at its events.
fn after_a_period(equation: &str, numbers: &[(&str, f64)], start: [f64; 2], period: f64) -> [f64; 2] {
    let mut course = Course::of_equation(&Oscillator::parse(equation).expect(equation));
    course.values = numbers
        .iter()
        .map(|(name, value)| (Symbol::new(name), *value))
        .collect();
    course.begin("x".into(), start[0]).expect("a state");
    course.begin("x'".into(), start[1]).expect("a state");
    (course.duration, course.tolerance) = (period, 1e-12);
    let state = course.follow().expect("a motion").at(period).expect("a state");
    [state[0], state[1]]
}

/// J. P. Den Hartog, *Trans. ASME* 53 (1931) APM-107: the largest displacement of motions that do not stop, with r = Omega.
#[test]
fn motions_that_do_not_stop_are_those_of_den_hartog() {
    let found = response(
        "x'' + x + alpha*sgn(x') = F*cos(Omega*t)",
        [1.2, 2.0],
        "F = 1, alpha = 1/5",
        24,
    );
    assert_eq!(
        (found.branches.len(), found.verdict, found.unjudged),
        (1, Verdict::Pass, 0)
    );
    assert!(found.jumps && found.simulated.len() > 3);
    for point in points(&found) {
        let r = point.parameter;
        let response = 1.0 / (1.0 - r * r);
        let angle = std::f64::consts::PI / r;
        let friction = angle.sin() / (r * (1.0 + angle.cos()));
        let peak = (response.powi(2) - (0.2 * friction).powi(2)).sqrt();
        assert!((point.peak / peak - 1.0).abs() < 2e-3, "{r}: {} {peak}", point.peak);
        assert_eq!(point.stable, Some(true));
    }
}

/// The multipliers are the eigenvalues of the map of a period, its derivatives by differences of the simulation.
#[test]
fn multipliers_across_a_jump_are_those_of_the_map() {
    for (equation, range) in [
        ("x'' + x'/10 + x + x^3/5 + alpha*sgn(x') = F*cos(Omega*t)", [1.3, 1.8]),
        ("x'' + x'/10 + x + alpha*x*H(x') = F*cos(Omega*t)", [1.4, 1.8]),
        ("x'' + x'/10 + x + alpha*sgn(x' - 1/10) = F*cos(Omega*t)", [1.4, 1.8]),
    ] {
        let found = response(equation, range, "F = 1, alpha = 1/5", 12);
        // However few the harmonics, the multipliers are those of the true motion beside them.
        assert_eq!(found.unjudged, 0, "{equation}: {:?}", found.error);
        let mut seen = 0;
        for point in points(&found).step_by(11) {
            let numbers = [("F", 1.0), ("alpha", 0.2), ("Omega", point.parameter)];
            let period = std::f64::consts::TAU / point.parameter;
            let map = |start: [f64; 2]| after_a_period(equation, &numbers, start, period);
            let [x, v] = point.start;
            let back = map(point.start);
            assert!(
                (back[0] - x).hypot(back[1] - v) < 1e-6,
                "{equation}: {back:?} {point:?}"
            );
            const STEP: f64 = 1e-4;
            let slope = |to: [f64; 2], from: [f64; 2]| {
                let (to, from) = (map(to), map(from));
                [(to[0] - from[0]) / (2.0 * STEP), (to[1] - from[1]) / (2.0 * STEP)]
            };
            let by_x = slope([x + STEP, v], [x - STEP, v]);
            let by_v = slope([x, v + STEP], [x, v - STEP]);
            let (trace, determinant) = (by_x[0] + by_v[1], by_x[0] * by_v[1] - by_v[0] * by_x[1]);
            let [one, other] = point.multipliers.expect("multipliers");
            assert!(((one + other).re - trace).abs() < 1e-3, "{equation}: {point:?} {trace}");
            assert!(
                ((one * other).re - determinant).abs() < 1e-3,
                "{equation}: {point:?} {determinant}"
            );
            seen += 1;
        }
        assert!(seen > 1, "{equation}");
    }
}

/// What sticks forgets: a multiplier is zero, and a simulation from beside it is on the motion after a stop.
#[test]
fn a_motion_that_sticks_has_a_multiplier_of_zero() {
    use lindstedt::numeric::ode::Options;
    use lindstedt::response::driven::Driven;
    use lindstedt::response::jump::follow;
    let equation = "x'' + x + 3/5*sgn(x') = cos(k*t)";
    let oscillator = Oscillator::parse(equation).expect(equation);
    let driven = Driven::new(&oscillator, "k".into(), 1).expect(equation);
    let (k, period) = (0.5, 4.0 * std::f64::consts::PI);
    let mut start = [0.5, 0.0];
    for _ in 0..6 {
        let course = follow(&driven, start, k, period, &Options::with_tolerance(1e-11)).expect("a motion");
        let [x, v, a, c, b, d] = course.end;
        assert!((a * d - b * c).abs() < 1e-12);
        let expected = after_a_period("x'' + x + 3/5*sgn(x') = cos(t/2)", &[], start, period);
        assert!(
            (x - expected[0]).abs() < 1e-7 && (v - expected[1]).abs() < 1e-7,
            "{course:?} {expected:?}"
        );
        start = [x, v];
    }
}
