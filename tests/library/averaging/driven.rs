//! Driven motions averaged: the rates of multiple scales, dry friction, steady motions of forces
//! without a series.

use std::f64::consts::PI;

use lindstedt::expr::Expr;
use lindstedt::method::{Options, solve};
use lindstedt::solution::{Method, Solution};
use lindstedt::verify::{Verdict, judge};
use lindstedt::{Oscillator, Symbol};

use super::same;

fn driven(equation: &str, method: Method, resonance: (u32, u32)) -> Solution {
    let options = Options {
        method: Some(method),
        order: Some(1),
        resonance: Some(resonance),
        ..Options::default()
    };
    solve(&Oscillator::parse(equation).expect(equation), &options).expect(equation)
}

/// Away from 1:1, and to second order, averaging has the rates of multiple scales, with the motion
/// to one order less: at every resonance that a polynomial has, the amplitudes of the true motion
/// to that order (Bogoliubov and Mitropolsky, chapter 3).
#[test]
fn driven_motions_of_second_order() {
    for (equation, resonance, at) in [
        (
            "x'' + 2*zeta*x' + x + eps*x^3 = F*cos(Omega*t)",
            (1, 1),
            "zeta = 1/80, eps = 1/80, F = 3/80, Omega = 81/80",
        ),
        (
            "x'' + 2*zeta*x' + x + eps*x^3 = F*cos(Omega*t)",
            (1, 3),
            "zeta = 1/500, eps = 1/100, F = 1, Omega = 17/50",
        ),
        (
            "x'' + 2*zeta*x' + x + eps*x^3 = F*cos(Omega*t)",
            (3, 1),
            "zeta = 1/2000, eps = 1/200, F = 10, Omega = 31/10",
        ),
        (
            "x'' + 2*zeta*x' + x + eps*x^2 = F*cos(Omega*t)",
            (1, 2),
            "zeta = 1/2000, eps = 1/200, F = 1, Omega = 2003/4000",
        ),
        (
            "x'' + 2*zeta*x' + (1 + h*cos(Omega*t))*x + eps*x^3 = 0",
            (2, 1),
            "zeta = 1/200, h = 1/20, eps = 1/20, Omega = 81/40",
        ),
        ("x'' + x'/40 + x + x^3/80 = 3*cos(81*t/80)/80", (1, 1), ""),
    ] {
        let oscillator = Oscillator::parse(equation).expect(equation);
        let at: lindstedt::Values = at.parse().unwrap_or_default();
        let errors = [1, 2].map(|order| {
            let options = Options {
                method: Some(Method::Averaging),
                order: Some(order),
                resonance: Some(resonance),
                ..Options::default()
            };
            let solution = solve(&oscillator, &options).expect(equation);
            let judged = judge(&oscillator, &solution, &at, 0.1).expect(equation);
            assert_eq!(judged.verdict, Verdict::Pass, "{equation}: {judged:?}");
            let scales = Options { method: Some(Method::MultipleScales), ..options };
            if !solution.small_parameter.name().contains("delta") {
                let scales = solve(&oscillator, &scales).expect(equation);
                let [own, other] = [&solution, &scales]
                    .map(|solution| solution.modulation.as_ref().expect("slow equations"));
                let same =
                    |one: &Expr, other: &Expr| (one - other).expand().expect(equation).is_zero();
                assert!(same(&own.amplitude_rate, &other.amplitude_rate), "{equation}");
                assert!(same(&own.phase_rate, &other.phase_rate), "{equation}");
            }
            judged.relative_error.expect(equation).abs()
        });
        assert!(errors[1] < errors[0] / 4.0, "{equation}: {errors:?}");
    }
}

/// Of polynomial forces both methods give the same first order.
#[test]
fn driven_motions_are_those_of_multiple_scales() {
    for (equation, resonance) in [
        ("x'' + c*x' + w^2*x + g*x^3 = F*cos(Omega*t)", (1, 1)),
        ("x'' + c*x' + w^2*x + g*x^3 = F*sin(Omega*t + phi)", (1, 1)),
        ("x'' + c*x' + w^2*x + g*x^3 = F*cos(Omega*t) + G*sin(Omega*t)", (1, 1)),
        ("x'' - mu*(1 - x^2)*x' + x + eps*x^3 = F*cos(Omega*t)", (1, 1)),
        ("x'' + c*x' + w^2*x + g*x^3 + h*x*cos(Omega*t) = 0", (2, 1)),
        ("x'' + c*x' + w^2*x + g*x'^3 + h*x'*sin(Omega*t) = 0", (2, 1)),
        ("x'' + c*x' + w^2*x + g*x^3 + h*x^2*cos(Omega*t) = 0", (3, 1)),
        ("x'' + c*x' + w^2*x + g*x^3 + h*x^3*cos(Omega*t) = 0", (2, 1)),
    ] {
        let [own, other] = [Method::Averaging, Method::MultipleScales]
            .map(|method| driven(equation, method, resonance));
        let [own_slow, other_slow] =
            [&own, &other].map(|solution| solution.modulation.as_ref().expect(equation));
        for (rate, expected) in [
            (&own_slow.amplitude_rate, &other_slow.amplitude_rate),
            (&own_slow.phase_rate, &other_slow.phase_rate),
        ] {
            assert!(
                (rate - expected).expand().expect(equation).is_zero(),
                "{equation}: {rate}, {expected}"
            );
        }
        let [own, other] =
            [&own, &other].map(|solution| solution.response.as_ref().expect(equation));
        assert_eq!(own.relation, other.relation, "{equation}");
    }
}

/// Nayfeh and Mook, section 4.1.1, with the friction of section 3.3.2; Den Hartog's least force.
#[test]
fn dry_friction_under_a_drive() {
    let equation = "x'' + 2*zeta*x' + alpha*sgn(x') + x = F*cos(Omega*t)";
    let solution = driven(equation, Method::Averaging, (1, 1));
    let slow = solution.modulation.as_ref().expect("slow equations");
    assert!(same(&slow.amplitude_rate, "-zeta*a - 2*alpha/pi + F/2*sin(psi)"));
    assert!(same(&slow.phase_rate, "sigma + F/(2*a)*cos(psi)"));
    let response = solution.response.as_ref().expect("a response");
    assert!(response.peak.as_ref().is_some_and(|peak| same(peak, "(F/2 - 2*alpha/pi)/zeta")));
    let notes: Vec<String> = solution.validity.iter().map(ToString::to_string).collect();
    assert!(notes.iter().any(|note| note.contains("F > 4*alpha/pi")), "{notes:?}");
    let states = |force: f64| {
        let values = [("zeta", 0.01), ("alpha", 0.1), ("F", force), ("Omega", 1.0)];
        let value_of =
            |name: Symbol| values.iter().find(|entry| entry.0 == name.name()).map(|entry| entry.1);
        let states = solution.steady_states(&value_of).into_iter();
        states.map(|state| state.amplitude > 0.0).collect::<Vec<bool>>()
    };
    // Below it there is rest alone, which is the truth where friction holds against the whole
    // force.
    assert_eq!([0.99, 1.01].map(|part| states(part * 0.4 / PI)), [vec![false], vec![true]]);
    let oscillator = Oscillator::parse(equation).expect(equation);
    let at = "zeta = 1/100, alpha = 1/10, F = 9/100, Omega = 1".parse().expect("values");
    let held = judge(&oscillator, &solution, &at, 0.01).expect("a verdict");
    assert_eq!(held.verdict, Verdict::Pass, "{:?}", held.steady_states);
}

/// J. P. Den Hartog, Trans. ASME 53 (1931): with r = Omega the motion that never stops has the
/// amplitude F sqrt(V^2 - (alpha/F)^2 H^2), V = 1/(1 - r^2), H = sin(pi/r)/(r (1 + cos(pi/r))). All
/// that is small halved, the error of first order halves.
#[test]
fn dry_friction_under_a_drive_is_den_hartogs() {
    let equation = "x'' + alpha*sgn(x') + x = F*cos(Omega*t)";
    let solution = driven(equation, Method::Averaging, (1, 1));
    let error = |size: f64| {
        let (alpha, force, r) = (0.16 * size, 0.8 * size, 1.0 + 0.4 * size);
        let values = [("alpha", alpha), ("F", force), ("Omega", r)];
        let value_of =
            |name: Symbol| values.iter().find(|entry| entry.0 == name.name()).map(|entry| entry.1);
        let states = solution.steady_states(&value_of);
        let [state] = states.as_slice() else { panic!("{states:?}") };
        assert!(state.is_stable());
        let (v, h) = (1.0 / (1.0 - r * r), (PI / r).sin() / (r * (1.0 + (PI / r).cos())));
        let exact = force * (v * v - (alpha / force * h).powi(2)).sqrt();
        (state.amplitude / exact - 1.0).abs()
    };
    let errors = [1.0 / 8.0, 1.0 / 16.0, 1.0 / 32.0].map(error);
    assert!(errors[0] < 0.05, "{errors:?}");
    for pair in errors.windows(2) {
        assert!(((pair[0] / pair[1]).log2() - 1.0).abs() < 0.1, "{errors:?}");
    }
}

/// Steady motions of forces with corners and of the paper's arctangent beside the true ones, found
/// by shooting.
#[test]
fn steady_motions_without_a_series_are_the_true_ones() {
    for (equation, at, error) in [
        (
            "x'' + 2*zeta*x' + alpha*sgn(x') + x = F*cos(Omega*t + phi)",
            "zeta = 1/200, alpha = 1/200, F = 1/40, Omega = 201/200, phi = 3/10",
            5e-3,
        ),
        (
            "x'' + 2*zeta*x' + mu*(2/pi)*atan(100*x') + sin(x) = F*cos(Omega*t)",
            "zeta = 1/100, mu = 1/100, F = 1/20, Omega = 19/20",
            5e-3,
        ),
        (
            "x'' + c*abs(x')*x' + x + k*x*abs(x) = F*cos(Omega*t)",
            "c = 1/20, k = 1/20, F = 1/20, Omega = 51/50",
            2e-2,
        ),
        (
            "x'' + 2*zeta*x' + alpha*sgn(x') + (1 + h*cos(Omega*t))*x + eps*x^3 = 0",
            "zeta = 1/100, alpha = 1/1000, h = 1/10, Omega = 2, eps = 1/20",
            5e-3,
        ),
    ] {
        let oscillator = Oscillator::parse(equation).expect(equation);
        let at = at.parse().expect(at);
        let options = lindstedt::method::with_resonance_at(&oscillator, &Options::default(), &at)
            .expect(equation);
        let solution = solve(&oscillator, &options).expect(equation);
        assert_eq!(solution.method, Method::Averaging, "{equation}");
        let judged = judge(&oscillator, &solution, &at, error).expect(equation);
        assert_eq!(judged.verdict, Verdict::Pass, "{equation}: {:?}", judged.steady_states);
        for state in &judged.steady_states {
            assert_eq!(state.true_stable, Some(state.state.is_stable()), "{equation}: {state:?}");
        }
    }
}

#[test]
fn drives_that_averaging_refuses_by_name() {
    for (equation, resonance, words) in [
        (
            "x'' + 2*zeta*x' + x + alpha*sgn(x') = F*cos(Omega*t)",
            Some((1, 3)),
            "at 1:3; it does at 1:1",
        ),
        ("x'' + 2*zeta*x' + x = F*cos(Omega*t) + G*cos(2*t)", None, "G*cos(2*t)"),
        ("x'' + 2*zeta*x' + x = F*exp(-t)", None, "F*exp(-t)"),
        ("x'' + 2*zeta*x' + x = h*abs(x)*cos(Omega*t)", None, "h*abs(x)*cos(Omega*t)"),
        ("x'' + x = cos(t)", None, "nothing damps or detunes"),
        ("x'' + x'/10 + x + x^3/10 = cos(7*t)", None, "far from 1:1"),
    ] {
        let options = Options { method: Some(Method::Averaging), resonance, ..Options::default() };
        let refusal =
            solve(&Oscillator::parse(equation).expect(equation), &options).expect_err(equation);
        assert!(refusal.to_string().contains(words), "{equation}: {refusal}");
        assert!(refusal.help().is_some(), "{equation}");
    }
}
