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

/// The numbers of an impact between a pendulum and a barrier of a power law, each enclosed by a proof. Times in units of 1/omega, angles in radians.
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
    /// Further powers of the depth, which are added to the force.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub further_powers: Vec<PowerOfDepth>,
    /// The damping of a contact that loses energy, whose force is `stiffness * depth^exponent * (1 + damping * depth')` by the law
    /// `hunt-crossley`, `stiffness * (depth + damping * depth')` by `kelvin-voigt`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damping: Option<Constant>,
    /// The enclosed numbers.
    pub proved: OfPhases<EnclosedNumber>,
    /// The size of the relative error up to which a verdict is `pass`.
    pub tolerance: f64,
    /// The relative errors of Runge-Kutta.
    pub runge_kutta: OfPhases<ErrorBounds>,
    /// The closed forms: the paper's readings and the derived one.
    pub closed_forms: Vec<ProvedClosedForm>,
}

/// A force `stiffness * depth^exponent`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct PowerOfDepth {
    /// The factor.
    pub stiffness: Constant,
    /// The exponent of the depth.
    pub exponent: Constant,
}

/// The numbers of an impact, or their errors.
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
    /// The time from release to release; of a contact that loses energy until the motion turns after the impact.
    pub period: T,
    /// The speed after the contact over that before; left out where the contact loses nothing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub restitution: Option<T>,
    /// The speed after the contact; left out where the contact loses nothing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_out: Option<T>,
}

impl<T> OfPhases<T> {
    /// The numbers of each row in the order of a report, the last two of which may be missing.
    fn of_rows(row: impl Fn(usize) -> T, count: usize) -> Self {
        let [time_to_contact, speed, penetration, duration, period] = std::array::from_fn(&row);
        let [restitution, speed_out] = [5, 6].map(|index| (index < count).then(|| row(index)));
        Self { time_to_contact, speed, penetration, duration, period, restitution, speed_out }
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
    let proved = report.proved();
    let bounds = |row: usize, index: usize| {
        let unknown = SizeBounds { lower: 0.0, upper: f64::INFINITY };
        let range = errors.get(row).and_then(|(_, ranges)| ranges.get(index));
        let SizeBounds { lower, upper } = range.copied().unwrap_or(unknown);
        ErrorBounds { lower, upper: finite(Some(upper)) }
    };
    let column = |index: usize| OfPhases::of_rows(|row| bounds(row, index), proved.len());
    let most = not_above_typed(report.tolerance);
    let closed_form = |(index, (reading, verdict)): (usize, (PhaseReading, Verdict))| {
        // The first column is that of Runge-Kutta.
        let is_within =
            |row: usize| bounds(row, index + 1).upper.is_some_and(|upper| upper <= most);
        let beyond = errors.iter().enumerate().filter(|(row, _)| !is_within(*row));
        ProvedClosedForm {
            name: reading.name().to_owned(),
            beyond: beyond.map(|(_, (name, _))| name.replace(' ', "_")).collect(),
            errors: column(index + 1),
            verdict: verdict.name().to_owned(),
        }
    };
    let mut powers = report.force.iter().map(|law| PowerOfDepth {
        stiffness: constant(&law.stiffness),
        exponent: constant(&law.exponent),
    });
    // The enclosures are those of one power at least.
    let (stiffness, exponent) = match powers.next() {
        Some(PowerOfDepth { stiffness, exponent }) => (stiffness, exponent),
        None => (
            constant(&Rational::from_integer(0.into())),
            constant(&Rational::from_integer(0.into())),
        ),
    };
    ImpactCertificateDocument {
        schema: DocumentKind::ImpactCertificate.schema().to_owned(),
        equation: report.impact.equation.clone(),
        amplitude,
        barrier,
        stiffness,
        exponent,
        further_powers: powers.collect(),
        damping: report.damping.map(constant),
        proved: OfPhases::of_rows(|row| enclosed(proved[row].1), proved.len()),
        tolerance: report.tolerance,
        runge_kutta: column(0),
        closed_forms: report.verdicts().into_iter().enumerate().map(closed_form).collect(),
    }
}
