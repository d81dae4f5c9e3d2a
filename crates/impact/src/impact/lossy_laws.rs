//! Every law of a contact that loses energy, for one restitution, beside the true motion.
//!
//! In: a collision and the restitution. Out: a [`LossyRow`] for each law, its closed form with the force of the swing
//! left out, and the numbers of Runge-Kutta with it. A spring with a dashpot has the stiffness of the line of equal
//! energy, `k D0^2/2 = int_0^D0 gamma F`, D0 the greatest depth without loss, so that contacts of the same barrier are
//! compared; for a barrier that is a spring k is its own.

use super::collision::Collision;
use super::contact::{ContactError, LossyContact, LossyLaw};
use super::error::ImpactError;
use super::judge::{TrueImpact, assured_impact};
use super::linearisation::{Rule, fit, greatest_depth};
use super::si::greatest;
use crate::numeric::ode::IntegrationOptions;

/// A law of a contact that loses energy, in closed form and by Runge-Kutta.
#[derive(Clone, Debug, PartialEq)]
pub struct LossyRow {
    /// The law.
    pub law: LossyLaw,
    /// The stiffness: the force, an acceleration, at depth one at rest.
    pub stiffness: f64,
    /// The damping lambda, time over the unit of x or, of a dashpot, time alone.
    pub damping: f64,
    /// Duration, greatest depth, greatest force of the contact per unit of mass, and restitution; in units of the
    /// equation.
    pub closed_form: [f64; 4],
    /// These four numbers by Runge-Kutta, the force of the swing in the contact.
    pub runge_kutta: [f64; 4],
}

impl LossyRow {
    /// The relative errors of the closed form, in the order of its numbers.
    pub fn errors(&self) -> [f64; 4] {
        std::array::from_fn(|index| self.closed_form[index] / self.runge_kutta[index] - 1.0)
    }
}

/// The rows of every law for this restitution at the speed of the touch, for a force F(d) of this exponent.
///
/// # Errors
/// A force that is no power of the depth; a motion that Runge-Kutta does not settle.
pub(super) fn lossy_rows(
    collision: &Collision,
    exponent: Option<f64>,
    [restitution, speed]: [f64; 2],
    options: &IntegrationOptions,
) -> Result<Vec<LossyRow>, ImpactError> {
    let exponent = exponent.ok_or(ContactError::NoPowerLaw)?;
    let energy = 0.5 * speed * speed / collision.stiffness;
    let deepest =
        greatest_depth(collision.elastic_force, energy).map_err(ContactError::Linearisation)?;
    let line = fit(Rule::EqualEnergy, collision.elastic_force, deepest)
        .map_err(ContactError::Linearisation)?;
    let spring = |depth: f64| depth;
    let row = |law: LossyLaw| {
        let of_law = match law.dashpot() {
            None => Collision { dashpot: None, ..*collision },
            dashpot => Collision {
                dashpot,
                stiffness: collision.stiffness * line.slope,
                elastic_force: &spring,
                ..*collision
            },
        };
        let stiffness = of_law.stiffness * (of_law.elastic_force)(1.0);
        let damping = law.damping_for(restitution, stiffness, speed)?;
        let of_law = Collision { damping, ..of_law };
        let exponent = if law.dashpot().is_some() { 1.0 } else { exponent };
        let numbers = LossyContact::new(law, exponent, stiffness, damping, speed)?.numbers();
        let truth = assured_impact(&of_law, options)?;
        Ok(LossyRow {
            law,
            stiffness,
            damping,
            closed_form: [numbers.duration, numbers.depth, numbers.peak_force, numbers.restitution],
            runge_kutta: [
                truth.duration,
                truth.penetration,
                greatest_force(&of_law, &truth),
                truth.restitution(),
            ],
        })
    };
    LossyLaw::ALL.into_iter().map(row).collect()
}

/// The greatest force of a true contact, its damping included, per unit of mass.
pub(super) fn greatest_force(collision: &Collision, truth: &TrueImpact) -> f64 {
    let force = |time: f64| match truth.contact.phase_point_at(time) {
        Some((depth, speed)) => collision.contact_force(depth, speed),
        None => 0.0,
    };
    greatest(force, 0.0, truth.duration)
}
