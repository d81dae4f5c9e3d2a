//! The method that answers where none is asked for, and the force has no expansion about its equilibrium.

use lindstedt::expr::Expr;
use lindstedt::method::{Options, solve};
use lindstedt::solution::{AmplitudeConvention, Method, Note};
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
        ("x'' + sgn(x)/abs(x)^(1/3) = 0", Method::Exact, "A = 2"),
        ("x'' + c*x^(-1/5) = 0", Method::Exact, "A = 1/2, c = 3"),
        ("x'' + c*sgn(x)*abs(x)^p = 0", Method::Exact, "A = 1, c = 3, p = -2/3"),
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

/// What quadratic terms do to the frequency comes with the square of the amplitude, as what cubic ones do: beside a linear damping, and
/// at a resonance, it is in the answer. The truth is the expansion of the undamped motion, in its own amplitude.
#[test]
fn quadratic_terms_are_not_left_out() {
    let of_first_harmonic = Options {
        method: Some(Method::LindstedtPoincare),
        small: Some("A".to_owned()),
        order: Some(2),
        amplitude: Some(AmplitudeConvention::FirstHarmonic),
        ..Options::default()
    };
    for (undamped, damped, driven) in [
        (
            "x'' + x + b*x^2 + c*x^3 = 0",
            "x'' + 2*z*x' + x + b*x^2 + c*x^3 = 0",
            "x'' + 2*z*x' + x + b*x^2 + c*x^3 = F*cos(Omega*t)",
        ),
        (
            "x'' + 4*x + x^2 = 0",
            "x'' + x'/50 + 4*x + x^2 = 0",
            "x'' + z*x' + 4*x + x^2 = F*cos(Omega*t)",
        ),
        (
            "x'' + exp(x) - 1 = 0",
            "x'' + z*x' + exp(x) - 1 = 0",
            "x'' + z*x' + exp(x) - 1 = F*cos(Omega*t)",
        ),
    ] {
        let law = answered(undamped, &of_first_harmonic).law;
        let frequency = Expr::from(law.frequency().expect(undamped));
        let slow = answered(damped, &Options::default());
        assert!(slow.validity.contains(&Note::QuadraticTerms), "{damped}");
        let modulation = slow.modulation.expect(damped);
        assert_eq!(modulation.phase_rate.expand(), frequency.expand(), "{damped}");
        let resonance = answered(driven, &Options::default());
        assert!(resonance.validity.contains(&Note::QuadraticTerms), "{driven}");
        let branches = resonance.response.expect(driven).branches.expect(driven);
        let at_rest = frequency.substitute("a".into(), &Expr::zero()).expect("a number");
        assert_eq!(
            (at_rest + Expr::from(&branches.centre)).expand(),
            frequency.expand(),
            "{driven}"
        );
    }
    // Where it is said what is small, the answer says what it leaves out.
    for equation in [
        "x'' + 2*eps*x' + x + eps*x^2 = 0",
        "x'' + 2*eps*x' + x + eps*x^2 = eps*F*cos(Omega*t)",
    ] {
        let solution = answered(equation, &Options::default());
        assert!(solution.validity.contains(&Note::QuadraticTermsLeftOut), "{equation}");
    }
}

/// A quadratic damping and a quadratic force together act as a cubic damping does, whose sign they may turn: the limit cycle in one
/// of two wells is the unstable one of b < 1. For a small mu it is where the drain along an undamped orbit is zero, b = int x^2 v dx /
/// int v dx.
#[test]
fn a_limit_cycle_in_a_well_is_the_unstable_one() {
    let mut oscillator = Oscillator::parse("x'' + mu*(x^2 - b)*x' - x + x^3 = 0").expect("an oscillator");
    oscillator.about = Some(Expr::one());
    let solution = solve(&oscillator, &Options::default()).expect("slow equations");
    let [cycle] = solution
        .modulation
        .expect("slow equations")
        .steady
        .try_into()
        .expect("one cycle");
    let stays = |b: f64| {
        let numbers = [("b".into(), b), ("mu".into(), 0.1)].into();
        cycle.amplitude.evaluate(&numbers).expect("an amplitude")
    };
    let attracts = cycle.attracts_where.expect("a condition");
    assert!(attracts.evaluate(&[("mu".into(), 0.1)].into()).expect("a number") < 0.0);
    // x^2 = 1 +- 2 sqrt(e) at the turning points.
    let root = 1e-3;
    let [low, high] = [-1.0, 1.0].map(|side| f64::sqrt(1.0 + side * 2.0 * root));
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let (mut drained, mut fed) = (0.0, 0.0);
    for k in 0..64 {
        let angle = std::f64::consts::PI * (f64::from(k) + 0.5) / 64.0;
        let x = middle - half * angle.cos();
        let speed = (2.0 * root * root - 0.5 * (x * x - 1.0).powi(2)).max(0.0).sqrt();
        drained += x * x * speed * angle.sin();
        fed += speed * angle.sin();
    }
    let found = stays(drained / fed);
    assert!((found / half - 1.0).abs() < 1e-2, "{found} and {half}");
}

/// A force that is infinite at rest, and its potential is not: sgn(x)/|x|^(1/3) swings as 1/|x|^(1/3) of a fall that lasts
/// int_0^A dx/sqrt(3 (A^(2/3) - x^(2/3))) = A^(2/3) pi sqrt(3)/4, a quarter of the period. (x = A sin(u)^3 makes an integral of sin^2 of it.)
#[test]
fn a_force_that_is_infinite_at_rest_swings_through() {
    let solution = answered("x'' + sgn(x)/abs(x)^(1/3) = 0", &Options::default());
    let law = &solution.law.closed_form().expect("a closed law").value;
    for amplitude in [1e-3, 1.0, 7.0] {
        let frequency = law.evaluate(&[("A".into(), amplitude)].into()).expect("a number");
        let quarter = amplitude.powf(2.0 / 3.0) * std::f64::consts::PI * f64::sqrt(3.0) / 4.0;
        let truth = std::f64::consts::FRAC_PI_2 / quarter;
        assert!(
            (frequency / truth - 1.0).abs() < 1e-14,
            "{amplitude}: {frequency} and {truth}"
        );
    }
    // The fall to a centre that pulls with 1/x, whose potential is infinite, is refused.
    let oscillator = Oscillator::parse("x'' + 1/x = 0").expect("an oscillator");
    assert!(solve(&oscillator, &Options::default()).is_err());
}
