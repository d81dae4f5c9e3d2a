//! Searches for the best damper: what they find against other ways to the same numbers, and that
//! threads, records and interrupts change nothing.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

use lindstedt::export::{decimal, significant};
use lindstedt::genetic::GeneticOptions;
use lindstedt::impact::primary::simulate_primary;
use lindstedt::impact::{Integrator, Parameter, Settings, Simulation, simulate};
use lindstedt::optimize::{
    Objective, OptimizationProblem, Route, Study, StudyObserver, VariableRole, optimize,
};
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

fn asked(text: &str) -> OptimizationProblem {
    text.parse::<Problem>().expect("a file").optimize().expect("a question")
}

fn study(question: OptimizationProblem) -> Study {
    optimize(question, vec![], &StudyObserver::default()).expect("a study")
}

fn role(study: &Study, parameter: Parameter) -> VariableRole {
    let decision = study.decision.as_ref().expect("a decision");
    let found = decision.sensitivities.iter().find(|of| of.parameter == parameter);
    found.expect("a variable").role
}

/// The corner of the length depends on the unit of the rest time, and the rest of the box is flat.
#[test]
fn the_unit_of_the_rest_time_chooses_the_corner() {
    for (objective, end, corner) in [
        (Objective::RestTime, 0.03, VariableRole::Lower),
        (Objective::DimensionlessRestTime, 0.3, VariableRole::Upper),
    ] {
        let found = study(OptimizationProblem {
            objectives: vec![objective],
            runs: 3,
            ..OptimizationProblem::default()
        });
        let best = &found.best().expect("a design").design;
        assert!((best.point[2] / end - 1.0).abs() < 1e-3, "{best:?}");
        assert_eq!(role(&found, Parameter::Length), corner);
        for flat in [Parameter::Mass, Parameter::Radius, Parameter::Modulus] {
            assert_eq!(role(&found, flat), VariableRole::Flat, "{flat}");
        }
        let ends = found.decision.as_ref().and_then(|decision| decision.ends).expect("both ends");
        assert!(ends.seconds[0] < ends.seconds[1] && ends.dimensionless[0] > ends.dimensionless[1]);
        // No run ends before the window of the test is full, and the best value never rises.
        assert!(found.runs.iter().all(|run| run.generations >= 51));
        assert!(found.runs.iter().all(|run| run.curve.windows(2).all(|pair| pair[1] <= pair[0])));
    }
}

/// With mu held fixed the softest barrier loses most: there m, R and E are no longer flat.
#[test]
fn what_is_held_fixed_decides_what_is_flat() {
    let found = study(OptimizationProblem {
        runs: 2,
        ..asked("[contact]\nmu = 1e4\n[genetic]\npopulation = 40")
    });
    assert_eq!(role(&found, Parameter::Modulus), VariableRole::Lower);
    let best = &found.best().expect("a design").design;
    assert!(best.model.gamma < 1e5, "{}", best.model.gamma);
}

#[test]
fn the_best_design_rests_when_runge_kutta_says() {
    let found = study(OptimizationProblem { runs: 1, ..OptimizationProblem::default() });
    let best = found.best().expect("a design");
    let (model, start) = found.question.motion_of(&best.design.point).expect("a motion");
    let settings = Settings { duration: 150.0, ..Settings::default() };
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
        let (x, velocity) = judge.path.phase_point_at(t).expect("a state");
        model.contact(x - 0.323, velocity)
    });
    let greatest = force.fold(0.0, f64::max) * best.design.units.force();
    let hardest = best.design.hardest.expect("a contact");
    assert!((hardest.force / greatest - 1.0).abs() < 1e-4, "{} {greatest}", hardest.force);
}

/// The motion of a design by Runge-Kutta, as far as it is followed in a search.
fn judged(question: &OptimizationProblem, point: &[f64]) -> Simulation {
    let (model, start) = question.motion_of(point).expect("a motion");
    let settings = Settings { duration: question.settings.duration, ..Settings::default() };
    simulate(&model, start, Integrator::RungeKutta, &settings).expect("a motion")
}

/// The greatest force in units of m g, its restitution, and the number of contacts until rest, read
/// off a motion.
fn hardest_of(motion: &Simulation) -> (f64, f64, usize) {
    let rest = motion.rest().time.expect("it rests");
    let impacts = motion.impacts.iter().filter(|impact| impact.entry_time < rest);
    let hardest = impacts.clone().map(|impact| {
        let (entry, exit) = (impact.entry_time, impact.exit_time.expect("an end"));
        let barrier = motion.model.barrier(impact.side).expect("a barrier");
        let force = (0..=4000).map(|step| {
            let t = entry + (exit - entry) * f64::from(step) / 4000.0;
            let (x, velocity) = motion.path.phase_point_at(t).expect("a state");
            motion.model.contact(impact.side.sign() * (x - barrier), impact.side.sign() * velocity)
        });
        (force.fold(0.0, f64::max), impact.restitution.expect("a restitution"))
    });
    let (force, restitution) =
        hardest.fold((0.0, 0.0), |one, other| if other.0 > one.0 { other } else { one });
    (force, restitution, impacts.count())
}

/// Gravity presses the bob into a soft barrier: in closed form the contact is another one.
#[test]
fn force_and_restitution_of_an_integrated_design_are_those_of_its_motion() {
    for (contact, point) in [
        ("mu = 2000", [0.05, 0.001, 0.03, 1e6]),
        ("mu = 2000", [0.2, 0.002, 0.05, 1e6]),
        ("mu = 300", [0.1, 0.001, 0.05, 3e5]),
        ("lambda = 0.5", [0.1, 0.002, 0.2, 1e5]),
    ] {
        let text = format!(
            "[limits]\nmass = [0.05, 0.2]\nradius = [0.001, 0.002]\nlength = [0.03, 0.2]\nmodulus = [1e5, 1e7]\n[contact]\n{contact}\n"
        );
        let question = asked(&text);
        let design = question.follow(&point, Route::Integration, true).expect("a design");
        let (force, restitution, impacts) = hardest_of(&judged(&question, &point));
        let hardest = design.hardest.expect("a contact");
        let found = hardest.force / design.units.force();
        assert!((found / force - 1.0).abs() < 1e-5, "{contact} {point:?}: {found} {force}");
        let found = hardest.restitution.expect("a restitution");
        assert!((found / restitution - 1.0).abs() < 1e-5, "{found} {restitution}");
        assert_eq!(design.impacts, impacts);
    }
}

/// The numbers of a pendulum on a main mass are those of that motion, as `simulate` follows it from
/// the same file.
#[test]
fn a_main_mass_and_its_pendulum_have_the_numbers_of_their_own_motion() {
    const FILE: &str = "[primary]\nmass = 0.56\nstiffness = 200\ndamping = 0.4\ndisplacement = 0.03\n[design]\nradius = 0.0096\n\
                        modulus = 1.439e9\n[contact]\nmu_over_gamma = 0.5\n[damping]\nzeta = 0.02\n";
    for (start, point) in [
        ("barrier = [-0.3, 0.3]", [0.0279, 0.15]),
        ("barrier = [-0.3, 0.3]\nstart = -0.29\nspeed = 0.4", [0.0279, 0.15]),
        ("barrier = [-0.3, 0.3]\nstart = 0.1\nspeed = -0.5", [0.04, 0.1]),
        ("barrier = 0.2", [0.01, 0.08]),
    ] {
        let searched = format!(
            "{FILE}[pendulum]\n{start}\n[limits]\nmass = [0.005, 0.05]\nlength = [0.03, 0.15]\n[genetic]\nobjective = \"primary_rest_time\"\n"
        );
        let question = asked(&searched);
        let design = question.follow(&point, Route::Integration, true).expect("a design");
        let fixed = FILE.replace(
            "[design]\n",
            &format!("[design]\nmass = {}\nlength = {}\n", point[0], point[1]),
        );
        let simulated = format!("{fixed}[pendulum]\n{start}\n[run]\nduration = 500\n");
        let file: Problem = simulated.parse().expect("a file");
        let primary = file.primary_case(&[]).expect("a main mass");
        let motion = simulate_primary(primary.case, &primary.settings).expect("a motion");
        let rest = motion.rest_time().expect("it rests");
        let seconds = Objective::PrimaryRestTime.value(&design).expect("it rests");
        assert!((seconds / (rest * primary.units.time()) - 1.0).abs() < 1e-9, "{start}: {seconds}");
        let until = motion.pendulum_rest_time().expect("it rests");
        let impacts: Vec<_> =
            motion.impacts.iter().filter(|impact| impact.entry_time < until).collect();
        assert_eq!(
            design.impacts,
            impacts.len(),
            "{start}: until {until}, {:?}",
            motion.impacts.last()
        );
        assert!(!impacts.is_empty(), "{start}");
        // The force by looking at the states.
        let force = impacts.iter().flat_map(|impact| {
            let exit = impact.exit_time.expect("an end");
            let (motion, model, sign) = (&motion, primary.case.model, impact.side.sign());
            let barrier = model.barrier(impact.side).expect("a barrier");
            (0..=400).map(move |step| {
                let t = impact.entry_time + (exit - impact.entry_time) * f64::from(step) / 400.0;
                let state = motion.state_at(t).expect("a state");
                model.contact(sign * (state.x - barrier), sign * state.velocity)
            })
        });
        let greatest = force.fold(0.0, f64::max) * design.units.force();
        let hardest = design.hardest.expect("a contact");
        assert!(
            (hardest.force / greatest - 1.0).abs() < 1e-3,
            "{start}: {} {greatest}",
            hardest.force
        );
        let deepest = impacts.iter().map(|impact| impact.penetration).fold(0.0, f64::max);
        // Hertz: p = 3 F/(2 pi R d).
        let elastic = design.units.force() * design.model.gamma * deepest.powf(1.5);
        let pressure = 1.5 * elastic / (std::f64::consts::PI * 0.0096 * point[1] * deepest);
        assert!((hardest.pressure / pressure - 1.0).abs() < 1e-9);
        let restitutions =
            impacts.iter().map(|impact| impact.speed_out.expect("a speed") / impact.speed_in);
        let own = hardest.restitution.expect("a restitution");
        assert!(restitutions.into_iter().any(|other| (other - own).abs() < 1e-12));
    }
}

/// Limits beside a main mass hold for its own motion.
#[test]
fn limits_beside_a_main_mass_are_those_of_its_motion() {
    let text = std::fs::read_to_string(example("main-mass")).expect("an example");
    let force = |question: &OptimizationProblem, point: &[f64]| {
        let design = question.follow(point, Route::Integration, true).expect("a design");
        Objective::PeakForce.value(&design).expect("a force")
    };
    let limit = force(&asked(&text), &[0.02, 0.1]);
    let limited = text.replace("[limits]\n", &format!("[limits]\nmax_peak_force = {limit}\n"));
    let mut question = asked(&limited);
    (question.runs, question.genetic.population, question.genetic.generations) = (1, 6, 2);
    let found = study(question);
    let own = force(&found.question, &found.best().expect("a design").design.point);
    assert!((1e-3..=limit).contains(&own), "{own} {limit}");
    let document = lindstedt::export::text::document(&lindstedt::report::optimization(&found), 120);
    // Designs are followed by closed forms, and those that decide a limit by integration.
    let (all, integrated) = found.evaluations();
    assert!(integrated < all && document.contains("closed forms"), "{document}");
}

/// Hard limits are kept by the default way, as the judge sees it.
#[test]
fn designs_that_keep_hard_limits_are_found() {
    for limit in ["max_peak_force = 30", "max_impacts = 9", "max_peak_pressure = 5e7"] {
        let text =
            format!("[limits]\n{limit}\n[genetic]\nruns = 1\npopulation = 30\ngenerations = 40\n");
        let found = study(asked(&text));
        let best = found.best().expect("a design");
        let motion = judged(&found.question, &best.design.point);
        let (force, _, impacts) = hardest_of(&motion);
        let force = force * best.design.units.force();
        assert!(best.feasible);
        match limit {
            "max_peak_force = 30" => {
                assert!(force <= 30.0 * (1.0 + 1e-4) && force > 20.0, "{force}")
            }
            "max_impacts = 9" => assert!(impacts <= 9 && impacts > 5, "{impacts}"),
            _ => assert!(
                Objective::PeakPressure.value(&best.design).is_some_and(|pressure| pressure <= 5e7)
            ),
        }
        let said = lindstedt::report::optimization_sentences(&found).join("\n");
        if limit == "max_impacts = 9" {
            assert!(said.contains("It breaks max_impacts = 9 (11)"), "{said}");
        }
        assert!(!said.contains("as good as the best"), "{said}");
    }
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("death.toml");
    let text = "[limits]\nmax_peak_force = 30\n[genetic]\npenalty = \"death\"\npopulation = 10\nruns = 1\ngenerations = 10\n";
    std::fs::write(&file, text).expect("a file");
    let missed = run(&["optimize", file.to_str().expect("a path in text")]);
    let message = String::from_utf8_lossy(&missed.stderr).into_owned();
    assert!(missed.status.code() == Some(1) && missed.stdout.is_empty());
    assert!(message.contains("there are some") && message.contains("feasible-first"), "{message}");
}

/// Sentences follow from numbers that were computed.
#[test]
fn no_sentence_says_more_than_the_numbers() {
    let said = |text: &str| {
        let found = study(asked(text));
        let sentences = lindstedt::report::optimization_sentences(&found).join("\n");
        (found, sentences)
    };
    const SHORT: &str = "[genetic]\nruns = 2\npopulation = 30\ngenerations = 20\n";
    // The length that is best in seconds lies between the limits.
    let (found, sentences) = said(&format!("[damping]\nviscous = 0.003\n{SHORT}"));
    let ends = found.decision.as_ref().and_then(|decision| decision.ends).expect("both ends");
    let inside = ends.best_lengths.iter().any(|length| !ends.lengths.contains(length));
    assert!(inside && !sentences.contains("from one end to the other"), "{sentences}");
    // No run stood still.
    assert!(
        sentences.contains("no run ended because") && !sentences.contains("either"),
        "{sentences}"
    );
    let (_, sentences) = said("[genetic]\nruns = 2\npopulation = 30\n");
    assert!(sentences.contains("from one end to the other"), "{sentences}");
    // What random search finds is better: nothing found is an optimum.
    for text in [
        "[genetic]\nruns = 3\npopulation = 4\ngenerations = 2\n",
        "[damping]\nviscous = 0.5\n[genetic]\nruns = 2\npopulation = 4\ngenerations = 2\n",
    ] {
        let (found, sentences) = said(text);
        let own = found.decision.as_ref().expect("a decision").value;
        let better = found.rivals.iter().filter_map(|rival| rival.spread());
        let better = better.fold(f64::INFINITY, |best, spread| best.min(spread.best));
        let is_better = better < own * (1.0 - 1e-3);
        assert_eq!(
            sentences.contains("is no optimum"),
            is_better || sentences.contains("a look around it"),
            "{sentences}"
        );
        if is_better {
            assert!(!sentences.contains("The optimum is a corner"), "{sentences}");
        }
    }
}

#[test]
fn a_mass_between_the_limits_is_a_trade_and_is_integrated() {
    let text = std::fs::read_to_string(example("trade")).expect("an example");
    let found = study(asked(&text));
    assert_eq!(role(&found, Parameter::Mass), VariableRole::Trade);
    let (evaluations, integrated) = found.evaluations();
    assert!(integrated > evaluations / 2, "{integrated} of {evaluations}");
    let best = found.best().expect("a design");
    for factor in [0.9, 1.1] {
        let aside = [factor * best.design.point[0]];
        let aside = found.question.follow(&aside, Route::Integration, false).expect("a design");
        assert!(Objective::RestTime.value(&aside).is_none_or(|time| time > best.values[0]));
    }
}

#[test]
fn constraints_are_kept_by_integration_too() {
    let text = std::fs::read_to_string(example("steel-sphere")).expect("an example");
    let found = study(OptimizationProblem { runs: 3, ..asked(&text) });
    let best = found.best().expect("a design");
    assert!(best.feasible);
    let design = &best.design;
    let volume = 4.0 / 3.0 * std::f64::consts::PI * design.case.design.radius.powi(3);
    assert!((design.case.design.mass / (7850.0 * volume) - 1.0).abs() < 1.1e-3);
    assert!(design.hardest.expect("a contact").force <= 100.0);
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
    assert!(values.iter().flatten().all(|value| *value >= values[chosen].expect("it rests")));
    assert!(found.default_design.is_none());
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
            "optimize", &file, "--runs", "4", "--budget", "1200", "--jobs", jobs, "--format",
            "json",
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

/// Waits until a search has written so many lines of its record; one of more runs than anybody has
/// time for does.
fn wait_for_lines(child: &mut Child, record: &Path, count: usize) {
    while lines(record) < count {
        assert!(child.try_wait().expect("a state").is_none(), "the search has ended");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// A process that is killed in the middle leaves a record that reads, and taken up again the result
/// is that of one go.
#[test]
fn a_killed_search_is_taken_up_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let record: PathBuf = folder.path().join("runs.jsonl");
    let path = record.to_str().expect("text");
    let whole = ["optimize", "--runs", "12", "--seed", "5", "--format", "json"];
    // The number of runs is all that may differ.
    let mut child = Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .args(["optimize", "--runs", "100000", "--seed", "5", "--record", path, "--jobs", "1"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    wait_for_lines(&mut child, &record, 4);
    child.kill().expect("it ends");
    child.wait().expect("it ended");
    // As if it had been killed while it wrote the third run.
    let text = std::fs::read_to_string(&record).expect("a record");
    let first: Vec<&str> = text.split_inclusive('\n').take(4).collect();
    let first = first.concat();
    std::fs::write(&record, &first[..first.len() - 40]).expect("a file");
    let resumed = printed(&[&whole[..], &["--resume", path]].concat());
    assert_eq!(resumed, printed(&whole));
    assert_eq!(lines(&record), 13);
    // All of it is there now.
    assert_eq!(printed(&[&whole[..], &["--resume", path]].concat()), resumed);
    let other = run(&["optimize", "--runs", "12", "--seed", "6", "--resume", path]);
    let message = String::from_utf8_lossy(&other.stderr).into_owned();
    assert!(other.status.code() == Some(1) && message.contains("`seed` differs"), "{message}");
    let again = run(&["optimize", "--runs", "12", "--seed", "5", "--record", path]);
    let message = String::from_utf8_lossy(&again.stderr).into_owned();
    assert!(again.status.code() == Some(1) && message.contains("--resume"), "{message}");
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
    let mut child = Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .args(["optimize", "--runs", "100000", "--record", path])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    wait_for_lines(&mut child, &record, 3);
    let asked = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(asked.expect("kill").success());
    let output = child.wait_with_output().expect("it ended");
    let (text, said) =
        (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert_eq!(output.status.code(), Some(4), "{said}");
    assert!(text.contains("Stopped before the end") && text.contains("What decides"), "{text}");
    assert!(said.contains("stopped early") && said.contains("--resume"), "{said}");
}

#[test]
fn a_budget_of_time_hands_back_what_is_done() {
    let output = run(&["optimize", "--runs", "100000", "--budget", "0.5s"]);
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
    assert_eq!(question.genetic, GeneticOptions::default());
    let found = study(question.clone());
    let (best, papers) =
        (&found.best().expect("a design").design, found.default_design.as_ref().expect("Table 5"));
    let mut rows = Vec::new();
    for objective in [
        Objective::RestTime,
        Objective::DimensionlessRestTime,
        Objective::PeakForce,
        Objective::PeakPressure,
    ] {
        let [one, other] =
            [best, papers].map(|design| decimal(objective.value(design).expect("a value")));
        rows.push(format!("| {}, {} | {one} | {other} |", objective.meaning(), objective.unit()));
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
        let apart =
            rival.spread().expect("values").median / found.spread().expect("values").median - 1.0;
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
        let text = format!(
            "{fixed}[genetic]\nobjective = {objective}\npopulation = 6\ngenerations = 2\nruns = 1\n"
        );
        let table = lindstedt::export::optimization::csv(&study(asked(&text)));
        let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
        let names: std::collections::BTreeSet<&str> = rows[1].iter().copied().collect();
        assert_eq!((names.len(), rows[1].len()), (columns, columns), "{table}");
        assert!(names.contains("mass"), "{table}");
        assert!(rows.iter().all(|row| row.len() == columns), "{table}");
    }
}

/// What is held fixed has a say: where every material has a damping of its own, that of the contact
/// has none.
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
        let printed =
            lindstedt::export::text::document(&lindstedt::report::optimization(&found), 120);
        assert_eq!(printed.contains("lambda"), held, "{printed}");
        let document = lindstedt::export::json::optimization(&found);
        let document = serde_json::to_value(document).expect("JSON");
        assert_eq!(document["asked"]["held_fixed"]["contact"].is_null(), !held, "{document}");
    }
}
