//! What a person reads: lines that fit the terminal, and messages that help on with what was typed.

use std::process::{Command, Output};

fn run(arguments: &[&str], columns: Option<usize>) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lindstedt"));
    command.args(arguments).args(["--timeout", "3600"]).env_remove("COLUMNS");
    if let Some(columns) = columns {
        command.env("COLUMNS", columns.to_string());
    }
    command.output().expect("the program runs")
}

/// Runs a command that has no time limit.
fn run_plain(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lindstedt"));
    command.args(arguments).output().expect("the program runs")
}

fn printed(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("text")
}

/// The numbers of a method do not depend on the width that they are shown in.
#[test]
fn a_comparison_fits_its_terminal() {
    let arguments = ["compare", "x'' + x + 3/10*x^2 + x^3 = 0", "--at", "A=1.5"];
    let (wide, file, narrow) = (
        printed(&run(&arguments, Some(400))),
        printed(&run(&arguments, None)),
        printed(&run(&arguments, Some(80))),
    );
    let longest = |text: &str| text.lines().map(|line| line.chars().count()).max().unwrap_or(0);
    assert!(longest(&wide) > 120 && !wide.contains("Formulas"));
    assert!(longest(&file) <= 120, "{file}");
    assert!(longest(&narrow) <= 80, "{narrow}");
    assert!(file.contains("\nFormulas\n") && narrow.contains("\nFormulas\n"));
    // The same words in the same order, but for the place of the formulas and the breaks of lines.
    let words = |text: &str| {
        let mut words: Vec<String> = text.split_whitespace().map(str::to_owned).collect();
        words.sort();
        words
    };
    assert_eq!(words(&file), words(&narrow));
    // A long formula may take several lines.
    let unbroken = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    for row in wide.lines().filter(|line| line.contains("omega^2 = ")) {
        let formula = &row[row.find("omega^2 = ").expect("a formula")..];
        assert!(unbroken(&file).contains(&unbroken(formula)), "{formula}");
    }
}

#[test]
fn mistakes_on_the_command_line_are_helped() {
    for (arguments, code, expected) in [
        (
            &["derive", "duffing", "--order", "-1"][..],
            2,
            "`-1` is negative; an order is a whole number such as 2",
        ),
        (&["derive", "duffing", "--method", "Lindstedt"], 2, "did you mean `lindstedt-poincare`?"),
        (
            &["derive", "duffing", "--method", "homotopy"],
            2,
            "did you mean `homotopy-perturbation` or `homotopy-analysis`?",
        ),
        (&["derive", "duffing", "--method", "max_min"], 2, "did you mean `max-min`?"),
        (&["derive", "duffing", "--at", "A=1,eps"], 2, "--at A=1,eps"),
        (&["derive", "duffing", "-o", "law.pdf"], 2, "write .html and print it, or .tex"),
        (&["catalog", "dufing"], 2, "did you mean `duffing`?"),
        (&["derive", "duffing", "--taylor", "-3"], 2, "expected a whole number, 1 or more"),
        (&["compare", "duffing", "--tolerance", "-1"], 2, "expected a positive number"),
        (&["derive", "dufing"], 1, "did you mean `duffing`?"),
        (&["derive", "duffing", "--A", "1"], 2, "try `--at A=1`"),
        (&["derive", "duffing", "--eps=0.1"], 2, "try `--at eps=0.1`"),
        (&["derive", "duffing", "--pdf", "x.pdf"], 2, "write a page with `-o FILE.html`"),
        (&["derive", "duffing", "--methods", "lp"], 2, "a similar argument exists: '--method'"),
        (&["simulate", "duffing", "--x0", "1"], 2, "try `--from x=1`"),
        (&["simulate", "duffing", "--tend", "9"], 2, "try `--until 9`"),
        (&["response", "duffing", "--vary", "omega="], 2, "such as omega=0.5:1.5"),
        (&["derive", "duffing", "--at", "A="], 2, "a value is missing after `=`"),
        (&["compare", "duffing"], 1, "add --at eps=VALUE,A=VALUE"),
        (
            &["simulate", "x'' + c*x' + k*x = 0"],
            1,
            "help: --from x=1.5 --at c=VALUE,k=VALUE for a release from rest",
        ),
        (&["derive", "x'' + x = 0, x(0) = 1"], 1, "they are options: `--at A=1` of a formula"),
    ] {
        let output = run(arguments, None);
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(message.contains(expected), "{arguments:?}: {message}");
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {message}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
    }
}

/// An equation in the notation of print is answered as it is in that of the grammar, and how it was
/// read is said.
#[test]
fn notations_of_print_are_read() {
    for (print, grammar) in [
        ("ẍ − μ(1−x²)ẋ + x = 0", "x'' - mu*(1-x^2)*x' + x = 0"),
        ("θ̈ + sin θ = 0", "theta'' + sin(theta) = 0"),
        ("x''(t) + 2x(t) + |x|x = 0", "x'' + 2*x + abs(x)*x = 0"),
    ] {
        let (read, meant) = (run(&["derive", print], None), run(&["derive", grammar], None));
        assert_eq!(read.status.code(), Some(0), "{print}");
        assert_eq!(read.stdout, meant.stdout, "{print}");
        let note = String::from_utf8_lossy(&read.stderr);
        assert_eq!(note, format!("note: the equation is read as {grammar}\n"));
        assert!(run(&["derive", print, "--quiet"], None).stderr.is_empty());
    }
    let [degrees, radians] =
        ["A=60°", "A=pi/3"].map(|at| run(&["derive", "pendulum", "--at", at], None));
    assert!(degrees.status.success() && degrees == radians);
    let [words, name] = ["van der pol", "van-der-pol"].map(|name| run(&["derive", name], None));
    assert!(words.status.success() && words == name);
}

/// Names of formats are also what their files end in.
#[test]
fn formats_are_known_by_their_endings() {
    for (ending, format) in [("tex", "latex"), ("py", "python"), ("txt", "text")] {
        let [short, long] =
            [ending, format].map(|name| run(&["derive", "duffing", "--format", name], None));
        assert!(short.status.success() && short == long, "{ending}");
    }
    let [command, kind] = ["derive", "solution"].map(|name| run_plain(&["schema", name]));
    assert!(command.status.success() && command == kind);
}

/// The words of a command as a shell takes them apart, places below `examples/` in the project.
fn words_of(command: &str) -> Vec<String> {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let words = command.split('"').enumerate().flat_map(|(index, part)| match index % 2 {
        0 => part.split_whitespace().map(str::to_owned).collect(),
        _ => vec![part.to_owned()],
    });
    let in_project = |word: String| match word.strip_prefix("examples/") {
        Some(_) => root.join(word).display().to_string(),
        None => word,
    };
    words.map(in_project).collect()
}

/// Runs every command of an example, the lines that begin with `$ lindstedt`, and holds what the
/// last of them prints to the lines below it: all of it, but for what a line of three points stands
/// for.
fn holds(example: &str, folder: &std::path::Path) {
    let (mut printed, mut shown) = (String::new(), vec![String::new()]);
    for line in example.lines() {
        let Some(command) = line.strip_prefix("$ lindstedt ") else {
            match (line.trim(), shown.last_mut()) {
                ("...", _) => shown.push(String::new()),
                (_, Some(piece)) => *piece += &format!("{line}\n"),
                _ => {}
            }
            continue;
        };
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_lindstedt"))
            .args(words_of(command))
            .current_dir(folder)
            .env("COLUMNS", "90")
            .output()
            .expect("the program starts");
        let both = [output.stdout, output.stderr].concat();
        printed = String::from_utf8(both).expect("text");
    }
    let printed: String = printed.lines().map(|line| line.trim_end().to_owned() + "\n").collect();
    let mut rest = printed.strip_prefix(shown[0].as_str());
    for piece in &shown[1..] {
        rest = rest.and_then(|rest| Some(&rest[rest.find(piece.as_str())? + piece.len()..]));
    }
    let all =
        rest.is_some_and(|rest| rest.is_empty() || shown.last().is_some_and(String::is_empty));
    assert!(all, "{example}\nprints\n{printed}");
}

/// Every help begins with commands and the first lines of what the last of them prints.
#[test]
fn help_begins_with_a_command_and_its_output() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = tempfile::tempdir().expect("a folder");
    let mut count = 0;
    for file in std::fs::read_dir(root.join("src/cli/help")).expect("the folder of examples") {
        let path = file.expect("a file").path();
        let example = std::fs::read_to_string(&path).expect("an example");
        holds(&example, folder.path());
        let name = path.file_stem().and_then(|name| name.to_str()).expect("a name");
        let help = String::from_utf8(run_plain(&[name, "--help"]).stdout).expect("text");
        assert!(help.starts_with(&example), "{help}");
        count += 1;
    }
    assert_eq!(count, 21);
}

/// Every example on a page shows what its command prints in a terminal of 90 characters.
#[test]
fn pages_show_what_commands_print() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = tempfile::tempdir().expect("a folder");
    let below = |folder: &str| {
        let files = std::fs::read_dir(root.join(folder)).expect("a folder of pages");
        files.map(|file| file.expect("a file").path()).collect::<Vec<_>>()
    };
    let mut count = 0;
    for path in [below("docs"), below("docs/methods"), vec![root.join("README.md")]].concat() {
        if path.extension().is_none_or(|ending| ending != "md") {
            continue;
        }
        let page = std::fs::read_to_string(&path).expect("a page");
        let blocks = page.split("```text\n").skip(1).filter_map(|rest| rest.split_once("```"));
        for (block, _) in blocks.filter(|(block, _)| block.starts_with("$ lindstedt")) {
            holds(block, folder.path());
            count += 1;
        }
    }
    assert!(count >= 19, "{count}");
    for method in lindstedt::Method::ALL {
        let page = root.join(format!("docs/methods/{}.md", method.name()));
        assert!(page.exists(), "{page:?}");
    }
}

/// Completions name every command, and the manual page of each is its own.
#[test]
fn shells_and_man_know_the_commands() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = String::from_utf8(run_plain(&["completions", shell]).stdout).expect("text");
        assert!(script.contains("omega-only") && script.contains("certify"), "{shell}");
    }
    let page = |arguments: &[&str]| String::from_utf8(run_plain(arguments).stdout).expect("text");
    assert!(page(&["man"]).contains("certify"));
    let message = run_plain(&["man", "derivation"]).stderr;
    assert!(String::from_utf8_lossy(&message).contains("there is no command `derivation`"));
    let derive = page(&["man", "derive"]);
    assert!(derive.contains("lindstedt-derive") && derive.contains("omega\\-only"), "{derive}");
}

/// The crates whose licences are listed are those that are built, at these versions.
#[test]
fn licences_are_those_of_the_crates_in_use() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |file: &str| std::fs::read_to_string(root.join(file)).expect("a file");
    let (listed, locked) = (read("docs/licences.md"), read("Cargo.lock"));
    let rows = listed
        .lines()
        .filter(|line| line.starts_with("| "))
        .filter(|line| !line.starts_with("| crate") && !line.starts_with("| ---"));
    let mut count = 0;
    for row in rows {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let [_, name, version, licence, _] = cells[..] else { panic!("{row}") };
        let entry = format!("name = \"{name}\"\nversion = \"{version}\"");
        assert!(locked.contains(&entry) && !licence.is_empty(), "{row}: list it anew");
        count += 1;
    }
    assert!(count > 100, "{count}");
}

/// Short forms mean what the long ones do.
#[test]
fn short_forms_mean_the_long_ones() {
    for (short, long) in [
        (
            &["derive", "duffing", "--at", "A=1,eps=0.1"][..],
            &["derive", "duffing", "--at", "A=1", "--at", "eps=0.1"][..],
        ),
        (
            &["derive", "x'' + k*x = 0", "--at", "k=max(1,2), A=1"],
            &["derive", "x'' + k*x = 0", "--at", "k=max(1,2)", "--at", "A=1"],
        ),
        (
            &["derive", "DUFFING", "--method", "HPM"],
            &["derive", "duffing", "--method", "homotopy-perturbation"],
        ),
        (
            &["impact", "--at", "A=1.2,xc=-0.1", "-q"],
            &["impact", "--at", "A=1.2", "--at", "xc=-0.1", "--quiet"],
        ),
    ] {
        let outputs = [short, long].map(|arguments| run(arguments, None));
        assert_eq!(outputs[0].status.code(), Some(0), "{short:?}");
        assert_eq!(outputs[0], outputs[1], "{short:?}");
    }
}

/// Only as much of a file is read as a problem may have, and nobody is told a wrong length.
#[test]
fn a_large_file_is_refused_at_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("large.toml");
    let file = std::fs::File::create(&path).expect("a file");
    file.set_len(100_000_000).expect("room");
    let output = run(&["derive", path.to_str().expect("text")], None);
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        message.contains("the text is longer than the 1048576 bytes that a problem may have"),
        "{message}"
    );
}

/// The first screen says what of the closed form its verdict comes from.
#[test]
fn a_failed_impact_says_why() {
    let text = printed(&run(&["impact"], None));
    let why: Vec<&str> =
        text.lines().skip_while(|line| !line.contains("verdict")).skip(1).collect();
    assert!(text.contains("paper fail, energy fail"));
    assert!(
        why.iter().any(|line| line.contains("paper") && line.contains("speed -6.26 %")),
        "{text}"
    );
    assert!(
        why.iter().any(|line| line.contains("energy") && line.contains("duration +1.64 %")),
        "{text}"
    );
    assert!(!why.iter().any(|line| line.contains("energy") && line.contains(" speed ")), "{text}");
}

/// One row beyond the tolerance fails a table; where all hold, it succeeds.
#[test]
fn a_table_fails_with_its_worst_row() {
    for (tolerance, code) in [("0.5", 0), ("1e-3", 3)] {
        let arguments = ["compare", "x'' + x + x^3 = 0", "--at", "A=1", "--tolerance", tolerance];
        let output = run(&arguments, None);
        assert_eq!(output.status.code(), Some(code), "{}", printed(&output));
        assert_eq!(printed(&output).contains(" fail "), code == 3);
    }
}

/// What is beyond double precision is called that, and where, and not a pole or an end of the
/// force.
#[test]
fn an_overflow_is_called_one() {
    for (equation, amplitude, place, term) in [
        ("x'' + x*exp(x^2) = 0", "2.5e11", "2.5e11", "exp(x^2)"),
        ("x'' + exp(x) - 1 = 0", "2.5e11", "2.5e11", "exp(x)"),
        ("x'' + x + x^99 = 0", "-1e30", "-1e30", "x^99"),
        ("x'' + sinh(x) = 0", "1000", "1e3", "sinh(x)"),
    ] {
        let output = run(
            &["derive", equation, "--method", "exact", "--at", &format!("A={amplitude}")],
            None,
        );
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        let expected = format!(
            "the force overflows at x = {place}: `{term}` is beyond the range of double precision"
        );
        assert!(message.contains(&expected), "{equation}: {message}");
    }
    let table = printed(&run(&["compare", "x'' + x + x^99 = 0", "--at", "A=1e30"], Some(400)));
    assert!(table.contains("not known: the force overflows at x = 1e30: `x^99`"), "{table}");
    assert!(table.contains("w0 is beyond the range of double precision"), "{table}");
    assert!(!table.contains("the force ends") && !table.contains("pole"), "{table}");
    // What escapes is not too stiff.
    let soft =
        ["compare", "x'' - mu*(1 - x^2)*x' + x + eps*x^3 = 0", "--at", "mu=0.1", "--at", "eps=-5"];
    let table = printed(&run(&soft, Some(400)));
    assert!(table.contains("the motion escapes") && !table.contains("stiff"), "{table}");
}
