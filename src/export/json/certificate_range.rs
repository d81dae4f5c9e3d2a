//! Kind `certificate-range`: the amplitudes in which a formula is proved to be within a tolerance.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DocumentKind;
use super::number::{Constant, finite};
use crate::certificate::{RangeEnd, Validity};
use crate::exact::Rational;
use crate::exact::rational::to_f64;
use crate::report::CertificateReport;

/// The range of amplitudes in which the frequency of a formula is proved to be within a tolerance of
/// the true one, for every amplitude.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct CertificateRangeDocument {
    /// The kind of document.
    pub schema: String,
    /// The equation of motion, `... = 0`.
    pub equation: String,
    /// The method of the formula.
    pub method: String,
    /// The size of the relative error of the frequency that is asked for.
    pub tolerance: f64,
    /// The first amplitude of the range.
    pub from: Constant,
    /// The last amplitude up to which it is proved.
    pub to: Constant,
    /// The reason why the range ends: `asked`, because all of it is proved; `further`, because the
    /// error is proved to be larger at the next amplitude; `open`, because it is proved to be
    /// neither within nor beyond the tolerance there; `unproved`, because there is no proof of the
    /// motion there; `stopped`, because the computation was.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = ENDS)))]
    pub end: String,
    /// The amplitude at which it ends so; null for `asked` and `stopped`.
    pub beyond: Option<Constant>,
    /// The reason why there is no proof of the motion at `beyond`; null where there is one.
    pub reason: Option<String>,
    /// The size of the relative error is proved to be at most this between them; null where nothing
    /// is proved.
    pub within: Option<f64>,
    /// The number of intervals, each with a proof; 0 where nothing is proved.
    pub intervals: usize,
}

/// The reasons why a range ends.
#[cfg(feature = "schema")]
const ENDS: [&str; 5] = ["asked", "further", "open", "unproved", "stopped"];

/// The document of kind `certificate-range`; `None` where no range was asked for.
pub fn certificate_range(report: &CertificateReport) -> Option<CertificateRangeDocument> {
    let solution = report.question?.solution()?;
    let Validity { from, to, within, intervals, beyond, .. } = report.validity?;
    let constant = |value: &Rational| Constant {
        exact: value.to_string(),
        value: finite(Some(to_f64(value))),
    };
    let (end, beyond, reason) = match beyond {
        RangeEnd::Asked => ("asked", None, None),
        RangeEnd::Further(place) => ("further", Some(place), None),
        RangeEnd::Open(place) => ("open", Some(place), None),
        RangeEnd::Unproved(place, reason) => ("unproved", Some(place), Some(reason.to_string())),
        RangeEnd::Stopped => ("stopped", None, None),
    };
    Some(CertificateRangeDocument {
        schema: DocumentKind::CertificateRange.schema().to_owned(),
        equation: solution.equation.to_string(),
        method: solution.method.name().to_owned(),
        tolerance: report.tolerance,
        from: constant(from),
        to: constant(to),
        end: end.to_owned(),
        beyond: beyond.map(constant),
        reason,
        within: finite(Some(*within)).filter(|_| *intervals > 0),
        intervals: *intervals,
    })
}
