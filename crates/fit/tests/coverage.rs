//! Whether the errors are true: records of known laws, fitted, and held against the truth.
//!
//! The long run: `cargo test --release -p lindstedt-fit --test coverage -- --ignored --nocapture`; the number of
//! records and the first seed are `LINDSTEDT_FIT_RECORDS` and `LINDSTEDT_FIT_SEED`.

mod synthetic;

use std::collections::BTreeMap;

use lindstedt_fit::fit::answer::{FitOptions, fit};
use lindstedt_fit::fit::laws::{Loss, Spring};
use synthetic::{LONG, Length, SHORT, synthetic};

/// What a run over many records found.
#[derive(Default)]
struct Tally {
    records: usize,
    failures: Vec<String>,
    right_first: usize,
    intervals: usize,
    covered: usize,
    /// The errors in units of the standard error, by the name of the parameter.
    deviations: BTreeMap<&'static str, Vec<f64>>,
}

fn run(seeds: impl Iterator<Item = u64>, length: Length, is_talkative: bool) -> Tally {
    let mut tally = Tally::default();
    for seed in seeds {
        let made = synthetic(seed, length);
        tally.records += 1;
        let begin = std::time::Instant::now();
        let answer = match fit(&made.record, &FitOptions::default()) {
            Ok(answer) => answer,
            Err(error) => {
                tally.failures.push(format!("{}: {error}", made.words));
                continue;
            }
        };
        let duration = begin.elapsed();
        let parts = Some((made.spring, made.loss));
        let is_first = answer.laws[0].law.parts == parts;
        tally.right_first += usize::from(is_first);
        let Some(own) = answer.laws.iter().find(|law| law.law.parts == parts) else {
            tally.failures.push(format!(
                "{}: the law was not tried; first {}",
                made.words, answer.laws[0].law.name
            ));
            continue;
        };
        let mut far = vec![];
        for (name, value) in &made.truth {
            let estimate = own.estimate(name).expect("a parameter");
            let deviation = (estimate.value - value) / estimate.error;
            tally.intervals += 1;
            tally.covered += usize::from(deviation.abs() <= 3.0);
            tally.deviations.entry(name).or_default().push(deviation);
            if deviation.abs() > 3.0 {
                far.push(format!("{name} {} ({}) is {value}", estimate.value, estimate.error));
            }
        }
        if is_talkative && (!is_first || !far.is_empty()) {
            let first = &answer.laws[0];
            let behind = own.bic - first.bic;
            eprintln!(
                "{} in {duration:?}: {} far: {far:?} length {:.2} outliers {}",
                made.words,
                if is_first {
                    "right".to_owned()
                } else {
                    format!("{} first by {behind:.1}", first.law.name)
                },
                answer.correlation_length,
                answer.records[0].outliers.len()
            );
        }
    }
    tally
}

impl Tally {
    fn report(&self) {
        eprintln!(
            "{} records, {} without an answer, right law first {}, {} of {} intervals cover",
            self.records,
            self.failures.len(),
            self.right_first,
            self.covered,
            self.intervals
        );
        for failure in &self.failures {
            eprintln!("  {failure}");
        }
        for (name, own) in &self.deviations {
            let count = own.len() as f64;
            let mean = own.iter().sum::<f64>() / count;
            let square = own.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count;
            eprintln!("  {name:6} {:4} mean {mean:+.3} spread {:.3}", own.len(), square.sqrt());
        }
    }
}

#[test]
#[ignore = "a few minutes: see the head of the file"]
fn errors_are_true_over_many_records() {
    let number = |name: &str, usual: u64| {
        std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(usual)
    };
    let first = number("LINDSTEDT_FIT_SEED", 0);
    let begin = std::time::Instant::now();
    let tally = run(first..first + number("LINDSTEDT_FIT_RECORDS", 300), LONG, true);
    tally.report();
    eprintln!("{:?}", begin.elapsed());
    assert!(tally.failures.is_empty(), "{:?}", tally.failures);
    assert!(
        tally.covered * 100 >= tally.intervals * 99,
        "{} of {}",
        tally.covered,
        tally.intervals
    );
    assert!(tally.right_first * 100 >= tally.records * 95, "{}", tally.right_first);
    for (name, own) in &tally.deviations {
        // The mean of so few deviations is itself uncertain by their spread.
        let bias = (own.iter().sum::<f64>() / own.len() as f64).abs();
        assert!(bias < 0.3 + 3.0 / (own.len() as f64).sqrt(), "{name}: {bias}");
    }
}

#[test]
fn errors_are_true_over_some_short_records() {
    // Laws without unknown exponents, whose fits take longer.
    let is_quick = |seed: &u64| seed % 5 != 4 && (seed / 5) % 6 != 4;
    let tally = run((0..60).filter(is_quick).step_by(5), SHORT, true);
    tally.report();
    assert!(tally.failures.is_empty(), "{:?}", tally.failures);
    assert_eq!(tally.right_first, tally.records);
    assert_eq!(tally.covered, tally.intervals);
}

/// The example of a pendulum with viscous damping and dry friction, 60 s at 200 Hz with 0.3 degrees of noise.
fn pendulum(seed: u64) -> lindstedt_fit::fit::record::Record {
    use rand::SeedableRng;
    let mut generator = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
    let times: Vec<f64> = (0..12_000).map(|index| f64::from(index) / 200.0).collect();
    let truth = [("w", std::f64::consts::TAU), ("zeta", 0.004), ("alpha", 0.003)];
    let (spring, loss) = (Spring::Pendulum, Loss::ViscousAndCoulomb);
    let motion = synthetic::motion(spring, loss, &truth, [1.4, 0.0], &times);
    let noise = 0.3_f64.to_radians();
    let values = motion.iter().map(|x| x + noise * synthetic::normal(&mut generator));
    lindstedt_fit::fit::record::Record {
        values: values.collect(),
        times,
        is_angle: true,
        ..Default::default()
    }
}

#[test]
fn a_pendulum_with_viscous_damping_and_dry_friction_is_told_apart() {
    let begin = std::time::Instant::now();
    let answer = fit(&pendulum(1), &FitOptions::default()).unwrap();
    let duration = begin.elapsed();
    let best = &answer.laws[0];
    eprintln!("{duration:?}\n{}\n{:?}", answer.exclusions().join("\n"), best.estimates);
    let viscous = Some((Spring::Pendulum, Loss::Viscous));
    let viscous = answer.excluded.iter().find(|law| law.law.parts == viscous).expect("excluded");
    assert!(viscous.ratio > 500.0, "{viscous:?}");
    assert_eq!(best.law.parts, Some((Spring::Pendulum, Loss::ViscousAndCoulomb)));
    for (name, value, error) in [("zeta", 0.004, 1e-5), ("alpha", 0.003, 1e-4)] {
        let own = best.estimate(name).unwrap();
        assert!((own.value - value).abs() < 3.0 * own.error && own.error < error, "{own:?}");
    }
}

#[test]
fn laws_of_one_s_own_and_other_quantities_are_fitted() {
    use lindstedt_fit::fit::answer::fit_laws;
    use lindstedt_fit::fit::laws::Law;
    use lindstedt_fit::fit::motion::{MotionSolver, Quantity};
    use rand::SeedableRng;

    let law = Law::parse("x'' + c*x' + k*x + f*tanh(8*x) = 0").unwrap();
    let number = |name: &str| {
        [("c", 0.12), ("f", 4.0), ("k", 30.0)].iter().find(|own| own.0 == name).unwrap().1
    };
    let truth: Vec<f64> = law.parameters.iter().map(|name| number(name.name())).collect();
    let solver = MotionSolver::new(&law).unwrap();
    let times: Vec<f64> = (0..1500).map(|index| 0.02 * f64::from(index)).collect();
    for quantity in [Quantity::Displacement, Quantity::Velocity, Quantity::Acceleration] {
        let motion = solver.sample(&truth, [0.8, 0.5], &times, 0.5, quantity).unwrap();
        let mut generator = rand_chacha::ChaCha8Rng::seed_from_u64(3);
        let size = motion.columns[0].iter().fold(0.0_f64, |size, own| size.max(own.abs()));
        let values: Vec<f64> = motion.columns[0]
            .iter()
            .map(|own| own + 0.3 * size + 3e-3 * size * synthetic::normal(&mut generator))
            .collect();
        let record = lindstedt_fit::fit::record::Record {
            times: times.clone(),
            values,
            quantity,
            is_angle: false,
        };
        // From its accelerations, or from a start.
        let start: Vec<f64> = truth.iter().map(|own| 0.95 * own).collect();
        let start = (quantity != Quantity::Displacement).then_some(start);
        let answer = fit_laws(&record, &[(law.clone(), start)], &FitOptions::default()).unwrap();
        let best = &answer.laws[0];
        assert!(best.converged && best.whiteness.is_white(), "{quantity:?} {:?}", best.estimates);
        for (estimate, truth) in best.estimates.iter().zip(&truth) {
            assert!(
                (estimate.value - truth).abs() < 3.5 * estimate.error,
                "{quantity:?} {estimate:?} {truth}"
            );
        }
        let band = answer.predict(best, 0, &[31.0, 35.0]).unwrap();
        let exact = solver.sample(&truth, [0.8, 0.5], &[0.0, 31.0, 35.0], 0.5, quantity).unwrap();
        for ([value, error], exact) in band.iter().zip(&exact.columns[0][1..]) {
            assert!(
                (value - 0.3 * size - exact).abs() < 4.0 * error,
                "{quantity:?} {value} {exact} {error}"
            );
        }
    }
}

#[test]
fn outliers_are_left_out_and_named() {
    let mut made = synthetic(11, SHORT).record;
    let size = made.values.iter().fold(0.0_f64, |size, own| size.max(own.abs()));
    let wrong: Vec<usize> = (20..made.values.len()).step_by(97).collect();
    for index in &wrong {
        made.values[*index] += size;
    }
    let answer = fit(&made, &FitOptions::default()).unwrap();
    assert_eq!(answer.records[0].outliers, wrong);
}
