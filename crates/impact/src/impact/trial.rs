//! A trial: the problem of an impact, its true motion, and derived phases that are compared with
//! it.
//!
//! In: a [`Setup`](super::Setup) and the methods to try. Out: the derived phases of the first order
//! and method that pass, and an [`Attempt`] for each that was tried. All comparisons are made in z
//! = s (x - x_e), which runs from the equilibrium towards the barrier.

use super::collision::{Collision, CollisionError};
use super::contact::hunt_crossley::restitution;
use super::contact::power_law::exponent_of;
use super::contact::{ContactError, ContactLaw, ContactRow, LossyContact, Touch, comparison};
use super::derived::{DerivedContact, Flight, phases_of};
use super::error::ImpactError;
use super::judge::{Deviation, TrueImpact, assured_impact, deviation};
use super::lossy_laws::{LossyRow, lossy_rows};
use super::phases::ThreePhases;
use super::setup::{ContactLoss, ImpactEquations, LossAmount, Setup};
use crate::method;
use crate::method::table::{Choice, MethodEntry};
use crate::numeric::ode::IntegrationOptions;
use crate::solution::{Counts, Degrees, Method, Solution};

/// A method that was tried for the derived column.
#[derive(Clone, Debug, PartialEq)]
pub struct Attempt {
    /// The method.
    pub method: Method,
    /// Its order; `None` if it has none.
    pub order: Option<u32>,
    /// Its degrees; `None` if it has none.
    pub degrees: Option<Degrees>,
    /// The largest relative error, or the reason why there is none. If one of the five numbers is
    /// beyond the tolerance already, only these count; if the contact is not the exact one, only
    /// the approach.
    pub error: Result<f64, String>,
}

/// The problem of an impact with its true motion.
pub(super) struct Trial<'a> {
    pub(super) setup: &'a Setup,
    pub(super) equations: &'a ImpactEquations,
    /// The start of the cycle, in x: the release, or the turning point of a motion released inside
    /// the barrier.
    pub(super) turning_point: f64,
    /// The collision, in z.
    pub(super) collision: Collision<'a>,
    pub(super) truth: TrueImpact,
    /// The speed at the touch from the energy.
    pub(super) energy_speed: f64,
}

/// Three phases that a method derives.
pub(super) struct Derived {
    /// The swing.
    pub(super) flight: Flight,
    /// The phases, in x.
    pub(super) phases: ThreePhases,
    /// Their contact.
    pub(super) contact: DerivedContact,
    /// Their largest error; that of the approach if the contact is not the exact one.
    error: f64,
}

/// An order or degrees of a method.
type Rung = (Option<u32>, Option<Degrees>);

/// The highest order of a method that is tried if none is given: high for expansions and balances,
/// low for the others, which become slow; a third pass of iteration perturbation may take minutes.
fn highest_order(method: Method) -> u32 {
    match method {
        Method::LindstedtPoincare | Method::HarmonicBalance => 16,
        Method::IterationPerturbation => 2,
        _ => 4,
    }
}

/// Number of consecutive orders without progress that end the search.
const PATIENCE: usize = 4;

impl Trial<'_> {
    /// Follows the true motion and calls `run` with the trial.
    ///
    /// # Errors
    /// A barrier out of reach, a release that does not lead to it, numbers that are not finite.
    pub(super) fn run<R>(
        setup: &Setup,
        body: impl FnOnce(&Trial) -> Result<R, ImpactError>,
    ) -> Result<R, ImpactError> {
        let equations = setup.equations()?;
        let (sign, origin) = (setup.side.sign(), equations.equilibrium);
        let z = |x: f64| sign * (x - origin);
        let collision = Collision {
            release: z(setup.release),
            barrier: z(setup.barrier),
            stiffness: equations.stiffness,
            restoring_force: &|z: f64| sign * equations.restoring_force(origin + sign * z),
            elastic_force: &|depth: f64| equations.elastic_force(depth),
            damping: 0.0,
            dashpot: setup.loss.and_then(|loss| loss.law.dashpot()),
        };
        let seen = |error: CollisionError| error.seen_from(sign, origin);
        let inside = collision.release > collision.barrier && collision.barrier.is_finite();
        if inside && setup.loss.is_some() {
            return Err(ImpactError::InsideWithLoss);
        }
        let collision = Collision {
            release: match inside {
                true => collision.turning_point(collision.release).map_err(seen)?,
                false => collision.release,
            },
            ..collision
        };
        collision.check().map_err(seen)?;
        let energy_speed = collision.contact_speed().map_err(seen)?;
        let exponent = exponent_of(collision.elastic_force);
        let is_spring = exponent.is_some_and(|exponent| (exponent - 1.0).abs() < 1e-9);
        if let (Some(dashpot), false) = (collision.dashpot, is_spring) {
            let force =
                setup.force.as_ref().map_or("gamma*d^(3/2)".to_owned(), |own| own.to_string());
            return Err(ImpactError::NoSpring { law: dashpot.name(), force });
        }
        let stiffness = collision.stiffness * (collision.elastic_force)(1.0);
        let damping = match setup.loss {
            None => 0.0,
            Some(ContactLoss { amount: LossAmount::Damping(damping), .. }) => damping,
            Some(ContactLoss { law, amount: LossAmount::Restitution(wanted) }) => {
                law.damping_for(wanted, stiffness, energy_speed)?
            }
        };
        if collision.dashpot.is_none() {
            restitution(damping * energy_speed)?;
        }
        if let (Some(_), None, Some(force)) = (setup.loss, exponent, &setup.force) {
            return Err(ImpactError::NoPower { force: force.to_string() });
        }
        let collision = Collision { damping, ..collision };
        let truth =
            assured_impact(&collision, &integration_options(setup)).map_err(
                |error| match error {
                    ImpactError::Collision(error) => seen(error).into(),
                    other => other,
                },
            )?;
        body(&Trial {
            setup,
            equations: &equations,
            turning_point: match inside {
                true => origin + sign * collision.release,
                false => setup.release,
            },
            collision,
            truth,
            energy_speed,
        })
    }

    /// The largest deviation of these phases, in x, from the true motion.
    pub(super) fn deviation(&self, phases: &ThreePhases) -> Deviation {
        let sign = self.setup.side.sign();
        let seen = phases.moved(sign, -sign * self.equations.equilibrium);
        deviation(&seen, &self.truth)
    }

    /// The derived phases of the first of these methods that passes, else of the best; and the
    /// attempts.
    pub(super) fn derived(&self, methods: &[Method]) -> (Option<Derived>, Vec<Attempt>) {
        let mut tried: Vec<Attempt> = Vec::new();
        let mut best: Option<Derived> = None;
        for &method in methods {
            let (found, attempts) = self.raise_order(method);
            tried.extend(attempts);
            best = with_smaller_error(best, found);
            if best.as_ref().is_some_and(|best| best.error <= self.setup.tolerance) {
                break;
            }
        }
        (best, tried)
    }

    /// The derived phases of a method: at the order asked for, or at the lowest that passes, else
    /// at the best.
    fn raise_order(&self, method: Method) -> (Option<Derived>, Vec<Attempt>) {
        let setup = self.setup;
        let takes = |choice| MethodEntry::for_method(method).takes(choice);
        let same = |n| match method.counts() {
            Counts::Degrees(count) => Degrees::from_list(&vec![n; count]),
            _ => None,
        };
        let rungs: Vec<Rung> = match (setup.order, setup.degrees) {
            (None, None) if takes(Choice::Degrees) => {
                (1..=highest_order(method)).map(|n| (None, same(n))).collect()
            }
            (None, None) if takes(Choice::Order) => {
                (1..=highest_order(method)).map(|order| (Some(order), None)).collect()
            }
            chosen => vec![chosen],
        };
        let mut tried: Vec<Attempt> = Vec::new();
        let mut best: Option<Derived> = None;
        let mut last: Option<Solution> = None;
        for (order, degrees) in rungs {
            let options = method::Options {
                method: Some(method),
                order,
                degrees,
                amplitude: setup.amplitude_convention,
                ..Default::default()
            };
            let flight =
                Flight::derive(self.equations, [self.turning_point, -setup.side.sign()], &options);
            // An order that does not change the formula is skipped.
            let solution = flight.as_ref().ok().map(|flight| &flight.solution);
            let same = |last: &Solution, new: &Solution| {
                last.law == new.law
                    && last.displacement == new.displacement
                    && !new.displacement.is_zero()
            };
            if let (Some(last), Some(new)) = (&last, solution)
                && same(last, new)
            {
                continue;
            }
            last = solution.cloned();
            // A method that refuses an order refuses the higher ones too, unless the first was too
            // low.
            let refused = matches!(flight, Err(ImpactError::Refusal(_)))
                && order.is_none_or(|order| order > 2);
            let found = flight.and_then(|flight| self.with_contact(flight));
            // A law that does not apply to this contact does not apply at any order.
            let no_law = matches!(found, Err(ImpactError::Contact(_)))
                && self.contact(self.energy_speed).is_err();
            tried.push(Attempt {
                method,
                order,
                degrees,
                error: found
                    .as_ref()
                    .map(|found| found.error)
                    .map_err(|reason| reason.without_title(method)),
            });
            best = with_smaller_error(best, found.ok());
            // If the error has not decreased over several orders, the expansion is beyond its
            // radius of convergence.
            let error = |attempt: &Attempt| attempt.error.clone().unwrap_or(f64::INFINITY);
            let stalls = tried.len() > PATIENCE && {
                let (before, lately) = tried.split_at(tried.len() - PATIENCE);
                let least =
                    |attempts: &[Attempt]| attempts.iter().map(error).fold(f64::INFINITY, f64::min);
                least(lately) >= least(before)
            };
            if refused
                || no_law
                || stalls
                || best.as_ref().is_some_and(|best| best.error <= setup.tolerance)
            {
                break;
            }
        }
        (best, tried)
    }

    /// The phases of this swing with their error.
    fn with_contact(&self, flight: Flight) -> Result<Derived, ImpactError> {
        let (touch, speed) = flight.touch(self.setup.barrier)?;
        let contact = self.contact(speed)?;
        let phases =
            phases_of(&flight, self.equations, self.setup.barrier, [touch, speed], &contact)?;
        // The swing must not compensate the error of an inaccurate contact law, so that only its
        // flight is judged then.
        let is_exact = self.setup.contact_law == ContactLaw::Exact && self.setup.loss.is_none();
        let numbers = self.number_errors(&phases);
        // If a number is beyond the tolerance, the phases are not compared.
        let numbers = worst(if is_exact { &numbers } else { &numbers[..2] });
        let error = match (numbers <= self.setup.tolerance, is_exact) {
            (true, true) => worst(&self.errors(&phases)),
            (true, false) => worst(&[numbers, self.errors(&phases)[5]]),
            (false, _) => numbers,
        };
        Ok(Derived { flight, phases, contact, error })
    }

    /// The contact entered at this speed, with the force of the swing if there is no loss.
    fn contact(&self, speed: f64) -> Result<DerivedContact, ContactError> {
        let touch = self.touch(speed);
        match self.setup.loss {
            None => {
                Ok(DerivedContact::Elastic(Box::new(touch.contact_by(self.setup.contact_law)?)))
            }
            Some(ContactLoss { law, .. }) => {
                let exponent = touch.exponent.ok_or(ContactError::NoPowerLaw)?;
                let stiffness = touch.stiffness * (touch.elastic_force)(1.0);
                let damping = self.collision.damping;
                let contact = LossyContact::new(law, exponent, stiffness, damping, speed)?;
                Ok(DerivedContact::Lossy(Box::new(contact)))
            }
        }
    }

    /// The contact problem at this speed.
    fn touch(&self, speed: f64) -> Touch<'_> {
        let Collision { barrier, stiffness, restoring_force, elastic_force, .. } = self.collision;
        Touch {
            speed,
            barrier,
            stiffness,
            restoring_force,
            slope: self.equations.slope(self.setup.barrier),
            elastic_force,
            exponent: exponent_of(elastic_force),
        }
    }

    /// Every law of the contact at the speed from the energy; empty if not requested.
    pub(super) fn contact_laws(&self) -> Result<Vec<ContactRow>, ContactError> {
        match self.setup.every_contact_law && self.setup.loss.is_none() {
            true => comparison(&self.touch(self.energy_speed)),
            false => Ok(vec![]),
        }
    }

    /// Every law of a contact that loses energy, for the restitution of the contact without the force of the swing;
    /// empty if not requested.
    pub(super) fn lossy_laws(&self) -> Result<Vec<LossyRow>, ImpactError> {
        let (true, Some(ContactLoss { amount, .. })) =
            (self.setup.every_contact_law, self.setup.loss)
        else {
            return Ok(vec![]);
        };
        let restitution = match amount {
            LossAmount::Restitution(restitution) => restitution,
            LossAmount::Damping(damping) => restitution(damping * self.energy_speed)?,
        };
        let exponent = exponent_of(self.collision.elastic_force);
        lossy_rows(
            &self.collision,
            exponent,
            [restitution, self.energy_speed],
            &integration_options(self.setup),
        )
    }

    /// The relative errors of three phases in x: time to contact, speed, penetration, duration,
    /// period, and the largest deviation in each phase on its own clock, of the flights over the
    /// amplitude and of the contact over the depth.
    pub(super) fn errors(&self, phases: &ThreePhases) -> [f64; 8] {
        let amplitude = self.collision.release.abs();
        let [approach, contact, back] = self.deviation(phases).aligned;
        let [time, speed, penetration, duration, period] = self.number_errors(phases);
        [
            time,
            speed,
            penetration,
            duration,
            period,
            approach / amplitude,
            contact / self.truth.penetration,
            back / amplitude,
        ]
    }

    /// The first five of these [errors](Self::errors).
    fn number_errors(&self, phases: &ThreePhases) -> [f64; 5] {
        let (found, truth) = (phases.quantities(), self.truth.quantities());
        std::array::from_fn(|index| found[index] / truth[index] - 1.0)
    }
}

/// The options of Runge-Kutta.
fn integration_options(setup: &Setup) -> IntegrationOptions {
    IntegrationOptions {
        maximum_steps: setup.step_limit as usize,
        ..IntegrationOptions::with_tolerance(setup.integrator_tolerance)
    }
}

/// The one with the smaller error.
fn with_smaller_error(one: Option<Derived>, other: Option<Derived>) -> Option<Derived> {
    match (one, other) {
        (Some(one), Some(other)) if other.error < one.error => Some(other),
        (one, other) => one.or(other),
    }
}

/// The largest absolute value; NaN counts as the largest.
pub(super) fn worst<'a>(errors: impl IntoIterator<Item = &'a f64>) -> f64 {
    errors.into_iter().fold(0.0, |worst: f64, error| match error.is_nan() {
        true => f64::INFINITY,
        false => worst.max(error.abs()),
    })
}
