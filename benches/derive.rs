//! The derivations and the impact whose speed is promised in the README: `cargo bench --workspace`.

use criterion::{Criterion, criterion_group, criterion_main};
use lindstedt::Oscillator;
use lindstedt::Values;
use lindstedt::impact::hertz::StiffnessDesign;
use lindstedt::impact::{self, Setup};
use lindstedt::method::{Options, numbers, solve};
use lindstedt::solution::{Degrees, Method};
use lindstedt::verify::comparison::compare;
use lindstedt::verify::judge;

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
        ("van der Pol to mu^16", "x'' - mu*(1 - x^2)*x' + x = 0", Method::LindstedtPoincare, 16),
        (
            "a2 a3 a5 symbolic to eps^6",
            "x'' + x + eps*(a2*x^2 + a3*x^3 + a5*x^5) = 0",
            Method::LindstedtPoincare,
            6,
        ),
        ("homotopy on Duffing, order 8", "x'' + x + eps*x^3 = 0", Method::HomotopyPerturbation, 8),
    ] {
        let options = Options { method: Some(method), order: Some(order), ..Options::default() };
        criterion.bench_function(name, |bencher| {
            bencher.iter(|| {
                let oscillator = Oscillator::parse(equation).expect("an oscillator");
                solve(&oscillator, &options).expect("a solution")
            });
        });
    }
}

/// Measures the calculations that take longest for a user: homotopy analysis by its order, hbar
/// sought at each of many amplitudes; an approximant with numbers of thousands of digits; a table of a force with a root.
fn waiting(criterion: &mut Criterion) {
    let pendulum = Oscillator::parse("x'' + sin(x) = 0").expect("an oscillator");
    let at = Values::try_from([("A", 2.0)]).expect("values");
    for order in [3, 4, 5] {
        let method = Some(Method::HomotopyAnalysis);
        let options = Options { method, order: Some(order), ..Options::default() };
        criterion.bench_function(
            &format!("homotopy analysis of order {order}, judged"),
            |bencher| {
                bencher.iter(|| {
                    let solution = solve(&pendulum, &options).expect("a solution");
                    judge(&pendulum, &solution, &at, 0.01).expect("a verdict")
                });
            },
        );
    }
    let cycle = Oscillator::parse("x'' - mu*(1 - x^2)*x' + x = 0").expect("an oscillator");
    let degrees = Some(Degrees::Quotient(40, 40));
    let options = Options { method: Some(Method::Pade), degrees, ..Options::default() };
    let solution = solve(&cycle, &options).expect("an approximant");
    let at = Values::try_from([("mu", 5.0)]).expect("values");
    criterion.bench_function("van der Pol [40/40] judged", |bencher| {
        bencher.iter(|| judge(&cycle, &solution, &at, 0.01).expect("a verdict"));
    });
    let root = Oscillator::parse("x'' + x^(1/3) = 0").expect("an oscillator");
    let at = Values::try_from([("A", 1.0)]).expect("values");
    criterion.bench_function("every method compared, cube root", |bencher| {
        bencher.iter(|| compare(&root, &at, None, 0.01).expect("a table"));
    });
}

/// The balance of many harmonics, and the whole table.
fn methods(criterion: &mut Criterion) {
    for (name, equation) in [("Duffing", "x'' + x + x^3 = 0"), ("pendulum", "x'' + sin(x) = 0")] {
        let oscillator = Oscillator::parse(equation).expect("an oscillator");
        let options = Options {
            method: Some(Method::HarmonicBalance),
            order: Some(20),
            ..Options::default()
        };
        let at = [("A".into(), 2.0)].into();
        criterion.bench_function(&format!("20 harmonics balanced, {name}"), |bencher| {
            bencher.iter(|| {
                let solution = solve(&oscillator, &options).expect("a balance");
                numbers::evaluate(&oscillator, &solution, &at).expect("numbers")
            });
        });
        let mut values = Values::default();
        values.insert("A".into(), "3/2".parse().expect("a number")).expect("a value");
        criterion.bench_function(&format!("every method compared, {name}"), |bencher| {
            bencher.iter(|| compare(&oscillator, &values, None, 0.01).expect("a table"));
        });
    }
}

fn contact(criterion: &mut Criterion) {
    let stiffness = StiffnessDesign::default().stiffness().expect("a stiffness");
    criterion.bench_function("impact of the paper", |bencher| {
        bencher.iter(|| impact::solve(Setup { stiffness, ..Setup::default() }).expect("an impact"));
    });
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(20);
    targets = derivations, waiting, methods, contact
}
criterion_main!(benches);
