//! Orbits with one impact in n periods of the drive, in numbers; with two walls placed alike, also
//! those with one impact on each wall.
//!
//! The gap y of the wall, just after an impact, is the steady wave about its mean Q = P/k and a
//! free part u. The orbit closes where u gains over T what the impact takes:
//!
//! ```text
//! y = 0, y' = e v  at t0,   y = 0, y' = -v  at t0 + T,   T = 2 pi n/omega
//! (I - Phi) u = (0, (1 + e) v)   ->   u = (1 + e) v/D (S, 1 - C - beta S),   D = 1 - 2 C + E^2
//! (Q + a v)^2 + (b v/omega)^2 = X^2,   a = (1 + e) S/D,   b = e - (1 + e)(1 - C - beta S)/D
//! ```
//!
//! (S. W. Shaw, P. J. Holmes, *J. Sound Vib.* 90, 129-155 (1983), for the free part). A symmetric orbit
//! between two walls is the same with T = pi n/omega, n odd, and -Phi in place of Phi: after half of
//! it the motion is its own mirror image. Without stiffness D is 0 and momentum fixes the speed,
//! (1 + e) v = -P T; the wave then has the velocity e v + P r/S at the impact, and its position
//! follows from its amplitude (P. J. Holmes, *J. Sound Vib.* 84, 173-189 (1982)).

use num_complex::Complex64;

use super::equation::{ImpactNumbers, WallNumbers};
use super::flow::{ClosedFlow, WalledFlow};
use super::multipliers::{OrbitStability, multipliers};
use super::orbit::{ImpactOrbit, Obstacle, OrbitImpact, OrbitKind};

/// The relation between impact speed and drive of one wall and one number of periods.
#[derive(Clone, Debug)]
pub(super) struct OneImpact {
    /// Duration of a leg from impact to impact.
    pub(super) length: f64,
    restitution: f64,
    flow: ClosedFlow,
    /// C and S of the leg, both with a minus for a symmetric orbit.
    wave: [f64; 2],
    /// exp(-c T).
    decay: f64,
    /// The force on the gap when the wave is left out.
    load: super::equation::BiasedHarmonic<f64>,
    relation: Relation,
}

/// The equation for the impact speed.
#[derive(Clone, Copy, Debug)]
enum Relation {
    /// (Q + a v)^2 + (b v/omega)^2 = X^2.
    Quadratic { mean: f64, position: f64, velocity: f64 },
    /// The speed, and the velocity of the wave over omega.
    Momentum { speed: f64, velocity: f64 },
}

/// A solution of the relation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ImpactState {
    /// The speed just before the impact.
    pub(super) speed: f64,
    /// The phase omega t of the drive at the impact, from 0 to 2 pi.
    pub(super) phase: f64,
    /// Trace of the monodromy of a leg, mirrored for a symmetric orbit.
    pub(super) trace: f64,
}

impl OneImpact {
    /// The relation for one impact on this wall in `periods` periods of the drive; for a symmetric
    /// orbit in half of their time. `None` at an undamped resonance, or where the free motion
    /// returns to itself in this time, so that the impact cannot be made up for.
    pub(super) fn new(
        numbers: &ImpactNumbers,
        wall: &WallNumbers,
        periods: u32,
        kind: OrbitKind,
    ) -> Option<Self> {
        let (c, k, omega) = (numbers.damping, numbers.stiffness, numbers.frequency);
        let e = wall.restitution;
        let flow = ClosedFlow::new([c, k, omega], &wall.load)?;
        let mirror = match kind {
            OrbitKind::Symmetric => -1.0,
            _ => 1.0,
        };
        let turns = if mirror < 0.0 { 0.5 } else { 1.0 };
        let length = std::f64::consts::TAU * turns * f64::from(periods) / omega;
        let by = flow.propagator(length);
        let [cosine, sine] = [mirror * by.cosine, mirror * by.sine];
        let decay = (-c * length).exp();
        let relation = if k == 0.0 && mirror > 0.0 {
            let speed = -wall.load.constant * length / (1.0 + e);
            let velocity = e * speed + wall.load.constant * by.from_rest[0] / sine;
            Relation::Momentum { speed, velocity: velocity / omega }
        } else {
            let determinant = 1.0 - 2.0 * cosine + decay;
            // The free motion of this length is the identity but for rounding.
            if determinant.abs() <= 1e-13 {
                return None;
            }
            let first = mirror * by.matrix[0][0];
            Relation::Quadratic {
                mean: match k == 0.0 {
                    true => wall.offset.constant,
                    false => wall.load.constant / k,
                },
                position: (1.0 + e) * sine / determinant,
                velocity: (e - (1.0 + e) * (1.0 - first) / determinant) / omega,
            }
        };
        let load = wall.load;
        Some(Self { length, restitution: e, flow, wave: [cosine, sine], decay, load, relation })
    }

    /// The steady wave's amplitude less the mean gap: zero where the motion without impacts grazes.
    /// `None` where there is no such motion: without stiffness, and where the wall lies beyond rest.
    pub(super) fn grazing(&self) -> Option<f64> {
        match self.relation {
            Relation::Quadratic { mean, .. } if mean > 0.0 => Some(self.flow.amplitude() - mean),
            Relation::Quadratic { .. } | Relation::Momentum { .. } => None,
        }
    }

    /// The discriminant of the relation: zero at a fold, negative where there is no orbit.
    pub(super) fn fold(&self) -> f64 {
        let amplitude = self.flow.amplitude();
        match self.relation {
            Relation::Quadratic { mean, position, velocity } => {
                let size = position.hypot(velocity);
                amplitude - (velocity * mean / size).abs()
            }
            Relation::Momentum { velocity, .. } => amplitude - velocity.abs(),
        }
    }

    /// Both solutions with a positive speed, the faster first; of two with one speed the stable
    /// one of the two phases first.
    pub(super) fn states(&self) -> [Option<ImpactState>; 2] {
        let amplitude = self.flow.amplitude();
        match self.relation {
            Relation::Quadratic { mean, position, velocity } => {
                let square = position * position + velocity * velocity;
                let discriminant =
                    square * amplitude * amplitude - (velocity * mean) * (velocity * mean);
                if !(discriminant >= 0.0 && square > 0.0) {
                    return [None, None];
                }
                // The root that does not cancel, then the other by their product.
                let half = -position * mean;
                let large = half + half.signum() * discriminant.sqrt();
                let product = mean * mean - amplitude * amplitude;
                let mut roots = [large / square, if large == 0.0 { 0.0 } else { product / large }];
                roots.sort_by(|a, b| b.total_cmp(a));
                roots.map(|speed| self.state(speed, [-(mean + position * speed), velocity * speed]))
            }
            Relation::Momentum { speed, velocity } => {
                let square = amplitude * amplitude - velocity * velocity;
                if square.is_nan() || square < 0.0 {
                    return [None, None];
                }
                let position = square.sqrt();
                [-position, position].map(|position| self.state(speed, [position, velocity]))
            }
        }
    }

    /// The solution of this speed, and position and velocity over omega of the steady wave.
    fn state(&self, speed: f64, [position, velocity]: [f64; 2]) -> Option<ImpactState> {
        let [u, v] = self.flow.wave;
        if !(speed > 0.0 && speed.is_finite()) {
            return None;
        }
        let phase = f64::atan2(v * position - u * velocity, u * position + v * velocity);
        let phase = phase.rem_euclid(std::f64::consts::TAU);
        let e = self.restitution;
        let [cosine, sine] = self.wave;
        let force = self.load.value(phase);
        let trace = -2.0 * e * cosine - (1.0 + e) * sine * force / speed;
        Some(ImpactState { speed, phase, trace })
    }

    /// The determinant of the monodromy of a leg.
    pub(super) fn determinant(&self) -> f64 {
        self.restitution * self.restitution * self.decay
    }

    /// 1 + trace + determinant of the leg: zero where a multiplier is -1.
    pub(super) fn period_doubling(&self, state: &ImpactState) -> f64 {
        1.0 + state.trace + self.determinant()
    }

    /// The multipliers of the orbit.
    pub(super) fn multipliers(&self, state: &ImpactState, kind: OrbitKind) -> [Complex64; 2] {
        let own = multipliers(state.trace, self.determinant());
        match kind {
            OrbitKind::Symmetric => own.map(|multiplier| multiplier * multiplier),
            _ => own,
        }
    }

    /// The time after the impact at which the gap is negative, for one wall alone; `None` if the
    /// orbit stays off the wall.
    pub(super) fn negative_gap(&self, state: &ImpactState) -> Option<f64> {
        let start = state.phase / self.flow.frequency;
        self.flow.negative_gap(start, self.restitution * state.speed, self.length)
    }
}

/// All one-impact orbits of these numbers of periods, in each the faster first, and the numbers of
/// periods in whose time the free motion returns to itself. `None` at an undamped resonance.
pub(super) fn one_impact_orbits(
    numbers: &ImpactNumbers,
    periods: impl Iterator<Item = u32>,
) -> Option<(Vec<ImpactOrbit>, Vec<u32>)> {
    let walled = WalledFlow::new(numbers)?;
    let (mut orbits, mut degenerate) = (Vec::new(), Vec::new());
    for count in periods {
        for wall in 0..numbers.walls.len() {
            match OneImpact::new(numbers, &numbers.walls[wall], count, OrbitKind::OneImpact) {
                Some(relation) => {
                    let states = relation.states().into_iter().flatten();
                    orbits.extend(states.map(|state| {
                        orbit(
                            &walled,
                            &relation,
                            &state,
                            [count, wall as u32],
                            OrbitKind::OneImpact,
                        )
                    }));
                }
                None => degenerate.push(count),
            }
        }
    }
    degenerate.dedup();
    Some((orbits, degenerate))
}

/// Symmetric orbits with one impact on each of two walls placed alike.
pub(super) fn symmetric_orbits(
    numbers: &ImpactNumbers,
    periods: impl Iterator<Item = u32>,
) -> Option<Vec<ImpactOrbit>> {
    let walled = WalledFlow::new(numbers)?;
    let mut orbits = Vec::new();
    // After half of an even number of periods the drive is itself, not its mirror image.
    for count in periods.filter(|count| count % 2 == 1) {
        let kind = OrbitKind::Symmetric;
        let Some(relation) = OneImpact::new(numbers, &numbers.walls[0], count, kind) else {
            continue;
        };
        let states = relation.states().into_iter().flatten();
        orbits.extend(states.map(|state| orbit(&walled, &relation, &state, [count, 0], kind)));
    }
    Some(orbits)
}

/// The orbit of a solution.
fn orbit(
    walled: &WalledFlow,
    relation: &OneImpact,
    state: &ImpactState,
    [periods, wall]: [u32; 2],
    kind: OrbitKind,
) -> ImpactOrbit {
    let omega = walled.flow.frequency;
    let wall = wall as usize;
    let first = OrbitImpact::new(wall, state.phase / omega, state.speed, omega);
    let multipliers = relation.multipliers(state, kind);
    let mut impacts = vec![first];
    if kind == OrbitKind::Symmetric {
        let second = first.time + relation.length;
        impacts.push(OrbitImpact::new(1 - wall, second, state.speed, omega));
    }
    ImpactOrbit {
        kind,
        periods,
        obstacle: obstacle(walled, &first, relation.length),
        impacts,
        multipliers,
        stability: OrbitStability::from_multipliers(&multipliers),
    }
}

/// The first place after an impact at which the motion is beyond a wall, before the leg of this
/// length ends.
pub(super) fn obstacle(walled: &WalledFlow, impact: &OrbitImpact, length: f64) -> Option<Obstacle> {
    let state = impact.state_after(walled);
    let contact = walled.first_contact(impact.time, state, length)?;
    // The impact at the end is the next of the orbit.
    (contact.after < length * (1.0 - 1e-7))
        .then_some(Obstacle { wall: contact.wall, after: contact.after })
}
