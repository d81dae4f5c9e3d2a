//! Derived series against published ones.
//!
//! - Duffing: A. H. Nayfeh, D. T. Mook, *Nonlinear Oscillations*, Wiley 1979, chapter 2, and the
//!   expansion of the exact frequency pi sqrt(1 + s) / (2 K(s/(2 + 2 s))).
//! - Pendulum: the expansion of pi / (2 K(sin^2(A/2))).
//! - Van der Pol: C. M. Andersen, J. F. Geer, SIAM J. Appl. Math. 42 (1982) 678-693.
//! - Complete elliptic integrals as power series: *NIST Digital Library of Mathematical
//!   Functions*, 19.5.1 and 19.5.2.
//!
//! Where a period is an elliptic integral, its series is an independent truth to any order; the
//! judge then measures the error that remains and the exponent with which it vanishes.

use std::f64::consts::PI;

use lindstedt::Values;
use lindstedt::exact::{Integer, POLYNOMIALS, Polynomial, Polynomials, Rational};
use lindstedt::exact::{factorial, ratio};
use lindstedt::expr::parse_expression;
use lindstedt::method::{Options, Reason, Refusal, solve};
use lindstedt::oscillator::OscillatorError;
use lindstedt::series::FourierSeries;
use lindstedt::solution::{AmplitudeConvention, Method, Solution};
use lindstedt::verify::{self, Verification};
use lindstedt::{Oscillator, Symbol};
use num_traits::{One, Pow, Zero};

fn derive(equation: &str, order: u32, amplitude: Option<AmplitudeConvention>) -> Solution {
    let oscillator = Oscillator::parse(equation).expect("an oscillator");
    solve(&oscillator, &Options { order: Some(order), amplitude, ..Options::default() })
        .expect("a solution")
}

fn polynomial(text: &str) -> Polynomial {
    let expression = parse_expression(text).expect("an expression");
    expression.to_polynomial(&mut |_| None).expect("short").expect("a polynomial")
}

fn law(solution: &Solution) -> &Polynomial {
    solution.law.frequency().expect("a polynomial law")
}

fn law_squared(solution: &Solution) -> &Polynomial {
    solution.law.frequency_squared().expect("a polynomial law")
}

/// `c_k(A)` of `cos k theta`.
fn cosine(solution: &Solution, k: usize) -> Polynomial {
    solution.displacement.cosine(k).mean().0
}

fn sine(solution: &Solution, k: usize) -> Polynomial {
    solution.displacement.sine(k).mean().0
}

const INITIAL: Option<AmplitudeConvention> = Some(AmplitudeConvention::Initial);
const FIRST_HARMONIC: Option<AmplitudeConvention> = Some(AmplitudeConvention::FirstHarmonic);

#[test]
fn duffing_to_order_eight() {
    let solution = derive("x'' + x + eps*x^3 = 0", 8, None);
    let expected = "1 + 3/8*s - 21/256*s^2 + 81/2048*s^3 - 6549/262144*s^4 + 37737/2097152*s^5 - 936183/67108864*s^6 \
                    + 6077907/536870912*s^7 - 2604833685/274877906944*s^8";
    assert_eq!(*law(&solution), polynomial(&expected.replace('s', "(eps*A^2)")));
    let expected = "1 + 3/4*s - 3/128*s^2 + 9/512*s^3 - 1779/131072*s^4 + 5643/524288*s^5 - 146661/16777216*s^6 \
                    + 486603/67108864*s^7";
    let eps = Symbol::new("eps");
    assert_eq!(
        law_squared(&solution).truncated(eps, 7),
        polynomial(&expected.replace('s', "(eps*A^2)"))
    );
}

#[test]
fn duffing_motion_to_order_five() {
    let solution = derive("x'' + x + eps*x^3 = 0", 5, None);
    // Coefficients of cos k theta in u_1 ... u_5 at A = 1, over the denominators 32, 1024, 32768,
    // 2^20, 2^25.
    let orders: [(i64, &[(usize, i64)]); 5] = [
        (32, &[(3, 1), (1, -1)]),
        (1024, &[(5, 1), (3, -24), (1, 23)]),
        (32_768, &[(7, 1), (5, -48), (3, 594), (1, -547)]),
        (1_048_576, &[(9, 1), (7, -72), (5, 1766), (3, -15_121), (1, 13_426)]),
        (33_554_432, &[(11, 1), (9, -96), (7, 3514), (5, -58_944), (3, 394_701), (1, -339_176)]),
    ];
    for (index, (denominator, coefficients)) in orders.iter().enumerate() {
        let order = index as i32 + 1;
        for k in 0..=13 {
            let expected =
                coefficients.iter().find(|entry| entry.0 == k).map_or(0, |entry| entry.1);
            let monomial = polynomial(&format!("eps^{order}*A^{}", 2 * order + 1));
            let (monomial, _) = monomial.single_term().expect("one term");
            let expected = Rational::new(expected.into(), (*denominator).into());
            assert_eq!(
                cosine(&solution, k).coefficient(monomial),
                expected,
                "u_{order}, cos {k} theta"
            );
            assert_eq!(sine(&solution, k), polynomial("0"));
        }
    }
}

#[test]
fn both_amplitude_conventions_and_the_way_between_them() {
    let equation = "x'' + x + eps*x^3 = 0";
    let by_first_harmonic = derive(equation, 3, FIRST_HARMONIC);
    let expected = polynomial("1 + 3*eps*a^2/8 - 15*eps^2*a^4/256 + 123*eps^3*a^6/8192");
    assert_eq!(*law(&by_first_harmonic), expected);
    // a = A (1 - s/32 + ...) is the first harmonic of the motion by A; put into the law by a it
    // gives the law by A.
    let (eps, a) = (Symbol::new("eps"), Symbol::new("a"));
    let initial = derive(equation, 3, INITIAL);
    let first_harmonic = cosine(&initial, 1);
    assert_eq!(
        first_harmonic,
        polynomial("A - eps*A^3/32 + 23*eps^2*A^5/1024 - 547*eps^3*A^7/32768")
    );
    let converted =
        law(&by_first_harmonic).substitute(a, &first_harmonic).expect("positive powers");
    assert_eq!(converted.truncated(eps, 3), *law(&initial));
}

#[test]
fn pendulum_to_the_tenth_power() {
    let solution = derive("x'' + sin(x) = 0", 10, None);
    let expected = "1 - A^2/16 + A^4/3072 - 23*A^6/737280 - 2519*A^8/1321205760";
    assert_eq!(law(&solution).truncated("A".into(), 8), polynomial(expected));
    let expected = "1 - A^2/8 + 7*A^4/1536 - 19*A^6/184320 + 127*A^8/660602880";
    assert_eq!(law_squared(&solution).truncated("A".into(), 8), polynomial(expected));
    // T/(2 pi) times omega is one, to A^10.
    let period = "1 + A^2/16 + 11*A^4/3072 + 173*A^6/737280 + 22931*A^8/1321205760 + 1319183*A^10/951268147200";
    let product =
        parse_expression(&format!("({period})*({})", law(&solution))).expect("an expression");
    let product = product.to_polynomial(&mut |_| None).expect("short").expect("a polynomial");
    assert_eq!(product.truncated("A".into(), 10), polynomial("1"));
}

#[test]
fn cubic_pendulum_is_the_papers_model() {
    let solution = derive("x'' + x - x^3/6 = 0", 6, None);
    assert_eq!(law_squared(&solution).truncated("A".into(), 4), polynomial("1 - A^2/8 - A^4/1536"));
    assert_eq!(*law(&solution), polynomial("1 - A^2/16 - 7*A^4/3072 - 3*A^6/16384"));
}

#[test]
fn quadratic_force_by_either_convention() {
    let initial = derive("x'' + x + eps*x^2 = 0", 3, INITIAL);
    assert_eq!(*law(&initial), polynomial("1 - 5*eps^2*A^2/12 - 5*eps^3*A^3/18"));
    // The odd power is the convention's alone.
    let first_harmonic = derive("x'' + x + eps*x^2 = 0", 3, FIRST_HARMONIC);
    assert_eq!(*law(&first_harmonic), polynomial("1 - 5*eps^2*a^2/12"));
}

#[test]
fn van_der_pol_to_order_eight() {
    let solution = derive("x'' - mu*(1 - x^2)*x' + x = 0", 8, INITIAL);
    let expected = "1 - mu^2/16 + 17*mu^4/3072 + 35*mu^6/884736 - 678899*mu^8/5096079360";
    assert_eq!(*law(&solution), polynomial(expected));
    let amplitude = &solution.limit_cycle.as_ref().expect("a limit cycle").amplitude;
    let expected = "2 + mu^2/96 - 1033*mu^4/552960 + 1019689*mu^6/55738368000 + 9835512276689*mu^8/157315969843200000";
    assert_eq!(*amplitude, polynomial(expected));
    // x_1 = (3 sin tau - sin 3 tau)/4, x_2 = (-12 cos tau + 18 cos 3 tau - 5 cos 5 tau)/96.
    let up_to = |polynomial: Polynomial, order| polynomial.truncated("mu".into(), order);
    assert_eq!(up_to(sine(&solution, 1), 1), polynomial("3*mu/4"));
    assert_eq!(up_to(sine(&solution, 3), 1), polynomial("-mu/4"));
    assert_eq!(up_to(cosine(&solution, 1), 2), polynomial("2 - mu^2/8"));
    assert_eq!(up_to(cosine(&solution, 3), 2), polynomial("3*mu^2/16"));
    assert_eq!(up_to(cosine(&solution, 5), 2), polynomial("-5*mu^2/96"));
}

#[test]
fn rayleigh_has_the_frequency_of_van_der_pol() {
    // The derivative of a solution of Rayleigh's equation solves van der Pol's, so the periods
    // agree exactly.
    let van_der_pol = derive("x'' - mu*(1 - x^2)*x' + x = 0", 8, None);
    for rayleigh in ["x'' + x = mu*(1 - x'^2/3)*x'", "x'' + x = mu*(1 - x'^2)*x'"] {
        assert_eq!(law(&derive(rayleigh, 8, None)), law(&van_der_pol), "{rayleigh}");
    }
    let scaled = derive("x'' + x = mu*(1 - x'^2)*x'", 2, None);
    let root = scaled
        .definitions
        .iter()
        .find(|definition| definition.symbol.name() == "a0")
        .expect("an irrational root");
    assert_eq!(root.meaning, parse_expression("sqrt(4/3)").expect("an expression"));
}

#[test]
fn a_symbolic_linear_frequency() {
    let solution = derive("x'' + w0^2*x + g*x^3 = 0", 3, FIRST_HARMONIC);
    let expected = "w0 + 3*g*a^2/(8*w0) - 15*g^2*a^4/(256*w0^3) + 123*g^3*a^6/(8192*w0^5)";
    assert_eq!(*law(&solution), polynomial(expected));
    let solution = derive("x'' + k*x + eps*x^3 = 0", 1, None);
    assert_eq!(*law(&solution), polynomial("omega0 + 3*eps*A^2/(8*omega0)"));
    assert_eq!(solution.definitions[0].meaning.to_string(), "sqrt(k)");
}

#[test]
fn mathews_and_lakshmanan_exactly() {
    // (1 + x^2) x'' - x x'^2 + x = 0 is solved by A cos(omega t), omega^2 = 1/(1 + A^2): P. M.
    // Mathews and M. Lakshmanan, Quart. Appl. Math. 32 (1974) 215.
    let solution = derive("(1 + x^2)*x'' - x*x'^2 + x = 0", 8, None);
    assert_eq!(*law_squared(&solution), polynomial("1 - A^2 + A^4 - A^6 + A^8"));
    assert_eq!(solution.displacement.harmonics().len(), 1);
}

#[test]
fn several_symbols_at_once_agree_with_numbers() {
    let symbolic = derive("x'' + x + eps*(a2*x^2 + a3*x^3 + a5*x^5) = 0", 4, None);
    let numbers = derive("x'' + x + eps*(2*x^2 - x^3/3 + 5*x^5) = 0", 4, None);
    let value = |text: &str| polynomial(text);
    let substituted = [("a2", "2"), ("a3", "-1/3"), ("a5", "5")]
        .iter()
        .try_fold(law(&symbolic).clone(), |law, (name, number)| {
            law.substitute((*name).into(), &value(number))
        });
    assert_eq!(substituted.as_ref(), Some(law(&numbers)));
}

#[test]
fn van_der_pols_period() {
    let solution = derive("x'' - mu*(1 - x^2)*x' + x = 0", 8, None);
    let period = "1 + mu^2/16 - 5*mu^4/3072 - 431*mu^6/884736 + 557039*mu^8/5096079360";
    let product = polynomial(&format!("({period})*({})", law(&solution)));
    assert_eq!(product.truncated("mu".into(), 9), polynomial("1"));
}

#[test]
fn pendulum_by_the_first_harmonic() {
    let solution = derive("x'' + sin(x) = 0", 4, FIRST_HARMONIC);
    assert_eq!(*law(&solution), polynomial("1 - a^2/16 + a^4/1024"));
}

/// The first harmonic of the motion by `A`, put into law and motion by `a`, gives law and motion by
/// `A`: exactly, up to the order kept, even forces included.
#[test]
fn one_convention_converts_into_the_other() {
    for (equation, small, order) in [
        ("x'' + x + eps*x^3 = 0", "eps", 6),
        ("x'' + x + eps*x^2 = 0", "eps", 5),
        ("x'' + k*x + eps*(a2*x^2 + a3*x^3 + a4*x^4) = 0", "eps", 4),
        ("x'' + x*exp(x) = 0", "A", 6),
        ("x'' + sin(x) = 0", "A", 10),
        ("(1 + x^2)*x'' + x*x'^2 + x = 0", "A", 8),
    ] {
        let (initial, other) =
            (derive(equation, order, INITIAL), derive(equation, order, FIRST_HARMONIC));
        // The motion is A times a series to the order kept: one power of A more than the law.
        let (power, leading) = (order as i32, i32::from(small == "A"));
        let first_harmonic = cosine(&initial, 1);
        let converted = |series: &Polynomial, highest: i32| {
            // Powers of the first harmonic, cut off where the answer is.
            let mut power = polynomial("1");
            let mut sum = Polynomial::zero();
            let (_, degree) = series.exponent_range("a".into()).unwrap_or((0, 0));
            for exponent in 0..=degree {
                for (monomial, coefficient) in
                    series.terms().filter(|(m, _)| m.exponent("a".into()) == exponent)
                {
                    let rest = Polynomial::term(monomial.without("a".into()), coefficient.clone());
                    sum = sum + rest.product(&power);
                }
                power = power.product(&first_harmonic).truncated(small.into(), highest);
            }
            sum.truncated(small.into(), highest)
        };
        assert_eq!(converted(law(&other), power), *law(&initial), "{equation}");
        assert_eq!(converted(law_squared(&other), power), *law_squared(&initial), "{equation}");
        assert_eq!(cosine(&other, 1), polynomial("a"), "{equation}");
        let highest = initial.displacement.highest_harmonic();
        assert_eq!(other.displacement.highest_harmonic(), highest, "{equation}");
        for k in 0..=highest {
            let expected = cosine(&initial, k);
            assert_eq!(
                converted(&cosine(&other, k), power + leading),
                expected,
                "{equation}, cos {k} theta"
            );
        }
        assert_eq!(initial.displacement.at_zero().mean().0, polynomial("A"), "{equation}");
        assert!(initial.displacement.is_even() && other.displacement.is_even(), "{equation}");
    }
}

#[test]
fn rayleigh_swings_with_the_amplitudes_known() {
    // First harmonic: 2 and sqrt(4/3) to first order, J. W. Strutt, Phil. Mag. 15 (1883) 229-235.
    let normal = derive("x'' + x = mu*(1 - x'^2/3)*x'", 1, FIRST_HARMONIC);
    assert_eq!(normal.limit_cycle.as_ref().map(|cycle| &cycle.amplitude), Some(&polynomial("2")));
    let bare = derive("x'' + x = mu*(1 - x'^2)*x'", 1, FIRST_HARMONIC);
    let amplitude = &bare.limit_cycle.as_ref().expect("a limit cycle").amplitude;
    let value = bare.evaluate(amplitude, &|_| None).expect("a number");
    assert!((value - (4.0_f64 / 3.0).sqrt()).abs() < 1e-15);
    // The two differ by the unit of length alone, sqrt(3), at every order.
    let (normal, bare) = (
        derive("x'' + x = mu*(1 - x'^2/3)*x'", 6, None),
        derive("x'' + x = mu*(1 - x'^2)*x'", 6, None),
    );
    for k in 0..=normal.displacement.highest_harmonic() {
        for (left, right) in
            [(cosine(&normal, k), cosine(&bare, k)), (sine(&normal, k), sine(&bare, k))]
        {
            let unit = right.substitute("a0".into(), &polynomial("2")).expect("a positive power");
            assert_eq!(left, unit, "harmonic {k}");
        }
    }
}

/// The derivative of Rayleigh's motion is van der Pol's, a quarter period later, harmonic by
/// harmonic.
#[test]
fn rayleighs_velocity_is_van_der_pols_motion() {
    let order = 7;
    let van_der_pol = derive("x'' + x = mu*(1 - x^2)*x'", order, None).displacement;
    let rayleigh = derive("x'' + x = mu*(1 - x'^2/3)*x'", order, None);
    let frequency = FourierSeries::constant(POLYNOMIALS, law(&rayleigh).clone());
    let velocity = rayleigh.displacement.derivative().product(&frequency);
    let truncated =
        |series: FourierSeries<Polynomials>| series.mean().0.truncated("mu".into(), order as i32);
    for k in 0..=van_der_pol.highest_harmonic() {
        // cos k(theta + pi/2) and sin k(theta + pi/2) in terms of those of k theta.
        let (cosine_sign, sine_sign, swapped) =
            [(1, 1, false), (1, -1, true), (-1, -1, false), (-1, 1, true)][k % 4];
        let (of_cosine, of_sine) = match swapped {
            false => (van_der_pol.cosine(k), van_der_pol.sine(k)),
            true => (van_der_pol.sine(k), van_der_pol.cosine(k)),
        };
        assert_eq!(
            truncated(velocity.cosine(k)),
            truncated(of_cosine.times(cosine_sign)),
            "cos {k} theta"
        );
        assert_eq!(
            truncated(velocity.sine(k)),
            truncated(of_sine.times(sine_sign)),
            "sin {k} theta"
        );
    }
}

/// `c_n^2` of `K(m) = (pi/2) sum c_n^2 m^n`, `c_n = (2 n)! / (2^n n!)^2`.
fn elliptic_coefficient(n: usize) -> Rational {
    let root = factorial(2 * n as u32);
    let half = Integer::from(2).pow(n as u32) * factorial(n as u32);
    let coefficient = Rational::new(root, half.pow(2_u32));
    &coefficient * &coefficient
}

/// The first coefficients of the product of two power series of equal length.
fn product(left: &[Rational], right: &[Rational]) -> Vec<Rational> {
    let entry = |n: usize| (0..=n).map(|k| &left[k] * &right[n - k]).sum();
    (0..left.len()).map(entry).collect()
}

/// `sum_n weight(n) inner^n`, where `inner` begins with its linear term.
fn composed(weight: impl Fn(usize) -> Rational, inner: &[Rational]) -> Vec<Rational> {
    let mut power = vec![Rational::zero(); inner.len()];
    power[0] = Rational::one();
    let mut sum = vec![Rational::zero(); inner.len()];
    for n in 0..inner.len() {
        for (entry, term) in sum.iter_mut().zip(&power) {
            *entry += weight(n) * term;
        }
        power = product(&power, inner);
    }
    sum
}

/// The frequency law of `equation` times the series of T/(2 pi) in `unit` is one, to as many terms
/// as `period` has.
fn assert_inverse_of_period(equation: &str, order: u32, unit: &str, period: &[Rational]) {
    let solution = derive(equation, order, INITIAL);
    let unit = polynomial(unit);
    let (monomial, _) = unit.single_term().expect("one term");
    let coefficient = |n: usize| law(&solution).coefficient(&monomial.power(n as i32));
    let frequency: Vec<Rational> = (0..period.len()).map(coefficient).collect();
    // Nothing else occurs in the law.
    let terms = frequency.iter().filter(|coefficient| !coefficient.is_zero()).count();
    assert_eq!(law(&solution).terms().len(), terms, "{equation}");
    let found = product(&frequency, period);
    for (n, coefficient) in found.iter().enumerate() {
        let expected = if n == 0 { ratio(1, 1) } else { ratio(0, 1) };
        assert_eq!(*coefficient, expected, "{equation}: term {n} of frequency times period");
    }
}

#[test]
fn periods_by_elliptic_integrals_to_any_order() {
    const TERMS: usize = 16;
    let highest = TERMS as u32 - 1;
    // Pendulum: T/(2 pi) = (2/pi) K(sin^2(A/2)), in powers of A^2; sin^2(A/2) = (1 - cos A)/2.
    let half_angle = |k: usize| match k {
        0 => Rational::zero(),
        _ => Rational::new(
            (if k % 2 == 1 { 1 } else { -1 }).into(),
            factorial(2 * k as u32) * Integer::from(2),
        ),
    };
    let modulus: Vec<Rational> = (0..TERMS).map(half_angle).collect();
    let period = composed(elliptic_coefficient, &modulus);
    assert_eq!(period[..3], [ratio(1, 1), ratio(1, 16), ratio(11, 3072)]);
    assert_inverse_of_period("x'' + sin(x) = 0", 2 * highest, "A^2", &period);

    // Duffing: T/(2 pi) = (2/pi) K(m) / sqrt(1 + s), m = (s/2)/(1 + s), s = eps A^2.
    let sign = |k: usize| 1 - 2 * (k % 2) as i64;
    let modulus: Vec<Rational> =
        (0..TERMS).map(|k| if k == 0 { Rational::zero() } else { ratio(-sign(k), 2) }).collect();
    // Binomial series of (1 + s)^(-1/2): its coefficients are +-c_k.
    let binomial = |k: usize| {
        let (top, bottom) =
            (factorial(2 * k as u32), Integer::from(2).pow(k as u32) * factorial(k as u32));
        Rational::new(top * Integer::from(sign(k)), bottom.pow(2_u32))
    };
    let root: Vec<Rational> = (0..TERMS).map(binomial).collect();
    let period = product(&composed(elliptic_coefficient, &modulus), &root);
    assert_eq!(period[..2], [ratio(1, 1), ratio(-3, 8)]);
    assert_inverse_of_period("x'' + x + eps*x^3 = 0", highest, "eps*A^2", &period);
    assert_inverse_of_period("x'' + x + x^3 = 0", 2 * highest, "A^2", &period);

    // A bead of this inertia keeps (1 + x^2) x'^2 + x^2 = A^2: T/(2 pi) = (2/pi) E(-A^2) with
    // E(m) = (pi/2) sum c_n^2 m^n/(1 - 2 n).
    let bead = |n: usize| elliptic_coefficient(n) * ratio(sign(n), 1 - 2 * n as i64);
    let period: Vec<Rational> = (0..TERMS).map(bead).collect();
    assert_eq!(period[..3], [ratio(1, 1), ratio(1, 4), ratio(-3, 64)]);
    assert_inverse_of_period("(1 + x^2)*x'' + x*x'^2 + x = 0", 2 * highest, "A^2", &period);
}

fn judged(equation: &str, solution: &Solution, at: &[(&str, &str)]) -> Verification {
    let oscillator = Oscillator::parse(equation).expect("an oscillator");
    let mut values = Values::default();
    for (name, value) in at {
        values
            .insert((*name).into(), parse_expression(value).expect("an expression"))
            .expect("a number");
    }
    verify::judge(&oscillator, solution, &values, verify::DEFAULT_TOLERANCE).expect("a verdict")
}

fn elliptic_k(m: f64) -> f64 {
    ellip::ellipk(m).expect("an elliptic integral")
}

/// Equation, value of eps, exact frequency at an amplitude, and pairs of an order and the exponent
/// of its error.
type Row = (&'static str, &'static str, fn(f64) -> f64, &'static [(u32, f64)]);

/// The frequency of the true motion comes out of the judge as the elliptic integral has it, and the
/// error of the series vanishes with the exponent of its first missing term.
#[test]
fn the_judge_measures_the_first_missing_term() {
    let duffing: fn(f64) -> f64 =
        |a| PI * (1.0 + a * a).sqrt() / (2.0 * elliptic_k(a * a / (2.0 * (1.0 + a * a))));
    let softening: fn(f64) -> f64 =
        |a| PI * (1.0 - a * a).sqrt() / (2.0 * elliptic_k(-a * a / (2.0 * (1.0 - a * a))));
    let pendulum: fn(f64) -> f64 = |a| PI / (2.0 * elliptic_k((0.5 * a).sin().powi(2)));
    let bead: fn(f64) -> f64 =
        |a| PI / (2.0 * ellip::ellipe(-a * a).expect("an elliptic integral"));
    let rows: [Row; 5] = [
        // An order of eps and the exponent in eps; odd orders in A add nothing.
        ("x'' + x + eps*x^3 = 0", "1", duffing, &[(1, 2.0), (2, 3.0), (3, 4.0), (4, 5.0)]),
        ("x'' + x + x^3 = 0", "", duffing, &[(2, 4.0), (3, 4.0), (4, 6.0)]),
        ("x'' + x + eps*x^3 = 0", "-1", softening, &[(1, 2.0), (3, 4.0)]),
        ("x'' + sin(x) = 0", "", pendulum, &[(2, 4.0), (4, 6.0), (5, 6.0)]),
        ("(1 + x^2)*x'' + x*x'^2 + x = 0", "", bead, &[(2, 4.0), (4, 6.0)]),
    ];
    for (equation, eps, exact, orders) in rows {
        for &(order, exponent) in orders {
            let solution = derive(equation, order, INITIAL);
            let at = |amplitude: &'static str| {
                let mut at = vec![("A", amplitude)];
                at.extend((!eps.is_empty()).then_some(("eps", eps)));
                judged(equation, &solution, &at)
            };
            let (whole, half) = (at("2/5"), at("1/5"));
            for (amplitude, verdict) in [(0.4, &whole), (0.2, &half)] {
                let error = verdict.true_frequency / exact(amplitude) - 1.0;
                assert!(
                    error.abs() < 1e-10,
                    "{equation} at {amplitude}: true frequency off by {error:e}"
                );
                assert_eq!(
                    verdict.verdict,
                    verify::Verdict::Pass,
                    "{equation}, order {order}, at {amplitude}"
                );
            }
            // Halving A is halving sqrt(eps): the same error falls with twice the exponent there.
            let per_halving = if eps.is_empty() { exponent } else { 2.0 * exponent };
            let error =
                |verdict: &Verification| verdict.relative_error.expect("a real frequency").abs();
            let measured = (error(&whole) / error(&half)).log2();
            assert!(
                (measured - per_halving).abs() < 0.35,
                "{equation}, order {order}: exponent {measured}"
            );
            let slope = whole.slope.expect("an error above rounding");
            assert!((slope - exponent).abs() < 0.1, "{equation}, order {order}: slope {slope}");
        }
    }
}

/// omega^2 = 1 - A^2/8 against the pendulum at finite amplitude, and a series beyond its radius of
/// convergence.
#[test]
fn verdicts_at_finite_amplitude() {
    // Amplitude, true frequency, error in per cent as printed, half a unit of its last digit.
    for (amplitude, frequency, percent, digit) in [
        ("1", 0.937_792_258_051_428, -0.25, 0.005),
        ("3/2", 0.860_608_346_679_613, -1.49, 0.005),
        ("2", 0.752_499_548_450_521, -6.0, 0.05),
        ("5/2", 0.608_649_247_214_08, -23.0, 0.5),
    ] {
        let equation = "x'' + sin(x) = 0";
        let verdict = judged(equation, &derive(equation, 2, INITIAL), &[("A", amplitude)]);
        assert!((verdict.true_frequency / frequency - 1.0).abs() < 1e-12, "A = {amplitude}");
        let found = 100.0 * verdict.relative_error.expect("a real frequency");
        assert!((found - percent).abs() <= digit, "A = {amplitude}: {found} %");
        assert_eq!(verdict.verdict == verify::Verdict::Pass, percent > -1.0, "A = {amplitude}");
    }
    // Duffing at s = 2: the series for omega alternates about the truth and comes no closer.
    let equation = "x'' + x + eps*x^3 = 0";
    for (order, percent) in [(1, 11.5), (2, -9.4), (3, 10.8)] {
        let solution = derive(equation, order, INITIAL);
        let verdict = judged(equation, &solution, &[("A", "1"), ("eps", "2")]);
        assert!((verdict.true_frequency / 1.569_105_802_869_32 - 1.0).abs() < 1e-12);
        let value = |symbol: Symbol| Some(if symbol.name() == "eps" { 2.0 } else { 1.0 });
        let series = solution.evaluate(law(&solution), &value).expect("a number");
        let found = 100.0 * (series / verdict.true_frequency - 1.0);
        assert!((found - percent).abs() <= 0.05, "order {order}: {found} %");
        // The verdict is on the root of omega^2.
        let squared = solution.evaluate(law_squared(&solution), &value).expect("a number");
        let frequency = verdict.frequency.expect("a real frequency");
        assert!((frequency / squared.sqrt() - 1.0).abs() < 1e-15);
    }
    // Beyond sqrt 8 the formula has no frequency left, and that is a failure.
    let cubic = derive("x'' + sin(x) = 0", 2, INITIAL);
    let verdict = judged("x'' + sin(x) = 0", &cubic, &[("A", "2.9")]);
    assert_eq!((verdict.frequency, verdict.verdict), (None, verify::Verdict::Fail));
}

/// Limit cycles against Runge-Kutta: the error vanishes with the next even power of mu.
#[test]
fn limit_cycles_against_runge_kutta() {
    for equation in [
        "x'' - mu*(1 - x^2)*x' + x = 0",
        "x'' + x = mu*(1 - x'^2/3)*x'",
        "x'' + x = mu*(1 - x'^2)*x'",
    ] {
        for (order, exponent) in [(2, 4.0), (4, 6.0)] {
            let solution = derive(equation, order, None);
            let verdict = judged(equation, &solution, &[("mu", "1/2")]);
            assert_eq!(verdict.verdict, verify::Verdict::Pass, "{equation}");
            let slope = verdict.slope.expect("an error above rounding");
            assert!((slope - exponent).abs() < 0.2, "{equation}, order {order}: slope {slope}");
            let deviation = verdict.max_deviation.expect("a motion");
            assert!(
                deviation < 2.0 * 0.5_f64.powi(order as i32 + 1),
                "{equation}, order {order}: {deviation}"
            );
        }
    }
}

#[test]
fn what_does_not_apply_is_refused_by_name() {
    let refused = |equation: &str, options: &Options| {
        let oscillator = Oscillator::parse(equation).expect("an oscillator");
        solve(&oscillator, options).expect_err(equation)
    };
    let options = |order: Option<u32>, small: Option<&str>| Options {
        method: Some(Method::LindstedtPoincare),
        order,
        small: small.map(str::to_owned),
        ..Options::default()
    };
    let default = options(None, None);

    for (equation, name) in [
        ("x'' + 2*zeta*x' + sin(x) = 0", "`2*zeta*x'`"),
        ("x'' + x + c*x'^3 = 0", "`c*x'^3`"),
        ("x'' + x + eps*(x^3 + 3*x'^3) = 0", "`3*x'^3`"),
        ("x'' + k*x + c*x^2*x' + eps*x^3 = 0", "`c*x^2*x'`"),
    ] {
        let refusal = refused(equation, &default);
        assert!(
            matches!(refusal, Refusal { reason: Reason::Damping { .. }, .. }),
            "{equation}: {refusal:?}"
        );
        assert!(refusal.to_string().contains(name), "{equation}: {refusal}");
        assert!(refusal.help().is_some(), "{equation}");
    }
    for (equation, name) in [
        ("x'' + x + eps*x^3 = F*cos(2*t)", "F*cos(2*t)`"),
        ("x'' + (1 + q*cos(2*t))*x = 0", "`(1 + q*cos(2*t))*x`"),
        ("x'' + x + t = 0", "`t`"),
    ] {
        let refusal = refused(equation, &default);
        assert!(
            matches!(refusal, Refusal { reason: Reason::Forcing, .. }),
            "{equation}: {refusal:?}"
        );
        assert!(refusal.to_string().contains(name), "{equation}: {refusal}");
        assert!(refusal.help().is_some(), "{equation}");
    }
    for (equation, name) in [
        ("x'' + x + x*abs(x) = 0", "`abs(x)`"),
        ("x'' + x + eps*tan(x) = 0", "`eps*tan(x)`"),
        ("x'' + sgn(x) = 0", "`sgn(x)`"),
        ("x'' + x^(1/3) = 0", "`x^(1/3)`"),
        ("x'' + 2*x + sqrt(x^2) = 0", "`sqrt(x^2)`"),
        ("x'' + x + max(x, 0) = 0", "`max(x, 0)`"),
    ] {
        let refusal = refused(equation, &default);
        assert!(refusal.to_string().contains(name), "{equation}: {refusal}");
    }
    for (equation, names) in [
        ("x'' + x + alpha*beta^2*x^3 = 0", ["alpha", "beta"]),
        ("x'' + x = (p*q + p^2*q^3)*(1 - x^2)*x'", ["p", "q"]),
    ] {
        let refusal = refused(equation, &default);
        let expected = OscillatorError::AmbiguousSmallParameter(names.map(Symbol::new).to_vec());
        assert_eq!(refusal.reason, Reason::Oscillator(expected), "{equation}");
        assert!(names.iter().all(|name| refusal.to_string().contains(name)), "{refusal}");
        assert!(
            refusal.help().is_some_and(|help| help.to_string().contains(names[0])),
            "{equation}"
        );
        // Naming one resolves it.
        let oscillator = Oscillator::parse(equation).expect("an oscillator");
        let solution = solve(&oscillator, &options(Some(1), Some(names[0]))).expect(equation);
        assert_eq!(solution.small_parameter, Symbol::new(names[0]));
    }
    // Of two that stand together everywhere either gives the same.
    for (equation, chosen, names) in [
        ("x'' + x + alpha*beta*x^3 = 0", "alpha", ["alpha", "beta"]),
        ("x'' + x + k*mu*x^3 = 0", "mu", ["k", "mu"]),
        ("x'' + x = p*q*(1 - x^2)*x'", "p", ["p", "q"]),
    ] {
        let oscillator = Oscillator::parse(equation).expect("an oscillator");
        let own = solve(&oscillator, &default).expect(equation);
        assert_eq!(own.small_parameter, Symbol::new(chosen));
        for name in names {
            let other = solve(&oscillator, &options(None, Some(name))).expect(equation);
            assert_eq!(other.law, own.law, "{equation}");
            assert_eq!(other.displacement, own.displacement, "{equation}");
        }
    }
    for asked in [401, u32::MAX] {
        for equation in ["x'' + x + eps*x^3 = 0", "x'' + sin(x) = 0"] {
            let refusal = refused(equation, &options(Some(asked), None));
            assert_eq!(refusal.reason, Reason::Order { asked, limit: 400 }, "{equation}");
            assert!(refusal.to_string().contains(&asked.to_string()), "{refusal}");
        }
    }
    let refusal = refused("x'' + x + eps*x^3 = 0", &options(None, Some("delta")));
    assert!(refusal.to_string().contains("`delta`"), "{refusal}");
    let refusal = refused("x'' + x + x^3 + eps*x^5 = 0", &default);
    assert!(refusal.to_string().contains("`x^3`"), "{refusal}");
    let refusal = refused("x'' + x = (1 - x^2)*x'", &options(None, Some("A")));
    assert!(matches!(refusal.reason, Reason::AmplitudeNotFree), "{refusal:?}");
    let refusal = refused("x'' + x^3 = 0", &default);
    assert!(
        matches!(refusal.reason, Reason::Oscillator(OscillatorError::NoRestoringForce(_))),
        "{refusal:?}"
    );
}

/// With `omega0^2 = g/L` the pendulum's terms are powers of it, and those of a bead on a parabola
/// have no `g`; where every parameter of the linear force stands elsewhere as well, all terms stay
/// as they were typed. Either way the numbers are those of the same equation without names.
#[test]
fn terms_that_are_powers_of_the_linear_frequency_are_written_so() {
    for (equation, values, expected) in [
        (
            "x'' + (g/L)*sin(x) = 0",
            vec![("g", 2.0), ("L", 8.0)],
            "omega0^2 - omega0^2*A^2/8 + 7*omega0^2*A^4/1536",
        ),
        (
            "x'' + 2*k*x + 4*k^2*x^3 = 0",
            vec![("k", 0.125)],
            "omega0^2 + 3*omega0^4*A^2/4 - 3*omega0^6*A^4/128",
        ),
        (
            "x'' + k*x/m + b*x^3/m = 0",
            vec![("k", 2.0), ("m", 8.0), ("b", 0.5)],
            "omega0^2 + 3*b*A^2/(4*m) - 3*b^2*A^4/(128*m^2*omega0^2)",
        ),
        (
            "(1 + 4*p^2*x^2)*x'' + 4*p^2*x*x'^2 + 2*g*p*x = 0",
            vec![("p", 0.25), ("g", 0.5)],
            "omega0^2 - 2*omega0^2*p^2*A^2 + 9*omega0^2*p^4*A^4/2",
        ),
    ] {
        let options = Options { order: Some(4), small: Some("A".to_owned()), ..Options::default() };
        let solution =
            solve(&Oscillator::parse(equation).expect(equation), &options).expect(equation);
        assert_eq!(*law_squared(&solution), polynomial(expected), "{equation}");
        let mut numbers = equation.to_owned();
        for (name, value) in &values {
            numbers = numbers.replace(name, &format!("({value})"));
        }
        let plain = solve(&Oscillator::parse(&numbers).expect(&numbers), &options).expect(&numbers);
        let value_of = |name: Symbol| match name.name() {
            "A" => Some(0.3),
            "omega0" => Some(0.5),
            name => values.iter().find(|(own, _)| *own == name).map(|(_, value)| *value),
        };
        let [found, plain] =
            [&solution, &plain].map(|own| law_squared(own).evaluate(value_of).expect("a number"));
        assert!((found / plain - 1.0).abs() < 1e-14, "{equation}: {found} {plain}");
    }
}
