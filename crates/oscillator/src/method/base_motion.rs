//! Base excitation: forces of the motion relative to a support that moves.
//!
//! ```text
//! x'' + f(x - y(t), x' - y'(t), t) = 0,   y a sum of waves:      z = x - y,   z'' + f(z, z', t) + y'' = 0
//! ```
//!
//! The motion of the support is read off a sum inside a nonlinear force, such as `x - Y sin(w t)`
//! in the cube of that. In the relative coordinate the force is free of it, and the drive is its
//! acceleration.

use std::collections::BTreeMap;

use super::drive::{HarmonicExcitation, Quadrature};
use super::{Options, Reason, Refusal, solve_in_its_coordinate};
use crate::expr::{Equation, Expr, ExprError, Typed};
use crate::oscillator::Oscillator;
use crate::solution::{Method, Note, Solution};
use crate::symbol::{Symbol, fresh};

/// Whether a refusal is one of a drive that another coordinate may simplify.
pub(super) fn is_of_drive(refusal: &Refusal) -> bool {
    matches!(refusal.reason, Reason::NoWave | Reason::SecondDrive)
}

/// The answer in the coordinate relative to the first base that leaves no such refusal; `None` if
/// no base moves, or there is no answer in that coordinate either.
pub(super) fn solve(oscillator: &Oscillator, options: &Options) -> Option<Solution> {
    let relative = fresh("z", &oscillator.names());
    // In the coordinate relative to one of two bases the other moves: only bases of the equation as
    // typed are tried, never those of a relative one.
    for base in base_motions(oscillator).ok()? {
        let seen = relative_to(oscillator, &base, relative).ok()?;
        match solve_in_its_coordinate(&seen, options) {
            Ok(mut solution) => {
                solution.validity.push(Note::RelativeCoordinate {
                    relative,
                    coordinate: oscillator.coordinate,
                    base,
                });
                return Some(solution);
            }
            Err(refusal) if is_of_drive(&refusal) => {}
            Err(_) => return None,
        }
    }
    None
}

/// The equation in the relative coordinate.
fn relative_to(
    oscillator: &Oscillator,
    base: &Expr,
    relative: Symbol,
) -> Result<Oscillator, Refusal> {
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

/// The motions of all bases, each once, in the order of the sums in the force that hold them.
fn base_motions(oscillator: &Oscillator) -> Result<Vec<Expr>, Refusal> {
    /// Largest number of bases that are tried: a long force may hold many sums, but two bases that
    /// move differently are rare.
    const MOST: usize = 8;
    let own = [oscillator.coordinate, oscillator.velocity()];
    let mut bases: Vec<Expr> = vec![];
    for sum in oscillator.force.unique_nodes().skip(1) {
        let moves =
            |name: Symbol| Ok::<_, ExprError>(moving_part(sum, name, own)?.map(|moving| -&moving));
        let base = match (moves(own[0])?, moves(own[1])?) {
            (Some(base), _) => Some(base),
            // A velocity that is not a sum of waves adds no base.
            (None, Some(speed)) => match integrated(&speed) {
                Ok(base) => Some(base),
                Err(refusal) if bases.is_empty() => return Err(refusal),
                Err(_) => None,
            },
            (None, None) => None,
        };
        if let Some(base) = base.filter(|base| !bases.contains(base)) {
            bases.push(base);
        }
        if bases.len() == MOST {
            break;
        }
    }
    Ok(bases)
}

/// The part of a sum that moves in time beside a coordinate or a velocity, over the factor of that;
/// `None` if the sum is another one.
fn moving_part(sum: &Expr, name: Symbol, own: [Symbol; 2]) -> Result<Option<Expr>, ExprError> {
    let t = Symbol::new("t");
    let (moving, still): (Vec<&Expr>, Vec<&Expr>) =
        sum.terms().iter().partition(|term| term.contains(t));
    let mut with_motion = still.iter().filter(|term| own.iter().any(|name| term.contains(*name)));
    let (Some(only), None) = (with_motion.next(), with_motion.next()) else {
        return Ok(None);
    };
    let factor = Expr::divide(only, &Expr::from(name))?;
    let holds_motion = |part: &Expr| own.iter().any(|name| part.contains(*name));
    if moving.is_empty() || holds_motion(&factor) || moving.iter().any(|term| holds_motion(term)) {
        return Ok(None);
    }
    Expr::divide(&Expr::sum(moving.into_iter().cloned()), &factor)?.expand().map(Some)
}

/// The motion of which a sum of waves is the velocity.
fn integrated(speed: &Expr) -> Result<Expr, Refusal> {
    let mut motion = vec![];
    for term in speed.terms() {
        let wave = HarmonicExcitation::new(term, Method::MultipleScales)?;
        let angle = &(&wave.rate * &Expr::symbol("t")) + &wave.phase;
        let along = match wave.quadrature {
            Quadrature::Cosine => angle.sin()?,
            Quadrature::Sine => -&angle.cos()?,
        };
        motion.push(&Expr::divide(&wave.factor, &wave.rate)? * &along);
    }
    Ok(Expr::sum(motion))
}
