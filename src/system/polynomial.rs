//! Polynomials of a step: value, and the roots of the series of an event.

/// The value at `s`.
pub(super) fn value(series: &[f64], s: f64) -> f64 {
    series.iter().rev().fold(0.0, |sum, coefficient| sum * s + coefficient)
}

/// The first root after `from`, at most `to`, and whether the polynomial grows there; a root at `from` itself is not counted.
///
/// By bounds: where the constant outweighs all that is added there is no root, where the slope keeps its sign there is at most
/// one, and everything else is halved.
pub(super) fn first_root(series: &[f64], from: f64, to: f64) -> Option<(f64, bool)> {
    let mut open = vec![(from + apart(from, to), to)];
    let mut looked_at = 0;
    while let Some((low, high)) = open.pop() {
        const MOST: usize = 4000;
        looked_at += 1;
        if low >= high || looked_at > MOST {
            continue;
        }
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let shifted = about(series, middle);
        let beyond = |from: usize, weight: &dyn Fn(usize) -> f64| -> f64 {
            let terms = shifted.iter().enumerate().skip(from);
            terms.map(|(k, c)| weight(k) * c.abs() * half.powi(k as i32)).sum()
        };
        if shifted[0].abs() > beyond(1, &|_| 1.0) {
            continue;
        }
        let slope = shifted.get(1).map_or(0.0, |slope| slope.abs() * half);
        let monotonic = slope > beyond(2, &|k| k as f64);
        if !monotonic && half > 1e-13 * (to - from) {
            open.push((middle, high));
            open.push((low, middle));
            continue;
        }
        let (at_low, at_high) = (value(series, low), value(series, high));
        if at_low == 0.0 || (at_high != 0.0 && at_low.signum() == at_high.signum()) {
            continue;
        }
        let (mut good, mut bad) = (low, high);
        while bad - good > f64::EPSILON * high.abs() {
            let middle = 0.5 * (good + bad);
            if middle <= good || middle >= bad {
                break;
            }
            match value(series, middle).signum() == at_low.signum() {
                true => good = middle,
                false => bad = middle,
            }
        }
        return Some((bad, at_low < 0.0));
    }
    None
}

/// So close to where the last root was, the sign is rounding.
fn apart(from: f64, to: f64) -> f64 {
    1e-14 * (to.abs() + from.abs())
}

/// The sign with which the search for roots begins on a step of this length; 0 for nothing but zeros.
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

/// The same polynomial about another centre, by Horner's scheme.
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
    fn every_root_is_found_in_its_turn() {
        // (s - 1/10)(s - 1/5)(s - 9/10), and a double root that does not cross.
        let cubic = [-0.018, 0.29, -1.2, 1.0];
        let (mut from, mut found) = (0.0, vec![]);
        while let Some((place, rising)) = first_root(&cubic, from, 1.0) {
            found.push((place, rising));
            from = place;
        }
        for ((place, rising), expected) in found.iter().zip([(0.1, true), (0.2, false), (0.9, true)]) {
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
    }
}
