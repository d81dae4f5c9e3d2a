//! The method that answers where none is asked for, and the force has no expansion about its equilibrium.

use lindstedt::method::{Options, solve};
use lindstedt::solution::{Method, Note};
use lindstedt::{Oscillator, Values, Verdict, judge};

fn answered(equation: &str, options: &Options) -> lindstedt::solution::Solution {
    let oscillator = Oscillator::parse(equation).expect(equation);
    solve(&oscillator, options).unwrap_or_else(|refusal| panic!("{equation}: {refusal}"))
}

#[test]
fn a_force_without_an_expansion_is_answered_and_the_answer_says_why_not_as_usual() {
    for (equation, method, at) in [
        ("x'' + sgn(x)*abs(x)^(1/3) = 0", Method::Exact, "A = 1"),
        ("x'' + x*abs(x) = 0", Method::Exact, "A = 2"),
        ("x'' + sgn(x) = 0", Method::Exact, "A = 1/2"),
        ("x'' + x^(1/3) = 0", Method::Exact, "A = 3"),
        ("x'' + x^3 = 0", Method::Exact, "A = 2"),
        ("x'' + k*sgn(x)*abs(x)^p = 0", Method::Exact, "A = 1, k = 2, p = 3/2"),
        ("x'' + x + sgn(x)*sqrt(abs(x)) = 0", Method::Hamiltonian, "A = 1"),
        ("x'' + x + H(x) = 0", Method::Exact, "A = 1"),
        ("x'' + tanh(x)^3 = 0", Method::Exact, "A = 1"),
        ("(1 + x^2)*x'' + x*x'^2 + x^3 = 0", Method::Hamiltonian, "A = 1"),
    ] {
        let solution = answered(equation, &Options::default());
        assert_eq!(solution.method, method, "{equation}");
        let said = solution.validity.iter().any(
            |note| matches!(note, Note::InsteadOf { usual: Method::LindstedtPoincare, reason } if !reason.is_empty()),
        );
        assert!(said, "{equation}");
        let oscillator = Oscillator::parse(equation).expect(equation);
        let at: Values = at.parse().expect("values");
        let judged = judge(&oscillator, &solution, &at, 0.01).expect(equation);
        assert_eq!(judged.verdict, Verdict::Pass, "{equation}: {:?}", judged.relative_error);
    }
}

#[test]
fn an_order_asks_for_so_many_harmonics() {
    let equation = "x'' + sgn(x)*abs(x)^(1/3) = 0";
    let options = Options {
        order: Some(3),
        ..Options::default()
    };
    let solution = answered(equation, &options);
    assert_eq!((solution.method, solution.order), (Method::HarmonicBalance, 3));
    let oscillator = Oscillator::parse(equation).expect(equation);
    let judged = judge(&oscillator, &solution, &"A = 1".parse().expect("a value"), 1e-3).expect(equation);
    assert_eq!(judged.verdict, Verdict::Pass);
}

#[test]
fn what_is_asked_of_an_expansion_is_refused_as_before() {
    let options = Options::default;
    for (equation, options) in [
        (
            "x'' + x^3 = 0",
            Options {
                method: Some(Method::LindstedtPoincare),
                ..options()
            },
        ),
        (
            "x'' + x*abs(x) = 0",
            Options {
                small: Some("A".to_owned()),
                ..options()
            },
        ),
        (
            "x'' + x^3 = 0",
            Options {
                frequency_alone: true,
                ..options()
            },
        ),
        // Not a stable place of rest: no method answers.
        ("x'' - x*abs(x) = 0", options()),
        ("x'' + abs(x) = 0", options()),
    ] {
        let oscillator = Oscillator::parse(equation).expect(equation);
        assert!(solve(&oscillator, &options).is_err(), "{equation}");
    }
}

/// With a letter for the exponent the exact law is that with the number.
#[test]
fn a_letter_may_stand_for_an_exponent() {
    let by_letter = answered("x'' + k*sgn(x)*abs(x)^p = 0", &Options::default());
    let form = by_letter.law.closed_form().expect("a closed form");
    for (p, equation) in [
        ("1/3", "x'' + 2*sgn(x)*abs(x)^(1/3) = 0"),
        ("2", "x'' + 2*x*abs(x) = 0"),
        ("0", "x'' + 2*sgn(x) = 0"),
    ] {
        let by_number = answered(equation, &Options::default());
        let expected = by_number.law.closed_form().expect("a closed form");
        let at: Values = format!("k = 2, A = 3/2, p = {p}").parse().expect("values");
        let numbers = at.numbers();
        let [found, expected] = [&form.value, &expected.value].map(|law| law.evaluate(&numbers).expect("a number"));
        assert!((found / expected - 1.0).abs() < 1e-12, "p = {p}: {found} {expected}");
    }
}
