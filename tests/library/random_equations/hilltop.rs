//! Random forces with a hilltop at rest between two wells, and the motions over both: every method
//! against its definition, and the least amplitude against the energy.
//!
//! ```text
//! -k x + c x^n + d x^m          -k sin(b x) + c x          -k tanh(b x) + c x          -k x/(1 + b x^2) + c x
//! ```

use std::collections::BTreeMap;

use lindstedt::expr::Expr;
use lindstedt::method::numbers;
use lindstedt::method::{CentredForce as AtNumbers, Options, solve};
use lindstedt::solution::Method;
use lindstedt::verify::Well;
use lindstedt::{Oscillator, Symbol};

use super::definitions::{Answer, Question};
use super::families::number;
use super::force::{Force, Number, Shape, Term};
use super::quadrature::{bisect, integrate};
use super::{AGREEMENT, setting};
use crate::random::Random;

fn term(coefficient: Number, shape: Shape) -> Term {
    Term { coefficient, shape, name: None }
}

/// A force and where its first well has its bottom.
fn two_wells(random: &mut Random) -> (Force, f64) {
    let size = |random: &mut Random| random.between(0.3, 3.0);
    let (k, c, b) = (size(random), size(random), size(random));
    let away = |shape: Shape, k: f64| term(number(-k), shape);
    let (polynomial, n) = (random.percent(60.0), random.choose(&[3, 3, 5, 7]));
    let terms = if polynomial {
        let mut terms = vec![away(Shape::Power(1), k), term(number(c), Shape::Power(n))];
        if random.percent(40.0) {
            terms.push(term(number(size(random)), Shape::Power(n + 2)));
        }
        terms
    } else {
        // What pulls back is weaker at rest.
        let pull = term(number(k * b * random.between(0.1, 0.8)), Shape::Power(1));
        let shape = match random.whole(0, 2) {
            0 => away(Shape::Sine(number(b)), k),
            1 => away(Shape::Tanh(number(b)), k),
            _ => away(Shape::Saturating(number(b)), k * b),
        };
        vec![shape, pull]
    };
    let force =
        Force { terms, length: random.choose(&[0, 0, -6, 6]), rate: random.choose(&[0, 0, -4, 8]) };
    let place = |step: u32| 1e-3 * 1.01_f64.powi(step as i32);
    let crossing = (0..2000)
        .find(|&step| force.value(place(step)) < 0.0 && force.value(place(step + 1)) >= 0.0);
    let step = crossing.expect("a well");
    let bottom = bisect(&|x| force.value(x), place(step), place(step + 1));
    (force, bottom)
}

/// The amplitude from which on the potential is above that at rest.
fn edge(force: &Force, bottom: f64) -> Option<f64> {
    let risen = |x: f64| {
        integrate(&|y| force.value(y), &[0.0, bottom.min(x), x], 1e-14).unwrap_or(f64::NAN)
    };
    let outside = (1..4000).map(|k| bottom * (1.0 + 0.01 * f64::from(k)));
    let beyond = outside.take_while(|x| force.value(*x) > 0.0).find(|x| risen(*x) > 0.0)?;
    Some(bisect(&risen, bottom, beyond))
}

/// Whether a method gives a series of omega itself.
fn gives_omega_itself(options: &Options) -> bool {
    options.method == Some(Method::HomotopyAnalysis)
}

#[test]
fn motions_over_both_wells_are_those_of_every_definition() {
    let count = setting("LINDSTEDT_RANDOM_COUNT", 150) * 2;
    let first = setting("LINDSTEDT_RANDOM_SEED", 1);
    let (mut compared, mut refused, mut edges) = (0, 0, 0);
    let mut complaints: Vec<String> = Vec::new();
    for seed in first..first + count {
        let random = &mut Random::new(7_000_000 + seed);
        let (force, bottom) = two_wells(random);
        let amplitude = number(random.choose(&[-1.0, 1.0]) * bottom * random.between(0.4, 6.0));
        let (text, _) = force.equation();
        let oscillator = Oscillator::parse(&text).expect("an equation").about(Expr::zero());
        let length = 10_f64.powi(force.length);
        let at: BTreeMap<Symbol, f64> =
            [(Symbol::new("A"), amplitude.times_ten_to(force.length).value())].into();
        let question = Question { force: &force, origin: 0.0, amplitude: amplitude.value() };
        let unit = 10_f64.powi(force.rate);
        let of = |method: Method, order: Option<u32>| Options {
            method: Some(method),
            order,
            ..Options::default()
        };
        let found_by = |options: &Options| {
            let solution = solve(&oscillator, options)
                .unwrap_or_else(|error| panic!("seed {seed}: {text}: {error}"));
            numbers::evaluate(&oscillator, &solution, &at).ok()
        };
        let mut say = |complaint: String| {
            complaints.push(format!(
                "seed {seed}: \"{text}\" --at A={}: {complaint}",
                at[&Symbol::new("A")]
            ))
        };
        // Where the least amplitude is.
        if let Some(edge) = edge(&force, bottom) {
            let written: Expr = oscillator.force.clone();
            let about = AtNumbers::new(
                &written,
                "x".into(),
                &Expr::zero(),
                &BTreeMap::new(),
                edge * length,
            )
            .expect("a force");
            let inner = Well::new(&about, 1.5 * edge * length).and_then(|well| well.inner);
            edges += 1;
            match inner {
                Some(inner) if edge >= question.size() || inner.place == 0.0 => {
                    if (inner.amplitude / (edge * length) - 1.0).abs() > 1e-6 {
                        say(format!("begins at {:e}, not {:e}", inner.amplitude, edge * length));
                    }
                }
                Some(_) => {}
                None => say("no least amplitude".to_owned()),
            }
        }
        let truth = question.truth();
        let moves = matches!(truth, Answer::Value(..));
        refused += usize::from(matches!(truth, Answer::Nothing(_) | Answer::Elsewhere(..)));
        let shared = question.shared_integral();
        let degree = force.degree();
        let mut list = vec![
            (of(Method::Exact, None), truth),
            (of(Method::Hamiltonian, None), shared),
            (of(Method::VariationalIteration, None), shared),
            (of(Method::IterationPerturbation, None), shared),
            (of(Method::ParameterExpansion, Some(1)), shared),
            (of(Method::MaxMin, None), shared),
            (of(Method::HarmonicBalance, Some(1)), shared),
            (of(Method::EnergyBalance, None), question.energy_balance()),
            (of(Method::AmplitudeFrequency, None), question.amplitude_frequency()),
            (of(Method::FrequencyFormula, None), question.frequency_formula()),
        ];
        let order = random.choose(&[1, 2, 3]);
        let hbar = Options {
            hbar: Some(Expr::from(-1)),
            ..of(Method::HomotopyAnalysis, Some(order as u32))
        };
        list.push((hbar, question.homotopy_analysis(order, degree.unwrap_or(2 * order + 1), -1.0)));
        for (options, expected) in list {
            let method = options.method.expect("a method").name();
            let found = found_by(&options).map(|found| found.frequency_squared / unit);
            compared += 1;
            match (found, expected) {
                // A negative omega is not real, and so is its definition, whatever its square.
                (Some(found), Answer::Value(expected, _))
                    if found < 0.0 && expected < 0.0 && gives_omega_itself(&options) => {}
                (Some(found), Answer::Value(expected, noise))
                    if (found / expected - 1.0).abs() <= AGREEMENT + noise => {}
                (Some(found), Answer::Value(expected, noise)) => {
                    say(format!("{method}: {found}, not {expected} (good to {noise:.0e})"));
                }
                (Some(found), Answer::Nothing(why)) if found > 0.0 => {
                    say(format!("{method}: {found}, but {why}"))
                }
                (Some(found), Answer::Elsewhere(..)) => {
                    say(format!("{method}: {found} of a motion in one well"))
                }
                (None, Answer::Value(expected, noise)) if expected > 0.0 && noise < 1e-3 => {
                    say(format!("{method}: nothing, not {expected}"));
                }
                _ => {}
            }
        }
        // What is solved for: the equations are met, and where the true motion is well outside of
        // the separatrix, by that motion.
        let order = random.choose(&[2, 3, 4]);
        if let (true, Some(degree)) = (moves, degree) {
            for method in [Method::HomotopyPerturbation, Method::ParameterExpansion] {
                let Some(found) = found_by(&of(method, Some(order as u32))) else {
                    continue;
                };
                compared += 1;
                let defect =
                    question.defect_of_homotopy(order, degree, found.frequency_squared / unit);
                if defect.is_none_or(|defect| defect > 1e-8) {
                    say(format!("{}: the relation is missed by {defect:?}", method.name()));
                }
            }
        }
        if moves && let Some(found) = found_by(&of(Method::HarmonicBalance, Some(order as u32))) {
            compared += 1;
            let motion = found.motion.expect("a motion");
            let highest = *question.balanced(order).last().expect("a harmonic");
            let coefficients: Vec<f64> =
                (0..=highest).map(|k| motion.cosine(k).mean().0 / length).collect();
            let squared = found.frequency_squared / unit;
            let defect = question.defect_of_balance(squared, &coefficients, order);
            if defect.is_some_and(|defect| defect > 1e-7) {
                say(format!("the harmonics are out of balance by {defect:?}"));
            }
            if let Answer::Value(truth, _) = truth
                && let Some(edge) = edge(&force, bottom)
                && question.size() > 1.5 * edge
                && degree.is_some()
                && (squared / truth).sqrt().ln().abs() > 0.1
            {
                say(format!("another branch of the balance: {squared} beside a true {truth}"));
            }
        }
    }
    println!("{compared} comparisons, {refused} motions in one well, {edges} least amplitudes");
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
    assert!(refused > 30 && edges > 200 && compared > 3000, "{compared}, {refused}, {edges}");
}
