//! Handing a result on: [`text`] to read, `json` (feature `json`) for programs, [`latex`] for an article, `figure` (feature `plot`)
//! to look at.

#[cfg(feature = "plot")]
pub mod figure;
#[cfg(feature = "json")]
pub mod json;
pub mod latex;
pub mod simulation;
pub(crate) mod steps;
pub mod text;
