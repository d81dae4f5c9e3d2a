//! JSON documents: what is printed is what the schema says and what reads back, every key is
//! described, and a program that knows nothing but the standard library of Python rebuilds
//! frequency and motion from them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use boon::{Compiler, SchemaIndex, Schemas};
use lindstedt::export::json::{
    self, AbsorberDocument, AuditDocument, CatalogDocument, CertificateDocument,
    CertificateRangeDocument, ComparisonDocument, CoupledCertificateDocument,
    DampedCertificateDocument, DocumentKind, FitDocument, FrictionDocument,
    ImpactCertificateDocument, ImpactComparisonDocument, ImpactDocument, LagrangianDocument,
    LawCertificateDocument, MaterialsDocument, ModeCertificateDocument, ModesDocument,
    MotionDocument, MotionSweepDocument, OneHarmonicDocument, OptimizationDocument,
    OrbitCertificateDocument, OrbitsDocument, PointDocument, PrimaryDocument, PrimarySweepDocument,
    ResponseDocument, ShortestDocument, SimulationDocument, SlowEquationsDocument,
    SolutionDocument, StabilityDocument, StudyDocument, SweepDocument,
};
use lindstedt::method::numbers::evaluate;
use lindstedt::method::{Options, solve};
use lindstedt::solution::{AmplitudeConvention, Method};
use lindstedt::verify::{judge, motions};
use lindstedt::{Oscillator, Symbol, Values};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

/// Whether a certificate is that of a law on a range.
fn is_law(document: &Value) -> bool {
    json::EQUATIONS_ON_A_RANGE.iter().any(|equation| document["ode"] == *equation)
}

/// Standard output of a run that must succeed.
fn output(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .args(arguments)
        .output()
        .expect("the program starts");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {errors}");
    String::from_utf8(output.stdout).expect("the output is text")
}

fn document(arguments: &[&str]) -> Value {
    let text = output(&[arguments, &["--format", "json"]].concat());
    serde_json::from_str(&text).expect("the output is JSON")
}

/// The files of a folder with this ending, in alphabetical order.
fn files(folder: &str, ending: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let entries = std::fs::read_dir(folder).expect("a folder");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let mut files: Vec<PathBuf> =
        paths.filter(|path| path.to_string_lossy().ends_with(ending)).collect();
    files.sort();
    files
}

fn is_impact(file: &Path) -> bool {
    file.file_name().is_some_and(|name| name.to_string_lossy().starts_with("impact"))
}

/// The schemas of all kinds, as the program prints them.
struct Published {
    schemas: Schemas,
    indices: Vec<(DocumentKind, SchemaIndex)>,
}

impl Published {
    fn new() -> Self {
        let mut schemas = Schemas::new();
        let mut compiler = Compiler::new();
        let index = |kind: DocumentKind| {
            let schema =
                serde_json::from_str(&output(&["schema", kind.name()])).expect("a schema is JSON");
            compiler.add_resource(kind.name(), schema).expect("a schema");
            (kind, compiler.compile(kind.name(), &mut schemas).expect("a schema of draft 2020-12"))
        };
        let indices = DocumentKind::ALL.map(index).into();
        Self { schemas, indices }
    }

    /// What the schema of the kind that a document names has against it.
    fn refusal(&self, document: &Value) -> Option<String> {
        let of_kind =
            |(kind, _): &&(DocumentKind, SchemaIndex)| document["schema"] == kind.schema();
        let (_, index) = self.indices.iter().find(of_kind).expect("a known kind");
        self.schemas.validate(document, *index).err().map(|error| format!("{error:#}"))
    }
}

/// What is written is what was read.
fn reads_back(document: &Value) {
    fn again<T: Serialize + DeserializeOwned>(document: &Value) -> Value {
        let typed: T = serde_json::from_value(document.clone()).expect("a document reads");
        serde_json::to_value(typed).expect("a document is written")
    }
    let kind = DocumentKind::ALL.into_iter().find(|kind| document["schema"] == kind.schema());
    let written = match kind.expect("a known kind") {
        DocumentKind::Solution => again::<SolutionDocument>(document),
        DocumentKind::Modes => again::<ModesDocument>(document),
        DocumentKind::OneHarmonic => again::<OneHarmonicDocument>(document),
        DocumentKind::SlowEquations => again::<SlowEquationsDocument>(document),
        DocumentKind::Comparison => again::<ComparisonDocument>(document),
        DocumentKind::Impact => again::<ImpactDocument>(document),
        DocumentKind::ImpactComparison => again::<ImpactComparisonDocument>(document),
        DocumentKind::ImpactCertificate => again::<ImpactCertificateDocument>(document),
        DocumentKind::Simulation => again::<SimulationDocument>(document),
        DocumentKind::Sweep => again::<SweepDocument>(document),
        DocumentKind::Absorber => again::<AbsorberDocument>(document),
        DocumentKind::Fit => again::<FitDocument>(document),
        DocumentKind::Shortest => again::<ShortestDocument>(document),
        DocumentKind::Orbits => again::<OrbitsDocument>(document),
        DocumentKind::Friction => again::<FrictionDocument>(document),
        DocumentKind::Lagrangian => again::<LagrangianDocument>(document),
        DocumentKind::MotionSweep => again::<MotionSweepDocument>(document),
        DocumentKind::Stability => again::<StabilityDocument>(document),
        DocumentKind::Motion => again::<MotionDocument>(document),
        DocumentKind::Primary => again::<PrimaryDocument>(document),
        DocumentKind::PrimarySweep => again::<PrimarySweepDocument>(document),
        DocumentKind::Materials => again::<MaterialsDocument>(document),
        DocumentKind::Optimization => again::<OptimizationDocument>(document),
        DocumentKind::Audit => again::<AuditDocument>(document),
        DocumentKind::Catalog => again::<CatalogDocument>(document),
        DocumentKind::Certificate if document["ode"] == json::EQUATION_OF_CYCLES => {
            again::<DampedCertificateDocument>(document)
        }
        DocumentKind::Certificate if document["ode"] == json::EQUATION_WITH_WALLS => {
            again::<OrbitCertificateDocument>(document)
        }
        DocumentKind::Certificate if is_law(document) => again::<LawCertificateDocument>(document),
        DocumentKind::Certificate if document["ode"] == json::EQUATIONS_OF_MODES => {
            again::<ModeCertificateDocument>(document)
        }
        DocumentKind::Certificate
            if [json::EQUATIONS_OF_CYCLES, json::EQUATIONS_WITH_DRIVE]
                .iter()
                .any(|ode| document["ode"] == **ode) =>
        {
            again::<CoupledCertificateDocument>(document)
        }
        DocumentKind::Certificate => again::<CertificateDocument>(document),
        DocumentKind::CertificateRange => again::<CertificateRangeDocument>(document),
        DocumentKind::Response => again::<ResponseDocument>(document),
        DocumentKind::Study => again::<StudyDocument>(document),
        DocumentKind::Point => again::<PointDocument>(document),
    };
    assert_eq!(written.to_string(), document.to_string());
}

/// Every document that the examples lead to.
fn documents() -> Vec<(String, Value)> {
    let mut documents = Vec::new();
    let mut add = |arguments: &[&str]| documents.push((arguments.join(" "), document(arguments)));
    for file in files("examples", ".toml") {
        add(&[if is_impact(&file) { "impact" } else { "derive" }, &file.to_string_lossy()]);
    }
    for file in files("examples/compare", ".toml") {
        add(&["compare", &file.to_string_lossy()]);
    }
    for file in files("examples/simulate", ".toml") {
        add(&["simulate", &file.to_string_lossy(), "--sample", "1"]);
    }
    for file in files("examples/materials", ".toml") {
        add(&["materials", &file.to_string_lossy()]);
    }
    for file in files("examples/optimize", ".toml") {
        add(&["optimize", &file.to_string_lossy()]);
    }
    for (file, start) in [("impact-damper", "x=-1.5"), ("newtons-cradle", "p=-1")] {
        let file = format!("{}/examples/walls/{file}.toml", env!("CARGO_MANIFEST_DIR"));
        add(&["simulate", &file, "--from", start, "--until", "2"]);
    }
    let clock = format!("{}/examples/events/clock.toml", env!("CARGO_MANIFEST_DIR"));
    add(&["simulate", &clock, "--from", "x=-1", "--until", "20"]);
    add(&["simulate", "x'' + x'/5 + x = 0", "--from", "x=1", "--lyapunov"]);
    let wall = ["--wall", "x < 1", "--restitution", "0.8", "--vary", "F=0.5:0.7"];
    add(&[&["response", "x'' + x'/10 + x = F*cos(t)"][..], &wall].concat());
    for file in files("examples/response", ".toml") {
        add(&["response", &file.to_string_lossy()]);
    }
    let two = "x'' + x'/5 + 2*x - y = cos(Omega*t); y'' + y'/5 + 2*y - x = 0";
    add(&["response", two, "--vary", "Omega=0.5:0.7", "--of", "x - y"]);
    let cycles = "v' = v - v^3/3 - w + I; w' = (v + 0.7 - 0.8*w)/5";
    add(&["response", cycles, "--vary", "I=0:0.6"]);
    for file in files("examples/modes", ".toml") {
        add(&["derive", &file.to_string_lossy()]);
    }
    let cubic = "x'' + x + x^3 + K*(x - y)^3 = 0; y'' + y + y^3 + K*(y - x)^3 = 0";
    add(&["derive", cubic, "--method", "harmonic-balance", "--at", "K=1/8,A=1/2"]);
    add(&["derive", "modal-pair", "--method", "harmonic-balance", "--order", "2", "--at", "A=1"]);
    for file in files("examples/slow", ".toml") {
        add(&["derive", &file.to_string_lossy()]);
    }
    for file in files("examples/audit", ".toml") {
        add(&["audit", &file.to_string_lossy()]);
    }
    add(&["absorber", "tuned", "--excitation", "ground"]);
    add(&["absorber", "tuned", "--at", "mu=1/20"]);
    add(&["absorber", "nonlinear"]);
    add(&["absorber", "impact-sink", "--at", "r=0.65,b=1,mu=1/100"]);
    add(&["absorber", "pendulum-sink", "--at", "r=0.5,b=1,w=0.95,mu=1/1000"]);
    for file in files("examples/orbits", ".toml") {
        add(&["orbits", &file.to_string_lossy()]);
    }
    let ball = "examples/orbits/bouncing-ball.toml";
    add(&["orbits", ball, "--certify", "--periods", "1"]);
    add(&["orbits", ball, "--vary", "Z=0.001:0.01"]);
    add(&["orbits", ball, "--vary", "Z=0.001:0.01", "--along", "e=0.2:0.9"]);
    let laws = ["shortest", "pendulum", "--range", "A=0:2.8", "--longest", "6"];
    add(&laws);
    add(&[&laws[..], &["--error", "0.01", "--certificate"]].concat());
    add(&["fit", "examples/fit/pendulum.csv", "x'' + c*x' + d*sgn(x') + g*sin(x) = 0"]);
    add(&["fit", "examples/fit/backbone.csv", "--data", "backbone"]);
    add(&[
        "fit",
        "examples/fit/response.csv",
        "x'' + c*x' + k*x + b*x^3 = F*cos(Omega*t)",
        "--data",
        "response",
    ]);
    add(&["fit", "examples/fit/impacts.csv", "--data", "impacts"]);
    add(&["paper"]);
    add(&["impact", "--compare"]);
    add(&["impact", "--certify"]);
    add(&["certify", "pendulum", "--at", "A=1", "--range", "1/10:3"]);
    for file in files("examples/lagrange", ".toml") {
        add(&["lagrange", &file.to_string_lossy()]);
    }
    add(&["lagrange"]);
    for file in files("examples/stability", ".toml") {
        add(&["stability", &file.to_string_lossy()]);
    }
    for file in files("examples/primary", ".toml") {
        add(&["simulate", &file.to_string_lossy(), "--sample", "1"]);
    }
    add(&["simulate", "examples/primary/driven.toml", "--sweep", "frequency=18:20:3"]);
    add(&["simulate", "examples/primary/chain.toml", "--chain"]);
    let driven = ["simulate", "x'' + x'/5 + x = F*cos(t)", "--from", "x=1"];
    add(&[&driven[..], &["--sweep", "F=0:1:3", "--every", "2*pi", "--after", "20"]].concat());
    add(&[&driven[..], &["--at", "F=1", "--section", "x'"]].concat());
    let links = "examples/lagrange/double-pendulum.toml";
    add(&["simulate", links, "--from", "a=1.5,b=-0.5", "--until", "5", "--integrator", "both"]);
    add(&["simulate", "x'' + x + x^3 = 0", "--from", "x=1"]);
    add(&["simulate", "--integrator", "both"]);
    add(&["simulate", "--sweep", "zeta=0.1:0.2:2", "--sweep", "alpha=0:0.1:3"]);
    let three = ["gamma=1e4:1e6:2:log", "zeta=0.1,0.3,0.2", "alpha=0.1:0:2"];
    add(&[&["simulate"], three.map(|axis| ["--sweep", axis]).as_flattened()].concat());
    add(&["friction"]);
    add(&["friction", "--alpha", "0.02", "--speed", "0.01"]);
    add(&["catalog"]);
    for file in files("examples/certify", ".toml") {
        add(&["certify", &file.to_string_lossy()]);
    }
    for line in output(&["simulate", "--sweep", "zeta=0.1,0.2,0.3", "--shard", "1/2"]).lines() {
        documents.push(("shard".to_owned(), serde_json::from_str(line).expect("a line of JSON")));
    }
    documents
}

#[test]
fn every_document_is_what_its_schema_says_and_reads_back() {
    let published = Published::new();
    let documents = documents();
    for (name, document) in &documents {
        assert_eq!(published.refusal(document), None, "{name}");
        reads_back(document);
    }
    for kind in DocumentKind::ALL {
        let of_kind = |entry: &&(String, Value)| entry.1["schema"] == kind.schema();
        assert!(
            documents.iter().any(|entry| of_kind(&entry)),
            "no document of kind {}",
            kind.name()
        );
    }
    // What no value stands for is null, so no key may go, and none may come; a text is no number.
    type Change = fn(&mut Value);
    let changes: [(&str, Change); 4] = [
        ("a key goes", |document| {
            let map = document.as_object_mut().expect("an object");
            let last = map.keys().next_back().expect("a key").clone();
            map.shift_remove(&last);
        }),
        ("a key comes", |document| document["unheard_of"] = json!(1)),
        ("a key comes inside", |document| innermost(document)["unheard_of"] = json!(1)),
        ("a text for what is none", |document| {
            let map = document.as_object_mut().expect("an object");
            *map.values_mut().next_back().expect("a value") = json!("text");
        }),
    ];
    for (name, document) in &documents {
        for (what, change) in changes {
            let mut changed = document.clone();
            change(&mut changed);
            assert!(published.refusal(&changed).is_some(), "{name}: {what}, and nobody minds");
        }
    }
}

/// An object inside an object that is no map of names.
fn innermost(document: &mut Value) -> &mut Value {
    let place = match document["schema"].as_str() {
        Some("lindstedt/solution/1") => "/equilibrium",
        Some("lindstedt/absorber/1") => "/designs/0/formulas/0",
        Some("lindstedt/orbits/1" | "lindstedt/shortest/1") => "/laws/0",
        Some("lindstedt/modes/1") => "/modes/0",
        Some("lindstedt/comparison/1") => "/methods/0",
        Some("lindstedt/impact/1") => "/derived_phases/1/displacement",
        Some("lindstedt/impact-comparison/1") => "/methods/0/speed",
        Some("lindstedt/simulation/1") => "/parameters/barrier",
        Some("lindstedt/materials/1") => "/materials/0/rest",
        Some("lindstedt/optimization/1") => "/asked/genetic",
        Some("lindstedt/sweep/1") => "/rows/0/final_state",
        Some("lindstedt/friction/1") => "/speeds/0/printed_value",
        Some("lindstedt/audit/1") => "/claims/0/entries/0",
        Some("lindstedt/response/1") => "/branches/0/0",
        Some("lindstedt/lagrangian/1") => match document["equilibria"][0].is_null() {
            true => "/groups/0",
            false => "/equilibria/0",
        },
        Some("lindstedt/motion/1" | "lindstedt/primary/1") => "/final_state",
        Some("lindstedt/one-harmonic/1") => "/motions/0",
        Some("lindstedt/fit/1") => "/laws/0",
        Some("lindstedt/slow-equations/1") => "/modes/0",
        Some("lindstedt/stability/1") => "/curves/0",
        Some("lindstedt/certificate/1") if document["ode"] == json::EQUATIONS_WITH_DRIVE => {
            "/drive"
        }
        Some("lindstedt/certificate/1") if document["ode"] == json::EQUATIONS_OF_CYCLES => {
            "/stability"
        }
        Some("lindstedt/certificate/1") if is_law(document) => "",
        Some("lindstedt/certificate/1") if document["ode"] == json::EQUATION_WITH_WALLS => {
            "/orbits/0/impacts/0"
        }
        Some("lindstedt/certificate/1") => "/formula",
        Some("lindstedt/motion-sweep/1") => "/motions/0/final_state",
        Some("lindstedt/primary-sweep/1") => "/rows/0",
        Some("lindstedt/impact-certificate/1") => "/closed_forms/0",
        Some("lindstedt/certificate-range/1") => "/to",
        Some("lindstedt/study/1" | "lindstedt/point/1") => "",
        _ => "/entries/0/methods/0",
    };
    document.pointer_mut(place).expect("an object")
}

/// A pinned document as it was printed: there, rounding noise and the number of steps are words,
/// and a slope has two digits.
fn unpinned(value: &mut Value) {
    match value {
        Value::String(text) if text == "noise" => *value = json!(0.0),
        Value::String(text) if text == "some" => *value = json!(0),
        Value::Array(list) => list.iter_mut().for_each(unpinned),
        Value::Object(map) => {
            for (key, entry) in map.iter_mut() {
                let slope = entry.as_str().filter(|_| key.ends_with("slope"));
                match slope.and_then(|slope| slope.parse::<f64>().ok()) {
                    Some(slope) => *entry = json!(slope),
                    None => unpinned(entry),
                }
            }
        }
        _ => {}
    }
}

/// The schemas are files, so that the program need not make them; they are what the types say that
/// write and read the documents.
#[test]
fn schemas_in_files_are_those_of_the_types() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/export/json/schemas");
    let mut written = Vec::new();
    for kind in DocumentKind::ALL {
        let generated = serde_json::to_string_pretty(&kind.generated_schema())
            .expect("a schema is JSON")
            + "\n";
        if generated != kind.json_schema() {
            let file = folder.join(format!("{}.json", kind.name()));
            std::fs::write(&file, generated).expect("a file that can be written");
            written.push(file);
        }
    }
    assert!(
        written.is_empty(),
        "{written:?} were not what the types say; they are written anew: look at them, and test again"
    );
}

#[test]
fn every_pinned_document_is_what_its_schema_says() {
    let published = Published::new();
    let mut count = 0;
    for file in files("snapshots", ".snap") {
        if !file.to_string_lossy().contains("json@") {
            continue;
        }
        let text = std::fs::read_to_string(&file).expect("a snapshot");
        let body = text.splitn(3, "---\n").nth(2).expect("a head and a body");
        let mut document: Value = serde_json::from_str(body).expect("JSON");
        unpinned(&mut document);
        assert_eq!(published.refusal(&document), None, "{}", file.display());
        count += 1;
    }
    assert!(count >= 40, "only {count} pinned documents");
}

#[test]
fn every_key_is_described_and_no_other_is_allowed() {
    /// The keys of a schema without a description, and objects that allow more keys.
    fn faults(place: &str, schema: &Value, found: &mut Vec<String>, keys: &mut usize) {
        if let Some(properties) = schema["properties"].as_object() {
            if schema["additionalProperties"] != json!(false) {
                found.push(format!("{place} is open"));
            }
            for (key, property) in properties {
                *keys += 1;
                let description = property["description"].as_str().unwrap_or_default();
                if !description.ends_with('.') || description.contains('\n') {
                    found.push(format!("{place}.{key}: {description:?}"));
                }
            }
        }
        match schema {
            Value::Object(map) => {
                for (key, part) in map {
                    faults(&format!("{place}/{key}"), part, found, keys);
                }
            }
            Value::Array(list) => {
                for part in list {
                    faults(place, part, found, keys);
                }
            }
            _ => {}
        }
    }
    for kind in DocumentKind::ALL {
        let printed = output(&["schema", kind.name()]);
        assert_eq!(printed.trim_end(), kind.json_schema().trim_end());
        let schema: Value = serde_json::from_str(&printed).expect("a schema is JSON");
        assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
        let (mut found, mut keys) = (Vec::new(), 0);
        faults(kind.name(), &schema, &mut found, &mut keys);
        assert_eq!(found, Vec::<String>::new());
        let least = match kind {
            DocumentKind::Study | DocumentKind::Point => 7,
            _ => 9,
        };
        assert!(keys >= least, "{}: only {keys} keys", kind.name());
    }
    // What is easily taken for something else is said where it stands.
    let said = |kind: DocumentKind, place: &str, words: &[&str]| {
        let schema: Value = serde_json::from_str(kind.json_schema()).expect("a schema is JSON");
        let description = schema.pointer(place).and_then(Value::as_str).expect(place);
        assert!(words.iter().all(|word| description.contains(word)), "{place}: {description}");
    };
    let key = |name: &str| format!("/properties/{name}/description");
    said(DocumentKind::Solution, &key("frequency_squared"), &["judged before `frequency`"]);
    said(DocumentKind::Solution, &key("closed_form"), &["parameter m"]);
    said(DocumentKind::Solution, &key("displacement"), &["equilibrium included"]);
    said(DocumentKind::Impact, "/$defs/Phase/description", &["s = t - clock"]);
    said(
        DocumentKind::Impact,
        "/$defs/Phase/properties/clock/description",
        &["counts", "derived return"],
    );
}

#[test]
fn an_unknown_kind_is_refused_with_the_known_ones() {
    let output = Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .args(["schema", "derivation"])
        .output()
        .expect("the program starts");
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty());
    assert!(DocumentKind::ALL.iter().all(|kind| message.contains(kind.name())), "{message}");
}

#[test]
fn hostile_documents_are_refused() {
    let duffing = document(&["derive", "duffing"]);
    let changes: [(&str, Value); 7] = [
        ("/schema", json!("lindstedt/impact/1")),
        ("/method", json!("magic")),
        ("/displacement/harmonics/0/harmonic", json!(u64::MAX)),
        ("/displacement/harmonics/0/harmonic", json!(100_001)),
        ("/frequency/terms/1/monomial/A", json!(i32::MAX)),
        ("/frequency/terms/1/monomial/A", json!(1e300)),
        ("/frequency/terms/1/exact", json!("1/0")),
    ];
    for (place, value) in changes {
        let mut changed = duffing.clone();
        *changed.pointer_mut(place).expect("a place") = value.clone();
        let refusal = json::read_solution(&changed).expect_err(place).to_string();
        assert!(!refusal.is_empty(), "{place} = {value}");
    }
    let many = (0..1001).map(|k| (format!("p{k}"), json!(1))).collect();
    let mut changed = duffing.clone();
    changed["frequency"]["terms"][1]["monomial"] = Value::Object(many);
    assert!(json::read_solution(&changed).is_err());
    assert!(json::read_solution(&duffing).is_ok());
    assert!(json::read_phases(&duffing).is_err());
}

/// Where Python is, if it is there at all: what starts it by that name may look for it each time.
pub(super) fn python() -> Option<PathBuf> {
    let asked = Command::new("python3").args(["-c", "import sys; print(sys.executable)"]).output();
    let output = asked.ok().filter(|output| output.status.success())?;
    Some(String::from_utf8(output.stdout).ok()?.trim().into())
}

/// Numbers that a reader prints for a document, a list for each line. It sees the standard library
/// alone.
fn by_reader(
    reader: &str,
    python: &Path,
    folder: &Path,
    document: &Value,
    times: &[f64],
) -> Vec<Vec<Value>> {
    let reader = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples").join(reader);
    let file = folder.join("document.json");
    std::fs::write(&file, document.to_string()).expect("the document is written");
    let output = Command::new(python)
        .args(["-I", "-S"])
        .arg(reader)
        .arg(&file)
        .args(times.iter().map(f64::to_string))
        .output()
        .expect("Python starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("text");
    text.lines().map(|line| serde_json::from_str(line).expect("a list")).collect()
}

/// Names and values.
type Given = &'static [(&'static str, &'static str)];

/// The equation, its values, and how many methods must have an answer there.
const READ: [(&str, Given, usize); 7] = [
    ("x'' + x + eps*x^3 = 0", &[("A", "3/2"), ("eps", "1/2")], 14),
    ("x'' + sin(x) = 0", &[("A", "6/5")], 13),
    ("x'' + x + x^2 + x^3 - 1/5 = 0", &[("A", "3/10")], 9),
    ("x'' + x + x^2 + x^3 - 1/5 = 0", &[("A", "-3/10")], 9),
    ("x'' + x + x*abs(x) = 0", &[("A", "-1/2")], 10),
    ("x'' + exp(x) - 1 = 0", &[("A", "-2/5")], 7),
    ("x'' - mu*(1 - x^2)*x' + x = 0", &[("mu", "3/10")], 1),
];

#[test]
fn a_reader_in_python_rebuilds_frequency_and_motion() {
    let lines = include_str!("../../examples/read_json.py").lines().count();
    assert!(lines <= 40, "{lines} lines");
    let Some(python) = python() else {
        eprintln!("python3 is not here: the reader was not run");
        return;
    };
    let folder = std::env::temp_dir().join(format!("lindstedt-reader-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let near = |read: &Value, value: f64, size: f64| {
        let read = read.as_f64().expect("a number");
        (read - value).abs() <= 1e-11 * size
    };
    let times = [0.0, 0.4, 1.7, 6.1, 23.0];
    for (equation, at, least) in READ {
        let oscillator = Oscillator::parse(equation).expect("an equation");
        let mut read = 0;
        for method in Method::ALL {
            let options = Options {
                method: Some(method),
                // Averaging begins with the first harmonic.
                amplitude: (method == Method::Averaging)
                    .then_some(lindstedt::solution::AmplitudeConvention::Initial),
                ..Options::default()
            };
            let Ok(solution) = solve(&oscillator, &options) else {
                continue;
            };
            let name = format!("{} on {equation} at {at:?}", method.name());
            // The same size by either amplitude.
            let size = match (solution.amplitude, &solution.limit_cycle) {
                (AmplitudeConvention::FirstHarmonic, None) => "a",
                _ => "A",
            };
            let mut values = Values::default();
            for (name, value) in at {
                let name = if *name == "A" { size } else { name };
                let value = value.parse().expect("a value");
                values.insert(Symbol::new(name), value).expect("a value");
            }
            let verification = judge(&oscillator, &solution, &values, 0.01).expect(&name);
            let written =
                serde_json::to_value(json::solution(&solution, Some(&verification))).expect("JSON");
            let numbers: BTreeMap<Symbol, f64> = verification
                .at
                .iter()
                .map(|entry| entry.0)
                .filter_map(|symbol| Some((symbol, values.get(symbol)?)))
                .collect();
            let own = evaluate(&oscillator, &solution, &numbers).expect(&name);
            let (omega, motion) = (own.frequency_squared.sqrt(), own.motion.expect(&name));
            let [line] = &by_reader("read_json.py", &python, &folder, &written, &times)[..] else {
                panic!("{name}: one line");
            };
            assert!(near(&line[0], omega, omega), "{name}: omega {} and {omega}", line[0]);
            for (t, x) in times.iter().zip(&line[1..]) {
                let value = motion.evaluate(omega * t);
                assert!(near(x, value, 1.0 + t), "{name}: x({t}) {x} and {value}");
            }
            if solution.limit_cycle.is_none() && size == "A" {
                let start = solution.equilibrium.evaluate(&numbers).expect("a number")
                    + numbers[&"A".into()];
                let found = motion.evaluate(0.0);
                assert!(
                    (found - start).abs() < 1e-9,
                    "{name}: starts at {found} instead of {start}"
                );
            }
            read += 1;
        }
        assert!(read >= least, "{equation}: only {read} methods");
    }
    for file in files("examples", ".toml").into_iter().filter(|file| is_impact(file)) {
        let written = document(&["impact", &file.to_string_lossy()]);
        let impact: ImpactDocument = serde_json::from_value(written.clone()).expect("an impact");
        let derived = &impact.derived_phases;
        let phases = || impact.phases.iter().chain(&impact.energy_phases).chain(derived);
        let middles: Vec<f64> = phases()
            .flat_map(|phase| {
                [0.0, 0.3, 0.9].map(|part| phase.start + part * (phase.end - phase.start))
            })
            .collect();
        let lines = by_reader("read_json.py", &python, &folder, &written, &middles);
        assert_eq!(lines.len(), phases().count(), "{}", file.display());
        assert_eq!(derived.len(), 3, "{}", file.display());
        for (phase, line) in phases().map(json::impact::Phase::read).zip(lines) {
            assert_eq!(line[0], phase.name);
            let inside = middles.iter().filter(|t| (phase.start..=phase.end).contains(t));
            let expected: Vec<f64> = inside.map(|t| phase.phase_point_at(*t).0).collect();
            assert_eq!(line.len(), 1 + expected.len());
            assert!(expected.len() >= 3);
            for (x, value) in line[1..].iter().zip(expected) {
                // To 1e-12.
                assert!(near(x, value, 0.1), "{}: {x} and {value}", phase.name);
            }
        }
    }
    std::fs::remove_dir_all(folder).expect("the folder goes");
}

#[test]
fn a_reader_in_python_rebuilds_motions_whose_amplitude_changes_or_is_driven() {
    let lines = include_str!("../../examples/read_slow_json.py").lines().count();
    assert!(lines <= 40, "{lines} lines");
    let Some(python) = python() else {
        eprintln!("python3 is not here: the reader was not run");
        return;
    };
    let folder = std::env::temp_dir().join(format!("lindstedt-slow-reader-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    for (equation, at, method) in [
        ("x'' + 2*zeta*x' + x + x^3 = 0", "A = 1, zeta = 1/20", Method::Averaging),
        ("x'' + 2*zeta*x' + x + x^3 = 0", "A = 1, zeta = 1/20", Method::MultipleScales),
        (
            "x'' + 2*zeta*x' + g*sin(x)/L = 0",
            "A = 1, zeta = 1/20, g = 9.81, L = 2",
            Method::MultipleScales,
        ),
        ("x'' + 2*zeta*x' + sin(x) = 0", "A = 1, zeta = 1/20", Method::Averaging),
        ("x'' - mu*(1 - x^2)*x' + x = 0", "A = 1, mu = 1/10", Method::Averaging),
        (
            "x'' + 2*zeta*x' + x + eps*x^3 = F*cos(w*t)",
            "F = 1/10, eps = 1/10, w = 9/10, zeta = 1/20",
            Method::MultipleScales,
        ),
    ] {
        let name = format!("{} on {equation} at {at}", method.name());
        let oscillator = Oscillator::parse(equation).expect("an equation");
        let options = Options { method: Some(method), ..Options::default() };
        let solution = solve(&oscillator, &options).expect(&name);
        let values: Values = at.parse().expect("values");
        let verification = judge(&oscillator, &solution, &values, 0.05).expect(&name);
        let written =
            serde_json::to_value(json::solution(&solution, Some(&verification))).expect("JSON");
        let paths = motions(&oscillator, &solution, &values).expect(&name).expect(&name);
        let samples = || {
            (0..5)
                .map(|k| k * (paths.formula.len() - 1) / 4)
                .map(|index| (paths.formula[index], paths.truth[index]))
        };
        let times: Vec<f64> = samples().map(|(formula, _)| formula.0).collect();
        let [line] = &by_reader("read_slow_json.py", &python, &folder, &written, &times)[..] else {
            panic!("{name}: one line");
        };
        let size = paths.truth.iter().map(|sample| sample.1.abs()).fold(0.0, f64::max);
        let deviation = verification.max_deviation.expect(&name);
        for ((formula, truth), x) in samples().zip(line) {
            let x = x.as_f64().expect("a number");
            assert!((x - formula.1).abs() < 1e-7, "{name}: x({}) {x} and {}", formula.0, formula.1);
            // The motion followed by steps is as far as the verdict says.
            assert!(
                (x - truth.1).abs() <= 1.01 * deviation * size,
                "{name}: x({}) {x} and {}",
                truth.0,
                truth.1
            );
        }
    }
    std::fs::remove_dir_all(folder).expect("the folder goes");
}

#[test]
fn where_a_motion_settles_the_values_are_those_of_its_cycle() {
    let oscillator = Oscillator::parse("x'' - mu*(1 - x^2)*x' + x = 0").expect("an equation");
    let options = Options { method: Some(Method::Averaging), ..Options::default() };
    let solution = solve(&oscillator, &options).expect("an answer");
    let verification = judge(&oscillator, &solution, &"mu = 1/10".parse().expect("values"), 0.01)
        .expect("a verdict");
    let value = |name: &str| {
        verification.values.iter().find(|entry| entry.0 == Symbol::new(name)).map(|entry| entry.1)
    };
    assert_eq!((value("a"), value("A")), (Some(2.0), None));
}
