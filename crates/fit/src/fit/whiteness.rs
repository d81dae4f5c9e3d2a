//! Whether residuals are white, and by how much errors grow where they are not.
//!
//! ```text
//! Q = N (N + 2) sum_(k=1)^L r_k^2/(N - k)                                    Ljung and Box: chi-square with L degrees of freedom
//! S = sum_|k|<=M (1 - |k|/(M + 1)) sum_i s_i s_(i+k)^T,   s_i = r_i J_i       Newey and West
//! covariance = (J^T J)^-1 S (J^T J)^-1
//! ```
//!
//! (G. M. Ljung, G. E. P. Box, *Biometrika* 65 (1978) 297; W. K. Newey, K. D. West, *Econometrica* 55 (1987) 703.)

use nalgebra::{DMatrix, DVector};
use spec_math::cephes64::igamc;

/// The number of autocorrelations that are tested.
const LAGS: usize = 20;

/// The autocorrelation of residuals.
#[derive(Clone, Debug, PartialEq)]
pub struct Whiteness {
    /// The autocorrelations at 1, 2, ... samples.
    pub autocorrelation: Vec<f64>,
    /// The probability that white noise has autocorrelations as large as these.
    pub probability: f64,
}

impl Whiteness {
    /// Tests residuals.
    pub fn new(residuals: &DVector<f64>) -> Self {
        let count = residuals.len();
        let lags = LAGS.min(count / 5);
        let square = residuals.norm_squared();
        let correlation = |lag: usize| {
            let pairs = residuals.iter().zip(residuals.iter().skip(lag));
            pairs.map(|(one, other)| one * other).sum::<f64>() / square
        };
        let autocorrelation: Vec<f64> = (1..=lags).map(correlation).collect();
        let number = count as f64;
        let parts = autocorrelation.iter().zip(1..);
        let statistic: f64 =
            parts.map(|(r, lag)| number * (number + 2.0) * r * r / (number - f64::from(lag))).sum();
        let probability = if lags == 0 { 1.0 } else { igamc(0.5 * lags as f64, 0.5 * statistic) };
        Self { autocorrelation, probability }
    }

    /// Whether the residuals are as white as noise is in 999 of 1000 records.
    pub fn is_white(&self) -> bool {
        const LEAST: f64 = 1e-3;
        self.probability >= LEAST
    }
}

/// The covariance of the parameters with autocorrelated residuals: `inverse` is that of `J^T J`, and `reach`
/// the number of samples over which residuals are correlated.
pub fn robust_covariance(
    jacobian: &DMatrix<f64>,
    residuals: &DVector<f64>,
    inverse: &DMatrix<f64>,
    reach: usize,
) -> DMatrix<f64> {
    let (count, width) = jacobian.shape();
    let mut scores = jacobian.clone();
    for (mut row, residual) in scores.row_iter_mut().zip(residuals.iter()) {
        row *= *residual;
    }
    let mut sum = scores.transpose() * &scores;
    let reach = reach.min(count / 4);
    for lag in 1..=reach {
        let weight = 1.0 - lag as f64 / (reach + 1) as f64;
        let (early, late) = (scores.rows(0, count - lag), scores.rows(lag, count - lag));
        let product: DMatrix<f64> = early.transpose() * late;
        sum += (&product + product.transpose()) * weight;
    }
    let covariance = inverse * sum * inverse;
    DMatrix::from_fn(width, width, |i, j| 0.5 * (covariance[(i, j)] + covariance[(j, i)]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn a_wave_in_the_residuals_is_noticed() {
        let mut generator = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        let noise = DVector::from_fn(2000, |_, _| generator.random::<f64>() - 0.5);
        assert!(Whiteness::new(&noise).is_white());
        let wave = DVector::from_fn(2000, |row, _| noise[row] + 0.1 * (0.1 * row as f64).sin());
        assert!(!Whiteness::new(&wave).is_white());
        // The mean of correlated noise is less certain.
        let smooth = DVector::from_fn(1990, |row, _| noise.rows(row, 10).sum());
        let ones = DMatrix::from_element(1990, 1, 1.0);
        let inverse = DMatrix::from_element(1, 1, 1.0 / 1990.0);
        let robust = robust_covariance(&ones, &smooth, &inverse, 40)[(0, 0)];
        let plain = smooth.norm_squared() / 1990.0 / 1990.0;
        assert!(robust > 5.0 * plain && robust < 20.0 * plain, "{}", robust / plain);
    }
}
