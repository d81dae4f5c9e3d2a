//! Averaging: published slow equations, projections against their integrals, closed solutions put
//! back into their equations, decay and limit cycles against the true motion.
//!
//! References: N. N. Bogoliubov, Y. A. Mitropolsky, *Asymptotic Methods in the Theory of Non-Linear
//! Oscillations*, Gordon and Breach 1961, chapter 1; A. H. Nayfeh, D. T. Mook, *Nonlinear
//! Oscillations*, Wiley 1979, chapters 2 and 3.

mod driven;
mod free;

use lindstedt::Oscillator;
use lindstedt::expr::Expr;
use lindstedt::method::{Options, solve};
use lindstedt::solution::{Method, Modulation, Solution};
use lindstedt::verify::{Verification, judge};

fn averaged(equation: &str, order: u32) -> Solution {
    let options =
        Options { method: Some(Method::Averaging), order: Some(order), ..Options::default() };
    solve(&Oscillator::parse(equation).expect(equation), &options).expect(equation)
}

fn slow(equation: &str, order: u32) -> Modulation {
    averaged(equation, order).modulation.expect(equation)
}

fn judged(equation: &str, order: u32, at: &str) -> Verification {
    let oscillator = Oscillator::parse(equation).expect(equation);
    let at = at.parse().expect(at);
    judge(&oscillator, &averaged(equation, order), &at, 0.01).expect(equation)
}

fn same(left: &Expr, right: &str) -> bool {
    let right: Expr = right.parse().expect(right);
    (left - &right).expand().expect("a difference").is_zero()
}
