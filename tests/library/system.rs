//! First-order systems followed by their Taylor series and by Runge-Kutta, against elliptic
//! functions, exact orbits, conserved energies, and each other.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use lindstedt::Symbol;
use lindstedt::expr::{Expr, parse_expression};
use lindstedt::numeric::ode::{self, Point, integrate_first_order};
use lindstedt::series::RecurrenceError;
use lindstedt::system::{
    Event, Integrator, LANES, Path, PathEnd, Solver, System, SystemError, SystemOptions,
    solve_together,
};

fn expression(text: &str) -> Expr {
    parse_expression(text).unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn system(states: &[&str], right: &[&str], numbers: &[(&str, f64)]) -> Result<System, SystemError> {
    let states: Vec<Symbol> = states.iter().map(|name| Symbol::new(name)).collect();
    let right: Vec<Expr> = right.iter().map(|text| expression(text)).collect();
    let numbers: BTreeMap<Symbol, f64> =
        numbers.iter().map(|(name, value)| (Symbol::new(name), *value)).collect();
    System::new(&states, "t".into(), &right, &numbers)
}

fn follow(system: &System, start: &[f64], end: f64, events: &[Event]) -> Path {
    system.solve([0.0, end], start, events, &SystemOptions::default()).expect("a path")
}

fn runge_kutta() -> SystemOptions {
    SystemOptions { integrator: Integrator::RungeKutta, ..SystemOptions::default() }
}

/// By Taylor series and by Runge-Kutta.
fn by_both(system: &System, start: &[f64], end: f64, events: &[Event]) -> [Path; 2] {
    [SystemOptions::default(), runge_kutta()]
        .map(|options| system.solve([0.0, end], start, events, &options).expect("a path"))
}

#[test]
fn the_pendulum_is_its_elliptic_function_at_every_time() {
    let pendulum = system(&["x", "v"], &["v", "-sin(x)"], &[]).unwrap();
    let path = follow(&pendulum, &[1.5, 0.0], 100.0, &[]);
    assert_eq!((path.end(), path.reason()), (100.0, PathEnd::Reached));
    let k = 0.75_f64.sin();
    for i in 0..=1000 {
        let t = 0.1 * f64::from(i);
        let (_, cn, dn, _) = spec_math::cephes64::ellpj(t, k * k);
        let x = 2.0 * (k * cn / dn).asin();
        let found = path.states_at(t).expect("a state")[0];
        assert!((found - x).abs() < 2e-12, "{t}: {found} {x}");
    }
    assert!(
        path.states_at(-0.1).is_none()
            && path.states_at(100.1).is_none()
            && path.states_at(f64::NAN).is_none()
    );
}

/// Two equal links of length and mass one: angles from the vertical, `c = cos(a - b)`,
/// accelerations from the Lagrangian.
#[test]
fn two_links_keep_their_energy() {
    let divisor = "(2 - cos(a - b)^2)";
    let first =
        format!("(-2*sin(a) + cos(a - b)*sin(b) - sin(a - b)*(q^2 + cos(a - b)*p^2))/{divisor}");
    let second =
        format!("(2*cos(a - b)*sin(a) - 2*sin(b) + sin(a - b)*(2*p^2 + cos(a - b)*q^2))/{divisor}");
    let links = system(&["a", "b", "p", "q"], &["p", "q", &first, &second], &[]).unwrap();
    let vertical = [Event::record(expression("a")), Event::record(expression("a - 3/2"))];
    let energy = |y: &[f64]| {
        let [a, b, p, q] = [y[0], y[1], y[2], y[3]];
        p * p + 0.5 * q * q + (a - b).cos() * p * q - 2.0 * a.cos() - b.cos()
    };
    // Small, large, and one that tumbles over.
    for start in [[0.1, 0.1, 0.0, 0.0], [1.5, -0.5, 0.0, 0.0], [2.5, 2.0, 0.5, -1.0]] {
        let [path, other] = by_both(&links, &start, 50.0, &vertical);
        assert_eq!((path.reason(), other.reason()), (PathEnd::Reached, PathEnd::Reached));
        assert!(other.step_count() > path.step_count());
        let before = energy(&start);
        for i in 0..=500 {
            let [state, judged] =
                [&path, &other].map(|path| path.states_at(0.1 * f64::from(i)).expect("a state"));
            for (state, kept) in [(&state, 1e-12), (&judged, 1e-11)] {
                let drift = energy(state) - before;
                assert!(drift.abs() < kept, "{start:?} at {i}: {drift:e}");
            }
            // Both are right as far as the motion lets errors grow: the one that tumbles is
            // chaotic.
            let time = 0.1 * f64::from(i);
            let allowed = if start[0] < 2.0 { 1e-10 } else { 1e-11 * time.exp() };
            for (value, expected) in judged.iter().zip(&state).filter(|_| allowed < 1e-4) {
                assert!(
                    (value - expected).abs() < allowed,
                    "{start:?} at {time}: {judged:?} {state:?}"
                );
            }
        }
        // At rest on the surface of an event they leave it without an occurrence.
        let until = if start[0] < 2.0 { 50.0 } else { 15.0 };
        let met = |path: &Path| -> Vec<_> {
            path.occurrences().iter().copied().filter(|met| met.time < until).collect()
        };
        let (met, judged) = (met(&path), met(&other));
        assert!(met.len() == judged.len() && met.len() > 5, "{met:?} {judged:?}");
        for (met, judged) in met.iter().zip(judged) {
            assert_eq!((met.event, met.rising), (judged.event, judged.rising));
            assert!((met.time - judged.time).abs() < 1e-4, "{met:?} {judged:?}");
        }
    }
    // The normal modes of small swings: omega^2 = 2 -+ sqrt(2), b = +-sqrt(2) a.
    for sign in [1.0, -1.0] {
        let size = 1e-6;
        let period = TAU / (2.0 - sign * 2.0_f64.sqrt()).sqrt();
        let path = follow(&links, &[size, sign * 2.0_f64.sqrt() * size, 0.0, 0.0], period, &[]);
        let end = path.states_at(path.end()).expect("a state");
        assert!((end[0] / size - 1.0).abs() < 1e-9, "{end:?}");
    }
}

#[test]
fn an_orbit_closes_after_its_period() {
    let kepler = system(
        &["x", "y", "u", "v"],
        &["u", "v", "-x/(x^2 + y^2)^(3/2)", "-y/(x^2 + y^2)^(3/2)"],
        &[],
    )
    .unwrap();
    for eccentricity in [0.0, 0.5, 0.9] {
        let start =
            [1.0 - eccentricity, 0.0, 0.0, f64::sqrt((1.0 + eccentricity) / (1.0 - eccentricity))];
        let path = follow(&kepler, &start, TAU, &[Event::record(expression("x"))]);
        let end = path.states_at(TAU).expect("a state");
        for (value, expected) in end.iter().zip(start) {
            assert!((value - expected).abs() < 1e-11, "{eccentricity}: {end:?}");
        }
        // Above the focus the eccentric anomaly is acos(e): Kepler's equation.
        let anomaly = f64::acos(eccentricity);
        let time = anomaly - eccentricity * anomaly.sin();
        let times: Vec<f64> = path.occurrences().iter().map(|met| met.time).collect();
        assert_eq!(times.len(), 2);
        assert!(
            (times[0] - time).abs() < 1e-12 && (times[1] - (TAU - time)).abs() < 1e-11,
            "{times:?}"
        );
        assert!(!path.occurrences()[0].rising && path.occurrences()[1].rising);
    }
}

/// Half a period on a spring k, half on 1 + k, exactly, however the corner is written.
#[test]
fn a_corner_is_met_and_left_where_it_is() {
    for right in
        ["-x - k*x*H(x)", "-x - k*max(x, 0)", "-x - k*(x + abs(x))/2", "min(-x, -(1 + k)*x)"]
    {
        let bilinear = system(&["x", "v"], &["v", right], &[("k", 3.0)]).unwrap();
        for path in by_both(&bilinear, &[-1.0, 0.0], 100.0, &[Event::stop(expression("v"))]) {
            assert_eq!(path.reason(), PathEnd::Event(0));
            // From -1 up to the corner in a quarter of 2 pi, on to rest at 1/2 in a quarter of pi.
            assert!((path.end() - 0.75 * PI).abs() < 1e-12, "{right}: {}", path.end());
            assert!((path.states_at(path.end()).expect("a state")[0] - 0.5).abs() < 1e-13);
        }
    }
    // Free fall onto a wall of constant force: parabolas.
    let wall = system(&["x", "v"], &["v", "-sgn(x)"], &[]).unwrap();
    let end = 8.0 * 2.0_f64.sqrt();
    let paths = by_both(&wall, &[1.0, 0.0], end, &[Event::record(expression("x"))]);
    for (path, allowed) in paths.iter().zip([1e-13, 1e-11]) {
        let end = path.states_at(path.end()).expect("a state");
        assert!((end[0] - 1.0).abs() < allowed, "{end:?}");
        assert_eq!(path.occurrences().len(), 4);
    }
}

/// The same bilinear spring in any units: a hundred half swings of a quadrillionth of a second are
/// no standstill.
#[test]
fn corners_are_met_in_any_units() {
    for (omega, length) in [(1e15, 1e-12), (1.0, 1.0), (1e-12, 1e15)] {
        let numbers = [("s", omega * omega)];
        let bilinear = system(&["x", "v"], &["v", "-s*x - 3*s*x*H(x)"], &numbers).unwrap();
        let period = 1.5 * PI / omega;
        for path in
            by_both(&bilinear, &[-length, 0.0], 50.0 * period, &[Event::record(expression("v"))])
        {
            assert_eq!(
                (path.reason(), path.end()),
                (PathEnd::Reached, 50.0 * period),
                "{omega} {:?}",
                path.occurrences()
            );
            let end = path.states_at(path.end()).expect("a state");
            assert!((end[0] / length + 1.0).abs() < 1e-10, "{omega} {end:?}");
            let turns = path.occurrences().iter().filter(|met| met.time < 49.9 * period);
            assert_eq!(turns.count(), 99, "{omega}");
        }
    }
}

/// A contact has no value on the near side: x^(3/2) from the touch on. The rebound is as fast as
/// the touch, and the depth is that of the energy, 1/2 = 2/5 k d^(5/2).
#[test]
fn a_contact_is_gated_by_its_step() {
    let contact = system(&["x", "v"], &["v", "-k*x^(3/2)*H(x)"], &[("k", 1e6)]).unwrap();
    let events = [Event::record(expression("v")), Event::stop(expression("x + 1/2"))];
    for path in by_both(&contact, &[-0.4, 1.0], 10.0, &events) {
        // In time the contact has no series at the touch and the release: the series may end there,
        // and says so.
        if path.reason() == PathEnd::Singular && path.step_count() < 200 {
            assert!(path.states_at(path.end()).expect("a state")[0].abs() < 1e-12);
            continue;
        }
        assert_eq!(path.reason(), PathEnd::Event(1));
        let end = path.states_at(path.end()).expect("a state");
        assert!((end[1] + 1.0).abs() < 1e-8, "{end:?}");
        let deepest =
            path.occurrences().iter().find(|met| met.event == 0).expect("a turning point");
        let depth = path.states_at(deepest.time).expect("a state")[0];
        assert!((depth / 1.25e-6_f64.powf(0.4) - 1.0).abs() < 1e-8, "{depth}");
    }
}

/// Euler's free body in an array: three states, two constants, and the same by expressions.
#[test]
fn any_number_of_states_by_a_closure() {
    let spin = |_: f64, w: &[f64; 3], rates: &mut [f64; 3]| {
        *rates = [-w[1] * w[2], 2.0 * w[0] * w[2], -w[0] * w[1]]
    };
    let start = [0.1, 1.0, 0.2];
    let options = ode::IntegrationOptions::with_tolerance(1e-13);
    let turned = ode::Event::new(|point: &Point<[f64; 3]>| point.y[1], ode::Action::Record);
    let path = integrate_first_order(spin, Point { t: 0.0, y: start }, 40.0, &[turned], &options)
        .expect("a path");
    let by_name = system(&["a", "b", "c"], &["-b*c", "2*a*c", "-a*b"], &[]).unwrap();
    let series = follow(&by_name, &start, 40.0, &[Event::record(expression("b"))]);
    let times = |index: usize| series.occurrences()[index].time;
    assert!(
        series.occurrences().len() >= 4 && path.occurrences().len() == series.occurrences().len()
    );
    for (index, met) in path.occurrences().iter().enumerate() {
        assert!(
            (met.state.t - times(index)).abs() < 1e-10
                && met.rising == series.occurrences()[index].rising
        );
    }
    for point in path.samples(101) {
        let [a, b, c] = point.y;
        assert!((2.0 * a * a + b * b - 1.02).abs() < 1e-11 && (a * a - c * c + 0.03).abs() < 1e-11);
        for (value, expected) in series.states_at(point.t).expect("a state").iter().zip(point.y) {
            assert!((value - expected).abs() < 1e-10, "{point:?}");
        }
    }
    assert!(path.state_at(40.1).is_none());
    let nowhere = |_: f64, w: &[f64; 3], rates: &mut [f64; 3]| *rates = [0.0, (-w[0]).sqrt(), 0.0];
    let refused =
        integrate_first_order(nowhere, Point { t: 0.0, y: start }, 1.0, &[], &options).unwrap_err();
    assert_eq!(refused, ode::IntegrationError::RateNotFinite { index: 1, t: 0.0 });
    let refused =
        integrate_first_order(spin, Point { t: 0.0, y: [f64::NAN; 3] }, 1.0, &[], &options)
            .unwrap_err();
    assert!(matches!(refused, ode::IntegrationError::ValuesNotFinite { .. }), "{refused}");
}

/// What is looked for may turn faster than the motion, at any time of the day.
#[test]
fn fast_events_and_corners_are_all_met() {
    let even = system(&["x"], &["1"], &[]).unwrap();
    for path in by_both(&even, &[0.001], 10.0, &[Event::record(expression("sin(100*x)"))]) {
        assert_eq!(path.occurrences().len(), 318);
        for (index, met) in path.occurrences().iter().enumerate() {
            let time = (index + 1) as f64 * PI / 100.0 - 0.001;
            assert!((met.time - time).abs() < 1e-12 && met.rising == (index % 2 == 1), "{met:?}");
        }
    }
    // Up on one half of every period, down on the other; and twice as long up as down.
    let square = system(&["x", "y"], &["sgn(sin(50*t))", "sgn(sin(50*t) + 1/2)"], &[]).unwrap();
    for path in by_both(&square, &[0.0, 0.0], TAU, &[]) {
        let end = path.states_at(TAU).expect("a state");
        assert!(end[0].abs() < 1e-11 && (end[1] - TAU / 3.0).abs() < 1e-11, "{end:?}");
    }
    // A late start costs no digits.
    let bilinear = system(&["x", "v"], &["v", "-x - 3*x*H(x)"], &[]).unwrap();
    for options in [SystemOptions::default(), runge_kutta()] {
        let path = bilinear
            .solve([1e6, 1e6 + 1.5 * PI * 20.0], &[-1.0, 0.0], &[], &options)
            .expect("a path");
        let end = path.states_at(path.end()).expect("a state");
        assert!((end[0] + 1.0).abs() < 1e-10 && end[1].abs() < 1e-8, "{end:?}");
    }
}

/// Saturation with |x| = 1 as an event as well: where the corner is, rounding may put the event on
/// either side of it.
#[test]
fn an_event_on_a_corner_is_met_once() {
    let saturated = system(&["x", "v"], &["v", "-min(max(x, -1), 1)"], &[]).unwrap();
    let events = [Event::record(expression("x")), Event::record(expression("abs(x) - 1"))];
    // Parabolas from 3 to 1 in two units, a sine from there to -1 in 2 atan(1/2).
    let (fall, swing) = (2.0, 2.0 * 0.5_f64.atan());
    for path in by_both(&saturated, &[3.0, 0.0], 40.0 * (2.0 * fall + swing), &events) {
        let count =
            |event: usize| path.occurrences().iter().filter(|met| met.event == event).count();
        assert_eq!((count(0), count(1)), (40, 80), "{:?}", path.occurrences());
        for (index, met) in path.occurrences().iter().filter(|met| met.event == 1).enumerate() {
            let halves = (index / 2) as f64 * (2.0 * fall + swing);
            let time = halves + fall + if index % 2 == 1 { swing } else { 0.0 };
            assert!(
                (met.time - time).abs() < 1e-9 && met.rising == (index % 2 == 1),
                "{met:?} {time}"
            );
        }
    }
    // At rest on a corner to which both sides lead back, and on one that it can leave on one side.
    let held = system(&["x", "v"], &["v", "1 - 2*H(x)"], &[]).unwrap();
    for path in by_both(&held, &[0.0, 0.0], 3.0, &[]) {
        assert_eq!((path.reason(), path.end()), (PathEnd::Sticks, 0.0));
    }
    let bounce = system(&["x", "v"], &["v", "-sgn(x)"], &[]).unwrap();
    for path in by_both(&bounce, &[0.0, 1.0], 9.0, &[Event::record(expression("x"))]) {
        assert_eq!((path.reason(), path.occurrences().len()), (PathEnd::Reached, 4));
        let end = path.states_at(9.0).expect("a state");
        assert!((end[0] - 0.5).abs() < 1e-11 && end[1].abs() < 1e-11, "{end:?}");
    }
}

/// Dry friction takes twice its bound of the amplitude in every half swing, and holds where the
/// spring is weaker.
#[test]
fn dry_friction_stops_the_motion_where_it_holds() {
    let slider = system(&["x", "v"], &["v", "-x - mu*sgn(v)"], &[("mu", 0.1)]).unwrap();
    for path in by_both(&slider, &[-1.05, 0.0], 100.0, &[Event::record(expression("v"))]) {
        assert_eq!(path.reason(), PathEnd::Sticks);
        // 1.05 -> 0.85 -> 0.65 -> 0.45 -> 0.25 -> 0.05, which is less than 0.1: five half swings of
        // time pi.
        assert!((path.end() - 5.0 * PI).abs() < 1e-11, "{}", path.end());
        assert!((path.states_at(path.end()).expect("a state")[0] - 0.05).abs() < 1e-11);
    }
}

/// An event that counts in one direction is met in that direction alone, also where it starts at
/// its zero and where rounding makes it leave it on the wrong side first.
#[test]
fn an_event_may_count_in_one_direction() {
    let wave = system(&["x", "v"], &["v", "-x"], &[]).unwrap();
    for (event, end) in [
        (Event::stop(expression("x")).rising(), 1.5 * PI),
        (Event::stop(expression("x")).falling(), 0.5 * PI),
        (Event::stop(expression("v")).falling(), 2.0 * PI),
        (Event::stop(expression("v")).rising(), PI),
    ] {
        for path in by_both(&wave, &[1.0, 0.0], 10.0, std::slice::from_ref(&event)) {
            assert!((path.end() - end).abs() < 1e-11, "{event:?}: {}", path.end());
        }
    }
    // x = t^2/2 - 1e-17 t: it dips below zero for 2e-17.
    let onset = system(&["x"], &["t - e"], &[("e", 1e-17)]).unwrap();
    let path = onset
        .solve(
            [0.0, 1.0],
            &[0.0],
            &[Event::stop(expression("x")).falling()],
            &SystemOptions::default(),
        )
        .expect("a path");
    assert_eq!(path.reason(), PathEnd::Reached);
}

#[test]
fn what_cannot_be_followed_is_said() {
    assert_eq!(
        system(&["x"], &["k*x"], &[]).expect_err("an unknown name"),
        SystemError::Expression(RecurrenceError::Unknown("k".into()))
    );
    assert!(matches!(system(&["x"], &[], &[]), Err(SystemError::Length { .. })));
    // A corner inside a jump would keep a side that is no longer its own.
    for jumps in ["max(H(x), 1/2)", "1 - abs(1 + 2*sgn(x))"] {
        let refused = system(&["x"], &[jumps], &[]).expect_err(jumps);
        assert!(matches!(refused, SystemError::JumpInCorner(_)), "{refused}");
    }
    // What has no value has no sign either.
    let unsigned = system(&["x"], &["1 + H(log(x))"], &[]).unwrap();
    let root = system(&["x"], &["sqrt(x)"], &[]).unwrap();
    for options in [SystemOptions::default(), runge_kutta()] {
        let refused = unsigned.solve([0.0, 1.0], &[-1.0], &[], &options);
        assert_eq!(refused.expect_err("no logarithm"), SystemError::Start("x".into()));
        let refused = root.solve([0.0, 1.0], &[-1.0], &[], &options);
        assert_eq!(refused.expect_err("no root"), SystemError::Start("x".into()));
        let refused = root.solve([0.0, 1.0], &[1.0], &[Event::record(expression("y"))], &options);
        let unknown = SystemError::Expression(RecurrenceError::Unknown("y".into()));
        assert_eq!(refused.expect_err("an unknown name"), unknown);
        let refused =
            root.solve([0.0, 1.0], &[1.0], &[Event::record(expression("log(x - 9)"))], &options);
        assert_eq!(refused.expect_err("no logarithm"), SystemError::Event(0));
        // Without a way to go the start is all there is.
        let path = root.solve([2.0, 2.0], &[1.0], &[], &options).expect("a start");
        assert_eq!(
            (path.end(), path.reason(), path.states_at(2.0)),
            (2.0, PathEnd::Reached, Some(vec![1.0]))
        );
        assert!(path.states_at(2.1).is_none() && path.states_at(1.9).is_none());
    }
    assert!(matches!(
        root.solve([0.0, 1.0], &[f64::NAN], &[], &SystemOptions::default()),
        Err(SystemError::Bounds)
    ));
    // x' = x^2 ends in a pole at t = 1.
    let pole = system(&["x"], &["x^2"], &[]).unwrap();
    for path in by_both(&pole, &[1.0], 2.0, &[]) {
        assert_eq!(path.reason(), PathEnd::Singular);
        assert!((path.end() - 1.0).abs() < 1e-6, "{}", path.end());
    }
    let short = SystemOptions { step_limit: 3, ..SystemOptions::default() };
    let path = pole.solve([0.0, 900.0], &[1e-3], &[], &short).expect("a part");
    assert_eq!((path.reason(), path.step_count()), (PathEnd::StepLimit, 3));
}

/// `x'' = x` from rest at one: x = cosh(t), which is 1e300 at ln(2e300). There either integrator
/// ends, with numbers; a pole is no such end.
#[test]
fn a_state_that_leaves_the_range_of_numbers_ends_the_path() {
    let growing = system(&["x", "v"], &["v", "x"], &[]).unwrap();
    let expected = 300.0 * std::f64::consts::LN_10 + std::f64::consts::LN_2;
    let events = [Event::record(expression("x - 1e10"))];
    for path in by_both(&growing, &[1.0, 0.0], 1000.0, &events) {
        assert_eq!(path.reason(), PathEnd::Overflow);
        assert!((path.end() - expected).abs() < 1e-7, "{} {expected}", path.end());
        let last = path.states_at(path.end()).expect("a state");
        assert!(last.iter().all(|value| (value / 1e300 - 1.0).abs() < 1e-6), "{last:?}");
        assert_eq!(path.occurrences().len(), 1);
    }
    // In time to be followed to its end.
    for path in by_both(&growing, &[1.0, 0.0], 600.0, &events) {
        assert_eq!((path.reason(), path.end()), (PathEnd::Reached, 600.0));
    }
    // A rate is too large before its state is: v^4 of v = 2 exp(t), and x grows likewise.
    let steep = system(&["v", "w"], &["v", "v^4"], &[]).unwrap();
    for path in by_both(&steep, &[2.0, 0.0], 1000.0, &[]) {
        assert_eq!(path.reason(), PathEnd::Overflow);
        // w = 4 exp(4 t) reaches 1e300.
        assert!(
            (path.end() - 0.25 * (300.0 * std::f64::consts::LN_10 - 4.0_f64.ln())).abs() < 1e-6,
            "{}",
            path.end()
        );
    }
    let pole = system(&["x"], &["x^2"], &[]).unwrap();
    for path in by_both(&pole, &[1.0], 2.0, &[]) {
        assert_eq!(path.reason(), PathEnd::Singular);
    }
    for start in [1.1e300, -1e308] {
        for integrator in [Integrator::Taylor, Integrator::RungeKutta] {
            let options = SystemOptions { integrator, ..SystemOptions::default() };
            let refused = growing.solve([0.0, 1.0], &[start, 0.0], &[], &options).unwrap_err();
            assert_eq!(refused, SystemError::Large("x".into(), start));
        }
    }
}

/// Corners with other arguments at the same place, and one that is another turned round: from x = 1
/// the force is 4 x on the right and x on the left, so that the motion comes back after pi/2 + pi.
#[test]
fn corners_at_the_same_place_are_all_switched() {
    let forces = [
        "-x - x*H(x) - x*H(x^3) - x*H(sin(x))",
        "-x - 3*max(x, 0)",
        "-5/2*x - 3/4*abs(x) - 3/4*sgn(x)*x",
        "-x - max(x, 0) - x*(1 - H(-x)) - x*H(2*x)",
        "-4*x + 3*x*H(-3*x) + 2*min(x, 0) - 2*x*H(-x/2)",
    ];
    for force in forces {
        let system = system(&["x", "v"], &["v", force], &[]).unwrap();
        let period = 1.5 * std::f64::consts::PI;
        for path in by_both(&system, &[1.0, 0.0], 3.0 * period, &[]) {
            assert_eq!(path.reason(), PathEnd::Reached, "{force}");
            for (time, expected) in [(1.0 / 6.0, [0.0, -2.0]), (2.0, [1.0, 0.0]), (3.0, [1.0, 0.0])]
            {
                let state = path.states_at(time * period).expect("a state");
                let astray = (state[0] - expected[0]).abs().max((state[1] - expected[1]).abs());
                assert!(astray < 1e-9, "{force}: {state:?} after {time} periods");
            }
        }
    }
}

/// A loose tolerance makes a motion less exact, not shorter, and takes few steps.
#[test]
fn a_loose_tolerance_is_followed_to_the_end() {
    type Motion<'a> = (&'a [&'a str; 2], [f64; 2], fn(f64) -> f64);
    let motions: [Motion; 3] = [
        (&["v", "-x"], [0.0, 1.0], f64::sin),
        (&["v", "-x + 3*x/4/(1 + x^2/1e9)"], [1.0, 0.0], |t| (0.5 * t).cos()),
        (&["1", "3*x^2"], [0.0, 0.0], |t| t),
    ];
    for (right, start, exact) in motions {
        let system = system(&["x", "v"], right, &[]).unwrap();
        for tolerance in [0.1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12] {
            let options = SystemOptions { tolerance, ..SystemOptions::default() };
            let path = system.solve([0.0, 20.0], &start, &[], &options).expect("a path");
            assert_eq!(
                (path.end(), path.reason()),
                (20.0, PathEnd::Reached),
                "{right:?} {tolerance}"
            );
            assert!(path.step_count() <= 60, "{right:?} {tolerance}: {} steps", path.step_count());
            let error = (path.states_at(20.0).expect("a state")[0] - exact(20.0)).abs();
            assert!(error < 100.0 * tolerance + 1e-6, "{right:?} {tolerance}: {error}");
        }
    }
}

/// A series that begins with a high order: `x' = t^13` from zero.
#[test]
fn a_state_that_begins_with_a_high_power_is_followed() {
    let power = system(&["x"], &["14*t^13"], &[]).unwrap();
    for path in by_both(&power, &[0.0], 2.0, &[]) {
        assert_eq!(path.reason(), PathEnd::Reached);
        let end = path.states_at(2.0).expect("a state")[0];
        assert!((end / 2.0_f64.powi(14) - 1.0).abs() < 1e-12, "{end}");
    }
}

/// Motions side by side are what each is alone, to the last bit: with other numbers and starts,
/// across corners, past events, to an end of their own, and beside equations of another form.
#[test]
fn motions_side_by_side_are_what_each_is_alone() {
    let same = |motions: &[(&Solver, Vec<f64>)], what: &str| {
        let starts: Vec<(&Solver, [f64; 2], &[f64])> = motions
            .iter()
            .map(|(solver, start)| (*solver, [0.0, 20.0], start.as_slice()))
            .collect();
        let together = solve_together(&starts);
        assert_eq!(together.len(), motions.len(), "{what}");
        for ((solver, start), together) in motions.iter().zip(together) {
            match (solver.solve([0.0, 20.0], start), together) {
                (Err(alone), Err(together)) => assert_eq!(alone, together, "{what}"),
                (Ok(alone), Ok(together)) => {
                    assert_eq!(alone.reason(), together.reason(), "{what}");
                    assert_eq!(alone.step_count(), together.step_count(), "{what}");
                    assert_eq!(alone.occurrences(), together.occurrences(), "{what}");
                    for part in 0..=100 {
                        let time = alone.end() * f64::from(part) / 100.0;
                        assert_eq!(
                            alone.states_at(time),
                            together.states_at(time),
                            "{what} at {time}"
                        );
                    }
                }
                (alone, together) => panic!("{what}: {alone:?} and {together:?}"),
            }
        }
    };
    let count = 2 * LANES + 3;
    let options = SystemOptions::default();
    for (right, events) in [
        (
            "-d*v - sin(x) + cos(3*t)/4",
            vec![Event::record(expression("x")), Event::stop(expression("x - 3"))],
        ),
        ("-d*v - x - tanh(20*x)/(1 + exp(-x^2)) + atan(v)*x^(1/3)", vec![]),
        ("d*x^3", vec![]),
    ] {
        let base = system(&["x", "v"], &["v", right], &[("d", 0.3)]).unwrap();
        let base = base.solver(&events, &options);
        let number = |index: usize| [("d".into(), 0.3 + 0.01 * index as f64)].into();
        let solvers: Vec<Solver> = (0..count)
            .map(|index| base.with_numbers(&number(index)).expect("the same form"))
            .collect();
        let starts = (0..count).map(|index| vec![1.0 + 0.1 * index as f64, 0.5]);
        same(&solvers.iter().zip(starts).collect::<Vec<_>>(), right);
    }
    let corners = system(&["x", "v"], &["v", "-x - 30*max(x - 1, 0)^(3/2) - sgn(v)/10"], &[]);
    let corners = corners.unwrap().solver(&[], &options);
    let other = system(&["x", "v"], &["v", "-x*abs(x)"], &[]).unwrap().solver(&[], &options);
    let root = system(&["x", "v"], &["v", "log(x)"], &[]).unwrap().solver(&[], &options);
    let mut motions: Vec<(&Solver, Vec<f64>)> =
        (0..count).map(|index| (&corners, vec![0.3 * index as f64, 1.0])).collect();
    motions.insert(3, (&other, vec![1.0, 0.0]));
    motions.insert(7, (&root, vec![-1.0, 0.0]));
    motions.insert(9, (&corners, vec![f64::NAN, 0.0]));
    same(&motions, "corners");
    assert!(solve_together(&[]).is_empty());
}
