//! Motions over two wells, through the unstable equilibrium between them, asked for by `about`:
//! their laws against elliptic functions, the energy and Runge-Kutta, where they begin and end, and
//! what is refused.

use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI, SQRT_2};

use lindstedt::expr::Expr;
use lindstedt::method::numbers::{NoNumbers, evaluate, frequency_squared_of};
use lindstedt::method::{Options, Reason, Refusal, solve, with_numbers_where_needed};
use lindstedt::numeric::period::{PeriodError, swing};
use lindstedt::oscillator::OscillatorError;
use lindstedt::solution::{Method, Note, Solution};
use lindstedt::verify::comparison::{backbones, compare};
use lindstedt::verify::{AmplitudeReach, Verdict, VerificationError, judge};
use lindstedt::{Oscillator, Symbol, Values};

fn about_zero(equation: &str) -> Oscillator {
    Oscillator::parse(equation).expect(equation).about(Expr::zero())
}

fn by(oscillator: &Oscillator, method: Method, order: Option<u32>) -> Solution {
    let options = Options { method: Some(method), order, ..Options::default() };
    solve(oscillator, &options).unwrap_or_else(|refusal| panic!("{method:?}: {refusal}"))
}

fn at(text: &str) -> Values {
    text.parse().expect("values")
}

fn note(solution: &Solution) -> String {
    let notes = solution.validity.iter();
    let found = notes.filter(|note| matches!(note, Note::CrossWell(_))).map(ToString::to_string);
    found.collect::<Vec<_>>().join("; ")
}

const TURNING_PENDULUM: &str = "x'' + sin(x)*(1 - 2*cos(x)) = 0";

/// Outside of the separatrix of -k x + c x^3 the motion is A cn(w t, m), w^2 = c A^2 - k, m = c
/// A^2/(2 w^2) (J. Guckenheimer, P. Holmes, *Nonlinear Oscillations, Dynamical Systems, and
/// Bifurcations of Vector Fields*, section 4.5).
#[test]
fn the_law_is_the_elliptic_one() {
    let oscillator = about_zero("x'' - k*x + c*x^3 = 0");
    let solution = by(&oscillator, Method::Exact, None);
    for (k, c) in [(1.0, 1.0), (0.3, 2.0), (5.0, 0.1), (1e-6, 1e6)] {
        let edge = f64::sqrt(2.0 * k / c);
        for part in [1.0001, 1.1, 1.5, 2.0, 10.0, 1e4] {
            let amplitude = part * edge;
            let rate = c * amplitude * amplitude - k;
            let quarter = ellip::ellipk(0.5 * c * amplitude * amplitude / rate).expect("below one")
                / rate.sqrt();
            let expected = PI / (2.0 * quarter);
            let numbers: BTreeMap<Symbol, f64> = [("k", k), ("c", c), ("A", amplitude)]
                .map(|(name, value)| (Symbol::new(name), value))
                .into();
            let found =
                frequency_squared_of(&oscillator, &solution, &numbers).expect("a motion").sqrt();
            assert!(
                (found / expected - 1.0).abs() < 1e-9,
                "{k} {c} {amplitude}: {found} for {expected}"
            );
        }
    }
}

#[test]
fn the_truth_is_the_runge_kutta_return() {
    let fifth: (&str, fn(f64) -> f64, &[f64]) =
        ("x'' - x + x^5 = 0", |x| x.powi(5) - x, &[1.4, -2.0]);
    let pendulum: (&str, fn(f64) -> f64, &[f64]) =
        (TURNING_PENDULUM, |x| x.sin() * (1.0 - 2.0 * x.cos()), &[1.6, 2.0, -3.0]);
    let corner: (&str, fn(f64) -> f64, &[f64]) =
        ("x'' - x + x*abs(x) = 0", |x| x * x.abs() - x, &[1.6, 5.0]);
    for (equation, force, amplitudes) in [fifth, pendulum, corner] {
        let oscillator = about_zero(equation);
        for &amplitude in amplitudes {
            let path = swing(&|_, x, _| -force(x), 0.0, amplitude, 1e3).expect("a return");
            for method in [Method::Exact, Method::HarmonicBalance, Method::EnergyBalance] {
                let solution = by(&oscillator, method, None);
                let judged = judge(&oscillator, &solution, &at(&format!("A = {amplitude}")), 0.01)
                    .expect(equation);
                assert!(
                    (judged.true_frequency * path.period() / (2.0 * PI) - 1.0).abs() < 1e-7,
                    "{equation} at {amplitude}"
                );
                assert!(judged.slope.is_none() && judged.over_several_wells);
                let deviation = judged.max_deviation.expect("a motion");
                match method {
                    Method::Exact => assert!(
                        deviation < 1e-4 && judged.verdict == Verdict::Pass,
                        "{equation}: {deviation}"
                    ),
                    _ => assert!(deviation > 1e-3, "{equation}: {deviation}"),
                }
            }
        }
    }
}

#[test]
fn where_they_begin_and_end_is_said_in_closed_form() {
    for (equation, words) in [
        ("x'' - x + x^3 = 0", "|A| > sqrt(2)"),
        ("x'' - 2*x + x^5/3 = 0", "|A| > sqrt(3*sqrt(2))"),
        ("x'' - k*x + c*x^3 = 0", "|A| > sqrt(2*k/c); for positive c, k"),
        (TURNING_PENDULUM, "pi/2 < |A| < pi"),
        ("x'' - x + x*abs(x) = 0", "|A| > 3/2"),
        (
            "x'' - k*sin(x) + c*x^3 = 0",
            "where the potential energy at A is above that of the equilibrium; for positive c, k",
        ),
    ] {
        let oscillator = about_zero(equation);
        for method in [Method::Hamiltonian, Method::Exact] {
            let said = note(&by(&oscillator, method, None));
            let begin =
                "motions through the unstable equilibrium x = 0, over the wells on both sides: ";
            assert_eq!(said, begin.to_owned() + words, "{equation}");
        }
    }
    let moved = Oscillator::parse("x'' - (x - 1) + (x - 1)^3 = 0").expect("an equation");
    let said = note(&by(&moved.about(Expr::one()), Method::HarmonicBalance, None));
    assert!(said.contains("equilibrium x = 1") && said.ends_with("|A| > sqrt(2)"), "{said}");
    // The same without being asked, where letters leave it open.
    let open = Oscillator::parse("x'' - k*x + c*x^3 = 0").expect("an equation");
    assert!(
        note(&by(&open, Method::Hamiltonian, None))
            .ends_with("|A| > sqrt(2*k/c); for positive c, k")
    );
    // About a stable equilibrium nothing of the kind is said.
    let stable = about_zero("x'' + k*x + c*x^3 = 0");
    assert_eq!(note(&by(&stable, Method::Hamiltonian, None)), "");
}

#[test]
fn a_motion_that_stays_in_one_well_is_no_motion_over_both() {
    for (equation, amplitude, least) in [
        ("x'' - x + x^3 = 0", "1.2", Some(SQRT_2)),
        ("x'' - x + x^3 = 0", "0.5", Some(SQRT_2)),
        ("x'' - x + x^3 = 0", "-1.41", Some(SQRT_2)),
        (TURNING_PENDULUM, "1.5", Some(FRAC_PI_2)),
        (TURNING_PENDULUM, "3.2", None),
        ("x'' - x + x^5 = 0", "1.3", Some(3.0_f64.powf(0.25))),
    ] {
        let oscillator = about_zero(equation);
        for method in [
            Method::Exact,
            Method::Hamiltonian,
            Method::HarmonicBalance,
            Method::ParameterExpansion,
        ] {
            let judged = judge(
                &oscillator,
                &by(&oscillator, method, None),
                &at(&format!("A = {amplitude}")),
                0.01,
            );
            match (judged, least) {
                (
                    Err(VerificationError::Period(PeriodError::OneWell { least: found, .. })),
                    Some(least),
                ) => {
                    assert!((found - least).abs() < 1e-5, "{equation}: {found}");
                }
                (Err(VerificationError::Period(PeriodError::PushedAway { .. })), None) => {}
                other => panic!("{equation} at {amplitude}: {other:?}"),
            }
        }
        assert!(compare(&oscillator, &at(&format!("A = {amplitude}")), None, 0.01).is_err());
    }
    let well = about_zero("x'' - x + x^3 = 0");
    let judged = judge(&well, &by(&well, Method::Exact, None), &at("A = sqrt(2)"), 0.01);
    assert!(
        matches!(
            judged,
            Err(VerificationError::Period(PeriodError::Separatrix { place: 0.0, .. }))
        ),
        "{judged:?}"
    );
    let exact = by(&well, Method::Exact, None);
    let numbers = [(Symbol::new("A"), 1.2)].into();
    assert!(matches!(
        evaluate(&well, &exact, &numbers),
        Err(NoNumbers::Motion(PeriodError::OneWell { .. }))
    ));
}

#[test]
fn what_expands_about_rest_refuses_and_says_what_does_not() {
    for (equation, term) in [("x'' - x + x^3 = 0", "-x"), ("x'' - k*x + c*x^3 = 0", "-k*x")] {
        let oscillator = about_zero(equation);
        for method in [
            Method::LindstedtPoincare,
            Method::Averaging,
            Method::Pade,
            Method::HermitePade,
            Method::MultipleScales,
        ] {
            let options = Options { method: Some(method), ..Options::default() };
            let refusal = solve(&oscillator, &options).expect_err("a refusal");
            match &refusal {
                Refusal { reason: Reason::PushesAway, .. } => {
                    assert_eq!(refusal.term(), Some(term))
                }
                other => panic!("{method:?}: {other}"),
            }
            assert!(refusal.help().expect("help").to_string().contains("method exact"));
        }
        assert_eq!(solve(&oscillator, &Options::default()).expect("a law").method, Method::Exact);
    }
}

/// Without being asked for they are offered where they exist, and only there; where they do not
/// exist they are refused.
#[test]
fn they_are_offered_where_they_are() {
    for (equation, offered) in [
        ("x'' - x + x^3 = 0", true),
        (TURNING_PENDULUM, true),
        ("x'' - k*x + c*x^3 = 0", true),
        ("x'' - x + x^2/10 + x^3 = 0", false),
        // The outer hilltops are lower: what passes the one in the middle never comes back.
        ("x'' - x + x^3 - 6*x^5/25 = 0", false),
    ] {
        let oscillator = Oscillator::parse(equation).expect(equation);
        let refusal = solve(&oscillator, &Options::default()).expect_err(equation);
        assert!(
            matches!(refusal.reason, Reason::Oscillator(OscillatorError::Unstable { .. })),
            "{equation}: {refusal}"
        );
        let help = refusal.help().expect("help").to_string();
        assert_eq!(
            help.contains("about x=0` for motions over the wells"),
            offered,
            "{equation}: {help}"
        );
        let asked = solve(&oscillator.about(Expr::zero()), &Options::default());
        assert_eq!(asked.is_ok(), offered, "{equation}: {asked:?}");
    }
    for equation in [
        "x'' + x'/10 - x + x^3 = 0",
        "x'' - x + x^3 = cos(t)",
        "(1 + x^2)*x'' + x*x'^2 - x + x^3 = 0",
        "x'' - sin(x) = 0",
        "x'' - x = 0",
    ] {
        for method in Method::ALL {
            let options = Options { method: Some(method), ..Options::default() };
            let refusal = solve(&about_zero(equation), &options).expect_err(equation);
            assert!(
                matches!(
                    refusal.reason,
                    Reason::Oscillator(OscillatorError::NoSuchEquilibrium { .. })
                ),
                "{equation}: {refusal}"
            );
        }
    }
}

#[test]
fn values_of_letters_may_make_rest_stable() {
    let letters = about_zero("x'' - k*x + c*x^3 = 0");
    let values = |k: &str| -> BTreeMap<Symbol, Expr> {
        [("k", k), ("c", "1")]
            .map(|(name, value)| (Symbol::new(name), value.parse().expect("a value")))
            .into()
    };
    assert_eq!(with_numbers_where_needed(&letters, &values("2")).expect("two wells"), None);
    let stable = with_numbers_where_needed(&letters, &values("-2"))
        .expect("one well")
        .expect("another equation");
    assert_eq!(
        solve(&stable, &Options::default()).expect("a law").method,
        Method::LindstedtPoincare
    );
}

/// The range of a verdict is that of the errors: within the tolerance just inside of its ends, not
/// outside.
#[test]
fn ranges_begin_and_end_where_the_error_crosses_the_tolerance() {
    let mut seen = [0, 0];
    for (equation, amplitude, last) in
        [("x'' - x + x^3 = 0", 2.0, 1e3), (TURNING_PENDULUM, 2.5, PI)]
    {
        let oscillator = about_zero(equation);
        let table =
            compare(&oscillator, &at(&format!("A = {amplitude}")), None, 0.01).expect(equation);
        for row in &table.rows {
            let error = |size: f64| {
                let judged = judge(&oscillator, &row.solution, &at(&format!("A = {size:?}")), 0.01)
                    .expect("a motion");
                judged.relative_error.map_or(f64::INFINITY, f64::abs)
            };
            let passes = row.verdict == Some(Verdict::Pass);
            match row.reach.expect("a range") {
                AmplitudeReach::Between { from, to, open }
                    if row.solution.method != Method::Exact =>
                {
                    assert!(
                        passes == (from..=to).contains(&amplitude),
                        "{equation}: {}",
                        row.solution.title()
                    );
                    assert!(
                        error(from * 1.001) <= 0.01 && error(from * 0.999) > 0.01,
                        "{}",
                        row.solution.title()
                    );
                    seen[0] += 1;
                    if !open {
                        assert!(
                            error(to * 0.999) <= 0.01 && error(to * 1.001) > 0.01,
                            "{}",
                            row.solution.title()
                        );
                        seen[1] += 1;
                    }
                }
                AmplitudeReach::Between { from, to, open } => {
                    assert!(open && passes && from < amplitude && to < last)
                }
                AmplitudeReach::Nowhere => assert!(!passes),
                other => panic!("{equation}: {other:?}"),
            }
        }
        let (truth, curves) = backbones(&oscillator, &table).expect(equation);
        assert!(truth.points.len() > 110 && curves.len() > 3, "{equation}");
    }
    assert!(seen[0] > 6 && seen[1] > 3, "{seen:?}");
}

/// Between the separatrix at rest and that of an outer hilltop a relation has a root of its own,
/// whatever becomes of it at amplitudes beyond.
#[test]
fn motions_between_two_separatrices_have_their_own_root() {
    let oscillator = about_zero("x'' - x + x^3 - x^5/10 + x^7/1000 = 0");
    for method in [Method::HomotopyPerturbation, Method::ParameterExpansion] {
        for (order, amplitudes) in [(2, ["1.7", "2", "2.5", "-3"]), (3, ["1.9", "2", "2.5", "-3"])]
        {
            let solution = by(&oscillator, method, Some(order));
            for amplitude in amplitudes {
                let judged = judge(&oscillator, &solution, &at(&format!("A = {amplitude}")), 0.01)
                    .expect("a motion");
                assert_eq!(
                    judged.verdict,
                    Verdict::Pass,
                    "{method:?} {order} at {amplitude}: {judged:?}"
                );
            }
        }
    }
    // (1 - 3 A^2/4)^2 is less than 3 A^4/32 there.
    let well = about_zero("x'' - x + x^3 = 0");
    let solution = by(&well, Method::HomotopyPerturbation, None);
    let numbers = [(Symbol::new("A"), 1.45)].into();
    let found = evaluate(&well, &solution, &numbers);
    assert!(matches!(found, Err(NoNumbers::NoneOfFirstOrder)), "{found:?}");
}

#[test]
fn a_formula_that_is_not_real_at_first_says_from_where_on() {
    let oscillator = about_zero("x'' - x + x^7 = 0");
    let solution = by(&oscillator, Method::FrequencyFormula, None);
    // f'(A/2) = 7 (A/2)^6 - 1 is zero at A = 2/7^(1/6) = 1.4460; the separatrix is at 4^(1/6)
    // = 1.2599.
    let judged = judge(&oscillator, &solution, &at("A = 1.35"), 0.01).expect("a motion");
    assert_eq!(judged.verdict, Verdict::Fail);
    let from =
        judged.ranges.iter().find(|range| range.text.contains("is positive from A = 1.44604 on"));
    assert!(from.is_some_and(|range| range.outside), "{:?}", judged.ranges);
}

/// A force that waves has a hilltop every wave: what a verdict passes lies in the range that is
/// printed, and a balance, which has many solutions there, has none.
#[test]
fn over_many_hilltops_a_balance_has_no_range() {
    let oscillator = about_zero("x'' - sin(3*x) + x/5 = 0");
    for (method, has_range) in [
        (Method::HarmonicBalance, false),
        (Method::Hamiltonian, true),
        (Method::IterationPerturbation, true),
    ] {
        let solution = by(&oscillator, method, None);
        for amplitude in ["8", "12", "24"] {
            let judged = judge(&oscillator, &solution, &at(&format!("A = {amplitude}")), 0.01)
                .expect("a motion");
            let ranges = judged.ranges.iter().filter(|range| range.text.starts_with("within"));
            let ranges: Vec<_> = ranges.collect();
            assert_eq!(!ranges.is_empty(), has_range, "{method:?} {amplitude}");
            let passes = judged.verdict == Verdict::Pass;
            assert!(
                ranges.iter().all(|range| range.outside != passes),
                "{method:?} {amplitude}: {ranges:?}"
            );
        }
    }
}
