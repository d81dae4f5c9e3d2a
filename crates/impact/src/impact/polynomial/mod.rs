//! Polynomials on an interval that begins at 0: value, slope, and every place where the sign
//! changes.
//!
//! ```text
//! p(u) = c_0 + c_1 u + ... + c_n u^n,  0 <= u <= h
//! |p(u) - p(m) - p'(m)(u - m)| <= r^2/2 max|p''|   for |u - m| <= r
//! max|p''| <= sum k (k - 1) |c_k| h^(k-2)
//! ```
//!
//! If Bernstein's form shows no change of sign, or one, nothing is searched (`lanes`, for several
//! polynomials side by side). Otherwise an interval on which the line through the middle stays
//! further from zero than the second bound holds no root; one on which the slope stays further from
//! zero than the first bound on p'' holds at most one; any other is halved. So no root is missed,
//! however close two of them lie, down to the rounding of the polynomial itself.

pub(super) mod lanes;

use crate::numeric::ode::root::find_root;
use lanes::{changes_of_sign, crossings, values, values_and_slopes, variations};

/// At most [`Roots::LIMIT`] roots in ascending order, without allocation; a step of a Taylor series
/// never has more.
#[derive(Debug, Clone, Copy)]
pub(super) struct Roots {
    values: [f64; Roots::LIMIT],
    count: usize,
}

impl Roots {
    pub(super) const LIMIT: usize = 16;

    pub(super) const fn new() -> Self {
        Self { values: [0.0; Self::LIMIT], count: 0 }
    }

    pub(super) fn push(&mut self, value: f64) {
        if let Some(place) = self.values.get_mut(self.count) {
            *place = value;
            self.count += 1;
        }
    }

    pub(super) fn as_slice(&self) -> &[f64] {
        &self.values[..self.count]
    }

    fn is_full(&self) -> bool {
        self.count == Self::LIMIT
    }
}

/// p(u).
pub(super) fn value(coefficients: &[f64], u: f64) -> f64 {
    let [value] = values(as_lane(coefficients), &[u]);
    value
}

/// p(u) and p'(u).
pub(super) fn value_and_slope(coefficients: &[f64], u: f64) -> (f64, f64) {
    let ([value], [slope]) = values_and_slopes(as_lane(coefficients), &[u]);
    (value, slope)
}

/// A bound on |p(u) - p(0)| for 0 <= u <= h.
pub(super) fn variation(coefficients: &[f64], h: f64) -> f64 {
    let [sum] = variations(as_lane(coefficients), &[h]);
    sum
}

/// One polynomial as one lane.
fn as_lane(coefficients: &[f64]) -> &[[f64; 1]] {
    coefficients.as_chunks().0
}

/// A bound on |p''(u)| for 0 <= u <= h.
fn curvature(coefficients: &[f64], h: f64) -> f64 {
    let mut sum = 0.0;
    for (k, coefficient) in coefficients.iter().enumerate().skip(2).rev() {
        sum = sum * h + (k * (k - 1)) as f64 * coefficient.abs();
    }
    sum
}

/// Every place in (0, h] where p changes sign, and h itself where p is zero there. A zero at 0 does
/// not count: it was the end of the step before.
pub(super) fn sign_changes(coefficients: &[f64], h: f64) -> Roots {
    if coefficients.first().is_some_and(|first| first.abs() > variation(coefficients, h)) {
        return Roots::new();
    }
    near_sign_changes(coefficients, h, value(coefficients, h))
}

/// The roots of a polynomial that may vanish in the interval, with its value at h given.
pub(super) fn near_sign_changes(coefficients: &[f64], h: f64, end: f64) -> Roots {
    let mut found = Roots::new();
    // Leaving zero is no change of sign: p(u)/u^k has the same sign for u > 0.
    let zeros = coefficients.iter().take_while(|coefficient| **coefficient == 0.0).count();
    let coefficients = &coefficients[zeros..];
    let Some(&first) = coefficients.first() else {
        return found;
    };
    // If it leaves zero, its value at the end is that of p/u^k.
    let end = if zeros == 0 { end } else { value(coefficients, h) };
    let [changes] = changes_of_sign(as_lane(coefficients), &[h]);
    if changes == 0.0 && first * end > 0.0 {
        return found;
    }
    if changes == 1.0 && first * end < 0.0 {
        found.push(bracketed(coefficients, 0.0, (0.0, first), (h, end)));
        return found;
    }
    let mut search = RootSearch {
        coefficients,
        curvature: curvature(coefficients, h),
        sign: first.signum(),
        looks: 0,
        found,
    };
    search.between((0.0, first), (h, end), DEEPEST);
    search.found
}

/// Number of halvings after which an interval counts as a point.
const DEEPEST: usize = 56;

/// Largest number of intervals in a search; a close pair of roots takes about a hundred. If the
/// values are only rounding or underflow, no interval is ever decided, and the rest counts as a
/// point.
const MOST_LOOKS: usize = 400;

/// A search from left to right.
struct RootSearch<'a> {
    coefficients: &'a [f64],
    /// A bound on |p''|.
    curvature: f64,
    /// The sign of p just before the current place.
    sign: f64,
    looks: usize,
    found: Roots,
}

impl RootSearch<'_> {
    /// Looks at the interval between two places with their values.
    fn between(&mut self, left: (f64, f64), right: (f64, f64), halvings: usize) {
        if self.found.is_full() {
            return;
        }
        let (from, to) = (left.0, right.0);
        let (middle, radius) = (0.5 * (from + to), 0.5 * (to - from));
        let (height, slope) = value_and_slope(self.coefficients, middle);
        if height.abs() > slope.abs() * radius + 0.5 * self.curvature * radius * radius {
            // The sign is the same all over the interval; a change of sign since the last interval
            // lies at its very beginning.
            if height.signum() != self.sign {
                self.add(from);
            }
            return;
        }
        self.looks += 1;
        let narrow = halvings == 0 || self.looks > MOST_LOOKS || radius <= 4.0 * f64::EPSILON * to;
        if !narrow && slope.abs() <= self.curvature * radius {
            self.between(left, (middle, height), halvings - 1);
            self.between((middle, height), right, halvings - 1);
        } else if right.1 == 0.0 {
            self.add(to);
        } else if right.1.signum() != self.sign {
            let clear = !narrow && left.1 != 0.0 && left.1.signum() == self.sign;
            self.add(if clear { bracketed(self.coefficients, 0.0, left, right) } else { middle });
        }
    }

    fn add(&mut self, root: f64) {
        self.found.push(root);
        self.sign = -self.sign;
    }
}

/// The place between `from` and `to` where p - level changes sign once; the nearer end where it
/// does not: Newton's method, halving the interval where that would leave it.
pub(super) fn level_crossing(coefficients: &[f64], level: f64, from: f64, to: f64) -> f64 {
    let start = value(coefficients, from) - level;
    let end = value(coefficients, to) - level;
    if start == 0.0 || end == 0.0 || (start > 0.0) == (end > 0.0) {
        return if start.abs() < end.abs() { from } else { to };
    }
    bracketed(coefficients, level, (from, start), (to, end))
}

/// The root of p - level between two points with known values of opposite sign.
pub(super) fn bracketed(
    coefficients: &[f64],
    level: f64,
    (from, start): (f64, f64),
    (to, end): (f64, f64),
) -> f64 {
    let [place] =
        crossings(as_lane(coefficients), &[level], (&[from], &[start]), (&[to], &[end]), &[true]);
    place
}

/// The root of any function with one change of sign.
pub(super) fn crossing_of(function: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    match find_root(&function, from, to) {
        Ok(root) => root,
        // If rounding has removed the change of sign, the end at which the function is closest to
        // zero is returned.
        Err(_) if function(from).abs() < function(to).abs() => from,
        Err(_) => to,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The product of (u - root) over the roots, lowest power first.
    fn with_roots(roots: &[f64]) -> Vec<f64> {
        let mut coefficients = vec![1.0];
        for root in roots {
            let mut next = vec![0.0; coefficients.len() + 1];
            for (power, coefficient) in coefficients.iter().enumerate() {
                next[power + 1] += coefficient;
                next[power] -= root * coefficient;
            }
            coefficients = next;
        }
        coefficients
    }

    #[test]
    fn value_slope_and_bounds_of_a_cubic() {
        let cubic = [1.0, -2.0, 0.5, 3.0];
        assert_eq!(value_and_slope(&cubic, 2.0), (1.0 - 4.0 + 2.0 + 24.0, -2.0 + 2.0 + 36.0));
        assert_eq!(variation(&cubic, 2.0), 4.0 + 2.0 + 24.0);
        assert_eq!(curvature(&cubic, 2.0), 1.0 + 36.0);
    }

    #[test]
    fn a_search_ends_where_there_is_nothing_but_rounding() {
        // Underflow and overflow: nothing can be told, and it says so at once.
        for scale in [5e-324, 1e-310, f64::MAX, f64::INFINITY, f64::NAN] {
            let noise: Vec<f64> =
                (0..24).map(|k| if k % 3 == 0 { scale } else { -scale }).collect();
            assert!(sign_changes(&noise, 1.0).as_slice().len() <= Roots::LIMIT);
        }
    }

    #[test]
    fn every_change_of_sign_is_found_and_none_invented() {
        for (roots, expected) in [
            (vec![0.3], vec![0.3]),
            (vec![0.3, 0.7], vec![0.3, 0.7]),
            (vec![0.5, 0.5 + 1e-6], vec![0.5, 0.5 + 1e-6]),
            (vec![0.1, 0.2, 0.9, 1.5], vec![0.1, 0.2, 0.9]),
            (vec![-0.1, 1.01], vec![]),
            (vec![0.0, 0.4], vec![0.4]),
            (vec![0.0, 0.0, 0.4], vec![0.4]),
            (vec![1.0], vec![1.0]),
        ] {
            let found = sign_changes(&with_roots(&roots), 1.0);
            assert_eq!(found.as_slice().len(), expected.len(), "{roots:?}: {found:?}");
            for (found, expected) in found.as_slice().iter().zip(&expected) {
                assert!((found - expected).abs() < 1e-9, "{found} against {expected}");
            }
        }
        // Two complex roots next to the interval: no real one.
        assert!(sign_changes(&[0.25 + 1e-12, -1.0, 1.0], 1.0).as_slice().is_empty());
        assert!(sign_changes(&[0.0, 0.0], 1.0).as_slice().is_empty());
    }
}
