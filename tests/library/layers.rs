//! A module uses only those that stand below it: the file tree is the way of the data. Between
//! crates the compiler holds that; here it is held inside of them, and the wall between the judge
//! and the methods with it.
//!
//! Every path of a source that starts at the root of its crate is read: `crate::name`,
//! `crate::{a, b::c}`, a chain of `super` long enough to reach the root, and the names that
//! `lib.rs` hands on (`crate::Oscillator` is the module `oscillator`). Unit tests may look
//! anywhere: they hold one layer against the others.

use std::path::{Path, PathBuf};

/// Which module stands in which layer, lowest first.
struct Layers(Vec<Vec<String>>);

impl Layers {
    /// The layers of the crates, lowest first: the modules of each `lib.rs` in order, those between
    /// two empty lines together.
    fn of_crates() -> Self {
        let mut layers: Vec<Vec<String>> = Vec::new();
        let libraries: Vec<String> =
            source_folders().iter().map(|folder| library(folder)).collect();
        for block in libraries.iter().flat_map(|library| library.split("\n\n")) {
            let names: Vec<String> = block.lines().filter_map(declared).collect();
            if !names.is_empty() {
                layers.push(names);
            }
        }
        Self(layers)
    }

    fn layer(&self, module: &str) -> Option<usize> {
        self.0.iter().position(|modules| modules.iter().any(|name| name == module))
    }
}

/// The members of the workspace by the way of the data, lowest first; the package of the program
/// stands above them all.
const CRATES: [&str; 9] =
    ["numeric", "expr", "series", "dynamics", "oscillator", "modes", "verify", "impact", "fit"];

/// The folders of sources, lowest crate first.
fn source_folders() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let members = CRATES.iter().map(|name| root.join("crates").join(name).join("src"));
    members.chain([root.join("src")]).collect()
}

/// The root of a crate.
fn library(folder: &Path) -> String {
    let path = folder.join("lib.rs");
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Each source file with its path inside its folder of sources.
fn sources() -> Vec<(PathBuf, PathBuf)> {
    let mut sources = Vec::new();
    for folder in source_folders() {
        for file in source_files(&folder) {
            let inside = file.strip_prefix(&folder).expect("a file in src").to_path_buf();
            sources.push((file, inside));
        }
    }
    sources
}

/// The names that the crates hand on from their modules.
fn all_handed_on() -> Vec<(String, String)> {
    source_folders().iter().flat_map(|folder| handed_on(&library(folder))).collect()
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
    let roots = ["crate::".to_owned(), "lindstedt::".to_owned(), "super::".repeat(source.depth)];
    let mut found = Vec::new();
    for root in &roots {
        for (place, _) in code.match_indices(root.as_str()) {
            let before = code[..place].chars().next_back();
            if before
                .is_some_and(|letter| letter.is_alphanumeric() || letter == '_' || letter == ':')
            {
                continue;
            }
            let line = code[..place].matches('\n').count() + 1;
            found.extend(
                first_names(&code[place + root.len()..]).into_iter().map(|name| (line, name)),
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
    path.chars().take_while(|&letter| letter.is_alphanumeric() || letter == '_').collect()
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
            || layers.layer(used).zip(layers.layer(own)).is_some_and(|(used, own)| used < own)
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
        // A whole module of a lower crate keeps its name.
        if path.starts_with("lindstedt_") {
            return None;
        }
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

/// The names on the way from the root of the crate to a file: `series, taylor`; `mod.rs` is its
/// folder.
fn module_path(inside: &Path) -> Vec<String> {
    let names = inside.with_extension("");
    let names = names.components().map(|part| part.as_os_str().to_string_lossy().into_owned());
    names.filter(|name| name != "mod").collect()
}

#[test]
fn lower_layers_never_use_upper_ones() {
    let handed_on = all_handed_on();
    for name in ["Oscillator", "Motion", "Method", "judge"] {
        assert!(handed_on.iter().any(|entry| entry.0 == name), "{name}: {handed_on:?}");
    }
    let layers = Layers::of_crates();
    let (mut wrong, mut seen, mut uses_seen) = (Vec::new(), Vec::new(), 0);
    for (file, inside) in sources() {
        let names = module_path(&inside);
        let module = names.first().expect("a name").as_str();
        if ["lib", "main"].contains(&module) {
            continue;
        }
        let text = std::fs::read_to_string(&file).expect("a source file");
        let source = Source { module, depth: names.len(), text: &text };
        uses_seen += uses(&source, &handed_on).len();
        if layers.layer(module).is_none() {
            wrong.push(format!(
                "{}: belongs to no layer, give it a place in lib.rs",
                file.display()
            ));
        }
        let offences = offences(&source, &handed_on, &layers);
        wrong.extend(offences.iter().map(|offence| format!("{}:{offence}", file.display())));
        seen.push(module.to_owned());
    }
    assert!(wrong.is_empty(), "the layers are broken:\n{}", wrong.join("\n"));
    assert!(seen.len() > 30 && uses_seen > 100, "only {} files with {uses_seen} uses", seen.len());
    // A layer without a file would protect nothing.
    let modules = layers.0.iter().flatten();
    let empty: Vec<_> = modules.filter(|name| !seen.contains(name)).collect();
    assert!(empty.is_empty(), "no file belongs to {empty:?}");
}

/// The members of the workspace are those that are held here, and each uses only those before it:
/// what the compiler holds is the order that is told.
#[test]
fn crates_use_only_those_before_them() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders = std::fs::read_dir(root.join("crates")).expect("crates");
    let mut folders: Vec<String> = folders
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    folders.sort();
    let mut named = CRATES.to_vec();
    named.sort_unstable();
    assert_eq!(folders, named);
    for (place, name) in CRATES.iter().enumerate() {
        let manifest = std::fs::read_to_string(root.join("crates").join(name).join("Cargo.toml"))
            .expect("a manifest");
        let used = manifest.split("[dependencies]").nth(1).expect("dependencies");
        let used = used.split("[dev-dependencies]").next().unwrap_or(used);
        for line in used.lines() {
            let Some(used) = line.strip_prefix("lindstedt-") else {
                continue;
            };
            let used = used.split(['.', ' ']).next().unwrap_or(used);
            assert!(CRATES[..place].contains(&used), "{name} uses {used}");
        }
    }
}

/// The documentation of the crate lists the modules that it hands on, and `ARCHITECTURE.md` all
/// modules crate by crate.
#[test]
fn one_order_is_told_everywhere() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let facade = library(&root.join("src"));
    let row = |line: &str| {
        let name = line.strip_prefix("//! | [`")?.split("`] | ").next()?;
        Some(name.to_owned())
    };
    let mut documented: Vec<String> = facade.lines().filter_map(row).collect();
    let handed = facade.lines().filter_map(|line| {
        let path = line.strip_prefix("pub use lindstedt_")?.strip_suffix(';')?;
        let names = path.split_once("::")?.1.trim_matches(['{', '}']);
        Some(names.split(", ").map(str::to_owned).collect::<Vec<_>>())
    });
    let own = facade.lines().filter(|line| line.starts_with("pub mod ")).filter_map(declared);
    let mut public: Vec<String> = handed.flatten().chain(own).collect();
    documented.sort();
    public.sort();
    assert_eq!(documented, public);
    let page = std::fs::read_to_string(root.join("ARCHITECTURE.md")).expect("ARCHITECTURE.md");
    assert!(page.lines().count() <= 120, "a map is read to its end");
    for folder in source_folders() {
        let text = library(&folder);
        let modules: Vec<String> = text.lines().filter_map(declared).collect();
        let told = |line: &&str| {
            let words: Vec<&str> = line.split_whitespace().collect();
            modules.iter().all(|module| words.contains(&module.as_str()))
        };
        assert!(page.lines().any(|line| told(&line)), "no line of ARCHITECTURE.md has {modules:?}");
    }
}

/// In `numeric` Runge-Kutta stands below the periods and the limit cycles, which do not use each
/// other.
#[test]
fn motions_in_numbers_stand_on_runge_kutta_alone() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("crates/numeric/src/numeric");
    let used = |text: &str| {
        let names = |name: &&str| {
            text.contains(&format!("{name}::")) || text.contains(&format!("numeric::{name};"))
        };
        ["ode", "period", "return_map"].into_iter().filter(names).collect::<Vec<_>>()
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

/// Printed equations, tables and numbers of a publication are data of the audit: no crate has a
/// name for one.
#[test]
fn the_engine_holds_no_publication() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("crates");
    let mut held = Vec::new();
    for (file, _) in sources().into_iter().filter(|(file, _)| file.starts_with(&crates)) {
        let text = std::fs::read_to_string(&file).expect("a source file");
        let numbered = |(place, name): (usize, &str)| {
            text[place + name.len()..].starts_with(|digit: char| digit.is_ascii_digit())
        };
        let of_a_table =
            ["Table ", "TABLE_"].iter().any(|name| text.match_indices(name).any(numbered));
        if of_a_table || text.contains("PRINTED_") {
            held.push(file);
        }
    }
    assert_eq!(held, Vec::<PathBuf>::new());
}

/// The crate of the integers of any length is named where numbers live: elsewhere they are
/// `exact::Integer`.
#[test]
fn long_integers_come_from_one_place() {
    let named = |(file, _): &(PathBuf, PathBuf)| {
        let text = std::fs::read_to_string(file).expect("a source file");
        ["dashu_int", "num_rational"].iter().any(|name| text.contains(name))
    };
    let files = sources().into_iter().filter(named).map(|(_, inside)| inside);
    let (inside, outside): (Vec<_>, Vec<_>) = files.partition(|file| file.starts_with("exact"));
    assert!(!inside.is_empty());
    assert_eq!(outside, Vec::<PathBuf>::new());
}

/// The files that make the judge's truth. They know which motion is meant, never how a formula came
/// about.
const TRUTH: [&str; 7] = [
    "numeric/period.rs",
    "numeric/periodic.rs",
    "numeric/return_map.rs",
    "verify/amplitude_series.rs",
    "verify/backbone.rs",
    "verify/free_motion.rs",
    "verify/orbit.rs",
];

/// What those in `verify` may use of it besides each other: the error type that they share with the
/// judge.
const OF_THE_JUDGE: [&str; 1] = ["VerificationError"];

/// What they may use of `solution`: plain data.
const OF_AN_ANSWER: [&str; 1] = ["AmplitudeConvention"];

/// The modules of `numeric` that are truth as a whole: only those that judge use them, `verify` and
/// `response`, so that no answer comes by a detour.
const TRUE_MODULES: [&str; 3] = ["period", "periodic", "return_map"];

/// What crosses the wall between the methods and the truth, as messages: `file` is the path of a
/// source in `src/`.
fn over_the_wall(file: &str, text: &str, handed_on: &[(String, String)]) -> Vec<String> {
    let names = module_path(Path::new(file));
    let source =
        Source { module: names.first().map_or("", String::as_str), depth: names.len(), text };
    let makes_truth = TRUTH.contains(&file);
    let code = without_comments(without_unit_tests(text));
    // The names behind every `root`, with their lines.
    let behind = |root: &str| -> Vec<Use> {
        let places = code.match_indices(root).map(|(place, _)| place);
        let names = |place: usize| {
            let line = code[..place].matches('\n').count() + 1;
            let names = first_names(&code[place + root.len()..]);
            names.into_iter().map(move |name| (line, name))
        };
        places.flat_map(names).collect()
    };
    let mut found = Vec::new();
    let mut refuse = |root: &str, allowed: &dyn Fn(&str) -> bool| {
        let wrong = behind(root).into_iter().filter(|(_, name)| !allowed(name));
        found.extend(wrong.map(|(line, name)| format!("{line}: uses `{root}{name}`")));
    };
    if !["verify", "response"].contains(&source.module) && !makes_truth {
        let no_truth = |name: &str| !TRUE_MODULES.contains(&name);
        refuse("numeric::", &no_truth);
        if source.module == "numeric" {
            refuse("super::", &no_truth);
        }
    }
    if makes_truth {
        let stem = |file: &&str| module_path(Path::new(file)).pop().unwrap_or_default();
        let truths: Vec<String> = TRUTH.iter().map(stem).collect();
        let of_verify =
            |name: &str| OF_THE_JUDGE.contains(&name) || truths.iter().any(|truth| truth == name);
        refuse("super::", &of_verify);
        refuse("crate::verify::", &of_verify);
        refuse("crate::solution::", &|name| OF_AN_ANSWER.contains(&name));
        let lines: Vec<&str> = code.lines().collect();
        for (line, name) in uses(&source, handed_on) {
            let root = format!("crate::{name}::");
            // By any other path it is not seen what of it is used.
            let hidden =
                ["solution", "verify"].contains(&name.as_str()) && !lines[line - 1].contains(&root);
            if name == "method" || hidden {
                found.push(format!("{line}: uses `{name}`"));
            }
        }
    }
    found
}

/// What is judged and the judge share numbers and the equation, not a way to the answer.
#[test]
fn the_judge_and_the_methods_share_no_truth() {
    let handed_on = all_handed_on();
    let (mut wrong, mut truths) = (Vec::new(), 0);
    for (path, inside) in sources() {
        let file: Vec<_> = inside.iter().map(|part| part.to_string_lossy()).collect();
        let file = file.join("/");
        truths += usize::from(TRUTH.contains(&file.as_str()));
        let text = std::fs::read_to_string(&path).expect("a source file");
        let crossed = over_the_wall(&file, &text, &handed_on);
        wrong.extend(crossed.iter().map(|message| format!("{file}:{message}")));
    }
    assert!(wrong.is_empty(), "the wall is broken:\n{}", wrong.join("\n"));
    assert_eq!(truths, TRUTH.len(), "a file of the truth is gone");
}

#[test]
fn a_hole_in_the_wall_is_seen() {
    let handed_on =
        handed_on("pub use method::{Options, solve};\npub use solution::{Method, Solution};\n");
    for (file, text, expected) in [
        ("numeric/period.rs", "use crate::method::numbers;", "1: uses `method`"),
        ("numeric/return_map.rs", "\nlet law = crate::solve(&x);", "2: uses `method`"),
        ("verify/orbit.rs", "use super::super::method::one_term;", "1: uses `method`"),
        (
            "verify/orbit.rs",
            "use super::{VerificationError, formula_frequency};",
            "1: uses `super::formula_frequency`",
        ),
        (
            "verify/free_motion.rs",
            "use crate::solution::{AmplitudeConvention, Law};",
            "1: uses `crate::solution::Law`",
        ),
        ("verify/backbone.rs", "use crate::verify::judge;", "1: uses `crate::verify::judge`"),
        ("verify/backbone.rs", "use crate::Solution;", "1: uses `solution`"),
        ("verify/free_motion.rs", "use crate::{solution::Law, symbol};", "1: uses `solution`"),
        (
            "method/exact.rs",
            "use crate::numeric::period::conservative_period;",
            "1: uses `numeric::period`",
        ),
        (
            "method/limit_cycle.rs",
            "\nuse super::super::numeric::{ode, return_map};",
            "2: uses `numeric::return_map`",
        ),
        (
            "conservative/motion.rs",
            "use crate::{expr::Expr, numeric::period};",
            "1: uses `numeric::period`",
        ),
    ] {
        let found = over_the_wall(file, text, &handed_on);
        assert!(found.iter().any(|message| message == expected), "{file}: {text}: {found:?}");
    }
    for (file, text) in [
        (
            "verify/mod.rs",
            "use crate::method::numbers::evaluate;\nuse crate::numeric::period::PeriodError;",
        ),
        (
            "verify/orbit.rs",
            "use super::VerificationError;\nuse crate::solution::AmplitudeConvention; // method",
        ),
        (
            "verify/backbone.rs",
            "use super::orbit::{NumericOscillator, OrbitTarget};\nuse crate::conservative::well::Well;",
        ),
        (
            "method/exact.rs",
            "use super::numbers::evaluate;\nuse crate::numeric::ode::energy::PeriodError;",
        ),
        ("response/cycle.rs", "use crate::numeric::periodic::Shooting;"),
        (
            "numeric/period.rs",
            "use crate::numeric::ode::root;\n#[cfg(test)]\nmod tests {\n    use crate::method::solve;\n}\n",
        ),
    ] {
        assert_eq!(over_the_wall(file, text, &handed_on), Vec::<String>::new(), "{file}: {text}");
    }
}

#[test]
fn an_upward_use_is_seen() {
    let handed_on =
        handed_on("pub use oscillator::Oscillator;\npub mod numeric;\npub use symbol::Symbol;\n");
    let layers = Layers::of_crates();
    let found = |module: &str, depth: usize, text: &str| {
        offences(&Source { module, depth, text }, &handed_on, &layers)
    };
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
        ("method", 2, "use super::secular::expand;\nuse crate::{Symbol, expr::Expr};"),
        ("expr", 2, "use crate::expr::Node;\nuse super::number;"),
        ("cli", 2, "use crate::export::{json, text};\nuse super::Common;"),
        ("exact", 2, "let x = 1;\n#[cfg(test)]\nmod tests {\n    use crate::method::solve;\n}\n"),
    ] {
        assert_eq!(found(module, depth, text), Vec::<String>::new(), "{text}");
    }
}

/// Every file of the repository, by its path from the root.
fn files_below(folder: &Path, found: &mut Vec<String>) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for entry in std::fs::read_dir(root.join(folder)).expect("a folder") {
        let entry = entry.expect("an entry");
        let path = folder.join(entry.file_name());
        found.push(path.to_str().expect("a path in text").to_owned());
        if entry.file_type().expect("a type").is_dir() {
            files_below(&path, found);
        }
    }
}

/// Names that Windows keeps for devices or does not allow, and names that differ by case alone,
/// cannot be checked out everywhere.
#[test]
fn every_file_can_be_checked_out_on_every_system() {
    const DEVICES: [&str; 6] = ["con", "prn", "aux", "nul", "conin$", "conout$"];
    let mut files = Vec::new();
    for folder in ["src", "crates", "tests", "examples", "docs", "snapshots", "benches"] {
        files_below(Path::new(folder), &mut files);
    }
    assert!(files.len() > 1000, "{}", files.len());
    let mut lower = std::collections::BTreeSet::new();
    for file in &files {
        let name = file.rsplit(['/', '\\']).next().unwrap_or(file).to_lowercase();
        let stem = name.split('.').next().unwrap_or(&name);
        let is_port = |stem: &str| {
            let number = stem.strip_prefix("com").or(stem.strip_prefix("lpt"));
            number.is_some_and(|number| {
                number.len() == 1 && number.chars().all(|digit| digit.is_ascii_digit())
            })
        };
        assert!(!DEVICES.contains(&stem) && !is_port(stem), "{file} is a device");
        let is_allowed =
            |letter: char| (' '..='~').contains(&letter) && !r#"<>:"|?*"#.contains(letter);
        assert!(name.chars().all(is_allowed) && !name.ends_with(['.', ' ']), "{file}");
        assert!(lower.insert(file.to_lowercase()), "{file} differs by case alone");
    }
}
