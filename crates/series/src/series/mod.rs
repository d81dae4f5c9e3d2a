//! Series with exact coefficients: Taylor's of a function ([`taylor()`]), [`FourierSeries`] in
//! `theta = omega t`, and running [`Convolutions`] of powers, order by order; with floating-point
//! ones by recurrence ([`numeric_taylor`]). What long ones say of the function behind them: its
//! nearest [singularity].
//!
//! In come expressions and a point, or series with coefficients in any
//! [`Ring`](crate::exact::Ring); out go series of the order asked for, or a [`TaylorError`] with
//! the term that has none there. Nothing here knows a method or an equation of motion.

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
