//! Balances of harmonics: they converge to the exact motion, and what is printed is what is solved.

use lindstedt::Oscillator;
use lindstedt::method::numbers::evaluate;
use lindstedt::method::{MOST_HARMONICS, Options, Reason, Refusal};
use lindstedt::solution::Method;

use super::{by, by_options, numbers};

/// The motion of the exact method is that of Runge-Kutta, and its harmonics that of many balanced
/// ones.
#[test]
fn harmonic_balance_converges_to_the_exact_motion() {
    for (equation, amplitude, order, tolerance) in [
        ("x'' + sin(x) = 0", 2.0, 12, 1e-11),
        ("x'' + x + x^3 = 0", 3.0, 14, 1e-12),
        ("x'' + x + x^2 = 0", 0.3, 12, 1e-7),
        ("x'' + x + x^2 = 0", -0.5, 16, 1e-7),
        ("x'' + exp(x) - 1 = 0", 1.0, 16, 1e-9),
        ("x'' + x^3 = 0", 0.01, 14, 1e-12),
    ] {
        let oscillator = Oscillator::parse(equation).unwrap();
        let balance = by_options(
            equation,
            Options {
                method: Some(Method::HarmonicBalance),
                order: Some(order),
                ..Options::default()
            },
        )
        .unwrap();
        let exact = by(equation, Method::Exact).unwrap();
        let values = numbers(&[("A", amplitude)]);
        let [found, expected] = [&balance, &exact]
            .map(|solution| evaluate(&oscillator, solution, &values).expect(equation));
        assert!(
            (found.frequency_squared / expected.frequency_squared - 1.0).abs() < tolerance,
            "{equation}: {} {}",
            found.frequency_squared,
            expected.frequency_squared
        );
        let [found, expected] = [found.motion.unwrap(), expected.motion.unwrap()];
        for theta in [0.0, 0.5, 1.3, 2.6, 3.1] {
            let error = (found.evaluate(theta) - expected.evaluate(theta)).abs();
            assert!(
                error < 10.0 * tolerance.sqrt() * f64::abs(amplitude),
                "{equation} at {theta}: {error:e}"
            );
        }
    }
    assert!(matches!(
        by_options(
            "x'' + sin(x) = 0",
            Options { method: Some(Method::HarmonicBalance), order: Some(0), ..Options::default() }
        ),
        Err(Refusal { reason: Reason::HighestOrder(MOST_HARMONICS), .. })
    ));
}

/// The printed system vanishes at the numbers that Newton's iteration finds.
#[test]
fn the_printed_balance_is_the_one_that_is_solved() {
    for (equation, order, entries) in [
        ("x'' + x + eps*x^3 = 0", 2, vec![("eps", 0.7), ("A", 1.4)]),
        ("x'' + x + x^2 - x^5/9 = 0", 3, vec![("A", 0.4)]),
        ("x'' + exp(x) - 1 = 0", 1, vec![("A", 0.8)]),
        ("x'' + x + k*(x - xc)*H(x - xc) = 0", 1, vec![("k", 2.0), ("xc", 0.5), ("A", 1.0)]),
    ] {
        let options = Options {
            method: Some(Method::HarmonicBalance),
            order: Some(order),
            ..Options::default()
        };
        let solution = by_options(equation, options).expect(equation);
        let oscillator = Oscillator::parse(equation).unwrap();
        let system = solution.law.system().expect("a system");
        let found = evaluate(&oscillator, &solution, &numbers(&entries)).expect(equation);
        let motion = found.motion.expect("a motion");
        let harmonic = |k: usize| {
            let points = 256;
            let sum: f64 = (0..points)
                .map(|i| {
                    let theta = std::f64::consts::TAU * i as f64 / points as f64;
                    motion.evaluate(theta) * (k as f64 * theta).cos()
                })
                .sum();
            if k == 0 { sum / points as f64 } else { 2.0 * sum / points as f64 }
        };
        let mut values = numbers(&entries);
        values.insert("omega".into(), found.frequency_squared.sqrt());
        for name in &system.unknowns[1..] {
            values.insert(*name, harmonic(name.name()[1..].parse().expect("a harmonic")));
        }
        for line in &system.equations {
            let value = line.evaluate(&values).expect("a number");
            // Newton's iteration samples the motion: at the corner of a barrier that is good to
            // less.
            let tolerance = if equation.contains('H') { 1e-8 } else { 1e-10 };
            assert!(value.abs() < tolerance, "{equation}: {line} = {value:e}");
        }
    }
}

/// Motions about several wells: the branch from rest ends inside, and the one from large amplitudes
/// converges to the exact motion; what is said beside it says so.
#[test]
fn balances_about_several_wells_come_from_large_amplitudes() {
    for (equation, amplitudes, tolerance) in [
        ("x'' + x - x^3 + 0.2*x^5 = 0", [2.5, 4.0, 60.0], 2e-3),
        ("x'' + x - 1.5*x^2 + 0.4*x^3 = 0", [-4.0, 9.0, 500.0], 2e-3),
    ] {
        let oscillator = Oscillator::parse(equation).unwrap();
        let by_order = |order: u32| {
            let options = Options {
                method: Some(Method::HarmonicBalance),
                order: Some(order),
                ..Options::default()
            };
            by_options(equation, options).unwrap()
        };
        let exact = by(equation, Method::Exact).unwrap();
        for amplitude in amplitudes {
            let values = numbers(&[("A", amplitude)]);
            let expected = evaluate(&oscillator, &exact, &values).unwrap().frequency_squared;
            let error = |order: u32| {
                let found = evaluate(&oscillator, &by_order(order), &values).unwrap();
                let remark = found.remark.expect("a remark");
                assert!(remark.contains("several wells"), "{remark}");
                (found.frequency_squared / expected - 1.0).abs()
            };
            let (few, many) = (error(3), error(12));
            assert!(many < tolerance && many < few, "{equation} {amplitude}: {few} {many}");
        }
    }
}

/// A single well whose force softens before it stiffens: the branch of a few harmonics from rest
/// turns back, the one from large amplitudes is that of the power x^5, for whose motions one
/// harmonic is known.
#[test]
fn a_single_well_is_balanced_from_large_amplitudes_too() {
    let equation = "x'' + x + 1.34*x^2 - 0.00509*x^3 + 0.441*x^5 = 0";
    let oscillator = Oscillator::parse(equation).unwrap();
    let options =
        Options { method: Some(Method::HarmonicBalance), order: Some(1), ..Options::default() };
    let solution = by_options(equation, options).unwrap();
    let values = numbers(&[("A", 464.0)]);
    let found = evaluate(&oscillator, &solution, &values).unwrap();
    // omega^2 = 5/8 c A^4, beside which the other terms are of the order of 1/A^2.
    let power = 0.625 * 0.441 * 464.0_f64.powi(4);
    assert!((found.frequency_squared / power - 1.0).abs() < 1e-5, "{found:?}");
    assert!(found.remark.is_some_and(|remark| remark.contains("from large amplitudes")));
}

/// Close to the edge of its well a motion may have no balance, and those about several wells are
/// none of it.
#[test]
fn balances_of_other_motions_are_not_taken() {
    let equation = "x'' + 0.206*x - 3.51*x^2 + 2.29*x^3 = 0";
    let oscillator = Oscillator::parse(equation).unwrap();
    let options =
        Options { method: Some(Method::HarmonicBalance), order: Some(3), ..Options::default() };
    let solution = by_options(equation, options).unwrap();
    let at = |amplitude: f64| evaluate(&oscillator, &solution, &numbers(&[("A", amplitude)]));
    let refused = at(-0.0298).unwrap_err();
    assert!(refused.to_string().contains("ends at A"), "{refused}");
    assert!(at(-0.01).unwrap().remark.is_none());
    // Just over the saddle between the wells.
    assert!(at(-0.0301).unwrap().remark.is_some());
}

/// Thousands of waves along the motion are refused at once.
#[test]
fn a_balance_of_thousands_of_waves_is_refused() {
    let equation = "x'' + sin(1.52*x) + 2.15*x = 0";
    let oscillator = Oscillator::parse(equation).unwrap();
    let solution = by(equation, Method::HarmonicBalance).unwrap();
    let refused = evaluate(&oscillator, &solution, &numbers(&[("A", 7550.0)])).unwrap_err();
    assert!(refused.to_string().contains("changes too often"), "{refused}");
    assert!(evaluate(&oscillator, &solution, &numbers(&[("A", 7.5)])).is_ok());
}
