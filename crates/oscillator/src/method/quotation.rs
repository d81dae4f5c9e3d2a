//! Refusals in the words of the reader: the term of the normal form that is in the way, `x'^3/2`
//! say, gives way to the term that was typed, `0.5*(x')^3`.
//!
//! A typed term is what a term of the force comes from if that term, its number apart, is one of
//! the expansion of the typed one: divided by the coefficient of the acceleration and seen from the
//! equilibrium, as the force is.

use std::convert::Infallible;

use super::{Reason, Refusal};
use crate::equilibrium::Centred;
use crate::expr::{Expr, ExprError, Quotation};
use crate::oscillator::{Oscillator, OscillatorError};
use crate::series::taylor::TaylorError;

/// A refusal whose term is quoted as it was typed, if it is known which typed term that was.
pub(super) fn as_typed(
    mut refusal: Refusal,
    oscillator: &Oscillator,
    centred: &Centred,
) -> Refusal {
    let moved = !centred.position.is_zero();
    let of_velocity = refusal.reason == Reason::Velocity;
    let not_odd = refusal.reason == Reason::NotOdd;
    let term = match &mut refusal.reason {
        Reason::Oscillator(OscillatorError::Taylor(TaylorError::NotAnalytic { term, point })) => {
            // A part of a term is quoted as it is where it stands so in the text.
            if !moved && oscillator.typed.contains(term.words()) {
                return refusal;
            }
            if let Some(found) = typed_around(term.expression(), oscillator, centred) {
                *term = found;
                // The force was expanded about the equilibrium.
                let place =
                    point.iter_mut().find(|(variable, _)| *variable == oscillator.coordinate);
                if let Some((_, centre)) = place.filter(|(_, centre)| centre.is_zero()) {
                    centre.clone_from(&centred.position);
                }
            }
            return refusal;
        }
        Reason::Oscillator(
            OscillatorError::NotSmall { term, .. } | OscillatorError::NotPolynomial(term),
        ) => Some(term),
        Reason::NotOddAbout(..) => None,
        _ => refusal.quoted.as_deref_mut(),
    };
    let found = term.and_then(|term| Some((typed_terms(term, oscillator, centred)?, term)));
    // The velocity may come from the coefficient of the acceleration; then the term is shown
    // divided by that.
    let shows_velocity = |found: &Quotation| found.words().contains(oscillator.velocity().name());
    if let Some((found, term)) = found.filter(|(found, _)| !of_velocity || shows_velocity(found)) {
        *term = found;
        if moved && not_odd {
            refusal.reason = Reason::NotOddAbout(oscillator.coordinate, centred.position.clone());
        }
    }
    refusal
}

/// The typed terms from which the terms of a sum come.
fn typed_terms(sum: &Quotation, oscillator: &Oscillator, centred: &Centred) -> Option<Quotation> {
    let expression = sum.expression();
    let sum = expression.expand().ok()?;
    let of = |term: &Expr| term.factors().1.to_vec();
    let wanted: Vec<Vec<Expr>> = sum.terms().iter().map(of).collect();
    let parts = parts(oscillator, centred);
    let among = |part: &Expr| part.terms().iter().any(|term| wanted.contains(&of(term)));
    let mirrored = |part: &Expr| {
        let turned = -Expr::from(oscillator.coordinate);
        part.substitute(oscillator.coordinate, &turned).and_then(|part| part.expand())
    };
    let comes_from = |part: &Expr| {
        // The even part of a force may hold the mirror image of what was typed.
        part.expand().is_ok_and(|part| among(&part))
            || mirrored(part).is_ok_and(|part| among(&part))
    };
    let mut numbers = numbers_where(&parts, comes_from);
    if numbers.is_empty() {
        // A series is attributed to the one typed term that contains all its symbols.
        let symbols = sum.symbols();
        numbers = numbers_where(&parts, |part| symbols.is_subset(&part.symbols()));
        numbers = if numbers.len() == 1 { numbers } else { vec![] };
    }
    (!numbers.is_empty())
        .then(|| Quotation::new(expression.clone(), oscillator.typed.quote(&numbers)))
}

/// The first typed term in which an expression occurs.
fn typed_around(inner: &Expr, oscillator: &Oscillator, centred: &Centred) -> Option<Quotation> {
    let parts = parts(oscillator, centred);
    let occurs = |part: &Expr| {
        let found = part.fold(|expr, below: &[bool]| {
            Ok::<bool, Infallible>(expr == inner || below.iter().any(|&found| found))
        });
        found.unwrap_or(false)
    };
    let number = numbers_where(&parts, occurs).into_iter().next()?;
    let part = parts.get(number)?.clone()?;
    // In `x*x'' + 1` the force `1/x` comes from the typed term `1`, which does not show it.
    let divided = oscillator.velocity().derivative();
    let own_mass =
        oscillator.residual.differentiate(divided).is_ok_and(|mass| mass.symbols().is_empty());
    let typed = oscillator.typed.values().nth(number)?;
    if !own_mass && centred.written.is_zero() && !occurs(&typed) {
        return None;
    }
    Some(Quotation::new(part, oscillator.typed.quote(&[number])))
}

fn numbers_where(parts: &[Option<Expr>], holds: impl Fn(&Expr) -> bool) -> Vec<usize> {
    let numbers = parts.iter().enumerate();
    let numbers = numbers.filter(|(_, part)| part.as_ref().is_some_and(&holds));
    numbers.map(|(number, _)| number).collect()
}

/// The contribution of each typed term to the force about the equilibrium; `None` for those with
/// the acceleration in them, and for the zero of `= 0`.
fn parts(oscillator: &Oscillator, centred: &Centred) -> Vec<Option<Expr>> {
    let (coordinate, acceleration) = (oscillator.coordinate, oscillator.velocity().derivative());
    let Ok(mass) = oscillator.residual.differentiate(acceleration) else {
        return vec![];
    };
    let part = |value: Expr| -> Result<Expr, ExprError> {
        let part = Expr::divide(&value, &mass.expand()?)?;
        match centred.written.is_zero() {
            true => Ok(part),
            false => part.substitute(coordinate, &(Expr::from(coordinate) + &centred.written)),
        }
    };
    let values = oscillator.typed.values();
    let parts = values.map(|value| match value.is_zero() || value.contains(acceleration) {
        true => None,
        false => part(value).ok(),
    });
    parts.collect()
}
