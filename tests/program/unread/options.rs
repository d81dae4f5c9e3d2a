//! The options of the command line.

use crate::NO_TIME;

use super::{path, run};

/// The long options that the help of a command lists.
fn options_of(command: &str) -> Vec<String> {
    let help = run(&[command, "--help"]).1;
    let lines = help.lines().map(str::trim);
    let names = lines.filter_map(|line| {
        let at = line.strip_prefix("-h, ").unwrap_or(line).strip_prefix("--")?;
        at.split([' ', '=']).next().map(str::to_owned)
    });
    names.filter(|name| name != "help").collect()
}

/// A file of claims.
const AUDIT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/audit/frequencies.toml");

#[test]
fn every_option_changes_the_answer_or_is_refused_by_name() {
    let cubic = "x'' + x + eps*x^3 + eps*x^5 = 0";
    let well = "x'' - x + x^3 = 0";
    let pair = "x'' + 2*x - y + x^3/2 = 0; y'' + 2*y - x = 0";
    let cycles = "x'' + x - eps*(1 - x^2 + x^4/20)*x' = 0";
    let file = path("output").with_extension("txt");
    let file = file.to_str().expect("a path in text");
    let simulated = ["simulate"];
    let swept =
        ["simulate", "--format", "csv", "--sweep", "zeta=0.1:0.2:2", "--sweep", "alpha=0.1:0.2:2"];
    let own = ["simulate", "x'' + k*x = 0", "--from", "x=1", "--at", "k=1"];
    let slides = ["x'' + k*x + sgn(x')/10 = 0", "--from", "x=1.15", "--at", "k=1"];
    let hill =
        ["stability", "x'' + (delta + eps*cos(Omega*t))*x = 0", "--at", "eps=1", "--at", "Omega=2"];
    let driven = [
        "response",
        "x'' + x'/5 + x + x^3 - F*cos(Omega*t) = 0",
        "--vary",
        "Omega=0.5:1.5",
        "--at",
        "F=0.2",
    ];
    let laws = ["shortest", "pendulum", "--range", "A=0:2.8", "--longest", "5"];
    let swing = path("decay").with_extension("csv");
    let rows = (0..300).map(|row| f64::from(row) / 5.0);
    let value = |t: f64| 0.1 + (-t / 50.0).exp() * (2.0 * t).cos() + 3e-3 * (1e4 * t * t).sin();
    let rows = rows.map(|t| format!("{t},{},{}\n", value(t), 0.5 * value(t)));
    std::fs::write(&swing, "t,x,y\n".to_owned() + &rows.collect::<String>()).expect("a file");
    let swing = swing.to_str().expect("a path in text");
    let fitted = [swing, "x'' + c*x' + k*x = 0"];
    const IMPACTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/fit/impacts.csv");
    let well_laws = [well, "--range", "A=0:1/4", "--longest", "3"];
    let backbone = [pair, "--mode", "1", "--range", "a=0:1", "--longest", "5"];
    let long = ["simulate", "--sweep", "zeta=0:0.1:3000"];
    // Command, what stands beside the option, the option.
    let table: Vec<(&str, Vec<&str>, Vec<&str>)> = vec![
        ("derive", vec![cubic], vec!["--method", "energy-balance"]),
        ("derive", vec![cubic], vec!["--contact", "x < 1: hertz K=1"]),
        ("derive", vec![cubic], vec!["--order", "1"]),
        ("derive", vec![cubic], vec!["--amplitude", "first-harmonic"]),
        ("derive", vec![cubic], vec!["--small", "A"]),
        ("derive", vec![cubic, "--method", "energy-balance"], vec!["--small", "nu"]),
        ("derive", vec![well], vec!["--about", "x=1"]),
        ("derive", vec![cubic], vec!["--taylor", "5"]),
        ("derive", vec![cubic, "--method", "max-min"], vec!["--taylor", "5"]),
        ("derive", vec!["pendulum", "--method", "parameter-expansion"], vec!["--taylor", "5"]),
        ("derive", vec![cubic], vec!["--hbar", "-1/2"]),
        ("derive", vec!["forced-duffing"], vec!["--resonance", "1:3"]),
        ("derive", vec![cubic], vec!["--resonance", "1:3"]),
        ("derive", vec![cubic, "--method", "multiple-scales"], vec!["--resonance", "1:3"]),
        ("derive", vec!["pendulum"], vec!["--omega-only"]),
        ("derive", vec!["pendulum", "--steps"], vec!["--omega-only"]),
        ("derive", vec!["pendulum", "--method", "energy-balance"], vec!["--omega-only"]),
        ("derive", vec![cycles], vec!["--cycle", "2"]),
        ("derive", vec!["pendulum"], vec!["--cycle", "1"]),
        ("derive", vec![pair], vec!["--mode", "2"]),
        ("derive", vec!["pendulum"], vec!["--mode", "1"]),
        ("derive", vec!["pendulum", "--method", "energy-balance"], vec!["--cycle", "1"]),
        ("derive", vec!["pendulum", "--method", "exact"], vec!["--order", "3"]),
        ("derive", vec!["pendulum"], vec!["--at", "A=1"]),
        ("derive", vec!["pendulum"], vec!["--steps"]),
        ("derive", vec!["pendulum"], vec!["--format", "csv"]),
        ("derive", vec!["pendulum"], vec!["--format", "json"]),
        ("derive", vec!["pendulum"], vec!["--output", file]),
        ("derive", vec!["pendulum", "--at", "A=1"], vec!["--standalone"]),
        ("derive", vec!["pendulum", "--at", "A=1"], vec!["--plot", "-"]),
        ("derive", vec!["pendulum", "--at", "A=1"], vec!["--tolerance", "1e-9"]),
        (
            "derive",
            vec!["van-der-pol", "--order", "150", "--omega-only"],
            vec!["--timeout", NO_TIME],
        ),
        ("derive", vec!["pendulum"], vec!["--jobs", "0"]),
        ("derive", vec!["pendulum"], vec!["--quiet"]),
        ("compare", vec![cubic, "--at", "eps=1"], vec!["--at", "A=1"]),
        (
            "compare",
            vec!["pendulum", "--at", "A=1"],
            vec!["--contact", "x < 1/2: kelvin-voigt K=1 c=0"],
        ),
        (
            "compare",
            vec![cubic, "--at", "eps=1", "--at", "A=1", "--format", "json"],
            vec!["--small", "A"],
        ),
        ("compare", vec![cubic, "--at", "eps=1", "--at", "A=1"], vec!["--small", "nu"]),
        ("compare", vec![well, "--at", "A=1/10"], vec!["--about", "x=1"]),
        ("compare", vec!["pendulum", "--at", "A=1"], vec!["--format", "csv"]),
        ("compare", vec!["pendulum", "--at", "A=1"], vec!["--format", "latex"]),
        ("compare", vec!["pendulum", "--at", "A=1"], vec!["--output", file]),
        ("compare", vec!["pendulum", "--at", "A=1"], vec!["--plot", "-"]),
        ("compare", vec!["pendulum", "--at", "A=1"], vec!["--tolerance", "1e-9"]),
        ("compare", vec!["pendulum", "--at", "A=1"], vec!["--standalone"]),
        ("compare", vec!["pendulum", "--at", "A=1"], vec!["--timeout", NO_TIME]),
        ("compare", vec!["pendulum", "--at", "A=1"], vec!["--quiet"]),
        ("impact", vec![], vec!["--at", "A=1"]),
        ("impact", vec![], vec!["--method", "pade"]),
        ("impact", vec![], vec!["--order", "6"]),
        ("impact", vec![], vec!["--amplitude", "first-harmonic"]),
        ("impact", vec![], vec!["--force", "gamma*d^2"]),
        ("impact", vec![], vec!["--contact", "power-law"]),
        ("impact", vec![], vec!["--contact", "all"]),
        ("impact", vec!["--compare"], vec!["--contact", "equal-energy"]),
        ("impact", vec!["--compare"], vec!["--contact", "all"]),
        ("impact", vec![], vec!["--left"]),
        ("impact", vec![], vec!["--compare"]),
        ("impact", vec![], vec!["--format", "csv"]),
        ("impact", vec![], vec!["--format", "latex"]),
        ("impact", vec![], vec!["--output", file]),
        ("impact", vec![], vec!["--plot", "-"]),
        ("impact", vec![], vec!["--tolerance", "1e-9"]),
        ("impact", vec![], vec!["--standalone"]),
        ("impact", vec![], vec!["--timeout", NO_TIME]),
        ("impact", vec![], vec!["--certify"]),
        ("orbits", vec!["examples/orbits/driven-beam.toml", "--periods", "1"], vec!["--certify"]),
        ("impact", vec![], vec!["--quiet"]),
        ("simulate", simulated[1..].to_vec(), vec!["--sample", "1"]),
        ("simulate", simulated[1..].to_vec(), vec!["--integrator", "both"]),
        ("simulate", simulated[1..].to_vec(), vec!["--chain"]),
        ("simulate", swept[1..].to_vec(), vec!["--chain"]),
        ("simulate", swept[1..].to_vec(), vec!["--baseline"]),
        ("simulate", simulated[1..].to_vec(), vec!["--baseline"]),
        ("simulate", simulated[1..].to_vec(), vec!["--sweep", "zeta=0:1:2"]),
        ("simulate", simulated[1..].to_vec(), vec!["--jobs", "1"]),
        ("simulate", swept[1..].to_vec(), vec!["--sample", "1"]),
        ("simulate", swept[1..].to_vec(), vec!["--integrator", "both"]),
        ("simulate", simulated[1..].to_vec(), vec!["--format", "latex"]),
        ("simulate", simulated[1..].to_vec(), vec!["--format", "csv"]),
        ("simulate", simulated[1..].to_vec(), vec!["--output", file]),
        ("simulate", simulated[1..].to_vec(), vec!["--plot", "-"]),
        ("simulate", simulated[1..].to_vec(), vec!["--tolerance", "1e-15"]),
        ("simulate", long[1..3].to_vec(), vec!["--shard", "1/1000"]),
        ("simulate", simulated[1..].to_vec(), vec!["--shard", "1/2"]),
        ("simulate", long[1..].to_vec(), vec!["--standalone"]),
        ("simulate", long[1..].to_vec(), vec!["--timeout", NO_TIME]),
        ("simulate", [&long[1..], &["--timeout", NO_TIME]].concat(), vec!["--quiet"]),
        ("simulate", own[1..].to_vec(), vec!["--from", "x'=0.5"]),
        ("simulate", own[1..].to_vec(), vec!["--until", "3"]),
        ("simulate", own[1..].to_vec(), vec!["--step-limit", "3"]),
        ("simulate", own[1..4].to_vec(), vec!["--at", "k=2"]),
        ("simulate", own[1..].to_vec(), vec!["--integrator", "both"]),
        ("simulate", own[1..].to_vec(), vec!["--chain"]),
        ("simulate", own[1..].to_vec(), vec!["--sample", "1"]),
        ("simulate", own[1..].to_vec(), vec!["--sweep", "zeta=0:1:2"]),
        ("simulate", own[1..4].to_vec(), vec!["--sweep", "k=1:2:3"]),
        ("simulate", own[1..].to_vec(), vec!["--sweep", "x'=1:2:3"]),
        ("simulate", own[1..].to_vec(), vec!["--every", "pi"]),
        ("simulate", own[1..].to_vec(), vec!["--section", "x'"]),
        ("simulate", own[1..].to_vec(), vec!["--wall", "x > 0", "--restitution", "1/2"]),
        ("simulate", own[1..].to_vec(), vec!["--restitution", "1/2"]),
        ("simulate", own[1..].to_vec(), vec!["--event", "x < 0: x' = -x'"]),
        ("simulate", slides.to_vec(), vec!["--static-friction", "2"]),
        ("simulate", vec![], vec!["--static-friction", "2"]),
        ("simulate", vec![], vec!["--event", "x < 0: x' = -x'"]),
        ("simulate", own[1..].to_vec(), vec!["--contact", "x < 1/2: hertz K=1"]),
        ("simulate", vec![], vec!["--contact", "x < 1/2: hertz K=1"]),
        ("simulate", own[1..].to_vec(), vec!["--lyapunov"]),
        ("simulate", vec![], vec!["--wall", "x > 0"]),
        ("simulate", own[1..].to_vec(), vec!["--after", "10"]),
        ("simulate", [&own[1..], &["--every", "pi"]].concat(), vec!["--after", "10"]),
        ("simulate", vec![], vec!["--every", "pi"]),
        ("simulate", vec![], vec!["--section", "x'"]),
        ("simulate", vec![], vec!["--after", "1"]),
        ("simulate", own[1..].to_vec(), vec!["--plot", "-"]),
        ("simulate", vec![], vec!["--from", "x=1"]),
        ("simulate", vec![], vec!["--until", "3"]),
        ("simulate", vec![], vec!["--at", "k=2"]),
        ("lagrange", vec![], vec!["--at", "m=1"]),
        ("lagrange", vec![], vec!["--format", "latex"]),
        ("lagrange", vec![], vec!["--output", file]),
        ("lagrange", vec![], vec!["--plot", "-"]),
        ("lagrange", vec![], vec!["--tolerance", "0.1"]),
        ("lagrange", vec![], vec!["--standalone"]),
        ("lagrange", vec![], vec!["--timeout", NO_TIME]),
        ("lagrange", vec![], vec!["--quiet"]),
        ("stability", hill[1..].to_vec(), vec!["--order", "2"]),
        ("stability", hill[1..].to_vec(), vec!["--tongues", "1"]),
        ("stability", hill[1..].to_vec(), vec!["--for", "Omega"]),
        ("stability", hill[1..].to_vec(), vec!["--small", "delta"]),
        ("stability", hill[1..].to_vec(), vec!["--at", "eps=1/2"]),
        ("stability", hill[1..].to_vec(), vec!["--format", "csv"]),
        ("stability", hill[1..].to_vec(), vec!["--format", "latex"]),
        ("stability", hill[1..].to_vec(), vec!["--output", file]),
        ("stability", hill[1..].to_vec(), vec!["--plot", "-"]),
        ("stability", hill[1..].to_vec(), vec!["--tolerance", "1e-9"]),
        ("stability", hill[1..].to_vec(), vec!["--standalone"]),
        ("stability", hill[1..].to_vec(), vec!["--timeout", NO_TIME]),
        ("stability", hill[1..].to_vec(), vec!["--quiet"]),
        ("absorber", vec!["tuned"], vec!["--excitation", "ground"]),
        ("absorber", vec!["cubic-sink"], vec!["--excitation", "ground"]),
        ("absorber", vec!["tuned"], vec!["--at", "mu=1/20"]),
        ("absorber", vec!["tuned"], vec!["--format", "latex"]),
        ("absorber", vec!["tuned"], vec!["--format", "csv"]),
        ("absorber", vec!["tuned"], vec!["--output", file]),
        ("absorber", vec!["tuned", "--at", "mu=1/20"], vec!["--plot", "-"]),
        ("absorber", vec!["tuned", "--at", "mu=1/20"], vec!["--tolerance", "1e-15"]),
        ("absorber", vec!["tuned", "--at", "mu=1/20"], vec!["--standalone"]),
        ("absorber", vec!["tuned", "--at", "mu=1/20"], vec!["--timeout", NO_TIME]),
        ("absorber", vec!["tuned", "--at", "mu=1/20"], vec!["--quiet"]),
        ("shortest", laws[1..].to_vec(), vec!["--range", "A=0:2"]),
        ("shortest", laws[1..].to_vec(), vec!["--error", "0.1"]),
        ("shortest", laws[1..].to_vec(), vec!["--quantity", "T"]),
        ("shortest", laws[1..].to_vec(), vec!["--at", "k=1"]),
        ("shortest", laws[1..].to_vec(), vec!["--atom", "A^2"]),
        ("shortest", laws[1..].to_vec(), vec!["--longest", "4"]),
        ("shortest", laws[1..].to_vec(), vec!["--exact-at-rest", "4"]),
        ("shortest", laws[1..].to_vec(), vec!["--growth", "0"]),
        ("shortest", well_laws.to_vec(), vec!["--about", "x=-1"]),
        ("shortest", laws[1..].to_vec(), vec!["--mode", "1"]),
        ("shortest", backbone.to_vec(), vec!["--mode", "2"]),
        ("shortest", backbone.to_vec(), vec!["--amplitude", "initial"]),
        ("shortest", laws[1..].to_vec(), vec!["--certificate"]),
        ("shortest", laws[1..].to_vec(), vec!["--format", "csv"]),
        ("shortest", laws[1..].to_vec(), vec!["--format", "latex"]),
        ("shortest", laws[1..].to_vec(), vec!["--output", file]),
        ("shortest", laws[1..].to_vec(), vec!["--plot", "-"]),
        ("shortest", laws[1..].to_vec(), vec!["--tolerance", "0.1"]),
        ("shortest", laws[1..].to_vec(), vec!["--standalone"]),
        ("shortest", laws[1..].to_vec(), vec!["--timeout", NO_TIME]),
        ("shortest", laws[1..].to_vec(), vec!["--quiet"]),
        ("fit", fitted.to_vec(), vec!["--also", swing]),
        ("fit", fitted.to_vec(), vec!["--data", "impacts"]),
        ("fit", fitted.to_vec(), vec!["--time", "y"]),
        ("fit", fitted.to_vec(), vec!["--column", "y"]),
        ("fit", [&fitted[..], &["--start", "c=0.04,k=4"]].concat(), vec!["--quantity", "velocity"]),
        ("fit", fitted.to_vec(), vec!["--angle"]),
        ("fit", fitted.to_vec(), vec!["--start", "c=1"]),
        ("fit", fitted.to_vec(), vec!["--noise", "0.1"]),
        ("fit", vec![IMPACTS, "--data", "impacts"], vec!["--keep-outliers"]),
        ("fit", [&fitted[..], &["--format", "csv"]].concat(), vec!["--until", "100"]),
        ("fit", vec![IMPACTS, "--data", "impacts"], vec!["--gravity", "1.62"]),
        ("fit", fitted.to_vec(), vec!["--format", "csv"]),
        ("fit", fitted.to_vec(), vec!["--format", "latex"]),
        ("fit", fitted.to_vec(), vec!["--output", file]),
        ("fit", fitted.to_vec(), vec!["--plot", "-"]),
        ("fit", fitted.to_vec(), vec!["--tolerance", "0.1"]),
        ("fit", fitted.to_vec(), vec!["--standalone"]),
        ("fit", fitted.to_vec(), vec!["--timeout", NO_TIME]),
        ("fit", fitted.to_vec(), vec!["--quiet"]),
        ("friction", vec![], vec!["--alpha", "0.1"]),
        ("friction", vec![], vec!["--amplitude", "1"]),
        ("friction", vec![], vec!["--speed", "0.01"]),
        ("friction", vec![], vec!["--format", "latex"]),
        ("friction", vec![], vec!["--output", file]),
        ("friction", vec![], vec!["--quiet"]),
        ("friction", vec![], vec!["--plot", "-"]),
        ("friction", vec![], vec!["--tolerance", "0.1"]),
        ("friction", vec![], vec!["--standalone"]),
        ("friction", vec![], vec!["--timeout", NO_TIME]),
        ("materials", vec![], vec!["--only-own"]),
        ("materials", vec![], vec!["--chain"]),
        ("materials", vec![], vec!["--shard", "1/2"]),
        ("materials", vec![], vec!["--format", "latex"]),
        ("materials", vec![], vec!["--output", file]),
        ("materials", vec![], vec!["--plot", "-"]),
        ("materials", vec![], vec!["--tolerance", "0.1"]),
        ("materials", vec![], vec!["--standalone"]),
        ("materials", vec![], vec!["--timeout", NO_TIME]),
        ("materials", vec![], vec!["--quiet"]),
        ("optimize", vec!["--runs", "1", "--budget", "300"], vec!["--seed", "2"]),
        ("optimize", vec!["--budget", "300"], vec!["--runs", "2"]),
        // The result is the same for any number of threads.
        ("optimize", vec!["--budget", "300"], vec!["--jobs", "0"]),
        ("optimize", vec!["--runs", "1"], vec!["--budget", "300"]),
        ("optimize", vec!["--runs", "2", "--budget", "600"], vec!["--shard", "1/2"]),
        ("optimize", vec!["--runs", "1", "--budget", "300"], vec!["--record", "-"]),
        ("optimize", vec!["--runs", "1", "--budget", "300"], vec!["--resume", "-"]),
        ("optimize", vec!["--budget", "0.0000000001s"], vec!["--quiet"]),
        ("optimize", vec!["--runs", "1", "--budget", "300"], vec!["--format", "latex"]),
        ("optimize", vec!["--runs", "1", "--budget", "300"], vec!["--output", file]),
        ("optimize", vec!["--runs", "1", "--budget", "300"], vec!["--plot", "-"]),
        ("optimize", vec!["--runs", "1", "--budget", "300"], vec!["--tolerance", "0.1"]),
        ("optimize", vec!["--runs", "2", "--budget", "600"], vec!["--standalone"]),
        ("optimize", vec!["--runs", "2", "--budget", "600"], vec!["--timeout", NO_TIME]),
        ("response", vec![driven[1], "--at", "F=0.2"], vec!["--vary", "Omega=0.5:1.5"]),
        ("response", driven[1..4].to_vec(), vec!["--at", "F=2"]),
        ("response", driven[1..].to_vec(), vec!["--method", "pade"]),
        ("response", driven[1..].to_vec(), vec!["--method", "multiple-scales"]),
        ("response", driven[1..].to_vec(), vec!["--order", "2"]),
        ("response", driven[1..].to_vec(), vec!["--periods", "2"]),
        ("response", driven[1..].to_vec(), vec!["--of", "y"]),
        ("response", driven[1..].to_vec(), vec!["--along", "F=0.1:0.3"]),
        ("response", driven[1..].to_vec(), vec!["--wall", "x < 9", "--restitution", "1/2"]),
        ("response", driven[1..].to_vec(), vec!["--restitution", "1/2"]),
        ("response", driven[1..].to_vec(), vec!["--event", "x > 0: x' = x'/2"]),
        ("response", driven[1..].to_vec(), vec!["--contact", "x < 9: hertz K=1"]),
        ("response", driven[1..].to_vec(), vec!["--format", "csv"]),
        ("response", driven[1..].to_vec(), vec!["--format", "latex"]),
        ("response", driven[1..].to_vec(), vec!["--output", file]),
        ("response", driven[1..].to_vec(), vec!["--plot", "-"]),
        ("response", [&driven[1..], &["--order", "3"]].concat(), vec!["--tolerance", "1e-7"]),
        ("response", driven[1..].to_vec(), vec!["--standalone"]),
        ("response", driven[1..].to_vec(), vec!["--timeout", NO_TIME]),
        ("response", driven[1..].to_vec(), vec!["--quiet"]),
        ("audit", vec![AUDIT], vec!["--strict"]),
        ("audit", vec![AUDIT], vec!["--shard", "1/2"]),
        ("audit", vec![AUDIT], vec!["--format", "latex"]),
        ("audit", vec![AUDIT], vec!["--format", "csv"]),
        ("audit", vec![AUDIT], vec!["--output", file]),
        ("audit", vec![AUDIT], vec!["--quiet"]),
        ("audit", vec![AUDIT], vec!["--plot", "-"]),
        ("audit", vec![AUDIT], vec!["--tolerance", "0.1"]),
        ("audit", vec![AUDIT], vec!["--standalone"]),
        ("audit", vec![AUDIT], vec!["--timeout", NO_TIME]),
        ("paper", vec![], vec!["--strict"]),
        ("paper", vec![], vec!["--shard", "1/2"]),
        ("paper", vec![], vec!["--format", "latex"]),
        ("paper", vec![], vec!["--output", file]),
        ("paper", vec![], vec!["--quiet"]),
        ("paper", vec![], vec!["--plot", "-"]),
        ("paper", vec![], vec!["--tolerance", "0.1"]),
        ("paper", vec![], vec!["--standalone"]),
        ("paper", vec![], vec!["--timeout", NO_TIME]),
        ("catalog", vec![], vec!["--format", "csv"]),
        ("catalog", vec![], vec!["--format", "json"]),
        ("catalog", vec![], vec!["--output", file]),
        ("catalog", vec![], vec!["--plot", "-"]),
        ("catalog", vec![], vec!["--tolerance", "0.1"]),
        ("catalog", vec![], vec!["--standalone"]),
        ("catalog", vec![], vec!["--timeout", NO_TIME]),
        ("catalog", vec![], vec!["--quiet"]),
        ("schema", vec!["impact"], vec!["--output", file]),
        ("schema", vec!["impact"], vec!["--quiet"]),
    ];
    for command in [
        "derive",
        "compare",
        "impact",
        "simulate",
        "response",
        "lagrange",
        "friction",
        "materials",
        "optimize",
        "audit",
        "paper",
        "catalog",
        "schema",
    ] {
        for name in options_of(command) {
            let option = format!("--{name}");
            assert!(
                table.iter().any(|(known, _, words)| *known == command && words[0] == option),
                "{command} {option} is not tried"
            );
        }
    }
    for (command, beside, option) in table {
        let base = run(&[&[command], beside.as_slice()].concat());
        let answer = run(&[&[command], beside.as_slice(), option.as_slice()].concat());
        let word = option[0].trim_start_matches('-');
        let named = !matches!(answer.0, Some(1 | 2))
            || answer.2.contains(word)
            || answer.2.contains(option[option.len() - 1])
            || word == "timeout" && answer.2.contains("stopped after")
            || word == "plot" && answer.2.contains("picture");
        assert!(named, "{command} {beside:?} {option:?}: {answer:?}");
        // Most commands have nothing to say beside their result.
        if word == "quiet" && command != "schema" {
            assert_eq!((answer.1, answer.2), (base.1, String::new()), "{command} {beside:?}");
            continue;
        }
        assert!(answer != base, "{command} {beside:?}: {option:?} changes nothing: {answer:?}");
    }
    let _ = std::fs::remove_file(file);
}

/// The help of a command lists `--tolerance` where it has a verdict, and nowhere else.
#[test]
fn the_help_is_silent_on_a_tolerance_that_is_refused() {
    for (words, has_verdict) in [
        (&["derive", "pendulum"][..], true),
        (&["compare", "pendulum", "--at", "A=1"], true),
        (&["impact"], true),
        (&["simulate"], true),
        (&["friction"], false),
        (&["materials"], false),
        (&["optimize"], false),
        (&["lagrange"], false),
        (&["audit", AUDIT], false),
        (&["paper"], false),
        (&["catalog"], false),
    ] {
        let listed = options_of(words[0]).iter().any(|name| name == "tolerance");
        assert_eq!(listed, has_verdict, "{words:?}");
        if !has_verdict {
            let (status, _, error) = run(&[words, &["--tolerance", "0.1"]].concat());
            assert!(status == Some(2) && error.contains("--tolerance"), "{words:?}: {error}");
        }
    }
}
