//! Every method on every oscillator of the catalogue that it claims: the error of its frequency
//! vanishes as fast as the exact series says it must, its residual is small, its motion is that of
//! Runge-Kutta; and what the methods share they share exactly.

mod balance;
mod laws;
mod series;
mod validity;

use std::collections::BTreeMap;

use lindstedt::Values;
use lindstedt::catalog::CATALOG;
use lindstedt::exact::Rational;
use lindstedt::exact::ratio;
use lindstedt::expr::Expr;
use lindstedt::method::numbers::frequency_squared_of;
use lindstedt::method::{Options, Refusal, solve};
use lindstedt::solution::{Method, Solution};
use lindstedt::verify::{Verdict, judge, needed_values};
use lindstedt::{Oscillator, Symbol};

fn by(equation: &str, method: Method) -> Result<Solution, Refusal> {
    by_options(equation, Options { method: Some(method), ..Options::default() })
}

fn by_options(equation: &str, options: Options) -> Result<Solution, Refusal> {
    solve(&Oscillator::parse(equation).expect(equation), &options)
}

fn numbers(entries: &[(&str, f64)]) -> BTreeMap<Symbol, f64> {
    entries.iter().map(|(name, value)| (Symbol::new(name), *value)).collect()
}

/// omega^2 of an answer at an amplitude.
fn squared(equation: &str, solution: &Solution, entries: &[(&str, f64)]) -> f64 {
    let oscillator = Oscillator::parse(equation).expect(equation);
    frequency_squared_of(&oscillator, solution, &numbers(entries)).unwrap_or(f64::NAN)
}

/// The values at which an entry is judged.
fn at(solution: &Solution, size: &str) -> Values {
    let mut at = Values::default();
    let dry = solution.equation.to_string().contains("sgn(x')");
    for name in needed_values(solution) {
        let value = match name.name() {
            // A fiftieth of the force at the start, and of critical damping.
            "alpha" if dry => "1/1000",
            "zeta" => "1/50",
            "A" | "a" | "mu" => size,
            // Twice as much current as the wire can bear would leave it no equilibrium.
            "lambda" => "1/10",
            _ => "1/2",
        };
        at.insert(name, value.parse().expect("a number")).expect("a value");
    }
    at
}

/// The equations whose law is a power of the amplitude: no small parameter, no slope.
fn is_scale_free(equation: &str) -> bool {
    [
        "x'' + x^3 = 0",
        "x'' + x*abs(x) = 0",
        "x'' + sgn(x) = 0",
        "x'' + x^(1/3) = 0",
        "x'' + x^3/(1 + x^2) = 0",
    ]
    .contains(&equation)
}

#[test]
fn every_method_on_every_entry_it_claims() {
    let (mut judged, mut slopes) = (0, 0);
    for entry in CATALOG.iter().filter(|entry| !entry.is_coupled() && entry.walls.is_empty()) {
        let oscillator = Oscillator::parse(entry.equation).expect(entry.name);
        for method in Method::ALL {
            let Ok(solution) = by(entry.equation, method) else {
                continue;
            };
            // Motions that die out or are driven have no frequency to be judged by:
            // `multiple_scales.rs` holds them.
            if let Some(slow) = &solution.modulation
                && solution.limit_cycle.is_none()
                && !slow.is_conservative()
            {
                continue;
            }
            let context = format!("{} by {}", entry.name, method.name());
            // One term of a truly nonlinear force is as good at any amplitude as at any other: a
            // few per cent.
            let (size, tolerance, deviation) = match is_scale_free(entry.equation) {
                // The one-line formula was made for cubic forces, and is far off for roots.
                true if method == Method::FrequencyFormula => ("3/4", 0.4, 2.0),
                true => ("3/4", 0.2, 2.0),
                // What one term leaves out of the motion is of the order of the amplitude (a drift
                // eps*A among it).
                false => ("1/20", 1e-2, 1e-1),
            };
            let verdict = judge(&oscillator, &solution, &at(&solution, size), tolerance)
                .unwrap_or_else(|error| panic!("{context}: {error}"));
            assert_eq!(verdict.verdict, Verdict::Pass, "{context}: {verdict:?}");
            assert!(
                verdict.max_deviation.is_some_and(|value| value < deviation),
                "{context}: {verdict:?}"
            );
            let residual = if is_scale_free(entry.equation) { 1.1 } else { 0.1 };
            match &verdict.followed {
                // Not periodic: followed to a tenth of its amplitude.
                Some(followed) => assert!(
                    followed.amplitude_error.is_some_and(|value| value < 0.01),
                    "{context}: {verdict:?}"
                ),
                None => assert!(
                    verdict.residual.is_some_and(|value| value < residual),
                    "{context}: {verdict:?}"
                ),
            }
            judged += 1;
            // Irrational equilibria have rounded coefficients: their series agree only to rounding.
            if !solution.numerical
                && let Some(expected) = expected_slope(&oscillator, &solution)
                && let Some(slope) = verdict.slope
            {
                assert!(
                    (slope - expected).abs() < 0.2,
                    "{context}: slope {slope}, expected {expected}"
                );
                slopes += 1;
            }
        }
    }
    assert!(judged > 180 && slopes > 70, "{judged} answers judged, {slopes} slopes");
}

/// The exponent of the first term in which a law differs from the exact series: of a polynomial by
/// subtraction, of a closed form after its own Taylor expansion, of a relation R(omega^2) = 0 by
/// putting the exact series into it.
fn expected_slope(oscillator: &Oscillator, solution: &Solution) -> Option<f64> {
    const HIGHEST: u32 = 10;
    let small = solution.small_parameter;
    let options = Options {
        method: Some(Method::LindstedtPoincare),
        order: Some(HIGHEST),
        small: Some(small.name().to_owned()),
        amplitude: Some(solution.amplitude),
        ..Options::default()
    };
    let series = solve(oscillator, &options).ok()?;
    let exact = series.law.frequency_squared()?;
    // Symbols that either answer introduced, and one half for the parameters of the shape, as in
    // `at`.
    let half = |name: &Symbol| (*name, Expr::number(ratio(1, 2)));
    let values: BTreeMap<Symbol, Expr> =
        oscillator.parameters.iter().filter(|&&name| name != small).map(half).collect();
    let definitions = series.definitions.iter().chain(&solution.definitions);
    let meanings =
        definitions.map(|definition| (definition.symbol, definition.meaning.clone())).collect();
    let difference = if let Some(law) = solution.law.frequency_squared() {
        Expr::from(law) - Expr::from(exact)
    } else if let Some(relation) = solution.law.relation() {
        let root = Expr::from(exact).sqrt().ok()?;
        Expr::from(relation).substitute("omega".into(), &root).ok()?
    } else {
        // Powers of A below the line are multiplied away first: 2*J1(A)/A, (cos(..) - cos(A))/A^2.
        let form = solution.law.closed_form().filter(|form| form.squared)?;
        let scale = Expr::symbol("A").integer_power(2).ok()?;
        let numerator = (&form.value * &scale).expand().ok()?;
        let zero = Rational::from_integer(0.into());
        let parts = lindstedt::series::taylor(&numerator, &[(small, zero)], HIGHEST + 2).ok()?;
        Expr::divide(&Expr::sum(parts), &scale).ok()? - Expr::from(exact)
    };
    let difference = difference.substitute_all(&meanings).ok()?.substitute_all(&values).ok()?;
    let difference = difference.expand().ok()?.to_polynomial(&mut |_| None).ok()??;
    let lowest = f64::from(difference.exponent_range(small)?.0);
    (lowest <= f64::from(HIGHEST)).then_some(lowest)
}
