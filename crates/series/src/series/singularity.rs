//! The singularities on the circle of convergence of a power series with exact coefficients.
//!
//! References: D. L. Hunter, G. A. Baker, Phys. Rev. B 19 (1979) 3808-3821 (inhomogeneous
//! differential approximants); R. E. Shafer, SIAM J. Numer. Anal. 11 (1974) 447-460 (quadratic
//! approximants).
//!
//! ```text
//! quadratic:     P + Q f + R f^2 = O(s^n)    branch points where D = Q^2 - 4 P R = 0, like (s - s_0)^(1/2)
//! differential:  P g' + Q g + R = O(s^n)     singular where P = 0, like (s - s_0)^(-Q/P');  g = f, or g = f^(-1/2)
//! ```
//!
//! If `f` is omega^2, `f^(-1/2)` is the period up to a factor. It has a logarithmic singularity
//! where a motion takes for ever, and the differential approximants represent it exactly. All three
//! kinds of approximant are made from all coefficients, and from fewer and fewer. They have many
//! zeros that are not singularities of the series, but these move from one approximant to the next;
//! a zero that stays is accepted, and its movement gives the estimate of its error, which also
//! shows the kind that converges fastest. Several kinds that have found a singularity must agree
//! within their errors, or else the error is their difference.
//!
//! A zero of `f` is a singularity of `f^(-1/2)`, with the power -1/2, -1, -3/2, ..., but not of
//! `f`: it is left out. The others must agree with the growth of the coefficients,
//! `|c_k| ~ k^(-e-1)/R^k` for a power `e` on the circle `|s| = R`: a singularity that would make
//! them larger than they are is rejected, and at least one must make them as large as they are.
//! Coefficients that fall [faster than the powers of any number](is_entire), or [end](last_power),
//! belong to a function without a singularity.

mod complex;

use std::cmp::Ordering;
use std::fmt;

use num_complex::Complex64;
use num_traits::Zero as _;

use super::hermite_pade::{Field, HermitePade};
use crate::decimal::plain_decimal;
use crate::exact::big_float::BigFloat;
use crate::exact::{Rational, Scaled, to_f64};
use crate::parallel::par_map;
use complex::Complex;

/// An estimated number with a bound of its error.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// The estimate, rounded to the digits that its error leaves.
    pub value: Rational,
    /// Bound of the error, rounding included.
    pub error: f64,
}

/// A singularity, or a pair of conjugate ones.
#[derive(Clone, Debug, PartialEq)]
pub struct Singularity {
    /// The distance from zero.
    pub radius: Estimate,
    /// The angle in the upper half plane, in radians: exactly zero on the positive axis; pi with
    /// the error zero on the negative one.
    pub angle: Estimate,
    /// Real and imaginary part.
    pub place: [Estimate; 2],
    /// The power of the distance with which `f^(-1/2)` is singular there (the period if `f` is
    /// omega^2): 1/2 for a square root, 0 for a logarithm; `None` if it could not be determined.
    pub exponent: Option<Estimate>,
}

/// The least power up to which a series must be known for a singularity to be found.
pub const FEWEST: usize = 16;

/// Returns the nearest singularity of a series with these coefficients, the lowest power first;
/// `None` if the coefficients are too few or too irregular, if several singularities are equally
/// far away, or if there is none.
///
/// ```
/// # use lindstedt_series as lindstedt;
/// use lindstedt::exact::ratio;
/// use lindstedt::series::singularity::nearest;
///
/// // 2 - sqrt(1 - s/3): c_k = c_(k-1) (2k - 3)/(6k) from c_1 = 1/6 on
/// let mut coefficients = vec![ratio(1, 1), ratio(1, 6)];
/// for k in 2..=24 {
///     coefficients.push(&coefficients[k as usize - 1] * ratio(2 * k - 3, 6 * k));
/// }
/// let found = nearest(&coefficients).expect("a branch point");
/// assert_eq!(found.radius.value, ratio(3, 1));
/// assert_eq!(found.exponent.expect("its kind").value, ratio(1, 2));
/// ```
pub fn nearest(coefficients: &[Rational]) -> Option<Singularity> {
    if is_entire(coefficients) || last_power(coefficients).is_some() {
        return None;
    }
    let growth = Growth::from_coefficients(coefficients)?;
    let bits = BITS_AT_LEAST + BITS_EACH * coefficients.len();
    let scaled: Vec<BigFloat> = (0..)
        .zip(coefficients)
        .map(|(k, value)| BigFloat::of_fraction(value, bits).shifted(growth.unit * k))
        .collect();
    let find = |kind: &ApproximantKind| followed(*kind, &scaled, &growth);
    let found = par_map(&KINDS, find).into_iter().flatten().collect();
    singularity(found, &growth, bits)
}

/// Least number of binary digits of the calculation, and the number for each coefficient:
/// approximants lose many digits.
const BITS_AT_LEAST: usize = 256;
const BITS_EACH: usize = 6;

/// The growth of the coefficients with the order.
struct Growth {
    /// The approximate radius of convergence, in units of `2^unit`.
    radius: f64,
    /// Uncertainty of the radius: the logarithm of a factor.
    margin: f64,
    /// The binary exponent of the unit of the variable.
    unit: i64,
    /// The powers with the logarithms of the absolute values of their coefficients, in that unit;
    /// without coefficients that vanish.
    sizes: Vec<(usize, f64)>,
}

impl Growth {
    fn from_coefficients(coefficients: &[Rational]) -> Option<Self> {
        /// Number of the last coefficients, of which the largest counts.
        const LAST: usize = 12;
        let highest = coefficients.len().checked_sub(1)?;
        if highest < FEWEST {
            return None;
        }
        let size = |(k, value): (usize, &Rational)| Some((k, logarithm(value)?));
        let mut sizes: Vec<(usize, f64)> =
            coefficients.iter().enumerate().filter_map(size).collect();
        let last = sizes.iter().filter(|(k, _)| *k > 0 && k + LAST > highest);
        let root = last.map(|(k, size)| -size / *k as f64).reduce(f64::min)?;
        let unit = (root / std::f64::consts::LN_2).round();
        for (k, size) in &mut sizes {
            *size += *k as f64 * unit * std::f64::consts::LN_2;
        }
        let count = highest as f64;
        Some(Self {
            radius: (root - unit * std::f64::consts::LN_2).exp(),
            // Besides the power of the radius, coefficients have a power of k as a factor, hence
            // log(k)/k.
            margin: 5.0 * count.ln() / count + 0.05,
            unit: unit as i64,
            sizes,
        })
    }

    fn allows(&self, size: f64) -> bool {
        (size / self.radius).ln().abs() <= self.margin
    }

    /// Returns the power of `k` with which `|c_k| radius^k` grows: `-e - 1` for a singularity like
    /// `(s - s_0)^e` on the circle. It compares the largest coefficient of the last three tenths
    /// with that of the three tenths before, since the coefficients of a conjugate pair oscillate.
    fn power(&self, radius: f64) -> Option<f64> {
        let highest = self.sizes.last()?.0 as f64;
        let largest = |from: f64, to: f64| {
            let within = self.sizes.iter().map(|(k, size)| (*k as f64, size));
            let within = within.filter(|(k, _)| *k > from * highest && *k <= to * highest);
            within.map(|(k, size)| (k, size + k * radius.ln())).max_by(|a, b| a.1.total_cmp(&b.1))
        };
        let (before, last) = (largest(0.4, 0.7)?, largest(0.7, 1.0)?);
        Some((last.1 - before.1) / (last.0 / before.0).ln())
    }
}

/// The natural logarithm of the absolute value; `None` for zero.
fn logarithm(value: &Rational) -> Option<f64> {
    Some(Scaled::of_fraction(value).logarithm()).filter(|logarithm| logarithm.is_finite())
}

/// Returns the last power of a polynomial, which is recognized by at least as many vanishing
/// coefficients behind it as there are up to it; `None` for any other series.
///
/// ```
/// # use lindstedt_series as lindstedt;
/// use lindstedt::{exact::ratio, series::singularity::last_power};
///
/// let mut coefficients = vec![ratio(0, 1); 40];
/// coefficients[0] = ratio(1, 1);
/// coefficients[3] = ratio(-2, 5);
/// assert_eq!(last_power(&coefficients), Some(3));
/// ```
pub fn last_power(coefficients: &[Rational]) -> Option<usize> {
    let last = coefficients.iter().rposition(|value| !value.is_zero())?;
    (coefficients.len() > FEWEST && 2 * (last + 1) <= coefficients.len()).then_some(last)
}

/// Whether the coefficients fall faster than the powers of any number: the function has no
/// singularity then, and its series converges everywhere. The slope of `-log |c_k|` is
/// `log R + p/k` on a circle of convergence; for an entire function it grows with `log k`, by as
/// much over one doubling of k as over the next. The test must also hold without the last sixth and
/// without the last third of the coefficients.
pub fn is_entire(coefficients: &[Rational]) -> bool {
    /// The smallest number of coefficients that can show it.
    const FEWEST: usize = 24;
    let count = coefficients.len();
    let mut lengths = [count, count - count / 6, count - count / 3].into_iter();
    count >= FEWEST && lengths.all(|length| steepens_evenly(&coefficients[..length]))
}

fn steepens_evenly(coefficients: &[Rational]) -> bool {
    /// Least increase of the slope over one doubling of the power; an entire function of order two
    /// has 0.35.
    const STEEPER: f64 = 0.28;
    /// Largest ratio of the increases over two successive doublings.
    const EVENLY: f64 = 2.0;
    // The largest coefficient of each half counts, since those of a conjugate pair oscillate.
    let slope = |from: usize, to: usize| {
        let middle = usize::midpoint(from, to);
        let largest = |range: std::ops::Range<usize>| {
            let sizes = range.filter_map(|k| Some((k, logarithm(&coefficients[k])?)));
            sizes.max_by(|a, b| a.1.total_cmp(&b.1))
        };
        let (first, last) = (largest(from..middle)?, largest(middle..to)?);
        Some((first.1 - last.1) / (last.0 - first.0) as f64)
    };
    let count = coefficients.len();
    let slopes =
        [slope(count / 8, count / 4), slope(count / 4, count / 2), slope(count / 2, count)];
    match slopes {
        [Some(first), Some(second), Some(third)] => {
            let (before, after) = (second - first, third - second);
            after > STEEPER && before * EVENLY > after && before < EVENLY * after
        }
        _ => false,
    }
}

/// The equation that an approximant solves.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ApproximantKind {
    Quadratic,
    Differential,
    /// The differential approximant of `f^(-1/2)`.
    OfInverseRoot,
}

const KINDS: [ApproximantKind; 3] =
    [ApproximantKind::Quadratic, ApproximantKind::Differential, ApproximantKind::OfInverseRoot];

impl ApproximantKind {
    /// Number of equations for this many coefficients.
    fn length(self, coefficients: usize) -> usize {
        match self {
            Self::Quadratic => coefficients,
            Self::Differential | Self::OfInverseRoot => coefficients - 1,
        }
    }
}

/// The field of floating-point numbers of one precision.
struct Floats {
    bits: usize,
}

impl Field for Floats {
    type Element = BigFloat;

    fn zero(&self) -> BigFloat {
        BigFloat::zero(self.bits)
    }
    fn one(&self) -> BigFloat {
        BigFloat::of_f64(1.0, self.bits)
    }
    fn quotient(&self, numerator: &BigFloat, denominator: &BigFloat) -> BigFloat {
        numerator / denominator
    }
    fn subtract(&self, number: &mut BigFloat, factor: &BigFloat, other: &BigFloat) {
        if !other.is_zero() {
            *number = &*number - &(factor * other);
        }
    }
    fn exponent(&self, number: &BigFloat) -> Option<i64> {
        number.exponent()
    }
    fn noise(&self) -> Option<i64> {
        Some(self.bits as i64 * 3 / 4)
    }
}

/// An approximant by its polynomials.
struct Approximant {
    kind: ApproximantKind,
    /// The factors of one, of the series, and of its square or its derivative.
    factors: [Vec<BigFloat>; 3],
}

/// Returns the approximants to the orders that lie `below` the highest, each with that difference.
fn approximants(
    kind: ApproximantKind,
    coefficients: &[BigFloat],
    below: &[usize],
) -> Vec<(usize, Approximant)> {
    let bits = coefficients[0].bits();
    let field = Floats { bits };
    let length = kind.length(coefficients.len());
    let mut constant = vec![BigFloat::zero(bits); length];
    constant[0] = field.one();
    let mut own = match kind {
        ApproximantKind::Quadratic | ApproximantKind::Differential => coefficients.to_vec(),
        ApproximantKind::OfInverseRoot => inverse_root(coefficients),
    };
    let last = match kind {
        ApproximantKind::Quadratic => product(&own, &own, length),
        ApproximantKind::Differential | ApproximantKind::OfInverseRoot => {
            (1..=length).map(|k| &own[k] * &BigFloat::of_f64(k as f64, bits)).collect()
        }
    };
    own.truncate(length);
    let mut work = HermitePade::new(field, vec![(constant, 0), (own, 0), (last, 0)]);
    let mut found = vec![];
    while work.order() < length {
        work.advance();
        if below.contains(&(length - work.order())) {
            let factors = work.best().factors.clone().try_into();
            let approximant = factors.ok().map(|factors| Approximant { kind, factors });
            found.extend(approximant.map(|own| (length - work.order(), own)));
        }
    }
    found
}

/// Returns the coefficients of `(f/c_0)^(-1/2)`: `n c_0 g_n = sum_(k=1..n) (k/2 - n) c_k g_(n-k)`.
fn inverse_root(coefficients: &[BigFloat]) -> Vec<BigFloat> {
    let bits = coefficients[0].bits();
    let mut root = vec![BigFloat::of_f64(1.0, bits)];
    for n in 1..coefficients.len() {
        let mut sum = BigFloat::zero(bits);
        for k in 1..=n {
            let weight = BigFloat::of_f64(0.5 * k as f64 - n as f64, bits);
            sum = &sum + &(&(&weight * &coefficients[k]) * &root[n - k]);
        }
        root.push(&sum / &(&BigFloat::of_f64(n as f64, bits) * &coefficients[0]));
    }
    root
}

/// The product, cut off after `most` coefficients.
fn product(left: &[BigFloat], right: &[BigFloat], most: usize) -> Vec<BigFloat> {
    let Some(length) =
        (left.len() + right.len()).checked_sub(1).filter(|_| !left.is_empty() && !right.is_empty())
    else {
        return vec![];
    };
    let mut product = vec![BigFloat::zero(left[0].bits()); length.min(most)];
    for (i, left) in left.iter().enumerate() {
        for (sum, right) in product.iter_mut().skip(i).zip(right) {
            *sum = &*sum + &(left * right);
        }
    }
    product
}

/// A zero that stays from one approximant to the next.
struct PersistentZero {
    kind: ApproximantKind,
    place: Complex,
    error: f64,
    /// The exponent by a differential approximant, with its error.
    exponent: Option<(f64, f64)>,
}

impl PersistentZero {
    /// Returns the power of the distance with which f is singular there; `None` if it is not known.
    fn power_of_function(&self) -> Option<f64> {
        match (self.kind, self.exponent) {
            (ApproximantKind::Quadratic, _) => Some(0.5),
            (ApproximantKind::Differential, Some((value, _))) => Some(value),
            (ApproximantKind::OfInverseRoot, Some((value, _))) if value < 0.0 => Some(-2.0 * value),
            (ApproximantKind::OfInverseRoot, Some((value, _))) => Some(value),
            (_, None) => None,
        }
    }

    /// Returns the order of a zero of f, at which `f^(-1/2)` has the power -1/2, -1, ...: the
    /// period is infinite there, but omega^2 is regular. `None` if the power is another.
    fn order_of_zero(&self) -> Option<f64> {
        let (value, error) =
            self.exponent.filter(|_| self.kind == ApproximantKind::OfInverseRoot)?;
        let order = (-2.0 * value).round();
        (order >= 1.0 && (-2.0 * value - order).abs() <= (4.0 * error).max(WORST_POWER))
            .then_some(order)
    }

    /// Whether f is regular there, as far as this approximant and the zeros of f can tell.
    fn is_regular(&self, zeros: &[(Complex64, f64)]) -> bool {
        match (self.kind, self.exponent) {
            (ApproximantKind::OfInverseRoot, Some((_, error))) => {
                error > WORST_POWER || self.order_of_zero().is_some()
            }
            (ApproximantKind::OfInverseRoot, None) => true,
            // The power is that of the zero itself; a singularity at a zero has another power.
            (ApproximantKind::Differential, Some((value, _))) => {
                let place = self.place.to_f64();
                let here =
                    |zero: &&(Complex64, f64)| (zero.0 - place).norm() <= MOVES * place.norm();
                zeros.iter().filter(here).any(|(_, order)| (value - order).abs() <= WORST_POWER)
            }
            _ => false,
        }
    }
}

/// Largest error of a power of the distance that still identifies a singularity.
const WORST_POWER: f64 = 0.1;

/// A zero of one approximant.
struct Zero {
    place: Complex,
    exponent: Option<Complex64>,
}

/// Returns the zeros that all, or all but a few, of the approximants of one kind share.
fn followed(
    kind: ApproximantKind,
    coefficients: &[BigFloat],
    growth: &Growth,
) -> Vec<PersistentZero> {
    /// Number of coefficients from which doubles give a first estimate.
    const FIRST: usize = 48;
    let length = kind.length(coefficients.len());
    let window = (length / 8).max(3);
    let first = length.saturating_sub(FIRST);
    let starts = [first, first + 2, first + 4];
    let wanted: Vec<usize> = starts.into_iter().chain(0..=2 * window).collect();
    let all = approximants(kind, coefficients, &wanted);
    let at = |below: usize| all.iter().find(|own| own.0 == below).map(|own| &own.1);
    let follow = |start: Complex64| -> Option<PersistentZero> {
        /// Number of approximants of which one may lack the zero.
        const LACKING: usize = 6;
        let mut near = Complex::from_complex64(start, coefficients[0].bits());
        let mut missed = 0;
        for below in starts {
            match at(below).and_then(|own| own.zero_near(&near)) {
                Some(zero) => near = zero.place,
                None if missed == 0 => missed = 1,
                None => return None,
            }
        }
        let mut zeros: Vec<(usize, Zero)> = vec![];
        for below in (0..=2 * window).rev() {
            let from = zeros.last().map_or(&near, |(_, zero)| &zero.place);
            let found = at(below).and_then(|own| own.zero_near(from));
            zeros.extend(found.map(|zero| (below, zero)));
            let done = 2 * window + 1 - below;
            if done - zeros.len() > 1 + done / LACKING {
                return None;
            }
        }
        let (_, end) = zeros.pop()?;
        let error_of = |distance: &dyn Fn(&Zero, &Zero) -> f64| {
            let farthest = |from: usize, to: usize| {
                let some = zeros.iter().filter(|(below, _)| (from..=to).contains(below));
                some.map(|(_, zero)| distance(zero, &end)).fold(0.0, f64::max)
            };
            let (recent, before) = (farthest(0, window), farthest(window + 1, 2 * window));
            // The error of a slowly converging sequence is larger than its last steps.
            if 8.0 * recent <= before { FAST * recent } else { SLOW * recent }
        };
        let exponent = end.exponent.map(|value| {
            let distance = |one: &Zero, other: &Zero| match (one.exponent, other.exponent) {
                (Some(one), Some(other)) => (one - other).norm(),
                _ => 1.0,
            };
            (value.re, error_of(&distance).max(value.im.abs()))
        });
        Some(PersistentZero {
            kind,
            error: error_of(&|one, other| one.place.distance(&other.place)),
            place: end.place,
            exponent,
        })
    };
    let mut candidates: Vec<Complex64> = vec![];
    for below in starts {
        let Some(approximant) = at(below) else {
            continue;
        };
        for candidate in candidates_of(&approximant.polynomial(), growth) {
            if candidates.iter().all(|other| (other - candidate).norm() > MOVES * candidate.norm())
            {
                candidates.push(candidate);
            }
        }
    }
    let found = candidates.into_iter().filter_map(follow);
    found.filter(|found| growth.allows(found.place.to_f64().norm())).collect()
}

/// Ratio of the error to the last step for slow convergence, in which a step is an eighth of the
/// way, and for fast convergence.
const SLOW: f64 = 8.0;
const FAST: f64 = 4.0;

/// Relative change up to which zeros of two approximants count as the same.
const MOVES: f64 = 0.05;

impl Approximant {
    /// Returns the polynomial that vanishes at a singularity, D or P.
    fn polynomial(&self) -> Vec<BigFloat> {
        let [of_one, of_series, last] = &self.factors;
        if self.kind != ApproximantKind::Quadratic {
            return last.clone();
        }
        let mut polynomial = product(of_series, of_series, usize::MAX);
        for (place, value) in product(of_one, last, usize::MAX).iter().enumerate() {
            polynomial.resize(polynomial.len().max(place + 1), BigFloat::zero(value.bits()));
            polynomial[place] = &polynomial[place] - &value.shifted(2);
        }
        polynomial
    }

    /// Returns the first Taylor coefficients of that polynomial about a place; those of D follow
    /// from those of its factors with fewer products than its own coefficients.
    fn derivatives<const COUNT: usize>(&self, place: &Complex) -> [Complex; COUNT] {
        let [of_one, of_series, last] = &self.factors;
        if self.kind != ApproximantKind::Quadratic {
            return derivatives(last, place);
        }
        let [p, q, r]: [[Complex; COUNT]; 3] =
            [of_one, of_series, last].map(|factor| derivatives(factor, place));
        std::array::from_fn(|k| {
            let zero = Complex::from_complex64(Complex64::default(), place.re.bits());
            (0..=k).fold(zero, |sum, i| {
                let product = &p[i] * &r[k - i];
                let four = Complex { re: product.re.shifted(2), im: product.im.shifted(2) };
                &sum + &(&(&q[i] * &q[k - i]) - &four)
            })
        })
    }

    /// Returns the zero to which Newton's iteration leads from a place near it; `None` if the
    /// iteration moves away, or if another zero is close, which is typical of a point that is not a
    /// branch point.
    fn zero_near(&self, start: &Complex) -> Option<Zero> {
        const ITERATIONS: usize = 60;
        const APART: f64 = 1e-3;
        /// Largest number of binary digits that a step of the iteration tells to be right.
        const DIGITS: usize = 900;
        let bits = start.re.bits();
        let size = start.to_f64().norm();
        // The error after a step is some square of it: with a third of the digits it is beyond what
        // any two approximants agree in.
        let enough = 2.0_f64.powi(-(DIGITS.min(bits / 3) as i32)) * size;
        let mut place = start.clone();
        let mut last = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let [value, slope] = self.derivatives(&place);
            if value.squared_size().is_zero() {
                last = 0.0;
                break;
            }
            let step = value.divided_by(&slope);
            let length = step.squared_size().sqrt()?.to_f64();
            // Rounding keeps changing the last digits: the iteration has converged.
            if length >= last && length < 1e-12 * size {
                break;
            }
            place = &place - &step;
            last = length;
            if place.distance(start) > MOVES * size || length <= enough {
                break;
            }
        }
        let [_, slope, bend] = self.derivatives(&place);
        let settled = place.distance(start) <= MOVES * size && last < 1e-9 * size;
        let apart = 2.0 * slope.divided_by(&bend).to_f64().norm() > APART * size
            || bend.squared_size().is_zero();
        (settled && apart).then(|| Zero {
            exponent: (self.kind != ApproximantKind::Quadratic).then(|| {
                let [value] = derivatives(&self.factors[1], &place);
                -value.divided_by(&slope).to_f64()
            }),
            place: if start.im.is_zero() {
                Complex { im: BigFloat::zero(bits), ..place }
            } else {
                place
            },
        })
    }
}

/// Returns the first Taylor coefficients of a polynomial about a place: the value, the slope, half of
/// the second derivative.
fn derivatives<const COUNT: usize>(polynomial: &[BigFloat], place: &Complex) -> [Complex; COUNT] {
    let zero = Complex::from_complex64(Complex64::default(), place.re.bits());
    let mut found = std::array::from_fn(|_| zero.clone());
    for coefficient in polynomial.iter().rev() {
        for order in (1..COUNT).rev() {
            found[order] = &(&found[order] * place) + &found[order - 1];
        }
        found[0] = &found[0] * place;
        found[0].re = &found[0].re + coefficient;
    }
    found
}

/// Returns zeros of a polynomial near the circle of convergence in the upper half plane, by
/// Newton's iteration from a lattice of starting points.
fn candidates_of(polynomial: &[BigFloat], growth: &Growth) -> Vec<Complex64> {
    const RADII: usize = 15;
    const ANGLES: usize = 25;
    const ITERATIONS: usize = 40;
    let Some(largest) = polynomial.iter().filter_map(BigFloat::exponent).max() else {
        return vec![];
    };
    let numbers: Vec<f64> =
        polynomial.iter().map(|value| value.shifted(-largest).to_f64()).collect();
    let evaluate = |z: Complex64| {
        let zero = Complex64::default();
        numbers
            .iter()
            .rev()
            .fold((zero, zero), |(value, slope), number| (value * z + number, slope * z + value))
    };
    let mut found: Vec<Complex64> = vec![];
    for radius in 0..RADII {
        let radius = growth.radius
            * ((radius as f64 / (RADII - 1) as f64 * 2.0 - 1.0) * growth.margin).exp();
        for angle in 0..ANGLES {
            let mut z = Complex64::from_polar(
                radius,
                angle as f64 / (ANGLES - 1) as f64 * std::f64::consts::PI,
            );
            if angle == 0 || angle + 1 == ANGLES {
                z.im = 0.0;
            }
            let mut length = f64::INFINITY;
            for _ in 0..ITERATIONS {
                let (value, slope) = evaluate(z);
                let step = value / slope;
                z -= step;
                length = step.norm();
                if length <= 1e-14 * z.norm() || !z.is_finite() {
                    break;
                }
            }
            let size = z.norm();
            if !z.is_finite() || length > 1e-6 * size || !growth.allows(size) {
                continue;
            }
            z.im = if z.im.abs() < 1e-7 * size { 0.0 } else { z.im.abs() };
            if found.iter().all(|other| (other - z).norm() > 1e-5 * size) {
                found.push(z);
            }
        }
    }
    found
}

/// Whether every kind of approximant has found one place, the same within their errors, at which
/// the power may be that of a square root, which all kinds can represent; `seen` are the places
/// found from `f^(-1/2)` with their errors, whose power may not be known yet.
fn all_agree(found: &[PersistentZero], seen: &[(Complex, f64)]) -> bool {
    let has = |kind: ApproximantKind| found.iter().any(|own| own.kind == kind);
    let is_root = |own: &PersistentZero| match (own.kind, own.exponent) {
        (ApproximantKind::Differential, Some((value, error))) => {
            error <= WORST_POWER && (value - 0.5).abs() <= error
        }
        _ => true,
    };
    let together = |one: &PersistentZero| {
        let near = |place: &Complex, error: f64| one.place.distance(place) <= one.error + error;
        found.iter().all(|other| near(&other.place, other.error))
            && seen.iter().any(|other| near(&other.0, other.1))
    };
    has(ApproximantKind::Quadratic)
        && has(ApproximantKind::Differential)
        && found.iter().all(|own| is_root(own) && together(own))
}

/// Returns the nearest of the singularities that the kinds of approximants have found, with an
/// error that covers their differences.
fn singularity(found: Vec<PersistentZero>, growth: &Growth, bits: usize) -> Option<Singularity> {
    /// Largest error of an exponent that is returned.
    const WORST_EXPONENT: f64 = 0.02;
    /// Largest relative error of a place.
    const WORST: f64 = 0.05;
    /// Number of coefficients that determine a singularity of unknown exponent.
    const MANY: usize = 32;
    /// Powers of the period below this may come from a logarithm.
    const SMALL_POWER: f64 = 0.2;
    /// The factor on the error of a singularity with such a power.
    const SLOWEST: f64 = 10.0;
    let size_of = |own: &PersistentZero| own.place.to_f64().norm();
    // Excess of the growth of the coefficients over that due to the singularity, both as powers of
    // k, divided by its uncertainty.
    let excess = |own: &PersistentZero| {
        let power = own.power_of_function()? + 1.0;
        Some((growth.power(size_of(own))? + power) / (1.25 + 0.25 * power.abs()))
    };
    let zero = |own: &PersistentZero| Some((own.place.to_f64(), own.order_of_zero()?));
    let zeros: Vec<(Complex64, f64)> = found.iter().filter_map(zero).collect();
    let of_inverse_root = found.iter().filter(|own| own.kind == ApproximantKind::OfInverseRoot);
    let seen: Vec<(Complex, f64)> = of_inverse_root
        .filter(|own| own.order_of_zero().is_none() && own.error <= WORST * size_of(own))
        .map(|own| (own.place.clone(), own.error))
        .collect();
    let singular =
        |own: &PersistentZero| !own.is_regular(&zeros) && own.error <= WORST * size_of(own);
    // A zero that would make the coefficients larger than they are is not a singularity.
    let found: Vec<(PersistentZero, f64)> = found
        .into_iter()
        .filter(singular)
        .filter_map(|own| excess(&own).map(|excess| (own, excess)))
        .filter(|(_, excess)| *excess >= -1.0)
        .collect();
    // At least one must account for the size of the coefficients; otherwise a nearer singularity
    // may be hidden.
    if !found.iter().any(|(_, excess)| *excess <= 1.0) {
        return None;
    }
    let nearest =
        found.iter().map(|(own, _)| size_of(own) + own.error).fold(f64::INFINITY, f64::min);
    let on_circle = |own: &PersistentZero| size_of(own) - own.error <= nearest * (1.0 + MOVES);
    let mut found: Vec<PersistentZero> =
        found.into_iter().map(|(own, _)| own).filter(on_circle).collect();
    let exponent_by = |found: &[PersistentZero], wanted: ApproximantKind| {
        let own = found.iter().filter(|own| own.kind == wanted);
        let best = own.min_by(|a, b| a.error.total_cmp(&b.error))?;
        best.exponent.filter(|(_, error)| *error < WORST_EXPONENT)
    };
    let exponent = exponent_by(&found, ApproximantKind::OfInverseRoot);
    let power = exponent_by(&found, ApproximantKind::Differential);
    // Quadratic approximants cannot represent a singularity other than a square root, nor those of
    // omega^2 a logarithm of the period.
    if [exponent, power]
        .into_iter()
        .flatten()
        .any(|(value, error)| (value - 0.5).abs() > 2.0 * error)
    {
        let others = found.iter().any(|own| own.kind != ApproximantKind::Quadratic);
        found.retain(|own| own.kind != ApproximantKind::Quadratic || !others);
    }
    if exponent.is_some_and(|(value, error)| value.abs() <= error) {
        found.retain(|own| own.kind != ApproximantKind::Differential);
    }
    let best = found.iter().min_by(|a, b| a.error.total_cmp(&b.error))?;
    let size = best.place.to_f64().norm();
    let mut error = best.error;
    for other in &found {
        let distance = other.place.distance(&best.place);
        let same = distance <= MOVES * size;
        if same && distance > best.error + other.error {
            error = error.max(distance);
        }
        // Two different places with errors of a similar size are ambiguous.
        if !same && other.error < 100.0 * best.error.max(1e-6 * size) {
            return None;
        }
    }
    // With few coefficients a singularity of unknown power may be one of several, unless all kinds
    // have found only this one.
    let few = growth.sizes.last().is_none_or(|(highest, _)| *highest < MANY);
    if exponent.is_none() && few && !all_agree(&found, &seen) {
        return None;
    }
    // Convergence is slow towards powers of a logarithm, which look like a small power, and towards
    // singularities without a recognizable power.
    if exponent.is_none_or(|(value, error)| value.abs() > error && value.abs() < SMALL_POWER) {
        error *= SLOWEST;
    }
    // An exact approximant does not move at all, so the error is at least a bound of rounding.
    error = error.max(size * (-(bits as f64) / 6.0).exp2());
    if error > WORST * size {
        return None;
    }
    let unit = (growth.unit as f64).exp2();
    let estimate = |value: &BigFloat, error: f64| {
        Estimate::rounded(&value.shifted(growth.unit).to_fraction(), error * unit)
    };
    let real = best.place.im.is_zero();
    let angle = best.place.im.angle(&best.place.re);
    Some(Singularity {
        radius: estimate(&best.place.squared_size().sqrt()?, error),
        angle: Estimate::rounded(&angle.to_fraction(), if real { 0.0 } else { error / size }),
        place: [
            estimate(&best.place.re, error),
            estimate(&best.place.im, if real { 0.0 } else { error }),
        ],
        // The exponent was computed in doubles.
        exponent: exponent.map(|(value, error)| {
            Estimate::rounded(&BigFloat::of_f64(value, 64).to_fraction(), error.max(1e-12))
        }),
    })
}

impl Singularity {
    /// Returns `Greater` on the positive axis and `Less` on the negative one; `None` for a
    /// conjugate pair.
    pub fn sign(&self) -> Option<Ordering> {
        let [real, imaginary] = &self.place;
        imaginary.value.is_zero().then(|| real.value.cmp(&Rational::zero()))
    }
}

/// Writes the decimals that the error leaves, without trailing zeros.
impl fmt::Display for Estimate {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&plain_decimal(&self.value, MOST_DECIMALS))
    }
}

/// Largest number of decimals of an estimate.
const MOST_DECIMALS: usize = 400;

impl Estimate {
    /// Rounds a value to the last decimal that its error leaves, and adds the rounding to the
    /// error; to twenty decimals if the error is zero.
    pub fn rounded(value: &Rational, error: f64) -> Self {
        let digit = match error > 0.0 {
            true => (error.log10().ceil() as i32).max(-(MOST_DECIMALS as i32)),
            false => -20,
        };
        let ten = num_traits::Pow::pow(Rational::from_integer(10.into()), digit);
        let rounded = match value.is_zero() {
            true => value.clone(),
            false => (value / &ten).round() * ten,
        };
        let error = match error > 0.0 {
            true => error + to_f64(&(value - &rounded)).abs(),
            false => error,
        };
        Self { value: rounded, error }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::rational::ratio;

    /// `(1 - s/place)^power` to a degree.
    fn power(place: &Rational, power: &Rational, degree: usize) -> Vec<Rational> {
        let mut coefficients = vec![ratio(1, 1)];
        for k in 1..=degree as i64 {
            let last = &coefficients[k as usize - 1];
            coefficients.push(last * (ratio(k - 1, 1) - power) / (ratio(k, 1) * place));
        }
        coefficients
    }

    fn exponential(rate: &Rational, degree: usize) -> Vec<Rational> {
        let mut coefficients = vec![ratio(1, 1)];
        for k in 1..=degree as i64 {
            coefficients.push(&coefficients[k as usize - 1] * rate / ratio(k, 1));
        }
        coefficients
    }

    fn times(left: &[Rational], right: &[Rational]) -> Vec<Rational> {
        let term = |n: usize| (0..=n).map(|k| &left[k] * &right[n - k]).sum();
        (0..left.len()).map(term).collect()
    }

    fn plus(left: &[Rational], right: &[Rational]) -> Vec<Rational> {
        left.iter().zip(right).map(|(a, b)| a + b).collect()
    }

    /// The error is never larger than its estimate and the rounding to it, whatever the singularity
    /// and the degree.
    #[test]
    fn the_error_is_what_is_said() {
        let (near, far) = (ratio(-7, 5), ratio(9, 4));
        for degree in [16, 21, 27, 36, 50] {
            for exponent in [ratio(1, 2), ratio(-1, 1), ratio(-1, 2), ratio(1, 3), ratio(-3, 2)] {
                // A singular part that is more than a power, a regular part, and a second
                // singularity beyond.
                let singular =
                    times(&power(&near, &exponent, degree), &exponential(&ratio(1, 3), degree));
                let beyond =
                    times(&power(&far, &ratio(1, 4), degree), &exponential(&ratio(-1, 2), degree));
                let Some(found) = nearest(&plus(&singular, &beyond)) else {
                    assert!(degree < 30, "{degree} {exponent}");
                    continue;
                };
                let error = to_f64(&(&found.radius.value + &near)).abs();
                assert!(error <= found.radius.error, "{degree} {exponent}: {found:?}");
                assert_eq!(found.sign(), Some(Ordering::Less));
                assert!(degree < 36 || error < 1e-6, "{degree} {exponent}: {found:?}");
            }
        }
    }

    /// `sqrt(1 - 2 s cos(phi)/R + s^2/R^2)` times an exponential: branch points at `R e^(+-i phi)`,
    /// with `cos(phi) = 3/5`.
    #[test]
    fn a_pair_has_its_angle() {
        let (cosine, radius) = (ratio(3, 5), ratio(5, 2));
        let mut root = vec![ratio(1, 1)];
        // The square of the series is the polynomial.
        let square = [ratio(1, 1), ratio(-2, 1) * &cosine / &radius, (&radius * &radius).recip()];
        for n in 1..=60 {
            let own = square.get(n).cloned().unwrap_or_else(Rational::zero);
            let others: Rational = (1..n).map(|k| &root[k] * &root[n - k]).sum();
            root.push((own - others) / ratio(2, 1));
        }
        let found = nearest(&times(&root, &exponential(&ratio(1, 2), 60))).expect("a pair");
        assert!(found.radius.error < 1e-12, "{found:?}");
        assert!(to_f64(&(&found.radius.value - &radius)).abs() <= found.radius.error, "{found:?}");
        let angle = to_f64(&found.angle.value);
        assert!((angle.cos() - 0.6).abs() < 1e-12 && found.sign().is_none(), "{found:?}");
        assert!(to_f64(&(&found.place[0].value - ratio(3, 2))).abs() < 1e-12, "{found:?}");
        // The root of the series is that of the root.
        assert_eq!(found.exponent.expect("a power").value, ratio(-1, 4));
    }

    /// Few coefficients give a right result or none: pairs of all angles and powers, with a real
    /// singularity near them, at their own distance or within it.
    #[test]
    fn few_coefficients_say_what_is_so_or_nothing() {
        for degree in [20, 29] {
            for (cosine, sine) in [(3, 4), (-24, 7)] {
                let size = (f64::from(cosine * cosine + sine * sine)).sqrt().round() as i64;
                let cosine = ratio(i64::from(cosine), size);
                for exponent in [ratio(1, 2), ratio(1, 3), ratio(-1, 2), ratio(1, 10)] {
                    for beyond in [ratio(19, 5), ratio(-13, 5), ratio(12, 1)] {
                        // (1 - 2 s cos(phi)/R + s^2/R^2)^e by n c_n = 2 cos(phi)/R (n - 1 - e)
                        // c_(n-1) - (n - 2 - 2 e) c_(n-2)/R^2
                        let radius = ratio(5, 2);
                        let mut pair = vec![ratio(1, 1)];
                        for n in 1..=degree as i64 {
                            let last = &pair[n as usize - 1];
                            let step = ratio(2, 1) * &cosine / &radius
                                * (ratio(n - 1, 1) - &exponent)
                                * last;
                            let before = match n {
                                1 => ratio(0, 1),
                                _ => {
                                    let weight = ratio(n - 2, 1) - ratio(2, 1) * &exponent;
                                    weight * &pair[n as usize - 2] / (&radius * &radius)
                                }
                            };
                            pair.push((step - before) / ratio(n, 1));
                        }
                        let whole = times(&pair, &exponential(&ratio(1, 3), degree));
                        let other = times(
                            &power(&beyond, &ratio(1, 3), degree),
                            &exponential(&ratio(-1, 4), degree),
                        );
                        let Some(found) = nearest(&plus(&whole, &other)) else {
                            continue;
                        };
                        let true_radius = to_f64(&radius).min(to_f64(&beyond).abs());
                        let error = (to_f64(&found.radius.value) - true_radius).abs();
                        assert!(
                            error <= found.radius.error,
                            "{degree} {cosine} {exponent} {beyond}: {found:?}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn what_shows_no_law_has_none() {
        // An entire function, noise, a polynomial, and too few coefficients.
        let mut state = 1_i64;
        let mut random = || {
            state = state * 48_271 % 2_147_483_647;
            ratio(state % 31 - 15, 1)
        };
        let noise: Vec<Rational> = (0..40).map(|_| random()).collect();
        let polynomial: Vec<Rational> = (0..40).map(|k| ratio(i64::from(k < 5), 1)).collect();
        let few = power(&ratio(2, 1), &ratio(1, 2), FEWEST - 1);
        for coefficients in [exponential(&ratio(1, 1), 40), noise, polynomial, few] {
            assert_eq!(nearest(&coefficients), None);
        }
    }

    #[test]
    fn an_exact_relation_is_exact() {
        // A root without anything beside it: every approximant is the function itself.
        let found = nearest(&power(&ratio(3, 2), &ratio(1, 2), 40)).expect("a branch point");
        assert_eq!(found.radius.value, ratio(3, 2));
        assert!(found.radius.error < 1e-15, "{found:?}");
    }
}
