//! Errors of an impact in closed form.

use super::collision::CollisionError;
use super::contact::ContactError;
use super::judge::way_forward;
use super::linearisation::LinearisationError;
use super::trial::Attempt;
use crate::expr::{EvaluationError, ExprError, LostDigits};
use crate::method::Refusal;
use crate::method::numbers::NoNumbers;
use crate::numeric::ode::quadrature::QuadratureError;
use crate::numeric::ode::{IntegrationError, StopReason};
use crate::oscillator::OscillatorError;
use crate::solution::Method;
use crate::symbol::Symbol;
use crate::values::ValueError;

/// The reason why there is no impact to report: in its equation, its three phases, the derived
/// flight or the true motion.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ImpactError {
    /// The swing is not an oscillator.
    #[error(transparent)]
    Oscillator(#[from] OscillatorError),
    /// The force of the swing is not one of the position alone.
    #[error(
        "an impact in closed form needs a swing that keeps its energy, a force of the position alone, but `{term}` is more: \
         leave it out, or follow the motion by `lindstedt simulate`"
    )]
    NotOfPosition {
        /// The term.
        term: String,
    },
    /// A swing that is infinitely fast on its way.
    #[error(
        "the swing goes through x = {place}, where the force `{force}` and its speed are infinite: `impact` does not follow it through such a \
         place; give a barrier on the side of the release"
    )]
    InfinitelyFast {
        /// The force.
        force: String,
        /// The position.
        place: f64,
    },
    /// A release or a barrier so far out that the force of the swing has no digits there.
    #[error(transparent)]
    LostDigits(#[from] LostDigits),
    /// A parameter without a value.
    #[error("a value is needed for `{name}`")]
    NoValue {
        /// The parameter.
        name: Symbol,
    },
    /// A swing that the paper's reading does not cover.
    #[error(
        "the paper's cosine is that of a swing about x = 0 with f(-x) = -f(x), but the force is `{force}`"
    )]
    NotOdd {
        /// The force.
        force: String,
    },
    /// A contact that loses energy, in the paper's reading.
    #[error("its equations (13) to (16) are those of a contact that loses nothing")]
    LosesEnergy,
    /// A contact that loses energy, from inside the barrier.
    #[error(
        "a release inside the barrier is the deepest point of a cycle only where nothing is lost: release the motion outside, or leave \
         the loss out"
    )]
    InsideWithLoss,
    /// A contact that loses energy by a law that has no closed form.
    #[error(
        "a contact that loses energy needs a force that is a power of the depth, such as `gamma*d^(3/2)`, but it is `{force}`: give \
         another one, or leave the loss out"
    )]
    NoPower {
        /// The force.
        force: String,
    },
    /// A dashpot beside a force that is not a spring.
    #[error(
        "the law {law} is a spring with a dashpot, whose force is a number times the depth, but it is `{force}`: leave the force \
         out, which is gamma*d then, or take hunt-crossley"
    )]
    NoSpring {
        /// The law.
        law: &'static str,
        /// The force.
        force: String,
    },
    /// A value for a name that does not occur.
    #[error("there is no parameter `{name}`, neither in the swing nor in the force of the barrier")]
    Unknown {
        /// The name.
        name: Symbol,
    },
    /// A force that cannot be evaluated.
    #[error(transparent)]
    Evaluation(#[from] EvaluationError),
    /// A step of algebra failed.
    #[error(transparent)]
    Expression(#[from] ExprError),
    /// The law of the frequency ends below this amplitude.
    #[error(
        "omega^2 = {frequency_squared} at A = {amplitude}: the frequency law does not reach this amplitude; lower the \
         amplitude, or use a law of higher order"
    )]
    BeyondTheLaw {
        /// Its value.
        frequency_squared: f64,
        /// The amplitude.
        amplitude: f64,
    },
    /// The linear stiffness is negative enough to undo the contact, or not a number.
    #[error(
        "the linear stiffness f'(0) = {0} leaves no oscillation in the contact: give the slope of the force at x = 0"
    )]
    LinearStiffness(f64),
    /// The elastic force could not be replaced by a line.
    #[error(transparent)]
    Linearisation(#[from] LinearisationError),
    /// The method refuses.
    #[error(transparent)]
    Refusal(#[from] Refusal),
    /// The answer has no motion at these numbers.
    #[error(transparent)]
    Motion(#[from] NoNumbers),
    /// A value that is not a number.
    #[error(transparent)]
    Value(#[from] ValueError),
    /// The contact could not be computed.
    #[error(transparent)]
    Contact(#[from] ContactError),
    /// No amplitude of the law belongs to the release.
    #[error("no amplitude of the law turns round at the release")]
    NoAmplitude,
    /// No amplitude of the law belongs to the return.
    #[error("no amplitude of the law leaves the barrier with the speed {0}")]
    WayBack(f64),
    /// The derived motion does not touch the barrier.
    #[error("the derived motion does not reach the barrier: it swings from {from} to {to}")]
    NeverReaches {
        /// The start of the range.
        from: f64,
        /// The end of the range.
        to: f64,
    },
    /// The derived motion does not start at the release.
    #[error(
        "the derived motion starts at {start}, not at the release {release}: it has too few harmonics there, as next to a separatrix, \
         where a motion all but stops; lower the amplitude, or follow it by `lindstedt simulate`"
    )]
    Start {
        /// The start of the motion.
        start: f64,
        /// The position at which it should start.
        release: f64,
    },
    /// The pendulum does not hit the barrier.
    #[error(transparent)]
    Collision(#[from] CollisionError),
    /// The run gave up.
    #[error("the true motion could not be followed to the end of the impact: {}", way_forward(.0))]
    Stopped(StopReason),
    /// The motion still changes with the tolerance at the limit of double precision.
    #[error(
        "the true motion is not known to six digits, closer steps change it by {change:.0e}: double precision cannot tell \
         apart motions that start so near the top of the swing or turn so near the barrier; lower the amplitude, or move the \
         barrier"
    )]
    NotSettled {
        /// The change, relative to the quantity that changes most.
        change: f64,
    },
    /// The run could not begin.
    #[error(transparent)]
    Integration(#[from] IntegrationError),
    /// The energy could not be evaluated.
    #[error("the energy of the true motion could not be evaluated: {0}")]
    Energy(#[from] QuadratureError),
    /// No reading applies.
    #[error("no closed form: the paper's reading does not apply, {paper}; {}", attempts(.tried))]
    NoReading {
        /// The reason why the paper's version does not apply.
        paper: String,
        /// The other attempts.
        tried: Vec<Attempt>,
    },
}

impl ImpactError {
    /// The message without the name of the method at its head, for lists that name it already.
    pub fn without_title(&self, method: Method) -> String {
        match self {
            Self::Refusal(refusal) => refusal.without_title(method),
            other => other.to_string(),
        }
    }
}

fn attempts(tried: &[Attempt]) -> String {
    let reason = |attempt: &Attempt| {
        let reason = attempt.error.as_ref().err()?;
        Some(format!("{}: {reason}", attempt.method.title()))
    };
    let mut reasons: Vec<String> = tried.iter().filter_map(reason).collect();
    reasons.dedup();
    reasons.join("; ")
}
