//! Time of whole responses, with everything that judges them:
//! `cargo bench --workspace --bench response`.

use criterion::{Criterion, criterion_group, criterion_main};
use lindstedt::response::{ResponseRequest, respond};

fn duffing(harmonics: Option<usize>) -> ResponseRequest {
    let equation = "x'' + x'/10 + x + x^3 - F*cos(Omega*t) = 0";
    let question =
        ResponseRequest::new(equation, "Omega", [0.5, 2.5], "F = 3/10").expect("a question");
    ResponseRequest { harmonics, ..question }
}

fn benches(criterion: &mut Criterion) {
    for (name, harmonics) in [("automatic", None), ("20 harmonics", Some(20))] {
        let question = duffing(harmonics);
        criterion.bench_function(&format!("response of Duffing's oscillator, {name}"), |bencher| {
            bencher.iter(|| respond(&question).expect("a response"));
        });
    }
}

criterion_group! {
    name = all;
    config = Criterion::default().sample_size(10);
    targets = benches
}
criterion_main!(all);
