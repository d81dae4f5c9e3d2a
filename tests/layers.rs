//! A module uses only those that stand below it: the file tree is the way of the data.
//!
//! Every path in `src/` that starts at the root of the crate is read: `crate::name`, `crate::{a, b::c}`, a chain of
//! `super` long enough to reach the root, and the names that `lib.rs` hands on (`crate::Oscillator` is the module
//! `oscillator`). Unit tests may look anywhere: they hold one layer against the others.

use std::path::{Path, PathBuf};

/// Which module stands in which layer, lowest first.
struct Layers(Vec<Vec<String>>);

impl Layers {
    /// The layers of `lib.rs`: its modules in order, those between two empty lines together, and on top of them the program.
    fn of(library: &str) -> Self {
        let mut layers: Vec<Vec<String>> = Vec::new();
        for block in library.split("\n\n") {
            let names: Vec<String> = block.lines().filter_map(declared).collect();
            if !names.is_empty() {
                layers.push(names);
            }
        }
        layers.push(vec!["cli".to_owned()]);
        Self(layers)
    }

    fn of_crate() -> Self {
        let library = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/lib.rs");
        Self::of(&std::fs::read_to_string(library).expect("src/lib.rs"))
    }

    fn layer(&self, module: &str) -> Option<usize> {
        self.0
            .iter()
            .position(|modules| modules.iter().any(|name| name == module))
    }
}

/// The module that a line declares, public or not.
fn declared(line: &str) -> Option<String> {
    let name = line.trim_start_matches("pub ").strip_prefix("mod ")?;
    Some(name.strip_suffix(';')?.to_owned())
}

/// One source file: which module it belongs to and how many `super` lead from it to the root.
struct Source<'a> {
    module: &'a str,
    depth: usize,
    text: &'a str,
}

/// A use of another module: line, counted from one, and the name after the root.
type Use = (usize, String);

/// Every module of the crate that a text names by a path from the root.
fn uses(source: &Source, handed_on: &[(String, String)]) -> Vec<Use> {
    let code = without_comments(without_unit_tests(source.text));
    let roots = [
        "crate::".to_owned(),
        "lindstedt::".to_owned(),
        "super::".repeat(source.depth),
    ];
    let mut found = Vec::new();
    for root in &roots {
        for (place, _) in code.match_indices(root.as_str()) {
            let before = code[..place].chars().next_back();
            if before.is_some_and(|letter| letter.is_alphanumeric() || letter == '_' || letter == ':') {
                continue;
            }
            let line = code[..place].matches('\n').count() + 1;
            found.extend(
                first_names(&code[place + root.len()..])
                    .into_iter()
                    .map(|name| (line, name)),
            );
        }
    }
    found.sort();
    found.dedup();
    let module = |name: String| {
        let handed = handed_on.iter().find(|entry| entry.0 == name);
        handed.map_or(name, |entry| entry.1.clone())
    };
    found.into_iter().map(|(line, name)| (line, module(name))).collect()
}

/// `a` of `a::b`, or `a` and `c` of `{a::b, c::{d, e}}`.
fn first_names(path: &str) -> Vec<String> {
    let Some(group) = path.strip_prefix('{') else {
        return vec![leading_name(path)];
    };
    let (mut depth, mut names, mut expecting) = (0, Vec::new(), true);
    for (place, letter) in group.char_indices() {
        match letter {
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            '{' => depth += 1,
            ',' if depth == 0 => expecting = true,
            _ if expecting && depth == 0 && !letter.is_whitespace() => {
                names.push(leading_name(&group[place..]));
                expecting = false;
            }
            _ => {}
        }
    }
    names
}

fn leading_name(path: &str) -> String {
    path.chars()
        .take_while(|&letter| letter.is_alphanumeric() || letter == '_')
        .collect()
}

fn without_unit_tests(text: &str) -> &str {
    text.split("#[cfg(test)]\nmod tests").next().unwrap_or(text)
}

/// Comments blanked line by line, so that the lines keep their numbers.
fn without_comments(text: &str) -> String {
    let line = |line: &str| line.split("//").next().unwrap_or(line).to_owned();
    text.lines().map(line).collect::<Vec<_>>().join("\n")
}

/// The uses that are not allowed, as messages that name the line.
fn offences(source: &Source, handed_on: &[(String, String)], layers: &Layers) -> Vec<String> {
    let own = source.module;
    let allowed = |used: &str| {
        used == own
            || layers
                .layer(used)
                .zip(layers.layer(own))
                .is_some_and(|(used, own)| used < own)
    };
    uses(source, handed_on)
        .into_iter()
        .filter(|(_, used)| !allowed(used))
        .map(|(line, used)| match layers.layer(&used) {
            Some(_) => format!("{line}: `{own}` uses `{used}`, which is not below it"),
            None => format!("{line}: `{own}` uses `{used}`, which belongs to no layer"),
        })
        .collect()
}

/// The names that `lib.rs` hands on from a module: `pub use solution::{Method, Solution};`.
fn handed_on(library: &str) -> Vec<(String, String)> {
    let line = |line: &str| {
        let path = line.strip_prefix("pub use ")?.strip_suffix(';')?;
        let (module, names) = path.split_once("::")?;
        let names = names.rsplit("::").next()?.trim_matches(['{', '}']);
        let module = module.to_owned();
        Some(
            names
                .split(", ")
                .map(move |name| (name.to_owned(), module.clone()))
                .collect::<Vec<_>>(),
        )
    };
    library.lines().filter_map(line).flatten().collect()
}

fn source_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder of sources") {
        let path = entry.expect("an entry that can be read").path();
        if path.is_dir() {
            files.extend(source_files(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    files.sort();
    files
}

/// The names on the way from the root of the crate to a file: `series, taylor`; `mod.rs` is its folder.
fn module_path(inside: &Path) -> Vec<String> {
    let names = inside.with_extension("");
    let names = names
        .components()
        .map(|part| part.as_os_str().to_string_lossy().into_owned());
    names.filter(|name| name != "mod").collect()
}

#[test]
fn lower_layers_never_use_upper_ones() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let library = std::fs::read_to_string(folder.join("lib.rs")).expect("src/lib.rs");
    let handed_on = handed_on(&library);
    for name in ["Oscillator", "Motion", "Method", "judge"] {
        assert!(handed_on.iter().any(|entry| entry.0 == name), "{name}: {handed_on:?}");
    }
    let layers = Layers::of(&library);
    let (mut wrong, mut seen, mut uses_seen) = (Vec::new(), Vec::new(), 0);
    for file in source_files(&folder) {
        let inside = file.strip_prefix(&folder).expect("a file in src");
        let names = module_path(inside);
        let module = names.first().expect("a name").as_str();
        if ["lib", "main"].contains(&module) {
            continue;
        }
        let text = std::fs::read_to_string(&file).expect("a source file");
        let source = Source {
            module,
            depth: names.len(),
            text: &text,
        };
        uses_seen += uses(&source, &handed_on).len();
        if layers.layer(module).is_none() {
            wrong.push(format!(
                "src/{}: belongs to no layer, give it a place in src/lib.rs",
                inside.display()
            ));
        }
        let offences = offences(&source, &handed_on, &layers);
        wrong.extend(
            offences
                .iter()
                .map(|offence| format!("src/{}:{offence}", inside.display())),
        );
        seen.push(module.to_owned());
    }
    assert!(wrong.is_empty(), "the layers are broken:\n{}", wrong.join("\n"));
    assert!(
        seen.len() > 30 && uses_seen > 100,
        "only {} files with {uses_seen} uses",
        seen.len()
    );
    // A layer without a file would protect nothing.
    let modules = layers.0.iter().flatten();
    let empty: Vec<_> = modules.filter(|name| !seen.contains(name)).collect();
    assert!(empty.is_empty(), "no file in src/ belongs to {empty:?}");
}

/// The documentation of the crate lists the public modules, and `ARCHITECTURE.md` all of them, as `lib.rs` declares them.
#[test]
fn one_order_is_told_everywhere() {
    let read = |name: &str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
        std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{name}: {error}"))
    };
    let layers = Layers::of_crate().0;
    let row = |line: &str| {
        let name = line.strip_prefix("//! | [`")?.split("`] | ").next()?;
        Some(name.to_owned())
    };
    let library = read("src/lib.rs");
    let documented: Vec<String> = library.lines().filter_map(row).collect();
    let public = library.lines().filter(|line| line.starts_with("pub mod "));
    assert_eq!(documented, public.filter_map(declared).collect::<Vec<_>>());
    let row = |line: &str| {
        let names = line.strip_prefix("    ")?.split("  ").next()?;
        Some(names.split(' ').map(str::to_owned).collect())
    };
    let page = read("ARCHITECTURE.md");
    let first = page.split("\n## ").next().unwrap_or(&page);
    let drawn: Vec<Vec<String>> = first.lines().filter_map(row).collect();
    assert_eq!(drawn, layers);
}

/// In `numeric` Runge-Kutta stands below the periods and the limit cycles, which do not use each other.
#[test]
fn motions_in_numbers_stand_on_runge_kutta_alone() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/numeric");
    let used = |text: &str| {
        let names = |name: &&str| text.contains(&format!("{name}::")) || text.contains(&format!("numeric::{name};"));
        ["ode", "period", "return_map"]
            .into_iter()
            .filter(names)
            .collect::<Vec<_>>()
    };
    assert_eq!(used("use crate::numeric::return_map;"), ["return_map"]);
    for file in source_files(&folder) {
        let names = module_path(file.strip_prefix(&folder).expect("a file in numeric"));
        let Some(own) = names.first() else { continue };
        let text = std::fs::read_to_string(&file).expect("a source file");
        let above = used(&without_comments(without_unit_tests(&text))).into_iter();
        let above: Vec<&str> = above.filter(|name| *name != "ode" && name != own).collect();
        assert_eq!(above, Vec::<&str>::new(), "{}", file.display());
    }
}

/// The crate of the integers of any length is named where numbers live: elsewhere they are `exact::Integer`.
#[test]
fn long_integers_come_from_one_place() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let named = |file: &PathBuf| {
        let text = std::fs::read_to_string(file).expect("a source file");
        ["num_bigint", "num_rational"].iter().any(|name| text.contains(name))
    };
    let files = source_files(&folder).into_iter().filter(named);
    let (inside, outside): (Vec<_>, Vec<_>) = files.partition(|file| file.starts_with(folder.join("exact")));
    assert!(!inside.is_empty());
    assert_eq!(outside, Vec::<PathBuf>::new());
}

#[test]
fn an_upward_use_is_seen() {
    let handed_on = handed_on("pub use oscillator::Oscillator;\npub mod numeric;\npub use symbol::Symbol;\n");
    let layers = Layers::of_crate();
    let found = |module: &str, depth: usize, text: &str| offences(&Source { module, depth, text }, &handed_on, &layers);
    for (module, depth, text, line, used) in [
        ("series", 2, "use crate::method::solve;", 1, "method"),
        ("numeric", 3, "\nlet x = crate::expr::Expr::zero();", 2, "expr"),
        ("numeric", 1, "use crate::exact::Rational;", 1, "exact"),
        (
            "exact",
            1,
            "fn f() {}\n\nuse crate::{\n    symbol::Symbol,\n    verify::{judge, Values},\n};",
            3,
            "verify",
        ),
        ("expr", 1, "use crate::Oscillator;", 1, "oscillator"),
        ("expr", 3, "use super::super::super::series::taylor;", 1, "series"),
        ("symbol", 1, "use super::exact::Ring;", 1, "exact"),
        ("export", 2, "crate::cli::run()", 1, "cli"),
        (
            "expr",
            1,
            "use crate::numeric; // crate::symbol\nuse crate::unheard_of::Thing;",
            2,
            "unheard_of",
        ),
    ] {
        let offences = found(module, depth, text);
        assert_eq!(offences.len(), 1, "{text}: {offences:?}");
        let expected = format!("{line}: `{module}` uses `{used}`, which ");
        assert!(offences[0].starts_with(&expected), "{text}: {offences:?}");
    }
    for (module, depth, text) in [
        ("method", 2, "use crate::series::taylor::taylor; // crate::verify"),
        (
            "method",
            2,
            "use super::secular::expand;\nuse crate::{Symbol, expr::Expr};",
        ),
        ("expr", 2, "use crate::expr::Node;\nuse super::number;"),
        ("cli", 2, "use lindstedt::export::{json, text};\nuse super::Common;"),
        (
            "exact",
            2,
            "let x = 1;\n#[cfg(test)]\nmod tests {\n    use crate::method::solve;\n}\n",
        ),
    ] {
        assert_eq!(found(module, depth, text), Vec::<String>::new(), "{text}");
    }
}
