//! Studies that are split over shards: put together they are what the undivided command prints,
//! byte for byte; what is missing, damaged or of another study is found and said.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::NO_TIME;

fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .args(arguments)
        .current_dir(folder)
        .env("COLUMNS", "100")
        .output()
        .expect("the program starts")
}

fn printed(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {message}");
    String::from_utf8(output.stdout).expect("text")
}

/// The message of a run that ends with this code.
fn refused(folder: &Path, arguments: &[&str], code: i32) -> String {
    let output = run(folder, arguments);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}");
    String::from_utf8(output.stderr).expect("text")
}

/// Runs so many shards of a command, the last one first, and returns the names of their files.
fn split(folder: &Path, command: &[&str], shards: usize) -> Vec<String> {
    let shard = |number: usize| {
        let name = format!("{number}-{shards}.jsonl");
        let option = format!("--shard={number}/{shards}");
        let text = printed(folder, &[command, &[option.as_str()]].concat());
        std::fs::write(folder.join(&name), text).expect("a file");
        name
    };
    (1..=shards).rev().map(shard).collect()
}

fn collect<'a>(files: &'a [String], options: &[&'a str]) -> Vec<&'a str> {
    let files = files.iter().map(String::as_str);
    std::iter::once("collect").chain(options.iter().copied()).chain(files).collect()
}

fn example(name: &str) -> String {
    let path: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples").join(name);
    path.to_string_lossy().into_owned()
}

/// A sweep of four motions.
const SWEEP: [&str; 5] = ["simulate", "--sweep", "zeta=0.01:0.04:2", "--sweep", "barrier=0.1,0.2"];

#[test]
fn any_split_gives_the_bytes_of_the_undivided_run() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let [primary, carried, front, claims] =
        ["primary/driven.toml", "primary/chain.toml", "optimize/front.toml", "audit/paper.toml"]
            .map(example);
    let equation = "x'' + x'/5 + x^3 = F*cos(t)";
    let section = ["--every", "2*pi", "--after", "20", "--until", "40"];
    let commands: [(&[&str], &[&str]); 7] = [
        (&[&SWEEP[..], &["--baseline"]].concat(), &["json", "csv", "text"]),
        (
            &[&["simulate", equation, "--from", "x=1", "--sweep", "F=0:1:10"][..], &section]
                .concat(),
            &["json", "csv", "text"],
        ),
        (&["simulate", &primary, "--sweep", "frequency=18:19:2"], &["json", "csv", "text"]),
        (&["materials"], &["json", "csv", "text"]),
        (&["materials", &carried, "--chain"], &["json", "csv", "text"]),
        (&["optimize", &front, "--quiet"], &["json", "csv", "text"]),
        (&["audit", &claims], &["json", "text"]),
    ];
    for (command, formats) in commands {
        let whole: Vec<String> = formats
            .iter()
            .map(|format| printed(folder, &[command, &["--format", format]].concat()))
            .collect();
        for shards in [1, 3] {
            let files = split(folder, command, shards);
            for (format, whole) in formats.iter().zip(&whole) {
                let joined = printed(folder, &collect(&files, &["--format", format]));
                assert!(joined == *whole, "{command:?} in {shards}, {format}:\n{joined}\n{whole}");
            }
        }
    }
}

#[test]
fn the_file_of_the_problem_comes_with_the_lines() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let file = folder.join("damper.toml");
    std::fs::write(&file, "[damping]\nzeta = 0.02\n").expect("a file");
    let command = ["simulate", "damper.toml", "--sweep", "alpha=0:0.02:3"];
    let whole = printed(folder, &command);
    let files = split(folder, &command, 2);
    // Neither a change of the file nor its loss matters to the lines that are there.
    std::fs::write(&file, "[damping]\nzeta = 0.05\n").expect("a file");
    assert_eq!(printed(folder, &collect(&files, &[])), whole);
    let other = split(folder, &command, 1);
    let message = refused(folder, &collect(&[files.clone(), other].concat(), &[]), 1);
    assert!(message.contains("another text") || message.contains("its identity"), "{message}");
    std::fs::remove_file(&file).expect("a file");
    assert_eq!(printed(folder, &collect(&files, &[])), whole);
}

#[test]
fn what_is_missing_is_found_and_run_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let whole = printed(folder, &SWEEP);
    let files = split(folder, &SWEEP, 3);
    assert_eq!(printed(folder, &collect(&files, &["--missing"])), "");
    // The first shard has points 0 and 3; it is killed in the line of the second.
    let path = folder.join("1-3.jsonl");
    let lines = std::fs::read_to_string(&path).expect("lines");
    std::fs::write(&path, &lines[..lines.len() - 50]).expect("a file");
    let message = refused(folder, &collect(&files, &[]), 1);
    let said = [
        "1 of 4 points are missing",
        "1-3.jsonl, line 3 is cut off",
        "lindstedt simulate --shard=1/3 --sweep=zeta=0.01:0.04:2 --sweep=barrier=0.1,0.2 > 1-3.jsonl",
    ];
    assert!(said.iter().all(|part| message.contains(part)), "{message}");
    assert_eq!(printed(folder, &collect(&files, &["--missing"])), "1/3\n");
    // Its file goes on behind the torn line, and the points that are there twice are one.
    let again = printed(folder, &[&SWEEP[..], &["--shard", "1/3"]].concat());
    std::fs::write(&path, lines[..lines.len() - 50].to_owned() + "\n" + &again).expect("a file");
    assert_eq!(printed(folder, &collect(&files, &[])), whole);
    // A file that is not there is missed as a whole, and lines of another split serve as well.
    let message = refused(folder, &collect(&files[..2], &[]), 1);
    assert!(message.contains("2 of 4 points are missing"), "{message}");
    let other = split(folder, &SWEEP, 4);
    let mixed = [files[..2].to_vec(), other].concat();
    assert_eq!(printed(folder, &collect(&mixed, &[])), whole);
}

#[test]
fn lines_that_do_not_belong_together_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let files = split(folder, &SWEEP, 2);
    let other = ["simulate", "--sweep", "zeta=0.01:0.05:4"];
    let foreign = printed(folder, &[&other[..], &["--shard", "1/2"]].concat());
    std::fs::write(folder.join("other.jsonl"), &foreign).expect("a file");
    let mixed = ["1-2.jsonl".to_owned(), "other.jsonl".to_owned()];
    let message = refused(folder, &collect(&mixed, &[]), 1);
    assert!(message.contains("another study than 1-2.jsonl, line"), "{message}");
    // One digit of one row.
    let text = std::fs::read_to_string(folder.join("2-2.jsonl")).expect("lines");
    let changed = text.replacen("\"impacts\":", "\"impacts\":1", 1);
    std::fs::write(folder.join("changed.jsonl"), changed).expect("a file");
    let all = [files, vec!["changed.jsonl".to_owned()]].concat();
    let message = refused(folder, &collect(&all, &[]), 1);
    assert!(message.contains("changed.jsonl, line 2: point 1 differs from that in"), "{message}");
    // An identity that is not that of what is asked.
    let (head, _) = text.split_once('\n').expect("lines");
    let forged = head.replace("zeta=0.01", "zeta=0.02");
    std::fs::write(folder.join("forged.jsonl"), forged).expect("a file");
    let message = refused(folder, &["collect", "forged.jsonl"], 1);
    assert!(message.contains("forged.jsonl, line 1: this is no line of a shard"), "{message}");
    for (name, text) in [("empty.jsonl", ""), ("torn.jsonl", &text[..20])] {
        std::fs::write(folder.join(name), text).expect("a file");
        let message = refused(folder, &["collect", name], 1);
        assert!(message.contains("there is no line of a shard"), "{message}");
    }
    let message = refused(folder, &["collect", "gone.jsonl"], 1);
    assert!(message.contains("cannot read gone.jsonl"), "{message}");
    assert!(refused(folder, &["collect"], 2).contains("<FILES>"));
    let message = refused(folder, &["collect", "1-2.jsonl", "-o", "1-2.jsonl"], 2);
    assert!(message.contains("it would be overwritten"), "{message}");
    let message = refused(folder, &["collect", "1-2.jsonl", "--tolerance", "0.1"], 2);
    assert!(message.contains("the command that was split"), "{message}");
}

#[test]
fn a_shard_that_cannot_be_is_wrong_usage() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    for shard in ["0/4", "5/4", "1/0", "3", "a/b", "-1/4", "1/2/3", "1/99999999"] {
        let option = format!("--shard={shard}");
        let message = refused(folder, &[&SWEEP[..], &[option.as_str()]].concat(), 2);
        assert!(message.contains("I from 1 to N, such as 3/64"), "{shard}: {message}");
    }
    let cases: [(&[&str], &str); 5] = [
        (&["simulate", "--shard", "1/2"], "--shard splits a sweep"),
        (&[&SWEEP[..], &["--shard", "1/2", "--format", "csv"]].concat(), "lines of JSON"),
        (&[&SWEEP[..], &["--shard", "1/2", "--plot", "a.svg"]].concat(), "lines of JSON"),
        (&["optimize", "--shard", "1/2", "--budget", "5s"], "--budget in seconds"),
        (&["optimize", "--shard", "1/2", "--record", "a.jsonl"], "--record does not go"),
    ];
    for (arguments, part) in cases {
        let message = refused(folder, arguments, 2);
        assert!(message.contains(part), "{arguments:?}: {message}");
    }
}

/// A shard without points says so by its first line, and more shards than points are no harm.
#[test]
fn a_shard_may_be_empty() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let files = split(folder, &SWEEP, 6);
    let text = std::fs::read_to_string(folder.join("6-6.jsonl")).expect("lines");
    assert_eq!(text.lines().count(), 1);
    assert_eq!(printed(folder, &collect(&files, &[])), printed(folder, &SWEEP));
}

/// The exit code is that of the undivided command.
#[test]
fn verdicts_and_parts_keep_their_exit_codes() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let claim =
        "[[claim]]\nid = \"one\"\nquantity = \"value\"\nformula = \"1 + 1\"\nprinted = \"3\"\n";
    std::fs::write(folder.join("claims.toml"), claim).expect("a file");
    let files = split(folder, &["audit", "claims.toml"], 1);
    assert_eq!(run(folder, &["audit", "claims.toml"]).status.code(), Some(3));
    assert_eq!(run(folder, &collect(&files, &[])).status.code(), Some(3));
    // A time limit that is up before the work begins leaves every point undone, and the shard says
    // so. One of a nanosecond would be up only if the work is not done first.
    let message =
        refused(folder, &[&SWEEP[..], &["--shard=1/2", "--timeout", NO_TIME]].concat(), 4);
    assert!(message.contains("0 of 2 points"), "{message}");
}
