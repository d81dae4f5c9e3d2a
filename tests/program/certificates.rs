//! Certificates as files: what `certify` writes `check` proves, a second program in another
//! language proves, and what has been tampered with neither.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use lindstedt::certificate::{
    Enclosure, check, check_coupled, check_damped, check_mode, check_orbits,
};
use lindstedt::exact::{Rational, from_f64, ratio};
use lindstedt::export::json::{
    self, CertificateDocument, CoupledCertificateDocument, DampedCertificateDocument,
    ModeCertificateDocument, OrbitCertificateDocument,
};
use serde_json::{Value, json};

use super::documents::python;

fn run(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lindstedt"));
    command.args(arguments).args(["--timeout", "3600"]).output().expect("the program starts")
}

fn folder(name: &str) -> PathBuf {
    let folder =
        std::env::temp_dir().join(format!("lindstedt-certificates-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// A certificate, and its file.
fn certified(folder: &Path, arguments: &[&str]) -> (PathBuf, Value) {
    let file = folder.join("certificate.json");
    let written =
        run(&[&["certify"], arguments, &["--output", file.to_str().expect("a path in text")]]
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
fn driven_coordinates_are_proved_and_proved_again() {
    let folder = folder("driven-coordinates");
    let pair = "x'' + x'/10 + 2*x - y + x^3/2 = 3*cos(Omega*t)/10; y'' + y'/10 + 2*y - x = 0";
    let skew = "2*x'' + x'/5 + (x*y' + y*x')/20 + 2*x - y + x^2/9 = cos(t)/4 + sin(2*t)/20; \
                y'' + y'/5 + 2*sin(y) - x = 0";
    for question in [[pair, "--at", "Omega=11/10"].as_slice(), &[skew]] {
        let (file, document) = certified(&folder, question);
        let said = run(&[&["certify"], question].concat());
        let said = String::from_utf8_lossy(&said.stdout).into_owned();
        let path = file.to_str().expect("a path in text");
        let checked = run(&["check", path]);
        assert!(checked.status.success(), "{question:?}: {checked:?}");
        // Nothing is said but what the file proves, and which motion was chosen at which values.
        let again = String::from_utf8_lossy(&checked.stdout).into_owned();
        let words = |text: &str| -> Vec<String> {
            let lines = text.lines().map(str::trim);
            let own = lines.filter(|line| !line.starts_with("at ") && !line.starts_with("chosen "));
            own.map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect()
        };
        assert_eq!(words(&said), words(&again), "{question:?}");
        assert!(said.contains("chosen") && said.contains("amplitude") && said.contains("of y: "));
        let read: CoupledCertificateDocument =
            serde_json::from_value(document.clone()).expect("a document");
        let certificate = read.read().expect("a certificate");
        assert_eq!(json::coupled_certificate(&certificate), read, "{question:?}");
        assert_eq!(check_coupled(&certificate).expect("a proof").amplitudes.len(), 2);
        let tampers: [Tamper; 13] = [
            |document| document["claim_r"] = json!("1e-60"),
            |document| document["c"][1][1] = json!("1"),
            |document| document["s"][0][1] = json!("1"),
            |document| document["inverse"][1][1] = json!("1000000000000000000000000000000"),
            |document| document["odd"] = json!("yes"),
            |document| document["ode"] = json!("q''+f(q)=0"),
            |document| document["more"] = json!("1"),
            |document| document["h"][1] = json!("y"),
            |document| document["g"][1][0] = json!("x^2"),
            |document| document["coordinates"] = json!(["c", "y"]),
            |document| document["coordinates"] = json!(["x", "x"]),
            |document| document["drive"]["driving_frequency"] = json!("4/3"),
            |document| document["bits"] = json!(225),
        ];
        for (place, tamper) in tampers.into_iter().enumerate() {
            let mut changed = document.clone();
            tamper(&mut changed);
            std::fs::write(&file, changed.to_string()).expect("a file");
            let checked = run(&["check", path]);
            assert_eq!(checked.status.code(), Some(1), "{question:?}: {place}");
        }
    }
    for (arguments, code, expected) in [
        ([pair, "--at", "Omega=1", "--range", "1:2"].as_slice(), 2, "--range: of several driven"),
        (&[pair, "--at", "Omega=1", "--mode", "1"], 2, "--mode: of several driven"),
        (&[pair, "--at", "Omega=1", "--cycle", "1"], 2, "--cycle: of several driven"),
        (&[pair], 1, "add --at Omega=..."),
        (&[pair, "--at", "Omega=pi/3"], 1, "the driving frequency pi/3 is no fraction"),
        (&[pair, "--at", "Omega=1,k=1"], 1, "there is no parameter k"),
        (&["x'' + x'^2 + x = cos(t); y'' + y' + y = x"], 1, "has `x'^2`"),
    ] {
        let refused = run(&[&["certify"], arguments].concat());
        assert_eq!(refused.status.code(), Some(code), "{arguments:?}: {refused:?}");
        let said = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert!(said.contains(expected), "{arguments:?}: {said}");
    }
}

/// Two oscillators that excite themselves, with two frequencies.
const COUPLED_CYCLE: &str = "x'' - (1 - x^2)*x'/10 + x + (x - y)/2 = 0; \
                             y'' - (1 - y^2)*y'/10 + 6*y/5 + (y - x)/2 = 0";

#[test]
fn limit_cycles_of_coordinates_are_proved_and_proved_again() {
    let folder = folder("coupled-cycles");
    let example = format!("{}/examples/certify/coupled-cycle.toml", env!("CARGO_MANIFEST_DIR"));
    let masses = "2*x'' + y'' - (1 - x^2)*x'/5 + (x*y' + y*x')/20 + 2*sin(x) = 0; \
                  x'' + 3*y'' + y'/10 + 4*y + y^3/4 - x/2 = 0";
    let mut frequencies = vec![];
    for question in [&[example.as_str()][..], &[COUPLED_CYCLE, "--at", "x=1,y=-1"], &[masses]] {
        let (file, document) = certified(&folder, question);
        let said = run(&[&["certify"], question].concat());
        let said = String::from_utf8_lossy(&said.stdout).into_owned();
        let path = file.to_str().expect("a path in text");
        let checked = run(&["check", path]);
        assert!(checked.status.success(), "{question:?}: {checked:?}");
        let again = String::from_utf8_lossy(&checked.stdout).into_owned();
        for name in ["motion", "omega", "amplitude", "stability", "r ", "block"] {
            assert_eq!(fact(&said, name), fact(&again, name), "{question:?}");
        }
        assert!(fact(&said, "motion").starts_with("a limit cycle: (x, y)(t)"), "{said}");
        assert!(fact(&said, "stability").starts_with("attracts, proved"), "{said}");
        let read: CoupledCertificateDocument =
            serde_json::from_value(document.clone()).expect("a document");
        let certificate = read.read().expect("a certificate");
        assert_eq!(json::coupled_certificate(&certificate), read, "{question:?}");
        let proved = check_coupled(&certificate).expect("a proof");
        frequencies.push(lindstedt::exact::rational::to_f64(&proved.frequency.middle));
        assert_eq!(document["ode"], json!("q''+g(q)*q'+h(q)=0"));
        assert_eq!(document["stability"]["attracts"], json!(true));
        let tampers: [Tamper; 13] = [
            |document| document["claim_r"] = json!("1e-60"),
            |document| document["c"][1][1] = json!("1"),
            |document| document["p"] = json!("1"),
            |document| document["p"] = Value::Null,
            |document| document["odd"] = json!("yes"),
            |document| document["ode"] = json!("q''+g(q)*q'+h(q,c,s)=0"),
            |document| document["h"][1] = json!("y"),
            |document| document["phase_of"] = json!("z"),
            |document| document["drive"] = json!({"driving_frequency": "1", "n": 1, "harmonic": 1}),
            |document| document["stability"]["attracts"] = json!(false),
            |document| document["stability"]["largest_multiplier"][1] = json!("0.5"),
            |document| document["stability"]["largest_multiplier"][0] = json!("0.95"),
            |document| document["stability"]["more"] = json!("1"),
        ];
        for (place, tamper) in tampers.into_iter().enumerate() {
            let mut changed = document.clone();
            tamper(&mut changed);
            std::fs::write(&file, changed.to_string()).expect("a file");
            let checked = run(&["check", path]);
            assert_eq!(checked.status.code(), Some(1), "{question:?}: {place}");
        }
        // A file that claims nothing of the stability is one too, and it is proved all the same.
        let mut silent = document.clone();
        silent.as_object_mut().expect("an object").remove("stability");
        std::fs::write(&file, silent.to_string()).expect("a file");
        let checked = run(&["check", path]);
        let said = String::from_utf8_lossy(&checked.stdout).into_owned();
        assert!(fact(&said, "stability").starts_with("attracts, proved"), "{said}");
    }
    // In phase and in opposition.
    assert!(frequencies[0] < 1.05 && frequencies[1] > 1.4, "{frequencies:?}");
    for (arguments, code, expected) in [
        ([COUPLED_CYCLE, "--range", "1:2"].as_slice(), 2, "--range: of several"),
        (&[COUPLED_CYCLE, "--order", "2"], 2, "--order: of several"),
        (&["x'' + x'/10 + x = y; y'' + y'/10 + 2*y = x"], 1, "comes to rest"),
        (&["x'' - x'/10 + x = y; y'' + y'/20 + 2*y = x"], 1, "runs away"),
        (
            &["x'' - (1 - x^2 - y^2)*x'/10 + x = 0; y'' + y'/10 + 2*y = x"],
            1,
            "is not the rate of a function",
        ),
        (&["x'' + x'^3 - x'/9 + x = y; y'' + y'/10 + 2*y = x"], 1, "`x'^3`"),
    ] {
        let refused = run(&[&["certify"], arguments].concat());
        assert_eq!(refused.status.code(), Some(code), "{arguments:?}: {refused:?}");
        let said = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert!(said.contains(expected), "{arguments:?}: {said}");
    }
    std::fs::remove_dir_all(&folder).expect("an own folder");
}

#[test]
fn the_stability_is_a_key_of_the_document() {
    let folder = folder("stability-key");
    let driven = "x'' + x'/5 + x + x^3/4 - F*cos(Omega*t) = 0";
    let unstable = "x'' + x'/10 + 2*x + x^3 = cos(t); y'' - y'/10 + y + x*y = 0";
    let open = "x'' + x'/10 + 2*x = cos(t); y'' + 3*y + x^2*y/9 = 0";
    let number =
        |value: &Value| -> f64 { value.as_str().expect("text").parse().expect("a number") };
    // exp(-pi/5/Omega), of the cycle exp of 2 pi p times minus the mean of the damping.
    let modulus = (-std::f64::consts::PI / 5.0 / 1.25).exp();
    let questions: [(&[&str], Value, Option<f64>); 4] = [
        (&[driven, "--at", "F=1/2", "--at", "Omega=1.25"], json!(true), Some(modulus)),
        (&["van-der-pol", "--at", "mu=1/2"], json!(true), Some(0.039_176_920)),
        (&[unstable], json!(false), None),
        (&[open], Value::Null, None),
    ];
    for (question, attracts, modulus) in questions {
        let (file, document) = certified(&folder, question);
        assert_eq!(document["stability"]["attracts"], attracts, "{question:?}");
        let ends = &document["stability"]["largest_multiplier"];
        let [lower, upper] = [0, 1].map(|end| number(&ends[end]));
        assert!(lower <= upper && upper < 2.0 * lower, "{question:?}");
        if let Some(modulus) = modulus {
            assert!(lower - 1e-9 < modulus && modulus < upper + 1e-9, "{question:?}: {ends}");
        }
        // What is not proved is not claimed.
        for other in [json!(true), json!(false)] {
            let mut changed = document.clone();
            changed["stability"]["attracts"] = other.clone();
            std::fs::write(&file, changed.to_string()).expect("a file");
            let checked = run(&["check", file.to_str().expect("a path in text")]);
            let code = if other == attracts { 0 } else { 1 };
            assert_eq!(checked.status.code(), Some(code), "{question:?}: {other}");
        }
    }
    std::fs::remove_dir_all(&folder).expect("an own folder");
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
        assert!(said.contains("pass (amplitude within 1 %, proved)"), "{example}: {said}");
        let checked = run(&["check", file.to_str().expect("a path in text")]);
        assert!(checked.status.success(), "{example}");
        let proof = |text: &str| {
            text.lines()
                .skip_while(|line| !line.starts_with("The proof"))
                .map(str::to_owned)
                .collect::<Vec<_>>()
        };
        assert_eq!(proof(&said), proof(&String::from_utf8_lossy(&checked.stdout)), "{example}");
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

/// The lines of a fact.
fn fact(said: &str, name: &str) -> String {
    let line = said.lines().find(|line| line.trim_start().starts_with(name));
    line.unwrap_or_else(|| panic!("{name}: {said}")).trim_start()[name.len()..].trim().to_owned()
}

#[test]
fn the_stability_of_driven_motions_is_proved() {
    let driven = "x'' + x'/5 + x + x^3/4 - F*cos(Omega*t) = 0";
    let stability = |arguments: &[&str]| {
        let said = run(&[arguments, &["--format", "latex"]].concat());
        fact(&String::from_utf8_lossy(&said.stdout), "% stability:")
    };
    // On the upper branch of the resonance curve both multipliers have the modulus
    // exp(-pi/5/Omega).
    for omega in [1.0_f64, 1.25] {
        let at = format!("Omega={omega}");
        let said = stability(&["certify", driven, "--at", "F=1/2", "--at", &at]);
        let words = "attracts, proved: the larger Floquet multiplier has the modulus ";
        let number = said.strip_prefix(words).unwrap_or_else(|| panic!("{said}"));
        let (number, radius) = number.split_once(" +- ").expect("a radius");
        let [number, radius]: [f64; 2] =
            [number, radius].map(|text| text.parse().expect("a number"));
        let expected = (-std::f64::consts::PI / 5.0 / omega).exp();
        assert!((number - expected).abs() < 1e-14, "{number}, {expected}");
        assert!(radius < 1e-12, "{radius}");
    }
    // `check` proves it again from the numbers alone.
    let folder = folder("stability");
    let problem = format!("{}/examples/subharmonic.toml", env!("CARGO_MANIFEST_DIR"));
    let (file, _) = certified(&folder, &[&problem]);
    let said =
        |arguments: &[&str]| fact(&String::from_utf8_lossy(&run(arguments).stdout), "stability");
    let proved = said(&["certify", &problem]);
    assert!(proved.starts_with("attracts, proved"), "{proved}");
    assert_eq!(proved, said(&["check", file.to_str().expect("a path in text")]));
    std::fs::remove_dir_all(&folder).expect("an own folder");
}

#[test]
fn normal_modes_are_proved_and_proved_again() {
    let folder = folder("modes");
    let pair = "x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0";
    let masses = "2*x'' + y'' + 2*x - y + x^2/2 = 0; x'' + 3*y'' + 2*y - x + k*y^3 = 0";
    let letters = "a'' + 2*a - A + a^3/2 = 0; A'' + omega*A - a = 0";
    let questions: [&[&str]; 6] = [
        &[pair, "--at", "a=4/5"],
        &[pair, "--at", "a=4/5", "--mode", "2", "--order", "6"],
        &[pair, "--at", "A=1", "--amplitude", "initial"],
        &[pair, "--at", "a=3", "--no-formula"],
        &[masses, "--at", "a=1/4", "--at", "k=1/10", "--mode", "2"],
        &[letters, "--at", "r=4/5", "--at", "omega=2"],
    ];
    let mut frequencies = vec![];
    for question in questions {
        let (file, document) = certified(&folder, question);
        let said = run(&[&["certify"], question].concat());
        let said = String::from_utf8_lossy(&said.stdout).into_owned();
        let path = file.to_str().expect("a path in text");
        let checked = run(&["check", path]);
        assert!(checked.status.success(), "{question:?}: {checked:?}");
        let proof = |text: &str| -> Vec<String> {
            let lines = text.lines().skip_while(|line| !line.starts_with("The proof"));
            lines.map(str::to_owned).collect()
        };
        let again = String::from_utf8_lossy(&checked.stdout).into_owned();
        assert_eq!(proof(&said), proof(&again), "{question:?}");
        for name in
            ["relative error", "largest deviation at one phase", "deviation in time", "verdict"]
        {
            if document["formula"] != Value::Null {
                assert_eq!(fact(&said, name), fact(&again, name), "{question:?}");
            }
        }
        frequencies.push(by_library(&document).expect("a proof").middle);
        let read: ModeCertificateDocument =
            serde_json::from_value(document.clone()).expect("a document");
        let certificate = read.read().expect("a certificate");
        assert_eq!(json::mode_certificate(&certificate), read, "{question:?}");
        let tampers: [Tamper; 12] = [
            |document| document["claim_r"] = json!("1e-60"),
            |document| document["c"][1][1] = json!("1"),
            without_first_column,
            |document| document["odd"] = json!("yes"),
            |document| document["ode"] = json!("x''+f(x)=0"),
            |document| document["more"] = json!("1"),
            |document| document["f"][1] = json!("y"),
            |document| document["coordinates"] = json!(["t", "y"]),
            |document| document["coordinates"] = json!(["x", "x"]),
            |document| document["amplitude"]["value"] = json!("4/3"),
            |document| document["amplitude"]["start_of"] = json!("z"),
            |document| document["bits"] = json!(225),
        ];
        for (place, tamper) in tampers.into_iter().enumerate() {
            let mut changed = document.clone();
            tamper(&mut changed);
            std::fs::write(&file, changed.to_string()).expect("a file");
            let checked = run(&["check", path]);
            assert_eq!(checked.status.code(), Some(1), "{question:?}: {place}");
        }
    }
    // The letters of an equation change nothing.
    assert_eq!(frequencies[0], frequencies[5]);
    for (arguments, code, expected) in [
        ([pair, "--at", "a=1", "--range", "1:2"].as_slice(), 2, "--range: it is of one coordinate"),
        (&[pair, "--at", "a=1", "--mode", "3"], 1, "there is no mode 3"),
        (&[pair], 1, "--at a=VALUE"),
        (&[pair, "--at", "a=pi/3"], 1, "a = pi/3 is no fraction"),
        (&[pair, "--at", "a=1", "--cycle", "1"], 2, "--cycle: it is of one coordinate"),
        (&["pendulum", "--at", "A=1", "--mode", "1"], 2, "--mode: one coordinate has one mode"),
        (&[pair, "--at", "a=2", "--tolerance", "0.01"], 3, ""),
        (&["x'' + x = 0; y'' + 9*y = 0", "--at", "a=1"], 1, "is not below 1"),
        (
            &["x'' + x'/9 + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0", "--at", "a=1"],
            1,
            "`x'/9` is odd in the velocities",
        ),
        (
            &["(1 + x^2)*x'' + x*x'^2 + 2*x - y = 0; y'' + 4*y - x = 0", "--at", "a=1/2"],
            1,
            "depends on velocities",
        ),
    ] {
        let output = run(&[&["certify"], arguments].concat());
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {errors}");
        assert!(errors.contains(expected), "{arguments:?}: {errors}");
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
            let lines = text.lines().filter(|line| {
                line.starts_with("  ") && !line.contains("x") && !line.contains("u")
            });
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
        let strict =
            run(&["check", file.to_str().expect("a path in text"), "--tolerance", "1e-12"]);
        assert_eq!(strict.status.code(), Some(3), "{example}");
    }
}

/// Laws on ranges are proved by both programs, and false claims by neither.
#[test]
fn both_programs_prove_laws_on_ranges() {
    let Some(python) = python() else {
        eprintln!("python3 is not here: the second program was not run");
        return;
    };
    let folder = folder("laws");
    let program = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/check_certificate.py");
    let contact = "x'' + k*x^(3/2)*(1 + lambda*x') = 0";
    for (equation, range, longest, quantity) in [
        ("pendulum", "A=0:2.8", "8", "omega"),
        ("duffing", "eps*A^2=0:inf", "9", "omega"),
        ("x'' + x + x^2/4 = 0", "A=0:1", "6", "T"),
        (contact, "e=0.3:1", "7", "contact-time"),
    ] {
        let quantity = ["--quantity", quantity];
        let question = ["shortest", equation, "--range", range, "--longest", longest];
        let question = [&question[..], &quantity].concat();
        let output = run(&[&question[..], &["--certificate", "--format", "json"]].concat());
        let document: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        let file = folder.join("law.json");
        let proved = |document: &Value| {
            std::fs::write(&file, document.to_string()).expect("a file");
            let own = run(&["check", file.to_str().expect("a path in text")]).status.success();
            let second = Command::new(&python).args(["-I", "-S", program]).arg(&file).output();
            let second = second.expect("Python starts");
            let errors = String::from_utf8_lossy(&second.stderr);
            assert!(second.status.success() || errors.starts_with("not proved: "), "{errors}");
            [own, second.status.success()]
        };
        assert_eq!(proved(&document), [true, true], "{equation}");
        let claims = document["error"].as_array().expect("two numbers").clone();
        for (which, value) in [(1, claims[0].clone()), (0, claims[1].clone())] {
            let mut changed = document.clone();
            changed["error"][which] = value;
            assert_eq!(proved(&changed), [false, false], "{equation}");
        }
    }
}

/// Laws of normal modes on a range of their amplitude are proved by both programs, and by neither with a smaller
/// error, another branch, a longer range or another law.
#[test]
fn both_programs_prove_laws_of_normal_modes() {
    let Some(python) = python() else {
        eprintln!("python3 is not here: the second program was not run");
        return;
    };
    let folder = folder("laws-of-modes");
    let cubic = "x'' + 2*x - y + x^3 = 0; y'' + 2*y - x + y^3 = 0";
    let chain = "x'' + 2*x - y + x^3 + (x - y)^3 = 0; \
                 y'' + 2*y - x - z + (y - x)^3 + (y - z)^3 = 0; \
                 z'' + 2*z - y + z^3 + (z - y)^3 = 0";
    let pendulums = "x'' + sin(x) + (x - y)/3 = 0; y'' + 2*sin(y) + (y - x)/3 = 0";
    let uneven = "x'' + 2*x - y + x^2/5 + x^3/2 = 0; 2*y'' + 3*y - x + y^2/7 = 0";
    let questions = [
        (cubic, "1", "a=0:1", "first-harmonic"),
        (cubic, "2", "a=0:1", "first-harmonic"),
        (chain, "1", "a=0:1", "first-harmonic"),
        (pendulums, "1", "A=1/2:1", "initial"),
        (uneven, "2", "a=0:1/5", "first-harmonic"),
    ];
    let documents = questions.map(|(equations, mode, range, amplitude)| {
        let question = ["shortest", equations, "--mode", mode, "--range", range];
        let more = ["--amplitude", amplitude, "--longest", "8", "--certificate"];
        let output = run(&[&question[..], &more, &["--format", "json"]].concat());
        serde_json::from_slice::<Value>(&output.stdout).expect("JSON")
    });
    let file = folder.join("law.json");
    let reasons = |document: &Value| {
        std::fs::write(&file, document.to_string()).expect("a file");
        let own = run(&["check", file.to_str().expect("a path in text")]);
        let program = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/check_certificate.py");
        let second = Command::new(&python).args(["-I", "-S", program]).arg(&file).output();
        let second = second.expect("Python starts");
        let errors = String::from_utf8_lossy(&second.stderr).into_owned();
        assert!(second.status.success() || errors.starts_with("not proved: "), "{errors}");
        [!own.status.success(), !second.status.success()].map(|fails| fails.then(|| errors.clone()))
    };
    for (document, question) in documents.iter().zip(questions) {
        assert_eq!(reasons(document), [None, None], "{question:?}");
    }
    let refused = |document: &Value, change: &dyn Fn(&mut Value), reason: &str| {
        let mut changed = document.clone();
        change(&mut changed);
        let [own, second] = reasons(&changed);
        assert!(own.is_some(), "`check` proves another one: {reason}");
        let second = second.unwrap_or_default();
        assert!(second.contains(reason), "{second} instead of {reason}");
    };
    let [first, second, ..] = &documents;
    for document in [first, second] {
        let [lower, upper] = [0, 1].map(|which| document["error"][which].clone());
        refused(document, &|law| law["error"][1] = lower.clone(), "the error is above its bound");
        refused(document, &|law| law["error"][0] = upper.clone(), "not as large as claimed");
        refused(document, &|law| law["to"] = json!("11/10"), "error");
        let more = format!("{} + a^8/50", document["law"].as_str().expect("a law"));
        refused(document, &|law| law["law"] = json!(more), "error");
        // A law that is off at one place alone.
        let hidden =
            format!("{} + exp(-(5*(a - 1/3))^2)/10", document["law"].as_str().expect("a law"));
        refused(document, &|law| law["law"] = json!(hidden), "error");
        let moved = "the motion at the lower end";
        refused(document, &|law| law["mode"]["mu"] = json!("0.9999"), moved);
        refused(document, &|law| law["mode"]["c"][1][1] = json!("0.9999"), moved);
        refused(document, &|law| law["mode"]["f"][0] = json!("2*x - y + 101*x^3/100"), "error");
        refused(document, &|law| law["mode"]["f"][0] = json!("2*x - y + 1/9"), "not zero");
        refused(document, &|law| law["mode"]["start_of"] = json!("x"), "one condition");
    }
    // The other branch with the law of the one.
    refused(first, &|law| law["mode"] = second["mode"].clone(), "error");
    // Without coupling the motions are a family.
    refused(first, &|law| law["mode"]["f"] = json!(["x + x^3", "y + y^3"]), "no single motion");
    std::fs::remove_dir_all(&folder).expect("an own folder");
}

/// Impact orbits are proved by both programs to the same digits, and by neither with another number.
#[test]
fn both_programs_prove_impact_orbits() {
    let folder = folder("orbits");
    let file = folder.join("orbits.json");
    let path = file.to_str().expect("a path in text");
    let python = python();
    let second = |document: &Value| {
        std::fs::write(&file, document.to_string()).expect("a file");
        let program = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/check_certificate.py");
        let run = |python| Command::new(python).args(["-I", "-S", program]).arg(&file).output();
        python.as_ref().map(|python| run(python).expect("Python starts"))
    };
    for question in [
        ["examples/orbits/two-stops.toml", "--periods", "1", "--impacts", "1"],
        ["examples/orbits/doubled.toml", "--periods", "2", "--impacts", "2"],
        ["examples/orbits/bouncing-ball.toml", "--periods", "1", "--impacts", "1"],
    ] {
        let question = [&["orbits"][..], &question, &["--certify"]].concat();
        let written = run(&[&question[..], &["--output", path]].concat());
        assert!(written.status.success(), "{written:?}");
        let text = std::fs::read_to_string(&file).expect("a file");
        let document: Value = serde_json::from_str(&text).expect("JSON");
        let read: OrbitCertificateDocument = serde_json::from_str(&text).expect("a certificate");
        let certificate = read.read().expect("a certificate");
        assert_eq!(json::orbit_certificate(&certificate), read);
        // `check` says what is proved as `orbits` did.
        let [said, checked] = [&question[..], &["check", path]].map(|own| run(own).stdout);
        let proved = |text: &[u8]| {
            let text = String::from_utf8_lossy(text);
            let lines = text.lines().filter(|line| line.contains("+-"));
            lines.map(str::to_owned).collect::<Vec<_>>()
        };
        assert_eq!(proved(&said), proved(&checked));
        assert!(!proved(&checked).is_empty());

        let enclosed = check_orbits(&certificate).expect("a proof");
        if let Some(output) = second(&document) {
            let errors = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{errors}");
            let found: Value = serde_json::from_slice(&output.stdout).expect("JSON");
            for (orbit, own) in enclosed.iter().zip(found["orbits"].as_array().expect("orbits")) {
                for (impact, ends) in
                    orbit.impacts.iter().zip(own["speeds"].as_array().expect("ends"))
                {
                    let end = |place: usize| {
                        let text = ends[place].as_str().expect("text").replace('.', "");
                        text.parse::<Rational>().expect("digits") / ratio(10, 1).pow(36)
                    };
                    // Each encloses the same number.
                    let radius = from_f64(impact.speed.radius.value()).expect("a radius");
                    assert!(end(0) <= &impact.speed.middle + &radius);
                    assert!(end(1) >= &impact.speed.middle - &radius);
                    assert!(end(1) - end(0) < ratio(1, 1) / ratio(10, 1).pow(33));
                }
            }
        }
        let changes: [Tamper; 6] = [
            |own| own["orbits"][0]["speed_radius"] = json!("1e-60"),
            |own| own["orbits"][0]["impacts"][0]["phase"] = json!("12345678901234567890"),
            |own| own["walls"][0]["restitution"] = json!("2/3"),
            |own| own["load"]["cosine"] = json!("1/1000000000"),
            |own| own["driving_frequency"] = json!("0"),
            |own| own["orbits"][0]["isolated_in_phase"] = json!("1000"),
        ];
        // One document is enough for what no program may prove.
        let is_first = question.contains(&"examples/orbits/two-stops.toml");
        for (index, change) in changes.into_iter().enumerate().filter(|_| is_first) {
            let mut changed = document.clone();
            change(&mut changed);
            std::fs::write(&file, changed.to_string()).expect("a file");
            assert!(!run(&["check", path]).status.success(), "{index}");
            if let Some(output) = second(&changed) {
                let errors = String::from_utf8_lossy(&output.stderr);
                assert!(errors.starts_with("not proved: "), "{index}: {errors}");
            }
        }
    }
    std::fs::remove_dir_all(&folder).expect("an own folder");
}

/// omega, of a driven motion the amplitude, from below and from above, by the second program;
/// `None` where it does not prove the certificate with all its claims.
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
    let proved: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let of_first = proved.get("amplitudes").and_then(|all| all.get(0));
    let ends = proved.get("omega").or(proved.get("amplitude")).or(of_first).expect("two ends");
    let fraction = |place: usize| {
        let text = ends[place].as_str().expect("text");
        let digits: Rational = text.replace('.', "").parse().expect("digits");
        digits / ratio(10, 1).pow(36)
    };
    Some([fraction(0), fraction(1)])
}

/// The numbers that the library proves of a document of any kind: omega, or the amplitude.
fn by_library(document: &Value) -> Result<Enclosure, String> {
    let unread = |error: serde_json::Error| error.to_string();
    let proved = match document["ode"].as_str() {
        Some("x''+f(x)=0") => {
            let certificate =
                read(document).map_err(unread)?.read().map_err(|error| error.to_string())?;
            check(&certificate)
        }
        Some("q''+f(q)=0") => {
            let document: ModeCertificateDocument =
                serde_json::from_value(document.clone()).map_err(unread)?;
            check_mode(&document.read().map_err(|error| error.to_string())?)
        }
        Some(json::EQUATIONS_OF_CYCLES | json::EQUATIONS_WITH_DRIVE) => {
            let document: CoupledCertificateDocument =
                serde_json::from_value(document.clone()).map_err(unread)?;
            let certificate = document.read().map_err(|error| error.to_string())?;
            check_coupled(&certificate).map(|mut proved| {
                // With a drive what the second program encloses is the amplitude of the first
                // coordinate.
                proved.amplitude = certificate.drive.map(|_| proved.amplitudes.swap_remove(0));
                proved
            })
        }
        _ => {
            let document: DampedCertificateDocument =
                serde_json::from_value(document.clone()).map_err(unread)?;
            check_damped(&document.read().map_err(|error| error.to_string())?)
        }
    };
    let proved = proved.map_err(|error| error.to_string())?;
    Ok(proved.amplitude.unwrap_or(proved.frequency))
}

/// A change of a document by which it is no proof any more.
type Tamper = fn(&mut Value);

/// Sets the first column of the inverse to zero but for its first entry: that of a constant may be
/// zero already.
fn without_first_column(document: &mut Value) {
    for row in [1, 2] {
        document["inverse"][row][0] = json!("0");
    }
}

#[test]
fn a_second_program_in_python_proves_the_same() {
    let of_all: [Tamper; 7] = [
        |document| document["claim_r"] = json!("1e-60"),
        |document| document["c"][1] = json!("1"),
        without_first_column,
        |document| document["odd"] = json!("yes"),
        |document| document["formula"]["phase_error"][0] = json!("1"),
        |document| document["formula"]["phase_error"][1] = json!("1e-12"),
        |document| document["more"] = json!("1"),
    ];
    let of_several: [Tamper; 10] = [
        |document| document["claim_r"] = json!("1e-60"),
        |document| document["c"][1][1] = json!("1"),
        |document| document["s"][1][1] = json!("1"),
        |document| document["odd"] = json!(true),
        |document| document["more"] = json!("1"),
        |document| document["h"][1] = json!("6*y/5"),
        |document| document["g"][0][1] = json!("x"),
        |document| document["g"][1][1] = json!("-1/10 + y^2/10 + x^2/1000"),
        |document| document["coordinates"][1] = json!("x"),
        |document| document["formula"] = json!({}),
    ];
    let of_several_cycles: [Tamper; 6] = [
        |document| document["phase_of"] = json!("y"),
        |document| document["phase_of"] = json!("z"),
        |document| document["p"] = json!("1"),
        |document| document["drive"] = json!({"driving_frequency": "1", "n": 1, "harmonic": 1}),
        |document| document["s"][0][1] = json!("1"),
        |document| document["sigma_log2"] = json!(-60),
    ];
    let of_several_driven: [Tamper; 4] = [
        |document| document["drive"]["driving_frequency"] = json!("801/1000"),
        |document| document["drive"]["n"] = json!(2),
        |document| document["coordinates"][1] = json!("c"),
        |document| document["p"] = json!("1"),
    ];
    let of_modes: [Tamper; 8] = [
        |document| document["amplitude"]["value"] = json!("799999999/1000000000"),
        |document| document["amplitude"]["first_harmonic_of"][0] = json!("3/4"),
        |document| document["amplitude"]["start_of"] = json!("x"),
        |document| document["f"][1] = json!("2*y - x + x/1000000"),
        |document| document["c"][1][3] = json!("1"),
        |document| document["formula"]["frequency_error"][1] = json!("1e-12"),
        |document| document["formula"]["drift"][0] = json!("1"),
        |document| document["formula"]["c"][1][1] = json!("1"),
    ];
    let of_motions: [Tamper; 5] = [
        |document| document["initial_displacement"] = json!("1499999/1000000"),
        |document| document["f"] = json!(["0", "2"]),
        |document| document["formula"]["frequency_error"][1] = json!("1e-12"),
        |document| document["formula"]["drift"][0] = json!("1"),
        |document| {
            document["formula"]["omega"] =
                json!(format!("-{}", document["formula"]["omega"].as_str().unwrap_or("1")))
        },
    ];
    let of_cycles: [Tamper; 6] = [
        |document| document["g"] = json!(["-1/2", "0", "501/1000"]),
        |document| document["p"] = json!("1"),
        |document| document["s"][1] = json!("1"),
        half_a_period_later,
        |document| document["formula"]["frequency_error"][0] = json!("1e-2"),
        |document| document["formula"]["drift"][1] = json!("1e-12"),
    ];
    let of_driven: [Tamper; 5] = [
        |document| document["drive"]["driving_frequency"] = json!("1001/1000"),
        |document| document["drive"]["n"] = json!(7),
        |document| document["sigma_log2"] = json!(1),
        |document| document["h"] = json!("x + x^3/9 - c"),
        |document| document["formula"]["amplitude_error"][1] = json!("1e-12"),
    ];
    let examples = concat!(env!("CARGO_MANIFEST_DIR"), "/examples");
    let proved = |name: &str, questions: &[&[&str]], common: &[Tamper], tampers: &[Tamper]| {
        let Some(python) = python() else {
            eprintln!("python3 is not here: the second program was not run");
            return;
        };
        let folder = folder(name);
        for (index, arguments) in questions.iter().enumerate() {
            let (file, document) = certified(&folder, arguments);
            let own =
                by_library(&document).unwrap_or_else(|error| panic!("{arguments:?}: {error}"));
            let [lower, upper] =
                by_python(&python, &file).unwrap_or_else(|| panic!("{arguments:?}"));
            // Both are true, so that they overlap; and each is as narrow.
            let radius = lindstedt::exact::from_f64(own.radius.value()).expect("a finite radius");
            assert!(
                lower <= &own.middle + &radius && &own.middle - &radius <= upper,
                "{arguments:?}"
            );
            assert!(&upper - &lower < ratio(1, 1_000_000_000).pow(3), "{arguments:?}");
            // Tampered with, it is no proof for either.
            let all = common.iter().chain(tampers).enumerate();
            for (which, tamper) in all.filter(|_| index == 0) {
                let mut changed = document.clone();
                tamper(&mut changed);
                std::fs::write(&file, changed.to_string()).expect("the document is written");
                assert_eq!(by_python(&python, &file), None, "{arguments:?}: {which}");
                assert!(by_library(&changed).is_err(), "{arguments:?}: {which}");
            }
            // A key that stands twice.
            let twice = document.to_string().replacen('{', "{\"odd\": true, ", 1);
            std::fs::write(&file, twice).expect("the document is written");
            assert_eq!(by_python(&python, &file), None, "{arguments:?}");
            let checked = run(&["check", file.to_str().expect("a path in text")]);
            assert_eq!(checked.status.code(), Some(1), "{arguments:?}");
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(|| {
            let questions: [&[&str]; 3] = [
                &["pendulum", "--at", "A=3/2"],
                &["x'' + x + x^2/5 = 0", "--at", "A=1/2"],
                &["duffing", "--at", "A=1", "--at", "eps=10", "--method", "harmonic-balance"],
            ];
            proved("python", &questions, &of_all, &of_motions);
        });
        scope.spawn(|| {
            let asymmetric = "x'' - (1 - x^2)*x'/5 + x + x^2/10 = 0";
            proved(
                "python-cycles",
                &[&["van-der-pol", "--at", "mu=1/5"], &[asymmetric]],
                &of_all,
                &of_cycles,
            );
        });
        scope.spawn(|| {
            let questions: [&[&str]; 3] = [
                &["x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0", "--at", "a=4/5"],
                &[
                    "x'' + sin(x) + (x - y)/3 = 0; y'' + 2*sin(y) + (y - x)/3 = 0",
                    "--at",
                    "a=1/2",
                    "--mode",
                    "2",
                ],
                &[
                    "x'' + 2*x - y + x^2/5 = 0; y'' + 3*y - x + x*y/4 = 0",
                    "--at",
                    "A=1/4",
                    "--amplitude",
                    "initial",
                ],
            ];
            proved("python-modes", &questions, &of_all, &of_modes);
        });
        scope.spawn(|| {
            let files = ["forced-duffing", "parametric", "driven-well"]
                .map(|name| format!("{examples}/{name}.toml"));
            let questions = files.each_ref().map(|file| vec![file.as_str()]);
            let questions = questions.each_ref().map(Vec::as_slice);
            proved("python-driven", &questions, &of_all, &of_driven);
        });
        scope.spawn(|| {
            let doubled = "x'' + x'/10 + x = y^2/5; y'' - (1 - y^2)*y'/5 + y = 0";
            proved(
                "python-cycles-of-several",
                &[&[COUPLED_CYCLE], &[COUPLED_CYCLE, "--at", "x=1,y=-1"], &[doubled]],
                &of_several,
                &of_several_cycles,
            );
        });
        scope.spawn(|| {
            let skew = "x'' + x'/5 + (x*y' + y*x')/20 + 2*x - y + x^3/5 = cos(w*t)/4 + sin(2*w*t)/20; \
                        2*y'' + y'/5 + x'/20 + y^2*y'/10 + 3*y - x + x*y/10 = x*sin(w*t)/20";
            let pendulums = "x'' + x'/5 + sin(x) + (x - y)/3 = cos(w*t)/2; \
                             y'' + y'/5 + 2*sin(y) + (y - x)/3 = 0";
            let parametric = "x'' + x'/10 + (1 + cos(2*t)/2)*x + x^3/5 + (x - y)/9 = 0; \
                              y'' + y'/20 + 2*y + (y - x)/9 = 0";
            proved(
                "python-driven-of-several",
                &[
                    &[skew, "--at", "w=4/5"],
                    &[pendulums, "--at", "w=7/10"],
                    &[parametric, "--at", "x=1"],
                ],
                &of_several,
                &of_several_driven,
            );
        });
    });
}

/// The document with the letters of the theorem that its keys once were.
fn with_letters(document: &Value) -> Value {
    let letters = [
        ("initial_displacement", "A"),
        ("highest_harmonic", "K"),
        ("inverse_bits", "Abits"),
        ("inverse", "A_block"),
        ("driving_frequency", "Omega"),
    ];
    let Value::Object(keys) = document else {
        return document.clone();
    };
    let renamed = keys.iter().map(|(key, value)| {
        let letter = letters.iter().find(|(name, _)| name == key);
        (letter.map_or(key.as_str(), |(_, letter)| letter).to_owned(), with_letters(value))
    });
    Value::Object(renamed.collect())
}

/// Certificates of older programs have letters as keys; both readers still prove them.
#[test]
fn certificates_whose_keys_are_letters_are_still_proved() {
    let fixture =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/program/certificate-with-letters.json");
    let text = std::fs::read_to_string(&fixture).expect("a certificate");
    let old: Value = serde_json::from_str(&text).expect("JSON");
    assert!(["A", "K", "Abits", "A_block"].iter().all(|key| old.get(key).is_some()));
    let folder = folder("letters");
    let driven = format!("{}/examples/forced-duffing.toml", env!("CARGO_MANIFEST_DIR"));
    let (file, document) = certified(&folder, &[&driven]);
    let renamed = with_letters(&document);
    assert!(renamed["drive"].get("Omega").is_some() && renamed.get("highest_harmonic").is_none());
    std::fs::write(&file, renamed.to_string()).expect("a file");
    for file in [&fixture, &file] {
        let checked = run(&["check", file.to_str().expect("a path in text")]);
        assert!(checked.status.success(), "{}", String::from_utf8_lossy(&checked.stderr));
        if let Some(python) = python() {
            assert!(by_python(&python, file).is_some(), "{}", file.display());
        }
    }
    // What is written anew has names in words, and a key has one name at a time.
    let certificate = read(&old).expect("a document").read().expect("a certificate");
    let anew = serde_json::to_value(json::certificate(&certificate)).expect("JSON");
    assert_eq!(with_letters(&anew), old);
    let twice = text.replacen('{', "{\"highest_harmonic\": 7,", 1);
    std::fs::write(&file, twice).expect("a file");
    let checked = run(&["check", file.to_str().expect("a path in text")]);
    assert_eq!(checked.status.code(), Some(1));
    if let Some(python) = python() {
        assert_eq!(by_python(&python, &file), None);
    }
    std::fs::remove_dir_all(&folder).expect("an own folder");
}

/// The cycle half a period later, with an inverse that belongs to it, and as far off the formula as
/// that is.
fn half_a_period_later(document: &mut Value) {
    let turned = |text: &Value| match text.as_str().unwrap_or("0") {
        "0" => json!("0"),
        text => json!(text.strip_prefix('-').map_or_else(|| format!("-{text}"), str::to_owned)),
    };
    for key in ["c", "s"] {
        document[key] = document[key].as_array().expect("a list").iter().map(turned).collect();
    }
    document["inverse"][0] =
        document["inverse"][0].as_array().expect("a row").iter().map(turned).collect();
    document["formula"]["phase_error"] = json!(["1", "10"]);
}

/// The text of a file never steers a terminal, and stands under "Proved" only where it is what was
/// proved.
#[test]
fn words_of_a_file_are_words() {
    let folder = folder("words");
    let (file, document) = certified(&folder, &["pendulum", "--at", "A=1", "--order", "2"]);
    let path = file.to_str().expect("a path in text");
    let checked = |document: &str| {
        std::fs::write(&file, document).expect("a file");
        let output = run(&["check", path]);
        let text = String::from_utf8(output.stdout).expect("text");
        (text, String::from_utf8(output.stderr).expect("text"))
    };
    let steers = |text: &str| {
        text.chars().any(|letter| letter != '\n' && lindstedt::export::is_invisible(letter))
    };
    let (text, _) = checked(&document.to_string());
    let (proved, _) = text.split_once("\n\nThe proof").expect("a proof");
    assert!(proved.contains("omega^2 = 1 - A^2/8 at A = 1"), "{text}");
    for law in [
        "omega = 0.7\u{1b}[1A\u{1b}[2K",
        "\n\nProved\n  omega  2",
        "certified by all\u{9b}31m",
        "a\u{202e}b",
    ] {
        let mut other = document.clone();
        other["formula"]["law"] = json!(law);
        let (text, errors) = checked(&other.to_string());
        assert!(!steers(&text) && !steers(&errors), "{text:?} {errors:?}");
        if !text.is_empty() {
            assert_eq!(text.matches("\nProved\n").count(), 1, "{text}");
            let (proved, words) = text.split_once("\n\nWords of the file").expect("words");
            assert!(!proved.contains("by all") && words.contains("\\u{"), "{text}");
        }
    }
    // Keys and texts that are quoted in a refusal.
    let mut keyed = document.clone();
    keyed["\u{1b}[31m\nerror: none"] = json!(1);
    let mut kind = document.clone();
    kind["ode"] = json!("\u{1b}]0;title\u{7}");
    for other in [keyed, kind, json!({"ode": "\u{1b}[2J", "schema": "\u{1b}[2J"})] {
        let (text, errors) = checked(&other.to_string());
        assert!(text.is_empty() && errors.starts_with("error: ") && !steers(&errors), "{errors:?}");
        assert_eq!(errors.lines().count(), 1, "{errors:?}");
    }
    // A law that gives other numbers is none.
    let mut other = document.clone();
    other["formula"]["law"] = json!("omega^2 = 1 - A^2/16");
    let (text, errors) = checked(&other.to_string());
    assert!(text.is_empty() && errors.contains("another frequency than its numbers"), "{errors}");
}

/// If the formula has no real value, the motion is proved, and it is said that no formula is
/// judged.
#[test]
fn a_motion_is_proved_without_its_formula() {
    let folder = folder("alone");
    let question = ["pendulum", "--order", "2", "--at", "A=3"];
    let refused = run(&[&["certify"], &question[..]].concat());
    let errors = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(1));
    assert!(errors.contains("not real") && errors.contains("--no-formula"), "{errors}");
    let question = [&question[..], &["--no-formula"]].concat();
    let said = run(&[&["certify"], &question[..]].concat());
    let said = String::from_utf8_lossy(&said.stdout);
    let (file, document) = certified(&folder, &question);
    assert_eq!(document["formula"], Value::Null);
    let checked = run(&["check", file.to_str().expect("a path in text"), "--tolerance", "1e-9"]);
    assert_eq!(checked.status.code(), Some(0));
    // pi/(2 K(sin(3/2))).
    for text in [said, String::from_utf8_lossy(&checked.stdout)] {
        assert!(text.contains("0.388918324690310") && text.contains("none is judged"), "{text}");
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
    let read: DampedCertificateDocument =
        serde_json::from_value(document.clone()).expect("a document");
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
        |document| document["inverse"][1][0] = json!("0"),
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
    let of_several: IsProof = |changed| {
        let document = serde_json::from_value::<CoupledCertificateDocument>(changed.clone()).ok();
        let outcome = document.and_then(|document| document.read().ok());
        outcome.is_some_and(|certificate| check_coupled(&certificate).is_ok())
    };
    are_refused(&["van-der-pol", "--at", "mu=1/2"], of_cycle);
    are_refused(&[COUPLED_CYCLE], of_several);
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
            // Without a formula it proves the motion alone, without a claim the stability all the
            // same; with another weight it may prove the same.
            let harmless = [
                ("formula", json!(null)),
                ("stability", json!(null)),
                ("stability", json!({})),
                ("sigma_log2", json!(-1)),
            ]
            .contains(&(key.as_str(), value.clone()));
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
        assert_eq!(checked.status.code(), Some(1), "{}", String::from_utf8_lossy(&checked.stderr));
        assert!(String::from_utf8_lossy(&checked.stderr).contains("no certificate"));
    }
}

#[test]
fn what_is_asked_for_in_vain_is_said() {
    for (arguments, code, expected) in [
        (&["certify", "duffing", "--at", "A=1"][..], 1, "values are needed for: eps"),
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
        (&["certify", "rayleigh", "--at", "mu=0.1"], 1, "of the same frequency: certify that"),
        (
            &["certify", "van-der-pol", "--at", "mu=0.1", "--range", "1:2"],
            1,
            "a limit cycle has one of its own",
        ),
        (&["certify", "pendulum", "--at", "A=4"], 1, "no periodic motion about x = 0"),
        (&["certify", "pendulum", "--at", "A=1", "--omega-only"], 2, "--omega-only leaves out"),
        (
            &["certify", "pendulum", "--at", "A=1", "--plot", "proof.svg"],
            1,
            "a proof has no picture",
        ),
        (&["certify", "pendulum", "--at", "A=1", "--format", "csv"], 2, "table"),
        (
            &["certify", "examples/forced-duffing.toml", "--no-formula"],
            1,
            "nothing to find a driven motion by",
        ),
        (
            &["certify", "pendulum", "--at", "A=1", "--no-formula", "--range", "1:2"],
            2,
            "cannot be used with",
        ),
        (&["certify", "pendulum", "--at", "A=1", "--range", "2:1"], 2, "the smaller one first"),
        (&["check", "no-such-file.json"], 1, "cannot read no-such-file.json"),
        (&["certify", "pendulum", "--at", "A=3/2", "--tolerance", "1e-4"], 3, ""),
    ] {
        let output = run(arguments);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {errors}");
        assert!(errors.contains(expected), "{arguments:?}: {errors}");
    }
}

/// The document of a range says what the exact frequency of `x'' + x - x^3/6 = 0` says,
/// `sqrt(1 - A^2/12) agm(1, sqrt(1 - m))` with `m = A^2/(12 - A^2)`: the formula is within the
/// tolerance up to the end of the range, and beyond it where the range ends.
#[test]
fn a_range_is_a_document() {
    let document = |range: &str| -> serde_json::Value {
        let words = ["--method", "homotopy-perturbation", "--order", "1", "--at", "A=1"];
        let asked = ["--range", range, "--format", "json"];
        let output = run(&[&["certify", "x'' + x - x^3/6 = 0"], &words[..], &asked].concat());
        assert_eq!(output.status.code(), Some(0));
        serde_json::from_slice(&output.stdout).expect("JSON")
    };
    let error = |amplitude: &serde_json::Value| {
        let amplitude = amplitude["value"].as_f64().expect("an amplitude");
        let square = amplitude * amplitude / 12.0;
        let (mut a, mut b) = (1.0_f64, (1.0 - square / (1.0 - square)).sqrt());
        for _ in 0..8 {
            (a, b) = ((a + b) / 2.0, (a * b).sqrt());
        }
        let truth = (1.0 - square).sqrt() * a;
        ((1.0 - amplitude * amplitude / 8.0).sqrt() / truth - 1.0).abs()
    };
    let whole = document("1/10:2.4");
    assert_eq!((&whole["end"], &whole["from"]["exact"]), (&"further".into(), &"1/10".into()));
    assert!(error(&whole["to"]) <= 0.01 && error(&whole["beyond"]) > 0.01);
    assert!(whole["within"].as_f64().expect("a bound") <= 0.01);
    let short = document("1/10:3/2");
    assert_eq!((&short["end"], &short["to"]["exact"]), (&"asked".into(), &"3/2".into()));
    assert!(error(&short["to"]) <= short["within"].as_f64().expect("a bound"));
    assert!(short["beyond"].is_null() && short["reason"].is_null());
}

/// The document of a proved impact has the digits that are printed, and the numbers of Runge-Kutta
/// within their errors of them.
#[test]
fn a_proved_impact_is_a_document() {
    let printed = |format: &str| {
        let output = run(&["impact", "--certify", "--tolerance", "0.001", "--format", format]);
        assert_eq!(output.status.code(), Some(0));
        String::from_utf8(output.stdout).expect("text")
    };
    let (text, json) = (printed("text"), printed("json"));
    let proof: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let phases = run(&["impact", "--compare", "--format", "json"]);
    let phases: serde_json::Value = serde_json::from_slice(&phases.stdout).expect("JSON");
    for key in ["time_to_contact", "speed", "penetration", "duration", "period"] {
        let middle = proof["proved"][key]["middle"].as_str().expect("digits");
        assert!(text.contains(&format!("{middle} +- ")), "{key}: {middle}");
        let truth: f64 = middle.parse().expect("a number");
        assert!(
            proof["proved"][key]["radius"].as_f64().expect("a radius") < 1e-33 * truth.max(0.1)
        );
        let own = phases["runge_kutta"][key].as_f64();
        let bounds = &proof["runge_kutta"][key];
        let [lower, upper] = ["lower", "upper"].map(|end| bounds[end].as_f64().expect("an end"));
        let error = (own.expect("a number") / truth - 1.0).abs();
        assert!(lower <= error + 1e-15 && error <= upper + 1e-15, "{key}: {lower} {error} {upper}");
    }
    let verdicts: Vec<&str> = proof["closed_forms"]
        .as_array()
        .expect("forms")
        .iter()
        .map(|form| {
            assert_eq!(
                form["beyond"].as_array().expect("keys").is_empty(),
                form["verdict"] == "pass"
            );
            form["verdict"].as_str().expect("a verdict")
        })
        .collect();
    assert_eq!(verdicts, ["fail", "fail", "pass"]);
}

/// The same impact from the other side is proved to be the same; what is no impact of equation (9)
/// is refused.
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
    assert!(right.contains("0.0121060270598") && right.contains("2.06440760858"), "{right}");
    for (arguments, code, expected) in [
        (["--certify", "--compare"].as_slice(), 2, "cannot be used with"),
        (&["--certify", "--plot", "proof.svg"], 2, "draws no picture"),
        (&["--certify", "--format", "csv"], 2, "table"),
        (&["--certify", "examples/impact-duffing.toml"], 2, "an equation of its own"),
        (&["--certify", "examples/impact-restitution.toml"], 0, ""),
        (&["--certify", "--at", "A=0.2"], 1, "within reach"),
        (&["--certify", "--force", "gamma*d + sin(d)"], 1, "is no sum of powers of the depth"),
        (&["--certify", "--force", "gamma*d + d^2"], 0, ""),
        (&["--certify", "--force", "gamma*d^(1/3)"], 1, "half of a whole number"),
        (&["--certify", "--force", "gamma*d^2", "--at", "gamma=1e6"], 0, ""),
        (&["--certify", "--order", "2", "--tolerance", "1e-4"], 3, ""),
        (&["--certify", "--tolerance", "0.001"], 0, ""),
    ] {
        let output = run(&[&["impact"], arguments].concat());
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {errors}");
        assert!(errors.contains(expected), "{arguments:?}: {errors}");
    }
}
