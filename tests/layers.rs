//! A module uses only those that stand above it in `src/lib.rs`: the file tree is the way of the data.

use std::path::{Path, PathBuf};

/// The layers, lowest first; one line may hold several that do not use each other.
const LAYERS: [&[&str]; 15] = [
    &["symbol", "spelling"],
    &["exact"],
    &["decimal"],
    &["expr", "ode"],
    &["series"],
    &["solution"],
    &["oscillator"],
    &["equilibrium"],
    &["method"],
    &["verify"],
    &["contact"],
    &["impact"],
    &["problem"],
    &["catalog"],
    &["export"],
];

fn layer(module: &str) -> Option<usize> {
    LAYERS.iter().position(|modules| modules.contains(&module))
}

/// The modules that a line of the module `own` uses and may not.
fn offences<'a>(own: &str, line: &'a str) -> Vec<&'a str> {
    let code = line.split("//").next().unwrap_or(line);
    let used = code.split("crate::").skip(1).filter_map(|rest| {
        let end = rest
            .find(|letter: char| !(letter.is_alphanumeric() || letter == '_'))
            .unwrap_or(rest.len());
        Some(&rest[..end]).filter(|name| name.starts_with(|letter: char| letter.is_lowercase()))
    });
    let allowed = |used: &str| used == own || layer(used).zip(layer(own)).is_some_and(|(used, own)| used < own);
    used.filter(|used| !allowed(used)).collect()
}

fn source_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder)
        .expect("a folder of sources")
        .filter_map(Result::ok)
    {
        let path = entry.path();
        if path.is_dir() {
            files.extend(source_files(&path))
        } else {
            files.push(path)
        }
    }
    files.sort();
    files
}

#[test]
fn lower_layers_never_use_upper_ones() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut seen = 0;
    for file in source_files(&source) {
        let inside = file.strip_prefix(&source).expect("a file in src");
        let first = inside
            .components()
            .next()
            .expect("a name")
            .as_os_str()
            .to_string_lossy()
            .into_owned();
        let own = first.trim_end_matches(".rs");
        if ["lib", "main", "cli"].contains(&own) {
            continue;
        }
        assert!(
            layer(own).is_some(),
            "{} belongs to no layer: give it a place in this test",
            inside.display()
        );
        let text = std::fs::read_to_string(&file).expect("a source file");
        // Tests may look anywhere: they hold a layer against the others.
        let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or(&text);
        for (number, line) in code.lines().enumerate() {
            let wrong = offences(own, line);
            assert!(
                wrong.is_empty(),
                "{}:{}: `{own}` uses {wrong:?}",
                inside.display(),
                number + 1
            );
        }
        seen += 1;
    }
    assert!(seen > 30, "only {seen} files");
}

#[test]
fn an_upward_use_is_seen() {
    assert_eq!(offences("series", "use crate::method::solve;"), ["method"]);
    assert_eq!(offences("ode", "let x = crate::expr::Expr::zero();"), ["expr"]);
    assert!(offences("method", "use crate::series::taylor::taylor; // crate::verify").is_empty());
    assert!(offences("expr", "use crate::expr::Node;").is_empty());
}
