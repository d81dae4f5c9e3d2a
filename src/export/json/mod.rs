//! JSON documents: one type for each kind, by which it is written, read and described.
//!
//! In come results: a [`Solution`], a [`Comparison`](crate::verify::comparison::Comparison), an
//! [`Impact`](crate::impact::Impact), a report of a simulation or a sweep. Out goes a document that
//! `serde_json` prints and reads back; solutions and phases read back into results. What is no such
//! document is a [`JsonError`], which names the key.
//!
//! ```text
//! number       {"exact": "-1/8", "value": -0.125}
//! polynomial   {"terms": [{"monomial": {"A": 2}, "exact": "-1/8", "value": -0.125}, ...]}
//! ```
//!
//! The documentation of a field is its description in the schema, [`DocumentKind::json_schema`]. A
//! missing value is null: a key is never left out.

mod absorber;
pub mod audit;
pub mod catalog;
pub mod certificate;
pub mod certificate_range;
pub mod comparison;
pub mod coupled_certificate;
pub mod damped_certificate;
mod fit;
pub mod friction;
#[cfg(feature = "schema")]
mod generated_schema;
pub mod impact;
pub mod impact_certificate;
pub mod impact_comparison;
pub mod lagrangian;
mod law_certificate;
pub mod materials;
pub mod mode_certificate;
pub mod modes;
pub mod motion;
pub mod number;
mod one_harmonic;
pub mod optimization;
pub mod orbit_certificate;
mod orbits;
pub mod points;
pub mod primary;
pub mod response;
mod schema;
pub mod shard;
mod shortest;
pub mod simulation;
mod slow_equations;
pub mod solution;
pub mod stability;
pub mod sweep;
pub mod verification;

use std::io;

use serde::{Deserialize, Serialize};
use serde_json::Value;

pub use absorber::{
    AbsorberDecayDocument, AbsorberDesignDocument, AbsorberDocument, AbsorberFormulaDocument,
    AbsorberMotionDocument, AbsorberRelationDocument, absorber,
};
pub use audit::{AuditDocument, audit};
pub use catalog::{CatalogDocument, catalog};
pub use certificate::{CertificateDocument, certificate};
pub use certificate_range::{CertificateRangeDocument, certificate_range};
pub use comparison::{ComparisonDocument, comparison};
pub use coupled_certificate::{
    CoupledCertificateDocument, EQUATIONS_OF_CYCLES, EQUATIONS_WITH_DRIVE, coupled_certificate,
};
pub use damped_certificate::{
    DampedCertificateDocument, EQUATION_OF_CYCLES, EQUATION_WITH_DRIVE, damped_certificate,
};
pub use fit::{
    BackbonePointDocument, BestLawDocument, EstimateDocument, FitDocument, FittedLawDocument,
    RecordDocument, RestitutionDocument, TurningPointDocument, fit,
};
pub use friction::{FrictionDocument, friction};
pub use impact::{ImpactDocument, impact};
pub use impact_certificate::{ImpactCertificateDocument, impact_certificate};
pub use impact_comparison::{ImpactComparisonDocument, impact_comparison};
pub use lagrangian::{LagrangianDocument, lagrangian};
pub use law_certificate::{
    EQUATIONS_ON_A_RANGE, LawCertificateDocument, ModeOfLawDocument, law_certificate,
};
pub use materials::{MaterialsDocument, materials};
pub use mode_certificate::{EQUATIONS_OF_MODES, ModeCertificateDocument, mode_certificate};
pub use modes::{ModesDocument, modes};
pub use motion::{MotionDocument, MotionSweepDocument, motion, motion_sweep};
pub use number::{Constant, Map, Polynomial, Term};
pub use one_harmonic::{
    OneHarmonicBranchDocument, OneHarmonicDocument, OneHarmonicFamilyDocument,
    OneHarmonicMotionDocument, one_harmonic,
};
pub use optimization::{OptimizationDocument, optimization};
pub use orbit_certificate::{EQUATION_WITH_WALLS, OrbitCertificateDocument, orbit_certificate};
pub use orbits::{
    MultiplierDocument, OrbitBranchDocument, OrbitChangeDocument, OrbitChartDocument,
    OrbitCurveDocument, OrbitDocument, OrbitFamilyDocument, OrbitLawsDocument,
    OrbitRelationDocument, OrbitSweepDocument, OrbitWallDocument, OrbitsDocument, orbits,
};
pub use primary::{PrimaryDocument, PrimarySweepDocument, primary, primary_sweep};
pub use response::{ResponseDocument, response};
pub use schema::DocumentKind;
pub use shard::{PointDocument, StudyDocument};
pub use shortest::{PublishedFormulaDocument, ShortLawDocument, ShortestDocument, shortest};
pub use simulation::{SimulationDocument, simulation};
pub use slow_equations::{
    NearDivisorDocument, SlowEquationsDocument, SlowModeDocument, SlowSteadyDocument,
    SteadyRelationDocument, TransientDocument, slow_equations,
};
pub use solution::{SolutionDocument, solution};
pub use stability::{StabilityDocument, stability};
pub use sweep::{SweepDocument, sweep};

use crate::impact::MotionPhase;
use crate::solution::Solution;
use schema::check_kind;

/// Why a document or a record cannot be read: a key that is missing or holds what it never holds, a
/// text that is none, another search.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct JsonError(String);

impl From<serde_json::Error> for JsonError {
    fn from(error: serde_json::Error) -> Self {
        Self(error.to_string())
    }
}

fn unexpected<T>(key: &str, expected: &'static str) -> Result<T, JsonError> {
    Err(JsonError(format!("`{key}` should hold {expected}")))
}

/// Writes a document as text of several lines, with a line end.
///
/// # Errors
/// The errors of the writer.
///
/// ```
/// use lindstedt::{Options, Oscillator, solve};
///
/// let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
/// let solution = solve(&duffing, &Options::default())?;
/// let mut text = Vec::new();
/// lindstedt::export::json::write(&lindstedt::export::json::solution(&solution, None), &mut text)?;
/// assert!(text.starts_with(b"{\n") && text.ends_with(b"}\n"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write(document: &impl Serialize, to: &mut dyn io::Write) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut *to, document)?;
    writeln!(to)
}

/// Reads a document of kind `solution` back; its `verification` and the derivation are left out.
///
/// # Errors
/// A key that is missing or holds something else.
///
/// ```
/// use lindstedt::{Options, Oscillator, solve};
///
/// let duffing = Oscillator::parse("x'' + x + eps*x^3 = 0")?;
/// let solution = solve(&duffing, &Options::default())?;
/// let document = serde_json::to_value(lindstedt::export::json::solution(&solution, None))?;
/// assert_eq!(lindstedt::export::json::read_solution(&document)?.formula(), solution.formula());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_solution(document: &Value) -> Result<Solution, JsonError> {
    SolutionDocument::deserialize(document)?.read()
}

/// Reads the three phases of a document of kind `impact` back.
///
/// # Errors
/// A key that is missing or holds something else.
///
/// ```
/// use lindstedt::impact::{Setup, solve};
///
/// let impact = solve(Setup { stiffness: 1e6, ..Setup::default() })?;
/// let document = serde_json::to_value(lindstedt::export::json::impact(&impact, 0.01))?;
/// let phases = lindstedt::export::json::read_phases(&document)?;
/// assert_eq!(phases.iter().map(|phase| phase.name).collect::<Vec<_>>(), ["approach", "contact", "return"]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_phases(document: &Value) -> Result<Vec<MotionPhase>, JsonError> {
    ImpactDocument::deserialize(document)?.read_phases()
}
