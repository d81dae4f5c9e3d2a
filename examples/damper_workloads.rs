//! Two workloads of the damper, timed on one core: what `benches/simulate.rs` measures, with the
//! results to compare.
//!
//! W5: 1000 conservative motions to t = 50. W6: 10 000 damped ones until the energy is below 1e-3.
//! Each one by one, and then several at a time, which must give the same to the last bit. At last
//! the rest times of the damped ones by closed forms, beside the integration at the tolerance of
//! the program.

use std::time::Instant;

use lindstedt::impact::{Integrator, Model, Settings, Simulation, Start, simulate, simulate_many};

fn main() {
    let w5: Vec<(Model, Start)> = (0..1000)
        .map(|i| {
            let x = -1.5 + 1e-4 * f64::from(i);
            (Model { gamma: 1e6, ..Model::default() }, Start { x, velocity: 0.0 })
        })
        .collect();
    let options = Settings {
        relative_tolerance: 1e-10,
        absolute_tolerance: 1e-12,
        keep_path: false,
        ..Settings::default()
    };
    measure("W5", &w5, &options);
    let w6: Vec<(Model, Start)> = (0..10_000)
        .map(|i| {
            let model = Model {
                gamma: 1e6,
                zeta: 0.01,
                mu: 1e4,
                right: Some(0.05 + 0.5 * f64::from(i) / 10_000.0),
                ..Model::default()
            };
            (model, Start { x: -1.5, velocity: 0.0 })
        })
        .collect();
    let options = Settings {
        duration: 1e4,
        relative_tolerance: 1e-8,
        absolute_tolerance: 1e-10,
        rest_energy: Some(1e-3),
        ..options
    };
    measure("W6", &w6, &options);
    chains(&w6);
}

/// Number of motions that a sweep runs on a core before it asks for more.
const BLOCK: usize = 96;

/// The rest times by the chain, one by one and several at a time, and by integration, and how far
/// they are apart.
fn chains(motions: &[(Model, Start)]) {
    let options =
        Settings { duration: 1e4, keep_path: false, stop_at_rest: true, ..Settings::default() };
    let rest = |motion: &Simulation| motion.rest().time.expect("it rests");
    let one_by_one = |integrator| {
        let begin = Instant::now();
        let motion = |(model, start): &(Model, Start)| {
            rest(&simulate(model, *start, integrator, &options).expect("a motion"))
        };
        let times: Vec<f64> = motions.iter().map(motion).collect();
        (begin.elapsed().as_secs_f64(), times)
    };
    let (alone, single) = one_by_one(Integrator::Chain);
    let begin = Instant::now();
    // In blocks, as a sweep runs them: the memory of the impacts of one serves the next.
    let block = |motions: &[(Model, Start)]| {
        let runs = simulate_many(motions, Integrator::Chain, &options).expect("motions");
        runs.iter().map(rest).collect::<Vec<f64>>()
    };
    let found: Vec<f64> = motions.chunks(BLOCK).flat_map(block).collect();
    let together = begin.elapsed().as_secs_f64();
    let (integrated, truth) = one_by_one(Integrator::Taylor);
    let errors = found.iter().zip(&truth).map(|(found, truth)| (found / truth - 1.0).abs());
    let same = found.iter().zip(&single).all(|(one, other)| one.to_bits() == other.to_bits());
    println!(
        "rest times by chain: {together:.4} s ({alone:.4} s one by one), by integration one by one {integrated:.4} s, \
         {:.1} times as long ({:.1}); at most {:.4} % apart",
        integrated / together,
        integrated / alone,
        100.0 * errors.fold(0.0, f64::max)
    );
    println!("  the same one by one and together: {same}");
}

fn measure(name: &str, motions: &[(Model, Start)], options: &Settings) {
    let begin = Instant::now();
    let single: Vec<Simulation> = motions
        .iter()
        .map(|(model, start)| {
            simulate(model, *start, Integrator::Taylor, options).expect("a motion")
        })
        .collect();
    let one_by_one = begin.elapsed().as_secs_f64();
    let begin = Instant::now();
    let runs = simulate_many(motions, Integrator::Taylor, options).expect("motions");
    let together = begin.elapsed().as_secs_f64();
    let impacts: usize = runs.iter().map(|run| run.impacts.len()).sum();
    let steps: usize = runs.iter().map(|run| run.steps).sum();
    println!(
        "{name}: {together:.4} s ({one_by_one:.4} s one by one), {impacts} impacts, {steps} steps"
    );
    let same = single.iter().zip(&runs).all(|(one, other)| {
        let bits = |run: &Simulation| [run.end_time, run.end_x, run.end_velocity].map(f64::to_bits);
        bits(one) == bits(other) && one.impacts == other.impacts
    });
    println!("  the same one by one and together: {same}");
    for index in [0, runs.len() / 2, runs.len() - 1] {
        let run = &runs[index];
        println!(
            "  run {index}: t = {:.15}, x = {:.15}, x' = {:.15}, {} impacts",
            run.end_time,
            run.end_x,
            run.end_velocity,
            run.impacts.len()
        );
    }
}
