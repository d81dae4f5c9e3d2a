//! Time of a search on one core: `cargo bench --workspace --bench optimize`.
//!
//! One design by closed forms, one run of the genetic algorithm of the paper's study (a hundredth
//! of it), and what stands beside the runs.

use criterion::{Criterion, criterion_group, criterion_main};
use lindstedt::genetic::{generator, one_by_one, search};
use lindstedt::optimize::{OptimizationProblem, Route, StudyObserver, optimize};

fn benches(criterion: &mut Criterion) {
    let question = OptimizationProblem::default();
    let space = question.space().expect("a box");
    let middle = space.point_at(&[0.5; 4]);
    criterion.bench_function("optimize/one design", |bencher| {
        bencher.iter(|| question.follow(&middle, Route::Chain, false));
    });
    criterion.bench_function("optimize/one design with its greatest force", |bencher| {
        bencher.iter(|| question.follow(&middle, Route::Chain, true));
    });
    criterion.bench_function("optimize/one design, integrated", |bencher| {
        bencher.iter(|| question.follow(&middle, Route::Integration, false));
    });
    let mut slow = criterion.benchmark_group("optimize");
    slow.sample_size(10);
    slow.bench_function("one run", |bencher| {
        bencher.iter(|| {
            let evaluate = |point: &[f64]| match question.follow(point, Route::Chain, false) {
                Ok(design) => question.evaluation(&design),
                Err(_) => lindstedt::genetic::Evaluation::unconstrained(f64::INFINITY),
            };
            search(
                &space,
                one_by_one(evaluate),
                &question.genetic,
                &mut generator(1, 0),
                &mut |_| true,
            )
        });
    });
    slow.bench_function("a study of two runs", |bencher| {
        let two = OptimizationProblem { runs: 2, ..question.clone() };
        bencher.iter(|| optimize(two.clone(), vec![], &StudyObserver::default()));
    });
}

criterion_group!(all, benches);
criterion_main!(all);
