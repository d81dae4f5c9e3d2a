//! The slow equations of amplitude and phase, where a motion is no longer periodic: damped, growing, on its way to a limit
//! cycle, or driven.
//!
//! References: N. N. Bogoliubov, Y. A. Mitropolsky, *Asymptotic Methods in the Theory of Non-Linear Oscillations*, Gordon and
//! Breach 1961, chapter 1; A. H. Nayfeh, D. T. Mook, *Nonlinear Oscillations*, Wiley 1979, chapters 3 and 4.
//!
//! ```text
//! free      x = a cos(theta) + ...,  theta = psi,                       a' = f(a),       psi' = g(a), near omega0
//! driven    x = a cos(theta) + ...,  theta = (n Omega t - psi)/m,       a' = f(a, psi),  psi' = g(a, psi), near zero
//!           where n Omega = m omega0 + sigma
//! ```
//!
//! The displacement of the solution is the series in `theta`, its coefficients in `a`.

use super::{Definition, LeadingCycle};
use crate::expr::Expr;
use crate::symbol::Symbol;

/// The equations of amplitude and phase, and what is known of their solutions.
#[derive(Clone, Debug, PartialEq)]
pub struct Modulation {
    /// The symbol of the amplitude, that of the convention of the solution.
    pub amplitude: Symbol,
    /// The symbol of the phase: the whole phase of a free motion, the slow one behind the force of a driven motion.
    pub phase: Symbol,
    /// `a'`, in the amplitude, the phase of a driven motion, and the parameters and definitions of the solution.
    pub amplitude_rate: Expr,
    /// `psi'`, likewise.
    pub phase_rate: Expr,
    /// Parameters that are small together with the small parameter of the solution.
    pub small_with: Vec<Symbol>,
    /// What is in resonance with what; `None` for a free motion.
    pub resonance: Option<Resonance>,
    /// The motion from a start in closed form, where there is one.
    pub transient: Option<Transient>,
    /// The amplitudes other than zero that stay, smallest first, each with its stability, where they can be written down.
    pub steady: Vec<LeadingCycle>,
}

/// A driving frequency near a rational multiple of the linear frequency, `n Omega = m omega0 + sigma`.
#[derive(Clone, Debug, PartialEq)]
pub struct Resonance {
    /// The driving frequency: a symbol, or a number.
    pub driving_frequency: Expr,
    /// `n`.
    pub times_driving: u32,
    /// `m`.
    pub times_linear: u32,
    /// `sigma`, the detuning, by what it stands for.
    pub detuning: Definition,
}

/// A motion from its start in closed form.
#[derive(Clone, Debug, PartialEq)]
pub struct Transient {
    /// The symbol of the amplitude at `t = 0`.
    pub start: Symbol,
    /// `a(t)`.
    pub amplitude: Expr,
    /// `psi(t)` from `psi(0) = 0`, where that is closed as well.
    pub phase: Option<Expr>,
    /// The time from which on the amplitude is zero, or at which it grows without bound; `None` where the formula holds for all
    /// times.
    pub ends: Option<Expr>,
}

impl Modulation {
    /// Whether nothing drains or feeds energy at this order: the amplitude stays as it is.
    pub fn is_conservative(&self) -> bool {
        self.amplitude_rate.is_zero()
    }
}
