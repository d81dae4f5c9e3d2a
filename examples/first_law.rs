//! A frequency law of an equation of one's own: derived, printed, evaluated, handed on.
//!
//! `cargo run --release --example first_law`

use lindstedt::export::code::Language;
use lindstedt::export::{code, latex};
use lindstedt::{Options, Oscillator, Values, solve};

pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let duffing = Oscillator::parse("x'' + omega0^2*x + eps*x^3 = 0")?;
    let law = solve(&duffing, &Options { order: Some(2), ..Options::default() })?;
    println!("{}", law.formula());

    // The motion released at x = A, at one time and as a formula for a program.
    let at = Values::try_from([("omega0", 2.0), ("eps", 0.3), ("A", 1.0)])?;
    println!("x(t) = {}", law.motion_at(&at)?);
    println!("x(1) = {:.9}", law.displacement_at(1.0, &at)?);
    println!("{}", latex::solution(&law, None));
    println!("{}", code::solution(&duffing, &law, None, Language::Python)?);
    Ok(())
}
