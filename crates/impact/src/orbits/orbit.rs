//! A periodic impact orbit.

use num_complex::Complex64;

use super::flow::WalledFlow;
use super::multipliers::OrbitStability;

/// The way an orbit was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OrbitKind {
    /// One impact in n periods, in closed form.
    OneImpact,
    /// One impact on each of two walls, the second half the mirror image of the first, in closed
    /// form.
    Symmetric,
    /// Several impacts, by Newton's method on the closed form between impacts.
    Searched,
}

impl OrbitKind {
    /// The name: `one-impact`, `symmetric` or `searched`.
    pub fn name(self) -> &'static str {
        match self {
            Self::OneImpact => "one-impact",
            Self::Symmetric => "symmetric",
            Self::Searched => "searched",
        }
    }
}

/// An impact of an orbit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrbitImpact {
    /// The index of the wall.
    pub wall: usize,
    /// The time, counted as in the equation; the first of an orbit lies in its first period of the
    /// drive.
    pub time: f64,
    /// The phase omega t of the drive, from 0 to 2 pi.
    pub phase: f64,
    /// The speed relative to the wall just before the impact.
    pub speed: f64,
}

impl OrbitImpact {
    pub(super) fn new(wall: usize, time: f64, speed: f64, frequency: f64) -> Self {
        Self { wall, time, phase: (frequency * time).rem_euclid(std::f64::consts::TAU), speed }
    }

    /// Position and velocity of the coordinate just after the impact.
    pub(super) fn state_after(&self, walled: &WalledFlow) -> [f64; 2] {
        let wall = &walled.walls[self.wall];
        let omega = walled.flow.frequency;
        let phase = omega * self.time;
        let rate = wall.restitution * self.speed;
        [
            -wall.side * wall.offset.value(phase),
            wall.side * (rate - omega * wall.offset.slope(phase)),
        ]
    }
}

/// The place where an orbit of the closed form is beyond a wall, so that no motion follows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Obstacle {
    /// The index of the wall.
    pub wall: usize,
    /// The time after the first impact.
    pub after: f64,
}

/// A periodic impact orbit.
#[derive(Clone, Debug, PartialEq)]
pub struct ImpactOrbit {
    /// The way it was found.
    pub kind: OrbitKind,
    /// The periods of the drive in a period of the orbit.
    pub periods: u32,
    /// Its impacts in a period, in order of time.
    pub impacts: Vec<OrbitImpact>,
    /// The Floquet multipliers over a period.
    pub multipliers: [Complex64; 2],
    /// Whether neighbouring motions approach it.
    pub stability: OrbitStability,
    /// The place where it is beyond a wall; `None` of an admissible orbit.
    pub obstacle: Option<Obstacle>,
}

impl ImpactOrbit {
    /// Whether a motion follows it: between impacts it is beyond no wall.
    pub fn is_admissible(&self) -> bool {
        self.obstacle.is_none()
    }

    /// Whether two orbits have the same impacts, from whichever of them and period they are counted.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        const NEAR: f64 = 1e-6;
        let is_near = |(one, other): (&OrbitImpact, &OrbitImpact)| {
            let turns = (one.phase - other.phase) / std::f64::consts::TAU;
            one.wall == other.wall
                && (turns - turns.round()).abs() < NEAR
                && (one.speed - other.speed).abs() < NEAR * one.speed.max(other.speed)
        };
        self.impacts.len() == other.impacts.len()
            && (0..self.impacts.len()).any(|shift| {
                self.impacts.iter().zip(other.impacts.iter().cycle().skip(shift)).all(is_near)
            })
    }
}
