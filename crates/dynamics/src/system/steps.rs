//! The steps of a path by Taylor series: the start of each, and the polynomials of all states about
//! it, in the time or in a variable in which [roots](super::roots) are power series.
//!
//! All coefficients are in one list, so that a step needs no allocation of its own; `n` steps of
//! `s` states to order `p` take `8 n (s (p + 1) + 3)` bytes, and `p + 1` more numbers where the time
//! is a series of its own.

use crate::numeric::ode::root::find_root;

use super::polynomial::{roots, sign_at_start, value, values};

/// The steps of a path.
#[derive(Clone, Debug)]
pub(super) struct TaylorSteps {
    states: usize,
    order: usize,
    /// The number of steps that are no longer kept.
    forgotten: usize,
    steps: Vec<TaylorStep>,
    /// The coefficients of `s^0, s^1, ...`, step by step and state by state.
    coefficients: Vec<f64>,
}

/// A step from one expansion to the next.
#[derive(Clone, Copy, Debug)]
struct TaylorStep {
    /// Its start, as time since the start of the path.
    start: f64,
    /// The largest value of the variable of its series.
    length: f64,
    /// The index of its first coefficient.
    first: usize,
}

impl TaylorSteps {
    /// An empty list of steps for this many states, to this order.
    pub(super) fn new(states: usize, order: usize) -> Self {
        Self { states, order, forgotten: 0, steps: vec![], coefficients: vec![] }
    }

    /// A single step of length zero in these states.
    pub(super) fn at_rest(values: Vec<f64>) -> Self {
        let step = TaylorStep { start: 0.0, length: 0.0, first: 0 };
        let states = values.len();
        Self { steps: vec![step], coefficients: values, ..Self::new(states, 0) }
    }

    /// The number of steps, including those that are no longer kept.
    pub(super) fn count(&self) -> usize {
        self.forgotten + self.steps.len()
    }

    /// Keeps only the last two steps, one of which may still be taken back, when many have ended
    /// before this time since the start of the path.
    pub(super) fn forget_before(&mut self, time: f64) {
        const MANY: usize = 64;
        let [.., before, last] = self.steps.as_slice() else { return };
        if self.steps.len() < MANY || before.start > time || last.start > time {
            return;
        }
        let (first, unneeded) = (before.first, self.steps.len() - 2);
        self.forgotten += unneeded;
        self.steps.drain(..unneeded);
        self.coefficients.drain(..first);
        self.steps.iter_mut().for_each(|step| step.first -= first);
    }

    /// The start of the first step that is kept; infinity before the first.
    pub(super) fn first_start(&self) -> f64 {
        self.steps.first().map_or(f64::INFINITY, |step| step.start)
    }

    /// The start of the last step.
    pub(super) fn last_start(&self) -> Option<f64> {
        self.steps.last().map(|step| step.start)
    }

    /// The polynomials of the last step, state by state; none before the first.
    pub(super) fn last(&self) -> impl Iterator<Item = &[f64]> {
        let first = self.steps.last().map_or(0, |step| step.first);
        self.coefficients[first..].chunks_exact(self.order + 1).take(self.states)
    }

    /// Adds a step that begins at this time, with the length and the polynomials of its states, and
    /// with that of the time unless it is the variable.
    pub(super) fn push<'a>(
        &mut self,
        [start, length]: [f64; 2],
        states: impl Iterator<Item = &'a [f64]>,
        time: Option<&[f64]>,
    ) {
        self.steps.push(TaylorStep { start, length, first: self.coefficients.len() });
        states.for_each(|series| self.coefficients.extend_from_slice(series));
        if let Some([_, since_start @ ..]) = time {
            self.coefficients.push(0.0);
            self.coefficients.extend_from_slice(since_start);
        }
    }

    /// Removes the last step; returns its start.
    pub(super) fn pop(&mut self) -> Option<f64> {
        let step = self.steps.pop()?;
        self.coefficients.truncate(step.first);
        Some(step.start)
    }

    /// All states at a time since the start, before the end of the last step; `None` before the
    /// first.
    pub(super) fn states_at(&self, time: f64) -> Option<Vec<f64>> {
        let step = self.step_at(time)?;
        let place = self.place(step, time);
        Some((0..self.states).map(|state| value(self.series(step, state), place)).collect())
    }

    /// One state at a time since the start; `None` before the first step.
    pub(super) fn state_at(&self, time: f64, state: usize) -> Option<f64> {
        let step = self.step_at(time)?;
        (state < self.states).then(|| value(self.series(step, state), self.place(step, time)))
    }

    /// The times from `from` until `end` at which a state passes through zero, in order.
    pub(super) fn zeros(&self, [from, end]: [f64; 2], state: usize) -> Vec<f64> {
        let first = self.step_at(from).unwrap_or(0);
        let (mut zeros, mut before) = (Vec::new(), 0.0);
        let steps = if state < self.states { first..self.steps.len() } else { 0..0 };
        for step in steps {
            let (start, series) = (self.steps[step].start, self.series(step, state));
            let end = self.steps.get(step + 1).map_or(end, |next| next.start);
            let since_start = |place: f64| match self.time(step) {
                Some(time) => value(time, place),
                None => place,
            };
            let [here, there] = [from.max(start), end].map(|time| self.place(step, time));
            let sign = sign_at_start(series, here, there);
            // A crossing that rounding has put between two steps.
            if sign != 0.0 && before == -sign {
                zeros.push(start);
            }
            let met = roots(series, here, there);
            before = met.last().map_or(sign, |(_, rising)| if *rising { 1.0 } else { -1.0 });
            zeros.extend(met.into_iter().map(|(place, _)| start + since_start(place)));
        }
        zeros
    }

    /// Appends the values of the first states, a column for each, at times since the start in
    /// increasing order.
    pub(super) fn sample(&self, mut times: &[f64], columns: &mut [Vec<f64>]) {
        let mut places = Vec::new();
        let mut step = 0;
        while let (Some(first), true) = (times.first(), step < self.steps.len()) {
            let next = |step: usize| self.steps.get(step + 1).map(|step| step.start);
            while next(step).is_some_and(|start| start <= *first) {
                step += 1;
            }
            let count =
                next(step).map_or(times.len(), |until| times.partition_point(|time| *time < until));
            let (own, others) = times.split_at(count);
            places.clear();
            places.extend(own.iter().map(|time| self.place(step, *time)));
            for (state, column) in columns.iter_mut().enumerate().take(self.states) {
                values(self.series(step, state), &places, column);
            }
            times = others;
        }
    }

    /// Returns the index of the step at a time; `None` before the first.
    fn step_at(&self, time: f64) -> Option<usize> {
        self.steps.partition_point(|step| step.start <= time).checked_sub(1)
    }

    /// Returns the value of the variable of a step at a time since the start of the path.
    fn place(&self, step: usize, time: f64) -> f64 {
        let TaylorStep { start, length, .. } = self.steps[step];
        let since_start = time - start;
        match self.time(step) {
            None => since_start,
            // The time never goes back.
            Some(time) if since_start >= value(time, length) => length,
            Some(time) => {
                find_root(|place| value(time, place) - since_start, 0.0, length).unwrap_or(0.0)
            }
        }
    }

    fn series(&self, step: usize, state: usize) -> &[f64] {
        let length = self.order + 1;
        &self.coefficients[self.steps[step].first + state * length..][..length]
    }

    /// The time since the start of a step, as a series; `None` if it is the variable itself.
    fn time(&self, step: usize) -> Option<&[f64]> {
        let next = self.steps.get(step + 1).map_or(self.coefficients.len(), |next| next.first);
        let has_time = next - self.steps[step].first > self.states * (self.order + 1);
        has_time.then(|| self.series(step, self.states))
    }
}

#[cfg(test)]
mod tests {
    use crate::system::{System, SystemOptions};

    #[test]
    fn a_path_that_forgets_its_beginning_is_the_same_from_then_on() {
        let wave = System::parse(&[("x", "v"), ("v", "-x*(1 + x^2)")], &[]).expect("a system");
        let whole = SystemOptions::default();
        let late = SystemOptions { keep_from: 900.0, ..whole };
        let [whole, late] =
            [whole, late].map(|options| wave.solve([0.0, 1000.0], &[1.0, 0.0], &[], &options));
        let (whole, late) = (whole.expect("a path"), late.expect("a path"));
        assert_eq!(whole.step_count(), late.step_count());
        assert_eq!(late.states_at(10.0), None);
        assert_eq!(whole.zeros(0, 900.0), late.zeros(0, 900.0));
        let times: Vec<f64> = (0..=1000).map(f64::from).collect();
        let [one, other] = [&whole, &late].map(|path| {
            let (mut kept, mut columns) = (vec![], vec![vec![]; 2]);
            path.sample(&times, &mut kept, &mut columns);
            kept.into_iter().zip(columns.swap_remove(0)).collect::<Vec<_>>()
        });
        assert!(one.len() == 1001 && (101..200).contains(&other.len()), "{}", other.len());
        assert_eq!(one[1001 - other.len()..], other);
    }
}
