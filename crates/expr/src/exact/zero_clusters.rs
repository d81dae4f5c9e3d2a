//! Zeros of a long real polynomial on the positive axis and close to it, with a proof of their
//! number.
//!
//! Reference: M. Marden, *Geometry of Polynomials*, 2nd ed., AMS 1966, section 28 (Pellet's
//! theorem).
//!
//! ```text
//! p(a + t) = d_0 + d_1 t + ... + d_n t^n,    |d_k| r^k > sum_(i != k) |d_i| r^i :   k zeros within r of a
//! ```
//!
//! The search walks along the axis from zero: by steps within discs without zeros (k = 0), and
//! across discs that hold one zero, which is then real, or two, which are both real or conjugate.

use super::big_float::BigFloat;

/// One or two zeros in a disc about a point of the axis that contains no other zero.
#[derive(Clone, Debug)]
pub struct Cluster {
    /// The zero, or the middle of two zeros: the point between them at which the slope vanishes.
    pub place: BigFloat,
    /// One or two.
    pub count: usize,
    /// Distance of two zeros from their middle, divided by the middle; positive if they are
    /// conjugate, negative if they are real.
    pub distance: f64,
}

/// All zeros on the positive axis, and the pairs beside it that are closer to each other than to
/// all others, nearest first; `None` if rounding or a multiple zero hides them, if zero is a
/// zero, or if `stopped`, which is asked before each step, says so.
pub fn clusters(polynomial: &[BigFloat], stopped: impl Fn() -> bool) -> Option<Vec<Cluster>> {
    /// Largest number of steps, far more than any search needs: some ten for each zero, wherever it
    /// is.
    const MOST_STEPS: usize = 20_000;
    /// Logarithms to base two of a step over its place: below the first the search looks for a
    /// cluster ahead, below the second it has failed.
    const SHORT: f64 = -4.0;
    const NONE: f64 = -200.0;
    let walk = ClusterSearch::new(polynomial)?;
    let mut found = vec![];
    let mut at = BigFloat::zero(walk.bits);
    for _ in 0..MOST_STEPS {
        if walk.is_last(&at) {
            return Some(found);
        }
        if stopped() {
            return None;
        }
        let near = walk.about(&at);
        let step = near.radius_of_none()?;
        let share = step - logarithm(&at);
        if share < NONE {
            return None;
        }
        // The next point lies well within the disc, because its radius is rounded.
        let next = &at + &power_of_two(step - 0.1, walk.bits);
        let cluster = (share < SHORT).then(|| walk.cluster(&at, &near)).flatten();
        at = match cluster {
            // The disc of the cluster overlaps the empty disc, so that no zero lies between them.
            Some((cluster, radius)) if &cluster.place - &radius <= next => {
                let beyond = &cluster.place + &radius;
                found.push(cluster);
                beyond
            }
            _ => next,
        };
    }
    None
}

/// Returns the logarithm to base two of the absolute value; minus infinity for zero.
fn logarithm(value: &BigFloat) -> f64 {
    value.exponent().map_or(f64::NEG_INFINITY, |exponent| {
        exponent as f64 + value.shifted(-exponent).to_f64().abs().log2()
    })
}

/// Returns two to a power that need not be a whole number, to the accuracy of a double.
fn power_of_two(exponent: f64, bits: usize) -> BigFloat {
    let whole = exponent.floor();
    BigFloat::of_f64((exponent - whole).exp2(), bits).shifted(whole as i64)
}

struct ClusterSearch<'a> {
    polynomial: &'a [BigFloat],
    bits: usize,
    /// Logarithms to base two of the absolute values of the coefficients.
    sizes: Vec<f64>,
}

/// The Taylor expansion of the polynomial about a point.
struct About {
    coefficients: Vec<BigFloat>,
    sizes: Vec<f64>,
    /// Logarithm of a bound of the total rounding error of all terms, within the largest disc that
    /// is needed.
    noise: f64,
    /// The logarithm of the expansion point, which is the largest radius that is needed.
    largest: f64,
}

impl<'a> ClusterSearch<'a> {
    fn new(polynomial: &'a [BigFloat]) -> Option<Self> {
        let degree = polynomial.iter().rposition(|value| !value.is_zero())?;
        let polynomial = &polynomial[..=degree];
        let first = polynomial.first().filter(|first| !first.is_zero())?;
        Some(Self {
            polynomial,
            bits: first.bits(),
            sizes: polynomial.iter().map(logarithm).collect(),
        })
    }

    /// Whether all zeros are nearer to the origin than this place.
    fn is_last(&self, at: &BigFloat) -> bool {
        dominates(&self.sizes, self.sizes.len() - 1, logarithm(at), f64::NEG_INFINITY)
    }

    /// Returns the Taylor expansion about a point, by repeated synthetic division.
    fn about(&self, at: &BigFloat) -> About {
        let mut coefficients = self.polynomial.to_vec();
        let degree = coefficients.len() - 1;
        if !at.is_zero() {
            for low in 0..degree {
                for k in (low..degree).rev() {
                    coefficients[k] = &coefficients[k] + &(&coefficients[k + 1] * at);
                }
            }
        }
        let largest = logarithm(at);
        let terms = self.sizes.iter().zip(0..);
        let terms = terms.map(|(size, k)| size + f64::from(k) * (largest + 1.0));
        let noise = match at.is_zero() {
            true => f64::NEG_INFINITY,
            // The rounding errors grow with the number of sums in which every term takes part.
            false => {
                terms.fold(f64::NEG_INFINITY, f64::max) + 3.0 * (degree as f64 + 2.0).log2()
                    - self.bits as f64
            }
        };
        About {
            sizes: coefficients.iter().map(logarithm).collect(),
            coefficients,
            noise,
            largest: if at.is_zero() { f64::INFINITY } else { largest },
        }
    }

    /// Returns the zero, or the two zeros, ahead of a point, and the radius of a disc that holds no
    /// other.
    fn cluster(&self, at: &BigFloat, near: &About) -> Option<(Cluster, BigFloat)> {
        // Two zeros are tried first: Newton's method may reach either zero of a close pair alone.
        [2, 1].into_iter().find_map(|count| {
            let place = self.centre(at, near, count)?;
            let about = self.about(&place);
            let radius = power_of_two(about.radius_of(count)?, self.bits);
            let ratio = match count {
                1 => 0.0,
                _ => {
                    let square = about.coefficients.first()? / about.coefficients.get(2)?;
                    (&square / &(&place * &place)).to_f64()
                }
            };
            let distance = ratio.abs().sqrt().copysign(ratio);
            Some((Cluster { place, count, distance }, radius))
        })
    }

    /// The zero near a point by Newton's method, or the middle of two zeros.
    fn centre(&self, at: &BigFloat, near: &About, count: usize) -> Option<BigFloat> {
        const STEPS: usize = 12;
        /// Logarithm of the last step over the starting point.
        const EXACT: f64 = -100.0;
        /// Logarithm of the largest distance ahead over the starting point.
        const FAR: f64 = -2.0;
        let step = |about: &About| {
            let slope = about.coefficients.get(count).filter(|slope| !slope.is_zero())?;
            let times = BigFloat::of_f64(count as f64, self.bits);
            Some(-&(&(about.coefficients.get(count - 1)? / slope) / &times))
        };
        let zero = BigFloat::zero(self.bits);
        let mut place = at + &step(near)?;
        for _ in 0..STEPS {
            let ahead = &place - at;
            if ahead < zero || logarithm(&ahead) > near.largest + FAR {
                return None;
            }
            let next = step(&self.about(&place))?;
            place = &place + &next;
            if logarithm(&next) < near.largest + EXACT {
                break;
            }
        }
        Some(place)
    }
}

impl About {
    /// The logarithm of the radius of a disc without zeros.
    fn radius_of_none(&self) -> Option<f64> {
        const HALVINGS: usize = 6;
        let first = self.sizes[0];
        let terms = self.sizes.iter().zip(0..).skip(1);
        // At this radius the first of the other terms reaches the constant term; at half of it
        // their sum does not.
        let bound =
            terms.map(|(size, k)| (first - size) / f64::from(k)).fold(f64::INFINITY, f64::min);
        let (mut inside, mut outside) = (bound.min(self.largest) - 1.0, bound.min(self.largest));
        if !(inside.is_finite() && dominates(&self.sizes, 0, inside, self.noise)) {
            return None;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            match dominates(&self.sizes, 0, middle, self.noise) {
                true => inside = middle,
                false => outside = middle,
            }
        }
        Some(inside)
    }

    /// The logarithm of the radius of the largest disc with this many zeros, small compared with
    /// the expansion point; `None` if there is none.
    fn radius_of(&self, count: usize) -> Option<f64> {
        /// Logarithm of the smallest radius over the expansion point.
        const LEAST: f64 = -100.0;
        /// Logarithms of the largest radius over the expansion point, for one zero and for two; two
        /// zeros farther apart are found one by one.
        const WIDEST: [f64; 2] = [-3.0, -5.0];
        const STEP: f64 = 0.25;
        self.sizes.get(count)?;
        let mut radius = self.largest + WIDEST[count - 1];
        while radius > self.largest + LEAST {
            if dominates(&self.sizes, count, radius, self.noise) {
                return Some(radius);
            }
            radius -= STEP;
        }
        None
    }
}

/// Whether one term is larger than the sum of all others and the noise, all given by their
/// logarithms: Pellet's criterion.
fn dominates(sizes: &[f64], term: usize, radius: f64, noise: f64) -> bool {
    /// The margin for rounded logarithms.
    const SURELY: f64 = 0.99;
    // The constant term is treated apart, since 0 times an infinite radius would be NaN.
    let at = |k: usize| match k {
        0 => sizes[0],
        _ => sizes[k] + k as f64 * radius,
    };
    let own = at(term);
    let others = (0..sizes.len()).filter(|k| *k != term).map(|k| (at(k) - own).exp2());
    own.is_finite() && others.sum::<f64>() + (noise - own).exp2() < SURELY
}

#[cfg(test)]
mod tests {
    use super::*;

    const BITS: usize = 512;

    fn number(value: f64) -> BigFloat {
        BigFloat::of_f64(value, BITS)
    }

    fn times(left: &[BigFloat], right: &[BigFloat]) -> Vec<BigFloat> {
        let mut product = vec![BigFloat::zero(BITS); left.len() + right.len() - 1];
        for (i, a) in left.iter().enumerate() {
            for (k, b) in right.iter().enumerate() {
                product[i + k] = &product[i + k] + &(a * b);
            }
        }
        product
    }

    /// The product of factors `c_0 + c_1 s + c_2 s^2`.
    fn product(factors: &[[f64; 3]]) -> Vec<BigFloat> {
        let one = vec![number(1.0)];
        factors.iter().fold(one, |all, factor| times(&all, &factor.map(number)))
    }

    fn found(polynomial: &[BigFloat]) -> Vec<(f64, usize, f64)> {
        let clusters = clusters(polynomial, || false).expect("zeros that are told apart");
        clusters.iter().map(|own| (own.place.to_f64(), own.count, own.distance)).collect()
    }

    fn same(found: &[(f64, usize, f64)], expected: &[(f64, usize, f64)]) {
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for (found, expected) in found.iter().zip(expected) {
            assert_eq!(found.1, expected.1, "{found:?} {expected:?}");
            // The middle is where the slope vanishes.
            let allowed = 1e-9 + 10.0 * expected.2.powi(2);
            assert!((found.0 / expected.0 - 1.0).abs() < allowed, "{found:?} {expected:?}");
            assert!(
                (found.2 - expected.2).abs() <= 1e-3 * expected.2.abs(),
                "{found:?} {expected:?}"
            );
        }
    }

    #[test]
    fn single_zeros_are_found_at_every_scale() {
        let linear = |zero: f64| [-zero, 1.0, 0.0];
        let polynomial =
            product(&[linear(1e-9), linear(0.3), linear(0.4), linear(-2.0), linear(1e12)]);
        same(&found(&polynomial), &[(1e-9, 1, 0.0), (0.3, 1, 0.0), (0.4, 1, 0.0), (1e12, 1, 0.0)]);
        assert!(found(&product(&[linear(-1.0), [1.0, 1.0, 1.0]])).is_empty());
    }

    /// `(s - m)^2 + h^2` with `h` far below the digits of a double, and real pairs likewise.
    #[test]
    fn close_pairs_are_counted_as_two() {
        for (exponent, sign) in [(-30, 1.0), (-30, -1.0), (-90, 1.0), (-90, -1.0), (-12, 1.0)] {
            let middle = 3.0;
            let small = number(sign).shifted(2 * exponent);
            let pair = [&number(middle * middle) + &small, number(-2.0 * middle), number(1.0)];
            let others = product(&[[-0.5, 1.0, 0.0], [50.0, 3.0, 1.0], [-700.0, 1.0, 0.0]]);
            let distance = sign * 2_f64.powi(exponent as i32) / middle;
            let expected = [(0.5, 1, 0.0), (middle, 2, distance), (700.0, 1, 0.0)];
            same(&found(&times(&pair, &others)), &expected);
        }
        // An exact double zero.
        let double = found(&product(&[[9.0, -6.0, 1.0], [-1.0, 2.0, 0.0]]));
        assert!(double.len() == 2 && double[1].1 == 2 && double[1].2.abs() < 1e-40, "{double:?}");
    }

    /// Chebyshev's polynomial of degree 40, moved to `0 < s < 2`: zeros `1 + cos((2k + 1) pi/80)`,
    /// close to each other at the ends.
    #[test]
    fn many_zeros_are_all_found() {
        let mut last = vec![number(1.0)];
        let mut next = vec![number(-1.0), number(1.0)];
        for _ in 1..40 {
            let twice = times(&[number(-2.0), number(2.0)], &next);
            let new = twice.iter().enumerate();
            let zero = number(0.0);
            let new = new.map(|(k, value)| value - last.get(k).unwrap_or(&zero)).collect();
            (last, next) = (next, new);
        }
        let zeros = found(&next);
        let expected: Vec<f64> = (0..40)
            .map(|k| 1.0 + (f64::from(79 - 2 * k) * std::f64::consts::PI / 80.0).cos())
            .collect();
        let mut rest = expected.iter();
        for (place, count, distance) in zeros {
            for sign in [-1.0, 1.0].into_iter().take(count) {
                let expected = rest.next().expect("no more than there are");
                let zero = place * (1.0 + sign * distance.abs());
                assert!((zero - expected).abs() < 1e-3, "{place} {count} {distance} {expected}");
                assert!(count == 2 || (zero - expected).abs() < 1e-12, "{place} {expected}");
            }
        }
        assert!(rest.next().is_none());
    }

    #[test]
    fn what_cannot_be_told_is_not_said() {
        // A fourfold zero, a zero at the origin, nothing at all.
        assert!(clusters(&product(&[[1.0, -2.0, 1.0], [1.0, -2.0, 1.0]]), || false).is_none());
        assert!(clusters(&product(&[[0.0, 1.0, 1.0]]), || false).is_none());
        assert!(clusters(&[], || false).is_none());
        // Zeros that are told apart, by a search that is stopped.
        assert!(clusters(&product(&[[1.0, -3.0, 2.0]]), || true).is_none());
    }
}
