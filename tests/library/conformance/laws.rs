//! Closed forms against projections by quadrature, laws derived by hand, and the exact frequency.

use lindstedt::Oscillator;
use lindstedt::Values;
use lindstedt::expr::Expr;
use lindstedt::method::Options;
use lindstedt::numeric::period::{PiecewiseForce, conservative_period};
use lindstedt::solution::{Method, Solution};
use lindstedt::verify::comparison::compare;

use super::{by, by_options, numbers, squared};

/// mathematics.md 1.4: one formula behind many names. Exactly: the laws are equal as expressions.
#[test]
fn the_methods_of_the_shared_integral_agree_exactly() {
    let shared = [
        Method::IterationPerturbation,
        Method::MaxMin,
        Method::Hamiltonian,
        Method::VariationalIteration,
    ];
    let with_order =
        |method, order| Options { method: Some(method), order: Some(order), ..Options::default() };
    let law = |solution: &Solution| -> Expr {
        match (solution.law.frequency_squared(), solution.law.closed_form()) {
            (Some(law), _) => Expr::from(law),
            (None, Some(form)) => form.value.expand().expect("a sum"),
            (None, None) => panic!("{} has no law", solution.method.name()),
        }
    };
    for equation in [
        "x'' + x + eps*x^3 = 0",
        "x'' + x - x^3/6 + x^5/120 = 0",
        "x'' + alpha*x + eps*x^3 + beta*x^7 = 0",
        "x'' + sin(x) = 0",
        "x'' + k*sin(2*x) + sinh(x/3) = 0",
        "x'' + x + eps*x*abs(x) = 0",
        "x'' + x^3 = 0",
        "x'' + x + sgn(x)*abs(x)^(5/2) = 0",
    ] {
        let reference =
            law(&by_options(equation, with_order(Method::HarmonicBalance, 1)).expect(equation));
        for method in shared {
            assert_eq!(
                law(&by(equation, method).expect(equation)),
                reference,
                "{equation} by {}",
                method.name()
            );
        }
        let parameter =
            law(&by_options(equation, with_order(Method::ParameterExpansion, 1)).expect(equation));
        assert_eq!(parameter, reference, "{equation}");
    }
    // Where the force is a polynomial, homotopy perturbation and homotopy analysis begin there as
    // well.
    for equation in ["x'' + x + eps*x^3 = 0", "x'' + alpha*x + eps*x^3 + beta*x^7 = 0"] {
        let reference =
            law(&by_options(equation, with_order(Method::HarmonicBalance, 1)).expect(equation));
        let homotopy =
            by_options(equation, with_order(Method::HomotopyPerturbation, 1)).expect(equation);
        assert_eq!(law(&homotopy), reference, "{equation}");
        let analysis =
            by_options(equation, with_order(Method::HomotopyAnalysis, 1)).expect(equation);
        let root = &analysis.definitions.last().expect("w0").meaning;
        assert_eq!(root.integer_power(2).unwrap().expand().unwrap(), reference, "{equation}");
    }
}

#[test]
fn closed_forms_of_the_shared_integral() {
    for (equation, law) in [
        ("x'' + x + eps*x^3 = 0", "1 + 3/4*eps*A^2"),
        ("x'' + x - x^3/6 = 0", "1 - A^2/8"),
        ("x'' + x - x^3/6 + x^5/120 = 0", "1 - A^2/8 + A^4/192"),
        ("x'' + sin(x) = 0", "2*J1(A)/A"),
        ("x'' + sinh(x) = 0", "2*I1(A)/A"),
        ("x'' + x + eps*x*abs(x) = 0", "1 + 8*eps*A/(3*pi)"),
        ("x'' + sgn(x) = 0", "4/(pi*A)"),
        ("x'' + x^(1/3) = 0", "2*Gamma(7/6)/(sqrt(pi)*Gamma(5/3)*A^(2/3))"),
        ("x'' + x^3/(1 + x^2) = 0", "1 - 2/A^2 + 2/(A^2*sqrt(1 + A^2))"),
    ] {
        let solution = by(equation, Method::Hamiltonian)
            .or_else(|_| by(equation, Method::IterationPerturbation))
            .expect(equation);
        let expected: Expr = law.parse().unwrap();
        for amplitude in [0.4, 1.3, 2.2, -1.3] {
            let found = squared(equation, &solution, &[("A", amplitude), ("eps", 0.7)]);
            let value =
                expected.evaluate(&numbers(&[("A", f64::abs(amplitude)), ("eps", 0.7)])).unwrap();
            assert!(
                (found / value - 1.0).abs() < 1e-12,
                "{equation} at {amplitude}: {found} {value}"
            );
        }
    }
}

/// A barrier on either side, by arcs: against the integral between the edges.
#[test]
fn barriers_by_arcs() {
    let equation = "x'' + x + k*(x - xc)^2*H(x - xc) - k*(-x - xc)^2*H(-x - xc) = 0";
    let solution = by(equation, Method::Hamiltonian).unwrap();
    let (k, edge): (f64, f64) = (3.0, 0.4);
    for amplitude in [0.3, 0.41, 0.9, 2.0] {
        let arc = f64::acos(f64::min(1.0, edge / amplitude));
        let integrand = |theta: f64| (amplitude * theta.cos() - edge).powi(2) * theta.cos();
        let integral = lindstedt::numeric::ode::quadrature::integrate_smooth(
            integrand,
            0.0,
            arc.max(1e-300),
            1e-13,
        )
        .unwrap()
        .0;
        let expected = 1.0 + 4.0 * k * integral / (std::f64::consts::PI * amplitude);
        let found = squared(equation, &solution, &[("A", amplitude), ("k", k), ("xc", edge)]);
        assert!((found / expected - 1.0).abs() < 1e-11, "{amplitude}: {found} {expected}");
    }
    // A fractional power is done by numbers.
    let hertz = "x'' + x + k*(x - xc)^(3/2)*H(x - xc) - k*(-x - xc)^(3/2)*H(-x - xc) = 0";
    let solution = by(hertz, Method::Hamiltonian).unwrap();
    assert!(solution.law.quadrature().is_some());
    let integrand = |theta: f64| (2.0 * theta.cos() - edge).powf(1.5) * theta.cos();
    let arc = f64::acos(edge / 2.0);
    // theta = arc (1 - u^2) takes the root out of the end.
    let smooth = |u: f64| 2.0 * arc * u * integrand(arc * (1.0 - u * u));
    let integral =
        lindstedt::numeric::ode::quadrature::integrate_smooth(smooth, 0.0, 1.0, 1e-13).unwrap().0;
    let expected = 1.0 + 4.0 * k * integral / (std::f64::consts::PI * 2.0);
    let found = squared(hertz, &solution, &[("A", 2.0), ("k", k), ("xc", edge)]);
    assert!((found / expected - 1.0).abs() < 1e-8, "{found} {expected}");
}

/// The formulas of He's family on Duffing and the pendulum, by hand.
#[test]
fn laws_derived_by_hand() {
    type Case<'a> = (&'a str, Method, &'a dyn Fn(f64) -> f64);
    let cases: [Case; 9] = [
        ("x'' + sin(x) = 0", Method::EnergyBalance, &|a| {
            4.0 * ((a / 2f64.sqrt()).cos() - a.cos()) / (a * a)
        }),
        ("x'' + sin(x) = 0", Method::FrequencyFormula, &|a| (a / 2.0).cos()),
        ("x'' + sin(x) = 0", Method::AmplitudeFrequency, &|a| {
            let place = 0.75f64.sqrt() * a;
            place.sin() / place
        }),
        ("x'' + x + x^3 = 0", Method::EnergyBalance, &|a| 1.0 + 0.75 * a * a),
        ("x'' + x + x^3 = 0", Method::FrequencyFormula, &|a| 1.0 + 0.75 * a * a),
        ("x'' + x + x^3 = 0", Method::AmplitudeFrequency, &|a| 1.0 + 0.75 * a * a),
        ("x'' + x + x^3 = 0", Method::MaxMin, &|a| 1.0 + 0.75 * a * a),
        ("x'' + x + x^5 = 0", Method::FrequencyFormula, &|a| 1.0 + 5.0 * (a / 2.0).powi(4)),
        ("x'' + x + x^5 = 0", Method::EnergyBalance, &|a| 1.0 + 7.0 / 12.0 * a.powi(4)),
    ];
    for (equation, method, by_hand) in cases {
        let solution = by(equation, method).expect(equation);
        for amplitude in [0.3, 1.0, 1.9] {
            let found = squared(equation, &solution, &[("A", amplitude)]);
            assert!(
                (found / by_hand(amplitude) - 1.0).abs() < 1e-12,
                "{equation} {}: {found}",
                method.name()
            );
        }
    }
}

/// Exact frequencies in closed form against quadrature of the energy, which knows nothing of
/// elliptic functions.
#[test]
fn exact_frequencies() {
    let forms: [(&str, &[(&str, f64)]); 15] = [
        ("x'' + sin(x) = 0", &[]),
        ("x'' + k*sin(2*x) = 0", &[("k", 0.7)]),
        ("x'' + sinh(x/2) = 0", &[]),
        ("x'' + x + eps*x^3 = 0", &[("eps", 0.8)]),
        ("x'' + x + eps*x^3 = 0", &[("eps", -0.3)]),
        ("x'' + 2*x + eps*x^5 = 0", &[("eps", 0.5)]),
        ("x'' + x + eps*x^3 + beta*x^5 = 0", &[("eps", -0.5), ("beta", 0.4)]),
        ("x'' + x^3 + x^5 = 0", &[]),
        ("x'' + x + eps*x^2 = 0", &[("eps", 0.3)]),
        ("x'' + x + eps*x^2 = 0", &[("eps", -0.3)]),
        ("x'' + x^3 = 0", &[]),
        ("x'' + k*x^7 = 0", &[("k", 2.0)]),
        ("x'' + x*abs(x) = 0", &[]),
        ("x'' + x^(1/3) = 0", &[]),
        ("x'' + sgn(x) = 0", &[]),
    ];
    for (equation, parameters) in forms {
        let solution = by(equation, Method::Exact).expect(equation);
        assert!(solution.law.closed_form().is_some(), "{equation}");
        let oscillator = Oscillator::parse(equation).unwrap();
        for amplitude in [0.2, 0.9, -0.9, 1.2] {
            let mut entries = parameters.to_vec();
            entries.push(("A", amplitude));
            let values = numbers(&entries);
            let force = |x: f64| {
                let mut values = values.clone();
                values.insert("x".into(), x);
                oscillator.force.evaluate(&values).unwrap()
            };
            let found = squared(equation, &solution, &entries).sqrt();
            let expected = match equation {
                // Constant pulls, for which time is elementary: a quarter of the period is sqrt(2
                // A).
                "x'' + sgn(x) = 0" => {
                    std::f64::consts::TAU / (4.0 * (2.0 * f64::abs(amplitude)).sqrt())
                }
                _ => {
                    std::f64::consts::TAU
                        / conservative_period(&PiecewiseForce::smooth(&force), 0.0, amplitude)
                            .unwrap()
                }
            };
            // The cube root has no smooth force at the middle: the quadrature is good to less
            // there.
            let tolerance =
                if equation.contains("^(1/3)") || equation.contains("abs") { 1e-8 } else { 1e-11 };
            assert!(
                (found / expected - 1.0).abs() < tolerance,
                "{equation} {entries:?}: {found} {expected}"
            );
        }
    }
    // mathematics.md 1.1 and 1.4
    for (equation, amplitude, value) in [
        ("x'' + sin(x) = 0", 1.5, 0.860608346679613),
        ("x'' + sin(x) = 0", 3.0, 0.388918324690311),
        ("x'' + x + x^3 = 0", 10f64.sqrt(), 2.86664013663241),
        ("x'' + x^3 = 0", 1.0, 0.847213084793979),
        ("x'' + x*abs(x) = 0", 1.0, 0.914681356502),
        ("x'' + x^(1/3) = 0", 1.0, 1.07045051404),
    ] {
        let found =
            squared(equation, &by(equation, Method::Exact).unwrap(), &[("A", amplitude)]).sqrt();
        assert!((found / value - 1.0).abs() < 1e-11, "{equation}: {found}");
    }
}

#[test]
fn the_table_of_the_pendulum() {
    let oscillator = Oscillator::parse("x'' + sin(x) = 0").unwrap();
    // mathematics.md 1.5, in per cent.
    for (amplitude, errors) in [
        (
            "1",
            [
                ("hamiltonian", 0.037),
                ("energy-balance", 0.018),
                ("frequency-formula", -0.106),
                ("amplitude-frequency", 0.0085),
            ],
        ),
        (
            "1.5",
            [
                ("hamiltonian", 0.22),
                ("energy-balance", 0.113),
                ("frequency-formula", -0.61),
                ("amplitude-frequency", 0.061),
            ],
        ),
        (
            "2.5",
            [
                ("hamiltonian", 3.6),
                ("energy-balance", 2.3),
                ("frequency-formula", -7.7),
                ("amplitude-frequency", 1.6),
            ],
        ),
    ] {
        let mut values = Values::default();
        values.insert("A".into(), amplitude.parse().unwrap()).unwrap();
        let table = compare(&oscillator, &values, None, 0.01).unwrap();
        for (name, printed) in errors {
            let row = table.rows.iter().find(|row| row.solution.method.name() == name).expect(name);
            let error: f64 = 100.0 * row.relative_error.unwrap();
            let digits = if f64::abs(printed) < 0.01 {
                0.0001
            } else if f64::abs(printed) < 0.2 {
                0.001
            } else if f64::abs(printed) < 1.0 {
                0.01
            } else {
                0.1
            };
            assert!(
                (error - printed).abs() < 0.51 * digits,
                "{name} at {amplitude}: {error} {printed}"
            );
        }
        assert!(table.refused.is_empty(), "{:?}", table.refused);
    }
}
