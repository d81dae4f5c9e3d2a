//! A search for the best damper as a table of comma-separated values and as pictures; as text and
//! LaTeX it is a document of [`report`](crate::report), in JSON one of `export::json`.

mod csv;
pub mod figure;

pub use csv::optimization as csv;
