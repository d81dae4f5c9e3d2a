//! Linear equations with constant coefficients: exact motions, put back into their equations.

use std::collections::BTreeMap;

use lindstedt::expr::Expr;
use lindstedt::method::{Options, solve};
use lindstedt::solution::{Method, Solution};
use lindstedt::verify::Verdict;
use lindstedt::{Oscillator, Symbol, Values, judge};

fn answered(equation: &str) -> (Oscillator, Solution) {
    let oscillator = Oscillator::parse(equation).expect(equation);
    let solution = solve(&oscillator, &Options::default()).expect(equation);
    assert_eq!(solution.method, Method::Exact, "{equation}");
    (oscillator, solution)
}

/// `x(t)` and the two rates of it, with numbers; a free motion from its amplitude and phase.
fn motion(solution: &Solution, numbers: &BTreeMap<Symbol, f64>) -> [Expr; 3] {
    let t = Symbol::new("t");
    let place = match (solution.in_time(), &solution.modulation) {
        (Some(motion), _) => motion.clone(),
        (None, Some(slow)) => {
            let transient = slow.transient.as_ref().expect("a closed form");
            let phase = transient.phase.as_ref().expect("a phase");
            &transient.amplitude * &phase.cos().expect("a wave")
        }
        (None, None) => panic!("no motion"),
    };
    let mut numbers = numbers.clone();
    let defined =
        solution.defined_values(&|name| numbers.get(&name).copied()).expect("definitions");
    numbers.extend(defined);
    let exact = |(name, value): (&Symbol, &f64)| {
        (*name, format!("{value:.17}").parse::<Expr>().expect("a number"))
    };
    let place = place.substitute_all(&numbers.iter().map(exact).collect()).expect("numbers");
    let speed = place.differentiate(t).expect("a rate");
    let rate = speed.differentiate(t).expect("a rate");
    [place, speed, rate]
}

/// The motion satisfies the equation at every instant, and begins at rest at A.
#[test]
fn exact_motions_satisfy_their_equations() {
    for (equation, at) in [
        ("x'' + 2*zeta*x' + x = 0", "zeta = 1/10, A = 3/2"),
        ("x'' + c*x' + k*x = 0", "c = 3/10, k = 5, A = 1"),
        ("x'' - x'/10 + 2*x = 0", "A = 1"),
        ("x'' + 3*x' + x = 0", "A = 1"),
        ("x'' + 2*x' + x = 0", "A = 2"),
        ("x'' + x = sin(2*t)", "A = 1"),
        ("x'' + x = cos(t)", "A = 1/2"),
        ("x'' + 4*x = 3*sin(2*t + 1)", "A = 1"),
        ("x'' + x/4 + x'/20 = cos(t) + sin(3*t)", "A = 1"),
        ("x'' + 2*zeta*x' + x = F*cos(Omega*t)", "zeta = 1/20, F = 1/3, Omega = 9/10, A = 1"),
        (
            "x'' + 2*zeta*x' + x = F*sin(Omega*t + phi)",
            "zeta = 1/20, F = 1/3, Omega = 9/10, phi = 1, A = 1",
        ),
        ("x'' + w^2*x = F*cos(W*t) + G*cos(V*t)", "w = 2, F = 1, G = 1/2, W = 3/2, V = 7/3, A = 1"),
        ("x'' + 5*x' + 4*x = cos(t)", "A = 1"),
        ("x'' + 2*x' + x = cos(t)", "A = 1"),
    ] {
        let (oscillator, solution) = answered(equation);
        let values: Values = at.parse().expect(at);
        let numbers = values.numbers();
        let [place, speed, rate] = motion(&solution, &numbers);
        for k in 0..40 {
            let t = 0.37 * f64::from(k);
            let time = BTreeMap::from([(Symbol::new("t"), t)]);
            let [x, v, b] =
                [&place, &speed, &rate].map(|part| part.evaluate(&time).expect("a number"));
            let mut point = numbers.clone();
            point.extend([("t".into(), t), ("x".into(), x), (Symbol::new("x").derivative(), v)]);
            let force = oscillator.force.evaluate(&point).expect("a force");
            assert!(
                (b + force).abs() < 1e-10 * (1.0 + force.abs()),
                "{equation} at t = {t}: {b} {force}"
            );
            if k == 0 {
                let start = numbers[&Symbol::new("A")];
                assert!((x - start).abs() < 1e-12 && v.abs() < 1e-12, "{equation}: {x} {v}");
            }
        }
        let judged = judge(&oscillator, &solution, &values, 1e-6).expect(equation);
        assert_eq!(judged.verdict, Verdict::Pass, "{equation}: {judged:?}");
    }
}

/// The damped frequency and the decay as they stand in every textbook.
#[test]
fn the_damped_frequency_is_that_of_textbooks() {
    let (_, solution) = answered("x'' + 2*zeta*x' + x = 0");
    let slow = solution.modulation.as_ref().expect("slow equations");
    assert_eq!(slow.amplitude_rate.to_string(), "-zeta*a");
    let frequency =
        solution.definitions.iter().find(|known| Expr::from(known.symbol) == slow.phase_rate);
    assert_eq!(frequency.expect("omega_d").meaning.to_string(), "sqrt(1 - zeta^2)");
    let transient = slow.transient.as_ref().expect("a closed form");
    assert_eq!(transient.amplitude.to_string(), "a0*exp(-zeta*t)");
}

/// A drive at the frequency of an undamped oscillator is named, and the motion grows in proportion
/// to time.
#[test]
fn resonance_of_an_undamped_oscillator_is_named() {
    let (_, solution) = answered("x'' + x = cos(t)");
    let expected: Expr = "A*cos(t) + t*sin(t)/2".parse().expect("an expression");
    let growing = solution.in_time().expect("a motion") - &expected;
    assert!(growing.expand().expect("short").is_zero(), "{growing}");
    let notes: Vec<String> = solution.validity.iter().map(ToString::to_string).collect();
    assert!(
        notes.iter().any(|note| note.contains("resonance") && note.contains("cos(t)")),
        "{notes:?}"
    );
    let (_, solution) = answered("x'' + w^2*x = F*cos(W*t)");
    let notes: Vec<String> = solution.validity.iter().map(ToString::to_string).collect();
    assert!(notes.iter().any(|note| note.contains("only where W^2 is not w^2")), "{notes:?}");
}

/// An order, a resonance or a method that is asked for is the expansion that it was.
#[test]
fn an_expansion_that_is_asked_for_stays_one() {
    let damped = Oscillator::parse("x'' + 2*zeta*x' + x = 0").expect("an oscillator");
    for (method, order) in
        [(None, Some(1)), (Some(Method::Averaging), None), (Some(Method::MultipleScales), Some(2))]
    {
        let options = Options { method, order, ..Options::default() };
        let found = solve(&damped, &options).expect("slow equations");
        assert_ne!(found.method, Method::Exact);
    }
}

/// A free linear motion is answered as what it is: no order, nothing cut off, and the law of its
/// letters.
#[test]
fn free_linear_equations_are_answered_exactly() {
    for (equation, law, motion) in [
        ("x'' + 4*x = 0", "omega = 2", "A*cos(2*t)"),
        ("x'' + w^2*x = 0", "omega = w", "A*cos(w*t)"),
        ("m*x'' + k*x = 0", "omega^2 = k/m", "A*cos(t*sqrt(k/m))"),
        ("2*x'' + 4*x = 1", "omega^2 = 2", "1/4 + A*cos(sqrt(2)*t)"),
    ] {
        let (_, solution) = answered(equation);
        assert_eq!(solution.formula(), law, "{equation}");
        assert_eq!(
            solution.closed_motion.as_ref().expect("a motion").to_string(),
            motion,
            "{equation}"
        );
        let text = lindstedt::export::text::solution(&solution, None);
        assert!(
            text.contains("exact: the equation is linear") && !text.contains("truncated"),
            "{text}"
        );
    }
    // Asked of an expansion, nothing is cut off either; what is not linear is an expansion still.
    let text = |equation: &str| {
        let options = Options {
            method: Some(Method::LindstedtPoincare),
            order: Some(1),
            ..Options::default()
        };
        let oscillator = Oscillator::parse(equation).expect(equation);
        lindstedt::export::text::solution(&solve(&oscillator, &options).expect(equation), None)
    };
    assert!(!text("x'' + 4*x = 0").contains("truncated"));
    assert!(text("x'' + 4*x + x^3 = 0").contains("truncated"));
}
