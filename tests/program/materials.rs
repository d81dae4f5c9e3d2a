//! Barriers of several materials: the contact against formulas written out here in SI units, the
//! rest time against Runge-Kutta, what is held fixed against what must follow from it, and the page
//! that tells it.

use std::f64::consts::PI;
use std::process::{Command, Output};

use lindstedt::export::decimal;
use lindstedt::export::{json, materials, text};
use lindstedt::impact::contact::HuntCrossley;
use lindstedt::impact::primary::simulate_primary;
use lindstedt::impact::{
    ContactDamping, Integrator, MaterialQuestion, MaterialRow, MaterialStudy, Model, Parameter,
    Settings, Start, course, simulate, study_materials,
};
use lindstedt::problem::Problem;
use lindstedt::report;

fn study(text: &str) -> MaterialStudy {
    let file: Problem = text.parse().expect("a file");
    study_materials(file.materials(false).expect("a study")).expect("motions")
}

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .args(arguments)
        .output()
        .expect("the program starts")
}

/// Depth and duration of a Hertz contact without loss, by its energy: dd/dt = sqrt(v^2 - (4 k/(5
/// m)) d^(5/2)), with d = D (1 - w^2).
fn hertz(mass: f64, stiffness: f64, speed: f64) -> [f64; 2] {
    let depth = (1.25 * mass * speed * speed / stiffness).powf(0.4);
    const POINTS: i32 = 20_000;
    let sum: f64 = (0..POINTS)
        .map(|point| {
            let w = (f64::from(point) + 0.5) / f64::from(POINTS);
            2.0 * w / (1.0 - (1.0 - w * w).powf(2.5)).sqrt()
        })
        .sum();
    [depth, 2.0 * depth / speed * sum / f64::from(POINTS)]
}

#[test]
fn the_first_contact_is_that_of_hertz_where_nothing_is_lost() {
    let of = |text: &str| study(&format!("[contact]\nmu = 0\n{text}"));
    for text in [
        "",
        "[design]\nmass = 0.5\nlength = 2\nradius = 0.03\ngravity = 1.62\nmodulus = 1e9\n[damping]\nzeta = 0.001",
    ] {
        let study = of(text);
        assert!(study.held_fixed.is_empty());
        for row in &study.rows {
            let first = row.first.expect("a contact");
            let design = &study.question.case.design;
            let stiffness = 4.0 / 3.0 * row.material.modulus.value() * design.radius.sqrt();
            let [depth, duration] = hertz(design.mass, stiffness, first.speed);
            // Gravity acts in the contact as well.
            let near = |found: f64, expected: f64| (found / expected - 1.0).abs() < 1e-3;
            assert!(near(first.penetration, depth), "{}: {depth}", row.material.name);
            assert!(near(first.duration, duration), "{}: {duration}", row.material.name);
            let force = stiffness * depth.powf(1.5);
            assert!(near(first.peak_force, force), "{}: {force}", row.material.name);
            let modulus = row.material.modulus.value();
            let pressure =
                (6.0 * force * modulus.powi(2) / (PI.powi(3) * design.radius.powi(2))).cbrt();
            assert!(near(first.peak_pressure, pressure), "{}: {pressure}", row.material.name);
        }
    }
}

#[test]
fn the_restitution_is_that_of_hunt_and_crossley() {
    let study =
        study("[contact]\nlambda = 0.4\n[[material]]\nname = \"Own\"\nmodulus = 1e9\nlambda = 1.5");
    for row in &study.rows {
        let first = row.first.expect("a contact");
        let lambda = row.dissipation.lambda.expect("units");
        assert_eq!(lambda, if row.material.name == "Own" { 1.5 } else { 0.4 });
        // lambda v (1 + e) = ln((1 + lambda v)/(1 - lambda e v)), e from above and below by its
        // sign: gravity and zeta act in the contact as well.
        let (x, e) = (lambda * first.speed, first.restitution);
        let missing = |e: f64| x * (1.0 + e) - (x.ln_1p() - (-x * e).ln_1p());
        assert!(missing(e - 1e-3) * missing(e + 1e-3) < 0.0, "{}: {e}", row.material.name);
        // The greatest force comes on the way in, before the greatest depth.
        let (speed, ratio) = (first.speed / study.units.speed(), row.dissipation.mu_over_gamma);
        let contact = HuntCrossley::new(1.5, row.gamma, ratio, speed).expect("a contact");
        let near = |found: f64, expected: f64| (found / expected - 1.0).abs() < 2e-3;
        assert!(near(first.peak_force, study.units.force() * contact.peak_force));
        assert!(near(first.duration, study.units.time() * contact.duration));
        assert!(near(first.penetration, study.units.length * contact.depth));
        let swing = row.course.energies[0];
        let barrier = 1.0 - 0.323_f64.cos();
        assert!((swing - barrier - 0.5 * (e * speed).powi(2)).abs() < 1e-12);
    }
}

#[test]
fn the_rest_time_is_that_of_runge_kutta() {
    let study = study("[damping]\nzeta = 0.03\nalpha = 0.002\n[contact]\nrestitution = 0.7");
    for row in &study.rows {
        let model = Model { gamma: row.gamma, mu: row.dissipation.mu, ..study.model };
        let settings = Settings { duration: 150.0, ..Settings::default() };
        let judge =
            simulate(&model, study.start, Integrator::RungeKutta, &settings).expect("a motion");
        let (rest, judged) =
            (row.course.rest_time.expect("rest"), judge.rest().time.expect("rest"));
        assert!((rest / judged - 1.0).abs() < 1e-7, "{rest} and {judged}");
        let before = judge.impacts.iter().filter(|impact| impact.entry_time < judged);
        assert_eq!(before.count(), row.course.impacts.len());
    }
}

#[test]
fn known_rest_times_are_found_again() {
    let rest = |gamma: f64, mu: f64| {
        let model = Model { zeta: 0.01, gamma, mu, ..Model::default() };
        let settings = Settings { duration: 400.0, ..Settings::default() };
        let found =
            course(&model, Start::default(), Integrator::Taylor, &settings).expect("a motion");
        found.rest_time.expect("rest")
    };
    for (gamma, mu, expected) in [
        (3e4, 1e4, 128.0),
        (3e7, 1e4, 199.0),
        (3e4, 3e3, 156.1),
        (1e6, 1e5, 155.3),
        (3e7, 3e6, 155.1),
    ] {
        let found = rest(gamma, mu);
        // Half a swing is what two ways to measure a rest may differ by.
        assert!((found - expected).abs() < PI, "{gamma} {mu}: {found}");
    }
}

#[test]
fn two_families_of_what_is_held_fixed() {
    let study = study(
        "[contact]\ndamping = 5e5\n[damping]\nviscous = 0.002\n[[material]]\nname = \"Cork\"\nmodulus = 2e7",
    );
    let held = |form: &str| {
        let found = study.held_fixed.iter().find(|held| held.damping.form().name() == form);
        found.expect("a form")
    };
    assert_eq!(study.held_fixed[0].damping, ContactDamping::Coefficient(5e5));
    assert_eq!(study.held_fixed.len(), 5);
    for (one, other) in [("mu", "damping"), ("lambda", "mu_over_gamma"), ("lambda", "restitution")]
    {
        for (one, other) in held(one).ratios.iter().zip(&held(other).ratios) {
            assert!((one / other - 1.0).abs() < 1e-10, "{one} and {other}");
        }
    }
    // mu/gamma is as 1/E where mu is fixed.
    let moduli = study.rows.iter().map(|row| row.material.modulus.value());
    let products: Vec<f64> =
        held("mu").ratios.iter().zip(moduli).map(|(ratio, modulus)| ratio * modulus).collect();
    assert!(products.iter().all(|product| (product / products[0] - 1.0).abs() < 1e-12));
    assert_eq!(study.order(held("mu")), Some(true));
    assert!(held("mu").spread() > held("lambda").spread());
}

#[test]
fn numbers_in_si_units_come_out_again() {
    let text = "[contact]\ndamping = 5e5\n[damping]\nviscous = 0.002\ntorque = 1e-5\n[pendulum]\nmass = 0.03\nlength = 0.2";
    let document = json::materials(&study(text));
    let near = |found: Option<f64>, expected: f64| {
        found.is_some_and(|found| (found / expected - 1.0).abs() < 1e-12)
    };
    for damping in std::iter::once(&document.dissipation)
        .chain(document.materials.iter().map(|row| &row.dissipation))
    {
        assert!(near(damping.contact.damping, 5e5), "{damping:?}");
        assert!(near(damping.viscous.viscous, 0.002) && near(damping.friction.torque, 1e-5));
        let lambda = damping.contact.lambda.expect("units");
        assert!(near(Some(lambda * (9.81_f64 * 0.2).sqrt()), damping.contact.mu_over_gamma));
    }
    // The coefficient over the stiffness is lambda: F = k (1 + lambda d') d^(3/2).
    for row in &document.materials {
        let stiffness = 4.0 / 3.0 * row.modulus * 0.0096_f64.sqrt();
        assert!(near(row.dissipation.contact.lambda, 5e5 / stiffness), "{}", row.name);
    }
}

/// Where the clock has no digits left for a contact, it is that of the closed form, and nothing is
/// infinite.
#[test]
fn a_barrier_beyond_all_hardness_is_a_barrier_still() {
    for modulus in ["1e20", "1e60", "1e300", "1e-3"] {
        let study = study(&format!("[[material]]\nname = \"Strange\"\nmodulus = {modulus}"));
        let row = study.rows.last().expect("a row");
        let Some(first) = row.first else { continue };
        let numbers = [first.duration, first.penetration, first.peak_force, first.peak_pressure];
        assert!(numbers.iter().all(|number| *number > 0.0), "{modulus}: {first:?}");
        let said = text::document(&report::materials(&study), 120);
        assert!(!said.contains(" inf") && !said.contains("NaN"), "{said}");
    }
}

#[test]
fn a_barrier_out_of_reach_has_no_say() {
    let study = study("[pendulum]\nbarrier = 1.6");
    assert!(study.held_fixed.is_empty() && study.rows.iter().all(|row| row.first.is_none()));
    let none = study.no_barrier.expect("rest");
    for row in &study.rows {
        // Measured on one side of the swing instead of both.
        let rest = row.course.rest_time.expect("rest");
        assert!((rest / none - 1.0).abs() < 1e-4, "{rest} and {none}");
    }
    let said = text::document(&report::materials(&study), 120);
    assert!(
        said.contains("no barrier is touched") && !said.contains("with these barriers"),
        "{said}"
    );
}

/// The tables of the page are computed here.
#[test]
fn the_page_prints_what_is_found() {
    let page = include_str!("../../docs/materials.md");
    let study = study_materials(MaterialQuestion::default()).expect("a study");
    let contact = |row: &MaterialRow| {
        let first = row.first.expect("a contact");
        let numbers = [
            row.material.modulus.value(),
            row.gamma,
            first.duration,
            first.penetration,
            first.peak_force,
            first.peak_pressure,
            first.restitution,
        ];
        format!("| {} | {} |", row.material.name, numbers.map(decimal).join(" | "))
    };
    let held = study.held_fixed.iter().map(|held| {
        let [first, last] =
            held.extremes().expect("rest").map(|row| held.rest_times[row].expect("rest"));
        let form = held.damping.form();
        let words = format!("{} = {} {}", form.name(), decimal(held.damping.value()), form.unit());
        let apart = lindstedt::export::significant(100.0 * (last / first - 1.0), 3);
        format!("| {} | {} | {} | {apart} % |", words.trim_end(), decimal(first), decimal(last))
    });
    for row in study.rows.iter().map(contact).chain(held) {
        assert!(page.contains(&row), "{row}");
    }
    let none = decimal(study.no_barrier.expect("rest"));
    let lossless = decimal(study.rows[0].lossless.expect("rest"));
    assert!(
        page.contains(&format!("rests at {none}; at a barrier without loss at {lossless} (steel)")),
        "{none} {lossless}"
    );
}

#[test]
fn a_study_of_nothing_is_refused() {
    let output = run(&["materials", "--only-own"]);
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1));
    assert!(output.stdout.is_empty() && message.contains("there is no material"), "{message}");
}

#[test]
fn a_table_has_a_row_for_each_material() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("own.toml");
    let text = "[[material]]\nname = \"Cork, \\\"fine\\\"\"\nmodulus = 2e7\n[run]\nduration = 3";
    std::fs::write(&file, text).expect("a file");
    let output = run(&["materials", file.to_str().expect("text"), "--only-own", "--format", "csv"]);
    let table = String::from_utf8(output.stdout).expect("text");
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines.len(), 3, "{table}");
    let columns = |line: &str| line.split(',').count();
    assert_eq!(columns(lines[0]), columns(lines[1]));
    // Its name has a comma; it does not rest in so short a run.
    assert!(lines[2].starts_with("\"Cork, \"\"fine\"\"\",20000000,"), "{table}");
    assert_eq!(columns(lines[2]), columns(lines[1]) + 1);
    assert!(lines[2].contains(",,,"), "{table}");
}

#[cfg(feature = "plot")]
#[test]
fn a_picture_shows_what_is_held_fixed() {
    let examples = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/materials");
    for (name, words) in [
        ("table-2", ["Swing, lambda held fixed", "Decay, mu held fixed"]),
        ("own-mu", ["Swing, mu held fixed", "Decay, mu_over_gamma held fixed"]),
        ("never-rests", ["Decay, mu_over_gamma held fixed", "no barrier"]),
    ] {
        let file = format!("{examples}/{name}.toml");
        let folder = tempfile::tempdir().expect("a folder");
        let result = folder.path().join("result.txt");
        let place = ["--output", result.to_str().expect("text")];
        let output = run(&[&["materials", &file, "--plot", "-"], &place[..]].concat());
        let picture = String::from_utf8_lossy(&output.stdout);
        assert!(words.iter().all(|words| picture.contains(words)), "{name}");
    }
}

#[test]
fn the_chain_tells_the_same_of_the_materials() {
    let study = |integrator| {
        let question = MaterialQuestion { integrator, ..MaterialQuestion::default() };
        study_materials(question).expect("a study")
    };
    let [chain, truth] = [Integrator::Chain, Integrator::Taylor].map(study);
    for (row, of_truth) in chain.rows.iter().zip(&truth.rows) {
        let [found, wanted] = [row, of_truth].map(|row| row.course.rest_time.expect("it rests"));
        assert!((found / wanted - 1.0).abs() < 1e-3, "{found} {wanted}");
        assert_eq!(row.course.impacts.len(), of_truth.course.impacts.len());
        let [first, of_truth] = [row, of_truth].map(|row| row.first.expect("a contact"));
        for (found, wanted) in [
            (first.speed, of_truth.speed),
            (first.duration, of_truth.duration),
            (first.penetration, of_truth.penetration),
            (first.peak_force, of_truth.peak_force),
            (first.restitution, of_truth.restitution),
        ] {
            assert!((found / wanted - 1.0).abs() < 5e-3, "{found} {wanted}");
        }
    }
}

/// A main mass with the barriers of its damper, which loses nothing in contact.
const CARRIED: &str = "[primary]\nmass = 0.3\nstiffness = 100\ndamping = 0.06\ndisplacement = 0.01\n[pendulum]\nbarrier = [-0.15, 0.15]\n";

/// A contact inside of a main mass is that of Hertz with the mass of the relative motion, m (R +
/// sin^2 x_c)/(R + 1).
#[test]
fn a_first_contact_beside_a_main_mass_has_the_mass_of_the_relative_motion() {
    let study = study(&format!("{CARRIED}[contact]\nmu = 0\n[damping]\nzeta = 0"));
    assert!(study.held_fixed.is_empty());
    let design = &study.question.case.design;
    let ratio = 0.3 / design.mass;
    let relative = design.mass * (ratio + 0.15_f64.sin().powi(2)) / (ratio + 1.0);
    for row in &study.rows {
        let first = row.first.expect("a contact");
        let stiffness = 4.0 / 3.0 * row.material.modulus.value() * design.radius.sqrt();
        let [depth, duration] = hertz(relative, stiffness, first.speed);
        let near = |found: f64, expected: f64| (found / expected - 1.0).abs() < 0.02;
        assert!(near(first.penetration, depth), "{}: {depth}", row.material.name);
        assert!(near(first.duration, duration), "{}: {duration}", row.material.name);
        assert!((first.restitution - 1.0).abs() < 0.01, "{}", row.material.name);
    }
    let steel = study.rows[0].first.expect("a contact");
    let [depth, _] = hertz(design.mass, 4.0 / 3.0 * 200e9 * design.radius.sqrt(), steel.speed);
    assert!((steel.penetration / depth - 1.0).abs() > 0.01, "the mass of the relative motion");
}

/// Each material is the motion of `simulate` with its modulus; by closed forms it is that of the
/// integration, and the same design rests as in a search.
#[test]
fn the_main_mass_rests_as_it_does_alone_in_a_file() {
    let text = format!("{CARRIED}[contact]\nmu_over_gamma = 0.3\n[damping]\nzeta = 0.01\n");
    let file: Problem = text.parse().expect("a file");
    let question = file.materials(false).expect("a study");
    let by_chain = MaterialQuestion { integrator: Integrator::Chain, ..question.clone() };
    let [study, chain] =
        [question, by_chain].map(|question| study_materials(question).expect("motions"));
    for (row, of_chain) in study.rows.iter().zip(&chain.rows) {
        let modulus = row.material.modulus.value();
        let alone: Problem =
            format!("{text}[design]\nmodulus = {modulus}").parse().expect("a file");
        let asked = alone.primary_case(&[]).expect("a case");
        let motion = simulate_primary(asked.case, &asked.settings).expect("a motion");
        let [truth, found] =
            [motion.rest_time(), row.course.rest_time].map(|rest| rest.expect("a rest"));
        assert!((found / truth - 1.0).abs() < 1e-9, "{found} {truth}");
        let of_chain = of_chain.course.rest_time.expect("a rest");
        assert!((of_chain / truth - 1.0).abs() < 0.01, "{of_chain} {truth}");
        // The energy after an impact is no more than before, and that of the start at most.
        let energies = &row.course.energies;
        assert_eq!(energies.len(), row.course.impacts.len());
        assert!(energies[0] < motion.energy.start);
        assert!(energies.windows(2).all(|pair| pair[1] < pair[0]), "{energies:?}");
    }
    // mu/gamma, lambda and a restitution hold fixed the same.
    let rest = |form: Parameter| {
        let held = study.held_fixed.iter().find(|held| held.damping.form() == form).expect("it");
        held.rest_times.iter().map(|rest| rest.expect("a rest")).collect::<Vec<_>>()
    };
    for form in [Parameter::Lambda, Parameter::Restitution] {
        for (one, other) in rest(Parameter::MuOverGamma).iter().zip(rest(form)) {
            assert!((one / other - 1.0).abs() < 1e-3, "{form:?} {one} {other}");
        }
    }
    let document = json::materials(&study);
    let main_mass = document.parameters.main_mass.expect("a main mass");
    assert_eq!((main_mass.mass, main_mass.stiffness), (0.3, 100.0));
    let page = text::document(&report::materials(&study), 120);
    for words in
        ["for the damper of one main mass", "when the main mass rests", "0.3 kg on 100 N/m"]
    {
        assert!(page.contains(words), "{words}: {page}");
    }
    let picture = materials::figure::materials(&chain).expect("a picture");
    assert!(picture.contains("Main mass, mu_over_gamma held fixed"));
}

/// By closed forms each row has the rest times of starts nearby, those of the files that have these
/// starts, and the study says whether they are near each other; by integration it does not.
#[test]
fn rest_times_by_closed_forms_say_how_far_those_of_starts_nearby_are() {
    let of = |displacement: f64, integrator: Integrator| {
        let text = CARRIED.replace("0.01", &displacement.to_string());
        let text = format!("{text}[contact]\nmu_over_gamma = 0.3\n[damping]\nzeta = 0.01\n");
        let file: Problem = text.parse().expect("a file");
        let question = file.materials(false).expect("a study");
        study_materials(MaterialQuestion { integrator, ..question }).expect("motions")
    };
    let [below, study, above] =
        [1.0 - 3e-4, 1.0, 1.0 + 3e-4].map(|part| of(0.01 * part, Integrator::Chain));
    let document = json::materials(&study);
    for (number, row) in document.materials.iter().enumerate() {
        let rests = [&below, &study, &above].map(|study| study.rows[number].course.rest_time);
        let rests = rests.map(|rest| rest.expect("a rest"));
        let wanted = [
            rests.into_iter().fold(f64::INFINITY, f64::min),
            rests.into_iter().fold(0.0, f64::max),
        ];
        let found = row.nearby_rest_times.expect("rests");
        assert!(
            found.iter().zip(wanted).all(|(found, wanted)| (found / wanted - 1.0).abs() < 1e-9)
        );
    }
    let last = |study: &MaterialStudy| report::material_sentences(study).pop().expect("a sentence");
    let words = last(&study);
    assert!(words.contains("within 0.5 % of each other"), "{words}");
    let integrated = of(0.01, Integrator::Taylor);
    assert!(integrated.rows.iter().all(|row| row.nearby.is_none()));
    assert!(!last(&integrated).contains("Starts 0.03 %"));
    // Rest times that are far apart are said, with their materials.
    let mut doubtful = study;
    doubtful.rows[1].nearby = Some([180.0, 190.0]);
    doubtful.rows[2].nearby = None;
    let words = last(&doubtful);
    let named = "For 2 of 3 materials, Aluminum alloy (6061-T6), Polyester elastomer, starts";
    assert!(words.contains(named), "{words}");
}

#[test]
fn a_main_mass_at_rest_or_driven_is_no_study() {
    let refused = |text: &str| {
        let file: Problem = text.parse().expect("a file");
        file.materials(false).expect_err("no study").to_string()
    };
    let still = refused("[primary]\nmass = 0.3\nstiffness = 100");
    assert!(still.contains("nothing moves"), "{still}");
    let driven = refused("[primary]\nmass = 0.3\nstiffness = 100\nforce = 1\nfrequency = 18");
    assert!(driven.contains("force"), "{driven}");
}
