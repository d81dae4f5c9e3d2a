//! The method of multiple scales against published slow equations, against true motions, and put
//! back into the equation.
//!
//! - Duffing, pendulum, van der Pol: A. H. Nayfeh, D. T. Mook, *Nonlinear Oscillations*, Wiley
//!   1979, chapters 2 and 3.

mod driven;
mod drives;
mod free;

use lindstedt::Oscillator;
use lindstedt::exact::Polynomial;
use lindstedt::expr::{Expr, parse_expression};
use lindstedt::method::{Options, solve};
use lindstedt::solution::{Method, Solution};

fn options(order: u32) -> Options {
    Options { method: Some(Method::MultipleScales), order: Some(order), ..Options::default() }
}

fn derive(equation: &str, order: u32) -> Solution {
    let oscillator = Oscillator::parse(equation).expect("an oscillator");
    solve(&oscillator, &options(order)).unwrap_or_else(|refusal| panic!("{equation}: {refusal}"))
}

fn of_text(text: &str) -> Polynomial {
    of_expression(&parse_expression(text).expect("an expression"))
}

fn of_expression(expression: &Expr) -> Polynomial {
    let polynomial = expression.expand().and_then(|sum| sum.to_polynomial(&mut |_| None));
    polynomial.expect("short").expect("a polynomial")
}

/// `a'` and `psi'`.
fn slow(solution: &Solution) -> [Polynomial; 2] {
    let slow = solution.modulation.as_ref().expect("slow equations");
    [&slow.amplitude_rate, &slow.phase_rate].map(of_expression)
}
