//! Polynomials of a step: value, and the roots of the series of an event.

use pulp::{Arch, Simd, WithSimd};

use crate::numeric::ode::root::{BisectionStop, bisect};

/// The value at `s`.
pub(super) fn value(series: &[f64], s: f64) -> f64 {
    series.iter().rev().fold(0.0, |sum, coefficient| sum * s + coefficient)
}

/// The values at several places, each as [`value`] has it: this many sums at a time wait less on
/// each other than one.
pub(super) fn values(series: &[f64], places: &[f64], into: &mut Vec<f64>) {
    Arch::new().dispatch(EvaluatePolynomial { series, places, into });
}

struct EvaluatePolynomial<'a> {
    series: &'a [f64],
    places: &'a [f64],
    into: &'a mut Vec<f64>,
}

impl WithSimd for EvaluatePolynomial<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        const TOGETHER: usize = 32;
        for places in self.places.chunks(TOGETHER) {
            let (mut at, mut sums) = ([0.0; TOGETHER], [0.0; TOGETHER]);
            at[..places.len()].copy_from_slice(places);
            for coefficient in self.series.iter().rev() {
                for (sum, place) in sums.iter_mut().zip(&at) {
                    *sum = *sum * place + coefficient;
                }
            }
            self.into.extend_from_slice(&sums[..places.len()]);
        }
    }
}

/// `h^0, h^1, ...`, as many as there is room for, each with a multiplication.
pub(super) fn powers(h: f64, into: &mut [f64]) {
    let Some(first) = into.first_mut() else {
        return;
    };
    *first = 1.0;
    // h^2, h^4, h^8, ... and what stands before them.
    let (mut half, mut square) = (1, h);
    while half < into.len() {
        for k in half..into.len().min(2 * half) {
            into[k] = into[k - half] * square;
        }
        (half, square) = (2 * half, square * square);
    }
}

/// Bounds of all that is added to the constant, and of the same of its slope beside the first term,
/// times `size`, for |s| <= `size`.
fn beyond(series: &[f64], size: f64) -> [f64; 2] {
    let (mut change, mut bend) = (0.0, 0.0);
    for (k, coefficient) in series.iter().enumerate().skip(1).rev() {
        change = change * size + coefficient.abs();
        if k > 1 {
            bend = bend * size + k as f64 * coefficient.abs();
        }
    }
    [change * size, bend * size * size]
}

/// The first root after `from`, at most `to`, and whether the polynomial grows there; a root at
/// `from` itself is not counted.
///
/// The first root, by bounds: if the constant outweighs all other terms there is no root, if the
/// slope keeps its sign there is at most one, and every other interval is halved.
pub(super) fn first_root(series: &[f64], from: f64, to: f64) -> Option<(f64, bool)> {
    let [constant, slope, ..] = *series else {
        return None;
    };
    // Most series have none, and the bounds about 0 say so.
    let [change, bend] = beyond(series, to.abs().max(from.abs()));
    if constant.abs() > change || change == 0.0 {
        return None;
    }
    let first = from + apart(from, to);
    let monotonic = slope.abs() * to.abs().max(from.abs()) > bend;
    let (at_first, at_last) = (value(series, first), value(series, to));
    if monotonic && at_first * at_last > 0.0 {
        return None;
    }
    let mut open = vec![(first, to)];
    let mut looked_at = 0;
    while let Some((low, high)) = open.pop() {
        const MOST: usize = 4000;
        looked_at += 1;
        if low >= high || looked_at > MOST {
            continue;
        }
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let shifted = about(series, middle);
        let [change, bend] = beyond(&shifted, half);
        if shifted[0].abs() > change {
            continue;
        }
        let slope = shifted.get(1).map_or(0.0, |slope| slope.abs() * half);
        let monotonic = slope > bend;
        if !monotonic && half > 1e-13 * (to - from) {
            open.push((middle, high));
            open.push((low, middle));
            continue;
        }
        let (at_low, at_high) = (value(series, low), value(series, high));
        if at_low == 0.0 || (at_high != 0.0 && at_low.signum() == at_high.signum()) {
            continue;
        }
        let before = |at: f64| value(series, at).signum() == at_low.signum();
        let [_, root] = bisect(before, low, high, BisectionStop::Width(f64::EPSILON * high.abs()));
        return Some((root, at_low < 0.0));
    }
    None
}

/// Distance from the last root within which the sign is rounding.
fn apart(from: f64, to: f64) -> f64 {
    1e-14 * (to.abs() + from.abs())
}

/// The sign with which the search for roots begins on a step of this length; 0 for nothing but
/// zeros.
pub(super) fn sign_at_start(series: &[f64], length: f64) -> f64 {
    let here = value(series, apart(0.0, length));
    let leading = series.iter().find(|value| **value != 0.0);
    match (here, leading) {
        (0.0, None) => 0.0,
        // Underflow, or no step at all.
        (0.0, Some(leading)) => leading.signum(),
        _ => here.signum(),
    }
}

/// The polynomial about another centre, by Horner's scheme.
fn about(series: &[f64], centre: f64) -> Vec<f64> {
    let mut shifted = series.to_vec();
    for start in 0..shifted.len() {
        for k in (start..shifted.len() - 1).rev() {
            shifted[k] += centre * shifted[k + 1];
        }
    }
    shifted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_those_of_the_standard_library() {
        for length in 0..40 {
            let mut table = vec![0.0; length];
            powers(-0.7, &mut table);
            for (k, power) in table.iter().enumerate() {
                let expected = (-0.7_f64).powi(k as i32);
                assert!(
                    (power - expected).abs() <= 1e-15 * expected.abs(),
                    "{k}: {power} {expected}"
                );
            }
        }
    }

    #[test]
    fn every_root_is_found_in_its_turn() {
        // (s - 1/10)(s - 1/5)(s - 9/10), and a double root that does not cross.
        let cubic = [-0.018, 0.29, -1.2, 1.0];
        let (mut from, mut found) = (0.0, vec![]);
        while let Some((place, rising)) = first_root(&cubic, from, 1.0) {
            found.push((place, rising));
            from = place;
        }
        for ((place, rising), expected) in
            found.iter().zip([(0.1, true), (0.2, false), (0.9, true)])
        {
            assert!((place - expected.0).abs() < 1e-14 && *rising == expected.1, "{found:?}");
        }
        assert_eq!(found.len(), 3);
        assert_eq!(first_root(&[0.25, -1.0, 1.0], 0.0, 1.0), None);
        // Two roots a millionth apart.
        let near = first_root(&[0.25 - 2.5e-13, -1.0, 1.0], 0.0, 1.0).expect("a root");
        assert!((near.0 - (0.5 - 5e-7)).abs() < 1e-9 && !near.1);
        assert_eq!(first_root(&[0.0, 1.0], 0.0, 1.0), None);
        // One at the very end, where the value is exactly zero.
        assert_eq!(first_root(&[-1.0, 1.0], 0.0, 1.0), Some((1.0, true)));
        assert_eq!(first_root(&[1.0, -1.0], 0.0, 1.0), Some((1.0, false)));
        // Cases that the bounds about 0 decide by themselves.
        assert_eq!(first_root(&[2.0, -1.0, 0.5], 0.0, 1.0), None);
        assert_eq!(first_root(&[1e-3, 1.0, 0.1], 0.0, 1.0), None);
        assert_eq!(first_root(&[3.0], 0.0, 1.0), None);
    }
}
