//! The motion across a jump of the force with the velocity, such as dry friction, and its variation.
//!
//! ```text
//! h = x' - c,   f = f+ where h > 0, f- where h < 0,   a = -f        crossing:  a+ and a- have one sign
//! dx, dx' behind a crossing = S (dx, dx'),   S = 1 + (y'_behind - y'_before) n^T/(n^T y'_before) = [1 0; 0 a_behind/a_before]
//! sticking: a+ <= 0 <= a-,   x' = c,   until a+ > 0 or a- < 0,      S = [1 0; 0 0] where it begins, 1 where it ends
//! ```
//!
//! S is the saltation matrix (R. I. Leine and H. Nijmeijer, *Dynamics and Bifurcations of Non-Smooth Mechanical Systems*, Springer 2004,
//! chapter 7; M. di Bernardo, C. J. Budd, A. R. Champneys and P. Kowalczyk, *Piecewise-smooth Dynamical Systems*, Springer 2008, chapter
//! 2). In: a start. Out: the motion leg by leg, each on one side of the jump or sticking, the ends of the legs located as events, and
//! M(t). Of a force without such a jump it is one leg.

use super::driven::Driven;
use crate::numeric::ode::{Action, Event, Options, Point, StopReason, Trajectory, integrate_first_order};

/// Position, velocity and the two columns of M at a time.
type Values = [f64; 6];

/// A motion with its variations.
#[derive(Clone, Debug)]
pub struct Course {
    legs: Vec<Trajectory<Point<Values>>>,
    /// Position, velocity and the two columns of M where it ends.
    pub end: [f64; 6],
}

/// Where the velocity is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Mode {
    /// Above the jump, 1, or below it, -1.
    Side(f64),
    /// On it.
    Sticking,
}

impl Course {
    /// Positions at equal steps of the duration, its end left out.
    pub fn positions(&self, count: usize) -> Vec<f64> {
        let from = self.legs.first().map_or(0.0, |leg| leg.start().t);
        let to = self.legs.last().map_or(0.0, |leg| leg.end().t);
        let time = |index: usize| from + index as f64 / count as f64 * (to - from);
        let mut leg = 0;
        let at = |index: usize| {
            while leg + 1 < self.legs.len() && time(index) >= self.legs[leg].end().t {
                leg += 1;
            }
            self.legs.get(leg)?.state_at(time(index))
        };
        (0..count).filter_map(at).map(|point| point.y[0]).collect()
    }

    /// Evaluations of the force.
    pub fn evaluations(&self) -> usize {
        self.legs.iter().map(Trajectory::evaluations).sum()
    }
}

/// The motion from a start at phase zero for a duration; nothing where it cannot be followed.
pub fn follow(driven: &Driven, start: [f64; 2], parameter: f64, duration: f64, options: &Options) -> Option<Course> {
    /// Legs of a period: beyond them it does not come to an end.
    const MOST: usize = 400;
    let begin = [start[0], start[1], 1.0, 0.0, 0.0, 1.0];
    let Some(speed) = driven.jump_speed(parameter) else {
        let path = on_side(driven, parameter, 0.0, (0.0, begin), duration, &[], options)?;
        let end = path.end().y;
        return Some(Course { legs: vec![path], end });
    };
    let omega = driven.frequency_at(parameter);
    // On the jump, as it is on either side.
    let acceleration = |t: f64, x: f64, side: f64| -driven.force_on(&[x, speed, omega * t, parameter], side);
    let mut mode = match start[1] - speed {
        above if above > 0.0 => Mode::Side(1.0),
        below if below < 0.0 => Mode::Side(-1.0),
        _ if acceleration(0.0, start[0], 1.0) > 0.0 => Mode::Side(1.0),
        _ if acceleration(0.0, start[0], -1.0) < 0.0 => Mode::Side(-1.0),
        _ => Mode::Sticking,
    };
    let (mut t, mut y) = (0.0, begin);
    let mut legs = Vec::new();
    for _ in 0..MOST {
        let path = match mode {
            Mode::Side(side) => {
                let reached = Event::new(move |point: &Point<Values>| side * (point.y[1] - speed), Action::Stop);
                on_side(driven, parameter, side, (t, y), duration, &[reached.falling()], options)?
            }
            Mode::Sticking => {
                (y[1], y[3], y[5]) = (speed, 0.0, 0.0);
                let leaves = [1.0, -1.0].map(|side| {
                    let pushed = move |point: &Point<Values>| side * acceleration(point.t, point.y[0], side);
                    Event::new(pushed, Action::Stop).rising()
                });
                // Nothing but the drive changes: a step sees all of it.
                let options = Options {
                    maximum_step: 0.05 * std::f64::consts::TAU / omega / driven.periods as f64,
                    ..*options
                };
                let rates = |_: f64, _: &Values, rates: &mut Values| *rates = [speed, 0.0, 0.0, 0.0, 0.0, 0.0];
                let path = integrate_first_order(rates, Point { t, y }, duration, &leaves, &options).ok()?;
                path.is_complete().then_some(path)?
            }
        };
        let (reason, last) = (path.stop_reason(), path.end());
        (t, y) = (last.t, last.y);
        legs.push(path);
        let StopReason::Event { event, .. } = reason else {
            return Some(Course { legs, end: y });
        };
        y[1] = speed;
        mode = match mode {
            Mode::Sticking => Mode::Side(if event == 0 { 1.0 } else { -1.0 }),
            Mode::Side(side) => {
                let (before, behind) = (acceleration(t, y[0], side), acceleration(t, y[0], -side));
                if side * behind < 0.0 {
                    (y[3], y[5]) = (y[3] * behind / before, y[5] * behind / before);
                    Mode::Side(-side)
                } else {
                    Mode::Sticking
                }
            }
        };
        if t >= duration {
            if mode == Mode::Sticking {
                (y[3], y[5]) = (0.0, 0.0);
            }
            return Some(Course { legs, end: y });
        }
    }
    None
}

/// A leg on one side of the jump.
fn on_side(
    driven: &Driven,
    parameter: f64,
    side: f64,
    (t, y): (f64, Values),
    until: f64,
    events: &[Event<Point<Values>>],
    options: &Options,
) -> Option<Trajectory<Point<Values>>> {
    let omega = driven.frequency_at(parameter);
    let rates = |t: f64, y: &Values, rates: &mut Values| {
        let at = [y[0], y[1], omega * t, parameter];
        let [by_position, by_velocity, _] = driven.slopes_on(&at, side);
        *rates = [
            y[1],
            -driven.force_on(&at, side),
            y[3],
            -by_position * y[2] - by_velocity * y[3],
            y[5],
            -by_position * y[4] - by_velocity * y[5],
        ];
    };
    let path = integrate_first_order(rates, Point { t, y }, until, events, options).ok()?;
    path.is_complete().then_some(path)
}
