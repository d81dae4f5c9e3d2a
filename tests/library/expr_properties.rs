//! What must hold of every expression: it reads back as it prints, its value survives
//! simplification, its derivative agrees with differences, and sums and products obey the laws of a
//! ring.

use std::collections::BTreeMap;

use lindstedt::Symbol;
use lindstedt::exact::Rational;
use lindstedt::exact::{ratio, to_f64};
use lindstedt::expr::{CompiledFunction, Expr, Function, parse_equation, parse_expression};
use num_traits::Zero;
use proptest::prelude::*;

/// An expression before any simplification: the independent truth about values.
#[derive(Clone, Debug)]
enum Raw {
    Number(i64, i64),
    Symbol(&'static str),
    Add(Box<Raw>, Box<Raw>),
    Subtract(Box<Raw>, Box<Raw>),
    Multiply(Box<Raw>, Box<Raw>),
    Divide(Box<Raw>, Box<Raw>),
    Negate(Box<Raw>),
    Power(Box<Raw>, i64, i64),
    Call(Function, Box<Raw>, Box<Raw>),
}

const SYMBOLS: [&str; 5] = ["x", "x'", "eps", "A", "y"];

impl Raw {
    /// With every pair of parentheses.
    fn text(&self) -> String {
        match self {
            Self::Number(numerator, denominator) => format!("({numerator}/{denominator})"),
            Self::Symbol(name) => (*name).to_string(),
            Self::Add(a, b) => format!("({} + {})", a.text(), b.text()),
            Self::Subtract(a, b) => format!("({} - {})", a.text(), b.text()),
            Self::Multiply(a, b) => format!("({} * {})", a.text(), b.text()),
            Self::Divide(a, b) => format!("({} / {})", a.text(), b.text()),
            Self::Negate(a) => format!("(-{})", a.text()),
            Self::Power(a, numerator, denominator) => {
                format!("({}^({numerator}/{denominator}))", a.text())
            }
            Self::Call(function, a, _) if function.argument_count() == 1 => {
                format!("{}({})", function.name(), a.text())
            }
            Self::Call(function, a, b) => {
                format!("{}({}, {})", function.name(), a.text(), b.text())
            }
        }
    }

    /// The exact value of a tree without functions and roots; `None` where it divides by zero, and
    /// for a letter that has no value.
    fn exact(&self, point: &BTreeMap<Symbol, Rational>) -> Option<Rational> {
        Some(match self {
            Self::Number(numerator, denominator) => ratio(*numerator, *denominator),
            Self::Symbol(name) => point.get(&Symbol::new(name))?.clone(),
            Self::Add(a, b) => a.exact(point)? + b.exact(point)?,
            Self::Subtract(a, b) => a.exact(point)? - b.exact(point)?,
            Self::Multiply(a, b) => a.exact(point)? * b.exact(point)?,
            Self::Divide(a, b) => {
                a.exact(point)? / Some(b.exact(point)?).filter(|value| !value.is_zero())?
            }
            Self::Negate(a) => -a.exact(point)?,
            Self::Power(_, numerator, denominator) if numerator % denominator != 0 => return None,
            Self::Power(a, numerator, denominator) => {
                let base = a.exact(point)?;
                let exponent = i32::try_from(numerator / denominator).ok()?;
                if base.is_zero() && exponent <= 0 {
                    return None;
                }
                base.pow(exponent)
            }
            Self::Call(..) => return None,
        })
    }

    /// The value in floating point, with the real root of odd degree. Numbers are exact up to the
    /// first root or function, as the program's are: the sine of 5^12 is wrong altogether for an
    /// argument with one wrong digit. `nudge` is by how much, of its size, each root and function
    /// is moved, to see what their roundings amount to.
    fn float(&self, point: &BTreeMap<Symbol, f64>, nudge: f64) -> f64 {
        if let Some(number) = self.exact(&BTreeMap::new()) {
            return to_f64(&number);
        }
        let value = |part: &Self| part.float(point, nudge);
        match self {
            Self::Number(numerator, denominator) => to_f64(&ratio(*numerator, *denominator)),
            Self::Symbol(name) => point[&Symbol::new(name)],
            Self::Add(a, b) => value(a) + value(b),
            Self::Subtract(a, b) => value(a) - value(b),
            Self::Multiply(a, b) => value(a) * value(b),
            Self::Divide(a, b) => value(a) / value(b),
            Self::Negate(a) => -value(a),
            Self::Power(a, numerator, denominator) => {
                let base = value(a);
                let exponent = ratio(*numerator, *denominator);
                let even = |integer: &lindstedt::exact::Integer| !integer.is_odd();
                let size = base.abs().powf(to_f64(&exponent)) * (1.0 + nudge);
                match base < 0.0 {
                    true if even(exponent.denom()) => f64::NAN,
                    true if !even(exponent.numer()) => -size,
                    _ => size,
                }
            }
            Self::Call(function, a, b) => function.value(value(a), value(b)) * (1.0 + nudge),
        }
    }
}

fn leaf() -> impl Strategy<Value = Raw> {
    prop_oneof![
        (-6_i64..=6, 1_i64..=4)
            .prop_map(|(numerator, denominator)| Raw::Number(numerator, denominator)),
        proptest::sample::select(SYMBOLS.to_vec()).prop_map(Raw::Symbol),
    ]
}

/// Sums, products, quotients and whole powers.
fn rational_tree() -> impl Strategy<Value = Raw> {
    algebraic_tree(1, -3)
}

/// Sums, products and powers with a natural exponent.
fn polynomial_tree() -> impl Strategy<Value = Raw> {
    algebraic_tree(0, 1)
}

fn algebraic_tree(quotients: u32, lowest_power: i64) -> impl Strategy<Value = Raw> {
    leaf().prop_recursive(5, 40, 2, move |inner| {
        let pair = (inner.clone().prop_map(Box::new), inner.prop_map(Box::new));
        prop_oneof![
            3 => pair.clone().prop_map(|(a, b)| Raw::Add(a, b)),
            2 => pair.clone().prop_map(|(a, b)| Raw::Subtract(a, b)),
            3 => pair.clone().prop_map(|(a, b)| Raw::Multiply(a, b)),
            quotients => pair.clone().prop_map(|(a, b)| Raw::Divide(a, b)),
            1 => pair.0.clone().prop_map(Raw::Negate),
            2 => (pair.0, lowest_power..=4).prop_map(|(a, exponent)| Raw::Power(a, exponent, 1)),
        ]
    })
}

/// Everything, with roots and functions.
fn full_tree() -> impl Strategy<Value = Raw> {
    leaf().prop_recursive(4, 30, 2, |inner| {
        let pair = (inner.clone().prop_map(Box::new), inner.prop_map(Box::new));
        let function = proptest::sample::select(Function::all().collect::<Vec<_>>());
        prop_oneof![
            2 => pair.clone().prop_map(|(a, b)| Raw::Add(a, b)),
            2 => pair.clone().prop_map(|(a, b)| Raw::Subtract(a, b)),
            3 => pair.clone().prop_map(|(a, b)| Raw::Multiply(a, b)),
            1 => pair.clone().prop_map(|(a, b)| Raw::Divide(a, b)),
            1 => pair.0.clone().prop_map(Raw::Negate),
            2 => (pair.0.clone(), -5_i64..=5, 1_i64..=4).prop_map(|(a, p, q)| Raw::Power(a, p, q)),
            2 => (function, pair).prop_map(|(function, (a, b))| Raw::Call(function, a, b)),
        ]
    })
}

fn rational_point() -> impl Strategy<Value = BTreeMap<Symbol, Rational>> {
    proptest::collection::vec((-20_i64..=20, 1_i64..=7), SYMBOLS.len()).prop_map(|values| {
        let values =
            values.into_iter().map(|(numerator, denominator)| ratio(numerator, denominator));
        SYMBOLS.iter().map(|name| Symbol::new(name)).zip(values).collect()
    })
}

fn float_point() -> impl Strategy<Value = BTreeMap<Symbol, f64>> {
    proptest::collection::vec(-2.0..2.0, SYMBOLS.len())
        .prop_map(|values| SYMBOLS.iter().map(|name| Symbol::new(name)).zip(values).collect())
}

fn at(expr: &Expr, point: &BTreeMap<Symbol, Rational>) -> Option<Rational> {
    let values =
        point.iter().map(|(symbol, value)| (*symbol, Expr::number(value.clone()))).collect();
    expr.substitute_all(&values).ok()?.as_number().cloned()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn what_is_printed_reads_back(raw in full_tree()) {
        if let Ok(expr) = parse_expression(&raw.text()) {
            let text = expr.to_string();
            prop_assert_eq!(parse_expression(&text), Ok(expr), "{}", text);
        }
    }

    #[test]
    fn what_is_derived_reads_back(raw in full_tree()) {
        if let Ok(expr) = parse_expression(&raw.text())
            && let Ok(slope) = expr.differentiate(Symbol::new("x"))
        {
            let text = slope.to_string();
            prop_assert_eq!(parse_expression(&text), Ok(slope), "{}", text);
        }
    }

    #[test]
    fn simplification_keeps_the_exact_value(raw in rational_tree(), point in rational_point()) {
        let truth = raw.exact(&point);
        match parse_expression(&raw.text()) {
            // A point where the original divides by zero may have a value afterwards.
            Ok(expr) => {
                prop_assert!(truth.is_none() || at(&expr, &point) == truth, "{expr}: {truth:?}");
                if let Ok(expanded) = expr.expand() {
                    prop_assert!(truth.is_none() || at(&expanded, &point) == truth, "{expanded}: {truth:?}");
                }
            }
            Err(_) => prop_assert!(truth.is_none(), "refused, but {truth:?}"),
        }
    }

    #[test]
    fn simplification_keeps_the_value_of_functions_and_roots(raw in full_tree(), point in float_point()) {
        let truth = raw.float(&point, 0.0);
        let nearby = point.iter().map(|(symbol, value)| (*symbol, value * (1.0 + 1e-10))).collect();
        let sensitivity = (raw.float(&nearby, 0.0) - truth).abs() + (raw.float(&point, 1e-10) - truth).abs();
        // Points next to a jump or a pole, and sums in which everything cancels, tell nothing.
        prop_assume!(truth.is_finite() && sensitivity < 1e-6 * (1.0 + truth.abs()));
        match parse_expression(&raw.text()) {
            Ok(expr) => {
                let value = expr.evaluate(&point).map_err(|error| TestCaseError::fail(format!("{expr}: {error}")))?;
                let tolerance = 1e-9 * (1.0 + truth.abs()) + 100.0 * sensitivity;
                prop_assert!((value - truth).abs() <= tolerance, "{expr} is {value}, not {truth}");
            }
            // Refused as a whole although a step hides the offending factor, or a term of value
            // zero: both are rare.
            Err(error) => prop_assert!(error.message.contains("no real value") || error.message.contains("division")),
        }
    }

    #[test]
    fn derivatives_agree_with_differences(raw in full_tree(), point in float_point()) {
        let x = Symbol::new("x");
        let Ok(expr) = parse_expression(&raw.text()) else { return Ok(()) };
        let Ok(slope) = expr.differentiate(x) else { return Ok(()) };
        let shifted = |step: f64| {
            let mut moved = point.clone();
            moved.insert(x, point[&x] + step);
            expr.evaluate(&moved)
        };
        let difference = |step: f64| Some((shifted(step).ok()? - shifted(-step).ok()?) / (2.0 * step));
        let (Some(coarse), Some(fine), Some(finest)) = (difference(2e-4), difference(1e-4), difference(5e-5)) else {
            return Ok(());
        };
        // Where the three steps disagree there is a kink or a pole, and the difference is no
        // derivative.
        let (first, second) = ((coarse - fine).abs(), (fine - finest).abs());
        prop_assume!(first < 1e-4 * (1.0 + fine.abs()) && second < 0.5 * first + 1e-7 * (1.0 + fine.abs()));
        let value = slope.evaluate(&point).map_err(|error| TestCaseError::fail(format!("{expr}: {slope}: {error}")))?;
        let size = shifted(0.0).unwrap_or(0.0).abs();
        let tolerance = 4.0 * (first + second) + 1e-6 * (1.0 + size + value.abs());
        prop_assert!((value - finest).abs() <= tolerance, "{expr}: {slope} is {value}, not {finest}");
    }

    #[test]
    fn sums_and_products_form_a_ring(a in rational_tree(), b in rational_tree(), c in rational_tree()) {
        let parsed = |raw: &Raw| parse_expression(&raw.text());
        let (Ok(a), Ok(b), Ok(c)) = (parsed(&a), parsed(&b), parsed(&c)) else { return Ok(()) };
        prop_assert_eq!(&a + &b, &b + &a);
        prop_assert_eq!((&a + &b) + &c, &a + (&b + &c));
        prop_assert_eq!(&a * &b, &b * &a);
        prop_assert_eq!((&a * &b) * &c, &a * (&b * &c));
        prop_assert_eq!(&a + Expr::zero(), a.clone());
        prop_assert_eq!(&a * Expr::one(), a.clone());
        prop_assert_eq!(&a - &a, Expr::zero());
        prop_assert_eq!((&a + &b) - &b, a.clone());
        prop_assert_eq!(-(-&a), a.clone());
    }

    /// Quotients of equal value need not be equal trees: nothing is divided out of sums.
    #[test]
    fn polynomials_expand_to_one_form(a in polynomial_tree(), b in polynomial_tree(), c in polynomial_tree()) {
        let parsed = |raw: &Raw| parse_expression(&raw.text());
        let (Ok(a), Ok(b), Ok(c)) = (parsed(&a), parsed(&b), parsed(&c)) else { return Ok(()) };
        if let (Ok(left), Ok(right)) = ((&a * (&b + &c)).expand(), (&a * &b + &a * &c).expand()) {
            prop_assert_eq!(&left, &right);
            prop_assert_eq!(left.expand(), Ok(right));
        }
    }

    #[test]
    fn compiled_functions_give_the_same_numbers(raw in full_tree(), point in float_point()) {
        if let Ok(expr) = parse_expression(&raw.text()) {
            let symbols: Vec<Symbol> = point.keys().copied().collect();
            let arguments: Vec<f64> = point.values().copied().collect();
            let compiled = CompiledFunction::new(&expr, &symbols);
            let value = compiled.map_err(|error| TestCaseError::fail(error.to_string()))?.call(&arguments);
            match expr.evaluate(&point) {
                Ok(expected) => prop_assert_eq!(value, expected),
                Err(_) => prop_assert!(!value.is_finite()),
            }
        }
    }

    #[test]
    fn no_text_makes_the_parser_panic(text in "\\PC{0,40}") {
        let _ = parse_expression(&text).map_err(|error| error.to_string());
        let _ = parse_equation(&text).map_err(|error| error.to_string());
    }

    #[test]
    fn no_formula_like_text_makes_the_parser_panic(
        pieces in proptest::collection::vec(
            proptest::sample::select(vec![
                "x", "x'", "u''", "2", "0", "1.5e3", "e", ".", "+", "-", "*", "/", "^", "**", "(", ")", ",", "=", "==",
                "'", "sin", "sqrt", "max", "H", "pi", "dt", "d", "d2x", "dt2", "A", "nan", " ", "\n", "\u{feff}", "²",
                "−", "x_dot", "diff", "\\ddot{", "}", "\0", "log(0)", "1/0", "(-1)", "(1/2)",
            ]),
            0..24,
        )
    ) {
        let text = pieces.concat();
        for error in [parse_expression(&text).err(), parse_equation(&text).err()].into_iter().flatten() {
            prop_assert!(text.get(error.span.clone()).is_some(), "{:?} in {:?}", error.span, text);
            prop_assert!(!error.to_string().is_empty());
        }
        // A number may have more digits than a text may hold: 1500^1500.
        if let Ok(expr) = parse_expression(&text)
            && expr.to_string().len() < 1_000
        {
            prop_assert_eq!(parse_expression(&expr.to_string()), Ok(expr));
        }
    }
}
