//! When it comes to rest: the envelope of the amplitude and the time at which it falls to a tenth of the start.
//!
//! ```text
//! envelope: the turning points (t_i, |x_i|) that no later one exceeds, joined by straight lines of log|x|
//! rest:     envelope = |x(0)|/10;    last crossing: the last time |x| = |x(0)|/10
//! ```
//!
//! A barrier turns the motion early on its side, so only turning points that bound all that follows make an envelope.
//! The rest time is a smooth function of the parameters; the last crossing is a staircase, because it jumps by half a
//! swing when one more crest stays below the level.

use thiserror::Error;

use super::polynomial::crossing_of;
use super::{Simulation, Turn};

/// The part of the first amplitude that counts as rest.
pub const REST_FRACTION: f64 = 0.1;

/// Rest, and what it was measured by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rest {
    /// The amplitude at the start, rad.
    pub amplitude: f64,
    /// The time at which the envelope falls to a tenth of it.
    pub time: Result<f64, NoRest>,
    /// The last time at which |x| was a tenth of it; nothing where it never was.
    pub last_crossing: Option<f64>,
}

/// Why there is no rest time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum NoRest {
    /// The motion has not become small enough.
    #[error("the amplitude stays above 10 % of the start until the end of the run")]
    StaysAbove,
    /// There is no amplitude to begin with.
    #[error("the motion starts at x = 0 without speed: it has no amplitude that could decay")]
    NoAmplitude,
    /// The run broke off.
    #[error("the run ended before it could be seen")]
    BrokeOff,
}

impl Simulation {
    /// When it came to rest.
    pub fn rest(&self) -> Rest {
        let amplitude = self.first_amplitude();
        let level = REST_FRACTION * amplitude;
        if amplitude == 0.0 {
            return Rest {
                amplitude,
                time: Err(NoRest::NoAmplitude),
                last_crossing: None,
            };
        }
        let time = match self.envelope_crossing(level) {
            Some(time) => Ok(time),
            None if self.stop.is_complete() => Err(NoRest::StaysAbove),
            None => Err(NoRest::BrokeOff),
        };
        Rest {
            amplitude,
            time,
            last_crossing: self.last_crossing(level),
        }
    }

    /// |x| at the start; where it starts with speed, that of the first turning point if it is larger.
    fn first_amplitude(&self) -> f64 {
        let start = self.start.x.abs();
        match self.turns.first() {
            Some(turn) if self.start.velocity != 0.0 => start.max(turn.x.abs()),
            None if self.start.velocity != 0.0 => start.max(self.end_x.abs()),
            _ => start,
        }
    }

    fn envelope_crossing(&self, level: f64) -> Option<f64> {
        // Where the motion still was beyond the level, the envelope was too: the last such turning point and the next
        // that nothing later exceeds hold the crossing.
        let last = self.turns.iter().rposition(|turn| turn.x.abs() > level);
        let above = match last {
            Some(index) => self.turns[index],
            None => Turn {
                t: 0.0,
                x: self.start.x,
            },
        };
        let later = &self.turns[last.map_or(0, |index| index + 1)..];
        let below = later.iter().rev().fold(None, |best: Option<&Turn>, turn| match best {
            Some(best) if best.x.abs() > turn.x.abs() => Some(best),
            _ => Some(turn),
        })?;
        if above.x.abs() <= level {
            return Some(above.t);
        }
        // Friction may hold it at zero, whose logarithm is not to be had.
        let floor = 1e-12 * level;
        let height = |turn: &Turn| turn.x.abs().max(floor).ln();
        let fraction = (level.ln() - height(&above)) / (height(below) - height(&above));
        Some(above.t + fraction * (below.t - above.t))
    }

    /// Between turning points x only rises or only falls: the last stretch that begins beyond the level holds the
    /// crossing, unless the run ends beyond it.
    fn last_crossing(&self, level: f64) -> Option<f64> {
        if self.path.pieces().is_empty() || self.end_x.abs() > level {
            return None;
        }
        let start = Turn {
            t: 0.0,
            x: self.start.x,
        };
        let end = Turn {
            t: self.end_time,
            x: self.end_x,
        };
        let index = self.turns.iter().rposition(|turn| turn.x.abs() > level);
        let from = match index {
            Some(index) => self.turns[index],
            None if start.x.abs() > level => start,
            None => return None,
        };
        let to = index
            .map_or(self.turns.first(), |index| self.turns.get(index + 1))
            .copied()
            .unwrap_or(end);
        let edge = level.copysign(from.x);
        let excess = |t: f64| self.path.at(t).map_or(0.0, |(x, _)| x - edge);
        Some(crossing_of(excess, from.t, to.t))
    }
}
