//! Several drives, a base that moves, and forces whose first power is high: steady motions against the true ones, found by shooting.

use lindstedt::expr::Expr;
use lindstedt::method::{Options, solve};
use lindstedt::solution::{Method, Note, Solution};
use lindstedt::verify::Verification;
use lindstedt::{Oscillator, Values, Verdict, judge};

fn derived(equation: &str, resonance: Option<(u32, u32)>, order: Option<u32>) -> (Oscillator, Solution) {
    let oscillator = Oscillator::parse(equation).expect(equation);
    let options = Options {
        method: Some(Method::MultipleScales),
        order,
        resonance,
        ..Options::default()
    };
    let solution = solve(&oscillator, &options).unwrap_or_else(|refusal| panic!("{equation}: {refusal}"));
    (oscillator, solution)
}

fn judged(equation: &str, resonance: (u32, u32), order: u32, at: &str) -> Verification {
    let (oscillator, solution) = derived(equation, Some(resonance), Some(order));
    let at: Values = at.parse().expect(at);
    judge(&oscillator, &solution, &at, 0.05).unwrap_or_else(|error| panic!("{equation}: {error}"))
}

/// Everything that moves has its true motion near by, as stable, and the second order is nearer to the largest than the first.
fn are_the_true_ones(equation: &str, resonance: (u32, u32), at: &str, within: f64) {
    let orders = [1, 2].map(|order| judged(equation, resonance, order, at));
    for judged in &orders {
        assert!(!judged.steady_states.is_empty(), "{equation} {at}");
        for state in &judged.steady_states {
            let near = state.state.amplitude == 0.0 || state.relative_error.is_some_and(|error| error.abs() < within);
            assert!(
                near && state.true_stable == Some(state.state.is_stable()),
                "{equation} {at}: {state:?}"
            );
        }
    }
    let [first, second] = orders.map(|judged| judged.max_deviation.expect("a motion"));
    assert!(second < 0.5 * first, "{equation} {at}: {first} {second}");
}

#[test]
fn drives_whose_frequencies_have_a_ratio_act_together() {
    for (equation, resonance, at) in [
        // A force, and the parametric drive of twice its frequency.
        (
            "x'' + 2*zeta*x' + (1 + h*cos(2*w*t))*x + eps*x^3 = F*cos(w*t)",
            (1, 1),
            "zeta = 1/50, h = 1/50, eps = 1/20, F = 1/50, w = 101/100",
        ),
        // A second force far from resonance, and one at twice the frequency.
        (
            "x'' + 2*zeta*x' + x + eps*x^3 = F*cos(w*t) + G*sin(3*w*t)",
            (1, 1),
            "zeta = 1/50, eps = 1/20, F = 1/50, G = 1, w = 1",
        ),
        (
            "x'' + 2*zeta*x' + x + b*x^2 = F*cos(w*t) + G*cos(2*w*t)",
            (1, 1),
            "zeta = 1/50, b = 1/50, F = 1/50, G = 1/2, w = 1",
        ),
        // Neither is in resonance, their difference is.
        (
            "x'' + 2*zeta*x' + x + b*x^2 = F*cos(2*w*t) + G*cos(3*w*t)",
            (1, 1),
            "zeta = 1/50, b = 1/20, F = 1, G = 1, w = 1",
        ),
    ] {
        are_the_true_ones(equation, resonance, at, 0.1);
    }
}

/// The slow equations of a force beside the principal parametric resonance are the sums of both.
#[test]
fn slow_equations_of_both_drives_are_their_sum() {
    let rates = |equation: &str, resonance: (u32, u32)| {
        let (_, solution) = derived(equation, Some(resonance), Some(1));
        solution.modulation.expect("slow equations").amplitude_rate
    };
    let both = rates("x'' + (1 + h*cos(2*w*t))*x + eps*x^3 = F*cos(w*t)", (1, 1));
    let expected: Expr = "F*sin(psi)/2 - h*a*sin(2*psi)/4".parse().expect("an expression");
    assert!((&both - &expected).expand().expect("short").is_zero(), "{both}");
}

#[test]
fn frequencies_without_a_ratio_are_refused_by_name() {
    let oscillator = Oscillator::parse("x'' + x + eps*x^3 = F*cos(W*t) + G*cos(V*t)").expect("an oscillator");
    let refusal = solve(&oscillator, &Options::default()).expect_err("no ratio");
    assert!(
        refusal.term().is_some_and(|term| term.contains("cos(V*t)")),
        "{refusal}"
    );
}

/// A base that moves: the answer is in the relative coordinate and says so, and the true motion of that agrees.
#[test]
fn a_base_that_moves_is_left_out_of_the_force() {
    for (equation, at) in [
        ("x'' + x + eps*(x - Y*sin(w*t))^3 = 0", "eps = 1/10, Y = 1/5, w = 6/5"),
        (
            "x'' + 2*zeta*(x' - Y*w*cos(w*t)) + (x - Y*sin(w*t)) + eps*(x - Y*sin(w*t))^3 = 0",
            "zeta = 1/50, eps = 1/20, Y = 1/50, w = 101/100",
        ),
        (
            "x'' + 2*zeta*x' + sin(x - Y*cos(w*t)) = 0",
            "zeta = 1/50, Y = 1/50, w = 99/100",
        ),
    ] {
        let (oscillator, solution) = derived(equation, Some((1, 1)), None);
        let said = |note: &Note| matches!(note, Note::RelativeCoordinate { .. });
        assert!(solution.validity.iter().any(said), "{equation}");
        assert_eq!(solution.coordinate().name(), "z");
        let judged = judge(&oscillator, &solution, &at.parse().expect(at), 0.2).expect(equation);
        let moving: Vec<_> = judged
            .steady_states
            .iter()
            .filter_map(|state| state.relative_error)
            .collect();
        assert!(
            !moving.is_empty() && moving.iter().all(|error| error.abs() < 0.2),
            "{equation}: {moving:?}"
        );
    }
}

/// Seen from one of two bases the other moves, and the first again as seen from that: there is an end to it.
#[test]
fn bases_that_move_differently_are_refused() {
    for equation in [
        "x'' + x + eps*abs(x - t)*abs(x + t) = 0",
        "x'' + x + eps*sqrt(x - t)*sqrt(x + t) = 0",
        "x'' + x + eps*sin(x - t^2)*sin(x + t) = 0",
        "x'' + x + eps*abs(x' - cos(t))*abs(x' - cos(2*t))*abs(x - sin(3*t)) = 0",
        "x'' + x + eps*sqrt(x - cos(t))*sqrt(x - cos(V*t))*sqrt(x - t) = 0",
    ] {
        let oscillator = Oscillator::parse(equation).expect(equation);
        for method in Method::ALL {
            let options = Options {
                method: Some(method),
                ..Options::default()
            };
            let refusal = solve(&oscillator, &options).expect_err(equation);
            assert!(refusal.term().is_some(), "{equation}: {refusal}");
        }
        let default = solve(&oscillator, &Options::default()).expect_err(equation);
        assert!(default.term().is_some(), "{equation}: {default}");
    }
}

/// Beside a fifth power damping, detuning and drive count as the fourth power of the amplitude: there are steady motions, and their error
/// vanishes as the next power does.
#[test]
fn a_fifth_power_balances_at_its_own_order() {
    let equation = "x'' + x'/50 + x + x^5/10 = cos(Omega*t)/20";
    let judged = judged(equation, (1, 1), 4, "Omega = 51/50");
    assert_eq!(judged.verdict, Verdict::Pass, "{judged:?}");
    let slope = judged.slope.expect("a slope");
    assert!((3.5..6.0).contains(&slope), "{slope}");
    let (_, solution) = derived(equation, Some((1, 1)), None);
    assert_eq!(solution.order, 4);
    let law = solution.law.frequency().expect("a backbone").to_string();
    assert_eq!(law, "1 + a^4/32");
}

/// To first order in the amplitude nothing holds a damped motion: the order that does is named.
#[test]
fn an_order_at_which_nothing_holds_the_motion_is_refused() {
    let oscillator = Oscillator::parse("x'' + 2*zeta*x' + x + b*x^2 = F*cos(Omega*t)").expect("an oscillator");
    let options = Options {
        method: Some(Method::MultipleScales),
        small: Some("A".to_owned()),
        order: Some(1),
        resonance: Some((1, 2)),
        ..Options::default()
    };
    let refusal = solve(&oscillator, &options).expect_err("nothing holds it");
    assert!(refusal.to_string().contains("needs order 2"), "{refusal}");
    let held = Options {
        order: Some(2),
        ..options
    };
    let solution = solve(&oscillator, &held).expect("an answer");
    assert!(solution.response.is_some_and(|response| response.relation.is_some()));
}
