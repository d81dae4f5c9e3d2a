//! The displacement behind a record of velocity or acceleration, good enough for turning points.
//!
//! A sum of trapezoids, less its mean over one period about each time: offsets and slow drifts, which integration would
//! enlarge, go with the mean.

/// The integral of values at increasing times without what is slower than this period.
pub fn oscillating_integral(times: &[f64], values: &[f64], period: f64) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    let centred: Vec<f64> = values.iter().map(|value| value - mean).collect();
    let sum = cumulative(times, &centred);
    let area = cumulative(times, &sum);
    let (Some(first), Some(last)) = (times.first(), times.last()) else { return sum };
    let at = |time: f64| {
        // The area at any time, by its line between samples.
        let next = times.partition_point(|own| *own < time).clamp(1, times.len() - 1);
        let share = (time - times[next - 1]) / (times[next] - times[next - 1]);
        area[next - 1] + share * (area[next] - area[next - 1])
    };
    let window = period.min(last - first);
    times
        .iter()
        .zip(&sum)
        .map(|(time, own)| {
            let from = (time - 0.5 * window).clamp(*first, last - window);
            own - (at(from + window) - at(from)) / window
        })
        .collect()
}

fn cumulative(times: &[f64], values: &[f64]) -> Vec<f64> {
    let mut sum = 0.0;
    let pairs = times.windows(2).zip(values.windows(2));
    let parts = pairs.map(|(time, value)| 0.5 * (value[0] + value[1]) * (time[1] - time[0]));
    let sums = parts.map(|part| {
        sum += part;
        sum
    });
    std::iter::once(0.0).chain(sums).take(times.len()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_velocity_with_an_offset_gives_its_displacement() {
        let times: Vec<f64> = (0..4000).map(|index| 0.01 * f64::from(index)).collect();
        let values: Vec<f64> = times.iter().map(|t| 0.3 + 2.0 * (2.0 * t).cos()).collect();
        let found = oscillating_integral(&times, &values, std::f64::consts::PI);
        for (time, own) in times.iter().zip(&found).skip(200).take(3500) {
            assert!((own - (2.0 * time).sin()).abs() < 5e-3, "{own} at {time}");
        }
    }
}
