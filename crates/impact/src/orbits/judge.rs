//! The verdict on an orbit: does a simulation that starts on it return to it, with the same
//! impacts and the same multipliers?

use num_complex::Complex64;

use super::multipliers::multipliers;
use super::orbit::ImpactOrbit;
use crate::system::PathEnd;
use crate::trajectory::PreparedTrajectory;
use crate::verify::Verdict;

/// An orbit beside a simulation that started on it.
#[derive(Clone, Debug, PartialEq)]
pub struct OrbitVerdict {
    /// The distance of the simulation from its start after a period of the orbit, over the largest
    /// impact speed (a distance of position times the frequency of the drive).
    pub return_error: f64,
    /// The multipliers of the simulation, by central differences; `None` if a neighbouring motion
    /// cannot be followed.
    pub multipliers: Option<[Complex64; 2]>,
    /// The largest distance of a multiplier from that of the orbit; `None` likewise.
    pub multiplier_error: Option<f64>,
    /// Whether the simulation has the impacts of the orbit, both errors within the tolerance.
    pub verdict: Verdict,
}

/// Judges an orbit; the start is position and velocity of the coordinate just after the first
/// impact. `None` if the simulation does not reach the end of the period.
pub(super) fn judge(
    simulation: &PreparedTrajectory,
    orbit: &ImpactOrbit,
    start: [f64; 2],
    frequency: f64,
    tolerance: f64,
) -> Option<OrbitVerdict> {
    let first = orbit.impacts.first()?;
    let period = std::f64::consts::TAU * f64::from(orbit.periods) / frequency;
    let speed = orbit.impacts.iter().map(|impact| impact.speed).fold(0.0, f64::max);
    let next = orbit.impacts.get(1).map_or(first.time + period, |impact| impact.time);
    // The section lies within a leg, where a displaced start is a start as any other.
    let section = 0.5 * (first.time + next);
    let follow = |times: [f64; 2], state: [f64; 2]| {
        let motion = simulation.follow(times, &state).ok()?;
        let end = <[f64; 2]>::try_from(motion.state).ok()?;
        (motion.reason == PathEnd::Reached).then_some((end, motion.walls.impacts.len()))
    };
    let (begin, early) = follow([first.time, section], start)?;
    if early > 0 {
        return Some(failed());
    }
    let advance = |state: [f64; 2]| follow([section, section + period], state);
    let (end, impacts) = advance(begin)?;
    let distance = ((end[0] - begin[0]) * frequency).hypot(end[1] - begin[1]);
    let return_error = distance / speed;
    let end_of = |state: [f64; 2]| Some(advance(state)?.0);
    let found = map_multipliers(begin, [speed / frequency, speed], end_of);
    let multiplier_error = found.map(|found| farthest(&found, &orbit.multipliers));
    let size = orbit.multipliers.iter().map(|own| own.norm()).fold(1.0, f64::max);
    let is_alike = impacts == orbit.impacts.len()
        && return_error <= tolerance
        && multiplier_error.is_some_and(|error| error <= tolerance * size);
    Some(OrbitVerdict {
        return_error,
        multipliers: found,
        multiplier_error,
        verdict: Verdict::from_passed(is_alike),
    })
}

/// The multipliers of a map by central differences over steps that are small beside these sizes.
fn map_multipliers(
    at: [f64; 2],
    sizes: [f64; 2],
    map: impl Fn([f64; 2]) -> Option<[f64; 2]>,
) -> Option<[Complex64; 2]> {
    /// Far above the error of the integration, whose error it is over this.
    const DIFFERENCE: f64 = 1e-5;
    let column = |index: usize| {
        let step = DIFFERENCE * sizes[index];
        let beside = |step: f64| {
            let mut state = at;
            state[index] += step;
            map(state)
        };
        let (right, left) = (beside(step)?, beside(-step)?);
        Some([0, 1].map(|row| (right[row] - left[row]) / (2.0 * step)))
    };
    let ([a, c], [b, d]) = (column(0)?, column(1)?);
    Some(multipliers(a + d, a * d - b * c))
}

fn failed() -> OrbitVerdict {
    OrbitVerdict {
        return_error: f64::INFINITY,
        multipliers: None,
        multiplier_error: None,
        verdict: Verdict::Fail,
    }
}

/// The largest distance between two pairs, paired so that it is least.
fn farthest([a, b]: &[Complex64; 2], [c, d]: &[Complex64; 2]) -> f64 {
    let straight = (a - c).norm().max((b - d).norm());
    let crossed = (a - d).norm().max((b - c).norm());
    straight.min(crossed)
}
