//! Series with exact coefficients: Taylor's of a function ([`taylor()`]), [`FourierSeries`] in `theta = omega t`, and running
//! [`Convolutions`] of powers, order by order; with floating-point ones by recurrence ([`numeric_taylor`]).

pub(crate) mod convolution;
pub(crate) mod fourier;
pub(crate) mod recurrence;
pub(crate) mod taylor;
pub(crate) mod terms;

pub use convolution::{Convolutions, Node};
pub use fourier::{FourierSeries, Resonance, fraction, linear_combination, sum_of_products};
pub use recurrence::{RecurrenceError, numeric_taylor};
pub use taylor::{HIGHEST_DEGREE, TaylorError, taylor};
