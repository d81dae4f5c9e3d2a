//! `lindstedt shortest`: formats, certificates and refusals.

use std::process::{Command, Output};

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .args(arguments)
        .output()
        .expect("the program starts")
}

fn printed(arguments: &[&str]) -> String {
    let output = run(arguments);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {message}");
    String::from_utf8(output.stdout).expect("text")
}

/// Runs a test with its snapshots beside all others.
fn in_snapshots(body: impl FnOnce()) {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(concat!(env!("CARGO_MANIFEST_DIR"), "/snapshots"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(body);
}

const PENDULUM: [&str; 8] =
    ["shortest", "pendulum", "--range", "A=0:2.8", "--error", "0.01", "--longest", "8"];

#[test]
fn laws_as_text() {
    in_snapshots(|| {
        insta::assert_snapshot!("shortest-pendulum", printed(&PENDULUM));
        let period =
            ["shortest", "pendulum", "--range", "A=0:2.8", "--quantity", "T", "--longest", "8"];
        insta::assert_snapshot!("shortest-period", printed(&period));
        let duffing = ["shortest", "duffing", "--range", "eps*A^2=0:inf", "--longest", "9"];
        insta::assert_snapshot!("shortest-duffing", printed(&duffing));
        let latex = [&PENDULUM[..], &["--format", "latex"]].concat();
        insta::assert_snapshot!("shortest-latex", printed(&latex));
        insta::assert_snapshot!("help-shortest", printed(&["shortest", "--help"]));
    });
}

#[test]
fn every_format_has_the_law_with_its_bound() {
    for (format, words) in [
        ("csv", "law,6,"),
        ("rust", "pub fn angular_frequency(A: f64) -> f64"),
        ("c", "double angular_frequency(double A)"),
        ("python", "def angular_frequency(A):"),
        ("julia", "angular_frequency(A"),
        ("matlab", "angular_frequency(A)"),
    ] {
        let text = printed(&[&PENDULUM[..], &["--format", format]].concat());
        assert!(text.contains(words), "{text}");
        assert!(format == "csv" || text.contains("0.888 %, proved"), "{text}");
    }
    let page = printed(&[&PENDULUM[..], &["--format", "html"]].concat());
    assert_eq!(page.contains("<svg"), cfg!(feature = "plot"));
}

#[test]
fn a_certificate_is_checked_and_a_false_one_refused() {
    let file = std::env::temp_dir().join(format!("lindstedt-law-{}.json", std::process::id()));
    let name = file.to_str().expect("a path in text");
    let certificate = printed(&[&PENDULUM[..], &["--certificate", "--format", "json"]].concat());
    let check = |text: &str| {
        std::fs::write(&file, text).expect("a file");
        let output = run(&["check", name]);
        let text = [output.stdout, output.stderr].concat();
        (output.status.code(), String::from_utf8_lossy(&text).into_owned())
    };
    let (code, text) = check(&certificate);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("between 0.887273 % and 0.888 %, for every A of the range"), "{text}");
    for (from, to, words) in [
        ("0.00888", "0.00887", "is not proved to be within its bound"),
        ("0.00887273", "0.0088728", "more is claimed"),
        ("sin(x)", "sin(x) + 1/9", "is not zero at x = 0"),
        ("sin(x)", "sin(x*A)", "an amplitude that goes to infinity or is a parameter"),
        ("\"14/5\"", "\"4\"", "has no value"),
        ("\"from\": \"0\"", "\"from\": \"3\"", "an empty range"),
        ("\"A\"", "\"x\"", "a variable that is the coordinate"),
        ("\"omega\"", "\"omega^3\"", "`quantity` should hold"),
        ("cos(A/2)", "cos(B/2)", "a law with letters that have no value"),
    ] {
        assert!(certificate.contains(from), "{certificate}");
        let (code, text) = check(&certificate.replace(from, to));
        assert_eq!(code, Some(1), "{from}: {text}");
        assert!(text.contains(words), "{from}: {text}");
    }
    let _ = std::fs::remove_file(&file);
}

const CONTACT: [&str; 8] = [
    "shortest",
    "x'' + k*x^(3/2)*(1 + lambda*x') = 0",
    "--quantity",
    "contact-time",
    "--range",
    "e=0.3:1",
    "--longest",
    "7",
];

#[test]
fn laws_of_contacts_and_of_modes() {
    in_snapshots(|| {
        insta::assert_snapshot!("shortest-contact", printed(&CONTACT));
        let mode = ["shortest", PAIR, "--mode", "2", "--range", "a=0:1", "--longest", "8"];
        insta::assert_snapshot!("shortest-mode", printed(&mode));
    });
    let code = printed(&[&CONTACT[..], &["--format", "python"]].concat());
    assert!(code.contains("def contact_time_ratio(e):"), "{code}");
    // The certificate is checked again, and not as one of an oscillator.
    let file = std::env::temp_dir().join(format!("lindstedt-contact-{}.json", std::process::id()));
    let name = file.to_str().expect("a path in text");
    let certificate = printed(&[&CONTACT[..], &["--certificate", "--format", "json"]].concat());
    std::fs::write(&file, &certificate).expect("a file");
    let text = printed(&["check", name]);
    assert!(text.contains("T/T_0 = ") && text.contains("for every s of the range"), "{text}");
    std::fs::write(&file, certificate.replace("x''+f(x,x')=0", "x''+f(x,p)=0")).expect("a file");
    let output = run(&["check", name]);
    assert!(String::from_utf8_lossy(&output.stderr).contains("`ode` should hold"));
    // So is that of a mode.
    let mode = ["shortest", PAIR, "--mode", "1", "--range", "a=0:1", "--longest", "6"];
    let certificate = printed(&[&mode[..], &["--certificate", "--format", "json"]].concat());
    std::fs::write(&file, &certificate).expect("a file");
    let text = printed(&["check", name]);
    assert!(text.contains("the branch of normal modes with omega near 1"), "{text}");
    assert!(text.contains("for every a of the range"), "{text}");
    assert_eq!(printed(&["check", name, "--format", "json"]), certificate);
    for (from, to, words) in [
        ("\"mu\": \"1\"", "\"mu\": \"0.3\"", "is not that of the branch"),
        ("\"start_of\": null", "\"start_of\": \"x\"", "`mode` should hold"),
    ] {
        let changed = certificate.replace(from, to);
        assert!(changed != certificate, "{certificate}");
        std::fs::write(&file, changed).expect("a file");
        let errors = String::from_utf8_lossy(&run(&["check", name]).stderr).into_owned();
        assert!(errors.contains(words), "{errors}");
    }
    let _ = std::fs::remove_file(&file);
}

#[test]
fn a_parameter_may_have_the_letter_of_the_amplitude() {
    let question = ["shortest", "x'' + A*x + x^3 = 0", "--range", "C=0:1", "--at", "A=1"];
    let text = printed(&[&question[..], &["--longest", "6"]].concat());
    assert!(text.contains("released at rest from x(0) = C, 0 <= C <= 1"), "{text}");
    assert!(text.contains("%  proved"), "{text}");
}

const PAIR: &str = "x'' + 2*x - y + x^3 = 0; y'' + 2*y - x + y^3 = 0";
const HERTZ: &str = "x'' + x^(3/2)*(1 + lambda*x') = 0";

#[test]
fn what_no_law_is_searched_for_says_why() {
    for (arguments, code, words) in [
        (vec!["pendulum", "--range", "A=2:1"], 1, "is empty or begins below zero"),
        (vec!["pendulum", "--range", "A=-1:1"], 1, "is empty or begins below zero"),
        (vec!["pendulum", "--range", "A"], 2, "expected NAME=FROM:TO"),
        (
            vec!["pendulum", "--range", "k=0:1"],
            1,
            "`k` is neither the amplitude `A` nor a parameter",
        ),
        (vec!["pendulum", "--range", "A=0:4"], 1, "help: the whole range has to be of one family"),
        (
            vec!["duffing", "--range", "eps=0:1"],
            1,
            "values are needed for: A\n  help: add --at A=1",
        ),
        (vec!["duffing", "--range", "A=0:1"], 1, "values are needed for: eps"),
        (vec!["duffing", "--range", "eps*A=0:1"], 1, "does not depend on `eps*A` alone"),
        (
            vec!["pendulum", "--range", "A=0:1", "--at", "k=1"],
            2,
            "--at k: `k` does not occur in the question",
        ),
        (vec!["pendulum", "--range", "A=0:1", "--atom", "log(A - 2)"], 1, "no quantity of `A`"),
        (vec!["pendulum", "--range", "A=0:1", "--atom", "k*A"], 1, "no quantity of `A`"),
        (vec!["pendulum", "--range", "A=0:1", "--longest", "900"], 2, "at most 60 symbols"),
        (vec!["pendulum", "--range", "A=0:1", "--exact-at-rest", "99"], 2, "at most 12"),
        (
            vec!["x'' + 2*sin(x) = 0", "--range", "A=0:1", "--exact-at-rest", "2"],
            1,
            "no coefficients that are fractions",
        ),
        (vec!["pendulum", "--range", "A=0:1", "--certificate"], 2, "add --format json"),
        (vec!["pendulum", "--range", "A=0:1", "--mode", "1"], 2, "--mode: it is of the modes"),
        (vec!["pendulum", "--range", "A=0:1", "--amplitude", "initial"], 2, "--amplitude: it is"),
        (vec!["pendulum", "--range", "A=0:1", "--growth", "much"], 2, "expected a number"),
        (vec![PAIR, "--range", "a=0:1"], 2, "add --mode 1"),
        (vec![PAIR, "--mode", "3", "--range", "a=0:1"], 1, "mode"),
        (vec![PAIR, "--mode", "1", "--range", "x=0:1"], 1, "of a mode the amplitude `a` varies"),
        (vec![PAIR, "--mode", "1", "--range", "a=0:1", "--at", "q=1"], 2, "--at q"),
        (
            vec![PAIR, "--mode", "1", "--range", "a=0:1", "--quantity", "contact-time"],
            2,
            "one coordinate",
        ),
        (
            vec!["pendulum", "--quantity", "contact-time", "--range", "e=0.5:1"],
            1,
            "needs a force k*x^n*(1 + c*x')",
        ),
        (
            vec![HERTZ, "--quantity", "contact-time", "--range", "e=0.5:2"],
            1,
            "that of its restitution at one",
        ),
        (vec![HERTZ, "--quantity", "contact-time", "--range", "lambda=0:2"], 1, "add --at v=1"),
        (
            vec![HERTZ, "--quantity", "contact-time", "--range", "k=0:2"],
            1,
            "write --range \"lambda*v=0:5\"",
        ),
        (
            vec![HERTZ, "--quantity", "contact-time", "--range", "lambda*v=0:inf"],
            1,
            "ends at a number",
        ),
        (
            vec![HERTZ, "--quantity", "contact-time", "--range", "e=0.5:1", "--at", "q=1"],
            2,
            "--at q",
        ),
        (vec!["damped-pendulum", "--range", "A=0:1", "--at", "zeta=0.1"], 1, "without damping"),
        (vec!["pendulum", "--range", "A=0:1", "--error", "-1"], 2, "expected a positive number"),
    ] {
        let arguments = [&["shortest"], &arguments[..]].concat();
        let output = run(&arguments);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {text}");
        assert!(text.contains(words), "{arguments:?}: {text}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
    }
    // An error that no law of the length reaches: the nearest one is shown, and the verdict fails.
    let short =
        ["shortest", "pendulum", "--range", "A=0:2.8", "--longest", "5", "--error", "0.001"];
    let output = run(&short);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(3), "{text}");
    assert!(text.contains("No law of this length is within 0.1 %; the nearest"), "{text}");
}
