//! Zeros of a long real polynomial on the positive axis and closely beside it, each counted for certain.
//!
//! Reference: M. Marden, *Geometry of Polynomials*, 2nd ed., AMS 1966, section 28 (Pellet's theorem).
//!
//! ```text
//! p(a + t) = d_0 + d_1 t + ... + d_n t^n,    |d_k| r^k > sum_(i != k) |d_i| r^i :   k zeros within r of a
//! ```
//!
//! The axis is walked along from zero: by steps within which nothing vanishes (k = 0), and across discs that hold one zero, which
//! is real then, or two, which are real or conjugate.

use super::big_float::BigFloat;

/// One or two zeros in a disc about a place on the axis, and no other there.
#[derive(Clone, Debug)]
pub(crate) struct Cluster {
    /// The zero, or the middle of two.
    pub place: BigFloat,
    /// One or two.
    pub count: usize,
    /// How far two zeros are from their middle, over the place; positive where they are conjugate, negative where they are real.
    pub distance: f64,
}

/// All zeros on the positive axis, and the pairs beside it that are closer to each other than to all others, nearest first; `None`
/// where rounding or a multiple zero hides them, or where zero is a zero.
pub(crate) fn clusters(polynomial: &[BigFloat]) -> Option<Vec<Cluster>> {
    /// Far more steps than any walk needs: some ten for each zero, wherever it is.
    const MOST_STEPS: usize = 20_000;
    /// A step of a smaller share of the place looks for what is in the way; one of less than the second is none.
    const SHORT: f64 = -4.0;
    const NONE: f64 = -200.0;
    let walk = Walk::new(polynomial)?;
    let mut found = vec![];
    let mut at = BigFloat::zero(walk.bits);
    for _ in 0..MOST_STEPS {
        let near = walk.about(&at);
        if walk.is_last(&at) {
            return Some(found);
        }
        let step = near.radius_of_none()?;
        let share = step - logarithm(&at);
        if share < NONE {
            return None;
        }
        let cluster = (share < SHORT).then(|| walk.cluster(&at, &near)).flatten();
        at = match cluster {
            Some((cluster, radius)) => {
                let beyond = &cluster.place + &power_of_two(radius, walk.bits);
                found.push(cluster);
                beyond
            }
            // Within the disc, for its radius is rounded.
            None => &at + &power_of_two(step - 0.1, walk.bits),
        };
    }
    None
}

/// The logarithm to base two of the size; minus infinity of zero.
fn logarithm(value: &BigFloat) -> f64 {
    value.exponent().map_or(f64::NEG_INFINITY, |exponent| {
        exponent as f64 + value.shifted(-exponent).to_f64().abs().log2()
    })
}

/// Two to a power that is no whole number, to the digits of a double.
fn power_of_two(exponent: f64, bits: usize) -> BigFloat {
    let whole = exponent.floor();
    BigFloat::of_f64((exponent - whole).exp2(), bits).shifted(whole as i64)
}

struct Walk<'a> {
    polynomial: &'a [BigFloat],
    bits: usize,
    /// Logarithms of the sizes of the coefficients.
    sizes: Vec<f64>,
}

/// The polynomial about a place.
struct About {
    coefficients: Vec<BigFloat>,
    sizes: Vec<f64>,
    /// What rounding may have added to all terms together, within the largest disc that is asked for.
    noise: f64,
    /// The logarithm of the place, beyond which no disc reaches.
    largest: f64,
}

impl<'a> Walk<'a> {
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

    /// Taylor's coefficients.
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
            // Every term takes part in so many sums.
            false => terms.fold(f64::NEG_INFINITY, f64::max) + 3.0 * (degree as f64 + 2.0).log2() - self.bits as f64,
        };
        About {
            sizes: coefficients.iter().map(logarithm).collect(),
            coefficients,
            noise,
            largest: if at.is_zero() { f64::INFINITY } else { largest },
        }
    }

    /// The zero or the two ahead of a place, with the radius of a disc that holds nothing else.
    fn cluster(&self, at: &BigFloat, near: &About) -> Option<(Cluster, f64)> {
        /// Half of that to the next zeros must be farther.
        const WIDEST: f64 = -3.0;
        let [first, second, third] = [0, 1, 2].map(|k| near.coefficients.get(k));
        let guesses = [
            (1, second.map(|second| -&(first? / second))),
            (2, None),
        ];
        let _ = (guesses, third, at, WIDEST);
        None
    }
}
