//! How long a step may be, from the last coefficients of a series.

use crate::impact::taylor::series::{INVERSE, LAST};

/// The longest step at which the first term left out stays within what is allowed, by the radius of convergence that
/// the last coefficients tell: |v_n| ~ size / radius^n.
pub(super) fn step_length(size: f64, allowed: f64, last: [f64; LAST], order: usize) -> f64 {
    let logarithm_of_size = logarithm(size);
    let mut inverse_radius = -1e3_f64;
    for (back, coefficient) in last.iter().enumerate() {
        let excess = logarithm(coefficient.abs()) - logarithm_of_size;
        inverse_radius = inverse_radius.max(excess * INVERSE[order - back]);
    }
    let left_out = (logarithm(allowed) - logarithm_of_size) * INVERSE[order + 1];
    power(left_out - inverse_radius)
}

/// The logarithm to base 2, to two decimals, which is enough for a step: from the bits of the number.
fn logarithm(number: f64) -> f64 {
    let bits = number.to_bits();
    let mantissa = f64::from_bits((bits & ((1 << 52) - 1)) | (1023 << 52)) - 1.0;
    let exponent = (bits >> 52) as f64 - 1023.0;
    exponent + mantissa * (1.343_5 - 0.343_5 * mantissa)
}

/// Two to this power, to a percent.
fn power(exponent: f64) -> f64 {
    // The integer below it, without a call.
    let toward_zero = exponent as i64;
    let whole = if (toward_zero as f64) > exponent {
        toward_zero - 1
    } else {
        toward_zero
    };
    let part = exponent - whole as f64;
    let scale = f64::from_bits(((whole + 1023).clamp(1, 2046) as u64) << 52);
    scale * (1.0 + part * (0.656_5 + 0.343_5 * part))
}
