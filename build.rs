//! The version of the program, with the commit that it is built from where that is known.

use std::process::Command;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=.git/HEAD");
    let package = env!("CARGO_PKG_VERSION");
    let commit = Command::new("git").args(["rev-parse", "--short=9", "HEAD"]).output().ok();
    let commit = commit.filter(|output| output.status.success());
    let commit = commit.and_then(|output| String::from_utf8(output.stdout).ok());
    let version = match commit.as_deref().map(str::trim) {
        Some(commit) if !commit.is_empty() => format!("{package} ({commit})"),
        _ => package.to_owned(),
    };
    println!("cargo:rustc-env=LINDSTEDT_VERSION={version}");
}
