//! The method that answers where none is asked for, and the force has no expansion about its
//! equilibrium.

use lindstedt::expr::Expr;
use lindstedt::method::numbers::evaluate;
use lindstedt::method::{Options, Reason, Refusal, solve};
use lindstedt::oscillator::OscillatorError;
use lindstedt::solution::{AmplitudeConvention, Method, Note};
use lindstedt::verify::{VerificationError, motions};
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
    let options = Options { order: Some(3), ..Options::default() };
    let solution = answered(equation, &options);
    assert_eq!((solution.method, solution.order), (Method::HarmonicBalance, 3));
    let oscillator = Oscillator::parse(equation).expect(equation);
    let judged =
        judge(&oscillator, &solution, &"A = 1".parse().expect("a value"), 1e-3).expect(equation);
    assert_eq!(judged.verdict, Verdict::Pass);
}

#[test]
fn what_is_asked_of_an_expansion_is_refused_as_before() {
    let options = Options::default;
    for (equation, options) in [
        ("x'' + x^3 = 0", Options { method: Some(Method::LindstedtPoincare), ..options() }),
        ("x'' + x*abs(x) = 0", Options { small: Some("A".to_owned()), ..options() }),
        ("x'' + x^3 = 0", Options { frequency_alone: true, ..options() }),
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
        let [found, expected] =
            [&form.value, &expected.value].map(|law| law.evaluate(&numbers).expect("a number"));
        assert!((found / expected - 1.0).abs() < 1e-12, "p = {p}: {found} {expected}");
    }
}

/// What quadratic terms do to the frequency comes with the square of the amplitude, as what cubic
/// ones do: beside a linear damping, and at a resonance, it is in the answer. The truth is the
/// expansion of the undamped motion, in its own amplitude.
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
    for equation in
        ["x'' + 2*eps*x' + x + eps*x^2 = 0", "x'' + 2*eps*x' + x + eps*x^2 = eps*F*cos(Omega*t)"]
    {
        let solution = answered(equation, &Options::default());
        assert!(solution.validity.contains(&Note::QuadraticTermsLeftOut), "{equation}");
    }
}

/// A quadratic damping and a quadratic force together act as a cubic damping does, whose sign they
/// may turn: the limit cycle in one of two wells is the unstable one of b < 1. For a small mu it is
/// where the drain along an undamped orbit is zero, b = int x^2 v dx / int v dx.
#[test]
fn a_limit_cycle_in_a_well_is_the_unstable_one() {
    let mut oscillator =
        Oscillator::parse("x'' + mu*(x^2 - b)*x' - x + x^3 = 0").expect("an oscillator");
    oscillator.about = Some(Expr::one());
    let solution = solve(&oscillator, &Options::default()).expect("slow equations");
    let [cycle] =
        solution.modulation.expect("slow equations").steady.try_into().expect("one cycle");
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

/// A force that is infinite at rest, and its potential is not: sgn(x)/|x|^(1/3) swings as
/// 1/|x|^(1/3) of a fall that lasts int_0^A dx/sqrt(3 (A^(2/3) - x^(2/3))) = A^(2/3) pi sqrt(3)/4,
/// a quarter of the period. (x = A sin(u)^3 makes an integral of sin^2 of it.)
#[test]
fn a_force_that_is_infinite_at_rest_swings_through() {
    let solution = answered("x'' + sgn(x)/abs(x)^(1/3) = 0", &Options::default());
    let law = &solution.law.closed_form().expect("a closed law").value;
    for amplitude in [1e-3, 1.0, 7.0] {
        let frequency = law.evaluate(&[("A".into(), amplitude)].into()).expect("a number");
        let quarter = amplitude.powf(2.0 / 3.0) * std::f64::consts::PI * f64::sqrt(3.0) / 4.0;
        let truth = std::f64::consts::FRAC_PI_2 / quarter;
        assert!((frequency / truth - 1.0).abs() < 1e-14, "{amplitude}: {frequency} and {truth}");
    }
}

/// T of `x'' + s x + k/x = 0` from `x = A`: with `x = A exp(-u^2)` the integrand of the period is
/// smooth, even and falls as `exp(-u^2)`, so that equal steps give all digits.
fn period_through_a_logarithm(s: f64, k: f64, amplitude: f64) -> f64 {
    const STEP: f64 = 0.05;
    let rate = |u: f64| {
        let lost = if u == 0.0 { 2.0 } else { -(-2.0 * u * u).exp_m1() / (u * u) };
        8.0 * amplitude * (-u * u).exp() / (s * amplitude * amplitude * lost + 2.0 * k).sqrt()
    };
    let sum: f64 = (1..160).map(|step| rate(f64::from(step) * STEP)).sum();
    STEP * (0.5 * rate(0.0) + sum)
}

#[test]
fn a_force_like_one_over_x_has_its_period() {
    let pi = std::f64::consts::PI;
    // Mickens: T = 2 sqrt(2 pi) A.
    assert!(
        (period_through_a_logarithm(0.0, 1.0, 3.0) / (6.0 * (2.0 * pi).sqrt()) - 1.0).abs() < 1e-14
    );
    for (equation, s, k) in [
        ("x'' + 1/x = 0", 0.0, 1.0),
        ("x*x'' + 3 = 0", 0.0, 3.0),
        ("x'' + 2*sgn(x)/abs(x) = 0", 0.0, 2.0),
        ("x'' + x + 3/x = 0", 1.0, 3.0),
        ("x'' + 5*x + 1/(100*x) = 0", 5.0, 0.01),
    ] {
        let oscillator = Oscillator::parse(equation).expect(equation);
        let options = Options { method: Some(Method::Exact), ..Options::default() };
        let exact = answered(equation, &options);
        for amplitude in ["1/50", "2", "-7"] {
            let at: Values = format!("A = {amplitude}").parse().expect("a value");
            let judged = judge(&oscillator, &exact, &at, 1e-9).expect(equation);
            let size = at.iter().next().expect("A").1.evaluate(&[].into()).expect("a number").abs();
            let omega = 2.0 * pi / period_through_a_logarithm(s, k, size);
            // The judge, and the law or the quadrature of the method.
            assert!(
                (judged.true_frequency / omega - 1.0).abs() < 1e-11,
                "{equation} at {amplitude}"
            );
            assert!(
                (judged.frequency.expect("a frequency") / omega - 1.0).abs() < 1e-11,
                "{equation} at {amplitude}"
            );
            assert_eq!(judged.verdict, Verdict::Pass);
            // Nobody follows the path: nothing is said of it, and that is said.
            assert_eq!((judged.max_deviation, judged.residual), (None, None));
            let reason = judged.no_deviation.as_deref().unwrap_or_default();
            assert!(reason.contains("does not follow the true motion"), "{equation}: {reason}");
            // No range speaks of a displacement that there is not.
            let ranges = judged.ranges.iter();
            assert!(ranges.clone().all(|range| !range.text.contains("displacement")), "{equation}");
        }
    }
}

/// The same for `V = log|x (9 - x^2)|`, whose force is odd in letters and not in its last digit.
#[test]
fn a_force_that_rounding_makes_uneven_is_taken_through_its_pole() {
    let equation = "x'' + 1/x + 1/(x - 3) + 1/(x + 3) = 0";
    let (oscillator, solution) =
        (Oscillator::parse(equation).expect(equation), answered(equation, &Options::default()));
    for amplitude in [1.0_f64, 0.7, 1.5] {
        let rate = |u: f64| {
            let x = amplitude * (-u * u).exp();
            let fallen = u * u + ((9.0 - amplitude * amplitude) / (9.0 - x * x)).ln();
            8.0 * x * u / (2.0 * fallen).sqrt()
        };
        // At the ends of the steps beside zero the integrand is even, and its value at zero a
        // limit: middles of steps do without.
        let period: f64 = (0..160).map(|step| 0.05 * rate((f64::from(step) + 0.5) * 0.05)).sum();
        let at: Values = format!("A = {amplitude}").parse().expect("a value");
        let judged = judge(&oscillator, &solution, &at, 1e-8).expect(equation);
        let omega = std::f64::consts::TAU / period;
        assert!((judged.true_frequency / omega - 1.0).abs() < 1e-10, "{amplitude}: {omega}");
        assert_eq!(judged.verdict, Verdict::Pass);
    }
}

/// `c_k` of `1/x` along a motion by the midpoint rule, which is exact for the trigonometric
/// polynomial that `cos(k theta)/x` nearly is.
fn balance_of_one_over_x(coefficients: &[(usize, f64)], k: usize) -> f64 {
    const POINTS: usize = 4000;
    let theta = |i: usize| std::f64::consts::PI * (i as f64 + 0.5) / POINTS as f64;
    let x =
        |theta: f64| coefficients.iter().map(|(j, a)| a * (*j as f64 * theta).cos()).sum::<f64>();
    let sum: f64 = (0..POINTS).map(theta).map(|theta| (k as f64 * theta).cos() / x(theta)).sum();
    2.0 / POINTS as f64 * sum
}

#[test]
fn methods_of_few_terms_take_one_over_x_where_their_integral_exists() {
    for (method, law) in [
        (Method::Exact, "omega = sqrt(pi*k/2)/A"),
        (Method::Hamiltonian, "2*k/A^2"),
        (Method::VariationalIteration, "2*k/A^2"),
        (Method::EnergyBalance, "omega^2 = 2*k*log(2)/A^2"),
        (Method::AmplitudeFrequency, "4*k/(3*A^2)"),
    ] {
        let options = Options { method: Some(method), ..Options::default() };
        let solution = answered("x'' + k/x = 0", &options);
        let squared = solution.law.frequency_squared().map(|law| Expr::from(law).to_string());
        let found = squared.or_else(|| solution.law.closed_form().map(ToString::to_string));
        assert_eq!(found.as_deref(), Some(law), "{method:?}");
        let said =
            solution.validity.iter().any(|note| matches!(note, Note::EndlessPotential { .. }));
        assert!(said, "{method:?}");
    }
    // f/x = 1/x^2 has no bound at rest.
    let max_min = Options { method: Some(Method::MaxMin), ..Options::default() };
    let oscillator = Oscillator::parse("x'' + k/x = 0").expect("an equation");
    assert!(matches!(
        solve(&oscillator, &max_min),
        Err(Refusal { reason: Reason::Unbounded(_), .. })
    ));
    for order in 1..5 {
        let options = Options {
            method: Some(Method::HarmonicBalance),
            order: Some(order),
            ..Options::default()
        };
        let equation = "x'' + 1/x = 0";
        let solution = answered(equation, &options);
        let oscillator = Oscillator::parse(equation).expect(equation);
        let found =
            evaluate(&oscillator, &solution, &[("A".into(), 1.0)].into()).expect("a balance");
        let motion = found.motion.expect("a motion");
        let harmonics = (0..order as usize).map(|j| 2 * j + 1);
        let coefficients: Vec<(usize, f64)> =
            harmonics.map(|k| (k, motion.cosine(k).mean().0)).collect();
        for &(k, a) in &coefficients {
            let inertia = (k * k) as f64 * found.frequency_squared * a;
            let force = balance_of_one_over_x(&coefficients, k);
            assert!(
                (inertia - force).abs() < 1e-9,
                "order {order}, harmonic {k}: {inertia} {force}"
            );
        }
    }
}

#[test]
fn weaker_powers_go_over_into_one_over_x() {
    // omega A = sqrt(pi/2) at p = -1; the slope of the exact law in p there is finite.
    let limit = (std::f64::consts::PI / 2.0).sqrt();
    let mut last = f64::INFINITY;
    for p in ["-9/10", "-99/100", "-999/1000"] {
        let equation = format!("x'' + sgn(x)*abs(x)^({p}) = 0");
        let solution = answered(&equation, &Options::default());
        assert_eq!(solution.method, Method::Exact, "{equation}");
        let oscillator = Oscillator::parse(&equation).expect("an equation");
        let judged = judge(&oscillator, &solution, &"A = 1".parse().expect("a value"), 1e-8)
            .expect("a motion");
        assert_eq!(judged.verdict, Verdict::Pass, "{equation}: {:?}", judged.relative_error);
        let off = (judged.true_frequency - limit).abs();
        assert!(off < 0.15 * last, "{equation}: {off}");
        last = off;
    }
}

#[test]
fn what_falls_in_is_refused_and_says_why() {
    let refused = |equation: &str| {
        let oscillator = Oscillator::parse(equation).expect(equation);
        solve(&oscillator, &Options::default()).expect_err(equation)
    };
    for equation in ["x'' + 1/x^3 = 0", "x'' + x + 2/x^3 = 0", "x'' + sgn(x)*abs(x)^(-11/10) = 0"] {
        let refusal = refused(equation);
        let falls_in = matches!(
            refusal.reason,
            Reason::Oscillator(OscillatorError::FallsIn { uneven: false, .. })
        );
        assert!(falls_in, "{equation}: {refusal}");
    }
    for equation in ["x'' + 1 + 1/x = 0", "x'' + x^2 + 1/x = 0"] {
        let refusal = refused(equation);
        let uneven = matches!(
            refusal.reason,
            Reason::Oscillator(OscillatorError::FallsIn { uneven: true, .. })
        );
        assert!(uneven, "{equation}: {refusal}");
    }
    // What pushes away from zero has wells beside it.
    assert_eq!(answered("x'' + x - 1/x = 0", &Options::default()).equilibrium, Expr::from(1));
    assert_eq!(answered("x'' + x - 1/x^3 = 0", &Options::default()).equilibrium, Expr::from(1));
}

#[test]
fn a_path_through_an_infinite_force_is_neither_drawn_nor_followed() {
    let equation = "x'' + x'/10 + x + 1/x = 0";
    let oscillator = Oscillator::parse(equation).expect(equation);
    let solution = answered(equation, &Options::default());
    assert_eq!(solution.method, Method::Averaging);
    let error = judge(&oscillator, &solution, &"A = 1".parse().expect("a value"), 0.01)
        .expect_err("no path");
    assert!(matches!(error, VerificationError::NotFollowed { .. }), "{error}");
    let free = Oscillator::parse("x*x'' + 1 = 0").expect("an equation");
    let exact = answered("x*x'' + 1 = 0", &Options::default());
    let error = motions(&free, &exact, &"A = 1".parse().expect("a value")).err();
    assert_eq!(error, Some(VerificationError::NoPath));
    // The typed term `1` is no reason: its quotient is.
    let reason = exact.validity.iter().find_map(|note| match note {
        Note::InsteadOf { reason, .. } => Some(reason.clone()),
        _ => None,
    });
    assert_eq!(reason.as_deref(), Some("`1/x` has no Taylor series about x = 0, x' = 0"));
}
