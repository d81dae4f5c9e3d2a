//! Whether two expressions are the same for every value of their symbols, and the terms in which
//! they differ.
//!
//! They are compared term by term in expanded form. If that does not decide, because an identity of
//! functions may convert one into the other, they are evaluated at points that are the same in
//! every run.

use std::collections::BTreeMap;

use crate::expr::{CompiledFunction, Expr, ExprError};
use crate::symbol::Symbol;

/// The difference of two expressions.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TermDifference {
    /// The terms of the first that the second does not have.
    pub(super) only_first: Vec<Expr>,
    /// The terms of the second that the first does not have.
    pub(super) only_second: Vec<Expr>,
}

/// Number of points at which expressions are compared, and the least number of them that must have
/// a value.
const POINTS: usize = 64;
const ENOUGH: usize = 8;

/// The difference of two expressions; `None` if they are the same.
///
/// # Errors
/// Expressions too large to be written out; no point at which both have a value.
pub(super) fn difference(first: &Expr, second: &Expr) -> Result<Option<TermDifference>, String> {
    let words = |error: ExprError| error.to_string();
    let (one, other) = (first.expand().map_err(words)?, second.expand().map_err(words)?);
    let rest = (&one - &other).expand().map_err(words)?;
    if rest.is_zero() || agree(&one, &other)? {
        return Ok(None);
    }
    let apart = |these: &Expr, those: &Expr| -> Vec<Expr> {
        let terms = these.terms().iter().filter(|term| !those.terms().contains(term));
        terms.cloned().collect()
    };
    Ok(Some(TermDifference { only_first: apart(&one, &other), only_second: apart(&other, &one) }))
}

/// Whether two expressions have the same value wherever both have one.
fn agree(one: &Expr, other: &Expr) -> Result<bool, String> {
    let symbols: Vec<Symbol> = one.symbols().union(&other.symbols()).copied().collect();
    let compiled =
        |expr: &Expr| CompiledFunction::new(expr, &symbols).map_err(|error| error.to_string());
    let (first, second) = (compiled(one)?, compiled(other)?);
    // A linear congruential generator gives the same points in every run.
    let mut state = 0x2545_F491_4F6C_DD1D_u64;
    let mut next = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut compared = 0;
    for point in 0..POINTS {
        // Roots need positive arguments, steps and signs arguments of both signs.
        let place = |part: f64| {
            if point % 2 == 0 { 0.2 + 1.5 * part } else { 3.0 * part - 1.5 }
        };
        let arguments: Vec<f64> = symbols.iter().map(|_| place(next())).collect();
        let (a, b) = (first.call(&arguments), second.call(&arguments));
        if a.is_finite() && b.is_finite() {
            if (a - b).abs() > 1e-9 * (1e-3 + a.abs() + b.abs()) {
                return Ok(false);
            }
            compared += 1;
        }
    }
    match compared >= ENOUGH {
        true => Ok(true),
        false => Err("there are too few points at which both expressions have a value".to_owned()),
    }
}

/// An expression with these definitions substituted, which may use each other. `X'` is the time
/// derivative of what `X` is defined as, unless it has a definition of its own; in that derivative
/// `t` is the time, and `x` depends on it.
///
/// # Errors
/// A definition that uses itself; a result without a value.
pub(super) fn with_definitions(
    expr: &Expr,
    definitions: &BTreeMap<Symbol, Expr>,
) -> Result<Expr, String> {
    let mut found = expr.clone();
    let mut definitions = definitions.clone();
    for symbol in expr.symbols() {
        if let (Some(of), 1, false) = (
            definitions.get(&symbol.coordinate()),
            symbol.primes(),
            definitions.contains_key(&symbol),
        ) {
            let rate = time_derivative(of).map_err(|error| error.to_string())?;
            definitions.insert(symbol, rate);
        }
    }
    for _ in 0..=definitions.len() {
        if !definitions.keys().any(|name| found.contains(*name)) {
            return Ok(found);
        }
        found = found.substitute_all(&definitions).map_err(|error| error.to_string())?;
    }
    let own = definitions.keys().find(|name| found.contains(**name));
    match own {
        None => Ok(found),
        Some(name) => Err(format!("`{name}` is defined by itself")),
    }
}

/// The rate of change along any motion x(t).
fn time_derivative(expr: &Expr) -> Result<Expr, ExprError> {
    let x = Symbol::new("x");
    let mut terms = vec![expr.differentiate(Symbol::new("t"))?];
    for moving in [x, x.derivative()] {
        let slope = expr.differentiate(moving)?;
        terms.push(Expr::product([slope, Expr::from(moving.derivative())]));
    }
    Ok(Expr::sum(terms))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::parse_expression;

    fn apart(one: &str, other: &str) -> Option<[String; 2]> {
        let [one, other] = [one, other].map(|text| parse_expression(text).expect("an expression"));
        let words =
            |terms: Vec<Expr>| terms.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ");
        difference(&one, &other)
            .expect("a comparison")
            .map(|found| [words(found.only_first), words(found.only_second)])
    }

    #[test]
    fn what_is_the_same_by_a_law_of_functions_is_the_same() {
        for (one, other) in [
            ("(x + 1)^2", "x^2 + 2*x + 1"),
            ("sin(x)^2 + cos(x)^2", "1"),
            ("sin(2*x)", "2*sin(x)*cos(x)"),
            ("(l*d)^(3/2)*H(d)", "l^(3/2)*d*sqrt(d)*H(d)"),
        ] {
            assert_eq!(apart(one, other), None, "{one} = {other}");
        }
    }

    #[test]
    fn the_terms_that_differ_are_named() {
        let found = apart("(a + 1)^2 + b", "(a + 1)^2 + b^2");
        assert_eq!(found, Some(["b".to_owned(), "b^2".to_owned()]));
        assert_eq!(apart("x", "x + 1e-6"), Some([String::new(), "1/1000000".to_owned()]));
        // It is not where both have no value that they agree.
        let [one, other] = ["sqrt(-1 - x^2)", "sqrt(-2 - x^2)"]
            .map(|text| parse_expression(text).expect("an expression"));
        assert!(difference(&one, &other).is_err());
    }

    #[test]
    fn definitions_may_use_each_other_but_not_themselves() {
        let define = |entries: &[(&str, &str)]| -> BTreeMap<Symbol, Expr> {
            let parsed = |text: &str| parse_expression(text).expect("an expression");
            entries.iter().map(|(name, text)| (Symbol::new(name), parsed(text))).collect()
        };
        let f = parse_expression("F + 1").expect("an expression");
        let found = with_definitions(&f, &define(&[("F", "k*d"), ("k", "2")]));
        assert_eq!(found.map(|found| found.to_string()), Ok("1 + 2*d".to_owned()));
        let rate = parse_expression("X' + F'").expect("an expression");
        let found = with_definitions(&rate, &define(&[("X", "t*sin(x)"), ("F'", "3")]));
        assert_eq!(found.map(|found| found.to_string()), Ok("3 + sin(x) + x'*t*cos(x)".to_owned()));
        assert!(
            with_definitions(&f, &define(&[("F", "k"), ("k", "F")]))
                .is_err_and(|error| error.contains("itself"))
        );
    }
}
