//! The method of multiple scales: a slow time for each order, amplitude and phase that change on
//! them.
//!
//! Reference: A. H. Nayfeh, D. T. Mook, *Nonlinear Oscillations*, Wiley 1979, sections 2.3.3
//! (free), 3.1 to 3.4 (damped and self-excited), 4.1 and 5.7 (driven).
//!
//! ```text
//! x = a cos(theta) + sum eps^k x_k(a, theta)
//! a' = sum eps^k f_k(a),   theta' = omega0 + sum eps^k g_k(a),   f_k + i a g_k = 2 e^(-i beta) D_k B,  B = (a/2) e^(i beta)
//! ```
//!
//! The slow derivatives `D_k B` are computed in `slow_times`. The motion leaves out homogeneous
//! solutions, so `a` is the amplitude of the first harmonic to every order. A free conservative
//! motion keeps its amplitude, and `theta'` is its frequency; a self-excited one ends at `f = 0`,
//! on a limit cycle.
//!
//! Parameters that have to vanish together, as in `x'' + 2*zeta*x' + x + eps*x^3 = 0`, count as
//! equally small. In powers of the amplitude a linear damping counts as its square, so that it
//! appears beside the first effect of a cubic force.
//!
//! Cost: the products of the force in as many slow times as there are orders, of which there are at
//! most three.
//!
//! ```
//! # use lindstedt_oscillator as lindstedt;
//! use lindstedt::{Oscillator, method::{Options, solve}, solution::Method};
//! let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
//! let options = Options { method: Some(Method::MultipleScales), order: Some(2), ..Options::default() };
//! let law = solve(&duffing, &options)?.law;
//! assert_eq!(law.frequency().unwrap().to_string(), "1 + 3*eps*a^2/8 - 15*eps^2*a^4/256");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod answer;
mod derivation;
pub(super) mod driven;
mod free;
mod names;
mod release;
pub mod scaling;
mod slow_equations;
mod slow_times;
mod slow_waves;

use self::slow_times::DrivenTerm;
use super::{Options, Reason, Refusal};
use crate::oscillator::{Oscillator, Term};
use crate::solution::{AmplitudeConvention, Method, Solution};

/// Derives the slow equations and the motion as power series in the small parameter.
///
/// # Errors
/// A drive, or a force that cannot be expanded, each by name; an order above the highest.
pub fn solve(oscillator: &Oscillator, options: &Options) -> Result<Solution, Refusal> {
    let parts = oscillator.parts()?;
    if options.amplitude == Some(AmplitudeConvention::Initial) {
        return Err(Reason::ConventionOfFirstHarmonic.to(Method::MultipleScales));
    }
    if !parts.forcing.is_zero() {
        return driven::solve(oscillator, &parts, options);
    }
    if options.resonance.is_some() {
        let choice = super::table::Choice::Resonance;
        return Err(Reason::NoSuchChoice(choice).to(Method::MultipleScales));
    }
    free::solve(oscillator, &parts, options)
}

/// A term of a force without drive.
fn undriven(term: &Term) -> DrivenTerm {
    DrivenTerm {
        order: term.order,
        position: term.position,
        velocity: term.velocity,
        coefficient: term.coefficient.clone(),
        drive: None,
    }
}
