//! The source publication of the pendulum and its barrier: its printed equations, each compared
//! with the derived one.
//!
//! The engine names no publication. A printed equation, table or number lives here and is compared
//! with what the engine computes.

mod contact_time;
mod equations;
mod friction;

pub use contact_time::{CONTACT_TIME, is_reproduced, over_contact_time};
pub use equations::{Finding, findings, mechanism, pendulum, units};
pub use friction::{FrictionTable, PiReading, PrintedDigits, PrintedSpeed, SPEEDS, TableRow};
