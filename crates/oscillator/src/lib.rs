//! One oscillator, `x'' + f(x, x', t) = 0`, and the formulas of its motion.
//!
//! In: an equation of motion. Out: a frequency law, a motion as a Fourier series, the derivation
//! line by line; or a refusal that names the term and a way forward.
//!
//! Five names to know: [`oscillator::Oscillator`], the question; [`method::solve`] with
//! [`method::Options`], one signature for all methods; [`solution::Solution`], the answer;
//! [`method::motion::Motion`], the answer in numbers.

#![warn(missing_docs)]

#[doc(no_inline)]
pub use lindstedt_expr::{decimal, exact, expr, parallel, symbol, values};
#[doc(no_inline)]
pub use lindstedt_numeric::{interrupt, numeric};
#[doc(no_inline)]
pub use lindstedt_series::series;

pub mod derivation;

pub mod solution;

pub mod oscillator;

pub mod conservative;

pub mod equilibrium;

pub mod method;

pub use interrupt::{Counter, Interrupt, Progress, Supervision};
pub use method::motion::Motion;
pub use method::numbers::NoNumbers;
pub use method::{Options, solve};
pub use oscillator::Oscillator;
pub use solution::{Method, Solution};
pub use symbol::Symbol;
pub use values::{ValueError, Values};
