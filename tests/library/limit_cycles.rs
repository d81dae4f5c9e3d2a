//! Self-excited oscillators: amplitudes, stability and frequencies of limit cycles against an
//! independent truth.

use std::f64::consts::TAU;

use lindstedt::Values;
use lindstedt::exact::Polynomial;
use lindstedt::expr::parse_expression;
use lindstedt::method::{Options, Reason, Refusal, solve};
use lindstedt::solution::{Method, Solution};
use lindstedt::verify::{Verdict, Verification, judge};
use lindstedt::{Oscillator, Symbol};

fn derive(equation: &str, options: &Options) -> (Oscillator, Solution) {
    let oscillator = Oscillator::parse(equation).expect(equation);
    let solution =
        solve(&oscillator, options).unwrap_or_else(|refusal| panic!("{equation}: {refusal}"));
    (oscillator, solution)
}

fn polynomial(text: &str) -> Polynomial {
    let polynomial = parse_expression(text).unwrap().to_polynomial(&mut |_| None);
    polynomial.unwrap().expect(text)
}

fn judged((oscillator, solution): &(Oscillator, Solution), at: &[(&str, &str)]) -> Verification {
    let mut values = Values::default();
    for (name, value) in at {
        values.insert((*name).into(), parse_expression(value).unwrap()).unwrap();
    }
    judge(oscillator, solution, &values, 0.01)
        .unwrap_or_else(|error| panic!("{}: {error}", solution.equation))
}

/// A letter in one small term and a number before another: all of them are small together, and the
/// letter keeps its size.
#[test]
fn a_letter_beside_a_number_is_expanded_at_its_own_size() {
    for (equation, small, at) in [
        ("x'' - 0.1*(1 - x^2)*x' + x + b*x^3 = 0", None, ("b", "0.05")),
        ("x'' - 0.02*(1 - x^2)*x' + x + b*x^3 = 0", None, ("b", "-0.03")),
        ("x'' - 0.1*(1 - x^2)*x' + x + eps*x^3 = 0", Some("eps"), ("eps", "0.05")),
    ] {
        let options = Options { small: small.map(str::to_owned), ..Options::default() };
        // To second order omega = 1 + 3 b/2 + ..., from a truth that is no expansion.
        let verification = judged(&derive(equation, &options), &[at]);
        let error = verification.relative_error.expect("a frequency");
        assert!(error.abs() < 2e-3, "{equation}: {error}");
    }
}

/// However strongly the cycle of van der Pol's equation attracts or repels, the judge finds it.
#[test]
fn cycles_are_judged_at_any_strength() {
    let van_der_pol = derive("x'' - mu*(1 - x^2)*x' + x = 0", &Options::default());
    // Without mu every motion is periodic, and none attracts.
    assert!(judged(&van_der_pol, &[("mu", "0")]).ranges.is_empty());
    // Periods by Taylor series of order 30: the digits that step tolerances of 1e-12 and 1e-16 have
    // in common.
    for (mu, period) in [
        ("10", 19.078_369_566_94),
        ("20", 34.682_323_311_65),
        ("-20", 34.682_323_311_65),
        ("-3/10", 6.318_443_203_454),
    ] {
        let judged = judged(&van_der_pol, &[("mu", mu)]);
        let found = TAU / judged.true_frequency;
        assert!((found / period - 1.0).abs() < 1e-9, "mu = {mu}: {found}");
        // omega^2 = 1 - mu^2/8 is not positive at 10 and 20, and the verdict says so.
        assert_eq!(judged.verdict == Verdict::Pass, mu == "-3/10");
    }
}

/// A cycle in microseconds, or in years, is the cycle in seconds.
#[test]
fn the_unit_of_time_does_not_matter() {
    let cycle = |square: &str, rate: &str, at: &[(&str, &str)]| {
        let equation = format!("x'' + {square}*x - mu*{rate}*(1 - x^2)*x' = 0");
        judged(&derive(&equation, &Options::default()), at)
    };
    for mu in ["1/2", "-3", "8"] {
        let reference = cycle("1", "1", &[("mu", mu)]);
        for (square, rate, size) in
            [("1e18", "1e9", 1e9), ("1e-18", "1e-9", 1e-9), ("1e8", "1e4", 1e4)]
        {
            let found = cycle(square, rate, &[("mu", mu)]);
            let ratio = found.true_frequency / size / reference.true_frequency;
            assert!((ratio - 1.0).abs() < 1e-8, "mu = {mu}, {rate}: {ratio}");
            assert_eq!(found.relative_error.is_some(), reference.relative_error.is_some());
            assert_eq!(found.ranges, reference.ranges);
        }
    }
}

/// `int x' f_d(x, x') dtheta` over a harmonic motion of amplitude `a`: what the damping terms take
/// in one period, by quadrature.
fn work(damping: &dyn Fn(f64, f64) -> f64, a: f64, omega: f64) -> f64 {
    const POINTS: i32 = 64;
    let power = |k: i32| {
        let theta = TAU * f64::from(k) / f64::from(POINTS);
        let (x, v) = (a * theta.cos(), -a * omega * theta.sin());
        v * damping(x, v)
    };
    (0..POINTS).map(power).sum::<f64>() / f64::from(POINTS)
}

/// Every cycle is named, its work over a period balances, and it attracts where the work grows with
/// the amplitude.
#[test]
fn all_cycles_balance_and_attract_as_said() {
    type Damping = fn(f64, f64) -> f64;
    let cases: [(&str, Damping, f64, usize); 12] = [
        ("x'' - mu*(1 - x^2)*x' + x", |x, v| (x * x - 1.0) * v, 1.0, 1),
        ("x'' + mu*(1 - x^2)*x' + x", |x, v| (1.0 - x * x) * v, 1.0, 1),
        ("x'' - mu*(1 - x^4)*x' + x", |x, v| (x.powi(4) - 1.0) * v, 1.0, 1),
        ("x'' - mu*(1 - x^6)*x' + 4*x", |x, v| (x.powi(6) - 1.0) * v, 2.0, 1),
        ("x'' - mu*(x' - x'^5) + x", |_, v| v.powi(5) - v, 1.0, 1),
        ("x'' - mu*(1 - x^2 - x'^2)*x' + 2*x", |x, v| (x * x + v * v - 1.0) * v, 2f64.sqrt(), 1),
        (
            "x'' + mu*(x' - 3*x^2*x' + x^4*x') + x",
            |x, v| (1.0 - 3.0 * x * x + x.powi(4)) * v,
            1.0,
            2,
        ),
        (
            "x'' - mu*(-4 + 20*x^2 - 8*x^4)*x' + x",
            |x, v| (4.0 - 20.0 * x * x + 8.0 * x.powi(4)) * v,
            1.0,
            2,
        ),
        ("x'' - mu*(1 - x^2 + x^4/12)*x' + x", |x, v| (x * x - 1.0 - x.powi(4) / 12.0) * v, 1.0, 2),
        (
            "x'' - mu*(1 - x^2 + x^4/10 - x^6/700)*x' + x",
            |x, v| (x * x - 1.0 - x.powi(4) / 10.0 + x.powi(6) / 700.0) * v,
            1.0,
            3,
        ),
        ("x'' - mu*(x^2 - x^4)*x' + x", |x, v| (x.powi(4) - x * x) * v, 1.0, 1),
        ("x'' - mu*(1 - x^2/2)*x' + x + mu*x^2", |x, v| (0.5 * x * x - 1.0) * v, 1.0, 1),
    ];
    for (equation, damping, omega, count) in cases {
        let (_, solution) = derive(equation, &Options::default());
        let cycle = solution.limit_cycle.as_ref().expect(equation);
        assert_eq!(cycle.cycles.len(), count, "{equation}: {:?}", cycle.cycles);
        for leading in &cycle.cycles {
            let a = leading.amplitude.evaluate(&Default::default()).expect(equation);
            let [inside, here, outside] =
                [0.99, 1.0, 1.01].map(|part| work(&damping, part * a, omega));
            assert!(
                here.abs() < 1e-10 * (inside.abs() + outside.abs()),
                "{equation} at {a}: {here}"
            );
            let condition = leading.attracts_where.as_ref().expect(equation);
            let positive = condition.evaluate(&[("mu".into(), 1.0)].into()).expect(equation) > 0.0;
            assert_eq!(positive, inside < 0.0 && outside > 0.0, "{equation} at {a}: {condition}");
            assert!(positive || (inside > 0.0 && outside < 0.0), "{equation} at {a}");
        }
    }
}

/// Each cycle that can be asked for has the frequency of the true one: the error vanishes with the
/// next power.
#[test]
fn every_cycle_is_expanded_right() {
    let mut measured = 0;
    for (equation, count, mu) in [
        ("x'' - mu*(1 - x^4)*x' + x", 1, "1/5"),
        ("x'' - mu*(1 - x^6)*x' + 4*x", 1, "1/5"),
        ("x'' - mu*(1 - x^2 - x'^2)*x' + 2*x", 1, "1/2"),
        ("x'' + mu*(x' - 3*x^2*x' + x^4*x') + x", 2, "1/3"),
        ("x'' - mu*(1 - x^2 + x^4/12)*x' + x", 2, "1/8"),
        ("x'' - mu*(1 - x^2 + x^4/10 - x^6/700)*x' + x", 3, "1/50"),
        ("x'' - mu*(x^2 - x^4)*x' + x", 1, "1/5"),
    ] {
        for number in 1..=count {
            let options = Options { cycle: Some(number), ..Options::default() };
            let problem = derive(equation, &options);
            let cycle = problem.1.limit_cycle.as_ref().expect(equation);
            assert_eq!(cycle.number, number as usize);
            // Backward in the parameter the cycle is the same, and repels where it attracted.
            for sign in ["", "-"] {
                let verification = judged(&problem, &[("mu", &format!("{sign}{mu}"))]);
                assert_eq!(verification.verdict, Verdict::Pass, "{equation}, cycle {number}");
                // The slope is measured where the error stands well above that of Runge-Kutta,
                // 1e-8.
                let error = verification.relative_error.expect(equation).abs();
                let slope = verification.slope.filter(|_| error > 1e-6);
                assert!(slope.is_some() || error < 1e-6, "{equation}, cycle {number}: {error}");
                assert!(
                    slope.is_none_or(|slope| (slope - 4.0).abs() < 0.25),
                    "{equation}, cycle {number}: {slope:?}"
                );
                measured += usize::from(slope.is_some());
                let attracts = verification.ranges[0].text.ends_with("attracts");
                let condition =
                    cycle.cycles[number as usize - 1].attracts_where.as_ref().expect(equation);
                let positive =
                    condition.evaluate(&[("mu".into(), 1.0)].into()).expect(equation) > 0.0;
                assert_eq!(
                    attracts,
                    positive == sign.is_empty(),
                    "{equation}: {:?}",
                    verification.ranges
                );
            }
        }
        let beyond = Options { cycle: Some(count + 1), ..Options::default() };
        let refusal = solve(&Oscillator::parse(equation).unwrap(), &beyond).expect_err(equation);
        assert!(matches!(refusal.reason, Reason::NoSuchCycle(..)), "{refusal}");
    }
    // Most of them do.
    assert!(measured >= 12, "{measured} of 22");
}

/// Irrational roots are exact: the law of a cycle at sqrt(2) is that of the equation scaled so that
/// it lies at 1.
#[test]
fn an_irrational_amplitude_is_a_matter_of_units() {
    let derived = |equation: &str, order, number| {
        let options = Options { order: Some(order), cycle: Some(number), ..Options::default() };
        derive(equation, &options).1
    };
    // x = sqrt(2) y: 1 - 3 x^2 + x^4 = 1 - 6 y^2 + 4 y^4.
    let irrational = derived("x'' + mu*(x' - 3*x^2*x' + x^4*x') + x", 6, 1);
    let rational = derived("y'' + mu*(y' - 6*y^2*y' + 4*y^4*y') + y", 6, 1);
    assert_eq!(irrational.law, rational.law);
    // With two irrational squares the symbol stands for either root, and both laws come from one
    // polynomial in it.
    let value = |solution: &Solution| {
        let law = solution.law.frequency().expect("a law");
        let mu = |symbol: Symbol| (symbol.name() == "mu").then_some(0.05);
        solution.evaluate(law, &mu).expect("a number")
    };
    let [small, large] =
        [1, 2].map(|number| derived("x'' - mu*(1 - x^2 + x^4/10)*x' + x", 4, number));
    assert_eq!(small.law, large.law);
    assert!(value(&small) != value(&large));
}

/// Parameters of different terms that are small together, and numbers in place of a letter.
#[test]
fn what_is_small_together() {
    let both = derive("x'' - mu*(1 - x^2)*x' + x + eps*x^3 = 0", &Options::default());
    let law = both.1.law.frequency_squared().cloned().expect("a law");
    // eps = 0 leaves van der Pol; first order in eps is Duffing at the amplitude 2.
    let text = law.to_string();
    assert_eq!(law, polynomial("1 + 3*eps - 9*eps^2/8 - mu^2/8"), "{text}");
    assert!(both.1.title().ends_with("to order 2 in eps and mu"), "{}", both.1.title());
    let verification = judged(&both, &[("mu", "1/5"), ("eps", "1/10")]);
    assert_eq!(verification.verdict, Verdict::Pass);
    assert!((verification.slope.expect("a slope") - 3.0).abs() < 0.2, "{:?}", verification.slope);
    // The same with kappa = eps/mu in one parameter, which needs no joint expansion.
    let single = derive(
        "x'' - mu*(1 - x^2)*x' + x + kappa*mu*x^3 = 0",
        &Options { small: Some("mu".into()), ..Options::default() },
    );
    let eps = polynomial("kappa*mu");
    assert_eq!(law.substitute("eps".into(), &eps).as_ref(), single.1.law.frequency_squared());
    assert_eq!(single.1.limit_cycle.as_ref().map(|cycle| cycle.amplitude.clone()), {
        let amplitude = both.1.limit_cycle.as_ref().map(|cycle| cycle.amplitude.clone());
        amplitude.and_then(|amplitude| amplitude.substitute("eps".into(), &eps))
    });
    // Asked for the other way round, and with letters of one's own.
    for (equation, small) in [
        ("x'' - mu*(1 - x^2)*x' + x + eps*x^3 = 0", Some("mu")),
        ("x'' - b*(1 - x^2)*x' + x + c*x^3 = 0", None),
        ("x'' - b*x' + c*x^2*x' + x = 0", None),
    ] {
        let options = Options { small: small.map(str::to_owned), ..Options::default() };
        let (_, solution) = derive(equation, &options);
        assert_eq!(solution.limit_cycle.map(|cycle| cycle.small_with.len()), Some(1), "{equation}");
    }
}

#[test]
fn a_number_in_place_of_the_small_parameter() {
    let letter = derive("x'' - mu*(1 - x^2)*x' + x = 0", &Options::default());
    let expected = judged(&letter, &[("mu", "1/10")]);
    for (equation, value) in [
        ("x'' - 0.1*(1 - x^2)*x' + x = 0", "1/10"),
        ("x'' - (1 - x^2)*x' + x = 0", "1"),
        ("x'' - x'/10 + x^2*x'/10 + x = 0", "1/10"),
    ] {
        let problem = derive(equation, &Options::default());
        let solution = &problem.1;
        assert_eq!(solution.small_parameter.name(), "delta");
        assert_eq!(
            solution.law.frequency_squared(),
            Some(&polynomial("1 - delta^2/8")),
            "{equation}"
        );
        assert_eq!(
            solution.definitions.last().map(|it| it.meaning.to_string()),
            Some(value.to_owned())
        );
        let verification = judged(&problem, &[]);
        if value == "1/10" {
            assert_eq!(verification.frequency, expected.frequency);
            assert!((verification.true_frequency / expected.true_frequency - 1.0).abs() < 1e-10);
        }
        let slope = verification.slope.expect(equation);
        assert!((slope - 4.0).abs() < 0.2, "{equation}: {slope}");
    }
    // Without a linear damping term the force could be expanded in the amplitude, but that is not
    // free: z/4 = z^2/16.
    let problem = derive("x'' - 0.4*(x^2 - x^4/2)*x' + x = 0", &Options::default());
    let cycle = problem.1.limit_cycle.as_ref().expect("a limit cycle");
    assert_eq!(cycle.cycles[0].amplitude.to_string(), "2");
    let slope = judged(&problem, &[]).slope.expect("a slope");
    assert!((slope - 4.0).abs() < 0.2, "{slope}");
    // A parameter called delta is not touched.
    let (_, solution) = derive("x'' - 0.1*(1 - delta*x^2)*x' + x = 0", &Options::default());
    assert_eq!(solution.small_parameter.name(), "delta_");
}

/// Damping alone is still refused, and so is what is fed at every amplitude.
#[test]
fn without_a_balance_there_is_no_cycle() {
    let options = Options { method: Some(Method::LindstedtPoincare), ..Options::default() };
    let refused = |equation: &str| {
        solve(&Oscillator::parse(equation).unwrap(), &options).expect_err(equation)
    };
    for equation in ["x'' + 0.1*x' + x + x^3", "x'' - mu*x' + x", "x'' + 2*zeta*x' + x + eps*x^3"] {
        assert!(
            matches!(refused(equation), Refusal { reason: Reason::Damping { .. }, .. }),
            "{equation}: {}",
            refused(equation)
        );
    }
    for equation in ["x'' - mu*(1 - x^2/4 + x^4/80)*x' + x", "x'' + 0.1*x' + 0.2*x'^3 + x"] {
        assert!(
            matches!(refused(equation).reason, Reason::NoLimitCycle(_)),
            "{equation}: {}",
            refused(equation)
        );
    }
    // A double root is no start: 1 - z/2 + z^2/16 = (1 - z/4)^2.
    let refusal = refused("x'' - mu*(1 - 2*x^2 + x^4/2)*x' + x");
    assert!(refusal.to_string().contains("multiple root"), "{refusal}");
}

/// A verdict is not lost where there is nothing to draw: the result stands, and what is missing is
/// said.
#[test]
fn a_formula_without_a_motion_keeps_its_verdict() {
    let picture = std::env::temp_dir().join(format!("no-motion-{}.svg", std::process::id()));
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .args(["derive", "x'' - 10*(1 - x^2)*x' + x = 0", "--plot"])
        .arg(&picture)
        .output()
        .expect("the program runs");
    let [text, error] =
        [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).expect("text"));
    assert!(
        text.contains("omega               not real") && text.contains("verdict             fail"),
        "{text}"
    );
    assert!(
        error.starts_with("error: no picture: the formula has no real frequency there"),
        "{error}"
    );
    assert_eq!(output.status.code(), Some(1));
    assert!(!picture.exists());
}

/// Relaxation oscillations far beyond the reach of explicit steps, and of other equations with the
/// same jumps, in any units.
#[test]
fn relaxation_oscillations_are_judged_however_stiff() {
    let slow = 3.0 - 2.0 * 2.0_f64.ln();
    let van_der_pol = derive("x'' - mu*(1 - x^2)*x' + x = 0", &Options::default());
    for (mu, value) in [("1e3", 1e3), ("1e4", 1e4), ("1e5", 1e5)] {
        let verification = judged(&van_der_pol, &[("mu", mu)]);
        // ... + 3 alpha mu^(-1/3), less than its next term away: Dorodnitsyn.
        let period =
            slow * value + 3.0 * 2.338_107 / f64::cbrt(value) - 2.0 / 3.0 * f64::ln(value) / value;
        let found = TAU / verification.true_frequency;
        assert!((found / period - 1.0).abs() < 2e-6, "{mu}: {found} {period}");
        assert_eq!(verification.verdict, Verdict::Fail);
        assert!(verification.ranges.iter().any(|range| range.text.contains("and attracts")));
    }
    // Lengths of 1e-6 and times of 1e-3: x = 1e-6 X, t = 1e-3 T turns mu into 1e3 mu.
    let scaled = derive("x'' - mu*(1 - 1e12*x^2)*x' + 1e6*x = 0", &Options::default());
    let found = TAU / judged(&scaled, &[("mu", "1e6")]).true_frequency;
    let plain = TAU / judged(&van_der_pol, &[("mu", "1e3")]).true_frequency;
    assert!((found * 1e3 / plain - 1.0).abs() < 1e-8, "{found} {plain}");
}

/// Powers of which the algebra would not end are refused at once, those below are expanded.
#[test]
fn high_powers_end() {
    let (_, solution) = derive("x'' - mu*(1 - x^40)*x' + x = 0", &Options::default());
    // <x'^2 (1 - x^40)> = 0: a^40/4^20 C(40, 20)/21 = 1.
    let binomial = (1..=20).fold(1.0, |product, k| product * f64::from(20 + k) / f64::from(k));
    let amplitude = solution.limit_cycle.expect("a cycle").cycles[0].amplitude.evaluate(&[].into());
    let expected = 2.0 * (21.0 / binomial).powf(1.0 / 40.0);
    assert!((amplitude.expect("a number") / expected - 1.0).abs() < 1e-14);
    for equation in ["x'' - mu*(1 - x^1000)*x' + x = 0", "x'' + x + eps*x^999 = 0"] {
        let refusal =
            solve(&Oscillator::parse(equation).unwrap(), &Options::default()).expect_err(equation);
        assert!(refusal.to_string().contains("harmonics at this order"), "{refusal}");
    }
}

/// The amplitude at which the work of `s(x) x'` along `a cos` is none, by bisection: between the
/// edges of `s` it is `int sin^2`.
fn balanced_amplitude(share: &dyn Fn(f64) -> f64, edges: &[f64]) -> f64 {
    let work = |a: f64| -> f64 {
        let mut angles = vec![0.0, std::f64::consts::PI];
        angles.extend(edges.iter().map(|edge| (edge / a).acos()));
        angles.sort_by(f64::total_cmp);
        let integral = |angle: f64| 0.5 * angle - 0.25 * (2.0 * angle).sin();
        let piece = |pair: &[f64]| {
            share(a * (0.5 * (pair[0] + pair[1])).cos()) * (integral(pair[1]) - integral(pair[0]))
        };
        angles.windows(2).map(piece).sum()
    };
    let (mut low, mut high) = (1.001, 20.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if work(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// Damping that jumps with the position: averaged in closed form, its limit cycle found by numbers
/// and judged by the return map.
#[test]
fn damping_that_jumps_with_the_position_has_its_limit_cycle() {
    type Share = fn(f64) -> f64;
    type Case<'a> = (&'a str, &'a [(&'a str, &'a str)], Share, f64);
    let jump: Share = |x| if x.abs() < 1.0 { 1.0 } else { -1.0 };
    let cases: [Case; 5] = [
        ("x'' - mu*sgn(1 - x^2)*x' + x = 0", &[("mu", "1/10")], jump, 1.0),
        ("x'' - mu*sgn(1 - abs(x))*x' + x = 0", &[("mu", "1/10")], jump, 1.0),
        ("x'' - mu*(1 - 2*H(x^2 - 1))*x' + x = 0", &[("mu", "1/10")], jump, 1.0),
        ("x'' - mu*sgn(d^2 - x^2)*x' + x = 0", &[("mu", "1/10"), ("d", "-2")], jump, 2.0),
        (
            "x'' - mu*(1 - 3*H(x - 1))*x' + x = 0",
            &[("mu", "1/10")],
            |x| if x < 1.0 { 1.0 } else { -2.0 },
            1.0,
        ),
    ];
    for (equation, at, share, scale) in cases {
        let expected = scale * balanced_amplitude(&share, &[-1.0, 1.0]);
        let oscillator = Oscillator::parse(equation).expect(equation);
        let solution = solve(&oscillator, &Options::default()).expect(equation);
        assert_eq!(solution.method, Method::Averaging, "{equation}");
        let mut values = lindstedt::Values::default();
        for (name, value) in at {
            values.insert((*name).into(), value.parse().expect("a number")).expect("a value");
        }
        let verification = judge(&oscillator, &solution, &values, 0.01)
            .unwrap_or_else(|error| panic!("{equation}: {error}"));
        let found = verification
            .values
            .iter()
            .find(|(name, _)| name.name() == "a")
            .expect("an amplitude")
            .1;
        assert!((found / expected - 1.0).abs() < 1e-9, "{equation}: {found} {expected}");
        let slow = solution.modulation.as_ref().expect("slow equations");
        assert_eq!(slow.steady.len(), 1, "{equation}");
        assert_eq!(
            slow.steady[0].attracts_where.as_ref().map(ToString::to_string).as_deref(),
            Some("mu"),
            "{equation}"
        );
        assert!(verification.max_deviation.is_some_and(|deviation| deviation < 0.1), "{equation}");
    }
}
