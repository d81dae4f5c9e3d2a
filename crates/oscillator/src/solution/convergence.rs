//! Convergence of the series of omega^2, by its own coefficients.

use std::cmp::Ordering;
use std::fmt;

use num_traits::{One, Zero};

use crate::decimal::significant;
use crate::exact::rational::{ratio, to_f64};
use crate::exact::{Integer, Monomial, Polynomial, Rational};
use crate::expr::Expr;
use crate::series::singularity::{Estimate, Singularity};
use crate::symbol::Symbol;

/// The singularity that the coefficients of a long series show.
#[derive(Clone, Debug, PartialEq)]
pub struct Convergence {
    /// The variable of the series: a power of the small parameter times the symbols that enter in
    /// step with it, `mu^2`, `eps*A^2`.
    pub variable: Monomial,
    /// The highest power of it in the series.
    pub highest: usize,
    /// The singularity on the circle of convergence.
    pub nearest: Singularity,
}

impl Convergence {
    /// The variable as an expression.
    pub fn variable_in_words(&self) -> String {
        Expr::from(&Polynomial::term(self.variable.clone(), Rational::one())).to_string()
    }

    /// The one symbol in the variable and the size up to which the series converges in it, where
    /// there is but one.
    pub fn in_symbol(&self) -> Option<(Symbol, Estimate)> {
        let [(symbol, power)] = *self.variable.factors() else {
            return None;
        };
        let degree = u32::try_from(power).ok().filter(|power| *power > 0)?;
        let Estimate { value, error } = &self.nearest.radius;
        let root = root(value, degree)?;
        let slope = to_f64(&root) / to_f64(value) / f64::from(degree);
        Some((symbol, Estimate::rounded(&root, error * slope)))
    }

    /// The singularity, or the pair: `mu^2 = 3.42 e^(+-1.79i)`.
    fn singularity_in_words(&self) -> String {
        let Singularity { radius, angle, .. } = &self.nearest;
        let (variable, radius) = (self.variable_in_words(), radius.to_string());
        match self.nearest.sign() {
            Some(Ordering::Less) => format!("{variable} = -{radius}"),
            Some(_) => format!("{variable} = {radius}"),
            None => format!("{variable} = {radius} e^(+-{angle}i)"),
        }
    }

    /// The kind of singularity in words.
    fn kind(&self) -> String {
        let Some(exponent) = &self.nearest.exponent else {
            return String::new();
        };
        match &exponent.value {
            value if value.is_zero() => ", a logarithm of the period".to_owned(),
            value if *value == ratio(1, 2) => ", a square root".to_owned(),
            _ => format!(", where the period goes like the power {exponent} of the distance"),
        }
    }
}

/// A root of a positive number, to more digits than its estimate has.
fn root(value: &Rational, degree: u32) -> Option<Rational> {
    const DIGITS: u32 = 400;
    if degree == 1 {
        return Some(value.clone());
    }
    let ten = Integer::from(10);
    let scaled = (value * Rational::from_integer(ten.pow(DIGITS * degree))).to_integer();
    (scaled > Integer::zero()).then(|| Rational::new(scaled.nth_root(degree), ten.pow(DIGITS)))
}

impl fmt::Display for Convergence {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (name, size) = match self.in_symbol() {
            Some((symbol, size)) => (symbol.to_string(), size),
            None => (self.variable_in_words(), self.nearest.radius.clone()),
        };
        write!(
            formatter,
            "the series converges for |{name}| < {}: by {} coefficients the nearest singularity is at {}{}; error about {}",
            size,
            self.highest,
            self.singularity_in_words(),
            self.kind(),
            significant(self.nearest.radius.error, 1)
        )
    }
}
