//! Coupled oscillators, `M q'' + K q + f(q, q', q'') = 0`, and the formulas of their free motions.
//!
//! In: equations of several coordinates. Out: of those that nothing drives or damps the nonlinear
//! normal modes, each with its frequency law, the motion of every coordinate and the modal line; of
//! all the slow equations of amplitudes and phases; of absorbers the designs; or a refusal that names the term, or the two
//! modes that resonate.
//!
//! Five names to know: [`modes::FreeSystem`], the question; [`modes::derive`] and
//! [`modes::NonlinearMode`], the answer for one mode; [`multiple_scales::CoupledSystem`] and
//! [`multiple_scales::SlowMotion`], the same with damping and drives. Absorbers are in [`absorber`].

#![warn(missing_docs)]

#[doc(no_inline)]
pub use lindstedt_dynamics::{coupled, mechanics};
#[doc(no_inline)]
pub use lindstedt_expr::{decimal, exact, expr, parallel, symbol, values};
#[doc(no_inline)]
pub use lindstedt_numeric::{interrupt, numeric};
#[doc(no_inline)]
pub use lindstedt_oscillator::{derivation, method, solution};
#[doc(no_inline)]
pub use lindstedt_series::series;

pub mod modes;

pub mod multiple_scales;

pub mod absorber;

pub use interrupt::Supervision;
pub use symbol::Symbol;
