//! The kinds of documents and the JSON Schema of each.

use super::{JsonError, unexpected};

/// A kind of document.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DocumentKind {
    /// `derive`.
    Solution,
    /// `derive` of coupled equations.
    Modes,
    /// `derive --method harmonic-balance` of coupled equations.
    OneHarmonic,
    /// `derive --method multiple-scales` of coupled equations.
    SlowEquations,
    /// `compare`.
    Comparison,
    /// `impact`.
    Impact,
    /// `impact --compare`.
    ImpactComparison,
    /// `impact --certify`.
    ImpactCertificate,
    /// `simulate`.
    Simulation,
    /// `simulate` of an equation or a mechanism.
    Motion,
    /// `simulate --sweep` of an equation or a mechanism.
    MotionSweep,
    /// `simulate` of a main mass.
    Primary,
    /// `simulate --sweep` of a main mass.
    PrimarySweep,
    /// `simulate --sweep`.
    Sweep,
    /// `response`.
    Response,
    /// `absorber`.
    Absorber,
    /// `orbits`.
    Orbits,
    /// `shortest`.
    Shortest,
    /// `fit`.
    Fit,
    /// `friction`.
    Friction,
    /// `lagrange`.
    Lagrangian,
    /// `materials`.
    Materials,
    /// `optimize`.
    Optimization,
    /// `stability`.
    Stability,
    /// `audit`, `paper`.
    Audit,
    /// `catalog`.
    Catalog,
    /// `certify`.
    Certificate,
    /// `certify --range`.
    CertificateRange,
    /// The first line of a shard.
    Study,
    /// Another line of a shard.
    Point,
}

impl DocumentKind {
    /// Every kind.
    pub const ALL: [Self; 30] = [
        Self::Solution,
        Self::Modes,
        Self::OneHarmonic,
        Self::SlowEquations,
        Self::Comparison,
        Self::Impact,
        Self::ImpactComparison,
        Self::ImpactCertificate,
        Self::Simulation,
        Self::Motion,
        Self::MotionSweep,
        Self::Primary,
        Self::PrimarySweep,
        Self::Sweep,
        Self::Response,
        Self::Absorber,
        Self::Orbits,
        Self::Shortest,
        Self::Fit,
        Self::Friction,
        Self::Lagrangian,
        Self::Materials,
        Self::Optimization,
        Self::Stability,
        Self::Audit,
        Self::Catalog,
        Self::Certificate,
        Self::CertificateRange,
        Self::Study,
        Self::Point,
    ];

    /// The name of the schema, and its file.
    const fn entry(self) -> [&'static str; 2] {
        match self {
            Self::Solution => ["lindstedt/solution/1", include_str!("schemas/solution.json")],
            Self::Modes => ["lindstedt/modes/1", include_str!("schemas/modes.json")],
            Self::OneHarmonic => {
                ["lindstedt/one-harmonic/1", include_str!("schemas/one-harmonic.json")]
            }
            Self::SlowEquations => {
                ["lindstedt/slow-equations/1", include_str!("schemas/slow-equations.json")]
            }
            Self::Comparison => ["lindstedt/comparison/1", include_str!("schemas/comparison.json")],
            Self::Impact => ["lindstedt/impact/1", include_str!("schemas/impact.json")],
            Self::ImpactComparison => {
                ["lindstedt/impact-comparison/1", include_str!("schemas/impact-comparison.json")]
            }
            Self::ImpactCertificate => {
                ["lindstedt/impact-certificate/1", include_str!("schemas/impact-certificate.json")]
            }
            Self::Simulation => ["lindstedt/simulation/1", include_str!("schemas/simulation.json")],
            Self::Motion => ["lindstedt/motion/1", include_str!("schemas/motion.json")],
            Self::MotionSweep => {
                ["lindstedt/motion-sweep/1", include_str!("schemas/motion-sweep.json")]
            }
            Self::Primary => ["lindstedt/primary/1", include_str!("schemas/primary.json")],
            Self::PrimarySweep => {
                ["lindstedt/primary-sweep/1", include_str!("schemas/primary-sweep.json")]
            }
            Self::Sweep => ["lindstedt/sweep/1", include_str!("schemas/sweep.json")],
            Self::Response => ["lindstedt/response/1", include_str!("schemas/response.json")],
            Self::Absorber => ["lindstedt/absorber/1", include_str!("schemas/absorber.json")],
            Self::Orbits => ["lindstedt/orbits/1", include_str!("schemas/orbits.json")],
            Self::Shortest => ["lindstedt/shortest/1", include_str!("schemas/shortest.json")],
            Self::Fit => ["lindstedt/fit/1", include_str!("schemas/fit.json")],
            Self::Friction => ["lindstedt/friction/1", include_str!("schemas/friction.json")],
            Self::Lagrangian => ["lindstedt/lagrangian/1", include_str!("schemas/lagrangian.json")],
            Self::Materials => ["lindstedt/materials/1", include_str!("schemas/materials.json")],
            Self::Optimization => {
                ["lindstedt/optimization/1", include_str!("schemas/optimization.json")]
            }
            Self::Stability => ["lindstedt/stability/1", include_str!("schemas/stability.json")],
            Self::Audit => ["lindstedt/audit/1", include_str!("schemas/audit.json")],
            Self::Catalog => ["lindstedt/catalog/1", include_str!("schemas/catalog.json")],
            Self::Certificate => {
                ["lindstedt/certificate/1", include_str!("schemas/certificate.json")]
            }
            Self::CertificateRange => {
                ["lindstedt/certificate-range/1", include_str!("schemas/certificate-range.json")]
            }
            Self::Study => ["lindstedt/study/1", include_str!("schemas/study.json")],
            Self::Point => ["lindstedt/point/1", include_str!("schemas/point.json")],
        }
    }

    /// The text that a document of this kind has under `schema`.
    pub const fn schema(self) -> &'static str {
        self.entry()[0]
    }

    /// The name on the command line: `solution`.
    pub fn name(self) -> &'static str {
        self.schema().split('/').nth(1).unwrap_or_default()
    }

    /// The kind of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// The JSON Schema, draft 2020-12, of documents of this kind: every key with its meaning, no
    /// other key allowed. It is kept as a file in `src/export/json/schemas/`, which a test holds to
    /// the types that write and read the documents.
    ///
    /// ```
    /// use lindstedt::export::json::DocumentKind;
    ///
    /// let kind = DocumentKind::from_name("impact").ok_or("no such kind")?;
    /// let schema: serde_json::Value = serde_json::from_str(kind.json_schema())?;
    /// assert_eq!(schema["title"], "lindstedt/impact/1");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub const fn json_schema(self) -> &'static str {
        self.entry()[1]
    }
}

/// Refuses a document of another kind.
pub(super) fn check_kind(schema: &str, kind: DocumentKind) -> Result<(), JsonError> {
    match schema == kind.schema() {
        true => Ok(()),
        false => unexpected("schema", kind.schema()),
    }
}
