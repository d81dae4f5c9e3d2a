//! Free motions by multiple scales: slow equations, the motion put back, errors that vanish as
//! their order says, decay from a start.

use lindstedt::exact::{POLYNOMIALS, Polynomial, ratio};
use lindstedt::expr::parse_expression;
use lindstedt::method::{Options, Reason, solve};
use lindstedt::series::FourierSeries;
use lindstedt::solution::Method;
use lindstedt::{Oscillator, Symbol, Values, judge};

use super::{derive, of_expression, of_text, options, slow};

#[test]
fn published_slow_equations() {
    for (equation, order, amplitude_rate, phase_rate) in [
        (
            "x'' + w^2*x + g*x^3 = 0",
            3,
            "0",
            "w + 3*g*a^2/(8*w) - 15*g^2*a^4/(256*w^3) + 123*g^3*a^6/(8192*w^5)",
        ),
        ("x'' + sin(x) = 0", 4, "0", "1 - a^2/16 + a^4/1024"),
        (
            "x'' - mu*(1 - x^2)*x' + x = 0",
            2,
            "mu*a/2 - mu*a^3/8",
            "1 - mu^2*(1/8 - a^2/8 + 7*a^4/256)",
        ),
        ("x'' + 2*zeta*x' + x = 0", 3, "-zeta*a", "1 - zeta^2/2"),
        ("x'' + 2*zeta*x' + x + eps*x^3 = 0", 1, "-zeta*a", "1 + 3*eps*a^2/8"),
        ("x'' + x + eps*x'^3 = 0", 1, "-3*eps*a^3/8", "1"),
        ("x'' + x + eps*x^2 = 0", 2, "0", "1 - 5*eps^2*a^2/12"),
    ] {
        let expected = [amplitude_rate, phase_rate].map(of_text);
        assert_eq!(slow(&derive(equation, order)), expected, "{equation}");
    }
}

/// The motion put back into its equation, by the algebra of series alone: time derivatives are
/// `a' d/da + psi' d/dtheta`.
#[test]
fn what_is_left_of_the_equation_is_of_the_next_order() {
    for (equation, small, order) in [
        ("x'' + x + eps*x^3 = 0", "eps", 3),
        ("x'' + x + eps*(alpha*x^2 + beta*x^3) = 0", "eps", 3),
        ("x'' + eps*x' + x + eps*x^3 + eps*x^2*x'^3 = 0", "eps", 3),
        ("x'' + x + eps*x^2 + eps^2*x'*x^2 + 3*eps^3*x^5 = 0", "eps", 3),
        ("x'' + x + eps*x*x'^2 - eps^2*x' = 0", "eps", 2),
        ("x'' + 4*x + eps*(1 + x)*x'^2 = 0", "eps", 3),
    ] {
        let solution = derive(equation, order);
        let [amplitude_rate, phase_rate] = slow(&solution);
        let (eps, a) = (Symbol::new(small), Symbol::new("a"));
        let cut = |series: FourierSeries<_>, highest: i32| {
            series
                .map(POLYNOMIALS, |coefficient: &Polynomial, _| coefficient.truncated(eps, highest))
        };
        let highest = order as i32;
        let constant =
            |polynomial: &Polynomial| FourierSeries::constant(POLYNOMIALS, polynomial.clone());
        let rate = |series: &FourierSeries<_>| {
            let slope = series.map(POLYNOMIALS, |coefficient: &Polynomial, _| coefficient.slope(a));
            let slow = slope.product(&constant(&amplitude_rate));
            cut(slow.sum(&series.derivative().product(&constant(&phase_rate))), highest)
        };
        let x = &solution.displacement;
        let velocity = rate(x);
        let acceleration = rate(&velocity);
        let residual = of_expression(&solution.equation.left);
        let names = ["x", "x'", "x''"].map(Symbol::new);
        let mut sum = FourierSeries::zero(POLYNOMIALS);
        for (monomial, number) in residual.terms() {
            let mut rest = monomial.clone();
            let mut term = FourierSeries::integer(POLYNOMIALS, 1);
            for (name, series) in names.iter().zip([x, &velocity, &acceleration]) {
                for _ in 0..monomial.exponent(*name) {
                    term = cut(term.product(series), highest);
                }
                rest = rest.without(*name);
            }
            sum = sum.sum(&cut(
                term.product(&constant(&Polynomial::term(rest, number.clone()))),
                highest,
            ));
        }
        assert!(sum.is_zero(), "{equation}: {:?}", sum.harmonics());
        // The next order is not zero: the test would see a mistake.
        assert!(!x.is_zero());
    }
}

/// The error of the frequency against the true one vanishes with the first missing power.
#[test]
fn slopes_of_the_error() {
    for (equation, order, at, slope) in [
        ("x'' + x + eps*x^3 = 0", 1, "eps = 1/5, a = 1", 2.0),
        ("x'' + x + eps*x^3 = 0", 2, "eps = 1/5, a = 1", 3.0),
        ("x'' + x + eps*x^3 = 0", 3, "eps = 1/5, a = 1", 4.0),
        ("x'' + x + eps*x^2 = 0", 3, "eps = 1/5, a = 1", 4.0),
        ("x'' + sin(x) = 0", 2, "a = 1/2", 4.0),
        ("x'' + sin(x) = 0", 4, "a = 1/2", 6.0),
        ("x'' + sin(x) = 0", 6, "a = 1", 8.0),
        ("x'' + x + eps*x*x'^2 = 0", 2, "eps = 1/5, a = 1", 3.0),
        ("x'' - mu*(1 - x^2)*x' + x = 0", 2, "mu = 3/10", 4.0),
        ("x'' - mu*(1 - x'^2/3)*x' + x = 0", 2, "mu = 3/10", 4.0),
    ] {
        let oscillator = Oscillator::parse(equation).expect("an oscillator");
        let solution = derive(equation, order);
        let at: Values = at.parse().expect("values");
        let judged = judge(&oscillator, &solution, &at, 0.01).expect("a verdict");
        let measured = judged.slope.expect("a slope");
        assert!((measured - slope).abs() < 0.1, "{equation} to order {order}: {measured}");
    }
}

#[test]
fn several_cycles_each_on_its_own() {
    // a' = -(eps/2) a (a^2 - 1)(a^2 - 4)/8 and so on: two cycles at 1 and 2 to leading order.
    let equation = "x'' + x + eps*x'*(4 - 5*(x^2 + x'^2) + (x^2 + x'^2)^2) = 0";
    let oscillator = Oscillator::parse(equation).expect("an oscillator");
    for (cycle, amplitude) in [(1, 1), (2, 2)] {
        let asked = Options { cycle: Some(cycle), ..options(2) };
        let solution = solve(&oscillator, &asked).expect("a limit cycle");
        let found = solution.limit_cycle.as_ref().expect("a limit cycle");
        let leading = found.amplitude.truncated(Symbol::new("eps"), 0);
        assert_eq!(leading, Polynomial::constant(ratio(amplitude, 1)));
        let judged = judge(&oscillator, &solution, &"eps = 1/100".parse().expect("values"), 0.01)
            .expect("a verdict");
        assert!(judged.relative_error.is_some_and(|error| error.abs() < 1e-6), "{judged:?}");
        assert!(judged.max_deviation.is_some_and(|deviation| deviation < 1e-3), "{judged:?}");
    }
}

/// In powers of the amplitude the rates are cut off: only terms of one order balance at an
/// amplitude that is small.
#[test]
fn only_terms_of_one_order_let_a_motion_stay() {
    for (equation, amplitude) in [
        // -zeta*a + 3*zeta*a^3/8: nothing feeds it, and it dies away.
        ("x'' + 2*zeta*x' + x + x^3 = 0", None),
        ("x'' + 2*zeta*x' + x - x^3 = 0", None),
        ("x'' + x'/10 + x + x^3 = 0", None),
        ("x'' + 2*zeta*x' + sin(x) = 0", None),
        // mu*a/2 - a^3/8 + mu*a^3/32: the cycle of van der Pol.
        ("x'' - mu*x' + x^2*x' + sin(x) = 0", Some("2*sqrt(mu)")),
        ("x'' + nu*x' - x'^3 + sin(x) = 0", Some("sqrt(4*nu/3)")),
    ] {
        let oscillator = Oscillator::parse(equation).unwrap();
        let solution = solve(&oscillator, &options(4)).unwrap();
        let modulation = solution.modulation.as_ref().unwrap();
        let stays: Vec<String> =
            modulation.steady.iter().map(|cycle| cycle.amplitude.to_string()).collect();
        assert_eq!(stays, Vec::from_iter(amplitude), "{equation}");
    }
}

#[test]
fn refusals_name_what_is_in_the_way() {
    let refused = |equation: &str, order| {
        let oscillator = Oscillator::parse(equation).expect("an oscillator");
        solve(&oscillator, &options(order)).expect_err("refused")
    };
    let highest = |highest| Reason::HighestOrder(highest).to(Method::MultipleScales);
    assert_eq!(refused("x'' + x + eps*x^3 = 0", 4), highest(3));
    assert_eq!(refused("x'' + sin(x) = 0", 7), highest(6));
    for (equation, term) in [
        ("x'' + x + eps*sgn(x') = 0", "eps*sgn(x')"),
        ("x'' + x + eps*abs(x)*x = 0", "eps*abs(x)*x"),
    ] {
        let refusal = refused(equation, 2);
        assert!(matches!(&refusal.reason, Reason::Oscillator(_)), "{equation}: {refusal}");
        assert_eq!(refusal.term(), Some(term), "{equation}: {refusal}");
    }
}

/// Both leave homogeneous solutions out, so that the slow equations of a damped motion are the
/// same.
#[test]
fn multiple_scales_are_averaging_where_both_apply() {
    for equation in [
        "x'' + 2*zeta*x' + x + eps*x^3 = 0",
        "x'' + x + eps*x'^3 = 0",
        "x'' + x + eps*(x^2 - 1)*x' + eps*x^5 = 0",
    ] {
        let oscillator = Oscillator::parse(equation).expect("an oscillator");
        let by = |method: Method| {
            let options = Options { method: Some(method), ..options(2) };
            let solution = solve(&oscillator, &options)
                .unwrap_or_else(|refusal| panic!("{equation}: {refusal}"));
            solution.modulation.expect("slow equations")
        };
        let [scales, averaging] = [Method::MultipleScales, Method::Averaging].map(by);
        for (one, other) in [
            (&scales.amplitude_rate, &averaging.amplitude_rate),
            (&scales.phase_rate, &averaging.phase_rate),
        ] {
            let difference = (one - other).expand().expect("short");
            assert!(difference.is_zero(), "{equation}: {one} and {other}");
        }
    }
}

/// A free motion that is damped has its rates in the answer, and its verdict is on the motion as it
/// decays.
#[test]
fn a_damped_motion_shows_how_it_decays() {
    let oscillator = Oscillator::parse("x'' + x + z*x'^3 = 0").expect("an oscillator");
    let asked = Options { method: Some(Method::MultipleScales), ..options(1) };
    let solution = solve(&oscillator, &asked).expect("an answer");
    let slow = solution.slow().expect("slow equations");
    let expected = parse_expression("-3*z*a^3/8").expect("an expression");
    assert!(
        (&slow.amplitude_rate - &expected).expand().expect("short").is_zero(),
        "{}",
        slow.amplitude_rate
    );
    let judged = judge(&oscillator, &solution, &"z = 1/20, A = 1".parse().expect("values"), 0.01)
        .expect("a verdict");
    assert!(judged.relative_error.is_some_and(|error| error.abs() < 1e-3), "{judged:?}");
}

/// From a start amplitude and phase are known in closed form: differentiated they are the slow
/// equations, and at the start the motion is at A, at rest, up to the order to which the slow
/// equations tell it.
#[test]
fn closed_forms_from_a_start() {
    let t = Symbol::new("t");
    for (equation, order) in [
        ("x'' + 2*zeta*x' + x + eps*x^3 = 0", 1),
        ("x'' + 2*zeta*x' + x + eps*x^3 = 0", 2),
        ("x'' + 2*zeta*x' + x = 0", 3),
        ("x'' + 2*zeta*x' + x + eps*(x^2 + x^3) = 0", 2),
        ("x'' - mu*(1 - x^2)*x' + x = 0", 1),
        ("x'' - mu*(1 - x^2)*x' + x = 0", 2),
        ("x'' - mu*(1 - x'^2/3)*x' + x + eps*x^3 = 0", 1),
        ("x'' + x + eps*x'^3 = 0", 2),
    ] {
        let solution = derive(equation, order);
        let solution = solution.off_cycle().unwrap_or(solution);
        let slow = solution.modulation.as_ref().expect(equation);
        let transient = slow.transient.as_ref().expect(equation);
        let phase = transient.phase.as_ref().expect(equation);
        let slopes = [&transient.amplitude, phase].map(|of| of.differentiate(t).expect(equation));
        let at_size = |size: f64| {
            let values =
                [("A", 0.7), ("zeta", 0.3 * size), ("eps", 0.8 * size), ("mu", 0.6 * size)];
            let mut values: std::collections::BTreeMap<_, _> =
                values.into_iter().map(|(name, value)| (Symbol::new(name), value)).collect();
            let defined = solution.defined_values(&|name| values.get(&name).copied());
            values.extend(defined.expect(equation));
            for time in [0.0, 0.5, 3.0, 11.0] {
                values.insert(t, time);
                let amplitude = transient.amplitude.evaluate(&values).expect(equation);
                values.insert("a".into(), amplitude);
                for (slope, rate) in slopes.iter().zip([&slow.amplitude_rate, &slow.phase_rate]) {
                    let [slope, rate] =
                        [slope, rate].map(|value| value.evaluate(&values).expect(equation));
                    assert!((slope - rate).abs() < 1e-11, "{equation} at {time}: {slope}, {rate}");
                }
            }
            values.insert(t, 0.0);
            let start = transient.amplitude.evaluate(&values).expect(equation);
            values.insert("a".into(), start);
            let theta = phase.evaluate(&values).expect(equation);
            let [rate, turning] = [&slow.amplitude_rate, &slow.phase_rate]
                .map(|rate| rate.evaluate(&values).expect(equation));
            let position = |a: f64, theta: f64| {
                let value_of = |name: Symbol| {
                    if name.name() == "a" { Some(a) } else { values.get(&name).copied() }
                };
                solution.motion(&value_of).expect("numbers").evaluate(theta)
            };
            let step = 1e-5;
            let by_amplitude =
                (position(start + step, theta) - position(start - step, theta)) / (2.0 * step);
            let by_phase =
                (position(start, theta + step) - position(start, theta - step)) / (2.0 * step);
            (position(start, theta) - 0.7).abs() + (by_amplitude * rate + by_phase * turning).abs()
        };
        let slope = (at_size(0.02) / at_size(0.01)).log2();
        assert!(slope > f64::from(order) - 0.1, "{equation} to order {order}: {slope}");
    }
}

/// Followed over times of 1/small, the error of order n vanishes with the power n: in a parameter,
/// and in the amplitude.
#[test]
fn slopes_of_motions_from_a_start() {
    for (equation, order, at) in [
        ("x'' + 2*zeta*x' + x + eps*x^3 = 0", 1, "zeta = 1/20, eps = 1/10, A = 1"),
        ("x'' + 2*zeta*x' + x + eps*x^3 = 0", 2, "zeta = 1/20, eps = 1/10, A = 1"),
        ("x'' + 2*zeta*x' + x + eps*x^3 = 0", 3, "zeta = 1/20, eps = 1/10, A = 1"),
        ("x'' - mu*(1 - x^2)*x' + x = 0", 3, "mu = 1/10, A = 1/2"),
        ("x'' + x'/50 + sin(x) = 0", 4, "A = 1/2"),
        // About 0.92, a root in numbers and one in letters.
        ("x'' + x'/50 + x + x^2/10 - 1 = 0", 4, "A = 1/5"),
        ("x'' + 2*zeta*x' + x + k*x^2 - 1 = 0", 4, "zeta = 1/100, k = 1/10, A = 1/5"),
    ] {
        let oscillator = Oscillator::parse(equation).expect("an oscillator");
        let at: Values = at.parse().expect("values");
        let judged = judge(&oscillator, &derive(equation, order), &at, 0.01).expect("a verdict");
        let slope = judged.slope.expect("a slope");
        let amplitude =
            judged.followed.and_then(|followed| followed.amplitude_slope).expect("a slope");
        assert!((slope - f64::from(order)).abs() < 0.1, "{equation} to order {order}: {slope}");
        assert!(amplitude > f64::from(order) - 0.1, "{equation} to order {order}: {amplitude}");
        assert!(
            judged.residual.is_some_and(|residual| residual < 0.02),
            "{equation}: {:?}",
            judged.residual
        );
    }
}

/// A viscous bubble: its damping is another at every radius, and its linear part counts as the
/// square of the amplitude.
#[test]
fn damping_that_changes_with_the_place() {
    let equation = "x*x'' + 3*x'^2/2 + 4*nu*x'/x - p*(x^(-3*k) - 1) = 0";
    let oscillator = Oscillator::parse(equation).expect("an oscillator");
    let solution = derive(equation, 4);
    let deviations =
        ["nu = 1/25, A = 1/5", "nu = 1/100, A = 1/10", "nu = 1/400, A = 1/20"].map(|at| {
            let at: Values = format!("{at}, p = 1, k = 7/5").parse().expect("values");
            let judged = judge(&oscillator, &solution, &at, 0.01).expect("a verdict");
            judged.max_deviation.expect("a deviation")
        });
    for pair in deviations.windows(2) {
        let slope = (pair[0] / pair[1]).log2();
        assert!((slope - 4.0).abs() < 0.2, "{slope}: {deviations:?}");
    }
}
