//! lindstedt
pub mod symbol;
pub mod spelling;
pub mod decimal;
pub mod exact;
pub mod expr;
pub mod series;
pub mod solution;
pub mod oscillator;
pub mod method;
pub mod ode;
pub mod verify;
pub mod contact;
pub mod impact;
pub mod problem;
pub mod export;
pub use symbol::Symbol;
pub use oscillator::Oscillator;
