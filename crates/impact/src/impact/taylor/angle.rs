//! Sine and cosine of several angles side by side.
//!
//! ```text
//! x = k pi/2 + y, |y| <= pi/4, pi/2 in two parts, the first short enough for its product with k to be exact
//! sin y = y - y^3/3! + ... + y^17/17!,   cos y = 1 - y^2/2! + ... + y^16/16!:   what is left out is below 2^-58
//! ```
//!
//! Own polynomials are used because calls of library functions would not be vectorised, and because
//! the result is then the same on every processor.

use std::f64::consts::FRAC_2_PI;

/// 1.5 2^52: added to a number, it rounds it to a whole number in the last bits.
const WHOLE: f64 = 6_755_399_441_055_744.0;

/// The first 33 bits of pi/2, and the rest.
const QUARTER: [f64; 2] = [1.570_796_326_734_125_6, 6.077_100_506_506_192e-11];

/// The angle beyond which the product with the first part of pi/2 is not exact.
const LARGEST: f64 = 1e5;

/// 1/2!, 1/3!, ..., 1/17!.
const INVERSE_FACTORIALS: [f64; 18] = {
    let mut table = [1.0; 18];
    let (mut n, mut factorial) = (1, 1_u64);
    while n < table.len() {
        factorial *= n as u64;
        table[n] = 1.0 / factorial as f64;
        n += 1;
    }
    table
};

/// Sine and cosine of each angle, to a unit of the last digit or 1e-26 of the angle.
#[inline(always)]
pub(super) fn sines_and_cosines<const L: usize>(angles: &[f64; L]) -> ([f64; L], [f64; L]) {
    let (mut sines, mut cosines) = ([0.0; L], [0.0; L]);
    let mut large = false;
    for lane in 0..L {
        let shifted = angles[lane] * FRAC_2_PI + WHOLE;
        let (turns, quadrant) = (shifted - WHOLE, shifted.to_bits());
        let first = angles[lane] - turns * QUARTER[0];
        let second = turns * QUARTER[1];
        let y = first - second;
        let rest = (first - y) - second;
        let z = y * y;
        let f = &INVERSE_FACTORIALS;
        let odd = f[15] - z * f[17];
        let odd = f[11] - z * (f[13] - z * odd);
        let odd = f[7] - z * (f[9] - z * odd);
        let odd = f[3] - z * (f[5] - z * odd);
        let even = f[14] - z * f[16];
        let even = f[10] - z * (f[12] - z * even);
        let even = f[6] - z * (f[8] - z * even);
        let even = z * z * (f[4] - z * even);
        let half = 0.5 * z;
        let most = 1.0 - half;
        let sine = y + (rest * most - y * z * odd);
        let cosine = most + (((1.0 - most) - half) + (even - rest * y));
        let swap = quadrant & 1 == 1;
        let (one, other) = if swap { (cosine, sine) } else { (sine, cosine) };
        sines[lane] = f64::from_bits(one.to_bits() ^ ((quadrant & 2) << 62));
        cosines[lane] = f64::from_bits(other.to_bits() ^ ((quadrant.wrapping_add(1) & 2) << 62));
        large |= angles[lane].abs() > LARGEST;
    }
    if large {
        for lane in 0..L {
            if angles[lane].abs() > LARGEST {
                (sines[lane], cosines[lane]) = angles[lane].sin_cos();
            }
        }
    }
    (sines, cosines)
}

/// Sine and cosine of one angle, bit for bit those of [`sines_and_cosines`].
pub(super) fn sine_and_cosine(angle: f64) -> (f64, f64) {
    let ([sine], [cosine]) = sines_and_cosines(&[angle]);
    (sine, cosine)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sine and cosine are those of the standard library to the last digit, in every quadrant, next
    /// to its ends, and for any number.
    #[test]
    fn they_are_sine_and_cosine() {
        let steps = (-40_000..40_000).map(|step| f64::from(step) * 0.013);
        let ends = (-70..70).map(|quarters| f64::from(quarters) * std::f64::consts::FRAC_PI_2);
        let wide = [0.0, -0.0, 1e-300, 5e-324, 99_999.9, -99_999.9, 1e5 + 1.0, 1e22, f64::MAX];
        for angle in steps.chain(ends).chain(wide) {
            let (sine, cosine) = sine_and_cosine(angle);
            let (sine_of, cosine_of) = angle.sin_cos();
            let allowed = |value: f64| 2.3e-16 * value.abs() + 1e-26 * angle.abs().min(LARGEST);
            assert!((sine - sine_of).abs() <= allowed(sine_of), "sin {angle}: {sine} {sine_of}");
            assert!(
                (cosine - cosine_of).abs() <= allowed(cosine_of),
                "cos {angle}: {cosine} {cosine_of}"
            );
        }
        for angle in [f64::NAN, f64::INFINITY] {
            assert!(sine_and_cosine(angle).0.is_nan());
        }
    }

    /// Eight at a time are what each is alone.
    #[test]
    fn each_lane_is_what_it_is_alone() {
        let angles = [0.1, -1.0, 2.0, -3.0, 4.0, 1e6, 0.0, -7e4];
        let (sines, cosines) = sines_and_cosines(&angles);
        for (lane, angle) in angles.iter().enumerate() {
            assert_eq!((sines[lane], cosines[lane]), sine_and_cosine(*angle));
        }
    }
}
