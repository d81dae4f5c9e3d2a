//! Kind `one-harmonic`: normal modes of two coordinates with one harmonic, in closed form.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DocumentKind;
use super::number::{Constant, Map, constants, finite, meanings, texts};
use crate::modes::OneHarmonicFamily;
use crate::report::OneHarmonicReport;
use crate::symbol::letters::AMPLITUDE;

/// Normal modes with one harmonic: the second coordinate is the ratio times the first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct OneHarmonicDocument {
    /// The kind of document.
    pub schema: String,
    /// The equations as they were understood.
    pub equations: Vec<String>,
    /// The coordinates.
    pub coordinates: Vec<String>,
    /// The letters of the equations, in alphabetical order.
    pub parameters: Vec<String>,
    /// The method: `harmonic-balance`.
    pub method: String,
    /// The symbol of the amplitude, the start of the first coordinate.
    pub amplitude_symbol: String,
    /// The symbol of the ratio.
    pub ratio_symbol: String,
    /// The families of modes.
    pub families: Vec<OneHarmonicFamilyDocument>,
    /// The places where another family branches off a similar mode.
    pub branch_points: Vec<OneHarmonicBranchDocument>,
    /// What the formulas name.
    pub definitions: Map<String>,
    /// The values; null without them.
    pub at: Option<Map<Constant>>,
    /// The modes that have the amplitude, the slowest first.
    pub motions: Vec<OneHarmonicMotionDocument>,
    /// `pass` or `fail`; null without values.
    pub verdict: Option<String>,
    /// The largest relative error that passes; null without values.
    pub tolerance: Option<f64>,
}

/// A family of modes: formulas of two of ratio, A^2 and omega^2 in the parameter of the family.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "OneHarmonicFamily"))]
pub struct OneHarmonicFamilyDocument {
    /// The parameter: `amplitude` of a similar mode, `ratio` or `frequency`.
    pub along: String,
    /// The ratio, a formula; null where it is the parameter.
    pub ratio: Option<String>,
    /// A^2, a formula; null where A is the parameter.
    pub amplitude_squared: Option<String>,
    /// omega^2, a formula; null where omega is the parameter.
    pub omega_squared: Option<String>,
}

/// A place where another family branches off a similar mode.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "OneHarmonicBranchPoint"))]
pub struct OneHarmonicBranchDocument {
    /// The ratio of the similar mode.
    pub ratio: String,
    /// What is fixed there: the square of the amplitude, or a letter.
    pub quantity: String,
    /// Its value, a formula.
    pub value: String,
}

/// A mode at an amplitude beside the true motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "OneHarmonicMotion"))]
pub struct OneHarmonicMotionDocument {
    /// The number of its family, from 1.
    pub family: usize,
    /// The ratio.
    pub ratio: f64,
    /// omega.
    pub omega: f64,
    /// omega of the true motion from the same start of the first coordinate; null if none was found
    /// near.
    pub true_omega: Option<f64>,
    /// `omega/true_omega - 1`; null without a true motion.
    pub relative_error: Option<f64>,
}

/// The document of kind `one-harmonic`.
///
/// ```
/// use lindstedt::modes::{FreeSystem, one_harmonic_modes};
/// use lindstedt::report::OneHarmonicReport;
///
/// let pair = FreeSystem::parse("x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0")?;
/// let modes = one_harmonic_modes(&pair)?;
/// let document = lindstedt::export::json::one_harmonic(&OneHarmonicReport { modes: &modes, judged: None });
/// assert_eq!(document.families[0].ratio.as_deref(), Some("1/(2 - omega^2)"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn one_harmonic(report: &OneHarmonicReport) -> OneHarmonicDocument {
    let modes = report.modes;
    let equations = &modes.system.equations;
    let sides = equations.equations.iter().map(|(left, right)| format!("{left} = {right}"));
    let judged = report.judged;
    OneHarmonicDocument {
        schema: DocumentKind::OneHarmonic.schema().to_owned(),
        equations: sides.collect(),
        coordinates: texts(&equations.coordinates),
        parameters: texts(&equations.parameters),
        method: crate::solution::Method::HarmonicBalance.name().to_owned(),
        amplitude_symbol: AMPLITUDE.to_string(),
        ratio_symbol: modes.ratio.to_string(),
        families: modes.families.iter().map(family).collect(),
        branch_points: modes
            .branch_points
            .iter()
            .map(|point| OneHarmonicBranchDocument {
                ratio: point.ratio.to_string(),
                quantity: point.at.0.to_string(),
                value: point.at.1.to_string(),
            })
            .collect(),
        definitions: meanings(&modes.definitions),
        at: judged.map(|judged| constants(&judged.at)),
        motions: judged
            .iter()
            .flat_map(|judged| &judged.motions)
            .map(|motion| OneHarmonicMotionDocument {
                family: motion.family + 1,
                ratio: motion.ratio,
                omega: motion.frequency,
                true_omega: finite(motion.true_frequency),
                relative_error: finite(motion.relative_error),
            })
            .collect(),
        verdict: judged.map(|judged| judged.verdict.name().to_owned()),
        tolerance: judged.map(|judged| judged.tolerance),
    }
}

fn family(family: &OneHarmonicFamily) -> OneHarmonicFamilyDocument {
    let text = |formula: &crate::expr::Expr| Some(formula.to_string());
    let (along, ratio, amplitude_squared, omega_squared) = match family {
        OneHarmonicFamily::Similar { ratio, frequency_squared } => {
            ("amplitude", text(ratio), None, text(frequency_squared))
        }
        OneHarmonicFamily::AlongRatio { amplitude_squared, frequency_squared } => {
            ("ratio", None, text(amplitude_squared), text(frequency_squared))
        }
        OneHarmonicFamily::AlongFrequency { ratio, amplitude_squared } => {
            ("frequency", text(ratio), text(amplitude_squared), None)
        }
    };
    OneHarmonicFamilyDocument { along: along.to_owned(), ratio, amplitude_squared, omega_squared }
}
