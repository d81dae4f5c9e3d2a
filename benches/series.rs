//! The exact core by itself: numbers by primes and over whole numbers, and symbols.
//! `cargo bench --workspace -- series`.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use lindstedt::Symbol;
use lindstedt::exact::{Integers, Polynomial, Polynomials, Ring, factorial};
use lindstedt::method::secular::{
    AmplitudeKind, Detuning, ExpansionScope, ForceTerm, Scheme, expand, expand_numbers,
    expand_polynomials,
};
use lindstedt::series::FourierSeries;
use lindstedt::solution::AmplitudeConvention;

fn scheme(amplitude: AmplitudeKind) -> Scheme {
    Scheme {
        normalisation: AmplitudeConvention::Initial,
        amplitude,
        detuning: Detuning::Acceleration,
    }
}

fn term<R: Ring>(position: u32, velocity: u32, coefficient: FourierSeries<R>) -> ForceTerm<R> {
    ForceTerm { order: 1, position, velocity, coefficient }
}

/// `sin x - x` to an order in `A^2`.
fn pendulum(highest: usize) -> Vec<ForceTerm<Integers>> {
    let of_order = |order: usize| {
        let sign = if order.is_multiple_of(2) { 1 } else { -1 };
        let coefficient =
            FourierSeries::integer(Integers, sign).over(&factorial(2 * order as u32 + 1));
        ForceTerm { order, ..term(2 * order as u32 + 1, 0, coefficient) }
    };
    (1..=highest).map(of_order).collect()
}

fn numbers(criterion: &mut Criterion) {
    let integer = |value| FourierSeries::integer(Integers, value);
    let duffing = vec![term(3, 0, integer(1))];
    let van_der_pol = vec![term(2, 1, integer(4)), term(0, 1, integer(-1))];
    let works = [
        ("Duffing", duffing, AmplitudeKind::Free, [5, 10, 20, 40, 80]),
        ("pendulum", pendulum(40), AmplitudeKind::Free, [5, 10, 20, 30, 40]),
        ("van der Pol", van_der_pol, AmplitudeKind::Determined, [4, 8, 16, 32, 64]),
    ];
    for (name, force, amplitude, orders) in works {
        let mut group = criterion.benchmark_group(format!("series: {name}"));
        group.sample_size(10);
        for order in orders {
            let scheme = scheme(amplitude);
            let within = force.iter().take_while(|term| term.order <= order).count();
            let force = &force[..within];
            group.bench_function(BenchmarkId::new("motion", order), |bencher| {
                bencher.iter(|| {
                    expand_numbers(force, order, &scheme, ExpansionScope::Motion)
                        .expect("an expansion")
                });
            });
            group.bench_function(BenchmarkId::new("frequency alone", order), |bencher| {
                bencher.iter(|| {
                    expand_numbers(force, order, &scheme, ExpansionScope::Frequency)
                        .expect("an expansion")
                });
            });
            // What it was before, and is where an equation has no symmetry.
            if order <= 20 {
                group.bench_function(BenchmarkId::new("over whole numbers", order), |bencher| {
                    bencher
                        .iter(|| expand(&Integers, force, order, &scheme).expect("an expansion"));
                });
            }
        }
    }
}

fn symbols(criterion: &mut Criterion) {
    let ring = Polynomials(Integers);
    let letter = |name| FourierSeries::constant(ring, Polynomial::symbol(Symbol::new(name)));
    let force = [term(2, 0, letter("a2")), term(3, 0, letter("a3")), term(5, 0, letter("a5"))];
    let scheme = scheme(AmplitudeKind::Free);
    let mut group = criterion.benchmark_group("series: three symbols");
    group.sample_size(10);
    for order in [2, 4, 6, 8] {
        group.bench_function(BenchmarkId::new("motion", order), |bencher| {
            bencher.iter(|| {
                expand_polynomials(&force, order, &scheme, ExpansionScope::Motion)
                    .expect("an expansion")
            });
        });
        group.bench_function(BenchmarkId::new("frequency alone", order), |bencher| {
            bencher.iter(|| {
                expand_polynomials(&force, order, &scheme, ExpansionScope::Frequency)
                    .expect("an expansion")
            });
        });
        group.bench_function(BenchmarkId::new("over polynomials", order), |bencher| {
            bencher.iter(|| expand(&ring, &force, order, &scheme).expect("an expansion"));
        });
    }
}

criterion_group!(benches, numbers, symbols);
criterion_main!(benches);
