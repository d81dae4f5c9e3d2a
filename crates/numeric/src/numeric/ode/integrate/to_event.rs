//! A step that ends at an event which ends the right side in force, in place of a step beyond it.

use differential_equations::ode::OrdinaryNumericalMethod;
use differential_equations::status::Status;

use super::Leg;
use crate::numeric::ode::event::{Action, SignTracker};
use crate::numeric::ode::sample::Sample;
use crate::numeric::ode::scheme::Scheme;
use crate::numeric::ode::trajectory::TrajectoryStep;

/// Change of the length of a step that is to end at an event, relative to it, below which it is the
/// last: the rest is a straight line.
const LAST: f64 = 1e-8;

/// A step that ends at an event.
pub(super) enum StepToEnd<S: Sample> {
    /// The step, and the event: the state, its index and whether its function rises.
    Found(TrajectoryStep<S>, (S, usize, bool)),
    /// One step does not lead there with the error allowed: shorter ones, the first of this length.
    TooLong(f64),
    /// No event ends the leg, or it is not met so: a motion that just grazes a surface.
    None,
}

impl<S: Sample> Leg<'_, '_, S> {
    /// Looks for a step that ends at the first event that ends the leg. The interpolant by which the
    /// event was found has a lower order than the step; and where another force acts beyond the event,
    /// it knows that force already. The length of the step follows by Newton's method, mostly in one
    /// step.
    pub(super) fn step_to_end<M: OrdinaryNumericalMethod<f64, S::Values>>(
        &self,
        scheme: &Scheme<M, S::Values>,
        (start, longest): (&S, f64),
        happenings: &[(S, usize, bool)],
    ) -> StepToEnd<S> {
        /// Largest number of steps, for a surface that is barely reached.
        const MOST: usize = 16;
        let ends = |(_, event, _): &&(S, usize, bool)| {
            !matches!(self.events[*event].action, Action::Record)
        };
        let Some((found, index, rising)) = happenings.iter().find(ends) else {
            return StepToEnd::None;
        };
        let value = |state: &S| (self.events[*index].function)(state);
        let shortest = 64.0 * f64::EPSILON * start.time().abs();
        let mut length = found.time() - start.time();
        for _ in 0..MOST {
            if !(length > shortest && length <= longest) {
                return StepToEnd::None;
            }
            let Some(mut solver) = self.solver(scheme, start, length) else {
                return StepToEnd::None;
            };
            let outcome = solver.step(&self.equations);
            if outcome.is_err() || self.equations.non_finite.get() {
                return StepToEnd::None;
            }
            if matches!(solver.status(), Status::RejectedStep) {
                return StepToEnd::TooLong(0.5 * length);
            }
            let Some((step, end)) = self.accepted(scheme, &mut solver, start) else {
                return StepToEnd::None;
            };
            let beyond = LAST * length;
            let slope = (value(&self.extrapolated(&end, beyond)) - value(&end)) / beyond;
            let left = -value(&end) / slope;
            if left.abs() <= beyond {
                return StepToEnd::Found(step, (self.extrapolated(&end, left), *index, *rising));
            }
            length += left;
        }
        StepToEnd::None
    }

    /// Returns the events inside a step that ends at one of them, this one last, from those that were
    /// `found` inside the step before it was shortened; `None` if an event function is not finite.
    pub(super) fn up_to_end(
        &self,
        step: &TrajectoryStep<S>,
        end: (S, usize, bool),
        found: &[(S, usize, bool)],
        (watches, moved): (&mut [SignTracker], Option<&S>),
    ) -> Option<Vec<(S, usize, bool)>> {
        let mut all = self.located_events(step, watches, moved)?;
        let rounding = LAST * step.length;
        let last = end.0.time() - rounding;
        // What ends the leg at the same time comes after what was found first.
        all.retain(|(at, event, _)| match self.events[*event].action {
            Action::Record => at.time() < end.0.time(),
            _ => *event != end.1 && at.time() < last,
        });
        // What is recorded at the same time may lie beyond the end by rounding.
        let before = found.iter().take_while(|(_, event, _)| *event != end.1);
        let ending = found.iter().find(|(_, event, _)| *event == end.1)?.0.time();
        for (at, event, rising) in before {
            let is_known = all.iter().any(|(at, known, _)| known == event && at.time() > last);
            if ending - at.time() <= rounding && !is_known {
                all.push((end.0.clone(), *event, *rising));
            }
        }
        all.push(end);
        Some(all)
    }
}
