//! Where a formula holds, beside what is known in closed form: zeros and poles of laws, wells and
//! what lies beyond them, radii of convergence, the first amplitude at which a formula fails, and
//! the size of what is left over.

use std::f64::consts::TAU;

use lindstedt::Values;
use lindstedt::expr::parse_expression;
use lindstedt::method::numbers::frequency_squared_of;
use lindstedt::method::{Options, solve};
use lindstedt::numeric::period::{PiecewiseForce, conservative_period};
use lindstedt::solution::{Degrees, Method, Note};
use lindstedt::verify::{Range, Verification, judge};
use lindstedt::{Oscillator, Symbol};

fn judged_by(oscillator: &Oscillator, options: &Options, at: &[(&str, &str)]) -> Verification {
    let mut values = Values::default();
    for (name, value) in at {
        values.insert(Symbol::new(name), value.parse().unwrap()).unwrap();
    }
    let solution = solve(oscillator, options).unwrap();
    judge(oscillator, &solution, &values, 0.01).unwrap()
}

fn judged(equation: &str, method: Method, order: Option<u32>, amplitude: &str) -> Verification {
    let options = Options { method: Some(method), order, ..Options::default() };
    judged_by(&Oscillator::parse(equation).unwrap(), &options, &[("A", amplitude)])
}

/// A sine waves more and more often along a large motion; the balance of two harmonics is followed
/// through all of it.
#[test]
fn a_balance_is_followed_through_the_waves_of_its_force() {
    let oscillator = Oscillator::parse("x'' + x + sin(x) = 0").unwrap();
    let options =
        Options { method: Some(Method::HarmonicBalance), order: Some(2), ..Options::default() };
    let solution = solve(&oscillator, &options).unwrap();
    for amplitude in [20.0, 100.0, 131.0, 179.0, 250.0, 400.0] {
        let square =
            frequency_squared_of(&oscillator, &solution, &[("A".into(), amplitude)].into())
                .unwrap();
        let force = |x: f64| x + x.sin();
        let waves = |from: f64, to: f64| {
            (-400..400).map(f64::from).filter(|place| from < *place && *place < to).collect()
        };
        let truth = TAU
            / conservative_period(&PiecewiseForce::with_cuts(&force, &waves), 0.0, amplitude)
                .unwrap();
        // What the harmonics left out change: less than the second power of the wave over the
        // amplitude.
        assert!(
            (square.sqrt() / truth - 1.0).abs() < 0.1 / amplitude.powi(2),
            "{amplitude}: {square} {truth}"
        );
    }
}

/// The range whose text has these words.
fn range<'a>(verification: &'a Verification, words: &str) -> Option<&'a Range> {
    verification.ranges.iter().find(|range| range.text.contains(words))
}

/// The number behind the words in the text of a range.
fn number_behind(verification: &Verification, words: &str) -> f64 {
    let found = range(verification, words)
        .unwrap_or_else(|| panic!("no `{words}` in {:?}", verification.ranges));
    let (_, rest) = found.text.split_once(words).expect("the words");
    let number: String = rest.chars().take_while(|letter| !": ;<".contains(*letter)).collect();
    number.parse().unwrap_or_else(|_| panic!("{}", found.text))
}

/// The force of a planet's orbit, u_e and the place where its pull ends being the roots of 3 m
/// u^2 - u + m/h^2.
#[test]
fn the_end_of_a_well_is_named_by_the_coordinate() {
    let oscillator = Oscillator::parse("u'' + u - m/h^2 - 3*m*u^2 = 0").unwrap();
    let at = [("A", "1/100"), ("m", "1/20"), ("h", "1")];
    let found = judged_by(&oscillator, &Options::default(), &at);
    let place = number_behind(&found, "the unstable equilibrium u = ");
    let expected = (1.0 + (1.0_f64 - 12.0 * 0.05 * 0.05).sqrt()) / (6.0 * 0.05);
    assert!((place - expected).abs() < 1e-5 * expected, "{place}");
}

/// By halving.
fn zero(function: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    assert!(function(low) * function(high) < 0.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if function(low) * function(middle) <= 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    0.5 * (low + high)
}

#[test]
fn a_law_that_reaches_zero_says_where() {
    const WORDS: &str = "omega^2 of the formula reaches zero at A = ";
    // omega^2 = 1 +- 3 A^2/4 - 3 A^4/128.
    let root =
        |sign: f64| ((0.75 * sign + (0.5625 + 12.0 / 128.0_f64).sqrt()) / (6.0 / 128.0)).sqrt();
    for (equation, sign) in [("x'' + x + x^3 = 0", 1.0), ("x'' + x - x^3 = 0", -1.0)] {
        for (amplitude, side) in [("1/2", 1.0), ("-1/2", -1.0)] {
            let found = judged(equation, Method::LindstedtPoincare, Some(4), amplitude);
            let place = number_behind(&found, WORDS);
            assert!((place / (side * root(sign)) - 1.0).abs() < 1e-5, "{equation}: {place}");
            assert!(!range(&found, WORDS).unwrap().outside);
        }
    }
    let beyond = judged("x'' + x + x^3 = 0", Method::LindstedtPoincare, Some(4), "6");
    assert!(range(&beyond, WORDS).unwrap().outside && beyond.frequency.is_none());
    let never = judged("x'' + x + x^3 = 0", Method::LindstedtPoincare, Some(2), "6");
    assert!(range(&never, "reaches zero").is_none() && range(&never, "pole").is_none());
    // omega^2 = f'(A/2), which is negative in a place far narrower than any amplitude.
    let slope = |x: f64| {
        let bump = (-1e4 * (x * x - 1.0).powi(2)).exp() / 10.0;
        1.0 + bump * (1.0 - 4e4 * x * x * (x * x - 1.0))
    };
    let equation = "x'' + x + x*exp(-10000*(x^2 - 1)^2)/10 = 0";
    let narrow = judged(equation, Method::FrequencyFormula, None, "1");
    let expected = 2.0 * zero(slope, 1.0, 1.002);
    let place = number_behind(&narrow, WORDS);
    assert!((place / expected - 1.0).abs() < 1e-5, "{place} {expected}");
}

#[test]
fn a_pole_of_a_law_is_no_zero() {
    const WORDS: &str = "the formula has a pole at A = ";
    // omega^2 = 1 + c1 s + c2 s^2 with s = A^2 gives the approximant [1/1] = (1 + (c1 - c2/c1)
    // s)/(1 - c2 s/c1).
    for (cubic, quintic, amplitude, outside) in [
        ("1", "1", "1/2", false),
        ("1", "1", "-1/2", false),
        ("1", "1", "6/5", true),
        ("4", "1", "1", false),
        ("1/1000", "1/1000000", "10", false),
    ] {
        let number =
            |text: &str| parse_expression(text).unwrap().evaluate(&Default::default()).unwrap();
        let (c1, quintic_term) = (0.75 * number(cubic), 0.625 * number(quintic));
        let c2 = quintic_term - 3.0 / 128.0 * number(cubic).powi(2);
        let equation = format!("x'' + x + {cubic}*x^3 + {quintic}*x^5 = 0");
        let options = Options {
            method: Some(Method::Pade),
            degrees: Some(Degrees::Quotient(1, 1)),
            ..Options::default()
        };
        let found =
            judged_by(&Oscillator::parse(&equation).unwrap(), &options, &[("A", amplitude)]);
        let expected = (c1 / c2).sqrt().copysign(number(amplitude));
        let place = number_behind(&found, WORDS);
        assert!((place / expected - 1.0).abs() < 1e-5, "{equation}: {place} {expected}");
        assert_eq!(range(&found, WORDS).unwrap().outside, outside, "{equation} at {amplitude}");
        assert!(range(&found, "reaches zero").is_none(), "{:?}", found.ranges);
    }
}

#[test]
fn what_lies_beyond_one_well_may_be_several() {
    // V = x^4/4 - x^2/2 about x = 1: the separatrix through x = 0 ends at x = sqrt(2).
    let wells = Oscillator::parse("x'' - x + x^3 = 0").unwrap();
    let wells = wells.about(parse_expression("1").unwrap());
    let options = Options::default();
    let found = |amplitude| judged_by(&wells, &options, &[("A", amplitude)]);
    let words =
        "periodic for -1 < A < 0.414214: the separatrix passes the unstable equilibrium x = 0";
    for inside in ["1/4", "-3/4"] {
        let found = found(inside);
        assert_eq!(range(&found, "periodic").map(|range| range.text.as_str()), Some(words));
    }
    for beyond in ["1/2", "1", "-3"] {
        let found = found(beyond);
        let range = range(&found, words).unwrap_or_else(|| panic!("{:?}", found.ranges));
        assert!(
            range.text.ends_with("the motion runs over several wells, and does so here")
                && !range.outside,
            "{range:?}"
        );
    }
}

#[test]
fn a_force_without_end_has_no_well() {
    for (equation, amplitude) in [
        // Beyond all numbers, but only in numbers.
        ("x'' + sinh(x) = 0", "1"),
        ("x'' + x*exp(x^2) = 0", "-1"),
        ("x'' + x + x^31 = 0", "1/2"),
        // Without a value at x = 1, where its branches meet.
        ("x'' + 2*x + (x - 1)^2/abs(x - 1) - 1 = 0", "1/2"),
        // Dying away.
        ("x'' + x*exp(-x^2) = 0", "1"),
        ("x'' + x/(1 + x^2)^2 = 0", "1"),
    ] {
        let found = judged(equation, Method::Exact, None, amplitude);
        assert!(range(&found, "periodic").is_none(), "{equation}: {:?}", found.ranges);
    }
    for (equation, amplitude, words) in [
        ("x'' + x/(1 - x^2) = 0", "1/2", "periodic for |A| < 1: the force ends at x = 1"),
        (
            "x'' + tan(3*x) = 0",
            "1/10",
            "periodic for |A| < 0.523599: the force ends at x = 0.523599",
        ),
        (
            "x'' + x/((1 + x)*(2 - x)) = 0",
            "1/2",
            "periodic for -1 < A < 2: the force ends at x = -1, the force ends at x = 2",
        ),
        ("x'' + log(1 + x) = 0", "-1/2", "periodic for -1 < A < 1.71828: the force ends at x = -1"),
        (
            "x'' + x*(2 - x)*(x + 3) = 0",
            "1",
            "periodic for -1.33333 < A < 2: the separatrix passes the unstable equilibrium x = 2",
        ),
    ] {
        let found = judged(equation, Method::Exact, None, amplitude);
        assert_eq!(
            range(&found, "periodic").map(|range| range.text.as_str()),
            Some(words),
            "{equation}"
        );
    }
}

#[test]
fn singularities_have_their_place_and_an_amplitude_beyond_is_outside() {
    // The exact law of a cubic force ends at A^2 = -c1/c3.
    for (equation, radius) in [
        ("x'' + x + x^3 = 0", 1.0_f64),
        ("x'' + 2*x + x^3 = 0", 2.0_f64.sqrt()),
        ("x'' + 9*x + 4*x^3 = 0", 1.5),
    ] {
        for (amplitude, outside) in
            [("1/2", false), ("-1/2", false), ("9/10", false), ("8/5", true), ("-8/5", true)]
        {
            let found = judged(equation, Method::LindstedtPoincare, None, amplitude);
            let place = number_behind(&found, "singularity is at A^2 = ");
            assert!((place / -radius.powi(2) - 1.0).abs() < 5e-3, "{equation}: {place}");
            let estimate = number_behind(&found, "|A| < about ");
            assert!((estimate / radius - 1.0).abs() < 5e-3, "{equation}: {estimate}");
            let range = range(&found, "the series converges").unwrap();
            assert_eq!(range.outside, outside, "{equation} at {amplitude}");
        }
    }
    // At the separatrix of a softening force the singularity is real and positive.
    let soft = judged("x'' + x - x^3 = 0", Method::LindstedtPoincare, None, "1/2");
    let place = number_behind(&soft, "singularity is at A^2 = ");
    assert!((place - 1.0).abs() < 0.02, "{place}");
}

#[test]
fn a_formula_fails_first_where_the_far_turning_point_meets_a_narrow_place() {
    // At x = -1 the force all but vanishes: a motion that turns there takes its time, one that
    // passes it does not notice.
    let equation = "x'' + x + x^2/5 + 79/100*exp(-10000*(x + 1)^2) = 0";
    let rise = |x: f64| x * x / 2.0 + x.powi(3) / 15.0;
    // The bump is worth 0.79 sqrt(pi)/100 of energy, half of it up to its middle.
    let bump = 0.79 * std::f64::consts::PI.sqrt() / 100.0;
    let reaching = |part: f64| zero(|x| rise(x) + part * bump - rise(-1.0), 0.1, 2.0);
    for method in [Method::LindstedtPoincare, Method::HarmonicBalance] {
        let found = judged(equation, method, None, "2");
        let end = number_behind(&found, "within 1 % up to A = ");
        assert!(
            reaching(1.2) < end && end < reaching(-0.2),
            "{end} between {} and {}",
            reaching(1.2),
            reaching(-0.2)
        );
    }
}

#[test]
fn a_range_that_ends_before_the_first_amplitude_looked_at() {
    const WORDS: &str = "within 1 % up to A = ";
    let good =
        |amplitude| judged("x'' + x + x^3 = 0", Method::LindstedtPoincare, Some(2), amplitude);
    // omega^2 = 1 + 3 A^2/4 against the exact frequency.
    let end = number_behind(&good("1/2"), WORDS);
    for amplitude in ["1000", "-1000", "20"] {
        let found = good(amplitude);
        assert!((number_behind(&found, WORDS).abs() / end - 1.0).abs() < 2e-3, "{amplitude}");
        assert!(range(&found, WORDS).unwrap().outside);
    }
    // Off by 2.2 % at every amplitude, however small.
    let nowhere = judged("x'' + x^3 = 0", Method::EnergyBalance, None, "1");
    assert!(range(&nowhere, "within 1 % at no amplitude").unwrap().outside);
}

#[test]
fn a_mirrored_force_has_the_mirrored_ranges() {
    let words = |equation: &str, amplitude: &str| {
        let found = judged(equation, Method::LindstedtPoincare, None, amplitude);
        let place = number_behind(&found, "singularity is at A = ");
        let ends = ["|A| < about ", "reaches zero at A = ", "within 1 % up to A = "];
        let [radius, zero, end] = ends.map(|words| number_behind(&found, words));
        (radius, [place, zero, end])
    };
    for quadratic in ["", "3*", "10*"] {
        let plus = words(&format!("x'' + x + {quadratic}x^2 = 0"), "-1/50");
        let minus = words(&format!("x'' + x - {quadratic}x^2 = 0"), "1/50");
        assert_eq!(plus.0, minus.0);
        assert_eq!(plus.1, minus.1.map(|value| -value));
        // The well ends at A = 1/2 of the one-unit force, and the series with it.
        let unit: f64 = quadratic.trim_end_matches('*').parse().unwrap_or(1.0);
        assert!((plus.0 * unit - 0.5).abs() < 5e-3, "{}", plus.0);
    }
}

/// What sees of a force only its derivatives at rest says that corners lie farther out; what sees
/// all of it need not.
#[test]
fn an_expansion_ends_at_the_first_corner() {
    let equation = "x'' + x + x^3 + 3*(x - 1)*H(x - 1) - 3*(-x - 1)*H(-x - 1) = 0";
    let oscillator = Oscillator::parse(equation).unwrap();
    let smooth = Oscillator::parse("x'' + x + x^3 = 0").unwrap();
    for (method, expands) in [
        (Method::LindstedtPoincare, true),
        (Method::HomotopyPerturbation, true),
        (Method::HomotopyAnalysis, true),
        (Method::Pade, true),
        (Method::EnergyBalance, false),
        (Method::HarmonicBalance, false),
        (Method::MaxMin, false),
    ] {
        let options = Options { method: Some(method), ..Options::default() };
        let said = |oscillator: &Oscillator| {
            let solution = solve(oscillator, &options).unwrap();
            solution.validity.contains(&Note::Corners)
        };
        assert_eq!(said(&oscillator), expands, "{}", method.name());
        assert!(!said(&smooth), "{}", method.name());
    }
}

#[test]
fn an_integral_by_quadrature_says_how_good_it_is() {
    let found = judged("x'' + x + x^3/(1 + x^4) = 0", Method::Hamiltonian, None, "1");
    let range = range(&found, "the integral of the law is good to").unwrap();
    assert!(range.text.ends_with("good to 1e-15") && !range.outside, "{range:?}");
}

#[test]
fn what_is_left_over_and_how_far_the_motion_strays() {
    // x = A cos(theta) with omega^2 = 1 + 3 A^2/4 leaves A^3 cos(3 theta)/4 of a force of
    // (A + 3 A^3/4) cos(theta) + A^3 cos(3 theta)/4.
    for (amplitude, a) in [("1", 1.0_f64), ("-2", 2.0), ("1/10", 0.1)] {
        let found = judged("x'' + x + x^3 = 0", Method::EnergyBalance, None, amplitude);
        let exact = judged("x'' + x + x^3 = 0", Method::Hamiltonian, None, amplitude);
        let left = a.powi(3) / 4.0;
        let expected = left / (a + 3.0 * left).hypot(left);
        let residual = exact.residual.unwrap();
        assert!((residual / expected - 1.0).abs() < 1e-9, "{residual} {expected}");
        // The same law, so the same motion and the same numbers.
        assert!((found.residual.unwrap() / expected - 1.0).abs() < 1e-9);
    }
    // Over the amplitude: in units a thousand times larger it is the same.
    let deviation = |equation, amplitude| {
        judged(equation, Method::Hamiltonian, None, amplitude).max_deviation.unwrap()
    };
    let (one, other) =
        (deviation("x'' + x + x^3 = 0", "2"), deviation("x'' + x + x^3/1000000 = 0", "2000"));
    assert!((one / other - 1.0).abs() < 1e-6 && one > 0.01, "{one} {other}");
}

/// Released beyond the pole so far out that its energy is lost in rounding: the motion ends at the
/// pole all the same.
#[test]
fn a_pole_that_rounding_hides_ends_the_motion() {
    let oscillator = Oscillator::parse("x'' + 2.51*x/(1.07 - x)^2 + x = 0").unwrap();
    let solution = solve(&oscillator, &Options::default()).unwrap();
    for amplitude in ["7.26", "72600", "7260000", "1e9"] {
        let at = format!("A = {amplitude}").parse().unwrap();
        let error = judge(&oscillator, &solution, &at, 0.01).unwrap_err().to_string();
        assert_eq!(
            error, "the motion runs into x = 1.07, where the force has no finite value",
            "A = {amplitude}"
        );
    }
}

/// Thousands of waves along a motion are looked at no farther than a second's work allows; hundreds
/// of thousands are refused.
#[test]
fn forces_that_wave_all_the_way_are_looked_at_less_far() {
    let equation = "x'' + x - 0.178*cos(x) = 0";
    let found = judged(equation, Method::Exact, None, "25600");
    // A small wave on a linear force moves its frequency by far less than the ratio of the two.
    assert!((found.true_frequency - 1.0).abs() < 1e-8, "{found:?}");
    let looked = number_behind(&found, "at every amplitude looked at, up to A = ");
    assert!((25_600.0..100.0 * 25_600.0).contains(&looked), "{looked}");
    let oscillator = Oscillator::parse(equation).unwrap();
    let solution = solve(&oscillator, &Options::default()).unwrap();
    let error = judge(&oscillator, &solution, &"A = 1e6".parse().unwrap(), 0.01).unwrap_err();
    assert!(error.to_string().contains("changes too often"), "{error}");
}

/// The tail of a bump says nothing at rest of the bump itself: the exact period beside the energy,
/// whose potential is `3.08 x^2 - (2330/100.2) exp(-50.1 (x - 1.41)^2)`, and the shared integral
/// beside its sum.
#[test]
fn a_bump_whose_tail_vanishes_at_rest_is_no_tail_alone() {
    const POINTS: u32 = 200_000;
    let angles = || (0..POINTS).map(|k| (f64::from(k) + 0.5) * 0.5 * TAU / f64::from(POINTS));
    let bell = |x: f64| (-50.1 * (x - 1.41).powi(2)).exp();
    let equation = "x'' + 6.16*x + 2330*(x - 1.41)*exp(-50.1*(x - 1.41)^2) = 0";
    let amplitude = 3.52_f64;
    let potential = |x: f64| 3.08 * x * x - 2330.0 / 100.2 * bell(x);
    let time = |angle: f64| {
        let speed = (2.0 * (potential(amplitude) - potential(amplitude * angle.cos()))).sqrt();
        amplitude * angle.sin() / speed
    };
    let period = TAU / f64::from(POINTS) * angles().map(time).sum::<f64>();
    let exact = judged(equation, Method::Exact, None, "3.52");
    assert!((exact.true_frequency * period / TAU - 1.0).abs() < 1e-9, "{}", exact.true_frequency);
    let force = |x: f64| 6.16 * x + 2330.0 * (x - 1.41) * bell(x);
    let projection = |angle: f64| force(amplitude * angle.cos()) * angle.cos();
    let squared = 2.0 / (amplitude * f64::from(POINTS)) * angles().map(projection).sum::<f64>();
    let one_term = judged(equation, Method::Hamiltonian, None, "3.52");
    let found = one_term.frequency.expect("a law");
    assert!((found / squared.sqrt() - 1.0).abs() < 1e-12, "{found}");
}

/// A sine that waves thousands of times along the motion: a quadrature knows less of it than its
/// closed form, which is `J1`.
#[test]
fn a_closed_form_is_not_given_up_for_a_worse_quadrature() {
    const POINTS: u32 = 100_000;
    let oscillator = Oscillator::parse("x'' + 3.2*sin(1.01*x) = 0").unwrap();
    let options = Options { method: Some(Method::Hamiltonian), ..Options::default() };
    let solution = solve(&oscillator, &options).unwrap();
    let amplitude = 23_100.0;
    let square =
        frequency_squared_of(&oscillator, &solution, &[("A".into(), amplitude)].into()).unwrap();
    let sum: f64 = (0..POINTS)
        .map(|k| (f64::from(k) + 0.5) * 0.5 * TAU / f64::from(POINTS))
        .map(|angle| 3.2 * (1.01 * amplitude * angle.cos()).sin() * angle.cos())
        .sum();
    let expected = 2.0 / (amplitude * f64::from(POINTS)) * sum;
    assert!((square / expected - 1.0).abs() < 1e-8, "{square} {expected}");
}

/// The range of a formula begins at rest, however far out the motion is that was asked for.
#[test]
fn a_range_ends_where_it_ends_for_a_smaller_motion() {
    let end = |amplitude: &str| {
        let equation = "x'' + 2.02*x - 0.562*x^2 + 1.81*x^3 = 0";
        let verification = judged(equation, Method::Hamiltonian, None, amplitude);
        let mut ends = verification
            .ranges
            .iter()
            .filter_map(|range| range.text.split_once("within 1 % up to A = "));
        let (_, end) = ends.next().expect("a formula that fails there");
        end.parse::<f64>().expect("a number")
    };
    let near = end("-2");
    for amplitude in ["-10", "-606", "-100000"] {
        let far = end(amplitude);
        assert!((far / near - 1.0).abs() < 2e-3, "A = {amplitude}: {far} {near}");
    }
}

/// The refusal of a motion that is released there.
fn refused(equation: &str, amplitude: &str) -> String {
    let oscillator = Oscillator::parse(equation).unwrap();
    let solution = solve(&oscillator, &Options::default()).unwrap();
    let mut values = Values::default();
    values.insert(Symbol::new("A"), amplitude.parse().unwrap()).unwrap();
    match judge(&oscillator, &solution, &values, 0.01) {
        Ok(_) => panic!("{equation}: a motion from {amplitude}"),
        Err(error) => error.to_string(),
    }
}

/// Motions of an equation are periodic up to an end: at an amplitude inside the range is stated, at
/// one outside the refusal names it. Out comes the refusal.
fn is_periodic_until([equation, inside, outside, end]: [&str; 4]) -> String {
    let found = judged(equation, Method::Exact, None, inside);
    let text = range(&found, "periodic").map(|range| range.text.clone());
    assert_eq!(text, Some(format!("periodic for {end}")), "{equation}");
    let words = refused(equation, outside);
    assert!(words.ends_with(&format!("motions are periodic for {end}")), "{equation}: {words}");
    words
}

/// Released on the wall of a well that levels off on the other side, a motion has the energy to
/// leave from where V is that at infinity.
#[test]
fn a_motion_must_turn_back_on_the_other_side_too() {
    for (equation, inside, outside, end) in [
        // V = 1/(2 r^2) - 1/r, r = 1 + x, is zero at r = 1/2 and at infinity.
        (
            "x'' + 1/(1 + x)^2 - 1/(1 + x)^3 = 0",
            "-0.49",
            "-0.51",
            "A > -0.5: beyond it the motion escapes to x = infinity",
        ),
        // Lennard-Jones: r^-12 - 2 r^-6 is zero at r^6 = 1/2.
        (
            "x'' + 12*((1 + x)^(-7) - (1 + x)^(-13)) = 0",
            "-0.1",
            "-0.12",
            "A > -0.109101: beyond it the motion escapes to x = infinity",
        ),
        // Morse: (1 - exp(-x))^2/2 is 1/2 at infinity and at -log 2.
        (
            "x'' + (1 - exp(-x))*exp(-x) = 0",
            "-0.6",
            "-0.7",
            "A > -0.693147: beyond it the motion escapes to x = infinity",
        ),
        (
            "x'' + (exp(x) - 1)*exp(x) = 0",
            "0.6",
            "0.7",
            "A < 0.693147: beyond it the motion escapes to x = -infinity",
        ),
        // V = 1/r - 2/sqrt(r), which dies away slowly: zero at r = 1/4.
        (
            "x'' + (1 + x)^(-3/2) - (1 + x)^(-2) = 0",
            "-0.7",
            "-0.8",
            "A > -0.75: beyond it the motion escapes to x = infinity",
        ),
        // V = tanh(x)^2/2 + tanh(x)/4, from -1/32 at tanh(x) = -1/4: 1/4 on the left and where
        // tanh(x) = 1/2, 3/4 on the right.
        (
            "x'' + (tanh(x) + 1/4)*(1 - tanh(x)^2) = 0",
            "0.7",
            "0.9",
            "A < 0.804719: beyond it the motion escapes to x = -infinity",
        ),
    ] {
        is_periodic_until([equation, inside, outside, end]);
    }
    // log(r) + 1/r grows without end, and so does sqrt(1 + x^2).
    let found = judged("x'' + 1/(1 + x) - 1/(1 + x)^2 = 0", Method::Exact, None, "-0.9");
    let text = range(&found, "periodic").map(|range| range.text.clone());
    assert_eq!(text.as_deref(), Some("periodic for A > -1: the force ends at x = -1"));
    let found = judged("x'' + x/sqrt(1 + x^2) = 0", Method::Exact, None, "30");
    assert!(range(&found, "periodic").is_none(), "{:?}", found.ranges);
}

/// `M x'^2/2 + U` with `M = exp(2 int g)`, `U' = M f` tells where motions of `x'' + g x'^2 + f = 0`
/// are periodic.
#[test]
fn inertia_that_depends_on_the_position_has_its_wells() {
    for (equation, inside, outside, end) in [
        // M = 1 + x^2, U = x^2/2 - x^4/4: a hilltop at one.
        (
            "(1 + x^2)*x'' + x*x'^2 + x*(1 - x^2) = 0",
            "0.9",
            "1.2",
            "|A| < 1: the separatrix passes the unstable equilibrium x = 1",
        ),
        // M = exp(2 x), U = exp(2 x)(x/2 - 1/4): zero at 1/2 and infinitely far to the left.
        (
            "x'' + x + x'^2 = 0",
            "0.45",
            "1.2",
            "A < 0.5: beyond it the motion escapes to x = -infinity",
        ),
        // M = exp(-x), U = -exp(-x)(1 + x).
        (
            "x'' + x - x'^2/2 = 0",
            "-0.9",
            "-1.1",
            "A > -1: beyond it the motion escapes to x = infinity",
        ),
        // M = 1 - x^2 is zero where the force is infinite, and U = x^2/2.
        ("(1 - x^2)*x'' - x*x'^2 + x = 0", "0.9", "1.1", "|A| < 1: the force ends at x = 1"),
        // About x = 1: M = exp(2 x), U' = exp(2 x)(x^2 - 1), U = exp(2 x)(2 x^2 - 2 x - 1)/4, at x
        // = -1 3 exp(-2)/4.
        (
            "x'' + x'^2 + x^2 - 1 = 0",
            "0.3",
            "0.45",
            "-2 < A < 0.373508: the separatrix passes the unstable equilibrium x = -1",
        ),
    ] {
        let words = is_periodic_until([equation, inside, outside, end]);
        assert!(!words.contains("no finite value") && words.len() < 250, "{equation}: {words}");
    }
    let on_the_hilltop = refused("(1 + x^2)*x'' + x*x'^2 + x*(1 - x^2) = 0", "1");
    assert!(on_the_hilltop.contains("it is on the separatrix"), "{on_the_hilltop}");
    // What velocities add that has no energy is followed, and what becomes of the motion is said.
    let runs_away = refused("x'' + x + x'^2 = 0", "0.6");
    assert!(runs_away.contains("its speed grows beyond all bounds"), "{runs_away}");
}

/// Averaged to second order, `x'' + x + x'^2 = 0` has `omega = 1 - A^2/6`: it is omega that is
/// negative, and no square.
#[test]
fn a_negative_frequency_is_said_of_omega() {
    let oscillator = Oscillator::parse("x'' + x + x'^2 = 0").unwrap();
    let table =
        lindstedt::verify::comparison::compare(&oscillator, &"A = -3".parse().unwrap(), None, 0.01)
            .unwrap();
    let reason = |method: Method, order: u32| {
        let mut rows = table.rows.iter();
        let row = rows.find(|row| row.solution.method == method && row.solution.order == order);
        row.and_then(|row| row.reason.as_ref()).map(ToString::to_string)
    };
    assert_eq!(reason(Method::Averaging, 2).as_deref(), Some("not positive: omega <= 0"));
    let solution = &table
        .rows
        .iter()
        .find(|row| row.solution.method == Method::Averaging && row.solution.order == 2);
    let motion = solution.unwrap().solution.motion_at(&"A = -3".parse().unwrap());
    assert_eq!(motion.unwrap_err().to_string(), "not positive: omega <= 0");
    // omega^2 = 1 - A^2/3 - 4 A^3/9 - 43 A^4/72.
    assert_eq!(reason(Method::LindstedtPoincare, 4).as_deref(), Some("not real: omega^2 <= 0"));
}

/// Motions that are known in closed form are judged as they are written, against Runge-Kutta; of a
/// pendulum `sin(x/2)` is a `sn`, of `x^3` the motion a `cn`, of `x^2` a `sn^2`.
#[test]
fn exact_motions_in_closed_form_are_the_true_ones() {
    for (equation, amplitudes, written) in [
        ("x'' + 4*x = 0", ["2", "-1"], "A*cos(2*t)"),
        ("x'' + x^3 = 0", ["2", "-1/10"], "A*cn(A*t, 1/2)"),
        ("x'' + x + x^3 = 0", ["20", "-1/2"], "A*cn(t*sqrt(1 + A^2), A^2/(2*(1 + A^2)))"),
        ("x'' + x - x^3 = 0", ["99/100", "-1/2"], "A*cn(t*sqrt(1 - A^2), -A^2/(2*(1 - A^2)))"),
        ("x'' + 2*sin(3*x) = 0", ["1", "-1/2"], "sn("),
        (
            "x'' + 2*sinh(3*x) = 0",
            ["1", "-1/2"],
            "2*asinh(sinh(3*A/2)*cn(sqrt(6)*t*cosh(3*A/2), tanh(3*A/2)^2))/3",
        ),
        ("x'' + x + x^2 = 0", ["9/20", "-9/10"], "sn("),
        ("x'' + x^2 - 2 = 0", ["7/5", "-2"], "sn("),
        ("x'' + x - x^3 + 2*x^5 = 0", ["3/2", "-1/2"], "dn("),
    ] {
        for amplitude in amplitudes {
            let found = judged(equation, Method::Exact, None, amplitude);
            let deviation = found.max_deviation.expect("a motion");
            assert!(deviation < 1e-8, "{equation} from {amplitude}: {deviation:e}");
        }
        let oscillator = Oscillator::parse(equation).unwrap();
        let options = Options { method: Some(Method::Exact), ..Options::default() };
        let solution = solve(&oscillator, &options).unwrap();
        let motion = solution.closed_motion.as_ref().expect("a motion").to_string();
        assert!(motion.contains(written), "{equation}: {motion}");
        // What is exported reads back.
        let document = lindstedt::export::json::solution(&solution, None);
        assert_eq!(document.read().unwrap().closed_motion, solution.closed_motion, "{equation}");
    }
}
