//! Searches for the best damper: what they find against other ways to the same numbers, and that threads, records and interrupts change nothing.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use lindstedt::export::{decimal, significant};
use lindstedt::genetic::Options;
use lindstedt::impact::{Integrator, Parameter, Settings, simulate};
use lindstedt::optimize::{Objective, Question, Role, Route, Study, Watch, optimize};
use lindstedt::problem::Problem;

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .args(arguments)
        .output()
        .expect("the program starts")
}

fn printed(arguments: &[&str]) -> String {
    let output = run(arguments);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && errors.is_empty(), "{arguments:?}: {errors}");
    String::from_utf8(output.stdout).expect("text")
}

fn example(name: &str) -> String {
    format!("{}/examples/optimize/{name}.toml", env!("CARGO_MANIFEST_DIR"))
}

fn asked(text: &str) -> Question {
    text.parse::<Problem>().expect("a file").optimize().expect("a question")
}

fn study(question: Question) -> Study {
    optimize(question, vec![], &Watch::default()).expect("a study")
}

fn role(study: &Study, parameter: Parameter) -> Role {
    let decision = study.decision.as_ref().expect("a decision");
    let found = decision.sensitivities.iter().find(|of| of.parameter == parameter);
    found.expect("a variable").role
}

/// The corner of the length depends on the unit of the rest time, and the rest of the box is flat.
#[test]
fn the_unit_of_the_rest_time_chooses_the_corner() {
    for (objective, end, corner) in [
        (Objective::RestTime, 0.03, Role::Lower),
        (Objective::DimensionlessRestTime, 0.3, Role::Upper),
    ] {
        let found = study(Question {
            objectives: vec![objective],
            runs: 3,
            ..Question::default()
        });
        let best = &found.best().expect("a design").design;
        assert!((best.point[2] / end - 1.0).abs() < 1e-3, "{best:?}");
        assert_eq!(role(&found, Parameter::Length), corner);
        for flat in [Parameter::Mass, Parameter::Radius, Parameter::Modulus] {
            assert_eq!(role(&found, flat), Role::Flat, "{flat}");
        }
        let ends = found
            .decision
            .as_ref()
            .and_then(|decision| decision.ends)
            .expect("both ends");
        assert!(ends.seconds[0] < ends.seconds[1] && ends.dimensionless[0] > ends.dimensionless[1]);
        // No run ends before the window of the test is full, and the best value never rises.
        assert!(found.runs.iter().all(|run| run.generations >= 51));
        assert!(
            found
                .runs
                .iter()
                .all(|run| run.curve.windows(2).all(|pair| pair[1] <= pair[0]))
        );
    }
}

/// With mu held fixed the softest barrier loses most: there m, R and E are no longer flat.
#[test]
fn what_is_held_fixed_decides_what_is_flat() {
    let found = study(Question {
        runs: 2,
        ..asked("[contact]\nmu = 1e4\n[genetic]\npopulation = 40")
    });
    assert_eq!(role(&found, Parameter::Modulus), Role::Lower);
    let best = &found.best().expect("a design").design;
    assert!(best.model.gamma < 1e5, "{}", best.model.gamma);
}

#[test]
fn the_best_design_rests_when_runge_kutta_says() {
    let found = study(Question {
        runs: 1,
        ..Question::default()
    });
    let best = found.best().expect("a design");
    let (model, start) = found.question.motion_of(&best.design.point).expect("a motion");
    let settings = Settings {
        duration: 150.0,
        ..Settings::default()
    };
    let judge = simulate(&model, start, Integrator::RungeKutta, &settings).expect("a motion");
    let truth = judge.rest().time.expect("it rests");
    let dimensionless = best.design.rest_time.expect("it rests");
    assert!((dimensionless / truth - 1.0).abs() < 1e-7, "{dimensionless} {truth}");
    let seconds = truth * (best.design.case.design.length / 9.81).sqrt();
    assert!((best.values[0] / seconds - 1.0).abs() < 1e-7);
    assert!((best.by_chain[0] / seconds - 1.0).abs() < 1e-3);
    // The hardest contact is the first; its force by the motion itself.
    let first = judge.impacts[0];
    let (entry, exit) = (first.entry_time, first.exit_time.expect("an end"));
    let force = (0..=2000).map(|step| {
        let t = entry + (exit - entry) * f64::from(step) / 2000.0;
        let (x, velocity) = judge.path.at(t).expect("a state");
        model.contact(x - 0.323, velocity)
    });
    let greatest = force.fold(0.0, f64::max) * best.design.units.force();
    let hardest = best.design.hardest.expect("a contact");
    assert!(
        (hardest.force / greatest - 1.0).abs() < 2e-3,
        "{} {greatest}",
        hardest.force
    );
}

#[test]
fn a_mass_between_the_limits_is_a_trade_and_is_integrated() {
    let text = std::fs::read_to_string(example("trade")).expect("an example");
    let found = study(asked(&text));
    assert_eq!(role(&found, Parameter::Mass), Role::Trade);
    let (evaluations, integrated) = found.evaluations();
    assert!(integrated > evaluations / 2, "{integrated} of {evaluations}");
    let best = found.best().expect("a design");
    for factor in [0.9, 1.1] {
        let aside = [factor * best.design.point[0]];
        let aside = found
            .question
            .follow(&aside, Route::Integration, false)
            .expect("a design");
        assert!(
            Objective::RestTime
                .value(&aside)
                .is_none_or(|time| time > best.values[0])
        );
    }
}

#[test]
fn constraints_are_kept_by_integration_too() {
    let text = std::fs::read_to_string(example("steel-sphere")).expect("an example");
    let found = study(Question {
        runs: 3,
        ..asked(&text)
    });
    let best = found.best().expect("a design");
    assert!(best.feasible);
    let design = &best.design;
    let volume = 4.0 / 3.0 * std::f64::consts::PI * design.case.design.radius.powi(3);
    assert!((design.case.design.mass / (7850.0 * volume) - 1.0).abs() < 1.1e-3);
    assert!(design.hardest.expect("a contact").force < 101.0);
    assert!(!found.decision.as_ref().expect("a decision").active.is_empty());
}

#[test]
fn the_material_is_chosen_by_what_it_loses() {
    let text = std::fs::read_to_string(example("materials")).expect("an example");
    let question = asked(&text);
    let found = study(question);
    let best = &found.best().expect("a design").design;
    let values = &found.decision.as_ref().expect("a decision").materials;
    let chosen = best.material.expect("a material");
    assert_eq!(found.question.materials[chosen].name, "Rubber");
    assert!(
        values
            .iter()
            .flatten()
            .all(|value| *value >= values[chosen].expect("it rests"))
    );
    assert!(found.papers.is_none());
}

#[test]
fn a_front_has_nobody_who_is_worse_in_everything() {
    let text = std::fs::read_to_string(example("front")).expect("an example");
    let found = study(asked(&text));
    assert!(found.finalists.len() > 20 && found.decision.is_none() && found.rivals.is_empty());
    for pair in found.finalists.windows(2) {
        let [one, other] = [&pair[0].values, &pair[1].values];
        // By integration a little may turn around.
        assert!(one[0] <= other[0] && one[1] > other[1] * 0.999, "{one:?} {other:?}");
    }
}

/// Budget, options and seed make the result, threads do not.
#[test]
fn threads_change_nothing() {
    let file = example("table-4");
    let with = |jobs: &str| {
        printed(&[
            "optimize", &file, "--runs", "4", "--budget", "1200", "--jobs", jobs, "--format", "json",
        ])
    };
    let alone = with("1");
    assert_eq!(alone, with("3"));
    assert_ne!(
        alone,
        printed(&[
            "optimize", &file, "--runs", "4", "--budget", "1200", "--seed", "2", "--format", "json"
        ])
    );
    let document: serde_json::Value = serde_json::from_str(&alone).expect("JSON");
    for run in document["runs"].as_array().expect("runs") {
        assert_eq!(run["evaluations"], 100 + 2 * 98);
        assert_eq!(run["stop"], "budget");
    }
}

fn lines(path: &Path) -> usize {
    std::fs::read_to_string(path).map_or(0, |text| text.matches('\n').count())
}

/// A process that is killed in the middle leaves a record that reads, and taken up again the result is that of one go.
#[test]
fn a_killed_search_is_taken_up_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let record: PathBuf = folder.path().join("runs.jsonl");
    let path = record.to_str().expect("text");
    let whole = ["optimize", "--runs", "12", "--seed", "5", "--format", "json"];
    let mut child = Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .args([&whole[..], &["--record", path, "--jobs", "1"]].concat())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    let started = Instant::now();
    while lines(&record) < 3 && started.elapsed() < Duration::from_secs(120) {
        std::thread::sleep(Duration::from_millis(5));
    }
    child.kill().expect("it ends");
    child.wait().expect("it ended");
    let done = lines(&record) - 1;
    assert!((2..12).contains(&done), "{done} runs");
    // As if it had been killed while it wrote.
    let mut text = std::fs::read_to_string(&record).expect("a record");
    text.truncate(text.len() - 40);
    std::fs::write(&record, &text).expect("a file");
    let resumed = printed(&[&whole[..], &["--resume", path]].concat());
    assert_eq!(resumed, printed(&whole));
    assert_eq!(lines(&record), 13);
    // All of it is there now.
    assert_eq!(printed(&[&whole[..], &["--resume", path]].concat()), resumed);
    let other = run(&["optimize", "--runs", "12", "--seed", "6", "--resume", path]);
    let message = String::from_utf8_lossy(&other.stderr).into_owned();
    assert!(
        other.status.code() == Some(1) && message.contains("`seed` differs"),
        "{message}"
    );
    let again = run(&["optimize", "--runs", "12", "--seed", "5", "--record", path]);
    let message = String::from_utf8_lossy(&again.stderr).into_owned();
    assert!(
        again.status.code() == Some(1) && message.contains("--resume"),
        "{message}"
    );
    std::fs::write(&record, "no record\n").expect("a file");
    let nothing = run(&["optimize", "--resume", path]);
    assert!(nothing.status.code() == Some(1) && nothing.stdout.is_empty());
}

#[cfg(unix)]
#[test]
fn an_interrupt_keeps_what_was_done() {
    let folder = tempfile::tempdir().expect("a folder");
    let record: PathBuf = folder.path().join("runs.jsonl");
    let path = record.to_str().expect("text");
    let child = Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .args(["optimize", "--runs", "400", "--record", path])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let started = Instant::now();
    while lines(&record) < 3 && started.elapsed() < Duration::from_secs(120) {
        std::thread::sleep(Duration::from_millis(5));
    }
    let asked = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(asked.expect("kill").success());
    let output = child.wait_with_output().expect("it ended");
    let (text, said) = (
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr),
    );
    assert_eq!(output.status.code(), Some(4), "{said}");
    assert!(
        text.contains("Stopped before the end") && text.contains("What decides"),
        "{text}"
    );
    assert!(said.contains("stopped early") && said.contains("--resume"), "{said}");
}

#[test]
fn a_budget_of_time_hands_back_what_is_done() {
    let output = run(&["optimize", "--runs", "1000", "--budget", "0.5s"]);
    assert_eq!(output.status.code(), Some(4));
    assert!(String::from_utf8_lossy(&output.stdout).contains("Stopped before the end"));
    let output = run(&["optimize", "--budget", "500"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("less than one population"));
    let output = run(&["optimize", "--budget", "soon"]);
    assert_eq!(output.status.code(), Some(2));
}

#[cfg(feature = "plot")]
#[test]
fn pictures_show_runs_box_and_front() {
    let folder = tempfile::tempdir().expect("a folder");
    let result = folder.path().join("result.txt");
    let place = ["--output", result.to_str().expect("text"), "--plot", "-"];
    for (name, words) in [
        ("bits", ["Convergence", "Where the good designs lie", "Table 5"]),
        ("trade", ["Convergence", "rest time (s)", "each run"]),
        ("front", ["Front", "peak force (N)", "Table 5"]),
    ] {
        let picture = printed(&[&["optimize", &example(name)], &place[..]].concat());
        assert!(picture.starts_with("<svg"), "{name}");
        assert!(words.iter().all(|words| picture.contains(words)), "{name}");
        assert_eq!(picture, printed(&[&["optimize", &example(name)], &place[..]].concat()));
    }
}

/// The numbers of the page are computed here.
#[test]
fn the_page_prints_what_is_found() {
    let page = include_str!("../../docs/optimize.md");
    let text = std::fs::read_to_string(example("table-4")).expect("an example");
    let question = asked(&text);
    assert_eq!(question.genetic, Options::default());
    let found = study(question.clone());
    let (best, papers) = (
        &found.best().expect("a design").design,
        found.papers.as_ref().expect("Table 5"),
    );
    let mut rows = Vec::new();
    for objective in [
        Objective::RestTime,
        Objective::DimensionlessRestTime,
        Objective::PeakForce,
        Objective::PeakPressure,
    ] {
        let [one, other] = [best, papers].map(|design| decimal(objective.value(design).expect("a value")));
        rows.push(format!(
            "| {}, {} | {one} | {other} |",
            objective.meaning(),
            objective.unit()
        ));
    }
    let decision = found.decision.as_ref().expect("a decision");
    for of in &decision.sensitivities {
        let [least, greatest] = of.range.expect("it rests everywhere");
        rows.push(format!(
            "| {} | {} | {} | {} | {} |",
            of.parameter.name(),
            significant(of.elasticity.expect("a slope"), 3),
            significant(least, 4),
            significant(greatest, 4),
            of.role.name()
        ));
    }
    let ends = decision.ends.expect("both ends");
    for index in 0..2 {
        rows.push(format!(
            "| {} | {} | {} |",
            decimal(ends.lengths[index]),
            significant(ends.seconds[index], 4),
            significant(ends.dimensionless[index], 4)
        ));
    }
    rows.push(format!("{} % of the box", significant(100.0 * decision.share, 3)));
    for rival in &found.rivals {
        let apart = rival.spread().expect("values").median / found.spread().expect("values").median - 1.0;
        rows.push(format!("| {} | {} % |", rival.name, significant(100.0 * apart, 2)));
    }
    for row in &rows {
        assert!(page.contains(row.as_str()), "{row}\nof\n{}", rows.join("\n"));
    }
}

/// No column stands there twice, whether the mass varies, is wanted small, or both.
#[test]
fn every_column_has_its_own_name() {
    for (objective, fixed, columns) in [
        (r#"["rest_time", "peak_force"]"#, "", 10),
        (r#"["rest_time", "peak_force"]"#, "[design]\nmass = 0.01\n", 10),
        (r#"["mass", "rest_time"]"#, "", 10),
        (r#""mass""#, "", 9),
    ] {
        let text = format!("{fixed}[genetic]\nobjective = {objective}\npopulation = 6\ngenerations = 2\nruns = 1\n");
        let table = lindstedt::export::optimization::csv(&study(asked(&text)));
        let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
        let names: std::collections::BTreeSet<&str> = rows[1].iter().copied().collect();
        assert_eq!((names.len(), rows[1].len()), (columns, columns), "{table}");
        assert!(names.contains("mass"), "{table}");
        assert!(rows.iter().all(|row| row.len() == columns), "{table}");
    }
}

/// What is held fixed has a say: where every material has a damping of its own, that of the contact has none.
#[test]
fn a_damping_without_say_is_not_said_to_be_held_fixed() {
    let text = |second: &str| {
        format!(
            "[[material]]\nname = \"Steel\"\nmodulus = 200e9\nrestitution = 0.9\n[[material]]\nname = \"Rubber\"\nmodulus = 8e6\n{second}\n\
             [genetic]\npopulation = 6\ngenerations = 2\nruns = 1\n"
        )
    };
    for (second, held) in [("restitution = 0.6", false), ("", true)] {
        let question = asked(&text(second));
        assert_eq!(question.holds_contact_damping(), held);
        assert_eq!(question.defaults.contains(&Parameter::Lambda), held);
        let found = study(question);
        let printed = lindstedt::export::text::optimization(&found, 120);
        assert_eq!(printed.contains("lambda"), held, "{printed}");
        let document = lindstedt::export::json::optimization(&found);
        let document = serde_json::to_value(document).expect("JSON");
        assert_eq!(
            document["asked"]["held_fixed"]["contact"].is_null(),
            !held,
            "{document}"
        );
    }
}
