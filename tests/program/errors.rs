//! One wrong input, one message: every file in `tests/errors/` is refused, located and helped,
//! never a panic or a hang.
//!
//! `*.txt` is an equation on standard input; `*.toml` a problem file, for `impact`, `materials`,
//! `optimize` or `audit` where its first line says so.

use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// Far more than any refusal takes; without it a hang would be a hang of the test.
const TIMEOUT: &str = "3600";

fn run(arguments: &[&str], input: &[u8]) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .args(arguments)
        .args(["--timeout", TIMEOUT])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    // A program that refuses before it has read everything closes the pipe; that is its right.
    let _ = child.stdin.take().expect("a pipe").write_all(input);
    child.wait_with_output().expect("the program ends")
}

fn message(file: &Path) -> String {
    let bytes = std::fs::read(file).expect("a wrong input");
    let path = file.to_str().expect("a path in text");
    let output = match file.extension().and_then(|extension| extension.to_str()) {
        Some("txt") => run(&["derive", "-"], &bytes),
        _ if bytes.starts_with(b"# impact") => run(&["impact", path], b""),
        _ if bytes.starts_with(b"# materials") => run(&["materials", path], b""),
        _ if bytes.starts_with(b"# optimize") => run(&["optimize", path], b""),
        _ if bytes.starts_with(b"# audit") => run(&["audit", path], b""),
        _ if bytes.starts_with(b"# lagrange") => run(&["lagrange", path], b""),
        _ if bytes.starts_with(b"# stability") => run(&["stability", path], b""),
        _ if bytes.starts_with(b"# simulate") => run(&["simulate", path], b""),
        _ => run(&["derive", path], b""),
    };
    let text = String::from_utf8(output.stderr).expect("messages are text");
    assert!(matches!(output.status.code(), Some(1 | 2)), "{path}: {:?} {text}", output.status);
    assert!(output.stdout.is_empty(), "{path} printed a result");
    assert!(text.starts_with("error: "), "{path}: {text}");
    for word in ["panicked", "internal error", "stopped after", "RUST_BACKTRACE"] {
        assert!(!text.contains(word), "{path}: {text}");
    }
    format!("{text}exit code {}\n", output.status.code().unwrap_or_default())
}

#[test]
fn every_wrong_input_gets_its_message() {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(concat!(env!("CARGO_MANIFEST_DIR"), "/snapshots"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    // The folder of the checkout is nobody's business.
    settings.add_filter(concat!(env!("CARGO_MANIFEST_DIR"), "/"), "");
    settings.bind(|| {
        insta::glob!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/errors"), "*.t*", |file| {
            insta::assert_snapshot!("error", message(file));
        });
    });
}

#[test]
fn strange_inputs_that_are_right_are_answered() {
    for input in [
        "\u{feff}x'' + sin(x) = 0\n".to_owned(),
        "x'' + x\r\n + eps*x^3\r\n = 0\r\n".to_owned(),
        // A sum of 20 000 terms.
        format!("x'' + x{} = 0", " + eps*x^3".repeat(6000)),
        "equation = \"x'' + sin(x) = 0\"\n[values]\nA = \"pi/3\"\n".to_owned(),
        "x'' + 1e-300*x + eps*x^3".to_owned(),
        "x'' + 1e300*x + eps*x^3".to_owned(),
    ] {
        let output = run(&["derive", "-"], input.as_bytes());
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{}: {text}", &input[..input.len().min(60)]);
        assert!(!output.stdout.is_empty() && text.is_empty(), "{text}");
    }
}

#[test]
fn too_long_an_input_is_refused() {
    let output = run(&["derive", "-"], "x'' + x + ".repeat(100_000).as_bytes());
    assert_eq!(output.status.code(), Some(1));
}
