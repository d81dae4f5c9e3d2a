//! Expansions against each other: homotopies, Pade, and the exact frequency expanded.

use std::collections::BTreeMap;

use lindstedt::Values;
use lindstedt::exact::Rational;
use lindstedt::exact::ratio;
use lindstedt::expr::Expr;
use lindstedt::method::numbers::evaluate;
use lindstedt::method::{Options, Reason, Refusal};
use lindstedt::solution::{AmplitudeConvention, Degrees, Method, Solution};
use lindstedt::verify::judge;
use lindstedt::{Oscillator, Symbol};

use super::{by, by_options, numbers, squared};

/// mathematics.md 1.7: homotopy analysis at hbar = -1 and homotopy perturbation share the first
/// frequency, the first correction, and omega^2 through s^3; not more.
#[test]
fn homotopy_analysis_and_homotopy_perturbation() {
    let equation = "x'' + x + eps*x^3 = 0";
    let analysis = |order| {
        by_options(
            equation,
            Options {
                method: Some(Method::HomotopyAnalysis),
                order: Some(order),
                hbar: Some(Expr::from(-1)),
                ..Options::default()
            },
        )
        .unwrap()
    };
    let perturbation = by_options(
        equation,
        Options {
            method: Some(Method::HomotopyPerturbation),
            order: Some(2),
            ..Options::default()
        },
    )
    .unwrap();
    let at =
        |solution: &Solution, s: f64| squared(equation, solution, &[("eps", s), ("A", 1.0)]).sqrt();
    let second = analysis(2);
    let first = |s: f64| (1.0 + 0.75 * s).sqrt();
    for s in [0.1, 2.0, 50.0] {
        let by_hand = first(s) - 3.0 * s * s / (256.0 * first(s).powi(3));
        assert!((at(&second, s) / by_hand - 1.0).abs() < 1e-14);
        assert!((at(&analysis(1), s) / first(s) - 1.0).abs() < 1e-14);
    }
    assert!(
        (at(&second, 2.0) - 1.569280).abs() < 1e-6
            && (at(&perturbation, 2.0) - 1.569051).abs() < 1e-6
    );
    // Through s^3: the difference of omega^2 falls like s^4.
    let difference = |s: f64| (at(&second, s).powi(2) - at(&perturbation, s).powi(2)).abs();
    let slope = (difference(0.04) / difference(0.02)).log2();
    assert!((slope - 4.0).abs() < 0.1, "{slope}");
    // The best hbar is better than -1, by the residual that it minimises.
    let free = by(equation, Method::HomotopyAnalysis).unwrap();
    let oscillator = Oscillator::parse(equation).unwrap();
    let chosen =
        evaluate(&oscillator, &free, &numbers(&[("eps", 2.0), ("A", 1.0)])).unwrap().chosen;
    assert!(chosen.len() == 1 && chosen[0].1 < -0.8 && chosen[0].1 > -1.3, "{chosen:?}");
    let residual = |solution: &Solution| {
        let mut values = Values::default();
        values.insert("A".into(), Expr::one()).unwrap();
        values.insert("eps".into(), Expr::from(2)).unwrap();
        judge(&oscillator, solution, &values, 0.01).unwrap().residual.unwrap()
    };
    assert!(residual(&free) <= residual(&second), "{} {}", residual(&free), residual(&second));
    // Orders converge on the exact frequency at hbar = -1.
    let exact = at(&by(equation, Method::Exact).unwrap(), 5.0);
    let errors: Vec<f64> =
        (1..=5).map(|order| (at(&analysis(order), 5.0) / exact - 1.0).abs()).collect();
    assert!(errors[4] < 1e-5 && errors[4] < errors[1] / 10.0, "{errors:?}");
}

/// A Pade approximant re-expands to the exact series through its last coefficient.
#[test]
fn pade_approximants_agree_with_the_series() {
    for (equation, small, degrees) in [
        ("x'' + x + eps*x^3 = 0", "eps", [(1, 1), (2, 1), (3, 2), (2, 3)]),
        ("x'' + sin(x) = 0", "A", [(1, 1), (2, 1), (3, 2), (2, 2)]),
        ("x'' + x + x^2 = 0", "A", [(2, 1), (3, 1), (2, 2), (3, 3)]),
        ("x'' + x + eps*(alpha*x^3 + beta*x^5) = 0", "eps", [(1, 1), (2, 1), (1, 2), (2, 2)]),
    ] {
        for degrees in degrees {
            let options = Options {
                method: Some(Method::Pade),
                degrees: Some(Degrees::Quotient(degrees.0, degrees.1)),
                ..Options::default()
            };
            let solution = by_options(equation, options).expect(equation);
            let value = &solution.law.closed_form().expect("a quotient").value;
            let zero: Rational = ratio(0, 1);
            let even = small == "A" && equation.contains("sin");
            let highest = (degrees.0 + degrees.1) * if even { 2 } else { 1 };
            let parts = lindstedt::series::taylor(value, &[(small.into(), zero)], highest)
                .expect("a series");
            let law = by_options(
                equation,
                Options {
                    method: Some(Method::LindstedtPoincare),
                    order: Some(highest),
                    ..Options::default()
                },
            )
            .unwrap();
            let law = law.law.frequency_squared().unwrap();
            let difference = Expr::sum(parts) - Expr::from(law);
            if difference.symbols().len() < 3 {
                let difference = difference.expand().expect("a sum");
                assert!(difference.is_zero(), "{equation} {degrees:?}: {difference}");
                continue;
            }
            // A rational function of several symbols: zero where it is tried, at fractions.
            for (alpha, beta, amplitude) in [(2, 3, 1), (-1, 5, 2), (7, -2, 3)] {
                let point = [("alpha", alpha), ("beta", beta), ("A", amplitude), ("eps", 5)];
                let point =
                    point.map(|(name, value)| (Symbol::new(name), Expr::from(value))).into();
                let value = difference.substitute_all(&point).unwrap().expand().unwrap();
                assert!(value.is_zero(), "{equation} {degrees:?}: {value}");
            }
        }
    }
    // mathematics.md 1.8: bounded for every s, from a series that diverges at s = 1.
    let duffing = by("x'' + x + eps*x^3 = 0", Method::Pade).unwrap();
    let exact = by("x'' + x + eps*x^3 = 0", Method::Exact).unwrap();
    for s in [0.1, 1.0, 10.0, 1000.0] {
        let [found, expected] = [&duffing, &exact].map(|solution| {
            squared("x'' + x + eps*x^3 = 0", solution, &[("eps", s), ("A", 1.0)]).sqrt()
        });
        assert!((found / expected - 1.0).abs() < 6.95e-4, "{s}: {found} {expected}");
    }
    // omega^2 = 1 - 5/6 A^2 + ... has no A^1: [1/1] in A does not exist.
    let singular = Options {
        method: Some(Method::Pade),
        degrees: Some(Degrees::Quotient(1, 1)),
        ..Options::default()
    };
    assert!(matches!(
        by_options("x'' + x + x^2 = 0", singular),
        Err(Refusal { reason: Reason::Approximant { .. }, .. })
    ));
    let linear = Options {
        method: Some(Method::Pade),
        degrees: Some(Degrees::Quotient(1, 1)),
        ..Options::default()
    };
    assert!(matches!(
        by_options("x'' + x = 0", linear),
        Err(Refusal { reason: Reason::Approximant { .. }, .. })
    ));
}

/// P + Q f + R f^2 of a quadratic approximant begins with the power that its degrees promise, f the
/// exact series, and the root of its formula is that series near rest.
#[test]
fn hermite_pade_approximants_agree_with_the_series() {
    for (equation, small, [p, q, r]) in [
        ("x'' + x + eps*x^3 = 0", "eps", [1, 1, 1]),
        ("x'' + x + eps*x^3 = 0", "eps", [3, 2, 4]),
        ("x'' + k*x + eps*x^3 = 0", "eps", [2, 2, 2]),
        ("x'' + sin(x) = 0", "A", [2, 3, 1]),
        ("x'' + x + x^2 = 0", "A", [2, 2, 2]),
        ("x'' - mu*(1 - x^2)*x' + x = 0", "mu", [2, 2, 2]),
    ] {
        let options = Options {
            method: Some(Method::HermitePade),
            degrees: Some(Degrees::Quadratic(p, q, r)),
            ..Options::default()
        };
        let solution = by_options(equation, options).expect(equation);
        // Even series run in the square.
        let step = if small == "eps" || equation.contains("x^2 = 0") { 1 } else { 2 };
        let powers = step * (p + q + r + 2);
        let series = Options {
            method: Some(Method::LindstedtPoincare),
            order: Some(powers + 2),
            frequency_alone: true,
            ..Options::default()
        };
        let series = by_options(equation, series).expect(equation);
        let law = Expr::from(series.law.frequency_squared().expect("a series"));
        let at_rest = law.substitute(small.into(), &Expr::zero()).expect("a number");
        let f = Expr::divide(&law, &at_rest).expect("no division by zero");
        let letter = |name: &str| {
            let own = solution.definitions.iter().find(|own| own.symbol.name() == name);
            own.expect("a definition").meaning.clone()
        };
        let defect = &(&letter("P") + &(&letter("Q") * &f)) + &(&letter("R") * &(&f * &f));
        let defect = defect.expand().expect("a sum");
        let polynomial =
            defect.to_polynomial(&mut |_| None).expect("no error").expect("a polynomial");
        let (lowest, _) = polynomial.exponent_range(small.into()).expect("terms");
        assert_eq!(lowest, powers as i32, "{equation}: {defect}");
        // Beside rest, where the series itself is good.
        let size = if small == "eps" { 1e-3 } else { 0.03 };
        let values: Vec<(&str, f64)> =
            vec![(small, size), ("A", if small == "A" { size } else { 1.0 }), ("k", 2.0)];
        let values: Vec<(&str, f64)> = values
            .into_iter()
            .filter(|(name, value)| {
                (*name == small) == (*value == size) && (*name != "k" || equation.contains("k*x"))
            })
            .collect();
        let [found, expected] = [&solution, &series].map(|own| squared(equation, own, &values));
        assert!((found / expected - 1.0).abs() < 1e-13, "{equation}: {found} {expected}");
    }
}

/// Lindstedt-Poincare at order n is the expansion of the exact frequency to order n: the elliptic
/// law, expanded exactly by the series of K and of a power, gives the same fractions.
#[test]
fn lindstedt_poincare_is_the_expansion_of_the_exact_frequency() {
    // omega = pi sqrt(1+s)/(2 K(m)) with m = s/(2(1+s)); 2K/pi = sum [binomial(2k,k)/4^k]^2 m^k.
    let order = 8;
    let mut series = Expr::zero();
    let mut coefficient = ratio(1, 1);
    let m: Expr = "eps/(2*(1 + eps))".parse().unwrap();
    for k in 0..=i64::from(order) {
        let power = if k == 0 { Expr::one() } else { m.integer_power(k).unwrap() };
        series = series + Expr::number(&coefficient * &coefficient) * power;
        coefficient *= ratio(2 * k + 1, 2 * k + 2);
    }
    let root: Expr = "sqrt(1 + eps)".parse().unwrap();
    let law = Expr::divide(&root, &series).unwrap();
    let parts = lindstedt::series::taylor(&law, &[("eps".into(), ratio(0, 1))], order).unwrap();
    let expected = Expr::sum(parts).expand().unwrap();
    let solution = by_options(
        "x'' + x + eps*x^3 = 0",
        Options {
            method: Some(Method::LindstedtPoincare),
            order: Some(order),
            ..Options::default()
        },
    )
    .unwrap();
    let found =
        Expr::from(solution.law.frequency().unwrap()).substitute("A".into(), &Expr::one()).unwrap();
    assert_eq!(found.expand().unwrap(), expected);
}

/// The two conventions of the amplitude agree once one is converted into the other by the motion
/// itself.
#[test]
fn amplitude_conventions_agree_after_conversion() {
    for equation in ["x'' + x + eps*x^3 = 0", "x'' + sin(x) = 0", "x'' + x + eps*x^2 = 0"] {
        let with = |amplitude| {
            let order = if equation.contains("eps") { 4 } else { 8 };
            let options = Options {
                method: Some(Method::LindstedtPoincare),
                order: Some(order),
                amplitude: Some(amplitude),
                ..Options::default()
            };
            by_options(equation, options).unwrap()
        };
        let (initial, first) =
            (with(AmplitudeConvention::Initial), with(AmplitudeConvention::FirstHarmonic));
        let difference = |size: f64| {
            let values =
                numbers(&[("a", size), ("eps", if equation.contains("eps") { size } else { 1.0 })]);
            let value = |symbol| values.get(&symbol).copied();
            // x(0) of the motion with first harmonic a is the A of the other convention.
            let motion = first.motion(&value).unwrap();
            let equilibrium = 0.0;
            let mut converted = values.clone();
            converted.insert("A".into(), motion.evaluate(0.0) - equilibrium);
            let omega = |solution: &Solution, values: &BTreeMap<Symbol, f64>| {
                solution.frequency_squared_at(&|symbol| values.get(&symbol).copied()).unwrap()
            };
            (omega(&initial, &converted) - omega(&first, &values)).abs()
        };
        // Beyond the order kept the difference vanishes faster than the last term kept.
        let slope = (difference(0.4) / difference(0.2)).log2();
        assert!(slope > 9.5, "{equation}: {slope}");
    }
}
