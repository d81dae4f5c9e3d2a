//! The damper against truths that it does not know: elliptic functions, quadrature, the other
//! integrator, itself with a tighter tolerance.

mod books;
mod chain;
mod contact;
mod equations;
mod exact;
mod friction;
mod integrators;
mod many;
mod refusals;
mod rest;

use lindstedt::impact::{Integrator, Model, Settings, Simulation, Start, simulate};

const REST: Start = Start { x: -1.5, velocity: 0.0 };

fn run(
    model: &Model,
    start: Start,
    tolerance: f64,
    duration: f64,
    integrator: Integrator,
) -> Simulation {
    let options = Settings {
        duration,
        relative_tolerance: tolerance,
        absolute_tolerance: 1e-2 * tolerance,
        ..Settings::default()
    };
    simulate(model, start, integrator, &options).expect("a motion")
}

/// As accurate as a run by the program with this `integrator_tolerance`, whose steps get a
/// hundredth of it.
fn taylor(model: &Model, start: Start, tolerance: f64, duration: f64) -> Simulation {
    run(model, start, (1e-2 * tolerance).max(1e-15), duration, Integrator::Taylor)
}
