//! What high orders buy: singularities of the frequency, and values far beyond them.

use lindstedt::exact::{Integer, Rational, ratio, to_f64};
use lindstedt::export::text;
use lindstedt::method::numbers::evaluate;
use lindstedt::series::singularity::{Estimate, is_entire, last_power, nearest};
use lindstedt::solution::{Convergence, Degrees};
use lindstedt::verify::{converges, converges_everywhere, nearest_singularity};
use lindstedt::{Method, Options, Oscillator, Solution, Symbol, judge, solve};

/// The frequency alone to an order.
fn frequency(equation: &str, order: u32) -> Solution {
    let options = Options { order: Some(order), frequency_alone: true, ..Options::default() };
    solve(&Oscillator::parse(equation).expect("an equation"), &options).expect("a series")
}

const VAN_DER_POL: &str = "x'' - mu*(1 - x^2)*x' + x = 0";

fn found(equation: &str, order: u32) -> Convergence {
    converges(&frequency(equation, order)).unwrap_or_else(|| panic!("{equation}: no singularity"))
}

/// Whether an estimate is right within its error.
fn holds(estimate: &Estimate, truth: &Rational) -> bool {
    to_f64(&(&estimate.value - truth)).abs() <= estimate.error
}

/// A number of many digits.
fn number(text: &str) -> Rational {
    let (whole, fraction) = text.split_once('.').expect("a decimal point");
    let digits: Integer = format!("{whole}{fraction}").parse().expect("digits");
    Rational::new(digits, Integer::from(10).pow(fraction.len() as u32))
}

/// Where the true motion takes for ever: on the separatrix, real or not. The pendulum stands
/// upright at pi; a hardening spring has its separatrix at `eps A^2 = -1`; `x + x^2` lets go of
/// what starts at 1/2.
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

/// If omega^2 itself has a zero, the motion takes for ever, and the series converges beyond.
/// Kepler's radial motion has `omega^2 = (1 + 2 A)^3/(1 + A)^6`, by its third law; in a field
/// `1 - 1/x^2` the motion meets its singular place at A = -1 as well.
#[test]
fn zeros_of_the_frequency_are_no_singularities() {
    let mut said = 0;
    for (equation, orders) in [
        ("x'' + 1/(1 + x)^2 - 1/(1 + x)^3 = 0", [24, 32, 40]),
        ("x'' + 1 - 1/(1 + x)^2 = 0", [20, 24, 40]),
        // x = -1 is infinitely far up a logarithm.
        ("x'' + 1 - 1/(1 + x) = 0", [24, 32, 48]),
    ] {
        for order in orders {
            let solution = frequency(equation, order);
            assert!(converges_everywhere(&solution).is_none(), "{equation} {order}");
            if let Some(found) = converges(&solution) {
                said += 1;
                let one = ratio(1, 1);
                assert!(holds(&found.nearest.radius, &one), "{equation} {order}: {found:?}");
            }
        }
    }
    assert!(said >= 4, "{said}");
}

/// Morse's oscillator released from rest at A: `omega^2 = 1 - (1 - exp(-A))^2`, entire, with zeros
/// at `-log 2 + 2 pi i k`. Where the small parameter changes the linear force alone, omega^2 ends.
#[test]
fn a_series_without_a_singularity_says_so() {
    for order in [24, 32, 48] {
        let solution = frequency("x'' + exp(-x) - exp(-2*x) = 0", order);
        assert_eq!(converges(&solution), None, "{order}");
        let note = converges_everywhere(&solution).expect("an entire function").to_string();
        assert!(note.starts_with("the series converges everywhere"), "{note}");
    }
    let linear = frequency("x'' + x + eps*x = 0", 30);
    assert_eq!(converges(&linear), None);
    let note = converges_everywhere(&linear).expect("an end").to_string();
    assert!(note.contains("omega^2 ends with eps,"), "{note}");
    // What has a singularity does not converge everywhere.
    for (equation, order) in
        [("x'' + sin(x) = 0", 60), ("x'' + x + x^2 = 0", 24), (VAN_DER_POL, 60)]
    {
        assert_eq!(converges_everywhere(&frequency(equation, order)), None, "{equation}");
    }
}

/// `(1 - s/place)^power` to a degree.
fn planted(place: &Rational, power: &Rational, degree: usize) -> Vec<Rational> {
    let mut coefficients = vec![ratio(1, 1)];
    for k in 1..=degree as i64 {
        let last = &coefficients[k as usize - 1];
        coefficients.push(last * (ratio(k - 1, 1) - power) / (ratio(k, 1) * place));
    }
    coefficients
}

/// `exp(rate*s)` to a degree.
fn exponential(rate: &Rational, degree: usize) -> Vec<Rational> {
    let mut coefficients = vec![ratio(1, 1)];
    for k in 1..=degree as i64 {
        coefficients.push(&coefficients[k as usize - 1] * rate / ratio(k, 1));
    }
    coefficients
}

fn multiplied(left: &[Rational], right: &[Rational]) -> Vec<Rational> {
    let term = |n: usize| (0..=n).map(|k| &left[k] * &right[n - k]).sum();
    (0..left.len()).map(term).collect()
}

/// Strong and weak singularities times an entire function, with another singularity beyond or a
/// zero of the function before: the error is never larger than is said.
#[test]
fn the_error_of_a_radius_is_never_larger_than_said() {
    let (near, far, zero) = (ratio(-7, 5), ratio(-3, 1), ratio(1, 2));
    let mut said = 0;
    for degree in [24, 36] {
        for (numerator, denominator) in [(-6, 1), (-1, 2), (1, 2), (5, 2)] {
            let power = ratio(numerator, denominator);
            let singular =
                multiplied(&planted(&near, &power, degree), &exponential(&ratio(1, 3), degree));
            let beyond = planted(&far, &ratio(1, 4), degree);
            let sum: Vec<Rational> =
                singular.iter().zip(&beyond).map(|(one, other)| one + other).collect();
            let through_zero = multiplied(&singular, &planted(&zero, &ratio(1, 1), degree));
            for (name, coefficients) in [("sum", sum), ("zero", through_zero)] {
                assert!(
                    !is_entire(&coefficients) && last_power(&coefficients).is_none(),
                    "{name} {power} {degree}"
                );
                if let Some(found) = nearest(&coefficients) {
                    said += 1;
                    assert!(
                        holds(&found.radius, &-near.clone()),
                        "{name} {power} {degree}: {found:?}"
                    );
                }
            }
        }
    }
    assert!(said >= 8, "{said}");
}

/// C. M. Andersen and J. F. Geer, SIAM J. Appl. Math. 42 (1982) 678-693: branch points of omega in
/// mu^2 at a distance of about 3.42.
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
    // Another way to it: the recurrence that the coefficients of a pair obey, by least squares in
    // doubles.
    let law = frequency(VAN_DER_POL, 120);
    let law = law.law.frequency_squared().expect("a series");
    let coefficients: Vec<f64> = law.terms().map(|(_, number)| to_f64(number)).collect();
    let other = nearest_singularity(&coefficients).expect("a pair");
    assert!(
        (other.radius / to_f64(&nearest.radius.value) - 1.0).abs() < 1e-4,
        "{other:?} {found:?}"
    );
    assert!((other.angle - to_f64(&nearest.angle.value)).abs() < 1e-4, "{other:?} {found:?}");
    // So do the twenty and more of order 40, where the kind of the singularity cannot be told yet.
    for order in [40, 44, 48, 52] {
        let early = converges(&frequency(VAN_DER_POL, order))
            .unwrap_or_else(|| panic!("order {order}: no singularity"));
        let own = &early.nearest;
        assert!(own.exponent.is_none() && own.radius.error < 0.1, "{early:?}");
        assert!(
            holds(&own.radius, &nearest.radius.value) && holds(&own.angle, &nearest.angle.value),
            "{early:?}"
        );
    }
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

/// Periods of van der Pol's cycle in fixed point, 176 binary digits behind the point: Taylor series
/// from turning point to turning point, x'' = mu (1 - x^2) x' - x, and the turning point that is
/// met again by the secant rule.
struct Cycle {
    mu: Rational,
}

const BITS: usize = 176;

fn fixed(value: &Rational) -> Integer {
    (value * Rational::from_integer(Integer::from(1) << BITS)).to_integer()
}

fn product(left: &Integer, right: &Integer) -> Integer {
    (left * right) >> BITS
}

impl Cycle {
    /// The Taylor coefficients of x at a state.
    fn series(&self, x: &Integer, velocity: &Integer) -> Vec<Integer> {
        const DEGREE: usize = 40;
        let mu = fixed(&self.mu);
        let (mut place, mut square) = (vec![x.clone(), velocity.clone()], vec![]);
        for n in 0..DEGREE {
            let squares = (0..=n).map(|k| product(&place[k], &place[n - k]));
            square.push(squares.sum::<Integer>());
            // (1 - x^2) x' at this power.
            let slope = |k: usize| &place[k + 1] * Integer::from(k + 1);
            let taken: Integer = (0..=n).map(|k| product(&square[k], &slope(n - k))).sum();
            let force = product(&mu, &(slope(n) - taken)) - &place[n];
            place.push(force / Integer::from((n + 1) * (n + 2)));
        }
        place
    }

    fn state(series: &[Integer], time: &Integer) -> (Integer, Integer) {
        let zero = Integer::from(0);
        let (mut x, mut velocity) = (zero.clone(), zero);
        for coefficient in series.iter().rev() {
            velocity = product(&velocity, time) + &x;
            x = product(&x, time) + coefficient;
        }
        (x, velocity)
    }

    /// From rest at x > 0 to rest at x < 0: the time and the place.
    fn half_turn(&self, start: &Integer) -> (Integer, Integer) {
        let step = fixed(&ratio(1, 16));
        let (mut x, mut velocity, mut time) = (start.clone(), Integer::from(0), Integer::from(0));
        loop {
            let series = self.series(&x, &velocity);
            let (next, rate) = Self::state(&series, &step);
            if rate >= Integer::from(0) && next < Integer::from(0) {
                // Newton's iteration on the velocity within the step.
                let mut end = step.clone();
                for _ in 0..12 {
                    let (_, rate) = Self::state(&series, &end);
                    let (place, _) = Self::state(&series, &end);
                    let force = product(
                        &fixed(&self.mu),
                        &product(&((Integer::from(1) << BITS) - product(&place, &place)), &rate),
                    ) - &place;
                    end -= (rate << BITS) / force;
                }
                let (place, _) = Self::state(&series, &end);
                return (time + end, place);
            }
            (x, velocity) = (next, rate);
            time += &step;
        }
    }

    /// The period.
    fn period(&self) -> Rational {
        let mut places = [fixed(&ratio(2, 1)), fixed(&ratio(201, 100))];
        let miss = |place: &Integer| self.half_turn(place).1 + place;
        let mut misses = [miss(&places[0]), miss(&places[1])];
        for _ in 0..14 {
            let difference = &misses[1] - &misses[0];
            // What is left are the last digits.
            if difference == Integer::from(0) || misses[1].bits() < 16 {
                break;
            }
            let next = &places[1] - &misses[1] * (&places[1] - &places[0]) / difference;
            let [_, place] = places;
            let [_, last] = misses;
            misses = [last, miss(&next)];
            places = [place, next];
        }
        Rational::new(self.half_turn(&places[1]).0 * Integer::from(2), Integer::from(1) << BITS)
    }
}

/// The sum of a law at a value of its one symbol.
fn at(solution: &Solution, value: &Rational) -> Rational {
    let law = solution.law.frequency().expect("a series of omega");
    let terms = law.terms().map(|(monomial, number)| {
        number * num_traits::Pow::pow(value.clone(), monomial.exponent("mu".into()))
    });
    terms.sum()
}

/// E. Hairer, S. P. Norsett and G. Wanner, *Solving Ordinary Differential Equations I*, 2nd ed.,
/// exercise 16.1, print the period at mu = 1 to 29 digits; the integration above knows more, and
/// nothing of the series.
#[test]
fn the_series_of_van_der_pol_has_the_period_to_forty_digits() {
    let law = frequency(VAN_DER_POL, 160);
    let two_pi = ratio(2, 1) * number("3.14159265358979323846264338327950288419716939937510");
    for (mu, digits) in [(ratio(1, 2), 44), (ratio(1, 1), 40)] {
        let period = Cycle { mu: mu.clone() }.period();
        let by_series = &two_pi / at(&law, &mu);
        let difference = to_f64(&(&by_series - &period)).abs();
        assert!(difference < 10.0_f64.powi(-digits), "{mu}: {difference:e}");
        if mu == ratio(1, 1) {
            let printed = number("6.6632868593231301896996820305");
            assert!(to_f64(&(&period - printed)).abs() < 1e-28);
        }
    }
}

/// Far beyond the radius of convergence, 1.85, against the true motion.
#[test]
fn quotients_of_high_degree_hold_far_beyond_the_radius() {
    let oscillator = Oscillator::parse(VAN_DER_POL).expect("an equation");
    let options = Options {
        method: Some(Method::Pade),
        degrees: Some(Degrees::Quotient(40, 40)),
        ..Options::default()
    };
    let quotient = solve(&oscillator, &options).expect("a quotient");
    for (mu, error) in [("mu = 3", 1e-8), ("mu = 5", 1e-5)] {
        let judged =
            judge(&oscillator, &quotient, &mu.parse().expect("a value"), 1e-3).expect("a verdict");
        assert!(judged.relative_error.is_some_and(|found| found.abs() < error), "{mu}: {judged:?}");
    }
}

/// Quadratic approximants hold farther than quotients of as many coefficients, beyond the place
/// where their two roots cross.
#[test]
fn roots_of_quadratic_equations_hold_farther_than_quotients() {
    let oscillator = Oscillator::parse(VAN_DER_POL).expect("an equation");
    let by = |method: Method, degrees: Degrees| {
        let options =
            Options { method: Some(method), degrees: Some(degrees), ..Options::default() };
        solve(&oscillator, &options).expect("an approximant")
    };
    let root = by(Method::HermitePade, Degrees::Quadratic(13, 13, 12));
    let quotient = by(Method::Pade, Degrees::Quotient(20, 19));
    let followed =
        root.validity.iter().map(ToString::to_string).find(|note| note.contains("cross"));
    assert!(followed.is_some_and(|note| note.contains("mu^2 = 1.1397")));
    for (mu, least) in [("mu = 3", 1e-10), ("mu = 5", 1e-5), ("mu = 8", 1e-3), ("mu = 12", 1e-2)] {
        let error = |solution: &Solution| {
            let judged = judge(&oscillator, solution, &mu.parse().expect("a value"), 1e-3)
                .expect("a verdict");
            judged.relative_error.expect("an error").abs()
        };
        let (found, other) = (error(&root), error(&quotient));
        assert!(found < least && found < other, "{mu}: {found} {other}");
    }
}

/// omega^2 of Duffing's equation at eps A^2 = s: sqrt(1 + s) agm(1, sqrt(1 - s/(2 (1 + s)))),
/// squared.
fn elliptic(size: f64) -> f64 {
    let (mut a, mut g) = (1.0, f64::sqrt(1.0 - size / (2.0 * (1.0 + size))));
    for _ in 0..9 {
        (a, g) = ((a + g) / 2.0, f64::sqrt(a * g));
    }
    (1.0 + size) * a * a
}

/// R of Duffing's [2/2/2] vanishes at eps A^2 = 4.16776... and P at -0.97...: there one form of the
/// root is 0/0, and the root goes on, as far as it is right.
#[test]
fn a_root_goes_through_a_removable_zero_of_its_denominator() {
    let oscillator = Oscillator::parse("x'' + x + eps*x^3 = 0").expect("an equation");
    let options = Options {
        method: Some(Method::HermitePade),
        degrees: Some(Degrees::Quadratic(2, 2, 2)),
        ..Options::default()
    };
    let root = solve(&oscillator, &options).expect("an approximant");
    let zero = |a: f64, b: f64, c: f64| 2.0 * c / (-b + f64::sqrt(b * b - 4.0 * a * c));
    let of_r = zero(6695.0, -1_052_879_520.0, 4_388_010_496.0);
    let of_p = -zero(1_094_216_137.0, -3_462_316_704.0, 2_330_809_856.0);
    assert!((of_r - 4.1678).abs() < 1e-3 && (of_p + 0.97).abs() < 0.01, "{of_r} {of_p}");
    for (size, error) in [
        (of_p, 1e-2),
        (of_p + 1e-9, 1e-2),
        (4.0, 1e-5),
        (of_r - 1e-9, 1e-5),
        (of_r, 1e-5),
        (of_r * (1.0 + f64::EPSILON), 1e-5),
        (of_r + 1e-12, 1e-5),
        (5.0, 1e-4),
        // The two roots cross at 6.2447: the other one would be off by far more.
        (6.2447, 1e-2),
        (6.25, 1e-2),
        (10.0, 1e-3),
        (1000.0, 1e-2),
    ] {
        let numbers = [("A".into(), 1.0), ("eps".into(), size)].into();
        let found = evaluate(&oscillator, &root, &numbers)
            .unwrap_or_else(|error| panic!("{size}: {error}"));
        let off = found.frequency_squared / elliptic(size) - 1.0;
        assert!(off.abs() < error, "{size}: {off}");
    }
    let judged = judge(&oscillator, &root, &"eps = 1, A = 1".parse().expect("values"), 0.01)
        .expect("a verdict");
    let words = text::solution(&root, Some(&judged));
    let (_, reach) = words.split_once("within 1 % up to A = ").expect("a range");
    let reach: f64 = reach.split_whitespace().next().expect("a number").parse().expect("a number");
    assert!(reach > 40.0, "{words}");
}

/// omega0 = sqrt(2) stays out of the expansion: with time and force halved, `omega^2` is half of
/// it, term by term.
#[test]
fn an_irrational_linear_frequency_is_no_letter_of_the_expansion() {
    for (force, halved) in [
        ("1 - 1/(1 + x)^2", "(1 - 1/(1 + x)^2)/2"),
        ("2*x + x^2 + x^3", "x + x^2/2 + x^3/2"),
        ("2*x + x'^2*x + x^3", "x + x'^2*x + x^3/2"),
    ] {
        let [own, other] = [force, halved].map(|force| {
            let equation = format!("x'' + {force} = 0");
            let options = Options { order: Some(8), ..Options::default() };
            solve(&Oscillator::parse(&equation).expect("an equation"), &options).expect("a series")
        });
        let omega0 = Symbol::new("omega0");
        for step in &own.steps {
            let coefficients = [&step.resonance, &step.correction];
            assert!(
                coefficients.iter().all(|own| !own.symbols().contains(&omega0)),
                "{force}: {step:?}"
            );
        }
        let twice = |number: &Rational| number * ratio(2, 1);
        let law =
            |solution: &Solution| solution.law.frequency_squared().cloned().expect("a series");
        assert_eq!(law(&own), law(&other).map(twice), "{force}");
        assert_eq!(own.displacement, other.displacement, "{force}");
    }
}

/// About an equilibrium that is no fraction every number is rounded, to fifteen digits, also in
/// closed forms and what they are made of.
#[test]
fn rounded_closed_forms_are_written_with_fifteen_digits() {
    let longest = |text: &str| {
        let numbers = text.split(|letter: char| !letter.is_ascii_digit() && letter != '.');
        let digits = numbers.map(|number| number.trim_start_matches(['0', '.']).replace('.', ""));
        digits.map(|digits| digits.trim_end_matches('0').len()).max().unwrap_or(0)
    };
    for equation in ["x'' + x^3 - cos(x) = 0", "x'' + exp(x) - 2 = 0", "x'' + x^3 - x - 1 = 0"] {
        let oscillator = Oscillator::parse(equation).expect("an equation");
        let by = |method, degrees, order| Options {
            method: Some(method),
            degrees,
            order,
            ..Options::default()
        };
        let series =
            solve(&oscillator, &by(Method::LindstedtPoincare, None, Some(10))).expect("a series");
        for options in [
            by(Method::Pade, Some(Degrees::Quotient(2, 2)), None),
            by(Method::Pade, Some(Degrees::Quotient(4, 4)), None),
            by(Method::HermitePade, Some(Degrees::Quadratic(2, 2, 2)), None),
            by(Method::HomotopyPerturbation, None, None),
        ] {
            let solution = solve(&oscillator, &options).expect("an answer");
            let words = text::solution(&solution, None);
            assert!(longest(&words) <= 15, "{equation}: {words}");
            let numbers = [("A".into(), 0.01)].into();
            let squared = |solution: &Solution| {
                evaluate(&oscillator, solution, &numbers)
                    .unwrap_or_else(|error| panic!("{equation}: {error}"))
                    .frequency_squared
            };
            let off = squared(&solution) / squared(&series) - 1.0;
            let allowed = if solution.degrees.is_some() { 1e-9 } else { 1e-3 };
            assert!(off.abs() < allowed, "{equation}: {off} {words}");
        }
    }
}

/// omega^2 of Morse's oscillator is `1 - (1 - exp(-A))^2`. At A = 6 its series of order 48 is right
/// and loses nine digits: that is said, and the value is off by no more. At A = 1 nothing is lost,
/// and nothing is said.
#[test]
fn digits_that_cancel_are_said_to_be_lost() {
    let morse = Oscillator::parse("x'' + exp(-x) - exp(-2*x) = 0").expect("an equation");
    let solution = frequency("x'' + exp(-x) - exp(-2*x) = 0", 60);
    for (amplitude, is_said) in [(1, false), (6, true)] {
        let at = format!("A = {amplitude}").parse().expect("a value");
        let judged = judge(&morse, &solution, &at, 0.01).expect("a verdict");
        let words = text::solution(&solution, Some(&judged));
        let said = words.split_once("rounding moves omega^2 by ");
        assert_eq!(said.is_some(), is_said, "{words}");
        let truth = 1.0 - (1.0 - f64::exp(-f64::from(amplitude))).powi(2);
        let off = judged.frequency.expect("a frequency").powi(2) / truth - 1.0;
        let allowed = match said {
            Some((_, rest)) => {
                rest.split_whitespace().next().expect("a number").parse().expect("a number")
            }
            None => 1e-12,
        };
        assert!(off.abs() <= allowed, "{amplitude}: {off} {allowed}");
    }
}

/// omega of Duffing's equation at eps A^2 = s is sqrt(1 + s) agm(1, sqrt(1 - s/(2 (1 + s)))).
#[test]
fn a_quotient_of_high_degree_is_the_elliptic_integral() {
    let oscillator = Oscillator::parse("x'' + x + eps*x^3 = 0").expect("an equation");
    let options = Options {
        method: Some(Method::Pade),
        degrees: Some(Degrees::Quotient(31, 30)),
        ..Options::default()
    };
    let quotient = solve(&oscillator, &options).expect("a quotient");
    for size in [0.5, 10.0, 1000.0] {
        let (mut a, mut g) = (1.0, f64::sqrt(1.0 - size / (2.0 * (1.0 + size))));
        for _ in 0..9 {
            (a, g) = ((a + g) / 2.0, f64::sqrt(a * g));
        }
        let numbers = [("A".into(), 1.0), ("eps".into(), size)].into();
        let found = evaluate(&oscillator, &quotient, &numbers).expect("a value");
        let omega = f64::sqrt(1.0 + size) * a;
        assert!(
            (found.frequency_squared.sqrt() / omega - 1.0).abs() < 1e-9,
            "{size}: {found:?} {omega}"
        );
    }
}

/// The frequency alone is judged like that of the whole answer.
#[test]
fn the_frequency_alone_has_the_verdict_of_the_whole() {
    for (equation, values) in [
        (VAN_DER_POL, "mu = 1/2"),
        ("x'' + x + eps*x^3 = 0", "eps = 1/4, A = 1"),
        ("x'' + sin(x) = 0", "A = 3/2"),
    ] {
        let oscillator = Oscillator::parse(equation).expect("an equation");
        let verdict = |frequency_alone: bool| {
            let options = Options { order: Some(8), frequency_alone, ..Options::default() };
            let solution = solve(&oscillator, &options).expect("an answer");
            judge(&oscillator, &solution, &values.parse().expect("values"), 0.01)
                .expect("a verdict")
        };
        let (whole, alone) = (verdict(false), verdict(true));
        assert_eq!(
            (alone.frequency, alone.verdict),
            (whole.frequency, whole.verdict),
            "{equation}"
        );
        assert_eq!(
            (alone.relative_error, alone.slope),
            (whole.relative_error, whole.slope),
            "{equation}"
        );
        assert_eq!((alone.max_deviation, alone.residual), (None, None), "{equation}");
    }
}
