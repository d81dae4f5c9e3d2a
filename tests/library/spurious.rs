//! Steady motions that only the truncation of slow equations makes: left out where no true motion is near, and only there.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use lindstedt::expr::{CompiledFunction, Expr};
use lindstedt::method::{Options, solve};
use lindstedt::numeric::periodic::periodic_motion;
use lindstedt::solution::response::{SteadyMotions, SteadyState};
use lindstedt::solution::{Method, Solution};
use lindstedt::{Oscillator, Symbol, Values, judge};

const PARAMETRIC: &str = "x'' + 2*zeta*x' + (1 + h*cos(Omega*t))*x + eps*x^3 = 0";
const DUFFING: &str = "x'' + 2*zeta*x' + x + eps*x^3 = F*cos(Omega*t)";

fn derived(equation: &str, resonance: (u32, u32), order: u32) -> Solution {
    let options = Options {
        method: Some(Method::MultipleScales),
        order: Some(order),
        resonance: Some(resonance),
        ..Options::default()
    };
    solve(&Oscillator::parse(equation).expect(equation), &options).expect(equation)
}

fn found(solution: &Solution, at: &Values) -> SteadyMotions {
    let numbers = at.numbers();
    solution.steady_motions(&|name| numbers.get(&name).copied())
}

/// The amplitude of the true motion to which Newton's method leads from a steady motion by the formula; nothing where it leads to none.
fn true_amplitude(equation: &str, solution: &Solution, at: &Values, state: &SteadyState) -> Option<f64> {
    let oscillator = Oscillator::parse(equation).expect(equation);
    let resonance = solution.modulation.as_ref()?.resonance.as_ref()?;
    let mut numbers: BTreeMap<Symbol, f64> = at.numbers();
    let period = TAU * f64::from(resonance.times_linear) / resonance.driving_frequency.evaluate(&numbers).ok()?;
    let defined = solution.defined_values(&|name| numbers.get(&name).copied()).ok()?;
    numbers.extend(defined);
    let exact = |(name, value): (&Symbol, &f64)| (*name, format!("{value:.17}").parse::<Expr>().expect("a number"));
    let values: BTreeMap<Symbol, Expr> = numbers.iter().map(exact).collect();
    let [t, x] = ["t", "x"].map(Symbol::new);
    let force = oscillator.force.substitute_all(&values).ok()?;
    let force = CompiledFunction::new(&force, &[t, x, x.derivative()]).ok()?;
    let slow = solution.modulation.as_ref()?;
    let motion = solution.response.as_ref()?.motion.substitute_all(&values).ok()?;
    let arguments = [t, slow.amplitude, slow.phase];
    let [position, velocity] = [motion.clone(), motion.differentiate(t).ok()?]
        .map(|motion| CompiledFunction::new(&motion, &arguments).expect("compiled"));
    let start = [&position, &velocity].map(|of| of.call(&[0.0, state.amplitude, state.phase]));
    let acceleration = |t: f64, x: f64, v: f64| -force.call(&[t, x, v]);
    let found = periodic_motion(&acceleration, period, start, state.amplitude).ok()?;
    Some(found.harmonic(resonance.times_driving))
}

#[test]
fn no_true_motion_is_near_what_is_left_out() {
    let mut left_out = 0;
    for (equation, resonance, order, at) in [
        (PARAMETRIC, (1, 1), 2, "zeta = 1/1000, h = 1/5, eps = 1/10, Omega = 1"),
        (
            PARAMETRIC,
            (1, 1),
            2,
            "zeta = 1/1000, h = 1/5, eps = 1/100, Omega = 21/20",
        ),
        (PARAMETRIC, (1, 1), 2, "zeta = 1/200, h = 1/2, eps = 1/100, Omega = 1"),
        (PARAMETRIC, (2, 1), 2, "zeta = 1/100, h = 1/10, eps = 1/10, Omega = 2"),
        (PARAMETRIC, (2, 1), 3, "zeta = 1/100, h = 1/10, eps = -1/10, Omega = 2"),
        (DUFFING, (1, 1), 2, "zeta = 1/50, eps = 1/10, F = 3/50, Omega = 11/10"),
        (DUFFING, (1, 1), 2, "zeta = 1/50, eps = 1/2, F = 1/2, Omega = 9/10"),
        (DUFFING, (1, 1), 3, "zeta = 1/50, eps = 1/2, F = 1/2, Omega = 9/10"),
        (DUFFING, (1, 3), 2, "zeta = 1/200, eps = 1/20, F = 1/2, Omega = 17/50"),
        (DUFFING, (3, 1), 2, "zeta = 1/500, eps = 1/20, F = 4, Omega = 31/10"),
    ] {
        let solution = derived(equation, resonance, order);
        let at: Values = at.parse().expect("values");
        let motions = found(&solution, &at);
        for state in &motions.spurious {
            let truth = true_amplitude(equation, &solution, &at, state);
            let near = truth.is_some_and(|truth| (truth / state.amplitude - 1.0).abs() < 0.2);
            assert!(!near, "{equation} {at:?} {resonance:?} {order}: {state:?} {truth:?}");
        }
        left_out += motions.spurious.len();
    }
    assert!(left_out >= 12, "{left_out}");
}

#[test]
fn motions_of_the_equation_stay() {
    for (equation, resonance, order, at, count) in [
        (
            PARAMETRIC,
            (1, 1),
            2,
            "zeta = 1/1000, h = 1/5, eps = 1/10, Omega = 1",
            3,
        ),
        (
            PARAMETRIC,
            (1, 1),
            3,
            "zeta = 1/1000, h = 1/10, eps = 1/100, Omega = 1",
            5,
        ),
        (
            PARAMETRIC,
            (2, 1),
            2,
            "zeta = 1/200, h = 1/20, eps = 1/100, Omega = 2",
            2,
        ),
        (
            DUFFING,
            (1, 1),
            1,
            "zeta = 1/100, eps = 1/50, F = 1/20, Omega = 26/25",
            3,
        ),
        (
            DUFFING,
            (1, 1),
            2,
            "zeta = 1/100, eps = 1/50, F = 1/20, Omega = 26/25",
            3,
        ),
        (
            DUFFING,
            (1, 1),
            3,
            "zeta = 1/100, eps = 1/50, F = 1/20, Omega = 26/25",
            3,
        ),
        (
            DUFFING,
            (3, 1),
            2,
            "zeta = 1/2000, eps = 1/200, F = 10, Omega = 31/10",
            3,
        ),
    ] {
        let solution = derived(equation, resonance, order);
        let values: Values = at.parse().expect("values");
        let oscillator = Oscillator::parse(equation).expect(equation);
        let judged = judge(&oscillator, &solution, &values, 0.05).expect(equation);
        assert_eq!(judged.steady_states.len(), count, "{equation} {at} {order}");
        for state in &judged.steady_states {
            let near = state.state.amplitude == 0.0 || state.relative_error.is_some_and(|error| error.abs() < 0.05);
            assert!(
                near && state.true_stable == Some(state.state.is_stable()),
                "{equation} {at}: {state:?}"
            );
        }
    }
}

/// Beside a jump two motions are born whose leading order has none: where the first order has one motion and the second has three, none
/// of the three is left out.
#[test]
fn a_jump_moves_with_the_order() {
    let [first, second] = [1, 2].map(|order| derived(DUFFING, (1, 1), order));
    let mut moved = 0;
    for step in 0..=400 {
        let omega = 1.0 + 0.1 * f64::from(step) / 400.0;
        let at: Values = format!("zeta = 1/50, eps = 1/10, F = 3/50, Omega = {omega:.6}")
            .parse()
            .expect("values");
        let [first, second] = [&first, &second].map(|solution| found(solution, &at));
        assert!(second.spurious.is_empty(), "{omega}: {second:?}");
        for state in &second.states {
            assert!(state.amplitude < 1.6, "{omega}: {state:?}");
        }
        moved += usize::from(first.states.len() == 1 && second.states.len() == 3);
    }
    assert!(moved > 3, "{moved}");
}
