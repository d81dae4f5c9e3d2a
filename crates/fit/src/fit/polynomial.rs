//! Least-squares polynomials through a few samples, with their covariance.

use nalgebra::{DMatrix, DVector};

/// A polynomial in `(t - centre)/width` through samples.
#[derive(Clone, Debug)]
pub struct LocalPolynomial {
    centre: f64,
    width: f64,
    coefficients: DVector<f64>,
    /// The covariance of the coefficients for samples of standard deviation one.
    covariance: DMatrix<f64>,
    /// The sum of the squares of the residuals.
    pub residual_square: f64,
    /// The number of samples beyond that of the coefficients.
    pub freedom: usize,
}

impl LocalPolynomial {
    /// Fits a polynomial to samples within a width of a centre. Returns `None` if they are too few.
    pub fn fit(
        times: &[f64],
        values: &[f64],
        centre: f64,
        width: f64,
        degree: usize,
    ) -> Option<Self> {
        let count = degree + 1;
        let freedom = times.len().checked_sub(count + 1)? + 1;
        let place = |index: usize| (times[index] - centre) / width;
        let design =
            DMatrix::from_fn(times.len(), count, |row, column| place(row).powi(column as i32));
        let right = DVector::from_column_slice(values);
        let covariance = (design.transpose() * &design).try_inverse()?;
        let coefficients = &covariance * (design.transpose() * &right);
        let residual_square = (right - design * &coefficients).norm_squared();
        Some(Self { centre, width, coefficients, covariance, residual_square, freedom })
    }

    fn powers(&self, time: f64, derivative: usize) -> DVector<f64> {
        let place = (time - self.centre) / self.width;
        DVector::from_fn(self.coefficients.len(), |index, _| {
            let lowered = index.checked_sub(derivative);
            let factor = (0..derivative).map(|step| index as f64 - step as f64).product::<f64>();
            lowered.map_or(0.0, |power| factor * place.powi(power as i32))
        }) / self.width.powi(derivative as i32)
    }

    /// A derivative at a time, and its standard error for samples of standard deviation one.
    pub fn derivative(&self, time: f64, order: usize) -> (f64, f64) {
        let powers = self.powers(time, order);
        let variance = powers.dot(&(&self.covariance * &powers));
        (powers.dot(&self.coefficients), variance.max(0.0).sqrt())
    }

    /// The zero of a derivative nearest to the centre by Newton's method, and its standard error for samples of
    /// standard deviation one. Returns `None` if it lies outside the width.
    pub fn zero(&self, order: usize) -> Option<(f64, f64)> {
        const ITERATIONS: usize = 20;
        let mut time = self.centre;
        for _ in 0..ITERATIONS {
            let (value, slope) =
                (self.derivative(time, order).0, self.derivative(time, order + 1).0);
            if slope == 0.0 {
                return None;
            }
            time -= (value / slope).clamp(-0.3 * self.width, 0.3 * self.width);
            if !time.is_finite() || (time - self.centre).abs() > self.width {
                return None;
            }
        }
        let slope = self.derivative(time, order + 1).0;
        Some((time, self.derivative(time, order).1 / slope.abs()))
    }
}

/// The median; not a number of an empty list.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.retain(|value| value.is_finite());
    values.sort_by(f64::total_cmp);
    match values.len() {
        0 => f64::NAN,
        count if count % 2 == 1 => values[count / 2],
        count => 0.5 * (values[count / 2 - 1] + values[count / 2]),
    }
}

/// Weighted linear regression on these columns: the coefficients and their covariance for weights that are
/// reciprocal variances. Returns `None` if they are not determined.
pub fn regression(
    columns: &[Vec<f64>],
    values: &[f64],
    weights: &[f64],
) -> Option<(Vec<f64>, DMatrix<f64>)> {
    let root = |row: usize| weights[row].sqrt();
    let design = DMatrix::from_fn(values.len(), columns.len(), |row, column| {
        columns[column][row] * root(row)
    });
    let right = DVector::from_fn(values.len(), |row, _| values[row] * root(row));
    let covariance = (design.transpose() * &design).try_inverse()?;
    let coefficients = &covariance * (design.transpose() * right);
    let finite = coefficients.iter().all(|value| value.is_finite());
    finite.then(|| (coefficients.iter().copied().collect(), covariance))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_is_found_with_its_vertex() {
        let times: Vec<f64> = (0..9).map(|index| 0.25 * f64::from(index)).collect();
        let values: Vec<f64> = times.iter().map(|t| 2.0 - 3.0 * (t - 1.1).powi(2)).collect();
        let fit = LocalPolynomial::fit(&times, &values, 1.0, 1.0, 2).unwrap();
        let (vertex, _) = fit.zero(1).unwrap();
        assert!((vertex - 1.1).abs() < 1e-12 && (fit.derivative(vertex, 0).0 - 2.0).abs() < 1e-12);
        assert_eq!(fit.freedom, 6);
        assert!(LocalPolynomial::fit(&times[..3], &values[..3], 1.0, 1.0, 2).is_none());
    }
}
