//! The Taylor series of a system at a point: states, events, and the arguments of corners and of
//! narrow functions, with what a step along them meets.
//!
//! References: R. E. Moore, *Methods and Applications of Interval Analysis*, SIAM 1979, section 3.4
//! (coefficients by recurrences along the expression); A. Jorba, M. Zou, *Experimental Mathematics*
//! 14 (2005) 99 (order).
//!
//! ```text
//! y(t + s) = sum_n y_n s^n,   (n + 1) y_(n+1) = F_n      F_n: coefficient of s^n along the expression, each part once
//! event: g(t, y) = 0, found on the series of g itself, so that two crossings in one step are two
//! ```

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use super::narrow::{FunctionGrowth, end_of_step};
use super::polynomial::{roots, sign_and_roots, value};
use super::roots::{Equations, Root, corner_roots, equations_on_side};
use super::spare_memory::SpareMemory;
use super::step_length::{Allowance, StepBounds};
use super::{Event, System};
use crate::expr::Expr;
use crate::numeric::ode::root::find_root;
use crate::series::recurrence::{RecurrenceError, Recurrences};
use crate::series::tape::Tape;
use crate::symbol::Symbol;

/// Checks that there are recurrences for the right sides of a system and these events.
///
/// # Errors
/// [`RecurrenceError`] for a function without a recurrence.
pub(super) fn check(system: &System, events: &[Event]) -> Result<(), RecurrenceError> {
    const ANY: f64 = 0.1;
    let equations = Equations::as_written(system, &expressions(events));
    SystemSeries::new(&equations, &system.numbers, ANY).map(drop)
}

pub(super) fn expressions(events: &[Event]) -> Vec<&Expr> {
    events.iter().map(|event| &event.expression).collect()
}

/// The recurrences for the right sides of a system and for events, to the order with which steps
/// within the tolerance are cheapest; for each side of the roots their own, derived when a motion
/// first comes there.
#[derive(Clone, Debug)]
pub(super) struct Expansions {
    tolerance: f64,
    pub(super) roots: Arc<[Root]>,
    known: Arc<Mutex<BTreeMap<Vec<bool>, SystemSeries>>>,
    /// The memory of the steps of paths that are gone.
    pub(super) memory: SpareMemory,
}

impl Expansions {
    /// Prepares the recurrences of a system and these events.
    ///
    /// # Errors
    /// As [`check`].
    pub(super) fn new(
        system: &System,
        events: &[Event],
        tolerance: f64,
    ) -> Result<Self, RecurrenceError> {
        let events = expressions(events);
        let equations = Equations::as_written(system, &events);
        let as_written = SystemSeries::new(&equations, &system.numbers, tolerance)?;
        let roots: Arc<[Root]> = corner_roots(system, &events).into();
        let known = match roots.is_empty() {
            true => [(vec![], as_written)].into(),
            false => BTreeMap::new(),
        };
        let memory = SpareMemory::default();
        Ok(Self { tolerance, roots, known: Arc::new(Mutex::new(known)), memory })
    }

    /// Returns the recurrences where the arguments of the roots have these signs; `None` if they
    /// cannot be written.
    pub(super) fn on_side(
        &self,
        system: &System,
        events: &[Event],
        signs: &[f64],
    ) -> Option<SystemSeries> {
        let side: Vec<bool> = signs.iter().map(|sign| *sign > 0.0).collect();
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(series) = known.get(&side).and_then(|own| own.with_numbers(&system.numbers)) {
            return Some(series);
        }
        let events = expressions(events);
        let equations = match self.roots.is_empty() {
            true => Equations::as_written(system, &events),
            false => equations_on_side(system, &events, &self.roots, signs).ok()?,
        };
        let series = SystemSeries::new(&equations, &system.numbers, self.tolerance).ok()?;
        // The latest stays: recurrences for a number that is exactly 1 serve no other number.
        known.insert(side, series.clone());
        Some(series)
    }

    /// The order of the series.
    pub(super) fn order(&self) -> usize {
        order(self.tolerance)
    }

    /// Whether these are the recurrences of the same equations.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.known, &other.known)
    }
}

/// Returns the order of the series for a tolerance.
///
/// The order `-ln(tolerance)/2` needs the fewest products for a time (Jorba and Zou). A step also has a cost
/// that no order changes, with which series longer by a third need the least time.
fn order(tolerance: f64) -> usize {
    (1.0 - 0.7 * tolerance.ln()).ceil() as usize + 1
}

/// The recurrences of right sides and events, with their series.
#[derive(Clone, Debug)]
pub(super) struct SystemSeries {
    /// The tape, whose variables are the states, then that of the series. The states of the system
    /// come first, then the variables of the roots that act, then, if there are any, the time.
    pub(super) tape: Tape,
    states: usize,
    events: usize,
    /// The roots that act.
    pub(super) acting: Vec<usize>,
    /// The number of roots; their sides are the first corners.
    pub(super) roots: usize,
    pub(super) order: usize,
    tolerance: f64,
    /// The places of the rates, then of the events, then of the arguments of narrow functions.
    outputs: Vec<usize>,
    narrow: Vec<FunctionGrowth>,
    /// The longest step within the bounds of states, events and corners.
    pub(super) longest_step: f64,
    /// Whether all coefficients of states, events and corners are known to be finite.
    has_values: bool,
    /// Whether the series were computed on the tape itself, not taken from a lane.
    is_own: bool,
    /// Bounds of the last terms of states, events and corners.
    of_steps: Arc<Allowance>,
    /// Bounds of the last terms of the arguments of narrow functions.
    of_arguments: Arc<Allowance>,
}

impl SystemSeries {
    /// Derives the recurrences of these equations, to the order for this tolerance.
    pub(super) fn new(
        equations: &Equations,
        numbers: &BTreeMap<Symbol, f64>,
        tolerance: f64,
    ) -> Result<Self, RecurrenceError> {
        Self::to_order(order(tolerance), equations, numbers, tolerance)
    }

    /// Derives the recurrences of these equations, to an order with the bounds of this tolerance.
    pub(super) fn to_order(
        order: usize,
        equations: &Equations,
        numbers: &BTreeMap<Symbol, f64>,
        tolerance: f64,
    ) -> Result<Self, RecurrenceError> {
        /// Tolerance of the arguments of narrow functions, which need not be known to rounding.
        const CLOSELY: f64 = 1e-9;
        let states = equations.states.iter().map(|state| (*state, None));
        let variables: Vec<_> = states.chain([(equations.variable, Some(1))]).collect();
        let mut recurrences = Recurrences::new(&variables, numbers, order);
        for end in &equations.ends {
            recurrences.watch(end)?;
        }
        let narrow = equations.narrow.iter().map(|(argument, _)| argument);
        let outputs = equations.right.iter().chain(&equations.events).chain(narrow);
        let outputs = outputs.map(|output| recurrences.add(output)).collect::<Result<_, _>>()?;
        Ok(Self {
            tape: recurrences.into_tape(),
            states: equations.states.len(),
            events: equations.events.len(),
            acting: equations.acting.clone(),
            roots: equations.ends.len(),
            order,
            tolerance,
            outputs,
            narrow: equations.narrow.iter().map(|(_, kind)| *kind).collect(),
            longest_step: f64::NAN,
            has_values: false,
            is_own: true,
            of_steps: Allowance::new(tolerance, order).into(),
            of_arguments: Allowance::new(CLOSELY, order).into(),
        })
    }

    /// Whether another expansion has the same recurrences, so that both may be computed side by
    /// side.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        self.tape.is_like(&other.tape)
    }

    /// The series of the time; `None` if it is the variable itself.
    pub(super) fn time(&self) -> Option<&[f64]> {
        (!self.acting.is_empty()).then(|| self.state(self.states - 1))
    }

    /// The time that passes from the start of the step until a value of its variable.
    pub(super) fn elapsed(&self, place: f64) -> f64 {
        match self.time() {
            None => place,
            Some([]) => 0.0,
            Some([_, since_start @ ..]) => place * value(since_start, place),
        }
    }

    /// The rate of the time in the variable of the series.
    pub(super) fn time_rate(&self) -> f64 {
        self.time().and_then(|series| series.get(1)).copied().unwrap_or(1.0)
    }

    /// Returns the value of the variable at which this time has passed, on a step on which the time
    /// does not go back; `None` if it does not pass on it.
    pub(super) fn step_within(&self, time: f64, reach: f64) -> Option<f64> {
        if self.time().is_none() {
            return (reach >= time).then_some(time);
        }
        let beyond = |place: f64| self.elapsed(place) - time;
        match beyond(reach) {
            0.0 => Some(reach),
            passed if passed > 0.0 => find_root(beyond, 0.0, reach).ok(),
            _ => None,
        }
    }

    /// Returns the first root whose side the motion leaves at once, or on whose side it does not
    /// move; `signs` are the signs of the arguments of all.
    pub(super) fn left_root(&self, signs: &[f64]) -> Option<usize> {
        let mut sides = self.tape.corners().zip(signs).enumerate();
        sides.find_map(|(root, ((series, side), sign))| {
            let is_left = match self.acting.contains(&root) {
                true => side < 0.0 || series.iter().all(|value| *value == 0.0),
                false => side * sign < 0.0,
            };
            is_left.then_some(root)
        })
    }

    /// Takes the sides of the roots on which their arguments have these signs.
    pub(super) fn take_root_sides(&mut self, signs: &[f64]) {
        let mut sides = self.sides();
        for (root, sign) in signs.iter().enumerate() {
            sides[root] = if self.acting.contains(&root) { 1.0 } else { *sign };
        }
        self.set_sides(&sides);
    }

    /// Returns this expansion with other values of the parameters; `None` if these may lead to
    /// other recurrences.
    fn with_numbers(&self, numbers: &BTreeMap<Symbol, f64>) -> Option<Self> {
        let mut other = self.clone();
        other.tape.set_numbers(numbers).then_some(other)
    }

    /// Takes other values of the parameters, and the sides of corners with which a motion begins. Returns
    /// `false` if these values may lead to other recurrences.
    pub(super) fn begin_anew(&mut self, numbers: &BTreeMap<Symbol, f64>) -> bool {
        self.tape.reset_sides();
        self.tape.set_numbers(numbers)
    }

    /// Takes the side of every corner on which this point lies, or to which it moves.
    pub(super) fn begin(&mut self, time: f64, values: &[f64]) {
        self.expand_about(time, values);
        let corners = self.tape.corners().count();
        // The expansion is repeated because the argument of one corner may depend on the side of
        // another.
        for _ in 0..if corners > 0 { corners + 1 } else { 0 } {
            // Undefined series do not matter here, since the sides may still be wrong.
            self.compute();
            if !self.tape.take_sides() {
                break;
            }
        }
    }

    /// Computes all coefficients about a point.
    ///
    /// # Errors
    /// As [`Self::switch_corners`].
    pub(super) fn expand(&mut self, time: f64, values: &[f64]) -> Result<(), usize> {
        self.expand_about(time, values);
        self.compute();
        self.switch_corners()
    }

    /// Computes all coefficients about a point on the present sides of the corners; returns whether
    /// they are finite.
    pub(super) fn expand_once(&mut self, time: f64, values: &[f64]) -> bool {
        self.expand_about(time, values);
        self.compute();
        self.check().is_ok()
    }

    /// Sets the variables to the point of the expansion.
    pub(super) fn expand_about(&mut self, time: f64, values: &[f64]) {
        for (variable, value) in values.iter().chain([&time]).enumerate() {
            self.tape.set(variable, 0, *value);
        }
        if self.order > 0 {
            self.tape.set(self.states, 1, 1.0);
        }
    }

    /// Computes all coefficients about the present point.
    pub(super) fn compute(&mut self) {
        self.tape.expand(&self.outputs[..self.states]);
        let StepBounds { longest: [longest], has_values: [has_values] } = self.bounds(&self.tape);
        (self.longest_step, self.has_values, self.is_own) = (longest, has_values, true);
        self.leave_out_overflow();
    }

    /// Leaves out the last terms of all series where one of them overflows, as it does when time is counted in
    /// units far too long: series of two thirds of the order have a bound of their own for the step.
    fn leave_out_overflow(&mut self) {
        if self.has_values {
            return;
        }
        let events = &self.outputs[self.states..][..self.events];
        let corners = self.tape.corner_places();
        let places: Vec<usize> =
            (0..self.states).chain(events.iter().chain(corners).copied()).collect();
        let finite = |place: &usize| {
            let series = self.tape.series(*place);
            series.iter().position(|value| !value.is_finite()).unwrap_or(series.len())
        };
        let kept = places.iter().map(finite).min().unwrap_or(0);
        if 3 * kept < 2 * (self.order + 1) {
            return;
        }
        for place in &places {
            (kept..=self.order).for_each(|order| self.tape.set(*place, order, 0.0));
        }
        let allowance = Allowance::new(self.tolerance, kept - 1);
        let StepBounds { longest: [longest], has_values: [has_values] } =
            allowance.bounds(&self.tape, places.into_iter());
        (self.longest_step, self.has_values, self.is_own) = (longest, has_values, true);
    }

    /// Whether the series are those of the lane from which they were last taken.
    pub(super) fn is_of_lane(&self) -> bool {
        !self.is_own
    }

    /// Takes the series that were computed in a lane, with the bounds of the step along them.
    pub(super) fn take_from<const L: usize>(
        &mut self,
        tape: &Tape<L>,
        lane: usize,
        bounds: &StepBounds<L>,
    ) {
        let places = (0..self.states).chain(self.outputs[self.states..].iter().copied());
        tape.copy_lane_to(lane, places, &mut self.tape);
        (self.longest_step, self.has_values) = (bounds.longest[lane], bounds.has_values[lane]);
        self.is_own = false;
        self.leave_out_overflow();
    }

    /// Returns the bounds that every state, event and argument of a corner sets to a step, for each
    /// lane of a tape of these recurrences.
    pub(super) fn bounds<const L: usize>(&self, tape: &Tape<L>) -> StepBounds<L> {
        let events = &self.outputs[self.states..][..self.events];
        let places = (0..self.states).chain(events.iter().chain(tape.corner_places()).copied());
        self.of_steps.bounds(tape, places)
    }

    /// The number of variables: the states, and that of the series.
    pub(super) fn variables(&self) -> usize {
        self.states + 1
    }

    /// The places of the rates.
    pub(super) fn rates(&self) -> &[usize] {
        &self.outputs[..self.states]
    }

    /// Switches to the other side of corners that were passed together with another one: the motion
    /// is beyond them and moving away.
    ///
    /// # Errors
    /// The index of the first state whose series is not finite; 0 if the argument of a corner has a
    /// value but no series.
    pub(super) fn switch_corners(&mut self) -> Result<(), usize> {
        for _ in 0..=self.tape.corners().count() {
            let left = self.tape.corners().enumerate().position(|(corner, (series, side))| {
                let slope = series.get(1).copied().unwrap_or(0.0);
                corner >= self.roots && series[0] * side < 0.0 && slope * side < 0.0
            });
            let Some(corner) = left else { break };
            self.cross(corner);
            self.compute();
        }
        self.check()
    }

    /// Checks that states and corners have series; the errors are those of
    /// [`Self::switch_corners`].
    fn check(&self) -> Result<(), usize> {
        if self.has_values {
            return Ok(());
        }
        let is_defined = |series: &[f64]| series.iter().all(|value| value.is_finite());
        if let Some(state) = (0..self.states).find(|&state| !is_defined(self.state(state))) {
            return Err(state);
        }
        // A corner whose argument has a value but no series, such as a root that begins here, could
        // change its side unnoticed.
        let mut corners = self.tape.corners();
        match corners.any(|(series, _)| series[0].is_finite() && !is_defined(series)) {
            true => Err(0),
            false => Ok(()),
        }
    }

    /// The series of a state.
    pub(super) fn state(&self, state: usize) -> &[f64] {
        self.tape.series(state)
    }

    /// Returns the rate of a state, the coefficient of order 1.
    pub(super) fn rate(&self, state: usize) -> f64 {
        self.state(state).get(1).copied().unwrap_or(0.0)
    }

    /// Returns the first event whose series is not finite; `None` if there is none.
    pub(super) fn undefined_event(&self) -> Option<usize> {
        if self.has_values {
            return None;
        }
        let is_defined = |event: usize| self.event(event).iter().all(|value| value.is_finite());
        (0..self.events).find(|event| !is_defined(*event))
    }

    /// The series of an event.
    pub(super) fn event(&self, event: usize) -> &[f64] {
        self.tape.series(self.outputs[self.states + event])
    }

    /// Returns the length, at most `longest`, of a step that ends beside the first narrow place, if
    /// there is one.
    pub(super) fn short_of_narrow(&mut self, longest: f64) -> f64 {
        let arguments = self.outputs.iter().skip(self.states + self.events);
        let mut length = longest;
        for (kind, output) in self.narrow.iter().zip(arguments) {
            let series = self.tape.series(*output);
            if end_of_step(*kind, series, length).is_none() {
                continue;
            }
            // The series of the argument is valid only within its own step length.
            let [valid] = self.of_arguments.bounds(&self.tape, [*output].into_iter()).longest;
            length = length.min(valid);
            if let Some(end) = end_of_step(*kind, series, length) {
                length = end;
            }
        }
        length
    }

    /// Finds the crossings of all events on the step in order: the index of the event, the time
    /// since the start of the step, and whether its function rises there. `signs` are the signs
    /// after the last step: a crossing that rounding has put between two steps counts at the
    /// beginning of the second.
    pub(super) fn crossings(
        &self,
        signs: &mut [f64],
        length: f64,
        met: &mut Vec<(usize, f64, bool)>,
    ) {
        met.clear();
        // On a step of length zero the sign would be due to rounding.
        if length == 0.0 {
            return;
        }
        for (event, before) in signs.iter_mut().enumerate() {
            let first = met.len();
            let sign = sign_and_roots(self.event(event), 0.0, length, &mut |place, rising| {
                met.push((event, place, rising));
            });
            if sign == 0.0 {
                met.truncate(first);
                continue;
            }
            if *before == -sign {
                met.insert(first, (event, 0.0, sign > 0.0));
            }
            let last = met[first..].last().map(|(_, _, rising)| *rising);
            *before = last.map_or(sign, |rising| if rising { 1.0 } else { -1.0 });
        }
        if met.len() > 1 {
            met.sort_by(|one, other| one.1.total_cmp(&other.1));
        }
    }

    /// Returns the first corner met within a step, and the time since its start: 0 if the motion
    /// turns back to the corner on which it starts, or leaves it on the other side. `None` if no
    /// corner is met.
    pub(super) fn first_corner(&self, length: f64) -> Option<(usize, f64)> {
        let met = |(index, (series, side)): (usize, (&[f64], f64))| {
            let (here, slope) = (side * series[0], side * series.get(1).copied().unwrap_or(0.0));
            let rounding = 1e-14 * length * slope.abs();
            let leading = series.iter().find(|value| **value != 0.0);
            let leaves = here == 0.0 && leading.is_some_and(|leading| side * leading < 0.0);
            if leaves || here <= rounding && slope < 0.0 {
                return Some((index, 0.0));
            }
            let mut crossed = roots(series, 0.0, length).into_iter();
            let left = crossed.find(|(_, rising)| *rising != (side > 0.0));
            left.map(|(place, _)| (index, place))
        };
        // A corner whose argument has no value is left out.
        let corners = self.tape.corners().enumerate();
        let found = corners.filter(|(_, (series, _))| series[0].is_finite()).filter_map(met);
        found.min_by(|one, other| one.1.total_cmp(&other.1))
    }

    /// Returns the speed of the argument of a corner at a time since the start of the step.
    pub(super) fn speed_at(&self, corner: usize, time: f64) -> Option<f64> {
        let (series, _) = self.tape.corners().nth(corner)?;
        let terms = series.iter().enumerate().skip(1).rev();
        let slope =
            terms.fold(0.0, |sum, (order, coefficient)| sum * time + order as f64 * coefficient);
        Some(slope.abs())
    }

    /// Whether only rounding leads away from a corner within a step: its argument stays far below
    /// the `change` that it would have had at its speed before. If the argument is zero throughout,
    /// the motion does not stick, but goes on.
    pub(super) fn stays_on(&self, corner: usize, change: f64, length: f64) -> bool {
        /// Ratio to `change` below which a value is rounding.
        const ROUNDING: f64 = 1e-12;
        let Some((series, _)) = self.tape.corners().nth(corner) else {
            return false;
        };
        let reached = series.iter().rev().fold(0.0, |sum, value| sum * length + value.abs());
        reached > 0.0 && reached <= ROUNDING * change
    }

    /// The sides of the corners.
    pub(super) fn sides(&self) -> Vec<f64> {
        self.tape.corners().map(|(_, side)| side).collect()
    }

    /// Sets the sides of all corners.
    pub(super) fn set_sides(&mut self, sides: &[f64]) {
        for (corner, side) in sides.iter().enumerate() {
            if self.tape.corners().nth(corner).is_some_and(|(_, now)| now != *side) {
                self.cross(corner);
            }
        }
    }

    /// Switches to the other side of a corner.
    pub(super) fn cross(&mut self, corner: usize) {
        self.tape.cross(corner);
    }
}
