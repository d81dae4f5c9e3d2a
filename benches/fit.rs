//! The laws of a measurement, for records of three lengths: the work is proportional to the samples.
//!
//! `cargo bench --workspace -- fit`.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use lindstedt::fit::answer::{FitOptions, fit};
use lindstedt::fit::record::{ReadOptions, Record, read};

/// The example of the page, a pendulum with two kinds of damping.
const PENDULUM: &str = include_str!("../examples/fit/pendulum.csv");

fn laws_of_a_pendulum(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("fit: laws of a pendulum");
    group.sample_size(10);
    let records = read(PENDULUM, &ReadOptions::default()).expect("a record");
    let record = &records[0].record;
    for step in [4, 2, 1] {
        let few = |values: &[f64]| values.iter().copied().step_by(step).collect::<Vec<_>>();
        let record =
            Record { times: few(&record.times), values: few(&record.values), ..record.clone() };
        group.bench_function(BenchmarkId::from_parameter(record.times.len()), |bencher| {
            bencher.iter(|| fit(black_box(&record), &FitOptions::default()));
        });
    }
    group.finish();
}

criterion_group!(benches, laws_of_a_pendulum);
criterion_main!(benches);
