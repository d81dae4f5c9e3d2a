//! The derivation of an answer as on paper: the orders of an expansion, and lines of words and
//! equations.
//!
//! In: what a method did, in its order. Out: [`Step`]s and [`DerivationLine`]s for every format to
//! lay out.
//!
//! Text and LaTeX are printed from the same formulas.

use std::collections::BTreeSet;
use std::fmt;

use crate::exact::{POLYNOMIALS, Polynomial, Polynomials, Rational};
use crate::expr::{Expr, Inside};
use crate::series::FourierSeries;
use crate::series::terms::{self, Notation};
use crate::symbol::Symbol;

/// One order of an expansion, `y_n'' + y_n = right_side + (resonance + W_n) cos(theta)`, in units
/// of the amplitude and of the linear frequency (of omega in homotopy perturbation). Every part
/// carries its power of the small parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// The order `n`; at order zero there is no force, and `y_0 = cos(theta)`.
    pub order: u32,
    /// The coefficient of the secular `cos(theta)` that the nonlinear terms leave.
    pub resonance: Polynomial,
    /// `W_n`, which the secular condition fixes.
    pub correction: Polynomial,
    /// The conditions that fix the homogeneous solution.
    pub conditions: Vec<Condition>,
    /// `y_n`.
    pub displacement: FourierSeries<Polynomials>,
    /// Limit cycles: what fixes the amplitude of `y_n`.
    pub amplitude: Option<AmplitudeCondition>,
}

impl Step {
    /// `y_n'' + y_n`, the forcing of the n-th order without its secular term.
    pub fn right_side(&self) -> FourierSeries<Polynomials> {
        self.displacement.derivative().derivative().sum(&self.displacement)
    }
}

/// A condition that fixes a homogeneous solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Condition {
    /// `y_n(0)` has this value.
    Position(i64),
    /// `y_n'(0) = 0`.
    AtRest,
    /// `y_n` has no `cos(theta)`.
    NoCosine,
    /// `y_n` has no `sin(theta)`.
    NoSine,
}

/// The secular sine of the next order set to zero, which fixes the `cos(theta)` part of `y_n`
/// (`a0`, `B1`, `B2`, ...).
#[derive(Clone, Debug, PartialEq)]
pub struct AmplitudeCondition {
    /// The coefficient of the secular `sin(theta)`, which must vanish.
    pub sine: Polynomial,
    /// The amplitude in it.
    pub unknown: Symbol,
    /// Its value.
    pub value: Expr,
}

/// One line of a derivation: words, an equation, or an equation with the reason for it.
#[derive(Clone, Debug, PartialEq)]
pub struct DerivationLine {
    /// The step in words; may be empty.
    pub words: String,
    /// Formulas that are equal, from left to right; may be empty.
    pub equal: Vec<DerivationFormula>,
}

/// A part of a line: an expression, or a formula that the grammar of expressions cannot write.
#[derive(Clone, Debug, PartialEq)]
pub enum DerivationFormula {
    /// An expression.
    Expression(Expr),
    /// A motion or a force along it.
    Waves {
        /// The harmonics.
        series: FourierSeries<Polynomials>,
        /// The name of the phase.
        phase: Symbol,
    },
    /// A sum of derivatives, each times a factor: `y'' + square*y`, derivatives in theta or, with
    /// `square` = omega^2, in time.
    Linear(Vec<DerivativeTerm>),
    /// `y(0)`, or `y'(0)`.
    AtZero {
        /// `y`.
        of: Symbol,
        /// The number of derivatives.
        derivatives: usize,
    },
    /// `factor * int_from^to integrand d(variable)`.
    Integral {
        /// The factor in front of the integral.
        factor: Expr,
        /// The lower end.
        from: Expr,
        /// The upper end.
        to: Expr,
        /// The integrand.
        integrand: Box<Self>,
        /// The variable of integration.
        variable: Symbol,
    },
    /// `numerator/sqrt(inside)`.
    OverRoot(Expr, Box<Self>),
    /// `factor * d(of)/d(by)`.
    Slope {
        /// The factor in front of the derivative.
        factor: Expr,
        /// The dependent variable.
        of: Symbol,
        /// The variable of differentiation.
        by: Symbol,
    },
}

/// A derivative times a factor.
#[derive(Clone, Debug, PartialEq)]
pub struct DerivativeTerm {
    /// The factor.
    pub factor: Expr,
    /// The function.
    pub of: Symbol,
    /// The number of its derivatives.
    pub derivatives: usize,
}

impl DerivationLine {
    /// Words alone.
    pub fn words(words: impl Into<String>) -> Self {
        Self { words: words.into(), equal: vec![] }
    }

    /// Formulas that are equal.
    pub fn equal(formulas: impl IntoIterator<Item = DerivationFormula>) -> Self {
        Self { words: String::new(), equal: formulas.into_iter().collect() }
    }

    /// An equation between two expressions.
    pub fn equation(
        left: impl Into<DerivationFormula>,
        right: impl Into<DerivationFormula>,
    ) -> Self {
        Self::equal([left.into(), right.into()])
    }

    /// The line with every number of its formulas changed; an expression that has no value then
    /// stays as it is.
    #[must_use]
    pub fn with_numbers(&self, change: &dyn Fn(&Rational) -> Rational) -> Self {
        Self {
            words: self.words.clone(),
            equal: self.equal.iter().map(|formula| formula.with_numbers(change)).collect(),
        }
    }

    /// Returns the line with this name of the phase in its Fourier series, and in its words, where
    /// `θ` stands for it.
    pub(crate) fn with_phase(mut self, name: Symbol) -> Self {
        self.words = self.words.replace('θ', name.name());
        for formula in &mut self.equal {
            if let DerivationFormula::Waves { phase, .. } = formula {
                *phase = name;
            }
        }
        self
    }

    /// Returns this line with words in front of it.
    pub fn because(self, words: impl Into<String>) -> Self {
        Self { words: words.into(), ..self }
    }

    /// The names in its formulas.
    pub fn symbols(&self) -> BTreeSet<Symbol> {
        self.equal.iter().flat_map(DerivationFormula::symbols).collect()
    }
}

impl DerivationFormula {
    /// `y'' + square*y`.
    pub fn oscillator(of: Symbol, square: Expr) -> Self {
        let term = |factor, derivatives| DerivativeTerm { factor, of, derivatives };
        Self::Linear(vec![term(Expr::one(), 2), term(square, 0)])
    }

    fn with_numbers(&self, change: &dyn Fn(&Rational) -> Rational) -> Self {
        let changed = |expression: &Expr| {
            expression.with_numbers(change).unwrap_or_else(|_| expression.clone())
        };
        match self {
            Self::Expression(expression) => Self::Expression(changed(expression)),
            Self::Waves { series, phase } => Self::Waves {
                series: series.map(POLYNOMIALS, |coefficient, _| coefficient.map(change)),
                phase: *phase,
            },
            Self::Linear(terms) => {
                let terms = terms.iter();
                let changed = terms
                    .map(|term| DerivativeTerm { factor: changed(&term.factor), ..term.clone() });
                Self::Linear(changed.collect())
            }
            Self::Integral { factor, from, to, integrand, variable } => Self::Integral {
                factor: changed(factor),
                from: changed(from),
                to: changed(to),
                integrand: Box::new(integrand.with_numbers(change)),
                variable: *variable,
            },
            Self::OverRoot(numerator, inside) => {
                Self::OverRoot(changed(numerator), Box::new(inside.with_numbers(change)))
            }
            Self::Slope { factor, of, by } => {
                Self::Slope { factor: changed(factor), of: *of, by: *by }
            }
            Self::AtZero { .. } => self.clone(),
        }
    }

    /// The names in it, those that are integrated over included.
    pub fn symbols(&self) -> BTreeSet<Symbol> {
        match self {
            Self::Expression(expression) => expression.symbols(),
            Self::Waves { series, .. } => {
                series.numerators().flat_map(Polynomial::symbols).collect()
            }
            Self::Linear(terms) => {
                let each = terms.iter();
                each.flat_map(|term| term.factor.symbols().into_iter().chain([term.of])).collect()
            }
            Self::AtZero { of, .. } => [*of].into(),
            Self::Integral { factor, from, to, integrand, variable } => {
                let ends = [factor, from, to].into_iter().flat_map(Expr::symbols);
                ends.chain(integrand.symbols()).chain([*variable]).collect()
            }
            Self::OverRoot(numerator, inside) => {
                numerator.symbols().into_iter().chain(inside.symbols()).collect()
            }
            Self::Slope { factor, of, by } => {
                factor.symbols().into_iter().chain([*of, *by]).collect()
            }
        }
    }
}

impl From<Expr> for DerivationFormula {
    fn from(expression: Expr) -> Self {
        Self::Expression(expression)
    }
}

impl From<&Expr> for DerivationFormula {
    fn from(expression: &Expr) -> Self {
        Self::Expression(expression.clone())
    }
}

impl From<&str> for DerivationFormula {
    /// A name.
    fn from(name: &str) -> Self {
        Self::Expression(Expr::symbol(name))
    }
}

impl From<Symbol> for DerivationFormula {
    fn from(name: Symbol) -> Self {
        Self::Expression(Expr::from(name))
    }
}

impl From<&Polynomial> for DerivationFormula {
    fn from(polynomial: &Polynomial) -> Self {
        FourierSeries::constant(POLYNOMIALS, polynomial.clone()).into()
    }
}

impl From<FourierSeries<Polynomials>> for DerivationFormula {
    fn from(series: FourierSeries<Polynomials>) -> Self {
        Self::Waves { series, phase: Symbol::new("theta") }
    }
}

/// Harmonics as they are typed: `cos(3*theta)`.
pub const NOTATION: Notation = Notation {
    wave: |function, k, phase| match k {
        1 => format!("{function}({phase})"),
        _ => format!("{function}({k}*{phase})"),
    },
    times: "*",
    brackets: ["(", ")"],
};

impl fmt::Display for DerivationLine {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.words)?;
        if !self.words.is_empty() && !self.equal.is_empty() {
            formatter.write_str(":  ")?;
        }
        for (index, formula) in self.equal.iter().enumerate() {
            let sign = if index == 0 { "" } else { " = " };
            write!(formatter, "{sign}{formula}")?;
        }
        Ok(())
    }
}

impl fmt::Display for DerivationFormula {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Expression(expression) => write!(formatter, "{expression}"),
            Self::Waves { series, phase } => {
                let waves = terms::waves(series, ToString::to_string, &NOTATION, *phase);
                formatter.write_str(&terms::sum(waves))
            }
            Self::Linear(terms) => {
                let each = terms.iter().map(|DerivativeTerm { factor, of, derivatives }| {
                    let primes = "'".repeat(*derivatives);
                    (factor * &Expr::symbol(&format!("{of}{primes}"))).to_string()
                });
                formatter.write_str(&terms::sum(each))
            }
            Self::AtZero { of, derivatives } => {
                write!(formatter, "{of}{}(0)", "'".repeat(*derivatives))
            }
            Self::Integral { factor, from, to, integrand, variable } => {
                let end = |end: &Expr| match end.symbols().is_empty() && end.terms().len() < 2
                    || end.as_symbol().is_some()
                {
                    true => end.to_string(),
                    false => format!("({end})"),
                };
                let inside = match integrand.as_ref() {
                    Self::Expression(sum) if sum.terms().len() > 1 => format!("({})", Inside(sum)),
                    other => other.to_string(),
                };
                write!(
                    formatter,
                    "{}int_{}^{} {inside} d{variable}",
                    before(factor),
                    end(from),
                    end(to)
                )
            }
            Self::OverRoot(numerator, inside) => {
                let numerator = bracketed(numerator);
                match inside.as_ref() {
                    Self::Expression(inside) => {
                        write!(formatter, "{numerator}/sqrt({})", Inside(inside))
                    }
                    inside => write!(formatter, "{numerator}/sqrt({inside})"),
                }
            }
            Self::Slope { factor, of, by } => write!(formatter, "{}d{of}/d{by}", before(factor)),
        }
    }
}

/// A factor in front of something that is not an expression.
fn before(factor: &Expr) -> String {
    match *factor == Expr::one() {
        true => String::new(),
        false => format!("{}*", bracketed(factor)),
    }
}

fn bracketed(factor: &Expr) -> String {
    match factor.terms().len() > 1 || !factor.fraction().denominator.is_empty() {
        true => format!("({})", Inside(factor)),
        false => factor.to_string(),
    }
}
