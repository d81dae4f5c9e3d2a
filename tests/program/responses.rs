//! `lindstedt response` of coupled equations: where they come from, what is listed, and what is
//! refused.

use std::path::PathBuf;
use std::process::{Command, Output};

use serde_json::Value;

/// Two oscillators, of which one is driven; linear, so that the amplitudes are known.
const LINEAR: &str = "x'' + x'/5 + 2*x - y = cos(Omega*t); y'' + y'/5 + 2*y - x = 0";

const RANGE: [&str; 2] = ["--vary", "Omega=0.5:0.7"];

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .arg("response")
        .args(arguments)
        .output()
        .expect("the program starts")
}

fn printed(arguments: &[&str]) -> String {
    let output = run(arguments);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {message}");
    String::from_utf8(output.stdout).expect("text")
}

/// The printed text, without the ends of its lines.
fn words(arguments: &[&str]) -> String {
    printed(arguments).split_whitespace().collect::<Vec<_>>().join(" ")
}

fn document(arguments: &[&str]) -> Value {
    let text = printed(&[arguments, &["--format", "json"]].concat());
    serde_json::from_str(&text).expect("the output is JSON")
}

/// A file of this text.
fn file(name: &str, text: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("lindstedt-responses-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join(name);
    std::fs::write(&path, text).expect("a file");
    path
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// The first point of the first branch.
fn first(document: &Value) -> &Value {
    &document["branches"][0][0]
}

/// The amplitudes of x, y and x - y at the frequency 1/2: the sum and the difference of both
/// coordinates are oscillators of their own, of the stiffness 1 and 3.
fn amplitudes() -> [f64; 3] {
    // 1/(k - 1/4 + i/10) is the answer of an oscillator of the stiffness k to cos(t/2).
    let answer = |stiffness: f64| {
        let (real, imaginary) = (stiffness - 0.25, 0.1);
        let square: f64 = real * real + imaginary * imaginary;
        [real / square, -imaginary / square]
    };
    let ([sum, sum_lag], [difference, difference_lag]) = (answer(1.0), answer(3.0));
    let half = |sign: f64| {
        (0.5 * (sum + sign * difference)).hypot(0.5 * (sum_lag + sign * difference_lag))
    };
    [half(1.0), half(-1.0), difference.hypot(difference_lag)]
}

#[test]
fn coupled_equations_come_from_a_text_a_list_and_a_mechanism() {
    let [x, y, _] = amplitudes();
    let text = document(&[&[LINEAR], &RANGE[..]].concat());
    let list = file(
        "list.toml",
        "equation = [\"x'' + c*x' + 2*x - y = cos(Omega*t)\", \"y'' + c*y' + 2*y - x = 0\"]\nvary = \"Omega=0.5:0.7\"\n[values]\nc = 0.2\n",
    );
    let mechanism = file(
        "mechanism.toml",
        "vary = \"Omega=0.5:0.7\"\n[lagrangian]\ncoordinates = [\"x\", \"y\"]\nkinetic = \"m*(x'^2 + y'^2)/2\"\npotential = \"k*(x^2 + y^2 + (x - y)^2)/2\"\n\
         dissipation = \"(x'^2 + y'^2)/10\"\nforces = { x = \"cos(Omega*t)\" }\n[values]\nk = 1\nm = 1\n",
    );
    let of_list = document(&[list.to_str().expect("a path")]);
    let of_mechanism = document(&[mechanism.to_str().expect("a path")]);
    for found in [&text, &of_list, &of_mechanism] {
        assert_eq!(found["coordinates"], serde_json::json!(["x", "y"]));
        assert_eq!((&found["method"], &found["of"]), (&"shooting".into(), &"x".into()));
        assert_eq!(found["verification"]["verdict"], "pass");
        let point = first(found);
        assert!((number(&point["amplitudes"]["x"]) - x).abs() < 1e-6 * x, "{point}");
        assert!((number(&point["amplitudes"]["y"]) - y).abs() < 1e-6 * y, "{point}");
        assert_eq!(point["amplitude"], point["amplitudes"]["x"]);
        assert_eq!(point["state"].as_array().map(Vec::len), Some(4));
    }
}

#[test]
fn the_quantity_that_is_listed_may_be_an_expression() {
    let [_, _, difference] = amplitudes();
    let arguments = [&[LINEAR, "--of", "x - y"], &RANGE[..]].concat();
    let found = document(&arguments);
    let amplitude = number(&first(&found)["amplitude"]);
    assert!((amplitude - difference).abs() < 1e-6 * difference, "{amplitude}");
    let text = words(&arguments);
    for words in ["half of peak to peak of x - y", "amplitude x", "amplitude y", "shooting"] {
        assert!(text.contains(words), "{words}: {text}");
    }
    let table = printed(&[&arguments[..], &["--format", "csv"]].concat());
    let head = table.lines().nth(1).expect("a head");
    assert!(head.ends_with(",error,amplitude_x,amplitude_y"), "{head}");
    let columns = |line: &str| line.split(',').count();
    assert!(table.lines().skip(1).all(|line| columns(line) == columns(head)), "{table}");
    // Of one coordinate it is the coordinate or nothing.
    let one = ["x'' + x'/5 + x = cos(Omega*t)", "--vary", "Omega=0.5:0.7"];
    assert_eq!(printed(&one), printed(&[&one[..], &["--of", "x"]].concat()));
}

#[test]
fn what_nothing_drives_has_equilibria_cycles_and_modes() {
    let cycles = words(&["v' = v - v^3/3 - w + I; w' = (v + 0.7 - 0.8*w)/5", "--vary", "I=0:0.6"]);
    for words in ["equilibria", "value: of v", "Hopf", "omega is an unknown of each motion"] {
        assert!(cycles.contains(words), "{words}: {cycles}");
    }
    let modes =
        words(&["x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0", "--vary", "omega=0.98:1.1"]);
    assert!(modes.contains("nonlinear normal modes") && !modes.contains("cycle"), "{modes}");
}

#[test]
fn what_cannot_be_answered_says_why() {
    let vary = ["--vary", "Omega=0.5:0.7"];
    let singular = "x'' + y'' + x = cos(Omega*t); 2*x'' + 2*y'' + y = 0";
    for (arguments, code, words) in [
        (vec!["x'' + x - y = cos(Omega*t); y - x^2 = 0"], 1, "2 equations for 1 coordinate: `x`"),
        (vec!["x'' + x - y = cos(Omega*t); y - x^2 = 0"], 1, "is a constraint: solve it"),
        (vec!["x'' + y'' + x = 0;"], 1, "1 equation for 2 coordinates"),
        (vec![singular], 1, "do not determine `x''`, `y''`"),
        (vec!["x + y = 0; y = 1"], 1, "no coordinate moves"),
        (
            vec!["x'' + x'/5 + x - y = cos(Omega*t); y'' + y'/5 + y = cos(pi*Omega*t)"],
            1,
            "no whole multiples of one frequency",
        ),
        (vec![LINEAR, "--of", "z"], 1, "the coordinates are `x`, `y`"),
        (vec![LINEAR, "--method", "averaging"], 2, "those of --method multiple-scales"),
        (vec![LINEAR, "--along", "k=1:2"], 2, "there is no parameter k"),
        (vec![LINEAR, "--along", "Omega=1:2"], 2, "Omega varies already"),
        (vec!["x'' + x'/5 + x = cos(Omega*t)", "--of", "x - y"], 2, "the coordinate x alone"),
        (
            vec!["x'' + sgn(x')*sgn(y') + x = cos(Omega*t); y'' + sgn(y') + y - x = 0"],
            1,
            "(2/pi)*atan(100*x')",
        ),
        (
            vec!["x'' + 2*x - y + Omega*x^3 = 0; y'' + 2*y - x = 0"],
            1,
            "--vary omega=FROM:TO gives the nonlinear normal modes",
        ),
    ] {
        let output = run(&[&arguments[..], &vary].concat());
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(message.contains(words), "{arguments:?}: {message}");
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {message}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
    }
    let free = run(&["x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0"]);
    let message = String::from_utf8_lossy(&free.stderr);
    assert!(message.contains("--vary omega=FROM:TO"), "{message}");
}

#[test]
fn two_equations_are_drawn_with_all_that_is_drawn_of_one() {
    let arguments = [&[LINEAR, "--of", "x - y", "--format", "svg"], &RANGE[..]].concat();
    let picture = printed(&arguments);
    assert!(picture.contains("<svg") && picture.contains("of x - y"), "{picture}");
}

/// Curves of bifurcations, numbers of stable motions and criticality are told in every form.
#[test]
fn two_parameters_have_their_tables_and_their_panel() {
    use lindstedt::response::bifurcation::BifurcationKind;
    use lindstedt::response::{
        Bifurcation, BifurcationCurve, BifurcationCurvePoint, Criticality, ResponseRequest,
        StableMotions, respond,
    };

    let equations = "x'' + x'/5 + 2*x - y = F*cos(Omega*t); y'' + y'/5 + 2*y - x = 0";
    let mut question =
        ResponseRequest::new(equations, "Omega", [0.5, 0.7], "F = 1/5").expect("a question");
    question.along = Some(("F".into(), [0.1, 0.5]));
    let mut response = respond(&question).expect("branches");
    let point = |index: usize| BifurcationCurvePoint {
        parameter: 0.5 + 0.01 * index as f64,
        along: 0.1 + 0.02 * index as f64,
        peak: 0.25,
    };
    response.curves = vec![BifurcationCurve {
        kind: BifurcationKind::NeimarkSacker,
        points: (0..20).map(point).collect(),
    }];
    response.stable_motions = Some(StableMotions {
        parameters: (0..30).map(|index| 0.5 + 0.2 * f64::from(index) / 29.0).collect(),
        along: vec![0.1, 0.3, 0.5],
        counts: vec![vec![1; 30], vec![2; 30], vec![0; 30]],
    });
    response.bifurcations = vec![Bifurcation {
        kind: BifurcationKind::NeimarkSacker,
        branch: 0,
        parameter: 0.6,
        frequency: 0.6,
        amplitude: 0.2,
        peak: 0.2,
        criticality: Some(Criticality::Subcritical),
    }];
    let document = lindstedt::report::response(&response);
    let text = lindstedt::export::text::document(&document, 120);
    for words in [
        "Neimark-Sacker, subcritical",
        "bifurcations in two parameters, Omega and F",
        "Curve 1: Neimark-Sacker, 20 points.",
        "Number of stable motions; F down, Omega across:",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
    let table = lindstedt::export::response::csv(&response);
    let columns = |line: &str| line.split(',').count();
    let head = table.lines().nth(1).expect("a head");
    assert!(head.ends_with(",amplitude_x,amplitude_y,F"), "{head}");
    assert!(table.lines().skip(1).all(|line| columns(line) == columns(head)), "{table}");
    assert_eq!(
        table.lines().filter(|line| line.starts_with("curve-neimark-sacker,1,")).count(),
        20
    );
    let json = lindstedt::export::json::response(&response);
    assert_eq!((json.along.as_deref(), json.curves_of_bifurcations.len()), (Some("F"), 1));
    #[cfg(feature = "plot")]
    {
        let picture = lindstedt::export::response::picture(&response).expect("a picture");
        for words in ["Bifurcations in two parameters", "2 stable motions", "no stable motion"] {
            assert!(picture.contains(words), "{words}");
        }
    }
}
