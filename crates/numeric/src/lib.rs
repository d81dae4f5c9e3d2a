//! Numerical motions and searches: everything takes closures and slices of `f64`, nothing handles
//! symbolic equations.
//!
//! In: a right-hand side, a start, tolerances. Out: trajectories, roots, integrals, periods, the
//! best of a search.
//!
//! Five names to know: [`numeric::ode`], Runge-Kutta, roots and quadrature; [`numeric::periodic`],
//! periodic orbits by shooting; [`numeric::return_map`], limit cycles; [`genetic`], the genetic
//! algorithm; [`interrupt::Interrupt`], a request to stop.

#![warn(missing_docs)]

pub mod interrupt;

pub mod numeric;

pub mod genetic;

pub use interrupt::{Counter, Interrupt, Progress, Supervision};
