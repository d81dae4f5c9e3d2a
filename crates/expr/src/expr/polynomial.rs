//! Conversion between expressions and exact polynomials.

use num_traits::{ToPrimitive, Zero};

use super::{Expr, ExprError, Node, normal};
use crate::exact::polynomial::Monomial;
use crate::exact::{Polynomial, Rational};
use crate::symbol::Symbol;

impl Expr {
    /// This expression as a polynomial in its symbols, with exponents of either sign.
    ///
    /// A factor that is not an integer power of a symbol (`sqrt(k)`, `sin(1/2)`, `1/(1 + k)`) is
    /// passed to `name`, which may return a symbol for it. Returns `Ok(None)` if it does not.
    ///
    /// # Errors
    /// The expanded form would be too long.
    pub fn to_polynomial(
        &self,
        name: &mut dyn FnMut(&Self) -> Option<Symbol>,
    ) -> Result<Option<Polynomial>, ExprError> {
        let expanded = self.expand()?;
        let mut polynomial = Polynomial::zero();
        for term in expanded.terms() {
            let (coefficient, factors) = term.factors();
            let mut monomial = Monomial::one();
            for factor in factors {
                let Some(power) = single_factor(factor, name) else {
                    return Ok(None);
                };
                monomial = monomial.product(&power);
            }
            polynomial.add_term(monomial, coefficient);
        }
        Ok(Some(polynomial))
    }
}

impl Expr {
    /// The degree of a polynomial in one variable, if it can be found without expansion: the
    /// highest degree cannot cancel if only one term has it. `None` otherwise.
    pub fn degree_at_sight(&self, variable: Symbol) -> Option<u32> {
        let degree =
            self.fold(|part, degrees: &[u32]| degree_of(part, degrees, variable).ok_or(()));
        degree.ok()
    }
}

/// The degree of a part, given those of its own parts.
fn degree_of(part: &Expr, degrees: &[u32], variable: Symbol) -> Option<u32> {
    let constant = degrees.iter().all(|&degree| degree == 0);
    match part.node() {
        Node::Symbol(name) => Some(u32::from(*name == variable)),
        Node::Sum(_) => {
            // A sum of constants may be zero.
            let highest = degrees.iter().copied().max().filter(|&highest| highest > 0)?;
            let alone = degrees.iter().filter(|&&degree| degree == highest).count() == 1;
            alone.then_some(highest)
        }
        Node::Product(..) => degrees.iter().try_fold(0_u32, |sum, &degree| sum.checked_add(degree)),
        Node::Power(_, exponent) if !constant => {
            let exponent = exponent.as_number().filter(|number| number.is_integer())?;
            degrees.first()?.checked_mul(exponent.to_integer().to_u32()?)
        }
        Node::Function(..) if !constant => None,
        Node::Number(_) | Node::Pi | Node::Power(..) | Node::Function(..) => Some(0),
    }
}

fn single_factor(factor: &Expr, name: &mut dyn FnMut(&Expr) -> Option<Symbol>) -> Option<Monomial> {
    match factor.node() {
        Node::Pi => Some(Monomial::power_of(Symbol::new("pi"), 1)),
        Node::Symbol(symbol) => Some(Monomial::power_of(*symbol, 1)),
        Node::Power(base, exponent) => match (base.node(), exponent.as_number()) {
            (Node::Symbol(symbol), Some(power)) if power.is_integer() => {
                Some(Monomial::power_of(*symbol, power.to_integer().to_i32()?))
            }
            (Node::Pi, Some(power)) if power.is_integer() => {
                Some(Monomial::power_of(Symbol::new("pi"), power.to_integer().to_i32()?))
            }
            // All powers of a constant share one symbol.
            (_, Some(power)) if power.is_integer() => {
                let power = power.to_integer().to_i32()?;
                name(base).map(|symbol| Monomial::power_of(symbol, power))
            }
            _ => name(factor).map(|symbol| Monomial::power_of(symbol, 1)),
        },
        _ => name(factor).map(|symbol| Monomial::power_of(symbol, 1)),
    }
}

impl From<&Polynomial> for Expr {
    fn from(polynomial: &Polynomial) -> Self {
        let power = |&(symbol, exponent): &(Symbol, i32)| {
            let exponent = Self::from(i64::from(exponent));
            normal::power(&Self::from(symbol), &exponent)
                .expect("a whole power of a symbol is never undefined")
        };
        let term = |(monomial, coefficient): (&Monomial, &Rational)| {
            let powers = monomial.factors().iter().map(power);
            Self::product(std::iter::once(Self::number(coefficient.clone())).chain(powers))
        };
        Self::sum(polynomial.terms().map(term))
    }
}

impl std::fmt::Display for Polynomial {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        Expr::from(self).fmt(formatter)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::parse_expression;

    /// The degree at sight is the one that writing the expression out gives.
    #[test]
    fn degrees_at_sight() {
        for (text, degree, at_sight) in [
            ("x*(1 + x^2)^50", Some(101), true),
            ("(x + 1)^30 - 1 + x", Some(30), true),
            ("x*(a + b*x^2 + x^4)^5", Some(21), true),
            ("k*x + sqrt(k)*x^3/sin(k)", Some(3), true),
            ("x*sin(t) + pi*x^2", Some(2), true),
            ("(x + 1)^3 - x^3 - 1", Some(2), false),
            ("x*(1 + x)*(1 - x) + x^3", Some(1), false),
            ("((1 + k)^2 - 1 - 2*k - k^2)*x^3 + x", Some(1), false),
            ("x + (1 + k)*x^3", Some(3), false),
            ("x + 1/x", None, false),
            ("x + x^(3/2)", None, false),
            ("x + x^k", None, false),
            ("x + 2^x", None, false),
            ("x + x*abs(x)", None, false),
            ("x/(1 + x^2)", None, false),
        ] {
            let expression = parse_expression(text).unwrap();
            let x = Symbol::new("x");
            let mut constant = |factor: &Expr| (!factor.contains(x)).then(|| Symbol::new("c"));
            let polynomial = expression.to_polynomial(&mut constant).unwrap();
            let range = polynomial.and_then(|polynomial| polynomial.exponent_range(x));
            let known = range.filter(|range| range.0 >= 0).map(|range| range.1 as u32);
            assert_eq!(known, degree, "{text}");
            let found = expression.degree_at_sight(x);
            assert_eq!(found, degree.filter(|_| at_sight), "{text}");
        }
    }
}
