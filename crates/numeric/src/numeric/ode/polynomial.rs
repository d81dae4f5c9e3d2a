//! The real zeros of a polynomial in doubles.
//!
//! In: coefficients and an interval. Out: the zeros in it, from left to right, each once, and
//! whether the sign changes there. Between two neighbouring zeros of its derivative a polynomial
//! has at most one zero, so the zeros are found from the linear derivative upwards, each by
//! [`find_root`].
//!
//! ```
//! # use lindstedt_numeric as lindstedt;
//! use lindstedt::numeric::ode::polynomial::{RealZero, real_zeros};
//!
//! // x^2 (x - 2)
//! let zeros = real_zeros(&[0.0, 0.0, -2.0, 1.0], [f64::NEG_INFINITY, f64::INFINITY]);
//! assert_eq!(zeros[0], RealZero { place: 0.0, crosses: false });
//! assert!(zeros.len() == 2 && (zeros[1].place - 2.0).abs() < 1e-15 && zeros[1].crosses);
//! ```

use super::root::{BisectionStop, bisect, find_root};

/// A real zero of a polynomial.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RealZero {
    /// The zero itself.
    pub place: f64,
    /// Whether the polynomial changes its sign there; `false` at an end of the interval.
    pub crosses: bool,
}

/// Returns the zeros of a polynomial between two ends, which may be infinite; the lowest
/// coefficient comes first. Two zeros so close that the polynomial between them is below its
/// rounding are one at which the sign does not change.
pub fn real_zeros(coefficients: &[f64], ends: [f64; 2]) -> Vec<RealZero> {
    let Some(degree) = coefficients.iter().rposition(|coefficient| *coefficient != 0.0) else {
        return vec![];
    };
    // Fujiwara's bound, 2 max |c_k/c_n|^(1/(n - k)); the powers of x alone have all their zeros
    // at 0.
    let bound =
        |k: usize| (coefficients[k] / coefficients[degree]).abs().powf(1.0 / (degree - k) as f64);
    let farthest = 2.0 * (0..degree).map(bound).fold(0.0, f64::max);
    let farthest = if farthest > 0.0 { farthest } else { 1.0 };
    // No zero can be found beyond the point at which the powers overflow.
    let is_finite =
        |x: f64| coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c.abs()).is_finite();
    let farthest = match is_finite(farthest) {
        true => farthest,
        false => bisect(is_finite, 0.0, farthest, BisectionStop::Width(0.0))[0],
    };
    let [low, high] = ends.map(|end| if end.is_infinite() { farthest.copysign(end) } else { end });
    let mut derivatives = vec![coefficients[..=degree].to_vec()];
    while let Some(last) = derivatives.last().filter(|last| last.len() > 2) {
        derivatives.push(last.iter().enumerate().skip(1).map(|(k, c)| k as f64 * c).collect());
    }
    let mut zeros: Vec<RealZero> = vec![];
    for polynomial in derivatives.iter().rev() {
        let places: Vec<f64> =
            [low].into_iter().chain(zeros.iter().map(|zero| zero.place)).chain([high]).collect();
        zeros = zeros_between(polynomial, &places);
    }
    zeros
}

/// Returns the zeros of a polynomial that is monotonic between neighbouring places.
fn zeros_between(polynomial: &[f64], places: &[f64]) -> Vec<RealZero> {
    /// A value is rounding if its ratio to the sum of the absolute values of all terms is below
    /// this.
    const ROUNDING: f64 = 1e-14;
    let value = |x: f64| polynomial.iter().rev().fold(0.0, |sum, c| sum * x + c);
    let size = |x: f64| polynomial.iter().rev().fold(0.0, |sum, c| sum * x.abs() + c.abs());
    let mut zeros = vec![];
    // The last place with a sign, and the first after it without one.
    let (mut last, mut touched): (Option<(f64, f64)>, Option<f64>) = (None, None);
    for &x in places {
        let here = value(x);
        if !here.is_finite() {
            (last, touched) = (None, None);
            continue;
        }
        if here.abs() <= ROUNDING * size(x) {
            touched = touched.or(Some(x));
            continue;
        }
        let crossed = last.filter(|(_, before)| (*before > 0.0) != (here > 0.0));
        let place = match crossed {
            Some((before, _)) => touched
                .filter(|touched| value(*touched) == 0.0)
                .or_else(|| find_root(value, before, x).ok()),
            None => touched,
        };
        zeros.extend(place.map(|place| RealZero { place, crosses: crossed.is_some() }));
        (last, touched) = (Some((x, here)), None);
    }
    zeros.extend(touched.map(|place| RealZero { place, crosses: false }));
    zeros
}

#[cfg(test)]
mod tests {
    use super::*;

    const EVERYWHERE: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

    fn crossings(coefficients: &[f64], ends: [f64; 2]) -> Vec<f64> {
        let zeros = real_zeros(coefficients, ends).into_iter().filter(|zero| zero.crosses);
        zeros.map(|zero| zero.place).collect()
    }

    #[test]
    fn zeros_lie_between_those_of_the_derivative() {
        // (x - 1)(x - 2)(x - 3)(x + 4)
        let quartic = [-24.0, 38.0, -13.0, -2.0, 1.0, 0.0];
        for (ends, expected) in [
            (EVERYWHERE, &[-4.0, 1.0, 2.0, 3.0][..]),
            ([0.0, f64::INFINITY], &[1.0, 2.0, 3.0]),
            ([1.5, 2.5], &[2.0]),
        ] {
            let found = crossings(&quartic, ends);
            assert_eq!(found.len(), expected.len(), "{found:?}");
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
        }
        for none in [&[1.0, 0.0, 1.0][..], &[3.0], &[0.0], &[]] {
            assert_eq!(real_zeros(none, EVERYWHERE), [], "{none:?}");
        }
    }

    /// `x^4000 = 2`, whose degree does not meet the stack, and whose powers overflow below the
    /// bound.
    #[test]
    fn high_powers_have_their_zeros() {
        let mut high = vec![0.0; 4001];
        (high[0], high[4000]) = (-2.0, 1.0);
        let found = crossings(&high, [0.0, f64::INFINITY]);
        assert!(matches!(found[..], [zero] if (zero.powi(4000) - 2.0).abs() < 1e-9), "{found:?}");
    }

    #[test]
    fn multiple_zeros_are_one() {
        let zero = |place, crosses| RealZero { place, crosses };
        assert_eq!(real_zeros(&[0.0, 1.0], EVERYWHERE), [zero(0.0, true)]);
        assert_eq!(real_zeros(&[0.0, 0.0, 0.0, 2.0], EVERYWHERE), [zero(0.0, true)]);
        assert_eq!(real_zeros(&[0.0, 0.0, -1.0], EVERYWHERE), [zero(0.0, false)]);
        // (x - 1/10)^2 (x + 1)
        let [single, double] = real_zeros(&[0.01, -0.19, 0.8, 1.0], EVERYWHERE)[..] else {
            panic!("not two")
        };
        assert!(single.crosses && (single.place + 1.0).abs() < 1e-15, "{single:?}");
        assert!(!double.crosses && (double.place - 0.1).abs() < 1e-15, "{double:?}");
        assert_eq!(real_zeros(&[-1.0, 1.0], [1.0, 2.0]), [zero(1.0, false)]);
    }
}
