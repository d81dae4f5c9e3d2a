//! Laws of vibration from measured records: which spring and which loss, with true standard errors.
//!
//! In: a record of a free decay, a backbone table or times of impacts. Out: frequency and damping against
//! amplitude without any law, a table of laws with their parameters, errors and exclusions.
//!
//! Five names to know: [`fit::record::read`], a record from text; [`fit::answer::fit`], the laws of a free decay; [`fit::laws::Law`], a law of
//! the list or an equation of one's own; [`fit::backbone::backbone`], frequency and damping without a law; [`fit::motion::MotionSolver`], a
//! motion with its derivatives by the parameters.
//!
//! ```
//! use lindstedt_fit::fit::answer::{FitOptions, fit};
//! use lindstedt_fit::fit::laws::{Loss, Spring};
//! use lindstedt_fit::fit::record::Record;
//!
//! // x'' + 0.04 x' + 4 x = 0 with an offset, and a ripple in place of noise.
//! let times: Vec<f64> = (0..800).map(|index| 0.05 * f64::from(index)).collect();
//! let ripple = |t: f64| 3e-3 * (1e4 * t * t).sin();
//! let values = times.iter().map(|t| 0.1 + (-0.02 * t).exp() * (2.0 * t).cos() + ripple(*t));
//! let record = Record { values: values.collect(), times: times.clone(), ..Record::default() };
//! let answer = fit(&record, &FitOptions::default())?;
//! let best = answer.best().ok_or("a law")?;
//! assert_eq!(best.law.parts, Some((Spring::Linear, Loss::Viscous)));
//! let zeta = best.estimate("zeta").ok_or("a parameter")?;
//! assert!((zeta.value - 0.01).abs() < 3.0 * zeta.error);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![warn(missing_docs)]

#[doc(no_inline)]
pub use lindstedt_dynamics::{expr, numeric, parallel, symbol, system};
#[doc(no_inline)]
pub use lindstedt_oscillator::oscillator;

pub mod fit;
