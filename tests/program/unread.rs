//! Nothing is silently ignored: every option of every command and every key of every file either changes what comes out or is
//! refused by name.

use std::path::PathBuf;
use std::process::{Command, Output};

use lindstedt::impact::sweep::sweep;
use lindstedt::impact::{Model, Parameter, Start};
use lindstedt::problem::{KEYS, Problem, Reader, SimulateError};

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

const FORMULA: &str = "equation = \"x'' + x + eps*x^3 + eps*x^5 = 0\"\n";

const HILL: &str = "equation = \"x'' + (delta + eps*cos(t))*x = 0\"\n";

const MECHANISM: &str = "[lagrangian]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\npotential = \"x^2/2 + x^4/4\"\n";

const MAIN_MASS: &str = "[pendulum]\nstart = 0.25\n[primary]\nmass = 0.5\nstiffness = 50\n";

/// A key, a line that gives it, and what stands beside it.
const LINES: [(&str, &str, &str); 95] = [
    ("equation", "equation = \"x'' + sin(x) = 0\"", ""),
    ("method", "method = \"harmonic-balance\"", FORMULA),
    ("order", "order = 1", FORMULA),
    ("vary", "vary = \"eps=0.5:1.5\"", FORMULA),
    ("periods", "periods = 2", FORMULA),
    ("small", "small = \"A\"", FORMULA),
    ("amplitude", "amplitude = \"first-harmonic\"", FORMULA),
    ("about", "about = \"x = 1\"", "equation = \"x'' - x + x^3 = 0\"\n"),
    ("[values]", "[values]\nA = 0.25\neps = 0.5", FORMULA),
    (
        "[lagrangian] coordinates",
        "[lagrangian]\ncoordinates = [\"u\"]\nkinetic = \"u'^2/2\"\npotential = \"u^2/2 + u^4/4\"",
        "",
    ),
    (
        "[lagrangian] kinetic",
        "kinetic = \"x'^2/3\"",
        "[lagrangian]\ncoordinates = [\"x\"]\n",
    ),
    (
        "[lagrangian] potential",
        "potential = \"x^2/2 + x^4/4\"",
        "[lagrangian]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/3\"\n",
    ),
    ("[lagrangian] dissipation", "dissipation = \"x'^2/4\"", MECHANISM),
    ("[lagrangian] forces", "forces = { x = \"-x^3\" }", MECHANISM),
    ("[units]", "[units]\nx = \"m\"", MECHANISM),
    ("[primary] mass", "[primary]\nmass = 1", ""),
    ("[primary] stiffness", "stiffness = 50", "[primary]\nmass = 1\n"),
    ("[primary] damping", "damping = 0.25", MAIN_MASS),
    ("[primary] displacement", "displacement = 0.25", MAIN_MASS),
    ("[primary] speed", "speed = 0.25", MAIN_MASS),
    ("[primary] force", "force = 0.25", MAIN_MASS),
    ("[primary] frequency", "frequency = 12", MAIN_MASS),
    ("[pendulum] amplitude", "[pendulum]\namplitude = 1.25", ""),
    ("[pendulum] barrier", "[pendulum]\nbarrier = 0.25", ""),
    ("[pendulum] side", "[pendulum]\nside = \"left\"", ""),
    ("[pendulum] start", "[pendulum]\nstart = 0.25", ""),
    ("[pendulum] speed", "[pendulum]\nspeed = 0.25", ""),
    ("[pendulum] mass", "[pendulum]\nmass = 0.02", ""),
    ("[pendulum] length", "[pendulum]\nlength = 0.1", ""),
    ("[pendulum] gravity", "[pendulum]\ngravity = 1.6", ""),
    ("[contact] gamma", "[contact]\ngamma = 1e5", ""),
    ("[contact] force", "[contact]\nforce = \"1e6*d^2\"", ""),
    ("[contact] mu", "[contact]\nmu = 1e5", ""),
    ("[contact] mu_over_gamma", "[contact]\nmu_over_gamma = 0.25", ""),
    ("[contact] lambda", "[contact]\nlambda = 0.25", ""),
    ("[contact] restitution", "[contact]\nrestitution = 0.75", ""),
    (
        "[contact] at_speed",
        "at_speed = 0.25",
        "[contact]\nrestitution = 0.75\n",
    ),
    ("[contact] damping", "[contact]\ndamping = 25", ""),
    ("[contact] law", "[contact]\nlaw = \"homotopy\"", ""),
    (
        "[contact] linearisation",
        "[contact]\nlinearisation = \"equal-energy\"",
        "",
    ),
    ("[damping] zeta", "[damping]\nzeta = 0.25", ""),
    ("[damping] viscous", "[damping]\nviscous = 0.01", ""),
    ("[damping] alpha", "[damping]\nalpha = 0.25", ""),
    ("[damping] torque", "[damping]\ntorque = 1e-4", ""),
    (
        "[damping] friction",
        "friction = \"arctangent\"",
        "[damping]\nalpha = 0.1\n",
    ),
    (
        "[excitation] beta",
        "beta = 0.25",
        "[excitation]\nfrequency_ratio = 0.5\n",
    ),
    (
        "[excitation] frequency_ratio",
        "frequency_ratio = 0.75",
        "[excitation]\nbeta = 0.1\n",
    ),
    ("[design] mass", "[design]\nmass = 0.02", ""),
    ("[design] radius", "[design]\nradius = 0.02", ""),
    ("[design] length", "[design]\nlength = 0.1", ""),
    ("[design] modulus", "[design]\nmodulus = 1e8", ""),
    ("[design] gravity", "[design]\ngravity = 1.6", ""),
    ("[sphere] radius", "[sphere]\nradius = 0.02", ""),
    (
        "[sphere] modulus",
        "[sphere]\nmodulus = 2e11\npoisson = 0.3\n[barrier]\npoisson = 0.3",
        "",
    ),
    ("[sphere] poisson", "[sphere]\npoisson = 0.3", ""),
    ("[sphere] yield", "[sphere]\nyield = 1e7", ""),
    ("[barrier] modulus", "[barrier]\nmodulus = 1e8", ""),
    ("[barrier] poisson", "[barrier]\npoisson = 0.3", ""),
    ("[barrier] yield", "[barrier]\nyield = 1e7", ""),
    ("[run] duration", "[run]\nduration = 25", ""),
    ("[run] integrator_tolerance", "[run]\nintegrator_tolerance = 1e-6", ""),
    ("[run] step_limit", "[run]\nstep_limit = 3", ""),
    ("[[material]]", "[[material]]\nname = \"Cork\"\nmodulus = 2e7", ""),
    ("[limits] mass", "[limits]\nmass = [0.02, 0.05]", ""),
    ("[limits] radius", "[limits]\nradius = [0.002, 0.01]", ""),
    ("[limits] length", "[limits]\nlength = [0.05, 0.2]", ""),
    ("[limits] modulus", "[limits]\nmodulus = [1e9, 1e10]", ""),
    ("[limits] density", "[limits]\ndensity = 7850", ""),
    (
        "[limits] elastic",
        "[limits]\nelastic = true",
        "[sphere]\nyield = 1e9\n",
    ),
    ("[limits] max_rest_time", "[limits]\nmax_rest_time = 9", ""),
    (
        "[limits] max_dimensionless_rest_time",
        "[limits]\nmax_dimensionless_rest_time = 95",
        "",
    ),
    ("[limits] max_peak_force", "[limits]\nmax_peak_force = 200", ""),
    ("[limits] max_peak_pressure", "[limits]\nmax_peak_pressure = 1e9", ""),
    ("[limits] max_impacts", "[limits]\nmax_impacts = 12", ""),
    (
        "[limits] max_primary_rest_time",
        "[primary]\nmass = 0.5\nstiffness = 50\ndamping = 2\ndisplacement = 0.01\n[limits]\nmax_primary_rest_time = 20",
        "",
    ),
    ("[genetic] objective", "[genetic]\nobjective = \"mass\"", ""),
    ("[genetic] population", "[genetic]\npopulation = 20", ""),
    ("[genetic] generations", "[genetic]\ngenerations = 2", ""),
    ("[genetic] elite", "[genetic]\nelite = 5", ""),
    (
        "[genetic] crossover_fraction",
        "[genetic]\ncrossover_fraction = 0.5",
        "",
    ),
    ("[genetic] crossover", "[genetic]\ncrossover = \"scattered\"", ""),
    ("[genetic] crossover_ratio", "[genetic]\ncrossover_ratio = 1.5", ""),
    ("[genetic] mutation", "[genetic]\nmutation = \"bit-flip\"", ""),
    (
        "[genetic] mutation_rate",
        "mutation_rate = 0.1",
        "[genetic]\ncoding = \"bits\"\n",
    ),
    ("[genetic] coding", "[genetic]\ncoding = \"bits\"", ""),
    ("[genetic] bits", "bits = 8", "[genetic]\ncoding = \"bits\"\n"),
    (
        "[genetic] penalty",
        "[genetic]\npenalty = \"feasible-first\"",
        "[limits]\nmax_impacts = 12\n",
    ),
    (
        "[genetic] initial_penalty",
        "initial_penalty = 5",
        "[limits]\nmax_impacts = 12\n[genetic]\npenalty = \"augmented-lagrangian\"\n",
    ),
    (
        "[genetic] penalty_factor",
        "penalty_factor = 5",
        "[limits]\nmax_impacts = 12\n[genetic]\npenalty = \"augmented-lagrangian\"\n",
    ),
    (
        "[genetic] constraint_tolerance",
        "[genetic]\nconstraint_tolerance = 0.5",
        "[limits]\ndensity = 7850\n",
    ),
    ("[genetic] stall_generations", "[genetic]\nstall_generations = 1", ""),
    ("[genetic] function_tolerance", "[genetic]\nfunction_tolerance = 1", ""),
    ("[genetic] stall_test", "[genetic]\nstall_test = \"weighted\"", ""),
    (
        "[genetic] runs",
        "runs = 2",
        "[genetic]\npopulation = 4\nelite = 1\ngenerations = 2\n",
    ),
    ("[genetic] seed", "[genetic]\nseed = 2", ""),
];

#[test]
fn every_key_of_a_file_changes_the_answer_or_is_refused_by_name() {
    let known: Vec<&str> = KEYS.iter().map(|(key, _)| *key).collect();
    assert_eq!(known, LINES.map(|(key, ..)| key), "a line for every key");
    for (key, line, beside) in LINES {
        let (_, word) = key.split_once("] ").unwrap_or(("", key));
        let (_, readers) = KEYS.iter().find(|(known, _)| *known == key).expect("a key");
        for (command, reader) in [
            ("derive", Reader::Derive),
            ("compare", Reader::Compare),
            ("impact", Reader::Impact),
            ("simulate", Reader::Simulate),
            ("materials", Reader::Materials),
            ("optimize", Reader::Optimize),
            ("lagrange", Reader::Lagrange),
            ("stability", Reader::Stability),
        ] {
            // Keys of the top stand first; those of a section that is there already stand in it.
            let (with, without) = match (key.starts_with('['), line.starts_with('[')) {
                (true, false) => (format!("{beside}{line}\n"), beside.to_owned()),
                (true, true) => (format!("{beside}{line}\n"), beside.to_owned()),
                (false, _) => (format!("{line}\n{beside}"), beside.to_owned()),
            };
            // An impact, a study of materials and a search take nothing of [excitation].
            let (with, without) = match (reader, key) {
                (Reader::Impact, "[excitation] beta") => ("[excitation]\nbeta = 0.25\n".to_owned(), String::new()),
                (Reader::Materials | Reader::Optimize, "[excitation] frequency_ratio") => {
                    ("[excitation]\nfrequency_ratio = 0.75\n".to_owned(), String::new())
                }
                _ => (with, without),
            };
            let foreign = matches!(
                reader,
                Reader::Impact | Reader::Simulate | Reader::Materials | Reader::Optimize
            ) && beside.starts_with("equation");
            let (with, without) = match foreign {
                true => (format!("{line}\n"), String::new()),
                false => (with, without),
            };
            // What stands beside a key of a search is no key of the others either.
            let of_search = key.starts_with("[limits]") || key.starts_with("[genetic]");
            let (with, without) = match (key.split_once(' '), line.lines().last()) {
                (Some((section, _)), Some(line)) if of_search && reader != Reader::Optimize => {
                    (format!("{section}\n{line}\n"), String::new())
                }
                _ => (with, without),
            };
            // A search reads a main mass where its rest counts.
            let of_main_mass = reader == Reader::Optimize && key.starts_with("[primary]");
            let wish =
                "[genetic]\nobjective = \"primary_rest_time\"\npopulation = 4\ngenerations = 1\nruns = 1\nelite = 1\n";
            let (with, without) = match of_main_mass {
                true => (
                    format!(
                        "{}displacement = 0.01\n{wish}",
                        with.replace("displacement = 0.25\n", "")
                    ),
                    format!("{}{wish}", without),
                ),
                false => (with, without),
            };
            // A mechanism needs the rest of its impact, and one that is derived a mechanism.
            let foreign = reader == Reader::Lagrange && !key.starts_with("[lagrangian]") && beside != MECHANISM;
            let named_otherwise = foreign && beside.starts_with('[');
            let (with, without) = match foreign {
                true => (format!("{with}{MECHANISM}"), format!("{without}{MECHANISM}")),
                false => (with, without),
            };
            // Periodic coefficients make another equation.
            let hill = reader == Reader::Stability && beside == FORMULA;
            let (with, without) = match hill {
                true => (with.replace(FORMULA, HILL), HILL.to_owned()),
                false => (with, without),
            };
            // What compares needs numbers.
            let mut arguments = vec![command, "--format", "json"];
            if command == "compare" && key != "[values]" {
                arguments.extend(["--at", "A=0.5"]);
                if beside == FORMULA {
                    arguments.extend(["--at", "eps=0.5"]);
                }
            }
            if command == "impact" && beside.starts_with("[lagrangian]") {
                arguments.extend(["--at", "A=0.5", "--at", "xc=0.1", "--at", "gamma=1e4"]);
            }
            // A search is made short.
            if command == "optimize" && key != "[genetic] runs" {
                arguments.extend(["--runs", "1", "--budget", "300"]);
            }
            let answer = of_file("key", &with, &arguments);
            let refused = is_refused(&answer, word);
            let named = refused
                || named_otherwise
                || answer.2.contains("`equation`")
                || ["start", "[lagrangian]", "[primary]"]
                    .iter()
                    .any(|word| answer.2.contains(word));
            if !readers.contains(&reader) {
                assert!(
                    matches!(answer.0, Some(1 | 2)) && named,
                    "`{key}` in a file for {command}: {answer:?}"
                );
                continue;
            }
            let base = of_file("base", &without, &arguments);
            assert!(answer != base, "`{key}` changes nothing for {command}: {answer:?}");
        }
    }
}

/// Steady states of a driven equation.
#[test]
fn every_key_of_a_response_changes_it_or_is_refused_by_name() {
    let equation = "equation = \"x'' + x'/2 + x + eps*x^3 - F*cos(t) = 0\"\n";
    let vary = "vary = \"F=0.5:0.6\"\n";
    let values = "[values]\neps = 0.5\n";
    let base = of_file("response-base", &format!("{equation}{vary}{values}"), &["response"]);
    assert_eq!(base.0, Some(0), "{base:?}");
    for (key, file) in [
        (
            "equation",
            format!("{}{vary}{values}", equation.replace("x'/2", "x'/3")),
        ),
        ("vary", format!("{equation}{}{values}", vary.replace("0.6", "0.7"))),
        ("FROM:TO", format!("{equation}{}{values}", vary.replace(":0.6", ""))),
        ("[values]", format!("{equation}{vary}{}", values.replace("0.5", "0.6"))),
        ("order", format!("{equation}{vary}order = 1\n{values}")),
        ("periods", format!("{equation}{vary}periods = 2\n{values}")),
        ("method", format!("{equation}{vary}method = \"pade\"\n{values}")),
        ("small", format!("{equation}{vary}small = \"eps\"\n{values}")),
        ("run", format!("{equation}{vary}{values}[run]\nduration = 5\n")),
    ] {
        let answer = of_file("response-key", &file, &["response"]);
        assert!(answer != base, "{key}: {answer:?}");
        assert!(answer.0 == Some(0) || answer.2.contains(key), "{key}: {answer:?}");
    }
}

/// An equation or a mechanism of one's own, followed from its start.
#[test]
fn every_key_of_a_motion_of_ones_own_changes_it_or_is_refused_by_name() {
    for (key, line, beside) in LINES {
        let (_, readers) = KEYS.iter().find(|(known, _)| *known == key).expect("a key");
        let of_mechanism = key.starts_with("[lagrangian]") || key == "[units]";
        let (with, without) = match of_mechanism {
            true => (format!("{beside}{line}\n"), beside.to_owned()),
            false if key == "equation" => (format!("{line}\n"), "equation = \"x'' + x = 0\"".to_owned()),
            false => {
                let equation = "equation = \"x'' + eps*x^3 + A = 0\"\n";
                let line = line.replace("A = 0.25\neps = 0.5", "A = 0.25");
                let line = line.replace("A = 0.25", "eps = 0.25");
                let equation = equation.replace(" + A", "");
                let sections = if beside.starts_with('[') { beside } else { "" };
                (format!("{equation}{sections}{line}\n"), format!("{equation}{sections}"))
            }
        };
        let coordinate = if key == "[lagrangian] coordinates" {
            "u=0.5"
        } else {
            "x=0.5"
        };
        let mut arguments = vec!["simulate", "--format", "json", "--from", coordinate];
        if !of_mechanism && key != "equation" && key != "[values]" {
            arguments.extend(["--at", "eps=1"]);
        }
        let answer = of_file("own", &with, &arguments);
        let (_, word) = key.split_once("] ").unwrap_or(("", key));
        match readers.contains(&Reader::Trajectory) {
            false => assert!(
                matches!(answer.0, Some(1 | 2))
                    && (answer.2.contains(word.trim_matches(['[', ']'])) || answer.2.contains("[primary]"))
                    || !beside.is_empty(),
                "`{key}`: {answer:?}"
            ),
            true => assert!(
                answer != of_file("own-base", &without, &arguments),
                "`{key}`: {answer:?}"
            ),
        }
    }
}

#[test]
fn keys_that_others_leave_nothing_to_say_are_refused_with_both_names() {
    for (text, arguments, words) in [
        ("[pendulum]\namplitude = 1\nstart = 0.1", vec![], ["amplitude", "start"]),
        (
            "[excitation]\nfrequency_ratio = 0.5",
            vec![],
            ["frequency_ratio", "beta"],
        ),
        ("[damping]\nfriction = \"exact\"", vec![], ["friction", "alpha"]),
        ("[contact]\nmu = 1\nlambda = 1", vec![], ["mu", "lambda"]),
        (
            "[contact]\nrestitution = 0.8\ndamping = 1",
            vec![],
            ["restitution", "damping"],
        ),
        (
            "[contact]\nlambda = 1\nmu_over_gamma = 1",
            vec![],
            ["lambda", "mu_over_gamma"],
        ),
        ("[contact]\nat_speed = 1", vec![], ["at_speed", "restitution"]),
        ("[damping]\nzeta = 0.1\nviscous = 1", vec![], ["zeta", "viscous"]),
        (
            "[damping]\nalpha = 0.1",
            vec!["--sweep", "torque=0:1e-4:3"],
            ["alpha", "torque"],
        ),
        (
            "[contact]\ngamma = 1e5\nmu_over_gamma = 0.1",
            vec!["--sweep", "length=0.1:0.2:3"],
            ["length", "gamma"],
        ),
        (
            "[contact]\ngamma = 1e5",
            vec!["--sweep", "modulus=1e8:1e9:3"],
            ["modulus", "gamma"],
        ),
        (
            "[contact]\ngamma = 1e5",
            vec!["--sweep", "gravity=1:10:3"],
            ["gravity", "gamma"],
        ),
        (
            "",
            vec!["--sweep", "gamma=1e5:1e6:3", "--sweep", "mass=0.1:0.2:3"],
            ["mass", "gamma"],
        ),
        (
            "[pendulum]\nstart = 0.1",
            vec!["--sweep", "amplitude=0.5:1:3"],
            ["amplitude", "start"],
        ),
        (
            "[pendulum]\namplitude = 1",
            vec!["--sweep", "start=0.1:0.2:3"],
            ["amplitude", "start"],
        ),
        (
            "",
            vec!["--sweep", "frequency_ratio=0.5:1:3"],
            ["frequency_ratio", "beta"],
        ),
        ("[contact]\nmu = 1", vec!["--sweep", "lambda=0:1:3"], ["mu", "lambda"]),
        (
            "[excitation]\nbeta = 0",
            vec!["--sweep", "frequency_ratio=0.5:1:3"],
            ["frequency_ratio", "beta"],
        ),
        ("", vec!["--sweep", "beta=0.1:1:3"], ["beta", "frequency_ratio"]),
        (
            "[pendulum]\nbarrier = false",
            vec!["--sweep", "gamma=1e4:1e5:3:log"],
            ["gamma", "barrier"],
        ),
        (
            "[contact]\ngamma = 1e5\nlambda = 0",
            vec!["--sweep", "length=0.1:0.2:3"],
            ["length", "gamma"],
        ),
    ] {
        let answer = of_file("both", text, &[&["simulate"], arguments.as_slice()].concat());
        assert!(
            words.iter().all(|word| is_refused(&answer, word)),
            "{text}, {arguments:?}: {answer:?}"
        );
    }
    // With lambda, length and gravity have a say: mu = gamma*lambda*sqrt(g*L).
    let swept = of_file(
        "lambda",
        "[contact]\ngamma = 1e5\nlambda = 0.1\n[run]\nduration = 9",
        &["simulate", "--format", "csv", "--sweep", "length=0.1:0.4:2"],
    );
    assert_eq!(swept.0, Some(0), "{swept:?}");
    let rows: Vec<&str> = swept
        .1
        .lines()
        .skip(2)
        .filter_map(|row| row.split_once(','))
        .map(|row| row.1)
        .collect();
    assert_ne!(rows[0], rows[1]);
    // A gamma that is given wins over the design, and says so.
    for command in ["impact", "simulate"] {
        let answer = of_file("wins", "[contact]\ngamma = 1e5\n[design]\nmodulus = 1e8", &[command]);
        assert!(answer.1.contains("given: [design] has no say in it"), "{answer:?}");
    }
}

/// The motions of a grid of two values for each parameter, as the command makes them.
fn grid(file: &str, swept: &[Parameter]) -> Result<Vec<(Model, Start)>, SimulateError> {
    let asked = file.parse::<Problem>().expect("a file").simulate(swept)?;
    (0..1_usize << swept.len())
        .map(|number| {
            let mut case = asked.case;
            for (bit, &parameter) in swept.iter().enumerate() {
                // A swing that reaches its barrier.
                let value = match parameter {
                    Parameter::Amplitude => 0.6,
                    Parameter::Start => -0.55,
                    Parameter::Barrier => 0.1,
                    Parameter::Zeta | Parameter::Alpha | Parameter::Beta => 0.02,
                    Parameter::Viscous => 5e-3,
                    Parameter::Torque => 1e-4,
                    other => 0.2 + 0.01 * f64::from(other as u8),
                };
                // By another ratio each: gamma is that of modulus over mass.
                let ratio = 1.2 + 0.01 * f64::from(parameter as u8);
                case.set(parameter, if number >> bit & 1 == 0 { value } else { value * ratio });
            }
            Ok(case.motion()?)
        })
        .collect()
}

/// Every parameter alone and every pair, beside files that give what might override them: no two rows of a sweep are the
/// same, or the refusal names what is swept and what it would be overridden by.
#[test]
fn what_is_swept_changes_every_row_or_is_refused_with_both_names() {
    const FILES: [&str; 19] = [
        "",
        "[pendulum]\nbarrier = false",
        "[pendulum]\nbarrier = [-1.6, 0.1]",
        "[pendulum]\namplitude = 0.9\nspeed = 0.3",
        "[pendulum]\nstart = -0.8",
        "[pendulum]\nmass = 0.1\nlength = 0.2\ngravity = 2.0\n[sphere]\nradius = 0.1\n[barrier]\nmodulus = 1e5",
        "[contact]\ngamma = 1e3",
        "[contact]\ngamma = 0",
        "[contact]\nmu = 10",
        "[contact]\nlambda = 0.2",
        "[contact]\ngamma = 1e3\nlambda = 0.2",
        "[contact]\ngamma = 1e3\nlambda = 0",
        "[contact]\nrestitution = 0.8",
        "[contact]\nrestitution = 1",
        "[contact]\ngamma = 1e3\ndamping = 1",
        "[contact]\ngamma = 1e3\n[damping]\nviscous = 5e-3\ntorque = 1e-4",
        "[damping]\nzeta = 0.02\nalpha = 0.01\nfriction = \"arctangent\"",
        "[excitation]\nbeta = 0.1\nfrequency_ratio = 0.7",
        "[excitation]\nbeta = 0\nfrequency_ratio = 0.7",
    ];
    let (mut told_apart, mut refused) = (0, 0);
    for file in FILES {
        let settings = ""
            .parse::<Problem>()
            .expect("a file")
            .simulate(&[])
            .expect("a motion")
            .settings;
        let singles = Parameter::ALL.into_iter().map(|parameter| vec![parameter]);
        let pairs = Parameter::ALL.into_iter().flat_map(|first| {
            let later = Parameter::ALL
                .into_iter()
                .filter(move |second| (first as u8) < *second as u8);
            later.map(move |second| vec![first, second])
        });
        for swept in singles.chain(pairs) {
            match grid(file, &swept) {
                Ok(motions) => {
                    let rows =
                        sweep(&motions, lindstedt::impact::Integrator::Taylor, &settings, |_| ()).expect("motions");
                    for (index, row) in rows.iter().enumerate() {
                        assert!(
                            !rows[..index].contains(row),
                            "{file:?}, {swept:?}: two rows are {row:?}"
                        );
                    }
                    told_apart += 1;
                }
                Err(error) => {
                    let text = error.to_string();
                    let says = |parameter: &Parameter| {
                        let mut words = text.split(|c: char| !(c.is_alphanumeric() || c == '_'));
                        words.any(|word| word == parameter.name())
                    };
                    let named = Parameter::ALL.iter().filter(|parameter| says(parameter)).count();
                    assert!(swept.iter().any(says) && named >= 2, "{file:?}, {swept:?}: {text}");
                    refused += 1;
                }
            }
        }
    }
    assert!(
        told_apart > 500 && refused > 300,
        "{told_apart} told apart, {refused} refused"
    );
}

#[test]
fn a_file_for_another_command_is_sent_there() {
    for (command, file, words) in [
        ("derive", "examples/impact-soft.toml", "use `lindstedt impact`"),
        ("compare", "examples/impact-soft.toml", "use `lindstedt impact`"),
        ("derive", "examples/simulate/damper.toml", "`lindstedt simulate`"),
        ("impact", "examples/simulate/damper.toml", "`lindstedt simulate`"),
        ("impact", "examples/simulate/stick-slip.toml", "`lindstedt simulate`"),
        ("impact", "examples/duffing.toml", "gamma=1e6"),
        ("simulate", "examples/duffing.toml", "`lindstedt derive`"),
        ("simulate", "examples/impact-soft.toml", "`lindstedt impact`"),
    ] {
        let path = format!("{}/{file}", env!("CARGO_MANIFEST_DIR"));
        let answer = run(&[command, &path]);
        assert!(is_refused(&answer, words), "{command} {file}: {answer:?}");
    }
}

/// The long options that the help of a command lists.
fn options_of(command: &str) -> Vec<String> {
    let help = run(&[command, "--help"]).1;
    let lines = help.lines().map(str::trim);
    let names = lines.filter_map(|line| {
        let at = line.strip_prefix("-h, ").unwrap_or(line).strip_prefix("--")?;
        at.split([' ', '=']).next().map(str::to_owned)
    });
    names.filter(|name| name != "help").collect()
}

/// A file of claims.
const AUDIT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/audit/frequencies.toml");

#[test]
fn every_option_changes_the_answer_or_is_refused_by_name() {
    let cubic = "x'' + x + eps*x^3 + eps*x^5 = 0";
    let well = "x'' - x + x^3 = 0";
    let cycles = "x'' + x - eps*(1 - x^2 + x^4/20)*x' = 0";
    let file = path("output").with_extension("svg");
    let file = file.to_str().expect("a path in text");
    let simulated = ["simulate"];
    let swept = [
        "simulate",
        "--format",
        "csv",
        "--sweep",
        "zeta=0.1:0.2:2",
        "--sweep",
        "alpha=0.1:0.2:2",
    ];
    let own = ["simulate", "x'' + k*x = 0", "--from", "x=1", "--at", "k=1"];
    let hill = [
        "stability",
        "x'' + (delta + eps*cos(Omega*t))*x = 0",
        "--at",
        "eps=1",
        "--at",
        "Omega=2",
    ];
    let driven = [
        "response",
        "x'' + x'/5 + x + x^3 - F*cos(Omega*t) = 0",
        "--vary",
        "Omega=0.5:1.5",
        "--at",
        "F=0.2",
    ];
    let long = ["simulate", "--sweep", "zeta=0:0.1:3000"];
    // Command, what stands beside the option, the option.
    let table: Vec<(&str, Vec<&str>, Vec<&str>)> = vec![
        ("derive", vec![cubic], vec!["--method", "energy-balance"]),
        ("derive", vec![cubic], vec!["--order", "1"]),
        ("derive", vec![cubic], vec!["--amplitude", "first-harmonic"]),
        ("derive", vec![cubic], vec!["--small", "A"]),
        (
            "derive",
            vec![cubic, "--method", "energy-balance"],
            vec!["--small", "nu"],
        ),
        ("derive", vec![well], vec!["--about", "x=1"]),
        ("derive", vec![cubic], vec!["--taylor", "5"]),
        ("derive", vec![cubic, "--method", "max-min"], vec!["--taylor", "5"]),
        (
            "derive",
            vec!["pendulum", "--method", "parameter-expansion"],
            vec!["--taylor", "5"],
        ),
        ("derive", vec![cubic], vec!["--hbar", "-1/2"]),
        ("derive", vec!["forced-duffing"], vec!["--resonance", "1:3"]),
        ("derive", vec![cubic], vec!["--resonance", "1:3"]),
        (
            "derive",
            vec![cubic, "--method", "multiple-scales"],
            vec!["--resonance", "1:3"],
        ),
        ("derive", vec![cycles], vec!["--cycle", "2"]),
        ("derive", vec!["pendulum"], vec!["--cycle", "1"]),
        (
            "derive",
            vec!["pendulum", "--method", "energy-balance"],
            vec!["--cycle", "1"],
        ),
        ("derive", vec!["pendulum", "--method", "exact"], vec!["--order", "3"]),
        ("derive", vec!["pendulum"], vec!["--at", "A=1"]),
        ("derive", vec!["pendulum"], vec!["--steps"]),
        ("derive", vec!["pendulum"], vec!["--format", "csv"]),
        ("derive", vec!["pendulum"], vec!["--format", "json"]),
        ("derive", vec!["pendulum"], vec!["--output", file]),
        ("derive", vec!["pendulum", "--at", "A=1"], vec!["--plot", "-"]),
        ("derive", vec!["pendulum", "--at", "A=1"], vec!["--tolerance", "1e-9"]),
        ("derive", vec!["pendulum"], vec!["--timeout", "1e-9"]),
        ("derive", vec!["pendulum"], vec!["--quiet"]),
        ("compare", vec![cubic, "--at", "eps=1"], vec!["--at", "A=1"]),
        (
            "compare",
            vec![cubic, "--at", "eps=1", "--at", "A=1", "--format", "json"],
            vec!["--small", "A"],
        ),
        (
            "compare",
            vec![cubic, "--at", "eps=1", "--at", "A=1"],
            vec!["--small", "nu"],
        ),
        ("compare", vec![well, "--at", "A=1/10"], vec!["--about", "x=1"]),
        ("compare", vec!["pendulum", "--at", "A=1"], vec!["--format", "csv"]),
        ("compare", vec!["pendulum", "--at", "A=1"], vec!["--format", "latex"]),
        ("compare", vec!["pendulum", "--at", "A=1"], vec!["--output", file]),
        ("compare", vec!["pendulum", "--at", "A=1"], vec!["--plot", "-"]),
        ("compare", vec!["pendulum", "--at", "A=1"], vec!["--tolerance", "1e-9"]),
        ("compare", vec!["pendulum", "--at", "A=1"], vec!["--timeout", "1e-9"]),
        ("compare", vec!["pendulum", "--at", "A=1"], vec!["--quiet"]),
        ("impact", vec![], vec!["--at", "A=1"]),
        ("impact", vec![], vec!["--method", "pade"]),
        ("impact", vec![], vec!["--order", "6"]),
        ("impact", vec![], vec!["--amplitude", "first-harmonic"]),
        ("impact", vec![], vec!["--force", "gamma*d^2"]),
        ("impact", vec![], vec!["--contact", "power-law"]),
        ("impact", vec![], vec!["--contact", "all"]),
        ("impact", vec!["--compare"], vec!["--contact", "equal-energy"]),
        ("impact", vec!["--compare"], vec!["--contact", "all"]),
        ("impact", vec![], vec!["--left"]),
        ("impact", vec![], vec!["--compare"]),
        ("impact", vec![], vec!["--format", "csv"]),
        ("impact", vec![], vec!["--format", "latex"]),
        ("impact", vec![], vec!["--output", file]),
        ("impact", vec![], vec!["--plot", "-"]),
        ("impact", vec![], vec!["--tolerance", "1e-9"]),
        ("impact", vec![], vec!["--timeout", "1e-9"]),
        ("impact", vec![], vec!["--quiet"]),
        ("simulate", simulated[1..].to_vec(), vec!["--sample", "1"]),
        ("simulate", simulated[1..].to_vec(), vec!["--integrator", "both"]),
        ("simulate", simulated[1..].to_vec(), vec!["--chain"]),
        ("simulate", swept[1..].to_vec(), vec!["--chain"]),
        ("simulate", swept[1..].to_vec(), vec!["--baseline"]),
        ("simulate", simulated[1..].to_vec(), vec!["--baseline"]),
        ("simulate", simulated[1..].to_vec(), vec!["--sweep", "zeta=0:1:2"]),
        ("simulate", simulated[1..].to_vec(), vec!["--jobs", "1"]),
        ("simulate", swept[1..].to_vec(), vec!["--sample", "1"]),
        ("simulate", swept[1..].to_vec(), vec!["--integrator", "both"]),
        ("simulate", simulated[1..].to_vec(), vec!["--format", "latex"]),
        ("simulate", simulated[1..].to_vec(), vec!["--format", "csv"]),
        ("simulate", simulated[1..].to_vec(), vec!["--output", file]),
        ("simulate", simulated[1..].to_vec(), vec!["--plot", "-"]),
        ("simulate", simulated[1..].to_vec(), vec!["--tolerance", "1e-15"]),
        ("simulate", long[1..].to_vec(), vec!["--timeout", "1e-9"]),
        (
            "simulate",
            [&long[1..], &["--timeout", "1e-9"]].concat(),
            vec!["--quiet"],
        ),
        ("simulate", own[1..].to_vec(), vec!["--from", "x'=0.5"]),
        ("simulate", own[1..].to_vec(), vec!["--until", "3"]),
        ("simulate", own[1..4].to_vec(), vec!["--at", "k=2"]),
        ("simulate", own[1..].to_vec(), vec!["--integrator", "both"]),
        ("simulate", own[1..].to_vec(), vec!["--chain"]),
        ("simulate", own[1..].to_vec(), vec!["--sample", "1"]),
        ("simulate", own[1..].to_vec(), vec!["--sweep", "zeta=0:1:2"]),
        ("simulate", own[1..4].to_vec(), vec!["--sweep", "k=1:2:3"]),
        ("simulate", own[1..].to_vec(), vec!["--sweep", "x'=1:2:3"]),
        ("simulate", own[1..].to_vec(), vec!["--every", "pi"]),
        ("simulate", own[1..].to_vec(), vec!["--section", "x'"]),
        ("simulate", own[1..].to_vec(), vec!["--after", "10"]),
        (
            "simulate",
            [&own[1..], &["--every", "pi"]].concat(),
            vec!["--after", "10"],
        ),
        ("simulate", vec![], vec!["--every", "pi"]),
        ("simulate", vec![], vec!["--section", "x'"]),
        ("simulate", vec![], vec!["--after", "1"]),
        ("simulate", own[1..].to_vec(), vec!["--plot", "-"]),
        ("simulate", vec![], vec!["--from", "x=1"]),
        ("simulate", vec![], vec!["--until", "3"]),
        ("simulate", vec![], vec!["--at", "k=2"]),
        ("lagrange", vec![], vec!["--at", "m=1"]),
        ("lagrange", vec![], vec!["--format", "latex"]),
        ("lagrange", vec![], vec!["--output", file]),
        ("lagrange", vec![], vec!["--plot", "-"]),
        ("lagrange", vec![], vec!["--tolerance", "0.1"]),
        ("lagrange", vec![], vec!["--timeout", "1e-9"]),
        ("lagrange", vec![], vec!["--quiet"]),
        ("stability", hill[1..].to_vec(), vec!["--order", "2"]),
        ("stability", hill[1..].to_vec(), vec!["--tongues", "1"]),
        ("stability", hill[1..].to_vec(), vec!["--for", "Omega"]),
        ("stability", hill[1..].to_vec(), vec!["--small", "delta"]),
        ("stability", hill[1..].to_vec(), vec!["--at", "eps=1/2"]),
        ("stability", hill[1..].to_vec(), vec!["--format", "csv"]),
        ("stability", hill[1..].to_vec(), vec!["--format", "latex"]),
        ("stability", hill[1..].to_vec(), vec!["--output", file]),
        ("stability", hill[1..].to_vec(), vec!["--plot", "-"]),
        ("stability", hill[1..].to_vec(), vec!["--tolerance", "1e-9"]),
        ("stability", hill[1..].to_vec(), vec!["--timeout", "1e-9"]),
        ("stability", hill[1..].to_vec(), vec!["--quiet"]),
        ("friction", vec![], vec!["--alpha", "0.1"]),
        ("friction", vec![], vec!["--amplitude", "1"]),
        ("friction", vec![], vec!["--speed", "0.01"]),
        ("friction", vec![], vec!["--format", "latex"]),
        ("friction", vec![], vec!["--output", file]),
        ("friction", vec![], vec!["--plot", "-"]),
        ("friction", vec![], vec!["--tolerance", "0.1"]),
        ("friction", vec![], vec!["--timeout", "1e-9"]),
        ("materials", vec![], vec!["--only-own"]),
        ("materials", vec![], vec!["--chain"]),
        ("materials", vec![], vec!["--format", "latex"]),
        ("materials", vec![], vec!["--output", file]),
        ("materials", vec![], vec!["--plot", "-"]),
        ("materials", vec![], vec!["--tolerance", "0.1"]),
        ("materials", vec![], vec!["--timeout", "1e-9"]),
        ("materials", vec![], vec!["--quiet"]),
        ("optimize", vec!["--runs", "1", "--budget", "300"], vec!["--seed", "2"]),
        ("optimize", vec!["--budget", "300"], vec!["--runs", "2"]),
        // The result is the same for any number of threads.
        ("optimize", vec!["--budget", "300"], vec!["--jobs", "0"]),
        ("optimize", vec!["--runs", "1"], vec!["--budget", "300"]),
        (
            "optimize",
            vec!["--runs", "1", "--budget", "300"],
            vec!["--record", "-"],
        ),
        (
            "optimize",
            vec!["--runs", "1", "--budget", "300"],
            vec!["--resume", "-"],
        ),
        ("optimize", vec!["--budget", "0.000001s"], vec!["--quiet"]),
        (
            "optimize",
            vec!["--runs", "1", "--budget", "300"],
            vec!["--format", "latex"],
        ),
        (
            "optimize",
            vec!["--runs", "1", "--budget", "300"],
            vec!["--output", file],
        ),
        ("optimize", vec!["--runs", "1", "--budget", "300"], vec!["--plot", "-"]),
        (
            "optimize",
            vec!["--runs", "1", "--budget", "300"],
            vec!["--tolerance", "0.1"],
        ),
        (
            "optimize",
            vec!["--runs", "2", "--budget", "600"],
            vec!["--timeout", "1e-9"],
        ),
        (
            "response",
            vec![driven[1], "--at", "F=0.2"],
            vec!["--vary", "Omega=0.5:1.5"],
        ),
        ("response", driven[1..4].to_vec(), vec!["--at", "F=2"]),
        ("response", driven[1..].to_vec(), vec!["--method", "pade"]),
        ("response", driven[1..].to_vec(), vec!["--method", "multiple-scales"]),
        ("response", driven[1..].to_vec(), vec!["--order", "2"]),
        ("response", driven[1..].to_vec(), vec!["--periods", "2"]),
        ("response", driven[1..].to_vec(), vec!["--format", "csv"]),
        ("response", driven[1..].to_vec(), vec!["--format", "latex"]),
        ("response", driven[1..].to_vec(), vec!["--output", file]),
        ("response", driven[1..].to_vec(), vec!["--plot", "-"]),
        (
            "response",
            [&driven[1..], &["--order", "3"]].concat(),
            vec!["--tolerance", "1e-7"],
        ),
        ("response", driven[1..].to_vec(), vec!["--timeout", "1e-9"]),
        ("response", driven[1..].to_vec(), vec!["--quiet"]),
        ("audit", vec![AUDIT], vec!["--strict"]),
        ("audit", vec![AUDIT], vec!["--format", "latex"]),
        ("audit", vec![AUDIT], vec!["--format", "csv"]),
        ("audit", vec![AUDIT], vec!["--output", file]),
        ("audit", vec![AUDIT], vec!["--plot", "-"]),
        ("audit", vec![AUDIT], vec!["--tolerance", "0.1"]),
        ("audit", vec![AUDIT], vec!["--timeout", "1e-9"]),
        ("paper", vec![], vec!["--strict"]),
        ("paper", vec![], vec!["--format", "latex"]),
        ("paper", vec![], vec!["--output", file]),
        ("paper", vec![], vec!["--plot", "-"]),
        ("paper", vec![], vec!["--tolerance", "0.1"]),
        ("paper", vec![], vec!["--timeout", "1e-9"]),
        ("catalog", vec![], vec!["--format", "csv"]),
        ("catalog", vec![], vec!["--format", "json"]),
        ("catalog", vec![], vec!["--output", file]),
        ("catalog", vec![], vec!["--plot", "-"]),
        ("catalog", vec![], vec!["--tolerance", "0.1"]),
        ("catalog", vec![], vec!["--timeout", "1e-9"]),
        ("catalog", vec![], vec!["--quiet"]),
        ("schema", vec!["impact"], vec!["--output", file]),
        ("schema", vec!["impact"], vec!["--quiet"]),
    ];
    for command in [
        "derive",
        "compare",
        "impact",
        "simulate",
        "response",
        "lagrange",
        "friction",
        "materials",
        "optimize",
        "audit",
        "paper",
        "catalog",
        "schema",
    ] {
        for name in options_of(command) {
            let option = format!("--{name}");
            assert!(
                table
                    .iter()
                    .any(|(known, _, words)| *known == command && words[0] == option),
                "{command} {option} is not tried"
            );
        }
    }
    for (command, beside, option) in table {
        let base = run(&[&[command], beside.as_slice()].concat());
        let answer = run(&[&[command], beside.as_slice(), option.as_slice()].concat());
        let word = option[0].trim_start_matches('-');
        let named = !matches!(answer.0, Some(1 | 2))
            || answer.2.contains(word)
            || answer.2.contains(option[option.len() - 1])
            || word == "timeout" && answer.2.contains("stopped after")
            || word == "plot" && answer.2.contains("picture");
        assert!(named, "{command} {beside:?} {option:?}: {answer:?}");
        assert!(
            answer != base,
            "{command} {beside:?}: {option:?} changes nothing: {answer:?}"
        );
    }
    let _ = std::fs::remove_file(file);
}
