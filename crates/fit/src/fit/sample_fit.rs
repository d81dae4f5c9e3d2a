//! A law fitted to the samples of a record: parameters, start, offset and drift together.
//!
//! ```text
//! y_i = x(t_i; p, x_0, v_0) + offset + drift (t_i - t_m)        x: the integrated equation with its derivatives
//! ```
//!
//! Several records share the parameters; each has its own start, offset and drift, and its residuals count by its noise.
//!
//! A fit whose start is out of step with the record grows: a sixteenth of the record, an eighth, a quarter, a half, all of it.

use nalgebra::{DMatrix, DVector};

use crate::fit::fit_coordinates::FitCoordinates;
use crate::fit::laws::Law;
use crate::fit::least_squares::{Linearised, Minimum, minimise};
use crate::fit::motion::{MotionSolver, Quantity, SampledMotion};

/// The samples that a law is fitted to.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    /// Increasing times.
    pub times: Vec<f64>,
    /// The observed values.
    pub values: Vec<f64>,
    /// The observed quantity.
    pub quantity: Quantity,
    /// The mean duration of a half swing.
    pub half_period: f64,
    /// The time to which the offset refers.
    pub middle: f64,
    /// Offset at the middle and drift of the observed values, as the swings show them.
    pub centre: [f64; 2],
    /// The factor of the residuals: the noise of the first record over that of this one.
    pub weight: f64,
}

/// A law whose parameters fit a record best.
#[derive(Clone, Debug)]
pub struct SampleFit {
    /// The law.
    pub law: Law,
    /// Its parameters, then for each record the initial coordinate and velocity, the offset at the middle and the drift.
    pub values: Vec<f64>,
    /// Observed minus fitted values, times the weight of the record.
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

/// Fits a law to one record or several from a start: parameters, then for each record the initial coordinate and velocity at the first
/// sample, offset, drift. Returns `None` if the law has no motion there.
pub fn fit_samples(
    law: &Law,
    solver: &MotionSolver,
    records: &[&Samples],
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
    let coordinates = FitCoordinates::new(law, records);
    let evaluate = |inner: &[f64], counts: &[usize]| -> Option<Linearised> {
        let values = coordinates.to_law(inner)?;
        let (residuals, jacobian) = linearised(solver, records, &values, counts)?;
        Some((residuals, jacobian * coordinates.slopes(inner)?))
    };
    let start = &coordinates.inner(start)?;
    let totals: Vec<usize> = records.iter().map(|samples| samples.values.len()).collect();
    let variance: f64 = records.iter().map(|samples| samples.square_about_mean()).sum();
    let first = evaluate(start, &totals);
    let in_step =
        first.is_some_and(|(residuals, _)| residuals.norm_squared() < OUT_OF_STEP * variance);
    let mut values = start.clone();
    if !in_step {
        for share in [16, 8, 4, 2] {
            if totals.iter().all(|total| total / share < FEWEST) {
                continue;
            }
            let count = |total: &usize| (total / share).max(FEWEST).min(*total);
            let counts: Vec<usize> = totals.iter().map(count).collect();
            if let Some(found) =
                minimise(&values, ITERATIONS_OF_PARTS, |values| evaluate(values, &counts))
            {
                values = found.parameters;
            }
        }
    }
    let mut minimum = minimise(&values, ITERATIONS, |values| evaluate(values, &totals))?;
    // In a curved valley the method stops early: it begins anew from there.
    for _ in 0..RESTARTS {
        if minimum.distance() < NEAR {
            break;
        }
        let next = minimise(&minimum.parameters, ITERATIONS, |values| evaluate(values, &totals))?;
        let gain = minimum.square() - next.square();
        // A gain within the distance that counts as converged leaves the order of the laws as it is.
        let freedom = next.residuals.len().saturating_sub(start.len()).max(1);
        let is_better = gain > NEAR * next.square() / freedom as f64;
        minimum = next;
        if !is_better {
            break;
        }
    }
    let converged = minimum.distance() < NEAR;
    let Minimum { parameters, residuals, jacobian, .. } = minimum;
    let jacobian = jacobian * coordinates.slopes(&parameters)?.try_inverse()?;
    let values = coordinates.to_law(&parameters)?;
    let mut fit = SampleFit { law: law.clone(), values, residuals, jacobian, converged };
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

/// The sum of the squares of the residuals at a start of [`fit_samples`]; `None` if the law has no motion there.
pub fn misfit(solver: &MotionSolver, records: &[&Samples], start: &[f64]) -> Option<f64> {
    let totals: Vec<usize> = records.iter().map(|samples| samples.values.len()).collect();
    let (residuals, _) = linearised(solver, records, start, &totals)?;
    Some(residuals.norm_squared()).filter(|square| square.is_finite())
}

impl Samples {
    /// The sum of the squares of the weighted values about their mean.
    fn square_about_mean(&self) -> f64 {
        let mean = self.values.iter().sum::<f64>() / self.values.len() as f64;
        let square: f64 = self.values.iter().map(|value| (value - mean).powi(2)).sum();
        square * self.weight * self.weight
    }
}

/// The motion of a law with these parameters, start, offset and drift at any increasing times.
pub fn motion(
    solver: &MotionSolver,
    samples: &Samples,
    values: &[f64],
    times: &[f64],
) -> Option<SampledMotion> {
    let own = values.len().checked_sub(LOCAL)?;
    let start = [values[own], values[own + 1]];
    solver.sample(&values[..own], start, times, samples.half_period, samples.quantity)
}

/// The number of values that belong to one record alone.
pub(crate) const LOCAL: usize = 4;

/// The values of one record among those of all: the parameters, then its own.
pub(crate) fn values_of(values: &[f64], records: usize, record: usize) -> Vec<f64> {
    let shared = values.len().saturating_sub(LOCAL * records);
    let own = (values.iter().skip(shared + LOCAL * record)).take(LOCAL);
    values.iter().take(shared).chain(own).copied().collect()
}

/// The residuals of the first samples of each record and their derivatives.
fn linearised(
    solver: &MotionSolver,
    records: &[&Samples],
    values: &[f64],
    counts: &[usize],
) -> Option<Linearised> {
    let total = counts.iter().sum();
    let shared = values.len() - LOCAL * records.len();
    let mut residuals = DVector::zeros(total);
    let mut jacobian = DMatrix::zeros(total, values.len());
    let mut from = 0;
    for (record, (samples, count)) in records.iter().zip(counts).enumerate() {
        let times = &samples.times[..*count];
        let own = values_of(values, records.len(), record);
        let columns = motion(solver, samples, &own, times)?.columns;
        let [offset, drift] = *own.last_chunk::<2>()?;
        let (weight, middle) = (samples.weight, samples.middle);
        for (row, time) in times.iter().enumerate() {
            let fitted = columns[0][row] + offset + drift * (time - middle);
            residuals[from + row] = weight * (samples.values[row] - fitted);
        }
        let local = shared + LOCAL * record;
        let place = |index: usize| if index < shared { index } else { local + index - shared };
        for (index, column) in columns[1..].iter().enumerate() {
            let mut rows = jacobian.column_mut(place(index));
            let rows = rows.iter_mut().skip(from);
            rows.zip(column).for_each(|(own, slope)| *own = -weight * slope);
        }
        for (row, time) in times.iter().enumerate() {
            jacobian[(from + row, local + 2)] = -weight;
            jacobian[(from + row, local + 3)] = -weight * (time - middle);
        }
        from += count;
    }
    Some((residuals, jacobian))
}
