//! Formulas about any equilibrium are those of the same force written about zero: irrational ones,
//! static loads in symbols, wells that were chosen. Held against the definitions of the methods,
//! against the equation moved by hand, and against Runge-Kutta.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use lindstedt::Values;
use lindstedt::expr::{CompiledFunction, Expr};
use lindstedt::method::numbers::{evaluate, frequency_squared_of};
use lindstedt::method::with_numbers_where_needed;
use lindstedt::method::{Options, Reason, Refusal, solve};
use lindstedt::numeric::period::{PeriodError, swing};
use lindstedt::oscillator::OscillatorError;
use lindstedt::solution::{Method, Solution};
use lindstedt::verify::{VerificationError, judge};
use lindstedt::{Oscillator, Symbol};

fn oscillator(equation: &str) -> Oscillator {
    Oscillator::parse(equation).expect(equation)
}

fn by(oscillator: &Oscillator, method: Method) -> Result<Solution, Refusal> {
    let options = Options { method: Some(method), ..Options::default() };
    solve(oscillator, &options)
}

fn numbers(entries: &[(&str, f64)]) -> BTreeMap<Symbol, f64> {
    let entry = |(name, value): &(&str, f64)| (Symbol::new(name), *value);
    entries.iter().map(entry).collect()
}

/// omega^2 at an amplitude.
fn squared(oscillator: &Oscillator, solution: &Solution, amplitude: f64) -> f64 {
    frequency_squared_of(oscillator, solution, &numbers(&[("A", amplitude)])).unwrap_or(f64::NAN)
}

/// The force of an equation without parameters.
fn force(oscillator: &Oscillator) -> impl Fn(f64) -> f64 {
    let function =
        CompiledFunction::new(&oscillator.force, &[oscillator.coordinate]).expect("no parameters");
    move |x| function.call(&[x])
}

/// The zero of a function between two points, by bisection.
fn bisected(function: &dyn Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if function(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[test]
fn the_force_about_an_irrational_equilibrium_is_the_force() {
    // Equation, an interval with the equilibrium in it, amplitude.
    for (equation, low, high, amplitude) in [
        ("x'' + x - 1/3 + x*abs(x) = 0", 0.0, 1.0, 0.4),
        ("x'' + x - 1/3 + x*abs(x) = 0", 0.0, 1.0, 0.1),
        ("x'' + x + 1/3 + x*abs(x) = 0", -1.0, 0.0, 0.7),
        ("x'' + x + 187*x*abs(x) - 1.72 = 0", 0.0, 1.0, 0.101),
        ("x'' + x/(1 + x^2) = 1/5", 0.0, 0.9, 1.2),
        ("x'' + x - cos(x) + 3*max(x - 1, 0) = 0", 0.0, 1.0, 0.9),
        ("x'' + x - 20*(x - 1)*exp(-100*(x - 1)^2) = 0", -0.5, 0.5, 0.3),
        ("x'' + x + 1/2 - 20*(x - 1)*exp(-100*(x - 1)^2) = 0", -0.8, 0.0, 1.6),
        ("x'' + exp(x) - 2 - cos(3*x)/5 = 0", 0.0, 1.5, 0.5),
        ("x'' + 24*x + 0.498*x^3 + 1.96*x^5 - 1.98 = 0", 0.0, 1.0, 0.447),
        ("x'' + x + log(x) = 0", 0.1, 1.0, 0.2),
        ("x'' + 1e12*x - 1e26*x^3 - 1e4 = 0", 0.0, 4e-8, 2e-8),
    ] {
        let oscillator = oscillator(equation);
        let force = force(&oscillator);
        let equilibrium = bisected(&force, low, high);
        // The definition of the Hamiltonian approach, by the midpoint rule.
        let points = 1 << 16;
        let sum: f64 = (0..points)
            .map(|k| {
                let theta = PI * (f64::from(k) + 0.5) / f64::from(points);
                force(equilibrium + amplitude * theta.cos()) * theta.cos()
            })
            .sum();
        let hamiltonian = 2.0 * sum / f64::from(points) / amplitude;
        for method in
            [Method::Hamiltonian, Method::IterationPerturbation, Method::VariationalIteration]
        {
            let found = squared(&oscillator, &by(&oscillator, method).expect(equation), amplitude);
            assert!(
                (found / hamiltonian - 1.0).abs() < 1e-8,
                "{equation} {method:?}: {found} against {hamiltonian}"
            );
        }
        let solution = by(&oscillator, Method::Exact).expect(equation);
        let path = swing(
            &|_, x, _| -force(x),
            equilibrium,
            equilibrium + amplitude,
            100.0 / hamiltonian.sqrt(),
        );
        let truth = TAU / path.expect(equation).end().t;
        let found = squared(&oscillator, &solution, amplitude).sqrt();
        assert!((found / truth - 1.0).abs() < 1e-8, "{equation} exact: {found} against {truth}");
        assert!(
            solution.displacement.is_zero(),
            "{equation}: a motion by quadrature has no formula"
        );
    }
}

#[test]
fn a_polynomial_is_kept_whole_about_an_irrational_equilibrium() {
    // x + x^5/2 + x^7 - 1 about its zero, whose Taylor coefficients are written out beside it.
    let equation = oscillator("x'' + x + x^5/2 + x^7 - 1 = 0");
    let x: f64 = bisected(&|x: f64| x + 0.5 * x.powi(5) + x.powi(7) - 1.0, 0.0, 1.0);
    let choose = |n: i32, k: i32| {
        (0..k).fold(1.0, |product, j| product * f64::from(n - j) / f64::from(j + 1))
    };
    let coefficient = |k: i32| {
        let power = |n: i32| {
            if n < k { 0.0 } else { choose(n, k) * x.powi(n - k) }
        };
        power(1) + 0.5 * power(5) + power(7)
    };
    let terms: Vec<String> = (1..=7).map(|k| format!("{:.15}*x^{k}", coefficient(k))).collect();
    let by_hand = oscillator(&format!("x'' + {} = 0", terms.join(" + ")));
    for (method, order) in [
        (Method::HomotopyPerturbation, 1),
        (Method::HomotopyPerturbation, 2),
        (Method::HomotopyAnalysis, 2),
        (Method::IterationPerturbation, 2),
        (Method::ParameterExpansion, 2),
        (Method::LindstedtPoincare, 4),
    ] {
        let options = Options {
            method: Some(method),
            order: Some(order),
            // The minimum of the residual is known to no more than the root of the rounding.
            hbar: (method == Method::HomotopyAnalysis).then(|| Expr::from(-1)),
            ..Options::default()
        };
        let moved = solve(&equation, &options).unwrap();
        let direct = solve(&by_hand, &options).unwrap();
        let (a, b) = (squared(&equation, &moved, 0.2), squared(&by_hand, &direct, 0.2));
        assert!((a / b - 1.0).abs() < 1e-9, "{method:?} {order}: {a} against {b}");
    }
}

#[test]
fn a_pendulum_is_a_pendulum_wherever_it_hangs() {
    let plain = oscillator("x'' + sin(x) = 0");
    for equation in ["x'' + cos(x) = 0", "x'' - sin(x + pi/3) = 0", "x'' - sin(x) = 0"] {
        let moved = oscillator(equation);
        let moved = match equation {
            "x'' - sin(x) = 0" => moved.about("pi".parse().unwrap()),
            _ => moved,
        };
        for method in Method::ALL {
            let (a, b) = (by(&moved, method).expect(equation), by(&plain, method).expect(equation));
            assert_eq!(
                a.law.frequency_squared(),
                b.law.frequency_squared(),
                "{equation} {method:?}"
            );
            assert_eq!(a.law.closed_form(), b.law.closed_form(), "{equation} {method:?}");
            assert!(!a.numerical && a.definitions == b.definitions, "{equation} {method:?}");
        }
    }
}

#[test]
fn static_loads_in_symbols_are_those_in_numbers() {
    for (equation, values, amplitude) in [
        ("x'' + x + x^2 - g = 0", &[("g", "1/10")][..], 0.2),
        ("x'' + k*x - b*x^2 + g = 0", &[("g", "1/10"), ("k", "2"), ("b", "1/3")], 0.3),
        ("x'' + x - lambda/(1 - x) = 0", &[("lambda", "1/8")], 0.2),
        ("x'' + x - k/x = 0", &[("k", "2")], 0.3),
        ("x'' + k*(x - L) + b*(x - L)^3 = 0", &[("k", "2"), ("b", "1"), ("L", "5/7")], 0.5),
        ("x'' + sin(x - c) = 0", &[("c", "1/4")], 0.5),
        ("x'' + x + eps*(x + 3)/(2 - x) = 0", &[("eps", "1/5")], 0.2),
        // Found by inverting the force.
        ("x'' + sin(x) = T", &[("T", "1/3")], 0.5),
        ("x'' + sin(x) - b*cos(x) = 0", &[("b", "1/3")], 0.5),
        ("x'' + k*sin(x) + b*cos(x) - c = 0", &[("k", "2"), ("b", "1/3"), ("c", "1/2")], 0.3),
        ("x'' + exp(x) - k = 0", &[("k", "1/2")], 0.3),
        ("x'' + log(1 + x) - k = 0", &[("k", "1/2")], 0.3),
        ("x'' + sinh(x) - k = 0", &[("k", "1/2")], 0.3),
        ("x'' + tan(x) - k = 0", &[("k", "1/2")], 0.3),
        // The sign of cos(2*x_e) and of log(x_e)^2 is not that at x_e = 1.
        ("x'' + sin(2*x) = T", &[("T", "1/3")], 0.3),
        ("x'' + log(x)^3 - m = 0", &[("m", "1/2")], 0.3),
        ("x'' + x^3 - g = 0", &[("g", "8")], 0.3),
        ("x'' + (x + 1)^3 - g = 0", &[("g", "8")], 0.3),
        // The orbit of a planet: one letter has to be much smaller than the other.
        ("x'' + x - m/h^2 - 3*m*x^2 = 0", &[("m", "1/20"), ("h", "1")], 0.1),
        ("x'' + x - k/x^2 = 0", &[("k", "2")], 0.3),
        ("x'' + x + b*x^3 - g = 0", &[("g", "2"), ("b", "1/3")], 0.3),
        // A gas bubble, two atoms, and other powers and exponentials of one thing.
        ("x*x'' + 3*x'^2/2 - p*(x^(-3*k) - 1) = 0", &[("p", "2"), ("k", "7/5")], 0.1),
        ("x'' + 24*e*(s^6/x^7 - 2*s^12/x^13) = 0", &[("e", "1/3"), ("s", "2")], 0.1),
        ("x'' + x^3 - k/x^3 = 0", &[("k", "64")], 0.2),
        ("x'' + exp(x) - k*exp(-x) = 0", &[("k", "9")], 0.2),
        ("x'' + exp(2*x) - k*exp(x) + 1 = 0", &[("k", "5/2")], 0.2),
        // A contact that a letter presses together.
        ("x'' + k*(max(x + d, 0)^(3/2) - d^(3/2)) = 0", &[("k", "2"), ("d", "1/2")], 0.2),
        ("x'' + k*(x + d)^2*H(x + d) - k*d^2 = 0", &[("k", "2"), ("d", "1/2")], 0.2),
        ("x'' + sqrt(x) + x - k = 0", &[("k", "6")], 0.2),
        ("x'' + x - lambda/(1 - x)^2 = 0", &[("lambda", "1/10")], 0.1),
        ("x'' + k*x - m/(L - x)^2 = 0", &[("k", "2"), ("m", "1/10"), ("L", "1")], 0.1),
    ] {
        let symbolic = oscillator(equation);
        let exact: BTreeMap<Symbol, Expr> = values
            .iter()
            .map(|(name, value)| (Symbol::new(name), value.parse().unwrap()))
            .collect();
        assert_eq!(
            with_numbers_where_needed(&symbolic, &exact).expect(equation),
            None,
            "{equation}"
        );
        let numerical = symbolic.with_values(&exact).unwrap();
        let at: BTreeMap<Symbol, f64> = exact
            .iter()
            .map(|(name, value)| (*name, value.evaluate(&BTreeMap::new()).unwrap()))
            .chain(["A", "a"].map(|name| (Symbol::new(name), amplitude)))
            .collect();
        // With a letter it is not seen that the force is odd about its equilibrium: an approximant
        // in A, not in A^2.
        let hidden_symmetry =
            ["b*cos(x) = 0", "k*exp(-x) = 0"].iter().any(|end| equation.ends_with(end));
        for method in Method::ALL {
            // Homotopy analysis chooses hbar by a residual; its value depends on nothing else.
            match (by(&symbolic, method), by(&numerical, method)) {
                (Ok(_), Ok(_)) if hidden_symmetry && method == Method::Pade => {}
                (Ok(symbols), Ok(direct)) => {
                    let a = evaluate(&symbolic, &symbols, &at).expect(equation);
                    let b = evaluate(&numerical, &direct, &at).expect(equation);
                    let error = a.frequency_squared / b.frequency_squared - 1.0;
                    assert!(error.abs() < 1e-7, "{equation} {method:?}: {error}");
                    let (a, b) = (a.motion.unwrap(), b.motion.unwrap());
                    for theta in [0.0, 0.7, 2.0, 3.0] {
                        let difference = a.evaluate(theta) - b.evaluate(theta);
                        assert!(difference.abs() < 1e-7, "{equation} {method:?}: {difference}");
                    }
                }
                (Err(_), Err(_)) => {}
                // What the refusal asks for.
                (Err(Refusal { reason: Reason::SeveralVariables, .. }), Ok(_)) => {}
                (a, b) => panic!("{equation} {method:?}: {:?} {:?}", a.err(), b.err()),
            }
        }
    }
}

#[test]
fn numbers_choose_the_equilibrium() {
    let values = |entries: &[(&str, &str)]| -> BTreeMap<Symbol, Expr> {
        let entry = |(name, value): &(&str, &str)| (Symbol::new(name), value.parse().unwrap());
        entries.iter().map(entry).collect()
    };
    // The side of a corner at rest, too.
    let corner = oscillator("x'' + 3*x + x*abs(x + c) = 0");
    assert_eq!(with_numbers_where_needed(&corner, &values(&[("c", "1")])), Ok(None));
    let other_side = with_numbers_where_needed(&corner, &values(&[("c", "-1")])).unwrap();
    assert_eq!(other_side.unwrap().parameters, vec![]);
    let duffing = oscillator("x'' + k*x + x^3 = 0");
    assert_eq!(with_numbers_where_needed(&duffing, &values(&[("k", "2")])), Ok(None));
    let error = with_numbers_where_needed(&duffing, &values(&[("k", "-1")])).unwrap_err();
    assert!(matches!(error, OscillatorError::Unstable { .. }), "{error}");
    let chosen = with_numbers_where_needed(&duffing.about(Expr::one()), &values(&[("k", "-1")]));
    assert!(chosen.unwrap().is_some());
    // A barrier behind the equilibrium acts at rest.
    let barrier = oscillator("x'' + x + k*(x - xc)*H(x - xc) = 0");
    assert_eq!(
        with_numbers_where_needed(&barrier, &values(&[("k", "3"), ("xc", "1/2")])),
        Ok(None)
    );
    let pushed = with_numbers_where_needed(&barrier, &values(&[("k", "3"), ("xc", "-1/2")]));
    let pushed = pushed.unwrap().expect("another equilibrium");
    let solution = by(&pushed, Method::Hamiltonian).unwrap();
    assert_eq!(solution.equilibrium.to_string(), "-3/8");
}

/// On the separatrix there is no period, whichever rim of the well it passes and whatever a
/// quadrature meets there; next to it rounding decides; farther away nothing changes.
#[test]
fn a_release_on_the_separatrix_is_named() {
    let at = |amplitude: &str| {
        let mut at = Values::default();
        at.insert("A".into(), amplitude.parse().unwrap()).unwrap();
        at
    };
    let reason = |equation: &Oscillator, method: Method, amplitude: &str| {
        let solution = by(equation, method).unwrap();
        judge(equation, &solution, &at(amplitude), 0.01).map_err(|error| match error {
            VerificationError::Period(error) => error,
            other => panic!("{amplitude}: {other}"),
        })
    };
    let pendulum = oscillator("x'' + sin(x) = 0");
    let well = oscillator("x'' - x + x^3 = 0").about(Expr::one());
    let softening = oscillator("x'' + x - x^3 = 0");
    let quadratic = oscillator("x'' + x - x^2 = 0");
    for method in [Method::LindstedtPoincare, Method::Exact] {
        for (equation, amplitude, summit) in [
            (&pendulum, "pi", PI),
            (&pendulum, "-pi", -PI),
            (&well, "sqrt(2) - 1", 0.0),
            (&well, "-1", 0.0),
            (&softening, "1", 1.0),
            (&quadratic, "1", 1.0),
            (&quadratic, "-1/2", 1.0),
        ] {
            match reason(equation, method, amplitude) {
                Err(PeriodError::Separatrix { place, .. }) => {
                    assert!((place - summit).abs() < 1e-9, "{amplitude}: {place}");
                }
                other => panic!("{equation:?} at {amplitude}: {other:?}"),
            }
        }
        for (equation, amplitude) in [(&pendulum, "3.1415926535"), (&quadratic, "0.99999999999")] {
            let near = reason(equation, method, amplitude);
            assert!(matches!(near, Err(PeriodError::NearSeparatrix { .. })), "{near:?}");
        }
        // 4 K(m) with the complementary parameter cos^2(A/2), as ln(16/m1)/2 + ...
        let near = "3.1415";
        let judged = reason(&pendulum, method, near).unwrap();
        let quarter = (4.0 / (0.5 * near.parse::<f64>().unwrap()).cos()).ln();
        assert!((judged.true_frequency * 4.0 * quarter / TAU - 1.0).abs() < 1e-8);
        let beyond = reason(&softening, method, "1.1");
        assert!(matches!(beyond, Err(PeriodError::PushedAway { .. })), "{beyond:?}");
        let beyond = reason(&quadratic, method, "-0.50001");
        assert!(matches!(beyond, Err(PeriodError::Escapes { .. })), "{beyond:?}");
    }
}

#[test]
fn a_formula_is_judged_by_a_motion_about_its_own_equilibrium() {
    let wells = oscillator("x'' + x - x^3 + x^5/5 = 0");
    let at = |amplitude: &str| {
        let mut at = Values::default();
        at.insert("A".into(), amplitude.parse().unwrap()).unwrap();
        at
    };
    let solution = by(&wells, Method::Hamiltonian).unwrap();
    let other = judge(&wells, &solution, &at("2"), 0.01).unwrap_err();
    assert!(matches!(other, VerificationError::Period(PeriodError::OtherWell { .. })), "{other}");
    let over_all = judge(&wells, &solution, &at("5/2"), 0.01).unwrap();
    let path = swing(&|_, x: f64, _| -(x - x.powi(3) + x.powi(5) / 5.0), 0.0, 2.5, 100.0).unwrap();
    assert!((over_all.true_frequency * path.end().t / TAU - 1.0).abs() < 1e-9);
    // The outer well, chosen by a rounded number.
    let outer = wells.about("1.902".parse().unwrap());
    let solution = by(&outer, Method::Hamiltonian).unwrap();
    let judged = judge(&outer, &solution, &at("1/100"), 0.01).unwrap();
    let place: f64 = (2.5 + 5.0_f64.sqrt() / 2.0).sqrt();
    let slope = 1.0 - 3.0 * place.powi(2) + place.powi(4);
    assert!((judged.true_frequency / slope.sqrt() - 1.0).abs() < 1e-3);
    assert!(judged.relative_error.unwrap().abs() < 1e-3);
}

#[test]
fn two_equilibria_close_together_are_seen_on_either_side() {
    // Between x = 2.999 and 3.001 the force changes its sign and back; not a polynomial, so that
    // nothing but a search sees it.
    for (equation, places) in [
        ("x'' + x*((x - 3)^2 - 1/1000000)*exp(x/100) = 0", "x = 0, 3001/1000"),
        ("x'' + x*((x + 3)^2 - 1/1000000)*exp(x/100) = 0", "x = -3001/1000, 0"),
    ] {
        let about = oscillator(equation).about("1".parse().expect("a number"));
        let refusal = solve(&about, &Options::default()).expect_err("a refusal").to_string();
        assert!(refusal.ends_with(&format!("stable ones are at {places}")), "{refusal}");
    }
}

/// The place about which a motion swings is no harmonic of it: an odd force is balanced by odd
/// ones, wherever its equilibrium is.
#[test]
fn an_odd_force_is_balanced_alike_about_any_equilibrium() {
    let at = |equation: &str, order: u32, small: &[(&str, f64)]| {
        let equation = oscillator(equation);
        let options = Options {
            method: Some(Method::HarmonicBalance),
            order: Some(order),
            ..Options::default()
        };
        let solution = solve(&equation, &options).expect("a balance");
        let mut values = numbers(small);
        values.insert("A".into(), 1.5);
        let found = evaluate(&equation, &solution, &values).expect("numbers");
        let third = found.motion.expect("a motion").cosine(3).mean().0;
        // Coefficients are solved for, the place is not.
        let names: Vec<&str> = found.chosen.iter().map(|(name, _)| name.name()).collect();
        assert_eq!(names, &["a1", "a3", "a5"][..order as usize]);
        let kept = if order == 2 { "1, 3" } else { "1, 3, 5" };
        assert_eq!(solution.formula(), format!("harmonics {kept} balanced, solved by numbers"));
        (found.frequency_squared, third)
    };
    for order in [2, 3] {
        let (squared, third) = at("x'' + x + x^3 = 0", order, &[]);
        for (moved, values) in [
            ("x'' + (x - 1) + (x - 1)^3 = 0", vec![]),
            ("x'' + (x - pi) + (x - pi)^3 = 0", vec![]),
            ("x'' + (x - L) + (x - L)^3 = 0", vec![("L", 0.3)]),
        ] {
            let found = at(moved, order, &values);
            assert!((found.0 / squared - 1.0).abs() < 1e-12, "{moved}: {} for {squared}", found.0);
            assert!((found.1 / third - 1.0).abs() < 1e-10, "{moved}: {} for {third}", found.1);
        }
    }
}

#[test]
fn what_is_no_equilibrium_has_no_formula() {
    for method in Method::ALL {
        for equation in
            ["x'' + x^2 + x^3 = 0", "x'' - x + x^3 = 0", "x'' + sin(x) - 2*sin(x)*cos(x) = 0"]
        {
            let refusal = by(&oscillator(equation), method).unwrap_err();
            assert!(
                matches!(refusal.reason, Reason::Oscillator(OscillatorError::Unstable { .. })),
                "{equation} {method:?}: {refusal}"
            );
        }
    }
}

#[test]
fn a_pole_is_no_equilibrium() {
    // The linear frequency about x = 1 is 2; x = 0 is a pole.
    let pole = oscillator("x'' + x - 1/x^3 = 0");
    let answers: Vec<Solution> =
        Method::ALL.into_iter().filter_map(|method| by(&pole, method).ok()).collect();
    assert!(answers.len() >= 8, "{}", answers.len());
    for solution in answers {
        assert_eq!(solution.equilibrium, Expr::one(), "{:?}", solution.method);
        let frequency = squared(&pole, &solution, 1e-3);
        assert!((frequency - 4.0).abs() < 1e-4, "{:?}: {frequency}", solution.method);
    }
}

/// A multiple zero of a force multiplied out is one place: the motion is that of the same power
/// about zero.
#[test]
fn a_multiple_zero_is_one_place() {
    for (shifted, about_zero) in [
        ("x'' + (x - 1)^3 = 0", "x'' + x^3 = 0"),
        ("x'' + x^3 - 3*x^2 + 3*x - 1 = 0", "x'' + x^3 = 0"),
        ("x'' + (x + 2)^5 = 0", "x'' + x^5 = 0"),
        ("x'' + 2*(x - 1/3)^3 + (x - 1/3)^5 = 0", "x'' + 2*x^3 + x^5 = 0"),
    ] {
        let laws = [shifted, about_zero].map(|equation| {
            let oscillator = oscillator(equation);
            solve(&oscillator, &Options::default()).expect(equation).law
        });
        assert_eq!(laws[0], laws[1], "{shifted}");
    }
}

/// An equilibrium asked for in letters is the one meant, however its root is written.
#[test]
fn an_equilibrium_may_be_written_in_any_way() {
    for (equation, about) in [
        ("x'' - alpha*x + beta*x^3 = 0", "sqrt(alpha/beta)"),
        ("x'' - alpha*x + beta*x^3 = 0", "-sqrt(alpha)/sqrt(beta)"),
        ("x'' - alpha*x + beta*x^3 = 0", "sqrt(alpha*beta)/beta"),
    ] {
        let mut wells = oscillator(equation);
        wells.about = Some(about.parse().expect(about));
        let solution = by(&wells, Method::LindstedtPoincare).expect(about);
        let at: Values = "alpha = 2, beta = 3, A = 1/100".parse().expect("values");
        let judged = judge(&wells, &solution, &at, 1e-6).expect(about);
        // omega0^2 = 2 alpha.
        assert!((judged.true_frequency - 2.0).abs() < 1e-3, "{about}: {}", judged.true_frequency);
        assert!(judged.relative_error.is_some_and(|error| error.abs() < 1e-6), "{about}");
    }
    let mut unstable = oscillator("x'' - alpha*x + beta*x^3 = 0");
    unstable.about = Some("2*sqrt(alpha/beta)".parse().expect("a place"));
    assert!(by(&unstable, Method::LindstedtPoincare).is_err());
}
