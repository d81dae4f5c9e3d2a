//! Time of simulations on one core: `cargo bench --workspace --bench simulate`.
//!
//! A hundredth of the two workloads of `examples/damper_workloads.rs`, one motion at a time and
//! several at a time, and the judge for comparison; and a sweep of an equation of one's own.

use criterion::{Criterion, criterion_group, criterion_main};
use lindstedt::Oscillator;
use lindstedt::impact::{Integrator, Model, Settings, Start, simulate, simulate_many};
use lindstedt::trajectory::{TrajectoryRequest, sweep};

const REST: Start = Start { x: -1.5, velocity: 0.0 };

fn conservative() -> (Vec<(Model, Start)>, Settings) {
    let start = |index: u32| Start { x: -1.5 + 1e-2 * f64::from(index), velocity: 0.0 };
    let motions =
        (0..10).map(|index| (Model { gamma: 1e6, ..Model::default() }, start(index))).collect();
    let options = Settings {
        relative_tolerance: 1e-10,
        absolute_tolerance: 1e-12,
        keep_path: false,
        ..Settings::default()
    };
    (motions, options)
}

fn damped() -> (Vec<(Model, Start)>, Settings) {
    let model = |index: u32| Model {
        gamma: 1e6,
        zeta: 0.01,
        mu: 1e4,
        right: Some(0.05 + 0.005 * f64::from(index)),
        ..Model::default()
    };
    let motions = (0..100).map(|index| (model(index), REST)).collect();
    let options = Settings {
        duration: 1e4,
        relative_tolerance: 1e-8,
        absolute_tolerance: 1e-10,
        rest_energy: Some(1e-3),
        keep_path: false,
        ..Settings::default()
    };
    (motions, options)
}

/// The paper's design with zeta = 0.02 and mu/gamma = 0.1, to rest: what a study asks of each of
/// its designs.
fn to_rest() -> (Vec<(Model, Start)>, Settings) {
    let (_, options) = damped();
    let model = Model { zeta: 0.02, ..Model::default() };
    let model = Model { mu: 0.1 * model.gamma, ..model };
    let options = Settings {
        relative_tolerance: 1e-12,
        absolute_tolerance: 1e-14,
        rest_energy: None,
        stop_at_rest: true,
        ..options
    };
    (vec![(model, REST)], options)
}

fn workloads(criterion: &mut Criterion) {
    for (name, (motions, options)) in
        [("conservative", conservative()), ("damped", damped()), ("to rest", to_rest())]
    {
        criterion.bench_function(&format!("{name}, several at a time"), |bencher| {
            bencher.iter(|| simulate_many(&motions, Integrator::Taylor, &options));
        });
        for (method, integrator) in [
            ("Taylor", Integrator::Taylor),
            ("Runge-Kutta", Integrator::RungeKutta),
            ("chain", Integrator::Chain),
        ] {
            criterion.bench_function(&format!("{name}, one by one, {method}"), |bencher| {
                bencher.iter(|| {
                    for (model, start) in &motions {
                        let _ = std::hint::black_box(simulate(model, *start, integrator, &options));
                    }
                });
            });
        }
    }
}

/// A pendulum with a hundred dampings, as `lindstedt simulate EQUATION --sweep zeta=0.01:0.2:100`
/// follows it, free and against barriers of three stiffnesses, which take the same time.
fn sweep_of_an_equation(criterion: &mut Criterion) {
    let free = "x'' + 2*zeta*x' + sin(x)";
    let against = |stiffness: &str| format!("{free} + {stiffness}*max(x - 0.3, 0)^1.5 = 0");
    for (name, equation) in [
        ("", format!("{free} = 0")),
        (", contact 1e3", against("1e3")),
        (", contact 1e7", against("1e7")),
        (", contact 1e12", against("1e12")),
    ] {
        let equation = Oscillator::parse(&equation).expect("an equation");
        let mut course = TrajectoryRequest::of_equation(&equation);
        course.begin("x".into(), -1.5).expect("a state");
        let dampings: Vec<Vec<f64>> =
            (0..100).map(|index| vec![0.01 + 0.0019 * f64::from(index)]).collect();
        criterion.bench_function(&format!("equation, a sweep of 100 motions{name}"), |bencher| {
            bencher.iter(|| sweep(&course, &["zeta".into()], &dampings, || ()));
        });
    }
}

criterion_group! {
    name = simulations;
    config = Criterion::default().sample_size(10);
    targets = workloads, sweep_of_an_equation
}
criterion_main!(simulations);
