//! Transition curves of Hill's equation held against published series, tables, exact widths,
//! scalings and the integrated motion.

use std::collections::BTreeMap;

use lindstedt::exact::Polynomial;
use lindstedt::expr::Expr;
use lindstedt::hill::{HillError, HillOptions, TransitionCurves, judge, transition_curves};
use lindstedt::{Oscillator, Symbol, Values};

fn curves(equation: &str, order: u32, tongues: usize) -> TransitionCurves {
    let oscillator = Oscillator::parse(equation).expect("an oscillator");
    let options = HillOptions { order, tongues, ..HillOptions::default() };
    transition_curves(&oscillator, &options).unwrap_or_else(|error| panic!("{equation}: {error}"))
}

fn named<'a>(curves: &'a TransitionCurves, name: &str) -> &'a Polynomial {
    let curve = curves.curves.iter().find(|curve| curve.name == name);
    &curve.expect("a curve of this name").middle
}

fn values(text: &[(&str, f64)]) -> Values {
    let mut values = Values::default();
    for (name, value) in text {
        let value = lindstedt::expr::parse_expression(&value.to_string()).expect("a number");
        values.insert(Symbol::new(name), value).expect("a value");
    }
    values
}

/// Abramowitz and Stegun, 20.2.25: characteristic values of `y'' + (a - 2 q cos 2 z) y = 0` in
/// powers of q.
#[test]
fn mathieu_has_the_published_series() {
    let derived = curves("x'' + (delta - 2*q*cos(2*t))*x = 0", 6, 3);
    let published = [
        ("a0", "-q^2/2 + 7*q^4/128 - 29*q^6/2304"),
        ("b1", "1 - q - q^2/8 + q^3/64 - q^4/1536 - 11*q^5/36864 + 49*q^6/589824"),
        ("a1", "1 + q - q^2/8 - q^3/64 - q^4/1536 + 11*q^5/36864 + 49*q^6/589824"),
        ("b2", "4 - q^2/12 + 5*q^4/13824 - 289*q^6/79626240"),
        ("a2", "4 + 5*q^2/12 - 763*q^4/13824 + 1002401*q^6/79626240"),
        ("b3", "9 + q^2/16 - q^3/64 + 13*q^4/20480 + 5*q^5/16384 - 1961*q^6/23592960"),
        ("a3", "9 + q^2/16 + q^3/64 + 13*q^4/20480 - 5*q^5/16384 - 1961*q^6/23592960"),
    ];
    for (name, series) in published {
        assert_eq!(derived.ordered(named(&derived, name)).to_string(), series, "{name}");
    }
}

/// Levy and Keller (1963): `a_n - b_n = 8 (q/4)^n/((n - 1)!)^2 + ...`.
#[test]
fn tongues_open_with_the_power_of_their_number() {
    let derived = curves("x'' + (delta - 2*q*cos(2*t))*x = 0", 8, 8);
    let q = Symbol::new("q");
    let mut factorial = 1.0;
    for n in 1..=8_usize {
        let [above, below] =
            [format!("a{n}"), format!("b{n}")].map(|name| named(&derived, &name).clone());
        let coefficient = |polynomial: &Polynomial, power: usize| {
            let terms = polynomial.terms().filter(|term| term.0.exponent(q) == power as i32);
            terms.map(|(_, number)| lindstedt::exact::to_f64(number)).sum::<f64>()
        };
        for power in 0..n {
            assert_eq!(
                coefficient(&above, power),
                coefficient(&below, power),
                "n = {n}, q^{power}"
            );
        }
        let expected = 8.0 / 4.0_f64.powi(n as i32) / (factorial * factorial);
        let width = coefficient(&above, n) - coefficient(&below, n);
        assert!((width / expected - 1.0).abs() < 1e-14, "n = {n}: {width} and {expected}");
        factorial *= n as f64;
    }
}

/// Abramowitz and Stegun, table 20.1, at q = 5, far beyond the series: the judge does not need
/// them.
#[test]
fn the_judge_knows_the_table_of_characteristic_values() {
    let derived = curves("x'' + (delta - 2*q*cos(2*t))*x = 0", 1, 2);
    let judged = judge(&derived, &values(&[("q", 5.0)]), 1e-3).expect("a judgement");
    let table: BTreeMap<&str, f64> = [
        ("a0", -5.800_046_02),
        ("b1", -5.790_080_60),
        ("a1", 1.858_187_54),
        ("b2", 2.099_460_45),
        ("a2", 7.449_109_74),
    ]
    .into();
    for curve in &judged {
        let name = derived.curves[curve.curve].name.as_str();
        let truth = curve.truth.expect("a tongue that reaches so far");
        assert!((truth - table[name]).abs() < 1e-8, "{name}: {truth}");
        assert!(!curve.passes, "{name}: an expansion to first order at q = 5");
    }
}

/// A determinant with too few waves to be taken on by the tenth harmonic has another a0; the
/// expansion is right to order five.
#[test]
fn the_judge_sees_as_many_waves_as_the_coefficients_need() {
    let derived = curves("x'' + (delta + eps*(cos(t) + cos(10*t)))*x = 0", 4, 3);
    let judged = judge(&derived, &values(&[("eps", 0.1)]), 1e-4).expect("a judgement");
    assert_eq!(judged.len(), 7);
    assert!(judged.iter().all(|curve| curve.passes), "{judged:?}");
}

/// `(x' + eps*sin(t)*x)' = 0` has the motion `exp(eps*cos(t))`, whatever eps: its curve is delta =
/// 0, and rounding is no error.
#[test]
fn a_curve_at_zero_is_judged() {
    let derived = curves("x'' + eps*sin(t)*x' + (delta + eps*cos(t))*x = 0", 4, 1);
    let judged = judge(&derived, &values(&[("eps", 0.3)]), 1e-2).expect("a judgement");
    let first = &judged[0];
    assert_eq!((first.value, first.truth, first.relative_error), (Some(0.0), Some(0.0), Some(0.0)));
    assert!(judged.iter().all(|curve| curve.passes), "{judged:?}");
}

/// The error falls with the first power that is left out.
#[test]
fn errors_fall_with_the_order() {
    let damped = "x'' + 2*zeta*x' + (delta + eps*cos(2*t))*x = 0";
    let driven = "x'' + 2*zeta*x' + (1 + eps*cos(Omega*t) + eps*sin(2*Omega*t)/2)*x = 0";
    let in_speed = "x'' + eps*cos(t)*x' + (delta + eps*sin(t)^2)*x = 0";
    for (equation, order) in
        [(damped, 2), (damped, 4), (driven, 2), (driven, 3), (in_speed, 3), (in_speed, 5)]
    {
        let derived = curves(equation, order, 2);
        let errors = |size: f64| {
            let mut at = vec![("eps", size)];
            if equation.contains("zeta") {
                at.push(("zeta", size / 40.0));
            }
            let judged = judge(&derived, &values(&at), 0.01).expect("a judgement");
            let error =
                |curve: &lindstedt::hill::JudgedCurve| Some((curve.value? - curve.truth?).abs());
            judged.iter().map(error).collect::<Vec<_>>()
        };
        let mut compared = 0;
        let sizes = if order < 4 { [0.1, 0.05] } else { [0.3, 0.15] };
        let [large, small] = sizes.map(errors);
        for ((large, small), curve) in large.into_iter().zip(small).zip(&derived.curves) {
            // A tongue that opens with a higher power than damping is closed at the smaller values.
            let (Some(large), Some(small)) = (large, small) else {
                continue;
            };
            if small < 1e-11 {
                continue;
            }
            compared += 1;
            let slope = (large / small).log2();
            assert!(
                slope > f64::from(order) + 0.6,
                "{equation}, order {order}, {}: slope {slope}",
                curve.name
            );
        }
        assert!(compared >= 2, "{equation}, order {order}: {compared} curves compared");
    }
}

/// With the time measured in half periods, `x'' + (1 + eps cos Omega t) x` is Mathieu's equation
/// with `delta = 4/Omega^2` and `eps' = 4 eps/Omega^2`: the curves for the frequency satisfy those
/// for the stiffness to their order.
#[test]
fn curves_for_the_frequency_are_those_for_the_stiffness() {
    let order = 8;
    let stiffness = curves("x'' + (delta + eps*cos(2*t))*x = 0", order, 3);
    let frequency = curves("x'' + (1 + eps*cos(Omega*t))*x = 0", order, 3);
    for curve in &frequency.curves {
        let defect = |eps: f64| {
            let square = curve.middle.evaluate(|_| Some(eps)).expect("a number");
            let delta = named(&stiffness, &curve.name)
                .evaluate(|_| Some(4.0 * eps / square))
                .expect("a number");
            (delta - 4.0 / square).abs()
        };
        let (large, small) = (defect(0.3), defect(0.15));
        assert!(large < 1e-3, "{}: {large}", curve.name);
        assert!(
            (large / small).log2() > f64::from(order) + 0.5,
            "{}: {large} and {small}",
            curve.name
        );
    }
}

/// The phase of the wave is a matter of when the clock starts.
#[test]
fn curves_do_not_depend_on_the_phase() {
    let cosine = curves("x'' + (delta + eps*cos(2*t))*x = 0", 7, 4);
    let sine = curves("x'' + (delta + eps*sin(2*t))*x = 0", 7, 4);
    assert_eq!(cosine.curves.len(), sine.curves.len());
    for (first, second) in cosine.curves.iter().zip(&sine.curves) {
        assert_eq!(first.middle, second.middle, "{} and {}", first.name, second.name);
        assert_eq!(second.under_root, None, "{}", second.name);
    }
}

/// By averaging (Nayfeh and Mook, section 5.3.2): the tip of the first tongue is at `eps = 4 zeta`
/// for a frequency of 2.
#[test]
fn damping_draws_the_first_tongue_back() {
    let derived = curves("x'' + 2*zeta*x' + (delta + eps*cos(2*t))*x = 0", 1, 1);
    let lower = derived.curves.iter().find(|curve| curve.name == "lower1").expect("a curve");
    let root = lower.under_root.as_ref().expect("a root");
    assert_eq!(derived.ordered(root).to_string(), "eps^2/4 - 4*zeta^2");
    let closed =
        judge(&derived, &values(&[("eps", 0.1), ("zeta", 0.03)]), 0.01).expect("a judgement");
    assert!(closed[1..].iter().all(|curve| curve.truth.is_none() && curve.passes), "{closed:?}");
    let open =
        judge(&derived, &values(&[("eps", 0.1), ("zeta", 0.02)]), 0.01).expect("a judgement");
    assert!(open[1..].iter().all(|curve| curve.truth.is_some() && curve.passes), "{open:?}");
}

#[test]
fn what_has_no_transition_curves_is_refused_with_its_term() {
    let refusal = |equation: &str| {
        let oscillator = Oscillator::parse(equation).expect("an oscillator");
        transition_curves(&oscillator, &HillOptions::default()).expect_err(equation)
    };
    let term = |error: &HillError| error.term().map(str::to_owned);
    assert_eq!(term(&refusal("x'' + (delta + eps*cos(t))*x + x^3 = 0")).as_deref(), Some("x^3"));
    assert_eq!(
        term(&refusal("x'' + (delta + eps*cos(t))*x = F*cos(t)")).as_deref(),
        Some("F*cos(t)")
    );
    assert_eq!(term(&refusal("x'' + delta*x + t*x = 0")).as_deref(), Some("t*x"));
    assert_eq!(refusal("x'' + 2*zeta*x' + delta*x = 0"), HillError::Constant);
    assert_eq!(refusal("x'' + (1 + eps*cos(t))*x = 0"), HillError::NoUnknown);
    assert!(matches!(
        refusal("x'' + (delta + eps*cos(t) + eps*cos(pi*t))*x = 0"),
        HillError::NotPeriodic(_)
    ));
    assert!(matches!(refusal("x'' + (delta + cos(t)/5)*x = 0"), HillError::NumberIsSmall(_)));
}

/// The table of the page is what the program finds.
#[test]
fn the_page_prints_what_is_computed() {
    let page = include_str!("../../docs/stability.md");
    let derived = curves("x'' + (delta + eps*cos(2*t))*x = 0", 6, 2);
    for eps in [0.5, 1.0, 2.0, 4.0] {
        let judged = judge(&derived, &values(&[("eps", eps)]), 0.01).expect("a judgement");
        let cells = judged.iter().map(|curve| {
            let (value, truth) = (curve.value.expect("a value"), curve.truth.expect("a truth"));
            format!("{value:.5} ({truth:.5})")
        });
        let row = format!("| {eps} | {} |", cells.collect::<Vec<_>>().join(" | "));
        assert!(page.contains(&row), "docs/stability.md lacks {row}");
    }
}

/// Where what is small is negative the curves of a pair have changed places.
#[test]
fn curves_are_told_apart_on_either_side() {
    for equation in [
        "x'' + (delta + eps*cos(2*t))*x = 0",
        "x'' + (delta + eps*sin(2*t))*x = 0",
        "x'' + (1 + eps*cos(Omega*t))*x = 0",
        "x'' + (1 - eps*sin(Omega*t))*x = 0",
    ] {
        let derived = curves(equation, 8, 3);
        for eps in [0.3, -0.3] {
            let judged = judge(&derived, &values(&[("eps", eps)]), 1e-4).expect("a judgement");
            assert!(
                judged.iter().all(|curve| curve.passes && curve.value.is_some()),
                "{equation}, {eps}: {judged:?}"
            );
        }
    }
}

/// The period is that of what the coefficients add up to, and a damped tongue has what opens it.
#[test]
fn tongues_are_counted_by_the_shortest_period_and_open_at_their_order() {
    let squared = curves("x'' + (delta + eps*cos(t)^2)*x = 0", 4, 2);
    let plain = curves("x'' + (delta + eps*cos(2*t))*x = 0", 4, 2);
    assert_eq!(squared.period(), plain.period());
    for curve in &squared.curves {
        // delta + eps/2 + (eps/2) cos 2t
        let [at, half] = [0.2, 0.1].map(|eps| move |_: Symbol| Some(eps));
        let expected = named(&plain, &curve.name).evaluate(half).expect("a number") - 0.1;
        let found = curve.middle.evaluate(at).expect("a number");
        assert!((found - expected).abs() < 1e-14, "{}: {found} and {expected}", curve.name);
    }
    let damped = curves("x'' + 2*zeta*x' + (delta + eps*cos(2*t))*x = 0", 2, 2);
    let judged =
        judge(&damped, &values(&[("eps", 0.5), ("zeta", 0.001)]), 1e-3).expect("a judgement");
    for curve in &judged[1..] {
        assert!(
            curve.passes && curve.value.is_some(),
            "{}: {curve:?}",
            damped.curves[curve.curve].name
        );
    }
}

/// With tau = W t the equation is Mathieu's with delta = -g/(l W^2) and eps = amp/l: the curves are
/// the same ones, exactly.
#[test]
fn a_frequency_that_scales_the_time_is_solved_for() {
    let scaled = curves("x'' + (-g/l + amp*W^2/l*cos(W*t))*x = 0", 6, 3);
    assert_eq!(Expr::from(&scaled.unknown.given()).to_string(), "1/W^2");
    assert_eq!(scaled.small, [Symbol::new("amp")]);
    let mathieu = curves("x'' + (delta + eps*cos(t))*x = 0", 6, 3);
    let numbers = |name: Symbol| match name.name() {
        "g" => Some(9.81),
        "l" => Some(0.7),
        "amp" => Some(0.21),
        "eps" => Some(0.3),
        _ => None,
    };
    for curve in &scaled.curves {
        let delta = named(&mathieu, &curve.name).evaluate(numbers).expect("a value");
        let value = curve.middle.evaluate(numbers).expect("a value");
        assert!((-9.81 / 0.7 * value - delta).abs() < 1e-12, "{}: {value}, {delta}", curve.name);
    }
    // The pendulum that stands on its head, P. L. Kapitza: W^2 > 2 g l/amp^2 for a small amplitude.
    let judged =
        judge(&scaled, &values(&[("g", 9.81), ("l", 1.0), ("amp", 0.1)]), 1e-6).expect("a verdict");
    assert!(judged.iter().all(|curve| curve.passes));
    let least = judged[0].truth.expect("a frequency");
    assert!((least / (2.0 * 9.81_f64).sqrt() * 0.1 - 1.0).abs() < 0.01, "{least}");
    assert!(judged[1].truth.is_none());
    // Hanging down it is unstable between two frequencies near 2 sqrt(g/l).
    let hanging = curves("x'' + (g/l + amp*W^2/l*cos(W*t))*x = 0", 6, 3);
    let judged = judge(&hanging, &values(&[("g", 9.81), ("l", 1.0), ("amp", 0.1)]), 1e-6)
        .expect("a verdict");
    assert!(judged.iter().all(|curve| curve.passes));
    let tongue: Vec<f64> = judged[1..3].iter().filter_map(|curve| curve.truth).collect();
    let twice = 2.0 * 9.81_f64.sqrt();
    assert!(tongue[0] > twice && tongue[1] < twice, "{tongue:?}");
}

#[test]
fn a_frequency_in_several_terms_is_no_unknown() {
    let oscillator =
        Oscillator::parse("x'' + c*x' + (-g/l + amp*W^2/l*cos(W*t))*x = 0").expect("an oscillator");
    let options = HillOptions { solve_for: Some("W".to_owned()), ..HillOptions::default() };
    let error = transition_curves(&oscillator, &options).expect_err("a refusal");
    assert!(matches!(error, HillError::InSeveralTerms(..)), "{error}");
}
