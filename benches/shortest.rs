//! Shortest laws: the search by greatest length, and the proof of a law by its error.
//! `cargo bench --workspace -- shortest`.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use lindstedt::certificate::{LawCertificate, LawQuantity, MotionsOfLaw, StartOfLaw, check_law};
use lindstedt::shortest::{LawProblem, SearchOptions, search};
use lindstedt::{Oscillator, Supervision};

fn searches(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("shortest: search");
    group.sample_size(10);
    let pendulum = Oscillator::parse("x'' + sin(x) = 0").expect("an equation");
    let ends = ["0", "14/5"].map(|end| end.parse().expect("a fraction"));
    let varying = "A".parse().expect("an expression");
    let at = "".parse().expect("no values");
    for longest in [6, 9, 12] {
        group.bench_function(BenchmarkId::new("pendulum", longest), |bencher| {
            bencher.iter(|| {
                let problem = LawProblem::new(&pendulum, &varying, (&ends[0], Some(&ends[1])), &at);
                let options = SearchOptions::new(LawQuantity::Frequency, longest);
                search(problem.expect("a problem"), &options, Supervision::default()).expect("laws")
            });
        });
    }
}

fn proofs(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("shortest: proof");
    group.sample_size(10);
    for (law, claim) in [
        ("2/5 + 3*cos(A/2)/5", "4/100"),
        ("6/25 + 241*cos(A/2)/1000 + 13*sqrt(cos(A/2))/25", "11/10000"),
        ("(sqrt(sqrt(cos(A/2)))/2 + 7071*sqrt(1 + cos(A/2))/20000)^2", "975/100000000"),
    ] {
        let fraction = |text: &str| text.parse().expect("a fraction");
        let certificate = LawCertificate {
            motions: MotionsOfLaw::Coordinate {
                force: "sin(x)".parse().expect("an expression"),
                mass: None,
                start: StartOfLaw::Variable,
            },
            variable: "A".into(),
            quantity: LawQuantity::Frequency,
            law: law.parse().expect("an expression"),
            from: fraction("0"),
            to: Some(fraction("14/5")),
            worst: fraction("1"),
            claim: [fraction("0"), fraction(claim)],
        };
        group.bench_function(BenchmarkId::new("pendulum", claim), |bencher| {
            bencher.iter(|| check_law(&certificate).expect("a proof"));
        });
    }
}

criterion_group!(benches, searches, proofs);
criterion_main!(benches);
