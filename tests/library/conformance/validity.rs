//! Where formulas hold: ranges, negative amplitudes, and which cycles attract.

use lindstedt::Oscillator;
use lindstedt::Values;
use lindstedt::method::numbers::evaluate;
use lindstedt::solution::Method;
use lindstedt::verify::judge;

use super::{by, numbers};

#[test]
fn validity_is_measured() {
    let ranges = |equation: &str, method, entries: &[(&str, &str)]| -> String {
        let solution = by(equation, method).unwrap();
        let mut values = Values::default();
        for (name, value) in entries {
            values.insert((*name).into(), value.parse().unwrap()).unwrap();
        }
        let verification =
            judge(&Oscillator::parse(equation).unwrap(), &solution, &values, 0.01).unwrap();
        verification
            .ranges
            .iter()
            .map(|range| format!("{} {}\n", range.outside, range.text))
            .collect()
    };
    let pendulum = ranges("x'' + sin(x) = 0", Method::LindstedtPoincare, &[("A", "1.5")]);
    assert!(pendulum.contains("periodic for |A| < 3.14159"), "{pendulum}");
    assert!(pendulum.contains("false the series converges for |A| < about 3.14"), "{pendulum}");
    let cubic = ranges("x'' + x - x^3/6 = 0", Method::HomotopyPerturbation, &[("A", "1.5")]);
    assert!(cubic.contains("periodic for |A| < 2.44949"), "{cubic}");
    let first = ranges("x'' + sin(x) = 0", Method::FrequencyFormula, &[("A", "2.5")]);
    assert!(first.contains("omega^2 of the formula reaches zero at A = 3.14159"), "{first}");
    assert!(first.contains("true within 1 % up to A = 1.6"), "{first}");
    // Duffing: the separatrix of the softening side, s = -1, bounds the series of the hardening one
    // as well.
    let duffing =
        ranges("x'' + x + eps*x^3 = 0", Method::LindstedtPoincare, &[("A", "1"), ("eps", "2")]);
    let (_, radius) =
        duffing.split_once("true the series converges for |eps| < about ").expect("a radius");
    let radius: f64 =
        radius.split(':').next().and_then(|number| number.parse().ok()).expect("a number");
    assert!((radius - 1.0).abs() < 0.01 && duffing.contains("at eps = -"), "{duffing}");
    // V(-1) = 1/6 is V(1/2): released on the right, the motion leaves over the left edge.
    let quadratic = ranges("x'' + x + x^2 = 0", Method::LindstedtPoincare, &[("A", "1/4")]);
    assert!(quadratic.contains("periodic for -1 < A < 0.5:"), "{quadratic}");
    let quadratic = ranges("x'' + x + x^2 = 0", Method::LindstedtPoincare, &[("A", "-1/4")]);
    assert!(quadratic.contains("periodic for -1 < A < 0.5:"), "{quadratic}");
}

/// Negative amplitudes are the same motion half a period on, where the force is odd.
#[test]
fn negative_amplitudes() {
    for equation in ["x'' + sin(x) = 0", "x'' + x*abs(x) = 0", "x'' + x + x^3 = 0"] {
        let oscillator = Oscillator::parse(equation).unwrap();
        for method in Method::ALL {
            let Ok(solution) = by(equation, method) else {
                continue;
            };
            let [plus, minus] = [0.7, -0.7].map(|a| {
                evaluate(&oscillator, &solution, &numbers(&[("A", a), ("a", a)]))
                    .unwrap_or_else(|reason| panic!("{}: {reason}", method.name()))
            });
            assert!(
                (plus.frequency_squared / minus.frequency_squared - 1.0).abs() < 1e-10,
                "{equation} {}",
                method.name()
            );
            let [plus, minus] = [plus.motion.unwrap(), minus.motion.unwrap()];
            for theta in [0.0, 0.4, 2.0] {
                assert!(
                    (plus.evaluate(theta) + minus.evaluate(theta)).abs() < 1e-9,
                    "{equation} {}",
                    method.name()
                );
            }
        }
    }
}

/// What is said of the stability of a limit cycle is what one swing of Runge-Kutta does beside it.
#[test]
fn limit_cycles_attract_or_repel_as_said() {
    for (equation, parameter, amplitude) in [
        ("x'' - mu*(1 - x^2)*x' + x = 0", "mu", 2.0),
        ("x'' - mu*(1 - x'^2/3)*x' + x = 0", "mu", 2.0),
        ("x'' + 4*x + eps*(x' - x'*x^2/3) = 0", "eps", 12f64.sqrt()),
    ] {
        let oscillator = Oscillator::parse(equation).unwrap();
        let solution = by(equation, Method::LindstedtPoincare).unwrap();
        for value in [0.05, -0.05] {
            let said = solution
                .validity
                .iter()
                .map(ToString::to_string)
                .find(|line| line.contains("limit cycle"))
                .expect(equation);
            let attracts = said.contains(&format!(
                "attracts for {parameter} {} 0",
                if value > 0.0 { '>' } else { '<' }
            ));
            let acceleration = |_: f64, x: f64, v: f64| {
                let values = numbers(&[("x", x), ("x'", v), (parameter, value)]);
                -oscillator.force.evaluate(&values).unwrap()
            };
            let drift = |start: f64| {
                lindstedt::numeric::period::swing(&acceleration, 0.0, start, 20.0).unwrap().end().x
                    - start
            };
            let (inside, outside) = (drift(0.9 * amplitude), drift(1.1 * amplitude));
            assert!(inside * outside < 0.0, "{equation} {value}: {inside} {outside}");
            assert_eq!(attracts, inside > 0.0, "{equation} {value}: {said}");
        }
    }
}
