//! Driven motions by multiple scales: slow equations and frequency response at every resonance,
//! steady motions beside the true ones.

use lindstedt::exact::Polynomial;
use lindstedt::expr::{Expr, parse_expression};
use lindstedt::method::{Options, Reason, solve};
use lindstedt::response::{ResponseRequest, SteadyMotion, respond};
use lindstedt::solution::{Method, Note, Solution};
use lindstedt::{Oscillator, Symbol, Values, judge};

use super::{derive, of_text, options};

const FORCED_DUFFING: &str = "x'' + c*x' + w^2*x + g*x^3 = F*cos(Omega*t)";

fn driven(equation: &str, resonance: (u32, u32), order: u32) -> Solution {
    let oscillator = Oscillator::parse(equation).expect("an oscillator");
    let asked = Options { resonance: Some(resonance), ..options(order) };
    solve(&oscillator, &asked)
        .unwrap_or_else(|refusal| panic!("{equation} at {resonance:?}: {refusal}"))
}

/// Nayfeh and Mook, section 4.1: equations (4.1.18), (4.1.37), (4.1.52) with their phase, and
/// (5.7.19).
#[test]
fn published_slow_equations_of_driven_motions() {
    for (equation, resonance, amplitude_rate, phase_rate) in [
        (
            FORCED_DUFFING,
            (1, 1),
            "-c*a/2 + F/(2*w)*sin(psi)",
            "sigma - 3*g*a^2/(8*w) + F/(2*w*a)*cos(psi)",
        ),
        (
            FORCED_DUFFING,
            (1, 3),
            "-c*a/2 - g*Lambda^3/w*sin(psi)",
            "sigma - 3*g*Lambda^2/w - 3*g*a^2/(8*w) - g*Lambda^3/(w*a)*cos(psi)",
        ),
        (
            FORCED_DUFFING,
            (3, 1),
            "-c*a/2 - 3*g*Lambda/(4*w)*a^2*sin(psi)",
            "sigma - 9*g*Lambda^2/w - 9*g*a^2/(8*w) - 9*g*Lambda/(4*w)*a*cos(psi)",
        ),
        (
            "x'' + c*x' + w^2*x + g*x^3 + h*x*cos(Omega*t) = 0",
            (2, 1),
            "-c*a/2 - h/(4*w)*a*sin(psi)",
            "sigma - 3*g*a^2/(4*w) - h/(2*w)*cos(psi)",
        ),
        (
            "x'' + c*x' + w^2*x + g*x^2 = F*cos(Omega*t)",
            (1, 2),
            "-c*a/2 - g*Lambda^2/w*sin(psi)",
            "sigma - g*Lambda^2/(w*a)*cos(psi)",
        ),
        (
            "x'' + c*x' + w^2*x + g*x^2 = F*cos(Omega*t)",
            (2, 1),
            "-c*a/2 - g*Lambda/w*a*sin(psi)",
            "sigma - 2*g*Lambda/w*cos(psi)",
        ),
        // A pendulum in the square of its amplitude, driven and shaken: equation (4.1.18) with g
        // = -omega0^2/6, and (5.7.19) with h.
        (
            "x'' + c*x' + k*sin(x) = F*cos(Omega*t)",
            (1, 1),
            "-c*a/2 + F/(2*omega0)*sin(psi)",
            "sigma + omega0*a^2/16 + F/(2*omega0*a)*cos(psi)",
        ),
        (
            "x'' + c*x' + k*(1 + h*cos(Omega*t))*sin(x) = 0",
            (2, 1),
            "-c*a/2 - h*omega0/4*a*sin(psi)",
            "sigma + omega0*a^2/8 - h*omega0/2*cos(psi)",
        ),
        // A linear oscillator has no small letter but its damping: the amplitude is small where the
        // drive needs it.
        (
            "x'' + c*x' + w^2*x + h*sin(x)*cos(Omega*t) = 0",
            (2, 1),
            "-c*a/2 - h/(4*w)*a*sin(psi)",
            "sigma - h/(2*w)*cos(psi)",
        ),
    ] {
        let order = if equation.contains("sin(x)") { 2 } else { 1 };
        let solution = driven(equation, resonance, order);
        let slow = solution.modulation.as_ref().expect("slow equations");
        for (found, expected) in
            [(&slow.amplitude_rate, amplitude_rate), (&slow.phase_rate, phase_rate)]
        {
            let difference = found - &parse_expression(expected).expect("an expression");
            let left = difference.expand().expect("short");
            assert!(left.is_zero(), "{equation} at {resonance:?}: {found} is not {expected}");
        }
    }
}

/// The frequency-response equation of the primary resonance, (4.1.21), its peak and where its
/// branches meet.
#[test]
fn frequency_response_of_the_primary_resonance() {
    let solution = driven("x'' + 2*zeta*x' + x + eps*x^3 = F*cos(Omega*t)", (1, 1), 1);
    let response = solution.response.as_ref().expect("a response");
    let relation = of_text("zeta^2*a^2 + (sigma*a - 3*eps*a^3/8)^2 - F^2/4");
    assert_eq!(response.relation, Some(relation));
    let peak = parse_expression("F/(2*zeta)").expect("an expression");
    assert_eq!(response.peak, Some(peak));
    // Where two branches meet the relation has a double root, and the discriminant vanishes.
    let at: Values = "zeta = 1/100, eps = 1/10, F = 1/10".parse().expect("values");
    let value = |polynomial: &Polynomial, sigma: f64| {
        let value_of = |name: Symbol| {
            if name.name() == "sigma" { Some(sigma) } else { at.get(name) }
        };
        polynomial.evaluate(value_of).expect("a value")
    };
    let jumps = response.jumps.as_ref().expect("a discriminant");
    let count = |omega: f64| {
        let value_of = |name: Symbol| {
            if name.name() == "Omega" { Some(omega) } else { at.get(name) }
        };
        solution.steady_states(&value_of).len()
    };
    let mut changes = 0;
    let grid: Vec<f64> = (0..400).map(|k| 0.9 + 0.003 * f64::from(k)).collect();
    for pair in grid.windows(2) {
        let signs = [pair[0], pair[1]].map(|omega| value(jumps, omega - 1.0) > 0.0);
        let counts = [count(pair[0]), count(pair[1])];
        assert_eq!(signs.map(|positive| if positive { 3 } else { 1 }), counts, "{pair:?}");
        changes += usize::from(signs[0] != signs[1]);
    }
    assert_eq!(changes, 2, "one jump up, one jump down");
}

/// Where the wave comes an order before all else, `P^2 + Q^2 = S^2` is whole from the order on that
/// has P and Q, and before it there is none.
#[test]
fn frequency_response_of_a_wave_that_comes_first() {
    let equation = "x'' + x'/20 + x + x^2/5 = cos(Omega*t)/5";
    let asked = Options { resonance: Some((1, 2)), ..options(1) };
    let refusal = solve(&Oscillator::parse(equation).expect("an oscillator"), &asked)
        .expect_err("nothing holds it");
    assert!(refusal.to_string().contains("needs order 2"), "{refusal}");
    let solution = driven(equation, (1, 2), 2);
    let whole = of_text("a^2/1600 + (sigma*a + a^3/60 + 46*Lambda^2*a/375)^2 - Lambda^4/25");
    assert_eq!(solution.response.expect("a response").relation, Some(whole));
}

/// An order below that of the first nonlinear term is that of a linear oscillator, and says so.
#[test]
fn an_order_without_nonlinear_terms_says_so() {
    for (force, order, without) in [
        ("x + x^5/10", 2, true),
        ("x + x^5/10", 4, false),
        ("x + x^4/10", 2, true),
        ("x + x^3/10", 2, false),
        ("x", 2, false),
    ] {
        let equation = format!("x'' + x'/50 + {force} = cos(Omega*t)/20");
        let solution = driven(&equation, (1, 1), order);
        let said = solution.validity.contains(&Note::NonlinearTermsLeftOut);
        assert_eq!(said, without, "{equation} to order {order}");
    }
}

/// Every steady motion against the true periodic one, found by shooting: amplitude and stability.
#[test]
fn steady_motions_are_the_true_ones() {
    let duffing = "x'' + 2*zeta*x' + x + eps*x^3 = F*cos(Omega*t)";
    let helmholtz = "x'' + 2*zeta*x' + x + eps*x^2 = F*cos(Omega*t)";
    let parametric = "x'' + 2*zeta*x' + (1 + h*cos(Omega*t))*x + eps*x^3 = 0";
    let by_sine = "x'' + 2*zeta*x' + x + eps*x^3 = F*sin(Omega*t)";
    let pendulum = "x'' + x'/100 + sin(x) = cos(19*t/20)/50";
    let quadratic = "x'' + x'/20 + x + x^2/5 = cos(Omega*t)/5";
    for (equation, at, order, count, stable, error) in [
        (duffing, "zeta = 1/100, eps = 1/50, F = 1/20, Omega = 26/25", 1, 3, 2, 4e-2),
        (duffing, "zeta = 1/100, eps = 1/50, F = 1/20, Omega = 26/25", 2, 3, 2, 4e-3),
        (by_sine, "zeta = 1/200, eps = -1/100, F = 1/50, Omega = 247/250", 1, 1, 1, 1e-2),
        (duffing, "zeta = 1/1000, eps = 1/200, F = 1, Omega = 67/200", 1, 1, 1, 2e-2),
        (duffing, "zeta = 1/1000, eps = 1/200, F = 1, Omega = 67/200", 2, 1, 1, 2e-4),
        (duffing, "zeta = 1/2000, eps = 1/200, F = 10, Omega = 31/10", 1, 3, 2, 1e-2),
        (parametric, "zeta = 1/200, h = 1/20, eps = 1/100, Omega = 2", 1, 2, 1, 1e-3),
        (helmholtz, "zeta = 1/200, eps = 1/50, F = 1, Omega = 101/200", 1, 1, 1, 8e-2),
        // The wave comes an order before all that holds it.
        (quadratic, "Omega = 1/2", 2, 1, 1, 1e-2),
        (quadratic, "Omega = 12/25", 2, 1, 1, 3e-2),
        (quadratic, "Omega = 26/50", 2, 1, 1, 3e-2),
        (pendulum, "", 2, 3, 2, 4e-2),
        (pendulum, "", 4, 3, 2, 1e-2),
    ] {
        let oscillator = Oscillator::parse(equation).expect("an oscillator");
        let at: Values = at.parse().expect("values");
        let asked = lindstedt::method::with_resonance_at(&oscillator, &options(order), &at)
            .expect(equation);
        let solution = solve(&oscillator, &asked).expect(equation);
        let judged = judge(&oscillator, &solution, &at, error).expect(equation);
        let states = &judged.steady_states;
        assert_eq!(states.len(), count, "{equation}: {states:?}");
        let found = states.iter().filter(|judged| judged.state.is_stable()).count();
        assert_eq!(found, stable, "{equation}: {states:?}");
        for state in states {
            assert_eq!(state.true_stable, Some(state.state.is_stable()), "{equation}: {state:?}");
            assert!(
                state.relative_error.is_none_or(|value| value.abs() < error),
                "{equation}: {state:?}"
            );
        }
        assert_eq!(judged.verdict, lindstedt::Verdict::Pass, "{equation}");
    }
}

/// Near the fold the search from the middle motion leads to the upper one; its own is the branch
/// that harmonic balance follows there.
#[test]
fn a_middle_motion_has_a_truth_of_its_own() {
    let equation = "x'' + x'/10 + x + x^3/10 - F*cos(Omega*t) = 0";
    let solution = driven(equation, (1, 1), 2);
    let oscillator = Oscillator::parse(equation).expect("an oscillator");
    for omega in ["1.19", "1.2", "1.21"] {
        let at: Values = format!("F = 0.3, Omega = {omega}").parse().expect("values");
        let verdict = judge(&oscillator, &solution, &at, 0.01).expect("a verdict");
        let mut judged: Vec<(f64, bool)> = verdict
            .steady_states
            .iter()
            .filter_map(|judged| judged.true_amplitude.zip(judged.true_stable))
            .collect();
        judged.sort_by(|one, other| one.0.total_cmp(&other.0));
        let middle: f64 = omega.parse().expect("a number");
        let range = [middle - 0.002, middle + 0.002];
        let question =
            ResponseRequest::new(equation, "Omega", range, "F = 0.3").expect("a question");
        let response = respond(&question).expect("a response");
        let mut followed: Vec<(f64, bool)> = response
            .branches
            .iter()
            .map(|branch| {
                let distance = |point: &SteadyMotion| (point.parameter - middle).abs();
                let points = branch.points.iter();
                let nearest = points.min_by(|one, other| distance(one).total_cmp(&distance(other)));
                let nearest = nearest.expect("a point");
                (nearest.amplitude, nearest.stable == Some(true))
            })
            .collect();
        followed.sort_by(|one, other| one.0.total_cmp(&other.0));
        assert_eq!((judged.len(), followed.len()), (3, 3), "{omega}: {judged:?} {followed:?}");
        for (one, other) in judged.iter().zip(&followed) {
            assert!(
                (one.0 - other.0).abs() < 0.03 && one.1 == other.1,
                "{omega}: {one:?} {other:?}"
            );
        }
    }
}

/// All that is small made smaller together: the error of the amplitude to order n vanishes with the
/// power n, and the table of `docs/multiple-scales.md` is what is computed.
#[test]
fn slopes_of_the_error_of_driven_motions() {
    let equation = "x'' + 2*zeta*x' + x + eps*x^3 = F*cos(Omega*t)";
    let oscillator = Oscillator::parse(equation).expect("an oscillator");
    let orders = [1, 2, 3].map(|order| driven(equation, (1, 1), order));
    let largest = |solution: &Solution, d: u32| {
        let at = format!("zeta = 1/{d}, eps = 1/{d}, F = 3/{d}, Omega = {}/{d}", d + 1);
        let judged =
            judge(&oscillator, solution, &at.parse().expect("values"), 0.1).expect("a verdict");
        let [state] = judged.steady_states.as_slice() else {
            panic!("{judged:?}");
        };
        (state.state.amplitude, state.relative_error.expect("an error"))
    };
    let page = include_str!("../../../docs/multiple-scales.md");
    let mut errors: Vec<[f64; 3]> = Vec::new();
    for line in page.lines().filter(|line| line.starts_with("| ") && line.ends_with(" % |")) {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let number =
            |index: usize| cells[index].trim_end_matches(" %").parse::<f64>().expect("a number");
        let d = cells[1].parse().expect("a whole number");
        let found = orders.each_ref().map(|solution| largest(solution, d));
        for (k, (amplitude, error)) in found.iter().enumerate() {
            assert!((amplitude - number(2 * k + 2)).abs() < 6e-5, "{line}: {amplitude}");
            let digits =
                cells[2 * k + 3].trim_end_matches(" %").split('.').nth(1).map_or(0, str::len);
            let last = 10.0_f64.powi(-i32::try_from(digits).expect("few digits"));
            assert!((100.0 * error - number(2 * k + 3)).abs() < 0.6 * last, "{line}: {error}");
        }
        errors.push(found.map(|(_, error)| error.abs()));
    }
    assert_eq!(errors.len(), 4);
    for pair in errors.windows(2) {
        for ((order, off), (before, after)) in
            [(1.0, 0.1), (2.0, 0.1), (3.0, 0.15)].iter().zip(pair[0].iter().zip(pair[1]))
        {
            let slope = (before / after).log2();
            assert!((slope - order).abs() < *off, "order {order}: {slope}");
        }
    }
}

/// The same at the other resonances of a cubic force, a drive far from resonance held as it is:
/// stable and unstable motions alike.
#[test]
fn slopes_of_the_error_at_every_resonance() {
    let forced = "x'' + 2*zeta*x' + x + eps*x^3 = F*cos(Omega*t)";
    let quadratic = "x'' + 2*zeta*x' + x + eps*x^2 = F*cos(Omega*t)";
    let parametric = "x'' + 2*zeta*x' + (1 + h*cos(Omega*t))*x + eps*x^3 = 0";
    let at = |values: &[(&str, f64)]| {
        values.iter().map(|(name, value)| format!("{name} = {value}")).collect::<Vec<_>>()
    };
    let superharmonic = |d: f64| {
        at(&[("zeta", 0.2 / d), ("eps", 1.0 / d), ("F", 1.0), ("Omega", (1.0 + 2.0 / d) / 3.0)])
    };
    let subharmonic =
        |d: f64| at(&[("zeta", 0.1 / d), ("eps", 1.0 / d), ("F", 10.0), ("Omega", 3.0 + 20.0 / d)]);
    let of_square = |d: f64| {
        at(&[("zeta", 0.1 / d), ("eps", 1.0 / d), ("F", 1.0), ("Omega", (1.0 + 0.3 / d) / 2.0)])
    };
    let principal = |d: f64| {
        at(&[("zeta", 0.1 / d), ("eps", 1.0 / d), ("h", 1.0 / d), ("Omega", 2.0 + 0.5 / d)])
    };
    type At<'a> = &'a dyn Fn(f64) -> Vec<String>;
    // Equation, resonance, values by d, the first d, how many motions swing.
    type Case<'a> = (&'a str, (u32, u32), At<'a>, f64, usize);
    let cases: [Case; 4] = [
        (forced, (1, 3), &superharmonic, 100.0, 1),
        (forced, (3, 1), &subharmonic, 200.0, 2),
        (quadratic, (1, 2), &of_square, 200.0, 1),
        (parametric, (2, 1), &principal, 20.0, 2),
    ];
    for (equation, resonance, at, d, count) in cases {
        let oscillator = Oscillator::parse(equation).expect(equation);
        for order in 1..=3 {
            let solution = driven(equation, resonance, order);
            let errors = [d, 2.0 * d].map(|d| {
                let values = at(d).join(", ").parse().expect("values");
                let judged = judge(&oscillator, &solution, &values, 0.1).expect(equation);
                let moving =
                    judged.steady_states.iter().filter(|judged| judged.state.amplitude > 0.0);
                let errors: Vec<f64> = moving
                    .map(|judged| {
                        assert_eq!(
                            judged.true_stable,
                            Some(judged.state.is_stable()),
                            "{equation} {judged:?}"
                        );
                        judged.relative_error.expect(equation).abs()
                    })
                    .collect();
                assert_eq!(errors.len(), count, "{equation} to order {order}: {judged:?}");
                errors
            });
            for (before, after) in errors[0].iter().zip(&errors[1]) {
                let slope = (before / after).log2();
                assert!(
                    slope > f64::from(order) - 0.2,
                    "{equation} at {resonance:?} to order {order}: {slope}, {errors:?}"
                );
            }
        }
    }
}

/// Where nothing drives, the slow equations of a driven motion are those of the free one, seen from
/// the drive: psi' = Omega - theta'.
#[test]
fn without_a_drive_the_motion_is_free() {
    let free = derive("x'' + 2*zeta*x' + x + eps*(x^2 + x^3) = 0", 3);
    let driven = driven("x'' + 2*zeta*x' + x + eps*(x^2 + x^3) = F*cos(Omega*t)", (1, 1), 3);
    let [free, driven] =
        [&free, &driven].map(|solution| solution.modulation.as_ref().expect("slow equations"));
    let still = |rate: &Expr| rate.substitute(Symbol::new("F"), &Expr::zero()).expect("a rate");
    let turning = &(&Expr::symbol("sigma") + &Expr::one()) - &still(&driven.phase_rate);
    for (one, other) in [
        (free.amplitude_rate.clone(), still(&driven.amplitude_rate)),
        (free.phase_rate.clone(), turning),
    ] {
        let difference = (&one - &other).expand().expect("short");
        assert!(difference.is_zero(), "{one} and {other}");
    }
}

/// What first order says nothing about is found by the second: the second tongue of Mathieu's
/// equation, whose edges are known (C. M. Bender, S. A. Orszag, *Advanced Mathematical Methods for
/// Scientists and Engineers*, McGraw-Hill 1978, section 11.4: delta = 1 - eps^2/12 and 1 + 5
/// eps^2/12), and the motions that a cubic force holds there.
#[test]
fn the_second_tongue_needs_the_second_order() {
    for method in [Method::MultipleScales, Method::Averaging] {
        let asked = Options { method: Some(method), resonance: Some((1, 1)), ..Options::default() };
        let mathieu = Oscillator::parse("x'' + (delta + eps*cos(t))*x = 0").expect("an oscillator");
        let solution = solve(&mathieu, &asked).expect("an answer");
        assert_eq!(solution.order, 2);
        let relation = solution.response.as_ref().and_then(|response| response.relation.as_ref());
        let relation = relation.expect("a relation");
        let value = |eps: f64, delta: f64| {
            let value_of = |name: Symbol| match name.name() {
                "eps" => Some(eps),
                "delta" => Some(delta),
                _ => None,
            };
            solution.evaluate(relation, &value_of).expect("a value")
        };
        for eps in [0.1, 0.05] {
            for part in [-1.0 / 12.0, 5.0 / 12.0] {
                let edge = 1.0 + part * eps * eps;
                let [below, above] =
                    [-1.0, 1.0].map(|side| value(eps, edge + side * 0.5 * eps.powi(3)));
                assert!(
                    below * above < 0.0,
                    "{method:?}, eps = {eps}: {below}, {above} beside {edge}"
                );
            }
        }
        let equation = "x'' + 2*zeta*x' + (1 + h*cos(Omega*t))*x + eps*x^3 = 0";
        let oscillator = Oscillator::parse(equation).expect("an oscillator");
        let solution = solve(&oscillator, &asked).expect("an answer");
        let error = |d: f64| {
            let square = d * d;
            let at = format!(
                "zeta = {}, h = {}, eps = {}, Omega = {}",
                0.0125 / square,
                1.0 / d,
                0.5 / square,
                1.0 + 0.025 / square
            );
            let judged = judge(&oscillator, &solution, &at.parse().expect("values"), 0.1)
                .expect("a verdict");
            let stable = judged.steady_states.iter().filter(|judged| judged.state.is_stable());
            let errors: Vec<f64> = stable.filter_map(|judged| judged.relative_error).collect();
            // x(t) and -x(t) both.
            assert_eq!(errors.len(), 2, "{judged:?}");
            errors[0].abs()
        };
        let slope = (error(10.0) / error(20.0)).log2();
        assert!((slope - 2.0).abs() < 0.1, "{method:?}: {slope}");
    }
}

#[test]
fn drives_that_are_refused_by_name() {
    let refused = |equation: &str| {
        let oscillator = Oscillator::parse(equation).expect("an oscillator");
        let options = Options { method: Some(Method::MultipleScales), ..Options::default() };
        solve(&oscillator, &options).expect_err("refused")
    };
    for (equation, term) in [
        ("x'' + x = cos(t)", "cos(t)"),
        ("x'' + t*x = 0", "t*x"),
        ("x'' + x = exp(-t)", "exp(-t)"),
        ("x'' + x + x^3 = cos(t)^2", "cos(t)^2"),
        ("x'' + x + x^3 = cos(2*t) + cos(sqrt(3)*t)", "cos(sqrt(3)*t)"),
    ] {
        let refusal = refused(equation);
        assert_eq!(refusal.term(), Some(term), "{equation}: {refusal}");
        assert!(refusal.help().is_some(), "{equation}");
    }
    // A cubic force knows no resonance 2:1 to first order; the refusal says which it knows.
    let oscillator = Oscillator::parse(FORCED_DUFFING).expect("an oscillator");
    let asked = Options { resonance: Some((2, 1)), ..options(1) };
    let others = vec![(1, 1), (3, 1), (1, 3)];
    let expected = Reason::NoResonance { asked: (2, 1), others }.to(Method::MultipleScales);
    assert_eq!(solve(&oscillator, &asked), Err(expected));
}

/// What is small may stand in the equation as one letter, as several or as numbers: the motions at
/// the same numbers are the same.
#[test]
fn a_motion_does_not_depend_on_how_the_small_terms_are_spelt() {
    let spellings = [
        ("x'' + 2*zeta*x' + x + eps*x^3 = F*cos(Omega*t)", "zeta = 1/50, eps = 1/10, F = 1/20"),
        ("x'' + 2*eps*mu*x' + x + eps*x^3 = eps*f*cos(Omega*t)", "mu = 1/5, eps = 1/10, f = 1/2"),
        ("x'' + 2*eps*mu*x' + x + eps*x^3 = F*cos(Omega*t)", "mu = 1/5, eps = 1/10, F = 1/20"),
        ("x'' + x'/25 + x + x^3/10 = cos(Omega*t)/20", ""),
    ];
    for order in [1, 2] {
        for omega in [0.98, 1.02, 1.06] {
            let states = spellings.map(|(equation, at)| {
                let values: Values = at.parse().unwrap_or_default();
                let value_of = |name: Symbol| match name.name() {
                    "Omega" => Some(omega),
                    _ => values.get(name),
                };
                // Numbers leave the amplitude to count, in which a cube is of the second order.
                let order = if at.is_empty() { 2 * order } else { order };
                driven(equation, (1, 1), order).steady_states(&value_of)
            });
            assert!(!states[0].is_empty());
            for (other, (equation, _)) in states.iter().zip(spellings) {
                assert_eq!(
                    states[0].len(),
                    other.len(),
                    "{equation}, order {order}, Omega = {omega}"
                );
                for (one, other) in states[0].iter().zip(other) {
                    let apart = (one.amplitude - other.amplitude)
                        .abs()
                        .max((one.phase - other.phase).abs());
                    assert!(
                        apart < 1e-9,
                        "{equation}, order {order}, Omega = {omega}: {one:?} and {other:?}"
                    );
                }
            }
        }
    }
}

/// The phase of a drive, and two waves of one frequency, are folded in: amplitudes do not know
/// where time begins, motions do.
#[test]
fn phases_of_a_drive() {
    for (equation, at, error, deviation) in [
        (
            "x'' + 2*zeta*x' + x + eps*x^3 = F*cos(Omega*t + phi)",
            "zeta = 1/50, eps = 1/20, F = 1/50, Omega = 101/100, phi = 1/2",
            2e-2,
            2e-2,
        ),
        (
            "x'' + 2*zeta*x' + x + eps*x^3 = F*sin(Omega*t - 2)",
            "zeta = 1/50, eps = 1/20, F = 1/50, Omega = 101/100",
            2e-2,
            2e-2,
        ),
        (
            "x'' + 2*zeta*x' + x + eps*x^3 = F*cos(Omega*t + phi) + F*sin(Omega*t)",
            "zeta = 1/50, eps = 1/20, F = 1/100, Omega = 101/100, phi = 1/2",
            2e-2,
            2e-2,
        ),
        (
            "x'' + 2*zeta*x' + x + eps*x^3 = F*cos(Omega*t + phi) + G*sin(Omega*t + phi)",
            "zeta = 1/1000, eps = 1/100, F = 3/5, G = 4/5, Omega = 67/200, phi = 2/5",
            1e-2,
            1e-2,
        ),
        (
            "x'' + 2*zeta*x' + (1 + h*cos(Omega*t + phi))*x + eps*x^3 = 0",
            "zeta = 1/200, h = 1/20, eps = 1/100, Omega = 2, phi = 1",
            2e-2,
            2e-2,
        ),
    ] {
        let oscillator = Oscillator::parse(equation).expect(equation);
        let at: Values = at.parse().expect("values");
        let asked =
            lindstedt::method::with_resonance_at(&oscillator, &options(1), &at).expect(equation);
        let judged = judge(&oscillator, &solve(&oscillator, &asked).expect(equation), &at, error)
            .expect(equation);
        assert_eq!(
            judged.verdict,
            lindstedt::Verdict::Pass,
            "{equation}: {:?}",
            judged.steady_states
        );
        assert!(
            judged.max_deviation.is_some_and(|size| size < deviation),
            "{equation}: {:?}",
            judged.max_deviation
        );
    }
}

/// A drive about an equilibrium that is not zero: a fraction, a letter's root, one that a drive in
/// a coefficient shakes directly.
#[test]
fn drives_about_an_equilibrium() {
    for (equation, about, at, tolerance) in [
        (
            "x'' + 2*zeta*x' - x + x^3 = F*cos(Omega*t)",
            Some("1"),
            "zeta = 1/50, F = 1/100, Omega = 7/5",
            1e-2,
        ),
        (
            "x'' + 2*zeta*x' + x + x^2/10 - 1 = F*cos(Omega*t)",
            None,
            "zeta = 1/50, F = 1/100, Omega = 11/10",
            1e-2,
        ),
        (
            "x'' + 2*zeta*x' + x - 1 + h*x*cos(Omega*t) = 0",
            None,
            "zeta = 1/50, h = 1/500, Omega = 101/100",
            2e-2,
        ),
    ] {
        let mut oscillator = Oscillator::parse(equation).expect(equation);
        if let Some(place) = about {
            oscillator = oscillator.about(parse_expression(place).expect(place));
        }
        let at: Values = at.parse().expect("values");
        let asked = lindstedt::Options { resonance: Some((1, 1)), ..lindstedt::Options::default() };
        let solution = solve(&oscillator, &asked).expect(equation);
        let judged = judge(&oscillator, &solution, &at, tolerance).expect(equation);
        assert_eq!(
            judged.verdict,
            lindstedt::Verdict::Pass,
            "{equation}: {:?}",
            judged.steady_states
        );
    }
}

/// The verdict on a steady motion measures the order of its error and what it leaves of the
/// equation, letters and numbers alike, a drive far from resonance, in a coefficient, about an
/// equilibrium that is not zero; in the amplitude the order counts its powers.
#[test]
fn verdicts_measure_the_order_of_steady_motions() {
    let forced = "x'' + 2*zeta*x' + x + eps*x^3 = F*cos(Omega*t)";
    for (equation, order, at, slope) in [
        (forced, 1, "zeta = 1/40, eps = 1/40, F = 3/40, Omega = 41/40", 1.0),
        (forced, 3, "zeta = 1/40, eps = 1/40, F = 3/40, Omega = 41/40", 3.0),
        (forced, 2, "zeta = 1/500, eps = 1/100, F = 1, Omega = 17/50", 2.0),
        ("x'' + x'/20 + x + x^3/40 = 3*cos(41*t/40)/40", 4, "", 4.0),
        ("x'' + x'/20 + x + x^3/40 = 3*cos(41*t/40)/40", 6, "", 6.0),
        (
            "x'' + 2*zeta*x' + (1 + h*cos(Omega*t))*x + eps*x^3 = 0",
            2,
            "zeta = 1/400, h = 1/40, eps = 1/40, Omega = 161/80",
            2.0,
        ),
        ("x'' + x'/50 + x + x^2/10 - 1 = cos(11*t/10)/200", 4, "", 4.0),
        // A pendulum whose support is shaken upwards, sideways, and far from resonance.
        ("x'' + x'/100 + (1 + cos(199*t/100)/20)*sin(x) = 0", 2, "", 2.0),
        ("x'' + x'/100 + (1 + cos(199*t/100)/20)*sin(x) = 0", 4, "", 4.0),
        ("x'' + x'/100 + (1 + cos(199*t/100)/20)*sin(x) = 0", 6, "", 6.0),
        ("x'' + x'/20 + sin(x) = cos(x)*cos(39*t/40)/40", 2, "", 2.0),
        ("x'' + x'/20 + sin(x) = cos(x)*cos(39*t/40)/40", 4, "", 4.0),
        ("x'' + x'/500 + sin(x) = cos(x)*cos(33*t/100)/5", 2, "", 2.0),
        ("x'' + x'/500 + sin(x) = cos(x)*cos(33*t/100)/5", 4, "", 4.0),
    ] {
        let oscillator = Oscillator::parse(equation).expect(equation);
        let at: Values = at.parse().unwrap_or_default();
        let asked = lindstedt::method::with_resonance_at(&oscillator, &options(order), &at)
            .expect(equation);
        let judged = judge(&oscillator, &solve(&oscillator, &asked).expect(equation), &at, 0.1)
            .expect(equation);
        let measured = judged.slope.expect(equation);
        assert!((measured - slope).abs() < 0.3, "{equation} to order {order}: {measured}");
        assert!(
            judged.residual.is_some_and(|residual| residual < 0.05),
            "{equation}: {:?}",
            judged.residual
        );
    }
}

/// A frequency far from every resonance has no formula of one.
#[test]
fn a_drive_far_from_resonance_is_refused() {
    let oscillator =
        Oscillator::parse("x'' + 2*zeta*x' + x + eps*x^3 = F*cos(Omega*t)").expect("an oscillator");
    let at: Values = "zeta = 1/100, eps = 1/20, F = 1, Omega = 7".parse().expect("values");
    let refusal =
        lindstedt::method::with_resonance_at(&oscillator, &options(1), &at).expect_err("far");
    assert!(refusal.to_string().contains("Omega : omega0 = 7 is far from 3:1"), "{refusal}");
    assert!(refusal.help().is_some_and(|help| help.to_string().contains("response")));
}

/// Driven motions are compared by the amplitude of their largest stable steady motion: both
/// methods, both orders.
#[test]
fn driven_motions_are_compared() {
    let compared = |equation: &str, at: &str| {
        let oscillator = Oscillator::parse(equation).expect(equation);
        let at: Values = at.parse().expect("values");
        let table =
            lindstedt::verify::comparison::compare(&oscillator, &at, None, 0.01).expect(equation);
        let rows = table.rows.iter();
        rows.map(|row| {
            (row.solution.method, row.solution.order, row.relative_error.expect("an error").abs())
        })
        .collect::<Vec<_>>()
    };
    let duffing = "x'' + 2*zeta*x' + x + eps*x^3 = F*cos(Omega*t)";
    let rows = compared(duffing, "zeta = 1/50, eps = 1/10, F = 3/50, Omega = 21/20");
    let kinds: Vec<_> = rows.iter().map(|row| (row.0, row.1)).collect();
    let expected = [
        (Method::Averaging, 1),
        (Method::Averaging, 2),
        (Method::MultipleScales, 1),
        (Method::MultipleScales, 2),
        (Method::MultipleScales, 3),
    ];
    assert_eq!(kinds, expected);
    assert!(rows[0].2 < 6e-3, "{rows:?}");
    assert!(rows[1].2 < rows[0].2 && rows[3].2 < rows[2].2 && rows[4].2 < rows[3].2, "{rows:?}");
    let friction = "x'' + 2*zeta*x' + alpha*sgn(x') + x = F*cos(Omega*t)";
    let rows = compared(friction, "zeta = 1/200, alpha = 1/200, F = 1/40, Omega = 201/200");
    assert!(
        matches!(rows.as_slice(), [(Method::Averaging, 1, error)] if *error < 5e-3),
        "{rows:?}"
    );
}

/// A wave that runs past drives as the two waves do of which it consists.
#[test]
fn a_wave_that_runs_past() {
    for (past, apart) in [
        (
            "x'' + 2*z*x' + x + c*x^3 = F*cos(Omega*t - k*x)",
            "x'' + 2*z*x' + x + c*x^3 = F*cos(k*x)*cos(Omega*t) + F*sin(k*x)*sin(Omega*t)",
        ),
        (
            "x'' + 2*z*x' + x + c*x^3 = F*sin(k*x + Omega*t)",
            "x'' + 2*z*x' + x + c*x^3 = F*cos(k*x)*sin(Omega*t) + F*sin(k*x)*cos(Omega*t)",
        ),
    ] {
        let [past, apart] = [past, apart].map(|equation| {
            let oscillator = Oscillator::parse(equation).expect(equation);
            let in_amplitude = Options { small: Some("A".to_owned()), ..options(2) };
            solve(&oscillator, &in_amplitude).expect(equation)
        });
        let rates = |solution: Solution| {
            let slow = solution.modulation.expect("slow equations");
            [slow.amplitude_rate.expand(), slow.phase_rate.expand()]
        };
        assert_eq!(rates(past), rates(apart));
    }
}
