//! Poincare's section of a motion: its states once a period, or wherever an expression grows through zero.
//!
//! Reference: A. H. Nayfeh and B. Balachandran, *Applied Nonlinear Dynamics*, Wiley 1995, section 1.4 and chapter 7.
//!
//! ```text
//! t = T, 2 T, 3 T, ...                       of a motion that is driven with the period T
//! s(q, q', t) = 0,  ds/dt > 0                of any motion
//! ```

use super::{Piece, Trajectory, TrajectoryError};
use crate::expr::Expr;
use crate::symbol::Symbol;
use crate::system::Event;

/// The most states that one section holds.
pub const MOST_CROSSINGS: f64 = 1e6;

/// Where a motion is looked at.
#[derive(Clone, Debug, PartialEq)]
pub enum Section {
    /// Once in this time, which may depend on the parameters: `2*pi/Omega`.
    Every(Expr),
    /// Where this grows through zero: `x'`, `x - 0.1`.
    Rising(Expr),
}

/// A state on a section.
#[derive(Clone, Debug, PartialEq)]
pub struct Crossing {
    /// When.
    pub time: f64,
    /// Coordinates, then velocities.
    pub state: Vec<f64>,
}

impl Section {
    /// The letters in it.
    pub fn expression(&self) -> &Expr {
        match self {
            Self::Every(expression) | Self::Rising(expression) => expression,
        }
    }

    /// What the integrator has to look out for.
    pub(super) fn events(&self) -> Vec<Event> {
        match self {
            Self::Every(_) => vec![],
            Self::Rising(expression) => vec![Event::record(expression.clone())],
        }
    }
}

impl Trajectory {
    /// The states on the section of the course from its time `after` on, in order; none without a section.
    ///
    /// ```
    /// use lindstedt::Oscillator;
    /// use lindstedt::expr::parse_expression;
    /// use lindstedt::trajectory::{Course, Section};
    ///
    /// let mut course = Course::of_equation(&Oscillator::parse("x'' + x = 0")?);
    /// course.begin("x".into(), 1.0)?;
    /// course.section = Some(Section::Rising(parse_expression("x'")?));
    /// let turning: Vec<f64> = course.follow()?.crossings().iter().map(|crossing| crossing.time).collect();
    /// assert!((turning[2] - 5.0 * std::f64::consts::PI).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn crossings(&self) -> &[Crossing] {
        &self.crossings
    }

    /// The same, found.
    pub(super) fn find_crossings(&self) -> Result<Vec<Crossing>, TrajectoryError> {
        let course = &self.course;
        let times: Vec<f64> = match &course.section {
            None => vec![],
            Some(Section::Rising(_)) => {
                let moving = self.pieces.iter().filter_map(|piece| match piece {
                    Piece::Moving(path) => Some(path.occurrences()),
                    Piece::Held { .. } => None,
                });
                let rising = moving.flatten().filter(|occurrence| occurrence.rising);
                rising.map(|occurrence| occurrence.time).collect()
            }
            Some(Section::Every(period)) => {
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
        let crossing = |time: f64| {
            Some(Crossing {
                time,
                state: self.at(time)?,
            })
        };
        Ok(times
            .into_iter()
            .filter(|time| *time >= course.after)
            .filter_map(crossing)
            .collect())
    }

    /// The least and the greatest value of each coordinate from the time `after` of the course on.
    pub fn extremes(&self) -> Vec<[f64; 2]> {
        /// Pieces of the motion in each of which a velocity changes its sign once.
        const PIECES: u32 = 4000;
        let count = self.course.coordinates.len();
        let (from, end) = (self.course.after.min(self.end()), self.end());
        let mut extremes = vec![[f64::INFINITY, f64::NEG_INFINITY]; count];
        let mut before: Option<(f64, Vec<f64>)> = None;
        for piece in 0..=PIECES {
            let time = from + (end - from) * f64::from(piece) / f64::from(PIECES);
            let Some(state) = self.at(time) else { continue };
            for (index, [least, greatest]) in extremes.iter_mut().enumerate() {
                let mut take = |value: f64| {
                    *least = least.min(value);
                    *greatest = greatest.max(value);
                };
                take(state[index]);
                // Between two signs of the velocity stands a turning point.
                if let Some((earlier, former)) = &before
                    && former[count + index] * state[count + index] < 0.0
                {
                    let velocity = |time: f64| self.at(time).map_or(f64::NAN, |state| state[count + index]);
                    let turning = crate::numeric::ode::root::find_root(velocity, *earlier, time).ok();
                    if let Some(state) = turning.and_then(|time| self.at(time)) {
                        take(state[index]);
                    }
                }
            }
            before = Some((time, state));
        }
        extremes
    }
}
