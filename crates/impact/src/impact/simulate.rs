//! The pendulum in full: the paper's equation (7) with every term on, followed event by event.
//!
//! ```text
//! x'' + 2 zeta x' + alpha sgn(x') - beta sin(Omega t/omega) cos x + sin x + F(x - x_c, x') = 0    equation (7)
//! F(d, d') = max(0, gamma + mu d') d^(3/2) H(d)
//! E(t) - E(0) = W_viscous + W_friction + W_contact + W_excitation
//! ```
//!
//! In: a [`Model`], a [`Start`], [`Settings`]. Out: a [`Simulation`], by one of two integrators
//! that share the forces of the model and nothing else:
//!
//! - [`Integrator::Taylor`], the fast one: power series, in contact those of the regularised
//!   equation, and the events as roots of polynomials.
//! - [`Integrator::RungeKutta`], for verification: the library's Runge-Kutta in phases.
//! - [`Integrator::Chain`], which does not integrate: closed forms, good to a part of a percent.

use thiserror::Error;

use super::chain::{ChainError, chain, chains};
use super::model::{Model, ModelError, Start};
use super::simulation::{Integrator, Settings, Simulation, SimulationStop, size};
use super::{judge, taylor};
use crate::numeric::ode::IntegrationError;
use crate::trajectory::DISPLACEMENT;

/// The reason why a simulation cannot begin.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// The model or the start.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A duration that is not a positive number.
    #[error("the duration must be a positive number, not {0}")]
    Duration(f64),
    /// A motion so small that the force of a barrier underflows.
    #[error(
        "the motion is of size {0:e}, at which the force of a barrier, d^(3/2), underflows: scale it up, below 1e-8 or so \
         the swing is linear"
    )]
    TooSmall(f64),
    /// A tolerance no double-precision run can keep.
    #[error(
        "the integrator's tolerance must lie between 1e-15 and 0.01, not {0:e}: 1e-10 is a good choice"
    )]
    Tolerance(f64),
    /// There is no chain of closed forms.
    #[error(transparent)]
    Chain(#[from] ChainError),
    /// Runge-Kutta cannot begin.
    #[error("Runge-Kutta: {0}")]
    RungeKutta(#[from] IntegrationError),
}

/// The smallest motion that can be followed: its depths to the power 5/2 do not underflow.
const SMALLEST: f64 = 1e-100;

/// The motion from this start.
///
/// # Errors
/// [`SimulationError`] if it cannot begin. A motion that ends early is not an error: see
/// [`Simulation::stop`].
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::{Integrator, Model, Settings, Start, simulate};
///
/// let model = Model { gamma: 1e6, zeta: 0.02, mu: 1e5, ..Model::default() };
/// let start = Start { x: -1.5, velocity: 0.0 };
/// let motion = simulate(&model, start, Integrator::Taylor, &Settings::default())?;
/// assert!(motion.impacts[0].restitution.is_some_and(|e| e < 1.0));
/// assert!(motion.energy().residual.abs() < 1e-9);
/// # Ok::<(), lindstedt::impact::SimulationError>(())
/// ```
pub fn simulate(
    model: &Model,
    start: Start,
    integrator: Integrator,
    settings: &Settings,
) -> Result<Simulation, SimulationError> {
    check(model, start, settings)?;
    match integrator {
        Integrator::Taylor => Ok(taylor::simulate_one(*model, start, *settings)),
        Integrator::RungeKutta => Ok(judge::follow(model, start, settings)?),
        Integrator::Chain => Ok(chain(model, start, settings)?),
    }
}

/// The time until which a motion with a moving pivot is known to six digits of its size, among two
/// thousand instants; later, a start with the relative displacement [`DISPLACEMENT`] leads
/// elsewhere. `None` if it is known to the end, if the pivot is at rest (such motions are regular),
/// or without a path. The cost is that of the motion.
///
/// ```text
/// errors of the integration grow as the displacement does: six digits are lost where it has grown 1e-6/tolerance times
/// ```
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::{Integrator, Model, Settings, Start, known_until, simulate};
///
/// let start = Start { x: -1.5, velocity: 0.0 };
/// let motion = simulate(&Model::default(), start, Integrator::Taylor, &Settings::default())?;
/// assert_eq!(known_until(&motion), None);
/// # Ok::<(), lindstedt::impact::SimulationError>(())
/// ```
pub fn known_until(motion: &Simulation) -> Option<f64> {
    const SIX_DIGITS: f64 = 1e-6;
    const LOOKS: usize = 2000;
    if motion.model.beta == 0.0 || matches!(motion.stop, SimulationStop::Interrupted { .. }) {
        return None;
    }
    let displaced =
        |value: f64| value + DISPLACEMENT * if value == 0.0 { motion.model.beta } else { value };
    let start = Start { x: displaced(motion.start.x), velocity: displaced(motion.start.velocity) };
    let other = simulate(&motion.model, start, motion.integrator, &motion.settings).ok()?;
    let until = motion.end_time.min(other.end_time);
    let places = (0..=LOOKS).filter_map(|look| {
        let time = until * look as f64 / LOOKS as f64;
        Some((time, motion.path.phase_point_at(time)?.0, other.path.phase_point_at(time)?.0))
    });
    let places: Vec<(f64, f64, f64)> = places.collect();
    let size = places.iter().fold(0.0_f64, |size, (_, x, _)| size.max(x.abs()));
    let lost = DISPLACEMENT * SIX_DIGITS / motion.settings.relative_tolerance.max(f64::EPSILON);
    let is_lost = |(_, x, other): &&(f64, f64, f64)| (x - other).abs() > lost * size;
    let first = places.iter().position(|place| is_lost(&place))?;
    Some(first.checked_sub(1).map_or(0.0, |last| places[last].0))
}

/// Many motions on one core, by Taylor series and by the chain several at a time: each exactly as by
/// [`simulate`].
///
/// # Errors
/// As [`simulate`], for the first that cannot begin, with its number.
///
/// ```
/// # use lindstedt_impact as lindstedt;
/// use lindstedt::impact::{Integrator, Model, Settings, Start, simulate_many};
///
/// let start = Start { x: -1.5, velocity: 0.0 };
/// let motions = [0.0, 0.1].map(|zeta| (Model { zeta, ..Model::default() }, start));
/// let found = simulate_many(&motions, Integrator::Taylor, &Settings::default()).map_err(|(_, error)| error)?;
/// assert!(found[1].impacts[0].speed_in < found[0].impacts[0].speed_in);
/// # Ok::<(), lindstedt::impact::SimulationError>(())
/// ```
pub fn simulate_many(
    motions: &[(Model, Start)],
    integrator: Integrator,
    settings: &Settings,
) -> Result<Vec<Simulation>, (usize, SimulationError)> {
    let mut results: Vec<Option<Result<Simulation, SimulationError>>> =
        motions.iter().map(|_| None).collect();
    simulate_each(motions, integrator, settings, &mut |number, motion| {
        results[number] = Some(motion);
    });
    let numbered = results.into_iter().flatten().enumerate();
    numbered.map(|(number, motion)| motion.map_err(|error| (number, error))).collect()
}

/// [`simulate_many`], each passed on with its number as it ends, or cannot begin: what is kept of it
/// may be less than the whole.
pub(crate) fn simulate_each(
    motions: &[(Model, Start)],
    integrator: Integrator,
    settings: &Settings,
    done: &mut dyn FnMut(usize, Result<Simulation, SimulationError>),
) {
    let mut begins: Vec<usize> = Vec::with_capacity(motions.len());
    for (number, (model, start)) in motions.iter().enumerate() {
        match check(model, *start, settings) {
            Ok(()) => begins.push(number),
            Err(error) => done(number, Err(error)),
        }
    }
    let begun = begins.iter().map(|number| (*number, motions[*number]));
    match integrator {
        Integrator::Taylor => {
            let runs =
                begun.map(|(_, (model, start))| taylor::Runner::new(model, start, *settings));
            taylor::follow(runs, |number, runner| {
                let number = begins[number];
                done(number, Ok(runner.finish(motions[number].1)));
            });
        }
        Integrator::Chain => chains(begun, settings, &mut |number, motion| {
            done(number, motion.map_err(SimulationError::from));
        }),
        Integrator::RungeKutta => {
            for (number, (model, start)) in begun {
                done(number, judge::follow(&model, start, settings).map_err(SimulationError::from));
            }
        }
    }
}

fn check(model: &Model, start: Start, settings: &Settings) -> Result<(), SimulationError> {
    model.check(start)?;
    let size = size(model, start);
    if size > 0.0 && size < SMALLEST {
        return Err(SimulationError::TooSmall(size));
    }
    if !(settings.duration.is_finite() && settings.duration > 0.0) {
        return Err(SimulationError::Duration(settings.duration));
    }
    if !(1e-15..=0.01).contains(&settings.relative_tolerance) {
        return Err(SimulationError::Tolerance(settings.relative_tolerance));
    }
    if !(f64::MIN_POSITIVE..=0.01).contains(&settings.absolute_tolerance) {
        return Err(SimulationError::Tolerance(settings.absolute_tolerance));
    }
    Ok(())
}
