//! Equation (6) beside Coulomb's law: the page is what is computed, and what is computed is so.

use std::process::Command;

use lindstedt::audit::paper::{FrictionTable, SPEEDS};
use lindstedt::export::{friction, text};
use lindstedt::impact::friction::{DEFAULT_ALPHA, FrictionSetup, FrictionStudy, study, work_share};
use lindstedt::impact::{Friction, Integrator, Model, Settings, Start, simulate};
use lindstedt::report;

fn with(alpha: f64) -> FrictionStudy {
    let setup = FrictionSetup { alpha, ..FrictionSetup::default() };
    study(setup).expect("a study")
}

/// Every block of numbers in `docs/friction.md` is a section of what the program prints, and none
/// is left out but the question.
#[test]
fn the_page_says_what_is_computed() {
    let page = include_str!("../../docs/friction.md");
    let printed = text::document(&report::friction(&with(DEFAULT_ALPHA)), usize::MAX);
    let sections: Vec<&str> = printed.trim_end().split("\n\n").skip(1).collect();
    assert_eq!(sections.len(), 6);
    for section in sections {
        assert!(page.contains(&format!("```text\n{section}\n```")), "{section}");
    }
}

#[test]
fn one_pi_makes_every_printed_digit() {
    let table = FrictionTable::from_study(&with(DEFAULT_ALPHA));
    let best = table.best();
    let found = (best.name, best.rounded, best.either, table.entries());
    assert_eq!(found, ("3.14", 21, 22, 22));
    // The one that is not rounded; its mirror image is.
    let cut: Vec<&str> = table
        .rows
        .iter()
        .filter_map(|row| row.printed)
        .flatten()
        .filter(|entry| !entry.rounded)
        .map(|entry| entry.printed)
        .collect();
    assert_eq!(cut, ["+0.99413"]);
    // No other comes near: only the two zeros come out by themselves.
    assert!(table.readings.iter().all(|reading| reading.name == "3.14" || reading.either == 2));
    let [least, greatest] = table.pi_range.expect("a range");
    assert!(
        least < best.value && best.value < greatest && greatest - least < 1e-7,
        "{least} {greatest}"
    );
    for (row, (speed, _)) in table.rows.iter().zip(SPEEDS) {
        assert_eq!(row.laws.speed, speed);
        // What is missing is the arctangent of the reciprocal.
        let missing = if speed == 0.0 {
            0.0
        } else {
            (0.01 / speed.abs()).atan() * 2.0 / std::f64::consts::PI
        };
        assert!((row.laws.error - 100.0 * missing).abs() < 1e-12, "{row:?}");
    }
}

#[test]
fn coulomb_stops_and_the_arctangent_creeps_at_the_rate_of_its_linear_equation() {
    for alpha in [1e-3, 0.01, 0.03, 0.032, DEFAULT_ALPHA, 0.2, 0.7] {
        let near_rest = with(alpha).near_rest;
        let (stop, creep) = (near_rest.stop, near_rest.creep);
        assert!(stop.x.sin().abs() <= alpha && stop.t > 0.0, "{alpha}: {stop:?}");
        // Another integrator stops it there too.
        let model = Model { alpha, right: None, ..Model::default() };
        let settings = Settings { duration: stop.t + 20.0, ..Settings::default() };
        let judged = simulate(&model, Start::default(), Integrator::RungeKutta, &settings)
            .expect("a motion");
        assert!((judged.end_x - stop.x).abs() < 1e-7 && judged.end_velocity == 0.0, "{alpha}");
        let last = judged.turns.iter().find(|turn| (turn.x - judged.end_x).abs() < 1e-12);
        assert!(
            last.is_some_and(|turn| (turn.t - stop.t).abs() < 1e-4),
            "{alpha}: {last:?} {stop:?}"
        );
        // The roots of s^2 - c s + 1, or half of c.
        let c = 200.0 * alpha / std::f64::consts::PI;
        assert!((creep.damping - c).abs() < 1e-12 && creep.creeps == (c > 2.0));
        let rate = creep.rate.expect("a rate");
        assert!(
            (rate / creep.rate_linear - 1.0).abs() < 1e-4,
            "{alpha}: {rate} {}",
            creep.rate_linear
        );
        let residual = match creep.creeps {
            true => creep.rate_linear * (creep.rate_linear - c) + 1.0,
            false => creep.rate_linear - 0.5 * c,
        };
        assert!(residual.abs() < 1e-12, "{alpha}");
        // It leaves the place where it should be held, for good.
        let last = creep.samples.last().expect("a sample");
        assert!(last.x.abs() < 0.01 * stop.x.abs(), "{alpha}: {last:?}");
    }
}

/// With much damping inertia does not count, and the formula is the motion, also where sin x is far
/// from x and |x| above alpha.
#[test]
fn a_strong_creep_is_its_formula() {
    for alpha in [0.8, 0.9, 0.95] {
        let near_rest = with(alpha).near_rest;
        let creep = &near_rest.creep;
        let model =
            Model { alpha, friction: Friction::Arctangent, right: None, ..Model::default() };
        let start = Start { x: near_rest.stop.x, velocity: 0.0 };
        let settings = Settings { duration: creep.motion.end_time, ..Settings::default() };
        let judged = simulate(&model, start, Integrator::RungeKutta, &settings).expect("a motion");
        for sample in &creep.samples {
            let (x, _) = judged.path.phase_point_at(sample.t).expect("a state");
            let formula = sample.formula.expect("a creep");
            // The rate of the linear equation is 1/c^2 above that without inertia, eight times 3e-4
            // at the end.
            assert!((formula / x - 1.0).abs() < 4e-3, "{alpha}: {formula} {x}");
            assert_eq!(creep.formula(sample.t), sample.formula);
        }
        let first = creep.samples[0].formula.expect("a creep");
        assert!((first - near_rest.stop.x).abs() < 1e-12, "{alpha}: {first}");
    }
    assert_eq!(with(0.02).near_rest.creep.formula(1.0), None);
}

/// Where Coulomb's law holds the pendulum above a tenth of the first swing, the arctangent still
/// comes to rest: as another integrator says.
#[test]
fn a_strong_friction_has_a_rest_time_by_the_arctangent() {
    for alpha in [0.8, 0.9, 0.95] {
        let times = with(alpha).near_rest.rest_times;
        assert!(times.coulomb.is_err() && times.difference().is_none(), "{alpha}: {times:?}");
        let model = Model { alpha, friction: Friction::Arctangent, ..Model::default() };
        let settings = Settings { duration: 200.0, ..Settings::default() };
        let judged = simulate(&model, Start::default(), Integrator::RungeKutta, &settings)
            .expect("a motion");
        let (found, truth) =
            (times.arctangent.expect("a rest"), judged.rest().time.expect("a rest"));
        assert!((found / truth - 1.0).abs() < 1e-6, "{alpha}: {found} {truth}");
    }
}

/// The work of friction in the first cycle is what the energy loses, and nearly that of a harmonic
/// swing.
#[test]
fn the_missing_work_is_that_of_the_books() {
    let alpha = 0.01;
    let cycle = with(alpha).near_rest.first_cycle;
    let model = Model { alpha, friction: Friction::Arctangent, right: None, ..Model::default() };
    let settings = Settings { duration: cycle.until, ..Settings::default() };
    let motion =
        simulate(&model, Start::default(), Integrator::Taylor, &settings).expect("a motion");
    let turns: Vec<f64> = motion.turns.iter().map(|turn| turn.x).collect();
    let way = (turns[1] + 1.5) + (turns[1] - motion.end_x);
    assert!((-motion.energy().friction / (alpha * way) - cycle.work_share).abs() < 1e-6);
    assert!((cycle.work_share - cycle.work_share_formula).abs() < 1e-3);
    assert!((cycle.largest_error - 1.0).abs() < 1e-6);
    assert!(cycle.over_ten_percent < cycle.over_one_percent && cycle.over_one_percent < 1.0);
    // Small swings are harmonic: from a release at 0.2 to within the loss of a cycle.
    let small = study(FrictionSetup { alpha: 1e-4, amplitude: 0.2, ..FrictionSetup::default() });
    let small = small.expect("a study").near_rest.first_cycle;
    assert!((small.work_share / work_share(0.2) - 1.0).abs() < 1e-3, "{small:?}");
}

#[test]
fn wrong_numbers_get_their_message() {
    for (arguments, code, words) in [
        (&["--alpha", "0"][..], 1, "above 0 and below 1"),
        (&["--alpha", "1"], 1, "above 0 and below 1"),
        (&["--alpha", "nan"], 1, "above 0 and below 1"),
        (&["--alpha", "-0.1"], 1, "above 0 and below 1"),
        (&["--alpha", "1e-12"], 1, "more steps"),
        (&["--amplitude", "0"], 1, "below pi"),
        (&["--amplitude", "3.2"], 1, "below pi"),
        (&["--amplitude", "inf"], 1, "below pi"),
        (&["--amplitude", "0.04"], 1, "holds the pendulum where it is released"),
        (&["--amplitude", "3.13"], 1, "holds the pendulum where it is released"),
        (&["--speed", "inf"], 1, "finite number"),
        (&["--speed", "x"], 2, "--speed"),
        (&["--tolerance", "0.1"], 2, "no verdict"),
        (&["file.toml"], 2, "file.toml"),
    ] {
        let output = Command::new(env!("CARGO_BIN_EXE_lindstedt"))
            .arg("friction")
            .args(arguments)
            .output()
            .expect("the program starts");
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {message}");
        assert!(message.contains(words) && output.stdout.is_empty(), "{arguments:?}: {message}");
    }
}

#[test]
fn the_table_has_a_row_for_every_speed() {
    let setup = FrictionSetup { speeds: vec![0.01, -1e300, 0.0], ..FrictionSetup::default() };
    let table = friction::csv(&study(setup).expect("a study"));
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines.len(), 2 + 11 + 3);
    assert_eq!(lines[1], "speed,sign,arctangent,error,printed_value,printed_error");
    assert!(lines[2].ends_with(",-0.99923,0.07667"), "{}", lines[2]);
    assert_eq!(lines[13], "0.01,1,0.5,50,,");
    assert_eq!(lines[15], "0,0,0,0,,");
}

#[cfg(feature = "plot")]
#[test]
fn a_picture_is_drawn_of_creep_and_of_swing() {
    for (alpha, formula) in [(DEFAULT_ALPHA, true), (0.02, false)] {
        let picture = friction::picture(&with(alpha)).expect("a picture");
        for words in ["Friction near zero speed", "Coming to rest", "From rest where sgn holds it"]
        {
            assert!(picture.contains(words), "{words}");
        }
        assert_eq!(picture.contains("creep by formula"), formula);
    }
}
