//! The longest step within the tolerance, read off the coefficients of a series.
//!
//! Reference: A. Jorba, M. Zou, *Experimental Mathematics* 14 (2005) 99.

use pulp::{Arch, Simd, WithSimd};

use crate::series::tape::Tape;

/// Number of last terms of a series that are examined: symmetry may leave some of them zero.
const LAST: usize = 8;

/// The bounds that some series set to a step, lane by lane.
#[derive(Clone, Copy, Debug)]
pub(super) struct StepBounds<const L: usize> {
    /// The longest step; infinity if nothing bounds it.
    pub(super) longest: [f64; L],
    /// Whether the sum of all coefficients is finite, and so every one of them. The sum of finite
    /// ones may overflow.
    pub(super) has_values: [bool; L],
}

/// Bounds of the last terms of a series, relative to its largest term of lower order on the step:
///
/// ```text
/// |c_k| h^k <= tolerance^(k/p) max_(j<first) |c_j| h^j      for the last orders k = first..p
/// ```
///
/// Each bound holds up to an `h` and not beyond, so that the longest step is the least over k of the
/// greatest over j of `(tolerance^(k/p) |c_j/c_k|)^(1/(k - j))`: differences of logarithms.
#[derive(Clone, Debug)]
pub(super) struct Allowance {
    /// The lowest of the last orders.
    first: usize,
    /// The binary logarithms of the bounds `tolerance^(k/p)` from the order `first` on.
    bounds: Vec<f64>,
    /// The reciprocals `1/n`.
    reciprocals: Vec<f64>,
}

impl Allowance {
    /// The bounds for series up to this order.
    pub(super) fn new(tolerance: f64, order: usize) -> Self {
        let first = order.saturating_sub(LAST - 1).max(order / 2 + 1);
        let bound = |k: usize| tolerance.log2() * k as f64 / order as f64;
        Self {
            first,
            bounds: (first..=order).map(bound).collect(),
            reciprocals: (0..=order).map(|n| 1.0 / n as f64).collect(),
        }
    }

    /// Returns the longest step on which the series at these places are within their bounds, and
    /// whether these have values, for each lane. A series without a value bounds nothing.
    ///
    /// A few dozen subtractions, multiplications and comparisons for each series, up to some hundred where every
    /// term is looked at: a term that bounds no lane more than those before it is left after the first few.
    pub(super) fn bounds<const L: usize>(
        &self,
        tape: &Tape<L>,
        places: impl Iterator<Item = usize>,
    ) -> StepBounds<L> {
        struct Shorten<'a, const L: usize> {
            allowance: &'a Allowance,
            series: &'a [[f64; L]],
            least: &'a mut [f64; L],
            total: &'a mut [f64; L],
        }
        impl<const L: usize> WithSimd for Shorten<'_, L> {
            type Output = ();

            #[inline(always)]
            fn with_simd<S: Simd>(self, _: S) {
                self.allowance.shorten(self.series, self.least, self.total);
            }
        }
        let (mut least, mut total) = ([f64::INFINITY; L], [0.0; L]);
        let arch = Arch::new();
        for place in places {
            let series = tape.lanes(place);
            let (least, total) = (&mut least, &mut total);
            arch.dispatch(Shorten { allowance: self, series, least, total });
        }
        StepBounds { longest: least.map(f64::exp2), has_values: total.map(f64::is_finite) }
    }

    /// Reduces the logarithms of the steps to what a series allows, and adds its coefficients to the
    /// total.
    #[inline(always)]
    fn shorten<const L: usize>(
        &self,
        series: &[[f64; L]],
        least: &mut [f64; L],
        total: &mut [f64; L],
    ) {
        const MOST: usize = 32;
        /// Number of terms after which a bound is looked at.
        const AT_ONCE: usize = 4;
        let mut lower = [[0.0; L]; MOST];
        let lower = &mut lower[..self.first];
        let mut sum = [0.0; L];
        for (logarithms, coefficients) in lower.iter_mut().zip(series) {
            for lane in 0..L {
                logarithms[lane] = logarithm(coefficients[lane]);
                sum[lane] += coefficients[lane];
            }
        }
        let mut shortest = *least;
        for (k, bound) in (self.first..).zip(&self.bounds) {
            let mut room = [0.0; L];
            for lane in 0..L {
                room[lane] = bound - logarithm(series[k][lane]);
                sum[lane] += series[k][lane];
            }
            let mut longest = [f64::NEG_INFINITY; L];
            let reciprocals = self.reciprocals[k + 1 - self.first..=k].rchunks(AT_ONCE);
            for (logarithms, reciprocals) in lower.chunks(AT_ONCE).zip(reciprocals) {
                for (logarithms, reciprocal) in logarithms.iter().zip(reciprocals.iter().rev()) {
                    for lane in 0..L {
                        let step = (logarithms[lane] + room[lane]) * reciprocal;
                        longest[lane] = if step > longest[lane] { step } else { longest[lane] };
                    }
                }
                // What is longer in every lane than a bound before is none.
                let mut may_bound = false;
                for lane in 0..L {
                    may_bound |= longest[lane] < shortest[lane];
                }
                if !may_bound {
                    break;
                }
            }
            for lane in 0..L {
                let bounds = (longest[lane] > f64::NEG_INFINITY) & (longest[lane] < shortest[lane]);
                shortest[lane] = if bounds { longest[lane] } else { shortest[lane] };
            }
        }
        for lane in 0..L {
            let bounds = sum[lane].is_finite() & (shortest[lane] < least[lane]);
            least[lane] = if bounds { shortest[lane] } else { least[lane] };
            total[lane] += sum[lane];
        }
    }
}

/// Returns the binary logarithm of the absolute value of a number to 0.01, from its bits: the
/// exponent, and a parabola for the mantissa. It is minus infinity for zero.
#[inline(always)]
fn logarithm(number: f64) -> f64 {
    const EXPONENT: u32 = 52;
    const MANTISSA: u64 = (1 << EXPONENT) - 1;
    /// Of `f + c f (1 - f)`, nearest to the logarithm of `1 + f` everywhere.
    const CURVATURE: f64 = 0.344;
    let bits = number.abs().to_bits();
    // Both conversions are sums with numbers whose last bits are free, which any processor does side by side.
    let whole = f64::from_bits((bits >> EXPONENT) | 2.0_f64.powi(52).to_bits()) - 2.0_f64.powi(52);
    let fraction = f64::from_bits((bits & MANTISSA) | 1.0_f64.to_bits()) - 1.0;
    let logarithm = whole - 1023.0 + fraction * (1.0 + CURVATURE * (1.0 - fraction));
    if bits == 0 { f64::NEG_INFINITY } else { logarithm }
}
