//! A Poincare section of a chaotic motion: the state once a period of the drive, and the time until
//! which its digits hold.
//!
//! `cargo run --release --example poincare_section > section.csv`

use lindstedt::Oscillator;
use lindstedt::expr::parse_expression;
use lindstedt::trajectory::{PoincareSection, TrajectoryRequest};

pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let well = Oscillator::parse("x'' + 0.3*x' - x + x^3 = F*cos(1.2*t)")?;
    let mut request = TrajectoryRequest::of_equation(&well);
    request.values.insert("F".into(), 0.5);
    request.begin("x".into(), 1.0)?;
    request.duration = 1000.0;
    request.after = 200.0;
    request.section = Some(PoincareSection::Every(parse_expression("2*pi/1.2")?));
    let motion = request.follow()?;
    println!("t,x,v");
    for crossing in motion.crossings() {
        println!("{:.4},{:.9},{:.9}", crossing.time, crossing.state[0], crossing.state[1]);
    }
    Ok(())
}
