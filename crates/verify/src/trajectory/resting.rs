//! The equations of a motion that rests on walls.
//!
//! ```text
//! q'' = f + sum_i d_i lambda_i,  g_i'' = 0 for every wall i that bears        lambda: linear equations with n_i.d_j
//! ```
//!
//! (F. Pfeiffer, C. Glocker, *Multibody Dynamics with Unilateral Contacts*, Wiley 1996, chapter 5.)

use super::{TrajectoryError, TrajectoryRequest};
use crate::expr::{Expr, ExprError};
use crate::mechanics::{MechanicsError, Rates, linear};
use crate::symbol::Symbol;
use crate::system::rate_along;
use crate::wall::{Wall, WallImpact};

/// A wall with the expressions that impacts and rest need.
#[derive(Clone, Debug)]
pub(super) struct WallEquations {
    pub(super) impact: WallImpact,
    /// g'' without the force of any wall.
    pub(super) free: Expr,
}

impl WallEquations {
    fn new(course: &TrajectoryRequest, wall: &Wall) -> Result<Self, TrajectoryError> {
        let Rates { states, right } = &course.rates;
        let impact = wall.impact(&course.coordinates, states, course.mass.as_deref())?;
        let free = rate_along(&impact.rate, Symbol::new("t"), states, right);
        let free = free.ok_or_else(|| TrajectoryError::WallWithCorner(wall.gap.clone()))?;
        Ok(Self { impact, free })
    }
}

/// The walls of a course with what impacts and rest need.
pub(super) fn equations(course: &TrajectoryRequest) -> Result<Vec<WallEquations>, TrajectoryError> {
    course.walls.iter().map(|wall| WallEquations::new(course, wall)).collect()
}

/// The equations of a motion that rests on some walls.
pub(super) struct RestingEquations {
    /// The rates of all states.
    pub(super) rates: Rates,
    /// The power of the walls, which moving ones have.
    pub(super) power: Expr,
    /// The functions at whose fall through zero a flight or a rest ends, one for each wall: its gap,
    /// or its force.
    pub(super) guards: Vec<Expr>,
}

/// The equations of a motion that rests on these walls.
///
/// # Errors
/// A bound that is not a wall; forces that the equations do not determine.
pub(super) fn resting_equations(
    course: &TrajectoryRequest,
    resting: &[usize],
) -> Result<RestingEquations, TrajectoryError> {
    let mut guards: Vec<Expr> = course.walls.iter().map(|wall| wall.gap.clone()).collect();
    let mut rates = course.rates.clone();
    if resting.is_empty() {
        return Ok(RestingEquations { rates, power: Expr::zero(), guards });
    }
    let walls = equations(course)?;
    let bearing: Vec<&WallEquations> = resting.iter().map(|index| &walls[*index]).collect();
    let mut power = Vec::new();
    if let [only] = bearing.as_slice()
        && course.coordinates.len() == 1
    {
        // x'' = -(g'' - n f)/n, in which the force f of flight cancels.
        let held = held_acceleration(course, only)?;
        let force = Expr::divide(&(&held - &rates.right[1]), &only.impact.direction[0])?;
        guards[resting[0]] = force.clone();
        power.push(&only.impact.normal[0] * Expr::from(rates.states[1]) * force);
        rates.right[1] = held;
    } else {
        let matrix: Vec<Vec<Expr>> = bearing
            .iter()
            .map(|one| bearing.iter().map(|other| one.impact.compliance(&other.impact)).collect())
            .collect();
        let right: Vec<Expr> = bearing.iter().map(|wall| -&wall.free).collect();
        let singular = || MechanicsError::Singular(matrix.iter().flatten().cloned().sum());
        let forces = linear::solution(&matrix, &right, &rates.states, singular)?;
        for ((index, wall), force) in resting.iter().zip(&bearing).zip(&forces) {
            let WallImpact { normal, direction, .. } = &wall.impact;
            for ((name, n), direction) in course.coordinates.iter().zip(normal).zip(direction) {
                let velocity = name.derivative();
                // A coordinate of an equation of first order has none.
                let place = rates.states.iter().position(|state| *state == velocity);
                let Some(place) = place else { continue };
                rates.right[place] = &rates.right[place] + &(direction * force);
                power.push(n * Expr::from(velocity) * force);
            }
            guards[*index] = force.clone();
        }
    }
    Ok(RestingEquations { rates, power: Expr::sum(power), guards })
}

/// The acceleration of one coordinate that stays on a wall.
fn held_acceleration(course: &TrajectoryRequest, wall: &WallEquations) -> Result<Expr, ExprError> {
    let [position, velocity] = [course.rates.states[0], course.rates.states[1]];
    let rest = Expr::sum([
        wall.impact.rate.differentiate(Symbol::new("t"))?,
        wall.impact.rate.differentiate(position)? * Expr::from(velocity),
    ]);
    Ok(-Expr::divide(&rest, &wall.impact.normal[0])?)
}
