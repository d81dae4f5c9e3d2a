//! Kind `absorber`: design formulas of a vibration absorber.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DocumentKind;
use super::number::{Constant, Map, constants, finite, meanings, named};
use crate::absorber::{AbsorberKind, Excitation};
use crate::report::AbsorberReport;

/// Design formulas of a vibration absorber, a small mass that takes the vibration of a large one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct AbsorberDocument {
    /// The kind of document.
    pub schema: String,
    /// The kind of absorber: `tuned`, `damped`, `nonlinear`, `impact-sink`, `pendulum-sink` or `cubic-sink`.
    pub absorber: String,
    /// What shakes the main mass of a tuned mass damper, `force` or `ground`; null of other kinds.
    pub excitation: Option<String>,
    /// The equations of motion.
    pub equations: Vec<String>,
    /// The letters of equations and formulas, each with its meaning.
    pub letters: Map<String>,
    /// The symbols that shorten the formulas.
    pub definitions: Map<String>,
    /// The equations from which the designs follow.
    pub relations: Vec<AbsorberRelationDocument>,
    /// The designs.
    pub designs: Vec<AbsorberDesignDocument>,
    /// What the formulas leave out, in words.
    pub validity: String,
    /// The values; null without them.
    pub at: Option<Map<Constant>>,
    /// The tuned mass damper with the lowest peak, by a search where no formula gives it; null otherwise,
    /// and without values.
    pub lowest_peak: Option<LowestPeakDocument>,
    /// A simulated motion that follows the manifold of a sink; null without values, of a tuned
    /// or nonlinear absorber, and where the motion does not follow it.
    pub motion: Option<AbsorberMotionDocument>,
    /// The amplitudes at which the body of an impact sink touches a wall between its impacts, where its
    /// motion ends while it is stable; null where it does not, and without values.
    #[serde(default)]
    pub touch: Option<AbsorberTouchDocument>,
    /// `pass` or `fail`; null without values.
    pub verdict: Option<String>,
    /// The largest relative error that passes; null without values.
    pub tolerance: Option<f64>,
}

/// An equation on the way to the designs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "AbsorberRelation"))]
pub struct AbsorberRelationDocument {
    /// The equation.
    pub equation: String,
    /// What it says, in words.
    pub words: String,
}

/// A way to choose the absorber, or a property of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "AbsorberDesign"))]
pub struct AbsorberDesignDocument {
    /// The name: `equal-peaks`, `lowest-peak` and `lowest-variance` of a tuned mass damper,
    /// `similar-springs` of a nonlinear absorber, `threshold` and `period-doubling` of an impact or pendulum sink,
    /// `upward-jump` and `downward-jump` of a cubic sink.
    pub name: String,
    /// What is best of it, in words.
    pub words: String,
    /// Its formulas.
    pub formulas: Vec<AbsorberFormulaDocument>,
}

/// A formula of a design.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "AbsorberFormula"))]
pub struct AbsorberFormulaDocument {
    /// The name of the quantity, such as `tuning` or `damping`.
    pub name: String,
    /// The symbol of the quantity.
    pub symbol: String,
    /// The formula.
    pub formula: String,
    /// Its value; null without values, and where there is no such design (no positive value).
    pub value: Option<f64>,
    /// The true value, by a search over the responses or motions of the two masses; null without
    /// values, and where none was found.
    pub truth: Option<f64>,
    /// `value/truth - 1`; null likewise.
    pub relative_error: Option<f64>,
}

/// The tuned mass damper with which the highest amplitude at any frequency is the least.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "LowestPeak"))]
pub struct LowestPeakDocument {
    /// The natural frequency of the absorber alone over that of the main mass alone.
    pub tuning: f64,
    /// The damping ratio of the absorber alone.
    pub damping: f64,
    /// The highest amplitude over the static one.
    pub height: f64,
}

/// A simulated motion that follows the manifold of a sink.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "AbsorberMotion"))]
pub struct AbsorberMotionDocument {
    /// What is simulated, in words.
    pub words: String,
    /// The amplitude of the main mass at the start.
    pub start: f64,
    /// The amplitude of the main mass where the motion leaves the manifold.
    pub end: f64,
    /// The largest distance of its two amplitudes from those on the manifold, over those of the
    /// start.
    pub largest_distance: f64,
    /// The time that it takes; null where there is no formula of it.
    #[serde(default)]
    pub decay: Option<AbsorberDecayDocument>,
}

/// The motion with two impacts a period at which the body touches a wall between them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "AbsorberTouch"))]
pub struct AbsorberTouchDocument {
    /// The amplitude of the main mass.
    pub amplitude: f64,
    /// The amplitude of the sink.
    pub sink: f64,
}

/// The time in which the amplitude of the main mass falls, on a simulated motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "AbsorberDecay"))]
pub struct AbsorberDecayDocument {
    /// The amplitudes of the main mass at the start and at the end.
    pub amplitudes: [f64; 2],
    /// The time by the formula, in units of 1/(the frequency of the main mass).
    pub formula: f64,
    /// The time of the simulated motion.
    pub truth: f64,
}

/// The document of kind `absorber`.
///
/// ```
/// use lindstedt::absorber::{AbsorberKind, Excitation, derive};
/// use lindstedt::report::AbsorberReport;
///
/// let laws = derive(AbsorberKind::Tuned(Excitation::Force))?;
/// let document = lindstedt::export::json::absorber(&AbsorberReport { laws: &laws, judged: None });
/// assert_eq!(document.designs[0].formulas[2].formula, "sqrt((2 + mu)/mu)");
/// # Ok::<(), lindstedt::absorber::AbsorberError>(())
/// ```
pub fn absorber(report: &AbsorberReport) -> AbsorberDocument {
    let (laws, judged) = (report.laws, report.judged);
    let designs = laws.designs.iter().map(|design| AbsorberDesignDocument {
        name: design.name.to_owned(),
        words: design.words.to_owned(),
        formulas: design
            .formulas
            .iter()
            .map(|own| {
                let judged = judged.iter().flat_map(|judged| &judged.formulas);
                let judged = judged
                    .into_iter()
                    .find(|row| (row.design, row.name) == (design.name, own.name));
                AbsorberFormulaDocument {
                    name: own.name.to_owned(),
                    symbol: own.symbol.to_string(),
                    formula: own.formula.to_string(),
                    value: finite(judged.and_then(|judged| judged.value)),
                    truth: finite(judged.and_then(|judged| judged.truth)),
                    relative_error: finite(judged.and_then(|judged| judged.relative_error)),
                }
            })
            .collect(),
    });
    let relations = laws.relations.iter().map(|relation| AbsorberRelationDocument {
        equation: format!("{} = {}", relation.left, relation.right),
        words: relation.words.to_owned(),
    });
    let motion = judged.and_then(|judged| judged.motion.as_ref());
    AbsorberDocument {
        schema: DocumentKind::Absorber.schema().to_owned(),
        absorber: laws.kind.name().to_owned(),
        excitation: match laws.kind {
            AbsorberKind::Tuned(excitation) | AbsorberKind::Damped(excitation) => {
                let words = match excitation {
                    Excitation::Force => "force",
                    Excitation::Ground => "ground",
                };
                Some(words.to_owned())
            }
            AbsorberKind::Nonlinear
            | AbsorberKind::ImpactSink
            | AbsorberKind::PendulumSink
            | AbsorberKind::CubicSink => None,
        },
        equations: laws.equations.iter().map(|(left, right)| format!("{left} = {right}")).collect(),
        letters: named(laws.meanings.iter().map(|(name, words)| (name, (*words).to_owned()))),
        definitions: meanings(&laws.definitions),
        relations: relations.collect(),
        designs: designs.collect(),
        validity: laws.validity.to_owned(),
        at: judged.map(|judged| constants(&judged.at)),
        lowest_peak: judged.and_then(|judged| judged.lowest_peak).map(|peak| LowestPeakDocument {
            tuning: peak.tuning,
            damping: peak.damping,
            height: peak.height,
        }),
        motion: motion.map(|motion| AbsorberMotionDocument {
            words: motion.words.to_owned(),
            start: motion.start,
            end: motion.end,
            largest_distance: motion.largest_distance,
            decay: motion.decay.map(|decay| AbsorberDecayDocument {
                amplitudes: decay.amplitudes,
                formula: decay.formula,
                truth: decay.truth,
            }),
        }),
        touch: judged
            .and_then(|judged| judged.touch)
            .map(|touch| AbsorberTouchDocument { amplitude: touch.amplitude, sink: touch.sink }),
        verdict: judged.and_then(|judged| Some(judged.verdict?.name().to_owned())),
        tolerance: judged.map(|judged| judged.tolerance),
    }
}
