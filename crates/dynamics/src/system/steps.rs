//! The steps of a path by Taylor series: the start of each, and the polynomials of all states about
//! it, in the time or in a variable in which [roots](super::roots) are power series.
//!
//! All coefficients are in one list, so that a step needs no allocation of its own: `s` states to
//! order `p` take `8 s (p + 1)` bytes a step, and `p + 1` more numbers where the time is a series of
//! its own. A long path keeps them of its last steps alone. Of every other step it keeps the point
//! of expansion, `8 (s + 4)` bytes and 8 for every root and corner, from which the same recurrences
//! give the same coefficients once more, bit for bit, when states on it are asked for: one
//! expansion for each step that is asked for.

use crate::numeric::ode::root::find_root;

use super::expansion::SystemSeries;
use super::polynomial::{extend_range, sign_and_roots, value, values};
use super::spare_memory::{PathLists, SpareMemory, SparingLists};

/// The steps of a path.
#[derive(Clone, Debug)]
pub(super) struct TaylorSteps {
    states: usize,
    order: usize,
    /// The number of steps that are no longer kept.
    forgotten: usize,
    /// The number of steps, the first ones, whose coefficients are no longer kept.
    without_series: usize,
    /// The steps with their coefficients and points of expansion, the events met and the states at the end.
    pub(super) lists: SparingLists,
    /// The recurrences that compute missing coefficients once more; `None` if all are kept.
    recurrences: Option<Box<SideRecurrences>>,
}

/// A step from one expansion to the next.
#[derive(Clone, Copy, Debug)]
pub(super) struct TaylorStep {
    /// Its start, as time since the start of the path.
    start: f64,
    /// The largest value of the variable of its series.
    length: f64,
    /// The index of its first coefficient.
    first: usize,
    /// The index of the first number of its point of expansion.
    point: usize,
}

/// The point about which a step is expanded.
pub(super) struct ExpansionPoint<'a> {
    /// The signs of the arguments of all roots.
    pub root_signs: &'a [f64],
    /// The sides of all corners.
    pub sides: &'a [f64],
    /// The states, then the variables of the roots that act.
    pub values: &'a [f64],
}

/// The recurrences on every side of the roots that a path has been on.
#[derive(Clone, Debug)]
struct SideRecurrences {
    /// The time at which the path starts.
    origin: f64,
    /// The signs of the arguments of the roots, with the recurrences there.
    sides: Vec<(Vec<f64>, SystemSeries)>,
}

impl TaylorSteps {
    /// An empty list of steps for this many states, to this order.
    pub(super) fn new(states: usize, order: usize, memory: &SpareMemory) -> Self {
        Self {
            states,
            order,
            forgotten: 0,
            without_series: 0,
            lists: memory.lists(),
            recurrences: None,
        }
    }

    /// A single step of length zero in these states.
    pub(super) fn at_rest(values: &[f64]) -> Self {
        let mut steps = Self::new(values.len(), 0, &SpareMemory::default());
        let PathLists { steps: list, coefficients, last, .. } = &mut *steps.lists;
        list.push(TaylorStep { start: 0.0, length: 0.0, first: 0, point: 0 });
        coefficients.extend_from_slice(values);
        last.extend_from_slice(values);
        steps
    }

    /// The number of steps, including those that are no longer kept.
    pub(super) fn count(&self) -> usize {
        self.forgotten + self.lists.steps.len()
    }

    /// Keeps only the last two steps, one of which may still be taken back, when many have ended
    /// before this time since the start of the path.
    pub(super) fn forget_before(&mut self, time: f64) {
        const MANY: usize = 64;
        let [.., before, last] = self.lists.steps.as_slice() else { return };
        let count = self.lists.steps.len();
        if count < MANY || before.start > time || last.start > time {
            return;
        }
        let (unneeded, point) = (count - 2, before.point);
        self.drop_series();
        self.forgotten += unneeded;
        self.without_series = 0;
        let PathLists { steps, points, .. } = &mut *self.lists;
        steps.drain(..unneeded);
        points.drain(..point);
        steps.iter_mut().for_each(|step| step.point -= point);
    }

    /// Keeps the coefficients of the last two steps alone.
    fn drop_series(&mut self) {
        let PathLists { steps, coefficients, .. } = &mut *self.lists;
        let [.., before, _] = steps.as_slice() else { return };
        let first = before.first;
        self.without_series = steps.len() - 2;
        coefficients.drain(..first);
        steps[self.without_series..].iter_mut().for_each(|step| step.first -= first);
    }

    /// Ends a path that starts at the time `origin`. `recurrences` gives those for the signs of the
    /// arguments of the roots; they are called for only where coefficients are missing.
    pub(super) fn finish(
        &mut self,
        origin: f64,
        roots: usize,
        recurrences: impl Fn(&[f64]) -> Option<SystemSeries>,
    ) {
        if self.without_series == 0 {
            return;
        }
        let mut sides: Vec<(Vec<f64>, SystemSeries)> = vec![];
        for step in &self.lists.steps[..self.without_series] {
            let signs = &self.lists.points[step.point..][..roots];
            if sides.iter().all(|(known, _)| known != signs) {
                sides.extend(recurrences(signs).map(|series| (signs.to_vec(), series)));
            }
        }
        self.recurrences = Some(Box::new(SideRecurrences { origin, sides }));
    }

    /// The start of the first step that is kept; infinity before the first.
    pub(super) fn first_start(&self) -> f64 {
        self.lists.steps.first().map_or(f64::INFINITY, |step| step.start)
    }

    /// The start of the last step.
    pub(super) fn last_start(&self) -> Option<f64> {
        self.lists.steps.last().map(|step| step.start)
    }

    /// Adds a step that begins at this time, with the length, the point and the polynomials of its
    /// states, and with that of the time unless it is the variable.
    pub(super) fn push<'a>(
        &mut self,
        [start, length]: [f64; 2],
        point: &ExpansionPoint,
        states: impl Iterator<Item = &'a [f64]>,
        time: Option<&[f64]>,
    ) {
        /// Number of coefficients that are kept: 4 MB.
        const MOST_COEFFICIENTS: usize = 1 << 19;
        if self.lists.coefficients.len() > MOST_COEFFICIENTS {
            self.drop_series();
        }
        let PathLists { steps, coefficients, points, .. } = &mut *self.lists;
        coefficients.reserve((self.states + usize::from(time.is_some())) * (self.order + 1));
        let (first, place) = (coefficients.len(), points.len());
        steps.push(TaylorStep { start, length, first, point: place });
        let ExpansionPoint { root_signs, sides, values } = point;
        [root_signs, sides, values].into_iter().for_each(|own| points.extend_from_slice(own));
        states.for_each(|series| coefficients.extend_from_slice(series));
        if time.is_some() {
            coefficients.extend(time_since_start(time));
        }
    }

    /// Removes the last step; returns its start.
    pub(super) fn pop(&mut self) -> Option<f64> {
        let PathLists { steps, coefficients, points, .. } = &mut *self.lists;
        let step = steps.pop()?;
        coefficients.truncate(step.first);
        points.truncate(step.point);
        Some(step.start)
    }

    /// All states at a time since the start, before the end of the last step; `None` before the
    /// first.
    pub(super) fn states_at(&self, time: f64) -> Option<Vec<f64>> {
        let step = self.step_at(time)?;
        let mut reader = StepReader::new(self);
        let series = reader.series(step);
        let place = series.place(time);
        Some(series.states(place))
    }

    /// One state at a time since the start; `None` before the first step.
    pub(super) fn state_at(&self, time: f64, state: usize) -> Option<f64> {
        let step = self.step_at(time)?;
        let mut reader = StepReader::new(self);
        let series = reader.series(step);
        (state < self.states).then(|| value(series.state(state), series.place(time)))
    }

    /// The times from `from` until `end` at which a state passes through zero, in order.
    pub(super) fn zeros(&self, [from, end]: [f64; 2], state: usize) -> Vec<f64> {
        let first = self.step_at(from).unwrap_or(0);
        let (mut zeros, mut before) = (Vec::new(), 0.0);
        let steps = if state < self.states { first..self.lists.steps.len() } else { 0..0 };
        let mut reader = StepReader::new(self);
        for step in steps {
            let is_last = step + 1 == self.lists.steps.len();
            let own = reader.series(step);
            let (start, series) = (own.step.start, own.state(state));
            let here = if from <= start { 0.0 } else { own.place(from) };
            let there = if is_last { own.place(end) } else { own.step.length };
            let first = zeros.len();
            let mut last = None;
            let sign = sign_and_roots(series, here, there, &mut |place, rising| {
                zeros.push(start + own.since_start(place));
                last = Some(if rising { 1.0 } else { -1.0 });
            });
            // A crossing that rounding has put between two steps.
            if sign != 0.0 && before == -sign {
                zeros.insert(first, start);
            }
            before = last.unwrap_or(sign);
        }
        zeros
    }

    /// The least and the greatest value of a state from one time until another.
    pub(super) fn range(&self, [from, end]: [f64; 2], state: usize) -> [f64; 2] {
        let first = self.step_at(from).unwrap_or(0);
        let steps = if state < self.states { first..self.lists.steps.len() } else { 0..0 };
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        let mut reader = StepReader::new(self);
        for step in steps {
            let is_last = step + 1 == self.lists.steps.len();
            let own = reader.series(step);
            let here = if from <= own.step.start { 0.0 } else { own.place(from) };
            let there = if is_last { own.place(end) } else { own.step.length };
            extend_range(&mut range, own.state(state), [here, there]);
        }
        range
    }

    /// Appends the values of the first states, a column for each, at times in increasing order; the path
    /// starts at `start`.
    pub(super) fn sample(&self, start: f64, mut times: &[f64], columns: &mut [Vec<f64>]) {
        const FEW: usize = 8;
        let (mut few, mut many) = ([0.0; FEW], vec![]);
        let mut reader = StepReader::new(self);
        let mut step = 0;
        while let (Some(first), true) = (times.first(), step < self.lists.steps.len()) {
            step = self.step_at(*first - start).unwrap_or(step);
            let count = match self.lists.steps.get(step + 1) {
                Some(next) => times.partition_point(|time| *time - start < next.start),
                None => times.len(),
            };
            let (own, others) = times.split_at(count);
            let series = reader.series(step);
            if many.len() < own.len() && own.len() > FEW {
                many.resize(own.len(), 0.0);
            }
            let places = if own.len() > FEW { many.as_mut_slice() } else { &mut few };
            let places = &mut places[..own.len()];
            for (place, time) in places.iter_mut().zip(own) {
                *place = series.place(*time - start);
            }
            for (state, column) in columns.iter_mut().enumerate().take(self.states) {
                values(series.state(state), places, column);
            }
            times = others;
        }
    }

    /// Returns the index of the step at a time; `None` before the first.
    fn step_at(&self, time: f64) -> Option<usize> {
        self.lists.steps.partition_point(|step| step.start <= time).checked_sub(1)
    }
}

/// The coefficients of the time since the start of a step, whose first is zero.
fn time_since_start(time: Option<&[f64]>) -> impl Iterator<Item = f64> {
    let behind = time.and_then(|series| series.get(1..));
    behind.into_iter().flat_map(|behind| [0.0].into_iter().chain(behind.iter().copied()))
}

/// Reads the polynomials of one step after the other.
struct StepReader<'a> {
    path: &'a TaylorSteps,
    /// The recurrences, copied when the first coefficients have to be computed once more.
    recurrences: Option<SideRecurrences>,
    /// The coefficients of a step that were computed once more.
    computed: Vec<f64>,
}

impl<'a> StepReader<'a> {
    fn new(path: &'a TaylorSteps) -> Self {
        Self { path, recurrences: None, computed: vec![] }
    }

    /// The polynomials of a step.
    fn series(&mut self, index: usize) -> StepSeries<'_> {
        let path = self.path;
        let PathLists { steps, coefficients, .. } = &*path.lists;
        let step = steps[index];
        let coefficients = match index < path.without_series {
            true => {
                self.compute(index);
                self.computed.as_slice()
            }
            false => {
                let next = steps.get(index + 1);
                &coefficients[step.first..next.map_or(coefficients.len(), |own| own.first)]
            }
        };
        StepSeries { step, states: path.states, order: path.order, coefficients }
    }

    /// Computes the coefficients of a step from its point of expansion.
    fn compute(&mut self, index: usize) {
        let TaylorSteps { states, order, lists, .. } = self.path;
        let PathLists { steps, points, .. } = &**lists;
        let step = steps[index];
        self.computed.clear();
        let own = self.recurrences.get_or_insert_with(|| {
            let known = self.path.recurrences.as_deref().cloned();
            known.unwrap_or(SideRecurrences { origin: 0.0, sides: vec![] })
        });
        let end = steps.get(index + 1).map_or(points.len(), |next| next.point);
        let point = &points[step.point..end];
        let here = |(signs, _): &&mut (Vec<f64>, SystemSeries)| point.starts_with(signs);
        let Some((signs, series)) = own.sides.iter_mut().find(here) else {
            // No side is missing; a step without recurrences has no values.
            self.computed.resize(states * (order + 1), f64::NAN);
            return;
        };
        let behind = &point[signs.len()..];
        let (sides, values) = behind.split_at(series.sides().len().min(behind.len()));
        series.set_sides(sides);
        series.expand_about(own.origin + step.start, values);
        series.compute();
        (0..*states).for_each(|state| self.computed.extend_from_slice(series.state(state)));
        self.computed.extend(time_since_start(series.time()));
    }
}

/// The polynomials of a step.
struct StepSeries<'a> {
    step: TaylorStep,
    states: usize,
    order: usize,
    coefficients: &'a [f64],
}

impl StepSeries<'_> {
    /// Returns the polynomial of a state.
    fn state(&self, state: usize) -> &[f64] {
        let length = self.order + 1;
        &self.coefficients[state * length..][..length]
    }

    /// The values of all states at a value of the variable, each equal to that of [`value`]; no sum waits for
    /// another.
    fn states(&self, place: f64) -> Vec<f64> {
        let length = self.order + 1;
        let mut sums = vec![0.0; self.states];
        for order in (0..length).rev() {
            for (sum, series) in sums.iter_mut().zip(self.coefficients.chunks_exact(length)) {
                *sum = *sum * place + series[order];
            }
        }
        sums
    }

    /// The time since the start of the step, as a series; `None` if it is the variable itself.
    fn time(&self) -> Option<&[f64]> {
        let has_time = self.coefficients.len() > self.states * (self.order + 1);
        has_time.then(|| self.state(self.states))
    }

    /// Returns the time since the start of the step at a value of its variable.
    fn since_start(&self, place: f64) -> f64 {
        self.time().map_or(place, |time| value(time, place))
    }

    /// Returns the value of the variable at a time since the start of the path.
    fn place(&self, time: f64) -> f64 {
        let TaylorStep { start, length, .. } = self.step;
        let since_start = time - start;
        match self.time() {
            None => since_start,
            // The time never goes back.
            Some(time) if since_start >= value(time, length) => length,
            Some(time) => {
                find_root(|place| value(time, place) - since_start, 0.0, length).unwrap_or(0.0)
            }
        }
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

    /// A path whose first coefficients were dropped equals a short one that keeps all, bit for bit.
    #[test]
    fn coefficients_that_were_dropped_are_computed_once_more() {
        let equations = [
            // A pendulum; a driven one with a corner and a contact, whose root has a variable of its own.
            "-sin(x)",
            "-x - x^3/5 - abs(v)*v/10 - 100*((x - 1/2)^2)^(3/4)*H(x - 1/2) + cos(t)",
        ];
        for rate in equations {
            let system = System::parse(&[("x", "v"), ("v", rate)], &[]).expect("a system");
            let [short, long] = [60.0, 10_000.0].map(|end| {
                let options = SystemOptions::default();
                system.solve([0.0, end], &[-1.0, 0.0], &[], &options).expect("a path")
            });
            assert!(long.step_count() > 12_000, "{}", long.step_count());
            let times: Vec<f64> = (0..=590).map(|index| f64::from(index) / 10.0).collect();
            for time in &times {
                assert_eq!(long.states_at(*time), short.states_at(*time), "{rate} at {time}");
                assert_eq!(long.state_at(*time, 1), short.state_at(*time, 1));
            }
            let [one, other] = [&short, &long].map(|path| {
                let (mut kept, mut columns) = (vec![], vec![vec![]; 2]);
                path.sample(&times, &mut kept, &mut columns);
                (kept, columns)
            });
            assert_eq!(one, other);
            // The range of x is that of its values at the zeros of its velocity and at both ends.
            let turns = short.zeros(1, 5.0).expect("series");
            let values =
                turns.iter().chain([&5.0, &60.0]).filter_map(|time| short.state_at(*time, 0));
            let [least, greatest] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |range, x| {
                [range[0].min(x), range[1].max(x)]
            });
            let range = short.range(0, 5.0).expect("series");
            assert!((range[0] - least).abs() < 1e-14 && (range[1] - greatest).abs() < 1e-14);
            let [one, other] = [&short, &long].map(|path| path.zeros(1, 5.0).expect("series"));
            assert!(one.len() > 10);
            assert_eq!(one, other[..one.len()]);
        }
    }
}
