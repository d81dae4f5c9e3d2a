//! Handing a result on: [`text`] to read, `json` (feature `json`) for programs, [`latex`] for an
//! article, [`code`] to compute with, `figure` (feature `plot`) to look at, `html` (feature `html`)
//! for all of it on one page.
//!
//! In come documents of [`report`](crate::report); JSON, pictures, tables of comma-separated values
//! and simulations take the results themselves. Out goes text in one format. What is shown was
//! chosen before: a format chooses only its layout.

pub mod catalog;
pub mod code;
pub mod comparison;
mod csv;
pub mod figure;
pub mod friction;
#[cfg(feature = "html")]
pub mod html;
#[cfg(feature = "json")]
#[cfg_attr(
    not(feature = "schema"),
    allow(dead_code, unused_imports, reason = "lists of names stand in schemas alone")
)]
pub mod json;
pub mod latex;
pub mod materials;
pub mod optimization;
pub mod primary;
pub mod response;
pub mod simulation;
pub mod stability;
pub(crate) mod steps;
pub mod text;
pub mod trajectory;

pub use crate::decimal::{decimal, significant};
pub use crate::spelling::{is_invisible, printable, printable_in_line};

use crate::exact::Doubles;
use crate::series::FourierSeries;

/// The size of a coefficient that is rounding noise of a motion in numbers: what quadrature leaves
/// of harmonics that are not there.
pub(crate) fn rounding_noise(motion: &FourierSeries<Doubles>) -> f64 {
    /// Ratio to the largest oscillation below which a harmonic is rounding.
    const NOISE: f64 = 1e-14;
    let swing = |k: usize| motion.cosine(k).mean().0.hypot(motion.sine(k).mean().0);
    NOISE * (1..=motion.highest_harmonic()).map(swing).fold(0.0, f64::max)
}
