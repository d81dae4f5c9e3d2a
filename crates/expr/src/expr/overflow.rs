//! Whether an expression has no finite value because it overflows, or because it is undefined:
//! `exp(x)` at `x = 1e3` overflows, `1/x` at `x = 0` is a pole.

use std::collections::BTreeMap;
use std::convert::Infallible;

use super::{CompiledFunction, Expr, Function, Node};
use crate::symbol::Symbol;

/// The known size of the value of a part.
#[derive(Clone)]
enum Magnitude {
    Finite(f64),
    /// The value overflows, because of this part.
    Beyond(Expr),
    /// The value is not real, or it is a pole.
    None,
}

impl Expr {
    /// Returns, in words, the innermost part that overflows at this point although its arguments
    /// are finite, if that is why the expression has no value. Returns `None` at a pole, where
    /// there is no real value, or where the value is finite.
    pub fn overflow(&self, values: &BTreeMap<Symbol, f64>) -> Option<String> {
        let (names, numbers): (Vec<Symbol>, Vec<f64>) =
            values.iter().map(|(name, value)| (*name, *value)).unzip();
        let value = |part: &Self| {
            CompiledFunction::new(part, &names).map_or(f64::NAN, |part| part.call(&numbers))
        };
        let found = self.fold(|part, children: &[Magnitude]| {
            let value = value(part);
            let inner = children.iter().find(|child| !matches!(child, Magnitude::Finite(_)));
            Ok::<Magnitude, Infallible>(match (value.is_finite(), inner) {
                (true, _) => Magnitude::Finite(value),
                (false, Some(inner)) => inner.clone(),
                (false, None) if value.is_nan() || is_pole(part, children) => Magnitude::None,
                (false, None) => Magnitude::Beyond(part.clone()),
            })
        });
        match found {
            Ok(Magnitude::Beyond(part)) => Some(super::print::in_message(&part)),
            _ => None,
        }
    }
}

/// Whether an infinite value at finite arguments is a pole: a small number to a negative power, or
/// the logarithm of zero.
fn is_pole(part: &Expr, children: &[Magnitude]) -> bool {
    match (part.node(), children) {
        (Node::Power(..), [Magnitude::Finite(base), ..]) => base.abs() < 1.0,
        (Node::Function(function, _), _) => {
            use Function::{BesselI0, BesselI1, Cosh, Exp, Sinh};
            !matches!(function, Exp | Sinh | Cosh | BesselI0 | BesselI1)
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use crate::expr::parse_expression;
    use std::collections::BTreeMap;

    #[test]
    fn what_overflows_is_told_from_poles_and_from_what_is_not_real() {
        let cases = [
            ("x + exp(x)", 1e3, Some("exp(x)")),
            ("x*exp(x^2)/(1 + x)", 2.5e11, Some("exp(x^2)")),
            ("x + x^99", 1e30, Some("x^99")),
            ("x - x^99 + x^101", -1e30, Some("x^99")),
            ("exp(x) - exp(2*x)", 500.0, Some("exp(2*x)")),
            ("sinh(x)/cosh(x)", -1e4, Some("sinh(x)")),
            ("(x - 1)^(3/2)*H(x - 1) + x^99", -1e30, Some("x^99")),
            ("x + 1/exp(x)", 1e3, None),
            ("x/(1 - x)^2", 1.0, None),
            ("x^(-3)", 1e-300, None),
            ("log(x)", 0.0, None),
            ("sqrt(x)", -1.0, None),
            ("x + x^3", 1e30, None),
        ];
        for (text, place, expected) in cases {
            let expression = parse_expression(text).unwrap();
            let values = BTreeMap::from([("x".into(), place)]);
            let found = expression.overflow(&values);
            assert_eq!(found.as_deref(), expected, "{text} at {place}");
        }
    }
}
