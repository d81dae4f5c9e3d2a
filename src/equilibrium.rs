//! Where a motion swings about: the stable equilibrium nearest to `x = 0`, and the equation seen from there.
//!
//! `f(x_e) = 0`, stable where the force changes sign from negative to positive. An equilibrium that is a fraction is used
//! exactly; any other leads to numerical coefficients, which the answer says.

use num_traits::Zero;

use crate::decimal::rounded;
use crate::exact::Rational;
use crate::exact::rational::ratio;
use crate::expr::{CompiledFunction, Expr, Function, Node};
use crate::ode::root::find_root;
use crate::oscillator::{Oscillator, OscillatorError};
use crate::series::taylor::taylor;

/// An equation of motion in the deviation from its equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct Centred {
    /// The equation in `x - position`.
    pub oscillator: Oscillator,
    /// The equilibrium: a fraction, or fifteen digits of it.
    pub position: Rational,
    /// Whether position and coefficients are rounded.
    pub numerical: bool,
    /// What was assumed of parameters: `xc > 0` where a barrier `H(x - xc)` must not act at rest.
    pub assumption: Option<String>,
}

/// The oscillator about the stable equilibrium nearest to zero; `degree` is that of the numerical force polynomial, should
/// the equilibrium be irrational.
///
/// # Errors
/// An unstable `x = 0` (the stable ones are named), no equilibrium, or one that depends on parameters.
pub fn centred(oscillator: &Oscillator, degree: u32) -> Result<Centred, OscillatorError> {
    let (position, velocity) = (oscillator.coordinate, oscillator.velocity());
    let at_origin = Centred {
        oscillator: oscillator.clone(),
        position: Rational::zero(),
        numerical: false,
        assumption: None,
    };
    // Time-dependent terms are refused by the methods; where the force has no value at rest, so is that.
    let Ok(still) = oscillator.force.substitute(velocity, &Expr::zero()) else {
        return Ok(at_origin);
    };
    let at_zero = still
        .substitute(position, &Expr::zero())
        .and_then(|force| force.expand());
    let Ok(at_zero) = at_zero else { return Ok(at_origin) };
    let only_position = still.symbols().into_iter().all(|symbol| symbol == position);
    if at_zero.is_zero() {
        if !only_position {
            return Ok(at_origin);
        }
        let equilibria = equilibria(&still, oscillator)?;
        let unstable = equilibria.iter().any(|found| found.position == 0.0 && !found.stable);
        return match unstable {
            false => Ok(at_origin),
            true => Err(OscillatorError::Unstable(stable_texts(&equilibria, &still, oscillator))),
        };
    }
    if !only_position && let Some(assumption) = untouched(&at_zero)? {
        return Ok(Centred {
            assumption: Some(assumption),
            ..at_origin
        });
    }
    if !only_position {
        return match at_zero.contains("t".into()) {
            true => Ok(at_origin),
            false => Err(OscillatorError::SymbolicEquilibrium(at_zero.to_string())),
        };
    }
    let equilibria = equilibria(&still, oscillator)?;
    let stable = equilibria.iter().filter(|found| found.stable);
    let Some(nearest) = stable.min_by(|a, b| a.position.abs().total_cmp(&b.position.abs())) else {
        return Err(OscillatorError::NoEquilibrium(at_zero.to_string()));
    };
    let exact = nearest.exact(&still, oscillator);
    let numerical = exact.is_none();
    let shift = exact.unwrap_or_else(|| rounded(nearest.position));
    let moved = &Expr::from(position) + &Expr::number(shift.clone());
    let mut oscillator = oscillator.clone();
    oscillator.residual = oscillator.residual.substitute(position, &moved)?;
    oscillator.force = match numerical {
        false => oscillator.force.substitute(position, &moved)?,
        true => numerical_force(&oscillator, &shift, degree)?,
    };
    Ok(Centred {
        oscillator,
        position: shift,
        numerical,
        assumption: None,
    })
}

/// Whether a force at rest is that of barriers alone that do not act there: every `H(-xc)` is zero for `xc > 0`.
fn untouched(at_zero: &Expr) -> Result<Option<String>, OscillatorError> {
    let mut names = Vec::new();
    let without = at_zero.fold(|expr, children: &[Expr]| match (expr.node(), children) {
        (Node::Function(Function::Step, _), [edge]) if edge.terms().len() == 1 && edge.has_leading_minus() => {
            let edge = (-edge).to_string();
            if !names.contains(&edge) {
                names.push(edge);
            }
            Ok(Expr::zero())
        }
        _ => expr.with_children(children),
    })?;
    let assumption = || {
        names
            .iter()
            .map(|name| format!("{name} > 0"))
            .collect::<Vec<_>>()
            .join(", ")
    };
    Ok((without.expand()?.is_zero() && !names.is_empty()).then(assumption))
}

/// The force as a polynomial with rounded coefficients; only for forces of the position alone.
fn numerical_force(oscillator: &Oscillator, shift: &Rational, degree: u32) -> Result<Expr, OscillatorError> {
    let position = oscillator.coordinate;
    if oscillator.force.contains(oscillator.velocity()) {
        return Err(OscillatorError::NoEquilibrium(
            "a force with velocities about an irrational equilibrium".to_owned(),
        ));
    }
    let parts = taylor(&oscillator.force, &[(position, shift.clone())], degree)?;
    // The value at the equilibrium itself is rounding; the linear frequency is rounded instead of its square, so that it
    // needs no symbol.
    let term = |(power, part): (usize, &Expr)| {
        let value = part.evaluate(&[(position, 1.0)].into()).ok()?;
        let coefficient = match power {
            1 if value > 0.0 => num_traits::pow(rounded(value.sqrt()), 2),
            _ => rounded(value),
        };
        let power = Expr::integer_power(&Expr::from(position), power as i64).ok()?;
        Some(&Expr::number(coefficient) * &power)
    };
    Ok(Expr::sum(parts.iter().enumerate().skip(1).filter_map(term)))
}

struct Equilibrium {
    position: f64,
    stable: bool,
}

impl Equilibrium {
    /// The fraction of smallest denominator here at which the force is exactly zero.
    fn exact(&self, force: &Expr, oscillator: &Oscillator) -> Option<Rational> {
        (1..=1000)
            .map(|q| ratio((self.position * q as f64).round() as i64, q))
            .find(|candidate| {
                let near = (crate::exact::rational::to_f64(candidate) - self.position).abs()
                    < 1e-9 * (1.0 + self.position.abs());
                let value = || force.substitute(oscillator.coordinate, &Expr::number(candidate.clone()));
                near && value()
                    .and_then(|value| value.expand())
                    .is_ok_and(|value| value.is_zero())
            })
    }
}

fn stable_texts(equilibria: &[Equilibrium], force: &Expr, oscillator: &Oscillator) -> Vec<String> {
    let text = |found: &Equilibrium| match found.exact(force, oscillator) {
        Some(exact) => exact.to_string(),
        None => crate::decimal::decimal(found.position),
    };
    equilibria.iter().filter(|found| found.stable).map(text).collect()
}

/// All simple zeros of the force between -1000 and 1000 that a fine grid tells apart, nearest to zero in the finest part.
fn equilibria(force: &Expr, oscillator: &Oscillator) -> Result<Vec<Equilibrium>, OscillatorError> {
    let function = CompiledFunction::new(force, &[oscillator.coordinate])
        .map_err(|_| OscillatorError::NoEquilibrium(force.to_string()))?;
    let value = |x: f64| function.call(&[x]);
    // From 1/100 apart near zero to a few units apart far out; odd numbers of steps keep zero itself off the grid.
    let place = |k: i32| {
        let s = (f64::from(k) + 0.5) / 1000.0;
        10.0 * s + 990.0 * s.powi(7)
    };
    let mut found: Vec<Equilibrium> = Vec::new();
    for k in -1000..1000 {
        let (left, right) = (place(k), place(k + 1));
        let (before, after) = (value(left), value(right));
        if !(before.is_finite() && after.is_finite()) || before.signum() == after.signum() {
            continue;
        }
        let Ok(root) = find_root(value, left, right) else {
            continue;
        };
        // A pole changes sign as well, but is no zero.
        if value(root).abs() > before.abs().min(after.abs()) {
            continue;
        }
        let root = if value(0.0) == 0.0 && root.abs() < 1e-12 {
            0.0
        } else {
            root
        };
        found.push(Equilibrium {
            position: root,
            stable: after > 0.0,
        });
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn position(text: &str) -> Result<(String, bool), OscillatorError> {
        let centred = centred(&Oscillator::parse(text)?, 9)?;
        Ok((centred.position.to_string(), centred.numerical))
    }

    #[test]
    fn the_nearest_stable_equilibrium() {
        assert_eq!(position("x'' + sin(x)"), Ok(("0".to_owned(), false)));
        assert_eq!(position("x'' + x - 1/3"), Ok(("1/3".to_owned(), false)));
        assert_eq!(position("x'' + x^2 - 4"), Ok(("2".to_owned(), false)));
        let (text, numerical) = position("x'' + x - cos(x)").unwrap();
        assert!(numerical);
        let value = crate::exact::rational::to_f64(&text.parse().unwrap());
        assert!((value - value.cos()).abs() < 1e-14);
    }

    #[test]
    fn unstable_and_missing_ones_are_refused() {
        let error = position("x'' - x + x^3").unwrap_err();
        assert_eq!(error, OscillatorError::Unstable(vec!["-1".to_owned(), "1".to_owned()]));
        assert!(matches!(
            position("x'' + 1 + x^2"),
            Err(OscillatorError::NoEquilibrium(_))
        ));
        assert!(matches!(
            position("x'' + x - k"),
            Err(OscillatorError::SymbolicEquilibrium(_))
        ));
    }
}
