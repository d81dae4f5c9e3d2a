//! The method of multiple scales for several coordinates: amplitudes and phases of all modes that
//! change slowly, damped, driven and in internal resonance.
//!
//! Reference: A. H. Nayfeh, D. T. Mook, *Nonlinear Oscillations*, Wiley 1979, chapter 6 and section
//! 7.4.
//!
//! ```text
//! M q'' + K q + (damping, drives, nonlinear forces) = 0,    q = V eta,  V the linear modes
//! eta_j = B_j e^(i nu_j t) + cc + sum eps^n eta_(j,n)(B, conj B),    sigma_j = nu_j - omega_j
//! eta_(j,n)'' + nu_j^2 eta_(j,n) = (what lower orders leave),     B_j' = sum eps^n D_n B_j
//! no e^(i nu_j t) on the right:    2 i nu_j D_n B_j = what stands there without it
//! B_j = (a_j/2) e^(i phi_j)
//! ```
//!
//! The reference frequencies `nu` obey the resonances exactly, and equal the linear ones but for the
//! detunings `sigma`, which are small: the slow equations have no time in them. The motion has no
//! homogeneous solutions, so `a_j` is the amplitude of the first harmonic of mode j to every order.
//!
//! - `system`: the equations as matrices and small terms.
//! - `resonance`: relations between frequencies, and the reference frequencies that obey them.
//! - `modal`: the linear modes, in which every divisor is a number or has a name.
//! - `expansion`: the orders, as waves in all frequencies.
//! - `slow_equations`: the rates of amplitudes and phases, and the motion.
//! - `relations`: steady motions in closed form, their phases eliminated.
//! - `exchange`: constants of motions that nothing damps, and the period of their exchange.
//! - `steady`: steady motions in numbers, with their stability.
//! - `steps`: the derivation order by order.
//!
//! Cost: the products of the force in as many orders, `O(order^2)` products of waves with
//! polynomials in the amplitudes for each factor of a term.

mod answer;
mod error;
mod exchange;
mod expansion;
mod modal;
mod relations;
mod resonance;
mod slow_equations;
mod steady;
mod steps;
mod system;

pub use answer::{MultipleScalesOptions, NearDivisor, SlowMotion, derive};
pub use error::MultipleScalesError;
pub use exchange::{EnergyExchange, SlowInvariants};
pub use relations::SteadyRelation;
pub use resonance::{Resonance, ResonanceError};
pub use slow_equations::{PhaseWaves, SlowRate};
pub use steady::{SlowNumbers, SlowSteadyState, SlowSteadyStates};
pub use system::CoupledSystem;
