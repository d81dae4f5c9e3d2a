//! Frequency and damping against amplitude, as measured: no law is needed.
//!
//! ```text
//! over a window of turning points:  t_n = t + n pi/omega,   ln A_n = ln A - delta (t_n - t)       regression on both
//! zeta = delta/omega                                                          the damping ratio at the amplitude A
//! ```
//!
//! The errors are those of the turning points. This is the table that tests of bolted structures are compared by (free decays with
//! frequency and damping against amplitude).

use nalgebra::DMatrix;

use crate::fit::polynomial::regression;
use crate::fit::turning_points::Swings;

/// Frequency and damping at one amplitude, with their standard errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BackbonePoint {
    /// The time in the middle of the window.
    pub time: f64,
    /// Half the distance between a maximum and a minimum.
    pub amplitude: f64,
    /// The standard error of the amplitude.
    pub amplitude_error: f64,
    /// The angular frequency.
    pub frequency: f64,
    /// The standard error of the angular frequency.
    pub frequency_error: f64,
    /// The damping ratio: the rate of decay of the amplitude over the angular frequency.
    pub damping: f64,
    /// The standard error of the damping ratio.
    pub damping_error: f64,
}

/// Frequency and damping against amplitude from the turning points of a free decay, in windows of time; at most this
/// number of points.
///
/// ```
/// use lindstedt_fit::fit::{backbone::backbone, turning_points::Swings};
///
/// // A linear decay has the damping ratio 0.01 at every amplitude.
/// let times: Vec<f64> = (0..6000).map(|index| 0.01 * f64::from(index)).collect();
/// let values: Vec<f64> = times.iter().map(|t| (-0.05 * t).exp() * (5.0 * t).cos()).collect();
/// for point in backbone(&Swings::find(&times, &values)?, 12) {
///     assert!((point.damping - 0.01).abs() < 1e-4 && (point.frequency - 5.0).abs() < 1e-3);
/// }
/// # Ok::<(), lindstedt_fit::fit::turning_points::SwingsError>(())
/// ```
pub fn backbone(swings: &Swings, most: usize) -> Vec<BackbonePoint> {
    const FEWEST: usize = 4;
    let count = swings.points.len();
    let window = (count / most.max(1)).max(FEWEST).min(count);
    let amplitudes = swings.amplitudes();
    let starts = (0..=count - window).step_by((window / 2).max(1));
    starts.filter_map(|start| point(swings, &amplitudes, start, window)).collect()
}

fn point(
    swings: &Swings,
    amplitudes: &[f64],
    start: usize,
    window: usize,
) -> Option<BackbonePoint> {
    let end = start + window;
    let points = &swings.points[start..end];
    let one = vec![1.0; window];
    let middle = points.iter().map(|point| point.time).sum::<f64>() / window as f64;
    let numbers: Vec<f64> =
        points.iter().map(|point| (point.half_swings - points[0].half_swings) as f64).collect();
    let times: Vec<f64> = points.iter().map(|point| point.time - middle).collect();
    let weights: Vec<f64> = points.iter().map(|point| point.time_error.powi(-2)).collect();
    // Maxima and minima are not half a period apart if the spring is not even.
    let parity: Vec<f64> =
        points.iter().map(|point| if point.is_maximum { 0.5 } else { -0.5 }).collect();
    let (line, covariance) = regression(&[one.clone(), numbers, parity], &times, &weights)?;
    let frequency = std::f64::consts::PI / line[1];
    let frequency_error = frequency / line[1] * covariance[(1, 1)].sqrt();
    let own = &amplitudes[start..end];
    let logarithms: Vec<f64> = own.iter().map(|amplitude| amplitude.ln()).collect();
    // An amplitude is a mean of three turning points with the weights 1/2, 1/4, 1/4.
    let weight = |(point, amplitude): (&crate::fit::turning_points::TurningPoint, &f64)| {
        (amplitude / (0.6124 * point.value_error)).powi(2)
    };
    let mut weights: Vec<f64> = points.iter().zip(own).map(weight).collect();
    // The first and the last turning point of a record have one neighbour, and no amplitude without bias.
    for (place, weight) in weights.iter_mut().enumerate() {
        if [0, swings.points.len() - 1].contains(&(start + place)) {
            *weight = 0.0;
        }
    }
    let (decay, covariance) = regression(&[one, times], &logarithms, &weights)?;
    let covariance: DMatrix<f64> = covariance;
    let amplitude = decay[0].exp();
    let damping = -decay[1] / frequency;
    // Neighbouring amplitudes share turning points, so that their errors add up where independent ones would not.
    const SHARED: f64 = 1.6;
    let damping_error = SHARED * covariance[(1, 1)].sqrt() / frequency;
    let amplitude_error = SHARED * amplitude * covariance[(0, 0)].sqrt();
    let found = BackbonePoint {
        time: middle,
        amplitude,
        amplitude_error,
        frequency,
        frequency_error,
        damping,
        damping_error,
    };
    (frequency.is_finite() && frequency > 0.0 && damping.is_finite()).then_some(found)
}
