//! Kind `impact-comparison`: every method on one impact.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DocumentKind;
use super::impact::{Judged, Parameters};
use crate::impact::{ImpactComparison, ImpactRow};
use crate::solution::Degrees;
#[cfg(feature = "schema")]
use crate::verify::Verdict;

/// Every method on one impact, beside Runge-Kutta on the equation as it stands. Units as in a
/// document of kind `impact`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct ImpactComparisonDocument {
    /// The kind of document.
    pub schema: String,
    /// The equation of motion that is judged, `... = 0`, its force on the barrier included.
    pub equation: String,
    /// The numbers of the problem.
    pub parameters: Parameters,
    /// The numbers of the true motion.
    pub runge_kutta: TrueNumbers,
    /// The size of the relative error up to which a verdict is `pass`.
    pub tolerance: f64,
    /// The rows: the paper's readings and the methods that apply, then those that do not.
    pub methods: Vec<ImpactMethodRow>,
}

/// The numbers of the true motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct TrueNumbers {
    /// The time from the release to the touch, in units of time.
    pub time_to_contact: f64,
    /// The speed at the touch, in radians per unit of time.
    pub speed: f64,
    /// The greatest depth in the barrier, in radians.
    pub penetration: f64,
    /// The time from touch to release, in units of time.
    pub duration: f64,
    /// The time from release to release, in units of time.
    pub period: f64,
}

/// A row of the table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct ImpactMethodRow {
    /// The method, by its name on the command line; `paper` and `energy` are the paper's readings.
    pub method: String,
    /// The order that was chosen; null for a method without one.
    pub order: Option<u32>,
    /// The degrees of an approximant, of numerator and denominator or of P, Q and R; null for every
    /// other method.
    pub degrees: Option<Vec<u32>>,
    /// Whether the method applies.
    pub applies: bool,
    /// Why it does not, in words; null where it does.
    pub reason: Option<String>,
    /// The time from the release to the touch, in units of time; this and the rest is null where
    /// the method does not apply.
    pub time_to_contact: Option<Judged>,
    /// The speed at the touch, in radians per unit of time.
    pub speed: Option<Judged>,
    /// The greatest depth in the barrier, in radians.
    pub penetration: Option<Judged>,
    /// The time from touch to release, in units of time.
    pub duration: Option<Judged>,
    /// The time from release to release, in units of time.
    pub period: Option<Judged>,
    /// The largest |x - x_true| in approach, contact and return, each on its own clock: of the
    /// flights as a fraction of the amplitude, of the contact as one of the true depth.
    pub max_deviation_by_phase: Option<[f64; 3]>,
    /// Whether every number and every phase is within the tolerance.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = [Verdict::Pass.name(), Verdict::Fail.name(), null])))]
    pub verdict: Option<String>,
}

/// The document of kind `impact-comparison`.
///
/// ```
/// use lindstedt::impact::{Setup, compare};
///
/// let table = compare(Setup { stiffness: 1e6, ..Setup::default() })?;
/// let document = lindstedt::export::json::impact_comparison(&table, 0.01);
/// assert_eq!(document.methods[0].method, "paper");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn impact_comparison(table: &ImpactComparison, tolerance: f64) -> ImpactComparisonDocument {
    let [time_to_contact, speed, penetration, duration, period] = table.truth.quantities();
    let applying = table.rows.iter().map(|row| applying(row, tolerance));
    let refused = table.refused.iter().map(|(method, reason)| ImpactMethodRow {
        method: method.name().to_owned(),
        order: None,
        degrees: None,
        applies: false,
        reason: Some(reason.clone()),
        time_to_contact: None,
        speed: None,
        penetration: None,
        duration: None,
        period: None,
        max_deviation_by_phase: None,
        verdict: None,
    });
    ImpactComparisonDocument {
        schema: DocumentKind::ImpactComparison.schema().to_owned(),
        equation: table.equation.clone(),
        parameters: Parameters::new(
            &table.setup,
            [table.equilibrium, table.turning_point],
            None,
            table.damping,
        ),
        runge_kutta: TrueNumbers { time_to_contact, speed, penetration, duration, period },
        tolerance,
        methods: applying.chain(refused).collect(),
    }
}

fn applying(row: &ImpactRow, tolerance: f64) -> ImpactMethodRow {
    let (values, errors) = (row.phases.quantities(), row.errors);
    let [time_to_contact, speed, penetration, duration, period] =
        std::array::from_fn(|index| Some(Judged { value: values[index], error: errors[index] }));
    ImpactMethodRow {
        method: row.method.name().to_owned(),
        order: row.order,
        degrees: row.degrees.map(Degrees::list),
        applies: true,
        reason: None,
        time_to_contact,
        speed,
        penetration,
        duration,
        period,
        max_deviation_by_phase: Some(row.deviations),
        verdict: Some(row.verdict(tolerance).name().to_owned()),
    }
}
