//! Certificates as files: what `certify` writes `check` proves, a second program in another language proves, and what has been tampered
//! with neither.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use lindstedt::certificate::{check, check_damped};
use lindstedt::exact::{Rational, ratio};
use lindstedt::export::json::{self, CertificateDocument, DampedCertificateDocument};
use serde_json::{Value, json};

use super::documents::python;

fn run(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lindstedt"));
    command
        .args(arguments)
        .args(["--timeout", "3600"])
        .output()
        .expect("the program starts")
}

fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("lindstedt-certificates-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// A certificate, and its file.
fn certified(folder: &Path, arguments: &[&str]) -> (PathBuf, Value) {
    let file = folder.join("certificate.json");
    let written = run(&[
        &["certify"],
        arguments,
        &["--output", file.to_str().expect("a path in text")],
    ]
    .concat());
    assert!(
        written.status.success(),
        "{arguments:?}: {}",
        String::from_utf8_lossy(&written.stderr)
    );
    let text = std::fs::read_to_string(&file).expect("a file");
    (file, serde_json::from_str(&text).expect("JSON"))
}

fn read(document: &Value) -> Result<CertificateDocument, serde_json::Error> {
    serde_json::from_value(document.clone())
}

#[test]
fn driven_motions_are_proved_and_proved_again() {
    let folder = folder("driven");
    for example in [
        "forced-duffing",
        "subharmonic",
        "superharmonic",
        "parametric",
        "driven-well",
        "second-tongue",
    ] {
        let problem = format!("{}/examples/{example}.toml", env!("CARGO_MANIFEST_DIR"));
        let (file, document) = certified(&folder, &[&problem]);
        let said = run(&["certify", &problem]);
        let said = String::from_utf8_lossy(&said.stdout);
        assert!(
            said.contains("pass (amplitude within 1 %, proved)"),
            "{example}: {said}"
        );
        let checked = run(&["check", file.to_str().expect("a path in text")]);
        assert!(checked.status.success(), "{example}");
        let proof = |text: &str| {
            text.lines()
                .skip_while(|line| !line.starts_with("The proof"))
                .map(str::to_owned)
                .collect::<Vec<_>>()
        };
        assert_eq!(
            proof(&said),
            proof(&String::from_utf8_lossy(&checked.stdout)),
            "{example}"
        );
        // What belongs to a cycle is not there, and what is put there is refused.
        for key in ["p", "omega"] {
            assert!(document.get(key).is_none(), "{example}: {key}");
        }
        for (key, value) in [
            ("p", json!("1")),
            ("drive", Value::Null),
            ("sigma_log2", json!(1)),
            ("odd", json!("yes")),
        ] {
            let mut other = document.clone();
            other[key] = value;
            std::fs::write(&file, other.to_string()).expect("a file");
            let checked = run(&["check", file.to_str().expect("a path in text")]);
            assert_eq!(checked.status.code(), Some(1), "{example}: {key}");
        }
    }
    std::fs::remove_dir_all(&folder).expect("an own folder");
}

#[test]
fn what_certify_writes_check_proves() {
    let folder = folder("check");
    for example in ["pendulum", "cubic-pendulum", "quadratic", "spring"] {
        let problem = format!("{}/examples/certify/{example}.toml", env!("CARGO_MANIFEST_DIR"));
        let (file, document) = certified(&folder, &[&problem]);
        let checked = run(&["check", file.to_str().expect("a path in text")]);
        assert!(
            checked.status.success(),
            "{example}: {}",
            String::from_utf8_lossy(&checked.stderr)
        );
        // The same facts, without the derivation.
        let facts = |output: &[u8]| {
            let text = String::from_utf8_lossy(output).into_owned();
            let lines = text
                .lines()
                .filter(|line| line.starts_with("  ") && !line.contains("x") && !line.contains("u"));
            lines.map(str::to_owned).collect::<Vec<_>>()
        };
        let proved = run(&["certify", &problem]);
        let same = facts(&proved.stdout);
        assert!(
            facts(&checked.stdout).iter().filter(|line| same.contains(line)).count() >= 7,
            "{example}"
        );
        // Once more through the types.
        let document = read(&document).expect("a document");
        let certificate = document.read().expect("a certificate");
        assert_eq!(lindstedt::export::json::certificate(&certificate), document);
        // A tolerance that is missed is exit code 3.
        let strict = run(&["check", file.to_str().expect("a path in text"), "--tolerance", "1e-12"]);
        assert_eq!(strict.status.code(), Some(3), "{example}");
    }
}

/// omega from below and from above, by the second program; `None` where it does not prove the certificate.
fn by_python(python: &Path, file: &Path) -> Option<[Rational; 2]> {
    let program = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/check_certificate.py");
    let output = Command::new(python)
        .args(["-I", "-S"])
        .arg(program)
        .arg(file)
        .output()
        .expect("Python starts");
    let errors = String::from_utf8_lossy(&output.stderr);
    if !output.status.success() {
        assert!(errors.starts_with("not proved: "), "{errors}");
        return None;
    }
    let [_, lower, upper]: [String; 3] = serde_json::from_slice(&output.stdout).expect("three texts");
    let fraction = |text: &str| {
        let digits: Rational = text.replace('.', "").parse().expect("digits");
        digits / ratio(10, 1).pow(36)
    };
    Some([fraction(&lower), fraction(&upper)])
}

#[test]
fn a_second_program_in_python_proves_the_same() {
    let Some(python) = python() else {
        eprintln!("python3 is not here: the second program was not run");
        return;
    };
    let folder = folder("python");
    for arguments in [
        &["pendulum", "--at", "A=3/2"][..],
        &["pendulum", "--at", "A=3", "--order", "6"],
        &["x'' + x - x^3/6 = 0", "--at", "A=2"],
        &["x'' + x + x^2/5 = 0", "--at", "A=1/2"],
        &["x'' + x^3 = 0", "--at", "A=1"],
        &[
            "duffing",
            "--at",
            "A=1",
            "--at",
            "eps=10",
            "--method",
            "harmonic-balance",
        ],
    ] {
        let (file, document) = certified(&folder, arguments);
        let certificate = read(&document).expect("a document").read().expect("a certificate");
        let own = check(&certificate).expect("a proof").frequency;
        let [lower, upper] = by_python(&python, &file).unwrap_or_else(|| panic!("{arguments:?}"));
        // Both are true, so that they overlap; and each is as narrow.
        let radius = lindstedt::exact::from_f64(own.radius.value()).expect("a finite radius");
        assert!(
            lower <= &own.middle + &radius && &own.middle - &radius <= upper,
            "{arguments:?}"
        );
        assert!(&upper - &lower < ratio(1, 1_000_000_000).pow(3), "{arguments:?}");
        // Tampered with, it is no proof for either.
        for tamper in [
            (|document: &mut Value| document["A"] = json!("1499999/1000000")) as fn(&mut Value),
            |document| document["claim_r"] = json!("1e-60"),
            |document| document["c"][1] = json!("1"),
            |document| document["f"] = json!(["0", "2"]),
            |document| document["A_block"][1][0] = json!("0"),
        ] {
            let mut changed = document.clone();
            tamper(&mut changed);
            std::fs::write(&file, changed.to_string()).expect("the document is written");
            assert_eq!(by_python(&python, &file), None, "{arguments:?}");
            let certificate = read(&changed).expect("a document").read().expect("a certificate");
            assert!(check(&certificate).is_err(), "{arguments:?}");
        }
    }
}

#[test]
fn what_certify_writes_of_a_cycle_check_proves() {
    let folder = folder("cycle");
    let problem = format!("{}/examples/certify/van-der-pol.toml", env!("CARGO_MANIFEST_DIR"));
    let (file, document) = certified(&folder, &[&problem]);
    assert_eq!(document["ode"], "x''+g(x)*x'+h(x)=0");
    let path = file.to_str().expect("a path in text");
    let checked = run(&["check", path]);
    assert!(checked.status.success(), "{}", String::from_utf8_lossy(&checked.stderr));
    let text = String::from_utf8_lossy(&checked.stdout).into_owned();
    for expected in ["a limit cycle", "attracts, proved", "0.98472097664531065", "5.31649e-6"] {
        assert!(text.contains(expected), "{expected}: {text}");
    }
    let read: DampedCertificateDocument = serde_json::from_value(document.clone()).expect("a document");
    let certificate = read.read().expect("a certificate");
    assert_eq!(json::damped_certificate(&certificate), read);
    assert_eq!(run(&["check", path, "--tolerance", "1e-9"]).status.code(), Some(3));
    // Tampered with, it is no proof.
    for tamper in [
        (|document: &mut Value| document["g"] = json!(["-1/2", "0", "501/1000"])) as fn(&mut Value),
        |document| document["h"] = json!(["0", "1", "1/1000"]),
        |document| document["claim_r"] = json!("1e-60"),
        |document| document["p"] = json!("1"),
        |document| document["c"][1] = json!("1"),
        |document| document["s"][1] = json!("1"),
        |document| document["A_block"][1][0] = json!("0"),
        |document| document["formula"]["frequency_error"][1] = json!("1e-9"),
        |document| document["ode"] = json!("x''+f(x)=0"),
    ] {
        let mut changed = document.clone();
        tamper(&mut changed);
        std::fs::write(&file, changed.to_string()).expect("the document is written");
        assert_eq!(run(&["check", path]).status.code(), Some(1), "{changed:.80}");
    }
}

/// Whether a document, whatever is in it, is a proof.
type IsProof = fn(&Value) -> bool;

#[test]
fn hostile_certificates_are_refused() {
    let of_motion: IsProof = |changed| {
        let outcome = read(changed).ok().and_then(|document| document.read().ok());
        outcome.is_some_and(|certificate| check(&certificate).is_ok())
    };
    let of_cycle: IsProof = |changed| {
        let document = serde_json::from_value::<DampedCertificateDocument>(changed.clone()).ok();
        let outcome = document.and_then(|document| document.read().ok());
        outcome.is_some_and(|certificate| check_damped(&certificate).is_ok())
    };
    are_refused(&["pendulum", "--at", "A=1"], of_motion);
    are_refused(&["van-der-pol", "--at", "mu=1/2"], of_cycle);
}

fn are_refused(arguments: &[&str], is_proof: IsProof) {
    let folder = folder("hostile");
    let (file, document) = certified(&folder, arguments);
    let keys: Vec<String> = document.as_object().expect("an object").keys().cloned().collect();
    let mut tried = 0;
    let mut refuse = |changed: &Value| {
        tried += 1;
        is_proof(changed)
    };
    let nines = "9".repeat(100_000);
    for key in &keys {
        for value in [
            json!(null),
            json!(-1),
            json!(1e308),
            json!(1_000_000_000),
            json!(""),
            json!("-"),
            json!("1/0"),
            json!("0/0"),
            json!("1e999999999"),
            json!(nines),
            json!("x^x^x"),
            json!("1/x"),
            json!("exp(exp(exp(exp(x))))"),
            json!("((((((x"),
            json!([]),
            json!([[]]),
            json!({}),
            json!(["1", "x"]),
            json!(vec!["0"; 100_000]),
            json!(vec![vec!["0"; 500]; 500]),
        ] {
            let mut changed = document.clone();
            changed[key.as_str()] = value.clone();
            // Without a formula it proves the motion alone, with another weight it may prove the same.
            let harmless =
                [("formula", json!(null)), ("sigma_log2", json!(-1))].contains(&(key.as_str(), value.clone()));
            assert!(!refuse(&changed) || harmless, "{key}: {value:.60}");
        }
    }
    assert!(tried >= 300);
    for text in [
        "",
        "{",
        "[]",
        "\u{feff}{}",
        &"[".repeat(100_000),
        &format!("{{\"c\": {}}}", "[".repeat(1000)),
    ] {
        std::fs::write(&file, text).expect("a file");
        let checked = run(&["check", file.to_str().expect("a path in text")]);
        assert_eq!(
            checked.status.code(),
            Some(1),
            "{}",
            String::from_utf8_lossy(&checked.stderr)
        );
        assert!(String::from_utf8_lossy(&checked.stderr).contains("no certificate"));
    }
}

#[test]
fn what_is_asked_for_in_vain_is_said() {
    for (arguments, code, expected) in [
        (
            &["certify", "duffing", "--at", "A=1"][..],
            1,
            "values are needed for: eps",
        ),
        (
            &["certify", "pendulum", "--at", "B=1"],
            2,
            "`B` does not occur in the formula; it has: A",
        ),
        (
            &["certify", "x'' + x'/5 + x = 0", "--at", "A=1"],
            1,
            "`x'/5` depends on the velocity or on time",
        ),
        (
            &["certify", "rayleigh", "--at", "mu=0.1"],
            1,
            "`mu*x'^3/3` is not linear in the velocity",
        ),
        (
            &["certify", "rayleigh", "--at", "mu=0.1"],
            1,
            "of the same frequency: certify that",
        ),
        (
            &["certify", "van-der-pol", "--at", "mu=0.1", "--range", "1:2"],
            1,
            "a limit cycle has one of its own",
        ),
        (
            &["certify", "pendulum", "--at", "A=4"],
            1,
            "no periodic motion about x = 0",
        ),
        (
            &["certify", "pendulum", "--at", "A=1", "--omega-only"],
            2,
            "--omega-only leaves out",
        ),
        (
            &["certify", "pendulum", "--at", "A=1", "--plot", "proof.svg"],
            1,
            "a proof has no picture",
        ),
        (&["certify", "pendulum", "--at", "A=1", "--format", "csv"], 2, "table"),
        (
            &["certify", "pendulum", "--at", "A=1", "--range", "2:1"],
            2,
            "the smaller one first",
        ),
        (
            &[
                "certify", "pendulum", "--at", "A=1", "--range", "1:2", "--format", "json",
            ],
            2,
            "--range is not in a certificate",
        ),
        (&["check", "no-such-file.json"], 1, "cannot read no-such-file.json"),
        (&["certify", "pendulum", "--at", "A=3/2", "--tolerance", "1e-4"], 3, ""),
    ] {
        let output = run(arguments);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {errors}");
        assert!(errors.contains(expected), "{arguments:?}: {errors}");
    }
}

/// The same impact from the other side is proved to be the same; what is no impact of equation (9) is refused.
#[test]
fn an_impact_is_proved_from_either_side() {
    let numbers = |arguments: &[&str]| {
        let output = run(&[&["impact", "--certify"], arguments].concat());
        let text = String::from_utf8(output.stdout).expect("text");
        let (_, proved) = text.split_once("\nProved\n").expect("a proof");
        let (proved, _) = proved.split_once("\n\n").expect("more");
        proved.to_owned()
    };
    let right = numbers(&["--at", "gamma=1e6", "--at", "xc=0.323"]);
    assert_eq!(numbers(&["--at", "gamma=1e6", "--at", "xc=-0.323", "--left"]), right);
    assert!(
        right.contains("0.0121060270598") && right.contains("2.06440760858"),
        "{right}"
    );
    for (arguments, code, expected) in [
        (["--certify", "--compare"].as_slice(), 2, "cannot be used with"),
        (&["--certify", "--plot", "proof.svg"], 2, "draws no picture"),
        (&["--certify", "--format", "json"], 2, "has no JSON"),
        (&["--certify", "--format", "csv"], 2, "table"),
        (
            &["--certify", "examples/impact-duffing.toml"],
            2,
            "an equation of its own",
        ),
        (&["--certify", "examples/impact-restitution.toml"], 2, "loses energy"),
        (&["--certify", "--at", "A=0.2"], 1, "within reach"),
        (&["--certify", "--order", "2", "--tolerance", "1e-4"], 3, ""),
        (&["--certify", "--tolerance", "0.001"], 0, ""),
    ] {
        let output = run(&[&["impact"], arguments].concat());
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {errors}");
        assert!(errors.contains(expected), "{arguments:?}: {errors}");
    }
}
