//! Kind `impact-certificate`: the proved numbers of an impact, and how far closed forms are off.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DocumentKind;
use super::number::{Constant, finite};
use crate::certificate::{Enclosure, SizeBounds};
use crate::decimal::not_above_typed;
use crate::exact::Rational;
use crate::exact::rational::to_f64;
use crate::impact::PhaseReading;
use crate::report::{ImpactCertificateReport, known_digits};
use crate::verify::Verdict;

/// The numbers of an impact between a pendulum and a barrier of a power law that loses nothing, each
/// enclosed by a proof. Times in units of 1/omega, angles in radians.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct ImpactCertificateDocument {
    /// The kind of document.
    pub schema: String,
    /// The equation of motion, `... = 0`.
    pub equation: String,
    /// The amplitude: the motion is released from rest at x = -amplitude.
    pub amplitude: Constant,
    /// The place of the barrier.
    pub barrier: Constant,
    /// The stiffness of the barrier, whose force is `stiffness * depth^exponent`.
    pub stiffness: Constant,
    /// The exponent of the depth, 3/2 of Hertz's law.
    pub exponent: Constant,
    /// The enclosed numbers.
    pub proved: OfPhases<EnclosedNumber>,
    /// The size of the relative error up to which a verdict is `pass`.
    pub tolerance: f64,
    /// The relative errors of Runge-Kutta.
    pub runge_kutta: OfPhases<ErrorBounds>,
    /// The closed forms: the paper's readings and the derived one.
    pub closed_forms: Vec<ProvedClosedForm>,
}

/// The five numbers of an impact, or their errors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "{T}OfPhases"))]
pub struct OfPhases<T> {
    /// The time from the release to the touch.
    pub time_to_contact: T,
    /// The speed at the touch.
    pub speed: T,
    /// The greatest depth in the barrier.
    pub penetration: T,
    /// The time from touch to release.
    pub duration: T,
    /// The time from release to release.
    pub period: T,
}

impl<T> From<[T; 5]> for OfPhases<T> {
    fn from([time_to_contact, speed, penetration, duration, period]: [T; 5]) -> Self {
        Self { time_to_contact, speed, penetration, duration, period }
    }
}

/// A number with a bound of its distance from the digits that are printed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct EnclosedNumber {
    /// The digits that are known, as text.
    pub middle: String,
    /// The number is no farther than this from `middle`.
    pub radius: f64,
}

/// The ends between which the size of a relative error lies, proved.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct ErrorBounds {
    /// The lower end.
    pub lower: f64,
    /// The upper end; null where there is none.
    pub upper: Option<f64>,
}

/// A closed form and its proved errors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct ProvedClosedForm {
    /// `paper`, `energy` or `derived`.
    pub name: String,
    /// The relative errors of its numbers.
    pub errors: OfPhases<ErrorBounds>,
    /// The keys of the numbers that are not proved to be within the tolerance.
    pub beyond: Vec<String>,
    /// Whether every number is proved to be within the tolerance.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = [Verdict::Pass.name(), Verdict::Fail.name()])))]
    pub verdict: String,
}

/// The document of kind `impact-certificate`.
pub fn impact_certificate(report: &ImpactCertificateReport) -> ImpactCertificateDocument {
    let constant = |value: &Rational| Constant {
        exact: value.to_string(),
        value: finite(Some(to_f64(value))),
    };
    let [amplitude, barrier] = report.exact.map(constant);
    let enclosed = |enclosure: &Enclosure| {
        let (middle, radius) = known_digits(enclosure);
        EnclosedNumber { middle, radius }
    };
    let errors = report.errors();
    let column = |index: usize| -> [ErrorBounds; 5] {
        let unknown = SizeBounds { lower: 0.0, upper: f64::INFINITY };
        std::array::from_fn(|row| {
            let range = errors.get(row).and_then(|(_, ranges)| ranges.get(index));
            let SizeBounds { lower, upper } = range.copied().unwrap_or(unknown);
            ErrorBounds { lower, upper: finite(Some(upper)) }
        })
    };
    let most = not_above_typed(report.tolerance);
    let closed_form = |(index, (reading, verdict)): (usize, (PhaseReading, Verdict))| {
        // The first column is that of Runge-Kutta.
        let own = column(index + 1);
        let is_within = |bounds: &ErrorBounds| bounds.upper.is_some_and(|upper| upper <= most);
        let beyond = errors.iter().zip(&own).filter(|(_, bounds)| !is_within(bounds));
        ProvedClosedForm {
            name: reading.name().to_owned(),
            beyond: beyond.map(|((name, _), _)| name.replace(' ', "_")).collect(),
            errors: OfPhases::from(own),
            verdict: verdict.name().to_owned(),
        }
    };
    ImpactCertificateDocument {
        schema: DocumentKind::ImpactCertificate.schema().to_owned(),
        equation: report.impact.equation.clone(),
        amplitude,
        barrier,
        stiffness: constant(&report.force.stiffness),
        exponent: constant(&report.force.exponent),
        proved: OfPhases::from(report.enclosure.in_order().map(|(_, number)| enclosed(number))),
        tolerance: report.tolerance,
        runge_kutta: OfPhases::from(column(0)),
        closed_forms: report.verdicts().into_iter().enumerate().map(closed_form).collect(),
    }
}
