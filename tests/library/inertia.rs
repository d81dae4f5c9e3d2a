//! Inertia that depends on the position, by every method that takes it: against Runge-Kutta on the
//! equation as typed, against motions that are known exactly, and against the definitions computed
//! another way.

use lindstedt::Values;
use lindstedt::method::{Options, solve};
use lindstedt::numeric::ode::quadrature::integrate_smooth;
use lindstedt::solution::{AmplitudeConvention, Method};
use lindstedt::verify::{Verification, judge};
use lindstedt::{Oscillator, Solution, Symbol};

fn derived(equation: &str, method: Method, order: Option<u32>) -> (Oscillator, Solution) {
    let oscillator = Oscillator::parse(equation).expect(equation);
    let options = Options { method: Some(method), order, ..Options::default() };
    let solution =
        solve(&oscillator, &options).unwrap_or_else(|refusal| panic!("{equation}: {refusal}"));
    (oscillator, solution)
}

fn judged(equation: &str, method: Method, order: Option<u32>, at: &[(&str, &str)]) -> Verification {
    let (oscillator, solution) = derived(equation, method, order);
    let mut values = Values::default();
    for (name, value) in at {
        values.insert(Symbol::new(name), value.parse().expect("a number")).expect("a value");
    }
    judge(&oscillator, &solution, &values, 0.01)
        .unwrap_or_else(|error| panic!("{equation}: {error}"))
}

/// The judge integrates the equation as typed by Runge-Kutta: it knows nothing of the energy.
#[test]
fn the_exact_frequency_is_that_of_runge_kutta() {
    for (equation, at) in [
        ("(1 + x^2)*x'' + x*x'^2 + x = 0", vec![("A", "1.5")]),
        (
            "(1 + 4*q^2*x^2)*x'' + 4*q^2*x*x'^2 + k*x = 0",
            vec![("A", "0.8"), ("q", "0.7"), ("k", "3")],
        ),
        ("x'' + x*x'^2 + sin(x) = 0", vec![("A", "-1.2")]),
        ("x'' + x*x'^2/3 + x + x^2 = 0", vec![("A", "0.3")]),
        ("x'' + x'^2/4 + x = 0", vec![("A", "0.5")]),
        ("x'' + x'^2*atan(x)^3*sinh(x) + x = 0", vec![("A", "0.6")]),
        ("(2 + cos(x))*x'' - sin(x)*x'^2/2 + 3*sin(x) = 0", vec![("A", "1")]),
        // The same in SI units of a nanometre and a gigahertz.
        ("(1 + 1e18*x^2)*x'' + 1e18*x*x'^2 + 1e18*x = 0", vec![("A", "1.5e-9")]),
    ] {
        let verdict = judged(equation, Method::Exact, None, &at);
        let error = verdict.relative_error.expect("a frequency");
        assert!(error.abs() < 1e-10, "{equation}: {error:e}");
        let deviation = verdict.max_deviation.expect("a motion");
        assert!(deviation < 1e-8, "{equation}: {deviation:e}");
    }
}

/// Mathews and Lakshmanan: `x = A cos(omega t)` solves it with `omega^2 = k/(1 + b A^2)`, so every
/// method that keeps one harmonic must find just that.
#[test]
fn a_nonlinear_oscillator_that_swings_like_a_linear_one() {
    let equation = "(1 + b*x^2)*x'' - b*x*x'^2 + k*x = 0";
    let exact = f64::sqrt(3.0 / (1.0 + 0.7 * 1.44));
    for (method, order) in [
        (Method::Exact, None),
        (Method::Hamiltonian, None),
        (Method::EnergyBalance, None),
        (Method::HarmonicBalance, Some(1)),
        (Method::HarmonicBalance, Some(3)),
    ] {
        for amplitude in ["1.2", "-1.2"] {
            let verdict =
                judged(equation, method, order, &[("A", amplitude), ("b", "0.7"), ("k", "3")]);
            let frequency = verdict.frequency.expect("a frequency");
            assert!(
                (frequency / exact - 1.0).abs() < 1e-11,
                "{}: {frequency} {exact}",
                method.name()
            );
            assert!((verdict.true_frequency / exact - 1.0).abs() < 1e-10);
            assert!(verdict.max_deviation.expect("a motion") < 1e-8, "{}", method.name());
        }
    }
}

/// The laws of one term against their definitions by quadrature:
/// `<(x'' + g x'^2 + h) M cos(theta)> = 0`, and the energy at an eighth of the period.
#[test]
fn laws_of_one_term_are_their_definitions() {
    type Function = fn(f64) -> f64;
    let cases: [(&str, Function, Function, Function); 3] = [
        (
            "(1 + x^2)*x'' + x*x'^2 + x = 0",
            |x| 1.0 + x * x,
            |x| x / (1.0 + x * x),
            |x| x / (1.0 + x * x),
        ),
        ("x'' + x*x'^2 + sin(x) = 0", |x| (x * x).exp(), |x| x, f64::sin),
        (
            "(2 + cos(x))*x'' - sin(x)*x'^2/2 + 3*sin(x) = 0",
            |x| 2.0 + x.cos(),
            |x| -0.5 * x.sin() / (2.0 + x.cos()),
            |x| 3.0 * x.sin() / (2.0 + x.cos()),
        ),
    ];
    for (equation, mass, growth, force) in cases {
        for amplitude in ["0.001", "0.5", "1.3"] {
            let size: f64 = amplitude.parse().expect("a number");
            let frequency = |method, order| {
                let verdict = judged(equation, method, order, &[("A", amplitude)]);
                verdict.frequency.expect("a frequency").powi(2)
            };
            let mean = |function: &dyn Fn(f64, f64) -> f64| {
                let value = |theta: f64| function(theta.cos(), theta.sin());
                integrate_smooth(value, 0.0, std::f64::consts::PI, 1e-13).expect("an integral").0
            };
            let work = mean(&|c, _| mass(size * c) * force(size * c) * c);
            let inertia = mean(&|c, s| {
                mass(size * c) * (size * c * c - growth(size * c) * size * size * s * s * c)
            });
            let found = frequency(Method::Hamiltonian, None);
            assert!(
                (found * inertia / work - 1.0).abs() < 1e-11,
                "{equation}, Hamiltonian at {size}: {found}"
            );
            let eighth = size / f64::sqrt(2.0);
            let rise = integrate_smooth(|x| mass(x) * force(x), eighth, size, 1e-13)
                .expect("an integral")
                .0;
            let expected = 4.0 * rise / (size * size * mass(eighth));
            let found = frequency(Method::EnergyBalance, None);
            assert!(
                (found / expected - 1.0).abs() < 1e-11,
                "{equation}, energy balance at {size}: {found} {expected}"
            );
        }
    }
}

/// Homotopy perturbation of order n is right to the power 2 n of the amplitude, n where there are
/// even terms: its error, against Runge-Kutta on the equation as typed, falls by as much with the
/// amplitude.
#[test]
fn the_error_of_homotopy_perturbation_has_the_power_of_its_order() {
    for (equation, even, at) in [
        ("(1 + x^2)*x'' + x*x'^2 + x = 0", false, vec![]),
        ("x'' + x*x'^2 + sin(x) = 0", false, vec![]),
        ("(1 + b*x^2)*x'' - b*x*x'^2 + k*x = 0", false, vec![("b", "0.7"), ("k", "3")]),
        ("x'' + x'^2/4 + x = 0", true, vec![]),
        ("x'' + x*x'^2/3 + x + x^2 = 0", true, vec![]),
    ] {
        let amplitudes = if even { ["0.02", "0.04"] } else { ["0.1", "0.2"] };
        for order in [1, 2, 3] {
            if even && order == 1 {
                continue;
            }
            let [near, far] = amplitudes.map(|amplitude| {
                let mut values = at.clone();
                values.push(("A", amplitude));
                let verdict = judged(equation, Method::HomotopyPerturbation, Some(order), &values);
                verdict.relative_error.expect("a frequency").abs()
            });
            let power = if even { order + 1 } else { 2 * order + 2 };
            let slope = (far / near).log2();
            // Beyond the order nothing is promised, and near 1e-12 Runge-Kutta itself is heard.
            assert!(
                slope > f64::from(power) - 0.4 || far < 1e-10,
                "{equation} of order {order}: {near:e}, {far:e}"
            );
        }
        // Another way to the same place: Lindstedt-Poincare.
        let (order, power) = if even { (4, 5.0) } else { (2, 6.0) };
        let [near, far] = amplitudes.map(|amplitude| {
            let mut values = at.clone();
            values.push(("A", amplitude));
            let methods = [(Method::HomotopyPerturbation, order), (Method::LindstedtPoincare, 4)];
            let [homotopy, series] = methods.map(|(method, order)| {
                let verdict = judged(equation, method, Some(order), &values);
                verdict.frequency.expect("a frequency")
            });
            (homotopy / series - 1.0).abs()
        });
        assert!((far / near).log2() > power - 0.4, "{equation}: {near:e}, {far:e}");
    }
}

/// One harmonic, whether balanced or freed of its secular term, gives one law:
/// `omega^2 (1 - A^2/4) = 1`.
#[test]
fn the_first_order_of_homotopy_perturbation_is_the_balance_of_one_harmonic() {
    let (_, solution) = derived("x'' + x*x'^2 + x = 0", Method::HomotopyPerturbation, Some(1));
    let law = solution.law.closed_form().expect("a law").value.clone();
    for (amplitude, expected) in [(0.5, 1.0 / (1.0 - 0.0625)), (1.5, 1.0 / (1.0 - 0.5625))] {
        let value = law.evaluate(&std::collections::BTreeMap::from([("A".into(), amplitude)]));
        assert!((value.expect("a number") / expected - 1.0_f64).abs() < 1e-14, "{law}");
    }
    for equation in ["x'' + x*x'^2 + x = 0", "x'' + x^3*x'^2/2 + 2*x - x^3 = 0"] {
        let [one, other] = [Method::HomotopyPerturbation, Method::HarmonicBalance].map(|method| {
            let verdict = judged(equation, method, Some(1), &[("A", "0.8")]);
            verdict.frequency.expect("a frequency")
        });
        assert!((one / other - 1.0).abs() < 1e-12, "{equation}: {one} {other}");
    }
    // Units do not matter: a nanometre and a gigahertz.
    let frequency = |equation, amplitude| {
        let verdict = judged(equation, Method::HomotopyPerturbation, Some(2), &[("A", amplitude)]);
        verdict.frequency.expect("a frequency")
    };
    let plain = frequency("(1 + x^2)*x'' + x*x'^2 + x = 0", "0.3");
    let small = frequency("(1 + 1e18*x^2)*x'' + 1e18*x*x'^2 + 1e18*x = 0", "0.3e-9");
    assert!((small / plain / 1e9 - 1.0).abs() < 1e-12, "{small} {plain}");
}

/// More harmonics come closer to Runge-Kutta, and the balances that are written out hold at the
/// numbers found.
#[test]
fn harmonic_balance_converges_and_its_equations_hold() {
    for (equation, at) in [
        ("(1 + x^2)*x'' + x*x'^2 + x = 0", vec![("A", "0.8")]),
        (
            "(1 + 4*q^2*x^2)*x'' + 4*q^2*x*x'^2 + k*x = 0",
            vec![("A", "-0.5"), ("q", "0.7"), ("k", "3")],
        ),
        ("x'' + x*x'^2/3 + x + x^2 = 0", vec![("A", "0.2")]),
        ("x'' + x*x'^2 + sin(x) = 0", vec![("A", "1")]),
        ("(1 + 1e18*x^2)*x'' + 1e18*x*x'^2 + 1e18*x = 0", vec![("A", "0.8e-9")]),
    ] {
        let mut last = f64::INFINITY;
        for order in [1, 3, 6] {
            let verdict = judged(equation, Method::HarmonicBalance, Some(order), &at);
            let error = verdict.relative_error.expect("a frequency").abs();
            assert!(error < 0.2 * last, "{equation} with {order}: {error:e} after {last:e}");
            last = error;
            let (_, solution) = derived(equation, Method::HarmonicBalance, Some(order));
            let Some(system) = solution.law.system() else {
                continue;
            };
            let mut values: std::collections::BTreeMap<Symbol, f64> = at
                .iter()
                .map(|(name, value)| (Symbol::new(name), value.parse().expect("a number")))
                .collect();
            values.extend(verdict.chosen.iter().copied());
            values.insert("omega".into(), verdict.frequency.expect("a frequency"));
            let squared = verdict.frequency.expect("a frequency").powi(2);
            let size = values[&Symbol::new("A")].abs();
            for balance in &system.equations {
                let value = balance.evaluate(&values).expect("a number");
                assert!(
                    value.abs() < 1e-9 * size * squared.max(1.0),
                    "{equation}: {balance} = {value:e}"
                );
            }
        }
        assert!(last < 1e-6, "{equation}: {last:e}");
    }
}

/// The derivation of a law leads to it, from the factor that gives the equation an energy.
#[test]
fn derivations_lead_from_the_mass_to_the_law() {
    for (equation, mass) in [
        ("(1 + x^2)*x'' + x*x'^2 + x = 0", "M = 1 + x^2"),
        ("(2 + x^2)*x'' + x*x'^2 + x^3 = 0", "M = 2 + x^2"),
    ] {
        for method in [Method::EnergyBalance, Method::Hamiltonian] {
            let (_, solution) = derived(equation, method, None);
            let law = solution.formula();
            let lines: Vec<String> = solution.derivation.iter().map(ToString::to_string).collect();
            assert!(lines[0].ends_with(mass), "{lines:?}");
            assert_eq!(lines.last(), Some(&law), "{}", method.name());
        }
    }
    let (_, exact) = derived("(1 + x^2)*x'' + x*x'^2 + x = 0", Method::Exact, None);
    let words = "exact wherever the motion is periodic, by quadrature of the energy";
    assert!(exact.validity.iter().any(|note| note.to_string() == words), "{:?}", exact.validity);
    for method in
        [Method::Exact, Method::Hamiltonian, Method::EnergyBalance, Method::HarmonicBalance]
    {
        let oscillator = Oscillator::parse("(1 + x^2)*x'' + x*x'^2 + x = 0").expect("an equation");
        let options = Options {
            method: Some(method),
            amplitude: Some(AmplitudeConvention::FirstHarmonic),
            ..Options::default()
        };
        let refusal = solve(&oscillator, &options).expect_err("a refusal").to_string();
        assert!(refusal.contains("measures the amplitude as A = x(0)"), "{refusal}");
    }
}

/// What takes energy away, or is no square of the velocity, is still refused by name.
#[test]
fn other_velocities_are_refused() {
    for (equation, term) in [
        ("x'' + x*x'^2 + x' + x = 0", "x'"),
        ("x'' + x*x'^4 + x = 0", "x*x'^4"),
        ("x'' + x*x'^2 + x + cos(t) = 0", "cos(t)"),
    ] {
        let oscillator = Oscillator::parse(equation).expect("an equation");
        for method in [
            Method::Exact,
            Method::Hamiltonian,
            Method::EnergyBalance,
            Method::HarmonicBalance,
            Method::HomotopyPerturbation,
        ] {
            let options = Options { method: Some(method), ..Options::default() };
            let refusal = solve(&oscillator, &options).expect_err("a refusal").to_string();
            assert!(refusal.contains(&format!("`{term}`")), "{equation}: {refusal}");
        }
    }
}

/// A place at which the inertia is a quotient of zeros is one that the motion passes; one at which
/// it grows like 1/x or faster is not.
#[test]
fn inertia_without_a_value_at_rest_is_refused_and_no_other() {
    for equation in [
        "x'' + x + x'^2*log(1 + x^2)/x = 0",
        "x'' + x + x'^2*sin(x)/x = 0",
        "x'' + x + x'^2*sinh(x)^2/x^2 = 0",
        "x'' + x + x'^2*abs(x)/(5*x) = 0",
    ] {
        let (_, solution) = derived(equation, Method::Exact, None);
        assert!(solution.law.closed_form().is_none(), "{equation}");
        let verdict = judged(equation, Method::Exact, None, &[("A", "0.3")]);
        let error = verdict.relative_error.expect("a frequency");
        assert!(error.abs() < 1e-9, "{equation}: {error:e}");
    }
    for equation in
        ["x'' + x + x'^2/x = 0", "x'' + x + x'^2/x^2 = 0", "x'' + x + x'^2*cos(x)/x = 0"]
    {
        let oscillator = Oscillator::parse(equation).expect(equation);
        for method in [Method::Exact, Method::EnergyBalance, Method::Hamiltonian] {
            let options = Options { method: Some(method), ..Options::default() };
            let refused = solve(&oscillator, &options).expect_err(equation);
            assert!(
                refused.term().is_some_and(|term| equation.contains(term)),
                "{equation}: {refused}"
            );
        }
    }
}
