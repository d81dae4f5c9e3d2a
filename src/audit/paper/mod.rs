//! The source publication of the pendulum and its barrier: its printed equations, each beside the derived one.
//!
//! The engine names no publication. A printed equation, table or number lives here and is compared with what the engine computes.

mod equations;

pub use equations::{Finding, PaperError, findings, mechanism, pendulum, units};
