//! The answer of multiple scales for a free motion.

use super::scaling::Scaling;
use crate::derivation::DerivationLine;
use crate::exact::Polynomials;
use crate::expr::Expr;
use crate::oscillator::Oscillator;
use crate::series::FourierSeries;
use crate::solution::{
    AmplitudeConvention, Definition, Law, LimitCycle, Method, Modulation, Note, Solution,
};

/// The results in which a free motion and one on a limit cycle differ.
pub(super) struct MultipleScalesResult {
    pub(super) definitions: Vec<Definition>,
    pub(super) law: Law,
    pub(super) displacement: FourierSeries<Polynomials>,
    pub(super) limit_cycle: Option<LimitCycle>,
    pub(super) modulation: Modulation,
    pub(super) validity: Vec<Note>,
    pub(super) derivation: Vec<DerivationLine>,
}

/// The answer, about zero.
pub(super) fn solution(
    oscillator: &Oscillator,
    scaling: &Scaling,
    found: MultipleScalesResult,
) -> Solution {
    Solution {
        equation: oscillator.equation(),
        method: Method::MultipleScales,
        order: scaling.order,
        degrees: None,
        small_parameter: scaling.small,
        amplitude: AmplitudeConvention::FirstHarmonic,
        parameters: oscillator.parameters.clone(),
        definitions: found.definitions,
        equilibrium: Expr::zero(),
        law: found.law,
        displacement: found.displacement,
        limit_cycle: found.limit_cycle,
        modulation: Some(found.modulation),
        response: None,
        numerical: false,
        closed_motion: None,
        convergence: None,
        validity: found.validity,
        steps: vec![],
        derivation: found.derivation,
    }
}
