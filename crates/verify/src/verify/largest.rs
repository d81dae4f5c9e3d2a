//! The largest value of a function over a period.

use crate::numeric::ode::root::find_minimum;

use super::orbit::SAMPLES;

/// The largest value of a function without negative values from 0 to a period: the largest sample,
/// refined between samples at a peak whose neighbours are lower by more than a thousandth. NaN if a
/// sample has no value.
pub(super) fn largest_over(period: f64, function: impl Fn(f64) -> f64) -> f64 {
    /// A peak is refined if its sample is at least the first fraction of the largest one, and a
    /// neighbour is lower by more than the second fraction.
    const LARGE: f64 = 0.5;
    const CLOSE: f64 = 1e-3;
    let time = |index: usize| period * index as f64 / SAMPLES as f64;
    let samples: Vec<f64> = (0..=SAMPLES).map(|index| function(time(index))).collect();
    if samples.iter().any(|sample| sample.is_nan()) {
        return f64::NAN;
    }
    let largest = samples.iter().copied().fold(0.0, f64::max);
    let mut found = largest;
    for (index, &sample) in samples.iter().enumerate() {
        let neighbours = [index.saturating_sub(1), (index + 1).min(SAMPLES)];
        let below = neighbours.map(|neighbour| sample - samples[neighbour]);
        let is_peak = below.iter().all(|below| *below >= 0.0);
        if is_peak && sample >= LARGE * largest && below.iter().any(|below| *below > CLOSE * sample)
        {
            let (_, least) =
                find_minimum(|t| function(t).recip(), time(neighbours[0]), time(neighbours[1]));
            found = found.max(least.recip());
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A peak narrower than the distance of two samples is as high as it is; a wide one is left to
    /// its samples.
    #[test]
    fn a_narrow_peak_is_found_between_the_samples() {
        let peak = |width: f64| move |t: f64| 3.0 / (1.0 + ((t - 1.234_567) / width).powi(2));
        for width in [1e-2, 3e-3, 1e-3] {
            assert!((largest_over(2.0, peak(width)) - 3.0).abs() < 1e-9, "{width}");
        }
        let wide = largest_over(2.0, peak(0.5));
        assert!(wide < 3.0 && wide > 3.0 * (1.0 - 1e-5), "{wide}");
        assert_eq!(largest_over(2.0, |_| 0.0), 0.0);
        assert!(largest_over(2.0, |t| if t > 1.0 { f64::NAN } else { t }).is_nan());
    }
}
