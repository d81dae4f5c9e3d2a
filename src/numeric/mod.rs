//! True motions in numbers: nothing here knows where an equation came from, so what is judged shares nothing with its judge.
//!
//! In come forces as closures, starts and tolerances; out go motions, periods and limit cycles, or the reason why there is none.
//! Units are those of the closures. [`ode`] uses neither of the others, and they do not use each other:
//!
//! - [`ode`]: Runge-Kutta with dense output and events, quadrature, roots; turning points.
//! - [`period`]: the true period of a force of the position alone, from its energy, and of others from their return.
//! - [`periodic`]: true periodic motions of driven equations, and their Floquet multipliers.
//! - [`return_map`]: true limit cycles, from one turning point to the next.
//!
//! The last three belong to the judge: no method takes its answer from them.

pub mod ode;
pub mod period;
pub mod periodic;
pub mod return_map;
