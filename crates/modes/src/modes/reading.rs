//! Equations of several coordinates counted from rest, and their coefficients as polynomials.

use std::collections::BTreeMap;

use num_traits::Zero;

use super::ModeError;
use crate::coupled::{CoupledEquations, CoupledError};
use crate::exact::{Polynomial, Rational};
use crate::expr::{Expr, NAMES_OF_ANSWERS};
use crate::mechanics::{EquationsOfMotion, equilibria};
use crate::solution::Definition;
use crate::symbol::{Symbol, fresh};

/// The equations of a mechanism, its coordinates counted from the first place of rest that is found,
/// and that place.
pub(crate) fn counted_from_rest(
    equations: &EquationsOfMotion,
) -> Result<(CoupledEquations, Vec<Expr>), ModeError> {
    let coupled = CoupledEquations::of_mechanism(equations)?;
    let found = equilibria(equations).map_err(CoupledError::from)?;
    let Some(place) = found.first().map(|rest| rest.values(&equations.coordinates)) else {
        let origin = vec![Expr::zero(); coupled.coordinates.len()];
        return Ok((coupled, origin));
    };
    let rest: Vec<Expr> = coupled
        .coordinates
        .iter()
        .map(|name| place.get(name).cloned().unwrap_or_else(Expr::zero))
        .collect();
    let counted: BTreeMap<Symbol, Expr> =
        place.iter().map(|(name, place)| (*name, place + &Expr::from(*name))).collect();
    Ok((coupled.substituted(&counted)?, rest))
}

/// Coordinates, velocities and accelerations, each zero.
pub(crate) fn at_rest(coordinates: &[Symbol]) -> Vec<(Symbol, Rational)> {
    let all = coordinates.iter().flat_map(|name| {
        let velocity = name.derivative();
        [*name, velocity, velocity.derivative()]
    });
    all.map(|name| (name, Rational::zero())).collect()
}

/// An expression as a polynomial; a factor that is no product of powers gets a name among the
/// `constants`, which is none of the `names`.
pub(crate) fn polynomial(
    expression: &Expr,
    names: &[Symbol],
    constants: &mut Vec<Definition>,
) -> Polynomial {
    let mut names = names.to_vec();
    let mut name = |factor: &Expr| {
        let known = constants.iter().find(|constant| constant.meaning == *factor);
        Some(known.map(|constant| constant.symbol).unwrap_or_else(|| {
            let symbol = fresh(&format!("c{}", constants.len() + 1), &names);
            names.push(symbol);
            constants.push(Definition { symbol, meaning: factor.clone() });
            symbol
        }))
    };
    // Every factor has a name, so that only the length of the expression can be in the way.
    let found = expression.to_polynomial(&mut name).ok().flatten();
    found.unwrap_or_else(|| name(expression).map_or_else(Polynomial::zero, Polynomial::symbol))
}

/// The equations with their names that are those of something in an answer kept apart.
pub(crate) fn with_own_names_apart(
    equations: CoupledEquations,
) -> Result<CoupledEquations, ModeError> {
    let is_taken = |name: &&Symbol| NAMES_OF_ANSWERS.contains(&name.name());
    let coordinates = equations.coordinates.iter().filter(is_taken).flat_map(|name| {
        let velocity = name.derivative();
        [*name, velocity, velocity.derivative()]
    });
    let parameters = equations.parameters.iter().filter(is_taken).copied();
    let apart: BTreeMap<Symbol, Expr> =
        coordinates.chain(parameters).map(|name| (name, Expr::from(name.apart()))).collect();
    if apart.is_empty() {
        return Ok(equations);
    }
    Ok(equations.substituted(&apart)?)
}
