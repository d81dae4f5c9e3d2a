//! A refusal names the term that was typed, not what the normal form made of it.

use std::path::Path;

use lindstedt::Oscillator;
use lindstedt::method::{Options, Refusal, solve};
use lindstedt::solution::Method;

fn refusal(equation: &str, method: Method, about: Option<&str>) -> Option<Refusal> {
    let mut oscillator = Oscillator::parse(equation).ok()?;
    if let Some(about) = about {
        oscillator = oscillator.about(about.parse().expect("a value"));
    }
    let options = Options { method: Some(method), ..Options::default() };
    solve(&oscillator, &options).err()
}

#[test]
fn the_term_is_the_one_that_was_typed() {
    use Method::{
        EnergyBalance, Exact, Hamiltonian, HarmonicBalance, HomotopyPerturbation,
        LindstedtPoincare, MaxMin, Pade,
    };
    let cases = [
        ("x'' + 0.5*(x')^3 + x = 0", LindstedtPoincare, None, "0.5*(x')^3"),
        ("2*x'' + 0.25*x' + 4*sin(x) = 0", EnergyBalance, None, "0.25*x'"),
        ("x'' - mu*(1 - x^2)*x' + x = 0", HomotopyPerturbation, None, "-mu*(1 - x^2)*x'"),
        ("x'' + x = 0.2 * cos(2*t)", HarmonicBalance, None, "0.2 * cos(2*t)"),
        ("x'' + x = -0.75*x^2*sqrt(4)", MaxMin, None, "-0.75*x^2*sqrt(4)"),
        ("x'' + x*(1 + x)^2 = 0", MaxMin, None, "x*(1 + x)^2"),
        ("x'' + x' + x + 0.5*x' = 0", Hamiltonian, None, "x' + 0.5*x'"),
        ("x'' + x' + x = -0.5*x'", Hamiltonian, None, "x' + 0.5*x'"),
        ("x'' + x + 0.5*x*sin(x')*x' = 0", Exact, None, "0.5*x*sin(x')*x'"),
        ("(1 + x^2)*x'' + x/2 + 0.5*x' = 0", Pade, None, "0.5*x'"),
        ("x'' - x*(1 - x)*(1 + x) = 0", MaxMin, Some("1"), "-x*(1 - x)*(1 + x)"),
        (
            "x'' + 2*x + (0.5*x)*abs(2*x - 1) - 1 = 0",
            LindstedtPoincare,
            Some("1/2"),
            "(0.5*x)*abs(2*x - 1)",
        ),
        ("x'' + x + 0.5*eps*tan(2*x/2) = 0", LindstedtPoincare, None, "0.5*eps*tan(2*x/2)"),
        ("x'' + x + eps*x^3 + 0.10*x^5 = 0", LindstedtPoincare, None, "0.10*x^5"),
    ];
    for (equation, method, about, expected) in cases {
        let refusal = refusal(equation, method, about).expect(equation);
        assert_eq!(refusal.term(), Some(expected), "{equation}: {refusal}");
        assert!(refusal.to_string().contains(&format!("`{expected}`")), "{refusal}");
    }
    let fast = Oscillator::parse("0.5*(x'')^2 + x = 0").unwrap_err().to_string();
    assert!(fast.contains("`0.5*(x'')^2`"), "{fast}");
}

/// A bracket that numbers and parameters scale is no term of its own: what stands in it is quoted,
/// and pointed at where it stands.
#[test]
fn terms_inside_scaled_brackets_are_quoted_as_typed() {
    let cases = [
        ("2*(x'' + x + 0.5*x') = 0", "0.5*x'", 13),
        ("(x'' + x + 0.5*x')/2 = 0", "0.5*x'", 11),
        ("-(x'' + x + 0.5*x') = 0", "0.5*x'", 12),
        ("(x'' + x + 0.5*x') = 0", "0.5*x'", 11),
        ("x'' + x = 3*(-0.5*x' + x^3)", "-0.5*x'", 14),
        ("-2*-(x'' + x) = -3/2*(0.5*x')*4", "0.5*x'", 22),
        ("x'' = -2*(x + 0.25*(3*x' + x^3)/k)", "3*x'", 20),
        ("m*(x'' + ((0.5*x'))) + x = 0", "0.5*x'", 11),
        ("(1 + 1)*(x'' + x - x'*2/3)*(k + 2)/3 = 0", "-x'*2/3", 19),
        ("0 = 1.5*(0.1*(x'' + x) + 0.2*(0.3*x'))", "0.3*x'", 30),
    ];
    for (equation, expected, column) in cases {
        let refused = refusal(equation, Method::Hamiltonian, None).expect(equation);
        assert_eq!(refused.term(), Some(expected), "{equation}: {refused}");
        let oscillator = Oscillator::parse(equation).expect(equation);
        let [line, carets] = oscillator.typed.locate(expected).expect(equation);
        assert_eq!((line.as_str(), carets.find('^')), (equation, Some(column)));
        assert_eq!(carets.matches('^').count(), expected.trim_start_matches('-').len());
    }
    let cases = [
        // Of one bracket the terms alone, of several with their scales, so that their sum is what
        // was typed.
        ("2*(x'' + x' + x + 0.5*x') = 0", "x' + 0.5*x'"),
        ("2*(x'' + x + 0.5*x') + 0.3*x' = 0", "2*(0.5*x') + 0.3*x'"),
        ("x'' + x = -3*(x - 0.5*x')/2 - x'", "-3*(0.5*x')/2 + x'"),
        // No bracket that the motion itself scales.
        ("x'' + x + 2*(1 - x)*(0.5*x') = 0", "2*(1 - x)*(0.5*x')"),
        ("x'' + x + (0.5*x' + 1)^2 = 0", "(0.5*x' + 1)^2"),
        ("x'' + x + 1/(2 + 0.5*x') = 0", "1/(2 + 0.5*x')"),
    ];
    for (equation, expected) in cases {
        let refused = refusal(equation, Method::Hamiltonian, None).expect(equation);
        assert_eq!(refused.term(), Some(expected), "{equation}: {refused}");
    }
    let refused = refusal("x'' + 2*(x + 0.5*x^2) = 0", Method::MaxMin, None).expect("an even term");
    assert_eq!(refused.term(), Some("0.5*x^2"), "{refused}");
}

/// About another equilibrium a term is even or odd there, and the message says where.
#[test]
fn oddness_about_another_equilibrium_is_said_to_be_that() {
    let refusal =
        refusal("x'' - x/2 + 0.5*x^3 = 0", Method::MaxMin, Some("1")).expect("even terms");
    let text = refusal.to_string();
    assert!(text.contains("`0.5*x^3` is not odd about x = 1"), "{text}");
}

/// Every equation among the wrong inputs, by every method: each term named is one of the text, as
/// it stands there.
#[test]
fn every_wrong_equation_is_quoted() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/errors");
    let mut quoted = 0;
    for entry in std::fs::read_dir(folder).expect("wrong inputs") {
        let path = entry.expect("a file").path();
        let Ok(text) = std::fs::read_to_string(&path) else {
            continue;
        };
        let equation = match text.lines().find_map(|line| line.strip_prefix("equation = \"")) {
            Some(equation) => equation.trim_end_matches('"').to_owned(),
            None => text,
        };
        for method in Method::ALL {
            let Some(refusal) = refusal(equation.trim(), method, None) else {
                continue;
            };
            let Some(term) = refusal.term() else { continue };
            assert!(
                equation.contains(term.trim_start_matches('-')),
                "{}: {refusal}",
                path.display()
            );
            quoted += 1;
        }
    }
    assert!(quoted > 50, "{quoted}");
}

/// Beside polynomial terms the one that is none is meant, also where it stands at a higher power of
/// the small parameter.
#[test]
fn polynomial_terms_are_not_blamed() {
    for (equation, expected) in [
        ("x'' + x + eps*x^3 - eps^2*sinh(x) = 0", "-eps^2*sinh(x)"),
        ("x'' + x + eps*x^31 + eps*sinh(x)^9 = 0", "eps*sinh(x)^9"),
    ] {
        let oscillator = Oscillator::parse(equation).expect(equation);
        let options = Options { order: Some(6), ..Options::default() };
        let refused = solve(&oscillator, &options).expect_err(equation);
        assert_eq!(refused.term(), Some(expected), "{equation}: {refused}");
        assert!(
            refused.to_string().ends_with(&format!("not `{expected}`")),
            "{equation}: {refused}"
        );
    }
    let of_position = [
        ("x'' + x + 0.5*sin(x) = 0", "0.5*sin(x)", 10),
        ("x'' + sqrt(k)*x + x^3 - x*exp(-x^2)/2 = 0", "-x*exp(-x^2)/2", 24),
        ("x'' + 2*x + 0.1*abs(x)*x = 0", "0.1*abs(x)*x", 12),
        ("x'' + 2*(x + 0.25*tanh(x)) = 0", "0.25*tanh(x)", 13),
    ];
    for (equation, expected, column) in of_position {
        for method in [Method::IterationPerturbation, Method::ParameterExpansion] {
            let oscillator = Oscillator::parse(equation).expect(equation);
            let options = Options { method: Some(method), order: Some(2), ..Options::default() };
            let refused = solve(&oscillator, &options).expect_err(equation);
            assert_eq!(refused.term(), Some(expected), "{equation}: {refused}");
            let [_, carets] = oscillator.typed.locate(expected).expect(equation);
            assert_eq!(carets.find('^'), Some(column), "{equation}");
        }
    }
}
