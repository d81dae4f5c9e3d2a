//! The judge and its ranges on forces that break what looks at points alone, compared with
//! independent truth.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

use lindstedt::Values;
use lindstedt::expr::Expr;
use lindstedt::method::{Options, solve};
use lindstedt::numeric::period::PeriodError;
use lindstedt::solution::{AmplitudeConvention, Method};
use lindstedt::verify::AmplitudeReach;
use lindstedt::verify::comparison::{Comparison, backbones, compare};
use lindstedt::verify::{Verdict, Verification, VerificationError, judge};
use lindstedt::{Oscillator, Symbol};

fn values(at: &[(&str, &str)]) -> Values {
    let mut values = Values::default();
    for (name, value) in at {
        values.insert(Symbol::new(name), value.parse().unwrap()).unwrap();
    }
    values
}

fn judged(equation: &str, method: Method, at: &[(&str, &str)]) -> Verification {
    let oscillator = Oscillator::parse(equation).unwrap();
    let options = Options { method: Some(method), ..Options::default() };
    let solution = solve(&oscillator, &options).unwrap();
    judge(&oscillator, &solution, &values(at), 0.01).unwrap()
}

fn compared(equation: &str, at: &[(&str, &str)]) -> Comparison {
    compare(&Oscillator::parse(equation).unwrap(), &values(at), None, 0.01).unwrap()
}

fn texts(verification: &Verification) -> String {
    let texts: Vec<&str> = verification.ranges.iter().map(|range| range.text.as_str()).collect();
    texts.join("\n")
}

/// The true frequency by the velocity Verlet scheme in steps far shorter than the bump is wide,
/// extrapolated to none (L. Verlet, Phys. Rev. 159 (1967) 98): nothing of this is shared with the
/// judge.
fn by_small_steps(force: impl Fn(f64) -> f64, start: f64, step: f64) -> f64 {
    let half_period = |h: f64| {
        let (mut t, mut x, mut v) = (0.0, start, 0.0);
        let mut a = -force(x);
        loop {
            let next = x + h * v + 0.5 * h * h * a;
            let next_a = -force(next);
            let next_v = v + 0.5 * h * (a + next_a);
            if t > 0.0 && next_v * start.signum() >= 0.0 {
                return t + h * v / (v - next_v);
            }
            (t, x, v, a) = (t + h, next, next_v, next_a);
        }
    };
    let (coarse, fine) = (half_period(step), half_period(0.5 * step));
    PI / (fine + (fine - coarse) / 3.0)
}

#[test]
fn narrow_places_of_the_force_are_seen() {
    type Case = (&'static str, fn(f64) -> f64, &'static str, f64);
    let cases: [Case; 5] = [
        (
            "x'' + x - 100000*(x + 1)*exp(-10000*(x + 1)^2) = 0",
            |x| x - 1e5 * (x + 1.0) * (-1e4 * (x + 1.0).powi(2)).exp(),
            "2",
            2.0,
        ),
        (
            "x'' + x + 200*exp(-10000*(x - 1)^2) = 0",
            |x| x + 200.0 * (-1e4 * (x - 1.0_f64).powi(2)).exp(),
            "3/2",
            1.5,
        ),
        (
            "x'' + x + 3/(1 + 1000000*(x - 1/2)^2) = 0",
            |x| x + 3.0 / (1.0 + 1e6 * (x - 0.5_f64).powi(2)),
            "1",
            1.0,
        ),
        (
            "x'' + x + tanh(2000*(x - 1/4)) + 1 = 0",
            |x| x + (2000.0 * (x - 0.25)).tanh() + 1.0,
            "-1",
            -1.0,
        ),
        (
            "x'' + x + 50*(x - 1/3)*H(x - 1/3) = 0",
            |x| x + 50.0 * (x - 1.0 / 3.0_f64).max(0.0),
            "-1",
            -1.0,
        ),
    ];
    for (equation, force, amplitude, start) in cases {
        let found = judged(equation, Method::Exact, &[("A", amplitude)]);
        let truth = by_small_steps(force, start, 1e-5);
        assert!(
            (found.true_frequency / truth - 1.0).abs() < 1e-6,
            "{equation}: {} {truth}",
            found.true_frequency
        );
    }
}

#[test]
fn a_barrier_is_judged_by_quadrature_between_its_corners() {
    // One half of the period on each side of x = 0.323: a pendulum, and a linear spring so stiff
    // that gravity is a constant.
    let linear =
        judged("x'' + sin(x) + 1e6*(x - 0.323)*H(x - 0.323) = 0", Method::Exact, &[("A", "-3/2")]);
    assert!((linear.true_frequency - 1.520_63).abs() < 1e-5, "{}", linear.true_frequency);
    assert!(
        linear.frequency.is_some() && !texts(&linear).contains("no amplitude"),
        "{}",
        texts(&linear)
    );
    let hertz =
        compared("x'' + sin(x) + 30406700*(x - 0.323)^(3/2)*H(x - 0.323) = 0", &[("A", "-3/2")]);
    let frequency = hertz.true_frequency.expect("a true frequency");
    assert!((frequency - 1.52).abs() < 2e-3, "{frequency}");
    for row in &hertz.rows {
        let everywhere = matches!(row.reach, Some(AmplitudeReach::Everywhere(_)));
        assert!(row.frequency.is_some() || !everywhere, "{}", row.solution.title());
    }
}

#[test]
fn the_unit_of_time_and_length_does_not_matter() {
    let reference = judged("x'' + sin(x) = 0", Method::LindstedtPoincare, &[("A", "3/2")]);
    for (equation, amplitude, rate, length) in [
        ("x'' + 1e14*sin(x) = 0", "3/2", 1e7, 1.0),
        ("x'' + 1e16*sin(x) = 0", "3/2", 1e8, 1.0),
        ("x'' + 1e-20*sin(x) = 0", "3/2", 1e-10, 1.0),
        ("x'' + 1e-12*sin(1e12*x) = 0", "3/2000000000000", 1.0, 1e-12),
        ("x'' + 1e18*sin(x/1000000) = 0", "1500000", 1e6, 1e6),
    ] {
        let found = judged(equation, Method::LindstedtPoincare, &[("A", amplitude)]);
        assert!(
            (found.true_frequency / rate / reference.true_frequency - 1.0).abs() < 1e-12,
            "{equation}"
        );
        assert!(
            (found.relative_error.unwrap() - reference.relative_error.unwrap()).abs() < 1e-12,
            "{equation}"
        );
        let deviation = found.max_deviation.unwrap() / reference.max_deviation.unwrap();
        assert!((deviation - 1.0).abs() < 1e-6, "{equation}: {deviation}");
        let edge = lindstedt::export::significant(std::f64::consts::PI * length, 6);
        assert!(
            texts(&found).contains(&format!("periodic for |A| < {edge}: the separatrix")),
            "{}",
            texts(&found)
        );
        let radius = lindstedt::export::significant(std::f64::consts::PI * length, 3);
        assert!(texts(&found).contains(&format!("|A| < about {radius}")), "{}", texts(&found));
        assert_eq!(found.ranges.len(), reference.ranges.len(), "{}", texts(&found));
    }
}

#[test]
fn the_radius_of_convergence_is_that_of_known_singularities() {
    // The series of a cubic force ends where the exact modulus does, A^2 = -c1/c3; that of a sine
    // at the separatrix.
    for (equation, radius) in [
        ("x'' + 2*x + x^3 = 0", 2.0_f64.sqrt()),
        ("x'' + x + x^3 = 0", 1.0),
        ("x'' + 3*sin(x) = 0", std::f64::consts::PI),
        ("x'' + exp(x) - 1 = 0", 2.398),
        ("x'' + 7*x + 1e-6*x^3 = 0", 7e6_f64.sqrt()),
    ] {
        let found = texts(&judged(equation, Method::LindstedtPoincare, &[("A", "1/2")]));
        let (_, rest) = found.split_once("|A| < about ").unwrap();
        let estimate: f64 = rest.split_once(':').unwrap().0.parse().unwrap();
        assert!((estimate / radius - 1.0).abs() < 0.005, "{equation}: {found}");
    }
    let found = judged(
        "x'' + 2*x + eps*x^3 = 0",
        Method::LindstedtPoincare,
        &[("A", "3"), ("eps", "1/10")],
    );
    assert!(texts(&found).contains("|eps| < about 0.222:"), "{}", texts(&found));
}

#[test]
fn the_range_ends_where_the_error_first_crosses_the_tolerance() {
    for (equation, amplitude) in [
        ("x'' + x - x^3/3600 + 2*x^3*exp(-x^2) = 0", "3/2"),
        ("x'' + x + x^3 = 0", "1/10"),
        ("x'' + sin(x) = 0", "1"),
        ("x'' + x + x^2 = 0", "-1/10"),
        ("x'' + x + 1/5*x^2 - x^3 = 0", "1/4"),
    ] {
        let table = compared(equation, &[("A", amplitude)]);
        let asked = table.at.get("A".into()).unwrap();
        let oscillator = Oscillator::parse(equation).unwrap();
        for row in &table.rows {
            let reach = row.reach.unwrap();
            let good = row.relative_error.is_some_and(|error| error.abs() <= 0.01);
            assert_eq!(
                !reach.leaves_out(asked),
                good,
                "{equation} {}: {reach:?}",
                row.solution.title()
            );
            let end = reach.end().unwrap_or(asked);
            // Every amplitude before the end is good, on a grid of its own.
            for k in 1..=24 {
                let size = 0.999 * end * f64::from(k) / 24.0;
                if size == 0.0 {
                    continue;
                }
                let mut at = Values::default();
                at.insert("A".into(), Expr::number(lindstedt::exact::from_f64(size).unwrap()))
                    .unwrap();
                let Ok(motion) = exact_frequency(&oscillator, size) else {
                    continue;
                };
                let law = lindstedt::method::numbers::frequency_squared_of(
                    &oscillator,
                    &row.solution,
                    &BTreeMap::from([("A".into(), size)]),
                );
                let error = law.map_or(f64::INFINITY, |law| law.sqrt() / motion - 1.0);
                assert!(
                    error.abs() <= 0.0101,
                    "{equation} {} at {size}: {error}",
                    row.solution.title()
                );
            }
        }
    }
}

/// omega of `x'' + x + x*x'^2 = 0`, whose velocity is `x'^2 = exp(A^2 - x^2) - 1`: the time over
/// the angle `x = A*sin(angle)` by the midpoint rule, which is exact to rounding for a periodic
/// integrand.
fn with_velocity_squared(amplitude: f64) -> f64 {
    const STEPS: u32 = 400;
    let step = std::f64::consts::FRAC_PI_2 / f64::from(STEPS);
    let time = |k: u32| {
        let distance = amplitude * ((f64::from(k) + 0.5) * step).cos();
        distance / (distance * distance).exp_m1().sqrt()
    };
    PI / (2.0 * step * (0..STEPS).map(time).sum::<f64>())
}

#[test]
fn what_velocities_add_has_its_range_and_its_backbone() {
    type Truth = dyn Fn(f64) -> f64;
    let cases: [(&str, &str, &Truth); 2] = [
        ("x'' + x + x*x'^2 = 0", "1", &with_velocity_squared),
        // P. M. Mathews and M. Lakshmanan, Q. Appl. Math. 32 (1974) 215: omega^2 = 1/(1 + k*A^2).
        ("(1 + x^2/2)*x'' - x*x'^2/2 + x = 0", "2/3", &|amplitude: f64| {
            (1.0 + 0.5 * amplitude * amplitude).sqrt().recip()
        }),
    ];
    for (equation, amplitude, truth) in cases {
        let oscillator = Oscillator::parse(equation).unwrap();
        let table = compared(equation, &[("A", amplitude)]);
        let (true_curve, _) = backbones(&oscillator, &table).unwrap();
        assert!(true_curve.points.len() > 100, "{equation}");
        for (amplitude, frequency) in &true_curve.points {
            let error = frequency / truth(*amplitude) - 1.0;
            assert!(error.abs() < 1e-9, "{equation} at {amplitude}: {error}");
        }
        let asked = table.at.get("A".into()).unwrap();
        for row in &table.rows {
            let (title, reach) = (row.solution.title(), row.reach.unwrap());
            assert_eq!(
                !reach.leaves_out(asked),
                row.verdict == Some(Verdict::Pass),
                "{equation} {title}"
            );
            let AmplitudeReach::UpTo(end) = reach else { continue };
            let (inside, outside) = (0.99 * end, 1.01 * end);
            let error = |size: f64| {
                let exact = Expr::number(lindstedt::exact::from_f64(size).unwrap());
                let mut at = Values::default();
                at.insert("A".into(), exact).unwrap();
                let table = compare(&oscillator, &at, None, 0.01).unwrap();
                let row = table.rows.iter().find(|row| row.solution.title() == title).unwrap();
                row.frequency.map_or(f64::INFINITY, |frequency| frequency / truth(size) - 1.0)
            };
            assert!(
                error(inside).abs() < 0.01 && error(outside).abs() > 0.01,
                "{equation} {title}: {end}"
            );
        }
    }
}

fn exact_frequency(
    oscillator: &Oscillator,
    amplitude: f64,
) -> Result<f64, lindstedt::numeric::period::PeriodError> {
    let force = lindstedt::expr::CompiledFunction::new(&oscillator.force, &["x".into()]).unwrap();
    let force = |x: f64| force.call(&[x]);
    let force = lindstedt::numeric::period::PiecewiseForce::smooth(&force);
    Ok(std::f64::consts::TAU
        / lindstedt::numeric::period::conservative_period(&force, 0.0, amplitude)?)
}

#[test]
fn the_sides_of_a_well_are_told_apart() {
    let text = |equation: &str, amplitude: &str| {
        texts(&judged(equation, Method::LindstedtPoincare, &[("A", amplitude)]))
    };
    let quadratic = text("x'' + x - x^2 = 0", "1/4");
    assert!(quadratic.contains("periodic for -0.5 < A < 1: the separatrix"), "{quadratic}");
    let other = text("x'' + x + x^2 = 0", "-1/4");
    assert!(other.contains("periodic for -1 < A < 0.5"), "{other}");
    assert!(other.contains("up to A = -0."), "{other}");
    let zero = text("x'' + x + x^2 = 0", "-9/10");
    assert!(!zero.contains("reaches zero at A = 0"), "{zero}");
}

#[test]
fn the_law_that_is_judged_is_named_and_the_other_has_its_own_error() {
    let oscillator = Oscillator::parse("x'' + x + eps*x^3 = 0").unwrap();
    let options = Options { order: Some(4), ..Options::default() };
    let solution = solve(&oscillator, &options).unwrap();
    let found = judge(&oscillator, &solution, &values(&[("A", "2"), ("eps", "1")]), 0.01).unwrap();
    // s = eps*A^2 = 4 in omega^2 = 1 + 3 s/4 - 3 s^2/128 + 9 s^3/512 - 1779 s^4/131072 and in its
    // root, term by term.
    let (squared, truth) =
        (1.0 + 3.0 - 0.375 + 1.125 - 1779.0 * 256.0 / 131_072.0, found.true_frequency);
    let series = 1.0 + 1.5 - 21.0 / 16.0 + 81.0 * 64.0 / 2048.0 - 6549.0 * 256.0 / 262_144.0;
    assert_eq!(found.judged_on, "omega^2");
    assert!((found.relative_error.unwrap() - (f64::sqrt(squared) / truth - 1.0)).abs() < 1e-12);
    assert!(
        (found.error_of_omega.unwrap() - (series / truth - 1.0)).abs() < 1e-12,
        "{:?}",
        found.error_of_omega
    );
}

#[test]
fn coefficients_of_many_digits_cost_no_more_than_short_ones() {
    // With exact fractions each of these took from ten seconds to minutes; the series behind the
    // ranges runs in rounded numbers.
    for (equation, radius) in [
        (
            "x'' + 0.731*x + 0.4173*x^2 + 0.9131*x^3 + 0.3137*x^4 + 0.1717*x^5 = 0",
            Some("about 0.7"),
        ),
        ("x'' + asin(sin(x)) = 0", None),
    ] {
        let found = texts(&judged(equation, Method::LindstedtPoincare, &[("A", "3/10")]));
        match radius {
            Some(radius) => assert!(found.contains(radius), "{found}"),
            None => assert!(!found.contains("converges"), "{found}"),
        }
    }
}

/// The period against a pole, `V(u) = k (log u + d/u)` with `u = d - x`, by the double exponential
/// rule in `log u` (H. Takahasi, M. Mori, Publ. RIMS 9 (1974) 721), with the distances from both
/// turning points exact.
fn against_a_pole(k: f64, d: f64, amplitude: f64) -> f64 {
    let far = d - amplitude;
    let level = |u: f64| u.ln() + d / u;
    // The near turning point: level(u) = level(far) below the equilibrium u = d.
    let (mut low, mut high) = (1e-9 * d, d);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if level(middle) > level(far) {
            low = middle;
        } else {
            high = middle;
        }
    }
    let length = (far / low).ln();
    let rule = |step: f64| -> f64 {
        let point = |j: i32| {
            let t = f64::from(j) * step;
            let (left, right) =
                (1.0 / (1.0 + (-PI * t.sinh()).exp()), 1.0 / (1.0 + (PI * t.sinh()).exp()));
            // From the nearer turning point.
            let (u, fallen) = if t < 0.0 {
                let growth = (length * left).exp_m1();
                (low * (1.0 + growth), growth * d / (low * (1.0 + growth)) - length * left)
            } else {
                let loss = -(-length * right).exp_m1();
                (far * (1.0 - loss), length * right - loss * d / (far * (1.0 - loss)))
            };
            length * PI * t.cosh() * left * right * u / (2.0 * k * fallen).sqrt()
        };
        step * (-(3.3 / step) as i32..=(3.3 / step) as i32).map(point).sum::<f64>()
    };
    let (coarse, fine) = (rule(0.02), rule(0.01));
    assert!((coarse / fine - 1.0).abs() < 1e-9, "{amplitude}: {coarse} {fine}");
    2.0 * fine
}

#[test]
fn a_motion_that_turns_close_to_a_pole_is_timed() {
    for amplitude in ["-3", "-40", "-3000", "-1110000", "-9e8", "9/10"] {
        let table = compared("x'' + 0.468*x/(0.962 - x)^2 = 0", &[("A", amplitude)]);
        let value: f64 = if amplitude == "9/10" { 0.9 } else { amplitude.parse().unwrap() };
        let start = if value < 0.0 {
            value
        } else {
            // The other turning point of the same motion is farther from the pole.
            let level = |u: f64| u.ln() + 0.962 / u;
            let (mut low, mut high) = (0.962, 1e9);
            for _ in 0..200 {
                let middle = 0.5 * (low + high);
                if level(middle) > level(0.962 - value) {
                    high = middle;
                } else {
                    low = middle;
                }
            }
            0.962 - low
        };
        let expected = std::f64::consts::TAU / against_a_pole(0.468, 0.962, start);
        let found = table.true_frequency.expect("a true frequency");
        assert!((found / expected - 1.0).abs() < 1e-8, "{amplitude}: {found} {expected}");
        let exact = table.rows.iter().find(|row| row.solution.method == Method::Exact).unwrap();
        let error = exact.relative_error.expect("a frequency");
        assert!(error.abs() < 1e-10, "{amplitude}: {error}");
    }
}

/// Whatever keeps the true motion from being known, every method has its row, and the reason is
/// said.
#[test]
fn a_table_without_a_true_motion_has_all_its_rows() {
    let table =
        compared("x'' - mu*(1 - x^2)*x' + x - eps*x^3 = 0", &[("mu", "1/10"), ("eps", "1")]);
    assert_eq!(table.true_frequency, None);
    let reason = table.reason.expect("a reason").to_string();
    assert!(reason.contains("the motion escapes"), "{reason}");
    let answered = table.rows.iter().map(|row| row.solution.method);
    let all: BTreeSet<Method> =
        answered.chain(table.refused.iter().map(|refused| refused.method)).collect();
    assert_eq!(all.len(), Method::ALL.len());
    assert!(table.rows.iter().all(|row| row.verdict.is_none() && row.relative_error.is_none()));
    let known = compared("x'' - mu*(1 - x^2)*x' + x = 0", &[("mu", "1/10")]);
    assert!(known.true_frequency.is_some() && known.reason.is_none());
    assert!(known.rows.iter().all(|row| row.verdict.is_some()));
}

/// The motion of one term does not pass a pole, however weak it is beside the rest of the force;
/// and it passes what only looks like one.
#[test]
fn a_weak_pole_is_still_a_pole() {
    for (equation, amplitude, pole) in [
        ("x'' + 0.386*(1/(91.7 - x) - 1/91.7) + x = 0", "43900000", true),
        ("x'' + x + 1/1000/(1 - x)^2 - 1/1000 = 0", "1e9", true),
        ("x'' + x + 1/(1e-8 + (x - 1)^2)/1000 - 1/1000/(1 + 1e-8) = 0", "1000", false),
        ("x'' + x + abs(x - 1)^(-1/2) - 1 = 0", "3", false),
    ] {
        let oscillator = Oscillator::parse(equation).unwrap();
        let options = Options { method: Some(Method::Hamiltonian), ..Options::default() };
        let solution = solve(&oscillator, &options).unwrap();
        let given = BTreeMap::from([(Symbol::new("A"), amplitude.parse().unwrap())]);
        let found = lindstedt::method::numbers::evaluate(&oscillator, &solution, &given);
        assert_eq!(found.is_err(), pole, "{equation}: {found:?}");
    }
}

/// A law in closed form has values where there is no motion, and terms beyond the range of doubles
/// where there is one.
#[test]
fn laws_have_numbers_where_there_is_a_motion_and_only_there() {
    let at = |equation: &str, method: Method, order: Option<u32>, amplitude: f64| {
        let oscillator = Oscillator::parse(equation).unwrap();
        let options = Options { method: Some(method), order, ..Options::default() };
        let solution = solve(&oscillator, &options).unwrap();
        let given = BTreeMap::from([(Symbol::new("A"), amplitude)]);
        lindstedt::method::numbers::evaluate(&oscillator, &solution, &given)
            .map(|found| found.frequency_squared)
    };
    // The potential falls for good beyond its last maximum.
    for (equation, amplitude) in [
        ("x'' + x + 1.31*x^3 - 0.575*x^5 = 0", 2.68),
        ("x'' + x - x^5 = 0", 1.5),
        ("x'' + 0.008*x - 0.0221*x^5 = 0", -3.86),
        ("x'' + x + x^2 = 0", 0.51),
    ] {
        let found = at(equation, Method::Exact, None, amplitude);
        assert!(
            matches!(&found, Err(reason) if reason.to_string().contains("no periodic motion")),
            "{equation}: {found:?}"
        );
        assert!(at(equation, Method::Exact, None, 0.1 * amplitude).is_ok(), "{equation}");
    }
    // omega^2 = f'(A/2) = 6/cosh(3 A/2)^2.
    for amplitude in [1.0, 20.0, 100.0] {
        let found = at("x'' + 2*tanh(3*x) = 0", Method::FrequencyFormula, None, amplitude).unwrap();
        let expected = 24.0 * (-3.0 * amplitude).exp() / (1.0 + (-3.0 * amplitude).exp()).powi(2);
        assert!((found / expected - 1.0).abs() < 1e-13, "{amplitude}: {found} {expected}");
    }
    // With e = exp(-c A) the period is 4 K(1 - m) sech, 1 - m = 4 e/(1 + e)^2 and K(m) = ln 4 -
    // ln(1 - m)/2 for tiny 1 - m.
    for amplitude in [20.0, 60.0, 150.0] {
        let found = at("x'' + 2*sinh(3*x) = 0", Method::Exact, None, amplitude).unwrap();
        let complete = 4.0_f64.ln() + 0.5 * (3.0 * amplitude - 4.0_f64.ln());
        let logarithm =
            (6.0_f64.sqrt() * PI / 2.0).ln() + 1.5 * amplitude - 2.0_f64.ln() - complete.ln();
        assert!((0.5 * found.ln() / logarithm - 1.0).abs() < 1e-13, "{amplitude}: {found}");
    }
    // A law does not depend on the unit of length: with x = 1e-12 u the coefficients overflow in
    // its higher powers.
    let small = "x'' + 0.00678*x - 217e19*x^3 + 123e68*x^7 = 0";
    let plain = "x'' + 0.00678*x - 0.00217*x^3 + 0.0123*x^7 = 0";
    for method in [Method::IterationPerturbation, Method::HomotopyPerturbation] {
        for amplitude in [0.1, 0.615, 2.0] {
            let expected = at(plain, method, Some(2), amplitude).unwrap();
            let found = at(small, method, Some(2), 1e-12 * amplitude).unwrap();
            assert!((found / expected - 1.0).abs() < 1e-11, "{amplitude}: {found} {expected}");
        }
    }
}

/// A pole of the quotient before the amplitude asked for is the first crossing, however good the
/// quotient is beyond it: for x + b x^5 + x^7, omega^2 = 1 + 5 b A^4/8 + 35 A^6/64 + ..., and [2/1]
/// has its pole where A^2 = 8 b/7.
#[test]
fn a_pole_before_the_amplitude_ends_the_range() {
    for (b, amplitude) in [("0.0578", "2/5"), ("0.0578", "1/10"), ("0.05", "3/10")] {
        let pole = (8.0 * b.parse::<f64>().unwrap() / 7.0).sqrt();
        let table = compared(&format!("x'' + x + {b}*x^5 + x^7 = 0"), &[("A", amplitude)]);
        let row =
            table.rows.iter().find(|row| row.solution.method == Method::Pade).expect("a quotient");
        // 35 A^6/64 is a 6500th there: the error is 1 % within a hundredth of the pole.
        let end = row.reach.and_then(|reach| reach.end()).expect("a crossing");
        assert!((0.985 * pole..pole).contains(&end), "{end} {pole}");
        assert_eq!(row.verdict, Some(Verdict::Pass));
    }
}

/// x/(1 - x)^2 from -2: the true motion stays left of the pole, A cos(theta) runs through it.
#[test]
fn a_motion_of_one_term_through_a_pole_does_not_apply() {
    let table = compared("x'' + x/(1 - x)^2 = 0", &[("A", "-2")]);
    let expected = by_small_steps(|x| x / (1.0 - x).powi(2), -2.0, 1e-4);
    let truth = table.true_frequency.expect("a true motion");
    assert!((truth / expected - 1.0).abs() < 1e-6, "{truth} {expected}");
    let mut through = 0;
    for row in &table.rows {
        let one_term = row.solution.displacement.harmonics().iter().all(|entry| entry.0 <= 1);
        if one_term && row.solution.method != Method::Exact {
            let reason = row.reason.as_ref().map(ToString::to_string).unwrap_or_default();
            assert!(reason.contains("runs through x = 1"), "{}: {reason}", row.solution.title());
            assert!(row.frequency.is_none() && row.verdict != Some(Verdict::Pass));
            through += 1;
        }
    }
    assert!(through >= 3, "{through}");
}

/// Harmonic balance is on the branch that starts from rest: with more harmonics it comes to the
/// true frequency, its first harmonic is never nothing, and the frequency has no jumps along the
/// amplitude.
#[test]
fn harmonic_balance_follows_the_branch_from_rest() {
    type Force = fn(f64) -> f64;
    let quadratic: Force = |x| x + 5.0 * x * x + 10.0 * x.powi(3);
    let cases: [(&str, Force, &[f64], u32); 4] = [
        ("x'' + x + 5*x^2 + 10*x^3 = 0", quadratic, &[0.1, 0.7, 0.8, 0.9, 1.0], 10),
        ("x'' + x^3 - x^4 = 0", |x| x.powi(3) - x.powi(4), &[0.2], 8),
        ("x'' + x^3 - x^4 + x^5 = 0", |x| x.powi(3) - x.powi(4) + x.powi(5), &[0.5, 2.0], 10),
        ("x'' + x - 3*x^2 + 3*x^3 = 0", |x| x - 3.0 * x * x + 3.0 * x.powi(3), &[0.4, 1.5], 10),
    ];
    for (equation, force, amplitudes, order) in cases {
        let oscillator = Oscillator::parse(equation).unwrap();
        let solved = |order: u32, amplitude: f64| {
            let options = Options {
                method: Some(Method::HarmonicBalance),
                order: Some(order),
                ..Options::default()
            };
            let solution = solve(&oscillator, &options).unwrap();
            let at = BTreeMap::from([("A".into(), amplitude)]);
            lindstedt::method::numbers::evaluate(&oscillator, &solution, &at).unwrap()
        };
        for &amplitude in amplitudes {
            let found = solved(order, amplitude);
            let expected = by_small_steps(force, amplitude, 1e-4);
            let frequency = found.frequency_squared.sqrt();
            assert!(
                (frequency / expected - 1.0).abs() < 2e-3,
                "{equation} {amplitude}: {frequency} {expected}"
            );
            let motion = found.motion.expect("a motion");
            // The odd harmonics together.
            let first = 0.5 * (motion.evaluate(0.0) - motion.evaluate(std::f64::consts::PI));
            assert!(first.abs() > 0.5 * amplitude, "{equation} {amplitude}: {first}");
        }
    }
    let oscillator = Oscillator::parse("x'' + x + 5*x^2 + 10*x^3 = 0").unwrap();
    let solution = solve(
        &oscillator,
        &Options { method: Some(Method::HarmonicBalance), ..Options::default() },
    )
    .unwrap();
    let mut before = 1.0;
    for k in 1..=100 {
        let at = BTreeMap::from([("A".into(), 0.01 * f64::from(k))]);
        let law = lindstedt::method::numbers::evaluate(&oscillator, &solution, &at)
            .unwrap()
            .frequency_squared;
        assert!((law.sqrt() - before).abs() < 0.06, "{k}: {} {before}", law.sqrt());
        before = law.sqrt();
        if k == 80 {
            assert!((before - 2.6597).abs() < 1e-3, "{before}");
        }
    }
}

/// Over the top of a pendulum beside a barrier: 1 - cos(A) + 2 gamma (A - xc)^(5/2)/5 > 2, and
/// nothing turns it back.
#[test]
fn a_pendulum_that_goes_over_the_top_is_said_not_to_come_back() {
    let equation = "x'' + sin(x) + gamma*(x - xc)^(3/2)*H(x - xc) = 0";
    let oscillator = Oscillator::parse(equation).expect(equation);
    let solution = solve(&oscillator, &Options::default()).expect(equation);
    let at = |amplitude: &str| {
        format!("gamma = 100, xc = 3/10, A = {amplitude}").parse().expect("values")
    };
    let refused = judge(&oscillator, &solution, &at("1"), 0.01).expect_err("it does not come back");
    let escapes = matches!(refused, VerificationError::Period(PeriodError::Escapes { .. }));
    assert!(escapes, "{refused}");
    assert!(judge(&oscillator, &solution, &at("1/2"), 0.01).is_ok());
}

/// A law that is off near rest and good further out has a range about the amplitude, and the
/// verdict changes at its ends.
#[test]
fn a_law_that_is_off_near_rest_has_a_range_further_out() {
    for equation in ["x'' + sgn(x) + x^3 = 0", "x'' + x + sgn(x)/2 = 0"] {
        let oscillator = Oscillator::parse(equation).expect(equation);
        let solution = solve(&oscillator, &Options::default()).expect(equation);
        let at = |amplitude: f64| {
            judge(&oscillator, &solution, &values(&[("A", &amplitude.to_string())]), 0.01)
                .expect(equation)
        };
        let asked = at(1.0);
        let range =
            asked.ranges.iter().find(|range| range.text.starts_with("within")).expect("a range");
        let ends: Vec<f64> = range
            .text
            .split(" = ")
            .skip(1)
            .filter_map(|rest| rest.split([' ', ',']).next()?.parse().ok())
            .collect();
        assert!(asked.verdict == Verdict::Pass && !range.outside, "{equation}: {}", range.text);
        let passes = |amplitude: f64| at(amplitude).verdict == Verdict::Pass;
        assert!(passes(1.01 * ends[0]) && !passes(0.99 * ends[0]), "{equation}: {}", range.text);
        if !range.text.contains("looked at") {
            assert!(
                passes(0.99 * ends[1]) && !passes(1.01 * ends[1]),
                "{equation}: {}",
                range.text
            );
        }
    }
}

/// If the parameter that is small by default leaves a series nothing to expand in, the table has
/// the series in the amplitude.
#[test]
fn a_table_expands_in_the_amplitude_where_no_parameter_is_small() {
    for (equation, at) in [
        ("x'' + x + eps*x^3 + d*x^2 = 0", vec![("A", "1/5"), ("eps", "1/10"), ("d", "1/5")]),
        ("x'' + x + eps*x^3 + x^5 = 0", vec![("A", "1/5"), ("eps", "1/10")]),
        ("x'' + eps*x + x^3 = 0", vec![("A", "1/5"), ("eps", "1")]),
    ] {
        let table = compared(equation, &at);
        let mut rows = table.rows.iter();
        let row = rows.find(|row| row.solution.method == Method::LindstedtPoincare);
        let row = row.unwrap_or_else(|| panic!("{equation}: {:?}", table.refused));
        assert_eq!(row.solution.small_parameter, Symbol::new("A"), "{equation}");
        assert!(row.relative_error.is_some_and(|error| error.abs() < 1e-4), "{equation}");
    }
}

/// A law that names the equilibrium says what the name stands for, be it an integral.
#[test]
fn every_formula_of_a_table_has_its_definitions() {
    let table = compared("x'' + exp(x) - 2 = 0", &[("A", "3/10")]);
    for row in &table.rows {
        let formula = row.solution.formula();
        assert_eq!(
            formula.contains("x_e"),
            formula.contains(", x_e = 0.69314718055994"),
            "{formula}"
        );
        assert!(formula.len() < 2000, "{formula}");
    }
}

/// A verdict says all that it is reached on: the frequency, and how far the motion is off where
/// that is further; of a motion that decays the amplitude as well, which is judged with the
/// frequency.
#[test]
fn a_verdict_says_what_it_is_reached_on() {
    let words = |equation: &str, method: Method, at: &str| {
        let oscillator = Oscillator::parse(equation).expect(equation);
        let options = Options { method: Some(method), order: Some(1), ..Options::default() };
        let solution = solve(&oscillator, &options).expect(equation);
        let judged = judge(&oscillator, &solution, &at.parse().expect(at), 0.01).expect(equation);
        judged.verdict_in_words()
    };
    let balanced = words("x'' + x + x^3 = 0", Method::HarmonicBalance, "A = 1");
    assert_eq!(balanced, "pass: frequency within 1 %, motion off by 4.47 %");
    let decays = words("x'' + 2*zeta*x' + sin(x) = 0", Method::Averaging, "zeta = 1/100, A = 3/2");
    assert_eq!(decays, "fail: frequency within 1 %, amplitude off by 2.43 %");
    let dry = words("x'' + x + alpha*sgn(x') = 0", Method::Averaging, "alpha = 1/100, A = 1");
    assert_eq!(dry, "pass: frequency within 1 %, amplitude within 1 %");
    let small = words("x'' + x + x^3 = 0", Method::HarmonicBalance, "A = 1/10");
    assert_eq!(small, "pass (|relative error| <= 1 %)");
}

/// First harmonic of `A cn`: `A 2 pi/(k K) sqrt(q)/(1 + q)`, `q = exp(-pi K'/K)` (Abramowitz and
/// Stegun, 16.23.2); Duffing's motion has `k^2 = eps A^2/(2 (1 + eps A^2))`.
#[test]
fn an_amplitude_of_the_other_convention_is_converted() {
    let (amplitude, eps) = (1.5_f64, 0.5_f64);
    let m = eps * amplitude.powi(2) / (2.0 * (1.0 + eps * amplitude.powi(2)));
    let [quarter, other] = [m, 1.0 - m].map(|m| ellip::ellipk(m).expect("below one"));
    let q = (-std::f64::consts::PI * other / quarter).exp();
    let first = amplitude * std::f64::consts::TAU / (m.sqrt() * quarter) * q.sqrt() / (1.0 + q);
    let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0").expect("an equation");
    for (convention, given, wanted, expected) in [
        (AmplitudeConvention::FirstHarmonic, ("A", amplitude), "a", first),
        (AmplitudeConvention::Initial, ("a", first), "A", amplitude),
    ] {
        let options = Options { amplitude: Some(convention), ..Options::default() };
        let solution = solve(&duffing, &options).expect("a law");
        let at = values(&[("eps", "1/2"), (given.0, &given.1.to_string())]);
        let judged = judge(&duffing, &solution, &at, 0.05).expect("a verdict");
        let converted = judged.at.get(Symbol::new(wanted)).expect("the amplitude of the formula");
        assert!((converted / expected - 1.0).abs() < 1e-9, "{wanted}: {converted}, {expected}");
        let truth = std::f64::consts::FRAC_PI_2 * (1.0 + eps * amplitude.powi(2)).sqrt() / quarter;
        assert!((judged.true_frequency / truth - 1.0).abs() < 1e-9, "{}", judged.true_frequency);
        assert!(texts(&judged).contains("has the first harmonic a = "), "{}", texts(&judged));
    }
}

/// A verdict that is reached on two numbers says both in LaTeX too, in the words of the text.
#[test]
fn latex_says_what_a_verdict_is_reached_on() {
    for (equation, method, at) in [
        (
            "x'' + 2*zeta*x' + x + eps*x^3 = 0",
            Method::Averaging,
            vec![("A", "1"), ("zeta", "1/10"), ("eps", "1/5")],
        ),
        ("x'' + x^3 = 0", Method::HarmonicBalance, vec![("A", "1")]),
    ] {
        let oscillator = Oscillator::parse(equation).unwrap();
        let options = Options { method: Some(method), order: Some(1), ..Options::default() };
        let solution = solve(&oscillator, &options).unwrap();
        let found = judge(&oscillator, &solution, &values(&at), 0.03).unwrap();
        let words = found.verdict_in_words();
        let document = lindstedt::report::solution(&solution, Some(&found));
        let latex = lindstedt::export::latex::document(&document);
        let both = found.verdict_on_both().is_some();
        assert_eq!(latex.contains(&format!("verdict {words}\n")), both, "{words}: {latex}");
        assert!(both || latex.contains("verdict pass\n"), "{latex}");
    }
}

/// A formula is judged on the equation that it answers alone, whatever the other one is called.
#[test]
fn a_formula_of_another_equation_is_not_judged() {
    let duffing = Oscillator::parse("x'' + x + x^3 = 0").unwrap();
    let law = solve(&duffing, &Options::default()).unwrap();
    let at = values(&[("A", "1")]);
    for other in ["x'' + sin(x) = 0", "x'' + x + x^3 + x^5 = 0", "y'' + y + y^3 = 0"] {
        let error = judge(&Oscillator::parse(other).unwrap(), &law, &at, 0.01).unwrap_err();
        assert!(matches!(error, VerificationError::OtherEquation { .. }), "{other}: {error}");
    }
    // The same equation in another order and with a fraction written otherwise.
    let same = Oscillator::parse("2*x^3/2 + x'' = -x").unwrap();
    assert!(judge(&same, &law, &at, 0.01).is_ok());
}
