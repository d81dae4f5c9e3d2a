//! A study of materials as a table of comma-separated values and as a picture; as text and LaTeX it
//! is a document of [`report`](crate::report), in JSON one of `export::json`.

mod csv;
pub mod figure;

pub use csv::materials as csv;
