//! Two workloads of the damper, timed on one core: what `benches/simulate.rs` measures, with the results to compare.
//!
//! W5: 1000 conservative motions to t = 50. W6: 10 000 damped ones until the energy is below 1e-3.

use std::time::Instant;

use lindstedt::damper::{Integrator, Model, Options, Simulation, Start, simulate};

fn main() {
    let begin = Instant::now();
    let w5: Vec<Simulation> = (0..1000)
        .map(|i| {
            let model = Model::default();
            let start = Start {
                x: -1.5 + 1e-4 * f64::from(i),
                velocity: 0.0,
            };
            let options = Options {
                keep_path: false,
                ..Options::default()
            };
            simulate(&model, start, Integrator::Taylor, &options).expect("a motion")
        })
        .collect();
    report("W5", begin, &w5);
    let begin = Instant::now();
    let w6: Vec<Simulation> = (0..10_000)
        .map(|i| {
            let model = Model {
                zeta: 0.01,
                mu: 1e4,
                right: Some(0.05 + 0.5 * f64::from(i) / 10_000.0),
                ..Model::default()
            };
            let options = Options {
                duration: 1e4,
                relative_tolerance: 1e-8,
                absolute_tolerance: 1e-10,
                rest_energy: Some(1e-3),
                keep_path: false,
                ..Options::default()
            };
            simulate(&model, Start { x: -1.5, velocity: 0.0 }, Integrator::Taylor, &options).expect("a motion")
        })
        .collect();
    report("W6", begin, &w6);
}

fn report(name: &str, begin: Instant, runs: &[Simulation]) {
    let seconds = begin.elapsed().as_secs_f64();
    let impacts: usize = runs.iter().map(|run| run.impacts.len()).sum();
    let steps: usize = runs.iter().map(|run| run.steps).sum();
    println!("{name}: {seconds:.4} s, {impacts} impacts, {steps} steps");
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
