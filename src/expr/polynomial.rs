//! Between expressions and exact polynomials: what can be expanded in its symbols, and back.

use num_traits::{ToPrimitive, Zero};

use super::{Expr, ExprError, Node, normal};
use crate::exact::polynomial::Monomial;
use crate::exact::{Polynomial, Rational};
use crate::symbol::Symbol;

impl Expr {
    /// This expression as a polynomial in its symbols, with exponents of either sign.
    ///
    /// A factor that is no integer power of a symbol (`sqrt(k)`, `sin(1/2)`, `1/(1 + k)`) is offered to `name`, which may give
    /// it a symbol of its own. `Ok(None)` where a factor stays without a name.
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

fn single_factor(factor: &Expr, name: &mut dyn FnMut(&Expr) -> Option<Symbol>) -> Option<Monomial> {
    match factor.node() {
        Node::Pi => Some(Monomial::power_of(Symbol::new("pi"), 1)),
        Node::Symbol(symbol) => Some(Monomial::power_of(*symbol, 1)),
        Node::Power(base, exponent) => match (base.node(), exponent.as_number()) {
            (Node::Symbol(symbol), Some(power)) if power.is_integer() => {
                Some(Monomial::power_of(*symbol, power.to_i32()?))
            }
            (Node::Pi, Some(power)) if power.is_integer() => {
                Some(Monomial::power_of(Symbol::new("pi"), power.to_i32()?))
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
            normal::power(&Self::from(symbol), &exponent).expect("a whole power of a symbol is never undefined")
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
