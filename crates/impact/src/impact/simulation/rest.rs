//! The rest time: the time at which the envelope of the amplitude falls to a tenth of the first
//! swing.
//!
//! ```text
//! first swing:  A_0 of the energy at the start, E = 1 - cos A_0, half a turn where it turns over
//! envelope:     (0, A_0) and the turning points (t_i, |x_i|) on the side without a barrier, joined by straight lines of
//!               log|x|; without a barrier, or with two, the larger of every two successive ones
//! rest:         envelope = A_0/10, the last time it falls there
//! last crossing: the last time |x| = A_0/10
//! ```
//!
//! Here x is counted from the place of rest (`place`), which is not 0 if a barrier holds the
//! pendulum above the bottom, or if it has turned over; A_0 is reduced by its height above the
//! bottom.
//!
//! If the line to the next turning point reaches the level before the motion itself does, as when
//! one swing takes nearly everything, or just after a turning point, the rest time is that of the
//! fall of |x| from the turning point: the later of the two, so that it does not jump. A creeping
//! motion has only the latter.
//!
//! A barrier turns the motion early on its side: its turning points there depend on the position of
//! the barrier and not on the swing. On the other side every swing shows its whole energy, impacts
//! or not, so the rest time is continuous in the parameters wherever the motion is, but for one
//! case: beside one barrier, where dry friction just holds the pendulum at a turning point on the
//! barrier's side, the next one on the other side, half a swing later, is missing, and the line
//! ends sooner.
//!
//! The last crossing is a staircase: it jumps by half a swing when one more crest stays below the
//! level. A crossing counts only once the turning point after it has been reached; a run that ends
//! before has no rest time.

use std::f64::consts::{PI, TAU};

use thiserror::Error;

use super::place::RestPoint;
use super::{Integrator, Simulation, SimulationStop, TurningPoint};
use crate::impact::model::{Model, Side, Start};
use crate::impact::polynomial::crossing_of;

/// The part of the first amplitude that counts as rest.
pub const REST_FRACTION: f64 = 0.1;

/// The rest time and the quantities from which it was determined.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rest {
    /// The amplitude of the first swing, rad.
    pub amplitude: f64,
    /// The place of rest from which amplitudes are counted, rad: 0, unless a barrier holds the
    /// pendulum elsewhere or it has turned over.
    pub place: f64,
    /// The time at which the envelope falls to a tenth of it.
    pub time: Result<f64, NoRest>,
    /// The last time at which the pendulum was a tenth of the first amplitude away from the place
    /// of rest; `None` if it never was.
    pub last_crossing: Option<f64>,
}

/// The reason why there is no rest time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum NoRest {
    /// The motion has not become small enough.
    #[error("the amplitude stays above 10 % of the first swing until the end of the run")]
    StaysAbove,
    /// The motion has become small enough in the last swing, but the time is not known before the
    /// next turning point.
    #[error("the run ends before the turning point that would show it: a longer duration will")]
    NotYetSeen,
    /// There is no initial amplitude.
    #[error(
        "the motion starts at its place of rest without speed: it has no amplitude that could decay"
    )]
    NoAmplitude,
    /// The run broke off.
    #[error("the run ended before it could be seen")]
    BrokeOff,
}

/// The information of the turning points about the rest.
#[derive(Debug, Clone, Copy, PartialEq)]
enum RestByTurningPoints {
    /// The envelope goes through the level between these two.
    Line { above: TurningPoint, below: TurningPoint },
    /// A creeping motion from here on.
    Fall(TurningPoint),
}

impl Simulation {
    /// The time at which the motion came to rest.
    pub fn rest(&self) -> Rest {
        let amplitude = self.first_swing();
        let place = self.rest_point().x;
        let level = REST_FRACTION * amplitude;
        if amplitude == 0.0 {
            return Rest { amplitude, place, time: Err(NoRest::NoAmplitude), last_crossing: None };
        }
        let last_crossing = self.last_crossing(level);
        let time = match self.rest_by_turns(level) {
            Err(_) if !self.stop.is_complete() => Err(NoRest::BrokeOff),
            Err(reason) => Err(reason),
            Ok(RestByTurningPoints::Line { above, below }) => {
                let time = between(above, below, level);
                Ok(match may_be_late(above, below, level) {
                    true => self.time_of_fall(above, level).map_or(time, |fall| time.max(fall)),
                    false => time,
                })
            }
            Ok(RestByTurningPoints::Fall(from)) => {
                self.time_of_fall(from, level).ok_or(NoRest::NotYetSeen)
            }
        };
        Rest { amplitude, place, time, last_crossing }
    }

    /// The amplitude of a swing with the energy of the start, so that it does not depend on the
    /// phase of the first swing at the start.
    fn first_swing(&self) -> f64 {
        first_swing(&self.model, self.start)
    }

    /// The rest position at which the motion settles.
    pub(super) fn rest_point(&self) -> RestPoint {
        RestPoint::near(&self.model, self.end_x)
    }

    /// The points of the envelope of the amplitude in order, the first swing at the start: (t, |x|)
    /// are what is joined by straight lines of log|x|, with x counted from the place of rest.
    pub fn envelope(&self) -> Vec<TurningPoint> {
        let mut envelope = Vec::with_capacity(self.turns.len() + 2);
        self.each_of_envelope(|turn| envelope.push(turn));
        envelope
    }

    /// Goes through the points of the envelope in order, those that are known to belong to it.
    fn each_of_envelope(&self, mut visit: impl FnMut(TurningPoint)) {
        let mut newest = TurningPoint { t: 0.0, x: self.first_swing() };
        visit(newest);
        let place = self.rest_point();
        let free = place.free_side(&self.model);
        let counted = |turn: &TurningPoint| TurningPoint { t: turn.t, x: turn.x - place.x };
        // The direction of approach tells the side of a turning point; a moment of rest without
        // motion before it, as under friction, is on the side of the last one.
        let mut before = self.start.x;
        let mut side = None;
        let mut last: Option<TurningPoint> = None;
        for &turn in &self.turns {
            match turn.x - before {
                rise if rise > 0.0 => side = Some(Side::Right),
                rise if rise < 0.0 => side = Some(Side::Left),
                _ => {}
            }
            before = turn.x;
            if turn.t <= 0.0 {
                continue;
            }
            let turn = counted(&turn);
            match free {
                Some(_) if side == free => visit(turn),
                Some(_) => {}
                None => {
                    let larger = last.map(|last| match turn.x.abs() > last.x.abs() {
                        true => turn,
                        false => last,
                    });
                    if let Some(larger) = larger.filter(|larger| newest != *larger) {
                        newest = larger;
                        visit(larger);
                    }
                    last = Some(turn);
                }
            }
        }
        // A pendulum that is held by friction to the end, or has fallen to the rest energy, will
        // not have a larger amplitude again.
        let held = self.model.sticks()
            && self.end_velocity == 0.0
            && self.turns.last().is_some_and(|turn| turn.x == self.end_x);
        if held {
            // The beginning of the hold counts, not the end of the run, on which the rest time must
            // not depend.
            let at_rest = self.turns.iter().rev().take_while(|turn| turn.x == self.end_x);
            at_rest.last().map(counted).into_iter().for_each(&mut visit);
        } else if self.stop == SimulationStop::RestEnergy {
            visit(TurningPoint { t: self.end_time, x: self.last_swing() });
        }
    }

    /// The amplitude of a swing with the energy of the end.
    fn last_swing(&self) -> f64 {
        let swing =
            swing_of(self.model.energy(self.end_x, self.end_velocity)).unwrap_or(f64::INFINITY);
        (swing - self.rest_point().height()).max(0.0)
    }

    /// Determines the rest from the turning points.
    fn rest_by_turns(&self, level: f64) -> Result<RestByTurningPoints, NoRest> {
        let (mut above, mut below) = (None, None);
        self.each_of_envelope(|turn| match turn.x.abs() > level {
            true => (above, below) = (Some(turn), None),
            false => below = below.or(Some(turn)),
        });
        match (above, below) {
            (None, _) => Err(NoRest::StaysAbove),
            (Some(above), Some(below)) => Ok(RestByTurningPoints::Line { above, below }),
            (Some(above), None) => self.creeping(above, level),
        }
    }

    /// Decides the case without a turning point of the envelope after `above`: a motion that has
    /// not turned for a whole period of the linear swing creeps, and is its own envelope; any other
    /// has to be followed further.
    fn creeping(&self, above: TurningPoint, level: f64) -> Result<RestByTurningPoints, NoRest> {
        if self.model.beta != 0.0 || self.last_swing() > level {
            return Err(NoRest::StaysAbove);
        }
        let place = self.rest_point().x;
        let last =
            self.turns.last().map_or(above, |last| TurningPoint { t: last.t, x: last.x - place });
        if self.end_time - last.t <= TAU {
            return Err(NoRest::NotYetSeen);
        }
        Ok(match last.x.abs() > level {
            true => RestByTurningPoints::Fall(last),
            false => RestByTurningPoints::Line { above, below: last },
        })
    }

    /// The turning point from which the fall to a tenth is needed but not given by a path: because
    /// none is kept, or because it is that of a chain, whose formulas are approximate between
    /// turning points. `None` if it is not needed.
    pub(in crate::impact) fn untold_fall(&self) -> Option<TurningPoint> {
        let level = REST_FRACTION * self.first_swing();
        if level == 0.0 || self.path_tells_the_fall() || !self.stop.is_complete() {
            return None;
        }
        let from = match self.rest_by_turns(level).ok()? {
            RestByTurningPoints::Line { above, below } => {
                may_be_late(above, below, level).then_some(above)?
            }
            RestByTurningPoints::Fall(from) => from,
        };
        Some(TurningPoint { t: from.t, x: from.x + self.rest_point().x })
    }

    fn path_tells_the_fall(&self) -> bool {
        self.integrator != Integrator::Chain && !self.path.pieces().is_empty()
    }

    /// The time at which |x| has fallen to the level on the way from a turning point, or the start,
    /// to the next, all counted from the place of rest.
    pub(in crate::impact) fn time_of_fall(&self, from: TurningPoint, level: f64) -> Option<f64> {
        if !self.path_tells_the_fall() {
            return self.fall;
        }
        let place = self.rest_point().x;
        let begins = if from.t > 0.0 { from.x } else { self.start.x - place };
        let next = self.turns.iter().find(|turn| turn.t > from.t);
        let until = next.map_or(self.end_time, |turn| turn.t);
        let edge = place + level.copysign(begins);
        let excess = |t: f64| self.path.phase_point_at(t).map_or(0.0, |(x, _)| x - edge);
        let falls = begins.abs() > level && excess(until) * begins < 0.0;
        falls.then(|| crossing_of(excess, from.t, until))
    }

    /// Between turning points x only rises or only falls: the last stretch that begins beyond the
    /// level holds the crossing, unless the run ends beyond it.
    fn last_crossing(&self, level: f64) -> Option<f64> {
        let place = self.rest_point().x;
        let beyond = |x: f64| (x - place).abs() > level;
        if self.path.pieces().is_empty() || beyond(self.end_x) {
            return None;
        }
        let start = TurningPoint { t: 0.0, x: self.start.x };
        let end = TurningPoint { t: self.end_time, x: self.end_x };
        let index = self.turns.iter().rposition(|turn| beyond(turn.x));
        let from = match index {
            Some(index) => self.turns[index],
            None if beyond(start.x) => start,
            None => return None,
        };
        let to = index
            .map_or(self.turns.first(), |index| self.turns.get(index + 1))
            .copied()
            .unwrap_or(end);
        let edge = place + level.copysign(from.x - place);
        let excess = |t: f64| self.path.phase_point_at(t).map_or(0.0, |(x, _)| x - edge);
        Some(crossing_of(excess, from.t, to.t))
    }
}

/// The amplitude, rad, of a swing with the energy of the start, counted from the place at which it
/// would settle if it did not turn over.
pub(in crate::impact) fn first_swing(model: &Model, start: Start) -> f64 {
    let Start { x, velocity } = start;
    let place = RestPoint::near(model, x);
    match velocity == 0.0 && model.depth(x).is_none() {
        true => (x - place.x).abs(),
        false => (swing_of(model.energy(x, velocity)).unwrap_or(PI) - place.height()).max(0.0),
    }
}

/// Whether the turning points show that the envelope is below this level, where nothing can raise
/// it again.
pub(in crate::impact) fn has_rested(model: &Model, turns: &[TurningPoint], level: f64) -> bool {
    if model.beta != 0.0 {
        return false;
    }
    let Some(last) = turns.last() else {
        return false;
    };
    // The usual case at once.
    if last.x.abs() > level && RestPoint::is_first_bottom(model, last.x) {
        return false;
    }
    let place = RestPoint::near(model, last.x);
    let small = |turn: &TurningPoint| (turn.x - place.x).abs() <= level;
    if !small(last) {
        return false;
    }
    // On the free side, not in the barrier.
    let free = |side: Side| {
        let from_barrier =
            model.barrier(side.opposite()).map(|barrier| side.sign() * (last.x - barrier));
        side.sign() * (last.x - place.x) > 0.0 && from_barrier.is_none_or(|distance| distance > 0.0)
    };
    match (place.free_side(model), turns) {
        (Some(side), _) => free(side),
        (None, [.., before, _]) => small(before),
        _ => false,
    }
}

/// The amplitude of the swing with this energy, `1 - cos A = E`, in units of m g L; `None` if it
/// turns over.
fn swing_of(energy: f64) -> Option<f64> {
    (energy < 2.0).then(|| 2.0 * (0.5 * energy.max(0.0)).sqrt().asin())
}

/// Whether the motion may still be beyond the level where the straight line of log|x| between two
/// turning points is at it: if it cannot be, the fall is not needed.
///
/// The linear swing of amplitude a takes acos(level/a) to the level. If a turning point is at least
/// half as far out as the one before, a is twice the level at most: the swing of the pendulum is
/// longer by a fortieth there, and damping, viscous or dry, makes it longer by a fifth.
fn may_be_late(above: TurningPoint, below: TurningPoint, level: f64) -> bool {
    let halves = 2.0 * below.x.abs() < above.x.abs();
    halves || between(above, below, level) - above.t < LONGEST_FALL * (level / above.x.abs()).acos()
}

/// The longest fall from a turning point that is followed by one at least half as far out, relative
/// to that of the linear swing.
const LONGEST_FALL: f64 = 1.5;

/// The time at which the straight line of log|x| from one turning point to a later one passes the
/// level between them.
fn between(above: TurningPoint, below: TurningPoint, level: f64) -> f64 {
    // Friction may hold the pendulum at zero, which has no logarithm.
    let height = |turn: TurningPoint| turn.x.abs().max(1e-12 * level).ln();
    let fraction = (level.ln() - height(above)) / (height(below) - height(above));
    above.t + fraction * (below.t - above.t)
}
