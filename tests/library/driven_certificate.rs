//! Certificates of driven motions against what is known of them otherwise: exact solutions,
//! shooting, damage.

use lindstedt::certificate::{
    Certified, CheckError, DampedCertificate, NotCertified, NotProved, certify_driven, check_damped,
};
use lindstedt::exact::{Integer, Rational, from_f64, ratio, to_f64};
use lindstedt::export::json;
use lindstedt::expr::{CompiledFunction, Expr, parse_expression};
use lindstedt::method::{Options, solve, with_resonance_at};
use lindstedt::numeric::periodic::periodic_motion;
use lindstedt::solution::Method;
use lindstedt::{Oscillator, Symbol, Values};
use num_traits::{Signed as _, Zero as _};
use proptest::prelude::*;

const DUFFING: &str = "x'' + x'/10 + x + x^3/10 - 3*cos(Omega*t)/10 = 0";

fn certified(equation: &str, at: &str) -> Result<(DampedCertificate, Certified), NotCertified> {
    let oscillator = Oscillator::parse(equation).expect(equation);
    let at: Values = at.parse().expect("values");
    let derived = |options: &Options| {
        let asked = with_resonance_at(&oscillator, options, &at).expect(equation);
        solve(&oscillator, &asked).expect(equation)
    };
    // A linear equation has its exact motion by default, and it is the amplitude of slow equations
    // that is certified.
    let solution = match derived(&Options::default()) {
        exact if exact.method == Method::Exact => {
            derived(&Options { method: Some(Method::MultipleScales), ..Options::default() })
        }
        other => other,
    };
    certify_driven(&oscillator, &solution, &at)
}

fn proved(equation: &str, at: &str) -> (DampedCertificate, Certified) {
    certified(equation, at).unwrap_or_else(|error| panic!("{equation} at {at}: {error}"))
}

/// Position and velocity at t = 0 of the approximate motion, in doubles.
fn start(certificate: &DampedCertificate, omega: f64) -> [f64; 2] {
    let value = |units: &Integer| {
        to_f64(&Rational::new(units.clone(), Integer::from(1) << certificate.bits))
    };
    let position = certificate.cosines.iter().map(value).sum();
    let velocity: f64 =
        certificate.sines.iter().enumerate().map(|(k, units)| k as f64 * value(units)).sum();
    [position, omega * velocity]
}

/// A linear oscillator: `a^2 ((1 - Omega^2)^2 + (c Omega)^2) = F^2`, exactly.
#[test]
fn the_amplitude_of_a_linear_oscillator_is_enclosed() {
    for omega in [ratio(9, 10), ratio(1, 1), ratio(7, 5)] {
        let (_, proof) =
            proved("x'' + x'/5 + x - cos(Omega*t)/10 = 0", &format!("Omega = {omega}"));
        let amplitude = proof.amplitude.expect("an amplitude");
        assert!(amplitude.radius.value() < 1e-30, "{omega}");
        let radius = ratio(1, 1_000_000_000_000_000).pow(2);
        let square = &omega * &omega;
        let weight = (ratio(1, 1) - &square).pow(2) + ratio(1, 25) * &square;
        let excess = |value: Rational| &value * &value * &weight - ratio(1, 100);
        assert!(excess(&amplitude.middle - &radius).is_negative(), "{omega}");
        assert!(excess(&amplitude.middle + &radius).is_positive(), "{omega}");
    }
}

/// The true motion by shooting on the equation as it was typed, which shares nothing with the
/// series: its start, its amplitude, and the deviation of nothing less than what is proved.
#[test]
fn shooting_finds_what_is_proved() {
    for (equation, at, periods, odd) in [
        (DUFFING, "Omega = 6/5", 1, true),
        ("x'' + x'/20 + sin(x) - cos(Omega*t)/10 = 0", "Omega = 9/10", 1, true),
        // In a letter that stands for a wave of the drive in certificates.
        ("s'' + s'/20 + sin(s) - cos(Omega*t)/10 = 0", "Omega = 9/10", 1, true),
        ("x'' + x'/20 + x + x^2/5 - cos(Omega*t)/5 = 0", "Omega = 1/2", 1, false),
        ("x'' + x'/20 + x + x^2/5 - sin(Omega*t + 1/3)/20 = 0", "Omega = 1", 1, false),
        ("x'' + x'/50 + (1 + cos(Omega*t)/5)*x + x^3/10 = 0", "Omega = 101/50", 2, true),
        ("x'' + x'/50 + x + x^3/10 - 5*cos(Omega*t) = 0", "Omega = 4", 3, true),
        ("x'' - (1 - x^2)*x'/10 + x - cos(Omega*t)/10 = 0", "Omega = 101/100", 1, true),
    ] {
        let (certificate, proof) = proved(equation, at);
        assert_eq!(
            (certificate.odd, certificate.drive.as_ref().map(|drive| drive.periods)),
            (odd, Some(periods)),
            "{equation}"
        );
        let values: Values = at.parse().expect("values");
        let omega = values.get(Symbol::new("Omega")).expect("a frequency");
        let oscillator = Oscillator::parse(equation).expect(equation);
        let names =
            [Symbol::new("t"), oscillator.coordinate, oscillator.velocity(), Symbol::new("Omega")];
        let force = CompiledFunction::new(&oscillator.force, &names).expect("a function");
        let acceleration = |t: f64, x: f64, v: f64| -force.call(&[t, x, v, omega]);
        let period = std::f64::consts::TAU * periods as f64 / omega;
        let begin = start(&certificate, omega / periods as f64);
        let found = periodic_motion(&acceleration, period, begin, 1.0, &[]).expect(equation);
        let (x, v) = found.phase_point_at(0.0);
        assert!(
            (x - begin[0]).abs() < 1e-8 && (v - begin[1]).abs() < 1e-8,
            "{equation}: {x} {v} {begin:?}"
        );
        let drive = certificate.drive.as_ref().expect("a drive");
        let own = found.harmonic(u32::try_from(drive.harmonic).expect("small"));
        let amplitude = proof.amplitude.as_ref().expect("an amplitude");
        assert!((to_f64(&amplitude.middle) - own).abs() < 1e-8, "{equation}: {own}");
        assert_eq!(check_damped(&certificate).as_ref(), Ok(&proof), "{equation}");
        let document = json::damped_certificate(&certificate);
        let text = serde_json::to_string(&document).expect("text");
        let read: json::DampedCertificateDocument =
            serde_json::from_str(&text).expect("a document");
        assert_eq!(read.read().expect("a certificate"), certificate, "{equation}");
    }
}

/// X any number of periods of the drive later is a motion too, and -X where the equation is its own
/// mirror image: whichever of them a file has, or its formula, the deviation is the same.
#[test]
fn a_formula_is_held_against_the_nearest_of_equal_motions() {
    // The places at which the deviation is looked at are others.
    let is_same = |one: f64, other: f64| (one / other - 1.0).abs() < 1e-3;
    for (equation, about, at, copies) in [
        // Period two, and -X is X a period of the drive later.
        ("x'' + x'/50 + (1 + cos(Omega*t)/5)*x + x^3/10 = 0", 0, "Omega = 101/50", 2),
        ("x'' + x'/50 + x + x^3/10 - 5*cos(Omega*t) = 0", 0, "Omega = 4", 3),
        ("x'' + x'/20 + x + x^2/5 - cos(Omega*t)/5 = 0", 0, "Omega = 1/2", 1),
        (DUFFING, 0, "Omega = 6/5", 1),
        // In one of two wells: the mirror image is in the other, half a period later.
        ("x'' + x'/10 - x/2 + x^3/2 - cos(Omega*t)/50 = 0", 1, "Omega = 1", 2),
    ] {
        let oscillator =
            Oscillator::parse(equation).expect(equation).about(Expr::number(ratio(about, 1)));
        let at: Values = at.parse().expect("values");
        let asked = with_resonance_at(&oscillator, &Options::default(), &at).expect(equation);
        let solution = solve(&oscillator, &asked).expect(equation);
        let (certificate, proof) = certify_driven(&oscillator, &solution, &at).expect(equation);
        assert_eq!(proof.copies, copies, "{equation}");
        let errors = proof.formula.expect("errors");
        let drive = certificate.drive.clone().expect("a drive");
        for period in 1..drive.periods {
            let mut other = certificate.clone();
            turn(&mut other, std::f64::consts::TAU * period as f64 / drive.periods as f64, 1.0);
            let again = check_damped(&other).expect("a proof").formula.expect("errors");
            assert!(is_same(again.deviation.upper, errors.deviation.upper), "{equation}");
            assert!(is_same(again.deviation.lower, errors.deviation.lower), "{equation}");
        }
        if !certificate.odd && copies > drive.periods {
            let mut other = certificate.clone();
            turn(&mut other, std::f64::consts::PI, -1.0);
            let again = check_damped(&other).expect("a proof").formula.expect("errors");
            assert!(is_same(again.deviation.upper, errors.deviation.upper), "{equation}");
        }
    }
}

/// Gives the formula another phase and sign, in doubles; its law is left out, and what is claimed
/// of its deviation widened a little.
fn turn(certificate: &mut DampedCertificate, angle: f64, sign: f64) {
    let bits = certificate.bits;
    let formula = certificate.formula.as_mut().expect("a formula");
    let value = |units: Option<&Integer>| {
        units.map_or(0.0, |units| to_f64(&Rational::new(units.clone(), Integer::from(1) << bits)))
    };
    let length = formula.coefficients.len().max(formula.sines.len());
    let in_units = |value: f64| {
        let exact =
            from_f64(value).expect("finite") * Rational::from_integer(Integer::from(1) << bits);
        exact.floor().to_integer()
    };
    let (mut cosines, mut sines) = (vec![], vec![]);
    for k in 0..length {
        let (a, b) = (value(formula.coefficients.get(k)), value(formula.sines.get(k)));
        let (sine, cosine) = (k as f64 * angle).sin_cos();
        cosines.push(in_units(sign * (a * cosine + b * sine)));
        sines.push(in_units(sign * (b * cosine - a * sine)));
    }
    (formula.coefficients, formula.sines) = (cosines, sines);
    formula.law.clear();
    let little = ratio(1, 100);
    formula.deviation[0] = &formula.deviation[0] * (ratio(1, 1) - &little);
    formula.deviation[1] = &formula.deviation[1] * (ratio(1, 1) + &little);
    formula.amplitude_error = [Rational::zero(), ratio(1, 1)];
}

/// The displacement as text, at the amplitude and the phase of the steady motion, gives all numbers
/// of the formula.
#[test]
fn the_law_of_a_driven_motion_is_held_against_the_numbers() {
    for (equation, at) in [
        (DUFFING, "Omega = 6/5"),
        ("x'' + x'/20 + x + x^2/5 - cos(Omega*t)/5 = 0", "Omega = 1/2"),
        ("x'' + x'/50 + (1 + cos(Omega*t)/5)*x + x^3/10 = 0", "Omega = 101/50"),
    ] {
        let (certificate, proof) = proved(equation, at);
        assert!(proof.law_is_held, "{equation}: {:?}", certificate.formula);
        let mut other = certificate.clone();
        if let Some(formula) = &mut other.formula {
            formula.law = formula.law.replacen("cos", "sin", 1);
        }
        assert!(matches!(check_damped(&other), Err(CheckError::Malformed(_))), "{equation}");
    }
}

/// The proved error of the amplitude is that which the judge measures.
#[test]
fn the_error_of_the_formula_is_enclosed() {
    let oscillator = Oscillator::parse(DUFFING).expect("an oscillator");
    let solution = solve(&oscillator, &Options::default()).expect("a solution");
    let at: Values = "Omega = 6/5".parse().expect("values");
    let judged = lindstedt::judge(&oscillator, &solution, &at, 0.01).expect("a verdict");
    let (_, proof) = certify_driven(&oscillator, &solution, &at).expect("a certificate");
    let errors = proof.formula.expect("errors");
    let relative = judged.relative_error.expect("an error").abs();
    assert!(errors.relative.lower - 1e-8 < relative && relative < errors.relative.upper + 1e-8);
    assert!(errors.relative.upper - errors.relative.lower < 1e-15);
    // The judge's deviation is over the largest displacement, which is that of the motion's start
    // at its largest.
    let deviation = judged.max_deviation.expect("a deviation");
    let size = errors.deviation.upper / deviation;
    assert!((size - 2.49462).abs() < 2e-3, "{size}");
}

#[test]
fn what_cannot_be_certified_is_refused_with_the_reason() {
    let refused = |equation: &str, at: &str| certified(equation, at).expect_err("no certificate");
    assert!(matches!(refused(DUFFING, "Omega = sqrt(2)"), NotCertified::DrivingFrequency(_)));
    // The slope of a sign is zero, and still it is no term of the position.
    let friction = refused("x'' + x'/10 + sgn(x')/100 + x - cos(Omega*t)/5 = 0", "Omega = 11/10");
    assert_eq!(friction, NotCertified::NotDriven("sgn(x')/100".to_owned()));
    let cubic = refused("x'' + x'^3/20 + x + x^3/5 - cos(Omega*t)/5 = 0", "Omega = 1");
    assert_eq!(cubic, NotCertified::NotDriven("x'^3/20".to_owned()));
}

fn sound() -> DampedCertificate {
    proved(DUFFING, "Omega = 6/5").0
}

#[test]
fn each_inequality_is_checked() {
    let sound = sound();
    let reason = |change: &dyn Fn(&mut DampedCertificate)| {
        let mut certificate = sound.clone();
        certificate.claim = ratio(10, 1);
        certificate.formula = None;
        change(&mut certificate);
        check_damped(&certificate).expect_err("a certificate that does not hold")
    };
    let no_contraction =
        |error: CheckError| matches!(error, CheckError::NotProved(NotProved::NoContraction(_)));
    for column in 0..sound.inverse.len() {
        assert!(no_contraction(reason(&move |certificate| {
            certificate.inverse.iter_mut().for_each(|row| row[column] = Integer::zero());
        })));
    }
    let far = |error: CheckError| {
        matches!(error, CheckError::NotProved(NotProved::TooFar(_) | NotProved::TooLarge(_)))
    };
    for place in [1, 3] {
        assert!(far(reason(
            &|certificate| certificate.cosines[place] += Integer::from(1) << (certificate.bits - 4)
        )));
        assert!(far(reason(
            &|certificate| certificate.sines[place] += Integer::from(1) << (certificate.bits - 4)
        )));
    }
    // A force that is not odd after half a period of the drive, in x or in time.
    for spoil in ["x^2", "1/10", "c^2", "x*c"] {
        let more = parse_expression(spoil).expect("an expression");
        let even =
            |certificate: &mut DampedCertificate| certificate.force = &certificate.force + &more;
        assert_eq!(reason(&even), CheckError::NotProved(NotProved::NotOdd), "{spoil}");
    }
    for spoil in [
        (|certificate: &mut DampedCertificate| certificate.sigma = 1) as fn(&mut DampedCertificate),
        |certificate| certificate.reciprocal = Integer::from(1),
        |certificate| certificate.sines[0] = Integer::from(1),
        |certificate| certificate.force = Expr::symbol("y"),
        |certificate| certificate.damping = Expr::symbol("c"),
        |certificate| certificate.inverse.truncate(2),
        |certificate| with_drive(certificate, |drive| drive.periods = 0),
        |certificate| with_drive(certificate, |drive| drive.periods = 1_000_000_000),
        |certificate| with_drive(certificate, |drive| drive.harmonic = 0),
        |certificate| with_drive(certificate, |drive| drive.frequency = Rational::zero()),
        |certificate| with_drive(certificate, |drive| drive.frequency = ratio(-6, 5)),
    ] {
        assert!(matches!(reason(&spoil), CheckError::Malformed(_)));
    }
    let mut boastful = sound.clone();
    if let Some(formula) = &mut boastful.formula {
        formula.amplitude_error[1] = &formula.amplitude_error[1] / Integer::from(2);
    }
    assert!(matches!(
        check_damped(&boastful),
        Err(CheckError::ClaimedLess { what: "the error of the amplitude", .. })
    ));
}

fn with_drive(
    certificate: &mut DampedCertificate,
    change: impl FnOnce(&mut lindstedt::certificate::Drive),
) {
    if let Some(drive) = &mut certificate.drive {
        change(drive);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn damaged_certificates_fail_or_are_true(
        changes in proptest::collection::vec((0_u8..6, 0_usize..400, 0_usize..115, any::<bool>()), 1..3)
    ) {
        let sound = sound();
        let truth = check_damped(&sound).expect("a proof").amplitude.expect("an amplitude").middle;
        let mut damaged = sound.clone();
        damaged.formula = None;
        damaged.claim = ratio(1, 1);
        for (which, place, bit, sign) in changes {
            let by = Integer::from(if sign { 1 } else { -1 }) << bit;
            let size = damaged.inverse.len();
            let (cosine, sine) = (place % damaged.cosines.len(), place % damaged.sines.len());
            match which {
                0 => damaged.cosines[cosine] += by,
                1 => damaged.sines[sine] += by,
                2 => damaged.inverse[place % size][(place / size) % size] += by,
                3 => damaged.odd = false,
                4 => damaged.bits += 1,
                _ => damaged.inverse_bits += 1,
            }
        }
        if let Ok(proof) = check_damped(&damaged) {
            let amplitude = proof.amplitude.expect("an amplitude");
            let apart = to_f64(&(&amplitude.middle - &truth)).abs();
            prop_assert!(apart <= amplitude.radius.value() + 1e-30, "{apart} {:?}", amplitude.radius);
        }
        // Another frequency, and another force, are other questions.
        let mut faster = sound.clone();
        with_drive(&mut faster, |drive| drive.frequency = &drive.frequency + ratio(1, 1_000_000_000));
        let mut stiffer = sound;
        stiffer.force = &stiffer.force + &parse_expression("x/1000000").expect("an expression");
        for question in [faster, stiffer] {
            prop_assert!(check_damped(&question).is_err());
        }
    }
}
