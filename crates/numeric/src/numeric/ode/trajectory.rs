//! The path of a run: its values at every time between its ends, the events it met, and the reason
//! why it stopped.
//!
//! Each accepted step is kept as one polynomial for each value in the fraction s of the step,
//! written `x(s) = x0 + s q(s)`, so that a motion that starts on a surface leaves it with the right
//! sign however small s is. `q` is a Chebyshev series through the values of the method's own
//! interpolant.

use std::f64::consts::PI;
use std::fmt;
use std::sync::LazyLock;

use super::State;
use super::sample::Sample;

/// Terms of the Chebyshev series of a step: the interpolant has degree 8 in s, its quotient by s
/// has degree 7.
pub(super) const TERMS: usize = 8;

/// The fractions of a step at which its interpolant is read: Chebyshev points, neither 0 nor 1.
pub(super) static FRACTIONS: LazyLock<[f64; TERMS]> = LazyLock::new(|| {
    std::array::from_fn(|index| 0.5 * (1.0 - (PI * (index as f64 + 0.5) / TERMS as f64).cos()))
});

/// The numerical solution of x'' = g(t, x, v), or of any first-order equations, on an interval of
/// time, as a function.
#[derive(Debug, Clone)]
pub struct Trajectory<S: Sample = State> {
    pub(super) start: S,
    pub(super) end: S,
    pub(super) steps: Vec<TrajectoryStep<S>>,
    pub(super) occurrences: Vec<EventOccurrence<S>>,
    pub(super) stop_reason: StopReason,
    pub(super) evaluations: usize,
}

/// One occurrence of an event.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EventOccurrence<S = State> {
    /// Index of the phase whose right side was in force (0 for [`integrate`](super::integrate)).
    pub phase: usize,
    /// Index of the event in that phase's list.
    pub event: usize,
    /// The state at the event, before a switch changed it.
    pub state: S,
    /// Whether the function crossed zero from negative to positive.
    pub rising: bool,
}

/// The reason why a run ended. Everything before that moment is kept.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StopReason {
    /// The end time was reached.
    EndReached,
    /// A stopping event was met: the last of [`Trajectory::occurrences`].
    Event {
        /// Index of the phase.
        phase: usize,
        /// Index of the event in that phase's list.
        event: usize,
    },
    /// The acceleration, the state or an event function had no finite value just after this time.
    NonFinite {
        /// The last time with a finite state.
        time: f64,
    },
    /// The allowed number of steps was used up.
    MaximumSteps {
        /// The last time reached.
        time: f64,
    },
    /// The run was interrupted.
    Interrupted {
        /// The last time reached.
        time: f64,
    },
    /// The steps became too small to advance the clock: a singularity, or a tolerance beyond double
    /// precision.
    StepTooSmall {
        /// The last time reached.
        time: f64,
    },
    /// Switches followed each other without progress of time.
    SwitchingStalled {
        /// The time at which it happened.
        time: f64,
    },
}

impl fmt::Display for StopReason {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Interrupted { time } => {
                write!(formatter, "the run was stopped from outside at t = {time}")
            }
            Self::EndReached => write!(formatter, "the end time was reached"),
            Self::Event { phase, event } => {
                write!(formatter, "event {event} of phase {phase} stopped the run")
            }
            Self::NonFinite { time } => write!(
                formatter,
                "no finite value after t = {time}: the motion leaves the domain of the equation or escapes to infinity"
            ),
            Self::MaximumSteps { time } => write!(
                formatter,
                "the allowed number of steps was used up at t = {time}: allow more, shorten the run or loosen the \
                 tolerance"
            ),
            Self::StepTooSmall { time } => write!(
                formatter,
                "the steps became too small at t = {time}: the equation is singular or very stiff there, or the \
                 tolerance is too tight"
            ),
            Self::SwitchingStalled { time } => write!(
                formatter,
                "the motion switches phases without time going on at t = {time}: let the switch lead to a phase that \
                 leaves the surface or stays on it"
            ),
        }
    }
}

impl Trajectory {
    /// Displacement and velocity at time `t`; `None` outside the time covered. Where a switch
    /// changed the state, the value after the switch.
    pub fn phase_point_at(&self, t: f64) -> Option<(f64, f64)> {
        self.state_at(t).map(|state| (state.x, state.v))
    }
}

impl<S: Sample> Trajectory<S> {
    /// The state at time `t`; `None` outside the time covered. Where a switch changed the state,
    /// the one after the switch.
    pub fn state_at(&self, t: f64) -> Option<S> {
        if t == self.end.time() {
            return Some(self.end.clone());
        }
        if !(self.start.time()..self.end.time()).contains(&t) {
            return None;
        }
        let step = self.steps.get(self.step_index(t)?)?;
        Some(S::new(t, step.values_at((t - step.start.time()) / step.length)))
    }

    /// The initial state.
    pub fn start(&self) -> S {
        self.start.clone()
    }

    /// The last state reached.
    pub fn end(&self) -> S {
        self.end.clone()
    }

    /// The states between which the method stepped, first and last included. A switch that changed
    /// the state shows the state after it.
    pub fn knots(&self) -> impl Iterator<Item = S> + '_ {
        self.steps.iter().map(|step| step.start.clone()).chain(std::iter::once(self.end.clone()))
    }

    /// `count` states at equal distances of time, both ends included (for `count` of at least 2).
    pub fn samples(&self, count: usize) -> impl Iterator<Item = S> + '_ {
        let (from, to) = (self.start.time(), self.end.time());
        (0..count).filter_map(move |index| {
            let fraction = index as f64 / (count.max(2) - 1) as f64;
            self.state_at(if index + 1 == count { to } else { from + fraction * (to - from) })
        })
    }

    /// The events met, in the order of time.
    pub fn occurrences(&self) -> &[EventOccurrence<S>] {
        &self.occurrences
    }

    /// Index of the phase in force at time `t`; `None` outside the time covered.
    pub fn phase_at(&self, t: f64) -> Option<usize> {
        if !(self.start.time()..=self.end.time()).contains(&t) {
            return None;
        }
        self.steps.get(self.step_index(t)?).map(|step| step.phase)
    }

    /// The reason why the run ended.
    pub fn stop_reason(&self) -> StopReason {
        self.stop_reason
    }

    /// Whether the end time or a stopping event was reached: false where the run had to give up.
    pub fn is_complete(&self) -> bool {
        matches!(self.stop_reason, StopReason::EndReached | StopReason::Event { .. })
    }

    /// Number of accepted steps.
    pub fn step_count(&self) -> usize {
        self.steps.len()
    }

    /// Number of times the right side was evaluated.
    pub fn evaluations(&self) -> usize {
        self.evaluations
    }

    fn step_index(&self, t: f64) -> Option<usize> {
        self.steps.partition_point(|step| step.start.time() <= t).checked_sub(1)
    }
}

/// One accepted step, or the part of it before an event.
#[derive(Debug, Clone)]
pub(super) struct TrajectoryStep<S: Sample> {
    pub(super) phase: usize,
    pub(super) start: S,
    /// The length of the whole step: the unit of the fraction s.
    pub(super) length: f64,
    /// The coefficients of `q`, term by term.
    quotient: [S::Values; TERMS],
}

impl<S: Sample> TrajectoryStep<S> {
    /// The interpolant through the values at [`FRACTIONS`].
    pub(super) fn new(phase: usize, start: S, length: f64, values: [S::Values; TERMS]) -> Self {
        let origin = start.values();
        let mut quotient = values;
        for (component, origin) in origin.as_ref().iter().enumerate() {
            let samples: [f64; TERMS] = std::array::from_fn(|index| {
                (quotient[index].as_ref()[component] - origin) / FRACTIONS[index]
            });
            for (term, coefficient) in quotient.iter_mut().zip(chebyshev_coefficients(&samples)) {
                term.as_mut()[component] = coefficient;
            }
        }
        Self { phase, start, length, quotient }
    }

    /// The interpolant with these terms of its quotient.
    pub(super) fn from_quotient(
        phase: usize,
        start: S,
        length: f64,
        quotient: [S::Values; TERMS],
    ) -> Self {
        Self { phase, start, length, quotient }
    }

    /// The terms of the quotient, whose memory may serve for the next step.
    pub(super) fn into_quotient(self) -> [S::Values; TERMS] {
        self.quotient
    }

    /// The largest change within the step, and a little more, of a sum of the first values with these
    /// factors: a Chebyshev series is nowhere larger than the sum of its coefficients.
    pub(super) fn largest_change(&self, factors: &[f64]) -> f64 {
        /// Allowance for rounding.
        const MORE: f64 = 1.0 + 1e-9;
        let term = |values: &S::Values| -> f64 {
            factors.iter().zip(values.as_ref()).map(|(factor, value)| factor * value).sum()
        };
        MORE * self.quotient.iter().map(|values| term(values).abs()).sum::<f64>()
    }

    /// The values at the fraction s of the step.
    pub(super) fn values_at(&self, fraction: f64) -> S::Values {
        self.state_at(fraction).values()
    }

    /// The state at the fraction s of the step.
    pub(super) fn state_at(&self, fraction: f64) -> S {
        let mut state = self.start.clone();
        self.set_first_at(fraction, usize::MAX, &mut state);
        state
    }

    /// Sets the first `count` values of a state, and its time, to those at the fraction s of the step.
    pub(super) fn set_first_at(&self, fraction: f64, count: usize, state: &mut S) {
        state.set(self.start.time() + fraction * self.length, count, |component| {
            let rise = clenshaw(|term| self.quotient[term].as_ref()[component], fraction);
            self.start.value(component) + fraction * rise
        });
    }
}

/// Row k: `(2 - [k = 0])/n cos(k angle_j)`, the discrete cosine transform at the points of
/// [`FRACTIONS`].
static TRANSFORM: LazyLock<[[f64; TERMS]; TERMS]> = LazyLock::new(|| {
    std::array::from_fn(|k| {
        let weight = if k == 0 { 1.0 } else { 2.0 } / TERMS as f64;
        // s = (1 - cos angle)/2 is the variable -cos(angle) = cos(pi - angle) on [-1, 1].
        std::array::from_fn(|j| {
            weight * (k as f64 * PI * (1.0 - (j as f64 + 0.5) / TERMS as f64)).cos()
        })
    })
});

/// The weights of the samples at [`FRACTIONS`] in each term of a Chebyshev series.
pub(super) fn quotient_weights() -> [[f64; TERMS]; TERMS] {
    *TRANSFORM
}

fn chebyshev_coefficients(values: &[f64; TERMS]) -> [f64; TERMS] {
    std::array::from_fn(|k| {
        TRANSFORM[k].iter().zip(values).map(|(weight, value)| weight * value).sum()
    })
}

/// Sum of the Chebyshev series in `2 fraction - 1` (Clenshaw 1955).
#[inline]
fn clenshaw(coefficient: impl Fn(usize) -> f64, fraction: f64) -> f64 {
    let argument = 2.0 * fraction - 1.0;
    let (mut newer, mut older) = (0.0, 0.0);
    for term in (1..TERMS).rev() {
        (newer, older) = (2.0 * argument * newer - older + coefficient(term), newer);
    }
    argument * newer - older + coefficient(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_reproduces_every_polynomial_it_can_hold() {
        // x(s) = 0.3 + s P(s), v(s) = -1 + s R(s) with P, R of degree 7, on the step from t = 2 to
        // t = 2.5.
        let p = |s: f64| 1.0 - 3.0 * s + 0.5 * s.powi(5) - 2.0 * s.powi(7);
        let r = |s: f64| 4.0 * s.powi(3) - s.powi(6);
        let start = State { t: 2.0, x: 0.3, v: -1.0 };
        let values = FRACTIONS.map(|s| [start.x + s * p(s), start.v + s * r(s)]);
        let step = TrajectoryStep::new(0, start, 0.5, values);
        for index in 0..=50 {
            let s = f64::from(index) / 50.0;
            let [x, v] = step.values_at(s);
            assert!((x - start.x - s * p(s)).abs() < 1e-14, "x at {s}");
            assert!((v - start.v - s * r(s)).abs() < 1e-14, "v at {s}");
        }
        assert_eq!(step.values_at(0.0), [0.3, -1.0]);
        // Next to the start the sign of x - x0 is that of s P(0), down to the last bit.
        assert!(step.values_at(1e-15)[0] > 0.3);
    }
}
