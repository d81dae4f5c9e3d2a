//! `lindstedt absorber`: formats, verdicts and refusals.

use std::process::{Command, Output};

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .arg("absorber")
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

/// Values of each kind.
const KINDS: [[&str; 2]; 6] = [
    ["tuned", "mu=1/20"],
    ["nonlinear", "mu=1/20,alpha3=1,F=1/100"],
    ["impact-sink", "r=0.65,b=1,mu=1/100"],
    ["cubic-sink", "lambda=0.2,k=1,eps=1/100"],
    ["damped", "mu=1/20,zeta_1=1/100"],
    ["pendulum-sink", "r=0.65,b=1,w=1/2,mu=1/100"],
];

#[test]
fn absorbers_as_text() {
    in_snapshots(|| {
        for [kind, _] in KINDS {
            insta::assert_snapshot!(format!("absorber-{kind}"), printed(&[kind]));
        }
        insta::assert_snapshot!("absorber-ground", printed(&["tuned", "--excitation", "ground"]));
        insta::assert_snapshot!("absorber-latex", printed(&["tuned", "--format", "latex"]));
        insta::assert_snapshot!("help-absorber", printed(&["--help"]));
    });
}

#[test]
fn every_kind_of_absorber_has_every_format() {
    for [kind, at] in KINDS {
        let table = printed(&[kind, "--at", at, "--format", "csv"]);
        assert!(table.contains("curve,kind,label,x,y"), "{table}");
        let page = printed(&[kind, "--at", at, "--format", "html"]);
        assert_eq!(page.contains("<svg"), cfg!(feature = "plot"));
        let letters = printed(&[kind, "--format", "json"]);
        assert!(letters.contains("\"verdict\": null"), "{letters}");
    }
}

#[test]
fn a_verdict_is_an_exit_code() {
    let [kind, at] = KINDS[3];
    assert_eq!(run(&[kind, "--at", at]).status.code(), Some(0));
    assert_eq!(run(&[kind, "--at", at, "--tolerance", "0.001"]).status.code(), Some(3));
    assert_eq!(run(&[kind, "--at", at, "--tolerance", "0.05"]).status.code(), Some(0));
    // What is not found is neither a pass nor a fail.
    let sought = run(&["tuned", "--at", "mu=1/100000000"]);
    assert_eq!(sought.status.code(), Some(4));
    assert!(String::from_utf8_lossy(&sought.stdout).contains("not judged"));
}

#[test]
fn what_an_absorber_cannot_be_says_why() {
    for (arguments, code, words) in [
        (
            vec!["tuned", "--at", "mu=-1/20"],
            1,
            "mu = -1/20: the mass ratio is positive\n  --at mu=-1/20\n          ^^^^^\n  help: such as mu=1/20",
        ),
        (vec!["tuned", "--at", "mu=0"], 1, "--at mu=0\n          ^\n"),
        (
            vec!["impact-sink", "--at", "b=1", "--at", "r=1.2,mu=1/100"],
            1,
            "r = 6/5: the coefficient of restitution is above 0 and below 1\n  --at r=1.2\n         ^^^\n",
        ),
        (vec!["impact-sink", "--at", "r=0,b=1,mu=1/100"], 1, "above 0 and below 1"),
        (
            vec!["impact-sink", "--at", "r=0.5"],
            1,
            "`b`, `mu` have no value\n  help: add --at b=1,mu=1/100",
        ),
        (vec!["cubic-sink", "--at", "lambda=0.6,k=1,eps=0.01"], 1, "above 0 and below 0.577"),
        (
            vec!["nonlinear", "--at", "mu=1/20,alpha3=-1,F=1/100"],
            1,
            "alpha3 = -1: the cubic coefficient of a main mass that stiffens is positive\n  --at alpha3=-1\n              ^^\n",
        ),
        (vec!["nonlinear", "--at", "mu=2,alpha3=1,F=1/100"], 1, "at least 0.001 and at most 1"),
        (vec!["nonlinear", "--at", "mu=1/20"], 1, "help: add --at alpha3=1,F=1/100"),
        (vec!["nonlinear", "--excitation", "ground"], 2, "--excitation says nothing to nonlinear"),
        (vec!["tuned", "--at", "nu=1"], 2, "`nu` is no letter of this absorber"),
        (vec!["tuned", "--at", "mu=k"], 2, "contains `k`"),
        (vec!["tuned", "--tolerance", "0.1"], 1, "a verdict of an absorber needs numbers"),
        (vec!["tuned", "--format", "csv"], 1, "help: add --at mu=1/20"),
        (
            vec!["impact-sink", "--excitation", "ground"],
            2,
            "--excitation says nothing to impact-sink",
        ),
        (vec!["tuned", "--format", "rust"], 2, "there is no program here"),
        (vec!["tunde"], 2, "'tuned'"),
        (vec![], 2, "<KIND>"),
    ] {
        let output = run(&arguments);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(message.contains(words), "{arguments:?}: {message}");
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {message}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
    }
}
