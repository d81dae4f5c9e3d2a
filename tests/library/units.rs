//! An impact in SI units: against a motion that is followed in seconds and metres, and what is said
//! of bodies and of the paper.

use std::process::Command;

use lindstedt::audit::paper;
use lindstedt::impact::{Parameter, PhaseReading, Setup, SiImpact, solve};
use lindstedt::numeric::ode::{Event, IntegrationOptions, State, integrate};
use lindstedt::problem::Problem;
use serde_json::Value;

fn si(text: &str) -> Option<SiImpact> {
    let file: Problem = text.parse().expect("a file");
    solve(Setup::try_from(&file).expect("an impact")).expect("a motion").si()
}

/// A pendulum, its length and gravity, and the stiffness of its contact, in SI units.
struct Pendulum {
    mass: f64,
    length: f64,
    gravity: f64,
    stiffness: f64,
}

/// Time to contact, speed, penetration, duration, period and peak force, each in SI units, of the
/// paper's release and barrier.
fn followed(pendulum: &Pendulum) -> [f64; 6] {
    let &Pendulum { mass, length, gravity, stiffness } = pendulum;
    let barrier = 0.323;
    let (inertia, weight) = (mass * length * length, mass * gravity * length);
    let force = |x: f64| stiffness * (length * (x - barrier)).max(0.0).powf(1.5);
    let acceleration = |_: f64, x: f64, _: f64| -(weight * x.sin() + force(x) * length) / inertia;
    let options = IntegrationOptions::with_tolerance(1e-12);
    let from = |t, x, v| State { t, x, v };
    let seconds = (length / gravity).sqrt();
    let touch = Event::stop(|_, x, _| x - barrier);
    let approach =
        integrate(acceleration, from(0.0, -1.5, 0.0), 10.0 * seconds, &[touch], &options)
            .expect("a touch");
    let touch = approach.end();
    let events = [Event::record(|_, _, v| v), Event::stop(|_, x, _| x - barrier).falling()];
    let pressed = integrate(acceleration, from(0.0, barrier, touch.v), seconds, &events, &options)
        .expect("a release");
    let deepest = pressed.occurrences()[0].state.x;
    let duration = pressed.end().t;
    [
        touch.t,
        length * touch.v,
        length * (deepest - barrier),
        duration,
        2.0 * touch.t + duration,
        force(deepest),
    ]
}

#[test]
fn every_number_is_that_of_a_motion_followed_in_si_units() {
    let papers = Pendulum {
        mass: 0.0112,
        length: 0.0681,
        gravity: 9.81,
        stiffness: 4.0 / 3.0 * 1.439e9 * 0.0096_f64.sqrt(),
    };
    let equivalent = 1.0 / (0.91 / 2.1e11 + 0.84 / 3e9);
    let on_the_moon = Pendulum {
        mass: 0.5,
        length: 2.0,
        gravity: 1.62,
        stiffness: 4.0 / 3.0 * equivalent * 0.03_f64.sqrt(),
    };
    let bodies = "[pendulum]\nmass = 0.5\nlength = 2\ngravity = 1.62\n[sphere]\nradius = 0.03\nmodulus = 2.1e11\npoisson = \
                  0.3\n[barrier]\nmodulus = 3e9\npoisson = 0.4";
    let given = "[contact]\ngamma = 1e6\n[pendulum]\nmass = 0.5\nlength = 2\ngravity = 1.62";
    let by_gamma = Pendulum { stiffness: 1e6 * 0.5 * 1.62 / 2_f64.powf(1.5), ..on_the_moon };
    for (text, pendulum) in [("", &papers), (bodies, &on_the_moon), (given, &by_gamma)] {
        let found = si(text).expect("units");
        assert!((found.contact_stiffness / pendulum.stiffness - 1.0).abs() < 1e-13, "{text}");
        let quantities = [
            &found.time_to_contact,
            &found.speed,
            &found.penetration,
            &found.duration,
            &found.period,
            &found.peak_force,
        ];
        for (quantity, expected) in quantities.into_iter().zip(followed(pendulum)) {
            let error = quantity.runge_kutta / expected - 1.0;
            assert!(error.abs() < 1e-7, "{text}: {} is off by {error}", quantity.name);
        }
        let kinetic = pendulum.mass * found.speed.runge_kutta.powi(2) / 2.0;
        assert!((found.energy.runge_kutta / kinetic - 1.0).abs() < 1e-13);
    }
    // What the release lost in height is the energy at the touch.
    let fall = 0.0112 * 9.81 * 0.0681 * (0.323_f64.cos() - 1.5_f64.cos());
    assert!((si("").expect("units").energy.runge_kutta / fall - 1.0).abs() < 1e-9);
}

#[test]
fn units_are_those_of_the_pendulum_with_the_contact_of_hertz() {
    for text in [
        "[contact]\ngamma = 1e6",
        "[contact]\nforce = \"1e6*d^2\"",
        "[contact]\nforce = \"gamma*d^2\"",
        "equation = \"x'' + x + x^3 = 0\"\n[values]\nA = 1\nxc = 0.3\ngamma = 1e6",
    ] {
        assert_eq!(si(text), None, "{text}");
    }
    // Mass and length have a say in gamma, whatever the force is.
    let force = |mass| format!("[pendulum]\nmass = {mass}\n[contact]\nforce = \"gamma*d^2\"");
    assert_eq!(si(&force(0.02)), None);
    let stiffness = |text: &str| {
        let file: Problem = text.parse().expect("a file");
        Setup::try_from(&file).expect("an impact").stiffness
    };
    assert!((2.0 * stiffness(&force(0.04)) / stiffness(&force(0.02)) - 1.0).abs() < 1e-14);
    // Beside a gamma that is given the pressure needs the radius.
    let given = "[contact]\ngamma = 1e6\n[design]\nmass = 0.5\nlength = 2\ngravity = 1.62\n";
    assert_eq!(si(given).expect("units").peak_pressure, None);
    let found = si(&format!("{given}radius = 0.03")).expect("units");
    let [force, depth] =
        [&found.peak_force, &found.penetration].map(|quantity| quantity.runge_kutta);
    let pressure = found.peak_pressure.expect("a pressure").runge_kutta;
    assert!((pressure * std::f64::consts::PI * 0.03 * depth / force / 1.5 - 1.0).abs() < 1e-14);
    // Numbers beyond floating point are not handed on.
    assert_eq!(
        si("[contact]\ngamma = 1e6\n[design]\nmass = 1e-300\nlength = 1e-20\ngravity = 9"),
        None
    );
}

#[test]
fn a_stated_yield_limit_is_held_against_the_peak_pressure() {
    let pressure = si("").and_then(|si| si.peak_pressure).expect("a pressure").runge_kutta;
    for (part, exceeded) in [(0.99, true), (1.01, false)] {
        let text = format!("[barrier]\nyield = {}", part * pressure / 1.6);
        let checks = si(&text).expect("units").yield_checks();
        let [check] = &checks[..] else { panic!("{checks:?}") };
        assert_eq!((check.body, check.is_exceeded()), ("barrier", exceeded));
    }
    assert!(si("").expect("units").yield_checks().is_empty());
    let both = si("[barrier]\nyield = 1e7\n[sphere]\nyield = 1e12").expect("units").yield_checks();
    assert_eq!(both.iter().map(|check| check.is_exceeded()).collect::<Vec<_>>(), [false, true]);
}

#[test]
fn the_printed_contact_time_is_not_that_of_any_reading() {
    let found = si("").expect("units");
    let ratios = paper::over_contact_time(&found);
    assert_eq!(ratios.closed_forms.len(), 3);
    for ratio in ratios.closed_forms.iter().chain([&ratios.runge_kutta]) {
        assert!((2700.0..2900.0).contains(ratio) && !paper::is_reproduced(*ratio, 0.1));
    }
    // Read as seconds with the lengths of Table 5 the printed time needs this gamma.
    let file: Problem =
        "[contact]\ngamma = 1.24e16\n[design]\nmass = 0.0112\nlength = 0.0681\ngravity = 9.81"
            .parse()
            .expect("a file");
    let stiff = solve(Setup::try_from(&file).expect("an impact")).expect("a motion");
    let index = stiff
        .columns
        .iter()
        .position(|column| column.reading == PhaseReading::Paper)
        .expect("the paper's");
    let ratios = paper::over_contact_time(&stiff.si().expect("units"));
    assert!((ratios.runge_kutta - 1.0).abs() < 0.05, "{ratios:?}");
    assert!((ratios.closed_forms[index] - 1.0).abs() < 0.1, "{ratios:?}");
    assert_eq!(lindstedt::export::decimal(paper::CONTACT_TIME), "9.258e-8");
}

#[test]
fn text_and_documents_say_so() {
    let program = |arguments: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_lindstedt"))
            .args(arguments)
            .output()
            .expect("the program starts");
        assert!(output.status.success());
        let text = String::from_utf8(output.stdout).expect("text");
        // A sentence may be broken over two lines anywhere.
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let text = program(&["impact"]);
    assert!(
        text.contains("9.258e-8 s") && text.contains("not reproduced by any of them"),
        "{text}"
    );
    assert!(!text.contains("yield"));
    let example = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/impact-units.toml");
    let text = program(&["impact", example]);
    assert!(
        text.contains("warning: the barrier yields") && text.contains("outside its range"),
        "{text}"
    );
    let document: Value =
        serde_json::from_str(&program(&["impact", example, "--format", "json"])).expect("JSON");
    let limits = document["si"]["yield_limits"].as_array().expect("a list");
    let exceeded = |body: &str| {
        limits.iter().find(|limit| limit["body"] == body).map(|limit| limit["exceeded"].clone())
    };
    assert_eq!(exceeded("barrier"), Some(true.into()));
    assert_eq!(document["si"]["printed_contact_time"]["paper"]["verdict"], "not-reproduced");
    let compared = Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .args(["impact", example, "--compare"])
        .output()
        .expect("the program starts");
    let words = String::from_utf8_lossy(&compared.stderr);
    assert!(compared.status.code() == Some(2) && words.contains("`yield`"), "{words}");
    let gamma = program(&["impact", "--at", "gamma=1e6", "--format", "json"]);
    let document: Value = serde_json::from_str(&gamma).expect("JSON");
    assert!(document["si"].is_null());
}

/// The peak force of a contact that loses energy is the greatest over time, the damping in it, as
/// in a study of materials: against samples of the other integrator, and near the law without the
/// force of the swing.
#[test]
fn the_peak_force_of_a_damped_contact_is_the_greatest_one() {
    use lindstedt::impact::contact::HuntCrossley;
    use lindstedt::impact::{Integrator, Model, Settings, Setup, Start, simulate, solve};
    use lindstedt::problem::Problem;

    let file = "[pendulum]\namplitude = 1.5\nbarrier = 0.323\nmass = 0.02\nlength = 0.25\n[contact]\nrestitution = 0.5";
    let file: Problem = file.parse().expect("a problem");
    let impact = solve(Setup::try_from(&file).expect("a setup")).expect("an impact");
    let si = impact.si().expect("units");
    let gamma = impact.setup.stiffness;
    let model = Model { gamma, mu: impact.damping * gamma, right: Some(0.323), ..Model::default() };
    let settings = Settings { duration: 4.0, ..Settings::default() };
    let motion =
        simulate(&model, Start::default(), Integrator::Taylor, &settings).expect("a motion");
    let first = motion.impacts[0];
    let (from, to) = (first.entry_time, first.exit_time.expect("it leaves"));
    let force = |k: u32| {
        let (x, v) =
            motion.path.phase_point_at(from + (to - from) * f64::from(k) / 1e4).expect("a place");
        model.contact(x - 0.323, v)
    };
    let greatest = si.units.force() * (0..=10_000).map(force).fold(0.0, f64::max);
    let found = si.peak_force.runge_kutta;
    assert!((found / greatest - 1.0).abs() < 1e-5, "{found} {greatest}");
    let law =
        HuntCrossley::new(1.5, gamma, impact.damping, impact.energy_speed).expect("a contact");
    assert!((found / (si.units.force() * law.peak_force) - 1.0).abs() < 0.01);
    let told = si.peak_force.closed_forms.last().expect("a closed form");
    assert!((told / found - 1.0).abs() < 0.01, "{told} {found}");
}

/// The speed of a restitution is in m/s beside numbers in SI units, and otherwise in units of L
/// omega: that of the bob of a longer pendulum is the same, its angular velocity is not.
#[test]
fn a_stated_speed_has_the_unit_of_the_numbers_beside_it() {
    let mu_of = |text: &str| {
        let file: Problem =
            format!("[contact]\ngamma = 1e6\nrestitution = 0.8\n{text}").parse().expect("a file");
        let asked = file.simulate(&[]).expect("a motion");
        let (model, _) = asked.case.motion().expect("an equation");
        (model.mu, asked.case.dissipation(None).expect("forms").at_speed_in_words())
    };
    let unit = |length: f64, gravity: f64| (length * gravity).sqrt();
    let bare = |speed: f64| mu_of(&format!("at_speed = {speed}"));
    assert_eq!(bare(0.7).1.as_deref(), Some("0.7 rad*omega"));
    for (sections, length, gravity) in [
        ("[design]\nlength = 0.25", 0.25, 9.81),
        ("[pendulum]\nlength = 0.25\ngravity = 1.6", 0.25, 1.6),
        ("[pendulum]\nmass = 0.02", 0.0681, 9.81),
        ("[damping]\nviscous = 0.001", 0.0681, 9.81),
        ("[design]\nmodulus = 2e9", 0.0681, 9.81),
    ] {
        let (mu, words) = mu_of(&format!("at_speed = 0.7\n{sections}"));
        let expected = bare(0.7 / unit(length, gravity)).0;
        assert!((mu / expected - 1.0).abs() < 1e-12, "{sections}: {mu} and {expected}");
        let words = words.expect("a speed");
        assert!(words.starts_with("0.7 m/s, ") && words.ends_with(" rad*omega"), "{words}");
    }
    // The phases of one impact and the study of materials read it alike.
    let text = "[contact]\ngamma = 1e6\nrestitution = 0.8\nat_speed = 0.7\n[design]\nmass = 0.02\nlength = 0.25\ngravity = 9.81";
    let impact =
        solve(Setup::try_from(&text.parse::<Problem>().expect("a file")).expect("an impact"))
            .expect("a motion");
    let (mu, _) = mu_of("at_speed = 0.7\n[design]\nlength = 0.25");
    assert!((impact.damping / (mu / 1e6) - 1.0).abs() < 1e-12);
    let text = "[contact]\nrestitution = 0.8\nat_speed = 0.7\n[design]\nlength = 0.25";
    let study = text.parse::<Problem>().expect("a file").materials(false).expect("a study");
    let forms = study.case.dissipation(None).expect("forms");
    assert!((forms.mu_over_gamma / (mu / 1e6) - 1.0).abs() < 1e-12);
    // Where the length is swept the speed of the bob stays what it is.
    let file: Problem = "[contact]\nrestitution = 0.8\nat_speed = 0.7".parse().expect("a file");
    let mut case = file.simulate(&[Parameter::Length]).expect("a motion").case;
    let mut ratio = |length: f64| {
        case.set(Parameter::Length, length);
        case.dissipation(None).expect("forms").mu_over_gamma
    };
    assert!((ratio(1.0) / ratio(0.25) / 2.0 - 1.0).abs() < 1e-12);
}
