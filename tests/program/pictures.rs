//! What a picture shows are the numbers that are printed: curves are read back from the SVG by the
//! ticks of their axes.

use std::process::Command;

use serde_json::Value;

/// One pair of axes: its title, and its curves in the order in which they are drawn, each with its
/// colour.
struct Panel {
    title: String,
    curves: Vec<(String, Vec<(f64, f64)>)>,
    logarithmic: bool,
}

const TRUTH: &str = "#56b4e9";
const FORMULA: &str = "#d55e00";
const SECOND_FORMULA: &str = "#000000";
const GUIDE: &str = "#777777";

impl Panel {
    /// The first curve of a colour.
    fn curve(&self, colour: &str) -> &[(f64, f64)] {
        let found = self.curves.iter().find(|(own, _)| own == colour);
        &found.unwrap_or_else(|| panic!("no {colour} in {}", self.title)).1
    }
}

/// The value of an attribute.
fn attribute<'a>(line: &'a str, name: &str) -> Option<&'a str> {
    let (_, rest) = line.split_once(&format!(" {name}=\""))?;
    Some(rest.split_once('"')?.0)
}

fn number(line: &str, name: &str) -> f64 {
    let text = attribute(line, name).unwrap_or_else(|| panic!("no {name} in {line}"));
    text.parse().unwrap_or_else(|_| panic!("{name} of {line}"))
}

/// `10` with a raised exponent.
fn power_of_ten(text: &str) -> Option<i32> {
    let raised = text.strip_prefix("10")?;
    let digits: Option<String> = raised
        .chars()
        .map(|letter| match letter {
            '⁻' => Some('-'),
            _ => "⁰¹²³⁴⁵⁶⁷⁸⁹"
                .chars()
                .position(|digit| digit == letter)
                .map(|digit| (b'0' + digit as u8) as char),
        })
        .collect();
    digits.filter(|digits| !digits.is_empty())?.parse().ok()
}

/// The straight line through the two ticks that are farthest apart.
fn scale(ticks: &[(f64, f64)]) -> impl Fn(f64) -> f64 + use<> {
    let (first, last) = (ticks[0], ticks[ticks.len() - 1]);
    assert!(first.0 != last.0, "two ticks: {ticks:?}");
    move |place| first.1 + (place - first.0) * (last.1 - first.1) / (last.0 - first.0)
}

fn panels(svg: &str) -> Vec<Panel> {
    let groups = svg.split("<g transform=\"translate(").skip(1);
    groups.filter(|group| group.contains("clip-path")).map(panel).collect()
}

fn panel(group: &str) -> Panel {
    let (mut x_ticks, mut y_ticks, mut labels) = (Vec::new(), Vec::new(), Vec::new());
    let (mut title, mut tick) = (String::new(), "");
    let mut logarithmic = false;
    let axes = group.split_once("<g clip-path").expect("curves").0;
    for line in axes.lines().map(str::trim) {
        if line.starts_with("<line") {
            tick = line;
        }
        let Some((_, text)) = line.strip_prefix("<text").and_then(|rest| rest.split_once('>'))
        else {
            continue;
        };
        let text = text.trim_end_matches("</text>").replace('−', "-");
        let value = text.parse().ok().or_else(|| {
            logarithmic |= power_of_ten(&text).is_some();
            power_of_ten(&text).map(f64::from)
        });
        match (attribute(line, "font-size"), attribute(line, "text-anchor"), value) {
            (Some("11"), Some("middle"), Some(value)) => x_ticks.push((number(tick, "x1"), value)),
            (Some("11"), Some("end"), Some(value)) => y_ticks.push((number(tick, "y1"), value)),
            (Some("12"), ..) => labels.push(text),
            (Some("13"), ..) => title = text,
            _ => {}
        }
    }
    // Large or small numbers are divided by a power of ten, which the label names.
    let unit = |label: &str| {
        let (_, inside) = label.rsplit_once('(').unwrap_or_default();
        let word = inside.split([' ', ')']).next().unwrap_or_default();
        power_of_ten(word).map_or(1.0, |power| 10.0_f64.powi(power))
    };
    let units = [unit(&labels[0]), unit(&labels[1])];
    let (x, y) = (scale(&x_ticks), scale(&y_ticks));
    let curves = group.lines().map(str::trim).filter(|line| line.starts_with("<path"));
    let curves = curves.map(|line| {
        let colour = attribute(line, "stroke").expect("a colour").to_owned();
        let path = attribute(line, "d").expect("points").split(['M', 'L']).skip(1);
        let point = |pair: &str| {
            let mut pair = pair.split_whitespace().map(|text| text.parse().expect("a number"));
            let (left, down) = (pair.next().expect("a place"), pair.next().expect("a place"));
            (units[0] * x(left), units[1] * y(down))
        };
        (colour, path.map(point).collect())
    });
    Panel { curves: curves.filter(|(colour, _)| colour != GUIDE).collect(), title, logarithmic }
}

/// The picture and the document of one command.
fn drawn(name: &str, arguments: &[&str]) -> (Vec<Panel>, Value) {
    let (svg, document) = picture(name, arguments);
    (panels(&svg), document)
}

fn picture(name: &str, arguments: &[&str]) -> (String, Value) {
    let path = std::env::temp_dir().join(format!("lindstedt-{name}-{}.svg", std::process::id()));
    let output = Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .args(arguments)
        .args(["--format", "json", "--plot", path.to_str().expect("a path in text")])
        .output()
        .expect("the program starts");
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {message}");
    let svg = std::fs::read_to_string(&path).expect("the picture");
    std::fs::remove_file(path).expect("the picture goes");
    (svg, serde_json::from_slice(&output.stdout).expect("JSON"))
}

fn float(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// As near as pixels with two digits behind the point show it.
fn close(found: f64, expected: f64, range: f64) {
    assert!((found - expected).abs() < 2e-4 * range, "{found} {expected}");
}

fn extreme(points: &[(f64, f64)], fold: fn(f64, f64) -> f64) -> f64 {
    points.iter().map(|point| point.1).reduce(fold).expect("points")
}

/// The ordinate at an abscissa, between the points.
fn at(points: &[(f64, f64)], x: f64) -> f64 {
    let pair =
        points.windows(2).find(|pair| pair[0].0 <= x && x <= pair[1].0).expect("within the curve");
    pair[0].1 + (pair[1].1 - pair[0].1) * (x - pair[0].0) / (pair[1].0 - pair[0].0)
}

#[test]
fn a_derived_motion_and_the_truth() {
    for (amplitude, value) in [("3/2", 1.5), ("-5/2", -2.5_f64)] {
        let arguments = ["derive", "pendulum", "--order", "2", "--at", &format!("A={amplitude}")];
        let (panels, document) = drawn("motion", &arguments);
        let verification = &document["verification"];
        let period = std::f64::consts::TAU / float(&verification["true_frequency"]);
        let deviation = float(&verification["max_deviation"]) * value.abs();
        let [motion, orbit, difference] = &panels[..] else {
            panic!("{} panels", panels.len());
        };
        let (truth, formula) = (motion.curve(TRUTH), motion.curve(FORMULA));
        for curve in [truth, formula] {
            close(curve[0].0, 0.0, period);
            close(curve[0].1, value, 5.0);
            close(curve[curve.len() - 1].0, period, period);
        }
        close(truth[truth.len() - 1].1, value, 5.0);
        close(truth[truth.len() / 2].1, -value, 5.0);
        let apart =
            truth.iter().zip(formula).map(|(truth, formula)| (truth.0, formula.1 - truth.1));
        let apart: Vec<(f64, f64)> = apart.collect();
        let below = difference.curve("#0072b2");
        for (index, point) in below.iter().enumerate().step_by(50) {
            close(point.1, apart[index].1, 10.0);
        }
        close(extreme(below, f64::max).max(-extreme(below, f64::min)), deviation, 3.0 * deviation);
        // Energy is conserved along the true orbit; the formula has its own frequency.
        for &(x, v) in orbit.curve(TRUTH) {
            close(0.5 * v * v + 1.0 - x.cos(), 1.0 - value.cos(), 10.0);
        }
        let fastest = extreme(orbit.curve(FORMULA), f64::max);
        let frequency = float(&verification["frequency"]);
        // x = (A + A^3/192) cos(theta) - A^3/192 cos(3 theta)
        let third = value.abs().powi(3) / 192.0;
        close(fastest, frequency * (value.abs() + 4.0 * third), 10.0);
        assert_eq!(orbit.curve(FORMULA)[20].1 < 0.0, value > 0.0);
    }
}

#[test]
fn frequencies_against_the_amplitude() {
    let (panels, document) = drawn("backbone", &["compare", "pendulum", "--at", "A=5/4"]);
    let [frequency, error] = &panels[..] else {
        panic!("{} panels", panels.len());
    };
    let truth = frequency.curve(TRUTH);
    close(at(truth, 1.25), float(&document["true_frequency"]), 3.0);
    for &(amplitude, omega) in truth.iter().step_by(7) {
        let modulus = (0.5 * amplitude).sin().powi(2);
        let exact = std::f64::consts::FRAC_PI_2 / ellip::ellipk(modulus).expect("m < 1");
        close(omega, exact, 2.0);
    }
    assert!(error.logarithmic);
    let rows = document["methods"].as_array().expect("methods");
    let first = &rows[0];
    assert_eq!(first["method"], "lindstedt-poincare");
    close(at(&frequency.curves[1].1, 1.25), float(&first["frequency"]), 3.0);
    let percent = (100.0 * float(&first["relative_error"]).abs()).log10();
    assert!((at(&error.curves[0].1, 1.25) - percent).abs() < 0.02);
}

#[test]
fn an_impact_by_both_columns_and_by_runge_kutta() {
    let (panels, document) = drawn("impact", &["impact"]);
    let [orbit, motion, contact] = &panels[..] else {
        panic!("{} panels", panels.len());
    };
    let (amplitude, barrier) = (1.5_f64, 0.323);
    for (colour, column) in [(TRUTH, "runge_kutta"), (FORMULA, "paper"), (SECOND_FORMULA, "energy")]
    {
        let [depth, duration] =
            ["penetration", "duration"].map(|name| float(&document["contact"][name][column]));
        let (time, enlarged) = (motion.curve(colour), contact.curve(colour));
        close(time[0].1, -amplitude, 3.0);
        close(extreme(time, f64::max), barrier + depth, 3.0);
        close(time[time.len() - 1].0, float(&document["period"][column]), 5.0);
        close(enlarged[0].1, 0.0, depth);
        close(extreme(enlarged, f64::max), depth, 2.0 * depth);
        close(enlarged[enlarged.len() - 1].0, duration, 2.0 * duration);
        // Through the lowest point at the speed of the energy or of the cosine; the fitted line of
        // the energy column pulls at first, so its contact is faster still.
        let wave = |phases: &Value| {
            let wave = &phases[1]["coefficients"];
            float(&wave["frequency"])
                * float(&wave["amplitude"]["re"]).hypot(float(&wave["amplitude"]["im"]))
        };
        let cosine = amplitude * (1.0 - amplitude * amplitude / 8.0).sqrt();
        let fastest = match column {
            "runge_kutta" => (2.0 * (1.0 - amplitude.cos())).sqrt(),
            "paper" => cosine.max(wave(&document["phases"])),
            _ => cosine.max(wave(&document["energy_phases"])),
        };
        close(extreme(orbit.curve(colour), f64::max), fastest, 4.0);
    }
}

#[test]
fn a_simulated_motion_and_where_its_energy_goes() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/simulate/everything.toml");
    let (panels, document) = drawn("simulation", &["simulate", file, "--sample", "0"]);
    let [motion, orbit, energy] = &panels[..] else {
        panic!("{} panels", panels.len());
    };
    let (start, end) = (&document["samples"][0], &document["final_state"]);
    let ends = |points: &[(f64, f64)]| (points[0], points[points.len() - 1]);
    let (first, last) = ends(&motion.curves[0].1);
    close(first.1, float(&start["x"]), 3.0);
    close(last.0, float(&end["t"]), float(&end["t"]));
    close(last.1, float(&end["x"]), 3.0);
    let (first, last) = ends(&orbit.curves[0].1);
    close(first.1, float(&start["velocity"]), 5.0);
    close(last.0, float(&end["x"]), 3.0);
    close(last.1, float(&end["velocity"]), 5.0);
    let book = &document["energy"];
    let curves = [
        (FORMULA, "end"),
        ("#cc79a7", "viscous"),
        ("#e69f00", "friction"),
        ("#009e73", "contact"),
        (SECOND_FORMULA, "excitation"),
    ];
    for (colour, name) in curves {
        let (first, last) = ends(energy.curve(colour));
        close(first.1, if name == "end" { float(&book["start"]) } else { 0.0 }, 4.0);
        close(last.1, float(&book[name]), 4.0);
    }
}

#[test]
fn a_sweep_is_drawn_as_its_rows_say() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/simulate/damper.toml");
    let (panels, document) = drawn("sweep", &["simulate", file, "--sweep", "zeta=0.01:0.05:5"]);
    let rows = document["rows"].as_array().expect("rows");
    for (title, key) in [
        ("Rest time", "rest_time"),
        ("Impacts", "impacts"),
        ("Deepest penetration", "penetration"),
        ("Energy lost in contact", "energy_lost"),
    ] {
        let panel = panels.iter().find(|panel| panel.title == title).expect(title);
        let points = &panel.curves[0].1;
        assert_eq!(points.len(), rows.len());
        let values: Vec<f64> = rows.iter().map(|row| float(&row[key])).collect();
        let largest = values.iter().copied().fold(0.0, f64::max);
        for ((point, row), value) in points.iter().zip(rows).zip(values) {
            close(point.0, float(&row["values"][0]), 0.1);
            close(point.1, value, largest);
        }
    }
}

#[test]
fn a_map_keeps_its_quantity_where_some_motions_lack_it() {
    let path = std::env::temp_dir().join(format!("lindstedt-map-{}.svg", std::process::id()));
    let problem = path.with_extension("toml");
    std::fs::write(&problem, "[pendulum]\namplitude = 0.5\n[run]\nduration = 40\n")
        .expect("a file");
    let (name, file) = (path.to_str().expect("text"), problem.to_str().expect("text"));
    let arguments = ["--sweep", "zeta=0.01:0.2:6", "--sweep", "mu=1e5:1e6:3"];
    let output = Command::new(env!("CARGO_BIN_EXE_lindstedt"))
        .args(["simulate", file, "--format", "json", "--plot", name])
        .args(arguments)
        .output()
        .expect("the program starts");
    assert!(output.status.success());
    let document: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let rows = document["rows"].as_array().expect("rows");
    let restless = rows.iter().filter(|row| row["rest_time"].is_null()).count();
    assert!(restless > 0 && restless < rows.len(), "{restless}");
    let svg = std::fs::read_to_string(&path).expect("the picture");
    let cells: Vec<&str> = svg.lines().filter(|line| line.starts_with("    <rect")).collect();
    assert_eq!(cells.len(), rows.len());
    let grey = cells.iter().filter(|cell| cell.contains("#c8c8c8")).count();
    assert_eq!(grey, restless);
    let caption = format!("Grey: no rest time within the run, {restless} of them.");
    for words in [
        ">Rest time<",
        ">rest time (units of 1/ω)<",
        ">damping ratio ζ<",
        "ζ from 0.01 to 0.2 and μ from 100000 to 1e6",
        &caption,
    ] {
        assert!(svg.contains(words), "{words}");
    }
    for file in [path, problem] {
        std::fs::remove_file(file).expect("the file goes");
    }
}

#[test]
fn the_energy_is_drawn_as_closely_as_the_motion() {
    // A plain pendulum takes some steps of the length of a swing: between them the work of damping
    // bends.
    let path = std::env::temp_dir().join(format!("lindstedt-energy-{}.toml", std::process::id()));
    std::fs::write(
        &path,
        "[pendulum]\nbarrier = 3.0\n[damping]\nzeta = 0.2\n[run]\nduration = 20\n",
    )
    .expect("a file");
    let (panels, _) = drawn("energy", &["simulate", path.to_str().expect("text")]);
    let [motion, _, energy] = &panels[..] else {
        panic!("{} panels", panels.len());
    };
    let motion = motion.curves[0].1.len();
    for (colour, points) in &energy.curves {
        assert!(points.len() >= motion, "{colour}: {} points beside {motion}", points.len());
    }
    std::fs::remove_file(path).expect("the file goes");
}

#[test]
fn the_cells_of_a_map_stand_at_their_parameters() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/simulate/damper.toml");
    let axes = ["--sweep", "zeta=0.01:0.03:3", "--sweep", "barrier=0.2:0.5:4"];
    let (svg, document) = picture("map", &[&["simulate", file], &axes[..]].concat());
    let inside =
        svg.split_once("clip-path=").expect("cells").1.split_once("</g>").expect("cells").0;
    let cells: Vec<&str> = inside.lines().filter(|line| line.contains("<rect")).collect();
    let rows = document["rows"].as_array().expect("rows");
    assert_eq!(cells.len(), rows.len());
    // Every tick stands at the middle of a cell that has its value, or between two.
    let ticks = |anchor: &str, place: &str| -> Vec<(f64, f64)> {
        let texts = svg.lines().map(str::trim).filter(|line| line.starts_with("<text"));
        let own = texts.filter(|line| {
            attribute(line, "text-anchor") == Some(anchor)
                && attribute(line, "font-size") == Some("12")
        });
        own.map(|line| {
            let text = line.split_once('>').expect("a text").1.trim_end_matches("</text>");
            (number(line, place), text.parse().expect("a number"))
        })
        .collect()
    };
    let (across, down) = (scale(&ticks("middle", "x")), scale(&ticks("end", "y")));
    let half = |cell: &str, size: &str| 0.5 * number(cell, size);
    // The greatest value has the brightest colour, the smallest the darkest, wherever they stand.
    let place = |cell: &&str| {
        let zeta = down(number(cell, "y") + half(cell, "height"));
        (zeta, across(number(cell, "x") + half(cell, "width")))
    };
    let values: Vec<f64> = rows.iter().map(|row| float(&row["rest_time"])).collect();
    for (colour, value) in [
        ("#fde725", values.iter().copied().fold(f64::MIN, f64::max)),
        ("#440154", values.iter().copied().fold(f64::MAX, f64::min)),
    ] {
        let cell =
            cells.iter().find(|cell| attribute(cell, "fill") == Some(colour)).expect("a cell");
        let row = values.iter().position(|known| *known == value).expect("a row");
        let expected = &rows[row]["values"];
        let (zeta, barrier) = place(cell);
        // The text of a tick stands a little below it.
        assert!((zeta - float(&expected[0])).abs() < 1e-3, "{zeta} {expected}");
        assert!((barrier - float(&expected[1])).abs() < 2e-3, "{barrier} {expected}");
    }
}
