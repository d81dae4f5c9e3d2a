//! Laws of vibration from measured records: which spring and which loss, with true standard errors.
//!
//! In: a record of a free decay, a backbone table or times of impacts. Out: frequency and damping against
//! amplitude without any law, a table of laws with their parameters, errors and exclusions.
//!
//! Five names to know: [`laws::Law`]

#![warn(missing_docs)]

#[doc(no_inline)]
pub use lindstedt_dynamics::{expr, numeric, symbol, system};
#[doc(no_inline)]
pub use lindstedt_oscillator::oscillator;

pub mod laws;

mod powers;

mod polynomial;

pub mod turning_points;

mod least_squares;

pub mod backbone;

mod closed_forms;

pub mod motion;

pub mod sample_fit;

pub mod whiteness;

pub mod record;

pub mod quality;

mod equation_error;

pub mod answer;

pub mod impacts;

pub mod tables;
