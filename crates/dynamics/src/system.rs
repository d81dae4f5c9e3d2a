//! Systems of first-order equations `y' = F(t, y)`, written as expressions and integrated by their
//! Taylor series, or by a Runge-Kutta method, which does not use the series: each is a check of the
//! other.
//!
//! In: the names of the states, the name of time, one expression for each state, numbers for all
//! other symbols. Out: a [`Path`] with every state at any time between, the events it met, and the
//! reason why it ended. At a corner (`abs`, `sgn`, `H`, `max`, `min`) a step ends where the
//! argument changes its sign, and the next begins on the other side; a motion that sticks to a
//! corner, as with dry friction, ends there with that reason. Where a root acts, as in Hertz's contact,
//! the steps are in a variable in which it is a power series. If a function changes faster than the
//! motion, as in a narrow well, its argument shows this in advance, and steps end beside the place.
//!
//! ```
//! # use lindstedt_dynamics as lindstedt;
//! use lindstedt::expr::parse_expression;
//! use lindstedt::system::{Event, SystemOptions, System};
//!
//! // The pendulum from 1.5 rad at rest: its first passage through the vertical is a quarter of its period.
//! let pendulum = System::parse(&[("x", "v"), ("v", "-sin(x)")], &[])?;
//! let vertical = Event::stop(parse_expression("x")?);
//! let path = pendulum.solve([0.0, 10.0], &[1.5, 0.0], &[vertical], &SystemOptions::default())?;
//! let quarter_period = std::f64::consts::FRAC_PI_2 / 0.860_608_346_679_613;
//! assert!((path.end() - quarter_period).abs() < 1e-13);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod corner_powers;
mod expansion;
mod narrow;
mod polynomial;
mod roots;
mod runge_kutta;
mod spare_memory;
mod step_length;
mod steps;
mod taylor;
mod variations;

use std::collections::{BTreeMap, BTreeSet};

use crate::expr::{EvaluationError, Expr, ExprError, Function, Node, ParseError, parse_expression};
use crate::interrupt::Interrupt;
use crate::numeric::ode::root::{BisectionStop, bisect};
use crate::series::recurrence::RecurrenceError;
use crate::symbol::Symbol;

pub use corner_powers::roots_across_corners;
pub use taylor::{LANES, SideBySide};
pub use variations::Variations;

use expansion::Expansions;
use narrow::Argument;
use steps::TaylorSteps;
use taylor::TaylorRun;

/// A system of first-order equations, ready for integration.
///
/// As an example, a pendulum of two equal links: angles a and b from the vertical, rates p and q;
/// length, mass and gravity are one.
///
/// ```
/// # use lindstedt_dynamics as lindstedt;
/// use lindstedt::system::{SystemOptions, System};
/// let links = System::parse(&[
///     ("a", "p"),
///     ("b", "q"),
///     ("p", "(-2*sin(a) + cos(a - b)*sin(b) - sin(a - b)*(q^2 + cos(a - b)*p^2))/(2 - cos(a - b)^2)"),
///     ("q", "(2*cos(a - b)*sin(a) - 2*sin(b) + sin(a - b)*(2*p^2 + cos(a - b)*q^2))/(2 - cos(a - b)^2)"),
/// ], &[])?;
/// let path = links.solve([0.0, 20.0], &[1.5, -0.5, 0.0, 0.0], &[], &SystemOptions::default())?;
/// let [a, b, p, q] = path.states_at(20.0).expect("a state")[..] else { unreachable!() };
/// let energy = p * p + q * q / 2.0 + (a - b).cos() * p * q - 2.0 * a.cos() - b.cos();
/// assert!((energy + 2.0 * 1.5_f64.cos() + 0.5_f64.cos()).abs() < 1e-12);
/// # Ok::<(), lindstedt::system::SystemError>(())
/// ```
#[derive(Clone, Debug)]
pub struct System {
    state: Vec<Symbol>,
    time: Symbol,
    right: Vec<Expr>,
    numbers: BTreeMap<Symbol, f64>,
    critical: Vec<f64>,
    /// The arguments of functions that may vary faster than the motion.
    narrow: Vec<Argument>,
}

/// The reason why there is no system, or no path from this start.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SystemError {
    /// The number of right sides, or of initial values, is not that of the states.
    #[error("{states} states need {states} right sides, not {right_sides}")]
    Length {
        /// The number of states.
        states: usize,
        /// The number of right sides, or of initial values.
        right_sides: usize,
    },
    /// A right side has a syntax error.
    #[error(transparent)]
    Parse(#[from] ParseError),
    /// A name has no value, or a function has no recurrence.
    #[error(transparent)]
    Expression(#[from] RecurrenceError),
    /// An expression cannot be written with signs in place of its corners.
    #[error(transparent)]
    Piecewise(#[from] ExprError),
    /// An expression cannot be evaluated.
    #[error(transparent)]
    Evaluation(#[from] EvaluationError),
    /// The argument of a corner jumps at another corner.
    #[error("`{0}` has a corner whose argument jumps itself: write it without `H` or `sgn` inside")]
    JumpInCorner(Expr),
    /// A right side has no finite value or no series at the start.
    #[error("the rate of `{0}` has no finite value or no series at the start")]
    Start(Symbol),
    /// An event has no finite value at the start.
    #[error("event {0}, counted from 0, has no finite value or no series at the start")]
    Event(usize),
    /// A state begins beyond the largest size that is followed.
    #[error(
        "`{0}` begins at {1:e}, but no state is followed beyond 1e300: count it in a larger unit"
    )]
    Large(Symbol, f64),
    /// The start, an initial value, the end or the tolerance is out of range, or the end lies
    /// before the start.
    #[error(
        "start and end must be finite, the end after the start, the tolerance between 1e-16 and 0.1"
    )]
    Bounds,
}

/// The integration method.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Integrator {
    /// The Taylor series of the states, to rounding accuracy.
    #[default]
    Taylor,
    /// Verner's Runge-Kutta pair of order 9, which only evaluates the right sides.
    RungeKutta,
}

/// Method, tolerance and limits of an integration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SystemOptions {
    /// The integration method.
    pub integrator: Integrator,
    /// Relative error of a step, in units of the size of each state on it; Runge-Kutta uses 1e-14
    /// at least.
    pub tolerance: f64,
    /// Largest number of steps of a run; rejected steps of Runge-Kutta count.
    pub step_limit: usize,
    /// The time before which the states need not be kept; a run then takes no more memory for being
    /// longer before it. Only Taylor series make use of it.
    pub keep_from: f64,
    /// The request to stop the run.
    pub interrupt: Interrupt,
}

impl Default for SystemOptions {
    /// Taylor series to rounding accuracy, 100 000 steps, all of which are kept.
    fn default() -> Self {
        Self {
            integrator: Integrator::default(),
            tolerance: 1e-16,
            step_limit: 100_000,
            keep_from: f64::NEG_INFINITY,
            interrupt: Interrupt::default(),
        }
    }
}

/// An event: an expression in time and states whose zeros are located.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    expression: Expr,
    stops: bool,
    /// The direction of crossing that counts, `true` for upwards; `None` for both.
    rising: Option<bool>,
}

impl Event {
    /// An event that is only recorded. Crossings in both directions count.
    pub fn record(expression: Expr) -> Self {
        Self { expression, stops: false, rising: None }
    }

    /// An event that ends the path. Crossings in both directions count.
    pub fn stop(expression: Expr) -> Self {
        Self { stops: true, ..Self::record(expression) }
    }

    /// Counts only crossings from negative to positive.
    ///
    /// ```
    /// # use lindstedt_dynamics as lindstedt;
    /// use lindstedt::expr::parse_expression;
    /// use lindstedt::system::{Event, SystemOptions, System};
    ///
    /// let wave = System::parse(&[("x", "v"), ("v", "-x")], &[])?;
    /// let upwards = Event::stop(parse_expression("x")?).rising();
    /// let path = wave.solve([0.0, 10.0], &[1.0, 0.0], &[upwards], &SystemOptions::default())?;
    /// assert!((path.end() - 1.5 * std::f64::consts::PI).abs() < 1e-13); // cos t falls through zero at pi/2
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn rising(self) -> Self {
        Self { rising: Some(true), ..self }
    }

    /// Counts only crossings from positive to negative.
    #[must_use]
    pub fn falling(self) -> Self {
        Self { rising: Some(false), ..self }
    }

    /// Whether a crossing in this direction counts.
    fn counts(&self, rising: bool) -> bool {
        self.rising.is_none_or(|counted| counted == rising)
    }
}

/// One occurrence of an event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EventCrossing {
    /// Index of the event.
    pub event: usize,
    /// The time.
    pub time: f64,
    /// Whether the expression crossed zero from negative to positive.
    pub rising: bool,
}

/// The reason why a path ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathEnd {
    /// The end time was reached.
    Reached,
    /// The event of this index stopped the path.
    Event(usize),
    /// The largest number of steps was used up.
    StepLimit,
    /// The steps vanish, or a state or an event becomes undefined: at a pole, or a root at zero.
    Singular,
    /// A state overflowed: it exceeds 1e300, or is so large that its rates do.
    Overflow,
    /// The state stays on a corner: the rates on both sides lead back to it.
    Sticks,
    /// The motion has passed a rigid wall.
    PassesWall,
    /// Events follow each other faster than they can be told apart.
    EventsAccumulate,
    /// An event sets a state to no number, or puts the motion behind a rigid wall.
    NoReset,
    /// The run was interrupted.
    Interrupted,
}

/// The relative tolerances of a step that are accepted.
const TOLERANCES: std::ops::RangeInclusive<f64> = 1e-16..=0.1;

/// Largest size of a state: doubles end at 1.8e308, and sums and products within a step need room.
const LARGEST: f64 = 1e300;

/// Size of a state beyond which rates without a value count as too large rather than undefined,
/// since fourth powers exceed [`LARGEST`].
const LARGE: f64 = 1e75;

/// Whether no state exceeds the largest size that is followed.
fn within_range(mut states: impl Iterator<Item = f64>) -> bool {
    states.all(|state| state.abs() <= LARGEST)
}

/// Returns the reason why a run ends in these states, after a step from one time to another, if its
/// rates have no value or no further step is possible.
fn without_value(mut states: impl Iterator<Item = f64>, step: [f64; 2]) -> PathEnd {
    match states.any(|state| state.abs() > LARGE) && !is_vanishing(step) {
        true => PathEnd::Overflow,
        false => PathEnd::Singular,
    }
}

/// Whether a step from one time to another, both since the start, is so short that it lies just
/// before a pole, where the size of the states is meaningless.
fn is_vanishing([from, to]: [f64; 2]) -> bool {
    to - from <= 1e-10 * to
}

/// Returns the last place before `length` at which all states are within range; `None` if they are
/// still within range at `length`.
fn end_of_range(length: f64, mut is_within: impl FnMut(f64) -> bool) -> Option<f64> {
    const HALVINGS: u32 = 60;
    if is_within(length) {
        return None;
    }
    let [within, _] = bisect(is_within, 0.0, length, BisectionStop::Halvings(HALVINGS));
    Some(within)
}

/// The solution of a system from the start to the end.
#[derive(Clone, Debug)]
pub struct Path {
    motion: PathRepresentation,
    end: f64,
    reason: PathEnd,
}

/// The representation from which states are interpolated.
#[derive(Clone, Debug)]
enum PathRepresentation {
    Taylor { steps: TaylorSteps, start: f64 },
    RungeKutta(Box<EvaluatedPath>),
}

/// A path by Runge-Kutta.
#[derive(Clone, Debug)]
struct EvaluatedPath {
    motion: runge_kutta::ScaledTrajectory,
    /// The states at the end.
    last: Vec<f64>,
    occurrences: Vec<EventCrossing>,
}

impl Path {
    /// A path that ends at the time at which it begins, in these states.
    pub fn at_instant(time: f64, states: &[f64], reason: PathEnd) -> Self {
        let steps = TaylorSteps::at_rest(states);
        let motion = PathRepresentation::Taylor { steps, start: time };
        Self { motion, end: time, reason }
    }

    /// The time at which the path ends.
    pub fn end(&self) -> f64 {
        self.end
    }

    /// The reason why the path ends there.
    pub fn reason(&self) -> PathEnd {
        self.reason
    }

    /// The events met, in order.
    pub fn occurrences(&self) -> &[EventCrossing] {
        match &self.motion {
            PathRepresentation::Taylor { steps, .. } => &steps.lists.occurrences,
            PathRepresentation::RungeKutta(path) => &path.occurrences,
        }
    }

    /// The states at the end as they were computed there, from which the motion goes on. [`Path::states_at`] is
    /// at the time of the end, which is rounded.
    pub fn last_states(&self) -> &[f64] {
        match &self.motion {
            PathRepresentation::Taylor { steps, .. } => &steps.lists.last,
            PathRepresentation::RungeKutta(path) => &path.last,
        }
    }

    /// The number of steps.
    pub fn step_count(&self) -> usize {
        match &self.motion {
            PathRepresentation::Taylor { steps, .. } => steps.count(),
            PathRepresentation::RungeKutta(path) => path.motion.step_count(),
        }
    }

    /// All states at a time; `None` outside the path.
    pub fn states_at(&self, time: f64) -> Option<Vec<f64>> {
        if time.is_nan() || time > self.end {
            return None;
        }
        match &self.motion {
            PathRepresentation::Taylor { steps, start } => steps.states_at(time - start),
            PathRepresentation::RungeKutta(path) => path.motion.states_at(time),
        }
    }
}

impl Path {
    /// One state, by its index, at a time; `None` outside the path.
    pub fn state_at(&self, time: f64, state: usize) -> Option<f64> {
        match &self.motion {
            PathRepresentation::Taylor { .. } if time.is_nan() || time > self.end => None,
            PathRepresentation::Taylor { steps, start } => steps.state_at(time - start, state),
            PathRepresentation::RungeKutta(_) => self.states_at(time)?.get(state).copied(),
        }
    }

    /// Returns the times from `from` on at which a state, given by its index, passes through zero,
    /// in increasing order: every root of its series. Returns `None` for Runge-Kutta, which has no
    /// series.
    ///
    /// ```
    /// # use lindstedt_dynamics as lindstedt;
    /// use lindstedt::system::{SystemOptions, System};
    ///
    /// let wave = System::parse(&[("x", "v"), ("v", "-x")], &[])?;
    /// let path = wave.solve([0.0, 10.0], &[0.0, 1.0], &[], &SystemOptions::default())?;
    /// let zeros = path.zeros(0, 1.0).expect("a path of series");
    /// assert_eq!(zeros.len(), 3);
    /// assert!((zeros[2] - 3.0 * std::f64::consts::PI).abs() < 1e-13);
    /// # Ok::<(), lindstedt::system::SystemError>(())
    /// ```
    pub fn zeros(&self, state: usize, from: f64) -> Option<Vec<f64>> {
        let PathRepresentation::Taylor { steps, start } = &self.motion else { return None };
        let zeros = steps.zeros([from - start, self.end - start], state);
        Some(zeros.into_iter().map(|time| start + time).collect())
    }

    /// Returns the least and the greatest value of a state, given by its index, from `from` on: at both
    /// ends, and where the slope of its series passes through zero. Returns `None` for Runge-Kutta, which
    /// has no series.
    ///
    /// ```
    /// # use lindstedt_dynamics as lindstedt;
    /// use lindstedt::system::{SystemOptions, System};
    ///
    /// let wave = System::parse(&[("x", "v"), ("v", "-x")], &[])?;
    /// let path = wave.solve([0.0, 4.0], &[0.0, 1.0], &[], &SystemOptions::default())?;
    /// let [least, greatest] = path.range(0, 1.0).expect("a path of series");
    /// assert!((least - 4_f64.sin()).abs() < 1e-15 && (greatest - 1.0).abs() < 1e-15);
    /// # Ok::<(), lindstedt::system::SystemError>(())
    /// ```
    pub fn range(&self, state: usize, from: f64) -> Option<[f64; 2]> {
        let PathRepresentation::Taylor { steps, start } = &self.motion else { return None };
        Some(steps.range([from - start, self.end - start], state))
    }

    /// Samples the states at many times in increasing order: the times that are within the path are
    /// added to `kept`, and the values of the first states there to the columns, one for each
    /// state. This is faster than as many calls of [`Path::states_at`], and gives the same values.
    pub fn sample(&self, times: &[f64], kept: &mut Vec<f64>, columns: &mut [Vec<f64>]) {
        match &self.motion {
            PathRepresentation::Taylor { steps, start } => {
                let before = times.partition_point(|time| *time - start < steps.first_start());
                let own = &times[before..];
                let own = &own[..own.partition_point(|time| *time <= self.end)];
                kept.extend_from_slice(own);
                steps.sample(*start, own, columns);
            }
            PathRepresentation::RungeKutta(_) => {
                for time in times {
                    let Some(states) = self.states_at(*time) else {
                        continue;
                    };
                    kept.push(*time);
                    for (column, state) in columns.iter_mut().zip(states) {
                        column.push(state);
                    }
                }
            }
        }
    }
}

/// A system prepared for many integrations: its recurrences are derived once.
///
/// ```
/// # use lindstedt_dynamics as lindstedt;
/// use lindstedt::system::{SystemOptions, System};
///
/// let stiffness = |k: f64| [("k".into(), k)].into();
/// let solver = System::parse(&[("x", "v"), ("v", "-k*x")], &[("k", 4.0)])?.solver(&[], &SystemOptions::default());
/// let slower = solver.with_numbers(&stiffness(0.25)).expect("equations of the same form");
/// let path = slower.solve([0.0, 2.0], &[1.0, 0.0])?;
/// assert!((path.states_at(2.0).expect("a state")[0] - 1.0_f64.cos()).abs() < 1e-14);
/// # Ok::<(), lindstedt::system::SystemError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Solver {
    system: System,
    events: Vec<Event>,
    options: SystemOptions,
    /// The recurrences; `None` for Runge-Kutta.
    expansions: Option<Result<Expansions, RecurrenceError>>,
    /// The symbols in the arguments of corners, in roots and in their exponents.
    fixed: BTreeSet<Symbol>,
}

impl Solver {
    /// The events.
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// Returns the solver with other values of the parameters. Returns `None` if the recurrences
    /// must be derived anew: for other numbers in corners or roots, which determine what is one
    /// corner, and for Runge-Kutta.
    #[must_use]
    pub fn with_numbers(&self, numbers: &BTreeMap<Symbol, f64>) -> Option<Self> {
        let Some(Ok(expansions)) = &self.expansions else {
            return None;
        };
        let is_same = |name: &Symbol| {
            let [before, now] = [&self.system.numbers, numbers].map(|numbers| numbers.get(name));
            before.map(|number| number.to_bits()) == now.map(|number| number.to_bits())
        };
        if !self.fixed.iter().all(is_same) {
            return None;
        }
        Some(Self {
            expansions: Some(Ok(expansions.clone())),
            system: System { numbers: numbers.clone(), ..self.system.clone() },
            events: self.events.clone(),
            options: self.options,
            fixed: self.fixed.clone(),
        })
    }

    /// Returns the solver of another system with the same equations and these events. Returns `None` if its equations
    /// are others, or as [`with_numbers`](Self::with_numbers).
    #[must_use]
    pub fn for_system(
        &self,
        system: &System,
        events: &[Event],
        options: &SystemOptions,
    ) -> Option<Self> {
        let is_same = self.options.tolerance.to_bits() == options.tolerance.to_bits()
            && self.options.integrator == options.integrator
            && self.events == events
            && self.system.state == system.state
            && self.system.time == system.time
            && self.system.right == system.right
            && self.system.critical == system.critical;
        let own = is_same.then(|| self.with_numbers(&system.numbers))??;
        Some(Self { options: *options, ..own })
    }

    /// Returns the solver with other critical times, see [`System::with_critical_times`].
    #[must_use]
    pub fn with_critical_times(self, times: &[f64]) -> Self {
        Self { system: self.system.with_critical_times(times), ..self }
    }

    /// Integrates as [`System::solve`] does.
    ///
    /// # Errors
    /// As for [`System::solve`].
    pub fn solve(&self, times: [f64; 2], values: &[f64]) -> Result<Path, SystemError> {
        self.system.check(times, values, &self.options)?;
        let (system, events, options) = (&self.system, &self.events, &self.options);
        match &self.expansions {
            Some(expansions) => {
                let own = expansions.as_ref().map_err(Clone::clone)?;
                let idle = &mut vec![];
                let run = TaylorRun::new(system, times, values, events, options, own, idle);
                taylor::follow(run?)
            }
            None => runge_kutta::follow(system, times, values, events, options),
        }
    }
}

/// Integrates several motions as [`Solver::solve`] does, each between its own times and from its own
/// values. Motions whose solvers differ only in numbers are computed side by side, [`LANES`] at a
/// time; each result is bit for bit the same as alone.
pub fn solve_together(motions: &[(&Solver, [f64; 2], &[f64])]) -> Vec<Result<Path, SystemError>> {
    SideBySide::default().solve(motions)
}

impl System {
    /// Reads equations `(state, right side)` in the time `t` from texts; every other symbol has its
    /// value in `numbers`.
    ///
    /// # Errors
    /// [`SystemError`].
    pub fn parse(equations: &[(&str, &str)], numbers: &[(&str, f64)]) -> Result<Self, SystemError> {
        let states: Vec<Symbol> = equations.iter().map(|(state, _)| Symbol::new(state)).collect();
        let right: Result<Vec<Expr>, ParseError> =
            equations.iter().map(|(_, right)| parse_expression(right)).collect();
        let numbers = numbers.iter().map(|(name, value)| (Symbol::new(name), *value)).collect();
        Self::new(&states, "t".into(), &right?, &numbers)
    }

    /// The equations `state[i]' = right[i]`; every other symbol has its value in `numbers`.
    ///
    /// # Errors
    /// [`SystemError`].
    pub fn new(
        state: &[Symbol],
        time: Symbol,
        right: &[Expr],
        numbers: &BTreeMap<Symbol, f64>,
    ) -> Result<Self, SystemError> {
        if state.len() != right.len() {
            return Err(SystemError::Length { states: state.len(), right_sides: right.len() });
        }
        let right: Vec<Expr> = right
            .iter()
            .map(|right| roots_across_corners(right, numbers))
            .collect::<Result<_, _>>()?;
        if let Some(part) = right.iter().find_map(jump_in_corner) {
            return Err(SystemError::JumpInCorner(part));
        }
        let guards = narrow::guards_in(&right, numbers);
        let system = Self {
            state: state.to_vec(),
            time,
            narrow: narrow::arguments(&right, state, &guards, numbers),
            right,
            numbers: numbers.clone(),
            critical: vec![],
        };
        expansion::check(&system, &[])?;
        Ok(system)
    }

    /// Returns these equations with times that no step crosses: times near which the right sides
    /// change too fast to be noticed from afar, such as both ends of a short pulse. The times may
    /// have any order; those that are not finite are ignored.
    #[must_use]
    pub fn with_critical_times(self, times: &[f64]) -> Self {
        let mut critical: Vec<f64> =
            times.iter().copied().filter(|time| time.is_finite()).collect();
        critical.sort_by(f64::total_cmp);
        Self { critical, ..self }
    }

    /// Integrates from the first of the `times` to the second, or to the first event that stops.
    /// The `values` are those of the states at the first. By Taylor series a step of order p costs
    /// p^2 operations for each product or function of the right sides; by Runge-Kutta, which needs
    /// three to five times as many steps, it costs 22 evaluations of them.
    ///
    /// # Errors
    /// [`SystemError`] if the run cannot begin. A run that ends early is no error: see
    /// [`Path::reason`].
    ///
    /// ```
    /// # use lindstedt_dynamics as lindstedt;
    /// use lindstedt::system::{Integrator, SystemOptions, System};
    ///
    /// // Prey and predator of Lotka and Volterra, by both integrators.
    /// let system = System::parse(&[("x", "x*(1 - y)"), ("y", "y*(x - 1)")], &[])?;
    /// let [taylor, runge_kutta] = [Integrator::Taylor, Integrator::RungeKutta].map(|integrator| {
    ///     let options = SystemOptions { integrator, ..SystemOptions::default() };
    ///     system.solve([0.0, 10.0], &[2.0, 1.0], &[], &options).map(|path| path.states_at(10.0))
    /// });
    /// let difference = taylor?.expect("a state")[0] - runge_kutta?.expect("a state")[0];
    /// assert!(difference.abs() < 1e-9);
    /// # Ok::<(), lindstedt::system::SystemError>(())
    /// ```
    pub fn solve(
        &self,
        times: [f64; 2],
        values: &[f64],
        events: &[Event],
        options: &SystemOptions,
    ) -> Result<Path, SystemError> {
        self.check(times, values, options)?;
        match options.integrator {
            Integrator::Taylor => {
                let expansions = Expansions::new(self, events, options.tolerance)?;
                let idle = &mut vec![];
                let run = TaylorRun::new(self, times, values, events, options, &expansions, idle);
                taylor::follow(run?)
            }
            Integrator::RungeKutta => runge_kutta::follow(self, times, values, events, options),
        }
    }

    /// Prepares this system for many integrations with these events.
    pub fn solver(self, events: &[Event], options: &SystemOptions) -> Solver {
        // There is no order for a tolerance out of range, which every run refuses.
        let has_order = TOLERANCES.contains(&options.tolerance);
        let expansions = match options.integrator {
            Integrator::Taylor if has_order => {
                Some(Expansions::new(&self, events, options.tolerance))
            }
            Integrator::Taylor | Integrator::RungeKutta => None,
        };
        let expressions = self.right.iter().chain(events.iter().map(|event| &event.expression));
        let fixed = expressions.flat_map(roots::fixed_symbols).collect();
        Solver { system: self, events: events.to_vec(), options: *options, expansions, fixed }
    }

    /// Checks that the system can be integrated from these values between these times.
    fn check(
        &self,
        [start, end]: [f64; 2],
        values: &[f64],
        options: &SystemOptions,
    ) -> Result<(), SystemError> {
        let size = self.state.len();
        if values.len() != size {
            return Err(SystemError::Length { states: size, right_sides: values.len() });
        }
        let finite =
            start.is_finite() && end.is_finite() && values.iter().all(|value| value.is_finite());
        if !finite || end < start || !TOLERANCES.contains(&options.tolerance) {
            return Err(SystemError::Bounds);
        }
        let large = self.state.iter().zip(values).find(|(_, value)| value.abs() > LARGEST);
        if let Some((state, value)) = large {
            return Err(SystemError::Large(*state, *value));
        }
        Ok(())
    }
}

/// Returns a corner whose argument jumps at another corner, so that its side after the jump does
/// not follow from the side before; `None` if there is none.
fn jump_in_corner(expression: &Expr) -> Option<Expr> {
    let jumps = |part: &Expr| {
        part.contains_function(Function::Step) || part.contains_function(Function::Sign)
    };
    let is_corner = |part: &&Expr| match part.node() {
        Node::Function(function, _) => function.has_corner(),
        _ => false,
    };
    let mut corners = expression.unique_nodes().filter(is_corner);
    corners.find(|corner| corner.children().any(jumps)).cloned()
}

/// Returns the rate of an expression along the motion of states with these rates; `None` if it
/// cannot be written.
///
/// ```
/// # use lindstedt_dynamics as lindstedt;
/// use lindstedt::{Symbol, expr::parse_expression, system::rate_along};
///
/// let [energy, force] = ["v^2/2 + x^2/2", "-x - v/5"].map(|text| parse_expression(text).expect("a text"));
/// let [x, v] = ["x", "v"].map(Symbol::new);
/// let rate = rate_along(&energy, "t".into(), &[x, v], &[v.into(), force]).expect("a rate");
/// assert_eq!(rate.expand().expect("a sum").to_string(), "-v^2/5");
/// ```
pub fn rate_along(
    expression: &Expr,
    time: Symbol,
    states: &[Symbol],
    right: &[Expr],
) -> Option<Expr> {
    let mut parts = vec![expression.differentiate(time).ok()?];
    for (state, right) in states.iter().zip(right) {
        parts.push(expression.differentiate(*state).ok()? * right);
    }
    Some(Expr::sum(parts))
}
