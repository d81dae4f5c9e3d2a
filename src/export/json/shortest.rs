//! Kind `shortest`: the best frequency laws on a range by length.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DocumentKind;
use super::number::{Constant, Map, finite, named};
use crate::certificate::StartOfLaw;
use crate::exact::Rational;
use crate::exact::rational::to_f64;
use crate::report::ShortestReport;
use crate::shortest::{LawMotion, MeasuredFormula, ShortLaw};

/// The best frequency laws on a range: for each length the one with the smallest largest error.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct ShortestDocument {
    /// The kind of document.
    pub schema: String,
    /// The equation of motion, `... = 0`, with numbers for all but the variable; of modes all equations,
    /// separated by `;`.
    pub equation: String,
    /// The name of the variable.
    pub variable: String,
    /// The product that the variable stands for, `eps*A^2` say; null for the amplitude or a parameter.
    pub meaning: Option<String>,
    /// The amplitude where a parameter varies; null where the amplitude does, for limit cycles and contacts.
    pub amplitude: Option<Constant>,
    /// The lower end of the range.
    pub from: Constant,
    /// The upper end; null for infinity.
    pub to: Option<Constant>,
    /// The number of the normal mode; null for one coordinate.
    pub mode: Option<usize>,
    /// The quantity of the laws: `omega`, `omega^2`, `T/(2*pi)` or `T/T_0`.
    pub quantity: String,
    /// The names in the laws besides the variable, each with its meaning in it; `restitution` for the
    /// coefficient of restitution of a contact.
    pub atoms: Map<String>,
    /// The number of the shortest law within that error, counted from zero; null where none is, and the
    /// last one without an error.
    pub chosen: Option<usize>,
    /// The laws, the shortest first, each with a smaller error than all before.
    pub laws: Vec<ShortLawDocument>,
    /// Published formulas beside them.
    pub published: Vec<PublishedFormulaDocument>,
    /// `pass` where a law is proved to be within the error, `fail` where none is; null without an error.
    pub verdict: Option<String>,
    /// The largest error that is asked for; null without it.
    pub error: Option<f64>,
}

/// A law and its largest error.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "ShortLaw"))]
pub struct ShortLawDocument {
    /// The formula.
    pub formula: String,
    /// The number of its symbols: digits, names, functions and signs.
    pub length: usize,
    /// The largest relative error that was measured.
    pub measured: f64,
    /// The value of the variable at which that is.
    pub worst: f64,
    /// The ends between which the largest error is proved to be; null without a proof.
    pub proved: Option<[f64; 2]>,
    /// The reason why there is no proof; null where there is one.
    pub reason: Option<String>,
}

/// A published formula and its largest error.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "PublishedFormula"))]
pub struct PublishedFormulaDocument {
    /// The formula.
    pub formula: String,
    /// Its quantity: `omega`, `omega^2`, `T/(2*pi)` or `T/T_0`.
    pub quantity: String,
    /// The publication.
    pub source: String,
    /// The number of its symbols.
    pub length: usize,
    /// The largest relative error that was measured; null where it has no value somewhere.
    pub measured: Option<f64>,
    /// The value of the variable at which that is.
    pub worst: f64,
}

/// The document of kind `shortest`.
pub fn shortest(report: &ShortestReport) -> ShortestDocument {
    let front = report.front;
    let constant = |value: &Rational| Constant {
        exact: value.to_string(),
        value: finite(Some(to_f64(value))),
    };
    let atoms = front.atoms.iter().filter(|atom| atom.name != front.problem.variable);
    ShortestDocument {
        schema: DocumentKind::Shortest.schema().to_owned(),
        equation: report.equation.clone(),
        variable: front.problem.variable.to_string(),
        meaning: front.problem.meaning.as_ref().map(ToString::to_string),
        mode: match &front.problem.motion {
            LawMotion::Mode { mode, .. } => Some(mode.number),
            _ => None,
        },
        amplitude: match front.problem.start() {
            Some(StartOfLaw::Fixed(start)) if front.problem.meaning.is_none() => {
                Some(constant(start))
            }
            _ => None,
        },
        from: constant(&front.problem.from),
        to: front.problem.to.as_ref().map(constant),
        quantity: front.quantity.name().to_owned(),
        atoms: named(atoms.map(|atom| {
            let meaning = atom.meaning.as_ref().map(ToString::to_string);
            (&atom.name, meaning.unwrap_or_else(|| "restitution".to_owned()))
        })),
        chosen: report.chosen(),
        laws: front.laws.iter().map(law).collect(),
        published: front.published.iter().map(published).collect(),
        verdict: report.verdict().map(|verdict| verdict.name().to_owned()),
        error: report.error,
    }
}

fn law(law: &ShortLaw) -> ShortLawDocument {
    let proof = law.proof.as_ref();
    ShortLawDocument {
        formula: law.formula.to_string(),
        length: law.length,
        measured: law.error,
        worst: law.worst,
        proved: proof.ok().map(|(certificate, _)| certificate.claim.each_ref().map(to_f64)),
        reason: proof.err().map(ToString::to_string),
    }
}

fn published(measured: &MeasuredFormula) -> PublishedFormulaDocument {
    PublishedFormulaDocument {
        formula: measured.published.text.clone(),
        quantity: measured.published.quantity.name().to_owned(),
        source: measured.published.source.clone(),
        length: measured.length,
        measured: finite(Some(measured.error)),
        worst: measured.worst,
    }
}
