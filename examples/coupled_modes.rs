//! Two coupled pendulums: equations of motion from their energies, and the modes about rest.
//!
//! `cargo run --release --example coupled_modes`

use lindstedt::Values;
use lindstedt::mechanics::{Mechanism, Modes, equilibria};

pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let pendulums = Mechanism::parse(
        &["a", "b"],
        "m*L^2*(a'^2 + b'^2)/2",
        "-m*g*L*(cos(a) + cos(b)) + k*(a - b)^2/2",
    )?;
    let equations = pendulums.equations()?;
    println!("{equations}\n");

    let at = Values::try_from([("m", 1.0), ("L", 1.0), ("g", 9.81), ("k", 0.5)])?;
    for rest in equilibria(&equations)? {
        for (coordinate, place) in rest.values(&pendulums.coordinates) {
            print!("{coordinate} = {place}  ");
        }
        println!("at rest");
        for mode in Modes::about_rest(&equations, &rest)?.numbers(&at.numbers())? {
            println!(
                "  {:.6} rad/s, growth {:.6}, shape {:?}",
                mode.frequency, mode.growth, mode.shape
            );
        }
    }
    Ok(())
}
