//! Kind `stability`: transition curves of a linear equation with periodic coefficients.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DocumentKind;
use super::number::{Constant, Map, Polynomial, constants, finite, texts};
use crate::expr::Expr;
use crate::report::StabilityReport;

/// The curves on which a linear equation with periodic coefficients changes between stable and
/// unstable.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct StabilityDocument {
    /// The kind of document.
    pub schema: String,
    /// The equation as it was understood.
    pub equation: String,
    /// The letter that the curves are solved for.
    pub unknown: String,
    /// What a curve gives: that letter, or its square where it is a frequency.
    pub gives: String,
    /// Highest power of the small parameters, all together, that is kept.
    pub order: u32,
    /// What is small.
    pub small_parameters: Vec<String>,
    /// The letters of the equation, in alphabetical order.
    pub parameters: Vec<String>,
    /// The angular frequency of the coefficients, a formula.
    pub frequency: String,
    /// The curves, by the number of their tongue.
    pub curves: Vec<TransitionCurve>,
    /// The curves at values beside the truth; null without values.
    pub verification: Option<StabilityVerification>,
}

/// A transition curve: `curve + sign*sqrt(under_root)`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct TransitionCurve {
    /// `a1`, `b1` for motions of cosines and of sines; `lower1`, `upper1` where they are of both.
    pub name: String,
    /// n: on the curve a motion of the frequency n*Omega/2 exists.
    pub tongue: usize,
    /// Floquet's multiplier of that motion over a period of the coefficients: 1 or -1.
    pub multiplier: i32,
    /// The curve, or the middle of the two.
    pub curve: Polynomial,
    /// What stands under the root; null where there is none.
    pub under_root: Option<Polynomial>,
    /// The sign before the root: 1 or -1; 0 where there is none.
    pub sign: i32,
}

/// The curves at values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct StabilityVerification {
    /// The values.
    pub at: Map<Constant>,
    /// The relative error up to which a curve passes.
    pub tolerance: f64,
    /// The curves, in the same order.
    pub curves: Vec<JudgedCurve>,
    /// Whether all of them pass: `pass` or `fail`.
    pub verdict: String,
}

/// A curve at the values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct JudgedCurve {
    /// Its name.
    pub name: String,
    /// The unknown by the formula; null where it is not real.
    pub value: Option<f64>,
    /// The unknown in truth, by Hill's determinant and Floquet's multipliers; null where the tongue
    /// does not reach so far.
    pub true_value: Option<f64>,
    /// `value/true_value - 1`; null where one of them is null.
    pub relative_error: Option<f64>,
    /// `pass` or `fail`.
    pub verdict: String,
}

fn verdict(passes: bool) -> String {
    if passes { "pass" } else { "fail" }.to_owned()
}

/// The document of kind `stability`.
///
/// ```
/// use lindstedt::Oscillator;
/// use lindstedt::hill::{HillOptions, transition_curves};
/// use lindstedt::report::StabilityReport;
///
/// let mathieu = Oscillator::parse("x'' + (delta + eps*cos(2*t))*x = 0")?;
/// let curves = transition_curves(&mathieu, &HillOptions::default())?;
/// let report = StabilityReport { curves: &curves, judged: None, tolerance: 0.01 };
/// assert_eq!(lindstedt::export::json::stability(&report).curves[1].name, "a1");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn stability(report: &StabilityReport) -> StabilityDocument {
    let curves = report.curves;
    let polynomial = |polynomial| Polynomial::of_sum(&curves.ordered(polynomial));
    let unknown = curves.unknown.symbol().to_string();
    StabilityDocument {
        schema: DocumentKind::Stability.schema().to_owned(),
        equation: curves.equation.to_string(),
        gives: Expr::from(&curves.unknown.given()).to_string(),
        unknown,
        order: curves.order,
        small_parameters: texts(&curves.small),
        parameters: texts(&curves.parameters),
        frequency: curves.driving_frequency().to_string(),
        curves: curves
            .curves
            .iter()
            .map(|curve| TransitionCurve {
                name: curve.name.clone(),
                tongue: curve.tongue,
                multiplier: if curve.tongue.is_multiple_of(2) { 1 } else { -1 },
                curve: polynomial(&curve.middle),
                under_root: curve.under_root.as_ref().map(polynomial),
                sign: match (&curve.under_root, curve.upper) {
                    (None, _) => 0,
                    (Some(_), true) => 1,
                    (Some(_), false) => -1,
                },
            })
            .collect(),
        verification: report.judged.map(|(at, judged)| StabilityVerification {
            at: constants(at),
            tolerance: report.tolerance,
            curves: judged
                .iter()
                .map(|judged| JudgedCurve {
                    name: curves.curves[judged.curve].name.clone(),
                    value: finite(judged.value),
                    true_value: finite(judged.truth),
                    relative_error: finite(judged.relative_error),
                    verdict: verdict(judged.passes),
                })
                .collect(),
            verdict: verdict(report.passes() == Some(true)),
        }),
    }
}
