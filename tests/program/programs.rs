//! Derived formulas as programs: run, they give the numbers of the library.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use lindstedt::exact::Polynomial;
use lindstedt::export::code::{self, Language};
use lindstedt::method::numbers::evaluate;
use lindstedt::modes::{FreeSystem, ModeOptions, derive};
use lindstedt::report::ModesReport;
use lindstedt::solution::{AmplitudeConvention, Method, defined_values};
use lindstedt::verify::{judge, judge_mode};
use lindstedt::{Interrupt, Options, Oscillator, Symbol, Values, solve};
use serde_json::Value;

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .args(arguments)
        .output()
        .expect("the program starts")
}

/// Standard output of a run that must succeed.
fn output(arguments: &[&str]) -> String {
    let output = run(arguments);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {said}");
    String::from_utf8(output.stdout).expect("the output is text")
}

/// An answer at given values: its programs, and what they must give.
struct Case {
    name: String,
    /// In the order of [`LANGUAGES`].
    texts: [String; 3],
    values: BTreeMap<String, f64>,
    omega: f64,
    /// The names of its functions: frequency, displacement, velocity.
    routines: [String; 3],
    /// The displacement by the time; none where there is no formula for the motion.
    motion: Option<Box<dyn Fn(f64) -> f64>>,
}

const LANGUAGES: [Language; 3] = [Language::Python, Language::C, Language::Rust];
const TIMES: [f64; 4] = [0.0, 0.4, 1.7, 6.1];
const STEP: f64 = 1e-4;
const ROUTINES: [&str; 3] = ["angular_frequency", "displacement", "velocity"];

/// The arguments of a function of a program in Python, by their names.
fn arguments<'a>(text: &'a str, routine: &str) -> Option<Vec<&'a str>> {
    let (_, rest) = text.split_once(&format!("def {routine}("))?;
    let (list, _) = rest.split_once(')')?;
    Some(list.split(", ").filter(|name| !name.is_empty()).collect())
}

impl Case {
    /// The calls whose values a program prints, in this order: the frequency; for each time
    /// displacement, velocity, and the displacements a step before and after.
    fn calls(&self) -> Vec<(&str, Vec<f64>)> {
        let list = |routine: &str, t: f64| -> Option<Vec<f64>> {
            let value = |name: &str| match name {
                "t" => t,
                _ => {
                    let own = self
                        .values
                        .get(name)
                        .or_else(|| self.values.get(name.trim_end_matches('_')));
                    *own.unwrap_or_else(|| panic!("{}: {name}", self.name))
                }
            };
            Some(arguments(&self.texts[0], routine)?.into_iter().map(value).collect())
        };
        let [frequency, ..] = &self.routines;
        let mut calls = vec![(frequency.as_str(), list(frequency, 0.0).expect("a frequency"))];
        if self.motion.is_some() {
            for t in TIMES {
                for (routine, t) in [(1, t), (2, t), (1, t - STEP), (1, t + STEP)] {
                    let routine = &self.routines[routine];
                    calls.push((
                        routine.as_str(),
                        list(routine, t).unwrap_or_else(|| panic!("{}: {routine}", self.name)),
                    ));
                }
            }
        }
        calls
    }

    fn check(&self, language: Language, found: &[f64]) {
        let name = format!("{} in {}", self.name, language.name());
        let near = |found: f64, value: f64, size: f64, what: &str| {
            assert!((found - value).abs() <= size, "{name}: {what} {found} and {value}");
        };
        // At a small amplitude terms may cancel: then there is a value to half of the digits, or
        // none.
        let cancels = self.texts[0].contains("rounding takes the digits")
            && ["A", "a"]
                .iter()
                .any(|name| self.values.get(*name).is_some_and(|value| value.abs() < 0.1));
        let tolerance = if cancels { 1e-6 } else { 1e-12 };
        if !(cancels && found[0].is_nan()) {
            near(found[0], self.omega, tolerance * self.omega, "omega");
        }
        let Some(motion) = &self.motion else { return };
        let size = TIMES.iter().map(|t| motion(*t).abs()).fold(0.0, f64::max);
        for (t, found) in TIMES.into_iter().zip(found[1..].chunks(4)) {
            if cancels && found.iter().all(|value| value.is_nan()) {
                continue;
            }
            near(found[0], motion(t), tolerance * size * (1.0 + self.omega * t), "x");
            let difference = (found[3] - found[2]) / (2.0 * STEP);
            near(found[1], difference, 1e-6 * size * self.omega * (1.0 + self.omega.powi(2)), "v");
        }
    }
}

/// The examples of `derive`, with the numbers of their JSON.
fn examples() -> Vec<Case> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .filter(|path| {
            !path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("impact"))
        })
        .collect();
    files.sort();
    let mut cases = Vec::new();
    for file in files {
        let file = file.to_string_lossy().into_owned();
        let document = |more: &[&str]| -> Value {
            let arguments = [&["derive", &file, "--format", "json"], more].concat();
            serde_json::from_str(&output(&arguments)).expect("JSON")
        };
        let mut solution = document(&[]);
        let mut at: Vec<String> = vec![];
        if solution["verification"].is_null() {
            let parameters = solution["parameters"].as_array().expect("a list").iter();
            let names: Vec<&str> = parameters.map(|name| name.as_str().expect("a name")).collect();
            at.extend(
                names
                    .iter()
                    .enumerate()
                    .map(|(index, name)| format!("{name}={}", 0.2 + 0.1 * index as f64)),
            );
            if solution["limit_cycle"].is_null() {
                at.push("A=0.4".to_owned());
            }
            // Without any symbol there is nothing to give values to.
            let at: Vec<&str> = at.iter().flat_map(|value| ["--at", value]).collect();
            let at = if at.is_empty() { vec!["--tolerance", "1"] } else { at };
            solution = document(&at);
        }
        let at: Vec<&str> = at.iter().flat_map(|value| ["--at", value]).collect();
        let verification = &solution["verification"];
        if !solution["response"].is_null()
            || !verification["followed"].is_null() && solution["limit_cycle"].is_null()
        {
            let refused = run(&[&["derive", &file, "--format", "c"], &at[..]].concat());
            let said = String::from_utf8_lossy(&refused.stderr).into_owned();
            assert!(
                refused.status.code() == Some(1) && said.contains("no program: "),
                "{file}: {said}"
            );
            continue;
        }
        let texts = LANGUAGES.map(|language| {
            output(&[&["derive", &file, "--format", language.name()], &at[..]].concat())
        });
        // The formula is that of the cycle, the verdict on the way to it: `methods` has it without
        // a start.
        if !verification["followed"].is_null() {
            continue;
        }
        let number = |value: &Value| value.as_f64().expect("a number");
        let omega = number(&verification["frequency"]);
        let phase = number(&verification["phase"]);
        let waves = verification["motion"].as_array().expect("a motion").iter();
        let waves: Vec<[f64; 3]> =
            waves.map(|wave| ["harmonic", "cos", "sin"].map(|key| number(&wave[key]))).collect();
        let values = verification["values"].as_object().expect("values").iter();
        cases.push(Case {
            name: file,
            texts,
            routines: ROUTINES.map(str::to_owned),
            values: values.map(|(name, value)| (name.clone(), number(value))).collect(),
            omega,
            motion: Some(Box::new(move |t| {
                let theta = omega * t + phase;
                waves.iter().map(|[k, c, s]| c * (k * theta).cos() + s * (k * theta).sin()).sum()
            })),
        });
    }
    cases
}

/// Equations and values at which every method that has an answer is run, and how many must have
/// one.
const EQUATIONS: [(&str, &str, usize); 16] = [
    ("x'' + x + eps*x^3 = 0", "A = 3/2, eps = 1/2", 14),
    ("x'' + k*x + eps*x^3 = 0", "A = 3/2, eps = -1/20, k = 2", 14),
    ("x'' + sin(x) = 0", "A = 6/5", 13),
    ("x'' + sin(x) = 0", "A = -6/5", 13),
    ("x'' + sin(x) = 0", "A = 1/25", 13),
    ("x'' + sin(x) = 0", "A = 1/10000", 13),
    ("x'' + exp(x) - 1 = 0", "A = 1/1000", 7),
    ("x'' + x + x^2 + x^3 - 1/5 = 0", "A = -3/10", 9),
    ("x'' + x + x*abs(x) = 0", "A = -1/2", 10),
    ("x'' + x + x^2 = 0", "A = -3/10", 8),
    ("x'' + x - x^3 + 2*x^5 = 0", "A = -6/5", 12),
    ("x'' + lambda*x + gamma*x^(1/3) = 0", "A = 2/5, gamma = 1/3, lambda = 3", 8),
    ("x'' + exp(x) - 1 = 0", "A = 2/5", 7),
    ("x'' + exp(x) - 1 = 0", "A = -2/5", 7),
    ("x'' + sgn(x)*abs(x)^p = 0", "A = -2/5, p = 3/2", 6),
    ("x'' - mu*(1 - x^2)*x' + x = 0", "mu = 3/10", 1),
];

/// Every method on every equation, with the numbers of the library.
fn methods() -> Vec<Case> {
    let mut cases = Vec::new();
    for (equation, at, least) in EQUATIONS {
        let oscillator = Oscillator::parse(equation).expect("an equation");
        let before = cases.len();
        for method in Method::ALL {
            let options = Options {
                method: Some(method),
                amplitude: (method == Method::Averaging).then_some(AmplitudeConvention::Initial),
                ..Options::default()
            };
            let Ok(solution) = solve(&oscillator, &options) else {
                continue;
            };
            let of_harmonic = solution.amplitude == AmplitudeConvention::FirstHarmonic
                && solution.limit_cycle.is_none();
            let at = if of_harmonic { at.replace("A =", "a =") } else { at.to_owned() };
            let name = format!("{} on {equation} at {at}", method.name());
            let values: Values = at.parse().expect("values");
            let verification = judge(&oscillator, &solution, &values, 0.01).expect(&name);
            let numbers: BTreeMap<Symbol, f64> =
                values.iter().filter_map(|(name, _)| Some((name, values.get(name)?))).collect();
            let own = evaluate(&oscillator, &solution, &numbers).expect(&name);
            let omega = own.frequency_squared.sqrt();
            let text = |language| {
                code::solution(&oscillator, &solution, Some(&verification), language).expect(&name)
            };
            let mut values: BTreeMap<String, f64> =
                numbers.iter().map(|(name, value)| (name.to_string(), *value)).collect();
            values.extend(own.chosen.iter().map(|(name, value)| (name.to_string(), *value)));
            cases.push(Case {
                texts: LANGUAGES.map(text),
                routines: ROUTINES.map(str::to_owned),
                values,
                omega,
                motion: own.motion.map(|motion| {
                    Box::new(move |t| motion.evaluate(omega * t)) as Box<dyn Fn(f64) -> f64>
                }),
                name,
            });
        }
        assert!(cases.len() - before >= least, "{equation}: only {} methods", cases.len() - before);
    }
    cases
}

/// Modes of coupled equations, with the numbers that their polynomials have.
fn modes() -> Vec<Case> {
    let mut cases = Vec::new();
    for (equations, at) in [
        ("x'' + k*x - y + x^3/2 = 0; y'' + k*y - x + y^2 = 0", "a = 2/5, k = 3"),
        ("x'' + 2*x - y/3 + x^2*y = 0; y'' + 5*y - x/3 = 0", "a = -3/10"),
    ] {
        let numbers: Values = at.parse().expect("values");
        let named =
            numbers.iter().filter_map(|(name, _)| Some((name.to_string(), numbers.get(name)?)));
        let values: BTreeMap<String, f64> = named.collect();
        let system = FreeSystem::parse(equations).expect("equations");
        let found = derive(&system, &ModeOptions::default()).expect("modes");
        let report = ModesReport { modes: &found, judged: &[], tolerance: 0.01 };
        let texts = LANGUAGES.map(|language| code::modes(&report, language).expect(equations));
        for mode in found.modes.iter().flatten() {
            let own = |name: Symbol| values.get(&name.to_string()).copied();
            let defined = defined_values(&mode.definitions, &own).expect(equations);
            let number = |polynomial: &Polynomial| {
                let value = |name: Symbol| {
                    let defined = defined.iter().find(|(own, _)| *own == name);
                    own(name).or_else(|| defined.map(|(_, value)| *value))
                };
                polynomial.evaluate(value).expect(equations)
            };
            let omega = number(&mode.frequency_squared).sqrt();
            let judged =
                judge_mode(&system, mode, &numbers, 0.01, Interrupt::default()).expect(equations);
            let by_judge = judged.frequency.expect("a frequency");
            assert!((omega - by_judge).abs() < 1e-14 * omega, "{equations}");
            for (name, series) in system.equations.coordinates.iter().zip(&mode.motion) {
                let harmonics = series.harmonics().into_iter();
                let harmonics: Vec<(usize, f64)> =
                    harmonics.map(|(k, cosine, _)| (k, number(&cosine))).collect();
                let routine = |what: &str| format!("mode{}_{what}", mode.number);
                cases.push(Case {
                    name: format!("{name} of mode {} of {equations}", mode.number),
                    texts: texts.clone(),
                    values: values.clone(),
                    omega,
                    routines: [
                        routine("angular_frequency"),
                        routine(&format!("displacement_{name}")),
                        routine(&format!("velocity_{name}")),
                    ],
                    motion: Some(Box::new(move |t| {
                        let harmonics = harmonics.iter();
                        harmonics.map(|(k, c)| c * (*k as f64 * omega * t).cos()).sum()
                    })),
                });
            }
        }
    }
    cases
}

/// The numbers that a command prints, a line each.
fn numbers(command: &mut Command) -> Vec<f64> {
    let output = command.output().expect("it starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("text");
    text.lines().map(|line| line.parse().expect("a number")).collect()
}

/// Whether a program of this name is here.
fn is_here(program: &str) -> bool {
    let asked = Command::new(program).arg("--version").output();
    let here = asked.is_ok_and(|output| output.status.success());
    if !here {
        eprintln!("{program} is not here: its programs were not run");
    }
    here
}

/// All programs of a language in one go: the numbers of every case, one after the other.
fn run_all(language: Language, cases: &[Case], folder: &Path) -> Option<Vec<f64>> {
    let index = LANGUAGES.iter().position(|other| *other == language).expect("a language");
    let ending = ["py", "c", "rs"][index];
    for (k, case) in cases.iter().enumerate() {
        std::fs::write(folder.join(format!("case{k}.{ending}")), &case.texts[index])
            .expect("a file");
    }
    let calls = |k: usize, prefix: &str, print: &dyn Fn(String) -> String| -> String {
        let calls = cases[k].calls().into_iter();
        calls
            .map(|(routine, list)| {
                let list: Vec<String> = list.iter().map(|value| format!("{value:?}")).collect();
                print(format!("{prefix}{routine}({})", list.join(", ")))
            })
            .collect()
    };
    let mut driver = String::new();
    match language {
        Language::Python => {
            if !is_here("python3") {
                return None;
            }
            driver += "import runpy\n\
def show(name, *values):\n    try:\n        print(repr(float(case[name](*values))))\n    except ValueError:\n        print('nan')\n";
            for k in 0..cases.len() {
                let _ = writeln!(
                    driver,
                    "case = runpy.run_path({:?})",
                    folder.join(format!("case{k}.py"))
                );
                driver += &calls(k, "", &|call| {
                    let (routine, list) = call.split_once('(').expect("a call");
                    format!("show('{routine}', {list}\n")
                });
            }
            let file = folder.join("driver.py");
            std::fs::write(&file, driver).expect("a file");
            Some(numbers(Command::new("python3").args(["-I", "-S"]).arg(file)))
        }
        Language::C => {
            if !is_here("cc") {
                return None;
            }
            const NAMES: [&str; 15] = [
                "PI",
                "angular_frequency",
                "displacement",
                "velocity",
                "sign",
                "heaviside",
                "bessel_j0",
                "bessel_j1",
                "bessel_i0",
                "bessel_i1",
                "elliptic_k",
                "jacobi_functions",
                "jacobi_sn",
                "jacobi_cn",
                "jacobi_dn",
            ];
            driver += "#include <math.h>\n#include <stdio.h>\n";
            for (k, case) in cases.iter().enumerate() {
                let own = case.texts[0].split("def mode").skip(1);
                let own = own.filter_map(|text| Some(format!("mode{}", text.split_once('(')?.0)));
                for name in NAMES.into_iter().map(str::to_owned).chain(own) {
                    let _ = writeln!(driver, "#undef {name}\n#define {name} {name}_{k}");
                }
                let _ = writeln!(driver, "#include \"case{k}.c\"\nstatic void show_{k}(void)\n{{");
                driver += &calls(k, "", &|call| format!("    printf(\"%.17g\\n\", {call});\n"));
                driver += "}\n";
            }
            driver += "int main(void)\n{\n";
            for k in 0..cases.len() {
                let _ = writeln!(driver, "    show_{k}();");
            }
            driver += "    return 0;\n}\n";
            std::fs::write(folder.join("driver.c"), driver).expect("a file");
            let compiled = Command::new("cc")
                .current_dir(folder)
                .args([
                    "-std=c99",
                    "-Wall",
                    "-Wextra",
                    "-pedantic",
                    "-Werror",
                    "driver.c",
                    "-o",
                    "driver-c",
                    "-lm",
                ])
                .output()
                .expect("the compiler starts");
            assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
            Some(numbers(&mut Command::new(folder.join("driver-c"))))
        }
        Language::Rust => {
            for k in 0..cases.len() {
                let _ = writeln!(driver, "mod case{k};");
            }
            driver += "fn main() {\n";
            for k in 0..cases.len() {
                driver += &calls(k, &format!("case{k}::"), &|call| {
                    format!("    println!(\"{{:?}}\", {call});\n")
                });
            }
            driver += "}\n";
            std::fs::write(folder.join("driver.rs"), driver).expect("a file");
            let compiler = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
            let compiled = Command::new(compiler)
                .current_dir(folder)
                // A motion that is not asked for is no mistake of the program.
                .args([
                    "--edition",
                    "2021",
                    "-D",
                    "warnings",
                    "-A",
                    "dead_code",
                    "driver.rs",
                    "-o",
                    "driver-rust",
                ])
                .output()
                .expect("the compiler starts");
            assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
            Some(numbers(&mut Command::new(folder.join("driver-rust"))))
        }
        _ => None,
    }
}

#[test]
fn programs_give_the_numbers_of_the_library() {
    let folder = std::env::temp_dir().join(format!("lindstedt-programs-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let cases: Vec<Case> = examples().into_iter().chain(methods()).chain(modes()).collect();
    for language in LANGUAGES {
        let Some(found) = run_all(language, &cases, &folder) else {
            continue;
        };
        let mut rest = &found[..];
        for case in &cases {
            let (own, others) = rest.split_at(case.calls().len());
            case.check(language, own);
            rest = others;
        }
        assert!(rest.is_empty());
    }
    std::fs::remove_dir_all(folder).expect("the folder goes");
}

/// The harmonics of a pendulum fall like the powers of its nome, by some seventy from one odd one
/// to the next at A = 1: the even ones are none, and those beyond the 15th are less than what
/// rounding leaves.
#[test]
fn rounding_noise_is_no_harmonic_of_a_program() {
    for language in ["python", "c", "rust"] {
        let text = output(&[
            "derive",
            "x'' + x*exp(x^2/16) = 0",
            "--method",
            "exact",
            "--at",
            "A=1",
            "--format",
            language,
        ]);
        let has = |k: &str| {
            text.contains(&format!("({k}*theta)"))
                || text.contains(&format!("({k}.0 * theta)"))
                || text.contains(&format!("({k}.0*theta)"))
        };
        assert!(["3", "5", "7"].iter().all(|k| has(k)), "{text}");
        assert!(!["2", "4", "6", "17", "21", "63"].iter().any(|k| has(k)), "{text}");
    }
}

#[test]
fn what_is_no_formula_is_refused_with_a_way_forward() {
    for (arguments, reason, help) in [
        (
            ["derive", "duffing", "--method", "harmonic-balance"],
            "several equations",
            "with values, by --at",
        ),
        (
            ["derive", "x'' + x + x*abs(x) = 0", "--method", "exact"],
            "integrals",
            "with values, by --at",
        ),
        (
            ["derive", "x'' + 2*zeta*x' + x = 0", "--method", "averaging"],
            "the amplitude changes",
            "JSON",
        ),
        (
            ["derive", "x'' + x + eps*x^3 = F*cos(Omega*t)", "--method", "averaging"],
            "a drive holds the motion",
            "JSON",
        ),
    ] {
        let refused = run(&[&arguments[..], &["--format", "python"]].concat());
        let said = String::from_utf8_lossy(&refused.stderr);
        assert_eq!(refused.status.code(), Some(1), "{arguments:?}: {said}");
        assert!(refused.stdout.is_empty());
        assert!(
            said.contains("no program: ") && said.contains(reason) && said.contains(help),
            "{said}"
        );
    }
    for command in [
        "compare pendulum --at A=1",
        "impact",
        "simulate examples/simulate/paper.toml",
        "optimize",
        "catalog",
    ] {
        let arguments: Vec<&str> = command.split(' ').chain(["--format", "julia"]).collect();
        let refused = run(&arguments);
        let said = String::from_utf8_lossy(&refused.stderr);
        assert_eq!(refused.status.code(), Some(2), "{command}: {said}");
        assert!(said.contains("--format julia belongs to `lindstedt derive`"), "{command}: {said}");
    }
}

/// How a program looks in every language: a law with a parameter, and one of special functions with
/// a verdict.
#[test]
fn programs_look_as_they_looked() {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(concat!(env!("CARGO_MANIFEST_DIR"), "/snapshots"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| {
        for language in Language::ALL {
            let name = language.name();
            let file = ["derive", "examples/condenser.toml", "--format", name];
            insta::assert_snapshot!(format!("program-condenser-{name}"), output(&file));
            let iterate =
                ["derive", "pendulum", "--method", "iteration-perturbation", "--format", name];
            insta::assert_snapshot!(format!("program-iterate-{name}"), output(&iterate));
        }
        let pair =
            ["derive", "examples/modes/two-masses.toml", "--order", "2", "--format", "matlab"];
        insta::assert_snapshot!("program-modes-matlab", output(&pair));
        let balance = ["derive", "examples/harmonic-balance-duffing.toml", "--format", "python"];
        insta::assert_snapshot!("program-balance-python", output(&balance));
        let exact = ["derive", "pendulum", "--method", "exact", "--format", "python"];
        insta::assert_snapshot!("program-exact-python", output(&exact));
    });
}

/// A derivation that is asked for is there whatever the format.
#[test]
fn a_derivation_stands_in_every_format() {
    let first = "fixes               W1 = 3*eps*A^2/4";
    let json: Value =
        serde_json::from_str(&output(&["derive", "duffing", "--steps", "--format", "json"]))
            .expect("JSON");
    let lines = json["derivation"].as_array().expect("lines");
    assert!(lines.iter().any(|line| line.as_str().is_some_and(|line| line.trim() == first)));
    let plain: Value =
        serde_json::from_str(&output(&["derive", "duffing", "--format", "json"])).expect("JSON");
    assert!(plain.get("derivation").is_none());
    for (language, prefix) in
        [("rust", "// "), ("c", "// "), ("python", "# "), ("julia", "# "), ("matlab", "% ")]
    {
        let text = output(&["derive", "duffing", "--steps", "--format", language]);
        let line = format!("{prefix}    {first}\n");
        assert!(text.contains(&line), "{language}: {text}");
        // What follows is the program without them.
        let program = output(&["derive", "duffing", "--format", language]);
        assert!(text.ends_with(&program), "{language}: {text}");
    }
}
