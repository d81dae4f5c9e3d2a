//! `lindstedt fit`: what measurements say, formats and refusals.

use std::path::PathBuf;
use std::process::{Command, Output};

use serde_json::Value;

const EXAMPLES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/fit");

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .arg("fit")
        .args(arguments)
        .current_dir(EXAMPLES)
        .output()
        .expect("the program starts")
}

fn printed(arguments: &[&str]) -> String {
    let output = run(arguments);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {message}");
    String::from_utf8(output.stdout).expect("text")
}

fn document(arguments: &[&str]) -> Value {
    serde_json::from_str(&printed(&[arguments, &["--format", "json"]].concat())).expect("JSON")
}

/// A file of a test with this text.
fn file(name: &str, text: &str) -> PathBuf {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, text).expect("a file");
    path
}

/// A parameter of the best law with its standard error.
fn estimate(document: &Value, name: &str) -> [f64; 2] {
    let own = &document["laws"][0]["parameters"][name];
    ["value", "standard_error"].map(|key| own[key].as_f64().expect("a number"))
}

#[test]
fn a_pendulum_with_two_kinds_of_damping_is_found() {
    let found = document(&["pendulum.csv"]);
    assert_eq!(found["laws"][0]["name"], "pendulum, viscous damping and dry friction");
    for (name, truth) in [("w", 10.0), ("zeta", 0.004), ("alpha", 0.003), ("x0", 1.0)] {
        let [value, error] = estimate(&found, name);
        assert!((value - truth).abs() < 3.0 * error, "{name}: {value} +- {error}");
        assert!(error < 0.01 * truth, "{name}: {value} +- {error}");
    }
    assert_eq!(found["best"]["is_white"], true);
    // Viscous damping alone, and dry friction alone, are excluded.
    for name in ["pendulum, viscous damping", "pendulum, dry friction"] {
        let laws = found["laws"].as_array().expect("laws");
        let law = laws.iter().find(|law| law["name"] == name).expect("the law");
        assert!(law["excluded"].is_string(), "{law}");
    }
}

/// The response of a cubic spring, swept up and down: the sweeps are on different branches between the folds.
#[test]
fn a_driven_oscillator_is_found_from_its_frequency_response() {
    let equation = "x'' + c*x' + k*x + b*x^3 = F*cos(Omega*t)";
    let arguments = ["response.csv", equation, "--data", "response"];
    let found = document(&arguments);
    for (name, truth) in [("c", 0.1), ("k", 1.0), ("b", 0.5), ("F", 0.3)] {
        let [value, error] = estimate(&found, name);
        assert!((value - truth).abs() < 3.0 * error, "{name}: {value} +- {error}");
        assert!(error < 0.02 * truth, "{name}: {value} +- {error}");
    }
    let rows = found["response"].as_array().expect("rows");
    assert_eq!(rows.len(), 35);
    for row in rows {
        let number = |key: &str| row[key].as_f64().expect("a number");
        assert!((number("amplitude") - number("law_amplitude")).abs() < 0.01, "{row}");
    }
    // The size of the drive as a column is known, and no longer found.
    let text = std::fs::read_to_string(format!("{EXAMPLES}/response.csv")).expect("a file");
    let with_drive = |line: &str| match line.starts_with('#') {
        true => String::new(),
        false if line.starts_with("Omega") => format!("{line},F\n"),
        false => format!("{line},0.3\n"),
    };
    let path = file("levels.csv", &text.lines().map(with_drive).collect::<String>());
    let known = document(&[path.to_str().expect("a path"), equation, "--data", "response"]);
    assert!(known["laws"][0]["parameters"].get("F").is_none());
    let [value, error] = estimate(&known, "c");
    assert!(
        (value - 0.1).abs() < 3.0 * error && error < estimate(&found, "c")[1],
        "{value} +- {error}"
    );
    let refusal = |arguments: &[&str]| {
        let output = run(arguments);
        assert!(!output.status.success(), "{arguments:?}");
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let without = refusal(&["response.csv", "--data", "response"]);
    assert!(without.contains("one equation with a drive"), "{without}");
    let free = refusal(&["response.csv", "x'' + c*x' + k*x = 0", "--data", "response"]);
    assert!(free.contains("no drive"), "{free}");
}

#[test]
fn a_fitted_law_is_a_problem_that_swings_as_the_record_does() {
    let problem = printed(&["pendulum.csv", "--format", "toml"]);
    let path = file("fitted.toml", &problem);
    let line = problem.lines().find(|line| line.contains("--from")).expect("a command");
    let words: Vec<&str> = line.split_whitespace().skip_while(|word| *word != "--from").collect();
    let output = Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .args(["simulate", path.to_str().expect("a path")])
        .args(words)
        .args(["--format", "csv"])
        .output()
        .expect("the program starts");
    let table = String::from_utf8(output.stdout).expect("text");
    let curve = printed(&["pendulum.csv", "--format", "csv"]);
    let number = |line: &str, place: usize| -> f64 {
        line.split(',').nth(place).and_then(|cell| cell.parse().ok()).expect("a number")
    };
    let measured: Vec<[f64; 2]> =
        curve.lines().skip(1).map(|line| [number(line, 1), number(line, 2)]).collect();
    for line in table.lines().skip(1).step_by(50) {
        let (time, angle) = (number(line, 0), number(line, 1));
        let nearest = measured
            .iter()
            .min_by(|one, other| (one[0] - time).abs().total_cmp(&(other[0] - time).abs()));
        let [at, value] = nearest.expect("a sample");
        // Half a step of the record at the largest speed, and five times the noise.
        assert!((value - angle).abs() < 10.0 * (at - time).abs() + 0.03, "{time}: {angle} {value}");
    }
}

#[test]
fn backbones_and_impacts_are_found() {
    let table = document(&["backbone.csv", "--data", "backbone"]);
    assert_eq!(table["laws"][0]["name"], "Duffing spring, no damping");
    assert!((estimate(&table, "w")[0] / 50.0 - 1.0).abs() < 1e-3);
    assert!((estimate(&table, "beta")[0] / 4000.0 - 1.0).abs() < 1e-3);
    let ball = document(&["impacts.csv", "--data", "impacts"]);
    assert_eq!(ball["laws"][0]["name"], "constant restitution");
    let [value, error] = estimate(&ball, "e");
    assert!((value - 0.86).abs() < 3.0 * error && error < 0.002, "{value} +- {error}");
    assert!(ball["laws"][1]["excluded"].is_string());
    assert_eq!(ball["impacts"].as_array().map(Vec::len), Some(12));
}

/// A linear decay with a ripple in place of noise, from an amplitude.
fn decay(name: &str, size: f64) -> PathBuf {
    let mut text = "t\tx\n".to_owned();
    for sample in 0..400 {
        let t = 0.1 * f64::from(sample);
        let x = size * (-0.02 * t).exp() * (2.0 * t).cos() + 3e-3 * (1e4 * t * t).sin();
        text += &format!("{t:.1}\t{x:.6}\n");
    }
    file(name, &text)
}

#[test]
fn records_of_one_thing_are_fitted_together() {
    let [one, other] = [decay("one.tsv", 1.0), decay("other.tsv", 0.5)];
    let [one, other] = [&one, &other].map(|path| path.to_str().expect("a path"));
    let equation = "x'' + c*x' + k*x = 0";
    let alone = document(&[one, equation]);
    let both = document(&[one, equation, "--also", other]);
    let [value, error] = estimate(&both, "c");
    assert!((value - 0.04).abs() < 3.0 * error, "{value} +- {error}");
    assert!(error < estimate(&alone, "c")[1]);
    let [start, error] = estimate(&both, "x0_2");
    assert!((start - 0.5).abs() < 4.0 * error, "{start} +- {error}");
    assert_eq!(both["records"].as_array().map(Vec::len), Some(2));
}

#[test]
fn mistakes_in_measurements_are_named_with_a_way_forward() {
    let decay = decay("mistakes.tsv", 1.0);
    let decay = decay.to_str().expect("a path");
    let word = file("word.csv", "t,x\n0,1\n1,two\n");
    let back = file("back.csv", "0,1\n2,1\n1,1\n");
    let short = file("short.csv", "0,1\n0.1,0.5\n0.2,0\n0.3,-0.5\n0.4,-1\n");
    let empty = file("nothing.csv", "# nothing\n");
    let [word, back, short, empty] =
        [&word, &back, &short, &empty].map(|path| path.to_str().expect("a path"));
    for (arguments, code, words) in [
        (vec![word], 1, "line 3: `two` in the column `x` is not a number"),
        (vec![back], 1, "line 3: the time runs back from 2 to 1"),
        (vec![short], 1, "help: "),
        (vec![empty], 1, "there are no lines with numbers"),
        (vec![decay, "--column", "y"], 1, "there is no column `y`; the columns are t, x"),
        (vec![decay, "x'' + 2*x = 0"], 1, "has no unknown parameter"),
        (vec![decay, "x'' + k*x = = 0"], 1, "help: "),
        (vec![decay, "x'' + c*x' + k*x = 0", "--start", "c=1"], 2, "a value for k"),
        (vec![decay, "--start", "c=1"], 2, "write the equation as well"),
        (vec!["impacts.csv", "--data", "impacts", "--angle"], 2, "no effect"),
        (vec!["no-such-file.csv"], 1, "cannot read no-such-file.csv"),
        (vec![decay, "--tolerance", "0.1"], 2, "--tolerance"),
        (vec!["impacts.csv", "--data", "impacts", "--format", "toml"], 1, "no equation of motion"),
    ] {
        let output = run(&arguments);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {message}");
        assert!(message.contains(words), "{arguments:?}: {message}");
    }
}

#[test]
fn measurements_as_text() {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(concat!(env!("CARGO_MANIFEST_DIR"), "/snapshots"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| {
        insta::assert_snapshot!("fit-pendulum", printed(&["pendulum.csv"]));
        let backbone = ["backbone.csv", "--data", "backbone", "--format", "latex"];
        insta::assert_snapshot!("fit-backbone-latex", printed(&backbone));
        insta::assert_snapshot!("fit-impacts", printed(&["impacts.csv", "--data", "impacts"]));
        insta::assert_snapshot!("help-fit", printed(&["--help"]));
    });
    let page = printed(&["impacts.csv", "--data", "impacts", "--format", "html"]);
    assert!(page.contains("constant restitution"));
}
