//! Pages: whole, of formulas that are set, with the numbers of the text and the picture of
//! `--plot`, and nothing from elsewhere.

use std::path::{Path, PathBuf};
use std::process::Command;

fn run(arguments: &[&str]) -> std::process::Output {
    Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("the program starts")
}

fn result(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}

fn page(arguments: &[&str]) -> String {
    result(&[arguments, &["--format", "html"]].concat())
}

/// Every element that is opened is closed, in order; the elements that are there.
fn elements(page: &str) -> Vec<String> {
    const EMPTY: [&str; 3] = ["meta", "!doctype", "br"];
    let (mut open, mut found) = (Vec::new(), Vec::new());
    for piece in page.split('<').skip(1) {
        let (tag, text) = piece.split_once('>').expect("a tag has an end");
        assert!(!text.contains('>') || open.last().is_some_and(|own| own == "style"), "{text}");
        let name: String = tag
            .trim_start_matches('/')
            .chars()
            .take_while(|letter| !letter.is_whitespace() && *letter != '/')
            .collect();
        if tag.starts_with('/') {
            assert_eq!(open.pop().as_ref(), Some(&name), "in {page}");
        } else if !tag.ends_with('/') && !EMPTY.contains(&name.as_str()) {
            open.push(name.clone());
        }
        found.push(name);
    }
    assert!(open.is_empty(), "{open:?} stay open");
    found
}

/// A page is whole, stands alone, and has no formula left as it is typed.
fn check(page: &str) {
    assert!(page.starts_with("<!doctype html>\n") && page.ends_with("</html>\n"));
    let elements = elements(page);
    assert!(!elements.iter().any(|name| name == "script" || name == "link" || name == "img"));
    for outside in [" src=", " href=", "url(http", "@import"] {
        assert!(!page.contains(outside), "{outside}");
    }
    let typed = page.matches("<code>").count();
    assert_eq!(typed, 1, "the command alone is typed");
    assert!(!page.contains('\\'), "LaTeX is left: {page}");
}

#[test]
fn every_command_has_a_page() {
    let commands: [(&[&str], bool); 19] = [
        (&["derive", "pendulum", "--at", "A=3/2"], true),
        (&["derive", "x'' + k*x + eps*x^3 = 0"], false),
        (&["derive", "van-der-pol", "--order", "3", "--at", "mu=1/2", "--steps"], true),
        (&["derive", "examples/forced-duffing.toml"], true),
        (&["compare", "duffing", "--at", "A=1", "--at", "eps=1"], true),
        (&["impact"], true),
        (&["impact", "examples/impact-units.toml"], true),
        (&["impact", "examples/impact-contact-laws.toml"], true),
        (&["impact", "--compare"], false),
        (&["simulate", "examples/simulate/paper.toml"], true),
        (&["simulate", "examples/simulate/paper.toml", "--sweep", "zeta=0.01,0.02"], true),
        (&["simulate", "x'' + sin(x) = 0", "--from", "x=1,v=0", "--until", "5"], true),
        (&["response", "examples/response/duffing.toml"], true),
        (&["stability", "examples/stability/mathieu.toml", "--at", "eps=1"], true),
        (&["friction"], true),
        (&["materials"], true),
        (&["lagrange"], false),
        (&["certify", "pendulum", "--at", "A=3/2"], false),
        (&["catalog"], false),
    ];
    for (arguments, pictured) in commands {
        let page = page(arguments);
        check(&page);
        assert_eq!(page.contains("<svg "), pictured, "{arguments:?}");
        assert!(!page.contains("No picture"), "{arguments:?}");
    }
}

/// What every example says is set, whatever its formulas are made of.
#[test]
fn the_formulas_of_every_example_are_set() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let files = |folder: PathBuf| -> Vec<String> {
        let entries = std::fs::read_dir(folder).expect("a folder").filter_map(Result::ok);
        let paths = entries.map(|entry| entry.path().to_str().expect("a path in text").to_owned());
        let mut files: Vec<String> = paths.filter(|path| path.ends_with(".toml")).collect();
        files.sort();
        files
    };
    for file in files(folder.clone()) {
        let name = Path::new(&file).file_stem().and_then(|name| name.to_str()).unwrap_or_default();
        if name.starts_with("impact") || name == "pressed-contact" {
            continue;
        }
        check(&page(&["derive", &file, "--steps"]));
    }
    for file in files(folder.join("lagrange")) {
        check(&page(&["lagrange", &file]));
    }
    for file in files(folder.join("audit")) {
        let output = run(&["audit", &file, "--format", "html"]);
        check(&String::from_utf8(output.stdout).expect("text"));
    }
}

/// The numbers of the report, and the picture of `--plot` to the last byte.
#[test]
fn a_page_has_the_numbers_of_the_text_and_the_picture_of_the_plot() {
    let question = ["derive", "pendulum", "--at", "A=3/2"];
    let (page, text) = (page(&question), result(&question));
    let (_, judged) = text.split_once("Judged against").expect("a verdict");
    let mut lines = 0;
    for line in judged.lines().skip(1).filter(|line| line.len() > 22) {
        let words = line[22..].replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
        // The verdict has a colour.
        let words = words.strip_prefix("pass").unwrap_or(&words);
        assert!(page.contains(words), "{words}");
        lines += 1;
    }
    assert!(lines > 8, "{text}");
    let picture = result(&[question.as_slice(), &["--format", "svg"]].concat());
    let file = std::env::temp_dir().join(format!("lindstedt-pages-{}.svg", std::process::id()));
    let place = file.to_str().expect("a path in text");
    result(&[question.as_slice(), &["--plot", place]].concat());
    let plotted = std::fs::read_to_string(&file).expect("the picture");
    std::fs::remove_file(&file).expect("the picture is removed");
    assert_eq!(picture, plotted);
    let (_, drawing) = plotted.split_once('\n').expect("lines");
    assert!(page.contains(drawing.trim_end()), "the picture of the page is that of --plot");
    // Only its frame may shrink.
    assert!(page.contains("<svg viewBox=\"0 0 "));
}

#[test]
fn a_page_says_how_it_was_made_and_reads_nothing_as_html() {
    let claims = "title = \"<script>alert(1)</script>\"\n[[claim]]\nid = \"one\"\nwhere = \"<b>here</b>\"\nquantity = \"value\"\n\
                  formula = \"1 + 1\"\nprinted = \"2\"\n";
    let file = std::env::temp_dir().join(format!("lindstedt-pages-{}.toml", std::process::id()));
    std::fs::write(&file, claims).expect("the claims are written");
    let page = page(&["audit", file.to_str().expect("a path in text")]);
    std::fs::remove_file(&file).expect("the claims are removed");
    check(&page);
    assert!(page.contains("&lt;b&gt;here&lt;/b&gt;") && !page.contains("<script"), "{page}");
    let page = self::page(&["derive", "x'' + x + eps*x^3 = 0", "--order", "1"]);
    let command = "lindstedt derive &quot;x'' + x + eps*x^3 = 0&quot; --order 1";
    assert!(page.contains(&format!("<title>{command}</title>")), "{page}");
    assert!(page.contains(&format!("<code>{command} --format html</code>")), "{page}");
}

#[test]
fn what_has_no_picture_says_so_before_the_work() {
    for arguments in [
        ["paper"].as_slice(),
        &["lagrange"],
        &["catalog"],
        &["certify", "pendulum", "--at", "A=1"],
        &["impact", "--compare"],
    ] {
        let output = run(&[arguments, &["--format", "svg"]].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(output.stdout.is_empty());
    }
    // A picture of numbers needs numbers, the page of a formula does not.
    let general = ["derive", "x'' + k*x + eps*x^3 = 0"];
    let output = run(&[general.as_slice(), &["--format", "svg"]].concat());
    assert_eq!(output.status.code(), Some(1));
    assert!(!page(&general).contains("<svg"));
}

/// Without `--format` the name of the file says what is in it.
#[test]
fn the_name_of_the_output_decides_where_no_format_is_given() {
    let folder = std::env::temp_dir().join(format!("lindstedt-pages-{}-names", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let question = ["derive", "pendulum", "--at", "A=3/2"];
    let written = |name: &str, more: &[&str]| {
        let place = folder.join(name);
        let place = place.to_str().expect("a path in text");
        result(&[question.as_slice(), &["--output", place], more].concat());
        std::fs::read_to_string(place).expect("the result")
    };
    for (name, format) in [
        ("law.json", "json"),
        ("law.tex", "latex"),
        ("law.svg", "svg"),
        ("law.py", "python"),
        ("law.m", "matlab"),
        ("law.txt", "text"),
        ("law", "text"),
        ("law.sh", "text"),
    ] {
        let asked = result(&[question.as_slice(), &["--format", format]].concat());
        assert_eq!(written(name, &[]), asked, "{name}");
    }
    // In C, which has no modules, functions have the name of their file.
    let program = written("law-2.c", &[]);
    assert!(program.contains("double law_2_displacement(double t"), "{program}");
    let plain = result(&[question.as_slice(), &["--format", "c"]].concat());
    assert_eq!(program.replace("law_2_", ""), plain);
    check(&written("LAW.HTML", &[]));
    assert_eq!(written("text.json", &["--format", "text"]), result(&question));
    let place = folder.join("impact.c");
    let refused = run(&["impact", "--output", place.to_str().expect("a path in text")]);
    let message = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!(refused.status.code(), Some(2));
    assert!(message.contains("--format text writes text there"), "{message}");
    std::fs::remove_dir_all(&folder).expect("the folder is removed");
}
