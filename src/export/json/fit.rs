//! Kind `fit`: the laws of a measurement.

#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DocumentKind;
use super::number::{Map, finite};
use crate::fit::answer::Estimate;
use crate::fit::backbone::BackbonePoint;
use crate::fit::fitted_record::FittedRecord;
use crate::fit::record::ReadRecord;
use crate::fit::response::ResponseRow;
use crate::fit::turning_points::TurningPoint;
use crate::report::FitReport;

/// The laws of a measurement, and what it says without a law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct FitDocument {
    /// The kind of document.
    pub schema: String,
    /// The kind of measurement: `decay`, a record of a motion, `backbone`, a table of frequencies against
    /// amplitudes, `response`, amplitudes against the frequency of a drive, or `impacts`, times of impacts.
    pub data: String,
    /// The records before any law; empty of tables and impacts.
    pub records: Vec<RecordDocument>,
    /// The laws, the best first.
    pub laws: Vec<FittedLawDocument>,
    /// The best law of a record; null of tables and impacts.
    pub best: Option<BestLawDocument>,
    /// Frequency and damping against amplitude, without a law, record by record; empty of tables and impacts.
    pub backbone: Vec<BackbonePointDocument>,
    /// The rows of a frequency response with its law; empty of everything else.
    pub response: Vec<ResponseRowDocument>,
    /// The coefficient of restitution of each impact; empty of records and tables.
    pub impacts: Vec<RestitutionDocument>,
}

/// A record before any law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "Record"))]
pub struct RecordDocument {
    /// The name of its column.
    pub name: String,
    /// The number of samples.
    pub samples: usize,
    /// Whether the values are angles, in radians.
    pub is_angle: bool,
    /// The usual time between samples.
    pub step: f64,
    /// The standard deviation of the noise.
    pub noise: f64,
    /// The step between values where they are quantised; null otherwise.
    pub quantum: Option<f64>,
    /// The line at which the free decay begins.
    pub start: Option<usize>,
    /// The lines before gaps in time.
    pub gaps: Vec<usize>,
    /// The lines without a value.
    pub missing: Vec<usize>,
    /// The lines with a time that repeats the one before.
    pub repeated: Vec<usize>,
    /// The turning points.
    pub turning_points: Vec<TurningPointDocument>,
    /// The times at which the record crosses its centre.
    pub crossings: Vec<EstimateDocument>,
    /// The lines on flat tops.
    pub saturated: Vec<usize>,
    /// The lines of the samples that were left out since they lie far from their neighbours or from the best law.
    pub outliers: Vec<usize>,
}

/// A turning point, with the offset of the record in it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "TurningPoint"))]
pub struct TurningPointDocument {
    /// The time.
    pub time: EstimateDocument,
    /// The value.
    pub value: EstimateDocument,
}

/// A value with its standard error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "Estimate"))]
pub struct EstimateDocument {
    /// The value.
    pub value: Option<f64>,
    /// The standard error; null where it is not known, or the measurement leaves the value open.
    pub standard_error: Option<f64>,
}

/// A law beside a measurement.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "FittedLaw"))]
pub struct FittedLawDocument {
    /// The name.
    pub name: String,
    /// The equation of motion; null for a law of restitution.
    pub equation: Option<String>,
    /// The parameters; of a record also the start `x0` and `v0`, the offset and its drift per unit of time, of
    /// further records `x0_2` and so on.
    pub parameters: Map<EstimateDocument>,
    /// Chi-square per degree of freedom; null where the law was not fitted to the samples.
    pub chi_squared: Option<f64>,
    /// The criterion of Akaike; null where there is none.
    pub aic: Option<f64>,
    /// The reason that excludes the law; null for the best one, and for one that the measurement does not exclude.
    pub excluded: Option<String>,
}

/// The best law of a record in detail.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "BestLaw"))]
pub struct BestLawDocument {
    /// Whether the residuals are white.
    pub is_white: bool,
    /// The probability that white noise has correlations as large as those of the residuals.
    pub probability: f64,
    /// The correlations of the parameters, in their order, row by row.
    pub correlations: Vec<Vec<Option<f64>>>,
    /// The directions of the parameters that the record does not determine, in words.
    pub flat: Vec<String>,
    /// Whether the search of the values converged.
    pub converged: bool,
}

/// Frequency and damping at an amplitude.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "BackbonePoint"))]
pub struct BackbonePointDocument {
    /// The time in the middle of the window.
    pub time: f64,
    /// The amplitude.
    pub amplitude: EstimateDocument,
    /// The angular frequency.
    pub frequency: EstimateDocument,
    /// The damping ratio.
    pub damping: EstimateDocument,
}

/// A row of a frequency response: the first harmonic, `amplitude cos(frequency t - phase)`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "FittedResponseRow"))]
pub struct ResponseRowDocument {
    /// The angular frequency of the drive.
    pub frequency: f64,
    /// The measured amplitude.
    pub amplitude: f64,
    /// The measured phase, in radians; null where it is not given.
    pub phase: Option<f64>,
    /// The amplitude of the law.
    pub law_amplitude: Option<f64>,
    /// The phase of the law, in radians.
    pub law_phase: Option<f64>,
}

/// The coefficient of restitution of one impact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema), schemars(rename = "Restitution"))]
pub struct RestitutionDocument {
    /// The speed of approach.
    pub speed: f64,
    /// The coefficient of restitution.
    pub restitution: EstimateDocument,
}

impl EstimateDocument {
    fn new(value: f64, error: f64) -> Self {
        Self { value: finite(Some(value)), standard_error: finite(Some(error)) }
    }
}

/// The document of kind `fit`.
pub fn fit(report: &FitReport) -> FitDocument {
    let laws = report.laws().into_iter().map(|law| FittedLawDocument {
        name: law.name,
        equation: Some(law.equation).filter(|equation| !equation.is_empty()),
        parameters: law
            .estimates
            .iter()
            .map(|Estimate { name, value, error }| {
                (name.clone(), EstimateDocument::new(*value, *error))
            })
            .collect(),
        chi_squared: finite(law.chi_squared),
        aic: finite(law.aic),
        excluded: law.excluded,
    });
    let (mut records, mut backbone) = (vec![], vec![]);
    let (mut response, mut impacts) = (vec![], vec![]);
    let data = match report {
        FitReport::Decay { records: read, answer, .. } => {
            let found = &answer.records;
            records = read
                .iter()
                .zip(found)
                .map(|(read, own)| of_record(read, own, answer.noise))
                .collect();
            backbone = found.iter().flat_map(|own| &own.backbone).map(of_point).collect();
            "decay"
        }
        FitReport::Backbone { .. } => "backbone",
        FitReport::Response { response: measured, fit } => {
            let rows = measured.rows.iter().zip(&fit.fitted);
            let row = |(row, [amplitude, phase]): (&ResponseRow, &[f64; 2])| ResponseRowDocument {
                frequency: row.frequency,
                amplitude: row.amplitude,
                phase: row.phase,
                law_amplitude: finite(Some(*amplitude)),
                law_phase: finite(Some(*phase)),
            };
            response = rows.map(row).collect();
            "response"
        }
        FitReport::Impacts(answer) => {
            let measured = answer.measured.iter().map(|own| RestitutionDocument {
                speed: own.speed,
                restitution: EstimateDocument::new(own.value, own.error),
            });
            impacts = measured.collect();
            "impacts"
        }
    };
    let best = report.best().map(|fit| {
        let parameters = fit.correlations.nrows();
        let row = |one: usize| {
            (0..parameters).map(|other| finite(Some(fit.correlations[(one, other)]))).collect()
        };
        BestLawDocument {
            is_white: fit.whiteness.is_white(),
            probability: fit.whiteness.probability,
            correlations: (0..parameters).map(row).collect(),
            flat: fit.flat.clone(),
            converged: fit.converged,
        }
    });
    FitDocument {
        schema: DocumentKind::Fit.schema().to_owned(),
        data: data.to_owned(),
        records,
        laws: laws.collect(),
        best,
        backbone,
        response,
        impacts,
    }
}

fn of_record(read: &ReadRecord, found: &FittedRecord, noise: f64) -> RecordDocument {
    let quality = &found.quality;
    let lines = |places: &mut dyn Iterator<Item = usize>| -> Vec<usize> {
        places.filter_map(|place| read.lines.get(place).copied()).collect()
    };
    RecordDocument {
        name: read.name.clone(),
        samples: read.record.times.len(),
        is_angle: read.record.is_angle,
        step: quality.step,
        noise,
        quantum: quality.quantum,
        start: read.lines.get(quality.start).copied(),
        gaps: lines(&mut quality.gaps.iter().map(|(place, _)| *place)),
        missing: read.missing.clone(),
        repeated: read.repeated.clone(),
        turning_points: found.swings.points.iter().map(of_turning_point).collect(),
        crossings: found
            .crossings
            .iter()
            .map(|own| EstimateDocument::new(own.time, own.time_error))
            .collect(),
        saturated: lines(&mut quality.saturated.iter().copied()),
        outliers: lines(&mut found.outliers.iter().copied()),
    }
}

fn of_turning_point(point: &TurningPoint) -> TurningPointDocument {
    TurningPointDocument {
        time: EstimateDocument::new(point.time, point.time_error),
        value: EstimateDocument::new(point.value, point.value_error),
    }
}

fn of_point(point: &BackbonePoint) -> BackbonePointDocument {
    BackbonePointDocument {
        time: point.time,
        amplitude: EstimateDocument::new(point.amplitude, point.amplitude_error),
        frequency: EstimateDocument::new(point.frequency, point.frequency_error),
        damping: EstimateDocument::new(point.damping, point.damping_error),
    }
}
