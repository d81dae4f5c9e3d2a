//! Orbits with several impacts, by Newton's method on the map from impact to impact.
//!
//! The map takes time and speed of an impact to those of the next one. Its derivative follows from
//! the closed form: with the gap g of a wall, s its side, v and e v its speeds,
//!
//! ```text
//! just after an impact   dx = -s e v dt,   dx' = (x_w'' - a) dt + s e dv
//! over the flight        Phi
//! at the next impact     dt = s dx/v,      dv = -s dx' - g'' dt
//! ```
//!
//! so that the derivative of the map of all impacts of an orbit has the multipliers of the orbit.

use super::equation::ImpactNumbers;
use super::flow::WalledFlow;
use super::multipliers::{OrbitStability, multipliers, product};
use super::orbit::{ImpactOrbit, OrbitImpact, OrbitKind};
use crate::interrupt::Interrupt;

/// An impact by wall, time and speed before it.
#[derive(Clone, Copy, Debug)]
struct Station {
    wall: usize,
    time: f64,
    speed: f64,
}

/// The impacts, after the first, of a run of the map, and its derivative.
struct ImpactSequence {
    stations: Vec<Station>,
    derivative: [[f64; 2]; 2],
}

/// A search for orbits of so many impacts in so many periods of the drive.
pub(super) struct Search<'a> {
    walled: WalledFlow<'a>,
    impacts: u32,
    periods: u32,
    /// Duration of the orbit.
    duration: f64,
}

/// Phases and speeds from which the search starts.
const PHASES: u32 = 24;
const SPEEDS: u32 = 14;

impl<'a> Search<'a> {
    /// The search; `None` at an undamped resonance.
    pub(super) fn new(numbers: &'a ImpactNumbers, impacts: u32, periods: u32) -> Option<Self> {
        let walled = WalledFlow::new(numbers)?;
        let duration = std::f64::consts::TAU * f64::from(periods) / numbers.frequency;
        Some(Self { walled, impacts, periods, duration })
    }

    /// All orbits found, the fastest first. Orbits that repeat one with fewer impacts are left out.
    /// A search from starts finds what it meets: it proves nothing about what it does not list.
    pub(super) fn orbits(&self, interrupt: Interrupt) -> Vec<ImpactOrbit> {
        let mut found: Vec<Vec<Station>> = Vec::new();
        let mut orbits: Vec<ImpactOrbit> = Vec::new();
        for start in self.starts() {
            if interrupt.is_requested() {
                break;
            }
            // From the start itself, and from where the motion of the start goes.
            for guess in [Some(start), self.later(start)].into_iter().flatten() {
                let Some(run) = guess_to_orbit(self, guess) else { continue };
                if !self.is_repetition(&run.stations)
                    && !found.iter().any(|known| self.is_same(known, &run.stations))
                {
                    orbits.push(self.orbit(&run));
                    found.push(run.stations);
                }
            }
        }
        let speed = |orbit: &ImpactOrbit| {
            orbit.impacts.iter().map(|impact| impact.speed).fold(0.0, f64::max)
        };
        orbits.sort_by(|a, b| speed(b).total_cmp(&speed(a)));
        orbits
    }

    /// Starts on every wall, over all phases and speeds around that of the drive.
    fn starts(&self) -> Vec<Station> {
        let period = self.duration / f64::from(self.periods);
        let omega = self.walled.flow.frequency;
        let mut starts = Vec::new();
        for (wall, own) in self.walled.walls.iter().enumerate() {
            let moving = own.offset.cosine.hypot(own.offset.sine);
            let size = omega * (self.walled.flow.amplitude() + moving)
                + own.load.constant.abs() * self.duration / f64::from(self.impacts);
            for phase in 0..PHASES {
                for speed in 0..SPEEDS {
                    starts.push(Station {
                        wall,
                        time: period * f64::from(phase) / f64::from(PHASES),
                        // From a hundredth of the size to four times it.
                        speed: size * 0.01 * 400_f64.powf(f64::from(speed) / f64::from(SPEEDS - 1)),
                    });
                }
            }
        }
        starts
    }

    /// The next impact, and the derivative of the map to it.
    fn next(&self, from: &Station) -> Option<(Station, [[f64; 2]; 2])> {
        let WalledFlow { flow, walls } = &self.walled;
        let omega = flow.frequency;
        let impact = OrbitImpact::new(from.wall, from.time, from.speed, omega);
        let state = impact.state_after(&self.walled);
        let contact = self.walled.first_contact(from.time, state, self.duration)?;
        let time = from.time + contact.after;
        let [_, rate] = self.walled.gap(contact.wall, time, contact.state);
        // An impact without speed, or just after the one before, is one of an endless series.
        if rate.is_nan() || rate >= 0.0 || contact.after < 1e-9 * self.duration {
            return None;
        }
        let acceleration_of = |wall: usize, time: f64| {
            let offset = &walls[wall].offset;
            -omega * omega * (offset.value(omega * time) - offset.constant)
        };
        let (own, other) = (&walls[from.wall], &walls[contact.wall]);
        let e = own.restitution;
        let leaving = flow.acceleration(from.time, state);
        let start = [
            [-own.side * e * from.speed, 0.0],
            [-own.side * acceleration_of(from.wall, from.time) - leaving, own.side * e],
        ];
        let flight = product(flow.propagator(contact.after).matrix, start);
        let speed = -rate;
        let arriving = other.side * flow.acceleration(time, contact.state)
            + acceleration_of(contact.wall, time);
        let time_slope = other.side / speed;
        let end = [[time_slope, 0.0], [-arriving * time_slope, -other.side]];
        let next = Station { wall: contact.wall, time, speed };
        Some((next, product(end, flight)))
    }

    /// The map over all impacts of an orbit.
    fn run(&self, start: Station) -> Option<ImpactSequence> {
        let mut derivative = [[1.0, 0.0], [0.0, 1.0]];
        let (mut stations, mut now) = (Vec::new(), start);
        for _ in 0..self.impacts {
            let (next, slope) = self.next(&now)?;
            derivative = product(slope, derivative);
            stations.push(next);
            now = next;
        }
        Some(ImpactSequence { stations, derivative })
    }

    /// The impact after many others.
    fn later(&self, start: Station) -> Option<Station> {
        const IMPACTS: usize = 60;
        let mut now = start;
        for _ in 0..IMPACTS {
            now = self.next(&now)?.0;
        }
        let period = self.duration / f64::from(self.periods);
        Some(Station { time: now.time.rem_euclid(period), ..now })
    }

    /// Whether the impacts are those of an orbit with fewer impacts, gone through several times.
    fn is_repetition(&self, stations: &[Station]) -> bool {
        let (count, total) = (stations.len(), self.periods as usize);
        (2..=count).filter(|parts| count % parts == 0 && total % parts == 0).any(|parts| {
            let part = count / parts;
            stations.iter().zip(&stations[part..]).all(|(one, other)| self.is_near(one, other))
        })
    }

    /// Whether two lists are the same orbit, from whichever impact and period they begin.
    fn is_same(&self, one: &[Station], other: &[Station]) -> bool {
        (0..other.len()).any(|shift| {
            let turned = other.iter().cycle().skip(shift);
            one.iter().zip(turned).all(|(one, other)| self.is_near(one, other))
        })
    }

    fn is_near(&self, one: &Station, other: &Station) -> bool {
        const NEAR: f64 = 1e-6;
        let period = self.duration / f64::from(self.periods);
        let apart = (one.time - other.time) / period;
        one.wall == other.wall
            && (apart - apart.round()).abs() < NEAR
            && (one.speed - other.speed).abs() < NEAR * one.speed.max(other.speed)
    }

    /// The orbit of a run that returns to its start.
    fn orbit(&self, run: &ImpactSequence) -> ImpactOrbit {
        let omega = self.walled.flow.frequency;
        let period = self.duration / f64::from(self.periods);
        // From the fastest impact on, which lies in the first period.
        let fastest = (0..run.stations.len())
            .max_by(|&a, &b| run.stations[a].speed.total_cmp(&run.stations[b].speed))
            .unwrap_or(0);
        let shift = (run.stations[fastest].time / period).floor() * period;
        let impacts = (0..run.stations.len()).map(|index| {
            let place = fastest + index;
            let station = run.stations[place % run.stations.len()];
            let later = if place >= run.stations.len() { self.duration } else { 0.0 };
            OrbitImpact::new(station.wall, station.time - shift + later, station.speed, omega)
        });
        let [[a, b], [c, d]] = run.derivative;
        let multipliers = multipliers(a + d, a * d - b * c);
        ImpactOrbit {
            kind: OrbitKind::Searched,
            periods: self.periods,
            impacts: impacts.collect(),
            multipliers,
            stability: OrbitStability::from_multipliers(&multipliers),
            obstacle: None,
        }
    }
}

/// Newton's method from a guess; the orbit's run, if it converges.
fn guess_to_orbit(search: &Search, guess: Station) -> Option<ImpactSequence> {
    const STEPS: usize = 30;
    let omega = search.walled.flow.frequency;
    let mut now = guess;
    let mut size = f64::INFINITY;
    for _ in 0..STEPS {
        let run = search.run(now)?;
        let last = *run.stations.last()?;
        if last.wall != now.wall {
            return None;
        }
        let missed = [last.time - search.duration - now.time, last.speed - now.speed];
        let scaled = (missed[0] * omega).abs().max((missed[1] / now.speed).abs());
        // As near as rounding lets it come: the last step no longer helps.
        if scaled < 1e-13 || scaled < 1e-10 && scaled >= size {
            return (now.speed > 0.0).then_some(run);
        }
        size = scaled;
        let [[a, b], [c, d]] = run.derivative;
        let (a, d) = (a - 1.0, d - 1.0);
        let determinant = a * d - b * c;
        let step = [
            (d * missed[0] - b * missed[1]) / determinant,
            (a * missed[1] - c * missed[0]) / determinant,
        ];
        // No farther than a tenth of a turn and a third of the speed at once.
        let longest = (step[0] * omega / 0.6).abs().max((step[1] / now.speed / 0.3).abs()).max(1.0);
        now.time -= step[0] / longest;
        now.speed -= step[1] / longest;
        if !(now.speed > 0.0 && now.time.is_finite()) {
            return None;
        }
    }
    None
}
