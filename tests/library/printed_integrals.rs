//! Laws that have no closed form are printed as integrals: evaluated as they stand, at the numbers
//! that are given with them, every printed equation holds.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use lindstedt::method::numbers::evaluate;
use lindstedt::method::{Options, solve};
use lindstedt::solution::Method;
use lindstedt::solution::{DerivationFormula, DerivationLine};
use lindstedt::{Oscillator, Solution, Symbol};

type Numbers = BTreeMap<Symbol, f64>;

/// What else is known once a variable of integration has its value.
type Context<'a> = dyn Fn(&mut Numbers, Symbol, f64) + 'a;

/// The value of a formula; `None` for what is no number.
fn value(formula: &DerivationFormula, numbers: &Numbers, context: &Context) -> Option<f64> {
    match formula {
        DerivationFormula::Expression(expression) => expression.evaluate(numbers).ok(),
        DerivationFormula::OverRoot(numerator, inside) => {
            Some(numerator.evaluate(numbers).ok()? / value(inside, numbers, context)?.sqrt())
        }
        DerivationFormula::Integral { factor, from, to, integrand, variable } => {
            // The double exponential rule (H. Takahasi, M. Mori, Publ. RIMS 9 (1974) 721), for
            // roots below the line at the ends.
            const STEP: f64 = 0.06;
            let [factor, from, to] = [factor, from, to].map(|part| part.evaluate(numbers).ok());
            let (from, to) = (from?, to?);
            let mut sum = 0.0;
            for k in -50..=50 {
                let t = STEP * f64::from(k);
                let tangent = (0.5 * PI * t.sinh()).tanh();
                let weight = 0.25 * PI * t.cosh() * (1.0 - tangent * tangent);
                let place = from + (to - from) * 0.5 * (1.0 + tangent);
                let mut there = numbers.clone();
                there.insert(*variable, place);
                context(&mut there, *variable, place);
                sum += value(integrand, &there, context)? * weight;
            }
            Some(factor? * sum * (to - from) * STEP)
        }
        _ => None,
    }
}

/// How many equations of an answer could be evaluated; each of them holds.
fn equations_hold(
    lines: &[DerivationLine],
    numbers: &mut Numbers,
    context: &Context,
    name: &str,
) -> usize {
    let mut count = 0;
    for line in lines.iter().filter(|line| line.equal.len() > 1) {
        // The other turning point is where the printed equation for it is true.
        let unknown = Symbol::new("x1");
        if line.words.contains("turning point") {
            let amplitude = numbers[&"A".into()];
            let excess = |x: f64| {
                let mut there = numbers.clone();
                there.insert(unknown, x);
                let [left, right] =
                    [&line.equal[0], &line.equal[1]].map(|side| value(side, &there, context));
                left.expect("an equation") - right.expect("an equation")
            };
            let (mut near, mut far) = (-0.05 * amplitude, -1.9 * amplitude);
            assert!(excess(near) * excess(far) < 0.0, "{name}: {line}");
            for _ in 0..60 {
                let middle = 0.5 * (near + far);
                if excess(near) * excess(middle) > 0.0 {
                    near = middle;
                } else {
                    far = middle;
                }
            }
            numbers.insert(unknown, near);
            continue;
        }
        let indices: Vec<f64> = match line.words.strip_prefix("for k = ") {
            Some(list) => list.split(", ").map(|k| k.parse().expect("a harmonic")).collect(),
            None => vec![1.0],
        };
        for k in indices {
            numbers.insert("k".into(), k);
            let values: Vec<f64> =
                line.equal.iter().filter_map(|part| value(part, numbers, context)).collect();
            if values.len() < 2
                || !line.equal.iter().any(|part| matches!(part, DerivationFormula::Integral { .. }))
            {
                continue;
            }
            for other in &values[1..] {
                let size = values[0].abs().max(other.abs()).max(0.1);
                assert!((values[0] - other).abs() < 5e-6 * size, "{name}: {line}: {values:?}");
            }
            count += 1;
        }
    }
    count
}

fn derived(equation: &str, method: Method) -> Option<(Oscillator, Solution)> {
    let oscillator = Oscillator::parse(equation).expect("an equation");
    let options = Options { method: Some(method), ..Options::default() };
    let solution = solve(&oscillator, &options).ok()?;
    Some((oscillator, solution))
}

#[test]
fn every_printed_integral_is_the_number_given_with_it() {
    /// Equation, `M` of its energy, and how many methods print integrals for it.
    type Case = (&'static str, fn(f64) -> f64, usize);
    let cases: [Case; 10] = [
        ("x'' + x + x^3/(1 + x^4) = 0", |_| 1.0, 7),
        ("x'' + 2*x + x^2/(1 + x^4) = 0", |_| 1.0, 6),
        ("x'' + atan(3*x) + x^5/(2 + cos(x)) = 0", |_| 1.0, 8),
        // Their potentials by substitution.
        ("x'' + exp(x) - 1 = 0", |_| 1.0, 2),
        ("x'' + sin(x) - sin(x)*cos(x)/2 = 0", |_| 1.0, 2),
        ("x'' + x + x*x'^2 = 0", |x| (x * x).exp(), 3),
        // log M = 2 int g, g what stands before x'^2.
        ("(1 + x^4)*x'' + 2*x^3*x'^2 + sin(x) = 0", |x| 1.0 + x.powi(4), 3),
        ("(1 + x^4)*x'' + 2*x^3*x'^2 + x + x^2/5 = 0", |x| 1.0 + x.powi(4), 2),
        (
            "(2 + cos(x)^2)*x'' - sin(x)*cos(x)*x'^2 + 2*sin(x) = 0",
            |x| (2.0 + x.cos().powi(2)) / 3.0,
            3,
        ),
        // The slope of M is typed in other waves than M, so that no formula is found for it.
        (
            "(1 + x^2 + sin(x)^4)*x'' + (x + sin(2*x)*(1 - cos(2*x))/2)*x'^2 + x = 0",
            |x| 1.0 + x * x + x.sin().powi(4),
            4,
        ),
    ];
    let mut counts = Vec::new();
    for (equation, mass, expected) in cases {
        let mut methods = 0;
        for method in Method::ALL {
            let Some((oscillator, solution)) = derived(equation, method) else {
                continue;
            };
            let Some(lines) = solution.law.quadrature() else {
                continue;
            };
            methods += 1;
            let amplitude = 0.9;
            let name = format!("{equation} by {} at {amplitude}", method.name());
            let mut numbers = Numbers::from([("A".into(), amplitude)]);
            let found = evaluate(&oscillator, &solution, &numbers)
                .unwrap_or_else(|error| panic!("{name}: {error}"));
            let omega = found.frequency_squared.sqrt();
            numbers.extend(found.chosen.iter().copied());
            numbers.extend([
                ("omega".into(), omega),
                ("T".into(), TAU / omega),
                ("M_eighth".into(), mass(amplitude * (PI / 4.0).cos())),
            ]);
            let motion = found.motion.expect("a motion");
            let velocity = motion.derivative();
            let acceleration = velocity.derivative();
            let context = |numbers: &mut Numbers, variable: Symbol, place: f64| {
                let x = if variable.name() == "theta" {
                    let x = motion.evaluate(place);
                    numbers.extend([
                        ("x".into(), x),
                        ("x'".into(), omega * velocity.evaluate(place)),
                        ("x''".into(), omega * omega * acceleration.evaluate(place)),
                    ]);
                    x
                } else {
                    place
                };
                numbers.insert("M".into(), mass(x));
            };
            let held = equations_hold(lines, &mut numbers, &context, &name);
            assert!(held > 0, "{name}: nothing could be evaluated in {lines:?}");
            // The derivation may show more.
            let more: Vec<DerivationLine> =
                solution.derivation.iter().filter(|line| !lines.contains(line)).cloned().collect();
            equations_hold(&more, &mut numbers, &context, &name);
        }
        counts.push((equation, methods, expected));
    }
    let others: Vec<_> = counts.iter().filter(|(_, found, expected)| found != expected).collect();
    assert!(others.is_empty(), "{others:?}");
}

/// Released on the other side, the motion turns on this one, and the printed period counts from
/// there to A.
#[test]
fn the_period_of_a_negative_amplitude_is_printed_as_well() {
    for (equation, mass) in [
        ("x'' + x + x^2 = 0", (|_| 1.0) as fn(f64) -> f64),
        ("x'' + 2*x + x^2/(1 + x^4) = 0", |_| 1.0),
        ("x'' + x + x*abs(x)/2 + x^2/5 = 0", |_| 1.0),
        ("(1 + x^4)*x'' + 2*x^3*x'^2 + x + x^2/5 = 0", |x| 1.0 + x.powi(4)),
    ] {
        let (oscillator, solution) = derived(equation, Method::Exact).expect(equation);
        let words: Vec<&str> = solution.derivation.iter().map(|line| line.words.as_str()).collect();
        let said = |text: &str| words.iter().any(|words| words.contains(text));
        assert!(
            said("x1, of the other sign than A") && said("for A < 0 from A to x1"),
            "{words:?}"
        );
        let mut numbers = Numbers::from([("A".into(), -0.4)]);
        let found = evaluate(&oscillator, &solution, &numbers).expect(equation);
        let period = TAU / found.frequency_squared.sqrt();
        // From x1 to A is the way back, whose integral has the other sign.
        numbers.extend([("omega".into(), -TAU / period), ("T".into(), -period)]);
        let context = |numbers: &mut Numbers, _: Symbol, place: f64| {
            numbers.insert("M".into(), mass(place));
        };
        assert!(equations_hold(&solution.derivation, &mut numbers, &context, equation) > 0);
    }
}

/// Where the integral is known, it stands beside its value in the derivation.
#[test]
fn integrals_on_the_way_to_a_closed_law_are_its_terms() {
    let mut counts = Vec::new();
    for (equation, small) in [
        ("x'' + x + x^3 = 0", None),
        ("x'' + sin(x) = 0", None),
        ("x'' + x + x*abs(x) = 0", None),
        ("x'' + x + eps*x*abs(x) = 0", Some("eps")),
    ] {
        let mut count = 0;
        for method in Method::ALL {
            let oscillator = Oscillator::parse(equation).expect("an equation");
            let options = Options {
                method: Some(method),
                order: small.map(|_| 1),
                small: small.map(str::to_owned),
                ..Options::default()
            };
            let Ok(solution) = solve(&oscillator, &options) else {
                continue;
            };
            let mut numbers = Numbers::from([("A".into(), 0.9), ("eps".into(), 0.3)]);
            let Ok(found) = evaluate(&oscillator, &solution, &numbers) else {
                continue;
            };
            numbers.insert("omega".into(), found.frequency_squared.sqrt());
            let name = format!("{equation} by {}", method.name());
            count += equations_hold(&solution.derivation, &mut numbers, &|_, _, _| (), &name);
        }
        counts.push(count);
    }
    assert_eq!(counts, [3, 5, 5, 7]);
}

/// Between corners, too, a balance leaves nothing of its harmonics in the equation: by the midpoint
/// rule, as fine as it takes.
#[test]
fn balances_of_forces_with_corners_hold() {
    const POINTS: usize = 40_000;
    type Case = (&'static str, fn(f64) -> f64, &'static [usize]);
    let cases: [Case; 4] = [
        ("x'' + x + sgn(x) = 0", |x| x + x.signum(), &[1, 3]),
        ("x'' + x + x*abs(x) = 0", |x| x + x * x.abs(), &[1, 3]),
        (
            "x'' + x + 3*(x - 1/2)*H(x - 1/2) - 3*(-x - 1/2)*H(-x - 1/2) = 0",
            |x| x + 3.0 * ((x - 0.5).max(0.0) - (-x - 0.5).max(0.0)),
            &[1, 3],
        ),
        (
            "x'' + 2*x + 5*max(x, 1/3) - 5/3 = 0",
            |x| 2.0 * x + 5.0 * (x - 1.0 / 3.0).max(0.0),
            &[0, 1, 2],
        ),
    ];
    for (equation, force, harmonics) in cases {
        let (oscillator, solution) = derived(equation, Method::HarmonicBalance).expect("an answer");
        for amplitude in [0.7, 1.3, 4.0] {
            let numbers = Numbers::from([("A".into(), amplitude)]);
            let found = evaluate(&oscillator, &solution, &numbers).expect("numbers");
            let motion = found.motion.expect("a motion");
            let acceleration = motion.derivative().derivative();
            assert!((motion.evaluate(0.0) - amplitude).abs() < 1e-12);
            for &k in harmonics {
                let left = |i: usize| {
                    let theta = PI * (i as f64 + 0.5) / POINTS as f64;
                    let defect = found.frequency_squared * acceleration.evaluate(theta)
                        + force(motion.evaluate(theta));
                    defect * (k as f64 * theta).cos() / POINTS as f64
                };
                let rest: f64 = (0..POINTS).map(left).sum();
                assert!(
                    rest.abs() < 1e-7 * amplitude,
                    "{equation} at {amplitude}, harmonic {k}: {rest}"
                );
            }
        }
    }
}

/// A branch that is followed from rest to an amplitude arrives there, wherever its last step would
/// have ended.
#[test]
fn a_balance_is_found_at_every_amplitude() {
    for equation in
        ["x'' + x + sgn(x) = 0", "x'' + x/10 + x*abs(x) = 0", "x'' + sin(x) + 2*tanh(5*x) = 0"]
    {
        let (oscillator, solution) = derived(equation, Method::HarmonicBalance).expect("an answer");
        let mut last = f64::NAN;
        for k in 1..=80 {
            let numbers = Numbers::from([("A".into(), 0.03 * f64::from(k))]);
            let found = evaluate(&oscillator, &solution, &numbers);
            let squared =
                found.unwrap_or_else(|error| panic!("{equation}, {k}: {error}")).frequency_squared;
            // One branch: it moves by less and less.
            assert!(
                k == 1 || (squared / last).ln().abs() < 1.5 / f64::from(k),
                "{equation}, {k}: {last} {squared}"
            );
            last = squared;
        }
    }
}

/// What is known of the motion stands in the law: a force and an inertia that are even or odd turn
/// back at -A, and a potential in closed form needs no integral.
#[test]
fn the_energy_is_written_out_where_it_can_be() {
    for (equation, expected) in [
        ("(1 + k*x^2)*x'' + k*x*x'^2 + x = 0", "T = 4*int_0^A sqrt(1 + k*x^2)/sqrt(A^2 - x^2) dx"),
        ("x'' + x + x*x'^2 = 0", "T = 4*int_0^A exp(x^2/2)/sqrt(exp(A^2) - exp(x^2)) dx"),
        ("x'' + exp(x) - 1 = 0", "-x1 + exp(x1) = -A + exp(A)"),
        ("x'' + x - 1/x = 0", "x1 + x1^2/2 - log(1 + x1) = A + A^2/2 - log(1 + A)"),
    ] {
        let (_, solution) = derived(equation, Method::Exact).expect(equation);
        let lines = solution.law.quadrature().expect(equation);
        let text: Vec<String> = lines.iter().map(ToString::to_string).collect();
        assert!(text.iter().any(|line| line.contains(expected)), "{equation}: {text:?}");
    }
}
