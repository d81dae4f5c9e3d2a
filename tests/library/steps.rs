//! What `--steps` prints is read back and recomputed: every equation holds, every condition is met,
//! and the orders together satisfy the equation of motion to the order they claim.

use std::collections::BTreeMap;

use lindstedt::export::{latex, text};
use lindstedt::expr::{Expr, parse_expression};
use lindstedt::method::{Options, solve};
use lindstedt::solution::{AmplitudeConvention, Degrees, Method};
use lindstedt::{Oscillator, Solution, Symbol};
use nalgebra::{DMatrix, DVector};

fn solution(equation: &str, options: &Options) -> Solution {
    let oscillator = Oscillator::parse(equation).expect(equation);
    solve(&oscillator, options).unwrap_or_else(|refusal| panic!("{equation}: {refusal}"))
}

fn by(method: Method, order: u32) -> Options {
    Options { method: Some(method), order: Some(order), ..Options::default() }
}

/// The lines of a derivation, without what surrounds them.
fn lines(solution: &Solution) -> Vec<String> {
    let text = text::steps(solution);
    text.lines().map(str::trim).filter(|line| !line.is_empty()).map(str::to_owned).collect()
}

fn read(text: &str) -> Expr {
    parse_expression(text).unwrap_or_else(|error| panic!("{text}: {error}"))
}

/// The right side of the last line that says what `name` is, with or without words in front of it.
fn value_of(name: &str, lines: &[String]) -> Expr {
    let start = format!("{name} = ");
    let place = |line: &String| {
        let after = line.rsplit("  ").next().unwrap_or(line).trim().to_owned();
        after.strip_prefix(&start).map(str::to_owned)
    };
    let found = lines.iter().rev().find_map(place);
    let found = found.unwrap_or_else(|| panic!("no `{name} = ...` in {lines:#?}"));
    let last = found.rsplit(" = ").next().expect("a right side").to_owned();
    read(last.split(", ").next().expect("an expression"))
}

type Numbers = BTreeMap<Symbol, f64>;

fn numbers(pairs: &[(&str, f64)]) -> Numbers {
    pairs.iter().map(|(name, value)| (Symbol::new(name), *value)).collect()
}

fn at(expression: &Expr, numbers: &Numbers, theta: f64) -> f64 {
    let mut numbers = numbers.clone();
    numbers.insert("theta".into(), theta);
    expression.evaluate(&numbers).unwrap_or_else(|error| panic!("{expression}: {error}"))
}

fn derivative(expression: &Expr) -> Expr {
    expression.differentiate("theta".into()).expect("a derivative")
}

/// `y_n'' + y_n` is the printed right side with the printed `W_n` in it, and the printed conditions
/// hold.
fn orders_hold(solution: &Solution, numbers: &Numbers) {
    let lines = lines(solution);
    let angles = [0.3, 1.1, 2.7, 4.4];
    for n in 0..=solution.order {
        let y = value_of(&format!("y{n}"), &lines);
        let left = &derivative(&derivative(&y)) + &y;
        let mut numbers = numbers.clone();
        if n > 0 {
            let w = value_of(&format!("W{n}"), &lines);
            numbers.insert(Symbol::new(&format!("W{n}")), w.evaluate(&numbers).expect("a number"));
        }
        let start = format!("y{n}'' + y{n} = ");
        let right = lines.iter().find_map(|line| line.strip_prefix(&start)).expect("the equation");
        let right = read(right);
        for theta in angles {
            let (left, right) = (at(&left, &numbers, theta), at(&right, &numbers, theta));
            assert!(
                (left - right).abs() < 1e-12,
                "order {n} of {}: {left} {right}",
                solution.equation
            );
        }
        let order = lines.iter().skip_while(|line| **line != format!("order {n}"));
        let conditions =
            order.clone().find_map(|line| line.strip_prefix("with ")).expect("conditions").trim();
        for condition in conditions.split(", ") {
            let pi = std::f64::consts::PI;
            let projection = |wave: &dyn Fn(f64) -> f64| -> f64 {
                let sample = |k: u32| 2.0 * pi * f64::from(k) / 64.0;
                (0..64).map(|k| at(&y, &numbers, sample(k)) * wave(sample(k))).sum::<f64>() / 32.0
            };
            let value = if condition == format!("y{n}(0) = 1") {
                at(&y, &numbers, 0.0) - 1.0
            } else if condition == format!("y{n}(0) = 0") {
                at(&y, &numbers, 0.0)
            } else if condition == format!("y{n}'(0) = 0") {
                at(&derivative(&y), &numbers, 0.0)
            } else if condition == format!("no cos(theta) in y{n}") {
                projection(&f64::cos)
            } else if condition == format!("no sin(theta) in y{n}") {
                projection(&f64::sin)
            } else {
                panic!("what is `{condition}`?")
            };
            assert!(value.abs() < 1e-13, "{condition}: {value}");
        }
    }
}

/// The rms of the equation of motion along the printed orders, with the small parameter at `small`.
fn residual(solution: &Solution, unit: &Expr, numbers: &Numbers, small: (&str, f64)) -> f64 {
    let lines = lines(solution);
    let mut numbers = numbers.clone();
    numbers.insert(small.0.into(), small.1);
    let sum = |letter: &str, first: u32| {
        let terms = (first..=solution.order).map(|n| value_of(&format!("{letter}{n}"), &lines));
        Expr::sum(terms)
    };
    let motion = unit * &sum("y", 0);
    let squared = &value_of("omega0^2", &lines) * &(Expr::one() + sum("W", 1));
    let omega = squared.evaluate(&numbers).expect("a number").sqrt();
    let (velocity, acceleration) = (derivative(&motion), derivative(&derivative(&motion)));
    let force = Oscillator::from_equation(&solution.equation).expect("an equation").force;
    let defect = |theta: f64| {
        let mut at_theta = numbers.clone();
        at_theta.insert("x".into(), at(&motion, &numbers, theta));
        at_theta.insert("x'".into(), omega * at(&velocity, &numbers, theta));
        omega * omega * at(&acceleration, &numbers, theta)
            + force.evaluate(&at_theta).expect("a force")
    };
    let sum: f64 =
        (0..48).map(|k| defect(2.0 * std::f64::consts::PI * f64::from(k) / 48.0).powi(2)).sum();
    (sum / 48.0).sqrt()
}

#[test]
fn the_orders_of_lindstedt_and_poincare_hold_as_printed() {
    let first_harmonic = |order| Options {
        amplitude: Some(AmplitudeConvention::FirstHarmonic),
        ..by(Method::LindstedtPoincare, order)
    };
    for (equation, options, values) in [
        ("x'' + x + eps*x^3 = 0", by(Method::LindstedtPoincare, 3), vec![("A", 1.3)]),
        ("x'' + x + eps*x^3 = 0", first_harmonic(3), vec![("a", 1.3)]),
        (
            "x'' + k*x + eps*(x^2 + 2*x^3) = 0",
            by(Method::LindstedtPoincare, 3),
            vec![("A", 0.7), ("k", 2.25)],
        ),
        ("x'' + 4*x + eps*x*x'^2 = 0", by(Method::LindstedtPoincare, 2), vec![("A", 0.7)]),
    ] {
        let solution = solution(equation, &options);
        let mut at = numbers(&values);
        at.insert("eps".into(), 0.3);
        for definition in &solution.definitions {
            let value = definition.meaning.evaluate(&at).expect("a definition");
            at.insert(definition.symbol, value);
        }
        orders_hold(&solution, &at);
        let unit = Expr::symbol(values[0].0);
        let ratio = residual(&solution, &unit, &at, ("eps", 2e-2))
            / residual(&solution, &unit, &at, ("eps", 1e-2));
        let expected = f64::from(options.order.expect("an order") + 1);
        assert!((ratio.log2() - expected).abs() < 0.2, "{equation}: {}", ratio.log2());
    }
}

#[test]
fn the_orders_of_homotopy_perturbation_hold_as_printed() {
    for method in [Method::HomotopyPerturbation, Method::ParameterExpansion] {
        let solution = solution("x'' + 3*x + eps*x^3 - x^5 = 0", &by(method, 3));
        let at = numbers(&[("A", 0.8), ("eps", 0.4), ("omega", 1.7)]);
        orders_hold(&solution, &at);
        // omega0^2 = omega^2 (1 - W1 - W2 - W3) is the relation that the answer gives.
        let lines = lines(&solution);
        let corrections = (1..=3).map(|n| value_of(&format!("W{n}"), &lines));
        let sum: f64 = corrections.map(|w| w.evaluate(&at).expect("a number")).sum();
        let left = value_of("omega0^2", &lines).evaluate(&at).expect("a number");
        let relation = solution.law.relation().expect("a relation");
        let value =
            solution.evaluate(relation, &|symbol| at.get(&symbol).copied()).expect("a value");
        // The relation has been multiplied by a power of omega.
        let highest = relation.exponent_range("omega".into()).expect("a power").1;
        let scaled = value / 1.7_f64.powi(highest);
        let printed = (1.7_f64.powi(2) * (1.0 - sum) - left) / 1.7_f64.powi(2);
        assert!((scaled - printed).abs() < 1e-12, "{scaled} {printed}");
    }
}

/// Every amplitude of a limit cycle follows from the secular sine that is printed with it, and the
/// whole satisfies the equation of motion.
#[test]
fn limit_cycles_have_their_amplitude_conditions() {
    for (equation, amplitude, others) in [
        ("x'' - mu*(1 - x^2)*x' + x = 0", 2.0, vec![]),
        ("x'' - mu*(1 - x^2)*x' + 4*x = 0", 2.0, vec![]),
        ("x'' + mu*(x'^3/3 - x') + k*x = 0", 2.0 / f64::sqrt(2.25), vec![("k", 2.25)]),
        ("x'' - mu*(1 - b*x^2)*x' + x + mu*x^3 = 0", 2.0 / f64::sqrt(1.7), vec![("b", 1.7)]),
    ] {
        for convention in [AmplitudeConvention::FirstHarmonic, AmplitudeConvention::Initial] {
            let options = Options {
                amplitude: Some(convention),
                small: Some("mu".to_owned()),
                ..by(Method::LindstedtPoincare, 3)
            };
            let solution = solution(equation, &options);
            let mut at = numbers(&others);
            at.insert("mu".into(), 0.2);
            for definition in &solution.definitions {
                let value = definition.meaning.evaluate(&at).expect("a definition");
                at.insert(definition.symbol, value);
            }
            orders_hold(&solution, &at);
            let lines = lines(&solution);
            for (n, name) in ["a0", "B1", "B2", "B3"].into_iter().enumerate() {
                let start = format!("no secular sin(theta) at order {}:  ", n + 1);
                let condition =
                    lines.iter().find_map(|line| line.strip_prefix(&start)).expect("a condition");
                let condition = read(condition.strip_suffix(" = 0").expect("an equation"));
                let value = value_of(name, &lines).evaluate(&at).expect("a number");
                let mut at = at.clone();
                at.insert(name.into(), value);
                let sine = condition.evaluate(&at).expect("a number");
                assert!(sine.abs() < 1e-12, "{equation}, {name}: {sine}");
                // It does fix the amplitude: elsewhere the sine does not vanish.
                at.insert(name.into(), value + 0.1);
                assert!(
                    condition.evaluate(&at).expect("a number").abs() > 1e-3,
                    "{equation}, {name}"
                );
                if n == 0 {
                    assert!((value - amplitude).abs() < 1e-12, "{equation}: {value}");
                } else {
                    let y = value_of(&format!("y{n}"), &lines);
                    let sample = |k: u32| 2.0 * std::f64::consts::PI * f64::from(k) / 64.0;
                    let part: f64 = (0..64)
                        .map(|k| self::at(&y, &at, sample(k)) * sample(k).cos())
                        .sum::<f64>()
                        / 32.0;
                    assert!((part - value).abs() < 1e-12, "{equation}, {name}: {part} {value}");
                }
            }
            let unit = value_of("a0", &lines);
            let at_size = |mu: f64| residual(&solution, &unit, &at, ("mu", mu));
            let exponent = (at_size(2e-2) / at_size(1e-2)).log2();
            assert!((exponent - 4.0).abs() < 0.2, "{equation}: {exponent}");
        }
    }
}

/// `R_m` is the coefficient of `q^(m-1)` in `N[sum q^k u_k, sum q^k w_k]`, here by interpolation in
/// q.
#[test]
fn homotopy_analysis_shows_its_residuals() {
    let order = 3;
    for (equation, powers) in [
        ("x'' + x + eps*x^3 = 0", [1.0, 0.0, 0.4, 0.0]),
        ("x'' + x + x^2 + eps*x^3 = 0", [1.0, 1.0, 0.4, 0.0]),
    ] {
        let solution = solution(equation, &by(Method::HomotopyAnalysis, order));
        let lines = lines(&solution);
        let mut values = numbers(&[("A", 0.6), ("eps", 0.4), ("hbar", -0.8)]);
        let squared = value_of("w0^2", &lines).evaluate(&values).expect("a number");
        values.insert("w0".into(), squared.sqrt());
        let mut w = vec![squared.sqrt()];
        for m in 1..order {
            let name = format!("w{m}");
            let value = value_of(&name, &lines).evaluate(&values).expect("a number");
            values.insert(Symbol::new(&name), value);
            w.push(value);
        }
        let u: Vec<Expr> = (0..order).map(|m| value_of(&format!("u{m}"), &lines)).collect();
        // u0 has the amplitude, so that the others begin at rest at zero, as printed.
        for (m, u) in u.iter().enumerate().skip(1) {
            let start = [at(u, &values, 0.0), at(&derivative(u), &values, 0.0)];
            assert!(start.iter().all(|value| value.abs() < 1e-14), "{equation}, u{m}: {start:?}");
            assert!(lines.iter().any(|line| *line == format!("u{m}(0) = u{m}'(0) = 0")));
        }
        let accelerations: Vec<Expr> = u.iter().map(|u| derivative(&derivative(u))).collect();
        for theta in [0.2, 1.0, 2.5] {
            // N is a polynomial in q of degree 6 at most.
            let points: Vec<f64> = (0..7).map(|k| f64::from(k) / 6.0 - 0.5).collect();
            let residual = |q: f64| {
                let sum = |terms: &[Expr]| -> f64 {
                    terms
                        .iter()
                        .zip(0..)
                        .map(|(term, k)| q.powi(k) * at(term, &values, theta))
                        .sum()
                };
                let omega: f64 = w.iter().zip(0..).map(|(w, k)| q.powi(k) * w).sum();
                let x = sum(&u);
                let force: f64 = powers.iter().zip(1..).map(|(c, power)| c * x.powi(power)).sum();
                omega * omega * sum(&accelerations) + force
            };
            let matrix = DMatrix::from_fn(7, 7, |i, j| points[i].powi(j as i32));
            let right = DVector::from_iterator(7, points.iter().map(|&q| residual(q)));
            let coefficients = matrix.lu().solve(&right).expect("a regular matrix");
            for m in 1..=order as usize {
                let printed = at(&value_of(&format!("R{m}"), &lines), &values, theta);
                assert!(
                    (printed - coefficients[m - 1]).abs() < 1e-10,
                    "{equation}, R{m}: {printed} {}",
                    coefficients[m - 1]
                );
            }
        }
        for m in 1..=order as usize {
            let start = format!("no cos(theta) in R{m}:  ");
            let condition =
                lines.iter().find_map(|line| line.strip_prefix(&start)).expect("a condition");
            let value = read(condition.strip_suffix(" = 0").expect("an equation"))
                .evaluate(&values)
                .expect("a number");
            assert!(value.abs() < 1e-13, "{equation}, R{m}: {value}");
        }
    }
}

/// The printed coefficients solve the printed equations, and are those of the printed polynomials.
#[test]
fn hermite_pade_shows_the_system_it_solves() {
    for (equation, degrees) in
        [("x'' + x + eps*x^3 = 0", [1, 2, 1]), ("x'' + k*sin(x) = 0", [2, 1, 2])]
    {
        let [p, q, r] = degrees;
        let options = Options {
            method: Some(Method::HermitePade),
            degrees: Some(Degrees::Quadratic(p, q, r)),
            ..Options::default()
        };
        let solution = solution(equation, &options);
        let lines = lines(&solution);
        let mut values = numbers(&[("A", 0.9), ("eps", 0.4)]);
        let s = value_of("s", &lines).evaluate(&values).expect("a number");
        values.insert(Symbol::new("s"), s);
        for (letter, degree) in ["p", "q", "r"].into_iter().zip(degrees) {
            for k in 0..=degree {
                let name = format!("{letter}{k}");
                let value = value_of(&name, &lines).evaluate(&values).expect("a number");
                values.insert(Symbol::new(&name), value);
            }
        }
        let equations: Vec<&String> = lines.iter().filter(|line| line.ends_with(" = 0")).collect();
        assert_eq!(equations.len(), (p + q + r + 2) as usize, "{equations:?}");
        let size = values.values().fold(0.0_f64, |size, value| size.max(value.abs()));
        for equation in equations {
            let left = equation.rsplit(":  ").next().and_then(|line| line.strip_suffix(" = 0"));
            let left = read(left.expect("an equation")).evaluate(&values).expect("a number");
            assert!(left.abs() < 1e-13 * size, "{equation}: {left}");
        }
        for letter in ["P", "Q", "R"] {
            let defined = solution.definitions.iter().find(|own| own.symbol.name() == letter);
            let defined =
                defined.expect("a definition").meaning.evaluate(&values).expect("a number");
            let printed = value_of(letter, &lines).evaluate(&values).expect("a number");
            assert!((printed / defined - 1.0).abs() < 1e-12, "{letter}: {printed} {defined}");
        }
    }
}

#[test]
fn pade_shows_the_system_it_solves() {
    for (equation, degrees, small) in [
        ("x'' + x + eps*x^3 = 0", (3, 2), "eps"),
        ("x'' + sin(x) = 0", (2, 3), "A"),
        ("x'' + k*x + eps*x^3 = 0", (2, 2), "eps"),
    ] {
        let options = Options {
            method: Some(Method::Pade),
            degrees: Some(Degrees::Quotient(degrees.0, degrees.1)),
            ..Options::default()
        };
        let solution = solution(equation, &options);
        let lines = lines(&solution);
        let mut values =
            numbers(&[("A", 0.9), ("eps", 0.4), ("k", 2.0), ("omega0", 2.0_f64.sqrt())]);
        for j in 1..=degrees.1 {
            let name = format!("q{j}");
            let value = value_of(&name, &lines).evaluate(&values).expect("a number");
            values.insert(Symbol::new(&name), value);
        }
        let equations: Vec<&String> = lines.iter().filter(|line| line.ends_with(" = 0")).collect();
        assert_eq!(equations.len(), degrees.1 as usize, "{equations:?}");
        for equation in equations {
            let left = equation
                .rsplit(":  ")
                .next()
                .expect("an equation")
                .strip_suffix(" = 0")
                .expect("zero");
            assert!(read(left).evaluate(&values).expect("a number").abs() < 1e-13, "{equation}");
        }
        for i in 0..=degrees.0 {
            let start = format!("p{i} = ");
            let line = lines
                .iter()
                .find_map(|line| line.rsplit(":  ").next()?.strip_prefix(&start))
                .expect("p");
            let sides: Vec<f64> = line
                .split(" = ")
                .map(|side| read(side).evaluate(&values).expect("a number"))
                .collect();
            assert!(sides.iter().all(|side| (side - sides[0]).abs() < 1e-13), "{line}");
            values.insert(Symbol::new(&format!("p{i}")), sides[0]);
        }
        // The quotient of the printed coefficients is the law.
        let quotient = lines
            .iter()
            .find_map(|line| line.strip_prefix("agrees with:  omega^2 = "))
            .expect("a quotient");
        let printed = read(quotient).evaluate(&values).expect("a number");
        let law = &solution.law.closed_form().expect("a closed form").value;
        assert!(
            (printed - law.evaluate(&values).expect("a number")).abs() < 1e-13,
            "{equation} in {small}"
        );
    }
}

#[test]
fn iteration_perturbation_shows_what_it_freezes() {
    for (equation, factor) in [
        ("x'' + x + eps*x^3 = 0", "1 + eps*x^2"),
        ("x'' + 2*x + x^2 - eps*x^3 = 0", "2 + x - eps*x^2"),
    ] {
        let solution = solution(equation, &by(Method::IterationPerturbation, 2));
        let lines = lines(&solution);
        let values = numbers(&[("A", 0.6), ("eps", 0.4), ("omega", 1.2)]);
        for pass in 1..=2 {
            let (before, after) = (format!("x{}", pass - 1), format!("x{pass}"));
            let motion = value_of(&before, &lines);
            let start = format!("pass {pass}, the factor frozen at {before}:  ");
            let frozen =
                lines.iter().find_map(|line| line.strip_prefix(&start)).expect("the frozen factor");
            let (named, written_out) = frozen.split_once(" = ").expect("an equation");
            assert_eq!(read(named), read(&factor.replace('x', &before)));
            let written_out = read(written_out);
            let equation = lines.iter().find_map(|line| {
                line.split_once(&format!("{after}'' + omega^2*{after} = "))
                    .filter(|_| line.matches(" = ").count() > 1)
            });
            let right = equation
                .expect("the equation of the pass")
                .1
                .rsplit(" = ")
                .next()
                .expect("a right side");
            let right = read(right);
            for theta in [0.3, 1.4, 2.9] {
                let x = at(&motion, &values, theta);
                let mut values = values.clone();
                values.insert("x".into(), x);
                let factor = at(&read(factor), &values, theta);
                assert!((factor - at(&written_out, &values, theta)).abs() < 1e-12);
                let driven = (1.44 - factor) * x;
                assert!((driven - at(&right, &values, theta)).abs() < 1e-12);
                if pass == 1 {
                    // The iterate satisfies it but for the secular term.
                    let next = value_of(&after, &lines);
                    let left = 1.44
                        * (at(&derivative(&derivative(&next)), &values, theta)
                            + at(&next, &values, theta));
                    let sample = |k: u32| 2.0 * std::f64::consts::PI * f64::from(k) / 64.0;
                    let secular: f64 = (0..64)
                        .map(|k| at(&right, &values, sample(k)) * sample(k).cos())
                        .sum::<f64>()
                        / 32.0;
                    let expected = at(&right, &values, theta) - secular * theta.cos();
                    assert!((left - expected).abs() < 1e-12, "{left} {expected}");
                }
            }
        }
    }
}

/// A derivation by one term leads to its law: the equation stands in it, beside what it follows
/// from.
#[test]
fn derivations_by_one_term_end_in_their_law() {
    for equation in ["x'' + x + eps*x^3 = 0", "x'' + sin(x) = 0", "x'' + x + eps*x*abs(x) = 0"] {
        for (method, order) in [
            (Method::LindstedtPoincare, 1),
            (Method::IterationPerturbation, 1),
            (Method::HarmonicBalance, 1),
            (Method::EnergyBalance, 1),
            (Method::MaxMin, 1),
            (Method::AmplitudeFrequency, 1),
            (Method::Hamiltonian, 1),
            (Method::VariationalIteration, 1),
            (Method::FrequencyFormula, 1),
        ] {
            let options = Options {
                small: equation.contains("eps").then(|| "eps".to_owned()),
                ..by(method, order)
            };
            let solution = solution(equation, &options);
            // The orders of a polynomial force are held one by one elsewhere.
            if !solution.steps.is_empty() {
                continue;
            }
            let formula = solution.formula();
            let (name, law) = formula.split_once(" = ").expect("a law");
            let lines = lines(&solution);
            let found = lines.iter().any(|line| {
                line.contains(&format!("{name} = ")) && line.ends_with(&format!("= {law}"))
            });
            assert!(found, "{equation} by {}: {formula} in {lines:#?}", method.name());
        }
    }
}

/// The bounds of max-min against a search through f(x)/x, where it is monotonic and where it is
/// not.
#[test]
fn max_min_has_the_bounds_of_the_motion() {
    for (equation, turning) in [
        ("x'' + x + x^3 = 0", vec![]),
        ("x'' + sin(x) = 0", vec![]),
        ("x'' + x*abs(x) = 0", vec![]),
        ("x'' + x + x^3 - x^5 = 0", vec![0.5_f64.sqrt()]),
        ("x'' + x + x^3*exp(-x^2) = 0", vec![1.0]),
        ("x'' + 1e12*x - 1e26*x^3 + 1e40*x^5 = 0", vec![0.5_f64.sqrt() * 1e-7]),
        (
            "x'' + x - 3*x^3 + 3*x^5 - x^7/2 = 0",
            vec![f64::sqrt(2.0 - f64::sqrt(2.0)), f64::sqrt(2.0 + f64::sqrt(2.0))],
        ),
    ] {
        let solution = solution(equation, &by(Method::MaxMin, 1));
        let lines = lines(&solution);
        let force = Oscillator::parse(equation).expect("an equation").force;
        let quotient =
            |x: f64| force.evaluate(&BTreeMap::from([("x".into(), x)])).expect("a force") / x;
        let scale = turning.first().copied().unwrap_or(1.0);
        let found: Vec<f64> = lines
            .iter()
            .filter_map(|line| {
                line.strip_prefix("x = ")?.split_once(": q turns back")?.0.parse().ok()
            })
            .collect();
        assert_eq!(found.len(), turning.len(), "{equation}: {lines:#?}");
        for (found, expected) in found.iter().zip(&turning) {
            assert!((found / expected - 1.0).abs() < 1e-4, "{equation}: {found} {expected}");
        }
        for part in [0.3, 0.9, 1.2, 1.8, 2.6] {
            let amplitude = part * scale;
            let values = |k: u32| quotient(amplitude * f64::from(k) / 4000.0);
            let least = (1..=4000).map(values).fold(f64::INFINITY, f64::min);
            let largest = (1..=4000).map(values).fold(f64::NEG_INFINITY, f64::max);
            let mut at = numbers(&[("A", amplitude)]);
            let q_end = value_of("q_A", &lines).evaluate(&at).expect("a number");
            at.insert("q_A".into(), q_end);
            let passed = found.iter().filter(|place| **place < amplitude).count();
            let (lo, hi) = match passed {
                0 => {
                    let rest = value_of("q_rest", &lines).evaluate(&at).expect("a number");
                    (rest.min(q_end), rest.max(q_end))
                }
                _ => {
                    let number = |letter: char| {
                        let start = format!("{letter}{passed} = ");
                        let line = lines
                            .iter()
                            .find_map(|line| line.split_once(&start))
                            .expect("a bound")
                            .1;
                        line.split(',')
                            .next()
                            .and_then(|text| text.parse::<f64>().ok())
                            .expect("a number")
                    };
                    (number('L').min(q_end), number('H').max(q_end))
                }
            };
            let width = (largest - least).abs().max(1e-6 * largest.abs());
            assert!((lo - least).abs() < 2e-3 * width, "{equation} at {amplitude}: {lo} {least}");
            assert!(
                (hi - largest).abs() < 2e-3 * width,
                "{equation} at {amplitude}: {hi} {largest}"
            );
            // The share k of the bounds that stand before it gives the law, by quadrature c_1/A.
            let stated = lines.iter().any(|line| line.starts_with("k = "));
            if stated && (turning.is_empty() || passed > 0) {
                at.extend(numbers(&[("lo", lo), ("hi", hi)]));
                let share = value_of("k", &lines).evaluate(&at).expect("a number");
                let (from, to) = match passed {
                    0 => (value_of("q_rest", &lines).evaluate(&at).expect("a number"), q_end),
                    _ => (lo, hi),
                };
                let mean = |i: u32| {
                    let cosine = (std::f64::consts::PI * (f64::from(i) + 0.5) / 4000.0).cos();
                    2.0 * quotient(amplitude * cosine) * cosine * cosine / 4000.0
                };
                let law: f64 = (0..4000).map(mean).sum();
                let found = from + share * (to - from);
                assert!(
                    (found / law - 1.0).abs() < 1e-4,
                    "{equation} at {amplitude}: {found} {law}"
                );
            }
        }
    }
}

/// A dip of f(x)/x far narrower than any grid is seen from the structure of the force.
#[test]
fn max_min_sees_narrow_dips() {
    for (centre, unit) in [(2.0535_f64, 1.0_f64), (7.3, 1.0), (2.0535, 1e-6)] {
        let square = centre * unit * unit;
        let (rise, sharp) = (0.01 / (unit * unit), 3e5 / unit.powi(4));
        let equation =
            format!("x'' + x + {rise:e}*x^3 - x*exp(-{sharp:e}*(x^2 - {square:e})^2)/10 = 0");
        let lines = lines(&solution(&equation, &by(Method::MaxMin, 1)));
        let places =
            lines.iter().filter_map(|line| line.strip_prefix("x = ")?.split_once(": q turns back"));
        let places: Vec<f64> = places.map(|entry| entry.0.parse().expect("a number")).collect();
        assert_eq!(places.len(), 2, "{equation}: {lines:#?}");
        assert!((places[1] / square.sqrt() - 1.0).abs() < 1e-5, "{equation}: {places:?}");
        assert!(
            lines.iter().any(|line| line.contains("the least is L2 = 0.92")) || centre > 3.0,
            "{lines:#?}"
        );
    }
}

/// With letters in several powers the condition is said, and for which signs it holds.
#[test]
fn max_min_says_on_what_its_bounds_depend() {
    let bounds =
        |equation: &str| solution(equation, &by(Method::MaxMin, 1)).validity[0].to_string();
    assert_eq!(
        bounds("x'' + x + eps*x^3 + k*x^5 = 0"),
        "omega^2 lies between 1 and 1 + eps*A^2 + k*A^4 while 2*eps*x + 4*k*x^3 keeps its sign for 0 < x < A, \
         as it does for positive eps, k"
    );
    let mixed = bounds("x'' + x + eps*x^3 - k*x^5 = 0");
    assert!(mixed.ends_with("while 2*eps*x - 4*k*x^3 keeps its sign for 0 < x < A"), "{mixed}");
    // One power changes one way only, whatever its sign.
    assert_eq!(bounds("x'' + x - eps*x^3 = 0"), "omega^2 lies between 1 and 1 - eps*A^2");
}

/// Where the coefficients are letters, the place at which f(x)/x turns back is given by them.
#[test]
fn max_min_names_where_letters_make_it_turn() {
    let solution = solution("x'' + k*x + b*x^3 + eps*x^5 = 0", &by(Method::MaxMin, 1));
    let lines = lines(&solution);
    let values = numbers(&[("k", 2.0), ("b", 3.0), ("eps", -1.0)]);
    let line = lines.iter().find(|line| line.starts_with("it turns back")).expect("the place");
    let place =
        read(line.rsplit(" = ").next().expect("a right side")).evaluate(&values).expect("a number");
    // 2 + 3 z - z^2 is stationary at z = 3/2, where it is 17/4.
    assert!((place - 1.5).abs() < 1e-15);
    let value = value_of("q_s", &lines).evaluate(&values).expect("a number");
    assert!((value - 4.25).abs() < 1e-14);
}

/// Parameters with the names that a derivation uses stay what they are.
#[test]
fn orders_and_corrections_have_names_of_their_own() {
    let solution = solution(
        "x'' + x + eps*(W1*x^3 + y2*x^5) = 0",
        &Options { small: Some("eps".to_owned()), ..by(Method::LindstedtPoincare, 2) },
    );
    let (text, latex) = (text::steps(&solution), latex::steps(&solution));
    assert!(text.contains("W_1 = 3*eps*W1*A^2/4 + 5*eps*y2*A^4/8"), "{text}");
    assert!(text.contains("y_0'' + y_0 = 0") && !text.contains("y0"), "{text}");
    assert!(!latex.contains("y_{0}''") && latex.contains("W_{1} A^{2}"), "{latex}");
}

/// What prints as text prints as LaTeX: formulas, not comments.
#[test]
fn no_method_leaves_its_derivation_in_comments() {
    for equation in ["x'' + x + eps*x^3 = 0", "x'' + sin(x) = 0", "x'' + x + sinh(x)*atan(x)^2 = 0"]
    {
        let oscillator = Oscillator::parse(equation).expect("an equation");
        for method in Method::ALL {
            let options = Options { method: Some(method), ..Options::default() };
            let Ok(solution) = solve(&oscillator, &options) else {
                continue;
            };
            let (text, latex) = (text::steps(&solution), latex::steps(&solution));
            assert!(text.lines().count() > 2, "{equation} by {}: {text}", method.name());
            assert!(!latex.contains('%'), "{latex}");
            assert!(latex.matches("&=").count() >= 2, "{equation} by {}: {latex}", method.name());
            let whole = latex::solution(&solution, None);
            if solution.law.quadrature().is_some() {
                assert!(whole.contains("\\int_"), "{whole}");
            }
        }
    }
}
