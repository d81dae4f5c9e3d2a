//! Phases at which the period of a driven motion begins.
//!
//! ```text
//! P_s: the state at phase s -> the state at s + 2 pi,      P_r = Phi P_s Phi^(-1),  Phi: from s to r
//! ```
//!
//! At an impact or another event the state jumps, so that a map that begins there has neither a value nor
//! a derivative. Multipliers do not depend on the phase of the section (A. H. Nayfeh and B. Balachandran,
//! *Applied Nonlinear Dynamics*, Wiley 1995, section 5.8): it is zero as long as no event comes near, then
//! the middle of the longest time without one. Where it changes along a branch, the orbit is in the branch
//! at both phases, one behind the other.

use std::cell::Cell;
use std::f64::consts::TAU;

use super::branches::{Known, OrbitBranch, Start};
use super::problem::{Anchor, CoupledProblem, Kind, Orbit};
use crate::numeric::orbit_branch::{OrbitBranchEnd, OrbitBranchLimits};
use crate::response::continuation::BranchEnd;

/// Phase between an event and the section below which the section is too near.
const NEAR: f64 = 0.01 * TAU;

/// The phase between a section and the nearest of events at these phases; infinite without events.
fn clearance(section: f64, phases: &[f64]) -> f64 {
    let apart = |phase: &f64| {
        let ahead = (phase - section).rem_euclid(TAU);
        ahead.min(TAU - ahead)
    };
    phases.iter().map(apart).fold(f64::INFINITY, f64::min)
}

/// The middle of the longest stretch without one of these phases, and its distance from both ends; `None`
/// without phases.
fn clearest(phases: &[f64]) -> Option<(f64, f64)> {
    let mut all: Vec<f64> = phases.iter().map(|phase| phase.rem_euclid(TAU)).collect();
    all.sort_by(f64::total_cmp);
    all.push(all.first()? + TAU);
    let stretches = all.windows(2).map(|pair| (pair[0], pair[1] - pair[0]));
    let (from, length) = stretches.max_by(|(_, one), (_, other)| one.total_cmp(other))?;
    Some(((from + 0.5 * length).rem_euclid(TAU), 0.5 * length))
}

/// The end of the way from one phase on to the next occurrence of another.
fn following(from: f64, to: f64) -> f64 {
    from + (to - from).rem_euclid(TAU)
}

impl CoupledProblem<'_> {
    /// Whether motions may begin at another phase than zero.
    fn has_sections(&self) -> bool {
        matches!(self.kind, Kind::Driven(_)) && self.question.has_jumps_of_states()
    }

    /// A section that is farther from the events at these phases than this one, which is near to some, or
    /// is to be left.
    fn better_section(&self, section: f64, phases: &[f64], is_left: bool) -> Option<f64> {
        let own = clearance(section, phases);
        if !self.has_sections() || own > NEAR && !is_left {
            return None;
        }
        clearest(phases).filter(|(_, apart)| *apart > 2.0 * own).map(|(section, _)| section)
    }

    /// A section that is farther from the events of an orbit than its own.
    fn better_section_of(&self, orbit: &Orbit, is_left: bool) -> Option<f64> {
        self.better_section(orbit.kept.section, &orbit.kept.encounters.times, is_left)
    }

    /// A start at a phase without events nearby, where the motion from it tells of one.
    pub(super) fn away_from_events(&self, start: &Start, scale: &[f64]) -> Start {
        let better = || -> Option<Start> {
            let Start { section, parameter, ref unknowns } = *start;
            let (sizes, flow) = (self.sizes_of_start(unknowns, scale), self.in_phase.as_ref()?);
            let phases = [section, section + TAU];
            let phases = flow.event_times(unknowns, phases, parameter, &sizes)?;
            let better = self.better_section(section, &phases, false)?;
            let way = [section, following(section, better)];
            let unknowns = flow.end(unknowns, way, parameter, &sizes)?;
            Some(Start { section: better, parameter, unknowns })
        };
        let found = if self.has_sections() { better() } else { None };
        found.unwrap_or_else(|| start.clone())
    }

    /// The state of an orbit at a phase; `None` if it cannot be followed to there.
    pub(super) fn state_at_phase(
        &self,
        orbit: &Orbit,
        phase: f64,
        scale: &[f64],
    ) -> Option<Vec<f64>> {
        let start = orbit.start()[..self.states.len()].to_vec();
        let from = orbit.kept.section;
        match phase == from {
            true => Some(start),
            false => self.after(&start, [from, following(from, phase)], orbit.parameter(), scale),
        }
    }

    /// An orbit as it begins at another phase.
    fn moved(&self, orbit: &Orbit, section: f64, scale: &[f64]) -> Option<Orbit> {
        let (n, from, parameter) = (self.states.len(), orbit.kept.section, orbit.parameter());
        let sizes = self.sizes_of_start(orbit.start(), scale);
        let way = [from, following(from, section)];
        let image = self.in_phase.as_ref()?.image(orbit.start(), way, parameter, &sizes)?;
        let along = orbit.parameter_slope();
        let ahead = image.by_start * orbit.tangent.rows(0, n) + image.by_parameter * along;
        let guess = image.end.push(parameter);
        let sizes = self.sizes(&orbit.kept.travel, scale, &guess);
        let direction = ahead.push(along).component_div(&sizes);
        let direction = &direction / direction.norm();
        self.with_orbits(scale, Anchor::at_phase(section), |orbits| {
            orbits.orbit_along(&guess, &direction, &sizes)
        })
    }

    /// The orbits from the first in the direction of its tangent, with another section wherever an event
    /// comes near, and the reason why they end.
    pub(super) fn follow_past_events(
        &self,
        first: Orbit,
        limits: &OrbitBranchLimits,
        scale: &[f64],
        anchor: Anchor,
        refused: &dyn Fn(&Orbit) -> bool,
    ) -> (Vec<Orbit>, OrbitBranchEnd) {
        /// Largest number of sections of a branch.
        const MOST: usize = 60;
        let mut points = vec![first];
        for _ in 0..MOST {
            let begin = points.len() - 1;
            let is_near = Cell::new(false);
            let refused = |orbit: &Orbit| {
                is_near.set(self.better_section_of(orbit, false).is_some());
                is_near.get() || refused(orbit)
            };
            let here = points[begin].clone();
            let limits = OrbitBranchLimits { most: limits.most.saturating_sub(begin), ..*limits };
            let (found, end) = self.with_orbits(scale, anchor.of_orbit(&here), |orbits| {
                orbits.follow(here.clone(), &limits, &refused)
            });
            if found.len() == 1 && begin > 0 {
                // It goes on no further from the other section.
                points.pop();
                return (points, end);
            }
            points.extend(found.into_iter().skip(1));
            if begin > 0 && self.leave_passed(&mut points, begin, scale) {
                return (points, OrbitBranchEnd::Closed);
            }
            let is_event = end == OrbitBranchEnd::Refused && is_near.get();
            if !is_event && end != OrbitBranchEnd::Lost {
                return (points, end);
            }
            let last = &points[points.len() - 1];
            let better = self.better_section_of(last, true);
            let next = better.and_then(|section| self.moved(last, section, scale));
            let Some(next) = next else { return (points, OrbitBranchEnd::Lost) };
            points.push(next);
        }
        (points, OrbitBranchEnd::Points)
    }

    /// Leaves the orbits behind an index that the branch has passed before that; returns whether there are
    /// any.
    fn leave_passed(&self, points: &mut Vec<Orbit>, begin: usize, scale: &[f64]) -> bool {
        let before = OrbitBranch {
            orbits: points[..begin].to_vec(),
            ends: [BranchEnd::Lost; 2],
            mirrored: false,
            anchor: Anchor::NONE,
        };
        let known = Known { branches: vec![before], scale: scale.to_vec() };
        let all = points.len();
        let has_passed = |orbit: &Orbit| self.find(orbit, &known).is_some();
        while points.len() > begin + 1 && points.last().is_some_and(has_passed) {
            points.pop();
        }
        points.len() < all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_clearest_phase_is_in_the_middle_of_the_longest_stretch() {
        let (section, apart) = clearest(&[1.0, 2.0, 2.5 + TAU]).expect("phases");
        assert!((apart - 0.5 * (TAU - 1.5)).abs() < 1e-14, "{apart}");
        assert!((section - (2.5 + apart)).abs() < 1e-14, "{section}");
        assert!((clearance(section, &[1.0, 2.0, 2.5]) - apart).abs() < 1e-14);
        assert!((clearance(0.1, &[TAU - 0.1]) - 0.2).abs() < 1e-14);
        assert_eq!((clearest(&[]), clearance(1.0, &[])), (None, f64::INFINITY));
        assert!((following(2.0, 1.0) - (1.0 + TAU)).abs() < 1e-14);
    }
}
