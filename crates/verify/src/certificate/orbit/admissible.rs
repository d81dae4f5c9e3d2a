//! Proof that an orbit touches no wall between its impacts.
//!
//! A flight is halved until each part is settled: the gap is positive on all of it; or it begins at an
//! impact on this wall and the gap grows, from zero with the speed `e v`; or it ends at one and the gap falls,
//! to zero. On a part about m of half the length h the gap is `y(m) +- h max|y'|` and its rate `y'(m) +- h
//! max|y''|`.
//!
//! Source: R. E. Moore: Interval Analysis, Prentice-Hall (1966), for the mean value form.

use super::equations::{Angle, Flight, GapEquations, ImpactBalls};
use super::flow::{Propagator, State, negative, product};
use super::{OrbitNotProved, is_positive};
use crate::certificate::fourier_series::WORKING;
use crate::exact::Integer;
use crate::exact::ball::Ball;
use crate::exact::bound::Bound;

/// The largest number of halvings of a flight.
const MOST_HALVINGS: u32 = 24;

/// The largest number of parts of a flight that are looked at.
const MOST_PARTS: usize = 20_000;

/// Halvings of a flight before any part of it is looked at.
const FIRST: u32 = 4;

/// A part of a flight, `index` in units of `2^-halvings` of it.
#[derive(Clone, Copy)]
struct Part {
    halvings: u32,
    index: u64,
}

impl Part {
    fn begins(self) -> bool {
        self.index == 0
    }

    fn ends(self) -> bool {
        self.index + 1 == 1 << self.halvings
    }

    fn halves(self) -> [Self; 2] {
        [0, 1].map(|half| Self { halvings: self.halvings + 1, index: 2 * self.index + half })
    }

    /// Its middle and half of its length, of a flight of the length one.
    fn middle_and_half(self) -> [Ball; 2] {
        let places = self.halvings as usize + 1;
        [2 * self.index + 1, 1].map(|units| WORKING.dyadic(&Integer::from(units), places))
    }
}

/// Proves that all gaps are positive throughout a flight, but at its ends that of the wall there.
///
/// # Errors
/// [`OrbitNotProved::Touches`] with the place where that is not proved.
pub(super) fn stays_off_walls(
    equations: &GapEquations,
    impacts: &[ImpactBalls],
    flight: &Flight,
) -> Result<(), OrbitNotProved> {
    let [from, _] = flight.ends;
    let start = &impacts[from];
    let digits = || OrbitNotProved::Digits;
    let angle = Angle::new(&start.phase).ok_or_else(digits)?;
    let speed = equations.by_phase(&start.speed).ok_or_else(digits)?;
    let of_flight = OfFlight { equations, impacts, flight, angle, speed };
    let mut parts: Vec<Part> =
        (0..1 << FIRST).rev().map(|index| Part { halvings: FIRST, index }).collect();
    let mut seen = 0;
    while let Some(part) = parts.pop() {
        seen += 1;
        match of_flight.wall_not_proved(part).ok_or_else(digits)? {
            None => {}
            Some(_) if part.halvings < MOST_HALVINGS && seen < MOST_PARTS => {
                let [first, second] = part.halves();
                parts.extend([second, first]);
            }
            Some(wall) => {
                let [middle, _] = part.middle_and_half();
                let after = product(&middle, &flight.duration);
                let phase = WORKING.nearest(&WORKING.sum(&start.phase, &after));
                return Err(OrbitNotProved::Touches { wall, phase });
            }
        }
    }
    Ok(())
}

/// A flight with what all its parts share.
struct OfFlight<'a> {
    equations: &'a GapEquations,
    impacts: &'a [ImpactBalls],
    flight: &'a Flight,
    /// Angle and speed (a rate of the phase) of the first impact.
    angle: Angle,
    speed: Ball,
}

impl OfFlight<'_> {
    /// The wall whose gap is not proved to be positive on a part; `Some(None)` if there is none, `None`
    /// if the numbers are too large.
    fn wall_not_proved(&self, part: Part) -> Option<Option<usize>> {
        let [middle, half] =
            part.middle_and_half().map(|length| product(&length, &self.flight.duration));
        let whole = Ball { radius: middle.radius + WORKING.magnitude(&half), ..middle.clone() };
        let motions = [&middle, &whole].map(|time| {
            let turned = Angle::new(time)?;
            Some((self.angle.later(&turned), self.equations.flow.over(time)?))
        });
        let [Some(at_middle), Some(on_whole)] = motions else { return None };
        let wall = &self.impacts[self.flight.ends[0]].wall;
        let end = self.impacts[self.flight.ends[1]].wall;
        let gap = |seen: usize, (angle, propagator): &(Angle, Propagator)| {
            self.equations.gap(*wall, seen, [&self.angle, angle], &self.speed, propagator)
        };
        let is_open = |seen: usize| {
            let wide = gap(seen, &on_whole);
            let second = self.equations.acceleration(seen, &on_whole.0, &wide);
            let [position, rate] =
                about_middle(&gap(seen, &at_middle), [&wide[1], &second], WORKING.magnitude(&half));
            let grows = match self.equations.walls[seen].is_dead {
                false => is_positive(&rate),
                // It leaves the wall from rest.
                true => is_positive(&second),
            };
            is_positive(&position)
                || part.begins() && seen == *wall && grows
                || part.ends() && seen == end && is_positive(&negative(&rate))
        };
        Some((0..self.equations.walls.len()).find(|seen| !is_open(*seen)))
    }
}

/// A gap and its rate on a part, from those in its middle and from their rates on all of it.
fn about_middle(middle: &State, rates: [&Ball; 2], half: Bound) -> State {
    [0, 1].map(|row| {
        let mut ball = middle[row].clone();
        ball.radius += half * WORKING.magnitude(rates[row]);
        ball
    })
}
