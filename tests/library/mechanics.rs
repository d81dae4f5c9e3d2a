//! Lagrange's equations held against equations derived by hand, against energy, and against modes
//! known in closed form.

use std::collections::BTreeMap;

use lindstedt::audit::paper;
use lindstedt::expr::{CompiledFunction, Expr, parse_expression};
use lindstedt::mechanics::{
    Dimension, DriveAtRest, Groups, MechanicsError, Mechanism, MechanismQuestion, Modes,
    RestPosition, equilibria, study,
};
use lindstedt::problem::Problem;
use lindstedt::system::Integrator;
use lindstedt::trajectory::TrajectoryRequest;
use lindstedt::{Oscillator, Symbol};

fn expression(text: &str) -> Expr {
    parse_expression(text).unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn example(name: &str) -> Problem {
    let path = format!("{}/examples/lagrange/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).expect("an example").parse().expect("a problem")
}

/// Numbers that are like no others, the same on every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        0.2 + (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Both sides at random points, all symbols between 0.2 and 1.2: a difference is a difference of
/// the formulas.
fn assert_same(derived: &Expr, by_hand: &Expr) {
    let names: Vec<Symbol> =
        (derived - by_hand).symbols().into_iter().chain(derived.symbols()).collect();
    let [one, two] =
        [derived, by_hand].map(|side| CompiledFunction::new(side, &names).expect("a function"));
    let mut random = Random(7);
    for _ in 0..200 {
        let point: Vec<f64> = {
            let mut values: BTreeMap<Symbol, f64> = BTreeMap::new();
            names.iter().map(|name| *values.entry(*name).or_insert_with(|| random.next())).collect()
        };
        let (one, two) = (one.call(&point), two.call(&point));
        assert!(
            (one - two).abs() <= 1e-12 * (1.0 + one.abs()),
            "{derived}\n{by_hand}: {one} {two}"
        );
    }
}

/// The textbooks' equations: Landau and Lifshitz, *Mechanics*, section 5, for the double pendulum's
/// energies; the equations by hand.
#[test]
fn equations_are_those_derived_by_hand() {
    let cases: [(&str, &[&str]); 5] = [
        (
            "double-pendulum",
            &[
                "(m1 + m2)*l1*a'' + m2*l2*b''*cos(a - b) + m2*l2*b'^2*sin(a - b) + (m1 + m2)*g*sin(a)",
                "l2*b'' + l1*a''*cos(a - b) - l1*a'^2*sin(a - b) + g*sin(b)",
            ],
        ),
        (
            "spring-pendulum",
            &["m*r'' - m*r*x'^2 - m*g*cos(x) + k*(r - L)", "r^2*x'' + 2*r*r'*x' + g*r*sin(x)"],
        ),
        (
            "cart-pendulum",
            &[
                "(M + m)*s'' + m*L*x''*cos(x) - m*L*x'^2*sin(x) + c*s'",
                "m*L^2*x'' + m*L*s''*cos(x) + m*g*L*sin(x) + b*x'",
            ],
        ),
        ("rotating-pendulum", &["x'' + g/L*sin(x) - Omega^2*sin(x)*cos(x)"]),
        ("bead-on-a-hoop", &["u'' + c/m*u' + g/R*sin(u) - Omega^2*cos(u)*(e/R + sin(u))"]),
    ];
    for (name, by_hand) in cases {
        let equations = example(name)
            .mechanism()
            .expect("a mechanism")
            .mechanism
            .equations()
            .expect("equations");
        assert_eq!(equations.left.len(), by_hand.len());
        for (derived, by_hand) in equations.left.iter().zip(by_hand) {
            assert_same(derived, &expression(by_hand));
        }
    }
}

/// What is derived keeps the energy of what it was derived from, and two integrators agree on it.
#[test]
fn energy_is_kept_by_what_is_derived() {
    for (name, start) in [
        ("double-pendulum", "a=1.5,b=-0.5"),
        ("spring-pendulum", "r=1.5,x=0.3"),
        ("cart-pendulum", "x=1.2"),
        ("rotating-pendulum", "x=0.4"),
        ("driven-masses", "p=0.1"),
    ] {
        let problem = example(name);
        let mut course = problem.course().expect("a course");
        course.values = problem.exact_values().expect("values").numbers();
        course.duration = 20.0;
        for part in start.split(',') {
            let (name, value) = part.split_once('=').expect("a start");
            course.begin(Symbol::new(name), value.parse().expect("a number")).expect("a state");
        }
        let motion = course.clone().follow().expect("a motion");
        assert!(motion.is_complete());
        let balance = motion.balance.clone().expect("an energy");
        assert!(balance.residual < 1e-12, "{name}: {balance:?}");
        let conservative =
            ["double-pendulum", "spring-pendulum", "rotating-pendulum"].contains(&name);
        assert_eq!(balance.work == 0.0, conservative, "{name}: {balance:?}");
        let judge = course.follow_by(Integrator::RungeKutta).expect("a motion");
        assert!(motion.difference(&judge) < 1e-6, "{name}: {}", motion.difference(&judge));
    }
}

/// Two equal masses on three equal springs: omega^2 = k/m and 3 k/m. Two equal links: omega^2 =
/// (2 -+ sqrt 2) g/l.
#[test]
fn modes_are_those_of_the_textbooks() {
    let modes = |name: &str, values: &[(&str, f64)]| {
        let equations = example(name).mechanism().unwrap().mechanism.equations().unwrap();
        let rest = &equilibria(&equations).unwrap()[0];
        let values = values.iter().map(|(name, value)| (Symbol::new(name), *value)).collect();
        Modes::about_rest(&equations, rest).unwrap().numbers(&values).unwrap()
    };
    let links = modes(
        "double-pendulum",
        &[("m1", 2.0), ("m2", 2.0), ("l1", 0.5), ("l2", 0.5), ("g", 9.81)],
    );
    for (mode, sign) in links.iter().zip([-1.0, 1.0]) {
        let square = (2.0 + sign * 2.0_f64.sqrt()) * 9.81 / 0.5;
        assert!((mode.frequency.powi(2) / square - 1.0).abs() < 1e-13 && mode.growth == 0.0);
        let shape = mode.shape.as_ref().expect("a shape");
        assert!((shape[1] / shape[0] + sign * 2.0_f64.sqrt()).abs() < 1e-12, "{shape:?}");
    }
    let masses = modes("driven-masses", &[("m", 0.5), ("k", 8.0), ("c", 0.0)]);
    assert!(
        (masses[0].frequency - 4.0).abs() < 1e-13
            && (masses[1].frequency - 48.0_f64.sqrt()).abs() < 1e-13
    );
    // Both damped alike: lambda = -c/2m +- i sqrt(omega^2 - (c/2m)^2).
    let masses = modes("driven-masses", &[("m", 0.5), ("k", 8.0), ("c", 1.0)]);
    for (mode, square) in masses.iter().zip([16.0, 48.0]) {
        assert!(
            (mode.growth + 1.0).abs() < 1e-12
                && (mode.frequency.powi(2) - square + 1.0).abs() < 1e-11,
            "{mode:?}"
        );
    }
    // A cart that rolls freely, a pendulum on it: omega^2 = (1 + m/M) g/L without friction.
    let cart = modes(
        "cart-pendulum",
        &[("m", 1.0), ("M", 2.0), ("L", 0.3), ("g", 9.81), ("c", 0.0), ("b", 0.0)],
    );
    assert_eq!((cart[0].frequency, cart[0].growth), (0.0, 0.0));
    assert!((cart[1].frequency.powi(2) / (1.5 * 9.81 / 0.3) - 1.0).abs() < 1e-13);
}

#[test]
fn places_of_rest_are_exact() {
    let places = |name: &str| {
        let mechanism = example(name).mechanism().unwrap().mechanism;
        let equations = mechanism.equations().unwrap();
        let found = equilibria(&equations).unwrap();
        for rest in &found {
            // Put in, every force vanishes: at random numbers, for the formulas have acos in them.
            let mut values: BTreeMap<Symbol, f64> = BTreeMap::new();
            let mut random = Random(3);
            for name in mechanism.parameters() {
                values.insert(name, 0.5 + random.next());
            }
            values.insert(Symbol::new("Omega"), 9.0);
            values.insert(Symbol::new("t"), 0.0);
            values.insert(Symbol::new("F"), 0.0);
            let mut state = values.clone();
            for (coordinate, place) in rest.values(&equations.coordinates) {
                state.insert(coordinate, place.evaluate(&values).unwrap());
                state.insert(coordinate.derivative(), 0.0);
            }
            for force in &equations.rest {
                assert!(force.evaluate(&state).unwrap().abs() < 1e-13, "{name}: {rest:?} {force}");
            }
        }
        found
    };
    assert_eq!(places("double-pendulum").len(), 4);
    assert_eq!(places("spring-pendulum").len(), 2);
    assert_eq!(places("rotating-pendulum").len(), 4);
    assert_eq!(places("cart-pendulum")[0].places[0], RestPosition::Anywhere);
    assert!(places("bead-on-a-hoop").is_empty());
    assert_eq!(places("driven-masses").len(), 1);
}

/// The dimensionless equation in its groups is the equation itself: numbers put into either give
/// the same accelerations.
#[test]
fn groups_leave_the_motion_as_it_is() {
    for name in [
        "cart-pendulum",
        "double-pendulum",
        "bead-on-a-hoop",
        "rotating-pendulum",
        "spring-pendulum",
    ] {
        let question = example(name).mechanism().unwrap();
        let units = question.units.expect("units");
        let mechanism = question.mechanism;
        let equations = mechanism.equations().unwrap();
        let groups = Groups::from_mechanism(&mechanism, &equations, &units).unwrap();
        let mut random = Random(11);
        let parameters: BTreeMap<Symbol, f64> =
            equations.parameters().into_iter().map(|name| (name, random.next())).collect();
        let time = groups.time.evaluate(&parameters).unwrap();
        for group in &groups.groups {
            assert!(group.dimension.is_none(), "{name}: {group:?}");
        }
        let mut scaled: BTreeMap<Symbol, f64> = groups
            .groups
            .iter()
            .map(|group| (group.name, group.definition.evaluate(&parameters).unwrap()))
            .collect();
        let mut state = parameters.clone();
        for (coordinate, length) in equations.coordinates.iter().zip(&groups.lengths) {
            let length = length.evaluate(&parameters).unwrap();
            for (derivatives, symbol) in
                [*coordinate, coordinate.derivative(), coordinate.derivative().derivative()]
                    .into_iter()
                    .enumerate()
            {
                let value = random.next();
                scaled.insert(symbol, value);
                state.insert(symbol, value * length / time.powi(derivatives as i32));
            }
        }
        // Each equation up to the unit of its own terms, the same for every state.
        let other = |seed: u64| {
            let mut random = Random(seed);
            let (mut state, mut scaled) = (state.clone(), scaled.clone());
            for (coordinate, length) in equations.coordinates.iter().zip(&groups.lengths) {
                let length = length.evaluate(&parameters).unwrap();
                let value = random.next();
                scaled.insert(coordinate.derivative(), value);
                state.insert(coordinate.derivative(), value * length / time);
            }
            let ratio = |index: usize| {
                groups.left[index].evaluate(&scaled).unwrap()
                    / equations.left[index].evaluate(&state).unwrap()
            };
            (0..equations.left.len()).map(ratio).collect::<Vec<f64>>()
        };
        for (one, two) in other(1).iter().zip(other(2)) {
            assert!((one / two - 1.0).abs() < 1e-11 && one.is_finite(), "{name}: {one} {two}");
        }
    }
}

/// Parameters that enter in a sum alone count as one, and cancel as one: a ball that rolls in a
/// bowl has no number left, as its equation divided by its inertia by hand shows. Where one of them
/// stands elsewhere, too, both count.
#[test]
fn parameters_that_enter_in_one_sum_count_as_one() {
    let units = |list: &str| -> BTreeMap<Symbol, Dimension> {
        let pair = |pair: &str| {
            let (name, unit) = pair.split_once(':').expect("a unit");
            (Symbol::new(name), unit.parse().expect("a unit"))
        };
        list.split(' ').map(pair).collect()
    };
    let ball = "phi:rad m:kg R:m r:m g:m/s^2";
    let masses = "x:m m1:kg m2:kg k1:N/m k2:N/m k3:N/m^3";
    for (coordinate, kinetic, potential, list, sums, equation, square, form) in [
        (
            "phi",
            "7*m*(R - r)^2*phi'^2/10",
            "-m*g*(R - r)*cos(phi)",
            ball,
            &["R - r"][..],
            "phi'' + 5*g*sin(phi)/(7*(R - r)) = 0",
            "5*g/(7*(R - r))",
            "phi'' + 5*sin(phi)/7",
        ),
        // One of them written out.
        (
            "phi",
            "7*m*(R^2 - 2*R*r + r^2)*phi'^2/10",
            "-m*g*(R - r)*cos(phi)",
            ball,
            &["R - r"],
            "phi'' + 5*g*sin(phi)/(7*(R - r)) = 0",
            "5*g/(7*(R - r))",
            "phi'' + 5*sin(phi)/7",
        ),
        (
            "x",
            "(m1 + m2)*x'^2/2",
            "(k1 + k2)*x^2/2 + k3*x^4/4",
            masses,
            &["m1 + m2", "k1 + k2"],
            "x'' + x*(k1 + k2)/(m1 + m2) + k3*x^3/(m1 + m2) = 0",
            "(k1 + k2)/(m1 + m2)",
            "x'' + x + x^3",
        ),
    ] {
        let mechanism = Mechanism::parse(&[coordinate], kinetic, potential).unwrap();
        let equations = mechanism.equations().unwrap();
        assert_eq!(equations.to_string(), equation);
        let rests = equilibria(&equations).unwrap();
        let found =
            Modes::about_rest(&equations, &rests[0]).unwrap().square().unwrap().expect("omega^2");
        assert_eq!(found.to_string(), square);
        let groups = Groups::from_mechanism(&mechanism, &equations, &units(list)).unwrap();
        let found: Vec<String> =
            groups.combinations.iter().map(|sum| sum.meaning.to_string()).collect();
        assert_eq!(found, sums);
        assert!(groups.groups.is_empty() && groups.parameters == groups.rank, "{groups:?}");
        assert_eq!(groups.left[0].to_string(), form);
    }
    for (kinetic, potential) in
        [("(m1 + m2)*x'^2/2", "k1*x^2/2 + m1*g*x"), ("m1*x'^2/2", "(k1 + k2)*x^2/2 + k1*x^4/4")]
    {
        let equations = Mechanism::parse(&["x"], kinetic, potential).unwrap().equations().unwrap();
        assert!(equations.combinations.is_empty(), "{equations}");
    }
}

/// What nothing linear pulls back does not move freely, and what shakes the pivot of a pendulum
/// leaves it its places of rest.
#[test]
fn a_rest_without_a_linear_force_is_not_called_free() {
    let printed = |coordinate: &str, kinetic: &str, potential: &str, values: &[(&str, f64)]| {
        let question = MechanismQuestion {
            mechanism: Mechanism::parse(&[coordinate], kinetic, potential).unwrap(),
            units: None,
            values: values.iter().map(|(name, value)| (Symbol::new(name), *value)).collect(),
        };
        let study = study(question).unwrap();
        let text = lindstedt::export::text::document(&lindstedt::report::mechanism(&study), 120);
        (study.rests.iter().map(|rest| rest.drive).collect::<Vec<_>>(), text)
    };
    let quartic = ("x", "m*x'^2/2", "k3*x^4/4");
    for values in [&[][..], &[("m", 1.0), ("k3", 2.0)]] {
        let (drive, text) = printed(quartic.0, quartic.1, quartic.2, values);
        assert_eq!(drive, [DriveAtRest::Absent]);
        assert!(!text.contains("freely") && text.contains("no linear force"), "{text}");
    }
    let (_, text) = printed("x", "m*x'^2/2", "0", &[("m", 1.0)]);
    assert!(text.contains("moves freely\n"), "{text}");
    // Held by what swings in time alone.
    let (drive, text) =
        printed("x", "m*x'^2/2", "k*cos(W*t)*x^2/2", &[("m", 1.0), ("k", 1.0), ("W", 2.0)]);
    assert_eq!(drive, [DriveAtRest::Acts]);
    assert!(text.contains("freely where nothing that is left out acts"), "{text}");
    // Kapitza's pendulum rests upright and hanging; pushed sideways it does not.
    let upwards = "m*L^2*phi'^2/2 - m*L*a*W*sin(W*t)*sin(phi)*phi'";
    let (drive, text) = printed("phi", upwards, "-m*g*L*cos(phi)", &[]);
    assert_eq!(drive, [DriveAtRest::Vanishes; 2]);
    assert!(
        text.contains("at rest there with the terms in t, too") && !text.contains("no such rest"),
        "{text}"
    );
    let sideways = "m*L^2*phi'^2/2 - m*L*a*W*sin(W*t)*cos(phi)*phi'";
    let (drive, text) = printed("phi", sideways, "-m*g*L*cos(phi)", &[]);
    assert_eq!(drive, [DriveAtRest::Acts; 2]);
    assert!(text.contains("no such rest"), "{text}");
}

#[test]
fn the_papers_equations_are_found_right_and_wrong() {
    let findings = paper::findings().unwrap();
    let wrong: Vec<&str> = findings
        .iter()
        .filter(|finding| finding.agrees == Some(false))
        .map(|finding| finding.equation.as_str())
        .collect();
    assert_eq!(wrong, ["(1)", "(5)"]);
    // The built-in mechanism is the one of the example.
    let question = example("pendulum-and-barrier").mechanism().unwrap();
    assert_eq!(question.mechanism, paper::pendulum());
    assert_eq!(question.units, Some(paper::units()));
}

#[test]
fn a_contact_is_followed_through_its_touches() {
    let problem = example("pendulum-and-barrier");
    let mut course = problem.course().unwrap();
    for (name, value) in [
        ("m", 1.0),
        ("L", 1.0),
        ("l", 1.0),
        ("R", 0.01),
        ("E", 1e6),
        ("g", 9.81),
        ("Ae", 0.0),
        ("Omega", 1.0),
        ("c", 0.0),
        ("F", 0.0),
        ("mu4", 0.0),
        ("xc", 0.3),
    ] {
        course.values.insert(Symbol::new(name), value);
    }
    course.begin("x".into(), -1.5).unwrap();
    course.duration = 10.0;
    let motion = course.follow().unwrap();
    assert!(motion.is_complete(), "{:?} at {}", motion.reason(), motion.end());
    assert!(motion.balance.as_ref().expect("an energy").residual < 1e-9, "{:?}", motion.balance);
}

#[test]
fn what_is_no_mechanism_is_refused() {
    let refused = |coordinates: &[&str], kinetic: &str, potential: &str| {
        Mechanism::parse(coordinates, kinetic, potential)
            .and_then(|mechanism| mechanism.equations())
            .unwrap_err()
            .to_string()
    };
    for (coordinates, kinetic, potential, words) in [
        (&["x"][..], "m*y'^2/2", "0", "`y'`: no coordinate"),
        (&["x", "y"], "m*x'^2/2", "k*y^2/2", "does not contain `y'`"),
        (&["x"], "m*x'^2/2", "k*x'*x", "a potential depends on coordinates alone"),
        (&["x"], "m*x''^2/2", "0", "`x''`"),
        (&["x", "x"], "m*x'^2/2", "0", "twice"),
        (&[], "0", "0", "1 to 8 coordinates"),
        (&["x", "y"], "m*(x' + y')^2/2", "0", "singular"),
        (&["x"], "m*x'^2/2", "k*H(x - 1)", "jumps with `H(x - 1)`"),
        (&["x"], "m*(1 + H(x))*x'^2/2", "0", "jumps"),
        (&["t"], "m*t^2/2", "0", "`t` cannot be a coordinate"),
        (&["x"], "m*x'", "k*x^2", "singular"),
    ] {
        let message = refused(coordinates, kinetic, potential);
        assert!(message.contains(words), "{kinetic}: {message}");
    }
    assert!(matches!(Mechanism::parse(&["x"], "m*(", "0"), Err(MechanicsError::Parse { .. })));
    // A unit that is missing, and one that is not used.
    let pendulum = Mechanism::parse(&["x"], "m*L^2*x'^2/2", "-m*g*L*cos(x)").unwrap();
    let units = |names: &[(&str, &str)]| -> BTreeMap<Symbol, Dimension> {
        names.iter().map(|(name, unit)| (Symbol::new(name), unit.parse().unwrap())).collect()
    };
    let message = pendulum
        .check_units(&units(&[("x", "1"), ("m", "kg"), ("L", "m")]))
        .unwrap_err()
        .to_string();
    assert_eq!(message, "`g` has no unit");
    let all = [("x", "1"), ("m", "kg"), ("L", "m"), ("g", "m/s^2"), ("k", "N/m")];
    assert!(pendulum.check_units(&units(&all)).unwrap_err().to_string().contains("`k`"));
    assert!(pendulum.check_units(&units(&all[..4])).is_ok());
}

/// One coordinate: what is derived is an oscillator like any other.
#[test]
fn a_derived_equation_is_handed_on() {
    let problem = example("pendulum");
    let equation = problem.equation.clone().expect("an equation");
    assert_eq!(
        Oscillator::parse(&equation).expect("an oscillator").force.to_string(),
        "g*sin(x)/L"
    );
    let course = TrajectoryRequest::of_equation(&Oscillator::parse(&equation).unwrap());
    assert_eq!(course.parameters(), vec![Symbol::new("L"), Symbol::new("g")]);
}

/// Dry friction that sticks and lets go, held against the simulator of equation (7), which has its
/// own way of doing it.
#[test]
fn a_driven_motion_sticks_and_lets_go() {
    use lindstedt::impact::{Integrator as Route, Model, Settings, Start, simulate};
    let equation = "x'' + alpha*sgn(x') + sin(x) - beta*sin(eta*t)*cos(x) = 0";
    for (alpha, beta, eta) in
        [(0.3, 0.5, 0.35), (0.2, 0.25, 0.8), (0.5, 0.9, 0.3), (0.1, 0.05, 1.1)]
    {
        let model = Model { alpha, beta, frequency_ratio: eta, right: None, ..Model::default() };
        let settings = Settings { duration: 80.0, ..Settings::default() };
        let truth = simulate(&model, Start { x: 0.6, velocity: 0.0 }, Route::Taylor, &settings)
            .expect("a motion");
        let mut course =
            TrajectoryRequest::of_equation(&Oscillator::parse(equation).expect("an oscillator"));
        course.values = [("alpha", alpha), ("beta", beta), ("eta", eta)]
            .map(|(name, value)| (Symbol::new(name), value))
            .into();
        course.begin("x".into(), 0.6).expect("a state");
        course.duration = 80.0;
        let motion = course.follow().expect("a motion");
        assert!(motion.is_complete(), "{:?} at {}", motion.reason(), motion.end());
        for index in 0..=800 {
            let t = 0.1 * f64::from(index);
            let (x, _) = truth.path.phase_point_at(t).expect("a state");
            let own = motion.states_at(t).expect("a state")[0];
            assert!((own - x).abs() < 1e-8, "{alpha} {beta} {eta} at {t}: {own} {x}");
        }
        assert!(
            motion.sticking_intervals().count() > 2 || beta < alpha,
            "{:?}",
            motion.sticking_intervals().collect::<Vec<_>>()
        );
    }
}

fn mechanism(
    [kinetic, potential, dissipation]: [&str; 3],
    forces: &[(&str, &str)],
    start: &[(&str, f64)],
    duration: f64,
) -> TrajectoryRequest {
    let mut mechanism = Mechanism::parse(&["x", "y"], kinetic, potential).expect("a mechanism");
    mechanism.dissipation = expression(dissipation);
    mechanism.forces =
        forces.iter().map(|(name, force)| (Symbol::new(name), expression(force))).collect();
    let equations = mechanism.equations().expect("equations");
    let mut course = TrajectoryRequest::of_mechanism(&mechanism, &equations).expect("a course");
    for (name, value) in start {
        course.begin(Symbol::new(name), *value).expect("a state");
    }
    course.duration = duration;
    course
}

fn followed(course: TrajectoryRequest) -> lindstedt::trajectory::Trajectory {
    let motion = course.follow().expect("a motion");
    assert!(motion.is_complete(), "{:?} at {}", motion.reason(), motion.end());
    let residual = motion.balance.as_ref().expect("a balance").residual;
    assert!(residual < 1e-9, "{residual}");
    motion
}

/// Parts of a system that friction holds while the rest goes on, in closed form: one of two blocks,
/// two blocks on each other, a block on a belt.
#[test]
fn friction_holds_one_of_several_coordinates() {
    // The spring between them, 1/2 times y, is too weak for the friction of 2/5: y'' + 3/2 y = 0.
    let blocks = ["(x'^2 + y'^2)/2", "(x^2 + y^2)/2 + (x - y)^2/4", "2/5*abs(x')"];
    let motion = followed(mechanism(blocks, &[], &[("y", 0.79)], 40.0));
    assert_eq!(motion.sticking_intervals().collect::<Vec<_>>(), [[0.0, 40.0]]);
    for index in 0..=400 {
        let t = 0.1 * f64::from(index);
        let state = motion.states_at(t).expect("a state");
        assert_eq!((state[0], state[2]), (0.0, 0.0));
        assert!((state[1] - 0.79 * (1.5_f64.sqrt() * t).cos()).abs() < 1e-12, "{t}: {state:?}");
    }
    // Only just too strong: let go where y/2 = 2/5.
    let motion = followed(mechanism(blocks, &[], &[("y", 0.7), ("y'", 0.7)], 40.0));
    let size = (0.49 + 0.49 / 1.5_f64).sqrt();
    let phase = (0.7 / 1.5_f64.sqrt()).atan2(0.7);
    let let_go = (phase - (0.8 / size).acos()) / 1.5_f64.sqrt();
    let [from, until] = motion.sticking_intervals().next().expect("a hold");
    assert!(from == 0.0 && (until - let_go).abs() < 1e-12, "{until} {let_go}");
    assert!(motion.states_at(until + 0.3).expect("a state")[0] > 1e-4);
    // Three quarters of the mass ride on the rest: 4 x'' + x = 0 while 3 |x''| <= 1/2.
    let riding = ["x'^2/2 + 3*y'^2/2", "x^2/2", "abs(x' - y')/2"];
    let motion = followed(mechanism(riding, &[], &[("x", 0.6), ("y", 0.1)], 30.0));
    for index in 0..=300 {
        let t = 0.1 * f64::from(index);
        let (state, wave) = (motion.states_at(t).expect("a state"), (0.5 * t).cos());
        assert!(
            (state[0] - 0.6 * wave).abs() < 1e-12 && (state[1] - 0.6 * wave + 0.5).abs() < 1e-12,
            "{t}"
        );
    }
    // Twice that is too much at the turning points: x'' + x = -1/2 sgn(x' - y') until both are
    // equally fast.
    let motion = followed(mechanism(riding, &[], &[("x", 1.2)], 30.0));
    assert!(
        motion.sticking_intervals().all(|[from, until]| from > 0.0 && until > from)
            && motion.sticking_intervals().count() > 0
    );
    // On a belt it is carried until the spring is too strong, and then swings about where friction
    // alone would hold it: it comes back to the speed of the belt once a period, and touches it.
    let mut course = TrajectoryRequest::of_equation(
        &Oscillator::parse("x'' + x + alpha*sgn(x' - 1/2) = 0").expect("an equation"),
    );
    course.begin("x'".into(), 0.5).expect("a state");
    course.values = [("alpha".into(), 0.3)].into();
    course.duration = 40.0;
    let motion = followed(course);
    for index in 0..=400 {
        let t = 0.1 * f64::from(index);
        let carried = if t < 0.6 { 0.5 * t } else { 0.3 + 0.5 * (t - 0.6).sin() };
        let x = motion.states_at(t).expect("a state")[0];
        assert!((x - carried).abs() < 1e-7, "{t}: {x} {carried}");
    }
}

/// Two masses by time stepping, the friction implicit: in every step the impulses of friction on
/// x', y' and x' - y' are projected on their bounds until the velocities fit (Moreau 1988), the
/// rest is the midpoint rule. Answers x, y at the end of every hundredth of time.
fn time_stepping(
    mass: [f64; 2],
    bounds: [f64; 3],
    belt: f64,
    force: impl Fn(f64, [f64; 2], [f64; 2]) -> [f64; 2],
    (mut place, mut speed): ([f64; 2], [f64; 2]),
    until: f64,
) -> Vec<[f64; 2]> {
    const STEPS: u32 = 100;
    let step = 0.01 / f64::from(STEPS);
    let mut places = vec![place];
    let mut impulse = [0.0_f64; 3];
    for index in 0..(until * 100.0).round() as u32 * STEPS {
        let middle = (f64::from(index) + 0.5) * step;
        let half = [0, 1].map(|body| place[body] + 0.5 * step * speed[body]);
        let push = force(middle, half, speed);
        let free = [0, 1].map(|body| speed[body] + step * push[body] / mass[body]);
        let velocity = |impulse: [f64; 3]| {
            [
                free[0] + (impulse[0] + impulse[2]) / mass[0],
                free[1] + (impulse[1] - impulse[2]) / mass[1],
            ]
        };
        for _ in 0..60 {
            let before = impulse;
            for (contact, inertia) in
                [mass[0], mass[1], mass[0] * mass[1] / (mass[0] + mass[1])].into_iter().enumerate()
            {
                let now = velocity(impulse);
                let slip = [now[0] - belt, now[1], now[0] - now[1]][contact];
                let bound = step * bounds[contact];
                impulse[contact] = (impulse[contact] - inertia * slip).clamp(-bound, bound);
            }
            if before == impulse {
                break;
            }
        }
        let now = velocity(impulse);
        place = [0, 1].map(|body| half[body] + 0.5 * step * now[body]);
        speed = now;
        if (index + 1).is_multiple_of(STEPS) {
            places.push(place);
        }
    }
    places
}

/// Stick and slip of two driven masses with friction under one, under both and between them, and on
/// a belt, beside time stepping.
#[test]
fn stick_and_slip_of_several_coordinates_is_that_of_time_stepping() {
    let mut held = 0;
    for (mass, bounds, belt, drive, eta) in [
        ([1.0, 1.0], [0.3, 0.0, 0.0], 0.0, 0.8, 0.7),
        ([1.0, 2.0], [0.25, 0.4, 0.0], 0.0, 1.1, 0.6),
        ([2.0, 0.5], [0.0, 0.0, 0.35], 0.0, 0.9, 1.3),
        ([1.5, 1.0], [0.2, 0.0, 0.3], 0.0, 1.4, 0.9),
        ([1.0, 1.0], [0.5, 0.0, 0.0], 0.4, 0.3, 1.7),
        ([1.0, 0.7], [0.5, 0.1, 0.0], -0.2, 0.6, 0.45),
        // Three frictions may be at rest at once, of two velocities.
        ([1.0, 1.0], [0.2, 0.3, 0.25], 0.0, 1.4, 0.9),
        ([1.5, 0.8], [0.1, 0.2, 0.3], 0.0, 0.9, 0.6),
        ([0.7, 1.2], [0.3, 0.05, 0.15], 0.0, 0.8, 1.2),
    ] {
        let kinetic = format!("{}*x'^2/2 + {}*y'^2/2", mass[0], mass[1]);
        // A friction of zero is none, and holds nothing.
        let dissipation = format!("F*abs(y') + {}*abs(x' - y') + (x'^2 + y'^2)/40", bounds[2]);
        let on_belt = format!("-{}*sgn(x' - ({belt}))", bounds[0]);
        let shake = format!("{drive}*cos({eta}*t)");
        let potential = "x^2/2 + y^2/2 + (x - y)^2/4";
        let mut course = mechanism(
            [&kinetic, potential, &dissipation],
            &[("x", &on_belt), ("y", &shake)],
            &[("x", 0.4), ("y", -0.3)],
            25.0,
        );
        course.values = [("F".into(), bounds[1])].into();
        let motion = followed(course.clone());
        let force = |t: f64, [x, y]: [f64; 2], [u, v]: [f64; 2]| {
            let between = 0.5 * (x - y);
            [-x - between - 0.05 * u, -y + between - 0.05 * v + drive * (eta * t).cos()]
        };
        let truth = time_stepping(mass, bounds, belt, force, ([0.4, -0.3], [0.0; 2]), 25.0);
        for (index, [x, y]) in truth.iter().enumerate() {
            let t = 0.01 * index as f64;
            let state = motion.states_at(t.min(25.0)).expect("a state");
            let apart = (state[0] - x).abs().max((state[1] - y).abs());
            assert!(apart < 5e-4, "{mass:?} {bounds:?} {belt} at {t}: {state:?} {x} {y}");
        }
        held += motion.sticking_intervals().count();
        // The other integrator finds the same.
        course.duration = 6.0;
        let other = course.follow_by(Integrator::RungeKutta).expect("a motion");
        assert!(motion.difference(&other) < 1e-7, "{mass:?} {bounds:?} {belt}");
    }
    assert!(held > 8, "{held}");
}

/// Two bodies on the floor and on each other, one of them pushed by t/10, in closed form: both slip
/// together where the push exceeds what holds both, 1 + 1/10, and apart where (t - 11)/20, the rate
/// of both, needs more than 1/2 between them.
#[test]
fn more_frictions_at_rest_than_velocities() {
    let dissipation = "abs(x') + abs(y')/10 + abs(x' - y')/2";
    let bodies = ["x'^2/2 + y'^2/2", "0", dissipation];
    let motion = followed(mechanism(bodies, &[("x", "t/10")], &[], 25.0));
    let held: Vec<[f64; 2]> = motion.sticking_intervals().collect();
    assert!(matches!(held.as_slice(), [[0.0, apart]] if (apart - 19.0).abs() < 1e-6), "{held:?}");
    for index in 0..=190 {
        let t = 0.1 * f64::from(index);
        let place = (t - 11.0).max(0.0).powi(3) / 120.0;
        let state = motion.states_at(t).expect("a state");
        assert!(
            (state[0] - place).abs() < 1e-9 && (state[1] - place).abs() < 1e-9,
            "{t}: {state:?} {place}"
        );
    }
    // From there on y'' = 2/5 and x'' = t/10 - 3/2.
    let [x, y] = [0, 1].map(|place| motion.states_at(25.0).expect("a state")[place]);
    let (at, speed) = (8.0_f64.powi(3) / 120.0, 64.0 / 40.0);
    let own = |t: f64| t * t * t / 60.0 - 3.0 * t * t / 4.0;
    let from = 19.0 * 19.0 / 20.0 - 1.5 * 19.0;
    assert!((y - (at + 6.0 * speed + 0.2 * 36.0)).abs() < 1e-6, "{y}");
    assert!((x - (at + 6.0 * (speed - from) + own(25.0) - own(19.0))).abs() < 1e-6, "{x}");
}

/// Three balls in a row that touch each other to rounding: 3/10 + 4/10 is 7/10 for people, and more
/// than that by one digit for a sum of doubles. They stay where they are, in a few steps; with the
/// first one pressed into the second the third is pushed away as if it touched exactly.
#[test]
fn balls_that_touch_to_rounding_cost_no_steps() {
    let row = |start: [f64; 3], until: f64| {
        let contacts = "50*max(0, 3/10 - (y - x))^2 + 50*max(0, 3/10 - (z - y))^2";
        let mechanism = Mechanism::parse(&["x", "y", "z"], "(x'^2 + y'^2 + z'^2)/2", contacts)
            .expect("a mechanism");
        let equations = mechanism.equations().expect("equations");
        let mut course = TrajectoryRequest::of_mechanism(&mechanism, &equations).expect("a course");
        for (name, value) in ["x", "y", "z"].into_iter().zip(start) {
            course.begin(Symbol::new(name), value).expect("a state");
        }
        course.duration = until;
        course.step_limit = 500;
        let motion = course.follow().expect("a motion");
        assert!(motion.is_complete(), "{:?} at {}", motion.reason(), motion.end());
        motion.states_at(until).expect("a state")
    };
    let still = row([0.1, 0.4, 0.7], 2.0);
    assert!(
        still.iter().zip([0.1, 0.4, 0.7]).all(|(now, then)| (now - then).abs() < 1e-14),
        "{still:?}"
    );
    // All three in contact: u'' = -100 (2 u - w), w'' = -100 (2 w - u) of both depths, modes 10 and
    // 10 sqrt(3).
    let pressed = row([0.1, 0.2, 0.5], 0.05);
    let [u, w] = [pressed[0] - pressed[1] + 0.3, pressed[1] - pressed[2] + 0.3];
    let [slow, fast] = [10.0_f64, 300.0_f64.sqrt()].map(|rate| 0.1 * (rate * 0.05).cos());
    assert!(
        (u - (slow + fast)).abs() < 1e-12 && (w - (slow - fast)).abs() < 1e-12,
        "{u} {w} {slow} {fast}"
    );
}

/// Kept by hand: a root is opened by its own gate alone, an energy may have steps that vanish where
/// they begin, masses of either sign have a mass matrix, and rigid motions are no growth.
#[test]
fn corners_of_mechanisms() {
    let follow = |equation: &str, start: f64, until: f64| {
        let mut course =
            TrajectoryRequest::of_equation(&Oscillator::parse(equation).expect("an oscillator"));
        course.begin("x".into(), start).expect("a state");
        course.duration = until;
        course.follow().expect("a motion")
    };
    let gated = follow("x'' + x^(1/3)*H(1 - x) = 0", 0.5, 10.0);
    let plain = follow("x'' + x^(1/3) = 0", 0.5, 10.0);
    let [gated, plain] = [&gated, &plain]
        .map(|motion| motion.states_at(motion.end().min(10.0)).expect("a state")[0]);
    assert!((gated - plain).abs() < 1e-6, "{gated} {plain}");
    // Without a gate of its own a root has no value, and the motion ends there.
    assert!(!follow("x'' + 1 + sqrt(x)*H(1 - x) = 0", 0.5, 10.0).is_complete());
    let stop = Mechanism::parse(&["x"], "m*x'^2/2", "k*x^2/2 + c*(x - a)^2*H(x - a)/2").unwrap();
    assert_eq!(stop.equations().unwrap().left[0].to_string().matches("H(").count(), 2);
    let crossed = Mechanism::parse(&["x", "y"], "m*x'*y'", "k*x*y").unwrap();
    let accelerations = crossed.equations().unwrap().accelerations().unwrap();
    assert_same(&accelerations[0], &expression("-k*x/m"));
    // Three masses in a chain that is free at both ends, with dashpots: one rigid motion.
    let mut chain = Mechanism::parse(
        &["x", "y", "z"],
        "150*x'^2 + 20*y'^2 + 125*z'^2",
        "10000*(x - y)^2 + 90000*(y - z)^2",
    )
    .unwrap();
    chain.dissipation = expression("750*(x' - y')^2 + 100*(y' - z')^2");
    let equations = chain.equations().unwrap();
    let rest = &equilibria(&equations).unwrap()[0];
    let modes = Modes::about_rest(&equations, rest).unwrap().numbers(&BTreeMap::new()).unwrap();
    assert!(modes.iter().all(|mode| mode.growth <= 0.0), "{modes:?}");
    assert_eq!((modes[0].frequency, modes[0].growth), (0.0, 0.0));
    // Anywhere along a rod: the swing depends on where, and says so.
    let rod =
        Mechanism::parse(&["s", "x"], "m*s'^2/2 + (I + m*s^2)*x'^2/2", "-M*g*L*cos(x)").unwrap();
    let equations = rod.equations().unwrap();
    let rest = &equilibria(&equations).unwrap()[0];
    assert_eq!(Modes::about_rest(&equations, rest).unwrap().taken_at_zero, [Symbol::new("s")]);
    // Duffing's spring rests at zero.
    let duffing =
        Mechanism::parse(&["x"], "m*x'^2/2", "k*x^2/2 + b*x^4/4").unwrap().equations().unwrap();
    assert_eq!(equilibria(&duffing).unwrap()[0].places, [RestPosition::At(Expr::zero())]);
}

/// A mechanism that changes with the time other than by sines and cosines has no modes; what a
/// drive adds is left out of inertia, damping and stiffness alike.
#[test]
fn a_mechanism_that_changes_with_the_time_has_no_modes() {
    let hanging = |kinetic: &str, potential: &str| {
        let equations = Mechanism::parse(&["x"], kinetic, potential).unwrap().equations().unwrap();
        let rest = equilibria(&equations).unwrap().swap_remove(0);
        Modes::about_rest(&equations, &rest).unwrap()
    };
    let numbers: BTreeMap<Symbol, f64> =
        ["m", "L", "g", "v", "a", "k", "c", "W"].map(|name| (Symbol::new(name), 1.5)).into();
    for (kinetic, potential) in [
        ("m*(L + v*t)^2*x'^2/2", "-m*g*(L + v*t)*cos(x)"),
        ("m*L^2*exp(c*t)*x'^2/2", "-m*g*L*exp(c*t)*cos(x)"),
        ("m*x'^2/2", "k*exp(-c*t)*x^2/2"),
        ("m*x'^2/2", "k*(1 + v*t)*x^2/2"),
        ("m*x'^2/2", "k*x^2/2/(L + a*cos(W*t))"),
        ("(m + v*t)*x'^2/2", "k*x^2/2"),
        ("m*x'^2/2", "k*x^2*sqrt(1 + t^2)/2"),
    ] {
        let modes = hanging(kinetic, potential);
        assert!(modes.changing.is_some(), "{kinetic}, {potential}");
        assert_eq!(modes.square().unwrap(), None, "{kinetic}, {potential}");
        let reason = modes.numbers(&numbers).unwrap_err().to_string();
        assert!(reason.contains("changes with the time"), "{reason}");
    }
    // omega^2 of the mechanism with its drive at rest, whether that shakes the pivot or the length.
    for (kinetic, potential, square) in [
        ("m*(L + a*cos(W*t))^2*x'^2/2", "-m*g*(L + a*cos(W*t))*cos(x)", "g/L"),
        ("m*(L^2*x'^2 - 2*a*W*L*x'*sin(W*t)*sin(x))/2", "-m*g*L*cos(x)", "g/L"),
        ("m*x'^2/2", "k*(1 + a*sin(W*t)^2)*x^2/2", "k/m"),
        ("m*x'^2/2", "k*(x - a*sin(W*t))^2/2", "k/m"),
    ] {
        let modes = hanging(kinetic, potential);
        assert_eq!(modes.changing, None, "{kinetic}, {potential}");
        assert_same(&modes.square().unwrap().expect("one coordinate"), &expression(square));
    }
}

/// A mass on a linear spring has no length of its own: its size is a unit, and the equations do not
/// depend on it; that of a cubic spring sets the time.
#[test]
fn groups_need_no_length_among_the_parameters() {
    let groups = |kinetic: &str, potential: &str, dissipation: &str, own: &[(&str, &str)]| {
        let mut mechanism = Mechanism::parse(&["x"], kinetic, potential).unwrap();
        mechanism.dissipation = expression(dissipation);
        let units: BTreeMap<Symbol, Dimension> = own
            .iter()
            .map(|(name, unit)| (Symbol::new(name), unit.parse().expect("a unit")))
            .collect();
        mechanism.check_units(&units).unwrap();
        Groups::from_mechanism(&mechanism, &mechanism.equations().unwrap(), &units).unwrap()
    };
    let linear =
        [("x", "m"), ("m", "kg"), ("k", "N/m"), ("c", "N*s/m"), ("b", "N/m^3"), ("F", "N")];
    let found = groups("m*x'^2/2", "k*x^2/2", "c*x'^2/2", &linear[..4]);
    assert_same(&found.left[0], &expression("x'' + 2*zeta*x' + x"));
    assert_eq!(found.groups.len(), 1);
    assert_same(&found.groups[0].definition, &expression("c/(2*sqrt(k*m))"));
    assert_same(&found.time, &expression("sqrt(m/k)"));
    assert_eq!(found.sizes, [("x".into(), "x0".into())]);
    assert_eq!((found.parameters, found.rank), (3, 3));
    let cubic = groups("m*x'^2/2", "b*x^4/4", "0", &[linear[0], linear[1], linear[4]]);
    assert_eq!((cubic.left[0].to_string().as_str(), cubic.groups.len()), ("x'' + x^3", 0));
    assert_same(&cubic.time, &expression("sqrt(m/b)/x0"));
    // Where the parameters have a length, it is the unit as before.
    let duffing =
        groups("m*x'^2/2", "k*x^2/2 + b*x^4/4", "0", &[linear[0], linear[1], linear[2], linear[4]]);
    assert!(duffing.sizes.is_empty() && duffing.groups.is_empty());
    // A dry force has one, too.
    let dry =
        groups("m*x'^2/2", "k*x^2/2", "F*abs(x')", &[linear[0], linear[1], linear[2], linear[5]]);
    assert!(dry.sizes.is_empty());
}

/// Seven links whose energies are written from the places of their masses: the mass matrix is `M_ij
/// = (sum of masses from the later link on) L_i L_j cos(q_i - q_j)`.
#[test]
fn energies_from_the_places_of_seven_links_join() {
    const LINKS: usize = 7;
    let sum = |last: usize, function: &str| {
        let terms: Vec<String> =
            (1..=last).map(|i| format!("L{i}*q{i}'*{function}(q{i})")).collect();
        terms.join(" + ")
    };
    let kinetic: Vec<String> = (1..=LINKS)
        .map(|k| format!("m{k}*(({})^2 + ({})^2)/2", sum(k, "cos"), sum(k, "sin")))
        .collect();
    let height =
        |k: usize| (1..=k).map(|i| format!("L{i}*cos(q{i})")).collect::<Vec<_>>().join(" + ");
    let potential: Vec<String> = (1..=LINKS).map(|k| format!("-m{k}*g*({})", height(k))).collect();
    let names: Vec<String> = (1..=LINKS).map(|i| format!("q{i}")).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let mechanism = Mechanism::parse(&names, &kinetic.join(" + "), &potential.join(" + ")).unwrap();
    let equations = mechanism.equations().unwrap();
    for i in 1..=LINKS {
        for j in 1..=LINKS {
            let masses: Vec<String> = (i.max(j)..=LINKS).map(|k| format!("m{k}")).collect();
            let by_hand = format!("({})*L{i}*L{j}*cos(q{i} - q{j})", masses.join(" + "));
            assert_same(&equations.mass[i - 1][j - 1], &expression(&by_hand));
        }
    }
}

/// The mass is a letter of the energies, with a unit and a value; the equation has no mass.
#[test]
fn a_letter_that_cancels_has_no_value_for_the_equation() {
    let text = "[lagrangian]\ncoordinates = [\"x\"]\nkinetic = \"m*L^2*x'^2/2\"\npotential = \"m*g*L*(1 - cos(x))\"\n\
                [values]\nm = 3\nL = 2\ng = 9.81\nk = 1";
    let file: Problem = text.parse().expect("a file");
    let values = file.values_of_motion().expect("values");
    let names: Vec<&str> = values.iter().map(|(name, _)| name.name()).collect();
    // What stands nowhere is still passed on, to be refused by its name.
    assert_eq!(names, ["L", "g", "k"]);
    // Where it is followed, the energy has a mass: given, it is the unit of the energy, without it
    // the motion is the same.
    let follow = |given: &str| {
        let file: Problem =
            text.replace("m = 3\n", given).replace("k = 1", "").parse().expect("a file");
        let mut course = file.course().expect("a course");
        course.values = file.values_with(&course.parameters()).expect("values").numbers();
        course.begin("x".into(), 0.4).expect("a state");
        course.duration = 2.0;
        course.follow().expect("a motion")
    };
    let [heavy, light, none] = ["m = 3\n", "m = 1\n", ""].map(follow);
    for motion in [&light, &none] {
        assert_eq!(motion.states_at(2.0), heavy.states_at(2.0));
    }
    let [three, one] =
        [&heavy, &light].map(|motion| motion.balance.as_ref().expect("a balance").start);
    let energy = 9.81 * 2.0 * (1.0 - 0.4_f64.cos());
    assert!((three / (3.0 * energy) - 1.0).abs() < 1e-12 && (one / energy - 1.0).abs() < 1e-12);
    assert!(none.balance.is_none());
    assert_eq!(none.course.missing_for_energy(), ["m".into()]);
}
