//! The pendulum that hits an elastic barrier, the search for the best damper, and periodic motions
//! between rigid walls.
//!
//! In: masses, lengths, a contact law; or a linear driven oscillator with walls. Out: three phases in
//! closed form, all forces event by event, sweeps, materials, the design that rests soonest; periodic
//! impact orbits in closed form.
//!
//! Five names to know: [`impact::Model`], equation (7); [`mod@impact::chain`], impacts in closed
//! form; [`impact::primary`], the main mass; [`optimize::optimize`]; [`orbits::find_orbits`].

#![warn(missing_docs)]

#[doc(no_inline)]
pub use lindstedt_dynamics::{mechanics, system, wall};
#[doc(no_inline)]
pub use lindstedt_expr::{decimal, exact, expr, parallel, spelling, symbol, values};
#[doc(no_inline)]
pub use lindstedt_numeric::{genetic, interrupt, numeric};
#[doc(no_inline)]
pub use lindstedt_oscillator::{conservative, equilibrium, method, oscillator, solution};
#[doc(no_inline)]
pub use lindstedt_series::series;
#[doc(no_inline)]
pub use lindstedt_verify::{certificate, trajectory, verify};

pub mod impact;

pub mod optimize;

pub mod orbits;

pub use interrupt::{Counter, Interrupt, Progress, Supervision};
pub use method::motion::Motion;
pub use method::numbers::NoNumbers;
pub use method::{Options, solve};
pub use oscillator::Oscillator;
pub use solution::{Method, Solution};
pub use symbol::Symbol;
pub use values::{ValueError, Values};
pub use verify::{Verdict, judge};
