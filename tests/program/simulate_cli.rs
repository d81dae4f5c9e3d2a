//! `lindstedt simulate` as a user meets it: one file in `examples/simulate/`, one snapshot in text
//! and one in JSON; one file in `tests/errors/simulate/`, one message.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::{Value, json};

const EXAMPLES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/simulate");

fn run(arguments: &[&str]) -> Output {
    run_for("3600", arguments)
}

/// With this time limit, in seconds.
fn run_for(seconds: &str, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .arg("simulate")
        .args(arguments)
        .args(["--timeout", seconds])
        .output()
        .expect("the program starts")
}

fn output(arguments: &[&str]) -> String {
    let output = run(arguments);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success() && message.is_empty(), "{arguments:?}: {message}");
    String::from_utf8(output.stdout).expect("the output is text")
}

fn json(arguments: &[&str]) -> Value {
    serde_json::from_str(&output(&[arguments, &["--format", "json"]].concat()))
        .expect("the output is JSON")
}

/// The lines of a table of comma-separated values that are no comments.
fn rows(table: &str) -> Vec<&str> {
    table.lines().filter(|line| !line.starts_with('#')).collect()
}

fn example(name: &str) -> String {
    format!("{EXAMPLES}/{name}.toml")
}

fn settings() -> insta::Settings {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(concat!(env!("CARGO_MANIFEST_DIR"), "/snapshots"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.add_filter(concat!(env!("CARGO_MANIFEST_DIR"), "/"), "");
    // Rounding noise by nature.
    settings.add_filter(r"residual +(< )?\S+", "residual noise");
    settings.add_filter(r"in \d+ steps", "in some steps");
    settings.add_filter(r#""steps": \d+"#, r#""steps": "some""#);
    settings
}

/// Numbers to seven digits: the last ones depend on the machine's sine.
fn rounded(value: &mut Value) {
    match value {
        Value::Number(number) if number.is_f64() => {
            let number = number.as_f64().unwrap_or_default();
            *value = match number {
                _ if number.abs() < 1e-9 => "noise".into(),
                _ => format!("{number:.6e}").parse::<f64>().map_or(Value::Null, Value::from),
            };
        }
        Value::Array(list) => list.iter_mut().for_each(rounded),
        Value::Object(map) => map.values_mut().for_each(rounded),
        _ => {}
    }
}

#[test]
fn every_example_prints_what_it_printed() {
    settings().bind(|| {
        insta::glob!(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/simulate"), "*.toml", |file| {
            let path = file.to_str().expect("a path in text");
            insta::assert_snapshot!(
                "simulate-text",
                output(&[path, "--sample", "12.5", "--sample", "40"])
            );
            let mut document = json(&[path, "--sample", "12.5"]);
            rounded(&mut document);
            insta::assert_json_snapshot!("simulate-json", document);
        });
    });
}

/// The chain of closed forms in every format, and what it says of itself: within a percent, or exit
/// code 3.
#[test]
fn a_chain_prints_what_it_printed_and_is_judged() {
    let file = format!("{EXAMPLES}/damper.toml");
    settings().bind(|| {
        insta::assert_snapshot!("simulate-chain-text@damper.toml", output(&[&file, "--chain"]));
        insta::assert_snapshot!(
            "simulate-chain-latex@damper.toml",
            output(&[&file, "--chain", "--format", "latex"])
        );
        let mut document = json(&[&file, "--chain"]);
        rounded(&mut document);
        insta::assert_json_snapshot!("simulate-chain-json@damper.toml", document);
    });
    let strict = run(&[&file, "--chain", "--tolerance", "1e-9"]);
    assert_eq!(strict.status.code(), Some(3));
    let document = json(&[&file, "--chain"]);
    assert_eq!(document["route"], "chain");
    // The formulas are where they say: the state asked for is that of the phase it falls in.
    let sampled = json(&[&file, "--chain", "--sample", "3.25"]);
    let phases = sampled["phases"].as_array().expect("phases");
    let phase = phases
        .iter()
        .find(|phase| phase["end"].as_f64() > Some(3.25))
        .expect("a phase at that time");
    let number = |key: &str| phase["swing"][key].as_f64().expect("a number");
    let t = 3.25 - phase["start"].as_f64().expect("a beginning");
    let (sn, ..) =
        spec_math::cephes64::ellpj(number("speed") * t + number("phase"), number("parameter"));
    let x = 2.0 * number("sign") * (number("modulus") * (-number("rate") * t).exp() * sn).asin();
    assert!((sampled["samples"][0]["x"].as_f64().expect("x") - x).abs() < 1e-12);
}

/// The three rest times of a row of a sweep are those of single runs.
#[test]
fn a_sweep_has_the_baseline_of_every_row() {
    let file = format!("{EXAMPLES}/damper.toml");
    for route in [vec![], vec!["--chain"]] {
        let swept = [vec![file.as_str(), "--sweep", "zeta=0.01,0.03", "--baseline"], route.clone()]
            .concat();
        let document = json(&swept);
        let row = &document["rows"][0];
        let single = json(&[vec![file.as_str()], route].concat());
        for (of_row, of_run) in [
            ("rest_time", "this_barrier"),
            ("rest_no_barrier", "no_barrier"),
            ("rest_lossless", "lossless_barrier"),
        ] {
            let (found, wanted) = (row[of_row].as_f64(), single["baseline"][of_run].as_f64());
            assert!(found.is_some() && found == wanted, "{of_row}: {found:?} {wanted:?}");
        }
        let table = output(&[swept.as_slice(), &["--format", "csv"]].concat());
        assert!(
            table.contains("\nzeta,impacts,rest_time,rest_no_barrier,rest_lossless,penetration,"),
            "{table}"
        );
    }
}

#[test]
fn every_example_agrees_with_the_judge() {
    for file in std::fs::read_dir(EXAMPLES).expect("examples/simulate").filter_map(Result::ok) {
        let path = file.path();
        let document = json(&[path.to_str().expect("a path in text"), "--integrator", "both"]);
        let judge = &document["judge"];
        let difference = judge["max_difference"]["x"].as_f64().expect("a number");
        assert!(difference < 1e-6, "{}: {difference}", path.display());
        assert_eq!(
            judge["impacts"].as_u64(),
            document["impacts"].as_array().map(|list| list.len() as u64)
        );
        assert!(document["energy_residual"].as_f64().is_some_and(|residual| residual < 1e-9));
    }
}

#[test]
fn every_wrong_input_gets_its_message() {
    settings().bind(|| {
        insta::glob!(
            concat!(env!("CARGO_MANIFEST_DIR"), "/tests/errors/simulate"),
            "*.toml",
            |file| {
                let path = file.to_str().expect("a path in text");
                insta::assert_snapshot!("simulate-error", refusal(&[path]));
            }
        );
    });
}

/// Message and exit code of a run that must be refused.
fn refusal(arguments: &[&str]) -> String {
    let output = run(arguments);
    let text = String::from_utf8(output.stderr).expect("messages are text");
    assert!(matches!(output.status.code(), Some(1 | 2)), "{arguments:?}: {text}");
    assert!(output.stdout.is_empty() && text.starts_with("error: "), "{text}");
    for word in ["panicked", "internal error", "stopped after"] {
        assert!(!text.contains(word), "{text}");
    }
    format!("{text}exit code {}\n", output.status.code().unwrap_or_default())
}

#[test]
fn wrong_arguments_get_theirs() {
    let file = example("damper");
    for (arguments, words) in [
        (vec!["--sweep", "zetta=0:1:3"], "did you mean `zeta`?"),
        (vec!["--sweep", "zeta=0:1"], "NAME=from:to:count"),
        (vec!["--sweep", "zeta=0:1:1"], "whole number from 2"),
        (vec!["--sweep", "zeta=nan:1:3"], "no finite number"),
        (vec!["--sweep", "zeta=-1:1:3"], "zeta must not be negative"),
        (vec!["--sweep", "barrier=-2:0.3:3"], "inside the right barrier"),
        (vec!["--sweep", "duration=1:2:3"], "the same for all motions"),
        (vec!["--sweep", "zeta=0:1:3", "--sweep", "zeta=0:1:3"], "swept twice"),
        (
            vec!["--sweep", "zeta=0:1:2000", "--sweep", "mu=0:1:2000"],
            "2000 * 2000 = 4000000 motions, more than 1000000 motions",
        ),
        (
            vec!["--sweep", "zeta=0:1:3", "--sweep", "mu=0:1:3", "--sweep", "zeta=5:6:3"],
            "`zeta` is swept twice",
        ),
        (
            vec![
                "--sweep",
                "zeta=0:1:3",
                "--sweep",
                "mu=0:1:3",
                "--sweep",
                "alpha=0:1:3",
                "--plot",
                "map.svg",
            ],
            "--plot draws curves over one parameter or a map over two",
        ),
        (vec!["--sweep", "mu=0:1e5:3:log"], "two ends of one sign, neither of them zero"),
        (vec!["--sweep", "speed=-1:1:3:log"], "two ends of one sign, neither of them zero"),
        (vec!["--sweep", "zeta=0.01:0.1:3:logg"], "did you mean `log`?"),
        (vec!["--sweep", "zeta=0.01,x"], "`x` is no finite number"),
        (vec!["--sweep", "zeta=0.01"], "NAME=a,b,c"),
        (vec!["--sweep", "zeta=0.1,0.2,0.1"], "`zeta` takes the value 0.1 twice"),
        (vec!["--sweep", "zeta=0.1:0.1:3"], "`zeta` takes the value 0.1 twice"),
        (vec!["--sweep", "zeta=0:1:3", "--sample", "1"], "leave out"),
        (vec!["--sample", "1e9"], "lies beyond the duration"),
        (vec!["--sample", "-1"], "sample"),
        (vec!["--format", "latex"], "no LaTeX form"),
        (
            vec!["--chain", "--sweep", "zeta=0.01,0.02", "--format", "latex"],
            "a sweep has no LaTeX form",
        ),
        (vec!["--integrator", "euler"], "taylor"),
    ] {
        let text = refusal(&[&[file.as_str()], arguments.as_slice()].concat());
        assert!(text.contains(words), "{arguments:?}: {text}");
    }
}

#[test]
fn a_barrier_out_of_reach_leaves_the_plain_pendulum_and_says_so() {
    let path =
        std::env::temp_dir().join(format!("lindstedt-out-of-reach-{}.toml", std::process::id()));
    std::fs::write(&path, "[pendulum]\nbarrier = 2.0\n").expect("a file");
    let file = path.to_str().expect("a path in text");
    assert!(output(&[file]).contains("no contact: the motion never reaches the barrier at 2"));
    let document = json(&[file]);
    assert_eq!(document["impacts"].as_array().map(Vec::len), Some(0));
    assert!(document["notes"][0].as_str().is_some_and(|note| note.contains("plain pendulum")));
    // A quarter of the period after half a period: cn(K) = 0.
    let quarter = ellip::ellipk(0.75_f64.sin().powi(2)).expect("m < 1");
    let sample = format!("{}", 3.0 * quarter);
    let document = json(&[file, "--sample", &sample]);
    assert!(document["samples"][0]["x"].as_f64().is_some_and(|x| x.abs() < 1e-9));
    std::fs::remove_file(path).expect("the file goes");
}

#[test]
fn a_run_that_cannot_go_on_says_where_and_keeps_what_it_has() {
    let path = std::env::temp_dir().join(format!("lindstedt-too-fast-{}.toml", std::process::id()));
    std::fs::write(&path, "[pendulum]\nstart = 0\nspeed = 1e300\n").expect("a file");
    let file = path.to_str().expect("a path in text");
    let output = run(&[file, "--format", "json"]);
    assert_eq!(output.status.code(), Some(4));
    assert!(String::from_utf8_lossy(&output.stderr).contains("stopped early"));
    let document: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(document["complete"], false);
    assert!(
        document["stopped"]
            .as_str()
            .is_some_and(|text| text.contains("no finite value after t = "))
    );
    assert_eq!(run(&[file, "--tolerance", "0.1"]).status.code(), Some(4));
    let table = run(&[file, "--format", "csv"]);
    assert!(
        String::from_utf8_lossy(&table.stdout).contains("# incomplete: no finite value after t = ")
    );
    std::fs::remove_file(path).expect("the file goes");
}

#[test]
fn steps_and_seconds_are_limits_that_are_said() {
    let path = std::env::temp_dir().join(format!("lindstedt-limits-{}.toml", std::process::id()));
    let file = path.to_str().expect("a path in text");
    std::fs::write(&path, "[run]\nduration = 1e4\nstep_limit = 500\n").expect("a file");
    let output = run(&[file, "--format", "json"]);
    assert_eq!(output.status.code(), Some(4));
    let document: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!((&document["complete"], &document["steps"]), (&json!(false), &json!(500)));
    let stopped = document["stopped"].as_str().expect("a reason");
    assert!(stopped.contains("step_limit"), "{stopped}");
    let swept = run(&[file, "--sweep", "zeta=0:0.1:3", "--format", "csv"]);
    assert_eq!(swept.status.code(), Some(4));
    assert!(
        rows(&String::from_utf8_lossy(&swept.stdout))[1..]
            .iter()
            .all(|row| row.ends_with(",false,step limit"))
    );
    let note = String::from_utf8_lossy(&swept.stderr);
    assert!(note.contains("warning: 3 of 3 motions stopped early"), "{note}");

    std::fs::write(&path, "[run]\nduration = 1e9\nstep_limit = 10000000\n").expect("a file");
    // A busy machine is given more time, until the barrier has been touched.
    let touched = ["0.2", "2", "20", "200", "2000"].into_iter().find_map(|seconds| {
        let output = run_for(seconds, &[file, "--format", "json"]);
        assert_eq!(output.status.code(), Some(4));
        let document: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        let impacts = document["impacts"].as_array().map_or(0, Vec::len);
        (impacts > 0).then_some(document)
    });
    let document = touched.expect("an impact");
    assert_eq!(document["complete"], false);
    let stopped = document["stopped"].as_str().expect("a reason");
    assert!(stopped.contains("stopped from outside"), "{stopped}");
    std::fs::remove_file(path).expect("the file goes");
}

#[test]
fn results_go_to_whole_files_or_nowhere() {
    let folder = std::env::temp_dir().join(format!("lindstedt-files-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let place = |name: &str| folder.join(name).to_str().expect("a path in text").to_owned();
    let code = |arguments: &[&str]| run(arguments).status.code();
    let (result, picture) = (place("result.txt"), place("picture.svg"));
    assert_eq!(code(&["--output", &result, "--plot", &picture]), Some(0));
    let printed = run(&[]).stdout;
    assert_eq!(std::fs::read(&result).expect("a result"), printed);
    assert!(std::fs::read_to_string(&picture).expect("a picture").starts_with("<svg"));
    // Nothing else is left beside them.
    assert_eq!(std::fs::read_dir(&folder).expect("a folder").count(), 2);

    let problem = place("problem.toml");
    std::fs::write(&problem, "[run]\nduration = 5.0\n").expect("a file");
    assert_eq!(code(&[&problem, "--output", &problem]), Some(2));
    assert_eq!(std::fs::read_to_string(&problem).expect("as it was"), "[run]\nduration = 5.0\n");
    assert_eq!(code(&["--output", &picture, "--plot", &picture]), Some(2));
    assert_eq!(code(&["--plot", &place("picture.png")]), Some(2));
    assert_eq!(code(&["--plot", "-"]), Some(2));
    assert_eq!(code(&["--output", &place("nowhere/result.txt")]), Some(1));
    assert_eq!(code(&["--output", folder.to_str().expect("a path in text")]), Some(1));
    let drawn = run(&["--plot", "-", "--output", &result]);
    assert!(drawn.stdout.starts_with(b"<svg"));
    std::fs::remove_dir_all(folder).expect("the folder goes");
}

#[test]
fn extreme_numbers_end_in_time() {
    // Excitation beyond all scales, a creeping motion that underflows, friction and damping without
    // measure.
    for (number, (text, code, words)) in [
        (
            "[excitation]\nbeta = -0.2\nfrequency_ratio = 1.7e308",
            4,
            "allowed number of steps was used up",
        ),
        (
            "[damping]\nalpha = 0.2\nfriction = \"arctangent\"\n[run]\nduration = 1e5",
            0,
            "At t = 100000:",
        ),
        (
            // The sine of such an angle has no digits: refused, with nothing on standard output.
            "[pendulum]\nstart = -1e300\n[damping]\nalpha = 1.1\nfriction = \"arctangent\"",
            1,
            "",
        ),
        ("[damping]\nzeta = 1e30\nalpha = 1e8", 0, "At t = 50: x = -1.5, x' = 0\n"),
        ("[contact]\ngamma = 1e300\nmu = 1e300", 0, "Impacts: 10\n"),
        ("[pendulum]\nspeed = 1e300", 4, "no finite value"),
        ("[excitation]\nbeta = 1e300\nfrequency_ratio = 1.0", 4, "no finite value"),
    ]
    .into_iter()
    .enumerate()
    {
        let path = std::env::temp_dir()
            .join(format!("lindstedt-extreme-{}-{number}.toml", std::process::id()));
        std::fs::write(&path, text).expect("a file");
        let output = run(&[path.to_str().expect("a path in text"), "--quiet"]);
        let printed = String::from_utf8_lossy(&output.stdout).into_owned();
        assert_eq!(output.status.code(), Some(code), "{text}: {printed}");
        assert!(printed.contains(words), "{text}: {printed}");
        std::fs::remove_file(path).expect("the file goes");
    }
}

#[test]
fn the_table_of_the_trajectory() {
    let file = example("damper");
    let table = output(&[&file, "--format", "csv"]);
    let mut lines = table.lines();
    assert!(lines.next().is_some_and(|line| line.starts_with("# units: t 1/omega, x rad, ")));
    assert_eq!(lines.next(), Some("t,x,velocity,state,energy"));
    let mut last = -1.0;
    let mut contacts = 0;
    for line in lines {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |index: usize| fields[index].parse::<f64>().expect("a number");
        assert!(fields.len() == 5 && number(0) > last, "{line}");
        last = number(0);
        contacts += usize::from(fields[3] == "contact");
        assert!(number(1) > 0.323 - 1e-12 || fields[3] == "free", "{line}");
    }
    assert!(last == 200.0 && contacts > 100);
    assert_eq!(output(&[&file, "--format", "csv", "--sample", "3"]).lines().count(), 3);
}

#[test]
fn a_row_of_the_trajectory_is_a_state_and_its_energy() {
    for name in ["damper", "everything"] {
        let file = example(name);
        let barriers = json(&[&file, "--sample", "0"])["parameters"].clone();
        let side = |key: &str| barriers["barrier"][key].as_f64();
        let gamma = barriers["gamma"].as_f64().expect("a number");
        let table = output(&[&file, "--format", "csv"]);
        let rows: Vec<Vec<f64>> = table
            .lines()
            .skip(2)
            .map(|line| {
                let fields = line.split(',').enumerate().filter(|(column, _)| *column != 3);
                fields.map(|(_, field)| field.parse().expect("a number")).collect()
            })
            .collect();
        for pair in rows.windows(2) {
            let ([t, x, v, _], [next_t, next_x, next_v, _]) = (&pair[0][..], &pair[1][..]) else {
                panic!("{pair:?}");
            };
            // The velocity is the slope of the displacement, to the third power of the step and the
            // last digit of both.
            let step = next_t - t;
            let missed = next_x - x - 0.5 * step * (v + next_v);
            assert!(
                missed.abs()
                    < step * (0.5 * (next_v - v).abs() + 0.3 * step * step)
                        + 2.0 * f64::EPSILON * x.abs(),
                "{pair:?}"
            );
        }
        for row in &rows {
            let [_, x, v, energy] = row[..] else {
                panic!("{row:?}");
            };
            let right = side("right").map_or(0.0, |barrier| (x - barrier).max(0.0));
            let left = side("left").map_or(0.0, |barrier| (barrier - x).max(0.0));
            let elastic = 0.4 * gamma * (right.powf(2.5) + left.powf(2.5));
            let expected = 0.5 * v * v + 1.0 - x.cos() + elastic;
            assert!((energy - expected).abs() < 1e-9 * (1.0 + expected), "{row:?}: {expected}");
        }
    }
}

/// What a sweep says of a motion is what its own document says, in every format.
#[test]
fn a_row_of_a_sweep_sums_up_its_motion() {
    let path =
        std::env::temp_dir().join(format!("lindstedt-sweep-row-{}.toml", std::process::id()));
    let file = path.to_str().expect("a path in text");
    let with = |barrier: f64| {
        format!(
            "[pendulum]\nbarrier = {barrier}\n[contact]\ngamma = 1e5\nmu = 1e4\n[damping]\nzeta = 0.02\n\
             [run]\nduration = 150.0\n"
        )
    };
    std::fs::write(&path, with(0.3)).expect("a file");
    let sweep = ["--sweep", "barrier=0.3:0.5:2"];
    let document = json(&[&[file], &sweep[..]].concat());
    let table = output(&[&[file, "--format", "csv"], &sweep[..]].concat());
    let text = output(&[&[file], &sweep[..]].concat());
    let header: Vec<&str> = rows(&table)[0].split(',').collect();
    for (row, barrier) in [0.3, 0.5].into_iter().enumerate() {
        std::fs::write(&path, with(barrier)).expect("a file");
        let single = json(&[file]);
        let impacts = single["impacts"].as_array().expect("a list");
        let float = |value: &Value| value.as_f64().expect("a number");
        let largest =
            |key: &str| impacts.iter().map(|impact| float(&impact[key])).fold(0.0, f64::max);
        let lost: f64 = impacts.iter().map(|impact| float(&impact["energy_lost"])).sum();
        assert!(impacts.len() > 3 && lost > 0.1, "{} {lost}", impacts.len());
        let expected = [
            ("barrier", barrier),
            ("impacts", impacts.len() as f64),
            ("rest_time", float(&single["rest_time"])),
            ("penetration", largest("penetration")),
            ("speed_in", largest("speed_in")),
            ("energy_lost", lost),
            ("t", float(&single["final_state"]["t"])),
            ("x", float(&single["final_state"]["x"])),
            ("velocity", float(&single["final_state"]["velocity"])),
        ];
        let entry = &document["rows"][row];
        let fields: Vec<&str> = rows(&table)[row + 1].split(',').collect();
        let words: Vec<&str> =
            text.lines().nth(row + 1).expect("a line").split_whitespace().collect();
        for (column, (key, value)) in expected.into_iter().enumerate() {
            let found = match key {
                "barrier" => &entry["values"][0],
                "t" | "x" | "velocity" => &entry["final_state"][key],
                _ => &entry[key],
            };
            // The books are kept without the path in a sweep, in another order of summation.
            let same =
                |found: f64, digits: f64| (found - value).abs() <= digits * value.abs().max(1e-3);
            assert!(same(float(found), 1e-9), "{key}: {found} {value}");
            let place = header.iter().position(|name| *name == key).expect(key);
            assert!(
                same(fields[place].parse().expect("a number"), 1e-9),
                "{key}: {}",
                fields[place]
            );
            if let Some(word) = words.get(column).filter(|_| column < 6) {
                assert!(same(word.parse().expect("a number"), 1e-5), "{key}: {word} {value}");
            }
        }
    }
    std::fs::remove_file(path).expect("the file goes");
}

#[test]
fn long_lists_are_cut_and_a_last_impact_may_be_open() {
    let path = std::env::temp_dir().join(format!("lindstedt-lists-{}.toml", std::process::id()));
    let file = path.to_str().expect("a path in text");
    let lasting = |duration: f64| format!("[contact]\ngamma = 1e5\n[run]\nduration = {duration}\n");
    std::fs::write(&path, lasting(150.0)).expect("a file");
    let document = json(&[file]);
    let impacts = document["impacts"].as_array().expect("a list");
    let text = output(&[file]);
    let sides = text.lines().filter(|line| line.contains(" right "));
    let numbers: Vec<usize> = sides
        .map(|line| {
            line.split_whitespace().next().and_then(|word| word.parse().ok()).expect("a number")
        })
        .collect();
    // The first of them, and the last.
    let last = numbers.len() - 1;
    assert!(impacts.len() > numbers.len() && numbers[..last].iter().copied().eq(1..=last));
    assert_eq!(numbers[last], impacts.len());
    assert!(text.contains(&format!("... {} more", impacts.len() - numbers.len())), "{text}");
    assert_eq!(document["notes"].as_array().map(Vec::len), Some(0));

    let float = |value: &Value| value.as_f64().expect("a number");
    let middle = 0.5 * (float(&impacts[2]["entry_time"]) + float(&impacts[2]["exit_time"]));
    std::fs::write(&path, lasting(middle)).expect("a file");
    let document = json(&[file]);
    assert_eq!(document["impacts"].as_array().map(Vec::len), Some(3));
    assert_eq!(document["impacts"][2]["exit_time"], Value::Null);
    let note = document["notes"][0].as_str().expect("a note");
    assert!(note.contains("the run ends in contact") && output(&[file]).contains(note), "{note}");

    // A state beyond an early end is not known.
    std::fs::write(&path, "[run]\nduration = 1e4\nstep_limit = 500\n").expect("a file");
    let output = run(&[file, "--sample", "9000", "--sample", "1", "--format", "json"]);
    let document: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(document["samples"][0]["x"], Value::Null);
    assert!(document["samples"][1]["x"].is_f64());
    let table = run(&[file, "--sample", "9000", "--sample", "1", "--format", "csv"]);
    assert_eq!(
        String::from_utf8_lossy(&table.stdout)
            .lines()
            .filter(|line| !line.starts_with('#'))
            .count(),
        2
    );
    std::fs::remove_file(path).expect("the file goes");
}

#[test]
fn samples_and_final_state_agree_whatever_the_format() {
    let file = example("everything");
    let document = json(&[&file, "--sample", "40", "--sample", "0"]);
    assert_eq!(document["samples"][0]["x"], document["final_state"]["x"]);
    assert_eq!(document["samples"][1]["x"], 0.1);
    assert_eq!(document["samples"][1]["velocity"], 1.2);
}

#[test]
fn a_sweep_prints_the_same_on_any_number_of_threads() {
    let file = example("damper");
    let axes = ["--sweep", "zeta=0.01:0.05:9", "--sweep", "barrier=0.1:0.6:31"];
    for format in ["text", "csv", "json"] {
        let on = |jobs: &str| {
            let arguments =
                [&[file.as_str(), "--format", format, "--jobs", jobs], &axes[..]].concat();
            output(&arguments)
        };
        let one = on("1");
        assert_eq!(one, on("2"));
        assert_eq!(one, on("7"));
    }
    let table = output(&[&[file.as_str(), "--format", "csv"], &axes[..]].concat());
    let table = rows(&table);
    assert_eq!(table.len(), 1 + 9 * 31);
    // A row is the motion that its parameters give.
    let single = output(&[&file, "--format", "csv", "--sweep", "barrier=0.1:0.6:31"]);
    assert_eq!(table[1].split_once(',').map(|fields| fields.1), Some(rows(&single)[1]));
}

/// Three parameters, each with its own spacing: every combination, the last fastest, in all
/// formats.
#[test]
fn a_sweep_of_many_parameters_names_every_column_and_its_unit() {
    let file = example("damper");
    let axes = [
        &file,
        "--sweep",
        "gamma=1e4:1e8:3:log",
        "--sweep",
        "frequency_ratio=0.5:1.5:2:lin",
        "--sweep",
        "beta=0.01,0.05",
    ];
    let table = output(&[&axes[..], &["--format", "csv"]].concat());
    let units = table.lines().next().expect("a line of units");
    assert_eq!(
        units,
        "# units: gamma 1, frequency_ratio 1, beta 1, impacts 1, rest_time 1/omega, penetration rad, speed_in rad*omega, \
         energy_lost m*g*L, t 1/omega, x rad, velocity rad*omega, complete -, stopped -"
    );
    let rows = rows(&table);
    assert_eq!(
        rows[0],
        "gamma,frequency_ratio,beta,impacts,rest_time,penetration,speed_in,energy_lost,t,x,velocity,complete,stopped"
    );
    let starts: Vec<String> = rows[1..]
        .iter()
        .map(|row| row.splitn(4, ',').take(3).collect::<Vec<_>>().join(" "))
        .collect();
    let expected = ["10000", "1000000", "100000000"].map(|gamma| {
        ["0.5 0.01", "0.5 0.05", "1.5 0.01", "1.5 0.05"].map(|rest| format!("{gamma} {rest}"))
    });
    assert_eq!(starts, expected.concat());
    let document = json(&axes);
    let spacings: Vec<&Value> =
        document["axes"].as_array().expect("axes").iter().map(|axis| &axis["spacing"]).collect();
    assert_eq!(spacings, ["logarithmic", "linear", "list"]);
    assert_eq!(document["axes"][0]["values"], json!([1e4, 1e6, 1e8]));
    let columns = document["columns"].as_array().expect("columns");
    let names: Vec<&str> = columns.iter().filter_map(|column| column["name"].as_str()).collect();
    assert_eq!(names.join(","), rows[0]);
    // Every column is a value or a key of a row.
    for column in &columns[3..] {
        let row = &document["rows"][0];
        let name = column["name"].as_str().expect("a name");
        assert!(
            !row[name].is_null() || !row["final_state"][name].is_null() || name == "rest_time",
            "{name}"
        );
        assert!(column["meaning"].as_str().is_some_and(|words| words.len() > 10));
    }
    // In text, a block for each gamma, and columns that do not run together.
    let text = output(&axes);
    let blocks: Vec<&str> = text.split("\n\n").collect();
    assert_eq!(blocks.len(), 3, "{text}");
    let words: Vec<&str> = text.lines().next().expect("a header").split_whitespace().collect();
    assert_eq!(words[..4], ["gamma", "frequency_ratio", "beta", "impacts"]);
}

/// A main mass is swept over its own numbers and those of the pendulum, one or several at a time;
/// what there is to vary is listed.
#[test]
fn a_main_mass_is_swept_over_any_of_its_numbers() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/primary/stick-slip.toml");
    let axes = [file, "--sweep", "barrier=0.1:0.2:2", "--sweep", "displacement=0.01,0.02"];
    let document = json(&axes);
    let swept = document["rows"].as_array().expect("rows");
    let values: Vec<&Value> = swept.iter().map(|row| &row["values"]).collect();
    assert_eq!(json!(values), json!([[0.1, 0.01], [0.1, 0.02], [0.2, 0.01], [0.2, 0.02]]));
    // The last of them is the file itself.
    let alone = json(&[file]);
    assert_eq!(swept[3]["rest_time"], alone["rest_time"]);
    assert_eq!(swept[3]["rest_locked"], alone["locked"]["rest_time"]);
    assert_eq!(swept[3]["all_impacts"], json!(alone["impacts"].as_array().expect("impacts").len()));
    let table = output(&[&axes[..], &["--format", "csv"]].concat());
    assert!(table.starts_with("# units: barrier rad, displacement m, "), "{table}");
    assert_eq!(table.lines().count(), 6);
    let text = output(&axes);
    assert!(text.contains("come to rest") && text.contains("barrier: the place"), "{text}");
    for (sweep, said) in [
        ("gap=1:2:2", "choose one of primary.mass, mass_ratio, stiffness, "),
        ("damping=1:2:2", "write primary.damping or contact.damping"),
        ("frequncy=1:2:2", "did you mean `frequency`?"),
        ("duration=1:2:2", "give it in [run]"),
        ("frequency=1:2:2", "[primary] force"),
        ("stiffness=-1:2:2", "[primary] stiffness must be a positive number"),
    ] {
        let output = run(&[file, "--sweep", sweep]);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.stdout.is_empty() && message.contains(said), "{sweep}: {message}");
    }
    let output = run(&["x'' + k*x = 0", "--from", "x=1", "--sweep", "j=1:2:2"]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(message.contains("choose one of k, x, x'"), "{message}");
}

/// The chain of a main mass beside its integration: in every format, judged, and swept.
#[test]
fn a_main_mass_by_its_chain_is_judged() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/primary/chain.toml");
    let [chain, truth] = [json(&[file, "--chain"]), json(&[file])];
    assert_eq!([&chain["route"], &truth["route"]], [&json!("chain"), &json!("integration")]);
    assert_eq!(chain["judge"]["rest_time"], truth["rest_time"]);
    assert_eq!(truth["judge"], Value::Null);
    let rest = |document: &Value| document["rest_time"].as_f64().expect("a rest time");
    assert!((rest(&chain) / rest(&truth) - 1.0).abs() < 0.01);
    let text = output(&[file, "--chain"]);
    assert!(text.contains("closed forms") && text.contains("integrated for want"), "{text}");
    assert_eq!(run(&[file, "--chain"]).status.code(), Some(0));
    assert_eq!(run(&[file, "--chain", "--tolerance", "1e-12"]).status.code(), Some(3));
    let swept = json(&[file, "--chain", "--sweep", "displacement=0.005,0.01"]);
    assert_eq!(swept["rows"][1]["rest_time"], chain["rest_time"]);
    let refused = run(&[file, "--chain", "--sweep", "primary.damping=1,90"]);
    let message = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(message.contains("motion 2") && message.contains("leave out --chain"), "{message}");
}

#[test]
fn exit_codes_follow_the_verdict() {
    let file = example("paper");
    for (arguments, code) in [(vec!["--tolerance", "1e-8"], 0), (vec!["--tolerance", "1e-14"], 3)] {
        let output = run(&[&[file.as_str()], arguments.as_slice()].concat());
        assert_eq!(output.status.code(), Some(code), "{arguments:?}");
        assert!(!output.stdout.is_empty());
    }
}

#[cfg(feature = "plot")]
#[test]
fn pictures_are_drawn_and_the_same_on_every_run() {
    let folder = std::env::temp_dir().join(format!("lindstedt-simulations-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder for pictures");
    let file = example("everything");
    for (arguments, words) in [
        (vec![], "Phase plane"),
        (vec!["--integrator", "both"], "Runge-Kutta"),
        (vec!["--sweep", "zeta=0:0.1:8"], "Impacts"),
        (vec!["--sweep", "zeta=0:0.1:5", "--sweep", "alpha=0:0.1:6"], "Impacts"),
    ] {
        let draw = |name: &str| {
            let path = folder.join(name);
            let plot = ["--plot", path.to_str().expect("a path in text")];
            output(&[&[file.as_str()], arguments.as_slice(), &plot].concat());
            std::fs::read_to_string(path).expect("the picture was written")
        };
        let picture = draw("first.svg");
        assert!(picture.contains("<svg") && picture.contains(words), "{arguments:?}");
        assert_eq!(picture, draw("second.svg"));
    }
    std::fs::remove_dir_all(folder).expect("the folder goes");
}

#[test]
fn help_says_what_there_is() {
    settings().bind(|| insta::assert_snapshot!("help-simulate", output_of_help()));
}

fn output_of_help() -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .args(["simulate", "--help"])
        .output()
        .expect("the program starts");
    String::from_utf8(output.stdout).expect("text")
}

#[test]
fn the_examples_are_the_ones_the_pages_name() {
    let page = include_str!("../../docs/damper.md");
    let named: Vec<&str> =
        page.split_whitespace().filter(|word| word.starts_with("examples/simulate/")).collect();
    assert!(!named.is_empty());
    for name in named {
        assert!(Path::new(env!("CARGO_MANIFEST_DIR")).join(name).exists(), "{name}");
    }
}

/// An amplitude or a position at which a sine has no digits left is refused by every command that
/// reads one, and one at which the force has them is not.
#[test]
fn a_place_without_digits_is_refused() {
    let of_file = |text: &str| {
        let mut file = tempfile::NamedTempFile::with_suffix(".toml").expect("a file");
        std::io::Write::write_all(&mut file, text.as_bytes()).expect("a file");
        file
    };
    let [amplitude, barrier, start] = [
        "[pendulum]\namplitude = 1e17",
        "[pendulum]\namplitude = 1.5\nbarrier = 1e17\nspeed = 3.0",
        "[pendulum]\nstart = -1e12",
    ]
    .map(of_file);
    let path = |file: &tempfile::NamedTempFile| file.path().to_str().expect("a path").to_owned();
    let [amplitude, barrier, start] = [&amplitude, &barrier, &start].map(path);
    let refused: [&[&str]; 9] = [
        &["simulate", &amplitude],
        &["simulate", &barrier],
        &["simulate", &start],
        &["impact", &amplitude],
        &["materials", &amplitude],
        &["simulate", "x'' + sin(x) = 0", "--from", "x=1e17", "--until", "1"],
        &["derive", "x'' + x*(2 + sin(x)) = 0", "--at", "A=1e17"],
        &["compare", "x'' + x*(2 + cos(x)) = 0", "--at", "A=1e17"],
        &["derive", "x'' + x*(2 + cos(1e17*x)) = 0", "--method", "exact", "--at", "A=1"],
    ];
    for arguments in refused {
        let output = Command::new(env!("CARGO_BIN_EXE_lindstedt"))
            .args(arguments)
            .output()
            .expect("the program starts");
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(
            (output.status.code(), output.stdout.len()),
            (Some(1), 0),
            "{arguments:?}: {message}"
        );
        assert!(message.contains("no digits left"), "{arguments:?}: {message}");
    }
    let answered: [&[&str]; 3] = [
        &["derive", "x'' + x + sin(x) = 0", "--method", "exact", "--at", "A=1e15"],
        &["derive", "x'' + x^3 = 0", "--method", "exact", "--at", "A=1e30"],
        &["simulate", "x'' + exp(x) - 1 = 0", "--from", "x=1e-12", "--until", "1"],
    ];
    for arguments in answered {
        let output = Command::new(env!("CARGO_BIN_EXE_lindstedt"))
            .args(arguments)
            .output()
            .expect("the program starts");
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!message.contains("no digits left"), "{arguments:?}: {message}");
    }
}

/// Many starts have attractors in text and document, and a picture of their basins.
#[test]
fn starts_in_a_plane_have_basins() {
    let wells = ["x'' + x'/2 - x + x^3 = 0", "--sweep", "x=-1.5:1.5:6"];
    let both = [&wells[..], &["--sweep", "x'=-1:1:4", "--until", "80", "--after", "60"]].concat();
    let section = ["--every", "1"];
    let text = output(&[&both[..], &section].concat());
    assert!(text.contains("Attractors, with the number of their states on the section"), "{text}");
    let is_half = |line: &&str| line.split_whitespace().skip(1).take(3).eq(["12", "50", "%"]);
    assert_eq!(text.lines().filter(is_half).count(), 2, "{text}");
    let document = json(&[&both[..], &section].concat());
    let motions = document["motions"].as_array().expect("motions");
    let attractors = document["attractors"].as_array().expect("attractors");
    assert_eq!((motions.len(), attractors.len()), (24, 2));
    for motion in motions {
        let own = &attractors[motion["attractor"].as_u64().expect("an attractor") as usize];
        let end = own["states"][0]["x"].as_f64().expect("a place");
        assert!((end.abs() - 1.0).abs() < 1e-6, "{end}");
    }
    let picture = output(&[&both[..], &section, &["--format", "svg"]].concat());
    assert!(picture.contains("Basins of attraction") && picture.contains("attractor 2"));
    // Without a section there are no attractors, and of a parameter no basins.
    assert!(!output(&both).contains("Attractors"));
    let mixed = ["x'' + c*x' + x = 0", "--sweep", "c=0.1:0.2:2", "--sweep", "x=1:2:2"];
    let refused = run(&[&mixed[..], &section, &["--format", "svg"]].concat());
    let message = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(message.contains("or basins over two coordinates or velocities"), "{message}");
}
