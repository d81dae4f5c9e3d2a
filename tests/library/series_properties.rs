//! Laws that hold for every series: the ring, the product rule, the equation that is solved, and
//! Taylor's theorem.

use std::collections::{BTreeMap, BTreeSet};

use lindstedt::Symbol;
use lindstedt::exact::Monomial;
use lindstedt::exact::{
    Doubles, Integer, Integers, POLYNOMIALS, Polynomial, Polynomials, Rational, Rationals,
};
use lindstedt::exact::{ratio, to_f64};
use lindstedt::expr::{Expr, Function, Node, parse_expression};
use lindstedt::series::Convolutions;
use lindstedt::series::FourierSeries;
use lindstedt::series::fraction;
use lindstedt::series::taylor;
use num_traits::{One, Zero};
use proptest::prelude::*;

/// Numerators of cosines and sines, and a denominator.
fn parts() -> impl Strategy<Value = (Vec<i64>, Vec<i64>, i64)> {
    let numerators = || prop::collection::vec(-20_i64..=20, 0..5);
    (numerators(), numerators(), 1_i64..=12)
}

fn whole((cosine, sine, denominator): &(Vec<i64>, Vec<i64>, i64)) -> FourierSeries<Integers> {
    let integers = |list: &[i64]| list.iter().map(|&value| Integer::from(value)).collect();
    FourierSeries::from_parts(Integers, integers(cosine), integers(sine)).divided_by(*denominator)
}

fn fractions(series: &FourierSeries<Integers>) -> FourierSeries<Rationals> {
    series.map(Rationals, fraction)
}

fn series() -> impl Strategy<Value = FourierSeries<Integers>> {
    parts().prop_map(|parts| whole(&parts))
}

fn polynomial() -> impl Strategy<Value = Polynomial> {
    prop::collection::vec((-9_i64..=9, 1_i64..=4, -2_i32..=3, -2_i32..=3), 0..5).prop_map(|terms| {
        terms.into_iter().fold(Polynomial::zero(), |sum, (p, q, a, k)| {
            let monomial =
                Monomial::power_of("A".into(), a).product(&Monomial::power_of("k".into(), k));
            sum + Polynomial::term(monomial, ratio(p, q))
        })
    })
}

/// Series with whole polynomials in `A` and `k` over one denominator.
fn symbolic_series() -> impl Strategy<Value = FourierSeries<Polynomials<Integers>>> {
    let numerator = || {
        prop::collection::vec((-9_i64..=9, 0_i32..=2, -1_i32..=2), 0..3).prop_map(|terms| {
            let term = |(c, a, k): (i64, i32, i32)| {
                let monomial =
                    Monomial::power_of("A".into(), a).product(&Monomial::power_of("k".into(), k));
                Polynomial::term(monomial, Integer::from(c))
            };
            terms.into_iter().map(term).fold(Polynomial::zero(), |sum, term| sum + term)
        })
    };
    let numerators = move || prop::collection::vec(numerator(), 0..4);
    let parts = (numerators(), numerators(), 1_i64..=12);
    parts.prop_map(|(cosine, sine, denominator)| {
        FourierSeries::from_parts(Polynomials(Integers), cosine, sine).divided_by(denominator)
    })
}

proptest! {
    #[test]
    fn polynomials_form_a_ring(a in polynomial(), b in polynomial(), c in polynomial()) {
        prop_assert_eq!(a.product(&b), b.product(&a));
        prop_assert_eq!(a.product(&b).product(&c), a.product(&b.product(&c)));
        prop_assert_eq!(a.product(&(b.clone() + c.clone())), a.product(&b) + a.product(&c));
        prop_assert_eq!(a.product(&Polynomial::constant(Rational::one())), a.clone());
        // Text and back.
        let read = parse_expression(&a.to_string()).expect("printed text").to_polynomial(&mut |_| None);
        prop_assert_eq!(read.expect("short"), Some(a));
    }

    #[test]
    fn polynomials_have_opposites_powers_and_inverses(a in polynomial(), b in polynomial(), n in 0_i32..4) {
        let mut opposite = a.clone();
        opposite.negate();
        prop_assert!((a.clone() + opposite).is_zero());
        prop_assert_eq!(a.clone() + b.clone(), b.clone() + a.clone());
        prop_assert_eq!(a.product(&Polynomial::zero()), Polynomial::zero());
        let power = (0..n).fold(Polynomial::constant(Rational::one()), |power, _| power.product(&a));
        prop_assert_eq!(a.power(n), Some(power));
        // A single term is a unit, a sum is none.
        let inverse = a.power(-1);
        prop_assert_eq!(inverse.is_some(), a.terms().len() == 1);
        if let Some(inverse) = inverse {
            prop_assert_eq!(inverse.product(&a), Polynomial::constant(Rational::one()));
        }
    }

    #[test]
    fn polynomials_keep_their_values(
        a in polynomial(), b in polynomial(), p in 1_i64..=9, q in 1_i64..=9, unit in (1_i64..=5, -2_i32..=2)
    ) {
        let (point, other) = (ratio(p, 4), ratio(q, 5));
        let value = |polynomial: &Polynomial| {
            let value_of = |symbol: Symbol| Some(to_f64(if symbol.name() == "A" { &point } else { &other }));
            polynomial.evaluate(value_of).expect("both symbols have values")
        };
        let size = |polynomial: &Polynomial| value(&polynomial.map(num_traits::Signed::abs));
        let close = |left: f64, right: f64, scale: f64| (left - right).abs() <= 1e-12 * (1.0 + scale);
        prop_assert!(close(value(&(a.clone() + b.clone())), value(&a) + value(&b), size(&a) + size(&b)));
        prop_assert!(close(value(&a.product(&b)), value(&a) * value(&b), size(&a) * size(&b)));
        // Numbers put in exactly, one after the other, give the same value, and substitution
        // respects products.
        let number = |value: &Rational| Polynomial::constant(value.clone());
        let exact = |polynomial: &Polynomial| {
            let once = polynomial.substitute("A".into(), &number(&point)).expect("not zero");
            once.substitute("k".into(), &number(&other)).expect("not zero").as_number().expect("no symbol is left")
        };
        prop_assert!(close(to_f64(&exact(&a)), value(&a), size(&a)));
        prop_assert_eq!(exact(&a.product(&b)), exact(&a) * exact(&b));
        let unit = Polynomial::term(Monomial::power_of("k".into(), unit.1), ratio(unit.0, 3));
        let put_in = |polynomial: &Polynomial| polynomial.substitute("A".into(), &unit).expect("a unit");
        prop_assert_eq!(put_in(&a.product(&b)), put_in(&a).product(&put_in(&b)));
        prop_assert_eq!(put_in(&(a.clone() + b.clone())), put_in(&a) + put_in(&b));
    }

    #[test]
    fn series_over_fractions_form_a_ring(a in series(), b in series(), c in series(), n in 0_u32..4) {
        let (a, b, c) = (fractions(&a), fractions(&b), fractions(&c));
        prop_assert_eq!(a.product(&b), b.product(&a));
        prop_assert_eq!(a.product(&b).product(&c), a.product(&b.product(&c)));
        prop_assert_eq!(a.product(&b.sum(&c)), a.product(&b).sum(&a.product(&c)));
        prop_assert_eq!(a.sum(&b).difference(&b), a.clone());
        prop_assert_eq!(a.sum(&b.sum(&c)), a.sum(&b).sum(&c));
        prop_assert_eq!(a.product(&FourierSeries::zero(Rationals)), FourierSeries::zero(Rationals));
        prop_assert_eq!(a.times(-6).divided_by(-3), a.times(2));
        let power = (0..n).fold(FourierSeries::integer(Rationals, 1), |power, _| power.product(&a));
        prop_assert_eq!(a.power(n), power);
    }

    #[test]
    fn symbols_over_one_denominator_or_over_fractions(a in symbolic_series(), b in symbolic_series()) {
        // Polynomials with whole coefficients and one denominator, or with fractions.
        let fractions = |series: &FourierSeries<Polynomials<Integers>>| -> FourierSeries<Polynomials> {
            series.map(POLYNOMIALS, |numerator, denominator| numerator.map(|coefficient| fraction(coefficient, denominator)))
        };
        prop_assert_eq!(fractions(&a.product(&b)), fractions(&a).product(&fractions(&b)));
        prop_assert_eq!(fractions(&a.sum(&b)), fractions(&a).sum(&fractions(&b)));
        prop_assert_eq!(fractions(&a.derivative()), fractions(&a).derivative());
        let (whole, field) = (a.solve_oscillator(), fractions(&a).solve_oscillator());
        prop_assert_eq!(fractions(&whole.0), field.0);
        prop_assert_eq!(fractions(&whole.1.cosine), field.1.cosine);
        prop_assert_eq!(fractions(&whole.1.sine), field.1.sine);
        let rule = a.derivative().product(&b).sum(&a.product(&b.derivative()));
        prop_assert_eq!(a.product(&b).derivative(), rule);
    }

    #[test]
    fn division_undoes_multiplication(a in series(), p in -9_i64..=9, q in 1_i64..=9) {
        let divisor = FourierSeries::integer(Integers, p).divided_by(q);
        match a.divided_by_constant(&divisor) {
            Some(quotient) => prop_assert_eq!(quotient.product(&divisor), a),
            None => prop_assert_eq!(p, 0),
        }
    }

    #[test]
    fn running_products_are_products(
        u in prop::collection::vec(series(), 4), v in prop::collection::vec(series(), 4), exponent in 1_u32..=5
    ) {
        // Order by order, against the product of the whole polynomials in the small parameter.
        let mut convolutions = Convolutions::new(Integers);
        let (left, right) = (convolutions.leaf(), convolutions.leaf());
        let power = convolutions.power(left, exponent);
        let node = convolutions.product(power, right);
        convolutions.require(node, 3);
        for order in 0..4 {
            convolutions.push(left, u[order].clone());
            convolutions.push(right, v[order].clone());
            convolutions.advance(order);
        }
        let cauchy = |a: &[FourierSeries<Integers>], b: &[FourierSeries<Integers>]| -> Vec<FourierSeries<Integers>> {
            let entry = |n: usize| (0..=n).fold(FourierSeries::zero(Integers), |sum, i| sum.sum(&a[i].product(&b[n - i])));
            (0..4).map(entry).collect()
        };
        let expected = cauchy(&(1..exponent).fold(u.clone(), |product, _| cauchy(&product, &u)), &v);
        for (order, expected) in expected.iter().enumerate() {
            prop_assert_eq!(convolutions.order(node, order), Some(expected), "order {}", order);
        }
    }

    #[test]
    fn fourier_series_form_a_ring(a in series(), b in series(), c in series()) {
        prop_assert_eq!(a.product(&b), b.product(&a));
        prop_assert_eq!(a.product(&b).product(&c), a.product(&b.product(&c)));
        prop_assert_eq!(a.product(&b.sum(&c)), a.product(&b).sum(&a.product(&c)));
        prop_assert_eq!(a.difference(&a), FourierSeries::zero(Integers));
        prop_assert_eq!(a.product(&FourierSeries::integer(Integers, 1)), a);
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
        let [cosine, sine] = [FourierSeries::cos(Integers, 1), FourierSeries::sin(Integers, 1)];
        let resonant = resonance.cosine.product(&cosine).sum(&resonance.sine.product(&sine));
        prop_assert_eq!(left.sum(&resonant), right_side);
        prop_assert!(solution.cosine(1).is_zero() && solution.sine(1).is_zero());
    }

    #[test]
    fn values_add_and_differentiate(a in parts(), b in parts(), theta in -4.0_f64..4.0) {
        let float = |series: &FourierSeries<Integers>| series.map(Doubles, |n, d| to_f64(&fraction(n, d)));
        let by_hand = |(cosine, sine, denominator): &(Vec<i64>, Vec<i64>, i64)| {
            let cosines = cosine.iter().enumerate().map(|(k, c)| *c as f64 * (k as f64 * theta).cos());
            let sines = sine.iter().enumerate().map(|(k, s)| *s as f64 * (k as f64 * theta).sin());
            cosines.chain(sines).sum::<f64>() / *denominator as f64
        };
        let slope_by_hand = |(cosine, sine, denominator): &(Vec<i64>, Vec<i64>, i64)| {
            let cosines = cosine.iter().enumerate().map(|(k, c)| -(k as f64) * *c as f64 * (k as f64 * theta).sin());
            let sines = sine.iter().enumerate().map(|(k, s)| k as f64 * *s as f64 * (k as f64 * theta).cos());
            cosines.chain(sines).sum::<f64>() / *denominator as f64
        };
        let close = |left: f64, right: f64| (left - right).abs() <= 1e-10 * (1.0 + right.abs());
        prop_assert!(close(float(&whole(&a)).evaluate(theta), by_hand(&a)));
        prop_assert!(close(float(&whole(&a).sum(&whole(&b))).evaluate(theta), by_hand(&a) + by_hand(&b)));
        prop_assert!(close(float(&whole(&a).derivative()).evaluate(theta), slope_by_hand(&a)));
        prop_assert!(close(float(&whole(&a).at_zero()).evaluate(theta), float(&whole(&a)).evaluate(0.0)));
    }

    #[test]
    fn values_multiply(a in parts(), b in parts(), theta in -4.0_f64..4.0) {
        let float = |series: &FourierSeries<Integers>| series.map(Doubles, |n, d| to_f64(&fraction(n, d)));
        let (a, b) = (whole(&a), whole(&b));
        let product = float(&a.product(&b)).evaluate(theta);
        let factors = float(&a).evaluate(theta) * float(&b).evaluate(theta);
        prop_assert!((product - factors).abs() <= 1e-9 * (1.0 + factors.abs()));
    }

    #[test]
    fn taylors_theorem_in_one_variable(which in 0..FUNCTIONS.len(), p in -7_i64..=7, q in 8_i64..=11) {
        // The k-th coefficient is the k-th derivative over k!, for every function of the grammar at
        // every point.
        let point = ratio(p, q);
        let function = parse_expression(FUNCTIONS[which]).expect("an expression");
        // Only at a corner is there no series, and there always.
        let corner = p == 0 && CORNER_AT_ZERO.contains(&FUNCTIONS[which]);
        let Ok(parts) = taylor(&function, &[("x".into(), point.clone())], 4) else {
            prop_assert!(corner, "{} at {point}", FUNCTIONS[which]);
            return Ok(());
        };
        prop_assert!(!corner, "{} at {point} has no series", FUNCTIONS[which]);
        let at = [("x".into(), lindstedt::exact::to_f64(&point))].into();
        let (mut derivative, mut factorial) = (function, 1.0);
        for (k, part) in parts.iter().enumerate() {
            let coefficient = part.evaluate(&[("x".into(), 1.0)].into()).expect("a number");
            let expected = derivative.evaluate(&at).expect("a number") / factorial;
            let error = (coefficient - expected).abs() / (1.0 + expected.abs());
            prop_assert!(error <= 1e-9, "{} at {point}: {k}", FUNCTIONS[which]);
            derivative = derivative.differentiate("x".into()).expect("a derivative");
            factorial *= (k + 1) as f64;
        }
    }

    #[test]
    fn taylors_theorem_in_two_variables(
        which in 0..FUNCTIONS.len(), p in -7_i64..=7, q in -7_i64..=7, direction in (-5_i64..=5, -5_i64..=5)
    ) {
        // Part k at a deviation (d, e) is the sum of d^i e^j / (i! j!) times the partial
        // derivative, i + j = k.
        const DEGREE: usize = 3;
        let (x, y) = (Symbol::new("x"), Symbol::new("y"));
        let argument = parse_expression("x/2 + y/3 + x*y/4").expect("an expression");
        let function = parse_expression(FUNCTIONS[which]).expect("an expression");
        let function = function.substitute(x, &argument).expect("a value");
        let (at_x, at_y) = (ratio(p, 8), ratio(q, 8));
        let corner = (&at_x / ratio(2, 1) + &at_y / ratio(3, 1) + &at_x * &at_y / ratio(4, 1)).is_zero()
            && CORNER_AT_ZERO.contains(&FUNCTIONS[which]);
        let Ok(parts) = taylor(&function, &[(x, at_x.clone()), (y, at_y.clone())], DEGREE as u32) else {
            prop_assert!(corner, "{} at {at_x}, {at_y}", FUNCTIONS[which]);
            return Ok(());
        };
        prop_assert!(!corner, "{} at {at_x}, {at_y} has no series", FUNCTIONS[which]);
        let at = BTreeMap::from([(x, to_f64(&at_x)), (y, to_f64(&at_y))]);
        let deviation = BTreeMap::from([(x, direction.0 as f64 / 4.0), (y, direction.1 as f64 / 4.0)]);
        let mut expected = [0.0; DEGREE + 1];
        let mut size = [1.0; DEGREE + 1];
        let mut by_x = function;
        for i in 0..=DEGREE {
            let mut by_y = by_x.clone();
            for j in 0..=DEGREE - i {
                let powers = deviation[&x].powi(i as i32) * deviation[&y].powi(j as i32);
                let weight = powers / (FACTORIALS[i] * FACTORIALS[j]);
                let term = weight * by_y.evaluate(&at).expect("a number");
                expected[i + j] += term;
                size[i + j] += term.abs();
                by_y = by_y.differentiate(y).expect("a derivative");
            }
            by_x = by_x.differentiate(x).expect("a derivative");
        }
        for (k, part) in parts.iter().enumerate() {
            let value = part.evaluate(&deviation).expect("a number");
            prop_assert!((value - expected[k]).abs() <= 1e-9 * size[k], "{} at {at_x}, {at_y}: {k}", FUNCTIONS[which]);
        }
    }
}

const FACTORIALS: [f64; 4] = [1.0, 1.0, 2.0, 6.0];

/// Those of [`FUNCTIONS`] that have a corner or a jump at zero, and nowhere else.
const CORNER_AT_ZERO: [&str; 4] = ["abs(x)", "sgn(x)", "max(x, -x)", "H(x)"];

#[test]
fn every_function_of_the_grammar_is_expanded() {
    let mut seen = BTreeSet::new();
    for text in FUNCTIONS {
        let mut open = vec![parse_expression(text).expect("an expression")];
        while let Some(expression) = open.pop() {
            if let Node::Function(function, _) = expression.node() {
                seen.insert(*function);
            }
            open.extend(expression.children().cloned());
        }
    }
    let missing: Vec<&str> =
        Function::all().filter(|function| !seen.contains(function)).map(Function::name).collect();
    assert_eq!(missing, Vec::<&str>::new());
    assert!(CORNER_AT_ZERO.iter().all(|corner| FUNCTIONS.contains(corner)));
}

/// Every function of the grammar, inside its domain for |x| < 1.
const FUNCTIONS: [&str; 20] = [
    "sin(x + k*0)",
    "cos(x)",
    "tan(x)",
    "sinh(x)",
    "cosh(x)",
    "tanh(2*x)",
    "asin(x/2)",
    "acos(x/2)",
    "atan(x)",
    "asinh(x)",
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
    let half = taylor(&parse_expression("sin(x)").expect("sine"), &[("x".into(), ratio(1, 2))], 1)
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
    for (text, expected) in
        [("sqrt(x^4)", "x^2"), ("(x^3)^(1/3)", "x"), ("(x^2)^(3/2)*(x^2)^(1/2)", "x^4")]
    {
        let function = parse_expression(text).expect("an expression");
        let parts = taylor(&function, &[("x".into(), Rational::zero())], 4).expect(text);
        assert_eq!(Expr::sum(parts), parse_expression(expected).expect("an expression"), "{text}");
    }
}
