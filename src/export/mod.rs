//! Output of results: [`text`] to read, `json` (feature `json`) for programs, [`latex`] for an
//! article, [`code`] to compute with, `figure` (feature `plot`) to look at, `html` (feature `html`)
//! for all of it on one page.
//!
//! In come documents of [`report`](crate::report); JSON, pictures, tables of comma-separated values
//! and simulations take the results themselves. Out goes text in one format. The content was chosen
//! before; a format determines only the layout.

pub mod absorber;
pub mod catalog;
pub mod code;
pub mod comparison;
mod csv;
pub mod figure;
pub mod fit;
pub mod friction;
#[cfg(feature = "html")]
pub mod html;
#[cfg(feature = "json")]
pub mod json;
pub mod latex;
pub mod materials;
pub mod modes;
pub mod optimization;
pub mod orbits;
pub mod primary;
pub mod response;
pub mod shortest;
pub mod simulation;
pub mod slow_equations;
pub mod stability;
pub(crate) mod steps;
pub mod text;
pub mod trajectory;

pub use crate::decimal::{decimal, significant};
pub use crate::spelling::{is_invisible, printable, printable_in_line};

use crate::exact::Doubles;
use crate::series::FourierSeries;

/// The size of a coefficient that is rounding noise of a numerical motion: the error of quadrature
/// in harmonics that vanish.
pub(crate) fn rounding_noise(motion: &FourierSeries<Doubles>) -> f64 {
    /// Ratio to the largest oscillation below which a harmonic is rounding.
    const NOISE: f64 = 1e-14;
    let swing = |k: usize| motion.cosine(k).mean().0.hypot(motion.sine(k).mean().0);
    NOISE * (1..=motion.highest_harmonic()).map(swing).fold(0.0, f64::max)
}

/// Text with the special characters of HTML escaped.
#[cfg(any(feature = "html", feature = "plot"))]
pub(crate) fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            _ => escaped.push(letter),
        }
    }
    escaped
}
