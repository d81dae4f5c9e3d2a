//! Initial limit cycles, found by the return map of a motion released at rest.
//!
//! ```text
//! P(x): the next turning point on the same side        P(x) = x: a cycle
//! ```
//!
//! Every cycle has a turning point to the right of an equilibrium. Starts there, from near to far,
//! at several values of the parameter, forward and backward in time, find the cycles that attract
//! and those that repel (A. A. Andronov, A. A. Vitt and S. E. Khaikin, *Theory of Oscillators*,
//! Pergamon 1966, chapter V).

use super::backbone::places_of_rest;
use super::jump::{StopCondition, follow};
use super::seeds::Seed;
use super::{PreparedRequest, ResponseError};
use crate::numeric::ode::root::find_root;
use crate::numeric::ode::{Event, IntegrationOptions, State, StopReason, Trajectory, integrate};

/// Number of values of the parameter at which cycles are sought; the second is used if the first
/// finds none.
const VALUES: [u32; 2] = [5, 33];

/// Starts: `RATIO^k` for `|k| <= RINGS`, a thousandth to a thousand units from rest.
const RATIO: f64 = 1.36;
const RINGS: i32 = 22;

/// Largest growth that may be the error of the steps.
const ROUNDING: f64 = 1e-8;

impl PreparedRequest<'_> {
    /// Limit cycles, each with its frequency and its positions.
    pub(super) fn cycles(&self) -> Result<Vec<Seed>, ResponseError> {
        let [low, high] = self.question.range;
        let mut seeds = Vec::new();
        for count in VALUES {
            for index in 0..count {
                if self.question.interrupt.is_requested() {
                    break;
                }
                let parameter = low + (high - low) * f64::from(index) / f64::from(count - 1);
                self.count([1, 0], seeds.len());
                for place in self.rest_positions(parameter) {
                    self.count([0, 2 * RINGS as usize + 1], seeds.len());
                    match self.driven.is_balanced() {
                        true => self.cycles_about(place, parameter, &mut seeds),
                        false => self.cycles_across_jumps(place, parameter, &mut seeds),
                    }
                }
            }
            if !seeds.is_empty() {
                return Ok(seeds);
            }
        }
        Err(self.no_motion_error())
    }

    /// The equilibria about which a motion may oscillate.
    fn rest_positions(&self, parameter: f64) -> Vec<f64> {
        const SIZES: [f64; 3] = [1.0, 0.03, 30.0];
        let mut found: Vec<f64> = Vec::new();
        for size in SIZES {
            for place in places_of_rest(&self.driven, parameter, size) {
                if !found.iter().any(|known| (known - place).abs() <= 1e-9 * size) {
                    found.push(place);
                }
            }
        }
        found
    }

    /// Adds the cycles with a turning point to the right of an equilibrium.
    fn cycles_about(&self, place: f64, parameter: f64, seeds: &mut Vec<Seed>) {
        for backward in [false, true] {
            let growth = |radius: f64| {
                let path = self.swing(place, radius, parameter, backward, SEARCHED);
                path.map_or(f64::NAN, |path| path.end().x - 1.0)
            };
            for radius in fixed_radii(growth) {
                let Some(path) = self.swing(place, radius, parameter, backward, FOUND) else {
                    continue;
                };
                // A jump from growing to shrinking is not a cycle.
                if (path.end().x - 1.0).abs() > 1e-4 {
                    continue;
                }
                const SAMPLES: usize = 512;
                let around = path.samples(SAMPLES + 1).take(SAMPLES);
                let mut positions: Vec<f64> =
                    around.map(|state| place + radius * state.x).collect();
                if backward {
                    positions[1..].reverse();
                }
                let period = path.end().t / self.approximate_frequency(place, radius, parameter);
                seeds.push(Seed {
                    parameter,
                    frequency: std::f64::consts::TAU / period,
                    positions,
                    start: None,
                });
            }
        }
    }

    /// Adds the cycles with a turning point to the right of an equilibrium for a force with jumps.
    /// A motion that sticks cannot be followed backward.
    fn cycles_across_jumps(&self, place: f64, parameter: f64, seeds: &mut Vec<Seed>) {
        /// The longest time in which a motion has to turn back.
        const LONGEST: f64 = 1e3;
        const SAMPLES: usize = 512;
        let swing = |radius: f64, (tolerance, _): (f64, usize)| {
            let options = super::stability::options(radius, tolerance);
            let course = follow(
                &self.driven,
                [place + radius, 0.0],
                parameter,
                StopCondition::Turn(LONGEST),
                &options,
            )?;
            let away = course.end[0] - place;
            (course.turned() && away > 0.0).then_some((course, away))
        };
        let growth =
            |radius: f64| swing(radius, SEARCHED).map_or(f64::NAN, |(_, away)| away / radius - 1.0);
        for radius in fixed_radii(growth) {
            // A jump from growing to shrinking is not a cycle.
            let found =
                swing(radius, FOUND).filter(|(_, away)| (away / radius - 1.0).abs() <= 1e-4);
            if let Some((course, _)) = found {
                seeds.push(Seed {
                    parameter,
                    frequency: std::f64::consts::TAU / course.duration(),
                    positions: course.positions(SAMPLES),
                    start: Some([place + radius, 0.0]),
                });
            }
        }
    }

    /// Approximate frequency of a motion at this distance from rest.
    fn approximate_frequency(&self, place: f64, radius: f64, parameter: f64) -> f64 {
        (self.driven.force(&[place + radius, 0.0, 0.0, parameter]) / radius).sqrt()
    }

    /// The half swing from rest right of an equilibrium to the next turning point there, in radii
    /// and in periods of the approximate frequency; `None` if it does not turn.
    fn swing(
        &self,
        place: f64,
        radius: f64,
        parameter: f64,
        backward: bool,
        (tolerance, maximum_steps): (f64, usize),
    ) -> Option<Trajectory> {
        const LONGEST: f64 = 2e3;
        /// Number of radii beyond which a motion does not return.
        const GONE: f64 = 1e3;
        let pace = self.approximate_frequency(place, radius, parameter);
        let speed = radius * pace * if backward { -1.0 } else { 1.0 };
        let scaled = |_: f64, x: f64, v: f64| {
            -self.driven.force(&[place + radius * x, speed * v, 0.0, parameter])
                / (radius * pace * pace)
        };
        let start = State { t: 0.0, x: 1.0, v: 0.0 };
        let events =
            [Event::stop(|_, _, v| v).falling(), Event::stop(|_, x, _| GONE - x.abs()).falling()];
        let options =
            IntegrationOptions { maximum_steps, ..IntegrationOptions::with_tolerance(tolerance) };
        let path = integrate(scaled, start, LONGEST, &events, &options).ok()?;
        let turned = matches!(path.stop_reason(), StopReason::Event { event: 0, .. });
        (turned && path.end().x > 0.0).then_some(path)
    }
}

/// Tolerance and largest number of steps during the search for cycles, and for a cycle that was
/// found.
const SEARCHED: (f64, usize) = (1e-9, 600);
const FOUND: (f64, usize) = (1e-11, 4000);

/// The radii at which one turn neither grows nor shrinks.
fn fixed_radii(growth: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut before = f64::NAN;
    let mut radii = Vec::new();
    for ring in -RINGS..=RINGS {
        let radius = RATIO.powi(ring);
        let after = growth(radius);
        if before * after < 0.0 && before.abs().min(after.abs()) > ROUNDING {
            radii.extend(find_root(&growth, radius / RATIO, radius).ok());
        }
        before = after;
    }
    radii
}
