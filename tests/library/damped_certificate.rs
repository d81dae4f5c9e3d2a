//! Certificates of limit cycles against frequencies of another way: the exact series of van der
//! Pol's equation, whose coefficients are fractions, to so high an order that what is left out is
//! below the radius; and the judge's Runge-Kutta.

use lindstedt::certificate::{
    CheckError, DampedCertificate, JudgedFormula, NotCertified, NotProved, certify_cycle,
    certify_cycle_motion, check_damped,
};
use lindstedt::exact::{Integer, Rational, from_f64, ratio, to_f64};
use lindstedt::expr::{Expr, parse_expression};
use lindstedt::solution::AmplitudeConvention;
use lindstedt::verify::motions;
use lindstedt::{Method, Options, Oscillator, Solution, Symbol, Values, solve};
use num_traits::{One, Signed, Zero};
use proptest::prelude::*;

const VAN_DER_POL: &str = "x'' - mu*(1 - x^2)*x' + x = 0";

fn solved(equation: &str, method: Option<Method>, order: u32) -> (Oscillator, Solution) {
    let oscillator = Oscillator::parse(equation).expect("an equation");
    let options = Options { method, order: Some(order), ..Options::default() };
    let solution = solve(&oscillator, &options).expect("a solution");
    (oscillator, solution)
}

fn certified(equation: &str, order: u32, at: &str) -> DampedCertificate {
    let (oscillator, solution) = solved(equation, None, order);
    let at: Values = at.parse().expect("values");
    let (certificate, proved) = certify_cycle(&oscillator, &solution, &at)
        .unwrap_or_else(|error| panic!("{equation} at {at:?}: {error}"));
    assert_eq!(check_damped(&certificate), Ok(proved));
    certificate
}

/// omega of van der Pol's equation, by so many orders of its series; the nearest singularity is at
/// `|mu| = 1.85`.
fn series(mu: &Rational, order: u32) -> Rational {
    let options = Options { order: Some(order), frequency_alone: true, ..Options::default() };
    let oscillator = Oscillator::parse(VAN_DER_POL).expect("an equation");
    let solution = solve(&oscillator, &options).expect("a solution");
    let law = Expr::from(solution.law.frequency().expect("a series of omega"));
    let value = law.substitute(Symbol::new("mu"), &Expr::number(mu.clone())).expect("a value");
    value.as_number().expect("a number").clone()
}

/// Whether a true frequency is in the enclosure.
fn contains(certificate: &DampedCertificate, truth: &Rational) -> Result<bool, CheckError> {
    let frequency = check_damped(certificate)?.frequency;
    let radius = from_f64(frequency.radius.value()).expect("a finite bound");
    Ok((frequency.middle - truth).abs() <= radius)
}

#[test]
fn thirty_digits_of_van_der_pol() {
    // (mu/1.85)^(order + 2) is below 1e-45.
    for (mu, order) in [("1/100", 24), ("1/10", 40), ("1/4", 56), ("1/2", 80)] {
        let certificate = certified(VAN_DER_POL, 2, &format!("mu = {mu}"));
        let truth = series(&mu.parse().expect("a fraction"), order);
        assert_eq!(contains(&certificate, &truth), Ok(true), "mu = {mu}");
        let known = check_damped(&certificate).expect("a proof").frequency.radius.value();
        assert!(known < 1e-30, "mu = {mu}: {known}");
    }
}

#[test]
fn strong_self_excitation() {
    for mu in ["3/2", "3"] {
        let certificate = certified(VAN_DER_POL, 4, &format!("mu = {mu}"));
        let proved = check_damped(&certificate).expect("a proof");
        let (oscillator, solution) = solved(VAN_DER_POL, None, 4);
        let at: Values = format!("mu = {mu}").parse().expect("values");
        let truth =
            lindstedt::judge(&oscillator, &solution, &at, 0.01).expect("a verdict").true_frequency;
        assert!((to_f64(&proved.frequency.middle) / truth - 1.0).abs() < 1e-9, "mu = {mu}");
        assert!(proved.frequency.radius.value() < 1e-15, "mu = {mu}");
    }
}

#[test]
fn the_error_of_a_formula_is_enclosed() {
    let (oscillator, solution) = solved(VAN_DER_POL, None, 2);
    let at: Values = "mu = 1/2".parse().expect("values");
    let (_, proved) = certify_cycle(&oscillator, &solution, &at).expect("a certificate");
    let errors = proved.formula.expect("a formula");
    let truth = to_f64(&series(&ratio(1, 2), 60));
    let formula = solution.motion_at(&at).expect("a motion");
    let error = (formula.frequency() - truth).abs();
    assert!(errors.frequency.lower <= error + 1e-15 && error <= errors.frequency.upper + 1e-15);
    // Both where the first harmonic is a cosine, the true one by Runge-Kutta.
    let samples =
        motions(&oscillator, &solution, &at).expect("a motion").expect("a real frequency").truth;
    let period = std::f64::consts::TAU / truth;
    let count = samples.len() - 1;
    let wave = |wave: fn(f64) -> f64| -> f64 {
        samples[..count].iter().map(|(t, x, _)| x * wave(truth * t)).sum()
    };
    let phase = wave(f64::sin).atan2(wave(f64::cos)) / truth;
    let apart = samples[..count].iter().map(|(t, x, _)| {
        let t = (t - phase).rem_euclid(period);
        ((x - formula.displacement_at(t * truth / formula.frequency())).abs(), t, *x)
    });
    let largest = apart.clone().fold(0.0, |most: f64, (apart, ..)| most.max(apart));
    assert!(
        errors.deviation.lower * 0.999 <= largest + 1e-8
            && largest <= errors.deviation.upper + 1e-8,
        "{errors:?}, {largest}"
    );
    assert!(errors.deviation.upper < 1.01 * errors.deviation.lower);
    // No moment of fifty periods is outside.
    for turn in 0..50 {
        for (_, t, x) in apart.clone().step_by(16) {
            let t = f64::from(turn) * period + t;
            let bound = errors.deviation.upper + errors.drift.upper * t;
            assert!((x - formula.displacement_at(t)).abs() <= bound + 1e-7, "t = {t}");
        }
    }
    // A formula from a turning point is turned first: the same motion.
    let options = Options {
        order: Some(2),
        amplitude: Some(AmplitudeConvention::Initial),
        ..Options::default()
    };
    let initial = solve(&oscillator, &options).expect("a solution");
    let (_, proved) = certify_cycle(&oscillator, &initial, &at).expect("a certificate");
    let turned = proved.formula.expect("a formula");
    assert_eq!(turned.frequency, errors.frequency);
    assert!(
        turned.deviation.upper < 3.0 * errors.deviation.upper
            && turned.deviation.lower > errors.deviation.lower / 3.0
    );
}

#[test]
fn proved_errors_shrink_with_the_power_that_is_left_out() {
    // omega = 1 - mu^2/16, what is left out begins with mu^4: 5^4 = 625.
    let error = |mu: &str| {
        let (oscillator, solution) = solved(VAN_DER_POL, Some(Method::MultipleScales), 2);
        let at: Values = format!("mu = {mu}").parse().expect("values");
        let (_, proved) = certify_cycle(&oscillator, &solution, &at).expect("a certificate");
        proved.formula.expect("a formula").frequency.upper
    };
    let (small, large) = (error("1/10"), error("1/2"));
    assert!((large / small - 625.2).abs() < 0.1, "{small}, {large}");
    let order = |order: u32| {
        let upper = |mu: &str| {
            let proved = check_damped(&certified(VAN_DER_POL, order, &format!("mu = {mu}")))
                .expect("a proof");
            proved.formula.expect("a formula").frequency.upper
        };
        (upper("1/10") / upper("1/20")).log2()
    };
    for (asked, left_out) in [(2, 4.0), (4, 6.0), (6, 8.0)] {
        let exponent = order(asked);
        assert!((exponent - left_out).abs() < 0.1, "order {asked}: {exponent}");
    }
}

#[test]
fn other_forces_and_dampings() {
    for (equation, at, odd) in [
        ("x'' - mu*(1 - x^2)*x' + x + x^3/5 = 0", "mu = 1/3", true),
        ("x'' - mu*(1 - x^4)*x' + x = 0", "mu = 1/2", true),
        ("x'' - mu*(1 - x^2)*x' + x + x^2/10 = 0", "mu = 1/4", false),
        ("x'' - mu*(1 - x - x^2)*x' + x = 0", "mu = 1/4", false),
    ] {
        let (oscillator, solution) = solved(equation, None, 2);
        let at: Values = at.parse().expect("values");
        let (certificate, proved) = certify_cycle(&oscillator, &solution, &at)
            .unwrap_or_else(|error| panic!("{equation}: {error}"));
        assert_eq!(certificate.odd, odd, "{equation}");
        let truth =
            lindstedt::judge(&oscillator, &solution, &at, 0.01).expect("a verdict").true_frequency;
        assert!((to_f64(&proved.frequency.middle) / truth - 1.0).abs() < 1e-9, "{equation}");
        assert!(proved.frequency.radius.value() < 1e-26, "{equation}: {proved:?}");
        assert_eq!(check_damped(&certificate), Ok(proved), "{equation}");
    }
}

#[test]
fn the_characteristic_exponent_is_that_of_the_mean_damping() {
    // The cycle attracts for mu > 0; backwards in time it repels as fast.
    let exponent = |mu: &str| {
        let certificate = certified(VAN_DER_POL, 2, &format!("mu = {mu}"));
        check_damped(&certificate).expect("a proof").exponent.expect("an exponent")
    };
    let (attracts, repels) = (exponent("1/4"), exponent("-1/4"));
    let apart = (&attracts.middle + &repels.middle).abs();
    assert!(attracts.middle.is_negative() && apart < ratio(1, 1_000_000_000).pow(3));
    // -[g]_0 = mu (1 - (a_1^2 + ...)/2), of which the first term is -mu.
    assert!((to_f64(&attracts.middle) + 0.25).abs() < 0.002, "{attracts:?}");
}

#[test]
fn what_cannot_be_certified_is_refused_with_the_reason() {
    let refused = |equation: &str, at: &str| {
        let (oscillator, solution) = solved(equation, None, 4);
        certify_cycle(&oscillator, &solution, &at.parse().expect("values"))
            .expect_err("no certificate")
    };
    let NotCertified::NotLienard { term, of_velocity } =
        refused("x'' - mu*(1 - x'^2/3)*x' + x = 0", "mu = 1/10")
    else {
        panic!("another reason");
    };
    assert_eq!(term, "mu*x'^3/3");
    let friction = refused("x'' - (1 - x^2)*x'/3 + sgn(x')/50 + x = 0", "");
    assert!(matches!(friction, NotCertified::NotLienard { term, .. } if term == "sgn(x')/50"));
    // The velocity of Rayleigh's oscillator is a motion of van der Pol's.
    let of_velocity = of_velocity.expect("an equation");
    let omega = |equation: &str| {
        check_damped(&certified(equation, 2, "mu = 1/10")).expect("a proof").frequency.middle
    };
    assert!((omega(&of_velocity) - omega(VAN_DER_POL)).abs() < ratio(1, 1_000_000_000).pow(3));
    // Relaxation: more harmonics than a proof holds.
    let relaxing = refused(VAN_DER_POL, "mu = 20");
    assert!(
        matches!(
            relaxing,
            NotCertified::TooManyHarmonics(_)
                | NotCertified::NotProved { .. }
                | NotCertified::Motion(_)
        ),
        "{relaxing:?}"
    );
}

/// A change of one number of a certificate, by a power of two of its last digits.
fn change(certificate: &mut DampedCertificate, which: u8, place: usize, bit: usize, sign: bool) {
    let by = Integer::from(if sign { 1 } else { -1 }) << bit;
    let size = certificate.inverse.len();
    match which {
        0 => certificate.reciprocal += by,
        1 => {
            let place = place % certificate.cosines.len();
            certificate.cosines[place] += by;
        }
        2 => {
            let place = place % certificate.sines.len();
            certificate.sines[place] += by;
        }
        3 => certificate.inverse[place % size][(place / size) % size] += by,
        4 => certificate.sigma += (bit % 5) as i32 - 2,
        5 => certificate.highest = 1 + bit,
        6 => certificate.odd = false,
        7 => certificate.bits += 1,
        8 => certificate.sines.truncate(2 + place % certificate.sines.len()),
        9 => certificate.inverse.iter_mut().flatten().for_each(|entry| *entry = Integer::zero()),
        _ => certificate.inverse_bits += 1,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn damaged_certificates_fail_or_are_true(
        mu in 5_i64..60, changes in proptest::collection::vec((0_u8..11, 0_usize..400, 0_usize..115, any::<bool>()), 1..3)
    ) {
        let mu = ratio(mu, 100);
        let mut certificate = certified(VAN_DER_POL, 2, &format!("mu = {mu}"));
        let truth = series(&mu, 100);
        prop_assert_eq!(contains(&certificate, &truth), Ok(true));
        let claim = std::mem::replace(&mut certificate.claim, ratio(1, 1));
        certificate.formula = None;
        let sound = certificate.clone();
        for (which, place, bit, sign) in changes {
            change(&mut certificate, which, place, bit, sign);
        }
        prop_assert!(contains(&certificate, &truth) != Ok(false), "{:?}", certificate);
        // Another damping, and another force, are other questions.
        let mut other = sound.clone();
        let more = ratio(1, 1_000_000_000);
        let scaled = &(&mu + &more) / &mu;
        other.damping = &other.damping * &Expr::number(scaled);
        prop_assert!(contains(&other, &series(&(&mu + &more), 100)) != Ok(false));
        let mut stiffer = sound;
        stiffer.force = &stiffer.force + &parse_expression("x/1000000").expect("an expression");
        for mut question in [other, stiffer] {
            question.claim = claim.clone();
            prop_assert!(check_damped(&question).is_err());
        }
    }
}

#[test]
fn each_inequality_is_checked() {
    let sound = certified(VAN_DER_POL, 2, "mu = 1/2");
    let reason = |change: &dyn Fn(&mut DampedCertificate)| {
        let mut certificate = sound.clone();
        certificate.claim = ratio(10, 1);
        certificate.formula = None;
        change(&mut certificate);
        check_damped(&certificate).expect_err("a certificate that does not hold")
    };
    let no_contraction =
        |error: CheckError| matches!(error, CheckError::NotProved(NotProved::NoContraction(_)));
    // Z1: an inverse that is none, in one column or in all.
    for column in 0..sound.inverse.len() {
        let without = move |certificate: &mut DampedCertificate| {
            certificate.inverse.iter_mut().for_each(|row| row[column] = Integer::zero());
        };
        assert!(no_contraction(reason(&without)), "column {column}");
    }
    // Z1, the column of 1/omega alone: its error counts for all, or for nothing.
    assert!(no_contraction(reason(&|certificate| certificate.sigma = -64)));
    // Z1 beyond the block: one harmonic in it.
    assert!(no_contraction(reason(&|certificate| {
        certificate.highest = 1;
        certificate.inverse.truncate(2);
        certificate.inverse.iter_mut().for_each(|row| row.truncate(2));
    })));
    // Y0 and Z2: too far for the curvature of the problem.
    let far = |error: CheckError| {
        matches!(error, CheckError::NotProved(NotProved::TooFar(_) | NotProved::TooLarge(_)))
    };
    for place in [1, 3] {
        assert!(far(reason(
            &|certificate| certificate.cosines[place] += Integer::from(1) << (certificate.bits - 5)
        )));
        assert!(far(reason(
            &|certificate| certificate.sines[3] += Integer::from(1) << (certificate.bits - 5)
        )));
    }
    assert!(far(reason(
        &|certificate| certificate.reciprocal += Integer::from(1) << (certificate.bits - 5)
    )));
    // A harmonic far beyond the block is a part of the defect too.
    let shaken = |certificate: &mut DampedCertificate| {
        certificate.cosines[41] += Integer::from(1) << (certificate.bits - 20)
    };
    let mut certificate = sound.clone();
    shaken(&mut certificate);
    assert!(matches!(
        check_damped(&certificate),
        Err(CheckError::ClaimedLess { what: "the radius", .. } | CheckError::NotProved(_))
    ));
    // At rest: every inequality may hold but that of the first harmonic.
    assert!(matches!(
        reason(&|certificate| {
            certificate.cosines = vec![];
            certificate.sines = vec![];
        }),
        CheckError::Malformed(_)
    ));
    assert!(matches!(
        reason(&|certificate| {
            certificate.cosines = vec![Integer::zero(), Integer::one()];
            certificate.sines = vec![];
        }),
        CheckError::NotProved(_)
    ));
    assert!(matches!(
        reason(&|certificate| certificate.reciprocal = Integer::zero()),
        CheckError::NotProved(_)
    ));
    // What is claimed.
    assert!(matches!(
        reason(&|certificate| certificate.claim = ratio(1, i64::MAX) * ratio(1, i64::MAX)),
        CheckError::ClaimedLess { what: "the radius", .. }
    ));
    let mut boastful = sound.clone();
    if let Some(formula) = &mut boastful.formula {
        formula.deviation[1] = &formula.deviation[1] / Integer::from(2);
    }
    assert!(matches!(
        check_damped(&boastful),
        Err(CheckError::ClaimedLess { what: "the deviation", .. })
    ));
    // The symmetry.
    for spoil in ["x^2", "1/10"] {
        let more = parse_expression(spoil).expect("an expression");
        let even =
            |certificate: &mut DampedCertificate| certificate.force = &certificate.force + &more;
        assert_eq!(reason(&even), CheckError::NotProved(NotProved::NotOdd));
    }
    let skew = |certificate: &mut DampedCertificate| {
        certificate.damping = &certificate.damping + &Expr::symbol("x")
    };
    assert_eq!(reason(&skew), CheckError::NotProved(NotProved::NotOdd));
    // Sizes, and the phase.
    for spoil in [
        (|certificate: &mut DampedCertificate| certificate.inverse.truncate(2))
            as fn(&mut DampedCertificate),
        |certificate| certificate.highest = 100_000,
        |certificate| certificate.bits = 1_000_000,
        |certificate| certificate.sigma = i32::MIN,
        |certificate| certificate.reciprocal = Integer::from(1) << 100_000,
        |certificate| certificate.damping = Expr::symbol("y"),
        |certificate| certificate.force = Expr::symbol("y"),
        |certificate| certificate.cosines = vec![Integer::zero(); 10_000],
        |certificate| certificate.sines[1] = Integer::from(1),
    ] {
        assert!(matches!(reason(&spoil), CheckError::Malformed(_)));
    }
}

/// Half a period later it is the same cycle: held against a formula at the opposite phase, it would
/// seem to be off by twice the amplitude.
#[test]
fn a_cycle_begins_at_the_positive_cosine_of_its_first_harmonic() {
    let sound = certified(VAN_DER_POL, 2, "mu = 1/2");
    let mut turned = sound.clone();
    for list in [&mut turned.cosines, &mut turned.sines] {
        list.iter_mut().for_each(|units| *units = -&*units);
    }
    // With X and F of the other sign the inverse has one in the row of 1/omega.
    turned.inverse[0].iter_mut().for_each(|entry| *entry = -&*entry);
    let reason = |certificate: &DampedCertificate| {
        check_damped(certificate).expect_err("no certificate").to_string()
    };
    assert!(reason(&turned).contains("no positive cosine"), "{}", reason(&turned));
    turned.formula = None;
    assert!(reason(&turned).contains("no positive cosine"), "{}", reason(&turned));
    // The same formula with a negative frequency, or as one of half the frequency.
    let with = |change: fn(&mut JudgedFormula)| {
        let mut other = sound.clone();
        change(other.formula.as_mut().expect("a formula"));
        reason(&other)
    };
    let negative = with(|formula| {
        formula.frequency = -&formula.frequency;
        formula.sines.iter_mut().for_each(|sine| *sine = -&*sine);
    });
    assert!(negative.contains("not positive"), "{negative}");
    let slow = with(|formula| {
        formula.frequency = formula.frequency.clone() >> 1;
        for list in [&mut formula.coefficients, &mut formula.sines] {
            *list = list.iter().flat_map(|units| [units.clone(), Integer::zero()]).collect();
        }
    });
    assert!(slow.contains("without a first harmonic"), "{slow}");
    // A formula that begins elsewhere is turned, and off by as much.
    let mut later = sound.clone();
    let formula = later.formula.as_mut().expect("a formula");
    for list in [&mut formula.coefficients, &mut formula.sines] {
        list.iter_mut().skip(1).step_by(2).for_each(|units| *units = -&*units);
    }
    assert_eq!(
        check_damped(&later).expect("a proof").formula,
        check_damped(&sound).expect("a proof").formula
    );
}

/// omega^2 = 1 - mu^2/8 has no root at mu = 3: the cycle is proved without it.
#[test]
fn a_cycle_is_proved_where_its_formula_has_no_value() {
    let (oscillator, solution) = solved(VAN_DER_POL, None, 2);
    let at: Values = "mu = 3".parse().expect("values");
    let refused = certify_cycle(&oscillator, &solution, &at).expect_err("no formula");
    assert!(refused.help().is_some_and(|help| help.contains("--no-formula")), "{refused}");
    let (certificate, proved) = certify_cycle_motion(&oscillator, &solution, &at).expect("a proof");
    assert_eq!(check_damped(&certificate).as_ref(), Ok(&proved));
    assert!(proved.formula.is_none() && certificate.formula.is_none());
    // The period of van der Pol's equation at mu = 3, from the tables of the literature: 8.8591.
    let period = std::f64::consts::TAU / to_f64(&proved.frequency.middle);
    assert!((period - 8.8591).abs() < 1e-4, "{period}");
}

/// The law as text gives the numbers to their last digits, or is refused; words are nothing that is
/// proved.
#[test]
fn the_law_is_held_against_the_numbers() {
    let sound = certified(VAN_DER_POL, 4, "mu = 1/2");
    assert!(check_damped(&sound).expect("a proof").law_is_held);
    let with_law = |law: &str, values: &str| {
        let mut other = sound.clone();
        let formula = other.formula.as_mut().expect("a formula");
        (formula.law, formula.values) = (law.to_owned(), values.parse().expect("values"));
        check_damped(&other)
    };
    for (law, values) in [
        ("omega = 1", ""),
        ("omega^2 = 1 - mu^2/8 + 23*mu^4/1536", "mu = 1/3"),
        ("omega^2 = 1 - mu^2/8 + 23*mu^4/1537", "mu = 1/2"),
        ("omega = 1 - mu^2/8 + 23*mu^4/1536", "mu = 1/2"),
    ] {
        assert!(matches!(with_law(law, values), Err(CheckError::Malformed(_))), "{law}");
    }
    for (law, values, is_held) in [
        ("omega^2 = 1 - k/2 + 23*mu^4/1536, k = mu^2/4", "mu = 1/2", true),
        ("omega^2 = 1 - mu^2/8 + 23*mu^4/1536", "", false),
        ("a perfect formula", "", false),
        ("0 = omega^2 - 1", "", false),
        ("", "", false),
    ] {
        let proved = with_law(law, values).unwrap_or_else(|error| panic!("{law}: {error}"));
        assert_eq!(proved.law_is_held, is_held, "{law}");
    }
}
