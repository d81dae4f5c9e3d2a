//! The answer of a driven motion, common to all methods that derive slow equations.

use super::drive::Drive;
use crate::derivation::DerivationLine;
use crate::exact::{POLYNOMIALS, Polynomial};
use crate::expr::Expr;
use crate::oscillator::Oscillator;
use crate::series::FourierSeries;
use crate::solution::modulation::Resonance;
use crate::solution::{
    AmplitudeConvention, Definition, Law, Method, Modulation, Note, Response, Solution,
};
use crate::symbol::Symbol;

/// The result of a method for a driven motion.
pub(super) struct DrivenMotion<'a> {
    pub(super) method: Method,
    pub(super) order: u32,
    /// The small parameter, and those that are small with it.
    pub(super) small: (Symbol, Vec<Symbol>),
    /// All definitions of the answer, that of the detuning among them.
    pub(super) definitions: Vec<Definition>,
    /// The frequency of the motion itself against its amplitude, without damping and drive.
    pub(super) backbone: Law,
    /// `a'` and `psi'`.
    pub(super) rates: [Expr; 2],
    pub(super) phase: Symbol,
    pub(super) drive: &'a Drive,
    /// Omega : omega0.
    pub(super) resonance: (u32, u32),
    pub(super) detuning: Definition,
    pub(super) response: Response,
    pub(super) validity: Vec<Note>,
    pub(super) derivation: Vec<DerivationLine>,
}

impl DrivenMotion<'_> {
    /// The answer, about zero.
    pub(super) fn into_solution(self, oscillator: &Oscillator) -> Solution {
        let convention = AmplitudeConvention::FirstHarmonic;
        let amplitude = Polynomial::symbol(convention.symbol());
        let [amplitude_rate, phase_rate] = self.rates;
        let (small_parameter, small_with) = self.small;
        Solution {
            equation: oscillator.equation(),
            method: self.method,
            order: self.order,
            degrees: None,
            small_parameter,
            amplitude: convention,
            parameters: oscillator.parameters.clone(),
            definitions: self.definitions,
            equilibrium: Expr::zero(),
            law: self.backbone,
            displacement: FourierSeries::cos(POLYNOMIALS, 1)
                .product(&FourierSeries::constant(POLYNOMIALS, amplitude)),
            limit_cycle: None,
            modulation: Some(Modulation {
                amplitude: convention.symbol(),
                phase: self.phase,
                amplitude_rate,
                phase_rate,
                small_with,
                resonance: Some(Resonance {
                    driving_frequency: self.drive.frequency.clone(),
                    times_driving: self.resonance.1,
                    times_linear: self.resonance.0,
                    detuning: self.detuning,
                }),
                release: None,
                transient: None,
                steady: vec![],
                motion: None,
            }),
            response: Some(self.response),
            numerical: false,
            closed_motion: None,
            convergence: None,
            validity: self.validity,
            steps: vec![],
            derivation: self.derivation,
        }
    }
}
