//! The small terms in averaging: all terms but the linear restoring force.
//!
//! ```text
//! x'' + 2 zeta x' + x + eps x^3 = 0       zeta -> delta zeta, eps -> delta eps; delta = 1
//! x'' + 2 zeta x' + sin(x) = 0            x'' + x + delta (2 zeta x' + sin(x) - x) = 0; delta = 1
//! ```
//!
//! Parameters are small if their vanishing leaves the linear restoring force alone; each must be a
//! factor of the terms that it makes small. If no parameters do that, all other terms are small
//! together.

use std::collections::BTreeMap;

use crate::exact::Rational;
use crate::expr::{Expr, ExprError};
use crate::method::{Options, Refusal};
use crate::oscillator::corner::near_rest;
use crate::oscillator::{Oscillator, OscillatorError, PerturbedForce, SmallParameter};
use crate::series::taylor::taylor;
use crate::symbol::{Symbol, fresh};
use num_traits::Zero as _;

/// The force with the small terms multiplied by `delta`.
pub(super) struct SmallTerms {
    marked: Oscillator,
    delta: Symbol,
    letters: Vec<Symbol>,
    linear: Expr,
}

impl SmallTerms {
    /// Splits a force, by the small parameter that is asked for and the others that are needed with
    /// it.
    ///
    /// # Errors
    /// A parameter that does not occur, or a term that no parameter makes small together with the
    /// one asked for.
    pub(super) fn from_oscillator(
        oscillator: &Oscillator,
        options: &Options,
    ) -> Result<Self, Refusal> {
        let delta = fresh("delta", &oscillator.names());
        let expanded = oscillator.force.expand()?;
        let asked = match options.small.as_deref() {
            None => None,
            name => Some(oscillator.small_parameter(name)?),
        };
        let first = match asked {
            Some(SmallParameter::Parameter(name)) => Some(name),
            _ => None,
        };
        let is_linear = |term: &&Expr| coefficient_of_linear(term, oscillator).is_some();
        let (linear, others): (Vec<&Expr>, Vec<&Expr>) = expanded
            .terms()
            .iter()
            .partition(|term| is_linear(term) && first.is_none_or(|name| !term.contains(name)));
        let x = oscillator.coordinate;
        // A term such as x/sqrt(1 - x'^2) has a linear part that restores.
        let slopes = others.iter().filter_map(|term| {
            let slow = term.substitute(oscillator.velocity(), &Expr::zero()).ok()?;
            let (beside, _) = near_rest(&slow, x).ok()?;
            let series = taylor(&beside, &[(x, Rational::zero())], 1).ok()?;
            series.get(1).cloned()
        });
        let slopes: Vec<Expr> = slopes.collect();
        // If a function alone restores, as in k*sin(x), its coefficient is not small: without it
        // there is no restoring force.
        let function_restores =
            linear.is_empty() && !Expr::sum(slopes.iter().cloned()).expand()?.is_zero();
        let found = match asked {
            Some(SmallParameter::Amplitude) => Err(None),
            _ if function_restores => {
                let mut left =
                    others.iter().filter(|term| first.is_none_or(|name| !term.contains(name)));
                Err(left.next().map(|&term| term.clone()))
            }
            _ => letters(&linear, &others, &oscillator.parameters, first).map_err(Some),
        };
        if let (Some(name), Err(Some(term))) = (first, &found) {
            return Err(OscillatorError::NotSmall {
                term: term.clone().into(),
                small: name.to_string(),
            }
            .into());
        }
        let mut split = Self {
            marked: oscillator.clone(),
            delta,
            letters: vec![],
            linear: Expr::sum(linear.iter().map(|term| (*term).clone())),
        };
        split.marked.parameters.push(delta);
        if let Ok(letters) = found {
            let scaled = letters.iter().map(|&name| (name, &Expr::from(delta) * &Expr::from(name)));
            let scaled: BTreeMap<Symbol, Expr> = scaled.collect();
            split.marked.force = expanded.substitute_all(&scaled)?;
            split.letters = letters;
            // A parameter may also occur where the force has no expansion in it.
            if split.first_order().is_ok() {
                return Ok(split);
            }
            split.letters.clear();
        }
        split.linear = Expr::sum(linear.into_iter().cloned().chain(slopes)).expand()?;
        let rest = (&expanded - &split.linear).expand()?;
        split.marked.force = &split.linear + &(&Expr::from(delta) * &rest);
        Ok(split)
    }

    /// The bookkeeping parameter, which is one in the end.
    pub(super) fn delta(&self) -> Symbol {
        self.delta
    }

    /// The small parameters; empty if all terms but the linear one are small together.
    pub(super) fn letters(&self) -> &[Symbol] {
        &self.letters
    }

    /// The force as a polynomial in powers of `delta`.
    ///
    /// # Errors
    /// The force is not a polynomial, or there is no restoring force.
    pub(super) fn expand(&self, order: u32) -> Result<PerturbedForce, OscillatorError> {
        self.marked.expand(SmallParameter::Parameter(self.delta), order)
    }

    /// The linear restoring force alone.
    ///
    /// # Errors
    /// There is no restoring force.
    pub(super) fn linear_part(&self) -> Result<PerturbedForce, OscillatorError> {
        let mut alone = self.marked.clone();
        alone.force = self.linear.clone();
        alone.expand(SmallParameter::Parameter(self.delta), 0)
    }

    /// The terms of first order.
    ///
    /// # Errors
    /// There is no series in `delta`.
    pub(super) fn first_order(&self) -> Result<Expr, OscillatorError> {
        let series = taylor(&self.marked.force, &[(self.delta, Rational::zero())], 1)?;
        let first = series.get(1).cloned().unwrap_or_else(Expr::zero);
        let first = first.substitute(self.delta, &Expr::one())?;
        Ok(first.expand()?)
    }

    /// All small terms.
    ///
    /// # Errors
    /// The terms would be too long.
    pub(super) fn without_linear(&self) -> Result<Expr, ExprError> {
        let whole = self.marked.force.substitute(self.delta, &Expr::one())?;
        (&whole - &self.linear).expand()
    }
}

/// The coefficient of the coordinate in a term that is linear in it; `None` for any other term.
fn coefficient_of_linear(term: &Expr, oscillator: &Oscillator) -> Option<Expr> {
    let quotient = Expr::divide(term, &Expr::from(oscillator.coordinate)).ok()?;
    let own = [oscillator.coordinate, oscillator.velocity(), Symbol::new("t")];
    own.iter().all(|&name| !quotient.contains(name)).then_some(quotient)
}

/// Parameters of which one is a factor of each small term and none of a linear one, `first` among
/// them. Each step adds the parameter that is a factor of most of the remaining terms; of equally
/// good ones a Greek one, the first in alphabetical order. The error is a term without such a
/// factor.
pub(super) fn letters(
    linear: &[&Expr],
    others: &[&Expr],
    parameters: &[Symbol],
    first: Option<Symbol>,
) -> Result<Vec<Symbol>, Expr> {
    let has = |term: &Expr, name: Symbol| {
        let (_, factors) = term.factors();
        factors.iter().any(|factor| {
            let (base, exponent) = factor.base_and_exponent();
            let positive = exponent
                .as_number()
                .is_some_and(|number| number.is_integer() && *number > Rational::zero());
            base.as_symbol() == Some(name) && positive
        })
    };
    let mut chosen: Vec<Symbol> = first.into_iter().collect();
    let mut left: Vec<&Expr> =
        others.iter().copied().filter(|term| !chosen.iter().any(|&name| has(term, name))).collect();
    while let Some(&term) = left.first() {
        let free = parameters.iter().copied();
        let candidates = free.filter(|&name| !linear.iter().any(|term| term.contains(name)));
        let taken = |name: Symbol| left.iter().filter(|term| has(term, name)).count();
        let best =
            candidates.max_by_key(|&name| (taken(name), name.is_greek(), std::cmp::Reverse(name)));
        let Some(best) = best.filter(|&name| taken(name) > 0) else {
            return Err(term.clone());
        };
        left.retain(|term| !has(term, best));
        chosen.push(best);
    }
    chosen.sort();
    Ok(chosen)
}
