//! Derived series against published ones.
//!
//! - Duffing: A. H. Nayfeh, D. T. Mook, *Nonlinear Oscillations*, Wiley 1979, chapter 2, and the expansion of the exact
//!   frequency pi sqrt(1 + s) / (2 K(s/(2 + 2 s))).
//! - Pendulum: the expansion of pi / (2 K(sin^2(A/2))).
//! - Van der Pol: C. M. Andersen, J. F. Geer, SIAM J. Appl. Math. 42 (1982) 678-693.

use lindstedt::exact::{Polynomial, Rational};
use lindstedt::expr::parse_expression;
use lindstedt::method::{Options, solve};
use lindstedt::solution::{AmplitudeConvention, Solution};
use lindstedt::{Oscillator, Symbol};

fn derive(equation: &str, order: u32, amplitude: Option<AmplitudeConvention>) -> Solution {
    let oscillator = Oscillator::parse(equation).expect("an oscillator");
    solve(
        &oscillator,
        &Options {
            order: Some(order),
            amplitude,
            ..Options::default()
        },
    )
    .expect("a solution")
}

fn polynomial(text: &str) -> Polynomial {
    let expression = parse_expression(text).expect("an expression");
    expression
        .to_polynomial(&mut |_| None)
        .expect("short")
        .expect("a polynomial")
}

fn law(solution: &Solution) -> &Polynomial {
    solution.frequency.as_ref().expect("a polynomial law")
}

fn law_squared(solution: &Solution) -> &Polynomial {
    solution.frequency_squared.as_ref().expect("a polynomial law")
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
    // Coefficients of cos k theta in u_1 ... u_5 at A = 1, over the denominators 32, 1024, 32768, 2^20, 2^25.
    let orders: [(i64, &[(usize, i64)]); 5] = [
        (32, &[(3, 1), (1, -1)]),
        (1024, &[(5, 1), (3, -24), (1, 23)]),
        (32_768, &[(7, 1), (5, -48), (3, 594), (1, -547)]),
        (1_048_576, &[(9, 1), (7, -72), (5, 1766), (3, -15_121), (1, 13_426)]),
        (
            33_554_432,
            &[(11, 1), (9, -96), (7, 3514), (5, -58_944), (3, 394_701), (1, -339_176)],
        ),
    ];
    for (index, (denominator, coefficients)) in orders.iter().enumerate() {
        let order = index as i32 + 1;
        for k in 0..=13 {
            let expected = coefficients
                .iter()
                .find(|entry| entry.0 == k)
                .map_or(0, |entry| entry.1);
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
    // a = A (1 - s/32 + ...) is the first harmonic of the motion by A; put into the law by a it gives the law by A.
    let (eps, a) = (Symbol::new("eps"), Symbol::new("a"));
    let initial = derive(equation, 3, INITIAL);
    let first_harmonic = cosine(&initial, 1);
    assert_eq!(
        first_harmonic,
        polynomial("A - eps*A^3/32 + 23*eps^2*A^5/1024 - 547*eps^3*A^7/32768")
    );
    let converted = law(&by_first_harmonic)
        .substitute(a, &first_harmonic)
        .expect("positive powers");
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
    let product = parse_expression(&format!("({period})*({})", law(&solution))).expect("an expression");
    let product = product
        .to_polynomial(&mut |_| None)
        .expect("short")
        .expect("a polynomial");
    assert_eq!(product.truncated("A".into(), 10), polynomial("1"));
}

#[test]
fn cubic_pendulum_is_the_papers_model() {
    let solution = derive("x'' + x - x^3/6 = 0", 6, None);
    assert_eq!(
        law_squared(&solution).truncated("A".into(), 4),
        polynomial("1 - A^2/8 - A^4/1536")
    );
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
    let amplitude = solution.limit_cycle.as_ref().expect("a limit cycle");
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
    // The derivative of a solution of Rayleigh's equation solves van der Pol's, so the periods agree exactly.
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
    // (1 + x^2) x'' - x x'^2 + x = 0 is solved by A cos(omega t), omega^2 = 1/(1 + A^2): P. M. Mathews and
    // M. Lakshmanan, Quart. Appl. Math. 32 (1974) 215.
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
