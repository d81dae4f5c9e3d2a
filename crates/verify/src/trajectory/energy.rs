//! The energy of an equation of motion: the potential of the terms that have one, and the power of
//! every other term.
//!
//! ```text
//! x'' + f = 0:   h = x'^2/2 + V(x),   dh/dt = -x' (f - V')
//! ```
//!
//! Reference: H. Goldstein, *Classical Mechanics*, 2nd ed., section 2-6. Terms are those of the
//! expanded force, but arguments of functions and denominators stay as they were typed: `exp(-((t -
//! 20)*1e5)^2)` written out would lose ten digits.

use super::EnergyWithPowers;
use crate::conservative::potential;
use crate::exact::rational::ratio;
use crate::expr::{Expr, ExprError, Node};
use crate::oscillator::Oscillator;
use crate::symbol::{Symbol, fresh_stem};
use num_traits::Signed as _;

/// `x'^2/2 + V(x)`, V of the terms that have a potential in closed form, and the power of every
/// other term; `None` for an inertia that depends on the position, whose energy has another form.
pub(super) fn energy_of_equation(oscillator: &Oscillator) -> Option<EnergyWithPowers> {
    let velocity = oscillator.velocity();
    let speed = Expr::from(velocity);
    let backwards = -&speed;
    let works = |term: &Expr| (term.to_string(), -(&speed * term));
    let mut value = vec![&speed * &speed * Expr::number(ratio(1, 2))];
    // Forces of the position without a potential, then dampers, then drives.
    let mut powers = [vec![], vec![], vec![]];
    for term in terms(&oscillator.force, &oscillator.names()).ok()? {
        if term.contains(Symbol::new("t")) {
            powers[2].push(works(&term));
        } else if !term.contains(velocity) {
            match potential(&term, oscillator.coordinate) {
                Some(potential) => value.push(potential),
                None => powers[0].push(works(&term)),
            }
        } else if term.substitute(velocity, &backwards).ok()? == term {
            return None;
        } else {
            powers[1].push(works(&term));
        }
    }
    Some(EnergyWithPowers { value: Expr::sum(value), powers: powers.concat() })
}

/// The terms of a force written out, functions and denominators as they were typed.
fn terms(force: &Expr, names: &[Symbol]) -> Result<Vec<Expr>, ExprError> {
    let stem = fresh_stem("part", names);
    let mut kept: Vec<(Symbol, Expr)> = Vec::new();
    let outline = force.fold(|expr, children: &[Expr]| {
        let expr = match children.is_empty() {
            true => expr.clone(),
            false => expr.with_children(children)?,
        };
        let closed = match expr.node() {
            Node::Function(..) => true,
            Node::Power(_, exponent) => !exponent
                .as_number()
                .is_some_and(|exponent| exponent.is_integer() && exponent.is_positive()),
            _ => false,
        };
        if !closed {
            return Ok(expr);
        }
        if let Some((name, _)) = kept.iter().find(|(_, known)| *known == expr) {
            return Ok(Expr::from(*name));
        }
        let name = Symbol::new(&format!("{stem}{}", kept.len()));
        kept.push((name, expr));
        Ok(Expr::from(name))
    })?;
    let outline = outline.expand()?;
    let typed = |term: &Expr| {
        let back = |term: Expr, (name, part): &(Symbol, Expr)| term.substitute(*name, part);
        kept.iter().rev().try_fold(term.clone(), back)
    };
    let typed: Vec<Expr> = outline.terms().iter().map(typed).collect::<Result<_, _>>()?;
    Ok(Expr::sum(typed).terms().iter().filter(|term| !term.is_zero()).cloned().collect())
}
