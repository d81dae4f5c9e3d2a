//! Base excitation: forces of the motion relative to a support that moves.
//!
//! ```text
//! x'' + f(x - y(t), x' - y'(t), t) = 0,   y a sum of waves:      z = x - y,   z'' + f(z, z', t) + y'' = 0
//! ```
//!
//! The motion of the support is read off a sum inside a nonlinear force, such as `x - Y sin(w t)` in the cube of that. In the relative
//! coordinate the force is free of it, and the drive is its acceleration.

use std::collections::BTreeMap;

use super::drive::{Quadrature, Wave};
use super::{Options, Refusal, Unsuited, solve_as_asked};
use crate::expr::{Equation, Expr, ExprError, Typed};
use crate::oscillator::Oscillator;
use crate::solution::{Method, Note, Solution};
use crate::symbol::{Symbol, fresh};

/// Whether a refusal is one of a drive that another coordinate may simplify.
pub(super) fn is_of_drive(refusal: &Refusal) -> bool {
    let Refusal::Unsuited { reason, .. } = refusal else {
        return false;
    };
    matches!(reason, Unsuited::NoWave { .. } | Unsuited::SecondDrive { .. })
}

/// The answer in the coordinate relative to a base; `None` where no base moves, or there is no answer in that coordinate either.
pub(super) fn solve(oscillator: &Oscillator, options: &Options) -> Option<Solution> {
    let base = base_motion(oscillator).ok()??;
    let relative = fresh("z", &oscillator.names());
    let seen = relative_to(oscillator, &base, relative).ok()?;
    let mut solution = solve_as_asked(&seen, options).ok()?;
    solution.validity.push(Note::RelativeCoordinate {
        relative,
        coordinate: oscillator.coordinate,
        base,
    });
    Some(solution)
}

/// The equation in the relative coordinate.
fn relative_to(oscillator: &Oscillator, base: &Expr, relative: Symbol) -> Result<Oscillator, Refusal> {
    let t = Symbol::new("t");
    let speed = base.differentiate(t)?;
    let own = [
        (oscillator.coordinate, &Expr::from(relative) + base),
        (oscillator.velocity(), &Expr::from(relative.derivative()) + &speed),
    ];
    let force = oscillator.force.substitute_all(&BTreeMap::from(own))?;
    let left = (&force + &speed.differentiate(t)?).expand()?;
    let equation = Equation {
        left: &Expr::from(relative.derivative().derivative()) + &left,
        right: Expr::zero(),
        coordinate: relative,
        typed: Typed::default(),
    };
    Ok(Oscillator::from_equation(&equation)?)
}

/// The motion of the base; `None` where no sum in the force holds one.
fn base_motion(oscillator: &Oscillator) -> Result<Option<Expr>, Refusal> {
    let own = [oscillator.coordinate, oscillator.velocity()];
    for sum in oscillator.force.unique_nodes().skip(1) {
        let moves = |name: Symbol| Ok::<_, ExprError>(beside(sum, name, own)?.map(|moving| -&moving));
        if let Some(base) = moves(own[0])? {
            return Ok(Some(base));
        }
        if let Some(speed) = moves(own[1])? {
            return integrated(&speed).map(Some);
        }
    }
    Ok(None)
}

/// The part of a sum that moves in time beside a coordinate or a velocity, over the factor of that; `None` where the sum is another one.
fn beside(sum: &Expr, name: Symbol, own: [Symbol; 2]) -> Result<Option<Expr>, ExprError> {
    let t = Symbol::new("t");
    let (moving, still): (Vec<&Expr>, Vec<&Expr>) = sum.terms().iter().partition(|term| term.contains(t));
    let mut with_motion = still.iter().filter(|term| own.iter().any(|name| term.contains(*name)));
    let (Some(only), None) = (with_motion.next(), with_motion.next()) else {
        return Ok(None);
    };
    let factor = Expr::divide(only, &Expr::from(name))?;
    let holds_motion = |part: &Expr| own.iter().any(|name| part.contains(*name));
    if moving.is_empty() || holds_motion(&factor) || moving.iter().any(|term| holds_motion(term)) {
        return Ok(None);
    }
    Expr::divide(&Expr::sum(moving.into_iter().cloned()), &factor)?
        .expand()
        .map(Some)
}

/// The motion of which a sum of waves is the velocity.
fn integrated(speed: &Expr) -> Result<Expr, Refusal> {
    let mut motion = vec![];
    for term in speed.terms() {
        let wave = Wave::new(term, Method::MultipleScales)?;
        let angle = &(&wave.rate * &Expr::symbol("t")) + &wave.phase;
        let along = match wave.quadrature {
            Quadrature::Cosine => angle.sin()?,
            Quadrature::Sine => -&angle.cos()?,
        };
        motion.push(&Expr::divide(&wave.factor, &wave.rate)? * &along);
    }
    Ok(Expr::sum(motion))
}
