//! Systems of any number of first-order equations, and equations of motion from energies.
//!
//! In: rates as expressions, or a kinetic and a potential energy. Out: motions in numbers,
//! equations of motion, units, dimensionless groups, equilibria and modes.
//!
//! Five names to know: [`system::System`], first-order equations that are integrated by Taylor
//! series or Runge-Kutta; and in [`mechanics`] `Mechanism`, `EquationsOfMotion`, `Dimension` and
//! `Modes`.

#![warn(missing_docs)]

#[doc(no_inline)]
pub use lindstedt_expr::{decimal, exact, expr, parallel, symbol, values};
#[doc(no_inline)]
pub use lindstedt_numeric::{interrupt, numeric};
#[doc(no_inline)]
pub use lindstedt_series::series;

pub mod system;

pub mod mechanics;

pub mod coupled;

pub mod wall;

pub mod contact;

pub use interrupt::{Interrupt, Progress};
pub use symbol::Symbol;
