//! Certificates against frequencies that are known to forty digits: arithmetic-geometric means, in
//! whole numbers of another crate.

use lindstedt::certificate::{
    Certificate, CheckError, JudgedFormula, NotCertified, NotProved, RangeEnd, SizeBounds, certify,
    certify_motion, check, validity,
};
use lindstedt::exact::{Bound, Integer, Rational, from_f64, ratio, to_f64};
use lindstedt::expr::{Expr, parse_expression};
use lindstedt::report::CertificateReport;
use lindstedt::verify::motions;
use lindstedt::{Method, Options, Oscillator, Solution, Supervision, Values, solve};
use num_bigint::BigInt;
use num_traits::{Signed, Zero};
use proptest::prelude::*;
use proptest::test_runner::TestRunner;

/// Binary digits behind the point of the truth.
const BITS: u32 = 150;

fn unit() -> BigInt {
    BigInt::from(1) << BITS
}

fn fixed(value: &Rational) -> BigInt {
    let part = |integer: &Integer| integer.to_string().parse::<BigInt>().expect("an integer");
    part(value.numer()) * unit() / part(value.denom())
}

fn root(square: &BigInt) -> BigInt {
    (square * unit()).sqrt()
}

/// The arithmetic-geometric mean of two positive numbers, to some units.
fn mean(mut a: BigInt, mut b: BigInt) -> BigInt {
    for _ in 0..20 {
        (a, b) = ((&a + &b) / 2, (&a * &b).sqrt());
    }
    a
}

fn cosine(x: &BigInt) -> BigInt {
    let (mut term, mut sum) = (unit(), BigInt::zero());
    for k in 1..80_u32 {
        sum += &term;
        term = -term * x / unit() * x / unit() / (2 * k * (2 * k - 1));
    }
    sum
}

/// omega of `x'' + x + eps x^3 = 0`.
fn duffing(eps: &Rational, start: &Rational) -> Rational {
    let stiffening = eps * start * start;
    let one = ratio(1, 1);
    let half = &stiffening / Integer::from(2);
    rational(mean(root(&fixed(&(&one + &stiffening))), root(&fixed(&(one + half)))))
}

/// omega of `x'' + sin(x) = 0`.
fn pendulum(start: &Rational) -> Rational {
    let half = start / Integer::from(2);
    rational(mean(unit(), cosine(&fixed(&half))))
}

fn rational(units: BigInt) -> Rational {
    format!("{units}/{}", unit()).parse().expect("a fraction")
}

fn radius(bound: f64) -> Rational {
    from_f64(bound).expect("a finite bound")
        + ratio(1, 1_000_000_000_000_000_000)
            * ratio(1, 1_000_000_000_000_000_000)
            * ratio(1, 1_000_000)
}

/// Whether the true frequency, known to 42 digits, is in the enclosure.
fn contains(certificate: &Certificate, truth: &Rational) -> Result<bool, CheckError> {
    let frequency = check(certificate)?.frequency;
    Ok((frequency.middle - truth).abs() <= radius(frequency.radius.value()))
}

fn certified(equation: &str, order: u32, at: &str) -> (Oscillator, Solution, Values, Certificate) {
    let oscillator = Oscillator::parse(equation).expect("an equation");
    let options = Options { order: Some(order), ..Options::default() };
    let solution = solve(&oscillator, &options).expect("a solution");
    let at: Values = at.parse().expect("values");
    let (certificate, proved) = certify(&oscillator, &solution, &at)
        .unwrap_or_else(|error| panic!("{equation} at {at:?}: {error}"));
    assert_eq!(check(&certificate), Ok(proved));
    (oscillator, solution, at, certificate)
}

#[test]
fn thirty_digits_of_the_pendulum() {
    for (start, digits) in [("1/10", 32), ("3/2", 32), ("5/2", 32), ("31/10", 31)] {
        let (_, _, _, certificate) = certified("x'' + sin(x) = 0", 4, &format!("A = {start}"));
        let start: Rational = start.parse().expect("a fraction");
        assert_eq!(contains(&certificate, &pendulum(&start)), Ok(true), "A = {start}");
        let known = check(&certificate).expect("a proof").frequency.radius.value();
        assert!(known < 10.0_f64.powi(-digits), "A = {start}: {known}");
    }
}

#[test]
fn pure_cubic_stiffness_swings_with_gauss_s_constant() {
    let (_, _, _, certificate) = certified("x'' + x^3 = 0", 1, "A = 2");
    let two = fixed(&ratio(2, 1));
    // omega = agm(A, A/sqrt(2)).
    let truth = rational(mean(two.clone(), root(&two)));
    assert_eq!(contains(&certificate, &truth), Ok(true));
}

#[test]
fn the_error_of_a_formula_is_enclosed() {
    for (order, at, eps, start) in [
        (1, "eps = 1/10, A = 1", ratio(1, 10), ratio(1, 1)),
        (3, "eps = -1/3, A = 3/4", ratio(-1, 3), ratio(3, 4)),
    ] {
        let (oscillator, solution, values, certificate) =
            certified("x'' + x + eps*x^3 = 0", order, at);
        let errors = check(&certificate).expect("a proof").formula.expect("a formula");
        let formula = solution.motion_at(&values).expect("a motion");
        let truth = to_f64(&duffing(&eps, &start));
        let error = (formula.frequency() - truth).abs();
        assert!(
            errors.frequency.lower <= error + 1e-15 && error - 1e-15 <= errors.frequency.upper,
            "{errors:?}, {error}"
        );
        assert!((errors.relative.upper - error / truth).abs() < 1e-15);
        // Both motions at the same phase, the true one by Runge-Kutta.
        let samples =
            motions(&oscillator, &solution, &values).expect("a motion").expect("a real frequency");
        let apart = samples
            .truth
            .iter()
            .map(|(t, x, _)| (x - formula.displacement_at(t * truth / formula.frequency())).abs());
        let largest = apart.fold(0.0, f64::max);
        assert!(
            errors.deviation.lower * 0.999 <= largest + 1e-9
                && largest <= errors.deviation.upper + 1e-9,
            "{errors:?}, {largest}"
        );
        assert!(errors.deviation.upper < 1.001 * errors.deviation.lower);
        // No moment of fifty periods is outside.
        let period = std::f64::consts::TAU / truth;
        for (turn, (instant, x, _)) in (0..50)
            .flat_map(|turn| samples.truth.iter().step_by(8).map(move |sample| (turn, sample)))
        {
            let t = f64::from(turn) * period + instant;
            let bound = errors.deviation.upper + errors.drift.upper * t;
            assert!((x - formula.displacement_at(t)).abs() <= bound + 1e-8, "t = {t}");
        }
    }
}

#[test]
fn proved_errors_shrink_with_the_power_that_is_left_out() {
    let relative = |order: u32, eps: &str| {
        let (_, _, _, certificate) =
            certified("x'' + x + eps*x^3 = 0", order, &format!("eps = {eps}, A = 1"));
        check(&certificate).expect("a proof").formula.expect("a formula").frequency.upper
    };
    for order in 1..=5 {
        let exponent = (relative(order, "1/50") / relative(order, "1/100")).log2();
        assert!((exponent - f64::from(order + 1)).abs() < 0.1, "order {order}: {exponent}");
    }
}

#[test]
fn every_method_is_held_against_the_same_proof() {
    let oscillator = Oscillator::parse("x'' + sin(x) = 0").expect("an equation");
    let at: Values = "A = 1".parse().expect("values");
    let truth = to_f64(&pendulum(&ratio(1, 1)));
    let mut count = 0;
    for method in Method::ALL {
        let options = Options { method: Some(method), ..Options::default() };
        let Ok(solution) = solve(&oscillator, &options) else {
            continue;
        };
        let (_, proved) = match certify(&oscillator, &solution, &at) {
            Ok(proved) => proved,
            Err(NotCertified::Convention | NotCertified::Motion(_) | NotCertified::Truth(_)) => {
                continue;
            }
            Err(error) => panic!("{method:?}: {error}"),
        };
        let error = (solution.motion_at(&at).expect("a motion").frequency() - truth).abs();
        let enclosed = proved.formula.expect("a formula").frequency;
        assert!(enclosed.lower <= error + 1e-15 && error <= enclosed.upper + 1e-15, "{method:?}");
        count += 1;
    }
    assert!(count >= 8, "{count} methods");
}

#[test]
fn forces_of_every_function_of_the_evaluator() {
    for force in [
        "tanh(x)",
        "exp(x) - 1",
        "x/(1 + x^2)",
        "x/sqrt(1 + x^2)",
        "atan(3*x)",
        "log(1 + x^2)*x + x",
        "sinh(x)",
        "tan(x)",
        "sin(pi*x)",
        "x + x^2*cosh(x)",
        "x*(1 + x^2)^(2/3)",
        "x*(2 + cos(x))^(-5/3)",
        "log(2 + x) - log(2)",
        "x + sqrt(2)*x^3",
    ] {
        let oscillator = Oscillator::parse(&format!("x'' + {force} = 0")).expect("an equation");
        let solution = solve(&oscillator, &Options::default()).expect("a solution");
        let at: Values = "A = 2/5".parse().expect("values");
        let (certificate, proved) =
            certify(&oscillator, &solution, &at).unwrap_or_else(|error| panic!("{force}: {error}"));
        // The judge's own frequency comes of another way, by quadrature.
        let truth =
            lindstedt::judge(&oscillator, &solution, &at, 0.01).expect("a verdict").true_frequency;
        assert!((to_f64(&proved.frequency.middle) / truth - 1.0).abs() < 1e-12, "{force}");
        assert!(proved.frequency.radius.value() < 1e-28, "{force}: {proved:?}");
        assert!(check(&certificate).is_ok(), "{force}");
    }
}

#[test]
fn what_cannot_be_certified_is_refused_with_the_reason() {
    let refused = |equation: &str, method: Option<Method>, at: &str| {
        let oscillator = Oscillator::parse(equation).expect("an equation");
        let options = Options { method, ..Options::default() };
        let solution = solve(&oscillator, &options).expect("a solution");
        certify(&oscillator, &solution, &at.parse().expect("values")).expect_err("no certificate")
    };
    let velocity = refused("x'' + x'/5 + x = 0", None, "A = 1");
    assert!(matches!(velocity, NotCertified::NotConservative(term) if term == "x'/5"));
    assert!(
        matches!(refused("x'' + x + abs(x)*x = 0", None, "A = 1"), NotCertified::NoSeries(NotProved::NoValue(part)) if part == "abs(x)")
    );
    assert!(
        matches!(refused("x'' + sin(x) = 0", None, "A = pi/3"), NotCertified::Start(start) if start == "pi/3")
    );
    assert!(matches!(
        refused("x'' + x + x^3 = 0", Some(Method::Averaging), "a = 1"),
        NotCertified::Convention
    ));
    assert!(matches!(refused("x'' + sin(x) = 0", None, "A = 7/2"), NotCertified::Truth(_)));
    // So near the separatrix that the block would have to be larger than any.
    assert!(matches!(
        refused("x'' + sin(x) = 0", None, "A = 31415/10000"),
        NotCertified::NotProved { .. }
    ));
}

/// A change of one number of a certificate, by a power of two of its last digits.
fn change(certificate: &mut Certificate, which: u8, place: usize, bit: usize, sign: bool) {
    let by = Integer::from(if sign { 1 } else { -1 }) << bit;
    let size = certificate.inverse.len();
    match which {
        0 => certificate.mu += by,
        1 => {
            let place = place % certificate.coefficients.len();
            certificate.coefficients[place] += by;
        }
        2 => certificate.inverse[place % size][(place / size) % size] += by,
        3 => certificate.sigma += (bit % 5) as i32 - 2,
        4 => certificate.claim = &certificate.claim / Integer::from(1 + bit),
        5 => certificate.highest = 1 + bit,
        6 => certificate.odd = false,
        7 => certificate.bits += 1,
        8 => certificate.coefficients.truncate(1 + place % certificate.coefficients.len()),
        9 => {
            for row in &mut certificate.inverse {
                for entry in row {
                    *entry = Integer::zero();
                }
            }
        }
        _ => certificate.inverse_bits += 1,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn damaged_certificates_fail_or_are_true(
        (eps, start) in (-40_i64..300, 10_i64..120), changes in proptest::collection::vec((0_u8..11, 0_usize..400, 0_usize..115, any::<bool>()), 1..3)
    ) {
        let (eps, start) = (ratio(eps, 100), ratio(start, 100));
        let oscillator = Oscillator::parse(&format!("x'' + x + ({eps})*x^3 = 0")).expect("an equation");
        let solution = solve(&oscillator, &Options { order: Some(2), ..Options::default() }).expect("a solution");
        let at: Values = format!("A = {start}").parse().expect("values");
        let (mut certificate, _) = certify(&oscillator, &solution, &at).expect("a certificate");
        let truth = duffing(&eps, &start);
        prop_assert_eq!(contains(&certificate, &truth), Ok(true));
        for (which, place, bit, sign) in changes {
            change(&mut certificate, which, place, bit, sign);
        }
        certificate.claim = ratio(1, 1);
        certificate.formula = None;
        prop_assert!(contains(&certificate, &truth) != Ok(false), "{:?}", certificate);
        // Another start, and another force, are other questions.
        let (mut other, _) = certify(&oscillator, &solution, &at).expect("a certificate");
        other.start = &other.start + ratio(1, 1_000_000_000_000);
        prop_assert!(check(&other).is_err());
        other.claim = ratio(1, 1);
        other.formula = None;
        prop_assert_eq!(contains(&other, &duffing(&eps, &other.start)), Ok(true));
        let more = ratio(1, 1_000_000_000);
        let cubic = parse_expression(&format!("({more})*x^3")).expect("an expression");
        other.force = &other.force + &cubic;
        prop_assert!(contains(&other, &duffing(&(eps + more), &other.start)) != Ok(false));
    }
}

#[test]
fn motions_in_one_well_and_over_both() {
    // In the well about x = 1 of the odd force -x + x^3, and over both wells.
    for (about, start) in [("1", "A = 1/4"), ("0", "A = 2")] {
        let about = parse_expression(about).expect("a number");
        let oscillator = Oscillator::parse("x'' - x + x^3 = 0").expect("an equation").about(about);
        let solution = solve(&oscillator, &Options::default()).expect("a solution");
        let at: Values = start.parse().expect("values");
        let (certificate, proved) =
            certify(&oscillator, &solution, &at).unwrap_or_else(|error| panic!("{start}: {error}"));
        let truth =
            lindstedt::judge(&oscillator, &solution, &at, 0.01).expect("a verdict").true_frequency;
        assert!((to_f64(&proved.frequency.middle) / truth - 1.0).abs() < 1e-12, "{start}");
        assert!(check(&certificate).is_ok());
    }
}

#[test]
fn each_inequality_is_checked() {
    let (_, _, _, sound) = certified("x'' + x + eps*x^3 = 0", 2, "eps = 1, A = 1");
    let reason = |change: &dyn Fn(&mut Certificate)| {
        let mut certificate = sound.clone();
        certificate.claim = ratio(10, 1);
        certificate.formula = None;
        change(&mut certificate);
        check(&certificate).expect_err("a certificate that does not hold")
    };
    // Z1: an inverse that is none, in one column or in all.
    let without = |column: usize| {
        move |certificate: &mut Certificate| {
            certificate.inverse.iter_mut().for_each(|row| row[column] = Integer::zero())
        }
    };
    for column in 0..sound.inverse.len() {
        assert!(
            matches!(reason(&without(column)), CheckError::NotProved(NotProved::NoContraction(_))),
            "column {column}"
        );
    }
    // Z1 beyond the block: one harmonic in it, of a force whose slope has many.
    let (_, _, _, steep) = certified("x'' + sin(x) = 0", 4, "A = 3");
    let mut one = steep.clone();
    one.highest = 1;
    one.inverse = steep.inverse[..2].iter().map(|row| row[..2].to_vec()).collect();
    assert!(matches!(check(&one), Err(CheckError::NotProved(NotProved::NoContraction(_)))));
    // Y0 and Z2: too far for the curvature of the problem.
    let far = |certificate: &mut Certificate| {
        certificate.coefficients[1] += Integer::from(1) << (certificate.bits - 2)
    };
    assert!(matches!(
        reason(&far),
        CheckError::NotProved(NotProved::TooFar(_) | NotProved::TooLarge(_))
    ));
    // What is claimed.
    let claimed =
        |certificate: &mut Certificate| certificate.claim = ratio(1, i64::MAX) * ratio(1, i64::MAX);
    assert!(matches!(reason(&claimed), CheckError::ClaimedLess { what: "the radius", .. }));
    let mut boastful = sound.clone();
    if let Some(formula) = &mut boastful.formula {
        formula.deviation[1] = &formula.deviation[1] / Integer::from(2);
    }
    assert!(matches!(check(&boastful), Err(CheckError::ClaimedLess { what: "the deviation", .. })));
    let mut modest = sound.clone();
    if let Some(formula) = &mut modest.formula {
        formula.frequency_error[0] = &formula.frequency_error[0] * Integer::from(2);
    }
    assert!(matches!(
        check(&modest),
        Err(CheckError::ClaimedMore { what: "the error of the frequency", .. })
    ));
    // The symmetry.
    let even = |certificate: &mut Certificate| {
        certificate.force =
            &certificate.force + &Expr::symbol("x").integer_power(2).expect("a square")
    };
    assert_eq!(reason(&even), CheckError::NotProved(NotProved::NotOdd));
    // Sizes.
    for spoil in [
        (|certificate: &mut Certificate| certificate.inverse.truncate(2)) as fn(&mut Certificate),
        |certificate| certificate.highest = 100_000,
        |certificate| certificate.bits = 1_000_000,
        |certificate| certificate.sigma = i32::MIN,
        |certificate| certificate.mu = Integer::from(1) << 100_000,
        |certificate| certificate.force = Expr::symbol("y"),
        |certificate| certificate.coefficients = vec![Integer::zero(); 10_000],
    ] {
        assert!(matches!(reason(&spoil), CheckError::Malformed(_)));
    }
    // No motion at all.
    assert!(matches!(
        reason(&|certificate| certificate.mu = Integer::zero()),
        CheckError::NotProved(_)
    ));
    assert!(matches!(
        reason(&|certificate| certificate.coefficients = vec![]),
        CheckError::NotProved(_)
    ));
}

/// How far a formula is within a tolerance, as it is proved, and the amplitude from which on it is
/// not.
fn proved_range(
    equation: &str,
    method: Method,
    order: u32,
    at: &str,
    [from, to]: [Rational; 2],
    tolerance: f64,
) -> (Rational, RangeEnd, Solution) {
    let oscillator = Oscillator::parse(equation).expect("an equation");
    let options = Options { method: Some(method), order: Some(order), ..Options::default() };
    let solution = solve(&oscillator, &options).expect("a solution");
    let at: Values = at.parse().expect("values");
    let proved =
        validity(&oscillator, &solution, &at, [&from, &to], tolerance, Supervision::default());
    let proved = proved.unwrap_or_else(|error| panic!("{equation}: {error}"));
    assert!(
        proved.from == from && proved.within <= tolerance && proved.intervals > 0,
        "{proved:?}"
    );
    (proved.to, proved.beyond, solution)
}

#[test]
fn a_proved_range_ends_where_the_error_passes_the_tolerance() {
    let cubic = ("x'' + x - x^3/6 = 0", ratio(1, 10), ratio(12, 5));
    let sine = ("x'' + sin(x) = 0", ratio(1, 1), ratio(2, 1));
    for ((equation, from, end), order, tolerance) in [
        (&cubic, 2, 1e-3),
        (&cubic, 2, 1e-2),
        (&cubic, 4, 1e-2),
        (&cubic, 6, 1e-4),
        (&sine, 2, 1e-2),
    ] {
        let ends = [from.clone(), end.clone()];
        let (to, beyond, solution) =
            proved_range(equation, Method::LindstedtPoincare, order, "", ends.clone(), tolerance);
        let error = |amplitude: &Rational| {
            let at: Values = format!("A = {amplitude}").parse().expect("values");
            let formula = solution.motion_at(&at).expect("a motion").frequency();
            let truth = if *equation == sine.0 {
                pendulum(amplitude)
            } else {
                duffing(&ratio(-1, 6), amplitude)
            };
            (formula / to_f64(&truth) - 1.0).abs()
        };
        // Every amplitude of the range is within, and hardly one beyond it.
        for k in 0..=50 {
            let amplitude = &ends[0] + (&to - &ends[0]) * ratio(k, 50);
            assert!(error(&amplitude) <= tolerance, "order {order}, A = {}", to_f64(&amplitude));
        }
        let RangeEnd::Further(outside) = beyond else {
            panic!("order {order}: {beyond:?}");
        };
        assert!(
            error(&outside) > tolerance && to_f64(&outside) < 1.03 * to_f64(&to),
            "order {order}: {}, {}",
            to_f64(&to),
            to_f64(&outside)
        );
    }
}

/// If the error hardly grows with the amplitude, the proved range still ends where the tolerance is
/// passed: omega^2 = 1 + 3 A^2/4 for x + x^3 is off by 2.2 % at most.
#[test]
fn a_proved_range_reaches_its_end_where_the_error_is_flat() {
    let cubic = "x'' + x + x^3 = 0";
    let error = |amplitude: f64| {
        let exact = from_f64(amplitude).expect("finite");
        let truth = to_f64(&duffing(&ratio(1, 1), &exact));
        ((1.0 + 0.75 * amplitude * amplitude).sqrt() / truth - 1.0).abs()
    };
    for tolerance in [0.01, 0.02] {
        let ends = [ratio(1, 1), ratio(8, 1)];
        let (to, beyond, _) = proved_range(cubic, Method::HarmonicBalance, 1, "", ends, tolerance);
        let (mut low, mut high) = (1.0, 8.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if error(middle) <= tolerance { low = middle } else { high = middle }
        }
        let to = to_f64(&to);
        assert!(to <= high && to > 0.99 * low, "{tolerance}: {to}, {low}");
        let RangeEnd::Further(outside) = beyond else {
            panic!("{tolerance}: {beyond:?}");
        };
        assert!(error(to_f64(&outside)) > tolerance && to_f64(&outside) < 1.02 * low, "{outside}");
    }
}

#[test]
fn a_range_may_be_proved_to_its_end_or_end_with_the_well() {
    // An exact law has no error.
    let (to, beyond, _) = proved_range(
        "x'' + x + eps*x^3 = 0",
        Method::HarmonicBalance,
        1,
        "eps = 1/10",
        [ratio(1, 100), ratio(2, 1)],
        0.01,
    );
    assert_eq!((to, beyond), (ratio(2, 1), RangeEnd::Asked));
    // The edge of the well of x - x^2 is x = 1, beyond which nothing returns.
    let quadratic = "x'' + x - x^2 = 0";
    let (to, beyond, _) = proved_range(
        quadratic,
        Method::LindstedtPoincare,
        6,
        "",
        [ratio(1, 100), ratio(3, 2)],
        0.5,
    );
    assert!(
        to < ratio(1, 1)
            && matches!(beyond, RangeEnd::Open(_) | RangeEnd::Unproved(..) | RangeEnd::Further(_)),
        "{to}, {beyond:?}"
    );
    // A law without an expression.
    let oscillator = Oscillator::parse("x'' + sin(x) = 0").expect("an equation");
    let balance =
        Options { method: Some(Method::HarmonicBalance), order: Some(3), ..Options::default() };
    let solution = solve(&oscillator, &balance).expect("a solution");
    let ends = [ratio(1, 10), ratio(1, 1)];
    let refused = validity(
        &oscillator,
        &solution,
        &Values::default(),
        [&ends[0], &ends[1]],
        0.01,
        Supervision::default(),
    );
    assert!(matches!(refused, Err(NotCertified::Law(_))), "{refused:?}");
}

/// omega^2 = 1 - A^2/8 has no root at A = 3: the motion is proved without it, and its frequency to
/// thirty digits.
#[test]
fn a_motion_is_proved_where_its_formula_has_no_value() {
    let oscillator = Oscillator::parse("x'' + sin(x) = 0").expect("an equation");
    let options = Options { order: Some(2), ..Options::default() };
    let solution = solve(&oscillator, &options).expect("a solution");
    let at: Values = "A = 3".parse().expect("values");
    let refused = certify(&oscillator, &solution, &at).expect_err("no formula");
    assert!(refused.help().is_some_and(|help| help.contains("--no-formula")), "{refused}");
    let (certificate, proved) = certify_motion(&oscillator, &solution, &at).expect("a proof");
    assert!(proved.formula.is_none() && check(&certificate).as_ref() == Ok(&proved));
    assert_eq!(contains(&certificate, &pendulum(&ratio(3, 1))), Ok(true));
}

/// Half a period later the pendulum is at -A: a file that begins there with the formula for A would
/// say that it is off by 2 A.
#[test]
fn a_formula_begins_where_the_motion_does() {
    let (.., sound) = certified("x'' + sin(x) = 0", 4, "A = 3/2");
    assert!(check(&sound).expect("a proof").law_is_held);
    let reason = |change: &dyn Fn(&mut Certificate)| {
        let mut other = sound.clone();
        change(&mut other);
        check(&other).expect_err("no certificate").to_string()
    };
    let turn = |certificate: &mut Certificate| {
        certificate.start = -certificate.start.clone();
        certificate.coefficients.iter_mut().for_each(|units| *units = -&*units);
        certificate.inverse[0].iter_mut().for_each(|entry| *entry = -&*entry);
    };
    let mut alone = sound.clone();
    turn(&mut alone);
    alone.formula = None;
    assert!(check(&alone).is_ok(), "it is a motion");
    assert!(reason(&turn).contains("begins elsewhere"), "{}", reason(&turn));
    let formula = |change: fn(&mut JudgedFormula)| {
        reason(&|other: &mut Certificate| change(other.formula.as_mut().expect("a formula")))
    };
    assert!(formula(|formula| formula.frequency = -&formula.frequency).contains("not positive"));
    // Another law, and the law at another amplitude with a frequency that is right.
    assert!(
        formula(|formula| formula.law = "omega = 1 - A^2/16".to_owned())
            .contains("another frequency")
    );
    // About a place of rest that is no fraction the amplitude is that from the rounded one.
    let (.., shifted) = certified("x'' + x - cos(x) = 0", 2, "A = 1/10");
    assert!(check(&shifted).expect("a proof").law_is_held);
    let elsewhere = formula(|formula| {
        formula.law = "omega^2 = 1 - 9*A^2/32 + 7*81*A^4/(16*1536)".to_owned();
        formula.values = "A = 1".parse().expect("values");
    });
    assert!(elsewhere.contains("amplitude is not that of the motion"), "{elsewhere}");
}

/// Whatever is proved, what is printed is no stronger.
#[test]
fn every_printed_bound_is_rounded_outwards() {
    let (.., certificate) = certified("x'' + x + x^3/10 = 0", 1, "A = 1");
    let sound = check(&certificate).expect("a proof");
    let sizes = (
        proptest::collection::vec(1.0..10.0_f64, 6),
        -290_i32..280,
        -17_i32..3,
        1_u32..100_000_000,
    );
    let run = TestRunner::default().run(&sizes, |(mantissas, exponent, width, percent)| {
        let mut proved = sound.clone();
        let size = 10.0_f64.powi(exponent);
        let range = |mantissa: f64| {
            let lower = mantissa * size;
            let upper = lower * (1.0 + 10.0_f64.powi(width));
            SizeBounds { lower, upper }
        };
        proved.frequency.middle = from_f64(mantissas[0] * size).expect("finite");
        proved.frequency.radius = Bound::exactly(mantissas[1] * size * 10.0_f64.powi(width));
        let errors = proved.formula.as_mut().expect("errors");
        errors.frequency = range(mantissas[2]);
        errors.relative = range(mantissas[3]);
        errors.deviation = range(mantissas[4]);
        errors.drift = range(mantissas[5]);
        let errors = *errors;
        let report = CertificateReport {
            question: None,
            certificate: (&certificate).into(),
            certified: &proved,
            validity: None,
            tolerance: format!("{percent}e-7").parse().expect("a number"),
        };
        let text =
            lindstedt::export::text::document(&lindstedt::report::certificate(&report), usize::MAX);
        let fact = |name: &str| {
            let line = text.lines().find(|line| line.trim_start().starts_with(name));
            let line = line.unwrap_or_else(|| panic!("{name}: {text}"));
            line.trim_start()[name.len()..].trim().to_owned()
        };
        let number = |text: &str| exactly(text.trim().trim_end_matches('%').trim());
        let finite = |value: f64| from_f64(value).expect("finite");
        for (name, range, factor) in [
            ("error of the formula's omega", errors.frequency, 1),
            ("relative error", errors.relative, 100),
            ("largest deviation at one phase", errors.deviation, 1),
        ] {
            let words = fact(name);
            let between =
                words.strip_prefix("between ").and_then(|words| words.split_once(" and "));
            let [lower, upper] = match (words.strip_prefix("at most "), between) {
                (Some(upper), _) => [Rational::zero(), number(upper)],
                (None, Some((lower, upper))) => [number(lower), number(upper)],
                (None, None) => [number(&words), number(&words)],
            };
            let [least, most] =
                [range.lower, range.upper].map(|end| finite(end) * Integer::from(factor));
            prop_assert!(lower <= least && most <= upper, "{name}: {range:?}: {words}");
        }
        let words = fact("omega ");
        let (middle, radius) = words.split_once(" +- ").expect("an enclosure");
        let apart = (number(middle) - &proved.frequency.middle).abs()
            + finite(proved.frequency.radius.value());
        prop_assert!(apart <= number(radius), "{words}: {:?}", proved.frequency);
        let words = fact("deviation in time");
        let (_, bound) = words.split_once("<= ").expect("a bound");
        let (deviation, drift) = bound.split_once(" + ").expect("two terms");
        let (drift, _) = drift.split_once("*|t|").expect("a factor");
        prop_assert!(number(deviation) >= finite(errors.deviation.upper), "{words}");
        prop_assert!(number(drift) >= finite(errors.drift.upper), "{words}");
        // The tolerance is that which was meant, in full.
        let words = fact("verdict");
        let tail = words.split_once(" within ").or_else(|| words.split_once(" beyond "));
        let (shown, _) = tail.and_then(|(_, tail)| tail.split_once(" %")).expect("a tolerance");
        prop_assert_eq!(number(shown), ratio(i64::from(percent), 100_000));
        Ok(())
    });
    run.unwrap_or_else(|error| panic!("{error}"));
}

/// The fraction of a decimal, `2.5e-33`.
fn exactly(text: &str) -> Rational {
    let (digits, exponent) = text.split_once('e').unwrap_or((text, "0"));
    let decimals = digits.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let count: Rational = digits.replace('.', "").parse().expect("digits");
    count * ratio(10, 1).pow(exponent.parse::<i32>().expect("an exponent") - decimals as i32)
}
