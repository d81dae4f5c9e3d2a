//! Nonlinear least squares by the Levenberg-Marquardt method, and the covariance of what it finds.
//!
//! The method is that of the crate `basin`: J. J. Moré, *Lecture Notes in Mathematics* 630 (1978) 105.

use std::cell::RefCell;
use std::convert::Infallible;

use basin::{Executor, Jacobian, LevenbergMarquardt, PointState, Residual};
use nalgebra::{DMatrix, DVector};

/// Residuals and their derivatives by the parameters.
pub type Linearised = (DVector<f64>, DMatrix<f64>);

/// A minimum of a sum of squares.
#[derive(Clone, Debug)]
pub struct Minimum {
    /// The parameters.
    pub parameters: Vec<f64>,
    /// The residuals there.
    pub residuals: DVector<f64>,
    /// Their derivatives by the parameters.
    pub jacobian: DMatrix<f64>,
}

impl Minimum {
    /// The sum of the squares.
    pub fn square(&self) -> f64 {
        self.residuals.norm_squared()
    }
}

struct Problem<F> {
    evaluate: F,
    /// The residuals where there are none, so that the step is taken back.
    refused: DVector<f64>,
    last: RefCell<Option<(DVector<f64>, Linearised)>>,
}

impl<F: Fn(&[f64]) -> Option<Linearised>> Problem<F> {
    fn at(&self, point: &DVector<f64>) -> Linearised {
        if let Some((known, values)) = &*self.last.borrow()
            && known == point
        {
            return values.clone();
        }
        let is_finite = |values: &Linearised| {
            values.0.iter().chain(values.1.iter()).all(|value| value.is_finite())
        };
        let values = (self.evaluate)(point.as_slice()).filter(is_finite).unwrap_or_else(|| {
            (self.refused.clone(), DMatrix::zeros(self.refused.len(), point.len()))
        });
        *self.last.borrow_mut() = Some((point.clone(), values.clone()));
        values
    }
}

impl<F: Fn(&[f64]) -> Option<Linearised>> Residual for &Problem<F> {
    type Param = DVector<f64>;
    type Output = DVector<f64>;
    type Error = Infallible;

    fn residual(&self, point: &DVector<f64>) -> Result<DVector<f64>, Infallible> {
        Ok(self.at(point).0)
    }
}

impl<F: Fn(&[f64]) -> Option<Linearised>> Jacobian for &Problem<F> {
    type Jacobian = DMatrix<f64>;

    fn jacobian(&self, point: &DVector<f64>) -> Result<DMatrix<f64>, Infallible> {
        Ok(self.at(point).1)
    }
}

/// Minimises the sum of the squares of residuals from a start; `evaluate` returns `None` where there are none.
/// Returns `None` if there are none at the start.
pub fn minimise(
    start: &[f64],
    iterations: u64,
    evaluate: impl Fn(&[f64]) -> Option<Linearised>,
) -> Option<Minimum> {
    /// The decrease of chi-square that no longer matters.
    const DECREASE: f64 = 1e-5;
    /// The factor by which residuals exceed those of the start where the law has no motion.
    const REFUSED: f64 = 1e3;
    let (residuals, jacobian) = evaluate(start)?;
    let size = residuals.norm() / (residuals.len() as f64).sqrt();
    let reduction = DECREASE / residuals.len() as f64;
    let refused = DVector::from_element(residuals.len(), REFUSED * size.max(f64::MIN_POSITIVE));
    let first = DVector::from_column_slice(start);
    let last = RefCell::new(Some((first.clone(), (residuals, jacobian))));
    let problem = Problem { evaluate, refused, last };
    let method = LevenbergMarquardt::new()
        .with_absolute_gradient_tolerance(None)
        .with_relative_model_reduction_tolerance(reduction)
        .with_initial_step_bound(1.0);
    let ended =
        Executor::new(&problem, method, PointState::new(first)).max_iter(iterations).run().ok()?;
    let point = ended.param().clone();
    let (residuals, jacobian) = problem.at(&point);
    Some(Minimum { parameters: point.iter().copied().collect(), residuals, jacobian })
}

impl Minimum {
    /// The amount by which an undamped step would still reduce chi-square, in units of the variance of the residuals: the square of its
    /// length in standard errors.
    pub fn distance(&self) -> f64 {
        let (count, width) = self.jacobian.shape();
        let gradient = self.jacobian.transpose() * &self.residuals;
        let inverse = Covariance::new(&self.jacobian).matrix;
        let variance = self.square() / (count.saturating_sub(width)).max(1) as f64;
        gradient.dot(&(inverse * &gradient)) / variance.max(f64::MIN_POSITIVE)
    }
}

/// The inverse of `J^T J`, from the singular values of the scaled columns of J, and the directions that they leave undetermined.
#[derive(Clone, Debug)]
pub struct Covariance {
    /// The inverse, which is the covariance of the parameters for residuals of standard deviation one.
    pub matrix: DMatrix<f64>,
    /// Directions in the space of the parameters, scaled by their columns, along which the residuals do not change.
    pub flat: Vec<Vec<f64>>,
}

impl Covariance {
    /// Computes the covariance of a minimum. Flat directions are left out of the inverse.
    pub fn new(jacobian: &DMatrix<f64>) -> Self {
        /// The relative singular value below which a direction counts as flat.
        const FLAT: f64 = 1e-6;
        let scales: Vec<f64> = jacobian
            .column_iter()
            .map(|column| column.norm())
            .map(|norm| if norm > 0.0 { norm } else { 1.0 })
            .collect();
        let count = scales.len();
        let gram = jacobian.transpose() * jacobian;
        let scaled = DMatrix::from_fn(count, count, |i, j| gram[(i, j)] / (scales[i] * scales[j]));
        let eigen = scaled.symmetric_eigen();
        let mut matrix = DMatrix::zeros(count, count);
        let mut flat = vec![];
        for (value, vector) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
            if *value < FLAT * FLAT {
                flat.push(vector.iter().zip(&scales).map(|(part, scale)| part / scale).collect());
                continue;
            }
            matrix += vector * vector.transpose() / *value;
        }
        let matrix =
            DMatrix::from_fn(count, count, |i, j| matrix[(i, j)] / (scales[i] * scales[j]));
        Self { matrix, flat }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_decay_is_fitted_and_a_flat_direction_found() {
        let times: Vec<f64> = (0..50).map(|index| 0.1 * f64::from(index)).collect();
        let residuals = |point: &[f64]| {
            let [size, rate] = *point else { return None };
            let values = times.iter().map(|t| size * (-rate * t).exp() - 2.0 * (-0.7 * t).exp());
            let slopes = |row: usize, column: usize| {
                let decay = (-rate * times[row]).exp();
                if column == 0 { decay } else { -times[row] * size * decay }
            };
            let values = DVector::from_iterator(times.len(), values);
            Some((values, DMatrix::from_fn(times.len(), 2, slopes)))
        };
        let minimum = minimise(&[1.0, 0.2], 50, residuals).unwrap();
        assert!(minimum.distance() < 1e-6);
        assert!((minimum.parameters[0] - 2.0).abs() < 1e-6);
        assert!((minimum.parameters[1] - 0.7).abs() < 1e-6);
        assert!(Covariance::new(&minimum.jacobian).flat.is_empty());
        let twice = DMatrix::from_fn(50, 2, |row, column| times[row] * (column + 1) as f64);
        let flat = Covariance::new(&twice).flat;
        assert!(flat.len() == 1 && (flat[0][0] / flat[0][1] + 2.0).abs() < 1e-6);
    }
}
