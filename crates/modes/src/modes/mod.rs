//! Nonlinear normal modes in formulas: the families of free periodic motions that begin at the
//! linear modes, by Lindstedt and Poincare.
//!
//! ```text
//! M q'' + K q + f(q, q', q'') = 0,    theta = omega t,  q(theta + 2 pi) = q(theta),  q(-theta) = q(theta)
//! (K - lambda M) v = 0,  (K - lambda M)^T u = 0
//! q = a v cos theta + a^2 q_2 + ...,  omega^2 = lambda + a W_1 + a^2 W_2 + ...
//! ```
//!
//! (R. M. Rosenberg, *Adv. Appl. Mech.* 9 (1966) 155; A. F. Vakakis and others, *Normal Modes and
//! Localization in Nonlinear Systems*, Wiley 1996, chapter 2; A. H. Nayfeh, *Perturbation Methods*,
//! Wiley 1973, section 3.1.)
//!
//! - `reading`: equations counted from rest, their coefficients as polynomials.
//! - `free_system`: the equations as `M`, `K` and the terms of `f`.
//! - `linear`: the linear modes, exact where their roots are; `matrix`: fractions in rows.
//! - `inverse`: `K - k^2 lambda M` inverted for each harmonic, the resonances among them.
//! - `expansion`: the orders of frequency and motion.
//! - `modal_line`: the other coordinates as functions of the first.
//! - `steps`: the derivation order by order.
//! - `harmonic_balance`: modes by balance of several harmonics, solved by numbers at an amplitude.
//! - `one_harmonic`: modes of two coordinates with one harmonic, in closed form.

mod answer;
mod error;
mod expansion;
mod free_system;
mod harmonic_balance;
mod inverse;
pub(crate) mod linear;
pub(crate) mod matrix;
mod modal_line;
mod one_harmonic;
pub(crate) mod reading;
mod steps;

pub use answer::{Approximant, LinearShape, ModeOptions, NonlinearMode, NormalModes, derive};
pub use error::ModeError;
pub use free_system::FreeSystem;
pub use harmonic_balance::{BalanceStart, ModeBalance, ModeInNumbers};
pub use linear::NearResonance;
pub use one_harmonic::{
    OneHarmonicBranchPoint, OneHarmonicFamily, OneHarmonicModes, one_harmonic_modes,
};
pub(crate) use one_harmonic::{by_powers, first_harmonic};
