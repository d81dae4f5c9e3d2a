//! Events: zeros of a function of (t, x, v), or of all values, found inside a step.
//!
//! Within a step the motion is a polynomial of degree 8, so the event function is sampled at 17
//! Chebyshev points, and each pair of neighbouring samples of opposite sign brackets a crossing,
//! which is then located to rounding accuracy. Where the samples keep their sign but come closer to
//! zero in between, the minimum of the absolute value is searched: two crossings between two
//! samples, the grazing of a barrier, are found as well. An event function should vary on the scale
//! of the motion, not faster.

use std::cell::RefCell;
use std::f64::consts::PI;
use std::sync::LazyLock;

use super::State;
use super::root::{find_minimum, find_root};
use super::sample::Sample;
use super::trajectory::TrajectoryStep;

/// A function of (t, x, v), or of all values, whose zeros are events; the direction of crossing
/// that counts; and the action at an event.
pub struct Event<'a, S = State> {
    pub(super) function: Box<dyn Fn(&S) -> f64 + 'a>,
    pub(super) direction: Direction,
    pub(super) action: Action<'a, S>,
    /// The number of values, from the first on, that the function reads.
    pub(super) reads: usize,
    /// The factors of the first values of which the function is a sum, beside a constant; `None` for another
    /// function.
    pub(super) factors: Option<Vec<f64>>,
}

/// The direction of a zero crossing that counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// Crossings from negative to positive.
    Rising,
    /// Crossings from positive to negative.
    Falling,
    /// Crossings in both directions.
    Either,
}

/// The action at an event.
pub enum Action<'a, S = State> {
    /// The event is recorded, and the run continues.
    Record,
    /// The event is recorded, and the run ends.
    Stop,
    /// The event is recorded, and the run restarts with another right side and possibly another
    /// state: the closure takes the state at the event and returns the index of the next phase and
    /// its initial state (whose time is not used).
    Switch(Box<dyn Fn(S) -> (usize, S) + 'a>),
}

impl<'a> Event<'a> {
    /// An event that is only recorded. Crossings in both directions count, unless [`Event::rising`]
    /// or [`Event::falling`] restricts them.
    pub fn record(function: impl Fn(f64, f64, f64) -> f64 + 'a) -> Self {
        Self::new(move |state| function(state.t, state.x, state.v), Action::Record)
    }

    /// An event that ends the run. Crossings in both directions count, as for [`Event::record`].
    pub fn stop(function: impl Fn(f64, f64, f64) -> f64 + 'a) -> Self {
        Self::new(move |state| function(state.t, state.x, state.v), Action::Stop)
    }

    /// An event that switches the right side, see [`Action::Switch`]. Crossings in both directions
    /// count, as for [`Event::record`]. Let `next` put the state exactly on the surface
    /// (`x = barrier`), so that the surface just left is not met again by rounding.
    pub fn switch(
        function: impl Fn(f64, f64, f64) -> f64 + 'a,
        next: impl Fn(State) -> (usize, State) + 'a,
    ) -> Self {
        Self::new(move |state| function(state.t, state.x, state.v), Action::Switch(Box::new(next)))
    }
}

impl<'a, S> Event<'a, S> {
    /// An event of any first-order equations. Crossings in both directions count, as for
    /// [`Event::record`].
    pub fn new(function: impl Fn(&S) -> f64 + 'a, action: Action<'a, S>) -> Self {
        let function = Box::new(function);
        Self { function, direction: Direction::Either, action, reads: usize::MAX, factors: None }
    }

    /// The function reads only so many values, from the first on, and the time: between the ends of a
    /// step it is given the others as they are at its start.
    pub fn reading(self, values: usize) -> Self {
        Self { reads: values, ..self }
    }

    /// The function is a constant and the sum of the first values, each times its factor: where it is larger
    /// than it can change within a step, it is not searched for zeros.
    pub fn linear(self, factors: Vec<f64>) -> Self {
        Self { factors: Some(factors), ..self }
    }

    /// Counts only crossings from negative to positive.
    pub fn rising(self) -> Self {
        Self { direction: Direction::Rising, ..self }
    }

    /// Counts only crossings from positive to negative.
    pub fn falling(self) -> Self {
        Self { direction: Direction::Falling, ..self }
    }

    fn counts(&self, rising: bool) -> bool {
        match self.direction {
            Direction::Rising => rising,
            Direction::Falling => !rising,
            Direction::Either => true,
        }
    }

    /// Whether a phase that starts on this surface and moves to this side has to be left: a contact
    /// that begins with less speed than rounding can resolve, for one.
    fn leaves_at_once(&self, rising: bool) -> bool {
        matches!(self.action, Action::Switch(_))
            && self.direction != Direction::Either
            && self.counts(rising)
    }
}

/// The error of an event function that has no finite value.
#[derive(Debug)]
pub(super) struct NotFinite;

/// Follows the sign of one event function from step to step.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct SignTracker {
    /// Sign of the last sample that was not zero; `None` at the start of a phase, and after the
    /// function reached zero at the very end of a step: from there the next sign is the start, not
    /// a crossing.
    positive: Option<bool>,
    /// Whether the phase started on the surface and has not left it yet.
    starts_on_surface: bool,
}

impl SignTracker {
    /// Returns the fractions of the step at which the event happens, in order, and whether its
    /// function rises there. `moved` is given for the first step of a phase: the start of the step,
    /// extrapolated over the step at the rates there.
    ///
    /// A start on the surface does not count as a crossing; reaching zero counts, and leaving it
    /// again does not. There is one exception: where a phase starts on the surface of a switch and
    /// moves through it in the direction that counts, it is left at once.
    pub(super) fn crossings<S: Sample>(
        &mut self,
        step: &TrajectoryStep<S>,
        event: &Event<S>,
        moved: Option<&S>,
    ) -> Result<Vec<(f64, bool)>, NotFinite> {
        if let (Some(factors), Some(positive), None) = (&event.factors, self.positive, moved) {
            let value = (event.function)(&step.start);
            let own = if positive { value } else { -value };
            if own > step.largest_change(factors) {
                return Ok(vec![]);
            }
        }
        let point = RefCell::new(step.start.clone());
        let value_at = |fraction: f64| {
            let point = &mut *point.borrow_mut();
            step.set_first_at(fraction, event.reads, point);
            (event.function)(point)
        };
        let first = moved.is_some();
        let mut samples = Vec::with_capacity(SAMPLES.len() + NEAR_START);
        for fraction in sample_fractions(first) {
            let value = value_at(fraction);
            if !value.is_finite() {
                return Err(NotFinite);
            }
            samples.push((fraction, value));
        }
        let starts_on_surface = first && samples.first().is_some_and(|&(_, value)| value == 0.0);
        if starts_on_surface {
            self.starts_on_surface = true;
            // Samples as small as rounding errors have an arbitrary sign. So do those as small as
            // the error of the polynomial if the arguments of the event function are at rest, since
            // the function then leaves zero as the square of time at least.
            let rounding = rounding_at(event, &step.state_at(0.0));
            let largest =
                samples.iter().fold(0.0, |largest: f64, (_, value)| largest.max(value.abs()));
            let is_at_rest = moved.is_some_and(|moved| (event.function)(moved) == 0.0);
            let slope_error = if is_at_rest { SLOPE_ERROR * largest } else { 0.0 };
            samples
                .iter_mut()
                .take_while(|(fraction, value)| value.abs() <= rounding.max(slope_error * fraction))
                .for_each(|(_, value)| *value = 0.0);
        }
        insert_near_misses(&mut samples, value_at);

        let mut found = Vec::new();
        let mut before = 0.0;
        for &(fraction, value) in &samples {
            match (self.positive, value) {
                (Some(positive), _) if value == 0.0 => {
                    found.push((fraction, !positive));
                    self.positive = None;
                }
                (Some(positive), _) if positive != (value > 0.0) => {
                    // The sign may differ by rounding between the end of a step and the start of
                    // the next.
                    let root = if fraction == before {
                        Ok(fraction)
                    } else {
                        find_root(value_at, before, fraction)
                    };
                    let root = root.map_err(|_| NotFinite)?;
                    found.push((root, !positive));
                    self.positive = Some(!positive);
                }
                (None, _) if value != 0.0 => {
                    if self.starts_on_surface && event.leaves_at_once(value > 0.0) {
                        found.push((0.0, value > 0.0));
                    }
                    self.starts_on_surface = false;
                    self.positive = Some(value > 0.0);
                }
                _ => {}
            }
            before = fraction;
        }
        found.retain(|&(_, rising)| event.counts(rising));
        Ok(found)
    }
}

/// Returns the change of an event function when each of its arguments changes in the last digits.
fn rounding_at<S: Sample>(event: &Event<S>, state: &S) -> f64 {
    const LAST_DIGITS: f64 = 4.0 * f64::EPSILON;
    let (time, values) = (state.time(), state.values());
    let here = (event.function)(state);
    let change =
        |time: f64, values: S::Values| ((event.function)(&S::new(time, values)) - here).abs();
    let changes = (0..values.as_ref().len().min(event.reads)).map(|index| {
        let mut changed = values.clone();
        changed.as_mut()[index] *= 1.0 + LAST_DIGITS;
        change(time, changed)
    });
    let sum = changes.sum::<f64>() + change(time * (1.0 + LAST_DIGITS), values.clone());
    if sum.is_finite() { sum } else { 0.0 }
}

/// Chebyshev points of a step, both ends included.
static SAMPLES: LazyLock<[f64; 17]> =
    LazyLock::new(|| std::array::from_fn(|index| 0.5 * (1.0 - (PI * index as f64 / 16.0).cos())));

/// Extra samples between the first two points of a phase: one that starts on a surface may leave
/// and meet it again within a tiny part of its first step.
const NEAR_START: usize = 20;

/// The error of the slope of a step at its start, relative to the largest value in the step.
const SLOPE_ERROR: f64 = 1e-9;

fn sample_fractions(first: bool) -> impl Iterator<Item = f64> {
    let near_start = if first { NEAR_START } else { 0 };
    let extra = (1..=near_start).rev().map(|power| SAMPLES[1] * 0.25_f64.powi(power as i32));
    std::iter::once(0.0).chain(extra).chain(SAMPLES[1..].iter().copied())
}

/// Inserts the minimum of |value| between samples of one sign if it lies beyond zero. It is searched
/// only where it may: a parabola through three samples, the one in the middle the lowest, goes below
/// that by no more than 0.6 of the rise to the higher of its neighbours, however the Chebyshev points
/// lie; beside an end of the step a function falls by no more than at the slope there.
fn insert_near_misses(samples: &mut Vec<(f64, f64)>, value_at: impl Fn(f64) -> f64) {
    /// Factor by which a function may fall lower than the parabola, or the slope, says.
    const SAFETY: f64 = 2.0;
    let mut misses = Vec::new();
    let mut search = |from: f64, to: f64, sign: f64| {
        let (fraction, height) = find_minimum(|fraction| sign * value_at(fraction), from, to);
        if height <= 0.0 {
            misses.push((fraction, sign * height));
        }
    };
    for triple in samples.windows(3) {
        let [(left, value_left), (_, value), (right, value_right)] =
            [triple[0], triple[1], triple[2]];
        let sign = value.signum();
        let (height_left, height, height_right) =
            (sign * value_left, sign * value, sign * value_right);
        let rises = height_left + height_right - 2.0 * height;
        let may_reach_zero = height < SAFETY * rises;
        if value != 0.0 && height < height_left && height <= height_right && may_reach_zero {
            search(left, right, sign);
        }
    }
    // A minimum beside an end of the step has no neighbour on one side: a point close to the end
    // gives the slope.
    if let [
        (first, value_first),
        (second, value_second),
        ..,
        (last_but_one, value_before),
        (last, value_last),
    ] = samples[..]
    {
        for (end, value_end, inner, value_inner) in [
            (first, value_first, second, value_second),
            (last, value_last, last_but_one, value_before),
        ] {
            const PARTS: f64 = 64.0;
            let sign = value_end.signum();
            let dips = || {
                let fall = sign * (value_end - value_at(end + (inner - end) / PARTS));
                fall > 0.0 && value_end.abs() < SAFETY * PARTS * fall
            };
            if value_end != 0.0 && sign * value_inner >= sign * value_end && dips() {
                search(end.min(inner), end.max(inner), sign);
            }
        }
    }
    if !misses.is_empty() {
        samples.extend(misses);
        samples.sort_by(|one, other| one.0.total_cmp(&other.0));
    }
}

#[cfg(test)]
mod tests {
    use super::super::trajectory::FRACTIONS;
    use super::*;

    /// A step of length 1 with x from `from` to `to` in a straight line.
    fn line(from: f64, to: f64) -> TrajectoryStep<State> {
        let start = State { t: 0.0, x: from, v: 0.0 };
        TrajectoryStep::new(
            0,
            start,
            1.0,
            FRACTIONS.map(|fraction| [from + fraction * (to - from), 0.0]),
        )
    }

    /// The crossings of x = 0 in such steps, one after the other from the start of a phase.
    fn crossings(steps: &[(f64, f64)]) -> Vec<Vec<f64>> {
        let event = Event::record(|_, x, _| x);
        let mut watch = SignTracker::default();
        let mut follow = |(index, &(from, to)): (usize, &(f64, f64))| {
            let step = line(from, to);
            let moved = (index == 0).then(|| step.state_at(1.0));
            let found = watch.crossings(&step, &event, moved.as_ref()).unwrap();
            found.into_iter().map(|(fraction, _)| fraction).collect()
        };
        steps.iter().enumerate().map(&mut follow).collect()
    }

    #[test]
    fn a_sign_that_changes_between_two_steps_is_a_crossing() {
        assert_eq!(crossings(&[(1.0, 1e-9), (-1e-9, -1.0)]), [vec![], vec![0.0]]);
    }

    /// A function that is known to be linear is searched where it may be zero within the step, and nowhere
    /// else.
    #[test]
    fn a_linear_event_is_not_searched_where_it_cannot_be_zero() {
        let calls = std::cell::Cell::new(0);
        let counted = |state: &State| {
            calls.set(calls.get() + 1);
            2.0 * state.x - 1.0
        };
        let event = Event::new(counted, Action::Record).linear(vec![2.0]);
        let mut watch = SignTracker::default();
        let mut happens = |from: f64, to: f64, is_first: bool| {
            let step = line(from, to);
            let moved = is_first.then(|| step.state_at(1.0));
            calls.set(0);
            let found = watch.crossings(&step, &event, moved.as_ref()).unwrap();
            (found.len(), calls.get() > 1)
        };
        assert_eq!(happens(3.0, 2.9, true), (0, true));
        assert_eq!(happens(2.9, 2.0, false), (0, false));
        assert_eq!(happens(2.0, 1.3, false), (0, false));
        assert_eq!(happens(1.3, 0.4, false), (1, true));
        assert_eq!(happens(0.4, 0.35, false), (0, false));
        assert_eq!(happens(0.35, 0.7, false), (1, true));
    }

    #[test]
    fn a_start_is_no_crossing_reaching_zero_is_one_and_leaving_it_is_none() {
        assert_eq!(crossings(&[(0.0, 1.0), (1.0, 0.0), (0.0, -1.0)]), [vec![], vec![1.0], vec![]]);
        let middle = crossings(&[(-1.0, 1.0)])[0][0];
        assert!((middle - 0.5).abs() < 1e-15);
    }

    #[test]
    fn a_phase_is_left_at_once_only_through_its_own_switch() {
        let next = |state: State| (0, state);
        for (event, found) in [
            (Event::switch(|_, x, _| x, next).falling(), 1),
            (Event::switch(|_, x, _| x, next).rising(), 0),
            (Event::switch(|_, x, _| x, next), 0),
            (Event::stop(|_, x, _| x).falling(), 0),
        ] {
            let step = line(0.0, -1.0);
            let moved = step.state_at(1.0);
            assert_eq!(
                SignTracker::default().crossings(&step, &event, Some(&moved)).unwrap().len(),
                found
            );
        }
    }
}
