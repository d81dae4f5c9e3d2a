//! A resonance curve with its jumps: steady motions of a driven oscillator followed through their
//! folds, with their stability, as comma-separated values.
//!
//! `cargo run --release --example resonance_curve > curve.csv`

use lindstedt::response::{ResponseRequest, respond};

pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let equation = "x'' + x'/10 + x + x^3 = F*cos(Omega*t)";
    let request = ResponseRequest::new(equation, "Omega", [0.5, 2.5], "F = 3/10")?;
    let diagram = respond(&request)?;
    println!("branch,Omega,amplitude,stable");
    for (number, branch) in diagram.branches.iter().enumerate() {
        for motion in &branch.points {
            let stable = motion.stable.map_or("unknown".to_owned(), |stable| stable.to_string());
            println!("{number},{:.6},{:.6},{stable}", motion.parameter, motion.amplitude);
        }
    }
    for jump in diagram.bifurcations.iter().filter(|found| found.kind.name() == "fold") {
        eprintln!("fold at Omega = {:.4}, amplitude {:.4}", jump.parameter, jump.amplitude);
    }
    Ok(())
}
