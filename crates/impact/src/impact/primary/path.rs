//! The states of both bodies at any time: flights in the time itself, contacts in the time s in
//! which they are analytic.

use super::super::model::Side;
use super::bounce::ClosedBounce;
use super::flight::{ClosedFlight, FlightStart};
use super::resting::RestingPendulum;
use crate::numeric::ode::root::{BisectionStop, try_bisect};
use crate::system::Path;

/// Angle and velocity of the pendulum, displacement and speed of the main mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrimaryState {
    /// x, rad.
    pub x: f64,
    /// x', in units of omega.
    pub velocity: f64,
    /// y, over L.
    pub y: f64,
    /// y', over L omega.
    pub speed: f64,
}

/// The states of a segment of the motion.
#[derive(Clone, Debug)]
pub(super) enum PrimarySegment {
    /// (x, x', y, y') in t.
    Flight(Path),
    /// (w, x', y, y', t) in s: x = place + side w^2.
    Contact { path: Path, side: Side, place: f64 },
    /// (y, y') in t: friction holds the pendulum here.
    Held { path: Path, x: f64 },
    /// A flight of a chain.
    ClosedFlight(Box<FlightStart>),
    /// A contact of a chain.
    ClosedBounce(ClosedBounce),
    /// A pendulum of a chain that friction holds or a barrier carries.
    Resting(RestingPendulum),
}

impl PrimarySegment {
    /// The state at a time within the piece.
    fn state_at(&self, time: f64) -> Option<PrimaryState> {
        match self {
            Self::Flight(path) => {
                let state = path.states_at(time.min(path.end()))?;
                Some(PrimaryState { x: state[0], velocity: state[1], y: state[2], speed: state[3] })
            }
            Self::Contact { path, side, place } => {
                let state = path.states_at(own_time(path, time)?)?;
                Some(PrimaryState {
                    x: place + side.sign() * state[0] * state[0],
                    velocity: state[1],
                    y: state[2],
                    speed: state[3],
                })
            }
            Self::Held { path, x } => {
                let state = path.states_at(time.min(path.end()))?;
                Some(PrimaryState { x: *x, velocity: 0.0, y: state[0], speed: state[1] })
            }
            Self::ClosedFlight(start) => {
                Some(ClosedFlight::new(start)?.point(time - start.begin).state)
            }
            Self::ClosedBounce(bounce) => Some(bounce.state_at(time)),
            Self::Resting(resting) => Some(resting.state_at(time)),
        }
    }
}

/// s at the time t, which is the last of the states and grows with s.
fn own_time(path: &Path, time: f64) -> Option<f64> {
    let clock = |s: f64| path.states_at(s).map(|state| state[4]);
    let end = path.end();
    if time >= clock(end)? {
        return Some(end);
    }
    let is_before = |s: f64| clock(s).map(|t| t < time).ok_or(());
    let [last, _] = try_bisect(is_before, 0.0, end, BisectionStop::Halvings(200)).ok()?;
    Some(last)
}

/// All pieces, in order.
#[derive(Clone, Debug, Default)]
pub(super) struct PrimaryPath {
    /// Each with the time at which it begins.
    pieces: Vec<(f64, PrimarySegment)>,
    end: f64,
    /// Whether the last piece alone is kept.
    keeps_last: bool,
}

impl PrimaryPath {
    /// A path that keeps its last piece alone, for who asks for the end of the motion only.
    pub(super) fn of_end() -> Self {
        Self { keeps_last: true, ..Self::default() }
    }

    pub(super) fn push(&mut self, start: f64, end: f64, piece: PrimarySegment) {
        if self.keeps_last {
            self.pieces.clear();
        }
        self.pieces.push((start, piece));
        self.end = end;
    }

    pub(super) fn state_at(&self, time: f64) -> Option<PrimaryState> {
        if !(0.0..=self.end).contains(&time) {
            return None;
        }
        let after = self.pieces.partition_point(|(start, _)| *start <= time);
        self.pieces.get(after.checked_sub(1)?)?.1.state_at(time)
    }

    /// The contacts that begin in this interval of time: their paths in s, and the sides of their
    /// barriers.
    pub(super) fn contacts(&self, [from, until]: [f64; 2]) -> impl Iterator<Item = (&Path, Side)> {
        let within = self.pieces.iter().filter(move |(start, _)| (from..=until).contains(start));
        within.filter_map(|(_, piece)| match piece {
            PrimarySegment::Contact { path, side, .. } => Some((path, *side)),
            _ => None,
        })
    }

    /// Whether the contact that begins at this time has a closed form.
    pub(super) fn is_closed_bounce(&self, time: f64) -> bool {
        let first = self.pieces.partition_point(|(start, _)| *start < time);
        let mut here = self.pieces[first..].iter().take_while(|(start, _)| *start == time);
        here.any(|(_, piece)| matches!(piece, PrimarySegment::ClosedBounce(_)))
    }

    pub(super) fn starts(&self) -> impl Iterator<Item = f64> {
        self.pieces.iter().map(|(start, _)| *start)
    }
}
