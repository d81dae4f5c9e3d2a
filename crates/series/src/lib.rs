//! Series: Taylor expansions of a force, Fourier series in `theta = omega t`, the singularities of
//! long power series.
//!
//! In: an expression, an order. Out: coefficients of any ring, order by order, none computed twice.
//!
//! Five names to know: [`series::FourierSeries`]; [`mod@series::taylor`], the expansion of an
//! expression; [`series::recurrence`], its floating-point counterpart by recurrences;
//! [`series::singularity`], the singularity that limits the convergence of a long series;
//! [`series::terms`], sums as they are written.

#![warn(missing_docs)]

#[doc(no_inline)]
pub use lindstedt_expr::{decimal, exact, expr, parallel, symbol, values};
#[doc(no_inline)]
pub use lindstedt_numeric::interrupt;

pub mod series;

pub use symbol::Symbol;
