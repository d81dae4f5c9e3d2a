//! A polynomial with its terms in the order of printing.

use std::fmt;

use num_traits::One;

use crate::decimal::significant_fraction;
use crate::exact::polynomial::Monomial;
use crate::exact::{Polynomial, Rational};
use crate::series::terms;

/// The terms of a polynomial in order; printed, it can be typed back in.
#[derive(Clone, Debug, PartialEq)]
pub struct Sum {
    terms: Vec<(Monomial, Rational)>,
    rounded: bool,
    digits: usize,
}

impl Sum {
    /// The terms with the least `key` first; whether the numbers before them are rounded.
    pub fn new(polynomial: &Polynomial, rounded: bool, key: impl Fn(&Monomial) -> i32) -> Self {
        let terms = terms::in_order(polynomial, key).into_iter();
        Self {
            terms: terms.map(|(monomial, number)| (monomial.clone(), number.clone())).collect(),
            rounded,
            digits: 6,
        }
    }

    /// The sum with this many digits of its rounded numbers.
    #[must_use]
    pub fn with_digits(self, digits: usize) -> Self {
        Self { digits, ..self }
    }

    /// The terms and the numbers before them.
    pub fn terms(&self) -> impl Iterator<Item = (&Monomial, &Rational)> {
        self.terms.iter().map(|(monomial, number)| (monomial, number))
    }

    /// The sum of its terms, each written by `exact`; a rounded number by `decimal`, from its six
    /// digits (or as many as were asked for) and what it multiplies, if anything.
    pub fn written(
        &self,
        exact: impl Fn(&Polynomial) -> String,
        decimal: impl Fn(&str, Option<&Polynomial>) -> String,
    ) -> String {
        let term = |(monomial, number): (&Monomial, &Rational)| {
            if !self.rounded || number.is_integer() {
                return exact(&Polynomial::term(monomial.clone(), number.clone()));
            }
            let rest = Polynomial::term(monomial.clone(), Rational::one());
            let rest = Some(&rest).filter(|_| !monomial.factors().is_empty());
            decimal(&significant_fraction(number, self.digits), rest)
        };
        terms::sum(self.terms().map(term))
    }
}

impl fmt::Display for Sum {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let decimal = |number: &str, rest: Option<&Polynomial>| match rest {
            None => number.to_owned(),
            Some(rest) => format!("{number}*{rest}"),
        };
        formatter.write_str(&self.written(ToString::to_string, decimal))
    }
}
