//! Verification: the true motion with which a formula is compared.
//!
//! In: the original equation, and a solution to be judged. Out: trajectories, Floquet multipliers,
//! verdicts, proofs, and the steady states of driven and self-excited oscillators.
//!
//! Five names to know: [`verify::judge`] and [`verify::Verdict`]; [`trajectory`], any equation
//! followed from its start; [`certificate`], a proof beside a formula; [`response`], branches of
//! steady states; [`hill`], linear equations with periodic coefficients.

#![warn(missing_docs)]

#[doc(no_inline)]
pub use lindstedt_dynamics::{coupled, event, mechanics, system, wall};
#[doc(no_inline)]
pub use lindstedt_expr::{decimal, exact, expr, parallel, symbol, values};
#[doc(no_inline)]
pub use lindstedt_modes::{absorber, modes, multiple_scales};
#[doc(no_inline)]
pub use lindstedt_numeric::{interrupt, numeric};
#[doc(no_inline)]
pub use lindstedt_oscillator::{conservative, equilibrium, method, oscillator, solution};
#[doc(no_inline)]
pub use lindstedt_series::series;

pub mod trajectory;

pub mod hill;

pub mod verify;

pub mod certificate;

pub mod response;

pub mod absorber_verdict;

pub mod shortest;

pub use interrupt::{Counter, Interrupt, Progress, Supervision};
pub use method::motion::Motion;
pub use method::numbers::NoNumbers;
pub use method::{Options, solve};
pub use oscillator::Oscillator;
pub use solution::{Method, Solution};
pub use symbol::Symbol;
pub use values::{ValueError, Values};
pub use verify::{Verdict, judge};
