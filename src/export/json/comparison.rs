//! Kind `comparison`: every method on one equation.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::number::{constants, finite, named, text};
use super::{Constant, DocumentKind, Map};
use crate::solution::Degrees;
#[cfg(feature = "schema")]
use crate::verify::Verdict;
use crate::verify::comparison::{Comparison, ComparisonRow, Refused};
use crate::verify::validity;

/// Every method on one equation at given values, beside the true motion of the equation as it was
/// typed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct ComparisonDocument {
    /// The kind of document.
    pub schema: String,
    /// The equation of motion as it was understood, `... = 0`; time is its own, so frequencies are
    /// in radians per unit of it.
    pub equation: String,
    /// The values of parameters and amplitude at which the methods are judged.
    pub at: Map<Constant>,
    /// omega of the true motion, in radians per unit of time; null where it cannot be computed.
    pub true_frequency: Option<f64>,
    /// Why there is no true frequency, in words; null where there is one.
    pub reason: Option<String>,
    /// The size of the relative error up to which a verdict is `pass`.
    pub tolerance: f64,
    /// The methods: first those that apply, then those that do not.
    pub methods: Vec<MethodRow>,
    /// Where the true motion is periodic, in words and numbers.
    pub validity: Vec<String>,
}

/// A row of the table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
#[serde(untagged)]
pub enum MethodRow {
    /// A method that applies.
    Applying(Box<ApplyingRow>),
    /// A method that does not apply.
    Refused(RefusedRow),
}

/// A method that applies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct ApplyingRow {
    /// The method, by its name on the command line.
    #[cfg_attr(feature = "schema", schemars(schema_with = "super::generated_schema::methods"))]
    pub method: String,
    /// The highest power kept of the small parameter, inclusive; for a balance the number of
    /// harmonics, for iterations the passes.
    pub order: u32,
    /// The degrees of an approximant, of numerator and denominator or of P, Q and R; null for every
    /// other method.
    pub degrees: Option<Vec<u32>>,
    /// Whether the method applies.
    #[cfg_attr(feature = "schema", schemars(extend("const" = true)))]
    pub applies: bool,
    /// Why there is no frequency at these values, in words; null where there is one.
    pub reason: Option<String>,
    /// Values that the method left open: hbar as it was chosen, the coefficients of a balance as
    /// they were solved for.
    pub chosen: Map<f64>,
    /// The law as text, with the definitions that it needs.
    pub formula: String,
    /// omega by the formula, in radians per unit of time; null where there is none.
    pub frequency: Option<f64>,
    /// frequency / true_frequency - 1, signed, as a fraction; null where one of them is not known.
    pub relative_error: Option<f64>,
    /// The largest |x - x_true| over one true period in real time, as a fraction of the amplitude;
    /// null where it is not known.
    pub max_deviation: Option<f64>,
    /// The range of the amplitude of the table's first row in which the error stays within the
    /// tolerance; null where it is not known.
    pub reach: Option<Reach>,
    /// Whether |relative_error| is within the tolerance; null where the true frequency is not
    /// known.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = [Verdict::Pass.name(), Verdict::Fail.name(), null])))]
    pub verdict: Option<String>,
}

/// A method that does not apply.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct RefusedRow {
    /// The method, by its name on the command line.
    #[cfg_attr(feature = "schema", schemars(schema_with = "super::generated_schema::methods"))]
    pub method: String,
    /// Null.
    pub order: (),
    /// Whether the method applies.
    #[cfg_attr(feature = "schema", schemars(extend("const" = false)))]
    pub applies: bool,
    /// Why it does not, in words.
    pub reason: String,
    /// Null.
    pub formula: (),
    /// Null.
    pub frequency: (),
    /// Null.
    pub relative_error: (),
    /// Null.
    pub max_deviation: (),
    /// Null.
    pub reach: (),
    /// Null.
    pub verdict: (),
}

/// How far a formula is good.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Reach {
    /// The size of the amplitude from which on the error stays within the tolerance, for motions
    /// over several wells, which begin at the separatrix; null for those that begin at rest.
    pub from: Option<f64>,
    /// The size of the amplitude at which the error first crosses the tolerance, in the unit of the
    /// coordinate, 0 where it does so at once; null where no crossing was found.
    pub up_to: Option<f64>,
    /// The size of the amplitude up to which was searched, where no crossing was found; null where
    /// one was.
    pub searched: Option<f64>,
}

/// The document of kind `comparison`.
///
/// ```
/// use lindstedt::{Oscillator, verify::comparison::compare};
///
/// let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
/// let table = compare(&pendulum, &"A = 1".parse()?, None, 0.01)?;
/// let document = lindstedt::export::json::comparison(&table);
/// assert_eq!((document.equation.as_str(), document.tolerance), ("x'' + sin(x) = 0", 0.01));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn comparison(comparison: &Comparison) -> ComparisonDocument {
    let _letters = comparison.letters().in_force();
    let applying = comparison.rows.iter().map(applying);
    ComparisonDocument {
        schema: DocumentKind::Comparison.schema().to_owned(),
        equation: comparison.equation.to_string(),
        at: constants(&comparison.at),
        true_frequency: finite(comparison.true_frequency),
        reason: text(comparison.reason.as_ref()),
        tolerance: comparison.tolerance,
        methods: applying.chain(comparison.refused.iter().map(refused)).collect(),
        validity: comparison.validity.clone(),
    }
}

fn applying(row: &ComparisonRow) -> MethodRow {
    MethodRow::Applying(Box::new(ApplyingRow {
        method: row.solution.method.name().to_owned(),
        order: row.solution.order,
        degrees: row.solution.degrees.map(Degrees::list),
        applies: true,
        reason: text(row.reason.as_ref()),
        chosen: named(row.chosen.iter().copied()),
        formula: row.solution.formula(),
        frequency: finite(row.frequency),
        relative_error: finite(row.relative_error),
        max_deviation: finite(row.max_deviation),
        reach: row.reach.map(reach),
        verdict: row.verdict.map(|verdict| verdict.name().to_owned()),
    }))
}

fn refused(refused: &Refused) -> MethodRow {
    MethodRow::Refused(RefusedRow {
        method: refused.method.name().to_owned(),
        order: (),
        applies: false,
        reason: refused.reason.to_string(),
        formula: (),
        frequency: (),
        relative_error: (),
        max_deviation: (),
        reach: (),
        verdict: (),
    })
}

fn reach(reach: validity::AmplitudeReach) -> Reach {
    let searched = match reach {
        validity::AmplitudeReach::Everywhere(searched) => Some(searched),
        validity::AmplitudeReach::Between { to, open: true, .. } => Some(to),
        validity::AmplitudeReach::Between { .. }
        | validity::AmplitudeReach::UpTo(_)
        | validity::AmplitudeReach::Nowhere => None,
    };
    let from = match reach {
        validity::AmplitudeReach::Between { from, .. } => Some(from),
        _ => None,
    };
    Reach { from, up_to: reach.end(), searched }
}
