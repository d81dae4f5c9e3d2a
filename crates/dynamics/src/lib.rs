//! Systems of equations of any number, and the equations that energies make.
//!
//! In: rates as expressions, or a kinetic and a potential energy. Out: motions in numbers,
//! equations of motion, units, dimensionless groups, equilibria and modes.
//!
//! Five names to know: [`system::System`], first-order equations that are followed by Taylor series
//! or Runge-Kutta; [`mechanics`]'s Lagrangian, generalized forces, dimensions and modes.

#![warn(missing_docs)]

#[doc(no_inline)]
pub use lindstedt_expr::{decimal, exact, expr, parallel, symbol, values};
#[doc(no_inline)]
pub use lindstedt_numeric::{interrupt, numeric};
#[doc(no_inline)]
pub use lindstedt_series::series;

pub mod system;

pub mod mechanics;

pub use interrupt::{Interrupt, Progress};
pub use symbol::Symbol;
