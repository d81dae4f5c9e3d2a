//! Events on the command line: `simulate` with `--event`, the examples, and what is refused.

use std::process::{Command, Output};

use serde_json::Value;

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("the program starts")
}

fn printed(arguments: &[&str]) -> String {
    let output = run(arguments);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {message}");
    String::from_utf8(output.stdout).expect("text")
}

/// The command in the comment of each example.
const EXAMPLES: [&[&str]; 4] = [
    &["simulate", "examples/events/clock.toml", "--from", "x=-1", "--until", "100"],
    &["simulate", "examples/events/hopper.toml", "--from", "y=1.5", "--until", "6"],
    &["simulate", "examples/events/integrate-and-fire.toml", "--from", "v=0", "--until", "30"],
    &["simulate", "examples/events/stick-slip.toml", "--from", "x'=0.2", "--until", "60"],
];

#[test]
fn examples_print_their_events() {
    for arguments in EXAMPLES {
        let name = arguments[1].rsplit(['/', '.']).nth(1).expect("a name");
        let mut settings = insta::Settings::clone_current();
        settings.set_snapshot_path(concat!(env!("CARGO_MANIFEST_DIR"), "/snapshots"));
        settings.set_prepend_module_to_snapshot(false);
        settings.set_omit_expression(true);
        settings.bind(|| insta::assert_snapshot!(format!("events-{name}"), printed(arguments)));
        let text =
            std::fs::read_to_string(format!("{}/{}", env!("CARGO_MANIFEST_DIR"), arguments[1]));
        let text = text.expect("a file").replace('"', "");
        assert!(text.contains(&arguments.join(" ")), "{arguments:?}");
    }
}

/// A document has the events, each with the states on both sides and its energy.
#[test]
fn a_document_has_its_events() {
    let event = "x < 0: x' = -x'/2; y = y + 1";
    let from = ["--from", "x=1", "--until", "2", "--format", "json"];
    let text =
        printed(&[&["simulate", "x'' + 2 = 0; y'' = 0", "--event", event], &from[..]].concat());
    let document: Value = serde_json::from_str(&text).expect("JSON");
    let events = &document["events"];
    assert_eq!(events["events"][0]["guard"], "-x");
    assert_eq!(events["events"][0]["set"]["x'"], "-x'/2");
    let first = &events["occurrences"][0];
    assert_eq!((first["t"].as_f64(), first["before"]["x'"].as_f64()), (Some(1.0), Some(-2.0)));
    assert_eq!(
        (first["after"]["x'"].as_f64(), first["after"]["y"].as_f64()),
        (Some(1.0), Some(1.0))
    );
    assert!(first["energy_lost"].is_null());
    let ball = ["simulate", "x'' + 2 = 0", "--event", "x < 0: x' = -x'/2"];
    let document: Value =
        serde_json::from_str(&printed(&[&ball, &from[..]].concat())).expect("JSON");
    assert_eq!(document["events"]["occurrences"][0]["energy_lost"].as_f64(), Some(1.5));
    assert_eq!(document["energy"]["works"]["events"].as_f64(), Some(-1.5));
    assert_eq!(document["complete"], true);
}

/// Equations of first order have pictures too: over the time, and each over the one before.
#[test]
fn states_without_velocities_are_drawn() {
    let pictured = |arguments: &[&str]| {
        let text = printed(&[arguments, &["--format", "svg"]].concat());
        assert!(text.contains("<svg"), "{arguments:?}");
        text
    };
    let modes = ["simulate", "u' = 3*m - u; m' = 0", "--from", "u=1,m=1", "--until", "5"];
    let events = ["--event", "u > 2: m = 0", "--event", "u < 1: m = 1"];
    for more in [&[][..], &["--section", "events"]] {
        let text = pictured(&[&modes[..], &events, more].concat());
        let title = if more.is_empty() { "Phase plane" } else { "Poincaré section" };
        assert_eq!(text.matches(&format!(">{title}<")).count(), 1, "{text}");
    }
    // One state, and one before a coordinate that has a velocity.
    let neuron = ["simulate", "v' = 3/2 - v", "--event", "v > 1: v = 0", "--from", "v=0"];
    let neuron = [&neuron[..], &["--until", "5"]].concat();
    assert!(!pictured(&neuron).contains("Phase plane"));
    pictured(&[&neuron[..], &["--section", "events"]].concat());
    let mixed = ["simulate", "m' = x - m; x'' + x = 0", "--from", "x=1", "--until", "5"];
    assert_eq!(pictured(&mixed).matches(">Phase plane<").count(), 1);
}

/// Steady motions of a kicked oscillator: one event in a period, in text and document.
#[test]
fn a_response_has_its_events() {
    let kicked = ["response", "x'' + x'/5 + x = 0", "--event", "sin(w*t) > 0: x' = x' + 1/2"];
    let vary = ["--vary", "w=0.9:1.1"];
    let text = printed(&[&kicked[..], &vary].concat());
    for words in ["event where sin(w*t) grows through zero", "Events in a period: 1 from w = 0.9"] {
        assert!(text.contains(words), "{text}");
    }
    let text = printed(&[&kicked[..], &vary, &["--format", "json"]].concat());
    let document: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(document["events"][0]["set"]["x'"], "1/2 + x'");
    let counts = document["event_counts"][0].as_array().expect("counts");
    assert!(counts.len() > 5 && counts.iter().all(|count| count == 1));
    let table = printed(&[&kicked[..], &vary, &["--format", "csv"]].concat());
    let cells: Vec<usize> = table
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| line.split(',').count())
        .collect();
    assert!(cells.len() > 5 && cells.iter().all(|count| *count == cells[0]), "{table}");
    let refused = run(&[&kicked[..], &vary, &["--along", "c=0.1:0.3"]].concat());
    let message = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(message.contains("there is no parameter c"), "{message}");
}

/// A parameter that the command line varies needs no value: that of the file is left out.
#[test]
fn a_parameter_of_a_file_can_be_varied() {
    let clock = ["response", "examples/events/clock.toml", "--vary", "p=0.3:0.4"];
    let text = printed(&clock);
    assert!(text.contains("p from 0.3 to 0.4") && text.contains("f = 0.05"), "{text}");
    let refused = run(&[&clock[..], &["--at", "p=0.3"]].concat());
    let message = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(message.contains("leave out its value"), "{message}");
}

/// A bifurcation diagram of a kicked oscillator: a row for each state just before a kick.
#[test]
fn a_sweep_takes_events() {
    let sweep = ["--sweep", "p=0.1:0.3:3", "--from", "x=0", "--until", "100", "--after", "50"];
    let kicked = ["simulate", "x'' + x'/5 + x = 0", "--event", "sin(t) > 0: x' = x' + p"];
    let text = printed(&[&kicked[..], &sweep].concat());
    assert!(text.contains("events"), "{text}");
    let text =
        printed(&[&kicked[..], &sweep, &["--section", "events", "--format", "csv"]].concat());
    assert_eq!(text.lines().count(), 1 + 3 * 8, "{text}");
}

#[test]
fn bad_events_are_refused_with_a_way_forward() {
    let refusal = |extra: &[&str]| {
        let output = run(&[&["simulate", "x'' + x = 0", "--from", "x=0.5"], extra].concat());
        assert!(!output.status.success(), "{extra:?}");
        String::from_utf8(output.stderr).expect("text")
    };
    for (extra, words) in [
        (&["--event", "x > 1"][..], "no `:` behind the condition"),
        (&["--event", "x > 1: y = 2"], "^ one of `x`, `x'`"),
        (&["--event", "x > 1:"], "this event changes nothing"),
        (&["--event", "d > 1: x = 2"], "this condition never changes"),
        (&["--event", "x > 1: x = d"], "no value for `d`"),
        (&["--section", "events"], "there are no events: give --event"),
        (&["--static-friction", "2"], "needs a dry friction in the equations"),
        (&["--static-friction", "mus"], "no value for `mus`"),
        (&["--static-friction", "1/2"], "must be 1 or more"),
        (&["--event", "x < 1: x' = -x'", "--wall", "x < 0", "--restitution", "1"], "behind a wall"),
    ] {
        let refusal = refusal(extra);
        assert!(refusal.contains(words), "{extra:?}: {refusal}");
    }
}

/// Events of a motion that come ever faster end it with the reason, and what there is is kept.
#[test]
fn accumulating_events_are_a_partial_result() {
    let ball = ["--event", "x < 0: x' = -0.8*x'", "--from", "x=1", "--until", "30"];
    let output = run(&[&["simulate", "x'' + 2 = 0"], &ball[..]].concat());
    assert_eq!(output.status.code(), Some(4));
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(message.contains("events follow each other ever faster"), "{message}");
}
