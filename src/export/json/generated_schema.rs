//! JSON Schemas made from the types that write and read the documents. Only the test that holds the
//! files in `schemas/` to them needs this.

use std::borrow::Cow;

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::Value;

use super::{
    AbsorberDocument, AuditDocument, CatalogDocument, CertificateDocument,
    CertificateRangeDocument, ComparisonDocument, CoupledCertificateDocument,
    DampedCertificateDocument, DocumentKind, FitDocument, FrictionDocument,
    ImpactCertificateDocument, ImpactComparisonDocument, ImpactDocument, LagrangianDocument,
    LawCertificateDocument, MaterialsDocument, ModeCertificateDocument, ModesDocument,
    MotionDocument, MotionSweepDocument, OneHarmonicDocument, OptimizationDocument,
    OrbitCertificateDocument, OrbitsDocument, PointDocument, PrimaryDocument, PrimarySweepDocument,
    ResponseDocument, ShortestDocument, SimulationDocument, SlowEquationsDocument,
    SolutionDocument, StabilityDocument, StudyDocument, SweepDocument,
};
use crate::solution::Method;

impl DocumentKind {
    /// The JSON Schema as the types have it: what the file `schemas/` of this kind has to say.
    pub fn generated_schema(self) -> Value {
        let generator = SchemaSettings::draft2020_12().for_serialize().into_generator();
        let mut schema = match self {
            Self::Solution => generator.into_root_schema_for::<SolutionDocument>(),
            Self::Modes => generator.into_root_schema_for::<ModesDocument>(),
            Self::OneHarmonic => generator.into_root_schema_for::<OneHarmonicDocument>(),
            Self::SlowEquations => generator.into_root_schema_for::<SlowEquationsDocument>(),
            Self::Comparison => generator.into_root_schema_for::<ComparisonDocument>(),
            Self::Impact => generator.into_root_schema_for::<ImpactDocument>(),
            Self::ImpactComparison => generator.into_root_schema_for::<ImpactComparisonDocument>(),
            Self::ImpactCertificate => {
                generator.into_root_schema_for::<ImpactCertificateDocument>()
            }
            Self::Simulation => generator.into_root_schema_for::<SimulationDocument>(),
            Self::Motion => generator.into_root_schema_for::<MotionDocument>(),
            Self::MotionSweep => generator.into_root_schema_for::<MotionSweepDocument>(),
            Self::Primary => generator.into_root_schema_for::<PrimaryDocument>(),
            Self::PrimarySweep => generator.into_root_schema_for::<PrimarySweepDocument>(),
            Self::Sweep => generator.into_root_schema_for::<SweepDocument>(),
            Self::Response => generator.into_root_schema_for::<ResponseDocument>(),
            Self::Absorber => generator.into_root_schema_for::<AbsorberDocument>(),
            Self::Orbits => generator.into_root_schema_for::<OrbitsDocument>(),
            Self::Shortest => generator.into_root_schema_for::<ShortestDocument>(),
            Self::Fit => generator.into_root_schema_for::<FitDocument>(),
            Self::Friction => generator.into_root_schema_for::<FrictionDocument>(),
            Self::Lagrangian => generator.into_root_schema_for::<LagrangianDocument>(),
            Self::Materials => generator.into_root_schema_for::<MaterialsDocument>(),
            Self::Optimization => generator.into_root_schema_for::<OptimizationDocument>(),
            Self::Stability => generator.into_root_schema_for::<StabilityDocument>(),
            Self::Audit => generator.into_root_schema_for::<AuditDocument>(),
            Self::Catalog => generator.into_root_schema_for::<CatalogDocument>(),
            Self::Certificate => generator.into_root_schema_for::<EitherCertificate>(),
            Self::CertificateRange => generator.into_root_schema_for::<CertificateRangeDocument>(),
            Self::Study => generator.into_root_schema_for::<StudyDocument>(),
            Self::Point => generator.into_root_schema_for::<PointDocument>(),
        };
        schema.insert("$id".to_owned(), format!("urn:{}", self.schema().replace('/', ":")).into());
        schema.insert("title".to_owned(), self.schema().into());
        let mut schema = head_first(schema.to_value());
        if let Some(Value::Object(key)) = schema.pointer_mut("/properties/schema") {
            key.insert("const".to_owned(), self.schema().into());
        }
        complete(&mut schema);
        schema
    }
}

/// A certificate of a conservative motion, of one coordinate or several, or of a motion with
/// damping, told apart by `ode`.
struct EitherCertificate;

impl JsonSchema for EitherCertificate {
    fn schema_name() -> Cow<'static, str> {
        "EitherCertificate".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let kinds = [
            generator.subschema_for::<CertificateDocument>(),
            generator.subschema_for::<DampedCertificateDocument>(),
            generator.subschema_for::<ModeCertificateDocument>(),
            generator.subschema_for::<CoupledCertificateDocument>(),
            generator.subschema_for::<LawCertificateDocument>(),
            generator.subschema_for::<OrbitCertificateDocument>(),
        ];
        json_schema!({
            "description": "Numbers from which a motion can be proved, and how far a formula for it is off: a conservative motion, a limit cycle, a driven motion, a free or a driven motion of several coordinates, or impact orbits; or how far a frequency law is off on a range.",
            "anyOf": kinds,
        })
    }
}

/// Moves the keys that a reader looks for first to the front.
fn head_first(schema: Value) -> Value {
    let Value::Object(mut rest) = schema else {
        return schema;
    };
    let head = ["$schema", "$id", "title", "description"];
    let mut ordered: serde_json::Map<String, Value> =
        head.iter().filter_map(|key| rest.shift_remove_entry(*key)).collect();
    ordered.extend(rest);
    ordered.into()
}

/// Sets each description in one line, which is wrapped where it is written, and closes each object
/// to keys that its type has not.
fn complete(schema: &mut Value) {
    match schema {
        Value::Object(map) => {
            if map.contains_key("properties") && !map.contains_key("additionalProperties") {
                let behind = map.keys().position(|key| key == "type").map_or(0, |place| place + 1);
                map.shift_insert(behind, "additionalProperties".to_owned(), false.into());
            }
            for (key, entry) in map.iter_mut() {
                match entry {
                    Value::String(text) if key == "description" => *text = text.replace('\n', " "),
                    _ => complete(entry),
                }
            }
        }
        Value::Array(list) => list.iter_mut().for_each(complete),
        _ => {}
    }
}

/// The schema of the name of a method.
pub(super) fn methods(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "string", "enum": Method::ALL.map(Method::name) })
}
