//! The operations of the Taylor recurrences, each for one coefficient of `L` series side by side.
//!
//! ```text
//! (a b)_n = sum_k a_k b_(n-k)                u = sin y, c = cos y:   n u_n = (y' c)_(n-1),  n c_n = -(y' u)_(n-1)
//! z' = y'/b:   n z_n b_0 = n y_n - sum_(0<k<n) k z_k b_(n-k)
//! ```
//!
//! The slope y' is stored shifted by one: n y_n at the index of y_(n-1). A coefficient costs n
//! multiplications, half of them for a square.

use super::series::{HIGHEST_ORDER, LaneSeries};
use super::stretch::stretched;

/// Motions in one register of 256 bits.
const REGISTER: usize = 4;

/// (a b)_n, requested in increasing order: for an even n the known part of the next one is computed
/// at the same time, so that every coefficient is read once for both.
#[inline(always)]
pub(super) fn product<const L: usize>(
    a: &LaneSeries<L>,
    b: &LaneSeries<L>,
    n: usize,
    ahead: &mut [f64; L],
) -> [f64; L] {
    let mut sum = [0.0; L];
    if n % 2 == 1 {
        for lane in 0..L {
            sum[lane] = ahead[lane] + a[0][lane] * b[n][lane] + a[n][lane] * b[0][lane];
        }
        return sum;
    }
    let mut next = [0.0; L];
    for ((low, high), b) in a[..n].iter().zip(&a[1..=n]).zip(b[1..=n].iter().rev()) {
        for lane in 0..L {
            sum[lane] += low[lane] * b[lane];
            next[lane] += high[lane] * b[lane];
        }
    }
    for lane in 0..L {
        sum[lane] += a[n][lane] * b[0][lane];
    }
    *ahead = next;
    sum
}

/// (a b)_n and (a c)_n, computed like [`product`].
#[inline(always)]
pub(super) fn products<const L: usize>(
    a: &LaneSeries<L>,
    [b, c]: [&LaneSeries<L>; 2],
    n: usize,
    ahead: &mut [[f64; L]; 2],
) -> [[f64; L]; 2] {
    let mut sums = [[0.0; L]; 2];
    if n % 2 == 1 {
        for lane in 0..L {
            sums[0][lane] = ahead[0][lane] + a[0][lane] * b[n][lane] + a[n][lane] * b[0][lane];
            sums[1][lane] = ahead[1][lane] + a[0][lane] * c[n][lane] + a[n][lane] * c[0][lane];
        }
        return sums;
    }
    let mut next = [[0.0; L]; 2];
    for ((low, high), (b, c)) in
        a[..n].iter().zip(&a[1..=n]).zip(b[1..=n].iter().zip(&c[1..=n]).rev())
    {
        // One register at a time, so that the sums stay in registers.
        for first in (0..L).step_by(REGISTER) {
            let last = L.min(first + REGISTER);
            for lane in first..last {
                sums[0][lane] += low[lane] * b[lane];
                next[0][lane] += high[lane] * b[lane];
            }
            for lane in first..last {
                sums[1][lane] += low[lane] * c[lane];
                next[1][lane] += high[lane] * c[lane];
            }
        }
    }
    for lane in 0..L {
        sums[0][lane] += a[n][lane] * b[0][lane];
        sums[1][lane] += a[n][lane] * c[0][lane];
    }
    *ahead = next;
    sums
}

/// (a b)_n, computed like [`product`], if one factor is a multiple of the other, so that half of
/// the terms equal the other half.
#[inline(always)]
pub(super) fn symmetric<const L: usize>(
    a: &LaneSeries<L>,
    b: &LaneSeries<L>,
    n: usize,
    ahead: &mut [f64; L],
) -> [f64; L] {
    let mut sum = [0.0; L];
    let half = n / 2;
    if n % 2 == 1 {
        for lane in 0..L {
            sum[lane] = 2.0 * (ahead[lane] + a[0][lane] * b[n][lane]);
        }
        return sum;
    }
    let mut next = [0.0; L];
    if half > 0 {
        let falling = b[half + 1..=n].iter().rev();
        for (a, (high, low)) in a[1..=half].iter().zip(falling.zip(b[half..n].iter().rev())) {
            for lane in 0..L {
                next[lane] += a[lane] * high[lane];
                sum[lane] += a[lane] * low[lane];
            }
        }
        // The middle term, which has no counterpart, came last.
        for lane in 0..L {
            sum[lane] = 2.0 * (sum[lane] + a[0][lane] * b[n][lane]) - a[half][lane] * b[half][lane];
        }
    } else {
        for lane in 0..L {
            sum[lane] = a[0][lane] * b[0][lane];
        }
    }
    *ahead = next;
    sum
}

/// (a a)_n.
#[inline(always)]
pub(super) fn square<const L: usize>(
    a: &LaneSeries<L>,
    n: usize,
    ahead: &mut [f64; L],
) -> [f64; L] {
    symmetric(a, a, n, ahead)
}

#[inline(always)]
pub(super) fn per_lane<const L: usize>(value: impl Fn(usize) -> f64) -> [f64; L] {
    let mut result = [0.0; L];
    for (lane, entry) in result.iter_mut().enumerate() {
        *entry = value(lane);
    }
    result
}

/// 1/n.
pub(super) const INVERSE: [f64; HIGHEST_ORDER + 2] = {
    let mut table = [0.0; HIGHEST_ORDER + 2];
    let mut n = 1;
    while n < table.len() {
        table[n] = 1.0 / n as f64;
        n += 1;
    }
    table
};

/// The next coefficients of sine and cosine of an angle with this rate: n s_n = (rate c)_(n-1).
#[inline(always)]
pub(super) fn sine_and_cosine<const L: usize>(
    [sine, cosine]: [&mut LaneSeries<L>; 2],
    rate: &LaneSeries<L>,
    n: usize,
    ahead: &mut [[f64; L]; 2],
) {
    let [up, down] = products(rate, [cosine, sine], n - 1, ahead);
    for lane in 0..L {
        sine[n][lane] = INVERSE[n] * up[lane];
        cosine[n][lane] = -INVERSE[n] * down[lane];
    }
}

/// The next coefficients of sine and cosine of a phase that grows like time; `factor` is its rate
/// over n, in the unit of the step.
#[inline(always)]
pub(super) fn waves_of_time<const L: usize>(
    [sine, cosine]: [&mut LaneSeries<L>; 2],
    stretch: &[[f64; L]; 2],
    factor: &[f64; L],
    n: usize,
) {
    let (up, down) = (stretched(stretch, cosine, n - 1), stretched(stretch, sine, n - 1));
    for lane in 0..L {
        sine[n][lane] = factor[lane] * up[lane];
        cosine[n][lane] = -factor[lane] * down[lane];
    }
}

/// The next coefficients of the function with the slope y'/b, and of that slope; `numerator` is n
/// y_n.
#[inline(always)]
pub(super) fn quotient<const L: usize>(
    [result, slope]: [&mut LaneSeries<L>; 2],
    numerator: &[f64; L],
    over: &LaneSeries<L>,
    n: usize,
) {
    let mut known = [0.0; L];
    for (slope, over) in slope[..n - 1].iter().zip(over[1..n].iter().rev()) {
        for lane in 0..L {
            known[lane] += slope[lane] * over[lane];
        }
    }
    for lane in 0..L {
        slope[n - 1][lane] = (numerator[lane] - known[lane]) / over[0][lane];
        result[n][lane] = INVERSE[n] * slope[n - 1][lane];
    }
}

/// The series of time itself.
#[inline(always)]
pub(super) fn time<const L: usize>(
    series: &mut LaneSeries<L>,
    unit: &[f64; L],
    [p, q]: &[[f64; L]; 2],
) {
    series[1] = *unit;
    series[2] = per_lane(|lane| INVERSE[2] * unit[lane] * p[lane]);
    series[3] = per_lane(|lane| INVERSE[3] * unit[lane] * q[lane]);
}
