//! Random equations: every method compared with its definition computed another way.
//!
//! Each equation is made from a seed, written as text at a random scale (lengths from 1e-12 to
//! 1e12, omega^2 from 1e-16 to 1e16) and given to the program; the answer is compared with the
//! definition of the method, evaluated without dimensions on a tree of the test's own: projections
//! by adaptive quadrature, Lindstedt's series by Lagrange's inversion of the energy integral,
//! homotopies by recursion in numbers, balances by continuation from rest. Nothing is taken from
//! the program but its parser and its answers. An answer may be a refusal or "not real" where that
//! is right.
//!
//! `cargo test` runs a hundred and fifty equations, some two thousand comparisons. By hand:
//!
//! ```text
//! LINDSTEDT_RANDOM_COUNT=20000 LINDSTEDT_RANDOM_SEED=1000000 cargo test --test library random_equations -- --nocapture
//! ```
//!
//! `LINDSTEDT_RANDOM_FAMILY=barrier` asks for the families with this in their name, and an empty
//! one for all; where it is set, the judge's true frequencies, deviations and ranges are looked at
//! as well, which takes longer. Motions over two wells, through an unstable equilibrium, are
//! compared in `hilltop.rs`. Equation number `i` comes from seed `seed + i` alone: a failure names
//! its own seed, to be run with a count of one and the same families.

mod balance;
mod definitions;
mod families;
mod force;
mod hilltop;
mod homotopy;
mod judgement;
mod motion;
mod quadrature;
mod velocities;
mod wells;

use std::collections::BTreeMap;

use crate::random::Random;
use definitions::{Answer, Question};
use families::Case;
use force::Shape;
use lindstedt::Values;
use lindstedt::expr::Expr;
use lindstedt::method::numbers::{self, NoNumbers};
use lindstedt::method::{Options, Reason, Refusal, solve};
use lindstedt::solution::{Degrees, Method};
use lindstedt::{Oscillator, Symbol};

/// Agreement asked for, relatively, of omega^2, beyond what rounding explains.
const AGREEMENT: f64 = 1e-9;

/// Seeds at which the program, or this test, was once wrong.
const FOUND: [u64; 63] = [
    1015149, 1006888, 1007138, 1003581, 1004387, 1005952, 1010397, 1000263, 1011981, 1012999,
    1000030, 1000224, 1000258, 1000281, 1000337, 1000464, 1000556, 1000572, 1000576, 1000587,
    1000699, 1000726, 1000782, 1000865, 1001033, 1001308, 1001339, 1001447, 1001611, 1001698,
    1001964, 1002105, 1002301, 1002676, 1002706, 1002907, 1003020, 1003039, 1003059, 1003064,
    1003243, 1003288, 1003381, 1003414, 1010185, 1010488, 1010590, 1010769, 1010893, 1010979,
    1011360, 1011435, 1011480, 1011570, 1011723, 1012170, 1012249, 1012298, 1012458, 1012489,
    1012516, 1012565, 1012566,
];

fn setting(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(default)
}

/// What was compared, and what is wrong with it.
struct Comparison {
    method: &'static str,
    complaint: Option<String>,
}

/// The stable equilibrium nearest to zero; zero itself where the force vanishes there and pulls
/// back.
fn equilibrium(case: &Case) -> Option<f64> {
    let force = &case.force;
    if force.value(0.0) == 0.0 {
        let pulls = force.value(1e-9) > 0.0 && force.value(-1e-9) < 0.0;
        return pulls.then_some(0.0);
    }
    let place = |k: i32| f64::from(k) * 1e-3;
    for k in 0..20_000 {
        for (low, high) in [(place(k), place(k + 1)), (-place(k + 1), -place(k))] {
            if force.value(low) < 0.0 && force.value(high) >= 0.0 {
                return Some(quadrature::bisect(&|x| force.value(x), low, high));
            }
        }
    }
    None
}

/// The methods with their options, and their definitions at a question.
fn variants(case: &Case, question: &Question, random: &mut Random) -> Vec<(Options, Answer, bool)> {
    let of = |method, order| Options { method: Some(method), order, ..Options::default() };
    let force = &case.force;
    let odd = question.is_odd();
    let analytic = force.taylor(question.origin, 1).is_some();
    let linear = analytic && force.slope(question.origin) > 0.0;
    let bounded =
        !force.terms.iter().any(|term| matches!(term.shape, Shape::SignedPower(p, q) if p < q));
    let shared = question.shared_integral();
    let mut list = vec![
        (of(Method::Hamiltonian, None), shared, true),
        (of(Method::VariationalIteration, None), shared, true),
        (of(Method::IterationPerturbation, None), shared, true),
        (of(Method::ParameterExpansion, Some(1)), shared, true),
        (of(Method::MaxMin, None), shared, odd && bounded),
        (of(Method::EnergyBalance, None), question.energy_balance(), odd),
        (of(Method::AmplitudeFrequency, None), question.amplitude_frequency(), odd),
        (of(Method::FrequencyFormula, None), question.frequency_formula(), odd),
        (of(Method::Exact, None), question.truth(), true),
    ];
    // In a parameter, the power of the amplitude follows from that of the parameter.
    let in_amplitude = force.terms.iter().all(|term| term.name.is_none());
    let rate = match force.terms.iter().find(|term| term.name.is_some()).map(|term| term.shape) {
        None => 1,
        Some(Shape::Power(n)) => n as usize - 1,
        Some(_) => return list,
    };
    let order = random.choose(&[1, 2, 3, 4, 6]);
    let series = if linear { question.lindstedt_poincare(order * rate) } else { Answer::Unknown };
    list.push((of(Method::LindstedtPoincare, Some(order as u32)), series, linear));
    let (above, below) = random.choose(&[(1, 1), (2, 1), (2, 2), (3, 2)]);
    let pade = Options {
        degrees: Some(Degrees::Quotient(above as u32, below as u32)),
        ..of(Method::Pade, None)
    };
    let step = if in_amplitude { None } else { Some(rate) };
    let quotient = if linear { question.pade(above, below, step) } else { Answer::Unknown };
    list.push((pade, quotient, false));
    let order = random.choose(&[1, 2, 3]);
    let degree = force.degree().unwrap_or(2 * order + 1);
    let homotopy =
        if linear { question.homotopy_perturbation(order, degree) } else { Answer::Unknown };
    list.push((of(Method::HomotopyPerturbation, Some(order as u32)), homotopy, linear));
    let order = random.choose(&[1, 2, 3]);
    let degree = force.degree().unwrap_or(2 * order + 1);
    let hbar =
        Options { hbar: Some(Expr::from(-1)), ..of(Method::HomotopyAnalysis, Some(order as u32)) };
    let analysis =
        if linear { question.homotopy_analysis(order, degree, -1.0) } else { Answer::Unknown };
    list.push((hbar, analysis, linear));
    if let Some(degree) = force.degree().filter(|_| linear && in_amplitude) {
        list.push((
            of(Method::IterationPerturbation, Some(2)),
            question.iteration_perturbation(degree),
            true,
        ));
    }
    if !force.has_corners() {
        let order = random.choose(&[1, 2, 3, 4]);
        list.push((
            of(Method::HarmonicBalance, Some(order as u32)),
            question.harmonic_balance(order),
            true,
        ));
    }
    list
}

/// One equation by every method.
fn run(seed: u64) -> (Case, String, Vec<Comparison>) {
    let mut random = Random::new(seed);
    let case = families::case(&mut random);
    let (text, values) = case.force.equation();
    let amplitude = case.amplitude.times_ten_to(case.force.length);
    let described = {
        let given = values.iter().map(|(name, value)| format!(" --at {name}={}", value.text()));
        format!("\"{text}\" --at A={}{}", amplitude.text(), given.collect::<String>())
    };
    let mut comparisons = Vec::new();
    let oscillator = match Oscillator::parse(&text) {
        Ok(oscillator) => oscillator,
        Err(error) => {
            comparisons.push(Comparison {
                method: "parser",
                complaint: Some(format!("refused: {error}")),
            });
            return (case, described, comparisons);
        }
    };
    let mut numbers: BTreeMap<Symbol, f64> =
        values.iter().map(|(name, value)| (Symbol::new(name), value.value())).collect();
    numbers.insert(Symbol::new("A"), amplitude.value());
    let Some(origin) = equilibrium(&case) else {
        let options = Options { method: Some(Method::Hamiltonian), ..Options::default() };
        let complaint = solve(&oscillator, &options).ok().map(|found| {
            format!(
                "x = 0 is no stable equilibrium, but the answer is {} about {}",
                found.formula(),
                found.equilibrium
            )
        });
        comparisons.push(Comparison { method: "equilibrium", complaint });
        return (case, described, comparisons);
    };
    let question = Question { force: &case.force, origin, amplitude: case.amplitude.value() };
    let unit = 10_f64.powi(case.force.rate);
    for (options, expected, applies) in variants(&case, &question, &mut random) {
        let method = options.method.expect("a method");
        let named = |complaint: String| {
            let order = options.order.map_or(String::new(), |order| format!(" --order {order}"));
            let degrees = options
                .degrees
                .map_or(String::new(), |degrees| format!(" --order {}", degrees.separated()));
            let hbar =
                options.hbar.as_ref().map_or(String::new(), |hbar| format!(" --hbar {hbar}"));
            format!("--method {}{order}{degrees}{hbar}: {complaint}", method.name())
        };
        let complaint = match solve(&oscillator, &options) {
            Err(Refusal { reason: Reason::TooLong(_), .. }) => None,
            Err(refusal) => applies.then(|| {
                let reason: String = refusal.to_string().chars().take(150).collect();
                format!("refused though it applies: {reason}")
            }),
            Ok(solution) => {
                let found = numbers::evaluate(&oscillator, &solution, &numbers);
                // Coefficients about an equilibrium that is no fraction are rounded: where their
                // terms cancel to less than six digits an answer is refused, and before that it
                // says how many are lost.
                let expected = match (&found, expected) {
                    (Err(NoNumbers::Cancels { .. }), _) if origin != 0.0 => Answer::Unknown,
                    // A balance about several wells says so, and is no branch from rest.
                    (Ok(found), _) if found.remark.is_some() => Answer::Unknown,
                    (Ok(found), Answer::Value(squared, noise)) => {
                        Answer::Value(squared, noise + found.rounding)
                    }
                    (_, expected) => expected,
                };
                let found = found.ok().filter(|found| found.frequency_squared > 0.0);
                let squared = found.as_ref().map(|found| found.frequency_squared / unit);
                let motion = found
                    .and_then(|found| found.motion)
                    .filter(|_| method == Method::HarmonicBalance);
                judged(squared, expected).or_else(|| {
                    let length = 10_f64.powi(case.force.length);
                    let (motion, squared) = (motion?, squared?);
                    let order = solution.order as usize;
                    let highest = *question.balanced(order).last()?;
                    let mut coefficients: Vec<f64> =
                        (0..=highest).map(|k| motion.cosine(k).mean().0 / length).collect();
                    coefficients[0] -= question.origin;
                    let defect = question.defect_of_balance(squared, &coefficients, order)?;
                    let rounding = 1e-13 * (1.0 + question.origin.abs() / question.size());
                    let noise = rounding * (1.0 + question.noise(question.amplitude));
                    (defect > 1e-7 + noise)
                        .then(|| format!("the harmonics are out of balance by {defect:.1e}"))
                })
            }
        };
        comparisons.push(Comparison { method: method.name(), complaint: complaint.map(named) });
    }
    // The whole table takes longer than the rest: by hand, and now and then.
    if families::asked_for().is_some() && random.percent(15.0) {
        let mut at = Values::default();
        for (name, value) in values.into_iter().chain([("A", amplitude)]) {
            at.insert(name.into(), value.text().parse().expect("a number"))
                .expect("one value for each");
        }
        let units = (10_f64.powi(case.force.length), unit.sqrt());
        comparisons.extend(judgement::judgement(&question, &oscillator, &at, units));
    }
    (case, described, comparisons)
}

/// What is wrong with an answer, omega^2 or "not real", in words.
fn judged(found: Option<f64>, expected: Answer) -> Option<String> {
    match (found, expected) {
        (_, Answer::Unknown) => None,
        (None, Answer::Nothing(_)) => None,
        (Some(found), Answer::Nothing(why)) => Some(format!("omega^2 = {found}, but {why}")),
        (None, Answer::Value(squared, noise)) => {
            (squared > 0.0 && noise < 1e-3).then(|| format!("not real, but omega^2 = {squared}"))
        }
        (None, Answer::Elsewhere(..)) => None,
        (Some(found), Answer::Value(squared, noise) | Answer::Elsewhere(squared, noise)) => {
            let agrees = (found / squared - 1.0).abs() <= AGREEMENT + noise;
            (!agrees).then(|| {
                format!(
                    "omega^2 = {found}, but the definition gives {squared} (good to {noise:.0e})"
                )
            })
        }
    }
}

#[test]
fn every_method_gives_what_its_definition_gives() {
    let count = setting("LINDSTEDT_RANDOM_COUNT", 150);
    let first = setting("LINDSTEDT_RANDOM_SEED", 1);
    let mut counts: BTreeMap<(&str, &str), (usize, usize)> = BTreeMap::new();
    let mut complaints = Vec::new();
    // A run by hand asks for its own seeds alone.
    let found = FOUND.into_iter().filter(|_| first == 1);
    for seed in (first..first + count).chain(found) {
        let (case, described, comparisons) = run(seed);
        for comparison in comparisons {
            let entry = counts.entry((case.family, comparison.method)).or_default();
            entry.0 += 1;
            if let Some(complaint) = comparison.complaint {
                entry.1 += 1;
                let complaint = format!("seed {seed}: {}: {described} {complaint}", case.family);
                // A long run shows them as they come.
                println!("{complaint}");
                complaints.push(complaint);
            }
        }
    }
    let total: usize = counts.values().map(|(done, _)| done).sum();
    println!("{count} equations, {total} comparisons, {} complaints", complaints.len());
    for ((family, method), (done, wrong)) in &counts {
        println!("{family:>24} {method:>24} {done:>6} {wrong:>6}");
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
fn motions_with_velocities_are_judged_rightly() {
    let count = setting("LINDSTEDT_RANDOM_COUNT", 150) / 20;
    let first = setting("LINDSTEDT_RANDOM_SEED", 1);
    let questions = [velocities::limit_cycle, velocities::inertia];
    let complaints: Vec<String> = (first..first + count)
        .flat_map(|seed| questions.map(|question| (seed, question(&mut Random::new(seed)))))
        .filter_map(|(seed, (described, complaint))| {
            Some(format!("seed {seed}: {described}: {}", complaint?))
        })
        .collect();
    println!("{} motions with velocities, {} complaints", 2 * count, complaints.len());
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}
