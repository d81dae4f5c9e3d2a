//! What `impact` reads of a problem file: the undamped pendulum and its barrier, released from rest.

use thiserror::Error;

use super::{Barrier, Order, Problem, ProblemError, Reader, UnreadKey};
use crate::impact::{Rule, Setup, UnknownRule};

/// Why a file describes no impact in closed form.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ImpactFileError {
    /// A key that belongs to another command.
    #[error(transparent)]
    Unread(#[from] UnreadKey),
    /// The design, or the rule.
    #[error(transparent)]
    Problem(#[from] ProblemError),
    /// Something that damps.
    #[error(
        "the three phases in closed form are those of the undamped equation (9): leave out zeta, alpha, mu and lambda, or use \
         `lindstedt simulate`"
    )]
    Damped,
    /// A moving pivot.
    #[error(
        "the three phases in closed form are those of the free motion, equation (9): leave out [excitation], or use \
         `lindstedt simulate`"
    )]
    Driven,
    /// Another start.
    #[error(
        "the three phases begin at rest at x = -amplitude: leave out `start` and `speed`, or use `lindstedt simulate`"
    )]
    Start,
    /// The degrees of an approximant.
    #[error("the order of the law is one whole number")]
    Degrees,
    /// An equation of its own.
    #[error("the swing of an impact is x'' + sin(x) = 0: leave out `equation`, or use `lindstedt derive`")]
    Equation,
    /// Another method.
    #[error("the law of the approach is derived by lindstedt-poincare: leave out `method`")]
    Method,
    /// A left barrier in the way.
    #[error(
        "released from rest at x = -amplitude the pendulum starts behind the left barrier: move it below -amplitude"
    )]
    LeftBarrier,
}

impl TryFrom<&Problem> for Setup {
    type Error = ImpactFileError;

    /// ```
    /// use lindstedt::impact::{Setup, solve};
    /// use lindstedt::problem::Problem;
    ///
    /// let file: Problem = "[contact]\ngamma = 1e6".parse()?;
    /// let impact = solve(Setup::try_from(&file)?)?;
    /// assert!((impact.truth.penetration - 0.00544677).abs() < 1e-8);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    fn try_from(problem: &Problem) -> Result<Self, ImpactFileError> {
        problem.check_keys(Reader::Impact)?;
        let (damping, contact) = (&problem.damping, &problem.contact);
        let contact_damping = contact.mu.or(contact.lambda).unwrap_or(0.0);
        if damping.zeta != 0.0 || damping.alpha != 0.0 || contact_damping != 0.0 {
            return Err(ImpactFileError::Damped);
        }
        if problem.excitation.beta != 0.0 {
            return Err(ImpactFileError::Driven);
        }
        if problem.pendulum.start.is_some() || problem.pendulum.speed.is_some() {
            return Err(ImpactFileError::Start);
        }
        let usual = Self::default();
        let order = match problem.order {
            None => usual.order,
            Some(Order::Power(order)) => order,
            Some(Order::Degrees(_)) => return Err(ImpactFileError::Degrees),
        };
        if problem.equation.is_some() {
            return Err(ImpactFileError::Equation);
        }
        if problem
            .method
            .as_deref()
            .is_some_and(|name| name != "lindstedt-poincare")
        {
            return Err(ImpactFileError::Method);
        }
        let amplitude = problem.pendulum.amplitude;
        let barrier = match problem.pendulum.barrier {
            Barrier::Right(position) => position,
            // A left barrier beyond the release is never touched again.
            Barrier::Both([left, right]) if left < -amplitude => right,
            Barrier::Both(_) => return Err(ImpactFileError::LeftBarrier),
        };
        let (stiffness, source) = problem.stiffness().map_err(ProblemError::from)?;
        Ok(Self {
            amplitude,
            barrier,
            stiffness,
            stiffness_source: source.to_owned(),
            order,
            rule: linearisation(problem).map_err(ProblemError::from)?,
            integrator_tolerance: problem.run.integrator_tolerance,
            step_limit: problem.run.step_limit,
        })
    }
}

/// The rule that replaces the elastic force by a line.
fn linearisation(problem: &Problem) -> Result<Rule, UnknownRule> {
    match &problem.contact.linearisation {
        None => Ok(Rule::default()),
        Some(name) => name.parse(),
    }
}
