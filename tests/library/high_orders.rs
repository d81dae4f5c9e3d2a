//! What high orders buy: singularities of the frequency, and values far beyond them.

use lindstedt::exact::{Integer, Rational, ratio, to_f64};
use lindstedt::series::singularity::Estimate;
use lindstedt::solution::Convergence;
use lindstedt::verify::{converges, nearest_singularity};
use lindstedt::{Options, Oscillator, Solution, Symbol, solve};

/// The frequency alone to an order.
fn frequency(equation: &str, order: u32) -> Solution {
    let options = Options {
        order: Some(order),
        frequency_alone: true,
        ..Options::default()
    };
    solve(&Oscillator::parse(equation).expect("an equation"), &options).expect("a series")
}

const VAN_DER_POL: &str = "x'' - mu*(1 - x^2)*x' + x = 0";

fn found(equation: &str, order: u32) -> Convergence {
    converges(&frequency(equation, order)).unwrap_or_else(|| panic!("{equation}: no singularity"))
}

/// Whether an estimate is right: within its error and what it is rounded by.
fn holds(estimate: &Estimate, truth: &Rational) -> bool {
    to_f64(&(&estimate.value - truth)).abs() <= 1.5 * estimate.error
}

/// A number of many digits.
fn number(text: &str) -> Rational {
    let (whole, fraction) = text.split_once('.').expect("a decimal point");
    let digits: Integer = format!("{whole}{fraction}").parse().expect("digits");
    Rational::new(digits, Integer::from(10).pow(fraction.len() as u32))
}

/// Where the true motion takes for ever: on the separatrix, real or not. The pendulum stands upright at pi; a hardening spring has
/// its separatrix at `eps A^2 = -1`; `x + x^2` lets go of what starts at 1/2.
#[test]
fn conservative_motions_are_singular_on_their_separatrix() {
    let pi = number("3.14159265358979323846264338327950288419716939937510");
    let cases = [
        ("x'' + sin(x) = 0", 80, "A^2", &pi * &pi, 1e-12),
        ("x'' + x + eps*x^3 = 0", 40, "eps*A^2", ratio(-1, 1), 1e-10),
        ("x'' + k*x + eps*x^3 = 0", 40, "eps*A^2/omega0^2", ratio(-1, 1), 1e-10),
        ("x'' + x + x^2 = 0", 40, "A", ratio(1, 2), 1e-12),
    ];
    for (equation, order, variable, place, precision) in cases {
        let found = found(equation, order);
        assert_eq!(found.variable_in_words(), variable, "{equation}");
        let [real, imaginary] = &found.nearest.place;
        assert!(holds(real, &place) && real.error < precision, "{equation}: {found:?}");
        assert_eq!(imaginary.value, ratio(0, 1), "{equation}: {found:?}");
        // The period grows like a logarithm there.
        let exponent = found.nearest.exponent.as_ref().expect("a logarithm");
        assert_eq!(exponent.value, ratio(0, 1), "{equation}: {found:?}");
    }
    let (symbol, radius) = found("x'' + sin(x) = 0", 80).in_symbol().expect("the amplitude alone");
    assert_eq!(symbol, Symbol::new("A"));
    assert!(holds(&radius, &pi), "{radius:?}");
}

/// C. M. Andersen and J. F. Geer, SIAM J. Appl. Math. 42 (1982) 678-693: branch points of omega in mu^2 at a distance of about 3.42.
#[test]
fn the_branch_points_of_van_der_pol() {
    let found = found(VAN_DER_POL, 120);
    let nearest = &found.nearest;
    assert_eq!((found.variable_in_words().as_str(), found.highest), ("mu^2", 60));
    assert!(nearest.radius.error < 1e-11 && nearest.angle.error < 1e-11, "{found:?}");
    assert!((to_f64(&nearest.radius.value) - 3.42).abs() < 0.005, "{found:?}");
    assert_eq!(nearest.exponent.as_ref().expect("a square root").value, ratio(1, 2));
    let (_, size) = found.in_symbol().expect("mu alone");
    assert!((to_f64(&size.value) - 1.85).abs() < 0.005, "{size:?}");
    // Another way to it: the recurrence that the coefficients of a pair obey, by least squares in doubles.
    let law = frequency(VAN_DER_POL, 120);
    let law = law.law.frequency_squared().expect("a series");
    let coefficients: Vec<f64> = law.terms().map(|(_, number)| to_f64(number)).collect();
    let other = nearest_singularity(&coefficients).expect("a pair");
    assert!(
        (other.radius / to_f64(&nearest.radius.value) - 1.0).abs() < 1e-4,
        "{other:?} {found:?}"
    );
    assert!(
        (other.angle - to_f64(&nearest.angle.value)).abs() < 1e-4,
        "{other:?} {found:?}"
    );
    // More coefficients move it by no more than fewer said.
    let further = converges(&frequency(VAN_DER_POL, 170)).expect("the same");
    assert!(further.nearest.radius.error < 1e-16, "{further:?}");
    for place in 0..2 {
        assert!(
            holds(&nearest.place[place], &further.nearest.place[place].value),
            "{found:?} {further:?}"
        );
    }
}
