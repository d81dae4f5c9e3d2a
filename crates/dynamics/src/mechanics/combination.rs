//! Sums of parameters that enter the energies only as one: R - r for a ball that rolls in a bowl,
//! m1 + m2 for two masses that move together.
//!
//! In: a mechanism, whose energies are written with such sums. Out: each [`Combination`] with a
//! name of its own, if that leaves fewer parameters: one parameter of the sum is expressed by the
//! sum and the other parameters, one of which must then cancel.

use std::collections::BTreeSet;

use super::Mechanism;
use crate::expr::{Expr, ExprError, Node};
use crate::symbol::{Symbol, fresh};

/// A sum of parameters that counts as a single one.
#[derive(Clone, Debug, PartialEq)]
pub struct Combination {
    /// The name of the sum.
    pub name: Symbol,
    /// The definition in the parameters: `R - r`.
    pub meaning: Expr,
    /// The parameter that is eliminated, and the expression that replaces it.
    replaced: (Symbol, Expr),
}

impl Combination {
    /// Returns an expression with the name in place of the sum.
    fn put_into(&self, expression: &Expr) -> Result<Expr, ExprError> {
        let (parameter, value) = &self.replaced;
        let put = expression.substitute(*parameter, value)?;
        match self.meaning.symbols().into_iter().any(|name| put.contains(name)) {
            // The sum was hidden in expanded products.
            true => put.expand(),
            false => Ok(put),
        }
    }

    /// Returns an expression with the sum in place of the name.
    fn written_out(&self, expression: &Expr) -> Result<Expr, ExprError> {
        expression.substitute(self.name, &self.meaning)
    }
}

/// Returns an expression in terms of these combinations.
pub(super) fn put_into(expression: &Expr, combinations: &[Combination]) -> Result<Expr, ExprError> {
    let put = |expression: Expr, combination: &Combination| combination.put_into(&expression);
    combinations.iter().try_fold(expression.clone(), put)
}

/// Returns an expression with every sum in place of its name. The last comes first, since it may
/// contain the names of earlier ones.
pub(super) fn written_out(
    expression: &Expr,
    combinations: &[Combination],
) -> Result<Expr, ExprError> {
    let write = |expression: Expr, combination: &Combination| combination.written_out(&expression);
    combinations.iter().rev().try_fold(expression.clone(), write)
}

/// Returns the mechanism in terms of its combinations, and the combinations.
pub(super) fn combined(mechanism: &Mechanism) -> Result<(Mechanism, Vec<Combination>), ExprError> {
    let mut own = mechanism.clone();
    let mut found: Vec<Combination> = Vec::new();
    while let Some((next, combination)) = one_more(&own)? {
        own = next;
        found.push(combination);
    }
    Ok((own, found))
}

fn one_more(mechanism: &Mechanism) -> Result<Option<(Mechanism, Combination)>, ExprError> {
    let parameters = mechanism.parameters();
    let sums: Vec<Expr> = mechanism
        .parts()
        .flat_map(|(_, part)| part.unique_nodes())
        .filter(|node| matches!(node.node(), Node::Sum(_)))
        .filter(|node| node.symbols().iter().all(|name| parameters.contains(name)))
        .cloned()
        .collect();
    let taken: Vec<Symbol> = parameters.iter().chain(&mechanism.coordinates).copied().collect();
    let name = fresh("d", &taken);
    for sum in sums {
        for term in sum.terms() {
            let (number, factors) = term.factors();
            let [factor] = factors else { continue };
            let Some(parameter) = factor.as_symbol() else {
                continue;
            };
            let others = &sum - term;
            if others.contains(parameter) {
                continue;
            }
            let value = Expr::divide(&(Expr::from(name) - others), &Expr::number(number))?;
            let combination =
                Combination { name, meaning: sum.clone(), replaced: (parameter, value) };
            let next = mechanism.mapped(|part| combination.put_into(part))?;
            let left: BTreeSet<Symbol> = next.parameters().into_iter().collect();
            // The new name replaces one parameter, so another one must have cancelled.
            if left.len() < parameters.len() {
                return Ok(Some((next, combination)));
            }
        }
    }
    Ok(None)
}
