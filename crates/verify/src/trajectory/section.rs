//! Poincare's section of a motion: its states once a period, or wherever an expression grows
//! through zero.
//!
//! Reference: A. H. Nayfeh and B. Balachandran, *Applied Nonlinear Dynamics*, Wiley 1995,
//! section 1.4 and chapter 7.
//!
//! ```text
//! t = T, 2 T, 3 T, ...                       of a motion that is driven with the period T
//! s(q, q', t) = 0,  ds/dt > 0                of any motion
//! s = 0 at the largest or the least s        touched, not crossed
//! just before each impact                    of any motion with walls
//! just before each event                     of any motion with events
//! ```
//!
//! A motion that turns back where s is zero touches the section and does not cross it, on whichever
//! side rounding leaves it there.

use super::{EventOccurrence, Trajectory, TrajectoryError, TrajectorySegment};
use crate::expr::Expr;
use crate::mechanics::Rates;
use crate::numeric::ode::root::find_root;
use crate::symbol::Symbol;
use crate::system::{Event, EventCrossing, rate_along};

/// The most states that one section holds.
pub const MOST_CROSSINGS: f64 = 1e6;

/// The condition for recording a point of the motion.
#[derive(Clone, Debug, PartialEq)]
pub enum PoincareSection {
    /// Once in this time, which may depend on the parameters: `2*pi/Omega`.
    Every(Expr),
    /// An expression that grows through zero: `x'`, `x - 0.1`.
    Rising(Expr),
    /// Just before each impact on a wall.
    Impacts,
    /// Just before each event.
    Events,
}

/// A state on a section.
#[derive(Clone, Debug, PartialEq)]
pub struct Crossing {
    /// The time.
    pub time: f64,
    /// Coordinates, then velocities.
    pub state: Vec<f64>,
}

impl PoincareSection {
    /// Its period, or the expression that grows through zero; `None` at impacts and events.
    pub fn expression(&self) -> Option<&Expr> {
        match self {
            Self::Every(expression) | Self::Rising(expression) => Some(expression),
            Self::Impacts | Self::Events => None,
        }
    }

    /// The events that the integrator locates: the zeros of the expression, and those of its rate,
    /// at which it may touch zero. A rate that cannot be written is left out.
    pub(super) fn events(&self, rates: &Rates) -> Vec<Event> {
        match self {
            Self::Every(_) | Self::Impacts | Self::Events => vec![],
            Self::Rising(expression) => {
                let rate = rate_along(expression, Symbol::new("t"), &rates.states, &rates.right);
                let rate = rate.filter(|rate| !rate.is_zero());
                let both = [Some(expression.clone()), rate].into_iter().flatten();
                both.map(Event::record).collect()
            }
        }
    }
}

/// Crossings and touches of the section.
#[derive(Clone, Debug, Default)]
pub(super) struct OnSection {
    pub(super) crossings: Vec<Crossing>,
    pub(super) touches: Vec<f64>,
}

impl Trajectory {
    /// The states on the section of the course from its time `after` on, in order; none without a
    /// section.
    ///
    /// ```
    /// # use lindstedt_verify as lindstedt;
    /// use lindstedt::Oscillator;
    /// use lindstedt::expr::parse_expression;
    /// use lindstedt::trajectory::{TrajectoryRequest, PoincareSection};
    ///
    /// let mut course = TrajectoryRequest::of_equation(&Oscillator::parse("x'' + x = 0")?);
    /// course.begin("x".into(), 1.0)?;
    /// course.section = Some(PoincareSection::Rising(parse_expression("x'")?));
    /// let turning: Vec<f64> = course.follow()?.crossings().iter().map(|crossing| crossing.time).collect();
    /// assert!((turning[2] - 5.0 * std::f64::consts::PI).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn crossings(&self) -> &[Crossing] {
        &self.on_section.crossings
    }

    /// The times from `after` on at which the motion turns back on its section, to a part in 1e9 of
    /// how far it goes: it touches the section there and does not cross it, so that there is no
    /// crossing.
    ///
    /// ```
    /// # use lindstedt_verify as lindstedt;
    /// use lindstedt::Oscillator;
    /// use lindstedt::expr::parse_expression;
    /// use lindstedt::trajectory::{TrajectoryRequest, PoincareSection};
    ///
    /// let mut course = TrajectoryRequest::of_equation(&Oscillator::parse("x'' + x = 0")?);
    /// course.begin("x".into(), 1.0)?;
    /// course.section = Some(PoincareSection::Rising(parse_expression("x - 1")?));
    /// let motion = course.follow()?;
    /// assert_eq!((motion.crossings().len(), motion.touches().len()), (0, 7));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn touches(&self) -> &[f64] {
        &self.on_section.touches
    }

    /// Finds both.
    pub(super) fn find_on_section(&self) -> Result<OnSection, TrajectoryError> {
        let course = &self.course;
        let in_time = |time: &f64| *time >= course.after;
        let mut touched: Vec<[f64; 3]> = Vec::new();
        let times: Vec<f64> = match &course.section {
            None => vec![],
            // A stretch ends with the state before its impact.
            Some(PoincareSection::Impacts) => {
                let mut times: Vec<f64> = self.walls.impacts.iter().map(|hit| hit.time).collect();
                times.dedup();
                times
            }
            // At the start no stretch ends with the state before an event.
            Some(PoincareSection::Events) => {
                let events = self.events.occurrences.iter().filter(|event| in_time(&event.time));
                let before = |event: &EventOccurrence| Crossing {
                    time: event.time,
                    state: event.before.clone(),
                };
                let mut crossings: Vec<Crossing> = events.map(before).collect();
                crossings.dedup_by(|next, first| next.time == first.time);
                return Ok(OnSection { crossings, touches: vec![] });
            }
            Some(PoincareSection::Rising(expression)) => {
                let met = self.pieces.iter().flat_map(|piece| {
                    let own = |occurrence: &&EventCrossing| occurrence.event < piece.recorded;
                    piece.path.occurrences().iter().filter(own)
                });
                let (crossed, turned): (Vec<&EventCrossing>, Vec<&EventCrossing>) =
                    met.partition(|occurrence| occurrence.event == 0);
                touched =
                    self.turns_on(expression, turned.into_iter().map(|turn| turn.time).collect());
                let touches = |time: f64| {
                    touched.iter().any(|[before, _, behind]| (*before..*behind).contains(&time))
                };
                let rising = crossed.into_iter().filter(|occurrence| occurrence.rising);
                rising.map(|occurrence| occurrence.time).filter(|time| !touches(*time)).collect()
            }
            Some(PoincareSection::Every(period)) => {
                let mut values = course.values.clone();
                values.remove(&Symbol::new("t"));
                let number = period.evaluate(&values).unwrap_or(f64::NAN);
                let count = (self.end() / number).floor();
                if !(number > 0.0 && count < MOST_CROSSINGS) {
                    return Err(TrajectoryError::Period(period.clone(), number));
                }
                (1..=count as u32).map(|index| number * f64::from(index)).collect()
            }
        };
        let sampled =
            self.sample(times.into_iter().filter(in_time).collect(), course.rates.states.len());
        let crossing =
            |(index, time): (usize, &f64)| Crossing { time: *time, state: sampled.row(index) };
        Ok(OnSection {
            crossings: sampled.times.iter().enumerate().map(crossing).collect(),
            touches: touched.into_iter().map(|[_, at, _]| at).filter(in_time).collect(),
        })
    }

    /// The extrema of an expression at which it is zero, to rounding, and not zero at the extrema
    /// before and behind, both on the same side; each between these two.
    fn turns_on(&self, expression: &Expr, turns: Vec<f64>) -> Vec<[f64; 3]> {
        /// Ratio to the largest value below which an extremum is a touch.
        const TOUCH: f64 = 1e-9;
        let Some(function) = self.compiled(expression) else {
            return vec![];
        };
        let times = [0.0].into_iter().chain(turns).chain([self.end()]).collect();
        let sampled = self.sample(times, self.course.rates.states.len());
        let height = |(index, time): (usize, &f64)| (*time, function(*time, &sampled.row(index)));
        let heights: Vec<(f64, f64)> = sampled
            .times
            .iter()
            .enumerate()
            .map(height)
            .filter(|(_, height)| height.is_finite())
            .collect();
        let largest = heights.iter().fold(0.0_f64, |most, (_, height)| most.max(height.abs()));
        let touch = |around: &[(f64, f64)]| {
            let [(before, one), (at, height), (behind, other)] = [around[0], around[1], around[2]];
            let away = |height: f64| height.abs() > TOUCH * largest;
            (!away(height) && away(one) && away(other) && one * other > 0.0)
                .then_some([before, at, behind])
        };
        heights.windows(3).filter_map(touch).collect()
    }

    /// The least and the greatest value of each coordinate from the time `after` of the course on.
    pub fn extremes(&self) -> Vec<[f64; 2]> {
        let (from, count) = (self.course.after.min(self.end()), self.course.coordinates.len());
        let mut ranges = self.earlier.clone();
        ranges.resize(count, [f64::INFINITY, f64::NEG_INFINITY]);
        for piece in self.pieces.iter().filter(|piece| piece.end() >= from) {
            piece.extend_ranges(&mut ranges, count, from);
        }
        ranges
    }
}

impl TrajectorySegment {
    /// Extends the ranges of the coordinates, of which there are so many, by their values from a time on.
    pub(super) fn extend_ranges(&self, ranges: &mut [[f64; 2]], count: usize, from: f64) {
        for (index, range) in ranges.iter_mut().enumerate() {
            let [least, greatest] = self.range([index, count + index], from.max(self.from));
            *range = [range[0].min(least), range[1].max(greatest)];
        }
    }

    /// The least and the greatest value of a coordinate from a time on, at both ends and where it turns.
    /// A coordinate without a series turns between two of many values with velocities of opposite signs.
    fn range(&self, [coordinate, velocity]: [usize; 2], from: f64) -> [f64; 2] {
        /// Number of values per step of the integrator.
        const VALUES: usize = 8;
        if !self.is_held()
            && let Some(range) = self.path.range(coordinate, from)
        {
            return range;
        }
        let state = |time: f64, index: usize| {
            self.states_at(time).and_then(|states| states.get(index).copied()).unwrap_or(f64::NAN)
        };
        let speed = |time: f64| state(time, velocity);
        let count = VALUES * self.path.step_count().max(1);
        let time = |index: usize| from + (self.end() - from) * index as f64 / count as f64;
        let mut turning = vec![from, self.end()];
        for index in 0..count {
            let [before, behind] = [time(index), time(index + 1)];
            if speed(before) * speed(behind) <= 0.0 {
                turning.extend(find_root(speed, before, behind));
            }
        }
        let values = turning.into_iter().map(|time| state(time, coordinate));
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, greatest], value| {
            [least.min(value), greatest.max(value)]
        })
    }
}
