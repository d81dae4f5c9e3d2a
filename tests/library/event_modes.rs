//! States that change at events alone: those that only count are no part of a motion, modes have the values to which
//! events lead.

use lindstedt::coupled::CoupledEquations;
use lindstedt::event::StateEvent;
use lindstedt::response::{
    Equations, ResponseDiagram, ResponseError, ResponseRequest, SteadyMotion, respond,
};

fn asked(equations: &str, events: &[&str], periods: usize) -> ResponseRequest {
    let first = ResponseRequest::new("x'' + x'/10 + x = cos(t)", "w", [0.9, 1.2], "");
    let coupled = CoupledEquations::parse(equations).expect(equations);
    let states = coupled.rates.states.clone();
    let events = events.iter().map(|text| StateEvent::parse(text, &states).expect(text));
    ResponseRequest {
        events: events.collect(),
        equations: Equations::Coupled(coupled),
        periods,
        ..first.expect("a question")
    }
}

fn points(found: &ResponseDiagram) -> Vec<&SteadyMotion> {
    found.branches.iter().flat_map(|branch| &branch.points).collect()
}

/// A kick p at every beginning of a period of `x'' + c x' + x = 0`: behind it x = X, x' = V with
/// (1 - Phi) (X, V) = (0, p), Phi the linear motion over T = 2 pi/w. Its multipliers are those of Phi, and a counter of
/// the kicks adds none.
#[test]
fn a_counter_is_no_part_of_a_kicked_motion() {
    let kicks = ["sin(w*t) > 0: x' = x' + 1/2; m = 1 - m; n = n + 1"];
    let found = respond(&asked("x'' + x'/5 + x = 0; m' = 0; n' = 0", &kicks, 1));
    let found = found.expect("a response");
    assert_eq!(found.counters, ["m".into(), "n".into()]);
    assert_eq!(found.coordinates(), ["x".into()]);
    assert_eq!(found.branches.len(), 1);
    assert!(found.modes.is_empty() && found.elsewhere.is_empty(), "{:?}", found.elsewhere);
    for point in points(&found) {
        // Both multipliers are exp(-T/10) in size, and the determinant of Phi is their product.
        let period = std::f64::consts::TAU / point.parameter;
        let size = (-0.1 * period).exp();
        let multipliers = point.multipliers.expect("multipliers");
        for multiplier in multipliers {
            assert!((multiplier.norm() - size).abs() < 1e-9, "{point:?}");
        }
        assert_eq!((point.stable, point.events), (Some(true), 1));
        assert_eq!(point.counted, [1.0, 1.0]);
        // Before the kick V = p (1 - C)/D - p and so on; D = det(1 - Phi) gives x = p S/D.
        let w0 = (1.0 - 0.01_f64).sqrt();
        let (s, c) = (w0 * period).sin_cos();
        let place = 0.5 * size * s / w0 / (1.0 - 2.0 * size * c + size * size);
        assert!((point.start[0] - place).abs() < 1e-9, "{} {place}", point.start[0]);
    }
}

/// Events that set nothing but a counter leave a linear motion, with its amplitude in closed form.
#[test]
fn events_that_only_count_are_left_out() {
    let counts = ["x > 0: m = m + 1", "x > 1: m = m + n", "x' = 0: n = 2 - n"];
    let found = respond(&asked("x'' + x'/10 + x = cos(w*t); m' = 0; n' = 0", &counts, 1));
    let found = found.expect("a response");
    assert_eq!((found.branches.len(), found.has_events()), (1, false));
    for point in points(&found) {
        let w = point.parameter;
        let exact = ((1.0 - w * w).powi(2) + 0.01 * w * w).sqrt().recip();
        assert!((point.amplitude / exact - 1.0).abs() < 1e-9, "{point:?}");
        assert_eq!(point.counted.len(), 2);
    }
    // A count that acts on the motion goes on for ever.
    let acts = asked("x'' + x'/10 + x + m = cos(w*t); m' = 0", &["x > 0: m = m + 1"], 1);
    let refused = respond(&acts).expect_err("no motion");
    assert!(matches!(refused, ResponseError::CountsAndActs { .. }), "{refused}");
    // A parameter that stands nowhere else changes nothing.
    let asked = asked("x'' + x'/10 + x = cos(t); m' = 0", &["x > 0: m = m + w"], 1);
    let refused = respond(&asked).expect_err("no parameter");
    assert!(matches!(refused, ResponseError::OnlyCounts { .. }), "{refused}");
}

/// A counter beside a rigid wall: as many impacts as without it, and its count.
#[test]
fn a_counter_stands_beside_a_wall() {
    use lindstedt::wall::Wall;
    let wall = Wall::parse("x < 1", &"4/5".parse().unwrap()).unwrap();
    let count = ["x > 0: m = m + 1"];
    let asked = asked("x'' + x'/10 + x = cos(w*t); m' = 0", &count, 1);
    let found = respond(&ResponseRequest { walls: wall, ..asked }).expect("a response");
    let all = points(&found);
    assert!(!all.is_empty() && all.iter().all(|point| point.impacts == 1));
    assert!(all.iter().all(|point| point.counted == [1.0]), "{all:?}");
}

/// Two stiffnesses by turns, changed at the beginning of every period of the drive, so that a motion takes two of
/// them: its multipliers are those of the product of two linear motions.
#[test]
fn a_mode_comes_back_after_two_events() {
    let equations = "x'' + x'/10 + x + 3*m*x/10 = cos(w*t); m' = 0";
    let turns = ["sin(w*t) > 0: m = 1 - m"];
    let refused = respond(&asked(equations, &turns, 1)).expect_err("no motion of one period");
    assert!(matches!(refused, ResponseError::NoMotion { repeats: Some(2), .. }), "{refused}");
    let found = respond(&asked(equations, &turns, 2)).expect("a response");
    assert_eq!(found.modes, [("m".into(), vec![0.0, 1.0])]);
    assert!(found.counters.is_empty());
    assert_eq!(found.branches.len(), 1, "each motion once");
    for point in points(&found) {
        assert_eq!(point.events, 2);
        let period = std::f64::consts::TAU / point.parameter;
        let matrix = |stiffness: f64| {
            let w = (stiffness - 0.0025_f64).sqrt();
            let (s, c) = (w * period).sin_cos();
            let decay = (-0.05 * period).exp();
            [[c + 0.05 * s / w, s / w], [-stiffness * s / w, c - 0.05 * s / w]]
                .map(|row| row.map(|entry| decay * entry))
        };
        let (one, other) = (matrix(1.0), matrix(1.3));
        let trace: f64 = (0..2).flat_map(|i| (0..2).map(move |j| one[i][j] * other[j][i])).sum();
        let [first, second] = point.multipliers.expect("multipliers");
        // Multipliers are those before the last step of Newton's method, of up to 1e-8.
        assert!(((first + second).re - trace).abs() < 1e-7, "{point:?} {trace}");
        assert!(((first * second).re - (-0.2 * period).exp()).abs() < 1e-7, "{point:?}");
        assert!(point.error.is_some_and(|error| error < 1e-8), "{point:?}");
    }
}

/// A relay with hysteresis, `x' = a - x - 2 u`: x goes between -1/10 and 1/10 in ln((2.1 - a)/(1.9 - a)) and back in
/// ln((2.1 + a)/(1.9 + a)), and after one event nothing is left of a disturbance but the phase.
#[test]
fn a_relay_swings_in_its_closed_form() {
    let relay = ["x > 1/10: u = 1", "x < -1/10: u = -1"];
    let asked = asked("x' = w - x - 2*u; u' = 0", &relay, 1);
    let found = respond(&ResponseRequest { range: [-0.5, 0.5], ..asked }).expect("a response");
    assert_eq!((found.branches.len(), found.modes.len()), (1, 1));
    let all = points(&found);
    assert!(all.iter().any(|point| point.parameter == -0.5) && all.len() > 10);
    for point in all {
        let a = point.parameter;
        let period = ((2.1 - a) * (2.1 + a) / ((1.9 - a) * (1.9 + a))).ln();
        assert!((point.frequency * period / std::f64::consts::TAU - 1.0).abs() < 1e-9, "{point:?}");
        assert!((point.peak - 0.1).abs() < 1e-9 && point.events == 2, "{point:?}");
        assert!(point.multipliers.is_some_and(|all| all[0].norm() < 1e-9), "{point:?}");
    }
}

/// `v' = I - v` that fires at 1 and begins anew: T = ln(I/(I - 1)).
#[test]
fn what_fires_and_begins_anew_has_a_limit_cycle() {
    let asked = asked("v' = w - v", &["v > 1: v = 0"], 1);
    let found = respond(&ResponseRequest { range: [1.2, 3.0], ..asked }).expect("a response");
    assert_eq!(found.branches.len(), 1);
    for point in points(&found) {
        let period = (point.parameter / (point.parameter - 1.0)).ln();
        assert!((point.frequency * period / std::f64::consts::TAU - 1.0).abs() < 1e-9, "{point:?}");
        assert_eq!(point.multipliers.map(|all| all[0].norm()), Some(0.0));
    }
}

/// Equations of first order beside a wall, written before and behind that of the body, change nothing of its impacts.
#[test]
fn equations_of_first_order_stand_beside_a_wall() {
    use lindstedt::wall::Wall;
    let walls = Wall::parse("x < 1/2", &"4/5".parse().unwrap()).unwrap();
    let answer = |equations: &str| {
        let asked = asked(equations, &[], 1);
        respond(&ResponseRequest { walls: walls.clone(), of: "x".parse().ok(), ..asked })
    };
    let alone = answer("x'' + x'/10 + x = cos(w*t)").expect("a response");
    for equations in
        ["x'' + x'/10 + x = cos(w*t); y' = x - y", "y' = x - y; x'' + x'/10 + x = cos(w*t)"]
    {
        let beside = answer(equations).expect(equations);
        let ends = |found: &ResponseDiagram| {
            let mut ends: Vec<[f64; 3]> = { &found.branches }
                .iter()
                .flat_map(|branch| [branch.points.first(), branch.points.last()])
                .flatten()
                .filter(|point| [0.9, 1.2].contains(&point.parameter))
                .map(|point| [point.parameter, point.peak, point.impacts as f64])
                .collect();
            ends.sort_by(|one, other| one.partial_cmp(other).expect("numbers"));
            ends
        };
        let (one, other) = (ends(&alone), ends(&beside));
        assert!(!one.is_empty() && one.len() == other.len(), "{one:?} {other:?}");
        for (one, other) in one.into_iter().zip(other) {
            assert!((one[1] - other[1]).abs() < 1e-8 && one[2] == other[2], "{one:?} {other:?}");
        }
    }
    let of_gap = asked("x'' + x = cos(w*t); y' = x - y", &[], 1);
    let walls = Wall::parse("x < y", &"4/5".parse().unwrap()).unwrap();
    let refused = respond(&ResponseRequest { walls, ..of_gap }).expect_err("no mass");
    assert!(refused.to_string().contains("`y` is of first order"), "{refused}");
}
