//! The kinds of documents and the JSON Schema of each, from the types that write and read them.

use std::borrow::Cow;

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::Value;

use super::{
    AuditDocument, CatalogDocument, CertificateDocument, ComparisonDocument, DampedCertificateDocument,
    FrictionDocument, ImpactComparisonDocument, ImpactDocument, JsonError, LagrangianDocument, MaterialsDocument,
    MotionDocument, MotionSweepDocument, OptimizationDocument, PrimaryDocument, PrimarySweepDocument, ResponseDocument,
    SimulationDocument, SolutionDocument, StabilityDocument, SweepDocument, unexpected,
};
use crate::solution::Method;

/// A kind of document.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `derive`.
    Solution,
    /// `compare`.
    Comparison,
    /// `impact`.
    Impact,
    /// `impact --compare`.
    ImpactComparison,
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
}

impl Kind {
    /// Every kind.
    pub const ALL: [Self; 19] = [
        Self::Solution,
        Self::Comparison,
        Self::Impact,
        Self::ImpactComparison,
        Self::Simulation,
        Self::Motion,
        Self::MotionSweep,
        Self::Primary,
        Self::PrimarySweep,
        Self::Sweep,
        Self::Response,
        Self::Friction,
        Self::Lagrangian,
        Self::Materials,
        Self::Optimization,
        Self::Stability,
        Self::Audit,
        Self::Catalog,
        Self::Certificate,
    ];

    /// What a document of this kind has under `schema`.
    pub const fn schema(self) -> &'static str {
        match self {
            Self::Solution => "lindstedt/solution/1",
            Self::Comparison => "lindstedt/comparison/1",
            Self::Impact => "lindstedt/impact/1",
            Self::ImpactComparison => "lindstedt/impact-comparison/1",
            Self::Simulation => "lindstedt/simulation/1",
            Self::Motion => "lindstedt/motion/1",
            Self::MotionSweep => "lindstedt/motion-sweep/1",
            Self::Primary => "lindstedt/primary/1",
            Self::PrimarySweep => "lindstedt/primary-sweep/1",
            Self::Sweep => "lindstedt/sweep/1",
            Self::Response => "lindstedt/response/1",
            Self::Friction => "lindstedt/friction/1",
            Self::Lagrangian => "lindstedt/lagrangian/1",
            Self::Materials => "lindstedt/materials/1",
            Self::Optimization => "lindstedt/optimization/1",
            Self::Stability => "lindstedt/stability/1",
            Self::Audit => "lindstedt/audit/1",
            Self::Catalog => "lindstedt/catalog/1",
            Self::Certificate => "lindstedt/certificate/1",
        }
    }

    /// The name on the command line: `solution`.
    pub fn name(self) -> &'static str {
        self.schema().split('/').nth(1).unwrap_or_default()
    }

    /// The kind of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// The JSON Schema, draft 2020-12, of documents of this kind: every key with its meaning, no other key allowed.
    ///
    /// ```
    /// use lindstedt::export::json::Kind;
    ///
    /// let kind = Kind::from_name("impact").ok_or("no such kind")?;
    /// assert_eq!(kind.json_schema()["title"], "lindstedt/impact/1");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn json_schema(self) -> Value {
        let generator = SchemaSettings::draft2020_12().for_serialize().into_generator();
        let mut schema = match self {
            Self::Solution => generator.into_root_schema_for::<SolutionDocument>(),
            Self::Comparison => generator.into_root_schema_for::<ComparisonDocument>(),
            Self::Impact => generator.into_root_schema_for::<ImpactDocument>(),
            Self::ImpactComparison => generator.into_root_schema_for::<ImpactComparisonDocument>(),
            Self::Simulation => generator.into_root_schema_for::<SimulationDocument>(),
            Self::Motion => generator.into_root_schema_for::<MotionDocument>(),
            Self::MotionSweep => generator.into_root_schema_for::<MotionSweepDocument>(),
            Self::Primary => generator.into_root_schema_for::<PrimaryDocument>(),
            Self::PrimarySweep => generator.into_root_schema_for::<PrimarySweepDocument>(),
            Self::Sweep => generator.into_root_schema_for::<SweepDocument>(),
            Self::Response => generator.into_root_schema_for::<ResponseDocument>(),
            Self::Friction => generator.into_root_schema_for::<FrictionDocument>(),
            Self::Lagrangian => generator.into_root_schema_for::<LagrangianDocument>(),
            Self::Materials => generator.into_root_schema_for::<MaterialsDocument>(),
            Self::Optimization => generator.into_root_schema_for::<OptimizationDocument>(),
            Self::Stability => generator.into_root_schema_for::<StabilityDocument>(),
            Self::Audit => generator.into_root_schema_for::<AuditDocument>(),
            Self::Catalog => generator.into_root_schema_for::<CatalogDocument>(),
            Self::Certificate => generator.into_root_schema_for::<EitherCertificate>(),
        };
        schema.insert("title".to_owned(), self.schema().into());
        let mut schema = head_first(schema.to_value());
        in_one_line(&mut schema);
        schema
    }
}

/// A certificate of a conservative motion or of a limit cycle, told apart by `ode`.
struct EitherCertificate;

impl JsonSchema for EitherCertificate {
    fn schema_name() -> Cow<'static, str> {
        "EitherCertificate".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let kinds = [
            generator.subschema_for::<CertificateDocument>(),
            generator.subschema_for::<DampedCertificateDocument>(),
        ];
        json_schema!({
            "description": "Numbers from which a motion can be proved, and how far a formula for it is off: a conservative motion, or a limit cycle.",
            "anyOf": kinds,
        })
    }
}

/// What a reader looks for first stands first.
fn head_first(schema: Value) -> Value {
    let Value::Object(mut rest) = schema else {
        return schema;
    };
    let head = ["$schema", "title", "description"];
    let mut ordered: serde_json::Map<String, Value> =
        head.iter().filter_map(|key| rest.shift_remove_entry(*key)).collect();
    ordered.extend(rest);
    ordered.into()
}

/// Descriptions are wrapped where they are written, in lines of the source.
fn in_one_line(schema: &mut Value) {
    match schema {
        Value::Object(map) => {
            for (key, entry) in map.iter_mut() {
                match entry {
                    Value::String(text) if key == "description" => *text = text.replace('\n', " "),
                    _ => in_one_line(entry),
                }
            }
        }
        Value::Array(list) => list.iter_mut().for_each(in_one_line),
        _ => {}
    }
}

/// The schema of the name of a method.
pub(super) fn methods(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "string", "enum": Method::ALL.map(Method::name) })
}

/// Refuses a document of another kind.
pub(super) fn check_kind(schema: &str, kind: Kind) -> Result<(), JsonError> {
    match schema == kind.schema() {
        true => Ok(()),
        false => unexpected("schema", kind.schema()),
    }
}
