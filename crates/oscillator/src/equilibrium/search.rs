//! Numerical search for the zeros of a force, at any scale.
//!
//! In: the force as a function, and places where it may have small features. Out: every zero at
//! which it changes its sign, whether it pulls back there, and whether it can be reached from
//! `x = 0` without crossing a pole or a place where the force has no value.
//!
//! A polynomial changes its sign at most once between two neighbouring zeros of its derivative, so
//! its zeros follow one derivative after the other. Any other force is walked along a grid of equal
//! ratios, outwards from zero.

use crate::numeric::ode::polynomial::real_zeros;
use crate::numeric::ode::root::{find_minimum, find_root};

/// A zero of the force at which it changes its sign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Zero {
    /// Its position.
    pub position: f64,
    /// Whether the force pulls back: from negative on the left to positive on the right.
    pub stable: bool,
    /// Whether neither a pole nor the end of the force lies between it and `x = 0`.
    pub reachable: bool,
}

/// Number of decades searched on either side of 1, and of grid points in each.
const DECADES: i32 = 30;
const PER_DECADE: i32 = 64;

/// Values below are what underflow leaves of a force that dies out.
const UNDERFLOW: f64 = 1e-300;

/// Number of zeros on one side after which the search stops: the force is taken to repeat.
const MOST: usize = 24;

/// All zeros of a force, those of the right side first, each side outwards; `centres` are places
/// with features that may be small beside their distance from zero.
pub(super) fn zeros(value: &dyn Fn(f64) -> f64, centres: &[f64]) -> Vec<Zero> {
    let mut found = Vec::new();
    let nearest = 10_f64.powi(-DECADES);
    // Beside a zero at x = 0 the force may underflow: the first nonzero value on either side tells
    // its sign.
    let at_zero = value(0.0) == 0.0;
    let felt = |side: f64| {
        let mut forces =
            grid_of_side(side, &[]).into_iter().map(value).take_while(|force| force.is_finite());
        forces.find(|force| *force != 0.0).unwrap_or(0.0)
    };
    let (left, right) = match at_zero {
        true => (felt(-1.0), felt(1.0)),
        false => (value(-nearest), value(nearest)),
    };
    let position = match at_zero {
        true => Some(0.0),
        false => crossing(value, -nearest, nearest),
    };
    if [left, right].iter().all(|force| *force != 0.0)
        && left.signum() != right.signum()
        && let Some(position) = position
    {
        found.push(Zero { position, stable: right > 0.0, reachable: true });
    }
    for side in [1.0, -1.0] {
        ZeroSearch::search_outwards(value, &grid_of_side(side, centres), &mut found);
    }
    found
}

/// The grid of one side, from the nearest place to the farthest. No grid point is a round number,
/// where poles often lie.
fn grid_of_side(side: f64, centres: &[f64]) -> Vec<f64> {
    const PER_DECADE_OF_A_CENTRE: i32 = 16;
    const DECADES_OF_A_CENTRE: i32 = 9;
    let power =
        |k: i32, per_decade: i32| 10_f64.powf((f64::from(k) + 0.37) / f64::from(per_decade));
    let steps = -DECADES * PER_DECADE..DECADES * PER_DECADE;
    let mut sizes: Vec<f64> = steps.map(|k| power(k, PER_DECADE)).collect();
    for centre in centres.iter().map(|centre| centre * side).filter(|centre| *centre > 0.0) {
        let steps = -DECADES_OF_A_CENTRE * PER_DECADE_OF_A_CENTRE..0;
        let near = steps.map(|k| centre * power(k, PER_DECADE_OF_A_CENTRE));
        sizes.extend(
            near.flat_map(|step| [centre - step, centre + step]).filter(|size| *size > 0.0),
        );
    }
    sizes.sort_by(f64::total_cmp);
    sizes.dedup();
    sizes.into_iter().map(|size| side * size).collect()
}

/// A place and the force there.
type ForceSample = (f64, f64);

struct ZeroSearch<'a> {
    value: &'a dyn Fn(f64) -> f64,
    reachable: bool,
    found: Vec<Zero>,
}

impl ZeroSearch<'_> {
    fn search_outwards(value: &dyn Fn(f64) -> f64, places: &[f64], found: &mut Vec<Zero>) {
        let mut walk = ZeroSearch { value, reachable: true, found: vec![] };
        // The last two places at which the force has a value other than zero, and the zeros since.
        let (mut before, mut last): (Option<ForceSample>, Option<ForceSample>) = (None, None);
        let mut flat = 0;
        // A pole at zero hides no zero of this side; close to it a high power overflows over some
        // points.
        let mut in_pole = !value(0.0).is_finite();
        for &x in places {
            let force = value(x);
            if !force.is_finite() && in_pole {
                continue;
            }
            in_pole = false;
            if !force.is_finite() {
                (walk.reachable, before, last, flat) = (false, None, None, 0);
                continue;
            }
            if force.abs() < UNDERFLOW {
                flat += 1;
                continue;
            }
            if let Some(last) = last {
                // On an interval on which the force vanishes no zero is singled out.
                if flat <= 1 {
                    walk.between(before, last, (x, force));
                }
                if walk.found.len() >= MOST {
                    break;
                }
            }
            (before, last, flat) = (if flat == 0 { last } else { None }, Some((x, force)), 0);
        }
        found.append(&mut walk.found);
    }

    /// Looks for zeros between the last point and this one, and for a double zero about the last.
    fn between(&mut self, before: Option<ForceSample>, last: ForceSample, now: ForceSample) {
        if last.1.signum() != now.1.signum() {
            self.change_of_sign(last.0, now.0);
            return;
        }
        let Some(before) = before.filter(|before| before.1.signum() == last.1.signum()) else {
            return;
        };
        let sign = last.1.signum();
        if last.1.abs() >= before.1.abs() && last.1.abs() >= now.1.abs() {
            let inverse = |x: f64| 1.0 / (self.value)(x).abs();
            let (place, _) = find_minimum(inverse, before.0, now.0);
            if self.is_pole(place, (now.0 - before.0).abs()) {
                self.reachable = false;
            }
        } else if last.1.abs() < before.1.abs() && last.1.abs() < now.1.abs() {
            let (place, least) = find_minimum(|x| sign * (self.value)(x), before.0, now.0);
            if least < 0.0 {
                self.change_of_sign(before.0, place);
                self.change_of_sign(place, now.0);
            }
        }
    }

    fn change_of_sign(&mut self, from: f64, to: f64) {
        let Some(position) = crossing(self.value, from, to) else {
            self.reachable = false;
            return;
        };
        if self.is_pole(position, (to - from).abs()) {
            self.reachable = false;
            return;
        }
        self.found.push(Zero {
            position,
            stable: (self.value)(from.max(to)) > 0.0,
            reachable: self.reachable,
        });
    }

    /// Whether the force grows without bound on both sides of a place, seen within `width` of it.
    fn is_pole(&self, place: f64, width: f64) -> bool {
        const GROWTH: f64 = 10.0;
        let far = 0.1 * width;
        let near = f64::max(1e-7 * width, 64.0 * f64::EPSILON * place.abs());
        let grows = |side: f64| {
            let (outer, inner) =
                ((self.value)(place + side * far), (self.value)(place + side * near));
            !inner.is_finite() || inner.abs() > GROWTH * outer.abs()
        };
        grows(1.0) && grows(-1.0)
    }
}

/// The point at which a function changes its sign; `None` if it has no value on the way.
fn crossing(value: &dyn Fn(f64) -> f64, from: f64, to: f64) -> Option<f64> {
    find_root(value, from, to).ok()
}

/// The zeros at which a polynomial changes its sign, from its coefficients, lowest first.
pub(super) fn polynomial_zeros(coefficients: &[f64]) -> Vec<Zero> {
    let found = real_zeros(coefficients, [f64::NEG_INFINITY, f64::INFINITY]);
    let places: Vec<f64> =
        found.iter().filter(|zero| zero.crosses).map(|zero| zero.place).collect();
    // Beyond the last zero the sign is that of the leading coefficient, and it alternates inwards.
    let leading = coefficients.iter().rfind(|coefficient| **coefficient != 0.0);
    let outermost = leading.is_some_and(|leading| *leading > 0.0);
    let count = places.len();
    let zero = |(index, &position): (usize, &f64)| Zero {
        position,
        stable: outermost == (count - 1 - index).is_multiple_of(2),
        reachable: true,
    };
    let mut zeros: Vec<Zero> = places.iter().enumerate().map(zero).collect();
    zeros.sort_by(|a, b| a.position.abs().total_cmp(&b.position.abs()));
    zeros
}

#[cfg(test)]
mod tests {
    use super::*;

    fn positions(value: &dyn Fn(f64) -> f64, stable: bool) -> Vec<f64> {
        let found = zeros(value, &[]).into_iter().filter(|zero| zero.stable == stable);
        found.map(|zero| zero.position).collect()
    }

    fn assert_near(found: &[f64], expected: &[f64]) {
        assert_eq!(found.len(), expected.len(), "{found:?} against {expected:?}");
        for (a, b) in found.iter().zip(expected) {
            assert!((a - b).abs() <= 1e-13 * b.abs(), "{found:?} against {expected:?}");
        }
    }

    #[test]
    fn every_scale_is_walked() {
        for scale in [1e-20, 1e-7, 1.0, 3e5, 1e20] {
            let force = |x: f64| (x / scale) * (x / scale) - 4.0;
            assert_near(&positions(&force, true), &[2.0 * scale]);
            assert_near(&positions(&force, false), &[-2.0 * scale]);
        }
    }

    #[test]
    fn a_zero_may_be_as_near_as_numbers_go() {
        assert_near(&positions(&|x| 1e-6 * x - 1e-293, true), &[1e-287]);
    }

    #[test]
    fn poles_underflow_and_plateaus_are_no_zeros() {
        assert_near(&positions(&|x| 1.0 / (x - 1.0), true), &[]);
        assert_near(&positions(&|x| 1.0 / (x - 1.0), false), &[]);
        assert_near(&positions(&|x| (x - 1.0) * (-(x - 1.0) * (x - 1.0)).exp(), true), &[1.0]);
        assert_near(&positions(&|x: f64| (x - 3.0).max(0.0) + (x - 1.0).min(0.0), true), &[]);
    }

    #[test]
    fn what_lies_beyond_a_pole_is_marked() {
        for force in [(|x| x - 0.25 / ((1.0 - x) * (1.0 - x)) + 0.2) as fn(f64) -> f64, |x| {
            x + 0.2 / (1.0 - x)
        }] {
            for zero in zeros(&force, &[]) {
                assert_eq!(zero.reachable, zero.position < 1.0, "{zero:?}");
            }
        }
        let beyond = zeros(&|x| x - 0.25 / ((1.0 - x) * (1.0 - x)), &[]);
        assert!(beyond.iter().all(|zero| !zero.reachable) && !beyond.is_empty(), "{beyond:?}");
    }

    #[test]
    fn close_pairs_between_two_places_are_seen() {
        let force = |x: f64| ((x - 1.3) * (x - 1.3) - 1e-8) * x.exp();
        assert_near(&positions(&force, true), &[1.3 + 1e-4]);
        assert_near(&positions(&force, false), &[1.3 - 1e-4]);
    }

    #[test]
    fn zeros_of_polynomials() {
        // (x - 1)(x - 2)(x - 3)(x + 1e-6)
        let coefficients = [-6e-6, -6.0 + 11e-6, 11.0 - 6e-6, -6.0 + 1e-6, 1.0];
        let found = polynomial_zeros(&coefficients);
        let stable: Vec<f64> =
            found.iter().filter(|zero| zero.stable).map(|zero| zero.position).collect();
        assert_eq!(stable.len(), 2, "{found:?}");
        assert!((stable[0] - 1.0).abs() < 1e-12 && (stable[1] - 3.0).abs() < 1e-12, "{found:?}");
        // (x - 1/10)^2 (x + 1): a double zero is no change of sign; x^2 + 1 has none.
        let once = polynomial_zeros(&[0.01, -0.19, 0.8, 1.0]);
        assert!(
            once.len() == 1 && once[0].stable && (once[0].position + 1.0).abs() < 1e-15,
            "{once:?}"
        );
        assert_eq!(polynomial_zeros(&[1.0, 0.0, 1.0]), vec![]);
        let far = polynomial_zeros(&[0.0, 1e12, 0.0, -1e26]);
        assert_eq!(far.len(), 3);
        assert!(
            far[0].stable && far[0].position == 0.0 && (far[1].position.abs() - 1e-7).abs() < 1e-20,
            "{far:?}"
        );
    }
}
