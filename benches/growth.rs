//! Growth of the time with the size of a question, over three sizes each:
//! `cargo bench --workspace --bench growth`. docs/performance.md has whole processes with their memory.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use lindstedt::Oscillator;
use lindstedt::method::{Options, numbers, solve};
use lindstedt::response::{ResponseRequest, respond};
use lindstedt::solution::Method;
use lindstedt::trajectory::{TrajectoryRequest, sweep};

const DUFFING: &str = "x'' + x + eps*x^3 = 0";
const VAN_DER_POL: &str = "x'' - mu*(1 - x^2)*x' + x = 0";

/// Orders of an exact series.
fn order(criterion: &mut Criterion) {
    for (name, equation, orders) in
        [("Duffing", DUFFING, [20, 40, 80]), ("van der Pol", VAN_DER_POL, [16, 32, 64])]
    {
        let mut group = criterion.benchmark_group(format!("growth: order, {name}"));
        let oscillator = Oscillator::parse(equation).expect("an oscillator");
        for order in orders {
            let options = Options {
                method: Some(Method::LindstedtPoincare),
                order: Some(order),
                ..Options::default()
            };
            group.bench_function(BenchmarkId::from_parameter(order), |bencher| {
                bencher.iter(|| solve(&oscillator, &options).expect("a solution"));
            });
        }
    }
}

/// Harmonics of a balance and of a response.
fn harmonics(criterion: &mut Criterion) {
    let oscillator = Oscillator::parse("x'' + sin(x) = 0").expect("an oscillator");
    let at = [("A".into(), 2.0)].into();
    let mut balance = criterion.benchmark_group("growth: harmonics of a balance");
    for order in [4, 8, 16] {
        let options = Options {
            method: Some(Method::HarmonicBalance),
            order: Some(order),
            ..Options::default()
        };
        balance.bench_function(BenchmarkId::from_parameter(order), |bencher| {
            bencher.iter(|| {
                let solution = solve(&oscillator, &options).expect("a balance");
                numbers::evaluate(&oscillator, &solution, &at).expect("numbers")
            });
        });
    }
    balance.finish();
    let equation = "x'' + x'/10 + x + x^3 - F*cos(Omega*t) = 0";
    let question =
        ResponseRequest::new(equation, "Omega", [0.5, 2.5], "F = 3/10").expect("a question");
    let mut response = criterion.benchmark_group("growth: harmonics of a response");
    for harmonics in [8, 16, 32] {
        let question = ResponseRequest { harmonics: Some(harmonics), ..question.clone() };
        response.bench_function(BenchmarkId::from_parameter(harmonics), |bencher| {
            bencher.iter(|| respond(&question).expect("a response"));
        });
    }
}

/// Points of a sweep, duration and stiffness of a motion.
fn motions(criterion: &mut Criterion) {
    let course = |equation: &str, duration: f64| {
        let equation = Oscillator::parse(equation).expect("an equation");
        let mut course = TrajectoryRequest::of_equation(&equation);
        course.begin("x".into(), -1.5).expect("a state");
        TrajectoryRequest { duration, step_limit: 1_000_000, ..course }
    };
    let pendulum = course("x'' + 2*zeta*x' + sin(x) = 0", 50.0);
    let mut points = criterion.benchmark_group("growth: points of a sweep");
    for count in [100, 400, 1600] {
        let dampings: Vec<Vec<f64>> = (0..count)
            .map(|index| vec![0.01 + 0.19 * f64::from(index) / f64::from(count)])
            .collect();
        points.bench_function(BenchmarkId::from_parameter(count), |bencher| {
            bencher.iter(|| sweep(&pendulum, &["zeta".into()], &dampings, || ()));
        });
    }
    points.finish();
    let wells = "x'' + x'/10 - x + x^3 - 0.3*cos(t) = 0";
    let mut durations = criterion.benchmark_group("growth: duration");
    for duration in [100.0, 1000.0, 10_000.0] {
        durations.bench_function(BenchmarkId::from_parameter(duration), |bencher| {
            bencher.iter(|| course(wells, duration).follow().expect("a motion"));
        });
    }
    durations.finish();
    let mut stiffnesses = criterion.benchmark_group("growth: stiffness of a contact");
    for stiffness in ["1e3", "1e7", "1e12"] {
        let against = format!("x'' + x + {stiffness}*max(x - 0.3, 0)^1.5 = 0");
        stiffnesses.bench_function(BenchmarkId::from_parameter(stiffness), |bencher| {
            bencher.iter(|| course(&against, 500.0).follow().expect("a motion"));
        });
    }
}

criterion_group! {
    name = growth;
    config = Criterion::default().sample_size(10);
    targets = order, harmonics, motions
}
criterion_main!(growth);
