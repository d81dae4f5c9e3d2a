//! Self-excited equations without one parameter whose vanishing leaves `x'' + omega0^2 x`:
//! everything else is taken small together.
//!
//! Reference: A. H. Nayfeh and D. T. Mook, *Nonlinear Oscillations*, Wiley 1979, section 2.3 (one
//! bookkeeping parameter for damping and nonlinearity).
//!
//! ```text
//! x'' + x - mu (1 - x^2) x' + eps x^3 = 0     mu -> delta mu, eps -> delta eps; expanded in delta; delta = 1
//! x'' + x - (1 - x^2) x'/10 = 0               x'' + x - delta (1 - x^2) x' = 0, expanded in delta; delta = 1/10
//! ```
//!
//! This neglects no term: it only states which terms count as equally small. If the parameters are
//! small in other proportions, each term of the result is still correct.

use std::collections::BTreeMap;

use num_traits::{One, Signed};

use crate::exact::Rational;
use crate::expr::{Expr, ExprError};
use crate::oscillator::{Oscillator, Parts, PerturbedForce, SmallParameter};
use crate::symbol::{Symbol, fresh};

/// A force expanded in a bookkeeping parameter.
pub(super) struct JointExpansion {
    /// The force in powers of `delta`.
    pub force: PerturbedForce,
    /// The bookkeeping parameter, which is no parameter of the equation.
    pub delta: Symbol,
    /// Its value where numbers stand before the terms; otherwise it is one, and `parameters` are
    /// small.
    pub value: Option<Rational>,
    /// The parameters of the equation that are small.
    pub parameters: Vec<Symbol>,
}

/// Expands to `delta^order`; `None` if no linear restoring force is left or a term is not a
/// polynomial.
pub(super) fn expand_jointly(
    oscillator: &Oscillator,
    parts: &Parts,
    small: SmallParameter,
    order: u32,
) -> Option<JointExpansion> {
    let terms: Vec<Expr> = [&parts.restoring, &parts.inertia, &parts.damping]
        .into_iter()
        .filter(|part| !part.is_zero())
        .flat_map(|part| part.terms().to_vec())
        .collect();
    let asked: Vec<Symbol> = match small {
        SmallParameter::Parameter(name) => vec![name],
        SmallParameter::Amplitude => vec![],
    };
    let is_linear = |term: &Expr| stays_linear(term, oscillator).unwrap_or(false);
    let (linear, others): (Vec<Expr>, Vec<Expr>) = terms
        .into_iter()
        .partition(|term| is_linear(term) && !asked.iter().any(|&name| term.contains(name)));
    let delta = fresh("delta", &oscillator.names());
    let marked = |expression: &Expr| &Expr::from(delta) * expression;
    let mut parameters = asked.clone();
    let with_letters = small_parameters(&linear, &others, oscillator, &mut parameters);
    let (force, value) = match with_letters {
        true => {
            let scaled: BTreeMap<Symbol, Expr> =
                parameters.iter().map(|&name| (name, marked(&Expr::from(name)))).collect();
            (oscillator.force.substitute_all(&scaled).ok()?, None)
        }
        false => {
            // The coefficient of the first damping term is the small factor, if no parameter is.
            let value = match asked.is_empty() {
                true => parts.damping.terms().first()?.factors().0.abs(),
                false => Rational::one(),
            };
            parameters = asked;
            let scaled: BTreeMap<Symbol, Expr> =
                parameters.iter().map(|&name| (name, marked(&Expr::from(name)))).collect();
            let factor = marked(&Expr::number(value.recip()));
            let small_term = |term: &Expr| {
                let scaled = term.substitute_all(&scaled)?;
                Ok(if scaled == *term { &factor * term } else { scaled })
            };
            let rest: Vec<Expr> =
                others.iter().map(small_term).collect::<Result<_, ExprError>>().ok()?;
            (Expr::sum(linear.into_iter().chain(rest)), Some(value))
        }
    };
    let mut scaled = oscillator.clone();
    scaled.force = force;
    scaled.parameters.push(delta);
    Some(JointExpansion {
        force: scaled.expand(SmallParameter::Parameter(delta), order).ok()?,
        delta,
        value,
        parameters,
    })
}

/// Completes `parameters` to a set whose vanishing leaves the linear terms alone, where there is
/// one: each step adds the parameter whose vanishing removes most of the remaining terms.
fn small_parameters(
    linear: &[Expr],
    others: &[Expr],
    oscillator: &Oscillator,
    parameters: &mut Vec<Symbol>,
) -> bool {
    let vanishes = |term: &Expr, name: Symbol| {
        term.substitute(name, &Expr::zero()).is_ok_and(|rest| rest.is_zero())
    };
    let mut left: Vec<&Expr> =
        others.iter().filter(|term| !parameters.iter().any(|&name| vanishes(term, name))).collect();
    while !left.is_empty() {
        let free = oscillator.parameters.iter().copied();
        let candidates = free.filter(|&name| !linear.iter().any(|term| term.contains(name)));
        let taken = |name: Symbol| left.iter().filter(|term| vanishes(term, name)).count();
        // Among equally good ones the first in alphabetical order is chosen.
        let Some(best) = candidates.max_by_key(|&name| (taken(name), std::cmp::Reverse(name)))
        else {
            return false;
        };
        if taken(best) == 0 {
            return false;
        }
        left.retain(|term| !vanishes(term, best));
        parameters.push(best);
    }
    true
}

/// Whether a term is a constant times the coordinate.
fn stays_linear(term: &Expr, oscillator: &Oscillator) -> Result<bool, ExprError> {
    let quotient = Expr::divide(term, &Expr::from(oscillator.coordinate))?;
    let own = [oscillator.coordinate, oscillator.velocity()];
    Ok(own.iter().all(|&name| !quotient.contains(name)))
}
