//! Kind `modes`: the nonlinear normal modes of coupled equations.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DocumentKind;
use super::number::{Constant, Map, Polynomial, constants, finite, meanings, named, texts};
use super::solution::Harmonic;
use crate::modes::NonlinearMode;
use crate::report::ModesReport;
use crate::symbol::Symbol;
use crate::verify::JudgedMode;

/// The nonlinear normal modes of coupled equations that nothing drives or damps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct ModesDocument {
    /// The kind of document.
    pub schema: String,
    /// The equations as they were understood.
    pub equations: Vec<String>,
    /// The coordinates.
    pub coordinates: Vec<String>,
    /// The place of rest from which each coordinate is counted, a formula.
    pub rest: Map<String>,
    /// The letters of the equations, in alphabetical order.
    pub parameters: Vec<String>,
    /// The method: `lindstedt-poincare`; `pade`, with an approximant of omega^2 on top; or
    /// `harmonic-balance`.
    pub method: String,
    /// The highest power of the amplitude in omega^2 that was asked for, or the number of harmonics.
    pub order: u32,
    /// What the amplitude measures: `first-harmonic` or `initial`.
    pub amplitude: String,
    /// The symbol of the amplitude.
    pub amplitude_symbol: String,
    /// The number of all modes.
    pub count: usize,
    /// The modes that have formulas, the slowest first.
    pub modes: Vec<ModeDocument>,
    /// The reasons why other modes have none.
    pub refused: Vec<String>,
    /// The largest relative error of omega that passes; null without values.
    pub tolerance: Option<f64>,
}

/// A nonlinear normal mode. Its polynomials are in the letters of the equations, the symbol of the
/// amplitude and those of `definitions`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "Mode"))]
pub struct ModeDocument {
    /// Its number, 1 for the slowest.
    pub number: usize,
    /// The highest power of the amplitude in omega^2 that was reached, or the number of harmonics.
    pub order: u32,
    /// omega^2 of the linear mode.
    pub linear_omega_squared: Polynomial,
    /// The linear mode: each coordinate over the first that moves.
    pub shape: Map<Polynomial>,
    /// The factors of the coordinates in the sum of which the amplitude is that of the first harmonic.
    pub modal_coordinate: Map<Polynomial>,
    /// omega^2 in powers of the amplitude; in omega itself where a balance gives it.
    pub omega_squared: Polynomial,
    /// A quotient of polynomials that agrees with omega_squared and stands for it, as text; left out
    /// where it was not asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub approximant: Option<String>,
    /// The balance of harmonics that determines omega and the coefficients of the motion; left out for
    /// a series.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub balance: Option<ModeBalanceDocument>,
    /// The law in one line.
    pub formula: String,
    /// The harmonics of each coordinate in theta = omega*t.
    pub motion: Map<Vec<Harmonic>>,
    /// The coordinate in which the modal lines are written.
    pub along: String,
    /// Each other coordinate as a polynomial in that one and the amplitude, up to third powers.
    pub modal_lines: Map<Polynomial>,
    /// What the formulas name, each by those before it.
    pub definitions: Map<String>,
    /// Whether coefficients are rounded to fifteen digits, because the linear frequency is no fraction.
    pub numerical: bool,
    /// The derivation line by line, as text; left out where it was not asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub derivation: Option<Vec<String>>,
    /// The mode at values beside the true motion; null without values.
    pub verification: Option<ModeVerification>,
    /// The reason why no true motion was found; null where one was, or none was asked for.
    pub unjudged: Option<String>,
}

/// The balance of several harmonics of every coordinate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "ModeBalance"))]
pub struct ModeBalanceDocument {
    /// The harmonics that are balanced.
    pub harmonics: Vec<usize>,
    /// The unknowns: omega and the coefficients of the motion.
    pub unknowns: Vec<String>,
    /// Equations, each of them equal to zero; empty where they are not written out.
    pub equations: Vec<String>,
}

/// A mode beside the true motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct ModeVerification {
    /// The values.
    pub at: Map<Constant>,
    /// omega by the formula; null if its square is not positive.
    pub omega: Option<f64>,
    /// The coefficients of omega^2 in powers of the amplitude with numbers for all letters, the
    /// constant first; left out where the formula is no polynomial of it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub law: Vec<f64>,
    /// The coefficients that a balance has at the values; left out for a series.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    pub coefficients: Map<f64>,
    /// omega of the true motion, by shooting.
    pub true_omega: f64,
    /// `omega/true_omega - 1`; null where there is no omega.
    pub relative_error: Option<f64>,
    /// The mode from small amplitudes up to this one, the linear motion first.
    #[serde(default)]
    pub backbone: Vec<ModeBackbonePoint>,
    /// Largest deviation of a coordinate at the same theta, as a part of the largest displacement.
    pub max_deviation: f64,
    /// The measured exponent of the error of omega; null if rounding hides it.
    pub slope: Option<f64>,
    /// `pass` or `fail`.
    pub verdict: String,
}

/// A motion of a mode at an amplitude.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct ModeBackbonePoint {
    /// The amplitude.
    pub amplitude: f64,
    /// omega by the formula; null if its square is not positive.
    pub omega: Option<f64>,
    /// omega of the true motion.
    pub true_omega: f64,
    /// The energy of the true motion over that of rest; null where the forces have no potential that is known.
    pub energy: Option<f64>,
}

/// The document of kind `modes`.
///
/// ```
/// use lindstedt::modes::{FreeSystem, ModeOptions, derive};
/// use lindstedt::report::ModesReport;
///
/// let pair = FreeSystem::parse("x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0")?;
/// let modes = derive(&pair, &ModeOptions::default())?;
/// let report = ModesReport { modes: &modes, judged: &[], tolerance: 0.01 };
/// assert_eq!(lindstedt::export::json::modes(&report).modes[1].omega_squared.terms[2].exact, "1429/26624");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn modes(report: &ModesReport) -> ModesDocument {
    let modes = report.modes;
    let equations = &modes.system.equations;
    let sides = equations.equations.iter().map(|(left, right)| format!("{left} = {right}"));
    ModesDocument {
        schema: DocumentKind::Modes.schema().to_owned(),
        equations: sides.collect(),
        coordinates: texts(&equations.coordinates),
        rest: named(
            equations.coordinates.iter().zip(modes.system.rest.iter().map(ToString::to_string)),
        ),
        parameters: texts(&equations.parameters),
        method: modes.method().name().to_owned(),
        order: modes.order,
        amplitude: modes.amplitude.name().to_owned(),
        amplitude_symbol: modes.amplitude.symbol().to_string(),
        count: modes.count,
        modes: report
            .judged_modes()
            .map(|(mode, judged)| one_mode(mode, judged, &equations.coordinates))
            .collect(),
        refused: modes
            .modes
            .iter()
            .filter_map(|mode| mode.as_ref().err().map(ToString::to_string))
            .collect(),
        tolerance: (!report.judged.is_empty()).then_some(report.tolerance),
    }
}

fn one_mode(
    mode: &NonlinearMode,
    judged: Option<&Result<JudgedMode, String>>,
    coordinates: &[Symbol],
) -> ModeDocument {
    let polynomial = |of: &crate::exact::Polynomial| Polynomial::of_sum(&mode.ordered(of));
    let each = |entries: &[crate::exact::Polynomial]| {
        named(coordinates.iter().zip(entries.iter().map(polynomial)))
    };
    let motion = mode.motion.iter().map(|series| {
        let harmonics = series.harmonics().into_iter();
        harmonics
            .map(|(harmonic, cos, sin)| Harmonic {
                harmonic,
                cos: polynomial(&cos),
                sin: polynomial(&sin),
            })
            .collect()
    });
    let others = coordinates.iter().zip(&mode.lines).enumerate();
    let others = others.filter(|(index, _)| *index != mode.along);
    ModeDocument {
        number: mode.number,
        order: mode.order,
        linear_omega_squared: polynomial(&mode.linear.square),
        shape: each(&mode.linear.shape),
        modal_coordinate: each(&mode.linear.modal),
        omega_squared: polynomial(&mode.frequency_squared),
        approximant: mode.approximant.as_ref().map(|_| mode.formula().replace("omega^2 = ", "")),
        balance: mode.balance.as_ref().map(|balance| ModeBalanceDocument {
            harmonics: balance.harmonics.clone(),
            unknowns: texts(balance.unknowns()),
            equations: balance.equations.iter().map(ToString::to_string).collect(),
        }),
        formula: mode.formula(),
        motion: named(coordinates.iter().zip(motion)),
        along: coordinates[mode.along].to_string(),
        modal_lines: named(others.map(|(_, (name, line))| (name, polynomial(line)))),
        definitions: meanings(&mode.definitions),
        numerical: mode.rounded,
        derivation: (!mode.derivation.is_empty())
            .then(|| mode.derivation.iter().map(ToString::to_string).collect()),
        verification: judged.and_then(|judged| judged.as_ref().ok()).map(verification),
        unjudged: judged.and_then(|judged| judged.as_ref().err().cloned()),
    }
}

fn verification(judged: &JudgedMode) -> ModeVerification {
    ModeVerification {
        at: constants(&judged.at),
        omega: finite(judged.frequency),
        law: judged.law.clone(),
        coefficients: named(judged.coefficients.iter().copied()),
        true_omega: judged.true_frequency,
        relative_error: finite(judged.relative_error),
        backbone: judged
            .backbone
            .iter()
            .map(|point| ModeBackbonePoint {
                amplitude: point.amplitude,
                omega: finite(point.frequency),
                true_omega: point.true_frequency,
                energy: finite(point.energy),
            })
            .collect(),
        max_deviation: judged.max_deviation,
        slope: finite(judged.slope),
        verdict: judged.verdict.name().to_owned(),
    }
}
