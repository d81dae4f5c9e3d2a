//! Nothing is silently ignored: every option of every command and every key of every file either
//! changes what comes out or is refused by name.

mod keys;
mod options;
mod sweeps;

use std::path::PathBuf;
use std::process::{Command, Output};

/// Exit code, standard output, standard error.
type Answer = (Option<i32>, String, String);

fn run(arguments: &[&str]) -> Answer {
    let Output { status, stdout, stderr } = Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .args(arguments)
        .output()
        .expect("the program starts");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("text");
    (status.code(), text(stdout), text(stderr))
}

fn is_refused(answer: &Answer, word: &str) -> bool {
    matches!(answer.0, Some(1 | 2)) && answer.1.is_empty() && answer.2.contains(word)
}

/// A file of its own for each test.
fn path(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("lindstedt-unread-{name}-{}.toml", std::process::id()))
}

fn of_file(name: &str, text: &str, arguments: &[&str]) -> Answer {
    let path = path(name);
    std::fs::write(&path, text).expect("a file");
    let answer = run(&[
        &arguments[..1],
        &[path.to_str().expect("a path in text")],
        &arguments[1..],
    ]
    .concat());
    std::fs::remove_file(path).expect("the file goes");
    answer
}
