//! One file in `examples/`, one run of the program, one snapshot in text and one in JSON. To add a
//! case, add a file.

use std::path::Path;
use std::process::{Command, Output};

use lindstedt::export::json::{read_phases, read_solution, solution};
use serde_json::Value;

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .args(arguments)
        .output()
        .expect("the program starts")
}

/// Standard output of a run that must succeed.
fn output(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    assert!(
        output.stderr.is_empty(),
        "{arguments:?} said {}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout).expect("the output is text")
}

fn snapshots(body: impl FnOnce()) {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(concat!(env!("CARGO_MANIFEST_DIR"), "/snapshots"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(body);
}

/// `impact` for a file of that name, `derive` for any other.
fn command_for(file: &Path) -> &'static str {
    let name = file.file_name().map(|name| name.to_string_lossy().into_owned());
    match name.is_some_and(|name| name.starts_with("impact")) {
        true => "impact",
        false => "derive",
    }
}

/// Floating-point numbers to eight digits, and what is rounding noise to its order of magnitude:
/// the last digits depend on the machine's sine.
fn rounded(value: &mut Value) {
    match value {
        Value::Number(number) if number.is_f64() => {
            let number = number.as_f64().unwrap_or_default();
            let digits = if number.abs() < 1e-8 { 0 } else { 7 };
            *value = format!("{number:.digits$e}")
                .parse()
                .map_or(Value::Null, |rounded: f64| rounded.into());
        }
        Value::Array(list) => {
            // Whether a harmonic of rounding noise is there at all is noise too.
            list.retain(|entry| !is_noise(&entry["cos"]) || !is_noise(&entry["sin"]));
            list.iter_mut().for_each(rounded);
        }
        Value::Object(map) => {
            // Rounding noise by nature.
            if map.contains_key("energy_drift") {
                map.insert("energy_drift".into(), "noise".into());
            }
            for key in ["slope", "amplitude_slope"] {
                if let Some(slope) = map.get_mut(key)
                    && let Some(number) = slope.as_f64()
                {
                    *slope = format!("{number:.2}").into();
                }
            }
            for (key, entry) in map.iter_mut() {
                let noise = entry.as_f64().map(f64::abs).is_some_and(|size| match key.as_str() {
                    "max_deviation" | "residual" => size < 1e-8,
                    "cos" | "sin" => is_noise(entry) && size > 0.0,
                    _ => key.ends_with("_error") && size < 1e-8,
                });
                if noise { *entry = "noise".into() } else { rounded(entry) }
            }
        }
        _ => {}
    }
}

/// Whether a harmonic of a motion is rounding noise.
fn is_noise(value: &Value) -> bool {
    value.as_f64().is_some_and(|number| number.abs() < 1e-12)
}

#[test]
fn every_example_prints_what_it_printed() {
    snapshots(|| {
        insta::glob!(concat!(env!("CARGO_MANIFEST_DIR"), "/examples"), "*.toml", |file| {
            let path = file.to_str().expect("a path in text");
            insta::assert_snapshot!("text", output(&[command_for(file), path]));
            insta::assert_snapshot!(
                "latex",
                output(&[command_for(file), path, "--format", "latex"])
            );
            let mut document: Value =
                serde_json::from_str(&output(&[command_for(file), path, "--format", "json"]))
                    .expect("the output is JSON");
            rounded(&mut document);
            insta::assert_json_snapshot!("json", document);
        });
    });
}

#[path = "../../examples/two_links.rs"]
mod two_links;

/// The example of the library: a motion checked by its energy and by the other integrator.
#[test]
fn the_example_of_two_links_prints_what_it_printed() {
    two_links::main().expect("a motion");
    snapshots(|| insta::assert_snapshot!("two-links", two_links::report().expect("a motion")));
}

#[path = "../../examples/coupled_modes.rs"]
mod coupled_modes;
#[path = "../../examples/first_law.rs"]
mod first_law;
#[path = "../../examples/impact_phases.rs"]
mod impact_phases;
#[path = "../../examples/poincare_section.rs"]
mod poincare_section;
#[path = "../../examples/resonance_curve.rs"]
mod resonance_curve;
#[path = "../../examples/which_method.rs"]
mod which_method;

/// The programs that a reader of the README would write first run to their end.
#[test]
fn the_first_programs_run() {
    for program in [
        coupled_modes::main,
        first_law::main,
        impact_phases::main,
        poincare_section::main,
        resonance_curve::main,
        which_method::main,
    ] {
        program().expect("a program that runs to its end");
    }
}

/// The table of every method in text, LaTeX and JSON.
#[test]
fn every_comparison_prints_what_it_printed() {
    snapshots(|| {
        insta::glob!(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/compare"), "*.toml", |file| {
            let path = file.to_str().expect("a path in text");
            insta::assert_snapshot!("compare-text", output(&["compare", path]));
            insta::assert_snapshot!(
                "compare-latex",
                output(&["compare", path, "--format", "latex"])
            );
            let mut document: Value =
                serde_json::from_str(&output(&["compare", path, "--format", "json"]))
                    .expect("the output is JSON");
            rounded(&mut document);
            insta::assert_json_snapshot!("compare-json", document);
        });
    });
}

/// Steady states in text; of one of them LaTeX, the head of the comma-separated values, and every
/// twentieth point in JSON.
#[test]
fn every_response_prints_what_it_printed() {
    snapshots(|| {
        insta::glob!(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/response"), "*.toml", |file| {
            let path = file.to_str().expect("a path in text");
            insta::assert_snapshot!("response-text", output(&["response", path]));
        });
        let path = "examples/response/duffing.toml";
        insta::assert_snapshot!("response-latex", output(&["response", path, "--format", "latex"]));
        let table = output(&["response", path, "--format", "csv"]);
        let head: Vec<&str> = table.lines().take(2).collect();
        insta::assert_snapshot!("response-csv", head.join("\n"));
        let mut document: Value =
            serde_json::from_str(&output(&["response", path, "--format", "json"]))
                .expect("the output is JSON");
        for list in ["branches", "backbone"] {
            for points in document[list].as_array_mut().expect("lists") {
                let points = points.as_array_mut().expect("points");
                *points = points.iter().step_by(20).cloned().collect();
            }
        }
        rounded(&mut document);
        noisy(&mut document);
        insta::assert_json_snapshot!("response-json@duffing.toml", document);
        insta::assert_snapshot!("help-response", output(&["response", "--help"]));
    });
}

/// What is left of small errors to three digits: more of it is rounding.
fn noisy(value: &mut Value) {
    match value {
        Value::Object(map) => {
            for (key, entry) in map.iter_mut() {
                match (key.as_str(), entry.as_f64()) {
                    ("error", Some(error)) => {
                        *entry = format!("{error:.0e}")
                            .parse()
                            .map_or(Value::Null, |error: f64| error.into());
                    }
                    _ => noisy(entry),
                }
            }
        }
        Value::Array(list) => list.iter_mut().for_each(noisy),
        _ => {}
    }
}

/// Claims of publications with their verdicts, in text, LaTeX and JSON.
#[test]
fn every_audit_prints_what_it_printed() {
    snapshots(|| {
        insta::glob!(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/audit"), "*.toml", |file| {
            let path = file.to_str().expect("a path in text");
            insta::assert_snapshot!("audit-text", output(&["audit", path]));
            insta::assert_snapshot!("audit-latex", output(&["audit", path, "--format", "latex"]));
            let mut document: Value =
                serde_json::from_str(&output(&["audit", path, "--format", "json"]))
                    .expect("the output is JSON");
            rounded(&mut document);
            insta::assert_json_snapshot!("audit-json", document);
        });
    });
}

/// Proofs in text and LaTeX, and the certificate of the first of them.
#[test]
fn every_certificate_prints_what_it_printed() {
    snapshots(|| {
        insta::glob!(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/certify"), "*.toml", |file| {
            let path = file.to_str().expect("a path in text");
            insta::assert_snapshot!("certify-text", output(&["certify", path]));
            insta::assert_snapshot!(
                "certify-latex",
                output(&["certify", path, "--format", "latex"])
            );
        });
        let cubic = "examples/certify/cubic-pendulum.toml";
        let range = ["certify", cubic, "--at", "A=1", "--range", "1/10:2.4"];
        insta::assert_snapshot!("certify-range", output(&range));
        insta::assert_snapshot!("help-certify", output(&["certify", "--help"]));
        insta::assert_snapshot!("help-check", output(&["check", "--help"]));
    });
}

/// Every mechanism, its equations of motion and its groups, in text, LaTeX and JSON; the paper's
/// among them.
#[test]
fn every_mechanism_prints_what_it_printed() {
    snapshots(|| {
        insta::glob!(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/lagrange"), "*.toml", |file| {
            let path = file.to_str().expect("a path in text");
            insta::assert_snapshot!("lagrange-text", output(&["lagrange", path]));
            insta::assert_snapshot!(
                "lagrange-latex",
                output(&["lagrange", path, "--format", "latex"])
            );
            let mut document: Value =
                serde_json::from_str(&output(&["lagrange", path, "--format", "json"]))
                    .expect("the output is JSON");
            rounded(&mut document);
            insta::assert_json_snapshot!("lagrange-json", document);
        });
        insta::assert_snapshot!("lagrange-paper-text", output(&["lagrange"]));
        insta::assert_snapshot!("lagrange-paper-latex", output(&["lagrange", "--format", "latex"]));
        let mut document: Value = serde_json::from_str(&output(&["lagrange", "--format", "json"]))
            .expect("the output is JSON");
        rounded(&mut document);
        insta::assert_json_snapshot!("lagrange-paper-json", document);
        let links = "examples/lagrange/double-pendulum.toml";
        let course = ["simulate", links, "--from", "a=1.5,b=-0.5", "--until", "2"];
        insta::assert_snapshot!("motion-text", output(&course));
        insta::assert_snapshot!(
            "motion-csv",
            output(&[&course[..], &["--format", "csv", "--sample", "1"]].concat())
        );
        let driven =
            ["simulate", "x'' + x'/5 - x + x^3 = F*cos(t)", "--from", "x=1", "--until", "60"];
        let settled = ["--every", "2*pi", "--after", "20"];
        insta::assert_snapshot!(
            "section-text",
            output(&[&driven[..], &settled, &["--at", "F=0.1"]].concat())
        );
        insta::assert_snapshot!(
            "motion-sweep-text",
            output(&[&driven[..], &settled, &["--sweep", "F=0:0.2:3"]].concat())
        );
        insta::assert_snapshot!("help-lagrange", output(&["lagrange", "--help"]));
    });
}

/// Every system of coupled equations and its nonlinear normal modes, in text, LaTeX and JSON.
#[test]
fn every_system_of_modes_prints_what_it_printed() {
    snapshots(|| {
        insta::glob!(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/modes"), "*.toml", |file| {
            let path = file.to_str().expect("a path in text");
            insta::assert_snapshot!("modes-text", output(&["derive", path]));
            insta::assert_snapshot!("modes-latex", output(&["derive", path, "--format", "latex"]));
            let mut document: Value =
                serde_json::from_str(&output(&["derive", path, "--format", "json"]))
                    .expect("the output is JSON");
            rounded(&mut document);
            insta::assert_json_snapshot!("modes-json", document);
        });
    });
}

/// Every system of coupled equations and its slow equations, in text, LaTeX and JSON.
#[test]
fn every_system_of_slow_equations_prints_what_it_printed() {
    snapshots(|| {
        insta::glob!(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/slow"), "*.toml", |file| {
            let path = file.to_str().expect("a path in text");
            insta::assert_snapshot!("slow-text", output(&["derive", path]));
            insta::assert_snapshot!("slow-latex", output(&["derive", path, "--format", "latex"]));
            let mut document: Value =
                serde_json::from_str(&output(&["derive", path, "--format", "json"]))
                    .expect("the output is JSON");
            rounded(&mut document);
            insta::assert_json_snapshot!("slow-json", document);
        });
    });
}

/// Every equation with periodic coefficients and its transition curves, in text, LaTeX and JSON.
#[test]
fn every_stability_prints_what_it_printed() {
    snapshots(|| {
        insta::glob!(
            concat!(env!("CARGO_MANIFEST_DIR"), "/examples/stability"),
            "*.toml",
            |file| {
                let path = file.to_str().expect("a path in text");
                insta::assert_snapshot!("stability-text", output(&["stability", path]));
                insta::assert_snapshot!(
                    "stability-latex",
                    output(&["stability", path, "--format", "latex"])
                );
                let mut document: Value =
                    serde_json::from_str(&output(&["stability", path, "--format", "json"]))
                        .expect("the output is JSON");
                rounded(&mut document);
                insta::assert_json_snapshot!("stability-json", document);
            }
        );
        insta::assert_snapshot!("help-stability", output(&["stability", "--help"]));
    });
}

/// A main mass with its damper, in text, JSON and comma-separated values, and driven at several
/// frequencies.
#[test]
fn every_main_mass_prints_what_it_printed() {
    snapshots(|| {
        insta::glob!(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/primary"), "*.toml", |file| {
            let path = file.to_str().expect("a path in text");
            let text = output(&["simulate", path, "--sample", "10"]);
            // What is lost to rounding differs from machine to machine.
            let (kept, rest) = text.split_once("  unaccounted for").expect("an account");
            let rest = rest.split_once('\n').expect("a line").1;
            insta::assert_snapshot!("primary-text", format!("{kept}{rest}"));
        });
        let driven = "examples/primary/driven.toml";
        let swept = ["simulate", driven, "--sweep", "frequency=17:21:5"];
        insta::assert_snapshot!("primary-sweep-text", output(&swept));
        insta::assert_snapshot!(
            "primary-sweep-csv",
            output(&[&swept[..], &["--format", "csv"]].concat())
        );
    });
}

/// The same swing against barriers of several materials, in text, LaTeX and JSON.
#[test]
fn every_study_of_materials_prints_what_it_printed() {
    snapshots(|| {
        insta::glob!(
            concat!(env!("CARGO_MANIFEST_DIR"), "/examples/materials"),
            "*.toml",
            |file| {
                let path = file.to_str().expect("a path in text");
                insta::assert_snapshot!("materials-text", output(&["materials", path]));
                insta::assert_snapshot!(
                    "materials-latex",
                    output(&["materials", path, "--format", "latex"])
                );
                let mut document: Value =
                    serde_json::from_str(&output(&["materials", path, "--format", "json"]))
                        .expect("the output is JSON");
                rounded(&mut document);
                insta::assert_json_snapshot!("materials-json", document);
            }
        );
        let table_2 = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/materials/table-2.toml");
        assert_eq!(output(&["materials"]), output(&["materials", table_2]));
    });
}

/// Searches for the best damper, in text, LaTeX, JSON and comma-separated values. Closed forms, so
/// the numbers are those of any machine up to its powers and logarithms; a search multiplies the
/// last digits of those, and six are shown.
#[test]
fn every_search_prints_what_it_printed() {
    snapshots(|| {
        insta::glob!(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/optimize"), "*.toml", |file| {
            let path = file.to_str().expect("a path in text");
            insta::assert_snapshot!("optimize-text", output(&["optimize", path]));
        });
        let of =
            |name: &str| format!("{}/examples/optimize/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let materials = of("materials");
        insta::assert_snapshot!(
            "optimize-latex",
            output(&["optimize", &materials, "--format", "latex"])
        );
        insta::assert_snapshot!(
            "optimize-csv",
            output(&["optimize", &materials, "--format", "csv"])
        );
        insta::assert_snapshot!(
            "optimize-front-csv",
            output(&["optimize", &of("front"), "--format", "csv"])
        );
        let mut document: Value =
            serde_json::from_str(&output(&["optimize", &materials, "--format", "json"]))
                .expect("the output is JSON");
        rounded(&mut document);
        insta::assert_json_snapshot!("json@optimize-materials", document);
        insta::assert_snapshot!("help-optimize", output(&["optimize", "--help"]));
    });
}

/// The table of every method on one impact, in text, LaTeX and JSON: one for a page, one for a
/// narrow terminal.
#[test]
fn every_method_on_one_impact_prints_what_it_printed() {
    let preloaded = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/impact-preloaded.toml");
    let of_own = [
        "impact",
        "x'' + x + x^2 = 0",
        "--at",
        "A=0.3",
        "--at",
        "xc=0.1",
        "--at",
        "gamma=1e4",
        "--compare",
    ];
    let refused = run(&["impact", preloaded, "--compare"]);
    let words = String::from_utf8_lossy(&refused.stderr);
    assert!(refused.status.code() == Some(2) && words.contains("leave out --method"), "{words}");
    snapshots(|| {
        insta::assert_snapshot!("impact-compare-text", output(&["impact", "--compare"]));
        insta::assert_snapshot!("impact-compare-own", output(&of_own));
        insta::assert_snapshot!(
            "impact-compare-latex",
            output(&["impact", "--compare", "--format", "latex"])
        );
        insta::assert_snapshot!("impact-certify-text", output(&["impact", "--certify"]));
        insta::assert_snapshot!(
            "impact-certify-latex",
            output(&["impact", "--certify", "--format", "latex"])
        );
        let mut document: Value =
            serde_json::from_str(&output(&["impact", "--compare", "--format", "json"]))
                .expect("the output is JSON");
        rounded(&mut document);
        insta::assert_json_snapshot!("json@impact-compare", document);
    });
}

/// The study of friction in every format: where the arctangent creeps, and, with less friction,
/// where it swings.
#[test]
fn the_study_of_friction_prints_what_it_printed() {
    let weak = ["friction", "--alpha", "0.02", "--speed", "0.01"];
    snapshots(|| {
        insta::assert_snapshot!("friction-text", output(&["friction"]));
        insta::assert_snapshot!("friction-weak", output(&weak));
        insta::assert_snapshot!("friction-latex", output(&["friction", "--format", "latex"]));
        let mut document: Value = serde_json::from_str(&output(&["friction", "--format", "json"]))
            .expect("the output is JSON");
        rounded(&mut document);
        insta::assert_json_snapshot!("json@friction", document);
        insta::assert_snapshot!("help-friction", output(&["friction", "--help"]));
    });
}

#[test]
fn every_example_reads_back_to_the_same_solution() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/examples");
    let files = std::fs::read_dir(folder)
        .expect("examples/ exists")
        .filter_map(Result::ok)
        .map(|entry| entry.path());
    let mut count = 0;
    for file in files.filter(|file| file.extension().is_some_and(|extension| extension == "toml")) {
        let command = command_for(&file);
        let text = output(&[command, file.to_str().expect("a path in text"), "--format", "json"]);
        let mut document: Value = serde_json::from_str(&text).expect("the output is JSON");
        if command == "derive" {
            let read = read_solution(&document).expect("a solution");
            document["verification"] = Value::Null;
            let written = serde_json::to_value(solution(&read, None)).expect("JSON");
            assert_eq!(written, document, "{}", file.display());
        } else {
            let phases = read_phases(&document).expect("three phases");
            assert_eq!(phases.len(), 3);
            let list = |key: &str| document[key].as_array().expect("a list").clone();
            let entries =
                if list("phases").is_empty() { list("derived_phases") } else { list("phases") };
            for (phase, entry) in phases.iter().zip(&entries) {
                assert_eq!(phase.closed_form(), entry["closed_form"].as_str().expect("text"));
                let (x, velocity) = phase.phase_point_at(phase.end);
                assert_eq!(Some(x), entry["end_state"]["x"].as_f64());
                assert_eq!(Some(velocity), entry["end_state"]["velocity"].as_f64());
            }
            for law in [&document["law"], &document["derived_law"]["law"]] {
                assert!(law.is_null() || read_solution(law).is_ok(), "the law is a solution");
            }
        }
        count += 1;
    }
    assert!(count >= 8, "only {count} examples");
}

#[test]
fn help_says_what_there_is() {
    snapshots(|| {
        insta::assert_snapshot!("help", output(&["--help"]));
        insta::assert_snapshot!("help-derive", output(&["derive", "--help"]));
        insta::assert_snapshot!("help-compare", output(&["compare", "--help"]));
        insta::assert_snapshot!("help-impact", output(&["impact", "--help"]));
        insta::assert_snapshot!("help-materials", output(&["materials", "--help"]));
        insta::assert_snapshot!("help-catalog", output(&["catalog", "--help"]));
        insta::assert_snapshot!("help-schema", output(&["schema", "--help"]));
        insta::assert_snapshot!("catalog", output(&["catalog"]));
        insta::assert_snapshot!("catalog-double-well", output(&["catalog", "double-well"]));
        let duffing = ["derive", "duffing", "--steps"];
        insta::assert_snapshot!("steps", output(&duffing));
        insta::assert_snapshot!(
            "steps-latex",
            output(&[duffing.as_slice(), &["--format", "latex"]].concat())
        );
    });
}

#[test]
fn no_command_is_the_impact_of_the_paper() {
    assert_eq!(output(&[]), output(&["impact"]));
    let example = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/impact-paper.toml");
    assert_eq!(output(&[]), output(&["impact", example]));
}

#[test]
fn exit_codes_are_those_of_the_manual() {
    for (arguments, code) in [
        (vec!["derive", "x'' + sin(x) = 0", "--at", "A=1.5", "--tolerance", "0.01"], 0),
        (vec!["derive", "x'' + sin(x) = 0", "--at", "A=1.5", "--tolerance", "1e-6"], 3),
        (vec!["derive", "damped-pendulum", "--method", "lindstedt-poincare"], 1),
        (vec!["derive", "x'' + eps*x^3 + x", "--at", "A=1"], 1),
        (vec!["derive", "x'' + sin(x) = 0", "--at", "B=1"], 2),
        (vec!["derive", "x'' + sin(x) = 0", "--method", "magic"], 2),
        (vec!["compare", "pendulum", "--at", "A=1.5"], 0),
        (vec!["compare", "pendulum", "--at", "A=1.5", "--tolerance", "0.01"], 3),
        (vec!["compare", "pendulum", "--at", "A=1", "--tolerance", "0.01"], 0),
        (vec!["compare", "pendulum", "--at", "A=4"], 1),
        (vec!["compare", "duffing", "--at", "A=1"], 1),
        (vec!["compare", "duffing", "--at", "B=1"], 2),
        (vec!["compare", "magnetic-wire", "--at", "A=0.1", "--at", "lambda=0.1"], 0),
        (vec!["derive", "magnetic-wire", "--at", "A=0.1", "--at", "lambda=0.1"], 0),
        (vec!["compare", "x'' + x + tanh(x') = 0", "--at", "A=1"], 1),
        (vec!["derive", "duffing", "--method", "pade", "--order", "3,2"], 0),
        (vec!["derive", "duffing", "--method", "pade", "--order", "3"], 2),
        (vec!["derive", "duffing", "--order", "3,2"], 2),
        (vec!["derive", "duffing", "--method", "hermite-pade", "--order", "2,2,2"], 0),
        (vec!["derive", "duffing", "--method", "hermite-pade", "--order", "2,2"], 2),
        (vec!["derive", "duffing", "--method", "pade", "--order", "2,2,2"], 2),
        (vec!["derive", "duffing", "--method", "homotopy-analysis", "--hbar", "-1"], 0),
        (vec!["derive", "duffing", "--hbar", "-1"], 2),
        (vec!["derive", "duffing", "--method", "homotopy-analysis", "--hbar", "x"], 2),
        (vec!["impact", "--tolerance", "0.1"], 0),
        (vec!["impact", "--tolerance", "0.001"], 0),
        (vec!["impact", "--order", "2", "--tolerance", "0.01"], 3),
        (vec!["schema", "solution"], 0),
        (vec!["schema", "solutions"], 2),
        (vec!["schema"], 2),
        (vec!["imapct"], 2),
    ] {
        let output = run(&arguments);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}");
        assert_eq!(output.stdout.is_empty(), code == 1 || code == 2, "{arguments:?}");
        assert_eq!(output.stderr.is_empty(), code == 0 || code == 3, "{arguments:?}");
    }
}

/// Everything that prints as LaTeX: the examples, and a derivation by either method.
fn latex_documents() -> Vec<(String, String)> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/examples");
    let files = std::fs::read_dir(folder)
        .expect("examples/ exists")
        .filter_map(Result::ok)
        .map(|entry| entry.path());
    let mut documents: Vec<(String, String)> = files
        .filter(|file| file.extension().is_some_and(|extension| extension == "toml"))
        .map(|file| {
            let path = file.to_str().expect("a path in text");
            (path.to_owned(), output(&[command_for(&file), path, "--format", "latex"]))
        })
        .collect();
    for method in ["lindstedt-poincare", "homotopy-perturbation"] {
        let steps = [
            "derive",
            "helmholtz",
            "--steps",
            "--order",
            "3",
            "--format",
            "latex",
            "--method",
            method,
        ];
        documents.push((method.to_owned(), output(&steps)));
    }
    for problem in ["duffing", "pendulum", "quadratic"] {
        let path = format!("{folder}/compare/{problem}.toml");
        documents
            .push((format!("compare {problem}"), output(&["compare", &path, "--format", "latex"])));
    }
    for method in [
        "harmonic-balance",
        "exact",
        "pade",
        "hermite-pade",
        "energy-balance",
        "iteration-perturbation",
        "homotopy-analysis",
    ] {
        for equation in ["pendulum", "duffing"] {
            let arguments =
                ["derive", equation, "--method", method, "--steps", "--format", "latex"];
            documents.push((format!("{method} {equation}"), output(&arguments)));
        }
    }
    for study in ["table-2", "further"] {
        let path = format!("{folder}/materials/{study}.toml");
        documents.push((
            format!("materials {study}"),
            output(&["materials", &path, "--format", "latex"]),
        ));
    }
    documents.push(("catalog".to_owned(), output(&["catalog", "--format", "latex"])));
    documents.sort();
    documents
}

#[test]
fn latex_is_balanced_and_uses_known_commands_only() {
    const COMMANDS: [&str; 69] = [
        "int",
        "Rightarrow",
        "hbar",
        "Gamma",
        "begin",
        "item",
        "end",
        "frac",
        "sqrt",
        "left",
        "right",
        "omega",
        "Omega",
        "Lambda",
        "psi",
        "theta",
        "varepsilon",
        "gamma",
        "mu",
        "zeta",
        "lambda",
        "alpha",
        "beta",
        "kappa",
        "cos",
        "sin",
        "tan",
        "sinh",
        "cosh",
        "tanh",
        "arcsin",
        "arccos",
        "arctan",
        "exp",
        "ln",
        "max",
        "min",
        "operatorname",
        "pi",
        "dot",
        "ddot",
        "mathrm",
        "quad",
        "qquad",
        "le",
        "cdot",
        "text",
        "hline",
        "bigl",
        "bigr",
        "footnotesize",
        "scriptsize",
        "setlength",
        "tabcolsep",
        "noindent",
        "raggedright",
        "raggedleft",
        "tabularnewline",
        "linewidth",
        "dots",
        "delta",
        "eta",
        "nu",
        "xi",
        "rho",
        "sigma",
        "tau",
        "phi",
        "chi",
    ];
    for (name, document) in latex_documents() {
        let lines: Vec<&str> = document.lines().filter(|line| !line.starts_with('%')).collect();
        let text = lines.join("\n");
        let (mut depth, mut delimiters) = (0_i32, 0_i32);
        for letter in text.chars() {
            depth += i32::from(letter == '{') - i32::from(letter == '}');
            assert!(depth >= 0, "{name}: a brace closes what was not opened");
        }
        assert_eq!(depth, 0, "{name}: braces");
        for command in text.split('\\').skip(1) {
            let word: String = command.chars().take_while(char::is_ascii_alphabetic).collect();
            assert!(word.is_empty() || COMMANDS.contains(&word.as_str()), "{name}: \\{word}");
            delimiters += i32::from(word == "left") - i32::from(word == "right");
            assert!(delimiters >= 0, "{name}: \\right without \\left");
        }
        assert_eq!(delimiters, 0, "{name}: \\left without \\right");
        let aligned = text.contains("\\begin{align*}");
        assert!(aligned || name == "catalog" || name.starts_with("compare"), "{name}");
        assert!(text.matches("\\begin{").count() == text.matches("\\end{").count());
    }
}

/// Where LaTeX is on the machine, it has the last word.
#[test]
fn latex_compiles_where_latex_is() {
    let version = Command::new("pdflatex").arg("--version").output();
    if !version.is_ok_and(|output| output.status.success()) {
        return;
    }
    let folder = std::env::temp_dir().join(format!("lindstedt-latex-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let bodies: Vec<String> = latex_documents().into_iter().map(|(_, document)| document).collect();
    let packages = lindstedt::export::latex::packages(&bodies.join("\n"));
    let head = format!("\\documentclass{{article}}\n{packages}\n\\begin{{document}}\n");
    std::fs::write(
        folder.join("all.tex"),
        format!("{head}{}\n\\end{{document}}\n", bodies.join("\n")),
    )
    .expect("the document is written");
    let arguments = ["-interaction=nonstopmode", "-halt-on-error", "all.tex"];
    let run = Command::new("pdflatex")
        .args(arguments)
        .current_dir(&folder)
        .output()
        .expect("pdflatex starts");
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stdout));
    std::fs::remove_dir_all(folder).expect("the folder goes");
}

#[cfg(feature = "plot")]
#[test]
fn pictures_are_drawn_and_the_same_on_every_run() {
    let folder = std::env::temp_dir().join(format!("lindstedt-pictures-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder for pictures");
    for arguments in [
        vec!["impact"],
        vec!["derive", "x'' + sin(x) = 0", "--at", "A=1.5"],
        vec!["compare", "x'' + x + x^3 = 0", "--at", "A=1.5"],
    ] {
        let draw = |name: &str| {
            let path = folder.join(name);
            let mut arguments = arguments.clone();
            arguments.extend(["--plot", path.to_str().expect("a path in text")]);
            output(&arguments);
            std::fs::read_to_string(path).expect("the picture was written")
        };
        let picture = draw("first.svg");
        let truth = if arguments[0] == "compare" { "true motion" } else { "Runge-Kutta" };
        assert!(picture.contains("<svg") && picture.contains(truth));
        assert_eq!(picture, draw("second.svg"));
    }
    std::fs::remove_dir_all(folder).expect("the folder goes");
}
