//! Handing a result on: [`text`] to read, [`json`] for programs, `figure` (feature `plot`) to look at.

#[cfg(feature = "plot")]
pub mod figure;
pub mod json;
pub mod text;
