//! Roots and minima of a function of one real variable, and the place where a property ends, from a
//! bracket.
//!
//! In: a continuous function and an interval. Out: the point, to the last bits of a double. For a
//! property that only holds or fails, [`bisect`] halves the interval.
//!
//! [`find_root`]: Chandrupatla's hybrid of inverse quadratic interpolation and bisection (T. R.
//! Chandrupatla, *Adv. Eng. Software* 28 (1997) 145): the interpolation is taken only where the
//! three points lie on a curve that is monotone in both directions, `xi = (x1 - x2)/(x3 - x2)`,
//! `phi = (f1 - f2)/(f3 - f2)`, `phi^2 < xi` and `(1 - phi)^2 < 1 - xi`. It never leaves the
//! bracket and never needs more than a few times the steps of bisection.
//!
//! ```
//! # use lindstedt_numeric as lindstedt;
//! use lindstedt::numeric::ode::root::find_root;
//! let cosine = find_root(|x| x.cos() - x, 0.0, 1.0)?;
//! assert!((cosine.cos() - cosine).abs() < 1e-15);
//! # Ok::<(), lindstedt::numeric::ode::root::RootError>(())
//! ```

use std::convert::Infallible;
use thiserror::Error;

/// The reason why no root was returned.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum RootError {
    /// Both ends have the same sign.
    #[error(
        "no sign change between {left} (value {left_value}) and {right} (value {right_value}): choose ends on \
         opposite sides of the root"
    )]
    NotBracketed {
        /// One end of the interval.
        left: f64,
        /// The other end of the interval.
        right: f64,
        /// Value at `left`.
        left_value: f64,
        /// Value at `right`.
        right_value: f64,
    },
    /// The function has no finite value at this point.
    #[error("the function has no finite value at {at}: choose an interval on which it is defined")]
    NonFinite {
        /// The argument.
        at: f64,
    },
}

/// Returns the point between `a` and `b` (in either order) where the continuous function changes
/// sign, as closely as doubles allow; an end at which the function is exactly zero is returned as
/// it is.
///
/// # Errors
/// [`RootError::NotBracketed`] when both ends have the same sign, [`RootError::NonFinite`] when an
/// end or a value is not a finite number.
pub fn find_root(mut function: impl FnMut(f64) -> f64, a: f64, b: f64) -> Result<f64, RootError> {
    let mut value_at = |x: f64| {
        let value = if x.is_finite() { function(x) } else { f64::NAN };
        if value.is_finite() { Ok(value) } else { Err(RootError::NonFinite { at: x }) }
    };
    // (x1, f1) is the newest point, (x2, f2) the other end of the bracket, (x3, f3) the point
    // dropped last.
    let (mut x1, mut f1) = (b, value_at(b)?);
    let (mut x2, mut f2) = (a, value_at(a)?);
    if f1 == 0.0 || f2 == 0.0 {
        return Ok(if f2 == 0.0 { x2 } else { x1 });
    }
    if (f1 > 0.0) == (f2 > 0.0) {
        return Err(RootError::NotBracketed { left: a, right: b, left_value: f2, right_value: f1 });
    }
    let mut fraction = 0.5;
    loop {
        let x = x1 + fraction * (x2 - x1);
        let f = value_at(x)?;
        let (x3, f3);
        if (f > 0.0) == (f1 > 0.0) {
            (x3, f3) = (x1, f1);
        } else {
            (x3, f3) = (x2, f2);
            (x2, f2) = (x1, f1);
        }
        (x1, f1) = (x, f);
        let (best, best_value) = if f1.abs() <= f2.abs() { (x1, f1) } else { (x2, f2) };
        let width = (x2 - x1).abs();
        // The bracket is no wider than two units in the last place: its middle would be one of its
        // ends.
        let resolution = f64::EPSILON * best.abs() + f64::MIN_POSITIVE;
        if best_value == 0.0 || width <= 2.0 * resolution {
            return Ok(best);
        }
        let xi = (x1 - x2) / (x3 - x2);
        let phi = (f1 - f2) / (f3 - f2);
        fraction = if phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi {
            f1 / (f2 - f1) * f3 / (f2 - f3)
                + (x3 - x1) / (x2 - x1) * f1 / (f3 - f1) * f2 / (f3 - f2)
        } else {
            0.5
        };
        let margin = (resolution / width).min(0.5);
        fraction = fraction.clamp(margin, 1.0 - margin);
    }
}

/// The width at which a bisection ends; neighbouring doubles end it in any case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BisectionStop {
    /// The interval has been halved this many times.
    Halvings(u32),
    /// The interval is no wider than this.
    Width(f64),
}

/// Returns the last place found at which a property holds and the first at which it does not, by
/// halving the interval between a place where it holds and one where it does not (in either order).
/// The property is not evaluated at the ends themselves.
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::numeric::ode::root::{BisectionStop, bisect};
///
/// let [defined, undefined] = bisect(|x: f64| (2.0 - x).sqrt().is_finite(), 0.0, 3.0, BisectionStop::Width(0.0));
/// assert_eq!([defined, undefined], [2.0, 2.0_f64.next_up()]);
/// ```
pub fn bisect(
    mut holds: impl FnMut(f64) -> bool,
    inside: f64,
    outside: f64,
    until: BisectionStop,
) -> [f64; 2] {
    let Ok(ends) = try_bisect(|x| Ok::<_, Infallible>(holds(x)), inside, outside, until);
    ends
}

/// Bisects as [`bisect`], for a property whose evaluation may fail.
///
/// # Errors
/// The first error of the property.
pub fn try_bisect<E>(
    mut holds: impl FnMut(f64) -> Result<bool, E>,
    mut inside: f64,
    mut outside: f64,
    until: BisectionStop,
) -> Result<[f64; 2], E> {
    let mut halvings = 0;
    loop {
        let is_wide = match until {
            BisectionStop::Halvings(most) => halvings < most,
            BisectionStop::Width(width) => (outside - inside).abs() > width,
        };
        let middle = 0.5 * (inside + outside);
        if !is_wide || middle == inside || middle == outside {
            return Ok([inside, outside]);
        }
        match holds(middle)? {
            true => inside = middle,
            false => outside = middle,
        }
        halvings += 1;
    }
}

/// Returns the point between `a` and `b` where the function is least, and its value there, by
/// golden section. The search stops as soon as a value is not positive, as suits a search for a
/// near miss. The function should have one minimum there. The point is accurate to about the square
/// root of the rounding error, the value to the rounding error.
///
/// ```
/// # use lindstedt_numeric as lindstedt;
/// use lindstedt::numeric::ode::root::find_minimum;
///
/// let (place, least) = find_minimum(|x| (x - 2.0).powi(2) + 1.0, 0.0, 5.0);
/// assert!((place - 2.0).abs() < 1e-6 && (least - 1.0).abs() < 1e-12);
/// ```
pub fn find_minimum(mut function: impl FnMut(f64) -> f64, a: f64, b: f64) -> (f64, f64) {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (mut left, mut right) = (a, b);
    let mut inner_left = right - golden * (right - left);
    let mut inner_right = left + golden * (right - left);
    let mut value_left = function(inner_left);
    let mut value_right = function(inner_right);
    // 0.618^80 < 2^-52: beyond that the bracket has no width.
    for _ in 0..80 {
        if value_left <= 0.0
            || value_right <= 0.0
            || right - left <= f64::EPSILON * (left.abs() + right.abs())
        {
            break;
        }
        if value_left < value_right {
            right = inner_right;
            (inner_right, value_right) = (inner_left, value_left);
            inner_left = right - golden * (right - left);
            value_left = function(inner_left);
        } else {
            left = inner_left;
            (inner_left, value_left) = (inner_right, value_right);
            inner_right = left + golden * (right - left);
            value_right = function(inner_right);
        }
    }
    if value_left <= value_right { (inner_left, value_left) } else { (inner_right, value_right) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Name, function, the two ends, the root.
    type Case = (&'static str, fn(f64) -> f64, f64, f64, f64);

    #[test]
    fn known_roots_to_the_last_bits() {
        let table: [Case; 7] = [
            ("square root of two", |x| x * x - 2.0, 0.0, 2.0, 2.0_f64.sqrt()),
            ("pi", f64::sin, 3.0, 4.0, std::f64::consts::PI),
            ("triple root", |x| (x - 0.3).powi(3), -1.0, 1.0, 0.3),
            ("end of the interval", |x| x, 0.0, 1.0, 0.0),
            ("a step", |x| if x < 0.323 { -1.0 } else { 1.0 }, -1.0, 1.0, 0.323),
            (
                "steep and flat",
                |x| (-1e6 * x).exp_m1() + 1e-6,
                -1e-4,
                1.0,
                -(-1e-6_f64).ln_1p() / 1e6,
            ),
            ("swapped ends", |x| x.exp() - 1.5, 1.0, 0.0, 1.5_f64.ln()),
        ];
        for (name, function, a, b, root) in table {
            let found = find_root(function, a, b).unwrap();
            assert!(
                (found - root).abs() <= 4.0 * f64::EPSILON * root.abs(),
                "{name}: {found} against {root}"
            );
        }
    }

    #[test]
    fn the_number_of_evaluations_stays_small() {
        for exponent in 1..=9 {
            let mut evaluations = 0;
            let function = |x: f64| {
                evaluations += 1;
                x.powi(exponent) - 0.1
            };
            find_root(function, 0.0, 1.0).unwrap();
            assert!(evaluations < 40, "power {exponent}: {evaluations} evaluations");
        }
    }

    #[test]
    fn what_has_no_root_is_refused() {
        assert!(matches!(
            find_root(|x| x * x + 1.0, -1.0, 1.0),
            Err(RootError::NotBracketed { .. })
        ));
        assert!(matches!(find_root(f64::ln, -1.0, 2.0), Err(RootError::NonFinite { .. })));
        assert!(matches!(
            find_root(|x| x, f64::NEG_INFINITY, 1.0),
            Err(RootError::NonFinite { .. })
        ));
    }

    #[test]
    fn a_property_ends_between_neighbours_or_as_early_as_asked() {
        let below = |x: f64| x < 0.3;
        assert_eq!(bisect(below, -1.0, 1.0, BisectionStop::Width(0.0)), [0.3_f64.next_down(), 0.3]);
        let above = bisect(|x| !below(x), 1.0, -1.0, BisectionStop::Halvings(2000));
        assert_eq!(above, [0.3, 0.3_f64.next_down()]);
        assert_eq!(bisect(below, 0.0, 1.0, BisectionStop::Halvings(2)), [0.25, 0.5]);
        assert_eq!(bisect(below, 0.0, 1.0, BisectionStop::Width(0.25)), [0.25, 0.5]);
        assert_eq!(
            bisect(below, 0.0, f64::INFINITY, BisectionStop::Halvings(9)),
            [0.0, f64::INFINITY]
        );
        let told = |x: f64| if x == 0.25 { Err(x) } else { Ok(below(x)) };
        assert_eq!(try_bisect(told, 0.0, 1.0, BisectionStop::Width(0.0)), Err(0.25));
    }

    #[test]
    fn the_minimum_of_a_parabola() {
        let (at, value) = find_minimum(|x| 1.0 + (x - 0.7) * (x - 0.7), 0.0, 1.0);
        assert!((at - 0.7).abs() < 1e-7 && value - 1.0 < 1e-15);
        let (at, value) = find_minimum(|x| (x - 0.7) * (x - 0.7) - 1e-12, 0.0, 1.0);
        assert!(value <= 0.0, "the dip of depth 1e-12 at 0.7 was not found: {value} at {at}");
    }
}
