//! The force as a linear one and terms that vanish with a small parameter, for perturbation
//! methods.

use std::collections::BTreeMap;

use num_traits::Zero;

use super::corner::near_rest;
use super::{Oscillator, OscillatorError, SmallParameter, at_rest};
use crate::exact::polynomial::Monomial;
use crate::exact::{Polynomial, Rational};
use crate::expr::Expr;
use crate::series::taylor::taylor;
use crate::solution::Definition;
use crate::symbol::letters::AMPLITUDE;
use crate::symbol::{Symbol, fresh, fresh_stem};

/// One term `delta^order * coefficient * x^position * x'^velocity` of the force.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// Power of the small parameter, at least one.
    pub order: usize,
    /// Power of the coordinate.
    pub position: u32,
    /// Power of the velocity.
    pub velocity: u32,
    /// The rest, in the parameters; the small parameter itself is left out.
    pub coefficient: Polynomial,
}

/// The force as `omega0^2 x` and terms that vanish with the small parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct PerturbedForce {
    /// `omega0^2`.
    pub linear: Polynomial,
    /// All other terms up to the order asked for.
    pub terms: Vec<Term>,
    /// Constants that are no polynomials and were given names.
    pub definitions: Vec<Definition>,
}

impl Oscillator {
    /// The force up to `delta^order`, about the equilibrium `x = 0`.
    ///
    /// # Errors
    /// A force at rest, a missing linear restoring force, or a term that is not small, not analytic
    /// or no polynomial.
    ///
    /// ```
    /// # use lindstedt_oscillator as lindstedt;
    /// use lindstedt::{Oscillator, oscillator::SmallParameter};
    ///
    /// let pendulum = Oscillator::parse("x'' + sin(x) = 0")?;
    /// let force = pendulum.expand(SmallParameter::Amplitude, 4)?;
    /// let powers: Vec<_> = force.terms.iter().map(|term| (term.order, term.position)).collect();
    /// assert_eq!(powers, [(2, 3), (4, 5)]); // -x^3/6 + x^5/120
    /// # Ok::<(), lindstedt::oscillator::OscillatorError>(())
    /// ```
    pub fn expand(
        &self,
        small: SmallParameter,
        order: u32,
    ) -> Result<PerturbedForce, OscillatorError> {
        let force = self.expand_with_any_stiffness(small, order)?;
        if force.lacks_restoring_force() {
            let linear = &force.linear_in_full() * &Expr::from(self.coordinate);
            return Err(OscillatorError::NoRestoringForce(linear));
        }
        Ok(force)
    }

    /// As [`Oscillator::expand`], for methods that need no linear restoring force.
    ///
    /// # Errors
    /// A force at rest, or a term that is not small, not analytic or no polynomial.
    pub fn expand_with_any_stiffness(
        &self,
        small: SmallParameter,
        order: u32,
    ) -> Result<PerturbedForce, OscillatorError> {
        let (position, velocity) = (self.coordinate, self.velocity());
        let force = match small {
            SmallParameter::Parameter(_) => self.force.clone(),
            SmallParameter::Amplitude => near_rest(&self.force, position)?.0,
        };
        let at_rest = at_rest(&force, position).and_then(|force| force.expand());
        if let Ok(force) = at_rest
            && !vanishes_identically(&force)
        {
            return Err(OscillatorError::NoEquilibrium(force.to_string()));
        }
        let zero = Rational::zero();
        let (parts, first) = match small {
            SmallParameter::Parameter(name) => (taylor(&force, &[(name, zero)], order)?, 0),
            SmallParameter::Amplitude => (
                taylor(
                    &force,
                    &[(position, zero.clone()), (velocity, zero)],
                    order.saturating_add(1),
                )?,
                1,
            ),
        };
        // Where a singularity is removable the force at rest is known by its series alone.
        if let (SmallParameter::Amplitude, Some(at_rest)) = (small, parts.first())
            && !vanishes_identically(at_rest)
        {
            let moves = at_rest.contains(position) || at_rest.contains(velocity);
            return Err(match moves {
                true => OscillatorError::NotPolynomial(at_rest.clone().into()),
                false => OscillatorError::NoEquilibrium(at_rest.to_string()),
            });
        }
        let mut names = NamedConstants::new(self);
        let mut linear = Polynomial::zero();
        let mut terms = Vec::new();
        for (power, part) in parts.iter().enumerate().skip(first) {
            let mut name = |constant: &Expr| names.symbol_of(constant, &[position, velocity]);
            let Some(polynomial) = part.to_polynomial(&mut name)? else {
                return Err(OscillatorError::NotPolynomial(part.clone().into()));
            };
            for (monomial, coefficient) in polynomial.terms() {
                let named =
                    || Expr::from(&Polynomial::term(monomial.clone(), coefficient.clone())).into();
                let exponent = |symbol| u32::try_from(monomial.exponent(symbol));
                let (Ok(p), Ok(q)) = (exponent(position), exponent(velocity)) else {
                    return Err(OscillatorError::NotPolynomial(named()));
                };
                let mut rest = monomial.without(position).without(velocity);
                if let SmallParameter::Parameter(name) = small {
                    rest = rest.without(name);
                }
                let coefficient = Polynomial::term(rest, coefficient.clone());
                match (power - first, p, q) {
                    (0, 1, 0) => linear.accumulate(&coefficient),
                    (0, ..) => {
                        let small = match small {
                            SmallParameter::Parameter(name) => name.to_string(),
                            SmallParameter::Amplitude => AMPLITUDE.to_string(),
                        };
                        return Err(OscillatorError::NotSmall { term: named(), small });
                    }
                    (order, position, velocity) => {
                        terms.push(Term { order, position, velocity, coefficient })
                    }
                }
            }
        }
        Ok(PerturbedForce { linear, terms: merged(terms), definitions: names.definitions })
    }
}

/// Terms with equal powers added up, so that each product of the equation occurs once.
fn merged(terms: Vec<Term>) -> Vec<Term> {
    let mut merged: Vec<Term> = Vec::with_capacity(terms.len());
    for term in terms {
        let key = |term: &Term| (term.order, term.position, term.velocity);
        match merged.iter_mut().find(|known| key(known) == key(&term)) {
            Some(known) => known.coefficient.accumulate(&term.coefficient),
            None => merged.push(term),
        }
    }
    merged
}

/// Whether a constant is zero however it is written, as `sin(c)/cos(c) - tan(c)` is: where
/// expanding it does not show that, numbers for its parameters are tried.
fn vanishes_identically(constant: &Expr) -> bool {
    if constant.is_zero() || constant.expand().is_ok_and(|constant| constant.is_zero()) {
        return true;
    }
    let symbols = constant.symbols();
    let tried = [0.137, 0.731, 1.913].map(|scale| {
        let places = symbols.iter().zip(1_u32..);
        let numbers: BTreeMap<Symbol, f64> =
            places.map(|(name, k)| (*name, scale / f64::from(k).sqrt())).collect();
        constant.evaluate_rounded(&|name| Some((*numbers.get(&name)?, 0.0)))
    });
    // Some of the values tried may lie outside its domain.
    let known = tried.into_iter().flatten().filter(|(value, _)| value.is_finite());
    let known: Vec<bool> = known.map(|(value, error)| value.abs() <= error).collect();
    !symbols.is_empty() && known.len() > 1 && known.iter().all(|zero| *zero)
}

/// Names for constants that are no polynomials.
pub(super) struct NamedConstants {
    taken: Vec<Symbol>,
    definitions: Vec<Definition>,
}

impl NamedConstants {
    pub(super) fn new(oscillator: &Oscillator) -> Self {
        Self { taken: oscillator.names(), definitions: vec![] }
    }

    /// The symbol of `constant`, unless one of `variables` occurs in it.
    pub(super) fn symbol_of(&mut self, constant: &Expr, variables: &[Symbol]) -> Option<Symbol> {
        if variables.iter().any(|&variable| constant.contains(variable))
            || constant.contains(Symbol::new("t"))
        {
            return None;
        }
        if let Some(known) =
            self.definitions.iter().find(|definition| definition.meaning == *constant)
        {
            return Some(known.symbol);
        }
        let stem = fresh_stem("c", &self.taken);
        let symbol = Symbol::new(&format!("{stem}{}", self.definitions.len() + 1));
        self.definitions.push(Definition { symbol, meaning: constant.clone() });
        Some(symbol)
    }
}

impl PerturbedForce {
    /// The linear frequency as a single term: a fraction, a product of powers of parameters, or a
    /// symbol with its definition, `omega0` where `names` leave it free.
    pub fn linear_frequency(&self, names: &[Symbol]) -> (Polynomial, Option<Definition>) {
        if let Some(root) = self.linear.single_term_root() {
            return (root, None);
        }
        let symbol = fresh("omega0", names);
        // Negative numbers were refused; nothing else under the root is known to be negative.
        let linear = self.linear_in_full();
        let meaning = linear.sqrt().unwrap_or(linear);
        (
            Polynomial::term(Monomial::power_of(symbol, 1), num_traits::One::one()),
            Some(Definition { symbol, meaning }),
        )
    }

    /// Writes the terms in powers of the linear frequency where a parameter under its root is left
    /// in none of them: of `omega0^2 = g/L` and `g*sin(x)/L` all that is left is `omega0^2 sin(x)`.
    pub(crate) fn write_with_frequency(&mut self, names: &[Symbol]) {
        let (_, Some(root)) = self.linear_frequency(names) else {
            return;
        };
        for letter in self.letters_under_root() {
            let terms = self.terms.iter();
            let written =
                terms.map(|term| self.with_frequency(&term.coefficient, letter, root.symbol));
            if let Some(written) = written.collect::<Option<Vec<Polynomial>>>() {
                for (term, coefficient) in self.terms.iter_mut().zip(written) {
                    term.coefficient = coefficient;
                }
                return;
            }
        }
    }

    /// The parameters of a linear coefficient that is a single product.
    fn letters_under_root(&self) -> Vec<Symbol> {
        let product = self.linear.single_term();
        product.map_or_else(Vec::new, |(monomial, _)| {
            monomial.factors().iter().map(|(symbol, _)| *symbol).collect()
        })
    }

    /// A coefficient that belongs to the force, written as its [terms](Self::write_with_frequency)
    /// are, where that can be done.
    pub(crate) fn written_with_frequency(
        &self,
        coefficient: Polynomial,
        names: &[Symbol],
    ) -> Polynomial {
        let (_, Some(root)) = self.linear_frequency(names) else {
            return coefficient;
        };
        let mut letters = self.letters_under_root().into_iter();
        let written =
            letters.find_map(|letter| self.with_frequency(&coefficient, letter, root.symbol));
        written.unwrap_or(coefficient)
    }

    /// The coefficient with `letter` eliminated in favour of the linear frequency; `None` if
    /// another parameter of the linear coefficient would have a higher power than before.
    fn with_frequency(
        &self,
        coefficient: &Polynomial,
        letter: Symbol,
        frequency: Symbol,
    ) -> Option<Polynomial> {
        let (linear, number) = self.linear.single_term()?;
        let unit = linear.exponent(letter);
        let mut written = Polynomial::zero();
        for (monomial, own) in coefficient.terms() {
            let power = monomial.exponent(letter) / unit;
            let rest = monomial.product(&linear.power(-power));
            let more =
                |symbol: Symbol| rest.exponent(symbol).abs() > monomial.exponent(symbol).abs();
            if rest.exponent(letter) != 0
                || linear.factors().iter().any(|(symbol, _)| more(*symbol))
            {
                return None;
            }
            let scale = num_traits::pow::Pow::pow(number, -power);
            written.add_term(rest.product(&Monomial::power_of(frequency, 2 * power)), own * scale);
        }
        Some(written)
    }

    /// The coefficient of the linear force, its named constants written out.
    pub(crate) fn linear_in_full(&self) -> Expr {
        let linear = Expr::from(&self.linear);
        let meanings = self.definitions.iter().map(|entry| (entry.symbol, entry.meaning.clone()));
        linear.substitute_all(&meanings.collect()).unwrap_or(linear)
    }

    /// Whether the linear force is known not to restore: nothing, a negative number, or a negative
    /// multiple of one product of parameters, which are taken to be positive.
    fn lacks_restoring_force(&self) -> bool {
        /// The size, relative to its terms, below which a sum of constants is zero but for
        /// rounding.
        const ROUNDING: f64 = 1e-14;
        let named = |symbol: &Symbol| self.definitions.iter().any(|entry| entry.symbol == *symbol);
        let parameters: Vec<Symbol> =
            self.linear.symbols().into_iter().filter(|name| !named(name)).collect();
        if self.linear.is_zero() || (!parameters.is_empty() && self.linear.single_term().is_none())
        {
            return self.linear.is_zero();
        }
        let full = self.linear_in_full();
        // Inside a function, as in cos(2*x_e), a parameter may make either sign.
        let not_positive = |value: f64| {
            let numbers = parameters.iter().map(|name| (*name, value)).collect();
            let terms = full.terms().iter();
            let size: f64 =
                terms.filter_map(|term| Some(term.evaluate(&numbers).ok()?.abs())).sum();
            full.evaluate(&numbers).ok().map(|found| found <= ROUNDING * size)
        };
        let known: Vec<bool> = [1.0, 0.1, 0.37, 2.3].into_iter().filter_map(not_positive).collect();
        !known.is_empty() && known.iter().all(|not| *not)
    }
}
