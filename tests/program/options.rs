//! Every option of the command line does what its help says: with it the answer is another one, and
//! the right one.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .args(arguments)
        .output()
        .expect("the program starts")
}

fn json(arguments: &[&str]) -> Value {
    let output = run(&[arguments, &["--format", "json"]].concat());
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {message}");
    serde_json::from_slice(&output.stdout).expect("the output is JSON")
}

/// The law for omega^2 as it is printed.
fn law(arguments: &[&str]) -> String {
    let output = run(&[&["derive"], arguments].concat());
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {message}");
    let text = String::from_utf8(output.stdout).expect("text");
    let mut lines = text.lines().skip_while(|line| !line.trim().starts_with("omega^2 = "));
    let first = lines.next().unwrap_or_else(|| panic!("no law in {text}")).trim().to_owned();
    // A long one goes on below its first term.
    let rest = lines.take_while(|line| line.starts_with("            "));
    rest.fold(first, |law, line| law + " " + line.trim())
}

/// A folder of its own for each test.
fn folder(name: &str) -> PathBuf {
    let folder =
        std::env::temp_dir().join(format!("lindstedt-options-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

fn text(path: &Path) -> &str {
    path.to_str().expect("a path in text")
}

#[test]
fn a_mode_is_chosen_by_its_number() {
    let pair = "x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0";
    let numbers = |more: &[&str]| -> Vec<Value> {
        let document = json(&[&["derive", pair], more].concat());
        let modes = document["modes"].as_array().expect("modes").iter();
        modes.map(|mode| mode["number"].clone()).collect()
    };
    assert_eq!(numbers(&[]), [1, 2]);
    assert_eq!(numbers(&["--mode", "2"]), [2]);
    let initial = json(&["derive", pair, "--mode", "1", "--amplitude", "initial", "--order", "2"]);
    assert_eq!(initial["modes"][0]["formula"], "omega^2 = 1 + 3*A^2/16");
    assert_eq!(initial["modes"][0]["order"], 2);
    // The cube of cos(theta) is three quarters of it and a quarter of cos(3*theta).
    let steps = json(&["derive", pair, "--mode", "1", "--order", "2", "--steps"]);
    let lines = steps["modes"][0]["derivation"].as_array().expect("lines");
    for line in [
        "x3'' + 2*x3 - y3 = (-3/8 + W2)*cos(theta) - 1/8*cos(3*theta)",
        "y3'' - x3 + 2*y3 = W2*cos(theta)",
        "no secular cos(theta) along the mode:  W2 = 3/16",
    ] {
        assert!(lines.contains(&line.into()), "{lines:?}");
    }
    // Of slow equations: by hand, the term alpha1*u*v at exp(i*t) is B2 times the conjugate of B1.
    let slow = "u'' + 2*mu*u' + u = alpha*u*v; v'' + 4*v = u^2/3";
    let steps = json(&["derive", slow, "--resonance", "omega2 = 2*omega1", "--steps"]);
    let lines = steps["derivation"].as_array().expect("lines");
    for line in [
        "eta1_0 = B1*exp(i*t)",
        "no exp(i*t) on the right:  2*D1B1*i = alpha*B2*Bc1 - 2*B1*i*mu",
        "fixes:  D1B2 = -B1^2*i/12",
        "eta2_1 = B1*Bc1/12",
    ] {
        assert!(lines.contains(&line.into()), "{lines:?}");
    }
    for (more, words) in [
        (&["--mode", "3"][..], "there is no mode 3: there are 2"),
        (&["--taylor", "3"], "--taylor: it is of one coordinate"),
        (&["--method", "max-min"], "are derived by lindstedt-poincare"),
        (
            &["--method", "averaging", "--order", "3"],
            "averaging of coupled equations is of the first order",
        ),
        (&["--steps", "--method", "harmonic-balance"], "--steps: one harmonic has no orders"),
    ] {
        let output = run(&[&["derive", pair], more].concat());
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && message.contains(words), "{more:?}: {message}");
    }
    let one = run(&["derive", "duffing", "--mode", "1"]);
    assert!(String::from_utf8_lossy(&one.stderr).contains("one coordinate has one mode"));
}

/// Values that a verdict lacks are named beside the formulas; with all of them the law stands in numbers.
#[test]
fn modes_are_derived_without_the_values_of_a_verdict() {
    let three = "x'' + k*(2*x - y) + b*x^3 = 0; y'' + k*(2*y - x - z) = 0; z'' + k*(2*z - y) = 0";
    let message = |arguments: &[&str]| {
        let output = run(&[&["derive"], arguments].concat());
        assert!(output.status.success(), "{arguments:?}");
        [output.stderr, output.stdout].map(|text| String::from_utf8(text).expect("text"))
    };
    let [note, answer] = message(&[three, "--order", "2", "--at", "k=1"]);
    assert_eq!(note, "note: not judged, values are needed for: `b`, `a`, the amplitude\n");
    assert!(answer.contains("b*a^2") && !answer.contains("verdict"), "{answer}");
    let letters = "m*x'' + 2*x - y + b*x^3 = 0; y'' + 2*y - x = 0";
    let [note, answer] = message(&[letters, "--order", "2", "--at", "m=1,b=2,a=0.1"]);
    assert!(note.is_empty() && answer.contains("omega^2 in numbers"), "{note}{answer}");
    // A mass that cancels may have a value all the same.
    let folder = folder("cancelled");
    let file = folder.join("pendulum.toml");
    let mechanism = "[lagrangian]\ncoordinates = [\"u\"]\nkinetic = \"m*R^2*u'^2/2\"\npotential = \"-m*g*R*cos(u)\"\n";
    std::fs::write(&file, mechanism).expect("a file");
    let [_, answer] = message(&[text(&file), "--order", "2", "--at", "m=1,R=1,g=10,A=0.1"]);
    assert!(answer.contains("verdict"), "{answer}");
    std::fs::remove_dir_all(folder).expect("the folder is removed");
}

#[test]
fn the_result_goes_to_the_file_of_output_alone() {
    let folder = folder("output");
    let path = folder.join("result");
    for command in [
        vec!["derive", "duffing"],
        vec!["compare", "pendulum", "--at", "A=1"],
        vec!["impact"],
        vec!["simulate", "--sample", "1", "--format", "json"],
        vec!["catalog", "--format", "json"],
    ] {
        let printed = run(&command);
        let to_file = run(&[command.as_slice(), &["--output", text(&path)]].concat());
        assert!(printed.status.success() && to_file.status.success(), "{command:?}");
        assert!(to_file.stdout.is_empty() && !printed.stdout.is_empty(), "{command:?}");
        assert_eq!(std::fs::read(&path).expect("the file"), printed.stdout, "{command:?}");
        // A second result takes the place of the first, and nothing lies about.
        assert_eq!(std::fs::read_dir(&folder).expect("a folder").count(), 1);
    }
    std::fs::remove_dir_all(folder).expect("the folder goes");
}

#[cfg(unix)]
#[test]
fn a_replaced_file_keeps_its_permissions_and_its_links() {
    use std::os::unix::fs::{PermissionsExt as _, symlink};
    let folder = folder("links");
    let (file, link) = (folder.join("file"), folder.join("link"));
    std::fs::write(&file, "old").expect("a file");
    std::fs::set_permissions(&file, std::fs::Permissions::from_mode(0o640)).expect("permissions");
    symlink(&file, &link).expect("a link");
    assert!(run(&["derive", "duffing", "--output", text(&link)]).status.success());
    assert!(link.symlink_metadata().expect("a link").file_type().is_symlink());
    assert_eq!(std::fs::read(&file).expect("the file"), run(&["derive", "duffing"]).stdout);
    assert_eq!(file.metadata().expect("the file").permissions().mode() & 0o777, 0o640);
    // The problem under another name is still the problem.
    let problem = folder.join("problem.toml");
    std::fs::write(&problem, "equation = \"x'' + sin(x) = 0\"\n").expect("a file");
    let alias = folder.join("alias");
    symlink(&problem, &alias).expect("a link");
    let refused = run(&["derive", text(&problem), "--output", text(&alias)]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("is the file that is read"));
    std::fs::remove_dir_all(folder).expect("the folder goes");
}

#[cfg(unix)]
#[test]
fn a_pipe_is_written_and_not_replaced() {
    use std::io::Read as _;
    use std::os::unix::fs::FileTypeExt as _;
    let folder = folder("pipe");
    let path = folder.join("pipe");
    let made = Command::new("mkfifo").arg(&path).status().expect("mkfifo starts");
    assert!(made.success());
    // Open at both ends, so that neither side waits for the other.
    let open = std::fs::OpenOptions::new().read(true).write(true).open(&path);
    let mut pipe = open.expect("the pipe opens");
    let expected = run(&["derive", "duffing"]).stdout;
    assert!(run(&["derive", "duffing", "--output", text(&path)]).status.success());
    assert!(path.metadata().expect("the pipe").file_type().is_fifo());
    let mut found = vec![0; expected.len()];
    pipe.read_exact(&mut found).expect("what was written");
    assert_eq!(found, expected);
    std::fs::remove_dir_all(folder).expect("the folder goes");
}

#[test]
fn a_hyphen_is_standard_input() {
    use std::io::Write as _;
    let from_input = |arguments: &[&str], input: &str| {
        let mut child = Command::new(env!("CARGO_BIN_EXE_lindstedt"))
            .args(arguments)
            .stdin(std::process::Stdio::piped())
            .stdout(std::process::Stdio::piped())
            .stderr(std::process::Stdio::piped())
            .spawn()
            .expect("the program starts");
        let mut pipe = child.stdin.take().expect("a pipe");
        pipe.write_all(input.as_bytes()).expect("the program reads");
        drop(pipe);
        let output = child.wait_with_output().expect("the program ends");
        (output.stdout, String::from_utf8_lossy(&output.stderr).into_owned())
    };
    let folder = folder("input");
    let path = folder.join("problem.toml");
    let input = "[pendulum]\namplitude = 1.2\nbarrier = 0.1\n";
    std::fs::write(&path, input).expect("a file");
    for command in ["simulate", "impact"] {
        let (found, _) = from_input(&[command, "-"], input);
        assert!(!found.is_empty() && found == run(&[command, text(&path)]).stdout, "{command}");
    }
    // A mistake in it is one in standard input.
    let wrong = from_input(&["simulate", "-"], "[pendulum]\namplitud = 1.2\n");
    assert!(wrong.1.starts_with("error: standard input: "), "{}", wrong.1);
    let input = "equation = \"x'' + 4*sin(x) = 0\"\n";
    std::fs::write(&path, input).expect("a file");
    assert_eq!(from_input(&["derive", "-"], input).0, run(&["derive", text(&path)]).stdout);
    assert_eq!(
        from_input(&["derive", "-"], "x'' + 4*sin(x) = 0").0,
        run(&["derive", text(&path)]).stdout
    );
    std::fs::remove_dir_all(folder).expect("the folder goes");
}

/// A limit of the algebra is met once, at the beginning, and not by every method in turn.
#[test]
fn what_is_too_long_is_refused_once() {
    let wide = "x'' + (x + y + z + 1)^60 - (y + z + 1)^60 + x = 0";
    for (arguments, message) in [
        (
            vec!["compare", wide, "--at", "A=0.1", "--at", "y=0", "--at", "z=0"],
            "stopped at 100000 terms",
        ),
        (
            vec!["derive", "x'' + x*(1 + x^2)^50 = 0", "--method", "homotopy-analysis"],
            "the power 101 in the equation gives 201 harmonics",
        ),
    ] {
        let output = run(&arguments);
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(error.matches(message).count(), 1, "{error}");
        assert!(output.status.code() == Some(1) && output.stdout.is_empty(), "{error}");
    }
}

#[test]
fn a_time_limit_ends_what_takes_longer() {
    // It waits for an equation that never comes: that the test ends at all is the limit's doing.
    let mut child = Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .args(["derive", "-", "--timeout", "0.05"])
        .stdin(std::process::Stdio::piped())
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .expect("the program starts");
    let open = child.stdin.take();
    let output = child.wait_with_output().expect("the program ends");
    drop(open);
    assert_eq!(output.status.code(), Some(1));
    assert!(output.stdout.is_empty());
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(message.contains("stopped after 0.05 s without a result"), "{message}");
    assert!(run(&["derive", "duffing", "--timeout", "3600"]).status.success());
}

#[test]
fn the_command_line_wins_over_the_file() {
    let folder = folder("file");
    let path = folder.join("problem.toml");
    std::fs::write(
        &path,
        "equation = \"x'' + x + eps*x^3 + eps*x^5 = 0\"\norder = 1\nsmall = \"eps\"\namplitude = \"first-harmonic\"\n\
         [values]\na = 2\neps = \"1/10\"\n",
    )
    .expect("a file");
    let file = text(&path);
    let of_file = json(&["derive", file]);
    assert_eq!((&of_file["order"], &of_file["small_parameter"]), (&1.into(), &"eps".into()));
    for (option, key, value) in [
        (["--order", "2"], "order", Value::from(2)),
        (["--small", "A"], "small_parameter", "a".into()),
    ] {
        let found = json(&[&["derive", file], &option[..]].concat());
        assert_eq!(found[key], value, "{option:?}");
        assert_ne!(found["frequency_squared"], of_file["frequency_squared"], "{option:?}");
    }
    // A value of the command line takes the place of the file's, the others stay.
    let judged = json(&["derive", file, "--at", "a=1"]);
    assert_eq!(judged["verification"]["at"]["a"]["exact"], "1");
    assert_eq!(judged["verification"]["at"]["eps"]["exact"], "1/10");
    std::fs::write(&path, "equation = \"x'' + x + x^3 = 0\"\namplitude = \"first-harmonic\"\n")
        .expect("a file");
    assert_eq!(json(&["derive", file])["amplitude"], "first-harmonic");
    assert_eq!(json(&["derive", file, "--amplitude", "initial"])["amplitude"], "initial");
    std::fs::remove_dir_all(folder).expect("the folder goes");
}

#[test]
fn options_of_a_derivation_change_it() {
    let equation = "x'' + x + eps*delta*x^3 = 0";
    let with_small = |name: &str| law(&[equation, "--small", name, "--order", "1"]);
    assert_eq!(with_small("eps"), "omega^2 = 1 + 3*delta*eps*A^2/4");
    let expansion =
        |name: &str| json(&["derive", equation, "--small", name])["small_parameter"].clone();
    assert_eq!(["eps", "delta", "A"].map(expansion), ["eps", "delta", "A"].map(Value::from));

    // J_1 of a sine, cut after the degree asked for: 2 J_1(A)/A = 1 - A^2/8 + A^4/192 - ...
    let taylor = |degree: &str| {
        law(&["pendulum", "--method", "homotopy-perturbation", "--order", "1", "--taylor", degree])
    };
    assert_eq!(taylor("3"), "omega^2 = 1 - A^2/8");
    assert_eq!(taylor("5"), "omega^2 = 1 - A^2/8 + A^4/192");
    assert_eq!(taylor("7"), "omega^2 = 1 - A^2/8 + A^4/192 - A^6/9216");

    // The averaged equation 1 - r/4 + r^2/160 = 0 in r = a^2 has two roots.
    let cycles = "x'' + x - eps*(1 - x^2 + x^4/20)*x' = 0";
    for (number, sign) in [("1", -1.0), ("2", 1.0)] {
        let root = (20.0 + sign * 240.0_f64.sqrt()).sqrt();
        let output = run(&["derive", cycles, "--cycle", number]);
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let line = text.lines().find(|line| line.trim().starts_with('*'));
        let line = line.unwrap_or_else(|| panic!("no cycle in {text}"));
        let value = line.split(" = ").nth(2).and_then(|rest| rest.split(',').next());
        let value: f64 = value.and_then(|value| value.parse().ok()).expect("a number");
        assert!((value - root).abs() < 1e-5, "{line}");
    }

    let wells = "x'' + x*(x^2 - 1)*(x^2 - 4) = 0";
    let leading = |about: &[&str]| {
        let found = json(&[&["derive", wells, "--at", "A=1/10000"], about].concat());
        found["verification"]["frequency"].as_f64().expect("a number")
    };
    // f' = 5 x^4 - 15 x^2 + 4: 4 at rest, 24 at x = 2.
    for (about, squared) in
        [(&[][..], 4.0_f64), (&["--about", "x=0"], 4.0), (&["--about", "x=-2"], 24.0)]
    {
        assert!((leading(about) / squared.sqrt() - 1.0).abs() < 1e-6, "{about:?}");
    }
    let refused = run(&["derive", wells, "--about", "x=1"]);
    assert_eq!(refused.status.code(), Some(1));

    let hbar = |value: &str| {
        let arguments =
            ["--method", "homotopy-analysis", "--hbar", value, "--at", "A=1", "--at", "eps=1"];
        json(&[&["derive", "duffing"], &arguments[..]].concat())["verification"]["frequency"]
            .clone()
    };
    assert_ne!(hbar("-1"), hbar("-1/2"));
}

/// The error of a verdict lies between the tolerances at which it changes.
#[test]
fn a_verdict_changes_at_the_tolerance_itself() {
    for arguments in [
        vec!["derive", "pendulum", "--at", "A=1"],
        vec!["derive", "duffing", "--at", "A=1", "--at", "eps=1"],
        vec!["derive", "duffing", "--at", "A=1", "--at", "eps=1", "--method", "energy-balance"],
        vec!["compare", "pendulum", "--at", "A=1"],
        vec!["impact", "--order", "2"],
    ] {
        let document = json(&arguments);
        let size = |value: &Value| value.as_f64().expect("a number").abs();
        let error = match arguments[0] {
            "derive" => size(&document["verification"]["relative_error"]),
            "compare" => {
                let rows = document["methods"].as_array().expect("methods").iter();
                let judged = rows.filter(|row| row["applies"] == true);
                judged.map(|row| size(&row["relative_error"])).fold(0.0, f64::max)
            }
            _ => {
                // The closest of the readings decides.
                let contact = &document["contact"];
                let quantities = || {
                    let speed = [&contact["speed"], &contact["penetration"], &contact["duration"]];
                    speed.into_iter().chain([&document["time_to_contact"], &document["period"]])
                };
                let reading = |name: &str| {
                    let shapes = &document["verification"][name]["max_deviation_of_shape"];
                    let shapes = shapes.as_array().expect("three phases").iter().map(size);
                    let key = format!("{name}_error");
                    let numbers = quantities().map(|quantity| size(&quantity[&key]));
                    numbers.chain(shapes).fold(0.0, f64::max)
                };
                ["paper", "energy", "derived"]
                    .map(reading)
                    .into_iter()
                    .fold(f64::INFINITY, f64::min)
            }
        };
        for (factor, code) in [(1.001, 0), (0.999, 3)] {
            let tolerance = (factor * error).to_string();
            let output = run(&[arguments.as_slice(), &["--tolerance", &tolerance]].concat());
            assert_eq!(output.status.code(), Some(code), "{arguments:?} at {tolerance}");
        }
    }
}

#[test]
fn quiet_leaves_notes_out_and_results_in() {
    let folder = folder("quiet");
    let path = folder.join("fast.toml");
    std::fs::write(&path, "[pendulum]\nstart = 0\nspeed = 1e300\n").expect("a file");
    let loud = run(&["simulate", text(&path)]);
    let quiet = run(&["simulate", text(&path), "--quiet"]);
    assert!(!loud.stderr.is_empty() && quiet.stderr.is_empty());
    assert_eq!(loud.stdout, quiet.stdout);
    assert_eq!(quiet.status.code(), Some(4));
    std::fs::remove_dir_all(folder).expect("the folder goes");
}

/// A number on the command line wins over that of the file, whatever key it has there.
#[test]
fn a_number_of_an_impact_wins_over_the_file() {
    let soft = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/impact-soft.toml");
    let document = json(&["impact", soft, "--at", "A=1.25", "--at", "xc=1/4", "--at", "gamma=2e5"]);
    let parameters = &document["parameters"];
    for (key, value) in [("amplitude", 1.25), ("barrier", 0.25), ("gamma", 2e5)] {
        assert_eq!(parameters[key].as_f64(), Some(value), "{key}");
    }
}

/// Letters in several combinations, which a quadratic approximant does not take, are answered by
/// the numbers given for them.
#[test]
fn numbers_given_for_letters_answer_as_numbers_typed() {
    let method = ["--method", "hermite-pade", "--at", "A=1/2"];
    let letters = ["derive", "x'' + x + b*x^3 + c*x^5 = 0", "--at", "b=1/3", "--at", "c=-1/7"];
    let by_option = json(&[&letters[..], &method[..]].concat());
    let typed = json(&[&["derive", "x'' + x + x^3/3 - x^5/7 = 0"][..], &method[..]].concat());
    assert!(by_option["verification"]["frequency"].is_number(), "{by_option}");
    assert_eq!(by_option["closed_form"], typed["closed_form"]);
    assert_eq!(by_option["verification"], typed["verification"]);
    let refused = run(&[&letters[..2], &method[..2]].concat());
    let message = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!(refused.status.code(), Some(1), "{message}");
    assert!(message.contains("several combinations") && message.contains("--at"), "{message}");
}

#[test]
fn the_frequency_is_the_same_with_and_without_the_motion() {
    for (equation, order) in [
        ("x'' + x + eps*x^3 = 0", "24"),
        ("x'' - mu*(1 - x^2)*x' + x = 0", "24"),
        ("x'' - mu*x'*(1 - x'^2/3) + x = 0", "14"),
        ("x'' + sin(x) = 0", "30"),
        ("x'' + a2*x^2 + a3*x^3 + x = 0", "6"),
    ] {
        let whole = law(&[equation, "--order", order]);
        assert_eq!(law(&[equation, "--order", order, "--omega-only"]), whole, "{equation}");
        let motion = json(&["derive", equation, "--order", order, "--omega-only"]);
        assert_eq!(motion["displacement"]["cosine"].as_array().map_or(0, Vec::len), 0, "{motion}");
    }
}

/// The output of a command whose time is up before its end: the warning says of how much it is a
/// part. A busy machine is given more time, until there is enough.
fn stopped_early(arguments: &[&str], of: &str, is_enough: fn(&Value) -> bool) -> Value {
    for doublings in 0..12 {
        let output = run(&[arguments, &["--timeout", &(1 << doublings).to_string()]].concat());
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        if output.status.code() == Some(1) && message.contains("without a result") {
            continue;
        }
        assert_eq!(output.status.code(), Some(4), "{message}");
        assert!(message.contains("stopped early") && message.contains(of), "{message}");
        let document = serde_json::from_slice(&output.stdout).expect("a document");
        if is_enough(&document) {
            return document;
        }
    }
    panic!("{arguments:?} has no part of its result")
}

/// What is there when the time is up is printed: an expansion to the order that its primes were
/// enough for.
#[test]
fn an_expansion_that_is_stopped_keeps_its_orders() {
    let long = ["derive", "van-der-pol", "--order", "600", "--omega-only", "--format", "json"];
    let document = stopped_early(&long, "of 600", |document| {
        document["order"].as_u64().is_some_and(|order| order >= 32)
    });
    let order = document["order"].as_u64().expect("an order");
    assert!(order < 600, "{order}");
    let text = document["validity"].to_string();
    assert!(text.contains("stopped before order 600"), "{text}");
    // They are the orders of a shorter expansion.
    let order = order.to_string();
    let shorter = json(&["derive", "van-der-pol", "--order", &order, "--omega-only"]);
    assert_eq!(shorter["frequency"], document["frequency"]);
}

/// A sweep of one's own equation ends at the time limit, and prints the motions that there are.
#[test]
fn a_sweep_that_is_stopped_keeps_its_motions() {
    let sweep = [
        "simulate",
        "x'' + 0.3*x' - x + x^3 = F*cos(1.2*t)",
        "--sweep",
        "F=0.2:0.4:20001",
        "--from",
        "x=1",
        "--until",
        "400",
        "--every",
        "2*pi/1.2",
        "--format",
        "json",
    ];
    let document = stopped_early(&sweep, "of 20001 motions", |document| {
        // The first one to the end.
        document["motions"][0]["final_state"]["t"] == 400.0
    });
    let motions = document["motions"].as_array().expect("motions");
    assert!(motions.len() < 20001, "{}", motions.len());
    // They are those that are followed alone.
    let force = motions[0]["values"]["F"].to_string();
    assert_eq!(force, "0.2");
    let alone = json(
        &[
            &sweep[..2],
            &["--at", "F=0.2", "--from", "x=1", "--until", "400", "--every", "2*pi/1.2"],
        ]
        .concat(),
    );
    // To rounding: alone the work of damping and drive is accounted for, by which steps are chosen too.
    for name in ["x", "x'"] {
        let state =
            |motion: &Value| motion["final_state"]["state"][name].as_f64().expect("a number");
        assert!((state(&motions[0]) - state(&alone)).abs() < 1e-11, "{name}: {alone}");
    }
}

/// Contact has its power series, too, but where a force presses it from rest exactly at its touch:
/// with both integrators that is said, and the motion is followed without.
#[test]
fn a_contact_has_two_integrators_but_pressed_from_rest_at_its_touch() {
    let forms = ["(x - 0.5)^(3/2)*H(x - 0.5)", "max(x - 0.5, 0)^(3/2)"];
    for (form, start) in
        [(forms[0], "x=-1"), (forms[1], "x=-1"), (forms[1], "x=0.5"), (forms[1], "x=0.4")]
    {
        let equation = format!("x'' + x + 1e4*{form} = 0");
        let both = json(&[
            "simulate",
            &equation,
            "--from",
            start,
            "--until",
            "20",
            "--integrator",
            "both",
        ]);
        assert!(both["difference"].as_f64().expect("a difference") < 1e-10, "{both}");
    }
    let pressed = ["simulate", "x'' + 1e4*max(x, 0)^(3/2) = 1", "--from", "x=0", "--until", "20"];
    let output = run(&[&pressed[..], &["--integrator", "both"]].concat());
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(output.stdout.is_empty());
    assert!(
        message.contains("no second integrator")
            && message.contains("help: leave out --integrator"),
        "{message}"
    );
    assert_eq!(json(&pressed)["complete"], true);
    // Both come to the pole of x'' = x^2 and stop there.
    let output =
        run(&["simulate", "x'' = x^2", "--from", "x=1", "--until", "20", "--integrator", "both"]);
    assert_eq!(output.status.code(), Some(4));
}

/// A motion that is said not to be trusted is incomplete: exit code 4, and so in JSON and as
/// comma-separated values.
#[test]
fn a_motion_that_is_not_to_be_trusted_is_incomplete() {
    let chaotic = [
        "simulate",
        "x'' + 0.25*x' - x + x^3 - 0.3*cos(t) = 0",
        "--from",
        "x=1",
        "--until",
        "300",
        "--integrator",
    ];
    let asked = |integrator: &str, format: &str| {
        run(&[&chaotic[..], &[integrator, "--format", format]].concat())
    };
    let output = asked("both", "json");
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(4), "{message}");
    assert!(message.contains("do not trust this motion"), "{message}");
    let document: Value = serde_json::from_slice(&output.stdout).expect("a document");
    assert_eq!(document["complete"], false);
    assert!(document["difference"].as_f64().expect("a difference") > 1e-6);
    let table = asked("both", "csv");
    assert_eq!(table.status.code(), Some(4));
    assert!(
        String::from_utf8_lossy(&table.stdout).contains("# incomplete: the two integrators differ")
    );
    // One integrator alone says how long its digits hold, and is complete.
    let alone = asked("taylor", "json");
    assert_eq!(alone.status.code(), Some(0));
    let document: Value = serde_json::from_slice(&alone.stdout).expect("a document");
    assert_eq!(document["complete"], true);
}

/// What grows beyond all numbers ends where it does, with numbers in every format; the schema has
/// no others.
#[test]
fn a_motion_that_leaves_the_range_of_numbers_ends_there() {
    let growing = ["simulate", "x'' - x = 0", "--until", "1000", "--from"];
    for integrator in [&[][..], &["--integrator", "runge-kutta"]] {
        let output = run(&[&growing[..], &["x=1", "--format", "json"], integrator].concat());
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(4), "{message}");
        assert!(message.contains("leaves the range of numbers"), "{message}");
        let document: Value = serde_json::from_slice(&output.stdout).expect("a document");
        let last = document["final_state"]["state"]["x"].as_f64().expect("a number");
        assert!((last / 1e300 - 1.0).abs() < 1e-6, "{last}");
        let samples = document["samples"].as_array().expect("samples");
        assert!(samples.iter().all(|sample| sample["state"]["x'"].is_f64()));
    }
    let output = run(&[&growing[..], &["x=1e308"]].concat());
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("`x` begins at 1e308"), "{message}");
}

/// The same where letters stay.
#[test]
fn an_expansion_with_letters_that_is_stopped_keeps_its_orders() {
    const LETTERS: &str = "x'' + x + eps*(a2*x^2 + a3*x^3 + a5*x^5) = 0";
    let long = ["derive", LETTERS, "--order", "70", "--omega-only", "--format", "json"];
    let document = stopped_early(&long, "of 70", |document| {
        document["order"].as_u64().is_some_and(|order| order >= 2)
    });
    let order = document["order"].as_u64().expect("an order");
    assert!(order < 70, "{order}");
    let shorter = json(&["derive", LETTERS, "--order", &order.to_string(), "--omega-only"]);
    assert_eq!(shorter["frequency"], document["frequency"]);
}

#[test]
fn the_threads_of_an_expansion_change_nothing() {
    for (problem, order) in [("van-der-pol", "80"), ("x'' + x + eps*(b*x^2 + c*x^3) = 0", "14")] {
        let on = |jobs: &str| {
            let output = run(&["derive", problem, "--order", order, "--jobs", jobs]);
            assert!(output.status.success());
            output.stdout
        };
        assert_eq!(on("1"), on("3"), "{problem}");
    }
}

#[test]
fn the_frequency_alone_has_a_higher_limit() {
    let refused = run(&["derive", "duffing", "--order", "401"]);
    let message = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(!refused.status.success() && message.contains("--omega-only"), "{message}");
    assert!(law(&["duffing", "--order", "401", "--omega-only"]).contains("eps^401*A^802"));
    let refused = run(&["derive", "duffing", "--order", "2001", "--omega-only"]);
    let message = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(!refused.status.success() && message.contains("2000"), "{message}");
}
