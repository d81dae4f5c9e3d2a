//! A pendulum of two equal links, from its equations as text: its motion by Taylor series, checked
//! by its energy and by Runge-Kutta.
//!
//! `cargo run --example two_links`. Angles a and b from the vertical, rates p and q; length, mass
//! and gravity are one.

use std::fmt::Write;

use lindstedt::expr::parse_expression;
use lindstedt::system::{Event, Integrator, System, SystemOptions};

const EQUATIONS: [(&str, &str); 4] = [
    ("a", "p"),
    ("b", "q"),
    ("p", "(-2*sin(a) + cos(a - b)*sin(b) - sin(a - b)*(q^2 + cos(a - b)*p^2))/(2 - cos(a - b)^2)"),
    (
        "q",
        "(2*cos(a - b)*sin(a) - 2*sin(b) + sin(a - b)*(2*p^2 + cos(a - b)*q^2))/(2 - cos(a - b)^2)",
    ),
];

const END: f64 = 20.0;

pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    print!("{}", report()?);
    Ok(())
}

/// What is printed.
pub fn report() -> Result<String, Box<dyn std::error::Error>> {
    let links = System::parse(&EQUATIONS, &[])?;
    let start = [1.5, -0.5, 0.0, 0.0];
    let upright = Event::record(parse_expression("a")?);
    let path = links.solve([0.0, END], &start, &[upright], &SystemOptions::default())?;
    let by_runge_kutta =
        SystemOptions { integrator: Integrator::RungeKutta, ..SystemOptions::default() };
    let check = links.solve([0.0, END], &start, &[], &by_runge_kutta)?;

    let mut out = String::from("Two links, released at rest\n\n     t          a          b\n");
    let (mut drift, mut difference) = (0.0_f64, 0.0_f64);
    for index in 0..=200 {
        let time = END * f64::from(index) / 200.0;
        let state = path.states_at(time).ok_or("the motion ends before")?;
        let other = check.states_at(time).ok_or("the motion ends before")?;
        drift = drift.max((energy(&state) - energy(&start)).abs());
        for (one, other) in state.iter().zip(other) {
            difference = difference.max((one - other).abs());
        }
        if index % 20 == 0 {
            writeln!(out, "{time:6.1} {:10.6} {:10.6}", state[0], state[1])?;
        }
    }
    let times: Vec<String> =
        path.occurrences().iter().map(|met| format!("{:.6}", met.time)).collect();
    writeln!(out, "\nthe upper link is vertical at t = {}", times.join(", "))?;
    writeln!(out, "the energy is kept to 1e-12: {}", drift < 1e-12)?;
    writeln!(out, "Runge-Kutta agrees to 1e-10: {}", difference < 1e-10)?;
    Ok(out)
}

/// Kinetic and potential.
fn energy(state: &[f64]) -> f64 {
    let [a, b, p, q] = [state[0], state[1], state[2], state[3]];
    p * p + 0.5 * q * q + (a - b).cos() * p * q - 2.0 * a.cos() - b.cos()
}
