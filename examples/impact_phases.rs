//! A pendulum that hits an elastic barrier: approach, contact and return in closed form, each beside
//! what Runge-Kutta says of the equation as it stands.
//!
//! `cargo run --release --example impact_phases`

use lindstedt::impact::{Setup, solve};

pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let impact =
        solve(Setup { release: -1.5, barrier: 0.323, stiffness: 1e6, ..Setup::default() })?;
    println!("{}", impact.equation);
    for column in &impact.columns {
        println!("\n{}", column.reading.name());
        for phase in &column.phases.phases {
            println!("  {}", phase.closed_form());
        }
    }
    Ok(())
}
