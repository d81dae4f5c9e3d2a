//! Laws of decay that are exact, or nearly so, for a restoring force of any strength: the action
//! under viscous damping, and the energy from one turning point to the next under dry friction.
//!
//! References: V. I. Arnold, *Mathematical Methods of Classical Mechanics*, 2nd ed., Springer 1989,
//! section 52 (averaging over the true motion); L. D. Landau, E. M. Lifshitz, *Mechanics*, 3rd ed.,
//! Pergamon 1976, section 49.
//!
//! ```text
//! x'' + 2 zeta x' + f(x) = 0,  V' = f:   J = (1/2 pi) oint x' dx,   dE/dt = -2 zeta x'^2 over a period is dJ/dt = -2 zeta J
//!                                        J(t) = J(A) exp(-2 zeta t)
//!     pendulum: J = (8/pi) (E(m) - (1 - m) K(m)), m = sin^2(a/2), as J starts from a^2/2
//! x'' + alpha sgn(x') + f(x) = 0:        V(a_n) - V(a_(n+1)) = alpha (a_n + a_(n+1)), V even: exact from turn to turn
//! ```

use std::collections::BTreeMap;

use crate::conservative::{CentredForce, is_odd, potential};
use crate::expr::{Expr, Function, Node};
use crate::oscillator::{Oscillator, Parts};
use crate::solution::Note;
use crate::symbol::Symbol;

/// The damping of an equation that has a single damping term.
enum OnlyDamping {
    /// `rate * x'`.
    Viscous(Expr),
    /// `size * sgn(x')`.
    Dry(Expr),
}

/// The damping, if it is viscous alone or dry alone; `None` for any other.
fn drain(oscillator: &Oscillator, parts: &Parts) -> Option<OnlyDamping> {
    if !parts.inertia.is_zero() || !parts.forcing.is_zero() {
        return None;
    }
    let velocity = oscillator.velocity();
    let own = [oscillator.coordinate, velocity];
    let free = |expression: &Expr| own.iter().all(|&name| !expression.contains(name));
    let rate = Expr::divide(&parts.damping, &Expr::from(velocity)).ok()?.expand().ok()?;
    if free(&rate) {
        return Some(OnlyDamping::Viscous(rate));
    }
    let (number, factors) = parts.damping.factors();
    let mut size = Expr::number(number);
    let mut signs = 0;
    for factor in factors {
        match factor.node() {
            Node::Function(Function::Sign, arguments)
                if arguments[0].as_symbol() == Some(velocity) =>
            {
                signs += 1
            }
            _ if free(factor) => size = &size * factor,
            _ => return None,
        }
    }
    (signs == 1).then_some(OnlyDamping::Dry(size))
}

/// Remarks that hold beside the slow equations if the restoring force is not linear.
pub(super) fn notes(oscillator: &Oscillator, parts: &Parts) -> Vec<Note> {
    let x = oscillator.coordinate;
    let linear =
        Expr::divide(&parts.restoring, &Expr::from(x)).and_then(|quotient| quotient.expand());
    if linear.is_ok_and(|stiffness| !stiffness.contains(x)) {
        return vec![];
    }
    let note = match drain(oscillator, parts) {
        Some(OnlyDamping::Viscous(rate)) => {
            let sine = Expr::from(x).sin().is_ok_and(|sine| sine == parts.restoring);
            Some(Note::Action { rate, pendulum: sine })
        }
        Some(OnlyDamping::Dry(size)) if is_odd(&parts.restoring, x).unwrap_or(false) => {
            let at = |name: &str| {
                potential(&parts.restoring, x)?.substitute(x, &Expr::symbol(name)).ok()
            };
            at("a_n")
                .zip(at("a_m"))
                .map(|(before, after)| Note::HalfSwings { lost: &before - &after, size })
        }
        _ => None,
    };
    note.into_iter().collect()
}

/// The time at which the amplitude has fallen to a given fraction of that at the start, by the
/// action; `None` if the damping is not viscous alone.
pub fn falls_to(
    oscillator: &Oscillator,
    equilibrium: &Expr,
    numbers: &BTreeMap<Symbol, f64>,
    [start, end]: [f64; 2],
) -> Option<f64> {
    let parts = oscillator.parts().ok()?;
    let Some(OnlyDamping::Viscous(rate)) = drain(oscillator, &parts) else {
        return None;
    };
    let rate = rate.evaluate(numbers).ok().filter(|rate| *rate > 0.0)?;
    let force =
        CentredForce::new(&parts.restoring, oscillator.coordinate, equilibrium, numbers, start)?;
    let ratio = action(&force, start)? / action(&force, end)?;
    Some(ratio.ln() / rate).filter(|time| time.is_finite())
}

/// The action of the motion released at a distance, up to a factor: `int sqrt(V(a) - V(x)) dx`
/// between its turning points.
fn action(force: &CentredForce, start: f64) -> Option<f64> {
    /// With `x = m + h sin(phi)` the integrand is smooth and periodic.
    const POINTS: usize = 64;
    let other = force.turning_point(start).ok()?;
    let (middle, half) = ((start + other) / 2.0, (start - other) / 2.0);
    let value = |k: usize| {
        let phase = std::f64::consts::PI * ((k as f64 + 0.5) / POINTS as f64 - 0.5);
        let (sine, cosine) = phase.sin_cos();
        let (depth, _) = force.work(middle + half * sine, start)?;
        Some(depth.max(0.0).sqrt() * cosine)
    };
    let sum: f64 = (0..POINTS).map(value).sum::<Option<f64>>()?;
    Some(sum * half.abs())
}
