//! The keys of files.

use lindstedt::problem::{ReadingCommand, keys};

use super::{is_refused, of_file, run};

const FORMULA: &str = "equation = \"x'' + x + eps*x^3 + eps*x^5 = 0\"\n";

const HILL: &str = "equation = \"x'' + (delta + eps*cos(t))*x = 0\"\n";

const MECHANISM: &str =
    "[lagrangian]\ncoordinates = [\"x\"]\nkinetic = \"x'^2/2\"\npotential = \"x^2/2 + x^4/4\"\n";

const MAIN_MASS: &str = "[pendulum]\nstart = 0.25\n[primary]\nmass = 0.5\nstiffness = 50\n";

/// A key, a line that gives it, and what stands beside it.
const LINES: [(&str, &str, &str); 102] = [
    ("equation", "equation = \"x'' + sin(x) = 0\"", ""),
    ("method", "method = \"harmonic-balance\"", FORMULA),
    ("order", "order = 1", FORMULA),
    ("vary", "vary = \"eps=0.5:1.5\"", FORMULA),
    ("periods", "periods = 2", FORMULA),
    ("of", "of = \"x\"", FORMULA),
    ("along", "along = \"eps=0.5:1.5\"", FORMULA),
    ("small", "small = \"A\"", FORMULA),
    ("resonance", "resonance = \"1:3\"", FORMULA),
    ("amplitude", "amplitude = \"first-harmonic\"", FORMULA),
    ("about", "about = \"x = 1\"", "equation = \"x'' - x + x^3 = 0\"\n"),
    ("static_friction", "static_friction = 2", FORMULA),
    ("[values]", "[values]\nA = 0.25\neps = 0.5", FORMULA),
    (
        "[lagrangian] coordinates",
        "[lagrangian]\ncoordinates = [\"u\"]\nkinetic = \"u'^2/2\"\npotential = \"u^2/2 + u^4/4\"",
        "",
    ),
    ("[lagrangian] kinetic", "kinetic = \"x'^2/3\"", "[lagrangian]\ncoordinates = [\"x\"]\n"),
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
    ("[contact] lambda", "[contact]\nlambda = 0.25", ""),
    ("[contact] mu_over_gamma", "[contact]\nmu_over_gamma = 0.25", ""),
    ("[contact] restitution", "[contact]\nrestitution = 0.75", ""),
    ("[contact] at_speed", "at_speed = 0.25", "[contact]\nrestitution = 0.75\n"),
    ("[contact] damping", "[contact]\ndamping = 25", ""),
    ("[contact] law", "[contact]\nlaw = \"homotopy\"", ""),
    ("[contact] linearisation", "[contact]\nlinearisation = \"equal-energy\"", ""),
    ("[damping] zeta", "[damping]\nzeta = 0.25", ""),
    ("[damping] viscous", "[damping]\nviscous = 0.01", ""),
    ("[damping] alpha", "[damping]\nalpha = 0.25", ""),
    ("[damping] torque", "[damping]\ntorque = 1e-4", ""),
    ("[damping] friction", "friction = \"arctangent\"", "[damping]\nalpha = 0.1\n"),
    ("[excitation] beta", "beta = 0.25", "[excitation]\nfrequency_ratio = 0.5\n"),
    ("[excitation] frequency_ratio", "frequency_ratio = 0.75", "[excitation]\nbeta = 0.1\n"),
    ("[design] mass", "[design]\nmass = 0.02", ""),
    ("[design] radius", "[design]\nradius = 0.02", ""),
    ("[design] length", "[design]\nlength = 0.1", ""),
    ("[design] modulus", "[design]\nmodulus = 1e8", ""),
    ("[design] gravity", "[design]\ngravity = 1.6", ""),
    ("[sphere] radius", "[sphere]\nradius = 0.02", ""),
    ("[sphere] modulus", "[sphere]\nmodulus = 2e11\npoisson = 0.3\n[barrier]\npoisson = 0.3", ""),
    ("[sphere] poisson", "[sphere]\npoisson = 0.3", ""),
    ("[sphere] yield", "[sphere]\nyield = 1e7", ""),
    ("[barrier] modulus", "[barrier]\nmodulus = 1e8", ""),
    ("[barrier] poisson", "[barrier]\npoisson = 0.3", ""),
    ("[barrier] yield", "[barrier]\nyield = 1e7", ""),
    ("[run] duration", "[run]\nduration = 25", ""),
    ("[run] integrator_tolerance", "[run]\nintegrator_tolerance = 1e-6", ""),
    ("[run] step_limit", "[run]\nstep_limit = 3", ""),
    ("[[material]]", "[[material]]\nname = \"Cork\"\nmodulus = 2e7", ""),
    ("[[wall]]", "[[wall]]\nbound = \"x < 9\"\nrestitution = 1", FORMULA),
    ("[[wall]] contact", "[[wall]]\nbound = \"x < 9\"\ncontact = \"hertz K=1\"", FORMULA),
    ("[[event]]", "[[event]]\nwhen = \"x < 0\"\nset = \"x' = -x'\"", FORMULA),
    ("[limits] mass", "[limits]\nmass = [0.02, 0.05]", ""),
    ("[limits] radius", "[limits]\nradius = [0.002, 0.01]", ""),
    ("[limits] length", "[limits]\nlength = [0.05, 0.2]", ""),
    ("[limits] modulus", "[limits]\nmodulus = [1e9, 1e10]", ""),
    ("[limits] density", "[limits]\ndensity = 7850", ""),
    ("[limits] elastic", "[limits]\nelastic = true", "[sphere]\nyield = 1e9\n"),
    ("[limits] max_rest_time", "[limits]\nmax_rest_time = 9", ""),
    ("[limits] max_dimensionless_rest_time", "[limits]\nmax_dimensionless_rest_time = 95", ""),
    ("[limits] max_peak_force", "[limits]\nmax_peak_force = 200", ""),
    ("[limits] max_peak_pressure", "[limits]\nmax_peak_pressure = 1e9", ""),
    ("[limits] max_impacts", "[limits]\nmax_impacts = 12", ""),
    (
        "[limits] max_primary_rest_time",
        "[primary]\nmass = 0.5\nstiffness = 50\ndamping = 2\ndisplacement = 0.01\n[genetic]\npopulation = 4\nelite = 1\ngenerations = 1\n[limits]\nmax_primary_rest_time = 20",
        "",
    ),
    ("[genetic] objective", "[genetic]\nobjective = \"mass\"", ""),
    ("[genetic] population", "[genetic]\npopulation = 20", ""),
    ("[genetic] generations", "[genetic]\ngenerations = 2", ""),
    ("[genetic] elite", "[genetic]\nelite = 5", ""),
    ("[genetic] crossover_fraction", "[genetic]\ncrossover_fraction = 0.5", ""),
    ("[genetic] crossover", "[genetic]\ncrossover = \"scattered\"", ""),
    ("[genetic] crossover_ratio", "[genetic]\ncrossover_ratio = 1.5", ""),
    ("[genetic] mutation", "[genetic]\nmutation = \"bit-flip\"", ""),
    ("[genetic] mutation_rate", "mutation_rate = 0.1", "[genetic]\ncoding = \"bits\"\n"),
    ("[genetic] coding", "[genetic]\ncoding = \"bits\"", ""),
    ("[genetic] bits", "bits = 8", "[genetic]\ncoding = \"bits\"\n"),
    ("[genetic] penalty", "[genetic]\npenalty = \"death\"", "[limits]\nmax_impacts = 12\n"),
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
    ("[genetic] runs", "runs = 2", "[genetic]\npopulation = 4\nelite = 1\ngenerations = 2\n"),
    ("[genetic] seed", "[genetic]\nseed = 2", ""),
];

#[test]
fn every_key_of_a_file_changes_the_answer_or_is_refused_by_name() {
    let known: Vec<String> = keys().map(|(key, _)| key).collect();
    assert_eq!(known, LINES.map(|(key, ..)| key), "a line for every key");
    for (key, line, beside) in LINES {
        let (_, word) = key.split_once("] ").unwrap_or(("", key));
        let (_, readers) = keys().find(|(known, _)| known == key).expect("a key");
        for (command, reader) in [
            ("derive", ReadingCommand::Derive),
            ("compare", ReadingCommand::Compare),
            ("impact", ReadingCommand::Impact),
            ("simulate", ReadingCommand::Simulate),
            ("materials", ReadingCommand::Materials),
            ("optimize", ReadingCommand::Optimize),
            ("lagrange", ReadingCommand::Lagrange),
            ("stability", ReadingCommand::Stability),
        ] {
            // Keys of the top stand first; those of a section that is there already stand in it.
            let (with, without) = match (key.starts_with('['), line.starts_with('[')) {
                (true, false) => (format!("{beside}{line}\n"), beside.to_owned()),
                (true, true) => (format!("{beside}{line}\n"), beside.to_owned()),
                (false, _) => (format!("{line}\n{beside}"), beside.to_owned()),
            };
            // An impact, a study of materials and a search take nothing of [excitation].
            let (with, without) = match (reader, key) {
                (ReadingCommand::Impact, "[excitation] beta") => {
                    ("[excitation]\nbeta = 0.25\n".to_owned(), String::new())
                }
                (
                    ReadingCommand::Materials | ReadingCommand::Optimize,
                    "[excitation] frequency_ratio",
                ) => ("[excitation]\nfrequency_ratio = 0.75\n".to_owned(), String::new()),
                _ => (with, without),
            };
            let foreign = matches!(
                reader,
                ReadingCommand::Impact
                    | ReadingCommand::Simulate
                    | ReadingCommand::Materials
                    | ReadingCommand::Optimize
            ) && beside.starts_with("equation");
            let (with, without) = match foreign {
                true => (format!("{line}\n"), String::new()),
                false => (with, without),
            };
            // What stands beside a key of a search is no key of the others either.
            let of_search = key.starts_with("[limits]") || key.starts_with("[genetic]");
            let (with, without) = match (key.split_once(' '), line.lines().last()) {
                (Some((section, _)), Some(line))
                    if of_search && reader != ReadingCommand::Optimize =>
                {
                    (format!("{section}\n{line}\n"), String::new())
                }
                _ => (with, without),
            };
            // A search reads a main mass where its rest counts.
            let of_main_mass = reader == ReadingCommand::Optimize && key.starts_with("[primary]");
            let wish = "[genetic]\nobjective = \"primary_rest_time\"\npopulation = 4\ngenerations = 1\nruns = 1\nelite = 1\n";
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
            let foreign = reader == ReadingCommand::Lagrange
                && !key.starts_with("[lagrangian]")
                && beside != MECHANISM;
            let named_otherwise = foreign && beside.starts_with('[');
            let (with, without) = match foreign {
                true => (format!("{with}{MECHANISM}"), format!("{without}{MECHANISM}")),
                false => (with, without),
            };
            // Periodic coefficients make another equation.
            let hill = reader == ReadingCommand::Stability && beside == FORMULA;
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
        ("equation", format!("{}{vary}{values}", equation.replace("x'/2", "x'/3"))),
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
        let (_, readers) = keys().find(|(known, _)| known == key).expect("a key");
        let of_mechanism = key.starts_with("[lagrangian]") || key == "[units]";
        let (with, without) = match of_mechanism {
            true => (format!("{beside}{line}\n"), beside.to_owned()),
            false if key == "equation" => {
                (format!("{line}\n"), "equation = \"x'' + x = 0\"".to_owned())
            }
            false => {
                let equation = "equation = \"x'' + eps*x^3 + A = 0\"\n";
                let line = line.replace("A = 0.25\neps = 0.5", "A = 0.25");
                let line = line.replace("A = 0.25", "eps = 0.25");
                let equation = equation.replace(" + A", "");
                let sections = if beside.starts_with('[') { beside } else { "" };
                (format!("{equation}{sections}{line}\n"), format!("{equation}{sections}"))
            }
        };
        let coordinate = if key == "[lagrangian] coordinates" { "u=0.5" } else { "x=0.5" };
        let mut arguments = vec!["simulate", "--format", "json", "--from", coordinate];
        if !of_mechanism && key != "equation" && key != "[values]" {
            arguments.extend(["--at", "eps=1"]);
        }
        let answer = of_file("own", &with, &arguments);
        let (_, word) = key.split_once("] ").unwrap_or(("", key));
        match readers.contains(&ReadingCommand::Trajectory) {
            false => assert!(
                matches!(answer.0, Some(1 | 2))
                    && (answer.2.contains(word.trim_matches(['[', ']']))
                        || answer.2.contains("[primary]"))
                    || !beside.is_empty(),
                "`{key}`: {answer:?}"
            ),
            true => {
                assert!(answer != of_file("own-base", &without, &arguments), "`{key}`: {answer:?}")
            }
        }
    }
}

#[test]
fn keys_that_others_leave_nothing_to_say_are_refused_with_both_names() {
    for (text, arguments, words) in [
        ("[pendulum]\namplitude = 1\nstart = 0.1", vec![], ["amplitude", "start"]),
        ("[excitation]\nfrequency_ratio = 0.5", vec![], ["frequency_ratio", "beta"]),
        ("[damping]\nfriction = \"exact\"", vec![], ["friction", "alpha"]),
        ("[contact]\nmu = 1\nlambda = 1", vec![], ["mu", "lambda"]),
        ("[contact]\nrestitution = 0.8\ndamping = 1", vec![], ["restitution", "damping"]),
        ("[contact]\nlambda = 1\nmu_over_gamma = 1", vec![], ["lambda", "mu_over_gamma"]),
        ("[contact]\nat_speed = 1", vec![], ["at_speed", "restitution"]),
        ("[damping]\nzeta = 0.1\nviscous = 1", vec![], ["zeta", "viscous"]),
        ("[damping]\nalpha = 0.1", vec!["--sweep", "torque=0:1e-4:3"], ["alpha", "torque"]),
        (
            "[contact]\ngamma = 1e5\nmu_over_gamma = 0.1",
            vec!["--sweep", "length=0.1:0.2:3"],
            ["length", "gamma"],
        ),
        ("[contact]\ngamma = 1e5", vec!["--sweep", "modulus=1e8:1e9:3"], ["modulus", "gamma"]),
        ("[contact]\ngamma = 1e5", vec!["--sweep", "gravity=1:10:3"], ["gravity", "gamma"]),
        ("", vec!["--sweep", "gamma=1e5:1e6:3", "--sweep", "mass=0.1:0.2:3"], ["mass", "gamma"]),
        ("[pendulum]\nstart = 0.1", vec!["--sweep", "amplitude=0.5:1:3"], ["amplitude", "start"]),
        ("[pendulum]\namplitude = 1", vec!["--sweep", "start=0.1:0.2:3"], ["amplitude", "start"]),
        ("", vec!["--sweep", "frequency_ratio=0.5:1:3"], ["frequency_ratio", "beta"]),
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
    let rows: Vec<&str> =
        swept.1.lines().skip(2).filter_map(|row| row.split_once(',')).map(|row| row.1).collect();
    assert_ne!(rows[0], rows[1]);
    // A gamma that is given wins over the design, and says so.
    for command in ["impact", "simulate"] {
        let answer = of_file("wins", "[contact]\ngamma = 1e5\n[design]\nmodulus = 1e8", &[command]);
        assert!(answer.1.contains("given: [design] has no say in it"), "{answer:?}");
    }
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
