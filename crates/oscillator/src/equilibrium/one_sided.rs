//! Refusal of a root that is real on one side of rest alone, as that of `x^1.5`: on the other side
//! there is no force, and nothing pulls back.

use num_integer::Integer as _;
use num_traits::Zero;

use crate::decimal::decimal;
use crate::exact::Rational;
use crate::exact::rational::{ratio, to_f64};
use crate::expr::{Expr, Node};
use crate::oscillator::{Oscillator, OscillatorError};
use crate::series::taylor::taylor;
use crate::symbol::Symbol;

/// The refusal of a force that has a value on one side of `x = 0` alone; parameters inside its root
/// are taken to be positive. `None` if no root of it begins there.
pub(super) fn refusal(oscillator: &Oscillator, force: &Expr) -> Option<OscillatorError> {
    let coordinate = oscillator.coordinate;
    let mut found = None;
    let Ok(()) = force.fold(|expr, _: &[()]| {
        if found.is_none() && begins_at_zero(expr, coordinate).is_some() {
            found = Some(expr.clone());
        }
        Ok::<(), std::convert::Infallible>(())
    });
    let root = found?;
    let side = if begins_at_zero(&root, coordinate)? { '<' } else { '>' };
    let (base, exponent) = root.base_and_exponent();
    let exponent = exponent.as_number()?.clone();
    let contains = |expr: &Expr| {
        let found = expr.fold(|inner, below: &[bool]| {
            Ok::<bool, std::convert::Infallible>(*inner == root || below.contains(&true))
        });
        found == Ok(true)
    };
    let typed = oscillator.typed.values().position(|value| contains(&value));
    let words = typed.map(|number| oscillator.typed.quote(&[number]));
    // The exponent is looked for as it may have been typed, as a decimal.
    let point = format!("^{}", decimal(to_f64(&exponent)));
    let by_point = words.as_ref().is_some_and(|words| words.contains(&point));
    let power_of = |base: &str| match by_point {
        true => format!("{base}{point}"),
        false if exponent == ratio(1, 2) => format!("sqrt({base})"),
        false => format!("{base}^({exponent})"),
    };
    let others = force.terms().iter().any(|term| term.contains(coordinate) && !contains(term));
    Some(OscillatorError::OneSided {
        coordinate,
        side,
        term: words.unwrap_or_else(|| root.to_string()),
        odd: format!("sgn({base})*{}", power_of(&format!("abs({base})"))),
        zero: others.then(|| power_of(&format!("max({base}, 0)"))),
    })
}

/// Whether an even root of something that changes its sign at zero is real for positive `x`, or
/// else for negative; `None` for anything else.
fn begins_at_zero(expr: &Expr, coordinate: Symbol) -> Option<bool> {
    const DEGREE: u32 = 5;
    let Node::Power(base, exponent) = expr.node() else {
        return None;
    };
    if !exponent.as_number()?.denom().is_even() || !base.contains(coordinate) {
        return None;
    }
    let parts = taylor(base, &[(coordinate, Rational::zero())], DEGREE).ok()?;
    let (power, lowest) = parts.iter().enumerate().find(|(_, part)| !part.is_zero())?;
    let coefficient = lowest.substitute(coordinate, &Expr::one()).ok()?;
    let letters = coefficient.symbols().into_iter().map(|name| (name, 1.0)).collect();
    let positive = coefficient.evaluate(&letters).ok()? > 0.0;
    (power % 2 == 1).then_some(positive)
}
