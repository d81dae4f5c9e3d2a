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

/// Duffing's oscillator with a contact in place of the cubic spring.
fn contact(stiffness: &str) -> ResponseRequest {
    let equation = "x'' + x'/10 + x + g*max(x - 0.5, 0)^1.5 - F*cos(Omega*t) = 0";
    let values = format!("F = 3/10, g = {stiffness}");
    ResponseRequest::new(equation, "Omega", [0.5, 2.5], &values).expect("a question")
}

fn benches(criterion: &mut Criterion) {
    for stiffness in ["1e3", "1e6", "1e9"] {
        let question = contact(stiffness);
        criterion.bench_function(&format!("response with contact, g = {stiffness}"), |bencher| {
            bencher.iter(|| respond(&question).expect("a response"));
        });
    }
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
