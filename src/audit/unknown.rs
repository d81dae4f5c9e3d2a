//! A number that is not printed, solved for: the values with which a claim is reproduced, and
//! whether several claims can share one.
//!
//! The values are searched on a grid, of equal ratios if the range is positive, and between two of
//! its points where the computed number passes the printed one; the ends of the range that
//! reproduces are found by bisection. The first such range is taken.

use super::claim::Unknown;
use crate::numeric::ode::root::{BisectionStop, bisect, find_root};

/// The values of an unknown that a claim asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RequiredValue {
    /// The unknown, with its range.
    pub unknown: Unknown,
    /// A value that reproduces the printed numbers.
    pub value: f64,
    /// The least and the greatest of the reproducing values around it.
    pub range: [f64; 2],
    /// Whether it lies within the range of the unknown.
    pub is_within: bool,
}

/// Points of the grid inside of the range, and beyond it on either side.
const POINTS: usize = 120;
/// The factor by which the search for a required value goes beyond a range of positive numbers.
const BEYOND: f64 = 1e15;

/// The result for one value of the unknown: whether all printed numbers are reproduced, and the
/// difference of each of them from the printed one; empty if there are none.
pub(super) struct Trial {
    pub(super) reproduces: bool,
    pub(super) differences: Vec<f64>,
}

/// The values of the unknown with which a claim is reproduced, within its range or else beyond it.
pub(super) fn solve(unknown: Unknown, try_value: &dyn Fn(f64) -> Trial) -> Option<RequiredValue> {
    let [low, high] = unknown.within;
    let by_ratio = low > 0.0;
    let place = |from: f64, to: f64, part: f64| match by_ratio {
        true => (from.ln() + part * (to.ln() - from.ln())).exp(),
        false => from + part * (to - from),
    };
    let grid = |from: f64, to: f64| -> Vec<f64> {
        let inner = (1..POINTS).map(|point| place(from, to, point as f64 / POINTS as f64));
        std::iter::once(from).chain(inner).chain(std::iter::once(to)).collect()
    };
    let [below, above] = match by_ratio {
        true => [low / BEYOND, high * BEYOND],
        false => [low - 1000.0 * (high - low), high + 1000.0 * (high - low)],
    };
    if let Some((value, range)) = first(&grid(low, high), try_value) {
        let range = [range[0].max(low), range[1].min(high)];
        return Some(RequiredValue {
            unknown,
            value: nearest(value, range, try_value),
            range,
            is_within: true,
        });
    }
    let mut downwards = grid(below, low);
    downwards.reverse();
    let found = first(&grid(high, above), try_value).or_else(|| first(&downwards, try_value));
    found.map(|(value, range)| RequiredValue {
        unknown,
        value: nearest(value, range, try_value),
        range,
        is_within: false,
    })
}

/// The first reproducing value on a grid, and the range of reproducing values around it.
fn first(grid: &[f64], try_value: &dyn Fn(f64) -> Trial) -> Option<(f64, [f64; 2])> {
    let trials: Vec<Trial> = grid.iter().map(|value| try_value(*value)).collect();
    for (index, trial) in trials.iter().enumerate() {
        let neighbours = [grid[index.saturating_sub(1)], grid[(index + 1).min(grid.len() - 1)]];
        if trial.reproduces {
            return Some(range_about(grid[index], neighbours, try_value));
        }
        let Some(next) = trials.get(index + 1) else {
            continue;
        };
        for (entry, pair) in trial.differences.iter().zip(&next.differences).enumerate() {
            if !(pair.0.is_finite() && pair.1.is_finite() && pair.0 * pair.1 < 0.0) {
                continue;
            }
            let difference =
                |value: f64| try_value(value).differences.get(entry).copied().unwrap_or(f64::NAN);
            let Ok(root) = find_root(difference, grid[index], grid[index + 1]) else {
                continue;
            };
            if try_value(root).reproduces {
                return Some(range_about(root, [grid[index], grid[index + 1]], try_value));
            }
        }
    }
    None
}

/// The ends of the range of reproducing values around a given one; the search goes beyond a
/// neighbour only if that reproduces too.
fn range_about(
    value: f64,
    neighbours: [f64; 2],
    try_value: &dyn Fn(f64) -> Trial,
) -> (f64, [f64; 2]) {
    let reproduces = |value: f64| try_value(value).reproduces;
    let end = |neighbour: f64| {
        let (mut inside, mut outside) = (value, neighbour);
        // Beyond the grid the steps grow.
        for _ in 0..60 {
            if !reproduces(outside) {
                break;
            }
            let step = 2.0 * (outside - inside);
            inside = outside;
            outside += step;
            if step == 0.0 {
                return inside;
            }
        }
        let [last, _] = bisect(reproduces, inside, outside, BisectionStop::Halvings(60));
        last
    };
    let [low, high] = neighbours;
    let (low, high) = (end(low.min(high)), end(low.max(high)));
    (value, [low, high])
}

/// The value in a range that gives exactly the printed number, if there is a single number and such
/// a value; else the known value.
fn nearest(known: f64, range: [f64; 2], try_value: &dyn Fn(f64) -> Trial) -> f64 {
    let difference = |value: f64| match try_value(value).differences[..] {
        [difference] => difference,
        _ => f64::NAN,
    };
    find_root(difference, range[0], range[1]).unwrap_or(known)
}

/// The intersection of all of these ranges; `None` if it is empty.
pub(super) fn in_common(ranges: &[[f64; 2]]) -> Option<[f64; 2]> {
    let low = ranges.iter().map(|range| range[0]).fold(f64::NEG_INFINITY, f64::max);
    let high = ranges.iter().map(|range| range[1]).fold(f64::INFINITY, f64::min);
    (low <= high).then_some([low, high])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn demand(
        within: [f64; 2],
        function: impl Fn(f64) -> f64,
        printed: f64,
        half: f64,
    ) -> Option<RequiredValue> {
        let unknown = Unknown { name: "u".into(), within };
        solve(unknown, &|value| Trial {
            reproduces: (function(value) - printed).abs() <= half,
            differences: vec![function(value) - printed],
        })
    }

    #[test]
    fn the_range_that_reproduces_is_found_however_narrow() {
        let found = demand([1.0, 100.0], |u| u * u, 50.0, 1e-6).expect("a value");
        assert!(found.is_within && (found.value - 50_f64.sqrt()).abs() < 1e-6);
        let width = found.range[1] - found.range[0];
        assert!((width - 1e-6 / 50_f64.sqrt()).abs() < 1e-10, "{width}");
        // As wide as the range itself.
        let found = demand([1.0, 2.0], |_| 3.0, 3.0, 0.1).expect("a value");
        assert_eq!(found.range, [1.0, 2.0]);
    }

    #[test]
    fn what_lies_beyond_is_told() {
        let found = demand([1.0, 10.0], |u| 1.0 / u, 1e-8, 1e-12).expect("a value");
        assert!(!found.is_within && (found.value / 1e8 - 1.0).abs() < 1e-3);
        assert_eq!(demand([1.0, 10.0], |u| 1.0 / u, -1.0, 0.1), None);
        let found = demand([-1.0, 1.0], |u| u, 20.0, 0.5).expect("a value");
        assert!(!found.is_within && (found.range[1] - 20.5).abs() < 1e-9);
    }

    #[test]
    fn ranges_have_a_part_in_common_or_none() {
        assert_eq!(in_common(&[[1.0, 3.0], [2.0, 5.0]]), Some([2.0, 3.0]));
        assert_eq!(in_common(&[[1.0, 2.0], [3.0, 5.0]]), None);
    }
}
