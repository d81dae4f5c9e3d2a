//! Claims of publications: a verdict turns when a claim is tampered with, an assumption is found
//! and needed, numbers that share an unknown must agree on it, and what the paper's audit finds is
//! held against formulas written out here.

use std::f64::consts::PI;
use std::process::{Command, Output};

use lindstedt::audit::{
    Audit, ClaimFinding, ClaimQuantity, Claims, Computed, NAMES, Printed, PrintedStatement,
    Relation, Rounding, Trend, Verdict, audit,
};

const PAPER: &str = include_str!("../../examples/audit/paper.toml");
const FREQUENCIES: &str = include_str!("../../examples/audit/frequencies.toml");

fn claims(text: &str) -> Claims {
    text.parse().unwrap_or_else(|error| panic!("{error}"))
}

fn finding<'a>(audit: &'a Audit, id: &str) -> &'a ClaimFinding {
    let found = audit.findings.iter().find(|finding| finding.claim.id == id);
    found.unwrap_or_else(|| panic!("no claim {id}"))
}

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .args(arguments)
        .output()
        .expect("the program starts")
}

/// The program on a file of its own.
fn of_file(name: &str, text: &str, options: &[&str]) -> Output {
    let path =
        std::env::temp_dir().join(format!("lindstedt-audit-{name}-{}.toml", std::process::id()));
    std::fs::write(&path, text).expect("a file");
    let output = run(&[&["audit", path.to_str().expect("a path in text")], options].concat());
    std::fs::remove_file(path).expect("the file goes");
    output
}

#[test]
fn the_paper_is_the_file_in_the_examples() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/audit/paper.toml");
    for format in ["text", "latex", "json"] {
        let (own, of_file) =
            (run(&["paper", "--format", format]), run(&["audit", file, "--format", format]));
        assert_eq!((own.status.code(), own.stderr.len()), (Some(0), 0));
        assert_eq!(own.stdout, of_file.stdout);
    }
}

/// Nothing that the paper numbers is left out.
#[test]
fn every_equation_table_and_figure_has_its_claim() {
    let claims = claims(PAPER).claims;
    let is_claimed = |what: String| {
        let stands_in = |place: &str| {
            let mut parts = place.split(&what).skip(1);
            parts.any(|rest| !rest.starts_with(|letter: char| letter.is_ascii_digit()))
        };
        claims.iter().any(|claim| stands_in(&claim.place))
    };
    let equations = (1..=16).map(|number| format!("({number})"));
    let tables = (1..=5).map(|number| format!("Table {number}"));
    let figures = (1..=4).map(|number| format!("Figure {number}"));
    for what in equations.chain(tables).chain(figures) {
        assert!(is_claimed(what.clone()), "{what}");
    }
}

/// The printed text with its last digit changed.
fn tampered(printed: &str) -> String {
    let place = printed.rfind(|letter: char| letter.is_ascii_digit()).expect("a digit");
    let digit =
        printed[place..].chars().next().and_then(|digit| digit.to_digit(10)).expect("a digit");
    format!("{}{}{}", &printed[..place], (digit + 5) % 10, &printed[place + 1..])
}

#[test]
fn a_changed_digit_turns_the_verdict() {
    let mut changed = 0;
    for text in [PAPER, FREQUENCIES] {
        let honest = audit(claims(text));
        for (index, finding) in honest.findings.iter().enumerate() {
            let Some(PrintedStatement::Number(printed)) =
                finding.claim.entries.first().map(|entry| &entry.stated)
            else {
                continue;
            };
            let is_bare =
                finding.claim.question.tolerance.is_none() && printed.relation == Relation::Equal;
            if !finding.verdict.is_reproduced() || !is_bare {
                continue;
            }
            let mut claim = claims(text).claims.swap_remove(index);
            let text =
                tampered(claim.entries[0].read_as.as_ref().unwrap_or(&claim.entries[0].printed));
            claim.entries[0].stated =
                PrintedStatement::Number(Printed::read(&text).expect("a number"));
            // An unknown takes up what is left of two digits.
            claim.unknown = claim.unknown.filter(|_| false);
            let id = claim.id.clone();
            let found = audit(Claims { claims: vec![claim], ..Claims::default() });
            let verdict = found.findings[0].verdict;
            assert!(
                !verdict.is_reproduced() && !found.passes(false),
                "{id}: {text} is {}",
                verdict.name()
            );
            changed += 1;
        }
    }
    assert!(changed > 15, "only {changed} claims");
}

#[test]
fn every_assumption_is_needed() {
    let mut needed = 0;
    for text in [PAPER, FREQUENCIES] {
        let honest = audit(claims(text));
        for (index, finding) in honest.findings.iter().enumerate() {
            if finding.verdict != Verdict::UnderAssumption {
                assert_eq!(finding.assumption(), "", "{}", finding.claim.id);
                continue;
            }
            assert!(!finding.assumption().is_empty(), "{}", finding.claim.id);
            let supposed = finding.tried.last().expect("a try").supposing.clone();
            let without = |supposition: Option<usize>| {
                let mut claim = claims(text).claims.swap_remove(index);
                match supposition {
                    Some(number) => {
                        for subject in &mut claim.suppositions {
                            subject.retain(|one| *one != supposed[number]);
                        }
                    }
                    None => claim.unknown = None,
                }
                let found = audit(Claims { claims: vec![claim], ..Claims::default() });
                found.findings[0].verdict
            };
            let all = (0..supposed.len()).map(Some).chain(finding.demand.map(|_| None));
            for one in all {
                let verdict = without(one);
                assert!(!verdict.is_reproduced(), "{}: {one:?} is not needed", finding.claim.id);
                needed += 1;
            }
        }
    }
    assert!(needed >= 9, "only {needed} assumptions");
}

/// What the paper's audit finds, by formulas of another kind.
#[test]
fn what_is_found_of_the_paper_follows_from_its_numbers() {
    let paper = audit(claims(PAPER));
    let demand = |id: &str| finding(&paper, id).demand.expect(id);
    // Table 1 with pi = 3.14.
    assert_eq!(
        finding(&paper, "table-1-values").assumption(),
        "pi = 3.14 and digits rounded or cut off"
    );
    assert_eq!(finding(&paper, "table-1-errors").assumption(), "pi = 3.14");
    assert_eq!(finding(&paper, "equation-16-phase").assumption(), "digits cut off");
    // Equation (15): slope 36/35 sqrt(d), d = (5 v^2/(4 gamma))^(2/5).
    let speed = (1.0 - 1.5_f64.powi(2) / 8.0).sqrt() * (1.5_f64.powi(2) - 0.323_f64.powi(2)).sqrt();
    let gamma_of = |slope: f64| 1.25 * speed * speed / (35.0 / 36.0 * slope).powi(5);
    let slope = demand("equation-15-slope");
    for (end, printed) in slope.range.into_iter().zip([0.0345, 0.0335]) {
        assert!((end / gamma_of(printed) - 1.0).abs() < 1e-6, "{end}");
    }
    // Table 5's design is none of them, and its constant allows the same.
    let stiffness = |modulus: f64, radius: f64, length: f64, mass: f64| {
        4.0 / 3.0 * modulus * radius.sqrt() * length.powf(1.5) / (mass * 9.81)
    };
    assert!(stiffness(1.439e9, 0.0096, 0.0681, 0.0112) < slope.range[0]);
    assert!(slope.is_within && demand("equation-15-constant").is_within);
    assert!(
        finding(&paper, "equation-15-slope")
            .evidence
            .iter()
            .any(|words| words.contains("`equation-15-constant`"))
    );
    // The range of Table 4.
    let box_of_table_4 = [stiffness(0.1e9, 0.001, 0.03, 0.1), stiffness(200e9, 0.02, 0.3, 0.01)];
    for (end, expected) in slope.unknown.within.into_iter().zip(box_of_table_4) {
        assert!((end / expected - 1.0).abs() < 1e-12);
    }
    // The contact time: by Hertz and by the printed line, as a number and as seconds.
    let (factor, time_unit) = (3.218_065_459_719_04_f64, (0.0681_f64 / 9.81).sqrt());
    let by_hertz = |time: f64| ((factor / time).powi(5) / speed).sqrt();
    let by_line = |time: f64| ((PI / time).powi(2) - 1.0) / 0.034;
    let evidence = &finding(&paper, "contact-duration").evidence;
    for wanted in [
        by_hertz(9.258e-8),
        by_line(9.258e-8),
        by_hertz(9.258e-8 / time_unit),
        by_line(9.258e-8 / time_unit),
    ] {
        assert!(wanted > 1e3 * box_of_table_4[1]);
        let text = format!("would need gamma = {},", lindstedt::export::significant(wanted, 3));
        assert!(evidence.iter().any(|words| words.contains(&text)), "{text}: {evidence:?}");
    }
    assert!(!demand("contact-duration").is_within);
    // The density of Table 5's sphere.
    let density = 0.0112 / (4.0 / 3.0 * PI * 0.0096_f64.powi(3));
    let steel = demand("table-5-steel");
    assert!(!steel.is_within && steel.range[0] < density && density < steel.range[1]);
    // The speed of the pendulum.
    let number = |id: &str| {
        let tried = finding(&paper, id).displayed_attempt().expect("a try");
        tried.computed[0].as_ref().expect("a number").number().expect("a number")
    };
    let exact = (2.0 * (0.323_f64.cos() - 1.5_f64.cos())).sqrt();
    assert!((number("contact-speed-of-the-pendulum") / exact - 1.0).abs() < 1e-12);
    assert!((number("precisely-close-speed") - (1.0 - speed / exact)).abs() < 1e-12);
    // Equation (13) starts on the other side of equation (11).
    assert!((number("equation-13-start") + 1.5).abs() < 1e-12);
    assert_eq!(finding(&paper, "one-length").assumption(), "l = L = 0.0681");
}

#[test]
fn claims_that_share_an_unknown_must_agree_on_it() {
    let file = |second: &str| {
        format!(
            "[[claim]]\nid = \"one\"\nquantity = \"value\"\nformula = \"k^2\"\nprinted = \"4.0\"\nunknown = \"k\"\nwithin = [1, 10]\n\
             [[claim]]\nid = \"two\"\nquantity = \"value\"\nformula = \"1/k\"\nprinted = \"{second}\"\nunknown = \"k\"\nwithin = [1, 10]\n"
        )
    };
    let agree = audit(claims(&file("0.50")));
    for finding in &agree.findings {
        assert_eq!(finding.verdict, Verdict::UnderAssumption, "{finding:?}");
        let [low, high] = finding.demand.expect("a demand").range;
        assert!(low <= 2.0 && 2.0 <= high && high - low < 0.1, "{low} {high}");
        assert!(
            finding.evidence.iter().any(|words| words.contains("serves")),
            "{:?}",
            finding.evidence
        );
    }
    let disagree = audit(claims(&file("0.20")));
    for (finding, other) in disagree.findings.iter().zip(["`two`", "`one`"]) {
        assert_eq!(finding.verdict, Verdict::Inconsistent);
        assert!(finding.demand.is_some_and(|demand| demand.is_within));
        let last = finding.evidence.last().expect("evidence");
        assert!(last.contains(other) && last.contains("there is one k"), "{last}");
    }
    // Beyond its range one does not speak for the other.
    let beyond = audit(claims(&file("0.02")));
    let verdicts: Vec<Verdict> = beyond.findings.iter().map(|finding| finding.verdict).collect();
    assert_eq!(verdicts, [Verdict::UnderAssumption, Verdict::Inconsistent]);
    assert!(
        beyond.findings[1].evidence[0]
            .contains("it would need k = 50, but that lies between 1 and 10")
    );
}

const ONE: &str =
    "[[claim]]\nid = \"one\"\nquantity = \"value\"\nformula = \"sqrt(2)\"\nprinted = ";

#[test]
fn the_exit_code_says_whether_every_verdict_is_the_expected_one() {
    for (printed, options, code) in [
        ("\"1.4142\"", &[][..], 0),
        ("\"1.4143\"", &[], 3),
        ("\"1.4143\"\ntolerance = 1e-3", &[], 0),
        ("\"1.4143\"\nexpect = \"inconsistent\"", &[], 0),
        ("\"1.4143\"\nexpect = \"inconsistent\"", &["--strict"], 3),
        ("\"1.4142\"\nexpect = \"inconsistent\"", &[], 3),
        ("\"1.4142\"\nexpect = \"inconsistent\"", &["--strict"], 0),
        ("\"1.4142\"\nexpect = \"reproduced-under-assumption\"", &[], 3),
        ("\"1.41\"\nrounding = \"cut\"", &[], 0),
        ("\"about\"", &[], 1),
        ("\"1.4142\"", &["--tolerance", "0.1"], 2),
        ("\"1.4142\"", &["--format", "csv"], 2),
    ] {
        let output = of_file("codes", &format!("{ONE}{printed}\n"), options);
        assert_eq!(output.status.code(), Some(code), "{printed} {options:?}");
        assert_eq!(output.stdout.is_empty(), matches!(code, 1 | 2), "{printed} {options:?}");
    }
    assert_eq!(run(&["paper", "--strict"]).status.code(), Some(3));
}

#[test]
fn what_is_missing_is_named_and_what_is_refused_has_its_reason() {
    let of = |text: &str| {
        audit(claims(&format!("[[claim]]\nid = \"one\"\nprinted = \"1\"\n{text}")))
            .findings
            .swap_remove(0)
    };
    let found = of("quantity = \"rest_time\"\nvalues = { A = 1.5, xc = 0.323, gamma = 1e6 }");
    assert_eq!(
        (found.verdict, found.missing.join(" ")),
        (Verdict::NotReproducible, "alpha mu zeta".to_owned())
    );
    let found = of(
        "quantity = \"frequency\"\nequation = \"cubic-pendulum\"\norder = 2\nvalues = { A = 3 }",
    );
    assert_eq!((found.verdict, found.missing.len()), (Verdict::NotReproducible, 0));
    assert!(found.evidence[0].contains("omega^2 = -0.125"), "{:?}", found.evidence);
    let found = of("quantity = \"value\"\nformula = \"a1\"\nvalues = { a1 = \"b1\", b1 = \"a1\" }");
    assert!(found.evidence[0].contains("defined by itself"), "{:?}", found.evidence);
    let found = of("quantity = \"value\"\nformula = \"1/(k - 1)\"\nvalues = { k = 1 }");
    assert_eq!(found.verdict, Verdict::NotReproducible);
    // A number far from what is meant is never reproduced.
    let found = of("quantity = \"value\"\nformula = \"-1\"");
    assert_eq!(found.verdict, Verdict::Inconsistent);
}

#[test]
fn the_fewest_suppositions_are_found() {
    let text = "[[claim]]\nid = \"one\"\nquantity = \"value\"\nformula = \"pi*k\"\nvalues = { k = 2 }\nprinted = \"9.42\"\n\
                suppose = { pi = [3, 3.14], values = [{ k = 3 }, { k = 4 }], rounding = [\"cut\", \"either\"] }";
    let found = audit(claims(text)).findings.swap_remove(0);
    assert_eq!(found.assumption(), "k = 3");
    let text = text.replace("9.42\"", "6.28\"");
    assert_eq!(audit(claims(&text)).findings[0].verdict, Verdict::Reproduced);
    let text = text.replace("6.28\"", "9\"").replace("k = 4", "k = 5");
    assert_eq!(audit(claims(&text)).findings[0].assumption(), "k = 3");
    let text = text.replace("printed = \"9\"", "printed = \"9.00\"");
    assert_eq!(audit(claims(&text)).findings[0].assumption(), "k = 3 and pi = 3");
}

#[test]
fn a_trend_is_one_of_all_entries() {
    for (trend, numbers, holds) in [
        (Trend::Falls, vec![3.0, 2.0, 1.0], true),
        (Trend::Falls, vec![3.0, 2.999, 1.0], false),
        (Trend::Rises, vec![1.0, 2.0, 3.0], true),
        (Trend::Rises, vec![1.0, 3.0, 2.0], false),
        (Trend::FirstIsLeast, vec![1.0, 3.0, 2.0], true),
        (Trend::FirstIsLeast, vec![1.0, 1.0], false),
        (Trend::FirstIsGreatest, vec![4.0, 3.0, 2.0], true),
        (Trend::FirstIsGreatest, vec![4.0, 5.0], false),
        (Trend::Falls, vec![f64::NAN, 1.0], false),
    ] {
        assert_eq!(trend.holds(&numbers, 1e-3), holds, "{trend:?} {numbers:?}");
    }
}

/// The page names every number, every key and every verdict.
#[test]
fn the_page_names_everything() {
    let page = include_str!("../../docs/audit.md");
    for (name, needs, words) in NAMES {
        let row = format!("| `{name}` | {needs} | {words} |");
        assert!(page.contains(&row), "{row}");
    }
    for verdict in Verdict::ALL {
        assert!(page.contains(&format!("| `{}` |", verdict.name())), "{}", verdict.name());
    }
    let words = Rounding::ALL.map(Rounding::name).into_iter().chain(Trend::ALL.map(Trend::name));
    for word in words {
        assert!(page.contains(&format!("`{word}`")), "{word}");
    }
    // The parser lists its keys where it meets another one.
    let error = "[[claim]]\nnonsense = 1".parse::<Claims>().expect_err("a mistake").to_string();
    let keys: Vec<&str> = error.split('`').skip(3).step_by(2).collect();
    assert!(keys.len() > 20, "{error}");
    for key in keys {
        assert!(page.contains(&format!("`{key}`")), "{key}");
    }
    // The file on the page is one.
    let example =
        page.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).expect("a file");
    assert!(audit(claims(example)).passes(true));
}

/// What is written of a question is what is computed: a claim made in Rust is the claim of a file.
#[test]
fn a_formula_is_compared_for_every_value_of_its_symbols() {
    let of = |printed: &str| {
        let text = format!(
            "[[claim]]\nid = \"one\"\nquantity = \"identity\"\nformula = \"m*X'^2/2\"\nvalues = {{ X = \"L*sin(x)\" }}\nprinted = \"{printed}\""
        );
        let found = audit(claims(&text)).findings.swap_remove(0);
        assert!(matches!(found.claim.question.quantity, ClaimQuantity::Identity(_)));
        (found.verdict, found.evidence.join("; "))
    };
    assert_eq!(of("m*L^2*x'^2*cos(x)^2/2").0, Verdict::Reproduced);
    assert_eq!(of("m*L^2*x'^2*(1 - sin(x)^2)/2").0, Verdict::Reproduced);
    let (verdict, words) = of("m*L^2*x'*cos(x)^2/2");
    assert_eq!(verdict, Verdict::Inconsistent);
    assert!(words.contains("printed, but not derived: `L^2*m*x'*cos(x)^2/2`"), "{words}");
    assert!(words.contains("derived, but not printed: `L^2*m*x'^2*cos(x)^2/2`"), "{words}");
}

/// A term that the law does not have is marked as absent, and one that it cannot have, or does not
/// reach, is no zero.
#[test]
fn the_coefficient_of_a_term_that_does_not_occur_is_no_number_among_others() {
    let of = |term: &str, printed: &str| {
        let text = format!(
            "[[claim]]\nid = \"one\"\nquantity = \"coefficient\"\nof = \"frequency_squared\"\nterm = \"{term}\"\n\
             equation = \"x'' + sin(x) = 0\"\nmethod = \"lindstedt-poincare\"\norder = 4\nprinted = \"{printed}\""
        );
        audit(claims(&text)).findings.swap_remove(0)
    };
    assert_eq!(of("A^2", "-1/8").verdict, Verdict::Reproduced);
    let absent = of("A^3", "1/8");
    assert_eq!(absent.verdict, Verdict::Inconsistent);
    assert_eq!(absent.evidence, ["printed 1/8, but the derived law has no such term"]);
    assert!(matches!(absent.tried[0].computed[0], Ok(Computed::Absent)));
    assert_eq!(of("A^3", "0").verdict, Verdict::Reproduced);
    for (term, words) in [
        ("A^6", "ask for a higher `order`"),
        ("B^2", "`B` does not occur"),
        ("A^2*k", "`k` does not occur"),
    ] {
        for printed in ["0", "1/8"] {
            let found = of(term, printed);
            assert_eq!(found.verdict, Verdict::NotReproducible, "{term}");
            assert!(
                found.evidence.iter().any(|evidence| evidence.contains(words)),
                "{:?}",
                found.evidence
            );
        }
    }
    let text = "[[claim]]\nid = \"one\"\nquantity = \"coefficient\"\nterm = \"A^3\"\nequation = \"x'' + sin(x) = 0\"\nprinted = \"0\"";
    let output = of_file("absent", text, &[]);
    assert!(String::from_utf8_lossy(&output.stdout).contains("0, no such term"));
}

/// Whatever a file holds, it is read or refused, and what is read is judged.
#[test]
fn no_file_of_claims_breaks_the_program() {
    let mut state = 12_345_u64;
    let mut next = |below: usize| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    let sections: Vec<&str> =
        [PAPER, FREQUENCIES].iter().flat_map(|text| text.split("\n[[claim]]\n").skip(1)).collect();
    let words = [
        "1e400",
        "-1",
        "0",
        "\"\"",
        "\"x\"",
        "[]",
        "{}",
        "true",
        "nan",
        "\"<\"",
        "\"1/0\"",
        "\"gamma\"",
        "\"rest_time\"",
        "\"%\"",
    ];
    let (mut read, mut refused) = (0, 0);
    for _ in 0..1500 {
        let own = sections[next(sections.len())];
        let mut lines: Vec<String> = own.lines().map(str::to_owned).collect();
        for _ in 0..=next(2) {
            let number = next(lines.len());
            match next(4) {
                0 => drop(lines.remove(number)),
                1 => {
                    let other =
                        sections[next(sections.len())].lines().nth(next(6)).unwrap_or_default();
                    lines.insert(number, other.to_owned());
                }
                2 => {
                    if let Some((key, _)) = lines[number].clone().split_once(" = ") {
                        lines[number] = format!("{key} = {}", words[next(words.len())]);
                    }
                }
                _ => {
                    let cut = next(lines[number].len() + 1);
                    lines[number].truncate(cut);
                }
            }
            if lines.is_empty() {
                lines.push(String::new());
            }
        }
        let text = format!(
            "[values]\nA = 1.5\nxc = 0.323\ng = 9.81\nL = 0.0681\n[[claim]]\n{}",
            lines.join("\n")
        );
        match text.parse::<Claims>() {
            Err(error) => {
                assert!(!error.to_string().is_empty());
                refused += 1;
            }
            // What would take long is left to the time limit of the program.
            Ok(claims) if claims.claims.iter().any(|claim| claim.unknown.is_some()) => {}
            Ok(claims) => {
                let found = audit(claims);
                assert!(found.findings.iter().all(|finding| !finding.claim.entries.is_empty()));
                read += 1;
            }
        }
    }
    assert!(read > 100 && refused > 300, "{read} read, {refused} refused");
}

#[test]
fn an_equation_of_motion_follows_from_its_energies() {
    let of = |parts: &str, printed: &str| {
        let text = format!(
            "[[claim]]\nid = \"one\"\nquantity = \"motion\"\n{parts}\nprinted = \"{printed}\""
        );
        audit(claims(&text)).findings.swap_remove(0)
    };
    for (parts, printed) in [
        ("kinetic = \"m*L^2*x'^2/2\"\npotential = \"-m*g*L*cos(x)\"", "x'' + g/L*sin(x) = 0"),
        ("kinetic = \"x'^2/2\"\nforce = \"-c*x' + F*cos(Omega*t)\"", "x'' + c*x' = F*cos(Omega*t)"),
        // A bead on a rotating hoop, and a mass that grows with its place.
        (
            "kinetic = \"m*r^2*(x'^2 + w^2*sin(x)^2)/2\"\npotential = \"-m*g*r*cos(x)\"",
            "x'' + g/r*sin(x) - w^2*sin(x)*cos(x)",
        ),
        ("kinetic = \"(1 + x^2)*x'^2/2\"\npotential = \"x^2/2\"", "x'' + (x*x'^2 + x)/(1 + x^2)"),
    ] {
        assert_eq!(of(parts, printed).verdict, Verdict::Reproduced, "{printed}");
    }
    let wrong =
        of("kinetic = \"m*L^2*x'^2/2\"\npotential = \"-m*g*L*cos(x)\"", "x'' + g*L*sin(x) = 0");
    assert_eq!(wrong.verdict, Verdict::Inconsistent);
    assert!(
        wrong.evidence.iter().any(|words| words.contains("derived, but not printed: `g*sin(x)/L`")),
        "{:?}",
        wrong.evidence
    );
    let none = of("kinetic = \"m*L^2/2\"", "x'' = 0");
    assert_eq!(none.verdict, Verdict::NotReproducible);
    assert!(none.evidence[0].contains("without inertia"), "{:?}", none.evidence);
}

/// The modes of coupled equations are audited like other laws: the classical frequencies are
/// reproduced, each tampered digit is found, and what a mode has not is refused by name.
#[test]
fn claims_about_modes_of_coupled_equations() {
    const MODES: &str = include_str!("../../examples/audit/modes.toml");
    let found = audit(claims(MODES));
    assert_eq!(found.findings.len(), 4);
    for finding in &found.findings {
        assert_eq!(finding.verdict, Verdict::Reproduced, "{}", finding.claim.id);
    }
    for (old, new) in [("0.585786", "0.585736"), ("3.414214", "3.414219"), ("\"3/4\"", "\"3/8\"")] {
        assert!(MODES.contains(old));
        let found = audit(claims(&MODES.replace(old, new)));
        let wrong = found.findings.iter().filter(|one| one.verdict == Verdict::Inconsistent);
        assert_eq!(wrong.count(), 1, "{old}");
    }
    for (old, new, words) in [
        ("mode = 2", "mode = 3", "there is no mode 3: there are 2"),
        ("order = 2", "order = 2\nmethod = \"pade\"", "by lindstedt-poincare"),
        ("order = 2", "order = 2\nof = \"frequency\"", "gives no polynomial for omega"),
        ("a = \"1/100000\"", "b = \"1/100000\"", "`b`"),
    ] {
        let output = of_file("modes", &MODES.replacen(old, new, 1), &["--format", "json"]);
        let said = [output.stdout, output.stderr].concat();
        let said = String::from_utf8(said).expect("text");
        assert!(said.contains(words), "{new}: {said}");
    }
}
