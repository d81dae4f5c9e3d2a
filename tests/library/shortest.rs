//! The shortest laws, measured again by elliptic integrals, and their proofs.
//!
//! omega of the pendulum is the arithmetic-geometric mean of 1 and cos(A/2), that of `x'' + x + s x^3 = 0`
//! released from 1 `sqrt(1 + s)` times that of 1 and `sqrt(1 - m)`, `m = s/(2 (1 + s))` (DLMF 19.8.5, 22.19).
//! Contacts are measured by the closed form of Hunt and Crossley in the phase plane.

use std::collections::BTreeMap;

use lindstedt::certificate::{LawCertificate, LawQuantity, MotionsOfLaw, check_law, restitution};
use lindstedt::exact::rational::to_f64;
use lindstedt::exact::{Integer, Rational};
use lindstedt::expr::Expr;
use lindstedt::impact::contact::{HuntCrossley, PowerLaw};
use lindstedt::modes::{FreeSystem, ModeOptions, derive};
use lindstedt::numeric::period::{PiecewiseForce, conservative_period};
use lindstedt::shortest::{Front, LawProblem, SearchOptions, length, search};
use lindstedt::solution::AmplitudeConvention;
use lindstedt::{Oscillator, Supervision, Symbol};
use lindstedt_expr::parallel::on_threads;

/// The arithmetic-geometric mean.
fn mean(mut a: f64, mut b: f64) -> f64 {
    while (a - b).abs() > 1e-15 * a {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    a
}

fn front(
    equation: &str,
    varying: &str,
    to: Option<&str>,
    quantity: LawQuantity,
    longest: usize,
) -> Front {
    let oscillator = Oscillator::parse(equation).expect(equation);
    let to: Option<Rational> = to.map(|to| to.parse().expect("a fraction"));
    let zero: Rational = "0".parse().expect("a fraction");
    let varying = varying.parse().expect("an expression");
    let at = "".parse().expect("no values");
    let problem =
        LawProblem::new(&oscillator, &varying, (&zero, to.as_ref()), &at).expect(equation);
    search(problem, &SearchOptions::new(quantity, longest), Supervision::default()).expect(equation)
}

/// Holds every proved bound against many values of the quantity.
fn remeasured(front: &Front, places: &[f64], truth: impl Fn(f64) -> f64) {
    let places: Vec<[f64; 3]> = places.iter().map(|&place| [place, 1.0, truth(place)]).collect();
    remeasured_at(front, &places);
}

/// Holds every proved bound against places, restitutions and true values there.
fn remeasured_at(front: &Front, places: &[[f64; 3]]) {
    let variable: Symbol = front.problem.variable;
    for law in &front.laws {
        let (certificate, error) =
            law.proof.as_ref().unwrap_or_else(|reason| panic!("{}: {reason}", law.formula));
        let measured = places.iter().map(|&[place, e, truth]| {
            let values = BTreeMap::from([(variable, place), (restitution(), e)]);
            let value = certificate.law.evaluate(&values);
            (value.expect("a value") / truth - 1.0).abs()
        });
        let largest = measured.fold(0.0, f64::max);
        let claims = certificate.claim.each_ref().map(to_f64);
        assert!(largest <= claims[1], "{}: {largest} beyond {claims:?}", law.formula);
        assert!(
            claims[0] <= error.lower && largest >= 0.99 * claims[0],
            "{}: {largest}",
            law.formula
        );
        assert_eq!(law.length, length(&law.formula.to_string()));
    }
    for pair in front.laws.windows(2) {
        assert!(pair[0].length < pair[1].length && pair[0].error > pair[1].error);
    }
}

#[test]
fn laws_of_the_pendulum_to_specification() {
    let found = front("x'' + sin(x) = 0", "A", Some("14/5"), LawQuantity::Frequency, 18);
    let places: Vec<f64> = (0..=10_000).map(|i| 2.8 * f64::from(i) / 1e4).collect();
    remeasured(&found, &places, |amplitude| mean(1.0, (amplitude / 2.0).cos()));
    let within = |error: f64| found.shortest_within(error).expect("a law").length;
    assert!(within(0.0011) <= 15, "{}", within(0.0011));
    assert!(within(0.0003) <= 21, "{}", within(0.0003));
    // A proof is checked from its claims alone, and a smaller claim is refused.
    let law = found.shortest_within(0.0011).expect("a law");
    let (certificate, error) = law.proof.as_ref().expect("a proof");
    assert_eq!(check_law(certificate).as_ref(), Ok(error));
    let mut false_one = certificate.clone();
    false_one.claim[1] = "1/1000".parse().expect("a fraction");
    assert!(check_law(&false_one).is_err());
}

#[test]
fn laws_that_are_exact_at_rest() {
    let pendulum = Oscillator::parse("x'' + sin(x) = 0").expect("an equation");
    let ends = ["0", "14/5"].map(|end| end.parse::<Rational>().expect("a fraction"));
    let varying = "A".parse().expect("an expression");
    let at = "".parse().expect("no values");
    let problem = LawProblem::new(&pendulum, &varying, (&ends[0], Some(&ends[1])), &at);
    let options =
        SearchOptions { exact_at_rest: Some(2), ..SearchOptions::new(LawQuantity::Frequency, 16) };
    let found =
        search(problem.expect("a problem"), &options, Supervision::default()).expect("laws");
    let last = found.laws.last().expect("a law");
    assert!(last.error < 0.01 && last.proof.is_ok(), "{}", last.formula);
    // omega = 1 - A^2/16 + O(A^4): the error of each law falls with the fourth power of the amplitude.
    for law in &found.laws {
        let (certificate, _) = law.proof.as_ref().expect("a proof");
        let error = |amplitude: f64| {
            let value = certificate.law.evaluate(&BTreeMap::from([(Symbol::new("A"), amplitude)]));
            (value.expect("a value") / mean(1.0, (amplitude / 2.0).cos()) - 1.0).abs()
        };
        assert!(error(0.02) < 1e-7 && error(0.04) < 17.0 * error(0.02) + 1e-13, "{}", law.formula);
    }
}

#[test]
fn the_best_short_law_is_found() {
    // Of all formulas of eight symbols the published one is the best.
    let found = front("x'' + sin(x) = 0", "A", Some("14/5"), LawQuantity::Period, 8);
    let last = found.laws.last().expect("a law");
    let known = (4.0 / (1.0 + 1.4_f64.cos().sqrt()).powi(2) * mean(1.0, 1.4_f64.cos()) - 1.0).abs();
    assert_eq!(last.length, 8);
    assert!((last.error / known - 1.0).abs() < 1e-9, "{}", last.formula);
}

#[test]
fn laws_of_a_hardening_spring_to_infinity() {
    let found = front("x'' + x + eps*x^3 = 0", "eps*A^2", None, LawQuantity::Frequency, 18);
    let places: Vec<f64> =
        (0..=10_000).map(|i| 10.0_f64.powf(f64::from(i) / 500.0 - 8.0)).collect();
    let truth = |s: f64| (1.0 + s).sqrt() * mean(1.0, (1.0 - s / (2.0 * (1.0 + s))).sqrt());
    remeasured(&found, &places, truth);
    let homotopy = "sqrt((1 + 3*s/4)/2 + sqrt((1 + 3*s/4)^2 - 3*s^2/32)/2)";
    let within = found.shortest_within(6e-5).expect("a law").length;
    assert!(within <= length(homotopy), "{within}");
}

/// The contacts of an exponent for products of damping and speed: that product, the restitution, and the
/// duration over that without damping.
fn contacts(exponent: f64, products: impl Iterator<Item = f64>) -> Vec<[f64; 3]> {
    let elastic = PowerLaw::new(exponent, 1.0, 1.0).expect("a contact").duration;
    let contact = |s: f64| {
        let contact = HuntCrossley::new(exponent, 1.0, s, 1.0).expect("a contact");
        [s, contact.restitution, contact.duration / elastic]
    };
    products.map(contact).collect()
}

fn contact_front(force: &str, varying: &str, ends: [&str; 2], longest: usize) -> Front {
    let equation = Oscillator::parse(&format!("x'' + {force} = 0")).expect(force);
    let [from, to] = ends.map(|end| end.parse::<Rational>().expect("a fraction"));
    let varying = varying.parse().expect("an expression");
    let at = "".parse().expect("no values");
    let problem = LawProblem::of_contact(&equation, &varying, (&from, Some(&to)), &at);
    let options = SearchOptions::new(LawQuantity::ContactTime, longest);
    search(problem.expect(force), &options, Supervision::default()).expect(force)
}

#[test]
fn laws_of_the_time_of_a_contact() {
    let hertz = "k*x^(3/2)*(1 + lambda*x')";
    let found = contact_front(hertz, "e", ["1/5", "1"], 8);
    let places = contacts(1.5, (0..=2000).map(|i| 4.919 * f64::from(i) / 2000.0));
    remeasured_at(&found, &places);
    // The worst place of each is in the range, to the last digit of its ends.
    for law in &found.laws {
        let (certificate, _) = law.proof.as_ref().expect("a proof");
        assert!(certificate.to.as_ref().is_some_and(|to| certificate.worst <= *to));
    }
    // T/T_0 = 0.88 + 0.12/e or better, and the range of s reaches the restitution that is asked for.
    assert!(found.laws.last().is_some_and(|law| law.largest_error() < 0.005));
    let end = to_f64(found.problem.to.as_ref().expect("an end"));
    let [_, e, _] = contacts(1.5, std::iter::once(end))[0];
    assert!((0.199_99..=0.2).contains(&e), "{e}");
    // Of a spring and of a cone, over the product and over the speed alone.
    for (force, exponent) in [("x*(1 + lambda*x')", 1.0), ("4*max(x, 0)^2*(1 + lambda*x')", 2.0)] {
        let found = contact_front(force, "lambda*v", ["0", "2"], 6);
        let places = contacts(exponent, (0..=1000).map(|i| f64::from(i) / 500.0));
        remeasured_at(&found, &places);
    }
    let found = contact_front("x^(3/2)*(1 + x'/4)", "v", ["1", "2"], 5);
    let places = contacts(1.5, (0..=1000).map(|i| 0.25 + 0.25 * f64::from(i) / 1000.0));
    let places: Vec<[f64; 3]> = places.into_iter().map(|[s, e, time]| [4.0 * s, e, time]).collect();
    remeasured_at(&found, &places);
    // Other claims are refused: half the error, and the same law for another exponent.
    let (certificate, _) = found.laws.last().expect("a law").proof.as_ref().expect("a proof");
    let mut smaller = certificate.clone();
    smaller.claim[1] = &smaller.claim[1] / Integer::from(2);
    let mut cone = certificate.clone();
    *force_of(&mut cone).0 = "x^4*(1 + x'/4)".parse().expect("a force");
    let mut spring = certificate.clone();
    *force_of(&mut spring).0 = "x^(3/2)".parse().expect("a force");
    for (other, words) in
        [(smaller, "within its bound"), (cone, "within its bound"), (spring, "x^n*(1 + c*x')")]
    {
        let refusal = check_law(&other).expect_err(words).to_string();
        assert!(refusal.contains(words), "{refusal}");
    }
}

/// The force and the mass of a certificate of one coordinate.
fn force_of(certificate: &mut LawCertificate) -> (&mut Expr, &mut Option<Expr>) {
    match &mut certificate.motions {
        MotionsOfLaw::Coordinate { force, mass, .. } => (force, mass),
        MotionsOfLaw::Mode(_) => panic!("a mode"),
    }
}

#[test]
fn laws_of_the_backbone_of_a_mode() {
    // Both masses move alike, as one on the ground.
    let pair =
        FreeSystem::parse("x'' + 2*x - y + x^3 = 0; y'' + 2*y - x + y^3 = 0").expect("a pair");
    let options = ModeOptions {
        mode: Some(1),
        amplitude: AmplitudeConvention::Initial,
        ..ModeOptions::default()
    };
    let modes = derive(&pair, &options).expect("modes");
    let [from, to] = ["0", "2"].map(|end| end.parse::<Rational>().expect("a fraction"));
    let varying = "A".parse().expect("an expression");
    let problem = LawProblem::of_mode(&modes, 1, &varying, (&from, Some(&to))).expect("a problem");
    let options = SearchOptions::new(LawQuantity::Frequency, 8);
    let found = search(problem, &options, Supervision::default()).expect("laws");
    let truth = |s: f64| (1.0 + s).sqrt() * mean(1.0, (1.0 - s / (2.0 * (1.0 + s))).sqrt());
    for law in &found.laws {
        let law_at = law.formula.expression().expect("an expression");
        let error = |i: u32| {
            let amplitude = f64::from(i) / 1000.0;
            let value = law_at.evaluate(&BTreeMap::from([(Symbol::new("A"), amplitude)]));
            (value.expect("a value") / truth(amplitude * amplitude) - 1.0).abs()
        };
        let largest = (1..=2000).map(error).fold(0.0, f64::max);
        assert!((largest - law.error).abs() < 1e-5, "{}: {largest}, {}", law.formula, law.error);
        let (certificate, proved) = law.proof.as_ref().expect("a proof");
        assert!(largest <= proved.upper && proved.lower > 0.99 * largest, "{}", law.formula);
        assert_eq!(check_law(certificate).as_ref(), Ok(proved), "{}", law.formula);
    }
    assert!(found.laws.last().is_some_and(|law| law.error < 0.02));
}

#[test]
fn laws_of_a_growth_that_is_asked_for() {
    let oscillator = Oscillator::parse("x'' + x + x^3 = 0").expect("an equation");
    let [from, to] = ["0", "3"].map(|end| end.parse::<Rational>().expect("a fraction"));
    let (varying, at) = ("A".parse().expect("a name"), "".parse().expect("no values"));
    let problem = LawProblem::new(&oscillator, &varying, (&from, Some(&to)), &at);
    let options = SearchOptions {
        growth: Some(Rational::from_integer(1.into())),
        ..SearchOptions::new(LawQuantity::Frequency, 9)
    };
    let found =
        search(problem.expect("a problem"), &options, Supervision::default()).expect("laws");
    for law in &found.laws {
        let law = law.formula.expression().expect("an expression");
        let at = |amplitude: f64| law.evaluate(&BTreeMap::from([(Symbol::new("A"), amplitude)]));
        let [near, far] = [1e8, 1e9].map(|amplitude| at(amplitude).expect("a value"));
        assert!((far / near - 10.0).abs() < 1e-3, "{law}");
    }
    assert!(found.laws.last().is_some_and(|law| law.error < 0.02 && law.proof.is_ok()));
}

#[test]
fn a_law_of_another_growth_has_no_bound() {
    let found = front("x'' + x + eps*x^3 = 0", "eps*A^2", None, LawQuantity::Frequency, 7);
    let (certificate, _) = found.laws.last().expect("a law").proof.as_ref().expect("a proof");
    for (law, words) in [("1 + s", "different powers"), ("sqrt(1 + s)/(s - 2)", "not certified")] {
        let mut other = certificate.clone();
        other.law = law.parse().expect("an expression");
        other.claim[1] = "10".parse().expect("a number");
        let refusal = check_law(&other).expect_err(law).to_string();
        assert!(refusal.contains(words), "{refusal}");
    }
    let mut other = certificate.clone();
    *force_of(&mut other).0 = "x + s*x^3 + 1/2".parse().expect("an expression");
    assert!(
        check_law(&other).expect_err("no equilibrium").to_string().contains("is not zero at x = 0")
    );
}

#[test]
fn limit_cycles_have_laws_without_a_proof() {
    let found = front("x'' - mu*(1 - x^2)*x' + x = 0", "mu", Some("2"), LawQuantity::Period, 8);
    let last = found.laws.last().expect("a law");
    assert!(last.error < 0.01 && last.proof.is_err(), "{}", last.formula);
}

#[test]
fn one_thread_finds_what_two_find() {
    let texts = |threads: usize| {
        let found = on_threads(threads, || {
            front("x'' + x + eps*x^3 = 0", "eps*A^2", None, LawQuantity::FrequencySquared, 12)
        });
        found.laws.iter().map(|law| law.formula.to_string()).collect::<Vec<String>>()
    };
    assert_eq!(texts(1), texts(2));
}

#[test]
fn motions_of_another_kind_are_measured_and_not_proved() {
    // About an equilibrium that is no fraction, and with a mass that depends on the speed.
    for (equation, words) in [
        ("x'' + x + x^3 - 1/4 = 0", "an equilibrium that is a number"),
        ("x'' + (1 - x'^2)^(3/2)*x = 0", "of the position and the variable alone"),
    ] {
        let found = front(equation, "A", Some("1/4"), LawQuantity::Frequency, 5);
        let last = found.laws.last().expect("a law");
        let reason = last.proof.as_ref().expect_err(equation).to_string();
        assert!(reason.contains(words), "{reason}");
    }
}

#[test]
fn laws_of_a_mass_that_depends_on_the_position() {
    // omega = 1/sqrt(1 + A^2) (Mathews and Lakshmanan), which the search finds.
    let equation = "(1 + x^2)*x'' - x*x'^2 + x = 0";
    let found = front(equation, "A", Some("9/10"), LawQuantity::Frequency, 8);
    let places: Vec<f64> = (0..=2000).map(|i| 0.9 * f64::from(i) / 2000.0).collect();
    for law in &found.laws {
        let (certificate, _) = law.proof.as_ref().expect("a proof");
        let error = |amplitude: &f64| {
            let values = BTreeMap::from([(Symbol::new("A"), *amplitude)]);
            let value = certificate.law.evaluate(&values).expect("a value");
            (value * (1.0 + amplitude * amplitude).sqrt() - 1.0).abs()
        };
        let largest = places.iter().map(error).fold(0.0, f64::max);
        assert!(largest <= to_f64(&certificate.claim[1]), "{}", law.formula);
    }
    let last = found.laws.last().expect("a law");
    assert!(last.formula.to_string() == "1/sqrt(1 + A^2)" && last.largest_error() < 2e-9);
    let (certificate, _) = last.proof.as_ref().expect("a proof");
    let mut lighter = certificate.clone();
    *force_of(&mut lighter).1 = None;
    assert!(check_law(&lighter).is_err());
}

#[test]
fn laws_about_an_equilibrium_that_is_not_zero() {
    let mut well = Oscillator::parse("x'' - x + x^3 = 0").expect("an equation");
    well.about = Some("1".parse().expect("a place"));
    let [from, to] = ["0", "3/10"].map(|end| end.parse::<Rational>().expect("a fraction"));
    let (varying, at) = ("A".parse().expect("a name"), "".parse().expect("no values"));
    let problem = LawProblem::new(&well, &varying, (&from, Some(&to)), &at).expect("a problem");
    let options = SearchOptions::new(LawQuantity::Frequency, 8);
    let found = search(problem, &options, Supervision::default()).expect("laws");
    let force = |x: f64| x * x * x - x;
    let places: Vec<f64> = (1..=300).map(|i| f64::from(i) / 1000.0).collect();
    remeasured(&found, &places, |amplitude| {
        let period = conservative_period(&PiecewiseForce::smooth(&force), 1.0, 1.0 + amplitude);
        std::f64::consts::TAU / period.expect("a period")
    });
}

#[test]
fn laws_of_a_spring_that_is_not_even() {
    let found = front("x'' + x + x^2/4 = 0", "A", Some("1"), LawQuantity::Frequency, 7);
    let force = |x: f64| x + 0.25 * x * x;
    let places: Vec<f64> = (1..=400).map(|i| f64::from(i) / 400.0).collect();
    remeasured(&found, &places, |amplitude| {
        let period = conservative_period(&PiecewiseForce::smooth(&force), 0.0, amplitude);
        std::f64::consts::TAU / period.expect("a period")
    });
}
