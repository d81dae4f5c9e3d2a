//! The derivations and the impact whose speed is promised in the README: `cargo bench`.

use criterion::{Criterion, criterion_group, criterion_main};
use lindstedt::Oscillator;
use lindstedt::contact::hertz::Design;
use lindstedt::contact::linearisation::Rule;
use lindstedt::impact::{self, Setup};
use lindstedt::method::{Options, solve};
use lindstedt::solution::Method;

fn derivations(criterion: &mut Criterion) {
    for (name, equation, method, order) in [
        (
            "Duffing to eps^8, symbolic eps and A",
            "x'' + x + eps*x^3 = 0",
            Method::LindstedtPoincare,
            8,
        ),
        (
            "Duffing to eps^40, symbolic eps and A",
            "x'' + x + eps*x^3 = 0",
            Method::LindstedtPoincare,
            40,
        ),
        ("pendulum to A^20", "x'' + sin(x) = 0", Method::LindstedtPoincare, 20),
        (
            "van der Pol to mu^16",
            "x'' - mu*(1 - x^2)*x' + x = 0",
            Method::LindstedtPoincare,
            16,
        ),
        (
            "a2 a3 a5 symbolic to eps^6",
            "x'' + x + eps*(a2*x^2 + a3*x^3 + a5*x^5) = 0",
            Method::LindstedtPoincare,
            6,
        ),
        (
            "homotopy on Duffing, order 8",
            "x'' + x + eps*x^3 = 0",
            Method::HomotopyPerturbation,
            8,
        ),
    ] {
        let options = Options {
            method: Some(method),
            order: Some(order),
            ..Options::default()
        };
        criterion.bench_function(name, |bencher| {
            bencher.iter(|| {
                let oscillator = Oscillator::parse(equation).expect("an oscillator");
                solve(&oscillator, &options).expect("a solution")
            });
        });
    }
}

fn contact(criterion: &mut Criterion) {
    let stiffness = Design::default().stiffness().expect("a stiffness");
    criterion.bench_function("impact of the paper", |bencher| {
        bencher.iter(|| {
            impact::solve(Setup {
                amplitude: 1.5,
                barrier: 0.323,
                stiffness,
                stiffness_source: String::new(),
                order: 2,
                rule: Rule::default(),
                integrator_tolerance: 1e-10,
            })
            .expect("an impact")
        });
    });
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20);
    targets = derivations, contact
}
criterion_main!(benches);
