//! First-order equations `y' = F(t, y)` of any number, written as expressions and followed by their Taylor series.
//!
//! References: A. Jorba, M. Zou, *Experimental Mathematics* 14 (2005) 99 (order and step from the series); R. E. Moore, *Methods
//! and Applications of Interval Analysis*, SIAM 1979, section 3.4 (coefficients by recurrences along the expression).
//!
//! ```text
//! y(t + s) = sum_n y_n s^n,   (n + 1) y_(n+1) = F_n      F_n: coefficient of s^n along the expression, each part once
//! step: the largest h with |y_p| h^p <= tolerance * size of y on the step, for the last two orders p
//! event: g(t, y) = 0, found on the series of g itself, so that two crossings in one step are two
//! ```
//!
//! In: the names of the states, the name of time, one expression a state, numbers for everything else. Out: a [`Path`] that
//! answers every state at any time between, the events it met, and why it ended. Corners (`abs`, `sgn`, `H`, `max`, `min`) end a
//! step where their argument changes its sign and begin the next on the other side; a motion that sticks to a corner, as dry
//! friction makes it, is handed back up to there with its reason.
//!
//! ```
//! use lindstedt::expr::parse_expression;
//! use lindstedt::system::{Event, Options, System};
//!
//! // The pendulum from 1.5 rad at rest: its first passage through the vertical is a quarter of its period.
//! let right = [parse_expression("v")?, parse_expression("-sin(x)")?];
//! let pendulum = System::new(&["x".into(), "v".into()], "t".into(), &right, &Default::default())?;
//! let vertical = Event::stop(parse_expression("x")?);
//! let path = pendulum.follow(0.0, &[1.5, 0.0], 10.0, &[vertical], &Options::default())?;
//! let quarter_period = std::f64::consts::FRAC_PI_2 / 0.860_608_346_679_613;
//! assert!((path.end() - quarter_period).abs() < 1e-13);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod polynomial;
mod tape;

use std::collections::BTreeMap;

use crate::expr::Expr;
use crate::interrupt::Interrupt;
use crate::symbol::Symbol;

use polynomial::first_root;
use tape::Tape;

/// Equations ready to be followed.
#[derive(Clone, Debug)]
pub struct System {
    state: Vec<Symbol>,
    time: Symbol,
    right: Vec<Expr>,
    numbers: BTreeMap<Symbol, f64>,
}

/// Why there is no system, or no path from this start.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SystemError {
    /// As many expressions as states.
    #[error("{states} states need {states} right sides, not {right_sides}")]
    Length {
        /// The number of states, or of initial values.
        states: usize,
        /// The number of right sides.
        right_sides: usize,
    },
    /// A name without a value.
    #[error("`{0}` is neither a state nor a number")]
    Unknown(Symbol),
    /// A function of answers, without a recurrence.
    #[error("`{0}` cannot be part of a right side: it occurs in answers alone")]
    Function(&'static str),
    /// A right side has no finite value or no series at the start.
    #[error("the rate of `{0}` has no Taylor series at the start")]
    Start(Symbol),
    /// A start, an end or a tolerance that is no finite number, or an end before the start.
    #[error("start and end must be finite, the end after the start, the tolerance between 1e-16 and 0.1")]
    Bounds,
}

/// How closely and how long to follow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Error of a step, relative to the size of each state on it.
    pub tolerance: f64,
    /// Steps after which the run ends.
    pub step_limit: usize,
    /// Who may ask the run to stop where it is.
    pub interrupt: Interrupt,
}

impl Default for Options {
    /// Rounding accuracy, 100 000 steps.
    fn default() -> Self {
        Self {
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
}

impl Event {
    /// An event that is only listed.
    pub fn record(expression: Expr) -> Self {
        Self {
            expression,
            stops: false,
        }
    }

    /// An event that ends the path.
    pub fn stop(expression: Expr) -> Self {
        Self {
            expression,
            stops: true,
        }
    }
}

/// An event that happened.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Occurrence {
    /// Which of the events.
    pub event: usize,
    /// When.
    pub time: f64,
    /// Whether its expression grew through zero.
    pub rising: bool,
}

/// Why a path ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// At the time asked for.
    Reached,
    /// At this event.
    Event(usize),
    /// After as many steps as were allowed.
    StepLimit,
    /// The series of a state does not converge any more: a pole, or a root at zero.
    Singular,
    /// It stays on a corner: the rates on both sides lead back to it.
    Sticks,
    /// Somebody asked for it.
    Interrupted,
}

/// One step: the Taylor polynomials of all states about its beginning.
#[derive(Clone, Debug)]
struct Step {
    start: f64,
    length: f64,
    /// State by state, the coefficients of `s^0, s^1, ...`.
    coefficients: Vec<f64>,
}

/// The states from the start to the end.
#[derive(Clone, Debug)]
pub struct Path {
    size: usize,
    steps: Vec<Step>,
    end: f64,
    reason: End,
    occurrences: Vec<Occurrence>,
}

impl Path {
    /// The time at which it ends.
    pub fn end(&self) -> f64 {
        self.end
    }

    /// Why it ends there.
    pub fn reason(&self) -> End {
        self.reason
    }

    /// The events met, in order.
    pub fn occurrences(&self) -> &[Occurrence] {
        &self.occurrences
    }

    /// The number of steps.
    pub fn step_count(&self) -> usize {
        self.steps.len()
    }

    /// All states at a time; `None` outside the path.
    pub fn at(&self, time: f64) -> Option<Vec<f64>> {
        let first = self.steps.first()?;
        if !(time >= first.start && time <= self.end) {
            return None;
        }
        let after = self.steps.partition_point(|step| step.start <= time);
        let step = &self.steps[after.max(1) - 1];
        let order = step.coefficients.len() / self.size;
        let polynomials = step.coefficients.chunks(order);
        Some(
            polynomials
                .map(|series| polynomial::value(series, time - step.start))
                .collect(),
        )
    }
}

impl System {
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
            return Err(SystemError::Length {
                states: state.len(),
                right_sides: right.len(),
            });
        }
        let system = Self {
            state: state.to_vec(),
            time,
            right: right.to_vec(),
            numbers: numbers.clone(),
        };
        system.tape(&[], 1).map(|_| system)
    }

    fn tape(&self, events: &[Event], order: usize) -> Result<Tape, SystemError> {
        let mut tape = Tape::new(&self.state, self.time, &self.numbers, order);
        for right in &self.right {
            tape.add(right)?;
        }
        for event in events {
            tape.add(&event.expression)?;
        }
        Ok(tape)
    }

    /// Follows the states from `start` until `end`, or to the first event that stops. Costs, for each step of order p, p^2
    /// operations a product or function of the right sides.
    ///
    /// # Errors
    /// [`SystemError`] where the run cannot begin; one that ends early says so by [`Path::reason`].
    pub fn follow(
        &self,
        start: f64,
        values: &[f64],
        end: f64,
        events: &[Event],
        options: &Options,
    ) -> Result<Path, SystemError> {
        let size = self.state.len();
        if values.len() != size {
            return Err(SystemError::Length {
                states: size,
                right_sides: values.len(),
            });
        }
        let finite = start.is_finite() && end.is_finite() && values.iter().all(|value| value.is_finite());
        if !finite || end < start || !(1e-16..=0.1).contains(&options.tolerance) {
            return Err(SystemError::Bounds);
        }
        // Jorba and Zou: the order that reaches the tolerance with the fewest operations.
        let order = (1.0 - 0.5 * options.tolerance.ln()).ceil() as usize + 1;
        let mut tape = self.tape(events, order)?;
        let (mut time, mut values) = (start, values.to_vec());
        let (mut steps, mut occurrences): (Vec<Step>, Vec<Occurrence>) = (vec![], vec![]);
        tape.begin(time, &values);
        let mut stuck = 0;
        let reason = loop {
            if time >= end {
                break End::Reached;
            }
            if steps.len() >= options.step_limit {
                break End::StepLimit;
            }
            if options.interrupt.is_requested() {
                break End::Interrupted;
            }
            if let Err(state) = tape.expand(time, &values) {
                if steps.is_empty() {
                    return Err(SystemError::Start(self.state[state]));
                }
                break End::Singular;
            }
            let mut length = tape.step(options.tolerance).min(end - time);
            if length.is_nan() || length <= 0.0 || time + length == time {
                break End::Singular;
            }
            // A corner within the step ends it.
            let corner = tape.first_corner(length);
            if let Some((_, place)) = corner {
                length = place;
            }
            let mut met: Vec<(usize, f64, bool)> = Vec::new();
            for event in 0..events.len() {
                let series = tape.output(size + event);
                let mut from = 0.0;
                while let Some((place, rising)) = first_root(series, from, length) {
                    met.push((event, place, rising));
                    from = place;
                }
            }
            met.sort_by(|one, other| one.1.total_cmp(&other.1));
            let stop = met.iter().position(|found| events[found.0].stops);
            let stop = stop.map(|index| {
                met.truncate(index + 1);
                (met[index].0, met[index].1)
            });
            if let Some((_, place)) = stop {
                length = place;
            }
            occurrences.extend(met.into_iter().map(|(event, place, rising)| Occurrence {
                event,
                time: time + place,
                rising,
            }));
            let coefficients: Vec<f64> = (0..size).flat_map(|state| tape.state(state).to_vec()).collect();
            for (value, series) in values.iter_mut().zip(coefficients.chunks(order + 1)) {
                *value = polynomial::value(series, length);
            }
            steps.push(Step {
                start: time,
                length,
                coefficients,
            });
            let last = time + length >= end && corner.is_none() && stop.is_none();
            let before = time;
            time = if last { end } else { time + length };
            if let Some((event, _)) = stop {
                break End::Event(event);
            }
            if let Some((corner, _)) = corner {
                tape.cross(corner);
                // Leaving a corner and being back at once, over and over, is to stay on it.
                const OFTEN: usize = 20;
                stuck = if time - before <= 1e-12 * (1.0 + time.abs()) {
                    stuck + 1
                } else {
                    0
                };
                if stuck > OFTEN {
                    break End::Sticks;
                }
            }
        };
        let end = steps.last().map_or(start, |step| step.start + step.length);
        Ok(Path {
            size,
            end: if reason == End::Reached { time } else { end },
            steps,
            reason,
            occurrences,
        })
    }
}
