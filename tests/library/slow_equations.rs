//! Slow equations of several coordinates, put back into the equations of motion, and held to published
//! laws and to the method for one coordinate.
//!
//! - Saturation at 1:2: A. H. Nayfeh, D. T. Mook, *Nonlinear Oscillations*, Wiley 1979, section 6.5.
//! - Death of two van der Pol oscillators: D. G. Aronson, G. B. Ermentrout, N. Kopell, *Physica D* 41
//!   (1990) 403.
//! - Two equal cubic oscillators: A. F. Vakakis, R. H. Rand, *Int. J. Non-Linear Mech.* 27 (1992) 861.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use lindstedt::expr::{CompiledList, Expr, parse_expression};
use lindstedt::method::{Options, solve};
use lindstedt::modes::ModeError;
use lindstedt::multiple_scales::{
    CoupledSystem, MultipleScalesError, MultipleScalesOptions, SlowMotion, SlowNumbers, derive,
};
use lindstedt::solution::Method;
use lindstedt::verify::{JudgedSteadyMotion, judge_slow_motion};
use lindstedt::{Interrupt, Oscillator, Symbol, Values, Verdict};
use num_complex::Complex;

fn options(order: Option<usize>, resonance: &str) -> MultipleScalesOptions {
    let resonance = (!resonance.is_empty()).then(|| resonance.to_owned());
    MultipleScalesOptions { order, resonance, ..MultipleScalesOptions::default() }
}

fn slow(equations: &str, resonance: &str, order: Option<usize>) -> SlowMotion {
    let system =
        CoupledSystem::parse(equations).unwrap_or_else(|error| panic!("{equations}: {error}"));
    derive(&system, &options(order, resonance))
        .unwrap_or_else(|error| panic!("{equations}: {error}"))
}

/// The expression that a text stands for.
fn expression(text: &str) -> Expr {
    parse_expression(text).expect("an expression")
}

/// Whether two expressions agree where their letters have some values.
fn agree(one: &Expr, other: &Expr) -> bool {
    let names = one.symbols().into_iter().chain(other.symbols());
    let values: BTreeMap<Symbol, f64> = names
        .enumerate()
        .map(|(index, name)| (name, 0.3 + 0.37 * (index as f64 + 1.0).sqrt()))
        .collect();
    let [one, other] =
        [one, other].map(|expression| expression.evaluate(&values).expect("a value"));
    (one - other).abs() <= 1e-12 * (one.abs() + other.abs())
}

/// What a formula leaves of the equations at some times and phases, as a part of the amplitude, where
/// amplitudes are `delta` times these.
fn left_over(slow: &SlowMotion, amplitudes: &[f64], values: &[(&str, f64)], delta: f64) -> f64 {
    let t = Symbol::new("t");
    let own: Vec<[Symbol; 2]> =
        slow.amplitudes.iter().zip(&slow.phases).map(|(a, phase)| [*a, *phase]).collect();
    let rates: Vec<[Expr; 2]> = (0..own.len())
        .map(|mode| {
            let meanings: BTreeMap<Symbol, Expr> = (0..slow.slow_phases.len())
                .filter_map(|index| Some((slow.slow_phases[index].0, slow.meaning(index)?)))
                .collect();
            let rates = slow.rate(mode).expect("rates");
            rates.map(|rate| rate.substitute_all(&meanings).expect("a rate"))
        })
        .collect();
    let along = |motion: &Expr| -> Expr {
        let mut sum = motion.differentiate(t).expect("a derivative");
        for (names, rates) in own.iter().zip(&rates) {
            for (name, rate) in names.iter().zip(rates) {
                sum = sum + motion.differentiate(*name).expect("a derivative") * rate.clone();
            }
        }
        sum
    };
    let equations = &slow.system.equations;
    let mut moving = BTreeMap::new();
    for (name, motion) in equations.coordinates.iter().zip(&slow.motion) {
        let velocity = along(motion);
        moving.insert(name.derivative().derivative(), along(&velocity));
        moving.insert(name.derivative(), velocity);
        moving.insert(*name, motion.clone());
    }
    let residuals: Vec<Expr> = equations
        .equations
        .iter()
        .map(|(left, right)| (left - right).substitute_all(&moving).expect("a residual"))
        .collect();
    let mut numbers: BTreeMap<Symbol, f64> =
        values.iter().map(|(name, value)| (Symbol::new(name), *value)).collect();
    let defined = slow.values(&|name| numbers.get(&name).copied()).expect("values");
    numbers.extend(defined);
    let names: Vec<Symbol> =
        numbers.keys().copied().chain([t]).chain(own.iter().flatten().copied()).collect();
    let compiled = CompiledList::new(&residuals, &names).expect("compiled");
    let mut largest = 0.0_f64;
    for sample in 0..40 {
        let turn = f64::from(sample);
        let arguments: Vec<f64> = numbers
            .values()
            .copied()
            .chain([1.7 * turn])
            .chain(
                amplitudes
                    .iter()
                    .enumerate()
                    .flat_map(|(mode, a)| [delta * a, 0.9 * turn * (mode as f64 + 1.3).sqrt()]),
            )
            .collect();
        let mut found = vec![0.0; residuals.len()];
        compiled.call(&arguments, &mut vec![], &mut found);
        largest = found.iter().fold(largest, |largest, value| largest.max(value.abs()));
    }
    largest / delta
}

/// The exponent of what is left over, which is the order and one.
fn exponent(
    slow: &SlowMotion,
    amplitudes: &[f64],
    values: impl Fn(f64) -> Vec<(&'static str, f64)>,
    scale: impl Fn(f64) -> f64,
) -> f64 {
    // Small enough for the next order to decide, large enough for rounding not to.
    let delta = if slow.order > 3 { 0.05 } else { 0.01 };
    let [large, small] =
        [delta, delta / 2.0].map(|delta| left_over(slow, amplitudes, &values(delta), scale(delta)));
    (large / small).log2()
}

#[test]
fn what_is_left_of_the_equations_is_of_the_next_order() {
    // 1:2, driven at the second mode; damping, detunings and the force are small with the amplitude.
    let pair = "u'' + 2*mu*u' + w1^2*u - b*u*v + k*u^3 = 0; v'' + 2*mu*v' + w2^2*v - c*u^2 + u'*v' = F*cos(Omega*t)";
    for order in [1, 2, 3] {
        let found = slow(pair, "w2 = 2*w1, Omega = w2", Some(order));
        let values = |delta: f64| {
            vec![
                ("mu", 0.3 * delta),
                ("w1", 1.0),
                ("w2", 2.0 - 0.7 * delta),
                ("b", 0.4),
                ("c", 0.7),
                ("k", 0.9),
                ("F", 0.8 * delta * delta),
                ("Omega", 2.0 + 0.4 * delta),
            ]
        };
        let found = exponent(&found, &[0.7, 1.1], values, |delta| delta);
        assert!((found - order as f64 - 1.0).abs() < 0.1, "1:2 to order {order}: {found}");
    }
    // 1:3 with cubic forces and coupled masses; damping counts as the square of the amplitude.
    let third = "x'' + y''/5 + 2*mu*x' + x + x^3 + b*x^2*y = 0; y'' + x''/5 + W*y + b*x^3/3 + y^3/2 = F*cos(Omega*t)";
    for order in [2, 3, 4] {
        let found = slow(third, "omega2 = 3*omega1, Omega = omega1", Some(order));
        let values = |delta: f64| {
            let small = delta * delta;
            vec![
                ("mu", 0.3 * small),
                ("b", 0.6),
                ("W", 8.0 + 0.2 * small),
                ("F", 0.5 * delta * small),
                ("Omega", 0.98 + 0.1 * small),
            ]
        };
        // omega2 = 3 omega1 at this W, to which Omega is adjusted.
        let near = |delta: f64| {
            let mut values = values(delta);
            let [w, omega] = resonant_pair();
            values[2].1 = w + 0.2 * delta * delta;
            values[4].1 = omega + 0.1 * delta * delta;
            values
        };
        let found = exponent(&found, &[0.7, 0.5], near, |delta| delta);
        // Odd powers alone: the order that is left over is the next even one.
        let expected = if order % 2 == 0 { order + 2 } else { order + 1 };
        assert!((found - expected as f64).abs() < 0.15, "1:3 to order {order}: {found}");
    }
    // A small parameter: two van der Pol oscillators that are coupled by their velocities.
    let cycles = "x'' + x - eps*(1 - x^2)*x' = eps*k*(y' - x'); y'' + w^2*y - eps*(1 - y^2)*y' = eps*k*(x' - y')";
    for order in [1, 2] {
        let found = slow(cycles, "w = omega1", Some(order));
        let values = |eps: f64| vec![("eps", eps), ("k", 0.7), ("w", 1.0 + 0.4 * eps)];
        let found = exponent(&found, &[1.7, 1.3], values, |_| 1.0);
        assert!((found - order as f64 - 1.0).abs() < 0.1, "1:1 to order {order}: {found}");
    }
    // A parametric resonance of the sum, and a force far from resonance that drives a superharmonic one.
    let sum = "x'' + 2*mu*x' + x + h*y*cos(Omega*t) + x^3 = 0; y'' + 2*mu*y' + 3*y + h*x*cos(Omega*t) + x*y^2 = 0";
    let found = slow(sum, "Omega = omega1 + omega2", Some(2));
    let values = |delta: f64| {
        let small = delta * delta;
        vec![("mu", 0.3 * small), ("h", 0.8 * small), ("Omega", 1.0 + 3.0_f64.sqrt() + 0.3 * small)]
    };
    let left = exponent(&found, &[0.7, 0.5], values, |delta| delta);
    assert!((left - 4.0).abs() < 0.15, "sum: {left}");
    let hard = "x'' + x + x*y = F*cos(Omega*t); y'' + 5*y + x^2 = 0";
    let found = slow(hard, "2*Omega = omega2", Some(1));
    let values =
        |delta: f64| vec![("F", 0.6 * delta), ("Omega", 5.0_f64.sqrt() / 2.0 + 0.2 * delta)];
    let left = exponent(&found, &[0.7, 0.5], values, |delta| delta);
    assert!((left - 2.0).abs() < 0.1, "superharmonic: {left}");
}

/// W and omega1 of the second pair at which its frequencies are as 1 to 3.
fn resonant_pair() -> [f64; 2] {
    // det [[1 - s, -s/5], [-s/5, W - s]] = 0, s = omega^2: 0.96 s^2 - (1 + W) s + W = 0, roots s and 9 s.
    // 10 s = (1 + W)/0.96, 9 s^2 = W/0.96.
    let f = |s: f64| 9.0 * s * s * 0.96 - (10.0 * s * 0.96 - 1.0);
    let (mut low, mut high) = (0.9, 1.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(low) * f(middle) <= 0.0 { high = middle } else { low = middle }
    }
    let s = 0.5 * (low + high);
    [10.0 * s * 0.96 - 1.0, s.sqrt()]
}

#[test]
fn two_that_are_not_coupled_are_each_what_one_is_alone() {
    let pair = slow("x'' + w^2*x + b*x^2 + c*x^3 + x*x'^2 = 0; z'' + 7*z = 0", "none", Some(2));
    let alone =
        Oscillator::parse("x'' + w^2*x + b*x^2 + c*x^3 + x*x'^2 = 0").expect("an oscillator");
    let options =
        Options { method: Some(Method::MultipleScales), order: Some(2), ..Options::default() };
    let law = solve(&alone, &options).expect("a law").law;
    let frequency = Expr::from(law.frequency().expect("a frequency"));
    let [amplitude, phase] = pair.rate(0).expect("rates");
    assert!(amplitude.is_zero());
    let a1 = [(Symbol::new("a1"), Expr::symbol("a"))].into();
    let ours = phase.substitute_all(&a1).expect("a rate") + Expr::symbol("w");
    assert!(agree(&ours, &frequency), "{ours} for {frequency}");
}

#[test]
fn the_second_mode_saturates_whatever_the_force() {
    let pair = "u'' + 2*mu1*u' + w1^2*u = alpha1*u*v; v'' + 2*mu2*v' + w2^2*v = alpha2*u^2 + F*cos(Omega*t)";
    let found = slow(pair, "w2 = 2*w1, Omega = w2", None);
    let relations = found.steady_relations();
    let moving = relations.iter().find(|relation| relation.at_rest.is_empty()).expect("a relation");
    let (name, square) = moving.solved.clone().expect("one amplitude");
    assert_eq!(name.name(), "a2");
    // At exact resonance a2 = 4 w1 mu1/alpha1.
    let exact = [(Symbol::new("sigma1"), Expr::zero()), (Symbol::new("Omega"), expression("2*w1"))];
    let square = square.substitute_all(&exact.into()).expect("a square");
    assert!(agree(&square, &expression("(4*w1*mu1/alpha1)^2")), "{square}");
    // In numbers, beside the true motion: 0.10019 for F = 0.008.
    let judged = judge_slow_motion(
        &found,
        &"mu1 = 1/100, mu2 = 1/100, w1 = 1, w2 = 2, alpha1 = 2/5, alpha2 = 3/10, F = 1/125, Omega = 2"
            .parse()
            .expect("values"),
        0.01,
        Interrupt::default(),
    )
    .expect("judged");
    let stable: Vec<_> = judged.steady.iter().filter(|motion| motion.state.is_stable()).collect();
    let [motion] = stable.as_slice() else { panic!("{judged:?}") };
    assert!((motion.state.amplitudes[1] - 0.1).abs() < 1e-12);
    assert_eq!((judged.verdict, motion.truly_stable), (Some(Verdict::Pass), Some(true)));
    let at_rest = judged.steady.iter().find(|motion| motion.state.amplitudes[0] == 0.0);
    assert!(at_rest.is_some_and(|motion| !motion.state.is_stable()));
}

#[test]
fn coupled_cycles_die_beyond_the_published_distance() {
    let cycles = "x'' + x - eps*(1 - x^2)*x' = eps*k*(y' - x'); y'' + w^2*y - eps*(1 - y^2)*y' = eps*k*(x' - y')";
    let found = slow(cycles, "w = omega1", None);
    // abs(w1 - w2) > eps sqrt(2 k - 1), for k > 1.
    let edge = 0.05 * 3.0_f64.sqrt();
    for (apart, dies) in [(edge * 1.001, true), (edge * 0.999, false)] {
        let values: BTreeMap<&str, f64> = [("eps", 0.05), ("k", 2.0), ("w", 1.0 + apart)].into();
        let numbers = found.in_numbers(&|name| values.get(name.name()).copied()).expect("values");
        let states = numbers.steady_states(Default::default()).isolated;
        let rest = states.iter().find(|state| state.amplitudes == [0.0, 0.0]).expect("rest");
        assert_eq!(rest.is_stable(), dies, "{apart}: {states:?}");
    }
}

#[test]
fn the_mode_out_of_phase_branches_where_it_was_published() {
    // phi1' - phi2' along a1 = a + u, a2 = a - u, phi1 - phi2 = pi + g: whether u and g stay small.
    let pair = "x'' + x + x^3 + K*(x - y)^3 = 0; y'' + y + y^3 + K*(y - x)^3 = 0";
    let found = slow(pair, "omega1 = omega2", None);
    let [a1, _] = found.rate(0).expect("rates");
    let [a2, _] = found.rate(1).expect("rates");
    let [phi1, phi2] = [0, 1].map(|mode| found.rate(mode).expect("rates")[1].clone());
    let at = |expression: &Expr, coupling: f64, u: f64, g: f64| {
        let values = [
            ("a1", 0.3 + u),
            ("a2", 0.3 - u),
            ("K", coupling),
            ("gamma1", std::f64::consts::PI + g),
        ];
        let values = values.map(|(name, value)| (Symbol::new(name), value)).into();
        expression.evaluate(&values).expect("a rate")
    };
    // u' = p g, g' = q u: the mode is stable where p q < 0.
    let product = |coupling: f64| {
        let small = 1e-5;
        let p = (at(&a1, coupling, 0.0, small) - at(&a2, coupling, 0.0, small)) / (2.0 * small);
        let q = (at(&phi1, coupling, small, 0.0) - at(&phi2, coupling, small, 0.0)) / small;
        p * q
    };
    assert!(product(0.251) < 0.0 && product(0.249) > 0.0, "{} {}", product(0.251), product(0.249));
}

#[test]
fn transients_are_followed_at_both_orders() {
    let pair = "x'' + x - x*y = 0; y'' + 4*y - x^2 = 0";
    let error = |order: usize| {
        let found = slow(pair, "", Some(order));
        let at = "a1 = 1/40, a2 = 1/200".parse().expect("values");
        let judged = judge_slow_motion(&found, &at, 0.01, Interrupt::default()).expect("judged");
        judged.transient.expect("a transient").error
    };
    let [first, second] = [1, 2].map(error);
    assert!(second < 1e-4 && first > 100.0 * second, "{first} and {second}");
}

const RING: &str =
    "x'' + 3*x - y - z + x^3 = 0; y'' + 3*y - z - x + y^3 = 0; z'' + 3*z - x - y + z^3 = 0";
const RING_OF_FIVE: &str = "a'' + 3*a - b - f + a^3 = 0; b'' + 3*b - c - a + b^3 = 0; c'' + 3*c - d - b + c^3 = 0; d'' + 3*d - f - c + d^3 = 0; f'' + 3*f - a - d + f^3 = 0";

/// Steady motions of self-excited oscillators are held against cycles whose period is sought, and the
/// measured slope of every kind of motion is that of the order: driven, self-excited in resonance 1:1
/// and 1:3, and transients, with a small parameter and without.
#[test]
fn the_deviation_falls_with_the_order() {
    let locked = "x'' + x - eps*(1 - x^2)*x' = eps*k*(y' - x'); y'' + w^2*y - eps*(1 - y^2)*y' = eps*k*(x' - y')";
    let third = "x'' + x - eps*(1 - x^2)*x' = eps*k*y; y'' + 9*y - eps*(1 - y^2)*y' = eps*k*x^3";
    let driven = "u'' + u'/50 + u - 2*u*v/5 = 0; v'' + v'/50 + 4*v - 3*u^2/10 = F*cos(Omega*t)";
    let coupled = "x'' + 2*x - y + x'/50 + x^3/2 = cos(W*t)/50; y'' + y'/50 + 2*y - x = 0";
    for (equations, resonance, order, at, slope) in [
        (locked, "w = omega1", 1, "eps = 1/20, k = 2, w = 51/50", 2.0),
        (third, "", 1, "eps = 1/20, k = 3/10", 1.0),
        (third, "", 2, "eps = 1/20, k = 3/10", 2.0),
        (third, "", 3, "eps = 1/20, k = 3/10", 3.0),
        (driven, "omega2 = 2*omega1, Omega = omega2", 1, "F = 1/125, Omega = 201/100", 1.0),
        (driven, "omega2 = 2*omega1, Omega = omega2", 2, "F = 1/125, Omega = 201/100", 2.0),
        (driven, "omega2 = 2*omega1, Omega = omega2", 3, "F = 1/125, Omega = 201/100", 3.0),
        (coupled, "W = omega1", 2, "W = 101/100", 2.0),
        ("x'' + x - x*y = 0; y'' + 4*y - x^2 = 0", "", 1, "a1 = 1/40, a2 = 1/200", 1.0),
        ("x'' + x - x*y = 0; y'' + 4*y - x^2 = 0", "", 2, "a1 = 1/40, a2 = 1/200", 2.0),
        // Modes of one frequency: a ring of three, and one of five whose roots are no fractions.
        (RING, "", 2, "a1 = 1/20, a2 = 1/20, a3 = 1/30", 2.0),
        (RING_OF_FIVE, "", 2, "a1 = 1/30, a2 = 1/20, a3 = 1/30, a4 = 1/30, a5 = 1/40", 2.0),
    ] {
        let found = slow(equations, resonance, Some(order));
        let judged =
            judge_slow_motion(&found, &at.parse().expect("values"), 0.2, Interrupt::default())
                .expect("judged");
        let measured = judged.slope.expect(equations);
        assert!((measured - slope).abs() < 0.1, "{equations}, order {order}: {measured}");
        if judged.transient.is_none() {
            let compared = judged.steady.iter().filter(|motion| motion.compared);
            let stable = compared.filter(|motion| motion.state.is_stable());
            let agree = |motion: &&JudgedSteadyMotion| motion.truly_stable == Some(true);
            assert!(stable.clone().count() > 0 && stable.clone().all(|motion| agree(&motion)));
            for motion in stable {
                let undriven = found.system.drives.is_empty();
                assert_eq!(motion.frequency.is_some(), undriven, "{equations}");
                if let Some((own, truth)) = motion.frequency {
                    let error = own / truth.expect("a true frequency") - 1.0;
                    assert!(error.abs() < 3e-4, "{equations}, order {order}: {error}");
                }
            }
        }
    }
}

#[test]
fn refusals_name_what_is_in_the_way() {
    let refused = |equations: &str, resonance: &str, order: Option<usize>| {
        let system = match CoupledSystem::parse(equations) {
            Ok(system) => system,
            Err(error) => return error,
        };
        derive(&system, &options(order, resonance)).expect_err(equations)
    };
    let defective = refused("x'' + x + y + x^3 = 0; y'' + y = 0", "none", None);
    assert!(
        matches!(defective, MultipleScalesError::Modes(ModeError::Defective { .. })),
        "{defective}"
    );
    let gyroscope = refused("x'' + x - g*y' = 0; y'' + y + g*x' + x^3 = 0", "", None);
    assert!(matches!(gyroscope, MultipleScalesError::Gyroscopic(_)), "{gyroscope}");
    let open = refused("x'' + x + x^3 = F*cos(W*t); y'' + 2*y + x*y = 0", "", None);
    assert!(open.help().is_some_and(|help| help.contains("W = omega1")), "{open:?}");
    let far = refused("x'' + x + x*y = 0; y'' + 2*y + x^2 = 0", "omega2 = 3*omega1", None);
    assert!(far.to_string().contains("far"), "{far}");
    let form = refused("x'' + x + x*y = 0; y'' + 2*y + x^2 = 0", "omega2 = 3*omega9", None);
    assert!(form.to_string().contains("omega9"), "{form}");
    let missed = refused("x'' + x + x*y = 0; y'' + 4*y + x^2 = 0", "none", None);
    assert!(matches!(missed, MultipleScalesError::Divisor { mode: 1, .. }), "{missed}");
    let low = refused("x'' + x + x^3 + y^3 = 0; y'' + 2*y = 0", "none", Some(1));
    assert!(matches!(low, MultipleScalesError::BelowBalance { asked: 1, lowest: 2 }), "{low}");
    let jump = refused("x'' + x + sgn(x') = 0; y'' + 2*y + x^2 = 0", "", None);
    assert!(
        matches!(jump, MultipleScalesError::Taylor(_) | MultipleScalesError::Term(_)),
        "{jump}"
    );
    let twice = refused(
        "x'' + x + x*y = 0; y'' + 4*y + x^2 = 0",
        "omega2 = 2*omega1, 2*omega2 = 4*omega1",
        None,
    );
    assert!(twice.to_string().contains("follows"), "{twice}");
    let alone = refused("x'' + x + x^3 = 0; y'' = x", "", None);
    assert!(alone.to_string().contains("omega = 0"), "{alone}");
}

/// Steady motions that differ in phase alone, families, large amplitudes, drives on one mode: each was
/// missed once.
#[test]
fn no_steady_motion_is_passed_over() {
    let states = |equations: &str, values: &[(&str, f64)]| {
        let system = CoupledSystem::parse(equations).expect(equations);
        let values: BTreeMap<Symbol, f64> =
            values.iter().map(|(name, value)| (Symbol::new(name), *value)).collect();
        let asked = MultipleScalesOptions { values: values.clone(), ..Default::default() };
        let slow = derive(&system, &asked).unwrap_or_else(|error| panic!("{equations}: {error}"));
        let numbers = slow.in_numbers(&|name| values.get(&name).copied()).expect("values");
        (numbers.steady_states(Default::default()), slow)
    };
    // In phase and out of phase, with equal amplitudes.
    let (found, _) = states(
        "x'' - eps*(1 - x^2)*x' + x + eps*(x - y) = 0; y'' - eps*(1 - y^2)*y' + y + eps*(y - x) = 0",
        &[("eps", 0.1)],
    );
    let locked = found.isolated.iter().filter(|state| state.is_stable());
    let amplitudes: Vec<_> = locked.map(|state| state.amplitudes.clone()).collect();
    assert_eq!(amplitudes.len(), 2, "{found:?}");
    assert!(amplitudes.iter().flatten().all(|a| (a - 2.0).abs() < 1e-9));
    // A circle of motions.
    let (found, _) = states(
        "x'' - eps*(1 - x^2 - y^2)*x' + x = 0; y'' - eps*(1 - x^2 - y^2)*y' + y = 0",
        &[("eps", 0.1)],
    );
    assert!(found.has_families, "{found:?}");
    // Nothing takes energy: members of families are not listed as if they stood alone.
    let (found, _) = states(
        "x'' + x + eps*x*y = eps*cos(t)^2; y'' + 4*y + eps*x^2*sin(3*t) = 0",
        &[("eps", 0.05)],
    );
    assert!(found.has_families && found.isolated.is_empty(), "{found:?}");
    // Nor those with a mode at rest.
    for equations in [
        "x'' + x + 0.1*x^3 = 0; y'' + 1.05*y + 0.1*y^3 + 0.1*(y - x) = 0",
        "x'' + x + 0.1*y*z = 0; y'' + 2.25*y + 0.2*x*z = 0; z'' + 6.25*z + 0.3*x*y = 0",
        "x'' + x + 0.3*x^3 + 0.2*x^2*y = 0; y'' + 9*y + 0.1*x^3 = 0",
    ] {
        let (found, _) = states(equations, &[]);
        let moving =
            found.isolated.iter().filter(|state| state.amplitudes.iter().any(|a| *a > 0.0));
        assert!(found.has_families && moving.count() == 0, "{equations}: {found:?}");
    }
    // The same in other units.
    let at = |scale: f64| {
        let system = format!(
            "x'' + x'/50 + x + x*y/{scale} = 0; y'' + y'/50 + 4*y + x^2/{scale} = F*cos(Omega*t)"
        );
        states(&system, &[("F", 0.01 * scale), ("Omega", 2.0)]).0.isolated.len()
    };
    assert_eq!([at(5.0), at(5000.0)], [2, 2]);
    // A drive near a mode on which it does not act drives another at twice its frequency.
    let (_, slow) = states(
        "x'' + x'/50 + x + x^2/5 = F*cos(Omega*t); y'' + y'/50 + 4*y + y*x^2/5 = 0",
        &[("F", 0.5), ("Omega", 2.0)],
    );
    let [rate, _] = slow.rate(0).expect("rates");
    assert!(rate.contains(Symbol::new("F")), "{rate}");
    // A second drive near the first: its divisor is small, and that is said.
    let (_, slow) = states(
        "x'' + x'/50 + x + x^3/5 = F*cos(Omega*t) + G*cos(W*t); y'' + y'/50 + 3*y + x*y/5 = 0",
        &[("F", 0.02), ("G", 0.01), ("Omega", 1.01), ("W", 1.02)],
    );
    assert!(slow.near.iter().any(|near| near.mode == 1 && near.distance < 0.02), "{:?}", slow.near);
    // Resonances that contradict the numbers together are not taken together.
    let (_, slow) =
        states("x'' + 2*x - y + x^3/5 = 0; y'' + 2*y - x - z = 0; z'' + 2*z - y = 0", &[]);
    for (reference, frequency) in slow.references.iter().zip(&slow.frequencies) {
        let [reference, frequency] = [reference, frequency]
            .map(|expression| expression.evaluate(&Default::default()).expect("a number"));
        assert!((reference / frequency - 1.0).abs() < 0.061, "{reference} {frequency}");
    }
}

/// Rest under a parametric drive is a motion like any other, and so is the one without modes that a drive
/// far from them leaves.
#[test]
fn motions_without_modes_are_compared() {
    for (equations, resonance, at) in [
        (
            "x'' + x'/50 + 2*x - y + x^3/2 + h*x*cos(Omega*t) = 0; y'' + y'/50 + 2*y - x = 0",
            "Omega = 2*omega1",
            "h = 1/50, Omega = 11/5",
        ),
        (
            "x'' + x'/50 + x + 3*x*y/10 = F*cos(Omega*t); y'' + y'/50 + 144*y/25 + 3*x^2/10 = 0",
            "Omega = omega2 - omega1",
            "F = 1/50, Omega = 7/5",
        ),
    ] {
        let found = slow(equations, resonance, None);
        let at = at.parse().expect("values");
        let judged = judge_slow_motion(&found, &at, 0.01, Interrupt::default()).expect(equations);
        let [only] = judged.steady.as_slice() else { panic!("{equations}: {:?}", judged.steady) };
        assert!(only.state.amplitudes.iter().all(|a| *a == 0.0) && only.compared, "{only:?}");
        assert!(only.error.is_some_and(|error| error < 0.01), "{only:?}");
        assert_eq!((only.truly_stable, judged.verdict), (Some(true), Some(Verdict::Pass)));
    }
}

/// A motion is periodic with its drive also where modes at rest are tied to the moving one by a resonance
/// of their own: here a linear oscillator in resonance, exactly of the amplitude F/(c Omega).
#[test]
fn a_mode_that_moves_alone_is_compared() {
    let found = slow(
        "x'' + x'/40 + 36/25*x + x*y/3 = 0; y'' + y'/30 + 4*y + x*z/4 = 0; z'' + z'/40 + 256/25*z + x*y/5 = F*cos(Omega*t)",
        "Omega = omega3, Omega = omega1 + omega2",
        None,
    );
    let at = "F = 1/100, Omega = 16/5".parse().expect("values");
    let judged = judge_slow_motion(&found, &at, 0.01, Interrupt::default()).expect("a verdict");
    let [only] = judged.steady.as_slice() else { panic!("{:?}", judged.steady) };
    assert!((only.state.amplitudes[2] - 0.125).abs() < 1e-12 && only.compared, "{only:?}");
    assert!(only.error.is_some_and(|error| error < 1e-6), "{only:?}");
    assert_eq!(judged.verdict, Some(Verdict::Pass));
}

/// Along the slow equations of several resonances, by Runge and Kutta, the constants stay what they are,
/// the amplitudes go between the ends of the exchange, and they come back after its period.
#[test]
fn modes_exchange_their_energy_in_the_period_of_the_closed_form() {
    for (equations, order, at) in [
        ("x'' + x - 2*x*y/5 = 0; y'' + 4*y - 3*x^2/10 = 0", 1, [0.05, 0.02, 0.7]),
        ("x'' + x - 2*x*y/5 = 0; y'' + 4*y - 3*x^2/10 = 0", 2, [0.05, 0.02, 0.7]),
        ("x'' + x + x^2*y/5 = 0; y'' + 9*y + x^3/7 = 0", 2, [0.3, 0.1, 1.0]),
        ("x'' + x + x^2*y/5 + x^3 = 0; y'' + 9*y + x^3/15 = 0", 2, [0.3, 0.1, 1.0]),
        ("x'' + x + 2*x*y = 0; y'' + y + x^2 - y^2 = 0", 2, [0.1, 0.02, 0.5]),
    ] {
        let slow = slow(equations, "", Some(order));
        let invariants = slow.invariants().unwrap_or_else(|| panic!("{equations}: no constants"));
        let values: Values =
            format!("a1 = {}, a2 = {}, phi1 = {}", at[0], at[1], at[2]).parse().expect("values");
        let judged =
            judge_slow_motion(&slow, &values, 0.05, Interrupt::default()).expect(equations);
        let exchange = judged.transient.and_then(|transient| transient.exchange);
        let exchange = exchange.unwrap_or_else(|| panic!("{equations}: no exchange"));
        let numbers = slow.in_numbers(&|_| None).expect("numbers");
        let (phase, turns) = &slow.slow_phases[0];
        let constants = invariants.expressions(*phase).expect("formulas");
        assert_eq!(constants.len(), 2, "{equations}");
        let named = |state: &[Complex<f64>]| -> BTreeMap<Symbol, f64> {
            let angle = turns.iter().zip(state).map(|(turn, b)| f64::from(*turn) * b.arg()).sum();
            let amplitudes =
                slow.amplitudes.iter().copied().zip(state.iter().map(|b| 2.0 * b.norm()));
            amplitudes.chain([(*phase, angle)]).collect()
        };
        let of = |state: &[Complex<f64>]| -> Vec<f64> {
            let at = named(state);
            constants.iter().map(|own| own.evaluate(&at).expect("a value")).collect()
        };
        let start =
            [Complex::from_polar(at[0] / 2.0, at[2]), Complex::from_polar(at[1] / 2.0, 0.0)];
        let mut state = start.to_vec();
        const STEPS: usize = 20_000;
        let step = exchange.period / STEPS as f64;
        let first = of(&start);
        let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
        for _ in 0..STEPS {
            state = stepped(&numbers, &state, step);
            least = least.min(2.0 * state[0].norm());
            most = most.max(2.0 * state[0].norm());
        }
        for (before, after) in first.iter().zip(of(&state)) {
            assert!((before - after).abs() < 1e-10 * before.abs(), "{equations}: {before} {after}");
        }
        // The closed form of the period: the integral of ds/sqrt(f) to and fro, by the angle of
        // s = (a + b)/2 + (a - b)/2 cos, over which the mean is exact.
        let [b, a] = exchange.ends;
        let mean: f64 = (0..400)
            .map(|k| {
                let s = 0.5 * (a + b) + 0.5 * (a - b) * (PI * (f64::from(k) + 0.5) / 400.0).cos();
                let f = exchange.rate_squared.iter().rev().fold(0.0, |sum, own| sum * s + own);
                ((a - s) * (s - b) / f).sqrt() / 400.0
            })
            .sum();
        assert!((2.0 * PI * mean / exchange.period - 1.0).abs() < 1e-6, "{equations}");
        let [low, high] = exchange.amplitudes[0];
        assert!(high - low > 0.01 * high, "{equations}: nothing is exchanged");
        assert!(
            (least - low).abs() < 1e-6 * high && (most - high).abs() < 1e-6 * high,
            "{equations}"
        );
        for (before, after) in start.iter().zip(&state) {
            assert!((before.norm() - after.norm()).abs() < 1e-8, "{equations}: {before} {after}");
        }
    }
    // Damping and drives leave no constants.
    let damped = slow("x'' + x'/50 + x - 2*x*y/5 = 0; y'' + 4*y - 3*x^2/10 = 0", "", None);
    assert_eq!(damped.invariants(), None);
}

/// A step of slow equations by the classical method of Runge and Kutta.
fn stepped(numbers: &SlowNumbers, from: &[Complex<f64>], step: f64) -> Vec<Complex<f64>> {
    let moved = |rates: &[Complex<f64>], part: f64| -> Vec<Complex<f64>> {
        from.iter().zip(rates).map(|(b, rate)| b + rate * (part * step)).collect()
    };
    let first = numbers.rates(from);
    let second = numbers.rates(&moved(&first, 0.5));
    let third = numbers.rates(&moved(&second, 0.5));
    let fourth = numbers.rates(&moved(&third, 1.0));
    let mean =
        |mode: usize| (first[mode] + (second[mode] + third[mode]) * 2.0 + fourth[mode]) / 6.0;
    from.iter().enumerate().map(|(mode, b)| b + mean(mode) * step).collect()
}

/// Averaging has the means of the forces along the linear motion, over a common period of both modes:
/// `a' = -<f sin theta>/omega`, `a phi' = -<f cos theta>/omega`.
#[test]
fn averaged_rates_are_means_along_the_linear_motion() {
    let system = CoupledSystem::parse(
        "x'' + x + x'/50 - 2*x*y/5 + x'*y'/7 = 0; y'' + 4*y + y'/30 - 3*x^2/10 = cos(2*t)/100",
    )
    .expect("equations");
    let averaging = MultipleScalesOptions { averaging: true, ..MultipleScalesOptions::default() };
    let slow = derive(&system, &averaging).expect("slow equations");
    let state: [f64; 4] = [0.3, 0.4, 0.2, -0.9];
    let names = slow.amplitudes.iter().zip(&slow.phases).flat_map(|(a, phase)| [*a, *phase]);
    let mut values: BTreeMap<Symbol, f64> = names.zip(state).collect();
    for index in 0..slow.slow_phases.len() {
        if let Some(meaning) = slow.meaning(index) {
            let value = meaning.evaluate(&values).expect("a value");
            values.insert(slow.slow_phases[index].0, value);
        }
    }
    let [a1, phi1, a2, phi2] = state;
    const COUNT: u32 = 64;
    let mut means = [0.0; 4];
    for k in 0..COUNT {
        let t = std::f64::consts::TAU * f64::from(k) / f64::from(COUNT);
        let (theta1, theta2) = (t + phi1, 2.0 * t + phi2);
        let (x, v) = (a1 * theta1.cos(), -a1 * theta1.sin());
        let (y, w) = (a2 * theta2.cos(), -2.0 * a2 * theta2.sin());
        let f = -v / 50.0 + 0.4 * x * y - v * w / 7.0;
        let g = -w / 30.0 + 0.3 * x * x + (2.0 * t).cos() / 100.0;
        let parts = [
            -f * theta1.sin(),
            -f * theta1.cos() / a1,
            -0.5 * g * theta2.sin(),
            -0.5 * g * theta2.cos() / a2,
        ];
        for (mean, part) in means.iter_mut().zip(parts) {
            *mean += part / f64::from(COUNT);
        }
    }
    for mode in 0..2 {
        let rates = slow.rate(mode).expect("rates");
        for (rate, mean) in rates.iter().zip(&means[2 * mode..]) {
            let rate = rate.evaluate(&values).expect("a value");
            assert!((rate - mean).abs() < 1e-14, "{mode}: {rate} {mean}");
        }
    }
    let linear = slow.motion.iter().map(ToString::to_string).collect::<Vec<_>>();
    assert_eq!(linear, ["a1*cos(t + phi1)", "a2*cos(2*t + phi2)"]);
}
