//! Motions of an odd force through its equilibrium, by their amplitudes: those about rest, and
//! those that run over hilltops of the potential, as round both wells of `V = -x^2/2 + x^4/4`.
//!
//! References: L. D. Landau and E. M. Lifshitz, *Mechanics*, 3rd ed., section 11; J. Guckenheimer
//! and P. Holmes, *Nonlinear Oscillations, Dynamical Systems, and Bifurcations of Vector Fields*,
//! Springer 1983, section 2.2 (the orbits outside of the homoclinic loops). Released at rest from
//! `x_e + A` a motion swings to `x_e - A` and back where
//!
//! ```text
//! f(x_e + A) > 0,   V(x_e + A) > V(x_e + y)   for all |y| < A
//! ```
//!
//! which holds in ranges of `A`: each begins where `V` is that of the highest hilltop before, and
//! ends at the next one.

use super::force::CentredForce;
use super::well::{WellBoundary, end_of_force, rise, sign_change};
use crate::numeric::ode::root::find_root;

/// One range of amplitudes; the sign of an amplitude does not count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passage {
    /// The amplitude that all of its motions exceed; zero where they begin at rest.
    pub from: f64,
    /// Distance from the equilibrium of the hilltop that these motions pass and the motion of
    /// amplitude `from` does not; zero for the equilibrium itself.
    pub over: f64,
    /// The boundary at which the range ends, at its distance from the equilibrium; `None` if it
    /// does not end.
    pub to: Option<WellBoundary>,
}

/// Number of decades searched on either side of the unit, and the growth of the steps.
const DECADES: i32 = 12;
const GROWTH: f64 = 1.02;

/// Number of equilibria on one side after which the search stops: the force is taken to repeat.
const MOST: usize = 24;

/// Whether a force pushes away from its equilibrium on both sides; `unit` is the scale of length.
pub fn pushes_away(force: &CentredForce, unit: f64) -> bool {
    let unit = unit.abs();
    let distances = (-DECADES..-2).map(|k| unit * 10.0_f64.powi(k));
    let felt = distances.map(|distance| [force.value(distance), -force.value(-distance)]);
    let first =
        felt.into_iter().find(|sides| sides.iter().all(|side| side.is_finite() && *side != 0.0));
    first.is_some_and(|sides| sides.iter().all(|side| *side < 0.0))
}

/// The ranges of amplitudes of an odd force, outwards, up to twenty-four equilibria or twelve
/// decades beyond the unit.
pub fn passages(force: &CentredForce, unit: f64) -> Vec<Passage> {
    let Some(side) = Side::new(force, unit.abs()) else {
        return vec![];
    };
    let mut found = Vec::new();
    let (mut top, mut height) = (0.0, 0.0);
    for (number, &pulls) in side.pulls.iter().enumerate() {
        if !pulls {
            continue;
        }
        let place = side.places.get(number).copied();
        if place.is_none() && !side.is_whole {
            break;
        }
        let rim = match place {
            Some(place) => Some(WellBoundary { place, separatrix: true }),
            None => side.end,
        };
        let begin = if number == 0 { 0.0 } else { side.places[number - 1] };
        if let Some(from) = beginning(force, begin, rim.map(|rim| rim.place), height) {
            found.push(Passage { from, over: top, to: rim });
        }
        if let Some(distance) = place {
            match rise(force, distance) {
                Some(rise) if rise > height => (top, height) = (distance, rise),
                Some(_) => {}
                None => break,
            }
        }
    }
    found
}

/// The range in which an amplitude lies, or the next one outwards, or the last.
pub fn passage_at(passages: &[Passage], amplitude: f64) -> Option<&Passage> {
    let size = amplitude.abs();
    let within =
        |passage: &&Passage| passage.to.is_none_or(|rim| size < rim.place || passage.from >= size);
    passages.iter().find(within).or(passages.last())
}

/// The first amplitude from a bottom at `begin` on at which the potential exceeds a height, before
/// the end; zero at rest.
fn beginning(force: &CentredForce, begin: f64, end: Option<f64>, height: f64) -> Option<f64> {
    /// Relative part of the depth below which a difference is rounding.
    const VISIBLE: f64 = 1e-9;
    if begin == 0.0 {
        return Some(0.0);
    }
    let excess = |distance: f64| rise(force, distance).map_or(f64::NAN, |rise| rise - height);
    let depth = -excess(begin);
    if depth.is_nan() || depth <= 0.0 {
        return None;
    }
    let far = |k: i32| match end {
        Some(end) => begin + (end - begin) * (1.0 - 0.5_f64.powi(k)),
        None => begin * 2.0_f64.powi(k),
    };
    let mut low = begin;
    let outwards = (1..=40).map(far).chain(end);
    for high in outwards {
        let there = excess(high);
        if there > VISIBLE * depth {
            return find_root(excess, low, high).ok();
        }
        if there.is_nan() {
            return None;
        }
        if there < -VISIBLE * depth {
            low = high;
        }
    }
    None
}

/// The right side of a force, from its equilibrium outwards.
struct Side {
    /// Distances at which the force changes its sign.
    places: Vec<f64>,
    /// Whether the force pulls back up to each of these distances, and beyond the last.
    pulls: Vec<bool>,
    /// The end of the force, or a pole.
    end: Option<WellBoundary>,
    /// Whether the search covered the whole side.
    is_whole: bool,
}

impl Side {
    fn new(force: &CentredForce, unit: f64) -> Option<Self> {
        let equilibrium = force.equilibrium();
        let value = |distance: f64| force.value(distance);
        let ends_at = |place: f64| WellBoundary { place, separatrix: false };
        let first = unit * 10.0_f64.powi(-DECADES);
        let farthest = unit * 10.0_f64.powi(DECADES);
        // The last place at which the force has a value other than zero.
        let mut last: Option<(f64, f64)> = None;
        let mut side = Self { places: vec![], pulls: vec![], end: None, is_whole: true };
        let (mut distance, mut window, mut strongest) = (first, first, 0.0_f64);
        let mut corners: Vec<f64> = Vec::new();
        while distance < farthest {
            if distance >= window {
                // Corners and narrow places of the next stretch, nearest last.
                let ahead = 4.0 * window.max(unit);
                corners = force.cuts(window, ahead);
                corners.sort_by(|one, other| other.total_cmp(one));
                window = ahead;
            }
            while corners.last().is_some_and(|&place| place <= distance) {
                corners.pop();
            }
            let step = distance * GROWTH;
            let corner = corners.last().copied().filter(|&place| place <= step);
            let next = corner.unwrap_or(step);
            if corner.is_some() && force.is_pole(equilibrium + next, unit) {
                side.end = Some(ends_at(next));
                break;
            }
            let there = value(next);
            if !there.is_finite() {
                // A corner at which the expression has no value, but the force goes on.
                if corner.is_some() && value(next * (1.0 + 1e-12)).is_finite() {
                    distance = next;
                    continue;
                }
                // A force that overflows f64 has a value all the same.
                if strongest <= 1e250 && force.overflow(next).is_none() {
                    side.end = Some(ends_at(end_of_force(&value, distance, next)));
                }
                break;
            }
            distance = next;
            if there == 0.0 {
                continue;
            }
            match last {
                None => side.pulls.push(there > 0.0),
                Some((from, before)) if before.signum() != there.signum() => {
                    let (place, through_zero) = sign_change(&value, from, next, strongest)?;
                    if !through_zero {
                        side.end = Some(ends_at(place));
                        break;
                    }
                    side.places.push(place);
                    side.pulls.push(there > 0.0);
                    if side.places.len() >= MOST {
                        side.is_whole = false;
                        break;
                    }
                }
                Some(_) => {}
            }
            last = Some((next, there));
            strongest = strongest.max(there.abs());
        }
        Some(side)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::expr::Expr;

    fn ranges(text: &str, unit: f64) -> Vec<(f64, f64, Option<f64>)> {
        let force: Expr = text.parse().unwrap();
        let force =
            CentredForce::new(&force, "x".into(), &Expr::zero(), &BTreeMap::new(), unit).unwrap();
        let found = passages(&force, unit).into_iter();
        let end = |rim: WellBoundary| rim.place;
        found.map(|range| (range.from, range.over, range.to.map(end))).collect()
    }

    #[test]
    fn ranges_begin_at_the_height_of_the_hilltop_before() {
        let near = |found: &[(f64, f64, Option<f64>)], expected: &[(f64, f64, Option<f64>)]| {
            let close = |a: f64, b: f64| (a - b).abs() <= 1e-8 * (1.0 + b.abs());
            assert_eq!(found.len(), expected.len(), "{found:?}");
            for (a, b) in found.iter().zip(expected) {
                let ends = match (a.2, b.2) {
                    (Some(one), Some(other)) => close(one, other),
                    (one, other) => one == other,
                };
                assert!(close(a.0, b.0) && close(a.1, b.1) && ends, "{found:?} for {expected:?}");
            }
        };
        let pi = std::f64::consts::PI;
        for unit in [1.0, 0.03, 700.0] {
            // V = -x^2/2 + x^4/4.
            near(&ranges("x^3 - x", unit), &[(2.0_f64.sqrt(), 0.0, None)]);
            // V = -cos(x) + cos(x)^2 is zero at pi/2 as at 0.
            let turning = ranges("sin(x)*(1 - 2*cos(x))", unit);
            near(&turning[..1], &[(pi / 2.0, 0.0, Some(pi))]);
            // V = 2 x^2 - 5 x^4/4 + x^6/6: the hilltop at 1, 11/12, is met again at x^2 = 11/2.
            near(
                &ranges("x*(x^2 - 1)*(x^2 - 4)", unit),
                &[(0.0, 0.0, Some(1.0)), (5.5_f64.sqrt(), 1.0, None)],
            );
            // Outer hilltops below the one in the middle keep nothing in: V = -x^2/2 + x^4/4 -
            // x^6/25.
            near(&ranges("-x + x^3 - 6*x^5/25", unit), &[]);
            near(&ranges("x + x^3", unit), &[(0.0, 0.0, None)]);
        }
        // V = -x^2 - log(1 - x^2) has a wall at 1, and is zero at x^2 = 0.7968...
        let walled = ranges("2*x/(1 - x^2) - 4*x", 1.0);
        assert!(walled.len() == 1 && (walled[0].2.unwrap() - 1.0).abs() < 1e-9, "{walled:?}");
        let edge = walled[0].0.powi(2);
        assert!((-2.0 * edge - (1.0 - edge).ln()).abs() < 1e-7, "{walled:?}");
    }

    #[test]
    fn a_hilltop_is_told_from_a_bottom() {
        let away = |text: &str, at: &str, unit: f64| {
            let [force, at]: [Expr; 2] = [text, at].map(|text| text.parse().unwrap());
            let force = CentredForce::new(&force, "x".into(), &at, &BTreeMap::new(), unit).unwrap();
            pushes_away(&force, unit)
        };
        for unit in [1e-5, 1.0, 1e5] {
            assert!(
                away("x^3 - x", "0", unit)
                    && away("x^5 - x^3", "0", unit)
                    && away("sin(x)", "pi", 1.0)
            );
            assert!(
                !away("x^3 - x", "1", unit) && !away("x^3", "0", unit) && !away("x^2", "0", unit)
            );
        }
    }
}
