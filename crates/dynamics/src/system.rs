//! First-order equations `y' = F(t, y)` of any number, written as expressions and followed by their
//! Taylor series, or by Runge-Kutta, which knows nothing of the series: each is a check of the
//! other.
//!
//! In: the names of the states, the name of time, one expression a state, numbers for everything
//! else. Out: a [`Path`] that answers every state at any time between, the events it met, and why
//! it ended. Corners (`abs`, `sgn`, `H`, `max`, `min`) end a step where their argument changes its
//! sign and begin the next on the other side; a motion that sticks to a corner, as dry friction
//! makes it, is handed back up to there with its reason. Where a function turns faster than the
//! motion, as a narrow well does, its argument tells beforehand, and steps end beside it.
//!
//! ```
//! # use lindstedt_dynamics as lindstedt;
//! use lindstedt::expr::parse_expression;
//! use lindstedt::system::{Event, SystemOptions, System};
//!
//! // The pendulum from 1.5 rad at rest: its first passage through the vertical is a quarter of its period.
//! let pendulum = System::parse(&[("x", "v"), ("v", "-sin(x)")], &[])?;
//! let vertical = Event::stop(parse_expression("x")?);
//! let path = pendulum.solve(0.0, &[1.5, 0.0], 10.0, &[vertical], &SystemOptions::default())?;
//! let quarter_period = std::f64::consts::FRAC_PI_2 / 0.860_608_346_679_613;
//! assert!((path.end() - quarter_period).abs() < 1e-13);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod narrow;
mod polynomial;
mod runge_kutta;
mod taylor;

use std::collections::BTreeMap;

use crate::expr::{EvaluationError, Expr, ExprError, Function, Node, ParseError, parse_expression};
use crate::interrupt::Interrupt;
use crate::numeric::ode::root::{BisectionStop, bisect};
use crate::series::recurrence::RecurrenceError;
use crate::symbol::Symbol;

pub use taylor::LANES;

use narrow::Argument;
use taylor::{SystemSeries, TaylorRun, TaylorStep};

/// Equations ready to be followed.
///
/// A pendulum of two equal links: angles a and b from the vertical, rates p and q; length, mass and
/// gravity are one.
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
/// let path = links.solve(0.0, &[1.5, -0.5, 0.0, 0.0], 20.0, &[], &SystemOptions::default())?;
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
    /// Arguments of functions that may vary faster than the motion.
    narrow: Vec<Argument>,
}

/// The reason why there is no system, or no path from this start.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SystemError {
    /// As many expressions as states.
    #[error("{states} states need {states} right sides, not {right_sides}")]
    Length {
        /// The number of states, or of initial values.
        states: usize,
        /// The number of right sides.
        right_sides: usize,
    },
    /// A right side that cannot be read.
    #[error(transparent)]
    Parse(#[from] ParseError),
    /// A name without a value, or a function without a recurrence.
    #[error(transparent)]
    Expression(#[from] RecurrenceError),
    /// An expression that cannot be written piece by piece between its corners.
    #[error(transparent)]
    Piecewise(#[from] ExprError),
    /// An expression that cannot be evaluated.
    #[error(transparent)]
    Evaluation(#[from] EvaluationError),
    /// A corner whose argument jumps at another corner.
    #[error("`{0}` has a corner whose argument jumps itself: write it without `H` or `sgn` inside")]
    JumpInCorner(Expr),
    /// A right side has no finite value or no series at the start.
    #[error("the rate of `{0}` has no finite value or no series at the start")]
    Start(Symbol),
    /// An event has no finite value at the start.
    #[error("event {0}, counted from 0, has no finite value or no series at the start")]
    Event(usize),
    /// A state that begins where numbers end.
    #[error(
        "`{0}` begins at {1:e}, but no state is followed beyond 1e300: count it in a larger unit"
    )]
    Large(Symbol, f64),
    /// A start, an end or a tolerance that is not a finite number, or an end before the start.
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
    /// Verner's Runge-Kutta pair of order 9, which evaluates the right sides and expands nothing.
    RungeKutta,
}

/// Method, tolerance and limits of an integration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SystemOptions {
    /// The integration method.
    pub integrator: Integrator,
    /// Error of a step, relative to the size of each state on it; Runge-Kutta keeps no less than
    /// 1e-14.
    pub tolerance: f64,
    /// Steps after which the run ends; those of Runge-Kutta that had to be repeated count.
    pub step_limit: usize,
    /// The interrupt.
    pub interrupt: Interrupt,
}

impl Default for SystemOptions {
    /// Taylor series to rounding accuracy, 100 000 steps.
    fn default() -> Self {
        Self {
            integrator: Integrator::default(),
            tolerance: 1e-16,
            step_limit: 100_000,
            interrupt: Interrupt::default(),
        }
    }
}

/// An expression in time and states whose zero matters.
#[derive(Clone, Debug)]
pub struct Event {
    expression: Expr,
    stops: bool,
    /// The only direction of crossing that counts, where not both do: `true` upwards.
    rising: Option<bool>,
}

impl Event {
    /// An event that is only listed.
    pub fn record(expression: Expr) -> Self {
        Self { expression, stops: false, rising: None }
    }

    /// An event that ends the path.
    pub fn stop(expression: Expr) -> Self {
        Self { stops: true, ..Self::record(expression) }
    }

    /// Counts only where the expression grows through zero.
    ///
    /// ```
    /// # use lindstedt_dynamics as lindstedt;
    /// use lindstedt::expr::parse_expression;
    /// use lindstedt::system::{Event, SystemOptions, System};
    ///
    /// let wave = System::parse(&[("x", "v"), ("v", "-x")], &[])?;
    /// let upwards = Event::stop(parse_expression("x")?).rising();
    /// let path = wave.solve(0.0, &[1.0, 0.0], 10.0, &[upwards], &SystemOptions::default())?;
    /// assert!((path.end() - 1.5 * std::f64::consts::PI).abs() < 1e-13); // cos t falls through zero at pi/2
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn rising(self) -> Self {
        Self { rising: Some(true), ..self }
    }

    /// Counts only where the expression falls through zero.
    #[must_use]
    pub fn falling(self) -> Self {
        Self { rising: Some(false), ..self }
    }

    /// Whether a crossing in this direction counts.
    fn counts(&self, rising: bool) -> bool {
        self.rising.is_none_or(|counted| counted == rising)
    }
}

/// An event that happened.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EventCrossing {
    /// Index of the event.
    pub event: usize,
    /// The time.
    pub time: f64,
    /// Whether its expression grew through zero.
    pub rising: bool,
}

/// The reason why a path ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathEnd {
    /// The end time.
    Reached,
    /// The event of this index.
    Event(usize),
    /// After as many steps as were allowed.
    StepLimit,
    /// The steps vanish, or a state or an event has no value any more: a pole, or a root at zero.
    Singular,
    /// A state overflowed: it is larger than 1e300, or so large that its rates are.
    Overflow,
    /// The state stays on a corner: the rates on both sides lead back to it.
    Sticks,
    /// An interrupt.
    Interrupted,
}

/// The relative tolerances of a step that can be asked for.
const TOLERANCES: std::ops::RangeInclusive<f64> = 1e-16..=0.1;

/// Largest size of a state: doubles end at 1.8e308, and sums and products within a step need room.
const LARGEST: f64 = 1e300;

/// A state from which on rates without a value are too large rather than undefined: fourth powers
/// are beyond [`LARGEST`].
const LARGE: f64 = 1e75;

/// Whether all of these are numbers that are followed.
fn within_range(mut states: impl Iterator<Item = f64>) -> bool {
    states.all(|state| state.abs() <= LARGEST)
}

/// The reason why a run ends in these states where its rates have no value, or no next step is
/// possible, behind a step from one time to another.
fn without_value(mut states: impl Iterator<Item = f64>, step: [f64; 2]) -> PathEnd {
    match states.any(|state| state.abs() > LARGE) && !is_vanishing(step) {
        true => PathEnd::Overflow,
        false => PathEnd::Singular,
    }
}

/// Whether a step from one time to another, both since the start, is so short that it stands before
/// a pole: what its states have become there means nothing.
fn is_vanishing([from, to]: [f64; 2]) -> bool {
    to - from <= 1e-10 * to
}

/// The last place up to this one at which all states are within the range of numbers, where they
/// leave it before.
fn end_of_range(length: f64, mut is_within: impl FnMut(f64) -> bool) -> Option<f64> {
    const HALVINGS: u32 = 60;
    if is_within(length) {
        return None;
    }
    let [within, _] = bisect(is_within, 0.0, length, BisectionStop::Halvings(HALVINGS));
    Some(within)
}

/// The states from the start to the end.
#[derive(Clone, Debug)]
pub struct Path {
    motion: PathRepresentation,
    end: f64,
    reason: PathEnd,
    occurrences: Vec<EventCrossing>,
}

/// The representation from which states are interpolated.
#[derive(Clone, Debug)]
enum PathRepresentation {
    Taylor { steps: Vec<TaylorStep>, start: f64 },
    RungeKutta(runge_kutta::ScaledTrajectory),
}

impl Path {
    /// The time at which it ends.
    pub fn end(&self) -> f64 {
        self.end
    }

    /// The reason why it ends there.
    pub fn reason(&self) -> PathEnd {
        self.reason
    }

    /// The events met, in order.
    pub fn occurrences(&self) -> &[EventCrossing] {
        &self.occurrences
    }

    /// The number of steps.
    pub fn step_count(&self) -> usize {
        match &self.motion {
            PathRepresentation::Taylor { steps, .. } => steps.len(),
            PathRepresentation::RungeKutta(motion) => motion.step_count(),
        }
    }

    /// All states at a time; `None` outside the path.
    pub fn states_at(&self, time: f64) -> Option<Vec<f64>> {
        if time.is_nan() || time > self.end {
            return None;
        }
        match &self.motion {
            PathRepresentation::Taylor { steps, start } => taylor::states_at(steps, time - start),
            PathRepresentation::RungeKutta(motion) => motion.states_at(time),
        }
    }
}

impl Path {
    /// One state, by its number, at a time; `None` outside the path.
    pub fn state_at(&self, time: f64, state: usize) -> Option<f64> {
        match &self.motion {
            PathRepresentation::Taylor { .. } if time.is_nan() || time > self.end => None,
            PathRepresentation::Taylor { steps, start } => {
                taylor::state_at(steps, time - start, state)
            }
            PathRepresentation::RungeKutta(_) => self.states_at(time)?.get(state).copied(),
        }
    }

    /// The states at many times, in increasing order: those of the times that are within the path
    /// are added to `kept`, and the first states there to the columns, one each. Costs less than as
    /// many calls of [`Path::states_at`] and has the same values.
    pub fn sample(&self, times: &[f64], kept: &mut Vec<f64>, columns: &mut [Vec<f64>]) {
        match &self.motion {
            PathRepresentation::Taylor { steps, start } => {
                let before = times.partition_point(|time| *time - start < 0.0);
                let own = &times[before..];
                let own = &own[..own.partition_point(|time| *time <= self.end)];
                kept.extend_from_slice(own);
                let since_start: Vec<f64> = own.iter().map(|time| time - start).collect();
                taylor::sample(steps, &since_start, columns);
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

/// A system made ready to be followed many times: its recurrences are found once.
///
/// ```
/// # use lindstedt_dynamics as lindstedt;
/// use lindstedt::system::{SystemOptions, System};
///
/// let stiffness = |k: f64| [("k".into(), k)].into();
/// let solver = System::parse(&[("x", "v"), ("v", "-k*x")], &[("k", 4.0)])?.solver(&[], &SystemOptions::default());
/// let slower = solver.with_numbers(&stiffness(0.25)).expect("equations of the same form");
/// let path = slower.solve(0.0, &[1.0, 0.0], 2.0)?;
/// assert!((path.states_at(2.0).expect("a state")[0] - 1.0_f64.cos()).abs() < 1e-14);
/// # Ok::<(), lindstedt::system::SystemError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Solver {
    system: System,
    events: Vec<Event>,
    options: SystemOptions,
    /// Runge-Kutta has no use for it.
    expansion: Option<Result<SystemSeries, RecurrenceError>>,
}

impl Solver {
    /// These equations take other numbers for their letters. `None` says that they have to be made
    /// ready anew: beside corners, whose arguments may be in proportion for some numbers and not
    /// for others, and where a letter is one, a factor that may be left out.
    #[must_use]
    pub fn with_numbers(&self, numbers: &BTreeMap<Symbol, f64>) -> Option<Self> {
        let Some(Ok(expansion)) = &self.expansion else {
            return None;
        };
        Some(Self {
            expansion: Some(Ok(expansion.with_numbers(numbers)?)),
            system: System { numbers: numbers.clone(), ..self.system.clone() },
            events: self.events.clone(),
            options: self.options,
        })
    }

    /// Its equations with other critical times.
    #[must_use]
    pub fn with_critical_times(self, times: &[f64]) -> Self {
        Self { system: self.system.with_critical_times(times), ..self }
    }

    /// As [`System::solve`].
    ///
    /// # Errors
    /// As there.
    pub fn solve(&self, start: f64, values: &[f64], end: f64) -> Result<Path, SystemError> {
        self.system.check(start, values, end, &self.options)?;
        let (system, events, options) = (&self.system, &self.events, &self.options);
        match &self.expansion {
            Some(expansion) => {
                let expansion = expansion.clone()?;
                let run = TaylorRun::new(system, [start, end], values, events, options, expansion);
                taylor::follow(run)
            }
            None => runge_kutta::follow(system, [start, end], values, events, options),
        }
    }
}

/// As [`Solver::solve`] for several motions between the same times, each from its values: those
/// whose solvers differ in numbers alone go side by side, [`LANES`] at a time, each bit for bit as
/// it is alone.
pub fn solve_together(
    motions: &[(&Solver, &[f64])],
    start: f64,
    end: f64,
) -> Vec<Result<Path, SystemError>> {
    let mut runs: Vec<TaylorRun> = Vec::new();
    let mut alone = Vec::new();
    for (solver, values) in motions {
        let Solver { system, events, options, expansion } = *solver;
        let is_like = |own: &SystemSeries| runs.first().is_none_or(|run| run.is_like(own));
        match expansion {
            Some(Ok(own)) if is_like(own) && system.check(start, values, end, options).is_ok() => {
                let times = [start, end];
                runs.push(TaylorRun::new(system, times, values, events, options, own.clone()));
                alone.push(None);
            }
            _ => alone.push(Some(solver.solve(start, values, end))),
        }
    }
    let mut together = taylor::follow_together(runs).into_iter();
    alone.into_iter().filter_map(|alone| alone.or_else(|| together.next())).collect()
}

impl System {
    /// The equations `(state, right side)` in the time `t`, as texts; every other symbol has its
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
        if let Some(part) = right.iter().find_map(jump_in_corner) {
            return Err(SystemError::JumpInCorner(part));
        }
        let system = Self {
            state: state.to_vec(),
            time,
            right: right.to_vec(),
            numbers: numbers.clone(),
            critical: vec![],
            narrow: narrow::arguments(right, state, &narrow::guards_in(right, numbers), numbers),
        };
        taylor::check(&system, &[])?;
        Ok(system)
    }

    /// Returns these equations with times that no step crosses: where the right sides turn faster
    /// than can be seen from afar, as at both ends of a short pulse. The times come in any order;
    /// those that are not finite are left out.
    #[must_use]
    pub fn with_critical_times(self, times: &[f64]) -> Self {
        let mut critical: Vec<f64> =
            times.iter().copied().filter(|time| time.is_finite()).collect();
        critical.sort_by(f64::total_cmp);
        Self { critical, ..self }
    }

    /// Follows the states from `start` until `end`, or to the first event that stops. Costs, by
    /// Taylor series, for each step of order p, p^2 operations a product or function of the right
    /// sides; by Runge-Kutta, which makes three to five times as many steps, 22 evaluations of
    /// them.
    ///
    /// # Errors
    /// [`SystemError`] where the run cannot begin; one that ends early says so by [`Path::reason`].
    ///
    /// ```
    /// # use lindstedt_dynamics as lindstedt;
    /// use lindstedt::system::{Integrator, SystemOptions, System};
    ///
    /// // Prey and predator of Lotka and Volterra, by both integrators.
    /// let system = System::parse(&[("x", "x*(1 - y)"), ("y", "y*(x - 1)")], &[])?;
    /// let [taylor, runge_kutta] = [Integrator::Taylor, Integrator::RungeKutta].map(|integrator| {
    ///     let options = SystemOptions { integrator, ..SystemOptions::default() };
    ///     system.solve(0.0, &[2.0, 1.0], 10.0, &[], &options).map(|path| path.states_at(10.0))
    /// });
    /// let difference = taylor?.expect("a state")[0] - runge_kutta?.expect("a state")[0];
    /// assert!(difference.abs() < 1e-9);
    /// # Ok::<(), lindstedt::system::SystemError>(())
    /// ```
    pub fn solve(
        &self,
        start: f64,
        values: &[f64],
        end: f64,
        events: &[Event],
        options: &SystemOptions,
    ) -> Result<Path, SystemError> {
        self.check(start, values, end, options)?;
        match options.integrator {
            Integrator::Taylor => {
                let expansion = taylor::expansion(self, events, options.tolerance)?;
                taylor::follow(TaylorRun::new(
                    self,
                    [start, end],
                    values,
                    events,
                    options,
                    expansion,
                ))
            }
            Integrator::RungeKutta => {
                runge_kutta::follow(self, [start, end], values, events, options)
            }
        }
    }

    /// This system ready to be followed many times with these events.
    pub fn solver(self, events: &[Event], options: &SystemOptions) -> Solver {
        // A tolerance out of range has no order; the runs refuse it.
        let has_order = TOLERANCES.contains(&options.tolerance);
        let expansion = match options.integrator {
            Integrator::Taylor if has_order => {
                Some(taylor::expansion(&self, events, options.tolerance))
            }
            Integrator::Taylor | Integrator::RungeKutta => None,
        };
        Solver { system: self, events: events.to_vec(), options: *options, expansion }
    }

    /// Whether it can be followed from these values between these times.
    fn check(
        &self,
        start: f64,
        values: &[f64],
        end: f64,
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

/// A corner whose argument jumps at another corner: which side it is on after the jump does not
/// follow from where it was.
fn jump_in_corner(expression: &Expr) -> Option<Expr> {
    use Function::{Absolute, Maximum, Minimum, Sign, Step};
    let jumps = |part: &Expr| part.contains_function(Step) || part.contains_function(Sign);
    let is_corner = |part: &&Expr| match part.node() {
        Node::Function(function, _) => [Absolute, Maximum, Minimum, Sign, Step].contains(function),
        _ => false,
    };
    let mut corners = expression.unique_nodes().filter(is_corner);
    corners.find(|corner| corner.children().any(jumps)).cloned()
}
