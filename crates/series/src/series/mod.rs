//! Series with exact coefficients: the Taylor series of a function ([`taylor()`]),
//! [`FourierSeries`] in `theta = omega t`, and [`Convolutions`] of powers, order by order; Taylor
//! series with floating-point coefficients by recurrence ([`numeric_taylor`]); and the nearest
//! [singularity] of the function behind a long series.
//!
//! In come expressions and a point, or series with coefficients in any
//! [`Ring`](crate::exact::Ring); out go series of the given order, or a [`TaylorError`] with the
//! term that has no series there. Nothing here depends on a method or an equation of motion.

pub mod convolution;
pub mod fixed_width;
pub mod fourier;
pub mod guard;
pub mod hermite_pade;
pub mod recurrence;
pub mod singularity;
pub mod tape;
pub mod taylor;
pub mod terms;
pub mod waves;

pub use convolution::{Convolutions, SeriesNode};
pub use fourier::{FourierSeries, ResonantPart, fraction, linear_combination, sum_of_products};
pub use recurrence::{RecurrenceError, numeric_taylor};
pub use taylor::{HIGHEST_DEGREE, TaylorError, taylor};
