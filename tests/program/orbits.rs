//! `lindstedt orbits`: formats, verdicts and refusals.

use std::process::{Command, Output};

const BEAM: &str = "x'' + c*x' + k*x = F*cos(w*t)";
const STOP: [&str; 4] = ["--wall", "x < d", "--restitution", "e"];

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .arg("orbits")
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

#[test]
fn orbits_as_text() {
    in_snapshots(|| {
        let letters = [&[BEAM][..], &STOP].concat();
        insta::assert_snapshot!("orbits-letters", printed(&letters));
        let latex = [&letters[..], &["--format", "latex"]].concat();
        insta::assert_snapshot!("orbits-latex", printed(&latex));
        for name in ["driven-beam", "shaw-holmes", "bouncing-ball", "two-stops"] {
            let file = format!("examples/orbits/{name}.toml");
            insta::assert_snapshot!(format!("orbits-{name}"), printed(&[&file]));
        }
        let doubled = ["examples/orbits/doubled.toml", "--impacts", "2"];
        insta::assert_snapshot!("orbits-doubled", printed(&doubled));
        let swept = ["examples/orbits/bouncing-ball.toml", "--vary", "Z=0.001:0.01"];
        insta::assert_snapshot!("orbits-vary", printed(&swept));
        let proved = ["examples/orbits/driven-beam.toml", "--periods", "1", "--certify"];
        insta::assert_snapshot!("orbits-certify", printed(&proved));
        insta::assert_snapshot!("help-orbits", printed(&["--help"]));
    });
}

/// A wall beyond the place of rest leaves no motion without impacts that could graze it.
#[test]
fn a_wall_beyond_rest_is_not_grazed() {
    for (bound, grazes) in
        [("x < 1/2", true), ("x < -1/2", false), ("x > 0", false), ("x > -1/2", true)]
    {
        let wall = ["--wall", bound, "--restitution", "4/5"];
        let text = printed(&[&["x'' + x'/10 + x = F*cos(w*t)"], &wall[..]].concat());
        assert_eq!(
            text.contains("grazing of the motion without impacts:  X = 1/2"),
            grazes,
            "{text}"
        );
        assert_eq!(text.contains("grazing of"), grazes, "{text}");
    }
}

#[test]
fn orbits_have_every_format() {
    let file = "examples/orbits/driven-beam.toml";
    let table = printed(&[file, "--format", "csv"]);
    assert!(table.starts_with("orbit,kind,periods,wall,time,phase,speed_before"), "{table}");
    let vary = ["--vary", "F=0.05:1.5"];
    let table = printed(&[&[file, "--format", "csv"], &vary[..]].concat());
    assert!(table.lines().count() > 600, "{table}");
    let page = printed(&[&[file, "--format", "html"], &vary[..]].concat());
    assert_eq!(page.contains("<svg"), cfg!(feature = "plot"));
    let chart = ["--vary", "F=0.05:1.5", "--along", "w=0.5:3", "--periods", "1"];
    let table = printed(&[&[file, "--format", "csv"], &chart[..]].concat());
    assert_eq!(table.lines().count(), 1 + 200 * 200);
    if cfg!(feature = "plot") {
        let picture = printed(&[&[file, "--format", "svg"], &chart[..]].concat());
        assert!(picture.contains("period doubling") && picture.contains("grazing"), "{picture}");
    }
}

#[test]
fn what_has_no_orbits_says_why() {
    let no_wall: [&str; 0] = [];
    let irrational = ["--certify", "--at", "c=0.1,k=1,F=1,w=pi/3,d=1,e=0.8"];
    let passing = ["--certify", "--at", "c=0,k=1,F=1,w=2.8,d=0.05,e=0.8", "--periods", "2"];
    let numbers = ["--at", "c=0.1,k=1,F=1,w=1,d=1"];
    for (equation, wall, others, code, words) in [
        ("x'' + x + 0.5*x^3 = cos(t)", &STOP[..], &no_wall[..], 1, "`0.5*x^3` is not linear"),
        ("x'' + x + 0.5*x^3 = cos(t)", &STOP, &no_wall, 1, "lindstedt simulate"),
        ("x'' + x = cos(t) + cos(2*t)", &STOP, &no_wall, 1, "two frequencies"),
        ("x'' + x = 1", &STOP, &no_wall, 1, "nothing drives"),
        (BEAM, &no_wall, &no_wall, 1, "needs a wall"),
        (BEAM, &["--wall", "x < d"], &no_wall, 2, "coefficient of restitution"),
        (BEAM, &["--wall", "y < d", "--restitution", "e"], &no_wall, 1, "contains no coordinate"),
        (BEAM, &["--wall", "x^2 < d", "--restitution", "e"], &no_wall, 1, "not a number times `x`"),
        (BEAM, &["--wall", "x < d", "--restitution", "1.2"], &numbers, 1, "between 0"),
        (BEAM, &["--wall", "x < d", "--restitution", "-0.2"], &numbers, 1, "between 0"),
        (BEAM, &STOP, &["--impacts", "0"], 2, "--impacts 0"),
        (BEAM, &STOP, &["--periods", "0"], 2, "--periods 0"),
        (BEAM, &STOP, &["--periods", "3:1"], 2, "--periods 3:1"),
        (BEAM, &STOP, &["--at", "c=0.1"], 1, "help: add --at F=VALUE"),
        (BEAM, &STOP, &["--at", "q=1"], 2, "`q` occurs neither"),
        (BEAM, &STOP, &["--format", "csv"], 1, "help: add --at"),
        (BEAM, &STOP, &["--tolerance", "0.1"], 1, "a verdict of orbits needs numbers"),
        (BEAM, &STOP, &["--certify"], 1, "help: add --at"),
        (BEAM, &STOP, &["--certify", "--vary", "F=1:2"], 2, "--certify"),
        (BEAM, &STOP, &["--certify", "--plot", "proof.svg"], 1, "a proof has no picture"),
        (BEAM, &STOP, &irrational, 1, "the frequency of the drive is pi/3, which is no fraction"),
        (BEAM, &STOP, &passing, 1, "no motion follows one"),
        (BEAM, &STOP, &["--format", "rust"], 2, "there is no program here"),
    ] {
        let arguments = [&[equation], wall, others].concat();
        let output = run(&arguments);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(message.contains(words), "{arguments:?}: {message}");
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {message}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
    }
}
