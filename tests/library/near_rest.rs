//! Motions close to rest: the judge and the methods see a force to all digits however small the
//! amplitude is beside the equilibrium, compared with the linear frequency and its first
//! correction, both written out by hand.

use std::collections::BTreeMap;

use lindstedt::Values;
use lindstedt::method::{Options, numbers, solve};
use lindstedt::solution::Method;
use lindstedt::verify::judge;
use lindstedt::{Oscillator, Symbol};

/// An equation, its equilibrium, and `f'`, `f''/2`, `f'''/6` there.
struct Case {
    equation: &'static str,
    equilibrium: f64,
    coefficients: [f64; 3],
}

fn cases() -> Vec<Case> {
    // x + 2.55 x^3 = 1.04 by Newton's iteration.
    let load =
        (0..60).fold(0.5_f64, |x, _| x - (x + 2.55 * x.powi(3) - 1.04) / (1.0 + 7.65 * x * x));
    let dottie = (0..60).fold(0.7_f64, |x, _| x - (x - x.cos()) / (1.0 + x.sin()));
    // x + x |x| = 1/3.
    let root = 0.5 * ((7.0_f64 / 3.0).sqrt() - 1.0);
    let sine = (1.0_f64 / 3.0).asin();
    vec![
        Case {
            equation: "x'' + x + 2.55*x^3 - 1.04 = 0",
            equilibrium: load,
            coefficients: [1.0 + 7.65 * load * load, 7.65 * load, 2.55],
        },
        Case {
            equation: "x'' + exp(x) - 1 = 0",
            equilibrium: 0.0,
            coefficients: [1.0, 0.5, 1.0 / 6.0],
        },
        Case {
            equation: "x'' + x - cos(x) = 0",
            equilibrium: dottie,
            coefficients: [1.0 + dottie.sin(), 0.5 * dottie.cos(), -dottie.sin() / 6.0],
        },
        Case {
            equation: "x'' + 1/(1 - x)^2 - 4 = 0",
            equilibrium: 0.5,
            coefficients: [16.0, 48.0, 128.0],
        },
        Case {
            equation: "x'' + x + x*abs(x) - 1/3 = 0",
            equilibrium: root,
            coefficients: [1.0 + 2.0 * root, 1.0, 0.0],
        },
        Case {
            equation: "x'' + sin(x) - 1/3 = 0",
            equilibrium: sine,
            coefficients: [sine.cos(), -0.5 * sine.sin(), -sine.cos() / 6.0],
        },
        Case {
            equation: "(1 + x^2)*x'' + x*x'^2 + exp(x) - 1 = 0",
            equilibrium: 0.0,
            // The inertia adds -1/2 of omega0^2 to the third coefficient's share, which the
            // tolerance below leaves out.
            coefficients: [1.0, 0.5, 1.0 / 6.0],
        },
    ]
}

const POWERS: [i32; 8] = [3, 5, 7, 8, 9, 10, 12, 30];

fn at(amplitude: f64) -> Values {
    let mut values = Values::default();
    let text = format!("{amplitude:e}");
    values.insert(Symbol::new("A"), text.parse().unwrap()).unwrap();
    values
}

#[test]
fn the_true_frequency_keeps_its_digits_at_every_amplitude() {
    for case in cases() {
        let oscillator = Oscillator::parse(case.equation).unwrap();
        let options = Options { method: Some(Method::Exact), ..Options::default() };
        let solution = solve(&oscillator, &options).unwrap();
        let [linear, quadratic, cubic] = case.coefficients;
        for power in POWERS.into_iter().filter(|&power| case.equilibrium == 0.0 || power < 14) {
            for side in [1.0, -1.0] {
                let amplitude = side * 10.0_f64.powi(-power);
                let context = format!("{} at {amplitude:e}", case.equation);
                // Landau and Lifshitz, Mechanics, section 28.
                let correction = 0.375 * cubic / linear - 5.0 / 12.0 * (quadratic / linear).powi(2);
                let expected = linear.sqrt() * (1.0 + correction * amplitude * amplitude);
                // The terms left out, and a few units in the last place.
                let scale = 1.0 + (quadratic / linear).abs() + (cubic / linear).abs();
                let slack = 20.0 * scale.powi(3) * amplitude.abs().powi(3) + 2e-13;
                let slack = if case.equation.starts_with('(') {
                    slack + amplitude * amplitude
                } else {
                    slack
                };
                let given = BTreeMap::from([(Symbol::new("A"), amplitude)]);
                let found = numbers::evaluate(&oscillator, &solution, &given).unwrap();
                let error = found.frequency_squared.sqrt() / expected - 1.0;
                assert!(error.abs() < slack, "{context}: exact {error:e}");
                let judged = judge(&oscillator, &solution, &at(amplitude), 0.01).unwrap();
                let error = judged.true_frequency / expected - 1.0;
                // By Runge-Kutta where there is no energy without an integrating factor.
                let slack = if case.equation.starts_with('(') { slack + 1e-10 } else { slack };
                assert!(error.abs() < slack, "{context}: true {error:e}");
                // The formula's own rounding of the equilibrium, beside the amplitude.
                let rounding = 1e-8 + 4.0 * f64::EPSILON * case.equilibrium / amplitude.abs();
                let deviation = judged.max_deviation.expect("a motion");
                assert!(deviation < rounding, "{context}: deviation {deviation:e}");
                let residual = judged.residual.expect("a motion");
                assert!(residual < 100.0 * rounding, "{context}: residual {residual:e}");
            }
        }
    }
}

/// `sin x = 1/3` has the separatrix through `pi - asin(1/3)`, however small the amplitude asked for
/// is; `exp(x) - 1` has none.
#[test]
fn the_edge_of_the_well_does_not_depend_on_the_amplitude_asked_for() {
    let oscillator = Oscillator::parse("x'' + sin(x) - 1/3 = 0").unwrap();
    let solution = solve(&oscillator, &Options::default()).unwrap();
    let high = std::f64::consts::PI - 2.0 * (1.0_f64 / 3.0).asin();
    for power in [1, 4, 7, 9] {
        let judged = judge(&oscillator, &solution, &at(10.0_f64.powi(-power)), 0.01).unwrap();
        let text = &judged.ranges[0].text;
        let end = format!("< A < {}", lindstedt::export::significant(high, 6));
        assert!(text.contains(&end), "1e-{power}: {text}, not {end}");
    }
    let oscillator = Oscillator::parse("x'' + exp(x) - 1 = 0").unwrap();
    let solution = solve(&oscillator, &Options::default()).unwrap();
    for power in [8, 16, 30, 100] {
        let judged = judge(&oscillator, &solution, &at(10.0_f64.powi(-power)), 0.01).unwrap();
        let texts: Vec<&str> = judged.ranges.iter().map(|range| range.text.as_str()).collect();
        assert!(texts.iter().all(|text| !text.contains("periodic for")), "1e-{power}: {texts:?}");
    }
}

/// A barrier beyond the part of the motion in which rounding shows is not lost with it: two halves
/// of linear motions, joined where the barrier begins.
#[test]
fn a_barrier_far_from_rest_stays_in_the_force() {
    for (length, stiffness) in [(378_000.0_f64, 566e18_f64), (0.378, 566e18), (1e-7, 1e9)] {
        let equation = format!("x'' + 241e13*x + {stiffness}*max(x - {length}, 0) = 0");
        let oscillator = Oscillator::parse(&equation).unwrap();
        let options = Options { method: Some(Method::Exact), ..Options::default() };
        let solution = solve(&oscillator, &options).unwrap();
        let amplitude = -10.0 / 3.0 * length;
        let given = BTreeMap::from([(Symbol::new("A"), amplitude)]);
        let found =
            numbers::evaluate(&oscillator, &solution, &given).unwrap().frequency_squared.sqrt();
        // Behind the barrier: a linear motion about another centre, entered at the speed of the
        // first.
        let (outer, inner) = (241e13_f64.sqrt(), (241e13 + stiffness).sqrt());
        let centre = stiffness * length / (241e13 + stiffness);
        let speed = outer * (amplitude * amplitude - length * length).sqrt();
        let behind = 2.0 * (speed / inner).atan2(length - centre) / inner;
        let before = 2.0 * (std::f64::consts::PI - (length / amplitude.abs()).acos()) / outer;
        let expected = std::f64::consts::TAU / (behind + before);
        assert!((found / expected - 1.0).abs() < 1e-9, "{equation}: {found} {expected}");
    }
}
