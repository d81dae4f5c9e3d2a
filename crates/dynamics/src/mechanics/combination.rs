//! Sums of parameters that enter as one: of a ball that rolls in a bowl R - r alone, of two masses
//! that move together m1 + m2.
//!
//! In: a mechanism, whose energies are written with such sums. Out: each [`Combination`] with a
//! name of its own, where that leaves fewer parameters: one of the sum is replaced by the sum and
//! the others, and one of the others is gone then.

use std::collections::BTreeSet;

use super::Mechanism;
use crate::expr::{Expr, ExprError, Node};
use crate::symbol::{Symbol, fresh};

/// A sum of parameters that stands for one.
#[derive(Clone, Debug, PartialEq)]
pub struct Combination {
    /// Its name.
    pub name: Symbol,
    /// Its definition in the parameters: `R - r`.
    pub meaning: Expr,
    /// The parameter that is replaced by it, and by what.
    replaced: (Symbol, Expr),
}

impl Combination {
    /// An expression with the name in the place of the sum.
    fn put_into(&self, expression: &Expr) -> Result<Expr, ExprError> {
        let (parameter, value) = &self.replaced;
        let put = expression.substitute(*parameter, value)?;
        match self.meaning.symbols().into_iter().any(|name| put.contains(name)) {
            // Products that were written out.
            true => put.expand(),
            false => Ok(put),
        }
    }

    /// An expression with the sum in the place of the name.
    fn written_out(&self, expression: &Expr) -> Result<Expr, ExprError> {
        expression.substitute(self.name, &self.meaning)
    }
}

/// An expression in these combinations.
pub(super) fn put_into(expression: &Expr, combinations: &[Combination]) -> Result<Expr, ExprError> {
    let put = |expression: Expr, combination: &Combination| combination.put_into(&expression);
    combinations.iter().try_fold(expression.clone(), put)
}

/// An expression with every sum in the place of its name: a later one may be a sum with an earlier
/// one.
pub(super) fn written_out(
    expression: &Expr,
    combinations: &[Combination],
) -> Result<Expr, ExprError> {
    let write = |expression: Expr, combination: &Combination| combination.written_out(&expression);
    combinations.iter().rev().try_fold(expression.clone(), write)
}

/// The combinations of a mechanism, and the mechanism in them.
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
            // The name came for the parameter that it replaces; another one must have gone.
            if left.len() < parameters.len() {
                return Ok(Some((next, combination)));
            }
        }
    }
    Ok(None)
}
