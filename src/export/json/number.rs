//! Exact numbers and polynomials: fractions as text beside decimals.

use indexmap::IndexMap;
use num_traits::Zero;
#[cfg(feature = "schema")]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{JsonError, unexpected};
use crate::exact::polynomial::Monomial;
use crate::exact::rational::to_f64;
use crate::exact::{self, Rational};
use crate::expr::{Expr, parse_expression};
use crate::solution::{Definition, Solution, Sum};
use crate::symbol::Symbol;
use crate::symbol::letters::ResultSymbols;
use crate::values::Values;

/// Values under names that the equation or the program chose, in their order.
pub type Map<T> = IndexMap<String, T>;

/// Whether there is nothing of what is counted, so that it is left out.
pub(super) fn is_nothing(count: &usize) -> bool {
    *count == 0
}

/// An exact constant beside its decimal value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Constant {
    /// The exact value as text: a fraction such as `-1/8`, or an expression such as `pi/3`.
    pub exact: String,
    /// The same as a decimal number; null where it is beyond the range of double precision.
    pub value: Option<f64>,
}

/// A polynomial: the sum of its terms, lowest order in the small parameters first; zero where there
/// is none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Polynomial {
    /// The terms that are added up.
    pub terms: Vec<Term>,
}

/// A term: its coefficient times a product of powers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(JsonSchema))]
pub struct Term {
    /// The power of each symbol in it, negative ones too; `verification.values` has the value of
    /// every symbol.
    pub monomial: Map<i32>,
    /// The exact coefficient as text: a fraction such as `-1/8`.
    pub exact: String,
    /// The coefficient as a decimal number; null where it is beyond the range of double precision.
    pub value: Option<f64>,
}

impl Constant {
    /// An exact constant expression, `3/2` or `pi/3`, beside its decimal value.
    pub fn from_expr(value: &Expr) -> Self {
        let decimal = value.as_number().map(to_f64).or_else(|| value.evaluate(&[].into()).ok());
        Self { exact: value.to_string(), value: finite(decimal) }
    }

    /// The constant that the text says.
    ///
    /// # Errors
    /// A text that is no expression.
    pub fn expression(&self, key: &str) -> Result<Expr, JsonError> {
        expression(&self.exact, key)
    }
}

impl Polynomial {
    /// A polynomial of a solution, lowest order in its small parameters first.
    pub fn from_polynomial(polynomial: &exact::Polynomial, solution: &Solution) -> Self {
        Self::of_sum(&solution.ordered(polynomial))
    }

    /// A polynomial with its terms in order.
    pub fn of_sum(sum: &Sum) -> Self {
        let term = |(monomial, coefficient): (&Monomial, &Rational)| Term {
            monomial: monomial
                .factors()
                .iter()
                .map(|(symbol, exponent)| (symbol.to_string(), *exponent))
                .collect(),
            exact: coefficient.to_string(),
            value: finite(Some(to_f64(coefficient))),
        };
        Self { terms: sum.terms().map(term).collect() }
    }

    /// The polynomial with its exact coefficients.
    ///
    /// # Errors
    /// A coefficient that is no fraction, exponents or symbols beyond all measure.
    pub fn exact(&self, key: &str) -> Result<exact::Polynomial, JsonError> {
        // No document of ours comes near them; those of a hostile one must neither overflow nor
        // keep us busy.
        const HIGHEST_EXPONENT: u32 = 2_000_000;
        const MOST_SYMBOLS: usize = 1000;
        let mut polynomial = exact::Polynomial::zero();
        for term in &self.terms {
            let Ok(coefficient) = term.exact.parse::<Rational>() else {
                return unexpected(key, "a polynomial whose coefficients are fractions");
            };
            let exponents = term.monomial.values();
            let highest = exponents.map(|exponent| exponent.unsigned_abs()).max();
            if highest > Some(HIGHEST_EXPONENT) || term.monomial.len() > MOST_SYMBOLS {
                return unexpected(key, "exponents up to 2000000, of up to 1000 symbols in a term");
            }
            let powers = term.monomial.iter();
            let monomial = powers.fold(Monomial::one(), |product, (name, exponent)| {
                product.product(&Monomial::power_of(Symbol::new(name), *exponent))
            });
            polynomial.add_term(monomial, coefficient);
        }
        Ok(polynomial)
    }
}

/// Each value as it is written.
pub(super) fn texts<T: ToString>(values: impl IntoIterator<Item = T>) -> Vec<String> {
    values.into_iter().map(|value| value.to_string()).collect()
}

/// A value as it is written, where there is one.
pub(super) fn text<T: ToString>(value: Option<T>) -> Option<String> {
    value.map(|value| value.to_string())
}

/// Values under names.
pub(super) fn named<N: ToString, T>(entries: impl IntoIterator<Item = (N, T)>) -> Map<T> {
    entries.into_iter().map(|(name, value)| (name.to_string(), value)).collect()
}

/// Exact values under their names.
pub(super) fn constants(values: &Values) -> Map<Constant> {
    named(values.iter().map(|(name, value)| (name, Constant::from_expr(value))))
}

/// The meaning of each symbol.
pub(super) fn meanings(definitions: &[Definition]) -> Map<String> {
    named(definitions.iter().map(|own| (own.symbol, own.meaning.to_string())))
}

/// The meaning of the names in a document: the letters of an answer give way to the names of its
/// equation.
pub(super) struct DocumentNames {
    own: Vec<Symbol>,
    letters: ResultSymbols,
}

impl DocumentNames {
    /// The names that avoid those of an equation, driven or not.
    pub fn avoiding(own: impl IntoIterator<Item = Symbol>, driven: bool) -> Self {
        let own: Vec<Symbol> = own.into_iter().collect();
        let letters = ResultSymbols::avoiding(&own, driven);
        let clash = |name: &Symbol| letters.renamed().any(|(usual, _)| usual.name() == name.name());
        let apart = |name: Symbol| if clash(&name) { name.apart() } else { name };
        Self { own: own.into_iter().map(apart).collect(), letters }
    }

    /// The name of the frequency.
    pub fn frequency(&self) -> &'static str {
        self.letters.frequency.name()
    }

    /// The symbol of a name.
    pub fn symbol(&self, name: &str) -> Symbol {
        self.changed(Symbol::new(name))
    }

    fn changed(&self, name: Symbol) -> Symbol {
        let changed = self.letters.resolve(name.coordinate(), &self.own);
        (0..name.primes()).fold(changed, |name, _| name.derivative())
    }

    fn are_usual(&self) -> bool {
        self.letters.renamed().next().is_none()
    }

    /// An expression with the symbols of its names.
    pub fn in_expression(&self, expression: Expr, key: &str) -> Result<Expr, JsonError> {
        if self.are_usual() {
            return Ok(expression);
        }
        let symbols = expression.symbols().into_iter();
        let symbols = symbols.map(|name| (name, Expr::from(self.changed(name)))).collect();
        let changed = expression.substitute_all(&symbols);
        changed.or_else(|_| unexpected(key, "an expression"))
    }

    /// The expression of a text.
    pub fn expression(&self, text: &str, key: &str) -> Result<Expr, JsonError> {
        self.in_expression(expression(text, key)?, key)
    }

    /// The exact polynomial of a document.
    pub fn polynomial(
        &self,
        polynomial: &Polynomial,
        key: &str,
    ) -> Result<exact::Polynomial, JsonError> {
        let read = polynomial.exact(key)?;
        if self.are_usual() {
            return Ok(read);
        }
        let mut changed = exact::Polynomial::zero();
        for (monomial, coefficient) in read.terms() {
            let powers = monomial.factors().iter();
            let monomial = powers.fold(Monomial::one(), |product, (name, power)| {
                product.product(&Monomial::power_of(self.changed(*name), *power))
            });
            changed.add_term(monomial, coefficient.clone());
        }
        Ok(changed)
    }
}

/// A text of the grammar.
pub(super) fn expression(text: &str, key: &str) -> Result<Expr, JsonError> {
    parse_expression(text).or_else(|_| unexpected(key, "an expression"))
}

/// JSON has no infinity: what is beyond the range of numbers is null.
pub(super) fn finite(value: Option<f64>) -> Option<f64> {
    value.filter(|value| value.is_finite())
}
