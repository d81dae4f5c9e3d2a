//! Rigid walls on the command line: `simulate` and `response` with `--wall`, the examples, and what is
//! refused.

use std::process::{Command, Output};

use serde_json::Value;

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
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
    let text = printed(&[arguments, &["--format", "json"]].concat());
    serde_json::from_str(&text).expect("the output is JSON")
}

fn refusal(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert!(!output.status.success(), "{arguments:?}");
    String::from_utf8(output.stderr).expect("text")
}

/// The command in the comment of each example.
const EXAMPLES: [&[&str]; 6] = [
    &["simulate", "examples/walls/bouncing-ball.toml", "--from", "x=1", "--until", "6"],
    &["simulate", "examples/walls/newtons-cradle.toml", "--from", "p=-1", "--until", "13"],
    &["simulate", "examples/walls/impact-damper.toml", "--from", "x=-1.5", "--until", "30"],
    &["simulate", "examples/walls/rattling-gear.toml", "--from", "z=0", "--until", "50"],
    &["simulate", "examples/walls/soft-collision.toml", "--from", "x=-1", "--until", "20"],
    &["simulate", "examples/walls/soft-stop.toml", "--from", "phi=-1", "--until", "20"],
];

#[test]
fn examples_print_their_impacts() {
    for arguments in EXAMPLES {
        let name = arguments[1].rsplit(['/', '.']).nth(1).expect("a name");
        let mut settings = insta::Settings::clone_current();
        settings.set_snapshot_path(concat!(env!("CARGO_MANIFEST_DIR"), "/snapshots"));
        settings.set_prepend_module_to_snapshot(false);
        settings.set_omit_expression(true);
        settings.bind(|| insta::assert_snapshot!(format!("walls-{name}"), printed(arguments)));
        let text =
            std::fs::read_to_string(format!("{}/{}", env!("CARGO_MANIFEST_DIR"), arguments[1]));
        let command = arguments[1..4].join(" ");
        assert!(text.expect("a file").contains(&command), "{command}");
    }
}

/// A floor under a ball: the impacts are those of free fall, and the rest begins after their sum.
#[test]
fn a_document_has_impacts_and_rest() {
    let ball = [
        "simulate",
        "x'' + 2 = 0",
        "--wall",
        "x > 0",
        "--restitution",
        "1/2",
        "--from",
        "x=1",
        "--until",
        "5",
    ];
    let document = document(&ball);
    let walls = &document["walls"];
    assert_eq!(walls["walls"][0]["gap"], "x");
    assert_eq!(walls["walls"][0]["restitution"], "1/2");
    let first = &walls["impacts"][0];
    assert_eq!((first["t"].as_f64(), first["speed"].as_f64()), (Some(1.0), Some(2.0)));
    let rest = &walls["rests"][0];
    assert!((rest["from"].as_f64().expect("a time") - 3.0).abs() < 1e-12);
    assert_eq!(rest["after_chatter"], true);
    assert_eq!(document["complete"], true);
}

/// A response with a wall lists the numbers of impacts, as text and as JSON.
#[test]
fn a_response_has_the_numbers_of_impacts() {
    let asked = [
        "response",
        "x'' + x'/10 + x = F*cos(t)",
        "--wall",
        "x < 1",
        "--restitution",
        "0.8",
        "--vary",
        "F=0.5:1",
    ];
    let text = printed(&asked);
    assert!(text.contains("wall at 1 - x = 0, coefficient of restitution 4/5"), "{text}");
    assert!(text.contains("Impacts in a period: "), "{text}");
    let document = document(&asked);
    assert_eq!(document["walls"][0]["gap"], "1 - x");
    let counts = document["impacts"].as_array().expect("a list of lists");
    let points = document["branches"].as_array().expect("a list of lists");
    for (counts, points) in counts.iter().zip(points) {
        assert_eq!(counts.as_array().map(Vec::len), points.as_array().map(Vec::len));
    }
}

#[test]
fn bad_walls_are_refused_with_a_way_forward() {
    let simulate = |extra: &[&str]| {
        refusal(&[&["simulate", "x'' + x = 0", "--from", "x=0.5"], extra].concat())
    };
    for (extra, words) in [
        (&["--wall", "x < 1"][..], "needs its coefficient of restitution: --restitution 0.8"),
        (&["--restitution", "0.5"], "belongs to a wall"),
        (&["--wall", "x < 1", "--restitution", "1.5"], "lies between 0"),
        (&["--wall", "x = 1", "--restitution", "1"], "no `<` or `>`"),
        (&["--wall", "x << 1", "--restitution", "1"], "a side of the inequality is empty"),
        (&["--wall", "x < 0.2", "--restitution", "1"], "begins behind a wall"),
        (&["--wall", "1 < 2", "--restitution", "1"], "contains no coordinate: it needs one of `x`"),
        (&["--wall", "x' < 2", "--restitution", "1"], "contains the velocity `x'`"),
        (&["--wall", "x < d", "--restitution", "1"], "no value for `d`"),
        (&["--wall", "x < 1", "--restitution", "0.5,0.6"], "2 values of --restitution for 1 walls"),
        (&["--section", "impacts"], "no impacts without a wall"),
    ] {
        let refusal = simulate(extra);
        assert!(refusal.contains(words), "{extra:?}: {refusal}");
    }
    let order =
        refusal(&["simulate", "v' = -v", "--wall", "v > 0", "--restitution", "1", "--from", "v=1"]);
    assert!(order.contains("v"), "{order}");
}

/// Two masses that lie on the ground at the same time are not followed by `response`: it names both walls, and
/// what follows them.
#[test]
fn walls_on_which_a_motion_rests_at_once_are_named() {
    let equations = "x'' + 1 + x'/10 = F*cos(t); y'' + 6/5 + y'/10 - x/100 = F*cos(t)";
    let walls = ["--wall", "x > 0", "--wall", "y > 0", "--restitution", "0"];
    let refusal = refusal(&[&["response", equations, "--vary", "F=1.5:2"], &walls[..]].concat());
    assert!(refusal.contains("rest on two walls at once, `x = 0` and `y = 0`"), "{refusal}");
    assert!(refusal.contains("`lindstedt simulate` with --wall follows it"), "{refusal}");
}
