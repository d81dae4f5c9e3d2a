//! Homotopy perturbation against published relations, other methods and the exact frequency.

use lindstedt::exact::Polynomial;
use lindstedt::expr::{Expr, parse_expression};
use lindstedt::method::numbers::{evaluate, frequency_squared_of};
use lindstedt::method::{Options, solve};
use lindstedt::solution::{Method, Solution};
use lindstedt::{Oscillator, Symbol};

fn derive(equation: &str, order: u32) -> Solution {
    let oscillator = Oscillator::parse(equation).expect("an oscillator");
    let method = Some(Method::HomotopyPerturbation);
    solve(&oscillator, &Options { method, order: Some(order), ..Options::default() })
        .expect("a solution")
}

fn polynomial(text: &str) -> Polynomial {
    let expression = parse_expression(text).expect("an expression");
    expression.to_polynomial(&mut |_| None).expect("short").expect("a polynomial")
}

/// omega at eps = s, A = 1.
fn frequency(solution: &Solution, s: f64) -> f64 {
    let value = |symbol: Symbol| Some(if symbol.name() == "eps" { s } else { 1.0 });
    solution.frequency_squared_at(&value).expect("a root").sqrt()
}

const DUFFING: &str = "x'' + x + eps*x^3 = 0";

#[test]
fn the_relation_of_duffing_to_order_six() {
    // Om = 1 + 3/4 s - 3/128 s^2/Om + 21/131072 s^4/Om^3 - 33/16777216 s^6/Om^5, times Om^5.
    let expected = "omega^12 - omega^10 - 3*eps*A^2*omega^10/4 + 3*eps^2*A^4*omega^8/128 - 21*eps^4*A^8*omega^4/131072 \
                    + 33*eps^6*A^12/16777216";
    assert_eq!(derive(DUFFING, 6).law.relation(), Some(&polynomial(expected)));
}

#[test]
fn odd_orders_of_duffing_beyond_the_first_add_nothing() {
    // In units of omega^2 the motion solves y'' + b y + c y^3 = 0 with period 2 pi and amplitude 1,
    // so that b = (2K/pi)^2 (1 - 2m) and c = 2m (2K/pi)^2. Jacobi's imaginary modulus, m -> -m/(1 -
    // m), K -> sqrt(1 - m) K, turns c into -c and leaves b + 3c/4 as it is: beyond the first, all
    // corrections of b are even in c.
    for order in [2, 4] {
        assert_eq!(derive(DUFFING, order).law, derive(DUFFING, order + 1).law);
    }
    assert_ne!(derive(DUFFING, 3).law, derive(DUFFING, 4).law);
}

#[test]
fn the_first_order_is_the_papers_equation_12() {
    let solution = derive("x'' + x - x^3/6 = 0", 1);
    assert_eq!(solution.law.frequency_squared(), Some(&polynomial("1 - A^2/8")));
    assert_eq!(
        derive("x'' + sin(x) = 0", 1).law.frequency_squared(),
        Some(&polynomial("1 - A^2/8"))
    );
}

#[test]
fn the_second_order_is_a_square_root() {
    let solution = derive(DUFFING, 2);
    let text = solution.law.closed_form().expect("a closed form").to_string();
    let root = parse_expression(text.strip_prefix("omega^2 = ").expect("omega^2 = ..."))
        .expect("an expression");
    for s in [-0.5, 0.1, 1.0, 2.0, 100.0] {
        let value =
            root.evaluate(&[("eps".into(), s), ("A".into(), 1.0)].into()).expect("a number");
        assert!((value.sqrt() / frequency(&solution, s) - 1.0).abs() < 1e-14);
        let by_hand: f64 = 0.5 * (1.0 + 0.75 * s + f64::sqrt(1.0 + 1.5 * s + 15.0 / 32.0 * s * s));
        assert!((value - by_hand).abs() < 1e-13 * by_hand);
    }
}

#[test]
fn uniformly_close_to_the_elliptic_frequency() {
    for (order, bound) in [(1, 0.022_3), (2, 0.000_31), (4, 0.000_008)] {
        let solution = derive(DUFFING, order);
        for s in [0.01, 0.1, 0.5, 1.0, 2.0, 5.0, 10.0, 100.0, 1e4, 1e6] {
            let exact = std::f64::consts::PI * f64::sqrt(1.0 + s)
                / (2.0 * ellip::ellipk(s / (2.0 * (1.0 + s))).expect("an elliptic integral"));
            let error = frequency(&solution, s) / exact - 1.0;
            assert!(error.abs() <= bound, "order {order}, s = {s}: {error}");
        }
        // At s = -0.9 the errors are 12.6, -1.5 and 0.2 %.
        let exact = std::f64::consts::PI * f64::sqrt(0.1)
            / (2.0 * ellip::ellipk(-4.5).expect("an elliptic integral"));
        let expected = [(1, 0.126), (2, -0.015), (4, 0.002)]
            .iter()
            .find(|entry| entry.0 == order)
            .expect("listed")
            .1;
        let error = frequency(&solution, -0.9) / exact - 1.0;
        assert!((error / expected - 1.0_f64).abs() < 0.3, "order {order}: {error}");
    }
}

#[test]
fn every_order_of_the_motion() {
    let solution = derive(DUFFING, 1);
    assert_eq!(solution.displacement.cosine(3).mean().0, polynomial("eps*A^3/(32*omega^2)"));
    // The conditions x(0) = A, x'(0) = 0 hold at every order.
    for order in 1..5 {
        assert_eq!(derive(DUFFING, order).displacement.at_zero().mean().0, polynomial("A"));
    }
}

#[test]
fn a_branch_that_ends_gives_no_number() {
    // omega^2 = 1 - A^2/8 is zero at sqrt 8.
    let value = |symbol: Symbol| (symbol.name() == "A").then_some(2.9);
    let squared = derive("x'' + x - x^3/6 = 0", 2).frequency_squared_at(&value);
    assert!(squared.is_none_or(|squared| squared > 0.0), "{squared:?}");
}

/// omega of Duffing's equation by the complete elliptic integral.
fn duffing_exactly(s: f64) -> f64 {
    std::f64::consts::PI * (1.0 + s).sqrt()
        / (2.0 * ellip::ellipk(s / (2.0 * (1.0 + s))).expect("a value"))
}

#[test]
fn the_branch_of_the_linear_frequency_at_any_amplitude_and_scale() {
    // Order 2 is within 0.031 % for every s >= 0, and the orders above within that.
    for order in [2, 3, 4, 6, 9, 14, 20] {
        let solution = derive("x'' + k*x + eps*x^3 = 0", order);
        for power in -16..=60 {
            let s = 2.3 * 10.0_f64.powf(f64::from(power) / 2.0);
            for (k, amplitude) in [(1.0, 1.0), (1e18, -1e-9), (1e-20, 1e12)] {
                let value = |symbol: Symbol| {
                    Some(match symbol.name() {
                        "k" => k,
                        "eps" => s * k / (amplitude * amplitude),
                        "omega0" => f64::sqrt(k),
                        _ => amplitude,
                    })
                };
                let omega = solution.frequency_squared_at(&value).expect("a root").sqrt();
                let error = omega / k.sqrt() / duffing_exactly(s) - 1.0;
                assert!(error.abs() < 3.2e-4, "order {order}, s = {s:e}, k = {k}: {error}");
            }
        }
    }
}

#[test]
fn a_branch_ends_where_its_discriminant_vanishes() {
    use lindstedt::solution::Branch;
    // Order 2 of the softening spring: (1 + 3 s/4)^2 = 3 s^2/32, at s = -0.9471...
    let ending = -1.0 / (0.75 + (3.0_f64 / 32.0).sqrt());
    let solution = derive(DUFFING, 2);
    let at = |amplitude: f64| {
        let value = |symbol: Symbol| Some(if symbol.name() == "eps" { -1.0 } else { amplitude });
        solution.branch_at(&value)
    };
    let edge = (-ending).sqrt();
    assert!(matches!(at(0.999_999 * edge), Some(Branch::At { .. })));
    for amplitude in [1.000_001 * edge, 2.0, 1e6] {
        let found = at(-amplitude);
        assert!(
            matches!(found, Some(Branch::Ends(end)) if (end / edge + 1.0).abs() < 1e-8),
            "{found:?} {edge}"
        );
    }
}

#[test]
fn forces_without_a_linear_part_start_from_their_lowest_power() {
    // Mixed powers: cubic at small amplitudes, of the fifth degree at large ones; omega of each by
    // Gamma functions.
    let oscillator = Oscillator::parse("x'' + x^3 + x^5 = 0").expect("an oscillator");
    let options =
        Options { method: Some(Method::ParameterExpansion), order: Some(2), ..Options::default() };
    let solution = solve(&oscillator, &options).expect("a solution");
    let omega = |amplitude: f64| {
        let value = |symbol: Symbol| (symbol.name() == "A").then_some(amplitude);
        solution.frequency_squared_at(&value).expect("a root").sqrt()
    };
    assert!((omega(1e-12) / 1e-12 / 0.847213 - 1.0).abs() < 2e-3, "{}", omega(1e-12));
    assert!((omega(1e12) / 1e24 / 0.746834 - 1.0).abs() < 2e-2, "{}", omega(1e12));
    let (below, above) = (omega(0.999), omega(1.001));
    assert!(below < above && above < 1.01 * below, "{below} {above}");
}

/// What the validity says of homotopy analysis and of iteration perturbation is what was done.
#[test]
fn validity_says_what_is_open_and_where_it_was_cut() {
    let of = |method, equation: &str, order, hbar: Option<&str>| {
        let options = Options {
            method: Some(method),
            order,
            hbar: hbar.map(|text| text.parse().expect("a number")),
            ..Options::default()
        };
        solve(&Oscillator::parse(equation).expect("an equation"), &options).expect("a solution")
    };
    let says = |solution: &Solution, words: &str| {
        solution.validity.iter().any(|note| note.to_string().contains(words))
    };
    // Where hbar is open it is said to be; the first order and a given one leave nothing open.
    for (order, hbar, open) in [
        (Some(2), None, true),
        (None, None, true),
        (Some(1), None, false),
        (Some(3), Some("-1"), false),
    ] {
        let solution = of(Method::HomotopyAnalysis, DUFFING, order, hbar);
        assert_eq!(
            says(&solution, "hbar controls the convergence"),
            open,
            "{:?}",
            solution.validity
        );
    }
    let solution = of(Method::IterationPerturbation, DUFFING, None, None);
    assert!(!says(&solution, "cut after"), "{:?}", solution.validity);
    let solution = of(Method::IterationPerturbation, "x'' + sin(x) = 0", None, None);
    let highest = solution.displacement.highest_harmonic();
    assert!(
        says(&solution, &format!("the motion is cut after its harmonic {highest}")),
        "{:?}",
        solution.validity
    );
    let solution = of(Method::IterationPerturbation, "x'' + k*x + x^3 = 0", Some(2), None);
    let words = "after 2 passes; the frequency is the root that continues omega0^2 from A = 0";
    assert!(says(&solution, words), "{:?}", solution.validity);
}

/// The hbar in use stands beside its formula in every format, whatever the parameters are called.
#[test]
fn a_table_says_which_hbar_was_used() {
    use lindstedt::Values;
    use lindstedt::export::{json, latex, text};
    use lindstedt::verify::comparison::compare;
    for (parameter, own) in [("eps", "hbar"), ("hbar", "hbar_")] {
        let oscillator =
            Oscillator::parse(&format!("x'' + x + {parameter}*x^3 = 0")).expect("an oscillator");
        let mut at = Values::default();
        at.insert("A".into(), "2".parse().expect("a number")).expect("a value");
        at.insert(parameter.into(), "1".parse().expect("a number")).expect("a value");
        let comparison = compare(&oscillator, &at, Some("A"), 0.01).expect("a table");
        let row =
            comparison.rows.iter().find(|row| row.solution.method == Method::HomotopyAnalysis);
        let (name, value) = row.and_then(|row| row.chosen_hbar()).expect("a chosen one");
        assert_eq!(name.name(), own);
        // That of homotopy perturbation is -1; the one of least residual is near.
        assert!((-1.1..-0.5).contains(&value), "{value}");
        let value = value.to_string();
        let digits = &value[..6];
        let table = latex::comparison(&comparison);
        assert!(table.contains(&format!("{} = {digits}", latex::symbol(name))), "{digits} {table}");
        let table = text::comparison(&comparison, usize::MAX);
        assert!(table.contains(&format!("{own} = {digits}")), "{digits} {table}");
        let table = serde_json::to_string(&json::comparison(&comparison)).expect("JSON");
        assert!(table.contains(&format!("\"{own}\":{digits}")), "{digits} {table}");
    }
}

/// A load whose equilibrium is no fraction, in units in which the coefficients of the formula leave
/// the range of doubles, and in units in which they are of order one: omega^2 scales with the unit
/// of time alone.
#[test]
fn formulas_hold_in_any_units() {
    let mut compared = 0;
    for (large, small, amplitude) in [
        (
            "x'' + 1e16*x + 66e38*x^3 + 218e61*x^5 - 1380 = 0",
            "x'' + x + 0.66*x^3 + 0.218*x^5 - 0.138 = 0",
            "2.24",
        ),
        (
            "x'' + 1e16*x + 3e26*x^2 + 66e38*x^3 - 1380 = 0",
            "x'' + x + 0.03*x^2 + 0.66*x^3 - 0.138 = 0",
            "11.5",
        ),
    ] {
        for (method, order) in [
            (Method::IterationPerturbation, 2),
            (Method::HomotopyAnalysis, 3),
            (Method::HomotopyPerturbation, 3),
            (Method::LindstedtPoincare, 4),
        ] {
            let squared = |equation: &str, amplitude: String| {
                let oscillator = Oscillator::parse(equation).expect(equation);
                let options = Options {
                    method: Some(method),
                    order: Some(order),
                    hbar: (method == Method::HomotopyAnalysis).then(|| Expr::from(-1)),
                    ..Options::default()
                };
                let solution = solve(&oscillator, &options).expect(equation);
                let at = [("A".into(), amplitude.parse().expect("a number"))].into();
                evaluate(&oscillator, &solution, &at).map(|found| found.frequency_squared)
            };
            let (found, expected) =
                (squared(large, format!("{amplitude}e-12")), squared(small, amplitude.to_owned()));
            match (found, expected) {
                (Ok(found), Ok(expected)) => {
                    compared += 1;
                    let error = found / 1e16 / expected - 1.0;
                    assert!(error.abs() < 1e-9, "{large} {method:?}: {found} {expected}");
                }
                (found, expected) => {
                    assert!(found.is_err() && expected.is_err(), "{found:?} {expected:?}")
                }
            }
        }
    }
    assert!(compared >= 6, "{compared}");
}

/// Where the first frequency is not real there is no hbar to look for, and the reason is said.
#[test]
fn homotopy_analysis_says_where_its_first_frequency_is_not_real() {
    let oscillator =
        Oscillator::parse("x'' + 1.32*tanh(6830*x) + 0.703*x = 0").expect("an oscillator");
    let options =
        Options { method: Some(Method::HomotopyAnalysis), order: Some(3), ..Options::default() };
    let solution = solve(&oscillator, &options).expect("a solution");
    let at = |amplitude: f64| evaluate(&oscillator, &solution, &[("A".into(), amplitude)].into());
    let refused = at(3.88).expect_err("not real");
    assert!(refused.to_string().contains("w0 has no real value"), "{refused}");
    assert!(at(1e-5).is_ok());
}

/// The frequency alone comes from the series in hbar with which that is chosen, the numbers of an
/// answer from its formula.
#[test]
fn the_frequency_at_the_chosen_hbar_is_that_of_the_formula() {
    for equation in ["x'' + sin(x) = 0", "x'' + 4*x + x^3 = 0", "x'' + x^3 = 0"] {
        let oscillator = Oscillator::parse(equation).expect("an oscillator");
        let options = Options {
            method: Some(Method::HomotopyAnalysis),
            order: Some(4),
            ..Options::default()
        };
        let solution = solve(&oscillator, &options).expect("a solution");
        for amplitude in [0.5, 1.5, -2.0] {
            let at = [("A".into(), amplitude)].into();
            let alone = frequency_squared_of(&oscillator, &solution, &at).expect("a frequency");
            let whole = evaluate(&oscillator, &solution, &at).expect("numbers").frequency_squared;
            assert!((alone / whole - 1.0).abs() < 1e-12, "{equation}: {alone} {whole}");
        }
    }
}
