//! The slow equations of amplitude and phase, where a motion is no longer periodic: damped,
//! growing, on its way to a limit cycle, or driven.
//!
//! References: N. N. Bogoliubov, Y. A. Mitropolsky, *Asymptotic Methods in the Theory of Non-Linear
//! Oscillations*, Gordon and Breach 1961, chapter 1; A. H. Nayfeh, D. T. Mook, *Nonlinear
//! Oscillations*, Wiley 1979, chapters 3 and 4.
//!
//! ```text
//! free      x = a cos(theta) + ...,  theta = psi,                       a' = f(a),       psi' = g(a), near omega0
//! driven    x = a cos(theta) + ...,  theta = (n Omega t - psi)/m,       a' = f(a, psi),  psi' = g(a, psi), near zero
//!           where n Omega = m omega0 + sigma
//! ```
//!
//! The displacement of the solution is the series in `theta`, its coefficients in `a`.

use super::{AmplitudeConvention, ClosedForm, Definition, Law, LeadingCycle, LimitCycle, Solution};
use crate::exact::{POLYNOMIALS, Polynomial, Polynomials, Rational};
use crate::expr::Expr;
use crate::series::FourierSeries;
use crate::symbol::letters::FIRST_HARMONIC;
use crate::symbol::{Symbol, fresh};

/// The equations of amplitude and phase, and what is known of their solutions.
#[derive(Clone, Debug, PartialEq)]
pub struct Modulation {
    /// The symbol of the amplitude, that of the convention of the solution.
    pub amplitude: Symbol,
    /// The symbol of the phase: the whole phase of a free motion, the slow one behind the force of
    /// a driven motion.
    pub phase: Symbol,
    /// `a'`, in the amplitude, the phase of a driven motion, and the parameters and definitions of
    /// the solution.
    pub amplitude_rate: Expr,
    /// `psi'`, likewise.
    pub phase_rate: Expr,
    /// Parameters that are small together with the small parameter of the solution.
    pub small_with: Vec<Symbol>,
    /// The resonance of drive and motion; `None` for a free motion.
    pub resonance: Option<Resonance>,
    /// Initial amplitude and phase of a motion released from rest at `x = A`; `None` for a driven
    /// motion.
    pub release: Option<Release>,
    /// The motion from a start in closed form, where there is one.
    pub transient: Option<Transient>,
    /// The steady amplitudes other than zero, smallest first, each with its stability; empty if
    /// they have no closed form.
    pub steady: Vec<LeadingCycle>,
    /// The motion in the amplitude, if the displacement of the solution is that on a limit cycle.
    pub motion: Option<FourierSeries<Polynomials>>,
}

/// A driving frequency near a rational multiple of the linear frequency,
/// `n Omega = m omega0 + sigma`.
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

/// Amplitude and phase at `t = 0` of a motion with `x(0) = A` about the equilibrium, `x'(0) = 0`,
/// to the order of the equations.
#[derive(Clone, Debug, PartialEq)]
pub struct Release {
    /// `a(0)`, in `A` and the parameters.
    pub amplitude: Expr,
    /// `psi(0)`, likewise.
    pub phase: Expr,
}

/// A motion from its start in closed form.
#[derive(Clone, Debug, PartialEq)]
pub struct Transient {
    /// The symbol of the amplitude at `t = 0`: `A`, or one that the definitions give in it.
    pub start: Symbol,
    /// `a(t)`.
    pub amplitude: Expr,
    /// `psi(t)`, where that is closed as well.
    pub phase: Option<Expr>,
    /// The time from which on the amplitude is zero, or at which it grows without bound; `None` if
    /// the formula holds for all times.
    pub ends: Option<Expr>,
}

impl Release {
    /// The initial values to leading order: `a(0) = A`, `psi(0) = 0`.
    pub fn at_start() -> Self {
        Self { amplitude: Expr::from(AmplitudeConvention::Initial.symbol()), phase: Expr::zero() }
    }

    /// Whether the initial values are those [to leading order](Self::at_start).
    pub fn is_at_start(&self) -> bool {
        *self == Self::at_start()
    }
}

impl Modulation {
    /// Rounds the coefficients of rates that are polynomials.
    pub(super) fn round(&mut self, round: &dyn Fn(&Rational) -> Rational) {
        for rate in [&mut self.amplitude_rate, &mut self.phase_rate] {
            if let Ok(Some(polynomial)) = rate.to_polynomial(&mut |_| None) {
                *rate = Expr::from(&polynomial.map(round));
            }
        }
    }

    /// Whether no term dissipates or feeds energy at this order, so that the amplitude is constant.
    pub fn is_conservative(&self) -> bool {
        self.amplitude_rate.is_zero()
    }
}

impl Solution {
    /// The motion on its way to the limit cycle, if this solution describes the motion on that
    /// cycle; `None` otherwise.
    pub fn off_cycle(&self) -> Option<Self> {
        self.limit_cycle.as_ref()?;
        let modulation = self.modulation.as_ref()?;
        modulation.release.as_ref()?;
        let frequency = modulation.phase_rate.to_polynomial(&mut |_| None).ok()??;
        let displacement = modulation.motion.clone()?;
        Some(Self {
            law: Law::Frequency(frequency),
            displacement,
            limit_cycle: None,
            ..self.clone()
        })
    }

    /// The periodic motion at a steady amplitude: the smallest that attracts for small positive
    /// parameters, else the smallest; `None` if none is known.
    pub fn on_cycle(&self) -> Option<Self> {
        let modulation =
            self.modulation.as_ref().filter(|modulation| modulation.resonance.is_none())?;
        let attracts = |cycle: &LeadingCycle| {
            let condition = cycle.attracts_where.as_ref();
            condition.is_some_and(|condition| !condition.has_leading_minus())
        };
        let number = modulation.steady.iter().position(attracts).unwrap_or(0);
        let amplitude = modulation.steady.get(number)?.amplitude.clone();
        let mut periodic = self.clone();
        // An amplitude that is not a polynomial has a name.
        let unit = match amplitude.to_polynomial(&mut |_| None).ok()? {
            Some(unit) => unit,
            None => {
                let symbol = fresh(&format!("{FIRST_HARMONIC}0"), &self.names());
                periodic.definitions.push(Definition { symbol, meaning: amplitude });
                Polynomial::symbol(symbol)
            }
        };
        let a = modulation.amplitude;
        let settled = |polynomial: &Polynomial| polynomial.substitute(a, &unit);
        periodic.law = match &self.law {
            Law::Frequency(frequency) => Law::Frequency(settled(frequency)?),
            Law::Closed(form) => Law::Closed(ClosedForm {
                squared: form.squared,
                value: form.value.substitute(a, &Expr::from(&unit)).ok()?,
            }),
            _ => return None,
        };
        periodic.displacement = self.displacement.map(POLYNOMIALS, |coefficient, _| {
            settled(coefficient).unwrap_or_else(|| coefficient.clone())
        });
        periodic.limit_cycle = Some(LimitCycle {
            amplitude: unit.clone(),
            number: number + 1,
            cycles: modulation.steady.clone(),
            small_with: modulation.small_with.clone(),
        });
        periodic.modulation = None;
        // Definitions that contain the initial amplitude have no meaning on the cycle.
        let start = AmplitudeConvention::Initial.symbol();
        periodic.definitions.retain(|definition| !definition.meaning.contains(start));
        Some(periodic)
    }
}
