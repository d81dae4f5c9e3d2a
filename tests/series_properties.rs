//! Laws that hold for every series: the ring, the product rule, the equation that is solved, and Taylor's theorem.

use lindstedt::exact::rational::ratio;
use lindstedt::exact::{Integer, Polynomial, Rational};
use lindstedt::expr::{Expr, parse_expression};
use lindstedt::series::FourierSeries;
use lindstedt::series::fourier::fraction;
use lindstedt::series::taylor::taylor;
use num_traits::{One, Zero};
use proptest::prelude::*;

/// Numerators of cosines and sines, and a denominator.
fn parts() -> impl Strategy<Value = (Vec<i64>, Vec<i64>, i64)> {
    let numerators = || prop::collection::vec(-20_i64..=20, 0..5);
    (numerators(), numerators(), 1_i64..=12)
}

fn whole((cosine, sine, denominator): &(Vec<i64>, Vec<i64>, i64)) -> FourierSeries<Integer> {
    let integers = |list: &[i64]| list.iter().map(|&value| Integer::from(value)).collect();
    FourierSeries::from_parts(integers(cosine), integers(sine), (*denominator).into())
}

fn fractions(series: &FourierSeries<Integer>) -> FourierSeries<Rational> {
    series.map(fraction)
}

fn series() -> impl Strategy<Value = FourierSeries<Integer>> {
    parts().prop_map(|parts| whole(&parts))
}

fn polynomial() -> impl Strategy<Value = Polynomial> {
    prop::collection::vec((-9_i64..=9, 1_i64..=4, -2_i32..=3, -2_i32..=3), 0..5).prop_map(|terms| {
        terms.into_iter().fold(Polynomial::zero(), |sum, (p, q, a, k)| {
            use lindstedt::exact::polynomial::Monomial;
            let monomial = Monomial::power_of("A".into(), a).product(&Monomial::power_of("k".into(), k));
            sum + Polynomial::term(monomial, ratio(p, q))
        })
    })
}

proptest! {
    #[test]
    fn polynomials_form_a_ring(a in polynomial(), b in polynomial(), c in polynomial()) {
        use lindstedt::exact::Ring;
        prop_assert_eq!(a.product(&b), b.product(&a));
        prop_assert_eq!(a.product(&b).product(&c), a.product(&b.product(&c)));
        prop_assert_eq!(a.product(&(b.clone() + c.clone())), a.product(&b) + a.product(&c));
        prop_assert_eq!(a.product(&Polynomial::constant(Rational::one())), a.clone());
        // Text and back.
        let read = parse_expression(&a.to_string()).expect("printed text").to_polynomial(&mut |_| None);
        prop_assert_eq!(read.expect("short"), Some(a));
    }

    #[test]
    fn fourier_series_form_a_ring(a in series(), b in series(), c in series()) {
        prop_assert_eq!(a.product(&b), b.product(&a));
        prop_assert_eq!(a.product(&b).product(&c), a.product(&b.product(&c)));
        prop_assert_eq!(a.product(&b.sum(&c)), a.product(&b).sum(&a.product(&c)));
        prop_assert_eq!(a.difference(&a), FourierSeries::zero());
        prop_assert_eq!(a.product(&FourierSeries::integer(1)), a);
    }

    #[test]
    fn one_denominator_or_a_field_give_the_same(a in series(), b in series()) {
        prop_assert_eq!(fractions(&a.product(&b)), fractions(&a).product(&fractions(&b)));
        prop_assert_eq!(fractions(&a.sum(&b)), fractions(&a).sum(&fractions(&b)));
        prop_assert_eq!(fractions(&a.solve_oscillator().0), fractions(&a).solve_oscillator().0);
    }

    #[test]
    fn the_product_rule(a in series(), b in series()) {
        let rule = a.derivative().product(&b).sum(&a.product(&b.derivative()));
        prop_assert_eq!(a.product(&b).derivative(), rule);
    }

    #[test]
    fn the_oscillator_is_solved_but_for_its_resonance(right_side in series()) {
        let (solution, resonance) = right_side.solve_oscillator();
        let left = solution.derivative().derivative().sum(&solution);
        let resonant = resonance.cosine.product(&FourierSeries::cos(1)).sum(&resonance.sine.product(&FourierSeries::sin(1)));
        prop_assert_eq!(left.sum(&resonant), right_side);
        prop_assert!(solution.cosine(1).is_zero() && solution.sine(1).is_zero());
    }

    #[test]
    fn values_multiply(a in parts(), b in parts(), theta in -4.0_f64..4.0) {
        let float = |series: &FourierSeries<Integer>| series.map(|n, d| lindstedt::exact::rational::to_f64(&fraction(n, d)));
        let (a, b) = (whole(&a), whole(&b));
        let product = float(&a.product(&b)).evaluate(theta);
        let factors = float(&a).evaluate(theta) * float(&b).evaluate(theta);
        prop_assert!((product - factors).abs() <= 1e-9 * (1.0 + factors.abs()));
    }

    #[test]
    fn taylors_theorem_in_one_variable(which in 0..FUNCTIONS.len(), p in -7_i64..=7, q in 8_i64..=11) {
        // The k-th coefficient is the k-th derivative over k!, for every function of the grammar at every point.
        let point = ratio(p, q);
        let function = parse_expression(FUNCTIONS[which]).expect("an expression");
        let Ok(parts) = taylor(&function, &[("x".into(), point.clone())], 4) else {
            // Only at a corner is there no series.
            prop_assert!(p == 0, "{} at {point}", FUNCTIONS[which]);
            return Ok(());
        };
        let at = [("x".into(), lindstedt::exact::rational::to_f64(&point))].into();
        let (mut derivative, mut factorial) = (function, 1.0);
        for (k, part) in parts.iter().enumerate() {
            let coefficient = part.evaluate(&[("x".into(), 1.0)].into()).expect("a number");
            let expected = derivative.evaluate(&at).expect("a number") / factorial;
            prop_assert!((coefficient - expected).abs() <= 1e-9 * (1.0 + expected.abs()), "{} at {point}: {k}", FUNCTIONS[which]);
            derivative = derivative.differentiate("x".into()).expect("a derivative");
            factorial *= (k + 1) as f64;
        }
    }
}

/// Every function of the grammar, inside its domain for |x| < 1.
const FUNCTIONS: [&str; 19] = [
    "sin(x + k*0)",
    "cos(x)",
    "tan(x)",
    "sinh(x)",
    "cosh(x)",
    "tanh(2*x)",
    "asin(x/2)",
    "acos(x/2)",
    "atan(x)",
    "exp(sin(x))",
    "log(2 + x)",
    "sqrt(2 + x)",
    "abs(x)",
    "sgn(x)",
    "max(x, -x)",
    "min(x, x^2 - 2)",
    "H(x)",
    "(2 + x)^(3/2)/(1 + x^2)",
    "2^x",
];

#[test]
fn several_variables_at_once() {
    // exp(x) cos(v) about (0, 0): the part of degree three is x^3/6 - x v^2/2.
    let function = parse_expression("exp(x)*cos(x')").expect("an expression");
    let point = [("x".into(), Rational::zero()), ("x'".into(), Rational::zero())];
    let parts = taylor(&function, &point, 3).expect("analytic");
    assert_eq!(parts[3], parse_expression("x^3/6 - x*x'^2/2").expect("an expression"));
}

#[test]
fn symbolic_coefficients_stay_exact() {
    let function = parse_expression("sqrt(k + x)").expect("an expression");
    let parts = taylor(&function, &[("x".into(), Rational::zero())], 2).expect("analytic");
    let expected = ["sqrt(k)", "x/(2*sqrt(k))", "-x^2/(8*k^(3/2))"];
    for (part, expected) in parts.iter().zip(expected) {
        assert_eq!(*part, parse_expression(expected).expect("an expression"));
    }
    let half = taylor(
        &parse_expression("sin(x)").expect("sine"),
        &[("x".into(), ratio(1, 2))],
        1,
    )
    .expect("analytic");
    assert_eq!(half[0], Expr::sin(&Expr::number(ratio(1, 2))).expect("a sine"));
}

#[test]
fn corners_and_branch_points_are_refused() {
    for text in [
        "abs(x)",
        "sgn(x)",
        "H(x)",
        "sqrt(x)",
        "x^(1/3)",
        "x*abs(x)",
        "sqrt(x^2)",
        "log(x)",
        "1/x",
        "max(x, -x)",
        "asin(1 + x)",
    ] {
        let function = parse_expression(text).expect("an expression");
        let error = taylor(&function, &[("x".into(), Rational::zero())], 3).expect_err(text);
        assert!(error.to_string().contains("x = 0") || text == "1/x", "{text}: {error}");
    }
    // These look like branch points and are none.
    for (text, expected) in [
        ("sqrt(x^4)", "x^2"),
        ("(x^3)^(1/3)", "x"),
        ("(x^2)^(3/2)*(x^2)^(1/2)", "x^4"),
    ] {
        let function = parse_expression(text).expect("an expression");
        let parts = taylor(&function, &[("x".into(), Rational::zero())], 4).expect(text);
        assert_eq!(
            Expr::sum(parts),
            parse_expression(expected).expect("an expression"),
            "{text}"
        );
    }
}
