//! Series with exact coefficients: [`taylor`] of a function, [`fourier`] in `theta = omega t`, and running [`convolution`]s
//! of powers, order by order; with floating-point ones by [`recurrence`].

pub mod convolution;
pub mod fourier;
pub mod recurrence;
pub mod taylor;
pub mod terms;

pub use fourier::FourierSeries;
