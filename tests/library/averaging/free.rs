//! Free motions averaged: projections, closed amplitudes and phases, decay, friction, limit cycles.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use lindstedt::expr::{CompiledFunction, Expr};
use lindstedt::method::{Options, solve};
use lindstedt::solution::{AmplitudeConvention, Degrees, Method};
use lindstedt::trajectory::TrajectoryRequest;
use lindstedt::verify::{Verdict, judge};
use lindstedt::{Oscillator, Symbol};

use super::{averaged, judged, same, slow};

#[test]
fn published_slow_equations() {
    for (equation, order, amplitude_rate, phase_rate) in [
        // Nayfeh and Mook, section 3.3.4 and, to second order, Bogoliubov and Mitropolsky,
        // section 1.3.
        (
            "x'' - mu*(1 - x^2)*x' + x = 0",
            2,
            "mu*a/2*(1 - a^2/4)",
            "1 - mu^2*(1/8 - a^2/8 + 7*a^4/256)",
        ),
        // Sections 3.3.1 to 3.3.3.
        ("x'' + 2*zeta*x' + k*x = 0", 1, "-zeta*a", "omega0"),
        ("x'' + x + alpha*sgn(x') = 0", 1, "-2*alpha/pi", "1"),
        ("x'' + x + c*abs(x')*x' = 0", 1, "-4*c*a^2/(3*pi)", "1"),
        // Section 2.3.1, and the exact frequency sqrt(1 - zeta^2) of a linear motion.
        ("x'' + x + eps*x^3 = 0", 2, "0", "1 + 3*eps*a^2/8 - 15*eps^2*a^4/256"),
        ("x'' + x + eps*x^2 = 0", 2, "0", "1 - 5*eps^2*a^2/12"),
        ("x'' + 2*zeta*x' + x = 0", 2, "-zeta*a", "1 - zeta^2/2"),
        // The pendulum, where the first harmonic of the sine is a Bessel function.
        ("x'' + 2*zeta*x' + sin(x) = 0", 1, "-zeta*a", "1/2 + J1(a)/a"),
        ("phi'' + 2*zeta*phi' + (g/L)*sin(phi) = 0", 1, "-zeta*a", "omega0/2 + omega0*J1(a)/a"),
        // What a letter is taken to be small for has to leave a restoring force.
        (
            "x'' + c*x' + k*sin(x) + m*x^3 = 0",
            1,
            "-c*a/2",
            "omega0/2 + omega0*J1(a)/a + 3*m*a^2/(8*omega0)",
        ),
    ] {
        let found = slow(equation, order);
        assert!(
            same(&found.amplitude_rate, amplitude_rate),
            "{equation}: {}",
            found.amplitude_rate
        );
        assert!(same(&found.phase_rate, phase_rate), "{equation}: {}", found.phase_rate);
    }
    // By the initial displacement it is the series of Lindstedt and Poincare.
    let options = Options {
        method: Some(Method::Averaging),
        order: Some(2),
        amplitude: Some(AmplitudeConvention::Initial),
        ..Options::default()
    };
    let oscillator = Oscillator::parse("x'' + x + eps*(x^2 + x^3) = 0").expect("an equation");
    let [one, other] = [Method::Averaging, Method::LindstedtPoincare].map(|method| {
        let options = Options { method: Some(method), ..options.clone() };
        solve(&oscillator, &options).expect("an answer")
    });
    assert_eq!(one.law.frequency(), other.law.frequency());
}

/// The rates of the first order are integrals over a period, here by the midpoint rule.
#[test]
fn projections_are_their_integrals() {
    const POINTS: usize = 200_000;
    for term in [
        "x'",
        "x^2*x'",
        "x'^3",
        "x*x'^2",
        "sgn(x')",
        "abs(x')*x'",
        "abs(x')^(1/2)*x'",
        "x'^(1/3)",
        "abs(x)*sgn(x')",
        "abs(x)*x'",
        "x^2*abs(x')*x'",
        "x*abs(x')",
        "x^3*abs(x')",
        "(2/pi)*atan(100*x')",
        "x^2*atan(3*x')",
        "x*x'*atan(3*x')",
        "sinh(x')",
        "cos(x)*x'",
        "H(x - 1/2)*x'",
        "sin(x)",
        "x*abs(x)",
        "(x - 1/2)*H(x - 1/2)",
    ] {
        let equation = format!("x'' + 9/4*x + eps*{term} = 0");
        let found = slow(&equation, 1);
        let force: Expr = term.parse().expect(term);
        let force = CompiledFunction::new(&force, &["x".into(), "x'".into()]).expect(term);
        let eps = BTreeMap::from([("eps".into(), Expr::one())]);
        let rate = |rate: &Expr| {
            CompiledFunction::new(&rate.substitute_all(&eps).expect(term), &["a".into()])
                .expect(term)
        };
        let (amplitude_rate, phase_rate) = (rate(&found.amplitude_rate), rate(&found.phase_rate));
        for a in [0.3, 0.8, 2.0] {
            let sum = |of: fn(f64) -> f64| -> f64 {
                let value = |k: usize| {
                    let psi = 2.0 * PI * (k as f64 + 0.5) / POINTS as f64;
                    force.call(&[a * psi.cos(), -1.5 * a * psi.sin()]) * of(psi)
                };
                2.0 * (0..POINTS).map(value).sum::<f64>() / POINTS as f64
            };
            let expected = [sum(f64::sin) / 3.0, 1.5 + sum(f64::cos) / (3.0 * a)];
            let values = [amplitude_rate.call(&[a]), phase_rate.call(&[a])];
            for (value, expected) in values.into_iter().zip(expected) {
                assert!((value - expected).abs() < 1e-5, "{term} at {a}: {value}, {expected}");
            }
        }
    }
}

/// `y = a^q` is linear in `exp(t)` or in `t`: put back into `y' = q a^(q-1) a'` nothing is left,
/// exactly.
#[test]
fn closed_amplitudes_solve_their_equations() {
    let (a, t) = (Symbol::new("a"), Symbol::new("t"));
    for (equation, q) in [
        ("x'' + 2*zeta*x' + x = 0", 1),
        ("x'' + x + alpha*sgn(x') = 0", 1),
        ("x'' + 2*zeta*x' + x + alpha*sgn(x') = 0", 1),
        ("x'' + x + c*abs(x')*x' = 0", -1),
        ("x'' + 2*zeta*x' + x + c*abs(x')*x' = 0", -1),
        ("x'' + x + c*x'^3 = 0", -2),
        ("x'' - mu*(1 - x^2)*x' + x = 0", -2),
        ("x'' - mu*(1 - x'^2/3)*x' + x = 0", -2),
        ("x'' - mu*(1 - x^4)*x' + x = 0", -4),
        ("x'' + x + c*x'^5 = 0", -4),
        ("x'' - x'/10 + x = 0", 1),
    ] {
        let slow = slow(equation, 1);
        let transient = slow.transient.as_ref().expect(equation);
        let y = Expr::power(&transient.amplitude, &Expr::from(q))
            .and_then(|y| y.expand())
            .expect(equation);
        // q a^(q-1) a' as a polynomial in y: every power of a there is 0 or q.
        let symbol = Expr::from(a);
        let slope =
            &Expr::from(q) * &symbol.integer_power(q - 1).expect("a power") * &slow.amplitude_rate;
        let slope = slope.expand().expect(equation);
        let power = symbol.integer_power(q).expect("a power");
        let mut in_y = Expr::zero();
        for term in slope.terms() {
            in_y = in_y
                + match term.contains(a) {
                    true => Expr::divide(term, &power).expect(equation) * &y,
                    false => term.clone(),
                };
        }
        assert!(!in_y.contains(a), "{equation}: {in_y}");
        let left = (y.differentiate(t).expect(equation) - in_y).expand().expect(equation);
        assert!(left.is_zero(), "{equation}: {left}");
        // It begins where it should.
        let start = transient.amplitude.substitute(t, &Expr::zero()).expect(equation);
        let start = Expr::power(&start, &Expr::from(q)).and_then(|y| y.expand()).expect(equation);
        assert!(same(&start, &format!("A^({q})")), "{equation}: {start}");
    }
}

/// Amplitude and phase in closed form, differentiated, are the slow equations.
#[test]
fn closed_phases_solve_their_equations() {
    let t = Symbol::new("t");
    for (equation, order) in [
        ("x'' + 2*zeta*x' + x + eps*x^3 = 0", 1),
        ("x'' + 2*zeta*x' + x + eps*x^3 = 0", 2),
        ("x'' + 2*zeta*x' + x + alpha*sgn(x') + eps*x^3 = 0", 1),
        ("x'' + x + c*abs(x')*x' + eps*x^3 = 0", 1),
        ("x'' + x + c*abs(x')*x' + alpha*sgn(x') = 0", 1),
        ("x'' + x + c*abs(x')*x' + 2*zeta*x' + eps*x*abs(x) = 0", 1),
        ("x'' - mu*(1 - x^2)*x' + x + eps*x^3 = 0", 1),
        ("x'' - mu*(1 - x^2)*x' + x = 0", 2),
        ("x'' + x + c*abs(x')^p*x' + eps*x^3 = 0", 1),
    ] {
        let solution = averaged(equation, order);
        let slow = solution.modulation.as_ref().expect(equation);
        let transient = slow.transient.as_ref().expect(equation);
        let phase = transient.phase.as_ref().expect(equation);
        let slopes = [&transient.amplitude, phase].map(|of| of.differentiate(t).expect(equation));
        let mut values = BTreeMap::from(
            [
                ("A", 0.7),
                ("zeta", 0.03),
                ("eps", 0.2),
                ("c", 0.15),
                ("alpha", 0.02),
                ("mu", 0.3),
                ("p", 0.75),
            ]
            .map(|(name, value)| (Symbol::new(name), value)),
        );
        let defined = solution.defined_values(&|name| values.get(&name).copied()).expect(equation);
        values.extend(defined);
        for time in [0.0, 0.5, 3.0, 11.0] {
            values.insert(t, time);
            let amplitude = transient.amplitude.evaluate(&values).expect(equation);
            values.insert("a".into(), amplitude);
            for (slope, rate) in slopes.iter().zip([&slow.amplitude_rate, &slow.phase_rate]) {
                let [slope, rate] =
                    [slope, rate].map(|value| value.evaluate(&values).expect(equation));
                assert!((slope - rate).abs() < 1e-12, "{equation} at {time}: {slope}, {rate}");
            }
        }
    }
}

/// The error of the frequency vanishes with one power of what is small more than the order.
#[test]
fn errors_vanish_as_the_order_says() {
    for (equation, at) in [
        ("x'' + 2*zeta*x' + x + eps*x^3 = 0", "zeta = 1/10 * D, eps = 2/5 * D, A = 1"),
        ("x'' - mu*(1 - x^2)*x' + x = 0", "mu = 2/5 * D, A = 1/2"),
        ("x'' + 2*zeta*x' + x + eps*x^2 + eps*x^3 = 0", "zeta = 1/10 * D, eps = 3/10 * D, A = 1"),
    ] {
        for (order, least) in [(1, 1.6), (2, 2.5)] {
            let errors = ["1/2", "1/4"].map(|size| {
                let verdict = judged(equation, order, &at.replace('D', size));
                verdict.relative_error.expect(equation).abs()
            });
            let slope = (errors[0] / errors[1]).log2();
            assert!(slope > least, "{equation} to order {order}: {slope}, {errors:?}");
        }
    }
}

/// The largest deviation over times of 1/small vanishes with the power of the order (Sanders,
/// Verhulst and Murdock, theorems 2.8.1 and 2.9.2), small letters and small numbers alike; what the
/// formula leaves of the equation is of the next order at order one.
#[test]
fn slopes_of_motions_from_a_start() {
    for (equation, order, at) in [
        ("x'' + x'/10 + x + x^3/10 = 0", 2, "A = 1"),
        ("x'' + c*abs(x')*x' + x = 0", 1, "c = 1/10, A = 1"),
        ("x'' + sgn(x')/50 + x + x*abs(x)/10 = 0", 1, "A = 1"),
    ] {
        let verdict = judged(equation, order, at);
        let slope = verdict.slope.expect(equation);
        assert!((slope - f64::from(order)).abs() < 0.15, "{equation} to order {order}: {slope}");
    }
    // x = A exp(-zeta t) cos(t) leaves zeta^2 x of x'' + 2 zeta x' + x.
    let residual = judged("x'' + 2*zeta*x' + x = 0", 1, "zeta = 1/100, A = 1").residual;
    assert!(residual.is_some_and(|residual| (residual / 1e-4 - 1.0).abs() < 1e-2), "{residual:?}");
}

#[test]
fn coulomb_friction_is_exact_at_every_turn() {
    let verdict = judged("x'' + x + alpha*sgn(x') = 0", 1, "alpha = 1/100, A = 1");
    let followed = verdict.followed.expect("followed");
    assert!(followed.amplitude_error.is_some_and(|error| error < 1e-9), "{followed:?}");
    assert_eq!(verdict.verdict, Verdict::Pass);
    // Where a size at the velocity has no power series, values alone are followed.
    let verdict = judged("x'' + x + c*abs(x')^p*x' = 0", 1, "c = 1/20, p = 1/2, A = 1");
    let followed = verdict.followed.expect("followed");
    assert!(followed.amplitude_error.is_some_and(|error| error < 1e-3), "{followed:?}");
}

/// The pendulum from 1.5 rad: by linear averaging log(10)/zeta, in truth and by its action sooner.
#[test]
fn a_pendulum_decays_by_its_action() {
    let verdict = judged("x'' + 2*zeta*x' + sin(x) = 0", 1, "zeta = 1/100, A = 3/2");
    let followed = verdict.followed.clone().expect("followed");
    let near = |value: Option<f64>, expected: f64| {
        value.is_some_and(|value| (value - expected).abs() < 5e-3)
    };
    assert!(near(followed.tenth, 230.2585), "{followed:?}");
    assert!(near(followed.true_tenth, 224.2246), "{followed:?}");
    assert!(near(followed.tenth_by_action, 224.2246), "{followed:?}");
    assert!(verdict.ranges.iter().any(|range| range.outside), "{verdict:?}");
    let solution = averaged("x'' + 2*zeta*x' + sin(x) = 0", 1);
    assert!(
        solution.validity.iter().any(|note| note.to_string().contains("J(A)*exp(-(2*zeta)*t)"))
    );
}

/// cos a_(n+1) - cos a_n = alpha (a_n + a_(n+1)), from one turn of the simulated pendulum to the
/// next.
#[test]
fn dry_friction_takes_its_work_from_turn_to_turn() {
    let equation = "x'' + sin(x) + alpha*sgn(x') = 0";
    let notes: Vec<String> =
        averaged(equation, 1).validity.iter().map(ToString::to_string).collect();
    assert!(
        notes.iter().any(|note| note.contains("cos(a_m) - cos(a_n) = alpha*(a_n + a_m)")),
        "{notes:?}"
    );
    let mut course =
        TrajectoryRequest::of_equation(&Oscillator::parse(equation).expect("an equation"));
    course.values.insert("alpha".into(), 0.02);
    course.duration = 60.0;
    course.tolerance = 1e-12;
    course.begin("x".into(), 1.5).expect("a state");
    let motion = course.follow().expect("a motion");
    let state = |t: f64| motion.states_at(t).expect("a state");
    let (mut turns, mut before) = (vec![1.5], 0.01);
    for k in 1..6000 {
        let t = f64::from(k) * 0.01;
        if state(before)[1] * state(t)[1] < 0.0 {
            let (mut low, mut high) = (before, t);
            for _ in 0..60 {
                let middle = (low + high) / 2.0;
                if state(low)[1] * state(middle)[1] <= 0.0 { high = middle } else { low = middle }
            }
            turns.push(state(low)[0].abs());
        }
        before = t;
    }
    assert!(turns.len() > 12, "{turns:?}");
    for pair in turns.windows(2) {
        let lost = pair[1].cos() - pair[0].cos();
        assert!((lost - 0.02 * (pair[0] + pair[1])).abs() < 1e-9, "{pair:?}");
    }
}

#[test]
fn amplitudes_that_stay_have_their_stability() {
    // Roots of 1 - z/4 + z^2/80: irrational, the smaller one attracts.
    let slow = slow("x'' - mu*(1 - x^2 + x^4/10)*x' + x = 0", 1);
    let amplitudes: Vec<f64> = slow
        .steady
        .iter()
        .map(|cycle| cycle.amplitude.evaluate(&BTreeMap::new()).expect("a number"))
        .collect();
    let expected = [10.0 - 20.0_f64.sqrt(), 10.0 + 20.0_f64.sqrt()].map(f64::sqrt);
    assert!(
        amplitudes.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-12),
        "{amplitudes:?}"
    );
    let stability: Vec<String> = slow.steady.iter().map(|cycle| cycle.stability()).collect();
    assert!(
        stability[0].starts_with("attracts for mu > 0")
            && stability[1].starts_with("attracts for mu < 0")
    );
    // Without a start the cycle is judged, with one the way to it.
    let at_cycle = judged("x'' - mu*(1 - x^2)*x' + x = 0", 2, "mu = 1/10");
    assert!(
        at_cycle.followed.is_none()
            && at_cycle.relative_error.is_some_and(|error| error.abs() < 1e-6)
    );
    let transient = judged("x'' - mu*(1 - x^2)*x' + x = 0", 2, "mu = 1/10, A = 1/2");
    assert!(transient.followed.is_some_and(|followed| followed.reason.contains("within 1 %")));
}

/// Past the radius of its series, about 1.85, the frequency of van der Pol's cycle is resummed, and
/// the judge says why.
#[test]
fn van_der_pol_beyond_the_radius_of_its_series() {
    let equation = "x'' - mu*(1 - x^2)*x' + x = 0";
    let oscillator = Oscillator::parse(equation).expect("an equation");
    let at = "mu = 2".parse().expect("a value");
    let series = Options { order: Some(8), ..Options::default() };
    let verdict = judge(&oscillator, &solve(&oscillator, &series).expect("a series"), &at, 0.01)
        .expect("a verdict");
    assert_eq!(verdict.verdict, Verdict::Fail);
    let said =
        verdict.ranges.iter().find(|range| range.text.contains("converges for |mu| < about 1.8"));
    assert!(
        said.is_some_and(|range| range.outside && range.text.contains("Pade")),
        "{:?}",
        verdict.ranges
    );
    let quotient = Options {
        method: Some(Method::Pade),
        degrees: Some(Degrees::Quotient(2, 2)),
        ..Options::default()
    };
    let verdict =
        judge(&oscillator, &solve(&oscillator, &quotient).expect("a quotient"), &at, 0.01)
            .expect("a verdict");
    assert!(verdict.relative_error.is_some_and(|error| error.abs() < 0.005), "{verdict:?}");
}

#[test]
fn damped_equations_are_averaged_by_default() {
    for (equation, order) in [
        ("x'' + 2*zeta*x' + sin(x) = 0", None),
        ("u'' + u + eps*u'*abs(u') = 0", None),
        ("u'' + u + eps*sgn(u') = 0", None),
        ("x'' - 0.1*x' + sin(x) = 0", None),
        ("x'' + 2*zeta*x' + x + eps*x^3 = 0", Some(4)),
    ] {
        let options = Options { order, ..Options::default() };
        let solution =
            solve(&Oscillator::parse(equation).expect(equation), &options).expect(equation);
        assert_eq!(solution.method, Method::Averaging, "{equation}");
        let notes: Vec<String> = solution.validity.iter().map(ToString::to_string).collect();
        assert_eq!(
            notes.iter().any(|note| note.contains("grows")),
            equation.contains("- 0.1"),
            "{notes:?}"
        );
        assert_eq!(
            notes.iter().any(|note| note.starts_with("order 4 was")),
            order.is_some(),
            "{notes:?}"
        );
    }
    for (equation, term) in
        [("u'' + u + eps*u' = 0", "eps*u'"), ("u'' + u + eps*sgn(u') = 0", "eps*sgn(u')")]
    {
        let options = Options { method: Some(Method::LindstedtPoincare), ..Options::default() };
        let refusal =
            solve(&Oscillator::parse(equation).expect(equation), &options).expect_err(equation);
        assert_eq!(refusal.term(), Some(term));
        assert!(refusal.help().is_some_and(|help| help.to_string().contains("averaging")));
    }
    let options = Options::default();
    let refusal =
        solve(&Oscillator::parse("x'' + x + tanh(x') = 0").expect("an equation"), &options);
    assert_eq!(refusal.expect_err("no closed form").term(), Some("tanh(x')"));
}

/// A force with the velocity in it restores where it does at rest; what is in the way is named with
/// the velocity in it.
#[test]
fn a_force_that_the_velocity_changes_is_named() {
    for (equation, method, term) in [
        ("x'' + x/sqrt(1 - x'^2) = 0", Method::Averaging, "x/sqrt(1 - x'^2)"),
        ("x'' + x*exp(x'^2) = 0", Method::Averaging, "x*exp(x'^2)"),
        ("x''*(1 + x'^2) + x = 0", Method::EnergyBalance, "x/(1 + x'^2)"),
        ("x'' + x/sqrt(1 - x'^2) = 0", Method::EnergyBalance, "x/sqrt(1 - x'^2)"),
    ] {
        let options = Options { method: Some(method), ..Options::default() };
        let refusal =
            solve(&Oscillator::parse(equation).expect(equation), &options).expect_err(equation);
        assert_eq!(refusal.term(), Some(term), "{refusal}");
    }
    // Its linear part is as small a difference as the polynomial says: x*(1 + x'^2)^2 = x +
    // 2*x*x'^2 + x*x'^4.
    assert_eq!(slow("x'' + x*(1 + x'^2)^2 = 0", 1).phase_rate.to_string(), "1 + a^2/4 + a^4/16");
}

/// The table of `docs/averaging.md` is what comes out.
#[test]
fn the_table_of_the_documentation_is_what_comes_out() {
    let page = include_str!("../../../docs/averaging.md");
    let rows: Vec<Vec<&str>> = page
        .lines()
        .filter(|line| line.starts_with("| `x''"))
        .map(|line| line.split('|').map(|cell| cell.trim().trim_matches('`')).collect())
        .filter(|row: &Vec<&str>| row.len() == 6)
        .collect();
    assert!(rows.len() >= 8, "{rows:?}");
    for row in rows {
        let [_, equation, order, amplitude_rate, phase_rate, _] = row.as_slice() else {
            panic!("{row:?}");
        };
        let slow = slow(&format!("{equation} = 0"), order.parse().expect("an order"));
        assert_eq!(slow.amplitude_rate.to_string(), *amplitude_rate, "{equation}");
        assert_eq!(slow.phase_rate.to_string(), *phase_rate, "{equation}");
    }
}

/// Dry friction takes the same from every half swing, so that the true time to a tenth is that of a
/// straight line.
#[test]
fn a_tenth_is_left_at_the_time_of_a_straight_line() {
    let oscillator = Oscillator::parse("x'' + alpha*sgn(x') + x = 0").expect("an oscillator");
    let solution = solve(&oscillator, &Options::default()).expect("an answer");
    let judged =
        judge(&oscillator, &solution, &"alpha = 1/25, A = 1".parse().expect("values"), 0.01)
            .expect("a verdict");
    let followed = judged.followed.expect("a motion that was followed");
    let (formula, truth) = (followed.tenth.expect("a time"), followed.true_tenth.expect("a time"));
    assert!((formula - 0.9 * std::f64::consts::PI / 0.08).abs() < 1e-9, "{formula}");
    assert!((truth - formula).abs() < 1e-6, "{truth} and {formula}");
}

/// The order 0 leaves damping out of sight, not out of the motion.
#[test]
fn a_damped_motion_has_no_law_of_order_nought() {
    for equation in ["x'' + 2*zeta*x' + x = 0", "x'' + alpha*sgn(x') + x = 0"] {
        let oscillator = Oscillator::parse(equation).expect("an oscillator");
        for method in [None, Some(Method::LindstedtPoincare)] {
            let options = Options { method, order: Some(0), ..Options::default() };
            assert!(solve(&oscillator, &options).is_err(), "{equation}, {method:?}");
        }
    }
    let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0").expect("an oscillator");
    let options = Options { order: Some(0), ..Options::default() };
    assert!(solve(&duffing, &options).is_ok());
}

/// A barrier at a letter does not act at rest; free and driven it is averaged like one at a number.
#[test]
fn a_barrier_at_a_letter() {
    for (equation, at) in [
        (
            "x'' + 2*zeta*x' + x + k*(x - xc)*H(x - xc) = 0",
            "zeta = 1/100, k = 1/10, xc = 1, A = 3/2",
        ),
        (
            "x'' + 2*zeta*x' + x + k*(x - xc)*H(x - xc) = F*cos(Omega*t)",
            "zeta = 1/50, k = 1/20, xc = 1, F = 1/20, Omega = 1",
        ),
    ] {
        let oscillator = Oscillator::parse(equation).expect(equation);
        let solution = solve(&oscillator, &Options::default()).expect(equation);
        assert_eq!(solution.method, Method::Averaging, "{equation}");
        let judged = judge(&oscillator, &solution, &at.parse().expect(at), 0.01).expect(equation);
        assert_eq!(judged.verdict, Verdict::Pass, "{equation}: {judged:?}");
    }
}

/// Nothing linear restores: the mean work of the damping along the true motion, here by the
/// midpoint rule over its energy, is the rate of the amplitude, and a viscous one is 2 c/(n + 3)
/// whatever the stiffness.
#[test]
fn a_force_of_one_power_is_averaged_along_its_motion() {
    for (equation, n, k, damping) in [
        ("x'' + 3*x^3 + c*x' = 0", 3.0, 3.0, [0.0, 1.0]),
        ("x'' + x*abs(x)/2 + c*x' = 0", 2.0, 0.5, [0.0, 1.0]),
        ("x'' + 2*sgn(x)*abs(x)^(1/2) + c*x' = 0", 0.5, 2.0, [0.0, 1.0]),
        ("x'' + x^5 + c*x'*abs(x') = 0", 5.0, 1.0, [0.0, 2.0]),
        ("x'' + 3*x^3 + c*sgn(x') = 0", 3.0, 3.0, [0.0, 0.0]),
        ("x'' + 3*x^3 + c*x^2*x'^3 = 0", 3.0, 3.0, [2.0, 3.0]),
        ("x'' + x^3 + c*abs(x')^(1/2)*sgn(x') = 0", 3.0, 1.0, [0.0, 0.5]),
    ] {
        let solution = averaged(equation, 1);
        let slow = solution.slow().expect(equation);
        let chi = solution.defined_values(&|_| Some(1.0)).expect(equation);
        let chi = chi.iter().find(|(name, _)| name.name() == "chi").expect("chi").1;
        let (r, c): (f64, f64) = (1.3, 0.1);
        // x = r sin(u): dx/v and |x|^p |v|^q dx are smooth in u.
        let (mut time, mut work) = (0.0, 0.0);
        const STEPS: usize = 200_000;
        for step in 0..STEPS {
            let u = PI / 2.0 * (step as f64 + 0.5) / STEPS as f64;
            let x = r * u.sin();
            let speed = (2.0 * k / (n + 1.0) * (r.powf(n + 1.0) - x.powf(n + 1.0))).sqrt();
            let dx = r * u.cos();
            time += dx / speed;
            work += c * x.powf(damping[0]) * speed.powf(damping[1]) * dx;
        }
        let expected = -chi * work / time / (k * r.powf(n));
        let numbers = [("a", chi * r), ("c", c), ("chi", chi)]
            .map(|(name, value)| (Symbol::new(name), value));
        let found = slow.amplitude_rate.evaluate(&numbers.into()).expect(equation);
        assert!((found / expected - 1.0).abs() < 1e-5, "{equation}: {found}, {expected}");
        if damping == [0.0, 1.0] {
            assert!((found / (-2.0 * c * chi * r / (n + 3.0)) - 1.0).abs() < 1e-14, "{equation}");
        }
        let frequency = slow.phase_rate.evaluate(&numbers.into()).expect(equation);
        let expected = PI / 2.0 / (time * PI / 2.0 / STEPS as f64);
        assert!((frequency / expected - 1.0).abs() < 1e-5, "{equation}: {frequency}, {expected}");
    }
}

/// The same against the true motion: over times of 1/small the error vanishes with its first power,
/// and what is fed comes to its cycle.
#[test]
fn motions_where_nothing_linear_restores() {
    for (equation, at) in [
        ("x'' + 0.05*x' + x^3 = 0", "A = 1"),
        ("x'' + c*x' + k*x*abs(x) = 0", "c = 1/50, k = 2, A = 1/2"),
        ("x'' + alpha*sgn(x') + x^3 = 0", "alpha = 1/200, A = 1"),
        ("x'' + c*x'*abs(x') + x^5 = 0", "c = 1/20, A = 1"),
    ] {
        let oscillator = Oscillator::parse(equation).expect(equation);
        let solution = solve(&oscillator, &Options::default()).expect(equation);
        assert_eq!(solution.method, Method::Averaging, "{equation}");
        let verdict = judge(&oscillator, &solution, &at.parse().expect(at), 0.02).expect(equation);
        assert_eq!(verdict.verdict, Verdict::Pass, "{equation}: {verdict:?}");
        let slope = verdict.slope.expect(equation);
        assert!((slope - 1.0).abs() < 0.15, "{equation}: {slope}");
    }
    let equation = "x'' + x^3 - mu*(1 - x^2)*x' = 0";
    let oscillator = Oscillator::parse(equation).expect(equation);
    let cycle = averaged(equation, 1).on_cycle().expect("a cycle");
    let verdict =
        judge(&oscillator, &cycle, &"mu = 1/50".parse().expect("values"), 0.001).expect(equation);
    assert_eq!(verdict.verdict, Verdict::Pass, "{verdict:?}");
}

/// Where nothing linear restores and something damps no method is named that refuses as well.
#[test]
fn no_help_leads_in_a_circle() {
    for method in [None, Some(Method::Averaging), Some(Method::MultipleScales)] {
        let options = Options { method, ..Options::default() };
        let refused = |equation: &str| {
            let refusal =
                solve(&Oscillator::parse(equation).expect(equation), &options).expect_err(equation);
            assert_eq!(refusal.term(), Some("0.1*x'"), "{refusal}");
            refusal.help().expect("help").to_string()
        };
        let help = refused("x'' + 0.1*x' + x^3 + x^5 = 0");
        assert!(help.contains("lindstedt simulate") && help.contains("exact"), "{help}");
        // One power alone is averaged, as whoever asked for another method is told.
        if method == Some(Method::MultipleScales) {
            let help = refused("x'' + 0.1*x' + x^3 = 0");
            assert!(help.contains("--method averaging") || help.contains("averaging"), "{help}");
        }
    }
    let undamped = Options { method: Some(Method::Exact), ..Options::default() };
    assert!(solve(&Oscillator::parse("x'' + x^3 = 0").expect("an equation"), &undamped).is_ok());
}

/// The tables of `docs/averaging.md` and `docs/multiple-scales.md` on motions from a start are what
/// comes out.
#[test]
fn deviations_residuals_and_slopes_of_the_documentation() {
    for (method, page) in [
        (Method::Averaging, include_str!("../../../docs/averaging.md")),
        (Method::MultipleScales, include_str!("../../../docs/multiple-scales.md")),
    ] {
        let lines = page.lines().filter(|line| line.starts_with("| `x''"));
        let rows: Vec<Vec<&str>> = lines
            .map(|line| line.split('|').map(|cell| cell.trim().trim_matches('`')).collect())
            .filter(|row: &Vec<&str>| row.len() == 8)
            .collect();
        assert_eq!(rows.len(), 3, "{rows:?}");
        for row in rows {
            let equation = format!("{} = 0", row[1]);
            let oscillator = Oscillator::parse(&equation).expect(row[1]);
            let options = Options {
                method: Some(method),
                order: Some(row[3].parse().expect("an order")),
                ..Options::default()
            };
            let solution = solve(&oscillator, &options).expect(row[1]);
            let judged =
                judge(&oscillator, &solution, &row[2].parse().expect(row[2]), 0.01).expect(row[1]);
            let percent = |value: Option<f64>| 100.0 * value.expect(row[1]);
            for (cell, found) in
                [(row[4], percent(judged.max_deviation)), (row[5], percent(judged.residual))]
            {
                let printed: f64 = cell.trim_end_matches(" %").parse().expect(cell);
                assert!((found / printed - 1.0).abs() < 5e-3, "{row:?}: {found}");
            }
            let slope: f64 = row[6].parse().expect(row[6]);
            assert!(
                (judged.slope.expect(row[1]) - slope).abs() < 0.02,
                "{row:?}: {:?}",
                judged.slope
            );
        }
    }
}
