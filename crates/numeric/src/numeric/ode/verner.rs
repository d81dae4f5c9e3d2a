//! Verner's explicit Runge-Kutta pair of orders 9 and 8, step by step.
//!
//! ```text
//! k_i = f(t + c_i h, y + h sum a_ij k_j),   y_1 = y + h sum b_i k_i,   error: h sum (b_i - b^_i) k_i
//! y(t + s h) = y + h sum b_i(s) k_i         with the five stages behind the step, k_16 = f(t + h, y_1) the first of them
//! ```
//!
//! (J. H. Verner, *Numerical Algorithms* 53 (2010) 383; the coefficients "RKV98.IIa.Efficient" with the
//! interpolant of order 8.) The coefficients are those of the crate `differential-equations`, whose own
//! step also adds the stages with a coefficient of zero, half of them, and takes those behind the step
//! where nothing is interpolated. Each sum is taken in the same order, so that the values are the same.
//!
//! A step of n values costs 16 evaluations of the rates and some 110 n products; the interpolant of m of
//! them four evaluations and some 60 m products more.

use std::sync::LazyLock;

use differential_equations::error::Error as StepError;
use differential_equations::ode::{ODE, OrdinaryNumericalMethod};
use differential_equations::stats::Evals;
use differential_equations::status::Status;
use differential_equations::tableau::ButcherTableau;
use pulp::{Arch, Simd, WithSimd};

use super::integrate::IntegrationOptions;
use super::sample::StateVector;
use super::trajectory::{FRACTIONS, TERMS, quotient_weights};

/// Stages of a step, and with those of its interpolant.
const STAGES: usize = 16;
const ALL_STAGES: usize = 21;

/// Order of the step, and number of coefficients of each stage in its interpolant.
const ORDER: usize = 9;

/// Stages with their coefficients, those of zero left out.
type Terms = Vec<(usize, f64)>;

/// The coefficients of the pair.
struct Coefficients {
    nodes: [f64; ALL_STAGES],
    /// The coefficients of each stage.
    stages: Vec<Terms>,
    high: Terms,
    low: Terms,
    /// The coefficients of the stages in the interpolant, a row for each power of the fraction of the step, from 1 to 9.
    inside: [[f64; ALL_STAGES]; ORDER],
    /// The coefficients of the stages in each term of the quotient of a step, see `TrajectoryStep`.
    quotient: [Terms; TERMS],
}

static COEFFICIENTS: LazyLock<Coefficients> = LazyLock::new(|| {
    let table = ButcherTableau::<f64, STAGES, ALL_STAGES>::rkv988e();
    let terms = |row: &[f64]| -> Terms {
        row.iter().copied().enumerate().filter(|(_, factor)| *factor != 0.0).collect()
    };
    let inside = table.bi.unwrap_or([[0.0; ALL_STAGES]; ALL_STAGES]);
    // The rise of the interpolant over the fraction of the step, by the stages.
    let over_fraction = |fraction: f64| -> [f64; ALL_STAGES] {
        inside.map(|row| row[..ORDER].iter().rev().fold(0.0, |sum, own| sum * fraction + own))
    };
    let samples = FRACTIONS.map(over_fraction);
    let quotient = quotient_weights().map(|weights| {
        let by_stage: [f64; ALL_STAGES] = std::array::from_fn(|stage| {
            weights.iter().zip(&samples).map(|(weight, sample)| weight * sample[stage]).sum()
        });
        terms(&by_stage)
    });
    Coefficients {
        quotient,
        nodes: table.c,
        stages: table.a.iter().map(|row| terms(row)).collect(),
        high: terms(&table.b),
        low: terms(&table.bh.unwrap_or(table.b)),
        inside: std::array::from_fn(|power| inside.map(|row| row[power])),
    }
});

/// The integration by steps of the pair.
pub(super) struct VernerSteps<Y: StateVector> {
    relative_tolerance: f64,
    absolute_tolerance: f64,
    first_step: f64,
    longest_step: f64,
    /// The number of values, from the first on, that are interpolated: the stages behind the step are
    /// computed for them alone.
    interpolated: usize,
    time: f64,
    time_before: f64,
    step: f64,
    step_before: f64,
    values: Y,
    values_before: Y,
    /// The rates of all stages; of those behind the step the first ones. The first stage of the next step is
    /// that behind the last one, if there is one.
    stages: Vec<Y>,
    is_behind_step: bool,
    /// Values at which rates are evaluated.
    scratch: [Y; 2],
    /// The first values at which rates are evaluated behind the step.
    leading: Y,
    /// As many zeros as there are interpolated values.
    zeros: Y,
    /// The widest registers of the processor.
    arch: Arch,
    rejections: usize,
    status: Status<f64, Y>,
}

impl<Y: StateVector> VernerSteps<Y> {
    /// An integration with a first step (0: chosen by the rates) and a longest one, which still is to
    /// be [begun](OrdinaryNumericalMethod::init).
    pub(super) fn new(
        options: &IntegrationOptions,
        [first_step, longest_step]: [f64; 2],
        interpolated: usize,
    ) -> Self {
        Self {
            relative_tolerance: options.relative_tolerance,
            absolute_tolerance: options.absolute_tolerance,
            first_step,
            longest_step,
            interpolated,
            time: 0.0,
            time_before: 0.0,
            step: 0.0,
            step_before: 0.0,
            values: Y::zeros(),
            values_before: Y::zeros(),
            stages: vec![],
            is_behind_step: false,
            scratch: [Y::zeros(), Y::zeros()],
            leading: Y::zeros(),
            zeros: Y::zeros(),
            arch: Arch::new(),
            rejections: 0,
            status: Status::Uninitialized,
        }
    }

    /// The values that are interpolated, at a time within the last step; `None` outside.
    pub(super) fn values_at(&self, time: f64) -> Option<Y> {
        if time < self.time_before || time > self.time {
            return None;
        }
        let fraction = (time - self.time_before) / self.step_before;
        // Horner's scheme for all stages at once.
        let mut sums = [0.0; ALL_STAGES];
        for row in COEFFICIENTS.inside.iter().rev() {
            for (sum, coefficient) in sums.iter_mut().zip(row) {
                *sum = *sum * fraction + coefficient;
            }
        }
        let (mut factors, mut count) = ([(0, 0.0); ALL_STAGES], 0);
        for (stage, sum) in sums.into_iter().enumerate().filter(|(_, sum)| *sum != 0.0) {
            factors[count] = (stage, sum * fraction);
            count += 1;
        }
        let factors = &factors[..count];
        let mut found = self.leading.clone();
        self.arch.dispatch(StageSum {
            values: self.values_before.as_ref(),
            step: self.step_before,
            terms: factors,
            stages: &self.stages,
            into: found.as_mut(),
        });
        Some(found)
    }

    /// Writes the terms of the quotient of the last step, of the values that are interpolated, in its
    /// Chebyshev series.
    pub(super) fn write_quotient(&self, quotient: &mut [Y; TERMS]) {
        for (term, factors) in quotient.iter_mut().zip(&COEFFICIENTS.quotient) {
            self.arch.dispatch(StageSum {
                values: self.zeros.as_ref(),
                step: self.step_before,
                terms: factors,
                stages: &self.stages,
                into: term.as_mut(),
            });
        }
    }

    /// The first step by the sizes of the rates and of their change (E. Hairer, S. P. Norsett, G.
    /// Wanner, *Solving Ordinary Differential Equations I*, 2nd ed., Springer 1993, section II.4).
    fn chosen_step<F: ODE<f64, Y> + ?Sized>(&mut self, equations: &F, end: f64) -> f64 {
        const SMALL: f64 = 1e-10;
        let allowed = |value: f64| self.absolute_tolerance + self.relative_tolerance * value.abs();
        let (values, rates) = (self.values.as_ref(), self.stages[0].as_ref());
        let square = |one: &[f64]| -> f64 {
            { one.iter().zip(values) }.fold(0.0, |sum, (x, y)| sum + (x / allowed(*y)).powi(2))
        };
        let (size, speed) = (square(values), square(rates));
        let guess =
            if speed <= SMALL || size <= SMALL { 1e-6 } else { (size / speed).sqrt() * 0.01 };
        let short = guess.min(self.longest_step);
        let [ahead, changed] = &mut self.scratch;
        for ((ahead, value), rate) in ahead.as_mut().iter_mut().zip(values).zip(rates) {
            *ahead = value + short * rate;
        }
        equations.diff(self.time + short, ahead, changed);
        for (changed, rate) in changed.as_mut().iter_mut().zip(rates) {
            *changed -= rate;
        }
        let bend = square(self.scratch[1].as_ref()).sqrt() / short;
        let steepest = speed.sqrt().max(bend);
        let by_bend = match steepest <= 1e-15 {
            true => short * 1e-3,
            false => (0.01 / steepest).powf(1.0 / ORDER as f64),
        };
        (short * 100.0).min(by_bend).min(self.longest_step).min(end - self.time)
    }

    /// Evaluates the rates of a stage of the step that begins here, of all values or, behind the step, of
    /// the first ones.
    fn evaluate<F: ODE<f64, Y> + ?Sized>(&mut self, equations: &F, stage: usize) {
        let table = &*COEFFICIENTS;
        let at = if stage < STAGES { &mut self.scratch[0] } else { &mut self.leading };
        self.arch.dispatch(StageSum {
            values: self.values.as_ref(),
            step: self.step,
            terms: &table.stages[stage],
            stages: &self.stages,
            into: at.as_mut(),
        });
        equations.diff(self.time + table.nodes[stage] * self.step, at, &mut self.stages[stage]);
    }
}

/// The first values, as many as there are to write, with the products of a step, factors and rates of the
/// stages added, in the order of the stages.
struct StageSum<'a, Y> {
    values: &'a [f64],
    step: f64,
    terms: &'a [(usize, f64)],
    /// The rates of all stages.
    stages: &'a [Y],
    into: &'a mut [f64],
}

impl<Y: StateVector> StageSum<'_, Y> {
    /// Writes so many sums from one on, which stay in registers.
    #[inline(always)]
    fn write<const WIDTH: usize>(&mut self, first: usize) {
        let mut part = [0.0; WIDTH];
        part.copy_from_slice(&self.values[first..first + WIDTH]);
        for (stage, factor) in self.terms {
            let factor = factor * self.step;
            let rates = &self.stages[*stage].as_ref()[first..][..WIDTH];
            for (part, rate) in part.iter_mut().zip(rates) {
                *part += factor * rate;
            }
        }
        self.into[first..first + WIDTH].copy_from_slice(&part);
    }
}

impl<Y: StateVector> WithSimd for StageSum<'_, Y> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) {
        let last = self.into.len();
        let mut first = 0;
        while last - first >= 24 {
            self.write::<24>(first);
            first += 24;
        }
        while last - first >= 8 {
            self.write::<8>(first);
            first += 8;
        }
        if last - first >= 4 {
            self.write::<4>(first);
            first += 4;
        }
        while first < last {
            self.write::<1>(first);
            first += 1;
        }
    }
}

impl<Y: StateVector> OrdinaryNumericalMethod<f64, Y> for VernerSteps<Y> {
    fn init<F: ODE<f64, Y> + ?Sized>(
        &mut self,
        equations: &F,
        time: f64,
        end: f64,
        values: &Y,
    ) -> Result<Evals, StepError<f64, Y>> {
        (self.time, self.time_before) = (time, time);
        self.values = values.clone();
        self.values_before = values.clone();
        self.leading = values.leading(self.interpolated);
        self.zeros = self.leading.clone();
        self.zeros.as_mut().fill(0.0);
        let model = |stage| if stage <= STAGES { values } else { &self.leading };
        self.stages = (0..ALL_STAGES).map(|stage| model(stage).clone()).collect();
        self.is_behind_step = false;
        self.scratch = [values.clone(), values.clone()];
        equations.diff(time, values, &mut self.stages[0]);
        self.step = match self.first_step {
            0.0 => self.chosen_step(equations, end),
            step => step,
        };
        self.status = Status::Initialized;
        Ok(Evals::new())
    }

    fn step<F: ODE<f64, Y> + ?Sized>(&mut self, equations: &F) -> Result<Evals, StepError<f64, Y>> {
        /// Part of the next step that its error allows; least and largest ratio of two steps.
        const SAFETY: f64 = 0.9;
        const LEAST: f64 = 0.2;
        const MOST: f64 = 10.0;
        /// Ratio to the last step below which a step is too short.
        const SHORTEST: f64 = 1e-14;
        const MOST_REJECTIONS: usize = 100;
        if self.step.abs() < self.step_before.abs() * SHORTEST {
            return Err(StepError::StepSize { t: self.time, y: self.values.clone() });
        }
        let table = &*COEFFICIENTS;
        if std::mem::take(&mut self.is_behind_step) {
            self.stages.swap(0, STAGES);
        }
        for stage in 1..STAGES {
            self.evaluate(equations, stage);
        }
        let [high, low] = &mut self.scratch;
        for (terms, sum) in [(&table.high, &mut *high), (&table.low, &mut *low)] {
            self.arch.dispatch(StageSum {
                values: self.values.as_ref(),
                step: self.step,
                terms,
                stages: &self.stages,
                into: sum.as_mut(),
            });
        }
        let (high, low) = (high.as_ref(), low.as_ref());
        let errors = self.values.as_ref().iter().zip(high).zip(low).map(|((value, high), low)| {
            let size = value.abs().max(high.abs());
            ((high - low) / (self.absolute_tolerance + self.relative_tolerance * size)).abs()
        });
        let error = errors.fold(0.0, f64::max);
        let mut scale = SAFETY * error.powf(-1.0 / ORDER as f64);
        scale = scale.clamp(LEAST, MOST);
        if error > 1.0 {
            self.status = Status::RejectedStep;
            self.rejections += 1;
            if self.rejections >= MOST_REJECTIONS {
                return Err(StepError::Stiffness { t: self.time, y: self.values.clone() });
            }
        } else {
            if matches!(self.status, Status::RejectedStep) {
                self.rejections = 0;
                scale = scale.min(1.0);
            }
            self.status = Status::Solving;
            let end = self.time + self.step;
            equations.diff(end, &self.scratch[0], &mut self.stages[STAGES]);
            self.is_behind_step = true;
            if self.interpolated > 0 {
                for stage in STAGES + 1..ALL_STAGES {
                    self.evaluate(equations, stage);
                }
            }
            (self.time_before, self.step_before) = (self.time, self.step);
            self.time = end;
            std::mem::swap(&mut self.values_before, &mut self.values);
            std::mem::swap(&mut self.values, &mut self.scratch[0]);
        }
        self.step = (self.step * scale).min(self.longest_step);
        Ok(Evals::new())
    }

    fn t(&self) -> f64 {
        self.time
    }

    fn y(&self) -> &Y {
        &self.values
    }

    fn t_prev(&self) -> f64 {
        self.time_before
    }

    fn y_prev(&self) -> &Y {
        &self.values_before
    }

    fn h(&self) -> f64 {
        self.step
    }

    fn set_h(&mut self, step: f64) {
        self.step = step;
    }

    fn status(&self) -> &Status<f64, Y> {
        &self.status
    }

    fn set_status(&mut self, status: Status<f64, Y>) {
        self.status = status;
    }
}
