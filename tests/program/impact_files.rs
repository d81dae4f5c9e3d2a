//! One file, read by `lindstedt impact` and by `lindstedt simulate`: the same barrier, the same
//! bodies, the same words where numbers are extreme.

use std::process::Command;

use serde_json::Value;

/// A file in a folder of its own, and what a command prints of it: standard output and standard
/// error.
fn of_text(name: &str, text: &str, arguments: &[&str]) -> (String, String) {
    let path = std::env::temp_dir().join(format!("lindstedt-{name}-{}.toml", std::process::id()));
    std::fs::write(&path, text).expect("a file");
    let output = Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .arg(arguments[0])
        .arg(&path)
        .args(&arguments[1..])
        .output()
        .expect("the program starts");
    std::fs::remove_file(&path).expect("the file goes");
    let text = |bytes| String::from_utf8(bytes).expect("text");
    (text(output.stdout), text(output.stderr))
}

/// A barrier on the left, released on the right, is the mirror image: integrated, by closed forms,
/// swept.
#[test]
fn a_barrier_on_the_left_is_the_mirror_image() {
    let damped = "[damping]\nzeta = 0.02\n[contact]\nmu_over_gamma = 0.1\n";
    let left = format!("[pendulum]\nbarrier = -0.3\nside = \"left\"\n{damped}");
    let right = format!("[pendulum]\nbarrier = 0.3\n{damped}");
    for arguments in [vec![], vec!["--chain"]] {
        let document = |text: &str| -> Value {
            let arguments = [&["simulate", "--format", "json"], arguments.as_slice()].concat();
            serde_json::from_str(&of_text("mirror", text, &arguments).0).expect("JSON")
        };
        let (left, right) = (document(&left), document(&right));
        let number = |value: &Value| value.as_f64().expect("a number");
        assert_eq!(left["rest_time"], right["rest_time"]);
        assert_eq!(number(&left["final_state"]["x"]), -number(&right["final_state"]["x"]));
        let impacts = |document: &Value| document["impacts"].as_array().expect("impacts").clone();
        assert!(!impacts(&left).is_empty() && impacts(&left).len() == impacts(&right).len());
        for (left, right) in impacts(&left).iter().zip(&impacts(&right)) {
            assert_eq!(
                (&left["side"], &right["side"]),
                (&Value::from("left"), &Value::from("right"))
            );
            assert_eq!(left["entry_time"], right["entry_time"]);
        }
    }
    let printed = of_text("mirror", &left, &["simulate"]).0;
    assert!(printed.contains("- (gamma - mu*x')*(xc - x)^(3/2)*H(xc - x) = 0"), "{printed}");
    // The rest, and the greatest penetration, speed and loss: all but where it stood at the end.
    let swept = |text: &str, places: &str| -> Vec<Vec<String>> {
        let arguments = ["simulate", "--sweep", places, "--format", "csv"];
        let table = of_text("mirror", text, &arguments).0;
        let rows = table.lines().skip(2);
        rows.map(|row| row.split(',').skip(1).take(5).map(str::to_owned).collect()).collect()
    };
    assert_eq!(swept(&left, "barrier=-0.2,-0.4"), swept(&right, "barrier=0.2,0.4"));
    assert_eq!(swept(&left, "amplitude=1,1.4"), swept(&right, "amplitude=1,1.4"));
    // Where no single barrier is on a side and no release either, it would change nothing.
    for barrier in ["[-0.3, 0.4]", "false"] {
        let text =
            format!("[pendulum]\nstart = 0.1\nspeed = 1\nside = \"left\"\nbarrier = {barrier}\n");
        let error = of_text("side", &text, &["simulate"]).1;
        assert!(error.contains("`[pendulum] side` changes nothing"), "{error}");
    }
}

/// The bodies of an impact are those of a simulation, and the barrier of the one is that of the
/// other.
#[test]
fn a_file_of_two_elastic_bodies_is_simulated_as_it_is_solved() {
    let bodies =
        "[sphere]\nmodulus = 2e11\npoisson = 0.3\n[barrier]\nmodulus = 2e9\npoisson = 0.4\n";
    let gamma = |command: &str| {
        let printed = of_text("bodies", bodies, &[command]).0;
        let line =
            printed.lines().find(|line| line.trim_start().starts_with("gamma ")).map(str::to_owned);
        let line = line.expect("gamma");
        line.split_whitespace().nth(2).expect("a number").to_owned()
    };
    assert_eq!(gamma("simulate"), gamma("impact"));
    // 1/E = (1 - 0.16)/2e9 + (1 - 0.09)/2e11, against 1.439e9 and 3.0407e7 of the paper.
    let modulus = 1.0 / (0.84 / 2e9 + 0.91 / 2e11);
    let found: f64 = gamma("simulate").parse().expect("a number");
    assert!((found / 3.04067e7 / (modulus / 1.439e9) - 1.0).abs() < 1e-5, "{found}");
    let error = of_text("bodies", bodies, &["simulate", "--sweep", "modulus=1e8,1e9"]).1;
    assert!(error.contains("two bodies"), "{error}");
    // A key of several readers names each command once.
    let error = of_text("bodies", "[run]\nduration = 20\n", &["impact"]).1;
    assert_eq!(error.matches("`lindstedt simulate`").count(), 1, "{error}");
}

#[test]
fn a_barrier_where_the_swing_turns_is_said_to_be_touched_by_rounding() {
    let text = "[pendulum]\namplitude = 1.5\nbarrier = 1.5\n[contact]\ngamma = 1e6\n";
    let in_one_line = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let (printed, error) = of_text("turn", text, &["simulate"]);
    let printed = in_one_line(&printed);
    let said = "rounding decides whether it is touched";
    assert!(printed.contains(said) || error.contains(said), "{printed}{error}");
    let (printed, error) =
        of_text("turn", &text.replace("barrier = 1.5", "barrier = 1.4999"), &["simulate"]);
    let printed = in_one_line(&printed);
    assert!(!printed.contains(said) && !error.contains(said), "{printed}{error}");
}

/// Numbers far beyond any material have answers, or a refusal that says what is extreme about them.
#[test]
fn extreme_contacts_are_called_by_their_name() {
    for text in ["[contact]\nrestitution = 1e-6\n", "[contact]\nmu = 1e12\n"] {
        let error = of_text("extreme", text, &["impact"]).1;
        assert!(
            error.contains("damped so strongly, mu*v/gamma = ") && !error.contains("smooth"),
            "{error}"
        );
    }
    let printed = of_text("extreme", "[contact]\ngamma = 1e300\n", &["impact"]).0;
    assert!(
        printed.contains("so stiff a contact") && printed.contains("derived pass"),
        "{printed}"
    );
    let printed = of_text("extreme", "[contact]\ngamma = 1e300\n", &["simulate"]).0;
    assert!(printed.contains("< 9e-16"), "{printed}");
    // A contact that loses nothing, by its restitution.
    let without = of_text("lossless", "", &["impact"]).0;
    assert_eq!(of_text("lossless", "[contact]\nrestitution = 1\n", &["impact"]).0, without);
    for restitution in ["0", "1.5", "-1", "nan"] {
        for command in ["impact", "simulate"] {
            let error = of_text(
                "restitution",
                &format!("[contact]\nrestitution = {restitution}\n"),
                &[command],
            )
            .1;
            assert!(error.contains("above 0 and be at most 1"), "{command} {restitution}: {error}");
        }
    }
}
