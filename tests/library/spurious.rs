//! Steady motions that only the truncation of slow equations makes: left out where no true motion
//! is near, and only there.

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

/// The amplitude of the true motion to which Newton's method leads from a steady motion by the
/// formula; nothing where it leads to none.
fn true_amplitude(
    equation: &str,
    solution: &Solution,
    at: &Values,
    state: &SteadyState,
) -> Option<f64> {
    let oscillator = Oscillator::parse(equation).expect(equation);
    let resonance = solution.modulation.as_ref()?.resonance.as_ref()?;
    let mut numbers: BTreeMap<Symbol, f64> = at.numbers();
    let period = TAU * f64::from(resonance.times_linear)
        / resonance.driving_frequency.evaluate(&numbers).ok()?;
    let defined = solution.defined_values(&|name| numbers.get(&name).copied()).ok()?;
    numbers.extend(defined);
    let exact = |(name, value): (&Symbol, &f64)| {
        (*name, format!("{value:.17}").parse::<Expr>().expect("a number"))
    };
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
    let found = periodic_motion(&acceleration, period, start, state.amplitude, &[])?;
    Some(found.harmonic(resonance.times_driving))
}

#[test]
fn no_true_motion_is_near_what_is_left_out() {
    let mut left_out = 0;
    for (equation, resonance, order, at) in [
        (PARAMETRIC, (1, 1), 2, "zeta = 1/1000, h = 1/5, eps = 1/10, Omega = 1"),
        (PARAMETRIC, (1, 1), 2, "zeta = 1/1000, h = 1/5, eps = 1/100, Omega = 21/20"),
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
        (PARAMETRIC, (1, 1), 2, "zeta = 1/1000, h = 1/5, eps = 1/10, Omega = 1", 3),
        (PARAMETRIC, (1, 1), 3, "zeta = 1/1000, h = 1/10, eps = 1/100, Omega = 1", 5),
        (PARAMETRIC, (2, 1), 2, "zeta = 1/200, h = 1/20, eps = 1/100, Omega = 2", 2),
        (DUFFING, (1, 1), 1, "zeta = 1/100, eps = 1/50, F = 1/20, Omega = 26/25", 3),
        (DUFFING, (1, 1), 2, "zeta = 1/100, eps = 1/50, F = 1/20, Omega = 26/25", 3),
        (DUFFING, (1, 1), 3, "zeta = 1/100, eps = 1/50, F = 1/20, Omega = 26/25", 3),
        (DUFFING, (3, 1), 2, "zeta = 1/2000, eps = 1/200, F = 10, Omega = 31/10", 3),
    ] {
        let solution = derived(equation, resonance, order);
        let values: Values = at.parse().expect("values");
        let oscillator = Oscillator::parse(equation).expect(equation);
        let judged = judge(&oscillator, &solution, &values, 0.05).expect(equation);
        assert_eq!(judged.steady_states.len(), count, "{equation} {at} {order}");
        for state in &judged.steady_states {
            let near = state.state.amplitude == 0.0
                || state.relative_error.is_some_and(|error| error.abs() < 0.05);
            assert!(
                near && state.true_stable == Some(state.state.is_stable()),
                "{equation} {at}: {state:?}"
            );
        }
    }
}

/// Beside a jump two motions are born whose leading order has none: where the first order has one
/// motion and the second has three, none of the three is left out.
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

const QUADRATIC: &str = "x'' + 2*zeta*x' + x + b*x^2 = F*cos(Omega*t)";

/// A steady motion that nothing saturates to leading order is one of the equation all the same:
/// subharmonic and superharmonic motions whose amplitude the second order decides, against the true
/// ones.
#[test]
fn motions_that_the_last_order_holds_stay() {
    for (equation, resonance, order, at, amplitudes) in [
        (QUADRATIC, (2, 1), 2, "zeta = 1/200, b = 1/10, F = 3/5, Omega = 201/100", vec![0.881]),
        (QUADRATIC, (2, 1), 3, "zeta = 1/200, b = 1/10, F = 3/5, Omega = 201/100", vec![0.881]),
        (
            DUFFING,
            (1, 3),
            2,
            "zeta = 1/500, eps = 1/20, F = 6/5, Omega = 37/100",
            vec![2.0, 0.2469],
        ),
    ] {
        let oscillator = Oscillator::parse(equation).expect(equation);
        let judged =
            judge(&oscillator, &derived(equation, resonance, order), &at.parse().expect(at), 0.1)
                .expect(at);
        let moving = judged.steady_states.iter().filter(|state| state.state.amplitude > 0.0);
        let found: Vec<f64> = moving.filter_map(|state| state.true_amplitude).collect();
        assert_eq!(found.len(), amplitudes.len(), "{equation} {at}: {found:?}");
        for (found, expected) in found.iter().zip(&amplitudes) {
            assert!((found / expected - 1.0).abs() < 5e-3, "{equation} {at}: {found} {expected}");
        }
        for state in &judged.steady_states {
            let near = state.state.amplitude == 0.0
                || state.relative_error.is_some_and(|error| error.abs() < 0.2);
            assert!(near, "{equation} {at} {order}: {state:?}");
        }
    }
}

/// Every place at which the printed slow equations vanish is among the steady motions: Newton's
/// method from a fine grid finds no other, and finds them all.
#[test]
fn steady_motions_are_all_roots_of_the_slow_equations() {
    for (equation, resonance, order, at) in [
        (DUFFING, (1, 1), 1, "zeta = 1/50, eps = 1/10, F = 3/50, Omega = 11/10"),
        (DUFFING, (1, 1), 2, "zeta = 1/50, eps = 1/2, F = 1/2, Omega = 9/10"),
        (DUFFING, (1, 1), 3, "zeta = 1/50, eps = 1/2, F = 1/2, Omega = 9/10"),
        (DUFFING, (1, 3), 2, "zeta = 1/500, eps = 1/20, F = 6/5, Omega = 37/100"),
        (DUFFING, (3, 1), 2, "zeta = 1/500, eps = 1/20, F = 4, Omega = 31/10"),
        (QUADRATIC, (2, 1), 2, "zeta = 1/200, b = 1/10, F = 3/5, Omega = 201/100"),
        (QUADRATIC, (1, 2), 2, "zeta = 1/100, b = 1/5, F = 1/2, Omega = 51/100"),
        (PARAMETRIC, (1, 1), 2, "zeta = 1/1000, h = 1/5, eps = 1/10, Omega = 1"),
        (PARAMETRIC, (1, 1), 3, "zeta = 1/1000, h = 1/10, eps = 1/100, Omega = 1"),
        (PARAMETRIC, (2, 1), 3, "zeta = 1/100, h = 1/10, eps = -1/10, Omega = 2"),
    ] {
        let solution = derived(equation, resonance, order);
        let at: Values = at.parse().expect("values");
        let motions = found(&solution, &at);
        let all: Vec<SteadyState> =
            motions.states.iter().chain(&motions.spurious).copied().collect();
        let largest = all.iter().map(|state| state.amplitude).fold(1.0, f64::max);
        let times = f64::from(resonance.0);
        let own: Vec<[f64; 2]> = on_grid(&solution, &at, 1.1 * largest);
        assert!(!own.is_empty(), "{equation} {at:?}");
        let same = |[u, v]: &[f64; 2], state: &SteadyState| {
            let near = |k: u32| {
                let angle = (state.phase + TAU * f64::from(k)) / times;
                let [x, y] = [state.amplitude * angle.cos(), -state.amplitude * angle.sin()];
                (x - u).hypot(y - v) < 1e-5 * largest
            };
            (0..resonance.0).any(near)
        };
        for place in &own {
            let known = all.iter().any(|state| same(place, state));
            assert!(known, "{equation} {at:?} {order}: {place:?} is missing in {all:?}");
        }
        for state in &all {
            let known = own.iter().any(|place| same(place, state));
            assert!(known, "{equation} {at:?} {order}: {state:?} is none of {own:?}");
        }
    }
}

/// The places to which Newton's method leads from a grid, by the rates in the plane alone.
fn on_grid(solution: &Solution, at: &Values, size: f64) -> Vec<[f64; 2]> {
    const STEPS: i32 = 24;
    let plane =
        solution.response.as_ref().and_then(|response| response.plane.as_ref()).expect("a plane");
    let mut numbers = at.numbers();
    numbers.extend(solution.defined_values(&|name| at.get(name)).expect("all values are given"));
    let exact = |(name, value): (&Symbol, &f64)| {
        (*name, format!("{value:.17}").parse::<Expr>().expect("a number"))
    };
    let values: BTreeMap<Symbol, Expr> = numbers.iter().map(exact).collect();
    let compiled = |part: &Expr| CompiledFunction::new(part, &plane.coordinates).expect("compiled");
    let rates: Vec<Expr> = plane
        .rates
        .iter()
        .map(|rate| Expr::from(rate).substitute_all(&values).expect("numbers"))
        .collect();
    let [p, q] = [0, 1].map(|k| compiled(&rates[k]));
    let slopes = [0, 1].map(|k| {
        plane.coordinates.map(|name| compiled(&rates[k].differentiate(name).expect("a slope")))
    });
    let mut places: Vec<[f64; 2]> = vec![];
    for i in -STEPS..=STEPS {
        for j in -STEPS..=STEPS {
            let mut place = [i, j].map(|k| size * (f64::from(k) + 0.37) / f64::from(STEPS));
            let mut moved = f64::INFINITY;
            for _ in 0..60 {
                let [[a, b], [c, d]] =
                    slopes.each_ref().map(|row| row.each_ref().map(|slope| slope.call(&place)));
                let [u, v] = [p.call(&place), q.call(&place)];
                let determinant = a * d - b * c;
                let step = [(d * u - b * v) / determinant, (a * v - c * u) / determinant];
                place = [place[0] - step[0], place[1] - step[1]];
                moved = step[0].hypot(step[1]);
                if moved < 1e-13 * size || !moved.is_finite() {
                    break;
                }
            }
            let settled = moved < 1e-9 * size && place[0].hypot(place[1]) <= size;
            let is_new =
                |known: &[f64; 2]| (known[0] - place[0]).hypot(known[1] - place[1]) > 1e-6 * size;
            if settled && places.iter().all(is_new) {
                places.push(place);
            }
        }
    }
    places
}
