//! Polynomials on a step: their values, and the roots of the series of an event.

use std::sync::OnceLock;

use pulp::{Arch, Simd, WithSimd};

use crate::numeric::ode::root::find_root;

/// The value at `s`.
pub(super) fn value(series: &[f64], s: f64) -> f64 {
    series.iter().rev().fold(0.0, |sum, coefficient| sum * s + coefficient)
}

/// Appends the values at several places, equal to those of [`value`]. Many sums are computed side
/// by side, so that no addition waits for the one before it.
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
        const FEW: usize = 8;
        const MANY: usize = 32;
        let Self { series, places, into } = self;
        match places.len() <= FEW {
            true => add_values::<FEW>(series, places, into),
            false => places.chunks(MANY).for_each(|own| add_values::<MANY>(series, own, into)),
        }
    }
}

/// Appends the values at no more than `N` places.
#[inline(always)]
fn add_values<const N: usize>(series: &[f64], places: &[f64], into: &mut Vec<f64>) {
    let (mut at, mut sums) = ([0.0; N], [0.0; N]);
    at[..places.len()].copy_from_slice(places);
    for coefficient in series.iter().rev() {
        for (sum, place) in sums.iter_mut().zip(&at) {
            *sum = *sum * place + coefficient;
        }
    }
    into.extend_from_slice(&sums[..places.len()]);
}

/// Returns the roots after `from` up to `to` at which the polynomial changes its sign, in order, and
/// whether it grows there; a root at `from` itself does not count.
///
/// Descartes' rule of signs for the Bernstein coefficients: a polynomial has no more roots in an
/// interval than there are sign changes. With none or one the number of roots is certain, and every
/// other interval is halved (G. E. Collins, A. G. Akritas, SYMSAC 1976, 272; J. M. Lane, R. F.
/// Riesenfeld, BIT 21 (1981) 112).
pub(super) fn roots(series: &[f64], from: f64, to: f64) -> Vec<(f64, bool)> {
    let mut roots = vec![];
    sign_and_roots(series, from, to, &mut |root, rising| roots.push((root, rising)));
    roots
}

/// Returns the sign with which the search for roots begins on an interval, 0 if all coefficients are
/// zero, and hands over each of the [`roots`].
pub(super) fn sign_and_roots(
    series: &[f64],
    from: f64,
    to: f64,
    found: &mut dyn FnMut(f64, bool),
) -> f64 {
    Arch::new().dispatch(SignAndRoots { series, from, to, found })
}

/// The search for roots; it is inlined into its caller, so that sums side by side get the widest registers
/// of the processor.
struct SignAndRoots<'a> {
    series: &'a [f64],
    from: f64,
    to: f64,
    found: &'a mut dyn FnMut(f64, bool),
}

impl WithSimd for SignAndRoots<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f64 {
        let Self { series, from, to, found } = self;
        let terms = TermSizes::new(series, to.abs().max(from.abs()));
        match series.first() {
            None => 0.0,
            // Most series have no root, since the constant outweighs all other terms.
            Some(constant) if terms.constant > terms.others => constant.signum(),
            // Of the others most grow or fall throughout, since the linear term outweighs the later ones, and
            // have no more than one.
            _ => {
                let most = (2.0 * terms.linear > terms.slopes(series)).then_some(1);
                let at_start = value_in_fours(series, from + apart(from, to));
                roots_of_at_most(most, series, [from, to], at_start, found);
                sign_at_start(series, at_start)
            }
        }
    }
}

/// The sizes of the terms of a polynomial at a place.
struct TermSizes {
    /// `|c_0|`.
    constant: f64,
    /// `|c_1| s`.
    linear: f64,
    /// The sum of `|c_k| s^k` for k > 0.
    others: f64,
    /// The place.
    s: f64,
}

impl TermSizes {
    #[inline(always)]
    fn new(series: &[f64], s: f64) -> Self {
        let [first, ref behind @ ..] = *series else {
            return Self { constant: 0.0, linear: 0.0, others: 0.0, s };
        };
        Self {
            constant: first.abs(),
            linear: behind.first().map_or(0.0, |second| second.abs() * s),
            others: s * in_fours(behind, s, |_, coefficient| coefficient.abs()),
            s,
        }
    }

    /// The sum of `k |c_k| s^k`.
    #[inline(always)]
    fn slopes(&self, series: &[f64]) -> f64 {
        let behind = series.get(1..).unwrap_or(&[]);
        self.s * in_fours(behind, self.s, |k, coefficient| (k + 1.0) * coefficient.abs())
    }
}

/// `sum_k f(k, c_k) s^k` as four sums side by side, every fourth term in each, so that few additions wait for
/// others; f is 0 for a coefficient of 0.
#[inline(always)]
fn in_fours(series: &[f64], s: f64, term: impl Fn(f64, f64) -> f64) -> f64 {
    let square = s * s;
    let fourth = square * square;
    let fours = series.chunks_exact(4);
    let rest = fours.remainder();
    let mut orders = four_orders(series.len() - rest.len());
    let mut sums = [0.0; 4];
    if !rest.is_empty() {
        let mut last = [0.0; 4];
        last[..rest.len()].copy_from_slice(rest);
        for place in 0..4 {
            sums[place] = sums[place] * fourth + term(orders[place], last[place]);
        }
    }
    for four in fours.rev() {
        for place in 0..4 {
            orders[place] -= 4.0;
            sums[place] = sums[place] * fourth + term(orders[place], four[place]);
        }
    }
    (sums[0] + s * sums[1]) + square * (sums[2] + s * sums[3])
}

/// Four orders from this one on.
#[inline(always)]
fn four_orders(first: usize) -> [f64; 4] {
    [0.0, 1.0, 2.0, 3.0].map(|place| first as f64 + place)
}

/// Extends a range by the values of a polynomial between two places from 0 on: at both of them, and where its slope
/// passes through zero in between.
pub(super) fn extend_range(range: &mut [f64; 2], series: &[f64], places: [f64; 2]) {
    Arch::new().dispatch(RangeExtension { range, series, places });
}

/// The extension of a range; it is inlined into its caller, as [`SignAndRoots`].
struct RangeExtension<'a> {
    range: &'a mut [f64; 2],
    series: &'a [f64],
    places: [f64; 2],
}

impl WithSimd for RangeExtension<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        /// Number of coefficients of a slope that need no memory of their own.
        const SHORT: usize = 32;
        /// Units in the last place by which a value may exceed the sum of its terms.
        const DIGITS: f64 = 8.0;
        let Self { range, series, places: [from, to] } = self;
        let [constant, linear, ..] = *series else {
            let value = series.first().copied().unwrap_or(f64::NAN);
            *range = [range[0].min(value), range[1].max(value)];
            return;
        };
        // The values lie no farther from the straight line through the first two terms than all others reach.
        let terms = TermSizes::new(series, to);
        let end = constant + linear * to;
        let reach =
            terms.others - terms.linear + DIGITS * f64::EPSILON * (terms.constant + terms.others);
        // Most series are too far inside of the range to leave it.
        if constant.min(end) - reach >= range[0] && constant.max(end) + reach <= range[1] {
            return;
        }
        let mut extend = |value: f64| *range = [range[0].min(value), range[1].max(value)];
        extend(if from != 0.0 { value(series, from) } else { constant });
        // A polynomial whose linear term outweighs all later ones grows or falls throughout.
        let mut turn = None;
        if 2.0 * terms.linear <= terms.slopes(series) {
            let (mut short, mut long) = ([0.0; SHORT], vec![]);
            let slope = match short.get_mut(..series.len() - 1) {
                Some(short) => short,
                None => {
                    long.resize(series.len() - 1, 0.0);
                    long.as_mut_slice()
                }
            };
            write_slope(series, slope);
            let at_start = value_in_fours(slope, from + apart(from, to));
            roots_of_at_most(None, slope, [from, to], at_start, &mut |place, _| {
                if let Some(other) = turn.replace(place) {
                    extend(value(series, other));
                }
            });
        }
        match turn {
            Some(turn) => value_at_both(series, [to, turn]).into_iter().for_each(extend),
            None => extend(value(series, to)),
        }
    }
}

/// Writes the coefficients `(k + 1) c_(k+1)` of the slope.
#[inline(always)]
fn write_slope(series: &[f64], slope: &mut [f64]) {
    let mut orders = four_orders(1);
    for (own, from) in slope.chunks_mut(4).zip(series[1..].chunks(4)) {
        for ((of_slope, coefficient), order) in own.iter_mut().zip(from).zip(&orders) {
            *of_slope = order * coefficient;
        }
        orders = orders.map(|order| order + 4.0);
    }
}

/// The values at two places, equal to those of [`value`]; neither sum waits for the other.
#[inline(always)]
fn value_at_both(series: &[f64], places: [f64; 2]) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for coefficient in series.iter().rev() {
        for (sum, place) in sums.iter_mut().zip(places) {
            *sum = *sum * place + coefficient;
        }
    }
    sums
}

/// Hands over the roots of a polynomial, of which there are at most so many if that is known; `at_start` is its
/// value [`apart`] from the start of the interval.
#[inline(always)]
fn roots_of_at_most(
    mut most: Option<usize>,
    series: &[f64],
    [from, to]: [f64; 2],
    at_start: f64,
    found: &mut dyn FnMut(f64, bool),
) {
    const MOST_INTERVALS: usize = 4000;
    // Most roots are alone in the whole interval.
    let (mut next, mut open) = (Some((from, to)), Vec::new());
    for _ in 0..MOST_INTERVALS {
        let Some((low, high)) = next.take().or_else(|| open.pop()) else { break };
        let changes = match most.take() {
            Some(count) => SignChanges { count, place: None },
            None => sign_changes(series, low, high),
        };
        if changes.count > 1 && high - low > 2e-13 * (to - from) {
            let middle = 0.5 * (low + high);
            open.extend([(middle, high), (low, middle)]);
        } else if changes.count > 0 {
            let ((low, at_low), (end, at_end)) = (
                beside(series, low, [from, to], at_start),
                beside(series, high, [from, to], at_start),
            );
            let crosses = match at_end == 0.0 {
                true => at_low != 0.0 && high == to,
                false => at_low != 0.0 && at_low.signum() != at_end.signum(),
            };
            if crosses && low < high {
                let part = changes.place.unwrap_or(at_low / (at_low - at_end));
                let root = if end != high {
                    // The end of the interval is the root itself.
                    Some(high)
                } else if at_end == 0.0 {
                    Some(end)
                } else {
                    root_between(series, [low, end], at_low > 0.0, low + part * (end - low))
                };
                if let Some(root) = root {
                    found(root, at_low < 0.0);
                }
            }
        }
    }
}

/// Returns an end of an interval and the value there; beside a zero the sign is that a little further on.
#[inline(always)]
fn beside(series: &[f64], place: f64, [from, to]: [f64; 2], at_start: f64) -> (f64, f64) {
    let value = match place == from {
        true if place < to => return (place + apart(from, to), at_start),
        true => 0.0,
        false => value_in_fours(series, place),
    };
    if value == 0.0 && place < to {
        let place = place + apart(from, to);
        return (place, value_in_fours(series, place));
    }
    (place, value)
}

/// Returns the root between two places, at the first of which the polynomial is positive or not, by Newton's
/// method from a guess; where that leaves the interval or does not end, by bracketing.
#[inline(always)]
fn root_between(
    series: &[f64],
    [low, high]: [f64; 2],
    is_positive: bool,
    guess: f64,
) -> Option<f64> {
    const STEPS: usize = 8;
    let (mut low, mut high, mut place) = (low, high, guess);
    for _ in 0..STEPS {
        if !(low < place && place < high) {
            break;
        }
        let [value, slope] = value_and_slope_in_fours(series, place);
        if value == 0.0 {
            return Some(place);
        }
        match (value > 0.0) == is_positive {
            true => low = place,
            false => high = place,
        }
        let step = value / slope;
        if step.abs() <= f64::EPSILON * place.abs() {
            return Some(place);
        }
        place -= step;
    }
    bracketed_root(series, [low, high])
}

/// Returns the root between two places with values of opposite signs by bracketing.
#[inline(never)]
fn bracketed_root(series: &[f64], [low, high]: [f64; 2]) -> Option<f64> {
    find_root(|s| value_in_fours(series, s), low, high).ok()
}

/// The value at `s`, as four sums side by side.
#[inline(always)]
fn value_in_fours(series: &[f64], s: f64) -> f64 {
    in_fours(series, s, |_, coefficient| coefficient)
}

/// The value and the slope at `s`, each as four sums side by side.
#[inline(always)]
fn value_and_slope_in_fours(series: &[f64], s: f64) -> [f64; 2] {
    let square = s * s;
    let fourth = square * square;
    let (mut sums, mut slopes) = ([0.0; 4], [0.0; 4]);
    let fours = series.chunks_exact(4);
    let rest = fours.remainder();
    let mut orders = four_orders(series.len() - rest.len());
    for (place, coefficient) in rest.iter().enumerate() {
        sums[place] = *coefficient;
        slopes[place] = orders[place] * coefficient;
    }
    for four in fours.rev() {
        for place in 0..4 {
            orders[place] -= 4.0;
            sums[place] = sums[place] * fourth + four[place];
            slopes[place] = slopes[place] * fourth + orders[place] * four[place];
        }
    }
    let [value, slope] =
        [sums, slopes].map(|sums| (sums[0] + s * sums[1]) + square * (sums[2] + s * sums[3]));
    [value, slope / s]
}

/// The number of sign changes of Bernstein coefficients, and the place of the first of them.
struct SignChanges {
    count: usize,
    /// The place where the line through the coefficients on both sides is zero, as a part of the interval.
    place: Option<f64>,
}

/// Number of Bernstein coefficients that are summed side by side.
const SIDE_BY_SIDE: usize = 8;

/// The weights `C(i, k)/C(n, k)` of the coefficients of a polynomial of degree n in its Bernstein
/// coefficients, for eight i after the other and for each k up to the last of them.
type BernsteinWeights = Vec<Vec<[f64; SIDE_BY_SIDE]>>;

fn bernstein_weights(degree: usize) -> BernsteinWeights {
    // C(i, k)/C(n, k) is the product of (i - j)/(n - j) for all j < k.
    let weight = |i: usize, k: usize| {
        let factors = (0..k.min(degree)).map(|j| i.saturating_sub(j) as f64 / (degree - j) as f64);
        factors.product::<f64>()
    };
    let block = |first: usize| {
        let row = |k: usize| std::array::from_fn(|i| weight(first + i, k));
        (0..=degree.min(first + SIDE_BY_SIDE - 1)).map(row).collect()
    };
    (0..=degree).step_by(SIDE_BY_SIDE).map(block).collect()
}

/// Returns the sign changes of the Bernstein coefficients on an interval: with
/// `s = low + (high - low) u` and `p = sum_k c_k u^k` these are `b_i = sum_k C(i, k) c_k/C(n, k)`.
#[inline(always)]
fn sign_changes(series: &[f64], low: f64, high: f64) -> SignChanges {
    /// Number of degrees whose weights are kept: more than those of the series to rounding accuracy.
    const KEPT: usize = 32;
    static WEIGHTS: [OnceLock<BernsteinWeights>; KEPT] = [const { OnceLock::new() }; KEPT];
    let degree = series.len().saturating_sub(1);
    let computed;
    let weights = match WEIGHTS.get(degree) {
        Some(kept) => kept.get_or_init(|| bernstein_weights(degree)),
        None => {
            computed = bernstein_weights(degree);
            &computed
        }
    };
    let mut short = [0.0; KEPT];
    let mut long = vec![];
    let scaled = match short.get_mut(..series.len()) {
        Some(scaled) => scaled,
        None => {
            long.resize(series.len(), 0.0);
            long.as_mut_slice()
        }
    };
    scaled.copy_from_slice(series);
    if low != 0.0 {
        about(scaled, low);
    }
    let mut factor = 1.0;
    for coefficient in scaled.iter_mut().skip(1) {
        factor *= high - low;
        *coefficient *= factor;
    }
    let mut few = [[0.0; SIDE_BY_SIDE]; KEPT / SIDE_BY_SIDE];
    let mut many = vec![];
    let coefficients = match few.get_mut(..weights.len()) {
        Some(few) => few,
        None => {
            many.resize(weights.len(), [0.0; SIDE_BY_SIDE]);
            many.as_mut_slice()
        }
    };
    for (weights, sums) in weights.iter().zip(coefficients.iter_mut()) {
        let mut own = [0.0; SIDE_BY_SIDE];
        for (weights, coefficient) in weights.iter().zip(scaled.iter()) {
            for (sum, weight) in own.iter_mut().zip(weights) {
                *sum += weight * coefficient;
            }
        }
        *sums = own;
    }
    count_sign_changes(&coefficients.as_flattened()[..series.len()])
}

/// Counts the sign changes of Bernstein coefficients, the last of which is the value at the end, where a root
/// counts.
#[inline(always)]
fn count_sign_changes(coefficients: &[f64]) -> SignChanges {
    let none = SignChanges { count: 0, place: None };
    let Some(degree) = coefficients.len().checked_sub(1) else { return none };
    let Some(first) = coefficients.iter().position(|value| *value != 0.0) else {
        return SignChanges { count: 1, ..none };
    };
    let others = &coefficients[first..];
    if others.iter().fold(false, |any, value| any | (*value == 0.0) | value.is_nan()) {
        return count_sign_changes_with_zeros(coefficients);
    }
    // Without a zero among them the signs are bits.
    const SIGN: u32 = 63;
    let differ = |one: f64, other: f64| (one.to_bits() ^ other.to_bits()) >> SIGN;
    let pairs = others.iter().zip(&others[1..]);
    let count = pairs.fold(0, |count, (one, other)| count + differ(*one, *other));
    // Most polynomials have no root: all signs are one.
    if count == 0 {
        return none;
    }
    let changed = others.iter().position(|other| differ(others[0], *other) != 0);
    let place = changed.and_then(|index| {
        let (before, here) = (others.get(index.checked_sub(1)?)?, others.get(index)?);
        let between = before / (before - here);
        Some(((first + index - 1) as f64 + between) / degree as f64)
    });
    SignChanges { count: count as usize, place }
}

/// Counts the sign changes as [`count_sign_changes`]; zeros have no sign.
#[inline(never)]
fn count_sign_changes_with_zeros(coefficients: &[f64]) -> SignChanges {
    let mut changes = SignChanges { count: 0, place: None };
    let Some((last, degree)) = coefficients.last().zip(coefficients.len().checked_sub(1)) else {
        return changes;
    };
    // The last coefficient that is not zero, and its index.
    let (mut before, mut at) = (0.0, 0);
    for (index, here) in coefficients.iter().enumerate() {
        if before * here.signum() < 0.0 && *here != 0.0 {
            if changes.count == 0 {
                let between = before / (before - here) * (index - at) as f64;
                changes.place = Some((at as f64 + between) / degree as f64);
            }
            changes.count += 1;
        }
        if *here != 0.0 {
            (before, at) = (*here, index);
        }
    }
    changes.count += usize::from(*last == 0.0);
    changes
}

/// Distance from the last root within which the sign is due to rounding.
#[inline(always)]
fn apart(from: f64, to: f64) -> f64 {
    1e-14 * (to.abs() + from.abs())
}

/// Returns the sign with which the search for roots begins on an interval, where the polynomial has this value; 0 if
/// all coefficients are zero.
#[inline(always)]
fn sign_at_start(series: &[f64], at_start: f64) -> f64 {
    let leading = || series.iter().find(|value| **value != 0.0);
    match at_start {
        // The value underflows, or the interval has the length zero.
        0.0 => leading().map_or(0.0, |leading| leading.signum()),
        _ => at_start.signum(),
    }
}

/// Expands a polynomial about another centre, by Horner's scheme.
fn about(series: &mut [f64], centre: f64) {
    for first in 0..series.len() {
        for k in (first + 1..series.len()).rev() {
            series[k - 1] += centre * series[k];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_root_is_found_in_its_turn() {
        // (s - 1/10)(s - 1/5)(s - 9/10), and a double root that does not cross.
        let cubic = [-0.018, 0.29, -1.2, 1.0];
        let found = roots(&cubic, 0.0, 1.0);
        for ((place, rising), expected) in
            found.iter().zip([(0.1, true), (0.2, false), (0.9, true)])
        {
            assert!((place - expected.0).abs() < 1e-14 && *rising == expected.1, "{found:?}");
        }
        assert_eq!(found.len(), 3);
        assert_eq!(roots(&cubic, 0.1, 1.0).len(), 2);
        assert_eq!(roots(&[0.25, -1.0, 1.0], 0.0, 1.0), []);
        // Two roots a millionth apart.
        let near = roots(&[0.25 - 2.5e-13, -1.0, 1.0], 0.0, 1.0);
        assert_eq!(near.iter().map(|root| root.1).collect::<Vec<_>>(), [false, true]);
        assert!((near[0].0 - (0.5 - 5e-7)).abs() < 1e-9);
        assert!((near[1].0 - (0.5 + 5e-7)).abs() < 1e-9);
        assert_eq!(roots(&[0.0, 1.0], 0.0, 1.0), []);
        // One at the very end, where the value is exactly zero.
        assert_eq!(roots(&[-1.0, 1.0], 0.0, 1.0), [(1.0, true)]);
        assert_eq!(roots(&[1.0, -1.0], 0.0, 1.0), [(1.0, false)]);
        // One in the middle of the interval, where it is halved: (s - 1/2)(s - 3/4).
        let [(half, false), (other, true)] = roots(&[0.375, -1.25, 1.0], 0.0, 1.0)[..] else {
            panic!("two roots, the first of them falling");
        };
        assert!(half == 0.5 && (other - 0.75).abs() < 1e-15, "{half} {other}");
        // Cases that the bounds about 0 decide by themselves.
        assert_eq!(roots(&[2.0, -1.0, 0.5], 0.0, 1.0), []);
        assert_eq!(roots(&[1e-3, 1.0, 0.1], 0.0, 1.0), []);
        assert_eq!(roots(&[3.0], 0.0, 1.0), []);
        assert_eq!(roots(&[], 0.0, 1.0), []);
    }

    #[test]
    fn sign_changes_by_bits_are_those_one_after_the_other() {
        let signs =
            |bits: u32| (0..9).map(move |place| if bits >> place & 1 == 1 { -1.0 } else { 1.0 });
        for bits in 0..512_u32 {
            for zeros in [0, 1, 3] {
                let sizes =
                    (0..9).map(|place| if place < zeros { 0.0 } else { f64::from(place) + 0.5 });
                let coefficients: Vec<f64> =
                    signs(bits).zip(sizes).map(|(sign, size)| sign * size).collect();
                let [one, other] = [count_sign_changes, count_sign_changes_with_zeros]
                    .map(|count| count(&coefficients));
                assert_eq!((one.count, one.place), (other.count, other.place), "{coefficients:?}");
            }
        }
        assert_eq!(count_sign_changes(&[0.0; 3]).count, 1);
        assert_eq!(count_sign_changes(&[1.0, 0.0, -1.0]).count, 1);
        assert_eq!(count_sign_changes(&[]).count, 0);
    }

    /// Chebyshev's polynomial of degree 9 has its roots at `cos((2 k + 1) pi/18)`.
    #[test]
    fn as_many_roots_as_the_degree_are_found() {
        let chebyshev = [0.0, 9.0, 0.0, -120.0, 0.0, 432.0, 0.0, -576.0, 0.0, 256.0];
        let found = roots(&chebyshev, -1.0, 1.0);
        assert_eq!(found.len(), 9);
        for (k, (place, rising)) in found.iter().rev().enumerate() {
            let expected = ((2 * k + 1) as f64 * std::f64::consts::PI / 18.0).cos();
            assert!((place - expected).abs() < 1e-14, "{place} {expected}");
            assert_eq!(*rising, k % 2 == 0);
        }
    }

    /// Chebyshev's polynomial of degree 9 is `cos(9 arccos s)`: between two places it has its values there,
    /// and 1 or -1 if a multiple of pi lies between.
    #[test]
    fn a_range_holds_both_ends_and_every_turn_between() {
        let chebyshev = [0.0, 9.0, 0.0, -120.0, 0.0, 432.0, 0.0, -576.0, 0.0, 256.0];
        let angle = |s: f64| 9.0 * s.acos();
        for [from, to] in [[0.0, 1.0], [0.0, 0.1], [0.2, 0.5], [0.3, 0.31], [0.9, 1.0], [0.5, 0.5]]
        {
            let mut expected = [angle(from).cos(), angle(to).cos()];
            expected.sort_by(f64::total_cmp);
            let turns = (angle(to) / std::f64::consts::PI).ceil() as i32
                ..=(angle(from) / std::f64::consts::PI).floor() as i32;
            for turn in turns {
                expected[usize::from(turn % 2 == 0)] = if turn % 2 == 0 { 1.0 } else { -1.0 };
            }
            let mut range = [f64::INFINITY, f64::NEG_INFINITY];
            extend_range(&mut range, &chebyshev, [from, to]);
            let apart = |index: usize| (range[index] - expected[index]).abs();
            assert!(apart(0) < 1e-13 && apart(1) < 1e-13, "{from} {to}: {range:?} {expected:?}");
            // What lies inside is no new value.
            let mut wider = [-2.0, 2.0];
            extend_range(&mut wider, &chebyshev, [from, to]);
            assert_eq!(wider, [-2.0, 2.0]);
        }
        let mut range = [0.0, 1.0];
        extend_range(&mut range, &[3.0], [0.0, 1.0]);
        assert_eq!(range, [0.0, 3.0]);
    }
}
