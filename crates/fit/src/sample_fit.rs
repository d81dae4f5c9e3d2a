//! A law fitted to the samples of a record: parameters, start, offset and drift together.
//!
//! ```text
//! y_i = x(t_i; p, x_0, v_0) + offset + drift (t_i - t_m)        x: the integrated equation with its derivatives
//! ```
//!
//! Where the motion of the start is out of step with the record, the fit grows: an eighth of the record, a quarter, a half, all of it.

use nalgebra::{DMatrix, DVector};

use crate::laws::Law;
use crate::least_squares::{Linearised, Minimum, minimise};
use crate::motion::{MotionSolver, Quantity, SampledMotion};

/// The samples that a law is fitted to.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    /// Increasing times.
    pub times: Vec<f64>,
    /// The observed values.
    pub values: Vec<f64>,
    /// What was observed.
    pub quantity: Quantity,
    /// The mean duration of a half swing.
    pub half_period: f64,
    /// The time to which the offset refers.
    pub middle: f64,
    /// Offset at the middle and drift of the observed values, as the swings show them.
    pub centre: [f64; 2],
}

/// A law whose parameters fit a record best.
#[derive(Clone, Debug)]
pub struct SampleFit {
    /// The law.
    pub law: Law,
    /// Its parameters, then the initial coordinate and velocity, the offset at the middle and the drift.
    pub values: Vec<f64>,
    /// Observed minus fitted values.
    pub residuals: DVector<f64>,
    /// The derivatives of the fitted values by `values`, with the sign of the residuals.
    pub jacobian: DMatrix<f64>,
    /// Whether the method converged.
    pub converged: bool,
}

impl SampleFit {
    /// The sum of the squares of the residuals.
    pub fn square(&self) -> f64 {
        self.residuals.norm_squared()
    }
}

/// Fits a law from a start: parameters, initial coordinate and velocity at the first sample, offset, drift.
/// Returns `None` if the law has no motion there.
pub fn fit_samples(
    law: &Law,
    solver: &MotionSolver,
    samples: &Samples,
    start: &[f64],
) -> Option<SampleFit> {
    const ITERATIONS: u64 = 12;
    const ITERATIONS_OF_PARTS: u64 = 8;
    /// The share of the variance of the record above which a start is out of step.
    const OUT_OF_STEP: f64 = 0.1;
    const FEWEST: usize = 40;
    const RESTARTS: usize = 3;
    /// The square of the distance from the minimum in standard errors: a tenth of one.
    const NEAR: f64 = 0.01;
    let total = samples.values.len();
    let evaluate = |values: &[f64], count: usize| linearised(solver, samples, values, count);
    let mean = samples.values.iter().sum::<f64>() / total as f64;
    let variance: f64 = samples.values.iter().map(|value| (value - mean).powi(2)).sum();
    let first = evaluate(start, total);
    let in_step =
        first.is_some_and(|(residuals, _)| residuals.norm_squared() < OUT_OF_STEP * variance);
    let mut values = start.to_vec();
    if !in_step {
        for share in [16, 8, 4, 2] {
            let count = total / share;
            if count < FEWEST {
                continue;
            }
            if let Some(found) =
                minimise(&values, ITERATIONS_OF_PARTS, |values| evaluate(values, count))
            {
                values = found.parameters;
            }
        }
    }
    let mut minimum = minimise(&values, ITERATIONS, |values| evaluate(values, total))?;
    // In a curved valley the method stops early: it begins anew from there.
    for _ in 0..RESTARTS {
        if minimum.distance() < NEAR {
            break;
        }
        let next = minimise(&minimum.parameters, ITERATIONS, |values| evaluate(values, total))?;
        let gain = minimum.square() - next.square();
        let is_better = gain > 1e-9 * next.square();
        minimum = next;
        if !is_better {
            break;
        }
    }
    let converged = minimum.distance() < NEAR;
    let Minimum { parameters, residuals, jacobian, .. } = minimum;
    let mut fit =
        SampleFit { law: law.clone(), values: parameters, residuals, jacobian, converged };
    // The equations of the list are the same for -w and -zeta.
    if let (Some(_), Some(w)) = (law.parts, law.parameter("w"))
        && fit.values[w] < 0.0
    {
        for index in [Some(w), law.parameter("zeta")].into_iter().flatten() {
            fit.values[index] *= -1.0;
            fit.jacobian.column_mut(index).neg_mut();
        }
    }
    Some(fit)
}

/// The motion of a law with these parameters, start, offset and drift at any increasing times.
pub fn motion(
    solver: &MotionSolver,
    samples: &Samples,
    values: &[f64],
    times: &[f64],
) -> Option<SampledMotion> {
    let own = values.len().checked_sub(4)?;
    let start = [values[own], values[own + 1]];
    solver.sample(&values[..own], start, times, samples.half_period, samples.quantity)
}

/// The residuals of the first samples and their derivatives.
fn linearised(
    solver: &MotionSolver,
    samples: &Samples,
    values: &[f64],
    count: usize,
) -> Option<Linearised> {
    let times = &samples.times[..count];
    let columns = motion(solver, samples, values, times)?.columns;
    let [offset, drift] = *values.last_chunk::<2>()?;
    let lag = |row: usize| times[row] - samples.middle;
    let residuals = DVector::from_fn(count, |row, _| {
        samples.values[row] - columns[0][row] - offset - drift * lag(row)
    });
    let mut jacobian = DMatrix::zeros(count, values.len());
    let last = values.len() - 2;
    for (index, column) in columns[1..].iter().enumerate() {
        jacobian.column_mut(index).iter_mut().zip(column).for_each(|(own, slope)| *own = -slope);
    }
    jacobian.column_mut(last).fill(-1.0);
    jacobian.column_mut(last + 1).iter_mut().enumerate().for_each(|(row, own)| *own = -lag(row));
    Some((residuals, jacobian))
}
