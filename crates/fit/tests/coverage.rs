//! Whether the errors are true: records of known laws, fitted, and held against the truth.
//!
//! The long run: `cargo test --release -p lindstedt-fit --test coverage -- --ignored --nocapture`; the number of
//! records and the first seed are `LINDSTEDT_FIT_RECORDS` and `LINDSTEDT_FIT_SEED`.

mod synthetic;

use std::collections::BTreeMap;

use lindstedt_fit::answer::{FitOptions, fit};
use lindstedt_fit::laws::{Loss, Spring};
use synthetic::synthetic;

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

fn run(seeds: impl Iterator<Item = u64>, is_talkative: bool) -> Tally {
    let mut tally = Tally::default();
    for seed in seeds {
        let made = synthetic(seed);
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
        if is_talkative && duration.as_secs_f64() > 3.0 {
            eprintln!("  {duration:?} {} laws {:?}", made.words, answer.laws.iter().map(|l| (l.law.name.clone(), l.converged)).collect::<Vec<_>>());
        }
        let is_first = answer.laws[0].law.parts == parts;
        tally.right_first += usize::from(is_first);
        let Some(own) = answer.laws.iter().find(|law| law.law.parts == parts) else {
            tally.failures.push(format!("{}: the law was not tried; first {}", made.words, answer.laws[0].law.name));
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
            eprintln!("{} in {duration:?}: {} far: {far:?} length {:.2} outliers {}", made.words,
                if is_first { "right".to_owned() } else { format!("{} first by {behind:.1}", first.law.name) },
                answer.correlation_length, answer.outliers.len());
        }
    }
    tally
}

impl Tally {
    fn report(&self) {
        eprintln!("{} records, {} without an answer, right law first {}, {} of {} intervals cover", self.records,
            self.failures.len(), self.right_first, self.covered, self.intervals);
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
    let tally = run(first..first + number("LINDSTEDT_FIT_RECORDS", 300), true);
    tally.report();
    eprintln!("{:?}", begin.elapsed());
}

#[test]
#[ignore]
fn one() {
    let seed = std::env::var("LINDSTEDT_FIT_SEED").unwrap().parse().unwrap();
    let made = synthetic(seed);
    eprintln!("{} {:?}", made.words, made.truth);
    let answer = fit(&made.record, &FitOptions::default()).unwrap();
    for law in &answer.laws {
        eprintln!("{:50} bic {:.1} chi {:.4} conv {} {:?} flat {:?}", law.law.name, law.bic, law.chi_square, law.converged, law.estimates.iter().map(|e| format!("{} {:.6}({:.1e})", e.name, e.value, e.error)).collect::<Vec<_>>(), law.flat);
    }
    eprintln!("{:?} {:?} {}", answer.noise, answer.swings.noise, answer.correlation_length);
}

/// The example of a pendulum with viscous damping and dry friction, 60 s at 200 Hz with 0.3 degrees of noise.
fn pendulum(seed: u64) -> lindstedt_fit::record::Record {
    use rand::SeedableRng;
    let mut generator = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
    let times: Vec<f64> = (0..12_000).map(|index| f64::from(index) / 200.0).collect();
    let truth = [("w", std::f64::consts::TAU), ("zeta", 0.004), ("alpha", 0.003)];
    let (spring, loss) = (Spring::Pendulum, Loss::ViscousAndCoulomb);
    let motion = synthetic::motion(spring, loss, &truth, [1.4, 0.0], &times);
    let noise = 0.3_f64.to_radians();
    let values = motion.iter().map(|x| x + noise * synthetic::normal(&mut generator));
    lindstedt_fit::record::Record { values: values.collect(), times, is_angle: true, ..Default::default() }
}

#[test]
fn a_pendulum_with_viscous_damping_and_dry_friction_is_told_apart() {
    let begin = std::time::Instant::now();
    let answer = fit(&pendulum(1), &FitOptions::default()).unwrap();
    eprintln!("{:?}", begin.elapsed());
    let best = &answer.laws[0];
    for line in answer.exclusions() { eprintln!("{line}"); }
    for estimate in &best.estimates { eprintln!("{estimate:?}"); }
    assert_eq!(best.law.parts, Some((Spring::Pendulum, Loss::ViscousAndCoulomb)));
    for (name, value, error) in [("zeta", 0.004, 1e-5), ("alpha", 0.003, 1e-4)] {
        let own = best.estimate(name).unwrap();
        assert!((own.value - value).abs() < 3.0 * own.error && own.error < error, "{own:?}");
    }
}
