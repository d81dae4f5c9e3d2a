//! First-order systems followed by their Taylor series, against elliptic functions, exact orbits and conserved energies.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use lindstedt::Symbol;
use lindstedt::expr::{Expr, parse_expression};
use lindstedt::system::{End, Event, Options, Path, System, SystemError};

fn expression(text: &str) -> Expr {
    parse_expression(text).unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn system(states: &[&str], right: &[&str], numbers: &[(&str, f64)]) -> Result<System, SystemError> {
    let states: Vec<Symbol> = states.iter().map(|name| Symbol::new(name)).collect();
    let right: Vec<Expr> = right.iter().map(|text| expression(text)).collect();
    let numbers: BTreeMap<Symbol, f64> = numbers
        .iter()
        .map(|(name, value)| (Symbol::new(name), *value))
        .collect();
    System::new(&states, "t".into(), &right, &numbers)
}

fn follow(system: &System, start: &[f64], end: f64, events: &[Event]) -> Path {
    system
        .follow(0.0, start, end, events, &Options::default())
        .expect("a path")
}

#[test]
fn the_pendulum_is_its_elliptic_function_at_every_time() {
    let pendulum = system(&["x", "v"], &["v", "-sin(x)"], &[]).unwrap();
    let path = follow(&pendulum, &[1.5, 0.0], 100.0, &[]);
    assert_eq!((path.end(), path.reason()), (100.0, End::Reached));
    let k = 0.75_f64.sin();
    for i in 0..=1000 {
        let t = 0.1 * f64::from(i);
        let (_, cn, dn, _) = spec_math::cephes64::ellpj(t, k * k);
        let x = 2.0 * (k * cn / dn).asin();
        let found = path.at(t).expect("a state")[0];
        assert!((found - x).abs() < 2e-12, "{t}: {found} {x}");
    }
    assert!(path.at(-0.1).is_none() && path.at(100.1).is_none() && path.at(f64::NAN).is_none());
}

/// Two equal links of length and mass one: angles from the vertical, `c = cos(a - b)`, accelerations from the Lagrangian.
#[test]
fn two_links_keep_their_energy() {
    let divisor = "(2 - cos(a - b)^2)";
    let first = format!("(-2*sin(a) + cos(a - b)*sin(b) - sin(a - b)*(q^2 + cos(a - b)*p^2))/{divisor}");
    let second = format!("(2*cos(a - b)*sin(a) - 2*sin(b) + sin(a - b)*(2*p^2 + cos(a - b)*q^2))/{divisor}");
    let links = system(&["a", "b", "p", "q"], &["p", "q", &first, &second], &[]).unwrap();
    let energy = |y: &[f64]| {
        let [a, b, p, q] = [y[0], y[1], y[2], y[3]];
        p * p + 0.5 * q * q + (a - b).cos() * p * q - 2.0 * a.cos() - b.cos()
    };
    // Small, large, and one that tumbles over.
    for start in [[0.1, 0.1, 0.0, 0.0], [1.5, -0.5, 0.0, 0.0], [2.5, 2.0, 0.5, -1.0]] {
        let path = follow(&links, &start, 50.0, &[]);
        assert_eq!(path.reason(), End::Reached);
        let before = energy(&start);
        for i in 0..=500 {
            let drift = energy(&path.at(0.1 * f64::from(i)).expect("a state")) - before;
            assert!(drift.abs() < 1e-12, "{start:?} at {i}: {drift:e}");
        }
    }
    // The normal modes of small swings: omega^2 = 2 -+ sqrt(2), b = +-sqrt(2) a.
    for sign in [1.0, -1.0] {
        let size = 1e-6;
        let period = TAU / (2.0 - sign * 2.0_f64.sqrt()).sqrt();
        let path = follow(&links, &[size, sign * 2.0_f64.sqrt() * size, 0.0, 0.0], period, &[]);
        let end = path.at(path.end()).expect("a state");
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
        let start = [
            1.0 - eccentricity,
            0.0,
            0.0,
            f64::sqrt((1.0 + eccentricity) / (1.0 - eccentricity)),
        ];
        let path = follow(&kepler, &start, TAU, &[Event::record(expression("x"))]);
        let end = path.at(TAU).expect("a state");
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

/// Half a period on a spring k, half on 1 + k, exactly.
#[test]
fn a_corner_is_met_and_left_where_it_is() {
    let bilinear = system(&["x", "v"], &["v", "-x - k*x*H(x)"], &[("k", 3.0)]).unwrap();
    let path = follow(&bilinear, &[-1.0, 0.0], 100.0, &[Event::stop(expression("v"))]);
    assert_eq!(path.reason(), End::Event(0));
    // From -1 up to the corner in a quarter of 2 pi, on to rest at 1/2 in a quarter of pi.
    assert!((path.end() - 0.75 * PI).abs() < 1e-13, "{}", path.end());
    assert!((path.at(path.end()).expect("a state")[0] - 0.5).abs() < 1e-13);
    // Free fall onto a wall of constant force: parabolas.
    let wall = system(&["x", "v"], &["v", "-sgn(x)"], &[]).unwrap();
    let path = follow(
        &wall,
        &[1.0, 0.0],
        8.0 * 2.0_f64.sqrt(),
        &[Event::record(expression("x"))],
    );
    assert!((path.at(path.end()).expect("a state")[0] - 1.0).abs() < 1e-13);
    assert_eq!(path.occurrences().len(), 4);
}

/// Dry friction takes twice its bound of the amplitude in every half swing, and holds where the spring is weaker.
#[test]
fn dry_friction_stops_the_motion_where_it_holds() {
    let slider = system(&["x", "v"], &["v", "-x - mu*sgn(v)"], &[("mu", 0.1)]).unwrap();
    let path = follow(&slider, &[-1.05, 0.0], 100.0, &[Event::record(expression("v"))]);
    assert_eq!(path.reason(), End::Sticks);
    // 1.05 -> 0.85 -> 0.65 -> 0.45 -> 0.25 -> 0.05, which is less than 0.1: five half swings of time pi.
    assert!((path.end() - 5.0 * PI).abs() < 1e-11, "{}", path.end());
    assert!((path.at(path.end()).expect("a state")[0] - 0.05).abs() < 1e-11);
}

#[test]
fn what_cannot_be_followed_is_said() {
    assert_eq!(
        system(&["x"], &["k*x"], &[]).expect_err("an unknown name"),
        SystemError::Unknown("k".into())
    );
    assert!(matches!(system(&["x"], &[], &[]), Err(SystemError::Length { .. })));
    let root = system(&["x"], &["sqrt(x)"], &[]).unwrap();
    let refused = root.follow(0.0, &[-1.0], 1.0, &[], &Options::default());
    assert_eq!(refused.expect_err("no root"), SystemError::Start("x".into()));
    assert!(matches!(
        root.follow(0.0, &[f64::NAN], 1.0, &[], &Options::default()),
        Err(SystemError::Bounds)
    ));
    // x' = x^2 ends in a pole at t = 1.
    let pole = system(&["x"], &["x^2"], &[]).unwrap();
    let path = follow(&pole, &[1.0], 2.0, &[]);
    assert_eq!(path.reason(), End::Singular);
    assert!((path.end() - 1.0).abs() < 1e-6, "{}", path.end());
    let short = Options {
        step_limit: 3,
        ..Options::default()
    };
    let path = pole.follow(0.0, &[1e-3], 900.0, &[], &short).expect("a part");
    assert_eq!((path.reason(), path.step_count()), (End::StepLimit, 3));
}
