//! The attractors on which many motions settle, by their last states on a section, and the basin of each.
//!
//! ```text
//! period n of a motion:  the least n with which |y_k - y_(k-n)| is so small for its last states y_k on the section, and
//!                        shrinks so fast, that it still has less than a part of that way to go; of n states that are
//!                        all the same one is counted
//! one attractor:         the same n, and the last n states in the same order from some state on
//! ```
//!
//! States are the same if they differ by less than a thousandth of the extent of all last states, and what a motion still
//! has to go is a fifth of that at most. (C. S. Hsu, *Cell-to-Cell
//! Mapping*, Springer 1987, chapter 1, for basins by simulation.)
//!
//! In: the motions of a [sweep](super::sweep) with a section, or of a [sweep to attractors](super::sweep_to_attractors). Out: the attractors, the most frequent first, and on which each
//! motion settles. Cost: the number of motions times that of the attractors.

use super::SweptMotion;
use crate::system::PathEnd;

/// Largest number of states on the section after which a motion repeats itself.
const MOST_STATES: usize = 16;

/// Difference of two states, in the extent of all last states, below which they are the same.
pub(super) const SAME: f64 = 1e-3;

/// Part of this that a motion which has settled may still have to go.
pub(super) const SETTLED: f64 = 0.2;

/// Part of the largest value that is varied which the extent of a state is at least.
const SMALL: f64 = 0.1;

/// A motion that repeats itself on a section, on which others settle.
#[derive(Clone, Debug, PartialEq)]
pub struct Attractor {
    /// Its states on the section, coordinates, then velocities, beginning with the lowest.
    pub states: Vec<Vec<f64>>,
    /// The number of motions that settle on it.
    pub motions: usize,
}

/// The fate of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    /// It settles on the attractor of this number.
    Settled(usize),
    /// It does not repeat itself: it has not settled yet, or takes more than sixteen states, or is chaotic.
    Unsettled,
    /// It ended before its time, as one that grows without bound.
    Ended,
}

/// A motion of which the fate is asked.
#[derive(Clone, Copy, Debug)]
pub(super) enum Member<'a> {
    /// One that was followed to its end.
    Followed(&'a SweptMotion),
    /// One that has the fate of an earlier one, by its number.
    Joins(usize),
}

/// The attractors of many motions and the fate of each of these.
#[derive(Clone, Debug, PartialEq)]
pub struct Basins {
    /// The attractors, that of the most motions first.
    pub attractors: Vec<Attractor>,
    /// The fate of each motion, in their order.
    pub fates: Vec<Fate>,
}

impl Basins {
    /// Finds the attractors of motions that have states on a section.
    pub fn new(motions: &[SweptMotion]) -> Self {
        let members: Vec<Member> = motions.iter().map(Member::Followed).collect();
        Self::of_members(&members, largest_value(motions.iter().map(|motion| &motion.values)))
    }

    /// Finds the attractors of motions of which some join others; `largest` is the largest value that is varied.
    pub(super) fn of_members(members: &[Member], largest: f64) -> Self {
        let followed = members.iter().filter_map(|member| match member {
            Member::Followed(motion) => Some(*motion),
            Member::Joins(_) => None,
        });
        let sizes = extent(&followed.collect::<Vec<_>>(), largest, 1.0);
        let is_same = |one: &[f64], other: &[f64]| {
            one.iter().zip(other).zip(&sizes).all(|((a, b), size)| (a - b).abs() <= SAME * size)
        };
        let mut attractors: Vec<Attractor> = Vec::new();
        let mut fates: Vec<Fate> = Vec::with_capacity(members.len());
        for member in members {
            let motion = match member {
                Member::Followed(motion) => *motion,
                Member::Joins(earlier) => {
                    let fate = fates.get(*earlier).copied().unwrap_or(Fate::Unsettled);
                    if let Fate::Settled(place) = fate {
                        attractors[place].motions += 1;
                    }
                    fates.push(fate);
                    continue;
                }
            };
            if motion.reason != PathEnd::Reached {
                fates.push(Fate::Ended);
                continue;
            }
            let last: Vec<&[f64]> =
                motion.crossings.iter().rev().map(|crossing| crossing.state.as_slice()).collect();
            let has_settled = |n: &usize| way_to_go(&last, *n, &sizes) <= SETTLED * SAME;
            let period = (1..=MOST_STATES.min(last.len() / 3)).find(has_settled);
            let Some(n) = period else {
                fates.push(Fate::Unsettled);
                continue;
            };
            // A slow motion may seem to repeat itself after n states sooner than after one, though all n are the same.
            let is_cycle = |fewer: &usize| {
                n.is_multiple_of(*fewer) && (*fewer..n).all(|k| is_same(last[k], last[k - fewer]))
            };
            let n = (1..n).find(is_cycle).unwrap_or(n);
            let states: Vec<&[f64]> = last[..n].iter().rev().copied().collect();
            let is_known = |known: &Attractor| {
                known.states.len() == n
                    && (0..n).any(|from| {
                        (0..n).all(|k| is_same(states[(from + k) % n], &known.states[k]))
                    })
            };
            let place = attractors.iter().position(is_known).unwrap_or_else(|| {
                let states = from_lowest(&states);
                attractors.push(Attractor { states, motions: 0 });
                attractors.len() - 1
            });
            attractors[place].motions += 1;
            fates.push(Fate::Settled(place));
        }
        // The most frequent first; of two as frequent that which was met first.
        let mut order: Vec<usize> = (0..attractors.len()).collect();
        order.sort_by_key(|place| std::cmp::Reverse(attractors[*place].motions));
        for fate in &mut fates {
            if let Fate::Settled(place) = fate {
                *place = order.iter().position(|old| old == place).unwrap_or(*place);
            }
        }
        let attractors = order.into_iter().map(|place| attractors[place].clone()).collect();
        Self { attractors, fates }
    }

    /// The number of motions with this fate.
    pub fn count(&self, fate: Fate) -> usize {
        self.fates.iter().filter(|own| **own == fate).count()
    }
}

/// The way that a motion still has to go to a cycle of n states, in the extent of all states, the last state first: its
/// largest difference in the last third of its states, and the geometric sequence of that and of the one in the third
/// before; infinite where differences do not shrink.
fn way_to_go(last: &[&[f64]], n: usize, sizes: &[f64]) -> f64 {
    /// Difference that counts as none: that of rounding and of the integration.
    const NONE: f64 = 1e-8;
    let third = (last.len() - n) / 2;
    let difference = |from: usize| {
        let of_state = |k: usize| {
            let pairs = last[k + from].iter().zip(last[k + from + n]).zip(sizes);
            pairs.map(|((a, b), size)| (a - b).abs() / size).fold(0.0, f64::max)
        };
        (0..third).map(of_state).fold(0.0, f64::max)
    };
    let [now, before] = [difference(0), difference(third)];
    // Of n states apart there are as many differences in a third as fit into it.
    let count = third.div_ceil(n) as f64;
    match (now <= NONE, now < before) {
        (true, _) => 0.0,
        (false, true) => count * now * now / (before - now),
        (false, false) => f64::INFINITY,
    }
}

/// The largest absolute value of what is varied.
pub(super) fn largest_value<'a>(values: impl Iterator<Item = &'a Vec<f64>>) -> f64 {
    values.flatten().map(|value| value.abs()).fold(0.0, f64::max)
}

/// Bounds from below of the extents once there are more motions: the states of these stay, and where they are one
/// state others may lie a thousandth of its size apart.
pub(super) fn least_extents(motions: &[&SweptMotion], largest: f64) -> Vec<f64> {
    extent(motions, largest, SAME)
}

/// The extent of the last states of all motions that did not end early, for each state; at least a small part of
/// what is varied, where a state dies out. Where all are one state it is this part of its size.
fn extent(motions: &[&SweptMotion], largest: f64, part: f64) -> Vec<f64> {
    let least = SMALL * largest;
    let complete = || motions.iter().filter(|motion| motion.reason == PathEnd::Reached);
    let states = || complete().flat_map(|motion| motion.crossings.iter().rev().take(MOST_STATES));
    let count = complete().map(|motion| motion.state.len()).max().unwrap_or(0);
    let of_state = |index: usize| {
        let values = states().map(|crossing| crossing.state[index]);
        let [low, high] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
            [low.min(value), high.max(value)]
        });
        let size = high.abs().max(low.abs());
        let extent = if high - low > SAME * size { high - low } else { part * size };
        extent.max(least)
    };
    (0..count).map(of_state).collect()
}

/// The states of a cycle in their order, from that on which is lowest, by the first coordinate, then the next.
fn from_lowest(states: &[&[f64]]) -> Vec<Vec<f64>> {
    let order = |one: &usize, other: &usize| {
        let pairs = states[*one].iter().zip(states[*other]);
        pairs.map(|(a, b)| a.total_cmp(b)).find(|order| order.is_ne()).unwrap_or(one.cmp(other))
    };
    let lowest = (0..states.len()).min_by(order).unwrap_or(0);
    (0..states.len()).map(|k| states[(lowest + k) % states.len()].to_vec()).collect()
}
