//! The length of a step, from the last coefficients of a series.

use super::kernels::INVERSE;
use super::series::{LAST, LaneSeries};

/// 2^52, beyond which consecutive doubles are whole numbers.
const WHOLE_NUMBERS: f64 = 4_503_599_627_370_496.0;

/// The longest steps at which the first term left out stays within the allowance, by the radius of
/// convergence estimated from the last coefficients of the velocity: |v_n| ~ size / radius^n.
#[inline(always)]
pub(super) fn step_lengths<const L: usize>(
    velocity: &LaneSeries<L>,
    order: usize,
    size: &[f64; L],
    allowed: &[f64; L],
) -> [f64; L] {
    let mut inverse_radius = [-1e3_f64; L];
    for back in 0..LAST {
        let (last, inverse) = (&velocity[order - back], INVERSE[order - back]);
        for lane in 0..L {
            let excess = logarithm(last[lane].abs()) - logarithm(size[lane]);
            let found = excess * inverse;
            inverse_radius[lane] =
                if found > inverse_radius[lane] { found } else { inverse_radius[lane] };
        }
    }
    let mut lengths = [0.0; L];
    for lane in 0..L {
        let left_out = (logarithm(allowed[lane]) - logarithm(size[lane])) * INVERSE[order + 1];
        lengths[lane] = power(left_out - inverse_radius[lane]);
    }
    lengths
}

/// The logarithm to base 2, to two decimals, which is enough for a step: from the bits of the
/// number.
#[inline(always)]
fn logarithm(number: f64) -> f64 {
    let bits = number.to_bits();
    let mantissa = f64::from_bits((bits & ((1 << 52) - 1)) | (1023 << 52)) - 1.0;
    let exponent = f64::from_bits((bits >> 52) | WHOLE_NUMBERS.to_bits()) - WHOLE_NUMBERS - 1023.0;
    exponent + mantissa * (1.343_5 - 0.343_5 * mantissa)
}

/// Two to this power, to a percent.
#[inline(always)]
fn power(exponent: f64) -> f64 {
    // The integer below, without a function call; rounding comes first.
    let rounded = (exponent + 1.5 * WHOLE_NUMBERS) - 1.5 * WHOLE_NUMBERS;
    let whole = if rounded > exponent { rounded - 1.0 } else { rounded };
    let part = exponent - whole;
    let normal = if whole < -1022.0 { -1022.0 } else { whole };
    let normal = if normal > 1023.0 { 1023.0 } else { normal };
    let scale = f64::from_bits((normal + 1023.0 + WHOLE_NUMBERS).to_bits() << 52);
    scale * (1.0 + part * (0.656_5 + 0.343_5 * part))
}
