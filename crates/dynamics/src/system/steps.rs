//! The steps of a path by Taylor series: the start of each, and the polynomials of all states about
//! it.
//!
//! All coefficients are in one list, so that a step needs no allocation of its own; `n` steps of
//! `s` states to order `p` take `8 n (s (p + 1) + 1)` bytes.

use super::polynomial::{roots, value, values};

/// The steps of a path.
#[derive(Clone, Debug)]
pub(super) struct TaylorSteps {
    states: usize,
    order: usize,
    /// The starts of the steps, as times since the start of the path.
    starts: Vec<f64>,
    /// The coefficients of `s^0, s^1, ...`, step by step and state by state.
    coefficients: Vec<f64>,
}

impl TaylorSteps {
    /// An empty list of steps for this many states, to this order.
    pub(super) fn new(states: usize, order: usize) -> Self {
        Self { states, order, starts: vec![], coefficients: vec![] }
    }

    /// A single step of length zero in these states.
    pub(super) fn at_rest(values: Vec<f64>) -> Self {
        Self { states: values.len(), order: 0, starts: vec![0.0], coefficients: values }
    }

    /// The number of steps.
    pub(super) fn count(&self) -> usize {
        self.starts.len()
    }

    /// The start of the last step.
    pub(super) fn last_start(&self) -> Option<f64> {
        self.starts.last().copied()
    }

    /// The polynomials of the last step, state by state; none before the first.
    pub(super) fn last(&self) -> impl Iterator<Item = &[f64]> {
        let from = self.place(self.count().saturating_sub(1));
        self.coefficients[from..].chunks_exact(self.order + 1)
    }

    /// Adds a step that begins at this time, with the polynomials of its states.
    pub(super) fn push<'a>(&mut self, start: f64, series: impl Iterator<Item = &'a [f64]>) {
        self.starts.push(start);
        series.for_each(|series| self.coefficients.extend_from_slice(series));
    }

    /// Removes the last step; returns its start, and the states there.
    pub(super) fn pop(&mut self) -> Option<(f64, Vec<f64>)> {
        let start = self.starts.pop()?;
        let from = self.place(self.count());
        let states = self.coefficients[from..].chunks_exact(self.order + 1);
        let states = states.map(|series| series[0]).collect();
        self.coefficients.truncate(from);
        Some((start, states))
    }

    /// All states at a time since the start, before the end of the last step; `None` before the
    /// first.
    pub(super) fn states_at(&self, time: f64) -> Option<Vec<f64>> {
        let step = self.step_at(time)?;
        let place = time - self.starts[step];
        Some((0..self.states).map(|state| value(self.series(step, state), place)).collect())
    }

    /// One state at a time since the start; `None` before the first step.
    pub(super) fn state_at(&self, time: f64, state: usize) -> Option<f64> {
        let step = self.step_at(time)?;
        (state < self.states).then(|| value(self.series(step, state), time - self.starts[step]))
    }

    /// The times from `from` until `end` at which a state passes through zero, in order.
    pub(super) fn zeros(&self, [from, end]: [f64; 2], state: usize) -> Vec<f64> {
        let first = self.step_at(from).unwrap_or(0);
        let mut zeros = Vec::new();
        let steps = if state < self.states { first..self.count() } else { 0..0 };
        for step in steps {
            let (start, series) = (self.starts[step], self.series(step, state));
            let end = self.starts.get(step + 1).map_or(end, |next| *next);
            let met = roots(series, (from - start).max(0.0), end - start);
            zeros.extend(met.into_iter().map(|(place, _)| start + place));
        }
        zeros
    }

    /// Appends the values of the first states, a column for each, at times since the start in
    /// increasing order.
    pub(super) fn sample(&self, mut times: &[f64], columns: &mut [Vec<f64>]) {
        let mut places = Vec::new();
        let mut step = 0;
        while let (Some(first), true) = (times.first(), step < self.count()) {
            let next = |step: usize| self.starts.get(step + 1);
            while next(step).is_some_and(|start| start <= first) {
                step += 1;
            }
            let count =
                next(step).map_or(times.len(), |until| times.partition_point(|time| time < until));
            let (own, others) = times.split_at(count);
            places.clear();
            places.extend(own.iter().map(|time| time - self.starts[step]));
            for (state, column) in columns.iter_mut().enumerate().take(self.states) {
                values(self.series(step, state), &places, column);
            }
            times = others;
        }
    }

    /// Returns the index of the step at a time; `None` before the first.
    fn step_at(&self, time: f64) -> Option<usize> {
        self.starts.partition_point(|start| *start <= time).checked_sub(1)
    }

    /// Returns the index of the first coefficient of a step.
    fn place(&self, step: usize) -> usize {
        step * self.states * (self.order + 1)
    }

    fn series(&self, step: usize, state: usize) -> &[f64] {
        let length = self.order + 1;
        &self.coefficients[self.place(step) + state * length..][..length]
    }
}
