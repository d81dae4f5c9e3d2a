//! Numerical reference motions: nothing here knows where an equation came from, so a formula that
//! is judged shares no code with its judge.
//!
//! In come forces as closures, starts and tolerances; out go motions, periods and limit cycles, or
//! the reason why there is none. Units are those of the closures. [`ode`], `harmonics` and
//! [`continuation`] use none of the others, and those do not use each other; [`balance`] uses the
//! first two, [`orbit_branch`] the last:
//!
//! - [`ode`]: Runge-Kutta with dense output and events, quadrature, roots; turning points.
//! - `harmonics`: the Fourier coefficients of a period from its values at equal steps, and back.
//! - [`balance`]: harmonic balance, the equations of a periodic motion for its Fourier
//!   coefficients.
//! - [`period`]: the true period under a force that depends on the position alone, from the energy,
//!   and under any other force from the return to a turning point.
//! - [`continuation`]: branches of solutions, step by step.
//! - [`orbit_branch`]: branches of periodic orbits in a parameter, by shooting.
//! - [`normal_form`]: the cubic term of a map where a pair of its multipliers passes the unit circle.
//! - [`periodic`]: true periodic orbits by shooting, and their Floquet multipliers.
//! - [`return_map`]: true limit cycles, from one turning point to the next.
//!
//! [`period`], [`periodic`] and [`return_map`] belong to the judge: no approximate method takes its
//! answer from them.

pub mod balance;
pub mod continuation;
pub mod harmonics;
pub mod normal_form;
pub mod ode;
pub mod orbit_branch;
pub mod period;
pub mod periodic;
pub mod return_map;
